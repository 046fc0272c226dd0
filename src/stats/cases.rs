//! Means and spreads over the realizations of each case and turning point.

use polars::prelude::{DataFrame, DataType, IntoColumn, IntoLazy, NamedFrom, PolarsResult, Series, SortMultipleOptions, col};

use super::cautions::caution;
use super::realizations::identity;
use super::rows::{Rows, Value};
use super::student::Sample;
use super::{CaseInput, Given, StatsError};
use crate::schema::{CASES, Kind, REALIZATIONS};
use crate::store::Frame;

/// Averages each case at each of its turning points; rows are ordered by case and turning point, and a case without any finished
/// realization has its row, without means.
///
/// What is averaged is what the table has columns for: `<column>_mean`, `_sd`, `_ci95_low`, `_ci95_high`, `_min` and `_max` of a column of the
/// table `realizations`. A realization in which that column is null is left out.
///
/// # Errors
/// If a column is missing, or a required parameter of a case was not given.
pub fn cases(realizations: &Frame, inputs: &[CaseInput]) -> Result<Frame, StatsError> {
    let groups = groups(realizations)?;
    let mut ordered: Vec<(&CaseInput, f64)> =
        inputs.iter().flat_map(|case| case.max_loads.iter().map(move |max_load| (case, *max_load))).collect();
    ordered.sort_by(|a, b| a.0.case_id.cmp(&b.0.case_id).then(a.1.total_cmp(&b.1)));
    let mut rows = Rows::of(&CASES);
    for (case, max_load) in ordered {
        // A turning point is a number of the spec, copied; the tolerance only forgives a rounding on the way through a file.
        let same = |group: &&Group| group.case_id == case.case_id && (group.max_load - max_load).abs() <= 1e-9 * max_load.abs();
        let none = Group::default();
        let group = groups.iter().find(same).unwrap_or(&none);
        rows.push(&[&identity(case), &averages(group, case, max_load), &case.parameters]);
    }
    rows.build()
}

/// What a column of the table `cases` says of the realizations.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Statistic {
    Mean,
    Sd,
    Low,
    High,
    Least,
    Greatest,
}

const STATISTICS: [(&str, Statistic); 6] = [
    ("_mean", Statistic::Mean),
    ("_sd", Statistic::Sd),
    ("_ci95_low", Statistic::Low),
    ("_ci95_high", Statistic::High),
    ("_min", Statistic::Least),
    ("_max", Statistic::Greatest),
];

impl Statistic {
    /// The column of the table `realizations` behind a column of the table `cases`, and what is said of it.
    fn of(column: &'static str) -> Option<(&'static str, Self)> {
        let numbers = |base: &str| REALIZATIONS.column(base).is_some_and(|base| base.kind == Kind::F64);
        STATISTICS.iter().find_map(|(end, what)| column.strip_suffix(end).filter(|base| numbers(base)).map(|base| (base, *what)))
    }

    fn take(self, values: &[f64]) -> Option<f64> {
        let sample = Sample::of(values);
        let end = |sign: f64| sample.mean.zip(sample.ci95).map(|(mean, half)| mean + sign * half);
        match self {
            Self::Mean => sample.mean,
            Self::Sd => sample.sd,
            Self::Low => end(-1.0),
            Self::High => end(1.0),
            Self::Least => values.iter().copied().min_by(f64::total_cmp),
            Self::Greatest => values.iter().copied().max_by(f64::total_cmp),
        }
    }
}

/// The columns of the table `realizations` that the table `cases` says something of.
fn averaged() -> Vec<&'static str> {
    let mut names: Vec<&str> = CASES.columns.iter().filter_map(|column| Statistic::of(column.name)).map(|(base, _)| base).collect();
    names.sort_unstable();
    names.dedup();
    names
}

/// The realizations of one case and turning point, in their order.
#[derive(Debug, Clone, Default)]
struct Group {
    case_id: String,
    max_load: f64,
    unconverged: Vec<f64>,
    /// The values that are not null, by column.
    values: Vec<(&'static str, Vec<f64>)>,
}

fn averages(group: &Group, case: &CaseInput, max_load: f64) -> Given {
    let mut row: Given = vec![("max_load".to_owned(), max_load.into())];
    for column in CASES.columns {
        if let Some((base, what)) = Statistic::of(column.name) {
            let values = group.values.iter().find(|(name, _)| *name == base).map_or(&[][..], |(_, values)| values);
            row.push((column.name.to_owned(), Value::from(what.take(values))));
        }
    }
    let done = group.unconverged.len();
    row.push(("planned_count".to_owned(), case.planned_count.into()));
    row.push(("done_count".to_owned(), done.into()));
    row.push(("failed_count".to_owned(), case.failed_count.into()));
    let words = caution(&row, case, done, group.unconverged.iter().any(|count| *count > 0.0));
    row.push(("caution".to_owned(), words.as_str().into()));
    row
}

fn groups(realizations: &Frame) -> Result<Vec<Group>, StatsError> {
    let mut columns = vec![
        Series::new("case_id".into(), realizations.text("case_id")?).into_column(),
        Series::new("max_load".into(), realizations.f64("max_load")?).into_column(),
        Series::new("realization".into(), realizations.i64("realization")?).into_column(),
        Series::new("unconverged_count".into(), realizations.i64("unconverged_count")?).into_column(),
    ];
    let names = averaged();
    for name in &names {
        columns.push(Series::new((*name).into(), realizations.f64_or_null(name)?).into_column());
    }
    let grouped = DataFrame::new_infer_height(columns).and_then(|frame| group(frame, &names));
    grouped.map_err(|source| StatsError::Group { table: realizations.table().name, source })
}

fn group(frame: DataFrame, names: &[&'static str]) -> PolarsResult<Vec<Group>> {
    let keys = [col("case_id"), col("max_load")];
    let lists: Vec<_> = ["unconverged_count"].iter().chain(names).map(|name| col(*name)).collect();
    let order = SortMultipleOptions::default().with_maintain_order(true);
    let grouped = frame.lazy().sort(["case_id", "max_load", "realization"], order).group_by_stable(keys).agg(lists).collect()?;
    let words = grouped.column("case_id")?.str()?;
    let loads = grouped.column("max_load")?.f64()?;
    let list = |name: &str, row: usize| -> PolarsResult<Vec<f64>> {
        let series = grouped.column(name)?.list()?.get_as_series(row).unwrap_or_default();
        Ok(series.cast(&DataType::Float64)?.f64()?.iter().flatten().collect())
    };
    words
        .iter()
        .zip(loads.iter())
        .enumerate()
        .map(|(row, (word, load))| {
            Ok(Group {
                case_id: word.unwrap_or_default().to_owned(),
                max_load: load.unwrap_or_default(),
                unconverged: list("unconverged_count", row)?,
                values: names.iter().map(|name| Ok((*name, list(name, row)?))).collect::<PolarsResult<_>>()?,
            })
        })
        .collect()
}
