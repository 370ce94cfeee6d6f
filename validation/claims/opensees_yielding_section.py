"""A column whose hinges yield by axial force and moment, along a path, here and with fibres."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from frames import Frame
from frames.assembly.assemble import assemble
from frames.assembly.system import STATE_SIZE
from frames.kernels.hinges import hinged_member
from frames.laws import PlasticHinge
from frames.library.models import DEFAULT_COLUMN
from validation.opensees.model import advance, empty_model, lead, solver, static_steps
from validation.opensees.nonlinear import hinged_member as hinged_in_opensees
from validation.opensees.nonlinear import plastic_rotations

if TYPE_CHECKING:
    from frames._types import FloatArray
    from lir_element import LIRBearing

LENGTH = 3.5  # m
AXIAL = 4e6  # N, of the hinge
SECTION = replace(DEFAULT_COLUMN, shear_area_y=math.inf, shear_area_z=math.inf)
ARM = math.sqrt(SECTION.inertia_y / SECTION.area)
HARDENING = 1e-3
HINGE = PlasticHinge(moment_y=AXIAL * ARM, axial=AXIAL, axial_exponent=1.0, hardening=HARDENING)
"""What fibres make: ``|n| + |m| = 1``, and little hardening, without which they find no state."""
CYCLES, STEPS = 3, 2400
DRIFT, STRETCH, PRESSED = 0.06, 6e-3, -3e-4  # m, of the path
FOOT, HEAD, COLUMN = 1, 2, 1  # tags


@dataclass(frozen=True)
class Path:
    """What a column did."""

    axial: FloatArray
    moment: FloatArray
    """(n,): Axial force (tension positive) and moment at the foot [N, N m]."""
    rotation: FloatArray
    """(n,): Plastic rotation of the hinge there [rad]."""
    drift: FloatArray
    stretch: FloatArray
    """(n,): The path [m]."""

    @property
    def dissipated(self) -> float:
        """Work done on the column, less what is elastic at the end [J]."""
        shear = 2.0 * self.moment / LENGTH
        done = [
            float((0.5 * (force[1:] + force[:-1]) * np.diff(move)).sum())
            for force, move in ((self.axial, self.stretch), (shear, self.drift))
        ]
        s = SECTION
        elastic = 0.5 * self.axial[-1] ** 2 * LENGTH / (s.elastic_modulus * s.area)
        elastic += self.moment[-1] ** 2 * LENGTH / (6.0 * s.elastic_modulus * s.inertia_y)
        return sum(done) - float(elastic)

    @property
    def utilisation(self) -> FloatArray:
        """Value of ``|n| + |m|`` (n,) [-]."""
        return np.asarray(np.abs(self.axial / AXIAL) + np.abs(self.moment / HINGE.moment_y))


def course() -> tuple[FloatArray, FloatArray]:
    """Return drift and stretch of the column (n,) [m]: growing cycles out of phase."""
    t = np.linspace(0.0, 2.0 * np.pi * CYCLES, STEPS + 1)
    grow = t / t[-1]
    stretch = STRETCH * grow * np.sin(0.61 * t + 0.4) + PRESSED * np.minimum(t, 1.0)
    return DRIFT * grow * np.sin(t), stretch


def column(bearing: LIRBearing) -> Frame:
    """Return a frame that is one column with hinges at both ends, on a bearing."""
    frame = Frame("column")
    frame.add_node("ground", 0.0, 0.0, 0.0)
    frame.fix("ground", "all")
    frame.add_node("foot", 0.0, 0.0, bearing.height)
    frame.add_node("head", 0.0, 0.0, bearing.height + LENGTH)
    frame.add_bearing("bearing", "ground", "foot", bearing)
    frame.add_member("column", "foot", "head", SECTION)
    frame.add_hinges("column", HINGE)
    frame.fix("foot", "rx", "ry", "rz")
    frame.add_mass("head", 1e4)
    return frame


def here(bearing: LIRBearing) -> Path:
    """Take the column along the path by the kernel of hinged members."""
    par = assemble(column(bearing)).parts.par[0]
    stiffness = par[:25].reshape(5, 5)
    old, new = np.zeros(STATE_SIZE), np.zeros(STATE_SIZE)
    beyond, slope, scratch = np.zeros(5), np.zeros((5, 5)), np.zeros((18, 16))
    drift, stretch = course()
    found = np.zeros((len(drift), 3))
    for k, (u, e) in enumerate(zip(drift, stretch, strict=True)):
        d = np.array([e, 0.0, 0.0, u / LENGTH, u / LENGTH])
        if hinged_member(par, old, new, d, beyond, slope, scratch) < 0:
            msg = f"no state of the hinges was found at step {k}"
            raise RuntimeError(msg)
        force = stiffness @ d + beyond
        found[k] = force[0], force[3], new[1]
        old[:] = new
    axial, moment, rotation = found.T
    return Path(axial, moment, rotation, drift, stretch)


def in_opensees(bearing: LIRBearing) -> Path:
    """Take the same member with sections of fibres along the path in OpenSees."""
    frame = column(bearing)
    drift, stretch = course()
    found = np.zeros((len(drift), 3))
    with empty_model() as ops:
        _place(ops, frame)
        for axis, values in ((1, drift), (3, stretch)):
            lead(ops, HEAD, axis, values)
        solver(ops)
        static_steps(ops, 1.0)
        for k in range(len(drift)):
            if k:
                advance(ops, 1)
            force = ops.eleResponse(COLUMN, "localForce")
            found[k] = force[6], force[4], plastic_rotations(ops, COLUMN)[0][0]
    axial, moment, rotation = found.T
    return Path(axial, moment, rotation, drift, stretch)


def _place(ops: Any, frame: Frame) -> None:
    # Its drift is along its local z; one rotation stays free, for OpenSees wants an unknown.
    ops.node(FOOT, 0.0, 0.0, 0.0)
    ops.node(HEAD, 0.0, 0.0, LENGTH)
    ops.fix(FOOT, 1, 1, 1, 1, 1, 1)
    ops.fix(HEAD, 0, 1, 0, 1, 1, 0)
    ops.geomTransf("Linear", COLUMN, 1.0, 0.0, 0.0)
    member = frame.members["column"]
    hinged_in_opensees(ops, COLUMN, member, (FOOT, HEAD), LENGTH, frame.hinges["column"])
