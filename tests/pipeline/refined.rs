//! Grids by points per shortest wavelength, and refined until a required grid error is reached.

use crate::bench::{Bench, code, stderr, stdout};
use crate::elements::statistics;
use crate::spec::refused;
use hysteron::campaign::Campaign;
use hysteron::schema;
use hysteron::spec::Spec;
use hysteron::stages::sampled;
use hysteron::stats::grid_percent;
use hysteron::store::Frame;
use std::collections::BTreeSet;
use std::fs;

/// Two surfaces of ζ = 2 and 4 with a choice of the grid: some seconds.
fn spec(grid: &str) -> String {
    format!(
        "name = \"refined\"\nseed = 7\nrealizations = 2\nmodel.method = \"boundary_elements\"\nboundary_elements.approach_step = 0.1\n\
         {grid}\ncycle.max_load = [0.004]\n[[sweep]]\nname = \"zeta\"\nsurface.magnification = [2, 4]\n"
    )
}

fn read(text: &str) -> Spec {
    Spec::parse(text, "x.toml").unwrap_or_else(|errors| panic!("{errors}"))
}

fn keys(spec: Spec) -> BTreeSet<String> {
    Campaign::new(spec, "unused".into()).cycles.into_iter().map(|unit| unit.key).collect()
}

/// The campaign of a folder, with all grids that its results require.
fn refined(bench: &Bench) -> Campaign {
    sampled(Campaign::new(Spec::read(bench.spec()).unwrap(), bench.out())).unwrap()
}

/// The grids of the case of a magnification, ascending.
fn grids(campaign: &Campaign, zeta: u32) -> Vec<u32> {
    let of_zeta = campaign.cases.iter().filter(|unit| unit.case.params.surface.generated().unwrap().magnification == zeta);
    let mut points: Vec<u32> = of_zeta.map(|unit| unit.case.params.elements().unwrap().points.unwrap()).collect();
    points.sort_unstable();
    points
}

/// Rows of a table without the warnings, in which a required error may differ.
fn rows(frame: &Frame) -> Vec<String> {
    frame.columns().filter(|(column, _)| column.name != "caution").map(|(column, data)| format!("{} {data:?}", column.name)).collect()
}

/// A list of points per wavelength is the list of points that each case has then, with the same tasks. The resolved spec reads back.
#[test]
fn law_points_per_wavelength_are_the_same_tasks_as_points() {
    let by_wavelength = read(&spec("boundary_elements.points_per_wavelength = [4, 8, 16]"));
    let case = |zeta: u32, points: &str| {
        let list = format!("boundary_elements.points = {points}");
        keys(read(&spec(&list).replace("[2, 4]", &zeta.to_string())))
    };
    let by_hand: BTreeSet<String> = case(2, "[8, 16, 32]").union(&case(4, "[16, 32, 64]")).cloned().collect();
    assert_eq!(keys(by_wavelength.clone()), by_hand);
    assert_eq!(by_wavelength.cases.len(), 6);
    let written = by_wavelength.to_toml();
    assert!(written.contains("\npoints_per_wavelength = [4, 8, 16]\n") && !written.contains("\npoints = "), "{written}");
    assert_eq!(read(&written), by_wavelength);
    // In a sweep each number is a case.
    let swept = read(&(spec("") + "boundary_elements.points_per_wavelength = [4, 16]\n"));
    assert_eq!(swept.cases.len(), 4);
    assert!(swept.cases.iter().all(|case| !case.is_coarser_grid()));
    // A sweep over points replaces the number per wavelength of the base, and the other way round.
    for (base, axis) in [("points_per_wavelength = [4, 8]", "points = [32, 64]"), ("points = [32, 64]", "points_per_wavelength = [8, 16]")]
    {
        let text = spec(&format!("boundary_elements.{base}")) + &format!("boundary_elements.{axis}\n");
        let spec = read(&text.replace("[2, 4]", "4"));
        assert_eq!(spec.cases.len(), 2, "{text}");
        assert_eq!(read(&spec.to_toml()), spec);
    }
    // A number that is no power of two gives the next grid.
    let campaign = Campaign::new(read(&spec("boundary_elements.points_per_wavelength = 5")), "unused".into());
    assert_eq!((grids(&campaign, 2), grids(&campaign, 4)), (vec![16], vec![32]));
    // A setting replaces the choice of the spec.
    let set = |setting: &str| Spec::parse_with(&spec("boundary_elements.points = [16, 64]"), "x.toml", &[setting.to_owned()]).unwrap();
    assert_eq!(set("boundary_elements.points_per_wavelength=8").cases.len(), 2);
    assert_eq!(set("boundary_elements.error=0.1").cases.len(), 6);
}

