"""What Frame.from_opensees refuses or names; each message says what to change."""

import importlib.util
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy import sparse

from frames import (
    Frame,
    GroundMotion,
    ModelError,
    ModelWarning,
    Recording,
    gravity,
    time_histories,
    time_history,
)
from frames.opensees.checks import refuse_unsymmetric
from frames.opensees.model import read_model
from lir_element.opensees import builtin_element
from tests.patience import fresh
from tests.refusals import refused
from tests.scenes import simple_bearing
from validation.opensees.model import gravity_analysis, permanent_loads

pytestmark = pytest.mark.skipif(
    importlib.util.find_spec("openseespy") is None, reason="openseespy is not installed"
)

BEARING = simple_bearing(capacity=0.2, interface_friction=0.12)
BEAM = (0.02, 2e11, 8e10, 1e-4, 3e-4, 3e-4)


def portal(ops, *, loaded=True, base_mass=5e3):
    """Two columns and a beam in space, fixed at nodes 1 and 2."""
    corners(ops, base_mass)
    for tag in (1, 2):
        ops.element("elasticBeamColumn", tag, tag, 10 + tag, *BEAM, 1)
    load(ops)
    if loaded:
        gravity_analysis(ops)


def corners(ops, base_mass=5e3):
    """Nodes of the portal, and its beam, in an empty model."""
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    for tag, x in ((1, 0.0), (2, 6.0)):
        ops.node(tag, x, 0.0, 0.0)
        ops.node(10 + tag, x, 0.0, 4.0)
        ops.fix(tag, 1, 1, 1, 1, 1, 1)
        ops.mass(tag, base_mass, base_mass, base_mass, 0.0, 0.0, 0.0)
        ops.mass(10 + tag, 1e4, 1e4, 1e4, 0.0, 0.0, 0.0)
    ops.geomTransf("Linear", 1, 0.0, 1.0, 0.0)
    ops.element("elasticBeamColumn", 3, 11, 12, *BEAM, 1)


def load(ops, push=0.0):
    """Loads on top of both columns, down and along x; an analysis has still to bring them up."""
    permanent_loads(ops)
    for tag in (11, 12):
        ops.load(tag, push, 0.0, -1e5, 0.0, 0.0, 0.0)


def test_loads_come_as_they_stand(ops):
    portal(ops)
    ops.timeSeries("Linear", 2)
    ops.pattern("Plain", 2, 2)
    ops.eleLoad("-ele", 3, "-type", "-beamUniform", 0.0, -2e3)  # not at work: no time has passed
    frame = Frame.from_opensees([1, 2], BEARING)
    part = frame.superelements["opensees"]
    assert part.nodes == ("1", "2", "11", "12")
    assert part.notes == ()
    assert_allclose(-part.load.reshape(-1, 6)[:, 2].sum(), 2e5, rtol=1e-12)
    assert_allclose(part.load.reshape(-1, 6)[:2, 2], -1e5, rtol=1e-9)
    assert_allclose(part.load.reshape(-1, 6)[2:], 0.0, atol=1e-6)  # in equilibrium already
    assert frame.fixed_dofs["1"] == {"rx", "ry"}
    assert frame.nodes["ground-1"].z == pytest.approx(-BEARING.height)
    by_tag = Frame.from_opensees((2, 1), {1: BEARING, 2: BEARING.as_dcfp()})
    assert by_tag.bearings["bearing-2"].bearing.is_dcfp
    named = Frame.from_opensees([1, 2], BEARING, levels={"roof": [11, 12], "base": [1, 2]})
    assert [level.name for level in named.levels] == ["base", "roof"]


def test_weights_and_loads_are_not_mixed_up(ops):
    portal(ops, loaded=False)
    with pytest.raises(ModelError, match=r"vertical load of 0 N, but its masses weigh 2.942e\+05"):
        Frame.from_opensees([1, 2], BEARING)
    portal(ops)
    with pytest.raises(ModelError, match=r"gravity = 9.81 m/s2, but .* already carries 2e\+05 N"):
        Frame.from_opensees([1, 2], BEARING, gravity=9.81)
    with pytest.warns(ModelWarning, match="check the units, and pass length_unit"):
        Frame.from_opensees([1, 2], BEARING, force_unit=1e3, length_unit=1e-3 * 1e3 * 20.0)


