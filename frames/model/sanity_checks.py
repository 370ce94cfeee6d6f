"""Plausibility of a frame's numbers, before any computation.

The bounds are wide: models at a twentieth of the scale, towers, bridges and rigid links of any
section pass without a warning. Values beyond them are probably in another unit.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from frames._errors import ModelError
from lir_element.texts import worded
from lir_element.units import meant

if TYPE_CHECKING:
    from frames.model.frame_data import FrameData

TALLEST, WIDEST = 1000.0, 50e3
"""Extent along z, and in plan, that no structure on bearings has [m]."""

SOFTEST, LARGEST_AREA = 3e8, 50.0
"""Elastic modulus [Pa] below which a member is softer than any plastic, unless its area [m2] shows
that it represents a stiffness.
"""

LIGHTEST = 20.0
"""Density of the lightest material of members [kg/m3]; 0 leaves their mass out."""

LIGHTEST_FLOOR = 30.0
"""Load of a floor panel, below which it may be in kN/m2 [N/m2]."""

USUAL_GRAVITY = (8.5, 11.5)
"""Acceleration of gravity on the ground [m/s2]."""

SLENDEREST, STOUTEST = 600.0, 8.0
"""Length over radius of gyration, and radius of gyration over length, that half of the members of
a frame do not exceed [-]."""


def refuse_extent(frame: FrameData) -> None:
    """Refuse coordinates that no structure has."""
    if not frame.nodes:
        return
    places = np.array([node.position for node in frame.nodes.values()])
    spans = np.ptp(places, axis=0)
    for words, span, bound in (
        ("high", float(spans[2]), TALLEST),
        ("wide", float(spans[:2].max()), WIDEST),
    ):
        if span > bound:
            message = (
                f'frame "{frame.name}" is {span:g} m {words}, at most {bound:g} m: '
                f"{meant(span, 'm', 0.05, 0.5 * bound)}"
            )
            raise ModelError(message)


def sanity_warnings(frame: FrameData) -> tuple[str, ...]:
    """Return the unusual values of a frame, a sentence each; nothing for usual ones."""
    return (
        *_of_gravity(frame),
        *_of_members(frame),
        *_of_sections(frame),
        *_of_floors(frame),
        *_of_mass_source(frame),
    )


def _of_gravity(frame: FrameData) -> list[str]:
    g = frame.gravity
    if g <= 0.0 or USUAL_GRAVITY[0] <= g <= USUAL_GRAVITY[1]:
        return []
    hint = meant(g, "m/s2", *USUAL_GRAVITY)
    return [
        worded(
            "gravity = {g:g} m/s2 is not the Earth's: {hint} if that is not meant", g=g, hint=hint
        )
    ]


def _of_members(frame: FrameData) -> list[str]:
    ratios, nodes = [], frame.nodes
    for member in frame.members.values():
        length = math.dist(nodes[member.i].position, nodes[member.j].position)
        section = member.section
        inertia = min(section.inertia_y, section.inertia_z)
        ratios.append(length / math.sqrt(inertia / section.area))
    if not ratios:
        return []
    middle = float(np.median(ratios))
    first = next(iter(frame.members))
    if middle > SLENDEREST:
        return [
            worded(
                "half of the members are longer than {middle:.3g} radii of gyration "
                '(member "{first}": {ratios:.3g}): give coordinates and sections in m, m2 '
                "and m4 (are the coordinates in mm or cm?)",
                middle=middle,
                first=first,
                ratios=ratios[0],
            )
        ]
    if middle < 1.0 / STOUTEST:
        return [
            worded(
                "half of the members are shorter than {middle:.2g} of their radius of gyration "
                '(member "{first}": {ratios:.2g}): give coordinates and sections in m, m2 and m4 '
                "(are the sections in mm or cm?)",
                middle=middle,
                first=first,
                ratios=ratios[0],
            )
        ]
    return []


def _of_sections(frame: FrameData) -> list[str]:
    found = []
    for section in dict.fromkeys(member.section for member in frame.members.values()):
        modulus, density = section.elastic_modulus, section.density
        if modulus < SOFTEST and section.area < LARGEST_AREA:
            hint = meant(modulus, "Pa", 1e9, 5e11)
            found.append(
                worded(
                    "a section's elastic_modulus = {modulus:g} Pa is softer than plastic: {hint}",
                    modulus=modulus,
                    hint=hint,
                )
            )
        if 0.0 < density < LIGHTEST:
            hint = meant(density, "kg/m3", 100.0, 2e4)
            found.append(
                worded(
                    "a section's density = {density:g} kg/m3 is lighter than cork: {hint}",
                    density=density,
                    hint=hint,
                )
            )
    return found


def _of_floors(frame: FrameData) -> list[str]:
    light = [load for load in frame.floor_loads.values() if 0.0 < load.q < LIGHTEST_FLOOR]
    if not light:
        return []
    load = light[0]
    return [
        worded(
            'floor load "{name}" has {load:g} N/m2, less than snow or sheeting: {hint}',
            name=load.name,
            load=load.q,
            hint=meant(load.q, "N/m2", 300.0, 5e4),
        )
    ]


def _of_mass_source(frame: FrameData) -> list[str]:
    cases = frame.load_cases
    empty = [name for name, share in frame.mass_source.items() if share and name not in cases]
    if not empty:
        return []
    return [
        worded(
            'set_mass_source: load case "{name}" has no loads, so it adds no mass; the '
            "cases are {cases}",
            name=empty[0],
            cases=", ".join(cases) or "no load cases",
        )
    ]
