//! The JSON Schema of specs and the reference page: complete, and in agreement with the reader of specs.

use hysteron::lengths::{LENGTH_PATTERN, metres};
use hysteron::spec::{CaseParams, OF_ASPERITIES, Spec, json_schema, reference};
use serde_json::Value;

use super::{accepted, specs};

/// Bad specs whose fault no JSON Schema shows: it joins several values, or is the point of an integer written as a float.
const BEYOND: [&str; 32] = [
    "across_same_file",
    "across_same_group",
    "across_unknown",
    "copies_in_sweep",
    "copies_of_scan",
    "copies_on_probe",
    "copies_without_list",
    "elements_negligible_adhesion",
    "files_realizations",
    "files_with_file",
    "grid_odd",
    "grid_too_large",
    "grids_too_coarse",
    "grids_unsorted",
    "integer_is_float",
    "measured_surface",
    "million_cases",
    "more_cases_than_a_register_counts",
    "realizations_most_below_least",
    "rms_above_default_length",
    "rms_above_length",
    "rms_equals_length",
    "seed_float",
    "sweep_grid_too_large",
    "sweep_measured",
    "sweep_names_equal",
    "zip_first_is_single",
    "zip_list_of_loads",
    "zip_not_listed",
    "zip_single_value",
    "zip_twice",
    "zip_unequal",
];

/// The schema, parsed.
pub fn root() -> Value {
    serde_json::from_str(&json_schema()).unwrap()
}

/// Whether a value is valid under a schema. A keyword that this validator does not have ends the test.
pub fn valid(schema: &Value, value: &Value, root: &Value) -> bool {
    schema.as_object().unwrap().iter().all(|(keyword, limit)| {
        let number = |holds: fn(f64, f64) -> bool| value.as_f64().is_none_or(|found| holds(found, limit.as_f64().unwrap()));
        let length = |holds: fn(f64, f64) -> bool| {
            let found = value.as_str().map(|text| text.chars().count()).or(value.as_array().map(Vec::len));
            found.is_none_or(|found| holds(found as f64, limit.as_f64().unwrap()))
        };
        match keyword.as_str() {
            "$schema" | "$defs" | "title" | "description" | "default" => true,
            "$ref" => valid(&root["$defs"][limit.as_str().unwrap().strip_prefix("#/$defs/").unwrap()], value, root),
            "type" => is_of_type(limit.as_str().unwrap(), value),
            "enum" => limit.as_array().unwrap().contains(value),
            "anyOf" => limit.as_array().unwrap().iter().any(|one| valid(one, value, root)),
            "minimum" => number(|found, limit| found >= limit),
            "exclusiveMinimum" => number(|found, limit| found > limit),
            "maximum" => number(|found, limit| found <= limit),
            "minLength" | "minItems" => length(|found, limit| found >= limit),
            "maxLength" | "maxItems" => length(|found, limit| found <= limit),
            "pattern" => value.as_str().is_none_or(|text| matches(limit.as_str().unwrap(), text)),
            "items" => value.as_array().is_none_or(|items| items.iter().all(|item| valid(limit, item, root))),
            "uniqueItems" => value.as_array().is_none_or(|items| {
                let numbers: Vec<_> = items.iter().map(|item| (item.as_f64().map(f64::to_bits), item.as_str())).collect();
                (1..numbers.len()).all(|at| !numbers[..at].contains(&numbers[at]))
            }),
            "required" => value
                .as_object()
                .is_none_or(|members| limit.as_array().unwrap().iter().all(|name| members.contains_key(name.as_str().unwrap()))),
            "properties" => value
                .as_object()
                .is_none_or(|members| members.iter().all(|(name, value)| limit.get(name).is_none_or(|schema| valid(schema, value, root)))),
            "additionalProperties" => value.as_object().is_none_or(|members| {
                let others = members.iter().filter(|(name, _)| schema["properties"].get(name).is_none());
                others.map(|(_, value)| value).all(|value| limit.is_object() && valid(limit, value, root))
            }),
            unknown => panic!("the validator of this test has no keyword {unknown}"),
        }
    })
}

fn is_of_type(name: &str, value: &Value) -> bool {
    match name {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "number" => value.is_number(),
        "integer" => value.as_f64().is_some_and(|number| number.fract() == 0.0),
        unknown => panic!("{unknown} is not a type"),
    }
}

