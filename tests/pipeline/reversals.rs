//! Boundary elements on scans that are not periodic, and load reversals without a result.

use crate::bench::{Bench, code, stderr, stdout};
use crate::elements::{campaign, close, elements, statistics, table};
use hysteron::campaign::{Campaign, CycleUnit};
use hysteron::schema;
use hysteron::store::Frame;
use std::fs;

/// A scan of 32 x 32 points that is not periodic, of waves and a slope, and a spec of it by both methods.
fn scan(bench: &Bench, lines: &str) -> String {
    let n = 32;
    let wave = |i: usize, j: usize| {
        let [x, y] = [i, j].map(|k| k as f64 / n as f64);
        1e-6 * ((7.0 * x + 0.3).sin() + (9.0 * y + 2.0).cos() + 0.7 * (11.0 * x - 6.0 * y).sin() + x * y)
    };
    let row = |i: usize| (0..n).map(|j| format!("{:e}", wave(i, j))).collect::<Vec<_>>().join(" ");
    let file = bench.spec().with_file_name("scan.txt");
    fs::write(&file, (0..n).map(row).collect::<Vec<_>>().join("\n")).unwrap();
    format!(
        "name = \"scan\"\n[surface]\nfile = \"{}\"\nunit = \"m\"\npixel_m = 2e-6\n[material]\nwork_of_adhesion_j_m2 = 0.01\n[model]\nboundary = \"isolated\"\n[cycle]\n\
         max_load = [0.002, 0.004]\n[boundary_elements]\npoints = 64\n{lines}\n[[sweep]]\nname = \"method\"\n\
         model.method = [\"asperities\", \"boundary_elements\"]\n",
        file.display()
    )
}

