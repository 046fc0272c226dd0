//! The table of realizations.

use super::event_kinds::event_kinds;
use super::grid_errors::GRID_ERRORS;
use super::parameters::PARAMETER_COLUMNS;
use super::probe_results::OF_PROBE;
use super::{ASPERITIES_ID, CYCLE_ID, Column, REALIZATION, SURFACE_ID, Table, count, join, real, text};

pub(super) const CASE: &[Column] = &[
    text("case_id", "Identifier of the case: short name of the surface and a hash of all parameters"),
    text("sweep", "Names of the sweeps that contain the case, joined by +; empty for a spec without sweeps"),
];

pub(super) const MAX_LOAD: &[Column] = &[
    real("max_load", "1", "Normal load F_max/(E* A0) at the load reversal"),
    real("max_load_n", "N", "Normal load F_max at the load reversal; null where A0 is unknown").or_null(),
    real("max_load_pa", "Pa", "Nominal pressure F_max/A0 at the load reversal").or_null(),
];

const RESULTS: &[Column] = &[
    REALIZATION,
    CYCLE_ID,
    SURFACE_ID,
    ASPERITIES_ID,
    MAX_LOAD[0],
    MAX_LOAD[1],
    MAX_LOAD[2],
    real(
        "nominal_area_m2",
        "m^2",
        "Nominal area A0 = L^2 of the surface or scan. F = load E* A0 and A = \
         area A0 in all tables, also where boundary elements continue a scan by mirror images",
    )
    .or_null(),
    real(
        "pull_off_load",
        "1",
        "Pull-off force F_po/(E* A0): magnitude of the most negative normal load \
         during unloading; null with adhesion where no tension is resolved",
    )
    .or_null(),
    real(
        "pull_off_load_n",
        "N",
        "Pull-off force F_po: magnitude of the most negative normal load during \
         unloading; null with adhesion where no tension is resolved",
    )
    .or_null(),
    real("pull_off_pressure_pa", "Pa", "Pull-off force over nominal area F_po/A0; null likewise").or_null(),
    real("area_at_max_load", "1", "Contact area A/A0 at load reversal, summed over the contact discs"),
    real(
        "area_union_at_max_load",
        "1",
        "Contact area A/A0 at load reversal, union of the contact discs; \
         null where it was not computed",
    )
    .or_null(),
    real(
        "area_adhesionless",
        "1",
        "Adhesionless contact area A/A0 at F_max, Persson's theory: erf(sqrt(2) \
         F/(E* A0 rms_slope))",
    )
    .from("Persson 2001"),
    real(
        "area_jkr_curve",
        "1",
        "Contact area A/A0 at load reversal, approximate JKR theory from the \
         adhesionless curve of the same surface; null for asperities, where that curve ends below the load, \
         and where it snaps to near full contact",
    )
    .or_null()
    .from("Ciavarella 2018"),
    real("pull_off_jkr_curve", "1", "Pull-off force F_po/(E* A0) of the same theory; null likewise")
        .or_null()
        .from("Ciavarella 2018"),
    real(
        "loss_jkr_curve",
        "1",
        "Dissipated energy Θ/(E* A0 h_rms) of the same theory, with contact formed \
         at zero penetration; null likewise",
    )
    .or_null()
    .from("Ciavarella 2018"),
    real(
        "area_adhesionless_small",
        "1",
        "Adhesionless contact area A/A0 at F_max, small-load limit of \
         boundary-element results: 2 F/(E* A0 rms_slope)",
    )
    .from("Hyun et al. 2004"),
    real("penetration_at_max_load", "1", "Mean penetration Δ/h_rms at load reversal"),
    real(
        "loss",
        "1",
        "Dissipated energy Θ/(E* A0 h_rms) of the loop; null where it is negative, since it is \
         not resolved",
    )
    .or_null(),
    real(
        "loss_j",
        "J",
        "Dissipated energy Θ: area of the loop of normal load over mean penetration; null \
         where it is negative, since it is not resolved",
    )
    .or_null(),
    real("loss_j_m2", "J/m^2", "Dissipated energy per nominal area Θ/A0; null likewise").or_null(),
    real(
        "loss_over_adhesion",
        "1",
        "Dissipated energy over the work of adhesion of the nominal area Θ/(A0 Δγ); null likewise, and \
         without adhesion",
    )
    .or_null(),
    real(
        "work_closing_j_m2",
        "J/m^2",
        "Work of adhesion of closing per nominal area: energy that the surfaces give from separation, by way \
         of the load reversal, to zero load on the unloading path. work_opening_j_m2 - work_closing_j_m2 = \
         loss_j_m2; null where Θ is not resolved",
    )
    .or_null(),
    real(
        "work_opening_j_m2",
        "J/m^2",
        "Work of adhesion of opening per nominal area: work from zero load on the unloading path to \
         separation; null likewise",
    )
    .or_null(),
    real("work_closing_j", "J", "Energy of closing, work_closing_j_m2 times A0; null likewise").or_null(),
    real("work_opening_j", "J", "Energy of opening, work_opening_j_m2 times A0; null likewise").or_null(),
];

