//! The end of a run: results, failures with their reasons, elapsed time and size.

use super::outputs::undamaged;
use super::{Fault, failed};
use crate::campaign::{Campaign, CycleUnit, Shard, Stage, Standing};
use crate::cli::progress::duration;
use crate::schema;
use crate::stages::Tally;
use crate::stats::{Shown, methods_summary, summary, warning_text};
use crate::store::{Check, Frame, parquet};
use crate::text::{counted, shell_path, shown, visible, wrapped};
use indicatif::HumanBytes;
use serde_json::json;
use std::path::Path;
use std::time::Duration;

/// Failures that are listed.
const LISTED: usize = 10;

/// A run that has ended.
pub(super) struct Ended<'a> {
    campaign: &'a Campaign,
    tallies: &'a [(Stage, Tally)],
    time: Duration,
    size_bytes: u64,
    /// Failed cycles without those of coarser grids; if a surface failed, all its cycles did.
    failed_count: usize,
    /// Failed tasks.
    failures: Vec<Failed>,
    /// Loads of finished cycles that have no result.
    unreached: Vec<Unreached>,
}

/// A failed cycle.
struct Failed {
    id: String,
    name: String,
    is_coarser_grid: bool,
    why: String,
}

/// A load of a finished cycle without a result.
struct Unreached {
    id: String,
    name: String,
    is_coarser_grid: bool,
    max_load: f64,
    why: String,
}

impl<'a> Ended<'a> {
    pub(super) fn of(
        campaign: &'a Campaign,
        shard: Shard,
        tallies: &'a [(Stage, Tally)],
        time: Duration,
    ) -> Self {
        let of_tasks = tallies.iter().map(|(_, tally)| tally.failed).max().unwrap_or(0);
        let failures = if of_tasks > 0 { failures(campaign, shard) } else { Vec::new() };
        let coarser = failures.iter().filter(|of| of.is_coarser_grid).count();
        // A failure that could not be recorded is in the tally alone.
        let failed_count = of_tasks.saturating_sub(coarser).max(failures.len() - coarser);
        Self {
            campaign,
            tallies,
            time,
            size_bytes: size(&campaign.dir),
            failed_count,
            failures,
            unreached: unreached(campaign, shard),
        }
    }

    /// True if requested results have failed or are not reached. Coarser grids of a case only estimate its
    /// error.
    pub(super) fn lacks_results(&self) -> bool {
        self.failed_count > 0 || self.unreached.iter().any(|of| !of.is_coarser_grid)
    }

    /// The table of results with verdicts and warnings; with all of them, also the ratios of both methods.
    fn results(&self, warnings: Shown) -> Result<String, Fault> {
        let (cases, methods) = (self.cases()?, self.table(&schema::METHODS)?);
        // Tables of an earlier version of the program have none.
        let is_there = self.campaign.statistics_path(schema::CUTOFF.name).is_file();
        let cutoff = is_there.then(|| self.table(&schema::CUTOFF)).transpose()?;
        let mut text = summary(&cases, Some(&methods), cutoff.as_ref(), warnings).map_err(failed)?;
        let compared = methods_summary(&cases, &methods).map_err(failed)?;
        if warnings == Shown::All && !compared.is_empty() {
            text += &format!("\n{compared}");
        }
        Ok(text + "\n")
    }

    /// The results, failures, counts and places.
    pub(super) fn conclusion(&self, until: Stage, warnings: Shown) -> Result<String, Fault> {
        let mut text = if until >= Stage::Aggregate { self.results(warnings)? } else { String::new() };
        for (stage, t) in self.tallies.iter().filter(|_| !self.is_idle()) {
            let lost = if t.failed > 0 { format!(", {} failed", t.failed) } else { String::new() };
            text += &format!(
                "{:9} {} of {} computed, {} done before{lost}\n",
                stage.word(),
                t.computed,
                t.planned,
                t.before
            );
        }
        if self.failed_count > 0 {
            text += &failed_cycles(self.failed_count, &self.campaign.dir);
            text += &self.reasons(false);
        }
        text += &self.unreached_loads(false);
        text += &self.of_coarser_grids();
        let size = HumanBytes(self.size_bytes);
        let computed: usize = self.tallies.iter().map(|(_, tally)| tally.computed).sum();
        let planned: usize = self.tallies.iter().map(|(_, tally)| tally.planned).sum();
        text += &if self.is_idle() {
            format!(
                "Nothing to do: {} done before. Size of the output folder: {size}\n",
                counted(planned, "task")
            )
        } else {
            format!(
                "{} in {}. Size of the output folder: {size}\n",
                counted(computed, "task"),
                duration(self.time)
            )
        };
        let dir = shown(&self.campaign.dir);
        text += &match until {
            Stage::Report => format!(
                "Report: {dir}/report.html\nTables: {dir}/statistics/*.parquet\n{}To open it: {} report {} \
                 --open\n",
                self.formats(),
                program(),
                shell_path(&self.campaign.dir)
            ),
            _ => format!("Output: {dir}\n"),
        };
        Ok(text)
    }

