//! The cases of one sweep, ordered by what varies.

use super::FigureError;
use super::axis::Axis;
use super::notes::LOAD;
use super::style::{case_colour, series_colour};
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
    /// The table `avalanches`, for the panel of their sizes.
    pub avalanches: Option<&'a Frame>,
    /// True if panels of sweeps of other parameters have all loads, and not the largest of each case alone.
    pub all_loads: bool,
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
    /// Value along the horizontal axis, as a label.
    pub(super) facet: String,
    /// True if a cycle of the case is finished.
    pub(super) is_finished: bool,
    /// Places among the values of the parameters besides `x`.
    rank: Vec<usize>,
}

/// A sweep.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sweep {
    pub(super) members: Vec<Member>,
    /// Varying parameters: the horizontal axis first, then parameters that follow from it; nothing if only
    /// the load reversal varies.
    pub(super) differing: Vec<Varying>,
    /// Number of parameters that follow from the first one, as those of a `zip`.
    pub(super) following: usize,
    /// True if several parameters vary, and not together: the colour is that of the series, and the panels of
    /// paths have one value of the horizontal axis each.
    pub(super) has_facets: bool,
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
    /// Finds the members of a sweep, or of several whose names are joined by `+`.
    pub(super) fn find(tables: &Tables<'_>, name: &str) -> Result<Self, FigureError> {
        let cases = tables.cases;
        let (rows, mut differing) = chosen(tables, name)?;
        let following = following(&mut differing);
        let (ids, max_loads, loads) = (cases.text("case_id")?, cases.f64("max_load")?, loads(cases)?);
        let area = cases.f64_or_null("area_at_max_load_mean")?;
        let done = cases.i64("done_count")?;
        let load_labels = loads.labels(rows.iter().copied());
        let load_of = |row: &usize| loads.values.get(*row).copied().unwrap_or_default();
        let many_loads = rows.windows(2).any(|pair| load_of(&pair[0]) != load_of(&pair[1]));
        let words = words(differing.first());
        let ranks: Vec<Vec<usize>> = differing.iter().skip(1 + following).map(ranks).collect();
        let mut members = Vec::new();
        for (place, row) in rows.iter().enumerate() {
            let x = match differing.first().map(|first| &first.values) {
                Some(Values::Numbers(numbers)) => numbers.get(place).copied().flatten(),
                Some(Values::Words(all)) => all
                    .get(place)
                    .and_then(|word| words.iter().position(|known| known == word))
                    .map(|at| at as f64),
                None => area.get(*row).copied().flatten(),
            };
            let load = load_labels.get(place).map(String::as_str).filter(|_| many_loads);
            let [label, series] = named(&differing, following, place, load);
            members.push(Member {
                row: *row,
                case_id: ids.get(*row).copied().unwrap_or_default().to_owned(),
                max_load: max_loads.get(*row).copied().unwrap_or_default(),
                // Without a place, a member has curves but no point; NaN is left out of every axis.
                x: x.unwrap_or(f64::NAN),
                label,
                colour: String::new(),
                series,
                facet: said(&differing[..differing.len().min(1 + following)], place).join(", "),
                is_finished: done.get(*row).is_some_and(|count| *count > 0),
                rank: ranks.iter().map(|rank| rank[place]).collect(),
            });
        }
        let order = |member: &Member| if differing.is_empty() { member.max_load } else { member.x };
        members.sort_by(|a, b| {
            a.rank
                .cmp(&b.rank)
                .then(order(a).total_cmp(&order(b)))
                .then(a.max_load.total_cmp(&b.max_load))
                .then(a.case_id.cmp(&b.case_id))
        });
        let axis = axis(&differing, words, &members);
        let has_facets = is_grid(&members);
        colour(&mut members, &differing, following, has_facets);
        Ok(Self { members, differing, following, has_facets, load_symbol: loads.symbol, axis })
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
            facet: String::new(),
            is_finished: true,
            rank: Vec::new(),
        };
        let differing = vec![Varying::named_as(["campaign", "run", "run"], Values::Words(labels.to_vec()))];
        let members: Vec<Member> = labels.iter().enumerate().map(member).collect();
        Ok(Self {
            members,
            differing,
            following: 0,
            has_facets: false,
            load_symbol: "",
            axis: Axis::of_words("run", labels.to_vec()),
        })
    }
}

/// Rows of the sweep in the table `cases`, with what varies between them: the parameter with most values
/// first.
fn chosen(tables: &Tables<'_>, name: &str) -> Result<(Vec<usize>, Vec<Varying>), FigureError> {
    let cases = tables.cases;
    let sweeps = cases.text("sweep")?;
    let belongs = |joined: &str, name: &str| joined.split('+').any(|one| one == name);
    if let Some(missing) = name.split('+').find(|name| !sweeps.iter().any(|joined| belongs(joined, name))) {
        return Err(unknown(missing, &sweeps));
    }
    let is_chosen = |joined: &str| name.split('+').any(|name| belongs(joined, name));
    let mut rows: Vec<usize> = (0..sweeps.len()).filter(|row| is_chosen(sweeps[*row])).collect();
    let mut differing = varying(cases, &rows)?;
    if !differing.is_empty() && !tables.all_loads {
        let (ids, loads) = (cases.text("case_id")?, cases.f64("max_load")?);
        let largest = |row: &usize| {
            let mut of_case = rows.iter().filter(|other| ids[**other] == ids[*row]);
            of_case.all(|other| loads[*other] <= loads[*row])
        };
        rows = rows.iter().copied().filter(largest).collect();
        differing = varying(cases, &rows)?;
    }
    let most = (0..differing.len()).rev().max_by_key(|at| count(&differing[*at])).unwrap_or_default();
    differing.get_mut(..=most).into_iter().for_each(|first| first.rotate_right(1));
    Ok((rows, differing))
}

