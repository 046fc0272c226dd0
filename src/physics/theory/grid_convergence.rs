//! Discretization error of a value that was computed on several grids.
//!
//! With the spacing `h ∝ 1/N` of a grid of N points per side, a value is taken as `φ(h) = φ₀ + C h^p`. Grid
//! convergence index of Roache (J. Fluids Eng. 116:405, 1994; ASME V&V 20-2009): the error of the finest grid
//! is the difference to the extrapolated value φ₀, times a factor of safety.
//!
//! # Deviations
//! A hysteresis loop has jumps, and a jump that a grid skips changes a value in steps. The observed order is
//! meaningful only for a monotone series with p near the order of the method, which is 1 for adhesive fronts.
//! The error of every other series follows from the range of its values, see [`grid_error`].

use crate::PhysicsError;
use crate::constants::Constant;

/// Observed orders p of a regular series.
const ORDERS: [f64; 2] = [0.6, 2.2];
/// Factor of safety of three grids.
const THREE_GRIDS: f64 = 1.25;
/// Factor of safety of two grids, with the order 1.
const TWO_GRIDS: f64 = 2.0;
/// Coverage factor of the scatter by the position of the grid.
const COVERAGE: f64 = 2.0;
/// Smallest relative error.
const FLOOR: f64 = 0.005;
/// Bisections of the observed order.
const BISECTIONS: usize = 60;

/// Constants of the estimate.
pub(super) const CONSTANTS: [Constant; 5] = [
    row("observed order", &ORDERS, "Smallest and largest order of a regular series of three grids."),
    row(
        "factor of safety",
        &[THREE_GRIDS],
        "Grid error of three grids over the estimated distance to the limit.",
    ),
    row("factor of safety of two grids", &[TWO_GRIDS], "Grid error of two grids, whose order is taken as 1."),
    row(
        "coverage factor of the scatter",
        &[COVERAGE],
        "Half-width of the scatter by the position of the grid over its standard deviation.",
    ),
    row("smallest grid error", &[FLOOR], "Lower limit of relative grid errors."),
];

const fn row(name: &'static str, values: &'static [f64], meaning: &'static str) -> Constant {
    Constant::new(name, values, "", meaning, "grid_convergence")
}

/// Estimated discretization error of the value of the finest grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GridError {
    /// Half-width of the interval that is expected to hold the exact value, over the magnitude of the value
    /// of the finest grid, at least 0.005. Infinite for a value of 0 in a series that is not constant.
    pub relative: f64,
    /// Half-width in the unit of the value.
    pub absolute: f64,
    /// Value at `h → 0` of a regular series of three grids, in the unit of the value.
    pub extrapolated: Option<f64>,
    /// Observed order p of a regular series of three grids.
    pub order: Option<f64>,
}

impl GridError {
    /// The error with the scatter by the position of the grid, added in squares: `2 s/r`, with the standard
    /// deviation s of the values on one coarser grid and on its shifted copies, and the ratio r of its
    /// spacing to that of the finest grid. Fewer than two values have no scatter.
    ///
    /// *Assumption:* the scatter is of first order in the grid spacing.
    #[must_use]
    pub fn with_scatter(self, copies: &[f64], refinement: f64) -> Self {
        let deviation = deviation(copies);
        if deviation == 0.0 {
            return self;
        }
        let finest = self.absolute / self.relative;
        let absolute = self.absolute.hypot(COVERAGE * deviation / refinement);
        Self { relative: absolute / finest, absolute, ..self }
    }
}

/// Standard deviation of a sample; 0 for fewer than two values.
fn deviation(values: &[f64]) -> f64 {
    if values.len() < 2 {
        return 0.0;
    }
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    (squares / (values.len() - 1) as f64).sqrt()
}

/// Kind of a series of three grids.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Series {
    /// Monotone, with an observed order within [`ORDERS`].
    Regular(f64),
    /// Monotone, and faster than [`ORDERS`].
    Fast,
    /// Slower, or not monotone.
    Irregular,
}

