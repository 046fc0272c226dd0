"""The single-asperity functions: against the formulae of their docstrings, and against values of many digits."""

import math

import numpy as np
import pytest

from conftest import table
from hysteron import jkr

E, G = 1e6, 0.07
GEL = {"contact_modulus_pa": E, "work_of_adhesion_j_m2": G}
R = 2.5e-5
A_OFF = (math.pi * R**2 * G / (8 * E)) ** (1 / 3)

# Name, further arguments, and the formula of the docstring in plain Python, of E*, Δγ, R and these.
FORMULAE = [
    ("pull_sqrt_m", [], lambda e, g, r: math.sqrt(2 * math.pi * g / e)),
    ("load", [3e-6], lambda e, g, r, a: 4 * e * a**3 / (3 * r) - math.sqrt(8 * math.pi * e * g * a**3)),
    ("load_slope", [3e-6], lambda e, g, r, a: 4 * e * a**2 / r - 1.5 * math.sqrt(8 * math.pi * e * g * a)),
    ("penetration", [3e-6], lambda e, g, r, a: a**2 / r - math.sqrt(2 * math.pi * a * g / e)),
    ("penetration_slope", [4e-6], lambda e, g, r, a: 2 * a / r - math.sqrt(math.pi * g / (2 * e * a))),
    ("jump_off_radius", [], lambda e, g, r: (math.pi * r**2 * g / (8 * e)) ** (1 / 3)),
    ("jump_off_penetration", [], lambda e, g, r: -((27 * math.pi**2 * g**2 * r / (64 * e**2)) ** (1 / 3))),
    ("pull_off_radius", [], lambda e, g, r: (9 * math.pi * r**2 * g / (8 * e)) ** (1 / 3)),
    ("pull_off_load", [], lambda e, g, r: -1.5 * math.pi * r * g),
    ("stored_energy", [2e-7, 5e-6], lambda e, g, r, d, a: e * (a * d**2 - 2 * a**3 * d / (3 * r) + a**5 / (5 * r**2))),
    ("tabor", [1e-9], lambda e, g, r, eps: (r * g**2 / e**2) ** (1 / 3) / eps),
    ("wu_jump_in_penetration", [1e-9], lambda e, g, r, eps: (1 - 2.641 * ((r * g**2 / e**2) ** (1 / 3) / eps) ** (3 / 7)) * eps),
    ("loop_loss", [], lambda e, g, r: 2 * e * r**3 * (math.pi * g / (e * r)) ** (5 / 3) * 2 ** (2 / 3) * (0.3 + 0.2 * 16 ** (-2 / 3))),
]


@pytest.mark.parametrize(("name", "values", "formula"), FORMULAE, ids=[name for name, *_ in FORMULAE])
def test_the_formula_of_the_docstring_holds(name, values, formula):
    function = getattr(jkr, name)
    found = function(R, *values, **GEL)
    assert isinstance(found, float)
    assert found == pytest.approx(formula(E, G, R, *values), rel=1e-12)
    # The same of arrays, each element its own asperity.
    radii = np.array([1e-6, 2.5e-5, 1e-3])
    adhesion = np.array([[0.05], [0.07]])
    found = function(radii, *values, contact_modulus_pa=E, work_of_adhesion_j_m2=adhesion)
    assert found.shape == (2, 3) and found.dtype == np.float64
    for (row, column), value in np.ndenumerate(found):
        assert value == pytest.approx(formula(E, adhesion[row, 0], radii[column], *values), rel=1e-11)


def test_values_of_many_digits():
    rows = table("jkr.csv")
    column = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    e, g, r, delta = (column[name] for name in ("E_star", "dgamma", "R", "delta"))
    gel = {"contact_modulus_pa": e, "work_of_adhesion_j_m2": g}
    a = jkr.radius_at_penetration(r, delta, **gel)
    # The first rows lie 1e-6 above the end of the branch, where a - a_off goes as a square root.
    digits = np.where(delta < column["delta_off"] * (1 - 2e-6), 1e-12, 2e-14)
    assert np.all(np.abs(a / column["a"] - 1) <= digits)
    assert np.all(np.abs(jkr.load(r, a, **gel) - column["F"]) <= 10 * digits * (r * g + np.abs(column["F"])))
    flat = a**2 / r
    scale = e * a * (delta**2 + flat**2)
    assert np.all(np.abs(jkr.stored_energy(r, delta, a, **gel) - column["U"]) <= 10 * digits * scale)
    for name, function in [
        ("theta", jkr.loop_loss),
        ("delta_off", jkr.jump_off_penetration),
        ("a_off", jkr.jump_off_radius),
        ("F_min", jkr.pull_off_load),
    ]:
        np.testing.assert_allclose(function(r, **gel), column[name], rtol=1e-14)


