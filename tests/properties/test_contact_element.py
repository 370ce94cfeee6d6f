"""Properties of the element at the level 'contact': sliders as bodies, solved inside.

Numbers are relative to the largest force, or stiffness, of the case. `lab` (conftest.py) makes the
bearings and the motions.
"""

import copy
import math
from functools import partial
from itertools import product
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation

from lir_element import AnalysisError, CoulombFriction, Element, LIRBearing, RunStatus
from lir_element.device.sliders import slider_record
from lir_element.layout import SEARCH, STATE_BY_NAME
from tests.plain import DEVICE, forces_both_ways
from tests.properties.conftest import differences
from tests.properties.conftest import walk as along

STILL = np.zeros(12)
NAMES = (
    "coulomb",
    "velocity",
    "bouc_wen_velocity",
    "fused",
    "one_rim",
    "thick_plates",
    "random-1",
    "random-2",
    "pressed_and_heated",
)
EACH = pytest.mark.parametrize("name", NAMES)
UPSIDE = 8e-4  # of N: elastic slip of 0.4 mm, as the axial force swings
pytestmark = pytest.mark.meant("slider_density")
WEIGHTLESS = {"slider_density": 1e-3}  # 8 micrograms a slider
# Newton's method stops at 1e-10 of the normal forces; carried along some hundred steps.
HISTORY = {"rtol": 0.0, "atol": 2e-8}


walk = partial(along, level="contact")


def contacts(element: Element) -> Any:
    """Return the records of the bodies and points of an element."""
    assert element._contacts is not None
    return element._contacts


def snapshot(element: Element) -> bytes:
    """Return the bits of all responses, of the forces and of the committed bodies and points."""
    parts = [np.asarray(element.response(name)).tobytes() for name in STATE_BY_NAME]
    parts += [element.resisting_force().tobytes(), committed(element)]
    return b"".join(parts)


def committed(element: Element) -> bytes:
    """Return the bits of what is committed."""
    c = contacts(element)
    parts = element._committed, c.bodies_old, c.touch_old, c.search_old
    return b"".join(part.tobytes() for part in parts)


def blocks(matrix: np.ndarray) -> np.ndarray:
    return np.kron(np.eye(4), matrix)


PRESSED = 1e-5 * np.eye(12)[8]  # m: off the corners of friction where the normal forces stay


# ------------------------------------------------------------------------------- tangent


def tangent_error(element: Element, u: np.ndarray, time: float, step: float = 4e-7) -> float | None:
    """Return the error of the tangent over its largest entry; None where a corner lies near."""
    element.set_trial(u, STILL, time)
    k = element.tangent_stiffness()
    scale = max(np.abs(k).max(), 1.0)
    coarse, fine = (differences(element, u, time, s) for s in (2.0 * step, step))
    element.set_trial(u, STILL, time)
    if np.abs(coarse - fine).max() > 1e-6 * scale:
        return None
    return float(np.abs(k - coarse).max() / scale)


@EACH
def test_tangent_along_a_motion(name: str, lab: SimpleNamespace) -> None:
    """With rate parts, static, and over 10 microseconds, where the sliders' inertia rules."""
    bearing = lab.make(name)
    u, time = lab.smooth_path(bearing, 11, 240)
    errors: list[float | None] = []
    rims = 0.0

    def visit(element: Element, k: int) -> None:
        nonlocal rims
        if k % 30 == 19:
            short = u[k - 1] + 1e-5 / (time[1] - time[0]) * (u[k] - u[k - 1])
            for place, when in ((u[k], time[k]), (u[k], time[k - 1]), (short, time[k - 1] + 1e-5)):
                errors.append(tangent_error(element, place - PRESSED, when))
            rims = max(rims, element.response("rim_force").max())
            element.set_trial(u[k], STILL, time[k])

    walk(bearing, u, time, visit=visit)
    smooth = [e for e in errors if e is not None]
    assert len(smooth) >= 0.5 * len(errors)
    # the equilibrium inside is exact to 1e-10 of N: 1e-5 N over 4e-7 m, of 1e8 N/m
    assert_allclose(smooth, 0.0, rtol=0.0, atol=2e-6)


def test_tangent_of_open_contacts(lab: SimpleNamespace) -> None:
    """Sliders in flight: nothing on the top node, on the bottom one what their inertia passes."""
    bearing = lab.make("coulomb")
    element = Element(bearing, "contact")
    u = np.zeros(12)
    u[8] = -5e-4
    element.set_trial(u, STILL, 0.0)
    element.commit()
    up = u.copy()
    up[[6, 8, 9]] = (1e-3, 0.03, 0.01)
    element.set_trial(up, STILL, 1e-3)
    assert_array_equal(element.resisting_force()[6:], STILL[6:])
    assert element.response("axial_force") == 0.0
    assert_array_equal(element.tangent_stiffness()[6:], np.zeros((6, 12)))
    error = tangent_error(element, up, 1e-3)
    assert error is not None
    assert error < 2e-6
    element.commit()
    for k in range(1, 6):
        element.set_trial(up, STILL, 1e-3 + 1e-3 * k)
        assert_array_equal(element.resisting_force()[6:], STILL[6:])
        element.commit()


