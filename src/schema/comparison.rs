//! The table that `report --compare` writes.

use super::{Column, Table, count, flag, index, real, text};

/// What two campaigns say of the same thing, side by side.
pub static COMPARISON: Table = Table {
    name: "comparison",
    version: 1,
    file: "comparison.parquet",
    doc: "One row per pair of cases that differ in nothing but what tells their campaigns apart, and per quantity; the first campaign is what the others are compared with.",
    columns: COLUMNS,
};

const COLUMNS: &[Column] = &[
    index("group", "Number of the group of cases that are compared, from 0, as the figures have it"),
    text("campaign", "The campaign that is compared"),
    text("case_id", "Its case"),
    text("reference", "The campaign that it is compared with"),
    text("reference_case_id", "Its case"),
    real("max_load", "1", "F/(E* A0) at which loading turned to unloading"),
    text("quantity", "What is compared: a column of the table realizations"),
    real("mean", "1", "Mean over realizations"),
    real("reference_mean", "1", "Mean over the realizations of the reference"),
    real("difference", "1", "Mean less that of the reference; of the pairs alone where they are paired"),
    real(
        "difference_ci95",
        "1",
        "Half the 95 % interval of the difference (Student; Welch's where not paired); null where it takes more realizations",
    )
    .or_null(),
    real("relative_difference", "1", "Difference over the magnitude of the reference's mean; null where that is 0").or_null(),
    flag("paired", "Whether both have the same surfaces, so that differences are taken surface by surface"),
    count("realization_count", "Realizations that are in the mean; pairs where they are paired"),
    count("reference_realization_count", "Realizations of the reference; pairs where they are paired"),
];
