"""Contact pairs: laws against plain formulas, derivatives against differences, balance of forces.

The kernels are called one by one, on records made here; nothing is solved.
"""

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

from lir_element import LIRBearing, VelocityFriction
from lir_element.bundles.contact_data import BodyStep
from lir_element.device.sliders import face_records, slider_record
from lir_element.kernels.contact.pair import bond, clear_pair, plane, rim, sphere
from lir_element.kernels.contact.pairs import press
from lir_element.kernels.contact.places import locate, matrix_of, turn_between, turn_by
from lir_element.kernels.contact.residual import invert
from lir_element.kernels.linear import solve_many
from lir_element.layout import BODIES, SCRATCH, TOUCH

OPTIONS: dict[str, Any] = {
    "radius": (0.75, 1.1),
    "slider_height": 0.11,
    "slider_radius": 0.08,
    "friction": (VelocityFriction(0.07, 0.03, 12.0), VelocityFriction(0.09, 0.05, 6.0)),
    "interface_friction": 0.15,
    "rims": (0.07, 0.11),
    "axial_stiffness": 1e8,
    "rim_stiffness": 2e7,
    "rim_damping": 3e4,
    "rim_overrun": 0.05,
    "yield_displacement": 0.5e-3,
    "interface_yield_displacement": 0.3e-3,
}
LAWS: dict[str, dict[str, Any]] = {
    "elastic-plastic": {},
    "bouc-wen": {"friction_law": "bouc-wen", "bouc_wen_exponent": 2.5},
}
STIFF, DAMP = 3e8, 2e5
CLOSE = {"rtol": 1e-11, "atol": 1e-9}  # N, of some 1e4; 1e-15 m times 3e8 N/m at most


def bearing(**changes: object) -> LIRBearing:
    return LIRBearing(**(OPTIONS | changes))


def one(dtype: np.dtype) -> Any:
    return np.zeros(1, dtype=dtype)[0]


def hysteresis(b: LIRBearing, old: np.ndarray, dw: np.ndarray, u_y: float) -> np.ndarray:
    """Return z after the sliding dw, by bisection where Bouc-Wen's equation has no closed form."""
    full = old + dw / u_y
    size = float(np.linalg.norm(full))
    if size == 0.0:
        return full
    kappa = float(full / size @ dw) / u_y
    if b.friction_law == "elastic-plastic" or kappa <= 0.0:
        return full / max(size, 1.0)
    rho = brentq(lambda r: r + kappa * r**b.bouc_wen_exponent - size, 0.0, 2.0, xtol=1e-15)
    return full * (min(rho, 1.0) / size)


def share_kept(old: SimpleNamespace, push: float, dt: float) -> float:
    """Return the share of z that the change of the normal force leaves."""
    return math.sqrt(old.push / push) if dt > 0.0 else 1.0


def contact_force(gap: float, old: float, k: float, c: float, dt: float) -> float:
    """Return the force of spring and damper, which acts on the closure and never pulls."""
    if gap < 0.0:
        return 0.0
    rate = (gap - old) / dt if dt > 0.0 else 0.0
    return max(k * gap + c * rate, 0.0)


def frame_of(n: np.ndarray) -> np.ndarray:
    """Return the two tangents (2, 3): x and y turned with z onto n the shortest way."""
    axis = np.cross([0.0, 0.0, 1.0], n)
    size = np.linalg.norm(axis)
    turn = Rotation.from_rotvec(axis / size * math.atan2(size, n[2]) if size > 0.0 else 3 * [0.0])
    return turn.as_matrix()[:, :2].T


