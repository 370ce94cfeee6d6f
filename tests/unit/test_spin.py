"""Torque of friction on a disc that slides and spins, against integrals over the disc."""

import numpy as np
import pytest

from lir_element.kernels.pendulum import spin

RADIUS = np.sqrt((np.arange(400) + 0.5) / 400)  # equal areas
ANGLE = (np.arange(400) + 0.5) / 400 * 2 * np.pi
X, Y = (RADIUS[:, None] * part for part in (np.cos(ANGLE), np.sin(ANGLE)))


def torque(omega: float, eccentricity: float = 0.0) -> float:
    """Return the torque about the centre of pressure over mu N a: it slides along x with 1."""
    pressure = 1.0 + 4.0 * eccentricity * X
    v_x, v_y = 1.0 - omega * Y, omega * (X - eccentricity)
    lever = (X - eccentricity) * v_y - Y * v_x
    return float((pressure * lever / np.hypot(v_x, v_y)).mean())


@pytest.mark.parametrize("omega", [1e-3, 0.3, 0.8, 1.1, 1.5, 2.0, 4.0, 10.0])
def test_spin_under_a_couple(omega: float) -> None:
    part = torque(omega) / spin._TORQUE
    assert spin.relative_spin(part) == pytest.approx(omega, rel=0.03)


@pytest.mark.parametrize("eccentricity", [0.1, 0.25])
def test_eccentric_pressure(eccentricity: float) -> None:
    """Eccentric along the sliding: exact at the edge of the kern."""
    exact = torque(1e-3, eccentricity) / torque(1e-3)
    share = 1.0 / (1.0 + spin._NARROW * eccentricity**2)
    assert share == pytest.approx(exact, abs=0.012)
