//! The table of avalanches, and the kinds of events that it counts.

use super::statistics::CASE;
use super::{ASPERITIES_ID, CYCLE_ID, Column, REALIZATION, SURFACE_ID, Table, count, index, join, real, text};

/// Every kind of event that the tables `events` may hold, in the order in which the tables over realizations have them.
pub const EVENT_KINDS: [&str; 7] = ["jump_in", "jump_off", "cover", "uncover", "snap", "merge", "split"];

const AVALANCHE: &[Column] = &[
    REALIZATION,
    CYCLE_ID,
    SURFACE_ID,
    ASPERITIES_ID,
    text("branch", "\"loading\" or \"unloading\""),
    real(
        "max_load",
        "1",
        "F/(E* A0) from which this unloading began; null while loading, since one loading path serves every turning point",
    )
    .or_null(),
    index("avalanche_id", "Number of the avalanche in the table events of its cycle"),
    index("step", "Step of its first event, as in the table steps"),
    real("approach_m", "m", "Approach of the surface at its first event, zero as in the table steps"),
    count("event_count", "Its size: how many events it has"),
    count("jump_in_count", "Asperities that jumped into contact in it"),
    count("jump_off_count", "Asperities that jumped out of contact in it"),
    count("cover_count", "Asperities that were covered in it"),
    count("uncover_count", "Asperities that were uncovered in it"),
    count("snap_count", "Moves of the contact to another equilibrium with the same spots in it"),
    count("merge_count", "Spots that became one with another in it"),
    count("split_count", "Spots that parted again in it"),
    real(
        "energy_lost_j",
        "J",
        "Energy lost in it, the sum over its events; negative where covering, which has no potential, gained energy",
    ),
    real("energy_lost", "1", "Energy lost in it over E* A0 h_rms"),
    real("load_drop_n", "N", "Load before its first event less load after its last one; negative where the load rose"),
    real("area_change_m2", "m^2", "Area after its last event less area before its first one; negative where area was lost"),
];

const COLUMNS: [Column; CASE.len() + AVALANCHE.len()] = join(&[CASE, AVALANCHE]);

/// What one instability brought about.
pub static AVALANCHES: Table = Table {
    name: "avalanches",
    version: 1,
    file: "statistics/avalanches.parquet",
    doc: "One row per avalanche of each realization; what defines its case stands in the table cases, by case_id.",
    columns: &COLUMNS,
};
