//! Verdicts before a run: regime, method, grid, memory and time, and errors that the run would have.

use crate::bench::{Bench, code, stderr, stdout};
use hysteron::model::Method;
use hysteron::physics::theory::regime::{Regime, effective_adhesion, loaded_area};
use hysteron::spec::Spec;
use serde_json::Value;
use std::fs;

/// A scan of `n x n` points of 0.1 µm, a wave of 8 points and one of 32, in nanometres.
fn scan(bench: &Bench, n: usize, name: &str) {
    let wave = |k: usize, points: f64| (std::f64::consts::TAU * k as f64 / points).cos();
    let line = |i: usize| -> String {
        let heights = (0..n).map(|j| format!("{:.3}", 40.0 * wave(i, 32.0) * wave(j, 32.0) + 4.0 * wave(i, 8.0) * wave(j, 8.0)));
        heights.collect::<Vec<_>>().join(" ")
    };
    fs::write(bench.folder.path().join(name), (0..n).map(line).collect::<Vec<_>>().join("\n")).unwrap();
}

/// A spec of a scan with a modulus \[Pa\] and further lines.
fn of_scan(name: &str, modulus: &str, more: &str) -> String {
    format!(
        "name = \"x\"\n[surface]\nfile = \"{name}\"\npixel_m = 1e-7\nunit = \"nm\"\n[material]\ncontact_modulus_pa = {modulus}\n\
         work_of_adhesion_j_m2 = 0.05\n[model]\nboundary = \"isolated\"\n{more}"
    )
}

/// The plan of a bench, as text and as JSON.
fn plan(bench: &Bench) -> (String, Value) {
    let (text, json) = (bench.verb("plan", &[]), bench.verb("plan", &["--json"]));
    assert_eq!((code(&text), code(&json)), (0, 0), "{}{}", stderr(&text), stderr(&json));
    (stdout(&text), serde_json::from_str(&stdout(&json)).unwrap())
}

#[test]
fn law_regimes_follow_their_limits() {
    use Regime::{Flattened, NearFullContact, Separate};
    let cases = [
        ([2.0, 1.0], Separate),
        ([f64::INFINITY, f64::INFINITY], Separate),
        ([1.99, 5.0], NearFullContact),
        ([20.0, 0.99], NearFullContact),
        ([0.5, 5.0], NearFullContact),
        ([0.499, 5.0], Flattened),
        // A surface without short wavelengths.
        ([5.0, 0.0], Separate),
    ];
    for ([whole, octave], regime) in cases {
        assert_eq!(Regime::of(whole, octave), regime, "{whole} {octave}");
    }
    let methods = [Separate, NearFullContact, Flattened].map(Regime::method);
    assert_eq!(methods, [Method::Asperities, Method::BoundaryElements, Method::BoundaryElements]);
}

/// The area without adhesion is linear in small loads, `1.596 F/(E* A0 h')`, and 1 at most; beyond 0.3 no contact is one of separate spots.
#[test]
fn law_a_large_load_brings_full_contact_near() {
    let slope = (8.0 / std::f64::consts::PI).sqrt() * 1e-4 / 0.1;
    // The next term of the series is (√2 F/h')²/3, 3e-9 here.
    assert!((loaded_area(1e-4, 0.1) / slope - 1.0).abs() < 1e-6);
    assert_eq!(loaded_area(1.0, 0.01), 1.0);
    assert_eq!(Regime::Separate.with_area(0.31), Regime::NearFullContact);
    assert_eq!((Regime::Separate.with_area(0.29), Regime::Flattened.with_area(0.9)), (Regime::Separate, Regime::Flattened));
}

