//! Nothing depends on the units: with lengths λ and forces φ times greater every equation scales by its dimension.

use crate::support::{ALONE, DEFAULT, Dice, LENGTH, PAPER, RMS, asperity, close, near, paper_spectrum, run};
use hysteron::model::{Amplitudes, Boundary, Coalescence, Interaction, KeptContacts, Material, Normalization, Slips};
use hysteron::physics::asperities::contact::{Problem, Rules};
use hysteron::physics::asperities::field::spot_field::spot_field_as_printed;
use hysteron::physics::jkr::Asperity;
use hysteron::physics::surface::shape::Shape;
use hysteron::physics::surface::spectrum::{Moments, Spectrum};
use hysteron::physics::surface::summits::{Summit, find_summits};
use hysteron::physics::surface::synthesis::{realization_seed, synthesize};
use hysteron::physics::theory::{
    adhesionless_area, dalvi_loss, deng_kesari_loss_as_printed, fuller_tabor, mean_loop_loss_as_printed, pinning_loss,
};

/// Something that moments have.
type Moment = fn(&Moments) -> f64;

/// How many times greater the numbers of lengths and forces become.
#[derive(Debug, Clone, Copy)]
struct Units {
    length: f64,
    force: f64,
}

impl Units {
    /// The factor of a quantity of dimension lengthˡ forceᶠ.
    fn of(self, l: f64, f: f64) -> f64 {
        self.length.powf(l) * self.force.powf(f)
    }

    fn material(self, m: Material) -> Material {
        Material {
            contact_modulus_pa: m.contact_modulus_pa * self.of(-2.0, 1.0),
            work_of_adhesion_j_m2: m.work_of_adhesion_j_m2 * self.of(-1.0, 1.0),
            interaction_range_m: m.interaction_range_m * self.length,
        }
    }

    fn spectrum(self, s: &Spectrum) -> Spectrum {
        let shape = Shape { roll_off_m: s.shape.roll_off_m.map(|length| length * self.length), ..s.shape.clone() };
        Spectrum { length_m: s.length_m * self.length, rms_height_m: s.rms_height_m * self.length, shape, ..s.clone() }
    }

    fn summit(self, s: &Summit) -> Summit {
        let k = 1.0 / self.length;
        Summit {
            x_m: s.x_m * self.length,
            y_m: s.y_m * self.length,
            height_m: s.height_m * self.length,
            curvature_1_m: s.curvature_1_m * k,
            curvature_min_1_m: s.curvature_min_1_m * k,
            curvature_max_1_m: s.curvature_max_1_m * k,
            ..*s
        }
    }
}

/// Six orders of magnitude either way, no powers of two: the digits change.
fn several() -> Vec<Units> {
    let mut dice = Dice(11);
    let mut factor = move || 10f64.powf(12.0 * dice.roll() - 6.0);
    (0..8).map(|_| Units { length: factor(), force: factor() }).collect()
}

/// Every equation as it is right, and every slip put back.
const PRINTED: [Slips; 2] = [Slips::NONE, Slips { eq8: true, eq9: true, a2: true, a3: true }];

/// A dozen roundings, through cube roots and powers of numbers of order 1e±12.
const ROUNDING: f64 = 1e-13;

#[test]
fn law_one_asperity_scales() {
    for units in several() {
        let material = units.material(PAPER);
        for (radius, slips) in [1e-6, 2.5e-5, 1e-3].into_iter().flat_map(|radius| PRINTED.map(|slips| (radius, slips))) {
            let of = |radius: f64, material: &Material| Asperity::as_printed(radius, material, slips).unwrap();
            let (p, q) = (of(radius, &PAPER), of(radius * units.length, &material));
            let scaled = |what: &str, got: f64, want: f64, l: f64, f: f64| close(what, got, want * units.of(l, f), ROUNDING);
            scaled("radius", q.radius_m(), p.radius_m(), 1.0, 0.0);
            scaled("pull", q.pull_sqrt_m(), p.pull_sqrt_m(), 0.5, 0.0);
            scaled("a_off", q.jump_off_radius(), p.jump_off_radius(), 1.0, 0.0);
            scaled("d_off", q.jump_off_penetration(), p.jump_off_penetration(), 1.0, 0.0);
            scaled("a_pull", q.pull_off_radius(), p.pull_off_radius(), 1.0, 0.0);
            scaled("F_pull", q.pull_off_load(), p.pull_off_load(), 0.0, 1.0);
            scaled("theta", q.loop_loss(), p.loop_loss(), 1.0, 1.0);
            for share in [1.2, 2.5, 9.0] {
                let (a, b) = (p.jump_off_radius() * share, p.jump_off_radius() * share * units.length);
                let (d, e) = (p.penetration(a), p.penetration(a) * units.length);
                scaled("F", q.load(b), p.load(a), 0.0, 1.0);
                scaled("dF/da", q.load_slope(b), p.load_slope(a), -1.0, 1.0);
                scaled("delta", q.penetration(b), d, 1.0, 0.0);
                scaled("d(delta)/da", q.penetration_slope(b), p.penetration_slope(a), 0.0, 0.0);
                scaled("a(delta)", q.radius_at_penetration(e).unwrap(), a, 1.0, 0.0);
                scaled("U", q.stored_energy(e, b), p.stored_energy(d, a), 1.0, 1.0);
            }
            let (range, wide) = (PAPER.interaction_range_m, material.interaction_range_m);
            scaled("Tabor", q.tabor(wide), p.tabor(range), 0.0, 0.0);
            scaled("Wu", q.wu_jump_in_penetration(wide), p.wu_jump_in_penetration(range), 1.0, 0.0);
            let jump = 0.4 * p.jump_off_penetration();
            // A difference of energies some ten times greater.
            close("loss", q.loop_loss_from(jump * units.length).unwrap(), p.loop_loss_from(jump).unwrap() * units.of(1.0, 1.0), 1e-12);
        }
    }
}

