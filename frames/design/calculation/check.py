"""Design checks as values: demand, limit, clause, and the calculation that led to them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Literal, get_args, overload

from frames.design._errors import CheckError
from frames.design.calculation.rendering import quantity, scale, usual_unit
from frames.design.calculation.standing import FROM_MEMORY, Standing
from frames.design.calculation.trace import Trace
from lir_element.argument_checks import as_number, require_choice, require_type
from lir_element.texts import html_table, joined, text_table, worded

if TYPE_CHECKING:
    import pandas as pd

Bound = Literal["lower", "nominal", "upper", ""]
Scope = Literal["any", "demand", "procedure", "agreement", "minimum"]
Verdict = Literal[
    "ok", "FAILS", "no value", "no limit", "does not apply", "needs agreement", "raised"
]
_ROUND_OFF = 1e-9


@dataclass(frozen=True, kw_only=True, eq=False)
class Check:
    """A demand against its limit.

    Parameters
    ----------
    clause : str
        Standard and clause, or another source of the requirement.
    title : str
        Title of the check, in a few words.
    demand, limit : float
        Values in `unit`; infinite if there is none, as the capacity of a bearing without rims.
    symbol : str
        Symbol of the demand in the calculation.
    unit : str
        SI unit, "-" for a pure number.
    relation : {"<=", ">="}
        Relation of the demand to the limit.
    trace : Trace, optional
        The calculation; later entries do not change the check.
    standing : Standing
        Source of clause, formula and limit; default: from memory, with a star.
    bound : {"lower", "nominal", "upper", ""}
        Properties of the bearings it holds for.
    subject : str
        Bearing or storey that it concerns; empty for the whole.
    note : str
        Remark for the reader.
    shown : str
        Unit to show it in; kN for forces, otherwise `unit`.
    void : str
        Reason that there is no valid demand, for example failed runs. The check then does not pass
        at any demand and limit. The demand is the largest value before the failure.
    scope : {"any", "demand", "procedure", "agreement", "minimum"}
        Scope of the check: any analysis; a demand that a time history finds anew; a limit of the
        equivalent-linear procedure; a solution without a rule in the code; or a least value of a
        demand. None of the last three is a failure if the limit is exceeded: a procedure does not
        apply, a solution needs the agreement in the note, and a demand below its least value is
        raised to it, by the ratio. Tables show the `verdict` instead.
    level : str
        Level of the seismic action, such as "MCE_R", "design" or "maximum"; empty if none enters.

    Raises
    ------
    CheckError, TypeError
        If demand or limit is NaN, or a word is none of those allowed.

    Examples
    --------
    >>> check = Check(clause="ASCE 7-22 17.5.6", title="storey drift", symbol="Delta",
    ...               demand=0.030, limit=0.045, unit="m", shown="mm", subject="storey 2")
    >>> check.passed, round(check.ratio, 3)
    (True, 0.667)
    """

    clause: str
    title: str
    demand: float
    limit: float
    symbol: str = ""
    unit: str = "-"
    relation: Literal["<=", ">="] = "<="
    trace: Trace = Trace()  # noqa: RUF009  (copied, never added to)
    standing: Standing = FROM_MEMORY
    bound: Bound = ""
    subject: str = ""
    note: str = ""
    shown: str = ""
    void: str = ""
    scope: Scope = "any"
    level: str = ""

    def __post_init__(self) -> None:
        for name in ("demand", "limit"):
            value = as_number(f"{name} of {self.title!r}", getattr(self, name), self.unit)
            if math.isnan(value):
                msg = (
                    f"{name} of {self.title!r} ({self.clause}) is not a number: find the cause "
                    "in its trace"
                )
                raise CheckError(msg)
            object.__setattr__(self, name, value)
        if math.isinf(self.demand) and math.isinf(self.limit):
            msg = (
                f"demand and limit of {self.title!r} ({self.clause}) are both infinite: give a "
                "finite limit"
            )
            raise CheckError(msg)
        require_choice("relation", self.relation, ("<=", ">="), error=CheckError)
        require_type("standing", self.standing, Standing, "a Standing")
        require_choice("bound", self.bound, get_args(Bound), error=CheckError)
        require_choice("scope", self.scope, get_args(Scope), error=CheckError)
        object.__setattr__(self, "shown", self.shown or usual_unit(self.unit))
        try:
            scale(self.unit, self.shown)
        except KeyError as cause:
            msg = (
                f"{self.title!r} is in {self.unit}, which cannot be shown in {self.shown!r}: "
                "leave `shown` out"
            )
            raise CheckError(msg) from cause
        object.__setattr__(self, "trace", self.trace.copy())

    @property
    def ratio(self) -> float:
        """Utilisation [-]: at most 1 if the check passes, for each relation.

        The side that must be smaller over the other one. 0 if a side that must be at least 0 or
        less is beyond that; infinite if no factor would help, and for a `void` check.
        """
        return math.inf if self.void else self.compared

    @property
    def compared(self) -> float:
        """The ratio of demand and limit alone, also of a check that is `void` [-]."""
        below, above = self.demand, self.limit
        if self.relation == ">=":
            below, above = above, below
        if above > 0.0:
            return max(below / above, 0.0)
        if above < 0.0:
            return above / below if below < 0.0 else math.inf
        return 0.0 if below <= 0.0 else math.inf

    @property
    def passed(self) -> bool:
        """True if demand and limit satisfy the relation, round-off (1e-9) aside."""
        return self.ratio <= 1.0 + _ROUND_OFF

    @property
    def is_unlimited(self) -> bool:
        """True if demand or limit is infinite, so that nothing is compared with a number."""
        return math.isinf(self.limit) or math.isinf(self.demand)

    @property
    def verdict(self) -> Verdict:
        """Outcome: "ok", "FAILS", "no value", or the meaning of an exceeded limit by the `scope`.

        "no limit": demand or limit is infinite, so that there is no comparison; "does not apply": a
        limit of a procedure; "needs agreement": the code has no rule; "raised": a demand that
        counts with its least value; "no value": runs failed (`void`).
        """
        if self.passed:
            return "no limit" if self.is_unlimited else "ok"
        beyond: dict[str, Verdict] = {
            "procedure": "does not apply",
            "agreement": "needs agreement",
        }
        if not self.void:
            beyond["minimum"] = "raised"
        return beyond.get(self.scope, "no value" if self.void else "FAILS")

    @property
    def concerns(self) -> str:
        """Subject, bound of the properties and level of the action, on one line."""
        return joined(self.subject, self.bound, self.level, by=", ")

    @property
    def cited(self) -> str:
        """Clause, with a star if it is from memory."""
        return self.standing.cited(self.clause)

    @property
    def said(self) -> tuple[str, str, str]:
        """Demand, limit and ratio as tables show them: "-" if there is no ratio."""
        demand = quantity(self.demand, self.unit, self.shown)
        limit = quantity(self.limit, self.unit, self.shown)
        if self.verdict == "no limit":
            demand = "no limit" if math.isinf(self.demand) else demand
            return demand, "no limit" if math.isinf(self.limit) else limit, "-"
        if self.void:
            return (
                demand
                if math.isinf(self.demand)
                else worded("{value} before failure", value=demand),
                limit,
                "-",
            )
        return demand, limit, f"{self.ratio:.3f}" if math.isfinite(self.ratio) else "-"

    @property
    def statement(self) -> str:
        """The check with its numbers on one line."""
        return f"{self.brief}, no valid value: {self.void}" if self.void else self.brief

    @property
    def brief(self) -> str:
        """The check with its numbers on one line, without the reason of `void`."""
        where = self.concerns
        demand, limit, _ = self.said
        title = f"{self.title}{f' ({where})' if where else ''}"
        if self.void:
            return f"{title}: {demand}, limit {limit}"
        if self.verdict == "no limit":
            return f"{title}: {demand if math.isinf(self.limit) else f'at least {limit}'}"
        return f"{title}: {demand} {self.relation} {limit}, {self._ratio_in_words}"

    @property
    def _ratio_in_words(self) -> str:
        if math.isfinite(self.ratio):
            return f"ratio {self.ratio:.3g}"
        if math.isinf(self.demand):
            return "no ratio without a demand"
        if self.relation == "<=":
            return "none allowed" if not self.limit else "no ratio to a limit below 0"
        return "no ratio of a demand that is not above 0"

    def __str__(self) -> str:
        """Return the check on one line."""
        word = {"ok": "passed", "FAILS": "FAILED", "no value": "FAILED"}
        return f"{self.statement}, {word.get(self.verdict, self.verdict)} [{self.clause}]"


COLUMNS = tuple(f.name for f in fields(Check) if f.name not in {"trace", "shown", "scope"})
"""Fields that tables have."""

_HEAD = ("check", "concerns", "bound", "level", "demand", "", "limit", "ratio", "", "clause")


class Checks(Sequence[Check]):
    """Design checks, in order.

    Parameters
    ----------
    checks : iterable of Check
        The checks.

    Examples
    --------
    >>> from frames.design import Check
    >>> drift = Check(clause="ASCE 7-22 17.5.6", title="storey drift", demand=0.030, limit=0.045,
    ...               unit="m", shown="mm")
    >>> checks = Checks([drift])
    >>> checks.passed, checks.governing.title, len(checks.failed)
    (True, 'storey drift', 0)
    """

    def __init__(self, checks: Iterable[Check] = ()) -> None:
        self._checks = tuple(checks)
        for check in self._checks:
            require_type("check", check, Check, "a Check")

    @overload
    def __getitem__(self, k: int) -> Check: ...
    @overload
    def __getitem__(self, k: slice) -> Checks: ...
    def __getitem__(self, k: int | slice) -> Check | Checks:
        return Checks(self._checks[k]) if isinstance(k, slice) else self._checks[k]

    def __len__(self) -> int:
        return len(self._checks)

    def __add__(self, other: Iterable[Check]) -> Checks:
        return Checks((*self, *other))

    @property
    def passed(self) -> bool:
        """True if there are checks, and none fails or lacks a valid value."""
        return bool(self._checks) and not self.failed

    @property
    def failed(self) -> Checks:
        """The checks that fail on their value or have no valid value."""
        return Checks(check for check in self if check.verdict in {"FAILS", "no value"})

    @property
    def by_value(self) -> Checks:
        """The checks that fail on their value; numbers of failed runs are not among them."""
        return Checks(c for c in self if c.verdict == "FAILS" and c.symbol != "n_failed")

    @property
    def without_value(self) -> Checks:
        """The checks that have no valid value, because runs failed."""
        return Checks(check for check in self if check.verdict == "no value")

    @property
    def beyond_and_within(self) -> tuple[list[str], list[str]]:
        """Titles of checks beyond their limit in what failed runs reached, and the others."""
        beyond = list(dict.fromkeys(check.title for check in self if check.compared > 1.0))
        titles = dict.fromkeys(check.title for check in self)
        return beyond, [title for title in titles if title not in beyond]

    @property
    def inapplicable(self) -> Checks:
        """Limits of a procedure that are exceeded, so that it does not apply."""
        return Checks(check for check in self if check.verdict == "does not apply")

    @property
    def to_agree(self) -> Checks:
        """Checks that need the agreement of the authority: the code has no rule for them."""
        return Checks(check for check in self if check.verdict == "needs agreement")

    @property
    def raised(self) -> Checks:
        """Checks of demands below their least value, to which they are raised."""
        return Checks(check for check in self if check.verdict == "raised")

    @property
    def tally(self) -> str:
        """Numbers of checks, of failures, of exceeded limits of a procedure, and so on."""
        beyond = len(self.inapplicable)
        more = f", {beyond} limits of the procedure exceeded: it does not apply" if beyond else ""
        agree = len(self.to_agree)
        more += f", {agree} to be agreed with the authority" if agree else ""
        less = len(self.raised)
        more += f", {less} below the code's least value: forces are raised to it" if less else ""
        free = sum(check.verdict == "no limit" for check in self)
        more += f", {free} without a limit" if free else ""
        failed, void = len(self.by_value), len(self.without_value)
        more = f", too many runs failed{more}" if len(self.failed) > failed + void else more
        more = f", {void} without a valid value{more}" if void else more
        return f"{len(self)} checks, {failed} failed{more}"

    @property
    def governing(self) -> Check:
        """The check of the largest ratio.

        Raises
        ------
        CheckError
            If there is none.
        """
        if not self._checks:
            msg = "there are no checks, so none governs: make Checks from at least one"
            raise CheckError(msg)
        return max(self._checks, key=lambda check: check.ratio)

    def of(self, clause: str = "", *, bound: Bound | None = None, subject: str = "") -> Checks:
        """Return those whose clause and subject have these words, and that are of this bound."""
        return Checks(
            c
            for c in self
            if clause in c.clause and subject in c.subject and bound in {None, c.bound}
        )

    def to_dataframe(self) -> pd.DataFrame:
        """Return a table with a row for each check, numbers in SI units."""
        import pandas as pd

        columns = [*COLUMNS, "ratio", "passed", "verdict"]
        rows = [
            {name: getattr(c, name) for name in columns} | {"standing": str(c.standing)}
            for c in self
        ]
        return pd.DataFrame(rows, columns=columns)

    def __str__(self) -> str:
        """Return a table for people."""
        return text_table(self._rows(), _HEAD, left=4) if self._checks else "no checks"

    def __repr__(self) -> str:
        """Return how many there are, and which governs."""
        if not self._checks:
            return "Checks: none"
        return f"Checks: {self.tally}; governing: {self.governing}"

    def _repr_html_(self) -> str:
        return html_table(self.tally, self._rows(), _HEAD)

    def _rows(self) -> list[tuple[str, ...]]:
        return [
            (
                c.title,
                c.subject,
                c.bound,
                c.level,
                c.said[0],
                "" if c.void or c.verdict == "no limit" else c.relation,
                *c.said[1:],
                c.verdict,
                c.cited,
            )
            for c in self
        ]
