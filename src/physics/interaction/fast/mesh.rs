//! The smooth far field on meshes: sources are spread, waves are weighted, and the field is read at the targets.

use super::super::ewald::ORDERS;
use super::plan::{LAPLACIANS, Plan, WIDTH};
use multiversion::multiversion;
use rustfft::num_complex::Complex64;
use std::sync::Arc;

/// Points of a row of the mesh before its first: a spline reaches beyond the period on both sides.
const BEFORE: usize = WIDTH / 2 - 1;

type Weights = [f64; WIDTH];

/// Where a place lies on a mesh along one direction: the first point that its B-spline reaches, the values of that at the points, and its second, fourth
/// and sixth derivatives.
#[derive(Debug, Clone, Copy)]
struct Spline {
    base: usize,
    all: [Weights; ORDERS],
}

/// The same along both directions.
#[derive(Debug, Clone, Copy)]
pub(super) struct Splines([Spline; 2]);

/// Places in units of the side, on a mesh.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
pub(super) fn splines(places: &[[f64; 2]], mesh: usize) -> Vec<Splines> {
    places.iter().map(|place| Splines([spline(place[0], mesh), spline(place[1], mesh)])).collect()
}

#[inline(always)]
fn spline(place: f64, mesh: usize) -> Spline {
    let scaled = (place - place.floor()) * mesh as f64;
    let base = (scaled as usize).min(mesh - 1);
    let f = scaled - base as f64;
    let mut weights = [0.0; WIDTH];
    (weights[0], weights[1]) = (f, 1.0 - f);
    let mut all = [[0.0; WIDTH]; ORDERS];
    for order in 2..=WIDTH {
        if order > 2 {
            // (n − 1) M_n(x) = x M_(n−1)(x) + (n − x) M_(n−1)(x − 1), at x = f + k.
            let before = shifted(&weights, 1);
            let share = 1.0 / (order - 1) as f64;
            for k in 0..WIDTH {
                let x = f + k as f64;
                weights[k] = x.mul_add(weights[k], (order as f64 - x) * before[k]) * share;
            }
        }
        if order + 2 * ORDERS > WIDTH + 1 && (WIDTH - order).is_multiple_of(2) {
            let times = (WIDTH - order) / 2;
            let mut differences = weights;
            for _ in 0..times {
                // M_n″(x) = M_(n−2)(x) − 2 M_(n−2)(x − 1) + M_(n−2)(x − 2).
                let (one, two) = (shifted(&differences, 1), shifted(&differences, 2));
                for k in 0..WIDTH {
                    differences[k] += two[k] - 2.0 * one[k];
                }
            }
            all[times] = differences;
        }
    }
    for weights in &mut all {
        weights.reverse();
    }
    Spline { base, all }
}

#[inline(always)]
fn shifted(weights: &Weights, by: usize) -> Weights {
    let mut moved = [0.0; WIDTH];
    moved[by..].copy_from_slice(&weights[..WIDTH - by]);
    moved
}

/// A source on a mesh: the point of its first weight, and its spread as a sum of products, along x and along y.
#[derive(Debug, Clone)]
pub(super) struct Source {
    spot: usize,
    base: [usize; 2],
    along_x: [Weights; ORDERS],
    along_y: [Weights; ORDERS],
}

impl Source {
    /// The source of `moments` at a place, number `spot` among all: `Σ_m c_m ∇^2m δ/[(2m−1)!!]²`, the Laplacian taken of its spline.
    pub(super) fn new(spot: usize, Splines([x, y]): &Splines, mesh: usize, moments: &[f64; ORDERS]) -> Self {
        const BINOMIALS: [[f64; ORDERS]; ORDERS] = [[1.0, 1.0, 1.0, 1.0], [1.0, 2.0, 3.0, 0.0], [1.0, 3.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]];
        let square = (mesh * mesh) as f64;
        let mut along_y = [[0.0; WIDTH]; ORDERS];
        for p in 0..ORDERS {
            for (q, derivative) in y.all[..ORDERS - p].iter().enumerate() {
                let m = p + q;
                let factor = BINOMIALS[p][q] * moments[m] / LAPLACIANS[m] * square.powi(m as i32);
                for (w, d) in along_y[p].iter_mut().zip(derivative) {
                    *w += factor * d;
                }
            }
        }
        Self { spot, base: [x.base, y.base], along_x: x.all, along_y }
    }
}

/// A target on a mesh.
#[derive(Debug, Clone)]
pub(super) struct Reader {
    base: [usize; 2],
    along_x: Weights,
    along_y: Weights,
}

impl Reader {
    pub(super) fn new(Splines([x, y]): &Splines) -> Self {
        Self { base: [x.base, y.base], along_x: x.all[0], along_y: y.all[0] }
    }
}

/// Work space of the transforms: used again and again, and no part of any result.
#[derive(Debug, Clone, Default)]
pub(super) struct Work {
    points: Vec<f64>,
    lines: Vec<Complex64>,
    turned: Vec<Complex64>,
    total: Vec<Complex64>,
    scratch: Vec<Complex64>,
}

