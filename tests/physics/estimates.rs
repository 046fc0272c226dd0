//! Analytical estimates of a surface and of a cycle in one call each.

use crate::support::{LENGTH, PAPER, close, paper_spectrum};
use hysteron::model::{Material, Slip, Slips};
use hysteron::physics::jkr::Asperity;
use hysteron::physics::surface::SquareMap;
use hysteron::physics::surface::edges::Edges;
use hysteron::physics::surface::summits::{Summit, find_summits};
use hysteron::physics::surface::synthesis::{realization_seed, synthesize};
use hysteron::physics::theory::approximate_jkr::{CurvePoint, adhesive_curve, curve_loop};
use hysteron::physics::theory::estimates::{CycleEstimates, DengKesari, Ratios, Roughness, SurfaceEstimates};
use hysteron::physics::theory::flattening::{
    RelativeFlattening, flattening, measured_flattening, realised_flattening, shortest_wavelength,
};
use hysteron::physics::theory::{adhesionless_area, dalvi_loss, deng_kesari_loss_as_printed, pinning_loss};
use ndarray::Array2;

/// A generated surface with its heights, asperities and estimates.
fn generated(zeta: u32) -> (Array2<f64>, Vec<Summit>, SurfaceEstimates) {
    let (spectrum, seed) = (paper_spectrum(0.8, zeta), realization_seed(3, 0));
    let surface = synthesize(&spectrum, &seed, 8 * zeta as usize);
    let summits = find_summits(surface.heights_m.view(), LENGTH, 8.0).unwrap().list;
    let roughness = Roughness {
        rms_height_m: surface.moments.rms_height_m(),
        rms_slope: surface.moments.rms_slope(),
        rms_curvature_1_m: surface.moments.rms_curvature_1_m(),
    };
    let estimates = SurfaceEstimates::of_generated(&spectrum, &seed, roughness, summits.len());
    (surface.heights_m, summits, estimates)
}

/// Stiff enough for pinning to be defined.
fn adhesive() -> Material {
    Material { work_of_adhesion_j_m2: 10.0, ..PAPER }
}

/// Adhesionless curve of a sphere.
fn sphere() -> Vec<CurvePoint> {
    let point = |k: u32| {
        let penetration_m = 1e-9 * f64::from(k);
        let radius_m: f64 = 1e-5;
        let load_m2 = 4.0 / 3.0 * radius_m.sqrt() * penetration_m.powf(1.5);
        CurvePoint { penetration_m, load_m2, area_m2: std::f64::consts::PI * radius_m * penetration_m }
    };
    (0..400).map(point).collect()
}

#[test]
fn law_estimates_are_those_of_the_single_models() {
    let spectrum = paper_spectrum(0.8, 16);
    let (_, summits, surface) = generated(16);
    let material = adhesive();
    let all = CycleEstimates::of(&surface, Some(&spectrum), &summits, &material, &sphere()).unwrap();
    let (modulus, adhesion) = (material.contact_modulus_pa, material.work_of_adhesion_j_m2);
    let realised = realised_flattening(&spectrum, &realization_seed(3, 0), modulus);
    let relative = RelativeFlattening::realised(&spectrum, &realization_seed(3, 0));
    assert_eq!(relative.energies(modulus), realised);
    assert_eq!(all.ratios.persson_tosatti_realised, Some(realised.persson_tosatti(adhesion)));
    assert_eq!(all.ratios.conformity_realised, Some(realised.conformity(adhesion)));
    assert_eq!(all.ratios.sticky_line, Some(0.5 * realised.persson_tosatti(adhesion)));
    assert_eq!(all.ratios.conformity, Some(flattening(&spectrum, modulus).conformity(adhesion)));
    let nominal = LENGTH * LENGTH;
    assert_eq!(all.dalvi_nominal_j, dalvi_loss(&material, nominal));
    let pinning = pinning_loss(&material, realised.whole_j_m2, nominal).unwrap();
    close("pinning", all.pinning_nominal_j.unwrap(), pinning, 1e-15);
    let slips: Vec<Slips> = [vec![], vec![Slip::A2], vec![Slip::A3], vec![Slip::A2, Slip::A3]].into_iter().map(Slips::from_iter).collect();
    assert_eq!(slips, DengKesari::ERRATA, "the order of the columns");
    for (slips, found) in slips.into_iter().zip(all.deng_kesari_realised.nominal_j) {
        assert_eq!(found, deng_kesari_loss_as_printed(&surface.roughness.moments(), &material, nominal, slips).ok());
    }
    let losses: Vec<f64> = summits.iter().map(|summit| Asperity::new(summit.radius_m(), &material).unwrap().loop_loss()).collect();
    // The number of a merged contact does not count.
    assert_eq!(all.isolated_loss_j(&[0, 2, summits.len()]), losses[0] + losses[2]);
    let at = all.at_load(0.01);
    assert_eq!(at.area_adhesionless, adhesionless_area(0.01, surface.roughness.rms_slope));
    let load = 2e-9 / nominal;
    let wanted = curve_loop(&adhesive_curve(&sphere(), material.adhesion_length_m()), load * nominal);
    assert_eq!(all.at_load(load).jkr_curve, wanted);
    let tabor = all.tabor.unwrap();
    assert!(tabor.min <= tabor.median && tabor.median <= tabor.max && (tabor.min..tabor.max).contains(&tabor.mean));
}

