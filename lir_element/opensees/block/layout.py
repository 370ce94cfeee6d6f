"""The blocks that compiled callbacks read: of a bearing in an OpenSees model, and of a guard.

Addresses are those of arrays and objects that Python owns (`ElementMemory` keeps them), or of
functions of the OpenSees library.
"""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np

from lir_element.layout import BODIES, STATE, Field, dtype_of

_ADDRESS = "i8"

MOST_DOFS = 12
"""Degrees of freedom of two nodes in a three-dimensional model."""

MESSAGES = 32
"""Room for messages: those of RunStatus by its codes, then the following."""
NEVER_LOADED = 24
LOAD_LOW = 25
LOAD_HIGH = 26
TOLD_ENOUGH = 27
NOT_SAVED = 28
HINT = 29

SHARED_FIELDS = (
    Field("dofs", "-", "", "degrees of freedom of both nodes in the model: 12 or 6", (), "i8"),
    Field("start", "-", "", "first entry of each row of the map to bearing axes", (13,), "i8"),
    Field("columns", "-", "", "the entries' columns", (36,), "i8"),
    Field("values", "", "", "their values: direction cosines, times the unit of length", (36,)),
    Field("force_factor", "", "", "forces in bearing axes to those of the model"),
    Field("time", "s", "t", "the model's time at the last trial"),
    Field("committed_time", "s", "t", "the model's time at the last commit"),
    Field("step", "s", "", "step from the last commit to the last trial"),
    Field("last_step", "s", "", "step from the commit before to the last commit"),
    Field("last_status", "-", "", "RunStatus code of the last trial", (), "i8"),
    Field("refused", "-", "", "RunStatus code of the first refusal since the commit", (), "i8"),
    Field("told", "-", "", "refusals told to the user", (), "i8"),
    Field("telling", "-", "", "message to tell after this trial; 0: none", (), "i8"),
    Field("unfinished", "-", "", "1 where a trial away from the commit was not accepted", (), "i8"),
    Field("design_load", "N", "W", "axial force that its stiffnesses belong to"),
    Field("load_seen", "-", "", "1 once the axial force was compared with that", (), "i8"),
    Field("symmetric", "-", "", "1 to hand over a symmetric tangent", (), "i8"),
    Field("has_tangent", "-", "", "0 to make from the trial, 1 made, 2 from the commit", (), "i8"),
    Field("loaded", "-", "", "1 once a committed state carried axial load", (), "i8"),
    Field("commits", "-", "", "commits since the start", (), "i8"),
    Field("u", "m, rad", "", "displacements in bearing axes", (12,)),
    Field("v", "m/s, rad/s", "", "velocities in bearing axes", (12,)),
    Field("element", "N/m", "", "tangent in bearing axes", (12, 12)),
    Field("element_made", "-", "", "1 where `element` is that of the last trial", (), "i8"),
    Field("left_known", "-", "", "1 where `left_over` is that of the last trial", (), "i8"),
    Field("start_u", "m, rad", "", "displacements at the step's start", (12,)),
    Field("last_u", "m, rad", "", "displacements of the trial before", (12,)),
    Field("last_force", "N, N m", "", "its forces", (12,)),
    Field("last_move", "m", "", "horizontal step that led to the trial before", (2,)),
    Field("move", "m", "", "horizontal step that led to the last trial", (2,)),
    Field("axial_row", "N/m", "", "row of the axial force in `element`", (12,)),
    Field("swings", "-", "", "turns in a row without getting closer", (), "i8"),
    Field("way", "-", "", "unit vector along which the iteration swings", (2,)),
    Field("between", "m", "", "positions along it with the solution between", (2,)),
    Field("left_over", "N", "", "force on node j that the last correction left over", (3,)),
    Field("host_u", "", "", "displacements in the model's DOFs and units", (MOST_DOFS,)),
    Field("host_v", "", "", "velocities", (MOST_DOFS,)),
    Field("force", "", "", "resisting forces in the model's DOFs and units", (MOST_DOFS,)),
    Field("tangent", "", "", "tangent by columns", (MOST_DOFS * MOST_DOFS,)),
    Field("initial", "", "", "stiffness at rest under the design load, by columns", (144,)),
    Field("props", "", "", "address of the properties", (), _ADDRESS),
    Field("old", "", "", "address of the committed state", (), _ADDRESS),
    Field("new", "", "", "address of the trial state", (), _ADDRESS),
    Field("first", "", "", "address of the state at the start", (), _ADDRESS),
    Field("work", "", "", "address of the scratch", (), _ADDRESS),
    Field("heat", "", "", "address of the parts of the temperatures", (), _ADDRESS),
    Field("point_count", "-", "", "contact points of all interfaces", (), "i8"),
    Field("row", "", "", "address of `Contacts.row`, and so on", (), _ADDRESS),
    Field("sliders", "", "", "", (), _ADDRESS),
    Field("points", "", "", "", (), _ADDRESS),
    Field("bodies_old", "", "", "", (), _ADDRESS),
    Field("bodies_new", "", "", "", (), _ADDRESS),
    Field("touch_old", "", "", "", (), _ADDRESS),
    Field("touch_new", "", "", "", (), _ADDRESS),
    Field("search_old", "", "", "", (), _ADDRESS),
    Field("search_new", "", "", "", (), _ADDRESS),
    Field("scratch", "", "", "", (), _ADDRESS),
    Field("bodies_first", "", "", "bodies and contacts at the start", (), _ADDRESS),
    Field("touch_first", "", "", "", (), _ADDRESS),
    Field("record_every", "-", "", "commits between two that are recorded; 0: none", (), "i8"),
    Field("record_left", "-", "", "commits until the next one", (), "i8"),
    Field("record_count", "-", "", "recorded states", (), "i8"),
    Field("record_room", "-", "", "states that the memory has room for", (), "i8"),
    Field("record", "", "", "address of the recorded states", (), _ADDRESS),
    Field("realloc", "", "", "address of the function that enlarges memory", (), _ADDRESS),
)
"""Fields of both routes."""

