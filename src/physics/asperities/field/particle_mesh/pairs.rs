//! Near pairs: data that depend on the positions alone, reused while the same spots are in contact.
//!
//! Beyond several radii a spot acts by its moments, four numbers per pair. Nearer spots act by their exact
//! fields.

use super::near::{Found, Group, Measure};
use crate::asperities::field::ewald::ORDERS;
use crate::asperities::field::multipole::{Moments, product};
use crate::asperities::field::spot_field::{AWAY, LANES, field_at};
use multiversion::multiversion;

/// Shape of a source for the exact field: a, √a, 1/√a and 1/R.
pub(super) type Shape = [f64; 4];

/// All sources, indexed by number.
#[derive(Debug)]
pub(super) struct Sources {
    pub(super) measure: Measure,
    pub(super) shapes: Vec<Shape>,
    pub(super) moments: Moments,
}

/// Number of targets in one parallel chunk.
pub(super) const TARGETS_PER_CHUNK: usize = 64;

/// Marks a source that is no longer valid.
pub(super) const GONE: u32 = u32::MAX;

/// A target, and its number in the previous search, if any.
#[derive(Debug, Clone, Copy)]
pub(super) struct Target {
    pub(super) place: [f64; 2],
    pub(super) before: Option<usize>,
}

/// Result of the previous search: pairs by chunk, new numbers of the sources, and changed sources.
#[derive(Clone, Copy)]
pub(super) struct Known<'a> {
    pub(super) pairs: &'a [Pairs],
    pub(super) numbers: &'a [u32],
    pub(super) changed: &'a [Group],
}

/// Near pairs of a chunk of targets.
///
/// The entries of a target are its sources: first those with exact fields, then those with moments.
#[derive(Debug, Clone, Default)]
pub(super) struct Pairs {
    /// First entry of each target, and number of exact entries before it.
    ///
    /// The last entries are the totals.
    starts: Vec<usize>,
    exact: Vec<usize>,
    /// Source of each entry, and the last computed derivative to its radius.
    spots: Vec<u32>,
    slopes: Vec<f32>,
    /// Exact entries: distance, and factors of the moments that subtract the mesh field.
    r: Vec<f64>,
    rest: Vec<[f64; ORDERS]>,
    /// Moment entries: factors of the moments, and the rounding residual of the first one.
    /// The higher orders contribute a hundredth or less.
    kernel: Vec<[f32; ORDERS]>,
    low: Vec<f32>,
    /// Moment entries of the current target, appended after the exact ones.
    waiting: Vec<u32>,
}

impl Pairs {
    /// Searches the near pairs of targets.
    ///
    /// Source k acts by its moments from `aloof[k]` \[m\] on.
    pub(super) fn find(
        &mut self,
        targets: impl Iterator<Item = Target>,
        known: Known<'_>,
        all: &[Group],
        measure: Measure,
        aloof: &[f64],
    ) {
        self.starts.clear();
        self.exact.clear();
        self.spots.clear();
        self.r.clear();
        self.rest.clear();
        self.kernel.clear();
        self.low.clear();
        let (mut found, mut rests) = (Found::default(), Vec::new());
        for Target { place, before } in targets {
            self.starts.push(self.spots.len());
            self.exact.push(self.r.len());
            self.waiting.clear();
            let groups = before.map_or(all, |target| {
                self.take(known, target);
                known.changed
            });
            for group in groups {
                group.find(measure, place, &mut found);
                enter(self, group, measure, place, &found, aloof, &mut rests);
            }
            self.spots.extend_from_slice(&self.waiting);
        }
        self.starts.push(self.spots.len());
        self.exact.push(self.r.len());
    }

