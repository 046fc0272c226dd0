//! What other programs run a campaign with.

use super::SMALL;
use crate::bench::{Bench, SPEC, code, files, skip, stderr, stdout};
use hysteron::campaign::{Campaign, Stage};
use hysteron::engines::ro_crate::licence;
use hysteron::engines::slurm::{LEAD_S, Order, Queue, Sent, jobs, lead_s, script, time_limit_s};
use hysteron::spec::Spec;
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::{Duration, Instant};

fn order(waiting: Vec<(Stage, Vec<usize>)>, most: usize) -> Order {
    Order {
        program: PathBuf::from("/opt/it's/hysteron"),
        shards: 12,
        waiting,
        most,
        cpus: 3,
        options: vec!["--time=1:00:00".to_owned()],
        queued: Vec::new(),
    }
}

#[test]
fn law_tasks_correspond_and_nothing_waits_for_what_is_not_sent() {
    let all: Vec<usize> = (0..12).collect();
    let tried = [
        vec![(Stage::Generate, all.clone()), (Stage::Extract, all.clone()), (Stage::Cycle, all)],
        vec![(Stage::Generate, vec![1]), (Stage::Extract, vec![1, 4]), (Stage::Cycle, vec![1, 4, 11])],
        vec![(Stage::Cycle, vec![0, 5, 6])],
        vec![(Stage::Generate, vec![7])],
        Vec::new(),
    ];
    for waiting in tried {
        for most in [3, 5, 1000] {
            let jobs = jobs(&order(waiting.clone(), most));
            let mut sent: BTreeSet<(Stage, usize)> = BTreeSet::new();
            for (place, job) in jobs.iter().enumerate() {
                assert!(job.tasks.iter().all(|task| *task < most), "{job:?}");
                for &before in &job.after {
                    assert!(before < place, "it waits for what has been sent");
                    if job.stage <= Stage::Cycle {
                        assert_eq!((&jobs[before].tasks, jobs[before].first), (&job.tasks, job.first));
                        assert!(jobs[before].stage < job.stage);
                    }
                }
                for task in &job.tasks {
                    assert!(sent.insert((job.stage, job.first + task)), "no shard is sent twice");
                }
            }
            for (stage, shards) in &waiting {
                assert!(shards.iter().all(|shard| sent.contains(&(*stage, *shard))), "{stage:?}");
            }
            let last = jobs.last().unwrap();
            assert_eq!((last.stage, last.tasks.len()), (Stage::Aggregate, 0));
            let waits: BTreeSet<usize> = last.after.iter().copied().collect();
            let ends: BTreeSet<usize> =
                (0..jobs.len() - 1).filter(|k| !jobs.iter().any(|job| job.stage <= Stage::Cycle && job.after.contains(k))).collect();
            assert_eq!(waits, ends, "the tables wait for the last job of every chain");
        }
    }
}

#[test]
fn val_the_arguments_of_sbatch() {
    let order = order(vec![(Stage::Extract, vec![1, 2, 3, 9]), (Stage::Cycle, vec![9])], 1000);
    let jobs = jobs(&order);
    let numbers = ["71", "72"].map(str::to_owned);
    let said: Vec<String> = jobs.iter().map(|job| job.arguments(Path::new("/run/slurm"), &numbers, &[]).join(" ")).collect();
    assert_eq!(
        said,
        [
            "--parsable --array=1-3,9 --export=ALL,HYSTERON_FIRST=0 /run/slurm/extract.sbatch",
            "--parsable --array=1-3,9 --export=ALL,HYSTERON_FIRST=0 --dependency=aftercorr:71 --kill-on-invalid-dep=yes /run/slurm/cycle.sbatch",
            "--parsable --dependency=afterany:72 --kill-on-invalid-dep=yes /run/slurm/aggregate.sbatch",
        ]
    );
    // What is in the queue already is waited for, by the first of a chain and by the tables.
    let later: Vec<String> = jobs.iter().map(|job| job.arguments(Path::new("/run"), &numbers, &[60, 61]).join(" ")).collect();
    assert!(later[0].contains("--dependency=afterany:60:61 ") && later[1].contains("--dependency=aftercorr:71 "), "{later:?}");
    assert!(later[2].contains("--dependency=afterany:60:61:72 "), "{later:?}");
    let campaign = Campaign::new(Spec::parse(SMALL, "x.toml").unwrap(), PathBuf::from("/data/run"));
    let text = script(&campaign, Stage::Cycle, &order);
    assert!(text.contains("#SBATCH --time=1:00:00\n") && text.contains("#SBATCH --cpus-per-task=3\n"), "{text}");
    assert!(text.contains("'/opt/it'\\''s/hysteron' cycle /data/run/campaign.toml --out /data/run"), "{text}");
    let checked = Command::new("sh").args(["-n", "-c", &text]).output().unwrap();
    assert!(checked.status.success(), "{}", stderr(&checked));
}

