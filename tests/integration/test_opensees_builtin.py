"""The plain bearing as elements of OpenSees: mapping, refusals, and short histories in both."""

import math
from collections.abc import Iterator
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from frames import GroundMotion, lumped_mass, time_history
from lir_element import CoulombFriction, LIRBearing, VelocityFriction
from tests.refusals import refused
from tests.scenes import plain_pendulum

pytest.importorskip("openseespy")

from lir_element.opensees import (
    BUILTIN_KINDS,
    builtin_commands,
    builtin_element,
    builtin_values,
    opensees,
)
from validation.opensees.model import (
    gravity_analysis,
    lead,
    solver,
    stand,
    static_steps,
    transient_steps,
    weigh_down,
)
from validation.opensees.runs import cycle, lumped

LOAD = 500e3
MASS = LOAD / 9.80665


plain = partial(plain_pendulum, friction=0.057, design_load=LOAD)


@pytest.fixture
def ops() -> Iterator[Any]:
    with stand(0.1, held=(0, 1)) as commands:
        yield commands


def loop(kind: str, bearing: LIRBearing, reach: float, steps: int = 200) -> np.ndarray:
    turns = [0.0, reach, -reach, reach]
    pieces = [np.linspace(a, b, steps + 1)[1:] for a, b in pairwise(turns)]
    path = np.concatenate([[0.0], *pieces])

    def place(tag: int, i: int, j: int) -> None:
        builtin_element(kind, tag, i, j, bearing, LOAD)

    track = cycle(place, bearing.height, LOAD, path)
    assert opensees().getNodeTags() in (None, [])  # the model is left empty
    return np.column_stack([path, track.force[:, 0]])


def weigh(ops: Any) -> None:
    weigh_down(ops, LOAD)
    gravity_analysis(ops)


def test_values_of_unlike_surfaces() -> None:
    laws = (CoulombFriction(0.03), CoulombFriction(0.09))
    values = builtin_values(plain(radius=(1.2, 0.8), friction=laws), LOAD)
    assert values.length == pytest.approx(1.9)
    assert values.friction_max == pytest.approx((0.03 * 1.2 + 0.09 * 0.8) / 1.9)
    before = LOAD * (0.03 * 1.2**2 + 0.09 * 0.8**2) / 1.9**2 / 0.25e-3
    assert values.initial_stiffness == pytest.approx(before + LOAD / 1.9)


def test_values_with_speed() -> None:
    law = VelocityFriction(f_max=0.06, f_min=0.03, rate=20.0)
    values = builtin_values(plain(friction=law), LOAD)
    assert values.rate == pytest.approx(20.0 / 1.9)
    assert values.friction_min == pytest.approx(0.03 * 2.0 / 1.9)
    assert values.yield_displacement == pytest.approx(0.25e-3 * 1.9)


LAWS = {
    "singleFPBearing": lambda s, m: (s + m) / (1.0 - s * (s + m)),
    "FPBearingPTV": lambda s, m: s / math.sqrt(1.0 - s**2) + m,
    "TripleFrictionPendulum": lambda s, m: s + m,
}


@pytest.mark.parametrize("kind", LAWS)
def test_strength_and_force_at_amplitude(kind: str) -> None:
    found = loop(kind, plain(), 0.2)
    s, m = 0.2 / 1.9, 0.06
    assert found[200, 1] == pytest.approx(LOAD * LAWS[kind](s, m), rel=1e-6)
    out = np.interp(0.0, found[401:, 0], found[401:, 1])
    assert out == pytest.approx(LOAD * m, rel=1e-4)


def test_tfp_slides_as_the_rigid_slider_with_unlike_surfaces() -> None:
    laws = (CoulombFriction(0.003), CoulombFriction(0.009))
    bearing = plain(radius=(1.2, 0.8), friction=laws, yield_displacement=0.1e-3)
    found = loop("TFP", bearing, 0.02, 5000)
    expected = LOAD * (0.02 / 1.9 + (0.003 * 1.2 + 0.009 * 0.8) / 1.9)
    assert found[5000, 1] == pytest.approx(expected, rel=0.01)


