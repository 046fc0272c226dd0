//! Tables of measured loops.

use super::{Column, Table, count, flag, index, join, real, text};

/// A result of a measured loop, and the limits of its 95 % interval.
macro_rules! with_interval {
    ($name:literal, $unit:literal, $what:literal, $source:literal) => {
        &[
            real($name, $unit, $what).or_null().from($source),
            real(
                concat!($name, "_ci95_low"),
                $unit,
                concat!("Lower limit of the 95 % confidence interval (Student) of ", $name),
            )
            .or_null(),
            real(
                concat!($name, "_ci95_high"),
                $unit,
                concat!("Upper limit of the 95 % confidence interval (Student) of ", $name),
            )
            .or_null(),
        ]
    };
}

const SOURCE: Column = text("source", "Name of the file of the loop, without its folder");

const OF_FILE: &[Column] = &[
    SOURCE,
    text("source_blake3", "BLAKE3 checksum of the file, hexadecimal"),
    text("columns_read", "Columns of the file that were read, with their units"),
    text("signs", "Factors of displacement and force from the file to this table: 1 or -1"),
    count("point_count", "Points of the loop"),
];

const RESULTS: &[&[Column]] = &[
    with_interval!(
        "pull_off_load_n",
        "N",
        "Pull-off force F_po: magnitude of the most negative load during unloading, the minimum of a \
         polynomial fitted near it; null without tension",
        ""
    ),
    with_interval!(
        "loss_j",
        "J",
        "Dissipated energy Θ of the loop, the integral of the load over the displacement",
        ""
    ),
    with_interval!(
        "work_closing_j",
        "J",
        "Energy of closing: given by the surfaces from separation to zero load on the unloading path",
        ""
    ),
    with_interval!(
        "work_opening_j",
        "J",
        "Energy of opening: from zero load on the unloading path to separation",
        ""
    ),
    with_interval!(
        "work_pull_off_j_m2",
        "J/m^2",
        "Apparent work of adhesion from the pull-off force, F_po/(1.5 π R); null without probe radius",
        "Johnson, Kendall and Roberts 1971"
    ),
    with_interval!(
        "work_loss_j_m2",
        "J/m^2",
        "Apparent work of adhesion from Θ of a smooth sphere under displacement control; null without \
         probe radius",
        "Eq A1"
    ),
    with_interval!(
        "work_approach_j_m2",
        "J/m^2",
        "Apparent work of adhesion of a JKR fit of the approach; null if the fit has none",
        "Johnson, Kendall and Roberts 1971"
    ),
    with_interval!(
        "work_retraction_j_m2",
        "J/m^2",
        "Apparent work of adhesion of a JKR fit of the retraction; null if the fit has none",
        "Johnson, Kendall and Roberts 1971"
    ),
    with_interval!(
        "contact_modulus_fit_pa",
        "Pa",
        "Apparent reduced modulus of a JKR fit with the modulus as a parameter: of the retraction if the \
         contact radius is known, else of both branches",
        "Johnson, Kendall and Roberts 1971"
    ),
];

const RESULT_COLUMNS: [Column; 3 * RESULTS.len()] = join(RESULTS);

const DETAILS: &[Column] = &[
    text("fit", "Fitted curve: \"radius\" (load over contact radius) or \"load\" (load over penetration)")
        .or_null(),
    real(
        "fit_residual_approach_n",
        "N",
        "Root-mean-square residual of the load of the JKR fit of the approach",
    )
    .or_null(),
    real(
        "fit_residual_retraction_n",
        "N",
        "Root-mean-square residual of the load of the JKR fit of the retraction",
    )
    .or_null(),
    real(
        "fit_residual",
        "1",
        "Residual of the JKR fit of the retraction over the maximum magnitude of the load",
    )
    .or_null(),
    real("max_load_n", "N", "Load at the load reversal"),
    real("probe_radius_m", "m", "Given radius R of the probe; null without one").or_null(),
    real("contact_modulus_pa", "Pa", "Given reduced modulus E* of the fits; null if it was fitted").or_null(),
    real(
        "machine_stiffness_n_m",
        "N/m",
        "Stiffness k of the machine: F/k is subtracted from the displacement",
    )
    .or_null(),
    text("baseline", "Baseline that was subtracted from the load: \"line\", \"offset\" or \"none\""),
    real("baseline_offset_n", "N", "Offset of the subtracted baseline, with the sign of this table"),
    real("baseline_slope_n_m", "N/m", "Slope of the subtracted baseline along the displacement"),
    real("baseline_drift_n", "N", "Drift of the subtracted baseline from the first to the last point"),
    count("baseline_approach_count", "Points without contact on approach to which the baseline was fitted"),
    count(
        "baseline_retraction_count",
        "Points without contact on retraction to which the baseline was fitted",
    ),
    real("noise_n", "N", "Standard deviation of the load without contact about the baseline"),
    real(
        "closure",
        "1",
        "Load at the end less that at the start, before subtraction, over the range of the load",
    ),
];

const LOOP_COLUMNS: [Column; OF_FILE.len() + RESULT_COLUMNS.len() + DETAILS.len()] =
    join(&[OF_FILE, &RESULT_COLUMNS, DETAILS]);

/// Results of measured loops.
pub static MEASURED_LOOPS: Table = Table {
    name: "measured_loops",
    version: 1,
    file: "statistics/measured_loops.parquet",
    doc: "One row per measured loop of `[experiment]` of the spec. Columns with the name of one of \
        the table realizations have the same meaning.",
    columns: &LOOP_COLUMNS,
};

/// Points of measured loops.
pub static MEASURED_STEPS: Table = Table {
    name: "measured_steps",
    version: 1,
    file: "statistics/measured_steps.parquet",
    doc: "One row per point of a measured loop. Columns with the name of one of the table steps have the \
        same meaning; what was not measured is null.",
    columns: &[
        SOURCE,
        index("step", "Number of the point along the loop, from 0"),
        text("branch", "\"loading\" or \"unloading\""),
        index("line", "Line of the file, from 1"),
        real(
            "approach_m",
            "m",
            "Penetration: displacement less F/k of the machine; 0 at the first contact on approach",
        ),
        real("load_n", "N", "Normal load F less the baseline; positive in compression, negative in tension"),
        real("area_m2", "m^2", "Contact area A = πa²; null where no contact radius was measured").or_null(),
        real("contact_radius_m", "m", "Contact radius a; null where none was measured").or_null(),
        real("time_s", "s", "Time; null where none was recorded").or_null(),
        real("displacement_m", "m", "Displacement of the file, with the sign of this table"),
        real(
            "force_n",
            "N",
            "Force of the file before subtraction of the baseline, with the sign of this table",
        ),
        real("work_j", "J", "Work done on the contact and the machine since the start of the branch"),
        flag("in_contact", "True between the first contact on approach and the separation"),
    ],
};