/// Results that follow those of a probe.
const FURTHER: &[Column] = &[
    real(
        "loss_dk",
        "1",
        "Deng-Kesari estimate Θ_DK/(E* A0 h_rms) at area_at_max_load, with the moments of \
         the continuous spectrum; null for a measured surface, and where the uncorrected Eq A2 has no \
         integral",
    )
    .or_null()
    .from("Eqs A1-A4"),
    real(
        "loss_dk_realised",
        "1",
        "Deng-Kesari estimate Θ_DK/(E* A0 h_rms) at area_at_max_load, with the \
         moments of the realized surface; null where these define none",
    )
    .or_null()
    .from("Eqs A1-A4"),
    real(
        "loss_touched",
        "1",
        "Sum of the dissipated energies of single isolated asperities over all \
         asperities that came into contact, over E* A0 h_rms: no interaction, jump into contact at zero \
         penetration; null for boundary elements",
    )
    .or_null()
    .from("Eq A1"),
    real("loss_dalvi", "1", "Work of adhesion times contact area at load reversal, over E* A0 h_rms")
        .from("Dalvi et al. 2019"),
    real(
        "loss_pinning",
        "1",
        "Dissipated energy of crack-front pinning, 2 k U_el times contact area at load \
         reversal with k = 1.35, over E* A0 h_rms; null where k U_el >= Δγ/2, and where U_el is unknown",
    )
    .or_null()
    .from("Sanner et al. 2024"),
    real(
        "loss_ratio_dk",
        "1",
        "Ratio Θ/Θ_DK, loss over loss_dk, with a probe over loss_dk_probe; null where either is null or Θ_DK \
         is 0",
    )
    .or_null(),
    real("dissipated", "1", "Dissipated energy over E* A0 h_rms, summed over the events of the loop"),
    real("dissipated_j", "J", "Dissipated energy, summed over the events of the loop"),
    real(
        "audit_gap",
        "1",
        "Energy-balance error |loss_j - dissipated_j| / |loss_j|; where loss_j is 0 (no \
         adhesion), energy of the loading events over the work of loading",
    )
    .or_null(),
    real(
        "absorption_share",
        "1",
        "Coalescence energy over dissipated energy: |cover + uncover + merge + \
         split|/|Θ| of the energies of events; null where Θ = 0",
    )
    .or_null(),
    real(
        "loss_uncertainty",
        "1",
        "Resolution of Θ over |Θ|; the resolution is 1e-7 of the maximum work \
         along the loop, and at least -Θ of a negative Θ and an energy-balance error above |Θ|/2; of \
         boundary elements at least the energy-balance error; null where Θ = 0",
    )
    .or_null(),
    count("summit_count", "Number of asperities of the surface"),
    real("summit_density_1_m2", "1/m^2", "Number of asperities per nominal area"),
    real(
        "nayak_density_1_m2",
        "1/m^2",
        "Summit density of a Gaussian surface with the spectral moments of \
         the realized surface",
    )
    .from("Eq A4, Nayak 1971"),
    count(
        "contact_count_at_max_load",
        "Asperities in contact at load reversal, or contact regions of \
         boundary elements",
    ),
    count(
        "touching_count_at_max_load",
        "Contact spots at load reversal that overlap a neighbour (distance < \
         sum of radii)",
    ),
    count("covered_count_at_max_load", "Asperities absorbed by a larger contact at load reversal"),
    count("step_count", "Output steps of loading and of this unloading"),
    count("unconverged_count", "Output steps with a residual above the tolerance"),
    count(
        "held_count",
        "Frozen asperities: state kept, because it alternated between absorbed and released; \
         summed over the steps",
    ),
    real("tabor_min", "1", "Minimum Tabor parameter μ of the asperities; null without asperities")
        .or_null()
        .from("Eq 3"),
    real("tabor_median", "1", "Median Tabor parameter μ of the asperities; null without asperities")
        .or_null()
        .from("Eq 3"),
    real("tabor_max", "1", "Maximum Tabor parameter μ of the asperities; null without asperities")
        .or_null()
        .from("Eq 3"),
    real("tabor_mean", "1", "Mean Tabor parameter μ of the asperities; null without asperities")
        .or_null()
        .from("Eq 3"),
    real(
        "low_tabor_share",
        "1",
        "Fraction of asperities with Tabor parameter μ < 2, where Wu's criterion is \
         invalid; null without asperities",
    )
    .or_null()
    .from("Eq 3"),
    real("rms_slope", "1", "Root-mean-square slope, rms of the gradient of the realized surface"),
    real(
        "rms_curvature_1_m",
        "1/m",
        "Root-mean-square Laplacian of the realized surface, twice the rms mean \
         curvature",
    ),
    real("nayak_parameter", "1", "Bandwidth (Nayak) parameter m0 m4/m2^2 of the realized surface")
        .from("Nayak 1971"),
    real(
        "fuller_tabor",
        "1",
        "Fuller-Tabor parameter E* sd(height)^(3/2)/(mean(radius)^(1/2) Δγ) of the \
         asperities; adhesion is negligible above about 10; null for fewer than two asperities and without \
         adhesion",
    )
    .or_null()
    .from("Fuller and Tabor 1975"),
    real(
        "touching_share",
        "1",
        "Fraction of contact spots that overlap a neighbour (distance < sum of \
         radii) at load reversal; null without contact",
    )
    .or_null(),
    real(
        "covered_share",
        "1",
        "Absorbed fraction of the asperities in contact or absorbed, at load \
         reversal; null without contact",
    )
    .or_null(),
    real(
        "conformity",
        "1",
        "Ratio U_el/Δγ of the shortest octave: elastic energy per area to flatten it \
         over the work of adhesion, continuous spectrum; below 1 the half-space conforms to it; null for a \
         measured surface and without adhesion",
    )
    .or_null()
    .from("Persson and Tosatti 2001"),
    real(
        "conformity_realised",
        "1",
        "Ratio U_el/Δγ of the shortest octave for the realized spectrum of the \
         surface; of a measured surface the shortest octave that, with all below, holds 10 % of the mean \
         square Laplacian; null where that is unknown and without adhesion",
    )
    .or_null()
    .from("Persson and Tosatti 2001"),
    real(
        "persson_tosatti",
        "1",
        "Persson-Tosatti ratio U_el/Δγ: elastic energy per area to flatten all \
         roughness over the work of adhesion, continuous spectrum; below 1 full contact is favoured; null \
         for a measured surface and without adhesion",
    )
    .or_null()
    .from("Persson and Tosatti 2001"),
    real(
        "persson_tosatti_realised",
        "1",
        "Persson-Tosatti ratio U_el/Δγ for the realized spectrum of the \
         surface; null where that is unknown and without adhesion",
    )
    .or_null()
    .from("Persson and Tosatti 2001"),
    real(
        "sticky_line",
        "1",
        "Wang-Müser ratio U_el/(2 Δγ) for the realized spectrum of the surface; below 1 \
         the pull-off force is high; null where U_el is unknown and without adhesion",
    )
    .or_null()
    .from("Wang and Müser 2022"),
    real(
        "texture_aspect",
        "1",
        "Texture aspect ratio: the larger of texture_slope_ratio and 1/texture_str, \
         the latter where the side is 20 decay lengths or more; null for a generated surface with an \
         isotropic spectrum",
    )
    .or_null(),
    real(
        "texture_slope_ratio",
        "1",
        "Ratio of the rms slopes along the principal axes of the slope tensor, \
         the larger over the smaller; null for a generated surface with an isotropic spectrum",
    )
    .or_null(),
    real(
        "texture_str",
        "1",
        "Texture aspect ratio Str: shortest over longest distance at which the \
         autocorrelation decays to 0.2; an upper limit where the longest exceeds half of the side; null for \
         a generated surface with an isotropic spectrum",
    )
    .or_null()
    .from("ISO 25178-2"),
    real(
        "elements_per_wavelength",
        "1",
        "Grid points of boundary elements per shortest wavelength, of a \
         measured surface that of its shortest octave with 10 % of the mean square Laplacian; 12 per JKR \
         radius of a probe at zero penetration count as 16; null for asperities",
    )
    .or_null(),
    real(
        "filter_overshoot",
        "1",
        "Height of filtered maxima above the measured heights within one cut-off \
         wavelength, beyond the noise, over h_rms; null for a generated surface",
    )
    .or_null(),
    real(
        "outlier_share",
        "1",
        "Fraction of the points of a measured surface that are isolated beyond 6 \
         robust standard deviations of their neighbours and were not replaced; 0 if none of them matters on \
         the filtered surface; null for a generated surface, and where it was not computed",
    )
    .or_null(),
    real(
        "line_jump_share",
        "1",
        "Rms offset between scan lines of a measured surface that was not removed, \
         over h_rms; 0 without significant offsets; null likewise",
    )
    .or_null(),
    real(
        "noise_share",
        "1",
        "Rms height that the S-filter removed over h_rms, where its spectral density \
         falls less than q^(-1), as that of noise; 0 elsewhere; null likewise",
    )
    .or_null(),
    real(
        "curvature_ratio",
        "1",
        "Curvature of the sharpest summits over that of the sharpest valleys of a \
         measured surface (1 % quantiles of the Laplacian) that is rounded nearly everywhere; null \
         elsewhere, with a stated tip radius, and likewise",
    )
    .or_null(),
];

