"""A design code as one value with all its rules, found by its name."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple, Protocol, cast, runtime_checkable

from frames.design._errors import CheckError
from frames.design.calculation.standing import FROM_MEMORY, Standing
from frames.design.codes.bounds import factors_by_source
from frames.design.codes.history_rules import LOADS_OF_ASCE, HistoryRules, LoadRule
from frames.design.codes.prototype_programme import DesignToTest, PlannedTest, no_tests
from frames.design.hazard.code_rules import (
    HazardRules,
    add_rules,
    canonical,
    known_rules,
    rules_named,
)
from frames.design.hazard.spectrum import Spectrum
from lir_element.argument_checks import require_type
from lir_element.texts import worded

if TYPE_CHECKING:
    from frames.design.calculation.check import Bound
    from frames.design.codes.bounds import PropertyModificationFactors
    from frames.design.codes.code_values import CodeValue, Provision
    from frames.design.codes.isolation import Extremes, IsolationSystem
    from frames.design.codes.outcome import BoundResult
    from frames.design.codes.prototype_programme import AcceptanceRule
    from frames.design.codes.superstructure import Superstructure


@runtime_checkable
class AnalysisMethod(Protocol):
    """Equivalent-linear analysis of a code, with its factors: `ASCE7`, `EN1998`, `NCh2745`."""

    @property
    def name(self) -> str:
        """Name of the code that it is of."""

    def analyse(
        self,
        system: IsolationSystem,
        spectrum: Spectrum,
        bound: Bound,
        superstructure: Superstructure | None,
        extremes: Extremes,
    ) -> BoundResult:
        """Return analysis and checks at one bound, as `ASCE7.analyse`."""


class RimRule(NamedTuple):
    """Requirement of a code on the displacement at rim contact.

    Attributes
    ----------
    clause : str
        Clause.
    symbol : str
        Name of the needed displacement capacity in the code.
    least : float
        Share of it below which the rims must not be reached [-].
    note : str
        Meaning of rim contact below it under the code.
    standing : Standing
        Source of clause and share.

    Examples
    --------
    >>> from frames.design import code_named
    >>> code_named("ASCE 7-22").rims.symbol, code_named("ASCE 7-22").rims.least
    ('D_TM', 0.6)
    """

    clause: str
    symbol: str
    least: float
    note: str
    standing: Standing = FROM_MEMORY


class SpectrumKey(NamedTuple):
    """A key of ``[spectrum]`` in a project's file.

    Attributes
    ----------
    kind : type
        ``float`` for a number, or a Literal of the choices.
    unit : str
        Unit that it must be given in, "m/s^2" or "s"; "" for a pure number.
    default : object
        Default; the key is required if None.
    most : float, optional
        Largest number [SI].
    optional : bool
        True if it may be left out without a value in its place.

    Examples
    --------
    >>> from frames.design import code_named
    >>> code_named("ASCE 7-22").spectrum_keys["t_l"]
    SpectrumKey(kind=<class 'float'>, unit='s', default=8.0, most=None, optional=False)
    """

    kind: object = float
    unit: str = ""
    default: object = None
    most: float | None = None
    optional: bool = False


class ExampleProject(NamedTuple):
    """The example of ``lir new`` under a code."""

    spectrum: Mapping[str, object]  # keys of its spectrum [SI], which its motions follow
    sections: Mapping[str, str]  # sections of the file by name, in place of those of ASCE 7-22


MOST_IMPORTANT = 3.0
"""Largest importance factor [-]; codes have 0.6 to 1.5."""


def example_bearing(
    radius: str, slider: int, capacity: int, friction: float, interface: float, why: str
) -> str:
    """Return the section ``[bearing]`` of an example."""
    return (
        f'radius = "{radius}"\nslider_height = "{slider} mm"\n'
        f'slider_radius = "{slider} mm"          # wide enough for the resultant (e/a)\n'
        f'capacity = "{capacity} mm"               # displacement at rim contact: {why}\n'
        f"friction = {friction:g}\n"
        f"interface_friction = {interface:g}        # no slip before rim contact\n"
    )


NO_LIMITS = "no code: the limits of ASCE 7-10"
"""Clause of acceptance if a code's own limits were not read."""


