"""Loads on a frame: of areas that are no shells to the members around each panel, or to corners."""

from __future__ import annotations

import math
from copy import copy
from typing import TYPE_CHECKING

import numpy as np

from frames._errors import ModelError
from frames.exchange.building import AreaLoad, JointLoad, LineLoad
from frames.exchange.geometry import Levels, area_normal
from frames.exchange.loads import OWN_MASS, own_loads
from frames.exchange.members import add_line_load
from frames.model.axes import area_of, corners_of, faces_of
from frames.model.components import FloorLoad
from frames.model.floors import floor_panel, members_at, panel_loads
from lir_element.elevations import SAME_PLACE

if TYPE_CHECKING:
    from collections.abc import Mapping

    from frames._types import FloatArray
    from frames.exchange.building import AreaObject, Building
    from frames.exchange.geometry import SplitMember
    from frames.exchange.mesh import Mesh
    from frames.frame import Frame
    from frames.model.floors import PanelLoads


_PANEL = "panel"


def corner_shares(points: FloatArray) -> FloatArray:
    """Return the share of each corner of a polygon in a uniform load (n,) [-].

    The polygon is cut into triangles from each corner in turn, a third of each goes to each of its
    corners, and the mean is the result: force and moments are those of the load.

    Shapes: points (n, 3), result (n,).
    """
    count = len(points)
    normal, area = area_normal(points)
    shares = np.zeros(count)
    triangles = [
        (first, (first + k) % count, (first + k + 1) % count)
        for first in range(count)
        for k in range(1, count - 1)
    ]
    a, b, c = np.moveaxis(points[np.array(triangles)], 1, 0)
    sizes = 0.5 * np.cross(b - a, c - a) @ normal
    np.add.at(shares, np.array(triangles), (sizes / (3.0 * area * count))[:, None])
    return shares


class Slabs:
    """Distributes loads on horizontal areas to the members that run along their panels.

    A slab is cut into panels along the members within it. A panel gives its load to the members
    along its edges, each point to the nearest edge, or in one direction. If members are missing
    along a carrying edge, the corners of the area get it. The frame has all members.
    """

    def __init__(self, frame: Frame, building: Building) -> None:
        self.frame, self.building = frame, building
        self._around = members_at(frame.members)
        self._beside = _along_horizontal(frame)
        self._joined = Levels({name: frame.nodes[name].position for name in self._beside})
        self._unit: dict[str, list[PanelLoads] | None] = {}
        self.at_corners: dict[str, None] = {}  # in the order of the loads

    def onto(self, frame: Frame) -> Slabs:
        """Return slabs that put loads on a copy of the frame, their panels found once for both."""
        found = copy(self)
        found.frame, found.at_corners = frame, {}
        return found

    def add(self, area: AreaObject, load: FloatArray, case: str) -> None:
        """Add a load on an area.

        Shapes: load (3,).
        """
        down = -float(load[2])
        if down > 0.0 and not load[:2].any():
            parts = self._panels(area)
            if parts is not None:
                for part in parts:
                    self._put(part, down, case)
                return
        points = self._points(area)
        _, size = area_normal(points)
        self.at_corners[area.name] = None
        for joint, share in zip(area.joints, corner_shares(points), strict=True):
            force = share * size * load
            self.frame.add_load(joint, [*force.tolist(), 0.0, 0.0, 0.0], case=case)

    def _points(self, area: AreaObject) -> FloatArray:
        return np.array([self.frame.nodes[name].position for name in area.joints])

    def _put(self, part: PanelLoads, size: float, case: str) -> None:
        for member, load in part.members:
            self.frame._put_on_member(member, load.scaled(size, case))
        for node, forces in part.nodes:
            self.frame.add_load(node, (size * forces).tolist(), case=case)

    def _panels(self, area: AreaObject) -> list[PanelLoads] | None:
        if area.name not in self._unit:
            self._unit[area.name] = self._unit_loads(area)
        return self._unit[area.name]

    def _unit_loads(self, area: AreaObject) -> list[PanelLoads] | None:
        points = self._points(area)
        if np.ptp(points[:, 2]) > SAME_PLACE:
            return None
        section = self.building.area_sections.get(area.section)
        span = None
        if section is not None and section.one_way:
            turn = math.radians(area.angle)
            span = (math.cos(turn), math.sin(turn))
        found = []
        for corners in self._faces(area, points):
            try:
                chosen, way = floor_panel(self.frame.nodes, area.name, corners, span)
                load = FloorLoad(_PANEL, chosen, 1.0, way, None, _PANEL)
                found.append(panel_loads(self.frame.nodes, self._around, load))
            except ModelError:  # no members along its edges, or not convex: to the corners
                return None
        return found

    def _faces(self, area: AreaObject, points: FloatArray) -> list[tuple[str, ...]]:
        # Panels between the members within the area; the area itself if they do not fill it.
        plan = self._joined.within(points)
        links = {name: [o for o in self._beside[name] if o in plan] for name in plan}
        faces = faces_of(plan, links)
        whole = area_normal(points)[1]
        size = sum(area_of(plan, face) for face in faces)
        if len(faces) < 2 or abs(size - whole) > 1e-6 * whole:
            return [area.joints]
        return [corners_of(plan, face) for face in faces]


