//! Damped Newton method for the contact radii.
//!
//! No step changes a radius by more than a fraction. A step that does not reduce the largest residual is
//! halved. Near the edge of another contact, where the slope of the field is infinite, only short steps
//! reduce it.

use super::residual::NotConverged;

/// Largest residual of an evaluation.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Worst {
    /// Largest residual of a contact, with its asperity.
    pub(crate) contact: NotConverged,
    /// Largest residual, those of constraints included \[m\].
    pub(crate) largest_m: f64,
}

impl From<NotConverged> for Worst {
    fn from(contact: NotConverged) -> Self {
        Self { contact, largest_m: contact.residual_m }
    }
}

/// Limits of the method.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Damping {
    /// Smallest share of a step.
    pub(crate) least_share: f64,
    /// Maximum number of steps and halvings.
    pub(crate) rounds: usize,
}

impl Damping {
    /// For solves whose failure only shortens the increment.
    pub(crate) const NORMAL: Self = Self { least_share: 0.2, rounds: 24 };
    /// For solves whose failure leads to a relaxation: contacts at the edge of another are followed in short
    /// steps.
    pub(crate) const PATIENT: Self = Self { least_share: 1e-4, rounds: 60 };
}

/// A system of equations with its present unknowns.
pub(crate) trait NonlinearSystem {
    /// Evaluates the residual.
    fn evaluate(&mut self) -> Worst;

    /// Computes a step from the present unknowns.
    fn begin_step(&mut self, round: usize, worst: &Worst);

    /// Reduces the largest residual by other means, after a full step that has not; nothing if there are
    /// none.
    fn repair(&mut self, _worst: &Worst) -> Option<Result<Worst, NotConverged>> {
        None
    }

    /// Moves the unknowns by a share of the step from where it began.
    fn advance(&mut self, share: f64);
}

/// Solves a system that was evaluated, with the largest residual `first`.
pub(crate) fn damped_newton(
    system: &mut impl NonlinearSystem,
    first: Worst,
    damping: Damping,
    tolerance_m: f64,
) -> Result<(), NotConverged> {
    let mut worst = first;
    let (mut best, mut share) = (f64::INFINITY, 1.0);
    for round in 0..damping.rounds {
        if worst.largest_m <= tolerance_m {
            return Ok(());
        }
        if worst.largest_m < best {
            (best, share) = (worst.largest_m, 1.0);
            system.begin_step(round, &worst);
        } else if share == 1.0
            && worst.largest_m.is_finite()
            && let Some(repaired) = system.repair(&worst)
        {
            (best, worst) = (f64::INFINITY, repaired?);
            continue;
        } else {
            // No descent, or not a number.
            share *= 0.5;
            if share < damping.least_share || best.is_infinite() {
                return Err(worst.contact);
            }
        }
        system.advance(share);
        worst = system.evaluate();
    }
    if worst.largest_m <= tolerance_m { Ok(()) } else { Err(worst.contact) }
}

#[cfg(test)]
mod tests {
    use super::{Damping, NonlinearSystem, Worst, damped_newton};
    use crate::asperities::solve::residual::NotConverged;

    /// `atan(x) = 0`, for which full steps of Newton's method diverge from |x| > 1.39.
    struct Arc {
        x: f64,
        start: f64,
        step: f64,
        /// Solution after a repair.
        repaired: Option<f64>,
    }

    impl NonlinearSystem for Arc {
        fn evaluate(&mut self) -> Worst {
            NotConverged::residual(self.x.atan().abs(), 0).into()
        }

        fn begin_step(&mut self, _round: usize, _worst: &Worst) {
            (self.start, self.step) = (self.x, -self.x.atan() * (1.0 + self.x * self.x));
        }

        fn repair(&mut self, worst: &Worst) -> Option<Result<Worst, NotConverged>> {
            // NaN means that there is no equilibrium nearby.
            self.x = self.repaired?;
            Some(if self.x.is_nan() { Err(worst.contact) } else { Ok(self.evaluate()) })
        }

        fn advance(&mut self, share: f64) {
            self.x = self.start + share * self.step;
        }
    }

    fn solve(damping: Damping, repaired: Option<f64>) -> Result<f64, NotConverged> {
        let mut arc = Arc { x: 5.0, start: 0.0, step: 0.0, repaired };
        let first = arc.evaluate();
        damped_newton(&mut arc, first, damping, 1e-12).map(|()| arc.x)
    }

    #[test]
    fn law_damping_makes_steps_descend() {
        assert!(solve(Damping::PATIENT, None).is_ok_and(|x| x.abs() < 1e-12));
        // Without halvings the first step overshoots to −31.
        assert!(solve(Damping { least_share: 1.0, rounds: 60 }, None).is_err());
        // A limit of rounds is kept.
        assert!(solve(Damping { least_share: 1e-4, rounds: 2 }, None).is_err());
    }

    #[test]
    fn law_a_step_that_does_not_descend_is_repaired() {
        let few = Damping { least_share: 1.0, rounds: 8 };
        assert!(solve(few, Some(0.5)).is_ok_and(|x| x.abs() < 1e-12));
        // Without an equilibrium nearby the solution ends at once; repairs that do not help end with the
        // rounds.
        assert!(solve(Damping::PATIENT, Some(f64::NAN)).is_err());
        assert!(solve(few, Some(5.0)).is_err());
    }
}
