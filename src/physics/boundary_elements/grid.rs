//! Periodic grid, elastic half-space operator and their real Fourier transforms.
//!
//! The displacement `u` of a half-space under the pressure `p` satisfies `p(q) = (E*/2)|q| u(q)` for every wavevector but zero. Lengths in this module
//! are in grid spacings and pressures in E*, so the operator is `K = |q|/2` and its elastic energy `½ u·K u` in `E* dx³`.
//!
//! On a *patch*, a square of the grid outside of which displacements vanish, the pressure is the same: a convolution with the pressure around one displaced
//! point. Its transforms have one and a half times the side, so that it is exact up to offsets of half a side. Beyond, displacements near opposite borders
//! act on one another as at the offset across the border, and these are small in a local relaxation.

use super::sums::{PANEL, grain, sums};
use crate::physics::PhysicsError;
use crate::physics::memory::filled;
use rayon::prelude::*;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use rustfft::num_complex::Complex;
use rustfft::num_traits::Zero;
use rustfft::{Fft, FftNum, FftPlanner};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Stiffness that the spectral preconditioner adds, in E*/dx.
const SHIFT: f64 = 0.15;
/// Columns of wavevectors that are transformed together.
const BLOCK: usize = 8;

/// A grid of `rows × columns` points with one spacing, periodic or a patch of a periodic one, and the elastic operator on it, in double and in single
/// precision.
pub struct HalfSpace {
    rows: usize,
    columns: usize,
    /// Rows and columns of the transforms: of a periodic grid its own, of a patch one and a half times those.
    padded: (usize, usize),
    double: Plans<f64>,
    single: Plans<f32>,
}

/// Numbers that fields consist of. In single precision are the search directions and what is computed from them: an error of a direction
/// delays the minimum and does not move it.
pub trait Real: FftNum + PartialOrd + Into<f64> {
    /// Transforms in this precision.
    fn plans(half_space: &HalfSpace) -> &Plans<Self>;
    /// The nearest number.
    fn nearest(value: f64) -> Self;
}

impl Real for f64 {
    fn plans(half_space: &HalfSpace) -> &Plans<Self> {
        &half_space.double
    }

    fn nearest(value: f64) -> Self {
        value
    }
}

impl Real for f32 {
    fn plans(half_space: &HalfSpace) -> &Plans<Self> {
        &half_space.single
    }

    fn nearest(value: f64) -> Self {
        value as Self
    }
}

/// Transforms of one precision and the operator.
pub struct Plans<T> {
    forward_row: Arc<dyn RealToComplex<T>>,
    inverse_row: Arc<dyn ComplexToReal<T>>,
    forward_column: Arc<dyn Fft<T>>,
    inverse_column: Arc<dyn Fft<T>>,
    /// The operator in the space of wavevectors over the number of points, by columns: `|q|/2` of a periodic grid.
    stiffness: Vec<T>,
}

/// Work space of one operator application.
pub struct Waves<T> {
    by_row: Vec<Complex<T>>,
    by_block: Vec<Complex<T>>,
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

impl<T: Real> Plans<T> {
    fn new(rows: usize, columns: usize, of: impl Fn(usize, usize) -> f64 + Sync) -> Result<Self, PhysicsError> {
        let mut real = RealFftPlanner::<T>::new();
        let mut complex = FftPlanner::<T>::new();
        let blocks = (columns / 2 + 1).div_ceil(BLOCK);
        let mut stiffness = filled(blocks * rows * BLOCK, T::zero())?;
        let points = (rows * columns) as f64;
        stiffness.par_chunks_mut(rows * BLOCK).enumerate().for_each(|(block, values)| {
            for (k, value) in values.iter_mut().enumerate() {
                let column = block * BLOCK + k / rows;
                *value = if column > columns / 2 { T::zero() } else { T::nearest(of(k % rows, column) / points) };
            }
        });
        Ok(Self {
            forward_row: real.plan_fft_forward(columns),
            inverse_row: real.plan_fft_inverse(columns),
            forward_column: complex.plan_fft_forward(rows),
            inverse_column: complex.plan_fft_inverse(rows),
            stiffness,
        })
    }
}

impl HalfSpace {
    /// Operator on `rows × columns` points.
    ///
    /// # Errors
    /// Not enough memory.
    pub fn new(rows: usize, columns: usize) -> Result<Self, PhysicsError> {
        let of = |row: usize, column: usize| {
            let qx = TAU * row.min(rows - row) as f64 / rows as f64;
            let qy = TAU * column as f64 / columns as f64;
            0.5 * qx.hypot(qy)
        };
        Ok(Self { rows, columns, padded: (rows, columns), double: Plans::new(rows, columns, of)?, single: Plans::new(rows, columns, of)? })
    }

