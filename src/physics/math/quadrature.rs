//! Gauss quadrature and Hermite interpolation on the unit interval.

/// Cubic through `f0` at 0 and `f1` at 1 with the slopes `t0` and `t1`, at `x`.
pub(crate) fn hermite(x: f64, f0: f64, f1: f64, t0: f64, t1: f64) -> f64 {
    let y = 1.0 - x;
    y * y * (1.0 + 2.0 * x) * f0 + x * x * (1.0 + 2.0 * y) * f1 + x * y * (y * t0 - x * t1)
}

/// Derivative of [`hermite`] at `x`.
pub(crate) fn hermite_slope(x: f64, f0: f64, f1: f64, t0: f64, t1: f64) -> f64 {
    let y = 1.0 - x;
    6.0 * x * y * (f1 - f0) + y * (y - 2.0 * x) * t0 + x * (x - 2.0 * y) * t1
}

/// `∫f dp` over `[0, 1]` by Gauss's rule of four points.
pub(crate) fn gauss(f: impl Fn(f64) -> f64) -> f64 {
    gauss_at_once(|points| points.map(&f))
}

/// [`gauss`] of a function of all four points at once.
pub(crate) fn gauss_at_once(f: impl FnOnce([f64; 4]) -> [f64; 4]) -> f64 {
    let (inner, outer) = (0.339_981_043_584_856_3 / 2.0, 0.861_136_311_594_052_6 / 2.0);
    let (heavy, light) = (0.652_145_154_862_546_1 / 2.0, 0.347_854_845_137_453_9 / 2.0);
    let [first, second, third, fourth] = f([0.5 - outer, 0.5 - inner, 0.5 + inner, 0.5 + outer]);
    light * (first + fourth) + heavy * (second + third)
}

#[cfg(test)]
mod tests {
    use super::{gauss, hermite, hermite_slope};

    #[test]
    fn law_four_points_integrate_degree_seven() {
        for degree in 0..8 {
            let exact = 1.0 / f64::from(degree + 1);
            assert!((gauss(|p| p.powi(degree)) - exact).abs() < 1e-15, "{degree}");
        }
        assert!((gauss(|p| p.powi(8)) - 1.0 / 9.0).abs() > 1e-7, "the rule has degree seven");
    }

    #[test]
    fn law_the_cubic_is_reproduced() {
        let (f, slope) =
            (|x: f64| 1.0 + x * (2.0 + x * (-3.0 + 4.0 * x)), |x: f64| 2.0 + x * (-6.0 + 12.0 * x));
        for x in [0.0, 0.3, 0.9, 1.0] {
            assert!((hermite(x, f(0.0), f(1.0), slope(0.0), slope(1.0)) - f(x)).abs() < 1e-14);
            assert!((hermite_slope(x, f(0.0), f(1.0), slope(0.0), slope(1.0)) - slope(x)).abs() < 1e-14);
        }
    }
}
