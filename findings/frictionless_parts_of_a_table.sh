#!/bin/bash
# frictionless 5.21.0 (PyPI), with pyarrow 26.0.1 and pandas 3.1.1: of a Parquet resource in several parts only the first is read.
#
# The Data Package standard (version 2, "path": a list of files) says that the files are concatenated. With three Parquet files of
# 2, 3 and 4 rows, the last without the column that the schema requires, `frictionless validate` says "valid" and counts 2 rows;
# `read_rows` returns 2 rows. The same list of CSV files is read as a whole: 9 rows. No message tells the two apart.
#
# Output seen (27 November 2026):
#   parquet, parts in one resource: valid True, 2 rows
#   csv, parts in one resource: valid True, 9 rows
#   parquet, one resource for each file: valid False, rows [2, 3, 4], errors in: c
#
# Why it matters here: `datapackage.json` of a run once listed the files of all cycles in one resource, and a damaged second file
# passed the validation. Each file is a resource of its own for that reason.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q "frictionless[parquet]==5.21.0" pandas==3.1.1 pyarrow==26.0.1
cd "$folder"
"$folder/venv/bin/python" - <<'PY'
import copy, frictionless, pandas

schema = {"fields": [{"name": "x", "type": "integer"}, {"name": "y", "type": "number", "constraints": {"required": True}}]}
parts = {name: pandas.DataFrame({"x": range(count), "y": [0.5] * count}) for name, count in [("a", 2), ("b", 3), ("c", 4)]}
for name, part in parts.items():
    part.to_csv(f"{name}.csv", index=False)
    (part.drop(columns="y") if name == "c" else part).to_parquet(f"{name}.parquet", index=False)


def resource(name, path):
    return {"name": name, "path": path, "format": str(path).strip("[]'").split(".")[-1], "schema": copy.deepcopy(schema)}


def checked(resources):
    return frictionless.Package.from_descriptor({"name": "p", "resources": resources}).validate()


together = checked([resource("t", ["a.parquet", "b.parquet", "c.parquet"])])
print(f"parquet, parts in one resource: valid {together.valid}, {together.tasks[0].stats['rows']} rows")
text = checked([resource("t", ["a.csv", "b.csv", "c.csv"])])
print(f"csv, parts in one resource: valid {text.valid}, {text.tasks[0].stats['rows']} rows")
alone = checked([resource(name, f"{name}.parquet") for name in parts])
wrong = [task.name for task in alone.tasks if not task.valid]
print(f"parquet, one resource for each file: valid {alone.valid}, rows {[task.stats['rows'] for task in alone.tasks]}, errors in: {', '.join(wrong)}")
assert together.valid and together.tasks[0].stats["rows"] == 2
assert not alone.valid and wrong == ["c"]
assert [task.stats["rows"] for task in alone.tasks][:2] == [2, 3]
PY
