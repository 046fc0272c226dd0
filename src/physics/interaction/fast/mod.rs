//! The same field as the direct sum's in n log n: near pairs exactly, the smooth rest by a mesh.
//!
//! Ewald splitting (Darden, York & Pedersen, J. Chem. Phys. 98:10089, 1993; Essmann et al., 103:8577, 1995) of a field that is, from afar,
//! `Σ_m c_m/r^(2m+1)`, m = 0 … 3 ([`super::moments`]). As `∇^2m (1/r) = [(2m−1)!!]²/r^(2m+1)` in the plane, the smooth field of a spot is
//! `Σ_m c_m ∇^2m(erf(αr)/r)/[(2m−1)!!]²`: one kernel, whose sources are a spot's load and Laplacians of it. Within the reach `r_c` of a
//! source its field is exact, less the smooth field of its nearest image; the smooth fields of all sources and images come from a mesh.
//!
//! A spot must be small against its reach. So sources form groups by their radii: every group has twice the reach of the one before and
//! a mesh half as fine, and one large spot costs one long list. What is too large for any mesh acts on all by its exact field.

mod mesh;
mod near;
mod plan;

use super::ewald::{IMAGES, ORDERS};
use super::moments::{Moments, product};
use super::pair::{SpotColumns, sag};
use super::{Effort, Interaction, Spots, Tangent};
use crate::model::{Interaction as Kind, Material, Slips};
use mesh::{Level, Reader, Source, Splines, Work, read, splines, transform};
use near::{Found, Group, Measure, Rest, Rows};
use plan::{Accuracy, Plan, ROUGH_ORDERS, ROUGH_WIDTH, WIDTH, mesh_size};
use rayon::prelude::*;
use std::cell::RefCell;
use std::f64::consts::PI;
use std::sync::{Arc, OnceLock};

/// The longest reach, in sides: within it no image but the nearest can lie.
const LONGEST: f64 = 0.45;

/// Reaches to choose from, each `1/√2` of the one before.
const REACHES: usize = 15;

/// What is spent for one pair in a linearisation and the dozen products that follow, in units of one point of a mesh in one transform.
const PAIR_COST: f64 = 8.0;

/// The same for one spot or target, spread and read.
const SPREAD_COST: f64 = 500.0;

/// Targets that one thread takes at a time.
const TOGETHER: usize = 64;

/// Near pairs and a mesh.
#[derive(Debug, Clone)]
pub struct FastSum {
    measure: Measure,
    positions: Vec<[f64; 2]>,
    /// `1/(πE*)` \[1/Pa\].
    compliance: f64,
    accuracy: Accuracy,
    /// What has been made, from the longest reach to the shortest.
    plans: [OnceLock<Arc<Plan>>; REACHES],
}

/// One evaluation: the sources in groups.
struct Field {
    moments: Moments,
    groups: Vec<Group>,
    /// Plans that are in use, the finest first, each with its spots.
    levels: Vec<(Arc<Plan>, Vec<Placed>)>,
}

/// A spot and its place in units of the side.
type Placed = (usize, [f64; 2]);

/// Sources on their meshes and readers there, for displacements or for their derivatives.
#[derive(Debug, Clone, Default)]
struct Meshes<const W: usize, const O: usize> {
    levels: Vec<Level<W, O>>,
    readers: Vec<Reader<W>>,
}

impl<const W: usize, const O: usize> Meshes<W, O> {
    /// Of a field, on its meshes of this `rank` and with the moments given, at targets in units of the side.
    fn new(field: &Field, rank: usize, moments: &[[f64; ORDERS]], targets: &[[f64; 2]]) -> Self {
        let of = |(plan, members): &(Arc<Plan>, Vec<Placed>)| {
            let mesh = plan.meshes[rank].clone();
            let places: Vec<[f64; 2]> = members.iter().map(|member| member.1).collect();
            let splines: Vec<Splines<W, O>> = splines(&places, mesh.size);
            let sources = members.iter().zip(&splines).map(|((j, _), splines)| Source::new(*j, splines, mesh.size, &moments[*j]));
            (mesh.clone(), sources.collect())
        };
        let levels: Vec<Level<W, O>> = field.levels.iter().map(of).collect();
        let readers = levels.first().map_or(Vec::new(), |(mesh, _)| splines::<W, O>(targets, mesh.size).iter().map(Reader::new).collect());
        Self { levels, readers }
    }

    /// Adds the fields at the targets to `values`; each source counts `factors` of its spot, or once.
    fn add(&self, factors: Option<&[f64]>, work: &mut Work, values: &mut [f64]) {
        if let Some((mesh, _)) = self.levels.first() {
            transform(&self.levels, factors, work);
            read(&self.readers, mesh.size, work, values);
        }
    }
}

type Fine = Meshes<WIDTH, ORDERS>;
type Rough = Meshes<ROUGH_WIDTH, ROUGH_ORDERS>;

