//! Exact area of the union of the contact discs.
//!
//! By Green's theorem the area is `∮ x dy` along the arcs that lie in no other disc. On the periodic square
//! `x` is in `[0, L)`. An arc is cut where it crosses `x = 0`, and the length of that line inside the union
//! is counted with the factor L.

use super::problem::Problem;
use super::state::State;
use crate::math::vector::nearest_image;
use crate::model::Boundary;
use std::f64::consts::{PI, TAU};

/// Area of the union of the discs of a state \[m²\].
#[must_use]
pub fn area(problem: &Problem, state: &State) -> f64 {
    let discs: Vec<Disc> =
        state.contacts.iter().map(|&i| Disc { centre: *problem.place(i), radius: state.radius[i] }).collect();
    let largest = discs.iter().map(|d| d.radius).fold(0.0, f64::max);
    let overlapping = |k: usize| {
        let mut list = Vec::new();
        problem.neighbours.within(state.contacts[k], discs[k].radius + largest, |r, i| {
            if r < discs[k].radius + state.radius[i]
                && let Ok(other) = state.contacts.binary_search(&i)
            {
                list.push(other);
            }
        });
        list
    };
    // The sum of the disc areas is an upper bound, also for a disc that overlaps its own periodic image. Of
    // tiny discs rounding may leave less than nothing.
    let sum: f64 = discs.iter().map(|disc| PI * disc.radius * disc.radius).sum();
    union_area(&discs, problem.length_m, problem.rules.boundary, overlapping).min(sum).max(0.0)
}

/// A disc in the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disc {
    /// Centre \[m\].
    pub centre: [f64; 2],
    /// Radius \[m\].
    pub radius: f64,
}

/// Area of the union of discs \[m²\], on the periodic square of side `length` or in the open plane.
///
/// `overlapping(k)` returns the discs that overlap disc k. A disc must not overlap its own periodic image
/// (radius below half the side); otherwise the result is the upper bound L².
#[must_use]
pub fn union_area(
    discs: &[Disc],
    length: f64,
    boundary: Boundary,
    overlapping: impl Fn(usize) -> Vec<usize>,
) -> f64 {
    let is_periodic = boundary == Boundary::Periodic;
    let mut area = 0.0;
    let mut line: Vec<(f64, f64)> = Vec::new();
    for (k, disc) in discs.iter().enumerate() {
        if is_periodic && disc.radius >= 0.5 * length {
            return length * length;
        }
        let mut hidden = Vec::new();
        let mut swallowed = false;
        for other in overlapping(k) {
            match hidden_arc(disc, &discs[other], length, boundary) {
                // Of two identical discs the first is counted.
                Arc::Whole => swallowed |= discs[other] != *disc || other < k,
                Arc::Part(from, to) => push_interval(&mut hidden, from, to, TAU),
                Arc::Nothing => {}
            }
        }
        if is_periodic {
            crossing(disc, length, &mut line);
        }
        if swallowed {
            continue;
        }
        for (from, to) in complement(&mut hidden, TAU) {
            area += arc_moment(disc, from, to, length, boundary);
        }
    }
    let crossed: f64 = if is_periodic {
        length - complement(&mut line, length).iter().map(|(from, to)| to - from).sum::<f64>()
    } else {
        0.0
    };
    area + length * crossed
}

enum Arc {
    Nothing,
    Part(f64, f64),
    Whole,
}

/// The arc of `disc` that lies inside `other`, as an interval of angles.
fn hidden_arc(disc: &Disc, other: &Disc, length: f64, boundary: Boundary) -> Arc {
    let [dx, dy] = [0, 1].map(|k| {
        let d = other.centre[k] - disc.centre[k];
        if boundary == Boundary::Periodic { nearest_image(d, length) } else { d }
    });
    let distance = dx.hypot(dy);
    if distance + disc.radius <= other.radius {
        return Arc::Whole;
    }
    if distance >= disc.radius + other.radius || distance + other.radius <= disc.radius {
        return Arc::Nothing;
    }
    let cosine = (distance * distance + disc.radius * disc.radius - other.radius * other.radius)
        / (2.0 * distance * disc.radius);
    let half = cosine.clamp(-1.0, 1.0).acos();
    let middle = dy.atan2(dx).rem_euclid(TAU);
    Arc::Part(middle - half, middle + half)
}

/// Adds the interval of the line `x = 0` inside a disc.
fn crossing(disc: &Disc, length: f64, line: &mut Vec<(f64, f64)>) {
    let [x, y] = disc.centre;
    let distance = x.min(length - x);
    if distance < disc.radius {
        let half = (disc.radius * disc.radius - distance * distance).sqrt();
        push_interval(line, y - half, y + half, length);
    }
}

/// Adds an interval of a circle of the given period, cut at 0.
fn push_interval(list: &mut Vec<(f64, f64)>, from: f64, to: f64, period: f64) {
    if from < 0.0 {
        list.push((from + period, period));
        list.push((0.0, to));
    } else if to > period {
        list.push((from, period));
        list.push((0.0, to - period));
    } else {
        list.push((from, to));
    }
}

/// Complement of a list of intervals in `[0, period]`.
fn complement(list: &mut [(f64, f64)], period: f64) -> Vec<(f64, f64)> {
    list.sort_by(|u, v| u.0.total_cmp(&v.0));
    let mut left = Vec::new();
    let mut reached = 0.0;
    for (from, to) in list.iter() {
        if *from > reached {
            left.push((reached, *from));
        }
        reached = f64::max(reached, *to);
    }
    if reached < period {
        left.push((reached, period));
    }
    left
}

/// `∫ x dy` along an arc, with x in `[0, L)`: the arc is cut where it crosses `x = 0` or `x = L`.
fn arc_moment(disc: &Disc, from: f64, to: f64, length: f64, boundary: Boundary) -> f64 {
    let radius = disc.radius;
    let piece = |x: f64, a: f64, b: f64| {
        x * radius * (b.sin() - a.sin())
            + 0.5 * radius * radius * (b - a + 0.5 * ((2.0 * b).sin() - (2.0 * a).sin()))
    };
    let x = disc.centre[0];
    if boundary == Boundary::Isolated {
        return piece(x, from, to);
    }
    // Angles at which the circle crosses the line; x is shifted by the period on one side.
    let mut cuts = vec![from, to];
    for edge in [-x, length - x] {
        if edge.abs() < radius {
            let angle = (edge / radius).acos();
            cuts.extend([angle, TAU - angle].into_iter().filter(|cut| *cut > from && *cut < to));
        }
    }
    cuts.sort_by(f64::total_cmp);
    cuts.windows(2)
        .map(|pair| {
            let middle = 0.5 * (pair[0] + pair[1]);
            let shift = ((x + radius * middle.cos()) / length).floor() * length;
            piece(x - shift, pair[0], pair[1])
        })
        .sum()
}

/// Sum of the areas of discs \[m²\], overlaps counted twice.
#[must_use]
pub fn plain_area(discs: &[Disc]) -> f64 {
    discs.iter().map(|disc| PI * disc.radius * disc.radius).sum()
}
