//! Fast sum in n log n: near pairs exactly, the smooth far field on a mesh.
//!
//! Ewald splitting (Darden, York & Pedersen, J. Chem. Phys. 98:10089, 1993; Essmann et al., 103:8577, 1995)
//! of a field with the far-field expansion `Σ_m c_m/r^(2m+1)`, m = 0 … 3 ([`super::multipole`]). As
//! `∇^2m (1/r) = [(2m−1)!!]²/r^(2m+1)` in the plane, the smooth field of a spot is
//! `Σ_m c_m ∇^2m(erf(αr)/r)/[(2m−1)!!]²`: one kernel, whose sources are a spot's load and Laplacians of it.
//! Within the cutoff `r_c` of a source its field is exact, less the smooth field of its nearest image. The
//! smooth fields of all sources and images come from a mesh.
//!
//! The radius of a spot must be small compared with its cutoff, so sources are grouped by radius. Each group
//! has twice the cutoff of the previous one and a mesh half as fine, so one large spot adds only one long
//! list. Spots too large for any mesh act on all targets by their exact field.
//!
//! An isolated square has no images. It is embedded in an empty square of [`ROOM`] times its side.
//! The smooth field of each source on the mesh is windowed to zero before the next image begins ([`plan`]).

mod geometry;
mod mesh;
mod near;
mod order;
mod pairs;
mod plan;

use super::ewald::ORDERS;
use super::multipole::{Moments, product};
use super::spot_field::{SpotColumns, sag};
use super::{Interaction, Spots, Tangent};
use crate::cycle::Effort;
use crate::model::{Boundary, Interaction as Kind, Material, Slips};
use geometry::Geometry;
use mesh::{Loads, Work};
use near::Measure;
use order::{Order, inward, outward};
use pairs::Sources;
use plan::{Accuracy, Plan, mesh_size};
use std::cell::RefCell;
use std::f64::consts::{FRAC_1_SQRT_2, PI};
use std::sync::{Arc, OnceLock};

/// Longest cutoff, in sides: only the nearest image lies within it.
const LONGEST_CUTOFF: f64 = 0.45;

/// Cutoffs to choose from, each `1/√2` of the one before.
const CUTOFF_COUNT: usize = 15;
const CUTOFF: [f64; CUTOFF_COUNT] = {
    let mut all = [LONGEST_CUTOFF; CUTOFF_COUNT];
    let mut step = 1;
    while step < CUTOFF_COUNT {
        all[step] = all[step - 1] * FRAC_1_SQRT_2;
        step += 1;
    }
    all
};

/// Side of the empty square around an isolated one, in units of the side.
const ROOM: f64 = 3.0;

/// Longest cutoff for an isolated square, in units of the empty square's side.
///
/// The window falls to zero and rises again between the range that the square needs and the next image.
const LONGEST_CUTOFF_ISOLATED: f64 = 0.5 * (0.5 - 1.0 / ROOM);

/// Cost of one pair in units of one mesh point in one transform.
///
/// It covers the linearisations of one solution and the products that follow.
const PAIR_COST: f64 = 8.0;

/// Factor by which radii may grow before pairs are searched again.
const MARGIN: f64 = 1.05;

/// Fast sum: near pairs and a mesh.
#[derive(Debug, Clone)]
pub struct FastSum {
    measure: Measure,
    order: Order,
    /// `1/(πE*)` \[1/Pa\].
    compliance: f64,
    accuracy: Accuracy,
    /// Plans made so far, from the longest cutoff to the shortest.
    plans: [OnceLock<Arc<Plan>>; CUTOFF_COUNT],
}

impl FastSum {
    /// Asperities at `positions` \[m\] on the square of side `length_m`.
    ///
    /// The error of every displacement is at most `tolerance` times the largest one.
    /// The load of a spot must follow from its radius by Eq 1. Of `slips` only Eq 8 is used.
    #[must_use]
    pub fn new(
        positions: Vec<[f64; 2]>,
        length_m: f64,
        material: &Material,
        kind: Kind,
        boundary: Boundary,
        slips: Slips,
        tolerance: f64,
    ) -> Self {
        let length = match boundary {
            Boundary::Periodic => length_m,
            Boundary::Isolated => ROOM * length_m,
        };
        Self {
            measure: Measure { kind, boundary, pull: material.pull(), sag: sag(slips), length },
            order: Order::new(positions, length),
            compliance: material.compliance(),
            accuracy: Accuracy::of(tolerance),
            plans: [const { OnceLock::new() }; CUTOFF_COUNT],
        }
    }

