"""Our functions in the place of a host element's virtual ones.

The host is a `genericClient`, an element of OpenSees between any nodes. Its virtual tables (it has
two base classes) are copied, entries are exchanged for our callbacks, and the address of a block is
put in front of each copy. No place in a table is assumed: each entry is found by the address of the
function that it holds.

Lifetime: OpenSees owns the element; its destructor is among the callbacks and marks the block, so
that memory is given up only after the element is gone (`Graft.alive`).
"""

from __future__ import annotations

import ctypes
import functools
import json
from typing import TYPE_CHECKING, Any

import numpy as np

from lir_element.opensees.block.layout import CONSTANT, RESPONSE, offset_of
from lir_element.opensees.block.responses import HINTED, bearing_messages, host_responses
from lir_element.opensees.in_process.symbols import (
    OPTIONAL,
    REPLACED,
    REPLACED_AGAIN,
    NotPossibleError,
    addresses,
)
from lir_element.opensees.kernels.motion import HASH_FACTOR, HASH_START

if TYPE_CHECKING:
    from collections.abc import Sequence

    from lir_element.layout import Records
    from lir_element.opensees.block.responses import HostResponse
    from lir_element.opensees.placement import PlacedBearing

_WORDS = 62
"""Words of all virtual tables of the host, after the first one's two words of head."""
_STREAM_WORDS = 48
_SECOND = 16
"""Offset of the second base class in an element, in bytes."""
_OBJECT_BYTES = 256
"""More than the size of a Vector or a Matrix of OpenSees."""
_TYPE = np.frombuffer(b"LIRBearing\0", dtype=np.uint8)


class VTablePatch:
    """Callbacks in an element of the current model, and the block that they read.

    `block` (1,) is the block of the bearing (`layout.HOST`). `words` are the entries of its state
    that recorders can have, too: name, place, size, whether integers. A NotPossibleError: the
    element differs from that of the self-test.
    """

    def __init__(
        self,
        placed: PlacedBearing,
        block: Records,
        route: str,
        words: Sequence[tuple[str, int, int, bool]] = (),
    ) -> None:
        self.block = block
        tag, placement = placed.tag, placed.placement
        self._kept: list[Any] = [block]
        where = addresses()
        domain = _call("get_domain")
        self._element = element = _call("get_element", domain, tag)
        self._tables = _tables()
        found = [_word(element), _word(element + _SECOND)] if element else []
        if found != [where["table"] + 8 * first for first in self._tables]:
            msg = f"element {tag} of the model is not the host element that was added"
            raise NotPossibleError(msg)
        block["domain"] = domain
        for name, node in zip(("node_i", "node_j"), placement.nodes, strict=True):
            block[name] = _call("get_node", domain, node)
        for name in (
            "get_displacement",
            "get_velocity",
            "get_time",
            "step_size",
            "destroy",
            "destroy_free",
            "new_response",
            "set_vector",
            "allocate",
        ):
            block[name] = where[name]
        block["host_set_response"] = where["set_response"]
        block["host_get_response"] = where["get_response"]
        block["host_force"] = where["resisting_force"]
        block["host_print"] = where["print_element"]
        block["host_table"] = where["table"] + 8 * self._tables[0]
        block["stream_slot"] = _stream_slot()
        block["write"] = ctypes.cast(ctypes.CDLL(None).write, ctypes.c_void_p).value
        block["hinted"] = HINTED.ctypes.data
        block["type_name"] = _TYPE.ctypes.data
        self._set_messages(bearing_messages(placed))
        self._set_responses(host_responses(placement), words)
        line = "\t\t\t" + json.dumps(placed.printed(route))
        self.block["json"] = self.keep(np.frombuffer(line.encode() + b"\0", np.uint8)).ctypes.data

    @property
    def alive(self) -> bool:
        """True if OpenSees still has the element."""
        return bool(self.block["alive"][0])

    def replace(self, functions: dict[str, int]) -> None:
        """Replace the element's own functions: from here on it is a bearing."""
        where = addresses()
        old = np.array((ctypes.c_int64 * (_WORDS + 2)).from_address(where["table"]))
        first, second = self._tables
        again = {f"again_{name}": functions[name] for name in REPLACED_AGAIN}
        upper = self._table(old[: second - 2], first, functions)
        lower = self._table(old[second - 2 :], 2, again)
        self.block["alive"] = 1
        ctypes.c_int64.from_address(self._element).value = upper
        ctypes.c_int64.from_address(self._element + _SECOND).value = lower

    def undo(self) -> None:
        """Restore a living element's own functions."""
        if self.alive:
            for first, place in zip(self._tables, (0, _SECOND), strict=True):
                own = addresses()["table"] + 8 * first
                ctypes.c_int64.from_address(self._element + place).value = own

    def _set_responses(
        self, given: dict[str, HostResponse], words: Sequence[tuple[str, int, int, bool]]
    ) -> None:
        # Responses for recorders.
        table = self.keep(np.zeros(len(given) + len(words), dtype=RESPONSE))
        rows: list[tuple[str, int, int, bool, Any]] = [
            (name, each.source, len(each.matrix), False, each.matrix)
            for name, each in given.items()
        ]
        rows += [(*row, None) for row in words]
        for k, (name, source, size, integer, matrix) in enumerate(rows):
            table["name"][k] = name_hash(name)
            table["source"][k], table["size"][k], table["integer"][k] = source, size, integer
            if source == CONSTANT:
                table["values"][k, :size] = matrix
            elif matrix is not None:
                table["map"][k] = self.keep(np.ascontiguousarray(matrix)).ctypes.data
            table["vector"][k] = self.vector(address_of(table[k : k + 1], "values"), size)
        self.block["responses"] = table.ctypes.data
        self.block["response_count"] = len(rows)

    def vector(self, data: int, count: int) -> int:
        """Return the address of a new Vector over memory of ours."""
        memory = self.keep(np.zeros(_OBJECT_BYTES, dtype=np.uint8)).ctypes.data
        _call("new_vector", memory, data, count)
        return int(memory)

    def matrix(self, data: int, count: int) -> int:
        """Return the address of a new square Matrix over memory of ours."""
        memory = self.keep(np.zeros(_OBJECT_BYTES, dtype=np.uint8)).ctypes.data
        _call("new_matrix", memory, data, count, count)
        return int(memory)

    def keep(self, array: Records) -> Records:
        """Keep memory as long as this object."""
        self._kept.append(array)
        return array

    def _set_messages(self, messages: dict[int, str]) -> None:
        for number, text in messages.items():
            buffer = self.keep(np.frombuffer(text.encode(), dtype=np.uint8))
            self.block["messages"][0, number] = buffer.ctypes.data
            self.block["message_sizes"][0, number] = buffer.size

    def _table(self, old: Any, head: int, functions: dict[str, int]) -> int:
        # A copy with our functions, behind the block's address; its first function's address.
        where = addresses()
        new = self.keep(np.zeros(len(old) + 1, dtype=np.int64))
        new[0], new[1:] = self.block.ctypes.data, old
        for name, function in functions.items():
            if name.removeprefix("again_") in OPTIONAL and name not in where:
                continue
            slots = np.flatnonzero(old[head:] == where[name])
            if len(slots) != 1:
                symbol = REPLACED.get(name, name)
                msg = f"{symbol} stands {len(slots)} times in the element's virtual table"
                raise NotPossibleError(msg)
            new[1 + head + slots[0]] = function
        return int(new.ctypes.data) + 8 * (1 + head)


