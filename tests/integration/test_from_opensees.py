"""Frame.from_opensees: against the same building built here, and analysed wholly in OpenSees."""

import importlib.util
from functools import partial

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy import sparse

from frames import Frame, ModalDamping, ModelWarning, gravity, modes, moment_frame, storey_drift
from frames.demo import table_of
from frames.solve import run as transient
from frames.statics import gravity as static
from lir_element import CoulombFriction
from lir_element.device.bearing import STANDARD_GRAVITY as G
from tests.scenes import uneven_bearing
from validation.claims.opensees_superstructure import BEAM, COLUMN, PENDULUM
from validation.opensees.frames import add_loads, build
from validation.opensees.isolators import add_ground, damp, put_on_isolators, spring, waves
from validation.opensees.model import gravity_analysis, solver, static_steps
from validation.opensees.runs import respond

pytestmark = pytest.mark.skipif(
    importlib.util.find_spec("openseespy") is None, reason="openseespy is not installed"
)

FLOORS = ("floor-1", "floor-2")


lir = partial(uneven_bearing, radius=1.0, capacity=0.15)


def building(bearing, **options):
    return moment_frame(bays=(1, 1), storeys=2, bearing=bearing, damping=None, **options)


def build_anew(ops, frame, **options):
    """Build a frame in OpenSees, without its bearings."""
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    return build(ops, frame, **options)


def analysis_at_hand(ops):
    """Set an analysis up, and take no step of it."""
    solver(ops)
    static_steps(ops, 0.0)


def histories_apart(first, second, names, others):
    """Largest difference of two runs over the largest value, by variable."""
    found = {}
    words = ("bearing_displacement", "bearing_force", "base_shear", "energy")
    for word in (*words, "node_displacement", "node_acceleration"):
        by_node = word.startswith("node")
        a = (first[word].sel(node=names) if by_node else first[word]).to_numpy()
        b = (second[word].sel(node=others) if by_node else second[word]).to_numpy()
        found[word] = float(np.abs(a - b).max() / np.abs(a).max())
    return found


def without_geometric_stiffness(monkeypatch):
    """Let the building that is built here have none, as the one with Linear transformations."""
    monkeypatch.setattr(
        static, "geometric_stiffness", lambda system, _: sparse.csr_array(system.stiffness.shape)
    )


@pytest.mark.quick
def test_the_same_building_built_here(ops, run, monkeypatch):
    """All periods, and a history with rim contact, slip and uneven axial forces."""
    without_geometric_stiffness(monkeypatch)
    device = lir()
    built = building(device)
    there = build_anew(ops, built, transformation="Linear")
    taken = Frame.from_opensees(there.bases, device, gravity=G)
    for frame in (built, taken):
        frame.set_damping(ModalDamping(0.03))
    for kind in ("sliding", "sticking", "fixed"):
        expected, found = modes(built, 1000, kind), modes(taken, 1000, kind)
        assert_allclose(found.periods, expected.periods, rtol=1e-9)
        assert_allclose(found.mass_ratios.sum(axis=0), expected.mass_ratios.sum(axis=0), rtol=1e-9)
    motion = waves(0.7, 5.0)
    first, second = run(built, motion, dt=0.005), run(taken, motion, dt=0.005)
    assert first.attrs["status"] == "ok"
    assert float(first["rim_force"].max()) > 0.0
    assert float(first["interface_slip_size"].max()) > 1e-3
    names, others = list(there.nodes), [str(tag) for tag in there.nodes.values()]
    for word, apart in histories_apart(first, second, names, others).items():
        # impacts pass round-off on, by the processor, to accelerations and forces
        assert apart < (1e-6 if word.endswith("displacement") else 1e-5), word
    assert_allclose(storey_drift(second), storey_drift(first), rtol=0.0, atol=1e-9)
    assert "completed" in table_of({"built": first, "taken": second})


