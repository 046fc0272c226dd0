//! Memory allocation that returns an error instead of aborting the program.

use crate::PhysicsError;
use ndarray::Array2;

/// Vector of `count` copies of a value.
pub(crate) fn filled<T: Clone>(count: usize, value: T) -> Result<Vec<T>, PhysicsError> {
    let mut values = Vec::new();
    values.try_reserve_exact(count).map_err(|_| short(count.saturating_mul(size_of::<T>())))?;
    values.resize(count, value);
    Ok(values)
}

/// Array of zeros.
pub(crate) fn zeros(shape: (usize, usize)) -> Result<Array2<f64>, PhysicsError> {
    let values = filled(shape.0.saturating_mul(shape.1), 0.0)?;
    Array2::from_shape_vec(shape, values).map_err(|_| short(usize::MAX))
}

/// Checks that `bytes` bytes can be allocated now.
///
/// # Errors
/// Too little memory.
pub fn check(bytes: usize) -> Result<(), PhysicsError> {
    Vec::<u8>::new().try_reserve_exact(bytes).map_err(|_| short(bytes))
}

fn short(bytes: usize) -> PhysicsError {
    PhysicsError::Surface {
        problem: format!(
            "a surface of this size needs another {:.2} GB of memory, which are not free",
            bytes as f64 / 1e9
        ),
        help: "run fewer tasks at once (--jobs 1), raise the memory limit (ulimit -v, h_vmem), or use fewer \
             points",
    }
}