def test_a_base_without_mass_is_told(ops):
    portal(ops, base_mass=0.0)
    with pytest.warns(ModelWarning, match="vibrates at high frequency and steps become small"):
        Frame.from_opensees([1, 2], BEARING)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"base_nodes": [1, 7]}, "no node 7, but base_nodes"),
        ({"base_nodes": [1, 1]}, "lists node 1 more than once"),
        ({"base_nodes": []}, "base_nodes is empty"),
        ({"base_nodes": [1]}, "nodes 2 are supports of elements, but not base nodes: add"),
        ({"bearing": {1: BEARING}}, "node 2 is in base_nodes but not in bearing"),
        ({"vertical": "x"}, "vertical = 'x'"),
        ({"base_rotations": "loose"}, "base_rotations = 'loose': choose one of"),
        ({"length_unit": 0.0}, "length_unit = 0 must be positive"),
        ({"gravity": -9.81}, "gravity"),
    ],
)
def test_options_out_of_bounds(ops, options, message):
    portal(ops)
    given = {"base_nodes": [1, 2], "bearing": BEARING} | options
    refused(ModelError, message, Frame.from_opensees, **given)


def test_there_must_be_a_model_of_a_known_shape(ops):
    refused(ModelError, "holds no model", Frame.from_opensees, [1], BEARING)
    ops.model("basic", "-ndm", 3, "-ndf", 3)
    ops.node(1, 0.0, 0.0, 0.0)
    with pytest.raises(ModelError, match=r"node 1 .* 3 displacements in 3 dimensions"):
        Frame.from_opensees([1], BEARING)
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    ops.node(1, 0.0, 0.0)
    ops.mass(1, 1.0, 1.0, 1.0)
    with pytest.raises(ModelError, match='vertical = "z": a plane model of OpenSees has its y'):
        Frame.from_opensees([1], BEARING, vertical="z")


def test_motion_is_refused(ops):
    portal(ops)
    ops.setNodeVel(11, 1, 0.02, "-commit")
    with pytest.raises(ModelError, match=r"not at rest: velocity 0\.02 at node 11"):
        Frame.from_opensees([1, 2], BEARING)
    portal(ops)
    ops.timeSeries("Path", 5, "-dt", 0.01, "-values", 0.0, 1.0, 0.0)
    ops.pattern("UniformExcitation", 5, 1, "-accel", 5)
    with pytest.raises(ModelError, match=r"load pattern 5 .*remove\('loadPattern', 5\)"):
        Frame.from_opensees([1, 2], BEARING)


def test_isolators_and_ties_to_the_ground_are_refused(ops):
    portal(ops, loaded=False)
    ops.remove("sp", 1, 1)
    ops.node(101, 0.0, 0.0, 0.0)
    ops.fix(101, 1, 1, 1, 1, 1, 1)
    ops.uniaxialMaterial("Elastic", 1, 1e6)
    ops.element("zeroLength", 7, 101, 1, "-mat", 1, "-dir", 1)
    with pytest.raises(ModelError, match=r"element 7 \(ZeroLength\) joins one to base node 1"):
        Frame.from_opensees([1, 2], BEARING, gravity=9.81)
    ops.remove("element", 7)
    frame = Frame.from_opensees([1, 2], BEARING, gravity=9.81)
    assert "101" not in frame.nodes  # nothing reaches it any more
    ops.equalDOF(101, 1, 2)
    with pytest.raises(ModelError, match="base node 1 cannot move along uy: a multi-point"):
        Frame.from_opensees([1, 2], BEARING, gravity=9.81, base_diaphragm=False)


def spare_node(ops):
    ops.node(101, 0.0, 0.0, -0.1)
    ops.node(102, 0.0, 0.0, -0.1)