/// Discretization error of the value on the finest of two or more grids.
///
/// `points` are the grid points N per side, ascending, and `values` the values on these grids, in any unit.
/// The three finest grids decide, or two if there are no more. R is the range of their values:
///
/// - three grids, monotone, observed order p in 0.6 to 2.2: `1.25 |φ₃ − φ₂|/((N₃/N₂)^p − 1)`, with p from
///   `(φ₂ − φ₁)/(φ₃ − φ₂) = (h₁^p − h₂^p)/(h₂^p − h₃^p)`, h = 1/N;
/// - monotone with a larger order: `1.25 R/(N₃/N₁ − 1)`, the first order between the outer grids;
/// - any other three grids: `1.25 R max(1, 1/((N₃/N₁)^0.6 − 1))`, at least the smallest order;
/// - two grids: `2 R/(N₂/N₁ − 1)`, which takes the order as 1.
///
/// The relative error is at least 0.5 %, the scatter of loops by the size of their steps. The estimate
/// assumes that the grids resolve the events that dissipate most of the energy. Its interval holds 95 % of
/// the exact results of Johnson's sinusoid, of JKR spheres and of probes with waves
/// (`tests/physics/boundary_elements/grid_error.rs`).
///
/// # Errors
/// At least two grids with as many values are needed. Points must be positive and ascending, and values
/// finite.
pub fn grid_error(points: &[f64], values: &[f64]) -> Result<GridError, PhysicsError> {
    check(points, values)?;
    let first = points.len().saturating_sub(3);
    let (points, values) = (&points[first..], &values[first..]);
    let last = values.len() - 1;
    let (finest, refined) = (values[last], points[last] / points[0]);
    let spread = range(values);
    let (error, series) = match (points, values) {
        ([_, n2, n3], [_, v2, v3]) => match series(points, values) {
            Series::Regular(order) => {
                let rest = (v3 - v2) / ((n3 / n2).powf(order) - 1.0);
                (THREE_GRIDS * rest.abs(), Some((order, v3 + rest)))
            }
            Series::Fast => (THREE_GRIDS * spread / (refined - 1.0), None),
            Series::Irregular => {
                (THREE_GRIDS * spread * (1.0 / (refined.powf(ORDERS[0]) - 1.0)).max(1.0), None)
            }
        },
        _ => (TWO_GRIDS * spread / (refined - 1.0), None),
    };
    let absolute = error.max(FLOOR * finest.abs());
    let relative = if absolute == 0.0 { FLOOR } else { absolute / finest.abs() };
    let [order, extrapolated] = [series.map(|of| of.0), series.map(|of| of.1)];
    Ok(GridError { relative, absolute, extrapolated, order })
}

/// Kind of a series of three grids.
fn series(points: &[f64], values: &[f64]) -> Series {
    let ([n1, n2, n3], [v1, v2, v3]) = (points, values) else { return Series::Irregular };
    let [first, second] = [v2 - v1, v3 - v2];
    // Rises with the order.
    let of = |order: f64| ((n2 / n1).powf(order) - 1.0) / (1.0 - (n2 / n3).powf(order));
    let ratio = (first / second).abs();
    let [mut low, mut high] = ORDERS;
    // Not a number for equal values.
    if first * second < 0.0 || ratio.is_nan() || ratio < of(low) {
        return Series::Irregular;
    }
    if ratio > of(high) {
        return Series::Fast;
    }
    for _ in 0..BISECTIONS {
        let middle = low.midpoint(high);
        *(if of(middle) < ratio { &mut low } else { &mut high }) = middle;
    }
    Series::Regular(low.midpoint(high))
}

/// Difference of the largest and the smallest value.
fn range(values: &[f64]) -> f64 {
    let largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    largest - values.iter().copied().fold(f64::INFINITY, f64::min)
}

fn check(points: &[f64], values: &[f64]) -> Result<(), PhysicsError> {
    let refused = |quantity, value, allowed| {
        Err(PhysicsError::Domain { action: "the discretization error", quantity, value, allowed })
    };
    if points.len() < 2 {
        return refused("the number of grids", points.len() as f64, "at least 2");
    }
    if points.len() != values.len() {
        return refused("the number of values", values.len() as f64, "one of each grid");
    }
    let mut before = 0.0;
    for n in points {
        if !(*n > before && n.is_finite()) {
            return refused("the number of grid points", *n, "positive, ascending numbers");
        }
        before = *n;
    }
    values
        .iter()
        .find(|value| !value.is_finite())
        .map_or(Ok(()), |value| refused("a value", *value, "finite numbers"))
}
