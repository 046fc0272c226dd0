//! Progress: bars on a terminal, plain lines elsewhere.

use super::arguments::TalkArguments;
use super::colour::painted;
use crate::campaign::Stage;
use crate::stages::Watch;
use crate::store::heartbeat;
use crate::text::{counted, in_words, printable, shown};
use indicatif::{ProgressBar, ProgressState, ProgressStyle};
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Parts of a task that a bar shows.
const PARTS: f64 = 1000.0;

/// Time between two progress lines where there is no bar, unless [`PERIOD`] sets it.
const EVERY: Duration = Duration::from_secs(30);

/// Environment variable: seconds between two progress lines.
const PERIOD: &str = "HYSTERON_PROGRESS_SECONDS";

/// The stage that is running: its bar, the parts that are done, the parts to do, and the finished tasks of
/// all.
struct Now {
    bar: ProgressBar,
    parts: f64,
    left: usize,
    units: usize,
    all: usize,
    /// Time of the last line.
    line_at: Instant,
}

/// Writes progress and notices to standard error.
pub(super) struct Teller {
    terminal: bool,
    talk: TalkArguments,
    every: Duration,
    began: Instant,
    now: Mutex<Option<Now>>,
    /// Files that are removed at the end.
    temporary: Mutex<Vec<PathBuf>>,
    /// Cycles that are running.
    running: Mutex<Vec<String>>,
}

impl Teller {
    pub(super) fn new(talk: TalkArguments) -> Self {
        let seconds = std::env::var(PERIOD)
            .ok()
            .and_then(|text| text.trim().parse().ok())
            .filter(|seconds: &f64| *seconds >= 0.0);
        let every = seconds.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok()).unwrap_or(EVERY);
        Self {
            terminal: std::io::stderr().is_terminal(),
            talk,
            every,
            began: Instant::now(),
            now: Mutex::new(None),
            temporary: Mutex::new(Vec::new()),
            running: Mutex::new(Vec::new()),
        }
    }

    /// Time since the command began.
    pub(super) fn elapsed(&self) -> Duration {
        self.began.elapsed()
    }

    fn with(&self, act: impl FnOnce(&mut Now)) {
        let mut now = locked(&self.now);
        if let Some(now) = now.as_mut() {
            act(now);
        }
    }

    /// Removes the bar.
    pub(super) fn clear(&self) {
        self.with(|now| now.bar.finish_and_clear());
    }

    /// Removes the page of progress and the heartbeat, where the run ends without its destructors.
    pub(super) fn remove_temporary(&self) {
        locked(&self.temporary).iter().for_each(|path| heartbeat::remove(path));
    }

    /// Numbers of running cycles with and without a checkpoint in an output folder.
    pub(super) fn checkpointed(&self, dir: &Path) -> [usize; 2] {
        let running = locked(&self.running);
        let with =
            running.iter().filter(|id| dir.join("cycles").join(id).join("halfway.bin").is_file()).count();
        [with, running.len() - with]
    }

    /// True if there are lines for tasks and progress: always with --verbose; otherwise where there is no
    /// bar, unless --quiet.
    fn has_lines(&self) -> bool {
        self.talk.verbose || !self.terminal && !self.talk.quiet
    }

    fn line(&self, text: &str) {
        // A closed standard error has no reader.
        let _ = writeln!(std::io::stderr().lock(), "{}", painted(printable(text), self.terminal));
    }

    /// A line above the bar.
    fn above(&self, now: &mut Now, text: &str) {
        now.line_at = Instant::now();
        let text = if self.talk.verbose {
            format!("{text} ({})", duration(self.elapsed()))
        } else {
            text.to_owned()
        };
        now.bar.suspend(|| self.line(&text));
    }
}

/// A lock; a thread that panicked while holding it left nothing half done that matters here.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A duration as a person writes it.
pub(super) fn duration(time: Duration) -> String {
    in_words(time.as_secs_f64())
}

/// The time left, which is unknown before the first progress.
fn remaining(state: &ProgressState, out: &mut dyn std::fmt::Write) {
    let text = if state.pos() == 0 { "?".to_owned() } else { duration(state.eta()) };
    let _ = out.write_str(&text);
}

/// The style of a bar.
fn style() -> Option<ProgressStyle> {
    let style = ProgressStyle::with_template(
        "{prefix:9} [{bar:24}] {msg} {percent:>3} %, {elapsed}, {remaining} left",
    )
    .ok()?;
    Some(style.with_key("remaining", remaining).progress_chars("=> "))
}

impl Watch for Teller {
    fn begin(&self, stage: Stage, done: usize, all: usize) {
        let left = all - done;
        let has_bar = self.terminal && !self.talk.quiet && left > 0;
        let bar =
            if has_bar { ProgressBar::new((left as f64 * PARTS) as u64) } else { ProgressBar::hidden() };
        if let Some(style) = style() {
            bar.set_style(style);
        }
        bar.set_prefix(stage.word());
        bar.set_message(format!("{done}/{all}"));
        if has_bar {
            bar.enable_steady_tick(Duration::from_millis(200));
        }
        let mut now = Now { bar, parts: 0.0, left, units: done, all, line_at: Instant::now() };
        if self.has_lines() {
            self.above(&mut now, &format!("{}: {}, {done} done before", stage.word(), counted(all, "task")));
        }
        *locked(&self.now) = Some(now);
    }

    fn progress(&self, stage: Stage, part: f64) {
        self.with(|now| {
            now.parts += part * PARTS;
            now.bar.set_position(now.parts as u64);
            if !self.terminal && !self.talk.quiet && now.line_at.elapsed() >= self.every {
                let share = 100.0 * now.parts / (now.left.max(1) as f64 * PARTS);
                let time = duration(self.elapsed());
                now.line_at = Instant::now();
                self.line(&format!(
                    "{}: {}/{}, {share:.0} % of the pending tasks after {time}",
                    stage.word(),
                    now.units,
                    now.all
                ));
            }
        });
    }

    fn finished(&self, stage: Stage, id: &str) {
        locked(&self.running).retain(|running| running != id);
        self.with(|now| {
            now.units += 1;
            let rate = (now.units as f64) / now.bar.elapsed().as_secs_f64().max(1e-3);
            now.bar.set_message(format!("{}/{} ({rate:.2}/s)", now.units, now.all));
            if self.has_lines() {
                let text = format!("{}: {}/{} {id}", stage.word(), now.units, now.all);
                self.above(now, &text);
            }
        });
    }

    fn notice(&self, text: &str) {
        let held = locked(&self.now);
        match held.as_ref() {
            Some(now) if self.terminal && !now.bar.is_finished() => now.bar.suspend(|| self.line(text)),
            _ => self.line(text),
        }
    }

    fn page(&self, path: &Path) {
        if !self.talk.quiet {
            self.notice(&format!("progress page: {}", shown(path)));
        }
    }

    fn temporary(&self, path: &Path) {
        locked(&self.temporary).push(path.to_owned());
    }

    fn started(&self, stage: Stage, id: &str) {
        if stage == Stage::Cycle {
            locked(&self.running).push(id.to_owned());
        }
    }

    fn failed(&self, _stage: Stage, id: &str) {
        locked(&self.running).retain(|running| running != id);
    }

    fn end(&self, _stage: Stage) {
        self.clear();
    }
}
