"""Laws of elements that Frame.from_opensees meets: told, refused with a remedy, or silent."""

import importlib.util
import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from frames import Frame, ModelError, ModelWarning, modes
from frames.laws import Gap
from frames.opensees.checks import energy_shares
from frames.opensees.materials import with_viscous_springs
from frames.opensees.model import read_model
from tests.scenes import simple_bearing
from validation.opensees.model import solver

pytestmark = pytest.mark.skipif(
    importlib.util.find_spec("openseespy") is None, reason="openseespy is not installed"
)

BEARING = simple_bearing(capacity=0.2, interface_friction=0.12)
STEEL = (0.02, 2.1e11, 8.1e10, 1e-4, 2e-4, 3e-4)


def building(ops, *, softer=1.0):
    """Two storeys on four columns, no loads; columns 11 to 14 can be softer."""
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    ops.geomTransf("Linear", 1, 1.0, 0.0, 0.0)
    ops.geomTransf("Linear", 2, 0.0, 0.0, 1.0)
    for corner, (x, y) in enumerate(((0.0, 0.0), (6.0, 0.0), (6.0, 5.0), (0.0, 5.0)), start=1):
        for level in range(3):
            tag, mass = 10 * level + corner, 20e3 * (1.0 + 0.1 * corner)
            ops.node(tag, x, y, 3.5 * level)
            ops.mass(tag, mass, mass, mass, 0.0, 0.0, 0.0)
            if level == 0:
                ops.fix(tag, 1, 1, 1, 1, 1, 1)
                continue
            area, e, g, *rest = STEEL
            factor = softer if level == 1 else 1.0
            section = (area, factor * e, factor * g, *rest)
            ops.element("elasticBeamColumn", tag, tag - 10, tag, *section, 1)
    for level in (10, 20):
        for k in range(4):
            ends = level + 1 + k, level + 1 + (k + 1) % 4
            ops.element("elasticBeamColumn", 10 * level + k, *ends, *STEEL, 2)


def take():
    return Frame.from_opensees([1, 2, 3, 4], BEARING, gravity=9.81)


def brace(ops, *material):
    building(ops)
    ops.uniaxialMaterial(*material)
    ops.element("Truss", 900, 1, 12, 1e-3, material[1])


def link(ops, *material):
    building(ops)
    ops.uniaxialMaterial(*material)
    ops.element("twoNodeLink", 900, 1, 12, "-mat", material[1], "-dir", 1)


def coupled(ops, *material):
    building(ops)
    ops.uniaxialMaterial(*material)
    ops.element("CoupledZeroLength", 900, 1, 12, 1, 2, 1)


@pytest.mark.parametrize(
    ("add", "material"),
    [
        (coupled, ("Elastic", 1, 1e7)),
        (brace, ("Elastic", 1, 2e11)),
        (brace, ("Elastic", 1, 2e11, 1e6)),
        (brace, ("Viscous", 1, 1e8, 1.0)),
        (link, ("Elastic", 1, 1e7)),
        (link, ("Viscous", 1, 1e5, 1.0)),
    ],
)
def test_what_is_linear_is_not_named(ops, add, material):
    """Warnings are errors here; a dashpot, a link and a bar are taken as they are."""
    add(ops, *material)
    taken = take()
    assert taken.superelements["opensees"].damping.nnz > 0 or material[0] == "Elastic"


def test_shells_of_an_elastic_section_are_not_named(ops):
    building(ops)
    ops.section("ElasticMembranePlateSection", 1, 31e9, 0.2, 0.2, 0.0)
    ops.element("ShellMITC4", 900, 11, 12, 13, 14, 1)
    ops.nDMaterial("ElasticIsotropic", 1, 3e10, 0.2)
    ops.nDMaterial("PlateFiber", 2, 1)
    ops.section("PlateFiber", 2, 2, 0.2)
    ops.element("ShellMITC4", 901, 21, 22, 23, 24, 2)
    take()


def test_nonlinear_laws_are_named_with_their_share(ops):
    brace(ops, "Steel02", 1, 2.5e8, 2e11, 0.01)
    share = 100.0 * energy_shares(read_model(), [900], 2)[900]
    assert 5.0 < share < 50.0
    words = (
        r"elements Truss \(900\) are nonlinear, of Steel02: .* within 5 % up to a strain of "
        rf"0\.001; they have {share:.3g} % .* about {share / 10.0:.2g} % larger"
    )
    with pytest.warns(ModelWarning, match=words):
        take()


def test_shares_are_the_derivative_of_the_compliance(ops):
    """Against columns that are in fact softer by a thousandth."""
    building(ops)
    model = read_model()
    every = energy_shares(model, [element.tag for element in model.elements], 2)
    assert sum(every.values()) == pytest.approx(1.0, rel=1e-9)
    moved = []
    for softer in (1.0, 0.999):
        building(ops, softer=softer)
        ops.timeSeries("Linear", 1)
        ops.pattern("Plain", 1, 1)
        nodes = [tag for tag in ops.getNodeTags() if tag > 10]
        for tag in nodes:
            ops.load(tag, ops.nodeMass(tag, 1), 0.0, 0.0, 0.0, 0.0, 0.0)
        solver(ops)
        ops.integrator("LoadControl", 1.0)
        ops.analysis("Static")
        assert ops.analyze(1) == 0
        moved.append(sum(ops.nodeMass(tag, 1) * ops.nodeDisp(tag, 1) for tag in nodes))
    # of x, in which the columns hold most
    columns = sum(energy_shares(model, (11, 12, 13, 14), 2).values())
    assert (moved[1] / moved[0] - 1.0) / 1e-3 == pytest.approx(columns, rel=5e-3)


