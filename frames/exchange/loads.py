"""Own weights, loads and combinations of a building, for any source program."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from frames.exchange.building import AreaLoad, JointLoad, LineLoad, MassSource
from frames.exchange.fields import values
from frames.exchange.geometry import area_normal, direction_of, frame_axes, is_within
from lir_element.elevations import SAME_PLACE

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping
    from typing import Any

    from frames._types import FloatArray
    from frames.exchange.building import Building, Vector
    from frames.exchange.fields import Fields
    from frames.exchange.tables import Row


def vector_of(values: FloatArray) -> Vector:
    """Return three components as a tuple.

    Shapes: values (3,).
    """
    x, y, z = values.tolist()
    return (x, y, z)


def add_line_load(
    row: Row,
    building: Building,
    frame: str,
    pattern: str,
    way: str,
    start: float,
    end: float,
    a: float = 0.0,
    b: float = 1.0,
    *,
    point: bool = False,
    absolute: bool = False,
) -> None:
    """Add a load along a frame object, or a force on it, between two places.

    These are shares of its length, or of `absolute` ones distances.
    """
    given = building.frames[frame]
    first, last = (building.joints[name].position for name in (given.i, given.j))
    axes = frame_axes(first, last, given.angle)
    found = direction_of(way, axes)
    if found is None:
        msg = f'direction "{way}" of frame "{frame}" must be Gravity, X, Y, Z, 1, 2 or 3'
        raise row.error(msg)
    vector, projected = found
    if absolute:
        length = float(np.linalg.norm(np.subtract(last, first)))
        a, b = a / length, b / length
    if a == b and not point:
        return  # a part without length, as ETABS writes those that are left free
    if not -1e-9 <= a <= b <= 1.0 + 1e-6:
        msg = f'a load from {a:g} to {b:g} of the length of frame "{frame}" is not on it'
        raise row.error(msg)
    is_less = projected and not point
    factor = float(np.linalg.norm(np.cross(axes[0], vector))) if is_less else 1.0
    first, last = (vector_of(factor * size * vector) for size in (start, end))
    load = LineLoad(frame, pattern, max(a, 0.0), min(b, 1.0), first, last, point)
    building.line_loads.append(load)


class LevelAreas:
    """The level areas of a building, which carry loads of lines that have no section."""

    _PARTS = 40  # of a load, each of which goes to the area under it

    def __init__(self, building: Building) -> None:
        self._building = building
        self._areas: list[tuple[str, float, FloatArray, float]] = []
        for name, area in building.areas.items():
            points = np.array([building.joints[joint].position for joint in area.joints])
            if np.ptp(points[:, 2]) <= SAME_PLACE:
                self._areas.append((name, points[0, 2], points[:, :2], area_normal(points)[1]))

    def spread(
        self,
        ends: tuple[str, str],
        pattern: str,
        way: str,
        start: float,
        end: float,
        a: float = 0.0,
        b: float = 1.0,
        *,
        point: bool = False,
    ) -> bool:
        """Spread a load along a line over the areas under it; return whether they carry all."""
        first, last = (np.array(self._building.joints[joint].position) for joint in ends)
        if not way.strip().upper().startswith("GRAV") or abs(last[2] - first[2]) > SAME_PLACE:
            return False
        count = 1 if point else self._PARTS
        length = 1.0 if point else (b - a) * float(np.linalg.norm(last - first)) / count
        found: dict[str, float] = {}
        for share in (np.arange(count) + 0.5) / count:
            place = first + (a + share * (b - a)) * (last - first)
            under = self._under(place)
            if under is None:
                return False
            name, size = under
            force = (start + share * (end - start)) * length
            found[name] = found.get(name, 0.0) + force / size
        for name, pressure in found.items():
            self._building.area_loads.append(AreaLoad(name, pattern, (0.0, 0.0, -pressure)))
        return True

    def _under(self, place: FloatArray) -> tuple[str, float] | None:
        for name, z, outline, size in self._areas:
            if abs(z - place[2]) <= SAME_PLACE and is_within(place[:2], outline):
                return name, size
        return None


def add_area_load(
    row: Row, building: Building, area: str, pattern: str, size: float, way: str = "GRAV"
) -> None:
    """Add a load on an area."""
    points = np.array([building.joints[name].position for name in building.areas[area].joints])
    normal, _ = area_normal(points)
    found = direction_of(way, None)
    if way.strip().lower() in {"3", "local-3"}:
        found = normal, False
    if found is None:
        message = f'direction "{way}" of area "{area}" must be Gravity, X, Y, Z or 3'
        raise row.error(message)
    vector, projected = found
    share = abs(float(normal @ vector)) if projected else 1.0
    load = vector_of(size * (vector * share))
    building.area_loads.append(AreaLoad(area, pattern, load))


def frame_weight(building: Building, frame: str, gravity: float = 0.0) -> float:
    """Return the own weight of a frame object per length [N/m], or its own mass times gravity."""
    given = building.frames[frame]
    section = building.sections[given.section]
    matter = building.materials.get(given.material or section.material)
    if matter is None:
        return 0.0
    factors = section.modifiers.times(given.modifiers)
    if gravity:
        return gravity * matter.density * section.area * factors.mass
    return matter.weight * section.area * factors.weight


def area_weight(building: Building, area: str, gravity: float = 0.0) -> float:
    """Return the own weight of an area per its own area [N/m2], or its own mass times gravity."""
    given = building.areas[area]
    section = building.area_sections.get(given.section)
    if section is None:
        return 0.0
    matter = building.materials.get(section.material)
    if gravity:
        own = 0.0 if matter is None else gravity * matter.density * section.thickness
        return (own + section.extra_weight) * section.mass * given.mass
    own = 0.0 if matter is None else matter.weight * section.thickness
    return (own + section.extra_weight) * section.weight * given.weight


OWN_MASS = "own mass"
"""Name of the case of the elements' mass."""


