//! `hysteron._hysteron`: the physics of hysteron over columns of numbers.
//!
//! Every function takes one-dimensional, contiguous arrays of `f64`, of one element or all of the same
//! length, and returns such arrays. The Python modules of this package are the only callers. They have the
//! broadcasting, the keywords and the documentation.

mod columns;
mod jkr;
mod spectrum;
mod theory;

use pyo3::prelude::*;

/// The physics of hysteron over columns of numbers; called by the modules of the package, not by its users.
#[pymodule]
fn _hysteron(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    jkr::add(module)?;
    theory::add(module)?;
    spectrum::add(module)
}