/// A load, or a range of attraction that Wu's criterion refuses, decides like the adhesion: `auto` takes boundary elements, and a plan says what fails.
#[test]
fn e2e_auto_and_plan_know_loads_and_low_tabor_parameters() {
    let text = |method: &str, adhesion: &str, load: &str| {
        format!(
            "name = \"x\"\nrealizations = 1\n[surface]\nmagnification = 8\n[model]\nmethod = \"{method}\"\n[material]\n\
             work_of_adhesion_j_m2 = {adhesion}\n[cycle]\nmax_load = [{load}]\n"
        )
    };
    for (adhesion, load, chosen) in
        [("1e-3", "0.002", "asperities"), ("1e-3", "0.2", "boundary_elements"), ("1e-8", "0.002", "boundary_elements")]
    {
        let (said, answer) = plan(&Bench::new(&text("auto", adhesion, load)));
        assert_eq!(answer["cases"][0]["method"], chosen, "{adhesion} {load}: {said}");
    }
    let bench = Bench::new(&text("asperities", "1e-8", "0.002"));
    let (said, _) = plan(&bench);
    assert!(said.contains("Wu's criterion"), "{said}");
    assert_eq!(code(&bench.verb("run", &["--until", "cycle"])), 3);
}

#[test]
fn e2e_a_sweep_over_regimes_has_a_verdict_for_each() {
    let text = "name = \"x\"\nrealizations = 1\n[surface]\nmagnification = 4\n[cycle]\nmax_load = [0.001]\napproach_step = 0.1\n\
                [[sweep]]\nname = \"a\"\nmaterial.work_of_adhesion_j_m2 = [0.001, 0.07]\n";
    let bench = Bench::new(text);
    let said = stdout(&bench.verb("run", &[]));
    let page = fs::read_to_string(bench.out().join("report.html")).unwrap();
    for words in ["Verdict: separate contacts (1 of 2 rows): within", "Verdict: near full contact (1 of 2 rows): "] {
        assert!(said.contains(words) && page.contains(words), "{said}");
    }
}

#[test]
fn val_effective_work_of_adhesion_of_a_flattened_surface() {
    // By hand: 0.05 (1 + 0.04/2) − 0.0018 = 0.0492; rounding only.
    let found = effective_adhesion(0.05, 0.2, 0.0018).unwrap();
    assert!((found - 0.0492).abs() < 1e-15, "{found}");
    assert_eq!(effective_adhesion(0.05, 0.2, 0.05), None);
}

#[test]
fn e2e_plan_and_run_state_the_regime_before_the_first_task() {
    let text = "name = \"x\"\nrealizations = 1\n[surface]\nmagnification = 4\n[[sweep]]\nname = \"a\"\n\
                material.work_of_adhesion_j_m2 = [0.0001, 0.07, 1.0]\n[[sweep]]\nname = \"b\"\nmodel.method = \"boundary_elements\"\n\
                surface.magnification = [4, 128]\n";
    let bench = Bench::new(text);
    let (said, answer) = plan(&bench);
    for part in ["flattened, asperities (1 of 5 cases)", "separate contacts, asperities", "near full contact, boundary elements"] {
        assert!(said.contains(part), "{part}: {said}");
    }
    assert!(said.contains("Effective work of adhesion") && said.contains("`\"auto\"`") && said.contains("warning[long_loop]"), "{said}");
    assert!(said.lines().all(|line| line.chars().count() <= 80), "{said}");
    let cases = answer["cases"].as_array().unwrap();
    let of = |name: &str| cases.iter().map(|case| case[name].clone()).collect::<Vec<_>>();
    assert_eq!(of("grid_points"), [32, 32, 32, 64, 2048].map(Value::from));
    assert_eq!(of("points_per_shortest_wavelength"), [8.0, 8.0, 8.0, 16.0, 16.0].map(Value::from));
    assert_eq!(of("recommended_method")[..3], ["asperities", "boundary_elements", "boundary_elements"].map(Value::from));
    // Memory of the solver as the guide states it for 2048² points and one load, 0.90 GB; time 57 min within its factor of 3.
    let [memory, seconds] = ["memory_bytes", "seconds"].map(|name| cases[4][name].as_f64().unwrap());
    assert!((0.9e9..1.1e9).contains(&memory) && (1150.0..10_400.0).contains(&seconds), "{memory} {seconds}");

    let weak =
        Bench::new("name = \"x\"\nrealizations = 1\n[surface]\nmagnification = 4\n[cycle]\nmax_load = [0.001]\napproach_step = 0.1\n");
    let run = weak.verb("run", &["--until", "cycle"]);
    let said = stderr(&run);
    let [regime, first] =
        ["regime    near full contact", "generate"].map(|part| said.find(part).unwrap_or_else(|| panic!("{part}: {said}")));
    // The line of the regime says what the warning `sticky` of a plan says.
    assert!(regime < first && !said.contains("warning[sticky]"), "{said}");
    assert!(!stderr(&weak.verb("run", &["--until", "cycle"])).contains("regime"), "nothing is left to do");
}

