"""The fast route: compiled callbacks in the place of a host element's virtual functions.

The host is a `genericClient`, an element of OpenSees that stands between any nodes. Its virtual
table is copied, the entries of `symbols.REPLACED` are exchanged for our callbacks, and the address
of the bearing's block is put in front of the copy. No place in the table is assumed: each entry is
found by the address of the function that it holds.

Lifetime: OpenSees owns the element; its destructor is among the callbacks and marks the block, so
that memory is given up only after the element is gone (`Grafted.alive`).
"""

from __future__ import annotations

import ctypes
import functools
from typing import TYPE_CHECKING, Any

import numpy as np

from lir_element.errors import RunStatus
from lir_element.layout import STATE, STATE_FIELDS
from lir_element.opensees.block.layout import MOST_DOFS, RESPONSE, offset_of
from lir_element.opensees.fast.symbols import REPLACED, NotPossibleError, addresses
from lir_element.opensees.kernels.motion import HASH_FACTOR, HASH_START

if TYPE_CHECKING:
    import socket

    from lir_element.layout import Records
    from lir_element.opensees.block.hosted import Hosted

_SLOTS = 60
"""Virtual functions of an element: as many words are copied after the table's two first ones."""
_OBJECT_BYTES = 256
"""More than a Vector or a Matrix of OpenSees takes."""
_HOST_RESPONSES = {"force"}
"""Names that the host element answers by itself, from our resisting force."""
_ALIASES = ("deformation", "deformations", "basicDeformation", "basicDisplacement")


class Grafted:
    """A bearing in the place of a host element of the current model.

    Parameters
    ----------
    hosted : Hosted
        The bearing.
    farewell : socket
        The host element's connection, which its destructor writes to.

    Raises
    ------
    NotPossibleError
        If the element is not what it was in the self-test.
    """

    route = "fast"

    def __init__(self, hosted: Hosted, farewell: socket.socket) -> None:
        self.hosted = hosted
        self.device = hosted.bearing
        self.level = hosted.level
        self.placement = hosted.placement
        self._farewell = farewell
        self._kept: list[Any] = []
        where = addresses()
        domain = _call("get_domain")
        element = _call("get_element", domain, hosted.tag)
        if not element or _word(element) != where["table"] + 16:
            msg = f"element {hosted.tag} of the model is not the host element that was added"
            raise NotPossibleError(msg)
        self._fill_block(domain)
        self._set_objects()
        self._set_responses()
        self._set_messages()
        table = self._new_table()
        self._element = element
        ctypes.c_int64.from_address(element).value = table  # from here on it is a bearing

    @property
    def alive(self) -> bool:
        """Whether OpenSees still has the element."""
        return bool(self.hosted.block["alive"][0])

    def response(self, name: str) -> Any:
        """Return a response of the committed state by name."""
        return self.hosted.response(name)

    def start_recording(self, every: int) -> None:
        """Record every so many commits from now on; 0: none."""
        self.hosted.start_recording(every)

    def recorded(self) -> tuple[Any, ...]:
        """Return what `Hosted.recorded` does."""
        return self.hosted.recorded()

    def detach(self) -> None:
        """Give the element its own functions back: ours end with Python, before OpenSees does."""
        if self.alive:
            ctypes.c_int64.from_address(self._element).value = addresses()["table"] + 16
            self._farewell.detach()  # stays open: to a closed end the destructor writes for ever

    def release(self) -> None:
        """Give up the connection, once the element is gone."""
        self._farewell.close()

    def _fill_block(self, domain: int) -> None:
        block, where = self.hosted.block, addresses()
        block["domain"] = domain
        for name, tag in zip(("node_i", "node_j"), self.hosted.placement.nodes, strict=True):
            block[name] = _call("get_node", domain, tag)
        for name in ("get_displacement", "get_velocity", "get_time", "step_size", "destroy",
                     "destroy_free", "new_response", "set_vector", "allocate"):  # fmt: skip
            block[name] = where[name]
        block["host_set_response"] = where["set_response"]
        block["host_get_response"] = where["get_response"]
        block["host_table"] = where["table"] + 16
        block["write"] = ctypes.cast(ctypes.CDLL(None).write, ctypes.c_void_p).value
        block["alive"] = 1

    def _set_objects(self) -> None:
        block, count = self.hosted.block, self.hosted.placement.dofs
        zeros = self._keep(np.zeros(MOST_DOFS * MOST_DOFS))
        block["force_vector"] = self._vector(_field(block, "force"), count)
        block["tangent_matrix"] = self._matrix(_field(block, "tangent"), count)
        block["initial_matrix"] = self._matrix(_field(block, "initial"), count)
        block["zero_matrix"] = self._matrix(zeros.ctypes.data, count)

    def _set_responses(self) -> None:
        half = self.hosted.placement.dofs // 2
        rows = [(name, -1, half, False) for name in _ALIASES]
        for field in STATE_FIELDS:
            size = int(np.prod(field.shape, dtype=int))
            if field.name not in _HOST_RESPONSES and size <= MOST_DOFS:
                offset = offset_of(STATE, field.name) // 8
                rows.append((field.name, offset, size, field.kind == "i8"))
        table = self._keep(np.zeros(len(rows), dtype=RESPONSE))
        for k, (name, source, size, integer) in enumerate(rows):
            table["name"][k] = name_hash(name)
            table["source"][k], table["size"][k], table["integer"][k] = source, size, integer
            table["vector"][k] = self._vector(_field(table[k : k + 1], "values"), size)
        self.hosted.block["responses"] = table.ctypes.data
        self.hosted.block["response_count"] = len(rows)

    def _set_messages(self) -> None:
        for status in RunStatus:
            what = f"WARNING bearing element {self.hosted.tag}: {status.meaning}."
            text = f"{what} What to try: {status.remedy}.\n".encode()
            buffer = self._keep(np.frombuffer(text, dtype=np.uint8).copy())
            self.hosted.block["messages"][0, status] = buffer.ctypes.data
            self.hosted.block["message_sizes"][0, status] = len(text)

    def _new_table(self) -> int:
        where = addresses()
        old = np.array((ctypes.c_int64 * (_SLOTS + 2)).from_address(where["table"]))
        new = self._keep(np.zeros(_SLOTS + 3, dtype=np.int64))
        new[0], new[1:] = self.hosted.address, old
        for name, function in _callbacks(self.hosted.level).items():
            slots = np.flatnonzero(old[2:] == where[name])
            if len(slots) != 1:
                msg = f"{REPLACED[name]} stands {len(slots)} times in the element's virtual table"
                raise NotPossibleError(msg)
            new[3 + slots[0]] = function
        return int(new.ctypes.data) + 24

    def _vector(self, data: int, count: int) -> int:
        memory = self._keep(np.zeros(_OBJECT_BYTES, dtype=np.uint8)).ctypes.data
        _call("new_vector", memory, data, count)
        return int(memory)

    def _matrix(self, data: int, count: int) -> int:
        memory = self._keep(np.zeros(_OBJECT_BYTES, dtype=np.uint8)).ctypes.data
        _call("new_matrix", memory, data, count, count)
        return int(memory)

    def _keep(self, array: Records) -> Records:
        self._kept.append(array)
        return array


