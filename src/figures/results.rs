//! Panels B, D and E: what a cycle comes to, over what varies.

use super::FigureError;
use super::axis::Axis;
use super::curve::{Curve, KeyEntry, Note, Stroke, XyPlot};
use super::paths::unnamed;
use super::style::{NEUTRAL, THEORY, curve, entry, shade};
use super::sweep::{Member, Sweep, Tables};
use super::units::{Quantity, Scales};
use crate::stats::{FEW, singles};

/// A result to be drawn, and how.
#[derive(Debug, Clone, Copy)]
pub(super) struct Measured {
    /// A column of the table `cases` without `_mean`.
    pub(super) name: &'static str,
    pub(super) text: &'static str,
    pub(super) stroke: Stroke,
    /// True if it cannot be negative.
    pub(super) positive: bool,
}

/// A prediction to be drawn, and how.
#[derive(Debug, Clone, Copy)]
pub(super) struct Predicted {
    /// A column of the table `cases` without `_mean`.
    pub(super) name: &'static str,
    pub(super) stroke: Stroke,
    pub(super) text: &'static str,
    /// Name at the end of a line of one series.
    pub(super) abbreviation: &'static str,
}

/// Series of which each line of a prediction has a name.
const MOST_LABELLED: usize = 4;

/// Curves with their entries of the key and the notes at their ends.
#[derive(Default)]
struct Drawn {
    curves: Vec<Curve>,
    key: Vec<KeyEntry>,
    notes: Vec<Note>,
}

