"""Damping factors B of the codes: a spectrum of 5 % damping is divided by them."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from frames._errors import MotionError
from lir_element.argument_checks import require_between, require_choice

TO_BE_CONFIRMED = "to be confirmed against the standard"
"""Standing of what was not compared with the text of the standard."""


class DampingRule(NamedTuple):
    """Damping factors of one code.

    Attributes
    ----------
    source : str
        Where the code gives them.
    rule : str
        The formula, or how values between those of the table are found.
    standing : str
        How well source and values are known.
    table : tuple of (float, float)
        Damping [-] and factor B [-]; empty where a formula gives them.
    """

    source: str
    rule: str
    standing: str
    table: tuple[tuple[float, float], ...] = ()


_LINEAR = "linear between the values, constant outside of them"

DAMPING_RULES = {
    "ASCE 7": DampingRule(
        "ASCE/SEI 7-22, table 17.5-1 (7-16 alike)",
        _LINEAR,
        TO_BE_CONFIRMED,
        ((0.02, 0.8), (0.05, 1.0), (0.10, 1.2), (0.20, 1.5), (0.30, 1.7), (0.40, 1.9), (0.50, 2.0)),
    ),
    "EN 1998": DampingRule(
        "EN 1998-1:2004, 3.2.2.2(3)",
        "B = 1 / eta, eta = sqrt(10 / (5 + damping in %)) >= 0.55",
        TO_BE_CONFIRMED,
    ),
    "NCh2745": DampingRule(
        "NCh2745:2013, table of B_D and B_M",
        _LINEAR,
        TO_BE_CONFIRMED,
        (
            (0.02, 0.65),
            (0.05, 1.0),
            (0.10, 1.37),
            (0.15, 1.67),
            (0.20, 1.94),
            (0.25, 2.17),
            (0.30, 2.38),
            (0.50, 3.02),
        ),
    ),
}
"""Damping rules by the code they belong to."""

SMALLEST_ETA = 0.55
"""Least damping correction of EN 1998-1 [-]."""


def damping_factor(code: str, damping: float) -> float:
    """Return the factor by which a code divides a spectrum of 5 % damping.

    Parameters
    ----------
    code : {"ASCE 7", "EN 1998", "NCh2745"}
        Whose rule (`DAMPING_RULES`).
    damping : float
        Part of the critical damping [-], in [0, 1).

    Returns
    -------
    float
        B [-]; 1 at 5 %.

    Raises
    ------
    MotionError
        If the code is not known, or the damping out of its bounds.

    Examples
    --------
    >>> damping_factor("ASCE 7", 0.25)
    1.6
    """
    require_choice("code", code, tuple(DAMPING_RULES), error=MotionError)
    ratio = require_between("damping", damping, 0.0, 1.0, remedy="5 % is 0.05", error=MotionError)
    table = DAMPING_RULES[code].table
    if table:
        known, factors = np.array(table).T
        return float(np.interp(ratio, known, factors))
    return 1.0 / max(math.sqrt(10.0 / (5.0 + 100.0 * ratio)), SMALLEST_ETA)
