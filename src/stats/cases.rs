//! Means and spreads over the realizations of each case and turning point.

use polars::prelude::{DataFrame, IntoColumn, IntoLazy, NamedFrom, PolarsResult, Series, SortMultipleOptions, col};

use super::realizations::identity;
use super::rows::{Rows, Value};
use super::student::Sample;
use super::{CaseInput, Given, StatsError};
use crate::schema::CASES;
use crate::store::Frame;

/// The results that are averaged.
const AVERAGED: [&str; 7] =
    ["pull_off_load", "area_at_max_load", "penetration_at_max_load", "loss", "loss_dk", "loss_dk_realised", "loss_ratio_dk"];
/// The results that only decide on cautions.
const WATCHED: [&str; 4] = ["audit_gap", "touching_share", "covered_share", "tabor_min"];

/// The words of the column `caution`, in the order in which they are joined, each with what it says.
pub const CAUTIONS: [(&str, &str); 8] = [
    ("incomplete", "fewer realizations are in the means than the spec asks for"),
    ("failed", "a realization failed"),
    ("single", "one realization: no spread"),
    ("unconverged", "a step's residual stayed above the tolerance"),
    ("audit", "the loop's work and the sum over its events differ by more than 1 % in a realization"),
    ("touching", "more than a tenth of the contact spots touch another one, on average"),
    ("covered", "more than a tenth of the asperities in contact are covered, on average"),
    ("tabor", "an asperity's Tabor number is below 2, where Wu's jump-in does not hold"),
];

/// Averages each case at each of its turning points; rows are ordered by case and turning point, and a case without any finished
/// realization has its row, without means.
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

/// The realizations of one case and turning point, in their order.
#[derive(Debug, Clone, Default)]
struct Group {
    case_id: String,
    max_load: f64,
    unconverged: Vec<f64>,
    averaged: Vec<Vec<f64>>,
    watched: Vec<Vec<f64>>,
}

fn averages(group: &Group, case: &CaseInput, max_load: f64) -> Given {
    let mut row: Given = vec![("max_load".to_owned(), max_load.into())];
    for (at, name) in AVERAGED.iter().enumerate() {
        let sample = Sample::of(group.averaged.get(at).map_or(&[], Vec::as_slice));
        let end = |sign: f64| sample.mean.zip(sample.ci95).map(|(mean, half)| mean + sign * half);
        let columns = [("mean", sample.mean), ("sd", sample.sd), ("ci95_low", end(-1.0)), ("ci95_high", end(1.0))];
        row.extend(columns.into_iter().map(|(what, value)| (format!("{name}_{what}"), Value::from(value))));
    }
    let done = group.unconverged.len();
    row.push(("planned_count".to_owned(), case.planned_count.into()));
    row.push(("done_count".to_owned(), done.into()));
    row.push(("failed_count".to_owned(), case.failed_count.into()));
    row.push(("caution".to_owned(), caution(group, case, done).as_str().into()));
    row
}

fn caution(group: &Group, case: &CaseInput, done: usize) -> String {
    let watched =
        |name: &str| WATCHED.iter().position(|known| *known == name).and_then(|at| group.watched.get(at)).map_or(&[][..], Vec::as_slice);
    let mean_above = |name: &str, limit: f64| Sample::of(watched(name)).mean.is_some_and(|mean| mean > limit);
    let wu = case.parameters.iter().any(|(name, value)| name == "jump_in" && *value == Value::from("wu"));
    let holds = |word: &str| match word {
        "incomplete" => done < case.planned_count,
        "failed" => case.failed_count > 0,
        "single" => done == 1,
        "unconverged" => group.unconverged.iter().any(|count| *count > 0.0),
        "audit" => watched("audit_gap").iter().any(|gap| *gap > 0.01),
        "touching" => mean_above("touching_share", 0.1),
        "covered" => mean_above("covered_share", 0.1),
        "tabor" => wu && watched("tabor_min").iter().any(|least| *least < 2.0),
        _ => false,
    };
    let words: Vec<&str> = CAUTIONS.iter().map(|(word, _)| *word).filter(|word| holds(word)).collect();
    words.join("+")
}

fn groups(realizations: &Frame) -> Result<Vec<Group>, StatsError> {
    let mut columns = vec![
        Series::new("case_id".into(), realizations.text("case_id")?).into_column(),
        Series::new("max_load".into(), realizations.f64("max_load")?).into_column(),
        Series::new("realization".into(), realizations.i64("realization")?).into_column(),
        Series::new("unconverged_count".into(), realizations.i64("unconverged_count")?).into_column(),
    ];
    for name in AVERAGED.iter().chain(&WATCHED) {
        columns.push(Series::new((*name).into(), realizations.f64_or_null(name)?).into_column());
    }
    let grouped = DataFrame::new_infer_height(columns).and_then(group);
    grouped.map_err(|source| StatsError::Group { table: realizations.table().name, source })
}

fn group(frame: DataFrame) -> PolarsResult<Vec<Group>> {
    let keys = [col("case_id"), col("max_load")];
    let lists: Vec<_> = ["unconverged_count"].iter().chain(&AVERAGED).chain(&WATCHED).map(|name| col(*name)).collect();
    let order = SortMultipleOptions::default().with_maintain_order(true);
    let grouped = frame.lazy().sort(["case_id", "max_load", "realization"], order).group_by_stable(keys).agg(lists).collect()?;
    let words = grouped.column("case_id")?.str()?;
    let loads = grouped.column("max_load")?.f64()?;
    let list = |name: &str, row: usize| -> PolarsResult<Vec<f64>> {
        let series = grouped.column(name)?.list()?.get_as_series(row).unwrap_or_default();
        Ok(series.cast(&polars::prelude::DataType::Float64)?.f64()?.iter().flatten().collect())
    };
    let lists = |names: &[&str], row: usize| names.iter().map(|name| list(name, row)).collect::<PolarsResult<Vec<_>>>();
    words
        .iter()
        .zip(loads.iter())
        .enumerate()
        .map(|(row, (word, load))| {
            Ok(Group {
                case_id: word.unwrap_or_default().to_owned(),
                max_load: load.unwrap_or_default(),
                unconverged: list("unconverged_count", row)?,
                averaged: lists(&AVERAGED, row)?,
                watched: lists(&WATCHED, row)?,
            })
        })
        .collect()
}
