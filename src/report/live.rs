//! Page of a run in progress, which reloads itself.

use super::layout::{plain, styled};
use crate::stats::significant;
use crate::store::heartbeat::RunningTask;
use crate::text::{counted, in_words};
use maud::{Markup, PreEscaped, html};

/// Seconds between two loads of the page.
const RELOAD_SECONDS: u32 = 5;
/// Loops that the page shows, at most: the last ones.
const MOST_LOOPS: usize = 24;
/// Width and height of a loop \[pixels\].
const SIZE: (f64, f64) = (180.0, 130.0);

/// Time without an update after which the process has ended \[s\].
const SILENT_SECONDS: u32 = 30;

/// A stage of a run in progress.
#[derive(Debug, Clone, Default)]
pub struct LiveStage {
    /// Name of the stage.
    pub name: &'static str,
    /// Number of finished tasks.
    pub done: usize,
    /// Number of tasks.
    pub all: usize,
    /// Work that is done, in tasks; parts of running tasks count.
    pub work: f64,
}

impl LiveStage {
    /// Finished fraction of the work.
    #[must_use]
    pub fn fraction(&self) -> f64 {
        if self.all == 0 { 1.0 } else { (self.work / self.all as f64).clamp(0.0, 1.0) }
    }
}

/// The loop of a finished cycle.
#[derive(Debug, Clone)]
pub struct LiveLoop {
    /// Identifier of the cycle.
    pub id: String,
    /// Paths of Δ/h_rms and F/(E* A0), one for each branch.
    pub paths: Vec<Vec<(f64, f64)>>,
}

/// A run in progress.
#[derive(Debug, Clone, Default)]
pub struct LiveRun {
    /// Name of the run.
    pub name: String,
    /// Output folder as a word of a shell.
    pub dir: String,
    /// Time of this version of the page, as in `2026-01-31T12:00:00Z`.
    pub updated: String,
    /// Time since the start \[s\].
    pub elapsed_s: f64,
    /// Estimated time to the end of the stage \[s\].
    pub left_s: Option<f64>,
    /// Stages that have begun.
    pub stages: Vec<LiveStage>,
    /// Running tasks, each with its parameters.
    pub running: Vec<(RunningTask, String)>,
    /// Warnings and failures.
    pub notices: Vec<String>,
    /// Loops of the finished cycles, in the order in which they ended.
    pub loops: Vec<LiveLoop>,
}

/// The page as HTML. Its script compares the time of the last update with the clock, and the text without the
/// script states the same rule.
#[must_use]
pub fn live_page(run: &LiveRun) -> String {
    let shown = run.updated.replace('T', " ").replace('Z', " UTC");
    let body = html! {
        h1 { (run.name) ": " span #state { "state at " (shown) } } "\n"
        div #ended .banner.red hidden role="alert" {
            p { b { "Interrupted." } " The process that computed this run has ended without finishing; the \
                 state below is its last one. Resume with " code { "hysteron run " (run.dir) } "." }
        }
        "\n"
        p {
            "A running process rewrites this page every 2 s, and the page reloads itself every "
            (RELOAD_SECONDS) " s. "
            "Without an update for " (SILENT_SECONDS) " s, the process has ended: "
            code { "hysteron status " (run.dir) } " shows the state. "
            "At the end of the run, " a href="report.html" { "report.html" } " has the results. Last update: "
            time #updated datetime=(run.updated) { (shown) } ", " (in_words(run.elapsed_s)) " after the start"
            @if let Some(left) = run.left_s { ", about " (in_words(left)) " before the end of the stage" }
            "."
        }
        "\n"
        div.scroll role="region" aria-label="Table of stages" tabindex="0" { table {
            tr { th { "stage" } th { "finished" } th { "work" } }
            @for stage in &run.stages {
                tr {
                    td { (stage.name) } td { (stage.done) " of " (counted(stage.all, "task")) }
                    td { (percent(stage.fraction())) }
                }
            }
        } }
        "\n"
        @if !run.running.is_empty() { (tasks(&run.running)) }
        @if !run.notices.is_empty() {
            h2 { "Failures and notices" } "\n"
            ul { @for notice in &run.notices { li { pre.text { (notice) } } } } "\n"
        }
        @if !run.loops.is_empty() {
            h2 { "Finished cycles" } "\n"
            p { (plain("Normal force F/(E*A₀) against mean penetration Δ/h_rms; loading dashed, unloading \
                 solid.")) } "\n"
            ul.loops { @for of in run.loops.iter().rev().take(MOST_LOOPS) { li { (drawn(of)) } } } "\n"
        }
        script {
            (PreEscaped(format!("const SILENT_MS = {SILENT_SECONDS}e3;\n{}", include_str!("live.js"))))
        } "\n"
    };
    styled(&format!("{}: state of the run", run.name), Some(RELOAD_SECONDS), &body)
}

