//! The five panels of a sweep: the four of the paper, and the dissipated energy by branch.

use super::FigureError;
use super::captions::{data, of_sweep, of_sweeps};
use super::curve::{Stroke, XyPlot};
use super::markup::described;
use super::notes::shared;
use super::paths::paths;
use super::plot::{plot_xy, width_beside};
use super::results::{Measured, Predicted, results};
use super::sizes::sizes;
use super::sweep::{Member, Sweep, Tables};
use super::units::{Quantity, Scales, Units};
use crate::stats::sweeps;
use crate::store::Frame;
use crate::text::counted;

/// A panel that has been drawn.
#[derive(Debug, Clone)]
pub struct Panel {
    /// Stem of its file's name.
    pub stem: String,
    /// Letter with the ending of its units, or its word.
    pub name: String,
    /// Units; those of a panel of a single cycle are dimensionless.
    pub units: Units,
    /// Caption.
    pub caption: String,
    /// Labels and colours of the cases of a sweep.
    pub cases: Vec<(String, String)>,
    /// The drawing.
    pub svg: String,
    /// Contents of the plot.
    pub plot: XyPlot,
}

impl Panel {
    /// A dimensionless panel of no sweep; its plot has the stem of its file.
    pub(super) fn alone(name: &str, caption: String, plot: XyPlot) -> Self {
        Self {
            stem: plot.stem.clone(),
            name: name.to_owned(),
            units: Units::Dimensionless,
            cases: Vec::new(),
            svg: described(&plot_xy(&plot), &caption),
            caption,
            plot,
        }
    }
}

/// Draws the panels of one sweep, or of several whose names are joined by `+`: `<sweep>_A` area over load,
/// `<sweep>_B` pull-off force, `<sweep>_C` penetration over load, `<sweep>_D` dissipated energy, with the
/// prediction of Deng and Kesari, `<sweep>_E` its fraction on each branch, `<sweep>_F` the sizes of
/// avalanches; in other units with an ending.
///
/// The horizontal axis of B, D and E is the parameter that varies; if only the load reversal varies, it is
/// the area at the end of loading. If several parameters vary, the one with most values is the axis, the
/// others are series with a colour each, and A and C have a panel for each value of the axis (`A`, `A2`, …).
/// Of several loads of such cases the largest is drawn. Lines join only cases that differ in nothing else. A
/// case without finished realizations has no curve and no point. Error bars and bands are one standard
/// deviation; for quantities that cannot be negative, they end at 0. Results of fewer than five surfaces have
/// crosses at the single surfaces instead of bars.
///
/// A sweep without a finished realization has no panels.
///
/// # Errors
/// If no case belongs to the sweep, or a table lacks a column.
pub fn panels(tables: &Tables<'_>, sweep: &str, units: Units) -> Result<Vec<Panel>, FigureError> {
    let found = Sweep::find(tables, sweep)?;
    if found.members.iter().all(|member| !member.is_finished) {
        return Ok(Vec::new());
    }
    let stem: String = if sweep.is_empty() { "run" } else { sweep }
        .chars()
        .map(|letter| match letter {
            '+' => '-',
            letter if letter.is_ascii_alphanumeric() || letter == '-' => letter,
            _ => '_',
        })
        .collect();
    let mut panels = drawn(tables, &found, &stem, units)?;
    let name = if sweeps(tables.cases)?.len() > 1 { of_sweeps(sweep) } else { String::new() };
    panels.iter_mut().for_each(|panel| panel.caption += &format!("{name}{}", data(&panel.name)));
    Ok(panels)
}

/// Draws the same panels of one case in several campaigns: the tables hold a row of it, and its paths, for
/// each, and `labels` are what the campaigns are called, in the order of the rows.
///
/// # Errors
/// If a table lacks a column.
pub fn compared(tables: &Tables<'_>, labels: &[String], stem: &str) -> Result<Vec<Panel>, FigureError> {
    drawn(tables, &Sweep::side_by_side(tables.cases, labels)?, stem, Units::Dimensionless)
}

fn drawn(tables: &Tables<'_>, found: &Sweep, stem: &str, units: Units) -> Result<Vec<Panel>, FigureError> {
    let (surfaces, failures) = (surfaces(tables.cases, found)?, failures(tables.cases, found)?);
    let scales = Scales::of(tables, found, units)?;
    let mut plots = plots(tables, found, &scales)?;
    // Surfaces of different size have no common scale.
    plots.retain(|(_, plot)| {
        units == Units::Dimensionless || plot.curves.iter().any(|curve| !curve.points.is_empty())
    });
    plots.iter_mut().for_each(|(_, plot)| plot.notes = shared(plot));
    // Adjacent panels have the same size.
    let margin = plots.iter().map(|(_, plot)| width_beside(plot)).fold(0.0, f64::max);
    // Where only the load varies, labels are numbers.
    let named = |member: &Member| match (member.label.as_str(), found.differing.is_empty()) {
        ("", _) => "simulation".to_owned(),
        (load, true) => format!("F_{{max}}/(E*A_{{0}}) = {load}"),
        (label, false) => label.to_owned(),
    };
    let mut cases: Vec<(String, String)> = Vec::new();
    for member in found.members.iter().filter(|member| member.is_finished) {
        let label = if found.has_facets { member.series.clone() } else { named(member) };
        if !cases.iter().any(|(known, _)| *known == label) {
            cases.push((label, member.colour.clone()));
        }
    }
    let panel = |(name, plot): (String, XyPlot)| {
        let letter = name.chars().next().unwrap_or(' ');
        let name = format!("{name}{}", units.ending());
        let stem = format!("{stem}_{name}");
        let plot = XyPlot { letter, stem: stem.clone(), margin, ..plot };
        let caption = of_sweep(letter, found, &surfaces, (&plot, &scales)) + &failures;
        Panel {
            stem,
            name,
            units,
            svg: described(&plot_xy(&plot), &caption),
            caption,
            cases: cases.clone(),
            plot,
        }
    };
    Ok(plots.into_iter().map(panel).collect())
}

