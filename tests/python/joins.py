"""The joins of the README over all cycles of a run, by Polars and DuckDB, against sums in plain Python.

    python joins.py DIR

Prints how many numbers were compared; the first difference ends it. What a cycle was computed with is read from its provenance record, not from
the columns that are tested.
"""

import json
import math
import sys
from pathlib import Path

import duckdb
import polars
import pyarrow.parquet

OF_A_CYCLE = ["steps", "contacts", "turning", "merged", "events"]


def rows(path):
    return pyarrow.parquet.read_table(path).to_pylist()


def close(found, wanted, what):
    assert abs(found - wanted) <= 1e-12 * abs(wanted), (what, found, wanted)


def plain(folder):
    """Per magnification and realization: how many events there were, and the energy they dissipated."""
    sums = {}
    for cycle in sorted(folder.glob("cycles/*/")):
        made = json.loads((folder / f"receipts/cycle/{cycle.name}.json").read_text())["preimages"]["generate"]["reads"]
        energies = [event["energy_lost_j"] for event in rows(cycle / "events.parquet")]
        sums[(made["surface"]["magnification"], made["realization"])] = (len(energies), math.fsum(energies))
    return sums


def joined(run):
    """The same by the two joins."""
    events = polars.scan_parquet(f"{run}/cycles/*/events.parquet").drop("case_id", "realization")
    cycles = polars.scan_parquet(f"{run}/statistics/cycles.parquet")
    keys = ["magnification", "realization"]
    yield events.join(cycles, on="cycle_id").group_by(keys).agg(polars.len(), polars.sum("energy_lost_j")).collect().rows()
    yield duckdb.sql(f"""
        select c.magnification, c.realization, count(*), sum(e.energy_lost_j)
        from '{run}/cycles/*/events.parquet' e join '{run}/statistics/cycles.parquet' c using (cycle_id) group by all""").fetchall()
    # Without cases that share a cycle, all three columns join.
    keys = ["cycle_id", "case_id", "realization"]
    events = polars.scan_parquet(f"{run}/cycles/*/events.parquet")
    yield (
        events.join(cycles, on=keys).group_by("magnification", "realization").agg(polars.len(), polars.sum("energy_lost_j")).collect().rows()
    )


def events_by_cycle(folder):
    wanted = plain(folder)
    compared = 0
    for found in joined(folder):
        assert len(found) == len(wanted), found
        for magnification, realization, count, energy_j in found:
            assert count == wanted[(magnification, realization)][0]
            close(energy_j, wanted[(magnification, realization)][1], (magnification, realization))
            compared += 2
    return compared


def identities(folder):
    """Every row of every table of a cycle names its cycle, and the table of cycles has it."""
    cycles = {row["cycle_id"]: row for row in rows(folder / "statistics/cycles.parquet")}
    assert {path.name for path in folder.glob("cycles/*/")} == set(cycles)
    compared = 0
    for name, cycle in cycles.items():
        assert cycle["status"] == "done" and cycle["failure"] is None and cycle["asperities_id"] == cycle["surface_id"]
        for table in OF_A_CYCLE:
            for row in rows(folder / f"cycles/{name}/{table}.parquet"):
                assert (row["cycle_id"], row["case_id"], row["realization"]) == (name, cycle["case_id"], cycle["realization"]), (name, table)
                compared += 1
        asperities = rows(folder / f"asperities/{cycle['asperities_id']}.parquet")
        assert {(row["surface_id"], row["realization"]) for row in asperities} == {(cycle["surface_id"], cycle["realization"])}
    for table in ["realizations", "avalanches", "events"]:
        for row in rows(folder / f"statistics/{table}.parquet"):
            cycle = cycles[row["cycle_id"]]
            assert all(row[name] == cycle[name] for name in ["case_id", "realization", "surface_id", "asperities_id"])
            compared += 1
    # From an event to its asperity, or to its merged contact.
    found = duckdb.sql(f"""
        select count(*) from '{folder}/cycles/*/events.parquet' e join '{folder}/statistics/cycles.parquet' c using (cycle_id)
        where exists (from '{folder}/asperities/*.parquet' a where a.surface_id = c.surface_id and a.asperity_id = e.asperity_id)
        or exists (from '{folder}/cycles/*/merged.parquet' m where m.cycle_id = e.cycle_id and m.asperity_id = e.asperity_id
            and (m.branch = 'loading' or m.max_load = e.max_load))""").fetchall()
    assert found[0][0] == sum(len(rows(path)) for path in folder.glob("cycles/*/events.parquet"))
    return compared


def ends_of_curves(folder):
    """The last point of each averaged unloading branch is the mean of the ends of the branches: each realization at its own maximum tensile load."""
    curves = rows(folder / "statistics/curves.parquet")
    compared = 0
    for curve in curves:
        if curve["branch"] != "unloading" or curve["tension_fraction"] != 1.0:
            continue
        ends = []
        for row in rows(folder / "statistics/cycles.parquet"):
            if row["case_id"] == curve["case_id"]:
                steps = rows(folder / f"cycles/{row['cycle_id']}/steps.parquet")
                ends.append(min((step for step in steps if step["max_load"] == curve["max_load"]), key=lambda step: step["load"]))
        assert curve["realization_count"] == len(ends)
        for mean, column in [("load", "load"), ("area_mean", "area"), ("penetration_mean", "penetration")]:
            close(curve[mean], math.fsum(end[column] for end in ends) / len(ends), (curve["case_id"], mean))
            compared += 1
    assert compared
    return compared


def main():
    folder = Path(sys.argv[1])
    print(f"{events_by_cycle(folder)} sums, {identities(folder)} rows, {ends_of_curves(folder)} means")


main()
