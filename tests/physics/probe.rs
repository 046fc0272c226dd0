//! Apparent works of adhesion of a probe, and evaluation of measured loops.
//!
//! Loops come from JKR's equations as they are written here, with another work of adhesion on approach than on retraction. After the load
//! reversal the contact edge is pinned until the energy release rate has risen.

use crate::support::{Dice, close};
use hysteron::physics::jkr::Asperity;
use hysteron::physics::model::{Baseline, Material};
use hysteron::physics::theory::probe::measured_loop::{Evaluated, Measured, evaluate};
use hysteron::physics::theory::probe::{Apparent, Branch, Estimate, Path, Probe};
use std::f64::consts::PI;

/// Radius, modulus, works of adhesion on approach and on retraction.
const TRUTH: Jkr = Jkr { radius: 2e-5, modulus: 1e6, approach: 0.03, retraction: 0.07 };

#[derive(Debug, Clone, Copy)]
struct Jkr {
    radius: f64,
    modulus: f64,
    approach: f64,
    retraction: f64,
}

/// A synthetic loop.
#[derive(Debug, Clone, Default)]
struct Loop {
    way: Vec<f64>,
    load: Vec<f64>,
    radius: Vec<f64>,
}

impl Jkr {
    fn load(&self, a: f64, work: f64) -> f64 {
        4.0 * self.modulus * a.powi(3) / (3.0 * self.radius) - (8.0 * PI * self.modulus * work * a.powi(3)).sqrt()
    }

    fn depth(&self, a: f64, work: f64) -> f64 {
        a * a / self.radius - (2.0 * PI * a * work / self.modulus).sqrt()
    }

    /// Load and penetration at a pinned contact radius, with the energy release rate `work`: both of JKR's equations.
    fn state(&self, a: f64, work: f64) -> [f64; 2] {
        [self.depth(a, work), self.load(a, work)]
    }

    /// Largest radius at which `way` increases to the given one, by bisection above `low`.
    fn radius_at(&self, way: f64, work: f64, compliance: f64, low: f64) -> f64 {
        let (mut low, mut high) = (low, self.radius);
        for _ in 0..200 {
            let a = 0.5 * (low + high);
            let [depth, load] = self.state(a, work);
            if depth + compliance * load < way { low = a } else { high = a }
        }
        0.5 * (low + high)
    }

    /// Radius at which the loop separates on retraction: minimum of the way of the machine.
    fn end(&self, work: f64, compliance: f64) -> f64 {
        let way = |a: f64| self.depth(a, work) + compliance * self.load(a, work);
        // The way is convex in sqrt(a) near its minimum; golden section by thirds.
        let (mut low, mut high) = (1e-4 * self.radius, 0.5 * self.radius);
        for _ in 0..300 {
            let (u, v) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
            if way(u) < way(v) { high = v } else { low = u }
        }
        0.5 * (low + high)
    }

    /// A loop from `-far` to `far` with so many points on each branch.
    fn cycle(&self, far: f64, count: usize, compliance: f64) -> Loop {
        let mut found = Loop::default();
        let [start, end] = [self.approach, self.retraction].map(|work| self.end(work, compliance));
        let turn = self.radius_at(far, self.approach, compliance, start);
        let last = self.depth(end, self.retraction) + compliance * self.load(end, self.retraction);
        let at = |k: usize| far * (2.0 * k as f64 / (count - 1) as f64 - 1.0);
        for k in 0..count {
            let a = if at(k) < 0.0 { 0.0 } else { self.radius_at(at(k), self.approach, compliance, start) };
            found.push(at(k), a, self.load(a, self.approach));
        }
        for k in (0..count - 1).rev() {
            let way = at(k);
            if way <= last {
                found.push(way, 0.0, 0.0);
                continue;
            }
            let free = self.radius_at(way, self.retraction, compliance, end);
            if free < turn {
                found.push(way, free, self.load(free, self.retraction));
            } else {
                // Pinned: the load is linear in the depth at constant radius, F = 2E*(aδ − a³/3R), and the way is δ + cF.
                let per_depth = 2.0 * self.modulus * turn;
                let offset = 2.0 * self.modulus * turn.powi(3) / (3.0 * self.radius);
                let depth = (way + compliance * offset) / (1.0 + compliance * per_depth);
                found.push(way, turn, per_depth * depth - offset);
            }
        }
        found
    }
}

