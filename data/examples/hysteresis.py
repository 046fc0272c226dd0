"""Figure from the tables of a run: the loop of one realization, all avalanches, and Θ with its Deng–Kesari estimate.

    pip install polars matplotlib
    cargo run --release -- run pipelines/quickstart.toml
    python data/examples/hysteresis.py data/runs/quickstart hysteresis.png
"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import polars as pl

folder, figure = Path(sys.argv[1]), Path(sys.argv[2])
cases = pl.read_parquet(folder / "statistics/cases.parquet").sort("magnification", "max_load")
realizations = pl.read_parquet(folder / "statistics/realizations.parquet")
avalanches = pl.read_parquet(folder / "statistics/avalanches.parquet")

left, middle, right = plt.subplots(1, 3, figsize=(12, 3.6), layout="constrained")[1]

# The loop of one cycle: the loading path, and the unloading path from the largest load.
steps = pl.read_parquet(sorted(folder.glob("cycles/*/steps.parquet"))[0])
largest = steps["max_load"].max()
loading = steps.filter(pl.col("branch") == "loading")
unloading = steps.filter((pl.col("branch") == "unloading") & (pl.col("max_load") == largest))
left.plot(loading["penetration"], loading["load"], "--", color="#008a5e", label="loading")
left.plot(unloading["penetration"], unloading["load"], "-", color="#cc3311", label="unloading")
left.axhline(0, color="grey", lw=0.5)
left.set(xlabel="Δ/h_rms", ylabel="F/(E* A₀)")
left.legend()

# Dissipated energy Θ, the area of the loop: the work of loading plus that of unloading.
loss = loading["work_j"][-1] + unloading["work_j"][-1]
unit = realizations.select(pl.col("loss_j") / pl.col("loss")).item(0, 0)
left.set_title(f"Θ = {loss / unit:.2e} E* A₀ h_rms")

# All avalanches of all realizations: dissipated energy against the number of events.
for branch, colour in [("loading", "#008a5e"), ("unloading", "#cc3311")]:
    some = avalanches.filter((pl.col("branch") == branch) & (pl.col("energy_lost") > 0))
    middle.loglog(some["event_count"], some["energy_lost"], ".", ms=3, color=colour, alpha=0.5)
middle.set(xlabel="events in an avalanche", ylabel="dissipated energy/(E* A₀ h_rms)")

# Means over realizations with their 95 % confidence intervals, against the contact area.
half = (cases["loss_ci95_high"] - cases["loss_mean"]).fill_null(0.0)
right.errorbar(cases["area_at_max_load_mean"], cases["loss_mean"], yerr=half, fmt="o", color="#cc3311", capsize=3, label="computed")
right.plot(cases["area_at_max_load_mean"], cases["loss_dk_mean"], "s", color="#0077bb", mfc="none", label="Deng–Kesari")
right.set(xlabel="A/A₀ at the load reversal", ylabel="Θ/(E* A₀ h_rms)", ylim=(0, None))
right.legend()

plt.savefig(figure, dpi=150)
print(f"{figure}: dissipated energy {loss:.3e} J")
