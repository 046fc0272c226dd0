//! Comparison of campaigns: matching cases, and the differences of their results.

use super::StatsError;
use super::student::{Sample, t_quantile};
use crate::schema::{COMPARISON, Kind, parameters_by_rank};
use crate::store::{ColumnData, Frame};

/// Compared quantities: columns of the table `realizations`.
const QUANTITIES: [&str; 5] =
    ["area_at_max_load", "penetration_at_max_load", "pull_off_load", "loss", "loss_ratio_dk"];

/// One campaign that is compared.
#[derive(Debug, Clone)]
pub struct Side {
    /// Label.
    pub label: String,
    /// Its tables.
    pub cases: Frame,
    /// Every realization.
    pub realizations: Frame,
    /// Its averaged paths.
    pub curves: Frame,
}

/// Matching cases of several campaigns, which differ only in the parameters that distinguish the campaigns:
/// the row of each in its table `cases`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Group {
    /// By campaign.
    pub rows: Vec<usize>,
}

/// Cases that campaigns have in common.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Matched {
    /// Parameters that distinguish the campaigns, by the columns of the table `cases`.
    pub differing: Vec<&'static str>,
    /// Cases that all of them have.
    pub groups: Vec<Group>,
    /// Number of rows of each without a counterpart.
    pub left_over: Vec<usize>,
}

/// The value of a cell as a text, equal for equal values.
pub(super) fn written(frame: &Frame, column: &str, row: usize) -> Result<String, StatsError> {
    Ok(match frame.column(column)? {
        ColumnData::F64(values) => format!("{:?}", values.get(row).copied().flatten()),
        ColumnData::I64(values) => format!("{:?}", values.get(row).copied().flatten()),
        ColumnData::Bool(values) => format!("{:?}", values.get(row).copied().flatten()),
        ColumnData::Text(values) => values.get(row).cloned().flatten().unwrap_or_default(),
    })
}

/// Columns of the parameters, in the order of labels.
pub(super) fn names() -> impl Iterator<Item = &'static str> {
    parameters_by_rank().into_iter().map(|parameter| parameter.column.name)
}

/// Finds the cases that all campaigns have. Campaigns are distinguished by the parameters whose values in one
/// of them differ from those in the first. All other parameters, and the load, must be the same.
///
/// # Errors
/// If a table lacks a column; if two cases of one campaign differ only in parameters that distinguish the
/// campaigns.
pub fn matched(sides: &[Side]) -> Result<Matched, StatsError> {
    let values = |side: &Side, parameter: &str| -> Result<Vec<String>, StatsError> {
        let mut all: Vec<String> = (0..side.cases.row_count())
            .map(|row| written(&side.cases, parameter, row))
            .collect::<Result<_, _>>()?;
        all.sort_unstable();
        all.dedup();
        Ok(all)
    };
    let mut differing = Vec::new();
    for parameter in names() {
        let all: Vec<Vec<String>> =
            sides.iter().map(|side| values(side, parameter)).collect::<Result<_, _>>()?;
        if all.windows(2).any(|pair| pair.first() != pair.last()) {
            differing.push(parameter);
        }
    }
    let keys: Vec<Vec<String>> = sides
        .iter()
        .map(|side| {
            let columns = || names().filter(|name| !differing.contains(name)).chain(["max_load"]);
            let key = |row: usize| {
                columns().map(|column| written(&side.cases, column, row)).collect::<Result<Vec<_>, _>>()
            };
            (0..side.cases.row_count()).map(|row| key(row).map(|parts| parts.join("\n"))).collect()
        })
        .collect::<Result<_, StatsError>>()?;
    for (side, keys) in sides.iter().zip(&keys) {
        if let Some((row, _)) = keys.iter().enumerate().find(|(row, key)| keys[..*row].contains(key)) {
            let case_id = side.cases.text("case_id")?.get(row).copied().unwrap_or_default().to_owned();
            return Err(StatsError::Ambiguous {
                label: side.label.clone(),
                case_id,
                differing: differing.join(", "),
            });
        }
    }
    let places = |key: &String| {
        keys.iter().map(|keys| keys.iter().position(|other| other == key)).collect::<Option<Vec<usize>>>()
    };
    let mut groups: Vec<Group> =
        keys.first().into_iter().flatten().filter_map(places).map(|rows| Group { rows }).collect();
    if let Some(first) = sides.first() {
        let ranks = names().chain(["max_load"]).map(|name| ranks(&first.cases, name));
        let ranks: Vec<Vec<usize>> = ranks.collect::<Result<_, _>>()?;
        groups.sort_by_cached_key(|group| {
            ranks.iter().map(|ranks| ranks[group.rows[0]]).collect::<Vec<usize>>()
        });
    }
    let left_over = keys.iter().map(|keys| keys.len() - groups.len()).collect();
    Ok(Matched { differing, groups, left_over })
}

