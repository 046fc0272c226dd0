//! Spectrum of a self-affine surface, its moments, and the energy that flattens it:
//! `surface::spectrum` and `theory::flattening` by name.

use crate::columns::{Column, Values, allowed, each, each_many, each_slow, positive};
use hysteron_physics::PhysicsError;
use hysteron_physics::model::{Amplitudes, Normalization};
use hysteron_physics::surface::shape::Shape;
use hysteron_physics::surface::spectrum::{Moments, Spectrum};
use hysteron_physics::theory::flattening::{Flattening, flattening as energies};
use pyo3::prelude::*;

const ACTION: &str = "the spectrum (Eq 10)";
const FLATTENING: &str = "the energy of flattening";
const LATTICE: &str = "the moments of discrete modes";
/// Largest magnification whose modes are added: its time, which is proportional to it, is seconds.
const MOST_ROWS: u32 = 1 << 24;
/// Above it not every whole number is an `f64`.
const WHOLE: f64 = 9_007_199_254_740_992.0;

/// The spectrum of one element.
fn spectrum(
    [length, rms_height, hurst, magnification]: [f64; 4],
    normalization: Normalization,
) -> Result<Spectrum, PhysicsError> {
    let whole = magnification.fract() == 0.0 && (2.0..=f64::from(u32::MAX)).contains(&magnification);
    Ok(Spectrum {
        length_m: positive(ACTION, "the side of the square [m]", length)?,
        rms_height_m: positive(ACTION, "the rms height [m]", rms_height)?,
        hurst: allowed(ACTION, "the Hurst exponent", hurst, hurst > 0.0 && hurst <= 1.0, "above 0, up to 1")?,
        magnification: allowed(
            ACTION,
            "the magnification",
            magnification,
            whole,
            "a whole number from 2 to 4294967295",
        )? as u32,
        normalization,
        amplitudes: Amplitudes::Fixed,
        shape: Shape::default(),
    })
}

fn parts(moments: Moments) -> [f64; 3] {
    [moments.m0_m2, moments.m2, moments.m4_1_m2]
}

#[pyfunction]
fn density<'py>(
    py: Python<'py>,
    mode_squared: Column<'py>,
    length_m: Column<'py>,
    rms_height_m: Column<'py>,
    hurst: Column<'py>,
    magnification: Column<'py>,
) -> PyResult<Values<'py>> {
    each(
        py,
        [mode_squared, length_m, rms_height_m, hurst, magnification],
        |[mode, length, height, hurst, magnification]| {
            let whole = mode.fract() == 0.0 && (0.0..=WHOLE).contains(&mode);
            let mode =
                allowed(ACTION, "the squared mode number", mode, whole, "a whole number from 0 to 2^53")?;
            Ok(spectrum([length, height, hurst, magnification], Normalization::Spectrum)?
                .density(mode as u64))
        },
    )
}

#[pyfunction]
fn prefactor<'py>(
    py: Python<'py>,
    length_m: Column<'py>,
    rms_height_m: Column<'py>,
    hurst: Column<'py>,
    magnification: Column<'py>,
) -> PyResult<Values<'py>> {
    each(py, [length_m, rms_height_m, hurst, magnification], |of| {
        Ok(spectrum(of, Normalization::Spectrum)?.prefactor())
    })
}

#[pyfunction]
fn moments<'py>(
    py: Python<'py>,
    length_m: Column<'py>,
    rms_height_m: Column<'py>,
    hurst: Column<'py>,
    magnification: Column<'py>,
) -> PyResult<[Values<'py>; 3]> {
    each_many(py, [length_m, rms_height_m, hurst, magnification], |of| {
        Ok(parts(spectrum(of, Normalization::Spectrum)?.moments()))
    })
}

#[pyfunction]
fn lattice_moments<'py>(
    py: Python<'py>,
    length_m: Column<'py>,
    rms_height_m: Column<'py>,
    hurst: Column<'py>,
    magnification: Column<'py>,
    sample: bool,
) -> PyResult<[Values<'py>; 3]> {
    let normalization = if sample { Normalization::Sample } else { Normalization::Spectrum };
    each_slow(py, [length_m, rms_height_m, hurst, magnification], |of| {
        let of = spectrum(of, normalization)?;
        let magnification = f64::from(of.magnification);
        allowed(
            LATTICE,
            "the magnification",
            magnification,
            of.magnification <= MOST_ROWS,
            "at most 16777216",
        )?;
        Ok(parts(of.lattice_moments()))
    })
}

/// Of moments: rms height, rms gradient, rms Laplacian, Nayak's parameter, density of summits.
#[pyfunction]
fn statistics<'py>(
    py: Python<'py>,
    m0_m2: Column<'py>,
    m2: Column<'py>,
    m4_1_m2: Column<'py>,
) -> PyResult<[Values<'py>; 5]> {
    each_many(py, [m0_m2, m2, m4_1_m2], |[m0_m2, m2, m4_1_m2]| {
        let of = Moments { m0_m2, m2, m4_1_m2 };
        Ok([
            of.rms_height_m(),
            of.rms_slope(),
            of.rms_curvature_1_m(),
            of.nayak_parameter(),
            of.summit_density_1_m2(),
        ])
    })
}

/// Elastic energies that flatten the whole band, and its shortest octave.
#[pyfunction]
fn flattening<'py>(
    py: Python<'py>,
    length_m: Column<'py>,
    rms_height_m: Column<'py>,
    hurst: Column<'py>,
    magnification: Column<'py>,
    contact_modulus_pa: Column<'py>,
) -> PyResult<[Values<'py>; 2]> {
    each_many(py, [length_m, rms_height_m, hurst, magnification, contact_modulus_pa], |of| {
        let energy = energy(of)?;
        Ok([energy.whole_j_m2, energy.octave_j_m2])
    })
}

/// Elastic energies over the work of adhesion: Persson and Tosatti's ratio, and the conformity.
#[pyfunction]
fn flattening_ratios<'py>(
    py: Python<'py>,
    length_m: Column<'py>,
    rms_height_m: Column<'py>,
    hurst: Column<'py>,
    magnification: Column<'py>,
    contact_modulus_pa: Column<'py>,
    work_of_adhesion_j_m2: Column<'py>,
) -> PyResult<[Values<'py>; 2]> {
    let columns = [length_m, rms_height_m, hurst, magnification, contact_modulus_pa, work_of_adhesion_j_m2];
    each_many(py, columns, |[length, height, hurst, magnification, modulus, adhesion]| {
        let energy = energy([length, height, hurst, magnification, modulus])?;
        let adhesion = positive(FLATTENING, "the work of adhesion [J/m2]", adhesion)?;
        Ok([energy.persson_tosatti(adhesion), energy.conformity(adhesion)])
    })
}

fn energy([length, height, hurst, magnification, modulus]: [f64; 5]) -> Result<Flattening, PhysicsError> {
    let of = spectrum([length, height, hurst, magnification], Normalization::Spectrum)?;
    Ok(energies(&of, positive(FLATTENING, "the contact modulus [Pa]", modulus)?))
}

/// Adds them to the module.
pub fn add(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(density, module)?)?;
    module.add_function(wrap_pyfunction!(prefactor, module)?)?;
    module.add_function(wrap_pyfunction!(moments, module)?)?;
    module.add_function(wrap_pyfunction!(lattice_moments, module)?)?;
    module.add_function(wrap_pyfunction!(statistics, module)?)?;
    module.add_function(wrap_pyfunction!(flattening, module)?)?;
    module.add_function(wrap_pyfunction!(flattening_ratios, module)?)
}
