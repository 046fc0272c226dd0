//! hysteron: from a self-affine rough surface to the energy that its adhesive contact loses.
//!
//! Dependencies have one direction: `model` has none and `schema` reads only `model`; `physics` opens no file; `store` computes no result. `stages` alone
//! joins them, and computes for `stats` the analytical estimates of each cycle from its surface. `figures` and `report` read only tables.
//!
//! The documentation for users is the [`guide`].

#[cfg(feature = "stats")]
pub mod campaign;
#[cfg(feature = "stats")]
pub mod cli;
#[cfg(feature = "stats")]
pub mod engines;
#[cfg(feature = "stats")]
pub mod figures;
pub mod formats;
pub mod guide;
pub mod keys;
pub mod lengths;
pub mod model;
pub mod paths;
#[cfg(feature = "stats")]
pub mod report;
pub mod schema;
pub mod spec;
#[cfg(feature = "stats")]
pub mod stages;
#[cfg(feature = "stats")]
pub mod stats;
#[cfg(feature = "store")]
pub mod store;
pub mod text;

pub use hysteron_physics as physics;
pub use hysteron_physics::constants;
