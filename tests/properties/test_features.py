"""With features left out the element keeps exact tangent, energy balance and symmetries."""

from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation

from lir_element import CoulombFriction, Element, Features, cyclic_test

STILL = np.zeros(12)
WORKS = (
    "work_friction",
    "work_interface",
    "work_elastic",
    "work_owed",
    "work_rim",
    "work_contact",
)
OUT = {
    "uplift": ("uplift",),
    "uplift, interface": ("uplift", "interface"),
    "vertical coupling": ("vertical_coupling",),
    "vertical coupling, interface": ("vertical_coupling", "interface"),
    "rims, velocity dependence": ("rims", "velocity_dependence"),
}
DEVICES = [
    "coulomb",
    "bouc_wen_velocity",
    "fused_velocity_torsion",
    "thick_plates",
    "random-1",
    "pressed_and_heated",
]

left_out = pytest.mark.parametrize("out", OUT)
device = pytest.mark.parametrize("name", DEVICES)


def path(lab: SimpleNamespace, bearing: object, count: int = 320) -> tuple:
    """An oblique motion with tilting, twisting plates, in which the string is pulled at times."""
    return lab.smooth_path(bearing, 11, count, swing=1.6)


@left_out
@device
def test_tangent(out: str, name: str, lab: SimpleNamespace) -> None:
    """Against differences of fourth order; two steps must agree, or a corner lies between."""
    bearing, errors, pulled = lab.make(name), [], 0
    u, time = path(lab, bearing)

    def differences(element: Element, at: np.ndarray, t: float, step: float) -> np.ndarray:
        k = np.zeros((12, 12))
        for column in range(12):
            for shift, weight in ((-2, 1.0), (-1, -8.0), (1, 8.0), (2, -1.0)):
                moved = at.copy()
                moved[column] += shift * step
                element.set_trial(moved, STILL, t)
                k[:, column] += weight * element.resisting_force() / (12.0 * step)
        return k

    def visit(element: Element, k: int) -> None:
        nonlocal pulled
        if k % 16 != 9:
            return
        for t in (time[k], time[k - 1]):
            element.set_trial(u[k], STILL, t)
            tangent = element.tangent_stiffness()
            pulled += element.response("axial_force") < 0.0
            scale = max(np.abs(tangent).max(), 1.0)  # N/m: zero where lifted
            coarse, fine = (differences(element, u[k], t, s) for s in (8e-7, 4e-7))
            if np.abs(coarse - fine).max() < 2e-8 * scale:
                errors.append(np.abs(tangent - coarse).max() / scale)
        element.set_trial(u[k], STILL, time[k])

    lab.walk(bearing, u, time, visit=visit, features=Features().without(*OUT[out]))
    assert len(errors) >= 32  # of 40
    assert_allclose(errors, 0.0, rtol=0.0, atol=3e-8)
    assert (pulled > 5) == out.startswith("uplift")


@left_out
@device
def test_works_are_those_of_the_nodes(out: str, name: str, lab: SimpleNamespace) -> None:
    bearing = lab.make(name)
    u, time = path(lab, bearing, 2000)
    r = lab.walk(bearing, u, time, WORKS, features=Features().without(*OUT[out]))
    steps = np.diff(u, axis=0)
    for first in (3, 9):
        turn = Rotation.from_rotvec(u[:, first : first + 3])
        steps[:, first : first + 3] = (turn[1:] * turn[:-1].inv()).as_rotvec()
    nodes = np.sum(0.5 * (r.resisting[1:] + r.resisting[:-1]) * steps, axis=1)
    inside = sum(getattr(r, work).reshape(len(u), -1).sum(axis=1) for work in WORKS)
    scale = r.work_friction[-1].sum()
    gap = np.concatenate([[0.0], np.cumsum(nodes)]) - (inside - inside[0])
    assert_allclose(gap / scale, 0.0, rtol=0.0, atol=1e-3)  # trapezoidal, second order
    assert (np.diff(r.work_friction, axis=0) >= 0.0).all()


@left_out
@device
def test_forces_and_moments_balance(out: str, name: str, lab: SimpleNamespace) -> None:
    bearing = lab.make(name)
    u, time = path(lab, bearing)
    f = lab.walk(bearing, u, time, features=Features().without(*OUT[out])).resisting
    arm = u[:, 6:9] - u[:, :3]
    arm[:, 2] += bearing.height
    moment = f[:, 3:6] + f[:, 9:12] + np.cross(arm, f[:, 6:9])
    size = np.abs(f[:, 6:9]).max()
    assert_allclose(f[:, :3], -f[:, 6:9], rtol=0.0, atol=1e-12 * size)
    assert_allclose(moment, 0.0, rtol=0.0, atol=1e-12 * size)


def test_bilateral_contact_is_the_other_one_while_pressed(lab: SimpleNamespace) -> None:
    bearing = lab.make("thick_plates")
    u, time = lab.smooth_path(bearing, 3, 300, swing=0.5)
    one, other = (
        lab.walk(bearing, u, time, features=Features(uplift=uplift)) for uplift in (True, False)
    )
    scale = np.abs(one.resisting).max()
    assert_allclose(other.resisting, one.resisting, rtol=0.0, atol=1e-11 * scale)


def test_left_out_is_the_device_without(lab: SimpleNamespace) -> None:
    bearing = lab.make("coulomb", rims=(0.05, 0.08))
    u, time = lab.smooth_path(bearing, 4, 300)
    for features, without in (
        (Features(interface=False), bearing.as_dcfp()),
        (Features(rims=False), lab.make("no_rims")),
        (Features(velocity_dependence=False), bearing),
    ):
        a = lab.walk(bearing, u, time, features=features).resisting
        assert_array_equal(a, lab.walk(without, u, time).resisting)


def test_without_vertical_coupling_the_lateral_force_is_that_under_a_held_load(
    lab: SimpleNamespace,
) -> None:
    """A testing rig that holds the vertical load, rims and slip included, gives the same force."""
    load = 3e5
    bearing = lab.make(
        "coulomb",
        radius=1.0,
        friction=CoulombFriction(0.05),
        design_load=load,
        rims=(0.08, 0.08),
        axial_stiffness=1e10,
        rim_stiffness=1e8,
    )
    x = np.interp(np.linspace(0.0, 3.0, 601), np.arange(4), [0.0, 0.19, -0.19, 0.1])
    rig = cyclic_test(bearing, x, load)
    assert float(rig["interface_slip_size"].max()) > 5e-3
    u = np.zeros((len(x), 12))
    u[:, 6] = x
    u[:, 8] = 0.03 * np.sin(np.arange(len(x)))  # whatever the height
    features = Features(vertical_coupling=False)
    mine = lab.walk(bearing, u, rig["time"].to_numpy(), features=features).resisting[:, 6]
    force = rig["bearing_force"].sel(axis="x").isel(bearing=0).to_numpy()
    # The rig holds the load in a contact of finite stiffness, 2e-5 of the length: steps on stiff
    # branches (reversal, first contact with a rim) differ by some per cent of their change.
    gap = np.sort(np.abs(mine - force)) / np.abs(force).max()
    assert gap[int(0.98 * len(gap))] < 1e-4
    assert gap[-1] < 0.03
