"""The works that the element counts are those that its nodes' forces do.

Nodes: trapezoidal work of forces along displacements, of moments along the rotation from one step
to the next. Element: friction of the surfaces, of the interface, rims, axial contact. Both are
second order in the increment, so their difference is. Friction counts slip apart from the elastic
sliding before it.
"""

from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

COUNT = 1000
WORKS = (
    "work_friction",
    "work_interface",
    "work_elastic",
    "work_owed",
    "work_rim",
    "work_contact",
)


def work_of_nodes(u: np.ndarray, force: np.ndarray) -> np.ndarray:
    """Return the accumulated work of the nodes' forces and moments."""
    steps = np.diff(u, axis=0)
    for first in (3, 9):
        turn = Rotation.from_rotvec(u[:, first : first + 3])
        steps[:, first : first + 3] = (turn[1:] * turn[:-1].inv()).as_rotvec()
    means = 0.5 * (force[1:] + force[:-1])
    return np.concatenate([[0.0], np.cumsum(np.sum(means * steps, axis=1))])


def works(lab: SimpleNamespace, variant: str, seed: int, refine: int, **changes: object) -> tuple:
    """Return (nodes, element, scale) histories at the coarse points of a path."""
    bearing = lab.make(variant, **changes)
    u, time = lab.smooth_path(bearing, seed, refine * COUNT + 1)
    r = lab.walk(bearing, u, time, WORKS)
    inside = sum(getattr(r, name).reshape(len(u), -1).sum(axis=1) for name in WORKS)
    scale = np.abs(r.work_friction).sum(axis=1).max()
    return work_of_nodes(u, r.resisting)[::refine], inside[::refine], scale


def test_works_agree(variant: str, lab: SimpleNamespace) -> None:
    """Less than 0.1 % of friction's work at all times; increments of about 0.6 mm here.

    The path is closed: nodes put in what friction dissipates, and what stays in the contact.
    """
    nodes, inside, scale = works(lab, variant, 5, 1)
    assert nodes[-1] > (1.0 - 1e-3) * scale
    assert_allclose(inside / scale, nodes / scale, rtol=0.0, atol=1e-3)


@pytest.mark.parametrize("name", ["coulomb", "fused", "random-2"])
def test_works_agree_to_second_order(name: str, lab: SimpleNamespace) -> None:
    """Halving the increment quarters the root-mean-square difference, within [1.7, 2.4] in order.

    Corners (slip, rim contact) inside an increment make the order of a single path scatter: mean of
    three paths. Without torsional friction, which works on the difference of rotation vectors, not
    of spins: of third order in the plates' rotations.
    """
    orders = []
    for seed in (1, 2, 3):
        errors = []
        for refine in (1, 2, 4):
            nodes, inside, scale = works(lab, name, seed, refine, torsional_friction=False)
            errors.append(np.sqrt(np.mean((inside - nodes) ** 2)) / scale)
        orders.append(0.5 * np.log2(errors[0] / errors[2]))
    assert 1.7 < np.mean(orders) < 2.4, orders


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_each_work_of_a_plain_push(sign: float, lab: SimpleNamespace) -> None:
    """Each term by itself: closed forms along x, plates parallel, N kept at 100 kN.

    Friction mu_k N (R_k tilt - u_y), interface mu_h N (s - u_yh), springs of friction half mu N u_y
    each, contact N^2 / (2 k) from the
    start; rim P^2 / (2 k_r).
    """
    bearing = lab.make("coulomb")
    element_u = np.zeros((6001, 12))
    element_u[:, 6] = sign * np.linspace(0.0, 0.17, 6001)
    for row in element_u:
        row[8] = lab.vertical(bearing, row, 1e5)
    names = (*WORKS, "axial_force", "slip", "rim_force", "slider_displacement", "axis")
    r = lab.walk(bearing, element_u, np.zeros(6001), names)
    tilt = np.arcsin(np.abs(r.axis[-1, 0]))
    slip = abs(r.slip[-1, 0])
    assert 5e-3 < slip < 5e-2
    n = r.axial_force
    # N falls by the string's share of the slip, s^2 / 2 L: below 1e-2; steps of 28 um, u_y / 18.
    for k, mu in enumerate((0.05, 0.08)):
        path = bearing.radii[k] * tilt - bearing.yield_displacement
        assert_allclose(r.work_friction[-1, k], mu * 1e5 * path, rtol=5e-3, atol=0.0)
    s = np.abs(r.slip[:, 0])
    expected = 0.15 * np.trapezoid(n, s) - 0.15 * 1e5 * bearing.interface_yield_displacement
    assert_allclose(r.work_interface[-1], expected, rtol=5e-3, atol=0.0)
    springs = 0.5 * 1e5 * (0.13 * bearing.yield_displacement)
    springs += 0.5 * 1e5 * 0.15 * bearing.interface_yield_displacement
    # a step in which slip starts is shared between both by its end points: 0.06 u_y
    assert_allclose(r.work_elastic[-1], springs, rtol=0.15, atol=0.0)
    assert_allclose(r.work_contact, 0.5 * n**2 / 1e8, rtol=0.0, atol=1e-5 * 50.0)
    assert_allclose(r.work_rim, 0.5 * r.rim_force**2 / 2e7, rtol=0.0, atol=1e-2)
    assert r.work_rim[-1].max() > 5.0
