//! Fit of a self-affine spectrum with a roll-off to a measured one.

use super::psd_bin::Ring;

/// Self-affine spectrum with a roll-off: `C0` up to `q_r`, then `C0 (q/q_r)^(−2(H+1))` (Eq 10).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SelfAffine {
    /// Hurst exponent H.
    ///
    /// A value outside (0, 1) means that the surface is not self-affine in the band.
    pub hurst: f64,
    /// Plateau C0 \[m⁴\].
    pub plateau_m4: f64,
    /// Roll-off wavenumber q_r \[1/m\]; the lowest wavenumber if there is no roll-off.
    pub roll_off_1_m: f64,
    /// True if there is a roll-off within the band.
    pub rolls_off: bool,
    /// Weighted rms deviation of log10 C from the fit.
    pub scatter: f64,
}

/// Ratio of the sums of squares with and without a roll-off below which it is accepted.
const ROLL_OFF_RATIO: f64 = 0.7;

/// Variance of a ring's density, in terms of `MODE_VARIANCE`/m for m modes, plus the square of `MODEL_DEVIATION`.
///
/// Half of the modes are conjugates of the others, and a window correlates neighbours: the standard deviation is about `sqrt(4/m)`.
/// No spectrum is a power law of q to better than `MODEL_DEVIATION`.
const MODE_VARIANCE: f64 = 4.0;
const MODEL_DEVIATION: f64 = 0.1;

/// Least-squares fit of log C over log q to the rings with wavenumbers below `highest_1_m`.
///
/// Above it, noise or the instrument dominates. Rings are weighted by the inverse of their variance.
/// The roll-off is searched among the rings, with at least four beyond it. Fewer than five rings give `None`.
#[must_use]
pub fn fit_self_affine(rings: &[Ring], highest_1_m: f64) -> Option<SelfAffine> {
    let points: Vec<Point> = rings
        .iter()
        .filter(|ring| ring.wavenumber_1_m < highest_1_m && ring.density_m4 > 0.0)
        .map(|ring| Point {
            x: ring.wavenumber_1_m.log10(),
            y: ring.density_m4.log10(),
            weight: 1.0 / (MODE_VARIANCE / ring.mode_count as f64 + MODEL_DEVIATION * MODEL_DEVIATION),
        })
        .collect();
    if points.len() < 5 {
        return None;
    }
    let fits: Vec<Line> = (0..points.len() - 4).map(|k| Line::of(&points, points[k].x)).collect();
    let straight = *fits.first()?;
    let best = fits.into_iter().min_by(|a, b| a.squares.total_cmp(&b.squares))?;
    let rolls_off = best.squares < ROLL_OFF_RATIO * straight.squares;
    let chosen = if rolls_off { best } else { straight };
    Some(SelfAffine {
        hurst: -0.5 * chosen.slope - 1.0,
        plateau_m4: 10f64.powf(chosen.plateau),
        roll_off_1_m: 10f64.powf(chosen.from),
        rolls_off,
        scatter: chosen.squares.sqrt(),
    })
}

/// Wavenumber and density of a ring in logarithms, and its weight.
struct Point {
    x: f64,
    y: f64,
    weight: f64,
}

/// Plateau up to `from` and a line beyond, in logarithms.
#[derive(Debug, Clone, Copy)]
struct Line {
    from: f64,
    plateau: f64,
    slope: f64,
    /// Weighted mean of the squared deviations.
    squares: f64,
}

impl Line {
    /// Least-squares fit of `plateau + slope max(x − from, 0)`.
    fn of(points: &[Point], from: f64) -> Self {
        let whole: f64 = points.iter().map(|p| p.weight).sum();
        let beyond = |p: &Point| (p.x - from).max(0.0);
        let mean = |value: &dyn Fn(&Point) -> f64| points.iter().map(|p| p.weight * value(p)).sum::<f64>() / whole;
        let (mean_x, mean_y) = (mean(&beyond), mean(&|p| p.y));
        let slope = mean(&|p| (beyond(p) - mean_x) * (p.y - mean_y)) / mean(&|p| (beyond(p) - mean_x).powi(2));
        let plateau = mean_y - slope * mean_x;
        let squares = mean(&|p| (p.y - plateau - slope * beyond(p)).powi(2));
        Self { from, plateau, slope, squares }
    }
}
