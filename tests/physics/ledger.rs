//! Every public equation has a test: read from the source itself, so that a new one cannot be forgotten.

use std::fs;
use std::path::Path;

/// A public function of the source: its type, if it is a method or belongs to one, and its name.
#[derive(Debug, Clone, PartialEq)]
struct Function {
    module: &'static str,
    of: Option<String>,
    name: String,
    takes_self: bool,
}

/// The public functions of a source text, line by line: `impl` blocks begin at the margin, as rustfmt has it.
fn functions(module: &'static str, text: &str) -> Vec<Function> {
    let mut of: Option<String> = None;
    let mut found = Vec::new();
    for line in text.lines() {
        if let Some(rest) = line.strip_prefix("impl") {
            let name = rest.rsplit(" for ").next().unwrap_or(rest).trim_start_matches(|c: char| c != ' ').trim();
            of = Some(name.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect());
        } else if line.starts_with('}') {
            of = None;
        }
        let code = line.trim_start();
        let signature = code.strip_prefix("pub fn ").or_else(|| code.strip_prefix("pub const fn "));
        if let Some(signature) = signature {
            let name: String = signature.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
            let takes_self = signature.split(['(', ',', ')']).nth(1).is_some_and(|first| first.trim_end().ends_with("self"));
            found.push(Function { module, of: of.clone(), name, takes_self });
        }
    }
    found
}

/// Whether a test's text, without its comments, calls the function. Its file must name the function's module.
fn calls(text: &str, function: &Function) -> bool {
    let code: String = text.lines().map(|line| line.split("//").next().unwrap_or_default()).collect::<Vec<_>>().join("\n");
    let called = |pattern: &str| {
        code.match_indices(pattern).any(|(at, _)| {
            let before = code[..at].chars().next_back();
            pattern.starts_with('.') || !before.is_some_and(|c| c.is_alphanumeric() || c == '_' || c == '.')
        })
    };
    code.contains(&format!("{}::", function.module))
        && match &function.of {
            Some(_) if function.takes_self => called(&format!(".{}(", function.name)),
            Some(of) => called(&format!("{of}::{}(", function.name)),
            None => called(&format!("{}(", function.name)),
        }
}

#[test]
fn law_every_public_equation_has_a_test() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let sources = [
        ("jkr", "src/physics/jkr.rs"),
        ("spectrum", "src/physics/surface/spectrum.rs"),
        ("theory", "src/physics/theory/mod.rs"),
        ("flattening", "src/physics/theory/flattening.rs"),
        ("common_spectrum", "src/physics/surface/common_spectrum.rs"),
        ("cut_off", "src/physics/theory/cut_off.rs"),
        ("spot_field", "src/physics/asperities/field/spot_field.rs"),
        ("ewald", "src/physics/asperities/field/ewald.rs"),
    ];
    let tests: Vec<String> = fs::read_dir(root.join("tests/physics"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "rs") && path.file_name().is_some_and(|n| n != "ledger.rs" && n != "main.rs"))
        .map(|path| fs::read_to_string(path).unwrap())
        .collect();
    let mut untested = Vec::new();
    for (module, path) in sources {
        let found = functions(module, &fs::read_to_string(root.join(path)).unwrap());
        assert!(found.len() >= 3, "{path}: too few public functions found, the reader of this ledger is wrong: {found:?}");
        untested.extend(found.into_iter().filter(|f| !tests.iter().any(|text| calls(text, f))));
    }
    assert!(untested.is_empty(), "public functions without a test: {untested:#?}");
}

#[test]
fn reg_the_ledger_reads_functions_and_calls() {
    let source = "impl Spot {\n    pub fn load(&self, a: f64) -> f64 {\n    }\n    pub fn new() -> Self {\n    }\n}\n\npub fn free(x: f64) {\n}\nfn hidden() {}\n";
    let found = functions("pair", source);
    let names: Vec<(&str, bool)> = found.iter().map(|f| (f.name.as_str(), f.takes_self)).collect();
    assert_eq!(names, [("load", true), ("new", false), ("free", false)]);
    assert_eq!(found.iter().map(|f| f.of.as_deref()).collect::<Vec<_>>(), [Some("Spot"), Some("Spot"), None]);
    let with = |line: &str| format!("use physics::pair::Spot;\n{line}\n");
    for (function, good, bad) in [
        (&found[0], "spot.load(1.0)", "spot.load_slope(1.0) + load(1.0) // spot.load(1.0)"),
        (&found[1], "Spot::new()", "Other::new() + MySpot::new()"),
        (&found[2], "free(1.0)", "carefree(1.0) + x.free(1.0)"),
    ] {
        assert!(calls(&with(good), function), "{good}");
        assert!(!calls(&with(bad), function), "{bad}");
        assert!(!calls(good, function), "another module's");
    }
}