impl Loop {
    fn push(&mut self, way: f64, radius: f64, load: f64) {
        self.way.push(way);
        self.radius.push(radius);
        self.load.push(load);
    }

    fn measured(&self) -> Measured<'_> {
        Measured { displacement_m: &self.way, load_n: &self.load, stiffness_n_m: None, baseline: Baseline::Line }
    }

    /// `∮F dδ` by trapezoids.
    fn loss(&self) -> f64 {
        (1..self.way.len()).map(|k| 0.5 * (self.load[k] + self.load[k - 1]) * (self.way[k] - self.way[k - 1])).sum()
    }

    /// The loop with a drifting zero, and noise of the load: normal, with the correlation `r` of neighbours.
    fn noisy(&self, dice: &mut Dice, noise: f64, correlation: f64) -> Self {
        let mut noisy = self.clone();
        let count = self.load.len() as f64;
        let mut last = 0.0;
        for (k, load) in noisy.load.iter_mut().enumerate() {
            let normal = (-2.0 * (1.0 - dice.roll()).ln()).sqrt() * (2.0 * PI * dice.roll()).cos();
            last = correlation * last + (1.0 - correlation * correlation).sqrt() * normal;
            *load += noise * last + 3e-8 + 2e-8 * k as f64 / count + 1e-3 * self.way[k];
        }
        noisy
    }
}

fn probe(modulus: Option<f64>) -> Probe {
    Probe::new(TRUTH.radius, modulus).unwrap()
}

/// Student's 95 % bound is near 2 for all the degrees of freedom here, and larger for few.
fn covers(estimate: Estimate, truth: f64) -> bool {
    let t = if estimate.degrees_of_freedom < 30 { 2.05 + 4.0 / estimate.degrees_of_freedom as f64 } else { 2.0 };
    (estimate.value - truth).abs() <= t * estimate.standard_error
}

#[test]
fn law_closed_forms_are_inverses_of_jkr() {
    for (radius, modulus, work) in [(1e-3, 1e6, 0.05), (2e-5, 7e5, 0.002), (0.1, 3e5, 1.3)] {
        let material = Material { contact_modulus_pa: modulus, work_of_adhesion_j_m2: work, interaction_range_m: 1e-9 };
        let sphere = Asperity::new(radius, &material).unwrap();
        let probe = Probe::new(radius, Some(modulus)).unwrap();
        close("F_po", probe.work_from_pull_off(-sphere.pull_off_load()).unwrap(), work, 1e-14);
        // Powers 3/5 and 5/3 one after the other.
        close("Θ", probe.work_from_loss(sphere.loop_loss()).unwrap(), work, 1e-13);
        // The constant of the head of the module, to its digits: 2 π^(5/3) 2^(2/3) (0.3 + 0.2/16^(2/3)).
        let loss = 7.092_196 * work.powf(5.0 / 3.0) * radius.powf(4.0 / 3.0) * modulus.powf(-2.0 / 3.0);
        close("constant", sphere.loop_loss(), loss, 1e-7);
        assert_eq!((probe.radius_m(), probe.contact_modulus_pa()), (radius, Some(modulus)));
    }
    assert_eq!(probe(Some(1e6)).work_from_pull_off(0.0).unwrap(), 0.0);
    assert_eq!(probe(Some(1e6)).work_from_loss(0.0).unwrap(), 0.0);
}

