//! Loads in newtons on scans, whose sizes are read from their files.

use crate::bench::{Bench, code, stderr, stdout};
use hysteron::campaign::Campaign;
use hysteron::schema::REALIZATIONS;
use hysteron::spec::Spec;
use hysteron::store::parquet::read_table;
use std::fs;
use std::process::{Command, Output};

/// Text of a scan of `rows x columns` points in nanometres: waves of 8 and of 32 points.
fn heights(rows: usize, columns: usize) -> String {
    let wave = |k: usize, points: f64| (std::f64::consts::TAU * k as f64 / points).cos();
    let height = |i: usize, j: usize| 40.0 * wave(i, 32.0) * wave(j, 32.0) + 4.0 * wave(i, 8.0) * wave(j, 8.0);
    let line = |i: usize| (0..columns).map(|j| format!("{:.3}", height(i, j))).collect::<Vec<_>>().join(" ");
    (0..rows).map(line).collect::<Vec<_>>().join("\n")
}

fn bench(scans: &[(&str, usize, usize)]) -> Bench {
    let bench = Bench::new("");
    for (name, rows, columns) in scans {
        fs::write(bench.folder.path().join(name), heights(*rows, *columns)).unwrap();
    }
    bench
}

/// A spec of a stiff material with lines of the surface and of the cycle.
fn spec(surface: &str, cycle: &str) -> String {
    format!(
        "name = \"x\"\n[surface]\nunit = \"nm\"\n{surface}\n[material]\ncontact_modulus_pa = 1e12\nwork_of_adhesion_j_m2 = 0.05\n\
         [model]\nboundary = \"isolated\"\njump_in = \"jkr\"\n[cycle]\napproach_step = 0.1\n{cycle}\n"
    )
}

fn verb(bench: &Bench, verb: &str, text: &str) -> Output {
    fs::write(bench.spec(), text).unwrap();
    bench.verb(verb, &[])
}

fn refused(bench: &Bench, text: &str, words: &[&str]) {
    let plan = verb(bench, "plan", text);
    let said = stderr(&plan);
    assert!(code(&plan) == 2 && words.iter().all(|word| said.contains(word)) && said.contains("= help: "), "{text}\n{said}");
}

/// The central square of 64 x 96 points of 0.1 µm has an area of (6.4 µm)²: 0.16384 N are F/(E* A0) = 0.004, and the tasks are those of this load. The
/// resolved spec needs no scan.
#[test]
fn e2e_newtons_take_the_size_of_the_scan() {
    let bench = bench(&[("scan.txt", 64, 96)]);
    let surface = "file = \"scan.txt\"\npixel_m = 1e-7";
    let plain = verb(&bench, "generate", &spec(surface, "max_load = [0.004]"));
    assert_eq!(code(&plain), 0, "{}", stderr(&plain));
    let newtons = spec(surface, "max_force_n = [0.16384]");
    let run = verb(&bench, "run", &newtons);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    let results = read_table(&bench.out().join(REALIZATIONS.file), &REALIZATIONS).unwrap();
    let of = |name: &str| results.f64_or_null(name).unwrap()[0].unwrap();
    // The side is a product of 64 and 1e-7, rounded.
    assert!((of("max_load") / 0.004 - 1.0).abs() < 1e-12 && (of("max_load_n") / 0.16384 - 1.0).abs() < 1e-12);
    assert!((of("length_m") / 6.4e-6 - 1.0).abs() < 1e-12);
    // Captions have the load as it is given.
    let report = fs::read_to_string(bench.out().join("report.html")).unwrap();
    assert!(report.contains("coalescence = &quot;merge&quot;, F<sub>max</sub> = 0.1638 N"));
    let resolved = fs::read_to_string(bench.out().join("campaign.toml")).unwrap();
    assert!(resolved.contains("scan_sides_m = [6.4") && resolved.contains("max_force_n = [0.16384]"), "{resolved}");
    let plan = stdout(&bench.verb("plan", &[]));
    assert!(plan.contains("Nothing is left to do"), "{plan}");

    // Nothing but the record is read.
    fs::remove_file(bench.folder.path().join("scan.txt")).unwrap();
    let status = bench.look("status", &[]);
    assert_eq!(code(&status), 0, "{}", stderr(&status));
    let spec = Spec::read(bench.out().join("campaign.toml")).unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!(Campaign::new(spec, bench.out()).cycles.len(), 1);
    refused(&bench, &newtons, &["the measured surface", "cannot be read", "spec.toml:4:"]);
}

/// The tasks of a force are those of the load `F/(E* A0)`.
#[test]
fn law_a_force_on_a_scan_has_the_keys_of_its_load() {
    let bench = bench(&[("scan.txt", 64, 64)]);
    let surface = "file = \"scan.txt\"\npixel_m = 1e-7";
    let side = 64.0 * 1e-7;
    // Divided as the program divides.
    let load = 0.16384 / (1e12 * side * side);
    let ids = |cycle: &str| {
        let plan = verb(&bench, "generate", &spec(surface, cycle));
        assert_eq!(code(&plan), 0, "{}", stderr(&plan));
        let spec = Spec::read(bench.out().join("campaign.toml")).unwrap_or_else(|errors| panic!("{errors}"));
        let campaign = Campaign::new(spec, bench.out());
        (campaign.cycles[0].key.clone(), campaign.surfaces[0].key.clone())
    };
    assert_eq!(ids("max_force_n = [0.16384]"), ids(&format!("max_load = [{load:?}]")));
}

