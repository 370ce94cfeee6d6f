"""Member forces of OpenSees models: against what OpenSees itself says of its elements."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from frames import Frame, GroundMotion, Recording, member_forces, time_history
from frames.assembly.assemble import assemble
from frames.opensees.structure import turning
from tests.scenes import simple_bearing

pytest.importorskip("openseespy")

BEARING = simple_bearing(slider_radius=0.12, capacity=0.25, interface_friction=0.14)
PLACES = {
    1: (0.0, 0.0, 0.0),
    2: (6.0, 0.0, 0.0),
    3: (6.0, 5.0, 0.0),
    4: (0.0, 5.0, 0.0),
    5: (0.0, 0.0, 3.0),
    6: (6.0, 0.0, 3.2),
    7: (6.0, 5.0, 3.4),
    8: (0.0, 5.0, 3.0),
}
RIGID = {1: (1, 1, 1, 1, 1, 1), 2: (1, 1, 1, 1, 1, 1), 3: (1,) * 6, 4: (1,) * 6}
E_, G_ = 30e9, 12e9
NUMBERS = (0.12, E_, G_, 1.5e-3, 1e-3, 2e-3)


def space_frame(ops, turned=False):
    """Build columns of all transformations, beams of all kinds, a bar and a shell."""
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    axes, _ = turning(3, "y" if turned else "z")

    def out(*vector):
        return (np.array(vector) @ axes).tolist()

    for tag, place in PLACES.items():
        ops.node(tag, *out(*place))
    for tag in range(1, 5):
        ops.fix(tag, *RIGID[tag])
    for tag in range(5, 9):
        ops.mass(tag, 20e3, 20e3, 20e3, 0.0, 0.0, 0.0)
    for tag in range(1, 5):
        ops.mass(tag, 5e3, 5e3, 5e3, 0.0, 0.0, 0.0)
    ops.geomTransf("PDelta", 1, *out(1.0, 0.3, 0.0))
    ops.geomTransf("PDelta", 2, *out(1.0, 0.0, 0.0))
    ends = ("-jntOffset", *out(0.0, 0.0, 0.2), *out(0.0, 0.0, -0.4))
    ops.geomTransf("Linear", 3, *out(1.0, 0.0, 0.0), *ends)
    ops.geomTransf("Linear", 4, *out(0.0, 0.0, 1.0))
    ops.geomTransf("Linear", 5, *out(0.0, 0.2, 1.0))
    ops.section("Elastic", 1, *[NUMBERS[k] for k in (1, 0, 5, 4, 2, 3)])
    ops.beamIntegration("Lobatto", 1, 1, 4)
    ops.element("elasticBeamColumn", 1, 1, 5, *NUMBERS, 1)
    ops.element("elasticBeamColumn", 2, 2, 6, *NUMBERS, 2)
    ops.element("elasticBeamColumn", 3, 3, 7, *NUMBERS, 3)
    ops.element("forceBeamColumn", 4, 4, 8, 1, 1)
    ops.element("elasticBeamColumn", 5, 5, 6, *NUMBERS, 4)
    ops.element("elasticBeamColumn", 6, 6, 7, *NUMBERS, 5, "-releasez", 2, "-releasey", 1)
    ops.element("ElasticTimoshenkoBeam", 7, 8, 7, E_, G_, 0.12, 1.5e-3, 1e-3, 2e-3, 0.1, 0.09, 4)
    ops.element("dispBeamColumn", 8, 5, 8, 4, 1)
    ops.uniaxialMaterial("Elastic", 1, 200e9)
    ops.element("Truss", 9, 1, 6, 2e-3, 1)
    ops.section("ElasticMembranePlateSection", 2, 20e9, 0.2, 0.1, 0.0)
    ops.element("ShellMITC4", 20, 5, 6, 7, 8, 2)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    for tag in range(5, 9):
        ops.load(tag, *out(0.0, 0.0, -2e5), 0.0, 0.0, 0.0)
    ops.eleLoad("-ele", 5, "-type", "-beamUniform", 1e3, -20e3, 500.0)
    ops.eleLoad("-ele", 8, "-type", "-beamPoint", 2e3, -40e3, 0.3)
    return out


def solve(ops, steps=1):
    ops.wipeAnalysis()
    ops.constraints("Plain")
    ops.numberer("RCM")
    ops.system("FullGeneral")
    ops.test("NormDispIncr", 1e-12, 30)
    ops.algorithm("Newton")
    ops.integrator("LoadControl", 1.0 / steps)
    ops.analysis("Static")
    assert ops.analyze(steps) == 0
    ops.loadConst("-time", 0.0)


def told(ops, tag):
    """Forces on an element's ends in its local axes, as OpenSees says."""
    return np.array(ops.eleResponse(tag, "localForce"))


