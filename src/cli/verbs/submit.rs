//! `submit`: pending tasks as Slurm jobs; and the state of Slurm's queue for `status`.

use super::place::{open, told};
use super::{BAD_SPEC, Fault, failed, make_folder, own_file, say};
use crate::campaign::{Campaign, Stage, Standing};
use crate::cli::OutputArguments;
use crate::engines::slurm::{Job, Order, Queue, Sent, folder, jobs, script};
use crate::engines::{open_shards, usual_shards};
use crate::stages;
use crate::store::{Check, commit};
use crate::text::{counted, shell_path, shell_quote, shown as path_shown};
use serde_json::{Value, json};
use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

/// What Slurm lets array indices go up to where it does not say.
const USUAL_MOST: usize = 1001;

pub(super) fn slurm(spec: &Path, output: &OutputArguments, shards: Option<u32>, task: (u16, &[String]), dry: bool) -> Result<u8, Fault> {
    if let Some(option) = task.1.iter().find(|option| option.chars().any(char::is_control)) {
        let text =
            format!("error: --option {option:?} has a control character\nhelp: give one option of sbatch for each --option, on one line");
        return Err(Fault { code: BAD_SPEC, text });
    }
    let mut campaign = open(spec, output)?;
    campaign.dir = told(&campaign.dir)?;
    let shards = shards.map_or_else(|| usual_shards(&campaign), |count| count as usize);
    let sent = sent(&campaign)?;
    let queue = queue(&sent).unwrap_or_default();
    if let Some((_, of, _)) = queue.shards.iter().find(|(_, of, _)| *of != shards) {
        return Err(failed(format!(
            "cannot submit {} in {shards} shards: jobs with {of} shards are in the queue\nhelp: use --shards {of}, or wait until they have ended",
            campaign.spec.name
        )));
    }
    let survey = campaign.survey(Check::Sizes);
    let open = |stage: Stage| {
        let mut open = open_shards(&campaign, &survey, stage, shards);
        // What is in the queue is on its way.
        open.retain(|shard| !queue.shards.contains(&(stage.word().to_owned(), shards, *shard)));
        (stage, open)
    };
    let waiting: Vec<_> =
        [Stage::Generate, Stage::Extract, Stage::Cycle].map(open).into_iter().filter(|(_, open)| !open.is_empty()).collect();
    if waiting.is_empty() && (queue.aggregates || survey.report == Standing::Done) {
        let why = if queue.aggregates { "all pending tasks are in the queue" } else { "everything is done" };
        say(&if output.json { jobs_json(&campaign, &[], &[]) } else { format!("Nothing to submit: {why}.\n") })?;
        return Ok(0);
    }
    let program = own_file()?;
    let queued = queue.jobs.iter().copied().collect();
    let order = Order { program, shards, waiting, most: most(), cpus: task.0, options: task.1.to_vec(), queued };
    if dry { show(&campaign, &order, output.json) } else { send(&campaign, &order, sent, output.json) }
}

/// The scripts of an order, each with its place.
fn scripts(campaign: &Campaign, order: &Order, jobs: &[Job]) -> Vec<(PathBuf, String)> {
    let mut stages: Vec<Stage> = jobs.iter().map(|job| job.stage).collect();
    stages.sort_unstable();
    stages.dedup();
    let place = |stage: Stage| folder(campaign).join(format!("{}.sbatch", stage.word()));
    stages.into_iter().map(|stage| (place(stage), script(campaign, stage, order))).collect()
}

/// Says what would be done.
fn show(campaign: &Campaign, order: &Order, json: bool) -> Result<u8, Fault> {
    let (folder, jobs) = (folder(campaign), jobs(order));
    let names: Vec<String> = jobs.iter().enumerate().map(|(place, job)| format!("<{}-{place}>", job.stage.word())).collect();
    let commands: Vec<Vec<String>> = jobs.iter().map(|job| job.arguments(&folder, &names, &order.queued)).collect();
    let scripts = scripts(campaign, order, &jobs);
    if json {
        let scripts: serde_json::Map<String, Value> =
            scripts.into_iter().map(|(path, text)| (path.display().to_string(), text.into())).collect();
        say(&format!("{:#}\n", json!({ "scripts": scripts, "sbatch": commands })))?;
        return Ok(0);
    }
    for (path, text) in scripts {
        say(&format!("# {}\n{text}\n", path_shown(&path)))?;
    }
    for (command, name) in commands.iter().zip(&names) {
        say(&format!("{name} = sbatch {}\n", shown(command)))?;
    }
    Ok(0)
}

