//! Maintenance: `explain`, `verify`, `gc`.

use super::place::{folder, open, open_dir};
use super::{FAILED, Fault, failed, say};
use crate::campaign::{Audit, Campaign, Explanation, Leftover};
use crate::cli::{FolderArguments, OutputArguments};
use crate::stages::undecided;
use crate::store::Check;
use crate::text::{counted, shell_path, shown, visible, wrapped};
use indicatif::HumanBytes;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// A spec with this output folder.
fn output(dir: &Path) -> OutputArguments {
    OutputArguments { out: Some(dir.to_owned()), set: Vec::new(), json: false }
}

pub(super) fn explain(asked: &FolderArguments, id: &str, spec: Option<&Path>) -> Result<u8, Fault> {
    let dir = folder(asked)?;
    let campaign = match spec {
        Some(spec) => open(spec, &output(&dir))?,
        None => open_dir("explain a task of", &dir)?,
    };
    let explanations = campaign.explain(id);
    if explanations.is_empty() {
        return Err(failed(format!(
            "cannot explain {id}: unknown task of the spec and of {}\nhelp: name `{}`, `{}`, or an id listed \
             by `hysteron status {} --json`",
            shown(&dir),
            crate::campaign::STATISTICS,
            crate::campaign::REPORT_PAGE,
            shell_path(&dir)
        )));
    }
    if asked.json {
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
    let mut text = format!(
        "{stage} {id} is {state}{}\n",
        why.as_ref().map_or_else(String::new, |why| format!(": {why}"))
    );
    let Some(nearest) = nearest else {
        if *state == "planned" {
            text += "  not computed yet; no finished task of another spec to compare with\n";
        }
        return text;
    };
    // An unreferenced task exists, and the spec requests another one.
    let orphan = *state == "orphan";
    let role = if orphan { "the nearest task of the spec is" } else { "the nearest finished task is" };
    if differences.is_empty() {
        text += &format!("  {role} {nearest}, with the same parameters\n");
        return text;
    }
    text += &format!("  {role} {nearest}, which differs in\n");
    let width = differences.iter().map(|difference| difference.field.len()).max().unwrap_or(0);
    let value =
        |value: &Option<Value>| value.as_ref().map_or_else(|| "nothing".to_owned(), ToString::to_string);
    for difference in differences {
        let (here, there) = (value(&difference.here), value(&difference.there));
        let (requested, existing) = if orphan { (there, here) } else { (here, there) };
        text += &format!(
            "  {:width$}  requested {requested}, existing {existing} (read by {})\n",
            difference.field, difference.read_by
        );
    }
    text
}

pub(super) fn verify(asked: &FolderArguments, deep: bool) -> Result<u8, Fault> {
    let campaign = open_dir("verify", &folder(asked)?)?;
    let audit = campaign.audit(if deep { Check::Contents } else { Check::Sizes });
    let faults = audit.fault_count();
    if asked.json {
        say(&format!("{:#}\n", json!(audit)))?;
    } else {
        for fault in &audit.faults {
            say(&format!("{}\n", visible(fault)))?;
        }
        say(&listed(
            &audit.unreceipted,
            "task has results and no receipt",
            "tasks have results and no receipt",
        ))?;
        say(&listed(&audit.unnamed, "file is named by no receipt", "files are named by no receipt"))?;
        let compared = if deep { "contents" } else { "sizes" };
        let counts = [(audit.receipt_count, "receipt"), (audit.file_count, "file")]
            .map(|(count, noun)| counted(count, noun));
        say(&format!("{}, {}: {compared} compared, ", counts.join(", "), HumanBytes(audit.size_bytes)))?;
        say(&match faults {
            0 => "no fault.\n".to_owned(),
            faults => {
                format!("{}.\n{}", counted(faults, "fault"), wrapped(&repairs(&audit, &campaign.dir), "  "))
            }
        })?;
    }
    Ok(if faults == 0 { 0 } else { FAILED })
}

/// Actions against the faults of an audit, as a paragraph.
pub(super) fn repairs(audit: &Audit, dir: &Path) -> String {
    let dir = shell_path(dir);
    let (left_over, others) = (audit.left_over.len(), audit.unnamed.len() - audit.left_over.len());
    let is_of_tasks = !(audit.faults.is_empty() && audit.unreceipted.is_empty());
    let run = is_of_tasks.then(|| format!("`hysteron run {dir}` repairs the tasks of its spec."));
    let gc = (left_over > 0).then(|| {
        format!(
            "`hysteron gc {dir} --delete` deletes {} of earlier runs, and all other results that the spec \
             does not name; without --delete it lists them.",
            counted(left_over, "file")
        )
    });
    let by_hand =
        (others > 0).then(|| format!("Move {} of other origin out of the folder.", counted(others, "file")));
    [run, gc, by_hand].into_iter().flatten().collect::<Vec<_>>().join(" ")
}

/// Maximum number of listed names.
const LISTED: usize = 20;

/// The first names below a heading.
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

pub(super) fn gc(asked: &FolderArguments, keep: &[PathBuf], delete: bool) -> Result<u8, Fault> {
    let dir = folder(asked)?;
    let campaign = open_dir("clean", &dir)?;
    if let Some(why) = campaign.spec_fault().filter(|_| delete) {
        let dir = shown(&dir);
        return Err(failed(format!("cannot clean {dir}: {why}\nhelp: run `hysteron run SPEC` first")));
    }
    let others =
        keep.iter().map(|spec| open(spec, &output(&dir))).collect::<Result<Vec<Campaign>, Fault>>()?;
    let unknown = unknown_files(&campaign, &others, delete);
    if let Some(why) = unknown.as_ref().filter(|_| delete) {
        let help = "finish the runs of the folder, and of --keep, with `hysteron run`";
        return Err(failed(format!("cannot clean {}: {why}\nhelp: {help}", shown(&dir))));
    }
    let leftovers = campaign.leftovers(&others);
    let bytes: u64 = leftovers.iter().map(|left| left.size_bytes).sum();
    let name =
        |left: &Leftover| left.path.strip_prefix(&dir).unwrap_or(&left.path).to_string_lossy().into_owned();
    if delete {
        for left in &leftovers {
            left.remove().map_err(|error| {
                failed(format!(
                    "cannot delete {}: {error}\nhelp: the files listed before it are deleted; repeat the \
                     command for the others",
                    shown(&left.path)
                ))
            })?;
        }
    }
    if asked.json {
        let units: Vec<Value> = leftovers
            .iter()
            .map(|left| json!({ "path": name(left), "size_bytes": left.size_bytes, "why": left.why }))
            .collect();
        say(&format!("{:#}\n", json!({ "deleted": delete, "size_bytes": bytes, "leftovers": units })))?;
        return Ok(0);
    }
    for left in &leftovers {
        say(&format!("{} ({}): {}\n", visible(&name(left)), HumanBytes(left.size_bytes), left.why))?;
    }
    say(&match (leftovers.len(), delete) {
        (0, _) => "Nothing is left over: all files are referenced.\n".to_owned(),
        (count, true) => format!("{count} deleted, {}.\n", HumanBytes(bytes)),
        (count, false) => {
            format!("{count} left over, {}; nothing was deleted. Delete with --delete.\n", HumanBytes(bytes))
        }
    })?;
    let warning = unknown
        .filter(|_| !leftovers.is_empty())
        .map(|why| wrapped(&format!("warning: {why}: some of them may be in use"), "  "));
    say(&warning.unwrap_or_default())?;
    Ok(0)
}

/// Why the files of some specs are not known yet; nothing if they are. Contents are compared before files are
/// deleted.
fn unknown_files(campaign: &Campaign, others: &[Campaign], delete: bool) -> Option<String> {
    let check = if delete { Check::Contents } else { Check::Sizes };
    let open =
        others.iter().chain([campaign]).map(|of| undecided(of, check)).max().filter(|open| *open > 0)?;
    let are = if open == 1 { "is" } else { "are" };
    let cycles = counted(open, "cycle");
    Some(format!("{cycles} {are} pending, and grids or surfaces follow from the results"))
}
