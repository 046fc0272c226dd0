//! Choice of summation method: direct for few contact spots, fast for many.
//!
//! Both give the same field, so the choice may change along a path.

use super::spot_field::Spot;
use super::{DirectSum, FastSum, Interaction, PairTable, PointLoad, Spots, Tangent};
use crate::cycle::Effort;
use crate::model::{Boundary, Interaction as Kind, Material, Slips};

/// Numbers of contact spots above which the fast sum is faster: with periodic images, with a table of their
/// sums, and without images.
///
/// Measured for the linearisations of one solution and the products that follow them.
/// Without images a pair costs less and the mesh more.
pub(super) const FAST_FROM_PERIODIC: usize = 70;
pub(super) const FAST_FROM_TABLE: usize = 100;
pub(super) const FAST_FROM_ISOLATED: usize = 400;

/// Number of asperities from which the fast sum is set up.
pub(super) const MIN_ASPERITIES: usize = 300;

/// Errors of the fast sum relative to the largest displacement.
///
/// `TOLERANCE` is for equilibria, `INTERMEDIATE_TOLERANCE` for intermediate solutions.
pub(super) const TOLERANCE: f64 = 1e-8;
pub(super) const INTERMEDIATE_TOLERANCE: f64 = 1e-6;

/// Precision of equilibria where all sums are direct.
pub(super) const DIRECT_TOLERANCE: f64 = 1e-10;

/// Displacement field of asperities at `positions` \[m\] on the square of side `length_m`.
///
/// The number of spots in contact selects the faster summation method.
#[must_use]
pub fn choose(
    positions: Vec<[f64; 2]>,
    length_m: f64,
    material: &Material,
    kind: Kind,
    boundary: Boundary,
    slips: Slips,
) -> FieldSum {
    let many = positions.len() >= MIN_ASPERITIES && matches!(kind, Kind::Spots | Kind::Point);
    let to =
        |tolerance| FastSum::new(positions.clone(), length_m, material, kind, boundary, slips, tolerance);
    let fast = many.then(|| PerPrecision { full: to(TOLERANCE), rough: to(INTERMEDIATE_TOLERANCE) });
    let many = if boundary == Boundary::Periodic { FAST_FROM_PERIODIC } else { FAST_FROM_ISOLATED };
    let full = DirectSum::new(positions, length_m, material, kind, boundary, slips);
    let rough = full.to_six_digits();
    FieldSum { direct: PerPrecision { full, rough }, fast, many, uniform: 0.0 }
}

/// Precision of a sum over contacts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SumPrecision {
    /// That of an equilibrium: a direct sum is exact.
    Full,
    /// Six digits, for intermediate solutions.
    Intermediate,
}

/// A method of summation in both precisions.
#[derive(Debug, Clone)]
struct PerPrecision<T> {
    full: T,
    rough: T,
}

impl<T> PerPrecision<T> {
    fn of(&self, precision: SumPrecision) -> &T {
        match precision {
            SumPrecision::Full => &self.full,
            SumPrecision::Intermediate => &self.rough,
        }
    }
}

/// The direct sum, and the fast sum if there are enough asperities.
#[derive(Debug, Clone)]
pub struct FieldSum {
    direct: PerPrecision<DirectSum>,
    fast: Option<PerPrecision<FastSum>>,
    /// Number of contact spots from which the fast sum is used.
    many: usize,
    /// Displacement of all asperities over the total load \[m/N\]: a spring in series with the contact.
    uniform: f64,
}

impl FieldSum {
    /// Precision to which equilibria can be solved: displacements in units of the largest one, or of the rms
    /// height, which is as large.
    pub(crate) fn precision(&self) -> f64 {
        if self.fast.is_some() { TOLERANCE } else { DIRECT_TOLERANCE }
    }

    /// Sets the compliance of a spring in series with the contact \[m/N\].
    pub(crate) fn with_uniform(self, uniform: f64) -> Self {
        Self { uniform, ..self }
    }

