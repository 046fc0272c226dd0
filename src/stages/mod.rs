//! The stages: read, compute, commit. Only this module joins the physics and the files.
//!
//! [`run`] runs the stages in their order. Each stage of many tasks is run by one function.

mod aggregate;
mod compare;
mod contact_maps;
mod correction;
mod cost;
mod cutoff;
mod cycle;
mod cycle_input;
mod datapackage;
mod done;
mod error;
mod estimates;
mod experiment;
mod explorer;
mod explorer_maps;
mod extent;
mod extract;
mod failure;
mod foreseen;
mod generate;
mod grids;
mod identity;
mod live;
mod live_state;
mod measure;
mod measured_loop;
mod outside;
mod pipeline;
mod previews;
mod refining;
mod report;
mod runner;
mod sampling;
mod scan_spectra;
mod single_cycle;
mod spectra;
mod standings;
mod surface;
mod surface_row;
mod task;
mod verdict;
mod works;

use crate::constants::Constants;
pub use crate::physics::surface::common_spectrum::{BandRoughness, CommonRow};
pub use crate::physics::surface::periodogram::Ring;
pub use crate::physics::theory::probe::Estimate;
pub use compare::{Comparison, compare};
pub use cost::Cost;
pub use cycle::unload_again;
pub use error::StageError;
pub use estimates::Examined;
pub use foreseen::{ARTEFACTS, Foreseen, Outside, foreseen};
pub use grids::cycle_results;
pub use measure::{Imported, measure, scan_side_m};
pub use measured_loop::{MeasuredLoop, half_width, measure_loop};
pub use outside::in_words;
pub use pipeline::{prepare, run};
pub use refining::{AboveError, above_error};
pub use sampling::{sampled, undecided};
pub use scan_spectra::{Sample, SampleScan, csv as psd_csv, scans_table};
pub use task::{Tally, Task, Watch};
pub use verdict::{Verdict, chosen_method};

/// Numerical choices and limits of the physics, and those of cycles and of the report that are made here.
pub fn constants() -> impl Iterator<Item = Constants> {
    crate::physics::CONSTANTS.into_iter().chain(CONSTANTS)
}

const CONSTANTS: [Constants; 3] = [
    Constants { subject: "Cycles", module: "stages::cycle", rows: cycle::CONSTANTS },
    Constants { subject: "Loop explorer", module: "stages::explorer", rows: explorer::CONSTANTS },
    Constants { subject: "Estimates before a run", module: "stages::cost", rows: cycle::ESTIMATES },
];
