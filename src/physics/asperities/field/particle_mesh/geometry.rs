//! Geometry of the fast sum: the part that does not depend on the contact radii.

use super::mesh::{Level, Loads, PlacedSources, Reader, Work, read, splines, transform};
use super::near::{Group, Rest};
use super::pairs::{GONE, Known, Pairs, Sources, TARGETS_PER_CHUNK, Target};
use super::plan::Real;
use super::plan::{Accuracy, INTERMEDIATE_ORDERS, INTERMEDIATE_WIDTH, Mesh, Plan, WIDTH};
use super::{CUTOFF_COUNT, FastSum, MARGIN};
use crate::asperities::field::ewald::ORDERS;
use crate::asperities::field::{Spots, places_in};
use crate::cycle::Effort;
use rayon::prelude::*;
use std::sync::Arc;

/// Relative change of the number of spots or targets beyond which the geometry is rebuilt.
const MAX_CHANGE: f64 = 0.2;

/// Maximum ratio of a spot's radius limit to the limit that a rebuild would assign.
const MAX_LOOSENESS: f64 = 2.0;

/// Number of targets from which on their chunks are distributed over threads, and number of chunks that one
/// thread takes at least: fewer cost less than waking another thread.
const PARALLEL_TARGETS: usize = 2048;
const MIN_CHUNKS: usize = 16;

/// Near pairs of all targets, and mesh weights of sources and targets.
#[derive(Debug, Clone, Default)]
pub(super) struct Geometry {
    /// Spots by rank, their positions and radius limits \[m\], and the targets.
    ///
    /// The geometry is valid up to these radii.
    index: Vec<usize>,
    places: Vec<[f64; 2]>,
    limits: Vec<f64>,
    targets: Vec<usize>,
    accuracy: Option<Accuracy>,
    /// Finest cutoff, and the numbers of spots and targets for which it was chosen.
    finest: usize,
    chosen_for: [usize; 2],
    /// Near pairs in chunks of [`TARGETS_PER_CHUNK`] targets, and those of the previous geometry.
    pairs: Vec<Pairs>,
    old: Vec<Pairs>,
    fine: Meshes<f64, WIDTH, ORDERS>,
    rough: Meshes<f32, INTERMEDIATE_WIDTH, INTERMEDIATE_ORDERS>,
}

/// Finds the pairs of all targets in chunks, in parallel if there are many; `find` is given the place of the
/// first target of its chunk.
fn find_in_chunks(
    all: &mut Vec<Pairs>,
    targets: &[usize],
    find: impl Fn(&mut Pairs, usize, &[usize]) + Sync,
) {
    all.resize_with(targets.len().div_ceil(TARGETS_PER_CHUNK), Pairs::default);
    let of_chunk = |((chunk, pairs), targets): ((usize, &mut Pairs), &[usize])| {
        find(pairs, chunk * TARGETS_PER_CHUNK, targets);
    };
    if targets.len() < PARALLEL_TARGETS {
        all.iter_mut().enumerate().zip(targets.chunks(TARGETS_PER_CHUNK)).for_each(of_chunk);
    } else {
        let chunks = all.par_iter_mut().enumerate().zip(targets.par_chunks(TARGETS_PER_CHUNK));
        chunks.with_min_len(MIN_CHUNKS).for_each(of_chunk);
    }
}

