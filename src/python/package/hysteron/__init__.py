"""hysteron: adhesion hysteresis of rough surfaces.

`run(spec)` runs a simulation with the program `hysteron`. `take(file)` imports a measured surface. `load(dir)` opens the output directory of a run, with
its tables as Arrow tables for Polars, DuckDB and pandas. The modules `jkr`, `theory` and `spectrum` provide the equations of a single asperity, the
analytical models and the power spectrum for NumPy arrays.
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
