//! The area of the union of the discs.

use crate::support::{Dice, close, near, random};
use hysteron::model::Boundary::{self, Isolated, Periodic};
use hysteron::physics::asperities::contact::union_area::{Disc, plain_area, union_area};
use proptest::prelude::*;
use proptest::sample::select;
use std::f64::consts::PI;

const SIDE: f64 = 1e-3;

/// Nearest-image difference of coordinates.
fn difference(p: f64, q: f64, boundary: Boundary) -> f64 {
    let d = p - q;
    if boundary == Periodic { d - SIDE * (d / SIDE).round() } else { d }
}

/// The union's area, with the overlaps found one by one.
fn area(discs: &[Disc], boundary: Boundary) -> f64 {
    union_area(discs, SIDE, boundary, |k| {
        (0..discs.len())
            .filter(|j| {
                let [dx, dy] = [0, 1].map(|c| difference(discs[*j].centre[c], discs[k].centre[c], boundary));
                *j != k && dx.hypot(dy) < discs[k].radius + discs[*j].radius
            })
            .collect()
    })
}

fn disc(x: f64, y: f64, radius: f64) -> Disc {
    Disc { centre: [x * SIDE, y * SIDE], radius: radius * SIDE }
}

/// Area that two discs have in common, at centre distance d.
fn lens(r: f64, s: f64, d: f64) -> f64 {
    let p = (d * d + r * r - s * s) / (2.0 * d);
    let q = d - p;
    r * r * (p / r).acos() - p * (r * r - p * p).sqrt() + s * s * (q / s).acos() - q * (s * s - q * q).sqrt()
}

/// Every disc moved by the same amount, wrapped into the square.
fn moved(discs: &[Disc], dx: f64, dy: f64) -> Vec<Disc> {
    discs
        .iter()
        .map(|d| Disc { centre: [(d.centre[0] + dx * SIDE).rem_euclid(SIDE), (d.centre[1] + dy * SIDE).rem_euclid(SIDE)], ..*d })
        .collect()
}

#[test]
fn val_two_discs() {
    for (r, s, d) in [(0.1, 0.1, 0.12), (0.2, 0.05, 0.19), (0.2, 0.05, 0.16), (0.2, 0.1, 0.35), (0.07, 0.2, 0.131)] {
        let pair = [disc(0.5, 0.5, r), disc(0.5 + 0.6 * d, 0.5 + 0.8 * d, s)];
        let common = if d < r + s { lens(r * SIDE, s * SIDE, d * SIDE) } else { 0.0 };
        let want = plain_area(&pair) - common;
        close("plane", area(&pair, Isolated), want, 1e-12);
        close("torus", area(&pair, Periodic), want, 1e-12);
        close("plain sum", plain_area(&pair), PI * (r * r + s * s) * SIDE * SIDE, 1e-14);
    }
}

#[test]
fn lim_apart_inside_and_twice() {
    close("apart", area(&[disc(0.2, 0.2, 0.1), disc(0.7, 0.7, 0.2)], Periodic), PI * 0.05 * SIDE * SIDE, 1e-12);
    close("inside", area(&[disc(0.5, 0.5, 0.2), disc(0.55, 0.5, 0.1)], Periodic), PI * 0.04 * SIDE * SIDE, 1e-12);
    close("twice", area(&[disc(0.5, 0.5, 0.2), disc(0.5, 0.5, 0.2)], Periodic), PI * 0.04 * SIDE * SIDE, 1e-12);
    assert_eq!(area(&[], Periodic).to_bits(), 0);
}

proptest! {
    #![proptest_config(random(40))]

    #[test]
    fn law_the_torus_has_no_origin(
        // Over either side, over a corner, onto the line itself, and anywhere.
        (dx, dy) in prop_oneof![select(vec![(0.5, 0.0), (0.0, 0.5), (0.5, 0.5), (0.55, 0.47), (0.45, 0.5)]), (0.0..1.0, 0.0..1.0)],
    ) {
        let discs = [disc(0.45, 0.5, 0.11), disc(0.55, 0.53, 0.08), disc(0.48, 0.62, 0.09)];
        close("shifted", area(&moved(&discs, dx, dy), Periodic), area(&discs, Isolated), 1e-11);
    }
}

#[test]
fn law_random_discs_against_counted_pixels() {
    for (seed, count, least, span) in [(5, 12, 0.02, 0.15), (6, 60, 0.02, 0.08), (7, 25, 0.05, 0.25)] {
        let mut dice = Dice(seed);
        let discs: Vec<Disc> = (0..count).map(|_| disc(dice.roll(), dice.roll(), least + span * dice.roll())).collect();
        // One random point in each cell of an n × n grid: only the cells that an edge crosses are uncertain, ½ at most each, and there
        // are fewer than 4·(2πr)·n/SIDE of them to a disc.
        let n = 500;
        let cell = 1.0 / f64::from(n);
        let mut hits = 0u32;
        for i in 0..n {
            for j in 0..n {
                let p = [(f64::from(i) + dice.roll()) * cell * SIDE, (f64::from(j) + dice.roll()) * cell * SIDE];
                let inside = |d: &Disc| {
                    let [dx, dy] = [0, 1].map(|c| difference(p[c], d.centre[c], Periodic));
                    dx.hypot(dy) < d.radius
                };
                hits += u32::from(discs.iter().any(inside));
            }
        }
        let crossed: f64 = discs.iter().map(|d| 8.0 * PI * d.radius / SIDE * f64::from(n)).sum();
        let error = 0.5 * crossed.sqrt() * cell * cell;
        let found = f64::from(hits) * cell * cell;
        near("share", area(&discs, Periodic) / (SIDE * SIDE), found, 4.0 * error);
        // Every disc within the plain sum, and an order does not matter.
        let mut reversed = discs.clone();
        reversed.reverse();
        close("order", area(&reversed, Periodic), area(&discs, Periodic), 1e-11);
        assert!(area(&discs, Periodic) < plain_area(&discs));
    }
}

#[test]
fn lim_full_coverage_is_the_square() {
    for n in [3, 5, 8] {
        // A square lattice covers the plane from a radius of 1/√2 of its spacing on; 2 % more leaves no doubt.
        let radius = 1.02 * 0.5f64.sqrt() / f64::from(n);
        for offset in [0.0, 0.013, 0.5] {
            let discs: Vec<Disc> = (0..n * n)
                .map(|k| {
                    disc(((f64::from(k / n) + offset) / f64::from(n)).fract(), ((f64::from(k % n) + offset) / f64::from(n)).fract(), radius)
                })
                .collect();
            close("covered", area(&discs, Periodic), SIDE * SIDE, 1e-12);
            // One disc less opens the square again, by a hole that is bounded by its neighbours.
            let open = area(&discs[1..], Periodic);
            assert!(open < SIDE * SIDE * (1.0 - 1e-6), "{n} {offset}: {open:e}");
        }
    }
    close("one that meets itself", area(&[disc(0.3, 0.4, 0.5)], Periodic), SIDE * SIDE, 0.0);
}
