//! Figures: five panels for each sweep, in the style of Figs 3 to 5 of the paper, and panels of a single
//! cycle.
//!
//! The colour is the case (a palette; numbers in their order along a scale), or with several varying
//! parameters the series. The dash is the branch: loading dashed, unloading solid. Analytical models are
//! black. Blue and red are compression and tension, in maps only. Lower loads of one case are lighter, and
//! each curve has its label at the end; loads whose curves coincide share one.

mod axis;
mod both;
mod captions;
mod closer;
mod curve;
mod cutoff;
mod cycle_loop;
mod drawing;
mod elements;
mod elements_map;
mod experiment;
mod formats;
mod grid_error;
mod hysteresis;
mod key;
mod map;
mod marks;
mod markup;
mod notes;
mod panels;
mod paths;
mod plot;
#[cfg(feature = "raster")]
mod raster;
mod results;
mod sensitivity;
mod sizes;
mod spectra;
mod style;
mod sweep;
mod table;
mod units;

pub use axis::Axis;
pub use both::{Both, both, method_ratios};
pub use closer::closer;
pub use curve::{Curve, KeyEntry, Note, Stroke, XyPlot};
pub use cutoff::{SimulatedWorks, works_over_cut_off};
pub use cycle_loop::Closer;
pub use drawing::Drawing;
pub use elements::{ElementsLoop, elements_loop};
pub use experiment::{Simulated, measured_loops};
pub use formats::file;
pub use grid_error::{OfGrids, over_grids};
pub use markup::described;
pub use panels::{Panel, compared, panels};
pub use plot::plot_xy;
pub use sensitivity::sensitivity;
pub use spectra::{Spectra, spectra};
pub use sweep::Tables;
pub use table::table;
pub use units::Units;

use crate::stats::StatsError;
use crate::store::FrameError;

/// Why a figure could not be drawn.
#[derive(Debug, thiserror::Error)]
pub enum FigureError {
    /// No case belongs to the sweep.
    #[error("unknown sweep {sweep:?}\nhelp: use one of {known}")]
    UnknownSweep {
        /// The sweep.
        sweep: String,
        /// Those of the table.
        known: String,
    },
    /// A picture could not be made into another format.
    #[error("cannot convert a figure to PNG or PDF: {0}")]
    Format(String),
    /// A table lacks a column.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// A table lacks a parameter.
    #[error(transparent)]
    Parameters(#[from] StatsError),
}
