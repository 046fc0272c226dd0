//! hysteron: from a self-affine rough surface to the energy that its adhesive contact loses.
//!
//! From a spec to the report:
//! 1. `cli` reads the command line; [`spec`] reads the TOML file into the parameters of cases ([`model`]),
//!    with the place of every error.
//! 2. `campaign` lists the tasks of all stages and their keys, and derives the status of each from the files
//!    that are there.
//! 3. `stages` computes the tasks that are missing, by dependency, in any number of processes; `engines`
//!    hands them to Slurm or Snakemake.
//! 4. Stage generate: a surface from its spectrum and seed, or from a measured file by the readers in
//!    `store`, into HDF5.
//! 5. Stage extract: its asperities and its analytical estimates ([`physics::theory::estimates`]), into
//!    Parquet.
//! 6. Stage cycle: a method ([`physics::cycle::Method`]) loads and unloads the surface and returns a
//!    [`physics::cycle::Cycle`] in SI units. One writer makes its steps, contacts, events and estimates;
//!    each method adds its own files (load reversals and merged contacts; maps and adhesionless loading).
//! 7. Stage aggregate: `stats` has the statistics over realizations, from the tables of the cycles and the
//!    rows of estimates.
//! 8. Stage report: `figures` draws the tables, `report` writes the page.
//!
//! Dependencies have one direction: `physics` is a crate of its own that opens no file. [`model`] adds the
//! parameters of a case to those of the physics. [`schema`] defines every table and column. `store`, [`spec`]
//! and `campaign` use types and formulas of the physics; only `stages` runs cycles and writes their results.
//! `figures` and `report` read only tables.
//!
//! The documentation for users is the [`guide`].

#[cfg(feature = "stats")]
pub mod campaign;
pub mod citation;
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
