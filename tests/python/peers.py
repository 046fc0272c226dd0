"""Loading by hysteron beside the programs Adhesion and tamaas, on one self-affine surface with attraction of one range; one thread each.

    pip install Adhesion tamaas h5py numpy pyarrow && python tests/python/peers.py hysteron 512 0.0005

Arguments: the program, grid points along a side, and the load F_max/(E* A0) up to which it loads.

hysteron loads by boundary elements with Morse's law at every point, in steps of one length. Adhesion goes through the same approaches with the same
law; the script ends with an error if loads or areas of more than a twentieth of the steps differ by more than 1 %. The law of tamaas is an exponential
on a hard wall with the same range and work of adhesion, so only its time is printed. hysteron and Adhesion begin each step with their last state, and
end it where the rms residual is about 1e-4 of the maximum tension (tamaas: 1e-6 in its own measure, or 1000 iterations). Times are seconds of wall clock.
"""
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")

import h5py
import numpy as np
import pyarrow.parquet as pq
from Adhesion.Interactions import RepulsiveExponential
from Adhesion.System import SmoothContactSystem
from ContactMechanics import PeriodicFFTElasticHalfSpace
from SurfaceTopography import Topography

try:
    import tamaas
except ImportError:
    tamaas = None

LENGTH, MODULUS, WORK, PRECISION = 1e-3, 1e6, 0.07, 1e-4
# Seconds after which no further step is begun.
LONGEST = 600
# Approaches that count as the same, in grid spacings.
SAME = 1e-3
SPEC = f"""
name = "peers"
seed = 2021
realizations = 1
surface.magnification = %d
surface.points_per_shortest_wavelength = 16
surface.normalization = "spectrum"
model.method = "boundary_elements"
boundary_elements.points = %d
boundary_elements.attraction = "range"
boundary_elements.approach_step = 0.03
boundary_elements.halvings = 0
boundary_elements.precision = {PRECISION}
cycle.max_load = [%s]
"""


def hysteron(program, points, max_load, folder):
    """Heights below the highest point, and the steps of loading: approach, load, points in contact, seconds. Units are grid spacing and E*."""
    spec, spacing = folder / "peers.toml", LENGTH / points
    spec.write_text(SPEC % (points // 16, points, max_load))
    run = folder / "run"
    subprocess.run([program, "run", spec, "--out", run, "--jobs", "1", "-q"], check=True, stdout=sys.stderr)
    with h5py.File(next((run / "surfaces").glob("*.h5"))) as file:
        heights = file["height_m"][:] / spacing
    steps = pq.read_table(next((run / "cycles").glob("*/steps.parquet"))).to_pylist()
    seconds = json.loads(next((run / "receipts" / "cycle").glob("*.json")).read_text())["made"]["seconds"]
    share = seconds / sum(step["transform_count"] for step in steps)
    states = [(step["approach_m"] / spacing, step["load_n"] / (MODULUS * spacing**2), round(step["area_m2"] / spacing**2), share * step["transform_count"])
              for step in steps if step["branch"] == "loading"]
    return heights - heights.max(), states


def adhesion(heights, states, work, reach):
    """The same by Adhesion, for as many states as the time allows."""
    points, strength = len(heights), 0.5 * work / reach
    morse = RepulsiveExponential(work, reach / 2, 2 * work, reach)
    half_space = PeriodicFFTElasticHalfSpace((points, points), 1.0, (points, points))
    system = SmoothContactSystem(half_space, morse, Topography(heights, (points, points)))
    # The largest residual that gives the same rms residual.
    options = dict(gtol=30 * PRECISION * strength, ftol=0, maxiter=20000, maxcor=3)
    disp, found, began = np.zeros((points, points)), [], time.perf_counter()
    for approach, expected, *_ in states:
        start = time.perf_counter()
        if start - began > LONGEST:
            break
        # Its half-space has the stiffness of the longest wave for the mean displacement too, which is zero in hysteron.
        mean = expected / (np.pi * points)
        for _ in range(4):
            offset = approach + mean
            disp = system.minimize_proxy(offset=offset, initial_displacements=disp, tol=1e-9, options=options).x.reshape(points, points)
            mean = disp.mean()
            if abs(offset - mean - approach) < SAME:
                break
        gap = system.compute_gap(disp, offset)
        load = -np.sum(morse.evaluate(gap, True, True)[1])
        found.append((offset - mean, load, int(np.sum(gap < reach * np.log(2))), time.perf_counter() - start))
    return found


def exponential(heights, states, work, reach):
    """Seconds per step of tamaas."""
    tamaas.set_log_level(tamaas.LogLevel.error)
    points = len(heights)
    model = tamaas.Model(tamaas.model_type.basic_2d, [points, points], [points, points])
    model.E, model.nu = 1.0, 0.0
    surface = heights.copy()
    solver = tamaas.PolonskyKeerRey(model, surface, 1e-6, tamaas.PolonskyKeerRey.gap, tamaas.PolonskyKeerRey.gap)
    attraction = tamaas.ExponentialAdhesionFunctional(surface)
    attraction.parameters = {"rho": reach, "surface_energy": work}
    solver.addFunctionalTerm(attraction)
    began = time.perf_counter()
    for approach, *_ in states:
        solver.solve(-approach - heights.mean())
    return (time.perf_counter() - began) / len(states)


def main():
    program, points, max_load = sys.argv[1], int(sys.argv[2]), sys.argv[3]
    work = WORK / (MODULUS * LENGTH / points)
    reach = 0.8 * np.sqrt(work)
    with tempfile.TemporaryDirectory() as folder:
        heights, states = hysteron(program, points, max_load, Path(folder))
    found = adhesion(heights, states, work, reach)
    largest = [max(abs(state[k]) for state in states[:len(found)]) for k in (1, 2)]
    print(" approach         load  by Adhesion  points  by Adhesion  seconds  by Adhesion")
    off = []
    for (approach, load, contact, mine), (at, theirs, area, seconds) in zip(states, found):
        same = abs(at - approach) < SAME
        if same:
            off.append(max(abs(theirs - load) / largest[0], abs(area - contact) / largest[1]))
        print(f"{approach:9.4f} {load:12.4f} {theirs:12.4f} {contact:7} {area:12} {mine:8.2f} {seconds:12.2f}{'' if same else '  elsewhere'}")
    mine, theirs = (sum(state[3] for state in steps[:len(found)]) / len(found) for steps in (states, found))
    print(f"{points} x {points} points, {len(found)} of {len(states)} steps: hysteron {mine:.3f} s a step, Adhesion {theirs:.3f} s")
    equal = sum(difference < 0.01 for difference in off)
    print(f"{equal} steps are equal within 1 % of the largest load and area, {np.median(off):.0e} in the median; the others are at an instability")
    if tamaas:
        print(f"tamaas {exponential(heights, states[len(states) // 2::len(states) // 8], work, reach):.3f} s a step", flush=True)
    if equal < 0.95 * len(found):
        sys.exit("error: they differ")


main()
