//! Periodic grid, elastic half-space operator and their real Fourier transforms.
//!
//! The displacement `u` of a half-space under the pressure `p` satisfies `p(q) = (E*/2)|q| u(q)` for every
//! wavevector but zero. Lengths in this module are in grid spacings and pressures in E*, so the operator is
//! `K = |q|/2` and its elastic energy `½ u·K u` in `E* dx³`.
//!
//! The mean displacement is fixed or, with the compliance of a [`Medium`], proportional to the mean pressure.
//!
//! On a *patch*, a square of the grid outside of which displacements vanish, the pressure is the same: a
//! convolution with the pressure around one displaced point. Its transforms have one and a half times the
//! side, so that it is exact up to offsets of half a side. Beyond, displacements near opposite borders act on
//! one another as at the offset across the border, and these are small in a local relaxation.

use super::medium::Medium;
use super::sums::{PANEL, grain, sums};
use crate::PhysicsError;
use crate::memory::filled;
use rayon::prelude::*;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use rustfft::num_complex::Complex;
use rustfft::num_traits::Zero;
use rustfft::{Fft, FftNum, FftPlanner};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Stiffness that the spectral preconditioner adds, in E*/dx.
const ADDED_STIFFNESS: f64 = 0.15;
/// Minimum stiffness of a mean displacement in the preconditioner, times the side \[E*\]: that of a contact
/// of an eighth of the side. A softer machine does not make the surface softer, which is held by the contact.
const STIFF_MEAN: f64 = 0.25;
/// Columns of wavevectors in a block, and rows in a group.
const BLOCK: usize = 8;

/// A grid of `rows × columns` points with one spacing, periodic or a patch of a periodic one, and the elastic
/// operator on it, in double and in single precision.
pub struct HalfSpace {
    rows: usize,
    columns: usize,
    /// Rows and columns of the transforms: of a periodic grid its own, of a patch one and a half times those.
    padded: (usize, usize),
    /// True if the grid holds a surface and its mirror images.
    is_mirrored: bool,
    /// True if the mean displacement is 0 at every load.
    fixes_mean: bool,
    medium: Medium,
    double: Plans<f64>,
    single: Plans<f32>,
}

/// Numbers that fields consist of. In single precision are the search directions and what is computed from
/// them: an error of a direction delays the minimum and does not move it.
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
    /// The operator in the space of wavevectors over the number of points, by columns: `|q|/2` of a periodic
    /// grid.
    stiffness: Vec<T>,
}

/// Work space of one operator application.
pub struct Waves<T> {
    /// Transformed rows: tiles of a group of rows one after another.
    by_group: Vec<Complex<T>>,
    /// Transformed columns: tiles of a block of columns one after another.
    by_block: Vec<Complex<T>>,
    /// Real transforms so far; an application is two.
    pub transforms: u64,
}

/// Operator of an application.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Operator {
    /// Displacement to pressure, `K = |q|/2`.
    Stiffness,
    /// Pressure to displacement, `1/K`, with 0 at `q = 0` where the mean is fixed.
    Compliance,
    /// `1/(K + 0.15)`: the spectral preconditioner, to compare the split one with.
    Shifted,
}

