//! A few asperities on one half-space: the coupled equilibrium against many digits, and a lattice against its own cell.

use crate::reference::table;
use crate::support::{ALONE, LENGTH, PAPER, asperity, close, near, run, turning, unloading};
use hysteron::model::{Boundary, Interaction, KeptContacts};
use hysteron::physics::asperities::Cycle;
use hysteron::physics::asperities::contact::{Problem, Rules};
use hysteron::physics::asperities::field::ewald::remainder;
use hysteron::physics::cycle::{Branch, Contact, Step};
use hysteron::physics::jkr::Asperity;
use hysteron::physics::surface::summits::Summit;
use std::f64::consts::PI;

/// The unit of the grid of approaches: every approach of the table is a whole number of it. Its 1e-10 is the tolerance of an equilibrium.
const GRID: f64 = 1e-7;

fn rules(interaction: Interaction) -> Rules {
    Rules { interaction, ..ALONE }
}

/// A cycle of hand-made asperities over a fine unit of height, to a load at which they are all deep in contact.
fn cycle(summits: &[Summit], length: f64, rules: Rules, load: f64) -> Cycle {
    let problem = Problem::new(summits, length, GRID, PAPER, rules).unwrap();
    run(&problem, &[load / problem.load_unit_n()], 1.0, KeptContacts::All)
}

/// Spots at the unloading step of the given approach.
fn at(cycle: &Cycle, approach: f64) -> (usize, Vec<&Contact>) {
    let found = |s: &Step| s.branch == Branch::Unloading && (s.mean_penetration_m - approach).abs() < 1e-6 * GRID;
    let number = cycle.steps.iter().position(found).expect("a step at this approach");
    (number, cycle.contacts.iter().filter(|c| c.step == number).collect())
}

#[test]
fn val_coupled_equilibria_agree_with_many_digits() {
    let table = table("coupled");
    let mut compared = 0;
    for set in ["one", "two", "wrap", "three", "five"] {
        for (word, interaction) in [("spots", Interaction::Spots), ("point", Interaction::Point)] {
            let rows: Vec<_> = table.rows().filter(|r| r.word("set") == set && r.word("interaction") == word).collect();
            let members = rows.iter().map(|r| r.number("index") as usize).max().unwrap() + 1;
            let summits: Vec<Summit> =
                rows[..members].iter().map(|r| asperity(r.number("x"), r.number("y"), r.number("z"), r.number("R"))).collect();
            // On the way back all are still in contact at every approach of the table, which begin with −1e-7 m.
            let cycle = cycle(&summits, LENGTH, rules(interaction), 3e-5 * members as f64);
            for row in &rows {
                let (_, spots) = at(&cycle, row.number("delta"));
                assert_eq!(spots.len(), members, "{set} {word}: all in contact");
                let spot = spots[row.number("index") as usize];
                // The equilibrium is met to 1e-17 m; radii follow with dδ/da of 0.2 at least: 1e-16 m of 3e-6. Penetrations are of 1e-6.
                close("a", spot.contact_radius_m, row.number("a"), 1e-10);
                near("w", spot.interaction_m.unwrap(), row.number("w_hat"), 1e-16);
                // dF/da is below 100 N/m.
                near("F", spot.load_n, row.number("F"), 1e-14);
                compared += 1;
            }
        }
    }
    assert_eq!(compared, table.rows().count());
}

#[test]
fn law_a_lattice_is_its_own_cell() {
    // n × n equal asperities on the square are one asperity on a square of side L/n: with point interaction the displacement is the load times
    // one constant.
    let (n, radius) = (3, 3e-5);
    let side = LENGTH / f64::from(n);
    let summits: Vec<Summit> =
        (0..n * n).map(|k| asperity((f64::from(k / n) + 0.3) * side, (f64::from(k % n) + 0.8) * side, 0.0, radius)).collect();
    let load = 2e-5;
    let many = cycle(&summits, LENGTH, rules(Interaction::Point), load * f64::from(n * n));
    let one = cycle(&[asperity(0.3 * side, 0.8 * side, 0.0, radius)], side, rules(Interaction::Point), load);
    // The spots one by one: the displacement is that of the own images and the background, F/(πE*L') times the constant.
    let jkr = Asperity::new(radius, &PAPER).unwrap();
    for approach in [1.5e-6, 4e-7, -1e-7] {
        let ((step, spots), (single, alone)) = (at(&many, approach), at(&one, approach));
        assert_eq!((spots.len(), alone.len()), (9, 1));
        let want = alone[0];
        let own = want.load_n / (PI * PAPER.contact_modulus_pa * side) * remainder(0.0, 0.0, 2.0);
        near("self term", want.interaction_m.unwrap(), own, 1e-18);
        near("Eq 2", jkr.penetration(want.contact_radius_m), approach - own, 2e-17);
        for spot in spots {
            // The sums over nine pairs come from the series of the kernel, good to 1e-11 of F/(πE*L), 1e-19 m; equilibria are met to 1e-17 m.
            close("a", spot.contact_radius_m, want.contact_radius_m, 1e-10);
            near("w", spot.interaction_m.unwrap(), want.interaction_m.unwrap(), 1e-16);
        }
        close("load", many.steps[step].load_n, 9.0 * one.steps[single].load_n, 1e-8);
    }
}