def name_hash(name: str) -> int:
    """Return the hash of a response's name, as `motion.find_response` makes it."""
    mixed = HASH_START % 2**64
    for byte in name.encode():
        mixed = ((mixed ^ byte) * HASH_FACTOR) % 2**64
    return mixed - 2**64 if mixed >= 2**63 else mixed


def address_of(records: Records, name: str) -> int:
    """Return the address of a field of the first record."""
    return int(records.ctypes.data) + offset_of(records.dtype, name)


def common_functions() -> dict[str, int]:
    """Return the addresses of the callbacks of both couplings; compiled on first use."""
    from lir_element.opensees.kernels import callbacks

    names = (
        "set_response",
        "get_response",
        "print_element",
        "class_type",
        "send_self",
        "receive_self",
        "destroy",
        "destroy_free",
    )
    return {name: getattr(callbacks, name).address for name in names}


@functools.cache
def _tables() -> tuple[int, int]:
    # Places of the first functions in the host's tables: the second one's head repeats the type.
    old = (ctypes.c_int64 * (_WORDS + 2)).from_address(addresses()["table"])
    heads = [k for k in range(1, _WORDS) if old[k] == old[1] and old[k - 1] == -_SECOND]
    if len(heads) != 1:
        msg = "the host element's virtual tables are not laid out as expected"
        raise NotPossibleError(msg)
    return 2, heads[0] + 1


@functools.cache
def _stream_slot() -> int:
    where = addresses()
    table = (ctypes.c_int64 * _STREAM_WORDS).from_address(where["stream_table"] + 16)
    slots = [k for k in range(_STREAM_WORDS) if table[k] == where["write_text"]]
    if len(slots) != 1:
        msg = "the output of OpenSees is not laid out as expected"
        raise NotPossibleError(msg)
    return slots[0]


def _call(name: str, *arguments: int) -> int:
    # A function of the library: addresses are 64 bits wide, tags and counts fit in them too.
    kinds = [ctypes.c_int64] * len(arguments)
    return int(ctypes.CFUNCTYPE(ctypes.c_int64, *kinds)(addresses()[name])(*arguments))


def _word(address: int) -> int:
    return int(ctypes.c_int64.from_address(address).value)
