//! The spec: what it takes, what it refuses, and in which words.

use std::path::{Path, PathBuf};

use hysteron::model::{
    Amplitudes, Boundary, Choice, Coalescence, Interaction, JumpIn, KeptContacts, Normalization,
    Slip,
};
use hysteron::spec::{CaseParams, Spec, UNAVAILABLE};

/// The files of a folder of the package, with their names and texts, sorted.
fn specs(folder: &str) -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut paths: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    paths.sort();
    let name = |path: &Path| path.file_name().unwrap().to_str().unwrap().to_owned();
    paths
        .iter()
        .map(|path| {
            (
                name(path),
                std::fs::read_to_string(path).unwrap().replace("\r\n", "\n"),
            )
        })
        .collect()
}

/// Every spec that ought to be accepted.
fn accepted() -> Vec<(String, String)> {
    [specs("tests/specs/good"), specs("pipelines")].concat()
}

/// What a file expects of its own reading.
fn expectations<'a>(text: &'a str, mark: &str) -> Vec<&'a str> {
    text.lines()
        .filter_map(|line| line.strip_prefix(mark))
        .collect()
}

fn errors_in(rendered: &str) -> usize {
    rendered
        .lines()
        .filter(|line| line.starts_with("error: "))
        .count()
}

/// The one fault of a text, rendered.
fn refused(text: &str) -> String {
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
        assert!(
            expected
                .iter()
                .any(|part| part.starts_with(&format!("--> {name}:"))),
            "{name} expects no place"
        );
        for part in &expected {
            assert!(
                rendered.contains(part),
                "{name} lacks `{part}`:\n{rendered}"
            );
        }
        let wanted = expected
            .iter()
            .filter(|part| part.starts_with("error: "))
            .count();
        assert_eq!(
            errors_in(&rendered),
            wanted,
            "{name} has other faults too:\n{rendered}"
        );
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
        let again = Spec::parse(&written, "campaign.toml")
            .unwrap_or_else(|errors| panic!("{name}:\n{errors}"));
        assert_eq!(again, spec, "{name}");
        assert_eq!(again.to_toml(), written, "{name}");
        // Others read it too, with any TOML reader.
        let table: toml::Table = written.parse().unwrap();
        assert_eq!(
            table.get("name").and_then(toml::Value::as_str),
            Some(spec.name.as_str()),
            "{name}"
        );
    }
}

#[test]
fn law_the_written_spec_holds_every_key_of_a_case() {
    let written: toml::Table = Spec::parse("name = \"x\"", "x")
        .unwrap()
        .to_toml()
        .parse()
        .unwrap();
    let json = serde_json::to_value(CaseParams::default()).unwrap();
    for (table, keys) in json.as_object().unwrap() {
        let wanted: Vec<&String> = keys.as_object().unwrap().keys().collect();
        let mut found: Vec<&String> = written[table].as_table().unwrap().keys().collect();
        found.sort();
        assert_eq!(found, wanted, "[{table}]");
    }
}

#[test]
fn law_case_parameters_survive_json() {
    for (name, text) in accepted() {
        for case in Spec::parse(&text, &name).unwrap().cases.iter().take(20) {
            let json = serde_json::to_string(&case.params).unwrap();
            assert_eq!(
                serde_json::from_str::<CaseParams>(&json).unwrap(),
                case.params,
                "{name}"
            );
        }
    }
}

#[test]
fn val_the_paper_is_eight_cases() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("pipelines/paper.toml");
    let spec = Spec::read(path).unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!((spec.name.as_str(), spec.realizations), ("paper", 6));
    let told: Vec<_> = spec
        .cases
        .iter()
        .map(|case| {
            let surface = &case.params.surface;
            (
                case.sweeps.join("+"),
                surface.magnification,
                surface.hurst,
                case.params.cycle.max_load.clone(),
            )
        })
        .collect();
    let one = |sweeps: &str, zeta, hurst| (sweeps.to_owned(), zeta, hurst, vec![0.0071]);
    let wanted = vec![
        (
            "fig3".to_owned(),
            128,
            0.8,
            vec![0.004, 0.0071, 0.012, 0.015],
        ),
        one("fig4", 64, 0.8),
        one("fig4+fig5", 128, 0.8),
        one("fig4", 256, 0.8),
        one("fig4", 512, 0.8),
        one("fig5", 128, 0.45),
        one("fig5", 128, 0.65),
        one("fig5", 128, 0.95),
    ];
    assert_eq!(told, wanted);
    // What the paper does not vary is what a spec that says nothing gets.
    let mut base = spec.base;
    base.cycle.max_load = CaseParams::default().cycle.max_load;
    assert_eq!(base, CaseParams::default());
}

