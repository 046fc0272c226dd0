//! Contact of asperities: the problem, its states and the transitions between them.

mod constants;
pub(crate) mod event;
pub(crate) mod merged_spot;
pub(crate) mod merging;
pub(crate) mod neighbours;
mod numbering;
pub(crate) mod problem;
pub mod rows;
pub(crate) mod spring;
pub(crate) mod state;
pub(crate) mod transition;
pub mod union_area;

pub(crate) use constants::CONSTANTS;
pub use event::Event;
pub use problem::{Problem, Rules};
pub use state::{State, Status};
