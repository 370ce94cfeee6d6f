"""Masses that are next to nothing, as scripts give them to rotations: they must change nothing."""

import importlib.util
import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from frames import Frame, GroundMotion, Section, gravity, modes
from frames.assembly.natural_modes import UnstableError, natural_modes
from tests.scenes import simple_bearing
from validation.opensees.isolators import waves
from validation.opensees.model import gravity_analysis

G = 9.80665
USUAL = 2e4  # kg m2: a node's mass at a lever of a metre
SHARES = (0.0, 1e-16, 1e-14, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-2)
DEVICE = simple_bearing(capacity=0.3, interface_friction=0.12, axial_stiffness=1e9)
MAST = Section(0.02, 1e-4, 1e-4, 2e-4, 2e11, 8e10, density=0.0)
TOP, HEIGHT = 2e4, 4.0  # kg, m


def mast(inertia: float, pieces: int = 1) -> Frame:
    """A mass on a post whose foot is held upright, on a bearing."""
    frame = Frame("mast")
    frame.add_node("ground", 0.0, 0.0, -DEVICE.height)
    frame.fix("ground", "all")
    names = [f"n{k}" for k in range(pieces + 1)]
    for k, name in enumerate(names):
        frame.add_node(name, 0.0, 0.0, HEIGHT * k / pieces)
        frame.add_mass(name, 1e4 if k == 0 else 0.0, (inertia,) * 3)
        if k:
            frame.add_member(f"m{k}", names[k - 1], name, MAST)
    frame.fix("n0", "rx", "ry", "rz")
    frame.add_mass(names[-1], TOP)
    frame.add_bearing("b", "ground", "n0", DEVICE)
    return frame


def lowest(inertia: float) -> float:
    """Squared circular frequency of a mass with rotary inertia on a loaded cantilever."""
    bending = MAST.elastic_modulus * MAST.inertia_y
    load, h = TOP * G, HEIGHT
    elastic = bending * np.array([[12 / h**3, -6 / h**2], [-6 / h**2, 4 / h]])
    geometric = -load / 30.0 * np.array([[36 / h, -3.0], [-3.0, 4 * h]])
    flexible = np.linalg.inv(elastic + geometric) @ np.diag([TOP, inertia])
    half = 0.5 * np.trace(flexible)
    return 1.0 / (half + math.sqrt(half**2 - np.linalg.det(flexible)))


@pytest.mark.parametrize("share", SHARES)
def test_a_cantilever_has_its_closed_form(share):
    frame = mast(share * USUAL)
    omega2 = gravity(frame).basis.omega2
    assert_allclose(omega2[:2], lowest(share * USUAL), rtol=1e-9)
    found = modes(frame, 4, "fixed")
    # "fixed" is a thousand times the bearing's stiffness, not rigid
    assert_allclose((2 * np.pi / found.periods[:2]) ** 2, lowest(share * USUAL), rtol=1e-5)
    assert_allclose(modes(frame, 2).periods, modes(mast(0.0), 2).periods, rtol=1e-3)


@pytest.mark.parametrize("share", [1e-16, 1e-10])
def test_a_history_does_not_see_them(run, share):
    t = np.arange(0.0, 2.0, 0.01)
    motion = GroundMotion(x=2.0 * np.sin(5.0 * t), y=1.0 * np.cos(9.0 * t) - 1.0, dt=0.01)
    expected, found = (
        run(mast(share_ * USUAL, pieces=5), motion, dt=0.01) for share_ in (0.0, share)
    )
    for name in ("node_displacement", "bearing_force", "energy"):
        size = float(np.abs(expected[name]).max())
        assert_allclose(found[name], expected[name], rtol=0.0, atol=1e-7 * size)