/// Results of every member in some units, with the single surfaces or error bars, and predictions of them.
pub(super) fn results(
    tables: &Tables<'_>,
    sweep: &Sweep,
    (quantity, scales): (Quantity, &Scales<'_>),
    measured: &[Measured],
    theories: &[Predicted],
) -> Result<XyPlot, FigureError> {
    // In the order of their values.
    let mut series: Vec<&str> = Vec::new();
    for member in &sweep.members {
        if !series.contains(&member.series.as_str()) {
            series.push(&member.series);
        }
    }
    // If only the load reversal varies, the only line joins its results.
    if sweep.differing.is_empty() {
        series.truncate(1);
    }
    let unit = |row: usize| scales.factor(quantity, row);
    let mut predicted = Drawn::default();
    for theory in theories {
        predict(tables, sweep, &series, *theory, &unit, &mut predicted)?;
    }
    let mut computed = Drawn::default();
    for of in measured {
        match scales.column(of.name) {
            Some((column, factor)) => {
                measure(tables, sweep, &series, of, (column, &|_| Some(factor)), &mut computed)?;
            }
            None => measure(tables, sweep, &series, of, (of.name, &unit), &mut computed)?,
        }
    }
    if measured.len() > 1 {
        computed.notes = highest(&computed.notes);
    }
    let crosses = computed.curves.iter().any(|curve| curve.stroke == Stroke::Crosses);
    let cut = computed.curves.iter().any(Curve::is_cut);
    let mut key = computed.key;
    if crosses {
        key.push(entry("single surfaces", NEUTRAL, Some(Stroke::Crosses), true));
    }
    if cut {
        key.push(entry("bars end at 0", NEUTRAL, None, false));
    }
    key.extend(predicted.key);
    let curves: Vec<Curve> = predicted.curves.into_iter().chain(computed.curves).collect();
    let room = 0.07 * key.len() as f64 + 0.04;
    let y = Axis::holding(scales.label(quantity), curves.iter().flat_map(Curve::heights), true)
        .with_headroom(room);
    let x = sweep.axis.clone();
    Ok(XyPlot { notes: [computed.notes, predicted.notes].concat(), ..unnamed([x, y], curves, key) })
}

/// The highest of the notes with the same text: lines of one series differ in their strokes alone.
fn highest(notes: &[Note]) -> Vec<Note> {
    let is_lower = |note: &Note| notes.iter().any(|other| other.text == note.text && other.at.1 > note.at.1);
    notes.iter().filter(|note| !is_lower(note)).cloned().collect()
}

/// Factor of the values of a row of the table `cases`.
type Unit<'a> = &'a dyn Fn(usize) -> Option<f64>;

/// The members that one line joins.
fn joined<'a>(sweep: &'a Sweep, series: &'a str) -> impl Iterator<Item = &'a Member> {
    sweep.members.iter().filter(move |member| sweep.differing.is_empty() || member.series == series)
}

/// Colour of a line: that of its series if several parameters vary.
fn line_colour(sweep: &Sweep, series: &str, else_of: [u8; 3]) -> String {
    let member = joined(sweep, series).next().filter(|_| sweep.has_facets);
    member.map_or_else(|| shade(else_of, 0, 1), |member| member.colour.clone())
}

/// Lines of a prediction.
fn predict(
    tables: &Tables<'_>,
    sweep: &Sweep,
    series: &[&str],
    Predicted { name: theory, stroke, text, abbreviation }: Predicted,
    unit: Unit<'_>,
    drawn: &mut Drawn,
) -> Result<(), FigureError> {
    let means = tables.cases.f64_or_null(&format!("{theory}_mean"))?;
    let (mut any, mut marked, mut lined) = (false, false, false);
    for name in series {
        let points: Vec<(f64, f64)> =
            joined(sweep, name).filter_map(|member| point(means, member, unit)).collect();
        if let Some(end) = points.last()
            && series.len() > 1
            && series.len() <= MOST_LABELLED
        {
            drawn.notes.push(Note { at: *end, text: format!("{abbreviation}, {name}"), beside: true });
        }
        let shown = line_colour(sweep, name, THEORY);
        let line = Curve { joined: sweep.is_joined(), ..curve(theory, name, points, shown, stroke) };
        any |= !line.points.is_empty();
        marked |= line.is_marked();
        lined |= line.points.len() > 1;
        drawn.curves.push(line);
    }
    if any {
        let joined = sweep.is_joined() && lined;
        drawn.key.push(KeyEntry { joined, ..entry(text, THEORY, Some(stroke), marked) });
    }
    Ok(())
}

/// Means of a result, by its column and the factor of its values, with error bars, or with crosses where
/// there are too few surfaces for these.
fn measure(
    tables: &Tables<'_>,
    sweep: &Sweep,
    series: &[&str],
    of: &Measured,
    (source, unit): (&str, Unit<'_>),
    drawn: &mut Drawn,
) -> Result<(), FigureError> {
    let Measured { name, text, stroke, positive } = *of;
    let column = |end: &str| tables.cases.f64_or_null(&format!("{source}_{end}"));
    let (means, sds) = (column("mean")?, column("sd")?);
    let (mut spread, mut lined) = (false, false);
    for series_name in series {
        let members: Vec<&Member> =
            joined(sweep, series_name).filter(|member| point(means, member, unit).is_some()).collect();
        let points: Vec<(f64, f64)> =
            members.iter().filter_map(|member| point(means, member, unit)).collect();
        if let Some(end) = points.last()
            && series.len() > 1
        {
            drawn.notes.push(Note { at: *end, text: (*series_name).to_owned(), beside: true });
        }
        let (mut errors, mut crosses, mut hues) = (Vec::new(), Vec::new(), Vec::new());
        for member in &members {
            let values = singles(tables.cases, tables.realizations, member.row, source)?;
            let (few, scale) = (values.len() < FEW, unit(member.row).unwrap_or(1.0));
            errors.push(sds.get(member.row).copied().flatten().filter(|_| !few).map(|sd| scale * sd));
            // The mark of one surface is its mean.
            let own =
                values.iter().filter(|_| few && values.len() > 1).map(|value| (member.x, scale * value));
            crosses.extend(own);
            hues.resize(crosses.len(), member.colour.clone());
        }
        spread |= errors.iter().any(Option::is_some);
        lined |= points.len() > 1;
        let shown = line_colour(sweep, series_name, NEUTRAL);
        let mean = curve(name, series_name, points, shown.clone(), stroke);
        let mark_colours = members.iter().map(|member| member.colour.clone()).collect();
        drawn.curves.push(Curve {
            errors,
            positive,
            marked: true,
            mark_colours,
            joined: sweep.is_joined(),
            ..mean
        });
        if !crosses.is_empty() {
            let single = curve(&format!("{name}_single"), series_name, crosses, shown, Stroke::Crosses);
            drawn.curves.push(Curve { mark_colours: hues, ..single });
        }
    }
    let text = if spread { format!("{text}, ± one standard deviation") } else { text.to_owned() };
    let sample = entry(&text, NEUTRAL, Some(stroke), true);
    let colour = lone(sweep).map_or(sample.colour, |member| member.colour.clone());
    drawn.key.push(KeyEntry { colour, joined: sweep.is_joined() && lined, ..sample });
    Ok(())
}

/// The only finished member.
fn lone(sweep: &Sweep) -> Option<&Member> {
    let mut finished = sweep.members.iter().filter(|member| member.is_finished);
    finished.next().filter(|_| finished.next().is_none())
}

fn point(means: &[Option<f64>], member: &Member, unit: Unit<'_>) -> Option<(f64, f64)> {
    let mean = means.get(member.row).copied().flatten()? * unit(member.row)?;
    member.x.is_finite().then_some((member.x, mean))
}
