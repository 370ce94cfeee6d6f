"""Properties of the element that hold for every bearing and every motion.

All numbers here are relative to the largest force, or stiffness, of the case; `lab` (conftest.py)
makes the bearings and the motions.
"""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation

from lir_element import AnalysisError, CoulombFriction, Element, LIRBearing, VelocityFriction
from tests.plain import DEVICE, forces_both_ways
from tests.properties.conftest import differences

STILL = np.zeros(12)
PRESSED = 1e-5 * np.eye(12)[8]  # m: off the corner of friction where the axial force stays
STATE_NAMES = tuple(Element.responses())
# Round-off of the inner equilibrium (1e-12 of N L), carried along a history of some 400 steps.
HISTORY = {"rtol": 0.0, "atol": 1e-9}


WORKS = (
    "work_friction",
    "work_interface",
    "work_elastic",
    "work_owed",
    "work_step",
    "work_rim",
    "work_contact",
    "travel",
    "interface_travel",
    "largest_slip",
)


def snapshot(element: Element, without: tuple[str, ...] = ()) -> bytes:
    """Return the bits of all responses."""
    names = [name for name in STATE_NAMES if name not in without]
    return b"".join(np.asarray(element.response(name)).tobytes() for name in names)


def blocks(matrix: np.ndarray) -> np.ndarray:
    """Return the transformation of twelve entries that applies `matrix` to each three."""
    return np.kron(np.eye(4), matrix)


# ------------------------------------------------------------------------------- tangent


def tangent_error(element: Element, u: np.ndarray, time: float, step: float = 4e-7) -> float | None:
    """Return the error of the tangent over its largest entry; None where a corner lies near.

    A corner (start of slip, of rim contact) within the differences shows as a disagreement of two
    steps. Without one they agree to some 2e-9 (round-off over step), measured.
    """
    element.set_trial(u, STILL, time)
    k = element.tangent_stiffness()
    scale = max(np.abs(k).max(), 1.0)  # N/m: zero where lifted
    coarse, fine = (differences(element, u, time, s) for s in (2.0 * step, step))
    element.set_trial(u, STILL, time)
    if np.abs(coarse - fine).max() > 2e-8 * scale:
        return None
    return float(np.abs(k - coarse).max() / scale)


def test_tangent_along_a_motion(variant: str, lab: SimpleNamespace) -> None:
    """Dynamic (dt > 0) and static (dt = 0) tangent, oblique motion, tilted and twisting plates."""
    bearing = lab.make(variant)
    u, time = lab.smooth_path(bearing, 11, 320)
    errors: list[float | None] = []

    def visit(element: Element, k: int) -> None:
        if k % 16 == 9:
            at = u[k] - PRESSED
            errors.extend(tangent_error(element, at, t) for t in (time[k], time[k - 1]))
            element.set_trial(u[k], STILL, time[k])

    lab.walk(bearing, u, time, visit=visit)
    smooth = [e for e in errors if e is not None]
    assert len(smooth) >= 0.8 * len(errors)  # corners are rare
    # Two steps agree to 2e-8; a term of 1 % of W/L would show as 2e-6.
    assert_allclose(smooth, 0.0, rtol=0.0, atol=3e-8)


def state_at(lab: SimpleNamespace, bearing: LIRBearing, corners: list, load: float) -> tuple:
    """Take a bearing to the last corner (lateral, tilts); return element, displacement, time."""
    element, time, at = Element(bearing), 0.0, np.zeros(8)
    for corner in corners:
        for share in np.linspace(0.0, 1.0, 41)[1:]:
            x = at + share * (np.array(corner) - at)
            u = np.zeros(12)
            u[6:8], u[3:6], u[9:12] = x[:2], x[2:5], x[5:8]
            u[8] = lab.vertical(bearing, u, load)
            time += 0.01
            element.set_trial(u, STILL, time)
            element.commit()
        at = np.array(corner)
    return element, u, time


TILT = np.array([0.002, -0.003, 0.003, -0.002, 0.001, -0.01])
REGIMES = {
    # name: (last corners as multiples of the capacity, load [N], step beyond, what to see)
    "sticking": ([(0.3, 0.1)], 9e4, -2e-4),
    "sliding": ([(0.3, 0.1)], 9e4, 2e-3),
    "rim": ([(1.1, 0.0)], 9e4, 2e-4),
    "slipping on the rim": ([(1.25, 0.3)], 9e4, 2e-3),
    "along the rim": ([(1.2, 0.2), (1.1, 0.65)], 9e4, 2e-3),
    "off the rim": ([(1.2, 0.2), (0.2, -0.3)], 9e4, 2e-3),
    "partial uplift": ([(0.6, 0.5)], 9e4, 2e-3),
    "partial uplift on the rim": ([(1.2, 0.5)], 9e4, 2e-3),
}


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("law", ["elastic-plastic", "bouc-wen"])
@pytest.mark.parametrize("mu_h", [0.13, math.inf])
@pytest.mark.parametrize("regime", REGIMES)
@pytest.mark.meant("design_load")  # far beyond the slider's, on purpose
def test_tangent_in_each_regime(
    regime: str, mu_h: float, law: str, sign: float, lab: SimpleNamespace
) -> None:
    corners, load, beyond = REGIMES[regime]
    bearing = lab.make(
        "coulomb",
        friction=(VelocityFriction(0.06, 0.03, 9.0), CoulombFriction(0.08)),
        interface_friction=mu_h,
        friction_law=law,
        torsional_friction=True,
        design_load=2e7,  # fades below 20 kN
        slider_height=0.25,  # more than the settlement under that load
        axial_damping=0.0 if regime.startswith("partial") else None,  # the damper would open it
    )
    reach = bearing.lateral_capacity
    tilt = TILT * np.array([sign, sign, 1.0] * 2)
    full = [(sign * x * reach, sign * y * reach, *tilt) for x, y in corners]
    element, u, time = state_at(lab, bearing, full, load)
    fading = regime.startswith("partial")
    if fading:  # l^2 = |c|^2 - |s|^2: the load that the geometry alone would give
        slip = element.response("slip")
        load = 1.3e4 + 0.5e8 * slip @ slip / bearing.effective_radius
    errors = []
    for scale in (0.7, 1.0, 1.3):
        moved = u.copy()
        moved[6:8] += sign * scale * beyond * np.array([1.0, 0.35])
        moved[11] += 1e-3 * (scale - 0.9)  # torsion: off its corner, on and back
        moved[8] = lab.vertical(bearing, moved, load * (1.0 + 0.1 * scale))
        for when in (time + 0.01, time):
            errors.append(tangent_error(element, moved, when))
            hysteresis = np.linalg.norm(element.response("hysteresis"), axis=1).max()
            if regime == "sticking":
                assert hysteresis < 0.999 or law == "bouc-wen"
            if regime == "sliding":
                assert hysteresis > 0.9
            if "on the rim" in regime or regime in {"rim", "along the rim"}:
                assert element.response("rim_force").max() > 0.0
            if fading and when == time:
                assert 0.0 < element.response("axial_force") < 2e4
            if regime in {"slipping on the rim", "along the rim"} and math.isfinite(mu_h):
                assert np.linalg.norm(element.response("interface_hysteresis")) > 0.9
    smooth = [e for e in errors if e is not None]
    assert len(smooth) >= 3
    assert_allclose(smooth, 0.0, rtol=0.0, atol=5e-8)  # two difference steps agree to 2e-8


