"""Compile the kernels of usual analyses ahead of their first use: ``python -m frames.precompile``.

For images of containers, clusters and wheels: the first analysis then starts at once. Compiled
kernels are kept in the folder that every start searches (`LIR_CACHE_DIR`). Two processes share the
work unless ``--jobs 1`` is set.
"""

from __future__ import annotations

import argparse
import multiprocessing
import os
import sys
import warnings
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np

from frames.library.models import lumped_mass
from frames.library.shear_buildings import shear_building
from frames.model.laws import Tie
from frames.motion.ground_motion import GroundMotion
from frames.solve.time_history import time_history
from lir_element import Element, LIRBearing, VelocityFriction, cyclic_test

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

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


LAYERS = (
    ("testing rig",),
    ("testing rig, contact", "time history", "element"),
    (
        "time history, both",
        "time history, contact",
        "time history, nonlinear parts",
        "testing rig, rigid_body",
        "time history, rigid_body",
    ),
)
"""Layers in the order of compilation: kernels that a layer calls are compiled before it.

Within a layer two processes hardly compile the same kernel; more than two would do so.
"""


def compile_usual(jobs: int = 1) -> dict[str, float]:
    """Run a small analysis of each kind."""
    return dict(_compiled(jobs))


def _compiled(jobs: int) -> Iterator[tuple[str, float]]:
    # Name and time [s] of each analysis as it is done.
    if jobs == 1:
        for name in USUAL:
            yield name, _timed(name)
        return
    context = multiprocessing.get_context("spawn")  # threads of numerical libraries do not fork
    os.environ.setdefault("PYTHONSAFEPATH", "1")  # no file of the working folder is a module there
    with ProcessPoolExecutor(jobs, context, _hush) as pool:
        for layer in LAYERS:
            running = {pool.submit(_timed, name): name for name in layer}
            for each in as_completed(running):
                if each.exception() is not None:
                    raise _failure(running) from each.exception()
                yield running[each], each.result()


def _timed(name: str) -> float:
    began = perf_counter()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of bearings and structures that nobody will build
        USUAL[name]()
    return perf_counter() - began


def _hush() -> None:
    # Two lines of progress would be drawn over each other.
    os.environ["LIR_QUIET"] = "1"


def _failure(running: dict[Future[float], str]) -> RuntimeError:
    # Message on a layer of which one analysis failed, or whose processes ended early.
    for each in running:
        each.cancel()
    failed = {name: e.exception() for e, name in running.items() if e.done() and not e.cancelled()}
    named = {name: error for name, error in failed.items() if error is not None}
    said = "; ".join(f"{name!r}: {error}" for name, error in named.items())
    return RuntimeError(
        f"kernels could not be compiled of {said}. One process takes half the memory and shows "
        "where it fails: python -m frames.precompile --jobs 1"
    )


def _jobs() -> int:
    parser = argparse.ArgumentParser(
        prog="python -m frames.precompile", description="Compile the kernels of usual analyses."
    )
    parser.add_argument(
        "--jobs",
        type=int,
        default=min(os.cpu_count() or 1, 2),
        metavar="N",
        help="processes that share the work (as many as processors, at most 2)",
    )
    jobs: int = parser.parse_args().jobs
    if jobs < 1:
        parser.error(f"--jobs {jobs} must be 1 or more")
    return jobs


def main() -> None:
    """Compile, and print the duration of each kind of analysis."""
    for kind, took in _compiled(_jobs()):
        sys.stdout.write(f"{kind:32}{took:8.1f} s\n")
        sys.stdout.flush()


if __name__ == "__main__":
    main()
