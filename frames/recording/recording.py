"""Content of a recording: steps, variables, bearings, nodes, or only peaks."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Self

from frames._errors import likely
from frames.bundles.nonlinear_data import part_sizes
from frames.results.recorded import ENDS, EVERY_STEP
from lir_element.argument_checks import require_non_negative, require_positive, require_type
from lir_element.layout import BODIES, STATE
from lir_element.units import meant

if TYPE_CHECKING:
    import xarray as xr

    from frames.statics.gravity_state import GravityState

_NAMES = {
    "channels": "variables (docs/results.md)",
    "bearings": "bearings",
    "nodes": "nodes",
    "levels": "levels",
}


@dataclass(frozen=True, kw_only=True)
class Recording:
    """Content of a time history's record; its parts combine.

    For any omission the run keeps the peaks of all its base steps: `peaks`, the assumption check
    and the energy balance need them. It needs no more memory than the record and a buffer of some
    64 MB.

    Parameters
    ----------
    every : int or None
        Every so many base steps, the first one included. None: the first and the last only.
    channels : sequence of str, optional
        Variables by name, as in docs/results.md, such as "bearing_displacement"; all if None.
        Variables without the dimension `time` are always kept.
    bearings : sequence of str, optional
        Names of the bearings recorded; all if None.
    nodes : sequence of str, optional
        Names of the nodes recorded; all if None, and no level is named either.
    levels : sequence of str, optional
        Names of levels whose nodes are recorded, besides `nodes`.
    around_impacts : (float, float), optional
        All steps from this time before to this time after each rim contact [s], for any `every`; a
        contact is a base step at which a slider presses on a rim.
    extremes : bool
        True to keep the largest and the smallest value of every recorded variable, and their times,
        over all base steps: read them by ``envelope(data, variable)``.
    forces : bool
        True to keep the largest and smallest forces in members, storeys and under bearings, each
        with the others at its instant, over all base steps: the variables ``peak_member_force``,
        ``peak_storey_force`` and ``peak_reaction_force`` (docs/recording.md).

    Raises
    ------
    ValueError
        If a value is out of its bounds, or a list of names is empty.
    TypeError
        If a value is of another kind.

    Examples
    --------
    >>> Recording(every=10, channels=("bearing_force", "energy"))
    Recording(every=10, channels=('bearing_force', 'energy'))
    >>> print(Recording.impacts(before=0.2, after=0.5, every=20))
    every 20th step, all from 0.2 s before to 0.5 s after rim contact
    >>> print(Recording.peaks())
    first and last step, extremes of all
    """

    every: int | None = 1
    channels: tuple[str, ...] | None = None
    bearings: tuple[str, ...] | None = None
    nodes: tuple[str, ...] | None = None
    levels: tuple[str, ...] | None = None
    around_impacts: tuple[float, float] | None = None
    extremes: bool = False
    forces: bool = False

    def __post_init__(self) -> None:
        """Check the fields, and keep sequences as tuples."""
        if self.every is not None:
            object.__setattr__(self, "every", whole_steps("every", self.every))
        for name in _NAMES:
            object.__setattr__(self, name, _names(name, getattr(self, name)))
        if self.around_impacts is not None:
            object.__setattr__(self, "around_impacts", _window(self.around_impacts))
        require_type("extremes", self.extremes, bool, "True or False")
        require_type("forces", self.forces, bool, "True or False")

    @classmethod
    def everything(cls) -> Self:
        """Return the recording of all base steps and all variables."""
        return cls()

    @classmethod
    def impacts(cls, before: float = 0.2, after: float = 0.5, every: int | None = 10) -> Self:
        """Return the recording of all steps around rim contacts [s], and every n-th elsewhere."""
        return cls(every=every, around_impacts=(before, after))

    @classmethod
    def peaks(cls) -> Self:
        """Return the recording of extremes alone, with the first and the last step."""
        return cls(every=None, extremes=True)

    @property
    def is_everything(self) -> bool:
        """True if nothing is left out, and nothing is added."""
        return self == type(self)()

    @property
    def names(self) -> tuple[str, ...]:
        """All names given: of channels, bearings, nodes and levels."""
        return tuple(name for kind in _NAMES for name in getattr(self, kind) or ())

    def __str__(self) -> str:
        """Return the content in words."""
        steps = ENDS if self.every is None else f"every {_ordinal(self.every)}step"
        parts = [EVERY_STEP if self.every == 1 else steps]
        if self.around_impacts is not None and self.every != 1:
            before, after = self.around_impacts
            parts.append(f"all from {before:g} s before to {after:g} s after rim contact")
        for name in _NAMES:
            chosen = getattr(self, name)
            if chosen is not None:
                parts.append(f"{name} {' '.join(chosen)}")
        if self.extremes:
            parts.append("extremes of all")
        if self.forces:
            parts.append("extremes of forces")
        return ", ".join(parts)

    def __repr__(self) -> str:
        """Return its constructor call, without defaults."""
        given = [
            f"{field.name}={getattr(self, field.name)!r}"
            for field in fields(self)
            if getattr(self, field.name) != field.default
        ]
        return f"Recording({', '.join(given)})"


def recording_of(recording: object, record_every: object) -> Recording:
    """Return the recording of `time_history` from its arguments."""
    every = whole_steps("record_every", record_every)
    if recording is None:
        return Recording(every=every)
    if not isinstance(recording, Recording):
        msg = (
            f"recording = {recording!r} must be a Recording, such as Recording(every=10) or "
            "Recording.peaks(), or None"
        )
        raise TypeError(msg)
    if every != 1:
        msg = (
            f"record_every = {every} and recording = {recording!r} conflict: pass "
            f"Recording(every={every}, ...) only"
        )
        raise ValueError(msg)
    return recording


def require_known(recording: Recording, data: xr.Dataset) -> None:
    """Refuse names that a model or its results do not have."""
    known = {
        "channels": [str(name) for name in data.data_vars if "time" in data[name].dims],
        "bearings": [str(name) for name in data["bearing"].to_numpy()],
        "nodes": [str(name) for name in data["node"].to_numpy()],
        "levels": [str(name) for name in data["level"].to_numpy()],
    }
    for kind, names in known.items():
        unknown = [name for name in getattr(recording, kind) or () if name not in names]
        if unknown and unknown[0] in data.variables:
            msg = f'{kind}: "{unknown[0]}" is always recorded: leave it out'
            raise ValueError(msg)
        if unknown:
            hint = likely(unknown[0], names) or "the model has none"
            msg = f'{kind}: "{unknown[0]}" is not among the {_NAMES[kind]} of this run: {hint}'
            raise ValueError(msg)


def whole_steps(name: str, value: object) -> int:
    """Return `value` as a whole number of at least 1, or raise."""
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if (not number and not hasattr(value, "__index__")) or isinstance(value, bool):
        msg = f"{name} = {value!r} must be a whole number of at least 1: count base steps"
        raise TypeError(msg)
    if not value >= 1 or value % 1:  # type: ignore[operator]
        msg = f"{name} = {value!r} must be a whole number of at least 1"
        raise ValueError(msg)
    return int(value)  # type: ignore[call-overload, no-any-return]


def _names(name: str, value: object) -> tuple[str, ...] | None:
    if value is None:
        return None
    if isinstance(value, str) or not hasattr(value, "__iter__"):
        msg = f"{name} = {value!r} must be a sequence of names: write {name}=({value!r},)"
        raise TypeError(msg)
    names = tuple(value)
    for one in names:
        require_type(f"{name}: {one!r}", one, str, "a name: a string")
    if not names:
        msg = f"{name} is empty: name at least one of the {_NAMES[name]}, or leave it out for all"
        raise ValueError(msg)
    return tuple(dict.fromkeys(names))


def _window(value: object) -> tuple[float, float]:
    if not isinstance(value, (tuple, list)) or len(value) != 2:
        msg = (
            f"around_impacts = {value!r} must be a pair of times (before, after) in s, such as "
            "(0.2, 0.5)"
        )
        raise TypeError(msg)
    before, after = value
    return (
        require_non_negative("before a rim contact", before, "s"),
        require_non_negative("after a rim contact", after, "s"),
    )


def _ordinal(number: int) -> str:
    last = {1: "st", 2: "nd", 3: "rd"}.get(number % 10, "th")
    return f"{number}{'th' if number // 10 % 10 == 1 else last} "


MOST_STEPS = 10**9
"""Steps beyond which a run is refused: the fastest would take an hour."""

COARSEST = 1.0
"""Step that resolves no earthquake [s]."""

USUAL_MEMORY = 8e9
"""Assumed memory if the system does not report it [bytes]."""

COPIES = 3.0
"""Size of the Dataset and of its input over that of the recorded states."""


def number_of_steps(duration: float, dt: float | None, largest: float) -> int:
    """Return the number of base steps of a run; refuse one without end."""
    step = largest if dt is None else require_positive("dt", dt, "s")
    if dt is not None and dt > duration * (1.0 + 1e-9):
        msg = (
            f"dt = {dt:g} s is longer than the run of {duration:g} s: give it in s (0.005 s "
            "is usual), or leave it out"
        )
        raise ValueError(msg)
    if dt is not None and dt > COARSEST:
        hint = meant(dt, "s", 1e-5, 0.05)
        msg = f"dt = {dt:g} s is longer than any step of an analysis, {COARSEST:g} s: {hint}"
        raise ValueError(msg)
    if duration / step > MOST_STEPS:
        msg = (
            f"duration = {duration:g} s in steps of {step:g} s makes {duration / step:.3g} "
            f"steps (at most {MOST_STEPS:g}): give both in s, shorten the run or use larger "
            "steps"
        )
        raise ValueError(msg)
    return max(1, math.ceil(duration / step - 1e-9))


def bytes_of_step(state: GravityState) -> float:
    """Return the memory of a step: of the states recorded, and of the Dataset made of them."""
    with_points = 0 if state.contacts is None else len(state.contacts.sliders)
    row = len(state.model.props) * STATE.itemsize + with_points * BODIES.itemsize
    row += 8 * (3 * len(state.run.b) + 2 * len(state.run.e) + 24 * len(state.system.node_names))
    deformations, parts, words = part_sizes(state.parts)
    row += 8 * (4 * deformations + parts * words)
    return COPIES * row


def require_memory(state: GravityState, records: int) -> None:
    """Refuse to record all variables of more steps than the machine's memory holds."""
    require_room(bytes_of_step(state), records)