/// Rank of each row by the value of a column, ascending; equal values have equal ranks.
fn ranks(frame: &Frame, column: &str) -> Result<Vec<usize>, StatsError> {
    fn ranked<T>(values: &[T], before: impl Fn(&T, &T) -> bool) -> Vec<usize> {
        values.iter().map(|value| values.iter().filter(|other| before(other, value)).count()).collect()
    }
    Ok(match frame.column(column)? {
        ColumnData::F64(values) => ranked(values, |a, b| a < b),
        ColumnData::I64(values) => ranked(values, |a, b| a < b),
        ColumnData::Bool(values) => ranked(values, |a, b| a < b),
        ColumnData::Text(values) => ranked(values, |a, b| a < b),
    })
}

/// A quantity of a row of the table `cases`, realization by realization, each with its surface.
fn samples(cases: &Frame, all: &Frame, row: usize, quantity: &str) -> Result<Vec<(String, f64)>, StatsError> {
    let of = |column: &str| -> Result<String, StatsError> { written(cases, column, row) };
    let (case, load) = (of("case_id")?, cases.f64_or_null("max_load")?.get(row).copied().flatten());
    let (ids, loads, surfaces) =
        (all.text_or_null("case_id")?, all.f64_or_null("max_load")?, all.text_or_null("surface_id")?);
    let values = all.f64_or_null(quantity)?;
    let of_row = |k: &usize| ids[*k].as_deref() == Some(case.as_str()) && loads[*k] == load;
    let sample = |k: usize| values[k].map(|value| (surfaces[k].clone().unwrap_or_default(), value));
    Ok((0..values.len()).filter(of_row).filter_map(sample).collect())
}

/// The values of a quantity for the single realizations of a row of the table `cases`, in their order.
///
/// # Errors
/// If a table lacks a column.
pub fn singles(
    cases: &Frame,
    realizations: &Frame,
    row: usize,
    quantity: &str,
) -> Result<Vec<f64>, StatsError> {
    Ok(samples(cases, realizations, row, quantity)?.into_iter().map(|(_, value)| value).collect())
}

/// The difference of a quantity between two rows of the table `cases`, the second of which is the reference;
/// nothing if one of them has no realization.
///
/// # Errors
/// If a table lacks a column.
pub fn difference_of(
    cases: &Frame,
    realizations: &Frame,
    [row, reference]: [usize; 2],
    quantity: &str,
) -> Result<Option<Difference>, StatsError> {
    Ok(difference(
        &samples(cases, realizations, row, quantity)?,
        &samples(cases, realizations, reference, quantity)?,
    ))
}

/// The difference of two means.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Difference {
    /// The two means, the second of the reference; of the pairs alone where they are paired.
    pub means: [f64; 2],
    /// The first mean less the second.
    pub of: f64,
    /// Half-width of its 95 % confidence interval; nothing where it takes more realizations.
    pub ci95: Option<f64>,
    /// True if realizations are compared surface by surface.
    pub paired: bool,
    /// Number of realizations of each mean.
    pub counts: [usize; 2],
}

/// Of two samples, the second of which is the reference; surface by surface, where all surfaces of one are
/// surfaces of the other.
fn difference(mine: &[(String, f64)], other: &[(String, f64)]) -> Option<Difference> {
    let pairs: Vec<(f64, f64)> = mine
        .iter()
        .filter_map(|(surface, a)| other.iter().find(|(known, _)| known == surface).map(|(_, b)| (*a, *b)))
        .collect();
    let paired = !pairs.is_empty() && pairs.len() == mine.len().min(other.len());
    let (a, b): (Vec<f64>, Vec<f64>) = if paired {
        pairs.into_iter().unzip()
    } else {
        (mine.iter().map(|s| s.1).collect(), other.iter().map(|s| s.1).collect())
    };
    let (first, second) = (Sample::of(&a), Sample::of(&b));
    let means = [first.mean?, second.mean?];
    let ci95 = if paired {
        Sample::of(&a.iter().zip(&b).map(|(a, b)| a - b).collect::<Vec<f64>>()).ci95
    } else {
        welch(&first, &second)
    };
    Some(Difference { means, of: means[0] - means[1], ci95, paired, counts: [a.len(), b.len()] })
}

/// Half the 95 % interval of the difference of two independent means (Welch, Biometrika 34:28, 1947), its
/// degrees of freedom rounded down.
fn welch(first: &Sample, second: &Sample) -> Option<f64> {
    let part = |sample: &Sample| sample.sd.map(|sd| sd * sd / sample.count as f64);
    let (a, b) = (part(first)?, part(second)?);
    if a + b == 0.0 {
        return Some(0.0);
    }
    let freedom = (a + b).powi(2) / (a * a / (first.count - 1) as f64 + b * b / (second.count - 1) as f64);
    t_quantile(0.975, freedom.floor().max(1.0) as usize).map(|t| t * (a + b).sqrt())
}