    /// Adds an asperity at `place` \[m\]; it gets the next number.
    pub(crate) fn add(&mut self, place: [f64; 2]) {
        self.order.add(place);
    }

    fn plan(&self, step: usize) -> Arc<Plan> {
        self.plans[step]
            .get_or_init(|| Arc::new(Plan::new(self.accuracy, CUTOFF[step], self.measure.boundary)))
            .clone()
    }

    /// Index of the shortest cutoff allowed for a spot of radius `a` \[m\].
    ///
    /// `None` if the spot is too large for all.
    fn shortest(&self, a: f64) -> Option<usize> {
        let least = if self.measure.kind == Kind::Spots {
            a / (self.accuracy.girth * self.measure.length)
        } else {
            0.0
        };
        CUTOFF.iter().rposition(|reach| *reach >= least).filter(|step| *step >= self.longest())
    }

    /// Index of the longest cutoff.
    fn longest(&self) -> usize {
        match self.measure.boundary {
            Boundary::Periodic => 0,
            Boundary::Isolated => {
                CUTOFF.iter().position(|reach| *reach <= LONGEST_CUTOFF_ISOLATED).unwrap_or(CUTOFF_COUNT - 1)
            }
        }
    }

    /// Longest of the cutoffs `finest`, `finest` − 2, … that is no shorter than `shortest`, if any.
    fn level(&self, finest: usize, shortest: usize) -> Option<usize> {
        let step = if finest <= shortest {
            Some(finest)
        } else {
            (shortest + 1 - (finest - shortest) % 2).checked_sub(1)
        };
        step.filter(|step| *step >= self.longest())
    }

    /// Index of the finest cutoff with the lowest estimated cost.
    ///
    /// The estimate uses the shortest cutoff of each spot, their positions and the number of targets.
    fn finest(&self, shortest: &[Option<usize>], columns: &SpotColumns, targets: usize) -> usize {
        let clustering = clustering(columns, self.measure.length);
        let mut spots = [0usize; CUTOFF_COUNT];
        for step in shortest.iter().flatten() {
            spots[*step] += 1;
        }
        let cost = |finest: usize| {
            let mut counts = [0usize; CUTOFF_COUNT];
            for (shortest, count) in spots.iter().enumerate() {
                if let Some(step) = self.level(finest, shortest) {
                    counts[step] += count;
                }
            }
            let large = shortest.len() - counts.iter().sum::<usize>();
            counts[finest] = counts[finest].max(1);
            let mut cost = PAIR_COST * (targets * large) as f64;
            for (step, count) in counts.iter().enumerate().filter(|(_, count)| **count > 0) {
                let mesh = mesh_size(self.accuracy, CUTOFF[step]) as f64;
                let pairs = clustering[step] * PI * CUTOFF[step] * CUTOFF[step] * (count * targets) as f64;
                cost += PAIR_COST * pairs + mesh * mesh * mesh.log2() * 2.0;
            }
            cost
        };
        let all = (self.longest()..CUTOFF_COUNT).map(|step| (step, cost(step)));
        all.min_by(|(_, a), (_, b)| a.total_cmp(b)).map_or(CUTOFF_COUNT - 1, |(step, _)| step)
    }

    /// Sources of the exact fields and of the moments.
    fn sources(&self, spots: &Spots) -> Sources {
        let columns = &spots.columns;
        let shape = |j: usize| {
            [columns.a[j], columns.root_a[j], columns.inverse_root_a[j], columns.inverse_radius[j]]
        };
        Sources {
            measure: self.measure,
            shapes: (0..columns.len()).map(shape).collect(),
            moments: Moments::of(
                self.measure.kind,
                columns,
                self.measure.pull,
                self.compliance,
                self.measure.length,
            ),
        }
    }

    /// True if there is any field.
    fn acts(&self, spots: &Spots) -> bool {
        self.measure.kind != Kind::None && !spots.index.is_empty()
    }
}

/// Clustering: mean number of spots near a spot relative to a uniform distribution, for each cutoff.
fn clustering(columns: &SpotColumns, length: f64) -> [f64; CUTOFF_COUNT] {
    let n = columns.len();
    let mut counts = Vec::new();
    std::array::from_fn(|step| {
        // At most as many cells as spots; smaller cells hold few spots in any case.
        let cells = ((1.0 / CUTOFF[step]) as usize).min((n as f64).sqrt() as usize).max(1);
        counts.clear();
        counts.resize(cells * cells, 0u32);
        let cell = |p: f64| (((p / length).rem_euclid(1.0) * cells as f64) as usize).min(cells - 1);
        for (x, y) in columns.x[..n].iter().zip(&columns.y[..n]) {
            counts[cell(*x) * cells + cell(*y)] += 1;
        }
        let squares: f64 = counts.iter().map(|count| f64::from(*count).powi(2)).sum();
        squares * (cells * cells) as f64 / (n * n) as f64
    })
}

