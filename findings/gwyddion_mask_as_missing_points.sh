#!/bin/sh
# A mask that marks asperities in a Gwyddion file removes them from the surface that SurfaceTopography and surfalize read.
#
# Packages: SurfaceTopography 1.27.1, surfalize 0.19.2, gwyfile 0.3.0 (PyPI), numpy 2.4.6.
# Behaviour: a mask of Gwyddion selects points; it is used for grains, for outliers, or for a region of interest, and all heights stay valid.
# Both readers take the selected points for missing, without a message. They differ for values between 0 and 1: SurfaceTopography takes more
# than 0.5 for missing, surfalize any value that is not 0. gwyfile returns the heights as they are in the file.
# Output seen (November 2026): rough surface with rms height 10 nm; mask on all points above one rms height:
#     no mask   | gwyfile rms 10.00, max 26.29 | SurfaceTopography rms 10.00, max 26.29, 0 missing | surfalize rms 10.00, max 26.29, 0 missing
#     mask, 1   | gwyfile rms 10.00, max 26.29 | SurfaceTopography rms 7.63, max 9.98, 691 missing | surfalize rms 7.63, max 9.98, 691 missing
#     mask, 0.4 | gwyfile rms 10.00, max 26.29 | SurfaceTopography rms 10.00, max 26.29, 0 missing | surfalize rms 7.63, max 9.98, 691 missing
# Why it matters: grains by a threshold are the asperities, and the mask stays in the file when a project is saved. The highest points, which
# carry the contact, are removed or filled in from their surroundings. A mask drawn around the region of interest removes that region.
#
# Exit code: 0 if the behaviour is as described, 1 if it has changed.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet SurfaceTopography==1.27.1 surfalize==0.19.2 gwyfile==0.3.0 numpy==2.4.6
cd "$folder"
"$folder/venv/bin/python" - <<'PY'
import sys

import gwyfile
import numpy
import surfalize
from gwyfile.objects import GwyContainer, GwyDataField
from SurfaceTopography.IO import open_topography

count = 64
q = numpy.hypot(*numpy.meshgrid(numpy.fft.fftfreq(count), numpy.fft.fftfreq(count)))
noise = numpy.fft.fft2(numpy.random.default_rng(0).normal(size=(count, count)))
heights = numpy.fft.ifft2(noise * numpy.exp(-((12 * q) ** 2))).real
heights = (heights - heights.mean()) / heights.std() * 10e-9
marked = (heights > 10e-9).astype(float)
found = []
for name, value in (("no mask  ", 0), ("mask, 1  ", 1), ("mask, 0.4", 0.4)):
    file = GwyContainer()
    file["/0/data/title"] = "Height"
    file["/0/data"] = GwyDataField(heights, xreal=1e-6, yreal=1e-6, si_unit_xy="m", si_unit_z="m")
    if value:
        file["/0/mask"] = GwyDataField(marked * value, xreal=1e-6, yreal=1e-6, si_unit_xy="m", si_unit_z="")
    file.tofile("a.gwy")
    line = []
    plain = gwyfile.util.get_datafields(gwyfile.load("a.gwy"))["Height"].data * 1e9
    first = numpy.ma.filled(numpy.ma.asarray(open_topography("a.gwy").topography().heights(), float), numpy.nan) * 1e9
    second = surfalize.Surface.load("a.gwy").data * 1e3
    for reader, data in (("gwyfile", plain), ("SurfaceTopography", first), ("surfalize", second)):
        missing = int(numpy.isnan(data).sum())
        line.append((round(float(numpy.nanstd(data)), 2), missing))
        text = f"{reader} rms {numpy.nanstd(data):.2f}, max {numpy.nanmax(data):.2f}"
        print(f"{name if reader == 'gwyfile' else ''} | {text}" + (f", {missing} missing" if reader != "gwyfile" else ""), end="")
    print()
    found.append(line)
whole, cut = (10.0, 0), (7.63, int(marked.sum()))
sys.exit(0 if found == [[whole] * 3, [whole, cut, cut], [whole, whole, cut]] else "the behaviour has changed")
PY
echo "as described"