def test_initial_stiffness(lab: SimpleNamespace) -> None:
    """Three interfaces in series give k_v; sideways that of the level 'pendulum'.

    Stiff contacts: soft ones let the sliders rock against each other.
    """
    for name in ("coulomb", "fused", "thick_plates"):
        bearing = lab.make(name, axial_stiffness=1e12)
        element = Element(bearing, "contact")
        before = snapshot(element)
        k = element.initial_stiffness()
        assert snapshot(element) == before
        other = Element(bearing).initial_stiffness()
        # points on spheres see the axis at up to a / R: second order, 0.8 %
        assert_allclose(k[8, 8], other[8, 8], rtol=1.2e-2, atol=0.0)
        assert_allclose(k[6, 6], other[6, 6], rtol=5e-2, atol=0.0)
        assert_allclose(k[6, 6], k[7, 7], rtol=1e-6, atol=0.0)


# ------------------------------------------------------------------------------- partial contact


def tilted(load: float, angle: float, way: float, friction: float = 0.05) -> tuple:
    """Return element, displacement, time: the top plate tilted faster than the sliders follow.

    Over a microsecond, so that they stay where they are.
    """
    bearing = LIRBearing(
        radius=(0.9, 0.9),
        slider_height=0.11,
        slider_radius=0.08,
        capacity=0.2,
        friction=CoulombFriction(friction),
        interface_friction=0.3,
        axial_stiffness=1e8,
        axial_damping=0.0,
    )
    element = Element(bearing, "contact")
    u = np.zeros(12)
    u[8] = -load / 1e8
    element.set_trial(u, STILL, 0.0)
    element.commit()
    u[9:11] = angle * math.cos(way), angle * math.sin(way)
    return element, u, 1e-6


def even_disc(radius: float) -> tuple[np.ndarray, np.ndarray]:
    """Return places (n, 2) and shares of the area (n,) of a fine quadrature over a disc."""
    nodes, weights = np.polynomial.legendre.leggauss(60)
    r = 0.5 * radius * (nodes + 1.0)
    angle = (np.arange(180) + 0.5) * math.pi / 90.0
    way = np.column_stack([np.cos(angle), np.sin(angle)])
    plan = (r[:, None, None] * way).reshape(-1, 2)
    return plan, np.repeat(weights * r / radius / 180.0, 180)


@pytest.mark.parametrize("way", [0.1, 0.6, 2.0, -1.3])
@pytest.mark.parametrize("angle", [6e-4, 1.5e-3])
def test_landing_on_an_edge(angle: float, way: float) -> None:
    """A part of the top surface opens; the rest presses as springs: force, moment, tangent.

    Expected from the places of the face alone: penetration of each into the turned sphere.
    """
    element, u, time = tilted(3e3, angle, way)
    bearing = element.bearing
    record, height = slider_record(bearing)[0], bearing.height
    start = contacts(element).bodies_old["displacement"][0, 1] + record["place"][2]
    start[2] += bearing.radii[0]  # from the bottom vertex
    element.set_trial(u, STILL, time)
    plan, share = even_disc(0.08)
    rise = np.sqrt(0.9**2 - np.sum(plan**2, axis=1)) - 0.9 + record["vertex"][1]
    places = start + np.column_stack([plan, rise])
    node = np.array([0.0, 0.0, height]) + u[6:9]
    turn = Rotation.from_rotvec(u[9:12])
    centre = node + turn.apply([0.0, 0.0, -0.9])
    rays = places - centre
    sizes = np.linalg.norm(rays, axis=1)
    pushes = np.maximum(3e8 * share * (sizes - 0.9), 0.0)
    open_ = pushes == 0.0
    assert open_.any()
    assert (~open_).any()
    normal = pushes[:, None] * rays / sizes[:, None]  # on the plate
    moment = np.cross(places - node, normal)
    force = element.resisting_force()
    f_j, m_j = -normal.sum(axis=0), -moment.sum(axis=0)
    # the sphere's centre shifts sideways by R phi, sliding meets friction: mu N at most
    assert_allclose(force[8], f_j[2], rtol=2e-3, atol=0.0)
    assert_allclose(force[6:8], f_j[:2], rtol=0.0, atol=0.06 * pushes.sum())
    arm = np.linalg.norm(m_j[:2]) / abs(f_j[2])
    assert 0.02 < arm < 0.08  # beyond the core of a disc, a / 4
    slack = 0.06 * pushes.sum() * 0.02  # friction's arm from the node: the cap's height
    assert_allclose(force[9:11], m_j[:2], rtol=0.0, atol=slack)
    # it acts against the tilt
    assert force[9:11] @ u[9:11] > 0.0
    error = tangent_error(element, u, time, 1e-7)
    assert error is not None
    assert error < 3e-6


