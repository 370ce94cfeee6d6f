"""A frame prepared for time histories: data that its runs share, and arrays that each changes.

A time history of a small building takes as long to set up as to integrate. Prepared frames are kept
by the parts of their frame: these are frozen, so a changed frame has others.
"""

from __future__ import annotations

import copy
import gc
import sys
import threading
import types
import warnings
from functools import cached_property
from time import perf_counter
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy import sparse

from frames._errors import ModelWarning
from frames._fingerprint import fingerprint
from frames.bundles.nonlinear_data import NonlinearElements, part_sizes
from frames.bundles.run_data import AT_REST, STILL, output_arrays, run_arrays
from frames.kernels.integration import integrate_chunk
from frames.model import sanity_checks
from frames.model.components import bearing_axial_stiffness, bearing_rocking_stiffness
from frames.model.superelement import Superelement
from frames.recording.dataset import build_dataset, common_of
from frames.recording.force_rows import force_maps
from frames.recording.peak_tracking import can_track, devices_of, kinematics_of, shape_of
from frames.recording.reduction import with_peak_state, without_histories_of
from frames.statics.gravity import equilibrium_of
from frames.statics.springs import plane_coupling
from lir_element.bundles.contact_data import detached
from lir_element.texts import worded

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    import xarray as xr

    from frames.bundles.peak_data import Devices, Shape
    from frames.model.frame_data import FrameData
    from frames.recording.dataset import Common
    from frames.recording.force_rows import ForceMaps
    from frames.recording.peak_tracking import Kinematics
    from frames.recording.reduction import PeakState
    from frames.statics.gravity_state import GravityState
    from lir_element import Features

MOST_BYTES = 64e6
"""Memory that a process keeps analyses in [bytes]; one that is larger is set up each time."""

_REMADE = frozenset({"reduced", "inverse_e", "follow_e", "lead_e", "follow", "pool"})
# of step sizes: the loop renews them, see `has_reduced`

_LEAST = 0.1
_HOLDING = bearing_axial_stiffness, bearing_rocking_stiffness
# a structure that bearings hold is held by others that are a tenth as stiff

_TAKEN = threading.Lock()
_CODE = (type, types.ModuleType, types.FunctionType, types.BuiltinFunctionType, types.MethodType)


class PreparedFrame:
    """A frame in equilibrium under gravity, and the results that depend on it alone.

    No run changes it: runs work in arrays of their own (`fresh`, `restart`). The equilibrium is
    found here if none is given. Data that two threads form at once are formed twice, with equal
    values. `like` is another one with these features and levels: equal parts are not formed again.
    """

    def __init__(
        self,
        model: FrameData,
        features: Features,
        level: str | Mapping[str, str],
        state: GravityState | None = None,
        like: PreparedFrame | None = None,
    ) -> None:
        self.model = copy.copy(model)  # as it is now
        self.features, self.level = features, level
        self.parts = list(_parts(vars(model)))
        """Parts of the model, its key in the store."""
        self._judged: xr.Dataset | None = None
        if state is None:
            before = like.state if like is not None and like.has_structure_of(self) else None
            state = equilibrium_of(model, features, level, before)
        self.state: GravityState = state
        if like is not None:
            self._take(like)

    def _take(self, like: PreparedFrame) -> None:
        # Data formed of the structure, or different in numbers that runs replace.
        self.common = common_of(self.model, self.state, like.common)
        if "shape" in vars(like) and self.common.resultants is like.common.resultants:
            self.shape = like.shape
        moves = self.state.system.moves_as(like.state.system) and self.common.moves_as(like.common)
        if "kinematics" in vars(like) and moves:
            self.kinematics = like.kinematics
        same = all(
            self.state.model.props[name].any() == like.state.model.props[name].any()
            for name in ("heats", "goes_on")
        )
        if same and self.common.is_laid_out_as(like.common):
            self._judged = like._judged
            if "template" in vars(like):
                self.at_rest, self.template = like.at_rest, like.template

    def has_structure_of(self, other: PreparedFrame) -> bool:
        """Return True if another one has such bearings as these, apart from their numbers."""
        links, others = (each.model.bearings.values() for each in (self, other))
        count = len(self.parts) - 2 * len(links) - 2  # names and links, and the ends of dicts
        return (
            len(self.parts) == len(other.parts)
            and all(map(_is_same, self.parts[:count], other.parts))
            and all(
                (a.name, a.i, a.j) == (b.name, b.i, b.j)
                and all(_LEAST <= of(a.bearing) / of(b.bearing) <= 1.0 / _LEAST for of in _HOLDING)
                for a, b in zip(links, others, strict=True)
            )
        )

    def fresh(self, seconds: float | None = None) -> GravityState:
        """Return the state at rest for one run to change; derived data are shared."""
        shared = self.state
        if shared.parts is not None:
            _ = shared.part_shift
        mine = copy.copy(shared)
        own: dict[str, Any] = {"run": run_arrays(shared.model)}
        if seconds is not None:
            own["seconds"] = seconds
        if shared.contacts is not None:
            own["contacts"] = detached(shared.contacts)
        if shared.parts is not None:
            own["parts"] = NonlinearElements(*(array.copy() for array in shared.parts))
        vars(mine).update(own)
        self.restart(mine)
        return mine

    def restart(self, mine: GravityState) -> None:
        """Reset a state of `fresh` to rest."""
        shared = self.state
        spared = frozenset() if shared.run.has_reduced.any() else _REMADE
        for name in ("run", "contacts", "parts"):
            own, rest = getattr(mine, name), getattr(shared, name)
            for field in () if own is None else own._fields:
                if field not in spared:
                    getattr(own, field)[...] = getattr(rest, field)

    @cached_property
    def attrs(self) -> dict[str, object]:
        """Attributes of all results."""
        level, features = self.level, self.features
        return {
            "title": worded("time history of {name}", name=self.model.name),
            "level": level if isinstance(level, str) else str(dict(level)),
            "features_left_out": ", ".join(features.left_out) or "none",
            "plane_coupling": 0.0 if features.second_direction else plane_coupling(self.model),
        }

    @cached_property
    def common(self) -> Common:
        """Common data of all results of the structure."""
        return common_of(self.model, self.state)

    @cached_property
    def can_track(self) -> bool:
        """True if the peaks of a run can be found without Datasets."""
        return can_track(self.state)

    @cached_property
    def devices(self) -> Devices:
        """Input of the bearings' peaks."""
        return devices_of(self.state)

    @cached_property
    def kinematics(self) -> Kinematics:
        """Places and motions of the nodes."""
        transform = sparse.csr_array(self.state.system.transform)
        return kinematics_of(transform, self.common.of_structure())

    @cached_property
    def shape(self) -> Shape:
        """Input of the structure's peaks."""
        accelerating = self.common.resultants.accelerating
        return shape_of(self.state, accelerating, self.kinematics)

    @cached_property
    def force_maps(self) -> ForceMaps:
        """Maps from the recorded quantities to forces."""
        return force_maps(self.model, self.state)

    @cached_property
    def at_rest(self) -> xr.Dataset:
        """The result of the state at rest alone."""
        state = self.state
        out, states, bodies = output_arrays(state.model, state.contacts, 1, part_sizes(state.parts))
        kept = state.model, state.run, state.contacts, state.parts
        integrate_chunk(*kept, AT_REST, STILL, out, 0, 0)
        return build_dataset(self.common, state, STILL, np.zeros(3), out, states, bodies, 1)

    @cached_property
    def template(self) -> xr.Dataset:
        """Input of the assumption check and of the tables of peaks."""
        return without_histories_of(self.at_rest)

    def judged(self, data: xr.Dataset, found: PeakState) -> xr.Dataset:
        """Return the check's input of a run with all histories and the peaks `found`."""
        if self._judged is None:
            self._judged = with_peak_state(data.drop_dims("time"), found)
        return self._judged

    @cached_property
    def doubts(self) -> tuple[str, ...]:
        """Unusual properties of the model, as in the warnings of `gravity`."""
        return (*sanity_checks.sanity_warnings(self.model), *self.state.doubts)

    @cached_property
    def bytes(self) -> float:
        """Memory of all that it refers to, code aside: with the data formed by its runs [bytes]."""
        seen: dict[int, object] = {}
        todo: list[object] = [self]
        while todo:
            fresh = {id(o): o for o in todo if id(o) not in seen and not isinstance(o, _CODE)}
            seen |= fresh
            todo = gc.get_referents(*fresh.values())
            todo += [one.base for one in fresh.values() if isinstance(one, np.ndarray)]
        return float(sum(map(sys.getsizeof, seen.values())))

    def is_of(self, parts: list[object], features: Features, level: object) -> bool:
        """Return True if these are its parts: by identity, because its parts are not replaced."""
        alike = len(self.parts) == len(parts) and (self.features, self.level) == (features, level)
        return alike and all(a is b for a, b in zip(self.parts, parts, strict=True))


