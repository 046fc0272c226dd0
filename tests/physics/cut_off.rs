//! Roughness over the cut-off wavelength, works of adhesion of models, and Deng and Kesari's loss of a probe.

use crate::support::{LENGTH, PAPER, close, paper_spectrum};
use hysteron::model::{Material, Slips};
use hysteron::physics::surface::SquareMap;
use hysteron::physics::surface::edges::Edges;
use hysteron::physics::surface::shape::Shape;
use hysteron::physics::surface::spectrum::{Moments, Spectrum};
use hysteron::physics::surface::synthesis::{realization_seed, synthesize};
use hysteron::physics::theory::cut_off::{
    LongWaves, PER_DECADE, continuous_long_waves, cut_offs, measured_long_waves, realised_long_waves,
};
use hysteron::physics::theory::estimates::DengKesari;
use hysteron::physics::theory::flattening::{flattening, realised_flattening};
use hysteron::physics::theory::probe_loss::{ProbeAreas, deng_kesari_probe_loss};
use hysteron::physics::theory::regime::effective_adhesion;
use hysteron::physics::theory::works::{PINNING_BAND, dalvi_closing, pinning_works};
use hysteron::physics::theory::{deng_kesari_loss, deng_kesari_loss_as_printed, pinning_loss};
use std::f64::consts::PI;

const MOMENTS: Moments = Moments { m0_m2: 2.5e-11, m2: 8e-3, m4_1_m2: 2e8 };

#[test]
fn val_cut_offs_are_powers_of_ten_between_the_ends() {
    let found = cut_offs(1e-3, 6.25e-5);
    // 1e-3 itself is 10^(-24/8); 6.25e-5 is not a power, and lies below 10^(-33/8) = 7.499e-5.
    assert_eq!((found.len(), found[0], found[found.len() - 1]), (11, 1e-3, 6.25e-5));
    for (k, wavelength) in found[1..10].iter().enumerate() {
        close("power", *wavelength, 10f64.powf(-3.0 - (k as f64 + 1.0) / f64::from(PER_DECADE)), 1e-12);
    }
    assert!(cut_offs(1e-3, 2e-3).is_empty() && cut_offs(1e-3, 0.0).is_empty() && cut_offs(f64::INFINITY, 1.0).is_empty());
    assert_eq!(cut_offs(1e-3, 1e-3), [1e-3]);
}

#[test]
fn val_sums_of_the_realised_spectrum() {
    // numpy, a direct sum over the lattice: P = K^(-2(H + 1)) of |K| in [1, 16), scaled to h_rms = 5 um.
    let want = [
        (1e-3, 3.859155412817643e-6, 0.024247788587938385, 2.3393996144500075e-8),
        (10f64.powf(-3.5), 4.8116746530736905e-6, 0.042932889030818266, 4.778404506564955e-8),
        (1e-4, 4.980978579680475e-6, 0.062205039205065045, 6.162178243441327e-8),
        (LENGTH / 16.0, 5e-6, 0.07098956006448251, 6.531522301308403e-8),
    ];
    let at: Vec<f64> = want.iter().map(|row| row.0).collect();
    let (spectrum, seed) = (paper_spectrum(0.8, 16), realization_seed(3, 0));
    let found = realised_long_waves(&spectrum, &seed, &at);
    let heights = synthesize(&spectrum, &seed, 128).heights_m;
    let map = SquareMap { heights_m: heights.view(), length_m: LENGTH, edges: Edges::Periodic };
    // The last mode is below the cut-off by 1/512 of it.
    let measured = measured_long_waves(map, &at).unwrap();
    for ((of, from_heights), (cut_off, height, slope, energy)) in found.iter().zip(&measured).zip(want) {
        // Sums of some hundred modes: rounding. Heights pass through two transforms.
        for (of, tolerance) in [(of, 1e-12), (from_heights, 1e-10)] {
            assert_eq!(of.cut_off_m, cut_off);
            close("rms height", of.rms_height_m, height, tolerance);
            close("rms slope", of.rms_slope, slope, tolerance);
            close("flattening", of.flattening_m, energy, tolerance);
        }
    }
    let whole = realised_flattening(&spectrum, &seed, PAPER.contact_modulus_pa).whole_j_m2;
    close("all roughness", found[3].energy_j_m2(PAPER.contact_modulus_pa), whole, 1e-13);
}