def test_sliders_rock_under_a_tilted_plate() -> None:
    """In full contact both surfaces would slide by up to 3 mm; the sliders rock instead."""
    closure, radius = 1e-3, 0.1
    rest = 1e-7  # of the load: round-off under a way to slip of 0.1 micrometres
    for reach, elastic, tilt in product((1.0, 3.0), (1e-4, 1e-7), (1e-5, 1e-4, 3e-4, 1e-3)):
        bearing = LIRBearing(
            radius=reach,
            slider_height=0.1,
            slider_radius=radius,
            capacity=0.2,
            friction=CoulombFriction(0.08),
            interface_friction=0.2,
            yield_displacement=elastic,
            interface_yield_displacement=min(elastic, 1e-5),
            axial_stiffness=2e9,
            **WEIGHTLESS,
        )
        element, u = Element(bearing, "contact"), np.zeros(12)
        u[6], u[8], u[9] = 1e-5, -closure, tilt
        element.set_trial(u, STILL, 0.0)
        force = element.resisting_force()
        size = -force[8]
        assert_allclose(force[:3], -force[6:9], rtol=0.0, atol=rest * size)
        # edges that open carry nothing: the rest is pressed further
        assert 0.99 < size / (2e9 * closure) < 1.0 + tilt * radius / closure
        arm = u[6:9] + np.array([0.0, 0.0, bearing.height])
        whole = force[3:6] + force[9:] + np.cross(arm, force[6:9])
        assert_allclose(whole, 0.0, rtol=0.0, atol=rest * size)
        assert np.hypot(*force[6:8]) < 0.2 * size


def test_sliders_follow_a_slow_tilt() -> None:
    """The same tilt in a static trial: they turn with the sphere.

    Friction mu N on both surfaces without a lateral force: the pressure's centre lies mu R off
    the axis. Inside the core of the disc, a / 4 = 20 mm, all of it presses; beyond it a part opens.
    """
    for friction, closed in ((0.01, True), (0.05, False)):
        element, u, _ = tilted(3e3, 1.5e-3, 0.6, friction)
        element.set_trial(u, STILL, 0.0)
        arms = np.linalg.norm(contacts(element).touch_new["centre"][0], axis=1)
        assert (arms <= 0.02).all() == closed
        force = element.resisting_force()
        arm = np.linalg.norm(force[9:11]) / abs(force[8])
        assert_allclose(arm, friction * 0.9, rtol=0.25, atol=0.0)


@pytest.mark.parametrize("seed", [3, 8])
def test_tangent_while_rocking(seed: int, lab: SimpleNamespace) -> None:
    """Random tilts of both plates within 10 microseconds under light load: faces open."""
    bearing = lab.make("velocity")
    rng = np.random.default_rng(seed)
    u, time = lab.smooth_path(bearing, seed, 240, load=5e3, swing=0.1, tilt=0.002)
    element = walk(bearing, u[:40], time[:40]).element
    errors, opened = [], 0
    for _ in range(6):
        place = u[39].copy()
        place[3:6] += 2e-3 * rng.normal(size=3)
        place[9:12] += 2e-3 * rng.normal(size=3)
        place[8] = lab.vertical(bearing, place, 5e3)
        errors.append(tangent_error(element, place, time[39] + 1e-5, 1e-7))
        arms = np.linalg.norm(contacts(element).touch_new["centre"][0], axis=1)
        opened += bool((arms > 0.25 * bearing.slider_radius).any())
    assert opened >= 4
    smooth = [e for e in errors if e is not None]
    assert len(smooth) >= 4
    assert_allclose(smooth, 0.0, rtol=0.0, atol=3e-6)


# ------------------------------------------------------------------------------- discipline


@EACH
def test_trials_repeat_and_leave_the_committed_state(name: str, lab: SimpleNamespace) -> None:
    """Same trial, same bits, whatever was tried between; nothing committed is touched."""
    bearing = lab.make(name)
    u, time = lab.smooth_path(bearing, 4, 400)
    element = walk(bearing, u[:60], time[:60]).element
    kept = committed(element)
    for k, when in ((60, time[60]), (61, time[59]), (60, time[59] + 1e-5)):
        element.set_trial(u[k], STILL, when)
        first = snapshot(element), element.tangent_stiffness().tobytes()
        element.set_trial(u[k], STILL, when)
        assert (snapshot(element), element.tangent_stiffness().tobytes()) == first
        element.set_trial(u[63], STILL, time[63])
        element.set_trial(u[k], STILL, when)
        assert (snapshot(element), element.tangent_stiffness().tobytes()) == first
        assert committed(element) == kept


