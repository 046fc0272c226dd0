//! The hues and strokes of the figures: the colour is the case, the dash is the branch; blue and red are
//! compression and tension.

use super::axis::Axis;
use super::curve::{Curve, KeyEntry, Stroke, XyPlot};

/// Compression in maps of contacts (blue of Okabe and Ito); no other figure has it.
pub(super) const COMPRESSION: &str = "#0072b2";
/// Tension in maps of contacts (red); no other figure has it.
pub(super) const TENSION: &str = "#c0281c";

/// Colours of cases, distinct with any colour vision, without blue and red.
const PALETTE: [[u8; 3]; 6] = [
    [0x7b, 0x32, 0x94],
    [0x00, 0x9e, 0x73],
    [0xe6, 0x9f, 0x00],
    [0xcc, 0x79, 0xa7],
    [0x80, 0x80, 0x00],
    [0x6b, 0x47, 0x2b],
];

/// Simulation results of a figure with one case.
pub(super) const RESULT: [u8; 3] = PALETTE[0];
/// Second quantity of a figure with one case.
pub(super) const OTHER: [u8; 3] = PALETTE[1];
/// Analytical models.
pub(super) const THEORY: [u8; 3] = [0x00, 0x00, 0x00];
/// Lines that join results of several cases, and samples of a stroke.
pub(super) const NEUTRAL: [u8; 3] = [0x59, 0x59, 0x59];
/// Maximum number of names that fit at the right of a panel.
pub(super) const MOST_NOTES: usize = 14;

/// A hue, the lighter the earlier of several.
pub(super) fn shade(hue: [u8; 3], at: usize, of: usize) -> String {
    let white = if of < 2 { 0.0 } else { 0.4 * (of - 1 - at) as f64 / (of - 1) as f64 };
    let [red, green, blue] =
        hue.map(|part| (f64::from(part) + white * (255.0 - f64::from(part))).round() as u8);
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// The colour of a case by its place, and of one of its loads: the lighter the lower. After the last colour
/// of the palette they begin again, darker.
pub(super) fn case_colour(place: usize, load: usize, loads: usize) -> String {
    let hue = PALETTE[place % PALETTE.len()];
    let dark = 0.6_f64.powi((place / PALETTE.len()) as i32);
    shade(hue.map(|part| (f64::from(part) * dark).round() as u8), load, loads)
}

/// Number of colours from which on numbers have a scale instead of the palette.
const SCALE_FROM: usize = 3;

/// Scale of numbers, from dark to light with any colour vision: purple, grey, green and yellow.
const SCALE: [[f64; 3]; 6] = [
    [84.0, 20.0, 100.0],
    [98.0, 72.0, 112.0],
    [80.0, 115.0, 95.0],
    [50.0, 150.0, 90.0],
    [140.0, 182.0, 60.0],
    [218.0, 184.0, 30.0],
];

/// The colour of one of several series: of numbers in their order along a scale, else of the palette; of one
/// of its loads as [`case_colour`] has it.
pub(super) fn series_colour(place: usize, of: usize, in_order: bool, [load, loads]: [usize; 2]) -> String {
    if !in_order || of < SCALE_FROM {
        return case_colour(place, load, loads);
    }
    let along = place as f64 / (of - 1) as f64 * (SCALE.len() - 1) as f64;
    let from = (along as usize).min(SCALE.len() - 2);
    let share = along - from as f64;
    let part = |k: usize| (SCALE[from][k] + share * (SCALE[from + 1][k] - SCALE[from][k])).round() as u8;
    shade([0, 1, 2].map(part), load, loads)
}

/// A curve without errors, of something and by its name.
pub(super) fn curve(name: &str, of: &str, points: Vec<(f64, f64)>, colour: String, stroke: Stroke) -> Curve {
    let [name, of] = [name, of].map(str::to_owned);
    let mark_colours = Vec::new();
    Curve {
        name,
        of,
        points,
        errors: Vec::new(),
        band: false,
        positive: false,
        colour,
        mark_colours,
        stroke,
        joined: true,
        marked: false,
    }
}

pub(super) fn entry(text: &str, hue: [u8; 3], stroke: Option<Stroke>, marked: bool) -> KeyEntry {
    KeyEntry { text: text.to_owned(), colour: shade(hue, 0, 1), stroke, marked, joined: true }
}

/// A plot with a title and samples of its curves.
pub(super) fn plot(
    title: String,
    x: Axis,
    y: Axis,
    curves: Vec<Curve>,
    key: &[(&str, [u8; 3], Stroke)],
) -> XyPlot {
    let marked = |colour: &str, stroke: Stroke| {
        curves.iter().any(|of| of.colour == colour && of.stroke == stroke && of.is_marked())
    };
    let key = key
        .iter()
        .map(|(text, hue, stroke)| entry(text, *hue, Some(*stroke), marked(&shade(*hue, 0, 1), *stroke)))
        .collect();
    XyPlot { stem: String::new(), letter: ' ', title, x, y, curves, key, notes: Vec::new(), margin: 0.0 }
}