KINDS = ("none", "mass and initial stiffness", "present stiffness", "by regions", "modal")


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.meant("the damping of the OpenSees model")
def test_the_same_building_wholly_in_opensees(ops, run, monkeypatch, kind):
    """P-Delta, diaphragms and every kind of damping; the isolators are linear in both programs."""
    monkeypatch.setattr(transient, "_FORCE_TOLERANCE", 1e-12)
    stiffness, damping = 2e9, 1e6
    device = lir(
        capacity=np.inf,
        friction=CoulombFriction(1e-9),
        axial_stiffness=stiffness,
        axial_damping=damping,
    ).as_dcfp()
    built = building(device, column=COLUMN, beam=BEAM, base_beam=BEAM)
    # OpenSees mixes up the modes of nodes that are tied where it damps by modes
    tied = () if kind == "modal" else FLOORS
    there = build_anew(ops, built, diaphragms=tied)
    bases = there.bases
    for tag in bases:
        ops.fix(tag, 1, 1, 1, 0, 0, 0)
    add_ground(ops, bases)
    add_loads(ops, built, there)
    damp(ops, there, kind)
    gravity_analysis(ops)
    if kind == "modal":
        analysis_at_hand(ops)
        ops.eigen("-genBandArpack", 4)
        ops.modalDamping(0.05)
    taken = Frame.from_opensees(bases, device, base_diaphragm=bool(tied))
    state = gravity(taken, PENDULUM)
    assert bool(state.basis.damping_ee.size) == (kind not in {"none", "present stiffness"})
    assert (state.basis.mass_e == 0.0).any() == (kind == "by regions")
    motion, dt, duration = waves(0.02, 3.0), 0.005, 3.0
    data = run(taken, motion, dt=dt, duration=duration, features=PENDULUM)
    damped = float(data["energy"].sel(term="damping")[-1] / data["energy"].sel(term="input")[-1])
    assert damped > 1e-4 if kind != "none" else damped == 0.0

    put_on_isolators(ops, bases, device, state.axial_forces, spring, diaphragm=bool(tied))
    nodes = [bases[0], *[there.nodes[f"floor-{k}-1-0"] for k in (1, 2)]]
    track = respond(
        ops, motion, dt, nodes, duration=duration, tolerance=1e-10, system="FullGeneral"
    )
    expected = track.displacement - track.displacement[0]
    found = data["node_displacement"].sel(node=[str(tag) for tag in nodes]).to_numpy()
    found = found - found[0]
    # U / L = 0.005: the pendulum is linear within some 1e-5, its vertical motion in the square
    assert_close(found, expected)
    assert_close(found - found[:, :1], expected - expected[:, :1])


def assert_close(found, expected):
    """Each kind of displacement that matters, over its largest value."""
    for dofs, within in (([0, 1], 5e-5), ([2], 1e-3), ([3, 4], 2e-4)):
        size = np.abs(expected[..., dofs]).max()
        apart = np.abs(found[..., dofs] - expected[..., dofs]).max() / size
        assert apart < within, dofs


def on_fixed_supports(ops, frame):
    """Build a frame in OpenSees, load it by its weight; return its supports."""
    there = build_anew(ops, frame, diaphragms=FLOORS, transformation="Linear")
    for tag in there.bases:
        ops.fix(tag, 1, 1, 1, 1, 1, 1)
    add_loads(ops, frame, there)
    gravity_analysis(ops)
    return there.bases


def test_the_model_stays_as_it_was(ops, tmp_path):
    device = lir()
    built = building(device)
    bases = on_fixed_supports(ops, built)
    tags = ops.getNodeTags()
    ops.setTime(3.5)
    ops.recorder("Node", "-file", str(tmp_path / "out.txt"), "-node", 5, "-dof", 1, "disp")

    def state():
        analysis_at_hand(ops)
        ops.reactions()
        return (
            [ops.nodeDisp(tag) for tag in tags],
            [ops.nodeReaction(tag) for tag in tags],
            [ops.eleForce(tag) for tag in ops.getEleTags()],
            ops.getTime(),
            ops.getFixedNodes(),
            [ops.getFixedDOFs(tag) for tag in bases],
            ops.getConstrainedNodes(),
        )

    before = state()
    eigenvalues = ops.eigen(4)
    Frame.from_opensees(bases, device)
    after = state()
    assert before == after  # to the bit
    assert (tmp_path / "out.txt").read_text() == ""
    assert_allclose(ops.eigen(4), eigenvalues, rtol=1e-12)


