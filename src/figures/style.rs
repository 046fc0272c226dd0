//! The hues and strokes of the panels.

use super::curve::{Curve, KeyEntry, Stroke};

pub(super) const LOADING: [u8; 3] = [0x00, 0x8a, 0x5e];
pub(super) const UNLOADING: [u8; 3] = [0xcc, 0x33, 0x11];
pub(super) const THEORY: [u8; 3] = [0x00, 0x77, 0xbb];
/// As many names as fit beside a panel.
pub(super) const MOST_NOTES: usize = 14;

/// A hue, the lighter the earlier of several.
pub(super) fn shade(hue: [u8; 3], at: usize, of: usize) -> String {
    let white = if of < 2 { 0.0 } else { 0.55 * (of - 1 - at) as f64 / (of - 1) as f64 };
    let [red, green, blue] = hue.map(|part| (f64::from(part) + white * (255.0 - f64::from(part))).round() as u8);
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// A curve without errors, of something and by its name.
pub(super) fn curve((name, of): (&str, &str), points: Vec<(f64, f64)>, colour: String, stroke: Stroke) -> Curve {
    let [name, of] = [name, of].map(str::to_owned);
    Curve { name, of, points, errors: Vec::new(), band: false, positive: false, colour, stroke, marked: false }
}

pub(super) fn entry(text: &str, hue: [u8; 3], stroke: Option<Stroke>, marked: bool) -> KeyEntry {
    KeyEntry { text: text.to_owned(), colour: shade(hue, 0, 1), stroke, marked }
}