/// Which of the meshes of a plan.
const FINE: usize = 0;
const ROUGH: usize = 1;

impl FastSum {
    /// Asperities at `positions` \[m\] on the periodic square of side `length_m`; every displacement is right to `tolerance` times the
    /// greatest one. The load of a spot must be the one of its radii by Eq 1; of the
    /// slips only that of Eq 8 is read.
    #[must_use]
    pub fn new(positions: Vec<[f64; 2]>, length_m: f64, material: &Material, kind: Kind, slips: Slips, tolerance: f64) -> Self {
        Self {
            measure: Measure { kind, pull: material.pull(), sag: sag(slips), length: length_m },
            positions,
            compliance: material.compliance(),
            accuracy: Accuracy::of(tolerance),
            plans: [const { OnceLock::new() }; REACHES],
        }
    }

    /// Adds a place \[m\], whose number follows the last one.
    pub(crate) fn add(&mut self, place: [f64; 2]) {
        self.positions.push(place);
    }

    fn reach(step: usize) -> f64 {
        LONGEST * 0.5f64.powf(0.5 * step as f64)
    }

    fn plan(&self, step: usize) -> Arc<Plan> {
        self.plans[step].get_or_init(|| Arc::new(Plan::new(self.accuracy, Self::reach(step)))).clone()
    }

    /// The longest of the reaches `finest`, `finest` − 2, … that a spot of radius `a` \[m\] needs, or nothing if it is too large for all.
    fn level(&self, finest: usize, a: f64) -> Option<usize> {
        let least = if self.measure.kind == Kind::Spots { a / (self.accuracy.girth * self.measure.length) } else { 0.0 };
        (0..=finest / 2).map(|k| finest - 2 * k).find(|step| Self::reach(*step) >= least)
    }

    /// The finest reach that costs least, by the radii of the spots and the number of targets.
    fn finest(&self, columns: &SpotColumns, targets: usize) -> usize {
        let cost = |finest: usize| {
            let mut counts = [0usize; REACHES];
            let mut large = 0;
            for a in &columns.a[..columns.len()] {
                match self.level(finest, *a) {
                    Some(step) => counts[step] += 1,
                    None => large += 1,
                }
            }
            counts[finest] = counts[finest].max(1);
            let mut cost = PAIR_COST * (targets * large) as f64 + SPREAD_COST * (columns.len() + targets) as f64;
            for (step, count) in counts.iter().enumerate().filter(|(_, count)| **count > 0) {
                let reach = Self::reach(step);
                let mesh = mesh_size(self.accuracy, reach) as f64;
                cost += PAIR_COST * PI * reach * reach * (count * targets) as f64 + mesh * mesh * mesh.log2() * 2.0;
            }
            cost
        };
        (0..REACHES).map(|step| (step, cost(step))).min_by(|(_, a), (_, b)| a.total_cmp(b)).map_or(0, |(step, _)| step)
    }

    /// Sources in groups for so many targets.
    fn field(&self, spots: &Spots, targets: usize) -> Field {
        let columns = &spots.columns;
        let Measure { kind, pull, length, .. } = self.measure;
        let moments = Moments::of(kind, columns, pull, self.compliance, length);
        let finest = self.finest(columns, targets);
        let mut members: [Vec<usize>; REACHES] = Default::default();
        let mut large = Vec::new();
        for (j, a) in columns.a[..columns.len()].iter().enumerate() {
            self.level(finest, *a).map_or(&mut large, |step| &mut members[step]).push(j);
        }
        let (mut groups, mut levels) = (Vec::new(), Vec::new());
        for (step, members) in members.into_iter().enumerate().rev() {
            if !members.is_empty() {
                let plan = self.plan(step);
                groups.push(Group::new(Rest::Mesh(plan.clone()), &members, columns, &moments, length));
                let placed = members.iter().map(|j| (*j, [columns.x[*j] / length, columns.y[*j] / length]));
                levels.push((plan, placed.collect()));
            }
        }
        if !large.is_empty() {
            groups.push(Group::new(Rest::Images, &large, columns, &moments, length));
        }
        Field { moments, groups, levels }
    }

    /// Places of targets in units of the side.
    fn places(&self, targets: &[usize]) -> Vec<[f64; 2]> {
        targets.iter().map(|t| self.positions[*t].map(|p| p / self.measure.length)).collect()
    }

    /// Near fields of all targets, in parallel and in their order: so many targets by each of the rows.
    fn near<const SLOPES: bool>(&self, field: &Field, targets: &[usize], effort: &mut Effort) -> Vec<Rows> {
        let rows = |found: &mut Found, targets: &[usize]| {
            let mut rows = Rows::default();
            for target in targets {
                rows.starts.push(rows.slopes.len());
                let sums = field.groups.iter().map(|group| group.add::<SLOPES>(self.measure, self.positions[*target], found, &mut rows));
                let sum = sums.sum();
                rows.sums.push(sum);
            }
            rows.starts.push(rows.slopes.len());
            rows
        };
        let all: Vec<Rows> = targets.par_chunks(TOGETHER).map_init(Found::default, rows).collect();
        effort.pairs += all.iter().map(|rows| rows.pairs).sum::<u64>();
        all
    }
}