@EACH
def test_what_a_search_keeps_only_saves_derivatives(name: str, lab: SimpleNamespace) -> None:
    """Without it a trial finds the same state, to the tolerance of the search."""
    bearing = lab.make(name)
    u, time = lab.smooth_path(bearing, 4, 1600)
    element = walk(bearing, u[:60], time[:60]).element
    renewed, count = 0, 0
    for k in range(60, 200):
        element.set_trial(u[k], STILL, time[k])
        if contacts(element).search_new["leads"][0] > 0:
            other = copy.deepcopy(element)
            other.revert_to_last_commit()
            contacts(other).search_old[:] = np.zeros(1, dtype=SEARCH)
            other.set_trial(u[k], STILL, time[k])
            count += 1
            renewed += int(contacts(element).search_new["renewed"][0])
            load = max(element.response("axial_force"), other.response("axial_force"))
            forces, found = element.resisting_force(), other.resisting_force()
            assert_allclose(found, forces, rtol=0.0, atol=1e-8 * load)
            contacts(other).search_new["follows"] = 1  # as trials of a step of a time history
            for at in (k + 1, k):
                other.set_trial(u[at], STILL, time[k])
                other.tangent_stiffness()
            found = other.resisting_force()
            assert_allclose(found, forces, rtol=0.0, atol=1e-8 * load)
        element.commit()
    assert count > 100
    assert renewed < 0.5 * count


def test_revert_to_last_commit(lab: SimpleNamespace) -> None:
    bearing = lab.make("velocity")
    u, time = lab.smooth_path(bearing, 4, 240)
    element = walk(bearing, u[:60], time[:60]).element
    kept = snapshot(element)
    element.set_trial(u[75], STILL, time[75])
    assert snapshot(element) != kept
    element.revert_to_last_commit()
    assert snapshot(element) == kept
    tangent = element.tangent_stiffness()
    element.commit()  # nothing to accept
    assert snapshot(element) == kept
    # the tangent of a committed state is that of a static trial there
    element.set_trial(u[59], STILL, time[59])
    scale = np.abs(tangent).max()
    other = element.tangent_stiffness()
    assert_allclose(other / scale, tangent / scale, rtol=0.0, atol=0.05)
    straight = walk(bearing, u[:120], time[:120])
    for k in range(60, 120):
        element.set_trial(u[k] + 1e-4, STILL, time[k])
        element.revert_to_last_commit()
        element.set_trial(u[k], STILL, time[k])
        element.commit()
        assert_array_equal(element.resisting_force(), straight.resisting[k])


def test_revert_to_start(lab: SimpleNamespace) -> None:
    bearing = lab.make("bouc_wen_velocity")
    u, time = lab.smooth_path(bearing, 4, 240)
    element = Element(bearing, "contact")
    new = snapshot(element)
    for k in range(60):
        element.set_trial(u[k], STILL, time[k])
        element.commit()
    forces = element.resisting_force()
    element.revert_to_start()
    assert snapshot(element) == new
    for k in range(60):
        element.set_trial(u[k], STILL, time[k])
        element.commit()
    assert_array_equal(element.resisting_force(), forces)


def test_a_trial_without_a_state_leaves_nothing(lab: SimpleNamespace) -> None:
    bearing = lab.make("coulomb")
    u, time = lab.smooth_path(bearing, 4, 240)
    element = walk(bearing, u[:40], time[:40]).element
    kept = snapshot(element)
    far = u[40].copy()
    far[6] = 9.0
    for bad, status in ((far, RunStatus.SPHERE_EXCEEDED), (u[40] * np.nan, RunStatus.NOT_FINITE)):
        with pytest.raises(AnalysisError) as caught:
            element.set_trial(bad, STILL, time[40])
        assert caught.value.status is status
        assert snapshot(element) == kept
    element.set_trial(u[40], STILL, time[40])
    element.commit()
    assert_array_equal(element.resisting_force(), walk(bearing, u[:41], time[:41]).resisting[-1])


def test_limits_are_reported_at_the_commit(lab: SimpleNamespace) -> None:
    bearing = lab.make("coulomb", slip_capacity=0.01)
    element, raised = Element(bearing, "contact"), None
    for k, x in enumerate(np.linspace(0.0, 0.2, 200)):
        u = np.zeros(12)
        u[6] = x
        u[8] = lab.vertical(bearing, u, 1e5)
        element.set_trial(u, STILL, 0.01 * k)
        try:
            element.commit()
        except AnalysisError as error:
            raised = error
            break
    assert raised is not None
    assert raised.status is RunStatus.SLIP_EXCEEDED
    assert "slip_capacity 0.01 m" in str(raised)
    assert 0.01 < element.response("largest_slip") < 0.012


@pytest.mark.parametrize("level", ["rigid_body", "string", "", None])
def test_levels_of_the_element(level: str, lab: SimpleNamespace) -> None:
    with pytest.raises(ValueError, match=r"level = .*choose one of \('pendulum', 'contact'\)"):
        Element(lab.make("coulomb"), level)


# ------------------------------------------------------------------------------- equilibrium


