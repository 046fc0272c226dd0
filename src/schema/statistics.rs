//! The tables over realizations.

use super::{ASPERITIES_ID, CYCLE_ID, Column, REALIZATION, SURFACE_ID, Table, count, index, join, real, text};

pub(super) const CASE: &[Column] = &[
    text("case_id", "Identity of the case: a hash of everything that defines it"),
    text("sweep", "The sweeps of the spec that the case belongs to, joined by +; empty for a spec without sweeps"),
];

/// What defines a case, a column each.
pub(super) const PARAMETERS: &[Column] = &[
    text("surface_file", "File of a measured surface, with as many of its folders as tell it from the others; null for a generated one")
        .or_null(),
    text("surface_dataset", "Which field of that file; null for the only one, and for a generated surface").or_null(),
    text("detrend", "What was taken off a measured surface: \"mean\", \"plane\" or \"quadratic\"; null for a generated one").or_null(),
    real("hurst", "1", "Hurst exponent H; null for a measured surface").or_null().from("Eq 10"),
    real("magnification", "1", "Magnification, longest over shortest wavelength; null for a measured surface").or_null().from("Eq 10"),
    real("length_m", "m", "Side of the square, L; null for a measured surface that could not be taken").or_null().from("Eq 10"),
    real("rms_height_m", "m", "Rms height: the one asked for, or that of the measured surface; null where that could not be taken")
        .or_null(),
    real("points_per_shortest_wavelength", "1", "Grid points per shortest wavelength; of a measured surface, shorter waves were taken off")
        .or_null(),
    text("normalization", "How the surface got its rms height: \"sample\" or \"spectrum\"; null for a measured surface").or_null(),
    text("amplitudes", "The moduli of the Fourier modes: \"fixed\" or \"gaussian\"; null for a measured surface").or_null(),
    real("contact_modulus_pa", "Pa", "Contact modulus E*").from("Eq 1"),
    real("work_of_adhesion_j_m2", "J/m^2", "Work of adhesion").from("Eq 1"),
    real("interaction_range_m", "m", "Range of attraction").from("Eq 3"),
    text("interaction", "How contact spots act on one another: \"spots\", \"point\", \"reciprocal\" or \"none\"").from("Eqs 6-8"),
    text("boundary", "What surrounds the square: \"periodic\" or \"isolated\""),
    text("coalescence", "What happens when a spot grows over another asperity: \"cover\", \"merge\" or \"none\"").from("Eq 8"),
    text("jump_in", "When a free asperity jumps into contact: \"wu\" or \"jkr\"").from("Eq 3"),
    text("as_printed", "Slips of the paper that were put back, joined by +; empty if none"),
    real("approach_step", "1", "Greatest step of the approach, in rms heights"),
];

/// Mean, spread and interval of one result. All are null where no realization has it; spread and interval need two.
macro_rules! over_realizations {
    ($($name:literal)+, $unit:literal, $what:expr, $source:literal) => {
        &[
            real(concat!($($name,)+ "_mean"), $unit, concat!("Mean over realizations: ", $what)).or_null().from($source),
            real(concat!($($name,)+ "_sd"), $unit, concat!("Standard deviation over realizations (n - 1): ", $what)).or_null().from($source),
            real(concat!($($name,)+ "_ci95_low"), $unit, concat!("Lower end of the 95 % interval of the mean: ", $what)).or_null().from($source),
            real(concat!($($name,)+ "_ci95_high"), $unit, concat!("Upper end of the 95 % interval of the mean: ", $what)).or_null().from($source),
        ]
    };
}

/// Mean over realizations and the worst of them. Both are null where no realization has it.
macro_rules! mean_and_worst {
    ($name:literal, $end:literal, $word:literal, $what:literal, $source:literal) => {
        &[
            real(concat!($name, "_mean"), "1", concat!("Mean over realizations: ", $what)).or_null().from($source),
            real(concat!($name, "_", $end), "1", concat!($word, " over realizations: ", $what)).or_null().from($source),
        ]
    };
}

