"""Values of a code, with clause and source."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Literal, NamedTuple

from frames.design._errors import CheckError
from frames.design.calculation.not_evaluated import NOT_EVALUATED
from frames.design.calculation.standing import FROM_MEMORY, PROJECT, Standing
from lir_element.texts import first_of, joined, worded

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping

    from frames.design.calculation.check import Check

State = Literal["checked", "not checked", "yours"]

RUN = "lir run"
"""Makes the checks that a project has before its time histories not yet."""

NO_CHECK = "because no check of it was made"
"""Reason of a provision that should have been checked."""

NEEDS: Mapping[str, str] = {
    "superstructure": "there is no [superstructure] with R",
    "wind": "no wind shear is given ([superstructure] wind_shear)",
    "combinations": "no dead, live and snow load cases are given ([loads])",
    "service": "no displacement is given ([superstructure] service_displacement)",
    "gap": "no clear distance is given ([limits] moat_gap)",
    "room": "no clear distance is given ([limits] moat_gap, or walls in [moat])",
    "storey stiffness": 'only a structure of kind "shear building" has the stiffness of a storey; '
    "the drifts of time histories are checked",
    "storeys": "the model names fewer than two levels",
    "moved": "no time history has its masses moved ([analysis] accidental_eccentricity)",
    "bounds": "[analysis] bounds has neither lower nor upper",
    "pressure": "no pressure is given ([limits] interface_pressure)",
    "liner": "no pressure is given ([limits] liner_pressure)",
    "rim strength": "no strength of the rims is given ([limits] rim_strength)",
    "near fault": "no motion is marked near_fault",
}
"""Facts that checks need, each with the reason if a project lacks it."""


class Provision(NamedTuple):
    """A provision of a code, with its checks.

    Attributes
    ----------
    clause : str
        Clause.
    what : str
        Requirement, in a few words.
    checks : tuple of str
        Beginnings of the titles of its checks: all of them must be made. None: it is not checked.
    needs : tuple of str
        Facts of `NEEDS` without which they are not made.
    why : str
        Reason that no check is made, or how the engineer shows it.
    yours : bool
        True if no program can check it, or this one leaves it to the engineer.
    only : str
        Fact of the structures concerned, such as "walls"; all structures if empty.

    Examples
    --------
    >>> from frames.design import code_named
    >>> code_named("ASCE 7-22").provisions[0].what
    'rims are not met at D_TM'
    """

    clause: str
    what: str
    checks: tuple[str, ...] = ()
    needs: tuple[str, ...] = ()
    why: str = ""
    yours: bool = False
    only: str = ""


class ProvisionState(NamedTuple):
    """State of a provision in a project: checked or not."""

    clause: str  # clause, with a star if it is from memory
    what: str  # requirement
    state: State  # outcome of the search for its checks
    how: str  # titles of its checks, why there is none, or how the engineer shows it

    @property
    def said(self) -> str:
        """The provision in a sentence."""
        return f"{self.what}: {self.state}{', ' if self.state != 'yours' else ': '}{self.how}"


def yours(clause: str, what: str, why: str, only: str = "") -> Provision:
    """Return a provision that the engineer shows, and how."""
    return Provision(clause, what, why=why, yours=True, only=only)


NO_CODE = "no code"
"""Clause of provisions that no code has."""

_CHECKED: Mapping[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "rims are not met at D_TM": (("no restrainer contact at the total displacement",), ()),
    "share of D_TM from which rims may be met": (("displacement where a rim engages",), ()),
    "restoring force": (("restoring force",), ()),
    "storey drift, equivalent-linear": (("storey drift",), ("superstructure", "storey stiffness")),
    "storey drift of time histories": (("storey drift ratio",), ("storeys",)),
    "overturning of the whole structure": (
        ("overturning of the whole structure",),
        ("superstructure",),
    ),
    "uplift by the combinations": (("no uplift",), ("superstructure", "combinations")),
    "vertical earthquake in the combinations": (
        ("no uplift",),
        ("superstructure", "combinations"),
    ),
    "sliding under wind": (("sliding under wind",), ("wind",)),
    "separation to walls and neighbours": (
        ("clearance to the moat wall, equivalent-linear",),
        ("room",),
    ),
    "number and scaling of motions": (
        ("number of motions", "pairs of motions", "mean spectrum of the motions"),
        (),
    ),
    "runs that failed": (("runs that failed",), ()),
    "accidental eccentricity of time histories": (
        ("runs with moved masses that failed",),
        ("moved",),
    ),
    "displacement of time histories": (("isolator displacement",), ()),
    "uplift in time histories": (("uplift duration",), ()),
}
"""Provisions in common with other codes, with checks and needs of each."""

_YOURS = {
    "overstrength of members and connections": (
        "member-combinations.csv has rows with E whole, elastic: the most that it can be"
    ),
    "parts that cross the isolation interface": (
        "they must follow the displacement of the check of the isolators, with the code's factor"
    ),
    "parts that stand above the isolation interface": "floor accelerations are in demands.csv",
    "bounds of properties over the life of the bearings": (
        "[bounds] has the factors, of tests, temperature, ageing and wear"
    ),
    "review of the design": "by a reviewer of the project",
    "tests of the bearings": (
        "the programme is in the report; acceptance_checks judges loops that were measured"
    ),
}
"""The same that the engineer shows, and how."""


def common(clause: str, what: str) -> Provision:
    """Return a provision in common with other codes, with the clause of one of them."""
    if what in _YOURS:
        return yours(clause, what, _YOURS[what])
    return Provision(clause, what, *_CHECKED[what])


OF_BEARINGS = (
    Provision(
        NO_CODE,
        "the interface holds until a rim is met",
        ("interface holds until a rim is met",),
    ),
    Provision(
        NO_CODE,
        "slip of the interface",
        ("slip over the overlap", "slip over its stable limit s*", "residual slip"),
    ),
    Provision(NO_CODE, "eccentricity of the resultant e/a", ("normalised eccentricity e/a",)),
    Provision(
        NO_CODE,
        "strength of the rims",
        ("rim force", "interface slips before the rim breaks"),
        ("rim strength",),
    ),
    Provision(
        NO_CODE,
        "forces at 3 times the default axial stiffness, for rim contact with slip",
        why="because no run has it: set axial_stiffness, and run again",
    ),
    Provision(
        NO_CODE,
        "pressure on the sliders' overlap",
        ("pressure on the sliders' overlap",),
        ("pressure",),
    ),
    Provision(
        NO_CODE,
        "pressure of the liners",
        ("pressure on the liner around its resultant",),
        ("liner",),
    ),
    Provision(NO_CODE, "movements in service", ("no restrainer contact in service",), ("service",)),
    Provision(
        NO_CODE,
        "clear distance under the time histories",
        ("clearance to the moat wall", "moat wall is not met in any run"),
        ("gap",),
    ),
    Provision(
        NO_CODE,
        "clear distance at the corners of the slab",
        ("clearance to the moat wall",),
        ("gap",),
    ),
    yours(
        NO_CODE,
        "strength of members and connections",
        "member-combinations.csv has their forces by combination",
    ),
    yours(
        NO_CODE,
        "foundations, pedestals and the slab above the bearings",
        "reaction-combinations.csv has forces and moments by combination, N u / 2 in them",
    ),
    yours(
        NO_CODE,
        "restraint of bearings that lift off",
        "uplift.csv has the gaps, and an estimate of the tension in restraints",
    ),
    yours(
        NO_CODE, "strength of walls in shear and at their edges", "members.csv has forces", "walls"
    ),
    yours(NO_CODE, "stroke and force of dampers", "links.csv has both", "dampers"),
    Provision(
        NO_CODE,
        "rotation of plastic hinges and ductility of links",
        why="because no limit can be set for them",
        only="yields",
    ),
)
"""Provisions that a bearing and its structure have under every code."""


def states_of(
    provisions: Iterable[Provision],
    facts: Collection[str],
    checks: Iterable[Check],
    *,
    is_run: bool = True,
) -> tuple[ProvisionState, ...]:
    """Return whether each provision is checked in a project."""
    made = tuple(checks)
    return tuple(
        _state(one, facts, made, is_run) for one in provisions if not one.only or one.only in facts
    )


def checks_of_provision(one: Provision, checks: Iterable[Check]) -> list[Check]:
    """Return the checks that are made of a provision; a code's are none but those that cite one."""
    own = one.clause.startswith(NO_CODE)
    return [
        check
        for check in checks
        if (own or not check.clause.startswith(NO_CODE))
        and any(_begins(check, title) for title in one.checks)
    ]


