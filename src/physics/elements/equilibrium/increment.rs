//! Changes of a state during a minimisation, in single precision.

use crate::PhysicsError;
use crate::elements::grid::sums::{PANEL, grain};
use crate::elements::law::{Bonding, Pieces};
use crate::elements::problem::{Problem, State};
use crate::memory::filled;
use rayon::prelude::*;

/// Displacement and pressure since a state in double precision, and gap and residual at that state, in single
/// precision.
pub(crate) struct SinglePrecisionIncrement {
    pub(crate) gap: Vec<f32>,
    pub(crate) residual: Vec<f32>,
    /// Displacement and pressure since that state.
    pub(crate) displacement: Vec<f32>,
    pub(crate) pressure: Vec<f32>,
    /// 1 at points in contact.
    pub(crate) touching: Vec<u8>,
    /// Rows with points that have come into contact or left it since bonds were updated.
    pub(crate) stale: Vec<bool>,
    /// Mean that is subtracted from the residual.
    pub(crate) centre: f64,
    pub(crate) pieces: Pieces,
}

impl SinglePrecisionIncrement {
    pub(crate) fn new(problem: &Problem) -> Result<Self, PhysicsError> {
        let points = problem.half_space.points();
        let field = || filled(points, 0.0_f32);
        Ok(Self {
            gap: field()?,
            residual: field()?,
            displacement: field()?,
            pressure: field()?,
            touching: filled(points, 0)?,
            stale: filled(problem.half_space.rows(), true)?,
            centre: 0.0,
            pieces: problem.law.pieces(),
        })
    }

    /// Sets the state that the changes refer to, with no change so far.
    pub(crate) fn rebase(&mut self, problem: &Problem, state: &State, centre: f64) {
        self.centre = centre;
        self.stale.fill(true);
        let mean_penetration = state.mean_penetration;
        let fields = (
            self.gap.par_chunks_mut(PANEL),
            self.residual.par_chunks_mut(PANEL),
            self.displacement.par_chunks_mut(PANEL),
            self.pressure.par_chunks_mut(PANEL),
            state.displacement.par_chunks(PANEL),
            state.pressure.par_chunks(PANEL),
            problem.heights.par_chunks(PANEL),
            state.bonds.par_chunks(PANEL),
        );
        fields.into_par_iter().with_min_len(grain(PANEL)).for_each(
            |(gap, residual, moved, pressed, u, p, z, bonds)| {
                for (k, (gap, residual)) in gap.iter_mut().zip(residual).enumerate() {
                    let exact = u[k] - mean_penetration - z[k];
                    *gap = exact as f32;
                    *residual = (p[k] + problem.bond(bonds[k], exact).tension - centre) as f32;
                }
                moved.fill(0.0);
                pressed.fill(0.0);
            },
        );
    }

    /// Enters the tension that the points with another bond would have had at the beginning.
    pub(crate) fn rebond(&mut self, problem: &Problem, bonds: &[Bonding], changed: &[(usize, Bonding)]) {
        for (point, before) in changed {
            let tension = |bonding| problem.bond(bonding, f64::from(self.gap[*point])).tension;
            self.residual[*point] += (tension(bonds[*point]) - tension(*before)) as f32;
        }
    }

    /// Adds the changes to the state.
    pub(crate) fn commit(&self, state: &mut State) {
        let fields = (&mut state.displacement, &mut state.pressure, &self.displacement, &self.pressure)
            .into_par_iter()
            .with_min_len(grain(1));
        fields.for_each(|(u, p, moved, pressed)| {
            *u += f64::from(*moved);
            *p += f64::from(*pressed);
        });
    }
}

/// Pressure and tension of some points, which near equilibrium is their mean over the grid.
pub(crate) fn level(problem: &Problem, state: &State) -> f64 {
    let points = state.bonds.len().min(PANEL);
    let residual = |k: usize| state.pressure[k] + problem.tension(state, k);
    (0..points).map(residual).sum::<f64>() / points as f64
}