const MAX_LOAD: &[Column] = &[real("max_load", "1", "F/(E* A0) at which loading turned to unloading")];

const RESULTS: &[Column] = &[
    REALIZATION,
    CYCLE_ID,
    SURFACE_ID,
    ASPERITIES_ID,
    MAX_LOAD[0],
    real("pull_off_load", "1", "Pull-off load over E* A0: the greatest tension while unloading"),
    real("pull_off_load_n", "N", "Pull-off load: the greatest tension while unloading"),
    real("area_at_max_load", "1", "A/A0 at the end of loading, the sum of the discs"),
    real("area_union_at_max_load", "1", "A/A0 at the end of loading, the union of the discs; null where it was not computed").or_null(),
    real("area_adhesionless", "1", "A/A0 at this load without adhesion, erf(sqrt(2) F/(E* A0 rms_slope)), of the gradient that this surface has").from("Persson 2001"),
    real("area_adhesionless_small", "1", "A/A0 at small loads without adhesion as boundary elements find it, 2 F/(E* A0 rms_slope)").from("Hyun et al. 2004"),
    real("penetration_at_max_load", "1", "Approach over rms height at the end of loading"),
    real("loss", "1", "Energy lost in the loop over E* A0 h_rms"),
    real("loss_j", "J", "Energy lost in the loop, the integral of load over approach around it"),
    real("loss_dk", "1", "Loss after Deng and Kesari over E* A0 h_rms, at this area, from the moments of the continuous spectrum; null for a measured surface, and where the printed Eq A2 has no integral")
        .or_null()
        .from("Eqs A1-A4"),
    real("loss_dk_realised", "1", "Loss after Deng and Kesari over E* A0 h_rms, at this area, from the moments that this surface has; null where they do not define one")
        .or_null()
        .from("Eqs A1-A4"),
    real("loss_touched", "1", "Sum over the asperities that came into contact of what each loses by itself, over E* A0 h_rms: the loss without interaction, of asperities that jump in at zero penetration").from("Eq A1"),
    real("loss_dalvi", "1", "Work of adhesion times contact area at the end of loading, over E* A0 h_rms").from("Dalvi et al. 2019"),
    real("loss_ratio_dk", "1", "Loss over loss_dk; null where either is missing or the latter is 0").or_null(),
    real("dissipated", "1", "Energy lost in the loop over E* A0 h_rms, the sum over its events"),
    real("dissipated_j", "J", "Energy lost in the loop, the sum over its events"),
    real("audit_gap", "1", "|loss_j - dissipated_j| / loss_j; null where nothing was lost").or_null(),
    real("absorption_share", "1", "Part of the dissipated energy Θ from contacts that meet and part: |cover + uncover| + |merge + split| of the energies of these events, over Θ; null where Θ = 0").or_null(),
    real("loss_uncertainty", "1", "Numerical resolution of Θ, 1e-7 of the largest work along the loop, over Θ; null where Θ = 0").or_null(),
    count("summit_count", "Asperities of the surface"),
    real("summit_density_1_m2", "1/m^2", "Asperities per area"),
    real("nayak_density_1_m2", "1/m^2", "Density of summits of a Gaussian surface with the moments that this surface has")
        .from("Eq A4, Nayak 1971"),
    count("contact_count_at_max_load", "Asperities in contact at the end of loading"),
    count("step_count", "Steps of loading and of this unloading"),
    count("unconverged_count", "Those of them whose residual stayed above the tolerance"),
    count("held_count", "Asperities held as they are since they flipped between covered and uncovered, summed over the steps"),
    real("tabor_min", "1", "Smallest Tabor number of the asperities").from("Eq 3"),
    real("tabor_median", "1", "Median Tabor number of the asperities").from("Eq 3"),
    real("tabor_max", "1", "Greatest Tabor number of the asperities").from("Eq 3"),
    real("tabor_mean", "1", "Mean Tabor number of the asperities").from("Eq 3"),
    real("low_tabor_share", "1", "Share of the asperities whose Tabor number is below 2, where Wu's jump-in does not hold").from("Eq 3"),
    real("rms_slope", "1", "Rms of the gradient that this surface has"),
    real("rms_curvature_1_m", "1/m", "Rms of the Laplacian that this surface has"),
    real("nayak_parameter", "1", "m0 m4 / m2^2 that this surface has").from("Nayak 1971"),
    real("fuller_tabor", "1", "Adhesion parameter E* sd(height)^(3/2)/(mean(radius)^(1/2) work of adhesion) of the summits; above about 10 adhesion is lost; null for fewer than two summits and without adhesion").or_null().from("Fuller and Tabor 1975"),
    real("touching_share", "1", "Share of contact spots that touch another one at the end of loading; null without contact").or_null(),
    real("covered_share", "1", "Share of asperities in contact or covered that are covered, at the end of loading; null without contact").or_null(),
    real("conformity", "1", "Elastic energy that flattens the shortest octave of the roughness over the work of adhesion, of the continuous spectrum; below 1 adhesion conforms to the summits; null for a measured surface and without adhesion")
        .or_null()
        .from("Persson and Tosatti 2001"),
    real("conformity_realised", "1", "The same of the modes that this surface has; null where they are not known")
        .or_null()
        .from("Persson and Tosatti 2001"),
    real("persson_tosatti", "1", "Elastic energy that flattens all the roughness over the work of adhesion, of the continuous spectrum; below 1 the surface is sticky; null for a measured surface and without adhesion")
        .or_null()
        .from("Persson and Tosatti 2001"),
    real("persson_tosatti_realised", "1", "The same of the modes that this surface has; null where they are not known")
        .or_null()
        .from("Persson and Tosatti 2001"),
];

