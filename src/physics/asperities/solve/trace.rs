//! Linear predictor of the penetration of one asperity.

use crate::jkr::Asperity;

/// Penetration `D − ŵ` \[m\] at one mean penetration, with its rate along the path. For a free asperity it
/// decides on the jump-in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PenetrationTrace {
    /// Mean penetration \[m\].
    pub(crate) at: f64,
    /// Penetration there \[m\]; not a number if unknown, so that a trace is three numbers long. Read by
    /// [`Self::penetration`].
    value: f64,
    /// Derivative to the mean penetration.
    pub(crate) rate: f64,
}

/// Largest rate that is extrapolated. Without a fold nearby it is below 1.2; at a fold it is infinite, over a
/// short way.
const MAX_RATE: f64 = 4.0;

/// Lower bound of |dδ/da|, against division by zero at the end of the branch.
const MIN_SLOPE: f64 = 1e-6;

impl PenetrationTrace {
    /// Penetration \[m\] at a mean penetration \[m\], with its rate.
    pub(crate) fn new(at: f64, penetration: f64, rate: f64) -> Self {
        Self { at, value: penetration, rate }
    }

    /// Unknown penetration.
    pub(crate) fn unknown(at: f64) -> Self {
        Self { at, value: f64::NAN, rate: 0.0 }
    }

    /// Of a contact of radius `a` \[m\] whose radius changes by `speed`.
    pub(crate) fn of(asperity: &Asperity, at: f64, a: f64, speed: f64) -> Self {
        Self { at, value: asperity.penetration(a), rate: asperity.penetration_slope(a) * speed }
    }

    /// `da/dΔ` of a contact of radius `a` \[m\]. At the end of its branch it is infinite; beyond it, where
    /// other contacts hold it, it has the opposite sign.
    pub(crate) fn speed(&self, asperity: &Asperity, a: f64) -> f64 {
        let slope = asperity.penetration_slope(a);
        self.rate / if slope.abs() < MIN_SLOPE { MIN_SLOPE.copysign(slope) } else { slope }
    }

    /// [`Self::speed`] with a bounded rate.
    pub(crate) fn bounded_speed(&self, asperity: &Asperity, a: f64) -> f64 {
        Self { rate: self.rate.clamp(-MAX_RATE, MAX_RATE), ..*self }.speed(asperity, a)
    }

    /// Penetration \[m\], if it is known.
    pub(crate) fn penetration(&self) -> Option<f64> {
        self.is_known().then_some(self.value)
    }

    /// Penetration \[m\], for integrals and comparisons that an unknown one makes not a number and false.
    pub(crate) fn penetration_or_nan(&self) -> f64 {
        self.value
    }

    /// True if the penetration is known.
    pub(crate) fn is_known(&self) -> bool {
        !self.value.is_nan()
    }

    /// Marks the penetration as unknown; mean penetration and rate remain.
    pub(crate) fn forget(&mut self) {
        self.value = f64::NAN;
    }

    /// Changes a known penetration by that of the displacement \[m\].
    pub(crate) fn displace(&mut self, change: f64) {
        self.value -= change;
    }

    /// True if the penetration is known and larger than a limit \[m\].
    pub(crate) fn exceeds(&self, limit: f64) -> bool {
        self.value > limit
    }

    /// True if the penetration is known and at least `value` \[m\].
    pub(crate) fn has_reached(&self, value: f64) -> bool {
        self.value >= value
    }

    /// The trace moved to another mean penetration \[m\], with its rate.
    pub(crate) fn moved_to(&self, mean_penetration: f64) -> Self {
        Self { at: mean_penetration, value: self.ahead(mean_penetration), ..*self }
    }

    /// Predicted penetration at a mean penetration \[m\]: not a number if it is unknown.
    pub(crate) fn ahead(&self, mean_penetration: f64) -> f64 {
        self.value + self.rate.clamp(-MAX_RATE, MAX_RATE) * (mean_penetration - self.at)
    }

    /// Predicted contact radius \[m\].
    pub(crate) fn radius_ahead(&self, asperity: &Asperity, mean_penetration: f64) -> f64 {
        asperity.radius_ahead(self.ahead(mean_penetration))
    }
}
