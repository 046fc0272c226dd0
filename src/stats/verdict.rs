//! The verdict on a sweep at the end of a run: the regime of its contacts, and which method holds there.

use super::cautions::Limit;
use super::methods::method_pairs;
use super::{StatsError, significant};
use crate::model::{Choice as _, Method};
use crate::store::Frame;

/// Warnings of the range of the asperity model that a verdict stands for.
pub(super) const IN_A_VERDICT: [&str; 6] = ["sticky", "area", "conformed", "covered", "absorption", "touching"];

/// Contacts of a sweep.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Regime {
    /// U_el/Δγ, the area and the shortest octave are within the limits of the asperity model.
    Separate,
    /// The shortest octave is beyond its limit.
    Conformal,
    /// U_el/Δγ or the area is beyond its limit.
    NearFullContact,
}

impl Regime {
    /// The regime of rows of the table `cases`, by the limits of the warnings of the same names.
    fn of(cases: &Frame, rows: &[usize]) -> Result<Self, StatsError> {
        let passed = |code: &str| -> Result<bool, StatsError> {
            let Some(limit) = Limit::of(code) else { return Ok(false) };
            let values = cases.f64_or_null(limit.column)?;
            Ok(rows.iter().any(|row| limit.is_passed(values[*row])))
        };
        Ok(match () {
            () if passed("sticky")? || passed("area")? => Self::NearFullContact,
            () if passed("conformed")? => Self::Conformal,
            () => Self::Separate,
        })
    }

    fn word(self) -> &'static str {
        match self {
            Self::Separate => "separate contacts",
            Self::Conformal => "conformal contact at the shortest wavelengths",
            Self::NearFullContact => "near full contact",
        }
    }
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
        let regime = Regime::of(cases, &elements)?;
        return Ok((!elements.is_empty()).then(|| format!("Verdict: {}, by boundary elements, which hold there.", regime.word())));
    }
    let regime = Regime::of(cases, &asperities)?;
    let share = share(cases, methods, &asperities)?.map(|share| format!("the asperity model has {share} of the area"));
    let advice = match (regime, elements.is_empty()) {
        (Regime::Separate, _) => "within the range of the asperity model",
        (_, true) => "use method = \"boundary_elements\"",
        (_, false) => "trust the rows by boundary elements",
    };
    let parts: Vec<String> = match regime {
        Regime::Separate => std::iter::once(advice.to_owned()).chain(share).collect(),
        _ => share.into_iter().chain([advice.to_owned()]).collect(),
    };
    Ok(Some(format!("Verdict: {}: {}.", regime.word(), parts.join("; "))))
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
