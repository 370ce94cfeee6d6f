"""One building in both programs: a steel frame of two storeys on four plain bearings.

Sections without shear deformation, damping proportional to the members' stiffness in both, so that
the structures are the same and the bearings undamped.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from frames import (
    Frame,
    GroundMotion,
    RayleighDamping,
    Section,
    gravity,
    modes,
    moment_frame,
    time_history,
)
from frames.library.models import DEFAULT_BASE_BEAM, DEFAULT_BEAM, DEFAULT_COLUMN
from lir_element import CoulombFriction, Features, LIRBearing
from lir_element.opensees import builtin_element
from validation.claims.opensees_causes import F_MAX, LARGE, SLIP, STEP, VERTICAL, Gap, Rung
from validation.opensees.frames import frame_history
from validation.scenes import example_bearing

if TYPE_CHECKING:
    from frames._types import FloatArray
    from lir_element.opensees.compare.builtin_writing import BuiltinKind

LOAD = 550e3  # N, about that of each bearing
RATIO = 0.02  # of damping, in the first mode
FAR = 1e6  # s: a period that leaves the part proportional to mass out
DURATION = 15.0  # s
ANGLE = math.radians(30.0)  # of the motion in plan
STIFFENED = 1e3  # times the inertia of the base beams
NODES = ("base-0-0", "floor-2-0-0")

TILT: Rung = (
    "tilt of the plates, and how N U is shared between the nodes",
    "both: base beams a thousand times as stiff",
    {"rigid_base": True},
)
RUNGS: tuple[Rung, ...] = (TILT, VERTICAL, LARGE)


@dataclass(frozen=True)
class Building:
    """What is run: which element, and what is modelled (see `opensees_causes.Setting`)."""

    kind: BuiltinKind
    rigid_base: bool = False
    coupled: bool = True
    scale: float = 1.0


def frame_of(setting: Building) -> Frame:
    """Return the building of a setting."""
    bearing = example_bearing(
        friction=CoulombFriction(setting.scale * F_MAX),
        design_load=LOAD,
        slider_radius=0.1,
        yield_displacement=setting.scale * SLIP,
    ).as_dcfp(rims=False)
    return steel_frame(bearing, rigid_base=setting.rigid_base)


def steel_frame(bearing: LIRBearing, *, rigid_base: bool = False) -> Frame:
    """Return one bay by one, two storeys, damped by the members' stiffness alone."""
    base = slender(DEFAULT_BASE_BEAM)
    if rigid_base:
        base = replace(
            base, inertia_y=STIFFENED * base.inertia_y, inertia_z=STIFFENED * base.inertia_z
        )
    frame = moment_frame(
        bays=(1, 1),
        storeys=2,
        bearing=bearing,
        column=slender(DEFAULT_COLUMN),
        beam=slender(DEFAULT_BEAM),
        base_beam=base,
        floor_load=1900.0,
        damping=None,
    )
    frame.set_damping(RayleighDamping(RATIO, (FAR, first_period(frame))))
    return frame


def stiffness_damping(frame: Frame) -> float:
    """Return the factor of the members' stiffness in the damping of a `steel_frame` [s]."""
    return RATIO * first_period(frame) / math.pi


def first_period(frame: Frame) -> float:
    """Return the first period on a fixed base [s]."""
    return float(modes(frame, 1, bearings="fixed").periods[0])


def slender(section: Section) -> Section:
    """Return a section without shear deformation."""
    return replace(section, shear_area_y=math.inf, shear_area_z=math.inf)


def apart(setting: Building, record: GroundMotion) -> Gap:
    """Run the building in both programs and return the differences."""
    frame = frame_of(setting)
    motion = record.scaled(setting.scale).rotated(ANGLE).trimmed(0.0, DURATION)
    data = time_history(
        frame, motion, dt=STEP, features=Features(vertical_coupling=setting.coupled)
    )
    load = float(gravity(frame).axial_forces.mean())

    def place(tag: int, i: int, j: int, bearing: LIRBearing) -> None:
        builtin_element(setting.kind, tag, i, j, bearing, load)

    track = frame_history(
        frame, place, motion, STEP, NODES, stiffness_damping=stiffness_damping(frame)
    )
    ours = data["node_displacement"].sel(node=list(NODES)).to_numpy()[:, :, :2]
    theirs = track.displacement[: len(ours), :, :2]
    shears = (data["bearing_force"].sum("bearing").to_numpy(), track.force.sum(axis=1))
    pairs = {
        "base": (ours[:, 0], theirs[:, 0]),
        "drift": (ours[:, 1] - ours[:, 0], theirs[:, 1] - theirs[:, 0]),
        "shear": (shears[0][:, :2], shears[1][:, :2]),
    }
    gap = {name: _peak(b) / _peak(a) - 1.0 for name, (a, b) in pairs.items()}
    return {**gap, "path": _peak(ours[:, 0] - theirs[:, 0]) / _peak(ours[:, 0])}


def _peak(values: FloatArray) -> float:
    return float(np.hypot(*values.T).max())