#[test]
fn e2e_plan_knows_measured_surfaces() {
    let bench = Bench::new("");
    scan(&bench, 64, "scan.txt");
    let spec = |modulus: &str, more: &str| fs::write(bench.spec(), of_scan("scan.txt", modulus, more)).unwrap();
    let folder = bench.folder.path().to_owned();
    let import = std::process::Command::new(env!("CARGO_BIN_EXE_hysteron"))
        .current_dir(&folder)
        .args(["import", "scan.txt", "--pixel-m", "1e-7", "--unit", "nm", "--dry-run", "--json"])
        .output()
        .unwrap();
    let import: Value = serde_json::from_str(&stdout(&import)).unwrap();
    spec("1e6", "method = \"boundary_elements\"\n");
    let (said, answer) = plan(&bench);
    let case = &answer["cases"][0];
    // The energy that `import` prints, times E*/Δγ; the numbers are equal but for the product.
    let wanted = import["flattening_m"].as_f64().unwrap() * 1e6 / 0.05;
    assert!((case["persson_tosatti"].as_f64().unwrap() / wanted - 1.0).abs() < 1e-12, "{said}");
    // 64 points and their mirror images, 8 points per cut-off: 16 wavelengths, 16 points each.
    assert_eq!((&case["grid_points"], &case["mirrored"], &case["error"]), (&256.into(), &true.into(), &Value::Null), "{said}");
    assert!(said.contains("grid with mirror images 256 points a side"), "{said}");
    spec("1e6", "");
    assert!(plan(&bench).0.contains("warning[sticky]"));
}

#[test]
fn e2e_plan_states_the_errors_of_the_run() {
    let bench = Bench::new("");
    scan(&bench, 64, "scan.txt");
    scan(&bench, 8, "small.txt");
    let cases = [
        ("scan.txt", "1e6", "method = \"boundary_elements\"\n[boundary_elements]\npoints = 32\n"),
        ("scan.txt", "1e6", "method = \"boundary_elements\"\n[boundary_elements]\npoints = 125\n"),
        ("small.txt", "1e9", ""),
        // A Tabor parameter below 2.
        ("scan.txt", "1e12", ""),
    ];
    for (name, modulus, more) in cases {
        fs::write(bench.spec(), of_scan(name, modulus, more)).unwrap();
        let (said, answer) = plan(&bench);
        let error = answer["cases"][0]["error"].as_str().unwrap_or_else(|| panic!("{name} {more}: {said}"));
        assert!(said.contains("warning: the run would fail for 1 of 1 case"), "{said}");
        let run = bench.verb("run", &[]);
        let problem = error.lines().next().unwrap();
        let said = stdout(&run) + &stderr(&run);
        // In the run the line of a failed task is wrapped.
        let flat = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(code(&run) != 0 && flat(&said).contains(&flat(problem)), "{problem}\n{said}");
        fs::remove_dir_all(bench.out()).unwrap();
    }
    // Coarser grids are counted apart from the cases.
    let list = "method = \"boundary_elements\"\n[boundary_elements]\npoints = [32, 128]\n";
    fs::write(bench.spec(), of_scan("scan.txt", "1e6", list)).unwrap();
    let said = plan(&bench).0;
    assert!(said.contains("warning: the run would fail for 1 of 1 coarser grid: "), "{said}");
}

/// A generated surface of four wavelengths with a method and works of adhesion.
fn generated(method: &str, adhesion: &str) -> String {
    format!(
        "name = \"x\"\nrealizations = 1\n[surface]\nmagnification = 4\n[model]\nmethod = \"{method}\"\n[[sweep]]\nname = \"a\"\n\
         material.work_of_adhesion_j_m2 = {adhesion}\n"
    )
}

