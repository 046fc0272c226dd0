//! Works of adhesion of models, from the table `cutoff`.

use super::StatsError;
use crate::store::Frame;

/// Persson and Tosatti's work of adhesion `Δγ (1 + h'²/2) - U_el` \[J/m²\] of each row of the table `cases`.
///
/// It is that of all roughness: of the shortest cut-off in the table `cutoff`. Nothing for `U_el ≥ Δγ`, and
/// for a case that this table does not have.
pub(super) fn persson_tosatti(cases: &Frame, cutoff: &Frame) -> Result<Vec<Option<f64>>, StatsError> {
    let (ids, works) = (cutoff.text("case_id")?, cutoff.f64_or_null("work_persson_tosatti_j_m2")?);
    let of = |id: &&str| ids.iter().rposition(|other| other == id).and_then(|row| works[row]);
    Ok(cases.text("case_id")?.iter().map(of).collect())
}
