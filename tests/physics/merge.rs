//! Touching spots become one of the same area and load, and part again.

use crate::support::{
    ALONE, DEFAULT, Dice, LENGTH, PAPER, RMS, asperity, close, local_contacts, loop_of, near, paper_cycle, paper_summits, run, turning,
    unloading,
};
use hysteron::model::{Coalescence, Interaction, KeptContacts, Material};
use hysteron::physics::EventKind;
use hysteron::physics::LoopError;
use hysteron::physics::SpotStatus;
use hysteron::physics::asperities::contact::{Problem, Rules, State};
use hysteron::physics::asperities::{Asperities, Cycle, Settings};
use hysteron::physics::cycle::{Merged, Method};
use hysteron::physics::jkr::Asperity;
use hysteron::physics::surface::summits::Summit;
use std::collections::BTreeSet;

const MERGE: Rules = Rules { coalescence: Coalescence::Merge, ..DEFAULT };
const MERGE_ALONE: Rules = Rules { coalescence: Coalescence::Merge, ..ALONE };
const MERGE_POINT: Rules = Rules { interaction: Interaction::Point, ..MERGE };

/// Two spheres across the edge of the square, 20 μm apart.
fn pair() -> [Summit; 2] {
    [asperity(LENGTH - 4e-6, 0.5 * LENGTH, 0.0, 3e-5), asperity(1.2e-5, 0.5 * LENGTH + 1.2e-5, -1e-7, 2e-5)]
}

fn pair_cycle() -> Cycle {
    let problem = Problem::new(&pair(), LENGTH, RMS, PAPER, MERGE_ALONE).unwrap();
    run(&problem, &[1.2e-4], 0.002, KeptContacts::All)
}

#[test]
fn law_two_spots_that_touch_become_one_of_their_area_and_load() {
    let cycle = pair_cycle();
    let kinds: Vec<EventKind> = cycle.events.iter().map(|e| e.kind).collect();
    assert_eq!(kinds, [EventKind::JumpIn, EventKind::JumpIn, EventKind::Merge, EventKind::Split, EventKind::JumpOff, EventKind::JumpOff]);
    let spheres = pair().map(|s| Asperity::new(s.radius_m(), &PAPER).unwrap());
    let (merged, event) = (cycle.merged[0], cycle.events[2]);
    assert_eq!((cycle.merged.len(), merged.asperity, event.asperity().unwrap(), merged.spot.parts), (1, 2, 2, [0, 1]));
    let spot = merged.spot;
    // Alone, each is on its own JKR branch, with penetration δ + z; equilibria are met to 5e-16 m of 1e-6 m.
    for (k, sphere) in spheres.iter().enumerate() {
        let want = sphere.radius_at_penetration(spot.mean_penetration_m + pair()[k].height_m).unwrap();
        close("radius of a part", spot.radii_m[k], want, 1e-8);
    }
    // They merge where they touch, to a thousandth of their distance.
    let distance = (16e-6f64).hypot(12e-6);
    let overlap = (spot.radii_m[0] + spot.radii_m[1]) / distance - 1.0;
    // Located to an overlap of 1e-6.
    assert!((0.0..=1e-6).contains(&overlap), "{overlap:e}");
    // Its centre divides the way between theirs, over the edge, in the inverse ratio of their areas.
    let share = (spot.radii_m[1] / spot.contact_radius_m()).powi(2);
    near("x", spot.place_m[0], (LENGTH - 4e-6 + share * 16e-6) % LENGTH, 1e-15);
    near("y", spot.place_m[1], 0.5 * LENGTH + share * 12e-6, 1e-15);
    // Area and load are those of the two: what is left is the rounding of cubes and differences.
    let whole = Asperity::new(spot.radius_m, &PAPER).unwrap();
    let load: f64 = spheres.iter().zip(spot.radii_m).map(|(sphere, a)| sphere.load(a)).sum();
    close("load of the merged spot", whole.load(spot.contact_radius_m()), load, 1e-10);
    close("load", event.after.load_n, event.before.load_n, 1e-8);
    close("area", event.after.area_m2, event.before.area_m2, 1e-8);
    // From then on it is one JKR sphere, at the height at which it was in equilibrium.
    let top = turning(&cycle, 0);
    let a = whole.radius_at_penetration(top.mean_penetration_m + spot.height_m).unwrap();
    close("area at the turning point", top.area_m2, std::f64::consts::PI * a * a, 1e-8);
    close("load at the turning point", top.load_n, whole.load(a), 1e-8);
    assert_eq!(top.counts.contacts, 1);
}

