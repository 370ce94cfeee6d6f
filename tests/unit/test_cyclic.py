"""The testing rig against the paper's static test (section 2.2) and against statics by hand."""

import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose
from scipy.optimize import fsolve

from lir_element import (
    AnalysisError,
    AnalysisWarning,
    CoulombFriction,
    LIRBearing,
    VelocityFriction,
    cyclic_test,
)
from tests.refusals import refused
from tests.scenes import small_bearing as bearing

W = 150e3
L, MU_D, MU_H = 1.415, 0.066, 0.126
SIGNS = pytest.mark.parametrize("sign", [1.0, -1.0])


def through(*corners: float, points: int = 400) -> np.ndarray:
    """Return a path from 0 through the corners, `points` to a branch."""
    ends = np.array([0.0, *corners])
    parts = [np.linspace(a, b, points + 1)[1:] for a, b in pairwise(ends)]
    return np.concatenate(parts)


def along_x(data: xr.Dataset, name: str) -> np.ndarray:
    return data[name].sel(axis="x")[:, 0].to_numpy()


@SIGNS
def test_static_cyclic_test_of_the_paper(sign: float) -> None:
    """First high-friction sliding at 17.5 cm; it leaves 1 cm; the next at 16.5 cm on the way back.

    Tolerance 0.3 mm: elastic sliding (0.25 mm) and the points of the path (0.46 mm apart, half).
    """
    path = sign * through(0.185, -0.185, 0.185, -0.185, 0.0)
    data = cyclic_test(bearing(), path, W)
    assert data.attrs["status"] == "ok"
    slip = sign * along_x(data, "interface_slip")
    u = sign * along_x(data, "bearing_displacement")
    moving = np.abs(np.diff(slip, prepend=0.0)) > 1e-4  # of 0.46 mm a point
    first = u[moving][0]
    assert_allclose(first, 0.175, rtol=0.0, atol=3e-4 + 4.7e-4)
    assert_allclose(slip[399], 0.010, rtol=0.0, atol=3e-4)
    second = u[moving & (np.arange(len(u)) > 400)][0]
    assert_allclose(second, -0.165, rtol=0.0, atol=3e-4 + 9.3e-4)
    # then the offset goes from one side to the other, at each turn
    assert_allclose(slip[[799, 1199, 1599]], [-0.01, 0.01, -0.01], rtol=0.0, atol=3e-4)
    force = sign * along_x(data, "bearing_force")
    limit = W * math.tan(math.asin(0.175 / L) + math.atan(MU_H))
    assert_allclose(np.abs(force[[399, 799, 1199, 1599]]), limit, rtol=5e-3, atol=0.0)
    assert np.abs(force).max() < 1.005 * limit  # the force never exceeds it
    # in fact much closer: what is left is the rim's and the contact's deformation
    assert_allclose(force[399], limit, rtol=2e-4, atol=0.0)
    assert_allclose(force[799], -limit, rtol=2e-4, atol=0.0)


def branch_work(s: float, c: float, start: float, end: float) -> float:
    """Return the integral of tan(phi + psi) (L cos phi - s sin phi) dphi, closed form.

    With chi = phi + psi and tan psi = c: sines and cosines of chi - psi expand, and
    int sin chi tan chi = arsinh(tan chi) - sin chi.
    """
    psi = math.atan(c)

    def primitive(phi: float) -> float:
        chi = phi + psi
        g = math.asinh(math.tan(chi)) - math.sin(chi)
        cosine = -math.cos(psi) * math.cos(chi) + math.sin(psi) * g
        sine = math.cos(psi) * g + math.sin(psi) * math.cos(chi)
        return L * cosine - s * sine

    return primitive(end) - primitive(start)