impl FastSum {
    /// Updates the geometry for spots and targets, both by rank.
    ///
    /// Entries of the previous geometry are reused where they are valid.
    pub(super) fn place(&self, spots: &Spots, targets: &[usize], geometry: &mut Geometry) {
        let columns = &spots.columns;
        let length = self.measure.length;
        let kept = geometry.keep(self, spots, targets);
        let shortest: Vec<Option<usize>> =
            geometry.limits.iter().map(|limit| self.shortest(*limit)).collect();
        if kept.is_none() {
            geometry.finest = self.finest(&shortest, columns, targets.len());
            geometry.chosen_for = [spots.index.len(), targets.len()];
        }
        let finest = geometry.finest;
        let mut members: [Vec<usize>; CUTOFF_COUNT] = Default::default();
        let mut large = Vec::new();
        for (j, shortest) in shortest.iter().enumerate() {
            shortest
                .and_then(|shortest| self.level(finest, shortest))
                .map_or(&mut large, |step| &mut members[step])
                .push(j);
        }
        let changed = |members: &[usize]| match &kept {
            Some(kept) => members.iter().copied().filter(|j| !kept.stays[*j]).collect(),
            None => Vec::new(),
        };
        let (mut all, mut others, mut levels) = (Vec::new(), Vec::new(), Vec::new());
        let mut group = |rest: Rest, members: &[usize]| {
            let few: Vec<usize> = changed(members);
            if !few.is_empty() {
                others.push(Group::new(rest.clone(), &few, columns, length));
            }
            all.push(Group::new(rest, members, columns, length));
        };
        for (step, members) in members.into_iter().enumerate().rev() {
            if !members.is_empty() {
                let plan = self.plan(step);
                group(Rest::Mesh(plan.clone()), &members);
                levels.push((plan, members));
            }
        }
        if !large.is_empty() {
            group(Rest::Images, &large);
        }
        // With point interaction, every source acts by its moments only.
        let aloof = if self.measure.kind == super::Kind::Spots { self.accuracy.aloof } else { 0.0 };
        let aloof: Vec<f64> = geometry.limits.iter().map(|limit| aloof * limit).collect();
        std::mem::swap(&mut geometry.pairs, &mut geometry.old);
        let before = kept.as_ref().map(|kept| kept.targets.as_slice());
        let numbers = kept.as_ref().map_or(&[][..], |kept| &kept.numbers);
        let known = Known { pairs: &geometry.old, numbers, changed: &others };
        let find = |pairs: &mut Pairs, first: usize, targets: &[usize]| {
            let target = |(k, target): (usize, &usize)| Target {
                place: self.order.positions[*target],
                before: before.and_then(|before| before[first + k]),
            };
            pairs.find(targets.iter().enumerate().map(target), known, &all, self.measure, &aloof);
        };
        find_in_chunks(&mut geometry.pairs, targets, find);
        self.place_meshes(&levels, targets, kept.as_ref(), geometry);
    }

    /// Weights of spots and targets on the meshes.
    fn place_meshes(
        &self,
        levels: &[(Arc<Plan>, Vec<usize>)],
        targets: &[usize],
        kept: Option<&Kept>,
        geometry: &mut Geometry,
    ) {
        let length = self.measure.length;
        geometry.targets.clear();
        geometry.targets.extend_from_slice(targets);
        let targets: Vec<[f64; 2]> =
            targets.iter().map(|target| self.order.positions[*target].map(|p| p / length)).collect();
        let sources: Vec<[f64; 2]> = geometry.places.iter().map(|place| place.map(|p| p / length)).collect();
        geometry.fine.renew(levels, |plan| &plan.fine, &sources, &targets, kept);
        geometry.rough.renew(levels, |plan| &plan.rough, &sources, &targets, kept);
    }
}

/// Parts of the previous geometry that are still valid.
struct Kept {
    /// For each spot, whether its entries are valid.
    stays: Vec<bool>,
    /// New numbers of the previous spots.
    numbers: Vec<u32>,
    /// Previous number of each target.
    targets: Vec<Option<usize>>,
}

