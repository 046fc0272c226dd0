"""Every table of a run, read by the programs that people read tables with: the same columns, types, values and nulls in all of them.

    python readers.py DIR

Says how many tables and values were compared; the first difference ends it.
"""

import json
import math
import sys
import tempfile
from pathlib import Path

import duckdb
import h5py
import numpy
import pandas
import polars
import pyarrow
import pyarrow.parquet
import pyfive
import xarray

KINDS = {
    pyarrow.float64(): (polars.Float64, "Float64", "DOUBLE"),
    pyarrow.int64(): (polars.Int64, "Int64", "BIGINT"),
    pyarrow.bool_(): (polars.Boolean, "boolean", "BOOLEAN"),
    pyarrow.string(): (polars.String, "string", "VARCHAR"),
}


def plain(kind):
    """A column's type, whether its words stand in a dictionary or not."""
    return kind.value_type if pyarrow.types.is_dictionary(kind) else kind


def table(path):
    """Compares one table; the number of its values."""
    arrow = pyarrow.parquet.read_table(path)
    names = arrow.schema.names
    columns = {name: arrow.column(name).to_pylist() for name in names}
    kinds = {name: KINDS[plain(arrow.schema.field(name).type)] for name in names}

    frame = polars.read_parquet(path)
    assert frame.columns == names, path
    for name in names:
        own = frame[name].dtype
        own = polars.String if own in (polars.Categorical, polars.Enum) else own
        assert own == kinds[name][0], (path, name, frame[name].dtype)
        assert frame[name].cast(kinds[name][0]).to_list() == columns[name], (path, name, "polars")

    panda = pandas.read_parquet(path, dtype_backend="numpy_nullable")
    assert list(panda.columns) == names, path
    for name in names:
        values = [None if value is pandas.NA or value is None else value for value in panda[name].astype(object)]
        assert values == columns[name], (path, name, "pandas")

    answer = duckdb.sql(f"select * from read_parquet('{path}')")
    assert answer.columns == names, path
    assert [str(kind) for kind in answer.types] == [kinds[name][2] for name in names], (path, answer.types)
    rows = answer.fetchall()
    for at, name in enumerate(names):
        assert [row[at] for row in rows] == columns[name], (path, name, "duckdb")

    # What each column means travels with it, and once more with the file, for those who do not see the first.
    described = json.loads(pyarrow.parquet.read_metadata(path).metadata[b"hysteron"])
    for schema in [arrow.schema, pyarrow.parquet.read_schema(path)]:
        assert json.loads(schema.metadata[b"hysteron"]) == described, path
    assert described["key"] and described["version"] == 1, path
    for field in arrow.schema:
        told = {key.decode(): value.decode() for key, value in field.metadata.items()}
        assert told["description"], (path, field.name)
        assert field.nullable or None not in columns[field.name], (path, field.name)
        if plain(field.type) == pyarrow.float64():
            assert "unit" in told, (path, field.name)
    assert described, path
    # No number is not one: what is missing is null.
    for name in names:
        assert all(not isinstance(value, float) or math.isfinite(value) for value in columns[name]), (path, name)
    return arrow.num_rows * arrow.num_columns


def surface(path, folder):
    """A surface by h5py and by xarray; the number of its heights."""
    with h5py.File(path) as file:
        heights = file["height_m"][:]
        told = dict(file.attrs)
        # Texts are str, and the axes have their coordinates.
        assert [type(told[name]) for name in ["key", "normalization", "amplitudes"]] == [str] * 3, told
        assert file["height_m"].attrs["unit"] == "m", path
        points = numpy.arange(len(heights)) * told["length_m"] / len(heights)
        for name, axis in zip(["x_m", "y_m"], file["height_m"].dims):
            assert axis.label == name and axis.keys() == [name] and file[name].is_scale, (path, name)
            assert numpy.allclose(axis[name][:], points, rtol=1e-15, atol=0), (path, name)
    assert heights.dtype == numpy.float64 and heights.shape[0] == heights.shape[1], path
    rms = float(numpy.sqrt(numpy.mean((heights - heights.mean()) ** 2)))
    assert abs(rms - told["rms_height_m"]) < 1e-9 * rms, (path, rms, told["rms_height_m"])
    for engine in ["h5netcdf", "netcdf4"]:
        with xarray.open_dataset(path, engine=engine) as dataset:
            assert dataset["height_m"].dims == ("x_m", "y_m") and list(dataset.coords) == ["x_m", "y_m"], (path, engine)
            assert numpy.array_equal(dataset["height_m"].values, heights), (path, engine)
            assert numpy.allclose(dataset["x_m"].values, points, rtol=1e-15, atol=0), (path, engine)
            assert dataset.attrs["rms_height_m"] == told["rms_height_m"], (path, engine)
            assert dataset.attrs["normalization"] == told["normalization"], (path, engine)
            # A NetCDF file has every attribute: there are no booleans, which it could not hold.
            copy = Path(folder) / f"{engine}.nc"
            dataset.to_netcdf(copy)
            with xarray.open_dataset(copy) as written:
                assert written.attrs.keys() == told.keys() and written.attrs["periodic"] == 1, (path, engine)
    # A reader without the HDF5 library.
    with pyfive.File(path) as file:
        assert file.attrs.keys() == told.keys() and numpy.array_equal(file["height_m"][:], heights), path
    return heights.size


def main():
    folder = Path(sys.argv[1])
    tables = sorted(folder.rglob("*.parquet"))
    surfaces = sorted(folder.rglob("*.h5"))
    assert tables and surfaces, folder
    values = sum(table(path) for path in tables)
    with tempfile.TemporaryDirectory() as copies:
        heights = sum(surface(path, copies) for path in surfaces)
    print(f"{len(tables)} tables, {values} values; {len(surfaces)} surfaces, {heights} heights")


main()
