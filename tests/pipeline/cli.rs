//! The command line: help, templates, options, and what is printed at the end.

mod ending;
mod findings;
mod places;
mod results;
mod settings;

use crate::bench::{Bench, code, stderr, stdout};
use clap::{Command, CommandFactory as _};
use hysteron::cli::Arguments;
use hysteron::spec::Spec;
use std::process::Output;

/// Two surfaces, one load: half a second of work.
pub const SMALL: &str =
    "name = \"small\"\nseed = 7\nrealizations = 2\n[surface]\nmagnification = 6\n[cycle]\nmax_load = [0.001]\napproach_step = 0.05\n";

/// Runs the program in a folder.
pub fn hysteron(bench: &Bench, arguments: &[&str]) -> Output {
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_hysteron"));
    command.current_dir(bench.folder.path()).args(arguments).output().unwrap()
}

fn each(command: &Command, visit: &mut impl FnMut(&Command)) {
    visit(command);
    command.get_subcommands().for_each(|inner| each(inner, visit));
}

#[test]
fn val_help_has_at_most_80_columns() {
    let mut program = Arguments::command();
    program.build();
    let (mut seen, mut long) = (0, Vec::new());
    each(&program, &mut |command| {
        for help in [command.clone().render_help(), command.clone().render_long_help()] {
            for line in help.to_string().lines() {
                long.extend((line.chars().count() > 80).then(|| format!("{}: {line}", command.get_name())));
                seen += 1;
            }
        }
    });
    assert!(seen > 500 && long.is_empty(), "{seen} lines: {long:#?}");
}

#[test]
fn val_help_lists_every_command_once_with_exit_codes() {
    let mut program = Arguments::command();
    program.build();
    let help = program.clone().render_help().to_string();
    for command in program.get_subcommands().filter(|command| command.get_name() != "help") {
        let about = command.get_about().unwrap().to_string();
        let named = |line: &&str| {
            let (names, text) = line.trim().split_once("  ").unwrap_or_default();
            names.split(", ").any(|name| name == command.get_name()) && text.trim() == about
        };
        assert_eq!(help.lines().filter(named).count(), 1, "{}: {help}", command.get_name());
        assert!(about.chars().count() <= 64 && !about.ends_with('.'), "{about}");
    }
    for line in ["  0    done", "  2    invalid spec or arguments", "  130  interrupted; the same command resumes"] {
        assert!(help.contains(line), "{help}");
    }
    assert!(help.contains("gc, clean "), "{help}");
}

#[test]
fn e2e_every_template_is_a_spec() {
    let bench = Bench::new("");
    let list = stdout(&hysteron(&bench, &["init", "--list"]));
    let names: Vec<&str> = list.lines().map(|line| line.split_whitespace().next().unwrap()).collect();
    assert_eq!(names, ["quickstart", "sweep", "scan", "spectrum", "probe", "loop", "full"]);
    for name in names {
        let printed = hysteron(&bench, &["init", name]);
        assert_eq!(code(&printed), 0, "{}", stderr(&printed));
        let text = stdout(&printed);
        let spec = Spec::parse(&text, name).unwrap_or_else(|errors| panic!("{errors}"));
        assert_eq!(spec.name, name);
        for line in text.lines() {
            assert!(line.chars().count() <= 100, "{line}");
            // Keys of a sweep were explained above it.
            let is_swept = ["surface.", "material.", "model."].iter().any(|start| line.starts_with(start));
            let is_key = line.contains(" = ") && !line.starts_with('#') && !is_swept;
            assert!(!is_key || line.contains("# ") || line.starts_with("name = "), "{line}");
        }
    }
    assert_eq!(stdout(&hysteron(&bench, &["init"])), stdout(&hysteron(&bench, &["init", "quickstart"])));
    assert_eq!(code(&hysteron(&bench, &["init", "quick"])), 2);
}

#[test]
fn law_the_two_quickstarts_have_the_same_cases() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("pipelines/quickstart.toml");
    let pipeline = Spec::read(path).unwrap();
    let template = Spec::parse(&stdout(&hysteron(&Bench::new(""), &["init", "quickstart"])), "quickstart").unwrap();
    assert_eq!((&template.cases, template.seed, &template.realizations), (&pipeline.cases, pipeline.seed, &pipeline.realizations));
}

