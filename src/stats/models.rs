//! Works of adhesion that follow from the columns of the table `cases`.

use super::{MOST_LEFT_OUT, StatsError};
use crate::store::Frame;

/// Persson and Tosatti's work of adhesion `Δγ - U_el` of each row \[J/m²\], with the realized spectrum and
/// without the area that roughness adds; nothing for `U_el ≥ Δγ`.
pub(super) fn persson_tosatti(cases: &Frame) -> Result<Vec<Option<f64>>, StatsError> {
    let (adhesion, ratios) =
        (cases.f64("work_of_adhesion_j_m2")?, cases.f64_or_null("persson_tosatti_realised_mean")?);
    let left_out = cases.f64_or_null("left_out_ratio")?;
    let of = |(row, adhesion): (usize, &f64)| {
        // A small energy of roughness below the grid is a part of the work of adhesion of the cycle.
        let folded = left_out[row].filter(|ratio| *ratio <= MOST_LEFT_OUT).unwrap_or_default();
        let ratio = ratios[row].filter(|ratio| *ratio < 1.0)?;
        Some(adhesion * (1.0 - folded) * (1.0 - ratio))
    };
    Ok(adhesion.iter().enumerate().map(of).collect())
}
