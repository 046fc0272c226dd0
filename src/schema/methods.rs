//! The table of both methods side by side.

use super::{Column, REALIZATION, SURFACE_ID, Table, count, join, real, text};

/// Values of both methods on one surface, their ratio, and its statistics over the surfaces.
macro_rules! compared {
    ($name:literal, $what:literal) => {
        &[
            real(
                concat!($name, "_asperities"),
                "1",
                concat!($what, ", asperity model; null where it is not resolved"),
            )
            .or_null(),
            real(
                concat!($name, "_elements"),
                "1",
                concat!($what, ", boundary elements; null where it is not resolved"),
            )
            .or_null(),
            real(
                concat!($name, "_ratio"),
                "1",
                concat!(
                    "Ratio of asperity model to boundary elements: ",
                    $what,
                    "; null where the latter is 0, and of a dissipated energy that is not resolved"
                ),
            )
            .or_null(),
            real(
                concat!($name, "_ratio_mean"),
                "1",
                concat!("Mean over the surfaces of the pair of cases: ratio of ", $what),
            )
            .or_null(),
            real(
                concat!($name, "_ratio_sd"),
                "1",
                concat!("Standard deviation over these surfaces (n - 1): ratio of ", $what),
            )
            .or_null(),
            real(
                concat!($name, "_ratio_ci95_low"),
                "1",
                concat!(
                    "Lower limit of the 95 % confidence interval of the mean (Student): ratio of ",
                    $what
                ),
            )
            .or_null(),
            real(
                concat!($name, "_ratio_ci95_high"),
                "1",
                concat!(
                    "Upper limit of the 95 % confidence interval of the mean (Student): ratio of ",
                    $what
                ),
            )
            .or_null(),
        ]
    };
}

const PAIR: &[Column] = &[
    text("asperities_case_id", "Identifier of the case of the asperity model"),
    text("elements_case_id", "Identifier of the case of boundary elements"),
    SURFACE_ID,
    REALIZATION,
    real("max_load", "1", "Normal load F_max/(E* A0) at the load reversal"),
    real(
        "persson_tosatti_realised",
        "1",
        "Persson-Tosatti ratio U_el/Δγ for the realized spectrum of the surface; null where that is unknown",
    )
    .or_null()
    .from("Persson and Tosatti 2001"),
    count("surface_count", "Surfaces of the pair of cases that both methods have finished"),
];

const COMPARED: &[&[Column]] = &[
    compared!("area_at_max_load", "contact area A/A0 at load reversal"),
    compared!("pull_off_load", "pull-off force F_po/(E* A0)"),
    compared!("loss", "dissipated energy Θ/(E* A0 h_rms) of the loop"),
];

const COMPARED_COLUMNS: [Column; 7 * COMPARED.len()] = join(COMPARED);

const COLUMNS: [Column; PAIR.len() + COMPARED_COLUMNS.len()] = join(&[PAIR, &COMPARED_COLUMNS]);

/// Both methods on the same surfaces.
pub static METHODS: Table = Table {
    name: "methods",
    version: 1,
    file: "statistics/methods.parquet",
    doc: "One row per pair of cases of the same surface and material, one by each method, surface and load \
         reversal. Without such a pair the table has no row.",
    columns: &COLUMNS,
};
