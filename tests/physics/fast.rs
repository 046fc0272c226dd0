//! The fast sum against the direct sum: the same field, the same tangent.

use crate::support::{DEFAULT, Dice, LENGTH, PAPER, RMS, close, loop_of, near, paper_summits, run};
use hysteron::model::{Boundary, Interaction as Kind, KeptContacts, Slips};
use hysteron::physics::asperities::Cycle;
use hysteron::physics::asperities::contact::{Problem, Rules};
use hysteron::physics::asperities::field::spot_field::Spot;
use hysteron::physics::asperities::field::{DirectSum, FastSum, Interaction, Spots, Tangent, choose};
use hysteron::physics::cycle::Effort;
use hysteron::physics::jkr::Asperity;

/// Asperities at random, of which the first are in contact with spots of very different radii, overlapping; `huge` \[m\] is the radius of one.
fn contact(seed: u64, asperities: usize, contacts: usize, huge: f64) -> (Vec<[f64; 2]>, Spots) {
    let mut dice = Dice(seed);
    let positions: Vec<[f64; 2]> = (0..asperities).map(|_| [LENGTH * dice.roll(), LENGTH * dice.roll()]).collect();
    let spots = on_spots(&positions[..contacts], seed, contacts, huge);
    (positions, spots)
}

/// Spots at the positions; the same radii again after every `period`.
fn on_spots(positions: &[[f64; 2]], seed: u64, period: usize, huge: f64) -> Spots {
    let spacing = LENGTH / (period as f64).sqrt();
    let mut dice = Dice(seed + 1000);
    let shapes: Vec<(f64, f64)> = (0..period)
        .map(|i| (if i == period / 2 { huge } else { spacing * (0.05 + 0.5 * dice.roll().powi(2)) }, 1.0 + 5.0 * dice.roll()))
        .collect();
    let mut spots = Spots { index: (0..positions.len()).collect(), ..Spots::default() };
    spots.columns.set(positions.iter().enumerate().map(|(i, [x, y])| {
        let (a, flatness) = shapes[i % period];
        let jkr = Asperity::new(a * flatness, &PAPER).unwrap();
        Spot { x: *x, y: *y, a, radius: jkr.radius_m(), load: jkr.load(a), load_slope: jkr.load_slope(a) }
    }));
    spots
}

fn greatest(values: &[f64]) -> f64 {
    values.iter().map(|v| v.abs()).fold(0.0, f64::max)
}

/// Greatest difference over greatest value.
fn error(got: &[f64], want: &[f64]) -> f64 {
    assert_eq!(got.len(), want.len());
    let off: Vec<f64> = got.iter().zip(want).map(|(g, w)| g - w).collect();
    assert!(off.iter().all(|v| v.is_finite()));
    greatest(&off) / greatest(want)
}

fn displacements(field: &dyn Interaction, spots: &Spots, targets: &[usize]) -> Vec<f64> {
    let mut found = Vec::new();
    field.displacements(spots, targets, &mut found, &mut Effort::default());
    found
}

fn linearised(field: &dyn Interaction, spots: &Spots) -> (Vec<f64>, Tangent) {
    let (mut found, mut tangent) = (Vec::new(), Tangent::default());
    field.linearise(spots, &mut found, &mut tangent, &mut Effort::default());
    (found, tangent)
}

/// Derivatives are made to fewer digits than displacements: they lead Newton's method, whose end is told by the displacements. Measured: 2e-4
/// where one spot is a hundred times as large as others, 2e-5 elsewhere.
const ROUGH: f64 = 1e-3;

