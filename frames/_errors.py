"""Errors and warnings of models and ground motions; how messages name arguments and parts."""

from __future__ import annotations

import difflib
import re
from collections.abc import Collection, Generator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar

from lir_element.argument_checks import require_type
from lir_element.errors import AnalysisWarning
from lir_element.texts import TextWarning

_NUMBERS = re.compile(r"(?<![\w-])\d[\d.e+-]*")


def without_numbers(message: str) -> str:
    """Return a message without its numbers, names with numbers aside: of one thing it is one."""
    return _NUMBERS.sub("#", message)


class ModelError(ValueError):
    """Raised if a structural model or one of its numbers is unusable; the message names the cause.

    Examples
    --------
    >>> from frames import Frame
    >>> try:
    ...     Frame("empty").check()
    ... except ModelError as error:
    ...     print(error)
    frame "empty" has no nodes: add nodes, supports and members first
    """


class ModelWarning(TextWarning):
    """Warning: a structural model can be used, but needs attention.

    Examples
    --------
    >>> import warnings
    >>> from frames import gravity, lumped_mass
    >>> from frames.demo import bearing_for
    >>> with warnings.catch_warnings(record=True) as told:
    ...     warnings.simplefilter("always")
    ...     state = gravity(lumped_mass(bearing_for(2000e3), mass=204e4))
    >>> told[0].category.__name__
    'ModelWarning'
    """


class MotionError(ValueError):
    """A ground motion, a file or a spectrum that cannot be used; the message names the culprit.

    Examples
    --------
    >>> from frames import GroundMotion
    >>> try:
    ...     GroundMotion(x=[0.0, 9810.0], dt=0.01)
    ... except MotionError as error:
    ...     print(str(error).split(":")[0])
    x peaks at 9810 m/s2 = 1000 g, above any recorded ground motion
    """


class MotionWarning(TextWarning):
    """Warning: a ground motion can be used, but needs attention.

    Examples
    --------
    >>> import warnings
    >>> import numpy as np
    >>> from frames import GroundMotion
    >>> with warnings.catch_warnings(record=True) as told:
    ...     warnings.simplefilter("always")
    ...     motion = GroundMotion(x=np.exp(-0.5 * np.arange(0.0, 20.0, 0.02)), dt=0.02)
    >>> told[0].category.__name__
    'MotionWarning'
    """


class AuditWarning(AnalysisWarning):
    """A completed analysis in which something that was left out or is uncertain mattered.

    Examples
    --------
    >>> import warnings
    >>> from frames import time_history
    >>> from frames.demo import example
    >>> from lir_element import Features
    >>> frame, pulse = example(2.4)
    >>> with warnings.catch_warnings(record=True) as told:
    ...     warnings.simplefilter("always")
    ...     data = time_history(frame, pulse, features=Features(rims=False))
    >>> told[0].category.__name__
    'AuditWarning'
    """


_IN_FILE = ContextVar("_IN_FILE", default=False)
_KEYS = {"at": "bearings_at"}
_UNITS = {"gravity": "m/s2", "mesh": "m", "plate_thickness": "m"}


@contextmanager
def in_project_file() -> Generator[None, None, None]:
    """Write remedies in the terms of a project's file while a model is imported for it."""
    token = _IN_FILE.set(True)
    try:
        yield
    finally:
        _IN_FILE.reset(token)


def argument(name: str, value: object) -> str:
    """Return an argument with its value: ``at=["X"]``, or ``bearings_at = ["X"]`` in a file."""
    if not _IN_FILE.get():
        return f"{name}={_text(value, file=False)}"
    if name in _UNITS:
        value = f"{value:g} {_UNITS[name]}"
    return f"{_KEYS.get(name, name)} = {_text(value, file=True)}"


def in_python(text: str) -> str:
    """Return a remedy that Python alone has, nothing for a project's file."""
    return "" if _IN_FILE.get() else text


def bearing_for(place: str) -> str:
    """Return how to replace links by a bearing: by a mapping, or by ``bearings_at``."""
    if _IN_FILE.get():
        return f"{argument('at', [place])}, to use [bearing] there"
    return f'bearing={{"{place}": LIRBearing(...)}}'


def _text(value: object, *, file: bool) -> str:
    if isinstance(value, bool):
        return str(value).lower() if file else str(value)
    if isinstance(value, Mapping):
        pairs = [f'"{k}"{" = " if file else ": "}{_text(v, file=file)}' for k, v in value.items()]
        return f"{{ {', '.join(pairs)} }}" if file else f"{{{', '.join(pairs)}}}"
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(_text(each, file=file) for each in value)}]"
    if value is ...:
        return "..."
    return f'"{value}"' if isinstance(value, str) else f"{value}"


def new_name(name: str, taken: Collection[str], kind: str) -> str:
    """Return a name that is neither empty nor in use, or raise."""
    require_type(f"name of a {kind}", name, str, "a string: write it in quotes")
    if not name.strip():
        message = f"the name of a {kind} is empty: use at least one visible character"
        raise ModelError(message)
    if name in taken:
        message = f'a {kind} "{name}" exists already: choose another name'
        raise ModelError(message)
    return name


def likely(name: object, known: Collection[str]) -> str:
    """Return the probable meaning of `name`; empty if no known name is close."""
    close = difflib.get_close_matches(str(name), list(known), n=3)
    if close:
        return "did you mean " + " or ".join(f'"{other}"' for other in close) + "?"
    return f'{len(known)} exist, the first is "{next(iter(known))}"' if known else ""


def known_name(name: object, known: Collection[str], kind: str) -> str:
    """Accept a name that exists."""
    if isinstance(name, str) and name in known:
        return name
    hint = likely(name, known) or f"the model has no {kind} yet"
    message = f'there is no {kind} "{name}": add it before it is used ({hint})'
    raise ModelError(message)
