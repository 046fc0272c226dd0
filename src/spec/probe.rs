//! Requirements of probe, machine, substrate and loads on the other values of their case.

use super::elements::latest;
use super::fault::Faults;
use super::keys::{Limits, find};
use super::number::short;
use super::origin::{Origin, written};
use super::values::Values;
use crate::model::{CaseParams, Coalescence, Control, FarField, Material, Method, Probe, SPHERE_SHARE};
use crate::physics::jkr::Asperity;

/// Contact radius of a smooth probe by JKR at a load \[N\]; nothing at a tension above the pull-off force.
#[must_use]
pub fn contact_radius_m(probe: &Probe, material: &Material, load_n: f64) -> Option<f64> {
    Asperity::new(probe.radius_m, material).ok()?.radius_at_load(load_n)
}

/// Why a probe cannot be used on a square of a side \[m\] with a load \[N\], and what to do: its contact by
/// JKR is too large.
#[must_use]
pub fn probe_refusal(
    probe: &Probe,
    material: &Material,
    length_m: f64,
    load_n: f64,
) -> Option<(String, String)> {
    let radius_m = contact_radius_m(probe, material, load_n)?;
    let largest_m = SPHERE_SHARE * length_m;
    (radius_m > largest_m).then(|| {
        let problem = format!(
            "the contact of the probe is too large for the square: a smooth sphere has a contact radius of \
             {radius_m:.3e} m at the maximum load, and at most {SPHERE_SHARE} L = {largest_m:.3e} m \
             can be used"
        );
        let side_m = radius_m / SPHERE_SHARE;
        (problem, format!("use a square of at least {side_m:.2e} m, or a smaller load or probe"))
    })
}

/// Checks the values of `[probe]`, `[machine]` and `[substrate]`, and loads in other units.
pub(super) fn check_contact(case: &CaseParams, values: &Values, origins: &[Origin], faults: &mut Faults<'_>) {
    check_units(origins, faults);
    // Without the side of a scan, loads in newtons have no value yet.
    let has_loads = !values.needs_side() || values.side_m.is_some();
    if has_loads {
        check_loads(case, origins, faults);
    }
    check_machine(case, origins, faults);
    check_substrate(case, values, origins, faults);
    if let Some(probe) = case.probe.as_ref().filter(|_| has_loads) {
        check_probe(probe, case, values, origins, faults);
    }
}

/// Refuses a pair of keys that exclude each other.
pub(super) fn exclude(keys: [&str; 2], help: &str, origins: &[Origin], faults: &mut Faults<'_>) {
    let place = |path: &str| {
        let (table, name) = path.split_once('.')?;
        written(find(table, name), origins)
    };
    if let [Some(_), Some(_)] = keys.map(place)
        && let Some(span) = latest(&keys, origins)
    {
        let [first, second] = keys;
        faults.add(&span, format!("`{first}` and `{second}` exclude each other"), help.to_owned());
    }
}

/// Keys of the loads.
const LOADS: [&str; 3] = ["cycle.max_load", "cycle.max_force_n", "cycle.max_pressure_pa"];

fn check_units(origins: &[Origin], faults: &mut Faults<'_>) {
    let [load, force, pressure] = LOADS;
    for pair in [[load, force], [load, pressure], [force, pressure]] {
        exclude(pair, "give the loads in one unit", origins, faults);
    }
}

fn check_loads(case: &CaseParams, origins: &[Origin], faults: &mut Faults<'_>) {
    let Some(key) = find("cycle", "max_load").map(|place| &super::keys::KEYS[place]) else { return };
    let super::keys::Kind::Numbers(Limits { high, .. }, _) = &key.kind else { return };
    let largest = case.cycle.largest_load();
    if largest > *high
        && let Some(span) = latest(&LOADS[1..], origins)
    {
        let message = format!(
            "the load is F/(E* A0) = {}, above {}: contact is full far below",
            short(largest),
            short(*high)
        );
        let help = "use a smaller load, a larger square or a larger material.contact_modulus_pa";
        faults.add(&span, message, help.to_owned());
    }
}

fn check_machine(case: &CaseParams, origins: &[Origin], faults: &mut Faults<'_>) {
    let help = "give one of them";
    exclude(["machine.compliance_m_n", "machine.stiffness_n_m"], help, origins, faults);
    if case.machine.far_field == FarField::HalfSpace
        && case.probe.is_none()
        && let Some(span) = latest(&["machine.compliance"], origins)
    {
        let message = "`machine.compliance = \"half_space\"` needs a probe: a flat surface has contacts all \
                       over the square";
        let help = "give probe.radius_m, or write compliance = \"cell\"";
        faults.add(&span, message.to_owned(), help.to_owned());
    }
    if case.machine.control == Control::Load
        && case.asperities().is_some_and(|options| options.coalescence == Coalescence::Merge)
        && let Some(span) = latest(&["machine.control", "model.coalescence", "model.method"], origins)
    {
        let message = "under control of the load asperities cannot merge: they do in jumps, after they have \
                       overlapped, and the pull-off force is up to a third too small";
        let help = "write model.coalescence = \"cover\" or \"none\", or method = \"boundary_elements\"";
        faults.add(&span, message.to_owned(), help.to_owned());
    }
}

fn check_substrate(case: &CaseParams, values: &Values, origins: &[Origin], faults: &mut Faults<'_>) {
    if case.substrate.is_none() {
        if let Some(span) = latest(&["substrate.poisson_ratio"], origins) {
            let help = "give substrate.thickness_m, or remove the key".to_owned();
            faults.add(
                &span,
                "`substrate.poisson_ratio` is that of a layer, which has no thickness".to_owned(),
                help,
            );
        }
        return;
    }
    if values.method == Method::Asperities
        && let Some(span) = latest(&["substrate.thickness_m", "model.method"], origins)
    {
        let message = "the asperity model is one of a half-space: it has no layer";
        faults.add(&span, message.to_owned(), "write method = \"boundary_elements\"".to_owned());
    }
    if case.machine.far_field == FarField::HalfSpace
        && let Some(span) = latest(&["machine.compliance", "substrate.thickness_m"], origins)
    {
        let message = "a layer has a rigid base: `machine.compliance` cannot be that of a half-space";
        faults.add(&span, message.to_owned(), "remove machine.compliance".to_owned());
    }
}

fn check_probe(
    probe: &Probe,
    case: &CaseParams,
    values: &Values,
    origins: &[Origin],
    faults: &mut Faults<'_>,
) {
    if let Some(surface) = case.surface.generated()
        && probe.radius_m <= surface.rms_height_m
        && let Some(span) = latest(&["probe.radius_m", "surface.rms_height_m"], origins)
    {
        let (radius, height) = (short(probe.radius_m), short(surface.rms_height_m));
        let message =
            format!("`probe.radius_m`, {radius} m, must be greater than the rms height, {height} m");
        faults.add(&span, message, "both are in metres".to_owned());
    }
    let Some(length_m) = values.length_m() else { return };
    let load_n = case.cycle.largest_load() * case.material.contact_modulus_pa * length_m * length_m;
    let keys = [
        "probe.radius_m",
        "surface.length_m",
        "surface.size_m",
        "cycle.max_load",
        "cycle.max_force_n",
        "cycle.max_pressure_pa",
    ];
    if let Some((message, help)) = probe_refusal(probe, &case.material, length_m, load_n)
        && let Some(span) = latest(&keys, origins)
    {
        faults.add(&span, message, help);
    }
}