@dataclass(frozen=True, kw_only=True, eq=False)
class DesignCode(HazardRules):
    """A design code; `register_code` makes it available to all functions that use a code.

    Parameters
    ----------
    name, aliases, damping, scaling
        As in `frames.design.hazard.code_rules.HazardRules`.
    title : str
        Title of the code.
    edition : str
        Edition that its clauses, formulas and tables are of, as report and console name it.
    values : mapping of str to CodeValue
        Values of the code with the source of each; all others are from memory.
    provisions : tuple of Provision
        Requirements on a project, checked or not.
    analysis : callable
        Returns the equivalent-linear analysis with all defaults; for example a class like `ASCE7`.
    histories : HistoryRules
        Rules for time histories.
    spectrum : callable
        Returns its design spectrum by the keys below, `Spectrum.asce7` for instance.
    spectrum_keys : mapping of str to SpectrumKey
        Keys of ``[spectrum]`` in a project's file.
    spectrum_by_points : callable, optional
        Returns its design spectrum through points: periods [s], pseudo-accelerations [m/s2], and
        the keys below; without it points are joined as `Spectrum.given` does.
    factors : callable
        Puts factors on friction together of their sources, `factors_by_source` if not given.
    points_keys : mapping of str to SpectrumKey
        Keys of ``[spectrum]`` besides ``points``; none is required.
    rims : RimRule
        Requirement on the displacement at rim contact.
    tests : callable
        Returns the tests of bearings from a `DesignToTest`.
    accepted : tuple of AcceptanceRule
        Acceptance criteria of its tests, as the programme states them.
    acceptance : str
        Clause of the limits that `acceptance_checks` holds measured loops against.
    loads : LoadRule
        Combinations of dead, live and snow load.
    example : ExampleProject, optional
        Example of ``lir new``; without it there is none.
    unread : mapping of str to str
        Keys of ``[superstructure]`` that its formulas do not read, with their reason in words.

    Raises
    ------
    CheckError
        If the number of motions whose mean counts is not the same in `scaling` and `histories`.

    Examples
    --------
    >>> from frames.design import code_named
    >>> code = code_named("NCh 2745")
    >>> code.name, sorted(code.spectrum_keys)
    ('NCh2745', ['soil', 'zone'])
    """

    title: str
    edition: str = ""
    values: Mapping[str, CodeValue] = field(default_factory=dict)
    provisions: tuple[Provision, ...] = ()
    analysis: Callable[[], AnalysisMethod]
    histories: HistoryRules
    spectrum: Callable[..., Spectrum]
    spectrum_keys: Mapping[str, SpectrumKey]
    rims: RimRule
    tests: Callable[[DesignToTest], Iterable[PlannedTest]] = field(default=no_tests)
    accepted: tuple[AcceptanceRule, ...] = ()
    acceptance: str = NO_LIMITS
    loads: LoadRule = LOADS_OF_ASCE
    example: ExampleProject | None = None
    unread: Mapping[str, str] = field(default_factory=dict)
    factors: Callable[..., PropertyModificationFactors] = field(default=factors_by_source)
    spectrum_by_points: Callable[..., Spectrum] | None = None
    points_keys: Mapping[str, SpectrumKey] = field(default_factory=dict)

    def __post_init__(self) -> None:
        least = self.scaling[0].least if self.scaling else 0
        if least != self.histories.mean_from:
            msg = (
                f"{self.name}: the mean counts from {self.histories.mean_from} motions on by "
                f"histories, from {least} by scaling: give both the same"
            )
            raise CheckError(msg)

    @property
    def cited(self) -> str:
        """Name and title, with the edition if it is given."""
        return f"{self.name}: {self.title}{f' ({self.edition})' if self.edition else ''}"

    def standing(self, name: str) -> Standing:
        """Return the source of one of its `values`; "from memory" if it is not listed."""
        return self.values[name].standing if name in self.values else FROM_MEMORY

    def by_points(
        self, periods: Sequence[float], accelerations: Sequence[float], **keys: float
    ) -> Spectrum:
        """Return a design spectrum of the code through the points of a site study.

        Parameters
        ----------
        periods : sequence of float
            Rising periods [s].
        accelerations : sequence of float
            Pseudo-accelerations for 5 % damping at the level of the code's spectrum [m/s2].
        **keys : float
            Values of the keys in `points_keys`.

        Returns
        -------
        Spectrum
            The spectrum, with the code's damping factors.

        Raises
        ------
        MotionError
            If the points are no spectrum.
        """
        if self.spectrum_by_points is not None:
            return self.spectrum_by_points(periods, accelerations, **keys)
        return Spectrum.given(
            periods, accelerations, code=self.name, name=worded("{code}, as given", code=self.name)
        )