def test_tangent_of_a_lifted_bearing_is_zero(variant: str, lab: SimpleNamespace) -> None:
    element = Element(lab.make(variant))
    u = np.array([0, 0, 0, 0.01, 0.0, 0.002, 0.03, -0.02, 0.05, 0.0, 0.01, 0.0])
    element.set_trial(u, STILL, 0.1)
    assert_array_equal(element.tangent_stiffness(), np.zeros((12, 12)))
    assert_array_equal(element.resisting_force(), STILL)
    assert element.response("axial_force") == 0.0


def test_tangent_is_none_of_the_callers_business(lab: SimpleNamespace) -> None:
    """What a caller does to a returned array does not reach the element."""
    element = Element(lab.make("coulomb"))
    u = np.zeros(12)
    u[8] = -1e-3
    element.set_trial(u, STILL, 0.0)
    for get in (element.tangent_stiffness, element.resisting_force, element.initial_stiffness):
        kept = get()
        get()[:] = 7.0
        assert_array_equal(get(), kept)


def factors(bearing: LIRBearing, load: np.ndarray, temperature: np.ndarray) -> np.ndarray:
    """Return k_p k_T of a surface under axial forces at temperatures, by the public laws."""
    found = np.ones_like(load)
    if bearing.pressure_dependence is not None:
        pressure = load / (math.pi * bearing.slider_radius**2)
        found = found * np.vectorize(bearing.pressure_dependence.factor)(pressure)
    if bearing.friction_heating is not None:
        found = found * np.vectorize(bearing.friction_heating.factor)(temperature)
    return found


def test_initial_stiffness(variant: str, lab: SimpleNamespace) -> None:
    """Closed form: contact k_v; laterally two surfaces and the interface in series, less N / L.

    The restoring part is small beside friction's elasticity: checked against the tangent at the
    design load; here the springs, mu N / u_y each, through the slider's axis as a lever.
    """
    bearing = lab.make(variant)
    element = Element(bearing)
    before = snapshot(element)
    k = element.initial_stiffness()
    assert snapshot(element) == before
    load = bearing.resolved()["design_load"]
    axial = bearing.resolved()["axial_stiffness"]
    length = bearing.effective_radius + load / axial
    left = factors(bearing, load, Element(bearing).response("temperature")[0])
    turn = sum(
        r * r * law.f_min * left * load / bearing.yield_displacement
        for r, law in zip(bearing.radii, bearing.frictions, strict=True)
    )
    if math.isinf(bearing.interface_friction):
        lateral = turn / length**2 + load / length
    else:  # axis turned by eta, slip U - l eta: stationary strain energy
        held = bearing.interface_friction * load + bearing.interface_hold
        spring = held / bearing.interface_yield_displacement
        k_ue, k_ee = -spring * length + load, turn + spring * length**2 - load * length
        lateral = spring - k_ue**2 / k_ee
    assert_allclose(k[8, 8], axial, rtol=1e-9, atol=0.0)  # round-off of the string's length
    # Exact at small displacement; 1e-9 of the solver's equilibrium.
    assert_allclose([k[6, 6], k[7, 7]], lateral, rtol=1e-8, atol=0.0)
    assert_allclose(k[6:9, 0:3], -k[6:9, 6:9], rtol=0.0, atol=1e-9 * axial)


# ------------------------------------------------------------------------------- symmetries


@given(angle=st.floats(-math.pi, math.pi), seed=st.integers(0, 10_000))
@example(angle=0.5, seed=1170)  # 'bouc_wen': round-off of the spin's balance ends a joint search
@settings(max_examples=3)
def test_rotated_about_the_vertical(
    variant: str, lab: SimpleNamespace, angle: float, seed: int
) -> None:
    bearing = lab.make(variant)
    u, time = lab.smooth_path(bearing, seed, 160)
    turn = blocks(Rotation.from_rotvec([0.0, 0.0, angle]).as_matrix())
    one, two = lab.walk(bearing, u, time), lab.walk(bearing, u @ turn.T, time)
    scale = np.abs(one.resisting).max()
    assert_allclose(two.resisting / scale, one.resisting @ turn.T / scale, **HISTORY)


@pytest.mark.parametrize(
    "signs",
    [(-1, -1, 1, -1, -1, 1), (-1, 1, 1, 1, -1, -1), (1, -1, 1, -1, 1, -1)],
    ids=["reversed", "mirrored in x", "mirrored in y"],
)
def test_mirrored_motion(variant: str, signs: tuple[int, ...], lab: SimpleNamespace) -> None:
    """u -> -u (half a turn about z), and mirror planes: rotations are axial vectors."""
    bearing = lab.make(variant)
    u, time = lab.smooth_path(bearing, 5, 400)
    flip = np.tile(signs, 2)
    one, two = lab.walk(bearing, u, time), lab.walk(bearing, u * flip, time)
    assert np.abs(one.resisting[:, 6]).max() > 1e3
    scale = np.abs(one.resisting).max()
    # Only signs change: differences can come from the order of sums alone.
    assert_allclose(two.resisting / scale, one.resisting * flip / scale, rtol=0.0, atol=1e-12)


def test_turned_upside_down(variant: str, lab: SimpleNamespace) -> None:
    """Exchange the plates (radii, friction, rims, thickness) and turn everything by pi about x.

    The forces agree. The moments differ by the couple s x F_h, which the element hands to the
    bottom plate, whichever that is: the axes of its interface turn with that plate. They come from
    the plate's by the least rotation that takes e_i to n, whose spin is (e_i + n) / (1 + n_z)
    times that of the plate about e_i.
    """
    bearing = lab.make(variant)
    swap = {
        name: tuple(getattr(bearing, name))[::-1]
        for name in ("radius", "friction", "rims", "plate_thickness")
        if isinstance(getattr(bearing, name), tuple)
    }
    other = lab.make(variant, **swap)
    u, time = lab.smooth_path(bearing, 8, 400, tilt=0.0, twist=0.0)
    flip = np.array([1, -1, -1, 1, -1, -1])
    turned = np.hstack([u[:, 6:] * flip, u[:, :6] * flip])
    names = ("rim_force", "slip", "interface_force", "slider_displacement")
    one, two = lab.walk(bearing, u, time, names), lab.walk(other, turned, time, names)
    expected = np.hstack([one.resisting[:, 6:] * flip, one.resisting[:, :6] * flip])
    if math.isfinite(bearing.interface_friction):
        up = np.array([0.0, 0.0, 1.0])
        axis = up - one.slider_displacement[:, 0] / bearing.radii[0]
        couple = one.slip[:, 0] * one.interface_force[:, 1]
        couple -= one.slip[:, 1] * one.interface_force[:, 0]
        moment = couple[:, None] * (axis + up) / (1.0 + axis[:, 2:]) * flip[:3]
        expected[:, 3:6] -= moment
        expected[:, 9:12] += moment
    scale = np.abs(one.resisting).max()
    assert_allclose(two.resisting / scale, expected / scale, **HISTORY)
    assert_allclose(two.rim_force / scale, one.rim_force[:, ::-1] / scale, **HISTORY)


