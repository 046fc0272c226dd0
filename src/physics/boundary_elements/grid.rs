//! Periodic grid, elastic half-space operator and their real Fourier transforms.
//!
//! The displacement `u` of a half-space under the pressure `p` satisfies `p(q) = (E*/2)|q| u(q)` for every wavevector but zero. Lengths in this module
//! are in grid spacings and pressures in E*, so the operator is `K = |q|/2` and its elastic energy `½ u·K u` in `E* dx³`.

use super::sums::grain;
use crate::physics::PhysicsError;
use crate::physics::memory::filled;
use rayon::prelude::*;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use rustfft::num_complex::Complex64;
use rustfft::{Fft, FftPlanner};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Stiffness that the spectral preconditioner adds, in E*/dx.
const SHIFT: f64 = 0.15;
/// Columns of wavevectors that are transformed together.
const BLOCK: usize = 8;

/// A periodic grid of `rows × columns` points with one spacing, and the elastic operator on it.
pub struct HalfSpace {
    rows: usize,
    columns: usize,
    forward_row: Arc<dyn RealToComplex<f64>>,
    inverse_row: Arc<dyn ComplexToReal<f64>>,
    forward_column: Arc<dyn Fft<f64>>,
    inverse_column: Arc<dyn Fft<f64>>,
    /// `|q|/2` over the number of points, by blocks of columns.
    stiffness: Vec<f64>,
}

/// Work space of one operator application.
pub struct Waves {
    by_row: Vec<Complex64>,
    by_block: Vec<Complex64>,
    /// Real transforms so far; an application is two.
    pub transforms: u64,
}

/// Operator of an application.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Operator {
    /// Displacement to pressure, `K = |q|/2`.
    Stiffness,
    /// Pressure to displacement, `1/K`, with 0 at `q = 0`.
    Compliance,
    /// `1/(K + 0.15)`: the spectral preconditioner, to compare the split one with.
    Shifted,
}

impl HalfSpace {
    /// Operator on `rows × columns` points.
    ///
    /// # Errors
    /// Not enough memory.
    pub fn new(rows: usize, columns: usize) -> Result<Self, PhysicsError> {
        let mut real = RealFftPlanner::<f64>::new();
        let mut complex = FftPlanner::<f64>::new();
        let half = columns / 2 + 1;
        let blocks = half.div_ceil(BLOCK);
        let mut stiffness = filled(blocks * rows * BLOCK, 0.0)?;
        let points = (rows * columns) as f64;
        stiffness.par_chunks_mut(rows * BLOCK).enumerate().for_each(|(block, values)| {
            for (k, value) in values.iter_mut().enumerate() {
                let (row, column) = (k / BLOCK, block * BLOCK + k % BLOCK);
                let qx = TAU * row.min(rows - row) as f64 / rows as f64;
                let qy = TAU * column as f64 / columns as f64;
                *value = 0.5 * qx.hypot(qy) / points;
            }
        });
        Ok(Self {
            rows,
            columns,
            forward_row: real.plan_fft_forward(columns),
            inverse_row: real.plan_fft_inverse(columns),
            forward_column: complex.plan_fft_forward(rows),
            inverse_column: complex.plan_fft_inverse(rows),
            stiffness,
        })
    }

    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Number of columns.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Number of points.
    #[must_use]
    pub fn points(&self) -> usize {
        self.rows * self.columns
    }

    /// Work space for [`Self::apply`].
    ///
    /// # Errors
    /// Not enough memory.
    pub fn waves(&self) -> Result<Waves, PhysicsError> {
        let half = self.columns / 2 + 1;
        Ok(Waves {
            by_row: filled(self.rows * half, Complex64::ZERO)?,
            by_block: filled(half.div_ceil(BLOCK) * self.rows * BLOCK, Complex64::ZERO)?,
            transforms: 0,
        })
    }

