//! Status of a task: derived from its receipt and its files, never stored.

use super::{Campaign, CycleUnit, REPORT_PAGE, STATISTICS, Stage, SurfaceUnit, Unit};
use crate::store::{Check, Fault, Found, Receipt, is_halfway, read_receipt};
use rayon::prelude::*;
use serde_json::Value;

/// Status of a task.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Standing {
    /// Done, with the present key: its receipt is there, and every file that it names.
    Done,
    /// A living process computes it.
    Running,
    /// A living process will compute it.
    Waiting,
    /// Not done yet.
    Planned,
    /// It has begun, and can go on from where it was kept last.
    Interrupted,
    /// It was tried, and failed: why.
    Failed(String),
    /// Done, but for other parameters or by a stage of another meaning.
    Stale,
    /// Done, but a file is gone since: which.
    Missing(String),
    /// Done, but a file or the receipt is another one since: which, and how.
    Corrupt(String),
}

impl Standing {
    /// Every word of [`Self::word`], in the order in which they are counted.
    pub const WORDS: [&'static str; 9] =
        ["done", "running", "waiting", "planned", "interrupted", "failed", "stale", "missing", "corrupt"];

    /// The word in the answers of the program.
    #[must_use]
    pub fn word(&self) -> &'static str {
        match self {
            Self::Done => "done",
            Self::Running => "running",
            Self::Waiting => "waiting",
            Self::Planned => "planned",
            Self::Interrupted => "interrupted",
            Self::Failed(_) => "failed",
            Self::Stale => "stale",
            Self::Missing(_) => "missing",
            Self::Corrupt(_) => "corrupt",
        }
    }

    /// True if a run leaves the task as it is: finished or failed.
    #[must_use]
    pub fn is_settled(&self) -> bool {
        matches!(self, Self::Done | Self::Failed(_))
    }

    /// Reason of a status, if it has one.
    #[must_use]
    pub fn why(&self) -> Option<&str> {
        match self {
            Self::Failed(why) | Self::Missing(why) | Self::Corrupt(why) => Some(why),
            _ => None,
        }
    }
}

/// Status of all tasks of a campaign, in its order.
#[derive(Debug, Clone)]
pub struct Survey {
    /// Surfaces.
    pub surfaces: Vec<Standing>,
    /// Their asperities.
    pub asperities: Vec<Standing>,
    /// Cycles, each once, by place in [`Campaign::cycles`].
    pub cycles: Vec<(usize, Standing)>,
    /// The tables over realizations.
    pub statistics: Standing,
    /// The page.
    pub report: Standing,
}

impl Campaign {
    /// Status of a task.
    #[must_use]
    pub fn standing(&self, unit: &Unit<'_>, check: Check) -> Standing {
        let name = || format!("receipts/{}/{}.json", unit.stage.word(), unit.id);
        match read_receipt(&self.receipt_path(unit)) {
            Found::Nothing => Standing::Planned,
            Found::Damaged(why) => Standing::Corrupt(format!("{}: {why}", name())),
            Found::Whole(receipt) if receipt.key != unit.key => Standing::Stale,
            Found::Whole(receipt) => {
                self.faults(&receipt, check).map_or(Standing::Done, |fault| match fault {
                    Fault::Missing(why) => Standing::Missing(why),
                    Fault::Changed(why) => Standing::Corrupt(why),
                })
            }
        }
    }

    /// Fault of `campaign.toml`, if any: a run with another spec has written this folder.
    #[must_use]
    pub fn spec_fault(&self) -> Option<String> {
        match read_receipt(&self.spec_receipt_path()) {
            Found::Nothing => Some("campaign.toml has no receipt".to_owned()),
            Found::Damaged(why) => Some(format!("receipts/campaign.json: {why}")),
            Found::Whole(receipt) => self.faults(&receipt, Check::Contents).map(Fault::sentence),
        }
    }

