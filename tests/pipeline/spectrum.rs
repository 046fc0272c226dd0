//! Surfaces with a roll-off, anisotropy or a tabulated spectrum: specs, refusals and runs.

use crate::bench::{Bench, code, stderr, stdout};
use crate::cli::hysteron;
use hysteron::campaign::Campaign;
use hysteron::schema;
use hysteron::spec::Spec;
use hysteron::store::Frame;
use hysteron::store::parquet::read_table;
use std::f64::consts::{PI, TAU};
use std::fs;
use std::path::Path;

const LENGTH: f64 = 1e-5;

/// Spec of a table, with more lines of `[surface]`.
fn spec(lines: &str) -> String {
    format!(
        "name = \"psd\"\nseed = 3\nrealizations = 2\n[surface]\nlength_m = 1e-5\nmagnification = 8\nspectrum = \"psd.csv\"\n{lines}\n\
         [material]\ncontact_modulus_pa = 1e9\nwork_of_adhesion_j_m2 = 0.02\n[model]\nallow_low_tabor = true\n\
         [cycle]\nmax_load = [0.002]\napproach_step = 0.05\n"
    )
}

/// Rows of a smooth roll-off, in the convention of this program: 12 a decade.
fn rows(last: f64) -> Vec<[f64; 2]> {
    let (from, count) = (0.9 * TAU / LENGTH, 40);
    let at = |k: usize| from * (last / from).powf(k as f64 / f64::from(count));
    (0..=count as usize).map(at).map(|q| [q, 3e-30 / (1.0 + (q / 2e6).powi(2)).powf(1.9)]).collect()
}

fn table(heading: &str, rows: impl IntoIterator<Item = [f64; 2]>) -> String {
    let line = |[q, c]: [f64; 2]| format!("{q:e},{c:e}\n");
    format!("{heading}\n{}", rows.into_iter().map(line).collect::<String>())
}

const PLAIN: &str = "spectrum_convention = \"plain\"";
/// Last wavenumber of the tables: λ1 is 1.25 µm.
const LAST: f64 = 1e8;

fn bench(lines: &str, table: &str) -> Bench {
    let bench = Bench::new(&spec(lines));
    fs::write(bench.folder.path().join("psd.csv"), table).unwrap();
    bench
}

/// Rms height and reading of the first case.
fn read(bench: &Bench) -> (f64, String) {
    let spec = Spec::read(bench.spec()).unwrap_or_else(|errors| panic!("{errors}"));
    let surface = spec.cases[0].params.surface.generated().unwrap().clone();
    assert_eq!(surface.rms_height_m, surface.spectrum().moments().rms_height_m());
    (surface.rms_height_m, surface.tabulated.reading)
}

