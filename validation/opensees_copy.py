"""A building of `frames` built again in OpenSeesPy, and analysed there."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from frames import GroundMotion
from frames.assembly import assemble
from frames.axes import default_up

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Sequence

    from frames import Frame, Section
    from frames._types import FloatArray

STANDARD_GRAVITY = 9.80665


def build_in_opensees(
    ops: Any,
    frame: Frame,
    *,
    transformation: str = "Linear",
    diaphragms: Collection[str] | None = None,
) -> tuple[dict[str, int], list[int]]:
    """Build members, masses and diaphragms of a frame in OpenSees, without bearings and supports.

    Parameters
    ----------
    ops : module
        The commands of OpenSees; its model is wiped.
    frame : Frame
        The building.
    transformation : str
        Geometric transformation of the columns; that of beams is Linear.
    diaphragms : collection of str, optional
        Names of the diaphragms to build; None is all.

    Returns
    -------
    tags : dict of str to int
        Tags of the nodes by name.
    bases : list of int
        Tags of the nodes above the bearings.
    """
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    ground = {link.i for link in frame.bearings.values()}
    system = assemble(frame)
    tags: dict[str, int] = {}
    for name, node in frame.nodes.items():
        if name not in ground:
            tags[name] = len(tags) + 1
            ops.node(tags[name], *node.position)
            ops.mass(tags[name], *system.node_mass[system.node_names.index(name)].tolist())
    for tag, member in enumerate(frame.members.values(), start=1):
        start, end = (np.array([frame.nodes[node].position]) for node in (member.i, member.j))
        is_column = abs(end[0, 2] - start[0, 2]) > 1.0
        up = default_up(start, end)[0] if member.up is None else np.array(member.up)
        ops.geomTransf(transformation if is_column else "Linear", tag, *up.tolist())
        _add_beam(ops, tag, tags[member.i], tags[member.j], member.section)
    chosen = frame.diaphragms if diaphragms is None else diaphragms
    for diaphragm in frame.diaphragms.values():
        if diaphragm.name in chosen:
            ops.rigidDiaphragm(3, *[tags[name] for name in diaphragm.nodes])
    return tags, [tags[link.j] for link in frame.bearings.values()]


def _add_beam(ops: Any, tag: int, i: int, j: int, section: Section) -> None:
    s = section
    elastic = (s.elastic_modulus, s.shear_modulus)
    inertia = (s.torsion_constant, s.inertia_y, s.inertia_z)
    if np.isfinite(s.shear_area_y):
        shear = (s.shear_area_y, s.shear_area_z)
        ops.element("ElasticTimoshenkoBeam", tag, i, j, *elastic, s.area, *inertia, *shear, tag)
    else:
        ops.element("elasticBeamColumn", tag, i, j, s.area, *elastic, *inertia, tag)


def add_weights(ops: Any, tags: Iterable[int]) -> None:
    """Load nodes with the weight of their masses, pattern 1."""
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    for tag in tags:
        ops.load(tag, 0.0, 0.0, -STANDARD_GRAVITY * ops.nodeMass(tag, 3), 0.0, 0.0, 0.0)


def static_analysis(ops: Any, step: float) -> None:
    """Set up a static analysis with load steps of this size."""
    _common(ops)
    ops.test("NormDispIncr", 1e-12, 20)
    ops.algorithm("Newton")
    ops.integrator("LoadControl", step)
    ops.analysis("Static")


def analyse_gravity(ops: Any) -> None:
    """Apply the loads in one step and keep them.

    Raises
    ------
    RuntimeError
        If OpenSees finds no equilibrium.
    """
    static_analysis(ops, 1.0)
    if ops.analyze(1):
        msg = "OpenSees found no equilibrium under gravity"
        raise RuntimeError(msg)
    ops.loadConst("-time", 0.0)


def shake(
    ops: Any, motion: GroundMotion, dt: float, steps: int, nodes: Sequence[int],
    *, linear: bool = True, system: str = "BandGeneral",
) -> FloatArray:  # fmt: skip
    """Integrate the present model of OpenSees by Newmark's method.

    Parameters
    ----------
    ops : module
        The commands of OpenSees.
    motion : GroundMotion
        Acceleration of the ground.
    dt : float
        Step [s].
    steps : int
        Number of steps.
    nodes : sequence of int
        Nodes to record.
    linear : bool
        Whether the model is linear; else Newton's method is used.
    system : str
        Storage of the equations; modal damping fills the matrix and needs "FullGeneral".

    Returns
    -------
    ndarray, (steps + 1, nodes, 6)
        Displacements since the beginning.

    Raises
    ------
    RuntimeError
        If a step fails.
    """
    for axis in range(3):
        tag = 10 + axis
        values = motion.components[:, axis].tolist()
        ops.timeSeries("Path", tag, "-dt", motion.dt, "-values", *values)
        ops.pattern("UniformExcitation", tag, axis + 1, "-accel", tag)
    _common(ops, system)
    ops.test("NormDispIncr", 1e-10, 50)
    ops.algorithm("Linear" if linear else "Newton")
    ops.integrator("Newmark", 0.5, 0.25)
    ops.analysis("Transient")
    rest = np.array([ops.nodeDisp(tag) for tag in nodes])
    history = [np.zeros_like(rest)]
    for step in range(steps):
        if ops.analyze(1, dt):
            msg = f"OpenSees failed in step {step} of {steps}"
            raise RuntimeError(msg)
        history.append(np.array([ops.nodeDisp(tag) for tag in nodes]) - rest)
    return np.array(history)


def _common(ops: Any, system: str = "BandGeneral") -> None:
    ops.wipeAnalysis()
    ops.system(system)
    ops.constraints("Transformation")
    ops.numberer("RCM")


def waves(scale: float, duration: float, dt: float = 0.01) -> GroundMotion:
    """Make a motion in three directions that starts and ends softly; peaks of 1.8 m/s2 scaled."""
    t = np.arange(0.0, duration, dt)
    envelope = np.minimum(t, 1.0) * np.minimum((duration - t) / 1.5, 1.0)
    parts = ((1.8, 1.5), (1.4, 1.9), (0.8, 0.3))
    components = [
        scale * peak * envelope * np.sin(2.0 * np.pi * t / period) for peak, period in parts
    ]
    return GroundMotion(*components, dt=dt, name="made waves")
