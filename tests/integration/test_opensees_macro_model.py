"""The macro-model of OpenSees elements: closed forms, refusals, and what it cannot do."""

import math
from functools import partial

import numpy as np
import pytest

from tests.scenes import small_bearing as bearing

pytest.importorskip("openseespy")

from frames import GroundMotion
from lir_element import DesignWarning, VelocityFriction
from lir_element.opensees import macro_model, opensees
from lir_element.units import STANDARD_GRAVITY
from tests.patience import patience
from validation.claims import static_test
from validation.claims.opensees_macro_model import (
    element_force,
    loops,
    pendulum_force,
    series_with_mu_h,
    static_checks,
)
from validation.claims.opensees_macro_runs import Loop
from validation.measurements.hard_scenes import impact
from validation.measurements.opensees_hard_cases import cases, energies, kinds
from validation.opensees.model import ABOVE, BELOW, stand
from validation.opensees.trials import (
    DEVICES,
    load_down,
    macro,
    pull,
    shake,
)
from validation.opensees.worker import Worker
from validation.scenes import MASS, static_path

LOAD = 150e3
REACH = 0.185
STEP = 2e-4


def outwards_and_back(device=macro, own=None):
    """Pull to 185 mm and back through zero."""
    way = np.concatenate([np.arange(0.0, REACH, STEP), np.arange(REACH, -0.01, -STEP)])
    done = pull(device, own or bearing(), LOAD, way)
    assert done.status == "ok"
    u = done.displacement[:, 0]
    return Loop("", u, done.force[:, 0] / LOAD, u - done.middle[:, 0])


@pytest.fixture(scope="module")
def loop():
    return outwards_and_back()


def back_at_zero(one):
    """Return force and slip at zero displacement on the way back."""
    turn = int(np.argmax(one.displacement))
    place = turn + int(np.argmin(np.abs(one.displacement[turn:])))
    return one.force[place], one.slip[place]


def test_slides_as_a_pendulum_before_the_rims(loop):
    for u in (0.05, 0.1, 0.17):
        place = int(np.argmin(np.abs(loop.displacement[: round(REACH / STEP)] - u)))
        assert loop.force[place] == pytest.approx(pendulum_force(bearing(), u), rel=4e-3)
        assert loop.force[place] == pytest.approx(element_force(bearing(), u), rel=0.015)


def test_slips_first_where_the_bearing_does(loop):
    first = loop.first()
    assert loop.displacement[first] == pytest.approx(0.175, rel=5e-3)
    assert loop.force.max() == pytest.approx(bearing().force_limit(1.0), rel=1e-3)
    assert loop.slip[int(np.argmax(loop.displacement))] == pytest.approx(0.01, rel=0.02)


def test_restoring_force_is_centred_on_the_slip(loop):
    """The disagreement: the bearing's is centred on zero."""
    own = bearing()
    force, slip = back_at_zero(loop)
    assert force == pytest.approx(-own.effective_friction - slip / own.effective_radius, rel=3e-3)
    assert abs(force + own.effective_friction) > 0.08 * own.effective_friction


def test_all_statements_on_the_static_test_hold():
    half = static_path()[: 3 * round(static_test.REACH / static_test.STEP)]
    checks = static_checks(loops(half))
    assert len(checks) == 8
    assert not [check for check in checks if not check.holds]


def test_springs_across_centre_it_but_let_the_force_grow():
    own = bearing()
    one = outwards_and_back(partial(macro, restoring="across"))
    force, _ = back_at_zero(one)
    assert force == pytest.approx(-own.effective_friction, rel=5e-3)
    beyond = (REACH - own.lateral_capacity) / own.effective_radius
    assert one.force.max() - own.force_limit(1.0) == pytest.approx(beyond, rel=0.05)


def test_with_mu_h_itself_the_interface_slips_too_early():
    own = bearing()
    way = np.arange(0.0, 0.1, STEP)
    done = pull(series_with_mu_h, own, LOAD, way)
    slip = (done.displacement - done.middle)[:, 0]
    first = done.displacement[int(np.argmax(slip > 5e-4)), 0]
    early = own.effective_radius * (own.interface_friction - own.effective_friction)
    assert first == pytest.approx(early, rel=0.03)
    assert first < 0.5 * own.lateral_capacity


@pytest.mark.parametrize("directions", [8, 16])
def test_rims_are_a_polygon(directions):
    own, corner = bearing(), math.pi / directions
    reach = np.arange(0.0, 1.1 * own.lateral_capacity, STEP)
    way = reach[:, None] * np.array([math.cos(corner), math.sin(corner)])
    done = pull(partial(macro, directions=directions), own, LOAD, way)
    slip = np.linalg.norm((done.displacement - done.middle)[:, :2], axis=1)
    first = np.linalg.norm(done.displacement[int(np.argmax(slip > 5e-4)), :2])
    assert first == pytest.approx(own.lateral_capacity / math.cos(corner), rel=6e-3)


