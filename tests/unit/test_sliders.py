"""The sliders as bodies: mass, inertia and contact points from a bearing's geometry."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import quad

from lir_element import cyclic_test
from lir_element.bundles.contact_data import as_rows, contact_arrays
from lir_element.device.sliders import (
    face_records,
    gripping,
    half_slider,
    interface_height,
    ring_points,
    slider_record,
)
from tests.scenes import rimmed_bearing as bearing
from tests.scenes import wide_bearing

QUADRATURE = {"rtol": 1e-9, "atol": 0.0}  # scipy's own error lies near 1e-13


@pytest.mark.parametrize("shape", [(0.08, 0.75, 0.05), (0.2, 0.25, 0.16), (0.05, 0.6, 0.12)])
def test_half_against_integrals_over_its_slices(shape: tuple[float, float, float]) -> None:
    """Discs at the height z above the vertex: sqrt(2 R z - z^2) in the cap, then the full radius.

    The kernel of this integral (over z) is not that of the program (over the radius).
    """
    a, sphere, h = shape
    rho = 7850.0
    cap = sphere - math.sqrt(sphere**2 - a**2)

    def square(z: float) -> float:
        return min(2.0 * sphere * z - z * z, a * a)

    def integral(power: int, moment: int) -> float:
        return sum(
            quad(lambda z: math.pi * rho * square(z) ** power * z**moment, *ends, epsrel=1e-12)[0]
            for ends in ((0.0, cap), (cap, h))
        )

    mass, centre, (across, along) = half_slider(a, sphere, h, rho)
    assert_allclose(mass, integral(1, 0), **QUADRATURE)
    assert_allclose(centre, integral(1, 1) / mass, **QUADRATURE)
    assert_allclose(along, 0.5 * integral(2, 0), **QUADRATURE)
    about_vertex = 0.25 * integral(2, 0) + integral(1, 2)
    assert_allclose(across, about_vertex - mass * centre**2, **QUADRATURE)


def test_record_of_the_sliders() -> None:
    """Places: spheres' vertices on the plates, both planes at one height, nodes by thickness."""
    b = bearing(plate_thickness=(0.03, 0.05), slider_density=5000.0)
    c = slider_record(b, gravity=9.0)
    first = b.radii[0]
    place = c["place"][0, :, 2] + first  # above the bottom vertex
    assert_allclose(place[[0, 3]], [-0.03, 0.11 + 0.05], rtol=1e-14)
    assert_allclose(place[1:3] + c["vertex"][0], [0.0, 0.11], rtol=0.0, atol=1e-15)
    plane = place[1:3] + c["plane"][0]
    height = interface_height(b.radii, b.slider_radius, b.slider_height)
    assert_allclose(plane, height, rtol=1e-14)
    edges = [r - math.sqrt(r * r - 0.08**2) for r in b.radii]
    # both edges are equally high
    assert_allclose(plane[0] - edges[0], 0.11 - edges[1] - plane[0], rtol=1e-12)
    for k, (sphere, height) in enumerate(zip(b.radii, (plane[0], 0.11 - plane[0]), strict=True)):
        mass, centre, (across, along) = half_slider(0.08, sphere, height, 5000.0)
        assert_allclose(c["mass"][0, k], mass, rtol=1e-14)
        assert_allclose(c["inertia"][0, k], [across, across, along], rtol=1e-14)
        from_vertex = abs(c["vertex"][0, k])
        assert_allclose(from_vertex, centre, rtol=1e-12)
    # three interfaces in series have the bearing's own stiffness and damping
    o = b.resolved()
    assert_allclose(c["stiffness"][0] / 3.0, o["axial_stiffness"], rtol=1e-14)
    assert_allclose(c["damping"][0] / 3.0, o["axial_damping"], rtol=1e-14)
    assert c["gravity"][0] == 9.0
    assert c["radius"][0] == 0.08


def test_given_mass_and_inertia() -> None:
    plain = slider_record(bearing())
    by_mass = slider_record(bearing(slider_mass=(3.0, 5.0)))
    assert_allclose(by_mass["mass"][0], [3.0, 5.0], rtol=1e-15)
    ratio = np.array([3.0, 5.0]) / plain["mass"][0]
    expected = plain["inertia"][0] * ratio[:, None]
    assert_allclose(by_mass["inertia"][0], expected, rtol=1e-14)
    assert_allclose(by_mass["place"], plain["place"], rtol=0.0, atol=0.0)
    both = slider_record(bearing(slider_mass=4.0, slider_inertia=((0.1, 0.2), (0.3, 0.4))))
    assert_allclose(both["mass"][0], [4.0, 4.0], rtol=1e-15)
    assert_allclose(both["inertia"][0], [[0.1, 0.1, 0.2], [0.3, 0.3, 0.4]], rtol=0.0, atol=0.0)
    twice = slider_record(bearing(slider_density=2.0 * 7850.0))
    assert_allclose(twice["mass"], 2.0 * plain["mass"], rtol=1e-14)


