//! Reasons of pending tasks: new values of parameters, and changes since the tables were computed.

use super::compare::{differences, fields};
use super::{Campaign, STATISTICS, Stage, Standing, Unit};
use crate::keys::canonical;
use crate::store::{Found, Receipt, read_receipt};
use crate::text::counted;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

/// Tasks that are compared, and finished tasks that are read, at most: a plan of 10⁵ tasks takes about a
/// second.
const COMPARED: usize = 5000;
const READ: usize = 20_000;

/// Tasks without a new value that are compared with every finished task.
const COMBINED: usize = 20;

/// Values of a parameter that are listed.
const LISTED: usize = 6;

/// New values by the name of the parameter, and the number of tasks that have them.
type Grouped = (BTreeMap<String, Vec<String>>, usize);

/// A field by stage and name.
type Fields = BTreeMap<(usize, String), Value>;

/// Reasons of pending tasks.
#[derive(Debug, Default)]
pub struct Reasons {
    /// Each reason with its number of tasks.
    pub reasons: Vec<(String, usize)>,
    /// Number of compared tasks.
    pub compared: usize,
}

impl Campaign {
    /// Reasons why tasks of a stage with one task for each surface or cycle are pending, from parameters of
    /// finished tasks. Nothing where no task is finished.
    #[must_use]
    pub fn reasons(&self, stage: Stage, pending: &[&str]) -> Reasons {
        let finished = std::fs::read_dir(self.receipts_dir(stage)).map_or(0, Iterator::count);
        if finished == 0 || finished > READ || pending.is_empty() || stage > Stage::Cycle {
            return Reasons::default();
        }
        let (finished, own) = self.finished(stage);
        let known: HashMap<&(usize, String), HashSet<String>> =
            finished.iter().flatten().fold(HashMap::new(), |mut known, (name, value)| {
                known.entry(name).or_insert_with(HashSet::new).insert(canonical(value));
                known
            });
        let inputs = self.key_inputs_by_id(stage, pending);
        let mut found: BTreeMap<Vec<String>, Grouped> = BTreeMap::new();
        let (mut combined, mut compared) = (0, 0);
        for id in pending.iter().take(COMPARED) {
            let Some(here) = inputs.get(id) else { continue };
            compared += 1;
            let is_new = |(name, value): &(&(usize, String), &Value)| {
                known.get(name).is_none_or(|known| !known.contains(&canonical(value)))
            };
            let new: Vec<(&(usize, String), &Value)> = here.iter().filter(is_new).collect();
            let (names, values) = if new.is_empty() {
                combined += 1;
                (combination(here, &finished, combined), Vec::new())
            } else {
                (new.iter().map(|(name, _)| name.1.clone()).collect(), new)
            };
            let (listed, count) = found.entry(names).or_default();
            *count += 1;
            for (name, value) in values {
                let listed = listed.entry(name.1.clone()).or_default();
                let text = value.to_string();
                if !listed.contains(&text) {
                    listed.push(text);
                }
            }
        }
        let text = |(names, (values, count)): (Vec<String>, Grouped)| {
            let before = |name: &String| if own { None } else { only(name, &finished) };
            (reason(&names, &values, before), count)
        };
        Reasons { reasons: found.into_iter().map(text).collect(), compared }
    }

    /// Key inputs of the finished tasks of a stage, and whether some are of this spec; the others are read
    /// only if none is.
    fn finished(&self, stage: Stage) -> (Vec<Fields>, bool) {
        let ids: HashSet<&str> = match stage {
            Stage::Cycle => self.cycles.iter().map(|unit| unit.id.as_str()).collect(),
            _ => self.surfaces.iter().map(|unit| unit.id.as_str()).collect(),
        };
        let all = self.receipts(stage);
        let of = |receipts: &mut dyn Iterator<Item = &Receipt>| {
            receipts.map(|receipt| fields(&receipt.preimages)).collect::<Vec<_>>()
        };
        let own = of(&mut all.iter().filter(|receipt| ids.contains(receipt.id.as_str())));
        if own.is_empty() { (of(&mut all.iter()), false) } else { (own, true) }
    }