#[test]
fn law_copies_of_a_patch_are_the_patch() {
    // The same for unequal asperities and the fields of spots: a patch of three, and four copies of it on a square of twice the side.
    let side = 0.5 * LENGTH;
    let patch = [(0.1, 0.2, 0.0, 3e-5), (0.2, 0.26, -2e-7, 2e-5), (0.7, 0.9, -1e-7, 4e-5)];
    let place = |ox: f64, oy: f64| patch.map(|(x, y, z, r)| asperity((x + ox) * side, (y + oy) * side, z, r));
    let four: Vec<Summit> = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)].iter().flat_map(|(x, y)| place(*x, *y)).collect();
    let (small, big) =
        (cycle(&place(0.0, 0.0), side, rules(Interaction::Spots), 6e-5), cycle(&four, LENGTH, rules(Interaction::Spots), 2.4e-4));
    for approach in [1.5e-6, -1e-7] {
        let ((_, spots), (_, copies)) = (at(&small, approach), at(&big, approach));
        for (k, copy) in copies.iter().enumerate() {
            // Images act as spots, but for the orders beyond a⁷: 0.03 (2a/L)⁸ of F/(πE*L), 1e-13 of 1e-8 m. Equilibria are met to 1e-17 m.
            close("a", copy.contact_radius_m, spots[k % 3].contact_radius_m, 1e-10);
        }
    }
}

#[test]
fn law_no_event_no_loss() {
    // Two turning points with all asperities in contact before the first: from one to the other and back nothing happens.
    let summits = [(0.2, 0.2, -1e-7, 5e-5), (0.235, 0.21, 0.0, 1e-5), (0.73, 0.89, -2.5e-7, 3.3e-5)]
        .map(|(x, y, z, r)| asperity(x * LENGTH, y * LENGTH, z, r));
    for interaction in [Interaction::Spots, Interaction::Point, Interaction::None] {
        let problem = Problem::new(&summits, LENGTH, GRID, PAPER, rules(interaction)).unwrap();
        let cycle = run(&problem, &[1e-5, 1e-4], 1.0, KeptContacts::None);
        let (first, second) = (cycle.turning[0].0, cycle.turning[1].0);
        assert!(cycle.steps[first..=second].iter().skip(1).all(|s| s.counts.events.sum() == 0));
        let mut compared = 0;
        let back = unloading(&cycle, 1);
        for up in &cycle.steps[first + 1..second] {
            let down = back.iter().find(|s| s.mean_penetration_m == up.mean_penetration_m).expect("one grid for both senses");
            // Equilibria are met to 1e-17 m; the stiffness is some 100 N/m, the perimeter 1e-4 m, with slopes of 0.2.
            near("load", down.load_n, up.load_n, 1e-13);
            near("area", down.area_m2, up.area_m2, 1e-19);
            // Work from here to the turning point and back: fourth-order quadrature on the same grid both ways, but for the last piece.
            let there = cycle.steps[second].work_j - up.work_j;
            near("work", down.work_j, -there, 1e-9 * there.abs());
            compared += 1;
        }
        assert!(compared > 3, "{compared}");
        assert!(turning(&cycle, 1).counts.contacts == 3);
    }
}

#[test]
fn law_two_spots_obey_newton_and_reach_far() {
    // Far apart on an isolated half-space each sees the other's load as F/(πE*r), with the next order (a/r)²/6.
    let r = 0.4 * LENGTH;
    let summits = [asperity(0.2 * LENGTH, 0.5 * LENGTH, 0.0, 3e-5), asperity(0.2 * LENGTH + r, 0.5 * LENGTH, 0.0, 2e-5)];
    let isolated = Rules { boundary: Boundary::Isolated, ..rules(Interaction::Spots) };
    let cycle = cycle(&summits, LENGTH, isolated, 6e-5);
    let (_, spots) = at(&cycle, 1.5e-6);
    for (me, other) in [(0, 1), (1, 0)] {
        let far = spots[other].load_n / (PI * PAPER.contact_modulus_pa * r);
        let a = spots[other].contact_radius_m;
        // Both terms of the load are some ten times the load itself.
        near("w", spots[me].interaction_m.unwrap(), far, 3.0 * (a / r).powi(2) * far.abs());
        let jkr = Asperity::new([3e-5, 2e-5][me], &PAPER).unwrap();
        near("balance", jkr.penetration(spots[me].contact_radius_m) + spots[me].interaction_m.unwrap(), 1.5e-6, 1e-16);
    }
    // Nearest images where it is periodic: across the edge the same distance is 0.6 L, and 0.4 L remains the nearest.
    let moved = [asperity(0.9 * LENGTH, 0.5 * LENGTH, 0.0, 3e-5), asperity(0.3 * LENGTH, 0.5 * LENGTH, 0.0, 2e-5)];
    let [here, there] = [&summits, &moved].map(|s| self::cycle(s, LENGTH, rules(Interaction::Spots), 6e-5));
    let ((_, p), (_, q)) = (at(&here, 4e-7), at(&there, 4e-7));
    for (s, t) in p.iter().zip(&q) {
        close("wrapped", t.contact_radius_m, s.contact_radius_m, 1e-10);
    }
}
