//! Physics: surfaces, JKR asperities, elastic interaction, equilibrium and path of a cycle.
//!
//! This module opens no files and is independent of the stages. All quantities are in SI units; compression and penetration are positive.

pub mod boundary_elements;
pub mod constants;
pub mod contact;
pub mod cycle;
pub mod elements;
mod error;
mod event_kind;
pub mod half_space;
pub mod jkr;
mod loop_position;
mod math;
pub mod memory;
pub mod model;
pub mod path;
mod solve;
pub mod surface;
pub mod theory;

use crate::constants::Constants;
pub use error::{LoopError, PhysicsError, Reason};
pub use event_kind::{EventCounts, EventGroup, EventKind, RegionChange};
pub use loop_position::LoopPosition;

/// Tolerances and limits of the physics, by module.
pub const CONSTANTS: [Constants; 10] = [
    Constants { subject: "Valid cycles", module: "physics::cycle", rows: cycle::CONSTANTS },
    Constants { subject: "Path of the asperity model", module: "physics::path", rows: path::CONSTANTS },
    Constants { subject: "Global and local problems", module: "physics::solve", rows: solve::CONSTANTS },
    Constants { subject: "Sums over contacts", module: "physics::half_space", rows: half_space::CONSTANTS },
    Constants { subject: "Contacts", module: "physics::contact", rows: contact::CONSTANTS },
    Constants { subject: "One asperity", module: "physics::jkr", rows: jkr::CONSTANTS },
    Constants { subject: "Boundary elements", module: "physics::boundary_elements", rows: boundary_elements::CONSTANTS },
    Constants { subject: "Cycles by boundary elements", module: "physics::elements", rows: elements::CONSTANTS },
    Constants { subject: "Measured surfaces", module: "physics::surface", rows: surface::CONSTANTS },
    Constants { subject: "Analytical models", module: "physics::theory", rows: theory::CONSTANTS },
];
