"""Links and hinges over a time history: labelled variables, forces, and peaks."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from frames.assembly.system import N_PLASTIC, WORK_DONE
from frames.kernels.hinges import place
from frames.model.components import hinge_name, hinged_ends
from frames.results.peak_response import Extreme, extreme_of, larger_of
from frames.results.recorded import require_recorded
from lir_element.results.dataset import labelled

if TYPE_CHECKING:
    import xarray as xr

    from frames._types import FloatArray
    from frames.assembly.system import NonlinearParts, System
    from frames.bundles.run_data import Output
    from frames.model.components import HingedEnd
    from frames.model.frame_data import FrameData
    from frames.statics.gravity_state import GravityState

HINGE_FORCES = ("N", "My", "Mz")
"""Forces on a hinge, in local axes of its member."""


def part_coordinates(found: NonlinearParts, frame: FrameData) -> dict[str, list[str]]:
    """Return the names of links and hinges."""
    coordinates: dict[str, list[str]] = {}
    if found.links:
        coordinates["link"] = [link.name for link in found.links]
    if found.hinged:
        coordinates["hinge"] = [hinge.name for hinge in hinged_ends(frame.hinges)]
        coordinates["hinge_force_component"] = list(HINGE_FORCES)
    return coordinates


def part_variables(
    found: NonlinearParts, frame: FrameData, out: Output, count: int
) -> dict[str, xr.Variable]:
    """Return the variables of links and hinges over the first `count` records."""
    variables = _link_variables(found, out, count) if found.links else {}
    if found.hinged:
        variables |= _hinge_variables(found, hinged_ends(frame.hinges), out, count)
    return variables


def _link_variables(found: NonlinearParts, out: Output, count: int) -> dict[str, xr.Variable]:
    n = len(found.links)
    d = out.deformation[:count, :n].copy()
    history = ("time", "link")
    limits = [getattr(link.law, "yield_deformation", np.nan) for link in found.links]
    return {
        "link_deformation": labelled(
            history,
            d,
            "m, rad",
            "deformation of the link; of dampers, tension-only elements and stops from gravity",
        ),
        "link_force": labelled(
            history, out.beyond[:count, :n] + found.elastic[:n] * d, "N, N m", "force of the link"
        ),
        "link_work": labelled(
            history,
            out.part_state[:count, :n, WORK_DONE].copy(),
            "J",
            "work the link took up: what yielding dissipates, and hardening or a wall stores",
        ),
        "link_yield_deformation": labelled(
            ("link",), np.array(limits), "m, rad", "deformation at first yield, NaN without"
        ),
    }


def _hinge_variables(
    found: NonlinearParts, hinges: list[HingedEnd], out: Output, count: int
) -> dict[str, xr.Variable]:
    order = {member: k for k, member in enumerate(found.hinged, start=len(found.links))}
    shape = (count, len(hinges), 3)
    force, plastic = np.zeros(shape), np.zeros(shape)
    turn, work = np.zeros(shape[:2]), np.zeros(shape[:2])
    for h, (_, member, end, _) in enumerate(hinges):
        k = order[member]
        at = slice(found.first[k], found.first[k + 1])
        stiffness = found.par[k, :25].reshape(5, 5)
        five = found.par[k, 25:30] + out.deformation[:count, at] @ stiffness
        five += out.beyond[:count, at]
        force[:, h] = five[:, _places(end)]
        plastic[:, h] = out.part_state[:count, k, 3 * end : 3 * end + 3]
        turn[:, h] = out.part_state[:count, k, N_PLASTIC + end]
        work[:, h] = out.part_state[:count, k, WORK_DONE + end]
    history = ("time", "hinge")
    return {
        "hinge_force": labelled(
            (*history, "hinge_force_component"), force, "N, N m", "N (tension +), My, Mz there"
        ),
        "hinge_rotation": labelled(
            (*history, "hinge_force_component"),
            plastic,
            "m, rad",
            "plastic elongation, and rotations about local y and z",
        ),
        "hinge_turn": labelled(
            history, turn, "rad", "plastic rotation run through since the start"
        ),
        "hinge_work": labelled(
            history, work, "J", "work the hinge took up, what hardening stores included"
        ),
        "hinge_moment": labelled(
            ("hinge", "hinge_force_component"),
            np.array([(each.axial, each.moment_y, each.moment_z) for *_, each in hinges]),
            "N, N m",
            "plastic forces of the hinge: axial from its centre, moments",
        ),
    }


def forces_beyond(system: System, data: xr.Dataset) -> FloatArray:
    """Return the forces of nonlinear parts beyond the elastic forces g, (time, m)."""
    found = system.parts
    beyond = np.zeros((data.sizes["time"], int(found.first[-1])))
    n = len(found.links)
    needed = ["link_deformation", "link_force"] if n else []
    needed += ["hinge_rotation"] if found.hinged else []
    require_recorded(data, "forces of a structure that yields", *needed)
    if n:
        d = data["link_deformation"].transpose("time", "link").to_numpy()
        force = data["link_force"].transpose("time", "link").to_numpy()
        beyond[:, :n] = force - found.elastic[:n] * d
    if found.hinged:
        plastic = data["hinge_rotation"].transpose("time", "hinge", ...).to_numpy()
        names = {str(name): h for h, name in enumerate(data["hinge"].to_numpy())}
        for k, member in enumerate(found.hinged, start=n):
            stiffness = found.par[k, :25].reshape(5, 5)
            for end in (0, 1):
                h = names.get(hinge_name(member, end))
                if h is not None:
                    columns = stiffness[:, _places(end)]
                    at = slice(found.first[k], found.first[k + 1])
                    beyond[:, at] -= plastic[:, h] @ columns.T
    return beyond


def _places(end: int) -> list[int]:
    # Places of N, My and Mz at an end among a member's five forces.
    return [place(end, part) for part in range(3)]


class NonlinearPeaks:
    """Peaks of nonlinear parts; empty for a structure without any."""

    def __init__(self, state: GravityState, model: FrameData) -> None:
        found = state.system.parts
        self._links = len(found.links)
        self._elastic = found.elastic[: self._links]
        limits = [getattr(link.law, "yield_deformation", np.nan) for link in found.links]
        self._yields = np.where(np.isfinite(limits), limits, np.inf)
        order = {member: k for k, member in enumerate(found.hinged, start=self._links)}
        ends = hinged_ends(model.hinges) if found.hinged else []
        self._hinges = [(order[member], end) for _, member, end, _ in ends]
        self._reached: dict[str, Extreme] = {}

    def take(self, out: Output, first: int, last: int) -> None:
        """Add rows first <= k < last of the recorded steps, which follow those before."""
        time = out.time[first:last]
        for name, values in self._histories(out, first, last).items():
            if len(time):
                now = extreme_of(values, time)
                before = self._reached.get(name)
                self._reached[name] = now if before is None else larger_of(before, now)

    def reached(self) -> dict[str, Extreme]:
        """Return the peaks by quantity."""
        return self._reached

    def left(self, out: Output, row: int) -> dict[str, FloatArray]:
        """Return the residual values at a row of the recorded steps, by quantity."""
        here = self._histories(out, row, row + 1)
        kept = ("link_deformation", "link_work", "hinge_rotation", "hinge_work")
        return {name: here[name][0] for name in kept if name in here}

    def _histories(self, out: Output, first: int, last: int) -> dict[str, FloatArray]:
        # As `part_variables` and frames.results.hinge_extremes form them.
        found: dict[str, FloatArray] = {}
        n, state = self._links, out.part_state[first:last]
        if n:
            d = out.deformation[first:last, :n]
            force = out.beyond[first:last, :n] + self._elastic * d
            found["link_ductility"] = np.where(d * force > 0.0, np.abs(d) / self._yields, 0.0)
            found["link_deformation"], found["link_force"] = np.abs(d), np.abs(force)
            found["link_reversal"], found["link_work"] = -force, state[:, :n, WORK_DONE]
        if self._hinges:
            part = np.array([k for k, _ in self._hinges])
            end = np.array([e for _, e in self._hinges])
            turns = [state[:, part, 3 * end + axis] for axis in (1, 2)]
            found["hinge_rotation"] = np.linalg.norm(np.stack(turns, axis=-1), axis=-1)
            found["hinge_turn"] = state[:, part, N_PLASTIC + end]
            found["hinge_work"] = state[:, part, WORK_DONE + end]
        return found
