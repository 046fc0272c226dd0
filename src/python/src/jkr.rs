//! One JKR asperity: the functions of `hysteron_physics::jkr`, by name.

use crate::columns::{Column, Values, each, within};
use hysteron_physics::PhysicsError;
use hysteron_physics::jkr::{self, Asperity};
use hysteron_physics::model::{Material, Slips};
use pyo3::prelude::*;

/// The asperity of one element.
fn asperity(radius_m: f64, modulus: f64, adhesion: f64, eq9: bool) -> Result<Asperity, PhysicsError> {
    // The range of attraction enters only where it is an argument.
    let material =
        Material { contact_modulus_pa: modulus, work_of_adhesion_j_m2: adhesion, interaction_range_m: 1e-9 };
    let slips = Slips { eq9, ..Slips::NONE };
    Asperity::as_printed(radius_m, &material, slips)
}

/// A function of the asperity and of further columns.
macro_rules! of_asperity {
    ($($name:ident($($value:ident),*) $evaluate:expr;)*) => {
        $(
            #[pyfunction]
            #[allow(clippy::too_many_arguments, reason = "an asperity is four of them")]
            fn $name<'py>(
                py: Python<'py>,
                radius_m: Column<'py>,
                $($value: Column<'py>,)*
                contact_modulus_pa: Column<'py>,
                work_of_adhesion_j_m2: Column<'py>,
                eq9: bool,
            ) -> PyResult<Values<'py>> {
                let columns = [radius_m, contact_modulus_pa, work_of_adhesion_j_m2, $($value),*];
                each(py, columns, |[radius, modulus, adhesion, $($value),*]| {
                    let evaluate: fn(&Asperity, $(of_asperity!(@number $value)),*) -> f64 = $evaluate;
                    Ok(evaluate(&asperity(radius, modulus, adhesion, eq9)?, $($value),*))
                })
            }
        )*

        /// Adds them to the module.
        pub fn add(module: &Bound<'_, PyModule>) -> PyResult<()> {
            module.add("loop_loss_constant", jkr::loop_loss_constant())?;
            $(module.add_function(wrap_pyfunction!($name, module)?)?;)*
            Ok(())
        }
    };
    (@number $value:ident) => { f64 };
}

of_asperity! {
    pull_sqrt_m() |spot| spot.pull_sqrt_m();
    load(a_m) |spot, a| within(a >= 0.0, spot.load(a));
    load_slope(a_m) |spot, a| within(a >= 0.0, spot.load_slope(a));
    penetration(a_m) |spot, a| within(a >= 0.0, spot.penetration(a));
    penetration_slope(a_m) |spot, a| within(a > 0.0, spot.penetration_slope(a));
    jump_off_radius() |spot| spot.jump_off_radius();
    jump_off_penetration() |spot| spot.jump_off_penetration();
    pull_off_radius() |spot| spot.pull_off_radius();
    pull_off_load() |spot| spot.pull_off_load();
    radius_at_penetration(penetration_m) |spot, penetration|
        spot.radius_at_penetration(penetration).unwrap_or(f64::NAN);
    radius_at_load(load_n) |spot, load| spot.radius_at_load(load).unwrap_or(f64::NAN);
    stored_energy(penetration_m, a_m) |spot, penetration, a|
        within(a >= 0.0, spot.stored_energy(penetration, a));
    tabor(range_m) |spot, range| within(range > 0.0, spot.tabor(range));
    wu_jump_in_penetration(range_m) |spot, range| within(range > 0.0, spot.wu_jump_in_penetration(range));
    loop_loss() |spot| spot.loop_loss();
    loop_loss_from(jump_in_m) |spot, jump_in| spot.loop_loss_from(jump_in).unwrap_or(f64::NAN);
}
