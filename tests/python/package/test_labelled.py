"""Results as labelled arrays."""

import numpy as np
import pytest

import hysteron

pytest.importorskip("xarray")


def test_results_have_the_rows_of_the_tables(campaign):
    results, cases = campaign.results(), campaign.cases
    assert results.sizes["case_id"] == len(set(cases["case_id"].to_pylist()))
    for row in cases.to_pylist():
        found = results["loss_mean"].sel(case_id=row["case_id"], max_load=row["max_load"])
        assert float(found) == row["loss_mean"]
    assert results["loss_mean"].attrs["long_name"] == hysteron.describe(cases)["loss_mean"].description
    each = campaign.results(realizations=True)
    row = campaign.realizations.to_pylist()[-1]
    place = {name: row[name] for name in ("case_id", "max_load", "realization")}
    assert float(each["area_at_max_load"].sel(place)) == row["area_at_max_load"]


def test_a_loop_is_loading_and_unloading(campaign):
    name = campaign.cycle_ids[0]
    loop, steps = campaign.loop(name), campaign.steps(name).to_pylist()
    assert loop["branch"].values[0] == "loading" and loop["branch"].values[-1] == "unloading"
    reversal = max(row["reversal_load"] for row in steps if row["reversal_load"] is not None)
    assert loop.attrs["max_load"] == reversal
    for step, load in zip(loop["step"].values, loop["load_n"].values, strict=True):
        assert steps[step]["load_n"] == load
    assert loop["load_n"].attrs["units"] == "N"
    with pytest.raises(ValueError, match="no load reversal at 7"):
        campaign.loop(name, max_load=7.0)


def test_maps_have_coordinates(campaign):
    pytest.importorskip("h5py")
    name = next(name for name in campaign.cycle_ids if (campaign.dir / "cycles" / name / "maps.h5").is_file())
    maps = campaign.maps(name)
    labelled = maps.to_xarray()
    assert labelled["pressure"].dims == ("step", "x", "y") and np.array_equal(labelled["gap"], maps.gap_m)
    at_pull_off = labelled.isel(step=int(labelled["load"].argmin()))
    assert float(at_pull_off["in_contact"].mean()) == pytest.approx(maps.in_contact()[maps.loads_n.argmin()].mean())