@pytest.mark.parametrize("count", [4, 5, 6, 7, 8, 10, 12, 16, 96, 128])
def test_points_of_an_interface(count: int) -> None:
    """A full disc under uniform pressure: int r dA = 2/3 a A, int x^2 dA = a^2 / 4 A."""
    a = 0.08
    plan, share = ring_points(count, a)
    assert plan.shape == (count, 2)
    assert_allclose(share.sum(), 1.0, rtol=1e-14)
    assert (share > 0.0).all()
    assert_allclose(share @ plan, 0.0, rtol=0.0, atol=1e-16)
    assert_allclose(np.linalg.norm(plan, axis=1).max(), a, rtol=1e-14)
    second = np.einsum("k,ka,kb->ab", share, plan, plan)
    lever = share @ np.linalg.norm(plan, axis=1)
    # one ring on the edge: a^2 / 2 an axis, lever a
    ring = count < 8
    expected = a * a * (0.5 if ring else 0.25) * np.eye(2)
    assert_allclose(second, expected, rtol=0.0, atol=1e-16)
    assert_allclose(lever, a if ring else 2.0 / 3.0 * a, rtol=1e-14)
    if count % 4 == 0:  # also symmetric about the centre
        for point in plan:
            assert np.linalg.norm(plan + point, axis=1).min() < 1e-15
    if count > 64:
        fourth = share @ np.linalg.norm(plan, axis=1) ** 4  # more rings, more moments
        assert_allclose(fourth, a**4 / 3.0, rtol=1e-13)
        return
    angles = np.sort(np.arctan2(plan[:, 1], plan[:, 0]) % (2.0 * math.pi))
    assert_allclose(np.diff(angles), 2.0 * math.pi / count, rtol=1e-12)
    pairs = np.linalg.norm(plan[:, None] - plan[None], axis=2) + np.eye(count)
    assert pairs.min() > 0.2 * a  # all distinct


@pytest.mark.parametrize("count", [4, 7, 8, 12])
def test_points_lie_on_the_surfaces(count: int) -> None:
    """On the spheres of both plates, and on the plane, of the undeformed bearing."""
    b = bearing(contact_points=count, plate_thickness=(0.02, 0.03))
    (points, touches), c = (part[0] for part in face_records(b)), slider_record(b)[0]
    assert len(points) == 3 * count
    for pair, body in enumerate((1, 2, 2)):
        chosen = points[points["pair"] == pair]
        assert len(chosen) == count
        assert_allclose(chosen["share"].sum(), 1.0, rtol=1e-14)
        place = chosen["arm"] + c["place"][body]  # from the bottom sphere's centre
        if pair == 0:
            assert_allclose(np.linalg.norm(place, axis=1), b.radii[0], rtol=1e-14)
            assert (place[:, 2] < 0.0).all()
        elif pair == 2:
            place[:, 2] += b.effective_radius
            assert_allclose(np.linalg.norm(place, axis=1), b.radii[1], rtol=1e-14)
            assert (place[:, 2] > 0.0).all()
        else:
            assert_allclose(place[:, 2], c["place"][1, 2] + c["plane"][0], rtol=0.0, atol=1e-15)
    spots = touches["spot"]
    assert_allclose(np.linalg.norm(spots[points["pair"] != 1], axis=1), 1.0, rtol=1e-14)
    assert (touches["closure"] == 0.0).all()
    assert (touches["hysteresis"] == 0.0).all()


def test_bundle_of_several_bearings() -> None:
    """Chosen ones in order, padded with points that have no share; words share the memory."""
    disc, many, other = bearing(), bearing(contact_points=12), bearing()
    bundle = contact_arrays([disc, other, many], [True, False, True], 9.81)
    assert bundle.row.tolist() == [0, -1, 1]
    assert bundle.points.shape == (2, 36)
    assert bundle.points["disc"][0, :4].tolist() == [disc.slider_radius] * 3 + [0.0]
    assert (bundle.points["disc"][1] == 0.0).all()
    assert_allclose(bundle.points["share"][0, 3:], 0.0, rtol=0.0, atol=0.0)
    assert_allclose(bundle.points["share"].sum(axis=1), [3.0, 3.0], rtol=1e-14)
    assert (bundle.points["arm"][0, 3:] == bundle.points["arm"][0, 0]).all()
    assert (bundle.touch_old["spot"][0, 3:] == bundle.touch_old["spot"][0, 0]).all()
    assert (bundle.sliders["grip"][0] == 1.0).all()
    assert (bundle.sliders["gravity"] == 9.81).all()
    bundle.bodies_old["displacement"][1, 0, 2] = 0.125
    assert (as_rows(bundle.bodies_old) == bundle.bodies_old_words).all()
    assert bundle.bodies_old_words[1].view(np.float64)[3] == 0.125  # after the step


