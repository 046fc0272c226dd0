//! What is seen while the program works: bars on a terminal, plain lines elsewhere.

use crate::campaign::Stage;
use crate::stages::Watch;
use crate::text::{counted, printable};
use indicatif::{ProgressBar, ProgressStyle};
use std::io::{IsTerminal, Write};
use std::sync::Mutex;

/// Parts of a unit that a bar shows.
const PARTS: f64 = 1000.0;

/// The stage at work: its bar, how much is done in parts, and how many units.
struct Now {
    bar: ProgressBar,
    parts: f64,
    units: usize,
    all: usize,
}

/// Tells the terminal, or whatever reads standard error.
pub(super) struct Teller {
    terminal: bool,
    now: Mutex<Option<Now>>,
}

impl Teller {
    pub(super) fn new() -> Self {
        Self { terminal: std::io::stderr().is_terminal(), now: Mutex::new(None) }
    }

    fn with(&self, act: impl FnOnce(&mut Now)) {
        // A thread that panicked while holding the lock left nothing half done that matters here.
        let mut now = self.now.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if let Some(now) = now.as_mut() {
            act(now);
        }
    }

    /// Takes the bar away: nothing more is done.
    pub(super) fn clear(&self) {
        self.with(|now| now.bar.finish_and_clear());
    }

    fn line(text: &str) {
        // Nobody is left to be told if standard error is closed.
        let _ = writeln!(std::io::stderr().lock(), "{}", printable(text));
    }
}

impl Watch for Teller {
    fn begin(&self, stage: Stage, done: usize, all: usize) {
        let left = all - done;
        let bar = if self.terminal && left > 0 { ProgressBar::new((left as f64 * PARTS) as u64) } else { ProgressBar::hidden() };
        let template = "{prefix:9} [{bar:24}] {msg} {percent:>3} %, {elapsed} gone, {eta} left";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style.progress_chars("=> "));
        }
        bar.set_prefix(stage.word());
        bar.set_message(format!("{done}/{all}"));
        if self.terminal && left > 0 {
            bar.enable_steady_tick(std::time::Duration::from_millis(200));
        }
        if !self.terminal {
            Self::line(&format!("{}: {}, {done} done before", stage.word(), counted(all, "task")));
        }
        *self.now.lock().unwrap_or_else(std::sync::PoisonError::into_inner) = Some(Now { bar, parts: 0.0, units: done, all });
    }

    fn progress(&self, _stage: Stage, part: f64) {
        self.with(|now| {
            now.parts += part * PARTS;
            now.bar.set_position(now.parts as u64);
        });
    }

    fn finished(&self, stage: Stage, id: &str) {
        self.with(|now| {
            now.units += 1;
            let rate = (now.units as f64) / now.bar.elapsed().as_secs_f64().max(1e-3);
            now.bar.set_message(format!("{}/{} ({rate:.2}/s)", now.units, now.all));
            if !self.terminal {
                Self::line(&format!("{}: {}/{} {id}", stage.word(), now.units, now.all));
            }
        });
    }

    fn notice(&self, text: &str) {
        let held = self.now.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        match held.as_ref() {
            Some(now) if self.terminal && !now.bar.is_finished() => now.bar.suspend(|| Self::line(text)),
            _ => Self::line(text),
        }
    }

    fn end(&self, _stage: Stage) {
        self.clear();
    }
}
