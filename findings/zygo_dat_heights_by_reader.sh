#!/bin/sh
# One Zygo MetroPro file has heights that differ by a factor of 8 or 4, and in sign, between three readers.
#
# Packages: surfalize 0.19.2, SurfaceTopography 1.27.1, prysm 0.21.1 (PyPI), numpy 2.4.6.
# Behaviour: the heights of a .dat file are integers; the header has a code for the number of them in one fringe. SurfaceTopography and prysm
# (and Gwyddion) take the codes 0, 1, 2 for 4096, 32768, 131072. surfalize takes the codes 1, 2, 3 for these numbers: a file of code 1 is
# 8 times too high, of code 2 it is 4 times too high, of code 0 it ends in KeyError. The header also has a sign. SurfaceTopography (and
# Gwyddion) invert the heights if it is not 0; surfalize and prysm do not look at it.
# Output seen (November 2026): a bump of 100 nm, extreme height in nm:
#     code 0, sign 0: surfalize KeyError, SurfaceTopography 100, prysm 100
#     code 1, sign 0: surfalize 800, SurfaceTopography 100, prysm 100
#     code 2, sign 0: surfalize 400, SurfaceTopography 100, prysm 100
#     code 1, sign 1: surfalize 800, SurfaceTopography -100, prysm 100
# Why it matters: smooth lenses and punches of adhesion tests are measured by these interferometers. All heights scale together, so that the
# map looks right; rms height and slope are wrong by 8, the elastic energy by 64. The sign exchanges asperities and pits: rms values stay,
# contact and skewness do not.
#
# Exit code: 0 if the behaviour is as described, 1 if it has changed.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet surfalize==0.19.2 SurfaceTopography==1.27.1 prysm==0.21.1 numpy==2.4.6
cd "$folder"
"$folder/venv/bin/python" - <<'PY'
import struct
import sys

import numpy
import surfalize
from prysm.io import read_zygo_dat
from SurfaceTopography.IO import open_topography

nx, ny, wavelength = 48, 32, 632.8e-9
y, x = numpy.mgrid[:ny, :nx]
heights = 100e-9 * numpy.exp(-(((x - 36) / 4) ** 2) - ((y - 8) / 4) ** 2)
per_fringe = {0: 4096, 1: 32768, 2: 131072}


def write(code, sign):
    header = bytearray(834)
    for place, form, values in (
        (0, ">IHI", (0x881B036F, 1, 834)),  # magic number, format 1, size of the header
        (64, ">hhHHI", (0, 0, nx, ny, 4 * nx * ny)),  # area of the heights
        (76, ">i", (1700000000,)),  # time
        (164, ">ffffff", (0.5, wavelength, 0.1, 1.0, 10.0, 1e-6)),  # scale, wavelength, aperture, obliquity, magnification, pixel in m
        (218, ">h", (code,)),
        (232, ">h", (sign,)),
    ):
        struct.pack_into(form, header, place, *values)
    raw = numpy.round(heights / (0.5 * wavelength) * per_fringe[code]).astype(">i4")
    with open("a.dat", "wb") as file:
        file.write(bytes(header) + raw.tobytes())


readers = {
    "surfalize": lambda: surfalize.Surface.load("a.dat").data * 1e3,
    "SurfaceTopography": lambda: open_topography("a.dat").topography().heights() * 1e9,
    "prysm": lambda: read_zygo_dat("a.dat")["phase"],
}
found = []
for code, sign in ((0, 0), (1, 0), (2, 0), (1, 1)):
    write(code, sign)
    line = []
    for name, read in readers.items():
        try:
            data = numpy.asarray(read()).ravel()
            line.append(round(float(data[numpy.argmax(abs(data))])))
        except KeyError as error:
            line.append(type(error).__name__)
    found.append(line)
    print(f"code {code}, sign {sign}: " + ", ".join(f"{name} {value}" for name, value in zip(readers, line)))
expected = [["KeyError", 100, 100], [800, 100, 100], [400, 100, 100], [800, -100, 100]]
sys.exit(0 if found == expected else "the behaviour has changed")
PY
echo "as described"
