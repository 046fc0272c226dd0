//! Linear predictor of the penetration of one asperity.

use crate::jkr::Asperity;

/// Penetration `D − ŵ` \[m\] at one mean penetration, with its rate along the path. For a free asperity it decides on the jump-in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PenetrationTrace {
    /// Mean penetration \[m\].
    pub(crate) at: f64,
    /// Penetration there \[m\].
    pub(crate) value: f64,
    /// Derivative to the mean penetration.
    pub(crate) rate: f64,
}

/// Largest rate that is extrapolated. Without a fold nearby it is below 1.2; at a fold it is infinite, over a short way.
pub(crate) const MAX_RATE: f64 = 4.0;

/// Lower bound of |dδ/da|, against division by zero at the end of the branch.
const LEAST_SLOPE: f64 = 1e-6;

impl PenetrationTrace {
    /// Unknown penetration.
    pub(crate) fn unknown(at: f64) -> Self {
        Self { at, value: f64::NAN, rate: 0.0 }
    }

    /// Of a contact of radius `a` \[m\] whose radius changes by `speed`.
    pub(crate) fn of(asperity: &Asperity, at: f64, a: f64, speed: f64) -> Self {
        Self { at, value: asperity.penetration(a), rate: asperity.penetration_slope(a) * speed }
    }

    /// `da/dΔ` of a contact of radius `a` \[m\]. At the end of its branch it is infinite; beyond it, where other contacts hold it, it has
    /// the opposite sign.
    pub(crate) fn speed(&self, asperity: &Asperity, a: f64) -> f64 {
        let slope = asperity.penetration_slope(a);
        self.rate / if slope.abs() < LEAST_SLOPE { LEAST_SLOPE.copysign(slope) } else { slope }
    }

    /// Predicted penetration at a mean penetration \[m\].
    pub(crate) fn ahead(&self, approach: f64) -> f64 {
        self.value + self.rate.clamp(-MAX_RATE, MAX_RATE) * (approach - self.at)
    }

    /// Predicted contact radius \[m\].
    pub(crate) fn radius_ahead(&self, asperity: &Asperity, approach: f64) -> f64 {
        asperity.radius_ahead(self.ahead(approach))
    }
}
