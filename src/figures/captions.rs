//! Captions of the panels: quantity, cases, statistics, strokes and data.

use super::curve::{Curve, Stroke, XyPlot};
use super::cycle_loop::Closer;
use super::paths::{MOST_FACETS, places};
use super::sweep::{Sweep, said};
use super::units::{Quantity, Scales};
use crate::stats::{Values, significant};
use crate::text::with_one_unit;

/// Values of one parameter that a caption lists; of more, it states the range.
const MOST_VALUES: usize = 8;

/// The caption of a panel of a sweep, by its letter.
pub(super) fn of_sweep(
    letter: char,
    sweep: &Sweep,
    surfaces: &str,
    (plot, scales): (&XyPlot, &Scales<'_>),
) -> String {
    let symbol = |of: Quantity| plain(scales.label(of));
    let (load, loss) = (symbol(Quantity::Load), symbol(Quantity::Loss));
    let axis = plain(&sweep.axis.label);
    let what = match letter {
        'A' => format!("Real contact area {} against normal force {load}", symbol(Quantity::Area)),
        'B' => format!("Pull-off force {} against {axis}", symbol(Quantity::PullOff)),
        'C' => format!("Mean penetration {} against normal force {load}", symbol(Quantity::Penetration)),
        'D' => {
            format!("Dissipated energy {loss} against {axis}, with the estimates of Deng and Kesari")
        }
        'E' => format!("Dissipated energy {loss} of the events of each branch against {axis}"),
        _ => "Number of avalanches per surface whose dissipated energy is at least that of the abscissa; \
              loading dashed, unloading solid"
            .to_owned(),
    };
    let mut parts = vec![format!("{what}{}; {surfaces}", cases(sweep, &plot.title))];
    if !plot.title.is_empty() {
        let values = places(sweep).len();
        if values > MOST_FACETS {
            parts.push(format!(
                "{MOST_FACETS} of {values} values have a panel, and all are in the table curves"
            ));
        }
    }
    if matches!(letter, 'A' | 'C') {
        parts.push("loading dashed, unloading solid".to_owned());
        if surfaces.starts_with("mean") {
            parts.push(
                "below zero load, averaged at equal fractions of the pull-off force of each surface"
                    .to_owned(),
            );
        }
    }
    let curves = || plot.curves.iter();
    if curves().any(|curve| curve.errors.iter().any(Option::is_some)) {
        let what = if matches!(letter, 'A' | 'C') { "bands" } else { "bars" };
        let cut = if curves().any(Curve::is_cut) { ", ending at 0" } else { "" };
        parts.push(format!("{what}: ± one standard deviation{cut}"));
    }
    if curves().any(|curve| curve.stroke == Stroke::Crosses) {
        parts.push("crosses: single surfaces, where there are fewer than five".to_owned());
    }
    format!("{}.", parts.join("; "))
}

/// A label without its unit and without the markup of the figures, but for subscripts of letters.
fn plain(label: &str) -> String {
    let symbol = label.split_once(" [").map_or(label, |(symbol, _)| symbol);
    [("_{0}", "₀"), ("^{*}", "*"), ("_{po}", "_po"), ("_{rms}", "_rms")]
        .into_iter()
        .fold(symbol.to_owned(), |text, (marked, plain)| text.replace(marked, plain))
}

/// Names of sweeps that are joined by `+`, as a sentence of a caption.
pub(super) fn of_sweeps(joined: &str) -> String {
    let plural = if joined.contains('+') { "s" } else { "" };
    format!(" Sweep{plural} {}.", joined.replace('+', ", "))
}

/// Table of the points of a panel of a report.
pub(super) fn data(name: &str) -> String {
    format!(" Data: statistics/panels.parquet (panel {name}).")
}

/// The cases of a panel: `, for ζ = 32, 64`. A panel with the title `ζ = 32` has only those with this value.
fn cases(sweep: &Sweep, title: &str) -> String {
    let own = sweep.differing.len().min(1 + sweep.following);
    let facet = |place: usize| said(&sweep.differing[..own], place).join(", ");
    let shown = |place: &usize| title.is_empty() || facet(*place) == title;
    let mut parts = Vec::new();
    for (at, parameter) in sweep.differing.iter().enumerate() {
        let mut places: Vec<usize> = (0..sweep.members.len()).filter(shown).collect();
        match &parameter.values {
            Values::Numbers(numbers) => places
                .sort_by(|a, b| numbers[*a].unwrap_or(f64::NAN).total_cmp(&numbers[*b].unwrap_or(f64::NAN))),
            Values::Words(words) => places.sort_by(|a, b| words[*a].cmp(&words[*b])),
        }
        let mut texts: Vec<&str> = places
            .into_iter()
            .filter(|place| !parameter.is_absent(*place))
            .map(|place| parameter.text(place))
            .collect();
        texts.dedup();
        let values = match texts[..] {
            [first, .., last] if texts.len() > MOST_VALUES => {
                format!("{} = {first} to {last} ({} values)", parameter.symbol, texts.len())
            }
            _ => format!("{} = {}", parameter.symbol, with_one_unit(&texts)),
        };
        let before = match at {
            0 => ", for ",
            at if at <= sweep.following => " with ",
            _ => "; ",
        };
        parts.push(format!("{before}{values}"));
    }
    parts.concat()
}

/// Caption of a panel of the branches of a loop, by the name of the panel.
pub(super) fn of_branches(name: &str) -> &'static str {
    match name {
        "tension" => "Tensile part of the loop, F/(E*A₀) against Δ/h_rms",
        _ => {
            "Load of loading less that of unloading at the same mean penetration, over E*A₀; its integral \
             over Δ/h_rms is the dissipated energy Θ/(E*A₀h_rms)"
        }
    }
}

