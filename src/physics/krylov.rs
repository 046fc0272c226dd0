//! GMRES: the linear solves of the equilibrium.
//!
//! Saad & Schultz, SIAM J. Sci. Stat. Comput. 7:856 (1986), right-preconditioned, modified Gram–Schmidt, no restart: the tangent of a
//! contact is a diagonal and a long-range coupling of low rank, and some ten products are enough; half as many with [`LocalInverse`].

use super::dense::Lu;
use super::interaction::{Effort, Tangent};
use super::local::LocalInverse;

/// Steps of the inverse iteration for the least eigenvalue: it stands apart where it matters.
const INVERSE_ITERATIONS: usize = 30;

/// `(diag(diagonal) + tangent)·x`.
fn apply(tangent: &Tangent, diagonal: &[f64], x: &[f64], y: &mut [f64]) {
    tangent.product(x, y);
    for (yi, (di, xi)) in y.iter_mut().zip(diagonal.iter().zip(x)) {
        *yi += di * xi;
    }
}

#[multiversion::multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut strands = [0.0; 8];
    let (a_whole, a_rest) = a.as_chunks::<8>();
    let (b_whole, b_rest) = b.as_chunks::<8>();
    for (ca, cb) in a_whole.iter().zip(b_whole) {
        for k in 0..8 {
            strands[k] += ca[k] * cb[k];
        }
    }
    for (k, (x, y)) in a_rest.iter().zip(b_rest).enumerate() {
        strands[k] += x * y;
    }
    strands.iter().sum()
}

/// A matrix `diag(diagonal) + tangent`, and an approximate inverse of it if there is one.
#[derive(Clone, Copy)]
pub(crate) struct Matrix<'a> {
    pub(crate) tangent: &'a Tangent,
    pub(crate) diagonal: &'a [f64],
    pub(crate) inverse: Option<&'a LocalInverse>,
}

/// Solves `matrix·x = rhs` to the relative residual `tolerance`; what is reached within `most` products is returned.
pub(crate) fn gmres(matrix: Matrix<'_>, rhs: &[f64], tolerance: f64, most: usize, effort: &mut Effort) -> Vec<f64> {
    solve(matrix, rhs, tolerance, most, effort, None)
}

/// The same, with the least eigenvalue of the matrix, each column over its diagonal element, in the space that the solution took: 1 without
/// coupling, 0 at a fold.
pub(crate) fn gmres_and_least(matrix: Matrix<'_>, rhs: &[f64], tolerance: f64, most: usize, effort: &mut Effort) -> (Vec<f64>, f64) {
    let mut projection = Projection::default();
    let x = solve(matrix, rhs, tolerance, most, effort, Some(&mut projection));
    (x, projection.least_eigenvalue())
}

/// What a solution has seen of the matrix `A`, by columns: `VᵀAW` down to its subdiagonal element and `VᵀDW`, V being the orthonormal basis, W that as
/// the approximate inverse answers to it and D the diagonal.
#[derive(Debug, Default)]
struct Projection {
    matrix: Vec<Vec<f64>>,
    diagonal: Vec<Vec<f64>>,
}

impl Projection {
    /// The eigenvalue θ of least magnitude of `VᵀAW y = θ VᵀDW y`, by inverse iteration. At a fold it is real, and passes through zero.
    fn least_eigenvalue(&self) -> f64 {
        let n = self.matrix.len();
        if n == 0 {
            return 1.0;
        }
        let mut matrix = vec![0.0; n * n];
        for (k, column) in self.matrix.iter().enumerate() {
            for (i, value) in column.iter().take(n).enumerate() {
                matrix[i * n + k] = *value;
            }
        }
        let mut lu = Lu::default();
        lu.factor(&matrix, n);
        let mut x: Vec<f64> = (0..n).map(|k| if k == 0 { 1.0 } else { 0.1 }).collect();
        let mut inverse = 1.0;
        for _ in 0..INVERSE_ITERATIONS {
            let length = dot(&x, &x).sqrt();
            x.iter_mut().for_each(|v| *v /= length);
            let before = x.clone();
            x.fill(0.0);
            for (column, factor) in self.diagonal.iter().zip(&before) {
                for (xi, value) in x.iter_mut().zip(column) {
                    *xi += value * factor;
                }
            }
            lu.solve(&mut x);
            inverse = dot(&before, &x);
        }
        1.0 / inverse
    }
}

