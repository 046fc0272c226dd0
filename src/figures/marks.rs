//! Marks of single points: in a panel and in its key.

use super::curve::{Curve, SPECK, Stroke};
use kuva::plot::scatter::{MarkerShape, ScatterPlot};
use kuva::render::color::Color;
use kuva::render::plots::Plot;
use kuva::render::render::{PathData, Primitive, Scene};

/// Opacity of a band: several lie over one another.
pub(super) const BAND_OPACITY: f64 = 0.13;

/// Radius of a mark.
const MARK: f64 = 4.5;
/// Half the width of a cross.
const CROSS: f64 = 4.0;

impl Stroke {
    fn shape(self) -> MarkerShape {
        match self {
            Self::Solid | Self::Points => MarkerShape::Circle,
            Self::Dashed | Self::Area => MarkerShape::Square,
            Self::Dotted | Self::Diamonds => MarkerShape::Diamond,
            Self::Crosses => MarkerShape::Cross,
        }
    }

    fn size(self) -> f64 {
        match self {
            Self::Points => SPECK,
            Self::Diamonds => 1.6 * SPECK,
            Self::Crosses => CROSS,
            Self::Area => 1.4 * MARK,
            // A square is wider than a disc of the same radius.
            Self::Dashed => 0.85 * MARK,
            Self::Solid | Self::Dotted => MARK,
        }
    }
}

/// The points of a curve as marks, a plot for each run of points of one colour.
pub(super) fn marks(curve: &Curve, points: &[(f64, f64)]) -> Vec<Plot> {
    let coloured: Vec<(&str, (f64, f64))> =
        points.iter().enumerate().map(|(place, point)| (curve.mark_colour(place), *point)).collect();
    let plot = |run: &[(&str, (f64, f64))]| {
        let colour = run.first().map_or("", |(colour, _)| colour).to_owned();
        let marks = ScatterPlot::new()
            .with_data(run.iter().map(|(_, point)| *point))
            .with_color(colour)
            .with_size(curve.stroke.size());
        Plot::Scatter(marks.with_marker(curve.stroke.shape()))
    };
    coloured.chunk_by(|a, b| a.0 == b.0).map(plot).collect()
}

/// One mark of a stroke in the key.
pub(super) fn sample(scene: &mut Scene, x: f64, y: f64, stroke: Stroke, colour: &str) {
    let size = stroke.size();
    let primitive = match stroke {
        Stroke::Solid | Stroke::Points => Primitive::Circle {
            cx: x,
            cy: y,
            r: size,
            fill: colour.into(),
            fill_opacity: None,
            stroke: None,
            stroke_width: None,
        },
        Stroke::Dashed => {
            path(format!("M {0} {1} h {2} v {2} h -{2} Z", x - size, y - size, 2.0 * size), colour, false)
        }
        Stroke::Dotted | Stroke::Diamonds => path(
            format!("M {x} {0} L {1} {y} L {x} {2} L {3} {y} Z", y - size, x + size, y + size, x - size),
            colour,
            false,
        ),
        Stroke::Area => Primitive::Path(Box::new(PathData {
            d: format!("M {0} {1} h {2} v {3} h -{2} Z", x - 2.0 * size, y - size, 4.0 * size, 2.0 * size),
            fill: Some(Color::from(colour)),
            stroke: Color::None,
            stroke_width: 0.0,
            opacity: Some(BAND_OPACITY),
            stroke_dasharray: None,
        })),
        Stroke::Crosses => {
            let arm = 0.9 * size;
            path(
                format!("M {0} {1} l {2} {2} m 0 -{2} l -{2} {2}", x - arm, y - arm, 2.0 * arm),
                colour,
                true,
            )
        }
    };
    scene.add(primitive);
}

fn path(d: String, colour: &str, outline: bool) -> Primitive {
    let (fill, stroke) =
        if outline { (None, Color::from(colour)) } else { (Some(Color::from(colour)), Color::None) };
    Primitive::Path(Box::new(PathData {
        d,
        fill,
        stroke,
        stroke_width: 1.5,
        opacity: None,
        stroke_dasharray: None,
    }))
}