#[test]
fn val_the_queue_by_hand() {
    let sent = |job: u64, stage: &str, first: usize| Sent {
        job,
        stage: stage.to_owned(),
        first,
        shards: 9,
        tasks: Vec::new(),
        options: Vec::new(),
    };
    let known = [sent(5, "cycle", 0), sent(6, "cycle", 4), sent(7, "aggregate", 0)];
    let queue =
        Queue::parse("5 1 RUNNING 2\n5 2 COMPLETED 0\n6 0 PENDING 1\n6 1 CANCELLED 0\n7 N/A PENDING\n8 1 RUNNING 9\nnonsense\n", &known);
    let shards: Vec<usize> = queue.shards.iter().map(|(_, _, shard)| *shard).collect();
    assert_eq!((shards, queue.aggregates), (vec![1, 4], true));
    assert_eq!(queue.states.iter().map(|(state, count)| format!("{count} {state}")).collect::<Vec<_>>(), ["2 pending", "1 running"]);
    let ended: Vec<String> = queue.ended.iter().map(|((job, task), state)| format!("{job} {task:?} {state}")).collect();
    assert_eq!((queue.restarts, ended), (3, vec!["5 Some(2) COMPLETED".to_owned(), "6 Some(1) CANCELLED".to_owned()]));
    assert_eq!((known[1].log(Some(3)), known[2].log(None)), ("cycle-6_3.log".to_owned(), "aggregate-7.log".to_owned()));
}

#[test]
fn e2e_a_dry_run_shows_and_does_nothing() {
    let bench = Bench::new(SMALL);
    let shown = bench.verb("submit", &["--engine", "slurm", "--dry-run", "--option=--partition=long"]);
    assert_eq!(code(&shown), 0, "{}", stderr(&shown));
    assert!(
        stdout(&shown).contains("#SBATCH --partition=long") && stdout(&shown).contains("sbatch --parsable --array=0-1"),
        "{}",
        stdout(&shown)
    );
    assert!(!bench.out().exists());
    let without = bench.command("submit").args(["--engine", "slurm"]).env("PATH", "/nowhere").output().unwrap();
    assert_eq!(code(&without), 1);
    assert!(stderr(&without).contains("--dry-run"), "{}", stderr(&without));
}

#[test]
fn e2e_an_option_of_several_lines_is_refused() {
    let bench = Bench::new(SMALL);
    for option in ["--time=1\ntouch pwned", "--time=1\rtouch pwned", "--comment=\u{1b}[2J"] {
        let refused = bench.verb("submit", &["--engine", "slurm", "--dry-run", &format!("--option={option}")]);
        assert_eq!(code(&refused), 2, "{option:?}: {}", stdout(&refused));
        assert!(stderr(&refused).contains("has a control character\nhelp: ") && stdout(&refused).is_empty(), "{}", stderr(&refused));
    }
}

