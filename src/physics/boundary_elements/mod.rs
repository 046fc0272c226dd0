//! Adhesive boundary elements: equilibrium of a rough surface on an elastic half-space, resolved on a grid.
//!
//! Imports nothing of the asperity model. Inside, lengths are in grid spacings `dx`, stresses in E*, energies in `E* dx³`.

pub mod adhesionless;
mod constants;
pub mod contact;
pub mod cycle;
pub mod equilibrium;
pub mod grid;
mod increment;
pub mod law;
pub mod minimise;
mod morse;
mod newton;
mod pairs;
mod passes;
pub mod patch;
mod places;
pub mod preconditioner;
pub mod records;
pub mod regions;
pub mod resample;
mod reversal;
mod stations;
mod step;
mod sums;
mod trial;
pub mod work;

pub(super) use constants::CONSTANTS;