    /// Key inputs of tasks by their ids.
    fn key_inputs_by_id<'a>(&self, stage: Stage, ids: &[&'a str]) -> HashMap<&'a str, Fields> {
        let wanted: HashMap<&str, &'a str> = ids.iter().take(COMPARED).map(|id| (*id, *id)).collect();
        if stage == Stage::Cycle {
            let units = self.cycles.iter().filter_map(|unit| Some((*wanted.get(unit.id.as_str())?, unit)));
            return units.map(|(id, unit)| (id, fields(&self.cycle_preimages(unit)))).collect();
        }
        let units = self.surfaces.iter().filter_map(|unit| Some((*wanted.get(unit.id.as_str())?, unit)));
        units.map(|(id, unit)| (id, fields(&self.surface_preimages(unit, stage)))).collect()
    }

    /// Changes that make the tables over realizations or the report stale.
    #[must_use]
    pub fn staleness(&self, stage: Stage, cycles: &[Standing]) -> Option<String> {
        let id = if stage == Stage::Aggregate { STATISTICS } else { super::REPORT_PAGE };
        let Found::Whole(receipt) = read_receipt(&self.receipt_path(&Unit { stage, id, key: "" })) else {
            return None;
        };
        let now = if stage == Stage::Aggregate {
            self.statistics_preimages(cycles)
        } else {
            self.report_preimages(&self.statistics_key(cycles))
        };
        let [then, now] =
            [&receipt.preimages, &now].map(|inputs| inputs.get(stage.word()).cloned().unwrap_or_default());
        let mut changes = Vec::new();
        if then.get("meaning") != now.get("meaning") {
            changes.push("this version of the program computes it differently".to_owned());
        }
        let read = |of: &Value, name: &str| {
            of.get("reads").and_then(|reads| reads.get(name)).cloned().unwrap_or_default()
        };
        if stage == Stage::Aggregate {
            changes.extend(of_lists(&read(&then, "cases"), &read(&now, "cases"), "case", "relabelled"));
            if changes.is_empty() {
                changes.extend(of_lists(
                    &read(&then, "cycles"),
                    &read(&now, "cycles"),
                    "cycle",
                    "finished, lost or failed since",
                ));
            }
            let named = [
                ("grid_error", "boundary_elements.error was changed"),
                ("loops", "[experiment] or a measured loop was changed"),
            ];
            changes.extend(differing(&named, |name| read(&then, name) != read(&now, name)));
        } else {
            let named =
                [("statistics", "the tables over realizations are stale"), ("spec", "the spec was edited")];
            changes.extend(differing(&named, |name| read(&then, name) != read(&now, name)));
        }
        if read(&then, "name") != read(&now, "name") {
            changes.push("the name of the run was changed".to_owned());
        }
        (!changes.is_empty()).then(|| changes.join(", "))
    }
}

/// Texts on the named inputs that differ.
fn differing(named: &[(&str, &str)], differs: impl Fn(&str) -> bool) -> Vec<String> {
    named.iter().filter(|(name, _)| differs(name)).map(|(_, text)| (*text).to_owned()).collect()
}

/// Changes from one list of entries `[id, …]` to another.
fn of_lists(then: &Value, now: &Value, noun: &str, otherwise: &str) -> Vec<String> {
    let entries = |list: &Value| -> BTreeMap<String, String> {
        let entry = |entry: &Value| Some((entry.get(0)?.as_str()?.to_owned(), entry.to_string()));
        list.as_array().into_iter().flatten().filter_map(entry).collect()
    };
    let [then, now] = [then, now].map(entries);
    let added = now.keys().filter(|id| !then.contains_key(*id)).count();
    let removed = then.keys().filter(|id| !now.contains_key(*id)).count();
    let changed =
        now.iter().filter(|(id, entry)| then.get(*id).is_some_and(|before| before != *entry)).count();
    let text = |(count, what): (usize, &str)| {
        let was = if count == 1 { "was" } else { "were" };
        (count > 0).then(|| format!("{} {was} {what}", counted(count, noun)))
    };
    [(added, "added"), (removed, "removed"), (changed, otherwise)].into_iter().filter_map(text).collect()
}

/// Names of the parameters in which a task differs from the most similar finished one; nothing beyond a
/// number of tasks, each of which takes time.
fn combination(here: &Fields, finished: &[Fields], number: usize) -> Vec<String> {
    if number > COMBINED {
        return Vec::new();
    }
    let names = |there: &Fields| {
        differences(here, there).into_iter().map(|of| of.field).collect::<BTreeSet<String>>()
    };
    finished.iter().map(names).min_by_key(BTreeSet::len).unwrap_or_default().into_iter().collect()
}

/// The value of a field in all finished tasks, if it is one.
fn only(name: &str, finished: &[Fields]) -> Option<String> {
    let mut values =
        finished.iter().flatten().filter(|((_, field), _)| field == name).map(|(_, value)| value.to_string());
    let first = values.next()?;
    values.all(|value| value == first).then_some(first)
}

/// A reason in words.
fn reason(
    names: &[String],
    values: &BTreeMap<String, Vec<String>>,
    before: impl Fn(&String) -> Option<String>,
) -> String {
    if values.is_empty() {
        let names: Vec<&str> = names.iter().map(|name| short(name)).collect();
        return match names.as_slice() {
            [] => "not computed yet".to_owned(),
            names => format!("new combination of {}", names.join(", ")),
        };
    }
    let listed = |(name, values): (&String, &Vec<String>)| {
        let more =
            if values.len() > LISTED { format!(", … ({} values)", values.len()) } else { String::new() };
        let list = format!("{}{more}", values[..values.len().min(LISTED)].join(", "));
        match name.as_str() {
            "surface.blake3" => "another content of the surface file".to_owned(),
            meaning if meaning.starts_with("meaning of ") => {
                format!("another version of the stage {}", &meaning["meaning of ".len()..])
            }
            _ if values.len() == 1
                && let Some(before) = before(name) =>
            {
                format!("{} {before} → {list}", short(name))
            }
            _ => format!("new value{} {} = {list}", if values.len() > 1 { "s" } else { "" }, short(name)),
        }
    };
    values.iter().map(listed).collect::<Vec<_>>().join("; ")
}

/// The key of a parameter without its section.
fn short(name: &str) -> &str {
    name.rsplit_once('.').map_or(name, |(_, key)| key)
}