#[test]
fn val_time_limits_as_slurm_reads_them() {
    for (option, seconds) in [
        ("--time=2", 120),
        ("--time=0:10:00", 600),
        ("--time=2:30", 150),
        ("--time=1-2", 93_600),
        ("--time=1-0:30", 88_200),
        ("--time=1-0:0:5", 86_405),
        ("-t 4:00:00", 14_400),
        ("-t30", 1800),
    ] {
        assert_eq!(time_limit_s(&["--mem=4G".to_owned(), option.to_owned()]), Some(seconds), "{option}");
    }
    for option in ["--mem=4G", "--time=UNLIMITED", "--time=1:2:3:4", "--time-min=5", "--time="] {
        assert_eq!(time_limit_s(&[option.to_owned()]), None, "{option}");
    }
    assert_eq!([None, Some(36_000), Some(120), Some(1)].map(lead_s), [LEAD_S, LEAD_S, 30, 1]);
    let campaign = Campaign::new(Spec::parse(SMALL, "x.toml").unwrap(), PathBuf::from("/data/run"));
    let order = Order { options: vec!["--time=2".to_owned()], ..order(vec![(Stage::Cycle, vec![0])], 1000) };
    assert!(script(&campaign, Stage::Cycle, &order).contains("#SBATCH --signal=B:USR1@30\n"));
    assert_eq!(order.arguments(), ["--shards=12", "--cpus=3", "--option=--time=2"]);
    let last = script(&campaign, Stage::Aggregate, &order);
    assert!(last.contains(" aggregate /data/run/campaign.toml --out /data/run --jobs 1 --quiet\n"), "{last}");
    assert!(last.contains(" report /data/run/campaign.toml --out /data/run --jobs 1\n") && last.contains("USR1\n"), "{last}");
}

/// Commands in place of those of the system, each a shell script; the path with them.
#[cfg(unix)]
fn commands(bench: &Bench, scripts: &[(&str, &str)]) -> String {
    use std::os::unix::fs::PermissionsExt as _;
    let folder = bench.folder.path().join("bin");
    std::fs::create_dir_all(&folder).unwrap();
    for (name, script) in scripts {
        std::fs::write(folder.join(name), format!("#!/bin/sh\n{script}\n")).unwrap();
        std::fs::set_permissions(folder.join(name), std::fs::Permissions::from_mode(0o755)).unwrap();
    }
    format!("{}:{}", folder.display(), std::env::var("PATH").unwrap_or_default())
}

/// A task that is signalled before its time limit returns to the queue only if something was written since its start.
#[cfg(unix)]
#[test]
fn e2e_a_job_without_progress_is_not_requeued() {
    // The last one is signalled by the program itself, about when the shell learns its number.
    for (progress, at_once) in [(true, false), (false, false), (false, true)] {
        let bench = Bench::new(SMALL);
        let campaign = Campaign::new(Spec::parse(SMALL, "x.toml").unwrap(), bench.out());
        std::fs::create_dir_all(bench.out().join("slurm/log")).unwrap();
        std::fs::create_dir_all(bench.out().join("receipts/cycle")).unwrap();
        std::fs::create_dir_all(bench.out().join("cycles")).unwrap();
        let at = |name: &str| bench.folder.path().join(name);
        let write =
            if progress { format!("sleep 0.05; : >'{}'", bench.out().join("receipts/cycle/x.json").display()) } else { String::new() };
        let signal = if at_once { "kill -USR1 $PPID" } else { "" };
        // Ends with the signal as the program does; without one after a minute, so that a signal that is lost fails the test.
        let wait = "n=0; while [ $n -lt 1200 ]; do sleep 0.05; n=$((n + 1)); done; exit 77";
        let program = format!("{signal}\n{write}\ntrap 'exit 130' TERM\n: >'{}'\n{wait}", at("started").display());
        let path = commands(&bench, &[("program", &program), ("scontrol", &format!("echo \"$@\" >>'{}'", at("requeued").display()))]);
        let order = Order { program: at("bin/program"), ..order(vec![(Stage::Cycle, vec![0])], 1000) };
        std::fs::write(at("job"), script(&campaign, Stage::Cycle, &order)).unwrap();
        let mut command = Command::new("bash");
        command.arg(at("job")).env("PATH", path).env("SLURM_ARRAY_JOB_ID", "5").env("SLURM_ARRAY_TASK_ID", "2").env("HYSTERON_FIRST", "0");
        let child = command.stdout(std::process::Stdio::piped()).stderr(std::process::Stdio::piped()).spawn().unwrap();
        if !at_once {
            let began = Instant::now();
            while !at("started").exists() {
                assert!(began.elapsed() < Duration::from_secs(60), "it was never started");
                std::thread::sleep(Duration::from_millis(20));
            }
            assert!(Command::new("kill").args(["-USR1", &child.id().to_string()]).status().unwrap().success());
        }
        let ended = child.wait_with_output().unwrap();
        assert_eq!(at("requeued").exists(), progress, "{}", stderr(&ended));
        if progress {
            assert_eq!(std::fs::read_to_string(at("requeued")).unwrap(), "requeue 5_2\n");
        } else {
            assert_eq!(code(&ended), 1);
            assert!(stderr(&ended).contains("no task was finished within the time limit"), "{}", stderr(&ended));
        }
        assert_eq!(std::fs::read_dir(bench.out().join("slurm/log")).unwrap().count(), 0, "no mark is left");
    }
}

