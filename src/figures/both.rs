//! Contact of one surface at one load by both methods.

use super::axis::Axis;
use super::curve::{Stroke, XyPlot};
use super::drawing::Drawing;
use super::map::{ABOVE, GAP, LEGEND, SIDE, circles, legend, scale_bar, sheet};
use super::panels::Panel;
use super::style::{COMPRESSION, OTHER, RESULT, TENSION, THEORY, curve, plot, shade};
use super::{FigureError, markup};
use crate::store::{Frame, LoopMaps};
use ndarray::ArrayView2;
use std::fmt::Write as _;

/// Cells of the contact of boundary elements along a side, at most.
const CELLS: usize = 150;

/// Content of the figure.
pub struct Both<'a> {
    /// Heights of the surface \[m\], rows along x.
    pub heights_m: ArrayView2<'a, f64>,
    /// Side of the square \[m\].
    pub length_m: f64,
    /// True if the asperity model is periodic.
    pub periodic: bool,
    /// Contact spots of the asperity model.
    pub contacts: &'a Frame,
    /// Step of the load reversal of the asperity model.
    pub step: i64,
    /// Contact area A/A0 of both.
    pub areas: [f64; 2],
    /// Contact by boundary elements, on the same square.
    pub elements: &'a LoopMaps,
}

/// Contact spots of the asperity model and the contact of boundary elements over the heights, side by side.
///
/// # Errors
/// If a table lacks a column.
pub fn both(of: &Both<'_>, caption: String) -> Result<Drawing, FigureError> {
    let (width, height) = (2.0 * SIDE + 3.0 * GAP, SIDE + ABOVE + GAP + LEGEND);
    let (spots, _) = circles(of.contacts, of.length_m, of.periodic, of.step)?;
    let mut svg = sheet(width, height, "both", of.heights_m);
    let contact = cells(of.elements);
    let maps = [("Asperity model", &spots), ("Boundary elements", &contact)];
    for (k, ((name, drawn), area)) in maps.into_iter().zip(of.areas).enumerate() {
        let left = GAP + k as f64 * (SIDE + GAP);
        // Writing to a string cannot fail.
        let _ = write!(
            svg,
            "<text x=\"{left}\" y=\"{}\" font-size=\"14\">{name}: A/A_{{0}} = {area:.3}</text>\
             <g transform=\"translate({left} {})\"><g clip-path=\"url(#both-edge)\">\
             <use xlink:href=\"#both-heights\"/>{drawn}</g>\
             <rect x=\"0\" y=\"0\" width=\"{SIDE}\" height=\"{SIDE}\" fill=\"none\" stroke=\"black\"/>{}</g>",
            ABOVE - 12.0,
            ABOVE - 4.0,
            scale_bar(of.length_m)
        );
    }
    svg += &legend(height - LEGEND + 14.0, of.heights_m);
    Ok(Drawing::new("contact_maps", caption, &markup::render(&svg)))
}

/// Cells in compression and in tension, a path for each.
fn cells(of: &LoopMaps) -> String {
    let map = &of.reversal;
    let points = map.pressure_pa.nrows();
    let cells = CELLS.min(points);
    let sign = |i: usize, j: usize| {
        let at = [(2 * i + 1) * points / (2 * cells), (2 * j + 1) * points / (2 * cells)];
        let touches = f64::from(map.gap_m[at]) < of.contact_gap_m;
        if map.pressure_pa[at] > 0.0 { 1 } else { -i8::from(touches) }
    };
    let size = SIDE / cells as f64;
    let mut svg = String::new();
    for (hue, wanted) in [(COMPRESSION, 1), (TENSION, -1)] {
        let _ = write!(svg, "<path fill=\"{hue}\" fill-opacity=\"0.85\" d=\"");
        for j in 0..cells {
            let mut i = 0;
            while i < cells {
                let from = i;
                while i < cells && sign(i, j) == wanted {
                    i += 1;
                }
                if i > from {
                    let (x, y, w) =
                        (from as f64 * size, SIDE - (j + 1) as f64 * size, (i - from) as f64 * size);
                    let _ = write!(svg, "M{x:.2} {y:.2}h{w:.2}v{size:.2}h-{w:.2}z");
                }
                i += 1;
            }
        }
        svg.push_str("\"/>");
    }
    svg
}

/// Ratios of the asperity model to boundary elements over
/// `U_el/Δγ`, a point for each row of the table `methods`; nothing where that has one value only.
///
/// # Errors
/// If the table lacks a column.
pub fn method_ratios(methods: &Frame) -> Result<Option<Panel>, FigureError> {
    let x = methods.f64_or_null("persson_tosatti_realised")?;
    let columns = [
        ("A", "area_at_max_load", THEORY, Stroke::Points),
        ("F_{po}", "pull_off_load", RESULT, Stroke::Crosses),
        ("Θ", "loss", OTHER, Stroke::Diamonds),
    ];
    let mut curves = Vec::new();
    for (name, column, hue, stroke) in columns {
        let ratios = methods.f64_or_null(&format!("{column}_ratio"))?;
        let points =
            x.iter().zip(ratios).filter_map(|(x, ratio)| x.zip(ratio.filter(|ratio| *ratio > 0.0))).collect();
        curves.push(curve(name, "", points, shade(hue, 0, 1), stroke));
    }
    let points = || curves.iter().flat_map(|curve| curve.points.iter().copied());
    let (low, high) =
        points().fold((f64::INFINITY, 0.0_f64), |(low, high), point| (low.min(point.0), high.max(point.0)));
    if low * 1.5 > high {
        return Ok(None);
    }
    let axes = (
        Axis::of_decades("U_{el}/Δγ", points().map(|point| point.0)),
        Axis::of_decades("asperity model/boundary elements", points().map(|point| point.1))
            .with_headroom(0.06),
    );
    let key = columns.map(|(name, _, hue, stroke)| (name, hue, stroke));
    let drawn = plot("ratio of the methods on each surface".to_owned(), axes.0, axes.1, curves, &key);
    let drawn = XyPlot { stem: "method_ratios".to_owned(), ..drawn };
    let caption = "Area, pull-off force and dissipated energy of the asperity model over those of boundary \
                   elements, each surface a point. Table methods: area_at_max_load_ratio, \
                   pull_off_load_ratio, loss_ratio over persson_tosatti_realised.";
    Ok(Some(Panel::alone("ratios", caption.to_owned(), drawn)))
}