/// Puts the parameters of which each value of the first one has one value next to it; gives their number.
fn following(differing: &mut [Varying]) -> usize {
    let Some((first, others)) = differing.split_first_mut() else { return 0 };
    let of_first = ranks(first);
    let follows = |of: &Varying| {
        let own = ranks(of);
        (0..own.len()).all(|a| (0..a).all(|b| of_first[a] != of_first[b] || own[a] == own[b]))
    };
    others.sort_by_cached_key(|of| !follows(of));
    others.iter().filter(|of| follows(of)).count()
}

/// Values of parameters that a case has.
pub(super) fn said(of: &[Varying], place: usize) -> Vec<String> {
    let present = of.iter().filter(|parameter| !parameter.is_absent(place));
    present.map(|parameter| parameter.named(place)).collect()
}

/// Label of all that varies, and of what does not follow from the first parameter.
fn named(differing: &[Varying], following: usize, place: usize, load: Option<&str>) -> [String; 2] {
    let free = differing.get(1 + following..).unwrap_or_default();
    let mut parts = [said(differing, place), said(free, place)];
    match load {
        Some(load) if differing.is_empty() => parts[0].push(load.to_owned()),
        Some(load) => parts.iter_mut().for_each(|parts| parts.push(format!("{LOAD}{load}"))),
        None => {}
    }
    parts.map(|parts| parts.join(", "))
}

/// Place of each value of a parameter among its different values, in ascending order.
fn ranks(of: &Varying) -> Vec<usize> {
    match &of.values {
        Values::Numbers(numbers) => {
            let number = |value: &Option<f64>| value.unwrap_or(f64::INFINITY);
            let mut known: Vec<f64> = numbers.iter().map(number).collect();
            known.sort_by(f64::total_cmp);
            known.dedup();
            numbers.iter().map(|value| known.partition_point(|one| *one < number(value))).collect()
        }
        Values::Words(all) => {
            let known = words(Some(of));
            all.iter().map(|word| known.partition_point(|one| one < word)).collect()
        }
    }
}

/// Number of different values of a parameter.
fn count(of: &Varying) -> usize {
    ranks(of).into_iter().max().map_or(0, |most| most + 1)
}

/// True if several parameters vary, and a value of the first one has several cases.
fn is_grid(members: &[Member]) -> bool {
    let share = |a: &Member, b: &Member| a.x.total_cmp(&b.x).is_eq() && a.rank != b.rank;
    members.iter().any(|a| members.iter().any(|b| share(a, b)))
}

/// Colours the members: a colour for each value of what varies, with several parameters for each series, and
/// for each load where only the load varies. Numbers have colours in their order. Cases that are not drawn
/// use no colour of their own.
fn colour(members: &mut [Member], differing: &[Varying], following: usize, by_series: bool) {
    let mut loads: Vec<f64> = members.iter().map(|member| member.max_load).collect();
    loads.sort_by(f64::total_cmp);
    loads.dedup();
    let word = |member: &Member| match (differing.len(), by_series) {
        (0, _) => member.max_load.to_string(),
        (_, true) => format!("{:?}", member.rank),
        _ => member.case_id.clone(),
    };
    let mut known: Vec<String> = Vec::new();
    for member in members.iter().filter(|member| member.is_finished) {
        if !known.contains(&word(member)) {
            known.push(word(member));
        }
    }
    let is_number = |of: &Varying| matches!(of.values, Values::Numbers(_));
    let in_order = match (differing, differing.get(1 + following..).unwrap_or_default()) {
        ([], _) => true,
        ([first, ..], []) => is_number(first),
        ([first, ..], [other]) => is_number(if by_series { other } else { first }),
        _ => false,
    };
    for member in members {
        let place = known.iter().position(|of| *of == word(member)).unwrap_or_default();
        let load = loads.iter().position(|load| *load == member.max_load).unwrap_or_default();
        let of_loads = if differing.is_empty() { [0, 1] } else { [load, loads.len()] };
        member.colour = series_colour(place, known.len(), in_order, of_loads);
    }
}

/// The words of a parameter, if it has words, each once.
fn words(of: Option<&Varying>) -> Vec<String> {
    let Some(Values::Words(all)) = of.map(|of| &of.values) else {
        return Vec::new();
    };
    let mut words = all.clone();
    words.sort_unstable();
    words.dedup();
    words
}

fn axis(differing: &[Varying], words: Vec<String>, members: &[Member]) -> Axis {
    let finished = members.iter().filter(|member| member.is_finished);
    let values: Vec<f64> = finished.map(|member| member.x).filter(|x| x.is_finite()).collect();
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
