//! Discretization errors of results by boundary elements, from loops of one case on several grids.
//!
//! Cases that differ only in their grid are a family ([`CaseInput::family`]). A result has an error if the
//! same surfaces were loaded and unloaded on a coarser grid of the family. The error of a mean follows from
//! the means over the surfaces that all grids have: there, events that single surfaces skip on one grid
//! average out.
//!
//! Shifted copies of a grid are no grids of a series. The standard deviation of their values is the scatter
//! by the position of the grid, which is part of the error.

use super::cautions::{GRID_ERROR, with_code};
use super::rows::Rows;
use super::{CaseInput, Given, StatsError};
use crate::schema::GRIDS;
use crate::store::{ColumnData, Frame};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Estimated error of the value on the finest grid of a series.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GridEstimate {
    /// Error over the magnitude of the value.
    pub relative: f64,
    /// Value on an infinitely fine grid, if the series has a limit.
    pub extrapolated: Option<f64>,
}

/// Values of a result on several grids.
#[derive(Debug, Clone, Copy)]
pub struct GridSeries<'a> {
    /// Points of the grids, ascending.
    pub points: &'a [f64],
    /// Values on these grids.
    pub values: &'a [f64],
    /// Values on one coarser grid and on its shifted copies; empty without copies.
    pub copies: &'a [f64],
    /// Spacing of that grid over the spacing of the finest grid; not a number without copies.
    pub refinement: f64,
}

/// Error of the last value of a series; nothing where it is undefined.
pub type GridRule = fn(&GridSeries<'_>) -> Option<GridEstimate>;

/// Results with an error: column of the table `realizations`, and stem of the columns of the error.
pub const QUANTITIES: [(&str, &str); 5] = [
    ("area_at_max_load", "area"),
    ("pull_off_load", "pull_off"),
    ("loss", "loss"),
    ("dissipated_loading", "loading"),
    ("dissipated_unloading", "unloading"),
];

/// Place of the dissipated energy among [`QUANTITIES`].
const LOSS: usize = 2;

/// Column of the table `cases` with the number of surfaces behind the errors of means.
const SURFACES: &str = "grid_surface_count";

/// Grids of a series, at most: the finest ones.
const MOST: usize = 3;

/// Tables with the errors of grids.
#[derive(Debug)]
pub struct WithGridErrors {
    /// Table `realizations` without the cases that are only coarser grids of others.
    pub realizations: Frame,
    /// Table `cases` without these cases.
    pub cases: Frame,
    /// Table `grids`.
    pub grids: Frame,
}

/// Fills the columns `*_grid_error` of both tables, and drops the rows of cases that are only coarser grids
/// of others.
///
/// # Errors
/// If a table lacks a column.
pub fn with_grid_errors(
    realizations: &Frame,
    cases: &Frame,
    inputs: &[CaseInput],
    rule: GridRule,
) -> Result<WithGridErrors, StatsError> {
    let loops = Loops::of(realizations, inputs)?;
    let hidden: BTreeSet<&str> =
        inputs.iter().filter(|case| case.is_coarser_grid).map(|case| case.case_id.as_str()).collect();
    let of_loops = (0..realizations.row_count()).map(|row| loops.errors(row, rule));
    let by_case: HashMap<&str, &CaseInput> =
        inputs.iter().map(|case| (case.case_id.as_str(), case)).collect();
    let (ids, loads) = (cases.text("case_id")?, cases.f64("max_load")?);
    let (mut of_cases, mut surfaces, mut grids) = (Vec::new(), Vec::new(), Rows::of(&GRIDS));
    let mut above = Vec::new();
    for (id, load) in ids.iter().zip(&loads) {
        let series = by_case.get(id).map(|case| loops.series(case, *load)).unwrap_or_default();
        let errors = series.last().map(|grid| grid.errors(rule)).unwrap_or_default();
        let goal = by_case.get(id).and_then(|case| case.grid_error_goal);
        above.push(goal.is_some_and(|goal| errors[LOSS].is_none_or(|error| error > goal)));
        of_cases.push(errors);
        let is_series = series.len() > 1 && !hidden.contains(id);
        surfaces.push(series.last().filter(|_| is_series).map(|grid| grid.surface_count as i64));
        if is_series {
            for grid in &series {
                grids.push(&[&grid.row(id, *load, rule)]);
            }
        }
    }
    let cases = with_cautions(cases, &above)?;
    Ok(WithGridErrors {
        realizations: filled(realizations, (&of_loops.collect::<Vec<_>>(), &[]), &hidden)?,
        cases: filled(&cases, (&of_cases, &surfaces), &hidden)?,
        grids: grids.build()?,
    })
}

/// Relative errors of the results, in the order of [`QUANTITIES`].
type Errors = [Option<f64>; QUANTITIES.len()];

/// A table with the columns of errors and of the surfaces behind them, without the rows of some cases.
fn filled(
    frame: &Frame,
    (errors, surfaces): (&[Errors], &[Option<i64>]),
    hidden: &BTreeSet<&str>,
) -> Result<Frame, StatsError> {
    let ids = frame.text("case_id")?;
    let kept: Vec<usize> = (0..ids.len()).filter(|row| !hidden.contains(ids[*row])).collect();
    let mut built = Frame::of(frame.table());
    for (column, data) in frame.columns() {
        let place = QUANTITIES.iter().position(|(_, stem)| error_column(stem) == column.name);
        let data = match (place, data) {
            (Some(place), _) => ColumnData::F64(kept.iter().map(|row| errors[*row][place]).collect()),
            (None, _) if column.name == SURFACES => ColumnData::I64(picked(surfaces, &kept)),
            (None, ColumnData::F64(values)) => ColumnData::F64(picked(values, &kept)),
            (None, ColumnData::I64(values)) => ColumnData::I64(picked(values, &kept)),
            (None, ColumnData::Bool(values)) => ColumnData::Bool(picked(values, &kept)),
            (None, ColumnData::Text(values)) => ColumnData::Text(picked(values, &kept)),
        };
        built = built.with(column.name, data);
    }
    Ok(built.build()?)
}

/// The table `cases` with the warning of a grid error above the required one in some rows.
fn with_cautions(cases: &Frame, above: &[bool]) -> Result<Frame, StatsError> {
    let codes = cases.text("caution")?.into_iter().zip(above);
    let codes = codes.map(|(codes, is_above)| {
        Some(if *is_above { with_code(codes, GRID_ERROR) } else { codes.to_owned() })
    });
    let codes: Vec<Option<String>> = codes.collect();
    let mut built = Frame::of(cases.table());
    for (column, data) in cases.columns() {
        let data = if column.name == "caution" { ColumnData::Text(codes.clone()) } else { data.clone() };
        built = built.with(column.name, data);
    }
    Ok(built.build()?)
}

fn picked<T: Clone>(values: &[T], rows: &[usize]) -> Vec<T> {
    rows.iter().map(|row| values[*row].clone()).collect()
}

/// Name of the column of an error.
fn error_column(stem: &str) -> String {
    format!("{stem}_grid_error")
}

/// Family, and bits of the load.
type Key<'a> = (&'a str, u64);