/// A table of the running tasks.
fn tasks(running: &[(RunningTask, String)]) -> Markup {
    let number = |value: f64| significant(value, 3).replace('-', "−");
    html! {
        h2 { "Running tasks" } "\n"
        div.scroll role="region" aria-label="Table of running tasks" tabindex="0" { table {
            tr {
                th { "task" } th { "branch" } th { "steps" } th { (plain("F/(E*A₀) (maximum)")) }
                th { "work" } th { "time" } th { "time left" }
            }
            @for (task, parameters) in running {
                tr {
                    td { (task.id) @if !parameters.is_empty() { small { (plain(parameters)) } } }
                    td { (task.branch.as_deref().unwrap_or("–")) }
                    td { @if let Some(steps) = task.step_count { (steps) } @else { "–" } }
                    td {
                        @if let Some(load) = task.load { (number(load)) } @else { "–" }
                        @if let Some(most) = task.max_load { " (" (number(most)) ")" }
                    }
                    td { (percent(task.fraction)) }
                    td { (in_words(task.elapsed_s)) }
                    td { @if let Some(left) = task.left_s { (in_words(left)) } @else { "–" } }
                }
            }
        } }
        "\n"
    }
}

/// A fraction as a percentage.
fn percent(fraction: f64) -> String {
    format!("{:.0}\u{a0}%", 100.0 * fraction.clamp(0.0, 1.0))
}

/// A loop as a small drawing, with a line at zero load.
fn drawn(of: &LiveLoop) -> Markup {
    let all = || of.paths.iter().flatten().copied();
    let (mut low, mut high) = ((f64::INFINITY, f64::INFINITY), (f64::NEG_INFINITY, f64::NEG_INFINITY));
    for (x, y) in all() {
        (low, high) = ((low.0.min(x), low.1.min(y)), (high.0.max(x), high.1.max(y)));
    }
    let place = |(x, y): (f64, f64)| {
        let share =
            |value: f64, low: f64, high: f64| if high > low { (value - low) / (high - low) } else { 0.5 };
        (
            4.0 + (SIZE.0 - 8.0) * share(x, low.0, high.0),
            4.0 + (SIZE.1 - 8.0) * (1.0 - share(y, low.1, high.1)),
        )
    };
    let number = |value: f64| significant(value, 3).replace('-', "−");
    let zero = place((low.0, 0.0)).1;
    let path = |points: &[(f64, f64)]| -> String {
        let step = |(k, point): (usize, &(f64, f64))| {
            let (x, y) = place(*point);
            format!("{}{x:.1} {y:.1}", if k == 0 { "M" } else { "L" })
        };
        points.iter().enumerate().map(step).collect()
    };
    html! {
        figure {
            svg.loop
                viewBox={ "0 0 " (SIZE.0) " " (SIZE.1) } width=(SIZE.0) height=(SIZE.1)
                role="img" aria-label={ "Loop of cycle " (of.id) } {
                @if low.1 <= 0.0 && high.1 >= 0.0 {
                    path d={ "M0 " (format!("{zero:.1}")) "H" (SIZE.0) } stroke="#999999" {}
                }
                @for (k, points) in of.paths.iter().enumerate() {
                    path d=(path(points)) fill="none" stroke="#7b3294" stroke-width="1.5"
                        stroke-dasharray=(if k == 0 { "5 3" } else { "none" }) {}
                }
            }
            figcaption { (of.id) br; "F/(E*A₀): " (number(low.1)) " to " (number(high.1)) }
        }
    }
}