/// The same sums of a table by both methods: `x E* L²` or `x L²` is the column in SI units.
#[test]
fn law_all_tables_refer_to_the_area_of_the_scan() {
    let bench = Bench::new("");
    // Twice as fine as the scan with its mirror images.
    fs::write(bench.spec(), scan(&bench, "").replace("points = 64", "points = 128")).unwrap();
    let run = bench.verb("run", &["--until", "aggregate"]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    let campaign = campaign(&bench);
    let (modulus, length) = (1e6, 32.0 * 2e-6_f64);
    let area = length * length;
    let ratio = |what: &str, frame: &Frame, [si, plain]: [&str; 2], unit: f64| {
        let (si, plain) = (frame.f64(si).unwrap(), frame.f64(plain).unwrap());
        assert!(plain.iter().any(|value| *value != 0.0), "{what}");
        si.iter().zip(&plain).for_each(|(si, plain)| close(what, *si, plain * unit, 1e-12));
    };
    let units = campaign.distinct_cycles();
    assert_eq!(units.len(), 2);
    for unit in &units {
        let steps = table(&campaign, unit, &schema::STEPS);
        ratio("load", &steps, ["load_n", "load"], modulus * area);
        ratio("area", &steps, ["area_m2", "area"], area);
    }
    let realizations = statistics(&bench, &schema::REALIZATIONS);
    let rms = realizations.f64("rms_height_m").unwrap()[0];
    ratio("F_po", &realizations, ["pull_off_load_n", "pull_off_load"], modulus * area);
    ratio("Θ", &realizations, ["loss_j", "loss"], modulus * area * rms);
    ratio("events", &realizations, ["dissipated_j", "dissipated"], modulus * area * rms);
    assert!(realizations.f64("nominal_area_m2").unwrap().iter().all(|nominal| (nominal / area - 1.0).abs() < 1e-12));
    assert!(statistics(&bench, &schema::CASES).f64("nominal_area_m2_mean").unwrap().iter().all(|mean| (mean / area - 1.0).abs() < 1e-12));
    maps_and_regions_of_a_scan(&campaign, &elements(&campaign)[0], [modulus, length, area]);
}

/// Events, regions, maps and the adhesionless curve of boundary elements are those of the scan itself.
fn maps_and_regions_of_a_scan(campaign: &Campaign, unit: &CycleUnit, [modulus, length, area]: [f64; 3]) {
    let [steps, contacts, events, free] =
        [&schema::STEPS, &schema::CONTACTS, &schema::EVENTS, &schema::ADHESIONLESS].map(|of| table(campaign, unit, of));
    let [step_area, step_load] = ["area_m2", "load_n"].map(|column| steps.f64(column).unwrap());
    let regions = steps.i64("contact_count").unwrap();
    // The largest load before an event is one of a step.
    let most = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
    assert!(most(&events.f64("area_after_m2").unwrap()) <= 1.001 * most(&step_area));
    assert!(most(&events.f64("load_before_n").unwrap()) <= 1.001 * most(&step_load));
    // Without adhesion the same load needs a larger penetration and has a smaller area: of the same order.
    let reached = most(&free.f64("load_n").unwrap());
    assert!(reached > most(&step_load) && reached < 100.0 * most(&step_load), "{reached}");
    let of_step = contacts.i64("step").unwrap();
    let (region_area, x) = (contacts.f64("area_m2").unwrap(), contacts.f64("centroid_x_m").unwrap());
    for step in of_step.iter().copied().collect::<std::collections::BTreeSet<_>>() {
        let rows = || (0..of_step.len()).filter(|row| of_step[*row] == step);
        // Equal but for points at which rounding has broken the symmetry of the images.
        close("regions", rows().map(|row| region_area[row]).sum(), step_area[step as usize], 0.02);
        assert_eq!(rows().count() as i64, regions[step as usize]);
    }
    assert!(x.iter().all(|x| (-1e-6..=length).contains(x)), "{x:?}");
    let file = hdf5_metno::File::open(campaign.cycle_dir(unit).join("maps.h5")).unwrap();
    let number = |name: &str| file.attr(name).unwrap().read_scalar::<f64>().unwrap();
    close("side of the maps", number("length_m"), length, 1e-12);
    // Half a pixel of the scan and half a spacing of the grid, which is twice as fine.
    close("first point", number("first_m"), 0.5 * (1e-6 - 2e-6), 1e-9);
    for group in file.groups().unwrap() {
        let pressure = group.dataset("pressure_pa").unwrap().read_2d::<f32>().unwrap();
        let load = group.attr("load_n").unwrap().read_scalar::<f64>().unwrap();
        let sum: f64 = pressure.iter().map(|p| f64::from(*p)).sum::<f64>() * area / pressure.len() as f64;
        assert!(load.abs() <= 0.0041 * modulus * area && (sum - load).abs() < 2e-5 * modulus * area, "{sum} and {load}");
    }
}

#[test]
fn reg_grids_of_a_scan_with_mirror_images() {
    for (line, sentence) in [("points = 16", "per shortest wavelength: at least 4 are needed"), ("points = 65", "an odd number")] {
        let bench = Bench::new("");
        fs::write(bench.spec(), scan(&bench, "").replace("points = 64", line).replace("\"asperities\", ", "")).unwrap();
        let refused = bench.verb("run", &["--until", "cycle"]);
        assert_eq!(code(&refused), 3, "{}", stderr(&refused));
        assert!(stderr(&refused).contains(sentence), "{}", stderr(&refused));
    }
}

/// A load without result: the other one has its rows, the reason is in the tables and printed, and the exit code is 3, again after all is done.
#[test]
fn e2e_a_load_that_is_not_reached() {
    let text = "name = \"flat\"\nrealizations = 1\nsurface.magnification = 2\nsurface.rms_height_m = 2e-7\nmodel.method = \"boundary_elements\"\n\
                boundary_elements.points = 32\nboundary_elements.opening = \"edges\"\nmaterial.work_of_adhesion_j_m2 = 1e-6\n\
                cycle.max_load = [5e-5, 0.01]\n";
    let bench = Bench::new(text);
    let run = bench.verb("run", &[]);
    assert_eq!(code(&run), 3, "{}", stderr(&run));
    assert!(stderr(&run).contains("no result at F_max/(E* A0) = 0.01: full contact"), "{}", stderr(&run));
    assert!(
        stdout(&run).contains("1 load of finished cycles not reached") && stdout(&run).contains("warning[not_reached]"),
        "{}",
        stdout(&run)
    );
    let realizations = statistics(&bench, &schema::REALIZATIONS);
    assert_eq!(realizations.f64("max_load").unwrap(), [5e-5]);
    let cases = statistics(&bench, &schema::CASES);
    assert_eq!(cases.i64("not_reached_count").unwrap(), [0, 1]);
    assert_eq!((cases.i64("done_count").unwrap(), cases.i64("failed_count").unwrap()), (vec![1, 0], vec![0, 0]));
    assert!(cases.text("caution").unwrap()[1].contains("not_reached") && !cases.text("caution").unwrap()[1].contains("incomplete"));
    let cycles = statistics(&bench, &schema::CYCLES);
    assert_eq!(cycles.text("status").unwrap(), ["done"]);
    let failure = cycles.text_or_null("failure").unwrap()[0].clone().unwrap();
    assert!(failure.contains("0.01 not reached: full contact") && !failure.contains("help"), "{failure}");
    assert!(stdout(&bench.look("status", &[])).contains("0.01 not reached"));
    assert_eq!(code(&bench.look("verify", &["--deep"])), 0);
    assert!(!stdout(&bench.look("gc", &["--dry-run"])).contains("not_reached.json"));
    let again = bench.verb("run", &[]);
    assert!(code(&again) == 3 && stdout(&again).contains("Nothing to do"), "{}", stdout(&again));
    // The help is followed to the letter.
    let help = stderr(&run).split("help: set ").nth(1).unwrap().split(',').next().unwrap().to_owned();
    let mended = Bench::new(&text.replace("boundary_elements.opening = \"edges\"", &help));
    let run = mended.verb("run", &["--until", "aggregate"]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    let realizations = statistics(&mended, &schema::REALIZATIONS);
    assert_eq!(realizations.f64("area_at_max_load").unwrap()[1], 1.0);
}

/// Ranges that take too many steps are refused before the run, and the range that the help names is not; long ones are announced.
#[test]
fn reg_ranges_of_many_steps() {
    let spec = |range: &str| {
        format!(
            "name = \"range\"\nrealizations = 1\nsurface.magnification = 4\nmodel.method = \"boundary_elements\"\n\
             boundary_elements.attraction = \"range\"\nboundary_elements.range_m = {range}\ncycle.max_load = [0.002]\n"
        )
    };
    for range in ["1e-3", "3e-4"] {
        let refused = Bench::new(&spec(range)).verb("plan", &[]);
        assert_eq!(code(&refused), 2, "{}", stderr(&refused));
        let text = stderr(&refused);
        assert!(text.contains("steps, more than 20000"), "{text}");
        let named = text.split("boundary_elements.range_m to ").nth(1).unwrap().split(' ').next().unwrap();
        let plan = Bench::new(&spec(named)).verb("plan", &[]);
        assert!(code(&plan) == 0 && stdout(&plan).contains("warning[many_steps]"), "{named}: {}", stderr(&plan));
    }
    let plan = stdout(&Bench::new(&spec("0.0")).verb("plan", &[]));
    assert!(!plan.contains("warning[many_steps]"), "{plan}");
}

/// Loads that no method can tell apart or represent are refused with a caret.
#[test]
fn reg_loads_that_cannot_be_told_apart() {
    for (loads, sentence) in [
        ("[0.002, 0.0020000000000000005]", "differ by less than 1e-4"),
        ("[0.00200001, 0.01, 0.002]", "differ by less than 1e-4"),
        ("[5e-324]", "below the smallest normal number"),
    ] {
        let refused = Bench::new(&format!("name = \"loads\"\ncycle.max_load = {loads}\n")).verb("plan", &[]);
        assert!(code(&refused) == 2 && stderr(&refused).contains(sentence), "{}", stderr(&refused));
    }
    assert_eq!(code(&Bench::new("name = \"loads\"\ncycle.max_load = [0.002, 0.00201]\n").verb("plan", &[])), 0);
}

/// At the largest permitted tolerance Θ is that of a small one within 5 % (measured: 0.6 %), F_po within 2 %; without adhesion to speak of, Θ is null and counted.
#[test]
fn law_numeric_options_at_their_bounds() {
    let text = "name = \"bounds\"\nseed = 3\nrealizations = 1\nfigures.format = []\nsurface.magnification = 2\n\
                model.method = \"boundary_elements\"\nboundary_elements.points = 32\ncycle.max_load = [0.002]\n\
                [[sweep]]\nname = \"precision\"\nboundary_elements.precision = [1e-6, 1e-3]\n\
                [[sweep]]\nname = \"weak\"\nmaterial.work_of_adhesion_j_m2 = 1e-8\n";
    let bench = Bench::new(text);
    let run = bench.verb("run", &["--until", "aggregate"]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    let cases = statistics(&bench, &schema::CASES);
    let (adhesion, precision) = (cases.f64("work_of_adhesion_j_m2").unwrap(), cases.f64_or_null("precision").unwrap().to_vec());
    let row = |work: f64, of: f64| (0..adhesion.len()).find(|row| adhesion[*row] == work && precision[*row] == Some(of)).unwrap();
    let mean = |column: &str, row: usize| cases.f64_or_null(column).unwrap()[row];
    let [fine, rough] = [1e-6, 1e-3].map(|of| row(0.07, of));
    for (column, tolerance) in [("loss_mean", 0.05), ("pull_off_load_mean", 0.02)] {
        close(column, mean(column, rough).unwrap(), mean(column, fine).unwrap(), tolerance);
    }
    let weak = row(1e-8, 1e-4);
    let is_null = mean("loss_mean", weak).is_none();
    assert_eq!(cases.i64("unresolved_count").unwrap()[weak], i64::from(is_null));
    // The warning follows the uncertainty, of a value that is kept too.
    let is_uncertain = mean("loss_uncertainty_max", weak).is_some_and(|uncertainty| uncertainty > 0.1);
    assert_eq!(cases.text("caution").unwrap()[weak].contains("unresolved"), is_uncertain);
    assert!(!is_null || is_uncertain);
    assert!(is_null || mean("loss_mean", weak).unwrap() > 0.0);
    assert!(mean("pull_off_load_mean", weak).is_none_or(|pull_off| pull_off > 0.0));
}
