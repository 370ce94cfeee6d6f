"""The element against a naive planar string with constant load, written here from the theory.

Section 3: H = W U / L + F, with F the friction of the surfaces and the force of the rims, referred
to U; the interface's friction balances F + W s / L. Springs in series with sliders for friction,
springs for the rims; the offset s of each step by bisection.
"""

import math
from itertools import pairwise

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import brentq

from lir_element import CoulombFriction, Element, LIRBearing

# Large radii, so that small tilt (sin theta = 0.028) is all there is.
W, RADII, HEIGHT, MU, MU_H = 2e5, (2.6, 3.6), 0.15, (0.03, 0.05), 0.09
U_Y, U_YH, K_RIM = 0.5e-3, 0.2e-3, 5e7
RIMS = (0.08, 0.09)
LENGTH = sum(RADII) - HEIGHT


BEARING = LIRBearing(
    radius=RADII,
    slider_height=HEIGHT,
    slider_radius=0.1,
    rims=RIMS,
    friction=(CoulombFriction(MU[0]), CoulombFriction(MU[1])),
    interface_friction=MU_H,
    yield_displacement=U_Y,
    interface_yield_displacement=U_YH,
    rim_stiffness=K_RIM,
    axial_stiffness=5e9,
    rim_overrun=0.05,
)


def naive(path: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return lateral force, interface slip and rim forces along `path`."""
    share = np.array(RADII) / LENGTH  # sliding of a surface over pendulum displacement U - s
    out = []

    def surfaces(z: np.ndarray, x: float, dx: float) -> tuple[np.ndarray, np.ndarray, float]:
        """Return z, rim forces and what both sum to, at the displacement x after a step dx."""
        new = np.clip(z + share * dx / U_Y, -1.0, 1.0)
        beyond = np.maximum(np.abs(share * x) - np.array(RIMS), 0.0)
        rim = math.copysign(1.0, x) * K_RIM * beyond
        return new, rim, float(np.sum(share * (np.array(MU) * W * new + rim)))

    def imbalance(ds: float, du: float, u: float, s: float, z: np.ndarray, z_h: float) -> float:
        force = surfaces(z, u + du - s - ds, du - ds)[2]
        interface = MU_H * W * np.clip(z_h + ds / U_YH, -1.0, 1.0)
        return float(interface - force - W * (s + ds) / LENGTH)

    z, z_h, u, s = np.zeros(2), 0.0, 0.0, 0.0
    for target in path:
        du = target - u
        ds = brentq(imbalance, -0.01, 0.01, args=(du, u, s, z, z_h), xtol=1e-13)
        z, rim, force = surfaces(z, target - s - ds, du - ds)
        z_h = float(np.clip(z_h + ds / U_YH, -1.0, 1.0))
        u, s = target, s + ds
        out.append((W * u / LENGTH + force, s, rim))
    force, slip, rims = zip(*out, strict=True)
    return np.array(force), np.array(slip), np.array(rims)


def element(path: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the same of the element, the vertical displacement found for constant load."""
    e, u = Element(BEARING), np.zeros(12)
    u[8] = -W / 5e9
    out = []
    for target in path:
        u[6] = target
        for _ in range(20):
            e.set_trial(u, np.zeros(12), 0.0)
            excess = e.resisting_force()[8] + W
            if abs(excess) < 1e-6 * W:
                break
            u[8] -= excess / e.tangent_stiffness()[8, 8]
        e.commit()
        out.append((e.resisting_force()[6], e.response("slip")[0], e.response("rim_force")))
    force, slip, rims = zip(*out, strict=True)
    return np.array(force), np.array(slip), np.array(rims)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_cyclic_path_with_rim_contact(sign: float) -> None:
    capacity = LENGTH * min(d / r for d, r in zip(RIMS, RADII, strict=True))
    corners = [0.0, 1.1, -1.13, 0.4, -0.6, 1.05, 0.0]
    ends = sign * capacity * np.array(corners)
    path = np.concatenate([np.linspace(a, b, 500)[1:] for a, b in pairwise(ends)])
    expected, computed = naive(path), element(path)
    assert np.abs(expected[1]).max() > 0.01  # it slips
    assert expected[2].any(axis=0).sum() == 1  # on one rim
    # Small tilt: theta^2 / 2 = 5e-4 of each term; (theta + psi)^2 / 3 of the force, 2e-3 of peak.
    peak = np.abs(expected[0]).max()
    assert_allclose(computed[0] / peak, expected[0] / peak, rtol=0.0, atol=3e-3)
    assert_allclose(computed[1], expected[1], rtol=0.0, atol=3e-3 * capacity)
    rim = np.abs(expected[2]).max()
    # A rim stops the slider within some 0.1 mm: the moment of contact shifts by theta^2 U / 6.
    close = np.abs(computed[2] - np.abs(expected[2])).max(axis=1) < 0.03 * rim
    assert close.mean() > 0.99
    # before any slip and rim contact: much closer
    start = slice(0, 400)
    assert_allclose(computed[0][start] / peak, expected[0][start] / peak, rtol=0.0, atol=1e-3)