def require_room(step: float, records: int, besides: float = 0.0) -> None:
    """Refuse to record more than the machine's memory holds."""
    needed, there = step * records + besides, memory()
    if needed > there:
        msg = (
            f"{records} recorded steps take about {1e-9 * needed:.3g} GB, the machine has "
            f"{1e-9 * there:.3g} GB: use record_every = {math.ceil(2.0 * needed / there)} or "
            "more (times the present one), fewer channels (frames.Recording), or a shorter "
            "run"
        )
        raise ValueError(msg)


def memory() -> float:
    """Return the machine's memory [bytes]."""
    try:
        return float(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
    except (AttributeError, OSError, ValueError):  # not on every system
        return USUAL_MEMORY


def bytes_over_time(data: xr.Dataset) -> float:
    """Return the memory of one recorded step of a result [bytes]."""
    histories = [data[name].nbytes for name in data.variables if "time" in data[name].dims]
    return float(sum(histories)) / data.sizes["time"]


def require_rows(needed: float, runs: int, asked: int) -> None:
    """Refuse more results of many runs than the machine's memory holds."""
    there = memory()
    if needed > there:
        msg = (
            f"the results of {runs} of {asked} runs need about {1e-9 * needed:.3g} GB, the "
            f"machine has {1e-9 * there:.3g} GB: call time_histories for fewer cases and "
            "save each, or use record=None (peaks only)"
        )
        raise ValueError(msg)