#[test]
fn law_the_fast_sum_is_the_direct_sum() {
    // From a handful of spots, which lie within all reaches, to many; a huge spot that no mesh takes, and one that a coarse mesh takes.
    for (seed, contacts, huge) in [(1, 1, 2e-5), (2, 2, 9e-5), (3, 40, 5e-5), (4, 500, 5e-5), (5, 1500, 1.5e-5)] {
        let (positions, spots) = contact(seed, contacts + 200, contacts, huge);
        // Spots, asperities that are none, and some of these inside a spot.
        let targets: Vec<usize> = (0..contacts + 200).collect();
        let (spotted, pointed) = (Kind::Spots, Kind::Point);
        let (all, one) = (Boundary::Periodic, Boundary::Isolated);
        for (kind, boundary) in [(spotted, all), (pointed, all), (spotted, one), (pointed, one)] {
            let direct = DirectSum::new(positions.clone(), LENGTH, &PAPER, kind, boundary, Slips::default());
            let fast = FastSum::new(positions.clone(), LENGTH, &PAPER, kind, boundary, Slips::default(), 1e-9);
            let want = displacements(&direct, &spots, &targets);
            let most = greatest(&want);
            let off = error(&displacements(&fast, &spots, &targets), &want);
            assert!(off < 1e-9, "{kind:?}, {boundary:?} of {contacts}: {off:e}");
            // At the spots alone, with the tangent.
            let ((want, exact), (got, tangent)) = (linearised(&direct, &spots), linearised(&fast, &spots));
            for (got, want) in got.iter().zip(&want) {
                near("at a spot", *got, *want, 1e-9 * most);
            }
            if contacts == 1 && boundary == one {
                // Nothing acts on it.
                assert_eq!(want, [0.0]);
                continue;
            }
            let mut dice = Dice(seed + 100);
            for signs in [0.0, 0.5] {
                let x: Vec<f64> = (0..contacts).map(|_| dice.roll() - signs).collect();
                let (mut want, mut got) = (vec![0.0; contacts], vec![0.0; contacts]);
                exact.product(&x, &mut want);
                tangent.product(&x, &mut got);
                let off = error(&got, &want);
                assert!(off < ROUGH, "{kind:?}, {boundary:?} of {contacts}, tangent: {off:e}");
            }
            for i in 0..contacts {
                near("own", tangent.own(i), exact.own(i), 1e-12 * exact.own(i).abs());
            }
        }
    }
}

#[test]
fn law_some_targets_are_some_of_all() {
    let (positions, spots) = contact(6, 700, 300, 5e-5);
    let fast = FastSum::new(positions, LENGTH, &PAPER, Kind::Spots, Boundary::Periodic, Slips::default(), 1e-9);
    let all = displacements(&fast, &spots, &(0..700).collect::<Vec<_>>());
    let some = [3, 650, 299, 300, 0];
    // The reach is chosen by the number of targets: within the tolerance, not to the last digit.
    let off = error(&displacements(&fast, &spots, &some), &some.map(|k| all[k]));
    assert!(off < 2e-9, "{off:e}");
    // The same question has the same answer, to the last digit.
    assert_eq!(displacements(&fast, &spots, &some), displacements(&fast, &spots, &some));
    assert!(displacements(&fast, &Spots::default(), &some).iter().all(|w| *w == 0.0));
}

#[test]
fn law_the_slope_along_a_path_is_a_difference() {
    let (positions, spots) = contact(7, 500, 300, 4e-5);
    let mut dice = Dice(70);
    let rates: Vec<f64> = (0..300).map(|_| dice.roll()).collect();
    let targets: Vec<usize> = (200..500).collect();
    let direct = DirectSum::new(positions.clone(), LENGTH, &PAPER, Kind::Spots, Boundary::Periodic, Slips::default());
    let fast = FastSum::new(positions, LENGTH, &PAPER, Kind::Spots, Boundary::Periodic, Slips::default(), 1e-9);
    let (mut want, mut want_slopes, mut got, mut slopes) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    direct.along_path(&spots, &rates, &targets, [&mut want, &mut want_slopes], &mut Tangent::default(), &mut Effort::default());
    fast.along_path(&spots, &rates, &targets, [&mut got, &mut slopes], &mut Tangent::default(), &mut Effort::default());
    assert_eq!(want, displacements(&direct, &spots, &targets));
    assert!(error(&got, &want) < 1e-9);
    assert!(error(&slopes, &want_slopes) < ROUGH);
    // At the spots it is the product of the tangent; the huge load of one spot changes by its rate alone.
    let (_, tangent) = linearised(&direct, &spots);
    let mut product = vec![0.0; 300];
    tangent.product(&rates, &mut product);
    assert!(error(&want_slopes[..100], &product[200..]) < 1e-13);
}

