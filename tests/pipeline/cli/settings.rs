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
