//! Maps of the contact spots on the surface, at four points of the loop.

use super::cycle_loop::{Closer, Kept, SpotTables};
use super::{FigureError, markup};
use crate::stats::significant;
use crate::store::Frame;
use crate::text::counted;
use ndarray::ArrayView2;
use std::collections::HashMap;
use std::fmt::Write as _;

/// Side of one map, what is between two, and room above each for its words \[pixels\].
pub(super) const SIDE: f64 = 300.0;
pub(super) const GAP: f64 = 16.0;
pub(super) const ABOVE: f64 = 42.0;

/// Cells of the heights along a side, and shades of grey.
const CELLS: usize = 75;
const SHADES: usize = 7;

/// Spots on one map, at most: the largest are drawn.
const MOST_SPOTS: usize = 4000;

pub(super) const PUSHED: &str = "#0077bb";
pub(super) const PULLED: &str = "#cc3311";

/// The spots at each landmark whose spots were kept, over the heights as shades of grey, the lower the darker; nothing where none were kept.
///
/// # Errors
/// If a table lacks a column.
pub(super) fn map(of: &Closer<'_>, landmarks: &[Kept], heights_m: ArrayView2<'_, f64>) -> Result<Option<String>, FigureError> {
    if landmarks.is_empty() {
        return Ok(None);
    }
    let (loads, penetrations) = (of.steps.f64("load")?, of.steps.f64("penetration")?);
    let rows = landmarks.len().div_ceil(2) as f64;
    let (width, height) = (2.0 * SIDE + 3.0 * GAP, rows * (SIDE + ABOVE) + GAP + 20.0);
    let mut svg = sheet((width, height), "map", heights_m);
    for (k, (landmark, step)) in landmarks.iter().enumerate() {
        let (left, top) = (GAP + (k % 2) as f64 * (SIDE + GAP), ABOVE + (k / 2) as f64 * (SIDE + ABOVE));
        let at = usize::try_from(*step).unwrap_or_default();
        let number = |values: &[f64]| values.get(at).copied().unwrap_or(f64::NAN);
        let (spots, count) = spots(of, *step)?;
        // Writing to a string cannot fail.
        let _ = write!(
            svg,
            "<text x=\"{left}\" y=\"{}\" font-size=\"14\">{}: {}</text>\
             <text x=\"{left}\" y=\"{}\" font-size=\"13\">F/(E^{{*}}A_{{0}}) = {}, Δ/h_{{rms}} = {:.2}</text>\
             <g transform=\"translate({left} {top})\"><g clip-path=\"url(#map-edge)\"><use xlink:href=\"#map-heights\"/>{spots}</g>\
             <rect x=\"0\" y=\"0\" width=\"{SIDE}\" height=\"{SIDE}\" fill=\"none\" stroke=\"black\"/></g>",
            top - 23.0,
            landmark.words(),
            counted(count, "contact spot"),
            top - 6.0,
            significant(number(&loads), 3).replace('-', "−"),
            number(&penetrations)
        );
    }
    svg += &legend(height - 12.0);
    Ok(Some(markup::render(&svg)))
}

/// Beginning of an SVG of maps: the heights and the edge of a map are its definitions `<prefix>-heights` and `<prefix>-edge`.
pub(super) fn sheet((width, height): (f64, f64), prefix: &str, heights_m: ArrayView2<'_, f64>) -> String {
    format!(
        "<svg viewBox=\"0 0 {width} {height}\" xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" width=\"{width}\" \
         height=\"{height}\" font-family=\"DejaVu Sans, Verdana, Liberation Sans, Arial, sans-serif\" fill=\"black\">\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/><defs><g id=\"{prefix}-heights\">{}</g><clipPath id=\"{prefix}-edge\">\
         <rect x=\"0\" y=\"0\" width=\"{SIDE}\" height=\"{SIDE}\"/></clipPath></defs>",
        ground(heights_m)
    )
}

