
import json
import os
import subprocess
import uuid

from snakemake.exceptions import WorkflowError


def pending():
    """Pending tasks by stage and shard, from `hysteron plan`: new parameters, lost files, damaged files. Failed tasks are not repeated."""
    command = [HYSTERON, "plan", SPEC, *SETTINGS, "--out", DIR, "--json"]
    answer = subprocess.run(command, cwd=FOLDER, capture_output=True, encoding="utf-8", errors="replace")
    if answer.returncode != 0:
        raise WorkflowError(answer.stderr.strip())
    stages = {stage["stage"]: stage["units"] for stage in json.loads(answer.stdout)["stages"]}
    shard = {unit["id"]: k % SHARDS for k, unit in enumerate(stages["generate"])}
    found = {f"{stage}-{k}": [] for stage in ("generate", "extract", "cycle") for k in range(SHARDS)} | {"report": []}
    for stage, units in stages.items():
        for unit in units:
            if unit["state"] not in ("done", "failed"):
                name = f"{stage}-{shard[unit.get('surface', unit['id'])]}" if stage in ("generate", "extract", "cycle") else "report"
                found[name].append(unit["id"])
    return found


# Pending tasks are inputs of the rules: a new list, which begins with a new word, starts the rule. Jobs read this file too; only the first process writes.
if getattr(workflow, "is_main_process", True):
    os.makedirs(f"{DIR}/snakemake", exist_ok=True)
    for name, tasks in pending().items():
        path = f"{DIR}/snakemake/{name}.pending"
        if tasks or not os.path.exists(path):
            with open(path, "w", encoding="utf-8") as file:
                file.write("\n".join([uuid.uuid4().hex, *tasks]) + "\n" if tasks else "")


rule all:
    input: f"{DIR}/snakemake/report.done"


rule generate:
    input: spec=SPEC, pending=f"{DIR}/snakemake/generate-{{shard}}.pending"
    output: touch(f"{DIR}/snakemake/generate-{{shard}}.done")
    params: program=HYSTERON, spec=SPEC, settings=SETTINGS, dir=DIR, folder=FOLDER, shards=SHARDS
    # A failed task is recorded, and the others are computed: exit code 3.
    shell: "cd {params.folder:q} && {params.program:q} generate {params.spec:q} {params.settings:q} --out {params.dir:q} --jobs {threads} "
           "--shard {wildcards.shard}/{params.shards} || [ $? -eq 3 ]"


rule extract:
    input: f"{DIR}/snakemake/generate-{{shard}}.done", spec=SPEC, pending=f"{DIR}/snakemake/extract-{{shard}}.pending"
    output: touch(f"{DIR}/snakemake/extract-{{shard}}.done")
    params: program=HYSTERON, spec=SPEC, settings=SETTINGS, dir=DIR, folder=FOLDER, shards=SHARDS
    shell: "cd {params.folder:q} && {params.program:q} extract {params.spec:q} {params.settings:q} --out {params.dir:q} --jobs {threads} "
           "--shard {wildcards.shard}/{params.shards} || [ $? -eq 3 ]"


rule cycle:
    input: f"{DIR}/snakemake/extract-{{shard}}.done", spec=SPEC, pending=f"{DIR}/snakemake/cycle-{{shard}}.pending"
    output: touch(f"{DIR}/snakemake/cycle-{{shard}}.done")
    params: program=HYSTERON, spec=SPEC, settings=SETTINGS, dir=DIR, folder=FOLDER, shards=SHARDS
    shell: "cd {params.folder:q} && {params.program:q} cycle {params.spec:q} {params.settings:q} --out {params.dir:q} --jobs {threads} "
           "--shard {wildcards.shard}/{params.shards} || [ $? -eq 3 ]"


rule report:
    input: expand(f"{DIR}/snakemake/cycle-{{shard}}.done", shard=range(SHARDS)), spec=SPEC, pending=f"{DIR}/snakemake/report.pending"
    output: touch(f"{DIR}/snakemake/report.done")
    params: program=HYSTERON, spec=SPEC, settings=SETTINGS, dir=DIR, folder=FOLDER
    shell: "cd {params.folder:q} && {params.program:q} aggregate {params.spec:q} {params.settings:q} --out {params.dir:q} && "
           "{params.program:q} report {params.spec:q} {params.settings:q} --out {params.dir:q}"
