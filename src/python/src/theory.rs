//! Analytical models: the functions of `hysteron_physics::theory`, by name.

use crate::columns::{Column, Values, each, each_many, positive, within};
use hysteron_physics::PhysicsError;
use hysteron_physics::model::{Material, Slips};
use hysteron_physics::surface::spectrum::Moments;
use hysteron_physics::theory::probe_loss::{
    ProbeAreas, deng_kesari_probe_loss as deng_kesari_probe_loss_per_area,
};
use hysteron_physics::theory::{self, regime, works};
use pyo3::prelude::*;

/// The material of one element, for `action`.
fn material(action: &'static str, modulus: f64, adhesion: f64) -> Result<Material, PhysicsError> {
    Ok(Material {
        contact_modulus_pa: positive(action, "the contact modulus [Pa]", modulus)?,
        work_of_adhesion_j_m2: positive(action, "the work of adhesion [J/m2]", adhesion)?,
        // It enters none of the theories.
        interaction_range_m: 1e-9,
    })
}

const MEAN_LOSS: &str = "Deng and Kesari's mean loss (Eq A3)";

#[pyfunction]
fn curvature_density<'py>(py: Python<'py>, t: Column<'py>) -> PyResult<Values<'py>> {
    each(py, [t], |[t]| Ok(theory::curvature_density(t)))
}

#[pyfunction]
fn curvature_decay<'py>(py: Python<'py>, nayak_parameter: Column<'py>, a2: bool) -> PyResult<Values<'py>> {
    let slips = Slips { a2, ..Slips::NONE };
    each(py, [nayak_parameter], |[nayak]| Ok(theory::curvature_decay(nayak, slips).unwrap_or(f64::NAN)))
}

#[pyfunction]
fn curvature_density_as_printed<'py>(
    py: Python<'py>,
    t: Column<'py>,
    decay: Column<'py>,
) -> PyResult<Values<'py>> {
    each(py, [t, decay], |[t, decay]| Ok(theory::curvature_density_as_printed(t, decay)))
}

/// An infinite tip radius is none: the surface is nominally flat.
#[pyfunction]
#[allow(
    clippy::too_many_arguments,
    reason = "three moments, two constants of the material, a tip and two slips"
)]
fn mean_loop_loss<'py>(
    py: Python<'py>,
    m0_m2: Column<'py>,
    m2: Column<'py>,
    m4_1_m2: Column<'py>,
    contact_modulus_pa: Column<'py>,
    work_of_adhesion_j_m2: Column<'py>,
    tip_radius_m: Column<'py>,
    a2: bool,
    a3: bool,
) -> PyResult<Values<'py>> {
    let slips = Slips { a2, a3, ..Slips::NONE };
    let columns = [m0_m2, m2, m4_1_m2, contact_modulus_pa, work_of_adhesion_j_m2, tip_radius_m];
    each(py, columns, |[m0_m2, m2, m4_1_m2, modulus, adhesion, tip]| {
        let tip = (tip < f64::INFINITY).then_some(tip);
        theory::mean_loop_loss_as_printed(
            &Moments { m0_m2, m2, m4_1_m2 },
            &material(MEAN_LOSS, modulus, adhesion)?,
            tip,
            slips,
        )
    })
}

#[pyfunction]
#[allow(
    clippy::too_many_arguments,
    reason = "three moments, two constants of the material, an area and two slips"
)]
fn deng_kesari_loss<'py>(
    py: Python<'py>,
    m0_m2: Column<'py>,
    m2: Column<'py>,
    m4_1_m2: Column<'py>,
    contact_modulus_pa: Column<'py>,
    work_of_adhesion_j_m2: Column<'py>,
    area_m2: Column<'py>,
    a2: bool,
    a3: bool,
) -> PyResult<Values<'py>> {
    let slips = Slips { a2, a3, ..Slips::NONE };
    let columns = [m0_m2, m2, m4_1_m2, contact_modulus_pa, work_of_adhesion_j_m2, area_m2];
    each(py, columns, |[m0_m2, m2, m4_1_m2, modulus, adhesion, area]| {
        let m2 = positive(MEAN_LOSS, "m2", m2)?;
        let material = material(MEAN_LOSS, modulus, adhesion)?;
        Ok(within(
            area >= 0.0,
            theory::deng_kesari_loss_as_printed(&Moments { m0_m2, m2, m4_1_m2 }, &material, area, slips)?,
        ))
    })
}

