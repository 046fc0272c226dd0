//! A JSON Schema of specs, from the table of keys, for editors that complete and check them.

use std::collections::BTreeMap;

use serde::Serialize;
use serde_json::{Value, json};

use super::auto::METHODS;
use super::figures::{FORMATS, Figures, LOADS, LONGEST_FONT, WIDTH};
use super::keys::{KEYS, Key, Kind, Limits, TABLES, words};
use super::realizations::{DEFAULT, DEFAULT_BOUNDS, LEAST, PRECISION};
use super::reference::described;
use super::top::DEFAULT_SEED;
use super::{MAX_REALIZATIONS, Values, coarser};
use crate::lengths::LENGTH_PATTERN;
use crate::model::{Choice, Goal};

/// The name of the schema's file.
pub const SCHEMA_FILE: &str = "spec.v1.json";

/// A name, as the reader of a spec accepts it.
const NAME: &str = "^[A-Za-z0-9_-]{1,64}$";

/// Text without control characters.
const PLAIN: &str = "^[^\\u0000-\\u001f\\u007f-\\u009f]*$";

/// A checksum.
const DIGEST: &str = "^[0-9a-f]{64}$";

/// A JSON value whose members are sorted: the order of `serde_json` depends on its features.
#[derive(Serialize)]
#[serde(untagged)]
enum Sorted {
    Members(BTreeMap<String, Sorted>),
    Items(Vec<Sorted>),
    Plain(Value),
}

impl From<Value> for Sorted {
    fn from(value: Value) -> Self {
        match value {
            Value::Object(members) => {
                Self::Members(members.into_iter().map(|(name, value)| (name, value.into())).collect())
            }
            Value::Array(items) => Self::Items(items.into_iter().map(Self::from).collect()),
            plain => Self::Plain(plain),
        }
    }
}

/// The schema (draft 2020-12) as indented JSON with a final newline.
///
/// It has every key with type, range, default and meaning. Rules that join several keys are checked by the
/// program only.
#[must_use]
pub fn json_schema() -> String {
    let definitions: BTreeMap<&str, Value> = KEYS.iter().map(|key| (key.path, definition(key))).collect();
    let mut properties: BTreeMap<&str, Value> =
        TABLES.into_iter().map(|table| (table, section(table, outside))).collect();
    let mut in_sweep: BTreeMap<&str, Value> =
        TABLES.into_iter().map(|table| (table, section(table, axis))).collect();
    let name = |meaning: &str| json!({ "type": "string", "pattern": NAME, "description": meaning });
    in_sweep.insert("name", name("Name of the sweep, unique in the spec."));
    properties.insert("name", name("Name of the run and of its default output directory."));
    in_sweep.insert("zip", zip());
    let seed = json!({
        "type": "integer", "minimum": 0, "maximum": i64::MAX, "default": DEFAULT_SEED,
        "description": "Seed of all generated surfaces.",
    });
    properties.insert("seed", seed);
    properties.insert("realizations", realizations());
    properties.insert("figures", figures());
    properties.insert("experiment", experiment());
    let sweep = json!({
        "type": "object", "required": ["name"], "additionalProperties": false, "properties": in_sweep,
    });
    properties.insert(
        "sweep",
        json!({ "type": "array", "items": sweep, "description": "Each sweep overrides keys; arrays in one \
             sweep multiply, but for those of `zip`." }),
    );
    let files = json!({ "type": "string", "pattern": DIGEST });
    properties.insert(
        "files",
        json!({
            "type": "object", "additionalProperties": files,
            "description": "BLAKE3 checksums of measured files; written by the program.",
        }),
    );
    let chosen = json!({ "type": "string", "enum": METHODS });
    properties.insert(
        "auto_methods",
        json!({ "type": "array", "items": chosen, "description": "Methods that method = \"auto\" chose, case \
             by case; written by the program." }),
    );
    properties.insert(
        super::sides::KEY,
        json!({ "type": "array", "items": number(&super::sides::LIMITS), "description": "Sides of the scans \
             with a load in newtons \\[m\\], case by case; written by the program." }),
    );
    let schema = json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Spec of hysteron",
        "type": "object",
        "required": ["name"],
        "additionalProperties": false,
        "properties": properties,
        "$defs": definitions,
    });
    // Strings, finite numbers and truth values always serialize, so nothing is lost by the default.
    let mut text = serde_json::to_string_pretty(&Sorted::from(schema)).unwrap_or_default();
    text.push('\n');
    text
}

