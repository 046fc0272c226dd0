"""Results as labelled arrays of xarray."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pyarrow as pa

#: Columns that number the rows of a table of results.
_DIMENSIONS = ("case_id", "max_load", "realization")


def xarray() -> Any:
    """The package xarray."""
    try:
        import xarray
    except ImportError:
        raise ImportError("cannot label arrays: xarray is not installed\nhelp: pip install xarray") from None
    return xarray


def _attributes(description: Any) -> dict[str, str]:
    """Attributes of a variable from the description of its column."""
    if description is None:
        return {}
    attributes = {"long_name": description.description, "units": description.unit}
    return {name: value for name, value in attributes.items() if value is not None}


def results(table: pa.Table, described: Mapping[str, Any]) -> Any:
    """The table `cases` or `realizations` with the dimensions case_id, max_load and, for the latter, realization; missing rows are NaN."""
    names = [name for name in _DIMENSIONS if name in table.schema.names]
    columns = {name: table[name].to_numpy() for name in names}
    coordinates = {name: list(dict.fromkeys(values)) if name == "case_id" else np.unique(values) for name, values in columns.items()}
    places = [[{value: k for k, value in enumerate(coordinates[name])}[value] for value in columns[name]] for name in names]
    shape = tuple(len(coordinates[name]) for name in names)
    variables = {}
    for field in table.schema:
        if field.name in names or not (pa.types.is_floating(field.type) or pa.types.is_integer(field.type)):
            continue
        values = np.full(shape, np.nan)
        values[tuple(places)] = table[field.name].cast(pa.float64()).to_numpy()
        variables[field.name] = (names, values, _attributes(described.get(field.name)))
    return xarray().Dataset(variables, coords=coordinates)


def loop(steps: pa.Table, described: Mapping[str, Any], max_load: float | None) -> Any:
    """The loop of one load reversal along the dimension step: loading up to it, and unloading from there."""
    rows = {name: steps[name].to_numpy(zero_copy_only=False) for name in ("branch", "max_load", "reversal_load")}
    known = [value for value in rows["reversal_load"] if value is not None and not np.isnan(value)]
    if not known:
        raise ValueError("the cycle has no load reversal")
    chosen = max(known) if max_load is None else min(known, key=lambda value: abs(value - max_load))
    if max_load is not None and not np.isclose(chosen, max_load, rtol=1e-9):
        raise ValueError(f"the cycle has no load reversal at {max_load}\nhelp: one of {sorted(known)}")
    turning = int(np.flatnonzero(rows["reversal_load"] == chosen)[0])
    on_loop = (rows["branch"] == "loading") & (np.arange(steps.num_rows) <= turning)
    on_loop |= (rows["branch"] == "unloading") & (rows["max_load"].astype(np.float64) == chosen)
    table = steps.filter(pa.array(on_loop))
    variables = {}
    for field in table.schema:
        if pa.types.is_floating(field.type) or field.name == "branch":
            variables[field.name] = ("step", table[field.name].to_numpy(zero_copy_only=False), _attributes(described.get(field.name)))
    coordinates = {"step": table["step"].to_numpy()}
    for name in ("approach_m", "branch"):
        coordinates[name] = variables.pop(name)
    return xarray().Dataset(variables, coords=coordinates, attrs={"max_load": chosen})


def maps(of: Any) -> Any:
    """Maps of gap and pressure with the dimensions step, x and y [m]."""
    dimensions = ("step", "x", "y")
    return xarray().Dataset(
        {
            "pressure": (dimensions, of.pressure_pa, {"long_name": "pressure", "units": "Pa"}),
            "gap": (dimensions, of.gap_m, {"long_name": "gap", "units": "m"}),
            "in_contact": (dimensions, of.in_contact()),
        },
        coords={
            "step": of.steps,
            "x": ("x", of.x_m, {"units": "m"}),
            "y": ("y", of.y_m, {"units": "m"}),
            "branch": ("step", of.branches),
            "max_load": ("step", of.max_loads),
            "approach": ("step", of.approaches_m, {"long_name": "mean penetration", "units": "m"}),
            "load": ("step", of.loads_n, {"long_name": "normal load", "units": "N"}),
        },
    )
