"""Modes against closed forms and an eigenproblem built another way."""

import math
from functools import partial

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy import linalg

from frames import Frame, ModelError, gravity, lumped_mass, modes, moment_frame, shear_building
from frames.statics.centres import floor_centres, lifting_stiffness
from lir_element import CoulombFriction, Element, LIRBearing
from tests.scenes import simple_bearing

G = 9.80665


bearing = partial(simple_bearing, capacity=0.3, friction=0.06, interface_friction=0.2)


def small_frame():
    return moment_frame(bays=(1, 1), storeys=2, bearing=bearing(), bay_width=(6.0, 4.0))


def test_rigid_block_slides_with_the_period_of_the_pendulum():
    plan = ((2, 1), (5.0, 4.0))
    frame = shear_building(bearing(), 1e5, 1e13, plan=plan)
    periods = modes(frame, 3, "sliding").periods
    pendulum = 2.0 * math.pi * math.sqrt(1.9 / G)
    gyration = (10.0**2 + 4.0**2) / 12.0
    squares = np.mean([x**2 + 2.0**2 for x in (-5.0, 0.0, 5.0)])
    turning = pendulum * math.sqrt(gyration / squares)
    assert turning < pendulum
    # the storey's own flexibility: N / L over 1e13 N/m, some 1e-7; that the base tilts on its
    # bearings under the moments of their ends, 8e-6
    assert_allclose(periods, [pendulum, pendulum, turning], rtol=1e-5)
    held = shear_building(bearing(), 1e5, 1e13, plan=plan, overturning=False)
    found = modes(held, 3, "sliding")
    assert_allclose(found.periods, [pendulum, pendulum, turning], rtol=1e-6)
    assert_allclose(found.torsion_ratios, [0.0, 0.0, 1.0], atol=1e-6)
    assert_allclose(found.mass_ratios[:, :2].sum(axis=1), [1.0, 1.0, 0.0], atol=1e-6)
    given = modes(held, 3, np.full(6, 5e5)).periods
    assert_allclose(given[:2], 2.0 * math.pi * math.sqrt(2e5 / 3e6), rtol=1e-6)


def floor_on_springs():
    """Four bearings, a stiff base, and a floor on unlike lateral springs at its corners."""
    frame = Frame("springs")
    corners = {"a": (0.0, 0.0), "b": (6.0, 0.0), "c": (6.0, 4.0), "d": (0.0, 4.0)}
    for (name, (x, y)), k in zip(corners.items(), (1e7, 2e7, 3e7, 4e7), strict=True):
        for level, z in (("g", 0.0), ("f", 3.0)):
            frame.add_node(f"{level}-{name}", x, y, z)
            frame.add_mass(f"{level}-{name}", 1e4)
        frame.add_node(f"s-{name}", x, y, -bearing().height)
        frame.fix(f"s-{name}", "all")
        frame.fix(f"g-{name}", "rx", "ry", "rz")
        frame.fix(f"f-{name}", "rx", "ry")
        frame.add_bearing(name, f"s-{name}", f"g-{name}", bearing())
        frame.add_spring(f"k-{name}", f"g-{name}", f"f-{name}", (k, k, 1e9, 0.0, 0.0, 1e3))
    frame.add_mass("f-a", 2e4)
    frame.add_level("floor", [f"f-{name}" for name in corners])
    return frame, corners


@pytest.mark.parametrize("rigid", [True, False])
def test_centres_of_a_floor(rigid):
    """Of stiffness: sum(k x) / sum(k) under a rigid floor; without one each corner goes alone."""
    frame, corners = floor_on_springs()
    plan, k = np.array(list(corners.values())), np.array([1.0, 2.0, 3.0, 4.0])
    if rigid:
        frame.add_diaphragm("floor", [f"f-{name}" for name in corners])
    (found,) = floor_centres(frame)
    m = np.array([3.0, 1.0, 1.0, 1.0])
    centre = m @ plan / m.sum()
    assert_allclose(found.mass_centre, centre)
    if rigid:
        assert_allclose(found.stiffness_centre, k @ plan / k.sum(), rtol=1e-3)
        return
    arm = plan - centre  # u = m / k of each: the mean rotation by the masses
    turn = np.sum(m * np.sum(arm**2, axis=1) * m / k)
    offset = [np.sum(m * arm[:, 0] * m / k), np.sum(m * arm[:, 1] * m / k)] / turn
    offset = offset * np.sum(m * np.sum(arm**2, axis=1)) / m.sum()
    assert_allclose(found.stiffness_centre, centre - offset, rtol=1e-3)


def test_lifting_a_bearing_takes_springs_in_series():
    frame, _ = floor_on_springs()
    for name, other in (("a", "b"), ("c", "d")):
        frame.add_spring(f"{name}{other}", f"g-{name}", f"g-{other}", (1e7, 1e7, 1e8, 0, 0, 0))
    found = lifting_stiffness(frame)
    other = bearing().resolved()["axial_stiffness"]
    assert_allclose(found["a"], 1.0 / (1e-8 + 1.0 / other), rtol=1e-6)


def test_a_bearing_of_a_period_has_it_in_the_model():
    heights = {"slider_height": 0.15, "plate_thickness": (0.05, 0.03)}
    given = {"slider_radius": 0.1, "capacity": 0.3, "friction": 0.05, "interface_friction": 0.2}
    own = LIRBearing.of_period(3.3, **heights, **given)
    assert own.radii[0] == own.radii[1]
    assert_allclose(modes(lumped_mass(own, 1e5), 2, "sliding").periods, 3.3, rtol=1e-6)
    with pytest.raises(ValueError, match=r"period = -1 .* must be positive"):
        LIRBearing.of_period(-1.0, **heights, **given)
    with pytest.raises(TypeError, match="radius"):
        LIRBearing.of_period(3.3, radius=1.0, **heights, **given)


