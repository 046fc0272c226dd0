//! Straight front of the band-limited crack, and the corrections of its law.
//!
//! # Corrections
//! The law of a straight front is exact. Its errors at other fronts and in contact are of first order in the
//! grid spacing. Each number of [`Front`] removes one of them:
//!
//! - *Hard contact.* The spring of contact gives way by `σ dx/k`. The operator `K' = (K⁻¹ − dx/k)⁻¹` and the
//!   gap `g' = g + σ dx/k` in the law have the compliance of the wall in the operator. Then `σ = k g'/dx`
//!   inside contact follows from the front itself, and `∫σ dg' = ∫σ dg = Δγ`.
//! - *Edge.* A point is in contact below the gap of the place `x = 0`, not below that of the maximum tension.
//! - *Line tension.* At a front of the curvature κ, positive for a convex contact, the law acts as one of the
//!   work of adhesion `Δγ (1 + c₁ κ dx)`, with `c₁ = s (1 − b − b²/4)/√π`. A line tension `c₁ Δγ dx` of the
//!   front lowers it by `c₁ Δγ κ dx`.
//! - *Flat kernel.* `Ŵ(q) = exp(−s²q²/2)(1 + b s²q²)` with `b = ½` has no term of second order in q.
//! - *Pre-emphasis.* The tension of a front has the spectrum `Ŵ`, so that a wave of the surface acts on it
//!   with `Ŵ(q)` of its height. Heights are divided by `Ŵ`.
//!
//! # Line tension
//! The energy is `λ Δγ Σ φ Lφ`, with a function `φ(g')` that falls from 1 inside contact to 0 outside, and
//! the negative Laplacian `L` of 9 points, `(20, −4, −1)/6`, which is isotropic up to the fourth order. At a
//! straight front `φ` is a smooth step of the place x, with its middle at the place c. The tension of a point
//! is `V'(g') + 2λ Δγ φ'(g') Lφ`. `V'` is the tension of the straight front less the second term there, so
//! that a straight front is in equilibrium as before. `∫V' dg' = Δγ`, since `∫φ_x Lφ dx = 0` by symmetry.
//!
//! The line tension is `λ Δγ (∫φ Lφ dx + 2∫(x − c) φ_x Lφ dx)`: the energy of `φ`, and that of the change of
//! `V`, which is at the front as well. Both are about `λ Δγ ∫φ_x² dx`, for every c. Inside contact `g'`
//! changes little with x, so that `φ'(g')` is large and the energy stiff. With the middle ahead of the front
//! an equilibrium takes fewer iterations. A straight front on the wall has the step on its open side alone.

use super::{KERNEL_WIDTH, WALL_STIFFNESS};
use std::f64::consts::PI;

/// Corrections of the law of the band-limited crack.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Front {
    /// Width s of the kernel \[dx\].
    pub width: f64,
    /// Coefficient b of the kernel: 0 for a Gaussian, ½ for one that is flat at small wavenumbers.
    pub flatness: f64,
    /// True for hard contact: the compliance of the wall is a part of the operator.
    pub is_hard: bool,
    /// True if contact ends at the place of the front, else at the maximum tension.
    pub ends_at_front: bool,
    /// Line tension over `c₁ Δγ dx`.
    pub line: f64,
    /// Half width of the step φ \[dx\].
    pub line_reach: f64,
    /// Place of the middle of the step φ, ahead of the front \[dx\]. On the wall, without hard contact, the
    /// step begins outside the wall.
    pub line_place: f64,
    /// True if heights are divided by the spectrum of the kernel.
    pub is_emphasised: bool,
}

impl Front {
    /// No correction.
    pub const PLAIN: Self = Self {
        width: KERNEL_WIDTH,
        flatness: 0.0,
        is_hard: false,
        ends_at_front: false,
        line: 0.0,
        line_reach: 1.2,
        line_place: 0.3,
        is_emphasised: false,
    };

    /// All corrections but the flat kernel.
    pub const CORRECTED: Self =
        Self { is_hard: true, ends_at_front: true, line: 1.0, is_emphasised: true, ..Self::PLAIN };

    /// Compliance of the wall that is taken out of the operator \[dx/E*\].
    #[must_use]
    pub fn wall_compliance(&self) -> f64 {
        if self.is_hard { 1.0 / WALL_STIFFNESS } else { 0.0 }
    }

    /// Spectrum `Ŵ` of the kernel at a wavenumber \[1/dx\].
    #[must_use]
    pub fn spectrum(&self, q: f64) -> f64 {
        let square = (self.width * q).powi(2);
        (-0.5 * square).exp() * (1.0 + self.flatness * square)
    }

    /// First-order coefficient `c₁` of the work of adhesion at a curved front: `∫₀^∞ x (W∗W)(x) dx` for a
    /// circular contact.
    #[must_use]
    pub fn curvature_coefficient(&self) -> f64 {
        let b = self.flatness;
        self.width * (1.0 - b - 0.25 * b * b) / PI.sqrt()
    }

