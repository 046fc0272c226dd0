//! A figure that is no line plot.

use super::markup::described;

/// A figure with its caption.
#[derive(Debug, Clone)]
pub struct Drawing {
    /// Stem of the name of its file.
    pub stem: &'static str,
    /// Caption.
    pub caption: String,
    /// The drawing.
    pub svg: String,
}

impl Drawing {
    /// A drawing that has its caption as description.
    #[must_use]
    pub fn new(stem: &'static str, caption: String, svg: &str) -> Self {
        Self { stem, svg: described(svg, &caption), caption }
    }
}
