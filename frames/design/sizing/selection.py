"""Selection of candidates: by one objective, and the Pareto-optimal ones."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, NamedTuple

from frames.design._errors import CheckError
from frames.design.calculation.not_evaluated import NOT_EVALUATED

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    import pandas as pd

    from frames.design.sizing.candidate import Candidate

Objective = Literal["base shear", "displacement", "plan diameter", "bearing volume", "cost"]
"""Quantity that a proposal minimises."""

OBJECTIVES: Mapping[str, Callable[[Candidate], float]] = {
    "base shear": lambda one: one.base_shear,
    "displacement": lambda one: one.displacement,
    "plan diameter": lambda one: one.plan_diameter,
    "bearing volume": lambda one: one.bearing_volume,
    "cost": lambda one: one.cost,
}
"""Number that each objective minimises, of a candidate that meets the target."""

_WEIGHED = ("displacement", "base shear", "plan diameter")


class Impossible(NamedTuple):
    """A pair of radius and friction of which no bearing can be made."""

    radius: float  # of the concave surfaces [m]
    friction: float  # of these [-]
    reason: str  # why, with value, bound and remedy


class NoCandidateError(CheckError):
    """Raised if no candidate meets the target; the message names the nearest and its deficits.

    Parameters
    ----------
    candidates : tuple of Candidate
        All that were fitted, with their reasons.
    impossible : tuple of Impossible
        Pairs of which no bearing can be made.

    Examples
    --------
    >>> from frames.design import DesignTarget, IsolationSystem, Spectrum, design
    >>> from lir_element import LIRBearing
    >>> bearing = LIRBearing(radius=1.5, slider_height=0.3, slider_radius=0.2, capacity=0.45,
    ...                      friction=0.06, interface_friction=0.25)
    >>> system = IsolationSystem(bearings=(bearing,) * 4, loads=(1.5e6,) * 4, plan=(9.0, 9.0),
    ...                          positions=((-4, -4), (4, -4), (4, 4), (-4, 4)))
    >>> narrow = DesignTarget(radii=(1.5, 2.0), frictions=(0.06,), max_displacement=0.1)
    >>> try:
    ...     design(system, Spectrum.asce7(s_ms=1.2, s_m1=0.6), bounds=None, target=narrow)
    ... except NoCandidateError as error:
    ...     [one.governing.what for one in error.candidates]
    ['displacement', 'displacement']
    """

    def __init__(
        self, candidates: tuple[Candidate, ...], impossible: tuple[Impossible, ...] = ()
    ) -> None:
        count = len(candidates) + len(impossible)
        said = f"none of {count} pairs of radius and friction meets the requirements"
        if candidates:
            near = min(candidates, key=lambda one: (len(one.lacks), one.governing.ratio))
            said += (
                f"; nearest: radius {near.radius:g} m, friction {near.friction.f_max:g}: "
                f"{_by_reason(near.lacks)}. "
            )
            if all(NOT_EVALUATED in one for one in near.lacks):
                said += "No bearing changes this: correct the model"
            elif own := [
                key for what, key in _LIMITS if any(x.startswith(what) for x in near.lacks)
            ]:
                said += f"Raise {' and '.join(own)}, or add radii and frictions"
            else:
                said += (
                    "Add radii and frictions, raise rim_share, or narrow the bounds of the "
                    "interface friction"
                )
        else:
            first = impossible[0]
            said += f": radius {first.radius:g} m, friction {first.friction:g}: {first.reason}"
        super().__init__(said)
        self.candidates, self.impossible = candidates, impossible


_LIMITS = (
    ("displacement ", "max_displacement"),
    ("base shear / weight ", "max_base_shear"),
    ("plan diameter ", "max_plan_diameter"),
)
"""Limits of a target, and the beginnings of the unmet requirements that they cause."""


def _by_reason(lacks: Sequence[str]) -> str:
    # Unmet requirements; those with one reason for no evaluation are together.
    found: dict[str, list[str]] = {}
    for lack in lacks:
        what, mark, why = lack.partition(f": {NOT_EVALUATED}")
        found.setdefault(mark + why or lack, []).append(what)
    return "; ".join(
        f"{' and '.join(whats)}{why}" if why.startswith(": ") else why
        for why, whats in found.items()
    )


class Place(NamedTuple):
    """A candidate among the others."""

    candidate: Candidate  # which
    # "proposed", "Pareto-optimal" (no other that meets the target has less displacement, base shear
    # and plate diameter at once, or is as good in some and better in another), "keeps what is
    # asked", or "rejected"
    outcome: Literal["proposed", "Pareto-optimal", "meets the target", "rejected"]


def ranked(found: Sequence[Candidate], least: str) -> tuple[Candidate, ...]:
    """Return the candidates that meet the target, best first."""
    good = [one for one in found if not one.lacks]
    return tuple(sorted(good, key=lambda one: (bool(one.warnings), OBJECTIVES[least](one))))


def pareto(found: Sequence[Candidate]) -> tuple[Candidate, ...]:
    """Return those that none beats in displacement, base shear and plan diameter at once."""
    good = [one for one in found if not one.lacks]
    values = {id(one): tuple(OBJECTIVES[name](one) for name in _WEIGHED) for one in good}

    def beaten(one: Candidate) -> bool:
        own = values[id(one)]
        return any(
            theirs != own and all(a <= b for a, b in zip(theirs, own, strict=True))
            for theirs in values.values()
        )

    return tuple(one for one in good if not beaten(one))


def placed(found: Sequence[Candidate], chosen: Candidate | None) -> tuple[Place, ...]:
    """Return each candidate with its outcome, in their order."""
    best = {id(one) for one in pareto(found)}
    return tuple(
        Place(
            one,
            "rejected"
            if one.lacks
            else "proposed"
            if one is chosen
            else "Pareto-optimal"
            if id(one) in best
            else "meets the target",
        )
        for one in found
    )


def table_of(
    found: Sequence[Candidate],
    chosen: Candidate | None = None,
    impossible: Sequence[Impossible] = (),
) -> pd.DataFrame:
    """Return all candidates, numbers in SI units, with their outcome."""
    import pandas as pd

    best = {id(one) for one in pareto(found)}
    rows: list[dict[str, object]] = [
        {"outcome": place.outcome, "Pareto-optimal": id(place.candidate) in best}
        | place.candidate.row()
        for place in placed(found, chosen)
    ]
    rows += [
        {
            "outcome": "cannot be made",
            "Pareto-optimal": False,
            "radius [m]": one.radius,
            "friction [-]": one.friction,
            "limited by": "cannot be made",
            "lacks": one.reason,
        }
        for one in impossible
    ]
    return pd.DataFrame(rows)