/// Writes the scripts and submits the jobs.
fn send(campaign: &Campaign, order: &Order, mut sent: Vec<Sent>, json: bool) -> Result<u8, Fault> {
    let (folder, jobs) = (folder(campaign), jobs(order));
    stages::prepare(campaign).map_err(failed)?;
    let log = folder.join("log");
    make_folder(&log)?;
    for (path, text) in scripts(campaign, order, &jobs) {
        commit::commit_bytes("write the script", &path, text.as_bytes()).map_err(failed)?;
    }
    let mut numbers: Vec<String> = Vec::new();
    for job in &jobs {
        let number = sbatch(&job.arguments(&folder, &numbers, &order.queued))?;
        sent.push(Sent { job: number, stage: job.stage.word().to_owned(), first: job.first, shards: order.shards });
        // After each, so that none that was sent is forgotten.
        remember(campaign, &sent)?;
        if !json {
            let tasks = counted(job.tasks.len().max(1), "task");
            say(&format!("{:9} job {number}, {tasks}\n", job.stage.word()))?;
        }
        numbers.push(number.to_string());
    }
    let (dir, log) = (shell_path(&campaign.dir), path_shown(&log));
    say(&if json {
        jobs_json(campaign, &jobs, &numbers)
    } else {
        format!("Logs: {log}\n`hysteron status {dir}` shows the state. The same command submits only missing tasks.\n")
    })?;
    Ok(0)
}

/// The jobs that were sent now.
fn jobs_json(campaign: &Campaign, jobs: &[Job], numbers: &[String]) -> String {
    let jobs: Vec<Value> = jobs
        .iter()
        .zip(numbers)
        .map(|(job, number)| json!({ "stage": job.stage.word(), "job": number, "task_count": job.tasks.len().max(1) }))
        .collect();
    format!("{:#}\n", json!({ "name": campaign.spec.name, "dir": campaign.dir.display().to_string(), "jobs": jobs }))
}

/// Arguments as a shell takes them.
fn shown(arguments: &[String]) -> String {
    arguments.iter().map(|word| shell_quote(word)).collect::<Vec<_>>().join(" ")
}

fn sbatch(arguments: &[String]) -> Result<u64, Fault> {
    let refused = |why: &str| failed(format!("cannot submit with `sbatch {}` (jobs submitted before are kept): {why}", shown(arguments)));
    let output = Command::new("sbatch")
        .args(arguments)
        .output()
        .map_err(|error| refused(&format!("{error}\nhelp: use a machine with the commands of Slurm, or --dry-run")))?;
    let said = String::from_utf8_lossy(&output.stdout);
    // `--parsable` says the number, and where there are several clusters a semicolon and which.
    let number = said.trim().split(';').next().and_then(|number| number.parse().ok());
    number.filter(|_| output.status.success()).ok_or_else(|| match String::from_utf8_lossy(&output.stderr).trim() {
        "" => refused("it returned no job number"),
        why => refused(why),
    })
}

/// How long Slurm's commands may take to answer a question.
const PATIENCE: Duration = Duration::from_secs(5);

/// What a command prints, if it succeeds in time. One that does not answer is killed.
fn answer(command: &str, arguments: &[&str]) -> Option<String> {
    let mut child = Command::new(command).args(arguments).stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().ok()?;
    let mut output = child.stdout.take()?;
    let (tell, told) = std::sync::mpsc::channel();
    // A thread of its own: what the command has started may hold its output open, and is not waited for.
    let read = move || {
        let mut text = Vec::new();
        tell.send(output.read_to_end(&mut text).map(|_| String::from_utf8_lossy(&text).into_owned()))
    };
    std::thread::Builder::new().name(command.to_owned()).spawn(read).ok()?;
    let text = told.recv_timeout(PATIENCE).ok().and_then(Result::ok);
    if text.is_none() {
        let _ = child.kill();
    }
    let status = child.wait().ok()?;
    text.filter(|_| status.success())
}

/// How far array indices may go here.
fn most() -> usize {
    let text = answer("scontrol", &["show", "config"]).unwrap_or_default();
    let line = text.lines().find(|line| line.trim_start().starts_with("MaxArraySize"));
    line.and_then(|line| line.split('=').nth(1)?.trim().parse().ok()).filter(|most| *most > 0).unwrap_or(USUAL_MOST)
}

/// The jobs that were sent for a campaign.
pub(super) fn sent(campaign: &Campaign) -> Result<Vec<Sent>, Fault> {
    let path = folder(campaign).join("jobs.json");
    let refused = |why: String| {
        let path = path_shown(&path);
        failed(format!("cannot read the submitted jobs from {path}: {why}\nhelp: delete the file when none of its jobs is in the queue"))
    };
    match std::fs::read(&path) {
        Ok(bytes) => serde_json::from_slice(&bytes).map_err(|error| refused(error.to_string())),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(Vec::new()),
        Err(error) => Err(refused(error.to_string())),
    }
}

fn remember(campaign: &Campaign, sent: &[Sent]) -> Result<(), Fault> {
    let text = format!("{:#}\n", json!(sent));
    commit::commit_bytes("write down the jobs in", &folder(campaign).join("jobs.json"), text.as_bytes()).map(drop).map_err(failed)
}

/// What the queue has of some jobs; nothing where there is none to ask, or none that answers.
pub(super) fn queue(sent: &[Sent]) -> Option<Queue> {
    if sent.is_empty() {
        return Some(Queue::default());
    }
    answer("squeue", &["--me", "-h", "-r", "-o", "%F %K %T"]).map(|text| Queue::parse(&text, sent))
}
