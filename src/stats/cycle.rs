//! The steps of one cycle, read and grouped into its branches by Polars.

use std::path::Path;

use polars::prelude::{Column, DataFrame, Expr, LazyFrame, PlRefPath, PolarsResult, ScanArgsParquet, Series, SortMultipleOptions, col};

use super::walk::{Point, Walk};
use super::{CycleInput, StatsError};

/// How far the load of a turning step may be from its turning point, relative: steps between turning points are never this close to one.
const TURNING_TOLERANCE: f64 = 1e-6;

/// The rows of one branch, in the order of the path.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Branch {
    pub(super) step: Vec<i64>,
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

/// A cycle: one loading branch, and an unloading branch from each turning point.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Cycle {
    pub(super) loading: Branch,
    /// By `max_load`, ascending.
    pub(super) unloading: Vec<(f64, Branch)>,
}

impl Cycle {
    /// Reads a table of steps.
    pub(super) fn read(path: &Path) -> Result<Self, StatsError> {
        let grouped = group(path).and_then(|frame| split(&frame));
        let branches = grouped.map_err(|source| StatsError::Steps { path: path.to_owned(), source })?;
        let mut loading = None;
        let mut unloading = Vec::new();
        for (word, max_load, branch) in branches {
            match (word.as_str(), max_load) {
                ("loading", None) => loading = Some(branch),
                ("unloading", Some(max_load)) => unloading.push((max_load, branch)),
                _ => {
                    return Err(fault(
                        path,
                        format!("hold a branch {word:?} with max_load {max_load:?}; loading has none, unloading has one"),
                    ));
                }
            }
        }
        unloading.sort_by(|a, b| a.0.total_cmp(&b.0));
        let loading = loading.ok_or_else(|| fault(path, "have no loading branch".to_owned()))?;
        Ok(Self { loading, unloading })
    }

    /// The position in the loading branch of the step from which a branch unloads: where the load has jumped over what was wanted, it is no other.
    fn where_unloading_began(&self, max_load: f64) -> Option<usize> {
        let (_, branch) = self.unloading.iter().find(|(load, _)| *load == max_load)?;
        let (load, penetration) = (branch.load.first()?, branch.penetration.first()?);
        let same = |row: &usize| {
            let (known, at) = (self.loading.load[*row], self.loading.penetration[*row]);
            at == *penetration && (known - load).abs() <= TURNING_TOLERANCE * load.abs()
        };
        (0..self.loading.load.len()).rev().find(same)
    }

    /// The position in the loading branch of the step at which it turned.
    pub(super) fn turning_row(&self, input: &CycleInput, max_load: f64) -> Result<usize, StatsError> {
        if let Some(row) = self.loading.reversal_load.iter().position(|load| *load == Some(max_load)) {
            return Ok(row);
        }
        let near = |load: f64| (load - max_load).abs() <= TURNING_TOLERANCE * max_load.abs();
        let distance = |load: &f64| (load - max_load).abs();
        let nearest = self.loading.load.iter().enumerate().min_by(|a, b| distance(a.1).total_cmp(&distance(b.1)));
        let row = nearest.filter(|(_, load)| near(**load)).map(|(row, _)| row);
        row.or_else(|| self.where_unloading_began(max_load))
            .ok_or_else(|| fault(&input.steps, format!("have no loading step at the turning point {max_load}")))
    }
}

pub(super) fn fault(path: &Path, problem: String) -> StatsError {
    StatsError::Cycle { path: path.to_owned(), problem }
}

impl Branch {
    /// The branch as a walk away from its turning point; a loading branch, cut off at its turning row, is walked backwards.
    pub(super) fn points(&self) -> impl DoubleEndedIterator<Item = Point> {
        let rest = self.area.iter().zip(&self.penetration);
        self.load.iter().zip(rest).map(|(load, (area, penetration))| Point { load: *load, area: *area, penetration: *penetration })
    }

    /// The branch walked from its turning row backwards.
    pub(super) fn backwards_from(&self, row: usize) -> Walk {
        let skipped = self.load.len().saturating_sub(row + 1);
        Walk(self.points().rev().skip(skipped).collect())
    }