/// The grid of a scan follows from its size when it is read: 16 per wavelength is the automatic grid, other numbers are tasks of their own.
#[test]
fn law_points_per_wavelength_of_a_scan_follow_its_cut_off() {
    let scan = |grid: &str| {
        let digest = "0".repeat(64);
        let text = "name = \"x\"\nsurface.file = \"a.h5\"\nmodel.method = \"boundary_elements\"";
        read(&format!("{text}\n{grid}\nfiles = {{ \"a.h5\" = \"{digest}\" }}\n"))
    };
    let automatic = keys(scan("boundary_elements.points = 0"));
    assert_eq!(keys(scan("boundary_elements.points_per_wavelength = 16")), automatic);
    assert_ne!(keys(scan("boundary_elements.points_per_wavelength = 8")), automatic);
    let [first, list] = ["error = 0.1", "points_per_wavelength = [4, 8, 16]"].map(|grid| scan(&format!("boundary_elements.{grid}")));
    assert_eq!(keys(first.clone()), keys(list));
    let finer = keys(first.refined(&[0]));
    assert_eq!(finer, keys(scan("boundary_elements.points_per_wavelength = [4, 8, 16, 32]")));
    assert_eq!(finer.len(), 4);
}

/// One rule for the terminal, the report and `show`: two digits, and no number for grids that disagree.
#[test]
fn val_grid_errors_in_per_cent() {
    assert_eq!([0.005, 0.1234, 1.0, 1.01, 12.0].map(grid_percent), ["0.5 %", "12 %", "100 %", "> 100 %", "> 100 %"]);
}

/// 12 points per JKR radius of a probe count as 16 per wavelength, as for the automatic grid.
#[test]
fn law_points_per_wavelength_of_a_probe_follow_its_radius() {
    let probe = |number: u32| {
        let text = spec(&format!("boundary_elements.points_per_wavelength = {number}\nprobe.radius_m = 1e-4"));
        let spec = read(&text.replace("[2, 4]", "2"));
        spec.cases[0].params.elements().unwrap().points.unwrap()
    };
    // JKR radius at zero penetration (2π R² Δγ/E*)^(1/3) = 1.64e-5 m: 12 points on it are 732 on 1 mm.
    assert_eq!((probe(16), probe(8)), (1024, 512));
}

#[test]
fn val_choices_of_a_grid_exclude_one_another() {
    let bad: [(&str, &[&str]); 7] = [
        ("boundary_elements.points = 64\nboundary_elements.points_per_wavelength = 16", &["exclude each other", "x.toml:7:", "give one"]),
        ("boundary_elements.error = 0.1\nboundary_elements.points = [16, 32]", &["exclude each other", "`boundary_elements.error`"]),
        ("boundary_elements.error = 0.1\nboundary_elements.points_per_wavelength = 8", &["exclude each other"]),
        ("boundary_elements.points_per_wavelength = 3", &["is 3: at least 4 are needed"]),
        ("boundary_elements.points_per_wavelength = [8, 4]", &["lists 4 after 8", "write points_per_wavelength = [4, 8]"]),
        ("boundary_elements.error = 0.001", &["is 0.001: the smallest estimate is 0.005"]),
        ("boundary_elements.error = 0.1\nboundary_elements.max_points = 16", &["needs two grids", "32 points a side", "max_points` is 16"]),
    ];
    for (lines, parts) in bad {
        let rendered = refused(&spec(lines));
        for part in parts {
            assert!(rendered.contains(part), "{lines}: lacks `{part}`:\n{rendered}");
        }
    }
    for axis in ["error = 0.2", "points = 16"] {
        let rendered = refused(&(spec("boundary_elements.error = 0.1") + &format!("boundary_elements.{axis}\n")));
        assert!(rendered.contains("cannot be swept") || rendered.contains("exclude each other"), "{rendered}");
    }
}

/// An error of 0 is none: the grid is the automatic one, whatever the maximum is.
#[test]
fn reg_an_error_of_zero_requires_nothing() {
    let [zero, none] = ["boundary_elements.error = 0\nboundary_elements.max_points = 16\n", ""].map(|lines| read(&spec(lines)));
    assert_eq!(zero.cases, none.cases);
    assert_eq!(keys(zero), keys(none));
}

