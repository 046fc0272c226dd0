//! Maps of the contact spots on the surface, at four points of the loop.

use super::cycle_loop::{Closer, Kept};
use super::drawing::Drawing;
use super::style::{COMPRESSION, TENSION};
use super::{FigureError, markup};
use crate::stats::{labels_with_unit, significant};
use crate::store::Frame;
use crate::text::counted;
use ndarray::ArrayView2;
use std::fmt::Write as _;

/// Side of one map, what is between two, and room above each for its words \[pixels\].
pub(super) const SIDE: f64 = 300.0;
pub(super) const GAP: f64 = 16.0;
pub(super) const ABOVE: f64 = 42.0;
/// Height of the legend.
pub(super) const LEGEND: f64 = 46.0;

/// Cells of the heights along a side, and shades of grey.
const CELLS: usize = 75;
const SHADES: usize = 12;

/// Spots on one map, at most: the largest are drawn.
const MOST_SPOTS: usize = 4000;

/// The contact spots at each landmark whose spots were kept, over the heights as shades of grey, the lower
/// the darker, with crosses at the absorbed asperities; nothing where none were kept.
///
/// # Errors
/// If a table lacks a column.
pub(super) fn map(
    of: &Closer<'_>,
    landmarks: &[Kept],
    heights_m: ArrayView2<'_, f64>,
) -> Result<Option<Drawing>, FigureError> {
    if landmarks.is_empty() {
        return Ok(None);
    }
    let (loads, penetrations) = (of.steps.f64("load")?, of.steps.f64("penetration")?);
    let rows = landmarks.len().div_ceil(2) as f64;
    let (width, height) = (2.0 * SIDE + 3.0 * GAP, rows * (SIDE + ABOVE) + GAP + LEGEND);
    let mut svg = sheet(width, height, "map", heights_m);
    let bar = scale_bar(of.length_m);
    for (k, (landmark, step)) in landmarks.iter().enumerate() {
        let (left, top) = (GAP + (k % 2) as f64 * (SIDE + GAP), ABOVE + (k / 2) as f64 * (SIDE + ABOVE));
        let at = usize::try_from(*step).unwrap_or_default();
        let number = |values: &[f64]| values.get(at).copied().unwrap_or(f64::NAN);
        let (spots, count) = circles(of.contacts, of.length_m, of.periodic, *step)?;
        // Writing to a string cannot fail.
        let _ = write!(
            svg,
            "<text x=\"{left}\" y=\"{}\" font-size=\"14\">{}: {}</text>\
             <text x=\"{left}\" y=\"{}\" font-size=\"13\">F/(E^{{*}}A_{{0}}) = {}, Δ/h_{{rms}} = {}</text>\
             <g transform=\"translate({left} {top})\"><g clip-path=\"url(#map-edge)\">\
             <use xlink:href=\"#map-heights\"/>{spots}</g>\
             <rect x=\"0\" y=\"0\" width=\"{SIDE}\" height=\"{SIDE}\" fill=\"none\" \
             stroke=\"black\"/>{bar}</g>",
            top - 23.0,
            landmark.words(),
            counted(count, "contact spot"),
            top - 6.0,
            power(number(&loads)),
            depth(number(&penetrations))
        );
    }
    svg += &legend(height - LEGEND + 14.0, heights_m);
    let caption = format!(
        "Contact spots at {} of the loop, for {}. Circles have the contact radius; where they overlap, A \
         counts the area once for each. Heights from their mean. Table contacts: contact_radius_m, load_n, \
         state.",
        counted(landmarks.len(), "point"),
        of.parameters
    );
    Ok(Some(Drawing::new("closer_map", caption, &markup::render(&svg))))
}

/// A mean penetration over the rms height, with two decimals.
pub(super) fn depth(penetration: f64) -> String {
    format!("{penetration:.2}").replace('-', "−")
}

/// Beginning of an SVG of maps: the heights and the edge of a map are its definitions
/// `<prefix>-heights` and `<prefix>-edge`.
pub(super) fn sheet(width: f64, height: f64, prefix: &str, heights_m: ArrayView2<'_, f64>) -> String {
    format!(
        "<svg viewBox=\"0 0 {width} {height}\" xmlns=\"http://www.w3.org/2000/svg\" \
         xmlns:xlink=\"http://www.w3.org/1999/xlink\" width=\"{width}\" height=\"{height}\" \
         font-family=\"DejaVu Sans, Verdana, Liberation Sans, Arial, sans-serif\" fill=\"black\">\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/><defs><g id=\"{prefix}-heights\">{}</g>\
         <clipPath id=\"{prefix}-edge\">\
         <rect x=\"0\" y=\"0\" width=\"{SIDE}\" height=\"{SIDE}\"/></clipPath></defs>",
        ground(heights_m)
    )
}