/// Where the energy of the events goes: `dissipated` in parts, over E* A0 h_rms and in joule. The first two make the whole, and so do the others.
macro_rules! parts {
    ($($part:literal, $what:literal;)+) => {
        const PARTS: &[&[Column]] = &[$(&[
            real(concat!("dissipated_", $part), "1", concat!("Energy lost ", $what, " over E* A0 h_rms")),
            real(concat!("dissipated_", $part, "_j"), "J", concat!("Energy lost ", $what)),
        ]),+];
        const PART_SPREADS: &[&[Column]] = &[$(
            over_realizations!("dissipated_" $part, "1", concat!("energy lost ", $what, " over E* A0 h_rms"), ""),
            over_realizations!("dissipated_" $part "_j", "J", concat!("energy lost ", $what), ""),
        )+];
    };
}

parts! {
    "loading", "in events on the way to the turning point";
    "unloading", "in events on the way back from the turning point";
    "jump_in", "in asperities' jumps into contact, with what relaxed after them";
    "jump_off", "in asperities' jumps out of contact, with what relaxed after them";
    "cover", "in the covering of asperities, with what relaxed after it; negative where energy was gained, since covering has no potential";
    "uncover", "in the uncovering of asperities, with what relaxed after it; negative where energy was gained, since covering has no potential";
    "snap", "in moves to another equilibrium with the same spots";
    "merge", "in spots that become one, with what relaxed after them";
    "split", "in spots that part again, with what relaxed after them";
}

const PART_COLUMNS: [Column; 2 * PARTS.len()] = join(PARTS);

const REALIZATION_COLUMNS: [Column; CASE.len() + PARAMETERS.len() + RESULTS.len() + PART_COLUMNS.len()] =
    join(&[CASE, PARAMETERS, RESULTS, &PART_COLUMNS]);

/// One cycle, in numbers.
pub static REALIZATIONS: Table = Table {
    name: "realizations",
    version: 1,
    file: "statistics/realizations.parquet",
    doc: "One row per case, realization and turning point.",
    columns: &REALIZATION_COLUMNS,
};

