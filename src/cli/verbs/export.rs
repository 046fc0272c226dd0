//! `export`: files that other programs run or publish a campaign with.

use super::place::{folder, open, open_dir, told};
use super::{BAD_SPEC, Fault, failed, make_folder, own_file, say};
use crate::campaign::Standing;
use crate::cli::{FolderArguments, OutputArguments};
use crate::engines::{ro_crate as description, snakemake as rules, usual_shards};
use crate::stages;
use crate::store::{Check, commit};
use crate::text::{counted, shell_path, shown};
use serde_json::json;
use std::path::Path;
use std::time::SystemTime;

pub(super) fn snakemake(spec: &Path, output: &OutputArguments, shards: Option<u32>) -> Result<u8, Fault> {
    let mut campaign = open(spec, output)?;
    campaign.dir = told(&campaign.dir)?;
    stages::prepare(&campaign).map_err(failed)?;
    let folder = campaign.dir.join("snakemake");
    make_folder(&folder)?;
    let program = own_file()?;
    let shards = shards.map_or_else(|| usual_shards(&campaign), |count| count as usize);
    let path = folder.join("Snakefile");
    commit::commit_bytes("write the Snakefile", &path, rules::snakefile(&campaign, &program, shards).as_bytes()).map_err(failed)?;
    if output.json {
        say(&format!("{:#}\n", json!({ "file": path.display().to_string(), "shard_count": shards })))?;
    } else {
        say(&format!("Written: {}\nRun it with `snakemake --snakefile {} --cores 2`\n", shown(&path), shell_path(&path)))?;
    }
    Ok(0)
}

pub(super) fn ro_crate(asked: &FolderArguments, license: Option<&str>) -> Result<u8, Fault> {
    let license = license.map(description::licence).transpose().map_err(|text| Fault { code: BAD_SPEC, text: format!("error: {text}") })?;
    let dir = folder(asked)?;
    let campaign = open_dir("describe", &dir)?;
    let audit = campaign.audit(Check::Sizes);
    if let Some(fault) = audit.first_fault() {
        return Err(failed(format!(
            "cannot describe {}: {fault}\nhelp: `hysteron verify` lists all faults; `hysteron run` repairs its tasks, `hysteron gc --delete` removes other files",
            shown(&dir)
        )));
    }
    let day: String = humantime::format_rfc3339_seconds(SystemTime::now()).to_string().chars().take(10).collect();
    let text = description::metadata(&campaign, &campaign.all_receipts(), &day, license.as_deref());
    let path = dir.join("ro-crate-metadata.json");
    commit::commit_bytes("write the description", &path, text.as_bytes()).map_err(failed)?;
    if asked.json {
        say(&format!("{:#}\n", json!({ "file": path.display().to_string(), "file_count": audit.file_count })))?;
        return Ok(0);
    }
    say(&format!("Written: {}, which describes {}.\n", shown(&path), counted(audit.file_count, "file")))?;
    if campaign.survey(Check::Sizes).report != Standing::Done {
        say("warning: the run is not finished, or its report is out of date\n")?;
    }
    if license.is_none() {
        say("A published crate needs a licence: --license CC-BY-4.0, for instance.\n")?;
    }
    Ok(0)
}