def plain_sphere(
    b: LIRBearing, side: int, d: np.ndarray, old: SimpleNamespace, dt: float, static: float
) -> SimpleNamespace:
    radius, law = b.radii[side], b.frictions[side]
    size = float(np.linalg.norm(d))
    m = d / size
    t = frame_of(-m if side == 0 else m)
    dw = radius * t @ (m - old.spot)
    push = contact_force(size - radius, old.closure, STIFF, DAMP, dt)
    kept = share_kept(old, push, dt)
    u_y, start = 2.0 * b.yield_displacement / (1.0 + kept), kept * old.hysteresis
    z = hysteresis(b, start, dw, u_y)
    before = float(np.linalg.norm(old.hysteresis))
    on = float(np.linalg.norm(old.hysteresis + dw / b.yield_displacement)) - before
    slip = b.yield_displacement * max(on, 0.0)
    mu = law.at_speed(slip / dt if dt > 0.0 else static)
    forces = {"normal": -push * m, "tangential": -push * mu * z @ t, "push": push}
    return SimpleNamespace(**forces, friction=mu, slid=slip, dw=dw, z=z)


def point_case(b: LIRBearing, side: int, seed: int, regime: str) -> tuple[np.ndarray, Any]:
    """Return a random place d on a sphere (pressed by 0.1 mm) and the record before it."""
    rng = np.random.default_rng(seed)
    radius = b.radii[side]
    down = -1.0 if side == 0 else 1.0
    m = np.array([*rng.uniform(-0.15, 0.15, 2), 0.0])
    m[2] = down * math.sqrt(1.0 - m @ m)
    d = (radius + 1e-4) * m
    angle = rng.uniform(-math.pi, math.pi)
    z = rng.uniform(0.2, 0.5) * np.array([math.cos(angle), math.sin(angle)])
    size, along = {"stick": (0.2, 0.4), "slip": (4.0, 0.5), "unload": (0.3, math.pi)}[regime]
    move = size * b.yield_displacement / radius
    shift = angle + along
    t = frame_of(down * -m if side == 0 else m)
    step = move * (math.cos(shift) * t[0] + math.sin(shift) * t[1])
    spot = m - step
    old = one(TOUCH)
    old.spot[:], old.hysteresis[:] = spot / np.linalg.norm(spot), z
    old.closure, old.push = 0.8e-4, rng.uniform(0.3, 2.0) * 3e4
    return d, old


REGIMES = ("stick", "slip", "unload")


@pytest.mark.parametrize("dt", [0.0, 2e-3])
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("side", [0, 1])
def test_sphere_law(side: int, law: str, dt: float) -> None:
    b = bearing(**LAWS[law])
    p, w = b.to_record()[0], one(SCRATCH)
    slipped = 0
    for seed in range(12):
        d, old = point_case(b, side, seed, REGIMES[seed % 3])
        new = one(TOUCH)
        clear_pair(w)
        w.d[:] = d
        sphere(p, side, w, old, new, STIFF, DAMP, dt, 0.07, 1.0)
        expected = plain_sphere(b, side, d, old, dt, 0.07)
        assert expected.push > 1e4
        assert_allclose(w.normal, expected.normal, **CLOSE)
        assert_allclose(w.tangential, expected.tangential, rtol=1e-9, atol=1e-6)
        assert_allclose(new.push, expected.push, **CLOSE)
        assert_allclose(new.friction, expected.friction, rtol=1e-11, atol=0.0)
        assert_allclose(new.hysteresis, expected.z, rtol=0.0, atol=1e-11)
        assert_allclose(new.increment, expected.dw, rtol=0.0, atol=1e-15)
        assert_allclose(new.slid, expected.slid, rtol=0.0, atol=1e-14)
        assert_allclose(new.spot, d / np.linalg.norm(d), rtol=0.0, atol=1e-15)
        assert_allclose(new.gap, 1e-4, rtol=1e-10, atol=0.0)
        # friction acts against the way slid, where it slips
        if expected.slid > 0.0:
            slipped += 1
            way = d / np.linalg.norm(d) - old.spot
            assert w.tangential @ way < 0.0
        assert np.linalg.norm(w.tangential) <= new.friction * new.push * (1.0 + 1e-12)
        assert abs(w.tangential @ d) < 1e-9 * new.push
    assert slipped >= 4


