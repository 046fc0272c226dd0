"""Single JKR (Johnson, Kendall, Roberts) asperity: rigid paraboloid of radius R on an elastic half-space, one function per equation.

Source: Violano & Afferrante, Lubricants 9(1):7 (2021), Eqs 1-4 and A1; Johnson, Kendall & Roberts, Proc. R. Soc. A 324:301 (1971).

The first argument is the radius of curvature `radius_m` R [m]. Keyword arguments define the material: `contact_modulus_pa` E*, reduced modulus [Pa],
and `work_of_adhesion_j_m2` Δγ, work of adhesion [J/m2]. Contact radii `a_m` a, penetrations `penetration_m` δ (positive in compression) and ranges are
in metres, loads F in newtons (positive in compression), energies in joule. All arguments may be arrays and are broadcast as in NumPy. Scalar arguments
return a `float`, arrays an array of float64.

`as_printed=["eq9"]` uses the uncorrected denominator of Eq 9, `2a/R - sqrt(πΔγ/(E*a))`: the stable branch ends at
`2^⅓` of the jump-off radius.

Domain: R, E* and Δγ that are not positive and finite raise `ValueError`. A contact radius, penetration or range outside the domain of the equation,
and NaN in any argument, give NaN.
"""

from __future__ import annotations

from collections.abc import Collection

from . import _hysteron
from ._arrays import Reals, Result, one, slips


def loop_loss_constant() -> float:
    """Constant of the dissipated energy of one asperity, `2^⅔ (3/10 + (1/5) 16^(-⅔)) = 0.5262203...` (Eq A1 prints 0.5262)."""
    return _hysteron.loop_loss_constant


def pull_sqrt_m(radius_m: Reals, *, contact_modulus_pa: Reals, work_of_adhesion_j_m2: Reals) -> Result:
    """Adhesive term of the penetration over `sqrt(a)`: `sqrt(2πΔγ/E*)` [m^½]."""
    return one(_hysteron.pull_sqrt_m, radius_m, contact_modulus_pa, work_of_adhesion_j_m2, eq9=False)


def load(radius_m: Reals, a_m: Reals, *, contact_modulus_pa: Reals, work_of_adhesion_j_m2: Reals) -> Result:
    """Load `F = 4E*a³/(3R) - sqrt(8πE*Δγa³)` [N] at contact radius a [m]. Eq 1.

    NaN for a < 0.
    """
    return one(_hysteron.load, radius_m, a_m, contact_modulus_pa, work_of_adhesion_j_m2, eq9=False)


def load_slope(radius_m: Reals, a_m: Reals, *, contact_modulus_pa: Reals, work_of_adhesion_j_m2: Reals) -> Result:
    """Derivative of the load `dF/da = 4E*a²/R - (3/2) sqrt(8πE*Δγa)` [N/m] at contact radius a [m]. Derivative of Eq 1.

    NaN for a < 0.
    """
    return one(_hysteron.load_slope, radius_m, a_m, contact_modulus_pa, work_of_adhesion_j_m2, eq9=False)


def penetration(radius_m: Reals, a_m: Reals, *, contact_modulus_pa: Reals, work_of_adhesion_j_m2: Reals) -> Result:
    """Penetration `δ = a²/R - sqrt(2πaΔγ/E*)` [m] at contact radius a [m]. Eq 2.

    NaN for a < 0.
    """
    return one(_hysteron.penetration, radius_m, a_m, contact_modulus_pa, work_of_adhesion_j_m2, eq9=False)


def penetration_slope(radius_m: Reals, a_m: Reals, *, contact_modulus_pa: Reals, work_of_adhesion_j_m2: Reals) -> Result:
    """Derivative of the penetration `dδ/da = 2a/R - sqrt(πΔγ/(2E*a))` (dimensionless) at contact radius a [m]. Derivative of Eq 2.

    NaN for a <= 0. The paper prints the denominator of Eq 9 as `2a/R - sqrt(πΔγ/(E*a))`, which is not this derivative.
    """
    return one(_hysteron.penetration_slope, radius_m, a_m, contact_modulus_pa, work_of_adhesion_j_m2, eq9=False)


def jump_off_radius(
    radius_m: Reals, *, contact_modulus_pa: Reals, work_of_adhesion_j_m2: Reals, as_printed: Collection[str] = ()
) -> Result:
    """Contact radius at the jump out of contact under displacement control, `(πR²Δγ/(8E*))^⅓` [m], where dδ/da = 0.

    With `as_printed=["eq9"]` it is `(πR²Δγ/(4E*))^⅓`.
    """
    return one(_hysteron.jump_off_radius, radius_m, contact_modulus_pa, work_of_adhesion_j_m2, eq9="eq9" in slips(as_printed))


def jump_off_penetration(
    radius_m: Reals, *, contact_modulus_pa: Reals, work_of_adhesion_j_m2: Reals, as_printed: Collection[str] = ()
) -> Result:
    """Penetration at the jump out of contact `δ_off = -(27π²Δγ²R/(64E*²))^⅓` [m]. Eq 4.

    With `as_printed=["eq9"]`, Eq 2 at the uncorrected jump-off radius, 0.9675 times this value.
    """
    return one(_hysteron.jump_off_penetration, radius_m, contact_modulus_pa, work_of_adhesion_j_m2, eq9="eq9" in slips(as_printed))