/// Surfaces with a value of each result.
type Surfaces = [BTreeSet<i64>; QUANTITIES.len()];

/// All loops by boundary elements, by row of the table `realizations`.
struct Loops<'a> {
    /// Family, bits of the load, and realization of each row; nothing for other methods.
    keys: Vec<Option<(&'a str, u64, i64)>>,
    case_ids: Vec<&'a str>,
    points: Vec<f64>,
    values: Vec<Errors>,
    /// Rows of each family and load, without shifted copies.
    rows: HashMap<Key<'a>, Vec<usize>>,
    /// Rows of one grid of each family and load, then those of each of its shifted copies.
    copies: HashMap<Key<'a>, Vec<Vec<usize>>>,
}

impl<'a> Loops<'a> {
    fn of(realizations: &'a Frame, inputs: &'a [CaseInput]) -> Result<Self, StatsError> {
        let families: HashMap<&str, &str> =
            inputs.iter().filter_map(|case| Some((case.case_id.as_str(), case.family.as_deref()?))).collect();
        let (case_ids, loads) = (realizations.text("case_id")?, realizations.f64("max_load")?);
        let numbers = realizations.i64("realization")?;
        let points = realizations.f64_or_null("elements_per_wavelength")?;
        let columns = QUANTITIES.map(|(column, _)| realizations.f64_or_null(column));
        let key = |row: usize| {
            let family = points[row].and(families.get(case_ids[row]))?;
            Some((*family, loads[row].to_bits(), numbers[row]))
        };
        let keys: Vec<_> = (0..case_ids.len()).map(key).collect();
        let shifted: BTreeSet<&str> =
            inputs.iter().filter(|case| case.is_shifted_copy).map(|case| case.case_id.as_str()).collect();
        let [mut rows, mut of_copies]: [HashMap<_, Vec<usize>>; 2] = Default::default();
        for (row, key) in keys.iter().enumerate() {
            if let Some((family, load, _)) = key {
                let rows = if shifted.contains(case_ids[row]) { &mut of_copies } else { &mut rows };
                rows.entry((*family, *load)).or_default().push(row);
            }
        }
        let mut values = vec![Errors::default(); case_ids.len()];
        for (place, column) in columns.into_iter().enumerate() {
            for (row, value) in column?.iter().enumerate() {
                values[row][place] = *value;
            }
        }
        let points = points.iter().map(|points| points.unwrap_or_default()).collect();
        let mut loops = Self { keys, case_ids, points, values, rows, copies: HashMap::new() };
        loops.copies = of_copies.into_iter().map(|(key, rows)| (key, loops.groups(key, &rows))).collect();
        Ok(loops)
    }

