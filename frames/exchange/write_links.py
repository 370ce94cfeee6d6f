"""Springs and bearings of a frame as SAP2000's tables of links."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from frames._errors import ModelError
from frames.exchange.geometry import frame_axes
from frames.exchange.pendulum_link import pendulum_link
from frames.statics.gravity import gravity

if TYPE_CHECKING:
    from frames.exchange.units import Units
    from frames.exchange.write_s2k_text import Tables, Value
    from frames.model.components import BearingLink
    from frames.model.frame_data import FrameData

_DOFS = ("U1", "U2", "U3", "R1", "R2", "R3")


class LinkWriter:
    """The tables of links.

    Parameters
    ----------
    frame : Frame
        The model.
    displacement : float or None
        Of the equivalent-linear analysis [m]; needed where there are bearings.
    units : Units
        Of the file.
    """

    def __init__(self, frame: FrameData, displacement: float | None, units: Units) -> None:
        self.frame, self.displacement, self.units = frame, displacement, units

    def tables(self) -> Tables:
        """Return their definitions, places and assignments."""
        found: Tables = {
            name: []
            for name in (
                "LINK PROPERTY DEFINITIONS 01 - GENERAL",
                "LINK PROPERTY DEFINITIONS 02 - LINEAR",
                "LINK PROPERTY DEFINITIONS 08 - SLIDING ISOLATOR",
                "CONNECTIVITY - LINK",
                "LINK PROPERTY ASSIGNMENTS",
            )
        }
        for spring in self.frame.springs.values():
            kind, prop = "Linear", f"K-{spring.name}"
            self._connect(found, spring.name, (spring.i, spring.j), kind, prop)
            self._spring(found, prop, spring.i, spring.j, spring.stiffness)
        if self.frame.bearings:
            state = gravity(self.frame)
            loads = dict(
                zip((b.name for b in state.system.bearings), state.axial_forces, strict=True)
            )
            for part in self.frame.bearings.values():
                self._bearing(found, part, float(loads[part.name]))
        return found

    def _connect(
        self, found: Tables, name: str, ends: tuple[str, str], kind: str, prop: str
    ) -> None:
        found["LINK PROPERTY DEFINITIONS 01 - GENERAL"].append(
            {"Link": prop, "LinkType": kind, "Mass": 0, "Weight": 0}
        )
        found["CONNECTIVITY - LINK"].append({"Link": name, "JointI": ends[0], "JointJ": ends[1]})
        row: dict[str, Value] = {"Link": name, "LinkType": kind, "LinkJoints": "TwoJoint"}
        found["LINK PROPERTY ASSIGNMENTS"].append(row | {"LinkProp": prop})

    def _spring(
        self, found: Tables, prop: str, i: str, j: str, stiffness: tuple[float, ...]
    ) -> None:
        ends = [np.array(self.frame.nodes[n].position) for n in (i, j)]
        upright = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
        apart = float(np.linalg.norm(ends[1] - ends[0])) > 1e-6
        axes = frame_axes(ends[0], ends[1]) if apart else upright
        if float(np.abs(axes).max(axis=1).min()) < 1.0 - 1e-9:
            message = (
                f'spring "{prop.removeprefix("K-")}" joins nodes that are apart across global '
                "axes, which a link in its own axes cannot be: join nodes along X, Y or Z"
            )
            raise ModelError(message)
        for k in range(6):
            axis = int(np.abs(axes[k % 3]).argmax())
            value = stiffness[axis + (3 if k >= 3 else 0)]
            word, unit = ("Trans", self.units.line) if k < 3 else ("Rot", self.units.moment)
            if value:
                row: dict[str, Value] = {"Link": prop, "DOF": _DOFS[k], "Fixed": False}
                row |= {f"{word}KE": value / unit, f"{word}CE": 0}
                found["LINK PROPERTY DEFINITIONS 02 - LINEAR"].append(row)

    def _bearing(self, found: Tables, part: BearingLink, load: float) -> None:
        assert self.displacement is not None  # noqa: S101  # refused before
        if load <= 0.0:
            message = (
                f'bearing "{part.name}" carries {load:g} N under the permanent loads: a link has '
                "no effective stiffness without a compression"
            )
            raise ModelError(message)
        link, units = pendulum_link(part.bearing, load, self.displacement), self.units
        prop = f"FP-{part.name}"
        self._connect(found, part.name, (part.i, part.j), "Friction Isolator", prop)
        rows = found["LINK PROPERTY DEFINITIONS 08 - SLIDING ISOLATOR"]
        rows.append(
            {
                "Link": prop,
                "DOF": "U1",
                "Fixed": False,
                "NonLinear": True,
                "TransKE": link.vertical / units.line,
                "TransCE": 0,
                "TransK": link.vertical / units.line,
                "TransC": 0,
            }
        )
        rows += [
            {
                "Link": prop,
                "DOF": dof,
                "Fixed": False,
                "NonLinear": True,
                "TransKE": link.effective / units.line,
                "TransCE": link.damping / units.line,
                "DJ": 0,
                "TransK": link.elastic / units.line,
                "Slow": link.slow,
                "Fast": link.fast,
                "Rate": link.rate * units.length,
                "Radius": link.radius / units.length,
            }
            for dof in ("U2", "U3")
        ]