#[test]
fn val_a_radius_fit_gives_jkr_back() {
    let radii: Vec<f64> = (1..40).map(|k| 2e-7 * f64::from(k)).collect();
    let area: Vec<f64> = radii.iter().map(|a| PI * a * a).collect();
    let load: Vec<f64> = radii.iter().map(|a| TRUTH.load(*a, TRUTH.retraction)).collect();
    let branch = Branch { load_n: &load, area_m2: &area };
    for modulus in [None, Some(TRUTH.modulus)] {
        let fit = probe(modulus).fit_radius(branch).unwrap();
        close("w", fit.work_j_m2.unwrap().value, TRUTH.retraction, 1e-6);
        assert_eq!((fit.count, fit.modulus_pa.is_some()), (39, modulus.is_none()));
        assert!(fit.residual < 1e-12 && fit.residual_n < 1e-18, "{fit:?}");
        if let Some(found) = fit.modulus_pa {
            close("E*", found.value, TRUTH.modulus, 1e-6);
        }
    }
    // Less contact than Hertz has no work of adhesion: of half the area at the same load.
    let half: Vec<f64> = area.iter().map(|area| 0.5 * area).collect();
    let hertz: Vec<f64> = radii.iter().map(|a| TRUTH.load(*a, 0.0)).collect();
    assert_eq!(probe(Some(TRUTH.modulus)).fit_radius(Branch { load_n: &hertz, area_m2: &half }).unwrap().work_j_m2, None);
}

#[test]
fn val_a_force_fit_gives_jkr_back() {
    let found = TRUTH.cycle(4e-6, 200, 0.0);
    let (turn, origin) = (199, 3e-7);
    let way: Vec<f64> = found.way.iter().map(|way| way + origin).collect();
    let least = (turn..way.len()).min_by(|u, v| found.load[*u].total_cmp(&found.load[*v])).unwrap();
    let path = |rows: std::ops::Range<usize>| Path { penetration_m: &way[rows.clone()], load_n: &found.load[rows] };
    for modulus in [None, Some(TRUTH.modulus)] {
        let fit = probe(modulus).fit_force(path(101..turn + 1), path(turn..least + 1)).unwrap();
        // The minimum of squares is flat to the root of rounding.
        close("w of retraction", fit.retraction_j_m2.unwrap().value, TRUTH.retraction, 1e-6);
        close("w of approach", fit.approach_j_m2.unwrap().value, TRUTH.approach, 1e-6);
        close("origin", fit.origin_m.value, origin, 1e-6);
        if let Some(found) = fit.modulus_pa {
            close("E*", found.value, TRUTH.modulus, 1e-6);
        }
        assert!(fit.residual < 1e-9 && fit.residuals_n[0] < 1e-14 && fit.count > 150, "{fit:?}");
    }
    // One work of adhesion, and the retraction alone.
    let same = Jkr { approach: TRUTH.retraction, ..TRUTH }.cycle(4e-6, 200, 0.0);
    let path = Path { penetration_m: &same.way[turn..least + 1], load_n: &same.load[turn..least + 1] };
    let fit = probe(None).fit_force(Path::default(), path).unwrap();
    close("w", fit.retraction_j_m2.unwrap().value, TRUTH.retraction, 1e-6);
    assert_eq!(fit.approach_j_m2, None);
}

#[test]
fn val_apparent_works_of_one_sphere_agree() {
    let jkr = Jkr { approach: 0.05, retraction: 0.05, ..TRUTH };
    let found = jkr.cycle(4e-6, 4000, 0.0);
    let area: Vec<f64> = found.radius.iter().map(|a| PI * a * a).collect();
    let (load, turn) = (&found.load, 3999);
    let of = |rows: std::ops::Range<usize>| Branch { load_n: &load[rows.clone()], area_m2: &area[rows] };
    let pull_off = -load.iter().copied().fold(0.0, f64::min);
    let works = probe(Some(jkr.modulus)).apparent_works(Some(pull_off), Some(found.loss()), of(0..turn + 1), of(turn..load.len())).unwrap();
    // 2000 points of penetration in contact: F_po by its sampled minimum, Θ with both jumps somewhere within a step.
    close("F_po", works.pull_off_j_m2.unwrap(), 0.05, 1e-4);
    close("Θ", works.loss_j_m2.unwrap(), 0.05, 3e-3);
    close("approach", works.approach.unwrap().work_j_m2.unwrap().value, 0.05, 1e-9);
    close("retraction", works.retraction.unwrap().work_j_m2.unwrap().value, 0.05, 1e-9);
    let none = Branch { load_n: &[], area_m2: &[] };
    let empty = probe(Some(1e6)).apparent_works(None, None, none, none).unwrap();
    assert_eq!((empty.pull_off_j_m2, empty.approach), (None, None));
}

fn evaluated(found: &Loop) -> Evaluated {
    evaluate(&found.measured()).unwrap()
}