impl Geometry {
    /// Replaces spots and targets; returns the parts that are still valid, if most are.
    fn keep(&mut self, field: &FastSum, spots: &Spots, targets: &[usize]) -> Option<Kept> {
        let columns = &spots.columns;
        let near = |now: usize, then: usize| (now as f64 - then as f64).abs() <= MAX_CHANGE * then as f64;
        let same = self.accuracy == Some(field.accuracy);
        let serves =
            same && near(spots.index.len(), self.chosen_for[0]) && near(targets.len(), self.chosen_for[1]);
        let places: Vec<[f64; 2]> = (0..columns.len()).map(|j| [columns.x[j], columns.y[j]]).collect();
        let mut kept = serves.then(|| Kept {
            stays: vec![false; spots.index.len()],
            numbers: vec![GONE; self.index.len()],
            targets: places_in(targets, &self.targets).collect(),
        });
        let mut limits: Vec<f64> = columns.a[..columns.len()].iter().map(|a| MARGIN * a).collect();
        if let Some(kept) = &mut kept {
            for (j, before) in places_in(&spots.index, &self.index).enumerate() {
                let Some(before) = before else { continue };
                let limit = self.limits[before];
                if self.places[before] == places[j]
                    && (columns.a[j]..MAX_LOOSENESS * limits[j]).contains(&limit)
                {
                    (kept.stays[j], kept.numbers[before], limits[j]) = (true, j as u32, limit);
                }
            }
        }
        self.index.clone_from(&spots.index);
        (self.places, self.limits, self.accuracy) = (places, limits, Some(field.accuracy));
        kept
    }

    /// True if the geometry belongs to these spots and every radius is within its limit.
    pub(super) fn serves(&self, field: &FastSum, spots: &Spots) -> bool {
        let columns = &spots.columns;
        let place = |j: usize| [columns.x[j], columns.y[j]];
        self.accuracy == Some(field.accuracy)
            && self.index == spots.index
            && self.places.iter().enumerate().all(|(j, known)| *known == place(j))
            && self.limits.iter().zip(&columns.a).all(|(limit, a)| a <= limit)
    }

    fn count(&self, effort: &mut Effort) {
        effort.pairs += self.pairs.iter().map(|pairs| pairs.len() as u64).sum::<u64>();
        effort.transforms += self.transforms();
    }

    /// Number of mesh transforms: one per mesh forward, and one inverse of the finest.
    pub(super) fn transforms(&self) -> u64 {
        match self.fine.levels.len() {
            0 => 0,
            meshes => meshes as u64 + 1,
        }
    }

    /// Displacements at the targets.
    pub(super) fn displacements(
        &self,
        sources: &Sources,
        work: &mut Work<f64>,
        values: &mut [f64],
        effort: &mut Effort,
    ) {
        self.count(effort);
        for_chunks(&self.pairs, values, |pairs, values| pairs.sums(sources, values));
        self.fine.add(Loads { moments: &sources.moments.value, factors: None }, work, values);
    }

    /// Displacements at the targets, and the derivatives for [`Self::product`].
    pub(super) fn linearise(
        &mut self,
        sources: &Sources,
        work: &mut Work<f64>,
        values: &mut [f64],
        effort: &mut Effort,
    ) {
        self.count(effort);
        for_chunks(&mut self.pairs, values, |pairs, values| pairs.linearise(sources, values));
        self.fine.add(Loads { moments: &sources.moments.value, factors: None }, work, values);
    }

    /// Product of the derivatives with the load factors, on the fine meshes.
    ///
    /// Its precision is that of displacements, except for near pairs, whose derivatives have seven digits.
    pub(super) fn fine_product(&self, loads: Loads<'_>, work: &mut Work<f64>, values: &mut [f64]) {
        let Some(x) = loads.factors else { return };
        for_chunks(&self.pairs, values, |pairs, values| pairs.product(x, values));
        self.fine.add(loads, work, values);
    }

    /// Product of the derivatives with the load factors, with the precision of a linear solve.
    pub(super) fn product(&self, loads: Loads<'_>, work: &mut Work<f32>, values: &mut [f64]) {
        let Some(x) = loads.factors else { return };
        for_chunks(&self.pairs, values, |pairs, values| pairs.product(x, values));
        self.rough.add(loads, work, values);
    }
}

