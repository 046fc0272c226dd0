//! Slurm: a job array for each stage, whose tasks are shards.
//!
//! Task k of a stage waits for task k of the stage before it (`aftercorr`), and is cancelled where that has failed (`--kill-on-invalid-dep`), so that nothing
//! waits for ever. Aggregation waits until all cycles have ended, however they ended, and checks for itself what there is.

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
    /// For each stage of the shards those that are to be sent; a stage that none needs is not there.
    pub waiting: Vec<(Stage, Vec<usize>)>,
    /// Indices of an array go up to this, without it.
    pub most: usize,
    /// Threads of a task.
    pub cpus: u16,
    /// Further options for `sbatch`, as they stand after `#SBATCH`.
    pub options: Vec<String>,
    /// Jobs of this campaign that are in the queue: what is sent waits until they have ended, however.
    pub queued: Vec<u64>,
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
        [order.program.clone(), campaign.dir.clone(), campaign.dir.join("campaign.toml")].map(|path| shell_path(&path));
    let log = folder(campaign).join("log");
    let array = stage <= Stage::Cycle;
    let mut text = format!("#!/bin/bash\n# {word} of the campaign {name}. `hysteron submit` wrote this file, and writes it anew.\n");
    let mut option = |what: &str| text.push_str(&format!("#SBATCH {what}\n"));
    option(&format!("--job-name={name}-{word}"));
    option(&format!("--output=\"{}/{word}-{}.log\"", log.display(), if array { "%A_%a" } else { "%j" }));
    option("--open-mode=append");
    option("--requeue");
    option("--signal=B:USR1@90");
    option(&format!("--cpus-per-task={}", if array { order.cpus } else { 1 }));
    order.options.iter().for_each(|given| option(given));
    text.push_str("set -u\n");
    if !array {
        text.push_str(&format!("{program} aggregate {spec} --out {dir} && {program} report {spec} --out {dir}\n"));
        return text;
    }
    let (shards, cpus) = (order.shards, order.cpus);
    text.push_str(&format!(
        "{program} {word} {spec} --out {dir} --shard \"$((HYSTERON_FIRST + SLURM_ARRAY_TASK_ID))/{shards}\" --jobs {cpus} &\n"
    ));
    text.push_str(
        "work=$!\nagain=0\n\
         # Before the time limit Slurm says USR1: the file at hand is finished, and the task goes back into the queue and goes on from there.\n\
         trap 'again=1; kill -TERM \"$work\"' USR1\ntrap 'kill -TERM \"$work\"' TERM\n\
         code=129\nwhile [ \"$code\" -gt 128 ] && kill -0 \"$work\" 2>/dev/null; do wait \"$work\"; code=$?; done\n\
         if [ \"$again\" = 1 ]; then scontrol requeue \"${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID\"; fi\nexit \"$code\"\n",
    );
    text
}

/// The jobs of an order, in the order of submission: arrays split where they are longer than the site allows, then the one that aggregates.
#[must_use]
pub fn jobs(order: &Order) -> Vec<Job> {
    let mut jobs: Vec<Job> = Vec::new();
    let shards: BTreeSet<usize> = order.waiting.iter().flat_map(|(_, shards)| shards.iter().copied()).collect();
    let firsts: BTreeSet<usize> = shards.iter().map(|shard| shard / order.most * order.most).collect();
    let mut last = Vec::new();
    for first in firsts {
        let inside = |shard: &&usize| (first..first + order.most).contains(*shard);
        // Every stage of these has the same tasks, so that they correspond; one that has nothing to do ends at once.
        let tasks: Vec<usize> = shards.iter().filter(inside).map(|shard| shard - first).collect();
        let mut before = None;
        for (stage, _) in order.waiting.iter().filter(|(_, waiting)| waiting.iter().any(|shard| inside(&shard))) {
            jobs.push(Job { stage: *stage, first, tasks: tasks.clone(), after: before.into_iter().collect() });
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
        let dependencies: Vec<String> =
            kinds.iter().filter(|(_, jobs)| !jobs.is_empty()).map(|(kind, jobs)| format!("{kind}:{}", jobs.join(":"))).collect();
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
    let words: Vec<String> = parts.iter().map(|(a, b)| if a == b { a.to_string() } else { format!("{a}-{b}") }).collect();
    words.join(",")
}

/// What Slurm's queue has of the jobs that were sent: `squeue` was asked for `%F %K %T`, a line for each task.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Queue {
    /// Tasks by state, as Slurm calls it.
    pub states: BTreeMap<String, usize>,
    /// Shards that are waiting or running, by the stage's word and how many shards there were.
    pub shards: BTreeSet<(String, usize, usize)>,
    /// True if the job that aggregates is there.
    pub aggregates: bool,
    /// The jobs that are there.
    pub jobs: BTreeSet<u64>,
}

impl Queue {
    /// Reads the answer of `squeue -h -r -o "%F %K %T"`.
    #[must_use]
    pub fn parse(answer: &str, sent: &[Sent]) -> Self {
        let mut queue = Self::default();
        for line in answer.lines() {
            let mut words = line.split_whitespace();
            let (Some(job), Some(task), Some(state)) = (words.next(), words.next(), words.next()) else { continue };
            let Some(sent) = sent.iter().find(|sent| job.parse() == Ok(sent.job)) else { continue };
            *queue.states.entry(state.to_lowercase()).or_default() += 1;
            if !matches!(state, "PENDING" | "RUNNING" | "REQUEUED" | "CONFIGURING" | "COMPLETING" | "SUSPENDED" | "REQUEUE_HOLD") {
                continue;
            }
            queue.jobs.insert(sent.job);
            match task.parse::<usize>() {
                Ok(task) => {
                    queue.shards.insert((sent.stage.clone(), sent.shards, sent.first + task));
                }
                Err(_) => queue.aggregates = true,
            }
        }
        queue
    }
}
