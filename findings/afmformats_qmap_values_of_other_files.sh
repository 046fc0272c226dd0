#!/bin/sh
# A force map of afmformats shows values of other files in some pixels, when many maps are processed one after the other.
#
# Packages: afmformats 0.18.7 (PyPI), h5py 3.16.0, numpy 2.4.6.
# Behaviour: `AFMQMap.get_qmap` keeps the results of "data: height base point", "data: piezo range" and "data: scan order" in a dictionary
# of the class. The key is the address of the curve in memory. Another cache holds the last 32 maps, so that nothing happens at first. From
# the 33rd map on, curves are freed, new curves get their addresses, and the pixel is filled with the value of the old curve. No message is
# given. The pixels that are hit differ from run to run and from machine to machine.
# Output seen (November 2026): 150 files of 4 x 4 curves, the height in all curves of file k is k µm:
#     the first 32 maps: 0 wrong
#     the other 118 maps: 73 wrong, for example file 42 with [9.0, 42.0]
# Why it matters: the base point of each force curve is the topography of the sample at the point, which is subtracted or compared with
# stiffness and adhesion. A batch over a folder of maps mixes the heights of different samples, in single pixels that look like outliers.
# Each file, opened in a process of its own, is right.
#
# Exit code: 0 if the behaviour is as described, 1 if it has changed.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet afmformats==0.18.7 h5py==3.16.0 numpy==2.4.6
cd "$folder"
"$folder/venv/bin/python" - <<'PY'
import sys

import h5py
import numpy
from afmformats import AFMForceDistance, AFMQMap

count, side, points = 150, 4, 20
segment = numpy.repeat(numpy.array([0, 1], numpy.uint8), points // 2)
for k in range(1, count + 1):
    with h5py.File(f"{k}.h5", "w") as file:
        for number in range(side * side):
            j, i = divmod(number, side)
            metadata = {"path": "x", "enum": number, "imaging mode": "force-distance", "z range": 1e-6}
            for axis, index in (("x", i), ("y", j)):
                metadata |= {f"grid shape {axis}": side, f"grid size {axis}": side * 1e-6, f"grid center {axis}": side * 5e-7}
                metadata |= {f"grid index {axis}": index, f"position {axis}": (index + 0.5) * 1e-6}
            height = numpy.linspace(1e-6, 0, points) + k * 1e-6
            curve = AFMForceDistance({"force": numpy.zeros(points), "height (measured)": height, "segment": segment}, metadata)
            curve.export_data(file, fmt="hdf5")


def values(k):
    return AFMQMap(f"{k}.h5").get_qmap("data: height base point", qmap_only=True)


wrong = {}
for k in range(1, count + 1):
    heights = values(k)
    if abs(heights - k).max() > 1e-6:
        wrong[k] = sorted(set(heights.ravel().round(3).tolist()))
early = sum(k <= 32 for k in wrong)
late = {k: wrong[k] for k in wrong if k > 32}
example = min(late, default=None)
print(f"the first 32 maps: {early} wrong")
print(f"the other {count - 32} maps: {len(late)} wrong" + (f", for example file {example} with {late[example]}" if late else ""))
sys.exit(0 if not early and late else "the behaviour has changed")
PY
echo "as described"
