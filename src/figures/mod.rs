//! Tables in, pictures out: five panels for each sweep, in the style of the paper's Figs 3 to 5, and a closer look at one cycle.
//!
//! Loading is green and dashed, unloading red and solid, the prediction of Deng and Kesari blue and dashed; the hues are told apart with any
//! colour vision, and the strokes without colour. Where the cases of a sweep differ, later ones are darker and each is named at its end.

mod axis;
mod captions;
mod closer;
mod formats;
mod key;
mod map;
mod marks;
mod markup;
mod panels;
mod paths;
mod plot;
mod results;
mod style;
mod sweep;
mod table;

pub use axis::Axis;
pub use closer::{Closer, closer};
pub use formats::{pdf, png};
pub use panels::{Panel, Tables, compared, panels};
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
    /// A picture could not be made into another format.
    #[error("cannot make a PNG or a PDF of a figure: {0}")]
    Format(String),
    /// A table lacks a column.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// A table lacks a parameter.
    #[error(transparent)]
    Parameters(#[from] StatsError),
}
