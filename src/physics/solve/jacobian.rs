//! Jacobian of the global problem.

use crate::physics::half_space::Tangent;
use crate::physics::math::gmres::LinearOperator;

/// Jacobian `∂(δ_JKR + ŵ)/∂a`: the slopes `dδ/da` of the asperities and the tangent of the field.
pub(super) struct Jacobian<'a> {
    pub(super) tangent: &'a Tangent,
    pub(super) diagonal: &'a [f64],
}

impl LinearOperator for Jacobian<'_> {
    fn product(&self, x: &[f64], y: &mut [f64]) {
        self.tangent.product(x, y);
        for (yi, (di, xi)) in y.iter_mut().zip(self.diagonal.iter().zip(x)) {
            *yi += di * xi;
        }
    }

    fn diagonal(&self, i: usize) -> f64 {
        self.diagonal[i] + self.tangent.own(i)
    }
}
