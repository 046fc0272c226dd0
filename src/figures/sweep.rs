//! The cases of one sweep, ordered by what varies.

use super::FigureError;
use super::axis::Axis;
use super::style::case_colour;
use crate::stats::{Values, Varying, loads, varying};
use crate::store::Frame;

/// Tables from which panels are drawn.
#[derive(Debug, Clone, Copy)]
pub struct Tables<'a> {
    /// The table `cases`.
    pub cases: &'a Frame,
    /// The table `curves`.
    pub curves: &'a Frame,
    /// The table `realizations`.
    pub realizations: &'a Frame,
}

/// A row of the table `cases` that belongs to the sweep.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Member {
    pub(super) row: usize,
    pub(super) case_id: String,
    pub(super) max_load: f64,
    /// Place along the horizontal axis of the panels of results.
    pub(super) x: f64,
    /// Label of its curves.
    pub(super) label: String,
    /// Colour of its curves and points.
    pub(super) colour: String,
    /// Parameters besides `x`: members that share them are joined by a line.
    pub(super) series: String,
}

/// A sweep.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sweep {
    pub(super) members: Vec<Member>,
    /// Varying parameters, the horizontal axis first; nothing if only the load reversal varies.
    pub(super) differing: Vec<Varying>,
    /// True if there are several load reversals.
    pub(super) many_loads: bool,
    /// Symbol of the load reversal.
    pub(super) load_symbol: &'static str,
    pub(super) axis: Axis,
}

/// Error of a sweep that no case belongs to.
fn unknown(name: &str, sweeps: &[&str]) -> FigureError {
    let mut known: Vec<&str> = sweeps.iter().flat_map(|joined| joined.split('+')).collect();
    known.sort_unstable();
    known.dedup();
    FigureError::UnknownSweep { sweep: name.to_owned(), known: known.join(", ") }
}

impl Sweep {
    /// Finds the members of a sweep.
    pub(super) fn find(cases: &Frame, name: &str) -> Result<Self, FigureError> {
        let sweeps = cases.text("sweep")?;
        let belongs = |joined: &&str| joined.split('+').any(|one| one == name);
        let rows: Vec<usize> =
            sweeps.iter().enumerate().filter(|(_, joined)| belongs(joined)).map(|(row, _)| row).collect();
        if rows.is_empty() {
            return Err(unknown(name, &sweeps));
        }
        let (ids, max_loads, loads) = (cases.text("case_id")?, cases.f64("max_load")?, loads(cases)?);
        let area = cases.f64_or_null("area_at_max_load_mean")?;
        let differing = varying(cases, &rows)?;
        let load_labels = loads.labels(rows.iter().copied());
        let load_of = |row: usize| loads.values.get(row).copied().unwrap_or_default();
        let many_loads = rows
            .windows(2)
            .any(|pair| pair.first().map(|row| load_of(*row)) != pair.last().map(|row| load_of(*row)));
        let words = words(&differing);
        let mut members = Vec::new();
        for (place, row) in rows.iter().enumerate() {
            let max_load = max_loads.get(*row).copied().unwrap_or_default();
            let x = match differing.first().map(|first| &first.values) {
                Some(Values::Numbers(numbers)) => numbers.get(place).copied().flatten(),
                Some(Values::Words(all)) => all
                    .get(place)
                    .and_then(|word| words.iter().position(|known| known == word))
                    .map(|at| at as f64),
                None => area.get(*row).copied().flatten(),
            };
            let said = |of: &[Varying]| -> Vec<String> {
                of.iter()
                    .filter(|parameter| !parameter.is_absent(place))
                    .map(|parameter| parameter.named(place))
                    .collect()
            };
            let (mut parts, mut series) = (said(&differing), said(differing.get(1..).unwrap_or_default()));
            if many_loads {
                let load = load_labels.get(place).map_or("", String::as_str);
                if differing.is_empty() {
                    parts.push(load.to_owned());
                } else {
                    parts.push(format!("F_{{max}} = {load}"));
                    series.push(format!("F_{{max}} = {load}"));
                }
            }
            let case_id = ids.get(*row).copied().unwrap_or_default().to_owned();
            let (label, series, colour) = (parts.join(", "), series.join(", "), String::new());
            // Without a place, a member has curves but no point; NaN is left out of every axis.
            let x = x.unwrap_or(f64::NAN);
            members.push(Member { row: *row, case_id, max_load, x, label, colour, series });
        }
        let order = |member: &Member| {
            if differing.is_empty() { member.max_load } else { member.x }
        };
        members.sort_by(|a, b| {
            order(a)
                .total_cmp(&order(b))
                .then(a.max_load.total_cmp(&b.max_load))
                .then(a.case_id.cmp(&b.case_id))
        });
        let axis = axis(&differing, words, &members);
        colour(&mut members, differing.is_empty());
        Ok(Self { members, differing, many_loads, load_symbol: loads.symbol, axis })
    }

