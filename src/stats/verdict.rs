//! The verdict on a sweep at the end of a run: the regime of its contacts, and which method holds there.

use super::methods::{MethodPair, method_pairs};
use super::{StatsError, significant};
use crate::model::{Choice as _, Method, Regime};
use crate::store::Frame;

/// Warnings of the range of the asperity model that are part of a verdict.
pub(super) const IN_A_VERDICT: [&str; 6] =
    ["sticky", "area", "conformed", "covered", "absorption", "touching"];

/// The regime of rows of the table `cases`: that of the smallest ratios of their surfaces, and near full
/// contact beyond the limit of the area.
fn regime(cases: &Frame, rows: &[usize]) -> Result<Regime, StatsError> {
    let values = |column: &str| -> Result<Vec<f64>, StatsError> {
        let values = cases.f64_or_null(column)?;
        Ok(rows.iter().filter_map(|row| values[*row]).collect())
    };
    let least = |column: &str| -> Result<f64, StatsError> {
        Ok(values(column)?.into_iter().fold(f64::INFINITY, f64::min))
    };
    let regime = Regime::of(least("persson_tosatti_realised_mean")?, least("conformity_realised_mean")?);
    Ok(regime.with_area(values("area_at_max_load_mean")?.into_iter().fold(0.0, f64::max)))
}

/// The verdicts on the rows of a sweep of the table `cases`, one sentence for each regime; nothing without a
/// finished row.
///
/// The part of the area that the asperity model has is measured where both methods have the same surfaces,
/// and expected otherwise.
///
/// # Errors
/// If a table lacks a column.
pub(super) fn verdicts(
    cases: &Frame,
    methods: Option<&Frame>,
    rows: &[usize],
) -> Result<Vec<String>, StatsError> {
    let areas = cases.f64_or_null("area_at_max_load_mean")?;
    let finished: Vec<usize> = rows.iter().copied().filter(|row| areas[*row].is_some()).collect();
    let pairs = methods.map(method_pairs).transpose()?.unwrap_or_default();
    let ids = cases.text("case_id")?;
    let mut regimes = Vec::with_capacity(finished.len());
    for row in &finished {
        // Both methods of a case have one regime.
        let paired = pairs.iter().find(|pair| pair.cases.iter().any(|id| *id == ids[*row]));
        let both = |other: &usize| {
            other == row || paired.is_some_and(|pair| pair.cases.iter().any(|id| *id == ids[*other]))
        };
        regimes.push(regime(cases, &finished.iter().copied().filter(both).collect::<Vec<_>>())?);
    }
    let mut sentences = Vec::new();
    for regime in [Regime::Separate, Regime::NearFullContact, Regime::Flattened] {
        let own: Vec<usize> =
            finished.iter().zip(&regimes).filter(|(_, of)| **of == regime).map(|(row, _)| *row).collect();
        let place = if own.len() == finished.len() {
            String::new()
        } else {
            format!(" ({} of {} rows)", own.len(), finished.len())
        };
        if !own.is_empty() {
            sentences.push(format!("{}{place}{}.", regime.name(), advice(cases, &pairs, &own, regime)?));
        }
    }
    Ok(sentences)
}

/// Consequence of a regime for rows, as the end of a sentence.
fn advice(cases: &Frame, pairs: &[MethodPair], rows: &[usize], regime: Regime) -> Result<String, StatsError> {
    let words = cases.text("method")?;
    let of =
        |method: Method| rows.iter().copied().filter(|row| words[*row] == method.word()).collect::<Vec<_>>();
    let (asperities, elements) = (of(Method::Asperities), of(Method::BoundaryElements));
    if asperities.is_empty() {
        return Ok(", by boundary elements, which hold there".to_owned());
    }
    let share = share(cases, pairs, &asperities)?;
    Ok(if regime == Regime::Separate {
        let share = share.map_or_else(String::new, |share| format!(", which has {share} of the area"));
        format!(": within the range of the asperity model{share}")
    } else {
        let advice = if elements.is_empty() {
            "use method = \"boundary_elements\""
        } else {
            "trust the rows by boundary elements"
        };
        share.map_or_else(
            || format!(": {advice}"),
            |share| format!(": the asperity model has {share} of the area; {advice}"),
        )
    })
}

/// The part of the area of boundary elements that the asperity model has in rows, as an interval.
fn share(cases: &Frame, pairs: &[MethodPair], rows: &[usize]) -> Result<Option<String>, StatsError> {
    let ids = cases.text("case_id")?;
    let own = pairs.iter().filter(|pair| rows.iter().any(|row| ids[*row] == pair.cases[0]));
    let measured: Vec<f64> = own.filter_map(|pair| pair.quantities[0][2]).collect();
    let expected = cases.f64_or_null("area_model_ratio")?;
    let values =
        if measured.is_empty() { rows.iter().filter_map(|row| expected[*row]).collect() } else { measured };
    let (low, high) = values
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(*value), high.max(*value)));
    let (from, to) = (significant(low, 2), significant(high, 2));
    Ok((low <= high).then(|| if from == to { from } else { format!("{from} to {to}") }))
}
