//! Displacement field of contact spots: direct and fast sums behind one trait.

mod choose;
mod constants;
mod direct;
pub mod ewald;
mod image_polynomials;
mod multipole;
mod particle_mesh;
mod patch_pairs;
pub mod spot_field;

use crate::cycle::Effort;
use crate::math::vector::dot;
pub use choose::{FieldSum, SumPrecision, choose};
pub(crate) use constants::CONSTANTS;
pub use direct::DirectSum;
pub(crate) use direct::PointLoad;
pub use particle_mesh::FastSum;
use particle_mesh::Sparse;
pub(crate) use patch_pairs::PairTable;
use spot_field::SpotColumns;

/// Spots in contact: their asperity numbers and their columns.
#[derive(Debug, Clone, Default)]
pub struct Spots {
    /// Asperity numbers, ascending.
    pub index: Vec<usize>,
    /// Columns in the order of `index`.
    pub columns: SpotColumns,
}

/// Tangent `∂ŵ_i/∂a_j` over the spots in contact, used through products with a vector.
#[derive(Debug, Clone)]
pub struct Tangent(Form);

#[derive(Debug, Clone)]
enum Form {
    /// Number of columns, and the rows of i one after another.
    Dense(usize, Vec<f64>),
    /// Near pairs and a mesh.
    Sparse(Box<Sparse>),
}

impl Default for Tangent {
    fn default() -> Self {
        Self(Form::Dense(0, Vec::new()))
    }
}

impl Tangent {
    /// `y = ∂ŵ/∂a · x`, in the sparse form to four digits.
    pub fn product(&self, x: &[f64], y: &mut [f64]) {
        match &self.0 {
            Form::Dense(size, matrix) => {
                for (line, yi) in matrix.chunks((*size).max(1)).zip(y.iter_mut()) {
                    *yi = dot(line, x);
                }
            }
            Form::Sparse(sparse) => sparse.product(x, y),
        }
    }

    /// Number of mesh transforms in one product.
    #[must_use]
    pub fn transforms(&self) -> u64 {
        match &self.0 {
            Form::Sparse(sparse) => sparse.transforms(),
            Form::Dense(..) => 0,
        }
    }

    /// True if the tangent has full precision; the sparse form is approximate.
    #[must_use]
    pub fn is_exact(&self) -> bool {
        matches!(self.0, Form::Dense(..))
    }

    /// `∂ŵ_i/∂a_i`: effect of a spot's own images and of the background on the spot.
    #[must_use]
    pub fn own(&self, i: usize) -> f64 {
        match &self.0 {
            Form::Dense(size, matrix) => matrix[i * size + i],
            Form::Sparse(sparse) => sparse.own(i),
        }
    }

    /// Moves the matrix out, as `size` rows of zeros; [`Self::set_dense`] puts it back.
    fn take_dense(&mut self, size: usize) -> Vec<f64> {
        let mut matrix = match std::mem::take(self).0 {
            Form::Dense(_, matrix) => matrix,
            Form::Sparse(_) => Vec::new(),
        };
        matrix.clear();
        matrix.resize(size * size, 0.0);
        matrix
    }

    fn set_dense(&mut self, size: usize, matrix: Vec<f64>) {
        self.0 = Form::Dense(size, matrix);
    }

    /// Moves the sparse form out to reuse its memory.
    ///
    /// [`Self::set_sparse`] puts it back.
    fn take_sparse(&mut self) -> Box<Sparse> {
        match std::mem::take(self).0 {
            Form::Sparse(sparse) => sparse,
            Form::Dense(..) => Box::default(),
        }
    }

    fn set_sparse(&mut self, sparse: Box<Sparse>) {
        self.0 = Form::Sparse(sparse);
    }
}

/// Position in `others` of each of `numbers`, if present; both lists are ascending.
pub(crate) fn places_in<'a>(
    numbers: &'a [usize],
    others: &'a [usize],
) -> impl Iterator<Item = Option<usize>> + 'a {
    let mut at = 0;
    numbers.iter().map(move |number| {
        while others.get(at).is_some_and(|other| other < number) {
            at += 1;
        }
        (others.get(at) == Some(number)).then_some(at)
    })
}

/// Displacement of the half-space at contacts and free asperities by other contacts.
pub trait Interaction: Sync {
    /// Writes the displacement ŵ \[m\] at each of `targets` to `displacements`.
    ///
    /// Targets are asperity numbers, and their order is kept.
    ///
    /// A spot does not act on its own centre, but its periodic images and the background do.
    fn displacements(
        &self,
        spots: &Spots,
        targets: &[usize],
        displacements: &mut Vec<f64>,
        effort: &mut Effort,
    );

    /// Displacements at the spots themselves, and the tangent.
    ///
    /// Reuses the geometry cached in `tangent`.
    fn linearise(
        &self,
        spots: &Spots,
        displacements: &mut Vec<f64>,
        tangent: &mut Tangent,
        effort: &mut Effort,
    );

    /// Displacement at each of `targets`, and its derivative along a path.
    ///
    /// `rates` are the derivatives of the spots' radii along the path.
    ///
    /// Writes the displacement and `dŵ_i = Σ_j (∂ŵ_i/∂a_j) rates_j` to `found`. With `rates` = da_j/dδ the
    /// latter is dŵ_i/dδ. The geometry is cached in `kept` for the next call.
    fn along_path(
        &self,
        spots: &Spots,
        rates: &[f64],
        targets: &[usize],
        found: [&mut Vec<f64>; 2],
        kept: &mut Tangent,
        effort: &mut Effort,
    );
}
