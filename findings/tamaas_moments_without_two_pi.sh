#!/bin/sh
# Spectral moments of tamaas use the wave number 1/wavelength, its rms slopes and energies the wave vector 2 pi/wavelength.
#
# Packages: tamaas 2.9.0 (PyPI), numpy 2.4.6.
# Behaviour: Statistics2D.computeMoments and the `moments` of the spectrum Isopowerlaw2D return m0, m2, m4 with q in periods per side.
# computeSpectralRMSSlope, computeSpectralEnergy, rmsSlopes and elasticEnergy of the same classes use radians per side. m2 is therefore
# 4 pi^2 = 39.5 times, and m4 16 pi^4 = 1558.5 times smaller than the identity <slope^2> = 2 m2 and the theory of Nayak require. The
# docstrings name no unit. The bandwidth parameter m0 m4/m2^2 does not change and hides the difference.
# Output seen (November 2026): h = cos(2 pi 3 x) + cos(2 pi 3 y) on the unit square, 64 x 64 points
#     m2 of computeMoments            4.5    by definition    177.7    ratio   39.478
#     m4 of computeMoments             27    by definition 4.208e+04    ratio 1558.545
#     2 m2 / computeSpectralRMSSlope^2: 0.025330 (1 by definition)
#     Isopowerlaw2D: 2 m2 / rmsSlopes^2: 0.025330 (1 by definition)
#     summit radius 3/8 sqrt(pi/m4): 0.12792, by definition 0.00324
# Why it matters: the asperity models of Greenwood-Williamson, Bush-Gibson-Thomas and Nayak take summit density, summit radius and
# curvature from m2 and m4. With these moments the radius is 39.5 times too large, and the pull-off force of every asperity with it.
#
# Exit code: 0 if the behaviour is as described, 1 if it has changed.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet tamaas==2.9.0 numpy==2.4.6
cd "$folder"
"$folder/venv/bin/python" - <<'PY'
import sys
from math import pi, sqrt

import numpy
import tamaas

x = numpy.arange(64) / 64
surface = numpy.cos(2 * pi * 3 * x)[:, None] + numpy.cos(2 * pi * 3 * x)[None, :]
_, m2, m4 = tamaas.Statistics2D.computeMoments(surface)
q = 2 * pi * 3
right2, right4 = q**2 / 2, q**4 / 3  # m2: mean square slope of a profile; m4: (m40 + 3 m22 + m04)/3
slope = tamaas.Statistics2D.computeSpectralRMSSlope(surface)
print(f"m2 of computeMoments {m2:14.4g}    by definition {right2:8.4g}    ratio {right2 / m2:8.3f}")
print(f"m4 of computeMoments {m4:14.4g}    by definition {right4:8.4g}    ratio {right4 / m4:8.3f}")
print(f"2 m2 / computeSpectralRMSSlope^2: {2 * m2 / slope**2:.6f} (1 by definition)")
spectrum = tamaas.Isopowerlaw2D()
spectrum.q0, spectrum.q1, spectrum.q2, spectrum.hurst = 4, 4, 64, 0.8
share = 2 * spectrum.moments()[1] / spectrum.rmsSlopes() ** 2
print(f"Isopowerlaw2D: 2 m2 / rmsSlopes^2: {share:.6f} (1 by definition)")
print(f"summit radius 3/8 sqrt(pi/m4): {3 / 8 * sqrt(pi / m4):.5f}, by definition {3 / 8 * sqrt(pi / right4):.5f}")
factor = 4 * pi**2
good = (
    abs(slope**2 / (2 * right2) - 1) < 1e-9
    and abs(right2 / m2 / factor - 1) < 1e-9
    and abs(right4 / m4 / factor**2 - 1) < 1e-9
    and abs(share * factor - 1) < 1e-9
)
sys.exit(0 if good else "the behaviour has changed")
PY
echo "as described"
