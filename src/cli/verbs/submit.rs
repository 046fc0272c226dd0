//! `submit`: what is not done yet goes to Slurm; and what `status` says of its queue.

use super::{Fault, failed, open, say};
use crate::campaign::{Campaign, Stage};
use crate::cli::OutputArguments;
use crate::engines::slurm::{Order, Queue, Sent, folder, jobs, script};
use crate::engines::{open_shards, usual_shards};
use crate::stages;
use crate::store::{Check, commit};
use serde_json::json;
use std::path::Path;
use std::process::Command;

/// What Slurm lets array indices go up to where it does not say.
const USUAL_MOST: usize = 1001;

pub(super) fn slurm(spec: &Path, output: &OutputArguments, shards: Option<u32>, task: (u16, &[String]), dry: bool) -> Result<u8, Fault> {
    let mut campaign = open(spec, output)?;
    campaign.dir =
        std::path::absolute(&campaign.dir).map_err(|error| failed(format!("cannot find {}: {error}", campaign.dir.display())))?;
    let shards = shards.map_or_else(|| usual_shards(&campaign), |count| count as usize);
    let sent = sent(&campaign);
    let queue = queue(&sent).unwrap_or_default();
    let survey = campaign.survey(Check::Sizes);
    let waiting = [Stage::Generate, Stage::Extract, Stage::Cycle]
        .map(|stage| {
            let mut open = open_shards(&campaign, &survey, stage, shards);
            // What is in the queue is on its way.
            open.retain(|shard| !queue.shards.contains(&(stage.word().to_owned(), shards, *shard)));
            (stage, open)
        })
        .into_iter()
        .filter(|(_, open)| !open.is_empty())
        .collect::<Vec<_>>();
    let other = queue.shards.iter().find(|(_, of, _)| *of != shards);
    if let Some((_, of, _)) = other {
        return Err(failed(format!(
            "cannot submit {} in {shards} shards: jobs with {of} shards are in the queue; allowed: --shards {of}, or after they have ended",
            campaign.spec.name
        )));
    }
    let tables_done = survey.report == crate::campaign::Standing::Done;
    if waiting.is_empty() && (tables_done || queue.aggregates) {
        say(if queue.aggregates {
            "Nothing to submit: all that is missing is in the queue.\n"
        } else {
            "Nothing to submit: everything is done.\n"
        });
        return Ok(0);
    }
    let program = std::env::current_exe().map_err(|error| failed(format!("cannot find the program's own file: {error}")))?;
    let order = Order { program, shards, waiting, most: most(), cpus: task.0, options: task.1.to_vec() };
    let (folder, jobs) = (folder(&campaign), jobs(&order));
    let mut stages: Vec<Stage> = jobs.iter().map(|job| job.stage).collect();
    stages.sort_unstable();
    stages.dedup();
    if dry {
        for stage in stages {
            say(&format!("# {}\n{}\n", folder.join(format!("{}.sbatch", stage.word())).display(), script(&campaign, stage, &order)));
        }
        let names: Vec<String> = jobs.iter().enumerate().map(|(place, job)| format!("<{}-{place}>", job.stage.word())).collect();
        for (job, name) in jobs.iter().zip(&names) {
            say(&format!("{name} = sbatch {}\n", job.arguments(&folder, &names).join(" ")));
        }
        return Ok(0);
    }
    stages::prepare(&campaign).map_err(failed)?;
    let log = folder.join("log");
    std::fs::create_dir_all(&log).map_err(|error| failed(format!("cannot make the folder {}: {error}", log.display())))?;
    for stage in stages {
        let path = folder.join(format!("{}.sbatch", stage.word()));
        commit::commit_bytes("write the script", &path, script(&campaign, stage, &order).as_bytes()).map_err(failed)?;
    }
    let mut all = sent;
    let mut numbers: Vec<String> = Vec::new();
    for job in &jobs {
        let number = sbatch(&job.arguments(&folder, &numbers))?;
        all.push(Sent { job: number, stage: job.stage.word().to_owned(), first: job.first, shards });
        // After each, so that none that was sent is forgotten.
        remember(&campaign, &all)?;
        if !output.json {
            let tasks = if job.tasks.is_empty() { "one task".to_owned() } else { format!("{} tasks", job.tasks.len()) };
            say(&format!("{:9} job {number}, {tasks}\n", job.stage.word()));
        }
        numbers.push(number.to_string());
    }
    if output.json {
        let jobs: Vec<_> = jobs
            .iter()
            .zip(&numbers)
            .map(|(job, number)| json!({ "stage": job.stage.word(), "job": number, "task_count": job.tasks.len().max(1) }))
            .collect();
        say(&format!("{:#}\n", json!({ "name": campaign.spec.name, "dir": campaign.dir.display().to_string(), "jobs": jobs })));
    } else {
        let dir = campaign.dir.display();
        say(&format!(
            "Logs: {}\n`hysteron status {dir}` tells how far it is; the same command again sends only what is missing.\n",
            log.display()
        ));
    }
    Ok(0)
}

fn sbatch(arguments: &[String]) -> Result<u64, Fault> {
    let refused = |why: String| {
        failed(format!(
            "cannot submit with `sbatch {}`: {why}; what was submitted before stays, and is known to the next `hysteron submit`",
            arguments.join(" ")
        ))
    };
    let output = Command::new("sbatch")
        .args(arguments)
        .output()
        .map_err(|error| refused(format!("{error}; allowed: a machine with Slurm's commands, or --dry-run")))?;
    let said = String::from_utf8_lossy(&output.stdout);
    // `--parsable` says the number, and where there are several clusters a semicolon and which.
    let number = said.trim().split(';').next().and_then(|number| number.parse().ok());
    number.filter(|_| output.status.success()).ok_or_else(|| refused(String::from_utf8_lossy(&output.stderr).trim().to_owned()))
}

/// How far array indices may go here.
fn most() -> usize {
    let output = Command::new("scontrol").args(["show", "config"]).output().ok().filter(|output| output.status.success());
    let text = output.map(|output| String::from_utf8_lossy(&output.stdout).into_owned()).unwrap_or_default();
    let line = text.lines().find(|line| line.trim_start().starts_with("MaxArraySize"));
    line.and_then(|line| line.split('=').nth(1)?.trim().parse().ok()).filter(|most| *most > 0).unwrap_or(USUAL_MOST)
}

/// The jobs that were sent for a campaign; none where that is not known.
pub(super) fn sent(campaign: &Campaign) -> Vec<Sent> {
    std::fs::read(folder(campaign).join("jobs.json")).ok().and_then(|bytes| serde_json::from_slice(&bytes).ok()).unwrap_or_default()
}

fn remember(campaign: &Campaign, sent: &[Sent]) -> Result<(), Fault> {
    let text = format!("{:#}\n", json!(sent));
    commit::commit_bytes("write down the jobs in", &folder(campaign).join("jobs.json"), text.as_bytes()).map(drop).map_err(failed)
}

/// What the queue has of some jobs; nothing where there is none to ask.
pub(super) fn queue(sent: &[Sent]) -> Option<Queue> {
    if sent.is_empty() {
        return Some(Queue::default());
    }
    let output = Command::new("squeue").args(["--me", "-h", "-r", "-o", "%F %K %T"]).output().ok()?;
    output.status.success().then(|| Queue::parse(&String::from_utf8_lossy(&output.stdout), sent))
}