/// Meaning of the colours, with its base line at `foot`, and the end of the SVG.
pub(super) fn legend(foot: f64) -> String {
    format!(
        "<circle cx=\"{}\" cy=\"{}\" r=\"5\" fill=\"{PUSHED}\"/><text x=\"{}\" y=\"{foot}\" font-size=\"13\">compressive</text>\
         <circle cx=\"{}\" cy=\"{}\" r=\"5\" fill=\"{PULLED}\"/><text x=\"{}\" y=\"{foot}\" font-size=\"13\">tensile; darker grey: lower heights</text></svg>",
        GAP + 5.0,
        foot - 4.5,
        GAP + 15.0,
        GAP + 115.0,
        foot - 4.5,
        GAP + 125.0
    )
}

/// The heights in shades of grey, a path for each shade.
fn ground(heights: ArrayView2<'_, f64>) -> String {
    let (rows, columns) = heights.dim();
    let cells = CELLS.min(rows).min(columns);
    if cells == 0 {
        return String::new();
    }
    // Measured surfaces may lack points.
    let known = || heights.iter().copied().filter(|height| height.is_finite());
    let (low, high) = known().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), h| (low.min(h), high.max(h)));
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
    let fill = |(k, path): (usize, String)| {
        let grey = 150 + 105 * k / SHADES;
        format!("<path fill=\"#{grey:02x}{grey:02x}{grey:02x}\" d=\"{path}\"/>")
    };
    paths.into_iter().enumerate().map(fill).collect()
}

/// Contact spots at a step as circles, with the images across the edges of a periodic square, and their number.
fn spots(of: &Closer<'_>, step: i64) -> Result<(String, usize), FigureError> {
    circles(&of.spots, of.length_m, of.periodic, step)
}

/// Centres of the merged contacts of the loading branch and of the unloading from a load \[m\], by their numbers.
fn merged_centres(merged: &Frame, max_load: Option<f64>) -> Result<HashMap<i64, (f64, f64)>, FigureError> {
    let (ids, branches, loads) = (merged.i64("asperity_id")?, merged.text("branch")?, merged.f64_or_null("max_load")?);
    let (x, y) = (merged.f64("x_m")?, merged.f64("y_m")?);
    let of_path = |row: &usize| branches[*row] == "loading" || (max_load.is_some() && loads[*row] == max_load);
    Ok((0..ids.len()).filter(of_path).map(|row| (ids[row], (x[row], y[row]))).collect())
}

/// The contact spots at a step as [`spots`] has them.
pub(super) fn circles(tables: &SpotTables<'_>, length_m: f64, periodic: bool, step: i64) -> Result<(String, usize), FigureError> {
    let SpotTables { contacts, asperities, merged } = *tables;
    let (steps, states, ids) = (contacts.i64("step")?, contacts.text("state")?, contacts.i64("asperity_id")?);
    let (radii, loads) = (contacts.f64("contact_radius_m")?, contacts.f64("load_n")?);
    let (x, y) = (asperities.f64("x_m")?, asperities.f64("y_m")?);
    let unit = SIDE / length_m;
    let first = steps.iter().position(|of| *of == step);
    let merged = merged_centres(merged, first.map(|row| contacts.f64_or_null("max_load").map(|loads| loads[row])).transpose()?.flatten())?;
    let mut spots: Vec<(f64, f64, f64, bool)> = Vec::new();
    let mut count = 0;
    for k in (0..steps.len()).filter(|k| steps[*k] == step && states[*k] == "contact") {
        count += 1;
        let asperity = usize::try_from(ids[k]).ok().filter(|id| *id < x.len());
        let Some((x, y)) = asperity.map(|id| (x[id], y[id])).or_else(|| merged.get(&ids[k]).copied()) else { continue };
        spots.push((x * unit, SIDE - y * unit, radii[k] * unit, loads[k] < 0.0));
    }
    spots.sort_by(|u, v| v.2.total_cmp(&u.2));
    spots.truncate(MOST_SPOTS);
    let mut svg = String::new();
    let shifts: &[f64] = if periodic { &[-SIDE, 0.0, SIDE] } else { &[0.0] };
    for (hue, wanted) in [(PUSHED, false), (PULLED, true)] {
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
    Ok((svg, count))
}
