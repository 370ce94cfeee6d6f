"""Extremes of forces that a run keeps: those of histories recovered step by step, and statics."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from frames import (
    Frame,
    Recording,
    Section,
    gravity,
    lumped_mass,
    member_forces,
    moment_frame,
    storey_forces,
    support_reactions,
    time_histories,
    time_history,
)
from frames.laws import Bilinear, PlasticHinge
from frames.recording.force_rows import force_maps
from frames.solve import recorder
from tests.scenes import simple_bearing, swell

DT = 0.005
MOTION = swell(x=(2.2, 1.4), y=(1.0, 0.8), middle=1.2, width=0.7, end=2.5)
BEARING = simple_bearing(slider_height=0.2, slider_radius=0.2, capacity=0.2)
FORCES = Recording(every=None, forces=True)
BEAM = Section.rectangle(0.3, 0.4, elastic_modulus=30e9, poisson_ratio=0.2, density=0.0)


def elastic():
    """Return a building with loads along members, released ends and rigid end zones."""
    frame = moment_frame((2, 1), 2, bearing=BEARING)
    frame.add_mass("floor-2-2-1", 2e4)
    frame.add_uniform_load("beam-x-floor-1-0-0", (2e3, 1e3, -9e3))
    frame.add_tapered_load("beam-x-floor-1-1-0", (0.0, 3e3, -9e3), (1e3, 0.0, -2e4), 1.0, 5.0)
    frame.add_member(
        "brace",
        "base-0-0",
        "floor-1-1-0",
        BEAM,
        releases={"i": ("My", "Mz"), "j": ("My",)},
        offsets={"i": (0.3, 0.0, 0.2), "j": (-0.3, 0.0, -0.2)},
    )
    return frame


def yielding():
    """Return a building whose members turn in hinges, with a link that yields."""
    hinge = PlasticHinge(moment_y=6e4, moment_z=6e4)
    frame = moment_frame((1, 1), 1, bearing=BEARING, hinges={"column": hinge, "beam": hinge})
    law = Bilinear(stiffness=2e7, yield_force=2e4, hardening=0.02)
    frame.add_link("brace", "base-0-0", "floor-1-1-0", law)
    return frame


@pytest.fixture(scope="module", params=[elastic, yielding])
def building(request):
    """Return a building, its whole record, and what a run kept without any step."""
    frame = request.param()
    whole = time_history(frame, MOTION, dt=DT)
    if request.param is yielding:
        assert float(whole["hinge_turn"].max()) > 1e-4
    return frame, whole, time_history(frame, MOTION, dt=DT, recording=FORCES)


def assert_extremes(data, name, histories, time, places=...):
    """Hold what was kept to histories (time, section, 6): extremes, what acts with them, when."""
    kept = data[f"peak_{name}_force"].to_numpy()[places]
    at = data[f"peak_{name}_force_at"].to_numpy()[places]
    kept = kept.reshape(-1, *kept.shape[-3:])
    at = at.reshape(-1, *at.shape[-2:])
    scale = np.abs(histories).max(axis=(0, 1))
    assert (scale > 0.0).all()
    sections, forces = kept.shape[0], np.arange(6)
    for way, sign in enumerate((1.0, -1.0)):
        extreme = kept[:, forces, way, forces]
        wanted = (sign * histories).max(axis=0) * sign
        assert_allclose(extreme / scale, wanted / scale, rtol=0.0, atol=1e-9)
        step = np.searchsorted(time, at[:, :, way] - 1e-9)
        together = histories[step, np.arange(sections)[:, None]]
        assert_allclose(kept[:, :, way] / scale, together / scale, rtol=0.0, atol=1e-9)


def ends(frame, whole):
    """Return forces at both ends of members by one sign along them, (time, sections, 6)."""
    found = member_forces(frame, whole).to_numpy() * np.array([-1.0, 1.0])[:, None]
    return found.reshape(len(found), -1, 6)


def test_forces_at_the_ends_of_members_are_those_of_every_step(building):
    frame, whole, kept = building
    histories, time = ends(frame, whole), whole["time"].to_numpy()
    assert_extremes(kept, "member", histories, time, np.s_[:, [0, 2]])
    rest = kept["peak_member_force_at_rest"].to_numpy()[:, [0, 2]].reshape(-1, 6)
    assert_allclose(rest, histories[0], rtol=0.0, atol=1e-6)


def test_storeys_and_reactions_are_those_of_every_step(building):
    frame, whole, kept = building
    time = whole["time"].to_numpy()
    assert_extremes(kept, "storey", storey_forces(frame, whole).to_numpy(), time)
    force = whole["bearing_force"].transpose("time", "bearing", "axis").to_numpy()
    moment = whole["bearing_moment"].transpose("time", "bearing", "end", "axis").to_numpy()
    for side, sign in enumerate((1.0, -1.0)):  # on what is below, node i, and above, node j
        pressing = -force[:, :, 2:]
        plan = sign * force[:, :, :2]
        histories = np.concatenate([pressing, plan, -moment[:, :, side]], axis=2)
        assert_extremes(kept, "reaction", histories, time, np.s_[:, side])


def test_reactions_below_hold_the_building(building):
    """What bearings exert on the ground is the opposite of what supports exert on the structure."""
    frame, whole, kept = building
    held = support_reactions(frame, whole)
    for name, link in frame.bearings.items():
        mine = kept["peak_reaction_force"].sel(bearing=name, side="below")
        for reaction, dof, sign in (("N", "uz", 1.0), ("Vx", "ux", -1.0), ("My", "ry", -1.0)):
            theirs = sign * held.sel(support=link.i, dof=dof).to_numpy()
            found = mine.sel(reaction=reaction, reaction_at_once=reaction).to_numpy()
            assert_allclose(found, [theirs.max(), theirs.min()], rtol=1e-9, atol=1e-4)


def test_a_displaced_bearing_bends_foundation_and_slab_by_its_share_of_the_load_times_the_way():
    """Equal surfaces: half of N u each, and the rest of what shear does over the height."""
    frame = lumped_mass(BEARING, 50e3)
    whole = time_history(frame, MOTION, dt=DT)
    kept = time_history(frame, MOTION, dt=DT, recording=FORCES)["peak_reaction_force"]
    u = whole["bearing_displacement"].isel(bearing=0).to_numpy()
    load, shear = whole["axial_force"].isel(bearing=0), whole["bearing_force"].isel(bearing=0)
    n = -shear.sel(axis="z").to_numpy()
    height = BEARING.height + u[:, 2]
    about_y = -0.5 * (n * u[:, 0] + height * shear.sel(axis="x").to_numpy())
    most = np.abs(about_y).max()
    assert most > 0.4 * float(load.mean()) * np.abs(u[:, 0]).max()
    for side in ("below", "above"):
        found = kept.isel(bearing=0).sel(side=side, reaction="My", reaction_at_once="My")
        size = np.abs(found.to_numpy()).max()
        assert size == pytest.approx(most, rel=2e-2)


def test_the_middle_of_a_member_has_what_its_load_asks_for(building):
    """Forces of the part from end i to the middle, loads integrated by many points."""
    frame, _, kept = building
    rest = kept["peak_member_force_at_rest"]
    loads = {
        name: lambda x, q=q: np.outer(np.ones_like(x), q) for name, q in frame.uniform_loads.items()
    }
    for name, some in frame.tapered_loads.items():
        load = some[0]
        loads[name] = lambda x, p=load: np.where(
            ((x > p.a) & (x < p.b))[:, None],
            np.array(p.start) + np.outer((x - p.a) / (p.b - p.a), np.subtract(p.end, p.start)),
            0.0,
        )
    system = gravity(frame).system
    for k, name in enumerate(system.members.names):
        axes, length = system.members.arrays.axes[k], system.members.arrays.length[k]
        first, middle, last = rest.sel(member=name).to_numpy()
        for start, at_end, sign in ((first, 0.0, 1.0), (last, length, -1.0)):
            count = 3000
            x = (np.arange(count) + 0.5) * 0.5 * length / count + (
                0.0 if at_end == 0.0 else 0.5 * length
            )
            q = loads[name](x) @ axes.T if name in loads else np.zeros((count, 3))
            part = q * 0.5 * length / count
            force = start[:3] - sign * part.sum(axis=0)
            arm = np.zeros((count, 3))
            arm[:, 0] = x - 0.5 * length
            lever = np.array([at_end - 0.5 * length, 0.0, 0.0])
            moment = start[3:] + np.cross(lever, start[:3]) - sign * np.cross(arm, part).sum(axis=0)
            assert_allclose(middle[:3], force, rtol=0.0, atol=1e-6 * np.abs(first).max() + 0.1)
            # second order of the permanent force over the difference of the ends is of both halves
            assert_allclose(middle[3:], moment, rtol=0.0, atol=2e-4 * np.abs(rest).max())


def test_a_simple_beam_sags_by_q_l_squared_over_eight():
    frame = Frame("beam")
    for k, x in enumerate((0.0, 8.0)):
        frame.add_node(f"ground-{k}", x, 0.0, 0.0)
        frame.add_node(f"top-{k}", x, 0.0, BEARING.height)
        frame.fix(f"ground-{k}", "all")
        frame.add_bearing(f"bearing-{k}", f"ground-{k}", f"top-{k}", BEARING)
        frame.add_mass(f"top-{k}", 1e4)
        frame.fix(f"top-{k}", "rx", "ry", "rz")
    free = ("My", "Mz")
    frame.add_member("beam", "top-0", "top-1", BEAM, releases={"i": free, "j": free})
    frame.add_uniform_load("beam", (0.0, 0.0, -10e3))
    data = time_history(frame, MOTION, duration=0.1, recording=FORCES)
    rest = data["peak_member_force_at_rest"].sel(member="beam")
    assert_allclose(rest.sel(component="My"), [0.0, -10e3 * 8.0**2 / 8.0, 0.0], atol=1e-3)
    assert_allclose(rest.sel(component="Vz"), [-40e3, 0.0, 40e3], rtol=1e-9, atol=1e-6)


def test_forces_that_bars_have_are_tension_positive_along_all_of_them():
    frame = elastic()
    data = time_history(frame, MOTION, dt=DT, duration=1.5, recording=FORCES)
    rest = data["peak_member_force_at_rest"].sel(component="N")
    columns = rest.sel(member=[n for n in frame.members if n.startswith("column")])
    assert (columns < 0.0).all()
    assert_allclose(columns.sel(station="i"), columns.sel(station="j"), rtol=1e-9)


def test_batch_and_small_buffers_keep_the_same(building, monkeypatch):
    frame, _, kept = building
    runs = time_histories(frame, {"pulse": MOTION}, dt=DT, record=FORCES, workers=1)
    monkeypatch.setattr(recorder, "BUFFER", 1e3)
    piecewise = time_history(frame, MOTION, dt=DT, recording=FORCES)
    names = [str(name) for name in kept.data_vars if "_force" in str(name)]
    names = [n for n in names if n.startswith(("peak_member", "peak_storey_f", "peak_rea"))]
    assert len(names) == 9
    for name in names:
        assert_array_equal(runs[name].to_numpy()[0], kept[name].to_numpy())
        scale = np.abs(kept[name]).max()
        assert_allclose(piecewise[name] / scale, kept[name] / scale, rtol=0.0, atol=1e-12)


def test_maps_hold_no_more_than_they_need():
    frame = elastic()
    maps = force_maps(frame, gravity(frame))
    assert [kind.shape for kind in maps.kinds] == [(len(frame.members), 3), (3,), (6, 2)]
    assert maps.rows.shape[0] == 6 * sum(int(np.prod(kind.shape)) for kind in maps.kinds)


def test_one_bearing_with_a_mass_has_no_structure_to_recover():
    with pytest.raises(ValueError, match=r"forces = True: at level=.rigid_body. there is one"):
        time_history(
            lumped_mass(BEARING, 50e3), MOTION, level="rigid_body", recording=Recording(forces=True)
        )
