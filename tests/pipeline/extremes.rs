//! The program at the ends of the range of inputs: no adhesion, weak adhesion, and contacts that are none.

use std::path::Path;

use crate::bench::{Bench, code, stderr, stdout};
use hysteron::schema;
use hysteron::store::Frame;
use hysteron::store::parquet::read_table;

fn spec(surface: &str, material: &str, max_load: &str) -> String {
    format!(
        "name = \"x\"\nseed = 3\nrealizations = 2\n[surface]\nmagnification = 8\n{surface}\n[material]\n{material}\n[model]\n\
         allow_low_tabor = true\n[cycle]\nmax_load = [{max_load}]\napproach_step = 0.05\n"
    )
}

fn cases(out: &Path) -> Frame {
    read_table(&out.join("statistics/cases.parquet"), &schema::CASES).unwrap()
}

fn number(frame: &Frame, column: &str) -> Option<f64> {
    frame.f64_or_null(column).unwrap()[0]
}

/// Version 0.1.0 gave areas of 5 to 23 A0 and negative dissipated energies here, with exit code 0.
#[test]
fn e2e_a_contact_beyond_full_contact_fails_in_a_sentence() {
    for (surface, material, load) in [
        ("", "contact_modulus_pa = 1e3", "0.002"),
        ("", "work_of_adhesion_j_m2 = 100", "0.002"),
        ("", "", "0.2"),
        ("length_m = 1.0", "", "0.002"),
    ] {
        let bench = Bench::new(&spec(surface, material, load));
        let run = bench.verb("run", &[]);
        assert_eq!(code(&run), 3, "{surface} {material} {load}: {}", stderr(&run));
        let help = if load == "0.2" {
            "help: reduce cycle.max_load, or set model.method = \"boundary_elements\""
        } else {
            "help: adhesion alone closes the contact"
        };
        assert!(stderr(&run).contains(help) && stderr(&run).contains("boundary_elements"), "{}", stderr(&run));
        // The report begins with the reason and the next step, and claims no results.
        let page = std::fs::read_to_string(bench.out().join("report.html")).unwrap();
        let banner = page.split("class=\"banner red\" role=\"alert\">").nth(1).and_then(|rest| rest.split("</div>").next()).unwrap();
        for words in
            ["No results: all 2 cycles failed.", " leaves no gap ", "Next step: ", "boundary_elements", "2 cycles, for example H0.80_z8_r0"]
        {
            assert!(banner.contains(words), "{words}: {banner}");
        }
        for words in ["validated range", "Methods paragraph", "<svg", "confidence intervals of", "Single cycle", "Model validity</h2>"] {
            assert!(!page.contains(words), "{words}: {page}");
        }
        assert!(std::fs::read_dir(bench.out().join("figures")).unwrap().next().is_none(), "a figure of nothing");
        let frame = cases(&bench.out());
        assert_eq!((frame.i64("done_count").unwrap()[0], frame.i64("failed_count").unwrap()[0]), (0, 2));
        for column in ["loss_mean", "pull_off_load_mean", "area_at_max_load_mean", "audit_gap_max"] {
            assert_eq!(number(&frame, column), None, "{column}");
        }
        // The surfaces alone decide on these.
        for column in
            ["persson_tosatti_mean", "persson_tosatti_realised_mean", "conformity_mean", "conformity_realised_min", "summit_count_mean"]
        {
            assert!(number(&frame, column).unwrap() > 0.0, "{column}");
        }
        let carried = frame.text("caution").unwrap()[0].to_owned();
        let sticky = number(&frame, "persson_tosatti_realised_mean").unwrap() < 2.0;
        assert_eq!(carried.starts_with("sticky+"), sticky, "{carried}");
        assert!(carried.contains("failed+incomplete"), "{carried}");
        let folders: Vec<_> = std::fs::read_dir(bench.out().join("cycles")).unwrap().map(|entry| entry.unwrap().path()).collect();
        assert_eq!(folders.len(), 2);
        for folder in folders {
            assert!(!folder.join("steps.parquet").exists(), "tables of a failed cycle");
            assert!(std::fs::read_to_string(folder.join("failed.json")).unwrap().contains("help: "));
        }
    }
}

