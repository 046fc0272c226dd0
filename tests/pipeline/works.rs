//! Works of adhesion of models over the cut-off wavelength, Deng and Kesari's loss of a probe, and loads in the unit of the spec.

use hysteron::model::{Material, Slips};
use hysteron::physics::surface::spectrum::Moments;
use hysteron::physics::theory::probe_loss::{ProbeAreas, deng_kesari_probe_loss};
use hysteron::schema::{CASES, CUTOFF, REALIZATIONS, SPECTRA, Table};
use hysteron::stats::significant;
use hysteron::store::Frame;
use hysteron::store::parquet::read_table;
use std::fs;

use crate::bench::{Bench, code, stderr, stdout};

/// Two cases with U_el/Δγ of 0.9, so that pinning is defined for the longest wavelengths alone.
const FLAT: &str = "name = \"flat\"
seed = 3
realizations = 2
[material]
work_of_adhesion_j_m2 = 0.07
[cycle]
max_pressure_pa = [1000.0, 2000.0]
approach_step = 0.05
[[sweep]]
name = \"zeta\"
surface.magnification = [6, 8]
";

fn table(bench: &Bench, table: &'static Table) -> Frame {
    read_table(&bench.out().join(table.file), table).unwrap()
}

fn column(frame: &Frame, name: &str) -> Vec<f64> {
    frame.f64_or_null(name).unwrap().iter().map(|value| value.unwrap_or(f64::NAN)).collect()
}

fn within(what: &str, got: f64, want: f64, relative: f64) {
    assert!((got - want).abs() <= relative * want.abs(), "{what}: {got:e}, {want:e}");
}

/// The terminal prints the column of all roughness under its equation.
fn prints_the_column(text: &str, cutoff: &Frame, cases: &Frame) {
    let ids = cutoff.text("case_id").unwrap();
    let last = |id: &&str| ids.iter().rposition(|other| other == id).unwrap();
    let rows: Vec<usize> = cases.text("case_id").unwrap().iter().map(last).collect();
    let range = |name: &str| {
        let works = column(cutoff, name);
        let ends = rows.iter().map(|row| 1e3 * works[*row]).fold([f64::INFINITY, 0.0], |[low, high], work| [low.min(work), high.max(work)]);
        ends.map(|work| significant(work, 3)).join(" to ")
    };
    let printed = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let wanted = format!(
        "Persson-Tosatti, closing and opening: Δγ (1 + h'²/2) - U_el = {} mJ/m²; h': rms slope.",
        range("work_persson_tosatti_j_m2")
    );
    assert!(printed.contains(&wanted), "{wanted}: {text}");
    assert_ne!(range("work_persson_tosatti_j_m2"), range("work_dalvi_closing_j_m2"), "the area of the slope shows");
}

