//! Where spots and targets lie to one another: all of the field that does not depend on the radii.

use super::super::Spots;
use super::super::ewald::ORDERS;
use super::mesh::{Level, Loads, Reader, Real, Work, read, splines, transform};
use super::near::{Group, Rest};
use super::pairs::{Pairs, Sources};
use super::plan::{Accuracy, Mesh, Plan, ROUGH_ORDERS, ROUGH_WIDTH, WIDTH};
use super::{Effort, FastSum, MARGIN, REACHES, level};
use rayon::prelude::*;
use std::sync::Arc;

/// Targets that one thread takes at a time.
const TOGETHER: usize = 64;

/// Near pairs of all targets, sources on meshes and readers there.
#[derive(Debug, Clone, Default)]
pub(super) struct Geometry {
    /// Of which spots, where, and up to which radii it serves \[m\].
    index: Vec<usize>,
    places: Vec<[f64; 2]>,
    limits: Vec<f64>,
    accuracy: Option<Accuracy>,
    /// So many targets by each, in their order.
    pairs: Vec<Pairs>,
    fine: Meshes<f64, WIDTH, ORDERS>,
    rough: Meshes<f32, ROUGH_WIDTH, ROUGH_ORDERS>,
}

impl FastSum {
    /// Finds the geometry of spots and targets.
    pub(super) fn place(&self, spots: &Spots, targets: &[usize], geometry: &mut Geometry) {
        let columns = &spots.columns;
        let length = self.measure.length;
        geometry.index.clone_from(&spots.index);
        geometry.places = (0..columns.len()).map(|j| [columns.x[j], columns.y[j]]).collect();
        geometry.limits = columns.a[..columns.len()].iter().map(|a| MARGIN * a).collect();
        geometry.accuracy = Some(self.accuracy);
        let shortest: Vec<Option<usize>> = geometry.limits.iter().map(|limit| self.shortest(*limit)).collect();
        let finest = self.finest(&shortest, columns, targets.len());
        let mut members: [Vec<usize>; REACHES] = Default::default();
        let mut large = Vec::new();
        for (j, shortest) in shortest.iter().enumerate() {
            shortest.and_then(|shortest| level(finest, shortest)).map_or(&mut large, |step| &mut members[step]).push(j);
        }
        let (mut groups, mut levels) = (Vec::new(), Vec::new());
        for (step, members) in members.into_iter().enumerate().rev() {
            if !members.is_empty() {
                let plan = self.plan(step);
                groups.push(Group::new(Rest::Mesh(plan.clone()), &members, columns, length));
                levels.push((plan, members));
            }
        }
        if !large.is_empty() {
            groups.push(Group::new(Rest::Images, &large, columns, length));
        }
        // By its moments a spot is felt that is felt by nothing else: with point interaction all are.
        let aloof = if self.measure.kind == super::Kind::Spots { self.accuracy.aloof } else { 0.0 };
        let aloof: Vec<f64> = geometry.limits.iter().map(|limit| aloof * limit).collect();
        geometry.pairs.resize_with(targets.len().div_ceil(TOGETHER), Pairs::default);
        geometry.pairs.par_iter_mut().zip(targets.par_chunks(TOGETHER)).for_each(|(pairs, targets)| {
            pairs.find(targets.iter().map(|target| self.positions[*target]), &groups, self.measure, &aloof);
        });
        let targets: Vec<[f64; 2]> = targets.iter().map(|target| self.positions[*target].map(|p| p / length)).collect();
        let sources: Vec<[f64; 2]> = geometry.places.iter().map(|place| place.map(|p| p / length)).collect();
        geometry.fine = Meshes::new(&levels, |plan| &plan.fine, &sources, &targets);
        geometry.rough = Meshes::new(&levels, |plan| &plan.rough, &sources, &targets);
    }
}

