"""Member forces, storey forces and reactions are in equilibrium with what moves."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from frames import (
    Frame,
    ModelError,
    force_tables,
    lumped_mass,
    member_forces,
    moment_frame,
    storey_forces,
    support_reactions,
    time_history,
)
from frames.assembly.assemble import assemble
from frames.library.models import DEFAULT_BASE_BEAM, DEFAULT_BEAM, DEFAULT_COLUMN
from frames.model.axes import to_global
from lir_element.opensees import bearing_element
from tests.scenes import simple_bearing as bearing
from tests.scenes import swell
from validation.claims.opensees_building import slender
from validation.opensees.frames import add_loads, build
from validation.opensees.model import (
    advance,
    empty_model,
    gravity_analysis,
    ground_motion,
    solver,
    transient_steps,
)

MOTION = swell(x=(1.7, 1.4), y=(1.0, 0.8), z=(1.5, 0.2))


@pytest.fixture(scope="module")
def building():
    """Return an eccentric building without damping, whose rims are met, and its history."""
    frame = moment_frame((2, 1), 3, bearing=bearing(), damping=None)
    frame.add_mass("floor-2-2-0", 2e4)
    frame.add_uniform_load("beam-x-floor-1-0-0", (0.0, 0.0, -5e3))
    data = time_history(frame, MOTION, dt=0.005)
    assert data.attrs["status"] == "ok"
    assert float(data["rim_force"].max()) > 0.0
    return frame, data


def parts_above(frame, height):
    """Return masses (n, 3), permanent vertical loads and places (n, 3) of the nodes above it."""
    system = assemble(frame)
    high = system.coordinates[:, 2] > height
    masses = system.node_mass[:, :3] * high[:, None]
    return masses, system.node_load[2::6] * high, system.coordinates


def acceleration(data):
    return data["node_acceleration"].sel(dof=["ux", "uy", "uz"]).to_numpy()


def feet(frame):
    """Return the storeys' names, and the heights at which they are cut."""
    levels = frame.levels
    below = [levels[0].z - 1e-3, *(level.z + 1e-3 for level in levels[:-1])]
    return [level.name for level in levels], below


def test_storeys_carry_what_moves_above_them(building):
    frame, data = building
    found = storey_forces(frame, data)
    names, cuts = feet(frame)
    assert [str(name) for name in found["storey"].to_numpy()] == names
    for name, cut in zip(names, cuts, strict=True):
        masses, loads, _ = parts_above(frame, cut)
        inertia = -np.einsum("na,tna->ta", masses, acceleration(data))
        inertia[:, 2] += loads.sum()
        passed = found.sel(storey=name, component=["Vx", "Vy", "Fz"]).to_numpy()
        scale = np.abs(inertia).max(axis=0)
        assert (scale > 1e4).all()
        assert_allclose(passed / scale, inertia / scale, rtol=0.0, atol=2e-6)


def test_overturning_and_torsion_are_the_moments_of_what_moves(building):
    """Up to the second order that the permanent axial forces add over relative displacements."""
    frame, data = building
    found = storey_forces(frame, data)
    names, cuts = feet(frame)
    for k, (name, cut) in enumerate(zip(names, cuts, strict=True)):
        below = frame.levels[max(k - 1, 0)]
        middle = np.mean([frame.nodes[node].position for node in below.nodes], axis=0)
        masses, loads, places = parts_above(frame, cut)
        forces = -masses * acceleration(data)
        forces[..., 2] += loads
        moments = np.cross(places - middle, forces).sum(axis=1)
        turning = assemble(frame).node_mass[:, 3:] * (places[:, 2] > cut)[:, None]
        moments -= np.einsum("na,tna->ta", turning, data["node_acceleration"][..., 3:].to_numpy())
        passed = found.sel(storey=name, component=["Mx", "My", "Mz"]).to_numpy()
        scale = np.abs(moments).max(axis=0)
        assert (np.abs(passed - moments).max(axis=0) < 0.02 * scale).all(), name
        assert scale[2] > 1e4  # it is eccentric


def test_lowest_cut_is_the_base_shear(building):
    frame, data = building
    found = storey_forces(frame, data).isel(storey=0)
    shear = data["base_shear"].sel(axis=["x", "y"]).to_numpy()
    assert_allclose(found.sel(component=["Vx", "Vy"]), shear, rtol=1e-9, atol=1e-6)
    reactions = support_reactions(frame, data)
    total = reactions.sel(dof=["ux", "uy", "uz"]).sum("support").to_numpy()
    assert_allclose(total[:, :2], -shear, rtol=1e-9, atol=1e-6)
    assert_allclose(total[:, 2], -found.sel(component="Fz"), rtol=1e-9, atol=1e-3)
    assert set(reactions["support"].to_numpy()) == set(frame.fixed_dofs)