    /// Formats of the figures that this build does not write.
    fn formats(&self) -> String {
        let left_out: Vec<String> =
            self.campaign.spec.figures.left_out().iter().map(|format| format.to_uppercase()).collect();
        let needs = if left_out.len() == 1 { "needs" } else { "need" };
        let text = || {
            format!("Figures: SVG; {} {needs} a build with `--features raster`.\n", left_out.join(" and "))
        };
        if left_out.is_empty() { String::new() } else { text() }
    }

    /// Warnings of the cases, once they are known.
    pub(super) fn warnings(&self, until: Stage) -> Result<String, Fault> {
        if until < Stage::Aggregate {
            Ok(String::new())
        } else {
            warning_text(&self.cases()?).map_err(failed)
        }
    }

    fn cases(&self) -> Result<Frame, Fault> {
        self.table(&schema::CASES)
    }

    /// A table of statistics, if it is as it was written.
    fn table(&self, table: &'static schema::Table) -> Result<Frame, Fault> {
        undamaged("print the results of", &self.campaign.dir, table.file)?;
        parquet::read_table(&self.campaign.dir.join(table.file), table).map_err(failed)
    }

    /// True if nothing was computed, and nothing failed.
    fn is_idle(&self) -> bool {
        self.failures.is_empty()
            && self.failed_count == 0
            && self.tallies.iter().all(|(_, tally)| tally.computed == 0)
    }

    /// Failures and loads without a result on coarser grids.
    fn of_coarser_grids(&self) -> String {
        let failed = self.failures.iter().filter(|of| of.is_coarser_grid).count();
        let failed =
            if failed > 0 { failed_coarser_grids(failed) + &self.reasons(true) } else { String::new() };
        failed + &self.unreached_loads(true)
    }

    /// The first loads of finished cycles without a result, each with the first line of its reason.
    fn unreached_loads(&self, of_coarser_grids: bool) -> String {
        let unreached: Vec<&Unreached> =
            self.unreached.iter().filter(|of| of.is_coarser_grid == of_coarser_grids).collect();
        if unreached.is_empty() {
            return String::new();
        }
        let (of, effect) = if of_coarser_grids {
            ("coarser grids", "results are complete, their grid errors may be unknown")
        } else {
            ("finished cycles", "their other loads have results")
        };
        let count = counted(unreached.len(), "load");
        let mut text = format!("{count} of {of} not reached; {effect}.\n");
        for Unreached { name, max_load, why, .. } in unreached.iter().take(LISTED) {
            let why = visible(why.lines().next().unwrap_or_default());
            text += &wrapped(&format!("  {name}, F_max/(E* A0) = {max_load}: {why}"), "    ");
        }
        if unreached.len() > LISTED {
            text += &format!("  … and {} more\n", unreached.len() - LISTED);
        }
        text + &format!("Reasons with help: {}/cycles/*/not_reached.json\n", shown(&self.campaign.dir))
    }

    /// The first failures, each with the first line of its reason; the others are in files.
    fn reasons(&self, of_coarser_grids: bool) -> String {
        let failures: Vec<&Failed> =
            self.failures.iter().filter(|of| of.is_coarser_grid == of_coarser_grids).collect();
        let mut text = String::new();
        for Failed { name, why, .. } in failures.iter().take(LISTED) {
            text +=
                &wrapped(&format!("  {name}: {}", visible(why.lines().next().unwrap_or_default())), "    ");
        }
        if failures.len() > LISTED {
            text += &format!("  … and {} more\n", failures.len() - LISTED);
        }
        text + &format!("Reasons with help: {}/cycles/*/failed.json\n", shown(&self.campaign.dir))
    }
}