    /// Rows of the shifted copies of a grid by their cases, after those of the grid itself.
    fn groups(&self, key: Key<'a>, copies: &[usize]) -> Vec<Vec<usize>> {
        let mut by_case: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        copies.iter().for_each(|row| by_case.entry(self.case_ids[*row]).or_default().push(*row));
        let surface = |row: usize| self.keys[row].map(|key| (key.2, self.points[row].to_bits()));
        let mut wanted: BTreeSet<_> = copies.iter().filter_map(|row| surface(*row)).collect();
        // Equal grids of different cases count once.
        let unshifted = self.rows.get(&key).into_iter().flatten().copied();
        let unshifted = unshifted.filter(|row| surface(*row).is_some_and(|of| wanted.remove(&of))).collect();
        let all = std::iter::once(unshifted).chain(by_case.into_values());
        all.filter(|rows| !rows.is_empty()).collect()
    }

    /// Groups of the rows of a grid and of its shifted copies; empty without them.
    fn copies(&self, key: Key<'a>) -> Vec<&[usize]> {
        self.copies.get(&key).into_iter().flatten().map(Vec::as_slice).collect()
    }

    /// Means of each result over the surfaces that a grid, its shifted copies and a series have.
    fn means_of_copies(&self, key: Key<'a>, of_series: &Surfaces) -> Copies {
        let groups = self.copies(key);
        let common = self.common(&groups);
        let values = std::array::from_fn(|place| {
            let surfaces = &common[place] & &of_series[place];
            groups.iter().filter_map(|rows| self.mean(rows, place, &surfaces)).collect()
        });
        Copies { values, points: mean(groups.iter().copied().flatten().map(|row| self.points[*row])) }
    }

    /// Results on one surface of a grid and of its shifted copies.
    fn copies_of_surface(&self, key: Key<'a>, realization: i64) -> Copies {
        let groups = self.copies(key);
        let is_own = |row: &usize| self.keys[*row].is_some_and(|key| key.2 == realization);
        let rows: Vec<usize> = groups.into_iter().flatten().copied().filter(is_own).collect();
        let values =
            std::array::from_fn(|place| rows.iter().filter_map(|row| self.values[*row][place]).collect());
        Copies { values, points: mean(rows.iter().map(|row| self.points[*row])) }
    }

    /// Mean of a result over surfaces; nothing without surfaces.
    fn mean(&self, rows: &[usize], place: usize, surfaces: &BTreeSet<i64>) -> Option<f64> {
        let values = rows.iter().filter_map(|row| {
            let is_common = self.keys[*row].is_some_and(|key| surfaces.contains(&key.2));
            self.values[*row][place].filter(|_| is_common)
        });
        Some(mean(values)).filter(|_| !surfaces.is_empty())
    }

    /// Errors of the results of one loop, from loops of the same surface.
    fn errors(&self, row: usize, rule: GridRule) -> Errors {
        let Some((family, load, realization)) = self.keys[row] else { return Errors::default() };
        // A copy may be the only loop of its family.
        let of_family = self.rows.get(&(family, load)).into_iter().flatten();
        let of_surface = of_family.filter(|other| {
            self.keys[**other].is_some_and(|key| key.2 == realization)
                && self.points[**other] < self.points[row]
        });
        // Equal grids of different cases count once.
        let mut coarser: Vec<usize> = of_surface.copied().collect();
        coarser.sort_by(|a, b| self.points[*a].total_cmp(&self.points[*b]));
        coarser.dedup_by(|a, b| self.points[*a] == self.points[*b]);
        let finest = coarser.split_off((coarser.len() + 1).saturating_sub(MOST));
        let all: Vec<usize> = finest.into_iter().chain([row]).collect();
        let points: Vec<f64> = all.iter().map(|of| self.points[*of]).collect();
        let copies = self.copies_of_surface((family, load), realization);
        std::array::from_fn(|place| {
            let values = all.iter().map(|of| self.values[*of][place]).collect::<Option<Vec<f64>>>()?;
            estimate(rule, (&points, &values), &copies, place).map(|of| of.relative)
        })
    }

