"""Input checks: every error names the value, the bound and the remedy.

A value of the wrong kind is a `TypeError`; one out of its bounds a `ValueError`, or the kind of it
that the caller passes as `error`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple, TypedDict, TypeVar, cast

import numpy as np

if TYPE_CHECKING:
    from typing import Unpack

    from numpy.typing import ArrayLike, NDArray

T = TypeVar("T")

Remedy = str | Callable[[float], str]
"""Remedy for a number that is refused, or a function of the number that returns it."""


class How(TypedDict, total=False):
    """Options of an input check: its remedy and the error that it raises."""

    remedy: Remedy
    optional: bool
    error: type[ValueError]


_LONGEST = 120  # characters of a value in a message


def shown(value: object) -> str:
    """Return a value as a message shows it; a long one by its type and shape.

    Examples
    --------
    >>> shown(2.5), shown(np.zeros((3, 600))), shown([0.0] * 600)
    ('2.5', 'an array of shape (3, 600)', 'a list of 600')
    """
    if isinstance(value, np.ndarray) and value.ndim > 0:
        return f"an array of shape {value.shape}"
    text = repr(value)
    if len(text) <= _LONGEST and "\n" not in text:
        return text
    size = f" of {len(value)}" if isinstance(value, (list, tuple, dict, str)) else ""
    kind = type(value).__name__
    return f"{'an' if kind[0] in 'AEIOUaeiou' else 'a'} {kind}{size}"


def listed(names: Iterable[object], most: int = 8) -> str:
    """Return names as a message lists them: the first of many, and how many more there are.

    Examples
    --------
    >>> listed([3, 4]), listed(range(12), most=2)
    ('3, 4', '0, 1 and 10 more')
    """
    every = list(names)
    first = ", ".join(str(name) for name in every[:most])
    return first if len(every) <= most else f"{first} and {len(every) - most} more"


def unreal(values: object) -> str:
    """Return why an array is none of real numbers, all there; empty if it is.

    Examples
    --------
    >>> unreal([1.0, 2.0]), unreal(np.array([1.0, 2.0j]))
    ('', 'has complex numbers: pass the real part, values.real')
    """
    if np.ma.isMaskedArray(values) and np.ma.getmaskarray(values).any():
        count = int(np.ma.getmaskarray(values).sum())
        return f"has {count} masked values: replace them (values.filled(0.0)), or remove them"
    if np.iscomplexobj(cast("ArrayLike", values)):
        return "has complex numbers: pass the real part, values.real"
    return ""


def as_number(name: str, value: object, unit: str = "") -> float:
    """Return `value` as a float, infinity and NaN included."""
    no_number = isinstance(value, (bool, np.bool_, complex, np.complexfloating))
    if no_number or not hasattr(value, "__float__") or getattr(value, "ndim", 0) > 0:
        msg = f"{name} = {shown(value)} is not a number: give one number in {unit or 'SI units'}"
        raise TypeError(msg)
    return float(value)


class Interval(NamedTuple):
    """Interval of a number in mathematical notation: "(0, 1)", "[0, inf)", "(0, 1) or inf"."""

    low: float
    high: float
    open_below: bool
    open_above: bool
    endless: bool

    def holds(self, number: float) -> bool:
        """Return whether a number is in it; NaN is in none."""
        if number == math.inf and self.endless:
            return True
        above = self.low < number if self.open_below else self.low <= number
        return above and (number < self.high if self.open_above else number <= self.high)

    def words(self) -> str:
        """Return it in words, for the end of "must be"."""
        found = []
        if not math.isinf(self.low):
            plain = f"above {self.low:g}" if self.low else "positive"
            found.append(plain if self.open_below else f"at least {self.low:g}")
        if not math.isinf(self.high):
            found.append(f"{'below' if self.open_above else 'at most'} {self.high:g}")
        elif self.open_above:
            found.append("finite")
        return " and ".join(found) + (", or infinite" if self.endless else "")


@lru_cache(512)
def interval(text: str) -> Interval:
    """Return the interval that a text means.

    Examples
    --------
    >>> interval("(0, 1] or inf").words()
    'positive and at most 1, or infinite'
    """
    plain = text.removesuffix(" or inf")
    low, high = plain[1:-1].split(",")
    return Interval(float(low), float(high), plain[0] == "(", plain[-1] == ")", plain != text)


def require_within(
    name: str,
    value: object,
    within: str,
    unit: str = "",
    *,
    remedy: Remedy = "",
    optional: bool = False,
    error: type[ValueError] = ValueError,
) -> float:
    """Return `value` if the interval holds it, or raise; an `optional` one can be left out."""
    number = as_number(name, value, unit)
    if interval(within).holds(number):
        return number
    plain = {"": "give a number in SI units", "-": "give a pure number"}
    otherwise = plain.get(unit, f"give it in {unit} (SI)") + ", or leave it out" * optional
    what_to_do = remedy(number) if callable(remedy) else remedy or otherwise
    shown_unit = f" [{unit}]" if unit else ""
    must = interval(within).words()
    msg = f"{name} = {number:g}{shown_unit} must be {must}: {what_to_do}"
    raise error(msg)


def require_finite(name: str, value: object, unit: str = "", **how: Unpack[How]) -> float:
    """Return `value` if it is finite, or raise."""
    return require_within(name, value, "(-inf, inf)", unit, **how)


def require_positive(
    name: str, value: object, unit: str = "", *, infinite: bool = False, **how: Unpack[How]
) -> float:
    """Return `value` if it is above zero (and finite, unless `infinite`), or raise."""
    return require_within(name, value, "(0, inf]" if infinite else "(0, inf)", unit, **how)


def require_non_negative(name: str, value: object, unit: str = "", **how: Unpack[How]) -> float:
    """Return `value` if it is finite and not below zero, or raise."""
    return require_within(name, value, "[0, inf)", unit, **how)


def require_between(
    name: str, value: object, low: float, high: float, unit: str = "", **how: Unpack[How]
) -> float:
    """Return `value` if ``low <= value < high``, or raise."""
    return require_within(name, value, f"[{low:.17g}, {high:.17g})", unit, **how)


def require_vector(
    name: str, values: ArrayLike, size: int, *, error: type[ValueError] = ValueError
) -> NDArray[np.float64]:
    """Return a copy of `size` finite numbers (size,), or raise; `name` includes their unit."""
    try:
        array = np.array(values, dtype=np.float64)
    except (TypeError, ValueError) as cause:
        msg = f"{name} = {shown(values)} must be {size} real numbers: give them in SI units"
        raise error(msg) from cause
    if array.shape != (size,):
        msg = (
            f"{name} has shape {array.shape}, it must be ({size},): "
            f"give {size} numbers, 0 for absent components"
        )
        raise error(msg)
    if not np.isfinite(array).all():
        msg = f"{name} = {array.tolist()} must be finite: give finite numbers in SI units"
        raise error(msg)
    return array


def require_type(
    name: str, value: object, kinds: type | tuple[type, ...], what_it_must_be: str
) -> None:
    """Raise a TypeError unless `value` is of one of the kinds."""
    if not isinstance(value, kinds):
        msg = f"{name} = {shown(value)} must be {what_it_must_be}"
        raise TypeError(msg)


def require_choice(
    name: str,
    value: object,
    allowed: Sequence[object],
    *,
    error: type[ValueError] = ValueError,
) -> None:
    """Raise unless `value` is one of those allowed."""
    if value not in allowed:
        msg = f"{name} = {shown(value)}: choose one of {tuple(allowed)}"
        raise error(msg)


def frozen_pair(name: str, value: object) -> object:
    """Return a list or array of two as a tuple; anything that is no sequence as it is."""
    if isinstance(value, np.ndarray):
        return as_pair(name, tuple(value.tolist()))
    return as_pair(name, tuple(value)) if isinstance(value, (tuple, list)) else value


def as_pair(name: str, value: T | tuple[T, T]) -> tuple[T, T]:
    """Return `value` as a pair (bottom, top): one value serves both surfaces."""
    if isinstance(value, (tuple, list)):
        if len(value) != 2:
            msg = f"{name} has {len(value)} entries: give one value, or a pair (bottom, top)"
            raise ValueError(msg)
        return (value[0], value[1])
    return (value, value)
