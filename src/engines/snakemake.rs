//! Snakemake: a Snakefile with one rule for each stage, whose jobs are shards. Its executors reach the
//! schedulers that this program does not.

use crate::campaign::Campaign;
use serde_json::json;
use std::path::Path;

/// The rules. Their outputs are empty files; the spec and the lists of pending tasks are their inputs.
const RULES: &str = include_str!("snakefile.smk");

/// Origin of a campaign, from which every job reads its spec.
#[derive(Debug, Clone, Copy)]
pub struct Origin<'a> {
    /// The spec.
    pub spec: &'a Path,
    /// Settings (`--set`) that replace values of the spec.
    pub settings: &'a [String],
    /// Working directory in which the spec was read: relative names in it may start there.
    pub folder: &'a Path,
}

/// The Snakefile.
#[must_use]
pub fn snakefile(campaign: &Campaign, origin: &Origin<'_>, program: &Path, shards: usize) -> String {
    // A JSON string is one of Python too.
    let python = |path: &Path| json!(path.display().to_string()).to_string();
    let settings: Vec<String> = origin.settings.iter().map(|setting| format!("--set={setting}")).collect();
    format!(
        "# The campaign {} in {shards} shards. `hysteron export snakemake` wrote this file, for Snakemake 8 \
         and later.\n\
         HYSTERON = {}\nSPEC = {}\nSETTINGS = {}\nFOLDER = {}\nDIR = {}\nSHARDS = {shards}\n{RULES}",
        campaign.spec.name,
        python(program),
        python(origin.spec),
        json!(settings),
        python(origin.folder),
        python(&campaign.dir),
    )
}