#[test]
fn val_the_full_template_has_every_key_with_its_default() {
    let bench = Bench::new("");
    let text = stdout(&hysteron(&bench, &["init", "full"]));
    let (full, minimal) = (Spec::parse(&text, "full").unwrap(), Spec::parse("name = \"full\"", "minimal").unwrap());
    assert_eq!((&full.base, full.seed, &full.cases), (&minimal.base, minimal.seed, &minimal.cases));
    // Commented keys too: a line of its own for each.
    let plain = serde_json::to_value(&full.base).unwrap();
    for (table, keys) in plain.as_object().unwrap() {
        for key in keys.as_object().unwrap().keys() {
            let named = |line: &&str| line.trim_start_matches("# ").starts_with(&format!("{key} = "));
            let tables = plain.as_object().unwrap().values().filter(|keys| keys.get(key).is_some()).count();
            assert_eq!(text.lines().filter(named).count(), tables, "{table}.{key}");
        }
    }
}

#[test]
fn e2e_a_dry_run_is_a_plan() {
    let bench = Bench::new(SMALL);
    let (dry, plan) = (bench.verb("run", &["-n"]), bench.verb("plan", &[]));
    assert_eq!((code(&dry), stdout(&dry)), (0, stdout(&plan)));
    assert_eq!(stdout(&bench.verb("run", &["--dry-run", "--json"])), stdout(&bench.verb("plan", &["--json"])));
    assert!(!bench.out().exists());
}

#[test]
fn e2e_a_plan_has_the_reasons_of_pending_tasks() {
    let bench = Bench::new(SMALL);
    assert_eq!(code(&bench.verb("run", &["--until", "cycle"])), 0);
    let finished = stdout(&bench.verb("plan", &[]));
    assert!(!finished.contains('→'), "{finished}");
    let plan = stdout(&bench.verb("plan", &["--set", "cycle.approach_step=0.1"]));
    assert!(plan.contains("cycle     2 planned\n  2 to run: approach_step 0.05 → 0.1\n"), "{plan}");
    assert!(plan.contains("generate  2 done\n") && plan.contains("`run` would compute 4 tasks."), "{plan}");
    let plan = stdout(&bench.verb("plan", &["--set", "realizations=3"]));
    assert!(plan.contains("  1 to run: new value realization = 2\n") && !plan.contains('→'), "nothing was changed but added: {plan}");
    let answer: serde_json::Value = serde_json::from_slice(&bench.verb("plan", &["--set", "realizations=3", "--json"]).stdout).unwrap();
    let pending: Vec<&serde_json::Value> =
        answer["stages"][2]["units"].as_array().unwrap().iter().filter(|unit| unit["state"] == "planned").collect();
    assert!(pending.len() == 1 && pending[0]["why"] == "not computed yet", "{pending:?}");
    let more = bench.folder.path().join("more.toml");
    std::fs::write(&more, SMALL.replace("realizations = 2", "realizations = 3")).unwrap();
    let explained = stdout(&bench.look("explain", &[pending[0]["id"].as_str().unwrap(), "--spec", more.to_str().unwrap()]));
    assert!(explained.contains(" is planned\n  not computed yet; ") && !explained.contains("requested"), "{explained}");
    // A finished run with two more cases of one new value, and one case less.
    assert_eq!(code(&bench.verb("run", &[])), 0);
    let sweep = SMALL.to_owned() + "[[sweep]]\nname = \"g\"\nmaterial.work_of_adhesion_j_m2 = [0.07, 0.03, 0.05]\n";
    std::fs::write(bench.spec(), &sweep).unwrap();
    let plan = stdout(&bench.verb("plan", &[]));
    assert!(plan.contains("cycle     2 done, 4 planned\n  4 to run: new values work_of_adhesion_j_m2 = 0.03, 0.05\n"), "{plan}");
    assert!(plan.contains("  statistics is stale: 2 cases were added, 1 case was relabelled\n"), "{plan}");
    assert!(plan.contains("  report is stale: the tables over realizations are stale, the spec was edited\n"), "{plan}");
    assert_eq!(code(&bench.verb("run", &[])), 0);
    // One new value in two sweeps.
    let wider = sweep
        + "[[sweep]]\nname = \"m\"\nsurface.magnification = [6, 8]\n[[sweep]]\nname = \"both\"\nsurface.magnification = 8\n\
                         material.work_of_adhesion_j_m2 = 0.03\n";
    std::fs::write(bench.spec(), wider).unwrap();
    let plan = stdout(&bench.verb("plan", &[]));
    assert!(plan.contains("  4 to run: new value magnification = 8\n"), "{plan}");
    std::fs::write(bench.spec(), SMALL).unwrap();
    let plan = stdout(&bench.verb("plan", &[]));
    assert!(plan.contains("  statistics is stale: 2 cases were removed, 1 case was relabelled\n"), "{plan}");
}
