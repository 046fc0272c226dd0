//! The paper's slips put back: what each changes, and that it changes nothing else. Section 8 of the physics sheet.

use crate::jkr::work;
use crate::support::{ALONE, DEFAULT, LENGTH, PAPER, RMS, close, loop_of, near, paper_cycle, paper_spectrum, paper_summits, turning};
use hysteron::model::{Boundary, Choice, Interaction as Kind, JumpIn, Slip, Slips};
use hysteron::physics::EventKind as Event;
use hysteron::physics::PhysicsError;
use hysteron::physics::asperities::contact::Rules;
use hysteron::physics::asperities::field::spot_field::{Spot, spot_field, spot_field_as_printed};
use hysteron::physics::asperities::field::{DirectSum, Interaction, Spots, ewald::RemainderSeries};
use hysteron::physics::cycle::Effort;
use hysteron::physics::jkr::Asperity;
use hysteron::physics::surface::spectrum::Moments;
use hysteron::physics::theory::{
    curvature_decay, curvature_density, curvature_density_as_printed, deng_kesari_loss, deng_kesari_loss_as_printed, mean_loop_loss,
    mean_loop_loss_as_printed,
};
use std::f64::consts::PI;

const EQ8: Slips = Slips { eq8: true, ..Slips::NONE };
const EQ9: Slips = Slips { eq9: true, ..Slips::NONE };
const A2: Slips = Slips { a2: true, ..Slips::NONE };
const A3: Slips = Slips { a3: true, ..Slips::NONE };

#[test]
fn law_a_list_of_slips_is_a_set_of_flags() {
    let each = Slip::WORDS.iter().map(|(_, slip)| std::iter::once(*slip).collect::<Slips>()).collect::<Vec<_>>();
    assert_eq!(each, [EQ8, EQ9, A2, A3]);
    assert_eq!(std::iter::empty().collect::<Slips>(), Slips::NONE);
    assert_eq!([Slip::A3, Slip::Eq8, Slip::Eq8].into_iter().collect::<Slips>(), Slips { eq8: true, a3: true, ..Slips::NONE });
    let read: Vec<Slip> = Slip::WORDS.iter().map(|(_, slip)| *slip).filter(|slip| slip.in_contact()).collect();
    assert_eq!(read, [Slip::Eq8, Slip::Eq9]);
}

#[test]
fn law_the_branch_ends_where_the_printed_slope_vanishes() {
    let (e, g) = (PAPER.contact_modulus_pa, PAPER.work_of_adhesion_j_m2);
    for radius in [1e-6, 2.5e-5, 1e-3] {
        let (right, printed) = (Asperity::new(radius, &PAPER).unwrap(), Asperity::as_printed(radius, &PAPER, EQ9).unwrap());
        let end = printed.jump_off_radius();
        // Cube roots and a dozen roundings.
        near("the denominator of Eq 9", 2.0 * end / radius - (PI * g / (e * end)).sqrt(), 0.0, 1e-14 * end / radius);
        close("radius", end, right.jump_off_radius() * 2f64.cbrt(), 1e-15);
        close("its penetration", printed.jump_off_penetration(), printed.penetration(end), 1e-14);
        close("less deep", printed.jump_off_penetration(), 0.967482 * right.jump_off_penetration(), 1e-6);
        // The branch is the same down to there, and then it is not.
        close("its end", printed.radius_at_penetration(printed.jump_off_penetration()).unwrap(), end, 1e-14);
        for share in [1.0 + 1e-12, 0.5 * (1.0 + 1.0 / 0.967482), 1.02, 2.0] {
            assert_eq!(printed.radius_at_penetration(share * printed.jump_off_penetration()), None);
        }
        for share in [0.999, 0.5, 0.0, -3.0] {
            let penetration = share * printed.jump_off_penetration();
            assert_eq!(printed.radius_at_penetration(penetration), right.radius_at_penetration(penetration));
        }
        // What is no end of a branch stays.
        for a in [0.3 * end, end, 4.0 * end] {
            let all = |jkr: &Asperity| [jkr.load(a), jkr.load_slope(a), jkr.penetration(a), jkr.penetration_slope(a)];
            assert_eq!(all(&printed), all(&right));
        }
        let all = |jkr: &Asperity| [jkr.pull_off_radius(), jkr.pull_off_load(), jkr.loop_loss(), jkr.tabor(1e-9)];
        assert_eq!(all(&printed), all(&right));
        assert_eq!(Asperity::as_printed(radius, &PAPER, Slips { eq9: false, eq8: true, a2: true, a3: true }).unwrap(), right);
    }
}

