#!/bin/sh
# SurfaceTopography spreads the points of a line scan evenly if its coordinates are in metres, and leaves them in place if they are in µm.
#
# Packages: SurfaceTopography 1.27.1 (PyPI), numpy 2.4.6.
# Behaviour: the reader of text with two columns (x, height) takes a scan for uniform if no spacing differs from the mean spacing by more
# than 1e-6. The limit is a length in the unit of the file, not a fraction of the spacing. In metres it is one micrometre: every scan with
# spacings below that is uniform. The x column is then dropped, and the heights are placed at equal distances. No warning is given, and
# the limit cannot be set through `open_topography`.
# Output seen (November 2026): h = 0.2 sin(2 pi x / 10), 200 points, spacings of 0.1 and 0.9 at random (µm), rms slope exact 0.0889:
#     file in µm: NonuniformLineScan, first x [0.  0.9 1.8 2.7 2.8] µm, rms slope 0.0875, rms curvature 0.055 1/µm
#     file in m: UniformLineScan, first x [0.    0.518 1.036 1.554 2.072] µm, rms slope 0.1100, rms curvature 0.209 1/µm
# Why it matters: profiles with unequal steps come from styli with their own encoder, from contours of electron micrographs, and from
# joined scans. SI units are the careful choice of an exporter, and they are the ones that lose the positions. Slope, curvature and spectrum
# change, here the curvature by a factor of 3.8; the rms height hardly changes, so that nothing shows it.
#
# Exit code: 0 if the behaviour is as described, 1 if it has changed.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet SurfaceTopography==1.27.1 numpy==2.4.6
cd "$folder"
"$folder/venv/bin/python" - <<'PY'
import sys

import numpy
from SurfaceTopography.IO import open_topography

x = numpy.cumsum(numpy.random.default_rng(1).choice([0.1, 0.9], 200))
x -= x[0]
h = 0.2 * numpy.sin(2 * numpy.pi * x / 10)
found = {}
for unit, metre in (("µm", 1.0), ("m", 1e-6)):
    numpy.savetxt("line.xyz", numpy.column_stack([x, h]) * metre)
    scan = open_topography("line.xyz").topography(unit=unit).to_unit("µm")
    places, _ = scan.positions_and_heights()
    found[unit] = (scan.is_uniform, float(scan.Rdq()), float(scan.Rddq()), float(abs(places - x).max()))
    name = "UniformLineScan" if scan.is_uniform else "NonuniformLineScan"
    print(f"file in {unit}: {name}, first x {numpy.round(places[:5], 3)} µm, rms slope {scan.Rdq():.4f}, rms curvature {scan.Rddq():.3f} 1/µm")
kept = not found["µm"][0] and found["µm"][3] < 1e-9
moved = found["m"][0] and found["m"][3] > 1 and found["m"][2] / found["µm"][2] > 3
sys.exit(0 if kept and moved else "the behaviour has changed")
PY
echo "as described"
