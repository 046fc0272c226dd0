//! The spec: what it takes, what it refuses, and in which words.

mod elements;
mod faults;
mod mutations;
mod rules;
pub mod schema;

use std::path::{Path, PathBuf};

use hysteron::model::{Coalescence, Normalization};
use hysteron::spec::{CaseParams, MEASURED, Realizations, Spec, Values, WHERE_USED};

/// The files of a folder of the package, with their names and texts, sorted.
fn specs(folder: &str) -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut paths: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let name = |path: &Path| path.file_name().unwrap().to_str().unwrap().to_owned();
    paths.iter().map(|path| (name(path), std::fs::read_to_string(path).unwrap().replace("\r\n", "\n"))).collect()
}

/// Every spec that ought to be accepted.
fn accepted() -> Vec<(String, String)> {
    [specs("tests/specs/good"), specs("pipelines")].concat()
}

/// What a file expects of its own reading.
fn expectations<'a>(text: &'a str, mark: &str) -> Vec<&'a str> {
    text.lines().filter_map(|line| line.strip_prefix(mark)).collect()
}

fn errors_in(rendered: &str) -> usize {
    rendered.lines().filter(|line| line.starts_with("error: ")).count()
}

/// The one fault of a text, rendered.
pub fn refused(text: &str) -> String {
    let rendered = Spec::parse(text, "x.toml").expect_err(text).to_string();
    assert_eq!(errors_in(&rendered), 1, "{text}\n{rendered}");
    rendered
}

#[test]
fn val_bad_specs_are_refused_in_these_words() {
    let files = specs("tests/specs/bad");
    assert!(files.len() >= 35);
    for (name, text) in files {
        let rendered = match Spec::parse(&text, &name) {
            Ok(spec) => panic!("{name} was accepted: {spec:?}"),
            Err(errors) => errors.to_string(),
        };
        let expected = expectations(&text, "#^ ");
        assert!(expected.iter().any(|part| part.starts_with(&format!("--> {name}:"))), "{name} expects no place");
        for part in &expected {
            assert!(rendered.contains(part), "{name} lacks `{part}`:\n{rendered}");
        }
        let wanted = expected.iter().filter(|part| part.starts_with("error: ")).count();
        assert_eq!(errors_in(&rendered), wanted, "{name} has other faults too:\n{rendered}");
    }
}

#[test]
fn val_good_specs_make_these_cases() {
    for (name, text) in specs("tests/specs/good") {
        let spec = Spec::parse(&text, &name).unwrap_or_else(|errors| panic!("{errors}"));
        let json = serde_json::to_value(&spec).unwrap();
        let expected = expectations(&text, "#= ");
        assert!(!expected.is_empty(), "{name} expects nothing");
        for line in expected {
            let (what, value) = line.split_once(' ').unwrap();
            if what == "cases" {
                assert_eq!(spec.cases.len(), value.parse::<usize>().unwrap(), "{name}");
            } else {
                let wanted: serde_json::Value = serde_json::from_str(value).unwrap();
                assert_eq!(json.pointer(what), Some(&wanted), "{name}: {what}");
            }
        }
    }
}

#[test]
fn law_a_spec_written_out_reads_back_equal() {
    for (name, text) in accepted() {
        let spec = Spec::parse(&text, &name).unwrap_or_else(|errors| panic!("{errors}"));
        let written = spec.to_toml();
        let again = Spec::parse(&written, "campaign.toml").unwrap_or_else(|errors| panic!("{name}:\n{errors}"));
        assert_eq!(again, spec, "{name}");
        assert_eq!(again.to_toml(), written, "{name}");
        // Others read it too, with any TOML reader.
        let table: toml::Table = written.parse().unwrap();
        assert_eq!(table.get("name").and_then(toml::Value::as_str), Some(spec.name.as_str()), "{name}");
    }
}

#[test]
fn law_the_written_spec_holds_every_key_of_a_case() {
    let written: toml::Table = Spec::parse("name = \"x\"", "x").unwrap().to_toml().parse().unwrap();
    let json = serde_json::to_value(CaseParams::default()).unwrap();
    for (table, keys) in json.as_object().unwrap() {
        // What only a measured surface has stands in the spec of one; the shape of a spectrum where it is not the default.
        let wanted: Vec<&String> = keys
            .as_object()
            .unwrap()
            .keys()
            .filter(|key| !MEASURED.contains(&key.as_str()) && !WHERE_USED.contains(&key.as_str()))
            .collect();
        let mut found: Vec<&String> = written[table].as_table().unwrap().keys().collect();
        found.sort();
        assert_eq!(found, wanted, "[{table}]");
    }
}

#[test]
fn law_a_case_is_what_its_values_say() {
    for (name, text) in accepted() {
        for case in Spec::parse(&text, &name).unwrap().cases.iter().take(20) {
            let values = Values::from(&case.params);
            assert_eq!(values.case(), case.params, "{name}");
            assert_eq!(serde_json::to_value(&case.params).unwrap(), serde_json::to_value(values).unwrap(), "{name}");
        }
    }
}

