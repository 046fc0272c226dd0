"""One loop and its contact map: the figure at the top of the README.

    python data/examples/loop.py [RUN] [FIGURE]

RUN is the output folder of a finished run (default: data/runs/quickstart), FIGURE the file to write (default: loop.svg).
Needs numpy, polars, h5py and matplotlib.
"""

import itertools
import pathlib
import sys

import h5py
import matplotlib.pyplot as plt
import numpy as np
import polars as pl

run = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "data/runs/quickstart")
figure = sys.argv[2] if len(sys.argv) > 2 else "loop.svg"

# The first surface of the largest magnification, at its largest load.
cases = pl.read_parquet(run / "statistics/realizations.parquet")
case = cases.sort(["magnification", "realization", "max_load"], descending=[True, False, True]).row(0, named=True)
steps = pl.read_parquet(run / "cycles" / case["cycle_id"] / "steps.parquet")
contacts = pl.read_parquet(run / "cycles" / case["cycle_id"] / "contacts.parquet")

unloading = steps.filter(max_load=case["max_load"])
reversal = unloading["penetration"][0]
loading = steps.filter(pl.col("branch") == "loading", pl.col("penetration") <= reversal)

plt.rcParams.update({"font.size": 8, "svg.fonttype": "none", "svg.hashsalt": "hysteron"})
fig, (left, right) = plt.subplots(1, 2, figsize=(7.0, 3.1), layout="constrained")

delta = np.concatenate([loading["penetration"], unloading["penetration"]])
force = np.concatenate([loading["load"], unloading["load"]])
left.fill(delta, 1e3 * force, color="#E69F00", alpha=0.3, lw=0)
left.plot(loading["penetration"], 1e3 * loading["load"], "--", color="#009E73", label="loading")
left.plot(unloading["penetration"], 1e3 * unloading["load"], "-", color="#D55E00", label="unloading")
lowest = unloading["load"].arg_min()
pull_off = (unloading["penetration"][lowest], 1e3 * unloading["load"][lowest])
left.plot(*pull_off, "o", color="black", ms=4)
left.annotate("pull-off force $F_{po}$", pull_off, xytext=(4, -11), textcoords="offset points")
middle = int(0.65 * len(loading))
inside = (loading["penetration"][middle], 1e3 * (loading["load"][middle] - 0.1 * loading["load"][-1]))
arrow = {"arrowstyle": "->", "lw": 0.7}
left.annotate("dissipated energy Θ", inside, xytext=(0.3, 0.6), textcoords="axes fraction", ha="center", arrowprops=arrow)
left.axhline(0, color="0.6", lw=0.6)
left.set(xlabel=r"mean penetration $\Delta/h_{rms}$", ylabel=r"load $F/(E^* A_0)$ [$10^{-3}$]")
left.margins(y=0.1)
left.legend(frameon=False, loc="upper left")

with h5py.File(run / "surfaces" / f"{case['surface_id']}.h5") as file:
    heights, length = file["height_m"][:], file.attrs["length_m"]
side = 1e3 * length
# The row is x.
right.imshow(heights.T, origin="lower", extent=(0, side, 0, side), cmap="Greys_r")
at_reversal = contacts.filter(step=loading["step"][-1]).filter(pl.col("state") == "contact")
for spot in at_reversal.iter_rows(named=True):
    color = "#D55E00" if spot["load_n"] < 0 else "#0072B2"
    x, y, radius = (1e3 * spot[name] for name in ("centroid_x_m", "centroid_y_m", "contact_radius_m"))
    # With the images across the edges of the periodic square.
    for centre in itertools.product((x - side, x, x + side), (y - side, y, y + side)):
        if all(-radius < c < side + radius for c in centre):
            right.add_patch(plt.Circle(centre, radius, color=color, alpha=0.75, lw=0))
handles = [plt.Line2D([], [], marker="o", ls="", color=color) for color in ("#0072B2", "#D55E00")]
right.legend(handles, ["compressive", "tensile"], loc="lower left", fontsize=7, framealpha=0.9)
right.set(xlabel="x [mm]", ylabel="y [mm]", title="contacts at the maximum load")
fig.savefig(figure, metadata={"Date": None} if figure.endswith(".svg") else None)