#[test]
fn law_a_spot_scales() {
    for units in several() {
        let (a, radius, pull) = (8e-6, 2.5e-5, 6.6e-4);
        for r in [2e-6, 9e-6, 4e-5, 1e-2] {
            for slips in PRINTED {
                let (w, slope) = spot_field_as_printed(r, a, radius, pull, slips);
                let by = units.length;
                let (v, steep) = spot_field_as_printed(r * by, a * by, radius * by, pull * by.sqrt(), slips);
                // The two terms of the field have opposite signs.
                near("w", v, w * by, 1e-13 * by * (w.abs() + a * a / r.max(a)));
                near("dw/da", steep, slope, 1e-13 * (slope.abs() + a / r.max(a)));
            }
        }
    }
}

#[test]
fn law_spectrum_and_theory_scale() {
    for units in several() {
        let shapes = [Shape::default(), Shape { roll_off_m: Some(0.8 * LENGTH), ..Shape::default() }];
        let of_shape = |shape| [Normalization::Sample, Normalization::Spectrum].map(|normalization| (normalization, shape));
        for (normalization, shape) in shapes.iter().flat_map(of_shape) {
            let p = Spectrum { normalization, shape: shape.clone(), ..paper_spectrum(0.7, 40) };
            let q = units.spectrum(&p);
            let scaled = |what: &str, got: f64, want: f64, l: f64, f: f64| close(what, got, want * units.of(l, f), ROUNDING);
            scaled("qL", q.lowest_wavenumber(), p.lowest_wavenumber(), -1.0, 0.0);
            scaled("C0", q.prefactor(), p.prefactor(), 4.0, 0.0);
            scaled("C", q.density(123), p.density(123), 4.0, 0.0);
            for (m, n) in [(p.moments(), q.moments()), (p.lattice_moments(), q.lattice_moments())] {
                let pairs: [(Moment, f64); 9] = [
                    (|m| m.m0_m2, 2.0),
                    (|m| m.m2, 0.0),
                    (|m| m.m4_1_m2, -2.0),
                    (Moments::rms_height_m, 1.0),
                    (Moments::rms_slope, 0.0),
                    (Moments::rms_curvature_1_m, -1.0),
                    (Moments::nayak_parameter, 0.0),
                    (Moments::summit_density_1_m2, -2.0),
                    (Moments::curvature_unit_1_m, -1.0),
                ];
                for (k, (moment, dimension)) in pairs.into_iter().enumerate() {
                    scaled(&format!("moment {k}"), moment(&n), moment(&m), dimension, 0.0);
                }
                let stuff = units.material(PAPER);
                for slips in PRINTED {
                    for tip in [None, Some(1e-3)] {
                        let mean = |m, material, tip| mean_loop_loss_as_printed(m, material, tip, slips).unwrap();
                        scaled("<theta>", mean(&n, &stuff, tip.map(|r| r * units.length)), mean(&m, &PAPER, tip), 1.0, 1.0);
                    }
                    let loss = |m, material, area| deng_kesari_loss_as_printed(m, material, area, slips).unwrap();
                    scaled("Theta", loss(&n, &stuff, 1e-7 * units.of(2.0, 0.0)), loss(&m, &PAPER, 1e-7), 1.0, 1.0);
                }
            }
        }
    }
}

#[test]
fn law_the_other_theories_scale() {
    for units in several() {
        let stuff = units.material(PAPER);
        let scaled = |what: &str, got: f64, want: f64, l: f64, f: f64| close(what, got, want * units.of(l, f), ROUNDING);
        scaled("Dalvi", dalvi_loss(&stuff, 1e-7 * units.of(2.0, 0.0)), dalvi_loss(&PAPER, 1e-7), 1.0, 1.0);
        let density = 1e-3 * units.of(-1.0, 1.0);
        let pinned = pinning_loss(&stuff, density, 1e-7 * units.of(2.0, 0.0)).unwrap();
        scaled("pinning", pinned, pinning_loss(&PAPER, 1e-3, 1e-7).unwrap(), 1.0, 1.0);
        let known = fuller_tabor(&PAPER, 4e-6, 1e-4);
        scaled("Fuller and Tabor", fuller_tabor(&stuff, 4e-6 * units.length, 1e-4 * units.length), known, 0.0, 0.0);
        // Neither load nor slope has a dimension: F/(E* A0) of scaled F, E* and A0.
        let load = 1e-3 * units.force / (PAPER.contact_modulus_pa * units.of(-2.0, 1.0) * 1e-6 * units.of(2.0, 0.0))
            * PAPER.contact_modulus_pa
            * 1e-6;
        scaled("area", adhesionless_area(load, 0.3), adhesionless_area(1e-3, 0.3), 0.0, 0.0);
    }
}

