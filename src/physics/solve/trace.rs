//! Linear predictor of the penetration of one asperity.

use crate::physics::jkr::Asperity;

/// A penetration `D − ŵ` \[m\] known at one approach, with its rate along the path: of a spot in contact its own, of a free asperity the
/// one that decides on its jump-in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PenetrationTrace {
    /// Approach at which it is known \[m\].
    pub(crate) at: f64,
    /// Penetration there \[m\].
    pub(crate) value: f64,
    /// Derivative to the approach.
    pub(crate) rate: f64,
}

/// Greatest rate at which a penetration goes on. Without a fold near it is below 1.2; at a fold it is infinite, but the way to it is short.
pub(crate) const STEEPEST: f64 = 4.0;

/// Least derivative of a penetration to a radius that is told from none.
const LEAST_SLOPE: f64 = 1e-6;

impl PenetrationTrace {
    /// Nothing is known but the approach.
    pub(crate) fn unknown(at: f64) -> Self {
        Self { at, value: f64::NAN, rate: 0.0 }
    }

    /// Of a spot of radius `a` \[m\] at an approach, whose radius changes by `speed`.
    pub(crate) fn of(asperity: &Asperity, at: f64, a: f64, speed: f64) -> Self {
        Self { at, value: asperity.penetration(a), rate: asperity.penetration_slope(a) * speed }
    }

    /// `da/dδ` of a spot of radius `a` \[m\]. At the very end of its branch the radius has no finite rate, and beyond it, where others hold the spot, it
    /// goes against the penetration.
    pub(crate) fn speed(&self, asperity: &Asperity, a: f64) -> f64 {
        let slope = asperity.penetration_slope(a);
        self.rate / if slope.abs() < LEAST_SLOPE { LEAST_SLOPE.copysign(slope) } else { slope }
    }

    /// The penetration expected at another approach \[m\].
    pub(crate) fn ahead(&self, approach: f64) -> f64 {
        self.value + self.rate.clamp(-STEEPEST, STEEPEST) * (approach - self.at)
    }

    /// The radius expected there \[m\].
    pub(crate) fn radius_ahead(&self, asperity: &Asperity, approach: f64) -> f64 {
        asperity.radius_ahead(self.ahead(approach))
    }
}