@pytest.mark.skipif(
    importlib.util.find_spec("openseespy") is None, reason="openseespy is not installed"
)
@pytest.mark.parametrize("share", SHARES)
def test_a_model_of_opensees_keeps_its_periods(ops, share):
    frame, expected = taken(ops, share)
    state = gravity(frame)
    assert_allclose(2.0 * np.pi / np.sqrt(state.basis.omega2[:3]), expected, rtol=1e-6)
    again = modes(frame, 3, "fixed").periods
    assert_allclose(again, expected, rtol=1e-3)  # on stiff springs


@pytest.mark.skipif(
    importlib.util.find_spec("openseespy") is None, reason="openseespy is not installed"
)
def test_a_model_of_opensees_moves_alike(ops, run):
    motion = waves(0.6, 2.0)
    kept, expected = (
        run(taken(ops, share)[0], motion, dt=0.01, duration=2.0) for share in (1e-12, 0.0)
    )
    for name in ("node_displacement", "bearing_displacement", "bearing_force"):
        size = float(np.abs(expected[name]).max())
        assert_allclose(kept[name], expected[name], rtol=0.0, atol=1e-6 * size)


def taken(ops, share: float) -> tuple[Frame, np.ndarray]:
    """A plane frame of two storeys in OpenSees, damped by stiffness; and its periods there."""
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    ops.geomTransf("PDelta", 1)
    for k in range(3):
        for i in range(2):
            tag = 10 * k + i + 1
            ops.node(tag, 6.0 * i, 3.5 * k)
            ops.mass(tag, 2e4, 2e4, share * USUAL)
            if k:
                ops.element("elasticBeamColumn", tag, tag - 10, tag, 0.02, 2e11, 2e-4, 1)
        if k:
            ops.element("elasticBeamColumn", 100 + k, 10 * k + 1, 10 * k + 2, 0.02, 2e11, 2e-4, 1)
    for tag in (1, 2):
        ops.fix(tag, 1, 1, 1)
    ops.rayleigh(0.0, 0.0, 0.002, 0.0)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    for tag in (11, 12, 21, 22):
        ops.load(tag, 0.0, -2e4 * G, 0.0)
    gravity_analysis(ops)
    return Frame.from_opensees([1, 2], DEVICE), 2.0 * np.pi / np.sqrt(ops.eigen(3))


def test_modes_span_fifteen_orders_of_mass():
    """A chain of masses over springs: orthonormal, and all of its frequencies."""
    rng = np.random.default_rng(3)
    size = 30
    stiffness = 10.0 ** rng.uniform(6.0, 9.0, size)
    k = np.diag(stiffness) + np.diag(np.append(stiffness[1:], 0.0))
    k -= np.diag(stiffness[1:], 1) + np.diag(stiffness[1:], -1)
    m = np.diag(10.0 ** rng.uniform(-10.0, 5.0, size))
    omega2, shapes, static = natural_modes(k, m)
    count = len(omega2)
    assert count + static.shape[1] == size
    assert static.shape[1] > 0
    assert omega2[-1] / omega2[0] > 1e6
    # ten digits, of a group that spans a million
    assert_allclose(shapes.T @ m @ shapes, np.eye(count), rtol=0.0, atol=1e-9)
    root = np.sqrt(omega2)
    assert_allclose(shapes.T @ k @ shapes / np.outer(root, root), np.eye(count), atol=1e-8, rtol=0)
    assert_allclose(static.T @ k @ static, np.eye(size - count), rtol=0.0, atol=1e-8)
    few = natural_modes(k, m, 4)
    assert_allclose(few.omega2, omega2[:4], rtol=1e-9)
    assert few.shapes.shape == (size, 4)


def test_a_stiffness_without_hold_is_named():
    k = np.array([[2.0, -1.0, 0.0], [-1.0, 2.0, 0.0], [0.0, 0.0, -1e-3]])
    with pytest.raises(UnstableError) as told:
        natural_modes(k, np.eye(3))
    assert int(np.argmax(np.abs(told.value.direction))) == 2
