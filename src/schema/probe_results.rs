//! Columns of the table of realizations that only cycles with a probe have.

use super::{Column, real};

/// Results of a probe.
pub(super) const OF_PROBE: &[Column] = &[
    real(
        "work_pull_off_j_m2",
        "J/m^2",
        "Apparent work of adhesion of the probe from its pull-off force, F_po/(1.5 π R); null without a \
         probe or tension",
    )
    .or_null()
    .from("Johnson, Kendall and Roberts 1971"),
    real(
        "work_loss_j_m2",
        "J/m^2",
        "Apparent work of adhesion of the probe from Θ, as of a smooth sphere under control of the \
         displacement; null without a probe, and where Θ is not positive",
    )
    .or_null()
    .from("Eq A1"),
    real(
        "work_approach_j_m2",
        "J/m^2",
        "Apparent work of adhesion of the probe on approach: JKR fit of the radius sqrt(A/π) against load on \
         loading, with E* given; null without a probe, on a layer, and where the residual is above 10 % of \
         the maximum load",
    )
    .or_null()
    .from("Johnson, Kendall and Roberts 1971"),
    real(
        "work_retraction_j_m2",
        "J/m^2",
        "Apparent work of adhesion of the probe on retraction: the fit on unloading; null likewise",
    )
    .or_null()
    .from("Johnson, Kendall and Roberts 1971"),
    real(
        "fit_residual_approach_n",
        "N",
        "Root-mean-square residual of the load of the JKR fit on approach; null without it",
    )
    .or_null(),
    real(
        "fit_residual_retraction_n",
        "N",
        "Root-mean-square residual of the load of the JKR fit on retraction; null without it",
    )
    .or_null(),
    real(
        "probe_extent",
        "1",
        "Largest distance of a contact edge from the apex of the probe at load reversal, over the side L: \
         the surface is that of the sphere up to 0.3; null without a probe",
    )
    .or_null(),
    real(
        "area_jkr_probe",
        "1",
        "Contact area A/A0 of the smooth probe at load reversal by JKR theory on a half-space; null without \
         a probe",
    )
    .or_null()
    .from("Johnson, Kendall and Roberts 1971"),
    real(
        "area_jkr_jump_in",
        "1",
        "Contact area A_in/A0 of the smooth probe after its jump into contact at zero penetration; null \
         without a probe",
    )
    .or_null()
    .from("Johnson, Kendall and Roberts 1971"),
    real(
        "loss_dk_probe",
        "1",
        "Deng-Kesari estimate Θ_DK/(E* A0 h_rms) with R_tip = R of the probe, at the area area_jkr_probe - \
         area_jkr_jump_in, with the moments of the continuous spectrum; null without a probe, and likewise",
    )
    .or_null()
    .from("Deng and Kesari 2019"),
    real(
        "loss_dk_probe_realised",
        "1",
        "The same estimate with the moments of the realized surface; null without a probe, and where these \
         define none",
    )
    .or_null()
    .from("Deng and Kesari 2019"),
];
