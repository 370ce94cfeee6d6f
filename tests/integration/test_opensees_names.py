"""What others ask a bearing's element for: forces in local axes, a model's print, a database."""

import copy
import json
import pickle  # of our own results  # noqa: S403
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lir_element.opensees import bearing_response, record_bearings

THIRD = np.array([2.0, -1.0, 2.0]) / 3.0
FIRST = np.array([2.0, 2.0, -1.0]) / 3.0
LOCAL = np.array([THIRD, FIRST, np.cross(THIRD, FIRST)])  # x along the axis, y, z
TURN = np.kron(np.eye(4), LOCAL)


def beside_a_single_pendulum(stand: Any, unit: float = 1.0, newton: float = 1.0) -> None:
    """Move a plain bearing (1) and OpenSees' element (2), both askew, by the same displacements."""
    ops, device = stand.ops, stand.DEVICE.as_dcfp(rims=False)
    stiff = device.resolved()["axial_stiffness"] * unit / newton
    stand.begin()
    ops.node(1, 0.0, 0.0, 0.0)
    ops.node(2, 0.0, 0.0, 0.0)
    ops.fix(1, *[1] * 6)
    orient = (*THIRD, *FIRST)
    stand.put(1, 1, 2, device, orient=orient, length_unit=unit, force_unit=newton)
    ops.uniaxialMaterial("Elastic", 1, stiff)
    ops.uniaxialMaterial("Elastic", 2, 0.0)
    ops.frictionModel("Coulomb", 1, 0.033 * 1.5 / 1.415)  # of the spheres, at the pendulum
    ops.element(
        "singleFPBearing",
        2,
        1,
        2,
        1,
        1.415 / unit,
        1e9 * unit / newton,
        "-P",
        1,
        "-T",
        2,
        "-My",
        2,
        "-Mz",
        2,
        "-orient",
        *orient,
    )
    moved = LOCAL.T @ np.array([-2.5e-4, 0.004, 0.002]) / unit  # hardly a rise
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    for dof, value in enumerate((*moved, 1e-4, -2e-4, 3e-4), 1):
        ops.sp(2, dof, value)
    stand.solver(handler=("Transformation",), tolerance=1e-6, test="EnergyIncr")
    ops.integrator("LoadControl", 0.05)
    ops.analysis("Static")
    assert ops.analyze(20) == 0


def test_responses_lie_as_those_of_opensees_own_bearing(stand: Any) -> None:
    beside_a_single_pendulum(stand)
    ops = stand.ops

    def both(name: str) -> tuple[np.ndarray, np.ndarray]:
        pair = [np.array(ops.eleResponse(tag, name)) for tag in (1, 2)]
        assert pair[0].shape == pair[1].shape, name
        assert bearing_response(1, name) == pytest.approx(pair[0], rel=1e-12, abs=1e-9)
        return pair[0], pair[1]

    for plural in ("", "s"):
        ours, theirs = both("globalForce" + plural)
        assert (TURN @ ours)[[0, 1, 2, 6, 7, 8]] == pytest.approx(
            (TURN @ theirs)[[0, 1, 2, 6, 7, 8]], rel=0.04
        )
        local, other = both("localForce" + plural)
        assert local == pytest.approx(TURN @ ours, rel=1e-9, abs=1e-6)
        assert other == pytest.approx(TURN @ theirs, rel=1e-9, abs=1e-6)
        basic, other = both("basicForce" + plural)
        assert basic == pytest.approx(local[6:], rel=1e-12)
        assert basic[:3] == pytest.approx(other[:3], rel=0.04)
        assert basic[0] < -5e5
        assert basic[1] > 2.0 * basic[2] * 0.9 > 0.0
        for name in ("localDisplacement", "deformation", "basicDeformation", "basicDisplacement"):
            ours, theirs = both(name + plural)
            assert ours == pytest.approx(theirs, rel=1e-9, abs=1e-15)
    assert ops.basicForce(1) == pytest.approx(basic)
    assert ops.basicDeformation(1) == pytest.approx(theirs)
    for k, name in enumerate(("xaxis", "yaxis", "zaxis")):
        assert ops.eleResponse(1, name) == pytest.approx(LOCAL[k])


def test_responses_are_in_the_models_units(stand: Any) -> None:
    beside_a_single_pendulum(stand)
    force = np.array(stand.ops.eleResponse(1, "basicForce"))
    moved = np.array(stand.ops.eleResponse(1, "deformation"))
    beside_a_single_pendulum(stand, 0.001, 1000.0)
    per = np.array([1000.0] * 3 + [1.0] * 3)
    assert np.array(stand.ops.eleResponse(1, "basicForce")) * per == pytest.approx(force, rel=1e-6)
    per = np.array([0.001] * 3 + [1.0] * 3)
    assert np.array(stand.ops.eleResponse(1, "deformation")) * per == pytest.approx(moved, rel=1e-9)


def test_the_plane_has_three_basic_forces(stand: Any) -> None:
    ops = stand.ops
    stand.begin(ndm=2)
    ops.node(1, 0.0, 0.0)
    ops.node(2, 0.0, 0.0)
    ops.fix(1, 1, 1, 1)
    ops.fix(2, 0, 0, 1)
    stand.put(1, 1, 2, orient=(0.0, 1.0, 0.0, 1.0, 0.0, 0.0))
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    ops.load(2, 2e4, -1e6, 0.0)
    stand.solver()
    ops.integrator("LoadControl", 0.1)
    ops.analysis("Static")
    assert ops.analyze(10) == 0
    assert ops.eleResponse(1, "basicForce")[:2] == pytest.approx([-1e6, 2e4], rel=1e-6)
    x, y, _ = ops.nodeDisp(2)
    assert ops.eleResponse(1, "deformation") == pytest.approx([y, x, 0.0])
    assert len(ops.eleResponse(1, "localForce")) == 6


def test_a_printed_model_is_json(stand: Any, tmp_path: Path) -> None:
    stand.build(count=2)
    stand.gravity()
    stand.ops.uniaxialMaterial("Elastic", 9, 1.0)
    stand.ops.element("zeroLength", 9, 1, 2, "-mat", 9, "-dir", 1)
    path = tmp_path / "model.json"
    stand.ops.printModel("-JSON", "-file", str(path))
    found = json.loads(path.read_text())
    elements = found["StructuralAnalysisModel"]["geometry"]["elements"]
    assert [each["name"] for each in elements] == [1, 2, 9]
    assert elements[1] == {
        "name": 2,
        "type": "LIRBearing",
        "nodes": [1, 3],
        "level": "pendulum",
        "route": stand.route,
    }
    assert elements[2]["nodes"] == [1, 2]


def test_recordings_are_not_copied(stand: Any) -> None:
    stand.build()
    recording = record_bearings()
    for way in (copy.copy, copy.deepcopy, pickle.dumps):
        with pytest.raises(TypeError, match=r"copy or save its dataset\(\)"):
            way(recording)
    stand.gravity()
    data = recording.dataset()
    assert pickle.loads(pickle.dumps(data)).identical(data)  # noqa: S301
