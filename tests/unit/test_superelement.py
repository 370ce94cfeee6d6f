"""Parts given by matrices: the same as members, refused where they cannot be."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy import sparse

from frames import Frame, ModelError, Section, shear_building
from frames.assembly.assemble import assemble
from frames.assembly.constraints import eliminate, separate_massless
from tests.scenes import large_bearing

SECTION = Section.box(0.3, 0.3, 0.01)


def mast(*, members: bool) -> Frame:
    frame = Frame("mast")
    for k in range(3):
        frame.add_node(f"n{k}", 0.0, 0.0, 2.0 * k)
    frame.fix("n0", "all")
    frame.add_mass("n2", 5000.0, (10.0, 10.0, 10.0))
    if members:
        for k in range(2):
            frame.add_member(f"m{k}", f"n{k}", f"n{k + 1}", SECTION)
    return frame


def test_matrices_do_what_members_do():
    expected = assemble(mast(members=True))
    frame = mast(members=False)
    own_mass = np.zeros((3, 6))
    own_mass[:, :3] = np.array([0.5, 1.0, 0.5])[:, None] * SECTION.density * SECTION.area * 2.0
    load = np.zeros((3, 6))
    load[:, 2] = -frame.gravity * own_mass[:, 2]
    frame.add_superelement(
        "part",
        ["n0", "n1", "n2"],
        expected.node_stiffness,
        np.diag(own_mass.ravel()),
        load=load.ravel(),
        damping=0.1 * expected.node_stiffness,
    )
    found = assemble(frame)
    for word in ("stiffness", "mass"):
        assert_allclose(getattr(found, word).toarray(), getattr(expected, word).toarray())
    for word in ("load", "inertia_load", "node_mass"):
        assert_allclose(getattr(found, word), getattr(expected, word))
    assert_allclose(found.damping.toarray(), 0.1 * expected.stiffness.toarray())
    assert "1 superelements" in repr(frame)


def test_ties_are_those_of_a_diaphragm():
    corners = {"a": (0.0, 0.0), "b": (4.0, 0.0), "c": (0.0, 3.0)}

    def table(*, tied: bool) -> Frame:
        frame = Frame()
        for name, (x, y) in corners.items():
            frame.add_node(f"foot {name}", x, y, 0.0)
            frame.fix(f"foot {name}", "all")
            frame.add_node(name, x, y, 3.0)
            frame.add_mass(name, 1000.0)
            frame.add_member(name, f"foot {name}", name, SECTION)
        if tied:
            frame.add_diaphragm("plate", list(corners))
        return frame

    rows = []
    for name in "bc":
        k = "abc".index(name)
        x, y = corners[name]
        for dof, lever in ((0, -y), (1, x), (5, None)):
            row = np.zeros(18)
            row[6 * k + dof], row[dof] = -1.0, 1.0
            row[5] = lever if lever is not None else 1.0
            rows += [row, 2.0 * row]  # said twice
    frame = table(tied=False)
    none = sparse.csr_array((18, 18))
    frame.add_superelement("ties", list("abc"), none, none, equations=np.array(rows))
    found, expected = assemble(frame), assemble(table(tied=True))
    assert len(found.dof_labels) == len(expected.dof_labels) == 12
    a, b = (
        np.linalg.eigvals(np.linalg.solve(s.stiffness.toarray(), s.mass.toarray()))
        for s in (found, expected)
    )
    assert_allclose(np.sort(a.real), np.sort(b.real), rtol=1e-9, atol=1e-12)


def test_elimination_follows_chains_and_drops_repetition():
    equations = sparse.csr_array(
        np.array([[1.0, -1.0, 0, 0], [0, 1.0, -2.0, 0], [1.0, 0, -2.0, 0], [0, 0, 0, 0]])
    )
    kept, follow = eliminate(equations, np.ones(4))
    assert len(kept) == 2
    assert 3 in kept
    assert_allclose(equations @ follow.toarray(), 0.0, atol=1e-15)
    assert np.linalg.matrix_rank(follow.toarray()) == 2


def test_a_mass_at_a_lever_leaves_directions_without_mass():
    lever = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 2.0]])  # two translations, one rotation
    mass = sparse.csr_array(lever.T @ lever * 7.0)
    turn, massless = separate_massless(mass, ("ux", "uy", "rz"))
    turned = (turn.T @ mass @ turn).toarray()
    assert massless.tolist() in ([1], [2])
    assert_allclose(turned[massless[0]], 0.0, atol=1e-12)
    assert np.linalg.matrix_rank(turned) == 2


def test_masses_that_cancel_are_none():
    """A slab's mass on its middle, given as a plane through the bearings: they carry none of it."""
    bearing = large_bearing()
    frame = shear_building(bearing, 3e5, 9e8, storeys=5, storey_height=3.5, plan=((3, 2), 7.0))
    system = assemble(frame)
    has_mass = (system.node_mass[:, :3] != 0.0).any(axis=1)
    assert [name for name, one in zip(system.node_names, has_mass, strict=True) if one] == [
        "base",
        *(f"floor-{k}" for k in range(1, 6)),
    ]
    assert_allclose(system.node_mass[has_mass, :3], 3e5, rtol=1e-12)


def test_what_cannot_be_is_refused():
    frame = mast(members=False)
    good = np.eye(18)
    with pytest.raises(ModelError, match=r"stiffness .* shape \(18, 12\), it must have 18 columns"):
        frame.add_superelement("s", ["n0", "n1", "n2"], np.ones((18, 12)), good)
    with pytest.raises(ModelError, match=r"mass .* shape \(6, 18\), it must be \(18, 18\)"):
        frame.add_superelement("s", ["n0", "n1", "n2"], good, np.ones((6, 18)))
    skew = good.copy()
    skew[13, 2] = 0.5
    with pytest.raises(ModelError, match=r"stiffness .* is not symmetric: entries differ by 0\.5"):
        frame.add_superelement("s", ["n0", "n1", "n2"], skew, good)
    with pytest.raises(ModelError, match=r"damping .* must be finite"):
        frame.add_superelement("s", ["n0", "n1", "n2"], good, good, damping=good * np.nan)
    with pytest.raises(ModelError, match=r'no node "n9"'):
        frame.add_superelement("s", ["n0", "n9"], np.eye(12), np.eye(12))
    assert not frame.superelements
    frame = mast(members=True)
    frame.add_superelement("s", ["n0", "n1", "n2"], good, -1e6 * good)
    with pytest.raises(ModelError, match='a superelement "s" exists already'):
        frame.add_superelement("s", ["n0", "n1", "n2"], good, good)
    with pytest.raises(ModelError, match="the mass is negative near"):
        assemble(frame)
