//! Sums and maps over fields whose results do not depend on the number of threads.

use rayon::prelude::*;

/// Points whose partial sum is formed by one thread, in single precision where the field is.
pub(crate) const PANEL: usize = 4096;
/// Points of a panel that are added side by side.
const LANES: usize = 64;

/// Parts of `size` points that one thread takes at least, so that small grids are not divided.
pub(crate) fn grain(size: usize) -> usize {
    (8 * PANEL).div_ceil(size)
}

/// Adds partial sums in their order.
pub(crate) fn total<const N: usize>(parts: impl IndexedParallelIterator<Item = [f64; N]>) -> [f64; N] {
    let parts: Vec<[f64; N]> = parts.with_min_len(grain(PANEL)).collect();
    parts.iter().fold([0.0; N], |mut all, part| {
        all.iter_mut().zip(part).for_each(|(a, b)| *a += b);
        all
    })
}

/// Sums of `N` quantities over all points: `add` adds those of a range, panels are added in their order.
pub(crate) fn sums<const N: usize>(
    points: usize,
    add: impl Fn(std::ops::Range<usize>, &mut [f64; N]) + Sync,
) -> [f64; N] {
    total((0..points.div_ceil(PANEL)).into_par_iter().map(|panel| {
        let mut sum = [0.0; N];
        add(panel * PANEL..points.min((panel + 1) * PANEL), &mut sum);
        sum
    }))
}

/// Sums over one panel of `N` functions of the values of `M` fields at each point, which vanish where all
/// fields do: runs in single precision, their sums in double.
#[inline(always)]
pub(crate) fn panel_sums<const M: usize, const N: usize>(
    fields: [&[f32]; M],
    of: impl Fn([f32; M]) -> [f32; N],
) -> [f64; N] {
    let mut sum = [0.0; N];
    let points = fields[0].len();
    let mut last = [[0.0; LANES]; M];
    for run in (0..points).step_by(PANEL) {
        let end = points.min(run + PANEL);
        let mut lanes = [[0.0_f32; LANES]; N];
        for start in (run..end).step_by(LANES) {
            let count = LANES.min(end - start);
            if count < LANES {
                // The end of the panel, filled up with 0.
                last.iter_mut()
                    .zip(fields)
                    .for_each(|(last, field)| last[..count].copy_from_slice(&field[start..end]));
            }
            let at: [&[f32; LANES]; M] =
                std::array::from_fn(|k| fields[k][start..start + count].try_into().unwrap_or(&last[k]));
            for lane in 0..LANES {
                let values = of(at.map(|field| field[lane]));
                for (to, value) in lanes.iter_mut().zip(values) {
                    to[lane] += value;
                }
            }
        }
        // Side by side, since each addition waits for the one before.
        let mut run_sum = [0.0; N];
        for lane in 0..LANES.min(end - run) {
            run_sum.iter_mut().zip(&lanes).for_each(|(to, lanes)| *to += f64::from(lanes[lane]));
        }
        sum.iter_mut().zip(run_sum).for_each(|(to, part)| *to += part);
    }
    sum
}

/// The larger of two values, `a` if `b` is not a number.
#[inline(always)]
fn larger(a: f32, b: f32) -> f32 {
    if b > a { b } else { a }
}

/// Largest magnitude on one panel.
#[inline(always)]
pub(crate) fn panel_largest(field: &[f32]) -> f64 {
    let mut most = [0.0_f32; LANES];
    for part in field.chunks(LANES) {
        for (most, value) in most.iter_mut().zip(part) {
            *most = larger(*most, value.abs());
        }
    }
    for width in (0..LANES.ilog2()).rev().map(|power| 1 << power) {
        let (first, second) = most.split_at_mut(width);
        first.iter_mut().zip(second).for_each(|(a, b)| *a = larger(*a, *b));
    }
    f64::from(most[0])
}

/// Scalar product.
pub(crate) fn dot(a: &[f32], b: &[f32]) -> f64 {
    let [sum] = total(
        (a.par_chunks(PANEL), b.par_chunks(PANEL))
            .into_par_iter()
            .map(|(a, b)| panel_sums([a, b], |[x, y]| [x * y])),
    );
    sum
}

/// Largest magnitude.
pub(crate) fn largest(a: &[f32]) -> f64 {
    a.par_chunks(PANEL).with_min_len(grain(PANEL)).map(panel_largest).reduce(|| 0.0, f64::max)
}

/// `to ← to + factor × from`.
pub(crate) fn add(to: &mut [f32], factor: f64, from: &[f32]) {
    let factor = factor as f32;
    let fields =
        (to.par_chunks_mut(PANEL), from.par_chunks(PANEL)).into_par_iter().with_min_len(grain(PANEL));
    fields.for_each(|(a, b)| a.iter_mut().zip(b).for_each(|(x, y)| *x += factor * y));
}