REFUSED = [
    ({name: value}, f"{name}.* = {value:g}.*must be positive")
    for name in ("slider_density", "slider_mass")
    for value in (0.0, -1.0, math.nan, math.inf)
]
REFUSED += [
    ({"slider_mass": (3.0, -1.0)}, r"slider_mass \(top\) = -1 .*positive"),
    ({"slider_mass": (math.nan, 3.0)}, r"slider_mass \(bottom\) = nan .*positive"),
    ({"slider_mass": (3.0,)}, "slider_mass has 1 entries"),
    ({"slider_mass": (3.0, 3.0, 3.0)}, "slider_mass has 3 entries"),
]
REFUSED += [({"slider_density": x}, f"{x!r} is not a number") for x in ("7850", None, True, 1j)]
for place in np.ndindex(2, 2):
    pairs = [[0.1, 0.1], [0.1, 0.1]]
    pairs[place[0]][place[1]] = -1.0
    REFUSED.append(({"slider_inertia": pairs}, r"slider_inertia.* = -1 \[kg m2\]"))
REFUSED += [
    ({"slider_inertia": value}, "slider_inertia = .*two pairs.*kg m2")
    for value in ((), ((0.1, 0.2),), ((0.1, 0.2, 0.3), (0.1, 0.2, 0.3)), ((0.1,), (0.2,)))
]
REFUSED += [
    ({"slider_inertia": value}, "slider_inertia")
    for value in (0.1, (0.1, 0.2), "none", [[0.1, "x"], [0.1, 0.1]])
]
REFUSED += [
    ({"contact_points": count}, f"contact_points = {count!r}.*4 to 7.*even")
    for count in (3, 0, -8, 9, 11, 66, 100, 4.5, True)
]
REFUSED += [
    ({"contact_points": count}, "contact_points") for count in (math.nan, math.inf, "8", (8, 8))
]


@pytest.mark.parametrize(("changes", "words"), REFUSED, ids=str)
def test_what_no_slider_has_is_refused(changes, words):
    with pytest.raises((TypeError, ValueError), match=words):
        bearing(**changes)


def test_options_survive_as_dcfp() -> None:
    b = bearing(contact_points=12, slider_mass=3.0, slider_inertia=[[0.1, 0.2], [0.1, 0.2]])
    other = b.as_dcfp()
    assert other.contact_points == 12
    assert other.slider_mass == 3.0
    assert b.slider_inertia == ((0.1, 0.2), (0.1, 0.2))
    assert hash(b) != hash(other)


@pytest.mark.parametrize("count", [4, 8, 16])
@pytest.mark.parametrize("part", [0.05, 0.13, 0.3])
def test_grip_is_the_torque_of_friction_over_load_and_radius(part: float, count: int) -> None:
    """Points pressed towards the sphere's centre, sliding along x: vectors summed."""
    sphere = 2.0
    plan, share = ring_points(count, part * sphere)
    z = np.sqrt(sphere**2 - np.sum(plan**2, axis=1))
    place = np.column_stack([plan, z])
    pressure = share * z / sphere  # of one and the same vertical closure
    load = float(np.sum(pressure * z / sphere))
    torques = []
    for axis in ([0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]):  # along x, along y
        along = np.cross(axis, place)
        along /= np.linalg.norm(along, axis=1)[:, None]
        torques.append(np.sum(pressure[:, None] * np.cross(place, along), axis=0) @ axis)
    assert_allclose(gripping(plan, share, sphere), np.mean(torques) / (load * sphere), rtol=1e-12)
    if count >= 8:  # a full disc
        assert_allclose(gripping(plan, share, sphere), 1.0 + part**2 / 8.0, rtol=0.1 * part**2)


def test_levels_have_the_friction_of_a_test() -> None:
    """Half the loop's height of a wide slider: without the grip they are 2.9e-3 apart.

    What is left is rocking, by ``4/3 R h F / (k_v a^2)``, and the sliders' weight.
    """
    wide = wide_bearing(slider_radius=0.21, friction=0.08, slider_density=500.0)
    heights = []
    for level in ("pendulum", "contact"):
        data = cyclic_test(wide, [0.1, 0.0, -0.1, 0.0], 1e6, level=level)
        force = data["bearing_force"].sel(axis="x").to_numpy()[:, 0]
        heights.append(0.5 * (force[3] - force[1]))
    assert_allclose(heights[1], heights[0], rtol=7e-4)
    assert_allclose(heights[0], 0.08 * 3.0 / 2.8 * 1e6, rtol=1e-4)
