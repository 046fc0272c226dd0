//! Discretization errors of boundary elements: columns of results, and the table of grids.

use super::{Column, Table, count, join, real, text};

const SOURCE: &str = "Roache 1994; ASME V&V 20-2009";

/// Relative error of one result.
macro_rules! error {
    ($stem:literal, $what:literal) => {
        real(
            concat!($stem, "_grid_error"),
            "1",
            concat!(
                "Estimated relative discretization error of boundary elements, from coarser grids and \
                 shifted copies on the same surfaces: ",
                $what,
                "; null without coarser grids"
            ),
        )
        .or_null()
        .from(SOURCE)
    };
}

/// Relative errors of the results of a loop, and of their means.
pub(super) const GRID_ERRORS: &[Column] = &[
    error!("area", "contact area at load reversal"),
    error!("pull_off", "pull-off force"),
    error!("loss", "dissipated energy"),
    error!("loading", "dissipated energy of events during loading"),
    error!("unloading", "dissipated energy of events during unloading"),
];

/// Number of surfaces behind the errors of a mean.
pub(super) const GRID_SURFACES: &[Column] = &[count(
    "grid_surface_count",
    "Surfaces that all grids of the case have: the estimated error of the dissipated energy is that of their \
     mean; null without coarser grids",
)
.or_null()];

/// Mean, relative error and extrapolated value of one result on a grid.
macro_rules! on_grid {
    ($name:literal, $stem:literal, $what:literal) => {
        &[
            real(
                concat!($name, "_mean"),
                "1",
                concat!("Mean over the surfaces that all grids of the case have: ", $what),
            )
            .or_null(),
            error!($stem, $what),
            real(
                concat!($stem, "_extrapolated"),
                "1",
                concat!(
                    "Extrapolated to an infinitely fine grid from three grids with a regular series: ",
                    $what,
                    "; null otherwise"
                ),
            )
            .or_null()
            .from(SOURCE),
        ]
    };
}

const GRID: &[Column] = &[
    text("case_id", "Identifier of the case"),
    real("max_load", "1", "Normal load F_max/(E* A0) at the load reversal"),
    text("grid_case_id", "Identifier of the case on this grid; equal to case_id for the finest grid"),
    real(
        "elements_per_wavelength",
        "1",
        "Grid points of boundary elements per shortest wavelength, mean over surfaces",
    ),
    count("surface_count", "Surfaces on which all grids of the case have a dissipated energy"),
];

const ON_GRID: &[&[Column]] = &[
    on_grid!("area_at_max_load", "area", "contact area A/A0 at load reversal"),
    on_grid!("pull_off_load", "pull_off", "pull-off force F_po/(E* A0)"),
    on_grid!("loss", "loss", "dissipated energy Θ/(E* A0 h_rms) of the loop"),
    on_grid!("dissipated_loading", "loading", "dissipated energy over E* A0 h_rms of events during loading"),
    on_grid!(
        "dissipated_unloading",
        "unloading",
        "dissipated energy over E* A0 h_rms of events during unloading"
    ),
];

const ON_GRID_COLUMNS: [Column; 3 * ON_GRID.len()] = join(ON_GRID);

const COLUMNS: [Column; GRID.len() + ON_GRID_COLUMNS.len()] = join(&[GRID, &ON_GRID_COLUMNS]);

/// Grids of boundary elements of each case.
pub static GRIDS: Table = Table {
    name: "grids",
    version: 1,
    file: "statistics/grids.parquet",
    doc: "One row per case by boundary elements with coarser grids, load reversal and grid, the finest last, \
          at most three. Without such a case the table has no row.",
    columns: &COLUMNS,
};