    /// Copies the entries of a target whose sources are still valid.
    fn take(&mut self, known: Known<'_>, target: usize) {
        let (old, k) = (&known.pairs[target / TARGETS_PER_CHUNK], target % TARGETS_PER_CHUNK);
        let exact = old.exact[k]..old.exact[k + 1];
        let (from, to) = (old.starts[k], old.starts[k + 1]);
        let middle = from + exact.len();
        let far = from - exact.start..to - exact.end;
        let number = |spot: &u32| known.numbers[*spot as usize];
        if !old.spots[from..to].iter().any(|spot| number(spot) == GONE) {
            self.spots.extend(old.spots[from..middle].iter().map(number));
            self.r.extend_from_slice(&old.r[exact.clone()]);
            self.rest.extend_from_slice(&old.rest[exact]);
            self.waiting.extend(old.spots[middle..to].iter().map(number));
            self.kernel.extend_from_slice(&old.kernel[far.clone()]);
            self.low.extend_from_slice(&old.low[far]);
            return;
        }
        self.reserve(to - from);
        for (spot, at) in
            old.spots[from..middle].iter().map(number).zip(exact).filter(|(spot, _)| *spot != GONE)
        {
            self.push_exact(spot, old.r[at], old.rest[at]);
        }
        for (spot, at) in old.spots[middle..to].iter().map(number).zip(far).filter(|(spot, _)| *spot != GONE)
        {
            self.push_far(spot, old.kernel[at], old.low[at]);
        }
    }

    /// Adds a source with its exact field.
    #[inline(always)]
    fn push_exact(&mut self, spot: u32, r: f64, rest: [f64; ORDERS]) {
        self.spots.push(spot);
        self.r.push(r);
        self.rest.push(rest);
    }

    /// Adds a source with its moments, after the exact ones.
    #[inline(always)]
    fn push_far(&mut self, spot: u32, kernel: [f32; ORDERS], low: f32) {
        self.waiting.push(spot);
        self.kernel.push(kernel);
        self.low.push(low);
    }

    /// Reserves memory for the entries of one target.
    fn reserve(&mut self, count: usize) {
        self.spots.reserve(count);
        self.r.reserve(count);
        self.rest.reserve(count);
        self.kernel.reserve(count);
        self.low.reserve(count);
        self.waiting.reserve(count);
    }

    /// Number of entries.
    pub(super) fn len(&self) -> usize {
        self.spots.len()
    }

    /// Displacements at the targets, one after another.
    pub(super) fn sums(&self, sources: &Sources, values: &mut [f64]) {
        evaluate::<false>(self, sources, values, &mut []);
    }

    /// Displacements at the targets, and the derivatives of all entries.
    pub(super) fn linearise(&mut self, sources: &Sources, values: &mut [f64]) {
        let mut slopes = std::mem::take(&mut self.slopes);
        slopes.resize(self.spots.len(), 0.0);
        evaluate::<true>(self, sources, values, &mut slopes);
        self.slopes = slopes;
    }

    /// Product of the derivatives with a vector, at the targets.
    pub(super) fn product(&self, x: &[f64], y: &mut [f64]) {
        multiply(&self.starts, &self.spots, &self.slopes, x, y);
    }
}

