"""Errors and warnings of structural models and of ground motions."""

from __future__ import annotations

import re

from lir_element.errors import AnalysisWarning
from lir_element.texts import TextWarning

_NUMBERS = re.compile(r"(?<![\w-])\d[\d.e+-]*")


def without_numbers(message: str) -> str:
    """Return a message without its numbers, names with numbers aside: of one thing it is one."""
    return _NUMBERS.sub("#", message)


class ModelError(ValueError):
    """A structural model, or a number of it, that cannot be used; the message names the culprit.

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
    """A structural model that can be used, with something that its user should know.

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
    x peaks at 9810 m/s2 = 1000 g, no ground shakes like that
    """


class MotionWarning(TextWarning):
    """A ground motion that can be used, with something that its user should know.

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