def test_translated_motion(variant: str, lab: SimpleNamespace) -> None:
    """A rigid translation of the whole bearing, growing in time, changes nothing."""
    bearing = lab.make(variant)
    u, time = lab.smooth_path(bearing, 6, 400)
    shift = np.outer(time, [0.4, -0.3, 0.2])
    moved = u.copy()
    moved[:, 0:3] += shift
    moved[:, 6:9] += shift
    one, two = lab.walk(bearing, u, time), lab.walk(bearing, moved, time)
    scale = np.abs(one.resisting).max()
    assert_allclose(two.resisting / scale, one.resisting / scale, **HISTORY)


def superpose(bearing: LIRBearing, u: np.ndarray, turns: Rotation) -> np.ndarray:
    """Rotate both nodes of a path (n, 12) rigidly about node i's place by `turns` (n)."""
    top = np.array([0.0, 0.0, bearing.height])
    out = np.empty_like(u)
    out[:, 0:3] = turns.apply(u[:, 0:3])
    out[:, 6:9] = turns.apply(u[:, 6:9] + top) - top
    out[:, 3:6] = (turns * Rotation.from_rotvec(u[:, 3:6])).as_rotvec()
    out[:, 9:12] = (turns * Rotation.from_rotvec(u[:, 9:12])).as_rotvec()
    return out


@given(
    vector=st.tuples(*[st.floats(-0.5, 0.5)] * 3),
    rate=st.tuples(*[st.floats(-1.0, 1.0)] * 3),
)
@settings(max_examples=4)
def test_rigid_rotation_of_the_bearing(
    variant: str, lab: SimpleNamespace, vector: tuple, rate: tuple
) -> None:
    """A rigid rotation, also one that grows in time, only turns the forces.

    Without torsional friction, which is defined about the global vertical.
    """
    bearing = lab.make(variant, torsional_friction=False)
    u, time = lab.smooth_path(bearing, 21, 120)
    size = time[:, None] / time[-1]
    turns = Rotation.from_rotvec(size * np.array(vector) + size**2 * np.array(rate))
    one = lab.walk(bearing, u, time)
    two = lab.walk(bearing, superpose(bearing, u, turns), time)
    scale = np.abs(one.resisting).max()
    expected = np.hstack([turns.apply(one.resisting[:, k : k + 3]) for k in (0, 3, 6, 9)])
    assert_allclose(two.resisting / scale, expected / scale, **HISTORY)


def test_rotation_about_the_vertical_with_torsion(lab: SimpleNamespace) -> None:
    bearing = lab.make("torsion")
    u, time = lab.smooth_path(bearing, 22, 300, tilt=0.0)
    turns = Rotation.from_rotvec(np.outer(time, [0.0, 0.0, 0.3]))
    one = lab.walk(bearing, u, time, ("torque",))
    two = lab.walk(bearing, superpose(bearing, u, turns), time)
    assert np.abs(one.torque).max() > 100.0
    scale = np.abs(one.resisting).max()
    expected = np.hstack([turns.apply(one.resisting[:, k : k + 3]) for k in (0, 3, 6, 9)])
    assert_allclose(two.resisting / scale, expected / scale, **HISTORY)


# ------------------------------------------------------------------------------- equilibrium


def equilibrium_error(bearing: LIRBearing, u: np.ndarray, f: np.ndarray) -> float:
    """Return the imbalance of forces and moments over the largest term."""
    arm = u[6:9] - u[0:3] + np.array([0.0, 0.0, bearing.height])
    cross = np.cross(arm, f[6:9])
    forces = np.abs(f[0:3] + f[6:9]).max() / max(np.abs(f[[0, 1, 2, 6, 7, 8]]).max(), 1.0)
    moments = np.abs(f[3:6] + f[9:12] + cross).max()
    # the largest term: force times the levers, which reach to the spheres' centres
    lever = max(bearing.radii) * np.abs(f[6:9]).max()
    return max(forces, moments / max(lever, np.abs(f).max(), 1.0))


@pytest.mark.parametrize("tilt", [0.0, 0.02, 0.3])
def test_forces_and_moments_balance(variant: str, tilt: float, lab: SimpleNamespace) -> None:
    """Finite rotations of both plates: forces sum to zero, m_i + m_j + (x_j - x_i) x f_j = 0."""
    changes = {"rims": None, "capacity": math.inf} if tilt > 0.1 else {}
    bearing = lab.make(variant, rim_overrun=0.2, **changes)
    u, time = lab.smooth_path(bearing, 31, 300, tilt=tilt, twist=2.0 * tilt, swing=1.3)
    r = lab.walk(bearing, u, time)
    errors = [equilibrium_error(bearing, a, f) for a, f in zip(u, r.resisting, strict=True)]
    assert np.abs(r.resisting).max() > 1e4
    assert_allclose(errors, 0.0, rtol=0.0, atol=1e-13)  # round-off of some ten operations


def test_moments_from_the_contact_forces(variant: str, lab: SimpleNamespace) -> None:
    """The moment on each node, from friction, rim and string forces acting where they act.

    On the top plate: string force and interface force pass through (node j's sphere centre) plus
    the friction and rim force at the surface, each R_2 away from the centre along the axis. All
    from the responses, in global axes, by statics of the top plate alone.
    """
    bearing = lab.make(variant, torsional_friction=False)
    u, time = lab.smooth_path(bearing, 33, 300, tilt=0.01, twist=0.0)
    names = ("slider_displacement", "axial_force", "rim_force", "friction_force", "eccentricity")
    r = lab.walk(bearing, u, time, names)
    t_j = np.broadcast_to(bearing.plate_thickness, 2)[1]
    turn = Rotation.from_rotvec(u[:, 9:12])
    e_j = turn.apply(np.array([0.0, 0.0, 1.0]))
    axis = e_j - r.slider_displacement[:, 1] / bearing.radii[1]
    arm = -(bearing.radii[1] + t_j) * e_j  # from node j to the sphere's centre
    about_centre = r.resisting[:, 9:12] - np.cross(arm, r.resisting[:, 6:9])
    radial = axis - np.sum(axis * e_j, axis=1)[:, None] * e_j
    size = np.linalg.norm(radial, axis=1)
    assert_allclose(bearing.radii[1] * size, r.eccentricity[:, 1], rtol=0.0, atol=1e-12)
    rim = -r.rim_force[:, 1, None] * radial / np.maximum(size, 1e-12)[:, None]
    # What friction adds lies in the tangent plane with the size of the friction force.
    friction = about_centre - bearing.radii[1] * np.cross(axis, rim)
    expected = bearing.radii[1] * np.linalg.norm(r.friction_force[:, 1], axis=1)
    scale = expected.max()
    assert_allclose(np.linalg.norm(friction, axis=1), expected, rtol=0.0, atol=1e-9 * scale)
    assert_allclose(np.sum(friction * axis, axis=1), 0.0, rtol=0.0, atol=1e-9 * scale)


