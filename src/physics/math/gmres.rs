//! GMRES for the linear systems of an equilibrium.
//!
//! Saad & Schultz, SIAM J. Sci. Stat. Comput. 7:856 (1986), right-preconditioned, modified Gram–Schmidt,
//! without restart: the tangent of a contact is a diagonal and a long-range coupling of low rank, and ten
//! products are enough; half as many with a preconditioner.

use super::dense::Lu;
use super::vector::dot;

/// Steps of the inverse iteration for the smallest eigenvalue, which is well separated near a fold.
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
pub(crate) fn gmres(
    matrix: &impl LinearOperator,
    inverse: Option<&dyn Preconditioner>,
    rhs: &[f64],
    limits: Limits,
) -> Solution {
    solve(matrix, inverse, rhs, limits, None)
}

/// Solves, and finds the smallest eigenvalue of the matrix in the Krylov space, with each column divided by
/// its diagonal element: 1 without coupling, 0 at a fold.
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

/// Projection of the matrix `A` on the Krylov space, by columns: `VᵀAW` down to its subdiagonal element and
/// `VᵀDW`, with the orthonormal basis V, the preconditioned basis W and the diagonal D.
#[derive(Debug, Default)]
struct Projection {
    matrix: Vec<Vec<f64>>,
    diagonal: Vec<Vec<f64>>,
}

impl Projection {
    /// The eigenvalue θ of smallest magnitude of `VᵀAW y = θ VᵀDW y`, by inverse iteration. At a fold it is
    /// real, and passes through zero.
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

/// Least-squares problem of the Hessenberg matrix, kept triangular by Givens rotations.
struct Triangular {
    columns: Vec<Vec<f64>>,
    rotations: Vec<(f64, f64)>,
    rhs: Vec<f64>,
}

impl Triangular {
    fn new(norm: f64) -> Self {
        Self { columns: Vec::new(), rotations: Vec::new(), rhs: vec![norm] }
    }

    /// Adds a column with its subdiagonal element last; false if it vanishes.
    fn add(&mut self, mut column: Vec<f64>) -> bool {
        let k = self.columns.len();
        for (i, (cosine, sine)) in self.rotations.iter().enumerate() {
            let (upper, lower) = (column[i], column[i + 1]);
            column[i] = cosine * upper + sine * lower;
            column[i + 1] = cosine * lower - sine * upper;
        }
        let length = column[k + 1];
        let radius = column[k].hypot(length);
        if radius == 0.0 {
            return false;
        }
        let (cosine, sine) = (column[k] / radius, length / radius);
        column[k] = radius;
        column.truncate(k + 1);
        self.columns.push(column);
        self.rotations.push((cosine, sine));
        self.rhs.push(-sine * self.rhs[k]);
        self.rhs[k] *= cosine;
        true
    }

    /// Norm of the residual.
    fn residual(&self) -> f64 {
        self.rhs[self.columns.len()].abs()
    }