GAPS = [
    (link, ("ElasticPPGap", 1, 1e8, -1e7, -0.01), "EPPGap, which has no stiffness at rest"),
    (link, ("ENT", 1, 1e8), "0 in tension and 1e[+]08 in compression"),
    (brace, ("Elastic", 1, 2e11, 0.0, 1e9), "2e[+]11 in tension and 1e[+]09 in compression"),
    (brace, ("Viscous", 1, 1e5, 0.5), "not proportional to speed.*ViscousDamper"),
    (coupled, ("Viscous", 1, 1e5, 1.0), "along the displacement.*, not along.*ViscousDamper"),
    (coupled, ("Elastic", 1, 1e7, 1e5), "along the displacement.*, not along.*ViscousDamper"),
    (link, ("Maxwell", 1, 1e8, 1e5, 1.0, 1.0), "a spring and a dashpot in series.*ViscousDamper"),
]


@pytest.mark.parametrize(("add", "material", "words"), GAPS)
def test_what_no_stiffness_stands_for_is_refused(ops, add, material, words):
    add(ops, *material)
    with pytest.raises(ModelError, match=words) as refused:
        take()
    with pytest.warns(ModelWarning) as told:
        Frame.from_opensees([1, 2, 3, 4], BEARING, gravity=9.81, accept_nonlinear=True)
    assert "keeps the present stiffness" in str(told[0].message)
    # the remedy of the message
    assert "ops.remove('element', 900)" in str(refused.value)
    ops.remove("element", 900)
    frame = take()
    frame.add_link("link-900", "1", "12", Gap(gap=0.01, stiffness=1e8), "ux")
    assert "link-900" in frame.links


def test_materials_are_tried_on_copies(ops):
    """A law that has yielded in the trial would be in every later element."""
    brace(ops, "ElasticPP", 1, 2e11, 1e-3)
    ops.testUniaxialMaterial(1)
    for _ in range(2):
        with pytest.warns(ModelWarning, match="are nonlinear, of ElasticPPMaterial"):
            take()
    ops.testUniaxialMaterial(1)
    assert ops.getStress() == 0.0
    assert ops.getTangent() == 2e11


def swinging(ops, *options, kinds=("Elastic",), stiffness=(4e6, 9e6)):
    """A mass on springs of zero length with viscous parts, turned by 30 degrees."""
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    for tag in (1, 2):
        ops.node(tag, 0.0, 0.0, 0.0)
    ops.fix(1, 1, 1, 1, 1, 1, 1)
    ops.fix(2, 0, 0, 1, 1, 1, 1)
    ops.mass(2, 1e4, 1e4, 1e4, 0.0, 0.0, 0.0)
    c, s = math.cos(math.pi / 6.0), 0.5
    for k, value in enumerate(stiffness):
        ops.uniaxialMaterial("Elastic", 10 + k, value, 1e4)
    mats = [10 + k for k in range(len(stiffness))]
    ops.element(
        "zeroLength",
        1,
        1,
        2,
        "-mat",
        *mats,
        "-dir",
        *range(1, 1 + len(mats)),
        "-orient",
        c,
        s,
        0.0,
        -s,
        c,
        0.0,
        *options,
    )


@pytest.mark.parametrize("options", [(), ("-doRayleigh", 1)])
@pytest.mark.parametrize("rayleigh", [0.0, 1e-4, 1e-2])
@pytest.mark.parametrize("stiffness", [(4e6, 9e6), (4e6, 4e6)])
def test_viscous_parts_of_springs_of_zero_length(ops, options, rayleigh, stiffness):
    """Against the force that OpenSees itself has in a motion, by its decay over a cycle."""
    swinging(ops, *options, stiffness=stiffness)
    ops.rayleigh(0.0, 0.0, rayleigh, 0.0)
    model = read_model()
    damping, notes = with_viscous_springs(ops, model)
    assert not notes
    along = np.zeros(12)
    along[6:8] = math.cos(math.pi / 6.0), 0.5
    ours = float(along @ damping @ along)
    # axes are printed to six digits
    assert ours == pytest.approx(1e4 + (rayleigh * stiffness[0] if options else 0.0), rel=2e-6)
    ratio = ours / (2.0 * math.sqrt(stiffness[0] * 1e4))
    if ratio < 0.2:
        found = decay(ops, along[6:9], stiffness[0])
        assert found == pytest.approx(ours, rel=0.02)


