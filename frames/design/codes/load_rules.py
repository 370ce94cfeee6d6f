"""What a code makes of dead, live and snow load: seismic mass, and combinations for bearings."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple

from frames.design.calculation.standing import MEMORY, Standing
from frames.design.codes.values_of_asce7 import VALUES
from frames.model.load_combinations import isolator_combinations

Combinations = dict[str, dict[str, float]]
"""Factors of the load cases "D", "L" and "S" by name of the combination."""

CASES = ("D", "L", "S")
"""Load cases: dead load, live load, snow."""


class LoadRule(NamedTuple):
    """How a code counts the loads of an isolated building.

    Attributes
    ----------
    clause : str
        Where the code says so.
    mass : mapping of str to float
        Share of each load case that is seismic mass [-], if a project does not say another.
    combinations : callable
        Returns the vertical load combinations of the bearings without the horizontal earthquake,
        "average" among them, which time histories carry; its argument is S_MS [g], or None where
        the code's spectrum has none.
    standing : Standing
        How well it is known.
    note : str
        What it makes of the loads, in words.

    Examples
    --------
    >>> from frames.design import code_named
    >>> rule = code_named("EN 1998").loads
    >>> rule.mass["L"], rule.combinations(None)["average"]
    (0.3, {'D': 1.0, 'L': 0.3, 'S': 0.0})
    """

    clause: str
    mass: Mapping[str, float]
    combinations: Callable[[float | None], Combinations]
    standing: Standing = MEMORY
    note: str = ""

    @property
    def cited(self) -> str:
        """Clause, with a star where it is from memory, and note."""
        said = self.standing.cited(self.clause)
        return f"{said}: {self.note}" if self.note else said


def fixed_combinations(combinations: Combinations) -> Callable[[float | None], Combinations]:
    """Return a rule whose factors do not depend on the spectrum."""
    return lambda s_ms: {name: dict(factors) for name, factors in combinations.items()}


LOADS_OF_ASCE = LoadRule(
    VALUES["loads"].clause,
    {"D": 1.0, "L": 0.0, "S": 0.0},
    lambda s_ms: isolator_combinations(s_ms or 0.0),
    VALUES["loads"].standing,
    "of live load only that of storage counts as mass, 25 %",
)
"""Seismic weight and combinations of ASCE 7, and of codes that give none of their own."""