@pytest.mark.meant("Frame.from_opensees")  # of every strangeness that can be imported
def test_fixed_interface_modes_are_those_of_the_fixed_base(ops):
    """Rigid links with masses at their ends, equal displacements, consistent masses, torsion."""
    device = lir()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    for tag, (x, y) in enumerate(((0.0, 0.0), (5.0, 0.0), (5.0, 4.0), (0.0, 4.0)), start=1):
        ops.node(tag, x, y, 0.0)
        ops.node(10 + tag, x, y, 3.0)
        ops.fix(tag, 1, 1, 1, 1, 1, 1)
        ops.mass(10 + tag, 1e3, 1e3, 1e3, 0.0, 0.0, 0.0)
    ops.geomTransf("Linear", 1, 1.0, 0.0, 0.0)
    ops.geomTransf("Linear", 2, 0.0, 0.0, 1.0)
    for tag in range(1, 5):
        add(ops, tag, tag, 10 + tag, 1, "-mass", 80.0, "-cMass")
        add(ops, 10 + tag, 10 + tag, 11 + tag % 4, 2, "-mass", 50.0)
    ops.node(20, 2.5, 2.0, 3.0)
    ops.fix(20, 0, 0, 1, 1, 1, 0)
    ops.rigidDiaphragm(3, 20, 11, 12, 13, 14)
    ops.mass(20, 4e4, 4e4, 0.0, 0.0, 0.0, 2e5)
    ops.node(31, 0.0, 4.0, 5.0)
    ops.node(30, 1.5, 4.5, 5.8)  # a mass beside the mast: singular in the displacements of its top
    ops.rigidLink("beam", 31, 30)
    ops.mass(30, 2e3, 2e3, 2e3, 0.0, 0.0, 0.0)
    ops.node(32, 0.0, 4.0, 5.0)
    add(ops, 30, 14, 31, 1)
    ops.equalDOF(31, 32, 1, 2, 3)
    ops.fix(32, 0, 0, 0, 1, 1, 1)
    ops.mass(32, 500.0, 500.0, 500.0, 0.0, 0.0, 0.0)
    analysis_at_hand(ops)
    omega2 = np.array(ops.eigen("-fullGenLapack", 9))
    frame = Frame.from_opensees([1, 2, 3, 4], device, gravity=G)
    found = gravity(frame).basis.omega2
    assert_allclose(found[:9], omega2, rtol=1e-8)
    total = 4 * 1e3 + 4 * 80.0 * 3.0 + 50.0 * 18.0 + 2e3 + 500.0  # weighs; the plan's mass does not
    assert_allclose(gravity(frame).axial_forces.sum(), G * total, rtol=1e-9)


def add(ops, tag, i, j, transformation, *options):
    s = COLUMN
    ops.element(
        "elasticBeamColumn",
        tag,
        i,
        j,
        s.area,
        s.elastic_modulus,
        s.shear_modulus,
        s.torsion_constant,
        s.inertia_y,
        s.inertia_z,
        transformation,
        *options,
    )


def plane_frame(ops, length=1.0, force=1.0):
    """Two bays and two storeys in OpenSees' x-y plane, in units of `length` m and `force` N."""
    mass, second = force / length, length  # of the unit of mass in kg, of the lever in m
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    ops.geomTransf("Linear", 1)
    for tag, x, y in plane_nodes():
        ops.node(tag, x / length, y / length)
        ops.mass(tag, 2e4 / mass, 2e4 / mass, 1e3 / (mass * second**2))
    for tag, i, j in plane_members():
        ops.element(
            "elasticBeamColumn",
            tag,
            i,
            j,
            COLUMN.area / length**2,
            COLUMN.elastic_modulus * length**2 / force,
            COLUMN.inertia_y / length**4,
            1,
        )
    ops.fix(1, 1, 1, 1)
    ops.fix(2, 1, 1, 0)
    ops.fix(3, 1, 1, 1)
    ops.rayleigh(0.05, 0.0, 0.001, 0.0)


def plane_nodes():
    return [(10 * k + i + 1, 5.0 * i, 3.5 * k) for k in range(3) for i in range(3)]


def plane_members():
    columns = [(10 * k + i, 10 * k + i, 10 * k + 10 + i) for k in range(2) for i in (1, 2, 3)]
    return columns + [
        (100 + 10 * k + i, 10 * k + i, 10 * k + i + 1) for k in (1, 2) for i in (1, 2)
    ]