/// A number with three digits and, where it is small, a power of ten, with the markup of the figures.
pub(super) fn power(number: f64) -> String {
    let text = significant(number, 3);
    let text = text
        .split_once('e')
        .map_or(text.clone(), |(digits, exponent)| format!("{digits} × 10^{{{exponent}}}"));
    text.replace('-', "−")
}

/// A scale bar and the directions of the axes, in the lower left corner of a map.
pub(super) fn scale_bar(length_m: f64) -> String {
    // The largest of 1, 2 and 5 times a power of ten that is at most a quarter of the side.
    let power = 10f64.powf((0.25 * length_m).log10().floor());
    let bar = [5.0, 2.0, 1.0]
        .into_iter()
        .map(|factor| factor * power)
        .find(|bar| *bar <= 0.25 * length_m * (1.0 + 1e-9))
        .unwrap_or(power);
    let (width, foot) = (SIDE * bar / length_m, SIDE - 8.0);
    let text = labels_with_unit("length_m", &[bar]).concat();
    format!(
        "<rect x=\"4\" y=\"{}\" width=\"{:.2}\" height=\"36\" fill=\"white\" fill-opacity=\"0.85\"/>\
         <rect x=\"10\" y=\"{}\" width=\"{width:.2}\" height=\"3\"/>\
         <text x=\"10\" y=\"{}\" font-size=\"12\">{text}</text>\
         <text x=\"{:.2}\" y=\"{}\" font-size=\"12\">x →</text><text x=\"{:.2}\" y=\"{}\" font-size=\"12\">y \
         ↑</text>",
        SIDE - 40.0,
        width + 48.0,
        foot - 3.0,
        foot - 8.0,
        width + 18.0,
        foot,
        width + 18.0,
        foot - 14.0
    )
}

/// Meaning of the colours and greys, with its first base line at `foot`, and the end of the SVG.
pub(super) fn legend(foot: f64, heights_m: ArrayView2<'_, f64>) -> String {
    let (low, high) = extent(heights_m);
    let rounded = |height: f64| significant(height, 3).parse().unwrap_or(height);
    let [low, high] =
        [low, high].map(|height| labels_with_unit("height_m", &[rounded(height)]).concat().replace('-', "−"));
    let mut svg = format!(
        "<circle cx=\"{}\" cy=\"{}\" r=\"5\" fill=\"{COMPRESSION}\"/>\
         <text x=\"{}\" y=\"{foot}\" font-size=\"13\">compressive</text>\
         <circle cx=\"{}\" cy=\"{}\" r=\"5\" fill=\"{TENSION}\"/>\
         <text x=\"{}\" y=\"{foot}\" font-size=\"13\">tensile</text>\
         <path d=\"M{} {}l6 6m0 -6l-6 6\" stroke=\"black\"/><text x=\"{}\" y=\"{foot}\" \
         font-size=\"13\">absorbed by a larger contact</text>",
        GAP + 5.0,
        foot - 4.5,
        GAP + 15.0,
        GAP + 115.0,
        foot - 4.5,
        GAP + 125.0,
        GAP + 185.0,
        foot - 7.5,
        GAP + 197.0
    );
    let top = foot + 8.0;
    for k in 0..SHADES {
        let at = GAP + k as f64 * 10.0;
        let _ =
            write!(svg, "<rect x=\"{at}\" y=\"{top}\" width=\"10.5\" height=\"12\" fill=\"{}\"/>", grey(k));
    }
    let _ = write!(
        svg,
        "<text x=\"{}\" y=\"{}\" font-size=\"13\">height: {low} (dark) to {high} (light)</text></svg>",
        GAP + SHADES as f64 * 10.0 + 8.0,
        top + 11.0
    );
    svg
}

/// Grey of a shade of the heights.
fn grey(shade: usize) -> String {
    format!("#{0:02x}{0:02x}{0:02x}", 150 + 105 * shade / SHADES)
}

