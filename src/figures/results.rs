//! Panels B, D and E: what a cycle comes to, over what varies.

use super::FigureError;
use super::axis::Axis;
use super::plot::{Curve, Note, Stroke, XyPlot};
use super::style::{MOST_NOTES, THEORY, curve, entry, shade};
use super::sweep::{Member, Sweep};
use crate::store::Frame;

/// A result to be drawn, and how.
#[derive(Debug, Clone, Copy)]
pub(super) struct Measured {
    /// A column of the table `cases` without `_mean`.
    pub(super) name: &'static str,
    pub(super) text: &'static str,
    pub(super) hue: [u8; 3],
    pub(super) stroke: Stroke,
}

/// Results of every member with their error bars, and predictions of them.
pub(super) fn results(
    table: &Frame,
    sweep: &Sweep,
    label: &str,
    measured: &[Measured],
    theories: &[(&str, Stroke, &str)],
) -> Result<XyPlot, FigureError> {
    let mut series: Vec<&str> = sweep.members.iter().map(|member| member.series.as_str()).collect();
    series.sort_unstable();
    series.dedup();
    // If only the turning point varies, it is what is joined, and no other line.
    let joined = |member: &Member, name: &str| sweep.differing.is_empty() || member.series == name;
    if sweep.differing.is_empty() {
        series.truncate(1);
    }
    let (mut curves, mut key, mut notes) = (Vec::new(), Vec::new(), Vec::new());
    for (theory, stroke, text) in theories {
        let (means, mut any) = (table.f64_or_null(&format!("{theory}_mean"))?, false);
        for (at, name) in series.iter().enumerate() {
            let points: Vec<(f64, f64)> =
                sweep.members.iter().filter(|member| joined(member, name)).filter_map(|member| point(means, member)).collect();
            any |= !points.is_empty();
            curves.push(curve((theory, name), points, shade(THEORY, at, series.len()), *stroke));
        }
        if any {
            key.push(entry(text, THEORY, Some(*stroke), false));
        }
    }
    let mut samples = Vec::new();
    for Measured { name, text, hue, stroke } in measured {
        let (means, sds) = (table.f64_or_null(&format!("{name}_mean"))?, table.f64_or_null(&format!("{name}_sd"))?);
        let mut spread = false;
        for (at, of) in series.iter().enumerate() {
            let members: Vec<&Member> =
                sweep.members.iter().filter(|member| joined(member, of) && point(means, member).is_some()).collect();
            let points: Vec<(f64, f64)> = members.iter().filter_map(|member| point(means, member)).collect();
            if let Some(end) = points.last()
                && series.len() > 1
                && at % series.len().div_ceil(MOST_NOTES) == 0
            {
                notes.push(Note { at: *end, text: (*of).to_owned(), beside: true });
            }
            let errors: Vec<Option<f64>> = members.iter().map(|member| sds.get(member.row).copied().flatten()).collect();
            spread |= errors.iter().any(Option::is_some);
            let (name, of) = ((*name).to_owned(), (*of).to_owned());
            curves.push(Curve {
                name,
                of,
                band: false,
                points,
                errors,
                colour: shade(*hue, at, series.len()),
                stroke: *stroke,
                marked: true,
            });
        }
        let text = if spread { format!("{text}, ± one standard deviation") } else { (*text).to_owned() };
        samples.push(entry(&text, *hue, Some(*stroke), true));
    }
    key.splice(0..0, samples);
    let ends = |curve: &Curve| -> Vec<f64> {
        let bars = curve.points.iter().zip(curve.errors.iter().copied().chain(std::iter::repeat(None)));
        bars.flat_map(|((_, y), error)| [y - error.unwrap_or_default(), y + error.unwrap_or_default()]).collect()
    };
    let room = 0.07 * key.len() as f64 + 0.04;
    let y = Axis::holding(label, curves.iter().flat_map(ends), true).with_headroom(room);
    Ok(XyPlot { stem: String::new(), letter: ' ', title: String::new(), x: sweep.axis.clone(), y, curves, key, notes })
}

fn point(means: &[Option<f64>], member: &Member) -> Option<(f64, f64)> {
    let mean = means.get(member.row).copied().flatten()?;
    member.x.is_finite().then_some((member.x, mean))
}
