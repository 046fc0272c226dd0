//! Line tension of fronts: the energy `λ Δγ Σ φ Lφ` with the step [φ](super::law::Profile) of the law and the
//! negative Laplacian `L` of 9 points. [Front](super::law::Front) has its derivation.

use super::grid::half_space::HalfSpace;
use super::law::Profile;

/// Energy and tension of the line at a point.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct LineBond {
    /// Energy \[E* dx\].
    pub(crate) energy: f64,
    /// Tension \[E*\].
    pub(crate) tension: f64,
}

/// Energy and tension of the line at a point, with the `factor` 2λΔγ \[E* dx\].
pub(crate) fn line_bond(
    grid: &HalfSpace,
    point: usize,
    factor: f64,
    profile: impl Fn(usize) -> Profile,
) -> LineBond {
    let (rows, columns) = (grid.rows(), grid.columns());
    let (row, column) = (point / columns, point % columns);
    let here = profile(point);
    let columns_beside = beside(column, columns, grid.is_patch());
    let values = beside(row, rows, grid.is_patch())
        .map(|row| columns_beside.map(|column| profile(row * columns + column).value));
    let [up, [left, _, right], down] = values;
    let middle = [left, here.value, right];
    let bend = laplacian([&up, &middle, &down], [0, 1, 2]);
    LineBond { energy: 0.5 * factor * here.value * bend, tension: factor * here.rate * bend }
}

/// The places before, at and after a place: across the edges of a periodic grid, and the border itself beyond
/// that of a patch.
pub(crate) fn beside(place: usize, size: usize, is_patch: bool) -> [usize; 3] {
    if is_patch {
        [place.saturating_sub(1), place, (place + 1).min(size - 1)]
    } else {
        [(place + size - 1) % size, place, (place + 1) % size]
    }
}

/// `L` in three rows, at the middle one of three columns: `(20, −4, −1)/6`.
#[inline(always)]
pub(crate) fn laplacian([up, here, down]: [&[f64]; 3], [left, middle, right]: [usize; 3]) -> f64 {
    let edges = up[middle] + down[middle] + here[left] + here[right];
    let corners = up[left] + up[right] + down[left] + down[right];
    (20.0 * here[middle] - 4.0 * edges - corners) / 6.0
}
