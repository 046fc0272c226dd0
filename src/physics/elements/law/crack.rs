//! Table of the law of the band-limited crack.

use super::{Bond, Front, WALL_STIFFNESS};

/// Spacing of the table, in ℓ.
const TABLE_SPACING: f64 = 1.0 / NODES_PER_UNIT;
const NODES_PER_UNIT: f64 = 100.0;
/// Tension at which the table ends, in E*ℓ/dx.
const END_TENSION: f64 = 1e-7;
/// Distance behind a front from which on its tension is that of the wall, in widths of the kernel.
const DEEP: f64 = 7.0;

/// Law of the band-limited crack for one work of adhesion.
#[derive(Debug, Clone)]
pub struct Crack {
    /// Unit of the gap, ℓ/dx, and dx/ℓ.
    pub(super) unit: f64,
    inverse_unit: f64,
    /// Gap from which on the table is valid, in ℓ.
    pub(super) onset: f64,
    /// Gap of the maximum tension, in ℓ, and that tension, in E*ℓ/dx.
    peak: f64,
    strength: f64,
    /// Gap at which contact ends, and the distance of the surfaces there, in ℓ.
    pub(super) edge: f64,
    pub(super) true_edge: f64,
    /// Energy of contact at no gap over −Δγ.
    pub(super) depth: f64,
    /// Tension, its slope and the energy at the nodes `onset + k TABLE_SPACING`, dimensionless.
    nodes: Vec<[f64; 3]>,
    /// Line tension.
    pub(super) line: Option<Line>,
}

/// Line tension of a front.
#[derive(Debug, Clone)]
pub(super) struct Line {
    /// Factor λ of the energy.
    factor: f64,
    /// Step φ, its slope to the gap, and the slope of the tension of a straight front in excess of that of
    /// the law, at the nodes, dimensionless.
    nodes: Vec<[f64; 3]>,
}

/// Step φ at a point.
#[derive(Debug, Clone, Copy, Default)]
pub struct Profile {
    /// The step, from 1 inside contact to 0 outside.
    pub(crate) value: f64,
    /// Its first and second derivative to the gap \[1/dx, 1/dx²\].
    pub(crate) rate: f64,
    pub(crate) bend: f64,
    /// Slope of the tension of a straight front in excess of that of the law \[E*/dx\].
    pub(crate) excess: f64,
}

impl Profile {
    /// Inside contact.
    pub(super) const INSIDE: Self = Self { value: 1.0, rate: 0.0, bend: 0.0, excess: 0.0 };
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

impl Crack {
    /// Law for the work of adhesion `work` in E* dx.
    pub(super) fn new(work: f64, front: &Front) -> Self {
        let mut law = if front.is_hard { Self::hard(front) } else { Self::soft(front) };
        law.unit = work.sqrt();
        law.inverse_unit = 1.0 / law.unit;
        law
    }

    /// Law of contact on a spring, scaled to the work of adhesion.
    fn soft(front: &Front) -> Self {
        let mut factor = 1.0;
        let (mut law, mut start) = Self::scaled(front, factor);
        // A fixed point: the energy is nearly linear in the factor.
        for _ in 0..40 {
            let energy = -law.nodes[0][2] + 0.5 * WALL_STIFFNESS * law.onset * law.onset;
            if (energy - 1.0_f64).abs() < 1e-13 {
                break;
            }
            factor /= energy;
            (law, start) = Self::scaled(front, factor);
        }
        let depth = -(law.nodes[0][2] - 0.5 * WALL_STIFFNESS * law.onset * law.onset);
        debug_assert!((depth - 1.0).abs() < 1e-12, "work of adhesion of the law");
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
        law.depth = 0.5 * WALL_STIFFNESS * law.onset * law.onset - law.nodes[0][2];
        debug_assert!((law.depth - 1.0).abs() < 1e-4, "work of adhesion of the law");
        law.line = (factor != 0.0).then_some(Line { factor, nodes: line });
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
            unit: 0.0,
            inverse_unit: 0.0,
            onset,
            peak,
            strength: strongest.1,
            edge,
            true_edge,
            depth: 1.0,
            nodes,
            line: None,
        }
    }

    /// Gap at which the table ends, in ℓ.
    pub(super) fn end(&self) -> f64 {
        self.onset + TABLE_SPACING * (self.nodes.len() - 1) as f64
    }

    /// Maximum tension \[E*\].
    pub(super) fn strength(&self) -> f64 {
        if self.line.is_some() { self.strength * self.unit } else { self.at(self.peak * self.unit).tension }
    }

    /// Factor `2λΔγ` of the tension by the curvature of the front \[E* dx\].
    pub(super) fn line_factor(&self) -> f64 {
        self.line.as_ref().map_or(0.0, |line| 2.0 * line.factor * self.unit * self.unit)
    }

    #[inline(always)]
    pub(super) fn at(&self, gap: f64) -> Bond {
        let unit = self.unit;
        let g = gap * self.inverse_unit;
        if g < self.onset {
            return Bond {
                energy: unit * unit * (0.5 * WALL_STIFFNESS * g * g - self.depth),
                tension: WALL_STIFFNESS * gap,
                slope: WALL_STIFFNESS,
            };
        }
        let place = (g - self.onset) * NODES_PER_UNIT;
        let k = place as usize;
        if k >= self.nodes.len() - 1 {
            return Bond::default();
        }
        let t = place - k as f64;
        let ([s0, d0, v0], [s1, d1, _]) = (self.nodes[k], self.nodes[k + 1]);
        let (d0, d1) = (d0 * TABLE_SPACING, d1 * TABLE_SPACING);
        // Hermite's cubic s0 + d0 t + b t² + c t³ and its integral.
        let (b, c) = (3.0 * (s1 - s0) - 2.0 * d0 - d1, 2.0 * (s0 - s1) + d0 + d1);
        Bond {
            energy: unit
                * unit
                * (v0 + TABLE_SPACING * t * (s0 + t * (0.5 * d0 + t * (b / 3.0 + t * 0.25 * c)))),
            tension: unit * (s0 + t * (d0 + t * (b + t * c))),
            slope: (d0 + t * (2.0 * b + t * 3.0 * c)) * NODES_PER_UNIT,
        }
    }

    /// Step φ at a bonded point: Hermite's cubic and its derivatives.
    #[inline(always)]
    pub(super) fn profile(&self, gap: f64) -> Profile {
        let Some(line) = &self.line else { return Profile::default() };
        let g = gap * self.inverse_unit;
        if g < self.onset {
            return Profile::INSIDE;
        }
        let place = (g - self.onset) * NODES_PER_UNIT;
        let k = place as usize;
        if k >= line.nodes.len() - 1 {
            return Profile::default();
        }
        let t = place - k as f64;
        let ([s0, d0, e0], [s1, d1, e1]) = (line.nodes[k], line.nodes[k + 1]);
        let (d0, d1) = (d0 * TABLE_SPACING, d1 * TABLE_SPACING);
        let (b, c) = (3.0 * (s1 - s0) - 2.0 * d0 - d1, 2.0 * (s0 - s1) + d0 + d1);
        let per_gap = NODES_PER_UNIT * self.inverse_unit;
        Profile {
            value: s0 + t * (d0 + t * (b + t * c)),
            rate: (d0 + t * (2.0 * b + t * 3.0 * c)) * per_gap,
            bend: (2.0 * b + t * 6.0 * c) * per_gap * per_gap,
            excess: e0 + t * (e1 - e0),
        }
    }
}
