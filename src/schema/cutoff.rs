//! Tables over cut-off wavelengths: roughness of a surface, and works of adhesion of a case.

use super::{Column, REALIZATION, SURFACE_ID, Table, count, real, text};

const CUT_OFF: Column = real("cut_off_m", "m", "Cut-off wavelength λc, descending");

/// Roughness of a surface over the cut-off wavelength.
pub static SPECTRA: Table = Table {
    name: "spectra",
    version: 1,
    file: "spectra/<id>.parquet",
    doc: "One row per cut-off wavelength: roughness of all wavelengths from the cut-off up, of the realized \
          spectrum of a surface.",
    columns: &[
        SURFACE_ID,
        REALIZATION,
        CUT_OFF,
        real("rms_height_m", "m", "Root-mean-square height of the wavelengths λ >= λc"),
        real("rms_slope", "1", "Root-mean-square slope of the wavelengths λ >= λc"),
        real(
            "flattening_m",
            "m",
            "Flattening 1/4 Σ k |c_k|^2 of the modes with λ >= λc: U_el/E*, with the elastic energy per area \
             U_el of flattening them",
        )
        .from("Persson and Tosatti 2001"),
    ],
};

/// Works of adhesion that models predict, over the cut-off wavelength.
pub static CUTOFF: Table = Table {
    name: "cutoff",
    version: 1,
    file: "statistics/cutoff.parquet",
    doc: "One row per case and cut-off wavelength λc, in the order of the spec: roughness of the wavelengths \
          from λc up, mean over the surfaces of finished and failed cycles, and works of adhesion that \
          models predict if only they existed. The last row of a case has all roughness.",
    columns: &[
        text("case_id", "Identifier of the case"),
        CUT_OFF,
        count("surface_count", "Surfaces in the means: those whose band has this cut-off"),
        real("rms_height_m", "m", "Root-mean-square height of the wavelengths λ >= λc"),
        real("rms_slope", "1", "Root-mean-square slope of the wavelengths λ >= λc"),
        real(
            "work_of_adhesion_j_m2",
            "J/m^2",
            "Work of adhesion Δγ of the models: that of the spec, less roughness below the grid that is \
             folded into it",
        ),
        real(
            "flattening_j_m2",
            "J/m^2",
            "Elastic energy per area U_el of full contact with the wavelengths λ >= λc",
        )
        .from("Persson and Tosatti 2001"),
        real("flattening_sd_j_m2", "J/m^2", "Its standard deviation over surfaces (n - 1)").or_null(),
        real("flattening_below_j_m2", "J/m^2", "U_el of the wavelengths λ < λc of the surface")
            .from("Persson and Tosatti 2001"),
        real("flattening_ratio", "1", "U_el/Δγ of the wavelengths λ >= λc; null without adhesion")
            .or_null()
            .from("Persson and Tosatti 2001"),
        real(
            "work_persson_tosatti_j_m2",
            "J/m^2",
            "Work of adhesion of both branches of reversible full contact, Δγ (1 + rms_slope^2/2) - U_el; \
             null for U_el >= Δγ",
        )
        .or_null()
        .from("Persson and Tosatti 2001"),
        real(
            "work_dalvi_closing_j_m2",
            "J/m^2",
            "Work of adhesion of closing, Δγ - U_el; null for U_el >= Δγ",
        )
        .or_null()
        .from("Dalvi et al. 2019"),
        real("loss_dalvi_j_m2", "J/m^2", "Dissipated energy per contact area Θ/A = Δγ; null for U_el >= Δγ")
            .or_null()
            .from("Dalvi et al. 2019"),
        real(
            "work_pinning_closing_low_j_m2",
            "J/m^2",
            "Work of adhesion of closing of a pinned contact line, Δγ - k U_el with k = 3; null for k U_el \
             >= Δγ/2",
        )
        .or_null()
        .from("Sanner et al. 2024"),
        real(
            "work_pinning_closing_high_j_m2",
            "J/m^2",
            "The same with k = 1.2 of our simulations; null likewise",
        )
        .or_null()
        .from("Sanner et al. 2024"),
        real(
            "work_pinning_opening_low_j_m2",
            "J/m^2",
            "Work of adhesion of opening of a pinned contact line, Δγ + k U_el with k = 1.2; null likewise",
        )
        .or_null()
        .from("Sanner et al. 2024"),
        real("work_pinning_opening_high_j_m2", "J/m^2", "The same with k = 3; null likewise")
            .or_null()
            .from("Sanner et al. 2024"),
    ],
};