def decay(ops, along, stiffness):
    """Force over speed of node 2: a push leaves exp(-c T / m) of its energy after a cycle T."""
    for axis in (1, 2, 3):
        ops.setNodeVel(2, axis, float(along[axis - 1]), "-commit")
    ops.constraints("Plain")
    ops.numberer("Plain")
    ops.system("FullGeneral")
    ops.test("NormUnbalance", 1e-8, 20)
    ops.algorithm("Newton")
    ops.integrator("Newmark", 0.5, 0.25)
    ops.analysis("Transient")
    steps, dt = 400, 2.0 * math.pi / math.sqrt(stiffness / 1e4) / 400
    assert ops.analyze(steps, dt) == 0
    energy = 0.5 * 1e4 * np.sum(np.square(ops.nodeVel(2)[:3]))
    energy += 0.5 * stiffness * np.sum(np.square(ops.nodeDisp(2)[:3]))
    return -math.log(energy / (0.5 * 1e4)) / (steps * dt) * 1e4


@pytest.mark.parametrize("kind", ["Truss", "corotTruss"])
@pytest.mark.parametrize("rayleigh", [0.0, 1e-3])
@pytest.mark.parametrize("plane", [False, True])
def test_viscous_parts_of_bars(ops, kind, rayleigh, plane):
    """The force of a corotTruss is that of a Truss; its damping matrix in OpenSees is not."""
    ops.wipe()
    ops.model("basic", "-ndm", 2 if plane else 3, "-ndf", 3 if plane else 6)
    along = (0.6, 0.8, 0.0)
    for tag, size in ((1, 0.0), (2, 5.0)):
        ops.node(tag, *(size * part for part in along[: 2 if plane else 3]))
    ops.fix(1, *[1] * (3 if plane else 6))
    ops.fix(2, 0, 1, *[1] * (1 if plane else 4))
    ops.mass(2, *[1e4] * (2 if plane else 3), *[0.0] * (1 if plane else 3))
    ops.uniaxialMaterial("Elastic", 1, 4e6, 3e4)
    ops.element(kind, 1, 1, 2, 5.0, 1, *(("-doRayleigh", 1) if rayleigh else ()))
    ops.rayleigh(0.0, 0.0, rayleigh, 0.0)
    damping, notes = with_viscous_springs(ops, read_model())
    assert not notes
    assert -damping[[0], [3 if plane else 6]] == pytest.approx(0.36 * (3e4 + 4e6 * rayleigh))
    if not plane:
        found = decay(ops, (1.0, 0.0, 0.0), 0.36 * 4e6)
        assert found == pytest.approx(0.36 * (3e4 + 4e6 * rayleigh), rel=0.02)


TIES = [
    [(21, 22, 2), (22, 23, 1)],
    [(22, 23, 1), (21, 22, 2)],
    [(21, 22, 2), (22, 23, 2)],
    [(21, 22, 2), (23, 22, 1)],
    [(21, 22, 1, 2, 6), (22, 23, 1, 2, 6), (23, 24, 1, 2, 6)],
]


@pytest.mark.parametrize("ties", TIES)
def test_ties_in_a_chain_are_all_taken(ops, ties):
    """Against stiff springs in OpenSees, whose Transformation handler takes chains wrongly."""
    building(ops)
    loose = modes(take(), 4, bearings="fixed").periods
    for tie in ties:
        ops.equalDOF(*tie)
    found = modes(take(), 4, bearings="fixed").periods
    building(ops)
    ops.uniaxialMaterial("Elastic", 1, 1e13)
    for k, (one, other, *dofs) in enumerate(ties):
        ops.element("zeroLength", 900 + k, one, other, "-mat", *[1] * len(dofs), "-dir", *dofs)
    theirs = 2.0 * np.pi / np.sqrt(ops.eigen(4))
    assert_allclose(found, theirs, rtol=2e-5)
    assert np.abs(found / loose - 1.0).max() > 0.1


def test_rigid_links_beyond_a_diaphragm_and_a_tie(ops):
    """The link's node follows one that the diaphragm ties; against stiff beams and springs."""

    def post(lever):
        building(ops)
        ops.node(31, 0.0, -2.0, 7.0)
        ops.node(32, 8.0, -2.0, 7.0)
        for tag in (31, 32):
            ops.mass(tag, 8e3, 8e3, 8e3, 1e2, 1e2, 1e2)
        ops.geomTransf("Linear", 3, 0.0, 0.0, 1.0)
        lever()

    def constraints():
        ops.rigidDiaphragm(3, 23, 21, 22, 24)
        ops.rigidLink("beam", 21, 31)
        ops.rigidLink("beam", 31, 32)

    def stiff():
        rigid = (1e3, 2e13, 8e12, 1e3, 1e3, 1e3)
        ops.element("elasticBeamColumn", 931, 21, 31, *rigid, 3)
        ops.element("elasticBeamColumn", 932, 31, 32, *rigid, 3)
        ops.rigidDiaphragm(3, 23, 21, 22, 24)

    post(constraints)
    found = modes(take(), 6, bearings="fixed").periods
    post(stiff)
    ops.constraints("Transformation")
    ops.system("BandGeneral")
    theirs = 2.0 * np.pi / np.sqrt(ops.eigen(6))
    assert_allclose(found, theirs, rtol=1e-5)