def test_unlike_bearings_add_their_stiffness():
    radii = {(0, 0): 1.0, (1, 0): 2.0, (0, 1): 1.0, (1, 1): 2.0}
    devices = {place: bearing(radius=r) for place, r in radii.items()}
    frame = shear_building(devices, 1e5, 1e13, plan=((1, 1), 6.0))
    found = modes(frame, 3, "sliding")
    weight = 2e5 * G
    k_1, k_2 = 2 * weight / 4 / 1.9, 2 * weight / 4 / 3.9
    # along x: both rows equal; along y: the stiffer column of bearings is eccentric in x
    m, inertia = 2e5, 2e5 * (36.0 + 36.0) / 12.0
    k_yr = (k_2 - k_1) * 3.0
    k_rr = (k_1 + k_2) * (9.0 + 9.0)
    coupled = linalg.eigvalsh([[k_1 + k_2, k_yr], [k_yr, k_rr]], np.diag([m, inertia]))
    expected = np.sort(2 * math.pi / np.sqrt([(k_1 + k_2) / m, *coupled]))[::-1]
    # bearings alike but for the radius carry a quarter of the weight each, but for their stiffness
    assert_allclose(found.periods, expected, rtol=1e-5)


def test_fixed_bearings_equal_a_fixed_base_eigenproblem():
    frame = small_frame()
    state = gravity(frame)
    system = state.system
    above = system.bearing_rows.toarray().reshape(-1, 2, 6, len(system.load))[:, 1, :3]
    held = linalg.null_space(above.reshape(-1, len(system.load)))
    k = held.T @ (system.stiffness + state.geometric).toarray() @ held
    m = held.T @ system.mass.toarray() @ held
    flexibility = linalg.eigvalsh(m, k)[::-1][:6]  # M v = 1 / omega2 K v: massless DOFs give 0
    found = modes(frame, 6, "fixed").periods
    # "fixed" means springs a thousand times as stiff as the bearings
    assert_allclose(found, 2.0 * math.pi * np.sqrt(flexibility), rtol=2e-5)
    assert found[0] < modes(frame, 1, "sliding").periods[0]


@pytest.mark.parametrize("kind", ["sliding", "sticking", "fixed"])
def test_shapes_are_orthonormal_and_all_modes_carry_all_mass(kind):
    frame = small_frame()
    mass = gravity(frame).system.node_mass.reshape(-1)
    found = modes(frame, 10**6, kind)
    shapes = found.shapes.reshape(len(mass), -1)
    product = shapes.T @ (mass[:, None] * shapes)
    assert_allclose(product, np.eye(product.shape[0]), rtol=0.0, atol=1e-9)  # eigh's round-off
    assert_allclose(found.mass_ratios.sum(axis=0), 1.0, rtol=1e-9)  # no mass on supports
    assert (found.mass_ratios >= 0.0).all()
    assert (np.diff(found.periods) <= 0.0).all()


def test_sliding_modes_of_a_stiff_frame_carry_the_horizontal_mass():
    found = modes(small_frame(), 3, "sliding")
    # three isolation modes: above them the frame follows, but for (T_fixed / T_slide)^2
    assert_allclose(found.mass_ratios[:3, :2].sum(axis=0), 1.0, rtol=1e-2)
    assert_allclose(found.mass_ratios[:3, 2], 0.0, rtol=0.0, atol=1e-6)  # none of it vertical


def test_vertical_mode_of_a_mass_on_one_bearing():
    device = bearing(axial_stiffness=3e8)
    found = modes(lumped_mass(device, 1e5), 9)
    assert len(found.periods) == 3
    assert_allclose(found.periods[2], 2 * math.pi * math.sqrt(1e5 / 3e8), rtol=1e-12)
    assert_allclose(np.abs(found.shapes[1, 2, 2]), 1e5**-0.5, rtol=1e-12)  # modal mass of 1 kg


UNLIKE = (CoulombFriction(0.1), CoulombFriction(0.02))


@pytest.mark.parametrize(
    "options", [{}, {"radius": (1.0, 0.8)}, {"friction": UNLIKE}], ids=["like", "radii", "friction"]
)
def test_sticking_modes_have_the_tangent_stiffness_at_rest(options):
    device, mass = bearing(**options), 1e5
    element = Element(device)
    u = np.zeros(12)
    u[8] = -mass * G / device.resolved()["axial_stiffness"]
    element.set_trial(u, np.zeros(12), 0.0)
    stiffness = element.tangent_stiffness()[6, 6]
    expected = 2 * math.pi * math.sqrt(mass / stiffness)
    found = modes(lumped_mass(device, mass), 2, "sticking").periods
    assert_allclose(found, expected, rtol=5e-3)  # what "tangent stiffness at rest" promises


def test_bad_input_is_refused():
    frame = lumped_mass(bearing(), 1e5)
    for count in (0, -3):
        with pytest.raises(ModelError, match=f"count = {count} must be an integer of at least 1"):
            modes(frame, count)
    with pytest.raises(ModelError, match=r"bearings = 'loose': choose one of .*sliding"):
        modes(frame, 1, "loose")
