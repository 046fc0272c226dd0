//! Mean, standard deviation and Student's interval of a handful of numbers.

use std::f64::consts::FRAC_PI_2;

/// Fewer samples than this are shown one by one: an interval of so few says more about the assumed
/// distribution than about them.
pub const FEW: usize = 5;

/// Statistics of a quantity from its independent samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Number of samples.
    pub count: usize,
    /// Arithmetic mean; nothing without samples.
    pub mean: Option<f64>,
    /// Standard deviation with n − 1; nothing with fewer than two samples.
    pub sd: Option<f64>,
    /// Half the width of the 95 % interval of the mean, `t(0.975, n − 1)·sd/√n`; nothing with fewer than two
    /// samples.
    pub ci95: Option<f64>,
}

impl Sample {
    /// Summarises values, adding them in the order given: the caller fixes the order, and so the last bit of
    /// the sums.
    pub fn of(values: &[f64]) -> Self {
        let count = values.len();
        if count == 0 {
            return Self { count, mean: None, sd: None, ci95: None };
        }
        let n = count as f64;
        let mean = values.iter().sum::<f64>() / n;
        if count < 2 {
            return Self { count, mean: Some(mean), sd: None, ci95: None };
        }
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        let sd = (squares / (n - 1.0)).sqrt();
        let ci95 = t_quantile(0.975, count - 1).map(|t| t * sd / n.sqrt());
        Self { count, mean: Some(mean), sd: Some(sd), ci95 }
    }
}

/// Quantile of Student's t distribution for a whole number of degrees of freedom.
///
/// With `t = √ν tan θ`, `P(|T| < t)` is a finite sum of powers of `cos θ` (Abramowitz and Stegun, 26.7.3 and
/// 26.7.4), so it is exact up to rounding; bisection in θ inverts it. Relative error below 1e-12 for
/// `ν ≤ 1000` and probabilities from 0.6 to 0.999. Nothing if `ν = 0` or the probability is not inside (0,
/// 1).
pub fn t_quantile(probability: f64, degrees_of_freedom: usize) -> Option<f64> {
    if degrees_of_freedom == 0 || !(probability > 0.0 && probability < 1.0) {
        return None;
    }
    let two_sided = (2.0 * probability - 1.0).abs();
    let (mut low, mut high) = (0.0, FRAC_PI_2);
    // 60 halvings of π/2 reach the spacing of doubles near 1; more would change nothing.
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if central_probability(middle, degrees_of_freedom) < two_sided {
            low = middle;
        } else {
            high = middle;
        }
    }
    let t = (degrees_of_freedom as f64).sqrt() * (0.5 * (low + high)).tan();
    Some(if probability < 0.5 { -t } else { t })
}

/// `P(|T| < √ν tan θ)`.
fn central_probability(theta: f64, degrees_of_freedom: usize) -> f64 {
    let (sin, cos) = theta.sin_cos();
    let odd = degrees_of_freedom % 2 == 1;
    let terms = degrees_of_freedom / 2;
    let mut term = if odd { cos } else { 1.0 };
    let mut sum = 0.0;
    for k in 1..=terms {
        sum += term;
        let (above, below) = if odd { (2 * k, 2 * k + 1) } else { (2 * k - 1, 2 * k) };
        term *= cos * cos * above as f64 / below as f64;
    }
    if odd { (theta + sin * sum) / FRAC_PI_2 } else { sin * sum }
}
