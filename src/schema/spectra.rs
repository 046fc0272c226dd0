//! Tables of the scans of one sample: their limits and roughness, their spectra and the common spectrum.

use super::{Column, SURFACE_ID, Table, count, flag, index, real, text};

const CASE_ID: Column = text(
    "case_id",
    "Identifier of the first case with these scans; other cases with the same scans share the spectrum",
);
const SCAN: Column =
    index("realization", "Number of the scan in `surface.files`, from 0: the realization of the case");
const WAVENUMBER: Column = real("wavenumber_1_m", "1/m", "Wavenumber q = 2π/λ");

/// Common spectrum of the scans of a case.
pub static SPECTRUM: Table = Table {
    name: "spectrum",
    version: 1,
    file: "statistics/spectrum.parquet",
    doc: "One row per wavenumber: common power spectral density of the scans of a case, ten wavenumbers per \
        decade. Only for a spec with `surface.files`.",
    columns: &[
        CASE_ID,
        WAVENUMBER,
        real(
            "density_m4",
            "m^4",
            "Isotropic density C with ∫ C d²q = h_rms²: arithmetic mean over the scans that are reliable at \
             this wavenumber, each with the same weight",
        )
        .from("Jacobs, Junge and Pastewka 2017"),
        count("scan_count", "Number of these scans"),
        real("density_min_m4", "m^4", "Smallest density of these scans"),
        real("density_max_m4", "m^4", "Largest density of these scans"),
        real(
            "scatter_decades",
            "1",
            "Standard deviation of log10 C over these scans (n - 1), in decades; null with one scan",
        )
        .or_null(),
    ],
};

/// Spectra of the scans of a case.
pub static SCAN_SPECTRA: Table = Table {
    name: "scan_spectra",
    version: 1,
    file: "statistics/scan_spectra.parquet",
    doc: "One row per scan and wavenumber: power spectral density of one scan. Only for a spec with \
        `surface.files`.",
    columns: &[
        CASE_ID,
        SCAN,
        SURFACE_ID,
        WAVENUMBER,
        real(
            "density_m4",
            "m^4",
            "Isotropic density C of the scan with ∫ C d²q = h_rms²: mean over a ring of wavevectors, before \
             the S-filter",
        ),
        count("mode_count", "Number of modes of the ring"),
        flag("reliable", "True between the limits of the scan, where it contributes to the common spectrum"),
    ],
};

/// Limits and roughness of the scans of a case.
pub static SCANS: Table = Table {
    name: "scans",
    version: 1,
    file: "statistics/scans.parquet",
    doc: "One row per scan, and one for the common spectrum of the case: limits of reliability, and \
        roughness with that of the common spectrum in the same band. Only for a spec with `surface.files`.",
    columns: &[
        CASE_ID,
        index("realization", "Number of the scan in `surface.files`, from 0; null for the common spectrum")
            .or_null(),
        text("surface_id", "Identifier of the surface of the scan; null for the common spectrum").or_null(),
        text("surface_file", "File of the scan; null for the common spectrum").or_null(),
        real("length_m", "m", "Side L of the square; null for the common spectrum").or_null(),
        real("lowest_1_m", "1/m", "Lowest reliable wavenumber").or_null(),
        text(
            "lowest_cause",
            "Cause of this limit: \"side\" (periodic), \"window\" (three modes of the side: levelling and \
             window) or \"long_cut\"; null for the common spectrum",
        )
        .or_null(),
        real("highest_1_m", "1/m", "Highest reliable wavenumber").or_null(),
        text(
            "highest_cause",
            "Cause of this limit: \"grid\" (four points per wavelength), \"tip\", \"filter\" (S-filter), \
             \"empty\", \"gaussian_filter\" or \"white_noise\"; null for the common spectrum",
        )
        .or_null(),
        real("rms_height_m", "m", "Root-mean-square height of the surface; null for the common spectrum")
            .or_null(),
        real("rms_slope", "1", "Root-mean-square gradient of the surface; null likewise").or_null(),
        real("rms_curvature_1_m", "1/m", "Root-mean-square Laplacian of the surface; null likewise")
            .or_null(),
        real(
            "flattening_m",
            "m",
            "U_el/E* of the surface: elastic energy per area that flattens it, over the reduced modulus; \
             null likewise",
        )
        .or_null()
        .from("Persson and Tosatti 2001"),
        real("band_rms_height_m", "m", "Root-mean-square height of the spectrum between the two limits")
            .or_null(),
        real("band_rms_slope", "1", "Root-mean-square gradient of the spectrum between the two limits")
            .or_null(),
        real(
            "band_rms_curvature_1_m",
            "1/m",
            "Root-mean-square Laplacian of the spectrum between the two limits",
        )
        .or_null(),
        real("band_flattening_m", "m", "U_el/E* of the spectrum between the two limits")
            .or_null()
            .from("Persson and Tosatti 2001"),
        real("common_rms_height_m", "m", "band_rms_height_m of the common spectrum between the same limits")
            .or_null(),
        real("common_rms_slope", "1", "band_rms_slope of the common spectrum between the same limits")
            .or_null(),
        real(
            "common_rms_curvature_1_m",
            "1/m",
            "band_rms_curvature_1_m of the common spectrum between the same limits",
        )
        .or_null(),
        real("common_flattening_m", "m", "band_flattening_m of the common spectrum between the same limits")
            .or_null()
            .from("Persson and Tosatti 2001"),
    ],
};
