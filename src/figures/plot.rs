//! Line plots in one style. The plotting library is used only here, so that it can be replaced.

use kuva::backend::svg::SvgBackend;
use kuva::plot::band::BandPlot;
use kuva::plot::line::LinePlot;
use kuva::render::layout::{ComputedLayout, Layout, TickFormat};
use kuva::render::plots::Plot;
use kuva::render::render::{Primitive, Scene, TextAnchor, render_multiple};
use std::sync::Arc;

use super::axis::Axis;
use super::curve::{Curve, NOTE, NOTE_PITCH, XyPlot, text};
use super::marks::{BAND_OPACITY, marks};
use super::{key, markup};

/// Size of a panel in pixels; at one column of a journal, 88 mm, a pixel is 0.18 mm and the smallest text 6.8
/// points.
const SIZE: (f64, f64) = (480.0, 380.0);
const LABEL: u32 = 16;
const TICK: u32 = 14;

/// Draws a panel as a complete SVG document.
pub fn plot_xy(plot: &XyPlot) -> String {
    // Bands lie below all curves.
    let bands = plot.curves.iter().filter(|curve| curve.band).map(|curve| band(curve, plot));
    let plots = bands.chain(plot.curves.iter().flat_map(|curve| drawn(curve, plot))).collect();
    let layout = layout(plot);
    let frame = ComputedLayout::from_layout(&layout);
    let mut scene = render_multiple(plots, layout);
    let letter = Primitive::Text {
        x: 10.0,
        y: 24.0,
        content: plot.letter.to_string(),
        size: LABEL + 2,
        anchor: TextAnchor::Start,
        rotate: None,
        bold: true,
        color: None,
    };
    if !plot.letter.is_whitespace() {
        scene.add(letter);
    }
    add_notes(&mut scene, &frame, plot);
    key::add(&mut scene, &frame, plot);
    // A view box lets a page scale the picture; the backend gives a width and a height only.
    let view_box = format!("<svg viewBox=\"0 0 {} {}\" ", scene.width, scene.height);
    let svg = SvgBackend.render_scene(&scene).replacen("<svg ", &view_box, 1);
    markup::render(&own_clips(&svg, &plot.stem))
}

/// The library numbers its clip paths through all pictures that a program draws. Here each has its own,
/// counted from zero under its own name: the same plot is the same picture whatever was drawn before, and two
/// pictures in one page do not cut each other.
fn own_clips(svg: &str, stem: &str) -> String {
    let mut parts = svg.split("kuva-clip-");
    let mut own = parts.next().unwrap_or_default().to_owned();
    let mut known: Vec<&str> = Vec::new();
    for part in parts {
        let digits = part.len() - part.trim_start_matches(|c: char| c.is_ascii_digit()).len();
        let (number, rest) = part.split_at(digits);
        let place = known.iter().position(|seen| *seen == number).unwrap_or_else(|| {
            known.push(number);
            known.len() - 1
        });
        own += &format!("{stem}-clip-{place}{rest}");
    }
    own
}

fn layout(plot: &XyPlot) -> Layout {
    let beside = width_beside(plot).max(plot.margin);
    let (x, y) = (&plot.x, &plot.y);
    let labels = |axis: &Axis| {
        let axis = axis.clone();
        TickFormat::Custom(Arc::new(move |value| axis.tick_label(value)))
    };
    let left = 48.0
        + y.ticks()
            .iter()
            .map(|tick| markup::width(&y.tick_label(*tick), TICK))
            .fold(2.0 * f64::from(TICK), f64::max);
    Layout::new(x.drawn_range(), y.drawn_range())
        .with_width(SIZE.0 + beside)
        .with_height(SIZE.1)
        .with_title(plot.title.clone())
        .with_title_size(LABEL - 2)
        .with_x_label(x.full_label())
        .with_y_label(y.full_label())
        .with_label_size(LABEL)
        .with_tick_size(TICK)
        .with_x_axis_min(x.drawn_range().0)
        .with_x_axis_max(x.drawn_range().1)
        .with_y_axis_min(y.drawn_range().0)
        .with_y_axis_max(y.drawn_range().1)
        .with_x_tick_step(x.drawn_step())
        .with_y_tick_step(y.drawn_step())
        .with_x_tick_format(labels(x))
        .with_y_tick_format(labels(y))
        .with_show_grid(false)
        .with_box_axes()
        .with_force_margins(left, 18.0 + if beside > 0.0 { beside + 6.0 } else { 0.0 })
}

