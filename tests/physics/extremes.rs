//! The ends of the range of inputs: no adhesion at all, adhesion beyond all bounds, low Tabor parameters, loads up to full contact.

use crate::support::{DEFAULT, LENGTH, PAPER, RMS, asperity, close, loop_of, near, paper_spectrum, run, unloading};
use hysteron::model::{Coalescence, Interaction, JumpIn, KeptContacts, Material};
use hysteron::physics::asperities::contact::{Problem, Rules};
use hysteron::physics::asperities::{Asperities, Cycle, Settings};
use hysteron::physics::cycle::soundness::{LoopEnergy, check_energy, loop_energy};
use hysteron::physics::cycle::{Branch, Method};
use hysteron::physics::surface::summits::{Summit, find_summits};
use hysteron::physics::surface::synthesis::{realization_seed, synthesize};
use hysteron::physics::{LoopError, PhysicsError, Reason};
use std::collections::BTreeSet;
use std::f64::consts::PI;

/// Summits of the paper's surface of another campaign seed.
fn summits(zeta: u32, seed: u64, realization: u64) -> Vec<Summit> {
    let surface = synthesize(&paper_spectrum(0.8, zeta), &realization_seed(seed, realization), 8 * zeta as usize);
    find_summits(surface.heights_m.view(), LENGTH, 8.0).unwrap().list
}

fn attempt(problem: &Problem, load: f64) -> Result<Cycle, PhysicsError> {
    let settings = Settings { max_loads: vec![load], approach_step: 0.05, contacts: KeptContacts::None, rest_every: None };
    Asperities { problem: problem.clone(), settings }.run()
}

/// Wu's jump-in penetration is below the jump-off penetration at Tabor parameters from 0.2 to 1. Version 0.1.0 did not end for the first two of these, and in the
/// third no asperity came into contact. A free asperity takes one event to jump in and one to leave, and a few to be absorbed.
#[test]
fn reg_low_tabor_parameters_end() {
    let rules = Rules { allow_low_tabor: true, ..DEFAULT };
    for (zeta, adhesion, range) in [(8, 1e-6, 1e-9), (16, 1e-6, 1e-9), (16, 0.07, 1e-6)] {
        let material = Material { work_of_adhesion_j_m2: adhesion, interaction_range_m: range, ..PAPER };
        let summits = summits(zeta, 3, 0);
        let problem = Problem::new(&summits, LENGTH, RMS, material, rules).unwrap();
        let cycle = attempt(&problem, 0.002).unwrap();
        assert!(cycle.events.len() <= 8 * summits.len(), "{} events of {} asperities", cycle.events.len(), summits.len());
        assert!(cycle.steps.iter().any(|step| step.counts.contacts > 0) && cycle.steps.last().unwrap().counts.contacts == 0);
    }
}

/// Without adhesion the asperities are Hertzian, the loop encloses no area, and unloading is loading in reverse.
#[test]
fn lim_without_adhesion() {
    use Coalescence::{Cover, Merge};
    for (interaction, coalescence) in [(Interaction::Spots, Cover), (Interaction::Spots, Merge), (Interaction::None, Coalescence::None)] {
        let rules = Rules { interaction, coalescence, ..DEFAULT };
        let material = Material { work_of_adhesion_j_m2: 0.0, ..PAPER };
        let problem = Problem::new(&summits(16, 3, 0), LENGTH, RMS, material, rules).unwrap();
        let cycle = run(&problem, &[0.002, 0.0071], 0.05, KeptContacts::All);
        for k in 0..2 {
            let back = unloading(&cycle, k);
            assert_eq!(loop_of(&cycle, k).loss, 0.0);
            assert_eq!(loop_of(&cycle, k).pull_off, 0.0);
            assert_eq!(back.last().unwrap().counts.contacts, 0);
            for again in back {
                let there = cycle
                    .steps
                    .iter()
                    .find(|step| step.branch == Branch::Loading && step.mean_penetration_m == again.mean_penetration_m)
                    .unwrap();
                assert_eq!((there.load_n, there.area_m2, there.counts.contacts), (again.load_n, again.area_m2, again.counts.contacts));
            }
            // Events are undone: those of the unloading give back what those of the loading took, but for the order of the sum.
            near("events", loop_of(&cycle, k).events, 0.0, 1e-12 * loop_energy(&cycle, k).work_j.max(1e-12));
        }
    }
}

