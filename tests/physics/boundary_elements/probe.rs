//! A spherical probe in a periodic cell, on a half-space, on a layer and on a compliant machine.

use hysteron::physics::cycle::{Branch, Cycle, Method};
use hysteron::physics::elements::path::cycle::Turning;
use hysteron::physics::elements::{Elements, Options};
use hysteron::physics::model::{Control, FarField, Machine, Material, Probe};
use hysteron::physics::surface::HeightMap;
use ndarray::Array2;
use std::f64::consts::PI;

const MATERIAL: Material = Material { contact_modulus_pa: 1e6, work_of_adhesion_j_m2: 0.05, interaction_range_m: 1e-9 };
const RADIUS: f64 = 50e-6;

/// JKR radius of contact at zero penetration [m].
fn a0() -> f64 {
    (2.0 * PI * MATERIAL.work_of_adhesion_j_m2 * RADIUS * RADIUS / MATERIAL.contact_modulus_pa).cbrt()
}

/// Pull-off force, dissipated energy, area at the load reversal.
struct Loop {
    pull_off_n: f64,
    loss_j: f64,
    area_m2: f64,
}

/// The loop of a smooth sphere in a square of `sides` a0, with `per` points per a0, loaded to a penetration of about a0²/R.
fn smooth(sides: f64, per: usize, machine: Machine) -> (Loop, Cycle<Turning>) {
    let points = (sides * per as f64).round() as usize;
    let length_m = sides * a0();
    let heights = Array2::zeros((points, points));
    let map = HeightMap { heights_m: heights.view(), length_m, is_periodic: true, shortest_wavelength_m: length_m, rms_height_m: 1e-9 };
    let options = Options { points, probe: Some(Probe { radius_m: RADIUS }), machine, ..Options::default() };
    let load = 2.0 * PI * MATERIAL.work_of_adhesion_j_m2 * RADIUS;
    let unit = MATERIAL.contact_modulus_pa * length_m * length_m;
    let cycle = Elements::new(&map, &MATERIAL, &[load / unit], &options).unwrap().run().unwrap();
    let reversal = cycle.turning[0].0;
    let pull_off_n = cycle.steps.iter().map(|s| -s.least_load_n).fold(0.0, f64::max);
    let loss_j = cycle.steps[reversal].work_j + cycle.steps.last().unwrap().work_j;
    let transforms: u64 = cycle.steps.iter().map(|s| s.numerics.effort.transforms).sum();
    eprintln!(
        "steps {} transforms {transforms} unconverged {}",
        cycle.steps.len(),
        cycle.steps.iter().filter(|s| !s.numerics.is_converged).count()
    );
    (Loop { pull_off_n, loss_j, area_m2: cycle.steps[reversal].area_m2 }, cycle)
}

#[test]
fn try_probe() {
    let w = MATERIAL.work_of_adhesion_j_m2;
    let theta = 7.092196 * w.powf(5.0 / 3.0) * RADIUS.powf(4.0 / 3.0) * MATERIAL.contact_modulus_pa.powf(-2.0 / 3.0);
    let force = 1.5 * PI * w * RADIUS;
    let half = Machine { far_field: FarField::HalfSpace, ..Machine::default() };
    let load = Machine { control: Control::Load, ..half };
    for (name, sides, machine) in [("load", 8.0, load)] {
        let (found, cycle) = smooth(sides, 12, machine);
        let events: f64 = cycle.events.iter().map(|e| e.energy_lost_j).sum();
        let last = cycle.steps.last().unwrap();
        println!(
            "{name} {sides}: F_po {:.4} Theta {:.4} events {:.4} A {:.4e}; last {:?} F {:.3e} D {:.3e} {:?} of {}",
            found.pull_off_n / force,
            found.loss_j / theta,
            events / theta,
            found.area_m2,
            last.branch,
            last.load_n,
            last.mean_penetration_m,
            last.machine_displacement_m,
            cycle.steps.len()
        );
        if name == "load" {
            for (k, t) in cycle.steps.iter().enumerate().filter(|(k, _)| k % 12 == 0 || *k > 600) {
                println!(
                    "{k} {:?} d {:.4} F {:.4} W {:.4} diss {:.4} tr {}",
                    t.branch,
                    t.mean_penetration_m / 5e-7,
                    t.load_n / (w * RADIUS),
                    t.work_j / theta,
                    t.dissipated_j / theta,
                    t.numerics.effort.transforms
                );
            }
        }
        for e in cycle.events.iter().filter(|e| e.energy_lost_j > 0.003 * theta) {
            println!(
                "   {:?} step {} F {:.3} -> {:.3}, {:.3}",
                e.kind,
                e.step,
                e.before.load_n / force,
                e.after.load_n / force,
                e.energy_lost_j / theta
            );
        }
    }
}
