"""Where a bearing stands in OpenSees: remedies that help."""

import numpy as np
import pytest

from lir_element.opensees.placement import PlacementWarning, place
from tests.scenes import simple_bearing

pytest.importorskip("openseespy")

BEARING = simple_bearing(capacity=0.2, interface_friction=0.12)


def nodes(ops, rise):
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    ops.node(1, 0.0, 0.0, 0.0)
    ops.node(2, 0.0, 0.0, rise)
    ops.fix(1, 1, 1, 1, 1, 1, 1)


def test_millimetres_are_told_and_the_remedy_helps(ops):
    nodes(ops, 1e3 * BEARING.height)
    with pytest.raises(ValueError, match=r"1,000 times .* length_unit=0\.001"):
        place(ops, 1, 2, BEARING, None, 1.0, 1.0)
    place(ops, 1, 2, BEARING, None, 0.001, 1e3)


def test_swapped_nodes_are_told_and_the_remedy_helps(ops):
    nodes(ops, BEARING.height)
    with pytest.raises(ValueError, match="swap the nodes, i=1 and j=2"):
        place(ops, 2, 1, BEARING, None, 1.0, 1.0)
    place(ops, 1, 2, BEARING, None, 1.0, 1.0)


def test_swapped_nodes_that_coincide_are_told_by_the_supports(ops):
    nodes(ops, 0.0)
    with pytest.warns(PlacementWarning, match="if the support is below, swap them, i=1 and j=2"):
        place(ops, 2, 1, BEARING, None, 1.0, 1.0)
    place(ops, 1, 2, BEARING, None, 1.0, 1.0)
    ops.fix(2, 1, 1, 1, 1, 1, 1)  # nothing to be told of two supports
    place(ops, 2, 1, BEARING, None, 1.0, 1.0)


def test_a_tag_of_numpy_is_taken(ops):
    from lir_element.opensees import bearing_element

    nodes(ops, 0.0)
    assert bearing_element(np.int64(5), np.int64(1), np.int64(2), BEARING) in {"fast", "portable"}
    assert list(ops.getEleTags()) == [5]
    ops.wipe()
