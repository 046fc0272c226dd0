#!/bin/sh
# A SUR file that is marked as inverted shows pits in SurfaceTopography where surfalize and rosettasciio show asperities, or the reverse.
#
# Packages: surfalize 0.19.2, SurfaceTopography 1.27.1, rosettasciio 0.15.0 (PyPI), numpy 2.4.6.
# Behaviour: the header of a SUR file has a code for inversion: 0 none, 1 heights, 2 and 3 heights with a mirror image. SurfaceTopography
# (and Gwyddion) change the sign of the heights for the codes 1 to 3, and mirror the map for 2 and 3. surfalize and rosettasciio give
# the stored heights; surfalize has the code in its metadata.
# Output seen (November 2026): map of 32 x 48 with a bump at row 8, column 36; skewness and place (row, column) of the extreme point:
#     code 0: surfalize +4.96 (8, 36)   rosettasciio +4.96 (8, 36)   SurfaceTopography +4.96 (8, 36)
#     code 1: surfalize +4.96 (8, 36)   rosettasciio +4.96 (8, 36)   SurfaceTopography -4.96 (8, 36)
#     code 2: surfalize +4.96 (8, 36)   rosettasciio +4.96 (8, 36)   SurfaceTopography -4.96 (8, 11)
#     code 3: surfalize +4.96 (8, 36)   rosettasciio +4.96 (8, 36)   SurfaceTopography -4.96 (23, 36)
# Why it matters: soft or large parts are measured by a replica, which is the negative of the part and has to be inverted. A surface and its
# negative differ in contact: asperities, their radii, load and area. Rms height, slope, curvature and the spectrum are the same for both,
# so that a comparison of two programs by these numbers does not show the difference.
#
# Exit code: 0 if the behaviour is as described, 1 if it has changed.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet surfalize==0.19.2 SurfaceTopography==1.27.1 rosettasciio==0.15.0 numpy==2.4.6
cd "$folder"
"$folder/venv/bin/python" - <<'PY'
import struct
import sys

import numpy
import surfalize
from rsciio.digitalsurf import file_reader
from SurfaceTopography.IO import open_topography

y, x = numpy.mgrid[:32, :48]
surfalize.Surface(numpy.exp(-(((x - 36) / 4) ** 2) - ((y - 8) / 4) ** 2), 0.5, 0.5).save("a.sur", encoding="latin-1")
content = bytearray(open("a.sur", "rb").read())
place = 290  # 2-byte code for inversion in the 512-byte header


def seen(values):
    data = numpy.asarray(values - values.mean())
    top = numpy.unravel_index(numpy.argmax(abs(data)), values.shape)
    return f"{(data**3).mean() / data.std() ** 3:+.2f} ({top[0]}, {top[1]})"


found = []
for code in range(4):
    struct.pack_into("<h", content, place, code)
    with open("b.sur", "wb") as file:
        file.write(content)
    assert surfalize.Surface.load("b.sur").metadata["inverted"] == code
    found.append([
        seen(surfalize.Surface.load("b.sur").data),
        seen(file_reader("b.sur")[0]["data"]),
        seen(open_topography("b.sur").topography().heights().T),
    ])
    print(f"code {code}: surfalize {found[-1][0]}   rosettasciio {found[-1][1]}   SurfaceTopography {found[-1][2]}")
stored = ["+4.96 (8, 36)"] * 2
expected = [stored + [other] for other in ("+4.96 (8, 36)", "-4.96 (8, 36)", "-4.96 (8, 11)", "-4.96 (23, 36)")]
sys.exit(0 if found == expected else "the behaviour has changed")
PY
echo "as described"
