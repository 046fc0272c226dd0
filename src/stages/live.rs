//! Page of a run in progress: `progress.html`, rewritten as tasks begin and end, and removed at the end of the run.

use super::{StageError, Watch};
use crate::campaign::owned::is_marked;
use crate::campaign::{Campaign, Stage};
use crate::report::{LiveLoop, LiveRun, LiveStage, live_page};
use crate::schema;
use crate::store::commit;
use crate::store::parquet::read_table;
use crate::text::shown;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant, SystemTime};

/// Name of the page.
const PAGE: &str = "progress.html";
/// Minimum time between two versions of the page.
const PERIOD: Duration = Duration::from_secs(2);
/// Points of a branch, at most.
const MOST_POINTS: usize = 200;

/// Passes progress on and writes the page.
pub(super) struct Live<'a> {
    inner: &'a dyn Watch,
    dir: PathBuf,
    state: Mutex<State>,
}

struct State {
    run: LiveRun,
    written: Option<Instant>,
    /// True if a page that no run wrote is in the place of this one, which is then left alone.
    is_foreign: bool,
    /// True after the path of the page was reported.
    is_named: bool,
}

impl<'a> Live<'a> {
    pub(super) fn of(campaign: &Campaign, inner: &'a dyn Watch) -> Self {
        let run = LiveRun { name: campaign.spec.name.clone(), ..LiveRun::default() };
        let page = campaign.dir.join(PAGE);
        let is_foreign = page.symlink_metadata().is_ok() && !is_marked(&page);
        if is_foreign {
            inner.notice(&format!("{} was not written by a run and is kept; this run has no page of progress", shown(&page)));
        }
        Self { inner, dir: campaign.dir.clone(), state: Mutex::new(State { run, written: None, is_foreign, is_named: false }) }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Changes the state, and writes the page if the last version is old enough or `now` is set.
    fn change(&self, now: bool, change: impl FnOnce(&mut LiveRun)) {
        let mut state = self.state();
        change(&mut state.run);
        if state.is_foreign {
            return;
        }
        if now || state.written.is_none_or(|at| at.elapsed() >= PERIOD) {
            state.written = Some(Instant::now());
            state.run.updated = now_text();
            // The run does not depend on this page: a disk that is full ends it elsewhere.
            let _ = commit::commit_bytes("write the page of progress", &self.dir.join(PAGE), live_page(&state.run).as_bytes());
        }
    }
}

impl Drop for Live<'_> {
    fn drop(&mut self) {
        if !self.state().is_foreign {
            let _ = std::fs::remove_file(self.dir.join(PAGE));
        }
    }
}

/// The stage of a run, added if it has not begun.
fn stage_of(run: &mut LiveRun, stage: Stage) -> Option<&mut LiveStage> {
    if run.stages.iter().all(|of| of.name != stage.word()) {
        run.stages.push(LiveStage { name: stage.word(), ..LiveStage::default() });
    }
    run.stages.iter_mut().find(|of| of.name == stage.word())
}

impl Watch for Live<'_> {
    fn begin(&self, stage: Stage, done: usize, all: usize) {
        // A run with nothing to do has no page to look at.
        let mut state = self.state();
        let is_shown = !state.is_foreign && done < all && !std::mem::replace(&mut state.is_named, true);
        drop(state);
        if is_shown {
            self.inner.page(&self.dir.join(PAGE));
        }
        self.inner.begin(stage, done, all);
        self.change(true, |run| {
            if let Some(of) = stage_of(run, stage) {
                (of.done, of.all, of.work) = (done, all, done as f64);
            }
        });
    }

    fn started(&self, stage: Stage, id: &str) {
        self.inner.started(stage, id);
        self.change(false, |run| {
            if let Some(of) = stage_of(run, stage) {
                of.running.push(id.to_owned());
            }
        });
    }

    fn progress(&self, stage: Stage, part: f64) {
        self.inner.progress(stage, part);
        self.change(false, |run| {
            if let Some(of) = stage_of(run, stage) {
                of.work += part;
            }
        });
    }

    fn finished(&self, stage: Stage, id: &str) {
        self.inner.finished(stage, id);
        let drawn = if stage == Stage::Cycle { loop_of(&self.dir, id).ok() } else { None };
        self.change(false, |run| {
            run.loops.extend(drawn);
            if let Some(of) = stage_of(run, stage) {
                of.done += 1;
                of.running.retain(|running| running != id);
            }
        });
    }

    fn failed(&self, stage: Stage, id: &str) {
        self.inner.failed(stage, id);
        self.change(true, |run| {
            if let Some(of) = stage_of(run, stage) {
                of.running.retain(|running| running != id);
            }
        });
    }

    fn notice(&self, text: &str) {
        self.inner.notice(text);
        self.change(true, |run| run.notices.push(text.to_owned()));
    }

    fn end(&self, stage: Stage) {
        self.inner.end(stage);
    }
}

/// The present time: "2026-01-31 12:00:00 UTC".
fn now_text() -> String {
    humantime::format_rfc3339_seconds(SystemTime::now()).to_string().replace('T', " ").replace('Z', " UTC")
}

/// The loop of a finished cycle up to its largest load.
fn loop_of(dir: &Path, id: &str) -> Result<LiveLoop, StageError> {
    let steps = read_table(&dir.join("cycles").join(id).join("steps.parquet"), &schema::STEPS)?;
    let (branches, of) = (steps.text("branch")?, steps.f64_or_null("max_load")?);
    let (penetration, load) = (steps.f64("penetration")?, steps.f64("load")?);
    let largest = of.iter().flatten().copied().reduce(f64::max);
    let path = |branch: &str, max_load: Option<f64>| -> Vec<(f64, f64)> {
        let rows: Vec<usize> = (0..load.len()).filter(|row| branches[*row] == branch && of[*row] == max_load).collect();
        let every = rows.len().div_ceil(MOST_POINTS).max(1);
        rows.into_iter().step_by(every).map(|row| (penetration[row], load[row])).collect()
    };
    Ok(LiveLoop { id: id.to_owned(), paths: vec![path("loading", None), path("unloading", largest)] })
}
