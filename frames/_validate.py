"""Checks at the door of the structural model: each refusal names value, bound and remedy."""

from __future__ import annotations

import difflib
import math
from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from frames._types import FloatArray


class ModelError(ValueError):
    """A structural model, or a number of it, that cannot be used; the message names the culprit."""


class ModelWarning(UserWarning):
    """A structural model that can be used, with something that its user should know."""


def finite(value: object, what: str, remedy: str = "give a finite number in SI units") -> float:
    """Accept a finite real number.

    Parameters
    ----------
    value : float
        The number given by the caller.
    what : str
        What the number is, with its unit, as the message should call it.
    remedy : str
        What the caller can do.

    Returns
    -------
    float
        The number as a Python float.

    Raises
    ------
    ModelError
        If the value is NaN or infinite.
    """
    number = real(value, what)
    if not math.isfinite(number):
        message = f"{what} = {number:g} must be finite: {remedy}"
        raise ModelError(message)
    return number


def real(value: object, what: str) -> float:
    """Accept a real number, infinity and NaN included.

    Parameters
    ----------
    value : float
        The number given by the caller.
    what : str
        What the number is, as the message should call it.

    Returns
    -------
    float
        The number as a Python float.

    Raises
    ------
    TypeError
        If the value is not a real number.
    """
    if isinstance(value, bool) or not isinstance(value, (int, float, np.integer, np.floating)):
        message = f"{what} = {value!r} must be a real number: give one number in SI units"
        raise TypeError(message)
    return float(value)


def of_type(value: object, kinds: type | tuple[type, ...], what: str, remedy: str) -> None:
    """Accept an instance of given types only.

    Parameters
    ----------
    value : object
        What the caller gave.
    kinds : type or tuple of types
        What it must be.
    what : str
        What it is, as the message should call it.
    remedy : str
        What it must be, in words, and what the caller can do.

    Raises
    ------
    TypeError
        If it is something else.
    """
    if not isinstance(value, kinds):
        message = f"{what} = {value!r} must be {remedy}"
        raise TypeError(message)


def positive(value: object, what: str, remedy: str = "give a number in SI units") -> float:
    """Accept a finite number greater than zero.

    Parameters
    ----------
    value : float
        The number given by the caller.
    what : str
        What the number is, with its unit, as the message should call it.
    remedy : str
        What the caller can do.

    Returns
    -------
    float
        The number as a Python float.

    Raises
    ------
    ModelError
        If the number is not finite or not greater than zero.
    """
    number = finite(value, what)
    if number <= 0.0:
        message = f"{what} = {number:g} must be greater than 0: {remedy}"
        raise ModelError(message)
    return number


def non_negative(value: object, what: str, remedy: str = "give a number in SI units") -> float:
    """Accept a finite number that is zero or greater.

    Parameters
    ----------
    value : float
        The number given by the caller.
    what : str
        What the number is, with its unit, as the message should call it.
    remedy : str
        What the caller can do.

    Returns
    -------
    float
        The number as a Python float.

    Raises
    ------
    ModelError
        If the number is not finite or less than zero.
    """
    number = finite(value, what)
    if number < 0.0:
        message = f"{what} = {number:g} must be 0 or greater: {remedy}"
        raise ModelError(message)
    return number


def vector(values: Sequence[float] | FloatArray, size: int, what: str) -> FloatArray:
    """Accept `size` finite numbers.

    Parameters
    ----------
    values : array_like, shape (size,)
        The numbers given by the caller.
    size : int
        How many there must be.
    what : str
        What the numbers are, with their unit, as the message should call them.

    Returns
    -------
    ndarray, shape (size,)
        A copy of the numbers as float64.

    Raises
    ------
    ModelError
        If the number of values differs from `size`, or one is not finite.
    """
    try:
        array = np.array(values, dtype=np.float64)
    except (TypeError, ValueError) as cause:
        message = f"{what} = {values!r} must be {size} real numbers: give them in SI units"
        raise ModelError(message) from cause
    if array.shape != (size,):
        message = (
            f"{what} has shape {array.shape}, it must be ({size},): "
            f"give {size} numbers, zeros where there is nothing"
        )
        raise ModelError(message)
    if not np.isfinite(array).all():
        message = f"{what} = {array.tolist()} must be finite: give finite numbers in SI units"
        raise ModelError(message)
    return array


def new_name(name: object, taken: Collection[str], kind: str) -> str:
    """Accept a name that is not empty and not taken.

    Parameters
    ----------
    name : str
        The name given by the caller.
    taken : collection of str
        The names in use.
    kind : str
        What is named: "node", "member", ...

    Returns
    -------
    str
        The name.

    Raises
    ------
    TypeError
        If the name is not a string.
    ModelError
        If the name is empty or taken.
    """
    if not isinstance(name, str):
        message = f"the name of a {kind} must be a string, not {name!r}: write it in quotes"
        raise TypeError(message)
    if not name.strip():
        message = f"the name of a {kind} is empty: give it at least one visible character"
        raise ModelError(message)
    if name in taken:
        message = f'a {kind} "{name}" exists already: names are unique, choose another one'
        raise ModelError(message)
    return name


def likely(name: object, known: Collection[str]) -> str:
    """Return what the caller may have meant instead of `name`; empty where nothing is known.

    Parameters
    ----------
    name : object
        The name given by the caller.
    known : collection of str
        The names that exist.

    Returns
    -------
    str
        A part of a sentence, for a message.
    """
    close = difflib.get_close_matches(str(name), list(known), n=3)
    if close:
        return "did you mean " + " or ".join(f'"{other}"' for other in close) + "?"
    return f'{len(known)} exist, the first is "{next(iter(known))}"' if known else ""


def known_name(name: object, known: Collection[str], kind: str) -> str:
    """Accept a name that exists.

    Parameters
    ----------
    name : str
        The name given by the caller.
    known : collection of str
        The names that exist.
    kind : str
        What is named: "node", "member", ...

    Returns
    -------
    str
        The name.

    Raises
    ------
    ModelError
        If nothing has this name; the message suggests close names.
    """
    if isinstance(name, str) and name in known:
        return name
    hint = likely(name, known) or f"the model has no {kind} yet"
    message = f'there is no {kind} "{name}": add it before it is used ({hint})'
    raise ModelError(message)
