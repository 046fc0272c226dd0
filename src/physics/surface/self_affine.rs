//! A self-affine spectrum that fits a measured one.

use super::psd_bin::Ring;

/// `C(q) = C0` up to the roll-off `q_r`, and `C0 (q/q_r)^(−2(H+1))` beyond (Eq 10 with a roll-off).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SelfAffine {
    /// Hurst exponent H; outside of (0, 1) the surface is not self-affine in the band.
    pub hurst: f64,
    /// C0 \[m⁴\].
    pub plateau_m4: f64,
    /// q_r \[1/m\]; the longest waves' wavenumber, if there is no roll-off.
    pub roll_off_1_m: f64,
    /// True if there is a roll-off within the band.
    pub rolls_off: bool,
    /// Rms deviation of log10 C from the fit, rings weighted as in it.
    pub scatter: f64,
}

/// A roll-off is told only where it lessens the sum of squares to this part.
const CLEARLY: f64 = 0.7;

/// The mean of a ring of m modes, half of which are conjugates of the others and which a window joins to their neighbours, scatters by about `sqrt(4/m)`; and no
/// spectrum is a power of q to better than this part.
const OF_MODES: f64 = 4.0;
const AT_BEST: f64 = 0.1;

/// Fits rings with wavenumbers below `highest_1_m`, where noise or the instrument takes over: least squares in log C over log q, each ring by how well it is known.
/// The roll-off is sought among the rings, with four or more beyond it; fewer than five rings have no fit.
#[must_use]
pub fn fit_self_affine(rings: &[Ring], highest_1_m: f64) -> Option<SelfAffine> {
    let points: Vec<Point> = rings
        .iter()
        .filter(|ring| ring.wavenumber_1_m < highest_1_m && ring.density_m4 > 0.0)
        .map(|ring| Point {
            x: ring.wavenumber_1_m.log10(),
            y: ring.density_m4.log10(),
            weight: 1.0 / (OF_MODES / ring.mode_count as f64 + AT_BEST * AT_BEST),
        })
        .collect();
    if points.len() < 5 {
        return None;
    }
    let fits: Vec<Line> = (0..points.len() - 4).map(|k| Line::of(&points, points[k].x)).collect();
    let straight = *fits.first()?;
    let best = fits.into_iter().min_by(|a, b| a.squares.total_cmp(&b.squares))?;
    let rolls_off = best.squares < CLEARLY * straight.squares;
    let chosen = if rolls_off { best } else { straight };
    Some(SelfAffine {
        hurst: -0.5 * chosen.slope - 1.0,
        plateau_m4: 10f64.powf(chosen.plateau),
        roll_off_1_m: 10f64.powf(chosen.from),
        rolls_off,
        scatter: chosen.squares.sqrt(),
    })
}

/// A ring in logarithms.
struct Point {
    x: f64,
    y: f64,
    weight: f64,
}

/// A plateau up to a place, and a line from there on, in logarithms.
#[derive(Debug, Clone, Copy)]
struct Line {
    from: f64,
    plateau: f64,
    slope: f64,
    /// Weighted mean of the squared deviations.
    squares: f64,
}

impl Line {
    /// The least squares of `plateau + slope max(x − from, 0)`.
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
