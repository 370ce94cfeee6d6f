"""Friction under a changing axial force: what it gives back is what it had stored, and no more.

The friction of a surface has a stiffness before slip. If that followed the axial force, a bearing
that is pushed under a small force and let back under a large one would do work out of nothing.
"""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from lir_element import Element, LIRBearing

# Sliders next to without mass, on purpose: their density is no metal's.
pytestmark = pytest.mark.filterwarnings("ignore:slider_density")
LOAD = 1e5
WORKS = ("work_friction", "work_interface", "work_elastic")
LAWS = {
    "coulomb": {},
    "velocity": {},
    "bouc_wen": {},
    "fused": {},
    "bouc_wen_velocity": {},
    "pressed_and_heated": {},
}


def device(lab: SimpleNamespace, name: str) -> LIRBearing:
    """Return a bearing without dampers and rims, of which nothing but friction dissipates."""
    return lab.make(
        name,
        axial_damping=0.0,
        rims=None,
        capacity=math.inf,
        torsional_friction=True,
        design_load=LOAD,
        slider_density=1.0,
    )


def walk(
    element: Element, lab: SimpleNamespace, path: np.ndarray, loads: np.ndarray, dt: float
) -> SimpleNamespace:
    """Take an element from rest along a path (n, 3: x, y, twist) under axial forces (n,)."""
    u, force = np.zeros(12), np.zeros(12)
    kept: dict[str, list[float]] = {name: [] for name in (*WORKS, "nodes")}
    for k, (x, y, twist) in enumerate(path):
        new = np.zeros(12)
        new[6], new[7], new[11] = x, y, twist
        new[8] = lab.vertical(element.bearing, new, loads[k])
        element.set_trial(new, np.zeros(12), dt * k)
        element.commit()
        after = element.resisting_force()
        kept["nodes"].append(float(0.5 * (force + after) @ (new - u)) if k else 0.0)
        for name in WORKS:
            kept[name].append(float(np.sum(element.response(name))))
        u, force = new, after
    out = SimpleNamespace(**{name: np.array(values) for name, values in kept.items()})
    out.nodes = np.cumsum(out.nodes)
    return out


def strokes(cycles: int, reach: float, low: float, high: float) -> tuple[np.ndarray, np.ndarray]:
    """Pushed out under `low`, held, let back under `high`, held: repeated."""
    x = np.concatenate(
        [np.linspace(0.0, 1.0, 6), np.ones(5), np.linspace(1.0, 0.0, 6), np.zeros(5)]
    )
    n = np.concatenate(
        [np.full(6, low), np.linspace(low, high, 5), np.full(6, high), np.linspace(high, low, 5)]
    )
    x, n = np.tile(x, cycles), np.tile(n, cycles)
    path = np.column_stack([0.8 * reach * x, 0.6 * reach * x, 20.0 * reach * x])
    return np.vstack([np.zeros((1, 3)), path]), np.concatenate([[LOAD], n])


@pytest.mark.parametrize(
    ("level", "low"),
    [("pendulum", 0.0), ("pendulum", 0.05), ("pendulum", 0.4), ("contact", 0.05), ("contact", 0.4)],
)
@pytest.mark.parametrize("name", LAWS)
def test_no_work_out_of_a_changing_axial_force(
    level: str, name: str, low: float, lab: SimpleNamespace
) -> None:
    """Out under a small force, back under a large one: the way that did work out of nothing."""
    bearing = device(lab, name)
    path, loads = strokes(12, 0.15e-3, low * LOAD, 1.6 * LOAD)
    out = walk(Element(bearing, level), lab, path, loads, 1e-3)
    scale = 0.5 * 0.08 * LOAD * bearing.yield_displacement  # J, what a surface stores at most
    assert out.work_elastic.min() > -1e-9 * scale
    if level == "pendulum":  # at rest there, and in no other energy, at the end of each cycle
        ends = out.nodes[22::22] - out.nodes[0]
        assert (np.diff(ends) > -1e-3 * scale).all()
    friction = out.work_friction + out.work_interface + out.work_elastic
    assert friction.min() > -1e-9 * scale
    assert (np.diff(out.work_friction) >= 0.0).all()
    assert (np.diff(out.work_interface) >= 0.0).all()


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("level", ["pendulum", "contact"])
def test_friction_never_gives_more_than_it_has(
    level: str, name: str, seed: int, lab: SimpleNamespace
) -> None:
    """Random axial forces, uplift among them, at random slidings: the database stays a store.

    At the level 'contact' the bearing stays down: its sliders have next to no mass here.

    And what the trapezoidal rule owes where slip turns round within a step stays small.
    """
    rng = np.random.default_rng(seed)
    count = 240
    reach = rng.choice([0.1e-3, 1e-3])
    t = np.linspace(0.0, 12.0 * np.pi, count)
    path = reach * np.column_stack(
        [
            np.sin(1.3 * t) + 0.5 * np.sin(2.9 * t),
            np.sin(0.7 * t + 1.0) - math.sin(1.0),
            20.0 * np.sin(1.9 * t),
        ]
    )
    swing = 1.2 if level == "pendulum" else 0.7
    loads = LOAD * (1.0 + swing * np.sin(t * rng.uniform(0.8, 4.0)) * np.minimum(t, 1.0))
    bearing = device(lab, name)
    element = Element(bearing, level)
    out = walk(element, lab, path, loads, 2e-3)
    scale = 0.5 * 0.08 * LOAD * bearing.yield_displacement
    assert out.work_elastic.min() > -1e-9 * scale
    assert out.work_elastic.max() < 20.0 * scale  # (2.2 N)^2, three interfaces
    friction = out.work_friction + out.work_interface + out.work_elastic
    assert friction.min() > -1e-9 * scale
    assert (np.diff(out.work_friction) >= 0.0).all()
    assert (np.diff(out.work_interface) >= 0.0).all()
    assert (element.response("work_owed") <= 0.0).all()
    assert_allclose(element.response("work_owed"), 0.0, rtol=0.0, atol=0.3 * scale)