_KEPT: list[PreparedFrame] = []  # the last one used is at the end


def analysis_of(
    frame: FrameData, features: Features, level: str | Mapping[str, str]
) -> tuple[PreparedFrame, GravityState]:
    """Return the analysis of a frame, kept from before if nothing changed, and a fresh state."""
    began = perf_counter()
    parts = list(_parts(vars(frame)))
    with _TAKEN:
        known = (kept for kept in reversed(_KEPT) if kept.is_of(parts, features, level))
        found = next(known, None)
        if found is not None:
            _KEPT.remove(found)
            _KEPT.append(found)
        alike = [kept for kept in _KEPT if (kept.features, kept.level) == (features, level)]
    if found is None:
        kept_level = level if isinstance(level, str) else dict(level)
        found = PreparedFrame(frame, features, kept_level, like=alike[-1] if alike else None)
        state = found.fresh()
        _keep(found)
        return found, state
    for doubt in found.doubts:
        warnings.warn(doubt, ModelWarning, stacklevel=3)
    return found, found.fresh(perf_counter() - began)


def _keep(new: PreparedFrame) -> None:
    room = MOST_BYTES - _arrays(new.state)
    if room < 0.0:
        return
    with _TAKEN:
        sizes = [kept.bytes for kept in _KEPT]
        while sum(sizes) > room:
            del _KEPT[0], sizes[0]
        _KEPT.append(new)


def _arrays(state: GravityState) -> float:
    # Bytes of the largest arrays, before any run formed more.
    arrays = [*state.run, *state.model, *(state.parts or ())]
    arrays += [value for value in vars(state.basis).values() if isinstance(value, np.ndarray)]
    return float(sum(array.nbytes for array in arrays))


def _is_same(a: object, b: object) -> bool:
    # Numbers of two frames that were sent together are no longer one object.
    return a is b or (type(a) is type(b) is float and a == b)


def _parts(frame: Mapping[str, object]) -> Iterator[object]:
    # Parts of a frame, its bearings last.
    links = {"_bearings": frame["_bearings"]}
    yield from _pieces({name: each for name, each in frame.items() if name not in links})
    yield from _pieces(links)


def _pieces(value: object) -> Iterator[object]:
    # Parts of a frame, down to frozen ones; matrices of superelements, which are not, as text.
    if isinstance(value, dict):
        yield dict
        for key, each in value.items():
            yield key
            yield from _pieces(each)
        yield None
    elif isinstance(value, Superelement):
        yield sys.intern(fingerprint(value))
    else:
        yield value