@pytest.fixture
def ops():
    with stand(bearing().height) as commands:
        yield commands


@pytest.mark.usefixtures("ops")
def test_one_piece_has_no_interface_and_no_rims_no_gaps():
    made = macro_model(bearing().as_dcfp(rims=False), BELOW, ABOVE, load=LOAD)
    assert made.node is None
    assert made.interface is None
    assert made.rims == ()
    assert load_down(LOAD) == 0


def test_friction_of_unlike_surfaces_at_speed():
    """Force over load of both surfaces at rest and at speed, at the speed of the bearing."""
    laws = (VelocityFriction(0.06, 0.03, 20.0), VelocityFriction(0.10, 0.05, 40.0))
    own = bearing(friction=laws, radius=(0.9, 0.6), interface_friction=0.2)
    length = own.effective_radius
    push = GroundMotion(x=np.full(100, -0.9), dt=0.01)
    done = shake(macro, own, LOAD / STANDARD_GRAVITY, push, duration=0.2, dt=5e-4)
    assert done.status == "ok"
    u, v = done.displacement[-1, 0], done.velocity[-1, 0]
    expected = sum(
        law.at_speed(v * r / length) * r / length for law, r in zip(laws, own.radii, strict=True)
    )
    assert own.effective_friction > 1.05 * expected
    assert done.force[-1, 0] / LOAD - u / length == pytest.approx(expected, rel=0.02)


def test_tags_begin_where_asked_and_do_not_collide(ops):
    first = macro_model(bearing(), BELOW, ABOVE, load=LOAD, first_tag=500)
    assert first.node is not None
    assert min(*first.materials, *first.frictions, first.node, first.pendulum) == 500
    ops.node(20, 3.0, 0.0, 0.0)
    ops.node(21, 3.0, 0.0, 0.1)
    second = macro_model(bearing(), 20, 21, load=LOAD)
    third = macro_model(bearing(), 20, 21, load=LOAD)
    assert not set(second.materials) & set(third.materials)
    assert {first.interface, second.interface, third.interface} <= set(ops.getEleTags())


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"load": 0.0}, "load = 0"),
        ({"directions": 6}, "directions = 6"),
        ({"restoring": "both"}, "restoring = 'both'"),
        ({"middle_mass": -1.0}, "middle_mass = -1"),
        ({"first_tag": 0}, "first_tag = 0"),
        ({"node_j": 77}, "node_j = 77 is not a node"),
        ({"node_i": ABOVE, "node_j": BELOW}, "node j must be above"),
    ],
)
def test_refuses_what_cannot_be_and_leaves_the_model_alone(ops, changes, message):
    options = {"bearing": bearing(), "node_i": BELOW, "node_j": ABOVE, "load": LOAD} | changes
    with pytest.raises(ValueError, match=message):
        macro_model(**options)
    assert not ops.getEleTags()
    assert sorted(ops.getNodeTags()) == [BELOW, ABOVE]


@pytest.mark.usefixtures("ops")
def test_refuses_a_weak_interface():
    with pytest.warns(DesignWarning):
        weak = bearing(interface_friction=0.068)
    with pytest.raises(ValueError, match=r"interface_friction = 0\.068"):
        macro_model(weak, BELOW, ABOVE, load=LOAD)


def test_refuses_nodes_of_three_degrees_of_freedom():
    ops = opensees()
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 3)
    ops.node(1, 0.0, 0.0, 0.0)
    ops.node(2, 0.0, 0.0, 0.1)
    with pytest.raises(ValueError, match="has 3 degrees of freedom"):
        macro_model(bearing(), 1, 2, load=LOAD)


@pytest.fixture(scope="module")
def worker():
    with Worker(limit=30.0) as started:
        yield started


def test_balance_and_energy_of_an_impact(worker):
    case = impact(0.3, oblique=False)
    kind = kinds()[0]
    _, done = worker.run(
        shake,
        make=DEVICES["singleFPBearing"],
        bearing=kind.bearing,
        mass=MASS,
        motion=case.motion,
        duration=2.0,
        dt=5e-3,
    )
    gap, made = energies(done, case.motion, kind.bearing)
    assert gap < 1e-4
    assert made < 1e-2
    done.force[:, 0] *= -1.0
    gap, made = energies(done, case.motion, kind.bearing)
    assert gap > 0.1
    assert made > 0.1


def crash():
    """End the process as a wrong call does."""
    import os

    os.abort()


def sleep():
    """Hang."""
    import time

    time.sleep(1e5)  # the worker is killed


def test_crashes_and_hangs_are_results():
    with Worker(limit=patience()) as started:
        assert started.run(crash)[0].startswith("crash")
        started.limit = 0.5
        assert started.run(sleep) == ("hang", None)


def test_all_cases_have_motions():
    assert len({case.name for case in cases()}) == len(cases()) >= 10
    assert all(case.motion.components.any() for case in cases())
