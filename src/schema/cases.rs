//! The table of cases: means over realizations.

use super::event_kinds::event_kinds;
use super::grid_errors::{GRID_ERRORS, GRID_SURFACES};
use super::parameters::PARAMETER_COLUMNS;
use super::realizations::{CASE, MAX_LOAD};
use super::{Column, Table, count, join, real, text};

/// Mean, standard deviation and confidence interval of one result. All are null without a value; the last two
/// require two.
macro_rules! over_realizations {
    ($($name:literal)+, $unit:literal, $what:expr, $source:literal) => {
        &[
            real(concat!($($name,)+ "_mean"), $unit, concat!("Mean over realizations: ", $what))
                .or_null()
                .from($source),
            real(concat!($($name,)+ "_sd"), $unit, concat!("Standard deviation over \
                 realizations (n - 1): ", $what)).or_null().from($source),
            real(concat!($($name,)+ "_ci95_low"), $unit, concat!("Lower limit of the 95 % confidence \
                 interval of the mean (Student): ", $what)).or_null().from($source),
            real(concat!($($name,)+ "_ci95_high"), $unit, concat!("Upper limit of the 95 % confidence \
                 interval of the mean (Student): ", $what)).or_null().from($source),
        ]
    };
}

/// Mean and extreme value over surfaces, those of failed cycles included. Both are null without a value.
macro_rules! over_surfaces {
    ($name:literal, $what:literal, $source:literal) => {
        &[
            real(
                concat!($name, "_mean"),
                "1",
                concat!("Mean over the surfaces of finished and failed cycles: ", $what),
            )
            .or_null()
            .from($source),
            real(
                concat!($name, "_min"),
                "1",
                concat!("Minimum over the surfaces of finished and failed cycles: ", $what),
            )
            .or_null()
            .from($source),
        ]
    };
}

/// Pooled fraction of the contacts of all realizations, and its maximum over realizations. Both are null
/// without contacts.
macro_rules! pooled {
    ($name:literal, $sums:literal, $what:literal) => {
        &[
            real(concat!($name, "_mean"), "1", concat!("Pooled over realizations, ", $sums, ": ", $what))
                .or_null(),
            real(concat!($name, "_max"), "1", concat!("Maximum over realizations: ", $what)).or_null(),
        ]
    };
}

/// Mean and extreme value over realizations. Both are null without a value.
macro_rules! mean_and_worst {
    ($name:literal, $end:literal, $word:literal, $what:literal, $source:literal) => {
        &[
            real(concat!($name, "_mean"), "1", concat!("Mean over realizations: ", $what))
                .or_null()
                .from($source),
            real(concat!($name, "_", $end), "1", concat!($word, " over realizations: ", $what))
                .or_null()
                .from($source),
        ]
    };
}

/// Means of the parts of `dissipated`.
macro_rules! part_spreads {
    ($($kind:literal, $_remark:literal, $_colour:literal, $_step:literal, $_avalanche:literal,
        $of_kind:literal;)+) => {
        part_spreads! {
            "loading", "of events during loading";
            "unloading", "of events during unloading";
            $($kind, $of_kind;)+
        }
    };
    ($($part:literal, $what:literal;)+) => {
        const PART_SPREADS: &[&[Column]] = &[$(
            over_realizations!(
                "dissipated_" $part, "1", concat!("dissipated energy over E* A0 h_rms ", $what), ""
            ),
            over_realizations!("dissipated_" $part "_j", "J", concat!("dissipated energy ", $what), ""),
        )+];
    };
}

event_kinds!(part_spreads);

