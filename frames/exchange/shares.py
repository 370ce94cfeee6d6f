"""Which share of the weight and the stiffness of a building some of its elements stand for."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from frames.exchange.geometry import area_normal
from frames.exchange.loads import area_weight, frame_weight

if TYPE_CHECKING:
    from collections.abc import Collection

    from frames.exchange.building import Building


class Shares:
    """Own weight, and modulus times volume, of all elements.

    Parameters
    ----------
    building : Building
        With its frame objects and areas.
    """

    def __init__(self, building: Building) -> None:
        self._weight: dict[str, float] = {}
        self._stiffness: dict[str, float] = {}
        for name, frame in building.frames.items():
            first, last = (np.array(building.joints[j].position) for j in (frame.i, frame.j))
            length = float(np.linalg.norm(last - first))
            section = building.sections[frame.section]
            matter = building.materials.get(frame.material or section.material)
            modulus = 0.0 if matter is None else matter.elastic_modulus
            self._weight[name] = length * frame_weight(building, name)
            self._stiffness[name] = length * modulus * section.area
        for name, area in building.areas.items():
            points = np.array([building.joints[j].position for j in area.joints])
            _, size = area_normal(points)
            found = building.area_sections.get(area.section)
            matter = building.materials.get(found.material) if found else None
            self._weight[name] = size * area_weight(building, name)
            if found is not None and matter is not None:
                self._stiffness[name] = size * matter.elastic_modulus * found.thickness

    def of(self, names: Collection[str]) -> tuple[float | None, float | None]:
        """Return the shares of weight and of stiffness of some elements [-], None of nothing."""
        return _share(self._weight, names), _share(self._stiffness, names)


def _share(values: dict[str, float], names: Collection[str]) -> float | None:
    whole = sum(values.values())
    return sum(values.get(name, 0.0) for name in names) / whole if whole > 0.0 else None
