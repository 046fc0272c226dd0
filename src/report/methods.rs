//! Part of the report: both methods on the same surfaces.

use super::cases::Cases;
use super::layout::{Numbers, figure, grid, heading, prose, unbroken, wide};
use super::numbers::{Scale, Shown, scaled, shown};
use crate::figures::{Drawing, Panel};
use crate::stats::{MethodPair, StatsError, labels, method_pairs, names_of_pairs};
use crate::store::Frame;
use maud::{Markup, html};

/// Heading and column of the compared quantities, in the order of [`method_pairs`].
const QUANTITIES: [(&str, &str); 3] =
    [("A/A_{0}", "area_at_max_load"), ("F_{po}/(E*A_{0})", "pull_off_load"), ("Θ/(E*A_{0}h_{rms})", "loss")];

/// Figures of both methods: ratios over U_el/Δγ, and contact on one surface.
#[derive(Debug, Clone, Default)]
pub struct MethodFigures {
    /// Ratios of the asperity model to boundary elements.
    pub ratios: Option<Panel>,
    /// Contact maps.
    pub maps: Option<Drawing>,
}

const NOTE: &str = "Means over the surfaces that both methods have finished, and the ratio of the asperity \
    model to boundary elements on the same surface: mean ± standard deviation. The table \
    `statistics/methods.parquet` holds each surface and the 95 % confidence intervals.";

/// A table of the means of both methods and their ratios; empty without cases of the same surfaces by both
/// methods.
pub(super) fn side_by_side(
    cases: &Cases<'_>,
    methods: &Frame,
    figures: &MethodFigures,
    numbers: &Numbers<'_>,
) -> Result<Markup, StatsError> {
    let pairs = method_pairs(methods)?;
    if pairs.is_empty() {
        return Ok(Markup::default());
    }
    let mut scales = Vec::new();
    for (_, column) in QUANTITIES {
        scales.push(cases.scale(column)?);
    }
    let names = names_of_pairs(cases.frame, &pairs)?;
    let loads = labels(&pairs.iter().map(|pair| pair.max_load).collect::<Vec<f64>>());
    let rows: Vec<Markup> = pairs
        .iter()
        .zip(names.iter().zip(&loads))
        .map(|(pair, (name, load))| row(pair, [name, load], &scales))
        .collect();
    Ok(html! {
        (heading("Asperity model and boundary elements"))
        p { (prose(NOTE)) } "\n"
        (wide("methods", &head(&scales), &rows))
        @if let Some(ratios) = &figures.ratios { (grid(numbers, [ratios])) }
        @if let Some(maps) = &figures.maps { (figure(numbers, maps)) }
    })
}

fn head(scales: &[Scale]) -> Markup {
    html! {
        th { "case" }
        th { (prose("F_{max}/(E*A_{0})")) }
        th { "surfaces" }
        @for ((heading, _), scale) in QUANTITIES.iter().zip(scales) {
            th { (prose(heading)) (scale.head()) ", asperities" }
            th { (prose(heading)) (scale.head()) ", boundary elements" }
            th { "ratio" }
        }
    }
}

fn row(pair: &MethodPair, [name, load]: [&str; 2], scales: &[Scale]) -> Markup {
    html! {
        td { (unbroken(name)) }
        td { (load) }
        td { (pair.count) }
        @for ([asperities, elements, ratio, sd], scale) in pair.quantities.into_iter().zip(scales) {
            td { (scaled(asperities, *scale)) }
            td { (scaled(elements, *scale)) }
            td {
                (shown(ratio, Shown::Plain))
                @if sd.is_some() { " " small { "±\u{a0}" (shown(sd, Shown::Plain)) } }
            }
        }
    }
}