    /// True if lines join the results: not between categories.
    pub(super) fn is_joined(&self) -> bool {
        !matches!(self.differing.first().map(|first| &first.values), Some(Values::Words(_)))
    }

    /// One case in several campaigns: a row for each, in the order of their names.
    pub(super) fn side_by_side(cases: &Frame, labels: &[String]) -> Result<Self, FigureError> {
        let (ids, loads) = (cases.text("case_id")?, cases.f64("max_load")?);
        let member = |(row, label): (usize, &String)| Member {
            row,
            case_id: ids.get(row).copied().unwrap_or_default().to_owned(),
            max_load: loads.get(row).copied().unwrap_or_default(),
            x: row as f64,
            label: label.clone(),
            colour: case_colour(row, 0, 1),
            // Runs are not joined by a line.
            series: label.clone(),
        };
        let differing = vec![Varying::named_as(["campaign", "run", "run"], Values::Words(labels.to_vec()))];
        let members: Vec<Member> = labels.iter().enumerate().map(member).collect();
        Ok(Self {
            members,
            differing,
            many_loads: false,
            load_symbol: "",
            axis: Axis::of_words("run", labels.to_vec()),
        })
    }
}

/// Colours the members: one colour for each case, or for each load where only the load varies.
fn colour(members: &mut [Member], by_load: bool) {
    let mut loads: Vec<f64> = members.iter().map(|member| member.max_load).collect();
    loads.sort_by(f64::total_cmp);
    loads.dedup();
    let mut cases: Vec<String> = Vec::new();
    for member in members {
        if !cases.contains(&member.case_id) {
            cases.push(member.case_id.clone());
        }
        let case = cases.iter().position(|id| *id == member.case_id).unwrap_or_default();
        let load = loads.iter().position(|load| *load == member.max_load).unwrap_or_default();
        member.colour = if by_load { case_colour(load, 0, 1) } else { case_colour(case, load, loads.len()) };
    }
}

/// The words of the horizontal axis, if it has words, each once.
fn words(differing: &[Varying]) -> Vec<String> {
    let Some(Values::Words(all)) = differing.first().map(|first| &first.values) else {
        return Vec::new();
    };
    let mut words = all.clone();
    words.sort_unstable();
    words.dedup();
    words
}

fn axis(differing: &[Varying], words: Vec<String>, members: &[Member]) -> Axis {
    let values: Vec<f64> = members.iter().map(|member| member.x).filter(|x| x.is_finite()).collect();
    let (least, most) =
        (values.iter().copied().fold(f64::INFINITY, f64::min), values.iter().copied().fold(0.0, f64::max));
    match differing.first() {
        None => Axis::holding("A/A_{0}", values, true).with_headroom(0.05),
        Some(first) if matches!(first.values, Values::Words(_)) => Axis::of_words(
            first.label,
            words.into_iter().map(|word| if word.is_empty() { "none".to_owned() } else { word }).collect(),
        ),
        // A magnification counts doublings of resolution: equal steps of it are equal ratios.
        Some(first) if first.name == "magnification" && most >= 2.0 * least => {
            Axis::of_doublings(first.label, values)
        }
        Some(first) => Axis::holding(first.label, values, false),
    }
}