def own_loads(
    building: Building, pattern: str, gravity: float = 0.0
) -> Iterator[LineLoad | AreaLoad | JointLoad]:
    """Yield the own weight of all elements, or their mass times gravity, as loads of a pattern."""
    yield from _link_loads(building, pattern, gravity)
    for name in building.frames:
        down = (0.0, 0.0, -frame_weight(building, name, gravity))
        yield LineLoad(name, pattern, 0.0, 1.0, down, down)
    for name in building.areas:
        yield AreaLoad(name, pattern, (0.0, 0.0, -area_weight(building, name, gravity)))


def _link_loads(building: Building, pattern: str, gravity: float) -> Iterator[JointLoad]:
    # Half of the weight of a link at each of its joints; the other half of a grounded link with a
    # single joint is lost. Source: CSI Analysis Reference Manual, "The Link/Support Element", mass.
    for link in building.links.values():
        prop = building.link_properties[link.property]
        half = 0.5 * (gravity * prop.mass if gravity else prop.weight)
        for joint in (link.i, link.j):
            if half and joint is not None:
                yield JointLoad(joint, pattern, (0.0, 0.0, -half, 0.0, 0.0, 0.0))


def mass_shares(rows: Iterable[Row], map_: Fields, building: Building) -> dict[str, float]:
    """Return the shares of load patterns that are mass [-]."""
    given = [values(row, map_, building) for row in rows]
    return {each["pattern"]: each["share"] for each in given}


def default_source(sources: Mapping[str, Mapping[str, Any]]) -> str:
    """Return the name of the mass source that counts: the default one, or the first."""
    return next((k for k, given in sources.items() if given["default"]), next(iter(sources), ""))


def add_mass_source(
    building: Building,
    name: str,
    sources: Mapping[str, Mapping[str, Any]],
    rows: Iterable[Row],
    map_: Fields,
) -> None:
    """Add the mass source of a name with its shares of load patterns, if there is any."""
    loads = mass_shares(rows, map_, building)
    if not sources:
        return
    given, account = sources[name], building.account
    loads = loads if given["loads"] else {}
    building.mass_source = MassSource(given["elements"], given["added"], loads)
    account.read("MASS SOURCE", "mass source", 1)
    others = sorted(other for other in sources if other != name)
    account.left_out("MASS SOURCE", "mass sources besides the default", others)


