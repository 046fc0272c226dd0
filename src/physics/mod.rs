//! Physics: surfaces, JKR asperities, elastic interaction, equilibrium and path of a cycle.
//!
//! This module opens no files and is independent of the stages. All quantities are in SI units; compression and penetration are positive.

pub mod boundary_elements;
pub mod contact;
pub mod cycle;
mod error;
pub mod half_space;
pub mod jkr;
mod math;
pub mod memory;
pub mod path;
mod solve;
pub mod surface;
pub mod theory;

pub use error::{PhysicsError, Reason};