/// Θ with the contact areas of the smooth probe at its load reversal and after its jump into contact.
#[pyfunction]
#[allow(
    clippy::too_many_arguments,
    reason = "three moments, two constants of the material, a radius, a load and two slips"
)]
fn deng_kesari_probe_loss<'py>(
    py: Python<'py>,
    m0_m2: Column<'py>,
    m2: Column<'py>,
    m4_1_m2: Column<'py>,
    contact_modulus_pa: Column<'py>,
    work_of_adhesion_j_m2: Column<'py>,
    radius_m: Column<'py>,
    max_load_n: Column<'py>,
    a2: bool,
    a3: bool,
) -> PyResult<[Values<'py>; 3]> {
    let slips = Slips { a2, a3, ..Slips::NONE };
    let columns = [m0_m2, m2, m4_1_m2, contact_modulus_pa, work_of_adhesion_j_m2, radius_m, max_load_n];
    each_many(py, columns, |[m0_m2, m2, m4_1_m2, modulus, adhesion, radius, load]| {
        let m2 = positive(MEAN_LOSS, "m2", m2)?;
        let material = material(MEAN_LOSS, modulus, adhesion)?;
        let moments = Moments { m0_m2, m2, m4_1_m2 };
        let per_area = deng_kesari_probe_loss_per_area(&moments, &material, radius, slips)?;
        let areas = ProbeAreas::of(radius, &material, load)?;
        Ok(areas.map_or([f64::NAN; 3], |areas| {
            [per_area * areas.swept_m2(), areas.reversal_m2, areas.jump_in_m2]
        }))
    })
}

#[pyfunction]
fn pinning_works<'py>(
    py: Python<'py>,
    work_of_adhesion_j_m2: Column<'py>,
    elastic_energy_j_m2: Column<'py>,
    prefactor: Column<'py>,
) -> PyResult<[Values<'py>; 2]> {
    each_many(
        py,
        [work_of_adhesion_j_m2, elastic_energy_j_m2, prefactor],
        |[adhesion, elastic, prefactor]| {
            let adhesion = positive("the works of pinning", "the work of adhesion [J/m2]", adhesion)?;
            let works = works::pinning_works(adhesion, elastic, prefactor);
            Ok(works.filter(|_| elastic >= 0.0 && prefactor >= 0.0).unwrap_or([f64::NAN; 2]))
        },
    )
}

#[pyfunction]
fn dalvi_closing<'py>(
    py: Python<'py>,
    work_of_adhesion_j_m2: Column<'py>,
    elastic_energy_j_m2: Column<'py>,
) -> PyResult<Values<'py>> {
    each(py, [work_of_adhesion_j_m2, elastic_energy_j_m2], |[adhesion, elastic]| {
        let adhesion = positive("Dalvi's work of closing", "the work of adhesion [J/m2]", adhesion)?;
        Ok(within(elastic >= 0.0, works::dalvi_closing(adhesion, elastic).unwrap_or(f64::NAN)))
    })
}

#[pyfunction]
fn effective_adhesion<'py>(
    py: Python<'py>,
    work_of_adhesion_j_m2: Column<'py>,
    rms_slope: Column<'py>,
    elastic_energy_j_m2: Column<'py>,
) -> PyResult<Values<'py>> {
    each(py, [work_of_adhesion_j_m2, rms_slope, elastic_energy_j_m2], |[adhesion, slope, elastic]| {
        let adhesion = positive("the effective work of adhesion", "the work of adhesion [J/m2]", adhesion)?;
        Ok(within(
            slope >= 0.0 && elastic >= 0.0,
            regime::effective_adhesion(adhesion, slope, elastic).unwrap_or(f64::NAN),
        ))
    })
}

#[pyfunction]
fn dalvi_loss<'py>(
    py: Python<'py>,
    work_of_adhesion_j_m2: Column<'py>,
    area_m2: Column<'py>,
) -> PyResult<Values<'py>> {
    each(py, [work_of_adhesion_j_m2, area_m2], |[adhesion, area]| {
        // The modulus does not enter.
        Ok(within(area >= 0.0, theory::dalvi_loss(&material("Dalvi's loss", 1.0, adhesion)?, area)))
    })
}

