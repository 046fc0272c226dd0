"""Table of the expected error of the asperity model, src/stats/model_error.csv, from a run of pipelines/validity.toml.

    hysteron run pipelines/validity.toml --out out && python tests/reference/validity.py out > src/stats/model_error.csv

Several folders of runs of parts of the spec are read together.

Ratios of both methods on the same surface, averaged over the surfaces and magnifications of one work of adhesion. Of boundary elements the
cases with 16 points per shortest wavelength are taken, with the mean of their grid errors. A ratio whose standard deviation exceeds its mean is
left out.

The heading states the versions of both methods, from the key inputs in the receipts of the cycles, and the number of pairs of cycles of all planned.
"""
import json
import math
import sys
from pathlib import Path

import polars as pl


def versions(folder):
    """Version of each method: one each, since a run recomputes the cycles of other versions."""
    found = {}
    for path in sorted(folder.rglob("*.json")):
        try:
            preimages = json.loads(path.read_text(encoding="utf-8"))["preimages"]
        except (KeyError, TypeError, ValueError):
            continue
        stack = [preimages]
        while stack:
            value = stack.pop()
            if isinstance(value, dict):
                if "method_version" in value:
                    found.setdefault(value["method"], set()).add(value["method_version"])
                stack.extend(value.values())
    return {method: ", ".join(map(str, sorted(numbers))) for method, numbers in found.items()}


folders = [Path(name) for name in sys.argv[1:]]
pairs, cases = (
    pl.concat([pl.read_parquet(folder / "statistics" / name) for folder in folders]) for name in ("methods.parquet", "cases.parquet")
)
of_asperities = cases.filter(pl.col("method") == "asperities")
asperities = of_asperities.select(pl.col("case_id").alias("asperities_case_id"), "coalescence", "magnification", "work_of_adhesion_j_m2")
elements = cases.filter(
    (pl.col("elements_per_wavelength_mean") == 16) & (pl.col("opening") == "strength")
).select(pl.col("case_id").alias("elements_case_id"), "area_grid_error", "pull_off_grid_error", "loss_grid_error").unique()
table = pairs.join(asperities, on="asperities_case_id").join(elements, on="elements_case_id")
ratios = [f"{name}_ratio" for name in ("area_at_max_load", "pull_off_load", "loss")]
made = versions(folders[0])
print("# Asperity model over boundary elements: area, pull-off force and dissipated energy, means over surfaces; their standard deviations, grid errors and number.")
print(f"# versions: asperities {made['asperities']}, boundary_elements {made['boundary_elements']}")
print(
    f"# hysteron run pipelines/validity.toml; magnifications {sorted(table['magnification'].unique().to_list())}; "
    f"{len(table)} of {of_asperities['planned_count'].sum()} pairs of cycles finished"
)
print("coalescence,persson_tosatti,area,pull_off,loss,area_sd,pull_off_sd,loss_sd,area_grid,pull_off_grid,loss_grid,count")
for (rule, _), part in sorted(table.group_by("coalescence", -pl.col("work_of_adhesion_j_m2"))):
    middle = math.exp(part["persson_tosatti_realised"].log().mean())
    means = [part[ratio].mean() for ratio in ratios]
    sds = [part[ratio].std() or 0.0 for ratio in ratios]
    shown = [f"{mean:.3f}" if mean is not None and sd < mean else "" for mean, sd in zip(means, sds)]
    grids = [part[f"{name}_grid_error"].mean() for name in ("area", "pull_off", "loss")]
    print(",".join([rule, f"{middle:.4g}"] + shown + [f"{value:.3f}" for value in sds + grids] + [str(len(part))]))
