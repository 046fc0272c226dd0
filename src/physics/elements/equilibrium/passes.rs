//! Passes over one row of the fields of an iteration, compiled for the vectors of the processor. Sums are
//! formed in blocks of one length, so that their digits are the same on every processor.

use crate::elements::grid::sums::{panel_largest, panel_sums};
use crate::elements::law::morse::Smooth;
use crate::elements::law::{Bond, Bonding, Law, Pieces};
use multiversion::multiversion;
use rayon::prelude::*;

/// Pairs of L-BFGS.
pub(crate) const PAIRS: usize = 2;
/// Points that are evaluated together.
const BLOCK: usize = 64;

/// `field − mean − Σ weights_i changes_i`: the direction of L-BFGS before the preconditioner.
pub(crate) struct Right<'a> {
    pub(crate) field: &'a [f32],
    pub(crate) mean: f32,
    pub(crate) changes: [&'a [f32]; PAIRS],
    pub(crate) weights: [f32; PAIRS],
}

impl Right<'_> {
    #[inline(always)]
    fn at(&self, k: usize) -> f32 {
        let ([a, b], [wa, wb]) = (self.changes, self.weights);
        self.field[k] - self.mean - wa * a[k] - wb * b[k]
    }

    /// Its rows.
    pub(crate) fn rows(&self, columns: usize) -> impl IndexedParallelIterator<Item = Right<'_>> {
        let [a, b] = self.changes.map(|change| change.par_chunks(columns));
        let rows = self.field.par_chunks(columns).zip(a.zip(b));
        rows.map(|(field, (a, b))| Right { field, mean: self.mean, changes: [a, b], weights: self.weights })
    }

    #[inline(always)]
    fn first(&self, n: usize) -> Self {
        Self {
            field: &self.field[..n],
            mean: self.mean,
            changes: self.changes.map(|change| &change[..n]),
            weights: self.weights,
        }
    }
}

/// Division of the points by the slope of the law, for the preconditioner.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Split {
    /// Slope above which a point is in contact \[E*/dx\].
    pub(crate) stiff: f32,
    /// Addition to the slope of points in contact \[E*/dx\].
    pub(crate) added: f32,
    /// Additional compliance of a softening point, per negative slope \[dx/E*\].
    pub(crate) softening: f32,
}

impl Split {
    #[inline(always)]
    fn scale(&self, slope: f32) -> f32 {
        1.0 - self.softening * slope.min(0.0)
    }
}

/// Open points of the right side, with 0 at those in contact.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx512bw", "x86_64+avx2"))]
pub(crate) fn open_part(to: &mut [f32], right: &Right<'_>, slopes: &[f32], split: Split) {
    let n = to.len();
    let (right, slopes) = (right.first(n), &slopes[..n]);
    for k in 0..n {
        to[k] = if slopes[k] > split.stiff { 0.0 } else { right.at(k) * split.scale(slopes[k]) };
    }
}

/// The direction after the preconditioner, of which `open` is the part at open points: its products with the
/// changes.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx512bw", "x86_64+avx2"))]
pub(crate) fn divided(
    to: &mut [f32],
    open: &[f32],
    right: &Right<'_>,
    slopes: &[f32],
    split: Split,
) -> [f64; PAIRS] {
    let n = to.len();
    let (right, slopes, open) = (right.first(n), &slopes[..n], &open[..n]);
    for k in 0..n {
        let slope = slopes[k];
        to[k] = if slope > split.stiff {
            right.at(k) / (slope + split.added)
        } else {
            open[k] * split.scale(slope)
        };
    }
    let [a, b] = right.changes;
    panel_sums([&*to, a, b], |[d, a, b]| [d * a, d * b])
}

/// `direction ← −(direction + Σ weights_i steps_i)`, written to `to` as well: its sum, its product with the
/// gradient and its largest magnitude.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx512bw", "x86_64+avx2"))]
pub(crate) fn descending(
    direction: &mut [f32],
    to: &mut [f32],
    steps: [&[f32]; PAIRS],
    weights: [f32; PAIRS],
    gradient: &[f32],
) -> [f64; 3] {
    let n = to.len();
    let ([a, b], [wa, wb]) = (steps.map(|step| &step[..n]), weights);
    let direction = &mut direction[..n];
    for k in 0..n {
        direction[k] = -(direction[k] + wa * a[k] + wb * b[k]);
    }
    to.copy_from_slice(direction);
    let [sum, product] = panel_sums([&*to, &gradient[..n]], |[d, g]| [d, d * g]);
    [sum, product, panel_largest(to)]
}

