"""Structures that yield, are damped and hit walls: against other routes through the program."""

from __future__ import annotations

import math
import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose

from frames import (
    AuditWarning,
    Frame,
    GroundMotion,
    ModalDamping,
    ModelError,
    Section,
    audit,
    lumped_mass,
    member_forces,
    moment_frame,
    shear_building,
    storey_forces,
    time_histories,
    time_history,
)
from frames.assembly.assemble import assemble
from frames.laws import Bilinear, BoucWen, Gap, HertzGap, PlasticHinge, Tie, ViscousDamper
from frames.statics.springs import is_plane
from lir_element import CoulombFriction
from tests.refusals import refused
from tests.scenes import heavy_bearing

DT = 0.005
MASS, STIFFNESS = 2e5, 1.2e8


def bearing(friction=0.05, capacity=0.2):
    return heavy_bearing(capacity=capacity, friction=CoulombFriction(friction))


def waves(size=2.2, axes="xy"):
    t = np.arange(0.0, 6.0, 0.01)
    shape = np.exp(-(((t - 2.2) / 1.5) ** 2))
    parts = {
        "x": np.sin(math.pi * t),
        "y": 0.7 * np.sin(1.6 * math.pi * t),
        "z": 0.1 * np.sin(20 * t),
    }
    return GroundMotion(dt=0.01, **{axis: size * parts[axis] * shape for axis in axes})


def stick(law=None, storeys=3, **options):
    options = {"damping": ModalDamping(0.02)} | options
    return shear_building(bearing(), MASS, STIFFNESS, storeys=storeys, storey_law=law, **options)


def yielding(stiffness):
    return Bilinear(stiffness=stiffness, yield_force=1.5e5, hardening=0.03)


STEEL = {
    "beam": PlasticHinge(moment_y=1.3e5, hardening=0.02),
    "column": PlasticHinge(moment_y=2e5, moment_z=2e5, axial=9e6, axial_exponent=1.5),
}


@pytest.fixture(scope="module")
def hinged():
    frame = moment_frame((1, 1), 2, bearing=bearing(0.1), hinges=STEEL, floor_load=3000.0)
    data = time_history(frame, waves(axes="xyz"), dt=DT)
    assert data.attrs["status"] == "ok"
    assert int((data["hinge_turn"].isel(time=-1) > 0.0).sum()) > 4
    return frame, data


@pytest.fixture(scope="module")
def stack():
    frame = stick(yielding)
    data = time_history(frame, waves(), dt=DT)
    assert data.attrs["status"] == "ok"
    assert float(np.abs(data["link_deformation"] / data["link_yield_deformation"]).max()) > 5.0
    return frame, data


def test_what_stays_elastic_is_the_linear_structure():
    plain = time_history(stick(), waves(), dt=DT)
    strong = stick(lambda k: Bilinear(stiffness=k, yield_force=1e9))
    same = time_history(strong, waves(), dt=DT)
    for name in ("node_displacement", "base_shear", "bearing_force"):
        scale = float(np.abs(plain[name]).max())
        assert_allclose(same[name], plain[name], rtol=0.0, atol=1e-6 * scale)
    assert not same["link_work"].any()


def test_hinges_that_do_not_turn_are_no_hinges():
    strong = {kind: PlasticHinge(moment_y=1e9, moment_z=1e9) for kind in ("beam", "column")}
    motion = waves(1.0)  # where rims are met, iterations of another order lead elsewhere
    plain, same = (
        time_history(moment_frame((1, 1), 2, bearing=bearing(), hinges=hinges), motion, dt=DT)
        for hinges in (None, strong)
    )
    assert_allclose(same["node_displacement"], plain["node_displacement"], rtol=0.0, atol=1e-7)
    forces = member_forces(moment_frame((1, 1), 2, bearing=bearing(), hinges=strong), same)
    for end in "ij":
        found = same["hinge_force"].sel(hinge=f"column-1-0-0:{end}")
        sign = -1.0 if end == "i" else 1.0
        own = forces.sel(member="column-1-0-0", end=end)
        assert_allclose(found[:, 1:], own.sel(component=["My", "Mz"]), rtol=1e-9, atol=1e-3)
        assert_allclose(found[:, 0], sign * own.sel(component="N"), rtol=1e-9, atol=1e-3)