def test_uplift_loses_the_store(lab: SimpleNamespace) -> None:
    """At uplift friction lets go: all that it had stored is dissipated, and lands at nothing."""
    bearing = device(lab, "coulomb")
    path, loads = strokes(1, 0.1e-3, LOAD, LOAD)
    path = np.vstack([path[:9], np.repeat(path[8:9], 3, axis=0)])
    loads = np.concatenate([loads[:9], [-100.0, -100.0, LOAD]])
    element = Element(bearing)
    out = walk(element, lab, path, loads, 1e-3)
    assert out.work_elastic[8] > 0.05
    # forces fade below a thousandth of the design load: as much is left of three full stores
    full = 0.5 * 0.08 * LOAD * bearing.yield_displacement
    assert_allclose(out.work_elastic[9:], 0.0, rtol=0.0, atol=3e-3 * full)
    lost = out.work_friction + out.work_interface
    assert lost[9] - lost[8] == pytest.approx(out.work_elastic[8], rel=3e-2)
    # the root of that thousandth
    assert np.abs(element.response("friction_force")).max() < 0.033 * 0.08 * LOAD


@pytest.mark.parametrize("level", ["pendulum", "contact"])
def test_a_static_trial_in_place_has_the_committed_force(lab: SimpleNamespace, level: str) -> None:
    """Stuck under an axial force that has swung: time does not change the force."""
    element, time = Element(device(lab, "coulomb"), level), 0.0
    for load in (LOAD, LOAD, 0.5 * LOAD, 0.5 * LOAD, LOAD, LOAD):
        u = np.zeros(12)
        u[6] = 0.05e-3 if time > 0.0 else 0.0
        u[8] = lab.vertical(element.bearing, u, load)
        element.set_trial(u, np.zeros(12), time)
        element.commit()
        time += 0.01
    force = element.resisting_force()
    element.set_trial(u, np.zeros(12), time - 0.01)
    assert_allclose(element.resisting_force(), force, rtol=0.0, atol=1e-6 * LOAD)


def test_stiffness_before_slip(lab: SimpleNamespace) -> None:
    """mu N / u_y, with the axial force that is there now, whatever it was before."""
    bearing = device(lab, "fused")

    def stiffness(*loads: float) -> float:
        """Under a small force at the side the axial force takes these values; the last counts."""
        element, u, time = Element(bearing), np.zeros(12), 0.0
        for k, load in enumerate(loads):
            u = np.zeros(12)
            u[6] = 0.05e-3 if k else 0.0
            u[8] = lab.vertical(bearing, u, load)
            element.set_trial(u, np.zeros(12), time)
            element.commit()
            time += 0.01
        assert 0.01 < np.hypot(*element.response("hysteresis")[0]) < 0.3
        sides = []
        for shift in (-1e-7, 1e-7):
            v = u.copy()
            v[6] += shift
            v[8] = lab.vertical(bearing, v, loads[-1])
            element.set_trial(v, np.zeros(12), time)
            sides.append(element.resisting_force()[6])
        element.revert_to_last_commit()
        k = (sides[1] - sides[0]) / 2e-7
        return float(k - element.response("axial_force") / element.response("string"))

    def spring(load: float) -> float:
        turn = sum(
            r * r * law.f_min / bearing.yield_displacement
            for r, law in zip(bearing.radii, bearing.frictions, strict=True)
        )
        return load * turn / bearing.effective_radius**2

    rel = 0.01  # the string is longer under load
    assert stiffness(LOAD, LOAD) == pytest.approx(spring(LOAD), rel=rel)
    assert stiffness(LOAD, LOAD, 0.6 * LOAD) == pytest.approx(spring(0.6 * LOAD), rel=rel)
    for low in (0.6, 0.2):
        back = stiffness(LOAD, LOAD, low * LOAD, low * LOAD, LOAD, LOAD)
        assert back == pytest.approx(spring(LOAD), rel=rel)
    more = stiffness(LOAD, LOAD, 2.0 * LOAD, 2.0 * LOAD)
    assert more == pytest.approx(spring(2.0 * LOAD), rel=rel)


def test_force_at_rest_goes_with_the_root_of_the_axial_force(lab: SimpleNamespace) -> None:
    """And comes back with it: no cycle of the axial force moves a bearing that is held.

    A rigid slider in its plates' middle, pushed by a tenth of the yield displacement.
    """
    bearing = device(lab, "fused")
    element, forces = Element(bearing), []
    for k, load in enumerate([1.0, 1.0, 0.5, 2.0, 1.0, 0.5, 2.0, 1.0]):
        u = np.zeros(12)
        u[6] = 0.1 * bearing.yield_displacement if k else 0.0
        u[8] = lab.vertical(bearing, u, load * LOAD)
        element.set_trial(u, np.zeros(12), 0.01 * k)
        element.commit()
        slope = element.response("axial_force") / element.response("string")
        forces.append(float(element.resisting_force()[6] - slope * u[6]))
    full = np.array(forces[1:]) / forces[1]
    roots = np.sqrt([1.0, 0.5, 2.0, 1.0, 0.5, 2.0, 1.0])
    assert_allclose(full, roots, rtol=2e-3, atol=0.0)  # the string's length follows the load