def test_columns_of_a_storey_carry_its_shear(building):
    frame, data = building
    ends = member_forces(frame, data)
    system = assemble(frame)
    low, high = frame.levels[1].z, frame.levels[2].z
    total = np.zeros((data.sizes["time"], 3))
    for m, name in enumerate(system.members.names):
        member = frame.members[name]
        if {frame.nodes[member.i].z, frame.nodes[member.j].z} == {low, high}:
            foot = "i" if frame.nodes[member.i].z == low else "j"
            local = ends.sel(member=name, end=foot, component=["N", "Vy", "Vz"]).to_numpy()
            total -= local @ system.members.arrays.axes[m]
    shear = storey_forces(frame, data).sel(storey=frame.levels[2].name)
    assert_allclose(total, shear.sel(component=["Vx", "Vy", "Fz"]), rtol=1e-9, atol=1e-3)
    assert_allclose(data["storey_shear"].sel(storey=frame.levels[2].name), total, atol=1e-3)


def test_bearings_made_of_bodies_are_in_equilibrium_too(building):
    frame, _ = building
    some = {name: "contact" for name in list(frame.bearings)[:2]}
    data = time_history(frame, MOTION, 1.0, dt=0.005, level=some)
    found = storey_forces(frame, data).sel(storey="floor-2", component=["Vx", "Vy"])
    masses, _, _ = parts_above(frame, frame.levels[1].z + 1e-3)
    inertia = -np.einsum("na,tna->ta", masses, acceleration(data))[:, :2]
    assert_allclose(found, inertia, rtol=0.0, atol=1e-5 * np.abs(inertia).max())


def test_another_model_is_refused(building):
    frame, data = building
    other = lumped_mass(bearing(), 3e4)
    with pytest.raises(ModelError, match=r"not computed with this model: it has \d+ nodes"):
        member_forces(other, data)
    with pytest.raises(ModelError, match=r'no member "nothing" in moment frame; its members: beam'):
        member_forces(frame, data, ["nothing"])
    bare = Frame("bare")
    bare.add_node("ground", 0.0, 0.0, 0.0)
    bare.add_node("top", 0.0, 0.0, bearing().height)
    bare.fix("ground", "all")
    bare.fix("top", "rx", "ry", "rz")
    bare.add_bearing("one", "ground", "top", bearing())
    bare.add_mass("top", 3e4, (1e3, 1e3, 1e3))
    run = time_history(bare, MOTION, 0.1)
    with pytest.raises(ModelError, match=r"bare has no level: storeys need Frame.add_level"):
        storey_forces(bare, run)


def test_tables_hold_the_extremes(building):
    frame, data = building
    tables = force_tables(frame, data)
    assert list(tables) == ["members", "storeys", "supports"]
    ends = member_forces(frame, data)
    row = tables["members"].loc["beam-x-floor-1-0-0", "j", "Mz"]
    history = ends.sel(member="beam-x-floor-1-0-0", end="j", component="Mz")
    assert row["largest"] == float(history.max())
    assert row["time_of_smallest"] == float(data["time"][int(history.to_numpy().argmin())])
    assert len(tables["members"]) == 12 * len(frame.members)
    assert len(tables["storeys"]) == 6 * 4
    assert tables["supports"].notna().all(axis=None)


def test_end_forces_are_those_of_opensees():
    """The same frame on the same bearings in OpenSees, whose columns know P-Delta by the chord."""
    parts = {"column": DEFAULT_COLUMN, "beam": DEFAULT_BEAM, "base_beam": DEFAULT_BASE_BEAM}
    frame = moment_frame(
        (1, 1),
        2,
        bearing=bearing(capacity=math.inf),
        damping=None,
        **{name: slender(section) for name, section in parts.items()},
    )
    frame.add_mass("floor-2-1-1", 1e4)
    motion = MOTION.scaled([1.0, 1.0, 0.0]).trimmed(0.0, 2.5)
    data = time_history(frame, motion, dt=0.005)
    names, supports = list(frame.members), list(frame.fixed_dofs)
    steps = data.sizes["time"]
    theirs, reactions = np.zeros((steps, len(names), 12)), np.zeros((steps, len(supports), 6))
    with empty_model() as ops:
        built = build(ops, frame, lambda tag, i, j, one: bearing_element(tag, i, j, one))
        add_loads(ops, frame, built)
        gravity_analysis(ops)
        ground_motion(ops, motion)
        solver(ops, 1e-9)
        transient_steps(ops)
        for k in range(steps):
            if k:
                advance(ops, 1, 0.005, 1e-9)
            theirs[k] = [ops.eleResponse(built.members[name], "force") for name in names]
            ops.reactions()
            reactions[k] = [ops.nodeReaction(built.nodes[name]) for name in supports]
    local = member_forces(frame, data).to_numpy().reshape(steps, -1, 12)
    ours = to_global(local, assemble(frame).members.arrays.axes)
    own = support_reactions(frame, data).sel(support=supports).to_numpy()
    for mine, other in ((ours, theirs), (own, reactions)):
        apart = np.abs(mine - other).reshape(*mine.shape[:2], -1, 2, 3)
        scale = np.abs(other).reshape(*mine.shape[:2], -1, 2, 3)
        for kind in range(2):  # forces, moments
            assert apart[..., kind, :].max() < 1e-3 * scale[..., kind, :].max()
