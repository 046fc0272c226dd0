//! `--set`: values of the command line in place of those of the spec.

use super::SMALL;
use crate::bench::{Bench, SPEC, code, stderr};
use hysteron::spec::Spec;

fn with(text: &str, settings: &[&str]) -> Result<Spec, String> {
    let settings: Vec<String> = settings.iter().map(|&setting| setting.to_owned()).collect();
    Spec::parse_with(text, "x.toml", &settings).map_err(|errors| errors.to_string())
}

#[test]
fn law_a_setting_is_the_same_as_the_written_value() {
    let written = SMALL.replace("magnification = 6", "magnification = 8\nhurst = 0.7").replace("seed = 7", "seed = 9")
        + "[model]\ncoalescence = \"merge\"\nas_printed = [\"eq8\"]\n";
    let settings = ["surface.magnification=8", "surface.hurst = 0.7", "seed=9", "model.coalescence=merge", "model.as_printed=[\"eq8\"]"];
    assert_eq!(with(SMALL, &settings).unwrap(), Spec::parse(&written, "x.toml").unwrap());
    // The last one counts, as the last of a shell's aliases does.
    assert_eq!(with(SMALL, &["seed=1", "seed=2"]).unwrap().seed, 2);
    let adaptive = with(SMALL, &["realizations={ until_relative_ci = 0.05 }", "name=other"]).unwrap();
    assert!(adaptive.realizations.until().is_some() && adaptive.name == "other");
    // A sweep overrides the base, whoever wrote it.
    let swept = with(SPEC, &["surface.hurst=0.7", "cycle.max_load=[0.001]"]).unwrap();
    assert!(swept.cases.iter().all(|case| case.params.surface.generated().unwrap().hurst == 0.7 && case.params.cycle.max_load == [0.001]));
}

#[test]
fn val_faults_of_a_setting_name_the_option() {
    let told = |text: &str, setting: &str, wanted: &[&str]| {
        let said = with(text, &[setting]).unwrap_err();
        for part in wanted {
            assert!(said.contains(part), "{setting} lacks `{part}`: {said}");
        }
    };
    told(SMALL, "surface.hurst=7", &["error: `surface.hurst` cannot be 7", "--> --set:1:17", " 1 | surface.hurst = 7"]);
    told(SMALL, "surface.hurts=0.7", &["unknown key `hurts`", "did you mean `hurst`?", "--> --set:1:"]);
    told(SMALL, "surface.hurst=high", &["--> --set:1:17", "surface.hurst = \"high\""]);
    told(SMALL, "model.interaction=spot", &["did you mean \"spots\"?", "--> --set:1:"]);
    told(SMALL, "surface.hurst", &["a setting has no `=`", "--> --set:1:1", "KEY=VALUE"]);
    told(SMALL, "hurst=0.7", &["--set needs the table of `hurst`", "write --set surface.hurst=VALUE"]);
    told(SMALL, "=1", &["a setting has no key"]);
    told(SMALL, "seed=1\nname=\"x\"", &["control character"]);
    told(SMALL, "sweep=[]", &["--set cannot set `sweep`"]);
    told(SMALL, "surface={}", &["--set cannot set `surface`"]);
    told(SPEC, "surface.magnification=8", &["every sweep of the spec sets `surface.magnification`", "--set has no effect"]);
    // What only two values show has its place in the setting; the settings are named.
    let rms = [
        "must be less than `surface.length_m`",
        "--> --set:1:24\n",
        " 1 | surface.rms_height_m = 0.01\n",
        "|                        ^^^^\n",
    ];
    told(SMALL, "surface.rms_height_m=0.01", &rms);
    told(SMALL, "surface.rms_height_m=0.01", &["read with --set surface.rms_height_m=0.01"]);
    let said = with(SMALL, &["seed=3", "surface.length_m=1e-7", "name=\"other\""]).unwrap_err();
    assert!(said.contains("--> --set:1:20") && said.contains("surface.length_m = 1e-7"), "{said}");
}