/// Each case has the grids that its error requires, and the results are those of the same list written by hand.
#[test]
fn e2e_grids_are_refined_until_the_error_is_reached() {
    let wanted = 0.3;
    let bench = Bench::new(&spec(&format!("boundary_elements.error = {wanted}\nboundary_elements.max_points = 256")));
    let plan = stdout(&bench.verb("plan", &[])).split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(plan.contains("2 cases with 4 coarser grids") && plan.contains("grid error of Θ is at most 30 %, up to 256 points"), "{plan}");
    let run = bench.verb("run", &[]);
    let said = stdout(&run);
    assert_eq!(code(&run), 0, "{said}{}", stderr(&run));
    let campaign = refined(&bench);
    let cases = statistics(&bench, &schema::CASES);
    let errors = cases.f64_or_null("loss_grid_error").unwrap();
    assert_eq!(cases.row_count(), 2);
    assert!(errors.iter().all(|error| error.is_some_and(|error| error <= wanted)), "{errors:?}");
    assert!(!said.contains("grid_error") && !said.contains("grid error too large"), "{said}");
    // One of the cases needs more than the first three grids.
    let of_zeta = [2, 4].map(|zeta| grids(&campaign, zeta));
    assert!(of_zeta.iter().any(|points| points.len() > 3), "{of_zeta:?}");
    assert!(stderr(&run).contains("grid error larger than requested: "), "{}", stderr(&run));
    assert!(stdout(&bench.verb("run", &[])).contains("Nothing to do"));
    assert!(stdout(&bench.look("status", &[])).contains("Nothing is left to do"));
    assert_eq!(code(&bench.look("verify", &["--deep"])), 0);
    let written = fs::read_to_string(bench.out().join("campaign.toml")).unwrap();
    assert!(
        written.contains("\nerror = 0.3\n") && written.contains("\nmax_points = 256\n") && !written.contains("\npoints = "),
        "{written}"
    );
    assert_eq!(read(&written), Spec::read(bench.spec()).unwrap());
    // The same lists written by hand, one case at a time.
    for (zeta, points) in [2, 4].into_iter().zip(of_zeta) {
        let by_hand = Bench::new(&spec(&format!("boundary_elements.points = {points:?}")).replace("[2, 4]", &zeta.to_string()));
        assert_eq!(code(&by_hand.verb("run", &[])), 0);
        let of_hand = statistics(&by_hand, &schema::CASES);
        let row = (0..2).find(|row| cases.f64("magnification").unwrap()[*row] == f64::from(zeta)).unwrap();
        for column in ["loss_mean", "loss_grid_error", "pull_off_grid_error", "area_at_max_load_mean", "element_points"] {
            assert_eq!(cases.f64_or_null(column).unwrap()[row], of_hand.f64_or_null(column).unwrap()[0], "{column}");
        }
        assert_eq!(cases.text("case_id").unwrap()[row], of_hand.text("case_id").unwrap()[0]);
    }
}