def _begins(check: Check, title: str) -> bool:
    return re.fullmatch(rf"{re.escape(title)}([,:] .*| above .*)?", check.title) is not None


def _state(
    one: Provision, facts: Collection[str], made: Iterable[Check], is_run: bool
) -> ProvisionState:
    standing = PROJECT if one.clause.startswith(NO_CODE) else FROM_MEMORY
    if one.yours:
        return ProvisionState(standing.cited(one.clause), one.what, "yours", one.why)
    lacking = next((NEEDS[name] for name in one.needs if name not in facts), "")
    found = checks_of_provision(one, made)
    clause = found[0].cited if found else standing.cited(one.clause)
    for blind in (c for c in found if NOT_EVALUATED in c.title or c.verdict == "no limit"):
        why = first_of(blind.note) if NOT_EVALUATED in blind.title else "it has no limit"
        return ProvisionState(clause, one.what, "not checked", worded("since {why}", why=why))
    whole = all(any(_begins(check, title) for check in found) for title in one.checks)
    if found and whole and not lacking:
        titles = dict.fromkeys(check.title for check in found)
        return ProvisionState(clause, one.what, "checked", joined(*titles))
    if one.checks and not lacking and not is_run:
        return ProvisionState(clause, one.what, "checked", RUN)
    why = one.why or (worded("since {why}", why=lacking) if lacking else NO_CHECK)
    return ProvisionState(clause, one.what, "not checked", why)