#[test]
fn law_surface_and_summits_scale() {
    for units in several().into_iter().take(3) {
        for amplitudes in [Amplitudes::Fixed, Amplitudes::Gaussian] {
            let p = Spectrum { amplitudes, ..paper_spectrum(0.8, 8) };
            let q = units.spectrum(&p);
            let [a, b] = [&p, &q].map(|s| synthesize(s, &realization_seed(1, 1), 64));
            for (g, h) in b.heights_m.iter().zip(&a.heights_m) {
                near("height", *g, h * units.length, 1e-14 * RMS * units.length);
            }
            let [s, t] = [(&p, &a), (&q, &b)].map(|(spectrum, made)| find_summits(made.heights_m.view(), spectrum.length_m, 8.0).unwrap());
            assert_eq!((s.list.len(), s.rejected, s.unrefined), (t.list.len(), t.rejected, t.unrefined));
            assert!(!s.list.is_empty());
            for (m, n) in s.list.iter().zip(&t.list) {
                let want = units.summit(m);
                // Newton's tolerance is 1e-10 of a spacing, L/64; what a rounding of the heights does to second derivatives is below.
                near("x", n.x_m, want.x_m, 1e-11 * q.length_m);
                near("y", n.y_m, want.y_m, 1e-11 * q.length_m);
                near("height", n.height_m, want.height_m, 1e-13 * q.rms_height_m);
                close("curvature", n.curvature_1_m, want.curvature_1_m, 1e-9);
            }
        }
    }
}

#[test]
fn law_a_whole_cycle_scales() {
    let summits = [
        (0.50, 0.50, 0.0, 2.5e-5),
        (0.525, 0.51, -3e-7, 4e-5),
        (0.48, 0.53, -1.2e-7, 1.5e-5),
        (0.02, 0.31, -2e-6, 5e-5),
        (0.97, 0.33, -1.5e-6, 2e-5),
        (0.503, 0.496, -4e-7, 1e-5),
    ]
    .map(|(x, y, z, r)| asperity(x * LENGTH, y * LENGTH, z, r));
    let cover = Rules { coalescence: Coalescence::Cover, ..DEFAULT };
    let others = Rules { boundary: Boundary::Isolated, slips: PRINTED[1], ..cover };
    for rules in [ALONE, cover, Rules { interaction: Interaction::Point, ..cover }, others] {
        let base = Problem::new(&summits, LENGTH, RMS, PAPER, rules).unwrap();
        let want = run(&base, &[1e-4, 2e-4], 0.05, KeptContacts::None);
        assert!(want.steps.iter().map(|s| s.counts.events.sum()).sum::<usize>() > 10);
        for units in several().into_iter().take(4) {
            let scaled: Vec<Summit> = summits.iter().map(|s| units.summit(s)).collect();
            let problem = Problem::new(&scaled, LENGTH * units.length, RMS * units.length, units.material(PAPER), rules).unwrap();
            close("unit of load", problem.load_unit_n(), base.load_unit_n() * units.force, ROUNDING);
            close("tolerance", problem.tolerance_m(), base.tolerance_m() * units.length, ROUNDING);
            close("first contact", problem.first_contact_m(), base.first_contact_m() * units.length, 1e-12);
            let got = run(&problem, &[1e-4, 2e-4], 0.05, KeptContacts::None);
            assert_eq!(got.steps.len(), want.steps.len(), "{units:?}");
            for (s, t) in got.steps.iter().zip(&want.steps) {
                assert_eq!(
                    (s.branch, s.counts.contacts, s.counts.covered, s.counts.events),
                    (t.branch, t.counts.contacts, t.counts.covered, t.counts.events)
                );
                // Equilibria are met to 1e-10 of the rms height, the turning load to 1e-9 of itself; approaches there follow.
                let load = base.load_unit_n() * 2e-4;
                near("approach", s.mean_penetration_m, t.mean_penetration_m * units.length, 1e-8 * RMS * units.length);
                near("load", s.load_n, t.load_n * units.force, 1e-8 * load * units.force);
                close("area", s.area_m2, t.area_m2 * units.of(2.0, 0.0), 1e-7);
                close("union", s.area_union_m2, t.area_union_m2 * units.of(2.0, 0.0), 1e-7);
                // Events are met to 1e-6 of the rms height, each in its own place within that.
                near("work", s.work_j, t.work_j * units.of(1.0, 1.0), 1e-5 * load * RMS * units.of(1.0, 1.0));
                near("lost", s.dissipated_j, t.dissipated_j * units.of(1.0, 1.0), 1e-5 * load * RMS * units.of(1.0, 1.0));
            }
        }
    }
}