@EACH
def test_whole_bearing_is_in_equilibrium(name: str, lab: SimpleNamespace) -> None:
    """Nodal forces sum to weight and inertia forces of the sliders; moments about node i too.

    The rate of angular momentum about node i is that of the mass centres and of the spins.
    """
    bearing = lab.make(name)
    u, time = lab.smooth_path(bearing, 31, 600, tilt=0.02, twist=0.04, swing=1.3)
    record = slider_record(bearing)[0]
    mass, place = record["mass"], record["place"] - record["place"][0]
    element = Element(bearing, "contact")
    worst = 0.0

    def momentum(body: Any, k: int) -> np.ndarray:
        q = Rotation.from_quat(body["turn"][k], scalar_first=True).as_matrix()
        return q @ (record["inertia"][k] * (q.T @ body["spin"][k]))

    for k in range(1, len(u)):
        before = contacts(element).bodies_old[0].copy()
        element.set_trial(u[k], STILL, time[k])
        element.commit()
        after = contacts(element).bodies_old[0]
        f = element.resisting_force()
        dt = time[k] - time[k - 1]
        forces, moments = f[:3] + f[6:9], f[3:6] + f[9:12]
        at_i = u[k, :3]
        moments = moments + np.cross(u[k, 6:9] + place[3] - at_i, f[6:9])
        for b in range(2):
            own = mass[b] * (after["velocity"][b] - before["velocity"][b]) / dt
            own = own + mass[b] * np.array([0.0, 0.0, 9.80665])
            assert_allclose(
                after["velocity"][b],
                (after["displacement"][b] - before["displacement"][b]) / dt,
                rtol=1e-12,
                atol=1e-15,
            )
            forces = forces - own
            moments = moments - np.cross(after["displacement"][b] + place[b + 1] - at_i, own)
            moments = moments - (momentum(after, b) - momentum(before, b)) / dt
        scale = max(np.abs(f[[2, 8]]).max(), 200.0)
        worst = max(worst, np.abs(forces).max() / scale, np.abs(moments).max() / scale)
    assert worst < 3e-9  # Newton's tolerance 1e-10 of all normal forces


@EACH
def test_sliders_without_mass_pass_on_forces_and_moments(name: str, lab: SimpleNamespace) -> None:
    bearing = lab.make(name, **WEIGHTLESS)
    u, time = lab.smooth_path(bearing, 31, 480, tilt=0.02, twist=0.04)
    r = walk(bearing, u, time)
    scale = np.abs(r.resisting[:, 8]).max()
    assert scale > 1e4
    arm = u[:, 6:9] - u[:, :3] + [0.0, 0.0, bearing.height]
    f = r.resisting
    assert_allclose((f[:, :3] + f[:, 6:9]) / scale, 0.0, rtol=0.0, atol=3e-9)
    moments = f[:, 3:6] + f[:, 9:12] + np.cross(arm, f[:, 6:9])
    assert_allclose(moments / scale, 0.0, rtol=0.0, atol=3e-9)


def test_bearing_at_rest_carries_its_sliders(lab: SimpleNamespace) -> None:
    """Static: what the bottom plate gets is what the top plate gives, plus both weights."""
    bearing = lab.make("coulomb", slider_mass=(40.0, 70.0))
    element = Element(bearing, "contact")
    u = np.zeros(12)
    u[8] = -1e-4
    element.set_trial(u, STILL, 0.0)
    f = element.resisting_force()
    assert_allclose(f[2] + f[8], 110.0 * 9.80665, rtol=1e-6, atol=0.0)
    assert_allclose(element.response("axial_force"), -f[8], rtol=1e-2, atol=0.0)


# ------------------------------------------------------------------------------- symmetries


@pytest.mark.parametrize(
    ("points", "angle"), [(None, 37.0), (8, 90.0), (4, -90.0), (5, 72.0), (12, 60.0)]
)
@pytest.mark.parametrize("name", ["velocity", "bouc_wen_velocity", "fused"])
def test_rotated_about_the_vertical(
    name: str, points: int | None, angle: float, lab: SimpleNamespace
) -> None:
    """Discs by any angle, contact points by those that map them onto themselves."""
    bearing = lab.make(name, contact_points=points)
    u, time = lab.smooth_path(bearing, 7, 300)
    turn = blocks(Rotation.from_rotvec([0.0, 0.0, math.radians(angle)]).as_matrix())
    one, two = walk(bearing, u, time), walk(bearing, u @ turn.T, time)
    scale = np.abs(one.resisting).max()
    assert_allclose(two.resisting / scale, one.resisting @ turn.T / scale, **HISTORY)