/// The contents of the panels, by letter.
fn plots(
    tables: &Tables<'_>,
    found: &Sweep,
    scales: &Scales<'_>,
) -> Result<Vec<(String, XyPlot)>, FigureError> {
    // Releasing absorbed asperities has no potential, so that one branch may gain energy.
    let branch = |name, text, stroke| Measured { name, text, stroke, positive: false };
    let computed =
        |name: &'static str| Measured { name, text: "simulation", stroke: Stroke::Solid, positive: true };
    let mut theories = vec![
        Predicted {
            name: "loss_dk",
            stroke: Stroke::Dashed,
            text: "Deng–Kesari, target spectrum",
            abbreviation: "DK target",
        },
        Predicted {
            name: "loss_dk_realised",
            stroke: Stroke::Dotted,
            text: "Deng–Kesari, realised spectrum",
            abbreviation: "DK realised",
        },
    ];
    let radii = tables.cases.f64_or_null("probe_radius_m")?;
    let is_probe = |member: &Member| radii.get(member.row).copied().flatten().is_some();
    if found.members.iter().all(is_probe) {
        // Deng and Kesari's own estimate of a probe.
        theories = vec![
            Predicted {
                name: "loss_dk_probe",
                stroke: Stroke::Dashed,
                text: "Deng–Kesari, R_{tip} = R, target spectrum",
                abbreviation: "DK target",
            },
            Predicted {
                name: "loss_dk_probe_realised",
                stroke: Stroke::Dotted,
                text: "Deng–Kesari, R_{tip} = R, realised spectrum",
                abbreviation: "DK realised",
            },
        ];
    }
    let branches = [
        branch("dissipated_unloading", "unloading", Stroke::Solid),
        branch("dissipated_loading", "loading", Stroke::Dashed),
    ];
    let of_path = |column: &str, quantity| paths(tables.curves, found, column, (quantity, scales));
    let of_results = |letter: &str, quantity, measured: &[Measured], theories: &[Predicted]| {
        results(tables, found, (quantity, scales), measured, theories)
            .map(|plot| vec![(letter.to_owned(), plot)])
    };
    Ok([
        numbered("A", of_path("area", Quantity::Area)?),
        of_results("B", Quantity::PullOff, &[computed("pull_off_load")], &[])?,
        numbered("C", of_path("penetration", Quantity::Penetration)?),
        of_results("D", Quantity::Loss, &[computed("loss")], &theories)?,
        of_results("E", Quantity::Loss, &branches, &[])?,
        numbered("F", sizes(tables, found, scales.units())?),
    ]
    .concat())
}

/// Plots of one letter with names: `A`, `A2`, …
fn numbered(letter: &str, plots: Vec<XyPlot>) -> Vec<(String, XyPlot)> {
    let name = |k| if k == 0 { letter.to_owned() } else { format!("{letter}{}", k + 1) };
    plots.into_iter().enumerate().map(|(k, plot)| (name(k), plot)).collect()
}

/// Cases of a sweep without a finished cycle, as a sentence; empty if there are none.
fn failures(cases: &Frame, sweep: &Sweep) -> Result<String, FigureError> {
    let failed = cases.i64("failed_count")?;
    let count = |fits: &dyn Fn(&Member) -> bool| {
        let mut ids: Vec<&str> = sweep
            .members
            .iter()
            .filter(|member| fits(member))
            .map(|member| member.case_id.as_str())
            .collect();
        ids.sort_unstable();
        ids.dedup();
        ids.len()
    };
    let all = counted(count(&|_| true), "case");
    let sentence = |number: usize, state: &str| match number {
        0 => String::new(),
        _ => format!(" {number} of {all} {state}: not drawn."),
    };
    let text = sentence(count(&|of| !of.is_finished && failed[of.row] > 0), "failed");
    Ok(text + &sentence(count(&|of| !of.is_finished && failed[of.row] == 0), "not computed"))
}

/// Number of surfaces of the means of a sweep.
fn surfaces(cases: &Frame, sweep: &Sweep) -> Result<String, FigureError> {
    let done = cases.i64("done_count")?;
    let counts = || sweep.members.iter().filter_map(|member| done.get(member.row));
    let (least, most) =
        (counts().min().copied().unwrap_or_default(), counts().max().copied().unwrap_or_default());
    Ok(match (least, most) {
        (_, 0) => "no surface finished".to_owned(),
        (1, 1) => "one surface".to_owned(),
        (0, 1) => "at most one surface".to_owned(),
        (0, _) => format!("mean of up to {most} surfaces"),
        _ if least == most => format!("mean of {most} surfaces"),
        _ => format!("mean of {least} to {most} surfaces"),
    })
}
