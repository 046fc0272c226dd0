//! The examples of the library, run.

use crate::support::{close, loop_of, near};
use hysteron::model::Material;
use hysteron::physics::cycle::Branch;
use hysteron::physics::jkr::Asperity;

#[path = "../examples/boundary_elements.rs"]
#[expect(dead_code, reason = "the function main is not called")]
mod boundary_elements;
#[path = "../examples/four_asperities.rs"]
#[expect(dead_code, reason = "the function main is not called")]
mod four_asperities;
#[path = "../examples/jkr_loop.rs"]
#[expect(dead_code, reason = "the function main is not called")]
mod jkr_loop;
#[path = "../examples/observe_path.rs"]
#[expect(dead_code, reason = "the function main is not called")]
mod observe_path;
#[path = "../examples/probe_loop.rs"]
#[expect(dead_code, reason = "the function main and some constants are not used")]
mod probe_loop;

#[test]
fn reg_example_of_a_loop_of_a_probe() {
    let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/data/examples/probe_loop.csv")).unwrap();
    assert_eq!(probe_loop::run().unwrap(), text, "write it again: cargo run --no-default-features --example probe_loop");
    assert!(text.starts_with("# INVENTED DATA"));
}

#[test]
fn law_example_of_a_jkr_loop() {
    // Events are located to 1e-6 of the unit of the approach, which is an eighth of the jump-off penetration; an equilibrium to 1e-10 of that unit.
    let tolerances = [1e-9, 1e-6, 1e-6, 1e-6];
    let rows = jkr_loop::run().unwrap();
    assert_eq!(rows.len(), tolerances.len());
    for (row, tolerance) in rows.iter().zip(tolerances) {
        close(row.quantity, row.computed, row.exact, tolerance);
    }
}

#[test]
fn law_example_of_four_asperities() {
    let cycle = four_asperities::run().unwrap();
    assert_eq!(cycle.steps[cycle.turning[0].0].counts.contacts, 4);
    let last = cycle.steps.last().unwrap();
    assert_eq!((last.branch, last.counts.contacts, last.load_n), (Branch::Unloading, 0, 0.0));
    // The highest asperity jumps into contact where Wu's criterion has it: no other contact displaces the surface before.
    let [_, _, _, radius] = four_asperities::ASPERITIES[0];
    let material = four_asperities::MATERIAL;
    let jump_in = Asperity::new(radius, &material).unwrap().wu_jump_in_penetration(material.interaction_range_m);
    // An event is located to 1e-6 of the unit of the approach, 1e-13 m.
    near("first jump into contact", cycle.events[0].mean_penetration_m, jump_in, 1e-13);
    // The energy of the interaction is exact for point loads; the fields of contact spots differ from these by (a/r)², 0.03 of the interaction.
    let sums = loop_of(&cycle, 0);
    close("energy balance", sums.events, sums.loss, 2e-3);
}

#[test]
fn law_example_of_an_observed_path() {
    let observed = observe_path::run().unwrap();
    let [first, resumed] = &observed.cycles;
    assert!(first == resumed, "a resumed cycle has the same steps, events and states");
    let [all, later] = observed.checkpoints;
    assert!(all > 10 && later == all - all / 2 - 1, "{all} checkpoints, {later} after the resume");
    let progress = &observed.progress;
    assert!(progress.iter().all(|fraction| (0.0..=1.0).contains(fraction)) && progress.last() == Some(&1.0), "{progress:?}");
    // Every step is solved at least once, and every iteration of a global solve needs a product.
    let effort = observed.effort;
    assert!(effort.iterations as usize >= first.steps.len() && effort.products > 0 && effort.pairs > 0, "{effort:?}");
}

#[test]
fn law_example_of_boundary_elements() {
    let cycle = boundary_elements::run().unwrap();
    let turn = &cycle.steps[cycle.turning[0].0];
    // The load at the reversal is met to 1e-5.
    close("load at the reversal", turn.load_n / (Material::default().contact_modulus_pa * 1e-6), boundary_elements::MAX_LOAD, 1e-5);
    let last = cycle.steps.last().unwrap();
    assert_eq!((last.area_m2, last.counts.contacts), (0.0, 0));
    // The quadrature of the load next to events at this coarse step.
    let events: f64 = cycle.events.iter().map(|event| event.energy_lost_j).sum();
    assert!(cycle.events.len() > 10, "{}", cycle.events.len());
    close("energy balance", events, turn.work_j + last.work_j, 1e-2);
}
