"""Power spectral density of a self-affine surface (Eq 10), its moments, and summit statistics.

Keyword arguments define the spectrum: `length_m` L, side of the periodic square [m]; `rms_height_m` h_rms [m]; `hurst` H, Hurst exponent, 0 < H <= 1;
`magnification` ζ = q1/qL, an integer of at least 2. All arguments may be arrays and are broadcast as in NumPy. Scalar arguments return a `float`, arrays
an array of float64.

Invalid spectra raise `ValueError`. NaN in any argument gives NaN in its place.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from . import _hysteron
from ._arrays import Reals, Result, many, one, real


class Moments(NamedTuple):
    """Spectral moments of an isotropic surface: mean squares of height, slope and curvature of a profile; numbers or arrays."""

    #: m0 [m2].
    m0_m2: Reals
    #: m2 (dimensionless).
    m2: Reals
    #: m4 [1/m2].
    m4_1_m2: Reals

    def rms_height_m(self) -> Result:
        """Root-mean-square height `h_rms = sqrt(m0)` [m]."""
        return many(_hysteron.statistics, *self)[0]

    def rms_slope(self) -> Result:
        """Root-mean-square slope `h'_rms = sqrt(2 m2)` (dimensionless), rms of the gradient."""
        return many(_hysteron.statistics, *self)[1]

    def rms_curvature_1_m(self) -> Result:
        """Root-mean-square Laplacian `h''_rms = sqrt(8 m4/3)` [1/m], twice the rms mean curvature."""
        return many(_hysteron.statistics, *self)[2]

    def nayak_parameter(self) -> Result:
        """Bandwidth (Nayak) parameter `α = m0 m4/m2²` (dimensionless)."""
        return many(_hysteron.statistics, *self)[3]

    def summit_density_1_m2(self) -> Result:
        """Summit density of a Gaussian surface (Nayak), `η = m4/(6π√3 m2)` [1/m2]. Below Eq A4."""
        return many(_hysteron.statistics, *self)[4]


def lowest_wavenumber(*, length_m: Reals) -> Result:
    """Lowest wavenumber `qL = 2π/L` [1/m]."""
    wavenumber = 2.0 * math.pi / real(length_m)
    return float(wavenumber) if wavenumber.ndim == 0 else wavenumber


def prefactor(*, length_m: Reals, rms_height_m: Reals, hurst: Reals, magnification: Reals) -> Result:
    """Prefactor `C0 = h_rms² H / (π qL² (1 - ζ^(-2H)))` [m4]; the integral of the spectrum over d²q is h_rms²."""
    return one(_hysteron.prefactor, length_m, rms_height_m, hurst, magnification)


def density(mode_squared: Reals, *, length_m: Reals, rms_height_m: Reals, hurst: Reals, magnification: Reals) -> Result:
    """Power spectral density `C(q) = C0 (q/qL)^(-2(H+1))` for `qL <= q < ζ qL`, else 0 [m4]. Eq 10.

    `mode_squared` is the squared mode number `k² = (q/qL)²`, an integer for a periodic square. The band includes q = qL and excludes q = q1.

    Normalization: `∫C d²q = h_rms²`. SurfaceTopography and contact.engineering use `∫C d²q/(4π²) = h_rms²`: their C is `4π² = 39.48` times as large.
    """
    return one(_hysteron.density, mode_squared, length_m, rms_height_m, hurst, magnification)


def moments(*, length_m: Reals, rms_height_m: Reals, hurst: Reals, magnification: Reals) -> Moments:
    """Moments of the continuous spectrum: `m0 = 2π∫qC dq` [m2], `m2 = π∫q³C dq`, `m4 = (3π/4)∫q⁵C dq` [1/m2]."""
    return Moments(*many(_hysteron.moments, length_m, rms_height_m, hurst, magnification))


def lattice_moments(
    *, length_m: Reals, rms_height_m: Reals, hurst: Reals, magnification: Reals, normalization: str = "sample"
) -> Moments:
    """Moments of the discrete spectrum of a periodic square with fixed amplitudes: sums instead of the integrals of `moments`.

    `normalization="sample"`: the surface has exactly the given rms height. `"spectrum"`: the integral of the spectrum has it. The time is proportional to ζ:
    0.1 s at ζ = 10^6. `magnification` is at most 2^24.
    """
    if normalization not in ("sample", "spectrum"):
        raise ValueError(f"unknown normalization {normalization!r}\nhelp: use one of sample, spectrum")
    sample = normalization == "sample"
    return Moments(*many(_hysteron.lattice_moments, length_m, rms_height_m, hurst, magnification, sample=sample))