#[test]
fn val_a_loop_without_noise() {
    let found = TRUTH.cycle(4e-6, 2001, 0.0);
    let loop_ = evaluated(&found);
    let pull_off = 1.5 * PI * TRUTH.radius * TRUTH.retraction;
    // The polynomial at the minimum.
    close("F_po", loop_.pull_off_n.unwrap().value, pull_off, 2e-3);
    close("Θ", loop_.loss_j.value, found.loss(), 1e-12);
    close("both works", loop_.opening_j.value - loop_.closing_j.value, loop_.loss_j.value, 1e-12);
    assert_eq!((loop_.turn, loop_.in_contact.iter().filter(|is| **is).count() > 2000), (2000, true));
    close("work", loop_.work_j[2000] + loop_.work_j.last().unwrap(), loop_.loss_j.value, 1e-12);
    for radius in [None, Some(found.radius.as_slice())] {
        let apparent = loop_.apparent(&probe(Some(TRUTH.modulus)), radius).unwrap();
        close("approach", apparent.approach_j_m2.unwrap().value, TRUTH.approach, 1e-6);
        close("retraction", apparent.retraction_j_m2.unwrap().value, TRUTH.retraction, 1e-6);
        close("E*", apparent.modulus_pa.unwrap().value, TRUTH.modulus, 1e-6);
        assert_eq!(apparent.is_of_radius, radius.is_some());
    }
}

/// A machine whose spring is as stiff as the contact: its displacement gives the penetration back, and Θ of the machine is that of the
/// penetration.
#[test]
fn val_the_stiffness_of_the_machine_is_subtracted() {
    let stiffness = 5.0;
    let found = TRUTH.cycle(6e-6, 1001, 1.0 / stiffness);
    let with = Measured { stiffness_n_m: Some(stiffness), ..found.measured() };
    let loop_ = evaluate(&with).unwrap();
    let apparent = loop_.apparent(&probe(None), None).unwrap();
    close("retraction", apparent.retraction_j_m2.unwrap().value, TRUTH.retraction, 1e-6);
    close("approach", apparent.approach_j_m2.unwrap().value, TRUTH.approach, 1e-6);
    close("E*", apparent.modulus_pa.unwrap().value, TRUTH.modulus, 1e-6);
    let contact: f64 = (1..found.way.len())
        .map(|k| 0.5 * (loop_.load_n[k] + loop_.load_n[k - 1]) * (loop_.penetration_m[k] - loop_.penetration_m[k - 1]))
        .sum();
    // Loads are 0 at both ends: ∮F dF/k vanishes exactly.
    close("Θ", loop_.loss_j.value, contact, 1e-10);
    // Not subtracted, the modulus is too small.
    let without = evaluated(&found).apparent(&probe(None), None).unwrap();
    assert!(without.modulus_pa.unwrap().value < 0.8 * TRUTH.modulus, "{without:?}");
}

/// Intervals of 95 % cover the truth in at least 95 of 100 loops with noise of 2 % of the pull-off force, white and correlated.
#[test]
fn law_intervals_cover_the_truth() {
    let exact = TRUTH.cycle(4e-6, 60_001, 0.0);
    let loss = exact.loss();
    let fine = evaluated(&exact);
    let pull_off = 1.5 * PI * TRUTH.radius * TRUTH.retraction;
    let mut all = Vec::new();
    for (correlation, count) in [(0.0, 301), (0.6, 301)] {
        let clean = TRUTH.cycle(4e-6, count, 0.0);
        let mut dice = Dice(60);
        let mut hits = [0_u32; 13];
        for _ in 0..100 {
            let noisy = clean.noisy(&mut dice, 0.02 * pull_off, correlation);
            let found = evaluated(&noisy);
            let of = |modulus, radius| -> Apparent { found.apparent(&probe(modulus), radius).unwrap() };
            let (by_radius, by_force) = (of(Some(TRUTH.modulus), Some(clean.radius.as_slice())), of(Some(TRUTH.modulus), None));
            let free = of(None, None);
            let cases = [
                (found.pull_off_n, pull_off),
                (Some(found.loss_j), loss),
                (Some(found.closing_j), fine.closing_j.value),
                (Some(found.opening_j), fine.opening_j.value),
                (by_radius.pull_off_j_m2, TRUTH.retraction),
                (by_radius.approach_j_m2, TRUTH.approach),
                (by_radius.retraction_j_m2, TRUTH.retraction),
                (by_radius.modulus_pa, TRUTH.modulus),
                (by_force.approach_j_m2, TRUTH.approach),
                (by_force.retraction_j_m2, TRUTH.retraction),
                (free.approach_j_m2, TRUTH.approach),
                (free.retraction_j_m2, TRUTH.retraction),
                (free.modulus_pa, TRUTH.modulus),
            ];
            for (hit, (estimate, truth)) in hits.iter_mut().zip(cases) {
                *hit += u32::from(covers(estimate.unwrap(), truth));
            }
        }
        all.push((correlation, count, hits));
    }
    assert!(all.iter().all(|(_, _, hits)| hits.iter().all(|hit| *hit >= 95)), "correlation, points, hits: {all:?}");
}