#[test]
fn law_merging_and_parting_of_a_pair_costs_nothing() {
    let cycle = pair_cycle();
    let [merge, split] = [2, 3].map(|k| cycle.events[k]);
    // It parts at the radius at which it merged, to 1e-4: twice that of the way of 1e-5 m that a²/R has made.
    near("approach", split.mean_penetration_m, merge.mean_penetration_m, 2e-9);
    // The constant of the merged spot takes up the difference of the potentials: neither costs anything, to the rounding of the sums (1e-16 of
    // the energies of its parts).
    let scale: f64 = pair().iter().map(|s| Asperity::new(s.radius_m(), &PAPER).unwrap().loop_loss()).sum();
    near("merging", merge.energy_lost_j, 0.0, 1e-9 * scale);
    // It splits a rounding of its radius below the one at which it merged.
    near("splitting", split.energy_lost_j, 0.0, 1e-6 * scale);
    // The loop loses what its jumps lose: by plain JKR each jumps in at δ = 0 and off at the end of its branch.
    let sums = loop_of(&cycle, 0);
    let want: f64 = pair().iter().map(|s| Asperity::new(s.radius_m(), &PAPER).unwrap().loop_loss()).sum();
    // The shares of two radii at parting are those at merging, though each of the two would have gone its own way: 1e-3 of it.
    close("loss", sums.loss, want, 1e-3);
    close("events", sums.events, sums.loss, 1e-6);
}

#[test]
fn law_with_point_interaction_the_loop_loses_what_its_events_lose() {
    // Merged spots are other spheres at other heights, and yet the sum over merging and parting closes the account of the whole loop.
    for (rules, most) in [(MERGE_ALONE, 1e-6), (MERGE_POINT, 1e-6)] {
        let summits = paper_summits(16, 1);
        let problem = Problem::new(&summits, LENGTH, RMS, PAPER, rules).unwrap().with_numerics(local_contacts(usize::MAX));
        let cycle = run(&problem, &[0.0071], 0.04, KeptContacts::None);
        let sums = loop_of(&cycle, 0);
        let count = |kind: EventKind| cycle.events.iter().filter(|e| e.kind == kind).count();
        assert!(count(EventKind::Merge) > 20 && count(EventKind::Split) > 20, "{:?}", rules.interaction);
        // The audit's tolerance: folds are passed by 1e-6 of the rms height, work is a sum of fourth order.
        close("events", sums.events, sums.loss, most);
        assert!(cycle.steps.iter().all(|s| s.numerics.residual_m.unwrap() <= 1e-8 * RMS));
    }
}

#[test]
fn law_merging_costs_nothing_and_splitting_little() {
    // The field of two spots stays at all others when they merge. What a split costs comes from others that have changed since: over the dissipated
    // energy the magnitudes sum to 0.023 (spots) and 0.0035 (point). Where the field of one spot replaced that of two, they were 0.80 and 0.46.
    for (rules, merging, splitting) in [(MERGE, 1e-6, 0.05), (MERGE_POINT, 1e-6, 0.01), (MERGE_ALONE, 1e-9, 1e-6)] {
        let problem = Problem::new(&paper_summits(16, 0), LENGTH, RMS, PAPER, rules).unwrap();
        let cycle = run(&problem, &[0.0071], 0.04, KeptContacts::None);
        for (kind, most) in [(EventKind::Merge, merging), (EventKind::Split, splitting)] {
            let exchanged: f64 = cycle.events.iter().filter(|e| e.kind == kind).map(|e| e.energy_lost_j.abs()).sum();
            let share = exchanged / loop_of(&cycle, 0).loss;
            assert!(share < most, "{:?}, {kind:?}: {share:e}", rules.interaction);
        }
    }
}

