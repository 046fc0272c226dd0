//! The path against an independent solver: dense, with sixty digits, by arclength and relaxation (`tests/reference/path.py`).

use crate::reference::{Row, table};
use crate::support::{DEFAULT, PAPER, RMS, close, local_contacts, near};
use hysteron::model::{Interaction, KeptContacts};
use hysteron::physics::EventKind;
use hysteron::physics::asperities::contact::{Problem, Rules};
use hysteron::physics::asperities::{Asperities, Cycle, Settings};
use hysteron::physics::cycle::{Branch, Step};

/// The cycle of a surface of the reference, with steps of `spacing` \[m\].
fn run(surface: &str, spacing: f64) -> Cycle {
    run_with(surface, spacing, None)
}

/// The same with local problems of some contacts.
fn run_with(surface: &str, spacing: f64, local: Option<usize>) -> Cycle {
    let surfaces = table("path_surfaces");
    let rows: Vec<Row<'_>> = surfaces.rows().filter(|row| row.word("surface") == surface).collect();
    let interaction = if rows[0].word("kind") == "point" { Interaction::Point } else { Interaction::Spots };
    let summits: Vec<_> =
        rows.iter().map(|r| crate::support::asperity(r.number("x"), r.number("y"), r.number("z"), r.number("R"))).collect();
    let problem = Problem::new(&summits, rows[0].number("L"), RMS, PAPER, Rules { interaction, ..DEFAULT }).unwrap();
    let problem = if let Some(contacts) = local { problem.with_numerics(local_contacts(contacts)) } else { problem };
    let settings = Settings { max_loads: Vec::new(), approach_step: spacing / RMS, contacts: KeptContacts::None, rest_every: None };
    Asperities { problem, settings }.run_to(rows[0].number("delta_turn")).unwrap()
}

/// But one: in an avalanche of p3 two spots end together, and which is first depends on how they are damped.
const SURFACES: [&str; 13] = ["s1", "s2", "s3", "s4", "s5", "s6", "s7", "s8", "s9", "p1", "p2", "p4", "p5"];

#[test]
fn val_the_events_are_those_of_an_independent_solver() {
    let events = table("path_events");
    let mut compared = 0;
    for surface in SURFACES {
        let cycle = run(surface, 1e-7);
        for branch in [Branch::Loading, Branch::Unloading] {
            let want: Vec<Row<'_>> = events.rows().filter(|r| r.word("surface") == surface && r.word("branch") == branch.word()).collect();
            let got: Vec<_> = cycle.events.iter().filter(|e| cycle.steps[e.step].branch == branch).collect();
            let name = |kind: EventKind| kind.word();
            let sequence: Vec<_> = got.iter().map(|e| (name(e.kind), e.asperity().unwrap())).collect();
            let wanted: Vec<_> = want.iter().map(|r| (r.word("kind"), r.number("asperity") as usize)).collect();
            assert_eq!(sequence, wanted, "{surface} {}", branch.word());
            let mut avalanche = 0.0;
            let mut energies = [0.0, 0.0];
            for (got, want) in got.iter().zip(&want) {
                // A jump-in or the end of a branch is met to the tolerance of an equilibrium, 5e-16 m; a fold is passed by 1e-6 of the rms
                // height, 5e-12 m.
                near("approach", got.mean_penetration_m, want.number("delta"), 6e-12);
                // Stiffnesses are of some 100 N/m; near a fold, of a thousand.
                near("load after", got.after.load_n, want.number("load_after"), 5e-9);
                // Passing a fold by 5e-12 m costs that much times a change of load of 1e-4 N.
                if want.number("avalanche") != avalanche {
                    near("energy", energies[0], energies[1], 5e-16);
                    (avalanche, energies) = (want.number("avalanche"), [0.0, 0.0]);
                }
                energies[0] += got.energy_lost_j;
                energies[1] += want.number("energy");
                compared += 1;
            }
            near("energy", energies[0], energies[1], 5e-16);
        }
    }
    assert!(compared > 100, "{compared}");
}

#[test]
fn val_the_curves_are_those_of_an_independent_solver() {
    let curves = table("path_curves");
    let mut compared = 0;
    for surface in SURFACES {
        // Every fourth of some 25 rows, each by a grid of its own, on which it is the first point.
        for row in curves.rows().filter(|r| r.word("surface") == surface && r.number("delta") != 0.0).skip(1).step_by(4) {
            let delta = row.number("delta");
            let cycle = run(surface, delta.abs());
            let at = |s: &&Step| s.branch.word() == row.word("branch") && (s.mean_penetration_m - delta).abs() < 1e-9 * delta.abs();
            let Some(step) = cycle.steps.iter().find(at) else {
                // The turning approach itself is met from its load.
                continue;
            };
            assert_eq!(step.counts.contacts, row.number("contacts") as usize, "{surface} at {delta:e}");
            // An equilibrium is met to 5e-16 m; stiffnesses are of 100 N/m, `dA/dδ` of 1e-3 m.
            near("F", step.load_n, row.number("F"), 5e-13);
            close("A", step.area_m2, row.number("A"), 1e-9);
            compared += 1;
        }
    }
    assert!(compared > 50, "{compared}");
}

/// With local problems of three contacts, events are propagated to the rest of the contact by local solves.
#[test]
fn val_propagated_events_are_those_of_an_independent_solver() {
    let events = table("path_events");
    let (mut compared, mut far) = (0, 0);
    for surface in SURFACES {
        let cycle = run_with(surface, 1e-7, Some(3));
        for branch in [Branch::Loading, Branch::Unloading] {
            let want: Vec<Row<'_>> = events.rows().filter(|r| r.word("surface") == surface && r.word("branch") == branch.word()).collect();
            let got: Vec<_> = cycle.events.iter().filter(|e| cycle.steps[e.step].branch == branch).collect();
            assert_eq!(got.len(), want.len(), "{surface} {}", branch.word());
            for (got, want) in got.iter().zip(&want) {
                let off = (got.mean_penetration_m - want.number("delta")).abs();
                // The response of the contacts outside a local problem is of first order: a hundredth of a jump-off penetration, 1e-7 m, and five
                // hundredths for the few events next to a fold. The order within an avalanche may differ.
                assert!(off < 8e-9, "{surface} {}: off by {off:e}", branch.word());
                far += usize::from(off > 1e-9);
                compared += 1;
            }
            let sum = |energies: &mut dyn Iterator<Item = f64>| energies.sum::<f64>();
            let (got, want) = (sum(&mut got.iter().map(|e| e.energy_lost_j)), sum(&mut want.iter().map(|r| r.number("energy"))));
            close(&format!("{surface} {}: energy", branch.word()), got, want, 0.03);
        }
    }
    assert!(compared > 100 && far < compared / 10, "{far} of {compared}");
}