fn matches(pattern: &str, text: &str) -> bool {
    match pattern {
        "^[A-Za-z0-9_-]{1,64}$" => {
            (1..=64).contains(&text.len()) && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-')
        }
        "^[0-9a-f]{64}$" => text.len() == 64 && text.bytes().all(|c| matches!(c, b'0'..=b'9' | b'a'..=b'f')),
        r"^[^\u0000-\u001f\u007f-\u009f]*$" => !text.chars().any(char::is_control),
        LENGTH_PATTERN => text.is_empty() || metres(text).is_some(),
        unknown => panic!("the validator of this test has no pattern {unknown}"),
    }
}

/// Whether the text of a spec is TOML that is valid under the schema.
fn is_valid(text: &str) -> bool {
    let root = root();
    text.parse::<toml::Table>().is_ok_and(|table| valid(&root, &serde_json::to_value(table).unwrap(), &root))
}

#[test]
fn val_the_schema_accepts_every_good_spec() {
    for (name, text) in accepted() {
        assert!(is_valid(&text), "{name}");
    }
}

#[test]
fn val_the_schema_refuses_faults_of_type_and_range() {
    for (name, text) in specs("tests/specs/bad") {
        let stem = name.strip_suffix(".toml").unwrap();
        assert_eq!(is_valid(&text), BEYOND.contains(&stem), "{name}");
    }
}

#[test]
fn law_every_key_is_in_the_schema_and_on_the_page() {
    let (root, page) = (root(), reference());
    let tables = serde_json::to_value(CaseParams::default()).unwrap();
    let mut count = 0;
    for (table, keys) in tables.as_object().unwrap() {
        for (key, default) in keys.as_object().unwrap() {
            let path = format!("{table}.{key}");
            let schema = &root["$defs"][path.as_str()];
            assert!(schema["description"].as_str().unwrap().len() > 12, "{path}");
            // An empty text stands for a key that is left out.
            assert!(*default == "" || schema["default"] == *default, "{path}");
            assert!(*default == "" || valid(schema, default, &root), "{path}");
            assert_eq!(page.matches(&format!("| `{path}` | ")).count(), 1, "{path}");
            let named = tables.as_object().unwrap().values().filter(|keys| keys.get(key).is_some()).count();
            assert_eq!(page.matches(&format!("\n- `{key}`: ")).count(), named, "{path}");
            for word in schema.pointer("/enum").or(schema.pointer("/items/enum")).and_then(Value::as_array).into_iter().flatten() {
                assert!(page.contains(&format!("\n  - `{word}`: ")), "{path}: {word}");
            }
            count += 1;
        }
    }
    // Files of several scans, loads in two other units, four other keys of the grid, and the keys of probe, machine and substrate, which
    // a case by default does not have.
    assert_eq!(root["$defs"].as_object().unwrap().len(), count + 1 + 2 + 4 + 1 + 4 + 2);
    for line in page.lines() {
        assert!(line.chars().count() <= 100, "{line}");
    }
}

/// The page names every table that a sweep may override.
#[test]
fn law_the_page_names_the_tables_of_a_sweep() {
    let (root, page) = (root(), reference());
    let part = page.split("\n## `[[sweep]]`\n").nth(1).unwrap().split("```").next().unwrap();
    let keys = root["properties"]["sweep"]["items"]["properties"].as_object().unwrap();
    let tables: Vec<&String> = keys.keys().filter(|key| !["name", "zip"].contains(&key.as_str())).collect();
    assert!(tables.len() >= 8 && tables.iter().all(|table| part.contains(&format!("`[{table}]`"))), "{tables:?}: {part}");
    assert_eq!(part.matches("`[").count(), tables.len(), "{part}");
}

/// The keys of `[model]` that the asperity model alone reads: with boundary elements they change no case.
#[test]
fn law_boundary_elements_read_no_key_of_the_asperity_model() {
    let tables = serde_json::to_value(CaseParams::default()).unwrap();
    let others = ["as_printed", "method"];
    let read: Vec<&String> = tables["model"].as_object().unwrap().keys().filter(|key| !others.contains(&key.as_str())).collect();
    assert!(read.len() == OF_ASPERITIES.len() && read.iter().all(|key| OF_ASPERITIES.contains(&key.as_str())), "{read:?}");
    let cases = |more: &str| {
        let spec =
            format!("name = \"x\"\nmodel.method = \"boundary_elements\"\nboundary_elements.points = 64\nsurface.magnification = 8\n{more}");
        Spec::parse(&spec, "x").unwrap().cases
    };
    let keys = "model.interaction = \"point\"\nmodel.coalescence = \"none\"\nmodel.jump_in = \"jkr\"\nmodel.allow_low_tabor = true\n";
    assert_eq!(cases(keys), cases(""));
}
