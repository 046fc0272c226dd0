//! Reason for computing a task: its key inputs, field by field, compared with those of the most similar
//! finished task.

use super::leftover::is_id;
use super::{Campaign, REPORT_PAGE, STATISTICS, Stage, Standing, Unit};
use crate::keys::canonical;
use crate::store::{Check, Found, read_receipt};
use serde::Serialize;
use serde_json::{Map, Value};
use std::collections::{BTreeMap, BTreeSet, HashSet};

/// Status of a task, and its differences from the most similar finished one.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Explanation {
    /// The stage's word.
    pub stage: &'static str,
    /// The unit.
    pub id: String,
    /// Status: a word of [`Standing`], or `orphan` if the spec does not name the task.
    pub state: &'static str,
    /// Reason, if the status has one.
    pub why: Option<String>,
    /// Most similar task: a finished one, or for an unreferenced task one of the spec.
    pub nearest: Option<String>,
    /// Differences.
    pub differences: Vec<Difference>,
}

/// One field that differs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Difference {
    /// The field, as in the spec.
    pub field: String,
    /// The first stage that reads it.
    pub read_by: String,
    /// Value of the task; nothing if it has no such field.
    pub here: Option<Value>,
    /// Value of the most similar task.
    pub there: Option<Value>,
}

/// A field by stage and name.
type Fields = BTreeMap<(usize, String), Value>;

/// Weight of another realization relative to another parameter: a unit is compared with one of its own
/// realization, if there is any.
const OTHER_REALIZATION: usize = 100;

impl Campaign {
    /// Explains the tasks with an id; empty if neither the spec nor the folder has it.
    #[must_use]
    pub fn explain(&self, id: &str) -> Vec<Explanation> {
        let mut found = Vec::new();
        for unit in self.surfaces.iter().filter(|unit| unit.id == id) {
            for (of, stage) in [(unit.surface(), Stage::Generate), (unit.asperities(), Stage::Extract)] {
                let standing = self.standing(&of, Check::Sizes);
                found.push(self.beside_receipts(stage, id, &standing, &self.surface_preimages(unit, stage)));
            }
        }
        if let Some(unit) = self.cycles.iter().find(|unit| unit.id == id) {
            let standing = self.cycle_standing(unit, Check::Sizes);
            found.push(self.beside_receipts(Stage::Cycle, id, &standing, &self.cycle_preimages(unit)));
        }
        if id == STATISTICS || id == REPORT_PAGE {
            let cycles = self.cycle_standings(Check::Sizes);
            let statistics = self.statistics_key(&cycles);
            let report = self.report_key(&statistics);
            let (stage, key, preimages) = match id {
                STATISTICS => (Stage::Aggregate, &statistics, self.statistics_preimages(&cycles)),
                _ => (Stage::Report, &report, self.report_preimages(&statistics)),
            };
            let standing = self.standing(&Unit { stage, id, key }, Check::Sizes);
            found.push(self.beside_receipts(stage, id, &standing, &preimages));
        }
        // An id that is none may be a path to somewhere else.
        if found.is_empty() && is_id(id) {
            found.extend(
                [Stage::Generate, Stage::Extract, Stage::Cycle]
                    .into_iter()
                    .filter_map(|stage| self.orphan(stage, id)),
            );
        }
        found
    }

    fn beside_receipts(
        &self,
        stage: Stage,
        id: &str,
        standing: &Standing,
        preimages: &Map<String, Value>,
    ) -> Explanation {
        let mut explanation = Explanation {
            stage: stage.word(),
            id: id.to_owned(),
            state: standing.word(),
            why: standing.why().map(str::to_owned),
            nearest: None,
            differences: Vec::new(),
        };
        if !matches!(standing, Standing::Done | Standing::Missing(_) | Standing::Corrupt(_)) {
            let here = fields(preimages);
            // A planned task differs from others of the same spec on purpose: only results of another spec
            // show a change.
            let own = if *standing == Standing::Planned { self.ids(stage) } else { HashSet::new() };
            let others =
                self.receipts(stage).into_iter().filter(|receipt| !own.contains(receipt.id.as_str()));
            let others = others.map(|receipt| (receipt.id.clone(), fields(&receipt.preimages)));
            (explanation.nearest, explanation.differences) = nearest(&here, others);
        }
        explanation
    }

    /// The ids of a stage's tasks in the spec.
    fn ids(&self, stage: Stage) -> HashSet<&str> {
        match stage {
            Stage::Generate | Stage::Extract => self.surfaces.iter().map(|unit| unit.id.as_str()).collect(),
            Stage::Cycle => self.cycles.iter().map(|unit| unit.id.as_str()).collect(),
            Stage::Aggregate | Stage::Report => HashSet::new(),
        }
    }