/// A case whose error is above the wanted one on the largest grid says so, and the run is complete. Resuming after each stage gives the same.
#[test]
fn e2e_an_error_that_is_not_reached_is_a_warning() {
    let text = spec("boundary_elements.error = 0.005\nboundary_elements.max_points = 64").replace("[2, 4]", "4");
    let bench = Bench::new(&text);
    let run = bench.verb("run", &[]);
    let said = stdout(&run).split_whitespace().collect::<Vec<_>>().join(" ");
    assert_eq!(code(&run), 0, "{said}{}", stderr(&run));
    assert!(said.contains("warning[grid_error]: grid error too large") && said.contains(" % (grid) ± "), "{said}");
    let campaign = refined(&bench);
    assert_eq!(grids(&campaign, 4), [16, 32, 64]);
    let cases = statistics(&bench, &schema::CASES);
    assert!(cases.text("caution").unwrap()[0].split('+').any(|code| code == "grid_error"));
    let status = stdout(&bench.look("status", &[])).split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(status.contains(&format!("{}: grid error of Θ ", campaign.cases[0].id)), "{status}");
    assert!(status.contains("on 64 points a side, above the requested 0.5 %") && status.contains("Nothing is left to do."), "{status}");
    let page = fs::read_to_string(bench.out().join("report.html")).unwrap();
    assert!(page.contains("grid error too large") && page.contains("above the requested"), "page");
    // Another required error changes the warnings, and `plan` gives it as the reason.
    let plan = stdout(&bench.verb("plan", &["--set", "boundary_elements.error=0.01", "--set", "boundary_elements.max_points=64"]));
    assert!(plan.contains("statistics is stale: boundary_elements.error was changed\n"), "{plan}");
    // Further grids begin from the finished ones.
    let run = bench.verb("run", &["--set", "boundary_elements.max_points=128"]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    assert!(stdout(&run).contains("cycle     2 of 8 computed, 6 done before"), "{}", stdout(&run));
}

/// A load that no surface reaches has no grid error, and the grids are refined for the others.
#[test]
fn e2e_grids_are_refined_for_the_loads_that_are_reached() {
    let text = "name = \"flat\"\nrealizations = 1\nsurface.magnification = 2\nsurface.rms_height_m = 2e-7\n\
                model.method = \"boundary_elements\"\nboundary_elements.error = 0.005\nboundary_elements.max_points = 32\n\
                boundary_elements.opening = \"edges\"\nmaterial.work_of_adhesion_j_m2 = 1e-6\ncycle.max_load = [5e-5, 0.01]\n";
    let bench = Bench::new(text);
    let run = bench.verb("run", &[]);
    assert_eq!(code(&run), 3, "{}", stderr(&run));
    assert_eq!(grids(&refined(&bench), 2), [8, 16, 32]);
    let status = stdout(&bench.look("status", &[])).split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(status.contains("grid error of Θ ") && status.contains("on 32 points a side, above"), "{status}");
}

/// Files with changed bytes stop no command: a run computes them again, and its grids and tables are the same.
#[test]
fn e2e_damaged_tables_of_a_refined_run_are_repaired() {
    let text = spec("boundary_elements.error = 0.005\nboundary_elements.max_points = 128").replace("[2, 4]", "4");
    let bench = Bench::new(&text);
    assert_eq!(code(&bench.verb("run", &[])), 0);
    let (whole, cases) = (refined(&bench), rows(&statistics(&bench, &schema::CASES)));
    for place in [whole.cycle_dir(&whole.cycles[0]).join("steps.parquet"), whole.estimates_path(&whole.surfaces[0])] {
        Bench::damage(&place);
        for look in ["status", "verify"] {
            let said = bench.look(look, &[]);
            assert_eq!(code(&said), 0, "{look}: {}", stderr(&said));
        }
        assert_eq!(code(&bench.look("verify", &["--deep"])), 1);
        // The finer grids are not known, and none is deleted.
        let clean = bench.look("clean", &["--delete"]);
        assert!(code(&clean) == 1 && stderr(&clean).contains("pending, and grids or surfaces follow"), "{}", stderr(&clean));
        let run = bench.verb("run", &[]);
        assert_eq!(code(&run), 0, "{}", stderr(&run));
        assert_eq!((grids(&refined(&bench), 4), rows(&statistics(&bench, &schema::CASES))), (grids(&whole, 4), cases.clone()));
        assert_eq!(code(&bench.look("verify", &["--deep"])), 0);
        assert!(stdout(&bench.look("clean", &["--delete"])).contains("Nothing is left over"));
    }
    // A lost receipt of a coarser grid.
    fs::remove_file(bench.out().join(format!("receipts/cycle/{}.json", whole.cycles[whole.cycles.len() - 1].id))).unwrap();
    let listed = stdout(&bench.look("clean", &[]));
    assert!(listed.contains("warning: ") && listed.contains("may be in use"), "{listed}");
    assert_eq!(code(&bench.look("clean", &["--delete"])), 1);
}

/// Surfaces after surfaces, and the cycles of each grid in a run of its own, end as one run does.
#[test]
fn e2e_refinement_is_resumed_from_any_state() {
    let text = spec("boundary_elements.error = 0.2\nboundary_elements.max_points = 128").replace("[2, 4]", "4");
    let [once, often] = [Bench::new(&text), Bench::new(&text)];
    assert_eq!(code(&once.verb("run", &[])), 0);
    // A shard computes the known grids of its surfaces; the next one follows from both.
    for _ in 0..3 {
        for shard in ["0/2", "1/2"] {
            let run = often.verb("run", &["--until", "cycle", "--shard", shard]);
            assert_eq!(code(&run), 0, "{}", stderr(&run));
        }
    }
    let run = often.verb("run", &[]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    let done = refined(&once).distinct_cycles().len();
    assert!(stdout(&run).contains(&format!("cycle     0 of {done} computed, {done} done before")), "{}", stdout(&run));
    for table in [&schema::CASES, &schema::REALIZATIONS, &schema::GRIDS] {
        assert_eq!(rows(&statistics(&once, table)), rows(&statistics(&often, table)), "{}", table.name);
    }
}
