"""The tables over realizations, once more from the steps of every cycle in plain Python: pyarrow only reads.

    python aggregates.py DIR

Says how many numbers were compared; the first that differs ends it.
"""

import math
import statistics
import sys
from pathlib import Path

import pyarrow.parquet

# Student's t(0.975, n - 1), which has a closed form for these n.
STUDENT = {2: math.tan(0.475 * math.pi), 3: 0.95 / math.sqrt(2 * 0.975 * 0.025)}


def rows(path):
    return pyarrow.parquet.read_table(path).to_pylist()


def results(steps, max_load, energy_j):
    """What one cycle comes to at a turning point."""
    loading = [step for step in steps if step["branch"] == "loading"]
    unloading = [step for step in steps if step["branch"] == "unloading" and step["max_load"] == max_load]
    turn = min(range(len(loading)), key=lambda k: abs(loading[k]["load"] - max_load))
    top = loading[turn]
    unit_n = top["load_n"] / top["load"]
    loss_j = top["work_j"] + unloading[-1]["work_j"]
    lost_j = math.fsum(step["dissipated_j"] for step in loading[: turn + 1] + unloading)
    return {
        "area_at_max_load": top["area"],
        "penetration_at_max_load": top["penetration"],
        "pull_off_load": -min(0.0, min(step["least_load_n"] for step in unloading)) / unit_n,
        "loss": loss_j / energy_j,
        "dissipated": lost_j / energy_j,
    }


def close(found, wanted, what):
    assert abs(found - wanted) <= 1e-12 * max(abs(wanted), 1e-12), (what, found, wanted)


def main():
    folder = Path(sys.argv[1])
    realizations = rows(folder / "statistics/realizations.parquet")
    cases = {(case["case_id"], case["max_load"]): case for case in rows(folder / "statistics/cases.parquet")}
    cycles = {path.parent.name: rows(path) for path in sorted(folder.glob("cycles/*/steps.parquet"))}
    compared = 0
    groups = {}
    for row in realizations:
        energy_j = row["contact_modulus_pa"] * row["length_m"] ** 2 * row["rms_height_m"]
        own = results(cycles[row["cycle_id"]], row["max_load"], energy_j)
        for name, value in own.items():
            close(row[name], value, (row["case_id"], row["realization"], name))
            compared += 1
        groups.setdefault((row["case_id"], row["max_load"]), []).append(own)
    assert groups.keys() == cases.keys()
    for key, group in groups.items():
        case = cases[key]
        assert case["done_count"] == len(group), key
        for name in group[0]:
            values = [result[name] for result in group]
            mean, sd = statistics.fmean(values), statistics.stdev(values)
            half = STUDENT[len(values)] * sd / math.sqrt(len(values))
            for column, value in [("mean", mean), ("sd", sd), ("ci95_low", mean - half), ("ci95_high", mean + half)]:
                if f"{name}_{column}" in case:
                    # The interval is a difference of two numbers: its digits are those of the greater.
                    assert abs(case[f"{name}_{column}"] - value) <= 1e-11 * (abs(mean) + half), (key, name, column)
                    compared += 1
    print(f"{compared} numbers of {len(cycles)} cycles")


main()
