//! `submit`: pending tasks as Slurm jobs; and the state of Slurm's queue for `status`.

use super::ending::failed_cycles;
use super::place::{open, script_path};
use super::{BAD_SPEC, FAILED_CASES, Fault, failed, make_folder, own_file, say};
use crate::campaign::{Campaign, Stage, Standing, Survey};
use crate::cli::OutputArguments;
use crate::engines::slurm::{
    EARLY_S, Job, Order, QUERY, Queue, Sent, folder, jobs, lead_s, script, time_limit_s,
};
use crate::engines::{open_shards, usual_shards};
use crate::stages;
use crate::store::{Check, commit};
use crate::text::{counted, shell_path, shell_quote, shown as path_shown};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::io::{Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

/// Number of array indices that Slurm allows by default.
const USUAL_MOST: usize = 1001;

/// Problem and help of an option that sbatch cannot read.
fn option_fault(option: &str) -> Option<String> {
    if option.chars().any(char::is_control) {
        return Some(format!(
            "error: --option {option:?} has a control character\nhelp: give one option of sbatch for each \
             --option, on one line"
        ));
    }
    if let Some((own, instead)) = reserved(option) {
        return Some(format!(
            "error: --option={own} would replace what `hysteron submit` sends\nhelp: {instead}"
        ));
    }
    (!option.starts_with('-')).then(|| {
        let option = shell_quote(&format!("--option=--{option}"));
        format!("error: an option of sbatch begins with a hyphen\nhelp: write {option}")
    })
}

/// The option of sbatch that an option means, if `submit` sets it, and what to do. sbatch takes the beginning
/// of a long name for the name.
fn reserved(option: &str) -> Option<(&'static str, &'static str)> {
    let name = option.split(['=', ' ']).next().unwrap_or_default();
    if "--wrap".starts_with(name) && name.starts_with("--wr") {
        return Some(("--wrap", "leave it out; use `sbatch` itself for other commands"));
    }
    let is_array = ("--array".starts_with(name) && name.starts_with("--ar"))
        || (name.starts_with("-a") && !name.starts_with("--"));
    is_array.then_some(("--array", "use --shards N for the number of parts"))
}

pub(super) fn slurm(
    spec: &Path,
    output: &OutputArguments,
    shards: Option<u32>,
    task: (u16, &[String]),
    dry: bool,
) -> Result<u8, Fault> {
    task.1.iter().try_for_each(|option| {
        option_fault(option).map_or(Ok(()), |text| Err(Fault { code: BAD_SPEC, text }))
    })?;
    let mut campaign = open(spec, output)?;
    campaign.dir = script_path(&campaign.dir)?;
    let shards = shards.map_or_else(|| usual_shards(&campaign), |count| count as usize);
    let sent = sent(&campaign)?;
    let queue = queue(&sent).unwrap_or_default();
    if let Some((_, of, _)) = queue.shards.iter().find(|(_, of, _)| *of != shards) {
        return Err(failed(format!(
            "cannot submit {} in {shards} shards: jobs with {of} shards are in the queue\nhelp: use --shards \
             {of}, or wait until they have ended",
            campaign.spec.name
        )));
    }
    let survey = campaign.survey(Check::Sizes);
    let open = |stage: Stage| {
        let mut open = open_shards(&campaign, &survey, stage, shards);
        // Shards in the queue are not submitted again.
        open.retain(|shard| !queue.shards.contains(&(stage.word().to_owned(), shards, *shard)));
        (stage, open)
    };
    let waiting: Vec<_> = [Stage::Generate, Stage::Extract, Stage::Cycle]
        .map(open)
        .into_iter()
        .filter(|(_, open)| !open.is_empty())
        .collect();
    if waiting.is_empty() && (queue.aggregates || survey.report == Standing::Done) {
        let failures =
            survey.cycles.iter().filter(|(_, standing)| matches!(standing, Standing::Failed(_))).count();
        let text = match (queue.aggregates, failures) {
            (true, _) => "Nothing to submit: all pending tasks are in the queue.\n".to_owned(),
            (false, 0) => "Nothing to submit: everything is done.\n".to_owned(),
            (false, _) => format!(
                "Nothing to submit: all other tasks are done.\n{}",
                failed_cycles(failures, &campaign.dir)
            ),
        };
        say(&if output.json { jobs_json(&campaign, &[], &[]) } else { text })?;
        return Ok(if queue.aggregates || failures == 0 { 0 } else { FAILED_CASES });
    }
    enough_processors(task.0)?;
    short_limit(&campaign, task.1);
    let program = own_file()?;
    let queued = queue.jobs.iter().copied().collect();
    let order =
        Order { program, shards, waiting, most: most(), cpus: task.0, options: task.1.to_vec(), queued };
    if dry { show(&campaign, &order, output.json) } else { send(&campaign, &order, sent, output.json) }
}

/// Refuses more threads than any node has. Without a Slurm that answers, nothing is refused.
fn enough_processors(wanted: u16) -> Result<(), Fault> {
    let nodes = answer("sinfo", &["-h", "-o", "%c"]).unwrap_or_default();
    let most = nodes.lines().filter_map(|line| line.trim().trim_end_matches('+').parse::<u64>().ok()).max();
    // `8+`: some nodes of the group have more.
    let known = most.filter(|_| !nodes.contains('+'));
    match known.filter(|most| *most < u64::from(wanted)) {
        Some(most) => Err(failed(format!(
            "no node has {wanted} processors (--cpus {wanted})\nhelp: use --cpus {most} or less"
        ))),
        None => Ok(()),
    }
}

/// Warns of a time limit within which the longest finished cycle could not be computed.
fn short_limit(campaign: &Campaign, options: &[String]) {
    let Some(limit) = time_limit_s(options) else { return };
    let usable = limit.saturating_sub(lead_s(Some(limit)) + EARLY_S);
    let longest = campaign.longest_cycle_s().unwrap_or(0.0);
    // Time of a small cycle, where none is finished.
    if longest.max(60.0) < usable as f64 {
        return;
    }
    let of_cycles = if longest > 0.0 {
        format!("; the longest finished cycle took {longest:.0} s")
    } else {
        String::new()
    };
    let text = format!(
        "warning: a time limit of {limit} s may leave only {usable} s for computing{of_cycles}\n\
         help: a cycle that does not finish within the limit is not requeued; use a longer --option=--time"
    );
    let _ = writeln!(std::io::stderr().lock(), "{text}");
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
    let names: Vec<String> =
        jobs.iter().enumerate().map(|(place, job)| format!("<{}-{place}>", job.stage.word())).collect();
    let commands: Vec<Vec<String>> =
        jobs.iter().map(|job| job.arguments(&folder, &names, &order.queued)).collect();
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

/// Mark of a script that `submit` wrote.
const SCRIPT_MARK: &str = "`hysteron submit` wrote this file";

/// Writes the scripts and submits the jobs.
fn send(campaign: &Campaign, order: &Order, mut sent: Vec<Sent>, json: bool) -> Result<u8, Fault> {
    let (folder, jobs) = (folder(campaign), jobs(order));
    stages::prepare(campaign).map_err(failed)?;
    let log = folder.join("log");
    make_folder(&log)?;
    for (path, text) in scripts(campaign, order, &jobs) {
        if path.is_file()
            && !std::fs::read_to_string(&path).is_ok_and(|present| present.contains(SCRIPT_MARK))
        {
            let path = path_shown(&path);
            return Err(failed(format!(
                "cannot write the script {path}: `hysteron submit` did not write the file that exists\nhelp: \
                 move it"
            )));
        }
        commit::commit_bytes("write the script", &path, text.as_bytes()).map_err(failed)?;
    }
    let mut numbers: Vec<String> = Vec::new();
    for job in &jobs {
        let number = sbatch(&job.arguments(&folder, &numbers, &order.queued), &numbers, &order.options)?;
        sent.push(Sent {
            job: number,
            stage: job.stage.word().to_owned(),
            first: job.first,
            shards: order.shards,
            tasks: job.tasks.clone(),
            options: order.arguments(),
        });
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
        format!(
            "Logs: {log}\n`hysteron status {dir}` shows the state. The same command submits only missing \
             tasks.\n"
        )
    })?;
    Ok(0)
}

/// The jobs that were sent now.
fn jobs_json(campaign: &Campaign, jobs: &[Job], numbers: &[String]) -> String {
    let jobs: Vec<Value> = jobs
        .iter()
        .zip(numbers)
        .map(|(job, number)| {
            json!({
                "stage": job.stage.word(), "job": number, "task_count": job.tasks.len().max(1),
            })
        })
        .collect();
    format!(
        "{:#}\n",
        json!({ "name": campaign.spec.name, "dir": campaign.dir.display().to_string(), "jobs": jobs })
    )
}

/// Arguments as a shell takes them.
fn shown(arguments: &[String]) -> String {
    arguments.iter().map(|word| shell_quote(word)).collect::<Vec<_>>().join(" ")
}

/// Submits a job, after those with these numbers.
fn sbatch(arguments: &[String], before: &[String], options: &[String]) -> Result<u64, Fault> {
    let kept = match before {
        [] => "no job was submitted".to_owned(),
        jobs => format!("submitted before: {}; `scancel {}` cancels them", jobs.join(", "), jobs.join(" ")),
    };
    let output = Command::new("sbatch").args(arguments).output().map_err(|error| {
        failed(format!(
            "cannot start sbatch: {error}; {kept}\nhelp: use a machine with the commands of \
             Slurm, or --dry-run"
        ))
    })?;
    let said = String::from_utf8_lossy(&output.stdout);
    // `--parsable` says the number, and where there are several clusters a semicolon and which.
    let number = said.trim().split(';').next().and_then(|number| number.parse().ok());
    number.filter(|_| output.status.success()).ok_or_else(|| {
        let reasons = String::from_utf8_lossy(&output.stderr);
        let reason =
            |line: &str| line.trim().trim_start_matches("sbatch: ").trim_start_matches("error: ").to_owned();
        let reason = reasons
            .lines()
            .map(reason)
            .find(|line| !line.is_empty())
            .unwrap_or_else(|| "it returned no job number".to_owned());
        let help = match options {
            [] => format!("`sbatch {}` shows the error again", shown(arguments)),
            options => {
                format!(
                    "check {}",
                    options
                        .iter()
                        .map(|option| shell_quote(&format!("--option={option}")))
                        .collect::<Vec<_>>()
                        .join(" ")
                )
            }
        };
        failed(format!("sbatch refused the job: {reason}; {kept}\nhelp: {help}"))
    })
}

/// Time limit of Slurm's commands.
const PATIENCE: Duration = Duration::from_secs(5);

/// Output of a command, if it succeeds in time. One that does not answer is killed.
fn answer(command: &str, arguments: &[&str]) -> Option<String> {
    let mut child = Command::new(command)
        .args(arguments)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .ok()?;
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

/// Number of array indices that Slurm allows here.
fn most() -> usize {
    let text = answer("scontrol", &["show", "config"]).unwrap_or_default();
    let line = text.lines().find(|line| line.trim_start().starts_with("MaxArraySize"));
    line.and_then(|line| line.split('=').nth(1)?.trim().parse().ok())
        .filter(|most| *most > 0)
        .unwrap_or(USUAL_MOST)
}

/// The jobs that were sent for a campaign.
pub(super) fn sent(campaign: &Campaign) -> Result<Vec<Sent>, Fault> {
    let path = folder(campaign).join("jobs.json");
    let refused = |why: String| {
        let path = path_shown(&path);
        failed(format!(
            "cannot read the submitted jobs from {path}: {why}\nhelp: delete the file when none of its jobs \
             is in the queue"
        ))
    };
    match std::fs::read(&path) {
        Ok(bytes) => serde_json::from_slice(&bytes).map_err(|error| refused(error.to_string())),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(Vec::new()),
        Err(error) => Err(refused(error.to_string())),
    }
}

fn remember(campaign: &Campaign, sent: &[Sent]) -> Result<(), Fault> {
    let text = format!("{:#}\n", json!(sent));
    commit::commit_bytes("write down the jobs in", &folder(campaign).join("jobs.json"), text.as_bytes())
        .map(drop)
        .map_err(failed)
}

/// State of some jobs in the queue; nothing if there is no queue or it does not answer.
pub(super) fn queue(sent: &[Sent]) -> Option<Queue> {
    if sent.is_empty() {
        return Some(Queue::default());
    }
    answer("squeue", &QUERY).map(|text| Queue::parse(&text, sent))
}

/// True if jobs other than the one of this program are in the queue.
pub(super) fn is_queued(sent: &[Sent]) -> bool {
    let own = std::env::var("SLURM_ARRAY_JOB_ID")
        .or_else(|_| std::env::var("SLURM_JOB_ID"))
        .ok()
        .and_then(|job| job.parse::<u64>().ok());
    queue(sent).is_some_and(|queue| queue.jobs.iter().any(|job| Some(*job) != own))
}

/// The command that submits pending tasks of a campaign again, with the options of the last submission.
pub(super) fn again(campaign: &Campaign, sent: &[Sent]) -> String {
    let last = sent.iter().rev().find(|sent| !sent.options.is_empty());
    let options: String = last
        .map(|sent| sent.options.iter().map(|option| format!(" {}", shell_quote(option))).collect())
        .unwrap_or_default();
    format!("hysteron submit {} --engine slurm{options}", shell_path(&campaign.dir))
}

/// Tasks of Slurm that have left the queue with work undone: name, state if Slurm still has it, log.
pub(super) fn ended(campaign: &Campaign, sent: &[Sent], queue: &Queue, survey: &Survey) -> Vec<Ended> {
    let mut found: Vec<Ended> = Vec::new();
    let mut seen = BTreeSet::new();
    let mut enter = |of: &Sent, task: Option<usize>| {
        let name = task.map_or_else(|| of.job.to_string(), |task| format!("{}_{task}", of.job));
        let state = queue.ended.get(&(of.job, task)).cloned();
        found.push(Ended {
            name,
            stage: of.stage.clone(),
            state,
            log: folder(campaign).join("log").join(of.log(task)),
        });
    };
    // The last job of a shard counts.
    for of in sent.iter().rev() {
        let Some(stage) = Stage::ALL.into_iter().find(|stage| stage.word() == of.stage) else { continue };
        if stage > Stage::Cycle {
            let is_open = survey.report != Standing::Done && !queue.aggregates;
            if is_open && seen.insert((of.stage.clone(), 0, 0)) {
                enter(of, None);
            }
            continue;
        }
        let open = open_shards(campaign, survey, stage, of.shards);
        for task in of.tasks.iter().rev() {
            let shard = (of.stage.clone(), of.shards, of.first + task);
            if open.contains(&shard.2) && !queue.shards.contains(&shard) && seen.insert(shard) {
                enter(of, Some(*task));
            }
        }
    }
    found.reverse();
    found
}

/// A task of Slurm that has left the queue with work undone.
pub(super) struct Ended {
    /// Job, or job and task.
    pub(super) name: String,
    /// The stage's word.
    pub(super) stage: String,
    /// State in Slurm's words, if it is still known.
    pub(super) state: Option<String>,
    /// File of its output.
    pub(super) log: PathBuf,
}
