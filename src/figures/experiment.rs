//! Measured loops and a simulated one, in newtons and metres.

use super::FigureError;
use super::axis::Axis;
use super::captions;
use super::curve::{Curve, Stroke, XyPlot};
use super::panels::Panel;
use super::style::{RESULT, case_colour, curve, entry, plot, shade};
use crate::store::Frame;

/// Name of the panel in the table of panels.
const NAME: &str = "measured_loops";
/// Most points of a branch that are drawn.
const MOST_POINTS: usize = 1000;

/// A simulated loop.
#[derive(Debug, Clone, Copy)]
pub struct Simulated<'a> {
    /// Load reversal, `F/(E* A0)`.
    pub max_load: f64,
    /// Parameters of the case, for the caption.
    pub parameters: &'a str,
    /// Steps.
    pub steps: &'a Frame,
}

/// Load over penetration of all measured loops, and of a simulated one if there is one.
///
/// # Errors
/// If a table lacks a column.
pub fn measured_loops(measured: &Frame, simulated: Option<&Simulated<'_>>) -> Result<Panel, FigureError> {
    let mut curves: Vec<Curve> = Vec::new();
    let mut key = Vec::new();
    if let Some(of) = simulated {
        curves.extend(of_simulated(of)?);
        key.push(entry("simulated", RESULT, Some(Stroke::Solid), false));
    }
    let sources = measured.text("source")?;
    let mut names: Vec<&str> = Vec::new();
    for source in &sources {
        if names.last() != Some(source) {
            names.push(source);
        }
    }
    for (place, name) in names.iter().enumerate() {
        let colour = case_colour(place + 1, 0, 1);
        let own = of_measured(measured, name, &colour)?;
        let mut named = entry(name, RESULT, Some(Stroke::Solid), false);
        named.colour.clone_from(&colour);
        key.push(named);
        curves.extend(own);
    }
    let all = || curves.iter().flat_map(|curve| &curve.points);
    let x = Axis::holding("δ [m]", all().map(|point| point.0), false);
    let y = Axis::holding("F [N]", all().map(|point| point.1), true).with_headroom(0.1);
    let beside = simulated.map_or_else(String::new, |of| format!(" Simulated: {}.", of.parameters));
    let caption = format!(
        "Normal force F against penetration δ of measured loops, baseline subtracted; loading dashed, \
         unloading solid. δ = 0 at the first contact on approach; for the simulated loop, where the highest \
         point touches. At \
         most {MOST_POINTS} points of each branch are drawn.{beside}{}",
        captions::data(NAME)
    );
    let plot = XyPlot { stem: NAME.to_owned(), key, ..plot(String::new(), x, y, curves, &[]) };
    Ok(Panel::alone(NAME, caption, plot))
}

fn of_simulated(of: &Simulated<'_>) -> Result<[Curve; 2], FigureError> {
    let (branches, max_loads) = (of.steps.text("branch")?, of.steps.f64_or_null("max_load")?);
    let (ways, loads) = (of.steps.f64("approach_m")?, of.steps.f64("load_n")?);
    let reversal = of.steps.f64_or_null("reversal_load")?.iter().position(|load| *load == Some(of.max_load));
    let points = |fits: &dyn Fn(usize) -> bool| -> Vec<(f64, f64)> {
        (0..branches.len()).filter(|k| fits(*k)).map(|k| (ways[k], loads[k])).collect()
    };
    // Loading continues beyond a load reversal that is not the last one.
    let loading = points(&|k| branches[k] == "loading" && reversal.is_none_or(|last| k <= last));
    let mut unloading = points(&|k| branches[k] == "unloading" && max_loads[k] == Some(of.max_load));
    unloading.splice(0..0, reversal.map(|k| (ways[k], loads[k])));
    let colour = || shade(RESULT, 0, 1);
    Ok([
        curve("loading", "simulated", loading, colour(), Stroke::Dashed),
        curve("unloading", "simulated", unloading, colour(), Stroke::Solid),
    ])
}

fn of_measured(frame: &Frame, source: &str, colour: &str) -> Result<[Curve; 2], FigureError> {
    let (sources, branches) = (frame.text("source")?, frame.text("branch")?);
    let (ways, loads) = (frame.f64("approach_m")?, frame.f64("load_n")?);
    let of = |branch: &str, stroke: Stroke| {
        let rows = (0..ways.len()).filter(|k| sources[*k] == source && branches[*k] == branch);
        let all: Vec<(f64, f64)> = rows.map(|k| (ways[k], loads[k])).collect();
        let every = all.len().div_ceil(MOST_POINTS).max(1);
        let drawn = all.into_iter().step_by(every).collect();
        curve(branch, source, drawn, colour.to_owned(), stroke)
    };
    Ok([of("loading", Stroke::Dashed), of("unloading", Stroke::Solid)])
}