impl<T: Real> Plans<T> {
    fn new(
        rows: usize,
        columns: usize,
        of: impl Fn(usize, usize) -> f64 + Sync,
    ) -> Result<Self, PhysicsError> {
        let mut real = RealFftPlanner::<T>::new();
        let mut complex = FftPlanner::<T>::new();
        let blocks = (columns / 2 + 1).div_ceil(BLOCK);
        let mut stiffness = filled(blocks * rows * BLOCK, T::zero())?;
        let points = (rows * columns) as f64;
        stiffness.par_chunks_mut(rows * BLOCK).enumerate().for_each(|(block, values)| {
            for (k, value) in values.iter_mut().enumerate() {
                let column = block * BLOCK + k / rows;
                *value =
                    if column > columns / 2 { T::zero() } else { T::nearest(of(k % rows, column) / points) };
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
        Self::of(&Medium::default(), rows, columns)
    }

    /// Operator of a medium on `rows × columns` points.
    ///
    /// # Errors
    /// Not enough memory.
    pub fn of(medium: &Medium, rows: usize, columns: usize) -> Result<Self, PhysicsError> {
        let mean_compliance = medium.mean_compliance();
        let stiffness = |q: f64| match q {
            0.0 if mean_compliance > 0.0 => mean_compliance.recip(),
            0.0 => 0.0,
            q => medium.stiffness(q),
        };
        Self::multiplying(medium, rows, columns, stiffness)
    }

    /// A grid on which [`Operator::Stiffness`] multiplies by a factor of the wavenumber.
    fn multiplying(
        medium: &Medium,
        rows: usize,
        columns: usize,
        factor: impl Fn(f64) -> f64 + Sync,
    ) -> Result<Self, PhysicsError> {
        let of = |row: usize, column: usize| {
            let qx = TAU * row.min(rows - row) as f64 / rows as f64;
            let qy = TAU * column as f64 / columns as f64;
            factor(qx.hypot(qy))
        };
        Ok(Self {
            rows,
            columns,
            padded: (rows, columns),
            is_mirrored: false,
            fixes_mean: medium.mean_compliance() == 0.0,
            medium: *medium,
            double: Plans::new(rows, columns, of)?,
            single: Plans::new(rows, columns, of)?,
        })
    }

    /// Multiplies the Fourier transform of a periodic field by a factor of the wavenumber \[1/dx\].
    ///
    /// # Errors
    /// Not enough memory.
    pub(crate) fn filter(
        field: &[f64],
        columns: usize,
        factor: impl Fn(f64) -> f64 + Sync,
    ) -> Result<Vec<f64>, PhysicsError> {
        let grid = Self::multiplying(&Medium::default(), field.len() / columns, columns, factor)?;
        let mut filtered = filled(field.len(), 0.0)?;
        grid.apply(Operator::Stiffness, field, &mut filtered, &mut grid.waves::<f64>()?);
        Ok(filtered)
    }

    /// The grid of a surface and its three mirror images: the surface is the first half of the rows and
    /// columns, which are even.
    #[must_use]
    pub fn with_images(self) -> Self {
        Self { is_mirrored: true, ..self }
    }

    /// True if the grid holds a surface and its mirror images.
    #[must_use]
    pub fn is_mirrored(&self) -> bool {
        self.is_mirrored
    }

    /// Rows and columns of the surface itself.
    #[must_use]
    pub fn own(&self) -> [usize; 2] {
        let parts = if self.is_mirrored { 2 } else { 1 };
        [self.rows / parts, self.columns / parts]
    }

    /// True if a point is one of the surface itself and not of a mirror image.
    #[must_use]
    pub fn is_own(&self, point: usize) -> bool {
        let [rows, columns] = self.own();
        point / self.columns < rows && point % self.columns < columns
    }

    /// Pressure around a unit displacement of one point of a periodic grid, at each offset \[E*/dx\]:
    /// `rows × columns` values, row by row.
    ///
    /// # Errors
    /// Not enough memory.
    pub fn kernel(&self) -> Result<Vec<f64>, PhysicsError> {
        let (mut unit, mut pressure) = (filled(self.points(), 0.0)?, filled(self.points(), 0.0)?);
        unit[0] = 1.0;
        self.apply(Operator::Stiffness, &unit, &mut pressure, &mut self.waves::<f64>()?);
        Ok(pressure)
    }

    /// Operator on a square of this grid, of at most half its side, with the grid's [`Self::kernel`]. The
    /// displacement vanishes outside the square.
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
            is_mirrored: false,
            fixes_mean: false,
            medium: self.medium,
            double: Plans::new(size, size, of)?,
            single: Plans::new(size, size, of)?,
        })
    }

    /// True if the grid is a patch.
    #[must_use]
    pub fn is_patch(&self) -> bool {
        self.padded.0 > self.rows
    }

    /// True if the mean displacement is 0 at every load: neither on a patch nor with a compliance.
    #[must_use]
    pub fn fixes_mean(&self) -> bool {
        self.fixes_mean
    }

    /// The medium.
    #[must_use]
    pub fn medium(&self) -> &Medium {
        &self.medium
    }

    /// Subtracts the mean of a displacement or of its gradient, if it is fixed.
    pub(crate) fn fix_mean<T: Real>(&self, field: &mut [T]) {
        if self.fixes_mean {
            remove_mean(field);
        }
    }

    /// Points of a transform.
    pub(crate) fn transformed(&self) -> u64 {
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
        let values = self.blocks() * self.height() * BLOCK;
        Ok(Waves {
            by_group: filled(values, Complex::zero())?,
            by_block: filled(values, Complex::zero())?,
            transforms: 0,
        })
    }

