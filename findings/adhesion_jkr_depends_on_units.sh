#!/bin/sh
# The JKR reference solution of Adhesion gives another force for the same contact when the unit system is changed.
#
# Packages: Adhesion 0.93 (PyPI), numpy 2.4.6, scipy 1.17.1.
# Behaviour: JKR.force(penetration=...) and JKR.contact_radius(penetration=...) search the contact radius numerically. Both the starting
# value and the limit below which "no contact" is returned contain the modulus in the numerator instead of the denominator, and the search
# stops at an absolute step of 1.5e-8 in the user's length unit. Only K = 4/3 E* = 1 is free of the first error. In SI units, the
# search for a stiff tip stops too early: at a radius of 19.5 instead of 1.0 nm in the first case below, with a force of the wrong sign
# and 7000 times too large. In nm and nN, a soft sphere under tension has no contact at all. Nothing is raised. In other cases the search
# ends in RuntimeError. JKR.force(contact_radius=...) is correct.
# Output seen (November 2026): displacement is half of that at pull-off (negative: the sphere is pulled).
#     tip R = 20 nm, E* = 70 GPa, w = 50 mJ/m2      theory -4.711e-09 N
#         m, N                                        +3.400e-05 N
#         um, uN                                      -4.711e-09 N
#         nm, nN                                      -4.711e-09 N
#     tip R = 50 nm, E* = 1 GPa, w = 50 mJ/m2       theory -1.178e-08 N
#         m, N                                        +2.772e-07 N
#         um, uN                                      -1.178e-08 N
#         nm, nN                                      -1.178e-08 N
#     sphere R = 1 um, E* = 1 MPa, w = 50 mJ/m2     theory -2.356e-07 N
#         m, N                                        -2.356e-07 N
#         um, uN                                      -2.356e-07 N
#         nm, nN                                      +0.000e+00 N
# Why it matters: these functions are the known answer against which adhesive contact codes and force curves are checked. The usual units
# of contact mechanics (SI) and of force microscopy (nm, nN) are the ones that fail. In each case another unit system gives the right force.
#
# Exit code: 0 if the behaviour is as described, 1 if it has changed.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet Adhesion==0.93 numpy==2.4.6 scipy==1.17.1
cd "$folder"
"$folder/venv/bin/python" - <<'PY'
import sys
from math import pi, sqrt

from Adhesion.ReferenceSolutions import JKR
from scipy.optimize import brentq

UNITS = [("m, N", 1.0, 1.0), ("um, uN", 1e6, 1e6), ("nm, nN", 1e9, 1e9)]
CASES = [
    ("tip R = 20 nm, E* = 70 GPa, w = 50 mJ/m2", 20e-9, 70e9, "wrong sign", "m, N"),
    ("tip R = 50 nm, E* = 1 GPa, w = 50 mJ/m2", 50e-9, 1e9, "wrong sign", "m, N"),
    ("sphere R = 1 um, E* = 1 MPa, w = 50 mJ/m2", 1e-6, 1e6, "no contact", "nm, nN"),
]
w, good = 0.05, True
for name, radius, modulus, fault, where in CASES:
    least = (pi * w * radius**2 / (8 * modulus)) ** (1 / 3)  # contact radius at the most negative displacement

    def displacement(a):
        return a * a / radius - sqrt(2 * pi * a * w / modulus)

    d = displacement(least) / 2
    a = brentq(lambda a: (displacement(a) - d) / abs(d), least, 100 * least, xtol=1e-18)
    theory = 4 * modulus * a**3 / (3 * radius) - sqrt(8 * pi * w * modulus * a**3)
    print(f"{name:45s} theory {theory:+.3e} N")
    for unit, length, force in UNITS:
        found = JKR.force(penetration=d * length, radius=radius * length, contact_modulus=modulus * force / length**2,
                          work_of_adhesion=w * force / length) / force
        print(f"    {unit:43s} {found:+.3e} N")
        if unit != where:
            good &= abs(found / theory - 1) < 0.01
        else:
            good &= found > 10 * abs(theory) if fault == "wrong sign" else found == 0
sys.exit(0 if good else "the behaviour has changed")
PY
echo "as described"