    /// Pressure around a unit displacement of one point of a periodic grid, at each offset \[E*/dx\]: `rows × columns` values, row by row.
    ///
    /// # Errors
    /// Not enough memory.
    pub fn kernel(&self) -> Result<Vec<f64>, PhysicsError> {
        let (mut unit, mut pressure) = (filled(self.points(), 0.0)?, filled(self.points(), 0.0)?);
        unit[0] = 1.0;
        self.apply(Operator::Stiffness, &unit, &mut pressure, &mut self.waves::<f64>()?);
        Ok(pressure)
    }

    /// Operator on a square of this grid, of at most half its side, with the grid's [`Self::kernel`]. The displacement vanishes outside the square.
    ///
    /// # Errors
    /// Not enough memory.
    pub fn patch(&self, side: usize, kernel: &[f64]) -> Result<Self, PhysicsError> {
        let size = 3 * side / 2;
        let mut waves = filled(size * size, Complex::zero())?;
        for (k, wave) in waves.iter_mut().enumerate() {
            let [row, column] = [k / size, k % size].map(|offset| offset.min(size - offset));
            wave.re = kernel[row * self.columns + column];
        }
        let plan = FftPlanner::new().plan_fft_forward(size);
        // The kernel is symmetric, so that its rows are its columns.
        for _ in 0..2 {
            plan.process(&mut waves);
            for row in 0..size {
                (0..row).for_each(|column| waves.swap(row * size + column, column * size + row));
            }
        }
        let of = |row: usize, column: usize| waves[row * size + column].re;
        Ok(Self {
            rows: side,
            columns: side,
            padded: (size, size),
            double: Plans::new(size, size, of)?,
            single: Plans::new(size, size, of)?,
        })
    }

    /// True if the grid is a patch.
    #[must_use]
    pub fn is_patch(&self) -> bool {
        self.padded.0 > self.rows
    }

