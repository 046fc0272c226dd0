//! One row per planned cycle of every case.

use super::realizations::identity;
use super::rows::{Rows, Value};
use super::{CaseInput, Given, StatsError};
use crate::schema::CYCLES;
use crate::store::Frame;
use std::collections::HashMap;

/// A cycle of a case, finished or not.
#[derive(Debug, Clone, PartialEq)]
pub struct Planned {
    /// Its case.
    pub case_id: String,
    /// Number of the surface.
    pub realization: i64,
    /// Identity of the cycle.
    pub cycle_id: String,
    /// Identity of the surface.
    pub surface_id: String,
    /// `done`, `failed` or `planned`.
    pub status: &'static str,
    /// Error message of a failed cycle.
    pub failure: Option<String>,
    /// Parameters of this realization that replace those in its case: the file of one of several scans.
    pub own: Given,
}

/// Joins planned cycles to the parameters of their cases; rows are ordered by case and realization, whatever
/// the order of the inputs.
///
/// # Errors
/// If a cycle names an unknown case, or a required parameter of a case was not given.
pub fn planned(cases: &[CaseInput], cycles: &[Planned]) -> Result<Frame, StatsError> {
    let by_id: HashMap<&str, &CaseInput> = cases.iter().map(|case| (case.case_id.as_str(), case)).collect();
    let mut ordered: Vec<&Planned> = cycles.iter().collect();
    ordered.sort_by(|a, b| a.case_id.cmp(&b.case_id).then(a.realization.cmp(&b.realization)));
    let mut rows = Rows::of(&CYCLES);
    for cycle in ordered {
        let unknown =
            || StatsError::UnknownCase { case_id: cycle.case_id.clone(), realization: cycle.realization };
        let case = *by_id.get(cycle.case_id.as_str()).ok_or_else(unknown)?;
        let columns: [(&str, Value); 6] = [
            ("realization", cycle.realization.into()),
            ("cycle_id", cycle.cycle_id.as_str().into()),
            ("surface_id", cycle.surface_id.as_str().into()),
            ("asperities_id", cycle.surface_id.as_str().into()),
            ("status", cycle.status.into()),
            ("failure", cycle.failure.as_deref().into()),
        ];
        let row: Given = columns.into_iter().map(|(name, value)| (name.to_owned(), value)).collect();
        rows.push(&[&identity(case), &row, &cycle.own, &case.parameters]);
    }
    rows.build()
}
