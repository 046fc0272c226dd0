"""Analytical models: dissipated energy, adhesionless contact area, and adhesion parameters.

Keyword arguments define the material: `contact_modulus_pa` E*, reduced modulus [Pa]; `work_of_adhesion_j_m2` Δγ, work of adhesion [J/m2]. The moments of
a surface are `hysteron.spectrum.Moments`, from `hysteron.spectrum.moments`. All arguments and moments may be arrays and are broadcast as in NumPy. Scalar
arguments return a `float`, arrays an array of float64.

`as_printed` selects uncorrected equations of the paper: `"a2"` for the exponent of Eq A2, `"a3"` for the curvature below Eq A3.

Domain: material, moments, slopes, radii and spectra that are not positive and finite raise `ValueError`. A negative load, area or height, and NaN in any
argument, give NaN.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from typing import NamedTuple

from . import _hysteron
from ._arrays import Reals, Result, many, one, slips
from .spectrum import Moments


def curvature_density(t: Reals) -> Result:
    """Nayak's probability density of the reduced summit curvature, `p_k(t) = sqrt(3/(4π)) (t² - 2 + 2e^(-t²/2)) e^(-t²/4)` for t < 0, else 0. Eq A2.

    `t = -sqrt(3/m4) k_m` (dimensionless); it integrates to 1. The exponent printed in Eq A2 is `8(C1² - C2²)t²/(16C1)`, and only
    `(8C1² - C2²)t²/(16C1) = t²/4`, which is Nayak's marginal, integrates to 1.
    """
    return one(_hysteron.curvature_density, t)


def curvature_decay(nayak_parameter: Reals, *, as_printed: Collection[str] = ()) -> Result:
    """`c` in the factor `e^(-ct²)` of `curvature_density`, as a function of the bandwidth parameter `α = m0 m4/m2²`: ¼ for all α.

    With `as_printed=["a2"]` it is `(α - 12)/(2(2α - 3))`, and NaN for α <= 12, where the printed density has no finite integral.
    """
    return one(_hysteron.curvature_decay, nayak_parameter, a2="a2" in slips(as_printed))


def curvature_density_as_printed(t: Reals, decay: Reals) -> Result:
    """Uncorrected probability density of the reduced summit curvature, `p_k(t) = sqrt(3/(4π)) (t² - 2 + 2e^(-t²/2)) e^(-ct²)` for t < 0, else 0: Eq A2 as printed.

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
    """Mean dissipated energy of one asperity `<θ> = ∫ 2E*R³ (πΔγ/(E*R))^(5/3) × 0.5262... p_k(t) dt` [J], with `1/R(t) = 1/R_tip + sqrt(m4/3)|t|`. Eq A3.

    `tip_radius_m` is the radius of a spherical indenter [m]; None or infinity for nominally flat surfaces. `as_printed=["a3"]` uses the curvature printed
    below Eq A3, `sqrt(m4/3t)`, as `sqrt((m4/3)|t|)`. With `"a2"` the bandwidth parameter must be above 12.
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
    """Deng-Kesari estimate of the dissipated energy, `Θ = η A <θ>` [J]. Eq A4.

    A is the contact area at load reversal [m2], η Nayak's summit density [1/m2].

    NaN for A < 0.
    """
    back = slips(as_printed)
    return one(
        _hysteron.deng_kesari_loss, *moments, contact_modulus_pa, work_of_adhesion_j_m2, area_m2, a2="a2" in back, a3="a3" in back
    )


class ProbeLoss(NamedTuple):
    """Deng-Kesari estimate of a spherical probe; numbers or arrays."""

    #: Dissipated energy Θ = η (A_max - A_in) <θ> [J].
    loss_j: Result
    #: Contact area A_max of the smooth probe at the load reversal [m2].
    area_m2: Result
    #: Contact area A_in of the smooth probe after its jump into contact at zero penetration [m2].
    jump_in_area_m2: Result


def deng_kesari_probe_loss(
    moments: Moments,
    radius_m: Reals,
    max_load_n: Reals,
    *,
    contact_modulus_pa: Reals,
    work_of_adhesion_j_m2: Reals,
    as_printed: Collection[str] = (),
) -> ProbeLoss:
    """Deng-Kesari estimate of the dissipated energy of a probe of radius R with `R_tip = R` [J]. Sci. Rep. 9:1639 (2019).

    Contact areas are those of the smooth sphere by JKR theory, at the load `max_load_n` [N] and after the jump into contact. NaN for a tension above the
    pull-off force.
    """
    back = slips(as_printed)
    columns = (*moments, contact_modulus_pa, work_of_adhesion_j_m2, radius_m, max_load_n)
    return ProbeLoss(*many(_hysteron.deng_kesari_probe_loss, *columns, a2="a2" in back, a3="a3" in back))


class Works(NamedTuple):
    """Works of adhesion of the two branches of a loop; numbers or arrays."""

    #: Of closing, the advancing contact line [J/m2].
    closing_j_m2: Result
    #: Of opening, the receding contact line [J/m2].
    opening_j_m2: Result


def pinning_works(elastic_energy_j_m2: Reals, *, work_of_adhesion_j_m2: Reals, prefactor: Reals) -> Works:
    """Works of adhesion of crack-front pinning, `Δγ - k U_el` and `Δγ + k U_el` [J/m2], after Sanner et al., Sci. Adv. 10:eadl1277 (2024).

    U_el is the elastic energy per area that flattens the roughness [J/m2]. The prefactor k is 1.2 to 1.5 in simulations of hysteron, and about 3 in the
    publication, possibly as the full difference. NaN for k U_el >= Δγ/2, for k < 0 and for U_el < 0.
    """
    return Works(*many(_hysteron.pinning_works, work_of_adhesion_j_m2, elastic_energy_j_m2, prefactor))


def dalvi_closing(elastic_energy_j_m2: Reals, *, work_of_adhesion_j_m2: Reals) -> Result:
    """Work of adhesion of closing of conformal contact, `Δγ - U_el` [J/m2]. Dalvi et al., PNAS 116:25484 (2019). NaN for U_el >= Δγ and for U_el < 0."""
    return one(_hysteron.dalvi_closing, work_of_adhesion_j_m2, elastic_energy_j_m2)


def effective_adhesion(rms_slope: Reals, elastic_energy_j_m2: Reals, *, work_of_adhesion_j_m2: Reals) -> Result:
    """Work of adhesion of both branches of reversible full contact, `Δγ (1 + h'_rms²/2) - U_el` [J/m2].

    Persson & Tosatti, J. Chem. Phys. 115:5597 (2001). The area of small slopes exceeds the nominal one by the fraction h'_rms²/2. NaN for U_el >= Δγ, and for
    a negative slope or energy.
    """
    return one(_hysteron.effective_adhesion, work_of_adhesion_j_m2, rms_slope, elastic_energy_j_m2)


def dalvi_loss(area_m2: Reals, *, work_of_adhesion_j_m2: Reals) -> Result:
    """Work of adhesion times contact area, `Θ = Δγ A` [J], with the contact area A at load reversal [m2].

    Empirical relation for soft spheres near full contact (Dalvi et al., PNAS 116:25484, 2019); upper bound for separate contact spots. NaN for A < 0.
    """
    return one(_hysteron.dalvi_loss, work_of_adhesion_j_m2, area_m2)


def pinning_loss(elastic_energy_j_m2: Reals, area_m2: Reals, *, work_of_adhesion_j_m2: Reals) -> Result:
    """Energy dissipated by crack-front pinning, `Θ = 2 k U_el A` [J] with k = 1.35, after Sanner et al., Sci. Adv. 10:eadl1277 (2024).

    U_el is the elastic energy per area that flattens the roughness [J/m2], A the contact area [m2]. The prefactor k is that of hysteron. For one connected
    contact with weak roughness: NaN for k U_el >= Δγ/2, for A < 0 and for U_el < 0.
    """
    return one(_hysteron.pinning_loss, work_of_adhesion_j_m2, elastic_energy_j_m2, area_m2)


def sticky_line(persson_tosatti: Reals) -> Result:
    """Ratio `U_el/(2Δγ)` from `U_el/Δγ`; below 1 the pull-off force is high. Wang and Müser, Front. Mech. Eng. 8:965584 (2022). NaN below 0."""
    return one(_hysteron.sticky_line, persson_tosatti)


def adhesionless_area(load: Reals, rms_slope: Reals) -> Result:
    """Adhesionless contact area A/A0, `erf(√2 p/(E* h'_rms))`. Persson, J. Chem. Phys. 115:3840 (2001).

    `load` is `p/E* = F/(E* A0)`, `rms_slope` the rms slope h'_rms of the surface, both dimensionless. NaN for a load below 0.
    """
    return one(_hysteron.adhesionless_area, load, rms_slope)


def adhesionless_area_small(load: Reals, rms_slope: Reals) -> Result:
    """Adhesionless contact area A/A0 at small loads, `κ p/(E* h'_rms)` with κ = 2 from boundary-element results.

    Hyun, Pei, Molinari and Robbins, Phys. Rev. E 70:026117 (2004). Arguments as of `adhesionless_area`; NaN for a load below 0.
    """
    return one(_hysteron.adhesionless_area_small, load, rms_slope)


def fuller_tabor(height_sd_m: Reals, mean_radius_m: Reals, *, contact_modulus_pa: Reals, work_of_adhesion_j_m2: Reals) -> Result:
    """Fuller-Tabor parameter `E* σ^(3/2)/(R^(1/2) Δγ)` (dimensionless). Proc. R. Soc. A 345:327 (1975).

    `height_sd_m` is the standard deviation σ of the asperity heights [m], `mean_radius_m` their mean radius R [m]. Above about 10 adhesion is
    negligible. NaN for σ < 0.
    """
    return one(_hysteron.fuller_tabor, contact_modulus_pa, work_of_adhesion_j_m2, height_sd_m, mean_radius_m)


class Flattening(NamedTuple):
    """Elastic energy per nominal area to flatten the roughness completely; numbers or arrays."""

    #: Of all the roughness, qL <= q < q1 [J/m2].
    whole_j_m2: Result
    #: Of its shortest octave, q1/2 <= q < q1 [J/m2].
    octave_j_m2: Result


def flattening(*, length_m: Reals, rms_height_m: Reals, hurst: Reals, magnification: Reals, contact_modulus_pa: Reals) -> Flattening:
    """Elastic energy per nominal area to flatten the continuous spectrum (Eq 10): `(E*/4) ∫ q C d²q = (π/2) E* C0 qL³ ∫ x^(-2H) dx`, `x = q/qL` [J/m2].

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
    """Persson-Tosatti ratio `U_el/Δγ` (dimensionless); below 1 full contact is favoured."""
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
    """Ratio `U_el/Δγ` of the shortest octave (dimensionless); below 1 the half-space conforms to the shortest wavelengths."""
    columns = (length_m, rms_height_m, hurst, magnification, contact_modulus_pa, work_of_adhesion_j_m2)
    return many(_hysteron.flattening_ratios, *columns)[1]
