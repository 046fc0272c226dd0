#!/bin/sh
# The contact area that tamaas counts from tractions is 100 % or 22 % for one converged contact, according to the solver's variable.
#
# Packages: tamaas 2.9.0 (PyPI), numpy 2.4.6.
# Behaviour: Statistics2D.contact(tractions) counts the points with a traction above zero. PolonskyKeerRey with the pressure as variable
# leaves exact zeros outside the contact, so that the count is right. With the gap as variable, which the adhesion functionals need, the
# zeros are in the gap, and the tractions outside the contact are positive residuals of about 1e-6 of the maximum: nearly the whole
# surface counts as contact. With adhesion the opposite error comes first: the rim of each contact is under tension, is not counted,
# and the area is too small. No message is given. The count of gap == 0 is right with the gap as variable and wrong with the pressure.
# Output seen (November 2026): double cosine, 64 x 64 points, E* = 1, mean pressure 0.005, tolerance 1e-5 (1e-6 with adhesion)
#                                  counted from tractions   gap == 0
#     pressure, no adhesion                        0.2173     0.0002
#     gap, no adhesion                             0.9998     0.2173
#     gap, exponential adhesion                    0.3540     0.4722
# Why it matters: contact area against load is the quantity that codes are compared by. A script that is extended by an adhesion
# functional keeps its line `Statistics2D.contact(model.traction)` and reports another quantity. Area has to be taken from the variable
# in which the solver has its active set.
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

import numpy
import tamaas

tamaas.set_log_level(tamaas.LogLevel.error)
Solver = tamaas.PolonskyKeerRey
points = 64
x = numpy.arange(points) / points
surface = 0.01 * numpy.cos(2 * numpy.pi * x)[:, None] * numpy.cos(2 * numpy.pi * x)[None, :]


def areas(variable, tolerance, work=0.0):
    model = tamaas.ModelFactory.createModel(tamaas.model_type.basic_2d, [1.0, 1.0], [points, points])
    model.E, model.nu = 1.0, 0.0
    solver = Solver(model, surface, tolerance, primal_type=variable, constraint_type=Solver.pressure)
    if work:
        adhesion = tamaas.ExponentialAdhesionFunctional(surface)
        adhesion.parameters = {"rho": 1e-3, "surface_energy": work}
        solver.addFunctionalTerm(adhesion)
    error = solver.solve(0.005)
    assert error <= tolerance, f"not converged: {error}"
    return tamaas.Statistics2D.contact(model.traction), float((numpy.array(model["gap"]) == 0).mean())


found = {
    "pressure, no adhesion": areas(Solver.pressure, 1e-5),
    "gap, no adhesion": areas(Solver.gap, 1e-5),
    "gap, exponential adhesion": areas(Solver.gap, 1e-6, 2e-5),
}
print(f"{'':30s} counted from tractions   gap == 0")
for name, (traction, gap) in found.items():
    print(f"{name:40s} {traction:10.4f} {gap:10.4f}")
right = found["pressure, no adhesion"][0]
good = (
    abs(right - 0.2173) < 0.002
    and found["pressure, no adhesion"][1] < 0.01
    and found["gap, no adhesion"][0] > 0.95
    and abs(found["gap, no adhesion"][1] - right) < 0.002
    and found["gap, exponential adhesion"][0] < 0.85 * found["gap, exponential adhesion"][1]
)
sys.exit(0 if good else "the behaviour has changed")
PY
echo "as described"
