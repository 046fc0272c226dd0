//! Asperities on a probe and on a machine with a spring, against closed forms of JKR theory.

use crate::support::{DEFAULT, LENGTH, Loop, PAPER, RMS, asperity, close, local_contacts, near, paper_summits};
use hysteron::model::{Boundary, Coalescence, Control, FarField, Interaction, JumpIn, KeptContacts, Machine, Material, Probe};
use hysteron::physics::asperities::contact::{Problem, Rules};
use hysteron::physics::asperities::{Asperities, Cycle, Numerics, Options, summits_on_probe};
use hysteron::physics::cycle::{Branch, Method, Step};
use hysteron::physics::jkr::Asperity;
use hysteron::physics::surface::summits::{Summit, find_summits};
use hysteron::physics::{EventKind, LoopError, PhysicsError};
use ndarray::Array2;
use std::f64::consts::PI;

const ADHESIVE: Material = Material { contact_modulus_pa: 1e6, work_of_adhesion_j_m2: 0.05, interaction_range_m: 1e-9 };
const RADIUS: f64 = 5e-5;
const SPHERE: Probe = Probe { radius_m: RADIUS };

/// Units of JKR theory: contact radius, penetration \[m\], load \[N\].
fn units() -> (f64, f64, f64) {
    (SPHERE.jkr_radius_m(&ADHESIVE), SPHERE.jkr_length_m(&ADHESIVE), RADIUS * ADHESIVE.work_of_adhesion_j_m2)
}

/// Load in these units at a contact radius in these units (Eq 1).
fn load(a: f64) -> f64 {
    4.0 / 3.0 * a.powi(3) - (8.0 * PI * a.powi(3)).sqrt()
}

/// Penetration in these units (Eq 2).
fn penetration(a: f64) -> f64 {
    a * a - (2.0 * PI * a).sqrt()
}

/// `∫F dδ` along the branch from `a = 0`: the product of Eq 1 and the slope of Eq 2 is a sum of powers.
fn work(a: f64) -> f64 {
    8.0 / 15.0 * a.powi(5) - 4.0 / 3.0 * (2.0 * PI).sqrt() * a.powf(3.5) + PI * a * a
}