def name_hash(name: str) -> int:
    """Return the hash of a response's name, as `motion.find_response` makes it."""
    mixed = HASH_START % 2**64
    for byte in name.encode():
        mixed = ((mixed ^ byte) * HASH_FACTOR) % 2**64
    return mixed - 2**64 if mixed >= 2**63 else mixed


@functools.cache
def _callbacks(level: str) -> dict[str, int]:
    # Addresses of what stands in for each function; compiled on first use.
    from lir_element.opensees.block.hosted import entries_of
    from lir_element.opensees.kernels import callbacks

    entries = entries_of(level)
    functions = {
        "update": entries.update,
        "commit_state": entries.commit_state,
        "tangent_stiff": entries.tangent_stiff,
        "initial_stiff": callbacks.initial_stiff,
        "resisting_force": callbacks.resisting_force,
        "resisting_force_with_inertia": callbacks.resisting_force,
        "damping": callbacks.zero_matrix,
        "mass": callbacks.zero_matrix,
        "revert_to_last_commit": callbacks.revert_to_last_commit,
        "revert_to_start": callbacks.revert_to_start,
        "set_response": callbacks.set_response,
        "get_response": callbacks.get_response,
        "destroy": callbacks.destroy,
        "destroy_free": callbacks.destroy_free,
    }
    return {name: function.address for name, function in functions.items()}


def _call(name: str, *arguments: int) -> int:
    # A function of the library: addresses are 64 bits wide, tags and counts fit in them too.
    kinds = [ctypes.c_int64] * len(arguments)
    return int(ctypes.CFUNCTYPE(ctypes.c_int64, *kinds)(addresses()[name])(*arguments))


def _word(address: int) -> int:
    return int(ctypes.c_int64.from_address(address).value)


def _field(records: Records, name: str) -> int:
    # Address of a field of the first record.
    return int(records.ctypes.data) + offset_of(records.dtype, name)