@pytest.mark.parametrize(
    ("leave", "message", "cure"),
    [
        (
            lambda ops: ops.fix(101, 1, 1, 0, 0, 0, 1),
            r"nodes 101 were removed, but their fix was not: .*remove\('sp', 101, dof\) .* 1, 2, 6",
            lambda ops: [ops.remove("sp", 101, dof) for dof in (1, 2, 6)],
        ),
        (
            lambda ops: ops.equalDOF(11, 101, 1),
            r"constraints of nodes 101 .*remove\('mp', 101\)",
            lambda ops: ops.remove("mp", 101),
        ),
        (
            lambda ops: ops.equalDOF(101, 12, 1),
            r"constraints of nodes 12 .*remove\('mp', 12\)",
            lambda ops: ops.remove("mp", 12),
        ),
        (
            lambda ops: ops.element("elasticBeamColumn", 77, 101, 11, *BEAM, 1),
            r"elements 77 end at a node that was removed: .*remove\('element', 77\)",
            lambda ops: ops.remove("element", 77),
        ),
    ],
)
def test_what_removed_nodes_leave_behind_is_refused(ops, leave, message, cure):
    """OpenSees would end the process; with the remedy that the message gives the model is taken."""
    portal(ops, loaded=False)
    spare_node(ops)
    leave(ops)
    ops.remove("node", 101)
    ops.remove("node", 102)
    refused(ModelError, message, Frame.from_opensees, [1, 2], BEARING, gravity=9.81)
    cure(ops)
    assert len(Frame.from_opensees([1, 2], BEARING, gravity=9.81).nodes) == 6


def test_supports_that_are_meant_stay(ops):
    portal(ops)
    refused(ModelError, "nodes 2 are supports", Frame.from_opensees, [1], BEARING)
    frame = Frame.from_opensees([1], BEARING, other_supports=[2])
    assert len(frame.fixed_dofs["2"]) == 6


def yielding(ops, push, strength=3e8):
    """Let a push yield the fibre columns of the portal, or not."""
    corners(ops)
    ops.uniaxialMaterial("Steel01", 1, strength, 2e11, 0.01)
    ops.section("Fiber", 1, "-GJ", 1e7)
    ops.patch("rect", 1, 10, 2, -0.1, -0.1, 0.1, 0.1)
    ops.beamIntegration("Lobatto", 1, 1, 4)
    for tag in (1, 2):
        ops.element("forceBeamColumn", tag, tag, 10 + tag, 1, 1)
    load(ops, push)
    gravity_analysis(ops)


def test_elements_in_yield_are_refused_and_others_named(ops):
    yielding(ops, push=1e3)
    with pytest.warns(
        ModelWarning, match=r"elements ForceBeamColumn3d \(1, 2\) are nonlinear, of Steel01"
    ):
        Frame.from_opensees([1, 2], BEARING)
    yielding(ops, push=4e5)
    with pytest.raises(ModelError, match=r"elements 1, 2 no longer have their initial stiffness"):
        Frame.from_opensees([1, 2], BEARING)
    with pytest.warns(ModelWarning) as told:
        frame = Frame.from_opensees([1, 2], BEARING, accept_nonlinear=True)
    notes = frame.superelements["opensees"].notes
    assert "their present stiffness is kept" in notes[0]
    assert len(told) == len(notes) == 2


