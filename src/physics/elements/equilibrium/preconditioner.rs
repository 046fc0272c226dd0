//! The preconditioner of the minimisation: approximate compliance of contact and open points.

use super::passes::{PAIRS, Right, Split, divided, open_part};
use crate::elements::grid::half_space::{Operator, Waves};
use crate::elements::problem::Problem;
use rayon::prelude::*;

/// Points in contact, of a slope of the law above `stiff`, are nearly fixed by the wall; at open points the
/// law softens near a front of contact.
const SPLIT: Split = Split { stiff: 0.3, added: 0.7, softening: 1.0 };
/// With hard contact, whose operator is stiffer at short wavelengths. With the values of [`SPLIT`] a loop
/// takes a quarter more transforms.
const HARD: Split = Split { stiff: 1.0, added: 0.7, softening: 0.2 };
/// All points as open ones.
const WHOLE: Split = Split { stiff: f32::INFINITY, added: 0.0, softening: 0.0 };

/// The split preconditioner, or the spectral one to compare it with.
pub struct Preconditioner {
    /// True if the points in contact have a preconditioner of their own; else that of the open points,
    /// shifted, is used for all.
    pub split: bool,
}

impl Preconditioner {
    /// `direction ← M⁻¹ right` at given slopes of the law: its products with the changes of `right`.
    pub(crate) fn divide(
        &self,
        problem: &Problem,
        waves: &mut Waves<f32>,
        direction: &mut [f32],
        right: &Right<'_>,
        slopes: &[f32],
    ) -> [f64; PAIRS] {
        let half_space = &problem.half_space;
        let is_hard = half_space.medium().wall_compliance > 0.0;
        let (split, operator) = match self.split {
            true => (if is_hard { HARD } else { SPLIT }, Operator::Compliance),
            false => (WHOLE, Operator::Shifted),
        };
        let columns = half_space.columns();
        let rows = || right.rows(columns).zip(slopes.par_chunks(columns));
        half_space.forward(waves, rows(), |(right, slopes), to| open_part(to, &right, slopes, split));
        let parts = half_space.backward(
            operator,
            waves,
            direction.par_chunks_mut(columns).zip(rows()),
            |(to, (right, slopes)), open| divided(to, open, &right, slopes, split),
        );
        parts.iter().fold([0.0; PAIRS], |all, part| [all[0] + part[0], all[1] + part[1]])
    }
}
