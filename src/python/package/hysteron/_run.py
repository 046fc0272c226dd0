"""Output of a run: tables as Arrow tables, surfaces as arrays."""

from __future__ import annotations

import difflib
import html
import json
import os
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from . import _labelled, _program

#: Columns of the table of means that a notebook shows.
_SHOWN = ("max_load", "done_count", "area_at_max_load_mean", "pull_off_load_mean", "loss_mean", "loss_sd", "caution")

#: Symbols and units of parameters in the names of cases.
_SYMBOLS = {
    "magnification": ("ζ", ""),
    "hurst": ("H", ""),
    "length_m": ("L", " m"),
    "rms_height_m": ("h_rms", " m"),
    "contact_modulus_pa": ("E*", " Pa"),
    "work_of_adhesion_j_m2": ("Δγ", " J/m²"),
    "interaction_range_m": ("ε", " m"),
}


def case_names(cases: pa.Table) -> dict[str, str]:
    """Name of each case of the table `cases`: the fewest varying parameters by which all cases differ."""
    names = cases.schema.names
    parameters = names[: names.index("max_load")]
    rows = {row["case_id"]: row for row in cases.select(parameters).to_pylist()}
    columns = [name for name in parameters if name not in ("case_id", "sweep")]
    # Of columns with as many values, the method and the quantities with symbols come first.
    known = ["method", *_SYMBOLS]
    columns.sort(key=lambda name: (-len({row[name] for row in rows.values()}), known.index(name) if name in known else len(known)))
    chosen: list[str] = []

    def groups(of: list[str]) -> int:
        return len({tuple(row[name] for name in of) for row in rows.values()})

    for name in columns:
        if groups([*chosen, name]) > groups(chosen):
            chosen.append(name)

    def part(name: str, value: Any) -> str:
        symbol, unit = _SYMBOLS.get(name, (name, ""))
        return f"{symbol} = {f'{value:.4g}' if isinstance(value, float) else value}{unit}"

    return {case: ", ".join(part(name, row[name]) for name in chosen) or case for case, row in rows.items()}


class Description(NamedTuple):
    """Description of a column, from its file."""

    #: Definition of the quantity.
    description: str
    #: SI unit, "1" if it is dimensionless; None if the column holds no quantity.
    unit: str | None
    #: Equation or publication, for example "Eq 2" of Violano and Afferrante; None without a source.
    source: str | None


def describe(table: pa.Table | pa.Schema | pa.RecordBatch) -> dict[str, Description]:
    """Description, unit and source of each column, from the metadata of the Arrow fields. Columns without metadata are omitted."""
    schema = table if isinstance(table, pa.Schema) else table.schema
    told = {}
    for field in schema:
        metadata = {key.decode(): value.decode() for key, value in (field.metadata or {}).items()}
        if "description" in metadata:
            told[field.name] = Description(metadata["description"], metadata.get("unit"), metadata.get("source"))
    return told


class Maps(NamedTuple):
    """Maps of gap and pressure of a cycle by boundary elements, ordered by step."""

    #: Numbers of the steps, as in the table `steps`; shape (n,).
    steps: NDArray[np.int64]
    #: "loading" or "unloading" of each map; shape (n,).
    branches: NDArray[np.str_]
    #: Load reversal F_max/(E* A0) of each map; shape (n,).
    max_loads: NDArray[np.float64]
    #: Mean penetrations [m]; shape (n,).
    approaches_m: NDArray[np.float64]
    #: Normal loads [N], positive in compression; shape (n,).
    loads_n: NDArray[np.float64]
    #: Coordinates of the grid points along x [m]; shape (N,).
    x_m: NDArray[np.float64]
    #: Coordinates of the grid points along y [m]; shape (N,).
    y_m: NDArray[np.float64]
    #: Pressure [Pa], compression positive; shape (n, N, N), indices map, x, y.
    pressure_pa: NDArray[np.float32]
    #: Gap [m]; shape (n, N, N), indices map, x, y.
    gap_m: NDArray[np.float32]
    #: Gap below which a point is in contact [m].
    contact_gap_m: float
    #: Side of the square [m].
    length_m: float

    def in_contact(self) -> NDArray[np.bool_]:
        """True at the grid points in contact; shape (n, N, N)."""
        touches: NDArray[np.bool_] = (self.pressure_pa > 0) | (self.gap_m < self.contact_gap_m)
        return touches

    def to_xarray(self) -> Any:
        """The maps as `xarray.Dataset` with the dimensions step, x and y. Requires xarray."""
        return _labelled.maps(self)