#[test]
fn val_the_quickstart_is_two_small_cases() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("pipelines/quickstart.toml");
    let spec = Spec::read(path).unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!(
        (spec.name.as_str(), spec.realizations, spec.cases.len()),
        ("quickstart", 3, 2)
    );
    assert_eq!(
        spec.cases
            .iter()
            .map(|case| case.params.surface.grid())
            .collect::<Vec<_>>(),
        [256, 512]
    );
    assert!(
        spec.cases
            .iter()
            .all(|case| case.params.cycle.max_load == [0.004, 0.0071])
    );
}

/// Every bound of every number: the least and the greatest that are allowed, and the next beyond.
#[test]
fn val_bounds_are_where_the_message_says() {
    // Table, key, refused below, allowed, allowed, refused above; what else must be written for the two to be a case.
    let bounds = [
        (
            "surface",
            "length_m",
            "9.99e-10",
            "1e-9",
            "1",
            "1.0000001",
            "rms_height_m = 1e-12",
        ),
        (
            "surface",
            "rms_height_m",
            "9.99e-13",
            "1e-12",
            "0.1",
            "0.1000001",
            "length_m = 1",
        ),
        ("surface", "hurst", "0.0", "1e-300", "1.0", "1.0000001", ""),
        ("surface", "magnification", "1", "2", "4096", "4097", ""),
        (
            "surface",
            "magnification",
            "1",
            "2",
            "8192",
            "16385",
            "points_per_shortest_wavelength = 4",
        ),
        (
            "surface",
            "points_per_shortest_wavelength",
            "3",
            "4",
            "64",
            "65",
            "",
        ),
        (
            "material",
            "contact_modulus_pa",
            "0.999",
            "1",
            "1e13",
            "1.0001e13",
            "",
        ),
        (
            "material",
            "work_of_adhesion_j_m2",
            "0",
            "1e-300",
            "1e3",
            "1000.001",
            "",
        ),
        (
            "material",
            "interaction_range_m",
            "9.99e-13",
            "1e-12",
            "1e-5",
            "1.001e-5",
            "",
        ),
        (
            "cycle",
            "max_load",
            "[0.0]",
            "[1e-300]",
            "[0.2]",
            "[0.2000001]",
            "",
        ),
        (
            "cycle",
            "approach_step",
            "9.99e-7",
            "1e-6",
            "1",
            "1.0000001",
            "",
        ),
    ];
    for (table, key, below, least, greatest, above, also) in bounds {
        let text = |value: &str| format!("name = \"x\"\n[{table}]\n{also}\n{key} = {value}\n");
        for value in [least, greatest] {
            assert_eq!(
                Spec::parse(&text(value), "x")
                    .map_err(|errors| errors.to_string())
                    .map(|_| ()),
                Ok(())
            );
        }
        for value in [below, above] {
            let rendered = refused(&text(value));
            assert!(rendered.contains("--> x.toml:4:"), "{rendered}");
        }
        // A sweep holds the same bounds.
        let swept = format!(
            "name = \"x\"\n[{table}]\n{also}\n[[sweep]]\nname = \"s\"\n{table}.{key} = [{below}]\n"
        );
        assert!(refused(&swept).contains("--> x.toml:6:"));
    }
}

fn words<T: Choice>(key: &'static str) -> Vec<(&'static str, &'static str)> {
    T::WORDS.iter().map(|(word, _)| (key, *word)).collect()
}

/// Every word of every choice, with its key; the words of a list are marked by the key.
fn all_words() -> Vec<(&'static str, &'static str)> {
    [
        words::<Normalization>("surface.normalization"),
        words::<Amplitudes>("surface.amplitudes"),
        words::<Interaction>("model.interaction"),
        words::<Boundary>("model.boundary"),
        words::<Coalescence>("model.coalescence"),
        words::<JumpIn>("model.jump_in"),
        words::<Slip>("model.as_printed"),
        words::<KeptContacts>("cycle.contacts"),
    ]
    .concat()
}