/// Products of a field with others.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx512bw", "x86_64+avx2"))]
pub(crate) fn products(field: &[f32], others: [&[f32]; PAIRS]) -> [f64; PAIRS] {
    let [a, b] = others;
    panel_sums([field, a, b], |[g, a, b]| [g * a, g * b])
}

/// The change `y ← (g − old − shift) × unit` of the gradient along a step
/// `s`, and its products with those of the other pair `a`: of `[g, old, s, s_a, y_a]`,
/// `[s·y, s·s, s·y_a, y·s_a, g·s, g·s_a]`.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx512bw", "x86_64+avx2"))]
pub(crate) fn new_pair(y: &mut [f32], fields: [&[f32]; 5], shift: f32, unit: f32) -> [f64; 6] {
    let [g, old, s, sa, ya] = fields;
    y.iter_mut().zip(g.iter().zip(old)).for_each(|(y, (g, old))| *y = (g - old - shift) * unit);
    panel_sums([&*y, g, s, sa, ya], |[y, g, s, sa, ya]| [s * y, s * s, s * ya, y * sa, g * s, g * sa])
}

/// One row of the fields of a step.
pub(crate) struct Points<'a> {
    /// Gap, and sum of pressure and tension, at the beginning.
    pub(crate) gap: &'a [f32],
    pub(crate) residual: &'a [f32],
    /// Displacement and pressure since then.
    pub(crate) displacement: &'a mut [f32],
    pub(crate) pressure: &'a mut [f32],
    pub(crate) bonds: &'a [Bonding],
    pub(crate) direction: &'a [f32],
    pub(crate) gradient: &'a mut [f32],
    pub(crate) slopes: &'a mut [f32],
    /// 1 at points in contact.
    pub(crate) touching: &'a mut [u8],
}

impl Points<'_> {
    /// A part of the row.
    #[inline(always)]
    fn part(&mut self, range: std::ops::Range<usize>) -> Points<'_> {
        Points {
            gap: &self.gap[range.clone()],
            residual: &self.residual[range.clone()],
            displacement: &mut self.displacement[range.clone()],
            pressure: &mut self.pressure[range.clone()],
            bonds: &self.bonds[range.clone()],
            direction: &self.direction[range.clone()],
            gradient: &mut self.gradient[range.clone()],
            slopes: &mut self.slopes[range.clone()],
            touching: &mut self.touching[range],
        }
    }
}

/// A step along the direction less its `mean`; `centre` is subtracted from the gradient.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stride {
    pub(crate) length: f32,
    pub(crate) mean: f32,
    pub(crate) centre: f32,
}

/// Sums over a row after a step.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Found {
    /// Sums of the gradient and of its square.
    pub(crate) gradient: [f64; 2],
    pub(crate) largest: f64,
    /// Products of the direction with the gradient and with the elastic response.
    pub(crate) slope: f64,
    pub(crate) curvature: f64,
    /// Change of the energy of the law beyond that of first order in the step.
    pub(crate) beyond: f64,
    /// True if a point has come into contact or left it.
    pub(crate) changed: bool,
}

impl Found {
    /// Adds the sums of another row.
    pub(crate) fn add(&mut self, other: &Self) {
        for (sum, part) in self.gradient.iter_mut().zip(other.gradient) {
            *sum += part;
        }
        self.largest = self.largest.max(other.largest);
        self.slope += other.slope;
        self.curvature += other.curvature;
        self.beyond += other.beyond;
    }
}

/// Values of a block of points that are needed to replace the spring by the law.
struct Block {
    /// Gap before the step.
    before: [f32; BLOCK],
    /// 1 where the law itself has to be evaluated.
    curved: [u8; BLOCK],
    /// Bonds of these points one after another, their gaps at the beginning, before and after the step, and
    /// the change of their tension, its slope, and the change of their energy beyond first order.
    bonds: [Bonding; BLOCK],
    gaps: [[f64; BLOCK]; 3],
    changes: [[f32; BLOCK]; 3],
}

