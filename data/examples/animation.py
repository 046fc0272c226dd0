"""A loop and its contact map as an animation: the second figure of the README.

    python data/examples/animation.py RUN [FIGURE]

RUN is the output folder of a finished run with `contacts = "all"`, FIGURE the animated PNG to write (default: loop.png).
Needs numpy, pyarrow, pillow and matplotlib.
"""

import pathlib
import sys

import matplotlib.pyplot as plt
import numpy as np
import pyarrow.parquet as pq
from matplotlib.animation import FuncAnimation, PillowWriter
from matplotlib.collections import EllipseCollection

run = pathlib.Path(sys.argv[1])
figure = sys.argv[2] if len(sys.argv) > 2 else "loop.png"

cycle = pq.read_table(run / "statistics/cycles.parquet").to_pylist()[0]
folder = run / "cycles" / cycle["cycle_id"]
steps = {name: np.array(of) for name, of in pq.read_table(folder / "steps.parquet").select(["step", "branch", "penetration", "load"]).to_pydict().items()}
contacts = {name: np.array(of) for name, of in pq.read_table(folder / "contacts.parquet").to_pydict().items()}
asperities = pq.read_table(run / "asperities" / f"{cycle['asperities_id']}.parquet").to_pydict()
x, y, side = np.array(asperities["x_m"]), np.array(asperities["y_m"]), cycle["length_m"]

fig, (left, right) = plt.subplots(1, 2, figsize=(6.4, 3.0), dpi=100, layout="constrained")
for branch, dash in (("loading", "--"), ("unloading", "-")):
    of = steps["branch"] == branch
    left.plot(steps["penetration"][of], 1e3 * steps["load"][of], dash, color="#0072B2", label=branch)
left.set(xlabel=r"$\Delta/h_\mathrm{rms}$", ylabel=r"$F/(E^* A_0)$ [$10^{-3}$]")
left.legend(frameon=False)
(dot,) = left.plot([], [], "o", color="black")
right.set(xlim=(0, 1e3 * side), ylim=(0, 1e3 * side), aspect="equal", xlabel="x [mm]", ylabel="y [mm]")


def draw(k):
    """The state at a step: its point on the loop and its contact spots."""
    dot.set_data([steps["penetration"][k]], [1e3 * steps["load"][k]])
    for old in list(right.collections):
        old.remove()
    of = (contacts["step"] == steps["step"][k]) & (contacts["state"] == "contact")
    ids = contacts["asperity_id"][of].astype(int)
    diameter = 2e3 * contacts["contact_radius_m"][of].astype(float)
    colours = np.where(contacts["load_n"][of].astype(float) < 0, "#D55E00", "#0072B2")
    spots = EllipseCollection(diameter, diameter, np.zeros(ids.size), units="xy", offsets=1e3 * np.c_[x[ids], y[ids]], facecolors=colours)
    right.add_collection(spots)
    spots.set_offset_transform(right.transData)
    right.set_title(f"{ids.size} contact spots", fontsize=9)


every = max(1, len(steps["step"]) // 60)
film = FuncAnimation(fig, draw, frames=range(0, len(steps["step"]), every))
film.save(figure, writer=PillowWriter(fps=10))
