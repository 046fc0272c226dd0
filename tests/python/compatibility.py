"""Other programs on the files of a finished run: a table in Markdown for the guide.

    python tests/python/compatibility.py PROGRAM RUN

Makes an environment with the packages below in a temporary folder, reads every file of the run with each of them, and compares the values with those of
pyarrow and h5py. RUN has a cycle by boundary elements. With `npm` the readers of JavaScript are compared too. PROGRAM exports surfaces and metadata.
"""

import json
import shutil
import subprocess
import sys
import tempfile
import venv
from pathlib import Path

PACKAGES = [
    "pyarrow==26.0.1", "polars==2.1.0", "pandas==3.1.1", "duckdb==2.0.1", "datafusion==55.0.0", "chdb==4.4.0", "fastparquet==2026.9.0", "h5py==3.16.0",
    "netCDF4==1.7.5.1", "h5netcdf==1.8.2", "xarray==2026.9.0", "pyfive==1.3.0", "scipy==1.17.1", "SurfaceTopography==1.27.1",
    "frictionless[parquet]==5.21.0",
]  # fmt: skip
NODE = ["hyparquet@1.31.5", "hyparquet-compressors", "h5wasm@0.10.3", "jsfive@0.4.2", "netcdfjs@4.0.0"]

TABLES = '''
import json, sys
from pathlib import Path

import numpy, pyarrow.parquet

files = sorted(str(path) for path in Path(sys.argv[2]).rglob("*.parquet"))


def sums(columns):
    """Sum of each column of numbers, without missing values: in the order of the columns, digits do not depend on the reader."""
    found = {}
    for name, values in columns.items():
        array = numpy.asarray(values, dtype=object)
        numbers = [float(value) for value in array if value is not None and not isinstance(value, (str, bytes, bool, numpy.bool_)) and value == value]
        if len(numbers) and not any(isinstance(value, (str, bytes)) for value in array):
            found[name] = sum(numbers)
    return found


def reference(path):
    return {name: column.to_pylist() for name, column in zip(*(lambda t: (t.column_names, t.columns))(pyarrow.parquet.read_table(path)))}


def polars(path):
    import polars
    return polars.read_parquet(path).to_dict(as_series=False)


def pandas(path):
    import pandas
    return {name: column.to_numpy() for name, column in pandas.read_parquet(path).items()}


def duckdb(path):
    import duckdb
    return duckdb.read_parquet(path).to_arrow_table().to_pydict()


def datafusion(path):
    import datafusion
    return datafusion.SessionContext().read_parquet(path).to_pydict()


def chdb(path):
    import chdb
    return chdb.query(f"SELECT * FROM file('{path}', Parquet)", "ArrowTable").to_pydict()


def fastparquet(path):
    import fastparquet
    return {name: column.to_numpy() for name, column in fastparquet.ParquetFile(path).to_pandas().items()}


reader = globals()[sys.argv[1]]
opened = equal = 0
why = ""
for path in files:
    try:
        found = reader(path)
        opened += 1
        wanted, sums_found = sums(reference(path)), sums(found)
        close = all(name in sums_found and abs(sums_found[name] - value) <= 1e-12 * abs(value) + 1e-300 for name, value in wanted.items())
        equal += close
        if not close:
            why = why or f"{Path(path).name}: {[name for name, value in wanted.items() if sums_found.get(name) != value][:3]}"
    except Exception as error:
        why = why or f"{type(error).__name__}: {str(error).splitlines()[0][:60]}"
print(json.dumps([f"{opened} of {len(files)}", f"{equal} of {len(files)}", why]))
'''