def test_axial_force_from_the_string(variant: str, lab: SimpleNamespace) -> None:
    """N = k_v (l - L), static, with l = -n . (C2 - C1) from the geometry of conventions.md."""
    bearing = lab.make(variant)
    u, time = lab.smooth_path(bearing, 35, 300)
    names = ("slider_displacement", "axial_force", "slip_total", "string")
    r = lab.walk(bearing, u, 0.0 * time, names)
    t_i, t_j = np.broadcast_to(bearing.plate_thickness, 2)
    up = np.array([0.0, 0.0, 1.0])
    e_i = Rotation.from_rotvec(u[:, 3:6]).apply(up)
    e_j = Rotation.from_rotvec(u[:, 9:12]).apply(up)
    c = u[:, 6:9] - u[:, 0:3] + bearing.height * up
    c -= (bearing.radii[0] + t_i) * e_i + (bearing.radii[1] + t_j) * e_j
    for k, e in enumerate((e_i, e_j)):  # one axis from either surface's sliding
        axis = e - r.slider_displacement[:, k] / bearing.radii[k]
        string = -np.sum(axis * c, axis=1)
        slip = c + string[:, None] * axis
        assert_allclose(np.linalg.norm(axis, axis=1), 1.0, rtol=0.0, atol=1e-14)
        assert_allclose(r.string, string, rtol=0.0, atol=1e-14)
        assert_allclose(r.slip_total, slip, rtol=0.0, atol=1e-14)
    expected = bearing.resolved()["axial_stiffness"] * (string - bearing.effective_radius)
    # 1e-15 m times the stiffness, in newtons
    assert_allclose(r.axial_force, np.maximum(expected, 0.0), rtol=0.0, atol=1e-6)


# ------------------------------------------------------------------------------- bounds


@given(seed=st.integers(0, 10_000))
@settings(max_examples=3)
def test_friction_and_contact_stay_within_bounds(
    variant: str, lab: SimpleNamespace, seed: int
) -> None:
    """Cones never exceeded, N >= 0, nothing when lifted; motions with uplift and landing."""
    bearing = lab.make(variant)
    u, time = lab.smooth_path(bearing, seed, 250, swing=1.6)
    names = (
        "axial_force",
        "friction_force",
        "friction_coefficient",
        "interface_force",
        "rim_force",
        "hysteresis",
        "interface_hysteresis",
        "torque",
        "closure",
        "string",
        "temperature",
    )
    r = lab.walk(bearing, u, time, names)
    start = Element(bearing).response("temperature")
    warm = np.vstack([start, r.temperature[:-1]])  # that of its start governs a step
    size = np.linalg.norm(r.friction_force, axis=-1)
    limit = r.friction_coefficient * r.axial_force[:, None]
    # |z| <= 1 to an ulp or two
    assert (size <= limit * (1.0 + 1e-14)).all()
    for k, law in enumerate(bearing.frictions):
        left = factors(bearing, r.axial_force, warm[:, k])
        assert (r.friction_coefficient[:, k] >= left * law.f_min * (1.0 - 1e-14)).all()
        assert (r.friction_coefficient[:, k] <= left * law.f_max * (1.0 + 1e-15)).all()
    if math.isfinite(bearing.interface_friction):
        slip = np.linalg.norm(r.interface_force, axis=-1)
        held = np.where(r.axial_force > 0.0, bearing.interface_hold, 0.0)
        most = bearing.interface_friction * r.axial_force + held
        assert (slip <= most * (1.0 + 1e-14)).all()
    assert (r.axial_force >= 0.0).all()
    assert (r.rim_force >= 0.0).all()
    lifted = r.string <= bearing.effective_radius
    assert lifted.any()
    assert (~lifted).any()
    assert_array_equal(r.axial_force[lifted], 0.0)
    if math.isfinite(bearing.interface_friction):
        assert_array_equal(r.rim_force[lifted], 0.0)
    # a rigid slider caught between its rims still passes what they press
    free = lifted & (r.rim_force.max(axis=1) == 0.0)
    assert free.any()
    assert_array_equal(r.resisting[free], 0.0)
    assert_array_equal(r.torque[lifted], 0.0)
    bound = 2 / 3 * bearing.slider_radius * max(f.f_max for f in bearing.frictions)
    bound *= factors(bearing, np.zeros(1), start[:1])[0]  # unloaded and cold: the most there is
    assert (np.abs(r.torque) <= bound * r.axial_force * (1.0 + 1e-14)).all()


@given(seed=st.integers(0, 10_000))
@settings(max_examples=3)
def test_friction_dissipates(variant: str, lab: SimpleNamespace, seed: int) -> None:
    """What friction dissipates never decreases, step by step, along any motion.

    And it is of the size of mu N times the path: nothing is lost between slip and elastic sliding.
    """
    bearing = lab.make(variant)
    u, time = lab.smooth_path(bearing, seed, 400)
    names = ("work_friction", "work_interface", "axial_force", "travel")
    r = lab.walk(bearing, u, time, names)
    n = r.axial_force.max()
    assert (np.diff(r.work_friction, axis=0) >= 0.0).all()
    assert (np.diff(r.work_interface) >= 0.0).all()
    for k, law in enumerate(bearing.frictions):
        assert r.work_friction[-1, k] > 0.3 * law.f_min * 0.5 * n * r.travel[-1, k]
    if math.isinf(bearing.interface_friction):
        assert_array_equal(r.work_interface, 0.0)


# ------------------------------------------------------------------------------- trial, commit


def test_trials_are_idempotent_and_leave_the_committed_state(
    variant: str, lab: SimpleNamespace
) -> None:
    """The same trial gives the same bits, whatever was tried, or asked for, in between."""
    bearing = lab.make(variant)
    u, time = lab.smooth_path(bearing, 41, 120)
    rng = np.random.default_rng(0)

    def visit(element: Element, k: int) -> None:
        first = snapshot(element)
        tangent = element.tangent_stiffness()
        for _ in range(3):
            wild = u[k] + 2e-3 * rng.normal(size=12)
            wild[8] = lab.vertical(bearing, wild, 1e5 * rng.normal())
            element.set_trial(wild, rng.normal(size=12), time[k] + rng.uniform(0.0, 0.1))
            element.tangent_stiffness()
        element.set_trial(u[k], STILL, time[k])
        assert snapshot(element) == first
        assert_array_equal(element.tangent_stiffness(), tangent)
        assert snapshot(element) == first  # asking for the tangent changes no response

    lab.walk(bearing, u, time, visit=visit)