#[test]
fn val_the_continuous_spectrum_in_closed_form() {
    // Python: h_rms² ratio, (π/2) C0 qL³ (x^(1-2H) - 1)/(1 - 2H) and the slope's integral, x = L/λc.
    let want = [
        (5e-4, 4.117503491153417e-6, 3.605745814942139e-8, 0.03572789081711093),
        (1e-4, 4.966295307662499e-6, 7.935502730696633e-8, 0.07771881238500034),
    ];
    let spectrum = paper_spectrum(0.8, 16);
    for (cut_off, height, energy, slope) in want {
        let of = continuous_long_waves(&spectrum, &[cut_off])[0];
        close("rms height", of.rms_height_m, height, 1e-12);
        close("flattening", of.flattening_m, energy, 1e-12);
        close("rms slope", of.rms_slope, slope, 1e-12);
    }
    let all = continuous_long_waves(&spectrum, &[LENGTH / 16.0])[0];
    close("all roughness", all.flattening_m, flattening(&spectrum, 1.0).whole_j_m2, 1e-12);
    close("slope", all.rms_slope, spectrum.moments().rms_slope(), 1e-12);
    // With a plateau, the wavelengths of the plateau alone: C = C(q_r), so U/E* = (π/6) C (q³ - qL³).
    let shape = Shape { roll_off_m: Some(LENGTH / 4.0), ..Shape::default() };
    let plateau = Spectrum { shape, ..paper_spectrum(0.8, 16) };
    let [a, b] = [2.0, 3.0].map(|k: f64| continuous_long_waves(&plateau, &[LENGTH / k])[0].flattening_m);
    close("plateau", b / a, 26.0 / 7.0, 1e-12);
}

#[test]
fn law_long_waves_grow_and_scale() {
    let (spectrum, seed) = (paper_spectrum(0.65, 32), realization_seed(7, 1));
    let at = cut_offs(LENGTH, LENGTH / 32.0);
    let found = realised_long_waves(&spectrum, &seed, &at);
    assert!(found.windows(2).all(|pair| pair[0].flattening_m <= pair[1].flattening_m && pair[0].rms_slope <= pair[1].rms_slope));
    let other = Spectrum { length_m: 8.0 * LENGTH, rms_height_m: 8.0 * spectrum.rms_height_m, ..spectrum };
    let scaled_at: Vec<f64> = at.iter().map(|cut_off| 8.0 * cut_off).collect();
    for (a, b) in found.iter().zip(realised_long_waves(&other, &seed, &scaled_at)) {
        let LongWaves { rms_height_m, rms_slope, flattening_m, .. } = b;
        close("height", rms_height_m, 8.0 * a.rms_height_m, 1e-13);
        close("slope", rms_slope, a.rms_slope, 1e-13);
        close("flattening", flattening_m, 8.0 * a.flattening_m, 1e-13);
    }
}

#[test]
fn val_works_of_the_models_by_hand() {
    let [low, high] = PINNING_BAND;
    assert!(low < 1.35 && 1.35 < high, "the prefactor of loss_pinning is in the band");
    // Δγ = 2 mJ/m², U_el = 0.3 mJ/m²: 2 ∓ 1.2 · 0.3 = 1.64 and 2.36.
    let [closing, opening] = pinning_works(2e-3, 3e-4, 1.2).unwrap();
    close("closing", closing, 1.64e-3, 1e-14);
    close("opening", opening, 2.36e-3, 1e-14);
    // k U_el = Δγ/2 at U_el = 1/3 mJ/m² with k = 3.
    assert!(pinning_works(2e-3, 3.33e-4, 3.0).is_some() && pinning_works(2e-3, 3.34e-4, 3.0).is_none());
    // The difference of both works is the dissipated energy per area, 2 k U_el.
    let material = Material { work_of_adhesion_j_m2: 2e-3, ..PAPER };
    let [closing, opening] = pinning_works(2e-3, 3e-4, 1.35).unwrap();
    close("loss", (opening - closing) * 1e-6, pinning_loss(&material, 3e-4, 1e-6).unwrap(), 1e-13);
    close("Dalvi", dalvi_closing(2e-3, 6e-4).unwrap(), 1.4e-3, 1e-14);
    assert!(dalvi_closing(2e-3, 2e-3).is_none() && dalvi_closing(0.0, 1e-4).is_none());
    // The area term is all that distinguishes Persson and Tosatti: Δγ h'²/2.
    let gained = effective_adhesion(2e-3, 0.1, 6e-4).unwrap() - dalvi_closing(2e-3, 6e-4).unwrap();
    close("area", gained, 2e-3 * 0.005, 1e-11);
}