/// The program as it was called, for a command that can be repeated: `hysteron`, or its path.
fn program() -> String {
    std::env::args_os().next().map_or_else(|| "hysteron".to_owned(), |path| shell_path(Path::new(&path)))
}

/// The answer of a run in JSON.
pub(super) fn tally_json(ended: &Ended<'_>) -> String {
    let stages: Vec<_> = ended
        .tallies
        .iter()
        .map(|(stage, t)| {
            json!({
                "stage": stage.word(), "planned_count": t.planned, "done_before_count": t.before,
                "computed_count": t.computed, "failed_count": t.failed,
            })
        })
        .collect();
    let failure = |of: &Failed| json!({ "id": of.id, "coarser_grid": of.is_coarser_grid, "why": of.why });
    let failures: Vec<_> = ended.failures.iter().map(failure).collect();
    let unreached = |of: &Unreached| {
        json!({
            "id": of.id, "coarser_grid": of.is_coarser_grid, "max_load": of.max_load, "why": of.why,
        })
    };
    let unreached: Vec<_> = ended.unreached.iter().map(unreached).collect();
    let answer = json!({
        "name": ended.campaign.spec.name,
        "dir": ended.campaign.dir.display().to_string(),
        "stages": stages,
        "failures": failures,
        "not_reached": unreached,
        "figure_formats_left_out": ended.campaign.spec.figures.left_out(),
        "elapsed_s": ended.time.as_secs_f64(),
        "size_bytes": ended.size_bytes,
    });
    format!("{answer:#}\n")
}

/// The number of failed cycles, and the command that reruns them.
pub(super) fn failed_cycles(failures: usize, dir: &Path) -> String {
    let them = if failures == 1 { "it" } else { "them" };
    format!(
        "{} failed. Follow the help of the error and change the spec:\n\
         without a change, a cycle fails again.\n\
         After a change of the program, `hysteron retry {}` reruns {them}.\n",
        counted(failures, "cycle"),
        shell_path(dir)
    )
}

/// The number of failed cycles on coarser grids, with their effect.
pub(super) fn failed_coarser_grids(failures: usize) -> String {
    let text = format!(
        "warning: {} on coarser grids failed: results are complete, and their grid errors follow from the \
         other grids or are unknown",
        counted(failures, "cycle")
    );
    wrapped(&text, "  ")
}

/// Failed cycles of a shard with their reasons.
fn failures(campaign: &Campaign, shard: Shard) -> Vec<Failed> {
    let cycles = campaign
        .survey(Check::Sizes)
        .cycles
        .into_iter()
        .map(|(place, standing)| (&campaign.cycles[place], standing))
        .filter(|(unit, _)| shard.holds(unit.surface));
    let failed = cycles.filter_map(|(unit, standing)| match standing {
        Standing::Failed(why) => Some(Failed {
            id: unit.id.clone(),
            name: campaign.name_of(unit),
            is_coarser_grid: campaign.is_coarser_grid(unit),
            why,
        }),
        _ => None,
    });
    failed.collect()
}

/// Loads without a result of the finished cycles of a shard.
fn unreached(campaign: &Campaign, shard: Shard) -> Vec<Unreached> {
    let cycles = campaign.distinct_cycles().into_iter().filter(|unit| shard.holds(unit.surface));
    let of = |unit: CycleUnit| {
        let loads = campaign.not_reached(&unit);
        let one = move |(max_load, why)| Unreached {
            id: unit.id.clone(),
            name: campaign.name_of(&unit),
            is_coarser_grid: campaign.is_coarser_grid(&unit),
            max_load,
            why,
        };
        loads.into_iter().map(one)
    };
    cycles.flat_map(of).collect()
}

/// Bytes of all files below a folder; links are not followed.
fn size(folder: &Path) -> u64 {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let of_entry = |entry: std::fs::DirEntry| match entry.metadata() {
        Ok(found) if found.is_dir() => size(&entry.path()),
        Ok(found) => found.len(),
        Err(_) => 0,
    };
    entries.map(of_entry).sum()
}
