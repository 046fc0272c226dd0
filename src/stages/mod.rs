//! The stages: read, compute, commit. Only this module joins the physics and the files.
//!
//! [`run`] runs the stages in their order. Each stage of many tasks is run by one function.

mod aggregate;
mod compare;
mod contact_maps;
mod correction;
mod cycle;
mod cycle_input;
mod datapackage;
mod done;
mod error;
mod explorer;
mod explorer_maps;
mod extract;
mod failure;
mod foreseen;
mod generate;
mod grid_size;
mod identity;
mod live;
mod live_state;
mod measure;
mod outside;
mod pipeline;
mod report;
mod runner;
mod sampling;
mod single_cycle;
mod step_count;
mod surface;
mod task;

use crate::constants::Constants;
pub use compare::{Comparison, compare};
pub use cycle::{Units, unload_again, unload_elements_again};
pub use error::StageError;
pub use foreseen::{ARTEFACTS, Outside, foreseen};
pub use grid_size::slow_grids;
pub use measure::{Imported, measure};
pub use pipeline::{prepare, run};
pub use sampling::sampled;
pub use task::{Tally, Task, Watch};

/// Numerical choices and limits of cycles and of the report that are made here.
pub const CONSTANTS: [Constants; 2] = [
    Constants { subject: "Cycles", module: "stages::cycle", rows: cycle::CONSTANTS },
    Constants { subject: "Loop explorer", module: "stages::explorer", rows: explorer::CONSTANTS },
];
