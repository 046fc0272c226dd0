//! Harmonic in-fill of missing points.

use super::edges::Edges;
use ndarray::Array2;

/// Fills missing points harmonically: the discrete Laplacian vanishes there.
///
/// At the edges of the field the slope vanishes, or the field is periodic.
pub(super) fn fill(heights: &mut Array2<f64>, edges: Edges) {
    let (rows, columns) = heights.dim();
    let holes: Vec<(usize, usize)> =
        heights.indexed_iter().filter(|(_, h)| !h.is_finite()).map(|(place, _)| place).collect();
    if holes.is_empty() {
        return;
    }
    let step = |at: usize, by: isize, n: usize| -> usize {
        let to = at as isize + by;
        match edges {
            Edges::Periodic => to.rem_euclid(n as isize) as usize,
            Edges::Open => to.clamp(0, n as isize - 1) as usize,
        }
    };
    let around = |(i, j): (usize, usize)| {
        [(step(i, -1, rows), j), (step(i, 1, rows), j), (i, step(j, -1, columns)), (i, step(j, 1, columns))]
    };
    // Initial values, from the edges of the holes inwards: the mean of the known neighbours.
    let mut open = holes.clone();
    while !open.is_empty() {
        let found: Vec<((usize, usize), f64)> = open
            .iter()
            .filter_map(|place| {
                let known: Vec<f64> =
                    around(*place).into_iter().map(|at| heights[at]).filter(|h| h.is_finite()).collect();
                (!known.is_empty()).then(|| (*place, known.iter().sum::<f64>() / known.len() as f64))
            })
            .collect();
        if found.is_empty() {
            return;
        }
        found.iter().for_each(|(place, h)| heights[*place] = *h);
        open.retain(|place| !heights[*place].is_finite());
    }
    // Successive over-relaxation until the largest change is below 1e-6 of the range.
    let (low, high) =
        heights.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), h| (low.min(*h), high.max(*h)));
    let width = (holes.len() as f64).sqrt().min(rows as f64);
    let over = 2.0 / (1.0 + (std::f64::consts::PI / (width + 1.0)).sin());
    for _ in 0..MAX_SWEEPS {
        let mut moved = 0.0_f64;
        for place in &holes {
            let mean = around(*place).into_iter().map(|at| heights[at]).sum::<f64>() / 4.0;
            let by = over * (mean - heights[*place]);
            heights[*place] += by;
            moved = moved.max(by.abs());
        }
        if moved <= 1e-6 * (high - low) {
            return;
        }
    }
}

/// Maximum number of sweeps over the missing points.
const MAX_SWEEPS: usize = 3000;
