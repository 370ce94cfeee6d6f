"""The totals of a model under its permanent loads, as an engineer checks them before a run."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from frames._errors import ModelError, ModelWarning
from frames.assembly.assemble import assemble
from frames.model import sanity_checks
from frames.statics.gravity import gravity
from frames.statics.modes import modes
from frames.statics.sanity_checks import (
    BearingLoad,
    bearing_loads,
    isolated_period,
    motion_doubts,
)
from lir_element.device.sanity_checks import sanity_warnings as device_doubts
from lir_element.errors import AnalysisError
from lir_element.texts import html_table, text_table

if TYPE_CHECKING:
    from frames.model.frame_data import FrameData
    from frames.motion.ground_motion import GroundMotion

SHOWN_PERIODS = 3
SHOWN = 12
"""Number of bearings in a printed table; the rest is in `ModelCheck.bearings`."""


@dataclass(frozen=True, repr=False)
class ModelCheck:
    """Totals of a frame (mass, loads, periods, pressures); prints as a table.

    Attributes
    ----------
    name : str
        Name of the frame.
    mass : float
        Total mass [kg].
    weight : float
        Permanent vertical load in all, weights and loads [N].
    loads : tuple of 3 floats
        Sum of the permanent forces along x, y, z besides the weight of the masses [N].
    carried : float
        Load of the bearings [N].
    supports : tuple of (str, float)
        Supports of the structure above the bearings, and the load of each [N].
    periods : tuple of float
        The first three periods on a fixed base (nodes i and j move together), longest first [s];
        none if nothing above the bearings can move.
    isolated_period : float
        Period of the mass on the bearings, as a pendulum [s].
    bearings : tuple of BearingLoad
        Name, axial force [N], pressure [Pa], settlement [m], period [s], and the stable limit of
        interface slip without rims beside the slip at the end of the sliders' overlap [m], of each.
    motion : tuple of (str, str)
        Facts of the motion in words; empty without one.
    doubts : tuple of str
        Unusual values, a sentence each.
    failure : str
        Reason that there is no equilibrium under permanent loads; empty if there is one.

    Examples
    --------
    >>> from frames import lumped_mass
    >>> from frames.demo import bearing_for
    >>> checked = lumped_mass(bearing_for(2000e3), mass=204e3).check()
    >>> checked.ok, checked.mass, round(checked.weight / 1e3)
    (True, 204000.0, 2001)
    """

    name: str
    mass: float
    weight: float
    loads: tuple[float, float, float]
    carried: float
    supports: tuple[tuple[str, float], ...]
    periods: tuple[float, ...]
    isolated_period: float
    bearings: tuple[BearingLoad, ...]
    motion: tuple[tuple[str, str], ...]
    doubts: tuple[str, ...]
    failure: str

    @property
    def ok(self) -> bool:
        """True if there is an equilibrium, and nothing is unusual."""
        return not (self.doubts or self.failure)

    def __str__(self) -> str:
        parts = [self.name, text_table(self._totals(), left=2)]
        if self.bearings:
            parts.append(text_table(self._rows(), _HEAD))
        parts += [f"warning: {note}" for note in self._notes()]
        return "\n".join(parts)

    __repr__ = __str__

    def _repr_html_(self) -> str:
        notes = self._notes()
        first = html_table(self.name, self._totals())
        return first + html_table("bearings", self._rows(), _HEAD, notes)

    def _notes(self) -> list[str]:
        return [*([self.failure] if self.failure else []), *self.doubts]

    def _totals(self) -> list[tuple[str, str]]:
        periods = ", ".join(f"{value:.3g}" for value in self.periods) or "none, rigid"
        rows = [
            ("mass", f"{1e-3 * self.mass:.5g} t"),
            ("permanent vertical load", f"{1e-3 * self.weight:.5g} kN"),
            ("of which non-mass loads", f"{-1e-3 * self.loads[2] + 0.0:.5g} kN"),
        ]
        if any(self.loads[:2]):
            across = " and ".join(f"{1e-3 * value:.5g}" for value in self.loads[:2])
            rows.append(("permanent loads along x and y", f"{across} kN"))
        if not self.failure:
            rows.append(("carried by the bearings", f"{1e-3 * self.carried:.5g} kN"))
            taken = 1e-3 * sum(force for _, force in self.supports) + 0.0
            rows.append(("loads carried by other supports", f"{taken:.5g} kN"))
            rows.append(("periods, fixed base", f"{periods} s"))
            rows.append(("period on the bearings", f"{self.isolated_period:.3g} s"))
        return [*rows, *self.motion]

    def _rows(self) -> list[tuple[str, ...]]:
        rows: list[tuple[str, ...]] = [
            (
                load.name,
                f"{1e-3 * load.axial_force:.4g} kN",
                f"{1e-6 * load.pressure:.3g} MPa",
                f"{1e3 * load.settlement:.2g} mm",
                f"{load.period:.3g} s",
                _held(load),
            )
            for load in self.bearings[:SHOWN]
        ]
        if len(self.bearings) > SHOWN:
            rows.append((f"and {len(self.bearings) - SHOWN} more", "", "", "", "", ""))
        return rows


_HEAD = (
    "bearing",
    "axial force",
    "pressure",
    "settlement",
    "pendulum",
    "stable limit of interface slip",
)


def _held(load: BearingLoad) -> str:
    if math.isinf(load.slip_stability):
        return "rigid slider"
    overlap = f"{1e3 * load.slip_capacity:.3g} mm"
    if load.slip_stability >= load.slip_capacity:
        return f"all {overlap}"
    return f"{1e3 * max(load.slip_stability, 0.0):.3g} of {overlap}"


def check_model(frame: FrameData, motion: GroundMotion | None = None) -> ModelCheck:
    """Sum up a model, and check it: `Frame.check`."""
    sanity_checks.refuse_extent(frame)
    system = assemble(frame)
    masses = system.node_mass[:, :3].sum(axis=0)
    totals = system.node_load.reshape(-1, 6)[:, :3].sum(axis=0)
    loads = totals.copy()
    loads[2] += system.gravity * masses[2]
    loads[np.abs(loads) < 1e-6 * np.abs(totals).max(initial=0.0)] = 0.0
    found = [*sanity_checks.sanity_warnings(frame)]
    for device in dict.fromkeys(link.bearing for link in frame.bearings.values()):
        found += device_doubts(device)
    if motion is not None:
        found += motion_doubts(frame, motion)
    failure, state, periods = "", None, np.zeros(0)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ModelWarning)  # they are among the doubts
            state = gravity(frame)
            if state.held_periods:
                count = min(len(state.held_periods), SHOWN_PERIODS)
                periods = modes(frame, count, bearings="fixed").periods
    except (AnalysisError, ModelError) as cause:
        failure = str(cause)
    return ModelCheck(
        name=frame.name,
        mass=float(masses.max()),
        weight=float(-totals[2]),
        loads=(float(loads[0]), float(loads[1]), float(loads[2])),
        carried=state.load_path.bearings if state else math.nan,
        supports=state.load_path.supports if state else (),
        periods=tuple(periods.tolist()),
        isolated_period=isolated_period(system, state.axial_forces) if state else math.nan,
        bearings=bearing_loads(system, state.axial_forces) if state else (),
        motion=tuple(motion.facts().items()) if motion is not None else (),
        doubts=(*found, *(state.doubts if state else ())),
        failure=failure,
    )
