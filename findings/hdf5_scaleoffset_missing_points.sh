#!/bin/sh
# The scale-offset filter of HDF5 turns a missing point of a height map into the lowest height of its chunk, or makes it unreadable.
#
# Packages: h5py 3.16.0 (with HDF5 2.0.0), numpy 2.4.6 (PyPI).
# Behaviour: with `scaleoffset=D` HDF5 stores each value as an integer count of 10^-D above the minimum of its chunk. NaN has no such
# count and is stored as zero: it is read as the minimum. If NaN is the first point of a chunk, it is also taken for the minimum. Then a
# float64 chunk is stored as it is and keeps the NaN, and a float32 chunk is written without an error and cannot be read. What happens to
# one missing point thus depends on its place in the chunk. Every reader of the file gets the same values.
# Output seen (November 2026): 8 x 8 heights with one NaN, one chunk, D = 3
#     float64, NaN inside  : 0 NaN read, the point is -2.711, minimum of the others -2.711
#     float64, NaN first   : 1 NaN read
#     float32, NaN inside  : 0 NaN read, the point is -2.711, minimum of the others -2.711
#     float32, NaN first   : OSError when read
# Why it matters: the filter is the usual lossy compression of scans, and NaN marks dropouts. Each dropout becomes a pit as deep as the
# deepest valley nearby, with no NaN left for a mask or a fill. Slopes, spectra and the contact at full load follow.
#
# Exit code: 0 if the behaviour is as described, 1 if it has changed.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet h5py==3.16.0 numpy==2.4.6
cd "$folder"
"$folder/venv/bin/python" - <<'PY'
import sys

import h5py
import numpy

base = numpy.random.default_rng(1).normal(size=(8, 8))


def outcome(kind, place):
    heights = base.astype(kind)
    heights[place] = numpy.nan
    with h5py.File("x.h5", "w") as file:
        file.create_dataset("h", data=heights, chunks=(8, 8), scaleoffset=3)
    try:
        with h5py.File("x.h5") as file:
            read = file["h"][:]
    except OSError:
        return "unreadable", None, None
    return int(numpy.isnan(read).sum()), float(read[place]), float(numpy.nanmin(heights))


good = True
for kind in ("float64", "float32"):
    for name, place in (("NaN inside", (4, 3)), ("NaN first", (0, 0))):
        count, value, least = outcome(kind, place)
        text = f"{kind}, {name:12s}: "
        if count == "unreadable":
            print(text + "OSError when read")
        elif count == 0:
            print(text + f"0 NaN read, the point is {value:.3f}, minimum of the others {least:.3f}")
        else:
            print(text + f"{count} NaN read")
        if name == "NaN inside":
            good &= count == 0 and abs(value - least) < 1e-3
        else:
            good &= count == (1 if kind == "float64" else "unreadable")
sys.exit(0 if good else "the behaviour has changed")
PY
echo "as described"
