//! Near pairs: what of them depends on the positions alone is found once, and serves as long as the same spots are in contact.
//!
//! A spot that is some radii away is felt by its moments alone, four numbers of the pair; only those nearer are summed by their exact fields.

use super::near::{Found, Group, Measure};
use crate::physics::half_space::ewald::ORDERS;
use crate::physics::half_space::multipole::{Moments, product};
use crate::physics::half_space::spot_field::{AWAY, LANES, field_at};
use multiversion::multiversion;

/// A source as an exact field wants it: a, √a, 1/√a and 1/R.
pub(super) type Shape = [f64; 4];

/// All sources, by their numbers.
#[derive(Debug)]
pub(super) struct Sources {
    pub(super) measure: Measure,
    pub(super) shapes: Vec<Shape>,
    pub(super) moments: Moments,
}

/// Targets that one thread takes at a time.
pub(super) const TOGETHER: usize = 64;

/// The new number of a source that is no longer what it was.
pub(super) const GONE: u32 = u32::MAX;

/// A target, and its number when pairs were found last, if it was one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Target {
    pub(super) place: [f64; 2],
    pub(super) before: Option<usize>,
}

/// What was found before: pairs of so many targets by each, the new numbers of its sources, and the sources that are others than then.
#[derive(Clone, Copy)]
pub(super) struct Known<'a> {
    pub(super) pairs: &'a [Pairs],
    pub(super) numbers: &'a [u32],
    pub(super) changed: &'a [Group],
}

/// The near pairs of some targets. The entries of a target are its sources: first those that are felt by their exact fields, then those by moments.
#[derive(Debug, Clone, Default)]
pub(super) struct Pairs {
    /// Where the entries of each target begin, and how many exact ones there are before; one past the last of both.
    starts: Vec<usize>,
    exact: Vec<usize>,
    /// The source of each entry, and the derivative to its radius as it was taken last.
    spots: Vec<u32>,
    slopes: Vec<f32>,
    /// Of exact ones the distance, its inverse, and what the powers of it are to be taken with: what the mesh has of them taken off.
    r: Vec<f64>,
    inverse_r: Vec<f64>,
    rest: Vec<[f64; ORDERS]>,
    /// Of the others the factors of the moments, and what the first lacks for its digits: the higher ones are worth a hundredth and less.
    kernel: Vec<[f32; ORDERS]>,
    low: Vec<f32>,
    /// Sources of one target by moments, until the exact ones have been entered.
    waiting: Vec<u32>,
}