const fn is_same(a: &str, b: &str) -> bool {
    let (a, b) = (a.as_bytes(), b.as_bytes());
    let mut place = 0;
    while a.len() == b.len() && place < a.len() && a[place] == b[place] {
        place += 1;
    }
    place == a.len() && place == b.len()
}

/// A column of the table `realizations` that another table has as well.
pub(super) const fn shared(name: &str) -> Column {
    let mut at = 0;
    while at < RESULT_COLUMNS.len() {
        if is_same(RESULT_COLUMNS[at].name, name) {
            return RESULT_COLUMNS[at];
        }
        at += 1;
    }
    panic!("no such column");
}

/// Parts of `dissipated` by branch and by kind of event, over E* A0 h_rms and in joule.
///
/// Each of the two groups sums to `dissipated`.
macro_rules! parts {
    ($($kind:literal, $_remark:literal, $_colour:literal, $_step:literal, $_avalanche:literal,
        $of_kind:literal;)+) => {
        parts! {
            "loading", "of events during loading";
            "unloading", "of events during unloading";
            $($kind, $of_kind;)+
        }
    };
    ($($part:literal, $what:literal;)+) => {
        const PARTS: &[&[Column]] = &[$(&[
            real(concat!("dissipated_", $part), "1", concat!("Dissipated energy over E* A0 h_rms ", $what)),
            real(concat!("dissipated_", $part, "_j"), "J", concat!("Dissipated energy ", $what)),
        ]),+];
    };
}

event_kinds!(parts);

const PART_COLUMNS: [Column; 2 * PARTS.len()] = join(PARTS);

const RESULT_COLUMNS: [Column; RESULTS.len() + OF_PROBE.len() + FURTHER.len()] =
    join(&[RESULTS, OF_PROBE, FURTHER]);

const REALIZATION_COLUMNS: [Column;
    CASE.len() + PARAMETER_COLUMNS.len() + RESULT_COLUMNS.len() + PART_COLUMNS.len() + GRID_ERRORS.len()] =
    join(&[CASE, &PARAMETER_COLUMNS, &RESULT_COLUMNS, &PART_COLUMNS, GRID_ERRORS]);

/// Results of single cycles.
pub static REALIZATIONS: Table = Table {
    name: "realizations",
    version: 1,
    file: "statistics/realizations.parquet",
    doc: "One row per case, realization and load reversal.",
    columns: &REALIZATION_COLUMNS,
};
