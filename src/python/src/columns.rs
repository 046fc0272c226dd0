//! The loop over the elements of arrays.

use hysteron_physics::PhysicsError;
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// One argument: a number for all elements, or one for each.
pub type Column<'py> = PyReadonlyArray1<'py, f64>;
/// One result for each element.
pub type Values<'py> = Bound<'py, PyArray1<f64>>;

/// Elements after which Ctrl-C is looked for. Fewer than a tenth of them are not worth letting other threads
/// in.
const STRETCH: usize = 1 << 14;

/// `evaluate` of every element; where an argument is NaN, so is the result, and nothing is evaluated.
pub fn each<'py, const N: usize>(
    py: Python<'py>,
    columns: [Column<'py>; N],
    evaluate: impl Fn([f64; N]) -> Result<f64, PhysicsError> + Send + Sync,
) -> PyResult<Values<'py>> {
    let [values] = each_many(py, columns, |arguments| Ok([evaluate(arguments)?]))?;
    Ok(values)
}

/// Columns of several results of each element.
pub fn each_many<'py, const N: usize, const M: usize>(
    py: Python<'py>,
    columns: [Column<'py>; N],
    evaluate: impl Fn([f64; N]) -> Result<[f64; M], PhysicsError> + Send + Sync,
) -> PyResult<[Values<'py>; M]> {
    in_stretches(py, columns, STRETCH, evaluate)
}

/// As [`each_many`], for evaluations of milliseconds to seconds: Ctrl-C is looked for after each of them.
pub fn each_slow<'py, const N: usize, const M: usize>(
    py: Python<'py>,
    columns: [Column<'py>; N],
    evaluate: impl Fn([f64; N]) -> Result<[f64; M], PhysicsError> + Send + Sync,
) -> PyResult<[Values<'py>; M]> {
    in_stretches(py, columns, 1, evaluate)
}

fn in_stretches<'py, const N: usize, const M: usize>(
    py: Python<'py>,
    columns: [Column<'py>; N],
    length: usize,
    evaluate: impl Fn([f64; N]) -> Result<[f64; M], PhysicsError> + Send + Sync,
) -> PyResult<[Values<'py>; M]> {
    let mut slices: [&[f64]; N] = [&[]; N];
    for (slice, column) in slices.iter_mut().zip(&columns) {
        *slice = column.as_slice()?;
    }
    let count = slices
        .iter()
        .map(|slice| slice.len())
        .reduce(|a, b| if a == 0 || b == 0 { 0 } else { a.max(b) })
        .unwrap_or(1);
    if let Some(strange) = slices.iter().map(|slice| slice.len()).find(|len| ![1, count].contains(len)) {
        return Err(PyValueError::new_err(format!(
            "columns of {strange} and {count} elements do not go together"
        )));
    }
    let at = |k: usize| slices.map(|slice| slice[if slice.len() == 1 { 0 } else { k }]);
    let one = |k: usize| {
        let arguments = at(k);
        if arguments.iter().any(|value| value.is_nan()) {
            Ok([f64::NAN; M])
        } else {
            evaluate(arguments).map_err(|error| (k, error))
        }
    };
    let mut results: [Vec<f64>; M] = std::array::from_fn(|_| Vec::with_capacity(count));
    let mut stretch = |range: std::ops::Range<usize>| -> Result<(), (usize, PhysicsError)> {
        for k in range {
            for (result, value) in results.iter_mut().zip(one(k)?) {
                result.push(value);
            }
        }
        Ok(())
    };
    let told = |(k, error): (usize, PhysicsError)| {
        let place = if count > 1 {
            format!("; this is element {k} of the arrays, counted along their rows")
        } else {
            String::new()
        };
        PyValueError::new_err(format!("{error}{place}"))
    };
    let mut from = 0;
    while from < count {
        let to = count.min(from + length);
        if count > length / 10 { py.detach(|| stretch(from..to)) } else { stretch(from..to) }
            .map_err(told)?;
        py.check_signals()?;
        from = to;
    }
    Ok(results.map(|values| PyArray1::from_vec(py, values)))
}

/// `value`, if it is what `quantity` of `action` may be.
pub fn positive(action: &'static str, quantity: &'static str, value: f64) -> Result<f64, PhysicsError> {
    allowed(action, quantity, value, value > 0.0 && value.is_finite(), "a positive, finite number")
}

/// `value`, if `holds`; else the sentence that says what is `allowed`.
pub fn allowed(
    action: &'static str,
    quantity: &'static str,
    value: f64,
    holds: bool,
    allowed: &'static str,
) -> Result<f64, PhysicsError> {
    if holds { Ok(value) } else { Err(PhysicsError::Domain { action, quantity, value, allowed }) }
}

/// `result` where its variable lies in the domain of the equation, NaN elsewhere.
pub fn within(holds: bool, result: f64) -> f64 {
    if holds { result } else { f64::NAN }
}
