//! A patch with nothing around it: `boundary = "isolated"`.

use crate::support::{ALONE, DEFAULT, LENGTH, PAPER, RMS, asperity, close, loop_of, near, paper_cycle, paper_summits, run, turning};
use hysteron::model::{Boundary, Coalescence, Interaction, KeptContacts};
use hysteron::physics::asperities::Cycle;
use hysteron::physics::asperities::contact::{Problem, Rules};
use hysteron::physics::cycle::{Branch, Contact, Step};
use hysteron::physics::jkr::Asperity;
use hysteron::physics::surface::summits::Summit;
use std::f64::consts::PI;

/// The unit of the grid of approaches; 1e-10 of it is the tolerance of an equilibrium.
const GRID: f64 = 1e-7;

fn isolated(interaction: Interaction) -> Rules {
    Rules { boundary: Boundary::Isolated, interaction, ..ALONE }
}

fn cycle(summits: &[Summit], length: f64, rules: Rules, load: f64) -> Cycle {
    let problem = Problem::new(summits, length, GRID, PAPER, rules).unwrap();
    run(&problem, &[load / problem.load_unit_n()], 1.0, KeptContacts::All)
}

/// Spots at the unloading step of the given approach.
fn at(cycle: &Cycle, approach: f64) -> Vec<&Contact> {
    let found = |s: &Step| s.branch == Branch::Unloading && (s.mean_penetration_m - approach).abs() < 1e-6 * GRID;
    let number = cycle.steps.iter().position(found).expect("a step at this approach");
    cycle.contacts.iter().filter(|c| c.step == number).collect()
}

/// Three unequal asperities in the middle of the square, at distances of several of their radii.
fn patch() -> [Summit; 3] {
    [(0.50, 0.48, 0.0, 3e-5), (0.54, 0.50, -2e-7, 2e-5), (0.47, 0.53, -1e-7, 4e-5)]
        .map(|(x, y, z, r)| asperity(x * LENGTH, y * LENGTH, z, r))
}

#[test]
fn law_a_lone_asperity_has_no_images() {
    for interaction in [Interaction::Spots, Interaction::Point] {
        // At the edge of the square, where an image would be near.
        let cycle = cycle(&[asperity(0.001 * LENGTH, 0.999 * LENGTH, 0.0, 3e-5)], LENGTH, isolated(interaction), 2e-5);
        let jkr = Asperity::new(3e-5, &PAPER).unwrap();
        for approach in [1e-6, 1e-7, -1e-7] {
            let spots = at(&cycle, approach);
            assert_eq!(spots[0].interaction_m, Some(0.0));
            // The equilibrium is met to 1e-17 m, of a penetration of 1e-7 m.
            close("a", spots[0].contact_radius_m, jkr.radius_at_penetration(approach).unwrap(), 1e-9);
        }
    }
}

#[test]
fn law_the_field_is_the_plain_one_over_r() {
    let summits = patch();
    let cycle = cycle(&summits, LENGTH, isolated(Interaction::Point), 4e-5);
    for approach in [1e-6, -1e-7] {
        let spots = at(&cycle, approach);
        assert_eq!(spots.len(), 3);
        for (me, spot) in spots.iter().enumerate() {
            let from = |other: &Contact| {
                let (p, q) = (&summits[me], &summits[other.asperity.unwrap()]);
                other.load_n / (PI * PAPER.contact_modulus_pa * (p.x_m - q.x_m).hypot(p.y_m - q.y_m))
            };
            let want: f64 = spots.iter().filter(|s| s.asperity != Some(me)).map(|s| from(s)).sum();
            // A sum of two, with the loads of the same state; places are rounded to 2⁻⁴⁰ of the side, 1e-15 m of some 1e-5.
            close("w", spot.interaction_m.unwrap(), want, 2e-10);
        }
    }
}

#[test]
fn lim_in_a_great_square_the_images_are_far() {
    let summits = patch();
    let share = 1e3;
    let alone = cycle(&summits, LENGTH, isolated(Interaction::Spots), 4e-5);
    let great = cycle(&summits, share * LENGTH, Rules { boundary: Boundary::Periodic, ..isolated(Interaction::Spots) }, 4e-5);
    for approach in [1e-6, -1e-7] {
        let (mine, theirs) = (at(&alone, approach), at(&great, approach));
        let load: f64 = mine.iter().map(|s| s.load_n.abs()).sum();
        for (p, q) in mine.iter().zip(&theirs) {
            // Images and background: −3.9/(πE*L') for each load, the same at all to (r/L')².
            let images = 3.900265 / (PI * PAPER.contact_modulus_pa * share * LENGTH) * load;
            near("w", q.interaction_m.unwrap(), p.interaction_m.unwrap(), 1.2 * images);
            assert!((q.interaction_m.unwrap() - p.interaction_m.unwrap()).abs() > 1e-3 * images, "images there are");
        }
    }
}