def test_history_does_not_depend_on_trials(variant: str, lab: SimpleNamespace) -> None:
    """A walk with wild trials, failed trials and reverts ends on the same bits."""
    bearing = lab.make(variant)
    u, time = lab.smooth_path(bearing, 43, 80)

    def visit(element: Element, k: int) -> None:
        committed = None
        if k:
            element.revert_to_last_commit()
            committed = snapshot(element)
        element.set_trial(np.roll(u[k], 1) * 0.3, STILL, time[k] + 0.4)
        with pytest.raises(AnalysisError):
            element.set_trial(np.full(12, np.nan), STILL, time[k])
        if k:
            element.revert_to_last_commit()
            assert snapshot(element) == committed
        element.set_trial(u[k], STILL, time[k])

    plain, disturbed = lab.walk(bearing, u, time), lab.walk(bearing, u, time, visit=visit)
    assert_array_equal(disturbed.resisting, plain.resisting)
    assert snapshot(disturbed.element) == snapshot(plain.element)


def test_revert_to_start_is_a_new_element(variant: str, lab: SimpleNamespace) -> None:
    bearing = lab.make(variant)
    u, time = lab.smooth_path(bearing, 47, 80)
    used = lab.walk(bearing, u, time).element
    used.revert_to_start()
    assert snapshot(used, WORKS) == snapshot(Element(bearing), WORKS)
    kept = []
    for element in (used, Element(bearing)):
        for a, t in zip(u, time, strict=True):
            element.set_trial(a, STILL, t)
            element.commit()
        kept.append(snapshot(element) + element.tangent_stiffness().tobytes())
    assert kept[0] == kept[1]


def test_revert_to_start_forgets_the_works(lab: SimpleNamespace) -> None:
    bearing = lab.make("coulomb")
    used = lab.walk(bearing, *lab.smooth_path(bearing, 47, 80)).element
    used.revert_to_start()
    for name in WORKS:
        assert_array_equal(used.response(name), np.zeros_like(used.response(name)))


def test_revert_returns_the_committed_state(lab: SimpleNamespace) -> None:
    bearing = lab.make("velocity")
    u, time = lab.smooth_path(bearing, 49, 60)
    element = lab.walk(bearing, u[:40], time[:40]).element
    before = snapshot(element)
    element.set_trial(u[55], STILL, time[55])
    assert snapshot(element) != before
    element.revert_to_last_commit()
    assert snapshot(element) == before


@pytest.mark.parametrize("revert", [False, True])
def test_commit_without_a_new_trial_changes_nothing(revert: bool, lab: SimpleNamespace) -> None:
    bearing = lab.make("coulomb")
    u, time = lab.smooth_path(bearing, 51, 60)
    element = lab.walk(bearing, u, time).element
    work, travel = element.response("work_friction"), element.response("travel")
    if revert:
        element.revert_to_last_commit()
    element.commit()
    assert_array_equal(element.response("travel"), travel)
    assert_array_equal(element.response("work_friction"), work)


def test_failed_trial_keeps_the_committed_state(lab: SimpleNamespace) -> None:
    """Not a number, and a top plate beyond the sphere: reported with time and cause."""
    bearing = lab.make("no_rims")
    u, time = lab.smooth_path(bearing, 53, 60)
    element = lab.walk(bearing, u, time).element
    before = snapshot(element)
    for entry, value, status in (
        (4, math.nan, "NOT_FINITE"),
        (7, math.inf, "NOT_FINITE"),
        (6, 100.0, "SPHERE_EXCEEDED"),
        (6, -100.0, "SPHERE_EXCEEDED"),
    ):
        wrong = u[-1].copy()
        wrong[entry] = value
        with pytest.raises(AnalysisError, match=r"at t = 2\.5 s, bearing element") as caught:
            element.set_trial(wrong, STILL, 2.5)
        assert caught.value.status.name == status
        assert caught.value.time == 2.5
        assert snapshot(element) == before
    with pytest.raises(AnalysisError):
        element.set_trial(u[-1], np.full(12, math.nan), 2.5)
    assert snapshot(element) == before


@pytest.mark.parametrize("time", [math.nan, math.inf])
def test_time_must_be_finite(time: float, lab: SimpleNamespace) -> None:
    element = Element(lab.make("coulomb"))
    with pytest.raises((AnalysisError, ValueError)):
        element.set_trial(np.zeros(12), STILL, time)


def test_tangent_after_a_failed_trial_is_that_of_the_committed_state(lab: SimpleNamespace) -> None:
    bearing = lab.make("coulomb")
    u, time = lab.smooth_path(bearing, 55, 60)
    element = lab.walk(bearing, u, time).element
    element.revert_to_last_commit()
    expected = element.tangent_stiffness()
    wrong = u[-1].copy()
    wrong[6] = 100.0
    with pytest.raises(AnalysisError):
        element.set_trial(wrong, STILL, 2.5)
    scale = np.abs(expected).max()
    assert_allclose(element.tangent_stiffness() / scale, expected / scale, rtol=0.0, atol=1e-9)


