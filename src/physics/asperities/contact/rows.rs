//! Table rows of a state at a load reversal, sufficient to unload from it in another process.
//!
//! Displacements and residual are not stored: they are computed again before the path continues.

use super::problem::Problem;
use super::state::{State, Status};
use crate::PhysicsError;
use crate::cycle::Merged;

/// Row of an asperity that is not simply free.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Kept {
    /// The asperity, by the caller's number.
    pub asperity: usize,
    /// Status of the asperity.
    pub status: Status,
    /// Contact radius \[m\], 0 out of contact.
    pub radius_m: f64,
    /// True if it is blocked from re-entry until its penetration falls below the jump-in.
    pub barred: bool,
}

impl State {
    /// Rows of all asperities that are not simply free, by the caller's numbers, ascending.
    #[must_use]
    pub fn kept(&self, problem: &Problem) -> Vec<Kept> {
        let all = self.status.iter().zip(&self.radius).zip(&self.barred).enumerate();
        let mut kept: Vec<Kept> = all
            .map(|(i, ((status, radius_m), barred))| Kept {
                asperity: problem.number(i),
                status: status.renumbered(|i| problem.number(i)),
                radius_m: *radius_m,
                barred: *barred,
            })
            .filter(|kept| kept.status != Status::Free || kept.barred)
            .collect();
        kept.sort_by_key(|kept| kept.asperity);
        kept
    }

    /// Merged spots, by the caller's numbers and positions.
    #[must_use]
    pub fn merged(&self, problem: &Problem) -> Vec<Merged> {
        self.merged.iter().map(|spot| problem.outward(spot)).collect()
    }

    /// State at a mean penetration \[m\] from its rows; all other asperities are free.
    ///
    /// `merged` are the merged spots of the state.
    ///
    /// # Errors
    /// Asperity numbers, including absorbing ones, must belong to the problem. A contact radius must be
    /// positive.
    pub fn restored(
        problem: &Problem,
        mean_penetration_m: f64,
        merged: &[Merged],
        rows: &[Kept],
    ) -> Result<Self, PhysicsError> {
        let mut state = Self::free(problem, mean_penetration_m);
        let inside = problem.places.inside();
        let number = |i: usize| inside.get(i).copied().unwrap_or(i);
        for spot in merged {
            state.extend(Merged {
                parts: spot.parts.map(number),
                place_m: problem.places.inward(spot.place_m),
                ..*spot
            });
        }
        let count = state.status.len();
        for row in rows {
            let by = match row.status {
                Status::Covered { by, .. } | Status::Merged { into: by } => by,
                _ => row.asperity,
            };
            if row.asperity.max(by) >= count {
                return Err(PhysicsError::UnknownAsperity { asperity: row.asperity.max(by), count });
            }
            if row.status == Status::Contact && !(row.radius_m > 0.0 && row.radius_m.is_finite()) {
                return Err(PhysicsError::Domain {
                    action: "the state at load reversal",
                    quantity: "the contact radius [m]",
                    value: row.radius_m,
                    allowed: "a positive number",
                });
            }
            let i = number(row.asperity);
            state.set(i, row.status.renumbered(number), row.radius_m);
            state.barred[i] = row.barred;
        }
        Ok(state)
    }
}

impl Status {
    /// Status with renumbered asperities.
    fn renumbered(self, number: impl Fn(usize) -> usize) -> Self {
        match self {
            Self::Covered { by, release_m } => Self::Covered { by: number(by), release_m },
            Self::Merged { into } => Self::Merged { into: number(into) },
            Self::Free | Self::Contact => self,
        }
    }
}
