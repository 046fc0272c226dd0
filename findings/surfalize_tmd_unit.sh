#!/bin/sh
# A TMD file has lengths in millimetres for SurfaceTopography and in micrometres for surfalize, which reads and writes it.
#
# Packages: surfalize 0.19.2, SurfaceTopography 1.27.1 (PyPI), numpy 2.4.6.
# Behaviour: a TMD file (TrueMap, GelSight) has no field for a unit. SurfaceTopography takes lengths and heights for millimetres, as a MATLAB
# reader of such files does that is published. surfalize takes them for its own unit, µm, without a conversion. A scan of an instrument is
# then 1000 times too small in surfalize, and a scan that surfalize has written is 1000 times too large in SurfaceTopography. surfalize reads
# its own files back correctly.
# Output seen (November 2026): 24 x 16 µm, rms height 0.1237 µm, written by surfalize:
#     surfalize: 24 x 16 µm, rms height 0.1237 µm, rms slope 0.0909
#     SurfaceTopography: 24000 x 16000 µm, rms height 123.6695 µm, rms slope 0.0921
# Why it matters: all lengths change together, so that slopes, the contact fraction and the picture stay right. What has a length does not: radii of
# asperities, loads (as the square), pull-off forces, and the ratio of elastic energy to the work of adhesion, which is wrong by 1000.
#
# Exit code: 0 if the behaviour is as described, 1 if it has changed.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet surfalize==0.19.2 SurfaceTopography==1.27.1 numpy==2.4.6
cd "$folder"
"$folder/venv/bin/python" - <<'PY'
import sys

import numpy
import surfalize
from SurfaceTopography.IO import open_topography

y, x = numpy.mgrid[:32, :48]
surfalize.Surface(numpy.exp(-(((x - 36) / 4) ** 2) - ((y - 8) / 4) ** 2), 0.5, 0.5).save("a.tmd")
one = surfalize.Surface.load("a.tmd")
other = open_topography("a.tmd").topography().to_unit("µm")
sizes = [(one.size.x * one.step_x, one.size.y * one.step_y), tuple(float(side) for side in other.physical_sizes)]
rms = [float(one.Sq()), float(other.Sq())]
slopes = [float(one.Sdq()), float(other.rms_gradient())]
for name, size, height, slope in zip(("surfalize", "SurfaceTopography"), sizes, rms, slopes):
    print(f"{name}: {size[0]:.0f} x {size[1]:.0f} µm, rms height {height:.4f} µm, rms slope {slope:.4f}")
thousand = all(abs(b / a / 1000 - 1) < 1e-5 for a, b in ((rms[0], rms[1]), (sizes[0][0], sizes[1][0]), (sizes[0][1], sizes[1][1])))
sys.exit(0 if thousand else "the behaviour has changed")
PY
echo "as described"