/// A wrapped text on one line.
fn flat(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn cases(bench: &Bench) -> Frame {
    read_table(&bench.out().join("statistics/cases.parquet"), &schema::CASES).unwrap()
}

#[test]
fn e2e_bad_tables_are_refused_at_their_line() {
    let good = "1e5,1e-29\n2e5,1e-30\n";
    let many = table("q_1_m,c_m4", rows(LAST));
    let refused = [
        (PLAIN, format!("q_1_m,c_m4\n{good}4e5,-1e-31\n"), "line 4: C is -1e-31"),
        (PLAIN, format!("q_1_m,c_m4\n{good}4e5,0\n"), "line 4: C is 0e0"),
        (PLAIN, format!("# a comment\n\nq_1_m,c_m4\n{good}4e5,nan\n"), "line 6: C is NaN"),
        (PLAIN, format!("q_1_m,c_m4\n{good}4e5,\n"), "line 4: no value of C"),
        (PLAIN, format!("q_1_m,c_m4\n{good}4e5,x\n"), "line 4: C is \"x\""),
        (PLAIN, format!("q_1_m,c_m4\n{good}1.5e5,1e-31\n"), "line 4: q is smaller"),
        (PLAIN, format!("q_1_m,c_m4\n{good}2e5,1e-31\n"), "line 4: the q of the row before it occurs twice"),
        (PLAIN, format!("q_1_m,c_m4\n{good}9e5,1e-31\n"), "line 4: gap: q is 4.500 times"),
        (PLAIN, format!("q_1_m,c_m4\n{good}"), "it covers wavelengths from 3.142e-5 to 6.283e-5 m"),
        (PLAIN, "q_1_m,c_m4\n".to_owned(), "0 rows"),
        (PLAIN, String::new(), "no two columns"),
        (PLAIN, format!("q,C\n{good}"), "units missing"),
        (PLAIN, format!("{good}4e5,1e-31\n"), "units missing"),
        (PLAIN, format!("q (um),C (um^4)\n{good}"), "not an inverse length"),
        (PLAIN, format!("q (1/um),C (um^2)\n{good}"), "to the power 2"),
        (PLAIN, format!("wavelength (m),C (m^4)\n{good}"), "over q = 2π/λ"),
        (PLAIN, format!("a,b,c\n1,2,3\n{good}"), "no column of the wavenumber q"),
        ("spectrum_convention = \"one_sided\"", many.clone(), "one_sided"),
        ("", many.clone(), "unknown normalization"),
        (&format!("{PLAIN}\nspectrum_unit = \"m\""), many.clone(), "surface.spectrum_unit is set"),
        (&format!("{PLAIN}\nspectrum_kind = \"profile\""), many.clone(), "to the power 4"),
        (&format!("{PLAIN}\nspectrum_series = \"x\""), many, "no column \"Data series\""),
        (&format!("{PLAIN}\naspect_ratio = 2"), table("q_1_m,c_m4", rows(6e6)), "it covers"),
        (PLAIN, table("q_1_m,c_m3", [[5e5, 1e-22], [1e6, 4e-22], [4e6, 3.9e-22], [8e6, 1e-23]]), "line 2: Abel"),
        (PLAIN, table("q_1_m,c_m3", [[5e5, 1e-22], [1e6, 2e-22]]), "line 3: the spectrum of a profile"),
    ];
    for (lines, text, words) in refused {
        let bench = bench(lines, &text);
        for verb in ["plan", "run"] {
            let found = bench.verb(verb, &[]);
            let said = stderr(&found);
            assert_eq!(code(&found), 2, "{text}: {said}");
            assert!(said.starts_with("error: ") && said.contains(words) && said.contains("help: "), "{words}: {said}");
            assert!(said.contains("spec.toml:7:"), "{said}");
        }
        assert!(!bench.out().exists(), "{words}");
    }
    // Bytes that are no text.
    let bench = bench(PLAIN, "");
    fs::write(bench.folder.path().join("psd.csv"), b"PK\x03\x04\xff\xfe").unwrap();
    assert!(stderr(&bench.verb("plan", &[])).contains("not a text"));
    fs::remove_file(bench.folder.path().join("psd.csv")).unwrap();
    assert!(stderr(&bench.verb("plan", &[])).contains("cannot be read"));
}

#[test]
fn val_units_conventions_and_kinds_give_one_spectrum() {
    let expected = read(&bench(PLAIN, &table("q_1_m,c_m4", rows(LAST)))).0;
    let two_pi = "spectrum_convention = \"two_pi\"";
    let four = 4.0 * PI * PI;
    let scaled = |heading: &str, q: f64, c: f64| table(heading, rows(LAST).into_iter().map(|[a, b]| [q * a, c * b]));
    let over_q = |heading: &str, c: f64| table(heading, rows(LAST).into_iter().map(|[a, b]| [a, c * a * b]));
    let semicolons = scaled("q [1/µm];C(q) [µm⁴]", 1e-6, 1e24).replace(',', ";");
    let same = [
        (two_pi.to_owned(), scaled("Wavevector (m⁻¹),PSD (m⁴)", 1.0, four)),
        (PLAIN.to_owned(), semicolons),
        (PLAIN.to_owned(), scaled("# q (1/nm)  C (nm^4)", 1e-9, 1e36).replace(',', " ")),
        (format!("{PLAIN}\nspectrum_unit = \"um\"\nspectrum_kind = \"isotropic\""), scaled("q,C", 1e-6, 1e24)),
        (format!("{two_pi}\nspectrum_kind = \"q_over_pi\""), over_q("q_1_m,c_m3", four / PI)),
        (format!("{PLAIN}\nspectrum_kind = \"q_over_pi\""), over_q("q_1_m,c_m3", 2.0)),
        ("spectrum_convention = \"one_sided\"\nspectrum_kind = \"q_over_pi\"".to_owned(), over_q("q_1_m,c_m3", 8.0 * PI)),
    ];
    for (lines, text) in same {
        let (found, reading) = read(&bench(&lines, &text));
        assert!((found / expected - 1.0).abs() < 1e-12, "{lines}: {found} for {expected}");
        assert!(!reading.is_empty());
    }
    // A pure power law C = q^(-3) has the two-sided profile 2/q²: ∫ C1 dq over both signs is the integral over d²q.
    let law = |c: fn(f64) -> f64| rows(LAST).into_iter().map(move |[q, _]| [q, 1e-10 * c(q)]);
    let expected = read(&bench(PLAIN, &table("q_1_m,c_m4", law(|q| q.powi(-3))))).0;
    for (convention, factor) in [("plain", 1.0), ("two_pi", TAU), ("one_sided", 2.0 * TAU)] {
        let text = table("q_1_m,c_m3", law(|q| 2.0 * q.powi(-2)).map(|[q, c]| [q, factor * c]));
        let (found, reading) = read(&bench(&format!("spectrum_convention = \"{convention}\""), &text));
        // The quadrature of Abel's inversion.
        assert!((found / expected - 1.0).abs() < 1e-9, "{convention}: {found} for {expected}");
        assert!(reading.contains("Abel"), "{reading}");
    }
}

/// A table as contact.engineering exports it: headings of topobank 1.x.
fn contact_engineering() -> String {
    let mut text = "Subject type;Subject name;Creator;Instrument name;Instrument type;Instrument parameters;Function name;\
                    Data series;Wavevector (m⁻¹);PSD (m³);standard error of PSD (m³);comment\n"
        .to_owned();
    for [q, c] in rows(LAST) {
        text += &format!("measurement;scan;A. B.;AFM;afm;\"{{'resolution': 1}}\";Power spectrum;1D PSD along x;{q:e};{:e};;\n", c * q);
    }
    for [q, c] in rows(LAST) {
        text += &format!("measurement;scan;A. B.;AFM;afm;;Power spectrum;q/π × 2D PSD;{q:e};{:e};;\n", 4.0 * PI * c * q);
    }
    text
}

#[test]
fn val_a_table_of_contact_engineering_states_its_convention() {
    let text = contact_engineering();
    let several = bench("", &text);
    assert!(stderr(&several.verb("plan", &[])).contains("\"scan: 1D PSD along x\", \"scan: q/π × 2D PSD\""));
    let expected = read(&bench(PLAIN, &table("q_1_m,c_m4", rows(LAST)))).0;
    for name in ["q/π × 2D PSD", "scan: q/π × 2D PSD"] {
        let (found, reading) = read(&bench(&format!("spectrum_series = \"{name}\""), &text));
        // Sixteen digits in the file.
        assert!((found / expected - 1.0).abs() < 1e-12, "{found} for {expected}");
        assert_eq!(reading, "q_over_pi, two_pi, C1 = q C/π");
    }
    let unknown = bench("spectrum_series = \"autocorrelation\"", &text);
    assert!(stderr(&unknown.verb("plan", &[])).contains("0 data series"));
}

#[test]
fn e2e_a_table_makes_surfaces_of_its_spectrum() {
    let bench = bench(PLAIN, &table("q_1_m,c_m4", rows(LAST)));
    let run = bench.verb("run", &[]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    assert!(flat(&stderr(&run)).contains("spectrum psd.csv: isotropic, plain."), "{}", stderr(&run));
    let frame = cases(&bench);
    let target = read(&bench).0;
    assert_eq!(frame.f64("rms_height_m").unwrap()[0], target);
    assert_eq!(frame.text("spectrum_file").unwrap()[0], "psd.csv");
    assert_eq!(frame.text("spectrum_reading").unwrap()[0], "isotropic, plain");
    assert_eq!(frame.f64_or_null("hurst").unwrap()[0], None);
    // Fixed amplitudes: all realizations have the lattice sum of C, and its moments are in the same row.
    let spectrum = Spec::read(bench.spec()).unwrap().cases[0].params.surface.generated().unwrap().spectrum();
    let realizations = read_table(&bench.out().join("statistics/realizations.parquet"), &schema::REALIZATIONS).unwrap();
    for slope in realizations.f64("rms_slope").unwrap() {
        assert!((slope / spectrum.lattice_moments().rms_slope() - 1.0).abs() < 1e-12);
    }
    // The resolved spec reads back to the same keys, also without the table.
    let campaign = |path: &Path| Campaign::new(Spec::read(path).unwrap(), bench.out()).cycles[0].key.clone();
    let resolved = bench.out().join("campaign.toml");
    let key = campaign(&bench.spec());
    assert_eq!(campaign(&resolved), key);
    let file = bench.folder.path().join("psd.csv");
    fs::rename(&file, bench.folder.path().join("kept.csv")).unwrap();
    assert_eq!(campaign(&resolved), key);
    assert!(stdout(&bench.look("status", &[])).contains("Nothing is left to do."));
    let plan = hysteron(&bench, &["plan", resolved.to_str().unwrap(), "--out", bench.out().to_str().unwrap()]);
    assert!(flat(&stdout(&plan)).contains("the file of `surface.spectrum` is not there or changed"), "{}", stdout(&plan));
    fs::remove_dir_all(bench.out().join("statistics")).unwrap();
    let again = hysteron(&bench, &["run", resolved.to_str().unwrap(), "--out", bench.out().to_str().unwrap()]);
    assert_eq!(code(&again), 0, "{}", stderr(&again));
    assert_eq!(cases(&bench).f64("rms_height_m").unwrap()[0], target, "from the surface, without the table");
    // A task that needs the table asks for the file of the checksum.
    fs::remove_dir_all(bench.out().join("surfaces")).unwrap();
    let lost = hysteron(&bench, &["run", resolved.to_str().unwrap(), "--out", bench.out().to_str().unwrap()]);
    assert!(stderr(&lost).contains("psd.csv"), "{}", stderr(&lost));
    fs::write(&file, table("q_1_m,c_m4", rows(2.0 * LAST))).unwrap();
    let changed = hysteron(&bench, &["run", resolved.to_str().unwrap(), "--out", bench.out().to_str().unwrap()]);
    assert!(stderr(&changed).contains("differs from its checksum"), "{}", stderr(&changed));
}

#[test]
fn val_roughness_below_the_grid_is_taken_off_the_work_of_adhesion() {
    let ratio = |bench: &Bench| cases(bench).f64_or_null("left_out_ratio").unwrap()[0].unwrap();
    // A table that ends just below λ1: the roughness is not flattened.
    let last = 5.12e6;
    let whole = table("q_1_m,c_m4", rows(last));
    let bench_of = |text: &str, adhesion: f64| {
        let bench = bench(PLAIN, text);
        let adhesive = spec(PLAIN).replace("work_of_adhesion_j_m2 = 0.02", &format!("work_of_adhesion_j_m2 = {adhesion:e}"));
        fs::write(bench.spec(), adhesive).unwrap();
        let run = bench.verb("run", &["--until", "aggregate"]);
        assert_eq!(code(&run), 0, "{}", stderr(&run));
        (bench, stderr(&run))
    };
    // E*/4 ∫ q C d²q beyond q1 = 8 · 2π/L, by the trapezoidal rule in ln q.
    let q1 = 8.0 * TAU / LENGTH;
    let law = |q: f64| 3e-30 / (1.0 + (q / 2e6).powi(2)).powf(1.9);
    let (count, span) = (20_000, (last / q1).ln());
    let energy: f64 = (0..count)
        .map(|k| q1 * ((f64::from(k) + 0.5) / f64::from(count) * span).exp())
        .map(|q| 0.25 * 1e9 * TAU * q.powi(3) * law(q) * span / f64::from(count))
        .sum();
    let adhesion = energy / 0.04;
    let (folded, said) = bench_of(&whole, adhesion);
    // Power laws between rows 6 % apart.
    assert!((ratio(&folded) / 0.04 - 1.0).abs() < 5e-3, "{}", ratio(&folded));
    assert!(flat(&said).contains("it is subtracted from Δγ (limit 5 %)"), "{said}");
    // The same table up to λ1, with the work of adhesion that is left.
    let mut cut: Vec<[f64; 2]> = rows(last).into_iter().filter(|[q, _]| *q < q1).collect();
    let at = rows(last).windows(2).find(|pair| pair[1][0] > q1).map(|pair| [pair[0], pair[1]]).unwrap();
    let slope = (at[1][1] / at[0][1]).ln() / (at[1][0] / at[0][0]).ln();
    cut.push([q1, at[0][1] * (q1 / at[0][0]).powf(slope)]);
    let (plain, _) = bench_of(&table("q_1_m,c_m4", cut), adhesion * (1.0 - ratio(&folded)));
    assert!(ratio(&plain) < 1e-9, "{}", ratio(&plain));
    let pull_off = |bench: &Bench| cases(bench).f64_or_null("pull_off_load_mean").unwrap()[0].unwrap();
    // The work of adhesion differs by rounding, and loops by their tolerance.
    assert!((pull_off(&folded) / pull_off(&plain) - 1.0).abs() < 1e-6, "{} {}", pull_off(&folded), pull_off(&plain));
    let (large, said) = bench_of(&whole, energy / 0.06);
    assert!(cases(&large).text("caution").unwrap()[0].split('+').any(|code| code == "left_out"));
    assert!(!cases(&folded).text("caution").unwrap()[0].contains("left_out"));
    assert!(flat(&said).contains("not subtracted from"), "{said}");
}

#[test]
fn e2e_keys_of_spectra_are_checked_together() {
    let refused = [
        ("roll_off_m = 2e-3", "`surface.roll_off_m` cannot be 0.002 m"),
        ("roll_off_m = 1e-6", "`surface.roll_off_m` cannot be 1e-6 m"),
        ("longest_wavelength_m = 2e-3", "`surface.longest_wavelength_m` cannot be 0.002 m"),
        ("longest_wavelength_m = 1e-5", "`surface.longest_wavelength_m` cannot be 1e-5 m"),
        ("longest_wavelength_m = 1e-4\nroll_off_m = 2e-4", "`surface.roll_off_m` cannot be 0.0002 m"),
        ("spectrum_unit = \"um\"", "`surface.spectrum_unit` describes a table"),
        ("spectrum = \"\"", "`surface.spectrum` is empty"),
        ("spectrum = \"a.csv\"\nrms_height_m = 1e-6", "`surface.rms_height_m` describes a power law"),
        ("spectrum = \"a.csv\"\nhurst = 0.7", "`surface.hurst` describes a power law"),
        ("spectrum = \"a.csv\"\nroll_off_m = 1e-4", "`surface.roll_off_m` describes a power law"),
        ("spectrum = \"a.csv\"\nnormalization = \"sample\"", "`surface.normalization` describes a power law"),
        ("file = \"a.h5\"\nperiodic = true\nspectrum = \"a.csv\"", "`surface.spectrum` describes a generated surface"),
    ];
    for (lines, words) in refused {
        let text = format!("name = \"x\"\n[surface]\n{lines}\n");
        let errors = Spec::parse(&text, "x.toml").expect_err(lines).to_string();
        assert!(errors.starts_with("error: ") && errors.contains(words) && errors.contains("help: "), "{lines}: {errors}");
    }
    // Two kinds of spectrum in one spec, and the angle of an isotropic surface is no parameter.
    let text = "name = \"x\"\n[surface]\nhurst = 0.7\nangle_deg = 30\n[[sweep]]\nname = \"a\"\nsurface.spectrum = \"a.csv\"\n\
                [[sweep]]\nname = \"b\"\nsurface.roll_off_m = [1e-4, 0]\n";
    let spec = Spec::parse(text, "x.toml").unwrap_or_else(|errors| panic!("{errors}"));
    let surfaces: Vec<_> = spec.cases.iter().map(|case| case.params.surface.generated().unwrap()).collect();
    assert_eq!(surfaces.len(), 3);
    assert!(surfaces[0].is_tabulated() && !surfaces[0].has_spectrum());
    assert!(surfaces.iter().all(|surface| surface.angle_deg == 0.0));
    assert_eq!((surfaces[1].roll_off_m, surfaces[2].roll_off_m), (Some(1e-4), None));
    let written = spec.to_toml();
    assert_eq!(Spec::parse(&written, "campaign.toml").unwrap(), spec, "{written}");
}

#[test]
fn e2e_init_spectrum_writes_its_example() {
    let bench = Bench::new("");
    let folder = bench.folder.path();
    let made = hysteron(&bench, &["init", "spectrum"]);
    assert_eq!((code(&made), stderr(&made).trim()), (0, "Written: psd.csv"));
    fs::write(folder.join("mine.toml"), stdout(&made)).unwrap();
    let plan = hysteron(&bench, &["plan", "mine.toml"]);
    assert_eq!(code(&plan), 0, "{}", stderr(&plan));
    assert!(flat(&stdout(&plan)).contains("it is subtracted from Δγ"), "{}", stdout(&plan));
    fs::write(folder.join("psd.csv"), "mine").unwrap();
    let again = hysteron(&bench, &["init", "spectrum"]);
    assert!(stderr(&again).contains("not replaced"), "{}", stderr(&again));
    assert_eq!(fs::read_to_string(folder.join("psd.csv")).unwrap(), "mine");
}