/// Moves the points of a row along the direction, to which `response` is the elastic response, and evaluates
/// the law at them. With a line tension the sums over the gradient are those of
/// [`add_line`](super::line::add_line), which changes it.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx512bw", "x86_64+avx2"))]
pub(crate) fn advance(
    points: &mut Points<'_>,
    response: &[f32],
    stride: Stride,
    law: &Law,
    pieces: &Pieces,
) -> Found {
    let mut found = Found::default();
    let mut beyond = vec![0.0; points.gap.len()];
    let mut block = Block {
        before: [0.0; BLOCK],
        curved: [0; BLOCK],
        bonds: [Bonding::Free; BLOCK],
        gaps: [[0.0; BLOCK]; 3],
        changes: [[0.0; BLOCK]; 3],
    };
    for (part, beyond) in beyond.chunks_mut(BLOCK).enumerate() {
        let range = part * BLOCK..part * BLOCK + beyond.len();
        let mut points = points.part(range.clone());
        let [changed, mut curved] = glide(&mut points, &response[range], stride, pieces, beyond, &mut block);
        found.changed |= changed;
        if curved && let Some(smooth) = pieces.smooth {
            curved = bend(&mut points, stride, smooth, beyond, &mut block);
        }
        match law {
            _ if !curved => {}
            // Bonded points alone are on the curve of this law.
            Law::Crack(law) => curve(&mut points, stride.centre, |_, gap| law.at(gap), beyond, &mut block),
            Law::Morse(_) => {
                let bond = |bonding, gap| law.bond(bonding, gap);
                curve(&mut points, stride.centre, bond, beyond, &mut block);
            }
        }
    }
    if law.has_line() {
        let fields = [&*beyond, response, points.direction];
        [found.beyond, found.curvature] = panel_sums(fields, |[beyond, k, d]| [beyond, k * d]);
        return found;
    }
    let fields = [&*points.gradient, &beyond, response, points.direction];
    [found.gradient[0], found.gradient[1], found.beyond, found.slope, found.curvature] =
        panel_sums(fields, |[g, beyond, k, d]| [g, g * g, beyond, g * d, k * d]);
    found.largest = panel_largest(points.gradient);
    found
}

/// Moves points, with the law as a spring or nothing: true if one has come into contact or left it, and if
/// one is on the curve of the law. Only changes since the beginning are computed in single precision.
#[inline(always)]
fn glide(
    points: &mut Points<'_>,
    response: &[f32],
    stride: Stride,
    pieces: &Pieces,
    beyond: &mut [f32],
    block: &mut Block,
) -> [bool; 2] {
    let n = beyond.len();
    let (gap, residual, bonds) = (&points.gap[..n], &points.residual[..n], &points.bonds[..n]);
    let (direction, response) = (&points.direction[..n], &response[..n]);
    let (displacement, pressure, touching) =
        (&mut points.displacement[..n], &mut points.pressure[..n], &mut points.touching[..n]);
    let (gradient, slopes) = (&mut points.gradient[..n], &mut points.slopes[..n]);
    let (was, curved) = (&mut block.before[..n], &mut block.curved[..n]);
    let Pieces { stiffness, spring, contact, curved: [[f0, l0], [f1, l1], [f2, l2]], .. } = *pieces;
    let (mut changed, mut any_curved) = (0, 0);
    for k in 0..n {
        let bonding = bonds[k] as u8;
        let of = |[free, bonded, sealed]: [f32; 3]| {
            if bonding == 0 {
                free
            } else if bonding == 1 {
                bonded
            } else {
                sealed
            }
        };
        let before = gap[k] + displacement[k];
        displacement[k] += stride.length * (direction[k] - stride.mean);
        pressure[k] += stride.length * response[k];
        let after = gap[k] + displacement[k];
        let spring = of(spring);
        let stretched = |gap: f32| if gap < spring { gap } else { 0.0 };
        let (m0, m1) = (stretched(before), stretched(after));
        let pulled = if gap[k] < spring && after < spring { displacement[k] } else { m1 - stretched(gap[k]) };
        slopes[k] = if after < spring { stiffness } else { 0.0 };
        gradient[k] = residual[k] + pressure[k] - stride.centre + stiffness * pulled;
        let jump = m1 - m0;
        beyond[k] = 0.5 * stiffness * (jump * jump + 2.0 * m0 * (jump - (after - before)));
        let touches = u8::from(after < of(contact));
        changed |= touching[k] ^ touches;
        touching[k] = touches;
        let (first, last) = (of([f0, f1, f2]), of([l0, l1, l2]));
        let on_curve = |gap: f32| u8::from(gap >= first && gap <= last);
        curved[k] = on_curve(gap[k]) | on_curve(before) | on_curve(after);
        any_curved |= curved[k];
        was[k] = before;
    }
    [changed != 0, any_curved != 0]
}

