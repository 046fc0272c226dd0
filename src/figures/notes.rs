//! Names at the ends of curves: one for curves that coincide, and as many as have room.

use super::Axis;
use super::curve::{Note, XyPlot};
use super::style::MOST_NOTES;

/// Symbol before the load at the end of a name.
pub(super) const LOAD: &str = "F_{max} = ";

/// Distance below which an end is on a curve, over the length of each axis.
const NEAR: f64 = 0.015;

/// A place as fractions of both axes.
type Place = (f64, f64);

/// The names of a plot: loads of one case of which the curve of one ends on that of the other share a name
/// with all of these loads. Of more names than have room, evenly spaced ones.
pub(super) fn shared(plot: &XyPlot) -> Vec<Note> {
    let mut found: Vec<Note> = Vec::new();
    for note in &plot.notes {
        let Some((case, load)) = note.text.split_once(LOAD) else {
            found.push(note.clone());
            continue;
        };
        let coincides = |known: &&mut Note| {
            let is_same = known.text.split_once(LOAD).is_some_and(|(other, _)| other == case);
            is_same && (is_on(plot, note, known) || is_on(plot, known, note))
        };
        match found.iter_mut().find(coincides) {
            Some(known) => {
                known.text += &format!(", {load}");
                // The name is at the end of the longer curve.
                if !is_on(plot, note, known) {
                    known.at = note.at;
                }
            }
            None => found.push(note.clone()),
        }
    }
    let every = found.iter().filter(|note| note.beside).count().div_ceil(MOST_NOTES).max(1);
    found.into_iter().enumerate().filter(|(at, _)| at % every == 0).map(|(_, note)| note).collect()
}

/// True if the end of a curve is on the curve with another end.
fn is_on(plot: &XyPlot, end: &Note, other: &Note) -> bool {
    let share = |axis: &Axis, value: f64| {
        let (low, high) = axis.drawn_range();
        (axis.drawn(value) - low) / (high - low)
    };
    let place = |(x, y): (f64, f64)| (share(&plot.x, x), share(&plot.y, y));
    let point = place(end.at);
    let ends = |points: &[(f64, f64)]| points.first() == Some(&other.at) || points.last() == Some(&other.at);
    let curves = plot.curves.iter().filter(|curve| curve.has_line() && ends(&curve.points));
    let mut pieces = curves.flat_map(|curve| curve.points.windows(2));
    distance(point, (place(other.at), place(other.at))) < NEAR
        || pieces.any(|pair| distance(point, (place(pair[0]), place(pair[1]))) < NEAR)
}

/// Distance of a point from a piece of a line.
fn distance((x, y): Place, ((u, v), (p, q)): (Place, Place)) -> f64 {
    let (along, across) = (p - u, q - v);
    let length = along * along + across * across;
    let share =
        if length > 0.0 { (((x - u) * along + (y - v) * across) / length).clamp(0.0, 1.0) } else { 0.0 };
    (x - u - share * along).hypot(y - v - share * across)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn law_the_distance_from_a_piece_is_that_of_its_nearest_point() {
        let piece = ((0.0, 0.0), (2.0, 0.0));
        assert_eq!(distance((1.0, 3.0), piece), 3.0);
        assert_eq!(distance((5.0, 4.0), piece), 5.0);
        assert_eq!(distance((-3.0, 4.0), (piece.0, piece.0)), 5.0);
    }
}
