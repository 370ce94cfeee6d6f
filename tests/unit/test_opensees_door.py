"""What a bearing in OpenSees is checked for: messages name value, bound and remedy."""

import os
import sys
import warnings
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from tests.refusals import refused
from validation.scenes import static_bearing

pytest.importorskip("openseespy")
pytest.importorskip("psutil")

import lir_element.opensees as package
from lir_element.child_process import child_environment
from lir_element.opensees import PlacementWarning, bearing_element, bearing_tags, opensees
from lir_element.opensees.connection import own_connections
from lir_element.opensees.placement import bearing_axes, place

DEVICE = static_bearing()


@pytest.fixture
def ops() -> Iterator[Any]:
    """Node 1 below, 2 there too, 3 at the bearing's height, 4 too high, 5 beside; element 50."""
    commands = opensees()
    commands.wipe()
    commands.model("basic", "-ndm", 3, "-ndf", 6)
    commands.node(1, 0.0, 0.0, 0.0)
    commands.node(2, 0.0, 0.0, 0.0)
    commands.node(3, 0.0, 0.0, DEVICE.height)
    commands.node(4, 0.0, 0.0, 0.2)
    commands.node(5, 0.01, 0.0, DEVICE.height)
    commands.node(6, 0.0, 0.0, -DEVICE.height)
    commands.uniaxialMaterial("Elastic", 1, 1.0)
    commands.element("zeroLength", 50, 1, 2, "-mat", 1, "-dir", 1)
    yield commands
    commands.wipe()


CALLS: list[tuple[dict[str, Any], type[Exception], str]] = [
    ({"i": 77}, ValueError, "node 77 is not in the current OpenSees model: add it"),
    ({"j": 77}, ValueError, "node 77 is not in the current OpenSees model: add it"),
    ({"j": 1}, ValueError, "starts and ends at node 1: pass two different nodes"),
    ({"i": "a"}, TypeError, "node i = 'a' must be an integer tag"),
    ({"j": True}, TypeError, "node j = True must be an integer tag"),
    ({"tag": 50}, ValueError, "element 50 is in the model already: choose another tag"),
    ({"tag": 1.0}, TypeError, r"tag = 1\.0 must be an integer"),
    ({"tag": 2**31}, ValueError, "tag = 2147483648 exceeds .* choose one up to 2147483647"),
    ({"j": 4}, ValueError, r"node 4 is 0\.2 m above node 1, it must be 0 m or .*0\.085 m.*move it"),
    ({"j": 6}, ValueError, r"node 6 is 0\.085 m below node 1"),
    ({"j": 5}, ValueError, r"node 5 is 0\.01 m off the bearing's axis.*0\.001 m.*by orient"),
    ({"level": "rigid_body"}, ValueError, r"level = 'rigid_body': choose one of \('pendulum'"),
    ({"tangent": "secant"}, ValueError, r"tangent = 'secant': choose one of \('consistent'"),
    ({"route": "quick"}, ValueError, r"route = 'quick': choose one of \('auto'"),
    ({"bearing": "LIR"}, TypeError, "bearing = 'LIR' must be an LIRBearing"),
    ({"orient": (0.0, 0.0)}, ValueError, r"orient = \(0\.0, 0\.0\): give the bearing's axis"),
    ({"orient": "up"}, ValueError, "orient = 'up': give the bearing's axis"),
    ({"orient": (0, 0, np.nan)}, ValueError, "orient = .*nan.*: give the bearing's axis"),
    ({"orient": (0, 0, 0)}, ValueError, "its axis has no length"),
    ({"orient": (0, 0, 1, 0, 0, 0)}, ValueError, "its x direction is parallel to it"),
    ({"orient": (0, 0, 1, 0, 0, 3)}, ValueError, "its x direction is parallel to it"),
    ({"j": 3, "orient": (0, 1, 0)}, ValueError, r"node 3 is 0\.085 m off"),
    ({"length_unit": 0.0}, ValueError, "length_unit = 0"),
    ({"length_unit": "mm"}, TypeError, "length_unit = 'mm'"),
    ({"force_unit": -1000.0}, ValueError, "force_unit = -1000"),
]


@pytest.mark.parametrize(("changes", "error", "message"), CALLS)
def test_a_refused_call_leaves_the_model_as_it_was(ops, changes, error, message):
    arguments: dict[str, Any] = {"tag": 1, "i": 1, "j": 2, "bearing": DEVICE, **changes}
    refused(error, message, bearing_element, **arguments)
    assert ops.getEleTags() == [50]
    assert bearing_tags() == ()
    bearing_element(1, 1, 2, DEVICE, route="portable")  # the tag is free
    assert bearing_tags() == (1,)


@pytest.mark.parametrize(("ndm", "ndf"), [(1, 1), (2, 2), (3, 3), (2, 6), (3, 4)])
def test_degrees_of_freedom_are_named(ops: Any, ndm: int, ndf: int) -> None:
    ops.wipe()
    ops.model("basic", "-ndm", ndm, "-ndf", ndf)
    for node in (1, 2):
        ops.node(node, *[0.0] * ndm)
    text = f"node 1 has {ndm} coordinates and {ndf} degrees of freedom: a bearing needs 3 and 6"
    refused(ValueError, text, bearing_element, 1, 1, 2, DEVICE)