impl Pairs {
    /// Enters the near pairs of some targets anew. A source is felt by its moments from `aloof` \[m\] on, by its number.
    pub(super) fn find(&mut self, targets: impl Iterator<Item = Target>, known: Known<'_>, all: &[Group], measure: Measure, aloof: &[f64]) {
        self.starts.clear();
        self.exact.clear();
        self.spots.clear();
        self.r.clear();
        self.inverse_r.clear();
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

    /// Takes over the entries of a target whose sources are still what they were.
    fn take(&mut self, known: Known<'_>, target: usize) {
        let (old, k) = (&known.pairs[target / TOGETHER], target % TOGETHER);
        let exact = old.exact[k]..old.exact[k + 1];
        let (from, to) = (old.starts[k], old.starts[k + 1]);
        let middle = from + exact.len();
        let far = from - exact.start..to - exact.end;
        self.reserve(to - from);
        for (spot, at) in old.spots[from..middle].iter().zip(exact) {
            let spot = known.numbers[*spot as usize];
            if spot != GONE {
                self.push_exact(spot, (old.r[at], old.inverse_r[at]), old.rest[at]);
            }
        }
        for (spot, at) in old.spots[middle..to].iter().zip(far) {
            let spot = known.numbers[*spot as usize];
            if spot != GONE {
                self.push_far(spot, old.kernel[at], old.low[at]);
            }
        }
    }

    /// Enters a source that is felt by its exact field.
    #[inline(always)]
    fn push_exact(&mut self, spot: u32, (r, inverse_r): (f64, f64), rest: [f64; ORDERS]) {
        self.spots.push(spot);
        self.r.push(r);
        self.inverse_r.push(inverse_r);
        self.rest.push(rest);
    }

    /// Enters a source that is felt by its moments, behind the exact ones.
    #[inline(always)]
    fn push_far(&mut self, spot: u32, kernel: [f32; ORDERS], low: f32) {
        self.waiting.push(spot);
        self.kernel.push(kernel);
        self.low.push(low);
    }

    /// Makes room for so many entries of one target.
    fn reserve(&mut self, count: usize) {
        self.spots.reserve(count);
        self.r.reserve(count);
        self.inverse_r.reserve(count);
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

    /// The same, and the derivatives of all entries.
    pub(super) fn linearise(&mut self, sources: &Sources, values: &mut [f64]) {
        let mut slopes = std::mem::take(&mut self.slopes);
        slopes.resize(self.spots.len(), 0.0);
        evaluate::<true>(self, sources, values, &mut slopes);
        self.slopes = slopes;
    }

    /// The derivatives times a vector, at the targets.
    pub(super) fn product(&self, x: &[f64], y: &mut [f64]) {
        multiply(&self.starts, &self.spots, &self.slopes, x, y);
    }
}

/// Enters the sources that were found near a target.
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
    // All at once, before any branch is to be guessed.
    rests.clear();
    rests.extend(found.numbers.iter().zip(&found.r2).map(|(number, square)| group.rest_at(measure, place, *number, *square)));
    for ((&number, &square), &rest) in found.numbers.iter().zip(&found.r2).zip(&*rests) {
        let spot = group.spots[number];
        // A spot does not act on its own centre: its field is felt there as from far away, and what the mesh has of it is taken off with all digits.
        let r = if square > 0.0 { square.sqrt() } else { AWAY };
        if r < aloof[spot] || square == 0.0 {
            pairs.push_exact(spot as u32, (r, 1.0 / r), rest);
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
            let (mut r, mut inverse_r) = ([1.0; LANES], [1.0; LANES]);
            r[..count].copy_from_slice(&pairs.r[at..at + count]);
            inverse_r[..count].copy_from_slice(&pairs.inverse_r[at..at + count]);
            let [mut a, mut root_a, mut inverse_root_a, mut curvature] = [[1.0; LANES]; 4];
            let spots = &pairs.spots[entry..entry + count];
            for (lane, spot) in spots.iter().enumerate() {
                [a[lane], root_a[lane], inverse_root_a[lane], curvature[lane]] = sources.shapes[*spot as usize];
            }
            let (fields, rates) = field_at(&r, &inverse_r, &a, &root_a, &inverse_root_a, &curvature, pull, sag);
            for (lane, (spot, rest)) in spots.iter().zip(&pairs.rest[at..at + count]).enumerate() {
                let spot = *spot as usize;
                all[lane] += fields[lane] + product(rest, &sources.moments.value[spot]);
                if SLOPES {
                    slopes[entry + lane] = (rates[lane] + product(rest, &sources.moments.slope[spot])) as f32;
                }
            }
        }
        let far = from - pairs.exact[k]..to - pairs.exact[k + 1];
        let (mut strands, mut low) = ([[0.0; ORDERS]; 2], 0.0);
        let entries = pairs.spots[middle..to].iter().zip(&pairs.kernel[far.clone()]).zip(&pairs.low[far]);
        for (count, ((spot, kernel), rest)) in entries.enumerate() {
            let moments = &sources.moments.value[*spot as usize];
            let strand = &mut strands[count % 2];
            for m in 0..ORDERS {
                strand[m] = f64::from(kernel[m]).mul_add(moments[m], strand[m]);
            }
            low += f64::from(*rest) * moments[0];
            if SLOPES {
                slopes[middle + count] = product(&kernel.map(f64::from), &sources.moments.slope[*spot as usize]) as f32;
            }
        }
        *value = all.iter().sum::<f64>() + strands.iter().flatten().sum::<f64>() + low;
    }
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn multiply(starts: &[usize], spots: &[u32], slopes: &[f32], x: &[f64], y: &mut [f64]) {
    for (ends, yi) in starts.windows(2).zip(y.iter_mut()) {
        let mut strands = [0.0; 4];
        let ((spots, left), (slopes, over)) = (spots[ends[0]..ends[1]].as_chunks::<4>(), slopes[ends[0]..ends[1]].as_chunks::<4>());
        for (spot, slope) in spots.iter().zip(slopes) {
            for k in 0..4 {
                strands[k] = f64::from(slope[k]).mul_add(x[spot[k] as usize], strands[k]);
            }
        }
        for (spot, slope) in left.iter().zip(over) {
            strands[0] += f64::from(*slope) * x[*spot as usize];
        }
        *yi = strands.iter().sum();
    }
}
