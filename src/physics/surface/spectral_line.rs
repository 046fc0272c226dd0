//! Least-squares line through rings of a spectrum, in logarithms.

use std::f64::consts::LN_2;

/// A ring in logarithms.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Point {
    /// ln q.
    pub(crate) x: f64,
    /// ln C without white noise.
    pub(crate) y: f64,
    /// Variance of y.
    pub(crate) variance: f64,
    /// Number of modes.
    pub(crate) modes: f64,
    /// True if the ring may hold data: white noise and window leakage do not dominate it.
    pub(crate) is_data: bool,
}

/// Transition from the plateau to the power law.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shape {
    /// A power law without plateau.
    Straight,
    /// A plateau that ends at the corner.
    Sharp,
    /// `(1 + (q/q_r)²)^(−(H+1))`, whose asymptotes meet at the corner.
    Smooth,
    /// A power law after a Gaussian L-filter (ISO 16610-61), which transmits half of the amplitude at the
    /// corner.
    Filtered,
}

/// Damping at short wavelengths.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Damping {
    /// None.
    None,
    /// That of a Gaussian filter.
    Gaussian,
}

impl Damping {
    /// Number of coefficients of a line with this damping.
    fn coefficients(self) -> usize {
        match self {
            Self::None => 2,
            Self::Gaussian => 3,
        }
    }
}

/// Form of a line, whose coefficients are fitted.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Form {
    /// Transition to the power law.
    pub(crate) shape: Shape,
    /// `ln q` of the corner; of the first ring without a roll-off.
    pub(crate) corner: f64,
    /// Damping.
    pub(crate) damping: Damping,
}

impl Shape {
    /// True for a plateau at long wavelengths.
    pub(crate) fn rolls_off(self) -> bool {
        matches!(self, Self::Sharp | Self::Smooth)
    }
}

/// Self-affine spectrum `ln C = level − power b(ln q) − damping q² + ln T²(q)`, with the transfer T of an
/// L-filter.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Line {
    /// Transition to the power law.
    pub(crate) shape: Shape,
    /// `ln q` of the corner; of the first ring without a roll-off.
    pub(crate) corner: f64,
    /// `ln C` of the plateau; at the corner, without filters, of a power law.
    pub(crate) level: f64,
    /// Exponent `2(H+1)`.
    power: f64,
    /// Coefficient of Gaussian damping \[m²\]; 0 without.
    pub(crate) damping: f64,
    /// Sum of the squared deviations over their variances.
    pub(crate) squares: f64,
    /// Weighted rms deviation of ln C.
    pub(crate) scatter: f64,
    /// First and last `ln q` of the band.
    pub(crate) band: [f64; 2],
}

impl Line {
    /// Weighted least-squares fit; nothing if it is singular or if damping is not positive.
    pub(crate) fn of(points: &[Point], form: Form) -> Option<Self> {
        let Form { shape, corner, damping } = form;
        let is_damped = damping == Damping::Gaussian;
        let (first, last) = (points.first()?, points.last()?);
        // Squares of wavenumbers relative to the last keep the equations well scaled.
        let unit = last.x;
        let basis = |x: f64| {
            [1.0, -decay(shape, x - corner), if is_damped { -(2.0 * (x - unit)).exp() } else { 0.0 }]
        };
        let count = damping.coefficients();
        let mut matrix = [[0.0; 4]; 3];
        for point in points {
            let row = basis(point.x);
            for a in 0..count {
                for b in 0..count {
                    matrix[a][b] += row[a] * row[b] / point.variance;
                }
                matrix[a][3] += row[a] * (point.y - transmitted(shape, point.x - corner)) / point.variance;
            }
        }
        let [level, power, damping] = solved(matrix, count)?;
        if is_damped && damping <= 0.0 {
            return None;
        }
        let damping = damping * (-2.0 * unit).exp();
        let mut line = Self {
            shape,
            corner,
            level,
            power,
            damping,
            squares: 0.0,
            scatter: 0.0,
            band: [first.x, last.x],
        };
        let weight: f64 = points.iter().map(|point| 1.0 / point.variance).sum();
        line.squares = points.iter().map(|point| (point.y - line.at(point.x)).powi(2) / point.variance).sum();
        line.scatter = (line.squares / weight).sqrt();
        Some(line)
    }

    /// Its form, with a corner at another `ln q`.
    pub(crate) fn form(&self, corner: f64) -> Form {
        Form {
            shape: self.shape,
            corner,
            damping: if self.damping > 0.0 { Damping::Gaussian } else { Damping::None },
        }
    }

    /// Hurst exponent.
    pub(crate) fn hurst(&self) -> f64 {
        0.5 * self.power - 1.0
    }

    /// `ln C` at `ln q`.
    pub(crate) fn at(&self, x: f64) -> f64 {
        let beyond = x - self.corner;
        self.level - self.power * decay(self.shape, beyond) - self.damping * (2.0 * x).exp()
            + transmitted(self.shape, beyond)
    }

