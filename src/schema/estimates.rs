//! The tables of analytical estimates: of a surface, and of a cycle.

use super::realizations::shared;
use super::run::CYCLE_CASE_ID;
use super::{CYCLE_ID, Column, REALIZATION, SURFACE_ID, Table, flag, join, real};

/// Columns of the table `realizations` that depend on the surface alone.
pub const OF_SURFACE: &[Column] = &[
    shared("nominal_area_m2"),
    shared("summit_count"),
    shared("summit_density_1_m2"),
    shared("nayak_density_1_m2"),
    shared("rms_slope"),
    shared("rms_curvature_1_m"),
    shared("nayak_parameter"),
    shared("texture_aspect"),
    shared("texture_slope_ratio"),
    shared("texture_str"),
    shared("filter_overshoot"),
    shared("outlier_share"),
    shared("line_jump_share"),
    shared("noise_share"),
    shared("curvature_ratio"),
];

const SURFACE: &[Column] = &[
    SURFACE_ID,
    REALIZATION,
    real("length_m", "m", "Side L of the square"),
    real("rms_height_m", "m", "Root-mean-square height of the realized surface"),
    flag("periodic", "True if the surface continues periodically"),
    real("cut_off_m", "m", "S-filter cut-off wavelength of a measured surface; null for a generated surface")
        .or_null(),
    real(
        "shortest_wavelength_m",
        "m",
        "Shortest wavelength: L/ζ of a generated surface; of a measured surface that of its shortest octave \
         with 10 % of the mean square Laplacian",
    ),
    real(
        "flattening_wavenumber_1_m",
        "1/m",
        "Unit q of the wavenumbers k in the sums flattening: 2π/L of a generated surface, 1/m of a measured \
         one",
    ),
    real(
        "flattening_m2",
        "m^2",
        "Sum 1/4 Σ (k/q) |c_k|^2 over all modes of the realized spectrum; times flattening_wavenumber_1_m it \
         is U_el/E*, with the elastic energy per area U_el of flattening all roughness",
    )
    .from("Persson and Tosatti 2001"),
    real("flattening_octave_m2", "m^2", "The same sum over the shortest octave of wavelengths")
        .from("Persson and Tosatti 2001"),
];

const SURFACE_COLUMNS: [Column; SURFACE.len() + OF_SURFACE.len()] = join(&[SURFACE, OF_SURFACE]);

/// Estimates of a surface.
pub static SURFACE_ESTIMATES: Table = Table {
    name: "surface_estimates",
    version: 1,
    file: "estimates/<id>.parquet",
    doc: "One row: statistics and analytical estimates of a surface that do not depend on the material.",
    columns: &SURFACE_COLUMNS,
};

/// Columns of the table `realizations` that depend on the surface and the material.
pub const OF_CYCLE: &[Column] = &[
    shared("conformity"),
    shared("conformity_realised"),
    shared("persson_tosatti"),
    shared("persson_tosatti_realised"),
    shared("sticky_line"),
    shared("tabor_min"),
    shared("tabor_median"),
    shared("tabor_max"),
    shared("tabor_mean"),
    shared("low_tabor_share"),
    shared("fuller_tabor"),
    shared("elements_per_wavelength"),
];

/// Columns of the table `realizations` that depend on the load reversal as well.
pub const OF_LOAD: &[Column] = &[
    shared("area_adhesionless"),
    shared("area_adhesionless_small"),
    shared("area_jkr_curve"),
    shared("pull_off_jkr_curve"),
    shared("loss_jkr_curve"),
    shared("loss_touched"),
    shared("work_pull_off_j_m2"),
    shared("work_loss_j_m2"),
    shared("work_approach_j_m2"),
    shared("work_retraction_j_m2"),
    shared("fit_residual_approach_n"),
    shared("fit_residual_retraction_n"),
    shared("probe_extent"),
    shared("area_jkr_probe"),
    shared("area_jkr_jump_in"),
];