#[test]
fn reg_loops_that_are_refused() {
    let good = TRUTH.cycle(4e-6, 200, 0.0);
    let part = |rows: std::ops::Range<usize>| Loop {
        way: good.way[rows.clone()].to_vec(),
        load: good.load[rows.clone()].to_vec(),
        radius: good.radius[rows].to_vec(),
    };
    let zigzag = Loop { way: (0..200).map(|k| f64::from(k % 50 + if k == 100 { 60 } else { 0 })).collect(), ..part(0..200) };
    let in_contact = Loop { ..part(110..290) };
    for (found, words) in [
        (part(0..20), "20 points"),
        (part(0..200), "no load reversal"),
        (part(0..280), "does not close"),
        (in_contact, "ontact"),
        (zigzag, "goes back"),
        (Loop { load: vec![0.0; good.load.len()], ..good.clone() }, "the same at all points"),
        (Loop { load: good.load.iter().rev().copied().collect(), ..good.clone() }, "gains energy"),
        (Loop { way: good.way[..300].to_vec(), ..good.clone() }, "300 displacements"),
    ] {
        let error = evaluate(&found.measured()).unwrap_err().to_string();
        assert!(error.contains(words) && error.contains("help: "), "{words}: {error}");
    }
    let loop_ = evaluated(&good);
    assert!(loop_.apparent(&probe(None), Some(&[1.0])).is_err());
    assert!(Probe::new(0.0, None).is_err() && Probe::new(1.0, Some(f64::NAN)).is_err());
    let none = probe(None);
    assert!(none.work_from_loss(1.0).is_err() && none.work_from_pull_off(-1.0).is_err() && none.with_modulus(-1.0).is_err());
    assert!(none.fit_force(Path::default(), Path::default()).is_err());
    assert!(none.fit_radius(Branch { load_n: &[1.0], area_m2: &[] }).is_err());
    assert!(none.fit_radius(Branch { load_n: &[1.0; 5], area_m2: &[1.0; 5] }).is_err());
}

/// With lengths λ and forces φ times greater every number scales by its dimension.
#[test]
fn law_a_measured_loop_scales() {
    let (length, force) = (3.7e3, 2.9e-4);
    let scaled = Jkr {
        radius: TRUTH.radius * length,
        modulus: TRUTH.modulus * force / (length * length),
        approach: TRUTH.approach * force / length,
        retraction: TRUTH.retraction * force / length,
    };
    let of = |jkr: Jkr, far: f64| {
        let found = evaluated(&jkr.cycle(far, 400, 0.0));
        let apparent = found.apparent(&Probe::new(jkr.radius, None).unwrap(), None).unwrap();
        (found, apparent)
    };
    let ((one, p), (two, q)) = (of(TRUTH, 4e-6), of(scaled, 4e-6 * length));
    close("F_po", two.pull_off_n.unwrap().value, one.pull_off_n.unwrap().value * force, 1e-9);
    close("Θ", two.loss_j.value, one.loss_j.value * force * length, 1e-9);
    close("w", q.retraction_j_m2.unwrap().value, p.retraction_j_m2.unwrap().value * force / length, 1e-6);
    close("w of Θ", q.loss_j_m2.unwrap().value, p.loss_j_m2.unwrap().value * force / length, 1e-6);
}