def cases_of(
    building: Building, parts: Iterable[tuple[str, str, float]]
) -> dict[str, dict[str, float]]:
    """Return static cases as factors by pattern, from (case, pattern, factor).

    A pattern of whose name there is no case is one itself.
    """
    cases: dict[str, dict[str, float]] = {}
    for case, pattern, factor in parts:
        if pattern in building.patterns:
            found = cases.setdefault(case, {})
            found[pattern] = found.get(pattern, 0.0) + factor
    return {name: {name: 1.0} for name in building.patterns} | cases


def add_combinations(
    building: Building,
    table: str,
    cases: dict[str, dict[str, float]],
    parts: Iterable[tuple[str, str | None, float]],
) -> None:
    """Add combinations from (name, case, factor); without a static case they are left out."""
    other: set[str] = set()
    for name, case, factor in parts:
        if case is None or case not in cases:
            other.add(name)
            continue
        found = building.combinations.setdefault(name, {})
        for pattern, share in cases[case].items():
            found[pattern] = found.get(pattern, 0.0) + share * factor
    for name in other:
        building.combinations.pop(name, None)
    building.account.read(table, "combinations of static loads", len(building.combinations))
    building.account.left_out(table, "combinations of other cases, or envelopes", sorted(other))


class Sizes:
    """Lengths [m] of frame objects, areas [m2], volumes of materials [m3], and shared totals."""

    def __init__(self, building: Building) -> None:
        self.building = building
        place = {name: np.array(joint.position) for name, joint in building.joints.items()}
        self.length = {
            name: float(np.linalg.norm(place[f.j] - place[f.i]))
            for name, f in building.frames.items()
        }
        self.area = {
            name: area_normal(np.array([place[j] for j in area.joints]))[1]
            for name, area in building.areas.items()
        }
        self.volumes: dict[str, float] = {}
        self._weight: dict[str, float] = {}
        self._stiffness: dict[str, float] = {}
        for name, frame in building.frames.items():
            section = building.sections[frame.section]
            volume = self.length[name] * section.area
            self._add(name, frame.material or section.material, volume)
            self._weight[name] = self.length[name] * frame_weight(building, name)
        for name, area in building.areas.items():
            if found := building.area_sections.get(area.section):
                self._add(name, found.material, self.area[name] * found.thickness)
            self._weight[name] = self.area[name] * area_weight(building, name)

    def _add(self, name: str, material: str, volume: float) -> None:
        self.volumes[material] = self.volumes.get(material, 0.0) + volume
        matter = self.building.materials.get(material)
        self._stiffness[name] = 0.0 if matter is None else volume * matter.elastic_modulus

    def shares(self, names: Collection[str]) -> tuple[float | None, float | None]:
        """Return the shares of weight and of stiffness of some elements [-], None of nothing."""
        return _share(self._weight, names), _share(self._stiffness, names)

    def down(self, loads: Iterable[LineLoad | AreaLoad | JointLoad]) -> dict[str, float]:
        """Return the downward sum of loads, by pattern [N]."""
        found: dict[str, float] = {}
        for load in loads:
            if isinstance(load, JointLoad):
                force = load.forces[2]
            elif isinstance(load, AreaLoad):
                force = load.load[2] * self.area[load.area]
            elif load.point:
                force = load.start[2]
            else:
                span = (load.b - load.a) * self.length[load.frame]
                force = 0.5 * (load.start[2] + load.end[2]) * span
            found[load.pattern] = found.get(load.pattern, 0.0) - force
        return found


def _share(values: dict[str, float], names: Collection[str]) -> float | None:
    whole = sum(values.values())
    return sum(values.get(name, 0.0) for name in names) / whole if whole > 0.0 else None
