"""The worked example of the README: from a scan to its curve."""

import os
import subprocess
import sys

import numpy as np
import pytest

import hysteron


def test_a_scan_is_taken(program, tmp_path):
    i, j = np.mgrid[:64, :72]
    np.save(tmp_path / "scan.npy", np.cos(0.3 * i) * np.sin(0.25 * j) + 0.01 * i)
    about = hysteron.take(tmp_path / "scan.npy", tmp_path / "scan.h5", pixel_m=1e-8, unit="nm")
    assert about["point_count"] == 64 and about["length_m"] == pytest.approx(64e-8, rel=1e-12)
    # Mean square 1/4 of a product of two waves, times the transmission of the Gaussian filter with a cut-off of 8 points.
    # The waves do not end at the edges of the scan.
    transmission = 2.0 ** -((8 * 0.3 / (2 * np.pi)) ** 2 + (8 * 0.25 / (2 * np.pi)) ** 2)
    assert about["rms_height_m"] == pytest.approx(0.5e-9 * transmission, rel=0.1)
    assert (tmp_path / "scan.h5").exists() and about["file"] == str(tmp_path / "scan.h5")
    alone = hysteron.take(tmp_path / "scan.npy", pixel_m=1e-8, unit="nm")
    assert alone["file"] is None and alone["rms_slope"] == about["rms_slope"]
    with pytest.raises(hysteron.Failed, match="no unit of the heights in the file"):
        hysteron.take(tmp_path / "scan.npy")


def test_an_array_is_taken_as_its_file_is(program, tmp_path):
    i, j = np.mgrid[:64, :72]
    heights = np.cos(0.3 * i) * np.sin(0.25 * j)
    np.save(tmp_path / "scan.npy", heights)
    told = {"pixel_m": 1e-8, "unit": "nm"}
    of_file, of_array = (hysteron.take(scan, **told) for scan in (tmp_path / "scan.npy", heights))
    assert {key: of_file[key] for key in ("rms_height_m", "rms_slope", "spectrum")} == {
        key: of_array[key] for key in ("rms_height_m", "rms_slope", "spectrum")
    }
    masked = np.ma.masked_where(np.hypot(i - 32, j - 36) < 2, heights)
    with pytest.raises(hysteron.Failed, match="the number of missing points is 9\nhelp: expected none"):
        hysteron.take(masked, **told)
    assert hysteron.take(masked, **told, fill=True)["missing_count"] == 9


def test_a_message_of_take_has_its_own_terms(program, tmp_path):
    heights = np.cos(0.3 * np.arange(64))[:, None] * np.ones(64)
    with pytest.raises(hysteron.Failed) as error:
        hysteron.take(heights, unit="nm")
    message = str(error.value)
    assert "the array" in message and "pixel_m=" in message and "--" not in message and "array.npy" not in message
    np.save(tmp_path / "scan.npy", heights)
    with pytest.raises(hysteron.Failed, match=r"scan\.npy: .*\nhelp: give the unit \(unit=, or surface\.unit in a spec\)"):
        hysteron.take(tmp_path / "scan.npy", pixel_m=1e-9)


def test_a_line_of_an_array_runs_along_x(program, tmp_path):
    h5py = pytest.importorskip("h5py")
    y, x = np.mgrid[:32, :48]
    image = np.exp(-(((x - 12) / 4) ** 2) - ((y - 20) / 4) ** 2) + 0.01 * np.sin(0.9 * x + 0.7 * y)
    for scan, more in ((image, {}), (image.T.copy(), {"transpose": True})):
        about = hysteron.take(scan, tmp_path / "scan.h5", size="480 nm x 320 nm", unit="nm", points=4, force=True, **more)
        assert about["source_point_counts"] == [48, 32]
        with h5py.File(tmp_path / "scan.h5") as file:
            top = np.unravel_index(np.argmax(file["height_m"]), (32, 32))
        # The central square begins at the eighth of 48 columns.
        assert top == (12 - 8, 20)


def test_a_surface_that_was_not_written_is_no_generated_one(program, tmp_path):
    with pytest.raises(ValueError, match="surface.file is None\nhelp: give a file, for example from `take` with `out`"):
        hysteron.run({"name": "x", "surface": {"file": None}}, out=tmp_path / "run")
    with pytest.raises(hysteron.Failed, match="cannot be read"):
        hysteron.run({"name": "x", "surface": {"file": tmp_path / "gone.npy", "periodic": True}}, out=tmp_path / "run")


def test_the_example_ends_at_a_figure(program, root, tmp_path):
    pytest.importorskip("matplotlib")
    environment = dict(os.environ, PYTHONDONTWRITEBYTECODE="1")
    command = [sys.executable, str(root / "data" / "examples" / "own_scan.py")]
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, encoding="utf-8", check=False)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "own_scan.png").read_bytes().startswith(b"\x89PNG")
    assert "rms height" in done.stdout and "own_scan.png: " in done.stdout


def test_an_existing_file_is_replaced_on_request_only(program, tmp_path):
    heights = np.random.default_rng(1).normal(size=(64, 64)).cumsum(0).cumsum(1)
    out = tmp_path / "mine.h5"
    out.write_text("mine")
    told = {"pixel_m": 1e-6, "unit": "nm"}
    with pytest.raises(hysteron.Failed, match="the file exists\nhelp: use another out=, or force=True"):
        hysteron.take(heights, out, **told)
    assert out.read_text() == "mine"
    hysteron.take(heights, out, **told, force=True)
    assert out.stat().st_size > heights.nbytes


def test_messages_name_arguments_and_no_temporary_file(program, tmp_path):
    heights = np.random.default_rng(1).normal(size=(64, 64)).cumsum(0).cumsum(1)
    for told, wanted in [
        ({}, "unit="),
        ({"unit": "nm"}, "pixel_m="),
        ({"unit": "nm", "pixel_m": 1e-6, "dataset": "z"}, "dataset="),
    ]:
        with pytest.raises(hysteron.Failed, match="^error: ") as failed:
            hysteron.take(heights, **told)
        said = str(failed.value)
        assert wanted in said and "--" not in said and "hysteron-" not in said and "array.npy" not in said, said
    with pytest.raises(hysteron.Failed, match=r"^error: .*(\n.*)*spec\.toml:1:") as failed:
        hysteron.run("name = 1\nseed = 'a'\n")
    assert "hysteron-" not in str(failed.value)


@pytest.mark.parametrize("strange", [np.ones((64, 64), bool), np.ones((64, 64), complex), np.full((64, 64), "1"), np.zeros((64, 64), "M8[s]")])
def test_a_scan_has_real_numbers(program, strange):
    with pytest.raises(TypeError, match="cannot compute with an array of type .*\nhelp: use real numbers"):
        hysteron.take(strange, pixel_m=1e-6, unit="nm")
