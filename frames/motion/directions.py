"""Components of a record by their directions, as files name them: azimuth, or vertical."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from frames.motion.records import AccelerationTrace

_VERTICAL = re.compile(r"UP|DOWN|DN|DWN|UD|VERT?\w*|VRT|V|Z|U|..Z", re.IGNORECASE)
_QUADRANT = re.compile(r"([NS])(\d{1,2})([EW])", re.IGNORECASE)
_NORTH = {"N": 0.0, "NS": 0.0, "NORTH": 0.0, "S": 180.0, "SOUTH": 180.0}
_AZIMUTHS = _NORTH | {"E": 90.0, "EW": 90.0, "EAST": 90.0, "W": 270.0, "WEST": 270.0}


class Component(NamedTuple):
    """One component of a record."""

    direction: str  # as the file names it
    trace: AccelerationTrace  # accelerations [m/s2] and time step [s]

    @property
    def vertical(self) -> bool:
        """Whether it is vertical."""
        return _VERTICAL.fullmatch(plain_direction(self.direction)) is not None

    @property
    def azimuth(self) -> float | None:
        """Azimuth [degrees clockwise from north], None if the direction does not say it."""
        text = plain_direction(self.direction)
        digits = re.fullmatch(r"(\d{1,3})(?:DEG)?", text)
        if digits:
            return float(digits[1]) % 360.0
        quadrant = _QUADRANT.fullmatch(text)
        if quadrant:
            start = 0.0 if quadrant[1] == "N" else 180.0
            turn = float(quadrant[2]) if quadrant[1] + quadrant[3] in {"NE", "SW"} else None
            return (start + turn if turn is not None else start - float(quadrant[2])) % 360.0
        stream = text[-1] if re.fullmatch(r"[A-Z]N[NE]", text) else text
        return _AZIMUTHS.get(stream)


def plain_direction(direction: str) -> str:
    """Return a direction without spaces and signs, in capitals."""
    return re.sub(r"[\s_.-]|\(\+\)", "", direction).upper()
