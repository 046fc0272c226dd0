#!/bin/bash
# ContactMechanics 1.8.3 (PyPI), PeriodicFFTElasticHalfSpace(thickness=h, poisson=nu): no layer of an incompressible material.
#
# A layer bonded to a rigid base has, at Poisson's ratio 1/2, a regular response: S(s) = (sinh 2s - 2s)/(cosh 2s + 2s^2 + 1) of that of
# a half-space at s = qh, and no displacement under a uniform pressure. The constructor computes the stiffness of that uniform
# pressure, E(1 - nu)/(h (1 - 2nu)(1 + nu)), as a number and divides by zero. At nu = 0.4999999 it works, and its stiffness at q > 0
# has converged to S.
#
# Output seen (28 November 2026):
#   nu = 0.3: S(q=1/4, h=4) = 0.415752, by the formula 0.415752
#   nu = 0.4999999: 0.240582, by the formula at 1/2 0.240582
#   nu = 0.5: ZeroDivisionError: float division by zero
#
# Why it matters here: silicones and rubbers, the usual layers of adhesion tests, are nearly incompressible, and 1/2 is the default of
# `substrate.poisson_ratio`. Our layer has the limit in closed form; the comparison of both stops short of it.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q ContactMechanics==1.8.3
"$folder/venv/bin/python" - <<'PY'
import warnings
from math import cosh, pi, sinh

import numpy as np
from ContactMechanics import PeriodicFFTElasticHalfSpace

warnings.simplefilter("ignore")


def share(s, nu):
    return ((3 - 4 * nu) * sinh(2 * s) - 2 * s) / ((3 - 4 * nu) * cosh(2 * s) + 2 * s * s + 5 - 12 * nu + 8 * nu * nu)


def found(nu, h=4.0):
    layer = PeriodicFFTElasticHalfSpace((16, 16), young=1.0, physical_sizes=(8 * pi, 8 * pi), thickness=h, poisson=nu)
    stiffness = np.asarray(layer.surface_stiffness)[1, 0].real
    return 0.25 / 2 / (1 - nu * nu) / stiffness


for nu, limit in [(0.3, 0.3), (0.4999999, 0.5)]:
    print(f"nu = {nu}: S(q=1/4, h=4) = {found(nu):.6f}, by the formula at {limit}: {share(1.0, limit):.6f}")
    assert abs(found(nu) - share(1.0, limit)) < 1e-5
try:
    found(0.5)
    raise SystemExit("an incompressible layer works now")
except ZeroDivisionError as error:
    print(f"nu = 0.5: {type(error).__name__}: {error}")
PY