@pytest.mark.parametrize("dt", [0.0, 2e-3])
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("held", [0.0, 5e3])
def test_plane_law(held: float, law: str, dt: float) -> None:
    b = bearing(**LAWS[law])
    p, w, rng = b.to_record()[0], one(SCRATCH), np.random.default_rng(4)
    for _ in range(12):
        old, new = one(TOUCH), one(TOUCH)
        old.spot[:2], old.hysteresis[:] = rng.uniform(-0.1, 0.1, 2), rng.uniform(-0.6, 0.6, 2)
        old.closure, old.push = 0.8e-4, rng.uniform(0.0, 2.0) * 3e4
        dw = rng.uniform(-6e-4, 6e-4, 2)
        clear_pair(w)
        w.d[:2], w.d[2] = old.spot[:2] + dw, -1e-4
        plane(p, w, old, new, STIFF, DAMP, dt, held)
        push = contact_force(1e-4, 0.8e-4, STIFF, DAMP, dt)
        kept = share_kept(SimpleNamespace(push=old.push + held), push + held, dt)
        u_y = 2.0 * b.interface_yield_displacement / (1.0 + kept)
        z = hysteresis(b, kept * old.hysteresis, dw, u_y)
        assert_allclose(w.normal, [0.0, 0.0, push], **CLOSE)
        expected = [*(-0.15 * (push + held) * z), 0.0]
        assert_allclose(w.tangential, expected, rtol=1e-9, atol=1e-6)
        assert_allclose(new.hysteresis, z, rtol=0.0, atol=1e-11)
        assert new.friction == 0.15
        assert_allclose(new.increment, dw, rtol=0.0, atol=1e-16)


@pytest.mark.parametrize("dt", [0.0, 2e-3])
@pytest.mark.parametrize("side", [0, 1])
def test_rim_law(side: int, dt: float) -> None:
    """Radial, towards the plate's axis, whatever the direction; the height of the point is free."""
    b = bearing()
    p, w = b.to_record()[0], one(SCRATCH)
    for angle in (0.0, 0.7, 1.9, -2.6):
        way = np.array([math.cos(angle), math.sin(angle), 0.0])
        for beyond in (2e-4, -2e-4):
            old, new = one(BODIES), one(BODIES)
            old.rim_closure[side] = 1e-4
            clear_pair(w)
            w.d[:] = (b.rim_displacement[side] + beyond) * way
            w.d[2] = -0.7
            rim(p, side, w, old, new, dt)
            push = contact_force(beyond, 1e-4, 2e7, 3e4, dt)
            assert (push > 1e3) == (beyond > 0.0)
            assert_allclose(w.normal, -push * way, rtol=1e-10, atol=1e-9)
            assert_array_equal(w.tangential, np.zeros(3))
            assert_allclose(new.rim_force[side], push, rtol=1e-10, atol=0.0)
            assert_allclose(new.rim_gap[side], beyond, rtol=1e-10, atol=0.0)
            assert_allclose(new.rim_closure[side], max(beyond, 0.0), rtol=1e-10, atol=0.0)