    /// A finished task that the spec does not reference, compared with the most similar task of the spec.
    fn orphan(&self, stage: Stage, id: &str) -> Option<Explanation> {
        let Found::Whole(receipt) = read_receipt(&self.receipt_path(&Unit { stage, id, key: "" })) else {
            return None;
        };
        let here = fields(&receipt.preimages);
        let (nearest, differences) = if stage == Stage::Cycle {
            nearest(
                &here,
                self.distinct_cycles()
                    .iter()
                    .map(|unit| (unit.id.clone(), fields(&self.cycle_preimages(unit)))),
            )
        } else {
            nearest(
                &here,
                self.surfaces
                    .iter()
                    .map(|unit| (unit.id.clone(), fields(&self.surface_preimages(unit, stage)))),
            )
        };
        Some(Explanation {
            stage: stage.word(),
            id: id.to_owned(),
            state: "orphan",
            why: None,
            nearest,
            differences,
        })
    }
}

/// The nearest of some units, and what differs.
fn nearest(
    here: &Fields,
    others: impl Iterator<Item = (String, Fields)>,
) -> (Option<String>, Vec<Difference>) {
    let far = |difference: &Difference| {
        if matches!(difference.field.as_str(), "realization" | "seed") { OTHER_REALIZATION } else { 1 }
    };
    let compared = others.map(|(id, there)| (id, differences(here, &there)));
    match compared.min_by_key(|(id, differences)| (differences.iter().map(far).sum::<usize>(), id.clone())) {
        Some((id, differences)) => (Some(id), differences),
        None => (None, Vec::new()),
    }
}

pub(super) fn differences(here: &Fields, there: &Fields) -> Vec<Difference> {
    let names: BTreeSet<&(usize, String)> = here.keys().chain(there.keys()).collect();
    let differs =
        |name: &&&(usize, String)| here.get(**name).map(canonical) != there.get(**name).map(canonical);
    names
        .iter()
        .filter(differs)
        .map(|name| {
            let (here, there) = apart(here.get(*name), there.get(*name));
            Difference { field: name.1.clone(), read_by: Stage::ALL[name.0].word().to_owned(), here, there }
        })
        .collect()
}

/// Two values; of two lists how many entries only one of them has.
fn apart(here: Option<&Value>, there: Option<&Value>) -> (Option<Value>, Option<Value>) {
    let (Some(Value::Array(a)), Some(Value::Array(b))) = (here, there) else {
        return (here.cloned(), there.cloned());
    };
    if a.len().max(b.len()) < 10 && !a.iter().chain(b).any(Value::is_array) {
        return (here.cloned(), there.cloned());
    }
    let [mine, its] = [a, b].map(|list| list.iter().map(canonical).collect::<BTreeSet<String>>());
    let only = |of: &BTreeSet<String>, but: &BTreeSet<String>| {
        Some(Value::from(format!("{} of {} only here", of.difference(but).count(), of.len())))
    };
    (only(&mine, &its), only(&its, &mine))
}

/// Fields of the key inputs of a task, by the stage that reads them first. The key of another task stands for
/// the inputs of that task.
pub(super) fn fields(preimages: &Map<String, Value>) -> Fields {
    let mut all = Fields::new();
    for (place, stage) in Stage::ALL.into_iter().enumerate() {
        let Some(preimage) = preimages.get(stage.word()) else { continue };
        // A number may be read back as its neighbour: both sides go through the same words.
        let preimage: Value = serde_json::from_str(&preimage.to_string()).unwrap_or(Value::Null);
        let meaning = preimage.get("meaning").cloned().unwrap_or(Value::Null);
        all.insert((place, format!("meaning of {}", stage.word())), meaning);
        for (name, value) in preimage.get("reads").and_then(Value::as_object).into_iter().flatten() {
            let is_key =
                matches!((stage, name.as_str()), (Stage::Extract, "surface") | (Stage::Cycle, "asperities"));
            if !is_key {
                flatten(place, name, value, &mut all);
            }
        }
    }
    all
}

fn flatten(place: usize, name: &str, value: &Value, all: &mut Fields) {
    match value {
        Value::Object(members) => {
            for (inner, value) in members {
                flatten(place, &format!("{name}.{inner}"), value, all);
            }
        }
        plain => {
            all.insert((place, name.to_owned()), plain.clone());
        }
    }
}
