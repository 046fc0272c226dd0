//! Least squares with a few parameters, and the effect of correlated residuals on their errors.

use crate::math::dense::Lu;

/// Largest factor by which correlation increases a variance. Residuals that need more do not scatter about
/// the model.
const MOST_INFLATION: f64 = 50.0;

/// Standard errors `1/√n` of a correlation that are added to it: one that is too small makes errors too
/// small.
const MARGIN: f64 = 2.0;

/// Entries of the inverse of a normal matrix with unit diagonal from which on the parameters are not
/// determined.
const SINGULAR: f64 = 1e13;

/// Solution of linear normal equations.
pub(super) struct Normal {
    /// Parameters.
    pub(super) values: Vec<f64>,
    /// Inverse of the normal matrix, row by row: covariance for a variance of 1.
    pub(super) inverse: Vec<f64>,
}

/// Solves `min Σ (y − g·x)²` for rows of gradients `g` and values `y`; nothing if they do not determine
/// the parameters. `damping` is added to the diagonal, relative to it.
pub(super) fn solve(rows: &[(Vec<f64>, f64)], damping: f64) -> Option<Normal> {
    let size = rows.first()?.0.len();
    let (mut matrix, mut right) = (vec![0.0; size * size], vec![0.0; size]);
    for (gradient, value) in rows {
        for (i, u) in gradient.iter().enumerate() {
            right[i] += u * value;
            for (j, v) in gradient.iter().enumerate() {
                matrix[i * size + j] += u * v;
            }
        }
    }
    // Parameters in units of their own columns: the matrix has ones on its diagonal.
    let scale: Vec<f64> = (0..size).map(|i| matrix[i * size + i].sqrt()).collect();
    if scale.iter().any(|scale| !(*scale > 0.0 && scale.is_finite())) {
        return None;
    }
    for i in 0..size {
        right[i] /= scale[i];
        for j in 0..size {
            matrix[i * size + j] /= scale[i] * scale[j];
        }
        matrix[i * size + i] += damping;
    }
    let mut lu = Lu::default();
    lu.factor(&matrix, size);
    let mut inverse = vec![0.0; size * size];
    for j in 0..size {
        let mut column = vec![0.0; size];
        column[j] = 1.0;
        lu.solve(&mut column);
        if !column.iter().all(|value| value.abs() < SINGULAR) {
            return None;
        }
        for i in 0..size {
            inverse[i * size + j] = column[i] / (scale[i] * scale[j]);
        }
    }
    lu.solve(&mut right);
    let values: Vec<f64> = right.iter().zip(&scale).map(|(value, scale)| value / scale).collect();
    let is_finite = values.iter().chain(&inverse).all(|value| value.is_finite());
    is_finite.then_some(Normal { values, inverse })
}

/// `gᵀ C g` of a covariance.
pub(super) fn variance_along(inverse: &[f64], gradient: &[f64]) -> f64 {
    let size = gradient.len();
    let product = |i: usize| (0..size).map(|j| inverse[i * size + j] * gradient[j]).sum::<f64>();
    (0..size).map(|i| gradient[i] * product(i)).sum::<f64>().max(0.0)
}

/// Residuals of a fit.
#[derive(Debug, Clone, Copy)]
pub(super) struct Residuals {
    /// Root mean square.
    pub(super) rms: f64,
    /// Variance of one value, with the degrees of freedom of the fit.
    pub(super) variance: f64,
    /// Factor of the variance of a mean for residuals with the correlation of neighbours,
    /// `(1 + r)/(1 − r) ≥ 1`.
    pub(super) inflation: f64,
    /// Independent residuals less parameters, at least 1.
    pub(super) degrees_of_freedom: usize,
}

impl Residuals {
    /// Of residuals in the order of the path, after a fit with this number of parameters.
    pub(super) fn of(residuals: &[f64], parameters: usize) -> Self {
        let count = residuals.len();
        let squares: f64 = residuals.iter().map(|residual| residual * residual).sum();
        let products: f64 = residuals.windows(2).map(|pair| pair[0] * pair[1]).sum();
        let found = if squares > 0.0 { products / squares } else { 0.0 };
        let correlation = (found + MARGIN / (count.max(1) as f64).sqrt()).clamp(0.0, 1.0);
        let inflation = ((1.0 + correlation) / (1.0 - correlation)).min(MOST_INFLATION);
        let degrees = count.saturating_sub(parameters).max(1);
        Self {
            rms: (squares / count.max(1) as f64).sqrt(),
            variance: squares / degrees as f64,
            inflation,
            degrees_of_freedom: ((count as f64 / inflation) as usize).saturating_sub(parameters).max(1),
        }
    }
}
