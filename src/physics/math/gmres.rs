//! GMRES for the linear systems of an equilibrium.
//!
//! Saad & Schultz, SIAM J. Sci. Stat. Comput. 7:856 (1986), right-preconditioned, modified Gram–Schmidt, without restart: the tangent of a contact is
//! a diagonal and a long-range coupling of low rank, and ten products are enough; half as many with a preconditioner.

use super::dense::Lu;
use super::vector::dot;

/// Steps of the inverse iteration for the least eigenvalue: it stands apart where it matters.
const INVERSE_ITERATIONS: usize = 30;

/// A square matrix, by its product with a vector.
pub(crate) trait LinearOperator {
    /// `y = A x`.
    fn product(&self, x: &[f64], y: &mut [f64]);
    /// Diagonal element `A_ii`.
    fn diagonal(&self, i: usize) -> f64;
}

/// An approximate inverse.
pub(crate) trait Preconditioner {
    /// `y ≈ A⁻¹ x`.
    fn apply(&self, x: &[f64], y: &mut [f64]);
}

/// An approximate solution.
pub(crate) struct Solution {
    pub(crate) x: Vec<f64>,
    /// Products of the matrix with a vector.
    pub(crate) products: u64,
}

/// Limits of a solution.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Limits {
    /// Norm of the residual over that of the right-hand side.
    pub(crate) tolerance: f64,
    /// Maximum number of products.
    pub(crate) products: usize,
}

/// Solves `A x = rhs` within the limits.
pub(crate) fn gmres(matrix: &impl LinearOperator, inverse: Option<&dyn Preconditioner>, rhs: &[f64], limits: Limits) -> Solution {
    solve(matrix, inverse, rhs, limits, None)
}

/// Solves, and finds the least eigenvalue of the matrix in the Krylov space, each column over its diagonal element: 1 without coupling, 0 at a fold.
pub(crate) fn gmres_and_least(
    matrix: &impl LinearOperator,
    inverse: Option<&dyn Preconditioner>,
    rhs: &[f64],
    limits: Limits,
) -> (Solution, f64) {
    let mut projection = Projection::default();
    let solution = solve(matrix, inverse, rhs, limits, Some(&mut projection));
    (solution, projection.least_eigenvalue())
}

/// Projection of the matrix `A` on the Krylov space, by columns: `VᵀAW` down to its subdiagonal element and `VᵀDW`, with the orthonormal basis V, the
/// preconditioned basis W and the diagonal D.
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

/// Solves, with the projection of the matrix if that is wanted.
fn solve(
    matrix: &impl LinearOperator,
    inverse: Option<&dyn Preconditioner>,
    rhs: &[f64],
    limits: Limits,
    mut seen: Option<&mut Projection>,
) -> Solution {
    let n = rhs.len();
    let beta = dot(rhs, rhs).sqrt();
    let mut x = vec![0.0; n];
    if beta == 0.0 || !beta.is_finite() {
        return Solution { x, products: 0 };
    }
    let scale: Vec<f64> = (0..n).map(|i| bounded_inverse(matrix.diagonal(i))).collect();
    let mut basis: Vec<Vec<f64>> = vec![rhs.iter().map(|v| v / beta).collect()];
    let mut hessenberg: Vec<Vec<f64>> = Vec::new();
    let (mut cosines, mut sines): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    let mut g = vec![beta];
    let mut scaled = vec![0.0; n];
    let mut answers: Vec<Vec<f64>> = Vec::new();
    let mut products = 0;
    for k in 0..limits.products.min(n) {
        precondition(inverse, &scale, &basis[k], &mut scaled);
        let mut w = vec![0.0; n];
        matrix.product(&scaled, &mut w);
        products += 1;
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
        if g[k + 1].abs() <= limits.tolerance * beta || length <= 1e-300 {
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
    Solution { x: scaled, products }
}

/// Inverse of a diagonal element, bounded.
pub(crate) fn bounded_inverse(whole: f64) -> f64 {
    // A diagonal near zero belongs to a spot near the end of its branch: keep its sign, bound its inverse.
    if whole.abs() > 1e-3 { 1.0 / whole } else { 1e3f64.copysign(whole) }
}

/// Applies the approximate inverse, or that of the diagonal.
fn precondition(inverse: Option<&dyn Preconditioner>, scale: &[f64], x: &[f64], y: &mut [f64]) {
    match inverse {
        Some(inverse) => inverse.apply(x, y),
        None => {
            for ((y, x), scale) in y.iter_mut().zip(x).zip(scale) {
                *y = x * scale;
            }
        }
    }
}
