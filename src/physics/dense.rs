//! Small dense linear systems: the neighbourhood of an event has some tens of spots.

/// `P·A = L·U` by Gaussian elimination with partial pivoting, rows of A one after another.
#[derive(Debug, Clone, Default)]
pub(crate) struct Lu {
    size: usize,
    factors: Vec<f64>,
    pivots: Vec<usize>,
    sign: f64,
}

impl Lu {
    /// Factors the square matrix `matrix`. A pivot that vanishes is replaced by rounding of the greatest entry, so that a solve with a
    /// singular matrix gives its null vector, greatly enlarged.
    pub(crate) fn factor(&mut self, matrix: &[f64], size: usize) {
        self.size = size;
        self.factors.clear();
        self.factors.extend_from_slice(matrix);
        self.pivots.clear();
        self.sign = 1.0;
        let n = size;
        let least = 1e-16 * matrix.iter().fold(0.0f64, |most, v| most.max(v.abs()));
        for k in 0..n {
            let mut pivot = k;
            for i in k + 1..n {
                if self.factors[i * n + k].abs() > self.factors[pivot * n + k].abs() {
                    pivot = i;
                }
            }
            self.pivots.push(pivot);
            if pivot != k {
                let (upper, lower) = self.factors.split_at_mut(pivot * n);
                upper[k * n..(k + 1) * n].swap_with_slice(&mut lower[..n]);
                self.sign = -self.sign;
            }
            let (upper, lower) = self.factors.split_at_mut((k + 1) * n);
            let top = &mut upper[k * n..];
            if top[k].abs() < least {
                top[k] = least.copysign(top[k]);
            }
            self.sign *= top[k].signum();
            let inverse = 1.0 / top[k];
            for row in lower.chunks_mut(n) {
                let factor = row[k] * inverse;
                row[k] = factor;
                if factor != 0.0 {
                    subtract(&mut row[k + 1..], factor, &top[k + 1..]);
                }
            }
        }
    }

    /// Solves `A·x = b`, in place of b.
    pub(crate) fn solve(&self, b: &mut [f64]) {
        let n = self.size;
        // All exchanges first: the factors stand in the order in which the rows ended.
        for (k, &pivot) in self.pivots.iter().enumerate() {
            b.swap(k, pivot);
        }
        for k in 0..n {
            let (done, rest) = b.split_at_mut(k);
            rest[0] -= product(&self.factors[k * n..k * n + k], done);
        }
        for k in (0..n).rev() {
            let (head, done) = b.split_at_mut(k + 1);
            head[k] = (head[k] - product(&self.factors[k * n + k + 1..(k + 1) * n], done)) / self.factors[k * n + k];
        }
    }

    /// The sign of the determinant.
    pub(crate) fn sign(&self) -> f64 {
        self.sign
    }
}

fn subtract(row: &mut [f64], factor: f64, top: &[f64]) {
    for (r, t) in row.iter_mut().zip(top) {
        *r -= factor * t;
    }
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}
