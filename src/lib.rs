//! hysteron: from a self-affine rough surface to the energy that its adhesive contact loses.
//!
//! One direction, no way back: `model` and `schema` know nothing; `physics` opens no file; `store` computes nothing; `stages` alone joins them;
//! `stats` and `figures` read only tables.
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
pub mod physics;
pub mod schema;
pub mod spec;
#[cfg(feature = "stats")]
pub mod stages;
#[cfg(feature = "stats")]
pub mod stats;
#[cfg(feature = "store")]
pub mod store;
pub mod text;