    /// Points of a transform.
    pub(super) fn transformed(&self) -> u64 {
        (self.padded.0 * self.padded.1) as u64
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
    pub fn waves<T: Real>(&self) -> Result<Waves<T>, PhysicsError> {
        let half = self.padded.1 / 2 + 1;
        Ok(Waves {
            by_row: filled(self.rows * half, Complex::zero())?,
            by_block: filled(half.div_ceil(BLOCK) * self.rows * BLOCK, Complex::zero())?,
            transforms: 0,
        })
    }

    /// Applies an operator to `field` and writes the result to `result`, both of `rows × columns` values, row by row.
    ///
    /// On a periodic grid the mean of `field` does not matter but to [`Operator::Shifted`]. On a patch the inverse operators are approximate.
    pub fn apply<T: Real>(&self, operator: Operator, field: &[T], result: &mut [T], waves: &mut Waves<T>) {
        self.forward(waves, field.par_chunks(self.columns), |from, row| row.copy_from_slice(from));
        self.backward(operator, waves, result.par_chunks_mut(self.columns), |to, row| to.copy_from_slice(row));
    }

    /// First half of an application: `fill` writes each row of the field, from the item of `rows` for it, and the row is transformed. What `fill` returns,
    /// in the order of the rows.
    pub(super) fn forward<T: Real, Row: Send, Part: Send>(
        &self,
        waves: &mut Waves<T>,
        rows: impl IndexedParallelIterator<Item = Row>,
        fill: impl Fn(Row, &mut [T]) -> Part + Sync,
    ) -> Vec<Part> {
        let half = self.padded.1 / 2 + 1;
        let plans = T::plans(self);
        waves.transforms += 1;
        let rows = waves.by_row.par_chunks_mut(half).zip(rows).with_min_len(grain(self.columns));
        let parts = rows.map_init(
            || (plans.forward_row.make_input_vec(), plans.forward_row.make_scratch_vec()),
            |(input, scratch), (wave, row)| {
                let part = fill(row, &mut input[..self.columns]);
                input[self.columns..].fill(T::zero());
                let done = plans.forward_row.process_with_scratch(input, wave, scratch);
                debug_assert!(done.is_ok(), "lengths of the plan");
                part
            },
        );
        parts.collect()
    }

    /// Second half: the operator, and the transform back, of which `take` is given each row with the item of `rows` for it. What `take` returns, in the
    /// order of the rows.
    pub(super) fn backward<T: Real, Row: Send, Part: Send>(
        &self,
        operator: Operator,
        waves: &mut Waves<T>,
        rows: impl IndexedParallelIterator<Item = Row>,
        take: impl Fn(Row, &[T]) -> Part + Sync,
    ) -> Vec<Part> {
        let half = self.padded.1 / 2 + 1;
        let plans = T::plans(self);
        let Waves { by_row, by_block, transforms } = waves;
        *transforms += 1;
        let by_row: &[Complex<T>] = by_row;
        let chunks = by_block.par_chunks_mut(self.rows * BLOCK).zip(plans.stiffness.par_chunks(self.padded.0 * BLOCK)).enumerate();
        chunks.with_min_len(grain(self.rows * BLOCK)).for_each_init(
            || self.column_space::<T>(),
            |space, (block, (waves, stiffness))| self.block(operator, by_row, block, waves, stiffness, space),
        );
        let by_block: &[Complex<T>] = by_block;
        let parts = rows.enumerate().with_min_len(grain(self.columns)).map_init(
            || (plans.inverse_row.make_input_vec(), plans.inverse_row.make_scratch_vec(), plans.inverse_row.make_output_vec()),
            |(input, scratch, output), (row, item)| {
                for (block, part) in input.chunks_mut(BLOCK).enumerate() {
                    let from = (block * self.rows + row) * BLOCK;
                    part.copy_from_slice(&by_block[from..from + part.len()]);
                }
                input[0].im = T::zero();
                if self.padded.1.is_multiple_of(2) {
                    input[half - 1].im = T::zero();
                }
                let done = plans.inverse_row.process_with_scratch(input, output, scratch);
                debug_assert!(done.is_ok(), "lengths of the plan");
                take(item, &output[..self.columns])
            },
        );
        parts.collect()
    }

    fn column_space<T: Real>(&self) -> ColumnSpace<T> {
        let plans = T::plans(self);
        let scratch = plans.forward_column.get_inplace_scratch_len().max(plans.inverse_column.get_inplace_scratch_len());
        (vec![Complex::zero(); self.padded.0 * BLOCK], vec![Complex::zero(); scratch])
    }

    /// Transforms the columns of one block, multiplies by the operator and transforms back.
    fn block<T: Real>(
        &self,
        operator: Operator,
        by_row: &[Complex<T>],
        block: usize,
        waves: &mut [Complex<T>],
        stiffness: &[T],
        (columns, scratch): &mut ColumnSpace<T>,
    ) {
        let (half, rows, plans) = (self.padded.1 / 2 + 1, self.padded.0, T::plans(self));
        let (first, count) = (block * BLOCK, BLOCK.min(half - block * BLOCK));
        let columns = &mut columns[..count * rows];
        columns.chunks_mut(rows).for_each(|column| column[self.rows..].fill(Complex::zero()));
        for (row, values) in by_row.chunks(half).enumerate() {
            for (k, value) in values[first..first + count].iter().enumerate() {
                columns[k * rows + row] = *value;
            }
        }
        plans.forward_column.process_with_scratch(columns, scratch);
        let points = self.transformed() as f64;
        let (unit, shift) = (T::nearest(points.powi(-2)), T::nearest(SHIFT / points));
        let inverse = |stiff: T| if stiff > T::zero() { unit / stiff } else { T::zero() };
        match operator {
            Operator::Stiffness => multiply(columns, stiffness, |stiff| stiff),
            Operator::Compliance => multiply(columns, stiffness, inverse),
            Operator::Shifted => multiply(columns, stiffness, |stiff| unit / (stiff + shift)),
        }
        plans.inverse_column.process_with_scratch(columns, scratch);
        for (row, values) in waves.chunks_mut(BLOCK).enumerate() {
            for (k, value) in values[..count].iter_mut().enumerate() {
                *value = columns[k * rows + row];
            }
        }
    }
}

fn multiply<T: Real>(waves: &mut [Complex<T>], stiffness: &[T], factor: impl Fn(T) -> T) {
    waves.iter_mut().zip(stiffness).for_each(|(wave, stiff)| *wave = *wave * factor(*stiff));
}

/// Columns of one block and the scratch of their transforms.
type ColumnSpace<T> = (Vec<Complex<T>>, Vec<Complex<T>>);

/// Subtracts the mean.
pub(super) fn remove_mean<T: Real>(field: &mut [T]) {
    let [sum] = sums(field.len(), |range, sum| sum[0] += field[range].iter().map(|x| (*x).into()).sum::<f64>());
    let mean = T::nearest(sum / field.len() as f64);
    field.par_chunks_mut(PANEL).with_min_len(grain(PANEL)).for_each(|part| part.iter_mut().for_each(|x| *x = *x - mean));
}
