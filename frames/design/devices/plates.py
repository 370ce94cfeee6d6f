"""Plates and rims of a bearing, which its model does not contain, and the bearing's weight."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from scipy.optimize import brentq

from frames.results.bearing_geometry import (
    AT_REST,
    Plates,
    outlines,
    rim_face,
    rim_height,
    slider_edge,
    turned_volume,
)
from lir_element import ring_strength
from lir_element.argument_checks import as_pair
from lir_element.device.sliders import slider_record

if TYPE_CHECKING:
    from frames.design.devices.limits import DesignLimits
    from lir_element import LIRBearing

YIELD_STRESS = 345e6
"""Yield stress of the steel of plates and rims, for their default proportions [Pa]."""

PLATE_SHARE = 0.04
"""Default thickness of a plate at its vertex over its diameter."""

_STEP = 0.005  # m, step to which proportioned lengths are rounded up
_THICKEST = 2.0  # m


class Make(NamedTuple):
    """A bearing as it is made; missing dimensions are proportioned."""

    plates: Plates
    diameters: tuple[float, float]  # of the bottom and the top plate [m]
    height: float  # of the whole bearing, at rest [m]
    sliders: float  # mass of both sliders [kg]
    mass: float  # of the bearing without anchors and masonry plates [kg]
    reach: float  # half the width of surfaces without rims [m]
    proposed: tuple[str, ...]  # dimensions proportioned here, in words


def made(
    bearing: LIRBearing,
    limits: DesignLimits,
    *,
    displacement: float,
    rim_force: float = 0.0,
    rim_width: float = 0.0,
) -> Make:
    """Return a bearing as it is made.

    Rims have the width `rim_width`, and the strength of the limits, else for the largest rim force
    of the runs [N]. Thicknesses are the bearing's, else a share of the diameter. Surfaces without
    rims are as wide as the displacement needs [m].
    """
    has_rims = all(map(math.isfinite, bearing.rim_displacement))
    reach = _reach(bearing, displacement)
    faces = [rim_face(bearing, k) if has_rims else reach for k in (0, 1)]
    height = (limits.rim_height or rim_height(bearing)) if has_rims else 0.0
    strength = limits.rim_strength or rim_force
    needed = _wall(bearing, height, strength) if height > 0.0 and strength > 0.0 else 0.0
    wall = max(rim_width, needed) if has_rims else 0.0
    diameters = 2.0 * (faces[0] + wall), 2.0 * (faces[1] + wall)
    given = as_pair("plate_thickness", bearing.plate_thickness)
    proposal = _rounded(PLATE_SHARE * max(diameters))
    thickness = float(given[0] or proposal), float(given[1] or proposal)
    plates = Plates(thickness, wall, height)
    proposals = {
        "thickness of the plates": not all(given),
        "width of the rims": has_rims,
        "height of the rims": has_rims and limits.rim_height is None,
    }
    bodies = outlines(bearing, AT_REST, reach, plates)
    sliders = float(slider_record(bearing)["mass"].sum())
    volume = sum(turned_volume(bodies[name]) for name in ("bottom plate", "top plate"))
    return Make(
        plates=plates,
        diameters=diameters,
        height=sum(thickness) + bearing.slider_height,
        sliders=sliders,
        mass=sliders + bearing.slider_density * volume,
        reach=reach,
        proposed=tuple(name for name, is_own in proposals.items() if is_own),
    )


def _reach(bearing: LIRBearing, displacement: float) -> float:
    # Half the width that a slider covers whose bearing goes as far as a displacement.
    turn = math.asin(min(displacement / bearing.effective_radius, 1.0))
    return min(max(slider_edge(bearing, k, turn) for k in (0, 1)), 0.95 * min(bearing.radii))


def _wall(bearing: LIRBearing, height: float, strength: float) -> float:
    # By `ring_strength`: the slider presses over its radius, which spreads to the foot at 45
    # degrees to both sides.
    arc = bearing.slider_radius + 2.0 * height

    def lacking(thickness: float) -> float:
        kept = ring_strength(thickness=thickness, height=height, arc=arc, yield_stress=YIELD_STRESS)
        return kept - strength

    reached = lacking(_THICKEST) >= 0.0
    return _rounded(float(brentq(lacking, 1e-6, _THICKEST))) if reached else _THICKEST


def _rounded(length: float) -> float:
    return _STEP * math.ceil(length / _STEP - 1e-9)
