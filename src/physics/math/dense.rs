//! Small dense linear systems: the neighbourhood of an event has some tens of spots.

use multiversion::multiversion;

/// Rows of the factors are padded to multiples of this.
const LANES: usize = 8;

/// `P·A = L·U` by Gaussian elimination with partial pivoting, rows of A one after another.
#[derive(Debug, Clone, Default)]
pub(crate) struct Lu {
    size: usize,
    factors: Vec<f64>,
    pivots: Vec<usize>,
    sign: f64,
}

impl Lu {
    /// Factors the square matrix `matrix`. A pivot that vanishes is replaced by rounding of the largest
    /// entry, so that a solve with a singular matrix gives its null vector, greatly enlarged.
    pub(crate) fn factor(&mut self, matrix: &[f64], size: usize) {
        self.size = size;
        self.factors.clear();
        for row in matrix.chunks(size.max(1)) {
            self.factors.extend_from_slice(row);
            self.factors.resize(self.factors.len().next_multiple_of(LANES), 0.0);
        }
        self.pivots.clear();
        self.sign = eliminate(&mut self.factors, &mut self.pivots, size);
    }

    /// Solves `A·x = b`, in place of b.
    pub(crate) fn solve(&self, b: &mut [f64]) {
        let n = self.size;
        // All exchanges first: the factors are in the final order of the rows.
        for (k, &pivot) in self.pivots.iter().enumerate() {
            b.swap(k, pivot);
        }
        for k in 0..n {
            let (done, rest) = b.split_at_mut(k);
            rest[0] -= product(&self.row(k)[..k], done);
        }
        for k in (0..n).rev() {
            let (head, done) = b.split_at_mut(k + 1);
            head[k] = (head[k] - product(&self.row(k)[k + 1..], done)) / self.row(k)[k];
        }
    }

    /// Solves it for several right sides at once: `b` has a row for each row of A.
    pub(crate) fn solve_all(&self, b: &mut [f64], columns: usize) {
        for (k, &pivot) in self.pivots.iter().enumerate().filter(|(k, pivot)| k != *pivot) {
            let (upper, lower) = b.split_at_mut(pivot * columns);
            upper[k * columns..(k + 1) * columns].swap_with_slice(&mut lower[..columns]);
        }
        substitute(self, b, columns);
    }

    /// A row of the factors, without padding.
    fn row(&self, k: usize) -> &[f64] {
        &self.factors[k * stride(self.size)..][..self.size]
    }

    /// The sign of the determinant.
    pub(crate) fn sign(&self) -> f64 {
        self.sign
    }
}

/// Length of a padded row.
fn stride(size: usize) -> usize {
    size.next_multiple_of(LANES)
}

/// The factors in place of the padded matrix; the sign of the determinant.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn eliminate(matrix: &mut [f64], pivots: &mut Vec<usize>, n: usize) -> f64 {
    let mut sign = 1.0;
    let least = 1e-16 * matrix.iter().fold(0.0f64, |most, v| most.max(v.abs()));
    let stride = stride(n);
    let mut right = vec![0.0; stride];
    for k in 0..n {
        let (mut pivot, mut largest) = (k, matrix[k * stride + k].abs());
        for (i, row) in matrix.chunks(stride).enumerate().skip(k + 1) {
            let value = row[k].abs();
            (pivot, largest) = if value > largest { (i, value) } else { (pivot, largest) };
        }
        pivots.push(pivot);
        if pivot != k {
            let (upper, lower) = matrix.split_at_mut(pivot * stride);
            upper[k * stride..(k + 1) * stride].swap_with_slice(&mut lower[..stride]);
            sign = -sign;
        }
        let (upper, lower) = matrix.split_at_mut((k + 1) * stride);
        let top = &mut upper[k * stride..];
        if top[k].abs() < least {
            top[k] = least.copysign(top[k]);
        }
        sign *= top[k].signum();
        let inverse = 1.0 / top[k];
        // Whole passes: what is left of the diagonal stays as it is.
        right[..=k].fill(0.0);
        right[k + 1..].copy_from_slice(&top[k + 1..]);
        let from = (k + 1) / LANES * LANES;
        for row in lower.chunks_mut(stride) {
            let factor = row[k] * inverse;
            if factor != 0.0 {
                subtract(&mut row[from..], factor, &right[from..]);
            }
            // Last: a pass that is loaded right after a store to one of its lanes waits for it.
            row[k] = factor;
        }
    }
    sign
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn substitute(factors: &Lu, b: &mut [f64], columns: usize) {
    for k in 0..factors.size {
        let (done, rest) = b.split_at_mut(k * columns);
        for (factor, row) in factors.row(k)[..k].iter().zip(done.chunks(columns)) {
            subtract(&mut rest[..columns], *factor, row);
        }
    }
    for k in (0..factors.size).rev() {
        let (head, done) = b.split_at_mut((k + 1) * columns);
        let row = &mut head[k * columns..];
        for (factor, other) in factors.row(k)[k + 1..].iter().zip(done.chunks(columns)) {
            subtract(row, *factor, other);
        }
        let inverse = 1.0 / factors.row(k)[k];
        row.iter_mut().for_each(|v| *v *= inverse);
    }
}

