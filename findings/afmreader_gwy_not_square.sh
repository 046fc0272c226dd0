#!/bin/sh
# AFMReader scrambles the rows of a Gwyddion file that is not square, and gives it a wrong pixel size.
#
# Packages: AFMReader 0.0.7, gwyfile 0.3.0 (PyPI), numpy 2.4.6.
# Behaviour: a GWY file holds the heights row by row, with xres points in a row. AFMReader arranges them in xres rows of yres points. For a
# map of 48 x 32 points each row then holds two thirds of a scan line and a part of the next one. The pixel size is the width divided by
# yres instead of xres. No message is given. A square map is read correctly. The heights are multiplied by 1e9 according to the lateral
# unit: a channel in volts or degrees comes 1e9 times too large.
# Output seen (November 2026): bump of 10 nm in 32 rows of 48 points of 10 nm:
#     gwyfile: rows x columns (32, 48), pixel 10.0 nm, maximum 10.0 nm at (8, 36), rms step along a row 0.321 nm
#     AFMReader: rows x columns (48, 32), pixel 15.0 nm, maximum 10.0 nm at (13, 4), rms step along a row 0.316 nm
#     AFMReader, channel of 0.5 V: 500000000.0
# Why it matters: AFM scans are often stopped early or have fewer lines than points. Heights, rms height and distribution are right, and the
# steps along a row nearly so. Positions, distances, slopes along y, spectrum, and the number and shape of asperities are wrong.
#
# Exit code: 0 if the behaviour is as described, 1 if it has changed.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet AFMReader==0.0.7 gwyfile==0.3.0 numpy==2.4.6
cd "$folder"
"$folder/venv/bin/python" - <<'PY'
import sys

import gwyfile
import numpy
from AFMReader.gwy import load_gwy
from gwyfile.objects import GwyContainer, GwyDataField
from loguru import logger

logger.remove()
y, x = numpy.mgrid[:32, :48]
heights = 10e-9 * numpy.exp(-(((x - 36) / 4) ** 2) - ((y - 8) / 4) ** 2)
file = GwyContainer()
file["/0/data/title"] = "Height"
file["/0/data"] = GwyDataField(heights, xreal=480e-9, yreal=320e-9, si_unit_xy="m", si_unit_z="m")
file["/1/data/title"] = "Deflection"
file["/1/data"] = GwyDataField(numpy.full((32, 48), 0.5), xreal=480e-9, yreal=320e-9, si_unit_xy="m", si_unit_z="V")
file.tofile("a.gwy")


def described(name, data, pixel):
    top = tuple(int(place) for place in numpy.unravel_index(numpy.argmax(data), data.shape))
    step = numpy.sqrt((numpy.diff(data, axis=1) ** 2).mean())
    print(f"{name}: rows x columns {data.shape}, pixel {pixel:.1f} nm, maximum {data.max():.1f} nm at {top}, rms step along a row {step:.3f} nm")
    return data.shape, round(float(pixel), 6), top


field = gwyfile.util.get_datafields(gwyfile.load("a.gwy"))["Height"]
found = [described("gwyfile", field.data * 1e9, field.xreal / field.data.shape[1] * 1e9), described("AFMReader", *load_gwy("a.gwy", "Height"))]
volts = float(load_gwy("a.gwy", "Deflection")[0].max())
print("AFMReader, channel of 0.5 V:", volts)
expected = [((32, 48), 10.0, (8, 36)), ((48, 32), 15.0, (13, 4))]
sys.exit(0 if found == expected and volts == 5e8 else "the behaviour has changed")
PY
echo "as described"
