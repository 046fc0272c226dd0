//! Which of the sums: few spots are summed directly, many fast. Both give the same field, so that the choice may change along a path.

use super::{DirectSum, Effort, FastSum, Interaction, PairTable, Spots, Tangent};
use crate::model::{Boundary, Interaction as Kind, Material, Slips};

/// Spots from which the fast sum is the faster one, measured for the linearisations of one solution and the products that follow them; where there
/// are no images, a pair costs less and the mesh more.
const MANY: usize = 150;
const MANY_ALONE: usize = 400;

/// Asperities from which there may be so many spots.
const ENOUGH: usize = 300;

/// Errors of the fast sum, of the largest displacement: where an equilibrium is met to 1e-10 of the rms height, and where it is met well enough to go on.
const TOLERANCE: f64 = 1e-10;
const ROUGH: f64 = 1e-6;

/// The displacement field of asperities at `positions` \[m\] on the square of side `length_m`, summed in the way that is the faster one for
/// the number of spots in contact.
#[must_use]
pub fn best(positions: Vec<[f64; 2]>, length_m: f64, material: &Material, kind: Kind, boundary: Boundary, slips: Slips) -> Best {
    let many = positions.len() >= ENOUGH && matches!(kind, Kind::Spots | Kind::Point);
    let to = |tolerance| FastSum::new(positions.clone(), length_m, material, kind, boundary, slips, tolerance);
    let fast = many.then(|| [to(TOLERANCE), to(ROUGH)]);
    let many = if boundary == Boundary::Periodic { MANY } else { MANY_ALONE };
    Best { direct: DirectSum::new(positions, length_m, material, kind, boundary, slips), fast, many }
}

/// The direct sum, and the fast one where there are asperities enough for it.
#[derive(Debug, Clone)]
pub struct Best {
    direct: DirectSum,
    fast: Option<[FastSum; 2]>,
    /// Spots from which on that one is used.
    many: usize,
}

impl Best {
    /// For the spots themselves; `roughly` with an error of 1e-6 where they are many.
    pub(crate) fn for_spots(&self, spots: &Spots, roughly: bool) -> &dyn Interaction {
        match &self.fast {
            Some(fast) if spots.columns.len() >= self.many => &fast[usize::from(roughly)],
            _ => &self.direct,
        }
    }

    /// For other places than the spots: a mesh is worth its while only for many of them.
    pub(crate) fn for_targets(&self, spots: &Spots, targets: &[usize], roughly: bool) -> &dyn Interaction {
        if targets.len() < self.many / 2 { &self.direct } else { self.for_spots(spots, roughly) }
    }

    /// As [`DirectSum::among`] has it.
    pub(crate) fn among(&self, spots: &Spots, table: &mut PairTable, fields: &mut Vec<f64>, slopes: &mut Vec<f64>, effort: &mut Effort) {
        self.direct.among(spots, table, fields, slopes, effort);
    }

    /// The same with a table of what images do, where there are few enough asperities; it is gone where a place is added.
    #[must_use]
    pub fn with_table(self) -> Self {
        Self { direct: self.direct.with_table(), ..self }
    }

    /// The same with the fast sum from another number of spots on.
    pub(crate) fn fast_from(self, many: usize) -> Self {
        Self { many, ..self }
    }

    /// Adds a place \[m\], whose number follows the last one.
    pub(crate) fn add(&mut self, place: [f64; 2]) {
        self.direct.add(place);
        for fast in self.fast.iter_mut().flatten() {
            fast.add(place);
        }
    }

    /// As [`DirectSum::rows`] has it.
    pub(crate) fn rows(&self, spots: &Spots, targets: &[usize], rough: bool, effort: &mut Effort, visit: impl FnMut(usize, f64, &[f64])) {
        self.direct.rows(spots, targets, rough, effort, visit);
    }
}

impl Interaction for Best {
    fn displacements(&self, spots: &Spots, targets: &[usize], displacements: &mut Vec<f64>, effort: &mut Effort) {
        self.for_targets(spots, targets, false).displacements(spots, targets, displacements, effort);
    }

    fn linearise(&self, spots: &Spots, displacements: &mut Vec<f64>, tangent: &mut Tangent, effort: &mut Effort) {
        self.for_spots(spots, false).linearise(spots, displacements, tangent, effort);
    }

    fn again(&self, spots: &Spots, displacements: &mut Vec<f64>, tangent: &mut Tangent, effort: &mut Effort) {
        self.for_spots(spots, false).again(spots, displacements, tangent, effort);
    }

    fn approach(
        &self,
        spots: &Spots,
        rates: &[f64],
        targets: &[usize],
        found: [&mut Vec<f64>; 2],
        kept: &mut Tangent,
        effort: &mut Effort,
    ) {
        self.for_targets(spots, targets, false).approach(spots, rates, targets, found, kept, effort);
    }
}