#[test]
fn law_a_loop_ends_with_the_printed_branch() {
    for radius in [1e-6, 1e-3] {
        let jkr = Asperity::as_printed(radius, &PAPER, EQ9).unwrap();
        let loss = jkr.loop_loss_from(0.0).unwrap();
        let landed = jkr.radius_at_penetration(0.0).unwrap();
        // Simpson's error, as for the right branch.
        close("area of the loop", loss, -work(&jkr, jkr.jump_off_radius(), landed), 1e-9);
        // What is lost of the loop is its last corner: 3 % of the penetration, at the least load.
        let corner = 1.0 - loss / jkr.loop_loss();
        assert!((0.01..0.03).contains(&corner), "{corner}");
        assert_eq!(jkr.loop_loss_from(1.01 * jkr.jump_off_penetration()), None);
    }
}

#[test]
fn law_without_interaction_the_loss_is_the_sum_of_the_printed_loops() {
    let summits = paper_summits(16, 0);
    for jump_in in [JumpIn::Jkr, JumpIn::Wu] {
        let cycle = paper_cycle(&summits, Rules { jump_in, slips: EQ9, ..ALONE }, &[0.0071], 0.02);
        let mut touched: Vec<usize> = cycle.events.iter().filter(|e| e.kind == Event::JumpIn).map(|e| e.asperity().unwrap()).collect();
        touched.sort_unstable();
        touched.dedup();
        assert!(touched.len() > 20);
        let want: f64 = touched
            .iter()
            .map(|i| {
                let jkr = Asperity::as_printed(summits[*i].radius_m(), &PAPER, EQ9).unwrap();
                let jump = if jump_in == JumpIn::Wu { jkr.wu_jump_in_penetration(PAPER.interaction_range_m) } else { 0.0 };
                jkr.loop_loss_from(jump).unwrap()
            })
            .sum();
        let sums = loop_of(&cycle, 0);
        // As for the right branch: the work's quadrature, and jump-offs within 2e-5 of δ_off before the end.
        close("Theta", sums.loss, want, 3e-5);
        close("events", sums.events, want, 3e-5);
        for event in cycle.events.iter().filter(|e| e.kind == Event::JumpOff) {
            let jkr = Asperity::as_printed(summits[event.asperity().unwrap()].radius_m(), &PAPER, EQ9).unwrap();
            let highest = summits.iter().map(|s| s.height_m).fold(f64::NEG_INFINITY, f64::max);
            let penetration = event.mean_penetration_m + summits[event.asperity().unwrap()].height_m - highest;
            near("jump-off", penetration, jkr.jump_off_penetration(), 2.1e-5 * jkr.jump_off_penetration().abs() + 1e-6 * RMS);
        }
    }
}

#[test]
fn law_the_printed_field_is_flat_inside_and_jumps_at_the_edge() {
    let pull = (2.0 * PI * 0.07 / 1e6f64).sqrt();
    for (a, radius) in [(4e-6f64, 2.5e-5), (1.5e-5, 2.5e-5), (2e-5, 1e-4)] {
        let scale = a * a / radius + pull * a.sqrt();
        for share in [1e-6, 0.1, 0.5, 0.999, 1.0 - 1e-12] {
            let (value, slope) = spot_field_as_printed(share * a, a, radius, pull, EQ8);
            // Two terms, rounded.
            near("Eq 8", value, a * a / radius - pull * a.sqrt(), 1e-15 * scale);
            assert_eq!(slope, spot_field(share * a, a, radius, pull).1);
        }
        let edge = spot_field_as_printed(a * (1.0 - 1e-12), a, radius, pull, EQ8).0 - spot_field(a, a, radius, pull).0;
        near("the jump", edge, a * a / (2.0 * radius), 1e-11 * scale);
        // Outside, and with the other slips, it is the field to the bit.
        for r in [0.2 * a, 1.001 * a, 3.0 * a, 1e4 * a] {
            let right = spot_field(r, a, radius, pull);
            assert_eq!(spot_field_as_printed(r, a, radius, pull, Slips { eq8: r > a, eq9: true, a2: true, a3: true }), right);
        }
    }
}