impl Geometry {
    /// Whether it is that of the spots at themselves, and none of them has grown too large for it.
    pub(super) fn serves(&self, field: &FastSum, spots: &Spots) -> bool {
        let columns = &spots.columns;
        let place = |j: usize| [columns.x[j], columns.y[j]];
        self.accuracy == Some(field.accuracy)
            && self.index == spots.index
            && self.places.iter().enumerate().all(|(j, known)| *known == place(j))
            && self.limits.iter().zip(&columns.a).all(|(limit, a)| a <= limit)
    }

    pub(super) fn forget(&mut self) {
        self.accuracy = None;
    }

    fn count(&self, effort: &mut Effort) {
        effort.pairs += self.pairs.iter().map(|pairs| pairs.len() as u64).sum::<u64>();
    }

    /// Displacements at the targets.
    pub(super) fn displacements(&self, sources: Sources<'_>, work: &mut Work<f64>, values: &mut [f64], effort: &mut Effort) {
        self.count(effort);
        self.pairs.par_iter().zip(values.par_chunks_mut(TOGETHER)).for_each(|(pairs, values)| pairs.sums(sources, values));
        self.fine.add(Loads { moments: &sources.moments.value, factors: None }, work, values);
    }

    /// The same, and the derivatives for [`Self::product`].
    pub(super) fn linearise(&mut self, sources: Sources<'_>, work: &mut Work<f64>, values: &mut [f64], effort: &mut Effort) {
        self.count(effort);
        self.pairs.par_iter_mut().zip(values.par_chunks_mut(TOGETHER)).for_each(|(pairs, values)| pairs.linearise(sources, values));
        self.fine.add(Loads { moments: &sources.moments.value, factors: None }, work, values);
    }

    /// Derivatives times a vector, the factors of the loads.
    pub(super) fn product(&self, loads: Loads<'_>, work: &mut Work<f32>, values: &mut [f64]) {
        let Some(x) = loads.factors else { return };
        self.pairs.par_iter().zip(values.par_chunks_mut(TOGETHER)).for_each(|(pairs, values)| pairs.product(x, values));
        self.rough.add(loads, work, values);
    }
}

/// Sources on their meshes and readers there, for displacements or for their derivatives.
#[derive(Debug, Clone)]
struct Meshes<T, const W: usize, const O: usize> {
    levels: Vec<Level<T, W, O>>,
    readers: Vec<Reader<T, W>>,
}

impl<T, const W: usize, const O: usize> Default for Meshes<T, W, O> {
    fn default() -> Self {
        Self { levels: Vec::new(), readers: Vec::new() }
    }
}

impl<T: Real, const W: usize, const O: usize> Meshes<T, W, O> {
    /// Of sources by their plans, the finest first, on one of the `meshes` of these, at targets; all places in units of the side.
    fn new(levels: &[(Arc<Plan>, Vec<usize>)], mesh: impl Fn(&Plan) -> &Arc<Mesh<T>>, sources: &[[f64; 2]], targets: &[[f64; 2]]) -> Self {
        let of = |(plan, members): &(Arc<Plan>, Vec<usize>)| {
            let mesh = mesh(plan).clone();
            let places: Vec<[f64; 2]> = members.iter().map(|j| sources[*j]).collect();
            let splines = splines(&places, mesh.size);
            (mesh, (members.clone(), splines))
        };
        let levels: Vec<Level<T, W, O>> = levels.iter().map(of).collect();
        let readers =
            levels.first().map_or(Vec::new(), |(mesh, _)| splines::<T, W, O>(targets, mesh.size).iter().map(Reader::new).collect());
        Self { levels, readers }
    }

    /// Adds the fields at the targets to `values`.
    fn add(&self, loads: Loads<'_>, work: &mut Work<T>, values: &mut [f64]) {
        if let Some((mesh, _)) = self.levels.first() {
            transform(&self.levels, loads, work);
            read(&self.readers, mesh.size, work, values);
        }
    }
}
