//! Numbers in the README and the guide that are constants of the program, and times that several pages state.

use super::blocks::pages;
use hysteron::cli::constants;
use hysteron::constants::number;
use hysteron::stats::{CAUTIONS, LIMITS, LONGEST_STEP, Limit};
use std::collections::BTreeSet;
use std::path::Path;

/// The text of a page of the guide, or of a file from the root of the repository, with single spaces.
fn text(name: &str) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let path = if name.contains(['/', 'R']) { root.join(name) } else { root.join("src/guide").join(name) };
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The values of a constant.
fn values(name: &str) -> &'static [f64] {
    let all = constants();
    let found = all.iter().flat_map(|of| of.rows).find(|constant| constant.name == name);
    found.unwrap_or_else(|| panic!("there is no constant {name}")).values
}

/// The limit of a warning.
fn bound(code: &str) -> f64 {
    Limit::of(code).unwrap().bound
}

/// Sentences with numbers in braces: page, sentence, and the numbers that the program has.
fn sentences() -> Vec<(&'static str, &'static str, Vec<f64>)> {
    let percent = |share: f64| (100.0 * share * 1e9).round() / 1e9;
    let checkpoints = values("asperities of a cycle with checkpoints").to_vec();
    let violation = values("violation of sign or energy balance")[0];
    let clusters = [values("signal before a time limit")[0], values("early signal")[0]];
    vec![
        ("README.md", "with more than {} % of the area in contact", vec![percent(bound("area"))]),
        ("README.md", "rms height × rms gradient < {} × work of adhesion", vec![4.0 * bound("sticky")]),
        ("README.md", "If more than {} % of the spots overlap", vec![percent(bound("touching"))]),
        ("README.md", "if Θ < 0 by more than {} % of the work of loading", vec![percent(violation)]),
        ("validity.md", "`E* h_rms h'_rms < {} Δγ` therefore implies `U_el < {} Δγ`", vec![4.0 * bound("sticky"), bound("sticky")]),
        ("howto_scan.md", "If E\\* h_rms h'_rms < {} Δγ, then U_el < {} Δγ", vec![4.0 * bound("sticky"), bound("sticky")]),
        ("glossary.md", "`U_el < {} Δγ` (warning `sticky`) or `A/A0 > {}`", vec![bound("sticky"), bound("area")]),
        ("howto_scan.md", "| texture aspect ratio | below {}? |", vec![bound("texture")]),
        ("validity.md", "| texture aspect ratio above {} |", vec![bound("texture")]),
        ("boundary_elements.md", "Attraction of a range acts over {} ρ", values("gap at which the attraction ends").to_vec()),
        ("boundary_elements.md", "announces more than {} steps, and more than {} are refused", values("steps over that gap").to_vec()),
        ("boundary_elements.md", "After {} steps of a cycle none is halved", values("steps that may be halved").to_vec()),
        ("boundary_elements.md", "`approach_step/2^halvings` above {}", vec![LONGEST_STEP]),
        ("boundary_elements.md", "where `loss_uncertainty` exceeds {}", vec![bound("unresolved")]),
        ("reference_limits.md", "`approach_step`/2^`halvings` > {}", vec![LONGEST_STEP]),
        ("validity.md", "points beyond {} robust standard deviations", values("outlier").to_vec()),
        ("howto_scan.md", "A ratio above {} is an error", values("ratio of the pixel sizes").to_vec()),
        ("howto_scan.md", "if more than {} % of the scan is dropped", vec![percent(values("part outside the central square")[0])]),
        ("howto_scan.md", "must have {} to {} points along a side", values("points along a side").to_vec()),
        ("howto_cluster.md", "A cycle with {} asperities or more", checkpoints.clone()),
        ("howto_cluster.md", "The signal comes {} s before the limit", clusters[..1].to_vec()),
        ("howto_cluster.md", "Slurm may send it up to {} s earlier", clusters[1..].to_vec()),
        ("howto_cluster.md", "one for each surface, at most {}", values("parts of a run, default").to_vec()),
        ("howto_recover.md", "cycles with {} asperities or more", checkpoints),
        ("howto_recover.md", "`Tabor parameter below {}`", values("Tabor parameter of Wu's criterion").to_vec()),
        ("howto_sweep.md", "A spec has at most {} cases", values("cases of a spec").to_vec()),
        ("model.md", "reaches its centre to {} of its radius", values("distance of absorption").to_vec()),
    ]
}