    /// Grids of a case at a load reversal, the finest last: the coarser ones of its family, and its own.
    /// Empty without a finished loop.
    fn series(&self, case: &CaseInput, max_load: f64) -> Vec<Grid<'a>> {
        let Some(family) = case.family.as_deref() else { return Vec::new() };
        let key = (family, max_load.to_bits());
        let Some((key, rows)) = self.rows.get_key_value(&key) else { return Vec::new() };
        let mut by_case: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        for row in rows {
            by_case.entry(self.case_ids[*row]).or_default().push(*row);
        }
        let Some(own) = by_case.remove(case.case_id.as_str()) else { return Vec::new() };
        let resolution = |rows: &[usize]| mean(rows.iter().map(|row| self.points[*row]));
        let finest = resolution(&own);
        let mut all: Vec<(f64, Vec<usize>)> = by_case
            .into_values()
            .map(|rows| (resolution(&rows), rows))
            .filter(|(of, _)| *of < finest)
            .collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        all.dedup_by(|a, b| a.0 == b.0);
        all.push((finest, own));
        let all = all.split_off(all.len().saturating_sub(MOST));
        let common = self.common(&all.iter().map(|(_, rows)| rows.as_slice()).collect::<Vec<_>>());
        let copies = self.means_of_copies(*key, &common);
        let mut series: Vec<Grid<'a>> = Vec::new();
        for (points, rows) in &all {
            let coarser = series.last().map_or(&[][..], |grid| &grid.points);
            let points = [coarser, &[*points]].concat();
            let values = std::array::from_fn(|place| {
                let coarser = series.last().map_or(&[][..], |grid| &grid.values[place]);
                [coarser, &[self.mean(rows, place, &common[place])]].concat()
            });
            series.push(Grid {
                case_id: self.case_ids[rows[0]],
                points,
                values,
                copies: copies.clone(),
                surface_count: common[LOSS].len(),
            });
        }
        series
    }

    /// Surfaces with a value of each result on all grids.
    fn common(&self, all: &[&[usize]]) -> Surfaces {
        std::array::from_fn(|place| {
            let of = |rows: &[usize]| -> BTreeSet<i64> {
                let known = rows.iter().filter(|row| self.values[**row][place].is_some());
                known.filter_map(|row| self.keys[*row].map(|key| key.2)).collect()
            };
            all.iter().map(|rows| of(rows)).reduce(|a, b| &a & &b).unwrap_or_default()
        })
    }
}

/// Results on a grid and on its shifted copies.
#[derive(Debug, Clone)]
struct Copies {
    /// Values of each result.
    values: [Vec<f64>; QUANTITIES.len()],
    /// Points per shortest wavelength; not a number without copies.
    points: f64,
}

/// One grid of a series with the coarser ones.
#[derive(Debug)]
struct Grid<'a> {
    case_id: &'a str,
    /// Points per shortest wavelength of the grids up to this one.
    points: Vec<f64>,
    /// Means of each result on these grids.
    values: [Vec<Option<f64>>; QUANTITIES.len()],
    /// Means of each result on one coarser grid and on its shifted copies.
    copies: Copies,
    surface_count: usize,
}

impl Grid<'_> {
    fn estimate(&self, place: usize, rule: GridRule) -> Option<GridEstimate> {
        let values = self.values[place].iter().copied().collect::<Option<Vec<f64>>>()?;
        estimate(rule, (&self.points, &values), &self.copies, place)
    }

    fn errors(&self, rule: GridRule) -> Errors {
        std::array::from_fn(|place| self.estimate(place, rule).map(|of| of.relative))
    }

    /// Row of the table `grids`.
    fn row(&self, case_id: &str, max_load: f64, rule: GridRule) -> Given {
        let mut row: Given = vec![
            ("case_id".to_owned(), case_id.into()),
            ("max_load".to_owned(), max_load.into()),
            ("grid_case_id".to_owned(), self.case_id.into()),
            ("elements_per_wavelength".to_owned(), self.points.last().copied().into()),
            ("surface_count".to_owned(), self.surface_count.into()),
        ];
        for (place, (column, stem)) in QUANTITIES.into_iter().enumerate() {
            let of = self.estimate(place, rule);
            row.push((format!("{column}_mean"), self.values[place].last().copied().flatten().into()));
            row.push((error_column(stem), of.map(|of| of.relative).into()));
            row.push((format!("{stem}_extrapolated"), of.and_then(|of| of.extrapolated).into()));
        }
        row
    }
}

/// Estimate of a result on a series of at least two grids, if it is finite. Copies of a grid that is not
/// coarser than the finest one do not count.
fn estimate(
    rule: GridRule,
    (points, values): (&[f64], &[f64]),
    copies: &Copies,
    place: usize,
) -> Option<GridEstimate> {
    let refinement = points.last()? / copies.points;
    let copies: &[f64] = if refinement > 1.0 { &copies.values[place] } else { &[] };
    let series = GridSeries { points, values, copies, refinement };
    let found = (points.len() > 1).then(|| rule(&series)).flatten();
    found.filter(|of| of.relative.is_finite())
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let all: Vec<f64> = values.collect();
    all.iter().sum::<f64>() / all.len() as f64
}