    /// Coefficients of the solution in the basis.
    fn solve(&self) -> Vec<f64> {
        let m = self.columns.len();
        let mut y = vec![0.0; m];
        for i in (0..m).rev() {
            let tail: f64 = (i + 1..m).map(|j| self.columns[j][i] * y[j]).sum();
            y[i] = (self.rhs[i] - tail) / self.columns[i][i];
        }
        y
    }
}

/// Orthogonalises a vector against a basis by the modified Gram–Schmidt method; its components and its
/// remaining length are returned.
fn orthogonalise(w: &mut [f64], basis: &[Vec<f64>]) -> Vec<f64> {
    let mut column = Vec::with_capacity(basis.len() + 1);
    for v in basis {
        let h = dot(v, w);
        for (wi, vi) in w.iter_mut().zip(v) {
            *wi -= h * vi;
        }
        column.push(h);
    }
    column.push(dot(w, w).sqrt());
    column
}

/// Solves, with the projection of the matrix if requested.
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
    let mut triangular = Triangular::new(beta);
    let mut scaled = vec![0.0; n];
    let mut answers: Vec<Vec<f64>> = Vec::new();
    let mut products = 0;
    for k in 0..limits.products.min(n) {
        precondition(inverse, &scale, &basis[k], &mut scaled);
        let mut w = vec![0.0; n];
        matrix.product(&scaled, &mut w);
        products += 1;
        let column = orthogonalise(&mut w, &basis);
        let length = column[k + 1];
        if let Some(seen) = &mut seen {
            seen.matrix.push(column.clone());
            answers.push(scaled.iter().zip(&scale).map(|(z, s)| z / s).collect());
        }
        if !triangular.add(column) || triangular.residual() <= limits.tolerance * beta || length <= 1e-300 {
            break;
        }
        basis.push(w.iter().map(|wi| wi / length).collect());
    }
    if let Some(seen) = seen {
        seen.diagonal = answers
            .iter()
            .map(|answer| basis.iter().take(answers.len()).map(|v| dot(v, answer)).collect())
            .collect();
    }
    for (v, yk) in basis.iter().zip(triangular.solve()) {
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

#[cfg(test)]
mod tests {
    use super::{Limits, LinearOperator, Preconditioner, gmres, gmres_and_least};

    /// Rows of a matrix.
    struct Rows(Vec<Vec<f64>>);

    impl LinearOperator for Rows {
        fn product(&self, x: &[f64], y: &mut [f64]) {
            for (y, row) in y.iter_mut().zip(&self.0) {
                *y = row.iter().zip(x).map(|(a, x)| a * x).sum();
            }
        }

        fn diagonal(&self, i: usize) -> f64 {
            self.0[i][i]
        }
    }

    impl Preconditioner for Rows {
        fn apply(&self, x: &[f64], y: &mut [f64]) {
            self.product(x, y);
        }
    }

    /// A diagonal and a coupling of rank one: `D + c 1 1ᵀ`.
    fn coupled(n: usize, coupling: f64) -> Rows {
        Rows(
            (0..n)
                .map(|i| {
                    (0..n).map(|j| coupling + if i == j { 1.0 + i as f64 / n as f64 } else { 0.0 }).collect()
                })
                .collect(),
        )
    }

    #[test]
    fn law_a_solution_has_the_wanted_residual() {
        let matrix = coupled(40, 0.05);
        let rhs: Vec<f64> = (0..40).map(|i| f64::from(i % 7) - 3.0).collect();
        for tolerance in [1e-3, 1e-8] {
            let found = gmres(&matrix, None, &rhs, Limits { tolerance, products: 40 });
            let mut product = vec![0.0; 40];
            matrix.product(&found.x, &mut product);
            let norm = |v: &[f64]| v.iter().map(|v| v * v).sum::<f64>().sqrt();
            let left: Vec<f64> = product.iter().zip(&rhs).map(|(p, r)| p - r).collect();
            assert!(norm(&left) <= 1.01 * tolerance * norm(&rhs), "{tolerance}");
            assert!(found.products < 20, "{}", found.products);
        }
    }

    #[test]
    fn law_the_exact_inverse_needs_one_product() {
        let matrix = Rows(vec![vec![2.0, 1.0], vec![1.0, 3.0]]);
        let inverse = Rows(vec![vec![0.6, -0.2], vec![-0.2, 0.4]]);
        let found = gmres(&matrix, Some(&inverse), &[1.0, 2.0], Limits { tolerance: 1e-12, products: 9 });
        assert_eq!(found.products, 1);
        assert!((found.x[0] - 0.2).abs() < 1e-14 && (found.x[1] - 0.6).abs() < 1e-14);
    }

    #[test]
    fn law_the_least_eigenvalue_vanishes_where_the_matrix_is_singular() {
        // D^-1 A has the smallest eigenvalue 1 - λ for A = D - λ d dᵀ/(dᵀ D^-1 d), with d the right side.
        let n = 12;
        let d: Vec<f64> = (0..n).map(|i| 1.0 + i as f64 / n as f64).collect();
        let sum: f64 = d.iter().sum();
        for share in [0.3, 0.9, 1.0 - 1e-9, 1.2] {
            let element = |i: usize, j: usize| if i == j { d[i] } else { 0.0 } - share * d[i] * d[j] / sum;
            let matrix = Rows((0..n).map(|i| (0..n).map(|j| element(i, j)).collect()).collect());
            // Each column over its diagonal element, as in the definition; elements of the coupling are below
            // a tenth of it.
            let rhs: Vec<f64> = (0..n).map(|i| 1.0 + 0.1 * i as f64).collect();
            let (_, least) = gmres_and_least(&matrix, None, &rhs, Limits { tolerance: 1e-10, products: n });
            assert_eq!(least > 0.0, share < 1.0, "{share}: {least}");
            assert!(!(0.99..=1.01).contains(&share) || least.abs() < 1e-8, "{share}: {least}");
        }
    }
}