/// Solves, and keeps what it has seen of the matrix if that is asked for.
fn solve(
    Matrix { tangent, diagonal, inverse }: Matrix<'_>,
    rhs: &[f64],
    tolerance: f64,
    most: usize,
    effort: &mut Effort,
    mut seen: Option<&mut Projection>,
) -> Vec<f64> {
    let n = rhs.len();
    let beta = dot(rhs, rhs).sqrt();
    let mut x = vec![0.0; n];
    if beta == 0.0 || !beta.is_finite() {
        return x;
    }
    let scale: Vec<f64> = diagonal.iter().enumerate().map(|(i, d)| alone(d + tangent.own(i))).collect();
    let mut basis: Vec<Vec<f64>> = vec![rhs.iter().map(|v| v / beta).collect()];
    let mut hessenberg: Vec<Vec<f64>> = Vec::new();
    let (mut cosines, mut sines): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    let mut g = vec![beta];
    let mut scaled = vec![0.0; n];
    let mut answers: Vec<Vec<f64>> = Vec::new();
    for k in 0..most.min(n) {
        precondition(inverse, &scale, &basis[k], &mut scaled);
        let mut w = vec![0.0; n];
        apply(tangent, diagonal, &scaled, &mut w);
        effort.products += 1;
        effort.transforms += tangent.transforms();
        let mut column = Vec::with_capacity(k + 2);
        for v in &basis {
            let h = dot(v, &w);
            for (wi, vi) in w.iter_mut().zip(v) {
                *wi -= h * vi;
            }
            column.push(h);
        }
        let length = dot(&w, &w).sqrt();
        if let Some(seen) = &mut seen {
            seen.matrix.push(column.iter().copied().chain([length]).collect());
            answers.push(scaled.iter().zip(&scale).map(|(z, s)| z / s).collect());
        }
        for i in 0..k {
            let (upper, lower) = (column[i], column[i + 1]);
            column[i] = cosines[i] * upper + sines[i] * lower;
            column[i + 1] = cosines[i] * lower - sines[i] * upper;
        }
        let radius = column[k].hypot(length);
        if radius == 0.0 {
            break;
        }
        let (c, s) = (column[k] / radius, length / radius);
        column[k] = radius;
        hessenberg.push(column);
        cosines.push(c);
        sines.push(s);
        g.push(-s * g[k]);
        g[k] *= c;
        if g[k + 1].abs() <= tolerance * beta || length <= 1e-300 {
            break;
        }
        basis.push(w.iter().map(|wi| wi / length).collect());
    }
    let m = hessenberg.len();
    if let Some(seen) = seen {
        seen.diagonal = answers.iter().map(|answer| basis.iter().take(answers.len()).map(|v| dot(v, answer)).collect()).collect();
    }
    let mut y = vec![0.0; m];
    for i in (0..m).rev() {
        let tail: f64 = (i + 1..m).map(|j| hessenberg[j][i] * y[j]).sum();
        y[i] = (g[i] - tail) / hessenberg[i][i];
    }
    for (v, yk) in basis.iter().zip(&y) {
        for (xi, vi) in x.iter_mut().zip(v) {
            *xi += yk * vi;
        }
    }
    precondition(inverse, &scale, &x, &mut scaled);
    scaled
}

/// What a spot alone answers to, its diagonal element being `whole`.
pub(crate) fn alone(whole: f64) -> f64 {
    // A diagonal near zero belongs to a spot near the end of its branch: keep its sign, bound its inverse.
    if whole.abs() > 1e-3 { 1.0 / whole } else { 1e3f64.copysign(whole) }
}

/// `y` as the approximate inverse answers to `x`, or the inverse of the diagonal.
fn precondition(inverse: Option<&LocalInverse>, scale: &[f64], x: &[f64], y: &mut [f64]) {
    match inverse {
        Some(inverse) => inverse.apply(x, y),
        None => {
            for ((y, x), scale) in y.iter_mut().zip(x).zip(scale) {
                *y = x * scale;
            }
        }
    }
}
