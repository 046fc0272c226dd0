//! The path of equilibria under displacement control, from event to event.

mod avalanche;
mod carried;
mod corrector;
mod equilibrium_path;
pub(crate) mod event_log;
mod limit;
mod neighbourhood;
mod pending;
mod predictor;
mod triggers;

pub(crate) use carried::Carried;
pub use equilibrium_path::{DRIFT, EVENT_TOLERANCE};
pub(crate) use equilibrium_path::{Depth, Path, is_multiple};
