//! The table of all events of a run.

use super::event_kinds::KINDS_DOC;
use super::realizations::CASE;
use super::run::{ASPERITY_OR_REGION, BRANCH, MAX_LOAD, STEP};
use super::{ASPERITIES_ID, CYCLE_ID, Column, REALIZATION, SURFACE_ID, Table, index, join, real, text};

const EVENT: &[Column] = &[
    REALIZATION,
    CYCLE_ID,
    SURFACE_ID,
    ASPERITIES_ID,
    BRANCH,
    MAX_LOAD,
    STEP,
    index("avalanche_id", "Number of the avalanche in the table events of the cycle"),
    text("kind", KINDS_DOC),
    text("cause", "Kind of the event that causes the relaxation, in the words of kind"),
    ASPERITY_OR_REGION,
    real("approach_m", "m", "Mean penetration Δ at the event, with the zero of the table steps"),
    real("load_before_n", "N", "Normal load before the event, summed over all contact spots"),
    real("load_drop_n", "N", "Normal load before the event minus that after it; negative for an increase"),
    real("area_change_m2", "m^2", "Contact area after the event minus that before it"),
    real(
        "energy_lost_j",
        "J",
        "Energy dissipated in the event and the relaxation that follows; 0 for further events of the same \
         relaxation",
    ),
    real("energy_lost", "1", "Dissipated energy over E* A0 h_rms"),
];

const COLUMNS: [Column; CASE.len() + EVENT.len()] = join(&[CASE, EVENT]);

/// Events of all cycles.
pub static POOLED_EVENTS: Table = Table {
    name: "pooled_events",
    version: 1,
    file: "statistics/events.parquet",
    doc: "One row per event of every case and realization: the tables events of all cycles in one; join the \
         parameters of the case from the table cycles by cycle_id and case_id.",
    columns: &COLUMNS,
};
