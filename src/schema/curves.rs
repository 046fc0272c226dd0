//! Tables of averaged paths and of the panels of figures.

use super::realizations::CASE;
use super::{Table, count, index, real, text};

/// Averaged loading and unloading paths.
pub static CURVES: Table = Table {
    name: "curves",
    version: 1,
    file: "statistics/curves.parquet",
    doc: "One row per case, branch and station, averaged over realizations. From the load reversal to zero \
          load the stations are loads common to all realizations; below zero load they are equal fractions \
          of the maximum tensile load of each realization on the branch.",
    columns: &[
        CASE[0],
        CASE[1],
        real(
            "max_load",
            "1",
            "Normal load F_max/(E* A0) at the load reversal from which this unloading starts; null for \
             loading, which is common to all load reversals",
        )
        .or_null(),
        text("branch", "\"loading\" or \"unloading\""),
        index(
            "grid_index",
            "Number of the station along the branch, from 0; a station without realizations \
             has no row",
        ),
        text(
            "station",
            "Rule of the station: \"load\" (same load in all realizations) or \"tension_fraction\" (same \
             fraction of the maximum tensile load of each realization)",
        ),
        real(
            "tension_fraction",
            "1",
            "Tensile load over the maximum tensile load of the realization on this branch; null if station \
             is \"load\"",
        )
        .or_null(),
        real(
            "load",
            "1",
            "Normal load F/(E* A0), positive in compression: the common load, or the mean of \
             the loads of the realizations if station is \"tension_fraction\"",
        ),
        real(
            "area_mean",
            "1",
            "Mean contact area A/A0 over the realizations, each at its own load if \
             station is \"tension_fraction\"",
        ),
        real(
            "area_sd",
            "1",
            "Standard deviation of A/A0 over the realizations (n - 1); null for fewer than \
             two",
        )
        .or_null(),
        real(
            "penetration_mean",
            "1",
            "Mean of the mean penetration Δ/h_rms over the realizations, each at its own load if station is \
             \"tension_fraction\"",
        ),
        real(
            "penetration_sd",
            "1",
            "Standard deviation of Δ/h_rms over the realizations (n - 1); null for \
             fewer than two",
        )
        .or_null(),
        count(
            "realization_count",
            "Realizations in the means: all that reach the load if station is \"load\", otherwise all; one \
             without tensile load enters at zero load",
        ),
    ],
};

/// Data of the panels of the figures.
pub static PANELS: Table = Table {
    name: "panels",
    version: 1,
    file: "statistics/panels.parquet",
    doc: "One row per point of each curve of each panel of the figures, in drawing order.",
    columns: &[
        text("sweep", "Name of the sweep; empty for the panels of a single cycle"),
        text(
            "panel",
            "Panel: A contact area, B pull-off force, C mean penetration, D dissipated energy, E dissipated \
             energy by branch, with the ending _SI in the units of the labels; a name for a single cycle",
        ),
        index("curve", "Number of the curve in the panel, from 0"),
        text("name", "Quantity of the curve: a branch, a column of the table cases without _mean, or a name"),
        text("of", "Cases of the curve, as labelled in the panel; empty if the panel has a single series"),
        index("point", "Number of the point along the curve, from 0"),
        real(
            "x",
            "1",
            "Horizontal value of the quantity x_label; a swept parameter is in the unit of its \
             column in the table cases",
        ),
        real("y", "1", "Vertical value of the quantity y_label"),
        real(
            "y_sd",
            "1",
            "Standard deviation over realizations (n - 1), drawn as error bar or band; null \
             where none is drawn",
        )
        .or_null(),
        text("x_label", "Label of the horizontal axis, with _{} for subscripts and ^{} for superscripts"),
        text("y_label", "Label of the vertical axis"),
    ],
};
