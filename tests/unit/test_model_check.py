"""A model that cannot work is refused, and the message names what is wrong."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy import sparse

from frames.assembly import check
from frames.assembly.assemble import assemble
from frames.assembly.check import ModelError, free_motions
from frames.io import Frame
from frames.library.models import lumped_mass, moment_frame
from frames.model.sections import Section
from tests.refusals import refused

BEARING = SimpleNamespace(axial_stiffness=2e9, height=0.12)
BOX = Section.box(0.3, 0.3, 0.01)


def cantilever(density: float = 7850.0) -> Frame:
    """Return a column on a fixed foot."""
    frame = Frame("cantilever")
    frame.add_node("foot", 0.0, 0.0, 0.0)
    frame.add_node("head", 0.0, 0.0, 3.0)
    frame.fix("foot", "all")
    frame.add_member("column", "foot", "head", Section.box(0.3, 0.3, 0.01, density=density))
    return frame


def on_bearing() -> Frame:
    """Return a mass whose rotations are free, on one bearing."""
    frame = Frame("free plate")
    frame.add_node("ground", 0.0, 0.0, 0.0)
    frame.add_node("plate", 0.0, 0.0, 0.12)
    frame.fix("ground", "all")
    frame.add_mass("plate", 1000.0)
    frame.add_bearing("bearing", "ground", "plate", BEARING)
    return frame


def test_empty_frame() -> None:
    refused(ModelError, r'frame "nothing" has no nodes', assemble, Frame("nothing"))


def test_loose_node_is_named_but_a_fixed_one_is_not() -> None:
    frame = cantilever()
    frame.add_node("survey mark", 9.0, 9.0, 0.0)
    frame.fix("survey mark", "all")
    assemble(frame)
    frame.add_node("lost", 5.0, 0.0, 3.0)
    frame.fix("lost", "ux")
    refused(ModelError, r'node "lost": no member, spring, bearing or diaphragm', assemble, frame)


def test_part_without_support_is_named() -> None:
    frame = cantilever()
    frame.add_node("left", 5.0, 0.0, 3.0)
    frame.add_node("right", 8.0, 0.0, 3.0)
    frame.add_member("afloat", "left", "right", BOX)
    refused(ModelError, r'nodes "left", "right": this part .* no support', assemble, frame)


def test_everything_fixed() -> None:
    frame = cantilever()
    frame.fix("head", "all")
    refused(ModelError, r"every degree of freedom is fixed", assemble, frame)


def test_no_mass_at_all() -> None:
    frame = cantilever(density=0.0)
    frame.add_mass("foot", 500.0)
    refused(ModelError, r"has mass \(500 kg in all, on fixed nodes\)", assemble, frame)


def test_no_mass_in_one_direction() -> None:
    frame = cantilever(density=0.0)
    frame.add_node("shoulder", 0.0, 0.0, 6.0)
    frame.add_member("upper", "head", "shoulder", Section.box(0.3, 0.3, 0.01, density=0.0))
    frame.add_mass("shoulder", 100.0)
    frame.fix("shoulder", "uz")
    refused(ModelError, r'no mass along z: node "head" can move along z', assemble, frame)


def test_free_plate_on_a_bearing_is_a_mechanism() -> None:
    with pytest.raises(ModelError) as caught:
        assemble(on_bearing())
    message = str(caught.value)
    assert "3 independent motion(s)" in message
    assert all(f'"plate {dof}"' in message for dof in ("rx", "ry", "rz"))
    assert 'fix it with fix("plate", "r' in message
    assert "a bearing does not restrain the rotation of its plates" in message


@pytest.mark.parametrize("left_free", ["rx", "ry", "rz"])
def test_one_free_rotation_is_named(left_free: str) -> None:
    frame = on_bearing()
    frame.fix("plate", *({"rx", "ry", "rz"} - {left_free}))
    words = rf'1 independent motion.*motion 1: "plate {left_free}".*rotation {left_free} is not'
    refused(ModelError, words, assemble, frame)
    frame.fix("plate", left_free)
    assemble(frame)


def test_independent_mechanisms_are_told_apart() -> None:
    frame = moment_frame((1, 1), 1, bearing=BEARING)
    frame.add_node("hinge", 20.0, 0.0, 0.0)
    frame.add_node("arm", 20.0, 0.0, 2.0)
    frame.fix("hinge", "ux", "uy", "uz", "ry", "rz")
    frame.add_member("pendulum", "hinge", "arm", BOX)
    frame.add_node("slider", 30.0, 0.0, 0.0)
    frame.add_node("runner", 33.0, 0.0, 0.0)
    frame.fix("slider", "uy", "uz", "rx", "ry", "rz")
    frame.add_member("rail", "slider", "runner", BOX)
    with pytest.raises(ModelError) as caught:
        assemble(frame)
    message = str(caught.value)
    assert "2 independent motion(s)" in message
    motions = [part for part in message.split("; ") if part.startswith("motion")]
    assert len(motions) == 2
    for motion in motions:
        assert ('"arm' in motion or '"hinge' in motion) != (
            '"runner' in motion or '"slider' in motion
        )


def test_diaphragm_that_nothing_holds_in_its_plane() -> None:
    frame = cantilever()
    for k in range(2):
        frame.add_node(f"post-{k}", 5.0 * k, 5.0, 0.0)
        frame.add_node(f"deck-{k}", 5.0 * k, 5.0, 3.0)
        frame.fix(f"post-{k}", "all")
        frame.fix(f"deck-{k}", "rx", "ry")
        frame.add_spring(f"stilt-{k}", f"post-{k}", f"deck-{k}", (0, 0, 1e8, 0, 0, 0))
    frame.add_diaphragm("deck", ["deck-0", "deck-1"])
    refused(ModelError, r'"deck \(diaphragm\) u[xy]".*connect the diaphragm', assemble, frame)


def test_single_bearing_under_a_free_torsion_is_refused_and_two_are_not() -> None:
    frame = Frame("two")
    for k in range(2):
        frame.add_node(f"g{k}", 4.0 * k, 0.0, 0.0)
        frame.add_node(f"b{k}", 4.0 * k, 0.0, 0.12)
        frame.fix(f"g{k}", "all")
        frame.add_bearing(f"bearing-{k}", f"g{k}", f"b{k}", BEARING)
    frame.add_member("girder", "b0", "b1", BOX)
    # Two bearings in a row: the girder may still roll about its own axis.
    refused(ModelError, r'"b[01] rx".*rx is not restrained', assemble, frame)
    frame.fix("b0", "rx")
    assemble(frame)


@pytest.mark.parametrize("limit", [10_000, 0], ids=["dense", "sparse"])
def test_both_solvers_find_the_same_motions(limit: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(check, "DENSE_LIMIT", limit)
    size = 60
    chain = sparse.diags_array(-np.ones((2, size - 1)), offsets=(-1, 1), shape=(size, size))
    chain = chain + sparse.diags_array(np.concatenate([[1.0], np.full(size - 2, 2.0), [1.0]]))
    # Two chains of unlike stiffness, both free to shift.
    both = sparse.csr_array(sparse.block_diag([chain, 1e6 * chain]))
    motions = free_motions(both)
    assert motions.shape == (2 * size, 2)
    forces = both @ motions
    scale = np.abs(motions).max(axis=0)
    assert_allclose(forces / scale, 0.0, rtol=0.0, atol=1e-6)  # 1e-12 of the stiff chain
    held = both + sparse.diags_array(np.eye(2 * size)[0] + np.eye(2 * size)[-1])
    assert free_motions(sparse.csr_array(held)).shape[1] == 0


def test_slender_but_sound_structures_pass() -> None:
    # A mast of 150 members: bending eigenvalue far below the axial one, yet no mechanism.
    frame = Frame("mast")
    count = 150
    for k in range(count + 1):
        frame.add_node(f"n{k}", 0.0, 0.0, 0.4 * k)
    frame.fix("n0", "all")
    for k in range(count):
        frame.add_member(f"m{k}", f"n{k}", f"n{k + 1}", BOX)
    assert len(assemble(frame).dof_labels) == 6 * count
    # A rigid link a million times stiffer than what it carries.
    frame = cantilever()
    frame.add_node("tip", 0.0, 0.0, 3.0)
    frame.add_spring("link", "head", "tip", (1e13, 1e13, 1e13, 1e13, 1e13, 1e13))
    assemble(frame)


def test_large_mechanism_is_found_and_named() -> None:
    frame = moment_frame((4, 3), 6, bearing=BEARING)
    frame.add_node("antenna", 0.0, 0.0, 40.0)
    frame.add_spring("foot", "floor-6-0-0", "antenna", (1e5, 1e5, 1e5, 1e5, 1e5, 0.0))
    refused(ModelError, r'1 independent motion.*motion 1: "antenna rz"', assemble, frame)


def test_lumped_mass_is_sound() -> None:
    assert assemble(lumped_mass(BEARING, 1e5)).dof_labels == ("mass ux", "mass uy", "mass uz")