#[test]
fn e2e_without_adhesion_nothing_is_dissipated() {
    let bench = Bench::new(&spec("", "work_of_adhesion_j_m2 = 0", "0.001, 0.004"));
    let run = bench.verb("run", &[]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    let realizations = read_table(&bench.out().join("statistics/realizations.parquet"), &schema::REALIZATIONS).unwrap();
    assert_eq!(realizations.f64("loss").unwrap(), [0.0; 4]);
    assert_eq!(realizations.f64("pull_off_load").unwrap(), [0.0; 4]);
    assert!(realizations.f64("area_at_max_load").unwrap().iter().all(|area| (0.01..0.2).contains(area)));
    assert_eq!(realizations.f64("dissipated").unwrap(), [0.0; 4]);
    let frame = cases(&bench.out());
    for column in ["persson_tosatti_mean", "conformity_realised_mean", "fuller_tabor_mean", "loss_ratio_dk_mean", "absorption_share_mean"] {
        assert_eq!(number(&frame, column), None, "{column}");
    }
    assert!(!frame.text("caution").unwrap()[0].contains("tabor"));
    let page = std::fs::read_to_string(bench.out().join("report.html")).unwrap();
    assert!(!page.contains("NaN") && !page.contains(">inf"), "a number of the report is none");
}

/// Version 0.1.0 did not warn of this: 92 % of the dissipated energy of the second surface is absorption and release.
#[test]
fn e2e_a_dissipated_energy_of_absorption_is_a_warning() {
    let text = spec("", "work_of_adhesion_j_m2 = 1e-3", "0.002").replace("magnification = 8", "magnification = 16");
    let text = text.replace("[model]", "[model]\ncoalescence = \"cover\"");
    let bench = Bench::new(&text);
    let run = bench.verb("run", &[]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    let frame = cases(&bench.out());
    assert!(number(&frame, "absorption_share_max").unwrap() > 0.9, "{:?}", number(&frame, "absorption_share_max"));
    assert!(frame.text("caution").unwrap()[0].contains("absorption"));
    let said = stdout(&bench.verb("run", &["--verbose"]));
    assert!(said.contains("warning[absorption]"), "{said}");
}

/// A jump off after a splitting had fourteen times Θ here, and the share was 14.
#[test]
fn e2e_the_share_of_coalescence_is_a_share_with_merging() {
    let text = "name = \"x\"\nseed = 7\nrealizations = 3\n[surface]\nmagnification = 32\n[material]\nwork_of_adhesion_j_m2 = 0.005\n[model]\n\
                coalescence = \"merge\"\n[cycle]\nmax_load = [0.002]\napproach_step = 0.05\n";
    let bench = Bench::new(text);
    let run = bench.verb("run", &["--until", "aggregate"]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    let frame = read_table(&bench.out().join("statistics/realizations.parquet"), &schema::REALIZATIONS).unwrap();
    let shares = frame.f64("absorption_share").unwrap();
    assert!(shares.iter().all(|share| (0.0..0.1).contains(share)), "{shares:?}");
    let (merged, loss) = (frame.f64("dissipated_merge").unwrap(), frame.f64("loss").unwrap());
    // Without the constants of the merged contacts it was above ten times Θ on one surface.
    assert!(merged.iter().zip(&loss).all(|(merged, loss)| merged.abs() < *loss), "{merged:?} {loss:?}");
}

/// Version 0.1.0 did not end here, and its memory grew.
#[test]
fn e2e_a_low_tabor_parameter_ends() {
    let bench = Bench::new(&spec("", "work_of_adhesion_j_m2 = 1e-6", "0.002"));
    let run = bench.verb("run", &["--until", "cycle"]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
}

/// The first sweep of the quickstart is inside the range of the model: the first thing that a user sees is no warning of it.
#[test]
fn e2e_the_quickstart_has_a_contact_inside_the_range() {
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("pipelines/quickstart.toml")).unwrap();
    let bench = Bench::new(&text);
    let run = bench.verb("run", &["--until", "aggregate"]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    // Small samples; and the energy balance of absorption, where the asperities are outside their range.
    let small = "few_contacts+few_asperities";
    assert_eq!(cases(&bench.out()).text("caution").unwrap(), [small, "", &format!("sticky+area+conformed+audit+{small}"), ""]);
    let said = stdout(&run);
    let verdicts: Vec<&str> = said.lines().filter(|line| line.starts_with("Verdict: ")).collect();
    assert_eq!(verdicts.len(), 2, "{said}");
    assert!(verdicts[0].starts_with("Verdict: separate contacts: within the range of the asperity model"), "{said}");
    assert!(verdicts[1].starts_with("Verdict: near full contact: the asperity model has 0.5"), "{said}");
    let warnings = said.split("Verdict: near").nth(1).unwrap().split("\n\n").nth(2).unwrap();
    assert!(warnings.lines().count() <= 3 && warnings.contains("report.html"), "{said}");
    assert!(said.lines().all(|line| line.chars().count() <= 80 || line.contains('/')), "{said}");
}
