//! Slurm: a job array for each stage, whose tasks are shards.
//!
//! Task k of a stage waits for task k of the stage before it
//! (`aftercorr`), and is cancelled where that has failed (`--kill-on-invalid-dep`), so that nothing waits for
//! ever. Aggregation waits until all cycles have ended, however they ended, and checks for itself what there
//! is.

use crate::campaign::{Campaign, Stage};
use crate::text::shell_path;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Jobs to submit.
#[derive(Debug, Clone)]
pub struct Order {
    /// The program, as the nodes find it.
    pub program: PathBuf,
    /// Shards of the campaign.
    pub shards: usize,
    /// Shards to be submitted, for each stage; a stage without such shards is absent.
    pub waiting: Vec<(Stage, Vec<usize>)>,
    /// Indices of an array go up to this, without it.
    pub most: usize,
    /// Threads of a task.
    pub cpus: u16,
    /// Further options for `sbatch`, as written after `#SBATCH`.
    pub options: Vec<String>,
    /// Jobs of this campaign in the queue: submitted jobs wait until these have ended, with or without
    /// success.
    pub queued: Vec<u64>,
}

impl Order {
    /// Options of `submit` that give this order again.
    #[must_use]
    pub fn arguments(&self) -> Vec<String> {
        let mut arguments = vec![format!("--shards={}", self.shards)];
        if self.cpus > 1 {
            arguments.push(format!("--cpus={}", self.cpus));
        }
        arguments.extend(self.options.iter().map(|option| format!("--option={option}")));
        arguments
    }
}

/// A job array, or the job that aggregates.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Job {
    /// The stage.
    pub stage: Stage,
    /// The number of the shard that task 0 does.
    pub first: usize,
    /// The tasks of the array; none for the job that aggregates.
    pub tasks: Vec<usize>,
    /// Places of the jobs in the order of submission that this one waits for.
    pub after: Vec<usize>,
}

/// A job that was sent, as `slurm/jobs.json` has it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Sent {
    /// Slurm's number.
    pub job: u64,
    /// The stage's word.
    pub stage: String,
    /// The number of the shard that task 0 does.
    pub first: usize,
    /// Shards of the campaign when it was sent.
    pub shards: usize,
    /// Tasks of the array; empty for the job that aggregates.
    #[serde(default)]
    pub tasks: Vec<usize>,
    /// Options of `submit` with which it was sent.
    #[serde(default)]
    pub options: Vec<String>,
}

impl Sent {
    /// Name of a task's log in `slurm/log`.
    #[must_use]
    pub fn log(&self, task: Option<usize>) -> String {
        match task {
            Some(task) => format!("{}-{}_{task}.log", self.stage, self.job),
            None => format!("{}-{}.log", self.stage, self.job),
        }
    }
}

/// Seconds before the time limit at which Slurm signals a task, for limits of six minutes and more.
pub const LEAD_S: u64 = 90;

/// Seconds by which Slurm may signal earlier than requested (manual of `sbatch`, `--signal`).
pub const EARLY_S: u64 = 60;

/// Time limit in seconds of options of sbatch, if one sets it: `--time=1-2:00:00`, `-t 30`.
#[must_use]
pub fn time_limit_s(options: &[String]) -> Option<u64> {
    let value = |option: &String| {
        let rest = option.strip_prefix("--time").or_else(|| option.strip_prefix("-t"))?;
        seconds(rest.trim_start_matches(['=', ' ']).trim())
    };
    options.iter().filter_map(value).next_back()
}

/// Seconds of a time as Slurm writes it: `minutes`, `m:s`, `h:m:s`, `d-h`, `d-h:m`, `d-h:m:s`.
fn seconds(text: &str) -> Option<u64> {
    let (days, rest) = text.split_once('-').map_or((None, text), |(days, rest)| (Some(days), rest));
    let parts = rest.split(':').map(|part| part.parse::<u64>().ok()).collect::<Option<Vec<u64>>>()?;
    let units: &[u64] = match (days.is_some(), parts.len()) {
        (false, 1) => &[60],
        (false, 2) => &[60, 1],
        (true, 1..=3) | (false, 3) => &[3600, 60, 1],
        _ => return None,
    };
    let of_days = days.map_or(Some(0), |days| days.parse::<u64>().ok()?.checked_mul(86_400))?;
    parts.iter().zip(units).try_fold(of_days, |sum, (part, unit)| sum.checked_add(part.checked_mul(*unit)?))
}

/// Seconds before a time limit at which a task is signalled: a quarter of a short limit.
#[must_use]
pub fn lead_s(limit: Option<u64>) -> u64 {
    limit.map_or(LEAD_S, |limit| (limit / 4).clamp(1, LEAD_S))
}

/// The folder of the scripts, the logs and `jobs.json`.
#[must_use]
pub fn folder(campaign: &Campaign) -> PathBuf {
    campaign.dir.join("slurm")
}

