"""Compile the kernels of usual analyses ahead of their first use: ``python -m frames.precompile``.

For images of containers, clusters and wheels: the first analysis then starts at once. What is
compiled is kept where every start looks for it (`LIR_CACHE_DIR`).
"""

from __future__ import annotations

import sys
import warnings
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np

from frames.library.models import lumped_mass, shear_building
from frames.model.laws import Tie
from frames.motion.ground_motion import GroundMotion
from frames.solve.time_history import time_history
from lir_element import Element, LIRBearing, VelocityFriction, cyclic_test

if TYPE_CHECKING:
    from collections.abc import Callable

    from frames.frame import Frame

_BEARING = LIRBearing(
    radius=1.0,
    slider_height=0.1,
    slider_radius=0.1,
    capacity=0.2,
    friction=VelocityFriction(f_max=0.05, f_min=0.03, rate=20.0),
    interface_friction=0.12,
)
_MASS = 1e5  # kg


def _element() -> None:
    element = Element(_BEARING)
    element.tangent_stiffness()
    element.commit()


def _building() -> Frame:
    return shear_building(_BEARING, _MASS, 1e8, storeys=2)


def _tied() -> Frame:
    frame = _building()
    bottom, *_, top = frame.nodes
    frame.add_link("tie", bottom, top, Tie(stiffness=1e6, yield_force=1e4))
    return frame


def _history(model: Frame, level: str) -> None:
    time_history(model, GroundMotion(x=np.full(4, 0.5), dt=0.005), level=level)


USUAL: dict[str, Callable[[], object]] = {
    "element": _element,
    "testing rig": lambda: cyclic_test(_BEARING, [1e-3, -1e-3], 1e5),
    "testing rig, contact": lambda: cyclic_test(_BEARING, [1e-4], 1e5, level="contact"),
    "testing rig, rigid_body": lambda: cyclic_test(_BEARING, [1e-4], 1e5, level="rigid_body"),
    "time history": lambda: _history(_building(), "pendulum"),
    "time history, contact": lambda: _history(_building(), "contact"),
    "time history, rigid_body": lambda: _history(lumped_mass(_BEARING, _MASS), "rigid_body"),
    "time history, nonlinear parts": lambda: _history(_tied(), "pendulum"),
    "time history, both": lambda: _history(_tied(), "contact"),
}
"""Small analyses whose kernels are those of all others of their kind."""


def compile_usual() -> dict[str, float]:
    """Run a small analysis of each kind.

    Returns
    -------
    dict
        Time that each took [s], by name; next to nothing where its kernels are kept already.
    """
    seconds = {}
    for name, run in USUAL.items():
        began = perf_counter()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of bearings and structures that nobody will build
            run()
        seconds[name] = perf_counter() - began
    return seconds


def main() -> None:
    """Compile, and print what each kind of analysis took."""
    for kind, took in compile_usual().items():
        sys.stdout.write(f"{kind:32}{took:8.1f} s\n")


if __name__ == "__main__":
    main()
