//! Tables of the law of the band-limited crack, and of the step of its line tension. They do not depend on
//! the material.

use super::{Front, WALL_STIFFNESS};
use std::sync::{Arc, LazyLock};

/// Spacing of a table, in ℓ.
pub(super) const TABLE_SPACING: f64 = 1.0 / NODES_PER_UNIT;
pub(super) const NODES_PER_UNIT: f64 = 100.0;
/// Nodes of a table: those of the law, about 400, and zeros. A power of two.
const NODES: usize = 1024;
/// Tension at which the law ends, in E*ℓ/dx.
const END_TENSION: f64 = 1e-7;
/// Distance behind a front from which on its tension is that of the wall, in widths of the kernel.
const DEEP: f64 = 7.0;

static PLAIN: LazyLock<Arc<Table>> = LazyLock::new(|| Arc::new(Table::new(&Front::PLAIN)));
static CORRECTED: LazyLock<Arc<Table>> = LazyLock::new(|| Arc::new(Table::new(&Front::CORRECTED)));

/// Three functions at the nodes `onset + k TABLE_SPACING`, dimensionless; 0 from the end of the law on.
#[derive(Debug, Clone)]
pub(super) struct Nodes(Box<[[f64; 3]; NODES]>);

/// Hermite's cubic `s + d t + b t² + c t³` between two nodes.
pub(super) struct Cubic {
    pub(super) s: f64,
    pub(super) d: f64,
    pub(super) b: f64,
    pub(super) c: f64,
    /// Place between the nodes, from 0 to 1.
    pub(super) t: f64,
    /// Third function at both nodes.
    pub(super) third: [f64; 2],
}

/// Law of one [`Front`].
#[derive(Debug)]
pub(super) struct Table {
    /// Gap from which on the table is valid, in ℓ.
    pub(super) onset: f64,
    /// Gap of the maximum tension, in ℓ, and that tension, in E*ℓ/dx.
    pub(super) peak: f64,
    pub(super) strength: f64,
    /// Gap at which contact ends, and the distance of the surfaces there, in ℓ.
    pub(super) edge: f64,
    pub(super) true_edge: f64,
    /// Gap at which the law ends, in ℓ.
    pub(super) end: f64,
    /// Energy of contact at no gap over −Δγ.
    pub(super) depth: f64,
    /// Tension, its slope and the energy.
    pub(super) nodes: Nodes,
    /// Line tension.
    pub(super) line: Option<Line>,
}

/// Line tension of a front.
#[derive(Debug)]
pub(super) struct Line {
    /// Factor λ of the energy.
    pub(super) factor: f64,
    /// First and last gap at which the step φ changes, in ℓ.
    pub(super) steep: [f64; 2],
    /// Step φ, its slope to the gap, and the slope of the tension of a straight front in excess of that of
    /// the law.
    pub(super) nodes: Nodes,
}

impl Line {
    fn new(factor: f64, onset: f64, nodes: &[[f64; 3]]) -> Self {
        let inside = nodes.iter().take_while(|node| **node == [1.0, 0.0, 0.0]).count();
        let outside = nodes.iter().rev().take_while(|node| **node == [0.0; 3]).count();
        let steep =
            [inside.saturating_sub(1), nodes.len() - outside].map(|k| onset + TABLE_SPACING * k as f64);
        Self { factor, steep, nodes: Nodes::new(nodes) }
    }
}

impl Nodes {
    fn new(values: &[[f64; 3]]) -> Self {
        let mut nodes = Box::new([[0.0; 3]; NODES]);
        nodes[..values.len()].copy_from_slice(values);
        Self(nodes)
    }

    /// The cubic at a distance from the first node, in ℓ. Without branches, so that the compiler can evaluate
    /// it at many points at once.
    #[inline(always)]
    pub(super) fn cubic(&self, from_onset: f64) -> Cubic {
        const LAST: f64 = (NODES - 2) as f64;
        let place = from_onset * NODES_PER_UNIT;
        let place = if place < LAST { place } else { LAST };
        let place = if place > 0.0 { place } else { 0.0 };
        let k = place as i32;
        let t = place - f64::from(k);
        // A mask instead of a check of the bounds, which hold.
        let at = |k: i32| self.0[k as usize & (NODES - 1)];
        let ([s0, d0, v0], [s1, d1, v1]) = (at(k), at(k + 1));
        let (d0, d1) = (d0 * TABLE_SPACING, d1 * TABLE_SPACING);
        let (b, c) = (3.0 * (s1 - s0) - 2.0 * d0 - d1, 2.0 * (s0 - s1) + d0 + d1);
        Cubic { s: s0, d: d0, b, c, t, third: [v0, v1] }
    }
}

impl Cubic {
    #[inline(always)]
    pub(super) fn value(&self) -> f64 {
        self.s + self.t * (self.d + self.t * (self.b + self.t * self.c))
    }

    /// Derivative to t.
    #[inline(always)]
    pub(super) fn slope(&self) -> f64 {
        self.d + self.t * (2.0 * self.b + self.t * 3.0 * self.c)
    }

    /// Second derivative to t.
    #[inline(always)]
    pub(super) fn bend(&self) -> f64 {
        2.0 * self.b + self.t * 6.0 * self.c
    }

    /// Mean from 0 to t.
    #[inline(always)]
    pub(super) fn mean(&self) -> f64 {
        self.s + self.t * (0.5 * self.d + self.t * (self.b / 3.0 + self.t * 0.25 * self.c))
    }
}