/// Adds the sources found near a target.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn enter(
    pairs: &mut Pairs,
    group: &Group,
    measure: Measure,
    place: [f64; 2],
    found: &Found,
    aloof: &[f64],
    rests: &mut Vec<[f64; ORDERS]>,
) {
    let length = measure.length;
    pairs.reserve(found.numbers.len());
    // All factors first, in a loop without branches.
    rests.clear();
    rests.extend(
        found
            .numbers
            .iter()
            .zip(&found.r2)
            .map(|(number, square)| group.rest_at(measure, place, *number, *square)),
    );
    for ((&number, &square), &rest) in found.numbers.iter().zip(&found.r2).zip(&*rests) {
        let spot = group.spots[number];
        // A spot does not act on its own centre: its distance is set to `AWAY`, and the mesh field is
        // subtracted in full precision.
        let r = if square > 0.0 { square.sqrt() } else { AWAY };
        if r < aloof[spot] || square == 0.0 {
            pairs.push_exact(spot as u32, r, rest);
        } else {
            let mut power = length / r;
            let unit2 = power * power;
            let mut kernel = rest;
            for factor in &mut kernel {
                *factor += power;
                power *= unit2;
            }
            let short = kernel.map(|factor| factor as f32);
            pairs.push_far(spot as u32, short, (kernel[0] - f64::from(short[0])) as f32);
        }
    }
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn evaluate<const SLOPES: bool>(pairs: &Pairs, sources: &Sources, values: &mut [f64], slopes: &mut [f32]) {
    let Measure { pull, sag, .. } = sources.measure;
    for (k, value) in values.iter_mut().enumerate() {
        let (from, to) = (pairs.starts[k], pairs.starts[k + 1]);
        let exact = pairs.exact[k]..pairs.exact[k + 1];
        let middle = from + exact.len();
        let mut all = [0.0; LANES];
        for at in exact.step_by(LANES) {
            let count = (pairs.exact[k + 1] - at).min(LANES);
            let entry = from + at - pairs.exact[k];
            let spots = &pairs.spots[entry..entry + count];
            // Lanes beyond the last entry repeat it.
            let lanes: [usize; LANES] = std::array::from_fn(|lane| lane.min(count - 1));
            let r = lanes.map(|lane| pairs.r[at + lane]);
            let inverse_r = r.map(|r| 1.0 / r);
            let shapes = lanes.map(|lane| sources.shapes[spots[lane] as usize]);
            let [a, root_a, inverse_root_a, curvature] =
                std::array::from_fn(|k| shapes.map(|shape| shape[k]));
            let (fields, rates) =
                field_at(&r, &inverse_r, &a, &root_a, &inverse_root_a, &curvature, pull, sag);
            for (lane, (spot, rest)) in spots.iter().zip(&pairs.rest[at..at + count]).enumerate() {
                let spot = *spot as usize;
                all[lane] += fields[lane] + product(rest, &sources.moments.value[spot]);
                if SLOPES {
                    slopes[entry + lane] = (rates[lane] + product(rest, &sources.moments.slope[spot])) as f32;
                }
            }
        }
        let far = from - pairs.exact[k]..to - pairs.exact[k + 1];
        let (spots, kernel, low) = (&pairs.spots[middle..to], &pairs.kernel[far.clone()], &pairs.low[far]);
        let (mut even, mut odd, mut rest) = ([0.0; ORDERS], [0.0; ORDERS], 0.0);
        let mut add = |at: usize, strand: &mut [f64; ORDERS]| {
            let (kernel, spot) = (kernel[at].map(f64::from), spots[at] as usize);
            let moments = &sources.moments.value[spot];
            for m in 0..ORDERS {
                strand[m] = kernel[m].mul_add(moments[m], strand[m]);
            }
            rest += f64::from(low[at]) * moments[0];
            if SLOPES {
                slopes[middle + at] = product(&kernel, &sources.moments.slope[spot]) as f32;
            }
        };
        for at in (1..spots.len()).step_by(2) {
            add(at - 1, &mut even);
            add(at, &mut odd);
        }
        if spots.len() % 2 == 1 {
            add(spots.len() - 1, &mut even);
        }
        *value = all.iter().sum::<f64>() + even.iter().chain(&odd).sum::<f64>() + rest;
    }
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn multiply(starts: &[usize], spots: &[u32], slopes: &[f32], x: &[f64], y: &mut [f64]) {
    for (ends, yi) in starts.windows(2).zip(y.iter_mut()) {
        let mut strands = [0.0; 4];
        let ((spots, left), (slopes, over)) =
            (spots[ends[0]..ends[1]].as_chunks::<4>(), slopes[ends[0]..ends[1]].as_chunks::<4>());
        for (spot, slope) in spots.iter().zip(slopes) {
            // All loads first, then one operation on all lanes.
            let (slope, x) = (slope.map(f64::from), spot.map(|spot| x[spot as usize]));
            for k in 0..4 {
                strands[k] = slope[k].mul_add(x[k], strands[k]);
            }
        }
        for (spot, slope) in left.iter().zip(over) {
            strands[0] += f64::from(*slope) * x[*spot as usize];
        }
        *yi = strands.iter().sum();
    }
}
