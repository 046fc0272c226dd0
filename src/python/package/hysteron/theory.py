"""Theories beside a run: Deng and Kesari's loss, Dalvi's, the area without adhesion, and the parameters of Fuller and Tabor, Persson and Tosatti.

The material is given by keyword: `contact_modulus_pa` E* [Pa], `work_of_adhesion_j_m2` Δγ [J/m2]; the moments of a surface as
`hysteron.spectrum.Moments`, which `hysteron.spectrum.moments` gives. Every argument may be an array, and so may each moment; they are broadcast against
one another as NumPy does it. Of numbers alone a `float` comes back, of arrays an array of float64.

`as_printed` puts slips of the paper back, by the words of a spec: `"a2"` for the exponent of Eq A2, `"a3"` for the curvature below Eq A3.

Outside the domain: material, moments, gradients, radii and spectra that are not positive and finite are an error, a `ValueError` with the sentence of
the program. A load, an area or a height below zero gives NaN in its place, and so does NaN in any argument.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from typing import NamedTuple

from . import _hysteron
from ._arrays import Reals, Result, many, one, slips
from .spectrum import Moments


def curvature_density(t: Reals) -> Result:
    """Nayak's density of the reduced summit curvature, `p_k(t) = sqrt(3/(4π)) (t² - 2 + 2e^(-t²/2)) e^(-t²/4)` for t < 0, else 0. Eq A2.

    `t = -sqrt(3/m4) k_m` (dimensionless); it integrates to 1. The exponent printed in Eq A2 is `8(C1² - C2²)t²/(16C1)`, and only
    `(8C1² - C2²)t²/(16C1) = t²/4`, which is Nayak's marginal, integrates to 1.
    """
    return one(_hysteron.curvature_density, t)


def curvature_decay(nayak_parameter: Reals, *, as_printed: Collection[str] = ()) -> Result:
    """`c` in the factor `e^(-ct²)` of the density of curvature, of Nayak's parameter `α = m0 m4/m2²` (dimensionless): ¼ whatever α is.

    With `as_printed=["a2"]` it is `(α - 12)/(2(2α - 3))`, and NaN for α <= 12, where the printed density has no finite integral.
    """
    return one(_hysteron.curvature_decay, nayak_parameter, a2="a2" in slips(as_printed))


def curvature_density_as_printed(t: Reals, decay: Reals) -> Result:
    """The density of curvature with another decay, `p_k(t) = sqrt(3/(4π)) (t² - 2 + 2e^(-t²/2)) e^(-ct²)` for t < 0, else 0: Eq A2 as printed.

    `decay` is c of `curvature_decay`; it integrates to 1 only with c = ¼.
    """
    return one(_hysteron.curvature_density_as_printed, t, decay)


def mean_loop_loss(
    moments: Moments,
    *,
    contact_modulus_pa: Reals,
    work_of_adhesion_j_m2: Reals,
    tip_radius_m: Reals | None = None,
    as_printed: Collection[str] = (),
) -> Result:
    """Mean loss of one asperity `<θ> = ∫ 2E*R³ (πΔγ/(E*R))^(5/3) × 0.5262... p_k(t) dt` [J], with `1/R(t) = 1/R_tip + sqrt(m4/3)|t|`. Eq A3.

    `tip_radius_m` is the radius of a spherical indenter [m]; none, or infinity, for nominally flat surfaces. The curvature printed below Eq A3 is
    `sqrt(m4/3t)`, which `as_printed=["a3"]` puts back as `sqrt((m4/3)|t|)`; with `"a2"` Nayak's parameter must be above 12.
    """
    tip = math.inf if tip_radius_m is None else tip_radius_m
    back = slips(as_printed)
    return one(
        _hysteron.mean_loop_loss, *moments, contact_modulus_pa, work_of_adhesion_j_m2, tip, a2="a2" in back, a3="a3" in back
    )


def deng_kesari_loss(
    moments: Moments,
    area_m2: Reals,
    *,
    contact_modulus_pa: Reals,
    work_of_adhesion_j_m2: Reals,
    as_printed: Collection[str] = (),
) -> Result:
    """Deng and Kesari's loss `Θ = η A <θ>` [J] of the true contact area A [m2] at the end of loading, with Nayak's density η. Eq A4.

    NaN for A < 0.
    """
    back = slips(as_printed)
    return one(
        _hysteron.deng_kesari_loss, *moments, contact_modulus_pa, work_of_adhesion_j_m2, area_m2, a2="a2" in back, a3="a3" in back
    )


def dalvi_loss(area_m2: Reals, *, work_of_adhesion_j_m2: Reals) -> Result:
    """Loss of a contact that forms without loss and parts by its full work of adhesion, `Θ = Δγ A` [J], of the true contact area A [m2].

    Dalvi et al., PNAS 116:25484 (2019), found it of soft spheres in nearly full contact; of separate spots it is an upper bound. NaN for A < 0.
    """
    return one(_hysteron.dalvi_loss, work_of_adhesion_j_m2, area_m2)


def adhesionless_area(load: Reals, rms_slope: Reals) -> Result:
    """Contact area over A0 without adhesion, `erf(√2 p/(E* h'_rms))`. Persson, J. Chem. Phys. 115:3840 (2001).

    `load` is `p/E* = F/(E* A0)`, `rms_slope` the rms gradient h'_rms of the surface, all dimensionless. NaN for a load below 0.
    """
    return one(_hysteron.adhesionless_area, load, rms_slope)


def adhesionless_area_small(load: Reals, rms_slope: Reals) -> Result:
    """Contact area over A0 without adhesion at small loads, `κ p/(E* h'_rms)` with κ = 2, as boundary elements find it.

    Hyun, Pei, Molinari and Robbins, Phys. Rev. E 70:026117 (2004). Arguments as of `adhesionless_area`; NaN for a load below 0.
    """
    return one(_hysteron.adhesionless_area_small, load, rms_slope)


def fuller_tabor(height_sd_m: Reals, mean_radius_m: Reals, *, contact_modulus_pa: Reals, work_of_adhesion_j_m2: Reals) -> Result:
    """Fuller and Tabor's adhesion parameter `E* σ^(3/2)/(R^(1/2) Δγ)` (dimensionless). Proc. R. Soc. A 345:327 (1975).

    `height_sd_m` is the standard deviation σ of the heights of the summits [m], `mean_radius_m` their mean radius R [m]. Above some 10 adhesion is
    lost. NaN for σ < 0.
    """
    return one(_hysteron.fuller_tabor, contact_modulus_pa, work_of_adhesion_j_m2, height_sd_m, mean_radius_m)


class Flattening(NamedTuple):
    """Elastic energy per nominal area that flattens the roughness of a surface wholly; numbers or arrays."""

    #: Of all the roughness, qL <= q < q1 [J/m2].
    whole_j_m2: Result
    #: Of its shortest octave, q1/2 <= q < q1 [J/m2].
    octave_j_m2: Result


def flattening(*, length_m: Reals, rms_height_m: Reals, hurst: Reals, magnification: Reals, contact_modulus_pa: Reals) -> Flattening:
    """What flattens the continuous spectrum (Eq 10): `(E*/4) ∫ q C d²q = (π/2) E* C0 qL³ ∫ x^(-2H) dx`, `x = q/qL` [J/m2].

    Persson & Tosatti, J. Chem. Phys. 115:5597 (2001). The spectrum is given as in `hysteron.spectrum`.
    """
    return Flattening(*many(_hysteron.flattening, length_m, rms_height_m, hurst, magnification, contact_modulus_pa))


def persson_tosatti(
    *,
    length_m: Reals,
    rms_height_m: Reals,
    hurst: Reals,
    magnification: Reals,
    contact_modulus_pa: Reals,
    work_of_adhesion_j_m2: Reals,
) -> Result:
    """Persson and Tosatti's `U_el/Δγ` (dimensionless): below 1 full contact costs less than adhesion gains, and the surface is sticky."""
    columns = (length_m, rms_height_m, hurst, magnification, contact_modulus_pa, work_of_adhesion_j_m2)
    return many(_hysteron.flattening_ratios, *columns)[0]


def conformity(
    *,
    length_m: Reals,
    rms_height_m: Reals,
    hurst: Reals,
    magnification: Reals,
    contact_modulus_pa: Reals,
    work_of_adhesion_j_m2: Reals,
) -> Result:
    """The same ratio for the shortest octave alone: below 1 the half-space conforms to the summits and does not bridge them."""
    columns = (length_m, rms_height_m, hurst, magnification, contact_modulus_pa, work_of_adhesion_j_m2)
    return many(_hysteron.flattening_ratios, *columns)[1]
