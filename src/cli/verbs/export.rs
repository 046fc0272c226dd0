//! `export`: files that other programs run or publish a campaign with.

use super::care::repairs;
use super::outputs::{may_replace, written};
use super::place::{folder, open, open_dir, script_path, spec_file};
use super::{BAD_SPEC, Fault, failed, make_folder, own_file, say};
use crate::campaign::Standing;
use crate::cli::{FolderArguments, OutputArguments};
use crate::engines::snakemake::Origin;
use crate::engines::{ro_crate as description, ro_crate::Publication, snakemake as rules, usual_shards};
use crate::stages;
use crate::store::Check;
use crate::text::{counted, shell_path, shown};
use serde_json::json;
use std::path::Path;
use std::time::SystemTime;

/// Mark of an exported Snakefile.
const SNAKEFILE_MARK: &str = "`hysteron export snakemake` wrote this file.";

pub(super) fn snakemake(
    spec: &Path,
    output: &OutputArguments,
    shards: Option<u32>,
    force: bool,
) -> Result<u8, Fault> {
    let mut campaign = open(spec, output)?;
    campaign.dir = script_path(&campaign.dir)?;
    stages::prepare(&campaign).map_err(failed)?;
    let folder = campaign.dir.join("snakemake");
    make_folder(&folder)?;
    let program = own_file()?;
    let origin = Origin {
        spec: &script_path(&spec_file(spec))?,
        settings: &output.set,
        folder: &script_path(Path::new("."))?,
    };
    let shards = shards.map_or_else(|| usual_shards(&campaign), |count| count as usize);
    let path = folder.join("Snakefile");
    let files = [(path.clone(), rules::snakefile(&campaign, &origin, &program, shards).into_bytes())];
    let is_own = std::fs::read_to_string(&path).is_ok_and(|text| text.contains(SNAKEFILE_MARK));
    may_replace("the Snakefile", &files, force || is_own)?;
    written("write the Snakefile", &files)?;
    if output.json {
        say(&format!("{:#}\n", json!({ "file": path.display().to_string(), "shard_count": shards })))?;
    } else {
        say(&format!(
            "Written: {}\nRun it with `snakemake --snakefile {} --cores 2`\n",
            shown(&path),
            shell_path(&path)
        ))?;
    }
    Ok(0)
}

pub(super) fn ro_crate(
    asked: &FolderArguments,
    license: Option<&str>,
    publisher: Option<&str>,
    force: bool,
) -> Result<u8, Fault> {
    let license = license
        .map(description::licence)
        .transpose()
        .map_err(|text| Fault { code: BAD_SPEC, text: format!("error: {text}") })?;
    let dir = folder(asked)?;
    let campaign = open_dir("describe", &dir)?;
    let audit = campaign.audit(Check::Contents);
    if let Some(fault) = audit.first_fault() {
        return Err(failed(format!(
            "cannot describe {}: {fault}\n\
             help: `hysteron verify {} --deep` lists all faults. {}",
            shown(&dir),
            shell_path(&dir),
            repairs(&audit, &dir)
        )));
    }
    let day: String =
        humantime::format_rfc3339_seconds(SystemTime::now()).to_string().chars().take(10).collect();
    let publication = Publication { day: &day, licence: license.as_deref(), publisher };
    let text = description::metadata(&campaign, &campaign.all_receipts(), &publication);
    let path = dir.join("ro-crate-metadata.json");
    let files = [(path.clone(), text.into_bytes())];
    may_replace("the metadata", &files, force)?;
    written("write the metadata", &files)?;
    if asked.json {
        say(&format!(
            "{:#}\n",
            json!({ "file": path.display().to_string(), "file_count": audit.file_count })
        ))?;
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
