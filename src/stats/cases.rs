//! Means and spreads over the realizations of each case and turning point.

use polars::prelude::{DataFrame, DataType, IntoColumn, IntoLazy, NamedFrom, PolarsResult, Series, SortMultipleOptions, col};

use super::cautions::caution;
use super::model_error;
use super::realizations::identity;
use super::rows::{Rows, Value};
use super::student::Sample;
use super::{CaseInput, Given, StatsError};
use crate::schema::{CASES, Kind, REALIZATIONS};
use crate::store::{ColumnData, Frame};

/// Averages each case at each of its load reversals. The rows have the order of the inputs, and the load reversals of a case ascend.
///
/// A case without finished realization has its row, with null means. The table has `<column>_mean`, `_sd`, `_ci95_low`, `_ci95_high`, `_min` and `_max` of
/// columns of the table `realizations`; realizations in which that column is null are omitted. Columns that depend on the surface alone
/// ([`CaseInput::surfaces`]) include the surfaces of failed cycles. Fractions of contacts are weighted by the number of contacts.
///
/// # Errors
/// If a column is missing, or a required parameter of a case was not given.
pub fn cases(realizations: &Frame, inputs: &[CaseInput]) -> Result<Frame, StatsError> {
    let groups = groups(realizations)?;
    let mut rows = Rows::of(&CASES);
    for case in inputs {
        let mut max_loads = case.max_loads.clone();
        max_loads.sort_by(f64::total_cmp);
        for max_load in max_loads {
            // A load reversal is a number of the spec, copied; the tolerance covers the rounding in a file.
            let same = |group: &&Group| group.case_id == case.case_id && (group.max_load - max_load).abs() <= 1e-9 * max_load.abs();
            let none = Group::default();
            let group = groups.iter().find(same).unwrap_or(&none);
            rows.push(&[&identity(case), &averages(group, case, max_load), &case.parameters]);
        }
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
        let numbers = |base: &str| REALIZATIONS.column(base).is_some_and(|base| matches!(base.kind, Kind::F64 | Kind::I64));
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
    let counts = POOLED.iter().flat_map(|(_, part, whole)| whole.iter().copied().chain([*part]));
    let mut names: Vec<&str> = CASES.columns.iter().filter_map(|column| Statistic::of(column.name)).map(|(base, _)| base).collect();
    names.extend(counts);
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

/// Fractions whose mean is the ratio of two sums over all realizations: the column, the counted contacts or asperities, and the counts of which they are a
/// part. The mean of the fractions of single surfaces would give a surface with one contact the weight of one with a hundred.
const POOLED: [(&str, &str, &[&str]); 2] = [
    ("touching_share", "touching_count_at_max_load", &["contact_count_at_max_load"]),
    ("covered_share", "covered_count_at_max_load", &["contact_count_at_max_load", "covered_count_at_max_load"]),
];

impl Group {
    fn values(&self, column: &str) -> &[f64] {
        self.values.iter().find(|(name, _)| *name == column).map_or(&[], |(_, values)| values)
    }

    /// The pooled fraction of a column; null without counts.
    fn pooled(&self, part: &str, whole: &[&str]) -> Option<f64> {
        let sum = |column: &str| self.values(column).iter().sum::<f64>();
        let whole: f64 = whole.iter().map(|column| sum(column)).sum();
        (whole > 0.0).then(|| sum(part) / whole)
    }
}

fn averages(group: &Group, case: &CaseInput, max_load: f64) -> Given {
    let mut row: Given = vec![("max_load".to_owned(), max_load.into())];
    for column in CASES.columns {
        let Some((base, what)) = Statistic::of(column.name) else { continue };
        let pooled = POOLED.iter().find(|(name, ..)| what == Statistic::Mean && *name == base);
        let of_surfaces: Vec<f64> =
            case.surfaces.iter().flatten().filter(|(name, _)| name == base).filter_map(|(_, value)| value.number()).collect();
        let value = match pooled {
            Some((_, part, whole)) => group.pooled(part, whole),
            None if of_surfaces.is_empty() => what.take(group.values(base)),
            None => what.take(&of_surfaces),
        };
        row.push((column.name.to_owned(), Value::from(value)));
    }
    let done = group.unconverged.len();
    row.push(("planned_count".to_owned(), case.planned_count.into()));
    row.push(("done_count".to_owned(), done.into()));
    row.push(("failed_count".to_owned(), case.failed_count.into()));
    let words = caution(&row, case, done, group.unconverged.iter().any(|count| *count > 0.0));
    row.extend(model_error::columns(&row, case));
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
        columns.push(match realizations.column(name)? {
            ColumnData::I64(counts) => Series::new((*name).into(), counts).into_column(),
            _ => Series::new((*name).into(), realizations.f64_or_null(name)?).into_column(),
        });
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