#[test]
fn law_auto_is_the_chosen_method_with_its_keys() {
    let parsed = |text: &str| Spec::parse(text, "x.toml").unwrap_or_else(|errors| panic!("{errors}\n{text}"));
    for (adhesion, method) in [("[0.0001, 0.0002]", "asperities"), ("[0.07, 0.3]", "boundary_elements"), ("[0.0]", "asperities")] {
        // One choice: the resolved specs are the same text.
        let (auto, written) = (parsed(&generated("auto", adhesion)), parsed(&generated(method, adhesion)));
        assert_eq!(auto, written, "{adhesion}");
        assert!(auto.to_toml().contains(&format!("method = \"{method}\"")) && !auto.to_toml().contains("auto"), "{}", auto.to_toml());
    }
    let auto = parsed(&generated("auto", "[0.0001, 0.07]"));
    let methods = |spec: &Spec| spec.cases.iter().map(|case| case.params.method.kind()).collect::<Vec<_>>();
    assert_eq!(methods(&auto), [Method::Asperities, Method::BoundaryElements]);
    let text = auto.to_toml();
    assert!(text.contains("auto_methods = [\"asperities\", \"boundary_elements\"]"), "{text}");
    assert_eq!(parsed(&text), auto);
    // Cases, and so keys and ids, are those of a spec that writes the methods.
    for (case, method, adhesion) in [(0, "asperities", "[0.0001]"), (1, "boundary_elements", "[0.07]")] {
        assert_eq!(auto.cases[case].params, parsed(&generated(method, adhesion)).cases[0].params);
    }
    // The record holds for the spec that it was made for.
    let stale = text.replace("[0.0001, 0.07]", "[0.0001, 0.07, 0.3]");
    let said = Spec::parse(&stale, "x.toml").unwrap_err().to_string();
    assert!(said.contains("`auto_methods` lists 2 methods, and 3 cases") && said.contains("help: remove the line"), "{said}");
    let wrong = text.replace("\"asperities\", \"boundary_elements\"", "\"auto\", 1");
    assert_eq!(Spec::parse(&wrong, "x.toml").unwrap_err().to_string().matches("`auto_methods` must list").count(), 2);
    let set = Spec::parse_with(&text, "x.toml", &["material.contact_modulus_pa=2e6".to_owned()]).unwrap();
    assert_eq!(methods(&set), methods(&auto), "chosen again");
}

#[test]
fn e2e_auto_chooses_from_the_scan_and_writes_the_choice() {
    let bench = Bench::new("");
    scan(&bench, 64, "scan.txt");
    let spec = |modulus: &str, method: &str| {
        let more = format!("method = \"{method}\"\njump_in = \"jkr\"\n");
        fs::write(bench.spec(), of_scan("scan.txt", modulus, &more)).unwrap();
    };
    for (modulus, method) in [("1e12", "asperities"), ("1e6", "boundary_elements")] {
        let [auto, written] = ["auto", method].map(|method| {
            spec(modulus, method);
            let _ = fs::remove_dir_all(bench.out());
            let run = bench.verb("generate", &[]);
            assert_eq!(code(&run), 0, "{}", stderr(&run));
            (plan(&bench), fs::read_to_string(bench.out().join("campaign.toml")).unwrap())
        });
        assert_eq!(auto, written, "{modulus}");
        assert_eq!(auto.0.1["cases"][0]["method"], *method);
    }
    spec("1e6", "auto");
    fs::write(bench.folder.path().join("scan.txt"), "1 2 x 4\n5 6 7 8\n").unwrap();
    let refused = bench.verb("plan", &[]);
    let said = stderr(&refused);
    assert!(code(&refused) == 2 && said.contains("\"auto\" cannot be chosen from the scan") && said.contains("help: "), "{said}");
}

/// Under load control a loop takes 3 to 21 times as long: one of a minute is then announced as a long one.
#[test]
fn reg_the_plan_of_load_control() {
    let plan = |control: &str| {
        let bench = Bench::new(&format!(
            "name = \"x\"\nrealizations = 1\nsurface.magnification = 4\nmodel.method = \"boundary_elements\"\n\
             boundary_elements.points = 512\nmachine.control = \"{control}\"\n"
        ));
        stdout(&bench.verb("plan", &[]))
    };
    let [free, held] = ["load", "displacement"].map(plan);
    assert!(free.contains("warning[long_loop]") && !held.contains("warning[long_loop]"), "{free}{held}");
}