#[cfg(unix)]
#[test]
fn e2e_status_names_ended_jobs_and_the_command_that_submits_again() {
    let bench = Bench::new(SMALL);
    assert_eq!(code(&bench.verb("run", &["--until", "extract"])), 0);
    std::fs::create_dir(bench.out().join("slurm")).unwrap();
    let sent = r#"[{"job":31,"stage":"cycle","first":0,"shards":2,"tasks":[0,1],"options":["--shards=2","--option=--time=2"]},
        {"job":32,"stage":"aggregate","first":0,"shards":2}]"#;
    std::fs::write(bench.out().join("slurm/jobs.json"), sent).unwrap();
    let look = |answer: &str, more: &[&str]| {
        let path = commands(&bench, &[("squeue", &format!("printf '{answer}'"))]);
        let mut command = Command::new("timeout");
        command.args(["60", env!("CARGO_BIN_EXE_hysteron"), "status"]).arg(bench.out()).args(more).env("PATH", path).output().unwrap()
    };
    let running = stdout(&look("31 0 RUNNING 2\\n31 1 CANCELLED 0\\n32 N/A PENDING 0\\n", &[]));
    let log = bench.out().join("slurm/log/cycle-31_1.log");
    assert!(running.contains(&format!("  cycle job 31_1 CANCELLED, log {}\n", log.display())), "{running}");
    assert!(running.contains("slurm     1 pending, 1 running, 2 restarts\n"), "{running}");
    assert!(
        running.contains("4 tasks pending; jobs of the run are in the Slurm queue.\n") && !running.contains("hysteron run"),
        "{running}"
    );
    let ended = stdout(&look("31 1 CANCELLED 0\\n", &[]));
    assert!(ended.contains("slurm     nothing in the queue\n") && ended.contains("  cycle job 31_0 has ended, log "), "{ended}");
    assert!(ended.contains("  aggregate job 32 has ended, log ") && ended.contains("aggregate-32.log\n"), "{ended}");
    let again = format!("pending; submit with\n  hysteron submit {} --engine slurm --shards=2 --option=--time=2\n", bench.out().display());
    assert!(ended.contains(&again) && !ended.contains("hysteron run"), "{ended}");
    let answer: Value = serde_json::from_str(&stdout(&look("31 1 CANCELLED 0\\n", &["--json"]))).unwrap();
    assert_eq!((&answer["slurm"]["ended"][1]["job"], &answer["slurm"]["ended"][1]["state"]), (&"31_1".into(), &"CANCELLED".into()));
    // Nobody computes, so that nothing is watched for.
    let watched = look("", &["--watch"]);
    assert_eq!(code(&watched), 1, "{}", stdout(&watched));
    assert!(stderr(&watched).starts_with("error: tasks are pending, but no job of the run is in the Slurm queue"), "{}", stderr(&watched));
    // The same jobs are the reason why a stage lacks its input.
    let path = commands(&bench, &[("squeue", "printf '31 0 RUNNING 0\\n'")]);
    let early = bench.command("aggregate").env("PATH", &path).output().unwrap();
    assert_eq!(code(&early), 1);
    assert!(stderr(&early).contains("of 2 tasks of the previous stage, 2 not computed"), "{}", stderr(&early));
    assert!(stderr(&early).contains("\nhelp: jobs of the run are in the Slurm queue"), "{}", stderr(&early));
    // Of the job itself nothing is waited for.
    let own = bench.command("aggregate").env("PATH", &path).env("SLURM_JOB_ID", "31").output().unwrap();
    assert!(stderr(&own).contains("\nhelp: submit them with `hysteron submit "), "{}", stderr(&own));
}

