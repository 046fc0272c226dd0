"""Make container.zip: three maps and a line scan of one surface, as SurfaceTopography 1.27 writes them.

Usage: python container.py; needs NumPy and SurfaceTopography. The maps have different sizes and units.
The heights are sums of plane waves with the amplitudes of a power law and phases of a fixed seed.
"""

import numpy as np
from SurfaceTopography import Topography, UniformLineScan
from SurfaceTopography.Container.IO import write_containers
from SurfaceTopography.Container.SurfaceContainer import InMemorySurfaceContainer


def heights(points, size, seed):
    """Heights of a square of this size, in its unit: h_rms = 0.01 size at H = 0.8, and a tilt."""
    rng = np.random.default_rng(seed)
    # Waves that do not fit into the square: the map is not periodic.
    count = 400
    q = 2 * np.pi / size * 10 ** rng.uniform(0, np.log10(points / 2), count)
    angle, phase = rng.uniform(0, 2 * np.pi, (2, count))
    x, y = np.meshgrid(*[np.arange(points) * size / points] * 2, indexing="ij")
    waves = [
        k**-0.8 * np.cos(k * (np.cos(a) * x + np.sin(a) * y) + p) for k, a, p in zip(q, angle, phase)
    ]
    total = np.sum(waves, axis=0)
    return 0.01 * size**0.8 * total / np.sqrt(np.sum(q**-1.6) / 2) + 0.002 * x


MAPS = [(40, 8.0, "um", 1), (40, 2.0, "um", 2), (32, 1000.0, "nm", 3)]


def topography(points, size, unit, seed):
    factor = 1000.0 if unit == "nm" else 1.0
    h = factor * heights(points, size / factor, seed)
    return Topography(h, (size, size), unit=unit, info={"name": f"map {size:g} {unit}"})


if __name__ == "__main__":
    line = UniformLineScan(heights(64, 4.0, 4)[0], 4.0, unit="um", info={"name": "line 4 um"})
    maps = [topography(*of) for of in MAPS]
    write_containers([InMemorySurfaceContainer([*maps, line])], "container.zip")