#[pyfunction]
fn pinning_loss<'py>(
    py: Python<'py>,
    work_of_adhesion_j_m2: Column<'py>,
    elastic_energy_j_m2: Column<'py>,
    area_m2: Column<'py>,
) -> PyResult<Values<'py>> {
    each(py, [work_of_adhesion_j_m2, elastic_energy_j_m2, area_m2], |[adhesion, elastic, area]| {
        // The modulus does not enter.
        let material = material("the pinning loss", 1.0, adhesion)?;
        Ok(within(
            area >= 0.0 && elastic >= 0.0,
            theory::pinning_loss(&material, elastic, area).unwrap_or(f64::NAN),
        ))
    })
}

#[pyfunction]
fn sticky_line<'py>(py: Python<'py>, persson_tosatti: Column<'py>) -> PyResult<Values<'py>> {
    each(py, [persson_tosatti], |[ratio]| Ok(within(ratio >= 0.0, theory::sticky_line(ratio))))
}

#[pyfunction]
fn adhesionless_area<'py>(
    py: Python<'py>,
    load: Column<'py>,
    rms_slope: Column<'py>,
) -> PyResult<Values<'py>> {
    each(py, [load, rms_slope], |[load, slope]| {
        let slope = positive("the area without adhesion", "the rms gradient", slope)?;
        Ok(within(load >= 0.0, theory::adhesionless_area(load, slope)))
    })
}

#[pyfunction]
fn adhesionless_area_small<'py>(
    py: Python<'py>,
    load: Column<'py>,
    rms_slope: Column<'py>,
) -> PyResult<Values<'py>> {
    each(py, [load, rms_slope], |[load, slope]| {
        let slope = positive("the area without adhesion at small loads", "the rms gradient", slope)?;
        Ok(within(load >= 0.0, theory::adhesionless_area_small(load, slope)))
    })
}

#[pyfunction]
fn fuller_tabor<'py>(
    py: Python<'py>,
    contact_modulus_pa: Column<'py>,
    work_of_adhesion_j_m2: Column<'py>,
    height_sd_m: Column<'py>,
    mean_radius_m: Column<'py>,
) -> PyResult<Values<'py>> {
    const ACTION: &str = "Fuller and Tabor's parameter";
    each(
        py,
        [contact_modulus_pa, work_of_adhesion_j_m2, height_sd_m, mean_radius_m],
        |[modulus, adhesion, height_sd, radius]| {
            let radius = positive(ACTION, "the mean radius of the summits [m]", radius)?;
            Ok(within(
                height_sd >= 0.0,
                theory::fuller_tabor(&material(ACTION, modulus, adhesion)?, height_sd, radius),
            ))
        },
    )
}

/// Adds them to the module.
pub fn add(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(curvature_density, module)?)?;
    module.add_function(wrap_pyfunction!(curvature_decay, module)?)?;
    module.add_function(wrap_pyfunction!(curvature_density_as_printed, module)?)?;
    module.add_function(wrap_pyfunction!(mean_loop_loss, module)?)?;
    module.add_function(wrap_pyfunction!(deng_kesari_loss, module)?)?;
    module.add_function(wrap_pyfunction!(deng_kesari_probe_loss, module)?)?;
    module.add_function(wrap_pyfunction!(pinning_works, module)?)?;
    module.add_function(wrap_pyfunction!(dalvi_closing, module)?)?;
    module.add_function(wrap_pyfunction!(effective_adhesion, module)?)?;
    module.add_function(wrap_pyfunction!(dalvi_loss, module)?)?;
    module.add_function(wrap_pyfunction!(pinning_loss, module)?)?;
    module.add_function(wrap_pyfunction!(sticky_line, module)?)?;
    module.add_function(wrap_pyfunction!(adhesionless_area, module)?)?;
    module.add_function(wrap_pyfunction!(adhesionless_area_small, module)?)?;
    module.add_function(wrap_pyfunction!(fuller_tabor, module)?)
}