/// Width of the texts at the right of the plot, in pixels.
pub(super) fn width_beside(plot: &XyPlot) -> f64 {
    plot.notes
        .iter()
        .filter(|note| note.beside)
        .map(|note| markup::width(&note.text, NOTE))
        .fold(0.0, f64::max)
}

/// Band of the errors of a curve.
fn band(curve: &Curve, plot: &XyPlot) -> Plot {
    let (mut at, mut low, mut high) = (Vec::new(), Vec::new(), Vec::new());
    for (place, (x, y)) in curve.points.iter().enumerate() {
        let ends = curve.ends(place).unwrap_or((*y, *y));
        at.push(plot.x.drawn(*x));
        // The band is cut off where the panel ends.
        let inside = |value: f64| plot.y.drawn(value).clamp(plot.y.drawn_range().0, plot.y.drawn_range().1);
        low.push(inside(ends.0));
        high.push(inside(ends.1));
    }
    Plot::Band(BandPlot::new(at, low, high).with_color(curve.colour.clone()).with_opacity(BAND_OPACITY))
}

fn drawn(curve: &Curve, plot: &XyPlot) -> Vec<Plot> {
    let points: Vec<(f64, f64)> =
        curve.points.iter().map(|(x, y)| (plot.x.drawn(*x), plot.y.drawn(*y))).collect();
    let style = match curve.stroke.dashes() {
        None => kuva::plot::line::LineStyle::Solid,
        Some(dashes) => kuva::plot::line::LineStyle::Custom(dashes.to_owned()),
    };
    let mut plots = Vec::new();
    if curve.has_line() {
        let line = LinePlot::new()
            .with_data(points.clone())
            .with_color(curve.colour.clone())
            .with_stroke_width(2.0)
            .with_line_style(style);
        plots.push(Plot::Line(line));
    }
    for (place, point) in points.iter().enumerate().filter(|_| !curve.band) {
        if let Some((low, high)) = curve.ends(place) {
            let y = curve.points[place].1;
            let arms = (plot.y.drawn_length(y - low), plot.y.drawn_length(high - y));
            let bar = LinePlot::new().with_data([*point]).with_color(curve.mark_colour(place).to_owned());
            plots.push(Plot::Line(bar.with_y_err_asymmetric([arms])));
        }
    }
    if curve.is_marked() {
        plots.extend(marks(curve, &points));
    }
    plots
}

fn add_notes(scene: &mut Scene, frame: &ComputedLayout, plot: &XyPlot) {
    let pixel = |at: (f64, f64)| (frame.map_x(plot.x.drawn(at.0)), frame.map_y(plot.y.drawn(at.1)));
    for note in plot.notes.iter().filter(|note| !note.beside) {
        let (x, y) = pixel(note.at);
        text(scene, (x + 4.0, y + 15.0), &note.text, TextAnchor::Start);
    }
    let mut beside: Vec<((f64, f64), &str)> = plot
        .notes
        .iter()
        .filter(|note| note.beside)
        .map(|note| (pixel(note.at), note.text.as_str()))
        .collect();
    beside.sort_by(|a, b| a.0.1.total_cmp(&b.0.1));
    let heights = apart(
        &beside.iter().map(|note| note.0.1).collect::<Vec<_>>(),
        (frame.margin_top, frame.height - frame.margin_bottom),
    );
    let edge = frame.width - frame.margin_right;
    for ((end, content), height) in beside.iter().zip(heights) {
        scene.add(Primitive::Line {
            x1: end.0 + 2.0,
            y1: end.1,
            x2: edge + 4.0,
            y2: height,
            stroke: "#888888".into(),
            stroke_width: 0.7,
            stroke_dasharray: None,
        });
        text(scene, (edge + 7.0, height + 4.5), content, TextAnchor::Start);
    }
}

/// Heights as near as possible to the preferred ones, in the same order, at least one line of text apart, and
/// inside the limits.
fn apart(wanted: &[f64], limits: (f64, f64)) -> Vec<f64> {
    let mut heights: Vec<f64> = Vec::with_capacity(wanted.len());
    for want in wanted {
        let least = heights.last().map_or(limits.0 + 6.0, |last| last + NOTE_PITCH);
        heights.push(want.max(least));
    }
    let mut most = limits.1 - 4.0;
    for height in heights.iter_mut().rev() {
        *height = height.min(most);
        most = *height - NOTE_PITCH;
    }
    heights
}
