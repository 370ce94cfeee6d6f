"""Checks at the door: every error names the value, the bound and the remedy."""

from __future__ import annotations

from math import inf, isnan
from typing import TypeVar

import numpy as np

T = TypeVar("T")


def as_number(name: str, value: object, unit: str) -> float:
    """Return `value` as a float, or raise a TypeError that names it."""
    if isinstance(value, (bool, np.bool_)) or not hasattr(value, "__float__"):
        msg = f"{name} = {value!r} is not a number: give it in {unit}"
        raise TypeError(msg)
    return float(value)


def require_between(
    name: str, value: object, low: float, high: float, unit: str, remedy: str = ""
) -> float:
    """Return `value` if ``low <= value < high``, or raise."""
    number = as_number(name, value, unit)
    if isnan(number) or not low <= number < high:
        end = f": {remedy}" if remedy else ""
        msg = f"{name} = {number:g} [{unit}] must be at least {low:g} and below {high:g}{end}"
        raise ValueError(msg)
    return number


def require_positive(name: str, value: object, unit: str, *, infinite: bool = False) -> float:
    """Return `value` if it is above zero (and finite, unless `infinite`), or raise."""
    number = as_number(name, value, unit)
    if isnan(number) or number <= 0.0 or (number == inf and not infinite):
        bound = "positive" if infinite else "positive and finite"
        msg = f"{name} = {number:g} [{unit}] must be {bound}; give it in {unit} (SI)"
        raise ValueError(msg)
    return number


def require_non_negative(name: str, value: object, unit: str) -> float:
    """Return `value` if it is finite and not below zero, or raise."""
    number = as_number(name, value, unit)
    if isnan(number) or number < 0.0 or number == inf:
        msg = f"{name} = {number:g} [{unit}] must be finite and at least 0; give it in {unit} (SI)"
        raise ValueError(msg)
    return number


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
