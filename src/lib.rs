//! hysteron: from a self-affine rough surface to the energy that its adhesive contact loses.
#[cfg(feature = "stats")]
pub mod figures;
pub mod model;
pub mod physics;
pub mod spec;
pub mod schema;
#[cfg(feature = "stats")]
pub mod stats;
#[cfg(feature = "store")]
pub mod store;
