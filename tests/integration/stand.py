"""A mass on bearings in OpenSees: for the tests, and for the processes that they start."""

import os
import tempfile
from typing import Any

import numpy as np

from lir_element import LIRBearing, VelocityFriction
from lir_element.opensees import bearing_element
from lir_element.opensees.plugin import _SESSION
from tests.scenes import small_bearing

with tempfile.TemporaryFile() as opened:
    ERRORS = os.dup(opened.fileno())  # of the whole process
WATCHED: list[int] = []  # servers that write there


class Stand:
    """A mass on bearings in OpenSees by one route: nodes 2, 3, ... on node 1 below."""

    LOAD = 1e6
    MASS = 1e5
    DEVICE = small_bearing(friction=VelocityFriction(0.066, 0.033, 20.0), design_load=LOAD)

    def __init__(self, ops: Any, route: str, host: Any = None) -> None:
        self.ops = ops
        self.route = route
        self.host = host

    def begin(self, ndm: int = 3) -> None:
        """Begin a new model."""
        self.ops.wipe()
        self.ops.model("basic", "-ndm", ndm, "-ndf", 6 if ndm == 3 else 3)

    def watch_server(self) -> None:
        """Have a server whose standard error is the file of `errors`: one serves many tests."""
        server = _SESSION.server
        if self.route == "portable" and (server is None or server.pid not in WATCHED):
            if server is not None:
                server.close()
                _SESSION.server = None
            own = os.dup(2)
            os.dup2(ERRORS, 2)
            WATCHED.append(_SESSION.running_server().pid)
            os.dup2(own, 2)
            os.close(own)
        self.read = os.fstat(ERRORS).st_size

    def errors(self, capfd: Any) -> str:
        """Return what was written to standard error since the last call, by the server as well."""
        written = os.pread(ERRORS, 1 << 24, self.read)
        self.read += len(written)
        return str(capfd.readouterr().err) + written.decode()

    def put(
        self, tag: int, i: int, j: int, bearing: LIRBearing | None = None, **options: Any
    ) -> None:
        """Add a bearing."""
        device = bearing or self.DEVICE
        taken = bearing_element(tag, i, j, device, route=self.route, ops=self.host, **options)
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


def begin(stand: Stand, count: int = 1) -> None:
    """Load bearings, and prepare to shake them."""
    stand.build(count=count)
    stand.gravity()
    stand.shaking(2.8)


def advance(stand: Stand, steps: int = 20) -> list[int]:
    """Analyse steps; what OpenSees returns of each."""
    return [stand.ops.analyze(1, 0.005) for _ in range(steps)]


def listening(pid: int | None = None) -> set[int]:
    """Ports at which a process waits for connections; this one, if none is given."""
    import psutil

    found = psutil.Process(pid).net_connections()
    return {c.laddr.port for c in found if c.status == psutil.CONN_LISTEN}
