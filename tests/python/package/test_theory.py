"""Theories and spectrum: against formulae in plain Python, quadrature, and values of many digits."""

import math

import numpy as np
import pytest

from conftest import table
from hysteron import spectrum, theory
from hysteron.spectrum import Moments

E, G = 1e6, 0.07
GEL = {"contact_modulus_pa": E, "work_of_adhesion_j_m2": G}
SURFACE = {"length_m": 1e-3, "rms_height_m": 5e-6, "hurst": 0.8, "magnification": 64}


def density(t):
    return math.sqrt(3 / (4 * math.pi)) * (t**2 - 2 + 2 * np.exp(-(t**2) / 2)) * np.exp(-(t**2) / 4)


def trapezoid(values, step):
    return step * (values.sum() - (values[0] + values[-1]) / 2)


def test_density_of_curvature():
    t = np.linspace(-20, 0, 40_001)
    found = theory.curvature_density(t)
    np.testing.assert_allclose(found, density(t), atol=1e-15)
    assert trapezoid(found, 5e-4) == pytest.approx(1, abs=1e-9)
    assert theory.curvature_density(0.5) == 0.0
    np.testing.assert_array_equal(theory.curvature_density_as_printed(t, 0.25), found)
    assert theory.curvature_decay(30.0) == 0.25
    np.testing.assert_allclose(theory.curvature_decay([30.0, 12.0], as_printed=["a2"]), [18 / 114, np.nan])


def test_mean_loss_by_quadrature():
    m = spectrum.moments(**SURFACE)
    # t = -u³ takes the power of 4/3 at 0 away.
    u = np.linspace(0, 20 ** (1 / 3), 20_001)[1:]
    for tip in (None, 1e-3):
        curvature = (0 if tip is None else 1 / tip) + math.sqrt(m.m4_1_m2 / 3) * u**3
        radius = 1 / curvature
        theta = 2 * E * radius**3 * (math.pi * G / (E * radius)) ** (5 / 3) * 2 ** (2 / 3) * (0.3 + 0.2 * 16 ** (-2 / 3))
        mean = np.sum(theta * density(-(u**3)) * 3 * u**2) * (u[1] - u[0])
        assert theory.mean_loop_loss(m, **GEL, tip_radius_m=tip) == pytest.approx(mean, rel=1e-6)
    both = theory.mean_loop_loss(m, **GEL, tip_radius_m=[math.inf, 1e-3])
    assert both[0] == theory.mean_loop_loss(m, **GEL) and both[1] < both[0]
    area = np.array([0.0, 2e-7])
    expected = m.summit_density_1_m2() * area * theory.mean_loop_loss(m, **GEL)
    np.testing.assert_allclose(theory.deng_kesari_loss(m, area, **GEL), expected, rtol=1e-14)
    assert math.isnan(theory.deng_kesari_loss(m, -1.0, **GEL))
    # What the slips are worth at this surface: each makes another estimate.
    losses = {theory.deng_kesari_loss(m, 1e-7, **GEL, as_printed=back) for back in ((), ("a2",), ("a3",), ("a2", "a3"))}
    assert len(losses) == 4


def test_closed_forms():
    assert theory.dalvi_loss(2e-7, work_of_adhesion_j_m2=G) == pytest.approx(G * 2e-7)
    assert theory.pinning_loss(0.1 * G, 2e-7, work_of_adhesion_j_m2=G) == pytest.approx(2 * 1.35 * 0.1 * G * 2e-7)
    assert math.isnan(theory.pinning_loss(0.4 * G, 2e-7, work_of_adhesion_j_m2=G))
    assert theory.sticky_line(3.0) == 1.5
    load = np.linspace(0, 0.2, 11)
    np.testing.assert_allclose(theory.adhesionless_area(load, 0.1), [math.erf(math.sqrt(2) * p / 0.1) for p in load], rtol=1e-14)
    np.testing.assert_allclose(theory.adhesionless_area_small(load, 0.1), 2 * load / 0.1)
    assert theory.fuller_tabor(1e-6, 2e-5, **GEL) == pytest.approx(E * 1e-9 / (math.sqrt(2e-5) * G))
    assert math.isnan(theory.adhesionless_area(-0.1, 0.1)) and math.isnan(theory.dalvi_loss(-1.0, work_of_adhesion_j_m2=G))


def test_works_of_adhesion():
    works = theory.pinning_works([3e-4, 4e-4], work_of_adhesion_j_m2=2e-3, prefactor=3.0)
    np.testing.assert_allclose(works.closing_j_m2, [1.1e-3, np.nan])
    np.testing.assert_allclose(works.opening_j_m2, [2.9e-3, np.nan])
    assert theory.dalvi_closing(6e-4, work_of_adhesion_j_m2=2e-3) == pytest.approx(1.4e-3)
    assert theory.effective_adhesion(0.1, 6e-4, work_of_adhesion_j_m2=2e-3) == pytest.approx(1.41e-3)
    assert math.isnan(theory.dalvi_closing(2e-3, work_of_adhesion_j_m2=2e-3))
    assert math.isnan(theory.effective_adhesion(0.1, -1.0, work_of_adhesion_j_m2=2e-3))


