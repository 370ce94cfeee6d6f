"""An isolation system of four bearings in a square, as tests of design formulas take it."""

from typing import Any

from frames.design import IsolationSystem
from lir_element import LIRBearing


def square_system(**more: Any) -> IsolationSystem:
    """Return it, 1.5 MN on each bearing, with further fields of `IsolationSystem`."""
    bearing = LIRBearing(
        radius=1.5,
        slider_height=0.3,
        slider_radius=0.2,
        capacity=0.45,
        friction=0.06,
        interface_friction=0.25,
    )
    return IsolationSystem(
        bearings=(bearing,) * 4,
        loads=(1.5e6,) * 4,
        plan=(9.0, 9.0),
        positions=((-4, -4), (4, -4), (4, 4), (-4, 4)),
        **more,
    )