    /// True if files of a stage may exist. Without the folders of the stage, no task of it is checked: for
    /// 10⁵ tasks the checks take most of the time of a plan.
    fn begun(&self, stage: Stage) -> bool {
        self.receipts_dir(stage).exists() || (stage == Stage::Cycle && self.dir.join("cycles").exists())
    }

    /// The first fault of a unit's files.
    fn faults(&self, receipt: &Receipt, check: Check) -> Option<Fault> {
        receipt.files.iter().find_map(|file| file.fault(&self.dir, check))
    }

    /// Status of a cycle, which may have failed or be checkpointed.
    #[must_use]
    pub fn cycle_standing(&self, unit: &CycleUnit, check: Check) -> Standing {
        match self.standing(&unit.cycle(), check) {
            Standing::Planned => match self.failure(unit) {
                Some(why) => Standing::Failed(why),
                None if is_halfway(&self.halfway_path(unit), &unit.key) => Standing::Interrupted,
                None => Standing::Planned,
            },
            other => other,
        }
    }

    /// The recorded failure of a cycle with the present key.
    fn failure(&self, unit: &CycleUnit) -> Option<String> {
        self.failure_record(unit)?.get("error").and_then(Value::as_str).map(str::to_owned)
    }

    /// Error message of a failed cycle as tables hold it: the problem without the help, and without paths of
    /// the machine.
    #[must_use]
    pub fn failure_in_tables(&self, unit: &CycleUnit, standing: &Standing) -> Option<String> {
        self.failure_texts(unit, standing).map(|[problem, _]| problem)
    }

    /// Problem and help of a failed cycle without paths of the machine.
    #[must_use]
    pub fn failure_texts(&self, unit: &CycleUnit, standing: &Standing) -> Option<[String; 2]> {
        let Standing::Failed(why) = standing else { return None };
        let (problem, help) = why.split_once("\nhelp: ").unwrap_or((why, ""));
        let inside =
            |text: &str| text.replace(&format!("{}{}", self.dir.display(), std::path::MAIN_SEPARATOR), "");
        Some([problem, help].map(|text| self.with_label(&inside(text), &self.surfaces[unit.surface].params)))
    }

    /// Loads `F_max/(E* A0)` of a finished cycle that have no result, with their errors.
    #[must_use]
    pub fn not_reached(&self, unit: &CycleUnit) -> Vec<(f64, String)> {
        let path = self.not_reached_path(unit);
        let Some(text) = path.is_file().then(|| std::fs::read_to_string(path).ok()).flatten() else {
            return Vec::new();
        };
        let record: Value = serde_json::from_str(&text).unwrap_or_default();
        if record["key"] != unit.key.as_str() {
            return Vec::new();
        }
        let load = |of: &Value| Some((of["max_load"].as_f64()?, of["error"].as_str()?.to_owned()));
        record["loads"].as_array().into_iter().flatten().filter_map(load).collect()
    }

    /// Loads of a finished cycle that have no result in one sentence, as tables hold it: without the help of
    /// the errors.
    #[must_use]
    pub fn not_reached_in_tables(&self, unit: &CycleUnit) -> Option<String> {
        let unreached = self.not_reached(unit);
        let (_, error) = unreached.first()?;
        let same: Vec<String> =
            unreached.iter().filter(|(_, other)| other == error).map(|(load, _)| load.to_string()).collect();
        let others = unreached.len() - same.len();
        let more = if others > 0 { format!("; {others} more in not_reached.json") } else { String::new() };
        let problem = error.split_once("\nhelp:").map_or(error.as_str(), |(problem, _)| problem);
        Some(format!("F_max/(E* A0) = {} not reached: {problem}{more}", same.join(", ")))
    }

    /// The stage at which a cycle failed, or what it is made of.
    #[must_use]
    pub fn failed_at(&self, unit: &CycleUnit) -> Option<Stage> {
        let record = self.failure_record(unit)?;
        let word = record.get("stage").and_then(Value::as_str);
        Stage::ALL.into_iter().find(|stage| Some(stage.word()) == word)
    }

