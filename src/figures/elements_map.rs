//! Contact of boundary elements with its pressure, at the load reversal and at pull-off.

use super::drawing::Drawing;
use super::map::{ABOVE, GAP, LEGEND, SIDE, depth, power, scale_bar};
use super::{FigureError, markup};
use crate::stats::{labels_with_unit, significant};
use crate::store::{Frame, LoopMaps, StoredMap};
use std::fmt::Write as _;

/// Cells of a map along a side, at most: the grid point in the middle of a cell stands for it.
const CELLS: usize = 128;
/// Levels of compression and of tension.
const LEVELS: usize = 6;
/// Ends of the scales of compression and tension, those of the loop explorer.
const COMPRESSIVE: [[f64; 3]; 2] = [[190.0, 215.0, 238.0], [0.0, 60.0, 110.0]];
const TENSILE: [[f64; 3]; 2] = [[246.0, 206.0, 196.0], [160.0, 20.0, 15.0]];
/// Surface out of contact.
const APART: &str = "#f2f2f2";

/// Largest magnitudes of compression and tension in both maps \[Pa\].
#[derive(Debug, Clone, Copy)]
struct Scale {
    compressive_pa: f64,
    tensile_pa: f64,
}

impl Scale {
    fn of<'a>(maps: impl Iterator<Item = &'a StoredMap>) -> Self {
        let mut scale = Self { compressive_pa: 0.0, tensile_pa: 0.0 };
        for pressure in maps.flat_map(|map| map.pressure_pa.iter()).map(|pressure| f64::from(*pressure)) {
            scale.compressive_pa = scale.compressive_pa.max(pressure);
            scale.tensile_pa = scale.tensile_pa.max(-pressure);
        }
        scale
    }

    /// Level of a pressure, negative in tension: levels follow the square root.
    fn level(self, pressure_pa: f64) -> i8 {
        let step = |part: f64| 1 + ((part.sqrt() * LEVELS as f64) as usize).min(LEVELS - 1) as i8;
        if pressure_pa > 0.0 {
            step(pressure_pa / self.compressive_pa)
        } else {
            -step(-pressure_pa / self.tensile_pa.max(f64::MIN_POSITIVE))
        }
    }
}

/// Colour of a level.
fn colour(level: i8) -> String {
    let [from, to] = if level > 0 { COMPRESSIVE } else { TENSILE };
    let share = (f64::from(level.abs()) - 1.0) / (LEVELS as f64 - 1.0);
    let part = |k: usize| (from[k] + share * (to[k] - from[k])).round() as u8;
    format!("#{:02x}{:02x}{:02x}", part(0), part(1), part(2))
}

/// The contact at the ends of a loop, coloured by its pressure.
///
/// # Errors
/// If the table of steps lacks a column.
pub(super) fn map(parameters: &str, steps: &Frame, maps: &LoopMaps) -> Result<Drawing, FigureError> {
    let (loads, areas, penetrations) = (steps.f64("load")?, steps.f64("area")?, steps.f64("penetration")?);
    let shown = || [("at F_{max}", Some(&maps.reversal)), ("at pull-off", maps.pull_off.as_ref())];
    let scale = Scale::of(shown().into_iter().filter_map(|(_, map)| map));
    let (width, height) = (2.0 * SIDE + 3.0 * GAP, SIDE + ABOVE + GAP + LEGEND);
    let mut svg = format!(
        "<svg viewBox=\"0 0 {width} {height}\" xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" \
         height=\"{height}\" font-family=\"DejaVu Sans, Verdana, Liberation Sans, Arial, sans-serif\" \
         fill=\"black\">\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>"
    );
    for (k, (words, map)) in
        shown().into_iter().filter_map(|(words, map)| map.map(|map| (words, map))).enumerate()
    {
        let left = GAP + k as f64 * (SIDE + GAP);
        let at = usize::try_from(map.step).unwrap_or(usize::MAX);
        let number = |values: &[f64]| values.get(at).copied().unwrap_or(f64::NAN);
        // Writing to a string cannot fail.
        let _ = write!(
            svg,
            "<text x=\"{left}\" y=\"{}\" font-size=\"14\">{words}: A/A_{{0}} = {:.3}</text>\
             <text x=\"{left}\" y=\"{}\" font-size=\"13\">F/(E^{{*}}A_{{0}}) = {}, Δ/h_{{rms}} = {}</text>\
             <g transform=\"translate({left} {ABOVE})\">\
             <rect x=\"0\" y=\"0\" width=\"{SIDE}\" height=\"{SIDE}\" fill=\"{APART}\"/>{}\
             <rect x=\"0\" y=\"0\" width=\"{SIDE}\" height=\"{SIDE}\" fill=\"none\" stroke=\"black\"/>{}</g>",
            ABOVE - 23.0,
            number(&areas),
            ABOVE - 6.0,
            power(number(&loads)),
            depth(number(&penetrations)),
            cells(map, maps.contact_gap_m, scale),
            scale_bar(maps.length_m)
        );
    }
    svg += &legend(height - LEGEND + 14.0, scale);
    let caption = format!(
        "Contact by boundary elements, for {}. Colour: pressure at the grid points in contact. File maps.h5: \
         pressure_pa, gap_m.",
        parameters
    );
    Ok(Drawing::new("elements_map", caption, &markup::render(&svg)))
}