impl Interaction for FastSum {
    fn displacements(&self, spots: &Spots, targets: &[usize], displacements: &mut Vec<f64>, effort: &mut Effort) {
        displacements.clear();
        if self.measure.kind == Kind::None || spots.index.is_empty() {
            displacements.resize(targets.len(), 0.0);
            return;
        }
        let field = self.field(spots, targets.len());
        displacements.extend(self.near::<false>(&field, targets, effort).iter().flat_map(|rows| &rows.sums));
        Fine::new(&field, FINE, &field.moments.value, &self.places(targets)).add(None, &mut Work::default(), displacements);
    }

    fn approach(
        &self,
        spots: &Spots,
        rates: &[f64],
        targets: &[usize],
        displacements: &mut Vec<f64>,
        slopes: &mut Vec<f64>,
        effort: &mut Effort,
    ) {
        displacements.clear();
        slopes.clear();
        if self.measure.kind == Kind::None || spots.index.is_empty() {
            displacements.resize(targets.len(), 0.0);
            slopes.resize(targets.len(), 0.0);
            return;
        }
        let field = self.field(spots, targets.len());
        for rows in self.near::<true>(&field, targets, effort) {
            displacements.extend_from_slice(&rows.sums);
            slopes.extend(rows.starts.windows(2).map(|ends| {
                let entries = rows.slopes[ends[0]..ends[1]].iter().zip(&rows.spots[ends[0]..ends[1]]);
                entries.map(|(slope, j)| slope * rates[*j as usize]).sum::<f64>()
            }));
        }
        let (mut work, places) = (Work::default(), self.places(targets));
        Fine::new(&field, FINE, &field.moments.value, &places).add(None, &mut work, displacements);
        Rough::new(&field, ROUGH, &field.moments.slope, &places).add(Some(rates), &mut work, slopes);
    }

    fn linearise(&self, spots: &Spots, displacements: &mut Vec<f64>, tangent: &mut Tangent, effort: &mut Effort) {
        displacements.clear();
        if self.measure.kind == Kind::None || spots.index.is_empty() {
            displacements.resize(spots.index.len(), 0.0);
            let zeros = tangent.take_dense(spots.index.len());
            tangent.set_dense(spots.index.len(), zeros);
            return;
        }
        let field = self.field(spots, spots.index.len());
        let mut sparse = tangent.take_sparse();
        sparse.starts.clear();
        sparse.columns.clear();
        sparse.values.clear();
        sparse.starts.push(0);
        for rows in self.near::<true>(&field, &spots.index, effort) {
            displacements.extend_from_slice(&rows.sums);
            let before = sparse.values.len();
            sparse.columns.extend_from_slice(&rows.spots);
            sparse.values.extend_from_slice(&rows.slopes);
            sparse.starts.extend(rows.starts[1..].iter().map(|end| before + end));
        }
        let own = IMAGES.sums(0.0, 0.0);
        sparse.own = field.moments.slope.iter().map(|slope| product(&own, slope)).collect();
        let places = self.places(&spots.index);
        Fine::new(&field, FINE, &field.moments.value, &places).add(None, sparse.work.get_mut(), displacements);
        sparse.far = Rough::new(&field, ROUGH, &field.moments.slope, &places);
        tangent.set_sparse(sparse);
    }
}

/// `∂ŵ/∂a` as near pairs and a mesh.
#[derive(Debug, Clone, Default)]
pub(super) struct Sparse {
    /// First entry of each row, and one past the last of all; the spot and the value of each entry.
    starts: Vec<usize>,
    columns: Vec<u32>,
    values: Vec<f64>,
    own: Vec<f64>,
    far: Rough,
    work: RefCell<Work>,
}

impl Sparse {
    pub(super) fn product(&self, x: &[f64], y: &mut [f64]) {
        for (ends, yi) in self.starts.windows(2).zip(y.iter_mut()) {
            let mut strands = [0.0; 4];
            let (columns, values) = (&self.columns[ends[0]..ends[1]], &self.values[ends[0]..ends[1]]);
            let ((columns, left), (values, over)) = (columns.as_chunks::<4>(), values.as_chunks::<4>());
            for (column, value) in columns.iter().zip(values) {
                for k in 0..4 {
                    strands[k] += value[k] * x[column[k] as usize];
                }
            }
            for (column, value) in left.iter().zip(over) {
                strands[0] += value * x[*column as usize];
            }
            *yi = strands.iter().sum();
        }
        self.far.add(Some(x), &mut self.work.borrow_mut(), y);
    }

    pub(super) fn own(&self, i: usize) -> f64 {
        self.own[i]
    }
}
