"""Bearings in the current OpenSeesPy model: their elements and their responses."""

from __future__ import annotations

import atexit
import functools
import os
import warnings
from collections.abc import Sequence
from typing import Any, Literal

import numpy as np

from lir_element.argument_checks import require_choice
from lir_element.device.bearing import LIRBearing
from lir_element.device.features import LEVELS, Level
from lir_element.opensees.connection import add_host_element, restart_reads, signals_held
from lir_element.opensees.element_memory import ElementMemory, entries_of
from lir_element.opensees.in_process.in_process_element import InProcessElement
from lir_element.opensees.in_process.selftest import why_not_fast
from lir_element.opensees.in_process.symbols import NotPossibleError
from lir_element.opensees.library import XaraCommands, commands_of
from lir_element.opensees.out_of_process.remote import (
    ForkedElements,
    Remote,
    RouteWarning,
    Server,
    ServerError,
)
from lir_element.opensees.out_of_process.responses import HostOverrides
from lir_element.opensees.placement import PlacedBearing, place

Route = Literal["auto", "fast", "portable"]
ROUTES = ("auto", "fast", "portable")
Tangent = Literal["consistent", "symmetric"]
TANGENTS = ("consistent", "symmetric")
_LARGEST_TAG = 2**31 - 1
_XARA = "the library of xara exports neither ops_getdomain_ nor Node::getTrialDisp"


class _Session:
    # The bearings of this process by commands and tag, and the server that some of them have.

    def __init__(self) -> None:
        self.bearings: dict[tuple[Any, int], InProcessElement | Remote] = {}
        self.server: Server | None = None
        self.forked_elements: ForkedElements | None = None
        self.told = False

    @signals_held()
    def sweep(self) -> None:
        """Release the memory of bearings that OpenSees has deleted."""
        tags = functools.cache(element_tags)
        for (ops, tag), bearing in list(self.bearings.items()):
            if not bearing.alive or tag not in tags(ops):
                del self.bearings[ops, tag]
                bearing.release()

    def running_server(self) -> Server:
        """Return the server, started if there is none."""
        if self.server is not None and not self.server.alive:
            if any(each.server is self.server for each in self._remotes()):
                raise ServerError(self.server.end_message())
            self.server.close()
            self.server = None
        if self.server is None:
            self.server = Server()
        return self.server

    @signals_held()  # an element that was left out would write to a closed connection for ever
    def close(self) -> None:
        """End the process in good order: OpenSees' own exit comes after Python's."""
        for bearing in self.bearings.values():
            bearing.detach()
        if self.server is not None:
            self.server.close()
        if self.forked_elements is not None:
            self.forked_elements.close()

    def forget(self) -> None:
        """Reset in a forked process: connections and server are the parent's."""
        remotes = self._remotes()
        self.bearings = {
            key: each for key, each in self.bearings.items() if isinstance(each, InProcessElement)
        }
        if remotes:
            self.forked_elements = ForkedElements(remotes)
        if self.server is not None:
            self.server.leave()
            self.server = None

    def _remotes(self) -> list[Remote]:
        return [each for each in self.bearings.values() if isinstance(each, Remote)]


def element_tags(ops: Any) -> frozenset[int]:
    """Return the tags of all elements of the model."""
    return frozenset(ops.getEleTags() or ())


_SESSION = _Session()
atexit.register(_SESSION.close)
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_SESSION.forget)


