"""Loads of a building: pressures on the fields of its floors, facades, masses off the middle."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames._errors import ModelError
from frames.library.building_plan import level_name
from frames.model.load_combinations import applied_loads, load_masses
from frames.model.plane_faces import fields_of

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.frame import Frame
    from frames.model.floors import Span

FACADE = "D"
"""Load case of facades."""


class Pressures(NamedTuple):
    """Loads of a building's floors, downwards."""

    # load by load case [N/m2], >= 0, of fields with a floor above, of those without, and of the
    # same at the base
    floors: Mapping[str, float]
    # load by load case [N/m2], >= 0, of fields with a floor above, of those without, and of the
    # same at the base
    roof: Mapping[str, float]
    # load by load case [N/m2], >= 0, of fields with a floor above, of those without, and of the
    # same at the base
    base: Mapping[str, float]
    # load by load case [N/m2], >= 0, of fields with a floor above, of those without, and of the
    # same at the base
    open_base: Mapping[str, float]
    facade: float = 0.0  # along the outer edges of every floor above the base [N/m], >= 0

    def of_field(self, level: int, *, covered: bool) -> Mapping[str, float]:
        """Return the loads of a field at a level, with a floor above it or without."""
        if level == 0:
            return self.base if covered else self.open_base
        return self.floors if covered else self.roof


def load_floors(
    frame: Frame,
    edges: Sequence[list[tuple[str, str]]],
    pressures: Pressures,
    span: Span | None = None,
) -> None:
    """Put loads on the floors of a building: on each field that beams enclose."""
    points = {name: (node.x, node.y) for name, node in frame.nodes.items()}
    levels = [fields_of(points, own, level_name(k)) for k, own in enumerate(edges)]
    members = {frozenset((m.i, m.j)): key for key, m in frame.members.items()}
    for level, found in enumerate(levels):
        name = level_name(level)
        if not found.corners:
            msg = f"{name}: its beams enclose no field that a load could lie on: add some around it"
            raise ModelError(msg)
        above = [_outline(points, each) for other in levels[level + 1 :] for each in other.corners]
        for k, corners in enumerate(found.corners):
            middle = _outline(points, corners).mean(axis=0)
            covered = any(_inside(middle, outline) for outline in above)
            for case, pressure in pressures.of_field(level, covered=covered).items():
                if pressure > 0.0:
                    panel = f"{case}-{name}-{k + 1}"
                    frame.add_floor_load(panel, corners, pressure, span=span, case=case)
        if pressures.facade > 0.0 and level > 0:
            load = (0.0, 0.0, -pressures.facade)
            for edge in found.outer:
                frame.add_uniform_load(members[frozenset(edge)], load, case=FACADE)


def _outline(points: Mapping[str, tuple[float, float]], corners: Sequence[str]) -> FloatArray:
    return np.array([points[node] for node in corners])


def _inside(place: FloatArray, outline: FloatArray) -> bool:
    # Whether a place is inside of a convex outline that runs anticlockwise.
    along, to = np.roll(outline, -1, axis=0) - outline, place - outline
    return bool((along[:, 0] * to[:, 1] - along[:, 1] * to[:, 0] > 0.0).all())


def move_loads(frame: Frame, eccentricity: tuple[float, float]) -> None:
    """Move the centre of the loads of each level, case by case, by forces on its nodes.

    The loads of the nodes rise linearly towards where the centre goes; their sum stays.
    """
    if not any(eccentricity):
        return
    added: list[tuple[str, float, str]] = []
    for case in frame.load_cases:
        weights = _node_loads(frame, case)
        for level in frame.levels:
            own = {node: weights[node] for node in level.nodes if weights.get(node, 0.0) > 0.0}
            if own:
                added += [
                    (node, more, case) for node, more in _tilted(frame, own, eccentricity).items()
                ]
    for node, more, case in added:
        frame.add_load(node, (0.0, 0.0, -more, 0.0, 0.0, 0.0), case=case)


def _node_loads(frame: Frame, case: str) -> dict[str, float]:
    # What the loads of a case weigh at each node, by the rule of the lever [N].
    alone = frame.copy()
    alone.set_mass_source({case: 1.0})
    masses = load_masses(alone, applied_loads(alone))
    return {node: mass * frame.gravity for node, mass in masses.items()}


def _tilted(
    frame: Frame, own: Mapping[str, float], eccentricity: tuple[float, float]
) -> dict[str, float]:
    places = np.array([frame.nodes[node].position[:2] for node in own])
    weights = np.array(list(own.values()))
    sides = np.ptp(places, axis=0)
    apart = places - weights @ places / weights.sum()
    spread: FloatArray = (apart * weights[:, None]).T @ apart
    wanted = weights.sum() * np.array(eccentricity) * sides
    slope, *_ = np.linalg.lstsq(spread, wanted, rcond=1e-12)
    tilt = apart @ slope
    if tilt.min() < -1.0:
        msg = (
            f"eccentricity = {list(eccentricity)} would leave columns at one edge without load: "
            "give smaller ones (codes ask for 0.05)"
        )
        raise ModelError(msg)
    return dict(zip(own, (weights * tilt).tolist(), strict=True))


def add_base_inertia(frame: Frame, depth: float) -> None:
    """Give the nodes above the bearings the rotary inertia of their mass over a depth."""
    masses = load_masses(frame, applied_loads(frame))
    for link in frame.bearings.values():
        inertia = masses.get(link.j, 0.0) * depth**2 / 12.0
        frame.add_mass(link.j, 0.0, (inertia, inertia, 0.0))