/// Minimum and maximum of the known heights: measured surfaces may lack points.
fn extent(heights: ArrayView2<'_, f64>) -> (f64, f64) {
    let known = heights.iter().copied().filter(|height| height.is_finite());
    known.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), h| (low.min(h), high.max(h)))
}

/// The heights in shades of grey, a path for each shade.
fn ground(heights: ArrayView2<'_, f64>) -> String {
    let (rows, columns) = heights.dim();
    let cells = CELLS.min(rows).min(columns);
    if cells == 0 {
        return String::new();
    }
    let (low, high) = extent(heights);
    let shade = |i: usize, j: usize| {
        // The middle of the cell stands for it.
        let height = heights[[(2 * i + 1) * rows / (2 * cells), (2 * j + 1) * columns / (2 * cells)]];
        (((height - low) / (high - low) * SHADES as f64) as usize).min(SHADES - 1)
    };
    let size = SIDE / cells as f64;
    let mut paths = vec![String::new(); SHADES];
    for j in 0..cells {
        let mut i = 0;
        while i < cells {
            let from = i;
            let own = shade(i, j);
            while i < cells && shade(i, j) == own {
                i += 1;
            }
            // x to the right, y upwards, as the maps of surfaces are drawn.
            let top = SIDE - (j + 1) as f64 * size;
            let _ = write!(
                paths[own],
                "M{:.2} {top:.2}h{:.2}v{size:.2}h-{:.2}z",
                from as f64 * size,
                (i - from) as f64 * size,
                (i - from) as f64 * size
            );
        }
    }
    let fill = |(k, path): (usize, String)| format!("<path fill=\"{}\" d=\"{path}\"/>", grey(k));
    paths.into_iter().enumerate().map(fill).collect()
}

/// Contact spots at a step as circles, with the images across the edges of a periodic square, and their
/// number.
pub(super) fn circles(
    contacts: &Frame,
    length_m: f64,
    periodic: bool,
    step: i64,
) -> Result<(String, usize), FigureError> {
    let (steps, states) = (contacts.i64("step")?, contacts.text("state")?);
    let (radii, loads) = (contacts.f64("contact_radius_m")?, contacts.f64("load_n")?);
    let (x, y) = (contacts.f64("centroid_x_m")?, contacts.f64("centroid_y_m")?);
    let unit = SIDE / length_m;
    let place = |row: usize| (x[row] * unit, SIDE - y[row] * unit);
    let of_state = |state: &str| {
        (0..steps.len()).filter(|row| steps[*row] == step && states[*row] == state).collect::<Vec<_>>()
    };
    let absorbed: Vec<(f64, f64)> = of_state("covered").into_iter().map(place).collect();
    let mut spots: Vec<(f64, f64, f64, bool)> = Vec::new();
    for row in of_state("contact") {
        let (x, y) = place(row);
        spots.push((x, y, radii[row] * unit, loads[row] < 0.0));
    }
    let count = spots.len();
    spots.sort_by(|u, v| v.2.total_cmp(&u.2));
    spots.truncate(MOST_SPOTS);
    let mut svg = String::new();
    let shifts: &[f64] = if periodic { &[-SIDE, 0.0, SIDE] } else { &[0.0] };
    for (hue, wanted) in [(COMPRESSION, false), (TENSION, true)] {
        let _ = write!(svg, "<g fill=\"{hue}\" fill-opacity=\"0.85\">");
        for (x, y, r, _) in spots.iter().filter(|spot| spot.3 == wanted) {
            for (dx, dy) in shifts.iter().flat_map(|dx| shifts.iter().map(move |dy| (dx, dy))) {
                let (x, y) = (x + dx, y + dy);
                if (-r..SIDE + r).contains(&x) && (-r..SIDE + r).contains(&y) {
                    let _ = write!(svg, "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{r:.2}\"/>");
                }
            }
        }
        svg.push_str("</g>");
    }
    if !absorbed.is_empty() {
        svg.push_str("<path stroke=\"black\" stroke-width=\"1.1\" d=\"");
        for (x, y) in absorbed.iter().take(MOST_SPOTS) {
            let _ = write!(svg, "M{:.1} {:.1}l4 4m0 -4l-4 4", x - 2.0, y - 2.0);
        }
        svg.push_str("\"/>");
    }
    Ok((svg, count))
}
