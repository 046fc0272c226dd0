//! Smooth far field on meshes: spread the sources, multiply in Fourier space, interpolate at the targets.

use super::plan::{LAPLACIANS, Mesh, Real};
use crate::asperities::field::ewald::ORDERS;
use multiversion::multiversion;
use rustfft::num_complex::Complex;
use std::sync::Arc;

/// Mesh points in a row before the first: a spline of this width extends beyond the period on both sides.
const fn before(width: usize) -> usize {
    width / 2 - 1
}

/// B-spline weights of order `W` along one direction.
///
/// First mesh point, the values at the points, and the derivatives of even order, `O` in all.
#[derive(Debug, Clone, Copy)]
struct Spline<T, const W: usize, const O: usize> {
    base: usize,
    all: [[T; W]; O],
}

/// B-spline weights along both directions.
#[derive(Debug, Clone, Copy)]
pub(super) struct Splines<T, const W: usize, const O: usize>([Spline<T, W, O>; 2]);

/// B-spline weights of points, in units of the side, on a mesh.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
pub(super) fn splines<T: Real, const W: usize, const O: usize>(
    places: &[[f64; 2]],
    mesh: usize,
) -> Vec<Splines<T, W, O>> {
    places.iter().map(|place| Splines([spline(place[0], mesh), spline(place[1], mesh)])).collect()
}

#[inline(always)]
fn spline<T: Real, const W: usize, const O: usize>(place: f64, mesh: usize) -> Spline<T, W, O> {
    let scaled = (place - place.floor()) * mesh as f64;
    let base = (scaled as usize).min(mesh - 1);
    let f = scaled - base as f64;
    let mut weights = [0.0; W];
    (weights[0], weights[1]) = (f, 1.0 - f);
    let mut all = [[0.0; W]; O];
    for order in 2..=W {
        if order > 2 {
            // (n − 1) M_n(x) = x M_(n−1)(x) + (n − x) M_(n−1)(x − 1), at x = f + k.
            let before = shifted(&weights, 1);
            let share = 1.0 / (order - 1) as f64;
            for k in 0..W {
                let x = f + k as f64;
                weights[k] = x.mul_add(weights[k], (order as f64 - x) * before[k]) * share;
            }
        }
        if order + 2 * O > W + 1 && (W - order).is_multiple_of(2) {
            let times = (W - order) / 2;
            let mut differences = weights;
            for _ in 0..times {
                // M_n″(x) = M_(n−2)(x) − 2 M_(n−2)(x − 1) + M_(n−2)(x − 2).
                let (one, two) = (shifted(&differences, 1), shifted(&differences, 2));
                for k in 0..W {
                    differences[k] += two[k] - 2.0 * one[k];
                }
            }
            all[times] = differences;
        }
    }
    let mut kept = [[T::default(); W]; O];
    for (kept, weights) in kept.iter_mut().zip(&all) {
        for (kept, weight) in kept.iter_mut().zip(weights.iter().rev()) {
            *kept = T::of(*weight);
        }
    }
    Spline { base, all: kept }
}

#[inline(always)]
fn shifted<const W: usize>(weights: &[f64; W], by: usize) -> [f64; W] {
    let mut moved = [0.0; W];
    moved[by..].copy_from_slice(&weights[..W - by]);
    moved
}

/// Interpolation weights of a target on a mesh.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reader<T, const W: usize> {
    base: [usize; 2],
    along_x: [T; W],
    along_y: [T; W],
}

impl<T: Real, const W: usize> Reader<T, W> {
    pub(super) fn new(Splines([x, y]): &Splines<T, W, 1>) -> Self {
        Self { base: [x.base, y.base], along_x: x.all[0], along_y: y.all[0] }
    }
}

/// Work space of the transforms; it carries no results between calls.
#[derive(Debug, Clone, Default)]
pub(super) struct Work<T> {
    points: Vec<T>,
    lines: Vec<Complex<T>>,
    turned: Vec<Complex<T>>,
    total: Vec<Complex<T>>,
    scratch: Vec<Complex<T>>,
}

/// A mesh with its sources.
#[derive(Debug, Clone)]
pub(super) struct Level<T, const W: usize, const O: usize> {
    pub(super) mesh: Arc<Mesh<T>>,
    pub(super) sources: PlacedSources<T, W, O>,
}

