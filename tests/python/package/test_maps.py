"""Maps of boundary elements: the arrays and the picture of the regions."""

import pytest

import hysteron

h5py = pytest.importorskip("h5py")
np = pytest.importorskip("numpy")

N = 8


@pytest.fixture
def run(tmp_path):
    """A run with one cycle of two maps, written in reverse order: an L-shaped region with a tensile corner, and two tensile points."""
    (tmp_path / "campaign.toml").write_text('name = "maps"\n', encoding="utf-8")
    folder = tmp_path / "cycles" / "z4_r00-0a1b2c3d"
    folder.mkdir(parents=True)
    (folder / "steps.parquet").write_bytes(b"")
    with h5py.File(folder / "maps.h5", "w") as file:
        file.attrs.update({"length_m": 8e-6, "points": N, "contact_gap_m": 1e-9, "first_m": 0.5e-6})
        for step, branch, load in ((12, "unloading", -3e-6), (5, "loading", 9e-6)):
            group = file.create_group(f"step_{step:06}")
            group.attrs.update({"step": step, "branch": branch, "max_load": 0.01, "approach_m": 1e-7, "load_n": load})
            gap, pressure = np.full((N, N), 1e-7, np.float32), np.zeros((N, N), np.float32)
            if branch == "loading":
                gap[1:6, 2], gap[5, 2:7] = 0, 0
                pressure[1:6, 2], pressure[5, 2:7] = 4e6, 4e6
                pressure[5, 6] = -1e6
            else:
                gap[3, 3:5], pressure[3, 3:5] = 0, -2e6
            group["gap_m"], group["pressure_pa"] = gap, pressure
    return hysteron.load(tmp_path)


def test_maps_are_ordered_by_step(run):
    maps = run.maps("z4_r00-0a1b2c3d")
    assert maps.steps.tolist() == [5, 12] and maps.branches.tolist() == ["loading", "unloading"]
    assert maps.loads_n.tolist() == [9e-6, -3e-6] and maps.max_loads.tolist() == [0.01, 0.01] and maps.approaches_m.tolist() == [1e-7, 1e-7]
    # A point each µm, from half of one.
    assert np.allclose(maps.x_m, 1e-6 * (np.arange(N) + 0.5), rtol=1e-12) and np.array_equal(maps.x_m, maps.y_m)
    assert maps.pressure_pa.shape == maps.gap_m.shape == (2, N, N) and maps.pressure_pa.dtype == np.float32
    assert maps.pressure_pa[0, 1, 2] == 4e6 and maps.pressure_pa[0, 2, 1] == 0
    assert maps.in_contact().sum(axis=(1, 2)).tolist() == [9, 2]


def test_cycles_without_maps_are_errors(run):
    with pytest.raises(KeyError, match="did you mean z4_r00-0a1b2c3d"):
        run.maps("z4_r00-0a1b2c3e")
    with pytest.raises(KeyError, match="only cycles by boundary elements"):
        run.maps("x")


def test_contacts_of_boundary_elements_have_their_shape(run):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    ax = hysteron.plot.contacts(run)
    assert not ax.collections and ax.get_title() == "step 5, loading: A/A₀ = 0.141"
    # Rows of the picture run along y. Points out of contact are masked; the scale is in MPa.
    drawn = ax.images[0].get_array()
    assert drawn[2, 1] == 4 and drawn[6, 5] == -1 and (~np.ma.getmaskarray(np.ma.masked_invalid(drawn))).sum() == 9
    assert ax.get_xlim() == (0, 8)
    ax = hysteron.plot.contacts(run, step=12)
    assert ax.get_title() == "step 12, unloading: A/A₀ = 0.031"
    with pytest.raises(ValueError, match="no map is stored at step 7"):
        hysteron.plot.contacts(run, step=7)


def test_maps_with_fewer_points(run):
    with h5py.File(run.dir / "cycles" / "z4_r00-0a1b2c3d" / "maps.h5", "r+") as file:
        group = file.create_group("step_000009")
        group.attrs.update({"step": 9, "branch": "loading", "max_load": np.nan, "approach_m": 1e-7, "load_n": 1e-6, "stride": 2})
        group["gap_m"], group["pressure_pa"] = np.zeros((N // 2, N // 2), np.float32), np.full((N // 2, N // 2), 3e6, np.float32)
    maps = run.maps("z4_r00-0a1b2c3d")
    assert maps.steps.tolist() == [5, 9, 12] and maps.pressure_pa.shape == (3, N // 2, N // 2)
    # Points 0, 2, 4, 6 of the other maps: (2, 2) and (4, 2) of the region of the first one.
    assert np.allclose(maps.x_m, 1e-6 * (2 * np.arange(N // 2) + 0.5), rtol=1e-12)
    assert maps.in_contact().sum(axis=(1, 2)).tolist() == [2, 16, 0] and np.isnan(maps.max_loads[1])
    whole = run.maps("z4_r00-0a1b2c3d", whole=True)
    assert whole.steps.tolist() == [5, 12] and whole.pressure_pa.shape == (2, N, N)
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    assert hysteron.plot.contacts(run, step=9).get_title() == "step 9, loading: A/A₀ = 1.000"
    assert hysteron.plot.contacts(run).get_title() == "step 5, loading: A/A₀ = 0.141"
