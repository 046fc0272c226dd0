"""Plots, the display in notebooks and the tutorial notebook."""

import json
import os
import subprocess
import sys

import numpy as np
import pyarrow as pa
import pytest

import hysteron

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")


def test_a_loop_is_drawn_in_three_lines(campaign):
    ax = hysteron.plot.loop(campaign)
    loading, unloading = ax.get_lines()
    assert loading.get_linestyle() == "--" and unloading.get_linestyle() == "-"
    # The default cycle is one of the case by the asperity model with the largest mean dissipated energy.
    rows = campaign.cases.select(["case_id", "method", "loss_mean"]).to_pylist()
    best = max((row for row in rows if row["method"] == "asperities"), key=lambda row: row["loss_mean"])["case_id"]
    cycle = next(row["cycle_id"] for row in campaign["statistics/cycles"].to_pylist() if row["case_id"] == best)
    steps = campaign.steps(cycle)
    largest = max(load for load in steps["max_load"].to_pylist() if load is not None)
    # The load may jump over F_max.
    reversal = steps["reversal_load"].to_pylist().index(largest)
    assert loading.get_ydata()[-1] == steps["load"][reversal].as_py() >= largest * (1 - 1e-6)
    assert len(unloading.get_ydata()) == steps["max_load"].to_pylist().count(largest) and unloading.get_ydata().min() < 0
    with pytest.raises(ValueError, match="no unloading from"):
        hysteron.plot.loop(campaign, max_load=1.0)


def test_other_plots(campaign):
    pytest.importorskip("h5py")
    cases = set(campaign.curves["case_id"].to_pylist())
    texts = [text.get_text() for text in hysteron.plot.curves(campaign).get_legend().get_texts()]
    assert len(set(texts)) == len(cases) and all("Δγ = " in text for text in texts), texts
    hysteron.plot.curves(campaign, "penetration")
    ax = hysteron.plot.contacts(campaign)
    count = int(ax.get_title().split(": ")[1].split()[0])
    assert count == len(ax.collections[0].get_offsets()) > 2
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


def test_names_of_cases_are_the_fewest_parameters():
    rows = [("a", "zeta", 8.0, "asperities", "spots", 1.0), ("b", "zeta", 16.0, "asperities", "spots", 1.0), ("c", "x", 8.0, "boundary_elements", None, 1.0)]
    names = ("case_id", "sweep", "magnification", "method", "interaction", "max_load")
    table = pa.table({name: [row[k] for row in rows] for k, name in enumerate(names)})
    of = hysteron._run.case_names(table)
    assert of == {"a": "method = asperities, ζ = 8", "b": "method = asperities, ζ = 16", "c": "method = boundary_elements, ζ = 8"}
    assert hysteron._run.case_names(table.slice(0, 1)) == {"a": "a"}


def test_a_run_in_a_notebook(campaign):
    shown = campaign._repr_html_()
    assert campaign.name in shown and shown.count("<tr>") == min(campaign.cases.num_rows, 20) + 1
    assert campaign.report.is_file() and campaign.spec.startswith("name = ")


def test_a_bar_replaces_lines_of_progress():
    pytest.importorskip("IPython")
    shown = []

    class Handle:
        def update(self, html):
            shown.append(html.data)

    bar = hysteron._notebook.Bar(Handle())
    assert bar.line("progress page: data/runs/gel/progress.html\n") and not shown
    assert bar.line("cycle: 9 tasks, 2 done before\n") and bar.line("cycle: 3/9 H0.80_z8_r01-32d139d8\n") and bar.line("report: 1 task, 0 done before\n")
    assert [text.rsplit(" ", 1)[1] for text in shown] == ["2/9</label>", "3/9</label>", "0/1</label>"]
    assert not bar.line("warning: H0.80_z8_r01-32d139d8 failed\n") and not bar.line("error: 1/2\n")


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


def test_the_tutorial_in_a_kernel_has_a_progress_bar(program, root, tmp_path, monkeypatch):
    pytest.importorskip("h5py")
    pytest.importorskip("ipykernel")
    client = pytest.importorskip("nbclient")
    nbformat = pytest.importorskip("nbformat")
    monkeypatch.setenv("HYSTERON", str(program))
    notebook = nbformat.read(root / "data" / "examples" / "tutorial.ipynb", as_version=4)
    client.NotebookClient(notebook, timeout=300, kernel_name="python3", resources={"metadata": {"path": str(tmp_path)}}).execute()
    outputs = [output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs]
    assert "report <progress" in outputs[0].data["text/html"] and outputs[0].data["text/html"].endswith("1/1</label>")
    # The verdict before the run, and no other message.
    said = "".join(output.text for output in outputs if output.output_type == "stream" and output.name == "stderr")
    starts = ("regime ", "cost ", "warning[", " ")
    assert all(line.startswith(starts) for line in said.splitlines()), said
    assert sum("image/png" in output.get("data", {}) for output in outputs) == 3
