//! Line tension of fronts: the energy `λ Δγ Σ φ Lφ` with the step [φ](super::law::Profile) of the law and the
//! negative Laplacian `L` of 9 points. [Front](super::law::Front) has its derivation.

use super::grid::half_space::HalfSpace;
use super::law::{Law, Profile};

/// Tension of the line at a point of a law that has one \[E*\].
pub(crate) fn line_tension(
    grid: &HalfSpace,
    law: &Law,
    point: usize,
    profile: impl Fn(usize) -> Profile,
) -> f64 {
    let rate = profile(point).rate;
    if rate == 0.0 { 0.0 } else { law.line_factor() * rate * bend(grid, point, |k| profile(k).value) }
}

/// `Lφ` at a point, from the values of φ.
pub(crate) fn bend(grid: &HalfSpace, point: usize, value: impl Fn(usize) -> f64) -> f64 {
    let (rows, columns) = (grid.rows(), grid.columns());
    let columns_beside = beside(point % columns, columns, grid.is_patch());
    let [up, here, down] = beside(point / columns, rows, grid.is_patch())
        .map(|row| columns_beside.map(|column| value(row * columns + column)));
    laplacian([&up, &here, &down], [0, 1, 2])
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