#[test]
fn val_deng_and_kesari_with_a_tip() {
    // scipy.integrate.quad of Eq A3 in t = -y³, relative tolerance 1e-13; m0 = 2.5e-11 m², m2 = 8e-3, m4 = 2e8 1/m².
    let want = [(1e-5, 0.0010815882017999785), (1e-4, 0.007149843955847071), (1e-3, 0.01251082268464191), (1e-2, 0.013531177230583684)];
    for (radius, loss) in want {
        // Five-point Gauss on 48 panels: 1e-9 of the integral where it bends at |t| = 1/(R sqrt(m4/3)) of 0.01 and more.
        close("loss per area", deng_kesari_probe_loss(&MOMENTS, &PAPER, radius, Slips::NONE).unwrap(), loss, 1e-8);
    }
    // JKR: brentq of the load for F = 2 mN, and π (2π R² Δγ/E*)^(2/3).
    let areas = ProbeAreas::of(1e-3, &PAPER, 2e-3).unwrap().unwrap();
    close("area", areas.reversal_m2, 6.977255508529556e-8, 1e-11);
    close("jump into contact", areas.jump_in_m2, 1.816917236480655e-8, 1e-12);
    close("swept", areas.swept_m2(), 6.977255508529556e-8 - 1.816917236480655e-8, 1e-11);
    // Below the pull-off force there is no contact; between it and the jump into contact none is swept.
    let pull_off = -1.5 * PI * 1e-3 * PAPER.work_of_adhesion_j_m2;
    assert!(ProbeAreas::of(1e-3, &PAPER, 1.01 * pull_off).unwrap().is_none());
    assert_eq!(ProbeAreas::of(1e-3, &PAPER, 0.99 * pull_off).unwrap().unwrap().swept_m2(), 0.0);
    assert!(ProbeAreas::of(0.0, &PAPER, 1e-3).is_err());
}

#[test]
fn lim_a_large_probe_has_the_loss_of_flat_surfaces() {
    let flat = deng_kesari_loss(&MOMENTS, &PAPER, 1.0).unwrap();
    // ⟨|t|^(-4/3)⟩ = 0.3477377 of the closed form, all seven digits.
    let unit: f64 = 2.0 * 0.526_220_315_590_459_8 * PAPER.contact_modulus_pa.powf(-2.0 / 3.0) * (PI * 0.07).powf(5.0 / 3.0);
    let mean = unit * (MOMENTS.m4_1_m2 / 3.0).powf(-2.0 / 3.0) * 0.347_737_7;
    close("closed form", flat, MOMENTS.summit_density_1_m2() * mean, 2e-7);
    // 1/(R sqrt(m4/3)) = 1.2e-11 at 1e7 m.
    close("large", deng_kesari_probe_loss(&MOMENTS, &PAPER, 1e7, Slips::NONE).unwrap(), flat, 1e-9);
}

#[test]
fn law_the_loss_of_a_probe_scales() {
    let (length, force) = (8.0, 32.0);
    let other = Moments { m0_m2: MOMENTS.m0_m2 * length * length, m4_1_m2: MOMENTS.m4_1_m2 / (length * length), ..MOMENTS };
    let material = Material {
        contact_modulus_pa: PAPER.contact_modulus_pa * force / (length * length),
        work_of_adhesion_j_m2: PAPER.work_of_adhesion_j_m2 * force / length,
        interaction_range_m: PAPER.interaction_range_m * length,
    };
    let loss = |moments, material, radius| deng_kesari_probe_loss(moments, material, radius, Slips::NONE).unwrap();
    close("loss per area", loss(&other, &material, 8e-3), loss(&MOMENTS, &PAPER, 1e-3) * force / length, 1e-12);
    let areas = |radius, material, load| ProbeAreas::of(radius, material, load).unwrap().unwrap();
    let (a, b) = (areas(1e-3, &PAPER, 2e-3), areas(8e-3, &material, 32.0 * 2e-3));
    close("area", b.reversal_m2, 64.0 * a.reversal_m2, 1e-12);
    close("jump into contact", b.jump_in_m2, 64.0 * a.jump_in_m2, 1e-12);
    // All four variants of the errata, for the area of the square.
    let found = DengKesari::of_probe(&MOMENTS, &PAPER, 1e-6, 1e7).unwrap().nominal_j;
    for (slips, value) in DengKesari::ERRATA.into_iter().zip(found) {
        let flat = deng_kesari_loss_as_printed(&MOMENTS, &PAPER, 1e-6, slips).unwrap();
        // The printed curvature has sqrt(|t|): 1/R is a larger part of it.
        close("errata", value.unwrap(), flat, 1e-8);
    }
}
