//! Approximate adhesive contact from the load and the area of adhesionless contact.
//!
//! # Equations
//! Adhesionless contact at the penetration `δ1` has the load `P1`, the area `A` and the stiffness
//! `S = dP1/dδ1`. Withdraw the surfaces by `x` at a constant contact area. The load falls to `P = P1 − S x`
//! at the penetration `δ = δ1 − x`. The energy release rate is `½ x² dS/dA`. Griffith's condition, that it is
//! equal to Δγ, gives
//!
//! ```text
//! x = sqrt(2Δγ/(dS/dA)),   δ = δ1 − x,   P = P1 − S x
//! ```
//!
//! Ciavarella, J. Appl. Mech. 85:011003 (2018), arXiv:1712.05844, with `dS/dA = P1''/A'`.
//! It is exact for spheres and sinusoids, whose contact grows through one family of shapes.
//! On a rough surface all contacts have one common displacement of withdrawal.

use std::f64::consts::SQRT_2;

/// Number of neighbours on either side in the estimate of the derivative `dS/dA`.
const WINDOW: usize = 4;

/// Point of a curve of load and contact area over penetration.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CurvePoint {
    /// Penetration \[m\].
    pub penetration_m: f64,
    /// Load over E* \[m²\], positive in compression.
    pub load_m2: f64,
    /// Contact area \[m²\].
    pub area_m2: f64,
}

/// Adhesive states from an adhesionless curve, by ascending area, with `work_length_m` = `Δγ/E*` \[m\].
///
/// The areas are the means of neighbouring points. Fewer than five stiffness values give an empty curve.
///
/// `curve` has ascending penetrations. `S` is the difference quotient between two points.
/// `dS/dA` is the slope of a least-squares line through nine of them, five at the ends.
/// Points where it is not positive have no adhesive state and are omitted.
#[must_use]
pub fn adhesive_curve(curve: &[CurvePoint], work_length_m: f64) -> Vec<CurvePoint> {
    let middles: Vec<(CurvePoint, f64)> = curve
        .windows(2)
        .filter(|pair| pair[1].penetration_m > pair[0].penetration_m)
        .map(|pair| {
            let middle = |value: fn(&CurvePoint) -> f64| 0.5 * (value(&pair[0]) + value(&pair[1]));
            let point = CurvePoint {
                penetration_m: middle(|p| p.penetration_m),
                load_m2: middle(|p| p.load_m2),
                area_m2: middle(|p| p.area_m2),
            };
            (point, (pair[1].load_m2 - pair[0].load_m2) / (pair[1].penetration_m - pair[0].penetration_m))
        })
        .collect();
    let adhesive = |(k, (point, _)): (usize, &(CurvePoint, f64))| {
        let near = &middles[k.saturating_sub(WINDOW)..middles.len().min(k + WINDOW + 1)];
        let (slope, stiffness) = line(near, point.area_m2)?;
        let withdrawn = SQRT_2 * (work_length_m / slope).sqrt();
        (slope > 0.0).then_some(CurvePoint {
            penetration_m: point.penetration_m - withdrawn,
            load_m2: point.load_m2 - stiffness * withdrawn,
            area_m2: point.area_m2,
        })
    };
    middles.iter().enumerate().filter_map(adhesive).collect()
}

/// Least-squares line of the stiffness over the area: its slope, and its value at an area.
fn line(points: &[(CurvePoint, f64)], at_m2: f64) -> Option<(f64, f64)> {
    let count = points.len() as f64;
    let mean = |value: &dyn Fn(&(CurvePoint, f64)) -> f64| points.iter().map(value).sum::<f64>() / count;
    let (area, stiffness) = (mean(&|p| p.0.area_m2), mean(&|p| p.1));
    let spread = mean(&|p| (p.0.area_m2 - area).powi(2));
    let slope = mean(&|p| (p.0.area_m2 - area) * (p.1 - stiffness)) / spread;
    (points.len() > WINDOW && slope.is_finite()).then_some((slope, stiffness + slope * (at_m2 - area)))
}

/// Loading–unloading loop along an adhesive curve under displacement control.
///
/// Contact forms at zero penetration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurveLoop {
    /// Contact area at the largest load \[m²\].
    pub area_m2: f64,
    /// Pull-off force over E* \[m²\], positive.
    pub pull_off_m2: f64,
    /// Dissipated energy over E* \[m³\].
    pub loss_m3: f64,
}

/// Loop to a maximum load over E* \[m²\], if the approximation is valid on it.
///
/// `None` if the curve does not reach the load, or if contact is lost at a penetration that is not negative.
/// It is `None` too if contact is lost at an area
/// of at least half the area at that load. In the latter case the curve jumps to near full contact.
///
/// Unloading follows the curve from the last point at or below that load.
/// It ends at the smallest penetration before the curve would rise again, where contact is lost.
/// The dissipated energy is the integral of the tensile load from there to zero penetration.
/// It is the energy lost when contact forms at zero penetration and when it separates.
#[must_use]
pub fn curve_loop(curve: &[CurvePoint], max_load_m2: f64) -> Option<CurveLoop> {
    let end = curve.iter().rposition(|point| point.load_m2 <= max_load_m2)?;
    let beyond = curve.get(end + 1)?;
    let part = (max_load_m2 - curve[end].load_m2) / (beyond.load_m2 - curve[end].load_m2);
    let start = (1..=end).rev().find(|k| curve[*k - 1].penetration_m >= curve[*k].penetration_m).unwrap_or(0);
    let branch = &curve[start..=end];
    let piece = |pair: &[CurvePoint]| {
        let [from, to] = [pair[0], pair[1]];
        let share = ((0.0_f64.min(to.penetration_m) - from.penetration_m)
            / (to.penetration_m - from.penetration_m))
            .clamp(0.0, 1.0);
        let last = from.load_m2 + share * (to.load_m2 - from.load_m2);
        -0.5 * (from.load_m2 + last) * share * (to.penetration_m - from.penetration_m)
    };
    let area_m2 = curve[end].area_m2 + part * (beyond.area_m2 - curve[end].area_m2);
    (branch[0].penetration_m < 0.0 && branch[0].area_m2 < 0.5 * area_m2).then(|| CurveLoop {
        area_m2,
        pull_off_m2: -branch.iter().map(|point| point.load_m2).fold(0.0, f64::min),
        loss_m3: branch.windows(2).map(piece).sum(),
    })
}
