//! Events: regions of contact, and the energy dissipated in a step.

pub mod regions;
pub mod work;
