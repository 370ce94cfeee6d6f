"""A structure on bearings with other parameters: fields of the bearing by name."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from frames.risk._errors import CampaignError
from lir_element.device.friction import CoulombFriction, VelocityFriction

if TYPE_CHECKING:
    from collections.abc import Mapping
    from typing import Any

    from frames.frame import Frame
    from lir_element import LIRBearing

FIELDS = (
    "radius",
    "slider_height",
    "slider_radius",
    "capacity",
    "interface_friction",
    "axial_stiffness",
    "axial_damping",
    "rim_stiffness",
    "rim_damping",
    "yield_displacement",
    "interface_yield_displacement",
)
"""Fields of `LIRBearing` that a sample may name: one number for both surfaces, SI."""

LAW = "f_max", "f_min", "rate"
"""Fields of `VelocityFriction` that a sample may name, for both surfaces."""


def with_parameters(frame: Frame, parameters: Mapping[str, float]) -> Frame:
    """Return a structure whose bearings all have the given parameters.

    Parameters
    ----------
    frame : Frame
        The structure.
    parameters : mapping of str to float
        `FIELDS` of its bearings; "friction", Coulomb's coefficient; of bearings with
        `VelocityFriction` also `LAW`. Rigid sliders (a plain DCFP) stay rigid.

    Returns
    -------
    Frame
        A copy.

    Raises
    ------
    CampaignError
        If a name is not known, or belongs to another law of friction.
    ModelError, ValueError
        If such a bearing cannot be, or does not fit.
    """
    devices = {name: _device(link.bearing, parameters) for name, link in frame.bearings.items()}
    return frame.with_bearings(devices)


def _device(bearing: LIRBearing, parameters: Mapping[str, float]) -> LIRBearing:
    changes: dict[str, Any] = {name: parameters[name] for name in FIELDS if name in parameters}
    law = {name: parameters[name] for name in LAW if name in parameters}
    unknown = parameters.keys() - changes.keys() - law.keys() - {"friction"}
    if unknown:
        msg = f'"{min(unknown)}" is no parameter: there are friction, {", ".join(FIELDS + LAW)}'
        raise CampaignError(msg)
    if bearing.is_dcfp:
        changes.pop("interface_friction", None)
    if "capacity" in changes:
        changes["rims"] = None
    if "friction" in parameters:
        changes["friction"] = CoulombFriction(parameters["friction"])
        if law:
            msg = f"friction and {', '.join(law)} are given: one is Coulomb's, the others are not"
            raise CampaignError(msg)
    elif law:
        given = [each for each in bearing.frictions if isinstance(each, VelocityFriction)]
        if len(given) < len(bearing.frictions):
            msg = f"{', '.join(law)}: the bearing has Coulomb's friction; give it VelocityFriction"
            raise CampaignError(msg)
        changes["friction"] = tuple(replace(each, **law) for each in given)
    return replace(bearing, **changes)