    /// Factor λ of the energy of the line.
    pub(super) fn line_factor(&self) -> f64 {
        // ∫φ Lφ dx = ∫(φ(x + 1) − φ(x))² dx, and 2 ∫(x − c) φ_x Lφ dx of the law, by the trapezoid rule,
        // whose integrands vanish at both ends.
        let (count, end) = (4000, self.line_reach + 1.0);
        let step = 2.0 * end / f64::from(count);
        let energy = |k: i32| {
            let off = f64::from(k) * step - end;
            let x = self.line_place + off;
            let [here, slope, _] = self.step(x);
            (self.step(x + 1.0)[0] - here).powi(2) + 2.0 * off * slope * self.bend(x)[0]
        };
        self.line * self.curvature_coefficient() / (step * (0..count).map(energy).sum::<f64>())
    }

    /// Step φ at the place x, with its first and second derivative: the integral of `(1 − (x/reach)²)³`.
    pub(super) fn step(&self, x: f64) -> [f64; 3] {
        let t = (x - self.line_place) / self.line_reach;
        if t.abs() >= 1.0 {
            return [if t < 0.0 { 1.0 } else { 0.0 }, 0.0, 0.0];
        }
        let (square, unit) = (t * t, 35.0 / 32.0);
        let bell = 1.0 - square;
        let integral = t * (1.0 - square * (1.0 - square * (0.6 - square / 7.0)));
        [
            0.5 - unit * integral,
            -unit * bell.powi(3) / self.line_reach,
            6.0 * unit * t * bell.powi(2) / self.line_reach.powi(2),
        ]
    }

    /// `Lφ` of a straight front at the place x, and its derivative.
    pub(super) fn bend(&self, x: f64) -> [f64; 2] {
        let [before, here, after] = [-1.0, 0.0, 1.0].map(|off| self.step(x + off));
        [0, 1].map(|k| 2.0 * here[k] - before[k] - after[k])
    }

    /// Convolutions of the kernel `W` with the fields of the front at the distance `x`: of `√y`, of `1/√y`,
    /// and the first and second derivative of the latter to `x`. With `y = t²` they are `∫₀^∞ 2t² W dt`,
    /// `∫₀^∞ 2 W dt`, `∫₀^∞ 2 W' dt` and `∫₀^∞ 2 W'' dt`, where `W = W(x − t²)`.
    pub(super) fn edge(&self, x: f64) -> [f64; 4] {
        // The integrand is even and entire in t, so that the trapezoid rule converges exponentially.
        let (width, b) = (self.width, self.flatness);
        let end = (x.max(0.0) + 9.0 * width).sqrt();
        let count = 400;
        let step = end / f64::from(count);
        let mut sum = [0.0; 4];
        for k in 0..=count {
            let t = f64::from(k) * step;
            let off = (x - t * t) / width;
            let weight = if k == 0 || k == count { 1.0 } else { 2.0 } * step * (-0.5 * off * off).exp()
                / (width * (2.0 * PI).sqrt());
            // W = G (1 + b − b v²) with the Gaussian G of v = x/s; W' and W'' accordingly.
            let square = b * off * off;
            let (value, first) = (weight * (1.0 + b - square), weight * (1.0 + 3.0 * b - square));
            sum[0] += value * t * t;
            sum[1] += value;
            sum[2] -= first * off / width;
            sum[3] += (first * (off * off - 1.0) + weight * 2.0 * square) / (width * width);
        }
        sum
    }

    /// Gap of the law at the distance `x` from the front and its derivative, in ℓ.
    pub(super) fn gap(&self, x: f64) -> [f64; 2] {
        let root = PI.sqrt();
        let ahead = self.edge(x);
        let [mut gap, mut slope] = [4.0 / root * ahead[0], 2.0 / root * ahead[1]];
        if self.is_hard {
            let behind = self.edge(-x);
            gap += behind[1] / root / WALL_STIFFNESS;
            slope -= behind[2] / root / WALL_STIFFNESS;
        }
        [gap, slope]
    }

    /// Gap of the law, tension and the slope `dσ/dg` at the distance `x` (grid spacings) from the front, in ℓ
    /// and E*ℓ/dx.
    pub(super) fn straight(&self, x: f64) -> [f64; 3] {
        let behind = self.edge(-x);
        let [gap, gap_slope] = self.gap(x);
        [gap, behind[1] / PI.sqrt(), -behind[2] / PI.sqrt() / gap_slope]
    }

    /// Second derivative of the gap of the law to `x`, in ℓ.
    pub(super) fn gap_curvature(&self, x: f64) -> f64 {
        let [ahead, behind] = [x, -x].map(|x| self.edge(x));
        let wall = if self.is_hard { behind[3] / WALL_STIFFNESS } else { 0.0 };
        (2.0 * ahead[2] + wall) / PI.sqrt()
    }
}