    /// Compliance of the spring in series with the contact \[m/N\].
    pub(crate) fn uniform(&self) -> f64 {
        self.uniform
    }

    /// Displacement of all asperities by the spring in series with the contact \[m\].
    pub(crate) fn by_spring(&self, spots: &Spots) -> f64 {
        self.uniform * spots.columns.load[..spots.columns.len()].iter().sum::<f64>()
    }

    /// Change of [`Self::by_spring`] over changes of the radii of the spots \[m\].
    pub(crate) fn by_spring_along(&self, spots: &Spots, changes: &[f64]) -> f64 {
        let slopes = &spots.columns.load_slope[..spots.columns.len()];
        self.uniform * slopes.iter().zip(changes).map(|(slope, change)| slope * change).sum::<f64>()
    }

    /// Sum for targets that are the spots themselves, without the spring.
    ///
    /// [`SumPrecision::Intermediate`] allows an error of 1e-6 if the fast sum is used; the direct sum is
    /// exact.
    pub(crate) fn for_spots(&self, spots: &Spots, precision: SumPrecision) -> &dyn Interaction {
        match &self.fast {
            Some(fast) if spots.columns.len() >= self.many => fast.of(precision),
            _ => &self.direct.full,
        }
    }

    /// Sum for other targets, without the spring; with few targets the direct sum is cheaper than a mesh.
    pub(crate) fn for_targets(
        &self,
        spots: &Spots,
        targets: &[usize],
        precision: SumPrecision,
    ) -> &dyn Interaction {
        if targets.len() < self.many / 2 {
            self.direct.of(precision)
        } else {
            self.for_spots(spots, precision)
        }
    }

    /// Displacements and derivatives among the spots by direct sums, see [`DirectSum::among`].
    pub(crate) fn among(
        &self,
        spots: &Spots,
        table: &mut PairTable,
        fields: &mut Vec<f64>,
        slopes: &mut Vec<f64>,
        effort: &mut Effort,
    ) {
        self.direct.full.among(spots, table, fields, slopes, effort);
        if self.uniform != 0.0 {
            let (n, by_spring) = (spots.columns.len(), self.by_spring(spots));
            fields.iter_mut().for_each(|field| *field += by_spring);
            for row in slopes.chunks_mut(n.max(1)) {
                self.add_slopes(spots, row);
            }
        }
    }

    /// Adds the derivatives of the displacement by the spring to the radii of the spots.
    fn add_slopes(&self, spots: &Spots, row: &mut [f64]) {
        for (slope, load_slope) in row.iter_mut().zip(&spots.columns.load_slope) {
            *slope += self.uniform * load_slope;
        }
    }

    /// Tabulates the image sums of all pairs if there are few enough asperities.
    ///
    /// Adding an asperity discards the table.
    #[must_use]
    pub fn with_table(self) -> Self {
        let PerPrecision { full, rough } = self.direct;
        let full = full.with_table();
        let many = if full.has_table() { FAST_FROM_TABLE } else { self.many };
        Self { direct: PerPrecision { full, rough }, many, ..self }
    }

    /// Sets the number of spots from which the fast sum is used.
    pub(crate) fn fast_from(self, many: usize) -> Self {
        Self { many, ..self }
    }

    /// Adds an asperity at `place` \[m\]; it gets the next number.
    pub(crate) fn add(&mut self, place: [f64; 2]) {
        self.direct.full.add(place);
        self.direct.rough.add(place);
        if let Some(fast) = &mut self.fast {
            fast.full.add(place);
            fast.rough.add(place);
        }
    }

    /// Displacements by few spots at many targets, see [`DirectSum::at_many`].
    pub(crate) fn at_many(&self, spots: &[(f64, Spot)], targets: impl Iterator<Item = usize>) -> Vec<f64> {
        if self.uniform == 0.0 {
            return self.direct.full.at_many(spots, targets);
        }
        let (targets, by_spring): (Vec<usize>, f64) = (targets.collect(), self.of_spring(spots));
        let mut found = self.direct.full.at_many(spots, targets.iter().copied());
        targets.into_iter().for_each(|target| found[target] += by_spring);
        found
    }