@pytest.mark.meant("rim_stiffness")  # a rim that gives way early, on purpose
def test_limits_are_reported_at_commit(lab: SimpleNamespace) -> None:
    """Beyond slip_capacity and rim_overrun: a trial passes, the commit raises with the value."""
    for changes, status, words in (
        ({"slip_capacity": 2e-3}, "SLIP_EXCEEDED", "slip_capacity 0.002 m"),
        ({"rim_overrun": 2e-4}, "RIM_OVERRUN", "rim_overrun 0.0002 m"),
    ):
        for sign in (1.0, -1.0):
            bearing = lab.make("coulomb", **changes)
            element = Element(bearing)
            with pytest.raises(AnalysisError, match=words) as caught:  # noqa: PT012
                for k in range(4000):
                    u = np.zeros(12)
                    u[6] = sign * 1e-4 * k
                    u[8] = lab.vertical(bearing, u, 1e5)
                    element.set_trial(u, STILL, 0.01 * k)
                    element.commit()
            assert caught.value.status.name == status
            assert caught.value.status.is_bearing_failure
            # it is committed all the same
            reached = element.response("displacement")
            assert_array_equal(reached, u)
            if status == "SLIP_EXCEEDED":
                assert 2e-3 < np.linalg.norm(element.response("slip")) < 2.2e-3
            else:
                assert 2e-4 < element.response("rim_closure").max() < 4e-4


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_travels_and_largest_slip(sign: float, lab: SimpleNamespace) -> None:
    """Paths are lengths gone, whichever way; the largest slip stays when the slip goes back."""
    bearing = lab.make("coulomb")
    x = np.concatenate([np.linspace(a, b, 800) for a, b in ((0, 0.17), (0.17, -0.1), (-0.1, 0.05))])
    u = np.zeros((len(x), 12))
    u[:, 6] = sign * x
    for row in u:
        row[8] = lab.vertical(bearing, row, 1e5)
    names = ("travel", "interface_travel", "largest_slip", "slip", "axis")
    r = lab.walk(bearing, u, np.zeros(len(u)), names)
    tilt = np.arcsin(r.axis[:, 0])
    for k in range(2):
        gone = bearing.radii[k] * np.abs(np.diff(tilt, prepend=0.0)).sum()
        # chords for arcs: (step / R)^2 / 24
        assert_allclose(r.travel[-1, k], gone, rtol=1e-5, atol=0.0)
    slip = r.slip[:, 0]
    assert np.abs(slip).max() > 1.01 * np.abs(slip[-1]) > 1e-4
    assert_allclose(r.interface_travel[-1], np.abs(np.diff(slip)).sum(), rtol=1e-5, atol=0.0)
    assert_allclose(r.largest_slip, np.maximum.accumulate(np.abs(slip)), rtol=1e-12, atol=0.0)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_steepest_tilt(sign: float, lab: SimpleNamespace) -> None:
    """The line of centres may tilt until its cosine is 0.3 (72 degrees and a half)."""
    bearing = lab.make("no_rims", interface_friction=math.inf)
    for cosine, passes in ((0.3005, True), (0.2995, False)):
        element, u = Element(bearing), np.zeros(12)
        u[6] = sign * bearing.effective_radius * math.sqrt(1.0 - cosine**2)
        u[8] = bearing.effective_radius * (1.0 - cosine)
        if passes:
            element.set_trial(u, STILL, 0.0)
            continue
        with pytest.raises(AnalysisError) as caught:
            element.set_trial(u, STILL, 0.0)
        assert caught.value.status.name == "SPHERE_EXCEEDED"
        assert "72 degrees" in str(caught.value)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_slip_that_friction_cannot_hold(sign: float, lab: SimpleNamespace) -> None:
    """Beyond L mu_h + mu_1 R_1 + mu_2 R_2 the axial force drives the slip on: a failure."""
    bearing = lab.make(
        "coulomb",
        friction=CoulombFriction(0.01),
        interface_friction=0.03,
        slip_capacity=10.0,
        rim_overrun=1.0,
    )
    held = 0.03 * bearing.effective_radius + 0.01 * sum(bearing.radii)
    element, u, slip = Element(bearing), np.zeros(12), 0.0
    with pytest.raises(AnalysisError) as caught:  # noqa: PT012
        for x in np.arange(0.0, 0.5, 1e-4):
            u[6] = sign * x
            u[8] = lab.vertical(bearing, u, 1e5 + 0.5e8 * slip**2 / bearing.effective_radius)
            element.set_trial(u, STILL, 0.0)
            element.commit()
            slip = float(np.linalg.norm(element.response("slip")))
    assert caught.value.status.name == "SLIP_UNSTABLE"
    assert caught.value.status.is_bearing_failure
    # a step of 0.1 mm of 71 mm, and what the axial stretch adds to L
    assert_allclose(slip, held, rtol=3e-3, atol=0.0)


@pytest.mark.parametrize("shape", [(11,), (13,), (12, 1), (1, 12), (2, 6), ()])
def test_wrong_shapes(shape: tuple[int, ...], lab: SimpleNamespace) -> None:
    element = Element(lab.make("coulomb"))
    with pytest.raises(ValueError, match=r"displacement has shape .*\(12,\)"):
        element.set_trial(np.zeros(shape), STILL, 0.0)
    with pytest.raises(ValueError, match=r"velocity has shape .*\(12,\)"):
        element.set_trial(STILL, np.zeros(shape), 0.0)


def test_unknown_level_and_response(lab: SimpleNamespace) -> None:
    bearing = lab.make("coulomb")
    with pytest.raises(ValueError, match=r"level = 'rigid'.*pendulum"):
        Element(bearing, level="rigid")  # type: ignore[arg-type]
    element = Element(bearing)
    with pytest.raises(KeyError, match=r"slop.*interface_force"):
        element.response("slop")
    for name, text in Element.responses().items():
        assert np.isfinite(element.response(name)).all()
        assert text.endswith("]")


# ------------------------------------------------------------------------------- neutral values


def test_fused_slider_is_the_dcfp(lab: SimpleNamespace) -> None:
    bearing = lab.make("velocity")
    u, time = lab.smooth_path(bearing, 61, 300)
    one = lab.walk(bearing.as_dcfp(), u, time, ("rim_force", "slip"))
    two = lab.walk(lab.make("velocity", interface_friction=math.inf), u, time)
    assert one.rim_force.max() > 1e3
    assert_array_equal(one.slip, 0.0)
    assert_array_equal(one.resisting, two.resisting)


def test_very_high_interface_friction_tends_to_the_dcfp(lab: SimpleNamespace) -> None:
    """What is left is the elastic slip u_yh mu_d / mu_h: the error falls in proportion to u_yh."""
    free = {"rims": None, "capacity": math.inf}
    u, time = lab.smooth_path(lab.make("velocity"), 61, 300)
    fused = lab.walk(lab.make("velocity", interface_friction=math.inf, **free), u, time).resisting
    scale = np.abs(fused).max()
    errors = []
    for small in (2.5e-5, 2.5e-6, 2.5e-7):
        options = {"interface_friction": 0.99, "interface_yield_displacement": small, **free}
        forces = lab.walk(lab.make("velocity", **options), u, time).resisting
        errors.append(np.abs(forces - fused).max() / scale)
    assert errors[0] < 1e-2
    # first order: a tenth each time
    assert_allclose(np.diff(np.log10(errors)), -1.0, rtol=0.0, atol=0.1)


def test_no_rims_is_rims_far_away(lab: SimpleNamespace) -> None:
    far, none = lab.make("velocity", rims=(0.2, 0.25)), lab.make("velocity", rims=(math.inf,) * 2)
    u, time = lab.smooth_path(none, 63, 300)
    one = lab.walk(far, u, time, ("rim_force",))
    assert_array_equal(one.rim_force, 0.0)
    assert_array_equal(lab.walk(none, u, time).resisting, one.resisting)
    without = lab.make("velocity", rims=None, capacity=math.inf)
    assert_array_equal(lab.walk(without, u, time).resisting, one.resisting)
    near = lab.walk(lab.make("velocity"), u, time, ("rim_force",))
    assert near.rim_force.max() > 0.0  # the motion would reach the rims


