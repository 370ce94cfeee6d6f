"""A building with floor loads, end zones and masses from loads, shaken: all is in balance."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from frames import (
    Frame,
    ModalDamping,
    Section,
    energy_error,
    gravity,
    member_forces,
    modes,
    storey_forces,
    support_reactions,
    time_history,
)
from frames.assembly.assemble import assemble
from frames.design import isolator_combinations
from tests.scenes import simple_bearing, swell

MOTION = swell(x=(2.2, 1.4), y=(0.9, 0.8), z=(1.0, 0.2), middle=1.2, width=0.6, end=3.0)
DEAD, LIVE = 5e3, 3e3  # N/m2
X, Y = 6.0, 4.5


BEARING = simple_bearing()


def building(*, damping=None):
    frame = Frame("loaded")
    column, beam = Section.box(0.4, 0.4, 0.02), Section.rolled_i(0.3, 0.3, 0.019, 0.011, 0.027)
    device = BEARING
    places = {"a": (0.0, 0.0), "b": (X, 0.0), "c": (X, Y), "d": (0.0, Y)}
    for name, (x, y) in places.items():
        frame.add_node(f"g{name}", x, y, 0.0)
        frame.fix(f"g{name}", "all")
        for level, z in enumerate((device.height, 3.3, 6.3)):
            frame.add_node(f"{name}{level}", x, y, z)
        frame.add_bearing(f"bearing-{name}", f"g{name}", f"{name}0", device)
        for level in (0, 1):
            zones = {"j": (0.0, 0.0, -0.15)}
            frame.add_member(
                f"column-{name}{level}",
                f"{name}{level}",
                f"{name}{level + 1}",
                column,
                offsets=zones,
            )
    for level in range(3):
        corners = [f"{name}{level}" for name in "abcd"]
        for k, i in enumerate(corners):
            j = corners[(k + 1) % 4]
            way = np.subtract(frame.nodes[j].position, frame.nodes[i].position)
            arm = 0.2 * way / np.linalg.norm(way)
            offsets = {"i": arm, "j": -arm}
            frame.add_member(f"beam-{i}-{j}", i, j, beam, offsets=offsets)
        frame.add_diaphragm(f"level-{level}", corners)
        frame.add_level(f"level-{level}", corners)
        span = None if level else "x"
        frame.add_floor_load(f"slab-{level}", corners, DEAD, span=span)
        frame.add_floor_load(f"live-{level}", corners, LIVE, case="L")
    frame.add_tapered_load("beam-a1-b1", (0.0, 0.0, -8e3), (0.0, 0.0, 0.0), 0.3, 4.0)
    frame.set_mass_source({"D": 1.0, "L": 0.25})
    frame.set_damping(damping)
    return frame


@pytest.fixture(scope="module")
def shaken():
    frame = building().combined({"D": 1.0, "L": 0.5})
    data = time_history(frame, MOTION, dt=0.005)
    assert data.attrs["status"] == "ok"
    assert float(data["rim_force"].max()) > 0.0
    return frame, data


def test_energy_is_in_balance(shaken):
    assert energy_error(shaken[1]) < 1e-3


def test_masses_and_weights_add_up(shaken):
    frame, data = shaken
    system = assemble(frame)
    own = sum(m.section.area * m.section.density * length for m, length in lengths(frame))
    taper = 0.5 * 8e3 * 3.7
    floors = 3.0 * X * Y
    mass = own + (floors * (DEAD + 0.25 * LIVE) + taper) / frame.gravity
    assert system.node_mass[:, 0].sum() == pytest.approx(mass)
    weight = own * frame.gravity + floors * (DEAD + 0.5 * LIVE) + taper
    assert data.attrs["status"] == "ok"
    assert float(data["weight"]) == pytest.approx(weight, rel=1e-6)
    checked = frame.check()
    assert checked.mass == pytest.approx(mass)
    assert checked.loads[2] == pytest.approx(-0.25 * floors * LIVE)


def lengths(frame):
    for member in frame.members.values():
        start, end = (
            np.add(frame.nodes[node].position, offset)
            for node, offset in zip((member.i, member.j), member.offsets, strict=True)
        )
        yield member, float(np.linalg.norm(end - start))


def test_storeys_carry_what_moves_above_them(shaken):
    """The masses that loads make among it, and the loads that are none."""
    frame, data = shaken
    system = assemble(frame)
    found = storey_forces(frame, data)
    acceleration = data["node_acceleration"].sel(dof=["ux", "uy", "uz"]).to_numpy()
    cuts = [frame.levels[0].z - 1e-3, *(level.z + 1e-3 for level in frame.levels[:-1])]
    for level, cut in zip(frame.levels, cuts, strict=True):
        high = system.coordinates[:, 2] > cut
        inertia = -np.einsum("na,tna->ta", system.node_mass[:, :3] * high[:, None], acceleration)
        inertia[:, 2] += (system.node_load[2::6] * high).sum()
        passed = found.sel(storey=level.name, component=["Vx", "Vy", "Fz"]).to_numpy()
        scale = np.abs(inertia).max(axis=0)
        assert_allclose(passed / scale, inertia / scale, rtol=0.0, atol=5e-6)


def test_the_faces_of_a_beam_carry_its_clear_length(shaken):
    """Shears at the ends of the zones: the panel's load between them, by area."""
    frame, data = shaken
    clear = X - 0.4
    forces = member_forces(frame, data, ["beam-a2-b2"]).sel(component="Vz").isel(member=0)
    peak = (DEAD + 0.5 * LIVE) * 0.5 * Y  # 45 degrees from the corners on
    ends = 0.5 * Y - 0.2
    load = peak * (X - Y) + 2.0 * ends * 0.5 * peak * (1.0 + 0.2 / (0.5 * Y))
    assert load / clear < peak
    assert_allclose(forces.sum("end"), load, rtol=1e-9)


def test_reactions_are_the_weight_at_rest(shaken):
    frame, data = shaken
    lift = support_reactions(frame, data).sel(dof="uz").isel(time=0).sum()
    assert float(lift) == pytest.approx(float(data["weight"]), rel=1e-6)


def test_other_bearings_under_the_same_loads():
    frame = building(damping=ModalDamping(0.02))
    plain = frame.with_bearings(BEARING.as_dcfp())
    ours, theirs = assemble(frame), assemble(plain)
    for name in ("node_load", "node_mass"):
        assert_array_equal(getattr(theirs, name), getattr(ours, name))
    assert_array_equal(
        modes(plain, 3, bearings="fixed").periods, modes(frame, 3, bearings="fixed").periods
    )


def test_forces_under_gravity_follow_the_combination():
    """Bearings of a symmetric plan share each case alike, but for the tapered load."""
    frame = building()
    found = {
        name: gravity(frame.combined(factors)).axial_forces
        for name, factors in isolator_combinations().items()
    }
    floors = 3.0 * X * Y
    average, least = found["average"].sum(), found["minimum"].sum()
    live = 0.5 * LIVE * floors
    assert average - live == pytest.approx(least / 0.9, rel=1e-6)
    most = found["maximum"].sum()
    assert most == pytest.approx(1.2 * (average - live) + LIVE * floors, rel=1e-6)
    assert found["maximum"][0] > found["maximum"][2]  # the taper is at the edge of a