def test_two_links_of_half_the_strength_are_one():
    law = yielding(STIFFNESS)
    half = Bilinear(stiffness=0.5 * STIFFNESS, yield_force=0.5 * law.yield_force, hardening=0.03)
    single, double = stick(yielding), stick(lambda k: half)
    for k in (1, 2, 3):
        below = "base" if k == 1 else f"floor-{k - 1}"
        for axis in "xy":
            double.add_link(f"twin-{k}-{axis}", below, f"floor-{k}", half, f"u{axis}")
    one, two = (time_history(frame, waves(), dt=DT) for frame in (single, double))
    assert_allclose(two["node_displacement"], one["node_displacement"], rtol=0.0, atol=3e-5)


def test_deformations_are_those_of_the_nodes(stack, hinged):
    for frame, data in (stack, hinged):
        system = assemble(frame)
        u = data["node_displacement"].to_numpy().reshape(data.sizes["time"], -1)
        n = len(frame.links)
        if n:
            found = np.asarray(system.parts.node_rows @ u.T).T[:, :n]
            assert_allclose(data["link_deformation"], found, rtol=0.0, atol=1e-9)


def test_storeys_are_in_equilibrium(stack, hinged):
    for (frame, data), motion in ((stack, waves()), (hinged, waves(axes="xyz"))):
        top = frame.levels[-1].name
        found = storey_forces(frame, data)
        base = found.sel(storey=frame.levels[0].name, component=["Vx", "Vy"])
        assert_allclose(base, data["base_shear"][:, :2], rtol=0.0, atol=1e-6 * np.abs(base).max())
        above = found.isel(storey=slice(1, None)).sel(component=["Vx", "Vy", "Fz"])
        scale = np.abs(above).max()
        assert_allclose(data["storey_shear"], above, rtol=0.0, atol=1e-9 * scale)
        kept = time_histories(frame, [motion], dt=DT)["peak_storey_shear"][0]
        in_plan = np.linalg.norm(above[..., :2], axis=-1).max(axis=0)
        assert_allclose(kept, in_plan, rtol=1e-9)
        if frame.links:
            shear = found.sel(storey=top, component="Vx")
            own = data["link_force"].sel(link=f"storey-{len(frame.levels) - 1}-x")
            assert_allclose(shear, own, rtol=0.0, atol=1e-6 * np.abs(shear).max())


def test_a_floor_that_is_not_damped_is_moved_by_its_storey():
    frame = moment_frame(
        (1, 1), 2, bearing=bearing(0.1), hinges=STEEL, damping=None, floor_load=3e3
    )
    data = time_history(frame, waves(), dt=DT)
    top = [name for name in frame.nodes if name.startswith("floor-2")]
    mass = assemble(frame).node_mass[[list(frame.nodes).index(name) for name in top], 0]
    moved = data["node_acceleration"].sel(node=top, dof=["ux", "uy"])
    inertia = -np.einsum("n,tna->ta", mass, moved)
    shear = storey_forces(frame, data).sel(storey="floor-2", component=["Vx", "Vy"])
    assert float(data["hinge_work"].isel(time=-1).sum()) > 0.0
    assert_allclose(shear, inertia, rtol=0.0, atol=1e-5 * np.abs(inertia).max())


def test_moments_of_hinges_are_those_of_the_members(hinged):
    frame, data = hinged
    forces = member_forces(frame, data)
    scale = float(np.abs(data["hinge_force"][..., 1:]).max())
    for name in ("beam-x-floor-1-0-0:i", "column-1-1-1:j", "beam-y-floor-2-1-0:j"):
        member, end = name.split(":")
        own = forces.sel(member=member, end=end, component=["My", "Mz"])
        found = data["hinge_force"].sel(hinge=name)[:, 1:]
        assert_allclose(found, own, rtol=0.0, atol=1e-7 * scale)


def test_no_hinge_bears_more_than_its_surface_and_hardening(hinged):
    _, data = hinged
    beams = data.sel(hinge=[str(h) for h in data["hinge"].to_numpy() if str(h).startswith("beam")])
    moment = np.abs(beams["hinge_force"].sel(hinge_force_component="My"))
    turned = np.abs(beams["hinge_rotation"].sel(hinge_force_component="My"))
    stiff = 0.02 / 0.98 * 6.0 * 2.1e11 * 8e-4 / 6.0  # not less than the modulus of any beam here
    assert float((moment - 1.3e5 - stiff * turned).max()) < 1.0