def column_axes(ops, tag):
    return np.array([ops.eleResponse(tag, f"{axis}axis") for axis in "xyz"])


def sum_of_inertia(frame, data):
    """Horizontal inertia of the roof, which has all its mass at four nodes."""
    roof = data["node_acceleration"].sel(node=["5", "6", "7", "8"]).to_numpy()
    return -20e3 * roof.sum(axis=1)[:, :2]


LINES = (1, 2, 3, 4, 5, 6, 7, 8, 9)
P_DELTA = (1, 2, 4)
# the shear of localForce has P-Delta of another sign than the forces that hold nodes in balance
BALANCED = {tag: [0, 3, 4, 5, 6, 9, 10, 11] if tag in P_DELTA else list(range(12)) for tag in LINES}


@pytest.mark.parametrize("turned", [False, True])
def test_loads_anew_give_the_forces_that_opensees_has(ops, turned):
    """Rows and rest at the displacements of a further load, against the elements' own forces."""
    out = space_frame(ops, turned)
    solve(ops)
    before = {tag: np.array(ops.nodeDisp(tag)) for tag in PLACES}
    at_rest = {tag: told(ops, tag) for tag in LINES}
    frame = Frame.from_opensees([1, 2, 3, 4], BEARING, **({"vertical": "y"} if turned else {}))
    table = assemble(frame).elements
    assert table.names == tuple(f"element-{tag}" for tag in LINES)
    for tag in PLACES:
        assert_allclose(ops.nodeDisp(tag), before[tag], rtol=0.0, atol=0.0)
    for k, tag in enumerate(LINES):
        assert_allclose(told(ops, tag), at_rest[tag], rtol=0.0, atol=1e-9)
        scale = np.abs(at_rest[tag]).max()
        apart = table.rest[k] - at_rest[tag]
        assert np.abs(apart[BALANCED[tag]]).max() < 1e-9 * scale
    ops.timeSeries("Linear", 2)
    ops.pattern("Plain", 2, 2)
    ops.load(6, *out(4e3, -3e3, 1e3), *out(1e3, 2e3, 3e3))
    ops.load(8, *out(-1e3, 2e3, -2e3), *out(2e3, 0.0, -1e3))
    solve(ops)
    _, turn = turning(3, "y" if turned else "z")
    index = list(frame.nodes)
    u = np.zeros((len(index), 6))
    for tag in PLACES:
        u[index.index(str(tag))] = turn @ (np.array(ops.nodeDisp(tag)) - before[tag])
    for k, tag in enumerate(LINES):
        more = told(ops, tag) - at_rest[tag]
        apart = table.rows[k] @ u[table.nodes[k]].ravel() - more
        # P-Delta: the change of the axial force times the drift at rest is not in the tangent
        close = 1e-3 if tag in P_DELTA else 1e-9
        assert np.abs(apart[BALANCED[tag]]).max() < close * np.abs(more).max()


def test_forces_of_a_run_hold_nodes_in_balance(ops):
    """Columns of a storey pass on its shear; what is told without forces; the middle of beams."""
    space_frame(ops)
    ops.remove("element", 20)
    ops.remove("element", 9)
    solve(ops)
    frame = Frame.from_opensees([1, 2, 3, 4], BEARING)
    assert frame.superelements["opensees"].elements.without == ()
    wave = np.sin(np.linspace(0.0, 9.0, 60))
    motion = GroundMotion(x=2.0 * wave, y=1.0 * wave, dt=0.02)
    data = time_history(frame, motion, level="pendulum", recording=Recording(every=1, forces=True))
    forces = member_forces(frame, data)
    axes = {f"element-{tag}": column_axes(ops, tag) for tag in (1, 2, 3, 4)}
    total = 0.0
    for name, turn in axes.items():
        ends = forces.sel(member=name, end="j").to_numpy()[:, :3]
        total = total + ends @ turn
    top = frame.levels[1]
    shear = sum_of_inertia(frame, data)
    assert top.name == "level-1"
    more = (total - total[0])[:, :2]  # loads along beams push sideways, too
    assert_allclose(more, shear, atol=1e-6 * np.abs(shear).max())
    reached = data["peak_member_force"]
    for name in forces["member"].to_numpy():
        one = reached.sel(member=name).transpose(..., "extreme", "component_at_once")
        for station, sign in (("i", -1.0), ("j", 1.0)):
            own = sign * forces.sel(member=name, end=station).to_numpy()
            for c, force in enumerate(forces["component"].to_numpy()):
                found = one.sel(station=station, component=force, component_at_once=force)
                scale = 1e-6 * np.abs(own).max()
                assert_allclose(found.to_numpy(), [own[:, c].max(), own[:, c].min()], atol=scale)
    beam = data["peak_member_force_at_rest"].sel(member="element-5")
    length = np.hypot(6.0, 0.2)
    mean = 0.5 * (beam.sel(station="i") + beam.sel(station="j"))
    sag = (beam.sel(station="mid") - mean).sel(component=["My", "Mz"]).to_numpy()
    assert_allclose(sag, [-20e3 * length**2 / 8.0, -1e3 * length**2 / 8.0], rtol=1e-9)


