//! Files of a figure.

use super::FigureError;

/// The file of a figure in a format that this build writes;
/// `width_mm` is the width of a panel on paper \[mm\], `font` that of SVG files.
///
/// # Errors
/// If the text is no SVG, or the picture does not fit in memory.
#[cfg_attr(not(feature = "raster"), expect(unused_variables, reason = "SVG has no width on paper"))]
pub fn file(format: &str, svg: &str, width_mm: f64, font: &str) -> Result<Vec<u8>, FigureError> {
    match format {
        #[cfg(feature = "raster")]
        "png" => super::raster::png(svg, width_mm),
        #[cfg(feature = "raster")]
        "pdf" => super::raster::pdf(svg, width_mm),
        _ => Ok(with_font(svg, font).into_bytes()),
    }
}

/// The SVG with a further font family before the existing ones.
fn with_font(svg: &str, font: &str) -> String {
    svg.replacen("font-family=\"", &format!("font-family=\"{font}, "), 1).replacen(
        &format!("{font}, {font}, "),
        &format!("{font}, "),
        1,
    )
}