    /// Local exponent `−d ln C/d ln q`, without an L-filter.
    pub(crate) fn exponent(&self, x: f64) -> f64 {
        let beyond = x - self.corner;
        let of_shape = match self.shape {
            Shape::Straight | Shape::Filtered => 1.0,
            Shape::Sharp => f64::from(u8::from(beyond > 0.0)),
            Shape::Smooth => 1.0 / (1.0 + (-2.0 * beyond).exp()),
        };
        self.power * of_shape + 2.0 * self.damping * (2.0 * x).exp()
    }
}

/// Sums over the first rings of a spectrum, for lines of one shape and corner through any band.
pub(crate) struct Sums {
    pub(crate) shape: Shape,
    pub(crate) corner: f64,
    /// For each number of rings: products of the basis, of it with ln C, the square of ln C, all over the
    /// variance, and the mean square height.
    sums: Vec<[f64; 11]>,
}

/// Places of the products of two of the three basis functions in [`Sums`].
const PRODUCTS: [[usize; 3]; 3] = [[0, 1, 2], [1, 3, 4], [2, 4, 5]];

impl Sums {
    pub(crate) fn of(points: &[Point], shape: Shape, corner: f64) -> Self {
        let last = points.last().map_or(0.0, |point| point.x);
        // Sums of squares of deviations from a common level lose fewer digits.
        let level = points.iter().map(|point| point.y).sum::<f64>() / points.len() as f64;
        let mut sum = [0.0; 11];
        let mut sums = vec![sum];
        for point in points {
            let basis = [1.0, -decay(shape, point.x - corner), -(2.0 * (point.x - last)).exp()];
            let y = point.y - level - transmitted(shape, point.x - corner);
            for a in 0..3 {
                for b in a..3 {
                    sum[PRODUCTS[a][b]] += basis[a] * basis[b] / point.variance;
                }
                sum[6 + a] += basis[a] * y / point.variance;
            }
            sum[9] += y * y / point.variance;
            sum[10] += point.power();
            sums.push(sum);
        }
        Self { shape, corner, sums }
    }

    fn over(&self, [first, end]: [usize; 2]) -> [f64; 11] {
        std::array::from_fn(|k| self.sums[end][k] - self.sums[first][k])
    }

    /// Mean square height of a band over the area of a mode \[m⁴\].
    pub(crate) fn power(&self, [first, end]: [usize; 2]) -> f64 {
        self.sums[end][10] - self.sums[first][10]
    }

    /// Hurst exponent and sum of the squared deviations of the line through a band; nothing if it is singular
    /// or if damping is not positive.
    pub(crate) fn solved(&self, band: [usize; 2], damping: Damping) -> Option<(f64, f64)> {
        let sums = self.over(band);
        let count = damping.coefficients();
        let matrix = std::array::from_fn(|a| {
            std::array::from_fn(|b| if b < 3 { sums[PRODUCTS[a][b]] } else { sums[6 + a] })
        });
        let solution = solved(matrix, count)?;
        if damping == Damping::Gaussian && solution[2] <= 0.0 {
            return None;
        }
        let explained: f64 = (0..count).map(|k| solution[k] * sums[6 + k]).sum();
        Some((0.5 * solution[1] - 1.0, (sums[9] - explained).max(0.0)))
    }
}

/// Decrease of `ln C` per unit of the exponent at a distance in `ln q` from the corner.
fn decay(shape: Shape, beyond: f64) -> f64 {
    match shape {
        Shape::Straight | Shape::Filtered => beyond,
        Shape::Sharp => beyond.max(0.0),
        Shape::Smooth => 0.5 * (2.0 * beyond).exp().ln_1p(),
    }
}

/// `ln T²` of an L-filter with transfer `T = 1 − exp(−ln 2 (q/q_c)²)`, 0 without.
fn transmitted(shape: Shape, beyond: f64) -> f64 {
    if shape == Shape::Filtered { 2.0 * (-(-LN_2 * (2.0 * beyond).exp()).exp_m1()).ln() } else { 0.0 }
}

/// Solution of symmetric equations of `count` unknowns by elimination; the other unknowns are 0.
fn solved(mut matrix: [[f64; 4]; 3], count: usize) -> Option<[f64; 3]> {
    let diagonal: [f64; 3] = std::array::from_fn(|k| matrix[k][k]);
    for pivot in 0..count {
        let row = matrix[pivot];
        // A pivot that cancels to rounding is no information.
        if row[pivot].is_nan() || row[pivot] <= 1e-9 * diagonal[pivot] {
            return None;
        }
        for other in (0..count).filter(|other| *other != pivot) {
            let factor = matrix[other][pivot] / row[pivot];
            matrix[other].iter_mut().zip(row).for_each(|(value, of)| *value -= factor * of);
        }
    }
    let mut solution = [0.0; 3];
    (0..count).for_each(|k| solution[k] = matrix[k][3] / matrix[k][k]);
    Some(solution)
}
