"""Broadcasting, types and layouts of what is passed."""

import math
import signal
import threading

import numpy as np
import pyarrow as pa
import pytest

from hysteron import jkr, spectrum, theory

GEL = {"contact_modulus_pa": 1e6, "work_of_adhesion_j_m2": 0.07}
R = 2.5e-5


def plain(a):
    return 4e6 * a**3 / (3 * R) - np.sqrt(8 * np.pi * 0.07e6 * a**3)


def test_shapes():
    a = np.linspace(1e-6, 5e-6, 12)
    for shape in [(12,), (3, 4), (1, 12), (2, 3, 2), (12, 1)]:
        found = jkr.load(R, a.reshape(shape), **GEL)
        assert found.shape == shape and found.flags.c_contiguous
        np.testing.assert_allclose(found, plain(a.reshape(shape)), rtol=1e-9)
    crossed = jkr.load(np.full((3, 1), R), a, **GEL)
    np.testing.assert_array_equal(crossed, np.broadcast_to(jkr.load(R, a, **GEL), (3, 12)))
    assert jkr.load(np.full((3, 1), R), a[:0], **GEL).shape == (3, 0)
    with pytest.raises(ValueError, match="broadcast"):
        jkr.load([R, R], [1e-6, 2e-6, 3e-6], **GEL)


def test_numbers_give_numbers_and_arrays_arrays():
    for number in (3e-6, np.float64(3e-6), np.float32(3e-6), np.array(3e-6)):
        assert type(jkr.load(R, number, **GEL)) is float
    assert jkr.load(R, [3e-6], **GEL).shape == (1,)
    assert jkr.load([[R]], 3e-6, **GEL).shape == (1, 1)


@pytest.mark.parametrize("empty", [[], np.zeros((0,)), np.zeros((3, 0)), np.zeros((0, 4), dtype=np.int32)])
def test_nothing_gives_nothing(empty):
    found = jkr.load(R, empty, **GEL)
    assert found.shape == np.shape(empty) and found.dtype == np.float64
    # Not even what is wrong is looked at, where no element has it.
    assert jkr.load(-R, empty, **GEL).size == 0


@pytest.mark.parametrize("kind", [np.float64, np.float32, np.float16, np.int64, np.uint8, np.bool_, ">f8", "<i2", object])
def test_kinds_of_numbers(kind):
    values = np.array([0, 1, 1], dtype=kind)
    np.testing.assert_array_equal(jkr.load(1.0, values, **GEL), jkr.load(1.0, [0.0, 1.0, 1.0], **GEL))


@pytest.mark.parametrize("strange", [1 + 2j, np.array(["1"]), np.array(["2020-01-01"], dtype="M8[D]"), b"1"])
def test_what_is_no_number(strange):
    with pytest.raises(TypeError, match="cannot compute with an array of type .*\nhelp: use real numbers"):
        jkr.load(R, strange, **GEL)


def test_layouts():
    square = np.asfortranarray(np.linspace(1e-6, 5e-6, 36).reshape(6, 6))
    whole = jkr.load(R, np.array(square, order="C"), **GEL)
    for cut in [np.s_[:, :], np.s_[::2, 1::3], np.s_[::-1], np.s_[:, ::-2], np.s_[2]]:
        np.testing.assert_array_equal(jkr.load(R, square[cut], **GEL), whole[cut])
    np.testing.assert_array_equal(jkr.load(R, square.T, **GEL), whole.T)
    # Not aligned: a field of a packed record.
    packed = np.zeros(5, dtype=[("flag", "u1"), ("a", "f8")])
    packed["a"] = square[0, :5]
    np.testing.assert_array_equal(jkr.load(R, packed["a"], **GEL), whole[0, :5])
    frozen = square.copy()
    frozen.flags.writeable = False
    np.testing.assert_array_equal(jkr.load(R, frozen, **GEL), whole)


def test_what_is_missing_stays_missing():
    a = np.array([1e-6, np.nan, 3e-6])
    found = jkr.load(R, a, **GEL)
    assert list(np.isnan(found)) == [False, True, False]
    # In any argument, those of the asperity included.
    assert math.isnan(jkr.load(math.nan, 1e-6, **GEL))
    assert math.isnan(theory.dalvi_loss(1.0, work_of_adhesion_j_m2=math.nan))
    # A null of an Arrow column is missing too.
    assert list(np.isnan(jkr.load(R, pa.chunked_array([[1e-6, None], [2e-6]]), **GEL))) == [False, True, False]


def test_arguments_are_left_as_they_are():
    a = np.linspace(1e-6, 5e-6, 7)
    kept = a.copy()
    found = jkr.load(R, a, **GEL)
    found[:] = 0.0
    np.testing.assert_array_equal(a, kept)


def test_many_elements_with_other_threads_beside():
    a = np.linspace(1e-6, 5e-6, 300_000)
    results = []
    threads = [threading.Thread(target=lambda: results.append(jkr.load(R, a, **GEL))) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for found in results:
        # Near F = 0 the two terms cancel.
        np.testing.assert_allclose(found, plain(a), rtol=1e-9, atol=1e-18)


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="the system has no timers")
def test_ctrl_c_ends_a_long_array():
    def stop(*_):
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, stop)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.2)
        with pytest.raises(KeyboardInterrupt):
            # Some minutes of quadrature, if nobody stopped it.
            theory.mean_loop_loss((np.full(20_000_000, 1e-12), 1e-2, 1e10), **GEL)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def test_masked_values_are_not_used():
    values = np.ma.masked_array([1e-6, 2e-6, 3e-6], mask=[False, True, False])
    np.testing.assert_array_equal(jkr.load(R, values, **GEL), jkr.load(R, [1e-6, np.nan, 3e-6], **GEL))
    whole = np.ma.masked_array([1, 2, 3], mask=[0, 0, 1])
    np.testing.assert_array_equal(np.isnan(jkr.load(1.0, whole, **GEL)), [False, False, True])
    assert math.isnan(jkr.load(np.ma.masked, 1e-6, **GEL))
    objects = np.ma.masked_array(np.array([1e-6, None], dtype=object), mask=[False, True])
    np.testing.assert_array_equal(np.isnan(jkr.load(R, objects, **GEL)), [False, True])
    lengths = np.ma.masked_array([1e-3, 1e-3], mask=[True, False])
    np.testing.assert_array_equal(np.isnan(spectrum.lowest_wavenumber(length_m=lengths)), [True, False])
    np.testing.assert_array_equal(np.isnan(theory.adhesionless_area(0.01, np.ma.masked_array([0.1, 0.1], mask=[True, False]))), [True, False])