#[test]
fn law_estimates_of_heights_are_those_of_the_modes_that_made_them() {
    let (heights, summits, of_modes) = generated(16);
    let cut_off = LENGTH / 16.0 * (1.0 + 1e-12);
    let map = SquareMap { heights_m: heights.view(), length_m: LENGTH, edges: Edges::Periodic };
    let found = SurfaceEstimates::of_measured(map, cut_off, of_modes.roughness, summits.len()).unwrap();
    let (a, b) = (found.flattening.energies(PAPER.contact_modulus_pa), of_modes.flattening.energies(PAPER.contact_modulus_pa));
    close("all roughness", a.whole_j_m2, b.whole_j_m2, 1e-10);
    close("shortest octave", a.octave_j_m2, b.octave_j_m2, 1e-10);
    let shortest = shortest_wavelength(map, cut_off).unwrap();
    assert_eq!(found.flattening, RelativeFlattening::measured(map, shortest).unwrap());
    assert_eq!(measured_flattening(map, shortest, PAPER.contact_modulus_pa).unwrap(), a);
    assert_eq!((found.shortest_wavelength_m, found.per_shortest_wavelength(3.0)), (cut_off, 3.0));
    let longer = SurfaceEstimates { shortest_wavelength_m: 4.0 * cut_off, ..found };
    assert_eq!(longer.per_shortest_wavelength(3.0), 12.0);
}

#[test]
fn law_estimates_follow_a_change_of_units() {
    let (length, force) = (8.0, 32.0);
    let spectrum = paper_spectrum(0.8, 16);
    let (_, summits, surface) = generated(16);
    let scaled_spectrum = hysteron::physics::surface::spectrum::Spectrum {
        length_m: length * spectrum.length_m,
        rms_height_m: length * spectrum.rms_height_m,
        ..spectrum.clone()
    };
    let rough = surface.roughness;
    let roughness = Roughness { rms_height_m: length * rough.rms_height_m, rms_curvature_1_m: rough.rms_curvature_1_m / length, ..rough };
    let scaled = SurfaceEstimates::of_generated(&scaled_spectrum, &realization_seed(3, 0), roughness, summits.len());
    let larger = |summit: &Summit| Summit { height_m: length * summit.height_m, curvature_1_m: summit.curvature_1_m / length, ..*summit };
    let larger: Vec<Summit> = summits.iter().map(larger).collect();
    let material = adhesive();
    let other = Material {
        contact_modulus_pa: material.contact_modulus_pa * force / length.powi(2),
        work_of_adhesion_j_m2: material.work_of_adhesion_j_m2 * force / length,
        interaction_range_m: length * material.interaction_range_m,
    };
    let a = CycleEstimates::of(&surface, Some(&spectrum), &summits, &material, &[]).unwrap();
    let b = CycleEstimates::of(&scaled, Some(&scaled_spectrum), &larger, &other, &[]).unwrap();
    close("ratio", b.ratios.persson_tosatti_realised.unwrap(), a.ratios.persson_tosatti_realised.unwrap(), 1e-13);
    close("Fuller-Tabor", b.fuller_tabor.unwrap(), a.fuller_tabor.unwrap(), 1e-13);
    close("Tabor", b.tabor.unwrap().mean, a.tabor.unwrap().mean, 1e-13);
    let energy = force * length;
    close("Dalvi", b.dalvi_nominal_j, energy * a.dalvi_nominal_j, 1e-13);
    close("pinning", b.pinning_nominal_j.unwrap(), energy * a.pinning_nominal_j.unwrap(), 1e-13);
    let of = |all: &CycleEstimates| all.deng_kesari.unwrap().nominal_j[0].unwrap();
    close("Deng-Kesari", of(&b), energy * of(&a), 1e-13);
    close("isolated", b.isolated_loss_j(&[0, 1]), energy * a.isolated_loss_j(&[0, 1]), 1e-13);
    close("density", scaled.summit_density_1_m2(), surface.summit_density_1_m2() / length.powi(2), 1e-15);
}

#[test]
fn lim_without_adhesion_no_ratio_is_known() {
    let spectrum = paper_spectrum(0.8, 16);
    let (_, summits, surface) = generated(16);
    let material = Material { work_of_adhesion_j_m2: 0.0, ..PAPER };
    let all = CycleEstimates::of(&surface, Some(&spectrum), &summits, &material, &[]).unwrap();
    assert_eq!(all.ratios, Ratios::default());
    assert_eq!((all.fuller_tabor, all.pinning_nominal_j, all.dalvi_nominal_j), (None, None, 0.0));
    assert_eq!(all.at_load(0.01).jkr_curve, None);
    let none = CycleEstimates::of(&surface, None, &[], &PAPER, &[]).unwrap();
    assert_eq!((none.tabor, none.fuller_tabor, none.deng_kesari), (None, None, None));
}