/// Tension, its slope, and [`Line::nodes`] at the place x of a straight front of `scale` times the tension.
fn node(front: &Front, scale: f64, line_factor: f64, x: f64) -> ([f64; 2], [f64; 3]) {
    let [_, tension, slope] = front.straight(x);
    let ([phi, phi_x, phi_xx], [bend, bend_x]) = (front.step(x), front.bend(x));
    let ([_, gap_x], gap_xx) = (front.gap(x), front.gap_curvature(x));
    let rate = phi_x / gap_x;
    let rate_x = (phi_xx - rate * gap_xx) / gap_x;
    let excess = 2.0 * line_factor * (rate_x * bend + rate * bend_x) / gap_x;
    ([scale * tension - 2.0 * line_factor * rate * bend, scale * slope - excess], [phi, rate, excess])
}

impl Table {
    /// Law of a front; those of the two laws of the program are computed once.
    pub(super) fn of(front: &Front) -> Arc<Self> {
        if *front == Front::PLAIN {
            Arc::clone(&PLAIN)
        } else if *front == Front::CORRECTED {
            Arc::clone(&CORRECTED)
        } else {
            Arc::new(Self::new(front))
        }
    }

    fn new(front: &Front) -> Self {
        if front.is_hard { Self::hard(front) } else { Self::soft(front) }
    }

    /// Law of contact on a spring, scaled to the work of adhesion.
    fn soft(front: &Front) -> Self {
        let mut factor = 1.0;
        let (mut law, mut start) = Self::scaled(front, factor);
        // A fixed point: the energy is nearly linear in the factor.
        for _ in 0..40 {
            let energy = law.energy_of_contact();
            if (energy - 1.0_f64).abs() < 1e-13 {
                break;
            }
            factor /= energy;
            (law, start) = Self::scaled(front, factor);
        }
        debug_assert!((law.energy_of_contact() - 1.0).abs() < 1e-12, "work of adhesion of the law");
        if front.line == 0.0 { law } else { Self::with_line(front, start, factor) }
    }

    /// Table with the tension of the front times `factor`, and the place at which it begins.
    fn scaled(front: &Front, factor: f64) -> (Self, f64) {
        // The spring ends where the tension of the front falls below it.
        let excess = |x: f64| {
            let [gap, tension, _] = front.straight(x);
            factor * tension - WALL_STIFFNESS * gap
        };
        let (mut low, mut high) = (-4.0 * front.width, 4.0 * front.width);
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            if excess(middle) > 0.0 { low = middle } else { high = middle }
        }
        let start = 0.5 * (low + high);
        let law = Self::from(front, start, |x| {
            let [_, tension, slope] = front.straight(x);
            [factor * tension, factor * slope]
        });
        (law, start)
    }

    /// Law of hard contact: the front itself, from a place on at which its tension is that of the wall.
    fn hard(front: &Front) -> Self {
        Self::with_line(front, -(DEEP * front.width).max(front.line_reach + 1.0), 1.0)
    }

    /// Table from the place `start` of a front on, of `scale` times its tension, with its line tension.
    fn with_line(front: &Front, start: f64, scale: f64) -> Self {
        let factor = if front.line == 0.0 { 0.0 } else { front.line_factor() };
        let mut line = Vec::new();
        let mut law = Self::from(front, start, |x| {
            let (law, step) = node(front, scale, factor, x);
            line.push(step);
            law
        });
        law.depth = law.energy_of_contact();
        debug_assert!((law.depth - 1.0).abs() < 1e-4, "work of adhesion of the law");
        law.line = (factor != 0.0).then(|| Line::new(factor, law.onset, &line));
        law
    }

    /// Table from the place `start` of the front on, of the tension and its slope at a place.
    fn from(front: &Front, start: f64, mut law: impl FnMut(f64) -> [f64; 2]) -> Self {
        let onset = front.gap(start)[0];
        let (mut nodes, mut strongest) = (Vec::new(), (0, 0.0));
        let mut x = start;
        loop {
            let gap = onset + TABLE_SPACING * nodes.len() as f64;
            // Newton for the place with this gap.
            for _ in 0..50 {
                let [found, slope] = front.gap(x);
                let off = found - gap;
                x -= off / slope;
                if off.abs() < 1e-14 * gap {
                    break;
                }
            }
            let [tension, slope] = law(x);
            let straight = if front.line == 0.0 { tension } else { front.straight(x)[1] };
            if straight >= strongest.1 {
                strongest = (nodes.len(), straight);
            }
            nodes.push([tension, slope, 0.0]);
            if tension.abs() < END_TENSION && x > 4.0 * front.width {
                break;
            }
        }
        if let Some(last) = nodes.last_mut() {
            *last = [0.0; 3];
        }
        for k in (0..nodes.len() - 1).rev() {
            let ([s0, d0, _], [s1, d1, v1]) = (nodes[k], nodes[k + 1]);
            nodes[k][2] = v1 - TABLE_SPACING * (0.5 * (s0 + s1) + TABLE_SPACING * (d0 - d1) / 12.0);
        }
        let peak = onset + TABLE_SPACING * strongest.0 as f64;
        let [at_front, tension, _] = front.straight(0.0);
        let edge = if front.ends_at_front { at_front } else { peak };
        let at_edge = if front.ends_at_front { tension } else { strongest.1 };
        let true_edge = edge - at_edge * front.wall_compliance();
        Self {
            onset,
            peak,
            strength: strongest.1,
            edge,
            true_edge,
            end: onset + TABLE_SPACING * (nodes.len() - 1) as f64,
            depth: 1.0,
            nodes: Nodes::new(&nodes),
            line: None,
        }
    }

    /// Energy of contact at no gap over −Δγ, as the table and the spring before it have it.
    fn energy_of_contact(&self) -> f64 {
        0.5 * WALL_STIFFNESS * self.onset * self.onset - self.nodes.0[0][2]
    }
}
