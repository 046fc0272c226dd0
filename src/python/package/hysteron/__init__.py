"""hysteron: adhesion hysteresis of rough surfaces.

`run(spec)` runs a simulation with the program `hysteron`. `take(file)` imports a measured surface. `load(dir)` opens the output directory of a run, with
its tables as Arrow tables for Polars, DuckDB and pandas. The modules `jkr`, `theory` and `spectrum` provide the equations of a single asperity, the
analytical models and the power spectrum for NumPy arrays. The module `plot` draws runs with matplotlib.

`take` is also `import_surface`, `Failed` is also `HysteronError`, and `FailedCases` is also `FailedCasesWarning`.
"""

from . import jkr, plot, spectrum, theory
from ._hysteron import __version__
from ._program import Failed, FailedCases, Interrupted, take
from ._run import Description, Maps, Run, describe, load
from ._start import run

import_surface = take
HysteronError = Failed
FailedCasesWarning = FailedCases

__all__ = [
    "Description",
    "Failed",
    "FailedCases",
    "FailedCasesWarning",
    "HysteronError",
    "Interrupted",
    "Maps",
    "Run",
    "__version__",
    "describe",
    "import_surface",
    "jkr",
    "load",
    "plot",
    "run",
    "spectrum",
    "take",
    "theory",
]