def test_contacts_never_pull() -> None:
    """Fast opening: the damper alone would pull by 4 kN; and an open point has no force at all."""
    b = bearing()
    p, w, dt = b.to_record()[0], one(SCRATCH), 1e-5
    for gap in (1e-5, -1e-5):
        old, new, past, after = one(TOUCH), one(TOUCH), one(BODIES), one(BODIES)
        old.closure, old.hysteresis[:], old.spot[2] = 4e-4, (0.5, 0.3), -1.0
        past.rim_closure[0] = 4e-4
        for pair, d in (
            ("sphere", (0.0, 0.0, -(b.radii[0] + gap))),
            ("plane", (0.0, 0.0, -gap)),
            ("rim", (b.rim_displacement[0] + gap, 0.0, -0.7)),
        ):
            clear_pair(w)
            w.d[:] = d
            if pair == "sphere":
                sphere(p, 0, w, old, new, STIFF, DAMP, dt, 0.0, 1.0)
                assert_allclose(new.hysteresis, [0.5, 0.3], rtol=0.0, atol=1e-15)  # for the landing
                assert_allclose(new.closure, max(gap, 0.0), rtol=1e-9, atol=1e-18)
            elif pair == "plane":
                plane(p, w, old, new, STIFF, DAMP, dt, 0.0)
            else:
                rim(p, 0, w, past, after, dt)
            assert new.push == after.rim_force[0] == 0.0
            assert not w.normal.any()
            assert not w.tangential.any()
            assert pair == "rim" or not w.slope.any()


def test_bond_pulls_both_ways() -> None:
    w, old, new = one(SCRATCH), one(TOUCH), one(TOUCH)
    old.spot[:] = (0.02, 0.01, 1e-5)
    d = np.array([0.0201, 0.0099, 3e-5])
    clear_pair(w)
    w.d[:] = d
    bond(w, old, new, 0.02, 0.01, STIFF, DAMP, 1e-3)
    expected = -STIFF * (d - [0.02, 0.01, 0.0]) - DAMP * (d - old.spot) / 1e-3
    assert_allclose(w.normal, expected, **CLOSE)
    assert_allclose(w.slope, -(STIFF + DAMP / 1e-3) * np.eye(3), rtol=1e-14, atol=0.0)
    assert new.push == 0.0
    w.d[2] = -3e-5
    bond(w, old, new, 0.02, 0.01, STIFF, 0.0, 0.0)
    assert_allclose(new.push, STIFF * 3e-5, rtol=1e-12, atol=0.0)


def fourth_order(function: Any, x: np.ndarray, step: float) -> np.ndarray:
    """Return central differences of fourth order, one column an entry of `x`."""
    columns = []
    for k in range(len(x)):
        total = 0.0
        for shift, weight in ((-2, 1.0), (-1, -8.0), (1, 8.0), (2, -1.0)):
            moved = x.copy()
            moved[k] += shift * step
            total = total + weight * function(moved)
        columns.append(total / (12.0 * step))
    return np.array(columns).T


@pytest.mark.parametrize("dt", [0.0, 2e-3])
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("pair", ["bottom", "top", "plane", "rim"])
def test_slope_is_the_derivative(pair: str, law: str, dt: float) -> None:
    b = bearing(**LAWS[law])
    p, w = b.to_record()[0], one(SCRATCH)
    rng = np.random.default_rng(9)
    for seed in range(12):
        side = 1 if pair == "top" else 0
        d, old = point_case(b, side, seed, REGIMES[seed % 3])
        before, after = one(BODIES), one(BODIES)
        before.rim_closure[0] = 1e-4
        if pair == "plane":
            d = np.array([*rng.uniform(-0.1, 0.1, 2), -1e-4])
            size = {"stick": 0.1, "slip": 5.0, "unload": 0.1}[REGIMES[seed % 3]]
            angle = rng.uniform(-math.pi, math.pi)
            way = np.array([math.cos(angle), math.sin(angle)])
            old.spot[:2] = d[:2] - size * b.interface_yield_displacement * way
            old.hysteresis[:] = 0.4 * way * (-1.0 if seed % 3 == 2 else 1.0)
        if pair == "rim":
            angle = rng.uniform(-math.pi, math.pi)
            d = np.array([0.0702 * math.cos(angle), 0.0702 * math.sin(angle), -0.7])

        def force(at: np.ndarray, old: Any = old, before: Any = before, after: Any = after) -> Any:
            new = one(TOUCH)
            clear_pair(w)
            w.d[:] = at
            if pair == "plane":
                plane(p, w, old, new, STIFF, DAMP, dt, 2e3)
            elif pair == "rim":
                rim(p, 0, w, before, after, dt)
            else:
                sphere(p, side, w, old, new, STIFF, DAMP, dt, 0.07, 1.0)  # noqa: B023
            return w.normal + w.tangential

        force(d)
        slope = w.slope.copy()
        expected = fourth_order(force, d, 1e-6)
        scale = np.abs(slope).max()
        assert scale > 1e7
        # fourth order in 1e-6 over u_y 3e-4: 1e-10; round-off 1e-16 / 1e-6
        assert_allclose(slope / scale, expected / scale, rtol=0.0, atol=3e-9)