#[test]
fn law_places_that_are_taken_over_are_as_if_found_anew() {
    let mut dice = Dice(12);
    let positions: Vec<[f64; 2]> = (0..900).map(|_| [LENGTH * dice.roll(), LENGTH * dice.roll()]).collect();
    let shapes: Vec<[f64; 2]> = (0..700).map(|_| [4e-5 * (0.05 + 0.5 * dice.roll().powi(2)), 1.0 + 5.0 * dice.roll()]).collect();
    // Some of the spots, of other radii than at first.
    let some = |wanted: &dyn Fn(usize) -> bool, scale: &dyn Fn(usize) -> f64| {
        let mut spots = Spots { index: (0..700).filter(|i| wanted(*i)).collect(), ..Spots::default() };
        let of = |i: &usize| {
            let ([a, flatness], [x, y]) = (shapes[*i], positions[*i]);
            let (jkr, a) = (Asperity::new(a * flatness, &PAPER).unwrap(), scale(*i) * a);
            Spot { x, y, a, radius: jkr.radius_m(), load: jkr.load(a), load_slope: jkr.load_slope(a) }
        };
        spots.columns.set(spots.index.iter().map(of).collect::<Vec<_>>().into_iter());
        spots
    };
    let way = [
        some(&|i| i < 600, &|_| 1.0),
        // A little larger; one that has gone and one that has come.
        some(&|i| i <= 600 && i != 17, &|_| 1.02),
        // Some come, some go, some are too large for what was found, some much smaller.
        some(&|i| i % 19 != 3 && i < 640, &|i| [1.0, 1.3, 0.4, 1.04][i % 4]),
        // The same again, and then so many others that all is found anew.
        some(&|i| i % 19 != 3 && i < 640, &|i| [1.0, 1.3, 0.4, 1.04][i % 4]),
        some(&|i| i % 3 != 0, &|_| 1.0),
    ];
    for kind in [Kind::Spots, Kind::Point] {
        let direct = DirectSum::new(positions.clone(), LENGTH, &PAPER, kind, Boundary::Periodic, Slips::default());
        let fast = FastSum::new(positions.clone(), LENGTH, &PAPER, kind, Boundary::Periodic, Slips::default(), 1e-9);
        let (mut tangent, mut kept) = (Tangent::default(), Tangent::default());
        for (step, spots) in way.iter().enumerate() {
            let n = spots.index.len();
            let mut got = Vec::new();
            fast.linearise(spots, &mut got, &mut tangent, &mut Effort::default());
            let (want, exact) = linearised(&direct, spots);
            let off = error(&got, &want);
            assert!(off < 1e-9, "{kind:?}, step {step}: {off:e}");
            let mut dice = Dice(step as u64);
            let x: Vec<f64> = (0..n).map(|_| dice.roll() - 0.5).collect();
            let (mut want, mut got) = (vec![0.0; n], vec![0.0; n]);
            exact.product(&x, &mut want);
            tangent.product(&x, &mut got);
            let off = error(&got, &want);
            assert!(off < ROUGH, "{kind:?}, step {step}, tangent: {off:e}");
            // At other places, which change too.
            let targets: Vec<usize> = (0..900).filter(|i| i % 11 != step && !spots.index.contains(i)).collect();
            let (mut want, mut want_slopes, mut got, mut slopes) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
            direct.along_path(spots, &x, &targets, [&mut want, &mut want_slopes], &mut Tangent::default(), &mut Effort::default());
            fast.along_path(spots, &x, &targets, [&mut got, &mut slopes], &mut kept, &mut Effort::default());
            let off = [error(&got, &want), error(&slopes, &want_slopes)];
            assert!(off[0] < 1e-9 && off[1] < ROUGH, "{kind:?}, step {step}, other places: {off:?}");
        }
    }
}