    /// The branch walked from the turning point that precedes it.
    pub(super) fn onwards_from(&self, turning_point: Option<Point>) -> Walk {
        Walk(turning_point.into_iter().chain(self.points()).collect())
    }
}

/// Column of the loads of the spec at the steps of load reversal.
const REVERSAL: &str = "reversal_load";

const COLUMNS: [&str; 15] = [
    "step",
    "load",
    "load_n",
    "least_load_n",
    "area",
    "penetration",
    "area_m2",
    "area_union_m2",
    "work_j",
    "dissipated_j",
    "contact_count",
    "covered_count",
    "touching_count",
    "held_count",
    "converged",
];

/// A table that Polars reads from a file.
pub(super) fn scan(path: &Path) -> PolarsResult<LazyFrame> {
    // A run's directory may have any name: no pattern and no partition is to be read from it.
    let arguments = ScanArgsParquet { glob: false, ..ScanArgsParquet::default() };
    LazyFrame::scan_parquet(PlRefPath::try_from_path(path)?, arguments)
}

/// One row per branch, each column a list in the order of the steps.
fn group(path: &Path) -> PolarsResult<DataFrame> {
    let keys = [col("branch"), col("max_load")];
    let mut lists: Vec<Expr> = COLUMNS.iter().map(|name| col(*name)).collect();
    let mut frame = scan(path)?;
    // Tables of earlier versions lack it.
    if frame.collect_schema()?.contains(REVERSAL) {
        lists.push(col(REVERSAL));
    }
    frame
        .select([keys.as_slice(), lists.as_slice()].concat())
        .sort(["step"], SortMultipleOptions::default().with_maintain_order(true))
        .group_by_stable(keys)
        .agg(lists)
        .collect()
}

type Split = Vec<(String, Option<f64>, Branch)>;

fn split(frame: &DataFrame) -> PolarsResult<Split> {
    let words = frame.column("branch")?.str()?;
    let loads = frame.column("max_load")?.f64()?;
    words
        .iter()
        .zip(loads.iter())
        .enumerate()
        .map(|(row, (word, load))| Ok((word.unwrap_or_default().to_owned(), load, branch(frame, row)?)))
        .collect()
}

fn branch(frame: &DataFrame, row: usize) -> PolarsResult<Branch> {
    let list = |name: &str| -> PolarsResult<Series> { Ok(cell(frame.column(name)?, row)?.unwrap_or_default()) };
    // These columns are never null in the schema; a null in a damaged file becomes NaN, which the table of results refuses.
    let reals = |name: &str| -> PolarsResult<Vec<f64>> { Ok(list(name)?.f64()?.iter().map(|value| value.unwrap_or(f64::NAN)).collect()) };
    let wholes = |name: &str| -> PolarsResult<Vec<i64>> { Ok(list(name)?.i64()?.iter().map(Option::unwrap_or_default).collect()) };
    Ok(Branch {
        step: wholes("step")?,
        load: reals("load")?,
        load_n: reals("load_n")?,
        least_load_n: reals("least_load_n")?,
        area: reals("area")?,
        penetration: reals("penetration")?,
        area_m2: reals("area_m2")?,
        area_union_m2: list("area_union_m2")?.f64()?.iter().collect(),
        work_j: reals("work_j")?,
        dissipated_j: reals("dissipated_j")?,
        contact_count: wholes("contact_count")?,
        covered_count: wholes("covered_count")?,
        touching_count: wholes("touching_count")?,
        held_count: wholes("held_count")?,
        reversal_load: match frame.column(REVERSAL) {
            Ok(column) => cell(column, row)?.unwrap_or_default().f64()?.iter().collect(),
            Err(_) => Vec::new(),
        },
        converged: list("converged")?.bool()?.iter().map(Option::unwrap_or_default).collect(),
    })
}

fn cell(column: &Column, row: usize) -> PolarsResult<Option<Series>> {
    Ok(column.list()?.get_as_series(row))
}
