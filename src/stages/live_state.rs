//! State of a run in progress, and estimates of the time left.

use super::Task;
use super::single_cycle::parameters;
use crate::campaign::{Campaign, CaseUnit, Stage};
use crate::physics::LoopPosition;
use crate::report::{LiveLoop, LiveRun, LiveStage};
use crate::stats::load_in_words;
use crate::store::heartbeat::{Heartbeat, RunningTask};
use crate::text::shell_path;
use std::collections::HashMap;
use std::time::{Duration, Instant, SystemTime};

/// Finished fraction from which a time left is estimated.
const ENOUGH: f64 = 0.01;

/// State of a run in progress.
pub(super) struct State {
    /// True if the run has a page. Processes with a part of the surfaces would write one page.
    pub(super) has_page: bool,
    is_named: bool,
    run: LiveRun,
    beat: Heartbeat,
    began: Instant,
    stage_began: Instant,
    /// Work of the present stage that was done before, in tasks: finished tasks and parts up to checkpoints.
    before: f64,
    running: Vec<Running>,
    cycles: Cycles,
}

/// Largest load and parameters of the cycles.
struct Cycles {
    of_cases: Vec<(f64, String)>,
    /// Numbers of the cases by the cycles.
    cases: HashMap<String, usize>,
}

impl Cycles {
    fn of(campaign: &Campaign) -> Self {
        let of_case = |unit: &CaseUnit| {
            let params = &unit.case.params;
            let max_load = params.cycle.largest_load();
            let of_generated = params.surface.generated().map(|surface| surface.length_m);
            let of_scan = match campaign.spec.scan_sides_m.as_slice() {
                [side_m] => Some(*side_m),
                _ => None,
            };
            let (modulus_pa, side_m) = (params.material.contact_modulus_pa, of_generated.or(of_scan));
            let load = load_in_words(max_load, campaign.spec.load_unit(), modulus_pa, side_m);
            (max_load, parameters(params, campaign.label_of(&params.surface).as_deref(), &load))
        };
        Self {
            of_cases: campaign.cases.iter().map(of_case).collect(),
            cases: campaign.cycles.iter().map(|unit| (unit.id.clone(), unit.case)).collect(),
        }
    }

    fn get(&self, id: &str) -> Option<&(f64, String)> {
        self.cases.get(id).and_then(|case| self.of_cases.get(*case))
    }
}

/// A task that is running.
struct Running {
    id: String,
    began: Instant,
    at: Option<LoopPosition>,
    /// Time of the first position, and its finished fraction: that of a checkpoint.
    first: Option<(Instant, f64)>,
}

impl State {
    pub(super) fn of(campaign: &Campaign, task: &Task) -> Self {
        let (now, present) = (Instant::now(), time(SystemTime::now()));
        Self {
            has_page: task.shard.is_whole() && task.from < task.until,
            is_named: false,
            run: LiveRun {
                name: campaign.spec.name.clone(),
                dir: shell_path(&campaign.dir),
                ..LiveRun::default()
            },
            beat: Heartbeat {
                host: gethostname::gethostname().to_string_lossy().into_owned(),
                process_id: std::process::id(),
                began: present.clone(),
                updated: present,
                stages: [task.from, task.until].map(|stage| stage.word().to_owned()),
                shard: task.shard.parts(),
                stage: task.from.word().to_owned(),
                ..Heartbeat::default()
            },
            began: now,
            stage_began: now,
            before: 0.0,
            running: Vec::new(),
            cycles: Cycles::of(campaign),
        }
    }

    /// True once, if there is a page.
    pub(super) fn names_page(&mut self) -> bool {
        self.has_page && !std::mem::replace(&mut self.is_named, true)
    }

    /// The stage, added if it has not begun.
    fn stage(&mut self, stage: Stage) -> Option<&mut LiveStage> {
        if self.run.stages.iter().all(|of| of.name != stage.word()) {
            self.run.stages.push(LiveStage { name: stage.word(), ..LiveStage::default() });
        }
        self.run.stages.iter_mut().find(|of| of.name == stage.word())
    }

