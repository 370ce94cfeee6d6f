"""Addresses of the functions that the in-process coupling calls or replaces in OpenSees."""

from __future__ import annotations

import ctypes
import functools
import sys
from pathlib import Path

_LIBRARIES = ("openseespylinux.opensees", "openseespymac.opensees")

REPLACED = {
    "update": "_ZN13GenericClient6updateEv",
    "commit_state": "_ZN13GenericClient11commitStateEv",
    "tangent_stiff": "_ZN13GenericClient15getTangentStiffEv",
    "initial_stiff": "_ZN13GenericClient15getInitialStiffEv",
    "resisting_force": "_ZN13GenericClient17getResistingForceEv",
    "resisting_force_with_inertia": "_ZN13GenericClient27getResistingForceIncInertiaEv",
    "damping": "_ZN13GenericClient7getDampEv",
    "mass": "_ZN13GenericClient7getMassEv",
    "revert_to_last_commit": "_ZN13GenericClient18revertToLastCommitEv",
    "revert_to_start": "_ZN13GenericClient13revertToStartEv",
    "set_response": "_ZN13GenericClient11setResponseEPPKciR10OPS_Stream",
    "get_response": "_ZN13GenericClient11getResponseEiR11Information",
    "print_element": "_ZN13GenericClient5PrintER10OPS_Streami",
    "send_self": "_ZN13GenericClient8sendSelfEiR7Channel",
    "receive_self": "_ZN13GenericClient8recvSelfEiR7ChannelR16FEM_ObjectBroker",
    "destroy": "_ZN13GenericClientD1Ev",
    "destroy_free": "_ZN13GenericClientD0Ev",
}
"""Virtual functions of the host element."""

OPTIONAL = {"class_type": "_ZNK13GenericClient12getClassTypeEv"}
"""A function that is replaced if the library exports it: the compiler may leave it out."""

REPLACED_AGAIN = {
    "class_type": "_ZThn16_NK13GenericClient12getClassTypeEv",
    "send_self": "_ZThn16_N13GenericClient8sendSelfEiR7Channel",
    "receive_self": "_ZThn16_N13GenericClient8recvSelfEiR7ChannelR16FEM_ObjectBroker",
}
"""Functions that are also called through the element's second base class, in its table."""

CALLED = {
    "get_domain": "_Z14ops_getdomain_v",
    "get_element": "_ZN6Domain10getElementEi",
    "get_node": "_ZN6Domain7getNodeEi",
    "get_displacement": "_ZN4Node12getTrialDispEv",
    "get_velocity": "_ZN4Node11getTrialVelEv",
    "get_time": "_ZNK6Domain14getCurrentTimeEv",
    "step_size": "ops_Dt",
    "new_vector": "_ZN6VectorC1EPdi",
    "new_matrix": "_ZN6MatrixC1EPdii",
    "new_response": "_ZN15ElementResponseC1EP7ElementiRK6Vector",
    "set_vector": "_ZN11Information9setVectorERK6Vector",
    "allocate": "_Znwm",
    "table": "_ZTV13GenericClient",
    "stream_table": "_ZTV10FileStream",
    "write_text": "_ZN10FileStreamlsEPKc",
}
"""Functions that are called, and data that are read."""


class NotPossibleError(RuntimeError):
    """Raised if the in-process coupling is not possible here; the message has the reason."""


@functools.cache
def library() -> ctypes.CDLL:
    """Return the OpenSees library that openseespy has loaded."""
    return ctypes.CDLL(str(library_path()))


def library_path() -> Path:
    """Return the file of the OpenSees library that openseespy has loaded."""
    for name in _LIBRARIES:
        origin = getattr(sys.modules.get(name), "__file__", None)
        if origin is not None:
            return Path(origin)
    msg = f"openseespy for {sys.platform} does not export the functions of its elements"
    raise NotPossibleError(msg)


@functools.cache
def addresses() -> dict[str, int]:
    """Return the addresses of all that is named above; of `REPLACED_AGAIN` as "again_..."."""
    found = {}
    again = {f"again_{name}": symbol for name, symbol in REPLACED_AGAIN.items()}
    for name, symbol in {**REPLACED, **OPTIONAL, **again, **CALLED}.items():
        try:
            function = getattr(library(), symbol)
        except AttributeError as cause:
            if name.removeprefix("again_") in OPTIONAL:
                continue
            msg = f"the OpenSees library does not export {symbol}"
            raise NotPossibleError(msg) from cause
        found[name] = int(ctypes.cast(function, ctypes.c_void_p).value or 0)
    return found
