//! Statistics: means, standard deviations and mean curves from the steps of many cycles.
//!
//! Tables are read and checked by the store, and grouped by Polars. Every sum is taken here, in the order of
//! the realizations, so that the tables have the same bytes with any number of threads. This module is
//! independent of the physics: the analytical estimates of each cycle are given to it.

mod adhesion;
mod avalanches;
mod by_sweep;
mod cases;
mod cautions;
mod compare;
mod curves;
mod cycle;
mod digits;
mod events;
mod findings;
mod grid_error;
mod grid_verdict;
mod grouped;
mod listed;
mod loads;
mod methods;
mod model_error;
mod models;
mod planned;
mod pooled_events;
mod realizations;
mod rows;
mod student;
mod summary;
mod varying;
mod verdict;
mod walk;
mod warnings;

use std::path::PathBuf;

pub use avalanches::avalanches;
pub use by_sweep::{OfSweeps, by_sweep};
pub use cases::{cases, fewer_surfaces};
pub use cautions::{CAUTIONS, Caution, LIMITS, LONGEST_STEP, Limit, MANY_STEPS, MOST_LEFT_OUT, condition};
pub use compare::{Difference, Group, Matched, Side, comparison, difference_of, matched, singles, together};
pub use curves::curves;
pub use digits::{column_exponent, decimals, labels, labels_with_unit, significant};
pub use findings::{FINDINGS, Judged, Reading, Verdict, findings};
pub use grid_error::{GridEstimate, GridRule, GridSeries, WithGridErrors, with_grid_errors};
pub use grid_verdict::{grid_help, grid_percent, grid_verdict};
pub use listed::{Listed, Listing, listing, listing_of, sweeps};
pub use loads::{load_in_words, loads};
pub use methods::{MethodPair, method_pairs, methods, methods_summary, names_of_pairs};
pub use planned::{Planned, planned};
pub use pooled_events::pooled_events;
pub use realizations::{realizations, results};
pub use rows::Value;
pub use student::{FEW, Sample, t_quantile};
pub use summary::{Shown, expected_ratios, summary, verdicts_of_sweeps, warning_text};
pub use varying::{Values, Varying, varying};
pub use walk::{COMPRESSION_STATIONS, Point, STATIONS, TENSION_STATIONS, Walk};
pub use warnings::{Warning, measured_text, warnings, warnings_of};

use crate::store::{FrameError, StoreError};

/// Columns by name, given from outside and copied through.
pub type Given = Vec<(String, Value)>;

/// One case: what all its realizations share.
#[derive(Debug, Clone, PartialEq)]
pub struct CaseInput {
    /// Identity of the case.
    pub case_id: String,
    /// The sweeps that it belongs to, joined by `+`.
    pub sweep: String,
    /// Name that cases share which differ only in the grid of boundary elements; nothing for asperities.
    pub family: Option<String>,
    /// True for a case that is only a coarser grid of others: its loops serve their discretization errors.
    pub is_coarser_grid: bool,
    /// True for a shifted copy of such a grid: its loops serve the scatter by the position of the grid.
    pub is_shifted_copy: bool,
    /// Parameters of the case: the columns that the tables `realizations` and `cases` have in common.
    pub parameters: Given,
    /// Its load reversals, as `F/(E* A0)`.
    pub max_loads: Vec<f64>,
    /// Unit in which the spec gives them: `1`, `N` or `Pa`.
    pub load_unit: &'static str,
    /// A column of the table `realizations` for whose mean a precision is required, and the relative
    /// precision.
    pub precision: Option<(String, f64)>,
    /// Required relative grid error of the mean dissipated energy.
    pub grid_error_goal: Option<f64>,
    /// Number of realizations in the spec.
    pub planned_count: usize,
    /// Number of failed realizations.
    pub failed_count: usize,
    /// Columns of the table `realizations` that depend on the surface and the material alone: one list per
    /// surface whose cycle is done or failed. Empty if only finished cycles count.
    pub surfaces: Vec<Given>,
}