@SIGNS
def test_area_of_the_loop_with_rim_contacts(sign: float) -> None:
    """Closed form of a steady cycle of amplitude A beyond the capacity; rigid bodies.

    The slider's axis is tilted by phi and the sliders are offset by s, so that
    U = L sin phi + s cos phi. Its moment equilibrium (theory, section 3) in sliding with constant
    friction reads L F_h = N (s + mu (R1 + R2)), with N along the axis and F_h in the interface;
    hence the resultant is inclined by psi against the axis, tan psi = (s + mu (R1 + R2)) / L, and
    H = W tan(phi + psi). At the rim, phi = theta = arcsin(U_cap / L), the interface slips with
    H = W tan(theta + arctan mu_h). On the way up the offset is -s0 until the rim, then grows to
    s0 = (A - L sin theta) / cos theta. The way down is the mirror image, so the area is twice

        W int_(-theta)^(theta) tan(phi + psi) dU + W tan(theta + arctan mu_h) 2 s0 cos theta.
    """
    amplitude = 0.185
    path = sign * through(amplitude, -amplitude, amplitude, points=3000)
    data = cyclic_test(bearing(), path, W)
    theta = math.asin(0.175 / L)
    s_0 = (amplitude - 0.175) / math.cos(theta)
    slope = (-s_0 + MU_D * 1.5) / L
    area = branch_work(-s_0, slope, -theta, theta)
    area += math.tan(theta + math.atan(MU_H)) * 2.0 * s_0 * math.cos(theta)
    expected = 2.0 * W * area
    start, end = 2999, 8999
    u = along_x(data, "bearing_displacement")[start : end + 1]
    h = along_x(data, "bearing_force")[start : end + 1]
    assert_allclose(np.trapezoid(h, u), expected, rtol=5e-3, atol=0.0)
    counted = sum(
        data[name].to_numpy().reshape(len(path), -1).sum(axis=1)
        for name in (
            "work_low_friction",
            "work_high_friction",
            "work_friction_elastic",
            "work_rims",
            "work_contact",
        )
    )
    assert_allclose(counted[end] - counted[start], expected, rtol=5e-3, atol=0.0)
    # each mechanism: mu N times the sliding of both surfaces; mu_h N times 4 s0; N = W within 2 %
    low = data["work_low_friction"].sum("surface").to_numpy()[:, 0]
    high = data["work_high_friction"].to_numpy()[:, 0]
    assert_allclose(low[end] - low[start], MU_D * W * 1.5 * 4.0 * theta, rtol=0.02, atol=0.0)
    assert_allclose(high[end] - high[start], MU_H * W * 4.0 * s_0, rtol=0.04, atol=0.0)


R_1, R_2, H_S, MU_1, MU_2 = 0.8, 1.3, 0.12, 0.04, 0.09
UNEQUAL: dict[str, Any] = {
    "radius": (R_1, R_2),
    "slider_height": H_S,
    "slider_radius": 0.08,
    "capacity": math.inf,
    "friction": (CoulombFriction(MU_1), CoulombFriction(MU_2)),
    "interface_friction": math.inf,
}


