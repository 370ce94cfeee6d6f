"""Finite rotations against scipy, and the spin operator against differences."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from lir_element.kernels.rotation import coefficients, rotate

SEAM = 2.5e-3  # of the squared angle: below it a series, above it closed forms
ANGLE = st.floats(-3.0, 3.0)
TINY = st.floats(-1e-3, 1e-3)


def rotation(vector: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    q, spin = np.full((3, 3), np.nan), np.full((3, 3), np.nan)
    rotate(*(float(x) for x in vector), q, spin)
    return q, spin


def spin_by_differences(vector: np.ndarray) -> np.ndarray:
    """Return d(spin)/d(vector): rotation vectors of R(v + h) R(v - h)^T over 2 h, to h^4."""
    columns = []
    for axis in np.eye(3):
        change = np.zeros(3)
        for h, weight in ((1e-3, 4.0 / 3.0), (2e-3, -1.0 / 3.0)):
            plus, minus = (Rotation.from_rotvec(vector + s * h * axis) for s in (1.0, -1.0))
            change += weight * (plus * minus.inv()).as_rotvec() / (2.0 * h)
        columns.append(change)
    return np.array(columns).T


@given(vector=st.one_of(st.tuples(ANGLE, ANGLE, ANGLE), st.tuples(TINY, TINY, TINY)))
def test_matrix_is_that_of_scipy(vector: tuple[float, float, float]) -> None:
    q, _ = rotation(np.array(vector))
    # round-off of 1 - cos over the square at the seam: 1e-16 / 2.5e-3 times the square
    assert_allclose(q, Rotation.from_rotvec(vector).as_matrix(), rtol=0.0, atol=5e-15)
    assert_allclose(q @ q.T, np.eye(3), rtol=0.0, atol=5e-15)


@given(vector=st.one_of(st.tuples(ANGLE, ANGLE, ANGLE), st.tuples(TINY, TINY, TINY)))
def test_spin_is_the_rate_of_rotation(vector: tuple[float, float, float]) -> None:
    _, spin = rotation(np.array(vector))
    expected = spin_by_differences(np.array(vector))
    # fourth order in 1e-3 and round-off of 1e-16 / 1e-3
    assert_allclose(spin, expected, rtol=0.0, atol=2e-11)


def test_no_rotation() -> None:
    q, spin = rotation(np.zeros(3))
    assert_allclose(q, np.eye(3), rtol=0.0, atol=0.0)
    assert_allclose(spin, np.eye(3), rtol=0.0, atol=0.0)


@pytest.mark.parametrize("square", [0.0, 1e-30, 1e-8, 1e-4, 0.999999 * SEAM, SEAM, 0.1, 4.0, 25.0])
def test_coefficients(square: float) -> None:
    """sin x / x, (1 - cos x) / x^2, (x - sin x) / x^3 by their Taylor series in exact order."""
    terms = range(40)
    expected = [sum((-square) ** n / math.factorial(2 * n + k) for n in terms) for k in (1, 2, 3)]
    # cancellation in the closed forms just above the seam: 1e-16 / 2.5e-3
    assert_allclose(coefficients(square), expected, rtol=2e-13, atol=1e-15)


def test_series_meets_the_closed_form() -> None:
    """Below and above the seam: no jump beyond the round-off of the closed forms."""
    below, above = (np.array(coefficients(SEAM * (1.0 + s * 1e-12))) for s in (-1.0, 1.0))
    assert_allclose(above, below, rtol=2e-13)
    # and the matrices of two neighbours on either side
    direction = np.array([0.48, -0.6, 0.64])
    one, two = (rotation(direction * math.sqrt(SEAM) * (1.0 + s * 1e-12)) for s in (-1.0, 1.0))
    for a, b in zip(one, two, strict=True):
        assert_allclose(a, b, rtol=0.0, atol=1e-13)  # they differ by 1e-12 of 0.05


@given(vector=st.tuples(ANGLE, ANGLE, ANGLE))
def test_opposite_vector_is_the_transpose(vector: tuple[float, float, float]) -> None:
    q, spin = rotation(np.array(vector))
    back, spin_back = rotation(-np.array(vector))
    assert_allclose(back, q.T, rtol=0.0, atol=1e-15)
    assert_allclose(spin_back, spin.T, rtol=0.0, atol=1e-15)
    assert_allclose(q @ spin.T, spin, rtol=0.0, atol=1e-14)  # T = Q T', a known identity
