//! The table of cycles, which joins the tables of single cycles to the cases.

use super::statistics::{CASE, PARAMETERS};
use super::{ASPERITIES_ID, CYCLE_ID, Column, REALIZATION, SURFACE_ID, Table, join, text};

const CYCLE: &[Column] = &[
    REALIZATION,
    CYCLE_ID,
    SURFACE_ID,
    ASPERITIES_ID,
    text("status", "\"done\", \"failed\", or \"planned\" if it was not computed before the tables were written"),
    text("failure", "Error message of a failed cycle; null otherwise").or_null(),
];

const COLUMNS: [Column; CASE.len() + CYCLE.len() + PARAMETERS.len()] = join(&[CASE, CYCLE, PARAMETERS]);

/// Cycles with the parameters of their cases.
pub static CYCLES: Table = Table {
    name: "cycles",
    version: 1,
    file: "statistics/cycles.parquet",
    doc: "One row per case and realization, with the parameters of the case; cycle_id joins it to the tables of the cycle. \
          Cases that differ only in as_printed may share a cycle.",
    columns: &COLUMNS,
};
