"""Self-test of the in-process coupling with this build of OpenSees, in another process.

    python -m lir_element.opensees.in_process.selftest

A mass on a bearing moves vertically under compression: a linear spring, whose answer the same build
gives with an element of its own. Static and transient analysis, a wipe, all of it twice. A verdict
by numbers is kept beside the compiled kernels under the hash of the library; a verdict by a crash,
by time or by memory is valid for this process alone.
"""

from __future__ import annotations

import functools
import hashlib
import json
import subprocess  # noqa: S404  # this module, by our own interpreter
import sys
from pathlib import Path
from typing import Any

import numpy as np

from lir_element import CoulombFriction, LIRBearing
from lir_element._compile.cache import content_of, keep
from lir_element._compile.jit import OWN
from lir_element._compile.progress import say
from lir_element.child_process import child_environment
from lir_element.opensees.connection import add_host_element
from lir_element.opensees.element_memory import ElementMemory
from lir_element.opensees.in_process.in_process_element import InProcessElement
from lir_element.opensees.in_process.symbols import NotPossibleError, addresses, library_path
from lir_element.opensees.library import opensees
from lir_element.opensees.placement import PlacedBearing, place

_LONGEST = 900.0
"""Longest duration of the self-test [s]; it compiles the kernels the first time."""
_STIFFNESS = 2.0e6
_MASS = 1000.0
_GRAVITY = 9.81
_STEPS = 200
_AGREEMENT = 1e-12


@functools.cache
def why_not_fast() -> str:
    """Return why the in-process coupling is not possible with this OpenSees; empty if it is."""
    opensees()
    try:
        addresses()
        path = library_path()
    except NotPossibleError as error:
        return str(error)
    folder = OWN.folder()
    verdicts = folder / "opensees.json" if folder else None
    key = _fingerprint(path)
    known = _kept(verdicts)
    if key in known:
        return known[key] and f"{known[key]}; remove {verdicts} to repeat the test"
    say("testing the in-process coupling with OpenSees (once, one to three minutes)")
    verdict, decided = _run_child()
    if decided:
        keep(verdicts, json.dumps(known | {key: verdict}, indent=1).encode())
    return verdict


def _kept(verdicts: Path | None) -> dict[str, str]:
    # A file that is missing or damaged holds no verdict.
    try:
        known = json.loads(content_of(verdicts) or b"{}") if verdicts else {}
    except (ValueError, RecursionError):
        return {}
    return {k: str(v) for k, v in known.items()} if isinstance(known, dict) else {}


def _fingerprint(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "blake2b").hexdigest()[:32]


def _run_child() -> tuple[str, bool]:
    # Verdict of a self-test in a process of its own, which may crash, and whether it is by numbers:
    # a verdict by time or by memory may differ tomorrow.
    try:
        done = subprocess.run(
            [sys.executable, "-P", "-m", "lir_element.opensees.in_process.selftest"],
            env=child_environment(),
            capture_output=True,
            text=True,
            timeout=_LONGEST,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return f"its self-test did not end within {_LONGEST:g} s", False
    except OSError as error:
        return f"its self-test cannot be started ({error})", False
    if done.returncode != 0:
        last = (done.stderr.strip().splitlines() or ["no message"])[-1]
        said = f"its self-test failed (exit code {done.returncode}: {last})"
        return said, NotPossibleError.__name__ in last
    return "", True


def main() -> None:
    """Compare the bearing with a linear spring, twice."""
    bearing = LIRBearing(
        radius=1.0,
        slider_height=0.1,
        slider_radius=0.1,
        capacity=0.2,
        friction=CoulombFriction(0.05),
        interface_friction=0.15,
        axial_stiffness=_STIFFNESS,
        axial_damping=0.0,
        design_load=1e4,
    )
    for turn in (1, 2):
        expected, got = _run(None), _run(bearing)
        error = float(np.abs(got - expected).max() / np.abs(expected).max())
        if not error < _AGREEMENT:
            msg = f"turn {turn}: the bearing is off by {error:.2g} of the spring's motion"
            raise NotPossibleError(msg)


def _run(bearing: LIRBearing | None) -> np.ndarray[Any, Any]:
    # Vertical displacements under gravity and half of it as a shaking, and the final force.
    ops = opensees()
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    for node in (1, 2):
        ops.node(node, 0.0, 0.0, 0.0)
    ops.fix(1, 1, 1, 1, 1, 1, 1)
    ops.fix(2, 1, 1, 0, 1, 1, 1)
    ops.mass(2, _MASS, _MASS, _MASS, 0.0, 0.0, 0.0)
    grafted = None
    if bearing is None:
        ops.uniaxialMaterial("Elastic", 1, _STIFFNESS)
        ops.element("zeroLength", 7, 1, 2, "-mat", 1, "-dir", 3)
    else:
        placement = place(ops, 1, 2, bearing, None, 1.0, 1.0)
        hosted = ElementMemory(PlacedBearing(7, bearing, "pendulum", placement))
        grafted = InProcessElement(hosted, add_host_element(ops, 7, placement))
    moves = [*_settle(ops), *_shake(ops)]
    force = ops.eleForce(7, 9)
    ops.wipe()
    if grafted is not None:
        if grafted.alive:
            msg = "the bearing outlives the model"
            raise NotPossibleError(msg)
        grafted.release()
    return np.array([*moves, force / _STIFFNESS])


def _settle(ops: Any) -> list[float]:
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    ops.load(2, 0.0, 0.0, -_MASS * _GRAVITY, 0.0, 0.0, 0.0)
    _solver(ops)
    ops.integrator("LoadControl", 0.25)
    ops.analysis("Static")
    if ops.analyze(4) != 0:
        msg = "the static analysis failed"
        raise NotPossibleError(msg)
    ops.loadConst("-time", 0.0)
    return [ops.nodeDisp(2, 3)]


def _shake(ops: Any) -> list[float]:
    ops.wipeAnalysis()
    ops.timeSeries("Trig", 2, 0.0, 100.0, 0.4, "-factor", 0.5 * _GRAVITY)
    ops.pattern("UniformExcitation", 2, 3, "-accel", 2)
    _solver(ops)
    ops.integrator("Newmark", 0.5, 0.25)
    ops.analysis("Transient")
    moves = []
    for _ in range(_STEPS):
        if ops.analyze(1, 0.01) != 0:
            msg = "the transient analysis failed"
            raise NotPossibleError(msg)
        moves.append(ops.nodeDisp(2, 3))
    return moves


def _solver(ops: Any) -> None:
    ops.constraints("Plain")
    ops.numberer("Plain")
    ops.system("FullGeneral")
    ops.test("NormDispIncr", 1e-14, 20)
    ops.algorithm("Newton")


if __name__ == "__main__":
    main()