def bearing_element(
    tag: int,
    i: int,
    j: int,
    bearing: LIRBearing,
    level: Level = "pendulum",
    orient: Sequence[float] | None = None,
    route: Route = "auto",
    *,
    length_unit: float = 1.0,
    force_unit: float = 1.0,
    tangent: Tangent = "consistent",
    ops: Any = None,
) -> str:
    """Add a bearing to the current OpenSeesPy model, or to a model of xara.

    Parameters
    ----------
    tag : int
        Tag of the new element.
    i, j : int
        Nodes below and above, coincident or `bearing.height` apart along the bearing's axis.
    bearing : LIRBearing
        The device; `bearing.as_dcfp()` is the plain DCFP.
    level : {"pendulum", "contact"}
        Level of fidelity.
    orient : sequence of 3 or 6 floats, optional
        Direction of the bearing's axis from node i to node j in global axes, and optionally that
        of its x axis. By default the axis points along global Z (in two dimensions Y) and x
        along X.
    route : {"auto", "fast", "portable"}
        "fast" determines states in this process, "portable" in another process that OpenSees calls.
        "auto" is "fast" if this build of OpenSees allows it.
    length_unit, force_unit : float
        The model's units [m], [N]: 0.001 and 1000 for mm and kN. Time is in seconds.
    tangent : {"consistent", "symmetric"}
        "symmetric" for symmetric systems of equations (ProfileSPD, BandSPD, SparseSYM); see the
        notes.
    ops : xara.Model, optional
        The model, if it is one of xara, or its module `opensees.openseespy`. By default that of
        OpenSeesPy.

    Returns
    -------
    str
        The coupling route, "fast" or "portable".

    Raises
    ------
    ValueError
        If an option or a node does not suit; the model is unchanged.
    RuntimeError
        If the requested route is not possible.

    Notes
    -----
    The tangent is unsymmetric, because friction depends on the axial force: choose a system of
    equations for unsymmetric matrices (UmfPack, BandGeneral, FullGeneral). A symmetric one uses
    half of the tangent and finds no equilibrium; ``tangent="symmetric"`` is for it, and leaves out
    the effect of axial forces on friction. Answers are the same, with more iterations.

    Without velocities a trial is static, as for OpenSees' own bearings: friction then is that at
    low speed. A step that leads beyond a limit of the bearing is committed, and the next one fails;
    why, is written to standard error.

    Examples
    --------
    >>> from lir_element import CoulombFriction, LIRBearing
    >>> from lir_element.opensees import bearing_element, opensees
    >>> ops = opensees()
    >>> ops.wipe()
    >>> ops.model("basic", "-ndm", 3, "-ndf", 6)
    >>> ops.node(1, 0.0, 0.0, 0.0)
    >>> ops.node(2, 0.0, 0.0, 0.0)
    >>> ops.fix(1, 1, 1, 1, 1, 1, 1)
    >>> bearing = LIRBearing(radius=0.75, slider_height=0.085, slider_radius=0.08, capacity=0.175,
    ...                      friction=CoulombFriction(0.066), interface_friction=0.126)
    >>> bearing_element(1, 1, 2, bearing) in {"fast", "portable"}
    True
    >>> ops.wipe()
    """
    _check(tag, bearing, level, route)
    tag = int(tag)
    require_choice("tangent", tangent, TANGENTS)
    ops = commands_of(ops)
    if tag in element_tags(ops):
        msg = f"element {tag} is in the model already: choose another tag"
        raise ValueError(msg)
    _SESSION.sweep()
    placement = place(ops, i, j, bearing, orient, length_unit, force_unit)
    placed = PlacedBearing(tag, bearing, level, placement, tangent == "symmetric")
    why_not = _XARA if isinstance(ops, XaraCommands) else why_not_fast()
    chosen = _choose(route, why_not)
    if chosen == "fast":
        entries_of(level)  # compiles on first use, which Ctrl-C may end
    with signals_held():
        _SESSION.bearings[ops, tag] = (
            _add_fast(ops, placed)
            if chosen == "fast"
            else _add_portable(ops, placed, overridden=not why_not)
        )
    return chosen


def bearing_response(tag: int, name: str, ops: Any = None) -> Any:
    """Return a response of a bearing as of the last committed step.

    Parameters
    ----------
    tag : int
        Tag of the bearing's element.
    name : str
        One of `Element.responses()`, in bearing axes and SI units; or a name of OpenSees' own
        bearings, in the model's units, as for `eleResponse` and recorders. "globalForce" is in the
        model's axes; "localForce", "basicForce", "localDisplacement" and "deformation" are in local
        axes (x along the bearing's axis, y its x axis, z its y axis). "basicForce" is the force on
        node j, "deformation" its motion relative to node i. Or "route".
    ops : xara.Model, optional
        As for `bearing_element`.

    Returns
    -------
    object
        A number or an array.

    Raises
    ------
    ValueError
        If there is no such bearing in the model.
    KeyError
        If there is no such response; the message lists all.

    Examples
    --------
    >>> from lir_element import LIRBearing
    >>> from lir_element.opensees import bearing_element, bearing_response, opensees
    >>> ops = opensees()
    >>> ops.wipe()
    >>> ops.model("basic", "-ndm", 3, "-ndf", 6)
    >>> ops.node(1, 0.0, 0.0, 0.0)
    >>> ops.node(2, 0.0, 0.0, 0.0)
    >>> ops.fix(1, 1, 1, 1, 1, 1, 1)
    >>> bearing = LIRBearing(radius=0.75, slider_height=0.085, slider_radius=0.08, capacity=0.175,
    ...                      friction=0.066, interface_friction=0.126)
    >>> route = bearing_element(10, 1, 2, bearing)
    >>> float(bearing_response(10, "axial_force"))
    0.0
    >>> ops.wipe()
    """
    bearing = bearing_at(tag, ops)
    return bearing.route if name == "route" else bearing.response(name)