    /// Estimates of a failed cycle that depend on its surface and the material alone, by column.
    #[must_use]
    pub fn failure_estimates(&self, unit: &CycleUnit) -> Vec<(String, f64)> {
        let record = self.failure_record(unit).unwrap_or_default();
        let estimate = |(name, value): (&String, &Value)| Some((name.clone(), value.as_str()?.parse().ok()?));
        record["estimates"].as_object().into_iter().flatten().filter_map(estimate).collect()
    }

    fn failure_record(&self, unit: &CycleUnit) -> Option<Value> {
        let path = self.failure_path(unit);
        // A pipe in its place would be waited for.
        let text = path.is_file().then(|| std::fs::read_to_string(path).ok())??;
        let record: Value = serde_json::from_str(&text).ok()?;
        // A folder stood in the place of a file, and is gone.
        if record
            .get("in_the_way")
            .and_then(Value::as_str)
            .is_some_and(|place| !self.dir.join(place).is_dir())
        {
            return None;
        }
        (record.get("key")?.as_str()? == unit.key).then_some(record)
    }

    /// Status of all cycles, in the order of [`Campaign::cycles`]; shared cycles are checked once.
    #[must_use]
    pub fn cycle_standings(&self, check: Check) -> Vec<Standing> {
        self.distinct_standings(check).1
    }

    /// Status of each distinct cycle, with its place, and status of all cycles.
    fn distinct_standings(&self, check: Check) -> (Vec<(usize, Standing)>, Vec<Standing>) {
        let begun = self.begun(Stage::Cycle);
        let standing = |place: usize| {
            if begun { self.cycle_standing(&self.cycles[place], check) } else { Standing::Planned }
        };
        let (firsts, which) = self.distinct();
        let found: Vec<(usize, Standing)> =
            firsts.into_par_iter().map(|place| (place, standing(place))).collect();
        let all = which.iter().map(|k| found[*k].1.clone()).collect();
        (found, all)
    }

    /// Marks surfaces and tables of asperities as failed where a cycle records the failure.
    fn mark_failed(
        &self,
        cycles: &[(usize, Standing)],
        surfaces: &mut [Standing],
        asperities: &mut [Standing],
    ) {
        for (place, standing) in cycles.iter().filter(|(_, standing)| matches!(standing, Standing::Failed(_)))
        {
            let cycle = &self.cycles[*place];
            let at = self.failed_at(cycle);
            for (stage, standings) in [(Stage::Generate, &mut *surfaces), (Stage::Extract, &mut *asperities)]
            {
                if at.is_some_and(|at| at <= stage) && standings[cycle.surface] == Standing::Planned {
                    standings[cycle.surface] = standing.clone();
                }
            }
        }
    }

    /// Status of all tasks.
    #[must_use]
    pub fn survey(&self, check: Check) -> Survey {
        let of_surfaces = |stage: Stage, unit: fn(&SurfaceUnit) -> Unit<'_>| -> Vec<Standing> {
            if !self.begun(stage) {
                return vec![Standing::Planned; self.surfaces.len()];
            }
            self.surfaces.par_iter().map(|surface| self.standing(&unit(surface), check)).collect()
        };
        let mut surfaces = of_surfaces(Stage::Generate, SurfaceUnit::surface);
        let mut asperities = of_surfaces(Stage::Extract, SurfaceUnit::asperities);
        let (cycles, standings) = self.distinct_standings(check);
        self.mark_failed(&cycles, &mut surfaces, &mut asperities);
        let statistics_key = self.statistics_key(&standings);
        let statistics =
            self.standing(&Unit { stage: Stage::Aggregate, id: STATISTICS, key: &statistics_key }, check);
        let report_key = self.report_key(&statistics_key);
        let report = self.standing(&Unit { stage: Stage::Report, id: REPORT_PAGE, key: &report_key }, check);
        Survey { surfaces, asperities, cycles, statistics, report }
    }
}
