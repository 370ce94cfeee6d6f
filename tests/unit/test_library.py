"""The ready-made models: masses, periods, names, and what they refuse."""

from __future__ import annotations

import math
from collections.abc import Callable
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, cast

import numpy as np
import numpy.typing as npt
import pytest
import scipy.linalg
from numpy.testing import assert_allclose

from frames._errors import ModelError
from frames.assembly.assemble import System, assemble, member_axial_forces
from frames.io import Frame
from frames.library.models import lumped_mass, moment_frame
from frames.library.shear_buildings import shear_building
from frames.model.components import bearing_axial_stiffness
from frames.model.damping import ModalDamping, RayleighDamping
from frames.model.sections import Section
from tests.refusals import refused

if TYPE_CHECKING:
    from lir_element import LIRBearing

Array = npt.NDArray[np.float64]


def bearing(height: float = 0.12, axial_stiffness: float = 2e9) -> LIRBearing:
    """Return a stand-in for a bearing."""
    made = SimpleNamespace(axial_stiffness=axial_stiffness, height=height)
    return cast("LIRBearing", made)


def fixed_base_periods(system: System) -> Array:
    """Return the periods of the structure with its base level held, longest first [s]."""
    keep = [k for k, label in enumerate(system.dof_labels) if not label.startswith("base")]
    k = system.stiffness.toarray()[np.ix_(keep, keep)]
    m = system.mass.toarray()[np.ix_(keep, keep)]
    # Condense the DOFs without mass.
    heavy = np.diag(m) > 0.0
    light = ~heavy
    schur = (
        k[np.ix_(heavy, light)] @ np.linalg.solve(k[np.ix_(light, light)], k[np.ix_(light, heavy)])
        if light.any()
        else 0.0
    )
    squares = scipy.linalg.eigh(
        k[np.ix_(heavy, heavy)] - schur, m[np.ix_(heavy, heavy)], eigvals_only=True
    )
    return np.asarray(2.0 * math.pi / np.sqrt(squares))


def test_lumped_mass_has_three_free_dofs_and_its_weight() -> None:
    frame = lumped_mass(bearing(0.1), mass=204e3, gravity=9.81)
    system = assemble(frame)
    assert system.dof_labels == ("mass ux", "mass uy", "mass uz")
    assert_allclose(system.load, [0.0, 0.0, -204e3 * 9.81], rtol=1e-15, atol=0.0)
    assert_allclose(system.inertia_load, 204e3 * np.eye(3), rtol=1e-15, atol=0.0)
    assert_allclose(system.coordinates[:, 2], [0.0, 0.1], rtol=0.0, atol=0.0)
    assert frame.damping is None


def test_shear_building_has_the_periods_of_a_shear_beam() -> None:
    # Uniform chain of n storeys: omega_r = 2 sqrt(k/m) sin((2 r - 1) pi / (2 (2 n + 1))).
    n, mass, stiffness = 5, 2e5, 3e8
    system = assemble(shear_building(bearing(), [mass] * n, stiffness))
    modes = np.arange(1, n + 1)
    omega = 2.0 * np.sqrt(stiffness / mass) * np.sin((2 * modes - 1) * np.pi / (4 * n + 2))
    found = fixed_base_periods(system)
    assert len(found) == 3 * n  # ux, uy, uz
    for period in 2.0 * np.pi / omega:
        assert (np.abs(found / period - 1.0) < 1e-10).sum() >= 2


def test_shear_building_on_a_plan_turns_as_its_columns_hold_it() -> None:
    bays, width, mass, stiffness = (2, 1), (6.0, 5.0), 3e5, 2e8
    frame = shear_building(bearing(), mass, stiffness, plan=(bays, width), base_mass=1e5)
    system = assemble(frame)
    grid = [(-6.0 + 6.0 * ix, -2.5 + 5.0 * iy) for ix in range(3) for iy in range(2)]
    polar = sum(stiffness / 6.0 * (x**2 + y**2) for x, y in grid)
    inertia = mass * (12.0**2 + 5.0**2) / 12.0
    torsional = 2.0 * math.pi * math.sqrt(inertia / polar)
    lateral = 2.0 * math.pi * math.sqrt(mass / stiffness)
    vertical = 0.05
    expected = sorted([lateral, lateral, torsional, vertical], reverse=True)
    assert_allclose(fixed_base_periods(system), expected, rtol=1e-10, atol=0.0)
    assert len(system.bearings) == 6
    assert [level.name for level in frame.levels] == ["base", "floor-1"]
    assert_allclose(system.node_mass[:, 0].sum(), 4e5, rtol=1e-15, atol=0.0)


