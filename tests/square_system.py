"""An isolation system of four bearings in a square, as tests of design formulas take it."""

from typing import Any

from frames.design import IsolationSystem
from tests.scenes import tall_bearing


def square_system(**more: Any) -> IsolationSystem:
    """Return it, 1.5 MN on each bearing, with further fields of `IsolationSystem`."""
    bearing = tall_bearing()
    return IsolationSystem(
        bearings=(bearing,) * 4,
        loads=(1.5e6,) * 4,
        plan=(9.0, 9.0),
        positions=((-4, -4), (4, -4), (4, 4), (-4, 4)),
        **more,
    )