/// Applies an operation to each chunk of targets and their values, on several threads if there are many.
fn for_chunks<P>(pairs: P, values: &mut [f64], each: impl Fn(<P as IntoIterator>::Item, &mut [f64]) + Sync)
where
    P: IntoIterator<Item: Send>
        + IntoParallelIterator<Item = <P as IntoIterator>::Item, Iter: IndexedParallelIterator>,
{
    if values.len() < PARALLEL_TARGETS {
        pairs
            .into_iter()
            .zip(values.chunks_mut(TARGETS_PER_CHUNK))
            .for_each(|(pairs, values)| each(pairs, values));
    } else {
        let chunks =
            pairs.into_par_iter().zip(values.par_chunks_mut(TARGETS_PER_CHUNK)).with_min_len(MIN_CHUNKS);
        chunks.for_each(|(pairs, values)| each(pairs, values));
    }
}

/// Weights of sources and targets on the meshes, for displacements or for derivatives.
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
    /// Weights of sources by their plans, the finest first, and of targets, in units of the side. Those of
    /// kept ones stay.
    ///
    /// `mesh` selects one of the meshes of a plan.
    fn renew(
        &mut self,
        levels: &[(Arc<Plan>, Vec<usize>)],
        mesh: impl Fn(&Plan) -> &Arc<Mesh<T>>,
        sources: &[[f64; 2]],
        targets: &[[f64; 2]],
        kept: Option<&Kept>,
    ) {
        let old = std::mem::take(self);
        for (plan, members) in levels {
            let mesh = mesh(plan);
            let mut before = vec![None; sources.len()];
            let mut weights = &[][..];
            if let (Some(kept), Some(known)) =
                (kept, old.levels.iter().find(|old| Arc::ptr_eq(&old.mesh, mesh)))
            {
                weights = &known.sources.weights;
                for (k, spot) in known.sources.numbers.iter().enumerate() {
                    // The number of a source that is gone is beyond the end.
                    if let Some(before) = before.get_mut(kept.numbers[*spot] as usize) {
                        *before = Some(k);
                    }
                }
            }
            let places = members.iter().map(|j| (before[*j], sources[*j]));
            let weights = completed(weights, places, |places| splines(places, mesh.size));
            self.levels.push(Level {
                mesh: mesh.clone(),
                sources: PlacedSources { numbers: members.clone(), weights },
            });
        }
        if let Some(Level { mesh, .. }) = self.levels.first() {
            let same = old.levels.first().is_some_and(|old| Arc::ptr_eq(&old.mesh, mesh));
            let kept = kept.filter(|_| same);
            let places =
                targets.iter().enumerate().map(|(k, place)| (kept.and_then(|kept| kept.targets[k]), *place));
            self.readers = completed(&old.readers, places, |places| {
                splines(places, mesh.size).iter().map(Reader::new).collect()
            });
        }
    }

    /// Adds the fields at the targets to `values`.
    fn add(&self, loads: Loads<'_>, work: &mut Work<T>, values: &mut [f64]) {
        if let Some(Level { mesh, .. }) = self.levels.first() {
            transform(&self.levels, loads, work);
            read(&self.readers, mesh.size, work, values);
        }
    }
}

/// Weights of places: from `known` for places that have a position there, from `find` for the others.
fn completed<A: Copy>(
    known: &[A],
    places: impl Iterator<Item = (Option<usize>, [f64; 2])> + Clone,
    find: impl FnOnce(&[[f64; 2]]) -> Vec<A>,
) -> Vec<A> {
    let unknown: Vec<[f64; 2]> =
        places.clone().filter(|(before, _)| before.is_none()).map(|(_, place)| place).collect();
    let mut found = find(&unknown).into_iter();
    let mut all = Vec::with_capacity(places.clone().count());
    // Known ones that follow one another are copied at once.
    let mut run = 0..0;
    for (before, _) in places {
        if before == Some(run.end) {
            run.end += 1;
            continue;
        }
        all.extend_from_slice(&known[run]);
        run = before.map_or(0..0, |before| before..before + 1);
        if before.is_none() {
            all.extend(found.next());
        }
    }
    all.extend_from_slice(&known[run]);
    all
}