#[test]
fn e2e_numbers_of_the_guide_are_those_of_the_program() {
    for (page, sentence, numbers) in sentences() {
        let wanted = numbers.iter().fold(sentence.to_owned(), |sentence, value| sentence.replacen("{}", &number(*value), 1));
        assert!(text(page).contains(&wanted), "{page} does not state\n{wanted}");
    }
}

#[test]
fn e2e_limits_of_the_decision_table_are_those_of_the_warnings() {
    let page = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("src/guide/validity.md")).unwrap();
    let section = page.split("## Decision table").nth(1).unwrap().split("\n## ").next().unwrap();
    let mut count = 0;
    for line in section.lines().filter(|line| line.starts_with("| `")) {
        let cells: Vec<&str> = line.trim_matches('|').split(" | ").map(str::trim).collect();
        let Some(limit) = LIMITS.iter().find(|limit| cells[0] == format!("`{}`", limit.column)) else { continue };
        let sign = if limit.at_least { '<' } else { '>' };
        assert_eq!(cells[1], format!("{sign} {}", number(limit.bound)), "{line}");
        count += 1;
    }
    assert!(count >= 10, "{count}");
}

#[test]
fn e2e_the_page_of_limits_has_every_constant_once() {
    let page = text("reference_limits.md");
    let mut names = BTreeSet::new();
    for of in constants() {
        assert!(page.contains(&format!("## {} Module `{}`.", of.subject, of.module)), "{}", of.subject);
        for constant in of.rows {
            assert!(names.insert((of.subject, constant.name)), "{} twice in {}", constant.name, of.subject);
            assert!(page.contains(&format!("| {} | {} |", constant.name, constant.text())), "{}", constant.name);
            assert!(!constant.values.is_empty() && constant.meaning.ends_with(['.', ')']), "{}", constant.name);
        }
    }
    for caution in CAUTIONS {
        assert!(
            page.contains(&format!("- `{}`, {}: {} {}", caution.code, caution.label, caution.consequence, caution.action)),
            "{}",
            caution.code
        );
    }
    assert!(names.len() >= 60, "{}", names.len());
}

/// Every time that a spec states in its head is a row of the table of runs, and the README has the row of cycles.
#[test]
fn e2e_times_are_the_same_on_every_page() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let performance = std::fs::read_to_string(root.join("src/guide/performance.md")).unwrap();
    let mut count = 0;
    for entry in std::fs::read_dir(root.join("pipelines")).unwrap() {
        let path = entry.unwrap().path();
        let spec = std::fs::read_to_string(&path).unwrap();
        let Some(time) = spec.split("Time: ").nth(1).and_then(|rest| rest.split_once(" on two cores")).map(|(time, _)| time) else {
            continue;
        };
        let name = format!("`pipelines/{}`", path.file_name().unwrap().to_str().unwrap());
        if time.starts_with(|c: char| c.is_ascii_digit()) {
            let row = performance.lines().find(|line| line.starts_with(&format!("| {name}"))).unwrap_or_else(|| panic!("no row {name}"));
            assert!(row.ends_with(&format!("| {time} |")), "{name}: {time} is not in\n{row}");
            count += 1;
        }
    }
    assert!(count >= 4, "{count}");
    let readme = std::fs::read_to_string(root.join("README.md")).unwrap();
    let row = readme.lines().find(|line| line.starts_with("| time of a cycle |")).unwrap();
    assert!(performance.lines().any(|line| line == row), "{row}");
    let quickstart = "20 s";
    for (page, sentence) in [("README.md", "2 cores, the run {}."), ("tutorial.md", "The run takes about {} on 2 cores.")] {
        assert!(text(page).contains(&sentence.replace("{}", quickstart)), "{page}");
    }
    assert!(performance.contains(&format!("| `pipelines/quickstart.toml` | 12 cycles, ζ = 8, both methods | {quickstart} |")));
}

#[test]
fn e2e_pages_have_no_limits_of_warnings_in_other_words() {
    // The limits of a warning are on the generated page; a table of codes with limits elsewhere would go stale.
    for page in pages().iter().filter(|page| page.is_of_guide() && page.name != "reference_limits.md") {
        let text = std::fs::read_to_string(&page.path).unwrap();
        assert!(!text.contains("| warning if |"), "{}", page.name);
    }
}
