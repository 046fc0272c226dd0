"""One loop by boundary elements, and its contact at the maximum load and at pull-off: the figure at the top of the README.

    python data/examples/loop.py [RUN] [FIGURE]

RUN is the output folder of a finished run (default: data/runs/quickstart), FIGURE the file to write (default: loop.svg).
Needs numpy, polars, h5py and matplotlib.
"""

import pathlib
import sys

import h5py
import matplotlib.pyplot as plt
import numpy as np
import polars as pl

run = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "data/runs/quickstart")
figure = sys.argv[2] if len(sys.argv) > 2 else "loop.svg"

# The first surface with the largest dissipated energy, at its largest load.
cases = pl.read_parquet(run / "statistics/realizations.parquet")
cycles = pl.read_parquet(run / "statistics/cycles.parquet").filter(method="boundary_elements")
first = cases.filter(pl.col("cycle_id").is_in(cycles["cycle_id"].implode()), realization=0)
if first.is_empty():
    sys.exit(f"{run} has no finished cycle by boundary elements")
case = first.sort(["loss", "max_load"], descending=True).row(0, named=True)
cycle = cycles.filter(cycle_id=case["cycle_id"]).row(0, named=True)
folder = run / "cycles" / case["cycle_id"]
steps = pl.read_parquet(folder / "steps.parquet")
unloading = steps.filter(max_load=case["max_load"])
turn = steps.filter(reversal_load=case["max_load"])["step"][0]
loading = steps.filter(pl.col("branch") == "loading", pl.col("step") <= turn)
pull_off = unloading["step"][unloading["load"].arg_min()]

plt.rcParams.update({"font.size": 8, "svg.fonttype": "none", "svg.hashsalt": "hysteron"})
fig, (left, middle, right) = plt.subplots(1, 3, figsize=(9.0, 2.9), layout="constrained", width_ratios=[1.25, 1, 1])

# Before the surfaces touch there is no load.
approach = np.concatenate([loading["penetration"][:1], loading["penetration"]])
load = np.concatenate([[0.0], loading["load"]])
delta = np.concatenate([approach, unloading["penetration"]])
force = np.concatenate([load, unloading["load"]])
left.fill(delta, 1e3 * force, color="0.85", lw=0)
left.plot(approach, 1e3 * load, "--", color="black", lw=1.2, label="loading")
left.plot(unloading["penetration"], 1e3 * unloading["load"], "-", color="black", lw=1.2, label="unloading")
lowest = unloading["load"].arg_min()
point = (unloading["penetration"][lowest], 1e3 * unloading["load"][lowest])
left.plot(*point, "o", color="black", ms=4)
left.annotate("pull-off force $F_{po}$", point, xytext=(-8, 0), textcoords="offset points", ha="right", va="center")
left.text(0.04, 0.68, f"Θ = {1e3 * case['loss']:.2f}·10$^{{-3}}$ $E^*A_0h_{{rms}}$", transform=left.transAxes)
left.axhline(0, color="0.6", lw=0.6)
left.set(xlabel=r"mean penetration $\Delta/h_{rms}$", ylabel=r"load $F/(E^* A_0)$ [$10^{-3}$]")
left.margins(y=0.1)
left.legend(frameon=False, loc="upper left")

# Pressure over E*; white: no contact.
with h5py.File(folder / "maps.h5") as file:
    side = 1e3 * file.attrs["length_m"]
    groups = {int(group.attrs["step"]): group for group in file.values()}
    for axes, step, title in [(middle, loading["step"][-1], "maximum load"), (right, pull_off, "pull-off")]:
        nearest = min(groups, key=lambda known: abs(known - step))
        group = groups[nearest]
        touching = group["gap_m"][:] <= file.attrs["contact_gap_m"]
        pressure = np.where(touching, group["pressure_pa"][:] / cycle["contact_modulus_pa"], np.nan)
        # The row is x.
        image = axes.imshow(
            pressure.T, origin="lower", extent=(0, side, 0, side), cmap="RdBu", vmin=-0.1, vmax=0.1, interpolation="nearest"
        )
        axes.set(xlabel="x [mm]", title=f"contact at {title}")
middle.set_ylabel("y [mm]")
bar = fig.colorbar(image, ax=[middle, right], shrink=0.85, extend="both")
bar.set_label("pressure $p/E^*$ (red: tension)")
fig.savefig(figure, metadata={"Date": None} if figure.endswith(".svg") else None)