    pub(super) fn begin(&mut self, stage: Stage, done: usize, all: usize) {
        (self.stage_began, self.before) = (Instant::now(), done as f64);
        self.beat.stage = stage.word().to_owned();
        if let Some(of) = self.stage(stage) {
            (of.done, of.all, of.work) = (done, all, done as f64);
        }
    }

    pub(super) fn started(&mut self, _: Stage, id: &str) {
        self.running.push(Running { id: id.to_owned(), began: Instant::now(), at: None, first: None });
    }

    pub(super) fn progress(&mut self, stage: Stage, part: f64) {
        if let Some(of) = self.stage(stage) {
            of.work += part;
        }
    }

    pub(super) fn position(&mut self, id: &str, at: &LoopPosition) {
        let Some(running) = self.running.iter_mut().find(|running| running.id == id) else { return };
        running.at = Some(*at);
        if running.first.is_none() {
            running.first = Some((Instant::now(), at.done));
            self.before += at.done;
        }
    }

    pub(super) fn finished(&mut self, stage: Stage, id: &str, drawn: Option<LiveLoop>) {
        self.ended(stage, id);
        self.run.loops.extend(drawn);
        if let Some(of) = self.stage(stage) {
            of.done += 1;
        }
    }

    pub(super) fn ended(&mut self, _: Stage, id: &str) {
        self.running.retain(|running| running.id != id);
    }

    pub(super) fn notice(&mut self, text: &str) {
        self.run.notices.push(text.to_owned());
    }

    /// The present state for other processes.
    pub(super) fn beat(&mut self) -> Heartbeat {
        self.beat.updated = time(SystemTime::now());
        self.beat.elapsed_s = self.began.elapsed().as_secs_f64();
        self.beat.tasks = self.running.iter().map(|running| running.state(&self.cycles)).collect();
        if let Some(of) = self.run.stages.iter().find(|of| of.name == self.beat.stage) {
            (self.beat.done_count, self.beat.task_count) = (of.done, of.all);
            self.beat.fraction = of.fraction();
            self.beat.left_s =
                left_s(self.stage_began.elapsed(), of.work - self.before, of.all as f64 - of.work);
        }
        self.beat.clone()
    }

    /// The state for the page, as in the last heartbeat.
    pub(super) fn run(&mut self) -> &LiveRun {
        self.run.updated.clone_from(&self.beat.updated);
        self.run.left_s = self.beat.left_s;
        self.run.elapsed_s = self.beat.elapsed_s;
        let parameters =
            |task: &RunningTask| self.cycles.get(&task.id).map_or_else(String::new, |(_, text)| text.clone());
        self.run.running = self.beat.tasks.iter().map(|task| (task.clone(), parameters(task))).collect();
        &self.run
    }
}

impl Running {
    fn state(&self, cycles: &Cycles) -> RunningTask {
        let fraction = self.at.map_or(0.0, |at| at.done);
        let left_s =
            self.first.and_then(|(since, from)| left_s(since.elapsed(), fraction - from, 1.0 - fraction));
        RunningTask {
            id: self.id.clone(),
            elapsed_s: self.began.elapsed().as_secs_f64(),
            fraction,
            left_s,
            step_count: self.at.map(|at| at.steps),
            branch: self.at.map(|at| if at.unloading { "unloading" } else { "loading" }.to_owned()),
            load: self.at.map(|at| at.load),
            max_load: cycles.get(&self.id).map(|(max_load, _)| *max_load),
        }
    }
}

/// Time for the rest of some work at the rate so far \[s\]; nothing as long as too little is done.
fn left_s(elapsed: Duration, done: f64, rest: f64) -> Option<f64> {
    (done > ENOUGH).then(|| elapsed.as_secs_f64() * rest.max(0.0) / done)
}

/// A time in seconds: `2026-01-31T12:00:00Z`.
fn time(at: SystemTime) -> String {
    humantime::format_rfc3339_seconds(at).to_string()
}