CONFIGS: dict[str, dict[str, Any]] = {
    "pressed": {},
    "one ring": {"contact_points": 5},
    "on the rims": {"reach": 1.02},
    "rocking": {"noise": 1e-3},
    "bouc-wen": {"friction_law": "bouc-wen"},
    "fused": {"interface_friction": math.inf, "reach": 1.02},
    "thick": {"plate_thickness": (0.05, 0.08)},
    "held": {"interface_hold": 4e3, "noise": 1e-3},
}


KINDS = "points", "discs"


class Bodies:
    """Four bodies near a string's position, with contact points or discs that have a past."""

    def __init__(self, name: str, seed: int, kind: str) -> None:
        options = dict(CONFIGS[name])
        reach, noise = options.pop("reach", 0.6), options.pop("noise", 2e-4)
        self.bearing = bearing(**options)
        self.p = self.bearing.to_record()[0]
        if kind == "points" and self.bearing.contact_points is None:
            self.bearing = replace(self.bearing, contact_points=8)
        self.c = slider_record(self.bearing, 9.81)[0]
        points, touches = face_records(self.bearing)
        self.points = points[0]
        self.old, self.new = one(BODIES), one(BODIES)
        self.touch_old, self.touch_new = touches[0], touches[0].copy()
        self.w, self.dt = one(SCRATCH), 0.0
        rng = np.random.default_rng(seed)
        sine = reach * max(
            d / r for d, r in zip(self.bearing.rim_displacement, self.bearing.radii, strict=True)
        )
        angle = rng.uniform(-math.pi, math.pi)
        way = np.array([math.cos(angle), math.sin(angle), 0.0])
        n = np.array([0.0, 0.0, math.sqrt(1.0 - sine**2)]) - sine * way
        turn = Rotation.from_rotvec(math.asin(sine) * np.array([-way[1], way[0], 0.0]) * -1.0)
        assert_allclose(turn.apply([0.0, 0.0, 1.0]), n, rtol=0.0, atol=1e-14)
        length = self.bearing.effective_radius + 3e-4
        place = self.c.place
        sliders = [turn.apply(place[k]) - 1e-4 * k * n for k in (1, 2)]
        self.x = np.array([place[0], *sliders, [0.0, 0.0, self.p.lever[1]] - length * n])
        self.q = np.array([np.eye(3), turn.as_matrix(), turn.as_matrix(), np.eye(3)])
        self.jolt(rng, 0.1 * noise)
        self.press()
        self.touch_old[:] = self.touch_new
        self.old.rim_closure[:] = self.new.rim_closure
        self.dt = 3e-3
        self.jolt(rng, noise)
        self.jolt(rng, 0.02 * noise)

    def jolt(self, rng: np.random.Generator, size: float) -> None:
        self.x += 0.15 * size * rng.normal(size=(4, 3)) * [1.0, 1.0, 0.1]
        for b in range(4):
            self.q[b] = Rotation.from_rotvec(size * rng.normal(size=3)).as_matrix() @ self.q[b]

    def press(self, *, derive: bool = False) -> np.ndarray:
        self.w.x[:], self.w.q[:] = self.x, self.q
        touches = self.touch_old, self.touch_new
        given = self.p, self.c, self.points, self.old, self.new, *touches, None, None, self.w
        press(BodyStep(*given), self.dt, 0.03, 0.04, derive)
        return self.w.g.copy().reshape(4, 6)

    def slopes(self, step: float, check: Any = None) -> np.ndarray:
        """Return the derivatives of all forces by differences: displacements and finite turns."""
        x, q = self.x.copy(), self.q.copy()

        def forces(move: np.ndarray) -> np.ndarray:
            self.x = x + move.reshape(4, 6)[:, :3]
            self.q = Rotation.from_rotvec(move.reshape(4, 6)[:, 3:]).as_matrix() @ q
            found = self.press().ravel()
            if check:
                check()
            return found

        return fourth_order(forces, np.zeros(24), step)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("config", CONFIGS)
