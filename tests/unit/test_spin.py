"""Torque of friction on a disc that slides and spins, against integrals over the disc."""

import numpy as np
import pytest

from lir_element.kernels.pendulum import spin

RADIUS = np.sqrt((np.arange(400) + 0.5) / 400)  # equal areas
ANGLE = (np.arange(400) + 0.5) / 400 * 2 * np.pi
X, Y = (RADIUS[:, None] * part for part in (np.cos(ANGLE), np.sin(ANGLE)))
RATIOS = [1e-3, 0.3, 0.8, 1.1, 1.5, 2.0, 4.0, 10.0]


def disc(ratio: float, eccentricity: tuple[float, float] = (0.0, 0.0)) -> tuple[float, ...]:
    """Return force along and across the sliding over mu N, torque about the axis over mu N a.

    The axis slides along x with 1, the edge spins with `ratio`.
    """
    pressure = 1.0 + 4.0 * (eccentricity[0] * X + eccentricity[1] * Y)
    v_x, v_y = 1.0 - ratio * Y, ratio * X
    size = np.hypot(v_x, v_y)
    along, across = v_x / size, v_y / size
    parts = (along, across, X * across - Y * along)
    return tuple(float((pressure * part).mean()) for part in parts)


@pytest.mark.parametrize("ratio", RATIOS)
def test_torque_of_a_disc_that_spins(ratio: float) -> None:
    part, slope = spin.torque_of_spin(ratio)
    torque = disc(ratio)[2]
    assert part * spin._TORQUE == pytest.approx(torque, rel=0.03)
    if ratio <= 0.3:
        assert spin._TORQUE * 0.375 * ratio == pytest.approx(torque, rel=0.01)
    if ratio > 2.0:
        assert spin._TORQUE * (1.0 - 0.75 / ratio**2) == pytest.approx(torque, rel=0.01)
    step = 1e-5 * ratio
    ahead, behind = (spin.torque_of_spin(ratio + d)[0] for d in (step, -step))
    assert slope == pytest.approx((ahead - behind) / (2 * step), rel=1e-6)


@pytest.mark.parametrize("ratio", RATIOS)
def test_friction_that_spin_leaves(ratio: float) -> None:
    assert (1.0 + ratio**4) ** -0.25 == pytest.approx(disc(ratio)[0], rel=0.02)


@pytest.mark.parametrize(("ratio", "off"), [(0.01, 1e-3), (0.3, 0.03), (1.6, 0.1), (50.0, 6e-3)])
@pytest.mark.parametrize("angle", [0.0, 1.0, 2.5, 4.7])
def test_torque_under_eccentric_pressure(ratio: float, off: float, angle: float) -> None:
    """That of an even pressure, and the moment of the friction that the axis' sliding gives.

    At the edge of the kern, over mu N a: exact for slow and for fast spin alone.
    """
    e = (0.25 * np.cos(angle), 0.25 * np.sin(angle))
    force, _, torque = disc(ratio)
    assert disc(ratio, e)[2] == pytest.approx(torque - e[1] * force, abs=off)
