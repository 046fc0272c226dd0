//! The pipeline: files, verbs, tables.
#![allow(clippy::unwrap_used, clippy::expect_used)]

#[cfg(feature = "stats")]
mod bench;
#[cfg(feature = "stats")]
mod campaign;
#[cfg(feature = "stats")]
mod citation;
#[cfg(feature = "stats")]
mod cli;
#[cfg(feature = "stats")]
mod e2e;
#[cfg(feature = "stats")]
mod elements;
#[cfg(feature = "stats")]
mod explorer;
#[cfg(feature = "stats")]
mod extremes;
#[cfg(feature = "stats")]
mod figures;
#[cfg(feature = "stats")]
mod grids;
#[cfg(feature = "stats")]
mod guide;
#[cfg(feature = "stats")]
mod keys;
#[cfg(feature = "stats")]
mod labels;
#[cfg(feature = "stats")]
mod loops;
#[cfg(feature = "stats")]
mod losses;
#[cfg(feature = "stats")]
mod manifest;
#[cfg(feature = "stats")]
mod newtons;
#[cfg(feature = "stats")]
mod panels;
#[cfg(feature = "stats")]
mod probe;
mod profiles;
#[cfg(feature = "stats")]
mod python;
#[cfg(feature = "stats")]
mod refined;
#[cfg(feature = "stats")]
mod report;
#[cfg(feature = "stats")]
mod reversals;
#[cfg(feature = "store")]
mod scan;
mod schema;
#[cfg(feature = "stats")]
mod several;
#[cfg(feature = "stats")]
mod shifted;
#[cfg(feature = "stats")]
mod sinusoid;
#[cfg(feature = "stats")]
mod snapshots;
mod spec;
#[cfg(feature = "stats")]
mod spectrum;
#[cfg(feature = "stats")]
mod stats;
#[cfg(feature = "stats")]
mod steps;
#[cfg(feature = "store")]
mod store;
#[cfg(feature = "stats")]
mod style;
mod text;
#[cfg(feature = "stats")]
mod validity;
#[cfg(feature = "stats")]
mod verdict;
#[cfg(feature = "stats")]
mod works;
