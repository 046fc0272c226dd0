//! Tables in, pictures out: four panels for each sweep, in the style of the paper's Figs 3 to 5.
//!
//! Loading is green and dashed, unloading red and solid, the prediction of Deng and Kesari blue and dashed; the hues are told apart with any
//! colour vision, and the strokes without colour. Where the cases of a sweep differ, later ones are darker and each is named at its end.

mod axis;
mod key;
mod markup;
mod panels;
mod paths;
mod plot;
mod results;
mod style;
mod sweep;
mod table;

pub use axis::Axis;
pub use panels::{Panel, panels};
pub use plot::{Curve, KeyEntry, Note, Stroke, XyPlot, plot_xy};
pub use table::table;

use crate::stats::StatsError;
use crate::store::FrameError;

/// Why a figure could not be drawn.
#[derive(Debug, thiserror::Error)]
pub enum FigureError {
    /// No case belongs to the sweep.
    #[error("no case belongs to the sweep {sweep:?}; there are: {known}")]
    UnknownSweep {
        /// The sweep.
        sweep: String,
        /// Those of the table.
        known: String,
    },
    /// A table lacks a column.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// A table lacks a parameter.
    #[error(transparent)]
    Parameters(#[from] StatsError),
}