/// One finished cycle of a case.
#[derive(Debug, Clone, PartialEq)]
pub struct CycleInput {
    /// Its case.
    pub case_id: String,
    /// Number of the surface.
    pub realization: i64,
    /// Identity of the cycle.
    pub cycle_id: String,
    /// Identity of the surface.
    pub surface_id: String,
    /// The table of its steps.
    pub steps: PathBuf,
    /// The table of its events.
    pub events: PathBuf,
    /// `E* A0 h_rms` \[J\], by which energies are made dimensionless.
    pub energy_scale_j: f64,
    /// Θ after Deng and Kesari per unit of `A/A0` \[J\], from the moments of the continuous spectrum.
    pub loss_dk_per_area_j: Option<f64>,
    /// Θ after Deng and Kesari per unit of `A/A0` \[J\], from the moments of this surface.
    pub loss_dk_realised_per_area_j: Option<f64>,
    /// Θ after Deng and Kesari with the radius of the probe per unit of `A/A0` \[J\], from the moments of the
    /// continuous spectrum; nothing without a probe.
    pub loss_dk_probe_per_area_j: Option<f64>,
    /// That estimate from the moments of this surface.
    pub loss_dk_probe_realised_per_area_j: Option<f64>,
    /// `Δγ A0` \[J\]: Θ after Dalvi and others per unit of `A/A0`.
    pub loss_dalvi_per_area_j: f64,
    /// Energy dissipated by crack-front pinning over the nominal area \[J\]; nothing where that is undefined.
    pub loss_pinning_per_area_j: Option<f64>,
    /// Further columns that depend on the load reversal, by its load; and `resolution_j`, the dissipated
    /// energy below which Θ is not resolved \[J\].
    pub at_max_load: Vec<(f64, Given)>,
    /// Every column of the table `realizations` that follows neither from the steps nor from the case:
    /// numbers of asperities, moments, Tabor parameters. An absent one is null, and an error where the table
    /// allows no null.
    pub surface: Given,
}

impl CycleInput {
    /// Further columns at a load reversal.
    fn at(&self, max_load: f64) -> Option<&Given> {
        self.at_max_load.iter().find(|(load, _)| *load == max_load).map(|(_, given)| given)
    }
}

/// Why a table could not be made.
#[derive(Debug, thiserror::Error)]
pub enum StatsError {
    /// A table of a cycle.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// Polars could not group rows.
    #[error("cannot group the rows of the table {table}: {source}")]
    Group {
        /// The table.
        table: &'static str,
        /// Message of Polars.
        source: polars::error::PolarsError,
    },
    /// The steps hold what no cycle can hold.
    #[error("the steps in {} {problem}", path.display())]
    Cycle {
        /// The table.
        path: PathBuf,
        /// Fault, as in "have no loading branch".
        problem: String,
    },
    /// The events hold what no cycle can hold.
    #[error("the events in {} {problem}", path.display())]
    Events {
        /// The table.
        path: PathBuf,
        /// Fault, as in "hold the kind ...".
        problem: String,
    },
    /// Campaigns cannot be compared.
    #[error(
        "cannot compare {label}: it varies parameters that also differ between the runs ({differing}); case \
         {case_id} cannot be paired\n\
         help: compare runs that differ in one fixed parameter, or sweep the same values"
    )]
    Ambiguous {
        /// The campaign.
        label: String,
        /// The case.
        case_id: String,
        /// Parameters that distinguish the campaigns.
        differing: String,
    },
    /// A cycle names a case that was not given.
    #[error("realization {realization} belongs to the case {case_id:?}, which was not given")]
    UnknownCase {
        /// The case.
        case_id: String,
        /// The realization.
        realization: i64,
    },
    /// The rows do not fit their table.
    #[error(transparent)]
    Frame(#[from] FrameError),
}