fn section(table: &str, of: fn(&Key) -> Value) -> Value {
    let keys: BTreeMap<&str, Value> =
        KEYS.iter().filter(|key| key.table == table).map(|key| (key.name, of(key))).collect();
    json!({ "type": "object", "additionalProperties": false, "properties": keys })
}

/// The value of a key.
fn key(key: &Key) -> Value {
    json!({ "$ref": format!("#/$defs/{}", key.path) })
}

/// The value of a key outside of sweeps, which may be a list of grids.
fn outside(of: &Key) -> Value {
    let Kind::Count { high, .. } = &of.kind else { return key(of) };
    if !coarser::LISTS.contains(&of.path) {
        return key(of);
    }
    let grid = json!({ "type": "integer", "minimum": coarser::fewest(of), "maximum": high });
    let list = json!({
        "type": "array", "items": grid, "minItems": 1, "maxItems": coarser::MOST, "uniqueItems": true,
    });
    json!({ "anyOf": [key(of), list] })
}

/// The value or the values of a key in a sweep.
fn axis(of: &Key) -> Value {
    json!({ "anyOf": [key(of), { "type": "array", "items": key(of), "minItems": 1 }] })
}

/// Groups of keys that advance together.
fn zip() -> Value {
    let paths: Vec<&str> = KEYS.iter().map(|key| key.path).collect();
    let group = json!({
        "type": "array", "items": { "type": "string", "enum": paths }, "minItems": 2, "uniqueItems": true,
    });
    let groups = json!({ "type": "array", "items": group, "minItems": 1 });
    json!({
        "anyOf": [group, groups],
        "description": "Keys of the sweep whose arrays advance together instead of multiplying; several \
             groups as an array of arrays.",
    })
}

fn definition(key: &Key) -> Value {
    let mut schema = match &key.kind {
        Kind::Number(limits) => number(limits),
        Kind::Numbers(limits, most) => {
            json!({
                "type": "array", "items": number(limits), "minItems": 1, "maxItems": most,
                "uniqueItems": true,
            })
        }
        Kind::Count { low, high, .. } => json!({ "type": "integer", "minimum": low, "maximum": high }),
        Kind::Flag => json!({ "type": "boolean" }),
        Kind::Word(choice) => json!({ "type": "string", "enum": words(choice) }),
        Kind::Words(choice) => {
            json!({ "type": "array", "items": { "type": "string", "enum": words(choice) } })
        }
        Kind::Text(most, _) => {
            json!({
                "type": "string", "minLength": i32::from(key.path == "surface.file"), "maxLength": most,
                "pattern": PLAIN,
            })
        }
        Kind::Texts(count, most, _) => {
            let item = json!({ "type": "string", "minLength": 1, "maxLength": most, "pattern": PLAIN });
            json!({ "type": "array", "items": item, "minItems": 1, "maxItems": count, "uniqueItems": true })
        }
        Kind::Length(_) => json!({ "type": "string", "maxLength": 16, "pattern": LENGTH_PATTERN }),
    };
    let symbol = if key.symbol.is_empty() { String::new() } else { format!("{}: ", key.symbol) };
    let (_, unit, _) = described(&key.kind);
    let unit = if unit.is_empty() { String::new() } else { format!(" [{unit}]") };
    let choices = match &key.kind {
        Kind::Word(choice) | Kind::Words(choice) => {
            choice.iter().map(|(word, meaning)| format!(" \"{word}\": {}", meaning.trim())).collect()
        }
        _ => String::new(),
    };
    schema["description"] = format!("{symbol}{}{unit}{choices}", key.meaning).into();
    let default = json!((key.get)(&Values::default()));
    if default != "" && !matches!(key.kind, Kind::Texts(..)) {
        schema["default"] = default;
    }
    schema
}

