"""Plots, the display in notebooks and the tutorial notebook."""

import json
import os
import subprocess
import sys

import numpy as np
import pytest

import hysteron

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")


def test_a_loop_is_drawn_in_three_lines(campaign):
    ax = hysteron.plot.loop(campaign)
    loading, unloading = ax.get_lines()
    assert loading.get_linestyle() == "--" and unloading.get_linestyle() == "-"
    steps = campaign.steps(campaign.cycle_ids[0])
    largest = max(load for load in steps["max_load"].to_pylist() if load is not None)
    assert loading.get_ydata()[-1] == pytest.approx(largest, rel=1e-6)
    assert unloading.get_ydata().min() < 0
    with pytest.raises(ValueError, match="no unloading from"):
        hysteron.plot.loop(campaign, max_load=1.0)


def test_other_plots(campaign):
    pytest.importorskip("h5py")
    cases = set(campaign.curves["case_id"].to_pylist())
    assert len(hysteron.plot.curves(campaign).get_legend().get_texts()) == len(cases)
    hysteron.plot.curves(campaign, "penetration")
    ax = hysteron.plot.contacts(campaign)
    count = int(ax.get_title().split(": ")[1].split()[0])
    assert count == len(ax.collections[0].get_offsets()) > 10
    assert len(hysteron.plot.spectrum(campaign).get_lines()[0].get_xdata()) > 5


def test_events_of_all_cycles_have_the_parameters(campaign):
    events = campaign.events()
    counts = [campaign.events(id).num_rows for id in campaign.cycle_ids]
    assert events.num_rows == sum(counts)
    assert {"magnification", "contact_modulus_pa", "kind", "energy_lost_j"} <= set(events.schema.names)
    cycles = campaign["statistics/cycles"]
    zeta = dict(zip(cycles["cycle_id"].to_pylist(), cycles["magnification"].to_pylist(), strict=True))
    found = zip(events["cycle_id"].to_pylist(), events["magnification"].to_pylist(), strict=True)
    assert all(zeta[id] == value for id, value in found)
    assert np.isfinite(events["energy_lost_j"].to_numpy()).any()


def test_a_run_in_a_notebook(campaign):
    shown = campaign._repr_html_()
    assert campaign.name in shown and shown.count("<tr>") == min(campaign.cases.num_rows, 20) + 1
    assert campaign.report.is_file() and campaign.spec.startswith("name = ")


def test_aliases():
    assert hysteron.import_surface is hysteron.take
    assert hysteron.HysteronError is hysteron.Failed and hysteron.FailedCasesWarning is hysteron.FailedCases


def test_the_tutorial_notebook_runs(program, root, tmp_path):
    pytest.importorskip("h5py")
    cells = json.loads((root / "data" / "examples" / "tutorial.ipynb").read_text(encoding="utf-8"))["cells"]
    code = "\n".join("".join(cell["source"]) for cell in cells if cell["cell_type"] == "code")
    (tmp_path / "cells.py").write_text(code + "\nprint(run.cases.num_rows, 'rows')\n", encoding="utf-8")
    environment = {**os.environ, "MPLBACKEND": "Agg"}
    said = subprocess.run([sys.executable, "cells.py"], cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert said.returncode == 0, said.stderr
    assert "4 rows" in said.stdout