#[test]
fn law_the_torus_has_no_origin_for_the_fast_sum() {
    let (positions, spots) = contact(8, 400, 300, 5e-5);
    let targets: Vec<usize> = (0..400).collect();
    let want = displacements(
        &FastSum::new(positions.clone(), LENGTH, &PAPER, Kind::Spots, Boundary::Periodic, Slips::default(), 1e-9),
        &spots,
        &targets,
    );
    for shift in [[0.123e-3, 0.77e-3], [-2.3e-3, 0.5e-3]] {
        let moved: Vec<[f64; 2]> = positions.iter().map(|[x, y]| [x + shift[0], y + shift[1]]).collect();
        let spots_moved = on_spots(&moved[..300], 8, 300, 5e-5);
        let field = FastSum::new(moved, LENGTH, &PAPER, Kind::Spots, Boundary::Periodic, Slips::default(), 1e-9);
        let off = error(&displacements(&field, &spots_moved, &targets), &want);
        assert!(off < 1e-9, "{off:e}");
    }
}

#[test]
fn law_the_tolerance_is_kept_and_used() {
    let (positions, spots) = contact(9, 1200, 1000, 3e-5);
    let targets: Vec<usize> = (0..1200).collect();
    let direct = DirectSum::new(positions.clone(), LENGTH, &PAPER, Kind::Spots, Boundary::Periodic, Slips::default());
    let want = displacements(&direct, &spots, &targets);
    let mut last = f64::INFINITY;
    for tolerance in [1e-5, 1e-7, 1e-9, 1e-11] {
        let fast = FastSum::new(positions.clone(), LENGTH, &PAPER, Kind::Spots, Boundary::Periodic, Slips::default(), tolerance);
        let off = error(&displacements(&fast, &spots, &targets), &want);
        assert!(off < tolerance, "{tolerance:e}: {off:e}");
        // A looser one is looser: nothing is paid for that was not asked for.
        assert!(off < 0.2 * last && off > 1e-4 * tolerance, "{tolerance:e}: {off:e} after {last:e}");
        last = off;
    }
}

#[test]
fn lim_copies_of_a_cell_are_the_cell() {
    // The same spots nine times on a square three times as wide: images act as spots, so it is the same field.
    let (positions, spots) = contact(10, 60, 60, 4e-5);
    let field =
        |n: usize| DirectSum::new(copies(&positions, n), LENGTH * n as f64, &PAPER, Kind::Spots, Boundary::Periodic, Slips::default());
    let targets: Vec<usize> = (0..60).collect();
    let want = displacements(&field(1), &spots, &targets);
    let many = on_spots(&copies(&positions, 3), 10, 60, 4e-5);
    // Of the images of a spot of a/L = 0.07 the orders beyond the last are left out: 0.03 (2a/L)⁸ of F/(πE*L) at most.
    let off = error(&displacements(&field(3), &many, &targets), &want);
    assert!(off < 1e-9, "{off:e}");
    let fast = FastSum::new(copies(&positions, 3), 3.0 * LENGTH, &PAPER, Kind::Spots, Boundary::Periodic, Slips::default(), 1e-10);
    let off = error(&displacements(&fast, &many, &targets), &want);
    assert!(off < 1e-9, "{off:e}");
}

fn copies(positions: &[[f64; 2]], n: usize) -> Vec<[f64; 2]> {
    let cells = (0..n * n).map(|k| [(k / n) as f64 * LENGTH, (k % n) as f64 * LENGTH]);
    cells.flat_map(|[u, v]| positions.iter().map(move |[x, y]| [x + u, y + v])).collect()
}