def test_shear_building_takes_arrays_and_counts() -> None:
    by_count = assemble(shear_building(bearing(), 1e5, 1e8, storeys=3))
    by_list = assemble(shear_building(bearing(), [1e5] * 3, np.full(3, 1e8)))
    assert by_count.dof_labels == by_list.dof_labels
    difference = by_count.stiffness - by_list.stiffness
    assert_allclose(difference.toarray(), 0.0, rtol=0.0, atol=0.0)
    frame = shear_building(bearing(), 1e5, 1e8, damping=RayleighDamping(0.02, (0.3, 0.1)))
    assert frame.damping == RayleighDamping(0.02, (0.3, 0.1))


def with_stiff_bearings(system: System) -> Array:
    """Return the static displacements q with every bearing as three springs."""
    t = system.transform.toarray()
    stiffness = system.stiffness.toarray()
    for _, i, j, device in system.bearings:
        relative = t[6 * j : 6 * j + 3] - t[6 * i : 6 * i + 3]
        stiffness += bearing_axial_stiffness(device) * relative.T @ relative
    return np.asarray(np.linalg.solve(stiffness, system.load))


def test_moment_frame_default_is_the_documented_building() -> None:
    frame = moment_frame(bearing=bearing())
    system = assemble(frame)
    total = system.node_mass[:, 0].sum()
    assert 850e3 < total < 950e3
    periods = fixed_base_periods(system)
    assert 0.4 < periods[0] < 0.6
    # Square plan: the two lateral periods agree, torsion is shorter.
    assert_allclose(periods[0], periods[1], rtol=1e-6, atol=0.0)
    assert periods[2] < periods[1]
    assert len(system.bearings) == 9
    assert [level.name for level in frame.levels] == ["base", "floor-1", "floor-2", "floor-3"]
    assert frame.levels[3].z == pytest.approx(0.12 + 3 * 3.5)
    assert all(len(level.nodes) == 9 for level in frame.levels)
    assert frame.damping == ModalDamping(0.02)


def test_moment_frame_weight_goes_to_the_bearings_by_tributary_area() -> None:
    light = Section.box(0.4, 0.4, 0.02, density=0.0)
    sections = dict.fromkeys(("column", "beam", "base_beam"), light)
    given = {"floor_load": 1000.0, "gravity": 10.0} | sections
    frame = moment_frame((2, 1), 2, bearing=bearing(), **given)
    system = assemble(frame)
    assert_allclose(system.node_mass[:, 0].sum(), 3 * 72.0 * 1000.0, rtol=1e-14, atol=0.0)
    assert_allclose(system.load.sum(), -3 * 72.0 * 1e4, rtol=1e-13, atol=0.0)
    corner = system.node_mass[system.node_names.index("floor-2-0-0"), 0]
    edge = system.node_mass[system.node_names.index("floor-2-1-0"), 0]
    assert_allclose([corner, edge], [9e3, 18e3], rtol=1e-14, atol=0.0)
    axial = member_axial_forces(system, with_stiff_bearings(system))
    feet = [k for k, name in enumerate(system.members.names) if name.startswith("column-1-")]
    assert_allclose(axial[feet].sum(), -2 * 72.0 * 1e4, rtol=1e-7, atol=0.0)


def test_moment_frame_takes_a_bearing_for_each_place() -> None:
    places = {(ix, iy): bearing(0.1 + 0.02 * ix) for ix in range(2) for iy in range(2)}
    frame = moment_frame((1, 1), 1, bearing=places)
    system = assemble(frame)
    base = {frame.nodes[f"base-{ix}-{iy}"].z for ix, iy in places}
    assert base == {max(device.height for device in places.values())}
    assert frame.nodes["ground-0-0"].z == pytest.approx(0.02)
    for name, _, j, device in system.bearings:
        ix, iy = (int(word) for word in name.split("-")[1:])
        assert device is places[ix, iy]
        assert system.node_names[j] == f"base-{ix}-{iy}"