def test_rims_are_met_at_the_capacity() -> None:
    found = loop("TripleFrictionPendulum", plain(capacity=0.15), 0.16, 800)
    slope = np.diff(found[:801, 1]) / np.diff(found[:801, 0])
    begin = np.searchsorted(found[:801, 0], 0.01)
    stiff = begin + int(np.argmax(slope[begin:] > 5.0 * LOAD / 1.9))
    assert found[stiff, 0] == pytest.approx(0.15, abs=1e-3)


@pytest.mark.parametrize("frequency", [0.05, 1.0])  # Hz
@pytest.mark.parametrize("kind", ["singleFPBearing", "FPBearingPTV"])
def test_friction_at_two_speeds(ops: Any, kind: str, frequency: float) -> None:
    """A stiff actuator moves the node; at the centre the force is friction at a known speed."""
    bearing = plain(friction=VelocityFriction(f_max=0.06, f_min=0.03, rate=8.0))
    ops.mass(2, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0)
    builtin_element(kind, 1, 1, 2, bearing, LOAD)
    weigh(ops)
    ops.node(3, 0.0, 0.0, 0.1)  # the actuator
    ops.fix(3, *[1] * 6)
    stiffness, reach, dt = 1e11, 0.05, 0.002 / frequency
    ops.uniaxialMaterial("Elastic", 1, stiffness)
    ops.element("zeroLength", 2, 3, 2, "-mat", 1, "-dir", 1)
    times = np.arange(0.0, 1.0 / frequency, dt)
    wanted = 0.5 * reach * (1.0 - np.cos(2.0 * np.pi * frequency * times))
    ops.timeSeries("Path", 2, "-dt", dt, "-values", *(stiffness * wanted).tolist())
    ops.pattern("Plain", 2, 2)
    ops.load(2, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    solver(ops, 1e-10)
    transient_steps(ops)
    assert ops.analyze(len(times) // 4, dt) == 0
    u, speed = ops.nodeDisp(2, 1), ops.nodeVel(2, 1)
    assert speed == pytest.approx(np.pi * frequency * reach, rel=0.02)
    on_surface = speed / 1.9  # R / L of the bearing's
    m = bearing.frictions[0].at_speed(on_surface) * 2.0 / 1.9
    force = ops.eleResponse(1, "force")[6]
    assert force == pytest.approx(LOAD * LAWS[kind](u / 1.9, m), rel=5e-3)


@pytest.mark.parametrize(
    ("kind", "bearing", "message"),
    [
        ("singleFPBearing", plain(interface_friction=0.2, capacity=0.2), "as_dcfp"),
        ("singleFPBearing", plain(capacity=0.2), r"capacity = 0.2 m.*rims=False"),
        ("FPBearingPTV", plain(capacity=0.2), "does not model rims"),
        ("TFP", plain(capacity=0.2), "choose TripleFrictionPendulum"),
        ("TFP", plain(friction=VelocityFriction(0.06, 0.03, 20.0)), "constant friction"),
        ("TripleFrictionPendulum", plain(friction=VelocityFriction(0.06, 0.03, 20.0)), "Coulomb"),
        ("FPBearingPTV", plain(friction=VelocityFriction(0.06, 0.02, 20.0)), "always uses 0.5"),
        ("singleFPBearing", plain(friction=CoulombFriction(0.0)), "need a positive one"),
        ("singleFPBearing", plain(friction_law="bouc-wen"), "elastic-plastic"),
        ("singleFPBearing", plain(yield_displacement=0.02), "reduce yield_displacement"),
        (
            "singleFPBearing",
            plain(radius=(1.2, 0.8), friction=VelocityFriction(0.06, 0.03, 20.0)),
            "equal rate \\* radius",
        ),
        ("flatSliderBearing", plain(), "choose one of"),
    ],
)
def test_refusals(kind: str, bearing: LIRBearing, message: str) -> None:
    refused(ValueError, message, builtin_commands, kind, 1, 1, 2, bearing, LOAD)


def test_unlike_radii_with_like_rates_over_the_bearing() -> None:
    laws = (VelocityFriction(0.06, 0.03, 10.0), VelocityFriction(0.06, 0.03, 15.0))
    values = builtin_values(plain(radius=(1.2, 0.8), friction=laws), LOAD)
    assert values.rate == pytest.approx(12.0 / 1.9)


def test_lift_is_for_one_element_alone() -> None:
    refused(ValueError, "lift = True", builtin_commands, "TFP", 1, 1, 2, plain(), LOAD, lift=True)
    last = builtin_commands("singleFPBearing", 1, 1, 2, plain(), LOAD, lift=True)[-1]
    assert "-inclVertdisp" in last


def test_nodes_and_tags_are_checked(ops: Any) -> None:
    with pytest.raises(ValueError, match="node 7 of element 1 does not exist"):
        builtin_element("TFP", 1, 1, 7, plain())
    ops.node(3, 0.0, 0.0, 0.5)
    refused(ValueError, r"0\.5 m above node 1", builtin_element, "TFP", 1, 1, 3, plain())
    builtin_element("singleFPBearing", 1, 1, 2, plain(), first_tag=50)
    refused(ValueError, "tag 1 is taken", builtin_element, "singleFPBearing", 1, 1, 2, plain())
    with pytest.raises(ValueError, match="another first_tag"):
        builtin_element("singleFPBearing", 2, 1, 2, plain(), first_tag=50)


def test_model_of_the_wrong_size_is_refused() -> None:
    commands = opensees()
    commands.wipe()
    commands.model("basic", "-ndm", 2, "-ndf", 3)
    commands.node(1, 0.0, 0.0)
    commands.node(2, 0.0, 0.0)
    with pytest.raises(ValueError, match=r"needs 3 and 6.* for a plane model use bearing_element"):
        builtin_element("singleFPBearing", 1, 1, 2, plain())
    commands.wipe()


def test_millimetres_and_tags_of_numpy(ops: Any) -> None:
    ops.node(3, 0.0, 0.0, 1e3 * plain().height)
    with pytest.raises(ValueError, match="units other than m and N use bearing_el"):
        builtin_element("singleFPBearing", 1, 1, 3, plain())
    numbers = np.arange(8)
    builtin_element("singleFPBearing", numbers[5], numbers[1], numbers[2], plain())
    assert list(ops.getEleTags()) == [5]
    with pytest.raises(TypeError, match=r"tag = 1\.5 must be an integer tag"):
        builtin_element("singleFPBearing", 1.5, 1, 2, plain())  # type: ignore[arg-type]


def test_shear_acts_at_half_height(ops: Any) -> None:
    """The option is not swallowed: the moment above is half the shear times the height."""
    bearing = plain()
    path = np.linspace(0.0, 0.05, 101)
    builtin_element("singleFPBearing", 1, 1, 2, bearing, LOAD)
    weigh(ops)
    lead(ops, 2, 1, path)
    solver(ops)
    static_steps(ops, 1.0)
    assert ops.analyze(len(path) - 1) == 0
    force = ops.eleResponse(1, "force")
    assert force[10] == pytest.approx(-0.5 * force[6] * bearing.height, rel=1e-9)
    assert force[4] == pytest.approx(force[10] - LOAD * 0.05, rel=1e-9)  # N U on node i alone


def small_motion() -> GroundMotion:
    t = np.arange(0.0, 6.0, 0.005)
    bell = np.sin(np.pi * np.minimum(t / 4.0, 1.0))
    x = 0.15 * bell * np.sin(2.0 * np.pi * t / 1.6)
    y = 0.10 * bell * np.sin(2.0 * np.pi * t / 1.1)
    return GroundMotion(x=x, y=y, z=2.0 * bell * np.sin(2.0 * np.pi * t / 0.7), dt=0.005)


@pytest.mark.parametrize("kind", [k for k in BUILTIN_KINDS if k != "TFP"])
def test_small_motions_agree(kind: str) -> None:
    """Friction and motion so small that laws of large displacement are alike; N varies."""
    bearing = plain(friction=CoulombFriction(0.006), yield_displacement=0.02e-3)
    motion = small_motion()
    ours = time_history(lumped_mass(bearing, MASS), motion, dt=0.0025)
    moved = ours["bearing_displacement"].isel(bearing=0).to_numpy()

    def place(tag: int, i: int, j: int) -> None:
        builtin_element(kind, tag, i, j, bearing, LOAD)

    track = lumped(place, bearing.height, MASS, motion, 0.0025)
    away = np.hypot(*(moved - track.displacement)[:, :2].T).max()
    peak = np.hypot(*moved[:, :2].T).max()
    assert peak > 5e-3
    assert away < 0.01 * peak