#[test]
fn e2e_models_over_the_cut_off() {
    let bench = Bench::new(FLAT);
    let run = bench.verb("run", &[]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    let (cutoff, cases) = (table(&bench, &CUTOFF), table(&bench, &CASES));
    let ids = cutoff.text("case_id").unwrap();
    let of = |name: &str| column(&cutoff, name);
    let (energy, below, ratio) = (of("flattening_j_m2"), of("flattening_below_j_m2"), of("flattening_ratio"));
    for (row, id) in cases.text("case_id").unwrap().iter().enumerate() {
        let own: Vec<usize> = (0..ids.len()).filter(|k| ids[*k] == *id).collect();
        let (first, last) = (own[0], own[own.len() - 1]);
        // The last row has all roughness: the ratio of the table `cases`, a sum over the modes in another order.
        within("all roughness", ratio[last], column(&cases, "persson_tosatti_realised_mean")[row], 1e-12);
        assert_eq!(below[last], 0.0);
        within("both parts", energy[first] + below[first], energy[last], 1e-12);
        assert_eq!(of("cut_off_m")[first], 1e-3);
        within("shortest", of("cut_off_m")[last], 1e-3 / column(&cases, "magnification")[row], 1e-12);
        assert!(own.iter().all(|k| cutoff.i64("surface_count").unwrap()[*k] == 2));
        for k in own {
            let (work, h) = (0.07, of("rms_slope")[k]);
            within("Persson-Tosatti", of("work_persson_tosatti_j_m2")[k], work * (1.0 + 0.5 * h * h) - energy[k], 1e-12);
            within("Dalvi", of("work_dalvi_closing_j_m2")[k], work - energy[k], 1e-12);
            // Null where k U_el >= Δγ/2.
            let (low, high) = (of("work_pinning_closing_low_j_m2")[k], of("work_pinning_opening_high_j_m2")[k]);
            assert_eq!(low.is_nan(), 3.0 * energy[k] >= 0.5 * work);
            if !low.is_nan() {
                within("band", 0.5 * (high - low), 3.0 * energy[k], 1e-12);
                within(
                    "band",
                    0.5 * (of("work_pinning_opening_low_j_m2")[k] - of("work_pinning_closing_high_j_m2")[k]),
                    1.2 * energy[k],
                    1e-12,
                );
            }
        }
    }
    // Fixed amplitudes: the surfaces of a case have one spectrum.
    assert!(of("flattening_sd_j_m2").iter().all(|sd| *sd < 1e-15));
    let files: Vec<_> = fs::read_dir(bench.out().join("spectra")).unwrap().map(|entry| entry.unwrap().path()).collect();
    assert_eq!(files.len(), 4);
    let spectra = read_table(&files[0], &SPECTRA).unwrap();
    let heights = column(&spectra, "rms_height_m");
    within("rms height", heights[heights.len() - 1], 5e-6, 1e-12);
    let report = fs::read_to_string(bench.out().join("report.html")).unwrap();
    assert!(report.contains("Works of adhesion and the models") && bench.out().join("figures/works_2.svg").is_file());
    // Loads are in pascals, as in the spec.
    let text = stdout(&run);
    assert!(text.contains("maximum nominal pressure") && text.contains(" 1 kPa") && text.contains(" 2 kPa"), "{text}");
    prints_the_column(&text, &cutoff, &cases);
    assert!(text.lines().all(|line| line.chars().count() <= 80 || line.contains('/')), "{text}");
    assert!(report.contains("F<sub>max</sub>/A<sub>0</sub>"));
    for (pressure, force) in column(&cases, "max_load_pa").iter().zip(column(&cases, "max_load_n")) {
        within("force", force, pressure * 1e-6, 1e-12);
    }
    assert!(cases.text("load_unit").unwrap().iter().all(|unit| *unit == "Pa"));
}

#[test]
fn e2e_deng_and_kesari_of_a_probe() {
    let spec = "name = \"sphere\"\nrealizations = 1\n[surface]\nlength_m = 4e-5\nrms_height_m = 1e-7\nmagnification = 8\n\
                [material]\nwork_of_adhesion_j_m2 = 0.03\n[probe]\nradius_m = 2e-5\n[cycle]\nmax_force_n = [2e-6]\n";
    let bench = Bench::new(spec);
    let run = bench.verb("run", &["--until", "aggregate"]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    let frame = table(&bench, &REALIZATIONS);
    let of = |name: &str| column(&frame, name)[0];
    within("newtons", of("max_load_n"), 2e-6, 1e-12);
    within("pascals", of("max_load_pa"), 2e-6 / 1.6e-9, 1e-12);
    // A_in = π (2π R² Δγ/E*)^(2/3) of the sphere, over A0.
    let jump_in = std::f64::consts::PI * (std::f64::consts::TAU * 4e-10 * 0.03 / 1e6_f64).powf(2.0 / 3.0) / 1.6e-9;
    within("A_in", of("area_jkr_jump_in"), jump_in, 1e-11);
    let material = Material { contact_modulus_pa: 1e6, work_of_adhesion_j_m2: 0.03, ..Material::default() };
    let moments = Moments::of_rms(1e-7, of("rms_slope"), of("rms_curvature_1_m"));
    let areas = ProbeAreas::of(2e-5, &material, 2e-6).unwrap().unwrap();
    within("A_max", of("area_jkr_probe"), areas.reversal_m2 / 1.6e-9, 1e-11);
    let loss_j = deng_kesari_probe_loss(&moments, &material, 2e-5, Slips::NONE).unwrap() * areas.swept_m2();
    within("loss", of("loss_dk_probe_realised"), loss_j / (1e6 * 1.6e-9 * 1e-7), 1e-9);
    within("ratio", of("loss_ratio_dk"), of("loss") / of("loss_dk_probe"), 1e-12);
    // The tip makes asperities sharper: less than the estimate of flat surfaces for the same area.
    assert!(of("loss_dk_probe") < of("loss_dk") * (of("area_jkr_probe") - of("area_jkr_jump_in")) / of("area_at_max_load"));
    within("joules", of("work_opening_j") - of("work_closing_j"), of("loss_j"), 1e-9);
    within("joules", of("work_closing_j"), of("work_closing_j_m2") * 1.6e-9, 1e-12);
    let text = stdout(&run);
    assert!(text.contains(" 2 µN ") && text.contains("R_tip = R"), "{text}");
}