#[test]
fn law_every_word_is_taken_unless_the_table_says_why_not() {
    let all = all_words();
    for (key, word, _) in UNAVAILABLE {
        assert!(all.contains(&(*key, *word)), "{key} has no word {word}");
    }
    for (key, word) in all {
        let value = if key == "model.as_printed" {
            format!("[\"{word}\"]")
        } else {
            format!("\"{word}\"")
        };
        let text = format!("name = \"x\"\n{key} = {value}\n");
        match UNAVAILABLE
            .iter()
            .find(|(path, known, _)| *path == key && *known == word)
        {
            None => {
                let spec = Spec::parse(&text, "x.toml").unwrap_or_else(|errors| panic!("{errors}"));
                let json = serde_json::to_value(&spec.cases[0].params).unwrap();
                let found = json
                    .pointer(&format!("/{}", key.replace('.', "/")))
                    .unwrap();
                assert_eq!(found.to_string(), value, "{key}");
            }
            Some((_, _, reason)) => {
                let rendered = refused(&text);
                let sentence = format!(
                    "`{key}` cannot be \"{word}\": {reason} is not available in this version"
                );
                assert!(rendered.contains(&sentence), "{rendered}");
                assert!(rendered.contains("allowed now: "), "{rendered}");
                let allowed = rendered
                    .lines()
                    .find(|line| line.contains("allowed now: "))
                    .unwrap();
                assert!(!allowed.contains(&format!("\"{word}\"")), "{rendered}");
            }
        }
    }
}

#[test]
fn law_slips_are_sorted_and_stand_once() {
    let can: Vec<&str> = Slip::WORDS
        .iter()
        .map(|(word, _)| *word)
        .filter(|word| {
            !UNAVAILABLE
                .iter()
                .any(|(key, known, _)| *key == "model.as_printed" && known == word)
        })
        .collect();
    let quoted: Vec<String> = can
        .iter()
        .rev()
        .chain(&can)
        .map(|word| format!("\"{word}\""))
        .collect();
    let text = format!("name = \"x\"\nmodel.as_printed = [{}]\n", quoted.join(", "));
    let slips = Spec::parse(&text, "x.toml")
        .unwrap()
        .cases
        .remove(0)
        .params
        .model
        .as_printed;
    assert_eq!(
        slips.iter().map(|slip| slip.word()).collect::<Vec<_>>(),
        can
    );
    assert!(slips.is_sorted());
}

/// The caret stands below the character that line and column name, for every fault of every bad spec.
#[test]
fn law_carets_stand_below_their_place() {
    let mut seen = 0;
    for (name, text) in specs("tests/specs/bad") {
        for fault in Spec::parse(&text, &name).unwrap_err().faults() {
            let place = fault.place.as_ref().unwrap();
            let line: Vec<char> = text
                .split('\n')
                .nth(place.line - 1)
                .expect(&name)
                .chars()
                .collect();
            assert!(
                place.column <= line.len() + 1,
                "{name}: column {} of {}",
                place.column,
                line.len()
            );
            let pad = place.carets.chars().take_while(|c| *c != '^').count();
            let marked = place.carets.chars().count() - pad;
            assert!(
                marked >= 1 && place.carets.chars().skip(pad).all(|c| c == '^'),
                "{name}"
            );
            // A tab above has a tab below, or else the caret would shift with the width of tabs.
            for (above, below) in place.excerpt.chars().zip(place.carets.chars().take(pad)) {
                assert_eq!(above == '\t', below == '\t', "{name}");
            }
            if let Some(wanted) = line.get(place.column - 1) {
                assert_eq!(place.excerpt.chars().nth(pad), Some(*wanted), "{name}");
                seen += 1;
            }
        }
    }
    assert!(seen > 60, "{seen}");
}

#[test]
fn val_line_ends_and_byte_order_marks_do_not_shift_a_place() {
    let plain = refused("name = \"x\"\n[surface]\nhurst = 2\n");
    assert_eq!(refused("name = \"x\"\r\n[surface]\r\nhurst = 2\r\n"), plain);
    let first = refused("nme = 3\nname = \"x\"\n");
    assert!(first.contains("--> x.toml:1:1\n"), "{first}");
    assert_eq!(refused("\u{feff}nme = 3\nname = \"x\"\n"), first);
}

#[test]
fn val_a_fault_looks_like_this() {
    let wanted = "error: unknown key `hurts` in [surface]\n  --> x.toml:3:1\n   |\n 3 | hurts = 0.8\n   | ^^^^^\n   = \
                  did you mean `hurst`? [surface] takes: length_m, rms_height_m, hurst, magnification, \
                  points_per_shortest_wavelength, normalization, amplitudes\n";
    assert_eq!(refused("name = \"x\"\n[surface]\nhurts = 0.8\n"), wanted);
}

#[test]
fn val_an_empty_spec_says_so() {
    for text in ["", "\n\n", "# only a comment\n"] {
        let rendered = refused(text);
        assert!(
            rendered.contains("error: the spec is empty: it needs a `name`"),
            "{rendered}"
        );
        assert!(rendered.contains("--> x.toml:1:1"), "{rendered}");
    }
}

#[test]
fn val_very_many_faults_are_counted_and_not_all_shown() {
    let text: String = (0..1000).map(|number| format!("x{number} = 1\n")).collect();
    let rendered = Spec::parse(&format!("name = \"x\"\n{text}"), "x.toml")
        .unwrap_err()
        .to_string();
    assert_eq!(errors_in(&rendered), 200);
    assert!(rendered.ends_with("… and 800 more\n"), "{rendered}");
}

