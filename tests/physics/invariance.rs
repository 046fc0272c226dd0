//! What a result must not depend on: the numbering of the asperities, where the square begins, the direction that was taken before.

use crate::support::{DEFAULT, LENGTH, PAPER, RMS, close, loop_of, paper_cycle, paper_summits};
use hysteron::model::{Coalescence, KeptContacts};
use hysteron::physics::asperities::contact::{Problem, Rules};
use hysteron::physics::asperities::{Asperities, Cycle, Settings};
use hysteron::physics::cycle::{Event, Site};
use hysteron::physics::surface::summits::Summit;

/// The same loop and the same events. Asperities are numbered from the highest down and placed from the highest on, so that not even rounding differs: there
/// is no tolerance.
fn same(got: &Cycle, want: &Cycle, number: impl Fn(usize) -> usize) {
    assert_eq!(got.steps, want.steps);
    assert_eq!(got.events.len(), want.events.len());
    for (p, q) in got.events.iter().zip(&want.events) {
        assert_eq!(*p, Event { site: Site::Asperity(number(q.asperity().unwrap())), ..*q });
    }
}

#[test]
fn law_numbering_and_origin_do_not_matter() {
    let summits = paper_summits(16, 0);
    for rules in [DEFAULT, Rules { coalescence: Coalescence::Merge, ..DEFAULT }] {
        let want = paper_cycle(&summits, rules, &[0.0071], 0.04);
        let sums = loop_of(&want, 0);
        assert!(sums.loss > 0.0 && want.events.len() > 80);
        let moved = |s: &Summit| Summit { x_m: (s.x_m + 0.37 * LENGTH) % LENGTH, y_m: (s.y_m + 0.61 * LENGTH) % LENGTH, ..*s };
        let moved: Vec<Summit> = summits.iter().map(moved).collect();
        same(&paper_cycle(&moved, rules, &[0.0071], 0.04), &want, |i| i);
        let backwards: Vec<Summit> = summits.iter().rev().copied().collect();
        let last = summits.len() - 1;
        // Merged spots have numbers after those of the summits.
        same(&paper_cycle(&backwards, rules, &[0.0071], 0.04), &want, |i| if i <= last { last - i } else { i });
    }
}

#[test]
fn law_a_way_without_an_event_is_retraced() {
    // Between the first jump-in and the second lies a way on which nothing happens; there and back on it costs nothing.
    let summits = paper_summits(16, 0);
    let problem = Problem::new(&summits, LENGTH, RMS, PAPER, DEFAULT).unwrap();
    let settings = Settings { max_loads: Vec::new(), approach_step: 0.01, contacts: KeptContacts::None, rest_every: None };
    let method = Asperities { problem, settings };
    let far = method.run_to(0.3 * RMS).unwrap();
    let loading: Vec<f64> = far.events.iter().take_while(|e| e.step <= far.turning[0].0).map(|event| event.mean_penetration_m).collect();
    let gap = loading.windows(2).max_by(|u, v| (u[1] - u[0]).total_cmp(&(v[1] - v[0]))).unwrap();
    // Down from the turning point to a little after the event before it: the loads of both ways at the points of the grid between.
    let turn = 0.25f64.mul_add(gap[0], 0.75 * gap[1]);
    let cycle = method.run_to(turn).unwrap();
    let at = cycle.turning[0].0;
    let quiet = |approach: f64| approach > gap[0] + 1e-3 * RMS && approach < turn;
    let first = cycle.events.iter().find(|e| e.step > at).map_or(f64::NEG_INFINITY, |event| event.mean_penetration_m);
    let mut compared = 0;
    for back in cycle.steps[at + 1..].iter().filter(|step| quiet(step.mean_penetration_m) && step.mean_penetration_m > first) {
        let there = cycle.steps[..at].iter().find(|step| (step.mean_penetration_m - back.mean_penetration_m).abs() < 1e-9 * RMS).unwrap();
        // Equilibria are met to 1e-10 of the rms height, some 1e-9 of a penetration.
        close("load", back.load_n, there.load_n, 1e-8);
        close("area", back.area_m2, there.area_m2, 1e-8);
        // What was done on the way there is given back.
        let given = cycle.steps[at].work_j - there.work_j;
        close("work", -back.work_j, given, 1e-6);
        compared += 1;
    }
    assert!(compared > 3, "{compared}");
}
