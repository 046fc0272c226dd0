//! Means and standard deviations over the realizations of each case and load reversal.

use polars::prelude::{IntoColumn, NamedFrom, Series};
use std::collections::BTreeSet;

use super::cautions::caution;
use super::grouped::grouped;
use super::loads;
use super::model_error;
use super::realizations::identity;
use super::rows::{Rows, Value};
use super::student::Sample;
use super::{CaseInput, Given, StatsError};
use crate::schema::{CASES, Kind, REALIZATIONS};
use crate::store::{ColumnData, Frame};

/// Averages each case at each of its load reversals. The rows have the order of the inputs, and the load
/// reversals of a case ascend.
///
/// A case without finished realization has its row, with null means. The table has `<column>_mean`, `_sd`,
/// `_ci95_low`, `_ci95_high`, `_min` and `_max` of columns of the table `realizations`; realizations in which
/// that column is null are omitted. Columns that depend on the surface alone ([`CaseInput::surfaces`])
/// include the surfaces of failed cycles. Fractions of contacts are weighted by the number of contacts.
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
            let same = |group: &&Group| {
                group.case_id == case.case_id && (group.max_load - max_load).abs() <= 1e-9 * max_load.abs()
            };
            let none = Group::default();
            let group = groups.iter().find(same).unwrap_or(&none);
            let finished = groups
                .iter()
                .filter(|group| group.case_id == case.case_id)
                .flat_map(|group| &group.realizations);
            let finished = finished.collect::<BTreeSet<_>>().len();
            rows.push(&[&identity(case), &averages(group, case, max_load, finished), &case.parameters]);
        }
    }
    rows.build()
}

/// Statistic over the realizations in a column of the table `cases`.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Statistic {
    Mean,
    Sd,
    Low,
    High,
    Least,
    Greatest,
    Count,
}

const STATISTICS: [(&str, Statistic); 7] = [
    ("_mean", Statistic::Mean),
    ("_sd", Statistic::Sd),
    ("_ci95_low", Statistic::Low),
    ("_ci95_high", Statistic::High),
    ("_min", Statistic::Least),
    ("_max", Statistic::Greatest),
    ("_count", Statistic::Count),
];

impl Statistic {
    /// The column of the table `realizations` behind a column of the table `cases`, and what is said of it.
    fn of(column: &'static str) -> Option<(&'static str, Self)> {
        let numbers = |base: &str| {
            REALIZATIONS.column(base).is_some_and(|base| matches!(base.kind, Kind::F64 | Kind::I64))
        };
        STATISTICS.iter().find_map(|(end, what)| {
            column.strip_suffix(end).filter(|base| numbers(base)).map(|base| (base, *what))
        })
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
            Self::Count => Some(values.len() as f64).filter(|count| *count > 0.0),
        }
    }
}

/// Number of surfaces in the mean of a result, and of all finished ones, where the first is smaller.
///
/// # Errors
/// If the table `cases` lacks the number of finished surfaces.
pub fn fewer_surfaces(cases: &Frame, column: &str, row: usize) -> Result<Option<[i64; 2]>, StatsError> {
    let name = format!("{column}_count");
    if cases.table().column(&name).is_none() {
        return Ok(None);
    }
    let count = cases.i64_or_null(&name)?.get(row).copied().flatten();
    let done = cases.i64("done_count")?.get(row).copied().unwrap_or_default();
    Ok(count.filter(|count| *count < done).map(|count| [count, done]))
}

/// The columns of the table `realizations` that the table `cases` says something of.
fn averaged() -> Vec<&'static str> {
    let counts = POOLED.iter().flat_map(|(_, part, whole)| whole.iter().copied().chain([*part]));
    let mut names: Vec<&str> =
        CASES.columns.iter().filter_map(|column| Statistic::of(column.name)).map(|(base, _)| base).collect();
    names.extend(counts);
    names.sort_unstable();
    names.dedup();
    names
}