def register_code(code: DesignCode, *, replace: bool = False) -> DesignCode:
    """Register a code: spectra, projects and checks accept its name from then on.

    Parameters
    ----------
    code : DesignCode
        The code.
    replace : bool
        True to replace a code of the same name.

    Returns
    -------
    DesignCode
        The same.

    Raises
    ------
    TypeError
        If it is no `DesignCode`.
    MotionError
        If one of its spellings is that of another code.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from frames.design import code_named, register_code
    >>> europe = code_named("EN 1998")
    >>> own = replace(europe, acceptance="EN 15129 8.3.4")  # its limits, once they were read
    >>> code = register_code(own, replace=True)
    >>> code_named("EN 1998").acceptance
    'EN 15129 8.3.4'
    >>> code = register_code(europe, replace=True)
    """
    require_type("code", code, DesignCode, "a DesignCode(name=..., ...)")
    add_rules(code, replace=replace)
    return code


def known_codes() -> tuple[DesignCode, ...]:
    """Return all codes that are registered."""
    return tuple(code for code in known_rules() if isinstance(code, DesignCode))


def code_named(name: str, error: type[ValueError] = CheckError) -> DesignCode:
    """Return a design code by its name or another spelling.

    Parameters
    ----------
    name : str
        "ASCE 7-22" (also "ASCE 7", "ASCE/SEI 7-22"), "EN 1998" ("EN 1998-1"), "NCh2745"
        ("NCh 2745"), or one that was registered.
    error : type
        Error for an unknown name.

    Returns
    -------
    DesignCode
        The code.

    Raises
    ------
    CheckError
        If there is none: the message lists those that are known.

    Examples
    --------
    >>> from frames.design import code_named
    >>> code_named("EN 1998-1").histories.displacement_factor
    1.2
    """
    return cast("DesignCode", rules_named(name, error))


def standing_in(code: str, name: str) -> Standing:
    """Return how well a value of a code is known."""
    spelled = canonical(code)
    found = [one for one in known_codes() if one.name == spelled]
    return found[0].standing(name) if found else FROM_MEMORY


class _HistoryRulesByCode(Mapping[str, HistoryRules]):
    """Rules of each code for time histories, by any spelling of its name."""

    def __getitem__(self, name: str) -> HistoryRules:
        return code_named(name, KeyError).histories  # type: ignore[arg-type]  # as mappings do

    def __iter__(self) -> Iterator[str]:
        return (code.name for code in known_codes())

    def __len__(self) -> int:
        return len(known_codes())


HISTORY_RULES: Mapping[str, HistoryRules] = _HistoryRulesByCode()
"""Rules of each code for time histories, by any spelling of its name."""
