#!/bin/sh
# surfalize excludes masked points from its parameters, and saves them as valid heights in every format, its own included.
#
# Packages: surfalize 0.19.2 (PyPI), numpy 2.4.6.
# Behaviour: a mask of surfalize excludes outliers and damaged regions from levelling and parameters, and filters refuse a masked surface.
# `save` writes the heights below the mask and not the mask, neither as missing points, for which the formats have a mark, nor in the own
# format .sflz. No warning is given. The file that is read back has other parameters than the surface that was saved.
# Output seen (November 2026): noise of rms 0.01 µm with a masked spike of 10 µm on 16 of 4096 points; Sq in µm:
#     before 0.009981
#     read back: sur 0.623868, x3p 0.623868, sdf 0.623868, al3d 0.623868, tmd 0.623868, sflz 0.623868
#     missing or masked points: 0
# Why it matters: a scan is cleaned in one program and its contact is computed in another. The spikes come back on the way. A spike is the
# first asperity in contact and carries the load, and its slope adds to the rms slope, while the person who masked it relies on a clean
# file. `data` with NaN at the masked points, in a new surface, is saved as intended.
#
# Exit code: 0 if the behaviour is as described, 1 if it has changed.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet surfalize==0.19.2 numpy==2.4.6
cd "$folder"
"$folder/venv/bin/python" - <<'PY'
import sys
import warnings

import numpy
import surfalize

warnings.simplefilter("error")
heights = numpy.random.default_rng(0).normal(size=(64, 64)) * 0.01
mask = numpy.zeros((64, 64), bool)
mask[30:34, 30:34] = True
heights[mask] = 10.0
surface = surfalize.Surface(heights, 0.5, 0.5, mask=mask)
before = float(surface.Sq())
print(f"before {before:.6f}")
after, lost = {}, 0
for name in ("sur", "x3p", "sdf", "al3d", "tmd", "sflz"):
    surface.save(f"a.{name}")
    other = surfalize.Surface.load(f"a.{name}")
    after[name] = float(other.Sq())
    lost += int(numpy.isnan(other.data).sum()) + int(other.has_masked_points)
print("read back:", ", ".join(f"{name} {value:.6f}" for name, value in after.items()))
print("missing or masked points:", lost)
surfalize.Surface(numpy.where(mask, numpy.nan, heights), 0.5, 0.5).save("b.sur")
kept = int(numpy.isnan(surfalize.Surface.load("b.sur").data).sum())
right = before < 0.0101 and all(abs(value - 0.623868) < 1e-4 for value in after.values()) and lost == 0 and kept == 16
sys.exit(0 if right else "the behaviour has changed")
PY
echo "as described"