@pytest.mark.parametrize("name", ["coulomb", "velocity", "random-1"])
def test_other_directions_differ_little(name: str, lab: SimpleNamespace) -> None:
    """Eight points stand for a disc: a turn by 25 degrees changes forces by less than 1 %."""
    bearing = lab.make(name, contact_points=8)
    u, time = lab.smooth_path(bearing, 7, 300)
    turn = blocks(Rotation.from_rotvec([0.0, 0.0, math.radians(25.0)]).as_matrix())
    one, two = walk(bearing, u, time), walk(bearing, u @ turn.T, time)
    scale = np.abs(one.resisting[:, 6:8]).max()
    error = (two.resisting - one.resisting @ turn.T)[:, 6:8] / scale
    assert np.sqrt(np.mean(error**2)) < 1e-2


@pytest.mark.parametrize(
    "signs",
    [(-1, -1, 1, -1, -1, 1), (-1, 1, 1, 1, -1, -1), (1, -1, 1, -1, 1, -1)],
    ids=["reversed", "mirrored in x", "mirrored in y"],
)
@pytest.mark.parametrize("name", ["velocity", "bouc_wen_velocity", "fused"])
def test_mirrored_motion(name: str, signs: tuple[int, ...], lab: SimpleNamespace) -> None:
    bearing = lab.make(name)
    u, time = lab.smooth_path(bearing, 5, 300, swing=1.2)
    flip = np.tile(signs, 2)
    one, two = walk(bearing, u, time), walk(bearing, u * flip, time)
    scale = np.abs(one.resisting).max()
    assert np.abs(one.resisting[:, 6]).max() > 1e3
    assert_allclose(two.resisting / scale, one.resisting * flip / scale, **HISTORY)


@pytest.mark.parametrize("name", ["coulomb", "velocity", "fused"])
def test_turned_upside_down(name: str, lab: SimpleNamespace) -> None:
    """Exchange the plates and turn everything by pi about x; sliders without weight.

    Short of the rims: the interface's plane belongs to the bottom slider, its points to the top
    one, and under a slip the two pictures differ in where the pressure acts.
    """
    bearing = lab.make(name, **WEIGHTLESS)
    swap = {
        key: tuple(getattr(bearing, key))[::-1]
        for key in ("radius", "friction", "rims", "plate_thickness")
        if isinstance(getattr(bearing, key), tuple)
    }
    other = lab.make(name, **WEIGHTLESS, **swap)
    u, time = lab.smooth_path(bearing, 8, 400, tilt=0.004, twist=0.01, reach=0.85)
    flip = np.array([1, -1, -1, 1, -1, -1])
    turned = np.hstack([u[:, 6:] * flip, u[:, :6] * flip])
    one, two = walk(bearing, u, time, ("slip",)), walk(other, turned, time)
    expected = np.hstack([one.resisting[:, 6:] * flip, one.resisting[:, :6] * flip])
    scale = np.abs(one.resisting[:, 8]).max()
    assert_allclose(two.resisting / scale, expected / scale, rtol=0.0, atol=UPSIDE)


@pytest.mark.parametrize("name", ["velocity", "bouc_wen_velocity", "fused"])
def test_rigid_motion_of_the_whole_bearing(name: str, lab: SimpleNamespace) -> None:
    """Sliders without mass: a rotation and translation of all only turns the forces."""
    bearing = lab.make(name, **WEIGHTLESS)
    u, time = lab.smooth_path(bearing, 21, 300)
    share = (time / time[-1])[:, None]
    turn = Rotation.from_rotvec(share * [0.3, -0.2, 0.9])
    shift = share * [0.4, -0.3, 0.2]
    top = np.array([0.0, 0.0, bearing.height])
    moved = np.hstack(
        [
            turn.apply(u[:, :3]) + shift,
            (turn * Rotation.from_rotvec(u[:, 3:6])).as_rotvec(),
            turn.apply(u[:, 6:9] + top) - top + shift,
            (turn * Rotation.from_rotvec(u[:, 9:12])).as_rotvec(),
        ]
    )
    one, two = walk(bearing, u, time), walk(bearing, moved, time)
    expected = np.hstack([turn.apply(one.resisting[:, k : k + 3]) for k in (0, 3, 6, 9)])
    scale = np.abs(one.resisting).max()
    assert_allclose(two.resisting / scale, expected / scale, rtol=0.0, atol=1e-7)


# ------------------------------------------------------------------------------- bounds


@pytest.mark.parametrize("name", ["velocity", "bouc_wen_velocity", "random-1", "random-2"])
def test_friction_and_contacts_stay_within_bounds(name: str, lab: SimpleNamespace) -> None:
    """Each point: |z| <= 1, no pull; the whole: friction below mu N; with uplift and landing."""
    bearing = lab.make(name)
    u, time = lab.smooth_path(bearing, 13, 400, swing=1.6)
    lifted = []

    def visit(element: Element, k: int) -> None:
        touch = contacts(element).touch_new[0]
        assert (touch["push"] >= 0.0).all()
        assert (np.linalg.norm(touch["hysteresis"], axis=1) <= 1.0 + 1e-12).all()
        assert (touch["slid"] >= 0.0).all()
        lifted.append(element.response("axial_force") == 0.0)
        if lifted[-1] and element.response("rim_force")[1] == 0.0:
            assert_array_equal(element.resisting_force()[6:], STILL[6:])

    names = ("axial_force", "friction_force", "friction_coefficient", "interface_force")
    r = walk(bearing, u, time, names, visit)
    assert any(lifted)
    assert not all(lifted)
    top = np.linalg.norm(r.friction_force[:, 1], axis=-1)
    assert (top <= bearing.frictions[1].f_max * r.axial_force * (1.0 + 1e-9)).all()


