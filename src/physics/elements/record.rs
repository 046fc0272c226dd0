//! A cycle of the solver in SI units: the only place, with [`Units`], that has its units.

use super::Units;
use super::events::regions::Region;
use super::path::records::{self, Turning};
use super::problem::Totals as GridTotals;
use crate::cycle::{
    Branch, Contact, Cycle, Effort, Event, Map, RegionShape, Site, Step, StepCounts, StepNumerics, Totals,
};
use crate::event_kind::EventCounts;
use std::f64::consts::PI;

/// The cycle in SI units, with loads `F/(E* A0)` at its load reversals.
pub(super) fn in_si(cycle: records::Cycle, max_loads: &[f64], units: &Units) -> Cycle<Turning> {
    let mut counts = vec![EventCounts::default(); cycle.steps.len()];
    for event in &cycle.events {
        counts[event.step].extend([event.kind.kind()]);
    }
    let steps = (0..cycle.steps.len()).map(|at| step(&cycle, at, counts[at], max_loads, units)).collect();
    let events =
        cycle.events.iter().enumerate().map(|(number, of)| event(&cycle, number, of, units)).collect();
    let mut contacts: Vec<Contact> =
        cycle.regions.iter().map(|(step, region)| contact(*step, region, units)).collect();
    // Regions at the maximum tensile load are found when the branch ends: stable, so that those of a step
    // keep their order.
    contacts.sort_by_key(|contact| contact.step);
    // A further step may be at the maximum tensile load as well.
    let further = cycle
        .between
        .iter()
        .filter(|map| cycle.maps.iter().all(|end| end.step != map.step))
        .map(|of| map(of, true, units));
    let mut maps: Vec<Map> = cycle.maps.iter().map(|of| map(of, false, units)).chain(further).collect();
    maps.sort_by_key(|map| map.step);
    let turning = cycle.turning.into_iter().map(|turning| (turning.step, turning)).collect();
    let unreached =
        cycle.unreached.into_iter().map(|(reversal, error)| (reversal, units.error(error))).collect();
    Cycle { steps, contacts, events, maps, turning, unreached, ..Cycle::default() }
}

fn totals(of: GridTotals, units: &Units) -> Totals {
    Totals { load_n: of.load * units.load_n(), area_m2: of.contact as f64 * units.area_m2() }
}

fn step(cycle: &records::Cycle, at: usize, events: EventCounts, max_loads: &[f64], units: &Units) -> Step {
    let of = &cycle.steps[at];
    let Totals { load_n, area_m2 } = totals(of.totals, units);
    Step {
        branch: if of.reversal.is_some() { Branch::Unloading } else { Branch::Loading },
        max_load: of.reversal.and_then(|reversal| max_loads.get(reversal)).copied(),
        // Not −0.
        mean_penetration_m: (of.mean_penetration + 0.0) * units.spacing_m(),
        machine_displacement_m: Some((of.mean_penetration + 0.0) * units.spacing_m()),
        load_n,
        least_load_n: cycle.least_load(at) * units.load_n(),
        area_m2,
        area_union_m2: area_m2,
        counts: StepCounts { contacts: of.regions, covered: 0, touching: 0, held: 0, events },
        dissipated_j: of.dissipated * units.energy_j(),
        work_j: of.work * units.energy_j(),
        numerics: StepNumerics {
            is_converged: of.converged,
            relative_residual: Some(of.residual),
            stiffness_n_m: Some(of.stiffness * (units.load_n() / units.spacing_m())),
            effort: Effort { iterations: of.iterations, transforms: of.transforms, ..Effort::default() },
            ..StepNumerics::default()
        },
    }
}

fn event(cycle: &records::Cycle, number: usize, of: &records::Event, units: &Units) -> Event {
    Event {
        step: of.step,
        kind: of.kind.kind(),
        site: Site::Region(of.kind),
        status: None,
        cause: of.kind.kind(),
        mean_penetration_m: cycle.steps[of.step].mean_penetration * units.spacing_m(),
        avalanche: number as u64,
        before: totals(of.before, units),
        after: totals(of.after, units),
        energy_lost_j: of.dissipated * units.energy_j(),
    }
}

fn contact(step: usize, of: &Region, units: &Units) -> Contact {
    let spacing = units.spacing_m();
    let area_m2 = of.points as f64 * spacing * spacing;
    Contact {
        step,
        contact_radius_m: (area_m2 / PI).sqrt(),
        load_n: of.load * units.point_load_n(),
        centroid_m: Some(of.centroid.map(|place| units.place_m(place))),
        region: Some(RegionShape { area_m2, perimeter_m: of.perimeter * spacing, summits: of.summits }),
        ..Contact::default()
    }
}

/// A map of the surface itself, without its mirror images.
fn map(of: &records::Map, is_further: bool, units: &Units) -> Map {
    let of_the_surface = |field: &[f32], unit: f64| -> Vec<f32> {
        let [all, own] = [units.points, units.own_points()].map(|points| points.div_ceil(of.stride));
        field
            .chunks(all)
            .take(own)
            .flat_map(|row| &row[..own])
            .map(|value| (f64::from(*value) * unit) as f32)
            .collect()
    };
    let (gap_m, pressure_pa) =
        (of_the_surface(&of.gap, units.spacing_m()), of_the_surface(&of.pressure, units.modulus_pa));
    Map { step: of.step, stride: of.stride, is_further, gap_m, pressure_pa }
}