#[test]
fn law_area_and_load_are_continuous_at_every_merger() {
    // With interaction as well, since the difference of the fields stays: to the tolerance of local problems, 1e-7 of the rms height, or of the sum over
    // fifty contacts, each in equilibrium to 5e-16 m.
    for (rules, most) in [(MERGE_ALONE, 1e-8), (MERGE_POINT, 1e-6), (MERGE, 1e-6)] {
        let problem = Problem::new(&paper_summits(16, 0), LENGTH, RMS, PAPER, rules).unwrap();
        let cycle = run(&problem, &[0.0071], 0.04, KeptContacts::None);
        let top = turning(&cycle, 0).load_n;
        let mut compared = 0;
        for event in cycle.events.iter().filter(|e| e.kind == EventKind::Merge) {
            close("area", event.after.area_m2, event.before.area_m2, most);
            near("load", event.after.load_n, event.before.load_n, most * top);
            compared += 1;
        }
        assert!(compared > 20, "{compared}");
    }
}

#[test]
fn law_contacts_follow_from_the_status_after_events() {
    let without = Material { work_of_adhesion_j_m2: 0.0, ..PAPER };
    for (rules, material) in [(MERGE, PAPER), (MERGE, without), (DEFAULT, PAPER), (DEFAULT, without)] {
        let problem = Problem::new(&paper_summits(16, 0), LENGTH, RMS, material, rules).unwrap();
        let cycle = run(&problem, &[0.0071], 0.04, KeptContacts::All);
        let mut events = cycle.events.iter().peekable();
        let mut inside = BTreeSet::new();
        for step in 0..cycle.steps.len() {
            while let Some(event) = events.next_if(|event| event.step == step) {
                let number = event.asperity().unwrap();
                let merged = cycle.merged.iter().find(|of| of.asperity == number);
                let parts = merged.map_or(vec![], |of| of.spot.parts.to_vec());
                inside.retain(|i| *i != number && !parts.contains(i));
                match event.status.unwrap() {
                    SpotStatus::Contact => inside.extend([number]),
                    SpotStatus::Split => inside.extend(parts),
                    SpotStatus::Free | SpotStatus::Covered | SpotStatus::Merged => {}
                }
            }
            let spots = cycle.contacts.iter().filter(|spot| spot.step == step && !spot.covered);
            assert_eq!(inside, spots.filter_map(|spot| spot.asperity).collect(), "step {step}");
        }
        assert!(events.next().is_none() && inside.is_empty());
    }
}

#[test]
fn law_a_reversal_before_any_jump_out_of_contact_retraces() {
    // Above the last jump into contact the states of loading and unloading are the same, merged and split, also at a third contact nearby.
    let trio = [pair().to_vec(), vec![asperity(4e-5, 0.5 * LENGTH, 0.0, 2e-5)]].concat();
    for (summits, rules) in [(pair().to_vec(), MERGE_ALONE), (trio.clone(), MERGE), (trio, MERGE_POINT)] {
        let problem = Problem::new(&summits, LENGTH, RMS, PAPER, rules).unwrap();
        let cycle = run(&problem, &[1.2e-4], 0.002, KeptContacts::None);
        let last_in = cycle.events.iter().rfind(|e| e.kind == EventKind::JumpIn).unwrap().mean_penetration_m;
        let merging = cycle.events.iter().find(|e| e.kind == EventKind::Merge).unwrap().mean_penetration_m;
        let loading: Vec<_> = cycle.steps[..cycle.turning[0].0].iter().filter(|s| s.mean_penetration_m > last_in).collect();
        let unloading = unloading(&cycle, 0);
        let mut compared = [0, 0];
        for step in loading {
            let Some(back) = unloading.iter().find(|s| s.mean_penetration_m == step.mean_penetration_m) else { continue };
            // The parts split with the shares of the area that they had at merging, to 1e-4.
            close("load", back.load_n, step.load_n, 1e-6);
            close("area", back.area_m2, step.area_m2, 1e-6);
            compared[usize::from(step.mean_penetration_m > merging)] += 1;
        }
        assert!(compared[0] > 5 && compared[1] > 5, "{:?}: {compared:?}", rules.interaction);
    }
}

