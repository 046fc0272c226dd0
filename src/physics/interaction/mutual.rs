//! Reciprocal fields: one mutual energy for each pair of spots, and so a potential.
//!
//! A spot of contact radius `a` and load `F` is the superposition of a Hertz contact of load `F_H = 4E*a³/(3R)` and a flat punch of load `−T`,
//! `T = F_H − F`. At the distance r it displaces the half-space by `s(r) = H(r; a, R) − T p(r, a)`, where `p = asin(a/r)/(πE*a)` is the field of a punch
//! over its load (`1/(2E*a)` inside it) and `∂H/∂a = (dF_H/da) p`: Eqs 6–8 of the paper, where `T = sqrt(8πE*Δγa³)`. It is felt by another spot as a whole, by
//! its load and not at its centre alone, so that field times load is not the same from both sides. Here it is made the same: a pair has the mutual energy
//! `M_ij = ½(F_i s_j(r) + F_j s_i(r))`, and the complementary energy is `C = Σ C_i(F_i, a_i) + Σ M_ij`. From it
//! - `D_i = ∂C/∂F_i = d_i + ŵ_i` with `d_i = a_i²/R_i − T_i/(2E*a_i)` and `ŵ_i = ½Σ_j[s_j(r_ij) + F_j p(r_ij, a_i)]`: the mean of the others' fields at the
//!   spot's centre, and of what their loads do to it as to a punch;
//! - `−∂C/∂a_i = 2πΔγa_i`, the balance of Griffith: `T_i²/(4E*a_i²) + ½T_i S_i = 2πΔγa_i` with `S_i = Σ_j F_j ∂p(r_ij, a_i)/∂a_i`, that is
//!   `T_i = −B_i + sqrt(B_i² + 8πE*Δγa_i³)`, `B_i = E*a_i² S_i`: a load nearby presses on the edge and loosens it, a tension tightens it.
//!
//! The potential at an equilibrium is `Π = Σ[U(d_i, a_i) − Δγπa_i²] + ½Σ_ij F_i F_j p(r_ij, a_i)`, and `dΠ/dδ = ΣF`. In sums over j the images count, a spot's
//! own ones too. A free asperity is a spot with `a → 0`, for which `p = 1/(πE*r)`.
//!
//! Given the radii, the second equations give the loads: every spot's share `T/sqrt(8πE*Δγa³)`, its grip, follows from the radii, and these are
//! the unknowns as with the other fields. With `K = ∂²C/∂F∂a`, `N = ∂²C/∂F²` and the diagonal `q = ∂²C/∂a² + 2πΔγ`, the loads change by
//! `dF = −K⁻ᵀ q da`, and the displacements by `dD = K da + N dF`.

use super::ewald::ORDERS;
use super::moments::{HERTZ, PUNCH};
use crate::physics::dense::Lu;
use crate::physics::krylov::dot;
use std::f64::consts::{FRAC_1_PI, PI};
use std::sync::OnceLock;

/// Rounds in which loads and grips find one another at most; each leaves some per cent of what is missing.
const ROUNDS: usize = 200;

/// Relative change of the adhesive loads at which they have; and above which they have not.
const FOUND: f64 = 1e-15;
const LOST: f64 = 1e-12;

/// The same of a change of the loads.
const ANSWERED: f64 = 1e-14;

/// Terms of the series of `asin`, and `a/r` up to which they are enough: `0.3^32` is 2e-17.
const TERMS: usize = 16;
const NEAR: f64 = 0.3;

/// Coefficients of `asin x = Σ c_k x^(2k+1)`.
const ARC: [f64; TERMS] = {
    let mut all = [1.0; TERMS];
    // (2k)!/(4^k k!²) by k.
    let mut share = 1.0;
    let mut k = 1;
    while k < TERMS {
        share *= (2 * k - 1) as f64 / (2 * k) as f64;
        all[k] = share / (2 * k + 1) as f64;
        k += 1;
    }
    all
};