PAIR = {(0, 0): bearing(), (1, 1): bearing()}
BOTH = {"floor_mass": 1e5, "floor_load": 1e3}
WORDS = r"floor_mass = 100000.0 kg and floor_load = 1000.0 kg/m2 both"
STRONG, LIGHT = {"eccentricity": (0.7, 0.0)}, {"eccentricity": (0.05, 0.0)}
REFUSALS: list[tuple[str, Callable[..., Frame], tuple[Any, ...], dict[str, Any]]] = [
    (r"mass \[kg\] = -1 must be positive", lumped_mass, (bearing(), -1.0), {}),
    (r"missing: \[\(0, 1\), \(1, 0\)\]", moment_frame, ((1, 1), 1), {"bearing": PAIR}),
    (WORDS, moment_frame, (), {"bearing": bearing()} | BOTH),
    (r"bays = 0 must be", moment_frame, ((0, 2),), {"bearing": bearing()}),
    (r"storeys = 2.5 must be integers", moment_frame, ((1, 1), 2.5), {"bearing": bearing()}),
    (r"numbers of storeys differ", shear_building, (bearing(), [1e5, 1e5], [1e8] * 3), {}),
    (r"differ or are 0", shear_building, (bearing(), [], []), {}),
    (r"storey_stiffness \[N/m\] = -1e\+08", shear_building, (bearing(), 1e5, -1e8), {}),
    (r"give plan=\(bays, bay_width\)", shear_building, (PAIR, 1e5, 1e8), {}),
    (r"needs a plan, because floors without a plan", shear_building, (bearing(), 1e5, 1e7), LIGHT),
    (r"\[-\] = 0\.7", shear_building, (bearing(), 1e5, 1e7), {"plan": ((1, 1), 6.0)} | STRONG),
]


@pytest.mark.parametrize(("words", "make", "given", "more"), REFUSALS)
def test_library_refuses(words, make, given, more):
    refused(ModelError, words, make, *given, **more)


@pytest.mark.parametrize("off", [(0.05, 0.0), (-0.05, 0.1), (0.0, 0.0)])
def test_floors_are_eccentric_as_far_as_asked(off: tuple[float, float]) -> None:
    light = Section.box(0.4, 0.4, 0.025, density=0.0)
    sections = dict.fromkeys(("column", "beam", "base_beam"), light)
    given = {"bay_width": (6.0, 8.0), "floor_mass": 1.2e5, "eccentricity": off} | sections
    frame = moment_frame((3, 2), 2, bearing=bearing(), **given)
    system = assemble(frame)
    middle = np.array([9.0, 8.0])
    for level in frame.levels:
        chosen = [system.node_names.index(name) for name in level.nodes]
        masses = system.node_mass[chosen, 0]
        assert_allclose(masses.sum(), 1.2e5, rtol=1e-12)
        assert (masses > 0.0).all()
        centre = masses @ system.coordinates[chosen, :2] / masses.sum()
        assert_allclose(centre - middle, np.array(off) * [18.0, 16.0], rtol=1e-12, atol=1e-9)


def test_eccentricities_that_leave_columns_without_mass() -> None:
    bound = 2.0 * (0.5 * 2 * 9.0**2 + 2 * 3.0**2) / 3.0 / 18.0**2
    moment_frame((3, 2), 1, bearing=bearing(), eccentricity=(0.999 * bound, 0.0))
    for words, off in (
        (r"eccentricity = 0\.4 of the side must be below 0\.\d+", (0.4, 0.0)),
        ("along both sides leaves a corner without", (0.15, 0.2)),
        ("eccentricity", (1.001 * bound, 0.0)),
    ):
        frame = {"bearing": bearing(), "eccentricity": off}
        refused(ModelError, words, moment_frame, (3, 2), 1, **frame)


def test_shear_building_with_eccentric_masses_twists() -> None:
    """The first coupled periods of a one-storey building on held bearings, in closed form."""
    plan, mass, stiffness = ((2, 1), (6.0, 8.0)), 1e5, 4e7
    frame = shear_building(
        bearing(), mass, stiffness, storeys=1, plan=plan, eccentricity=(0.1, 0.0), gravity=0.0
    )
    system = assemble(frame)
    assert "floor-1-mass" in system.node_names
    off = 0.1 * 12.0
    radius = (12.0**2 + 8.0**2) / 12.0  # of gyration, squared, about the centre of mass
    polar = (4 * (6.0**2 + 4.0**2) + 2 * 4.0**2) / 6.0  # of the columns at the grid points
    k = stiffness * np.array([[1.0, off], [off, polar + off**2]])  # y and twist at that centre
    m = mass * np.diag([1.0, radius])
    expected = 2.0 * math.pi / np.sqrt(scipy.linalg.eigh(k, m, eigvals_only=True))
    periods = fixed_base_periods(system)
    along = 2.0 * math.pi * math.sqrt(mass / stiffness)
    for period in (*expected, along):
        assert np.abs(periods - period).min() < 1e-6 * period
    plain = assemble(shear_building(bearing(), mass, stiffness, storeys=1, plan=plan))
    assert "floor-1-mass" not in plain.node_names