def slider_statics(u: float, way: float) -> float:
    """Return the lateral force on the top plate over its load, from scratch.

    A rigid slider between two spheres; the plates parallel; motion towards `way`. On each surface
    the contact pressure has its centre at an angle a_k; there a normal force N_k towards the
    sphere's centre and mu_k N_k against the motion. Unknown N_1, a_1, N_2, a_2; equations: the
    slider's two forces and moment vanish, the vertical force on the top plate is one.
    """
    length = R_1 + R_2 - H_S
    phi = math.asin(u / length)
    c_2 = np.array([u, -length * math.cos(phi)])  # bottom sphere's centre at the origin

    def contacts(x: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        n_1, a_1, n_2, a_2 = x
        p_1 = R_1 * np.array([math.sin(a_1), -math.cos(a_1)])
        p_2 = c_2 + R_2 * np.array([-math.sin(a_2), math.cos(a_2)])
        tangent_1 = np.array([math.cos(a_1), math.sin(a_1)])
        tangent_2 = np.array([math.cos(a_2), math.sin(a_2)])
        f_1 = -n_1 * p_1 / R_1 - way * MU_1 * n_1 * tangent_1
        f_2 = n_2 * (c_2 - p_2) / R_2 + way * MU_2 * n_2 * tangent_2
        return p_1, f_1, p_2, f_2

    def equations(x: np.ndarray) -> list[float]:
        p_1, f_1, p_2, f_2 = contacts(x)
        turn = p_1[0] * f_1[1] - p_1[1] * f_1[0] + p_2[0] * f_2[1] - p_2[1] * f_2[0]
        return [*(f_1 + f_2), turn, f_2[1] + 1.0]

    root, _, flag, _ = fsolve(equations, [1.0, phi, 1.0, phi], xtol=1e-13, full_output=True)
    assert flag == 1 or np.abs(equations(root)).max() < 1e-11
    return float(contacts(root)[3][0])


@SIGNS
def test_dcfp_at_large_displacement(sign: float) -> None:
    """Against the statics of the slider, up to 30 degrees of tilt.

    The element puts friction at the slider's axis, the statics at the centre of pressure: the
    resultant is inclined by arctan(c) there and by arcsin(c cos(arctan mu)) here, c = sum mu R / L.
    They differ by mu^2 / 2 of friction's part, 2e-3 of it.
    """
    corners = np.linspace(-1.0, 1.0, 11)
    up = cyclic_test(LIRBearing(**UNEQUAL), sign * np.array([-1.02, *corners]), W)
    expected = np.array([sign * slider_statics(float(u), 1.0) for u in corners])
    force = along_x(up, "bearing_force")[1:] / W
    assert_allclose(force, expected, rtol=1.5e-4, atol=1.5e-4)
    assert np.abs(force).max() > 0.6


@SIGNS
def test_capacity_and_rims_in_the_rig(sign: float) -> None:
    """Unequal rims: the slider stops at the smaller d_k / R_k, and only that rim is pressed."""
    for rims, k in (((0.08, 0.2), 0), ((0.2, 0.1), 1)):
        # A stiff rim: as s grows the rim unloads, and would hand the surfaces' friction back.
        options = {"capacity": None, "rims": rims, "interface_friction": 0.15}
        b = LIRBearing(**(UNEQUAL | options | {"rim_stiffness": 1e11}))
        length = R_1 + R_2 - H_S
        capacity = length * rims[k] / (R_1, R_2)[k]
        data = cyclic_test(b, sign * np.array([0.98, 1.0 + 0.02 / capacity]) * capacity, W)
        rim = data["rim_force"].to_numpy()[:, 0]
        assert rim[0].max() == 0.0
        assert rim[1, k] > 1e3
        assert rim[1, 1 - k] == 0.0
        slip = along_x(data, "interface_slip")
        theta = math.asin(capacity / length)
        assert_allclose(slip[1], sign * 0.02 / math.cos(theta), rtol=0.02, atol=0.0)
        limit = W * math.tan(theta + math.atan(0.15))
        assert_allclose(along_x(data, "bearing_force")[1], sign * limit, rtol=1e-3, atol=0.0)
        # what the rim carries: the interface's friction less that of the surfaces, by moments
        n = float(data["axial_force"][1, 0])
        moment = n * (0.15 * length - abs(slip[1]) - MU_1 * R_1 - MU_2 * R_2)
        carried = moment / ((R_1, R_2)[k] * math.cos(theta))
        assert_allclose(rim[1, k], carried, rtol=2e-3, atol=0.0)


@pytest.mark.parametrize("velocity", [1e-3, 0.05, 0.2, 1.0])
@SIGNS
def test_friction_grows_with_the_speed(sign: float, velocity: float) -> None:
    """At the centre each surface slides at v R_k / L and Eq. (1) holds for it."""
    laws = (VelocityFriction(0.08, 0.03, 9.0), VelocityFriction(0.065, 0.0325, 15.0))
    b = LIRBearing(**(UNEQUAL | {"friction": laws}))
    data = cyclic_test(b, sign * np.array([-0.05, 0.0, 0.05]), W, velocity=velocity)
    length = R_1 + R_2 - H_S
    mu = [
        0.08 - 0.05 * math.exp(-9.0 * velocity * R_1 / length),
        0.065 - 0.0325 * math.exp(-15.0 * velocity * R_2 / length),
    ]
    assert_allclose(data["friction_coefficient"][1, 0], mu, rtol=2e-4, atol=0.0)  # l > L by N / k
    speeds = [velocity * R_1 / length, velocity * R_2 / length]
    assert_allclose(data["sliding_speed"][1, 0], speeds, rtol=2e-4, atol=0.0)
    expected = (mu[0] * R_1 + mu[1] * R_2) / length * W
    assert_allclose(along_x(data, "bearing_force")[1], sign * expected, rtol=3e-4, atol=0.0)


def test_time_follows_the_path() -> None:
    path = np.array([[0.03, 0.04], [0.03, 0.04], [-0.03, -0.04]])
    data = cyclic_test(bearing(), path, W, velocity=0.1)
    assert_allclose(data["time"], [0.5, 0.5, 1.5], rtol=1e-12, atol=0.0)
    assert_allclose(data["bearing_displacement"][:, 0, :2], path, rtol=1e-14, atol=0.0)
    velocity = data["bearing_velocity"][:, 0, :2]
    assert_allclose(velocity, [[0.06, 0.08], [0, 0], [-0.06, -0.08]], rtol=1e-12, atol=1e-15)


@SIGNS
def test_axial_load_history(sign: float) -> None:
    """The load follows its history, linear between the points; forces go with it."""
    loads = np.array([1e5, 3e5, 0.5e5, 2e5])
    data = cyclic_test(bearing(), sign * np.array([-0.1, 0.0, 0.1, 0.0]), loads)
    vertical = data["bearing_force"].sel(axis="z")[:, 0]
    assert_allclose(vertical, -loads, rtol=1e-9, atol=0.0)
    force = along_x(data, "bearing_force")
    friction = MU_D * 1.5 / L
    # axial shortening, N / k: 1e-3 of the radius at most
    assert_allclose(force[1], sign * friction * 3e5, rtol=1e-3, atol=0.0)
    assert_allclose(force[3], -sign * friction * 2e5, rtol=1e-3, atol=0.0)
    between = cyclic_test(bearing(), sign * np.array([-0.1, -0.05, 0.0]), [1e5, 2e5, 3e5])
    direct = cyclic_test(bearing(), sign * np.array([-0.1, 0.0]), [1e5, 3e5])
    ends = [along_x(each, "bearing_force")[-1] for each in (between, direct)]
    assert_allclose(*ends, rtol=1e-6, atol=0.0)


def test_axial_force_on_the_tilted_slider() -> None:
    """N cos(phi) - F_h sin(phi) = W: both by statics of the top plate (no slip, parallel)."""
    data = cyclic_test(LIRBearing(**UNEQUAL), np.array([0.6]), W)
    length = R_1 + R_2 - H_S
    phi = math.asin(0.6 / length)
    c = (MU_1 * R_1 + MU_2 * R_2) / length
    n = W / (math.cos(phi) - c * math.sin(phi))
    assert_allclose(data["axial_force"][0, 0], n, rtol=1e-4, atol=0.0)  # l > L by N / k


@pytest.mark.parametrize("angle", [0.0, 0.3, math.pi / 2, 2.0, -1.2, math.pi])
def test_oblique_path(angle: float) -> None:
    """Along any line, with rim contacts, the response is that along x, turned."""
    line = through(0.185, -0.19, 0.0, points=60)
    way = np.array([math.cos(angle), math.sin(angle)])
    one = cyclic_test(bearing(), line, W)
    two = cyclic_test(bearing(), np.outer(line, way), W)
    for name in ("bearing_force", "interface_slip"):
        x = along_x(one, name)
        scale = np.abs(x).max()
        values = two[name].to_numpy()[:, 0, :2]
        # equilibrium to 1e-12 of N L, vertical load to 1e-10
        assert_allclose(values / scale, np.outer(x, way) / scale, rtol=0.0, atol=1e-7)


@SIGNS
def test_circular_path(sign: float) -> None:
    """Steady on a circle: the restoring force radial, friction against the motion, both constant.

    Small tilt (0.05 / 1.415): forces W r / L and mu (R1 + R2) / L W, within its square and the
    lag of the friction's direction, u_y / r.
    """
    angle = sign * np.linspace(0.0, 4.0 * math.pi, 721)
    circle = 0.05 * np.column_stack([np.cos(angle), np.sin(angle)])
    data = cyclic_test(bearing(), circle, W)
    force = data["bearing_force"].to_numpy()[360:, 0, :2]
    out = circle[360:] / 0.05
    ahead = sign * np.column_stack([-out[:, 1], out[:, 0]])
    radial, tangential = np.sum(force * out, axis=1), np.sum(force * ahead, axis=1)
    friction = MU_D * 1.5 / L * W
    lag = 0.25e-3 / (0.05 * 0.75 / L) * friction
    assert_allclose(radial, 0.05 / L * W, rtol=5e-3, atol=1.5 * lag)
    assert_allclose(tangential, friction, rtol=3e-3, atol=0.0)
    assert_allclose(np.ptp(tangential), 0.0, rtol=0.0, atol=2e-3 * friction)


@SIGNS
def test_circular_path_beyond_the_rim(sign: float) -> None:
    """On a circle of 0.19 m the slider runs along the rim: |d| stays at the rim, force within cap.

    The offset trails: from 0.19 - 0.175 m it grows towards the place where it moves along itself
    and across U - s, with |s|^2 = 0.19^2 - 0.175^2.
    """
    angle = sign * np.linspace(0.0, 4.0 * math.pi, 241)
    circle = 0.19 * np.column_stack([np.cos(angle), np.sin(angle)])
    data = cyclic_test(bearing(), circle, W)
    assert data.attrs["status"] == "ok"
    sliding = data["slider_displacement"].to_numpy()[:, 0, 0, :2]
    size = np.linalg.norm(sliding, axis=1)
    rim = bearing().rim_displacement[0]
    assert (size < rim * 1.001).all()  # the rims' deformation
    assert (size > 0.9 * rim).all()
    force = np.linalg.norm(data["bearing_force"].to_numpy()[:, 0, :2], axis=1)
    assert force.max() < 1.002 * bearing().force_limit(W)
    slip = np.linalg.norm(data["interface_slip"].to_numpy()[:, 0, :2], axis=1)
    assert slip.min() > 0.0148
    assert 0.02 < slip.max() < math.sqrt(0.19**2 - 0.175**2)
    assert (np.diff(slip[120:]) > 0.0).all()


@SIGNS
def test_slip_beyond_capacity(sign: float) -> None:
    """Slip of 15 mm at U = 0.175 + 0.015 cos(theta): named with time, value, bound, remedy."""
    b = bearing(slip_capacity=0.015)
    path = sign * np.arange(1, 43) * 0.005
    with pytest.warns(AnalysisWarning, match=r"interface slipped.*slip 0\.015\d* m") as caught:
        data = cyclic_test(b, path, W, velocity=0.02)
    assert data.attrs["status"] == "slip_exceeded"
    fail = 0.175 + 0.015 * math.cos(math.asin(0.175 / L))
    # within an increment of the rig and the elastic part of the slip
    assert_allclose(data.attrs["failed_at"], fail / 0.02, rtol=2e-3, atol=0.0)
    message = str(caught[0].message)
    assert message == data.attrs["message"]
    for word in ("slip_capacity 0.015 m", "What to try", "larger slider", "bearing in the rig"):
        assert word in message
    assert f"t = {data.attrs['failed_at']:.6g} s" in message
    assert data.sizes["step"] == 37  # up to 0.185 m
    whole = cyclic_test(bearing(), path[:37], W, velocity=0.02)
    assert_allclose(data["bearing_force"], whole["bearing_force"], rtol=1e-12, atol=1e-9)


@SIGNS
def test_rim_overrun(sign: float) -> None:
    """A rigid slider driven through its rim: fails at a deformation of a tenth of r."""
    path = sign * np.linspace(0.01, 0.25, 25)
    with pytest.raises(
        AnalysisError, match=r"overran.*rim deformation 0\.008.*rim_overrun"
    ) as info:
        cyclic_test(bearing().as_dcfp(), path, W, on_failure="raise")
    error = info.value
    assert error.status.name == "RIM_OVERRUN"
    fail = L * (bearing().rim_displacement[0] + 0.008) / 0.75
    assert_allclose(error.time, fail / 0.02, rtol=5e-3, atol=0.0)  # l > L under the rims' push
    assert isinstance(error.data, xr.Dataset)
    assert error.data.sizes["step"] == 19
    assert error.data.attrs["status"] == "rim_overrun"
    assert error.where in error.data.attrs["message"]


@SIGNS
@pytest.mark.parametrize("rising", [False, True])
def test_beyond_the_spheres(sign: float, rising: bool) -> None:
    """72 degrees of tilt: U = 0.95 L; also while the load changes."""
    low = LIRBearing(**(UNEQUAL | {"friction": CoulombFriction(0.01)}))
    path = sign * np.linspace(0.1, 2.5, 25)
    loads = np.linspace(1e5, 2e5, 25) if rising else 1e5
    with pytest.raises(AnalysisError) as info:
        cyclic_test(low, path, loads, on_failure="raise")
    assert info.value.status.name == "SPHERE_EXCEEDED"
    assert_allclose(info.value.time * 0.02, 0.954 * 1.98, rtol=1e-2, atol=0.0)


MASKED = np.ma.masked_less([1e5, -1.0, 1e5], 0.0)


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("displacement", [], r" has shape \(0,\).*n >= 1"),
        ("displacement", 0.1, r" has shape \(\)"),
        ("displacement", np.zeros((3, 3)), r" has shape \(3, 3\)"),
        ("displacement", np.zeros((3, 1)), r" has shape \(3, 1\)"),
        ("displacement", np.zeros((2, 2, 2)), r" has shape \(2, 2, 2\)"),
        ("displacement", np.array([0.0, 1.0j]), " has complex"),
        ("displacement", [0.0, math.nan], r"\[1\].*not finite"),
        ("displacement", [[0.0, 0.0], [0.0, math.inf]], r"\[1\]"),
        ("axial_load", MASKED, " has 1 masked values"),
        ("axial_load", 0.0, r" = 0 N.*positive"),
        ("axial_load", -1e5, r" = -100000 N.*compression"),
        ("axial_load", math.nan, r" = nan N"),
        ("axial_load", math.inf, r" = inf N"),
        ("axial_load", [1e5, 1e5], r" has shape \(2,\).*\(3,\)"),
        ("axial_load", [1e5, -2.0, 1e5], r" = -2 N"),
        ("axial_load", np.ones((3, 1)), r" has shape \(3, 1\)"),
        ("velocity", 0.0, r" = 0 \[m/s\].*positive"),
        ("velocity", -0.1, r" = -0\.1"),
        ("velocity", math.nan, r" = nan"),
        ("velocity", math.inf, r" = inf"),
        ("velocity", "fast", r" = 'fast' is not a number"),
        ("level", "contact!", r" = 'contact!'.*pendulum"),
        ("on_failure", "ignore", r" = 'ignore'.*'warn'.*'raise'"),
    ],
)
def test_bad_input(name: str, value: Any, words: str) -> None:
    given_ = {"displacement": [0.01, 0.02, 0.03], "axial_load": W, name: value}
    kind = TypeError if words.endswith("is not a number") else ValueError
    refused(kind, name + words, cyclic_test, bearing(), **given_)