#[test]
fn law_the_sum_over_spots_has_the_printed_field() {
    let (a, radius) = (2e-5, 1e-4);
    let jkr = Asperity::new(radius, &PAPER).unwrap();
    let positions = vec![[0.5 * LENGTH, 0.5 * LENGTH], [0.512 * LENGTH, 0.505 * LENGTH], [0.53 * LENGTH, 0.5 * LENGTH]];
    let mut spots = Spots { index: vec![0], ..Spots::default() };
    let [x, y] = positions[0];
    spots.columns.set(std::iter::once(Spot { x, y, a, radius, load: jkr.load(a), load_slope: jkr.load_slope(a) }));
    for (boundary, slips) in [Boundary::Isolated, Boundary::Periodic].iter().flat_map(|b| [Slips::NONE, EQ8].map(|s| (*b, s))) {
        let field = DirectSum::new(positions.clone(), LENGTH, &PAPER, Kind::Spots, boundary, slips);
        let mut found = Vec::new();
        field.displacements(&spots, &[1, 2], &mut found, &mut Effort::default());
        for (target, got) in [1, 2].into_iter().zip(found) {
            let [dx, dy] = [positions[target][0] - x, positions[target][1] - y];
            let own = spot_field_as_printed(dx.hypot(dy), a, radius, jkr.pull_sqrt_m(), slips).0;
            let images = match boundary {
                Boundary::Isolated => 0.0,
                Boundary::Periodic => {
                    jkr.load(a) / (PI * PAPER.contact_modulus_pa * LENGTH) * RemainderSeries::new().at(dx / LENGTH, dy / LENGTH)
                }
            };
            // Distances are differences of coordinates 20 times greater, and the field has an edge. Images act as spots: the next order of their
            // field is (a/L)² = 4e-4 of the first, here some 1e-11 m.
            let tolerance = if boundary == Boundary::Periodic { 3e-5 * (a * a / radius) } else { 1e-12 * (a * a / radius) };
            near("w", got, own + images, tolerance);
        }
    }
}

#[test]
fn e2e_a_cycle_with_a_slip_of_the_contact() {
    let summits = paper_summits(32, 2);
    let right = paper_cycle(&summits, DEFAULT, &[0.0071], 0.04);
    for slips in [EQ8, EQ9] {
        let cycle = paper_cycle(&summits, Rules { slips, ..DEFAULT }, &[0.0071], 0.04);
        assert!(cycle.steps.iter().all(|step| step.numerics.residual_m.unwrap() <= 1e-8 * RMS));
        let (p, q) = (loop_of(&right, 0), loop_of(&cycle, 0));
        // It is another loop, and a near one: few asperities lie within a contact and are not absorbed (Eq 8: 9e-4 of the loss), and a branch loses
        // its last corner, and some spots leave in another order (Eq 9). The area at the turning point knows no end of a branch.
        assert!((p.loss / q.loss - 1.0).abs() > if slips.eq8 { 1e-5 } else { 1e-3 }, "{slips:?}");
        close("loss", q.loss, p.loss, 0.1);
        // As printed Eq 8 makes the field jump at the edge of a spot: an asperity there may be covered or not, and so may those next to it (8 %).
        close("area", turning(&cycle, 0).area_m2, turning(&right, 0).area_m2, if slips.eq8 { 0.15 } else { 0.01 });
    }
    // Those of the estimate beside it do not enter.
    let beside = paper_cycle(&summits, Rules { slips: Slips { a2: true, a3: true, ..Slips::NONE }, ..DEFAULT }, &[0.0071], 0.04);
    assert_eq!(beside.steps, right.steps);
}

/// `∫ |t|^s p_k(t) dt` in closed form, with decay c: each term of p_k is a Gaussian moment, `½ c^(−(s + 1)/2) Γ((s + 1)/2)`, continued
/// analytically to where only their sum converges.
fn moment(s: f64, decay: f64) -> f64 {
    let gaussian = |power: f64, c: f64| 0.5 * c.powf(-0.5 * (power + 1.0)) * libm::tgamma(0.5 * (power + 1.0));
    (3.0 / (4.0 * PI)).sqrt() * (gaussian(s + 2.0, decay) - 2.0 * gaussian(s, decay) + 2.0 * gaussian(s, decay + 0.5))
}

/// Moments with a given Nayak parameter.
fn with_nayak(nayak: f64) -> Moments {
    let (m2, m4) = (1e-2, 1e8);
    Moments { m0_m2: nayak * m2 * m2 / m4, m2, m4_1_m2: m4 }
}