/// `πE*p(r, a)` \[1/m\] with its two derivatives to `a`, and `πR H(r; a, R)` \[m²\], at distance `r > 0` \[m\] of a contact radius `a > 0` \[m\]. `sag` is the
/// coefficient of `r²/R` inside a spot.
fn fields(r: f64, a: f64, sag: f64) -> [f64; 4] {
    if r <= a {
        let whole = 0.5 * PI / a;
        return [whole, -whole / a, 2.0 * whole / (a * a), PI * (a * a - sag * r * r)];
    }
    let x = a / r;
    if x < NEAR {
        let square = x * x;
        let mut sums = [0.0_f64; 4];
        for (k, c) in ARC.iter().enumerate().rev() {
            let order = (2 * k) as f64;
            let parts = [*c, order * c, order * (order - 1.0) * c, 4.0 * c / (order + 3.0)];
            for (sum, part) in sums.iter_mut().zip(parts) {
                *sum = sum.mul_add(square, part);
            }
        }
        return [sums[0] / r, sums[1] / (r * a), sums[2] / (r * a * a), sums[3] * a * a * x];
    }
    // At the very edge the slope is infinite; a finite one, as great as rounding tells apart, keeps what is made of it finite.
    let chord = ((r - a) * (r + a)).sqrt().max(1e-7 * a);
    let (arc, u) = (x.asin(), a / chord);
    let [first, second, third] = [arc / a, (u - arc) / (a * a), (u * u * u - 2.0 * u + 2.0 * arc) / (a * a * a)];
    [first, second, third, a * chord + (2.0 * a * a - r * r) * arc]
}

/// The material, and how far images are.
#[derive(Debug, Clone, Copy)]
pub(super) struct Measure {
    /// E* \[Pa\].
    pub(super) modulus: f64,
    /// `sqrt(2πΔγ/E*)` \[m^½\].
    pub(super) pull: f64,
    /// The coefficient of `r²/R` inside a spot.
    pub(super) sag: f64,
    /// Side of the square \[m\].
    pub(super) length: f64,
}

/// A spot by its radius and its sphere \[m\].
#[derive(Debug, Clone, Copy)]
pub(super) struct Sphere {
    pub(super) a: f64,
    pub(super) radius: f64,
}

impl Measure {
    /// `p` with its two derivatives, and H, of a spot at the distance r (not of itself, where `r = 0`) and of its images, which `sums` tells.
    pub(super) fn of(&self, spot: Sphere, r: f64, sums: Option<&[f64; ORDERS]>) -> [f64; 4] {
        let Sphere { a, radius } = spot;
        let mut all = if r > 0.0 { fields(r, a, self.sag) } else { [0.0; 4] };
        if let Some(sums) = sums {
            let (x, mut power) = (a / self.length, 1.0 / self.length);
            for (m, sum) in sums.iter().enumerate() {
                let order = (2 * m) as f64;
                let punch = PUNCH[m] * power * sum;
                all[0] += punch;
                all[1] += order * punch / a;
                all[2] += order * (order - 1.0) * punch / (a * a);
                all[3] += HERTZ[m] * power * a * a * a * sum;
                power *= x * x;
            }
        }
        let compliance = FRAC_1_PI / self.modulus;
        [compliance * all[0], compliance * all[1], compliance * all[2], FRAC_1_PI * all[3] / radius]
    }
}

/// Spots whose loads have found one another. Matrices go by rows of i, the spot whose radius enters.
#[derive(Debug, Clone)]
pub struct Mutual {
    count: usize,
    /// `p(r_ij, a_i)` \[m/N\] and its derivative to `a_i` \[1/N\].
    punch: Vec<f64>,
    bend: Vec<f64>,
    /// What all Hertz contacts displace at each \[m\].
    hertz: Vec<f64>,
    spheres: Vec<Sphere>,
    modulus: f64,
    /// Loads F and their adhesive parts T \[N\], and T alone \[N\].
    load: Vec<f64>,
    stick: Vec<f64>,
    alone: Vec<f64>,
    /// `S_i` \[-\], and the diagonal q \[N/m\].
    strain: Vec<f64>,
    firmness: Vec<f64>,
    /// Diagonals of K and N, and the derivatives of the penetrations at a constant grip, which is no part of the tangent.
    own: Vec<[f64; 3]>,
    /// K, factored.
    factors: OnceLock<Lu>,
}