CONTRACT = {
    "bearing_displacement": (("step", "bearing", "axis"), "m"),
    "bearing_force": (("step", "bearing", "axis"), "N"),
    "axial_force": (("step", "bearing"), "N"),
    "slider_displacement": (("step", "bearing", "surface", "axis"), "m"),
    "interface_slip": (("step", "bearing", "axis"), "m"),
    "rim_force": (("step", "bearing", "surface"), "N"),
}


def test_dataset_keeps_the_contract() -> None:
    data = cyclic_test(bearing(), np.column_stack([[0.1, 0.19, 0.0], [0.0, 0.05, 0.1]]), W)
    for name, (dims, units) in CONTRACT.items():
        assert data[name].dims == dims
        assert data[name].attrs["units"] == units
    for name, variable in data.data_vars.items():
        assert variable.attrs["units"], name
        assert len(variable.attrs["long_name"]) > 3, name
        assert np.isfinite(variable).all(), name
        assert variable.dtype == np.float64, name
    assert list(data["axis"].to_numpy()) == ["x", "y", "z"]
    assert list(data["surface"].to_numpy()) == ["bottom", "top"]
    assert data.sizes["step"] == 3
    assert {"status", "lir_dcfp_version", "level"} <= set(data.attrs)
    assert data.attrs["message"] == "completed"
    assert "failed_at" not in data.attrs