/// The field of all sources on the finest mesh, which is left in the work space for [`read`]. Sources of each plan, the finest first;
/// each counts `factors` of its spot, or once.
pub(super) fn transform(levels: &[(Arc<Plan>, Vec<Source>)], factors: Option<&[f64]>, work: &mut Work) {
    let Some((finest, _)) = levels.first() else { return };
    let n = finest.mesh;
    let half = n / 2 + 1;
    for (level, (plan, sources)) in levels.iter().enumerate() {
        forward(plan, sources, factors, work);
        if level == 0 {
            std::mem::swap(&mut work.total, &mut work.turned);
            for (value, wave) in work.total.iter_mut().zip(&plan.waves) {
                *value *= wave;
            }
        } else {
            // The waves of a coarser mesh are the lowest of the finest.
            let m = plan.mesh;
            for ky in 0..m / 2 {
                for kx in (0..m / 2).chain(m / 2 + 1..m) {
                    let to = if kx < m / 2 { kx } else { kx + n - m };
                    work.total[ky * n + to] += work.turned[ky * m + kx] * plan.waves[ky * m + kx];
                }
            }
        }
    }
    for (ky, line) in work.total.chunks_mut(n).enumerate() {
        let along = finest.sharpen[ky];
        for (value, across) in line.iter_mut().zip(&finest.sharpen) {
            *value *= along * across;
        }
    }
    work.scratch.resize(finest.columns_back.get_inplace_scratch_len().max(finest.rows_back.get_scratch_len()), Complex64::default());
    finest.columns_back.process_with_scratch(&mut work.total, &mut work.scratch);
    work.lines.resize(half * n, Complex64::default());
    turn(&work.total, &mut work.lines, half, n);
    let stride = n + WIDTH - 1;
    work.points.resize(stride * stride, 0.0);
    for (i, line) in work.lines.chunks_mut(half).enumerate() {
        // Real by symmetry, but for rounding.
        line[0].im = 0.0;
        line[half - 1].im = 0.0;
        let row = &mut work.points[(i + BEFORE) * stride..][..stride];
        let inner = &mut row[BEFORE..BEFORE + n];
        if finest.rows_back.process_with_scratch(line, inner, &mut work.scratch).is_err() {
            inner.fill(f64::NAN);
        }
        row.copy_within(n..n + BEFORE, 0);
        row.copy_within(BEFORE..WIDTH - 1, BEFORE + n);
    }
    work.points.copy_within(n * stride..(n + BEFORE) * stride, 0);
    work.points.copy_within(BEFORE * stride..(WIDTH - 1) * stride, (BEFORE + n) * stride);
}

/// The waves of the sources of one plan, by ky then kx, into `work.turned`.
fn forward(plan: &Plan, sources: &[Source], factors: Option<&[f64]>, work: &mut Work) {
    let n = plan.mesh;
    let half = n / 2 + 1;
    let stride = n + WIDTH - 1;
    work.points.clear();
    work.points.resize(stride * stride, 0.0);
    spread(sources, factors, &mut work.points, stride);
    // What was spread beyond the period belongs to its other side.
    for i in 0..stride {
        let row = &mut work.points[i * stride..(i + 1) * stride];
        for k in 0..BEFORE {
            row[n + k] += row[k];
        }
        for k in BEFORE..WIDTH - 1 {
            row[k] += row[n + k];
        }
    }
    for i in 0..WIDTH - 1 {
        let (low, high) = work.points.split_at_mut(n * stride);
        let (low, high) = (&mut low[i * stride..(i + 1) * stride], &mut high[i * stride..(i + 1) * stride]);
        let (to, from) = if i < BEFORE { (high, low) } else { (low, high) };
        for (to, from) in to.iter_mut().zip(from.iter()) {
            *to += from;
        }
    }
    work.lines.resize(half * n, Complex64::default());
    work.turned.resize(half * n, Complex64::default());
    work.scratch.resize(plan.columns.get_inplace_scratch_len().max(plan.rows.get_scratch_len()), Complex64::default());
    for (i, line) in work.lines.chunks_mut(half).enumerate() {
        let row = &mut work.points[(i + BEFORE) * stride + BEFORE..][..n];
        if plan.rows.process_with_scratch(row, line, &mut work.scratch).is_err() {
            line.fill(Complex64::new(f64::NAN, 0.0));
        }
    }
    turn(&work.lines, &mut work.turned, n, half);
    plan.columns.process_with_scratch(&mut work.turned, &mut work.scratch);
}

/// The rows of `from` become the columns of `to`, block by block.
fn turn(from: &[Complex64], to: &mut [Complex64], rows: usize, columns: usize) {
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

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn spread(sources: &[Source], factors: Option<&[f64]>, points: &mut [f64], stride: usize) {
    for source in sources {
        let factor = factors.map_or(1.0, |all| all[source.spot]);
        for i in 0..WIDTH {
            let [a, b, c, d] = [0, 1, 2, 3].map(|m: usize| factor * source.along_x[m][i]);
            let from = (source.base[0] + i) * stride + source.base[1];
            for (k, point) in points[from..from + WIDTH].iter_mut().enumerate() {
                let [first, second, third, fourth] = &source.along_y;
                let (left, right) = (b.mul_add(second[k], a * first[k]), d.mul_add(fourth[k], c * third[k]));
                *point += left + right;
            }
        }
    }
}

/// Adds the field in the work space at the targets to `values`.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
pub(super) fn read(readers: &[Reader], mesh: usize, work: &Work, values: &mut [f64]) {
    let stride = mesh + WIDTH - 1;
    for (reader, value) in readers.iter().zip(values) {
        let mut strands = [0.0f64; WIDTH];
        for i in 0..WIDTH {
            let across = reader.along_x[i];
            let from = (reader.base[0] + i) * stride + reader.base[1];
            for (strand, point) in strands.iter_mut().zip(&work.points[from..from + WIDTH]) {
                *strand = across.mul_add(*point, *strand);
            }
        }
        *value += strands.iter().zip(&reader.along_y).map(|(s, w)| s * w).sum::<f64>();
    }
}