const SPREADS: &[&[Column]] = &[
    over_realizations!("pull_off_load", "1", "pull-off force F_po/(E* A0)", ""),
    over_realizations!("area_at_max_load", "1", "contact area A/A0 at load reversal", ""),
    over_realizations!("penetration_at_max_load", "1", "mean penetration Δ/h_rms at load reversal", ""),
    over_realizations!("loss", "1", "dissipated energy Θ/(E* A0 h_rms) of the loop", ""),
    over_realizations!("pull_off_load_n", "N", "pull-off force F_po", ""),
    over_realizations!("pull_off_pressure_pa", "Pa", "pull-off force over nominal area F_po/A0", ""),
    over_realizations!("loss_j_m2", "J/m^2", "dissipated energy per nominal area Θ/A0", ""),
    over_realizations!("loss_over_adhesion", "1", "dissipated energy Θ/(A0 Δγ)", ""),
    over_realizations!("work_closing_j_m2", "J/m^2", "work of adhesion of closing per nominal area", ""),
    over_realizations!("work_opening_j_m2", "J/m^2", "work of adhesion of opening per nominal area", ""),
    over_realizations!("loss_j", "J", "dissipated energy Θ", ""),
    over_realizations!("work_closing_j", "J", "energy of closing", ""),
    over_realizations!("work_opening_j", "J", "energy of opening", ""),
    over_realizations!(
        "work_pull_off_j_m2",
        "J/m^2",
        "apparent work of adhesion from the pull-off force",
        ""
    ),
    over_realizations!("work_loss_j_m2", "J/m^2", "apparent work of adhesion from Θ", ""),
    over_realizations!(
        "work_approach_j_m2",
        "J/m^2",
        "apparent work of adhesion of the JKR fit on approach",
        ""
    ),
    over_realizations!(
        "work_retraction_j_m2",
        "J/m^2",
        "apparent work of adhesion of the JKR fit on retraction",
        ""
    ),
    over_realizations!(
        "loss_dk",
        "1",
        "Deng-Kesari estimate Θ_DK/(E* A0 h_rms), moments of the continuous spectrum",
        "Eqs A1-A4"
    ),
    over_realizations!(
        "loss_dk_realised",
        "1",
        "Deng-Kesari estimate Θ_DK/(E* A0 h_rms), moments of the realized surface",
        "Eqs A1-A4"
    ),
    over_realizations!(
        "loss_dk_probe",
        "1",
        "Deng-Kesari estimate Θ_DK/(E* A0 h_rms) of the probe, moments of the continuous spectrum",
        "Deng and Kesari 2019"
    ),
    over_realizations!(
        "loss_dk_probe_realised",
        "1",
        "Deng-Kesari estimate Θ_DK/(E* A0 h_rms) of the probe, moments of the realized surface",
        "Deng and Kesari 2019"
    ),
    over_realizations!(
        "loss_touched",
        "1",
        "sum of the dissipated energies of single isolated asperities that came into contact, over E* A0 \
         h_rms",
        "Eq A1"
    ),
    over_realizations!(
        "loss_dalvi",
        "1",
        "work of adhesion times contact area at load reversal, over E* A0 h_rms",
        "Dalvi et al. 2019"
    ),
    over_realizations!(
        "loss_pinning",
        "1",
        "dissipated energy of crack-front pinning, 2 k U_el times contact area at load reversal, over E* A0 \
         h_rms",
        "Sanner et al. 2024"
    ),
    over_realizations!(
        "area_jkr_curve",
        "1",
        "contact area A/A0 at load reversal, approximate JKR theory from the adhesionless curve",
        "Ciavarella 2018"
    ),
    over_realizations!(
        "pull_off_jkr_curve",
        "1",
        "pull-off force F_po/(E* A0), approximate JKR theory from the adhesionless curve",
        "Ciavarella 2018"
    ),
    over_realizations!(
        "loss_jkr_curve",
        "1",
        "dissipated energy Θ/(E* A0 h_rms), approximate JKR theory from the adhesionless curve",
        "Ciavarella 2018"
    ),
    over_realizations!(
        "area_adhesionless",
        "1",
        "adhesionless contact area A/A0 at F_max, Persson's theory",
        "Persson 2001"
    ),
    over_realizations!(
        "area_adhesionless_small",
        "1",
        "adhesionless contact area A/A0 at F_max, small-load limit of boundary-element results",
        "Hyun et al. 2004"
    ),
    over_realizations!(
        "fuller_tabor",
        "1",
        "Fuller-Tabor parameter of the asperities",
        "Fuller and Tabor 1975"
    ),
    over_realizations!(
        "loss_ratio_dk",
        "1",
        "ratio Θ/Θ_DK, loss over loss_dk, with a probe over loss_dk_probe",
        ""
    ),
    over_realizations!(
        "dissipated",
        "1",
        "dissipated energy over E* A0 h_rms, summed over the events of the loop",
        ""
    ),
    over_realizations!("dissipated_j", "J", "dissipated energy, summed over the events of the loop", ""),
];