#[test]
fn reg_the_chosen_sum_is_the_same_field_for_few_and_many() {
    let (positions, spots) = contact(11, 900, 800, 3e-5);
    let targets: Vec<usize> = (0..900).collect();
    for (kind, boundary) in [(Kind::Spots, Boundary::Periodic), (Kind::Point, Boundary::Isolated), (Kind::None, Boundary::Periodic)] {
        let field = choose(positions.clone(), LENGTH, &PAPER, kind, boundary, Slips::default()).with_table();
        let direct = DirectSum::new(positions.clone(), LENGTH, &PAPER, kind, boundary, Slips::default());
        for spots in [&spots, &contact(11, 900, 20, 3e-5).1] {
            let want = displacements(&direct, spots, &targets);
            let got = displacements(&field, spots, &targets);
            if kind == Kind::None {
                assert!(got.iter().chain(&want).all(|w| *w == 0.0));
            } else {
                // The tolerance of fast sums.
                assert!(error(&got, &want) < 1e-8, "{:e}", error(&got, &want));
            }
            // A tangent is filled anew whatever it held before.
            let mut tangent = linearised(&direct, spots).1;
            let n = spots.index.len();
            let mut found = Vec::new();
            field.linearise(spots, &mut found, &mut tangent, &mut Effort::default());
            let (mut got, mut want) = (vec![0.0; n], vec![0.0; n]);
            let ones = vec![1.0; n];
            tangent.product(&ones, &mut got);
            linearised(&direct, spots).1.product(&ones, &mut want);
            assert!(kind == Kind::None && got == want || error(&got, &want) < ROUGH);
        }
    }
}

#[test]
fn law_the_number_of_threads_changes_no_digit() {
    // So many that several threads take part.
    let (positions, spots) = contact(12, 6000, 5000, 1e-5);
    let fast = FastSum::new(positions, LENGTH, &PAPER, Kind::Spots, Boundary::Periodic, Slips::default(), 1e-9);
    let x = vec![1.0; 5000];
    let found = [1, 4].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let (displacements, tangent) = linearised(&fast, &spots);
            let mut product = vec![0.0; 5000];
            tangent.product(&x, &mut product);
            (displacements, product)
        })
    });
    assert_eq!(found[0], found[1]);
}

#[test]
fn law_whole_cycles_are_the_same_with_fast_sums() {
    let summits = paper_summits(64, 0);
    for (interaction, boundary) in [(Kind::Point, Boundary::Isolated), (Kind::Spots, Boundary::Periodic), (Kind::Spots, Boundary::Isolated)]
    {
        let cycle = |from: usize| {
            let rules = Rules { interaction, boundary, ..DEFAULT };
            let problem = Problem::new(&summits, LENGTH, RMS, PAPER, rules).unwrap().with_fast_sums_from(from);
            run(&problem, &[0.001], 0.02, KeptContacts::None)
        };
        let (direct, fast) = (cycle(usize::MAX), cycle(20));
        let transforms = |cycle: &Cycle| cycle.steps.iter().map(|step| step.numerics.effort.transforms).sum::<u64>();
        assert!(transforms(&direct) == 0 && transforms(&fast) > 1000);
        // Within an avalanche two that are overdue by nearly as much may change places.
        let events = |cycle: &Cycle| {
            let mut all: Vec<_> = cycle.events.iter().map(|event| (event.asperity().unwrap(), event.kind)).collect();
            all.sort_unstable();
            all
        };
        assert!(events(&direct).len() > 300 && events(&direct) == events(&fast), "{interaction:?}, {boundary:?}");
        let (want, got) = (loop_of(&direct, 0), loop_of(&fast, 0));
        close("area", got.area, want.area, 1e-9);
        // Sums differ in their eighth digit, rates in their fourth; no event hangs on either.
        close("pull-off", got.pull_off, want.pull_off, 5e-6);
        close("loss", got.loss, want.loss, 5e-6);
    }
}
