//! Page of a run in progress, which reloads itself.

use super::layout::{plain, styled};
use crate::stats::significant;
use crate::text::counted;
use maud::{Markup, html};

/// Seconds between two loads of the page.
const RELOAD_SECONDS: u32 = 5;
/// Loops that the page shows, at most: the last ones.
const MOST_LOOPS: usize = 24;
/// Width and height of a loop \[pixels\].
const SIZE: (f64, f64) = (180.0, 130.0);

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
    /// Tasks that are running.
    pub running: Vec<String>,
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
    /// Time of this version of the page.
    pub updated: String,
    /// Stages that have begun.
    pub stages: Vec<LiveStage>,
    /// Warnings and failures.
    pub notices: Vec<String>,
    /// Loops of the finished cycles, in the order in which they ended.
    pub loops: Vec<LiveLoop>,
}

/// The page as HTML.
#[must_use]
pub fn live_page(run: &LiveRun) -> String {
    let body = html! {
        h1 { (run.name) ": in progress" } "\n"
        p { "This page reloads itself every " (RELOAD_SECONDS) " s. At the end of the run, " a href="report.html" { "report.html" } " has the results. Last update: " (run.updated) "." } "\n"
        div.scroll role="region" aria-label="Table of stages" tabindex="0" { table {
            tr { th { "stage" } th { "finished" } th { "work" } th { "running" } }
            @for stage in &run.stages {
                tr { td { (stage.name) } td { (stage.done) " of " (counted(stage.all, "task")) } td { (percent(stage)) } td { (stage.running.join(", ")) } }
            }
        } }
        "\n"
        @if !run.notices.is_empty() {
            h2 { "Failures and notices" } "\n"
            ul { @for notice in &run.notices { li { pre.text { (notice) } } } } "\n"
        }
        @if !run.loops.is_empty() {
            h2 { "Finished cycles" } "\n"
            p { (plain("Normal force F/(E*A₀) against mean penetration Δ/h_rms; loading dashed, unloading solid.")) } "\n"
            ul.loops { @for of in run.loops.iter().rev().take(MOST_LOOPS) { li { (drawn(of)) } } } "\n"
        }
    };
    styled((&format!("{}: in progress", run.name), Some(RELOAD_SECONDS)), &body)
}

/// Part of the work of a stage that is done.
fn percent(stage: &LiveStage) -> String {
    let part = if stage.all == 0 { 1.0 } else { stage.work / stage.all as f64 };
    format!("{:.0}\u{a0}%", 100.0 * part.clamp(0.0, 1.0))
}

/// A loop as a small drawing, with a line at zero load.
fn drawn(of: &LiveLoop) -> Markup {
    let all = || of.paths.iter().flatten().copied();
    let (mut low, mut high) = ((f64::INFINITY, f64::INFINITY), (f64::NEG_INFINITY, f64::NEG_INFINITY));
    for (x, y) in all() {
        (low, high) = ((low.0.min(x), low.1.min(y)), (high.0.max(x), high.1.max(y)));
    }
    let place = |(x, y): (f64, f64)| {
        let share = |value: f64, low: f64, high: f64| if high > low { (value - low) / (high - low) } else { 0.5 };
        (4.0 + (SIZE.0 - 8.0) * share(x, low.0, high.0), 4.0 + (SIZE.1 - 8.0) * (1.0 - share(y, low.1, high.1)))
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
            svg.loop viewBox={ "0 0 " (SIZE.0) " " (SIZE.1) } width=(SIZE.0) height=(SIZE.1) role="img" aria-label={ "Loop of cycle " (of.id) } {
                @if low.1 <= 0.0 && high.1 >= 0.0 { path d={ "M0 " (format!("{zero:.1}")) "H" (SIZE.0) } stroke="#999999" {} }
                @for (k, points) in of.paths.iter().enumerate() {
                    path d=(path(points)) fill="none" stroke="#0072b2" stroke-width="1.5" stroke-dasharray=(if k == 0 { "5 3" } else { "none" }) {}
                }
            }
            figcaption { (of.id) br; "F/(E*A₀): " (number(low.1)) " to " (number(high.1)) }
        }
    }
}
