//! Progress, the end of a run, colours, and opening the report.

use super::SMALL;
use crate::bench::{Bench, code, paths, skip, stderr, stdout};
use std::fs;
use std::process::Command;

/// At a range of 1 µm the Tabor numbers are below 2, where Wu's rule does not hold.
fn failing(realizations: usize) -> Bench {
    let spec = SMALL.replace("realizations = 2", &format!("realizations = {realizations}"));
    Bench::new(&(spec + "[material]\ninteraction_range_m = 1e-6\n"))
}

#[test]
fn e2e_a_run_ends_with_its_failures_time_and_size() {
    let bench = failing(12);
    let run = bench.verb("run", &[]);
    assert_eq!(code(&run), 3, "{}", stderr(&run));
    let said = stdout(&run);
    let listed = said.lines().filter(|line| line.starts_with("  H0.80_z6_r") && line.contains(": ")).count();
    assert_eq!(listed, 10, "{said}");
    assert!(said.contains("12 cycles failed. ") && said.contains("  … and 2 more\n") && said.contains("Tabor"), "{said}");
    let answer: serde_json::Value = serde_json::from_slice(&bench.verb("run", &["--json"]).stdout).unwrap();
    assert_eq!(answer["failures"].as_array().unwrap().len(), 12);
    assert!(answer["failures"][0]["why"].as_str().unwrap().contains("Tabor") && answer["elapsed_s"].as_f64().unwrap() > 0.0);
    let bytes: u64 = paths(&bench.out()).iter().map(|path| fs::metadata(path).unwrap().len()).sum();
    assert_eq!(answer["size_bytes"].as_u64().unwrap(), bytes);

    // A shard lists its own failures.
    let shard = stdout(&bench.verb("cycle", &["--shard", "0/4"]));
    let listed = shard.lines().filter(|line| line.starts_with("  H0.80_z6_r") && line.contains(": ")).count();
    assert!(listed == 3 && shard.contains("3 cycles failed. "), "{shard}");
    // Failed cycles are not submitted again.
    let submitted = bench.verb("submit", &["--engine", "slurm", "--dry-run"]);
    assert_eq!(code(&submitted), 3, "{}", stderr(&submitted));
    assert!(stdout(&submitted).starts_with("Nothing to submit: all other tasks are done.\n12 cycles failed. "), "{}", stdout(&submitted));

    let whole = Bench::new(SMALL);
    let said = stdout(&whole.verb("run", &["--until", "cycle"]));
    assert!(said.contains("\n6 tasks in ") && said.contains(" s. Size of the output folder: ") && !said.contains("failed"), "{said}");
    let again = stdout(&whole.verb("run", &["--until", "cycle"]));
    assert!(again.starts_with("Nothing to do: 6 tasks done before. "), "{again}");
}

#[test]
fn e2e_progress_inside_a_cycle_without_a_terminal() {
    let bench = Bench::new(SMALL);
    let lines = |seconds: &str| {
        let _ = fs::remove_dir_all(bench.out());
        let run =
            bench.command("run").args(["--until", "cycle", "--jobs", "1"]).env("HYSTERON_PROGRESS_SECONDS", seconds).output().unwrap();
        assert_eq!(code(&run), 0, "{}", stderr(&run));
        stderr(&run)
    };
    let inside =
        |said: &str| said.lines().filter(|line| line.starts_with("cycle: ") && line.contains(" % of the pending tasks after ")).count();
    let said = lines("0");
    assert!(inside(&said) > 4, "{said}");
    // The share grows, to all of it.
    let shares: Vec<u32> = said
        .lines()
        .filter(|line| line.starts_with("cycle: ") && line.contains(" % "))
        .map(|line| line.split(' ').nth(2).unwrap().parse().unwrap())
        .collect();
    assert!(shares.is_sorted() && shares.last() == Some(&100), "{shares:?}");
    // By default every 30 s, which this run does not take.
    assert_eq!(inside(&lines("")), 0);
}

