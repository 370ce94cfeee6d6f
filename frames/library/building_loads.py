"""Loads of a building: pressures on the fields of its floors, facades, masses off the middle."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames._errors import ModelError
from frames.library.building_plan import level_name
from frames.library.floor_fields import fields_of
from frames.model.applied_loads import applied_loads, load_masses

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.frame import Frame
    from frames.model.panels import Span

FACADE = "D"
"""Load case of facades."""


class FloorPressures(NamedTuple):
    """Loads on the floor of a level.

    Attributes
    ----------
    by_case : mapping of str to float
        Load of the whole floor by load case, downwards [N/m2], >= 0.
    facade : float
        Along the outer edges [N/m], >= 0.
    """

    by_case: Mapping[str, float]
    facade: float = 0.0


def load_floor(
    frame: Frame,
    level: int,
    beams: list[tuple[str, str]],
    pressures: FloorPressures,
    span: Span | None = None,
) -> float:
    """Put loads on the floor of a level: on each field that beams enclose.

    Parameters
    ----------
    frame : Frame
        The building; it is changed.
    level : int
        0 is the base.
    beams : list of (str, str)
        Beams of the level, from node to node.
    pressures : FloorPressures
        The loads.
    span : {None, "x", "y"}
        As in `Frame.add_floor_load`.

    Returns
    -------
    float
        Area of the floor [m2].

    Raises
    ------
    ModelError
        If no field is enclosed, one is not convex, or beams cross.
    """
    name = level_name(level)
    points = {node: frame.nodes[node].position[:2] for beam in beams for node in beam}
    found = fields_of(points, beams, name)
    if not found.corners:
        msg = f"{name}: its beams enclose no field that a load could lie on: add beams around it"
        raise ModelError(msg)
    for k, corners in enumerate(found.corners):
        for case, pressure in pressures.by_case.items():
            if pressure > 0.0:
                panel = f"{case}-{name}-{k + 1}"
                frame.add_floor_load(panel, corners, pressure, span=span, case=case)
    if pressures.facade > 0.0:
        members = {frozenset((m.i, m.j)): key for key, m in frame.members.items()}
        for edge in found.outer:
            load = (0.0, 0.0, -pressures.facade)
            frame.add_uniform_load(members[frozenset(edge)], load, case=FACADE)
    return sum(_area([points[node] for node in corners]) for corners in found.corners)


def _area(corners: list[tuple[float, float]]) -> float:
    x, y = np.array(corners).T
    return float(0.5 * (x @ np.roll(y, -1) - y @ np.roll(x, -1)))


def move_loads(frame: Frame, eccentricity: tuple[float, float]) -> None:
    """Move the centre of the loads of each level, case by case, by forces on its nodes.

    The loads of the nodes rise linearly towards where the centre goes; their sum stays.

    Parameters
    ----------
    frame : Frame
        A building whose loads are all vertical; it is changed.
    eccentricity : (float, float)
        How far along x and y, over the sides of the plan of the level [-].

    Raises
    ------
    ModelError
        If a node would be left without load.
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
    """Give the nodes above the bearings the rotary inertia of their mass over a depth.

    Parameters
    ----------
    frame : Frame
        The building with its loads and its mass source; it is changed.
    depth : float
        Depth of base beams with their slab [m]: about x and y nodes get m depth^2 / 12.
    """
    masses = load_masses(frame, applied_loads(frame))
    for link in frame.bearings.values():
        inertia = masses.get(link.j, 0.0) * depth**2 / 12.0
        frame.add_mass(link.j, 0.0, (inertia, inertia, 0.0))