/// Sources on a mesh.
#[derive(Debug, Clone)]
pub(super) struct PlacedSources<T, const W: usize, const O: usize> {
    /// Numbers of the sources.
    pub(super) numbers: Vec<usize>,
    /// Their spline weights.
    pub(super) weights: Vec<Splines<T, W, O>>,
}

/// Moments of all sources, and an optional factor for each.
#[derive(Clone, Copy)]
pub(super) struct Loads<'a> {
    pub(super) moments: &'a [[f64; ORDERS]],
    pub(super) factors: Option<&'a [f64]>,
}

/// Field of all sources on the finest mesh, left in the work space for [`read`].
///
/// `levels` holds the sources of each mesh, the finest first.
pub(super) fn transform<T: Real, const W: usize, const O: usize>(
    levels: &[Level<T, W, O>],
    loads: Loads<'_>,
    work: &mut Work<T>,
) {
    let Some(Level { mesh: finest, .. }) = levels.first() else { return };
    let n = finest.size;
    let half = n / 2 + 1;
    for (level, Level { mesh, sources }) in levels.iter().enumerate() {
        forward(mesh, sources, loads, work);
        if level == 0 {
            std::mem::swap(&mut work.total, &mut work.turned);
            for (value, wave) in work.total.iter_mut().zip(&mesh.waves) {
                *value = *value * *wave;
            }
        } else {
            // The Fourier modes of a coarser mesh are the lowest modes of the finest.
            let m = mesh.size;
            for ky in 0..m / 2 {
                for kx in (0..m / 2).chain(m / 2 + 1..m) {
                    let to = if kx < m / 2 { kx } else { kx + n - m };
                    let to = &mut work.total[ky * n + to];
                    *to = *to + work.turned[ky * m + kx] * mesh.waves[ky * m + kx];
                }
            }
        }
    }
    for (ky, line) in work.total.chunks_mut(n).enumerate() {
        let along = finest.sharpen[ky];
        for (value, across) in line.iter_mut().zip(&finest.sharpen) {
            *value = *value * (along * *across);
        }
    }
    work.scratch.resize(
        finest.columns_back.get_inplace_scratch_len().max(finest.rows_back.get_scratch_len()),
        Complex::default(),
    );
    finest.columns_back.process_with_scratch(&mut work.total, &mut work.scratch);
    work.lines.resize(half * n, Complex::default());
    turn(&work.total, &mut work.lines, half, n);
    let stride = n + W - 1;
    work.points.resize(stride * stride, T::default());
    for (i, line) in work.lines.chunks_mut(half).enumerate() {
        // Real by symmetry, up to rounding.
        line[0].im = T::default();
        line[half - 1].im = T::default();
        let row = &mut work.points[(i + before(W)) * stride..][..stride];
        let inner = &mut row[before(W)..before(W) + n];
        if finest.rows_back.process_with_scratch(line, inner, &mut work.scratch).is_err() {
            inner.fill(T::nan());
        }
        row.copy_within(n..n + before(W), 0);
        row.copy_within(before(W)..W - 1, before(W) + n);
    }
    work.points.copy_within(n * stride..(n + before(W)) * stride, 0);
    work.points.copy_within(before(W) * stride..(W - 1) * stride, (before(W) + n) * stride);
}

/// Fourier modes of the sources of one mesh, by ky then kx, into `work.turned`.
fn forward<T: Real, const W: usize, const O: usize>(
    mesh: &Mesh<T>,
    sources: &PlacedSources<T, W, O>,
    loads: Loads<'_>,
    work: &mut Work<T>,
) {
    let n = mesh.size;
    let half = n / 2 + 1;
    let stride = n + W - 1;
    work.points.clear();
    work.points.resize(stride * stride, T::default());
    spread(&sources.numbers, &sources.weights, loads, n, &mut work.points);
    // Wrap the points beyond the period to the other side.
    for i in 0..stride {
        let row = &mut work.points[i * stride..(i + 1) * stride];
        for k in 0..before(W) {
            row[n + k] = row[n + k] + row[k];
        }
        for k in before(W)..W - 1 {
            row[k] = row[k] + row[n + k];
        }
    }
    for i in 0..W - 1 {
        let (low, high) = work.points.split_at_mut(n * stride);
        let (low, high) = (&mut low[i * stride..(i + 1) * stride], &mut high[i * stride..(i + 1) * stride]);
        let (to, from) = if i < before(W) { (high, low) } else { (low, high) };
        for (to, from) in to.iter_mut().zip(from.iter()) {
            *to = *to + *from;
        }
    }
    work.lines.resize(half * n, Complex::default());
    work.turned.resize(half * n, Complex::default());
    work.scratch
        .resize(mesh.columns.get_inplace_scratch_len().max(mesh.rows.get_scratch_len()), Complex::default());
    for (i, line) in work.lines.chunks_mut(half).enumerate() {
        let row = &mut work.points[(i + before(W)) * stride + before(W)..][..n];
        if mesh.rows.process_with_scratch(row, line, &mut work.scratch).is_err() {
            line.fill(Complex::new(T::nan(), T::default()));
        }
    }
    turn(&work.lines, &mut work.turned, n, half);
    mesh.columns.process_with_scratch(&mut work.turned, &mut work.scratch);
}

