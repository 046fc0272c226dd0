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
    insta::assert_snapshot!(refused("name = \"x\"\n[surface]\nhurts = 0.8\n"), @r"
    error: unknown key `hurts` in [surface]
      --> x.toml:3:1
       |
     3 | hurts = 0.8
       | ^^^^^
       = help: did you mean `hurst`? keys of [surface]: length_m, rms_height_m, hurst, magnification, points_per_shortest_wavelength, normalization, amplitudes, longest_wavelength_m, roll_off_m, aspect_ratio, angle_deg, spectrum, spectrum_kind, spectrum_convention, spectrum_unit, spectrum_series, file, files, dataset, periodic, pixel_m, size_m, size_y_m, unit, skip_lines, width, transpose, missing, detrend, filter, outliers, align_rows, fast_axis, tip_radius_m
    ");
    // A tab above has a tab below.
    insta::assert_snapshot!(refused("name = \"x\"\n[cycle]\n\tmax_load = [0.1, -0.2]\n").replace('\t', "<tab>"), @r"
    error: `cycle.max_load` cannot be -0.2: it must be greater than 0 and at most 0.2
      --> x.toml:3:19
       |
     3 | <tab>max_load = [0.1, -0.2]
       | <tab>                 ^^^^
       = help: F_max/(E* A0), maximum load, dimensionless; typical 0.004 to 0.015; near full contact above about 0.07
    ");
}

#[test]
fn val_a_symbol_is_answered_with_its_key() {
    for (table, symbol, help) in [
        ("surface", "zeta", "ζ is `magnification`"),
        ("surface", "hrms", "h_rms is `rms_height_m`"),
        ("cycle", "step", "the output step Δ/h_rms is `approach_step`"),
        ("cycle", "zeta", "ζ is `magnification` in [surface]"),
        ("material", "delta_gamma", "Δγ is `work_of_adhesion_j_m2`"),
        ("material", "youngs_modulus", "E* = E/(1 − ν²) is `contact_modulus_pa`"),
        ("material", "\"Δγ\"", "Δγ is `work_of_adhesion_j_m2`"),
    ] {
        let rendered = refused(&format!("name = \"x\"\n[{table}]\n{symbol} = 1\n"));
        assert!(rendered.ends_with(&format!("= help: {help}\n")), "{rendered}");
    }
    // A symbol names an existing key.
    let top = refused("name = \"x\"\nf_max = 1\n");
    assert!(top.ends_with("= help: F_max/(E* A0) is `max_load` in [cycle]\n"), "{top}");
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
    assert_eq!(errors_in(&rendered), 20);
    assert!(rendered.ends_with("… and 980 more\n"), "{rendered}");
    assert!(rendered.contains("--> x.toml:2:1\n") && rendered.contains("--> x.toml:21:1\n"), "the first ones: {rendered}");
}

#[test]
fn val_a_sweep_of_bad_values_is_answered_in_a_screenful() {
    let values: Vec<String> = (0..1000).map(|number| format!("{number}.5")).collect();
    let text = format!("name = \"x\"\n[[sweep]]\nname = \"s\"\nsurface.hurst = [{}]\n", values.join(", "));
    let rendered = Spec::parse(&text, "x.toml").unwrap_err().to_string();
    // 0.5 is allowed.
    assert!(rendered.ends_with("… and 979 more\n"), "{rendered}");
    // Twenty faults of four lines with an excerpt of 100 characters each.
    assert!(rendered.len() < 20 * 4 * 130, "{} bytes", rendered.len());
}

/// Reads a text in a thread of its own. A reader whose time grows as the square of the text takes minutes to hours for these; this one takes seconds.
fn answered(text: String) -> String {
    let (tell, told) = std::sync::mpsc::channel();
    std::thread::spawn(move || tell.send(Spec::parse(&text, "x.toml").map_or_else(|errors| errors.to_string(), |_| String::new())));
    told.recv_timeout(std::time::Duration::from_secs(100)).expect("no answer after 100 s")
}

#[test]
fn law_the_time_of_the_answer_grows_as_the_text_does() {
    let lines = |count: usize, line: &dyn Fn(usize) -> String| "name = \"x\"\n".to_owned() + &(0..count).map(line).collect::<String>();
    let tried: [(&str, String, &str); 6] = [
        ("one key 300 000 times", lines(300_000, &|_| "bogus=1\n".to_owned()), "error: the spec is not valid TOML: duplicate key"),
        ("table headers", lines(300_000, &|k| format!("[a{k}]\n")), "error: unknown key `a0` at the top of the spec"),
        ("unknown keys", lines(300_000, &|k| format!("k{k}=1\n")), "error: unknown key `k0` at the top of the spec"),
        ("broken lines", lines(300_000, &|k| format!("k{k}=\n")), "error: the spec is not valid TOML"),
        ("sweeps", lines(150_000, &|k| format!("[[sweep]]\nname=\"s{k}\"\n")), "error: the sweeps make 150000 cases"),
        ("words", lines(1, &|_| format!("model.as_printed=[{}]\n", "\"x\",".repeat(300_000))), "unknown value \"x\" of `model.as_printed`"),
    ];
    for (what, text, begins) in tried {
        let rendered = answered(text);
        assert!(rendered.contains(begins), "{what}: {}", &rendered[..rendered.len().min(300)]);
        assert!(errors_in(&rendered) <= 20, "{what}: {} errors", errors_in(&rendered));
    }
}

#[test]
fn val_a_hash_of_a_file_that_no_case_reads_is_refused() {
    let digest = "0".repeat(64);
    let text = |name: &str| {
        format!("name = \"x\"\n[surface]\nfile = \"a.x3p\"\n[model]\nboundary = \"isolated\"\n[files]\n\"{name}\" = \"{digest}\"\n")
    };
    assert_eq!(Spec::parse(&text("a.x3p"), "x.toml").unwrap().files.len(), 1);
    let rendered = refused(&text("b.x3p"));
    assert!(rendered.contains("[files] has a checksum of \"b.x3p\", which is not used by any case\n  --> x.toml:7:1"), "{rendered}");
}

#[test]
fn val_a_campaign_has_ten_million_tasks_at_most() {
    let text = |magnifications: usize, realizations: usize| {
        let values: Vec<String> = (0..magnifications).map(|k| (2 + 2 * k).to_string()).collect();
        format!("name = \"x\"\nrealizations = {realizations}\n[[sweep]]\nname = \"s\"\nsurface.magnification = [{}]\n", values.join(", "))
    };
    // 3 tasks for each of 400 surfaces: 9 999 600 and 10 000 800.
    assert!(Spec::parse(&text(400, 8333), "x.toml").is_ok());
    let rendered = refused(&text(400, 8334));
    assert!(rendered.contains("400 cases x 8334 realizations make 10000800 tasks"), "{rendered}");
    assert!(rendered.contains("--> x.toml:2:16\n") && rendered.contains("at most 10000000 are allowed"), "{rendered}");
    // Cases that share their surfaces have one task more each; and what a precision may ask for at most counts.
    let adhesion: Vec<String> = (1..=1000).map(|k| format!("{k}e-4")).collect();
    let swept = |most: usize| {
        format!(
            "name = \"x\"\nrealizations = {{ until_relative_ci = 0.1, max = {most} }}\n[[sweep]]\nname = \"s\"\nmaterial.work_of_adhesion_j_m2 = [{}]\n",
            adhesion.join(", ")
        )
    };
    assert!(Spec::parse(&swept(9980), "x.toml").is_ok());
    assert!(refused(&swept(9981)).contains("1000 cases x 9981 realizations make 10000962 tasks"));
}

#[test]
fn e2e_files_that_cannot_be_read_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let message = |path: &Path| Spec::read(path).unwrap_err().to_string();

    let missing = folder.path().join("missing.toml");
    let wanted = format!("error: cannot read the spec: no such file\n  --> {}\n   = help: give the path of a spec; ", missing.display());
    assert!(message(&missing).starts_with(&wanted), "{}", message(&missing));

    let said = message(folder.path());
    assert!(said.contains("it is a directory, not a TOML file"), "{said}");

    let latin = folder.path().join("latin.toml");
    std::fs::write(&latin, b"name = \"x\"\n# \xb5m: 5 \xe4\n").unwrap();
    let said = message(&latin);
    assert!(said.contains("error: cannot read the spec: not UTF-8 text"), "{said}");
    assert!(said.contains("latin.toml:2:3\n") && said.contains("save the file as UTF-8"), "{said}");

    let long = folder.path().join("long.toml");
    std::fs::write(&long, vec![b'\n'; (4 << 20) + 1]).unwrap();
    let said = message(&long);
    assert!(said.contains("it is longer than 4 MiB"), "{said}");

    let good = folder.path().join("good.toml");
    std::fs::write(&good, "name = \"x\"\n").unwrap();
    assert_eq!(Spec::read(&good).unwrap(), Spec::parse("name = \"x\"\n", "elsewhere").unwrap());
}