/// Cells in contact, a path of runs along x for each level.
fn cells(map: &StoredMap, contact_gap_m: f64, scale: Scale) -> String {
    let points = map.pressure_pa.nrows().min(map.pressure_pa.ncols());
    let cells = CELLS.min(points);
    let level = |i: usize, j: usize| {
        let at = [(2 * i + 1) * points / (2 * cells), (2 * j + 1) * points / (2 * cells)];
        let pressure = f64::from(map.pressure_pa[at]);
        let touches = pressure > 0.0 || f64::from(map.gap_m[at]) < contact_gap_m;
        if touches { scale.level(pressure) } else { 0 }
    };
    let mut paths = vec![String::new(); 2 * LEVELS + 1];
    for j in 0..cells {
        let mut i = 0;
        while i < cells {
            let (from, own) = (i, level(i, j));
            while i < cells && level(i, j) == own {
                i += 1;
            }
            // x to the right, y upwards, as the maps of surfaces are drawn.
            let place = (i16::from(own) + LEVELS as i16) as usize;
            let _ = write!(paths[place], "M{from} {}h{}v1h-{}z", cells - 1 - j, i - from, i - from);
        }
    }
    let mut svg = format!("<g transform=\"scale({})\" shape-rendering=\"crispEdges\">", SIDE / cells as f64);
    let levels = -(LEVELS as i8)..=LEVELS as i8;
    for (level, path) in levels.zip(paths).filter(|(level, path)| *level != 0 && !path.is_empty()) {
        let _ = write!(svg, "<path fill=\"{}\" d=\"{path}\"/>", colour(level));
    }
    svg + "</g>"
}

/// Colours of the levels with the largest tension and compression, and the end of the SVG.
fn legend(foot: f64, scale: Scale) -> String {
    let rounded = |pressure: f64| significant(pressure, 3).parse().unwrap_or(pressure);
    let named = |pressure: f64| labels_with_unit("pressure_pa", &[rounded(pressure)]).concat();
    let tensile = format!("tensile, to {}", named(scale.tensile_pa));
    let compressive = format!("compressive, to {}", named(scale.compressive_pa));
    let (middle, size) = (GAP + SIDE + 0.5 * GAP, 12.0);
    let mut svg = String::new();
    for level in (-(LEVELS as i8)..=LEVELS as i8).filter(|level| *level != 0) {
        let at = middle + size * f64::from(if level > 0 { level - 1 } else { level });
        let _ = write!(
            svg,
            "<rect x=\"{at}\" y=\"{}\" width=\"{size}\" height=\"14\" fill=\"{}\"/>",
            foot - 11.0,
            colour(level)
        );
    }
    let reach = size * LEVELS as f64 + 8.0;
    let _ = write!(
        svg,
        "<text x=\"{}\" y=\"{foot}\" font-size=\"13\" text-anchor=\"end\">{tensile}</text>\
         <text x=\"{}\" y=\"{foot}\" font-size=\"13\">{compressive}</text>\
         <text x=\"{middle}\" y=\"{}\" font-size=\"12\" text-anchor=\"middle\">colours follow the square \
         root of the pressure; light grey: out of contact</text></svg>",
        middle - reach,
        middle + reach,
        foot + 22.0
    );
    svg
}