impl Mutual {
    /// Of these spots: `pair` gives the distance between two and what images of one do at the other. `outer` tells what spots that are not among them add to
    /// each strain, `S_i/a_i` \[1/m\].
    pub(super) fn new(
        spheres: Vec<Sphere>,
        outer: &[f64],
        measure: Measure,
        pair: impl Fn(usize, usize) -> (f64, Option<[f64; ORDERS]>),
    ) -> Self {
        let n = spheres.len();
        let (mut punch, mut bend, mut turn, mut hertz) = (vec![0.0; n * n], vec![0.0; n * n], vec![0.0; n * n], vec![0.0; n]);
        for i in 0..n {
            for j in 0..=i {
                let (r, sums) = pair(i, j);
                for (from, to) in [(i, j), (j, i)] {
                    let [p, slope, curvature, displaced] = measure.of(spheres[from], r, sums.as_ref());
                    punch[from * n + to] = p;
                    bend[from * n + to] = slope;
                    turn[from * n + to] = curvature;
                    hertz[to] += displaced;
                    if i == j {
                        break;
                    }
                }
            }
        }
        let modulus = measure.modulus;
        let full = |s: &Sphere| 4.0 / 3.0 * modulus * s.a.powi(3) / s.radius;
        let alone: Vec<f64> = spheres.iter().map(|s| 2.0 * modulus * measure.pull * s.a * s.a.sqrt()).collect();
        let load = spheres.iter().zip(&alone).map(|(s, t)| full(s) - t).collect();
        let mut mutual = Self {
            count: n,
            punch,
            bend,
            hertz,
            modulus,
            load,
            stick: alone.clone(),
            alone,
            strain: vec![0.0; n],
            firmness: Vec::with_capacity(n),
            own: Vec::with_capacity(n),
            spheres,
            factors: OnceLock::new(),
        };
        mutual.find_loads(outer);
        for (i, sphere) in mutual.spheres.iter().enumerate() {
            let (a, t, strain) = (sphere.a, mutual.stick[i], mutual.strain[i]);
            let outer = outer.get(i).copied().unwrap_or(0.0);
            let line = i * n..(i + 1) * n;
            let further = dot(&mutual.load, &turn[line]) + outer;
            let steep = 4.0 * modulus * a * a / sphere.radius;
            let around = modulus * measure.pull * measure.pull;
            let twice = 2.0 * modulus * a * a;
            mutual.firmness.push(around + (t / a - steep) * t / twice - 0.5 * (steep * strain + t * further));
            let own = t / twice + 0.5 * strain - 0.5 * t * mutual.bend[i * n + i];
            mutual.own.push([own, 0.5 / (modulus * a) + mutual.punch[i * n + i], 2.0 * a / sphere.radius - 0.5 * t / twice]);
        }
        mutual
    }

    /// The loads that balance at the edges.
    fn find_loads(&mut self, outer: &[f64]) {
        let n = self.count;
        for _ in 0..ROUNDS {
            let mut worst = 0.0f64;
            for i in 0..n {
                let a = self.spheres[i].a;
                let outer = outer.get(i).map_or(0.0, |outer| outer * a);
                self.strain[i] = dot(&self.bend[i * n..(i + 1) * n], &self.load) + outer;
                let b = self.modulus * a * a * self.strain[i];
                let root = b.hypot(self.alone[i]);
                // The one without a difference of near numbers.
                let stick = if b > 0.0 { self.alone[i] * (self.alone[i] / (b + root)) } else { root - b };
                let more = stick - self.stick[i];
                self.load[i] -= more;
                self.stick[i] = stick;
                worst = if more.is_nan() { f64::INFINITY } else { worst.max((more / stick).abs()) };
            }
            if worst <= FOUND {
                return;
            }
            if !worst.is_finite() {
                break;
            }
        }
        // Rounding may go to and fro.
        let near = (0..n).all(|i| {
            let a = self.spheres[i].a;
            let b = self.modulus * a * a * (dot(&self.bend[i * n..(i + 1) * n], &self.load) + outer.get(i).map_or(0.0, |outer| outer * a));
            let off = self.stick[i] * (self.stick[i] + 2.0 * b) - self.alone[i] * self.alone[i];
            off.abs() <= LOST * (self.alone[i].powi(2) + b * b)
        });
        if !near {
            // Loads that are none must not pass as some.
            self.load.fill(f64::NAN);
        }
    }