    /// Displacement by the spring, with loads that are added or subtracted \[m\].
    fn of_spring(&self, spots: &[(f64, Spot)]) -> f64 {
        self.uniform * spots.iter().map(|(sign, spot)| sign * spot.load).sum::<f64>()
    }

    /// Displacement at a target by spots that are added or subtracted, see [`DirectSum::at_one`].
    pub(crate) fn at_one(&self, spots: &[(f64, Spot)], target: usize) -> f64 {
        let field = self.direct.full.at_one(spots, target);
        if self.uniform == 0.0 { field } else { field + self.of_spring(spots) }
    }

    /// Displacements and derivatives at targets by direct sums, see [`DirectSum::rows`]. Intermediate sums
    /// have six digits of the image sums.
    pub(crate) fn rows(
        &self,
        spots: &Spots,
        targets: &[usize],
        precision: SumPrecision,
        effort: &mut Effort,
        mut visit: impl FnMut(usize, f64, &[f64]),
    ) {
        let direct = self.direct.of(precision);
        if self.uniform == 0.0 {
            return direct.rows(spots, targets, effort, visit);
        }
        let (by_spring, mut whole) = (self.by_spring(spots), Vec::new());
        direct.rows(spots, targets, effort, |k, field, slopes| {
            whole.clear();
            whole.extend_from_slice(slopes);
            self.add_slopes(spots, &mut whole);
            visit(k, field + by_spring, &whole);
        });
    }

    /// Displacements far from a load, see [`DirectSum::far_from_load`].
    pub(crate) fn far_from_load(
        &self,
        load: f64,
        place: &[f64; 2],
        reach: f64,
        targets: &[usize],
    ) -> Vec<f64> {
        let mut found = self.direct.rough.far_from_load(load, place, reach, targets);
        if self.uniform != 0.0 {
            // Targets within the reach have no displacement.
            found.iter_mut().filter(|field| **field != 0.0).for_each(|field| *field += self.uniform * load);
        }
        found
    }

    /// Displacements by loads next to one another, see [`DirectSum::of_loads`].
    pub(crate) fn of_loads(&self, loads: &[PointLoad], centre: &[f64; 2], targets: &[usize]) -> Vec<f64> {
        let mut found = self.direct.rough.of_loads(loads, centre, targets);
        if self.uniform != 0.0 {
            let by_spring = self.uniform * loads.iter().map(|load| load.load_n).sum::<f64>();
            found.iter_mut().for_each(|field| *field += by_spring);
        }
        found
    }
}

impl Interaction for FieldSum {
    fn displacements(
        &self,
        spots: &Spots,
        targets: &[usize],
        displacements: &mut Vec<f64>,
        effort: &mut Effort,
    ) {
        self.for_targets(spots, targets, SumPrecision::Full).displacements(
            spots,
            targets,
            displacements,
            effort,
        );
        if self.uniform != 0.0 {
            let by_spring = self.by_spring(spots);
            displacements.iter_mut().for_each(|field| *field += by_spring);
        }
    }

    fn linearise(
        &self,
        spots: &Spots,
        displacements: &mut Vec<f64>,
        tangent: &mut Tangent,
        effort: &mut Effort,
    ) {
        self.for_spots(spots, SumPrecision::Full).linearise(spots, displacements, tangent, effort);
    }

    fn along_path(
        &self,
        spots: &Spots,
        rates: &[f64],
        targets: &[usize],
        found: [&mut Vec<f64>; 2],
        kept: &mut Tangent,
        effort: &mut Effort,
    ) {
        self.for_targets(spots, targets, SumPrecision::Full)
            .along_path(spots, rates, targets, found, kept, effort);
    }
}