def test_dataset_is_consistent() -> None:
    """Signs and kinematics of conventions.md, plates parallel, rim contact in an oblique path."""
    path = np.column_stack([[0.1, 0.16, 0.0, -0.1], [0.0, 0.12, 0.1, -0.17]])
    data = cyclic_test(bearing(), path, W)
    u = data["bearing_displacement"].to_numpy()[:, 0]
    slip = data["interface_slip"].to_numpy()[:, 0]
    d = data["slider_displacement"].to_numpy()[:, 0]
    assert_allclose(d[:, 0], d[:, 1], rtol=0.0, atol=1e-15)  # equal radii
    axis = np.array([0.0, 0.0, 1.0]) - d[:, 0] / 0.75
    assert_allclose(np.linalg.norm(axis, axis=1), 1.0, rtol=1e-14, atol=0.0)
    assert_allclose(np.sum(axis * slip, axis=1), 0.0, rtol=0.0, atol=1e-15)
    # d1 + d2 + s is U but for the slider's tilt over its height: u = d1 + d2 + s + h (n - e)
    lateral = d.sum(axis=1) + slip + 0.085 * (axis - [0.0, 0.0, 1.0])
    stretch = float(data["axial_force"].max()) / bearing().resolved()["axial_stiffness"]
    assert_allclose(lateral[:, :2], u[:, :2], rtol=0.0, atol=1.01 * stretch)
    # a lateral displacement lifts the plate
    rise = L * (1.0 - np.sqrt(1.0 - np.sum(d[:, 0, :2] ** 2, axis=1) / 0.75**2))
    assert_allclose(u[:, 2], rise + slip[:, 2], rtol=0.0, atol=2.0 * stretch)
    size = np.linalg.norm(slip, axis=1)
    assert_allclose(data["interface_slip_size"][:, 0], size, rtol=1e-12, atol=0.0)
    assert size.max() > 0.01
    moments = data["bearing_moment"].to_numpy()[:, 0]
    force = data["bearing_force"].to_numpy()[:, 0]
    arm = u + np.array([0.0, 0.0, 0.085])
    balance = moments[:, 0] + moments[:, 1] + np.cross(arm, force)
    assert_allclose(balance, 0.0, rtol=0.0, atol=1e-9 * W)  # round-off of levers times W