impl Interaction for FastSum {
    fn displacements(
        &self,
        spots: &Spots,
        targets: &[usize],
        displacements: &mut Vec<f64>,
        effort: &mut Effort,
    ) {
        displacements.clear();
        displacements.resize(targets.len(), 0.0);
        if self.acts(spots) {
            let ((spots, _), targets) = (self.order.spots(spots), self.order.of(targets));
            let (mut geometry, mut values) = (Geometry::default(), vec![0.0; targets.ranks.len()]);
            self.place(&spots, &targets.ranks, &mut geometry);
            geometry.displacements(&self.sources(&spots), &mut Work::default(), &mut values, effort);
            outward(&targets.from, &values, displacements);
        }
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
        let [displacements, slopes] = found;
        for values in [&mut *displacements, &mut *slopes] {
            values.clear();
            values.resize(targets.len(), 0.0);
        }
        if self.acts(spots) {
            let ((spots, from), targets) = (self.order.spots(spots), self.order.of(targets));
            let mut sparse = kept.take_sparse();
            self.place(&spots, &targets.ranks, &mut sparse.geometry);
            let sources = self.sources(&spots);
            let Sparse { geometry, fine, rough, .. } = &mut *sparse;
            let x = &mut rough.get_mut().x;
            inward(&from, rates, x);
            let mut values = vec![0.0; targets.ranks.len()];
            geometry.linearise(&sources, fine, &mut values, effort);
            outward(&targets.from, &values, displacements);
            values.fill(0.0);
            geometry.fine_product(
                Loads { moments: &sources.moments.slope, factors: Some(x) },
                fine,
                &mut values,
            );
            outward(&targets.from, &values, slopes);
            kept.set_sparse(sparse);
        }
    }

    fn linearise(
        &self,
        spots: &Spots,
        displacements: &mut Vec<f64>,
        tangent: &mut Tangent,
        effort: &mut Effort,
    ) {
        displacements.clear();
        displacements.resize(spots.index.len(), 0.0);
        if !self.acts(spots) {
            let zeros = tangent.take_dense(spots.index.len());
            tangent.set_dense(spots.index.len(), zeros);
            return;
        }
        let mut sparse = tangent.take_sparse();
        let (spots, from) = self.order.spots(spots);
        sparse.from = from;
        if !sparse.geometry.serves(self, &spots) {
            self.place(&spots, &spots.index, &mut sparse.geometry);
        }
        let sources = self.sources(&spots);
        let mut values = vec![0.0; spots.index.len()];
        sparse.geometry.linearise(&sources, &mut sparse.fine, &mut values, effort);
        outward(&sparse.from, &values, displacements);
        let own = self.measure.images(0.0, 0.0);
        for (value, slope) in values.iter_mut().zip(&sources.moments.slope) {
            *value = product(&own, slope);
        }
        sparse.own.resize(values.len(), 0.0);
        outward(&sparse.from, &values, &mut sparse.own);
        sparse.slopes = sources.moments.slope;
        tangent.set_sparse(sparse);
    }
}

/// `∂ŵ/∂a` as near pairs and a mesh.
#[derive(Debug, Clone, Default)]
pub(super) struct Sparse {
    geometry: Geometry,
    /// Original position of each spot; all fields but `own` are in Z-order.
    from: Vec<usize>,
    /// Derivatives of the moments to the radii.
    slopes: Vec<[f64; ORDERS]>,
    own: Vec<f64>,
    fine: Work<f64>,
    rough: RefCell<Rough>,
}

/// Work space of products.
#[derive(Debug, Clone, Default)]
struct Rough {
    work: Work<f32>,
    x: Vec<f64>,
    y: Vec<f64>,
}

impl Sparse {
    pub(super) fn product(&self, x: &[f64], y: &mut [f64]) {
        let rough = &mut *self.rough.borrow_mut();
        inward(&self.from, x, &mut rough.x);
        rough.y.resize(x.len(), 0.0);
        self.geometry.product(
            Loads { moments: &self.slopes, factors: Some(&rough.x) },
            &mut rough.work,
            &mut rough.y,
        );
        outward(&self.from, &rough.y, y);
    }

    pub(super) fn own(&self, i: usize) -> f64 {
        self.own[i]
    }

    pub(super) fn transforms(&self) -> u64 {
        self.geometry.transforms()
    }
}
