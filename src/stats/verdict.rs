//! The verdict on a sweep at the end of a run: the regime of its contacts, and which method holds there.

use super::cautions::Limit;
use super::methods::method_pairs;
use super::{StatsError, significant};
use crate::model::{Choice as _, Method};
use crate::physics::theory::regime::Regime;
use crate::store::Frame;

/// Warnings of the range of the asperity model that a verdict stands for.
pub(super) const IN_A_VERDICT: [&str; 6] = ["sticky", "area", "conformed", "covered", "absorption", "touching"];

/// The regime of rows of the table `cases`: that of the smallest ratios of their surfaces, and near full contact beyond the limit of the area.
fn regime(cases: &Frame, rows: &[usize]) -> Result<Regime, StatsError> {
    let values = |column: &str| -> Result<Vec<f64>, StatsError> {
        let values = cases.f64_or_null(column)?;
        Ok(rows.iter().filter_map(|row| values[*row]).collect())
    };
    let least = |column: &str| -> Result<f64, StatsError> { Ok(values(column)?.into_iter().fold(f64::INFINITY, f64::min)) };
    let regime = Regime::of(least("persson_tosatti_realised_mean")?, least("conformity_realised_mean")?);
    let is_large = Limit::of("area")
        .is_some_and(|limit| values(limit.column).is_ok_and(|areas| areas.into_iter().any(|area| limit.is_passed(Some(area)))));
    Ok(if is_large { regime.min(Regime::NearFullContact) } else { regime })
}

/// The verdict on the rows of a sweep of the table `cases`, as one sentence; nothing without a finished row.
///
/// The part of the area that the asperity model has is measured where both methods have the same surfaces, and expected otherwise.
///
/// # Errors
/// If a table lacks a column.
pub(super) fn verdict(cases: &Frame, methods: Option<&Frame>, rows: &[usize]) -> Result<Option<String>, StatsError> {
    let (words, areas) = (cases.text("method")?, cases.f64_or_null("area_at_max_load_mean")?);
    let of = |method: Method| rows.iter().copied().filter(|row| words[*row] == method.word() && areas[*row].is_some()).collect::<Vec<_>>();
    let (asperities, elements) = (of(Method::Asperities), of(Method::BoundaryElements));
    if asperities.is_empty() {
        let regime = regime(cases, &elements)?;
        return Ok((!elements.is_empty()).then(|| format!("Verdict: {}, by boundary elements, which hold there.", regime.name())));
    }
    let regime = regime(cases, &asperities)?;
    let share = share(cases, methods, &asperities)?;
    let text = match (regime, elements.is_empty()) {
        (Regime::Separate, _) => {
            let share = share.map_or_else(String::new, |share| format!(", which has {share} of the area"));
            format!("within the range of the asperity model{share}")
        }
        (_, has_none) => {
            let advice = if has_none { "use method = \"boundary_elements\"" } else { "trust the rows by boundary elements" };
            share.map_or_else(|| advice.to_owned(), |share| format!("the asperity model has {share} of the area; {advice}"))
        }
    };
    Ok(Some(format!("Verdict: {}: {text}.", regime.name())))
}

/// The part of the area of boundary elements that the asperity model has in rows, as an interval.
fn share(cases: &Frame, methods: Option<&Frame>, rows: &[usize]) -> Result<Option<String>, StatsError> {
    let ids = cases.text("case_id")?;
    let pairs = methods.map(method_pairs).transpose()?.unwrap_or_default();
    let own = pairs.iter().filter(|pair| rows.iter().any(|row| ids[*row] == pair.cases[0]));
    let measured: Vec<f64> = own.filter_map(|pair| pair.quantities[0][2]).collect();
    let expected = cases.f64_or_null("area_model_ratio")?;
    let values = if measured.is_empty() { rows.iter().filter_map(|row| expected[*row]).collect() } else { measured };
    let (low, high) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(*value), high.max(*value)));
    let (from, to) = (significant(low, 2), significant(high, 2));
    Ok((low <= high).then(|| if from == to { from } else { format!("{from} to {to}") }))
}