const SPREADS: &[&[Column]] = &[
    over_realizations!("pull_off_load", "1", "pull-off load over E* A0", ""),
    over_realizations!("area_at_max_load", "1", "A/A0 at the end of loading", ""),
    over_realizations!("penetration_at_max_load", "1", "approach over rms height at the end of loading", ""),
    over_realizations!("loss", "1", "energy lost in the loop over E* A0 h_rms", ""),
    over_realizations!("loss_dk", "1", "loss after Deng and Kesari, continuous moments", "Eqs A1-A4"),
    over_realizations!("loss_dk_realised", "1", "loss after Deng and Kesari, realised moments", "Eqs A1-A4"),
    over_realizations!("loss_touched", "1", "sum of what the asperities that touched lose by themselves over E* A0 h_rms", "Eq A1"),
    over_realizations!("loss_dalvi", "1", "work of adhesion times contact area over E* A0 h_rms", "Dalvi et al. 2019"),
    over_realizations!("area_adhesionless", "1", "A/A0 at this load without adhesion", "Persson 2001"),
    over_realizations!("area_adhesionless_small", "1", "A/A0 at small loads without adhesion, boundary elements", "Hyun et al. 2004"),
    over_realizations!("fuller_tabor", "1", "adhesion parameter of the summits", "Fuller and Tabor 1975"),
    over_realizations!("loss_ratio_dk", "1", "loss over loss after Deng and Kesari", ""),
    over_realizations!("dissipated", "1", "energy lost in the events of the loop over E* A0 h_rms", ""),
    over_realizations!("dissipated_j", "J", "energy lost in the events of the loop", ""),
];

/// What tells how far a row is to be trusted.
const VALIDITY: &[&[Column]] = &[
    mean_and_worst!("audit_gap", "max", "Greatest", "|loss_j - dissipated_j| / |loss_j|", ""),
    mean_and_worst!("tabor_min", "min", "Least", "smallest Tabor number of the asperities", "Eq 3"),
    mean_and_worst!("tabor_mean", "min", "Least", "mean Tabor number of the asperities", "Eq 3"),
    mean_and_worst!("low_tabor_share", "max", "Greatest", "share of the asperities whose Tabor number is below 2", "Eq 3"),
    mean_and_worst!(
        "absorption_share",
        "max",
        "Largest",
        "net energy of cover and uncover, and of merge and split events, over the dissipated energy",
        ""
    ),
    mean_and_worst!("loss_uncertainty", "max", "Largest", "numerical resolution of the dissipated energy over the dissipated energy", ""),
    mean_and_worst!("touching_share", "max", "Greatest", "share of contact spots that touch another one at the end of loading", ""),
    mean_and_worst!(
        "covered_share",
        "max",
        "Greatest",
        "share of asperities in contact or covered that are covered at the end of loading",
        ""
    ),
    mean_and_worst!(
        "conformity",
        "min",
        "Least",
        "energy of flattening the shortest octave over the work of adhesion, continuous spectrum",
        "Persson and Tosatti 2001"
    ),
    mean_and_worst!(
        "conformity_realised",
        "min",
        "Least",
        "energy of flattening the shortest octave over the work of adhesion, realised modes",
        "Persson and Tosatti 2001"
    ),
    mean_and_worst!(
        "persson_tosatti",
        "min",
        "Least",
        "energy of flattening all the roughness over the work of adhesion, continuous spectrum",
        "Persson and Tosatti 2001"
    ),
    mean_and_worst!(
        "persson_tosatti_realised",
        "min",
        "Least",
        "energy of flattening all the roughness over the work of adhesion, realised modes",
        "Persson and Tosatti 2001"
    ),
];

const COUNTS: &[Column] = &[
    count("planned_count", "Realizations that the spec asks for"),
    count("done_count", "Realizations that are in the means"),
    count("failed_count", "Realizations that failed"),
    text("caution", "What speaks against trusting the row, words joined by +; empty if nothing does"),
];