def test_the_branch_and_its_end():
    a = A_OFF * np.linspace(1.001, 30, 200)
    back = jkr.radius_at_penetration(R, jkr.penetration(R, a, **GEL), **GEL)
    np.testing.assert_allclose(back, a, rtol=1e-12)
    end = jkr.jump_off_penetration(R, **GEL)
    assert jkr.radius_at_penetration(R, end, **GEL) == pytest.approx(A_OFF, rel=1e-14)
    assert math.isnan(jkr.radius_at_penetration(R, end * (1 + 1e-12), **GEL))
    assert math.isnan(jkr.radius_at_penetration(R, math.inf, **GEL))
    # A loop that begins at δ = 0 loses what Eq A1 says, one that begins where it ends loses nothing.
    losses = jkr.loop_loss_from(R, np.array([0.0, end, end * 1.01]), **GEL)
    assert losses[0] == pytest.approx(jkr.loop_loss(R, **GEL), rel=1e-12)
    assert abs(losses[1]) < 1e-12 * losses[0] and math.isnan(losses[2])
    assert jkr.loop_loss_constant() == pytest.approx(0.5262203, abs=5e-8)


def test_the_slip_of_eq_9_ends_the_branch_earlier():
    printed = {**GEL, "as_printed": ["eq9"]}
    assert jkr.jump_off_radius(R, **printed) == pytest.approx(2 ** (1 / 3) * A_OFF, rel=1e-13)
    depth = jkr.jump_off_penetration(R, **printed) / jkr.jump_off_penetration(R, **GEL)
    assert depth == pytest.approx((4 * 2 ** (1 / 6) - 2 ** (2 / 3)) / 3, rel=1e-13)
    assert math.isnan(jkr.radius_at_penetration(R, 0.99 * jkr.jump_off_penetration(R, **GEL), **printed))
    assert jkr.jump_off_radius(R, **GEL, as_printed="eq9") == jkr.jump_off_radius(R, **printed)
    assert jkr.jump_off_radius(R, **GEL, as_printed=["eq8", "a2", "a3"]) == jkr.jump_off_radius(R, **GEL)
    with pytest.raises(ValueError, match="unknown equation 'eq5' in as_printed\nhelp: use one of eq8, eq9, a2, a3"):
        jkr.jump_off_radius(R, **GEL, as_printed=["eq5"])


def test_outside_the_domain():
    assert math.isnan(jkr.load(R, -1e-9, **GEL))
    assert jkr.load(R, 0.0, **GEL) == 0.0
    found = jkr.penetration_slope(R, np.array([-1.0, 0.0, A_OFF]), **GEL)
    assert np.isnan(found[:2]).all() and abs(found[2]) < 1e-12
    assert math.isnan(jkr.tabor(R, 0.0, **GEL)) and math.isnan(jkr.wu_jump_in_penetration(R, -1e-9, **GEL))
    assert math.isnan(jkr.stored_energy(R, 0.0, -1e-9, **GEL))
    sentence = r"cannot evaluate a JKR asperity: the radius of curvature \[m\] is -1\nhelp: expected a positive, finite number"
    with pytest.raises(ValueError, match=sentence + "$"):
        jkr.load(-1.0, 1e-6, **GEL)
    with pytest.raises(ValueError, match=sentence + "; this is element 1 of the arrays"):
        jkr.load([1.0, -1.0, 2.0], 1e-6, **GEL)
    for wrong in ({"contact_modulus_pa": 0.0}, {"work_of_adhesion_j_m2": math.inf}):
        with pytest.raises(ValueError, match="cannot evaluate a JKR asperity: the .*\nhelp: expected (zero or )?a positive, finite number"):
            jkr.load(R, 1e-6, **{**GEL, **wrong})