/// The script of a stage; that of [`Stage::Aggregate`] makes the report too.
#[must_use]
pub fn script(campaign: &Campaign, stage: Stage, order: &Order) -> String {
    let (name, word) = (&campaign.spec.name, stage.word());
    let [program, dir, spec] =
        [order.program.clone(), campaign.dir.clone(), campaign.dir.join("campaign.toml")]
            .map(|path| shell_path(&path));
    let log = folder(campaign).join("log");
    let array = stage <= Stage::Cycle;
    let mut text = format!(
        "#!/bin/bash\n# {word} of the campaign {name}. `hysteron submit` wrote this file, and writes it \
         anew.\n"
    );
    let mut option = |what: &str| text.push_str(&format!("#SBATCH {what}\n"));
    option(&format!("--job-name={name}-{word}"));
    option(&format!("--output=\"{}/{word}-{}.log\"", log.display(), if array { "%A_%a" } else { "%j" }));
    option("--open-mode=append");
    option("--requeue");
    option(&format!("--signal=B:USR1@{}", lead_s(time_limit_s(&order.options))));
    option(&format!("--cpus-per-task={}", if array { order.cpus } else { 1 }));
    order.options.iter().for_each(|given| option(given));
    let this = if array { "${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID" } else { "$SLURM_JOB_ID" };
    let mark = shell_path(&log.join(word));
    let [records, cycles] = ["receipts", "cycles"].map(|name| shell_path(&campaign.dir.join(name)));
    text.push_str(&format!(
        "set -u\nthis={this}\nbegan={mark}-$this.began\n: >\"$began\"\nchild= again=0 stop=0 code=0\n\
         end() {{ stop=1; [ -z \"$child\" ] || kill -TERM \"$child\"; }}\n\
         # Slurm sends USR1 before the time limit: the current file is finished, and the task \
         returns to the queue.\n\
         trap 'again=1; end' USR1\ntrap end TERM\n\
         # A signal that comes before the number of the program is known is passed on as soon as it is.\n\
         work() {{\n  \"$@\" &\n  child=$! code=129\n  [ \"$stop\" = 0 ] || kill -TERM \"$child\"\n  \
         while [ \"$code\" -gt 128 ] && kill -0 \"$child\" 2>/dev/null; do wait \"$child\"; code=$?; done\n  \
         child=\n}}\n\
         # A task that has written nothing since its start would be interrupted at the same point again.\n\
         progress() {{ [ -n \"$(find {records} {cycles} -newer \"$began\" \\( -name '*.json' -o -name \
         halfway.bin \\) -print -quit 2>/dev/null)\" ]; }}\n"
    ));
    if array {
        let (shards, cpus) = (order.shards, order.cpus);
        text.push_str(&format!(
            "work {program} {word} {spec} --out {dir} --shard \"$((HYSTERON_FIRST + \
             SLURM_ARRAY_TASK_ID))/{shards}\" --jobs {cpus}\n"
        ));
    } else {
        text.push_str(&format!("work {program} aggregate {spec} --out {dir} --jobs 1 --quiet\n"));
        text.push_str(&format!(
            "[ \"$code\" != 0 ] || [ \"$again\" = 1 ] || work {program} report {spec} --out {dir} --jobs 1\n"
        ));
    }
    text.push_str(
        "if [ \"$again\" = 1 ] && [ \"$code\" -gt 128 ]; then\n  \
         if progress; then\n    scontrol requeue \"$this\"\n  else\n    \
         echo 'error: no task was finished within the time limit, so the job does not return to the \
         queue' >&2\n    \
         echo 'help: repeat `hysteron submit` with a longer limit, for example \
         --option=--time=4:00:00' >&2\n    code=1\n  fi\nfi\n\
         rm -f \"$began\"\nexit \"$code\"\n",
    );
    text
}

/// The jobs of an order, in the order of submission: arrays split where they are longer than the site allows,
/// then the one that aggregates.
#[must_use]
pub fn jobs(order: &Order) -> Vec<Job> {
    let mut jobs: Vec<Job> = Vec::new();
    let shards: BTreeSet<usize> =
        order.waiting.iter().flat_map(|(_, shards)| shards.iter().copied()).collect();
    let firsts: BTreeSet<usize> = shards.iter().map(|shard| shard / order.most * order.most).collect();
    let mut last = Vec::new();
    for first in firsts {
        let inside = |shard: &&usize| (first..first + order.most).contains(*shard);
        // Every stage of these has the same tasks, so that they correspond; one that has nothing to do ends
        // at once.
        let tasks: Vec<usize> = shards.iter().filter(inside).map(|shard| shard - first).collect();
        let mut before = None;
        for (stage, _) in
            order.waiting.iter().filter(|(_, waiting)| waiting.iter().any(|shard| inside(&shard)))
        {
            jobs.push(Job {
                stage: *stage,
                first,
                tasks: tasks.clone(),
                after: before.into_iter().collect(),
            });
            before = Some(jobs.len() - 1);
        }
        last.extend(before);
    }
    jobs.push(Job { stage: Stage::Aggregate, first: 0, tasks: Vec::new(), after: last });
    jobs
}