def test_rate_zero_is_coulomb(lab: SimpleNamespace) -> None:
    """rate = 0 stays at f_min at every speed; f_min = f_max at f_max; very fast at f_max."""
    u, time = lab.smooth_path(lab.make("coulomb"), 65, 300)

    def forces(*laws: object) -> np.ndarray:
        return lab.walk(lab.make("coulomb", friction=laws), u, time).resisting

    coulomb = forces(CoulombFriction(0.05), CoulombFriction(0.08))
    slow = forces(VelocityFriction(0.09, 0.05, 0.0), VelocityFriction(0.1, 0.08, 0.0))
    equal = forces(VelocityFriction(0.05, 0.05, 20.0), VelocityFriction(0.08, 0.08, 20.0))
    scale = np.abs(coulomb).max()
    assert_allclose(slow / scale, coulomb / scale, **HISTORY)  # f_max - (f_max - f_min) rounds
    assert_array_equal(equal, coulomb)
    moving = forces(VelocityFriction(0.05, 0.03, 9.0), VelocityFriction(0.08, 0.05, 9.0))
    assert np.abs(moving - coulomb).max() > 1e-3 * scale


def test_no_torsion_is_plates_that_do_not_twist(lab: SimpleNamespace) -> None:
    """Plates turning together about z: no torque. Torsion off: none however they twist."""
    on, off = lab.make("torsion"), lab.make("torsion", torsional_friction=False)
    u, time = lab.smooth_path(on, 67, 300)
    together = u.copy()
    together[:, 11] = together[:, 5]
    one = lab.walk(on, together, time, ("torque",))
    assert_array_equal(one.torque, 0.0)
    assert_array_equal(one.resisting, lab.walk(off, together, time).resisting)
    twisting = lab.walk(on, u, time, ("torque",))
    without = lab.walk(off, u, time, ("torque",))
    assert_array_equal(without.torque, 0.0)
    assert np.abs(twisting.torque).max() > 100.0
    # torsion adds a couple about z and nothing else
    couple = np.zeros_like(u)
    couple[:, 11], couple[:, 5] = twisting.torque, -twisting.torque
    scale = np.abs(couple).max()
    difference = twisting.resisting - without.resisting
    assert_allclose(difference / scale, couple / scale, rtol=0.0, atol=1e-10)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_torque_of_a_twisted_bearing(sign: float, lab: SimpleNamespace) -> None:
    """Full slip: (2/3) r mu N, the full circle under uniform pressure, weakest contact.

    Elastic before: the circle's mean lever (2/3) r times the twist reaches u_y at the start.
    """
    bearing = lab.make("torsion")
    lever = 2.0 / 3.0 * bearing.slider_radius
    begin = bearing.yield_displacement / lever
    for twist, share in ((0.5 * begin, 0.5), (3.0 * begin, 1.0)):
        element = Element(bearing)
        u = np.zeros(12)
        for part in np.linspace(0.0, 1.0, 21):
            u[8] = -1e5 / bearing.resolved()["axial_stiffness"]
            u[11] = sign * part * twist
            element.set_trial(u, STILL, 0.0)
            element.commit()
        expected = sign * share * lever * 0.05 * 1e5
        assert_allclose(element.response("torque"), expected, rtol=1e-9, atol=0.0)
        f = element.resisting_force()
        assert_allclose([f[11], -f[5]], expected, rtol=1e-9, atol=0.0)
        # dissipated after the start of slip, half on each surface; T psi / 2 before it
        slipped = max(twist - begin, 0.0)
        work = 0.5 * lever * 0.05 * 1e5 * slipped
        # the step of the first slip: 0.00125 of it, half a step of elastic force
        assert_allclose(element.response("work_friction"), work, rtol=2e-3, atol=1e-9)
        elastic = 0.5 * share**2 * lever * 0.05 * 1e5 * begin
        # the step of the first slip is shared by its end points: 0.15 of begin at most
        assert_allclose(element.response("work_elastic"), elastic, rtol=0.16, atol=0.0)


def test_static_trials_take_speeds_from_the_velocities(lab: SimpleNamespace) -> None:
    """With dt = 0, plates parallel: v_k = R_k / L times the lateral velocity, in both directions.

    And with whole-bearing rigid velocities the speeds vanish: the slider only follows.
    """
    bearing = lab.make("velocity")
    length = bearing.effective_radius + 1e-3
    u = np.zeros(12)
    u[8] = -1e-3
    for direction in ((1.0, 0.0), (-0.6, 0.8), (0.0, -1.0)):
        element, v = Element(bearing), np.zeros(12)
        v[6:8] = 0.3 * np.array(direction)
        element.set_trial(u, STILL, 0.0)
        element.commit()
        element.set_trial(u, v, 0.0)
        speeds = [r / length * 0.3 for r in bearing.radii]
        assert_allclose(element.response("sliding_speed"), speeds, rtol=1e-12, atol=0.0)
        for k, law in enumerate(bearing.frictions):
            assert_allclose(
                element.response("friction_coefficient")[k],
                law.f_max - (law.f_max - law.f_min) * math.exp(-law.rate * speeds[k]),
                rtol=1e-12,
                atol=0.0,
            )
    spin = np.array([0.2, -0.1, 0.4])
    arm = np.array([0.0, 0.0, bearing.height - 1e-3])
    v = np.concatenate([np.zeros(3), spin, np.cross(spin, arm), spin])
    element = Element(bearing)
    element.set_trial(u, STILL, 0.0)
    element.commit()
    element.set_trial(u, v, 0.0)
    assert_allclose(element.response("sliding_speed"), 0.0, rtol=0.0, atol=1e-15)


def test_static_tangent_with_velocities(lab: SimpleNamespace) -> None:
    """The speeds of a static trial belong to the committed place: the tangent needs none of it."""
    bearing = lab.make("velocity")
    u, time = lab.smooth_path(bearing, 33, 120, tilt=0.02)
    element = lab.walk(bearing, u[:100], time[:100]).element
    v, now, place = 0.3 * np.random.default_rng(5).normal(size=12), time[99], u[99] + 1e-5
    element.set_trial(place, v, now)
    tangent, step = element.tangent_stiffness(), 1e-7
    difference = np.zeros((12, 12))
    for dof in range(12):
        for factor, weight in ((1, 8.0), (-1, -8.0), (2, -1.0), (-2, 1.0)):
            moved = place.copy()
            moved[dof] += factor * step
            element.set_trial(moved, v, now)
            difference[:, dof] += weight * element.resisting_force() / (12.0 * step)
    scale = np.abs(tangent).max()
    assert_allclose(tangent / scale, difference / scale, rtol=0.0, atol=1e-6)


def test_static_speeds_are_those_of_a_small_step(lab: SimpleNamespace) -> None:
    """Tilted plates, all velocities: sliding of a short step over dt tends to the static speed.

    With a fused slider, whose axis follows from geometry alone.
    """
    law = VelocityFriction(0.07, 0.03, 12.0)
    bearing = lab.make("fused", friction=law)
    u, time = lab.smooth_path(bearing, 71, 400, tilt=0.1, reach=0.8)
    rng = np.random.default_rng(2)
    for k in (60, 200, 333):
        element = lab.walk(bearing, u[: k + 1], time[: k + 1]).element
        v = 0.2 * rng.normal(size=12)
        element.set_trial(u[k], v, time[k])
        static = element.response("sliding_speed")
        assert_allclose(
            element.response("friction_coefficient"),
            [law.at_speed(speed) for speed in static],
            rtol=1e-14,
            atol=0.0,
        )
        dt = 1e-6
        moved = u[k] + dt * v
        for first in (3, 9):  # velocities of rotation are spins
            spin = Rotation.from_rotvec(dt * v[first : first + 3])
            turned = spin * Rotation.from_rotvec(u[k, first : first + 3])
            moved[first : first + 3] = turned.as_rotvec()
        element.set_trial(moved, v, time[k] + dt)
        distance = np.linalg.norm(element.response("sliding_increment"), axis=1)
        # first order in the step
        assert_allclose(distance / dt, static, rtol=2e-5, atol=0.0)