def _h5py(path: Path) -> Any:
    try:
        import h5py
    except ImportError:
        raise ImportError(f"cannot read {path}: h5py is not installed\nhelp: pip install h5py") from None
    return h5py


def load(dir: str | os.PathLike[str]) -> Run:
    """Opens the output directory of a run. Tables are read on access; tables of an unfinished run appear as they are written.

    Parameters
    ----------
    dir : path
        Output directory of a run.

    Returns
    -------
    Run
    """
    path = Path(dir).absolute()
    if not path.is_dir():
        raise FileNotFoundError(f"cannot load {path}: no such directory\nhelp: give the output directory of a run")
    if not (path / "campaign.toml").is_file():
        raise FileNotFoundError(f"cannot load {path}: no campaign.toml\nhelp: give the output directory of a run")
    return Run(path)


class Run(Mapping[str, pa.Table]):
    """The output directory of a run: a mapping from table names to `pyarrow.Table`.

    A table name is the path of the Parquet file without extension: "statistics/cases", "cycles/<id>/steps", "asperities/<id>". Each access reads the
    memory-mapped file again. Tables export the Arrow PyCapsule interface (`__arrow_c_stream__`), so Polars, DuckDB and others use them without a copy:
    `polars.DataFrame(run.cases)`. `describe(table)` returns descriptions and units of the columns.
    """

    def __init__(self, dir: Path) -> None:
        #: Absolute path of the directory.
        self.dir = dir

    def __repr__(self) -> str:
        return f"hysteron.load({str(self.dir)!r})"

    def _repr_html_(self) -> str:
        """The run in a notebook: state, link to the report, and the main columns of the table of means."""
        try:
            return self._html()
        except (pa.ArrowException, OSError, LookupError, TypeError, ValueError) as error:
            # A damaged file is an error of its access, not of the display of the run.
            why = f"{type(error).__name__}: {error}"
            path = html.escape(str(self.dir))
            return f"<p>{path}: cannot show the run ({html.escape(why)}). <code>hysteron verify {path} --deep</code> lists damaged files.</p>"

    def _html(self) -> str:
        title = f"<b>{html.escape(self.name)}</b> ({html.escape(str(self.dir))})"
        if self.report.is_file():
            title += f' <a href="{html.escape(self.report.as_uri())}">report.html</a>'
        if "statistics/cases" not in self:
            return f"<p>{title}: {len(self.cycle_ids)} cycles are finished, no table of means yet.</p>"
        cases = self.cases
        columns = [name for name in _SHOWN if name in cases.schema.names]
        head = "".join(f"<th>{name}</th>" for name in ("case", *columns))
        names = case_names(cases)

        def cell(value: Any) -> str:
            return f"{value:.4g}" if isinstance(value, float) else html.escape(str(value))

        first = cases.slice(0, 20).select(["case_id", *columns]).to_pylist()
        name_cell = '<td style="white-space:nowrap">'
        rows = (f"{name_cell}{cell(names[row['case_id']])}</td>" + "".join(f"<td>{cell(row[name])}</td>" for name in columns) for row in first)
        body = "".join(f"<tr>{row}</tr>" for row in rows)
        return f"<p>{title}: {cases.num_rows} rows of means.</p><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"

    @property
    def spec(self) -> str:
        """Spec of the run with all defaults, as TOML."""
        return (self.dir / "campaign.toml").read_text(encoding="utf-8")

    @property
    def name(self) -> str:
        """Name of the run."""
        found = re.search(r'^name = "([^"]*)"', self.spec, re.MULTILINE)
        return found[1] if found else self.dir.name

    @property
    def report(self) -> Path:
        """Path of the report."""
        return self.dir / "report.html"

    def __getitem__(self, name: str) -> pa.Table:
        path = self.dir / f"{name}.parquet"
        try:
            with pq.ParquetFile(path, memory_map=True) as file:
                return file.read()
        except FileNotFoundError:
            near = difflib.get_close_matches(name, list(self), n=1)
            hint = f"; did you mean {near[0]}?" if near else ""
            raise KeyError(f"{self.dir} has no table {name}{hint}") from None

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and not Path(name).name.startswith(".") and (self.dir / f"{name}.parquet").is_file()

    def __iter__(self) -> Iterator[str]:
        found = (path.relative_to(self.dir) for path in self.dir.rglob("*.parquet") if not path.name.startswith("."))
        return iter(sorted(path.as_posix().removesuffix(".parquet") for path in found))

    def __len__(self) -> int:
        return sum(1 for _ in iter(self))

    @property
    def cycle_ids(self) -> list[str]:
        """Identifiers of the finished cycles.

        After aggregation, cycles of earlier specs in the same directory are omitted; `hysteron gc` deletes them.
        """
        there = {path.parent.name for path in self.dir.glob("cycles/*/steps.parquet")}
        try:
            described = json.loads((self.dir / "datapackage.json").read_text(encoding="utf-8"))
        except FileNotFoundError:
            return sorted(there)
        # One path per resource; in directories of earlier versions a list of them.
        listed = (resource["path"] for resource in described["resources"])
        paths = [path for entry in listed for path in ([entry] if isinstance(entry, str) else entry)]
        return sorted(there.intersection(path.split("/")[1] for path in paths if path.endswith("/steps.parquet")))

    @property
    def surface_ids(self) -> list[str]:
        """Identifiers of the existing surfaces."""
        return sorted(path.name.removesuffix(".h5") for path in self.dir.glob("surfaces/*.h5") if not path.name.startswith("."))

    @property
    def cases(self) -> pa.Table:
        """Table of means: one row per case and load reversal, averaged over realizations."""
        return self["statistics/cases"]

    @property
    def realizations(self) -> pa.Table:
        """Table of results: one row per realization and load reversal."""
        return self["statistics/realizations"]

    @property
    def curves(self) -> pa.Table:
        """Mean loading and unloading curves of each case."""
        return self["statistics/curves"]

    @property
    def avalanches(self) -> pa.Table:
        """Table of avalanches: one row per avalanche of every cycle."""
        return self["statistics/avalanches"]

    @property
    def all_events(self) -> pa.Table:
        """Table of events: one row per event of every cycle."""
        return self["statistics/events"]

    def results(self, realizations: bool = False) -> Any:
        """The table `cases` as `xarray.Dataset` with the dimensions case_id and max_load. Requires xarray.

        Parameters
        ----------
        realizations : bool
            True: the table `realizations`, with the dimension realization too.
        """
        table = self.realizations if realizations else self.cases
        return _labelled.results(table, describe(table))

    def loop(self, id: str, max_load: float | None = None) -> Any:
        """The loop of the cycle `id` at a load reversal, by default the largest, as `xarray.Dataset` along the dimension step. Requires xarray."""
        table = self.steps(id)
        return _labelled.loop(table, describe(table), max_load)

    def steps(self, id: str) -> pa.Table:
        """Output steps of the cycle `id`: loading, and unloading from each load reversal."""
        return self[f"cycles/{id}/steps"]

    def events(self, id: str | None = None) -> pa.Table:
        """Events: one row per change of state of an asperity.

        Parameters
        ----------
        id : str, optional
            Cycle. Default: all finished cycles, with the parameters of the cycle in each row.

        Returns
        -------
        pyarrow.Table
        """
        if id is not None:
            return self[f"cycles/{id}/events"]
        cycles = self["statistics/cycles"]
        rows: dict[str, int] = {}
        for row, name in enumerate(cycles["cycle_id"].to_pylist()):
            # Cases that share a cycle have one row each.
            rows.setdefault(name, row)
        parts = []
        for name in self.cycle_ids:
            part = self.events(name)
            for field in cycles.schema:
                if field.name not in part.schema.names and name in rows:
                    part = part.append_column(field, pa.repeat(cycles[field.name][rows[name]], part.num_rows))
            parts.append(part)
        return pa.concat_tables(parts, promote_options="default")

    def contacts(self, id: str) -> pa.Table:
        """Contact spots of the cycle `id` at the steps selected by `cycle.contacts`."""
        return self[f"cycles/{id}/contacts"]

    def turning(self, id: str) -> pa.Table:
        """State of the contact at each load reversal of the cycle `id`."""
        return self[f"cycles/{id}/turning"]

    def merged(self, id: str) -> pa.Table:
        """Merged contacts of the cycle `id`."""
        return self[f"cycles/{id}/merged"]

    def asperities(self, id: str) -> pa.Table:
        """Asperities of the surface `id`."""
        return self[f"asperities/{id}"]

    def surface(self, id: str) -> NDArray[np.float64]:
        """Heights of the surface `id` [m], an N × N array; the row index runs along x. Requires h5py."""
        path = self.dir / "surfaces" / f"{id}.h5"
        if not path.is_file():
            near = difflib.get_close_matches(id, self.surface_ids, n=1)
            raise KeyError(f"{self.dir} has no surface {id}" + (f"; did you mean {near[0]}?" if near else ""))
        with _h5py(path).File(path) as file:
            heights: NDArray[np.float64] = file["height_m"][:]
            return heights

    def maps(self, id: str, whole: bool = False) -> Maps:
        """Stored maps of gap and pressure of the cycle `id` by boundary elements. Requires h5py.

        Parameters
        ----------
        id : str
            Cycle by boundary elements.
        whole : bool
            True: the maps of the whole grid alone, at load reversals and at pull-off. Default: all maps, on the points that they have in common. Of grids
            with more than 256 points along a side these are every n-th point.

        Returns
        -------
        Maps
        """
        path = self.dir / "cycles" / id / "maps.h5"
        if not path.is_file():
            near = difflib.get_close_matches(id, [found.parent.name for found in self.dir.glob("cycles/*/maps.h5")], n=1)
            hint = f"; did you mean {near[0]}?" if near else "; only cycles by boundary elements have maps"
            raise KeyError(f"{self.dir} has no maps of the cycle {id}{hint}")
        with _h5py(path).File(path) as file:
            groups = sorted(file.values(), key=lambda group: int(group.attrs["step"]))
            strides = {group.name: int(group.attrs.get("stride", 1)) for group in groups}
            if whole:
                groups = [group for group in groups if strides[group.name] == 1]
            common = max((strides[group.name] for group in groups), default=1)
            length = float(file.attrs["length_m"])
            first = float(file.attrs.get("first_m", 0.0))
            place = np.linspace(first, first + length, int(file.attrs["points"]), endpoint=False, dtype=np.float64)[::common]

            def attribute(name: str, dtype: Any) -> NDArray[Any]:
                return np.array([group.attrs[name] for group in groups], dtype=dtype)

            def field(name: str) -> NDArray[np.float32]:
                skips = [common // strides[group.name] for group in groups]
                fields = [group[name][::skip, ::skip] for group, skip in zip(groups, skips, strict=True)]
                return np.array(fields, dtype=np.float32).reshape(-1, place.size, place.size)

            return Maps(
                attribute("step", np.int64),
                attribute("branch", np.str_),
                attribute("max_load", np.float64),
                attribute("approach_m", np.float64),
                attribute("load_n", np.float64),
                place,
                place.copy(),
                field("pressure_pa"),
                field("gap_m"),
                float(file.attrs["contact_gap_m"]),
                length,
            )

    def status(self) -> dict[str, Any]:
        """State of the run: the output of `hysteron status DIR --json`."""
        return _program.status(self.dir)
