//! Sums and maps over fields whose results do not depend on the number of threads.

use rayon::prelude::*;

/// Points whose partial sum is formed by one thread.
pub(super) const PANEL: usize = 4096;

/// Parts of `size` points that one thread takes at least, so that small grids are not divided.
pub(super) fn grain(size: usize) -> usize {
    (8 * PANEL).div_ceil(size)
}

/// Sums of `N` quantities over all points: `add` adds those of a range, panels are added in their order.
pub(super) fn sums<const N: usize>(points: usize, add: impl Fn(std::ops::Range<usize>, &mut [f64; N]) + Sync) -> [f64; N] {
    let panels = points.div_ceil(PANEL);
    let partial: Vec<[f64; N]> = (0..panels)
        .into_par_iter()
        .with_min_len(grain(PANEL))
        .map(|panel| {
            let mut sum = [0.0; N];
            add(panel * PANEL..points.min((panel + 1) * PANEL), &mut sum);
            sum
        })
        .collect();
    partial.iter().fold([0.0; N], |mut all, part| {
        all.iter_mut().zip(part).for_each(|(a, b)| *a += b);
        all
    })
}

/// Sums of `N` functions of the values of four fields at each point.
pub(super) fn sums_of<const N: usize>(fields: [&[f64]; 4], of: impl Fn([f64; 4]) -> [f64; N] + Sync) -> [f64; N] {
    sums(fields[0].len(), |range, sum| {
        let [a, b, c, d] = fields.map(|field| &field[range.clone()]);
        for (((a, b), c), d) in a.iter().zip(b).zip(c).zip(d) {
            let values = of([*a, *b, *c, *d]);
            sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
        }
    })
}

/// Scalar product.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    sums::<1>(a.len(), |range, sum| {
        sum[0] += a[range.clone()].iter().zip(&b[range]).map(|(x, y)| x * y).sum::<f64>();
    })[0]
}

/// Largest magnitude.
pub(super) fn largest(a: &[f64]) -> f64 {
    a.par_chunks(PANEL)
        .with_min_len(grain(PANEL))
        .map(|part| part.iter().fold(0.0_f64, |most, x| most.max(x.abs())))
        .reduce(|| 0.0, f64::max)
}

/// `to ← to + factor × from`.
pub(super) fn add(to: &mut [f64], factor: f64, from: &[f64]) {
    to.par_chunks_mut(PANEL)
        .zip(from.par_chunks(PANEL))
        .with_min_len(grain(PANEL))
        .for_each(|(a, b)| a.iter_mut().zip(b).for_each(|(x, y)| *x += factor * y));
}

/// Subtracts the mean.
pub(super) fn remove_mean(field: &mut [f64]) {
    let mean = sums::<1>(field.len(), |range, sum| sum[0] += field[range].iter().sum::<f64>())[0] / field.len() as f64;
    field.par_chunks_mut(PANEL).with_min_len(grain(PANEL)).for_each(|part| part.iter_mut().for_each(|x| *x -= mean));
}
