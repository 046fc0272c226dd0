//! How a fault is told, and files that cannot be read.

use std::path::Path;

use hysteron::spec::Spec;

use super::{errors_in, refused, specs};

/// The caret stands below the character that line and column name, for every fault of every bad spec.
#[test]
fn law_carets_stand_below_their_place() {
    let mut seen = 0;
    for (name, text) in specs("tests/specs/bad") {
        for fault in Spec::parse(&text, &name).unwrap_err().faults() {
            let place = fault.place.as_ref().unwrap();
            let line: Vec<char> = text.split('\n').nth(place.line - 1).expect(&name).chars().collect();
            assert!(place.column <= line.len() + 1, "{name}: column {} of {}", place.column, line.len());
            let pad = place.carets.chars().take_while(|c| *c != '^').count();
            let marked = place.carets.chars().count() - pad;
            assert!(marked >= 1 && place.carets.chars().skip(pad).all(|c| c == '^'), "{name}");
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
                  points_per_shortest_wavelength, normalization, amplitudes, file, dataset, periodic, pixel_m, unit, missing, detrend\n";
    assert_eq!(refused("name = \"x\"\n[surface]\nhurts = 0.8\n"), wanted);
}

#[test]
fn val_an_empty_spec_says_so() {
    for text in ["", "\n\n", "# only a comment\n"] {
        let rendered = refused(text);
        assert!(rendered.contains("error: the spec is empty: it needs a `name`"), "{rendered}");
        assert!(rendered.contains("--> x.toml:1:1"), "{rendered}");
    }
}

#[test]
fn val_very_many_faults_are_counted_and_not_all_shown() {
    let text: String = (0..1000).map(|number| format!("x{number} = 1\n")).collect();
    let rendered = Spec::parse(&format!("name = \"x\"\n{text}"), "x.toml").unwrap_err().to_string();
    assert_eq!(errors_in(&rendered), 200);
    assert!(rendered.ends_with("… and 800 more\n"), "{rendered}");
}

#[test]
fn e2e_files_that_cannot_be_read_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let message = |path: &Path| Spec::read(path).unwrap_err().to_string();

    let missing = folder.path().join("missing.toml");
    let wanted = format!("error: the spec cannot be read: there is no such file\n  --> {}\n", missing.display());
    assert_eq!(message(&missing), wanted);

    let said = message(folder.path());
    assert!(said.contains("it is a folder; a spec is a TOML file"), "{said}");

    let latin = folder.path().join("latin.toml");
    std::fs::write(&latin, b"name = \"x\"\n# \xb5m: 5 \xe4\n").unwrap();
    let said = message(&latin);
    assert!(said.contains("error: the spec cannot be read: this is not UTF-8 text"), "{said}");
    assert!(said.contains("latin.toml:2:3\n") && said.contains("save the file as UTF-8"), "{said}");

    let long = folder.path().join("long.toml");
    std::fs::write(&long, vec![b'\n'; (4 << 20) + 1]).unwrap();
    let said = message(&long);
    assert!(said.contains("it is longer than 4 MiB"), "{said}");

    let good = folder.path().join("good.toml");
    std::fs::write(&good, "name = \"x\"\n").unwrap();
    assert_eq!(Spec::read(&good).unwrap(), Spec::parse("name = \"x\"\n", "elsewhere").unwrap());
}
