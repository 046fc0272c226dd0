//! Figures as PNG and PDF (feature `raster`). Letters come from fonts of the program, so that a figure has
//! the same bytes on every machine.

use super::FigureError;
use resvg::tiny_skia::{Color, Pixmap, Transform};
use std::sync::{Arc, LazyLock};
use svg2pdf::usvg::{Options, Tree, fontdb::Database};
use svg2pdf::{ConversionOptions, PageOptions};

/// Dots of a PNG for each pixel of the picture: about 420 dpi where a panel is one column of a journal wide.
const DOTS: f32 = 3.0;

/// Pixels per inch on paper, if a panel without notes at its right has this width \[mm\].
fn pixels_per_inch(width_mm: f64) -> f32 {
    (480.0 / (width_mm / 25.4)) as f32
}

/// The letters that figures use, of DejaVu Sans.
static FONTS: LazyLock<Arc<Database>> = LazyLock::new(|| {
    let mut fonts = Database::new();
    fonts.load_font_data(include_bytes!("../../data/fonts/DejaVuSans.ttf").to_vec());
    fonts.load_font_data(include_bytes!("../../data/fonts/DejaVuSans-Bold.ttf").to_vec());
    fonts.set_sans_serif_family("DejaVu Sans");
    Arc::new(fonts)
});

fn tree(svg: &str) -> Result<Tree, FigureError> {
    let options =
        Options { fontdb: FONTS.clone(), font_family: "DejaVu Sans".to_owned(), ..Options::default() };
    Tree::from_str(svg, &options).map_err(|error| FigureError::Format(error.to_string()))
}

/// A picture as a PNG file.
///
/// # Errors
/// If the text is no SVG, or the figure is too large for memory.
pub fn png(svg: &str, width_mm: f64) -> Result<Vec<u8>, FigureError> {
    let tree = tree(svg)?;
    let size = tree.size();
    let [width, height] = [size.width(), size.height()].map(|pixels| (pixels * DOTS).ceil() as u32);
    let mut dots = Pixmap::new(width, height)
        .ok_or_else(|| FigureError::Format(format!("it has {width} x {height} dots")))?;
    // On white, so that every dot is opaque.
    dots.fill(Color::WHITE);
    resvg::render(&tree, Transform::from_scale(DOTS, DOTS), &mut dots.as_mut());
    let colours: Vec<u8> =
        dots.pixels().iter().flat_map(|dot| [dot.red(), dot.green(), dot.blue()]).collect();
    encode(&colours, width, height, pixels_per_inch(width_mm))
        .map_err(|error| FigureError::Format(error.to_string()))
}

fn encode(
    colours: &[u8],
    width: u32,
    height: u32,
    pixels_per_inch: f32,
) -> Result<Vec<u8>, png::EncodingError> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(png::ColorType::Rgb);
    // Flat colours: this is small, and many times as fast as the default.
    encoder.set_compression(png::Compression::Fast);
    let per_metre = (DOTS * pixels_per_inch / 0.0254).round() as u32;
    encoder.set_pixel_dims(Some(png::PixelDimensions {
        xppu: per_metre,
        yppu: per_metre,
        unit: png::Unit::Meter,
    }));
    encoder.write_header()?.write_image_data(colours)?;
    Ok(file)
}

/// A picture as a PDF file of one page, its letters as text.
///
/// # Errors
/// If the text is no SVG.
pub fn pdf(svg: &str, width_mm: f64) -> Result<Vec<u8>, FigureError> {
    let page = PageOptions { dpi: pixels_per_inch(width_mm) };
    // The library writes several fonts in an order that differs between runs. One font is enough for the
    // letter of a panel.
    let svg = svg.replace(" font-weight=\"bold\"", "");
    let file = svg2pdf::to_pdf(&tree(&svg)?, ConversionOptions::default(), page)
        .map_err(|error| FigureError::Format(error.to_string()))?;
    Ok(in_order(&file))
}

/// The file with the resources of each page and group in order: the library lists them in the order of a hash
/// map, which differs between runs. Lines change places with others of the same list, so that all that
/// follows stays where it is.
fn in_order(file: &[u8]) -> Vec<u8> {
    let mut ordered = Vec::with_capacity(file.len());
    let mut list: Vec<&[u8]> = Vec::new();
    let mut in_stream = false;
    for line in file.split_inclusive(|byte| *byte == b'\n') {
        if !in_stream && is_resource(line) {
            list.push(line);
            continue;
        }
        list.sort_unstable();
        ordered.extend(list.drain(..).flatten());
        ordered.extend(line);
        in_stream = if in_stream { !line.ends_with(b"endstream\n") } else { line == b"stream\n" };
    }
    list.sort_unstable();
    ordered.extend(list.into_iter().flatten());
    ordered
}

/// True if a line is an entry such as `/gs46 53 0 R`.
fn is_resource(line: &[u8]) -> bool {
    let Ok(text) = std::str::from_utf8(line) else { return false };
    let mut words = text.split_whitespace();
    let named = words
        .next()
        .is_some_and(|name| name.starts_with('/') && name.ends_with(|c: char| c.is_ascii_digit()));
    named && words.next().is_some_and(|number| number.parse::<u32>().is_ok()) && words.eq(["0", "R"])
}