#[cfg(unix)]
#[test]
fn e2e_refusals_of_sbatch_name_the_option() {
    let bench = Bench::new(SMALL);
    let refusing =
        "echo 'sbatch: error: invalid partition specified: gpu' >&2\necho 'sbatch: error: Batch job submission failed' >&2\nexit 1";
    let submit = |scripts: &[(&str, &str)], more: &[&str]| {
        let path = commands(&bench, scripts);
        bench.command("submit").args(["--engine", "slurm"]).args(more).env("PATH", path).output().unwrap()
    };
    let scripts = [("sbatch", refusing), ("sinfo", "echo 4; echo 2"), ("scontrol", "exit 1")];
    let refused = submit(&scripts, &["--option=--partition=gpu"]);
    assert_eq!(code(&refused), 1);
    let wanted =
        "error: sbatch refused the job: invalid partition specified: gpu; no job was submitted\nhelp: check --option=--partition=gpu\n";
    assert_eq!(stderr(&refused), wanted);
    let once = format!("if [ -e '{0}' ]; then {refusing}; fi\n: >'{0}'\necho 7", bench.folder.path().join("sent").display());
    let second = submit(&[("sbatch", &once)], &[]);
    assert!(stderr(&second).contains("; submitted before: 7; `scancel 7` cancels them\n"), "{}", stderr(&second));
    let bench = Bench::new(SMALL);
    let cpus =
        bench.command("submit").args(["--engine", "slurm", "--cpus", "99"]).env("PATH", commands(&bench, &scripts)).output().unwrap();
    assert_eq!(code(&cpus), 1);
    assert!(stderr(&cpus).starts_with("error: no node has 99 processors (--cpus 99)\nhelp: use --cpus 4 or less"), "{}", stderr(&cpus));
    let option = bench.verb("submit", &["--engine", "slurm", "--dry-run", "--option=time=0:10:00"]);
    assert_eq!(code(&option), 2);
    assert!(stderr(&option).ends_with("help: write --option=--time=0:10:00\n"), "{}", stderr(&option));
    let short = bench.verb("submit", &["--engine", "slurm", "--dry-run", "--option=--time=2"]);
    assert!(code(&short) == 0 && stderr(&short).starts_with("warning: a time limit of 120 s may leave only 30 s"), "{}", stderr(&short));
    assert!(!bench.out().exists(), "nothing is written");
}

