"""The description of the tables of a run, by frictionless.

    python package.py DIR

Prints how many files were validated; the first error ends it.
"""

import sys
from pathlib import Path

import frictionless
import pyarrow.parquet


def table(folder, path, schema):
    """Validates one file, and compares texts, integers and nulls; how many nulls there are."""
    resource = frictionless.Resource(path=path, basepath=str(folder), format="parquet", schema=frictionless.Schema.from_descriptor(schema))
    report = resource.validate()
    assert report.valid, (path, report.flatten(["rowNumber", "fieldName", "message"])[:5])
    wanted = pyarrow.parquet.read_table(folder / path).to_pylist()
    found = resource.read_rows()
    assert len(found) == len(wanted), path
    nulls = 0
    for row, own in zip(found, wanted):
        for column, value in own.items():
            if value is None or isinstance(value, (int, str)):
                assert row[column] == value, (path, column, row[column], value)
                nulls += value is None
    return nulls


def main():
    folder = Path(sys.argv[1])
    package = frictionless.Package(folder / "datapackage.json")
    report = package.validate()
    assert report.valid, report.flatten(["name", "rowNumber", "fieldName", "message"])[:5]
    # Of a resource of several Parquet files frictionless reads the first one.
    files = nulls = 0
    for resource in package.to_dict()["resources"]:
        if resource["format"] == "parquet":
            paths = resource["path"] if isinstance(resource["path"], list) else [resource["path"]]
            paths = [*paths, *resource.get("extrapaths", [])]
            for path in paths:
                nulls += table(folder, path, resource["schema"])
            files += len(paths)
    assert files == len(list(folder.rglob("*.parquet"))), files
    assert nulls
    print(f"{files} files, {nulls} nulls")


main()