    /// Applies an operator to `field` and writes the result to `result`, both of `rows × columns` values, row
    /// by row.
    ///
    /// On a periodic grid the mean of `field` does not matter but to [`Operator::Shifted`]. On a patch the
    /// inverse operators are approximate.
    pub fn apply<T: Real>(&self, operator: Operator, field: &[T], result: &mut [T], waves: &mut Waves<T>) {
        self.forward(waves, field.par_chunks(self.columns), |from, row| row.copy_from_slice(from));
        self.backward(operator, waves, result.par_chunks_mut(self.columns), |to, row| {
            to.copy_from_slice(row);
        });
    }

    /// First half of an application: `fill` writes each row of the field, from the item of `rows` for it, and
    /// the row is transformed. What `fill` returns, in the order of the rows.
    pub(crate) fn forward<T: Real, Row: Send, Part: Send>(
        &self,
        waves: &mut Waves<T>,
        rows: impl IndexedParallelIterator<Item = Row>,
        fill: impl Fn(Row, &mut [T]) -> Part + Sync,
    ) -> Vec<Part> {
        let (half, width) = (self.padded.1 / 2 + 1, self.blocks() * BLOCK);
        let plans = T::plans(self);
        waves.transforms += 1;
        let groups = waves
            .by_group
            .par_chunks_mut(width * BLOCK)
            .zip(rows.chunks(BLOCK))
            .with_min_len(grain(self.columns * BLOCK));
        let parts = groups.map_init(
            || {
                (
                    plans.forward_row.make_input_vec(),
                    vec![Complex::zero(); width * BLOCK],
                    plans.forward_row.make_scratch_vec(),
                )
            },
            |(input, lines, scratch), (group, rows)| {
                let transform = |(line, row): (&mut [Complex<T>], Row)| {
                    let part = fill(row, &mut input[..self.columns]);
                    input[self.columns..].fill(T::zero());
                    let done = plans.forward_row.process_with_scratch(input, &mut line[..half], scratch);
                    debug_assert!(done.is_ok(), "lengths of the plan");
                    part
                };
                let parts: Vec<Part> = lines.chunks_mut(width).zip(rows).map(transform).collect();
                for (block, tile) in tiles_mut(group).iter_mut().enumerate() {
                    for (row, line) in tile.iter_mut().zip(lines.chunks(width)) {
                        *row = line.as_chunks().0[block];
                    }
                }
                parts
            },
        );
        parts.flatten_iter().collect()
    }

    /// Second half: the operator, and the transform back, of which
    /// `take` is given each row with the item of `rows` for it. What `take` returns, in the order of the
    /// rows.
    pub(crate) fn backward<T: Real, Row: Send, Part: Send>(
        &self,
        operator: Operator,
        waves: &mut Waves<T>,
        rows: impl IndexedParallelIterator<Item = Row>,
        take: impl Fn(Row, &[T]) -> Part + Sync,
    ) -> Vec<Part> {
        let (half, width) = (self.padded.1 / 2 + 1, self.blocks() * BLOCK);
        let plans = T::plans(self);
        let Waves { by_group, by_block, transforms } = waves;
        *transforms += 1;
        let by_group = tiles(by_group);
        let chunks = by_block
            .par_chunks_mut(self.height() * BLOCK)
            .zip(plans.stiffness.par_chunks(self.padded.0 * BLOCK))
            .enumerate();
        chunks.with_min_len(grain(self.rows * BLOCK)).for_each_init(
            || self.column_space::<T>(),
            |space, (block, (waves, stiffness))| {
                self.block(operator, by_group, block, tiles_mut(waves), stiffness, space);
            },
        );
        let by_block = tiles(by_block);
        let parts = rows.chunks(BLOCK).enumerate().with_min_len(grain(self.columns * BLOCK)).map_init(
            || {
                (
                    vec![Complex::zero(); width * BLOCK],
                    plans.inverse_row.make_scratch_vec(),
                    plans.inverse_row.make_output_vec(),
                )
            },
            |(lines, scratch, output), (group, items)| {
                for block in 0..self.blocks() {
                    let tile = &by_block[block * self.height() / BLOCK + group];
                    for (row, line) in tile.iter().zip(lines.chunks_mut(width)) {
                        line.as_chunks_mut().0[block] = *row;
                    }
                }
                let transform = |(line, item): (&mut [Complex<T>], Row)| {
                    let line = &mut line[..half];
                    line[0].im = T::zero();
                    if self.padded.1.is_multiple_of(2) {
                        line[half - 1].im = T::zero();
                    }
                    let done = plans.inverse_row.process_with_scratch(line, output, scratch);
                    debug_assert!(done.is_ok(), "lengths of the plan");
                    take(item, &output[..self.columns])
                };
                lines.chunks_mut(width).zip(items).map(transform).collect::<Vec<_>>()
            },
        );
        parts.flatten_iter().collect()
    }