/// Indicators of validity of a row.
const VALIDITY: &[&[Column]] = &[
    mean_and_worst!(
        "audit_gap",
        "max",
        "Maximum",
        "energy-balance error |loss_j - dissipated_j| / |loss_j|",
        ""
    ),
    mean_and_worst!(
        "tabor_min",
        "min",
        "Minimum",
        "minimum Tabor parameter of the asperities of a surface",
        "Eq 3"
    ),
    mean_and_worst!(
        "tabor_mean",
        "min",
        "Minimum",
        "mean Tabor parameter of the asperities of a surface",
        "Eq 3"
    ),
    mean_and_worst!(
        "low_tabor_share",
        "max",
        "Maximum",
        "fraction of asperities with a Tabor parameter below 2",
        "Eq 3"
    ),
    mean_and_worst!(
        "absorption_share",
        "max",
        "Maximum",
        "coalescence energy over dissipated energy, |cover + uncover + merge + split|/|Θ|",
        ""
    ),
    mean_and_worst!(
        "elements_per_wavelength",
        "min",
        "Minimum",
        "grid points of boundary elements per shortest wavelength",
        ""
    ),
    mean_and_worst!("probe_extent", "max", "Maximum", "distance of a contact edge from the apex over L", ""),
    mean_and_worst!("texture_aspect", "max", "Maximum", "texture aspect ratio of a measured surface", ""),
    mean_and_worst!(
        "filter_overshoot",
        "max",
        "Maximum",
        "height of filtered maxima above the measured heights nearby, beyond the noise, over h_rms",
        ""
    ),
    mean_and_worst!("loss_uncertainty", "max", "Maximum", "resolution of Θ over |Θ|", ""),
    mean_and_worst!(
        "outlier_share",
        "max",
        "Maximum",
        "fraction of outliers among the points of a measured surface",
        ""
    ),
    mean_and_worst!(
        "line_jump_share",
        "max",
        "Maximum",
        "rms offset between the scan lines of a measured surface, over h_rms",
        ""
    ),
    mean_and_worst!(
        "noise_share",
        "max",
        "Maximum",
        "rms height of the noise that the S-filter removed, over h_rms",
        ""
    ),
    mean_and_worst!(
        "curvature_ratio",
        "min",
        "Minimum",
        "curvature of the sharpest summits over that of the sharpest valleys, of a rounded measured surface",
        ""
    ),
    pooled!(
        "touching_share",
        "sum of touching_count_at_max_load over sum of contact_count_at_max_load",
        "fraction of contact spots that overlap a neighbour at load reversal"
    ),
    pooled!(
        "covered_share",
        "sum of covered_count_at_max_load over sum of absorbed and contacting asperities",
        "absorbed fraction of the asperities in contact or absorbed, at load reversal"
    ),
    mean_and_worst!(
        "contact_count_at_max_load",
        "min",
        "Minimum",
        "number of asperities in contact at load reversal",
        ""
    ),
    mean_and_worst!(
        "touching_count_at_max_load",
        "max",
        "Maximum",
        "number of contact spots at load reversal that overlap a neighbour",
        ""
    ),
    over_surfaces!("summit_count", "number of asperities of a surface", ""),
    over_surfaces!(
        "conformity",
        "U_el/Δγ of the shortest octave, continuous spectrum",
        "Persson and Tosatti 2001"
    ),
    over_surfaces!(
        "conformity_realised",
        "U_el/Δγ of the shortest octave, realized spectrum",
        "Persson and Tosatti 2001"
    ),
    over_surfaces!(
        "persson_tosatti",
        "Persson-Tosatti ratio U_el/Δγ, continuous spectrum",
        "Persson and Tosatti 2001"
    ),
    over_surfaces!(
        "persson_tosatti_realised",
        "Persson-Tosatti ratio U_el/Δγ, realized spectrum",
        "Persson and Tosatti 2001"
    ),
    over_surfaces!("sticky_line", "Wang-Müser ratio U_el/(2 Δγ), realized spectrum", "Wang and Müser 2022"),
];

