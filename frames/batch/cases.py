"""The cases of many histories: structures, motions and scales by name, and how far they are."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple, TypeVar

from frames._progress_line import ProgressLine
from frames.model.frame_data import FrameData
from frames.motion.ground_motion import GroundMotion
from lir_element.argument_checks import require_finite, require_type

if TYPE_CHECKING:
    from collections.abc import Callable

T = TypeVar("T")

NOT_BUILT = "not_built"
"""Status of a campaign's run whose model could not be built or set up."""


class Case(NamedTuple):
    """One history: names of its structure and motion, and the factor on the motion."""

    model: str
    motion: str
    scale: float

    def __str__(self) -> str:
        """Return it in words."""
        return f'"{self.model}" under {self.scale:g} x "{self.motion}"'


class BatchProgress(NamedTuple):
    """Progress of `time_histories`.

    Attributes
    ----------
    done, total : int
        Runs.
    elapsed : float
        Time since the first began [s].
    failed : int
        Runs done that stopped before their end.
    taken : int
        Further runs that were complete before.
    reused : int
        Runs done that a campaign copied instead of computing them.

    Examples
    --------
    >>> from frames import time_histories
    >>> from frames.demo import example
    >>> frame, pulse = example()
    >>> told = []
    >>> runs = time_histories(frame, {"pulse": pulse}, progress=told.append, workers=1)
    >>> told[-1].done, told[-1].total, told[-1].failed
    (1, 1, 0)
    """

    done: int
    total: int
    elapsed: float
    failed: int
    taken: int = 0
    reused: int = 0

    @property
    def rate(self) -> float:
        """Runs done in a second [1/s]."""
        return self.done / self.elapsed if self.elapsed > 0.0 else math.nan

    @property
    def remaining(self) -> float:
        """Time that the others will take at that rate [s]."""
        return (self.total - self.done) / self.rate if self.done else math.nan

    def __str__(self) -> str:
        """Return it on one line."""
        before = f" ({self.taken} more were complete before)" if self.taken else ""
        if self.reused:
            before += f" ({self.done - self.reused} computed, {self.reused} taken over)"
        if not self.done:
            return f"{self.done} of {self.total} runs{before}"
        left = f", {_clock(self.remaining)} left" if self.done < self.total else ""
        stopped = f", {self.failed} stopped early" if self.failed else ""
        return f"{self.done} of {self.total} runs{before}, {self.rate:.3g} runs/s{left}{stopped}"


def _clock(seconds: float) -> str:
    if seconds < 120.0:
        return f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 7200.0 else f"{seconds / 3600.0:.1f} h"


def named_models(models: object) -> dict[str, FrameData]:
    """Return structures by name."""
    return _named("models", models, FrameData, "a Frame")


def named_motions(motions: object) -> dict[str, GroundMotion]:
    """Return ground motions by name, as `named_models` does structures."""
    return _named("motions", motions, GroundMotion, "a GroundMotion")


def grid(
    models: Mapping[str, object],
    motions: Mapping[str, object],
    scales: object,
    cases: object,
) -> list[Case]:
    """Return the cases in their order."""
    if cases is None:
        factors = _factors(scales)
        return [Case(m, g, s) for m in models for g in motions for s in factors]
    if scales is not None:
        msg = (
            "cases and scales are both given: leave scales out, because cases contain the "
            "scale of each run"
        )
        raise ValueError(msg)
    return _listed(cases, models, motions)


def _listed(
    cases: object, models: Mapping[str, object], motions: Mapping[str, object]
) -> list[Case]:
    if isinstance(cases, (str, Mapping)) or not isinstance(cases, Sequence):
        msg = f"cases = {cases!r} must be a sequence of (name of model, name of motion, scale)"
        raise TypeError(msg)
    found = []
    for one in cases:
        if not isinstance(one, Sequence) or isinstance(one, str) or len(one) != 3:
            msg = f"cases: {one!r} must be (name of model, name of motion, scale)"
            raise TypeError(msg)
        model, motion, scale = one
        for name, known, what in ((model, models, "model"), (motion, motions, "motion")):
            if name not in known:
                msg = f"cases: no {what} {name!r}; there are {', '.join(map(repr, known))}"
                raise ValueError(msg)
        found.append(Case(model, motion, _factor(scale)))
    return _unique(found, "cases")


def _factors(scales: object) -> list[float]:
    if scales is None:
        return [1.0]
    if isinstance(scales, (str, Mapping)) or not hasattr(scales, "__iter__"):
        return [_factor(scales)]
    return _unique([_factor(one) for one in scales], "scales")


def _factor(value: object) -> float:
    number = require_finite("scale of a motion", value)
    if not abs(number) > 0.0:
        msg = "the scale of a motion must not be 0: use 1 for the unscaled motion"
        raise ValueError(msg)
    return number


def _unique(values: list[T], what: str) -> list[T]:
    if not values:
        msg = f"{what} is empty: pass at least one"
        raise ValueError(msg)
    seen: set[T] = set()
    for value in values:
        if value in seen:
            msg = f"{what}: {value} occurs twice: list each once"
            raise ValueError(msg)
        seen.add(value)
    return values


def _named(what: str, given: object, kind: type[T], one: str) -> dict[str, T]:
    usage = f"{one}, or a sequence or mapping of them"
    if isinstance(given, kind):
        return {_own_name(given, what): given}
    if isinstance(given, Mapping):
        pairs = [(name, value) for name, value in given.items()]
    elif isinstance(given, Sequence) and not isinstance(given, str):
        pairs = [(_own_name(value, f"{what}[{k}]"), value) for k, value in enumerate(given)]
    else:
        require_type(what, given, kind, usage)
        pairs = []
    found: dict[str, T] = {}
    for name, value in pairs:
        require_type(f"{what}: {name!r}", name, str, "a name: a string")
        require_type(f"{what}: {name}", value, kind, one)
        if name in found:
            msg = (
                f'{what}: two have the name "{name}": pass a mapping with different names, '
                '{"first": ..., "second": ...}'
            )
            raise ValueError(msg)
        found[name] = value
    if not found:
        msg = f"{what} is empty: give {usage}"
        raise ValueError(msg)
    return found


def _own_name(value: object, otherwise: str) -> str:
    return str(getattr(value, "name", "") or otherwise)


def tell(progress: object) -> Callable[[BatchProgress], None] | None:
    """Return the listener to the progress: none, a function, or the standard error."""
    if progress is None or progress is False:
        return None
    if progress is True:
        line = ProgressLine()
        return lambda told: line.write(str(told), told.elapsed, ends=told.done == told.total)
    if not callable(progress):
        msg = f"progress = {progress!r} must be True, or a function of one BatchProgress"
        raise TypeError(msg)
    return progress
