"""The values that a code gives: where each stands, and how well it is known."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from frames.design._errors import CheckError
from frames.design.calculation.standing import MEMORY, Standing

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

E031 = Standing("agrees", "E.031 of Peru (DS 030-2019-VIVIENDA)")
E031_FACTORS = Standing("agrees", "E.031 of Peru (DS 030-2019-VIVIENDA), eq. 1 and 2")
E031_ORDINATE = Standing("agrees", "E.031 of Peru (DS 030-2019-VIVIENDA), eq. 6")
UFC_BNBC = Standing("agrees", "UFC 3-310-03A and BNBC 2020 of Bangladesh, 2.5.16")
BNBC = Standing("agrees", "BNBC 2020 of Bangladesh, 2.5.16")
USGS = Standing("agrees", "the example of USGS for ASCE 7-22, UCSF Parnassus")
NTC = Standing("agrees", "NTC 2018 of Italy, 7.10.5")
NTC_SLIDERS = Standing("agrees", "NTC 2018 of Italy, 11.9.8")

_ORDER = ("memory", "agrees", "read")
"""Kinds of standings of codes, the weakest first."""


class CodeValue(NamedTuple):
    """A value or a formula of a code.

    Attributes
    ----------
    clause : str
        Where the code has it.
    what : str
        What it is, with its number where it has one.
    standing : Standing
        How well it is known.
    field : str
        Factor of the code's analysis that it is, such as "drift" of `ASCE7`; empty for a formula.

    Examples
    --------
    >>> from frames.design import code_named
    >>> value = code_named("EN 1998").values["restoring"]
    >>> value.clause, str(value.standing)
    ('EN 1998-1 10.9.2', 'agrees with NTC 2018 of Italy, 7.10.5')
    """

    clause: str
    what: str
    standing: Standing = MEMORY
    field: str = ""


def weakest(standings: Iterable[Standing]) -> Standing:
    """Return the standing of what rests on several values."""
    found = tuple(dict.fromkeys(standings))
    if not found or any(one.kind == "own" for one in found):
        msg = (
            f"standings {[str(one) for one in found]}: give those of values of a code, one at least"
        )
        raise CheckError(msg)
    kind = min((one.kind for one in found), key=_ORDER.index)
    return Standing(kind, "; ".join(one.source for one in found if one.kind == kind))


def standing_by(values: Mapping[str, CodeValue], *names: str, analysis: object = None) -> Standing:
    """Return the standing of a check that rests on values of a code."""
    missing = [name for name in names if name not in values]
    if missing:
        msg = f"value {missing[0]!r} is none of the code's: it has {', '.join(values)}"
        raise CheckError(msg)
    return weakest(
        MEMORY if _is_changed(values[name].field, analysis) else values[name].standing
        for name in names
    )


def _is_changed(field: str, analysis: object) -> bool:
    if analysis is None or not field:
        return False
    return bool(getattr(analysis, field) != getattr(type(analysis)(), field))
