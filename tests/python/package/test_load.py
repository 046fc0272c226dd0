"""A finished run as Arrow tables."""

import gc
import shutil

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

import hysteron


def test_tables_are_those_of_the_files(campaign):
    files = {path.relative_to(campaign.dir).as_posix().removesuffix(".parquet") for path in campaign.dir.rglob("*.parquet")}
    assert set(campaign) == files and len(campaign) == len(files) > 0
    assert list(campaign) == sorted(files)
    for name, table in campaign.items():
        assert isinstance(table, pa.Table)
        assert table.equals(pq.read_table(campaign.dir / f"{name}.parquet", partitioning=None)), name
        assert b"hysteron" in table.schema.metadata, name
        assert name in campaign
    assert "statistics/nothing" not in campaign and 7 not in campaign
    assert repr(campaign) == f"hysteron.load({str(campaign.dir)!r})"


def test_short_names(campaign):
    # Boundary elements have no table of load reversals.
    id = next(id for id in campaign.cycle_ids if f"cycles/{id}/turning" in campaign)
    for name in ("steps", "events", "contacts", "turning", "merged"):
        assert getattr(campaign, name)(id).equals(campaign[f"cycles/{id}/{name}"])
    for name in ("cases", "realizations", "curves", "avalanches"):
        assert getattr(campaign, name).equals(campaign[f"statistics/{name}"])
    assert campaign.all_events.num_rows == campaign.avalanches["event_count"].to_numpy().sum()
    for id in campaign.surface_ids:
        assert campaign.asperities(id).num_rows > 0


def test_what_is_not_there(campaign, tmp_path):
    with pytest.raises(KeyError, match="has no table statistics/case; did you mean statistics/cases"):
        campaign["statistics/case"]
    with pytest.raises(KeyError, match="has no surface"):
        campaign.surface("nothing")
    with pytest.raises(FileNotFoundError, match="no such directory\nhelp: give the output directory of a run"):
        hysteron.load(tmp_path / "nothing")
    with pytest.raises(FileNotFoundError, match="no campaign.toml\nhelp: give the output directory of a run"):
        hysteron.load(tmp_path)


def test_a_run_that_is_not_finished(campaign, tmp_path):
    shutil.copy(campaign.dir / "campaign.toml", tmp_path)
    begun = hysteron.load(tmp_path)
    assert list(begun) == begun.cycle_ids == begun.surface_ids == []
    (tmp_path / "statistics").mkdir()
    # A file that is being written has no name yet.
    shutil.copy(campaign.dir / "statistics/cases.parquet", tmp_path / "statistics/.hysteron-1.parquet")
    assert list(begun) == []
    shutil.copy(campaign.dir / "statistics/cases.parquet", tmp_path / "statistics")
    assert list(begun) == ["statistics/cases"] and begun.cases.num_rows > 0


def test_descriptions(campaign):
    told = hysteron.describe(campaign.steps(campaign.cycle_ids[0]))
    assert told["load_n"].unit == "N" and told["load_n"].source == "Eq 1"
    assert told["load_n"].description.startswith("Normal load")
    assert told["branch"].unit is None
    for table in campaign.values():
        told = hysteron.describe(table)
        assert list(told) == table.column_names
        for name, column in told.items():
            assert column.description and (column.unit or not pa.types.is_floating(table.schema.field(name).type))
    assert hysteron.describe(table.schema) == told
    assert hysteron.describe(pa.table({"own": [1]})) == {}


def test_surface(campaign):
    pytest.importorskip("h5py")
    for id in campaign.surface_ids:
        heights = campaign.surface(id)
        assert heights.dtype == np.float64 and heights.ndim == 2 and heights.shape[0] == heights.shape[1]
        assert abs(heights.mean()) < 1e-6 * heights.std()


def test_surface_without_h5py(campaign, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "h5py", None)
    with pytest.raises(ImportError, match="h5py is not installed\nhelp: pip install h5py"):
        campaign.surface(campaign.surface_ids[0])


def test_the_pycapsule_interface(campaign):
    table = campaign.cases
    capsule = table.__arrow_c_stream__()
    assert type(capsule).__name__ == "PyCapsule"
    again = pa.RecordBatchReader.from_stream(table).read_all()
    assert again.equals(table, check_metadata=True)


def test_polars_takes_them_without_copying(campaign):
    polars = pytest.importorskip("polars")
    table = campaign.contacts(campaign.cycle_ids[0])
    frame = polars.DataFrame(table)
    assert frame.shape == table.shape
    shared = 0
    for name in table.column_names:
        column = table.column(name)
        assert frame[name].cast(polars.String).to_list() == column.cast(pa.string()).to_pylist() or frame[name].dtype == polars.Float64
        if pa.types.is_floating(column.type) and column.num_chunks == 1:
            address, _, length = frame[name]._get_buffer_info()
            assert address == column.chunk(0).buffers()[1].address and length == table.num_rows, name
            shared += 1
    assert shared > 0
    # The frame holds what it shares.
    total = frame.select(polars.selectors.float().sum()).row(0)
    del table, column
    gc.collect()
    assert frame.select(polars.selectors.float().sum()).row(0) == total
    # Through the capsule alone, as any other library would.
    class Stream:
        def __init__(self, table):
            self.table = table

        def __arrow_c_stream__(self, requested_schema=None):
            return self.table.__arrow_c_stream__(requested_schema)

    assert polars.DataFrame(Stream(campaign.cases)).equals(polars.DataFrame(campaign.cases))


def test_duckdb_takes_them(campaign):
    duckdb = pytest.importorskip("duckdb")
    steps = campaign.steps(campaign.cycle_ids[0])
    count, greatest = duckdb.sql("select count(*), max(load_n) from steps").fetchone()
    assert count == steps.num_rows and greatest == max(steps["load_n"].to_pylist())


def test_numbers_of_a_run_agree_with_the_functions(campaign):
    """The summits' moments are not those of the spectrum, but what a case says of its spectrum is what `spectrum` and `theory` say."""
    from hysteron import spectrum, theory

    cases = campaign.cases
    column = {name: cases[name].to_numpy() for name in ("length_m", "rms_height_m", "hurst", "magnification")}
    gel = {name: cases[name].to_numpy() for name in ("contact_modulus_pa", "work_of_adhesion_j_m2")}
    moments = spectrum.moments(**column)
    unit_j = gel["contact_modulus_pa"] * column["length_m"] ** 2 * column["rms_height_m"]
    area_m2 = cases["area_at_max_load_mean"].to_numpy() * column["length_m"] ** 2
    loss = theory.deng_kesari_loss(moments, area_m2, **gel) / unit_j
    np.testing.assert_allclose(cases["loss_dk_mean"].to_numpy(), loss, rtol=1e-12)


def test_a_damaged_run_is_shown(campaign, tmp_path):
    for name, content in [
        ("statistics/cases.parquet", b"damaged"),
        ("statistics/cases.parquet", b"PAR1" + 100 * b"x" + b"PAR1"),
        ("campaign.toml", b"\xff\xfe"),
    ]:
        folder = tmp_path / f"{len(list(tmp_path.iterdir()))}"
        shutil.copytree(campaign.dir, folder)
        (folder / name).write_bytes(content)
        shown = hysteron.load(folder)._repr_html_()
        assert "cannot show the run" in shown and "hysteron verify" in shown
    (folder / "statistics/cases.parquet").unlink()
    (folder / "campaign.toml").write_text('name = "x"\n')
    (folder / "datapackage.json").write_text("{")
    assert "cannot show the run" in hysteron.load(folder)._repr_html_()
