//! State of a run in progress: heartbeats, `status` and the page of progress.

use crate::bench::{Bench, code, stderr, stdout};
use hysteron::report::{LiveRun, LiveStage, live_page};
use hysteron::store::heartbeat::{Heartbeat, Pulse, RunningTask, processes};
use serde_json::Value;
use std::fs;
use std::process::{Child, Stdio};

/// Boundary elements on 64² points with short steps: some seconds.
const LONG: &str = "name = \"long\"\nseed = 7\nrealizations = 2\n[surface]\nmagnification = 4\n[model]\nmethod = \"boundary_elements\"\n\
                    [boundary_elements]\napproach_step = 0.015\n[cycle]\nmax_load = [0.004]\n";

fn started(bench: &Bench) -> Child {
    bench.command("run").args(["--jobs", "1"]).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
}

/// The state of a task in the answer of `status --json`.
fn state(answer: &Value, stage: usize, unit: usize) -> &str {
    answer["stages"][stage]["units"][unit]["state"].as_str().unwrap()
}

/// `status` until a cycle is running, with a position.
fn seen_running(bench: &Bench, child: &mut Child) -> (Value, String) {
    loop {
        assert!(child.try_wait().unwrap().is_none(), "the run ended before it was seen");
        let json = bench.look("status", &["--json"]);
        let text = stdout(&bench.look("status", &[]));
        let answer: Value = serde_json::from_slice(&json.stdout).unwrap_or_default();
        let has_position = answer["processes"][0]["tasks"][0]["step_count"].as_u64().is_some_and(|steps| steps > 0);
        if has_position && text.contains(" steps, F/(E*A₀) = ") {
            return (answer, text);
        }
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
}

#[test]
fn e2e_status_of_a_living_and_of_a_killed_run() {
    let bench = Bench::new(LONG);
    let mut child = started(&bench);
    let (answer, text) = seen_running(&bench, &mut child);
    assert_eq!([state(&answer, 2, 0), state(&answer, 2, 1), state(&answer, 3, 0)], ["running", "waiting", "waiting"], "{answer:#}");
    let task = &answer["processes"][0]["tasks"][0];
    // On a busy machine the branch may end before it is seen.
    let branches = ["loading", "unloading"];
    assert!(branches.iter().any(|branch| task["branch"] == *branch) && task["max_load"] == 0.004 && task["load"].is_number(), "{task:#}");
    assert!(text.contains("cycle     1 running, 1 waiting\n"), "{text}");
    assert!(branches.iter().any(|branch| text.contains(&format!(" running: {branch}, "))), "{text}");
    assert!(text.contains("running   cycle: 0 of 2 tasks done, ") && text.contains("tasks pending: 1 running, 3 waiting.\n"), "{text}");
    assert!(!text.contains("planned") && !text.contains("interrupted") && !text.contains("resume"), "{text}");
    assert!(text.lines().skip(1).all(|line| line.chars().count() <= 80), "{text}");

    child.kill().unwrap();
    child.wait().unwrap();
    let killed = stdout(&bench.look("status", &[]));
    assert!(!killed.contains("running") && killed.contains("resume with `hysteron run "), "{killed}");
    assert!(killed.contains("cycle     1 planned, 1 interrupted\n") && killed.contains("\nkilled    process "), "{killed}");
    // The page of a killed run states the time of its state, and how to tell that it has ended.
    let page = fs::read_to_string(bench.out().join("progress.html")).unwrap();
    assert!(!page.contains(": in progress") && page.contains("<time id=\"updated\" datetime=\"20"), "{page}");
    assert!(page.contains("Without an update for 30 s, the process has ended: <code>hysteron status "), "{page}");
    // The next run removes what the killed one left.
    let run = bench.verb("run", &[]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    assert!(!bench.out().join("running").exists() && !bench.out().join("progress.html").exists());
    let finished = stdout(&bench.look("status", &[]));
    assert!(finished.contains("Nothing is left to do."), "{finished}");
}

#[test]
fn law_a_heartbeat_lives_as_long_as_its_process() {
    let folder = tempfile::tempdir().unwrap();
    let own = gethostname::gethostname().to_string_lossy().into_owned();
    let state = |host: &str, tasks: usize| Heartbeat {
        host: host.to_owned(),
        process_id: 1,
        tasks: vec![RunningTask { id: "x".to_owned(), ..RunningTask::default() }; tasks],
        ..Heartbeat::default()
    };
    let living = || processes(folder.path())[0].clone();
    assert!(living().is_empty());
    let mut pulse = Pulse::begin(folder.path(), |_| {}).unwrap();
    // A longer and a shorter state in one place.
    for tasks in [1, 20, 2] {
        pulse.beat(&state(&own, tasks));
        assert_eq!(living(), [state(&own, tasks)]);
    }
    // Files without a lock: of this machine, of another one, an old one of another one, and something else.
    let write = |name: &str, host: &str| {
        let path = folder.path().join("running").join(name);
        fs::write(&path, serde_json::to_string(&state(host, 0)).unwrap()).unwrap();
        path
    };
    write("hysteron-2-a.json", &own);
    write("hysteron-3-b.json", "another");
    let old = write("hysteron-4-c.json", "another");
    let hour_ago = std::time::SystemTime::now() - std::time::Duration::from_secs(3600);
    fs::File::options().write(true).open(old).unwrap().set_modified(hour_ago).unwrap();
    fs::write(folder.path().join("running/notes.json"), "{}").unwrap();
    fs::write(folder.path().join("running/hysteron-5-d.json"), "torn").unwrap();
    let hosts: Vec<String> = living().into_iter().map(|beat| beat.host).collect();
    assert_eq!((hosts.len(), hosts.contains(&"another".to_owned())), (2, true), "{hosts:?}");
    assert_eq!(processes(folder.path())[1].len(), 2, "one of this machine, and the old one");
    // A new process removes those of ended processes, and a torn one that no process holds.
    drop(pulse);
    drop(Pulse::begin(folder.path(), |_| {}).unwrap());
    let mut left: Vec<String> =
        fs::read_dir(folder.path().join("running")).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    left.sort();
    assert_eq!(left, ["hysteron-3-b.json", "notes.json"]);
}

#[test]
fn val_the_page_of_progress_shows_what_is_running() {
    let task = RunningTask {
        id: "H0.80_z8_r00-1a2b3c4d".to_owned(),
        elapsed_s: 90.0,
        fraction: 0.25,
        left_s: Some(270.0),
        step_count: Some(12),
        branch: Some("unloading".to_owned()),
        load: Some(-0.000_12),
        max_load: Some(0.004),
    };
    let run = LiveRun {
        name: "mine".to_owned(),
        dir: "'my run'".to_owned(),
        updated: "2026-01-31T12:00:00Z".to_owned(),
        elapsed_s: 3700.0,
        left_s: Some(7325.0),
        stages: vec![LiveStage { name: "cycle", done: 1, all: 4, work: 1.25 }],
        running: vec![(task, "ζ = 8".to_owned())],
        ..LiveRun::default()
    };
    let page = live_page(&run);
    for words in [
        "mine: <span id=\"state\">state at 2026-01-31 12:00:00 UTC</span>",
        "datetime=\"2026-01-31T12:00:00Z\">2026-01-31 12:00:00 UTC</time>, 1h 2m after the start, about 2h 2m before the end of the stage.",
        "<td>cycle</td><td>1 of 4 tasks</td><td>31\u{a0}%</td>",
        "H0.80_z8_r00-1a2b3c4d<small>ζ = 8</small>",
        "<td>unloading</td><td>12</td><td>−0.00012 (0.004)</td><td>25\u{a0}%</td><td>1m 30s</td><td>4m 30s</td>",
        "<code>hysteron run 'my run'</code>",
        "const SILENT_MS = 30e3;",
    ] {
        assert!(page.contains(words), "{words}: {page}");
    }
}