def test_the_ledger_closes_and_yielding_is_in_it(stack, hinged):
    for _, data in (stack, hinged):
        assert data.attrs["energy_error"] < 1e-5
        energy = data["energy"].isel(time=-1)
        works = [data[name] for name in ("link_work", "hinge_work") if name in data]
        work = sum(float(work.isel(time=-1).sum()) for work in works)
        assert_allclose(float(energy.sel(term="yielding")), work, rtol=1e-9)
        assert work > 0.02 * float(energy.sel(term="input"))
        assert float(np.diff(data["energy"].sel(term="yielding")).min()) > -0.01 * work  # hardening


def test_the_elastic_energy_is_that_of_the_springs(stack):
    """Storey links and the vertical springs store it; the energy balance finds it by difference."""
    frame, data = stack
    stored = np.sum(data["link_force"].to_numpy() ** 2 / (2.0 * STIFFNESS), axis=1)
    for spring in frame.springs.values():
        u = data["node_displacement"].sel(node=[spring.i, spring.j], dof="uz").to_numpy()
        stored += 0.5 * spring.stiffness[2] * (u[:, 1] - u[:, 0]) ** 2
    found = data["energy"].sel(term="elastic").to_numpy()
    assert_allclose(found, stored - stored[0], rtol=0.0, atol=2e-4 * stored.max())


def test_a_linear_damper_is_a_damping_matrix():
    c = 4e5
    linked, given = stick(damping=None), stick(damping=None)
    linked.add_link("damper", "ground", "floor-1", ViscousDamper(coefficient=c), "ux")
    block = np.zeros((12, 12))
    block[0, 0] = block[6, 6] = c
    block[0, 6] = block[6, 0] = -c
    given.add_superelement(
        "damper", ["ground", "floor-1"], np.zeros((12, 12)), np.zeros((12, 12)), damping=block
    )
    one, two = (time_history(frame, waves(), dt=DT) for frame in (linked, given))
    scale = float(np.abs(two["node_displacement"]).max())
    assert_allclose(one["node_displacement"], two["node_displacement"], rtol=0.0, atol=1e-5 * scale)
    dampers = one["energy"].isel(time=-1)
    assert_allclose(
        dampers.sel(term="dampers"), two["energy"].isel(time=-1).sel(term="damping"), rtol=1e-4
    )
    assert (
        float(np.abs(one["base_shear"] - two["base_shear"]).max()) > 0.0
    )  # ours counts the damper


@pytest.mark.parametrize(
    "law",
    [
        ViscousDamper(coefficient=3e5, exponent=0.3),
        ViscousDamper(coefficient=3e5, exponent=0.5, stiffness=4e7),
        Tie(stiffness=2e7, yield_force=2e5, slack=0.005),
        BoucWen(stiffness=2e7, yield_force=2e5, hardening=0.02, strength_loss=0.01),
        Gap(gap=0.1, stiffness=5e7, damping=1e6),
        HertzGap(gap=0.1, stiffness=2e8, restitution=0.6),
    ],
)
def test_the_ledger_closes_with_every_law(law):
    frame = stick(storeys=2)
    frame.add_link("part", "ground", "base", law, (0.8, 0.6, 0.0))
    data = time_history(frame, waves(1.8))
    energy = data["energy"].isel(time=-1)
    gap = energy.sel(term="input") - energy.drop_sel(term="input").sum()
    assert abs(float(gap)) < 1e-5 * float(energy.sel(term="input"))
    assert float(np.abs(data["link_force"]).max()) > 0.0


@pytest.mark.parametrize("integrator", ["newmark", "generalised-alpha"])
def test_finer_steps_find_the_same(integrator):
    found = []
    for dt in (0.01, 0.0025, 0.000625):
        data = time_history(
            stick(yielding), waves(), dt=dt, integrator=integrator, spectral_radius=0.9
        )
        worst = np.abs(data["link_deformation"]).max("time")
        found.append((worst / data["link_yield_deformation"]).to_numpy())
    first, second = (np.abs(one / found[2] - 1.0).max() for one in found[:2])
    assert second < 0.01
    assert first < 0.1


