"""Runs shared by tests of time histories; each one's energy balance is checked as it is made."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
import xarray as xr

from frames import Frame, GroundMotion, energy_error, time_history
from lir_element import LIRBearing, VelocityFriction
from lir_element.opensees import bearing_element, bearing_tags, opensees
from lir_element.opensees.fast.selftest import why_not_fast
from lir_element.opensees.plugin import _SESSION

LEDGER = 1e-3  # of the input


@pytest.fixture(scope="session")
def run() -> Callable[..., xr.Dataset]:
    """Run a time history and check that its energy balance closes within 0.1 %."""

    def analyse(model: Frame, motion: GroundMotion, **options: Any) -> xr.Dataset:
        data = time_history(model, motion, **options)
        assert np.isfinite(data["node_displacement"]).all()
        assert energy_error(data) < LEDGER
        return data

    return analyse


@pytest.fixture(scope="session")
def newhall_bearing() -> LIRBearing:
    """The bearing of the paper's numerical example (section 3.1)."""
    return LIRBearing(
        radius=1.185,
        slider_height=0.12,
        slider_radius=0.15,
        capacity=0.25,
        friction=VelocityFriction(f_max=0.065, f_min=0.0325, rate=15.0),
        interface_friction=0.13,
    )


@pytest.fixture(scope="session")
def pulse() -> Callable[..., np.ndarray]:
    """Make a sine that grows and fades smoothly, then rest; (n,) [m/s2]."""

    def make(
        peak: float, period: float, dt: float = 0.005, cycles: float = 2.0, rest: float = 1.0
    ) -> np.ndarray:
        length = cycles * period
        t = np.arange(0.0, length + dt, dt)
        window = np.sin(np.pi * np.minimum(t / length, 1.0))
        wave = peak * np.sin(2.0 * np.pi * t / period) * window
        return np.concatenate([wave, np.zeros(round(rest / dt))])

    return make


class Stand:
    """A mass on bearings in OpenSees by one route: nodes 2, 3, ... on node 1 below."""

    LOAD = 1e6
    MASS = 1e5
    DEVICE = LIRBearing(
        radius=0.75,
        slider_height=0.085,
        slider_radius=0.08,
        capacity=0.175,
        friction=VelocityFriction(f_max=0.066, f_min=0.033, rate=20.0),
        interface_friction=0.126,
        design_load=LOAD,
    )

    def __init__(self, ops: Any, route: str) -> None:
        self.ops = ops
        self.route = route

    def begin(self, ndm: int = 3) -> None:
        """Begin a new model."""
        self.ops.wipe()
        self.ops.model("basic", "-ndm", ndm, "-ndf", 6 if ndm == 3 else 3)

    @staticmethod
    def fresh_server() -> None:
        """End the server of this process: a new one writes to where standard error is captured."""
        if _SESSION.server is not None:
            _SESSION.server.close()
            _SESSION.server = None

    def put(
        self, tag: int, i: int, j: int, bearing: LIRBearing | None = None, **options: Any
    ) -> None:
        """Add a bearing."""
        taken = bearing_element(tag, i, j, bearing or self.DEVICE, route=self.route, **options)
        assert taken == self.route

    def build(
        self,
        bearing: LIRBearing | None = None,
        *,
        count: int = 1,
        height: float = 0.0,
        fixed: tuple[int, ...] = (0, 0, 0, 1, 1, 1),
        **options: Any,
    ) -> None:
        """Build masses on bearings 1, 2, ... in three dimensions."""
        self.begin()
        self.ops.node(1, 0.0, 0.0, 0.0)
        self.ops.fix(1, *[1] * 6)
        for node in range(2, count + 2):
            self.ops.node(node, 0.0, 0.0, height)
            self.ops.fix(node, *fixed)
            self.ops.mass(node, *[self.MASS] * 3, *[0.0] * 3)
            self.put(node - 1, 1, node, bearing, **options)

    def solver(
        self,
        algorithm: str = "Newton",
        handler: tuple[Any, ...] = ("Plain",),
        tolerance: float = 1e-9,
        iterations: int = 100,
        test: str = "NormDispIncr",
    ) -> None:
        """Begin an analysis."""
        ops = self.ops
        ops.wipeAnalysis()
        ops.constraints(*handler)
        ops.numberer("RCM")
        ops.system("UmfPack")
        ops.test(test, tolerance, iterations)
        ops.algorithm(algorithm)

    def gravity(self, load: float = LOAD, steps: int = 5, **solver: Any) -> None:
        """Load all nodes above, statically, and set the time back."""
        ops = self.ops
        ops.timeSeries("Linear", 1)
        ops.pattern("Plain", 1, 1)
        for node in ops.getNodeTags()[1:]:
            ops.load(node, 0.0, 0.0, -load, 0.0, 0.0, 0.0)
        self.solver(**solver)
        ops.integrator("LoadControl", 1.0 / steps)
        ops.analysis("Static")
        assert ops.analyze(steps) == 0
        ops.loadConst("-time", 0.0)
        ops.wipeAnalysis()

    def shaking(
        self, peak: float = 3.0, integrator: tuple[Any, ...] = ("Newmark", 0.5, 0.25), **solver: Any
    ) -> None:
        """Prepare a sinusoidal ground acceleration along x [m/s2], period 1 s."""
        ops = self.ops
        ops.timeSeries("Trig", 2, -1000.0, 1000.0, 1.0, "-factor", peak)
        ops.pattern("UniformExcitation", 2, 1, "-accel", 2)
        self.solver(**solver)
        ops.integrator(*integrator)
        ops.analysis("Transient")

    def run(self, steps: int = 100, dt: float = 0.01) -> np.ndarray:
        """Advance the analysis; returns displacements of node 2 (steps, 3)."""
        moved = np.zeros((steps, 3))
        for k in range(steps):
            assert self.ops.analyze(1, dt) == 0, f"step {k}"
            moved[k] = self.ops.nodeDisp(2)[:3]
        return moved


@pytest.fixture(params=["fast", "portable"])
def stand(request: pytest.FixtureRequest) -> Iterator[Stand]:
    """An empty model in OpenSees for each route, and an empty one after the test."""
    pytest.importorskip("openseespy")
    ops = opensees()
    if request.param == "fast" and why_not_fast():
        pytest.skip(f"the in-process coupling is not possible: {why_not_fast()}")
    ops.wipe()
    yield Stand(ops, request.param)
    ops.wipe()
    assert bearing_tags() == ()
