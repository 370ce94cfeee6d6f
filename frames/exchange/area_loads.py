"""Own weights, own masses and loads of areas and frame objects, put on a frame."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from frames.exchange.building import AreaLoad, JointLoad, LineLoad
from frames.exchange.geometry import area_normal
from frames.exchange.loads import area_weight, frame_weight
from frames.exchange.members import add_line_load
from frames.exchange.slabs import corner_shares

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from frames.exchange.building import Building
    from frames.exchange.mesh import Mesh
    from frames.exchange.slabs import Slabs
    from frames.exchange.stations import Divided
    from frames.model.editing import FrameEditor

OWN_MASS = "own mass"
"""Name of the case that stands for the mass of elements."""


def own_weights(building: Building, pattern: str) -> Iterator[LineLoad | AreaLoad | JointLoad]:
    """Yield the own weight of all elements as a load of a pattern."""
    yield from _link_loads(building, pattern, 0.0)
    for name in building.frames:
        down = (0.0, 0.0, -frame_weight(building, name))
        yield LineLoad(name, pattern, 0.0, 1.0, down, down)
    for name in building.areas:
        yield AreaLoad(name, pattern, (0.0, 0.0, -area_weight(building, name)))


def own_masses(building: Building, gravity: float) -> Iterator[LineLoad | AreaLoad | JointLoad]:
    """Yield the own mass of all elements times gravity, as loads of the case `OWN_MASS`."""
    yield from _link_loads(building, OWN_MASS, gravity)
    for name, given in building.frames.items():
        section = building.sections[given.section]
        matter = building.materials[given.material or section.material]
        factor = section.modifiers.times(given.modifiers).mass
        down = (0.0, 0.0, -gravity * matter.density * section.area * factor)
        yield LineLoad(name, OWN_MASS, 0.0, 1.0, down, down)
    for name, area in building.areas.items():
        found = building.area_sections.get(area.section)
        if found is None or found.kind == "none":
            continue
        matter = building.materials[found.material]
        own = gravity * matter.density * found.thickness + found.extra_weight
        yield AreaLoad(name, OWN_MASS, (0.0, 0.0, -own * found.mass * area.mass))


def _link_loads(building: Building, pattern: str, gravity: float) -> Iterator[JointLoad]:
    # Half of what a link weighs at each of its joints, the other half of one with a single joint
    # in the ground. Source: CSI Analysis Reference Manual, "The Link/Support Element", mass.
    for link in building.links.values():
        prop = building.link_properties[link.property]
        half = 0.5 * (gravity * prop.mass if gravity else prop.weight)
        for joint in (link.i, link.j):
            if half and joint is not None:
                yield JointLoad(joint, pattern, (0.0, 0.0, -half, 0.0, 0.0, 0.0))


class Loading:
    """Puts loads of patterns on a frame.

    Parameters
    ----------
    building : Building
        With the loads.
    divided : dict of str to Divided
        Frame objects.
    mesh : Mesh
        Shells: their loads go to their nodes.
    """

    def __init__(self, building: Building, divided: Mapping[str, Divided], mesh: Mesh) -> None:
        self.building, self.divided, self.mesh = building, divided, mesh
        self._shells = {area for area, _ in mesh.elements}
        self._elements: dict[str, list[tuple[str, ...]]] = {}
        for area, nodes in mesh.elements:
            self._elements.setdefault(area, []).append(nodes)

    def put(
        self, frame: FrameEditor, slabs: Slabs, factors: Mapping[str, tuple[float, str]], own: bool
    ) -> None:
        """Put the loads of patterns on a frame."""
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
                loads += [_times(load, factor) for load in own_weights(building, name)]
        if own:
            loads += list(own_masses(building, frame.gravity))
            chosen[OWN_MASS] = (1.0, OWN_MASS)
        for load in loads:
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
        self, frame: FrameEditor, slabs: Slabs, load: AreaLoad, factor: float, case: str
    ) -> None:
        vector = factor * np.array(load.load)
        if load.area not in self._shells:
            slabs.add(self.building.areas[load.area], vector, case)
            return
        for nodes in self._elements[load.area]:
            points = np.array([frame.nodes[name].position for name in nodes])
            _, size = area_normal(points)
            for node, share in zip(nodes, corner_shares(points), strict=True):
                frame.add_load(node, [*(share * size * vector).tolist(), 0.0, 0.0, 0.0], case=case)


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