const SPREAD_COLUMNS: [Column; 4 * SPREADS.len()] = join(SPREADS);
const PART_SPREAD_COLUMNS: [Column; 4 * PART_SPREADS.len()] = join(PART_SPREADS);
const VALIDITY_COLUMNS: [Column; 2 * VALIDITY.len()] = join(VALIDITY);

const CASE_COLUMNS: [Column;
    CASE.len()
        + PARAMETERS.len()
        + MAX_LOAD.len()
        + SPREAD_COLUMNS.len()
        + PART_SPREAD_COLUMNS.len()
        + VALIDITY_COLUMNS.len()
        + COUNTS.len()] = join(&[CASE, PARAMETERS, MAX_LOAD, &SPREAD_COLUMNS, &PART_SPREAD_COLUMNS, &VALIDITY_COLUMNS, COUNTS]);

/// Means over realizations.
pub static CASES: Table = Table {
    name: "cases",
    version: 1,
    file: "statistics/cases.parquet",
    doc: "One row per case and turning point, averaged over realizations.",
    columns: &CASE_COLUMNS,
};

/// Averaged loading and unloading paths.
pub static CURVES: Table = Table {
    name: "curves",
    version: 1,
    file: "statistics/curves.parquet",
    doc: "One row per case, branch and station, averaged over realizations. From the load reversal to zero load the stations are loads common to all \
          realizations; below zero load they are equal fractions of the maximum tensile load of each realization on the branch.",
    columns: &[
        CASE[0],
        CASE[1],
        real(
            "max_load",
            "1",
            "F/(E* A0) from which this unloading began; null while loading, since one loading path serves every turning point",
        )
        .or_null(),
        text("branch", "\"loading\" or \"unloading\""),
        index("grid_index", "Number of the station along the branch, from 0; a station without realizations has no row"),
        text(
            "station",
            "Rule of the station: \"load\" (the same load in every realization) or \"tension_fraction\" (the same fraction of each realization's own maximum tensile load)",
        ),
        real(
            "tension_fraction",
            "1",
            "Tensile load of each realization over its own maximum tensile load on this branch; null if station is \"load\"",
        )
        .or_null(),
        real("load", "1", "F/(E* A0): the common load, or the mean of the realizations' own loads if station is \"tension_fraction\""),
        real("area_mean", "1", "Mean of A/A0 over the realizations, each at its own load if station is \"tension_fraction\""),
        real("area_sd", "1", "Standard deviation of A/A0 (n - 1); null for fewer than two").or_null(),
        real(
            "penetration_mean",
            "1",
            "Mean of approach over rms height over the realizations, each at its own load if station is \"tension_fraction\"",
        ),
        real("penetration_sd", "1", "Standard deviation of approach over rms height (n - 1); null for fewer than two").or_null(),
        count(
            "realization_count",
            "Realizations in the means: those that reach the load if station is \"load\"; otherwise all, and one without tension is taken at zero load",
        ),
    ],
};

/// What the panels of the figures show.
pub static PANELS: Table = Table {
    name: "panels",
    version: 1,
    file: "statistics/panels.parquet",
    doc: "One row per point of a curve of a panel of the figures, in the order of drawing.",
    columns: &[
        text("sweep", "The sweep that the panel is of; empty for the closer look at one cycle"),
        text("panel", "Its letter: A area, B pull-off load, C penetration, D loss, E loss by branches; a word in the closer look"),
        index("curve", "Number of the curve in the panel, from 0"),
        text("name", "What it shows: a branch, a column of the table cases without _mean, or a word"),
        text("of", "Of what of the sweep, as the panel names it; empty if there is no choice"),
        index("point", "Number of the point on its curve, from 0"),
        real("x", "1", "Horizontal value, as x_label says; in units of the data, which for a swept parameter are its own"),
        real("y", "1", "Vertical value, as y_label says"),
        real("y_sd", "1", "Standard deviation over realizations (n - 1), drawn as a bar or a band; null where there is none").or_null(),
        text("x_label", "Label of the horizontal axis, with _{} for subscripts and ^{} for superscripts"),
        text("y_label", "Label of the vertical axis"),
    ],
};