def test_a_wall_stops_the_base():
    """An undamped wall takes the energy of the mass: what it stores at the deepest point."""
    k, gap = 2e7, 0.08
    frame = lumped_mass(bearing(), MASS)
    frame.add_moat("moat", [next(iter(frame.masses))], Gap(gap=gap, stiffness=k))
    assert len(frame.links) == 4
    free = time_history(lumped_mass(bearing(), MASS), waves(axes="x"))
    data = time_history(frame, waves(axes="x"), dt=0.001)
    deepest = float(data["link_deformation"].max()) - gap
    force = float(data["link_force"].max())
    assert deepest > 0.0
    assert force == pytest.approx(k * deepest, rel=1e-6)
    assert float(data["energy"].sel(term="stops").max()) == pytest.approx(
        0.5 * k * deepest**2, rel=0.02
    )
    reached = np.abs(data["bearing_displacement"]).max()
    assert float(reached) < float(np.abs(free["bearing_displacement"]).max())
    assert float(np.abs(data["base_shear"]).max()) > 0.9 * force  # the ground holds the wall


def test_a_column_that_turns_in_a_hinge_bears_its_moment():
    """A mast on the base: its foot bears no more than the plastic moment, whatever shakes it."""
    moment, height = 0.8e5, 4.0
    frame = lumped_mass(bearing(), 3 * MASS)
    base = next(iter(frame.masses))
    z = frame.nodes[base].z
    frame.add_node("top", 0.0, 0.0, z + height)
    frame.add_member("mast", base, "top", Section.box(0.4, 0.4, 0.02))
    frame.add_mass("top", 2e4)
    frame.add_hinges("mast", {"i": PlasticHinge(moment_y=moment, moment_z=moment, hardening=0.0)})
    data = time_history(frame, waves(2.0), dt=0.002)
    found = np.linalg.norm(data["hinge_force"].sel(hinge="mast:i")[:, 1:], axis=1)
    assert found.max() == pytest.approx(moment, rel=1e-6)
    assert float(data["hinge_turn"].isel(time=-1).max()) > 1e-3
    turned = data["hinge_rotation"].isel(time=-1).sel(hinge="mast:i").to_numpy()[1:]
    leaning = data["node_displacement"].isel(time=-1)
    drift = (leaning.sel(node="top") - leaning.sel(node=base)).to_numpy()[:2]
    assert np.linalg.norm(drift) == pytest.approx(height * np.linalg.norm(turned), rel=0.3)


def test_auto_chooses_with_parts_too():
    data = time_history(stick(yielding, storeys=1), waves(1.0, "x"), level="auto")
    assert data.attrs["status"] == "ok"
    assert "second_direction" in data.attrs["features_left_out"]


def test_the_level_of_bodies_takes_no_links():
    frame = lumped_mass(bearing(), MASS)
    frame.add_link("damper", "ground", "mass", ViscousDamper(coefficient=1e5), "ux")
    refused(ModelError, "it has links or hinges", time_history, frame, waves(), level="rigid_body")
    data = time_history(frame, waves(1.5), level="contact")
    assert float(data["energy"].sel(term="dampers")[-1]) > 0.0


def test_an_oblique_link_couples_the_plane():
    frame = stick(storeys=1)
    assert is_plane(assemble(frame))
    frame.add_link("along", "base", "floor-1", yielding(1e7), "ux")
    assert is_plane(assemble(frame))
    frame.add_link("oblique", "base", "floor-1", yielding(1e7), (1.0, 1.0, 0.0))
    assert not is_plane(assemble(frame))


def test_copies_carry_all_and_lose_what_is_removed():
    frame = stick(yielding)
    frame.add_moat("moat", ["base"], Gap(gap=0.3, stiffness=1e7))
    other = frame.with_bearings(bearing(0.08), "other")
    assert dict(other.links) == dict(frame.links)
    other.remove("link", "storey-1-x")
    assert "storey-1-x" in frame.links
    building = moment_frame((1, 1), 1, bearing=bearing(), hinges=STEEL)
    building.remove("member", "column-1-0-0")
    assert "column-1-0-0" not in building.hinges
    building.remove("hinges", "column-1-1-1")
    assert "column-1-1-1" in building.members


def test_the_parts_are_counted():
    frame = stick(yielding)
    assert "6 links" in repr(frame)
    assert "links" in frame._repr_html_()


def _braced(law, direction="axial"):
    frame = stick(storeys=1)
    frame.add_link("brace", "base", "floor-1", law, direction)
    return frame


