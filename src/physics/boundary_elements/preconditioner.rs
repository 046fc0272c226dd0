//! The preconditioner of the minimisation: approximate compliance of contact and open points.

use super::contact::Problem;
use super::grid::{Operator, Waves};
use super::sums::{PANEL, grain};
use crate::physics::PhysicsError;
use crate::physics::memory::filled;
use rayon::prelude::*;

/// Slope of the law from which a point counts as in contact, and the addition to it, in E*/dx.
const STIFF: f32 = 0.3;
const ADDED: f32 = 0.7;

/// The split preconditioner, or the spectral one to compare it with.
pub struct Preconditioner {
    masked: Vec<f32>,
    /// True if the points in contact have a preconditioner of their own; else that of the open points, shifted, is used for all.
    pub split: bool,
}

impl Preconditioner {
    pub(super) fn new(points: usize) -> Result<Self, PhysicsError> {
        Ok(Self { masked: filled(points, 0.0)?, split: true })
    }

    /// `direction ← M⁻¹ direction` at given slopes of the law; what `response` holds then has no meaning.
    pub(super) fn divide(
        &mut self,
        problem: &Problem,
        waves: &mut Waves<f32>,
        (direction, response): (&mut [f32], &mut [f32]),
        slopes: &[f32],
    ) {
        if !self.split {
            problem.half_space.apply(Operator::Shifted, direction, response, waves);
            direction.copy_from_slice(response);
            return;
        }
        let fields = (self.masked.par_chunks_mut(PANEL), direction.par_chunks(PANEL), slopes.par_chunks(PANEL));
        fields.into_par_iter().with_min_len(grain(PANEL)).for_each(|(to, from, slopes)| {
            for ((x, y), slope) in to.iter_mut().zip(from).zip(slopes) {
                *x = if *slope > STIFF { 0.0 } else { *y };
            }
        });
        problem.half_space.apply(Operator::Compliance, &self.masked, response, waves);
        let fields = (direction.par_chunks_mut(PANEL), response.par_chunks(PANEL), slopes.par_chunks(PANEL));
        fields.into_par_iter().with_min_len(grain(PANEL)).for_each(|(d, open, slopes)| {
            for ((x, y), slope) in d.iter_mut().zip(open).zip(slopes) {
                *x = if *slope > STIFF { *x / (slope + ADDED) } else { *y };
            }
        });
    }
}
