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
    # Two cosines have a quarter of the mean square each; their waves do not end at the edges of the scan.
    assert about["rms_height_m"] == pytest.approx(0.5e-9, rel=0.1)
    assert (tmp_path / "scan.h5").exists() and about["file"] == str(tmp_path / "scan.h5")
    alone = hysteron.take(tmp_path / "scan.npy", pixel_m=1e-8, unit="nm")
    assert alone["file"] is None and alone["rms_slope"] == about["rms_slope"]
    with pytest.raises(hysteron.Failed, match="how far apart its points are"):
        hysteron.take(tmp_path / "scan.npy")


def test_the_example_ends_at_a_figure(program, root, tmp_path):
    pytest.importorskip("matplotlib")
    environment = dict(os.environ, PYTHONDONTWRITEBYTECODE="1")
    command = [sys.executable, str(root / "data" / "examples" / "own_scan.py")]
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, encoding="utf-8", check=False)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "own_scan.png").read_bytes().startswith(b"\x89PNG")
    assert "rms height" in done.stdout and "own_scan.png: " in done.stdout
