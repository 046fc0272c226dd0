#!/bin/sh
# surfalize makes the pixels of an XYZ file too small, and ignores the coordinates when it places the heights.
#
# Packages: surfalize 0.19.2, SurfaceTopography 1.27.1 (PyPI), numpy 2.4.6.
# Behaviour: the spacing is the range of the coordinates over the number of points, n, instead of n - 1. The heights are placed in the order
# of the lines, as if x varied fastest. If y varies fastest, which is as common, the rows of a map that is not square are scrambled. If y
# or x decreases, the map is mirrored. No message is given. SurfaceTopography places each point by its coordinates. Coordinates are in metres.
# Output seen (November 2026): bump at x = 36, y = 8 µm, 48 x 32 points of 1 x 1 µm; spacing x, y in µm, place (column, row), rms slope:
#     x fastest | surfalize 0.9792, 0.9688 (36, 8) 0.0467 | SurfaceTopography 1.0000, 1.0000 (36, 8) 0.0461
#     y fastest | surfalize 0.9792, 0.9688 (8, 24) 0.1925 | SurfaceTopography 1.0000, 1.0000 (36, 8) 0.0461
# Why it matters: a map of 32 points loses 3 % of its length, 3 % are added to slopes and 6 % to curvatures, and square pixels get unequal
# sides. The error falls with the number of points, so that it looks like a size effect. Of scrambled rows only the height distribution is
# right.
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
import warnings

import numpy
import surfalize
from SurfaceTopography.IO import open_topography

warnings.simplefilter("ignore")
x, y = numpy.meshgrid(numpy.arange(48.0), numpy.arange(32.0), indexing="ij")
h = numpy.exp(-(((x - 36) / 4) ** 2) - ((y - 8) / 4) ** 2)
found = []
for name, order in (("x fastest", "F"), ("y fastest", "C")):
    numpy.savetxt("a.xyz", 1e-6 * numpy.column_stack([values.ravel(order=order) for values in (x, y, h)]))
    one = surfalize.Surface.load("a.xyz")
    other = open_topography("a.xyz").topography(unit="m").to_unit("µm")
    row, column = numpy.unravel_index(numpy.argmax(one.data), one.data.shape)
    place = numpy.unravel_index(numpy.argmax(other.heights()), other.nb_grid_pts)
    first = f"{one.step_x:.4f}, {one.step_y:.4f} ({column}, {row}) {one.Sdq():.4f}"
    second = f"{other.pixel_size[0]:.4f}, {other.pixel_size[1]:.4f} ({place[0]}, {place[1]}) {other.rms_gradient():.4f}"
    print(f"{name} | surfalize {first} | SurfaceTopography {second}")
    found += [first, second]
right = "1.0000, 1.0000 (36, 8) 0.0461"
expected = ["0.9792, 0.9688 (36, 8) 0.0467", right, "0.9792, 0.9688 (8, 24) 0.1925", right]
sys.exit(0 if found == expected else "the behaviour has changed")
PY
echo "as described"