def space_frame(ops, up):
    """The same in three dimensions, what leaves the plane held; `up` is "y" or "z"."""
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    z_up = up == "z"
    ops.geomTransf("Linear", 1, *((0.0, 1.0, 0.0) if z_up else (0.0, 0.0, 1.0)))
    for tag, x, height in plane_nodes():
        ops.node(tag, *((x, 0.0, height) if z_up else (x, height, 0.0)))
        ops.mass(tag, 2e4, 2e4, 2e4, 1e3, 1e3, 1e3)
        out = (0, 1, 0, 1, 0, 1) if z_up else (0, 0, 1, 1, 1, 0)
        held = {1: (1,) * 6, 2: (1, 1, 1, *out[3:]), 3: (1,) * 6}.get(tag, out)
        ops.fix(tag, *held)
    for tag, i, j in plane_members():
        add(ops, tag, i, j, 1)
    ops.rayleigh(0.05, 0.0, 0.001, 0.0)


@pytest.mark.meant("the vertical mass is", "the damping of the OpenSees model")
def test_plane_and_space_y_up_and_other_units(ops, run):
    """One frame four times: in the plane, in space with z and y up, and in kN and mm."""
    device = lir()
    motion = waves(0.7, 3.0).scaled([1.0, 0.0, 1.0])

    def analyse(**options):
        frame = Frame.from_opensees([1, 2, 3], device, gravity=G, **options)
        assert_allclose(frame.nodes["22"].position, (5.0, 0.0, 7.0), rtol=0.0, atol=1e-12)
        assert [level.nodes for level in frame.levels] == [
            ("1", "2", "3"),
            ("11", "12", "13"),
            ("21", "22", "23"),
        ]
        assert ("ry" in frame.fixed_dofs["1"], "ry" in frame.fixed_dofs["2"]) == (True, False)
        return run(frame, motion)

    plane_frame(ops)
    first = analyse()
    assert abs(float(first["node_displacement"].sel(node="22", dof="uy").max())) == 0.0
    assert float(np.abs(first["node_displacement"].sel(node="22", dof="ry")).max()) > 1e-4
    others = []
    for up in ("z", "y"):
        space_frame(ops, up)
        others.append(analyse(vertical=up))
    plane_frame(ops, length=1e-3, force=1e3)
    others.append(analyse(length_unit=1e-3, force_unit=1e3))
    names = [str(tag) for tag, _, _ in plane_nodes()]
    for other in others:
        for word, apart in histories_apart(first, other, names, names).items():
            assert apart < 1e-6, word


def test_rotations_of_the_bases_and_the_slab(ops, run):
    """Held, free, with and without a slab: what moves, and who carries moments."""
    device = lir()
    built = building(device)
    bases = on_fixed_supports(ops, built)
    held = {}
    for rotations in ("kept", "free", "fixed"):
        frame = Frame.from_opensees(bases, device, base_rotations=rotations)
        held[rotations] = frame.fixed_dofs.get(str(bases[0]), frozenset())
        assert_allclose(
            gravity(frame).axial_forces, gravity(built).axial_forces, rtol=1e-6
        )  # by symmetry, whatever the rotations
    assert held == {"kept": {"rx", "ry"}, "free": set(), "fixed": {"rx", "ry"}}
    loose = Frame.from_opensees(bases, device, base_diaphragm=False)
    assert not loose.diaphragms
    data = run(Frame.from_opensees(bases, device), waves(0.5, 2.0))
    assert float(np.abs(data["bearing_displacement"]).max()) > 0.01
    names = [str(tag) for tag in bases]
    turns = data["node_displacement"].sel(node=names, dof="rz").to_numpy()
    assert_allclose(turns, turns[:, :1] * np.ones(4), rtol=0.0, atol=1e-12)


def test_a_damped_isolation_is_told(ops):
    device = lir()
    bases = build_anew(ops, building(device), transformation="Linear").bases
    ops.rayleigh(0.3, 0.0, 0.0, 0.0)
    omega = 2.0 * np.pi / device.period
    with pytest.warns(ModelWarning, match=f"by {100 * 0.3 / (2 * omega):.1f} % of critical"):
        frame = Frame.from_opensees(bases, device, gravity=G)
    assert len(frame.superelements["opensees"].notes) == 1
    without = Frame.from_opensees(bases, device, gravity=G, damping=False)
    assert not without.superelements["opensees"].damping.nnz
