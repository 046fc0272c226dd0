//! The steps of one cycle, grouped into its branches.

use std::path::Path;

use polars::prelude::{IntoColumn, NamedFrom, Series};

use super::grouped::grouped;
use super::walk::{Point, Walk};
use super::{CycleInput, StatsError};
use crate::schema::STEPS;
use crate::store::parquet::read_table;
use crate::store::{Frame, FrameError};

/// The rows of one branch, in the order of the path.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Branch {
    pub(super) step: Vec<i64>,
    pub(super) approach_m: Vec<f64>,
    pub(super) load: Vec<f64>,
    pub(super) load_n: Vec<f64>,
    pub(super) least_load_n: Vec<f64>,
    pub(super) area: Vec<f64>,
    pub(super) penetration: Vec<f64>,
    pub(super) area_m2: Vec<f64>,
    pub(super) area_union_m2: Vec<Option<f64>>,
    pub(super) work_j: Vec<f64>,
    pub(super) dissipated_j: Vec<f64>,
    pub(super) contact_count: Vec<i64>,
    pub(super) covered_count: Vec<i64>,
    pub(super) touching_count: Vec<i64>,
    pub(super) held_count: Vec<i64>,
    pub(super) converged: Vec<bool>,
    pub(super) reversal_load: Vec<Option<f64>>,
}

/// A cycle: one loading branch, and an unloading branch from each load reversal.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Cycle {
    pub(super) loading: Branch,
    /// By `max_load`, ascending.
    pub(super) unloading: Vec<(f64, Branch)>,
}

impl Cycle {
    /// Reads a table of steps.
    pub(super) fn read(path: &Path) -> Result<Self, StatsError> {
        let frame = read_table(path, &STEPS)?;
        let branches = split(&frame)?;
        let mut loading = None;
        let mut unloading = Vec::new();
        for (word, max_load, branch) in branches {
            match (word.as_str(), max_load) {
                ("loading", None) => loading = Some(branch),
                ("unloading", Some(max_load)) => unloading.push((max_load, branch)),
                _ => {
                    return Err(fault(
                        path,
                        format!(
                            "hold a branch {word:?} with max_load {max_load:?}; loading has none, unloading \
                             has one"
                        ),
                    ));
                }
            }
        }
        unloading.sort_by(|a, b| a.0.total_cmp(&b.0));
        let loading = loading.ok_or_else(|| fault(path, "have no loading branch".to_owned()))?;
        Ok(Self { loading, unloading })
    }

    /// The position in the loading branch of the step at which it turned.
    pub(super) fn turning_row(&self, input: &CycleInput, max_load: f64) -> Result<usize, StatsError> {
        let row = self.loading.reversal_load.iter().position(|load| *load == Some(max_load));
        row.ok_or_else(|| {
            fault(&input.steps, format!("have no loading step at the turning point {max_load}"))
        })
    }
}

pub(super) fn fault(path: &Path, problem: String) -> StatsError {
    StatsError::Cycle { path: path.to_owned(), problem }
}

impl Branch {
    /// Points of the branch, in the order of the path.
    pub(super) fn points(&self) -> impl DoubleEndedIterator<Item = Point> {
        let rest = self.area.iter().zip(&self.penetration);
        self.load.iter().zip(rest).map(|(load, (area, penetration))| Point {
            load: *load,
            area: *area,
            penetration: *penetration,
        })
    }

    /// The branch walked from its turning row backwards.
    pub(super) fn backwards_from(&self, row: usize) -> Walk {
        let skipped = self.load.len().saturating_sub(row + 1);
        Walk(self.points().rev().skip(skipped).collect())
    }

    /// The branch walked from the load reversal that precedes it.
    pub(super) fn onwards_from(&self, turning_point: Option<Point>) -> Walk {
        Walk(turning_point.into_iter().chain(self.points()).collect())
    }
}

/// A branch with its word and its load reversal.
type Labelled = (String, Option<f64>, Branch);

/// The branches, each in the order of the steps.
fn split(frame: &Frame) -> Result<Vec<Labelled>, StatsError> {
    let (words, loads) = (frame.text("branch")?, frame.f64_or_null("max_load")?);
    let columns = vec![
        Series::new("branch".into(), &words).into_column(),
        Series::new("max_load".into(), loads).into_column(),
        Series::new("step".into(), frame.i64("step")?).into_column(),
    ];
    let groups = grouped(columns, &["branch", "max_load"], &["step"]);
    let groups = groups.map_err(|source| StatsError::Group { table: STEPS.name, source })?;
    let labelled = |rows: Vec<usize>| {
        let first = rows.first().copied().unwrap_or_default();
        Ok((words[first].to_owned(), loads[first], branch(frame, &rows)?))
    };
    groups.into_iter().map(labelled).collect()
}

/// These rows of a table of steps.
fn branch(frame: &Frame, rows: &[usize]) -> Result<Branch, FrameError> {
    fn picked<T: Copy>(values: &[T], rows: &[usize]) -> Vec<T> {
        rows.iter().map(|row| values[*row]).collect()
    }
    let reals = |name: &str| Ok(picked(&frame.f64(name)?, rows));
    let wholes = |name: &str| Ok(picked(&frame.i64(name)?, rows));
    Ok(Branch {
        step: wholes("step")?,
        approach_m: reals("approach_m")?,
        load: reals("load")?,
        load_n: reals("load_n")?,
        least_load_n: reals("least_load_n")?,
        area: reals("area")?,
        penetration: reals("penetration")?,
        area_m2: reals("area_m2")?,
        area_union_m2: picked(frame.f64_or_null("area_union_m2")?, rows),
        work_j: reals("work_j")?,
        dissipated_j: reals("dissipated_j")?,
        contact_count: wholes("contact_count")?,
        covered_count: wholes("covered_count")?,
        touching_count: wholes("touching_count")?,
        held_count: wholes("held_count")?,
        reversal_load: picked(frame.f64_or_null("reversal_load")?, rows),
        converged: picked(&frame.bool("converged")?, rows),
    })
}