FIELDS = '''
import json, sys

import h5py, numpy

name, path, field = sys.argv[1:]
with h5py.File(path) as file:
    wanted = file[field][:]


def h5py_(path):
    with h5py.File(path) as file:
        return file[field][:], file[field].attrs.get("unit")


def pyfive(path):
    import pyfive
    data = pyfive.File(path)[field]
    return data[:], data.attrs.get("unit")


def netCDF4(path):
    import netCDF4
    data = netCDF4.Dataset(path)
    data = data[field] if "/" not in field else data[field.split("/")[0]][field.split("/")[1]]
    return numpy.asarray(data[:]), getattr(data, "unit", None)


def xarray_(path, engine):
    import xarray
    group = field.split("/")[0] if "/" in field else None
    more = {"phony_dims": "sort"} if engine == "h5netcdf" else {}
    data = xarray.open_dataset(path, engine=engine, group=group, **more)[field.split("/")[-1]]
    return data.values, data.attrs.get("unit")


readers = {"h5py": h5py_, "pyfive": pyfive, "netCDF4": netCDF4}
readers |= {f"xarray, {engine}": (lambda path, engine=engine: xarray_(path, engine)) for engine in ("h5netcdf", "netcdf4")}
try:
    values, unit = readers[name](path)
    unit = unit.decode() if isinstance(unit, bytes) else unit
    print(json.dumps(["yes", "yes" if numpy.array_equal(values, wanted) else "no", str(unit), ""]))
except Exception as error:
    print(json.dumps(["no", "", "", f"{type(error).__name__}: {str(error).splitlines()[0][:60]}"]))
'''

NETCDF = '''
import json, sys

import h5py, numpy

name, path, source = sys.argv[1:]
with h5py.File(source) as file:
    wanted = file["height_m"][:]
try:
    if name == "SurfaceTopography":
        from SurfaceTopography.IO import open_topography
        topography = open_topography(path).topography()
        values, unit = topography.heights(), topography.unit
    else:
        import xarray
        data = xarray.open_dataset(path, engine=name.split(", ")[1])
        data = data[next(iter(data.data_vars))]
        values, unit = data.values, data.attrs.get("units", data.attrs.get("unit"))
    print(json.dumps(["yes", "yes" if numpy.array_equal(values, wanted) else "no", str(unit), ""]))
except Exception as error:
    print(json.dumps(["no", "", "", f"{type(error).__name__}: {str(error).splitlines()[0][:60]}"]))
'''

SCRIPT = '''
import fs from 'fs'
const [name, path, field] = process.argv.slice(2)
const buffer = fs.readFileSync(path)
const bytes = buffer.buffer.slice(buffer.byteOffset, buffer.byteOffset + buffer.byteLength)
const sum = values => values.reduce((all, value) => all + Number(value), 0)
let found
try {
    if (name === 'hyparquet') {
        const {parquetReadObjects} = await import('hyparquet')
        const {compressors} = await import('hyparquet-compressors')
        const rows = await parquetReadObjects({file: bytes, compressors})
        found = [rows.length, sum(rows.map(row => row[field]))]
    } else if (name === 'h5wasm') {
        const h5wasm = await import('h5wasm/node')
        await h5wasm.ready
        const data = new h5wasm.File(path, 'r').get(field)
        found = [data.value.length, sum(Array.from(data.value))]
    } else {
        const {File} = await import('jsfive')
        const data = new File(bytes, path).get(field).value
        found = [data.length, sum(Array.from(data))]
    }
    console.log(JSON.stringify({found}))
} catch (error) {
    console.log(JSON.stringify({error: String(error).slice(0, 80)}))
}
'''


def answer(command, cwd=None):
    done = subprocess.run(command, check=False, capture_output=True, encoding="utf-8", cwd=cwd)
    lines = done.stdout.strip().splitlines()
    if not lines:
        return ["no", "", "", (done.stderr.strip().splitlines() or ["no output"])[-1][:80]]
    return json.loads(lines[-1])


def version(name):
    return next((package.partition("==")[2] for package in PACKAGES if package.split("[")[0].split("==")[0] == name), "")


def row(*cells):
    print("| " + " | ".join(str(cell) for cell in cells) + " |")