def test_loss_of_a_probe():
    m = Moments(2.5e-11, 8e-3, 2e8)
    found = theory.deng_kesari_probe_loss(m, 1e-3, 2e-3, **GEL)
    jump_in = math.pi * (2 * math.pi * 1e-6 * G / E) ** (2 / 3)
    assert found.jump_in_area_m2 == pytest.approx(jump_in, rel=1e-12)
    # brentq of the load of Eq 1, and quad of Eq A3: tests/physics/cut_off.rs.
    assert found.area_m2 == pytest.approx(6.977255508529556e-8, rel=1e-11)
    assert found.loss_j == pytest.approx(0.01251082268464191 * (found.area_m2 - jump_in), rel=1e-8)
    assert math.isnan(theory.deng_kesari_probe_loss(m, 1e-3, -1.0, **GEL).loss_j)


def test_moments_of_many_digits():
    for row in table("moments.csv"):
        surface = {**SURFACE, "hurst": row["H"], "magnification": row["zeta"]}
        m = spectrum.moments(**surface)
        found = (*m, m.rms_slope(), m.rms_curvature_1_m(), m.nayak_parameter(), m.summit_density_1_m2())
        names = ("m0", "m2", "m4", "slope_rms", "laplacian_rms", "alpha", "eta")
        for name, value in zip(names, found, strict=True):
            assert value == pytest.approx(row[name], rel=1e-11), name
        assert m.rms_height_m() == pytest.approx(5e-6, rel=1e-12)
        assert theory.mean_loop_loss(m, **GEL) == pytest.approx(row["theta_mean"], rel=1e-9)


def test_flattening_of_many_digits():
    rows = table("flattening.csv")
    surface = {**SURFACE, "hurst": [row["H"] for row in rows], "magnification": [row["zeta"] for row in rows]}
    energy = theory.flattening(**surface, contact_modulus_pa=E)
    whole, octave = ([row[name] for row in rows] for name in ("whole", "octave"))
    np.testing.assert_allclose(energy.whole_j_m2, whole, rtol=1e-12)
    np.testing.assert_allclose(energy.octave_j_m2, octave, rtol=1e-12)
    np.testing.assert_allclose(theory.persson_tosatti(**surface, **GEL), np.divide(whole, G), rtol=1e-12)
    np.testing.assert_allclose(theory.conformity(**surface, **GEL), np.divide(octave, G), rtol=1e-12)


def test_spectrum():
    ql = 2 * math.pi / 1e-3
    c0 = 25e-12 * 0.8 / (math.pi * ql**2 * (1 - 64**-1.6))
    assert spectrum.lowest_wavenumber(length_m=1e-3) == pytest.approx(ql)
    assert spectrum.prefactor(**SURFACE) == pytest.approx(c0, rel=1e-13)
    k2 = np.array([0, 1, 2, 64**2 - 1, 64**2])
    expected = [0, c0, c0 * 2**-1.8, c0 * (64.0**2 - 1) ** -1.8, 0]
    np.testing.assert_allclose(spectrum.density(k2, **SURFACE), expected, rtol=1e-13)
    lattice = spectrum.lattice_moments(**SURFACE)
    assert lattice.rms_height_m() == pytest.approx(5e-6, rel=1e-12)
    k = np.arange(-63, 64)
    power = spectrum.density(k[:, None] ** 2 + k**2, **SURFACE)
    raw = spectrum.lattice_moments(**SURFACE, normalization="spectrum")
    assert raw.m0_m2 == pytest.approx(power.sum() * ql**2, rel=1e-12)
    assert spectrum.moments(**{**SURFACE, "hurst": [0.7, 0.8]}).m2.shape == (2,)


def test_errors():
    with pytest.raises(ValueError, match=r"cannot evaluate Deng and Kesari's mean loss \(Eq A3\): m4 \[1/m2\] is 0\nhelp: expected a positive, finite"):
        theory.mean_loop_loss(Moments(1.0, 1.0, 0.0), **GEL)
    with pytest.raises(ValueError, match="Nayak's parameter is 1\nhelp: expected with Eq A2 as printed, above 12"):
        theory.mean_loop_loss(Moments(1.0, 1.0, 1.0), **GEL, as_printed=["a2"])
    with pytest.raises(ValueError, match=r"the tip radius \[m\] is -1"):
        theory.mean_loop_loss(Moments(1.0, 1.0, 1.0), **GEL, tip_radius_m=-1.0)
    for key, wrong in [("hurst", 1.1), ("magnification", 1), ("magnification", 2.5), ("length_m", 0), ("rms_height_m", -1)]:
        with pytest.raises(ValueError, match=r"cannot evaluate the spectrum \(Eq 10\): .*\nhelp: expected "):
            spectrum.moments(**{**SURFACE, key: wrong})
    with pytest.raises(ValueError, match="the squared mode number is 1.5e0\nhelp: expected a whole number"):
        spectrum.density(1.5, **SURFACE)
    with pytest.raises(ValueError, match="unknown normalization 'rms'"):
        spectrum.lattice_moments(**SURFACE, normalization="rms")
    with pytest.raises(ValueError, match=r"the energy of flattening: the work of adhesion \[J/m2\] is 0"):
        theory.conformity(**SURFACE, contact_modulus_pa=E, work_of_adhesion_j_m2=0)


def test_many_discrete_modes():
    large = {**SURFACE, "magnification": 10**6}
    lattice, integral = spectrum.lattice_moments(**large, normalization="spectrum"), spectrum.moments(**large)
    # m4 is that of the shortest waves, where a sum over modes is an integral: the edge of the band adds at most 8 modes of 10^6.
    assert lattice.m4_1_m2 == pytest.approx(integral.m4_1_m2, rel=1e-5)
    with pytest.raises(ValueError, match="discrete modes: the magnification is 3.*\nhelp: expected at most 16777216"):
        spectrum.lattice_moments(**{**SURFACE, "magnification": 2**25})
