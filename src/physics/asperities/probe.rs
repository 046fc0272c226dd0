//! Asperities of roughness that a spherical probe carries.
//!
//! The sphere of radius R is a paraboloid around its apex at the middle of the square, and so is an asperity
//! around its own. Their sum is again a paraboloid, since curvatures add:
//!
//! ```text
//! z_i − |x − x_i|²/(2R_i) − |x|²/(2R) = z_i' − |x − x_i'|²/(2R_i')
//! 1/R_i' = 1/R_i + 1/R    x_i' = x_i R/(R + R_i)    z_i' = z_i − |x_i|²/(2(R + R_i))
//! ```
//!
//! For `R_i ≪ R` the asperity stays in its place and is lowered by `|x_i|²/(2R)`. Domain: contact radii small
//! compared with R. At a distance r the sphere itself is lower than its paraboloid by `r²/(4R²)` of
//! `r²/(2R)`.

use crate::PhysicsError;
use crate::math::vector::nearest_image;
use crate::model::{Boundary, Probe};
use crate::surface::summits::Summit;

/// The asperities of a surface \[m\] on a square of side `length_m`, on a probe with its apex at the middle
/// of the square; distances from it are those of the nearest image if the square is periodic.
///
/// The list keeps its order. Grid row and column are those of the surface.
///
/// # Errors
/// The radius of the probe must be positive and finite.
pub fn summits_on_probe(
    summits: &[Summit],
    probe: Probe,
    length_m: f64,
    boundary: Boundary,
) -> Result<Vec<Summit>, PhysicsError> {
    let radius = probe.radius_m;
    if !(radius > 0.0 && radius.is_finite()) {
        return Err(PhysicsError::Domain {
            action: "asperities on a probe",
            quantity: "the radius of the probe [m]",
            value: radius,
            allowed: "a positive, finite number",
        });
    }
    let middle = 0.5 * length_m;
    let on_probe = |summit: &Summit| {
        let [x, y] = [summit.x_m - middle, summit.y_m - middle]
            .map(|d| if boundary == Boundary::Periodic { nearest_image(d, length_m) } else { d });
        let joint = radius + summit.radius_m();
        let curvature = 1.0 / radius;
        Summit {
            x_m: middle + x * radius / joint,
            y_m: middle + y * radius / joint,
            height_m: summit.height_m - (x * x + y * y) / (2.0 * joint),
            curvature_1_m: summit.curvature_1_m + curvature,
            curvature_min_1_m: summit.curvature_min_1_m + curvature,
            curvature_max_1_m: summit.curvature_max_1_m + curvature,
            ..*summit
        }
    };
    Ok(summits.iter().map(on_probe).collect())
}