#[inline(always)]
fn subtract(row: &mut [f64], factor: f64, top: &[f64]) {
    let ((row, row_rest), (top, top_rest)) = (row.as_chunks_mut::<LANES>(), top.as_chunks::<LANES>());
    for (row, top) in row.iter_mut().zip(top) {
        // Copies: stores to the one do not alias loads of the other then, and the loop vectorises.
        let (mut r, t) = (*row, *top);
        for k in 0..LANES {
            r[k] -= factor * t[k];
        }
        *row = r;
    }
    for (r, t) in row_rest.iter_mut().zip(top_rest) {
        *r -= factor * t;
    }
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    let mut strands = [0.0; 4];
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<4>(), b.as_chunks::<4>());
    for (x, y) in a.iter().zip(b) {
        for k in 0..4 {
            strands[k] += x[k] * y[k];
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(x, y)| x * y).sum();
    strands.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    use super::Lu;

    /// Values of a fixed sequence in [−½, ½).
    fn values(count: usize) -> Vec<f64> {
        (0..count)
            .scan(1u64, |seed, _| {
                *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                Some((*seed >> 11) as f64 / (1u64 << 53) as f64 - 0.5)
            })
            .collect()
    }

    #[test]
    fn law_a_solution_satisfies_its_system() {
        for n in [1, 2, 7, 24, 45] {
            let matrix = values(n * n);
            let x = values(n + 3)[3..].to_vec();
            let b: Vec<f64> =
                matrix.chunks(n).map(|row| row.iter().zip(&x).map(|(a, x)| a * x).sum()).collect();
            let mut lu = Lu::default();
            lu.factor(&matrix, n);
            let mut found = b.clone();
            lu.solve(&mut found);
            // Condition numbers of these matrices are below 1e4.
            assert!(found.iter().zip(&x).all(|(f, x)| (f - x).abs() < 1e-11), "{n}");
            // Two right sides at once: the second twice the first.
            let mut both: Vec<f64> = b.iter().flat_map(|b| [*b, 2.0 * b]).collect();
            lu.solve_all(&mut both, 2);
            assert!(
                both.chunks(2)
                    .zip(&x)
                    .all(|(f, x)| (f[0] - x).abs() < 1e-11 && (f[1] - 2.0 * x).abs() < 2e-11),
                "{n}"
            );
        }
    }

    #[test]
    fn law_the_sign_is_that_of_the_determinant() {
        let mut lu = Lu::default();
        for (matrix, sign) in
            [([2.0, 1.0, 1.0, 3.0], 1.0), ([1.0, 3.0, 2.0, 1.0], -1.0), ([0.0, 1.0, 1.0, 0.0], -1.0)]
        {
            lu.factor(&matrix, 2);
            assert_eq!(lu.sign(), sign, "{matrix:?}");
        }
    }

    #[test]
    fn lim_a_singular_matrix_gives_its_null_vector() {
        let mut lu = Lu::default();
        lu.factor(&[1.0, 2.0, 2.0, 4.0], 2);
        let mut x = [1.0, 0.0];
        lu.solve(&mut x);
        // Null vector (2, −1), enlarged by the replaced pivot.
        assert!((x[0] / x[1] + 2.0).abs() < 1e-12 && x[0].abs() > 1e12, "{x:?}");
    }
}