fn number(limits: &Limits) -> Value {
    let low = if limits.above { "exclusiveMinimum" } else { "minimum" };
    json!({ "type": "number", low: limits.low, "maximum": limits.high })
}

fn experiment() -> Value {
    use super::experiment::{LONGEST, MODULUS, MOST_LOOPS, RADIUS, STIFFNESS, WORDS};
    let text = |meaning: &str| {
        json!({
            "type": "string", "pattern": PLAIN, "minLength": 1, "maxLength": LONGEST,
            "description": meaning,
        })
    };
    let mut keys: BTreeMap<&str, Value> =
        super::experiment::MEANINGS.iter().map(|(name, _, meaning)| (*name, text(meaning))).collect();
    for (name, choice) in WORDS {
        keys.insert(name, json!({ "type": "string", "enum": words(choice), "default": choice[0].0 }));
    }
    for (name, limits) in
        [("probe_radius_m", RADIUS), ("contact_modulus_pa", MODULUS), ("machine_stiffness_n_m", STIFFNESS)]
    {
        let mut schema = number(&limits);
        schema["description"] = limits.note.into();
        keys.insert(name, schema);
    }
    let file = json!({ "type": "string", "pattern": PLAIN, "minLength": 1, "maxLength": LONGEST });
    keys.insert(
        "loops",
        json!({
            "type": "array", "items": file, "minItems": 1, "maxItems": MOST_LOOPS, "uniqueItems": true,
            "description": "Files of measured loops.",
        }),
    );
    json!({
        "type": "object", "additionalProperties": false, "properties": keys, "required": ["loops"],
        "description": "Measured loops for comparison with the simulated ones.",
    })
}

fn figures() -> Value {
    let default = Figures::default();
    let format = json!({ "type": "string", "enum": FORMATS });
    let group = json!({
        "type": "array", "items": { "type": "string", "pattern": NAME }, "minItems": 2, "uniqueItems": true,
    });
    json!({
        "type": "object",
        "additionalProperties": false,
        "properties": {
            "format": {
                "anyOf": [format, { "type": "array", "items": format, "minItems": 1 }],
                "default": default.format, "description": "File formats of the figures.",
            },
            "width_mm": {
                "type": "number", "minimum": WIDTH.low, "maximum": WIDTH.high, "default": default.width_mm,
                "description": "Width of a panel in PNG and PDF files [mm].",
            },
            "font": {
                "type": "string", "pattern": PLAIN, "minLength": 1, "maxLength": LONGEST_FONT,
                "default": default.font,
                "description": "Font family of the SVG files; PNG and PDF files have DejaVu Sans.",
            },
            "loads": {
                "type": "string", "enum": LOADS, "default": default.loads,
                "description": "Loads in the figures of sweeps of other parameters.",
            },
            "across": {
                "anyOf": [group, { "type": "array", "items": group, "minItems": 1 }],
                "description": "Sweeps with figures of all of their cases together; several groups as an \
                     array of arrays.",
            },
        },
        "description": "Files of the figures.",
    })
}

fn realizations() -> Value {
    let goals: Vec<&str> = Goal::WORDS.iter().map(|(word, _)| *word).collect();
    let count = |least: u32, default: u32| {
        json!({
            "type": "integer", "minimum": least, "maximum": MAX_REALIZATIONS, "default": default,
        })
    };
    let until = json!({
        "type": "object",
        "required": ["until_relative_ci"],
        "additionalProperties": false,
        "properties": {
            "until_relative_ci": number(&PRECISION),
            "of": { "type": "string", "enum": goals, "default": Goal::Loss.word() },
            "min": count(LEAST, DEFAULT_BOUNDS.0),
            "max": count(LEAST, DEFAULT_BOUNDS.1),
        },
    });
    json!({
        "anyOf": [count(1, DEFAULT), until],
        "description": "Number of surfaces of each case, or the relative half-width of the 95 % confidence \
             interval that ends sampling.",
    })
}