    /// Loads \[N\].
    pub(crate) fn loads(&self) -> &[f64] {
        &self.load
    }

    /// Grip of a spot: its adhesive load over that of a lone one.
    pub(crate) fn grip(&self, i: usize) -> f64 {
        self.stick[i] / self.alone[i]
    }

    /// What is to be added to the strain of a spot by others for it to have such a grip among spots of such loads \[N\], over its radius \[1/m\].
    pub(crate) fn outer(&self, i: usize, grip: f64, loads: &[f64]) -> f64 {
        let (n, a) = (self.count, self.spheres[i].a);
        let b = 0.5 * self.alone[i] * (1.0 / grip - grip);
        (b / (self.modulus * a * a) - dot(&self.bend[i * n..(i + 1) * n], loads)) / a
    }

    /// Displacements ŵ of all by one another \[m\].
    pub(super) fn displacements(&self, all: &mut Vec<f64>) {
        let n = self.count;
        all.clear();
        all.extend(self.hertz.iter().map(|hertz| 0.5 * hertz));
        for (j, line) in self.punch.chunks(n.max(1)).enumerate() {
            let half = 0.5 * self.stick[j];
            all.iter_mut().zip(line).for_each(|(w, p)| *w -= half * p);
            all[j] += 0.5 * dot(line, &self.load);
        }
    }

    /// What the loads do to each spot as to a punch, `Σ_j F_j p(r_ij, a_i)` \[m\].
    pub(crate) fn returned(&self, all: &mut Vec<f64>) {
        all.clear();
        all.extend(self.punch.chunks(self.count.max(1)).map(|line| dot(line, &self.load)));
    }

    /// By how much the loads change as the radii do \[N\]. It is found in the way in which the loads were.
    fn answer(&self, radii: &[f64]) -> Vec<f64> {
        let n = self.count;
        let mut loads: Vec<f64> = (0..n).map(|i| -self.firmness[i] * radii[i] / self.own[i][0]).collect();
        for _ in 0..ROUNDS {
            let (mut worst, mut most) = (0.0f64, 0.0f64);
            for i in 0..n {
                let line = &self.bend[i * n..(i + 1) * n];
                let others = dot(line, &loads) - line[i] * loads[i];
                let load = (0.5 * self.stick[i] * others - self.firmness[i] * radii[i]) / self.own[i][0];
                (worst, most) = (worst.max((load - loads[i]).abs()), most.max(load.abs()));
                loads[i] = load;
            }
            if worst <= ANSWERED * most {
                break;
            }
        }
        loads
    }

    /// How grips change as the radii do.
    pub(crate) fn grip_rates(&self, radii: &[f64]) -> Vec<f64> {
        let rate = |(i, load): (usize, f64)| {
            let Sphere { a, radius } = self.spheres[i];
            let stick = 4.0 * self.modulus * a * a / radius * radii[i] - load;
            (stick - 1.5 * self.stick[i] * radii[i] / a) / self.alone[i]
        };
        self.answer(radii).into_iter().enumerate().map(rate).collect()
    }

    /// `N·x`.
    fn yielding(&self, x: &[f64], y: &mut [f64]) {
        let n = self.count;
        for (i, line) in self.punch.chunks(n.max(1)).enumerate() {
            y[i] += (self.own[i][1] - line[i]) * x[i] + 0.5 * dot(line, x);
            let half = 0.5 * x[i];
            y.iter_mut().zip(line).for_each(|(y, p)| *y += half * p);
        }
    }