def main(program, run):
    run = Path(run).absolute()
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        venv.create(folder / "venv", with_pip=True)
        python = str(folder / "venv/bin/python")
        subprocess.run([python, "-m", "pip", "install", "-q", *PACKAGES], check=True)
        for name, text in (("tables.py", TABLES), ("fields.py", FIELDS), ("netcdf.py", NETCDF), ("read.mjs", SCRIPT)):
            (folder / name).write_text(text, encoding="utf-8")
        row("reader", "files", "opens", "values equal", "unit", "remark")
        row(*["---"] * 6)
        for name, package in (("polars", ""), ("pandas", ""), ("duckdb", ""), ("datafusion", ""), ("chdb", ""), ("fastparquet", "")):
            opens, equal, why = answer([python, str(folder / "tables.py"), name, str(run)])[:3]
            row(f"{name} {version(name)}", "tables (Parquet)", opens, equal, "", why)
        surface = next(run.glob("surfaces/*.h5"))
        maps = next(run.glob("cycles/*/maps.h5"))
        group = subprocess.run([python, "-c", f"import h5py; print(next(iter(h5py.File({str(maps)!r}))))"], check=True, capture_output=True, encoding="utf-8")
        fields = [("surfaces (HDF5)", surface, "height_m"), ("maps (HDF5)", maps, f"{group.stdout.strip()}/gap_m")]
        for name in ("h5py", "pyfive", "netCDF4", "xarray, h5netcdf", "xarray, netcdf4"):
            for what, path, field in fields:
                opens, equal, unit, why = answer([python, str(folder / "fields.py"), name, str(path), field])
                row(f"{name} {version(name.split(',')[0])}", what, opens, equal, unit, why)
        exported = folder / "surface.nc"
        subprocess.run([program, "export", "netcdf", str(surface), "--out", str(exported)], check=True, capture_output=True)
        for name in ("SurfaceTopography", "xarray, scipy", "xarray, netcdf4"):
            opens, equal, unit, why = answer([python, str(folder / "netcdf.py"), name, str(exported), str(surface)])
            row(f"{name} {version(name.split(',')[0])}", "`export netcdf`", opens, equal, unit, why)
        if shutil.which("npm"):
            javascript(folder, python, run, surface)
        metadata(python, run)


def javascript(folder, python, run, surface):
    subprocess.run(["npm", "install", "--silent", "--no-audit", "--no-fund", *NODE], check=True, cwd=folder, capture_output=True)
    steps = next(run.glob("cycles/*/steps.parquet"))
    wanted = {
        "steps": f"import pyarrow.parquet as q; c = q.read_table({str(steps)!r})['load_n'].to_pylist(); print([len(c), sum(c)])",
        "surface": f"import h5py; h = h5py.File({str(surface)!r})['height_m'][:]; print([h.size, float(abs(h).max())])",
    }
    expected = {name: json.loads(subprocess.run([python, "-c", code], check=True, capture_output=True, encoding="utf-8").stdout) for name, code in wanted.items()}
    for name, what, path, field in (
        ("hyparquet", "tables (Parquet)", steps, "load_n"),
        ("h5wasm", "surfaces (HDF5)", surface, "height_m"),
        ("jsfive", "surfaces (HDF5)", surface, "height_m"),
    ):
        found = answer(["node", "read.mjs", name, str(path), field], cwd=folder)
        package = next(entry for entry in NODE if entry.startswith(f"{name}@"))
        if isinstance(found, list) or "error" in found:
            row(package.replace("@", " "), what, "no", "", "", found if isinstance(found, list) else found["error"])
            continue
        count, total = found["found"]
        number, value = expected["steps" if name == "hyparquet" else "surface"]
        # The mean height is 0: its sum is rounding.
        same = count == number and (abs(total - value) <= 1e-12 * abs(value) if name == "hyparquet" else abs(total) < 1e-9 * number * value)
        row(package.replace("@", " "), what, "yes", "yes" if same else "no", "", "")


def metadata(python, run):
    checked = subprocess.run(
        [python, "-m", "frictionless", "validate", "--json", str(run / "datapackage.json")], check=False, capture_output=True, encoding="utf-8", cwd=run
    )
    report = json.loads(checked.stdout)
    count = len(report["tasks"])
    valid = sum(task["valid"] for task in report["tasks"])
    row(f"frictionless {version('frictionless')}", "`datapackage.json`", f"{count} resources", f"{valid} valid", "", "")


if __name__ == "__main__":
    main(*sys.argv[1:])