/// One Hertzian asperity: `F = (4/3) E* sqrt(R) Δ^(3/2)`, `A = πRΔ` (Hertz 1882).
#[test]
fn lim_hertz() {
    let (radius, height) = (2e-4, 3e-6);
    let material = Material { work_of_adhesion_j_m2: 0.0, ..PAPER };
    let rules = Rules { interaction: Interaction::None, ..DEFAULT };
    let problem = Problem::new(&[asperity(5e-4, 5e-4, height, radius)], LENGTH, RMS, material, rules).unwrap();
    let cycle = run(&problem, &[1e-4], 0.05, KeptContacts::None);
    assert!(cycle.steps.len() > 20);
    for step in cycle.steps.iter().filter(|step| step.counts.contacts > 0) {
        let depth = step.mean_penetration_m;
        // A step is in equilibrium to 1e-10 of the rms height, 5e-16 m of depths from 1e-7 m on.
        close("load", step.load_n, 4.0 / 3.0 * 1e6 * radius.sqrt() * depth.powf(1.5), 1e-8);
        close("area", step.area_m2, PI * radius * depth, 1e-8);
    }
}

/// Weak adhesion without coalescence: Θ falls with Δγ^(5/3), as JKR has it for each asperity, to the limit 0.
#[test]
fn lim_weak_adhesion() {
    let rules = Rules { jump_in: JumpIn::Jkr, coalescence: Coalescence::None, ..DEFAULT };
    let loss = |adhesion: f64| {
        let material = Material { work_of_adhesion_j_m2: adhesion, ..PAPER };
        let problem = Problem::new(&summits(8, 3, 0), LENGTH, RMS, material, rules).unwrap();
        loop_energy(&attempt(&problem, 0.002).unwrap(), 0)
    };
    let (weak, weaker, none) = (loss(1e-4), loss(1e-5), loss(0.0));
    // The number of asperities that touch is the same; elastic interaction changes each loop by less than a tenth.
    close("exponent", (weak.loss_j / weaker.loss_j).log10(), 5.0 / 3.0, 0.05);
    assert_eq!(none.loss_j, 0.0);
    close("work of loading", weaker.work_j, none.work_j, 1e-3);
}

/// Whatever the material and the load, a cycle is a contact or an error with a reason.
#[test]
fn law_no_result_that_is_none() {
    let summits = summits(4, 3, 0);
    let (mut sound, mut refused) = (0, 0);
    for modulus in [1e3, 1e6, 1e12] {
        for adhesion in [1e-12, 1e-3, 0.07, 1.0, 1000.0] {
            for load in [0.002, 0.2] {
                let rules = Rules { allow_low_tabor: true, ..DEFAULT };
                let material = Material { contact_modulus_pa: modulus, work_of_adhesion_j_m2: adhesion, ..PAPER };
                let problem = Problem::new(&summits, LENGTH, RMS, material, rules).unwrap();
                match attempt(&problem, load) {
                    Ok(cycle) => {
                        sound += 1;
                        let energy = loop_energy(&cycle, 0);
                        assert!(cycle.steps.iter().all(|step| step.area_m2 <= LENGTH * LENGTH && step.area_union_m2 <= LENGTH * LENGTH));
                        assert!(energy.loss_j >= -energy.resolution_j(), "{modulus:e} {adhesion:e} {load}: {energy:?}");
                        let gap = (energy.loss_j - energy.events_j).abs();
                        assert!(gap <= (0.5 * energy.loss_j).max(1e-3 * energy.work_j), "{modulus:e} {adhesion:e} {load}: {energy:?}");
                        assert!(gap <= (0.5 * energy.loss_j).max(energy.resolution_j()), "{modulus:e} {adhesion:e} {load}: {energy:?}");
                    }
                    Err(error) => {
                        refused += 1;
                        let message = error.to_string();
                        assert!(message.len() > 30 && !message.contains("NaN"), "{modulus:e} {adhesion:e} {load}: {message}");
                    }
                }
            }
        }
    }
    assert!(sound >= 8 && refused >= 8, "{sound} sound, {refused} refused");
}

/// The rules of a result, each broken by hand.
#[test]
fn reg_unsound_cycles_are_refused() {
    let summits = summits(8, 3, 0);
    let sticky = Material { contact_modulus_pa: 1e3, ..PAPER };
    let error = attempt(&Problem::new(&summits, LENGTH, RMS, sticky, DEFAULT).unwrap(), 0.002).unwrap_err();
    assert!(matches!(error, PhysicsError::Loop(LoopError::ExcessArea { share, .. }) if share > 1.0), "{error}");
    let problem = Problem::new(&summits, LENGTH, RMS, PAPER, DEFAULT).unwrap();
    let whole = attempt(&problem, 0.002).unwrap();
    check_energy(&whole, 0).unwrap();
    let mut gains = whole.clone();
    gains.steps.last_mut().unwrap().work_j -= 3.0 * loop_energy(&whole, 0).work_j;
    assert!(matches!(check_energy(&gains, 0), Err(LoopError::NegativeDissipation { .. })));
    let mut unbalanced = whole;
    for step in &mut unbalanced.steps {
        step.dissipated_j *= 1.6;
    }
    assert!(matches!(check_energy(&unbalanced, 0), Err(LoopError::EnergyImbalance { .. })));
}