FAST_FIELDS = (
    Field("node_i", "", "", "address of the node below", (), _ADDRESS),
    Field("node_j", "", "", "address of the node above", (), _ADDRESS),
    Field("domain", "", "", "address of the domain", (), _ADDRESS),
    Field("step_size", "", "", "address of the step since the domain's last commit", (), _ADDRESS),
    Field("domain_time", "s", "t", "the domain's time at its last commit"),
    Field("get_displacement", "", "", "Node::getTrialDisp", (), _ADDRESS),
    Field("get_velocity", "", "", "Node::getTrialVel", (), _ADDRESS),
    Field("get_time", "", "", "Domain::getCurrentTime", (), _ADDRESS),
    Field("force_vector", "", "", "Vector over `force`", (), _ADDRESS),
    Field("tangent_matrix", "", "", "Matrix over `tangent`", (), _ADDRESS),
    Field("initial_matrix", "", "", "Matrix over `initial`", (), _ADDRESS),
    Field("zero_matrix", "", "", "Matrix of zeros", (), _ADDRESS),
    Field("alive", "-", "", "1 until OpenSees deletes the element", (), "i8"),
    Field("remote", "-", "", "1 where another process determines the states", (), "i8"),
    Field("failures", "-", "", "steps refused in a row", (), "i8"),
    Field("hinted", "", "", "address of a word: 1 once the hint was told", (), _ADDRESS),
    Field("host_force", "", "", "GenericClient::getResistingForce", (), _ADDRESS),
    Field("host_update", "", "", "GenericClient::update", (), _ADDRESS),
    Field("host_commit", "", "", "GenericClient::commitState", (), _ADDRESS),
    Field("host_tangent", "", "", "GenericClient::getTangentStiff", (), _ADDRESS),
    Field("host_initial", "", "", "GenericClient::getInitialStiff", (), _ADDRESS),
    Field("set_signals", "", "", "pthread_sigmask", (), _ADDRESS),
    Field("mask_mode", "-", "", "its SIG_SETMASK", (), "i8"),
    Field("all_signals", "-", "", "the set of all signals", (16,), "i8"),
    Field("own_signals", "-", "", "those held back before", (16,), "i8"),
    Field("type_name", "", "", "address of the element's type, a C string", (), _ADDRESS),
    Field("host_print", "", "", "GenericClient::Print", (), _ADDRESS),
    Field("stream_slot", "-", "", "place of `<<` for text in a stream's virtual table", (), "i8"),
    Field("json", "", "", "address of the element's line in a printed model", (), _ADDRESS),
    Field("host_table", "", "", "the host element's own virtual table", (), _ADDRESS),
    Field("destroy", "", "", "the host element's destructor", (), _ADDRESS),
    Field("destroy_free", "", "", "the destructor that also frees its memory", (), _ADDRESS),
    Field("host_set_response", "", "", "GenericClient::setResponse", (), _ADDRESS),
    Field("host_get_response", "", "", "GenericClient::getResponse", (), _ADDRESS),
    Field("new_response", "", "", "constructor of ElementResponse", (), _ADDRESS),
    Field("set_vector", "", "", "Information::setVector", (), _ADDRESS),
    Field("allocate", "", "", "operator new", (), _ADDRESS),
    Field("response_count", "-", "", "responses beside those of the host element", (), "i8"),
    Field("responses", "", "", "address of the table of responses", (), _ADDRESS),
    Field("write", "", "", "address of the function that writes to a file", (), _ADDRESS),
    Field("messages", "", "", "addresses of the messages by number", (MESSAGES,), _ADDRESS),
    Field("message_sizes", "", "", "their lengths", (MESSAGES,), "i8"),
)
"""Further fields of the callbacks of in-process coupling."""

