"""What is read from a static cyclic test of the macro-model or of the element."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from validation.claims.static_test import REACH, STEP

if TYPE_CHECKING:
    from lir_element.layout import Floats

SLIPS = 3e-4  # m, above what the interface gives before it slips


@dataclass(frozen=True)
class Loop:
    """One static cyclic test: displacement, force over load and slip, (n,)."""

    name: str
    displacement: Floats
    force: Floats
    slip: Floats

    def first(self) -> int:
        """Return the point of the first slip."""
        return int(np.argmax(np.abs(self.slip) > SLIPS))

    def at(self, displacement: float) -> float:
        """Return the force on the first way out, at a displacement [m]."""
        turn = round(REACH / STEP)
        return float(np.interp(displacement, self.displacement[:turn], self.force[:turn]))

    def zero(self) -> int:
        """Return the point nearest to zero displacement on the first way back."""
        turn = round(REACH / STEP)
        return turn + int(np.argmin(np.abs(self.displacement[turn : 3 * turn])))

    def back(self) -> float:
        """Return the force at zero displacement on the first way back."""
        turn = round(REACH / STEP)
        way = slice(turn, 3 * turn)
        return float(np.interp(0.0, self.displacement[way][::-1], self.force[way][::-1]))