const COUNTS: &[Column] = &[
    count("planned_count", "Realizations requested by the spec"),
    count("done_count", "Realizations in the means"),
    count("failed_count", "Realizations that failed"),
    count(
        "unresolved_count",
        "Realizations with a null dissipated energy, since it is not resolved; they \
         are in the means of the other results",
    )
    .or_null(),
    count(
        "not_reached_count",
        "Finished realizations without a result at this load reversal: the load was \
         not reached, or its unloading failed; the reasons are in the column failure of the table cycles",
    )
    .or_null(),
    real("nominal_area_m2_mean", "m^2", "Mean over realizations: nominal area A0 of the surface or scan")
        .or_null(),
    real(
        "area_model_ratio",
        "1",
        "Expected ratio of the asperity model to boundary elements at this \
         U_el/Δγ: contact area at F_max; null for boundary elements, without interaction, for a texture \
         aspect ratio above 2 and outside the measured range",
    )
    .or_null()
    .from("pipelines/validity.toml"),
    real(
        "area_model_ratio_error",
        "1",
        "Uncertainty of the expected ratio of the contact area: standard deviation over the surfaces of the \
         table and grid error of boundary elements, added squared",
    )
    .or_null()
    .from("pipelines/validity.toml"),
    real("pull_off_model_ratio", "1", "The same ratio of the pull-off force")
        .or_null()
        .from("pipelines/validity.toml"),
    real(
        "pull_off_model_ratio_error",
        "1",
        "Uncertainty of the expected ratio of the pull-off force, in the same way",
    )
    .or_null()
    .from("pipelines/validity.toml"),
    real("loss_model_ratio", "1", "The same ratio of the dissipated energy")
        .or_null()
        .from("pipelines/validity.toml"),
    real(
        "loss_model_ratio_error",
        "1",
        "Uncertainty of the expected ratio of the dissipated energy, in the same way",
    )
    .or_null()
    .from("pipelines/validity.toml"),
    text("load_unit", "Unit of the load reversals in the spec: \"1\" (over E* A0), \"N\" or \"Pa\"")
        .or_null(),
    text("caution", "Codes of all warnings of the row by severity, joined by +; empty without warnings"),
];

/// Numbers of realizations behind means that not every finished realization has.
const MEAN_COUNTS: &[Column] = &[
    count("work_approach_j_m2_count", "Realizations in the mean of work_approach_j_m2: those with a JKR fit")
        .or_null(),
    count(
        "work_retraction_j_m2_count",
        "Realizations in the mean of work_retraction_j_m2: those with a JKR fit",
    )
    .or_null(),
    count("work_pull_off_j_m2_count", "Realizations in the mean of work_pull_off_j_m2").or_null(),
    count("work_loss_j_m2_count", "Realizations in the mean of work_loss_j_m2").or_null(),
];

const SPREAD_COLUMNS: [Column; 4 * SPREADS.len()] = join(SPREADS);
const PART_SPREAD_COLUMNS: [Column; 4 * PART_SPREADS.len()] = join(PART_SPREADS);
const VALIDITY_COLUMNS: [Column; 2 * VALIDITY.len()] = join(VALIDITY);

static CASE_COLUMNS: [Column;
    CASE.len()
        + PARAMETER_COLUMNS.len()
        + MAX_LOAD.len()
        + SPREAD_COLUMNS.len()
        + PART_SPREAD_COLUMNS.len()
        + VALIDITY_COLUMNS.len()
        + MEAN_COUNTS.len()
        + GRID_ERRORS.len()
        + GRID_SURFACES.len()
        + COUNTS.len()] = join(&[
    CASE,
    &PARAMETER_COLUMNS,
    MAX_LOAD,
    &SPREAD_COLUMNS,
    &PART_SPREAD_COLUMNS,
    &VALIDITY_COLUMNS,
    MEAN_COUNTS,
    GRID_ERRORS,
    GRID_SURFACES,
    COUNTS,
]);

/// Means over realizations.
pub static CASES: Table = Table {
    name: "cases",
    version: 1,
    file: "statistics/cases.parquet",
    doc: "One row per case and load reversal, averaged over realizations, in the order of the spec.",
    columns: &CASE_COLUMNS,
};
