"""Where the nodes of a frame are in an ETABS model: points in plan at stories."""

from __future__ import annotations

from bisect import bisect_left
from typing import TYPE_CHECKING

from frames._errors import ModelError

if TYPE_CHECKING:
    from collections.abc import Collection

    from frames.model.frame_data import FrameData

LEAST_STORY = 0.01
"""Least height of a story; a level that is closer to the one below has none of its own [m]."""


class EtabsPlaces:
    """Stories and points of a frame.

    Levels are stories where a frame has levels, its diaphragms' elevations otherwise, and always
    the lowest and the highest node. Other nodes hang below the next story.

    Parameters
    ----------
    frame : Frame
        The model.
    length : float
        Unit of length of the file [m].
    left_out : collection of str
        Nodes that the file does not have.

    Attributes
    ----------
    at : dict of str to (str, str)
        Point and story of each node.

    Raises
    ------
    ModelError
        If two nodes stand at one place, which ETABS would merge.
    """

    def __init__(self, frame: FrameData, length: float, left_out: Collection[str]) -> None:
        self._one = length
        nodes = [node for name, node in frame.nodes.items() if name not in left_out]
        heights = sorted({node.z for node in nodes})
        chosen = {frame.nodes[level.nodes[0]].z for level in frame.levels}
        chosen |= {frame.nodes[part.nodes[0]].z for part in frame.diaphragms.values()}
        self._z = [heights[0]]
        for z in heights[1:]:
            if z in chosen and z - self._z[-1] > LEAST_STORY:
                self._z.append(z)
        if heights[-1] > self._z[-1]:
            self._z.append(heights[-1])
        self._names = ["Base", *(f"Story{k}" for k in range(1, len(self._z)))]
        self._points: dict[tuple[float, float, float], str] = {}
        self.at: dict[str, tuple[str, str]] = {}
        taken: dict[tuple[str, str], str] = {}
        for node in nodes:
            k = bisect_left(self._z, node.z)
            key = (node.x, node.y, self._z[k] - node.z)
            point = self._points.setdefault(key, str(len(self._points) + 1))
            place = (point, self._names[k])
            if place in taken:
                message = (
                    f'nodes "{taken[place]}" and "{node.name}" stand at one place, which ETABS '
                    "merges: move one of them, or join them in the frame"
                )
                raise ModelError(message)
            taken[place] = node.name
            self.at[node.name] = place

    def level(self, node: str) -> int:
        """Return the number of the story at which a node is, 0 for the base."""
        return self._names.index(self.at[node][1])

    def stories(self) -> list[str]:
        """Return the lines of stories, from the top."""
        lines = [
            f'STORY "{name}"  HEIGHT {(z - low) / self._one!r}  MASTERSTORY "Yes"'
            for name, z, low in zip(self._names[1:], self._z[1:], self._z[:-1], strict=True)
        ]
        return [*lines[::-1], f'STORY "Base"  ELEV {self._z[0] / self._one!r}']

    def points(self) -> list[str]:
        """Return the lines of points: x, y, and how far below the story."""
        return [
            f'POINT "{name}"  '
            + " ".join(repr(v / self._one) for v in (place if place[2] else place[:2]))
            for place, name in self._points.items()
        ]
