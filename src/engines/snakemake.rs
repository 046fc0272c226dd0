//! Snakemake: a Snakefile with one rule for each stage, whose jobs are shards. Its executors reach the schedulers that this program does not.

use crate::campaign::Campaign;
use std::path::Path;

/// The Snakefile. What is done is told by empty files below `snakemake/`, and by the program itself, which skips what is done whatever Snakemake thinks.
#[must_use]
pub fn snakefile(campaign: &Campaign, program: &Path, shards: usize) -> String {
    let python = |path: &Path| serde_json::Value::from(path.display().to_string()).to_string();
    let (name, dir, program) = (&campaign.spec.name, python(&campaign.dir), python(program));
    let mut text = format!(
        "# The campaign {name} in {shards} shards. `hysteron export snakemake` wrote this file.\n\
         HYSTERON = {program}\nDIR = {dir}\nSHARDS = {shards}\n\n\
         rule all:\n    input: f\"{{DIR}}/snakemake/report.done\"\n"
    );
    let mut before = "f\"{DIR}/campaign.toml\"".to_owned();
    for stage in ["generate", "extract", "cycle"] {
        text.push_str(&format!(
            "\nrule {stage}:\n    input: {before}\n    output: touch(f\"{{DIR}}/snakemake/{stage}-{{{{shard}}}}.done\")\n    \
             params: program=HYSTERON, dir=DIR, shards=SHARDS\n    \
             shell: \"{{params.program:q}} {stage} {{params.dir:q}}/campaign.toml --out {{params.dir:q}} --jobs {{threads}} \"\n           \
             \"--shard {{wildcards.shard}}/{{params.shards}}{}\"\n",
            // A failed case is recorded and counted; the others go on.
            if stage == "cycle" { " || [ $? -eq 3 ]" } else { "" }
        ));
        before = format!("f\"{{DIR}}/snakemake/{stage}-{{{{shard}}}}.done\"");
    }
    text.push_str(
        "\nrule report:\n    input: expand(f\"{DIR}/snakemake/cycle-{{shard}}.done\", shard=range(SHARDS))\n    \
         output: touch(f\"{DIR}/snakemake/report.done\")\n    params: program=HYSTERON, dir=DIR\n    \
         shell: \"{params.program:q} aggregate {params.dir:q}/campaign.toml --out {params.dir:q} && \"\n           \
         \"{params.program:q} report {params.dir:q}/campaign.toml --out {params.dir:q}\"\n",
    );
    text
}
