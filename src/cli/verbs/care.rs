//! The verbs that look after what is there: `explain`, `verify`, `gc`.

use super::{FAILED, Fault, failed, open, open_dir, say};
use crate::campaign::{Campaign, Explanation, Leftover};
use crate::cli::{FolderArguments, OutputArguments};
use crate::store::Check;
use indicatif::{HumanBytes, HumanCount};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

pub(super) fn explain(folder: &FolderArguments, id: &str, spec: Option<&Path>) -> Result<u8, Fault> {
    let campaign = match spec {
        Some(spec) => open(spec, &OutputArguments { out: Some(folder.dir.clone()), json: false })?,
        None => open_dir("explain a unit of", &folder.dir)?,
    };
    let explanations = campaign.explain(id);
    if explanations.is_empty() {
        return Err(failed(format!(
            "cannot explain {id}: neither the spec nor {} knows such a unit; allowed: `{}`, `{}`, or an id as `hysteron status {} --json` lists them",
            folder.dir.display(),
            crate::campaign::STATISTICS,
            crate::campaign::REPORT_PAGE,
            folder.dir.display()
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
            text += "  no unit of this stage is done, so that there is none to compare it with\n";
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
    if folder.json {
        say(&format!("{:#}\n", json!(audit)))?;
    } else {
        for fault in &audit.faults {
            say(&format!("{fault}\n"))?;
        }
        let compared = if deep { "contents" } else { "lengths (--deep compares contents)" };
        let (receipts, files) = (HumanCount(audit.receipt_count as u64), HumanCount(audit.file_count as u64));
        say(&format!("{receipts} receipts, {files} files, {}: {compared} compared, ", HumanBytes(audit.size_bytes)))?;
        say(&match audit.faults.len() {
            0 => "all as they were written.\n".to_owned(),
            faults => format!("{faults} faults. `hysteron run` with the spec makes what it names again.\n"),
        })?;
    }
    Ok(if audit.faults.is_empty() { 0 } else { FAILED })
}

pub(super) fn gc(folder: &FolderArguments, keep: &[PathBuf], delete: bool) -> Result<u8, Fault> {
    let campaign = open_dir("clear up", &folder.dir)?;
    if let Some(why) = campaign.spec_fault().filter(|_| delete) {
        let dir = folder.dir.display();
        return Err(failed(format!(
            "cannot clear up {dir}: {why}, so that it does not tell what is to stay; allowed: after a `hysteron run` of the spec"
        )));
    }
    let output = OutputArguments { out: Some(folder.dir.clone()), json: false };
    let others = keep.iter().map(|spec| open(spec, &output)).collect::<Result<Vec<Campaign>, Fault>>()?;
    let leftovers = campaign.leftovers(&others);
    let bytes: u64 = leftovers.iter().map(|left| left.size_bytes).sum();
    let name = |left: &Leftover| left.path.strip_prefix(&folder.dir).unwrap_or(&left.path).display().to_string();
    if delete {
        for left in &leftovers {
            left.remove()
                .map_err(|error| failed(format!("cannot delete {}: {error}; what was listed before it is gone", left.path.display())))?;
        }
    }
    if folder.json {
        let units: Vec<Value> =
            leftovers.iter().map(|left| json!({ "path": name(left), "size_bytes": left.size_bytes, "why": left.why })).collect();
        say(&format!("{:#}\n", json!({ "deleted": delete, "size_bytes": bytes, "leftovers": units })))?;
        return Ok(0);
    }
    for left in &leftovers {
        say(&format!("{} ({}): {}\n", name(left), HumanBytes(left.size_bytes), left.why))?;
    }
    say(&match (leftovers.len(), delete) {
        (0, _) => "Nothing is left over.\n".to_owned(),
        (count, true) => format!("{count} deleted, {}.\n", HumanBytes(bytes)),
        (count, false) => format!("{count} left over, {}; nothing was deleted: --delete does that.\n", HumanBytes(bytes)),
    })?;
    Ok(0)
}
