//! The pipeline: files, verbs, tables.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod spec;