def test_weight_and_flight_of_lifted_sliders(lab: SimpleNamespace) -> None:
    """The top plate gone at once: the sliders spring up, fall, and come to rest on the bottom."""
    bearing = lab.make("coulomb", slider_mass=30.0, axial_damping=2e5)
    element = Element(bearing, "contact")
    u = np.zeros(12)
    u[8] = -5e-4
    element.set_trial(u, STILL, 0.0)
    element.commit()
    u[8] = 0.2
    reactions = []
    for k in range(1, 600):
        element.set_trial(u, STILL, 1e-3 * k)
        element.commit()
        reactions.append(element.resisting_force()[2])
        assert element.response("axial_force") == 0.0
    assert min(reactions) == 0.0
    assert_allclose(reactions[-1], 60.0 * 9.80665, rtol=1e-3, atol=0.0)
    # momentum: what the bottom gave since the start is weight times time plus what moved at first
    assert_allclose(np.mean(reactions), 60.0 * 9.80665, rtol=0.05, atol=0.0)


def test_what_holds_the_halves_stops_them(lab: SimpleNamespace) -> None:
    """Lifted halves, one thrown: friction F = R + mu_h m g takes their relative motion.

    ``s = v^2 / 2 a`` with ``a = F / m + (F - 2 mu m g) / m``: the bottom half rubs on its plate.
    """
    mass, hold, speed, dt = 30.0, 300.0, 0.8, 2e-4
    flat = {"radius": 4.0, "rims": 0.5, "friction": 0.05}
    element = Element(lab.make("coulomb", **flat, slider_mass=mass, interface_hold=hold), "contact")
    u = np.zeros(12)
    u[8] = 0.2
    for k in range(1, 400):
        element.set_trial(u, STILL, 1e-3 * k)
        element.commit()
    contacts(element).bodies_old["velocity"][0, 1, 0] += speed
    for k in range(1, 500):
        element.set_trial(u, STILL, 0.4 + dt * k)
        element.commit()
    weight = mass * 9.80665
    force = hold + 0.15 * weight
    way = 0.5 * speed**2 * mass / (2.0 * force - 0.05 * 2.0 * weight)
    assert_allclose(element.response("largest_slip"), way, rtol=0.01, atol=0.0)


# ------------------------------------------------------------------------------- works

WORKS = (
    "work_friction",
    "work_interface",
    "work_elastic",
    "work_owed",
    "work_rim",
    "work_contact",
    "work_sliders",
)


@pytest.mark.parametrize("name", ["coulomb", "velocity", "bouc_wen_velocity", "fused"])
def test_works_agree_with_those_of_the_nodes(name: str, lab: SimpleNamespace) -> None:
    """Less than 0.1 % of friction's work at all times; dissipation never falls."""
    bearing = lab.make(name)
    u, time = lab.smooth_path(bearing, 5, 801, twist=0.005)
    r = walk(bearing, u, time, WORKS)
    steps = np.diff(u, axis=0)
    for first in (3, 9):
        turn = Rotation.from_rotvec(u[:, first : first + 3])
        steps[:, first : first + 3] = (turn[1:] * turn[:-1].inv()).as_rotvec()
    means = 0.5 * (r.resisting[1:] + r.resisting[:-1])
    nodes = np.concatenate([[0.0], np.cumsum(np.sum(means * steps, axis=1))])
    inside = sum(getattr(r, work).reshape(len(u), -1).sum(axis=1) for work in WORKS)
    scale = np.abs(r.work_friction).sum(axis=1).max()
    assert nodes[-1] > 0.5 * scale
    assert_allclose(inside / scale, nodes / scale, rtol=0.0, atol=1e-3)
    for name_ in ("work_friction", "work_interface"):
        assert (np.diff(getattr(r, name_), axis=0) >= 0.0).all()


def test_work_of_the_sliders_weight(lab: SimpleNamespace) -> None:
    """Both nodes moved alike, without time: what the sliders take up is their weight times rise."""
    bearing = lab.make("coulomb", slider_mass=(40.0, 70.0))
    u = np.zeros((4, 12))
    u[:, 8] = -1e-3
    for k in range(1, 4):
        u[k] += np.tile([0.1 * k, -0.2 * k, 0.1 * k, 0.0, 0.0, 0.0], 2)
    r = walk(bearing, u, np.zeros(4), ("work_sliders", "work_friction"))
    assert_allclose(np.diff(r.work_sliders), 110.0 * 9.80665 * 0.1, rtol=1e-9, atol=0.0)
    assert np.abs(np.diff(r.work_friction, axis=0)).max() < 1e-6