@SIGNS
def test_result_does_not_depend_on_the_points(sign: float) -> None:
    """The rig refines by itself: few points or many end on the same force."""
    few = cyclic_test(bearing(), sign * np.array([0.185, -0.185, 0.1]), W)
    many = cyclic_test(bearing(), sign * through(0.185, -0.185, 0.1, points=777), W)
    one, two = (along_x(d, "bearing_force")[-1] for d in (few, many))
    # increments of 20 um against u_y of 100 and 250 um, elastic-plastic: exact but for the tilt
    assert_allclose(one, two, rtol=1e-5, atol=0.0)


@SIGNS
def test_bouc_wen_in_the_rig(sign: float) -> None:
    """Same plateau as elastic-plastic; softer before it, by closed form for exponent 2: tanh."""
    b = bearing(friction_law="bouc-wen", capacity=math.inf).as_dcfp()
    # to the centre from far, and an excursion of U = 1.5 u_y L / R from rest
    data = cyclic_test(b, sign * np.array([-0.1, 0.0]), W)
    plateau = MU_D * 1.5 / L * W
    assert_allclose(along_x(data, "bearing_force")[-1], sign * plateau, rtol=1e-3, atol=0.0)
    small = 1.5 * 0.25e-3 * L / 0.75
    data = cyclic_test(b, sign * through(small, points=300), W)
    expected = plateau * math.tanh(1.5) + W * small / L
    # backward Euler with increments of 0.005 u_y
    assert_allclose(along_x(data, "bearing_force")[-1], sign * expected, rtol=3e-3, atol=0.0)