#[test]
fn e2e_quiet_and_verbose() {
    let bench = Bench::new(SMALL);
    let quiet = bench.verb("run", &["-q", "--until", "extract"]);
    assert_eq!((code(&quiet), stdout(&quiet).as_str(), stderr(&quiet).as_str()), (0, "", ""));
    let verbose = bench.verb("run", &["-v", "--until", "cycle"]);
    let said = stderr(&verbose);
    // The page of progress is named once, before the first stage with pending tasks.
    let page = format!("\nprogress page: {}\ncycle: 2 tasks, 0 done before", bench.out().join("progress.html").display());
    assert!(said.contains(&page) && said.matches("progress page").count() == 1, "{said}");
    // A run with nothing to do has none.
    assert!(!stderr(&bench.verb("run", &["--until", "cycle"])).contains("progress page"));
    assert!(said.lines().any(|line| line.starts_with("cycle: 2/2 H0.80_z6_r") && line.ends_with(" s)")), "{said}");
    assert_eq!(code(&bench.verb("run", &["-q", "-v"])), 2);
    // Failures are told all the same.
    let failed = failing(1).verb("run", &["-q"]);
    assert_eq!((code(&failed), stdout(&failed).as_str()), (3, ""));
    assert!(stderr(&failed).contains(" failed: "), "{}", stderr(&failed));
    // And warnings.
    assert!(stderr(&failed).contains("warning[failed]: "), "{}", stderr(&failed));
}

#[test]
#[cfg(target_os = "linux")]
fn e2e_open_starts_the_viewer_and_warns_if_it_fails() {
    use std::os::unix::fs::PermissionsExt as _;
    let bench = Bench::new(SMALL);
    let folder = bench.folder.path();
    let path = format!("{}:{}", folder.display(), std::env::var("PATH").unwrap());
    let viewer = |script: &str| {
        fs::write(folder.join("xdg-open"), format!("#!/bin/sh\n{script}\n")).unwrap();
        fs::set_permissions(folder.join("xdg-open"), fs::Permissions::from_mode(0o755)).unwrap();
        bench.command("run").arg("--open").env("PATH", &path).output().unwrap()
    };
    let opened = viewer(&format!("echo \"$1\" > '{}'", folder.join("opened").display()));
    assert_eq!(code(&opened), 0, "{}", stderr(&opened));
    assert_eq!(fs::read_to_string(folder.join("opened")).unwrap().trim(), bench.out().join("report.html").to_str().unwrap());
    assert!(!stderr(&opened).contains("warning: cannot open"), "{}", stderr(&opened));
    let failed = viewer("exit 3");
    assert_eq!(code(&failed), 0);
    assert!(stderr(&failed).contains("warning: cannot open ") && stderr(&failed).contains("exit status: 3"), "{}", stderr(&failed));
    let early = bench.verb("run", &["--open", "--until", "cycle"]);
    assert_eq!(code(&early), 2);
    assert!(stderr(&early).starts_with("error: --open needs the report"), "{}", stderr(&early));
}

#[test]
fn e2e_colours_are_for_terminals_without_no_color() {
    let bench = Bench::new("nme = \"x\"\n");
    let line = format!("'{}' plan '{}'", env!("CARGO_BIN_EXE_hysteron"), bench.spec().display());
    let on_terminal = |no_color: &str| {
        let mut command = Command::new("script");
        command.args(["-qec", &line, "/dev/null"]).env("NO_COLOR", no_color).env("TERM", "xterm").output()
    };
    assert!(!stderr(&bench.verb("plan", &[])).contains('\u{1b}'), "a pipe");
    let Ok(coloured) = on_terminal("") else {
        return skip("script", "there is no `script`");
    };
    assert!(stdout(&coloured).contains("\u{1b}[1;31merror:\u{1b}[0m the spec"), "{:?}", stdout(&coloured));
    let plain = stdout(&on_terminal("1").unwrap());
    assert!(plain.contains("error: ") && !plain.contains('\u{1b}'), "{plain:?}");
}

#[test]
fn e2e_a_stage_without_its_input_names_what_is_lacking() {
    let bench = Bench::new(SMALL);
    let nothing = bench.verb("aggregate", &[]);
    assert_eq!(code(&nothing), 1);
    assert!(stderr(&nothing).starts_with("error: cannot run the stage aggregate: "), "{}", stderr(&nothing));
    assert!(stderr(&nothing).contains("out has no campaign.toml\nhelp: ") && !bench.out().exists(), "{}", stderr(&nothing));
    assert_eq!(code(&bench.verb("run", &["--until", "cycle"])), 0);
    let cycle = fs::read_dir(bench.out().join("cycles")).unwrap().next().unwrap().unwrap().path();
    fs::remove_file(cycle.join("steps.parquet")).unwrap();
    let damaged = stderr(&bench.verb("aggregate", &["--set", "realizations=3"]));
    let wanted =
        format!("in {}: of 3 tasks of the previous stage, 1 not computed and 1 stale or damaged; for example ", bench.out().display());
    assert!(damaged.contains(&wanted) && damaged.contains(" or aggregate the finished ones with --partial"), "{damaged}");
}
