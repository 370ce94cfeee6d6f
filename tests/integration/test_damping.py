"""Damping: the given ratio in the structure, nothing of it in the isolation."""

import math
from functools import partial

import numpy as np
import pytest
from numpy.testing import assert_allclose

from frames import (
    Frame,
    GroundMotion,
    ModalDamping,
    RayleighDamping,
    Section,
    gravity,
    shear_building,
)
from tests.scenes import plain_pendulum

# Friction that holds whatever comes, on purpose.
pytestmark = [pytest.mark.meant("friction of 0.9", "the bearings hardly slide")]

MASS = 1e5
DT = 0.002


# Friction so high and stiff that small motions find it rigid.
held_bearing = partial(plain_pendulum, friction=0.9, yield_displacement=1e-7)


frictionless_bearing = partial(plain_pendulum, friction=0.0, axial_damping=0.0)


def stiffness(period: float) -> float:
    return MASS * (2.0 * math.pi / period) ** 2


def measured_ratio(run, damping, period: float, axis: str) -> float:
    """Return the damping ratio of free vibration after a pulse, from its peaks."""
    frame = shear_building(
        held_bearing(), MASS, stiffness(period), damping=damping, base_mass=5.0 * MASS
    )
    cycles = 12.0
    wave = np.zeros(round(cycles * period / DT))
    first = round(0.5 * period / DT)
    wave[:first] = 0.3 * np.sin(np.pi * np.arange(first) / first)
    data = run(frame, GroundMotion(**{axis: wave}, dt=DT), dt=DT)
    u = data["node_displacement"].sel(node="floor-1", dof=f"u{axis}").to_numpy()
    base = data["node_displacement"].sel(node="base", dof=f"u{axis}").to_numpy()
    assert np.abs(base).max() < 1e-3 * np.abs(u).max()  # held
    u = (u - base)[first:]
    size = np.abs(u)
    at = np.flatnonzero((size[1:-1] > size[:-2]) & (size[1:-1] >= size[2:])) + 1
    before, here, after = size[at - 1], size[at], size[at + 1]
    peaks = here + (after - before) ** 2 / (8.0 * (2.0 * here - before - after))
    slope = np.polyfit(np.arange(len(peaks)), np.log(peaks), 1)[0]  # each half cycle
    return -slope / math.hypot(math.pi, slope)


@pytest.mark.parametrize("axis", ["x", "y"])
@pytest.mark.parametrize("ratio", [0.02, 0.1])
def test_modal_damping_decays_with_the_given_ratio(run, ratio, axis):
    got = measured_ratio(run, ModalDamping(ratio), 0.4, axis)
    assert_allclose(got, ratio, rtol=5e-3)  # 200 steps a cycle; the base moves by 1e-3


@pytest.mark.parametrize("period", [0.5, 0.25, 0.1])
def test_rayleigh_damping_at_and_between_its_periods(run, period):
    ratio, t_1, t_2 = 0.05, 0.5, 0.1
    w_1, w_2, w = (2.0 * math.pi / t for t in (t_1, t_2, period))
    expected = ratio / (w_1 + w_2) * (w_1 * w_2 / w + w)
    got = measured_ratio(run, RayleighDamping(ratio, (t_1, t_2)), period, "x")
    if period in {t_1, t_2}:
        assert_allclose(expected, ratio, rtol=1e-12)  # round-off
    # the step shortens a period of 0.1 s by 0.1 %; the base moves by 1e-3
    assert_allclose(got, expected, rtol=1e-2)


def test_without_damping_the_structure_vibrates_on(run):
    assert abs(measured_ratio(run, None, 0.4, "x")) < 2e-5


def test_ratios_of_first_modes_and_the_last_for_all_further_ones():
    frame = shear_building(
        held_bearing(), MASS, stiffness(0.3), storeys=3, damping=ModalDamping((0.01, 0.03, 0.07))
    )
    basis = gravity(frame).basis
    ratios = basis.damping_e / (2.0 * np.sqrt(basis.omega2))
    assert_allclose(ratios, [0.01, 0.03] + [0.07] * (len(ratios) - 2), rtol=1e-12)  # round-off
    assert (np.diff(basis.omega2) >= -1e-9 * basis.omega2[1:]).all()


@pytest.mark.parametrize(
    "damping", [ModalDamping(0.2), RayleighDamping(0.2, (0.1, 0.05))], ids=["modal", "rayleigh"]
)
def test_isolation_is_not_damped(run, pulse, damping):
    frame = shear_building(
        frictionless_bearing(), MASS, 4.0 * stiffness(0.1), storeys=2, damping=damping
    )
    wave = pulse(2.0, 1.5, 0.005, cycles=1.0, rest=0.0)
    duration = 25.0
    data = run(frame, GroundMotion(x=wave, dt=0.005), dt=0.005, duration=duration)
    energy = data["energy"]
    supplied = float(np.abs(energy.sel(term="input")).max())
    assert float(energy.sel(term="damping").max()) < 1e-3 * supplied
    u = np.abs(data["bearing_displacement"].sel(axis="x")[:, 0].to_numpy()[len(wave) :])
    at = np.flatnonzero((u[1:-1] > u[:-2]) & (u[1:-1] >= u[2:])) + 1
    peaks = u[at]
    assert len(peaks) >= 15
    assert_allclose(peaks[-3:], peaks[0], rtol=1e-3)  # a peak between samples: (pi dt / T)^2
    # damping by the whole mass, as in C = alpha M, would have ended the motion
    w_1, w_2 = 2.0 * math.pi / 0.1, 2.0 * math.pi / 0.05
    alpha = 2.0 * 0.2 * w_1 * w_2 / (w_1 + w_2)
    assert math.exp(-0.5 * alpha * duration) < 1e-3


def test_rayleigh_damping_of_the_base_itself():
    """A beam from bearing to bearing has no other freedom: beta K damps its bending alone."""
    frame = Frame("beam")
    bearing = frictionless_bearing()
    for k, x in enumerate((0.0, 6.0)):
        frame.add_node(f"g{k}", x, 0.0, 0.0)
        frame.fix(f"g{k}", "all")
        frame.add_node(f"b{k}", x, 0.0, bearing.height)
        frame.fix(f"b{k}", "rx")
        frame.add_mass(f"b{k}", MASS)
        frame.add_bearing(f"B{k}", f"g{k}", f"b{k}", bearing)
    frame.add_member("beam", "b0", "b1", Section.box(0.5, 0.5, 0.02, density=0.0))
    frame.set_damping(RayleighDamping(0.05, (0.5, 0.1)))
    state = gravity(frame)
    basis, system = state.basis, state.system
    beta = 2.0 * 0.05 / (2.0 * math.pi * (1.0 / 0.5 + 1.0 / 0.1))
    order = basis.bearing_dofs
    expected = beta * system.stiffness.toarray()[np.ix_(order, order)]
    largest = np.abs(expected).max()
    assert_allclose(basis.damping_b, expected, rtol=0.0, atol=1e-12 * largest)  # round-off
    along = np.array([system.dof_labels[k].endswith("ux") for k in order], dtype=float)
    assert_allclose(basis.damping_b @ along, 0.0, rtol=0.0, atol=1e-9 * largest)