@pytest.mark.parametrize("whole", [True, False])
def test_a_run_says_how_far_imported_members_would_have_yielded(ops, whole):
    yielding(ops, push=0.0, strength=3e7)
    with pytest.warns(ModelWarning, match=r"up to a strain of 0.0001"):
        frame = Frame.from_opensees([1, 2], BEARING, base_rotations="fixed")
    pulse = np.sin(np.linspace(0.0, 2.0 * np.pi, 101))
    for size in (0.5, 3.0):
        motion = GroundMotion(x=size * pulse, dt=0.01)
        kept = Recording(forces=True)
        data = time_history(frame, motion, recording=kept)
        extremes = data["peak_member_force"].sel(station=["i", "j"]).to_numpy()
        n, _, _, _, y, z = np.moveaxis(extremes.reshape(-1, 6), 1, 0)
        # 10 x 2 fibres of 20 x 100 mm, in one of 200 x 200 mm
        at, area = np.array([-0.09, -0.07, -0.05, -0.03, -0.01]), 0.02 * 0.1
        about_z, about_y = 4.0 * area * (at**2).sum(), 20 * area * 0.05**2
        strain = np.abs(n) / 0.04 + np.abs(y) * 0.05 / about_y + np.abs(z) * 0.09 / about_z
        ratio = float(strain.max() / 2e11 / 0.0001)
        if whole:
            data = time_history(frame, motion)
        else:
            data = time_histories(frame, {"a": motion}).isel(run=0)
        assert (ratio > 1.0) == (size > 1.0)
        told = [line for line in str(data.attrs.get("audit") or data["audit"].item()).splitlines()]
        told = [line for line in told if "linear limit" in line]
        assert len(told) == (ratio > 1.0)
        if told:
            assert told[0].startswith("! yielding: element-")
            assert f"strains to {ratio:.3g} times the linear" in told[0]
            assert "(2 imported members exceed theirs)" in told[0]


def test_unsymmetric_matrices_are_refused(ops):
    portal(ops)
    model = read_model()
    refuse_unsymmetric(model)
    skew = model.stiffness.tolil()
    skew[6 * 2, 1] += 0.01 * model.stiffness.max()
    with pytest.raises(ModelError, match="stiffness of the OpenSees model is not symmetric near"):
        refuse_unsymmetric(replace(model, stiffness=sparse.csr_array(skew)))


def test_isolators_are_refused_by_their_tags(ops):
    """Without them, as the message says, the model is imported."""
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    for tag, z in ((1, 0.0), (2, BEARING.height), (3, 3.0)):
        ops.node(tag, 0.0, 0.0, z)
        ops.mass(tag, 2e4, 2e4, 2e4, 0.0, 0.0, 0.0)
    ops.fix(1, 1, 1, 1, 1, 1, 1)
    ops.fix(2, 0, 0, 0, 1, 1, 1)
    ops.fix(3, 0, 0, 0, 0, 0, 1)
    ops.geomTransf("Linear", 1, 1.0, 0.0, 0.0)
    ops.element("elasticBeamColumn", 5, 2, 3, 0.02, 2e11, 8e10, 1e-4, 2e-4, 2e-4, 1)
    builtin_element("singleFPBearing", 15, 1, 2, BEARING.as_dcfp(rims=False), axial_load=4e5)
    permanent_loads(ops)
    ops.load(3, 0.0, 0.0, -4e5, 0.0, 0.0, 0.0)
    gravity_analysis(ops)
    with pytest.raises(
        ModelError, match=r"one of the elements 15 \(SingleFPSimple3d\): .*remove\('element', tag"
    ):
        Frame.from_opensees([2], BEARING)
    ops.remove("element", 15)
    assert list(Frame.from_opensees([2], BEARING).bearings)


def leaning(ops, *, tied=False, load=2e5, hinge=1e-3):
    """A portal in the plane, and beside it a column between hinges that carries a load."""
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    for tag, x in ((1, 0.0), (2, 6.0), (3, 12.0)):
        ops.node(tag, x, 0.0)
        ops.node(10 + tag, x, 4.0)
        ops.fix(tag, 1, 1, 1)
        ops.mass(tag, 5e3, 5e3, 0.0)
        ops.mass(10 + tag, 1e4, 1e4, 0.0)
    ops.geomTransf("PDelta", 1)
    for tag in (1, 2):
        ops.element("elasticBeamColumn", tag, tag, 10 + tag, 0.02, 2e11, 1e-4, 1)
    ops.element("elasticBeamColumn", 5, 11, 12, 0.02, 2e11, 1e-4, 1)
    ops.node(31, 12.0, 0.0)
    ops.equalDOF(3, 31, 1, 2)
    ops.uniaxialMaterial("Elastic", 1, hinge)
    ops.element("zeroLength", 6, 3, 31, "-mat", 1, "-dir", 6)
    ops.element("elasticBeamColumn", 7, 31, 13, 0.02, 2e11, 1e-4, 1)
    if tied:
        ops.equalDOF(12, 13, 1)
    permanent_loads(ops)
    ops.load(11, 0.0, -1e5, 0.0)
    ops.load(13, 0.0, -load, 0.0)
    gravity_analysis(ops)


