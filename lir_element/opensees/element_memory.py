"""Memory of a bearing in a foreign model, and its queries from Python."""

from __future__ import annotations

import ctypes
import functools
import importlib
import sys
import weakref
from typing import TYPE_CHECKING, Any

import numpy as np

from lir_element.bundles.contact_data import contact_arrays, initial_state
from lir_element.device.sliders import face_records, initial_bodies
from lir_element.errors import RunStatus
from lir_element.layout import BODIES, HEAT_PARTS, STATE, STATE_BY_NAME, WORK
from lir_element.opensees.block.layout import (
    CONSTANT,
    FROM_FORCE,
    HOST,
    RECORD_WORDS,
    STATE_WORDS,
)
from lir_element.opensees.block.responses import bearing_messages, host_responses
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import ModuleType

    from lir_element.layout import Floats, Records
    from lir_element.opensees.placement import PlacedBearing

_C = ctypes.cdll.msvcrt if sys.platform == "win32" else ctypes.CDLL(None)
_C.free.argtypes = [ctypes.c_void_p]
_STATUS = {int(status): status for status in RunStatus}


class ElementMemory:
    """A bearing whose state other compiled code determines.

    That code reads and writes its `block` (1,) (`layout.HOST`).
    """

    def __init__(self, placed: PlacedBearing) -> None:
        self.placed = placed
        self.block = np.zeros(1, dtype=HOST)
        self.block["symmetric"] = placed.symmetric
        self.block["design_load"] = placed.device.resolved()["design_load"]
        self.messages = bearing_messages(placed)
        self._responses = host_responses(placed.placement)
        self._props = placed.device.to_record()
        self._old = initial_state(self._props)
        self._kept: list[Any] = []
        self.address = int(self.block.ctypes.data)
        count = placed.placement.dofs
        self._u: Floats = self.block["host_u"][0, :count]
        self._v: Floats = self.block["host_v"][0, :count]
        self._force: Floats = self.block["force"][0, :count]
        self._columns: Floats = self.block["tangent"][0, : count * count]
        self._initial: Floats = self.block["initial"][0, : count * count]
        self._clock = self.block["committed_time"]
        self._telling = self.block["telling"]
        self._trial, self._tangent, self._commit = _functions(placed.level)
        weakref.finalize(self, _free_records, self.block)
        self._set_map()
        self._set_records()
        self._set_initial()

    @property
    def force(self) -> Floats:
        """Resisting force of the last trial in the model's degrees of freedom, a view (n,)."""
        return self._force

    @property
    def initial(self) -> Floats:
        """Stiffness at rest under the design load, by columns, a view (n * n,)."""
        return self._initial

    @property
    def committed_time(self) -> float:
        """The model's time at the last commit [s]."""
        return float(self._clock[0])

    def trial(
        self, displacement: Floats, velocity: Floats, dt: float, time: float = 0.0
    ) -> RunStatus:
        """Determine the state at a motion of the model.

        Shapes: displacement, velocity (n,).
        """
        self._u[:] = displacement
        self._v[:] = velocity
        self.block["time"] = time
        return _STATUS[self._trial(self.address, dt)]

    def commit(self) -> None:
        """Accept the trial state."""
        self._commit(self.address)

    def restart(self) -> None:
        """Reset the bearing to its undeformed, unloaded start."""
        if self.block["commits"][0]:
            _restart()(self.address)

    def tangent_by_columns(self) -> Floats:
        """Return the tangent of the last trial in the model's DOFs, a view (n * n,)."""
        self._tangent(self.address)
        return self._columns

    def response(self, name: str) -> Any:
        """Return a response of the committed state by its name, as `bearing_response` does."""
        if name in self._responses:
            return self._host_response(*self._responses[name])
        if name not in STATE_BY_NAME:
            known = ", ".join(sorted({*STATE_BY_NAME, *self._responses, "route"}))
            msg = f"response {name!r} does not exist: choose one of {known}"
            raise KeyError(msg)
        value = np.array(self._old[name][0])
        return value if value.ndim else value[()]

    def _host_response(self, source: int, matrix: Floats) -> Floats:
        if source == CONSTANT:
            return matrix.copy()
        given = self._force if source == FROM_FORCE else self._u
        return np.asarray(matrix @ given)

    def told(self) -> str:
        """Return the message of the last trial; empty if there is none."""
        return self.messages[int(self._telling[0])] if self._telling[0] else ""

    def outcome(self) -> tuple[int, bool, float]:
        """Return the state of the analysis."""
        block = self.block
        refused, unfinished = int(block["refused"][0]), bool(block["unfinished"][0])
        return refused, unfinished, self.committed_time

    def start_recording(self, every: int) -> None:
        """Record every `every`-th commit from now on, and drop earlier records; 0: none."""
        self.block["record_every"] = every
        self.block["record_left"] = 1
        self.block["record_count"] = 0

    def recorded(self) -> tuple[Floats, Floats, Records, Records]:
        """Return the states that were recorded.

        Shapes: time, velocity, states, bodies (n,).
        """
        if self.block["record_every"][0] < 0:
            who = f"bearing element {self.placed.tag}"
            msg = f"{who}: there is no memory for more states: record fewer (every=)"
            raise MemoryError(msg)
        count = int(self.block["record_count"][0])
        if count == 0:
            words = np.zeros((0, RECORD_WORDS), dtype=np.int64)
        else:
            place = ctypes.cast(int(self.block["record"][0]), ctypes.POINTER(ctypes.c_int64))
            words = np.ctypeslib.as_array(place, (count, RECORD_WORDS)).copy()
        head = words[:, :4].copy().view(np.float64)
        states = words[:, 4 : 4 + STATE_WORDS].copy().view(STATE)[:, 0]
        bodies = words[:, 4 + STATE_WORDS :].copy().view(BODIES)[:, 0]
        return head[:, 0], head[:, 1:], states, bodies

    def _set_map(self) -> None:
        matrix = self.placed.placement.matrix
        entries = 0
        for row in range(12):
            columns = np.flatnonzero(matrix[row])
            for column in columns:
                self.block["columns"][0, entries] = column
                self.block["values"][0, entries] = matrix[row, column]
                entries += 1
            self.block["start"][0, row + 1] = entries
        self.block["dofs"] = self.placed.placement.dofs
        self.block["force_factor"] = self.placed.placement.force_factor

    def _set_records(self) -> None:
        self._keep("props", self._props)
        self._keep("old", self._old)
        self._keep("new", self._old.copy())
        self._keep("first", self._old.copy())
        self._keep("work", np.zeros(1, dtype=WORK))
        self._keep("heat", np.zeros((1, 3, HEAT_PARTS)))
        self.block["realloc"] = ctypes.cast(_C.realloc, ctypes.c_void_p).value
        if self.placed.level != "contact":
            return
        bundle = contact_arrays([self.placed.device], [True], STANDARD_GRAVITY)
        self.block["point_count"] = bundle.points.shape[1]
        for name in (
            "row",
            "sliders",
            "points",
            "bodies_old",
            "bodies_new",
            "touch_old",
            "touch_new",
            "search_old",
            "search_new",
            "scratch",
        ):
            self._keep(name, getattr(bundle, name))
        self._keep("bodies_first", initial_bodies(1))
        self._keep("touch_first", face_records(self.placed.device)[1])

    def _keep(self, name: str, array: Records) -> None:
        self._kept.append(array)
        self.block[name] = array.ctypes.data

    def _set_initial(self) -> None:
        # Stiffness at rest: undeformed and sticking under the design load; then unloaded again.
        options = self.placed.device.resolved()
        count = self.placed.placement.dofs
        u = np.zeros(12)
        u[8] = -options["design_load"] / options["axial_stiffness"]
        host = np.asarray(
            np.linalg.lstsq(self.placed.placement.matrix, u, rcond=None)[0], np.float64
        )
        self.trial(host, np.zeros(count), 0.0)
        self._initial[:] = self.tangent_by_columns()
        self.trial(np.zeros(count), np.zeros(count), 0.0)
        self.block["unfinished"] = 0


def _free_records(block: Records) -> None:
    _C.free(int(block["record"][0]))


@functools.cache
def _functions(level: str) -> tuple[Callable[..., Any], ...]:
    entries = entries_of(level)
    return tuple(e.ctypes for e in (entries.trial, entries.tangent, entries.commit))


@functools.cache
def _restart() -> Callable[..., Any]:
    from lir_element.opensees.kernels import callbacks

    return callbacks.restart.ctypes  # type: ignore[no-any-return]


def entries_of(level: str) -> ModuleType:
    """Return the compiled entry points of a level; compiled on first use of that level."""
    return importlib.import_module(f"lir_element.opensees.kernels.entries_{level}")