FROM_DISPLACEMENT = -1
FROM_FORCE = -2
CONSTANT = -3
"""Sources of responses that are no words of the state."""

RESPONSE_FIELDS = (
    Field("name", "-", "", "hash of its name", (), "i8"),
    Field("source", "-", "", "first word in the committed state; or one of FROM_...", (), "i8"),
    Field("size", "-", "", "number of words", (), "i8"),
    Field("integer", "-", "", "1 where they are integers", (), "i8"),
    Field("map", "", "", "address of a matrix (size, dofs) for what `source` names", (), _ADDRESS),
    Field("vector", "", "", "address of the Vector over `values`", (), _ADDRESS),
    Field("values", "", "", "what is handed over", (12,)),
)


def offset_of(dtype: np.dtype[Any], name: str) -> int:
    """Return the place of a field in a record, in bytes."""
    record = np.zeros(1, dtype)
    return int(record[name].ctypes.data - record.ctypes.data)


HOST = dtype_of(SHARED_FIELDS + FAST_FIELDS)
RESPONSE = dtype_of(RESPONSE_FIELDS)

WORDS = np.dtype(np.int64)
NUMBERS = np.dtype(np.float64)
STATE_WORDS = STATE.itemsize // 8
BODY_WORDS = BODIES.itemsize // 8
RECORD_WORDS = 4 + STATE_WORDS + BODY_WORDS
"""Words of a recorded state: time, relative velocity of node j, state, bodies."""

Host: TypeAlias = Any
"""One record of dtype HOST, as kernels see it."""

Response: TypeAlias = Any
"""One record of dtype RESPONSE."""

MOST_CHANNELS = 1024
"""Bearings that can be served at a time by out-of-process coupling."""

GUARD_FIELDS = (
    Field("pipe", "-", "", "file descriptor of the pipe to the server; -1: none", (), "i8"),
    Field("stop", "-", "", "file descriptor that ends the thread when written to", (), "i8"),
    Field("channels", "-", "", "descriptors, and words of an answer", (MOST_CHANNELS, 2), "i8"),
    Field("polled", "-", "", "what `poll` reads and writes", (MOST_CHANNELS + 1,), "i8"),
    Field("answer", "-", "", "an answer: not a number", (MOST_DOFS * MOST_DOFS,)),
    Field("inbox", "-", "", "what is thrown away", (MOST_DOFS * MOST_DOFS,)),
    Field("message", "", "", "address of what the user is told", (), "i8"),
    Field("message_size", "-", "", "its length", (), "i8"),
    Field(
        "hinted", "", "", "address of a word: 1 keeps a failed step from being explained", (), "i8"
    ),
    Field("receive_flags", "-", "", "of `recv`: do not wait", (), "i8"),
    Field("send_flags", "-", "", "of `send`: do not wait, no signal", (), "i8"),
    Field("poll", "", "", "addresses of the system's functions", (), "i8"),
    Field("recv", "", "", "", (), "i8"),
    Field("send", "", "", "", (), "i8"),
    Field("write", "", "", "", (), "i8"),
)

GUARD = dtype_of(GUARD_FIELDS)

GuardBlock: TypeAlias = Any
"""One record of dtype GUARD."""

# Messages of a `genericClient` are vectors of float64 whose first entry names the action. Source:
# OpenSees documentation of the element, OpenFresco's remote test protocol, and the messages of the
# stock builds (the header first: eleven int32, the first the number of degrees of freedom, the last
# the length of all vectors).
SET_TRIAL = 3
COMMIT = 5
GET_FORCE = 10
GET_INITIAL = 12
GET_TANGENT = 13
GET_DAMPING = 14
GET_MASS = 15
END = 99

ANSWERED = frozenset({GET_FORCE, GET_INITIAL, GET_TANGENT, GET_DAMPING, GET_MASS})
"""Actions that are answered by one vector."""

HEADER_BYTES = 44
HEADER_WORDS = 11


def vector_length(dofs: int) -> int:
    """Return the length of all vectors: a matrix by columns, or action, motion and time."""
    return max(dofs * dofs, 3 * dofs + 2)