/// The table of differences from the first campaign.
///
/// # Errors
/// If a table lacks a column.
pub fn comparison(sides: &[Side], matched: &Matched) -> Result<Frame, StatsError> {
    let Some((reference, others)) = sides.split_first() else { return Ok(Frame::of(&COMPARISON).build()?) };
    let mut rows = Vec::new();
    for (number, group) in matched.groups.iter().enumerate() {
        for (side, row) in others.iter().zip(&group.rows[1..]) {
            let base = group.rows[0];
            let ids = [written(&side.cases, "case_id", *row)?, written(&reference.cases, "case_id", base)?];
            let load = side.cases.f64("max_load")?[*row];
            for quantity in QUANTITIES {
                let found = difference(
                    &samples(&side.cases, &side.realizations, *row, quantity)?,
                    &samples(&reference.cases, &reference.realizations, base, quantity)?,
                );
                rows.extend(found.map(|found| (number, side, ids.clone(), load, quantity, found, *row)));
            }
        }
    }
    let each = |value: fn(&Difference) -> f64| rows.iter().map(move |row| value(&row.5));
    let mut builder = Frame::of(&COMPARISON);
    for name in names() {
        // The parameters of the compared case.
        let data = match COMPARISON.column(name).map(|column| column.kind) {
            Some(Kind::F64) => {
                let each = rows.iter().map(|row| Ok(row.1.cases.f64_or_null(name)?[row.6]));
                ColumnData::F64(each.collect::<Result<_, StatsError>>()?)
            }
            _ => {
                let each = rows.iter().map(|row| Ok(row.1.cases.text_or_null(name)?[row.6].clone()));
                ColumnData::Text(each.collect::<Result<_, StatsError>>()?)
            }
        };
        builder = builder.with(name, data);
    }
    Ok(builder
        .i64("group", rows.iter().map(|row| row.0 as i64))
        .text("campaign", rows.iter().map(|row| row.1.label.as_str()))
        .text("case_id", rows.iter().map(|row| row.2[0].as_str()))
        .text("reference", rows.iter().map(|_| reference.label.as_str()))
        .text("reference_case_id", rows.iter().map(|row| row.2[1].as_str()))
        .f64("max_load", rows.iter().map(|row| row.3))
        .text("quantity", rows.iter().map(|row| row.4))
        .f64("mean", each(|d| d.means[0]))
        .f64("reference_mean", each(|d| d.means[1]))
        .f64("difference", each(|d| d.of))
        .f64("difference_ci95", rows.iter().map(|row| row.5.ci95))
        .f64(
            "relative_difference",
            rows.iter().map(|row| Some(row.5.of / row.5.means[1].abs()).filter(|share| share.is_finite())),
        )
        .bool("paired", rows.iter().map(|row| row.5.paired))
        .count("realization_count", rows.iter().map(|row| row.5.counts[0]))
        .count("reference_realization_count", rows.iter().map(|row| row.5.counts[1]))
        .build()?)
}

/// One table of rows of several, whose cases are given other names.
///
/// # Errors
/// If there is no such table.
pub fn together(parts: &[(&Frame, Vec<usize>, String)]) -> Result<Frame, StatsError> {
    fn gathered<T: Clone>(
        parts: &[(&Frame, Vec<usize>, String)],
        of: impl Fn(&Frame) -> Result<Vec<Option<T>>, StatsError>,
    ) -> Result<Vec<Option<T>>, StatsError> {
        let mut all = Vec::new();
        for (frame, rows, _) in parts {
            let values = of(frame)?;
            all.extend(rows.iter().map(|row| values.get(*row).cloned().flatten()));
        }
        Ok(all)
    }
    let Some((first, ..)) = parts.first() else { return Ok(Frame::of(&COMPARISON).build()?) };
    let mut builder = Frame::of(first.table());
    for column in first.table().columns {
        let name = column.name;
        let data = match column.kind {
            Kind::F64 => ColumnData::F64(gathered(parts, |frame| Ok(frame.f64_or_null(name)?.to_vec()))?),
            Kind::I64 => ColumnData::I64(gathered(parts, |frame| Ok(frame.i64_or_null(name)?.to_vec()))?),
            Kind::Bool => ColumnData::Bool(gathered(parts, |frame| Ok(frame.bool_or_null(name)?.to_vec()))?),
            Kind::Text if name == "case_id" => ColumnData::Text(
                parts.iter().flat_map(|(_, rows, id)| rows.iter().map(|_| Some(id.clone()))).collect(),
            ),
            Kind::Text => ColumnData::Text(gathered(parts, |frame| Ok(frame.text_or_null(name)?.to_vec()))?),
        };
        builder = builder.with(name, data);
    }
    Ok(builder.build()?)
}
