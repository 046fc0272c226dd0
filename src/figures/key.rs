//! The key of a panel, in the corner with the smallest overlap.

use kuva::render::layout::ComputedLayout;
use kuva::render::render::{Primitive, Scene, TextAnchor};

use super::curve::{NOTE, NOTE_PITCH, XyPlot, text};
use super::{marks, markup};

/// Length of a line's sample.
const SAMPLE: f64 = 30.0;

/// Left, top, width and height in pixels.
type Place = (f64, f64, f64, f64);

/// Draws the key.
pub(super) fn add(scene: &mut Scene, frame: &ComputedLayout, plot: &XyPlot) {
    let (left, top, ..) = place(frame, plot);
    for (row, entry) in plot.key.iter().enumerate() {
        let y = top + (row as f64 + 0.5) * NOTE_PITCH;
        let Some(stroke) = entry.stroke else {
            text(scene, (left, y + 4.5), &entry.text, TextAnchor::Start);
            continue;
        };
        if stroke.is_line() && entry.joined {
            scene.add(Primitive::Line {
                x1: left,
                y1: y,
                x2: left + SAMPLE,
                y2: y,
                stroke: entry.colour.as_str().into(),
                stroke_width: 2.0,
                stroke_dasharray: stroke.dashes().map(str::to_owned),
            });
        }
        if entry.marked || !stroke.is_line() {
            marks::sample(scene, left + SAMPLE / 2.0, y, stroke, &entry.colour);
        }
        text(scene, (left + SAMPLE + 8.0, y + 4.5), &entry.text, TextAnchor::Start);
    }
}

fn place(frame: &ComputedLayout, plot: &XyPlot) -> Place {
    let indent = |sampled: bool| if sampled { SAMPLE + 8.0 } else { 0.0 };
    let width = plot
        .key
        .iter()
        .map(|entry| markup::width(&entry.text, NOTE) + indent(entry.stroke.is_some()))
        .fold(0.0, f64::max);
    let height = plot.key.len() as f64 * NOTE_PITCH;
    let (left, top) = (frame.margin_left + 10.0, frame.margin_top + 6.0);
    let (right, bottom) =
        (frame.width - frame.margin_right - 6.0 - width, frame.height - frame.margin_bottom - 8.0 - height);
    let points = inked(frame, plot);
    let covered = |place: &Place| {
        let (left, top, width, height) = *place;
        let inside = |(x, y): &&(f64, f64)| {
            (left - 6.0..left + width + 6.0).contains(x) && (top - 4.0..top + height + 4.0).contains(y)
        };
        points.iter().filter(inside).count()
    };
    let corners = [
        (left, top, width, height),
        (right, top, width, height),
        (right, bottom, width, height),
        (left, bottom, width, height),
    ];
    corners.into_iter().min_by_key(covered).unwrap_or((left, top, width, height))
}

/// Pixels that hold ink: points along every curve, close enough that none can pass through a key unseen, its
/// bars, and the notes.
fn inked(frame: &ComputedLayout, plot: &XyPlot) -> Vec<(f64, f64)> {
    let pixel = |x: f64, y: f64| (frame.map_x(plot.x.drawn(x)), frame.map_y(plot.y.drawn(y)));
    let mut points = Vec::new();
    for curve in &plot.curves {
        for pair in curve.points.windows(2) {
            if let [from, to] = pair {
                let (from, to) = (pixel(from.0, from.1), pixel(to.0, to.1));
                let steps = ((to.0 - from.0).hypot(to.1 - from.1) / 4.0).ceil().clamp(1.0, 1000.0);
                points.extend(
                    (0..=steps as usize)
                        .map(|step| step as f64 / steps)
                        .map(|share| (from.0 + share * (to.0 - from.0), from.1 + share * (to.1 - from.1))),
                );
            }
        }
        for (place, (x, y)) in curve.points.iter().enumerate() {
            let (low, high) = curve.ends(place).unwrap_or((*y, *y));
            points.extend((0..=8).map(|step| pixel(*x, low + (high - low) * f64::from(step) / 8.0)));
        }
    }
    points.extend(
        plot.notes
            .iter()
            .filter(|note| !note.beside)
            .map(|note| pixel(note.at.0, note.at.1))
            .flat_map(|(x, y)| [(x + 4.0, y + 10.0), (x + 40.0, y + 10.0)]),
    );
    points
}