/// A loop that violates sign or energy balance by a thousandth of its work is kept, and its Θ is not resolved.
#[test]
fn reg_small_violations_leave_the_energy_unresolved() {
    let small = |loss: f64, events: f64| LoopEnergy { loss_j: loss, events_j: events, work_j: 1.0 };
    close("balanced", small(1e-4, 0.9e-4).resolution_j(), 1e-7, 1e-12);
    close("negative", small(-1e-4, -0.9e-4).resolution_j(), 1e-4, 1e-12);
    close("unbalanced", small(1e-4, 3e-4).resolution_j(), 2e-4, 1e-12);
    for (loss, events, is_sound) in
        [(0.3, 0.3, true), (f64::NAN, 0.3, false), (0.3, f64::NAN, false), (-0.3, f64::NAN, false), (0.3, 0.7, false)]
    {
        assert_eq!(small(loss, events).is_sound(), is_sound, "{loss}, {events}");
    }
    let problem = Problem::new(&summits(8, 3, 0), LENGTH, RMS, PAPER, DEFAULT).unwrap();
    let whole = attempt(&problem, 0.002).unwrap();
    let LoopEnergy { loss_j, work_j, .. } = loop_energy(&whole, 0);
    for (violation, is_kept) in [(9e-4, true), (1.1e-3, false)] {
        let mut gains = whole.clone();
        gains.steps.last_mut().unwrap().work_j -= loss_j + violation * work_j;
        // The events are those of a loop with that energy.
        for step in &mut gains.steps {
            step.dissipated_j = 0.0;
        }
        assert_eq!(check_energy(&gains, 0).is_ok(), is_kept, "{violation}");
        assert!(loop_energy(&gains, 0).resolution_j() >= 0.9 * violation * work_j);
    }
}

/// The energy of the loading events is part of the energy balance also where the unloading undoes them.
#[test]
fn reg_imbalance_without_adhesion() {
    let material = Material { work_of_adhesion_j_m2: 0.0, ..PAPER };
    let problem = Problem::new(&summits(8, 3, 0), LENGTH, RMS, material, DEFAULT).unwrap();
    let mut cycle = attempt(&problem, 0.002).unwrap();
    check_energy(&cycle, 0).unwrap();
    let work = loop_energy(&cycle, 0).work_j;
    cycle.steps[1].dissipated_j = 0.6 * work;
    assert!(matches!(check_energy(&cycle, 0), Err(LoopError::EnergyImbalance { .. })));
}

/// Weak adhesion at a high load: the energies of the events are known to 1e-6 of the work, and Θ is less than that. It is not resolved, and no error.
#[test]
fn reg_weak_adhesion_at_high_load() {
    let rules = Rules { jump_in: JumpIn::Jkr, coalescence: Coalescence::None, ..DEFAULT };
    let material = Material { work_of_adhesion_j_m2: 1e-4, ..PAPER };
    for realization in 0..2 {
        let problem = Problem::new(&summits(8, 5, realization), LENGTH, RMS, material, rules).unwrap();
        let energy = loop_energy(&attempt(&problem, 0.03).unwrap(), 0);
        assert!(energy.loss_j < 1e-5 * energy.work_j, "{energy:?}");
    }
}

/// Each reason has its own sentence, and an unknown residual is not printed as one.
#[test]
fn reg_no_equilibrium_has_a_reason_in_words() {
    let sentence = |reason: Reason, residual_m: f64| {
        LoopError::NoEquilibrium { mean_penetration_m: 1e-7, reason, residual_m, asperity: 3, iterations: 100 }.to_string()
    };
    let known = sentence(Reason::Residual, 2e-9);
    assert!(known.contains("the largest residual stays at 2e-9 m (asperity 3)"), "{known}");
    let unknown = [Reason::Unstable, Reason::NotANumber];
    let sentences: BTreeSet<String> = unknown.into_iter().map(|reason| sentence(reason, f64::NAN)).chain([known]).collect();
    assert_eq!(sentences.len(), unknown.len() + 1);
    assert!(sentences.iter().all(|text| !text.contains("NaN")), "{sentences:?}");
    assert_eq!(sentence(Reason::Residual, f64::NAN), sentence(Reason::NotANumber, f64::NAN));
}