def not_checked(states: Iterable[ProvisionState]) -> list[str]:
    """Return the provisions that are not checked, each in a sentence with its reason."""
    return [one.said for one in states if one.state == "not checked"]


def left_to_the_engineer(states: Iterable[ProvisionState]) -> list[str]:
    """Return the provisions that the engineer shows, by their names."""
    return [one.what for one in states if one.state == "yours"]


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
        Clause of the code.
    what : str
        Name of the value, with its number if it has one.
    standing : Standing
        Source of the value.
    field : str
        Factor in the code's analysis, such as "drift" of `ASCE7`; empty for a formula.

    Examples
    --------
    >>> from frames.design import code_named
    >>> value = code_named("EN 1998").values["restoring"]
    >>> value.clause, str(value.standing)
    ('EN 1998-1 10.9.2', 'agrees with NTC 2018 of Italy, 7.10.5')
    """

    clause: str
    what: str
    standing: Standing = FROM_MEMORY
    field: str = ""


def weakest(standings: Iterable[Standing]) -> Standing:
    """Return the weakest source of several values."""
    found = tuple(dict.fromkeys(standings))
    if not found or any(one.kind == "own" for one in found):
        msg = (
            f"standings {[str(one) for one in found]} is empty: give the standing of at "
            "least one value"
        )
        raise CheckError(msg)
    kind = min((one.kind for one in found), key=_ORDER.index)
    return Standing(kind, "; ".join(one.source for one in found if one.kind == kind))


def standing_by(values: Mapping[str, CodeValue], *names: str, analysis: object = None) -> Standing:
    """Return the standing of a check that rests on values of a code."""
    missing = [name for name in names if name not in values]
    if missing:
        msg = f"{missing[0]!r} is not a value of the code: choose one of {', '.join(values)}"
        raise CheckError(msg)
    return weakest(
        FROM_MEMORY if _is_changed(values[name].field, analysis) else values[name].standing
        for name in names
    )


def _is_changed(field: str, analysis: object) -> bool:
    if analysis is None or not field:
        return False
    return bool(getattr(analysis, field) != getattr(type(analysis)(), field))
