#!/bin/sh
# SurfaceTopography exchanges x and y between an array saved as .npy and the same array saved as text.
#
# Packages: SurfaceTopography 1.27.1 (PyPI), h5py 3.16.0, numpy 2.4.6.
# Behaviour: the readers of .npy and HDF5 take the first index of an array for x. The reader of plain text takes a line for a scan line
# along x, so that the first index is y. One array written by numpy.save, h5py and numpy.savetxt therefore gives two surfaces, which are
# mirror images of each other at the line x = y. The documentation of each reader states its order.
# Output seen (November 2026): array of 32 by 48 with its maximum at [20, 12]:
#     a.npy (32, 48) (20, 12)
#     a.h5 (32, 48) (20, 12)
#     a.txt (48, 32) (12, 20)
# Why it matters: positions of asperities and contacts, and any anisotropy, are exchanged according to the format in which one and the
# same array reaches a program. Scalar results do not change, so that nothing else shows it. A program that reads several formats has to
# state an order for each one.
#
# Exit code: 0 if the behaviour is as described, 1 if it has changed.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet SurfaceTopography==1.27.1 h5py==3.16.0 numpy==2.4.6
cd "$folder"
"$folder/venv/bin/python" - <<'PY'
import sys

import h5py
import numpy
from SurfaceTopography.IO import open_topography

i, j = numpy.mgrid[:32, :48]
array = numpy.exp(-(((i - 20) / 4) ** 2) - ((j - 12) / 4) ** 2)
numpy.save("a.npy", array)
numpy.savetxt("a.txt", array)
with h5py.File("a.h5", "w") as file:
    file["heights"] = array
found = []
for name in ("a.npy", "a.h5", "a.txt"):
    heights = open_topography(name).topography(physical_sizes=(1.0, 1.0)).heights()
    top = tuple(int(place) for place in numpy.unravel_index(numpy.argmax(heights), heights.shape))
    found.append((heights.shape, top))
    print(name, heights.shape, top)
expected = [((32, 48), (20, 12)), ((32, 48), (20, 12)), ((48, 32), (12, 20))]
sys.exit(0 if found == expected else "the behaviour has changed")
PY
echo "as described"
