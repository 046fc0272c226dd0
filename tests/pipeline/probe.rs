//! Probe, machine, layer and loads in newtons, from the spec to the tables.

use hysteron::schema::{CASES, REALIZATIONS, STEPS};
use hysteron::spec::Spec;
use hysteron::store::Frame;
use hysteron::store::parquet::read_table;

use crate::bench::{Bench, code, stderr, stdout};
use std::process::Command;

/// A nearly smooth sphere of 20 µm on an elastomer, on a grid of 8 points per JKR radius.
const SPHERE: &str = "name = \"sphere\"
realizations = 1
[surface]
length_m = 4e-5
rms_height_m = 1e-9
magnification = 4
points_per_shortest_wavelength = 8
[material]
work_of_adhesion_j_m2 = 0.03
[boundary_elements]
points = 80
[probe]
radius_m = 2e-5
[cycle]
max_force_n = [1e-6]
";

fn table(spec: &str) -> (Bench, Frame) {
    let bench = Bench::new(spec);
    let run = bench.verb("run", &["--until", "aggregate"]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    let frame = read_table(&bench.out().join("statistics/realizations.parquet"), &REALIZATIONS).unwrap();
    (bench, frame)
}

fn column(frame: &Frame, name: &str) -> Vec<f64> {
    frame.f64_or_null(name).unwrap().iter().map(|value| value.unwrap_or(f64::NAN)).collect()
}

/// The pull-off force is 1.5πRΔγ = 2.827e-6 N for both methods: to 2 % for asperities (Wu's jump into contact does not change it), to 6.5 % on the grid of 8
/// points per JKR radius, whose law errs by 6 %. The load at the reversal is that of the spec, and the works of closing and opening differ by Θ/A0.
#[test]
fn e2e_a_probe_by_both_methods() {
    let spec =
        SPHERE.replace("[material]", "[[sweep]]\nname = \"methods\"\nmodel.method = [\"asperities\", \"boundary_elements\"]\n[material]");
    let (bench, frame) = table(&spec);
    assert_eq!(frame.row_count(), 2);
    let methods = frame.text("method").unwrap();
    for (row, method) in methods.iter().enumerate() {
        let limit = if *method == "asperities" { 0.02 } else { 0.065 };
        let of = |name: &str| column(&frame, name)[row];
        assert!((of("pull_off_load_n") / 2.827e-6 - 1.0).abs() < limit, "{}: {}", method, of("pull_off_load_n"));
        assert!((of("work_pull_off_j_m2") / 0.03 - 1.0).abs() < limit, "{}", method);
        for fit in ["work_approach_j_m2", "work_retraction_j_m2"] {
            // The area is that of grid points: its radius is 0.3 spacings too small.
            assert!((of(fit) / 0.03 - 1.0).abs() < 0.2, "{} {fit}: {}", method, of(fit));
        }
        let difference = of("work_opening_j_m2") - of("work_closing_j_m2");
        assert!((difference / of("loss_j_m2") - 1.0).abs() < 1e-9, "{difference}, {}", of("loss_j_m2"));
        assert!((of("max_load") * 1e6 * 1.6e-9 / 1e-6 - 1.0).abs() < 1e-12);
        assert_eq!((of("probe_radius_m"), of("machine_compliance_m_n")), (2e-5, 0.0));
        assert!(of("probe_extent") > 0.05 && of("probe_extent") < 0.3, "{}", of("probe_extent"));
    }
    assert_eq!(frame.text("far_field").unwrap(), ["half_space"; 2]);
    let cases = read_table(&bench.out().join("statistics/cases.parquet"), &CASES).unwrap();
    assert!(column(&cases, "work_retraction_j_m2_mean").iter().all(|work| *work > 0.0));
    // The written spec has the loads in the unit of the spec, and is the same spec.
    let text = std::fs::read_to_string(bench.out().join("campaign.toml")).unwrap();
    assert!(text.contains("max_force_n = [1e-6]") && text.contains("[probe]\nradius_m = 2e-5") && !text.contains("max_load ="), "{text}");
    assert_eq!(Spec::parse(&text, "campaign.toml").unwrap().cases, Spec::parse(&spec, "spec.toml").unwrap().cases);
}

/// Θ grows with the compliance of the machine, F_po does not; the displacements of machine and contact differ by cF. Under control of the load stiffness is not
/// read, and Θ is larger as well.
#[test]
fn e2e_machine_and_control() {
    let spec = format!(
        "{SPHERE}[model]\nmethod = \"boundary_elements\"\n[[sweep]]\nname = \"stiff\"\nmachine.stiffness_n_m = [1.0, 100.0]\n[[sweep]]\nname = \"load\"\nmachine.control = \"load\"\nmachine.stiffness_n_m = [1.0, 2.0]\n"
    );
    let (bench, frame) = table(&spec);
    assert_eq!(frame.row_count(), 3, "cases under control of the load are one");
    let (loss, force) = (column(&frame, "loss_j"), column(&frame, "pull_off_load_n"));
    let compliance = column(&frame, "machine_compliance_m_n");
    let at = |c: f64, control: &str| (0..3).find(|row| compliance[*row] == c && frame.text("control").unwrap()[*row] == control).unwrap();
    let [soft, stiff, load] = [at(1.0, "displacement"), at(0.01, "displacement"), at(0.0, "load")];
    assert!(loss[soft] > 2.0 * loss[stiff] && loss[load] > 1.05 * loss[stiff], "{loss:?}");
    assert!(force.iter().all(|f| (f / force[stiff] - 1.0).abs() < 0.01), "{force:?}");
    let id = &frame.text("cycle_id").unwrap()[soft];
    let steps = read_table(&bench.out().join(format!("cycles/{id}/steps.parquet")), &STEPS).unwrap();
    let (moved, contact, loads) = (column(&steps, "machine_displacement_m"), column(&steps, "approach_m"), column(&steps, "load_n"));
    // To the residual of an equilibrium.
    assert!((0..moved.len()).all(|row| (moved[row] - contact[row] - loads[row]).abs() < 1e-8), "c = 1 m/N");
}

/// The plan states the smooth sphere by JKR beside grid and square: `(2πΔγR²/E*)^⅓` = 4.22 µm, 1.5πRΔγ = 2.83 µN, and 5.83 µm at 1 µN.
#[test]
fn e2e_the_plan_states_probe_machine_and_layer() {
    let plan = |spec: &str| {
        let shown = Bench::new(spec).verb("plan", &[]);
        assert_eq!(code(&shown), 0, "{}", stderr(&shown));
        stdout(&shown).split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let layer = "[model]\nmethod = \"boundary_elements\"\n[substrate]\nthickness_m = 4.22e-5\n[cycle]";
    let elements = SPHERE.replace("[cycle]", "[model]\nmethod = \"boundary_elements\"\n[cycle]");
    let text = plan(&elements);
    for words in ["4.22e-6 m at touch (8.4 grid points)", "F_po = 2.83e-6 N", "5.83e-6 m", "0.15 of the side", "half-space"] {
        assert!(text.contains(words), "{words}\n{text}");
    }
    let text = plan(&SPHERE.replace("[cycle]", layer));
    assert!(text.contains("10 contact radii of the sphere") && text.contains("periodic cell"), "{text}");
    let flat = plan("name = \"flat\"\n[surface]\nmagnification = 8\n");
    assert!(!flat.contains("machine") && !flat.contains("probe"), "{flat}");
}

/// Labels of cases that differ in a layer alone: one has none.
/// The templates and their plans state the same number of grid points per JKR radius a0 = (2πΔγR²/E*)^(1/3) = 4.225 µm, on a spacing of
/// 40 µm / 128.
#[test]
fn val_the_templates_state_the_grid_of_their_plan() {
    for name in ["probe", "loop"] {
        let bench = Bench::new("");
        let program = |arguments: &[&str]| {
            let mut command = Command::new(env!("CARGO_BIN_EXE_hysteron"));
            stdout(&command.args(arguments).current_dir(bench.folder.path()).output().unwrap())
        };
        let text = program(&["init", name]);
        std::fs::write(bench.spec(), &text).unwrap();
        let plan = program(&["plan", "spec.toml"]);
        let points = (std::f64::consts::TAU * 0.03 * 2e-5 * 2e-5 / 1e6).cbrt() / (4e-5 / 128.0);
        assert!(plan.split_whitespace().collect::<Vec<_>>().join(" ").contains(&format!("({points:.0} grid points)")), "{plan}");
        assert!(text.contains(&format!("# {points:.0} points per JKR radius;")), "{text}");
    }
}

#[test]
fn e2e_labels_of_cases_with_and_without_a_layer() {
    let layered =
        "[[sweep]]\nname = \"layer\"\nsubstrate.thickness_m = 4e-5\n[[sweep]]\nname = \"none\"\nboundary_elements.points = 80\n[cycle]";
    let spec = SPHERE
        .replace("[cycle]", layered)
        .replace("[probe]", "[model]\nmethod = \"boundary_elements\"\n[machine]\ncompliance = \"cell\"\n[probe]");
    let bench = Bench::new(&spec);
    let run = bench.verb("run", &[]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    let text = std::fs::read_to_string(bench.out().join("report.html")).unwrap();
    assert!(text.contains("t = none") && text.contains("t = 40 µm") && !text.contains("= ?") && !text.contains("ν = none"), "{text}");
}

/// A spec with a change is refused with these words.
fn refused(from: &str, to: &str, words: &[&str]) {
    let text = SPHERE.replace(from, to);
    assert_ne!(text, SPHERE, "{from}");
    let error = Spec::parse(&text, "x.toml").unwrap_err().to_string();
    for word in words.iter().chain(&["help: "]) {
        assert!(error.contains(word), "{to}: {word}\n{error}");
    }
}

#[test]
fn e2e_what_a_probe_cannot_be_is_an_error_with_help() {
    let probe = "radius_m = 2e-5";
    refused(probe, "radius_m = 1e-10", &["must be greater than the rms height"]);
    refused(probe, "radius_m = 5e-3", &["the contact of the probe is too large", "0.3 L"]);
    refused(probe, "radius_m = -1", &["`probe.radius_m`"]);
    refused("max_force_n = [1e-6]", "max_force_n = [1.0]", &["too large"]);
    refused("max_force_n = [1e-6]", "max_force_n = [1e-6]\nmax_load = [0.001]", &["exclude each other"]);
    refused("max_force_n = [1e-6]", "max_force_n = [-1e-6]", &["must be greater than 0"]);
    refused("[cycle]", "[machine]\ncompliance_m_n = 1\nstiffness_n_m = 1\n[cycle]", &["exclude each other"]);
    refused("[cycle]", "[machine]\nstiffness_n_m = 0\n[cycle]", &["stiffness_n_m"]);
    refused("[cycle]", "[substrate]\nthickness_m = 1e-4\n[cycle]", &["asperity model", "boundary_elements"]);
    refused("[cycle]", "[substrate]\npoisson_ratio = 0.3\n[cycle]", &["no thickness"]);
    refused("[cycle]", "[machine]\ncontrol = \"load\"\n[cycle]", &["cannot merge", "cover"]);
    refused("[probe]\nradius_m = 2e-5", "[machine]\ncompliance = \"half_space\"", &["needs a probe"]);
}

/// A layer that the grid does not resolve, and a machine so soft that its energy hides that of the contact, are refused when the grid is known.
#[test]
fn e2e_a_thin_layer_and_a_soft_machine_are_refused() {
    for (table, word) in
        [("[substrate]\nthickness_m = 1e-6", "grid spacings"), ("[machine]\nstiffness_n_m = 1e-3", "hides that of the contact")]
    {
        let bench = Bench::new(&SPHERE.replace("[cycle]", &format!("{table}\n[model]\nmethod = \"boundary_elements\"\n[cycle]")));
        let run = bench.verb("run", &[]);
        assert_ne!(code(&run), 0, "{table}");
        assert!(stderr(&run).contains(word) && stderr(&run).contains("help: "), "{table}: {}", stderr(&run));
    }
}