/// Zero of a function between two numbers, by bisection.
fn zero(of: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let sign = of(low).signum();
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if of(middle).signum() == sign { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// Dissipated energy of `count` equal asperities with one spring of compliance c, in these units. They touch at D = 0, where they jump
/// to the branch, and leave where `dD/da = 0`, `D = δ + c·count·F`.
fn loss_with_spring(c: f64, count: f64) -> f64 {
    let c = c * count;
    let displacement = |a: f64| penetration(a) + c * load(a);
    let slope = |a: f64| 2.0 * a - (PI / (2.0 * a)).sqrt() + c * (4.0 * a * a - 3.0 * (2.0 * PI * a).sqrt());
    let off = zero(slope, 0.5, 1.5233);
    let touch = zero(displacement, off, 4.0);
    let spring = |a: f64| 0.5 * c * load(a).powi(2);
    count * (work(off) + spring(off) - work(touch) - spring(touch))
}

fn options(rules: Rules, machine: Machine, approach_step: f64) -> Options {
    Options { rules, probe: Some(SPHERE), machine, approach_step, contacts: KeptContacts::Turning, numerics: Numerics::DEFAULT }
}

/// Interactions off and plain JKR.
const ALONE: Rules =
    Rules { interaction: Interaction::None, coalescence: Coalescence::None, jump_in: JumpIn::Jkr, allow_low_tabor: true, ..DEFAULT };

fn machine(c: f64) -> Machine {
    let (_, length, force) = units();
    Machine { compliance_m_n: c * length / force, ..Machine::default() }
}

const LOAD: Machine = Machine { compliance_m_n: 0.0, far_field: FarField::Cell, control: Control::Load };
const HALF_SPACE: Machine = Machine { compliance_m_n: 0.0, far_field: FarField::HalfSpace, control: Control::Displacement };

/// A loop of asperities of the problem to a load in units of `RΔγ`.
fn cycle(summits: &[Summit], length: f64, load: f64, options: &Options) -> Cycle {
    let max_load = load * units().2 / (ADHESIVE.contact_modulus_pa * length * length);
    Asperities::of_summits(summits, length, 1e-8, &ADHESIVE, &[max_load], options).unwrap().run().unwrap()
}

/// The smooth sphere at the middle of the square: flat summits would have no curvature of their own.
fn sphere(length: f64) -> [Summit; 1] {
    [asperity(0.5 * length, 0.5 * length, 0.0, 1e6)]
}

/// Sums of a loop with one load reversal.
fn sums(cycle: &Cycle) -> Loop {
    let (turn, back) = (&cycle.steps[cycle.turning[0].0], back(cycle));
    Loop {
        loss: turn.work_j + back.last().unwrap().work_j,
        events: cycle.steps.iter().map(|step| step.dissipated_j).sum(),
        pull_off: -back.iter().map(|step| step.least_load_n).fold(0.0, f64::min),
        area: turn.area_m2,
    }
}

fn of_units(sums: &Loop) -> [f64; 3] {
    let (_, length, force) = units();
    [sums.loss / (force * length), sums.events / (force * length), sums.pull_off / force]
}

/// All steps of the last branch.
fn back(cycle: &Cycle) -> Vec<&Step> {
    cycle.steps.iter().filter(|step| step.branch == Branch::Unloading).collect()
}

#[test]
fn val_a_sphere_with_a_spring_has_the_loop_of_jkr_theory() {
    // 7.092196 is 2π^(5/3)·0.5262203 (Eq A1).
    close("closed form", loss_with_spring(0.0, 1.0), 7.092_196, 1e-6);
    for (c, allowed) in [(0.0, 1e-6), (0.2, 4e-6), (1.0, 4e-6), (5.0, 4e-6), (100.0, 1e-5)] {
        let found = cycle(&sphere(1e-3), 1e-3, 20.0, &options(ALONE, machine(c), 0.05));
        let [loss, events, pull_off] = of_units(&sums(&found));
        let want = loss_with_spring(c, 1.0);
        // Events are met to 1e-6 of the JKR length, and the work is that of a cubic between states.
        close(&format!("Theta at c = {c}"), loss, want, allowed);
        close(&format!("events at c = {c}"), events, want, allowed);
        // The load is recorded at steps and events; the maximum is quadratic in Δ, and the spring moves it by at most its own change.
        close(&format!("pull-off at c = {c}"), pull_off, 1.5 * PI, 2e-3);
        let (_, length, force) = units();
        let stiffness = c * length / force;
        for step in &found.steps {
            let machine = step.machine_displacement_m.unwrap();
            near("D = Δ + cF", step.mean_penetration_m + stiffness * step.load_n, machine, 1e-9 * length * (1.0 + c));
            // Every step is on the curve of JKR theory.
            if step.counts.contacts == 1 {
                let a = (step.area_m2 / PI).sqrt() / units().0;
                near("F", step.load_n / force, load(a), 1e-8);
                near("Δ", step.mean_penetration_m / length, penetration(a), 1e-7 * (1.0 + c));
            }
        }
    }
}

#[test]
fn val_two_equal_asperities_share_the_spring() {
    let pair = [asperity(3e-4, 5e-4, 0.0, RADIUS), asperity(7e-4, 5e-4, 0.0, RADIUS)];
    for (c, control) in [(0.3, Control::Displacement), (2.0, Control::Displacement), (0.0, Control::Load)] {
        let (_, length, force) = units();
        let machine = Machine { control, ..machine(c) };
        let max_load = 40.0 * force / (ADHESIVE.contact_modulus_pa * LENGTH * LENGTH);
        let options = Options { probe: None, ..options(ALONE, machine, 0.05) };
        // The rms height is the unit of the path without a probe.
        let found = Asperities::of_summits(&pair, LENGTH, length, &ADHESIVE, &[max_load], &options).unwrap().run().unwrap();
        let [loss, events, pull_off] = of_units(&sums(&found));
        if control == Control::Load {
            // A jump over δ changes the load by δ/c, with c = 1000/(E*a); the energy by δ²/(2c) = 2e-3 of 16.
            close("Theta", loss, 2.0 * loss_of_load_control(), 2e-3);
            close("pull-off", pull_off, 3.0 * PI, 1e-6);
        } else {
            close("Theta", loss, loss_with_spring(c, 2.0), 4e-6);
            close("pull-off", pull_off, 3.0 * PI, 2e-3);
        }
        close("events", events, loss, 4e-6);
    }
}

/// Work to pull-off at prescribed load: the contact jumps in at F = 0, and is lost at the maximum tension.
fn loss_of_load_control() -> f64 {
    let [touch, off] = [(4.5 * PI).cbrt(), (1.125 * PI).cbrt()];
    near("load at touch", load(touch), 0.0, 1e-12);
    near("maximum tension", load(off), -1.5 * PI, 1e-12);
    near("its penetration", penetration(off), -0.773_417, 1e-6);
    work(off) - work(touch)
}

#[test]
fn val_load_control_ends_at_the_maximum_tension() {
    let want = loss_of_load_control();
    close("over that of displacement control", want / loss_with_spring(0.0, 1.0), 1.143, 1e-3);
    let found = cycle(&sphere(1e-3), 1e-3, 20.0, &options(ALONE, LOAD, 0.05));
    let (_, length, force) = units();
    let [loss, events, pull_off] = of_units(&sums(&found));
    // The jump into contact over 1.949 lengths at c = 1000: δ²/(2c) of 8.1, 2.3e-4; found 2.4e-4.
    close("Theta", loss, want, 3e-4);
    close("events", events, loss, 1e-6);
    close("pull-off", pull_off, 1.5 * PI, 1e-9);
    let back = back(&found);
    let (last, before) = (back[back.len() - 1], back[back.len() - 2]);
    // The minimum of the load is flat: its place is that of a vanishing derivative, which is known to 1e-4.
    near("Δ at pull-off", before.mean_penetration_m / length, -0.773_417, 1e-3);
    assert_eq!((before.counts.contacts, last.counts.contacts, last.load_n), (1, 0, 0.0));
    assert_eq!((last.mean_penetration_m, last.work_j), (before.mean_penetration_m, before.work_j));
    assert!(found.steps.iter().all(|step| step.machine_displacement_m.is_none()));
    // The tension at the jump into contact is that of the spring alone.
    let first = found.steps.iter().find(|step| step.counts.contacts == 1).unwrap();
    near("load after the jump", first.least_load_n.min(first.load_n) / force, 0.0, 5e-3);
}

#[test]
fn lim_without_the_spring_of_the_cell_a_contact_is_on_a_half_space() {
    let (radius, _, _) = units();
    let rules = Rules { interaction: Interaction::Spots, jump_in: JumpIn::Jkr, allow_low_tabor: true, ..DEFAULT };
    // The next term of the images is of the order (a/L)² of the first, which changes Θ by a fifth: a = 3.3 radii at the largest load.
    for (sides, allowed) in [(16.0, 1e-2), (64.0, 1e-3)] {
        let length = sides * radius;
        let of = |rules: Rules, machine: Machine| {
            let found = cycle(&sphere(length), length, 10.0, &options(rules, machine, 0.05));
            of_units(&sums(&found))
        };
        let isolated = of(Rules { boundary: Boundary::Isolated, ..rules }, Machine::default());
        let (cell, half_space) = (of(rules, Machine::default()), of(rules, HALF_SPACE));
        close("isolated", isolated[0], 7.092_196, 1e-6);
        close("half-space", half_space[0], isolated[0], allowed);
        close("balance", half_space[1], half_space[0], allowed);
        // Displacement of the images: a spring of negative compliance −3.900265/(πE*L) of the cell.
        let c = -3.900_265 / (PI * sides);
        close("cell", cell[0], loss_with_spring(c, 1.0), allowed);
        assert!((cell[0] / isolated[0] - 1.0).abs() > 10.0 * allowed, "{} {}", cell[0], isolated[0]);
        close(
            "half-space is the isolated boundary with both",
            of(Rules { boundary: Boundary::Isolated, ..rules }, HALF_SPACE)[0],
            isolated[0],
            1e-12,
        );
    }
}

/// Rough asperities on a probe.
fn rough(interaction: Interaction, coalescence: Coalescence, machine: Machine, patch: usize) -> (Asperities, Loop) {
    let rules = Rules { interaction, coalescence, jump_in: JumpIn::Jkr, ..DEFAULT };
    let options = Options {
        rules,
        probe: Some(Probe { radius_m: 2e-2 }),
        machine,
        approach_step: 0.1,
        contacts: KeptContacts::None,
        numerics: local_contacts(patch),
    };
    let method = Asperities::of_summits(&paper_summits(16, 0), LENGTH, RMS, &PAPER, &[0.0035], &options).unwrap();
    let found = sums(&method.run().unwrap());
    (method, found)
}

#[test]
fn law_without_interaction_a_probe_loses_the_sum_over_its_asperities() {
    let options = Options {
        rules: ALONE,
        probe: Some(Probe { radius_m: 2e-2 }),
        approach_step: 0.1,
        contacts: KeptContacts::None,
        ..Options::default()
    };
    let flat = paper_summits(16, 0);
    let found = Asperities::of_summits(&flat, LENGTH, RMS, &PAPER, &[0.0035], &options).unwrap().run().unwrap();
    let on_probe = summits_on_probe(&flat, Probe { radius_m: 2e-2 }, LENGTH, Boundary::Periodic).unwrap();
    let mut touched: Vec<usize> =
        found.events.iter().filter(|event| event.kind == EventKind::JumpIn).map(|event| event.asperity().unwrap()).collect();
    touched.sort_unstable();
    touched.dedup();
    let theta = |i: &usize| Asperity::new(on_probe[*i].radius_m(), &PAPER).unwrap().loop_loss();
    // As on a flat surface: events are met to 1e-6 of the unit of length, the work is of fourth order in the increments.
    close("Theta", sums(&found).loss, touched.iter().map(theta).sum(), 4e-6);
    // They are those that a smooth probe reaches first.
    let depth = |i: usize| on_probe[i].height_m;
    let lowest = touched.iter().map(|i| depth(*i)).fold(f64::INFINITY, f64::min);
    assert!(touched.len() > 10 && touched.len() < flat.len());
    assert!((0..flat.len()).filter(|i| !touched.contains(i)).all(|i| depth(i) < lowest));
}

#[test]
fn law_with_point_interaction_and_a_spring_the_energy_balances() {
    let stiffness = PAPER.contact_modulus_pa * LENGTH;
    let mut before: Option<Loop> = None;
    for c in [0.0, 1.5, 6.0] {
        let machine = Machine { compliance_m_n: c / stiffness, ..Machine::default() };
        let (_, sums) = rough(Interaction::Point, Coalescence::Cover, machine, usize::MAX);
        // All contacts are solved together: the model with its spring has an exact potential, as without.
        close(&format!("balance at c = {c}"), sums.events, sums.loss, 2e-5);
        if let Some(before) = before {
            assert!(sums.loss > before.loss, "a softer machine dissipates more: {sums:?} {before:?}");
            close("area", sums.area, before.area, 0.02);
        }
        before = Some(sums);
    }
}

#[test]
fn law_local_problems_with_the_spring_of_the_cell_are_those_of_all_contacts() {
    let [local, whole] = [24, usize::MAX].map(|patch| rough(Interaction::Spots, Coalescence::Cover, HALF_SPACE, patch).1);
    // As without a spring: contacts outside respond to first order.
    close("Theta", local.loss, whole.loss, 5e-3);
    close("pull-off", local.pull_off, whole.pull_off, 5e-3);
    close("area", local.area, whole.area, 5e-3);
}

#[test]
fn law_a_soft_machine_loses_the_energy_of_its_spring_beyond_load_control() {
    let c = 300.0 / (PAPER.contact_modulus_pa * LENGTH);
    let soft = Machine { compliance_m_n: c, ..Machine::default() };
    let [held, moved, stiff] =
        [LOAD, soft, Machine::default()].map(|machine| rough(Interaction::Point, Coalescence::Cover, machine, usize::MAX).1);
    // The last jump is that from the maximum tension, and has the potential of the contact and ½cF²; jumps before differ by s²/(2c).
    close("Theta", moved.loss - 0.5 * c * moved.pull_off.powi(2), held.loss, 0.02);
    close("balance", held.events, held.loss, 1e-6);
    // All jumps into contact and out of it are those of one landscape: found 3e-5, of the steps between which the load is recorded.
    close("pull-off of a soft machine", moved.pull_off, held.pull_off, 1e-4);
    close("pull-off of a stiff machine", stiff.pull_off, held.pull_off, 1e-3);
}

#[test]
fn law_load_control_ends_with_merged_contacts_too() {
    let held = rough(Interaction::Spots, Coalescence::Merge, LOAD, 24).1;
    assert!(held.loss > 0.0 && held.pull_off > 0.0);
    // The field of contacts is not exactly reciprocal, as without a spring (found 0.034).
    close("balance", held.events, held.loss, 0.15);
}

#[test]
fn law_asperities_on_a_probe_are_those_of_rough_and_sphere_together() {
    // Waves on a sphere: a map whose summits are found flat, and found with the sphere, of which the map has a smooth period.
    let (points, length, radius) = (256usize, 1e-4, 2e-2);
    let wave = 2.0 * PI / length;
    let of = |x: f64, y: f64| 2e-8 * ((8.0 * wave * x + 0.3).cos() + (8.0 * wave * y - 0.5).cos() + 0.3 * (5.0 * wave * (x + y)).cos());
    // (1 − cos)/q² is r²/2 near the middle, and is periodic.
    let bowl = |d: f64| (1.0 - (wave * d).cos()) / (wave * wave);
    let at = |k: usize| length * k as f64 / points as f64;
    let middle = 0.5 * length;
    let flat = Array2::from_shape_fn((points, points), |(i, j)| of(at(i), at(j)));
    let both = Array2::from_shape_fn((points, points), |(i, j)| of(at(i), at(j)) - (bowl(at(i) - middle) + bowl(at(j) - middle)) / radius);
    let flat = find_summits(flat.view(), length, 16.0).unwrap().list;
    let both = find_summits(both.view(), length, 16.0).unwrap().list;
    let placed = summits_on_probe(&flat, Probe { radius_m: radius }, length, Boundary::Periodic).unwrap();
    let away = |summit: &Summit| (summit.x_m - middle).hypot(summit.y_m - middle);
    let inside = |list: &[Summit]| list.iter().copied().filter(|summit| away(summit) < 0.2 * length).collect::<Vec<_>>();
    let (placed, found) = (inside(&placed), inside(&both));
    assert!(placed.len() >= 3 && placed.len() == found.len(), "{} {}", placed.len(), found.len());
    for summit in &placed {
        let distance = |other: &&Summit| (other.x_m - summit.x_m).hypot(other.y_m - summit.y_m);
        let other = found.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap();
        let r = away(summit);
        // The bowl is r²/2 (1 − (qr)²/12 …); the asperity is a paraboloid of its mean curvature, and it moves by r R_i/R ≪ λ.
        let bowl_error = r * r / (2.0 * radius) * (wave * r).powi(2) / 12.0;
        let tilt = r * r / (2.0 * radius * radius) * (1.0 / summit.curvature_min_1_m - 1.0 / summit.curvature_1_m).abs();
        near("height", summit.height_m, other.height_m, 1.1 * (bowl_error + tilt) + 1e-3 * r * r / (2.0 * radius));
        near("place", distance(&other), 0.0, 2.0 * r / radius / summit.curvature_min_1_m);
        // The bowl loses (qr)²/2 of its curvature.
        close("curvature", summit.curvature_1_m, other.curvature_1_m, 0.05);
    }
}

#[test]
fn law_paraboloids_add() {
    let (radius, own) = (3e-3, 1e-5);
    let at = asperity(6.2e-4, 4.1e-4, 2e-7, own);
    let [sum] = <[Summit; 1]>::try_from(summits_on_probe(&[at], Probe { radius_m: radius }, LENGTH, Boundary::Isolated).unwrap()).unwrap();
    for (x, y) in [(6.2e-4, 4.1e-4), (6.25e-4, 4e-4), (6e-4, 4.2e-4)] {
        let of = |x0: f64, y0: f64, r: f64| ((x - x0).powi(2) + (y - y0).powi(2)) / (2.0 * r);
        let want = at.height_m - of(at.x_m, at.y_m, own) - of(5e-4, 5e-4, radius);
        // Rounding of heights of 5 µm.
        near("height", sum.height_m - of(sum.x_m, sum.y_m, sum.radius_m()), want, 1e-18);
    }
    // Across the edge of a periodic square the nearest apex is meant.
    let far = asperity(9.9e-4, 5e-4, 0.0, own);
    let [sum] = <[Summit; 1]>::try_from(summits_on_probe(&[far], Probe { radius_m: radius }, LENGTH, Boundary::Periodic).unwrap()).unwrap();
    close("depth", -sum.height_m, 4.9e-4f64.powi(2) / (2.0 * (radius + own)), 1e-12);
}

#[test]
fn reg_probe_and_load_that_have_no_result_are_refused() {
    for radius_m in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = summits_on_probe(&sphere(1e-3), Probe { radius_m }, 1e-3, Boundary::Periodic).unwrap_err();
        assert!(matches!(error, PhysicsError::Domain { quantity: "the radius of the probe [m]", .. }), "{error}");
    }
    for compliance_m_n in [-1.0, f64::NAN, f64::INFINITY] {
        let options = options(ALONE, Machine { compliance_m_n, ..Machine::default() }, 0.5);
        let error = Asperities::of_summits(&sphere(1e-3), 1e-3, 1e-8, &ADHESIVE, &[1e-6], &options).map(|_| ()).unwrap_err();
        assert!(matches!(error, PhysicsError::Domain { quantity: "the compliance of the machine [m/N]", .. }), "{error}");
    }
    // A load that the sphere reaches only where its contact spans the square.
    let options = options(ALONE, LOAD, 0.5);
    let error = Asperities::of_summits(&sphere(1e-4), 1e-4, 1e-8, &ADHESIVE, &[10.0], &options).unwrap().run().unwrap_err();
    assert!(matches!(error, PhysicsError::Loop(LoopError::ExcessArea { .. } | LoopError::LoadNotReached { .. })), "{error}");
}

#[test]
fn lim_without_adhesion_load_control_retraces() {
    let material = Material { work_of_adhesion_j_m2: 0.0, ..ADHESIVE };
    let options = options(ALONE, LOAD, 0.5);
    let found = Asperities::of_summits(&sphere(1e-3), 1e-3, 1e-6, &material, &[1e-6], &options).unwrap().run().unwrap();
    assert_eq!(sums(&found).loss, 0.0);
    assert!(found.events.iter().filter(|event| event.kind == EventKind::JumpOff).count() == 1);
}

#[test]
fn law_without_a_spring_a_machine_changes_nothing() {
    let rules = Rules { coalescence: Coalescence::Merge, ..DEFAULT };
    let problem = Problem::new(&paper_summits(8, 0), LENGTH, RMS, PAPER, rules).unwrap();
    let plain = crate::support::run(&problem, &[0.004], 0.05, KeptContacts::None);
    let stiff = problem.clone().on_machine(&Machine::default(), 0.004 * problem.load_unit_n());
    assert_eq!(crate::support::run(&stiff, &[0.004], 0.05, KeptContacts::None), plain);
}