#[test]
fn val_the_paper_is_eight_cases() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("pipelines/paper.toml");
    let spec = Spec::read(path).unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!((spec.name.as_str(), spec.realizations), ("paper", Realizations::Exactly(6)));
    let told: Vec<_> = spec
        .cases
        .iter()
        .map(|case| {
            let surface = case.params.surface.generated().unwrap();
            (case.sweeps.join("+"), surface.magnification, surface.hurst, case.params.cycle.max_load.clone())
        })
        .collect();
    let one = |sweeps: &str, zeta, hurst| (sweeps.to_owned(), zeta, hurst, vec![0.0071]);
    let wanted = vec![
        ("fig3".to_owned(), 128, 0.8, vec![0.004, 0.0071, 0.012, 0.015]),
        one("fig4", 64, 0.8),
        one("fig4+fig5", 128, 0.8),
        one("fig4", 256, 0.8),
        one("fig4", 512, 0.8),
        one("fig5", 128, 0.45),
        one("fig5", 128, 0.65),
        one("fig5", 128, 0.95),
    ];
    assert_eq!(told, wanted);
    // What the paper does not vary is the default, but for the constant of the spectrum and the coalescence rule.
    let mut base = spec.base;
    assert_eq!((base.generated.normalization, base.asperities.coalescence), (Normalization::Spectrum, Coalescence::Cover));
    base.asperities.coalescence = Values::default().asperities.coalescence;
    base.generated.normalization = Normalization::Sample;
    base.cycle.max_load = Values::default().cycle.max_load;
    assert_eq!(base, Values::default());
}

#[test]
fn val_the_quickstart_is_two_small_contacts_by_both_methods() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("pipelines/quickstart.toml");
    let spec = Spec::read(path).unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!((spec.name.as_str(), spec.realizations, spec.cases.len()), ("quickstart", Realizations::Exactly(3), 4));
    assert_eq!(spec.cases.iter().map(|case| case.params.surface.generated().unwrap().grid()).collect::<Vec<_>>(), [64; 4]);
    assert_eq!(spec.cases.iter().map(|case| case.params.elements().is_some()).collect::<Vec<_>>(), [false, true, false, true]);
}

#[test]
fn val_the_sensitivity_varies_one_choice_at_a_time() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("pipelines");
    let spec = Spec::read(folder.join("sensitivity.toml")).unwrap_or_else(|errors| panic!("{errors}"));
    // Its base is the paper's central case with the defaults of the program.
    let paper = Spec::read(folder.join("paper.toml")).unwrap_or_else(|errors| panic!("{errors}"));
    let mut base = paper.base;
    base.generated.magnification = 128;
    base.generated.normalization = Normalization::Sample;
    assert_eq!((&spec.base, spec.seed, spec.realizations), (&base, paper.seed, paper.realizations));
    let json = |values: &Values| serde_json::to_value(values).unwrap();
    let wanted = json(&base);
    let mut choices = Vec::new();
    for case in &spec.cases {
        let found = json(&Values::from(&case.params));
        let differing: Vec<String> = wanted
            .as_object()
            .unwrap()
            .iter()
            .flat_map(|(table, keys)| keys.as_object().unwrap().iter().map(move |(key, value)| (table, key, value)))
            .filter(|(table, key, value)| found[table][key] != **value)
            .map(|(table, key, _)| format!("{table}.{key}"))
            .collect();
        match differing.as_slice() {
            [] => assert_eq!(case.sweeps.len(), spec.sweeps.len(), "every sweep holds the base"),
            [key] => choices.push(key.clone()),
            more => panic!("{more:?} at once"),
        }
    }
    choices.dedup();
    let names: Vec<&str> = spec.sweeps.iter().map(|sweep| sweep.name.as_str()).collect();
    assert_eq!(
        names,
        ["coalescence", "boundary", "interaction", "jump_in", "range", "points", "normalization", "amplitudes", "step", "as_printed"]
    );
    assert_eq!(choices.len(), names.len());
}

/// Every error says what to do, those of wrong types, numbers out of bounds and broken TOML too.
#[test]
fn val_every_error_of_a_spec_has_a_help() {
    let lines = [
        "seed = -1",
        "seed = \"a\"",
        "seed = 99999999999999999999",
        "realizations = 0",
        "realizations = { until_relative_ci = 0.1, min = 10, max = 3 }",
        "surface.magnification = 3.5",
        "surface.hurst = nan",
        "surface.hurst = true",
        "surface.length_m = inf",
        "cycle.max_load = []",
        "cycle.max_load = [\"a\"]",
        "boundary_elements.points = \"a\"",
        "boundary_elements.points = 64.5",
        "boundary_elements.points = [[16, 32], [32, 64]]",
        "boundary_elements.error = \"x\"",
        "boundary_elements.error = nan",
        "boundary_elements.shifted_copies = 1.5",
        "seed = [1",
        "name = \"again\"",
    ];
    for line in lines {
        let rendered = Spec::parse(&format!("name = \"x\"\n{line}\n"), "x.toml").expect_err(line).to_string();
        let (errors, helps) = (rendered.matches("error: ").count(), rendered.matches("= help: ").count());
        assert!(errors > 0 && errors == helps, "{line}:\n{rendered}");
    }
}