#[test]
fn law_only_the_right_exponent_integrates_to_one() {
    // A check of the closed form itself: Γ has 1e-15, and the terms cancel by some tens.
    close("right", moment(0.0, 0.25), 1.0, 1e-13);
    for nayak in [12.5, 20.0, 73.73, 200.4, 1605.0, 1e7] {
        let (c1, root) = (nayak / (2.0 * nayak - 3.0), 12.0 / nayak);
        let c2 = c1 * f64::sqrt(root);
        close("right", (8.0 * c1 * c1 - c2 * c2) / (16.0 * c1), curvature_decay(nayak, Slips::NONE).unwrap(), 1e-15);
        let decay = curvature_decay(nayak, A2).unwrap();
        close("printed", 8.0 * (c1 * c1 - c2 * c2) / (16.0 * c1), decay, 1e-13);
        // The doc's integral, and a sum: trapezoids on a smooth function that vanishes at both ends, 4000 of them up to e^(−56).
        let whole = 0.75f64.sqrt() * (0.25 * decay.powf(-1.5) - decay.powf(-0.5) + (decay + 0.5).powf(-0.5));
        close("in closed form", whole, moment(0.0, decay), 1e-12);
        let h = 7.5 / decay.sqrt() / 4000.0;
        let sum: f64 = (1..4000).map(|k| h * curvature_density_as_printed(-h * f64::from(k), decay)).sum();
        close("as a sum", sum, whole, 1e-9);
        assert!(whole > 1.0, "{nayak}");
    }
    close("a wide spectrum", curvature_decay(1e7, A2).unwrap(), 0.25, 2e-6);
    for t in [-5.0, -1.0, -1e-3, 0.0, 1.0] {
        assert_eq!(curvature_density_as_printed(t, 0.25), curvature_density(t));
    }
    for nayak in [1.5, 2.0, 11.9, 12.0, f64::NAN, -1.0] {
        assert_eq!(curvature_decay(nayak, A2), None, "{nayak}");
        assert_eq!(curvature_decay(nayak, Slips { a2: false, ..PRINTED }), Some(0.25));
    }
}

const PRINTED: Slips = Slips { eq8: true, eq9: true, a2: true, a3: true };

#[test]
fn val_the_mean_loss_as_printed_has_a_closed_form() {
    for moments in [paper_spectrum(0.8, 64).moments(), paper_spectrum(0.8, 512).moments(), with_nayak(13.0)] {
        // θ(R) = θ(1 m) (R/1 m)^(4/3).
        let unit = Asperity::new(1.0, &PAPER).unwrap().loop_loss();
        let curvature = (moments.m4_1_m2 / 3.0).sqrt();
        for slips in [Slips::NONE, A2, A3, PRINTED] {
            let decay = curvature_decay(moments.nayak_parameter(), slips).unwrap();
            let power = if slips.a3 { -2.0 / 3.0 } else { -4.0 / 3.0 };
            let want = unit * curvature.powf(-4.0 / 3.0) * moment(power, decay);
            // The quadrature's own error is below 1e-9.
            close("<theta>", mean_loop_loss_as_printed(&moments, &PAPER, None, slips).unwrap(), want, 1e-8);
            let area = 0.3e-6;
            let loss = moments.summit_density_1_m2() * area * want;
            close("Eq A4", deng_kesari_loss_as_printed(&moments, &PAPER, area, slips).unwrap(), loss, 1e-8);
            // A sharp tip decides alone, whatever the summits: (4/3) of 1e-9 m over radii of 1e-5 m at least.
            let sharp = mean_loop_loss_as_printed(&moments, &PAPER, Some(1e-9), slips).unwrap();
            close("sharp", sharp, Asperity::new(1e-9, &PAPER).unwrap().loop_loss() * moment(0.0, decay), 1e-2);
        }
        let both = |slips| {
            (
                mean_loop_loss_as_printed(&moments, &PAPER, Some(1e-3), slips).unwrap(),
                deng_kesari_loss_as_printed(&moments, &PAPER, 1e-7, slips).unwrap(),
            )
        };
        let right = (mean_loop_loss(&moments, &PAPER, Some(1e-3)).unwrap(), deng_kesari_loss(&moments, &PAPER, 1e-7).unwrap());
        // Those of the contact do not enter.
        assert_eq!((both(Slips::NONE), both(Slips { eq8: true, eq9: true, ..Slips::NONE })), (right, right));
    }
}

#[test]
fn reg_a_narrow_spectrum_has_no_mean_loss_as_printed() {
    for nayak in [2.0, 12.0] {
        let moments = with_nayak(nayak);
        let refused = [mean_loop_loss_as_printed(&moments, &PAPER, None, A2), deng_kesari_loss_as_printed(&moments, &PAPER, 1e-7, PRINTED)];
        assert!(refused.iter().all(|r| matches!(r, Err(PhysicsError::Domain { quantity: "Nayak's parameter", .. }))), "{refused:?}");
        assert!(mean_loop_loss_as_printed(&moments, &PAPER, None, A3).is_ok());
    }
}
