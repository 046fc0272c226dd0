"""Loads and areas of a wavy surface with Morse attraction, by the program Adhesion, for tests/physics/boundary_elements/peer.rs.

    pip install Adhesion && python tests/reference/adhesion.py > tests/reference/adhesion.csv

Lengths are in grid spacings, stresses in E*. The half-space of that program has a stiffness for the mean displacement too; the approach of a row
is computed from the mean gap that it found.
"""
import importlib.metadata as metadata

import numpy as np
from Adhesion.Interactions import RepulsiveExponential
from Adhesion.System import SmoothContactSystem
from ContactMechanics import PeriodicFFTElasticHalfSpace
from SurfaceTopography import Topography

N = 32
WORK, RANGE = 0.02, 0.12
WAVES = [(1, 0, 0.4, 1.6), (0, 1, 1.9, 1.4), (2, 1, 3.0, 0.7), (1, -3, 5.1, 0.45), (3, 2, 0.2, 0.4)]

rows, columns = np.meshgrid(np.arange(N), np.arange(N), indexing="ij")
heights = sum(a * np.cos(2 * np.pi / N * (kx * rows + ky * columns) + phase) for kx, ky, phase, a in WAVES)
heights -= heights.max()
# Morse: V = w (exp(-2 g/ρ) - 2 exp(-g/ρ)).
morse = RepulsiveExponential(WORK, RANGE / 2, 2 * WORK, RANGE)
half_space = PeriodicFFTElasticHalfSpace((N, N), 1.0, (N, N))
system = SmoothContactSystem(half_space, morse, Topography(heights, (N, N)))

names = ("Adhesion", "ContactMechanics", "SurfaceTopography")
print("# " + ", ".join(f"{name} {metadata.version(name)}" for name in names) + f"; {N} x {N} points, E* = 1, Morse: work {WORK}, range {RANGE}")
print("approach,load,contact_points")
disp = np.zeros((N, N))
for offset in np.linspace(0.0, 4.0, 21):
    result = system.minimize_proxy(offset=offset, initial_displacements=disp, tol=1e-9, options=dict(gtol=1e-9, ftol=0, maxiter=20000, maxcor=10))
    disp = result.x.reshape(N, N)
    gap = system.compute_gap(disp, offset)
    # Our mean displacement is 0: the gap is D + u - z with D its mean plus that of the heights.
    approach = -(gap.mean() + heights.mean())
    load = -np.sum(morse.evaluate(gap, True, True)[1])
    print(f"{approach:.12e},{load:.12e},{int(np.sum(gap < RANGE * np.log(2)))}")