RESPONSES = {
    # name: difference over its largest value
    "axial_force": 0.01,
    "friction_force": 0.02,
    "hysteresis": 0.02,
    "interface_force": 0.02,
    "sliding_increment": 0.02,
    "slider_displacement": 0.01,
    "friction_coefficient": 0.01,
    "sliding_speed": 0.02,
    "eccentricity": 0.01,
    "axis": 1e-3,
    "axis_top": 1e-3,
    "centres": 1e-12,
    "string": 1e-4,
    "travel": 0.02,
    "torque": None,
}


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_responses_are_those_of_the_level_pendulum(sign: float, lab: SimpleNamespace) -> None:
    """Stiff contacts, no rim: along x, then along y; signs and axes as in the other level."""
    bearing = lab.make("velocity", axial_stiffness=1e10, rims=(0.2, 0.3))
    corner, count = np.array([0.03, 0.02]), 12
    u = np.zeros((2 * count + 1, 12))
    u[1 : count + 1, 6] = sign * corner[0] * np.arange(1, count + 1) / count
    u[count + 1 :, 6] = sign * corner[0]
    u[count + 1 :, 7] = sign * corner[1] * np.arange(1, count + 1) / count
    for row in u:
        row[8] = lab.vertical(bearing, row, 1e6)
    time = 0.02 * np.arange(len(u))
    names = tuple(RESPONSES)
    one, two = lab.walk(bearing, u, time, names), walk(bearing, u, time, names)
    sliding = np.r_[4 : count + 1, count + 6 : 2 * count + 1]  # beyond what is elastic
    for name, share in RESPONSES.items():
        if share is None:
            continue
        expected, found = getattr(one, name)[sliding], getattr(two, name)[sliding]
        scale = np.abs(expected).max()
        assert scale > 0.0, name
        assert_allclose(found / scale, expected / scale, rtol=0.0, atol=share, err_msg=name)


# ------------------------------------------------------------------------------- torsion


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("weak", [0, 1])
def test_twist_under_load(sign: float, weak: int) -> None:
    """The weakest surface turns: torque 2/3 a mu N."""
    friction = [CoulombFriction(0.08), CoulombFriction(0.08)]
    friction[weak] = CoulombFriction(0.05)
    bearing = LIRBearing(
        radius=(0.9, 0.9),
        slider_height=0.11,
        slider_radius=0.08,
        capacity=math.inf,
        friction=tuple(friction),
        interface_friction=0.3,
    )
    element, u = Element(bearing, "contact"), np.zeros(12)
    load = bearing.resolved()["axial_stiffness"] * 2e-4
    u[8] = -2e-4
    for k in range(40):
        u[11] = sign * 5e-4 * k
        element.set_trial(u, STILL, 0.1 * k)
        element.commit()
    torque = 2.0 / 3.0 * 0.08 * 0.05 * load
    force = element.resisting_force()
    assert_allclose(element.response("torque"), sign * torque, rtol=2e-4, atol=0.0)
    assert_allclose(force[[11, 5]], [sign * torque, -sign * torque], rtol=2e-4, atol=0.0)
    assert_allclose(element.response("twist"), u[11], rtol=0.0, atol=0.0)
    turns = Rotation.from_quat(contacts(element).bodies_old["turn"][0, :2], scalar_first=True)
    spin = sign * turns.as_rotvec()[:, 2]
    # both sliders stay with the plate that holds them, but for its elastic twist
    elastic = 0.05 / 0.08 * 1.5 * bearing.yield_displacement / 0.08
    expected = [elastic] * 2 if weak == 1 else [abs(u[11]) - elastic] * 2
    assert_allclose(spin, expected, rtol=0.0, atol=0.03 * elastic)


# ------------------------------------------------------------------------------- plain Python


@pytest.mark.nightly  # by day the pendulum's element and the time loop are
def test_compiled_is_plain_python(lab: SimpleNamespace) -> None:
    u, time = lab.smooth_path(lab.make("coulomb"), 81, 120)
    steps = slice(0, 3)
    common = DEVICE | {"rims": (0.005, 0.009)}
    bearings = [
        common | {"interface_friction": 0.15, "contact_points": 5},
        common | {"interface_friction": 0.15, "friction_law": "bouc-wen", "contact_points": 4},
        common | {"interface_friction": math.inf, "contact_points": 4},
        common | {"interface_friction": 0.15},
        common | {"interface_friction": math.inf, "friction_law": "bouc-wen"},
    ]
    compiled, python = forces_both_ways(bearings, u[steps], time[steps], "contact")
    scale = np.abs(compiled).max(axis=0)
    assert np.abs(compiled[:3]).max() > 1e4
    # Round-off, amplified by the contacts' stiffness: Newton's last step is the same in both.
    assert_allclose(python / scale, compiled / scale, rtol=0.0, atol=1e-11)
