//! Names at the ends of curves: one for curves that coincide, and as many as have room.

use super::curve::{Note, XyPlot};
use super::style::MOST_NOTES;

/// Symbol before the load at the end of a name.
pub(super) const LOAD: &str = "F_{max} = ";

/// Distance of two ends below which they coincide, over the length of each axis.
const NEAR: f64 = 0.012;

/// The names of a plot: ends of loads of one case that coincide share a name with all of these loads. Of more
/// names than have room, evenly spaced ones.
pub(super) fn shared(plot: &XyPlot) -> Vec<Note> {
    let share = |axis: &super::Axis, value: f64| {
        let (low, high) = axis.drawn_range();
        axis.drawn(value) / (high - low)
    };
    let place = |note: &Note| (share(&plot.x, note.at.0), share(&plot.y, note.at.1));
    let mut found: Vec<Note> = Vec::new();
    for note in &plot.notes {
        let (x, y) = place(note);
        let coincides = |known: &&mut Note| {
            let (u, v) = place(known);
            let same = note.text.split_once(LOAD).zip(known.text.split_once(LOAD));
            same.is_some_and(|(own, other)| own.0 == other.0) && (x - u).abs() < NEAR && (y - v).abs() < NEAR
        };
        match found.iter_mut().find(coincides).zip(note.text.split_once(LOAD)) {
            Some((known, (_, load))) => known.text += &format!(", {load}"),
            None => found.push(note.clone()),
        }
    }
    let every = found.iter().filter(|note| note.beside).count().div_ceil(MOST_NOTES).max(1);
    found.into_iter().enumerate().filter(|(at, _)| at % every == 0).map(|(_, note)| note).collect()
}