def _along_horizontal(frame: Frame) -> dict[str, list[str]]:
    # Nodes and their neighbours along horizontal members.
    found: dict[str, list[str]] = {}
    for member in frame.members.values():
        first, last = frame.nodes[member.i], frame.nodes[member.j]
        if abs(first.z - last.z) <= SAME_PLACE:
            found.setdefault(member.i, []).append(member.j)
            found.setdefault(member.j, []).append(member.i)
    return found


class Loading:
    """Puts loads of patterns on a frame; those of shells go to their nodes."""

    def __init__(self, building: Building, divided: Mapping[str, SplitMember], mesh: Mesh) -> None:
        self.building, self.divided, self.mesh = building, divided, mesh
        self._elements = mesh.by_area()
        self._corners: dict[str, list[tuple[str, float]]] = {}  # nodes and areas [m2] of shells

    def put(
        self, frame: Frame, slabs: Slabs, factors: Mapping[str, tuple[float, str]], own: bool
    ) -> None:
        """Add the loads of patterns to a frame."""
        building = self.building
        loads: list[LineLoad | AreaLoad | JointLoad] = [
            *building.line_loads,
            *building.area_loads,
            *building.joint_loads,
        ]
        chosen = dict(factors)
        for name, pattern in building.patterns.items():
            factor = pattern.self_weight
            if name in chosen and factor:
                loads += [_times(load, factor) for load in own_loads(building, name)]
        if own:
            loads += own_loads(building, OWN_MASS, frame.gravity)
            chosen[OWN_MASS] = (1.0, OWN_MASS)
        for k, load in enumerate(loads):
            building.account.doing(f"{k} of {len(loads)} loads")
            factor, case = chosen.get(load.pattern, (0.0, ""))
            if not factor:
                continue
            if isinstance(load, LineLoad):
                if any(load.start) or any(load.end):
                    add_line_load(frame, self.divided[load.frame], load, factor, case)
            elif isinstance(load, JointLoad):
                if any(load.forces):
                    frame.add_load(load.joint, [factor * v for v in load.forces], case=case)
            elif any(load.load):
                self._on_area(frame, slabs, load, factor, case)

    def _on_area(
        self, frame: Frame, slabs: Slabs, load: AreaLoad, factor: float, case: str
    ) -> None:
        vector = factor * np.array(load.load)
        if load.area not in self._elements:
            slabs.add(self.building.areas[load.area], vector, case)
            return
        if load.area not in self._corners:
            found: list[tuple[str, float]] = []
            self._corners[load.area] = found
            for nodes in self._elements[load.area]:
                points = np.array([frame.nodes[name].position for name in nodes])
                found += zip(nodes, corner_shares(points) * area_normal(points)[1], strict=True)
        for node, size in self._corners[load.area]:
            frame.add_load(node, [*(size * vector).tolist(), 0.0, 0.0, 0.0], case=case)


def _times(load: LineLoad | AreaLoad | JointLoad, factor: float) -> LineLoad | AreaLoad | JointLoad:
    def scaled(vector: tuple[float, float, float]) -> tuple[float, float, float]:
        x, y, z = vector
        return (factor * x, factor * y, factor * z)

    if isinstance(load, JointLoad):
        return JointLoad(load.joint, load.pattern, tuple(factor * v for v in load.forces))
    if isinstance(load, AreaLoad):
        return AreaLoad(load.area, load.pattern, scaled(load.load))
    start, end = scaled(load.start), scaled(load.end)
    return LineLoad(load.frame, load.pattern, load.a, load.b, start, end, load.point)