def plane_frame(ops, length=1.0, force=1.0):
    """Build a portal with a loaded beam, in units of length [m] and force [N]."""
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    ops.geomTransf("PDelta", 1)
    ends = ("-jntOffset", 0.3 / length, 0.0, -0.2 / length, 0.0)
    ops.geomTransf("Linear", 2, *ends)
    modulus = 30e9 / force * length**2
    for tag, x, y in ((1, 0.0, 0.0), (2, 5.0, 0.0), (3, 0.0, 3.0), (4, 5.0, 3.0)):
        ops.node(tag, x / length, y / length)
        mass = 20e3 * length / force
        ops.mass(tag, mass, mass, 0.0)
    for tag in (1, 2):
        ops.fix(tag, 1, 1, 1)
        numbers = 0.1 / length**2, modulus, 1e-3 / length**4
        ops.element("elasticBeamColumn", tag, tag, tag + 2, *numbers, 1)
    ops.element("elasticBeamColumn", 3, 3, 4, 0.1 / length**2, modulus, 2e-3 / length**4, 2)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    ops.eleLoad("-ele", 3, "-type", "-beamUniform", -40e3 / force * length)
    ops.eleLoad("-ele", 3, "-type", "-beamPoint", -9e3 / force, 0.25)
    solve(ops)


@pytest.mark.meant("carry no mass")
def test_a_plane_model_in_its_units(ops):
    """As OpenSees says of its elements, turned to SI; the middle of the beam by statics."""
    plane_frame(ops)
    local = np.array([told(ops, tag) for tag in (1, 2, 3)])
    found = assemble(Frame.from_opensees([1, 2], BEARING)).elements
    plane_frame(ops, 1e-3, 1e3)
    units = {"length_unit": 1e-3, "force_unit": 1e3}
    other = assemble(Frame.from_opensees([1, 2], BEARING, **units)).elements
    for word in ("rows", "rest", "middle"):
        one, two = getattr(found, word), getattr(other, word)
        assert_allclose(two, one, rtol=1e-6, atol=1e-9 * np.abs(one).max())
    in_plane = [0, 1, 5, 6, 7, 11]
    assert_allclose(found.rest[2][in_plane], local[2], rtol=1e-9)
    assert not np.delete(found.rest, in_plane, axis=1).any()
    span, at = 4.5, 0.25 * 4.5
    near, far = local[2][2], local[2][5]
    # sagging by the end moments and the loads of a simple beam; Mz of a section is far's sign
    simple = 40e3 * span**2 / 8.0 + 9e3 * at / 2.0
    middle = 0.5 * (far - near) + found.middle[2][5]
    assert_allclose(middle, 0.5 * (far - near) + simple, rtol=1e-12)
    shear = local[2][1] - 40e3 * span / 2.0 - 9e3
    assert_allclose(0.5 * (local[2][4] - local[2][1]) + found.middle[2][1], -shear, rtol=1e-9)


def test_elements_without_forces_are_named(ops):
    """A corotational bar tells no stiffness, a spring is no member."""
    space_frame(ops)
    ops.node(30, *PLACES[5])
    ops.mass(30, 1e3, 1e3, 1e3, 0.0, 0.0, 0.0)
    ops.element("zeroLength", 30, 5, 30, "-mat", *[1] * 6, "-dir", *range(1, 7))
    ops.element("corotTruss", 31, 2, 7, 1e-3, 1)
    solve(ops)
    frame = Frame.from_opensees([1, 2, 3, 4], BEARING)
    part = frame.superelements["opensees"].elements
    told_of = {one.kind: (one.number, one.which, one.why) for one in part.without}
    assert set(told_of) == {"ShellMITC4", "ZeroLength", "CorotTruss"}
    assert told_of["ShellMITC4"] == (1, "20", "no beam, column or bar between two nodes")
    assert told_of["CorotTruss"][2] == "OpenSees tells another stiffness of it than it assembles"
    assert "element-31" not in part.names
    assert len(part.names) == len(LINES)
