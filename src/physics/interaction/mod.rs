//! The displacement field of contact spots, behind one small trait.

mod direct;
pub mod ewald;
pub mod pair;

pub use direct::DirectSum;
use super::krylov::dot;
use pair::SpotColumns;

/// The spots in contact: which asperities they are, ascending, and their columns.
#[derive(Debug, Clone, Default)]
pub struct Spots {
    /// Asperity numbers, ascending.
    pub index: Vec<usize>,
    /// Their columns, in the same order.
    pub columns: SpotColumns,
}

/// `∂ŵ_i/∂a_j` over the spots in contact, rows of i.
#[derive(Debug, Clone, Default)]
pub struct Tangent {
    pub(crate) size: usize,
    pub(crate) matrix: Vec<f64>,
}

impl Tangent {
    /// `y = ∂ŵ/∂a · x`.
    pub(crate) fn product(&self, x: &[f64], y: &mut [f64]) {
        for (line, yi) in self.matrix.chunks(self.size.max(1)).zip(y.iter_mut()) {
            *yi = dot(line, x);
        }
    }

    /// `∂ŵ_i/∂a_i`: what a spot's own images and the background do to it.
    pub(crate) fn own(&self, i: usize) -> f64 {
        self.matrix[i * self.size + i]
    }
}

/// What it cost: counted, never timed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Effort {
    /// Pair fields evaluated.
    pub pairs: u64,
    /// Newton and relaxation iterations.
    pub iterations: u64,
    /// Products of the tangent with a vector.
    pub products: u64,
}

/// How contact spots displace the half-space at one another and at free asperities.
pub trait Interaction: Sync {
    /// Displacement ŵ \[m\] at each of `targets` (asperity numbers), and in `displacements` in their order. A spot does not act on its own
    /// centre, but its periodic images and the background do.
    fn displacements(&self, spots: &Spots, targets: &[usize], displacements: &mut Vec<f64>, effort: &mut Effort);

    /// Displacements at the spots themselves, with the tangent.
    fn linearise(&self, spots: &Spots, displacements: &mut Vec<f64>, tangent: &mut Tangent, effort: &mut Effort);
}
