"""What a campaign has left: its tables as Arrow tables, its surfaces as arrays."""

from __future__ import annotations

import difflib
import json
import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from . import _program


class Description(NamedTuple):
    """What a column holds, as its file tells it."""

    #: In words.
    description: str
    #: SI unit, "1" if it is dimensionless; None if the column holds no quantity.
    unit: str | None
    #: Where it comes from, as "Eq 2" of Violano and Afferrante; None if that is no equation.
    source: str | None


def describe(table: pa.Table | pa.Schema | pa.RecordBatch) -> dict[str, Description]:
    """Description, unit and source of each column, from the metadata of the Arrow fields; columns that have none, since they are not the program's,
    are left out."""
    schema = table if isinstance(table, pa.Schema) else table.schema
    told = {}
    for field in schema:
        metadata = {key.decode(): value.decode() for key, value in (field.metadata or {}).items()}
        if "description" in metadata:
            told[field.name] = Description(metadata["description"], metadata.get("unit"), metadata.get("source"))
    return told


def load(dir: str | os.PathLike[str]) -> Run:
    """Opens the output folder of a run. Nothing is read before it is asked for, and what is still being computed appears when it is there."""
    path = Path(dir).absolute()
    if not path.is_dir():
        raise FileNotFoundError(f"cannot load {path}: there is no such folder; allowed: the output folder of a run")
    if not (path / "campaign.toml").is_file():
        raise FileNotFoundError(f"cannot load {path}: it has no campaign.toml; allowed: the output folder of a run")
    return Run(path)


class Run(Mapping[str, pa.Table]):
    """The output folder of a run: a mapping from the names of its tables to `pyarrow.Table`.

    A name is the path of the Parquet file without its ending: "statistics/cases", "cycles/<id>/steps", "asperities/<id>". A table is read from the mapped
    file each time that it is asked for: keep it if it is needed again. It exports the Arrow PyCapsule interface (`__arrow_c_stream__`), so that
    Polars, DuckDB and others take it without copying: `polars.DataFrame(run.cases)`. What its columns mean says `describe(table)`.
    """

    def __init__(self, dir: Path) -> None:
        #: The folder, by its whole name.
        self.dir = dir

    def __repr__(self) -> str:
        return f"hysteron.load({str(self.dir)!r})"

    def __getitem__(self, name: str) -> pa.Table:
        path = self.dir / f"{name}.parquet"
        try:
            with pq.ParquetFile(path, memory_map=True) as file:
                return file.read()
        except FileNotFoundError:
            near = difflib.get_close_matches(name, list(self), n=1)
            hint = f"; the nearest that it has is {near[0]}" if near else ""
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
        """The cycles of the campaign that have been computed.

        A folder may hold those of earlier specs too, until `hysteron gc` takes them away: they are left out where the campaign has been aggregated.
        """
        there = {path.parent.name for path in self.dir.glob("cycles/*/steps.parquet")}
        try:
            described = json.loads((self.dir / "datapackage.json").read_text(encoding="utf-8"))
        except FileNotFoundError:
            return sorted(there)
        paths: list[str] = next((resource["path"] for resource in described["resources"] if resource["name"] == "steps"), [])
        return sorted(there.intersection(path.split("/")[1] for path in paths))

    @property
    def surface_ids(self) -> list[str]:
        """The surfaces that have been made."""
        return sorted(path.name.removesuffix(".h5") for path in self.dir.glob("surfaces/*.h5") if not path.name.startswith("."))

    @property
    def cases(self) -> pa.Table:
        """One row for each case and turning point, averaged over realizations."""
        return self["statistics/cases"]

    @property
    def realizations(self) -> pa.Table:
        """One row for each realization and turning point."""
        return self["statistics/realizations"]

    @property
    def curves(self) -> pa.Table:
        """The mean paths of each case."""
        return self["statistics/curves"]

    @property
    def avalanches(self) -> pa.Table:
        """One row for each avalanche of every cycle."""
        return self["statistics/avalanches"]

    def steps(self, id: str) -> pa.Table:
        """One row for each step of loading, and of unloading from each turning point, of the cycle `id`."""
        return self[f"cycles/{id}/steps"]

    def events(self, id: str) -> pa.Table:
        """One row for each asperity that changed its state in the cycle `id`."""
        return self[f"cycles/{id}/events"]

    def contacts(self, id: str) -> pa.Table:
        """One row for each contact spot at each kept step of the cycle `id`."""
        return self[f"cycles/{id}/contacts"]

    def turning(self, id: str) -> pa.Table:
        """The contact at each turning point of the cycle `id`: every asperity that is not simply free."""
        return self[f"cycles/{id}/turning"]

    def merged(self, id: str) -> pa.Table:
        """The merged spots of the cycle `id`."""
        return self[f"cycles/{id}/merged"]

    def asperities(self, id: str) -> pa.Table:
        """One row for each summit of the surface `id` that can come into contact."""
        return self[f"asperities/{id}"]

    def surface(self, id: str) -> NDArray[np.float64]:
        """The heights of the surface `id` [m], N × N; rows count along x. Needs h5py."""
        path = self.dir / "surfaces" / f"{id}.h5"
        if not path.is_file():
            near = difflib.get_close_matches(id, self.surface_ids, n=1)
            raise KeyError(f"{self.dir} has no surface {id}" + (f"; the nearest that it has is {near[0]}" if near else ""))
        try:
            import h5py
        except ImportError:
            raise ImportError(f"cannot read {path}: surfaces are HDF5, and h5py is not installed; allowed: after `pip install h5py`") from None
        with h5py.File(path) as file:
            heights: NDArray[np.float64] = file["height_m"][:]
            return heights

    def status(self) -> dict[str, Any]:
        """What of the run is done: the answer of `hysteron status DIR --json`."""
        return _program.status(self.dir)