def test_a_leaning_column_is_told_from_buckling(ops):
    leaning(ops)
    with pytest.raises(ModelError, match=r"node 13 can move along ux .*brace the column"):
        Frame.from_opensees([1, 2, 3], BEARING)
    leaning(ops, tied=True)
    assert gravity(Frame.from_opensees([1, 2, 3], BEARING)).axial_forces[2] > 1.9e5
    stiff = 1e6
    carried = stiff / 4.0  # N, by a hinge of this stiffness under a stiff column
    leaning(ops, load=1.2 * carried, hinge=stiff)
    with pytest.raises(ModelError, match=r'buckles .* at "13 ux" .* at least 1\.[2-4]\d* times'):
        Frame.from_opensees([1, 2, 3], BEARING)


def without_vertical_mass(ops, *, loaded):
    """The portal, its masses horizontal; a master of the roof that cannot rise has some."""
    portal(ops, loaded=False)
    for tag in (1, 2, 11, 12):
        ops.mass(tag, 5e3, 5e3, 0.0, 0.0, 0.0, 0.0)
    ops.node(20, 3.0, 0.0, 4.0)
    ops.fix(20, 0, 0, 1, 1, 1, 0)
    ops.rigidDiaphragm(3, 20, 11, 12)
    ops.mass(20, 1e4, 1e4, 0.0, 0.0, 0.0, 1e4)
    if loaded:
        gravity_analysis(ops)


def test_vertical_mass_can_be_given(ops):
    without_vertical_mass(ops, loaded=True)
    with pytest.raises(ModelError, match=r'3e\+04 kg along x, but no vertical mass .*"hor'):
        Frame.from_opensees([1, 2], BEARING)
    frame = Frame.from_opensees([1, 2], BEARING, vertical_mass="horizontal")
    own = gravity(frame).system.node_mass[:, 2]
    at = list(frame.nodes)
    found = {name: own[at.index(name)] for name in ("1", "11", "12", "20")}
    assert found == pytest.approx({"1": 5e3, "11": 1e4, "12": 1e4, "20": 0.0})
    assert gravity(frame).axial_forces.sum() == pytest.approx(2e5)  # the loads alone
    with pytest.warns(ModelWarning, match=r"vertical mass is 4000 kg, the mass along x 3e\+04 kg"):
        few = Frame.from_opensees([1, 2], BEARING, vertical_mass={11: 3e3, 12: 1e3})
    assert gravity(few).axial_forces.sum() == pytest.approx(2e5)
    without_vertical_mass(ops, loaded=False)
    heavy = Frame.from_opensees([1, 2], BEARING, vertical_mass="horizontal", gravity=9.81)
    assert gravity(heavy).axial_forces.sum() == pytest.approx(9.81 * 3e4)
    for given, message in (
        ("all", "vertical_mass = 'all': use"),
        ({20: 1.0}, "names node 20, which does not exist or is fixed vertically"),
        ({11: -1.0}, "vertical_mass .kg. of node 11"),
    ):
        with pytest.raises(ModelError, match=message):
            Frame.from_opensees([1, 2], BEARING, vertical_mass=given, gravity=9.81)


def test_frames_alone_does_not_load_openseespy():
    code = "import frames, sys; print(any(name.startswith('openseespy') for name in sys.modules))"
    out = fresh(code)
    assert out.stdout.strip() == "False"