def test_forces_and_moments_of_all_pairs_balance(config: str, seed: int, kind: str) -> None:
    """Free bodies: forces sum to zero, and so do moments about any point, to round-off."""
    bodies = Bodies(config, seed, kind)
    g = bodies.press()
    assert np.abs(g[3, :3]).max() > 1e3
    scale = np.abs(bodies.new.parts).max()
    for f in (g, *bodies.new.parts.reshape(-1, 4, 6)):  # in all, and origin by origin
        moments = f[:, 3:] + np.cross(bodies.x, f[:, :3])
        sums = np.hstack([f[:, :3], moments]).sum(axis=0)
        assert_allclose(sums, 0.0, rtol=0.0, atol=1e-12 * scale)
    assert_allclose(bodies.new.parts.sum(axis=0), g.ravel(), rtol=0.0, atol=1e-12 * scale)
    if config == "on the rims":
        for side, (body, plate) in enumerate(((1, 0), (2, 3))):
            edge = bodies.x[body] + bodies.c.vertex[side] * bodies.q[body][:, 2]
            away = (edge - bodies.x[plate]) @ bodies.q[plate]
            gap = np.hypot(*away[:2]) - bodies.p.rim_displacement[side]
            old = bodies.old.rim_closure[side]
            push = contact_force(gap, old, 2e7, 3e4, bodies.dt)
            assert push > 1e3
            assert_allclose(bodies.new.rim_force[side], push, rtol=1e-9, atol=0.0)
    if config == "rocking":
        pushes = bodies.touch_new["push"]
        assert (pushes > 0.0).any()
        if kind == "points":
            assert (pushes == 0.0).any()
        else:  # a disc opens where the load lies outside its kern
            arms = np.linalg.norm(bodies.touch_new["centre"], axis=1) / bodies.c.radius
            assert arms.max() > 0.1
            assert arms.max() < 1.0 + 1e-12


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("config", CONFIGS)
def test_forces_turn_with_the_bodies(config: str, kind: str) -> None:
    """A rigid motion of all four bodies, however large, only turns what acts on them."""
    bodies = Bodies(config, 5, kind)
    before = bodies.press()
    turn = Rotation.from_rotvec([0.8, -0.5, 1.7]).as_matrix()
    shift = np.array([0.3, -2.0, 0.7])
    bodies.x = bodies.x @ turn.T + shift
    bodies.q = turn @ bodies.q
    after = bodies.press()
    expected = np.hstack([before[:, :3] @ turn.T, before[:, 3:] @ turn.T])
    scale = np.abs(before).max()
    # places move by 2 m: 4e-16 m of round-off times 3e8 N/m
    assert_allclose(after / scale, expected / scale, rtol=0.0, atol=1e-10)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("config", CONFIGS)
