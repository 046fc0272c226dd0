//! What other programs run a campaign with.

use super::SMALL;
use crate::bench::{Bench, SPEC, code, files, stderr, stdout};
use crate::python;
use hysteron::campaign::{Campaign, Stage};
use hysteron::engines::ro_crate::licence;
use hysteron::engines::slurm::{Order, Queue, Sent, jobs, script};
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
    let sent = |job: u64, stage: &str, first: usize| Sent { job, stage: stage.to_owned(), first, shards: 9 };
    let known = [sent(5, "cycle", 0), sent(6, "cycle", 4), sent(7, "aggregate", 0)];
    let queue = Queue::parse("5 1 RUNNING\n5 2 COMPLETED\n6 0 PENDING\n7 N/A PENDING\n8 1 RUNNING\nnonsense\n", &known);
    let shards: Vec<usize> = queue.shards.iter().map(|(_, _, shard)| *shard).collect();
    assert_eq!((shards, queue.aggregates), (vec![1, 4], true));
    assert_eq!(
        queue.states.iter().map(|(state, count)| format!("{count} {state}")).collect::<Vec<_>>(),
        ["1 completed", "2 pending", "1 running"]
    );
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
            eprintln!("skipped: {}", stderr(&up).trim());
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
fn e2e_snakemake_does_what_run_does() {
    let Some(program) = python::environment("snakemake", &["snakemake==9.*"]).map(|folder| folder.join("bin/snakemake")) else { return };
    let alone = Bench::new(SPEC);
    assert_eq!(code(&alone.verb("run", &[])), 0);
    let bench = Bench::new(SPEC);
    let written = Command::new(env!("CARGO_BIN_EXE_hysteron"))
        .args(["export", "snakemake", "--shards", "3", "--out"])
        .arg(bench.out())
        .arg(bench.spec())
        .output()
        .unwrap();
    assert_eq!(code(&written), 0, "{}", stderr(&written));
    let run = || {
        let mut command = Command::new(&program);
        command.arg("--snakefile").arg(bench.out().join("snakemake/Snakefile")).args(["--cores", "2"]).current_dir(bench.folder.path());
        let path = format!("{}:{}", program.parent().unwrap().display(), std::env::var("PATH").unwrap_or_default());
        command.env("PATH", path).output().unwrap()
    };
    let first = run();
    assert!(first.status.success(), "{}", stderr(&first));
    let results = |bench: &Bench| files(&bench.out()).into_iter().filter(|(path, _)| !path.starts_with("snakemake")).collect::<Vec<_>>();
    assert!(results(&bench) == results(&alone), "other bytes than of a run");
    let again = run();
    assert!(again.status.success() && (stderr(&again) + &stdout(&again)).contains("Nothing to be done"), "{}", stderr(&again));
}

#[test]
fn e2e_a_crate_describes_every_file() {
    let bench = Bench::new(SMALL);
    assert_eq!(code(&bench.verb("run", &[])), 0);
    let own = files(&bench.out());
    let made = Command::new(env!("CARGO_BIN_EXE_hysteron"))
        .args(["export", "ro-crate", "--license", "https://creativecommons.org/licenses/by/4.0/"])
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
