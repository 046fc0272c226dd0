//! Content of a panel: axes, curves, key and notes.

use kuva::render::render::{Primitive, Scene, TextAnchor};

use super::axis::Axis;

pub(super) const NOTE: u32 = 13;
/// Radius of a point without a line.
pub(super) const SPECK: f64 = 1.8;
/// Minimum distance of two notes at the right of the plot, in pixels.
pub(super) const NOTE_PITCH: f64 = 17.0;

/// Stroke of a curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stroke {
    /// One unbroken line.
    Solid,
    /// Long dashes.
    Dashed,
    /// Dots.
    Dotted,
    /// No line: the points alone, small.
    Points,
    /// No line: small diamonds.
    Diamonds,
    /// No line: a cross at each point.
    Crosses,
    /// No line and no points: the area between two curves, which the band of the curve is.
    Area,
}

impl Stroke {
    pub(super) fn dashes(self) -> Option<&'static str> {
        match self {
            Self::Solid | Self::Points | Self::Diamonds | Self::Crosses | Self::Area => None,
            Self::Dashed => Some("7 4"),
            Self::Dotted => Some("1.5 3.5"),
        }
    }

    /// True if its points are joined.
    pub(super) fn is_line(self) -> bool {
        !matches!(self, Self::Points | Self::Diamonds | Self::Crosses | Self::Area)
    }
}

/// One curve, in units of the data.
#[derive(Debug, Clone)]
pub struct Curve {
    /// Name of the plotted column or branch.
    pub name: String,
    /// Of what of the sweep, as it is named in the panel; may be empty.
    pub of: String,
    /// Points, in the order in which they are joined.
    pub points: Vec<(f64, f64)>,
    /// Half the length of each point's error bar, or half the width of the band around the curve; empty for a
    /// curve without.
    pub errors: Vec<Option<f64>>,
    /// True if the errors are a band.
    pub band: bool,
    /// True if the quantity cannot be negative: bars and bands end at zero.
    pub positive: bool,
    /// A CSS colour.
    pub colour: String,
    /// Colours of the single points with their marks and bars; empty if all have the colour of the curve.
    pub mark_colours: Vec<String>,
    /// Stroke.
    pub stroke: Stroke,
    /// True if a line joins the points; false for categories.
    pub joined: bool,
    /// True if each point has a marker.
    pub marked: bool,
}

impl Curve {
    /// True if a line joins the points.
    pub(super) fn has_line(&self) -> bool {
        self.joined && self.stroke.is_line()
    }

    /// The colour of a point.
    pub(super) fn mark_colour(&self, place: usize) -> &str {
        self.mark_colours.get(place).unwrap_or(&self.colour)
    }

    /// True if each point is drawn with a mark: a line of one point would not be seen.
    pub(super) fn is_marked(&self) -> bool {
        self.stroke != Stroke::Area && (self.marked || self.points.len() == 1 || !self.has_line())
    }

    /// The ends of a point's error bar, or the edges of the band there.
    pub(super) fn ends(&self, place: usize) -> Option<(f64, f64)> {
        let ((_, y), error) = (*self.points.get(place)?, (*self.errors.get(place)?)?);
        let low = y - error;
        Some((if self.positive && y >= 0.0 { low.max(0.0) } else { low }, y + error))
    }

    /// Vertical values, with the ends of bars and bands.
    pub(super) fn heights(&self) -> Vec<f64> {
        let ends = |place: usize| self.ends(place).map_or_else(Vec::new, |(low, high)| vec![low, high]);
        (0..self.points.len()).flat_map(|place| [vec![self.points[place].1], ends(place)].concat()).collect()
    }

    /// True if a bar or the band ends at zero for that reason.
    pub(super) fn is_cut(&self) -> bool {
        let cut =
            |((_, y), error): (&(f64, f64), &Option<f64>)| *y >= 0.0 && error.is_some_and(|error| error > *y);
        self.positive && self.points.iter().zip(&self.errors).any(cut)
    }
}

/// A line of the key: what a colour and a stroke mean.
#[derive(Debug, Clone)]
pub struct KeyEntry {
    /// The text, with markup.
    pub text: String,
    /// A CSS colour.
    pub colour: String,
    /// The stroke, or nothing for a line of text alone.
    pub stroke: Option<Stroke>,
    /// True if the sample has a marker.
    pub marked: bool,
    /// True if the sample has a line; false for categories.
    pub joined: bool,
}

/// A text at the end of a curve.
#[derive(Debug, Clone)]
pub struct Note {
    /// The curve's end, in units of the data.
    pub at: (f64, f64),
    /// The text, with markup.
    pub text: String,
    /// True: in the right margin, at the height of the end. False: just below the end and to its right.
    pub beside: bool,
}

/// Everything that one panel shows.
#[derive(Debug, Clone)]
pub struct XyPlot {
    /// Prefix of all identifiers inside the figure, so that they are unique on a page.
    pub stem: String,
    /// The panel's letter, in bold at its upper left corner; a space for none.
    pub letter: char,
    /// Heading, with markup; may be empty.
    pub title: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// The curves, in the order in which they are painted.
    pub curves: Vec<Curve>,
    /// The key.
    pub key: Vec<KeyEntry>,
    /// Texts at the ends of curves.
    pub notes: Vec<Note>,
    /// Minimum width of the texts at the right of the plot, in pixels: adjacent panels have the same size.
    pub margin: f64,
}

/// Adds a text of the size of notes.
pub(super) fn text(scene: &mut Scene, at: (f64, f64), content: &str, anchor: TextAnchor) {
    scene.add(Primitive::Text {
        x: at.0,
        y: at.1,
        content: content.to_owned(),
        size: NOTE,
        anchor,
        rotate: None,
        bold: false,
        color: None,
    });
}