/// Adds Morse's law at the bonded points of a block, without branches: true if the law itself has to be
/// evaluated at some point.
#[inline(always)]
fn bend(points: &mut Points<'_>, stride: Stride, law: Smooth, beyond: &mut [f32], block: &mut Block) -> bool {
    let n = beyond.len();
    let (gap, displacement, bonds, direction) =
        (&points.gap[..n], &points.displacement[..n], &points.bonds[..n], &points.direction[..n]);
    let (gradient, slopes) = (&mut points.gradient[..n], &mut points.slopes[..n]);
    let (before, curved) = (&block.before[..n], &mut block.curved[..n]);
    let mut any_curved = 0;
    for k in 0..n {
        let effect =
            law.change(gap[k], before[k], displacement[k], stride.length * (direction[k] - stride.mean));
        let bonded = bonds[k] as u8 == Bonding::Bonded as u8;
        let holds = bonded & effect.holds;
        let (straight, slope, flat) = (gradient[k], slopes[k], beyond[k]);
        let bent = straight + effect.tension;
        gradient[k] = if holds { bent } else { straight };
        slopes[k] = if holds { effect.slope } else { slope };
        beyond[k] = if holds { effect.beyond } else { flat };
        let left = curved[k] & u8::from(!holds);
        curved[k] = left;
        any_curved |= left;
    }
    any_curved != 0
}

/// Replaces the spring by the law at the points of a block that are on its curve.
#[inline(always)]
fn curve(
    points: &mut Points<'_>,
    centre: f32,
    bond: impl Fn(Bonding, f64) -> Bond,
    beyond: &mut [f32],
    block: &mut Block,
) {
    let n = beyond.len();
    let (mut places, mut count) = ([0_u8; BLOCK], 0);
    for k in 0..n {
        places[count % BLOCK] = k as u8;
        count += usize::from(block.curved[k] != 0);
    }
    let Block { before, bonds, gaps, changes, .. } = block;
    let places = places[..count].iter().map(|k| usize::from(*k)).enumerate();
    for (j, k) in places.clone() {
        let after = points.gap[k] + points.displacement[k];
        [gaps[0][j], gaps[1][j], gaps[2][j]] = [points.gap[k], before[k], after].map(f64::from);
        bonds[j] = points.bonds[k];
    }
    change(bonds, gaps, count, bond, changes);
    let [tension, slope, energy] = changes;
    for (j, k) in places {
        points.gradient[k] = points.residual[k] + points.pressure[k] - centre + tension[j];
        points.slopes[k] = slope[j];
        beyond[k] = energy[j];
    }
}

/// Changes of the law at the first points of a block, as in [`Block`].
#[inline(always)]
fn change(
    bonds: &[Bonding; BLOCK],
    gaps: &[[f64; BLOCK]; 3],
    count: usize,
    bond: impl Fn(Bonding, f64) -> Bond,
    to: &mut [[f32; BLOCK]; 3],
) {
    for j in 0..count.min(BLOCK) {
        let [begin, before, after] = [gaps[0][j], gaps[1][j], gaps[2][j]];
        let (first, old, new) =
            (bond(bonds[j], begin).tension, bond(bonds[j], before), bond(bonds[j], after));
        to[0][j] = (new.tension - first) as f32;
        to[1][j] = new.slope as f32;
        to[2][j] = (new.energy - old.energy - old.tension * (after - before)) as f32;
    }
}