def test_derivative_of_all_forces(config: str, seed: int, kind: str) -> None:
    """24 columns: displacements, and spins (finite turns) of each body, against differences."""
    bodies = Bodies(config, 20 + seed, kind)
    bodies.touch_old["push"] *= 0.7
    bodies.press(derive=True)
    k = bodies.w.k.copy()
    touching = bodies.touch_new["push"] > 0.0
    slipping = bodies.touch_new["slid"] > 0.0
    assert touching.any()

    def no_corner() -> None:
        assert (touching == (bodies.touch_new["push"] > 0.0)).all()
        if bodies.bearing.friction_law != "bouc-wen":
            assert (slipping == (bodies.touch_new["slid"] > 0.0)).all()

    expected = bodies.slopes(2e-8, no_corner)
    scale = np.abs(k).max()
    assert scale > 1e8
    # round-off 1e-16 m over 2e-8 m; an arm of 0.1 m times a force of 1e4 N would show as 1e-6
    assert_allclose(k / scale, expected / scale, rtol=0.0, atol=3e-8)


def test_inverse_of_the_sliders_matrix() -> None:
    """With exchanged rows, by columns; a singular matrix has none."""
    rng = np.random.default_rng(5)
    w = one(SCRATCH)
    for _ in range(20):
        matrix = rng.normal(size=(12, 12)) * 10.0 ** rng.uniform(-3.0, 3.0, size=(12, 1))
        matrix[0, 0], matrix[3, 4] = 0.0, 0.0
        w.joint[:, :12] = matrix
        assert invert(w)
        assert_allclose(w.joint[:, 12:].T @ matrix, np.eye(12), rtol=0.0, atol=1e-9)
    matrix[7] = matrix[2]
    matrix[:, 5] = 0.0
    w.joint[:, :12] = matrix
    assert not invert(w)


def test_quaternions_against_scipy() -> None:
    rng = np.random.default_rng(0)
    for size in (1e-12, 1e-5, 1e-4, 0.3, 3.0):
        start = Rotation.from_rotvec(rng.normal(size=3))
        vector = rng.normal(size=3)
        vector *= size / np.linalg.norm(vector)
        first, out, q = start.as_quat(scalar_first=True), np.zeros(4), np.zeros((3, 3))
        turn_by(first, *vector, out)
        expected = Rotation.from_rotvec(vector) * start
        matrix_of(out, q)
        assert_allclose(q, expected.as_matrix(), rtol=0.0, atol=1e-15)
        assert_allclose(np.linalg.norm(out), 1.0, rtol=0.0, atol=1e-15)
        assert_allclose(turn_between(first, out), vector, rtol=1e-14, atol=1e-15)
        assert_allclose(turn_between(first, -out), vector, rtol=1e-14, atol=1e-15)


def test_point_in_axes_of_its_carrier() -> None:
    w, rng = one(SCRATCH), np.random.default_rng(1)
    w.x[:] = rng.normal(size=(4, 3))
    w.q[:] = Rotation.from_rotvec(rng.normal(size=(4, 3))).as_matrix()
    locate(w, 2, 3, 0.1, -0.2, 0.3, 0.7)
    place = w.x[2] + w.q[2] @ [0.1, -0.2, 0.3]
    assert_allclose(w.arm[0], place - w.x[2], rtol=0.0, atol=1e-15)
    assert_allclose(w.arm[1], place - w.x[3], rtol=0.0, atol=1e-15)
    expected = w.q[3].T @ (place - w.x[3]) - [0.0, 0.0, 0.7]
    assert_allclose(w.d, expected, rtol=0.0, atol=1e-15)


def test_linear_system() -> None:
    rng = np.random.default_rng(2)
    for n, m in ((1, 1), (12, 1), (12, 12), (18, 1)):
        a, right = rng.normal(size=(18, 18)), rng.normal(size=(18, 12))
        a[0, 0] = 0.0 if n > 1 else 1.0  # needs its pivots
        expected = np.linalg.solve(a[:n, :n], right[:n, :m])
        rest = right[n:].copy()
        assert solve_many(a.copy(), right, n, m)
        assert_allclose(right[:n, :m], expected, rtol=1e-11, atol=1e-12)
        assert_array_equal(right[n:], rest)
    singular = np.ones((18, 18))
    assert not solve_many(singular, rng.normal(size=(18, 12)), 12, 1)
