//! Loop and contact maps of a cycle by boundary elements.

use super::closer::of_loop;
use super::curve::{Curve, Note, Stroke, XyPlot};
use super::drawing::Drawing;
use super::elements_map::map;
use super::hysteresis::{of_branches, on_both};
use super::panels::Panel;
use super::style::{RESULT, THEORY, curve, entry, shade};
use super::{FigureError, captions};
use crate::store::{Frame, LoopMaps};

/// Name of the panel in the table of panels.
const NAME: &str = "elements_loop";

/// A loop by boundary elements.
#[derive(Debug, Clone, Copy)]
pub struct ElementsLoop<'a> {
    /// The load reversal, `F/(E* A0)`.
    pub max_load: f64,
    /// The parameters of the case, for the captions.
    pub parameters: &'a str,
    /// Steps.
    pub steps: &'a Frame,
    /// Maps at its ends; nothing where none are stored.
    pub maps: Option<&'a LoopMaps>,
}

/// The loop with its area Θ and the pull-off force, and the contact with its pressure at the load reversal
/// and at pull-off.
///
/// # Errors
/// If a table lacks a column.
pub fn elements_loop(of: &ElementsLoop<'_>) -> Result<(Vec<Panel>, Option<Drawing>), FigureError> {
    let plot = XyPlot { stem: NAME.to_owned(), ..marked(of_loop(of.steps, of.max_load)?) };
    let caption = format!(
        "Normal force F/(E*A₀) against mean penetration Δ/h_rms up to the load reversal and back by boundary \
         elements, for {}. Shaded: dissipated energy Θ/(E*A₀h_rms). Dotted: pull-off force F_po/(E*A₀).{}",
        of.parameters,
        captions::data(NAME)
    );
    let more = of_branches(&plot).into_iter().map(|(name, plot)| of_elements(name, of.parameters, plot));
    let panels = more.collect::<Vec<Panel>>();
    let panels = std::iter::once(Panel::alone(NAME, caption, plot)).chain(panels).collect();
    Ok((panels, of.maps.map(|maps| map(of.parameters, of.steps, maps)).transpose()?))
}

/// A further panel of a loop.
fn of_elements(name: &str, parameters: &str, plot: XyPlot) -> Panel {
    let name = format!("elements_{name}");
    let caption = format!(
        "{} by boundary elements, for {parameters}.{}",
        captions::of_branches(name.trim_start_matches("elements_")),
        captions::data(&name)
    );
    Panel::alone(&name, caption, XyPlot { stem: name.clone(), ..plot })
}

/// The plot of a loop with its area and its pull-off force.
fn marked(mut plot: XyPlot) -> XyPlot {
    let [loading, unloading] = &plot.curves[..] else { return plot };
    let area = area(&loading.points, &unloading.points);
    let lowest =
        unloading.points.iter().copied().min_by(|u, v| u.1.total_cmp(&v.1)).filter(|point| point.1 < 0.0);
    plot.key.push(entry("Θ/(E^{*}A_{0}h_{rms})", RESULT, Some(Stroke::Area), true));
    if let Some((at, load)) = lowest {
        plot.curves.push(curve(
            "pull_off",
            "",
            vec![(at, 0.0), (at, load)],
            shade(THEORY, 0, 1),
            Stroke::Dotted,
        ));
        plot.notes.push(Note { at: (at, 0.08 * load), text: "F_{po}".to_owned(), beside: false });
    }
    // Last, so that the other curves keep their numbers in the table of panels.
    plot.curves.push(area);
    plot
}

/// The area between loading and unloading. Before the first contact and after the last separation the load is
/// zero.
fn area(loading: &[(f64, f64)], unloading: &[(f64, f64)]) -> Curve {
    let ends = on_both(loading, unloading);
    let points = ends.iter().map(|(x, up, down)| (*x, 0.5 * (up + down))).collect();
    let errors = ends.iter().map(|(_, up, down)| Some(0.5 * (up - down).abs())).collect();
    Curve { errors, band: true, ..curve("area", "", points, shade(RESULT, 0, 1), Stroke::Area) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn law_the_shaded_area_is_the_work_of_the_loop() {
        // Loading: (0, 0) to (2, 1). Unloading: back to (0, −0.5), then to (−1, 0). By hand: triangles 0.5 ·
        // 0.5 · 2 and 0.5 · 0.5 · 1.
        let (loading, unloading) = ([(0.0, 0.0), (2.0, 1.0)], [(2.0, 1.0), (0.0, -0.5), (-1.0, 0.0)]);
        let area = area(&loading, &unloading);
        let width = |k: usize| 2.0 * area.errors[k].unwrap_or_default();
        let sum: f64 = (1..area.points.len())
            .map(|k| 0.5 * (width(k) + width(k - 1)) * (area.points[k].0 - area.points[k - 1].0))
            .sum();
        assert!((sum - 0.75).abs() < 1e-15, "{sum}");
    }
}