/// Each scan of a sweep has its own load; several scans of a case must have one size.
#[test]
fn e2e_newtons_on_scans_of_different_size() {
    let bench = bench(&[("a.txt", 64, 64), ("b.txt", 64, 80), ("small.txt", 48, 64)]);
    let sweep = format!(
        "{}\n[[sweep]]\nname = \"scans\"\nsurface.file = [\"a.txt\", \"small.txt\"]\n",
        spec("pixel_m = 1e-7", "max_force_n = [0.1]")
    );
    let made = verb(&bench, "generate", &sweep);
    assert_eq!(code(&made), 0, "{}", stderr(&made));
    let resolved = bench.out().join("campaign.toml");
    let read = || Spec::read(&resolved).unwrap_or_else(|errors| panic!("{errors}"));
    let loads: Vec<f64> = read().cases.iter().map(|case| case.params.cycle.max_load[0]).collect();
    for (load, side) in loads.iter().zip([6.4e-6, 4.8e-6]) {
        assert!((load / (0.1 / (1e12 * side * side)) - 1.0).abs() < 1e-12, "{loads:?}");
    }
    // The record holds for the cases that it was made for.
    let text = fs::read_to_string(&resolved).unwrap();
    let start = text.find("scan_sides_m").unwrap();
    let line = text[start..].lines().next().unwrap();
    assert_eq!(line.matches(", ").count(), 1, "{line}");
    fs::write(&resolved, text.replace(line, "scan_sides_m = [1e-6, 2e-6, 3e-6]")).unwrap();
    let said = Spec::read(&resolved).unwrap_err().to_string();
    assert!(said.contains("lists 3 sides, and 2 cases have a force") && said.contains("help: remove the line"), "{said}");
    fs::write(&resolved, text.replace(line, "scan_sides_m = [-1.0, \"a\"]")).unwrap();
    let said = Spec::read(&resolved).unwrap_err().to_string();
    assert!(said.contains("`scan_sides_m` cannot be -1.0") && said.contains("must be a number"), "{said}");

    // Scans of one square, of which one is cropped, and of two.
    let files = |names: &str| spec(&format!("files = [{names}]\npixel_m = 1e-7"), "max_force_n = [0.1]");
    let equal = verb(&bench, "generate", &files("\"a.txt\", \"b.txt\""));
    assert_eq!(code(&equal), 0, "{}", stderr(&equal));
    assert_eq!(read().scan_sides_m.len(), 1);
    refused(&bench, &files("\"a.txt\", \"small.txt\""), &["one force is two loads", "4.8000e-6 m to 6.4000e-6 m", "max_pressure_pa"]);
}

/// What the file does not state is asked for, at the loads; the size along x alone is enough for square pixels, and a force with `method = "auto"`.
#[test]
fn e2e_newtons_with_sizes_and_without() {
    let bench = bench(&[("scan.txt", 64, 48)]);
    let force = "max_force_n = [0.1]";
    refused(
        &bench,
        &spec("file = \"scan.txt\"", force),
        &["needs the size of the scan \"", "no pixel size in the file", "spec.toml:13:15"],
    );
    let load = |text: &str| {
        let made = verb(&bench, "generate", text);
        assert_eq!(code(&made), 0, "{}", stderr(&made));
        Spec::read(bench.out().join("campaign.toml")).unwrap().cases[0].params.cycle.max_load[0]
    };
    // A line of the text runs along x.
    for size in ["size_m = 4.8e-6", "size_m = 4.8e-6\nsize_y_m = 6.4e-6", "pixel_m = 1e-7"] {
        let found = load(&spec(&format!("file = \"scan.txt\"\n{size}"), force));
        assert!((found / (0.1 / (1e12 * 4.8e-6 * 4.8e-6)) - 1.0).abs() < 1e-12, "{size}: {found}");
    }
    let auto = spec("file = \"scan.txt\"\npixel_m = 1e-7", force).replace("[model]\n", "[model]\nmethod = \"auto\"\n");
    load(&auto);
    let set = Command::new(env!("CARGO_BIN_EXE_hysteron"))
        .args(["plan", bench.out().to_str().unwrap(), "--set", "cycle.max_force_n=[0.2, 0.3]"])
        .output()
        .unwrap();
    assert_eq!(code(&set), 0, "{}", stderr(&set));
    // A reader of texts alone has no scan.
    let said = Spec::parse(&auto, "x.toml").unwrap_err().to_string();
    assert!(said.contains("it is not read here") && said.contains("surface.size_y_m"), "{said}");
}

/// A probe is checked against the square of the scan.
#[test]
fn e2e_a_probe_too_large_for_the_scan_is_refused() {
    let bench = bench(&[("scan.txt", 64, 64)]);
    let text = spec("file = \"scan.txt\"\npixel_m = 1e-7", "max_force_n = [1e-3]\n[probe]\nradius_m = 1e-2");
    refused(&bench, &text, &["too large for the square", "a square of at least"]);
}