#[test]
fn e2e_the_resolved_spec_holds_the_settings() {
    let bench = Bench::new(SMALL);
    let run = bench.verb("run", &["--until", "generate", "--set", "realizations=1", "--set", "surface.hurst=0.7"]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    let resolved = Spec::read(bench.out().join("campaign.toml")).unwrap();
    assert_eq!((resolved.realizations.most(), resolved.base.generated.hurst), (1, 0.7));
    // The run goes on without the options, from its own spec.
    let again = bench.look("plan", &["--json"]);
    let plan: serde_json::Value = serde_json::from_slice(&again.stdout).unwrap();
    assert_eq!(plan["stages"][0]["units"][0]["state"], "done", "{plan:#}");
    let bad = bench.verb("plan", &["--set", "surface.hurst=7"]);
    assert_eq!(code(&bad), 2);
    assert!(stderr(&bad).contains("--> --set:1:17"), "{}", stderr(&bad));
}

/// A key of a table of the top is set alone. The other keys of the table keep their values.
#[test]
fn reg_a_setting_keeps_the_other_keys_of_its_table() {
    let sweeps = "[[sweep]]\nname = \"a\"\nsurface.hurst = [0.7, 0.8]\n[[sweep]]\nname = \"b\"\nsurface.hurst = [0.6, 0.7]\n";
    let figures = "figures = { format = [\"svg\"], width_mm = 60, across = [\"a\", \"b\"] }";
    let until = "realizations = { until_relative_ci = 0.05, min = 3, max = 10 }";
    let experiment = "[experiment]\nloops = [\"l.csv\"]\nforce_unit = \"nN\"\nbaseline = \"offset\"\nprobe_radius_m = 1e-5\n";
    let text = format!("name = \"x\"\n{until}\n{figures}\n{sweeps}{experiment}");
    let settings = ["figures.loads=all", "realizations.max=5", "experiment.force_unit=uN", "experiment.compression=negative"];
    let written = text.replace("width_mm = 60", "width_mm = 60, loads = \"all\"").replace("max = 10", "max = 5");
    let written = written.replace("\"nN\"", "\"uN\"\ncompression = \"negative\"");
    assert_eq!(with(&text, &settings).unwrap(), Spec::parse(&written, "x.toml").unwrap());
    // A whole table replaces the table.
    let whole = with(&text, &["figures={ width_mm = 70 }", "realizations={ until_relative_ci = 0.1 }"]).unwrap();
    let until = whole.realizations.until().unwrap();
    assert_eq!((whole.figures.across.len(), whole.figures.width_mm, until.min, until.max), (0, 70.0, 6, 200));
    assert!(with(&text, &["experiment={ force = \"F\" }"]).unwrap_err().contains("names no file"));
}

/// Faults that follow from several values have their places in the setting too, not at the same columns of the spec.
#[test]
fn reg_faults_of_lists_in_a_setting_name_the_option() {
    let elements = "name = \"x\"\nsurface.magnification = 4\nmodel.method = \"boundary_elements\"\n";
    for (setting, message, place) in [
        ("boundary_elements.points=[8, 64]", "8 x 8 points has 2 points", "--> --set:1:29\n"),
        ("boundary_elements.points_per_wavelength=[2, 16]", "is 2: at least 4 are needed", "--> --set:1:44\n"),
        ("boundary_elements.error=[0.1]", "holds for all cases", "--> --set:1:27\n"),
        ("figures.across=[\"a\", \"b\"]", "unknown sweep \"a\"", "--> --set:1:19\n"),
        ("figures={ across = [\"a\", \"b\"] }", "unknown sweep \"b\"", "--> --set:1:28\n"),
        ("realizations.max=20000", "`realizations.max` cannot be 20000", "--> --set:1:20\n"),
    ] {
        let text = format!("{elements}realizations = {{ until_relative_ci = 0.1 }}\n");
        let said = with(&text, &["seed=1", setting]).unwrap_err();
        assert!(said.contains(message) && said.contains(place), "{setting}: {said}");
    }
}

/// Checksums of a resolved spec are those of its files: a setting that names others leaves them out.
#[test]
fn reg_a_setting_of_files_replaces_their_checksums() {
    let digest = "0".repeat(64);
    for (lines, file, setting) in [
        ("surface = { file = \"a.h5\", periodic = true }", "a.h5", "surface.file=b.h5"),
        ("[experiment]\nloops = [\"a.csv\"]", "a.csv", "experiment.loops=[\"b.csv\"]"),
        ("[experiment]\nloops = [\"a.csv\"]", "a.csv", "experiment={ loops = [\"b.csv\"] }"),
    ] {
        let text = format!("name = \"x\"\n{lines}\n[files]\n\"{file}\" = \"{digest}\"\n");
        assert_eq!(with(&text, &[]).unwrap().files.len(), 1);
        assert!(with(&text, &[setting]).unwrap_or_else(|said| panic!("{said}")).files.is_empty(), "{setting}");
    }
}
