//! The table of a comparison of runs.

use super::parameters::PARAMETER_COLUMNS;
use super::{Column, Table, count, flag, index, join, real, text};

/// Paired cases of two runs.
pub static COMPARISON: Table = Table {
    name: "comparison",
    version: 1,
    file: "comparison.parquet",
    doc: "One row per quantity and pair of cases with equal parameters, except those in which the runs \
          differ; the first run is the reference. The parameters are those of the compared case; rows are in \
          the order of the parameters.",
    columns: COLUMNS,
};

const COLUMNS: &[Column] = &join::<{ OWN.len() + PARAMETER_COLUMNS.len() }>(&[OWN, &PARAMETER_COLUMNS]);

const OWN: &[Column] = &[
    index("group", "Number of the group of compared cases, from 0, as in the figures"),
    text("campaign", "Name of the compared run"),
    text("case_id", "Identifier of the case in the compared run"),
    text("reference", "Name of the reference run"),
    text("reference_case_id", "Identifier of the case in the reference run"),
    real("max_load", "1", "Normal load F_max/(E* A0) at the load reversal"),
    text("quantity", "Compared quantity: a column of the table realizations"),
    real("mean", "1", "Mean over the realizations of the compared run"),
    real("reference_mean", "1", "Mean over the realizations of the reference run"),
    real(
        "difference",
        "1",
        "Mean minus reference_mean; if paired, mean of the differences surface by surface",
    ),
    real(
        "difference_ci95",
        "1",
        "Half-width of the 95 % confidence interval of the difference (Student if paired, else Welch); null \
         for too few realizations",
    )
    .or_null(),
    real("relative_difference", "1", "Difference over |reference_mean|; null where that is 0").or_null(),
    flag(
        "paired",
        "True if both runs have the same surfaces, so that the difference is formed surface by \
         surface",
    ),
    count("realization_count", "Realizations in the mean of the compared run; pairs if paired"),
    count("reference_realization_count", "Realizations in the mean of the reference run; pairs if paired"),
];