    /// The change of `D`, less that of the penetrations at constant grips, as the radii change.
    pub(super) fn product(&self, x: &[f64], y: &mut [f64]) {
        let n = self.count;
        for (i, own) in self.own.iter().enumerate() {
            // The sum below has a spot's own images too.
            y[i] = (own[0] + 0.5 * self.stick[i] * self.bend[i * n + i] - own[2]) * x[i];
        }
        for (j, line) in self.bend.chunks(n.max(1)).enumerate() {
            let half = 0.5 * self.stick[j] * x[j];
            y.iter_mut().zip(line).for_each(|(y, p)| *y -= half * p);
        }
        self.yielding(&self.answer(x), y);
    }

    /// The diagonal of that, to first order in what spots do to one another.
    pub(super) fn own(&self, i: usize) -> f64 {
        let [own, yielding, apart] = self.own[i];
        own - yielding * self.firmness[i] / own - apart
    }

    /// K, factored.
    fn factors(&self) -> &Lu {
        self.factors.get_or_init(|| {
            let n = self.count;
            let mut matrix = vec![0.0; n * n];
            for j in 0..n {
                for i in 0..n {
                    matrix[i * n + j] = -0.5 * self.stick[j] * self.bend[j * n + i];
                }
                matrix[j * n + j] = self.own[j][0];
            }
            let mut factors = Lu::default();
            factors.factor(&matrix, n);
            factors
        })
    }

    /// Row of spot i of the matrix that [`Self::product`] is the product with.
    pub(super) fn row(&self, i: usize, slopes: &mut [f64]) {
        let n = self.count;
        let mut by_loads: Vec<f64> = (0..n).map(|j| 0.5 * (self.punch[i * n + j] + self.punch[j * n + i])).collect();
        by_loads[i] = self.own[i][1];
        self.factors().solve(&mut by_loads);
        for (j, slope) in slopes[..n].iter_mut().enumerate() {
            *slope = -0.5 * self.stick[j] * self.bend[j * n + i] - by_loads[j] * self.firmness[j];
        }
        slopes[i] = self.own[i][0] - by_loads[i] * self.firmness[i] - self.own[i][2];
    }

    /// Displacement at a free place \[m\], given what [`Measure::of`] has of each spot there and `1/(πE*r)` with its images; its derivatives to loads and to
    /// radii at given loads are left in the columns.
    pub(super) fn at(&self, each: impl Iterator<Item = ([f64; 4], f64)>, columns: &mut [Vec<f64>; 2]) -> f64 {
        columns.iter_mut().for_each(Vec::clear);
        let mut sum = 0.0;
        for (j, ([p, bend, _, hertz], point)) in each.enumerate() {
            sum += 0.5 * (hertz - self.stick[j] * p + self.load[j] * point);
            columns[0].push(0.5 * (p + point));
            columns[1].push(-0.5 * self.stick[j] * bend);
        }
        sum
    }

    /// The derivatives to the radii alone, of what [`Self::at`] has left.
    pub(super) fn row_at(&self, [by_loads, by_radii]: &mut [Vec<f64>; 2], slopes: &mut [f64]) {
        self.factors().solve(by_loads);
        for (j, slope) in slopes[..self.count].iter_mut().enumerate() {
            *slope = by_radii[j] - by_loads[j] * self.firmness[j];
        }
    }

    /// The derivative to a change of the radii, of what [`Self::at`] has left.
    pub(super) fn slope_at(&self, [by_loads, by_radii]: &[Vec<f64>; 2], rates: &[f64], loads: &[f64]) -> f64 {
        dot(by_radii, rates) + dot(by_loads, loads)
    }

    /// By how much the loads change, for [`Self::slope_at`].
    pub(super) fn load_rates(&self, rates: &[f64]) -> Vec<f64> {
        self.answer(rates)
    }

    /// How many spots.
    pub(super) fn len(&self) -> usize {
        self.count
    }
}