/// Transposes `from` into `to`, block by block.
fn turn<T: Copy>(from: &[T], to: &mut [T], rows: usize, columns: usize) {
    const BLOCK: usize = 16;
    for i in (0..rows).step_by(BLOCK) {
        for j in (0..columns).step_by(BLOCK) {
            for k in i..(i + BLOCK).min(rows) {
                for l in j..(j + BLOCK).min(columns) {
                    to[l * rows + k] = from[k * columns + l];
                }
            }
        }
    }
}

/// Spreads each source: `Σ_m c_m ∇^2m δ/[(2m−1)!!]²`, with the Laplacian of its spline.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn spread<T: Real, const W: usize, const O: usize>(
    spots: &[usize],
    sources: &[Splines<T, W, O>],
    loads: Loads<'_>,
    mesh: usize,
    points: &mut [T],
) {
    const BINOMIALS: [[f64; ORDERS]; ORDERS] =
        [[1.0, 1.0, 1.0, 1.0], [1.0, 2.0, 3.0, 0.0], [1.0, 3.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]];
    let stride = mesh + W - 1;
    let mut scales = [1.0; ORDERS];
    for (m, scale) in scales.iter_mut().enumerate() {
        *scale = ((mesh * mesh) as f64).powi(m as i32) / LAPLACIANS[m];
    }
    for (spot, Splines([x, y])) in spots.iter().zip(sources) {
        let factor = loads.factors.map_or(1.0, |all| all[*spot]);
        let mut moments = loads.moments[*spot];
        for (moment, scale) in moments.iter_mut().zip(&scales) {
            *moment *= factor * scale;
        }
        let mut along_y = [[T::default(); W]; O];
        for (p, along_y) in along_y.iter_mut().enumerate() {
            for (q, derivatives) in y.all[..O - p].iter().enumerate() {
                let weight = T::of(BINOMIALS[p][q] * moments[p + q]);
                for (sum, derivative) in along_y.iter_mut().zip(derivatives) {
                    *sum = weight.mul_add(*derivative, *sum);
                }
            }
        }
        for i in 0..W {
            let from = (x.base + i) * stride + y.base;
            let line = &mut points[from..from + W];
            let mut sums = [T::default(); W];
            for (along_x, along_y) in x.all.iter().zip(&along_y) {
                for (sum, along) in sums.iter_mut().zip(along_y) {
                    *sum = along_x[i].mul_add(*along, *sum);
                }
            }
            for (point, sum) in line.iter_mut().zip(sums) {
                *point = *point + sum;
            }
        }
    }
}

/// Adds the field in the work space, interpolated at the targets, to `values`.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
pub(super) fn read<T: Real, const W: usize>(
    readers: &[Reader<T, W>],
    mesh: usize,
    work: &Work<T>,
    values: &mut [f64],
) {
    let stride = mesh + W - 1;
    for (reader, value) in readers.iter().zip(values) {
        let mut strands = [T::default(); W];
        for i in 0..W {
            let across = reader.along_x[i];
            let from = (reader.base[0] + i) * stride + reader.base[1];
            for (strand, point) in strands.iter_mut().zip(&work.points[from..from + W]) {
                *strand = across.mul_add(*point, *strand);
            }
        }
        let mut sum = T::default();
        for (strand, weight) in strands.iter().zip(&reader.along_y) {
            sum = strand.mul_add(*weight, sum);
        }
        *value += sum.long();
    }
}
