#!/bin/sh
# A SUR file that surfalize writes cannot be converted to NetCDF by SurfaceTopography.
#
# Packages: surfalize 0.19.2, SurfaceTopography 1.27.1 (PyPI), numpy 2.4.6.
# Behaviour: surfalize encodes the unit µm of a SUR header as UTF-8 (bytes C2 B5 6D). SurfaceTopography decodes the header as Latin-1
# and has the unit "Âµm", which is not a unit for it: a conversion by `to_unit("m")` raises ValueError, and `to_netcdf` raises UnicodeEncodeError, because
# NetCDF-3 attributes are ASCII. `to_matrix` writes a text with the unit "Âµm" in UTF-8.
# Output seen (November 2026):
#     unit: 'Âµm'
#     to_netcdf: UnicodeEncodeError
#     to_unit: ValueError
#     to_matrix: ok
# Why it matters: the conversion by `open_topography(FILE).topography().to_netcdf(...)`, which works for other instrument formats, ends
# in an error for these files, and a statement of the unit is refused as well (the unit is fixed by the file). A text export is the way
# that works, if its reader takes "Âµm" for µm.
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

heights = numpy.sin(numpy.arange(32)[:, None] * 0.4) * numpy.cos(numpy.arange(48) * 0.3)
surfalize.Surface(heights, 0.5, 0.5).save("scan.sur")
topography = open_topography("scan.sur").topography()


def outcome(act):
    try:
        act()
    except Exception as error:
        return type(error).__name__
    return "ok"


found = {
    "unit": topography.unit,
    "to_netcdf": outcome(lambda: topography.to_netcdf("scan.nc")),
    "to_unit": outcome(lambda: topography.to_unit("m").to_netcdf("scan.nc")),
    "to_matrix": outcome(lambda: topography.to_matrix("scan.txt")),
}
print(found)
expected = {"unit": "\u00c2\u00b5m", "to_netcdf": "UnicodeEncodeError", "to_unit": "ValueError", "to_matrix": "ok"}
sys.exit(0 if found == expected else "the behaviour has changed")
PY
echo "as described"
