"""The bearing inside the multibody program Exudyn, beside the package's own time histories."""

import sys
from importlib import import_module

import numpy as np
import pytest

from frames import lumped_mass, time_history
from lir_element.exudyn import ExudynBearing, after_step
from validation.scenes import EXAMPLE_MASS, example_bearing, made

GRAVITY = 9.80665
DURATION, STEP = 2.0, 0.004


def test_what_is_not_installed_is_named_with_its_extra(monkeypatch):
    monkeypatch.setitem(sys.modules, "exudyn", None)
    with pytest.raises(ImportError, match=r'pip install "lir-dcfp\[exudyn\]"'):
        ExudynBearing(None, example_bearing(), (0, (0.0, 0.0, 0.0)))


@pytest.fixture(scope="module")
def exudyn():
    return pytest.importorskip("exudyn", reason="exudyn is not installed")


class Scene:
    """An empty system of Exudyn, and what is added to it."""

    def __init__(self, exudyn):
        items = import_module("exudyn.itemInterface")

        self.exudyn, self.items = exudyn, items
        self.container = exudyn.SystemContainer()
        self.system = self.container.AddSystem()

    def body(self, z, mass, down=0.0, turn=0.0):
        node = self.system.AddNode(
            self.items.NodeRigidBodyRotVecLG(
                referenceCoordinates=[0, 0, z, 0, turn, 0], initialCoordinates=[0, 0, down, 0, 0, 0]
            )
        )
        inertia = [mass, mass, mass, 0, 0, 0]
        body = self.system.AddObject(
            self.items.ObjectRigidBody(mass=mass, inertia=inertia, nodeNumber=node)
        )
        return node, self.marker(body)

    def marker(self, body):
        return self.system.AddMarker(
            self.items.MarkerBodyRigid(bodyNumber=body, localPosition=[0, 0, 0])
        )

    def hold(self, marker, axes):
        ground = self.marker(self.system.AddObject(self.items.ObjectGround()))
        self.system.AddObject(
            self.items.ObjectJointGeneric(markerNumbers=[ground, marker], constrainedAxes=axes)
        )


@pytest.mark.parametrize(("level", "on_a_body"), [("pendulum", True), ("contact", False)])
def test_a_mass_on_one_bearing(exudyn, level, on_a_body):
    bearing, motion = example_bearing(), made("pulse", DURATION, x=(3.0, 1.7, 0.9))
    scene = Scene(exudyn)
    down = EXAMPLE_MASS * GRAVITY / bearing.resolved()["axial_stiffness"]
    top, marker = scene.body(bearing.height + 1.0, EXAMPLE_MASS, -down)
    scene.hold(marker, [0, 0, 0, 1, 1, 1])
    lower = None
    if on_a_body:
        bottom, held = scene.body(0.0, EXAMPLE_MASS)
        scene.hold(held, [1] * 6)
        lower = (bottom, (0.0, 0.0, 0.0))
    element = ExudynBearing(scene.system, bearing, (top, (0.0, 0.0, -1.0)), lower, level)
    times = motion.dt * np.arange(len(motion.x))

    def load(_system, t, _):
        return [-EXAMPLE_MASS * np.interp(t, times, motion.x), 0.0, -EXAMPLE_MASS * GRAVITY]

    scene.system.AddLoad(
        scene.items.LoadForceVector(
            markerNumber=marker, loadVector=[0, 0, 0], loadVectorUserFunction=load
        )
    )
    commit, seen = after_step([element]), []

    def record(system, time):
        seen.append((time, *element.element.response("displacement")[[6, 0]]))
        return commit(system, time)

    scene.system.SetPostStepUserFunction(record)
    scene.system.Assemble()
    settings = exudyn.SimulationSettings()
    settings.solution.file.write = False
    way = settings.timeIntegration
    way.endTime, way.numberOfSteps, way.verboseMode = DURATION, round(DURATION / STEP), 0
    way.generalizedAlpha.spectralRadius = 0.5
    way.newton.relativeTolerance, way.newton.absoluteTolerance = 1e-6, 0.1
    scene.system.SolveDynamic(settings)
    time, above, below = np.array(seen).T
    assert (np.diff(time) > 0.0).all()  # a step that failed is not committed
    data = time_history(lumped_mass(bearing, EXAMPLE_MASS), motion, level=level, duration=DURATION)
    want = data["bearing_displacement"].sel(axis="x").to_numpy()[:, 0]
    size = np.abs(want).max()
    assert size > 0.05
    assert np.abs(np.interp(data["time"], time, above - below) - want).max() < 0.01 * size


def test_nodes_that_do_not_serve_are_refused(exudyn):
    scene = Scene(exudyn)
    place = (0.0, 0.0, 0.0)
    good, turned = scene.body(0.0, 1.0)[0], scene.body(0.0, 1.0, turn=0.1)[0]
    point = scene.system.AddNode(scene.items.NodePoint(referenceCoordinates=[0, 0, 0]))
    for upper, lower, words in (
        (point, None, "use a NodeRigidBodyRotVecLG"),
        (turned, None, "turned in its reference state"),
        (good, good, "pass the nodes of two bodies"),
    ):
        below = lower if lower is None else (lower, place)
        with pytest.raises(ValueError, match=words):
            ExudynBearing(scene.system, example_bearing(), (upper, place), below)