#[test]
fn e2e_files_that_cannot_be_read_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let message = |path: &Path| Spec::read(path).unwrap_err().to_string();

    let missing = folder.path().join("missing.toml");
    let wanted = format!(
        "error: the spec cannot be read: there is no such file\n  --> {}\n",
        missing.display()
    );
    assert_eq!(message(&missing), wanted);

    let said = message(folder.path());
    assert!(
        said.contains("it is a folder; a spec is a TOML file"),
        "{said}"
    );

    let latin = folder.path().join("latin.toml");
    std::fs::write(&latin, b"name = \"x\"\n# \xb5m: 5 \xe4\n").unwrap();
    let said = message(&latin);
    assert!(
        said.contains("error: the spec cannot be read: this is not UTF-8 text"),
        "{said}"
    );
    assert!(
        said.contains("latin.toml:2:3\n") && said.contains("save the file as UTF-8"),
        "{said}"
    );

    let long = folder.path().join("long.toml");
    std::fs::write(&long, vec![b'\n'; (4 << 20) + 1]).unwrap();
    let said = message(&long);
    assert!(said.contains("it is longer than 4 MiB"), "{said}");

    let good = folder.path().join("good.toml");
    std::fs::write(&good, "name = \"x\"\n").unwrap();
    assert_eq!(
        Spec::read(&good).unwrap(),
        Spec::parse("name = \"x\"\n", "elsewhere").unwrap()
    );
}

/// Numbers that only look random: the same ones in every run.
struct Lcg(u64);

impl Lcg {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        usize::try_from(self.0 >> 33).unwrap() % bound.max(1)
    }
}

const SPLICES: &[&str] = &[
    "",
    "\n",
    "\t",
    "\r",
    "\u{feff}",
    "ζ",
    "漢",
    "e\u{301}",
    "\0",
    "\u{1b}",
    "[",
    "]",
    "[[",
    "]]",
    "{",
    "}",
    "=",
    ".",
    ",",
    "#",
    "\"",
    "'",
    "\"\"\"",
    "'''",
    "\\u0000",
    "nan",
    "-inf",
    "1e999",
    "-0.0",
    "0x",
    "0",
    "-1",
    "9223372036854775808",
    "true",
    "2021-01-07",
    "[]",
    "[[]]",
    "{}",
    "[[sweep]]\n",
    "[sweep]\n",
    "name = \"s\"\n",
    "surface.hurst = [0.1, 0.2]\n",
    "surface.magnification = [3, 4, 5]\n",
    "cycle.max_load = [[0.1], []]\n",
    "model.as_printed = [\"a2\"]\n",
    "file = 1\n",
];

#[test]
fn law_no_text_makes_the_reader_panic() {
    let seeds: Vec<String> = accepted()
        .into_iter()
        .filter(|(name, _)| name != "ten_thousand.toml")
        .map(|(_, text)| text)
        .collect();
    let mut random = Lcg(2021);
    let (mut good, mut bad) = (0, 0);
    for round in 0..6000 {
        let mut text: Vec<char> = seeds[round % seeds.len()].chars().collect();
        for _ in 0..=random.below(4) {
            let at = random.below(text.len() + 1);
            let until = (at + random.below(8)).min(text.len());
            match random.below(4) {
                0 => drop(text.drain(at..until)),
                1 => drop(text.splice(at..until, SPLICES[random.below(SPLICES.len())].chars())),
                2 => drop(text.splice(at..at, SPLICES[random.below(SPLICES.len())].chars())),
                _ => {
                    let piece: Vec<char> =
                        text[at..(at + random.below(60)).min(text.len())].to_vec();
                    let to = random.below(text.len() + 1);
                    drop(text.splice(to..to, piece));
                }
            }
        }
        let text: String = text.into_iter().collect();
        match Spec::parse(&text, "x.toml") {
            Ok(spec) => {
                good += 1;
                assert_eq!(
                    Spec::parse(&spec.to_toml(), "again.toml").as_ref(),
                    Ok(&spec),
                    "{text}"
                );
            }
            Err(errors) => {
                bad += 1;
                assert!(!errors.faults().is_empty(), "{text}");
                let rendered = errors.to_string();
                assert_eq!(errors_in(&rendered), errors.faults().len(), "{rendered}");
                assert!(
                    !rendered.contains('\u{1b}') && !rendered.contains('\0'),
                    "{rendered:?}"
                );
            }
        }
    }
    assert!(good > 500 && bad > 500, "{good} good, {bad} bad");
}
