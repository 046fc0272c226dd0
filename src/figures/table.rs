//! Data of the panels as a table, for other figures.

use super::curve::{Curve, Stroke};
use super::panels::Panel;
use crate::schema::PANELS;
use crate::store::{Frame, FrameError};

/// One point of one curve of one panel.
struct Row<'a> {
    sweep: &'a str,
    panel: &'a Panel,
    curve: usize,
    point: usize,
}

impl<'a> Row<'a> {
    fn curve(&self) -> &'a Curve {
        &self.panel.plot.curves[self.curve]
    }
}

/// All points of all panels, each with its sweep, in the order in which they are drawn.
///
/// # Errors
/// If a number is not finite.
pub fn table(panels: &[(String, Panel)]) -> Result<Frame, FrameError> {
    let mut rows = Vec::new();
    for (sweep, panel) in panels {
        // An area between two curves is no result of its own.
        for (number, curve) in
            panel.plot.curves.iter().enumerate().filter(|(_, curve)| curve.stroke != Stroke::Area)
        {
            rows.extend((0..curve.points.len()).map(|point| Row { sweep, panel, curve: number, point }));
        }
    }
    Frame::of(&PANELS)
        .text("sweep", rows.iter().map(|row| row.sweep))
        .text("panel", rows.iter().map(|row| row.panel.name.as_str()))
        .i64("curve", rows.iter().map(|row| row.curve as i64))
        .text("name", rows.iter().map(|row| row.curve().name.as_str()))
        .text("of", rows.iter().map(|row| row.curve().of.as_str()))
        .i64("point", rows.iter().map(|row| row.point as i64))
        .f64("x", rows.iter().map(|row| row.curve().points[row.point].0))
        .f64("y", rows.iter().map(|row| row.curve().points[row.point].1))
        .f64("y_sd", rows.iter().map(|row| row.curve().errors.get(row.point).copied().flatten()))
        .text("x_label", rows.iter().map(|row| row.panel.plot.x.label.as_str()))
        .text("y_label", rows.iter().map(|row| row.panel.plot.y.label.as_str()))
        .build()
}