    /// Applies an operator to `field` and writes the result to `result`. Neither has a component at `q = 0`.
    pub fn apply(&self, operator: Operator, field: &[f64], result: &mut [f64], waves: &mut Waves) {
        let half = self.columns / 2 + 1;
        let Waves { by_row, by_block, transforms } = waves;
        *transforms += 2;
        by_row.par_chunks_mut(half).zip(field.par_chunks(self.columns)).with_min_len(grain(self.columns)).for_each_init(
            || (self.forward_row.make_input_vec(), self.forward_row.make_scratch_vec()),
            |(input, scratch), (row, values)| {
                input.copy_from_slice(values);
                let done = self.forward_row.process_with_scratch(input, row, scratch);
                debug_assert!(done.is_ok(), "lengths of the plan");
            },
        );
        let by_row: &[Complex64] = by_row;
        let chunks = by_block.par_chunks_mut(self.rows * BLOCK).zip(self.stiffness.par_chunks(self.rows * BLOCK)).enumerate();
        chunks.with_min_len(grain(self.rows * BLOCK)).for_each_init(
            || self.column_space(),
            |space, (block, (waves, stiffness))| self.block(operator, by_row, block, waves, stiffness, space),
        );
        let by_block: &[Complex64] = by_block;
        result.par_chunks_mut(self.columns).enumerate().with_min_len(grain(self.columns)).for_each_init(
            || (self.inverse_row.make_input_vec(), self.inverse_row.make_scratch_vec()),
            |(input, scratch), (row, values)| {
                for (block, part) in input.chunks_mut(BLOCK).enumerate() {
                    let from = (block * self.rows + row) * BLOCK;
                    part.copy_from_slice(&by_block[from..from + part.len()]);
                }
                input[0].im = 0.0;
                if self.columns.is_multiple_of(2) {
                    input[half - 1].im = 0.0;
                }
                let done = self.inverse_row.process_with_scratch(input, values, scratch);
                debug_assert!(done.is_ok(), "lengths of the plan");
            },
        );
    }

    fn column_space(&self) -> (Vec<Complex64>, Vec<Complex64>) {
        let scratch = self.forward_column.get_inplace_scratch_len().max(self.inverse_column.get_inplace_scratch_len());
        (vec![Complex64::ZERO; self.rows * BLOCK], vec![Complex64::ZERO; scratch])
    }

    /// Transforms the columns of one block, multiplies by the operator and transforms back.
    fn block(
        &self,
        operator: Operator,
        by_row: &[Complex64],
        block: usize,
        waves: &mut [Complex64],
        stiffness: &[f64],
        (columns, scratch): &mut (Vec<Complex64>, Vec<Complex64>),
    ) {
        let half = self.columns / 2 + 1;
        let (first, count) = (block * BLOCK, BLOCK.min(half - block * BLOCK));
        let columns = &mut columns[..count * self.rows];
        for (row, values) in by_row.chunks(half).enumerate() {
            for (k, value) in values[first..first + count].iter().enumerate() {
                columns[k * self.rows + row] = *value;
            }
        }
        self.forward_column.process_with_scratch(columns, scratch);
        let unit = 1.0 / (self.points() as f64).powi(2);
        for k in 0..count {
            for row in 0..self.rows {
                let stiff = stiffness[row * BLOCK + k];
                columns[k * self.rows + row] *= match operator {
                    Operator::Stiffness => stiff,
                    Operator::Compliance if stiff > 0.0 => unit / stiff,
                    Operator::Compliance => 0.0,
                    Operator::Shifted => unit / (stiff + SHIFT * self.points() as f64 * unit),
                };
            }
        }
        self.inverse_column.process_with_scratch(columns, scratch);
        for (row, values) in waves.chunks_mut(BLOCK).enumerate() {
            for (k, value) in values[..count].iter_mut().enumerate() {
                *value = columns[k * self.rows + row];
            }
        }
    }
}