@pytest.mark.parametrize(("level", "most"), [("pendulum", 0.02), ("contact", 0.06)])
@pytest.mark.parametrize(
    ("radius", "height", "slider_radius", "low"),
    [((2.59, 1.88), 0.077, 0.068, (0.027, 0.058)), ((2.67, 1.01), 0.06, 0.09, (0.098, 0.0235))],
)
def test_below_its_capacity_it_is_a_dcfp(radius, height, slider_radius, low, level, most):
    """The actuator holds its load as well as the sliders' own equilibrium is found."""
    sizes = {"radius": radius, "slider_height": height, "slider_radius": slider_radius}
    device = bearing(capacity=0.28, friction=low, interface_friction=0.2, **sizes)
    turn = 6.0 * math.pi * np.linspace(0.0, 0.5, 120)
    path = np.column_stack([np.sin(turn), 0.6 * np.sin(2.0 * turn / 3.0)])
    path = (0.85 * device.capacity / np.hypot(*path.T).max() * path)[:14]
    one = cyclic_test(device, path, axial_load=1e6, level=level)
    two = cyclic_test(device.as_dcfp(), path, axial_load=1e6, level=level)
    assert one.attrs["status"] == two.attrs["status"] == "ok"
    assert not one.rim_force.any()
    force, same = (each.bearing_force.to_numpy()[:, 0, :2] for each in (one, two))
    assert_allclose(force, same, rtol=0.0, atol=most * np.abs(same).max())