def test_speed_of_a_step_is_that_of_sliding_on(lab: SimpleNamespace) -> None:
    """dt > 0: the speed in Eq. (1) is that of sliding past the old z; unloading has none.

    That part of the sliding over dt belongs to the step's middle; half its change is added.
    """
    law = VelocityFriction(0.07, 0.03, 12.0)
    bearing = lab.make("fused", friction=law)
    for sign in (1.0, -1.0):
        element, u, before = Element(bearing), np.zeros(12), np.zeros((2, 2))
        speeds, mean_before = [], np.zeros(2)
        for k in range(60):
            u[6] = sign * 1e-4 * (k if k < 40 else 79 - k)
            u[8] = lab.vertical(bearing, u, 1e5)
            element.set_trial(u, STILL, 0.01 * k)
            element.commit()
            z = element.response("hysteresis")
            full = before + element.response("sliding_increment") / bearing.yield_displacement
            size, was = np.linalg.norm(full, axis=1), np.linalg.norm(before, axis=1)
            slip = bearing.yield_displacement * np.maximum(size - was, 0.0)
            speed = element.response("sliding_speed")
            mean = slip / 0.01 if k else np.zeros(2)
            ahead = np.where(
                (mean > 1e-9) & (mean_before > 1e-9), 1.5 * mean - 0.5 * mean_before, mean
            )
            # transport of z along the sphere: second order in a step of 1e-4 / R
            assert_allclose(speed, ahead, rtol=2e-6, atol=1e-12)
            mean_before = mean
            mu = [law.at_speed(s) for s in speed]
            assert_allclose(element.response("friction_coefficient"), mu, rtol=1e-14, atol=0.0)
            before = z
            speeds.append(speed)
        assert np.max(speeds[40:44]) == 0.0  # from z = 1 back to 0
        assert np.min(speeds[20:40]) > 3e-3
        assert np.min(speeds[-5:]) > 3e-3


# ------------------------------------------------------------------------------- contact damping


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_damping_of_the_axial_contact(sign: float, lab: SimpleNamespace) -> None:
    """Kelvin-Voigt along the axis: N = k pen + c (change of pen) / dt, but never below zero."""
    bearing = lab.make("coulomb", axial_damping=3e5)
    element = Element(bearing)
    u = np.zeros(12)
    u[8] = -1e-3
    element.set_trial(u, STILL, 0.0)
    assert_allclose(element.response("axial_force"), 1e5, rtol=1e-9, atol=0.0)
    element.commit()
    u[8] = -1e-3 - sign * 2e-4
    element.set_trial(u, STILL, 0.01)
    expected = 1e8 * (1e-3 + sign * 2e-4) + sign * 3e5 * 2e-4 / 0.01
    assert_allclose(element.response("axial_force"), expected, rtol=1e-9, atol=0.0)
    assert_allclose(element.resisting_force()[8], -expected, rtol=1e-9, atol=0.0)
    if sign < 0.0:
        u[8] = -1e-5  # opens fast: the damper would pull
        element.set_trial(u, STILL, 0.001)
        assert element.response("axial_force") == 0.0
        assert_array_equal(element.resisting_force(), STILL)


def test_default_contacts(lab: SimpleNamespace) -> None:
    """5 % and 10 % of critical damping under the design load; the rim a tenth as stiff."""
    bearing = lab.make("coulomb", axial_stiffness=None, rim_stiffness=None, rim_overrun=None)
    o = bearing.resolved()
    area = math.pi * 0.08**2
    assert_allclose(o["design_load"], 30e6 * area, rtol=1e-12, atol=0.0)
    assert_allclose(o["axial_stiffness"], 20e9 * area / 0.11, rtol=1e-12, atol=0.0)
    assert_allclose(o["rim_stiffness"], 0.1 * o["axial_stiffness"], rtol=1e-12, atol=0.0)
    mass = o["design_load"] / 9.80665
    for name, ratio in (("axial", 0.05), ("rim", 0.10)):
        critical = 2.0 * math.sqrt(o[f"{name}_stiffness"] * mass)
        assert_allclose(o[f"{name}_damping"], ratio * critical, rtol=1e-12, atol=0.0)
    assert_allclose(o["rim_overrun"], 0.008, rtol=1e-12, atol=0.0)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_rim_is_met_radially_at_its_displacement(sign: float, lab: SimpleNamespace) -> None:
    """P = k_r (d - d_max) of the plate whose rim is met; d = R sin(tilt), conventions.md."""
    for rims, k in (((0.07, math.inf), 0), ((math.inf, 0.1), 1)):
        bearing = lab.make("fused", rims=rims)
        for angle in (0.0, 0.8, 2.5):
            way = np.array([math.cos(angle), math.sin(angle)])
            element = Element(bearing)
            for part in np.linspace(0.0, 1.02, 60):
                u = np.zeros(12)
                u[6:8] = sign * part * bearing.lateral_capacity * way
                u[8] = lab.vertical(bearing, u, 1e5)
                element.set_trial(u, STILL, 0.0)
                element.commit()
            length = bearing.effective_radius + 1e-3
            radial = bearing.radii[k] * 1.02 * bearing.lateral_capacity / length
            force = 2e7 * (radial - rims[k])
            assert force > 1e3
            expected = [0.0, 0.0]
            expected[k] = force
            assert_allclose(element.response("rim_force"), expected, rtol=1e-8, atol=0.0)
            assert_allclose(element.response("eccentricity")[k], radial, rtol=1e-12, atol=0.0)


# ------------------------------------------------------------------------------- plain Python


def test_compiled_is_plain_python(lab: SimpleNamespace) -> None:
    u, time = lab.smooth_path(lab.make("coulomb"), 81, 45)
    common = DEVICE | {"rims": (0.07, 0.11)}
    bearings = [
        common | {"interface_friction": 0.15},
        common | {"interface_friction": 0.15, "friction_law": "bouc-wen"},
        common | {"interface_friction": math.inf},
    ]
    compiled, python = forces_both_ways(bearings, u, time)
    scale = np.abs(compiled).max(axis=0)
    assert np.abs(compiled[:45]).max() > 1e4
    # Round-off: contracted multiply-adds and libm, amplified by the contact's stiffness, and
    # searches that end at 1e-12.
    assert_allclose(python / scale, compiled / scale, rtol=0.0, atol=3e-12)
