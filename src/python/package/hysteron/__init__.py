"""hysteron: the adhesive hysteresis of rough surfaces.

`run(spec)` has the program `hysteron` compute a campaign, `take(file)` take a measured surface, and `load(dir)` opens what a campaign has left: its tables as Arrow tables, which Polars, DuckDB
and pandas take as they are. `jkr`, `theory` and `spectrum` are the program's own single-asperity functions, theories and spectrum for NumPy arrays.
"""

from . import jkr, spectrum, theory
from ._hysteron import __version__
from ._program import Failed, FailedCases, Interrupted, run, take
from ._run import Description, Run, describe, load

__all__ = [
    "Description",
    "Failed",
    "FailedCases",
    "Interrupted",
    "Run",
    "__version__",
    "describe",
    "jkr",
    "load",
    "run",
    "spectrum",
    "take",
    "theory",
]