def bearing_tags(ops: Any = None) -> tuple[int, ...]:
    """Return the tags of all bearings in the current model.

    Parameters
    ----------
    ops : xara.Model, optional
        As for `bearing_element`.

    Returns
    -------
    tuple of int
        Tags, in the order in which the bearings were added.

    Examples
    --------
    >>> from lir_element import LIRBearing
    >>> from lir_element.opensees import bearing_element, bearing_tags, opensees
    >>> ops = opensees()
    >>> ops.wipe()
    >>> ops.model("basic", "-ndm", 3, "-ndf", 6)
    >>> ops.node(1, 0.0, 0.0, 0.0)
    >>> ops.node(2, 0.0, 0.0, 0.0)
    >>> ops.fix(1, 1, 1, 1, 1, 1, 1)
    >>> bearing = LIRBearing(radius=0.75, slider_height=0.085, slider_radius=0.08, capacity=0.175,
    ...                      friction=0.066, interface_friction=0.126)
    >>> route = bearing_element(10, 1, 2, bearing)
    >>> bearing_tags()
    (10,)
    >>> ops.wipe()
    """
    _SESSION.sweep()
    host = commands_of(ops)
    return tuple(tag for each, tag in _SESSION.bearings if each is host)


def bearing_at(tag: int, ops: Any = None) -> InProcessElement | Remote:
    """Return the object behind a bearing's element."""
    host = commands_of(ops)
    found = _SESSION.bearings.get((host, tag))
    if found is None or tag not in element_tags(host) or not found.alive:
        msg = f"element {tag} is not a bearing of the current model: it has {bearing_tags(host)}"
        raise ValueError(msg)
    return found


def _check(tag: object, bearing: object, level: str, route: str) -> None:
    if isinstance(tag, bool) or not isinstance(tag, (int, np.integer)):
        msg = f"tag = {tag!r} must be an integer"
        raise TypeError(msg)
    if abs(int(tag)) > _LARGEST_TAG:
        msg = f"tag = {tag} exceeds the largest tag of OpenSees: choose one up to {_LARGEST_TAG}"
        raise ValueError(msg)
    if not isinstance(bearing, LIRBearing):
        msg = f"bearing = {bearing!r} must be an LIRBearing"
        raise TypeError(msg)
    require_choice("level", level, LEVELS)
    require_choice("route", route, ROUTES)


def _choose(route: str, reason: str) -> str:
    if route == "portable":
        return route
    if not reason:
        return "fast"
    if route == "fast":
        msg = f'the in-process coupling is not possible: {reason}; use route="portable"'
        raise NotPossibleError(msg)
    if not _SESSION.told:
        _SESSION.told = True
        msg = (
            "the out-of-process coupling is used (same results, several times slower), "
            f"because the in-process one is not possible: {reason}"
        )
        warnings.warn(msg, RouteWarning, stacklevel=3)
    return "portable"


def _add_fast(ops: Any, placed: PlacedBearing) -> InProcessElement:
    hosted = ElementMemory(placed)
    connection = add_host_element(ops, placed.tag, placed.placement)
    try:
        return InProcessElement(hosted, connection)
    except NotPossibleError:
        ops.remove("element", placed.tag)
        connection.close()
        raise


def _add_portable(ops: Any, placed: PlacedBearing, *, overridden: bool) -> Remote:
    remote = Remote(_SESSION.running_server(), placed, ops)
    connection = add_host_element(ops, placed.tag, placed.placement)
    try:
        remote.connect(connection)
        if overridden:
            remote.override(HostOverrides(placed))
        else:
            restart_reads(restart=True)
    except (ServerError, ValueError, NotPossibleError):
        ops.remove("element", placed.tag)
        remote.release()
        connection.close()
        raise
    return remote
