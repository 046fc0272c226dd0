//! State of a run in progress: a heartbeat for other processes, and the page `progress.html`, both rewritten
//! again and again and removed at the end.

use super::live_state::State;
use super::{StageError, Task, Watch};
use crate::campaign::owned::is_marked;
use crate::campaign::{Campaign, Stage};
use crate::physics::LoopPosition;
use crate::report::{LiveLoop, live_page};
use crate::schema;
use crate::store::commit;
use crate::store::heartbeat::Pulse;
use crate::store::parquet::read_table;
use crate::text::shown;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

/// Name of the page.
const PAGE: &str = "progress.html";
/// Time between two heartbeats, and number of heartbeats between two versions of the page.
const PERIOD: Duration = Duration::from_millis(500);
const BEATS_OF_PAGE: u32 = 4;
/// Points of a branch, at most.
const MOST_POINTS: usize = 200;

/// Passes progress on and writes the state.
pub(super) struct Live<'a> {
    inner: &'a dyn Watch,
    shared: Arc<Shared>,
    /// Thread that writes the state also while nothing is reported.
    writer: Option<JoinHandle<()>>,
}

/// State shared by the threads.
struct Shared {
    dir: PathBuf,
    state: Mutex<State>,
    pulse: Mutex<Option<Pulse>>,
    /// True when the run has ended.
    over: Mutex<bool>,
    ended: Condvar,
}

impl<'a> Live<'a> {
    pub(super) fn of(campaign: &Campaign, task: &Task, inner: &'a dyn Watch) -> Self {
        let pulse = Pulse::begin(&campaign.dir, |path| inner.temporary(path));
        let page = campaign.dir.join(PAGE);
        let mut state = State::of(campaign, task);
        // A power cut may leave an empty page.
        let is_foreign = page.symlink_metadata().is_ok_and(|found| found.len() > 0) && !is_marked(&page);
        if state.has_page && is_foreign {
            state.has_page = false;
            inner.notice(&format!(
                "{} was not written by a run and is kept; this run has no page of progress",
                shown(&page)
            ));
        }
        // Before it is written, so that an interrupt removes it at any time.
        if state.has_page {
            inner.temporary(&page);
        }
        let shared = Arc::new(Shared {
            dir: campaign.dir.clone(),
            state: Mutex::new(state),
            pulse: Mutex::new(pulse),
            over: Mutex::new(false),
            ended: Condvar::new(),
        });
        shared.write(true);
        let of_thread = Arc::clone(&shared);
        // Without the thread, states are written when progress is reported.
        let writer = std::thread::Builder::new()
            .name("heartbeat".to_owned())
            .spawn(move || of_thread.write_until_the_end())
            .ok();
        Self { inner, shared, writer }
    }

    /// Changes the state, and writes it with `now`.
    fn change(&self, now: bool, change: impl FnOnce(&mut State)) {
        change(&mut locked(&self.shared.state));
        if now || self.writer.is_none() {
            self.shared.write(true);
        }
    }
}

/// A lock; a thread that panicked while holding it left nothing half done.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Shared {
    /// Writes the heartbeat, and the page if it is due. The run does not depend on them: a disk that is full
    /// ends it elsewhere.
    fn write(&self, page_is_due: bool) {
        let (beat, page) = {
            let mut state = locked(&self.state);
            (state.beat(), (state.has_page && page_is_due).then(|| live_page(state.run())))
        };
        if let Some(pulse) = locked(&self.pulse).as_mut() {
            pulse.beat(&beat);
        }
        if let Some(page) = page {
            let _ = commit::commit_bytes("write the page of progress", &self.dir.join(PAGE), page.as_bytes());
        }
    }

    fn write_until_the_end(&self) {
        let (mut over, mut beats) = (locked(&self.over), 0_u32);
        while !*over {
            let (next, waited) =
                self.ended.wait_timeout(over, PERIOD).unwrap_or_else(PoisonError::into_inner);
            over = next;
            if waited.timed_out() && !*over {
                beats = beats.wrapping_add(1);
                self.write(beats.is_multiple_of(BEATS_OF_PAGE));
            }
        }
    }
}

impl Drop for Live<'_> {
    fn drop(&mut self) {
        *locked(&self.shared.over) = true;
        self.shared.ended.notify_all();
        if let Some(writer) = self.writer.take() {
            let _ = writer.join();
        }
        *locked(&self.shared.pulse) = None;
        if locked(&self.shared.state).has_page {
            let _ = std::fs::remove_file(self.shared.dir.join(PAGE));
        }
    }
}

impl Watch for Live<'_> {
    fn begin(&self, stage: Stage, done: usize, all: usize) {
        // A run with nothing to do has no page to look at.
        let is_named = done < all && locked(&self.shared.state).names_page();
        if is_named {
            self.inner.page(&self.shared.dir.join(PAGE));
        }
        self.inner.begin(stage, done, all);
        self.change(true, |state| state.begin(stage, done, all));
    }

    fn started(&self, stage: Stage, id: &str) {
        self.inner.started(stage, id);
        self.change(false, |state| state.started(stage, id));
    }

    fn progress(&self, stage: Stage, part: f64) {
        self.inner.progress(stage, part);
        self.change(false, |state| state.progress(stage, part));
    }

    fn position(&self, id: &str, at: &LoopPosition) {
        self.inner.position(id, at);
        self.change(false, |state| state.position(id, at));
    }

    fn finished(&self, stage: Stage, id: &str) {
        self.inner.finished(stage, id);
        let drawn = if stage == Stage::Cycle { loop_of(&self.shared.dir, id).ok() } else { None };
        self.change(false, |state| state.finished(stage, id, drawn));
    }

    fn failed(&self, stage: Stage, id: &str) {
        self.inner.failed(stage, id);
        self.change(true, |state| state.ended(stage, id));
    }

    fn notice(&self, text: &str) {
        self.inner.notice(text);
        self.change(true, |state| state.notice(text));
    }

    fn end(&self, stage: Stage) {
        self.inner.end(stage);
    }
}

/// The loop of a finished cycle up to its largest load.
fn loop_of(dir: &Path, id: &str) -> Result<LiveLoop, StageError> {
    let steps = read_table(&dir.join("cycles").join(id).join("steps.parquet"), &schema::STEPS)?;
    let (branches, of) = (steps.text("branch")?, steps.f64_or_null("max_load")?);
    let (penetration, load) = (steps.f64("penetration")?, steps.f64("load")?);
    let largest = of.iter().flatten().copied().reduce(f64::max);
    let path = |branch: &str, max_load: Option<f64>| -> Vec<(f64, f64)> {
        let rows: Vec<usize> =
            (0..load.len()).filter(|row| branches[*row] == branch && of[*row] == max_load).collect();
        let every = rows.len().div_ceil(MOST_POINTS).max(1);
        rows.into_iter().step_by(every).map(|row| (penetration[row], load[row])).collect()
    };
    Ok(LiveLoop { id: id.to_owned(), paths: vec![path("loading", None), path("unloading", largest)] })
}