    /// Blocks of wavevectors of a row.
    fn blocks(&self) -> usize {
        (self.padded.1 / 2 + 1).div_ceil(BLOCK)
    }

    /// Rows, filled up to whole groups.
    fn height(&self) -> usize {
        self.rows.next_multiple_of(BLOCK)
    }

    fn column_space<T: Real>(&self) -> ColumnSpace<T> {
        let plans = T::plans(self);
        let scratch = plans
            .forward_column
            .get_inplace_scratch_len()
            .max(plans.inverse_column.get_inplace_scratch_len());
        ColumnSpace {
            columns: vec![Complex::zero(); self.stride() * BLOCK],
            scratch: vec![Complex::zero(); scratch],
        }
    }

    /// From one column of a block to the next. With a power of two, all columns would have the same places in
    /// the cache.
    fn stride(&self) -> usize {
        self.padded.0.next_multiple_of(BLOCK) + BLOCK
    }

    /// Transforms the columns of one block, multiplies by the operator and transforms back.
    fn block<T: Real>(
        &self,
        operator: Operator,
        by_group: &[Tile<T>],
        block: usize,
        waves: &mut [Tile<T>],
        stiffness: &[T],
        space: &mut ColumnSpace<T>,
    ) {
        let ColumnSpace { columns, scratch } = space;
        let (rows, stride, plans) = (self.padded.0, self.stride(), T::plans(self));
        for (group, tile) in by_group.iter().skip(block).step_by(self.blocks()).enumerate() {
            for (column, values) in columns.chunks_mut(stride).zip(transposed(tile)) {
                column.as_chunks_mut().0[group] = values;
            }
        }
        let points = self.transformed() as f64;
        let (unit, shift) = (T::nearest(points.powi(-2)), T::nearest(ADDED_STIFFNESS / points));
        let is_soft = !self.fixes_mean && !self.is_patch();
        let least = if is_soft { T::nearest(STIFF_MEAN / (self.rows as f64 * points)) } else { T::zero() };
        let inverse = |stiff: T| match stiff {
            stiff if stiff > least => unit / stiff,
            stiff if stiff > T::zero() => unit / least,
            _ => T::zero(),
        };
        for (column, stiffness) in columns.chunks_mut(stride).zip(stiffness.chunks(rows)) {
            let column = &mut column[..rows];
            column[self.rows..].fill(Complex::zero());
            plans.forward_column.process_with_scratch(column, scratch);
            match operator {
                Operator::Stiffness => multiply(column, stiffness, |stiff| stiff),
                Operator::Compliance => multiply(column, stiffness, inverse),
                Operator::Shifted => multiply(column, stiffness, |stiff| unit / (stiff + shift)),
            }
            plans.inverse_column.process_with_scratch(column, scratch);
        }
        for (group, tile) in waves.iter_mut().enumerate() {
            *tile = transposed(&std::array::from_fn(|k| columns[k * stride..].as_chunks().0[group]));
        }
    }
}

/// Rows and columns of wavevectors that are moved between the order by rows and the order by columns at once.
type Tile<T> = [[Complex<T>; BLOCK]; BLOCK];

fn tiles<T>(waves: &[Complex<T>]) -> &[Tile<T>] {
    waves.as_chunks().0.as_chunks().0
}

fn tiles_mut<T>(waves: &mut [Complex<T>]) -> &mut [Tile<T>] {
    waves.as_chunks_mut().0.as_chunks_mut().0
}

fn transposed<T: Real>(tile: &Tile<T>) -> Tile<T> {
    std::array::from_fn(|k| std::array::from_fn(|row| tile[row][k]))
}

fn multiply<T: Real>(waves: &mut [Complex<T>], stiffness: &[T], factor: impl Fn(T) -> T) {
    waves.iter_mut().zip(stiffness).for_each(|(wave, stiff)| *wave = *wave * factor(*stiff));
}

/// Columns of one block and the scratch of their transforms.
struct ColumnSpace<T> {
    columns: Vec<Complex<T>>,
    scratch: Vec<Complex<T>>,
}

/// Subtracts the mean.
fn remove_mean<T: Real>(field: &mut [T]) {
    let [sum] =
        sums(field.len(), |range, sum| sum[0] += field[range].iter().map(|x| (*x).into()).sum::<f64>());
    let mean = T::nearest(sum / field.len() as f64);
    field
        .par_chunks_mut(PANEL)
        .with_min_len(grain(PANEL))
        .for_each(|part| part.iter_mut().for_each(|x| *x = *x - mean));
}
