"""The description of the tables of a run, by frictionless.

    python package.py DIR

Prints how many files were validated; the first error ends it.
"""

import sys
from pathlib import Path

import frictionless
import pyarrow.parquet


def values(folder, resource):
    """Compares texts, integers and nulls of one file; how many nulls there are."""
    wanted = pyarrow.parquet.read_table(folder / resource.path).to_pylist()
    found = resource.read_rows()
    assert len(found) == len(wanted), resource.path
    nulls = 0
    for row, own in zip(found, wanted):
        assert list(row) == list(own), resource.path
        for column, value in own.items():
            if value is None or isinstance(value, (int, str)):
                assert row[column] == value, (resource.path, column, row[column], value)
                nulls += value is None
    return nulls


def invalid(folder, package):
    """A last part of a table without a column is an error of the validation."""
    path = [resource.path for resource in package.resources if resource.path.endswith("/steps.parquet")][-1]
    part = folder / path
    whole = part.read_bytes()
    pyarrow.parquet.write_table(pyarrow.parquet.read_table(part).drop_columns(["load_n"]), part)
    report = frictionless.Package(folder / "datapackage.json").validate()
    part.write_bytes(whole)
    assert [task.place for task in report.tasks if not task.valid] == [path], report.flatten(["name", "message"])


def main():
    folder = Path(sys.argv[1])
    package = frictionless.Package(folder / "datapackage.json")
    report = package.validate()
    assert report.valid, report.flatten(["name", "rowNumber", "fieldName", "message"])[:5]
    tables = [resource for resource in package.resources if resource.format == "parquet"]
    rows = {task.place: task.stats.get("rows") or 0 for task in report.tasks}
    assert sum(rows[table.path] for table in tables) == sum(pyarrow.parquet.read_metadata(folder / table.path).num_rows for table in tables)
    assert sorted(folder / table.path for table in tables) == sorted(folder.rglob("*.parquet"))
    nulls = sum(values(folder, table) for table in tables)
    assert nulls
    invalid(folder, package)
    print(f"{len(tables)} files, {nulls} nulls")


main()