#[test]
fn law_a_shift_changes_nothing() {
    let rules = Rules { coalescence: Coalescence::Cover, ..isolated(Interaction::Spots) };
    let summits: Vec<Summit> = patch().into_iter().chain([asperity(0.505 * LENGTH, 0.482 * LENGTH, -4e-7, 1e-5)]).collect();
    let moved = |dx: f64, dy: f64| -> Vec<Summit> {
        summits.iter().map(|s| Summit { x_m: s.x_m + dx * LENGTH, y_m: s.y_m + dy * LENGTH, ..*s }).collect()
    };
    let here = cycle(&summits, LENGTH, rules, 8e-5);
    assert!(here.steps.iter().any(|s| s.counts.covered == 1), "one is covered on the way");
    // Across one edge, into a corner, and out of the square altogether.
    for (dx, dy) in [(-0.48, 0.1), (0.45, 0.46), (0.3, -0.49), (-7.3, 12.6)] {
        let there = cycle(&moved(dx, dy), LENGTH, rules, 8e-5);
        assert_eq!(there.steps.len(), here.steps.len());
        for (s, t) in here.steps.iter().zip(&there.steps) {
            assert_eq!((s.counts.contacts, s.counts.covered, s.counts.events), (t.counts.contacts, t.counts.covered, t.counts.events));
            // Differences of coordinates are rounded at 1e-16 of 1e-2 m: 1e-13 of distances of 1e-5 m; an equilibrium is met to 1e-17 m, of
            // which a turning point makes 1e-9 of its load.
            near("load", t.load_n, s.load_n, 1e-8 * 8e-5);
            close("area", t.area_m2, s.area_m2, 1e-8);
            close("union", t.area_union_m2, s.area_union_m2, 1e-8);
        }
    }
}

#[test]
fn law_opposite_edges_do_not_see_each_other() {
    // A hundredth of the side apart across the edge, and nearly a whole side through the square.
    let summits = [asperity(0.005 * LENGTH, 0.5 * LENGTH, 0.0, 1e-4), asperity(0.995 * LENGTH, 0.5 * LENGTH, -3e-7, 2e-5)];
    let rules = Rules { coalescence: Coalescence::Cover, ..isolated(Interaction::Spots) };
    let load = 2e-4;
    let apart = cycle(&summits, LENGTH, rules, load);
    let wrapped = cycle(&summits, LENGTH, Rules { boundary: Boundary::Periodic, ..rules }, load);
    let (top, meets) = (turning(&apart, 0), turning(&wrapped, 0));
    assert_eq!((top.counts.contacts, top.counts.covered, top.counts.touching), (2, 0, 0));
    assert_eq!((meets.counts.contacts, meets.counts.covered), (1, 1));
    // No overlap: a sum of two discs both ways.
    close("union", top.area_union_m2, top.area_m2, 1e-12);
    let spots: Vec<&Contact> = apart.contacts.iter().filter(|c| c.step == apart.turning[0].0).collect();
    let r = 0.99 * LENGTH;
    for (me, other) in [(0, 1), (1, 0)] {
        let far = spots[other].load_n / (PI * PAPER.contact_modulus_pa * r);
        // The next order of the field is (a/r)²/6 of its terms, which are some ten times the load.
        near("w", spots[me].interaction_m.unwrap(), far, 3.0 * (spots[other].contact_radius_m / r).powi(2) * far.abs());
    }
}

#[test]
fn law_point_interaction_loses_what_its_events_lose_without_images_too() {
    let summits = paper_summits(16, 0);
    let rules = Rules { interaction: Interaction::Point, boundary: Boundary::Isolated, ..DEFAULT };
    let cycle = paper_cycle(&summits, rules, &[0.0071], 0.04);
    let sums = loop_of(&cycle, 0);
    // As with images: quadrature of the load between events, and the places of the events.
    close("audit", sums.loss, sums.events, 1e-4);
    assert!(cycle.steps.iter().all(|step| step.numerics.residual_m.unwrap() <= 1e-8 * RMS));
}

#[test]
fn e2e_the_surface_as_a_patch() {
    let summits = paper_summits(16, 0);
    let [patch, square] =
        [Boundary::Isolated, Boundary::Periodic].map(|boundary| paper_cycle(&summits, Rules { boundary, ..DEFAULT }, &[0.0071], 0.04));
    assert!(patch.steps.iter().all(|step| step.numerics.residual_m.unwrap() <= 1e-8 * RMS));
    // One load sinks the patch as a whole: by F/(πE*) ⟨1/r⟩, with ⟨1/r⟩ = 2.97/L over a square, 4 ln(1 + √2) − 4(√2 − 1)/3; the periodic square does
    // not sink. The rest, a load that is not spread evenly and the shape of the sunken patch, is some tenths of that.
    let load = turning(&patch, 0).load_n;
    let mean = load / (PI * PAPER.contact_modulus_pa * LENGTH) * (4.0 * (1.0 + 2f64.sqrt()).ln() - 4.0 / 3.0 * (2f64.sqrt() - 1.0));
    let sunk = turning(&patch, 0).mean_penetration_m - turning(&square, 0).mean_penetration_m;
    near("sinking", sunk, mean, 0.4 * mean);
}