#[test]
fn lim_the_dissipated_energy_has_no_floor_at_weak_adhesion() {
    let loss = |rules: Rules, adhesion: f64| {
        let material = Material { work_of_adhesion_j_m2: adhesion, ..PAPER };
        let problem = Problem::new(&paper_summits(16, 0), LENGTH, RMS, material, rules).unwrap();
        let cycle = run(&problem, &[0.0071], 0.04, KeptContacts::None);
        loop_of(&cycle, 0).loss / (problem.load_unit_n() * RMS)
    };
    // Without interaction it is a sum of JKR loops, each in proportion to Δγ^(5/3); the area, and so the number of contacts, hardly changes.
    close("none", loss(MERGE_ALONE, 1e-5) / loss(MERGE_ALONE, 1e-4), 10f64.powf(-5.0 / 3.0), 0.01);
    // With it, Θ is less than without at 1e-5 J/m², and falls at least as fast. Where merging changed the field at others, 2.4e-8 and 3.1e-7 remained.
    let alone = loss(MERGE_ALONE, 1e-5);
    for rules in [MERGE_POINT, MERGE] {
        let (weak, weaker) = (loss(rules, 1e-4), loss(rules, 1e-5));
        assert!(
            0.0 < weaker && weaker < alone && weaker < 1.2 * 10f64.powf(-5.0 / 3.0) * weak,
            "{:?}: {weak:e}, {weaker:e}",
            rules.interaction
        );
    }
}

#[test]
fn law_a_released_asperity_does_not_merge_with_the_contacts_around_it() {
    // They overlap where it is released, as at a split. Merging there would be undone within nanometres.
    let (mut released, mut merged) = (0, 0);
    for realization in 0..6 {
        let cycle = paper_cycle(&paper_summits(16, realization), MERGE, &[0.0071], 0.01);
        for event in cycle.events.iter().filter(|e| e.kind == EventKind::Uncover) {
            let merges =
                |spot: &Merged| spot.parts.contains(&event.asperity().unwrap()) && spot.mean_penetration_m == event.mean_penetration_m;
            released += 1;
            merged += usize::from(cycle.merged.iter().any(|at| merges(&at.spot)));
        }
    }
    // Few meet a contact that they did not overlap, in the same avalanche.
    assert!(released >= 5 && 5 * merged <= released, "{merged} of {released}");
}

#[test]
fn law_a_turning_point_with_merged_spots_is_enough_to_unload_from() {
    let summits = paper_summits(16, 0);
    let problem = Problem::new(&summits, LENGTH, RMS, PAPER, MERGE).unwrap();
    let settings = Settings { max_loads: vec![0.004, 0.0071], approach_step: 0.04, contacts: KeptContacts::None, rest_every: None };
    let method = Asperities { problem, settings };
    let (cycle, problem) = (method.run().unwrap(), &method.problem);
    for (k, (_, state)) in cycle.turning.iter().enumerate() {
        assert!(state.merged.len() > 10);
        let again = State::restored(problem, state.mean_penetration_m, &state.merged(problem), &state.kept(problem)).unwrap();
        let other = method.unload_from(k, again).unwrap();
        let (want, max_load) = (unloading(&cycle, k), method.settings.max_loads[k]);
        assert_eq!(other.steps.len(), want.len());
        for (got, want) in other.steps.iter().zip(want) {
            assert_eq!(got, want, "the same bytes");
        }
        let numbers = |cycle: &Cycle| -> Vec<_> {
            cycle.merged.iter().filter(|m| cycle.steps[m.step].max_load == Some(max_load)).map(|m| (m.asperity, m.spot)).collect()
        };
        assert_eq!(numbers(&other), numbers(&cycle));
    }
}