@pytest.mark.parametrize(
    ("change", "error", "message"),
    [
        (lambda f: f.add_link("a", "base", "none", yielding(1e6)), ModelError, 'no node "none"'),
        (lambda f: f.add_link("a", "base", "floor-1", 3.0), TypeError, "law of link"),
        (
            lambda f: f.add_link("a", "base", "floor-1", yielding(1e6), "up"),
            ModelError,
            "direction",
        ),
        (
            lambda f: f.add_link("a", "base", "floor-1", yielding(1e6), (0, 0, 0)),
            ModelError,
            "no length",
        ),
        (lambda f: f.add_moat("m", ["base"], yielding(1e6)), TypeError, "law of moat"),
        (
            lambda f: f.add_moat("m", ["base"], {"z+": Gap(gap=0.1, stiffness=1.0)}),
            ValueError,
            "side of moat",
        ),
        (lambda f: f.add_hinges("none", STEEL["beam"]), ModelError, 'no member "none"'),
    ],
)
def test_what_cannot_be_is_refused_and_changes_nothing(change, error, message):
    frame = stick(storeys=1)
    before = repr(frame)
    refused(error, message, change, frame)
    assert repr(frame) == before


def test_hinges_are_refused_where_they_do_not_belong():
    frame = moment_frame((1, 1), 1, bearing=bearing())
    frame.add_member(
        "strut", "base-0-0", "floor-1-1-0", Section.circle(0.1, 0.01), releases={"i": ("My",)}
    )
    refused(ModelError, "has releases", frame.add_hinges, "strut", STEEL["beam"])
    frame.add_hinges("column-1-0-0", {"j": STEEL["column"]})
    refused(ModelError, "column-1-0-0", frame.add_hinges, "column-1-0-0", STEEL["column"])
    refused(ModelError, "names no end", frame.add_hinges, "column-1-1-0", {})
    with pytest.raises(ModelError, match="kind of member with hinges"):
        moment_frame((1, 1), 1, bearing=bearing(), hinges={"brace": STEEL["beam"]})


def test_what_yields_under_permanent_loads_is_refused():
    weak = Bilinear(stiffness=1e9, yield_force=1e4)
    with pytest.raises(ModelError, match=r'link "brace" carries .* of the permanent loads'):
        time_history(_braced(weak), waves())
    frame = moment_frame((1, 1), 1, bearing=bearing(), hinges={"beam": PlasticHinge(moment_y=2e3)})
    for name in frame.members:
        if name.startswith("beam"):
            frame.add_uniform_load(name, (0.0, 0.0, -2e4))
    with pytest.raises(ModelError, match=r'hinge at end i of member "beam-x-.* yields under'):
        time_history(frame, waves())


def test_storey_laws_must_fit_the_storeys():
    refused(ModelError, "2 laws for 3 storeys", stick, [yielding(1e8)] * 2)
    refused(TypeError, "storey_law of storey 1", stick, [Tie(stiffness=1e8)] * 3)


def test_a_node_that_only_a_damper_holds_is_refused():
    frame = Frame("loose")
    frame.add_node("ground", 0.0, 0.0, 0.0)
    frame.fix("ground", "all")
    frame.add_node("top", 0.0, 0.0, 1.0)
    frame.add_mass("top", 1.0)
    frame.add_link("damper", "ground", "top", ViscousDamper(coefficient=1.0))
    refused(ModelError, "no member, spring", assemble, frame)


def test_the_audit_marks_hinges_that_turn_further_than_members_last():
    frame = lumped_mass(bearing(), 3 * MASS)
    base = next(iter(frame.masses))
    frame.add_node("top", 0.0, 0.0, frame.nodes[base].z + 4.0)
    frame.add_member("mast", base, "top", Section.box(0.4, 0.4, 0.02))
    frame.add_mass("top", 2e4)
    found = []
    for moment in (1.5e4, 9e4, 5e6):
        model = frame.copy()
        hinge = PlasticHinge(moment_y=moment, moment_z=moment, hardening=0.005)
        model.add_hinges("mast", {"i": hinge})
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", AuditWarning)
            data = time_history(model, waves(2.0), dt=0.002)
        [finding] = [one for one in audit(data) if one.feature == "yielding"]
        turned = np.linalg.norm(data["hinge_rotation"][..., 1:], axis=-1).max()
        assert finding.number == pytest.approx(turned)
        assert finding.doubtful is bool(turned > 0.05)
        found.append((finding.mattered, finding.doubtful))
    assert found[0] == (True, True)
    assert found[-1] == (False, False)
