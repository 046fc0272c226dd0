//! The table of cycles, which joins tables of single cycles to cases.

use super::parameters::PARAMETER_COLUMNS;
use super::realizations::CASE;
use super::{ASPERITIES_ID, CYCLE_ID, Column, REALIZATION, SURFACE_ID, Table, join, text};

const CYCLE: &[Column] = &[
    REALIZATION,
    CYCLE_ID,
    SURFACE_ID,
    ASPERITIES_ID,
    text("status", "\"done\", \"failed\", or \"planned\" if not yet computed when this table was written"),
    text(
        "failure",
        "Error message of a failed cycle; of a finished one the load reversals without a result and the \
         error of the first; null otherwise",
    )
    .or_null(),
];

const COLUMNS: [Column; CASE.len() + CYCLE.len() + PARAMETER_COLUMNS.len()] =
    join(&[CASE, CYCLE, &PARAMETER_COLUMNS]);

/// Cycles with the parameters of their cases.
pub static CYCLES: Table = Table {
    name: "cycles",
    version: 1,
    file: "statistics/cycles.parquet",
    doc: "One row per case and realization, with the parameters of the case; join it by cycle_id. \
          Cases that differ only in as_printed may share a cycle.",
    columns: &COLUMNS,
};