impl Job {
    /// Arguments of `sbatch`, after jobs with these numbers.
    #[must_use]
    pub fn arguments(&self, folder: &Path, numbers: &[String], queued: &[u64]) -> Vec<String> {
        let mut arguments = vec!["--parsable".to_owned()];
        if self.stage <= Stage::Cycle {
            arguments.push(format!("--array={}", ranges(&self.tasks)));
            arguments.push(format!("--export=ALL,HYSTERON_FIRST={}", self.first));
        }
        let mut after: Vec<String> = self.after.iter().map(|place| numbers[*place].clone()).collect();
        let mut any: Vec<String> = Vec::new();
        // What waits for one of these jobs waits for what that one waits for.
        if self.after.is_empty() || self.stage > Stage::Cycle {
            any.extend(queued.iter().map(u64::to_string));
        }
        if self.stage > Stage::Cycle {
            any.append(&mut after);
        }
        let kinds = [("aftercorr", after), ("afterany", any)];
        let dependencies: Vec<String> = kinds
            .iter()
            .filter(|(_, jobs)| !jobs.is_empty())
            .map(|(kind, jobs)| format!("{kind}:{}", jobs.join(":")))
            .collect();
        if !dependencies.is_empty() {
            arguments.push(format!("--dependency={}", dependencies.join(",")));
            arguments.push("--kill-on-invalid-dep=yes".to_owned());
        }
        arguments.push(folder.join(format!("{}.sbatch", self.stage.word())).display().to_string());
        arguments
    }
}

/// Ascending numbers as Slurm has them: `0-3,7`.
fn ranges(numbers: &[usize]) -> String {
    let mut parts: Vec<(usize, usize)> = Vec::new();
    for &number in numbers {
        match parts.last_mut() {
            Some((_, last)) if *last + 1 == number => *last = number,
            _ => parts.push((number, number)),
        }
    }
    let words: Vec<String> =
        parts.iter().map(|(a, b)| if a == b { a.to_string() } else { format!("{a}-{b}") }).collect();
    words.join(",")
}

/// State of submitted jobs in Slurm's queue; [`QUERY`] gives a line for each task.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Queue {
    /// Number of waiting and running tasks by state, as Slurm calls it.
    pub states: BTreeMap<String, usize>,
    /// Shards that are waiting or running, by the stage's word and how many shards there were.
    pub shards: BTreeSet<(String, usize, usize)>,
    /// True if the job that aggregates is there.
    pub aggregates: bool,
    /// The jobs that are there.
    pub jobs: BTreeSet<u64>,
    /// States of tasks that have ended and that Slurm still lists, by job and task.
    pub ended: BTreeMap<(u64, Option<usize>), String>,
    /// Number of restarts of all waiting and running tasks.
    pub restarts: usize,
}

/// Arguments of `squeue`: job, task, state and number of restarts of each task, ended ones included.
pub const QUERY: [&str; 7] =
    ["--me", "-h", "-r", "-t", "all", "-O", "ArrayJobID:24,ArrayTaskID:24,State:24,RestartCnt:24"];

impl Queue {
    /// Reads the answer of `squeue` to [`QUERY`].
    #[must_use]
    pub fn parse(answer: &str, sent: &[Sent]) -> Self {
        let mut queue = Self::default();
        for line in answer.lines() {
            let mut words = line.split_whitespace();
            let (Some(job), Some(task), Some(state)) = (words.next(), words.next(), words.next()) else {
                continue;
            };
            let Some(sent) = sent.iter().find(|sent| job.parse() == Ok(sent.job)) else { continue };
            let task = task.parse::<usize>().ok();
            if !matches!(
                state,
                "PENDING"
                    | "RUNNING"
                    | "REQUEUED"
                    | "REQUEUE_FED"
                    | "CONFIGURING"
                    | "COMPLETING"
                    | "SUSPENDED"
                    | "REQUEUE_HOLD"
                    | "STOPPED"
                    | "SIGNALING"
                    | "STAGE_OUT"
                    | "RESIZING"
            ) {
                queue.ended.insert((sent.job, task), state.to_owned());
                continue;
            }
            *queue.states.entry(state.to_lowercase()).or_default() += 1;
            queue.restarts += words.next().and_then(|count| count.parse().ok()).unwrap_or(0);
            queue.jobs.insert(sent.job);
            match task {
                Some(task) => {
                    queue.shards.insert((sent.stage.clone(), sent.shards, sent.first + task));
                }
                None => queue.aggregates = true,
            }
        }
        queue
    }
}
