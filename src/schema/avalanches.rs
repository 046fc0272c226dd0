//! The table of avalanches.

use super::event_kinds::OF_AVALANCHES;
use super::realizations::CASE;
use super::{
    ASPERITIES_ID, CYCLE_ID, Column, REALIZATION, SURFACE_ID, Table, count, index, join, real, text,
};

const AVALANCHE: &[Column] = &[
    REALIZATION,
    CYCLE_ID,
    SURFACE_ID,
    ASPERITIES_ID,
    text("branch", "\"loading\" or \"unloading\""),
    real(
        "max_load",
        "1",
        "Normal load F_max/(E* A0) at the load reversal from which this unloading starts; null for loading, \
         which is common to all load reversals",
    )
    .or_null(),
    index("avalanche_id", "Number of the avalanche in the table events of the cycle"),
    index("step", "Output step of the first event, as in the table steps"),
    real("approach_m", "m", "Mean penetration Δ at the first event, with the zero of the table steps"),
    count("event_count", "Size of the avalanche: number of events"),
];

const ENERGY: &[Column] = &[
    real(
        "energy_lost_j",
        "J",
        "Dissipated energy, summed over the events; may be negative with absorption, which has no potential",
    ),
    real("energy_lost", "1", "Dissipated energy over E* A0 h_rms; sign as energy_lost_j"),
    real(
        "load_drop_n",
        "N",
        "Normal load before the first event minus normal load after the last; negative for an increase",
    ),
    real(
        "area_change_m2",
        "m^2",
        "Contact area after the last event minus contact area before the first; negative for a decrease",
    ),
];

const COLUMNS: [Column; CASE.len() + AVALANCHE.len() + OF_AVALANCHES.len() + ENERGY.len()] =
    join(&[CASE, AVALANCHE, &OF_AVALANCHES, ENERGY]);

/// Events caused by one instability.
pub static AVALANCHES: Table = Table {
    name: "avalanches",
    version: 1,
    file: "statistics/avalanches.parquet",
    doc: "One row per avalanche and realization; join the parameters of the case from the table cycles by \
         cycle_id.",
    columns: &COLUMNS,
};