def test_without_a_model(ops: Any) -> None:
    ops.wipe()
    with pytest.raises(ValueError, match="node 1 is not in the current OpenSees model"):
        bearing_element(1, 1, 2, DEVICE)


@pytest.mark.parametrize(
    ("orient", "ndm"),
    [
        (None, 3),
        (None, 2),
        ((0, 1, 0), 3),
        ((1, 0, 0), 3),
        ((1, 0, 0), 2),
        ((3, 4, 0), 2),
        ((0, -2, 0), 2),
        ((1, 2, 3, 1, 0, 0), 3),
        ((0.95, 0.3, 0), 3),
    ],
)
def test_axes_are_right_handed_and_z_is_the_bearings(orient: Any, ndm: int) -> None:
    axes = bearing_axes(orient, ndm)
    assert axes @ axes.T == pytest.approx(np.eye(3), abs=1e-12)
    assert np.linalg.det(axes) == pytest.approx(1.0)
    up = np.array((0, 0, 1) if ndm == 3 else (0, 1, 0)) if orient is None else np.array(orient[:3])
    assert axes[2] == pytest.approx(up / np.linalg.norm(up))
    if orient is None:
        assert axes[0] == pytest.approx([1.0, 0.0, 0.0])


def test_axes_leave_the_plane_of_two_dimensions() -> None:
    for orient in ((0, 0, 1), (0, 1, 0.5), (0, 1, 0, 0, 0, 1)):
        with pytest.raises(ValueError, match="in a model of two dimensions both vectors lie in"):
            bearing_axes(orient, 2)


def test_the_map_conserves_work(ops: Any) -> None:
    """Force times displacement is the same in the model's axes and units as in the bearing's."""
    ops.node(7, 0.0, 0.0, 85.0)
    placement = place(ops, 1, 7, DEVICE, (0, 0, 1, 1, 1, 0), 0.001, 1000.0)
    random = np.random.default_rng(3)
    moved, force = random.normal(size=12), random.normal(size=12)
    inside = placement.matrix @ moved
    outside = placement.force_factor * placement.matrix.T @ force
    assert outside @ moved * 0.001 * 1000.0 == pytest.approx(force @ inside)


def four_supports(ops: Any, vertical: int) -> None:
    """Four supports and a storey above them; bearings 1 to 4 stand between nodes k and 10 + k."""
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    for k, (a, b) in enumerate([(0.0, 0.0), (5.0, 0.0), (0.0, 4.0), (5.0, 4.0)], 1):
        for level, number in ((0.0, k), (0.0, 10 + k), (3.0, 20 + k)):
            place = [a, b]
            place.insert(vertical, level)
            ops.node(number, *place)
        ops.fix(k, *[1] * 6)


def test_a_model_that_stands_on_y_is_asked_for_its_axis(ops: Any) -> None:
    four_supports(ops, vertical=1)
    with pytest.warns(PlacementWarning, match=r"points along z, but .* pass orient=\(0, 1, 0\)"):
        bearing_element(1, 1, 11, DEVICE, route="portable")
    with warnings.catch_warnings():
        warnings.simplefilter("error", PlacementWarning)
        bearing_element(2, 2, 12, DEVICE, orient=(0, 1, 0), route="portable")
        bearing_element(3, 3, 13, DEVICE, orient=(0, 0, 1), route="portable")
        four_supports(ops, vertical=2)
        for k in range(1, 5):
            bearing_element(k, k, 10 + k, DEVICE, route="portable")


def test_what_the_package_offers_is_listed() -> None:
    offered = {name for name, each in vars(package).items() if not isinstance(each, ModuleType)}
    assert {name for name in offered if not name.startswith("_")} == set(package.__all__)
    scope: dict[str, Any] = {}
    exec("from lir_element.opensees import *", scope)  # noqa: S102
    assert {"bearing_element", "record_bearings", "PlacementWarning"} <= scope.keys()
    assert "plugin" not in scope


def test_what_is_not_installed_is_named_with_its_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "psutil", None)
    refused(ImportError, r'psutil is not.*pip install "lir-dcfp\[opensees\]"', own_connections)
    monkeypatch.delitem(sys.modules, "openseespy.opensees", raising=False)
    known = {"xara": "there"}
    monkeypatch.setattr("importlib.util.find_spec", known.get)
    said = r'openseespy is not installed: pip install "lir-dcfp\[opensees\]"'
    refused(ImportError, said + r"; or pass a model of xara by ops=$", opensees)
    known.clear()
    refused(ImportError, said + "$", opensees)


def test_a_child_imports_the_packages_of_its_parent(monkeypatch: pytest.MonkeyPatch) -> None:
    """A folder with these packages keeps its place before another installation of them."""
    own = str(Path(package.__file__).parents[2])
    monkeypatch.setattr(sys, "path", [own, "/elsewhere/site-packages"])
    monkeypatch.chdir(own)
    paths = child_environment()["PYTHONPATH"].split(os.pathsep)
    assert paths[0] == own
    monkeypatch.chdir("/")
    monkeypatch.setattr(sys, "path", ["/", own])
    assert child_environment()["PYTHONPATH"].split(os.pathsep) == [own, "/"]