/// Deng–Kesari estimates by the equations in use: corrected, and with the errata a2 and a3.
macro_rules! deng_kesari {
    ($name:literal, $moments:literal, $null:literal) => {
        [
            deng_kesari!($name, "", $moments, "", $null),
            deng_kesari!($name, "_a2", $moments, " and Eq A2 as printed", $null),
            deng_kesari!($name, "_a3", $moments, " and Eq A3 as printed", $null),
            deng_kesari!($name, "_a2_a3", $moments, " and Eqs A2 and A3 as printed", $null),
        ]
    };
    ($name:literal, $errata:literal, $moments:literal, $equations:literal, $null:literal) => {
        real(
            concat!($name, $errata, "_nominal_j"),
            "J",
            concat!(
                "Deng-Kesari estimate Θ_DK at A = A0, with the moments of the ",
                $moments,
                $equations,
                "; null ",
                $null
            ),
        )
        .or_null()
        .from("Eqs A1-A4")
    };
}

/// Deng–Kesari estimates at `A = A0` with the moments of the continuous spectrum: corrected, with a2, with
/// a3, with both.
pub const DENG_KESARI: [Column; 4] =
    deng_kesari!("loss_dk", "continuous spectrum", "for a measured surface, and where Eq A2 has no integral");
/// Deng–Kesari estimates with the moments of the realized surface, likewise.
pub const DENG_KESARI_REALISED: [Column; 4] =
    deng_kesari!("loss_dk_realised", "realized surface", "where Eq A2 has no integral");
/// Deng–Kesari estimates of a probe with the moments of the continuous spectrum, likewise.
pub const DENG_KESARI_PROBE: [Column; 4] = deng_kesari!(
    "loss_dk_probe",
    "continuous spectrum and R_tip = R of the probe",
    "without a probe, for a measured surface, and where Eq A2 has no integral"
);
/// Deng–Kesari estimates of a probe with the moments of the realized surface, likewise.
pub const DENG_KESARI_PROBE_REALISED: [Column; 4] = deng_kesari!(
    "loss_dk_probe_realised",
    "realized surface and R_tip = R of the probe",
    "without a probe, and where Eq A2 has no integral"
);

const ENERGIES: &[Column] = &[
    real("max_load", "1", "Normal load F_max/(E* A0) at the load reversal"),
    real("energy_scale_j", "J", "Unit of energies E* A0 h_rms"),
    real("loss_dalvi_nominal_j", "J", "Work of adhesion times nominal area").from("Dalvi et al. 2019"),
    real(
        "loss_pinning_nominal_j",
        "J",
        "Dissipated energy of crack-front pinning at A = A0, 2 k U_el A0 with k = 1.35; null where k U_el >= \
         Δγ/2, and without adhesion",
    )
    .or_null()
    .from("Sanner et al. 2024"),
    real(
        "resolution_j",
        "J",
        "Dissipated energy below which Θ is not resolved: 1e-7 of the maximum work along the loop, or the \
         energy by which the loop violates the sign of Θ or the energy balance; null for a load that is not \
         reached",
    )
    .or_null(),
];

const CYCLE: &[Column] = &[CYCLE_ID, CYCLE_CASE_ID, REALIZATION];

const CYCLE_COLUMNS: [Column; CYCLE.len() + ENERGIES.len() + 16 + OF_CYCLE.len() + OF_LOAD.len()] = join(&[
    CYCLE,
    ENERGIES,
    &DENG_KESARI,
    &DENG_KESARI_REALISED,
    &DENG_KESARI_PROBE,
    &DENG_KESARI_PROBE_REALISED,
    OF_CYCLE,
    OF_LOAD,
]);

/// Estimates of a cycle.
pub static ESTIMATES: Table = Table {
    name: "estimates",
    version: 1,
    file: "cycles/<id>/estimates.parquet",
    doc: "One row per load reversal: analytical estimates of the cycle for its surface, material and load, \
         and the resolution of its dissipated energy.",
    columns: &CYCLE_COLUMNS,
};
