//! The path of equilibria under displacement control, from event to event.

mod accuracy;
mod apply;
mod avalanche;
mod chatter;
mod checkpoint;
mod corrector;
mod energy;
mod equilibrium_path;
mod event_log;
mod events;
mod excursion;
mod neighbourhood;
mod pending;
mod predictor;
mod propagation;
mod rejection;
mod step_control;
mod triggers;
mod work;

pub use accuracy::{DRIFT, EVENT_TOLERANCE};
pub(crate) use checkpoint::PathCheckpoint;
pub(crate) use equilibrium_path::EquilibriumPath;
pub(crate) use step_control::is_multiple;
