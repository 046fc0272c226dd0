//! A spherical probe on the periodic grid.
//!
//! The surface of a sphere of radius R around its apex is `z(r) = −r²/(2R)`, for contact radii small compared
//! with R. On a periodic square of side L it must be smooth across the edges as well: a cusp there would be
//! spread by the grid over all points. Its slope is therefore `−(r/R) w(r)` with a weight
//! `w` that falls from 1 at `r = 0.3 L` to 0 at `0.5 L`, by a polynomial with two continuous derivatives.
//! Inside 0.3 L the surface is that of the sphere; contact beyond is an error or a warning of the caller.

/// Radius over the side of the square up to which the surface is that of the sphere.
pub const SPHERE_SHARE: f64 = 0.3;
/// Radius over the side from which on it is level.
const LEVEL_SHARE: f64 = 0.5;

/// Weight of the slope of the sphere, and of roughness that is not periodic, at a distance r from the apex
/// over the side.
#[must_use]
pub fn weight(r: f64) -> f64 {
    let t = ((r - SPHERE_SHARE) / (LEVEL_SHARE - SPHERE_SHARE)).clamp(0.0, 1.0);
    1.0 - t * t * t * (10.0 - t * (15.0 - 6.0 * t))
}

/// Height of the sphere relative to its apex, times R over the square of the side, at a distance r from the
/// apex over the side: `−∫ r w dr`.
#[must_use]
pub fn height(r: f64) -> f64 {
    if r <= SPHERE_SHARE {
        return -0.5 * r * r;
    }
    let span = LEVEL_SHARE - SPHERE_SHARE;
    let t = ((r - SPHERE_SHARE) / span).min(1.0);
    // ∫ w dt and ∫ t w dt from 0 to t.
    let plain = t - t.powi(4) * (2.5 - t * (3.0 - t));
    let moment = t * t * (0.5 - t.powi(3) * (2.0 - t * (2.5 - 6.0 / 7.0 * t)));
    -(0.5 * SPHERE_SHARE * SPHERE_SHARE + span * (SPHERE_SHARE * plain + span * moment))
}

/// Distance of a point of a grid of `points` points along a side from the middle of the square, over the
/// side.
#[must_use]
pub fn distance(row: usize, column: usize, points: usize) -> f64 {
    let middle = (points / 2) as f64;
    (row as f64 - middle).hypot(column as f64 - middle) / points as f64
}