/// The realizations of one case and load reversal, in their order.
#[derive(Debug, Clone, Default)]
struct Group {
    case_id: String,
    max_load: f64,
    realizations: Vec<i64>,
    unconverged: Vec<f64>,
    /// The values that are not null, by column.
    values: Vec<(&'static str, Vec<f64>)>,
}

/// Fractions whose mean is the ratio of two sums over all realizations: the column, the counted contacts or
/// asperities, and the counts of which they are a part. The mean of the fractions of single surfaces would
/// give a surface with one contact the weight of one with a hundred.
const POOLED: [(&str, &str, &[&str]); 2] = [
    ("touching_share", "touching_count_at_max_load", &["contact_count_at_max_load"]),
    (
        "covered_share",
        "covered_count_at_max_load",
        &["contact_count_at_max_load", "covered_count_at_max_load"],
    ),
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

fn averages(group: &Group, case: &CaseInput, max_load: f64, finished: usize) -> Given {
    let mut row: Given = loads::columns(case, max_load);
    for column in CASES.columns {
        let Some((base, what)) = Statistic::of(column.name) else { continue };
        let pooled = POOLED.iter().find(|(name, ..)| what == Statistic::Mean && *name == base);
        let of_surfaces: Vec<f64> = case
            .surfaces
            .iter()
            .flatten()
            .filter(|(name, _)| name == base)
            .filter_map(|(_, value)| value.number())
            .collect();
        let value = match pooled {
            Some((_, part, whole)) => group.pooled(part, whole),
            None if of_surfaces.is_empty() => what.take(group.values(base)),
            None => what.take(&of_surfaces),
        };
        let is_count = what == Statistic::Count;
        let value = if is_count { value.map(|count| count as i64).into() } else { Value::from(value) };
        row.push((column.name.to_owned(), value));
    }
    let done = group.unconverged.len();
    row.push(("planned_count".to_owned(), case.planned_count.into()));
    row.push(("done_count".to_owned(), done.into()));
    row.push(("failed_count".to_owned(), case.failed_count.into()));
    row.push(("unresolved_count".to_owned(), (done - group.values("loss").len().min(done)).into()));
    row.push(("not_reached_count".to_owned(), (finished - done).into()));
    let is_unconverged = group.unconverged.iter().any(|count| *count > 0.0);
    let is_full = group.values("area_at_max_load").iter().any(|area| *area >= 1.0);
    let words = caution(&row, case, [done, finished], [is_unconverged, is_full]);
    row.extend(model_error::columns(&row, case));
    row.push(("caution".to_owned(), words.as_str().into()));
    row
}

fn groups(realizations: &Frame) -> Result<Vec<Group>, StatsError> {
    let (ids, loads) = (realizations.text("case_id")?, realizations.f64("max_load")?);
    let realization = realizations.i64("realization")?;
    let columns = vec![
        Series::new("case_id".into(), &ids).into_column(),
        Series::new("max_load".into(), &loads).into_column(),
        Series::new("realization".into(), &realization).into_column(),
    ];
    let rows = grouped(columns, &["case_id", "max_load"], &["case_id", "max_load", "realization"]);
    let rows = rows.map_err(|source| StatsError::Group { table: realizations.table().name, source })?;
    let values = |name: &'static str| Ok((name, numbers(realizations, name)?));
    let columns: Vec<(&str, Vec<Option<f64>>)> =
        averaged().into_iter().map(values).collect::<Result<_, StatsError>>()?;
    let unconverged = numbers(realizations, "unconverged_count")?;
    let picked = |values: &[Option<f64>], rows: &[usize]| {
        rows.iter().filter_map(|row| values[*row]).collect::<Vec<f64>>()
    };
    let group = |rows: Vec<usize>| {
        let first = rows.first().copied()?;
        Some(Group {
            case_id: ids[first].to_owned(),
            max_load: loads[first],
            realizations: rows.iter().map(|row| realization[*row]).collect(),
            unconverged: picked(&unconverged, &rows),
            values: columns.iter().map(|(name, values)| (*name, picked(values, &rows))).collect(),
        })
    };
    Ok(rows.into_iter().filter_map(group).collect())
}

/// A column of real or whole numbers.
fn numbers(frame: &Frame, name: &str) -> Result<Vec<Option<f64>>, StatsError> {
    Ok(match frame.column(name)? {
        ColumnData::I64(counts) => counts.iter().map(|count| count.map(|count| count as f64)).collect(),
        _ => frame.f64_or_null(name)?.to_vec(),
    })
}
