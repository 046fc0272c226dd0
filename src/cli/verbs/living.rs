//! `status` of processes that compute in an output folder, from their heartbeats.

use crate::campaign::{Campaign, Shard, Stage, Standing};
use crate::stats::significant;
use crate::store::heartbeat::{Heartbeat, RunningTask, processes};
use crate::text::{counted, in_words, visible, wrapped};
use std::collections::{HashMap, HashSet};
use std::time::SystemTime;

/// Tasks of a process that are listed.
const LISTED: usize = 10;

/// Age of a heartbeat from which it is stated \[s\].
const OLD_S: f64 = 30.0;

/// Processes that compute in the folder of a campaign, and killed processes.
pub(super) struct Living {
    pub(super) alive: Vec<Heartbeat>,
    killed: Vec<Heartbeat>,
}

impl Living {
    pub(super) fn of(campaign: &Campaign) -> Self {
        let [alive, killed] = processes(&campaign.dir);
        Self { alive, killed }
    }

    /// Marks tasks in computation, tasks assigned to a live process, and tasks of killed processes.
    pub(super) fn mark(&self, campaign: &Campaign, units: &mut Units) {
        let running: HashSet<&str> =
            self.alive.iter().flat_map(|beat| &beat.tasks).map(|task| task.id.as_str()).collect();
        let surfaces = campaign.surfaces.iter().enumerate().map(|(place, unit)| (unit.id.as_str(), place));
        let cycles = campaign.cycles.iter().map(|unit| (unit.id.as_str(), unit.surface));
        let places: HashMap<&str, usize> = surfaces.chain(cycles).collect();
        for beat in &self.alive {
            let Some((from, until, shard)) = work(beat) else { continue };
            for (stage, units) in units.iter_mut().filter(|(stage, _)| (from..=until).contains(stage)) {
                let of_stage =
                    *stage == Stage::ALL.into_iter().find(|stage| stage.word() == beat.stage).unwrap_or(from);
                let holds = |id: &str| places.get(id).map_or(shard.is_whole(), |place| shard.holds(*place));
                let open = |standing: &Standing| !standing.is_settled() && *standing != Standing::Running;
                for (id, standing) in units.iter_mut().filter(|(id, standing)| open(standing) && holds(id)) {
                    let runs = of_stage && (running.contains(id.as_str()) || *stage > Stage::Cycle);
                    *standing = if runs { Standing::Running } else { Standing::Waiting };
                }
            }
        }
        for beat in &self.killed {
            for (_, units) in units.iter_mut().filter(|(stage, _)| stage.word() == beat.stage) {
                let was_running = |id: &str| beat.tasks.iter().any(|task| task.id == id);
                for (_, standing) in units
                    .iter_mut()
                    .filter(|(id, standing)| *standing == Standing::Planned && was_running(id))
                {
                    *standing = Standing::Interrupted;
                }
            }
        }
    }

    /// Lines on the running tasks of a stage.
    pub(super) fn tasks(&self, stage: Stage) -> String {
        let of_stage = self.alive.iter().filter(|beat| beat.stage == stage.word());
        let tasks: Vec<&RunningTask> = of_stage.flat_map(|beat| &beat.tasks).collect();
        let mut text: String =
            tasks.iter().take(LISTED).map(|task| wrapped(&task_text(task), "    ")).collect();
        if tasks.len() > LISTED {
            text += &format!("  … and {} more\n", tasks.len() - LISTED);
        }
        text
    }

    /// A line for each process.
    pub(super) fn lines(&self) -> String {
        let killed = |beat: &Heartbeat| {
            format!(
                "killed    process {} on {}, last update {}",
                beat.process_id,
                visible(&beat.host),
                visible(&beat.updated)
            )
        };
        let texts = self.alive.iter().map(process_text).chain(self.killed.iter().map(killed));
        texts.map(|text| wrapped(&text, "          ")).collect()
    }

    /// The number of pending tasks, if processes compute some of them; `resume` is the command for the
    /// others.
    pub(super) fn pending(&self, units: &Units, resume: &str) -> Option<String> {
        let count = |state: &Standing| {
            units.iter().flat_map(|(_, units)| units).filter(|(_, standing)| standing == state).count()
        };
        let (open, running, waiting) = (left(units), count(&Standing::Running), count(&Standing::Waiting));
        let pending = counted(open, "task");
        match open - running - waiting {
            _ if self.alive.is_empty() => None,
            0 => Some(format!("{pending} pending: {running} running, {waiting} waiting.\n")),
            others => Some(format!(
                "{pending} pending: {running} running, {waiting} waiting; resume the other {others} with \
                 `{resume}`.\n"
            )),
        }
    }
}

/// Stages and part of the surfaces of a process.
fn work(beat: &Heartbeat) -> Option<(Stage, Stage, Shard)> {
    let stage = |word: &String| Stage::ALL.into_iter().find(|stage| stage.word() == word);
    let [from, until] = &beat.stages;
    Some((stage(from)?, stage(until)?, Shard::of(beat.shard)?))
}

/// State of a task as text.
fn task_text(task: &RunningTask) -> String {
    let number = |value: f64| significant(value, 3);
    let mut parts = Vec::new();
    match (&task.branch, task.step_count) {
        (Some(branch), Some(steps)) => parts.extend([visible(branch), counted(steps, "step")]),
        _ if task.max_load.is_some() => parts.push("before the first step".to_owned()),
        _ => {}
    }
    let most = task.max_load.map_or_else(String::new, |most| format!(" (maximum {})", number(most)));
    parts.extend(task.load.map(|load| format!("F/(E*A₀) = {}{most}", number(load))));
    parts.extend(task.load.map(|_| percent(task.fraction)));
    parts.push(in_words(task.elapsed_s));
    parts.extend(task.left_s.map(|left| format!("about {} left", in_words(left))));
    format!("  {} running: {}", visible(&task.id), parts.join(", "))
}

/// State of a process as text.
fn process_text(beat: &Heartbeat) -> String {
    let [index, count] = beat.shard;
    let shard = if count > 1 { format!(" (shard {index}/{count})") } else { String::new() };
    let mut parts = vec![
        format!(
            "{}{shard}: {} of {} done",
            visible(&beat.stage),
            beat.done_count,
            counted(beat.task_count, "task")
        ),
        percent(beat.fraction),
        in_words(beat.elapsed_s),
    ];
    parts.extend(beat.left_s.map(|left| format!("about {} left", in_words(left))));
    let age =
        humantime::parse_rfc3339(&beat.updated).ok().and_then(|at| SystemTime::now().duration_since(at).ok());
    let silent = age.map(|age| age.as_secs_f64()).filter(|age| *age > OLD_S);
    parts.extend(silent.map(|age| format!("no update for {}", in_words(age))));
    format!("running   {} (process {} on {})", parts.join(", "), beat.process_id, visible(&beat.host))
}

fn percent(fraction: f64) -> String {
    format!("{:.0} %", 100.0 * fraction)
}

/// The state of every task of a campaign, by stage.
pub(super) type Units = Vec<(Stage, Vec<(String, Standing)>)>;

/// The number of pending tasks.
pub(super) fn left(units: &Units) -> usize {
    units.iter().flat_map(|(_, units)| units).filter(|(_, standing)| !standing.is_settled()).count()
}