#[test]
fn reg_merged_spots_that_fill_the_square_are_refused_with_a_sentence() {
    // Soft and sticky enough: full contact at hardly any load.
    let summits = paper_summits(16, 0);
    let problem = Problem::new(&summits, LENGTH, RMS, PAPER, MERGE).unwrap();
    let settings = Settings { max_loads: vec![0.1], approach_step: 0.04, contacts: KeptContacts::None, rest_every: None };
    let error = Asperities { problem, settings }.run().unwrap_err();
    assert!(matches!(error, hysteron::physics::PhysicsError::Loop(LoopError::ExcessArea { .. })), "{error}");
    assert!(error.to_string().contains("leaves no gap"), "{error}");
}

#[test]
fn reg_a_load_beyond_full_contact_leaves_the_loads_before_it() {
    let summits = paper_summits(16, 0);
    let problem = Problem::new(&summits, LENGTH, RMS, PAPER, MERGE).unwrap();
    let to = |max_loads: &[f64]| {
        let settings = Settings { max_loads: max_loads.to_vec(), approach_step: 0.04, contacts: KeptContacts::None, rest_every: None };
        Asperities { problem: problem.clone(), settings }.run().unwrap()
    };
    let (both, alone) = (to(&[0.002, 0.1]), to(&[0.002]));
    assert_eq!(both.unreached.len(), 1);
    assert!(both.unreached[0].0 == 1 && both.unreached[0].1.to_string().contains("leaves no gap"), "{:?}", both.unreached);
    assert!(alone.unreached.is_empty() && both.turning.len() == 1);
    let of = |cycle: &Cycle| cycle.steps.iter().filter(|step| step.max_load == Some(0.002)).cloned().collect::<Vec<_>>();
    assert!(!of(&alone).is_empty());
    assert_eq!(of(&both), of(&alone), "the same unloading");
}

#[test]
fn law_spots_that_never_touch_do_not_know_of_it() {
    // Few and far between: `merge` and `cover` are the same, event by event.
    let mut dice = Dice(7);
    let summits: Vec<Summit> = (0..9)
        .map(|k| {
            let (row, column) = (f64::from(k / 3), f64::from(k % 3));
            asperity(
                (row + 0.4 + 0.2 * dice.roll()) / 3.0 * LENGTH,
                (column + 0.4 + 0.2 * dice.roll()) / 3.0 * LENGTH,
                -4e-7 * dice.roll(),
                2e-5,
            )
        })
        .collect();
    let [merge, cover] = [MERGE, DEFAULT].map(|rules| {
        let problem = Problem::new(&summits, LENGTH, RMS, PAPER, rules).unwrap();
        run(&problem, &[2e-4], 0.02, KeptContacts::None)
    });
    let list =
        |cycle: &Cycle| cycle.events.iter().map(|e| (e.kind, e.asperity().unwrap(), e.mean_penetration_m.to_bits())).collect::<Vec<_>>();
    assert_eq!(list(&merge).len(), 18);
    // The sums over images are looked up in a table in one and computed in the other: 1e-15 of the approach.
    for (p, q) in merge.events.iter().zip(&cover.events) {
        assert_eq!((p.kind, p.site), (q.kind, q.site));
        near("approach", p.mean_penetration_m, q.mean_penetration_m, 1e-14);
    }
    close("loss", loop_of(&merge, 0).loss, loop_of(&cover, 0).loss, 1e-8);
}