#[cfg(unix)]
#[test]
fn e2e_status_does_not_wait_for_a_queue_that_is_silent() {
    use std::os::unix::fs::PermissionsExt as _;
    let bench = Bench::new(SMALL);
    assert_eq!(code(&bench.verb("run", &["--until", "generate"])), 0);
    let commands = bench.folder.path().join("bin");
    std::fs::create_dir(&commands).unwrap();
    // Its child holds the output open, whatever becomes of the command.
    std::fs::write(commands.join("squeue"), "#!/bin/sh\nsleep 100\necho 1 2 RUNNING\n").unwrap();
    std::fs::set_permissions(commands.join("squeue"), std::fs::Permissions::from_mode(0o755)).unwrap();
    std::fs::create_dir(bench.out().join("slurm")).unwrap();
    std::fs::write(bench.out().join("slurm/jobs.json"), r#"[{"job":1,"stage":"cycle","first":0,"shards":2}]"#).unwrap();
    let path = format!("{}:{}", commands.display(), std::env::var("PATH").unwrap_or_default());
    for more in [&[][..], &["--json"]] {
        let mut command = Command::new("timeout");
        command.args(["60", env!("CARGO_BIN_EXE_hysteron"), "status"]).arg(bench.out()).args(more).env("PATH", &path);
        let status = command.output().unwrap();
        assert_eq!(code(&status), 0, "{}", stderr(&status));
        let said = stdout(&status);
        assert!(said.contains("1 job submitted; the queue cannot be asked here\n") || said.contains("\"tasks\": null"), "{said}");
    }
}

#[test]
fn val_a_licence_is_an_address_or_an_identifier() {
    for (text, address) in [
        ("https://creativecommons.org/licenses/by/4.0/", "https://creativecommons.org/licenses/by/4.0/"),
        ("HTTP://example.org/licence", "HTTP://example.org/licence"),
        ("CC-BY-4.0", "https://spdx.org/licenses/CC-BY-4.0"),
        ("0BSD", "https://spdx.org/licenses/0BSD"),
        ("GPL-2.0+", "https://spdx.org/licenses/GPL-2.0+"),
    ] {
        assert_eq!(licence(text), Ok(address.to_owned()));
    }
    for wrong in [
        "javascript:alert(1)",
        "data:text/html,x",
        "https://",
        "https:///x",
        "https://a b",
        "https://a\nb",
        "file:///etc/passwd",
        "",
        "-x",
        "MIT OR Apache-2.0",
        "a/b",
    ] {
        assert!(licence(wrong).unwrap_err().contains("\nhelp: "), "{wrong}");
    }
}

/// A Slurm that ends with the test.
struct Slurm {
    folder: PathBuf,
}

impl Slurm {
    fn script(verb: &str, folder: &Path) -> Output {
        Command::new(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/slurm/local.sh")).arg(verb).arg(folder).output().unwrap()
    }

    fn start() -> Option<Self> {
        // Its socket's path must be short, and its folder open to all.
        let slurm = Self { folder: std::env::temp_dir().join(format!("hysteron-slurm-{}", std::process::id())) };
        let up = Self::script("up", &slurm.folder);
        if !up.status.success() {
            skip("slurm", stderr(&up).trim());
            return None;
        }
        Some(slurm)
    }

    fn run(&self, command: &mut Command) -> Output {
        command.env("SLURM_CONF", self.folder.join("slurm.conf")).output().unwrap()
    }
}

impl Drop for Slurm {
    fn drop(&mut self) {
        Self::script("down", &self.folder);
        let _ = std::fs::remove_dir_all(&self.folder);
    }
}

#[test]
fn e2e_slurm_does_what_run_does() {
    let Some(slurm) = Slurm::start() else { return };
    let alone = Bench::new(SPEC);
    assert_eq!(code(&alone.verb("run", &[])), 0);
    let bench = Bench::new(SPEC);
    // One unit is done before; one surface has gone since.
    assert_eq!(code(&bench.verb("run", &["--until", "cycle", "--shard", "0/4"])), 0);
    let submit = |more: &[&str]| slurm.run(bench.command("submit").args(["--engine", "slurm", "--json"]).args(more));
    let sent = submit(&[]);
    assert_eq!(code(&sent), 0, "{}", stderr(&sent));
    let answer: Value = serde_json::from_str(&stdout(&sent)).unwrap();
    let counts: Vec<&Value> = answer["jobs"].as_array().unwrap().iter().map(|job| &job["task_count"]).collect();
    assert_eq!(counts, [3, 3, 3, 1], "what was done is not sent");
    // At once again: all of it is in the queue, or done since.
    let again = submit(&[]);
    assert_eq!(code(&again), 0, "{}", stderr(&again));
    assert!(stdout(&again).contains("\"jobs\": []"), "{}", stdout(&again));
    let began = Instant::now();
    while !bench.out().join("receipts/report/report.json").is_file() {
        assert!(began.elapsed() < Duration::from_secs(120), "{}", stdout(&slurm.run(Command::new("squeue").arg("--all"))));
        std::thread::sleep(Duration::from_millis(200));
    }
    let status = slurm.run(Command::new(env!("CARGO_BIN_EXE_hysteron")).arg("status").arg(bench.out()));
    assert!(stdout(&status).contains("Nothing is left") && stdout(&status).contains("slurm "), "{}", stdout(&status));
    let results = |bench: &Bench| files(&bench.out()).into_iter().filter(|(path, _)| !path.starts_with("slurm")).collect::<Vec<_>>();
    assert!(results(&bench) == results(&alone), "other bytes than of a run");
    let nothing = slurm.run(bench.command("submit").args(["--engine", "slurm"]));
    assert!(stdout(&nothing).contains("everything is done"), "{}", stdout(&nothing));
}

#[test]
fn e2e_a_crate_describes_every_file() {
    let bench = Bench::new(SMALL);
    assert_eq!(code(&bench.verb("run", &[])), 0);
    let own = files(&bench.out());
    let made = Command::new(env!("CARGO_BIN_EXE_hysteron"))
        .args(["export", "ro-crate", "--license", "https://creativecommons.org/licenses/by/4.0/", "--publisher", "A University"])
        .arg(bench.out())
        .output()
        .unwrap();
    assert_eq!(code(&made), 0, "{}", stderr(&made));
    let text = std::fs::read_to_string(bench.out().join("ro-crate-metadata.json")).unwrap();
    let whole: Value = serde_json::from_str(&text).unwrap();
    let graph = whole["@graph"].as_array().unwrap();
    let described: BTreeSet<PathBuf> =
        graph.iter().filter(|entity| entity["@type"] == "File").map(|entity| PathBuf::from(entity["@id"].as_str().unwrap())).collect();
    assert_eq!(described, own.into_keys().collect());
    // The profile RO-Crate 1.2: what must be said of software, and should be of files, licence and publisher.
    for entity in graph {
        let has = |names: &[&str]| names.iter().all(|name| entity[*name].as_str().is_some_and(|text| !text.is_empty()));
        match entity["@type"].as_str().unwrap() {
            "SoftwareApplication" => assert!(has(&["name", "url", "version", "softwareVersion"]), "{entity:#}"),
            "File" => assert!(has(&["name", "description"]) && entity["description"] != "File of the run", "{entity:#}"),
            "CreateAction" => assert_ne!(entity["result"].as_array().map(Vec::len), Some(1), "{entity:#}"),
            "Organization" => assert_eq!(entity["name"], "A University"),
            "CreativeWork" => assert!(entity["@id"] == "ro-crate-metadata.json" || has(&["name", "description"]), "{entity:#}"),
            _ => assert_eq!(entity["publisher"]["@id"], "#publisher"),
        }
    }
    // Whatever an entity refers to is in the graph, or an address.
    let known: BTreeSet<&str> = graph.iter().map(|entity| entity["@id"].as_str().unwrap()).collect();
    assert_eq!(known.len(), graph.len(), "each entity once");
    fn references<'a>(value: &'a Value, found: &mut Vec<&'a str>) {
        match value {
            Value::Array(items) => items.iter().for_each(|item| references(item, found)),
            Value::Object(members) if members.len() == 1 && members.contains_key("@id") => found.extend(members["@id"].as_str()),
            Value::Object(members) => members.values().for_each(|member| references(member, found)),
            _ => {}
        }
    }
    let mut found = Vec::new();
    references(&whole["@graph"], &mut found);
    assert!(found.len() > 40);
    assert!(found.iter().all(|id| known.contains(id) || id.starts_with("https://")), "{found:?}");
}