def pull_off_radius(radius_m: Reals, *, contact_modulus_pa: Reals, work_of_adhesion_j_m2: Reals) -> Result:
    """Contact radius at the maximum tensile load, `(9πR²Δγ/(8E*))^⅓` [m]."""
    return one(_hysteron.pull_off_radius, radius_m, contact_modulus_pa, work_of_adhesion_j_m2, eq9=False)


def pull_off_load(radius_m: Reals, *, contact_modulus_pa: Reals, work_of_adhesion_j_m2: Reals) -> Result:
    """Pull-off force as a load: `-(3/2)πRΔγ` [N], the most negative load."""
    return one(_hysteron.pull_off_load, radius_m, contact_modulus_pa, work_of_adhesion_j_m2, eq9=False)


def radius_at_penetration(
    radius_m: Reals,
    penetration_m: Reals,
    *,
    contact_modulus_pa: Reals,
    work_of_adhesion_j_m2: Reals,
    as_printed: Collection[str] = (),
) -> Result:
    """Contact radius a [m] on the stable branch at penetration δ [m]: the inverse of Eq 2.

    NaN below the jump-off penetration and at infinity.
    """
    eq9 = "eq9" in slips(as_printed)
    return one(_hysteron.radius_at_penetration, radius_m, penetration_m, contact_modulus_pa, work_of_adhesion_j_m2, eq9=eq9)


def radius_at_load(radius_m: Reals, load_n: Reals, *, contact_modulus_pa: Reals, work_of_adhesion_j_m2: Reals) -> Result:
    """Contact radius a [m] on the branch that is stable under control of the load, at a load F [N].

    `a³ = (3R/(4E*)) (F + 3πRΔγ + sqrt(6πRΔγF + (3πRΔγ)²))`. NaN at a tension above the pull-off force.
    """
    return one(_hysteron.radius_at_load, radius_m, load_n, contact_modulus_pa, work_of_adhesion_j_m2, eq9=False)


def stored_energy(
    radius_m: Reals, penetration_m: Reals, a_m: Reals, *, contact_modulus_pa: Reals, work_of_adhesion_j_m2: Reals
) -> Result:
    """Stored elastic energy at fixed contact radius `U(δ, a) = E*(aδ² - 2a³δ/(3R) + a⁵/(5R²))` [J].

    On the equilibrium path ∂U/∂δ = F and ∂U/∂(πa²) = Δγ. NaN for a < 0.
    """
    return one(_hysteron.stored_energy, radius_m, penetration_m, a_m, contact_modulus_pa, work_of_adhesion_j_m2, eq9=False)


def tabor(radius_m: Reals, range_m: Reals, *, contact_modulus_pa: Reals, work_of_adhesion_j_m2: Reals) -> Result:
    """Tabor parameter `μ = (RΔγ²/E*²)^⅓ / ε` (dimensionless) of the range of attraction ε [m]. Below Eq 3.

    NaN for ε <= 0.
    """
    return one(_hysteron.tabor, radius_m, range_m, contact_modulus_pa, work_of_adhesion_j_m2, eq9=False)


def wu_jump_in_penetration(
    radius_m: Reals, range_m: Reals, *, contact_modulus_pa: Reals, work_of_adhesion_j_m2: Reals
) -> Result:
    """Wu's jump-in penetration `δ_in = (1 - 2.641 μ^(3/7)) ε` [m] of the range of attraction ε [m]. Eq 3.

    Valid for a Tabor parameter of at least 2, which is not checked here. Negative: contact forms at a gap below |δ_in|. NaN for ε <= 0.
    """
    return one(_hysteron.wu_jump_in_penetration, radius_m, range_m, contact_modulus_pa, work_of_adhesion_j_m2, eq9=False)


def loop_loss(radius_m: Reals, *, contact_modulus_pa: Reals, work_of_adhesion_j_m2: Reals) -> Result:
    """Dissipated energy of one loop with jump into contact at δ = 0: `2E*R³ (πΔγ/(E*R))^(5/3) × 0.5262...` [J]. Eq A1.

    Uses the exact constant `loop_loss_constant()`.
    """
    return one(_hysteron.loop_loss, radius_m, contact_modulus_pa, work_of_adhesion_j_m2, eq9=False)


def loop_loss_from(
    radius_m: Reals, jump_in_m: Reals, *, contact_modulus_pa: Reals, work_of_adhesion_j_m2: Reals, as_printed: Collection[str] = ()
) -> Result:
    """Dissipated energy of one loop with jump into contact at the penetration δ_in [m], δ_off <= δ_in <= 0 [J].

    Sum of the decreases of U - Δγπa² in both jumps. NaN below the jump-off penetration. With `as_printed=["eq9"]` the loop ends at the end of the
    uncorrected branch.
    """
    return one(_hysteron.loop_loss_from, radius_m, jump_in_m, contact_modulus_pa, work_of_adhesion_j_m2, eq9="eq9" in slips(as_printed))
