//! The verbs that look after what is there: `explain`, `verify`, `gc`.

use super::{FAILED, Fault, failed, open, open_dir, say};
use crate::campaign::{Campaign, Explanation, Leftover};
use crate::cli::{FolderArguments, OutputArguments};
use crate::store::Check;
use crate::text::{counted, shell_path, shown, visible};
use indicatif::HumanBytes;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

pub(super) fn explain(folder: &FolderArguments, id: &str, spec: Option<&Path>) -> Result<u8, Fault> {
    let campaign = match spec {
        Some(spec) => open(spec, &OutputArguments { out: Some(folder.dir.clone()), json: false })?,
        None => open_dir("explain a task of", &folder.dir)?,
    };
    let explanations = campaign.explain(id);
    if explanations.is_empty() {
        return Err(failed(format!(
            "cannot explain {id}: neither the spec nor {} has such a task; allowed: `{}`, `{}`, or an id as `hysteron status {} --json` lists them",
            shown(&folder.dir),
            crate::campaign::STATISTICS,
            crate::campaign::REPORT_PAGE,
            shell_path(&folder.dir)
        )));
    }
    if folder.json {
        say(&format!("{:#}\n", json!(explanations)))?;
    } else {
        for explanation in &explanations {
            say(&sentences(explanation))?;
        }
    }
    Ok(0)
}

fn sentences(explanation: &Explanation) -> String {
    let Explanation { stage, id, state, why, nearest, differences } = explanation;
    let mut text = format!("{stage} {id} is {state}{}\n", why.as_ref().map_or_else(String::new, |why| format!(": {why}")));
    let Some(nearest) = nearest else {
        if *state == "planned" {
            text += "  no task of this stage is done, so that there is none to compare it with\n";
        }
        return text;
    };
    let (role, own) = if *state == "orphan" { ("the spec's nearest is", "orphan") } else { ("the nearest that is done is", "it") };
    if differences.is_empty() {
        text += &format!("  {role} {nearest}, which differs in nothing that a stage reads\n");
        return text;
    }
    text += &format!("  {role} {nearest}, which differs in\n");
    let width = differences.iter().map(|difference| difference.field.len()).max().unwrap_or(0);
    let value = |value: &Option<Value>| value.as_ref().map_or_else(|| "nothing".to_owned(), ToString::to_string);
    for difference in differences {
        let (here, there) = (value(&difference.here), value(&difference.there));
        text += &format!("  {:width$}  {own} has {here}, that has {there} (read by {})\n", difference.field, difference.read_by);
    }
    text
}

pub(super) fn verify(folder: &FolderArguments, deep: bool) -> Result<u8, Fault> {
    let campaign = open_dir("verify", &folder.dir)?;
    let audit = campaign.audit(if deep { Check::Contents } else { Check::Sizes });
    let faults = audit.fault_count();
    if folder.json {
        say(&format!("{:#}\n", json!(audit)))?;
    } else {
        for fault in &audit.faults {
            say(&format!("{}\n", visible(fault)))?;
        }
        say(&listed(&audit.unreceipted, "task has results and no receipt", "tasks have results and no receipt"))?;
        say(&listed(&audit.unnamed, "file is named by no receipt", "files are named by no receipt"))?;
        let compared = if deep { "contents" } else { "lengths (--deep compares contents)" };
        let counts = [(audit.receipt_count, "receipt"), (audit.file_count, "file")].map(|(count, noun)| counted(count, noun));
        say(&format!("{}, {}: {compared} compared, ", counts.join(", "), HumanBytes(audit.size_bytes)))?;
        say(&match faults {
            0 => "all as they were written.\n".to_owned(),
            faults => format!(
                "{}. `hysteron run` with the spec repairs its own tasks; remove other files by hand or with `hysteron gc`.\n",
                counted(faults, "fault")
            ),
        })?;
    }
    Ok(if faults == 0 { 0 } else { FAILED })
}

/// Names that are listed at most.
const LISTED: usize = 20;

/// Names below their heading, the first ones of many.
fn listed(names: &[String], one: &str, many: &str) -> String {
    if names.is_empty() {
        return String::new();
    }
    let mut text = format!("{} {}:\n", names.len(), if names.len() == 1 { one } else { many });
    names.iter().take(LISTED).for_each(|name| text += &format!("  {}\n", visible(name)));
    if names.len() > LISTED {
        text += &format!("  … and {} more\n", names.len() - LISTED);
    }
    text
}

pub(super) fn gc(folder: &FolderArguments, keep: &[PathBuf], delete: bool) -> Result<u8, Fault> {
    let campaign = open_dir("clear up", &folder.dir)?;
    if let Some(why) = campaign.spec_fault().filter(|_| delete) {
        let dir = shown(&folder.dir);
        return Err(failed(format!(
            "cannot clear up {dir}: {why}, so that it does not tell what is to stay; allowed: after a `hysteron run` of the spec"
        )));
    }
    let output = OutputArguments { out: Some(folder.dir.clone()), json: false };
    let others = keep.iter().map(|spec| open(spec, &output)).collect::<Result<Vec<Campaign>, Fault>>()?;
    let leftovers = campaign.leftovers(&others);
    let bytes: u64 = leftovers.iter().map(|left| left.size_bytes).sum();
    let name = |left: &Leftover| left.path.strip_prefix(&folder.dir).unwrap_or(&left.path).to_string_lossy().into_owned();
    if delete {
        for left in &leftovers {
            left.remove()
                .map_err(|error| failed(format!("cannot delete {}: {error}; what was listed before it is gone", shown(&left.path))))?;
        }
    }
    if folder.json {
        let units: Vec<Value> =
            leftovers.iter().map(|left| json!({ "path": name(left), "size_bytes": left.size_bytes, "why": left.why })).collect();
        say(&format!("{:#}\n", json!({ "deleted": delete, "size_bytes": bytes, "leftovers": units })))?;
        return Ok(0);
    }
    for left in &leftovers {
        say(&format!("{} ({}): {}\n", visible(&name(left)), HumanBytes(left.size_bytes), left.why))?;
    }
    say(&match (leftovers.len(), delete) {
        (0, _) => "Nothing is left over.\n".to_owned(),
        (count, true) => format!("{count} deleted, {}.\n", HumanBytes(bytes)),
        (count, false) => format!("{count} left over, {}; nothing was deleted: --delete does that.\n", HumanBytes(bytes)),
    })?;
    Ok(0)
}
