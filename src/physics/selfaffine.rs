//! A self-affine spectrum that fits a measured one.

use super::periodogram::Ring;

/// `C(q) = C0` up to the roll-off `q_r`, and `C0 (q/q_r)^(−2(H+1))` beyond (Eq 10 with a roll-off).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SelfAffine {
    /// Hurst exponent H; outside of (0, 1) the surface is not self-affine in the band.
    pub hurst: f64,
    /// C0 \[m⁴\].
    pub plateau_m4: f64,
    /// q_r \[1/m\]; the longest waves' wavenumber, if there is no roll-off.
    pub roll_off_1_m: f64,
    /// Whether there is a roll-off within the band.
    pub rolls_off: bool,
    /// Rms deviation of log10 C from the fit.
    pub scatter: f64,
}

/// A roll-off is told only where it lessens the sum of squares to this part.
const CLEARLY: f64 = 0.7;

/// Fits rings with wavenumbers below `highest_1_m`, where noise or the instrument takes over: least squares in log C over log q, each ring alike. The roll-off is
/// sought among the rings, with four or more beyond it; fewer than five rings have no fit.
#[must_use]
pub fn fit_self_affine(rings: &[Ring], highest_1_m: f64) -> Option<SelfAffine> {
    let points: Vec<(f64, f64)> = rings
        .iter()
        .filter(|ring| ring.wavenumber_1_m < highest_1_m && ring.density_m4 > 0.0)
        .map(|ring| (ring.wavenumber_1_m.log10(), ring.density_m4.log10()))
        .collect();
    if points.len() < 5 {
        return None;
    }
    let fits: Vec<Line> = (0..points.len() - 4).map(|k| Line::of(&points, points[k].0)).collect();
    let straight = *fits.first()?;
    let best = fits.into_iter().min_by(|a, b| a.squares.total_cmp(&b.squares))?;
    let rolls_off = best.squares < CLEARLY * straight.squares;
    let chosen = if rolls_off { best } else { straight };
    Some(SelfAffine {
        hurst: -0.5 * chosen.slope - 1.0,
        plateau_m4: 10f64.powf(chosen.plateau),
        roll_off_1_m: 10f64.powf(chosen.from),
        rolls_off,
        scatter: (chosen.squares / points.len() as f64).sqrt(),
    })
}

/// A plateau up to a place, and a line from there on, in logarithms.
#[derive(Debug, Clone, Copy)]
struct Line {
    from: f64,
    plateau: f64,
    slope: f64,
    squares: f64,
}

impl Line {
    /// The least squares of `plateau + slope max(x − from, 0)`.
    fn of(points: &[(f64, f64)], from: f64) -> Self {
        let count = points.len() as f64;
        let beyond = |x: f64| (x - from).max(0.0);
        let mean_x = points.iter().map(|p| beyond(p.0)).sum::<f64>() / count;
        let mean_y = points.iter().map(|p| p.1).sum::<f64>() / count;
        let of = |p: &(f64, f64)| (beyond(p.0) - mean_x, p.1 - mean_y);
        let (product, norm) = points.iter().map(of).fold((0.0, 0.0), |(xy, xx), (x, y)| (xy + x * y, xx + x * x));
        let slope = product / norm;
        let plateau = mean_y - slope * mean_x;
        let squares = points.iter().map(|p| (p.1 - plateau - slope * beyond(p.0)).powi(2)).sum();
        Self { from, plateau, slope, squares }
    }
}
