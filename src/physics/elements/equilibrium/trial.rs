//! Trials of a step along a direction of descent.

/// Residual at a state.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Residual {
    /// Root mean square of the residual and a bound of its largest magnitude.
    pub(crate) rms: f64,
    pub(crate) largest: f64,
}

/// A direction of descent: its mean, which is no part of it, the slope of the energy along it, and its
/// largest magnitude.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Descent {
    pub(crate) mean: f64,
    pub(crate) slope: f64,
    pub(crate) largest: f64,
}

/// A state after a step: its residual, slope and elastic curvature of the energy along the direction, and the
/// change of the energy of the law in the step beyond first order.
pub(crate) struct TrialEvaluation {
    pub(crate) residual: Residual,
    pub(crate) slope: f64,
    pub(crate) curvature: f64,
    pub(crate) beyond: f64,
}

/// The last trial of a step: its length, and energy and slope there.
pub(crate) struct Trial {
    pub(crate) descent: Descent,
    pub(crate) length: f64,
    energy: f64,
    slope: f64,
}

impl Trial {
    pub(crate) fn new(descent: Descent) -> Self {
        Self { descent, length: 0.0, energy: 0.0, slope: descent.slope }
    }

    /// Goes on to a trial of another length: true if the energy falls enough (Armijo). Its change is of first
    /// order, elastic, and that of the law beyond first order, from one trial to the next.
    pub(crate) fn suffices(&mut self, length: f64, there: &TrialEvaluation) -> bool {
        let by = length - self.length;
        self.energy += by * (self.slope + 0.5 * by * there.curvature) + there.beyond;
        (self.length, self.slope) = (length, there.slope);
        self.energy <= 1e-4 * length * self.descent.slope
    }

    /// The minimum of the parabola through the energies, in bounds.
    pub(crate) fn shorter(&self) -> f64 {
        let first = self.descent.slope * self.length;
        self.length * (-0.5 * first / (self.energy - first)).clamp(0.15, 0.6)
    }
}

/// A step that was taken: its length along the direction and the largest change of the displacement.
#[derive(Debug, Clone, Copy)]
pub(crate) struct AcceptedStep {
    pub(crate) length: f64,
    pub(crate) largest: f64,
}