/// Caption of a panel of a single cycle, by the name of the panel.
pub(super) fn of_cycle(name: &str, of: &Closer<'_>) -> String {
    let text = match name {
        "loop" => {
            format!(
                "Normal force F/(E*A₀) against mean penetration Δ/h_rms up to the load reversal and \
                 back, for {}",
                of.parameters
            )
        }
        "hysteresis" | "tension" => of_branches(name).to_owned(),
        "events" => {
            "Energy dissipated by each event against mean penetration; events of negative dissipated energy \
             are not drawn on the logarithmic axis"
                .to_owned()
        }
        "avalanches" => "Number of avalanches with at least s events".to_owned(),
        "radii" => "Cumulative distribution of the contact radius over the side L of the square".to_owned(),
        "loads" if of.pull_off_n_m == 0.0 => {
            "Cumulative distribution of the load of each contact spot; positive in compression".to_owned()
        }
        "loads" => "Cumulative distribution of the load of each contact spot over the pull-off force of its \
             asperity, without merged contacts; positive in compression"
            .to_owned(),
        "spectrum" => spectrum(of),
        _ => "Probability density of the summit curvatures, with Nayak's distribution for the realised \
             spectral moments"
            .to_owned(),
    };
    format!("{text}.{}", data(name))
}

fn spectrum(of: &Closer<'_>) -> String {
    let rings = "Radially averaged power spectral density of the heights over rings of wavevectors below the \
                 cut-off, with ∫C d²q = h_rms² (SurfaceTopography: 4π² = 39.48 times C)";
    match of.asked_factor {
        Some(factor) if (factor - 1.0).abs() > 1e-6 => format!(
            "{rings}. The sum of Eq 10 over the discrete wavevectors is {} times the target variance, and \
             the heights are scaled to the target rms height. The realised density therefore follows {} \
             times Eq 10",
            significant(1.0 / factor, 3),
            significant(factor, 3)
        ),
        Some(_) => format!("{rings}, with Eq 10"),
        None => rings.to_owned(),
    }
}
