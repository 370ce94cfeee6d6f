"""Rules of codes for time histories, and for dead, live and snow load."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Literal, NamedTuple, get_args

from frames.design._errors import CheckError
from frames.design.calculation.standing import FROM_MEMORY, Standing
from frames.model.load_combinations import isolator_combinations
from lir_element.argument_checks import require_choice
from lir_element.fields import check_numbers, number
from lir_element.texts import worded

if TYPE_CHECKING:
    from frames.design.hazard.spectrum import Spectrum

Judged = Literal["all", "superstructure", "isolation"]

MCE_R, DESIGN, MAXIMUM = "MCE_R", "design", "maximum"
"""Names of levels."""

NCH_MAXIMUM = 1.2
"""M_M of NCh2745: maximum over design level, to be confirmed against the standard."""


@dataclass(frozen=True)
class ActionLevel:
    """A level of the seismic action, and its checked parts.

    Parameters
    ----------
    name : str
        Name in tables and checks.
    factor : float
        Factor on motions that are scaled to the design spectrum [-], at least 1.
    judges : {"all", "superstructure", "isolation"}
        Checked parts at this level: the structure above (base shear, storey shears and drifts,
        accelerations), the bearings (displacement, rims, slip, forces, uplift), or both.

    Raises
    ------
    CheckError
        If the factor is out of bounds, or a word is none of those allowed.

    Examples
    --------
    >>> from frames.design import HISTORY_RULES
    >>> [level.name for level in HISTORY_RULES["NCh2745"].levels]
    ['design', 'maximum']
    """

    name: str
    factor: float = field(default=1.0, metadata=number("-", "[1, 10)"))
    judges: Judged = "all"

    def __post_init__(self) -> None:
        check_numbers(self, error=CheckError)
        require_choice("judges", self.judges, get_args(Judged), error=CheckError)

    @property
    def judges_bearings(self) -> bool:
        """True if the bearings are checked at this level."""
        return self.judges != "superstructure"

    @property
    def judges_structure(self) -> bool:
        """True if the structure above the bearings is checked at this level."""
        return self.judges != "isolation"


MOST_ECCENTRIC = 0.25
"""Largest accidental eccentricity over the sides of the plan [-]; codes require 0.05."""

_COUNT, _SHARE = number("-", "[1, 1000)"), number("-", "(0, inf)")


@dataclass(frozen=True, kw_only=True)
class HistoryRules:
    """Rules of a code for time histories; clause numbers to be confirmed against the standard.

    `HISTORY_RULES` has those of the codes; `dataclasses.replace` changes a factor.

    Parameters
    ----------
    code : str
        Name of the code.
    least : int
        Least number of motions.
    mean_from : int
        Number of motions from which on the mean of their largest values counts, below it the
        largest.
    drift : float, optional
        Limit of the storey drift ratio [-]; None if the code has none for this level of motion.
    drift_factor : float
        Factor on the drift compared with it [-]: to a more frequent earthquake, nu of EN 1998.
    drift_classes : tuple of (str, float)
        Kinds of non-structural elements with the limit of each [-], if a code has several; a
        project names one.
    second_order : float, optional
        Storey drift ratio times R_I above which the analysis must include the effects of gravity on
        the displaced structure (P-Delta) [-]; None if the code has none.
    torsion : float, optional
        Largest drift of a line of nodes over the mean of its storey [-] up to which a structure is
        regular in plan; None if the code has none.
    stability : tuple of float, optional
        Largest coefficient of P-Delta theta = P d / (V h) of a storey [-], without and with the
        effects of gravity on the displaced structure in the analysis; None if the code has none.
    displacement_factor : float
        Factor on the isolators' displacement [-].
    uplift_allowed : bool
        True if bearings may lift off; if not, a run in which one does is unacceptable.
    least_gap : float
        Gap up to which a bearing still counts as in contact [m]. A proposal: sliders and liners
        spring back from a common pressure by 60 MPa times 225 mm over 20 GPa
        (docs/choices_bearing.md), 0.7 mm, rounded up. Notes name each such run; 0 counts any gap.
    unacceptable_allowed : int
        Number of runs that may fail while the mean of the others is valid for all: the median of
        all times `median_factor` is then its lower bound.
    median_factor : float
        Factor on the median for failed runs [-].
    engagement : float, optional
        Share of the displacement below which rims must not engage [-]; that of the code,
        `RIM_RULES`, if None.
    has_minima : bool
        True if the equivalent-linear analysis gives least values of the histories' demands, as
        D_TM_dyn, V_b_dyn and V_s_dyn of its calculation.
    accidental_eccentricity : float
        Share of the plan's sides by which the masses of floors are moved in each direction [-]; 0:
        not at all.
    levels : tuple of ActionLevel
        Levels of the seismic action of the histories, and the checked parts of each.
    statistic_clause, displacement_clause, drift_clause, force_clause, uplift_clause : str
        Clauses; `uplift_clause` is that of the requirements on bearings that lift off.
    torsion_clause, stability_clause : str
        Clauses of `torsion` and `stability`.
    eccentricity_clause : str
        Clause of accidental eccentricity.
    standard : str
        Beginning of clauses: the standard, or a part of it; the code's name if empty.

    Examples
    --------
    >>> from frames.design import code_named
    >>> rules = code_named("EN 1998").histories
    >>> rules.least, rules.mean_from, rules.uplift_allowed
    (3, 7, False)
    """

    code: str
    least: int = field(metadata=_COUNT)
    mean_from: int = field(metadata=_COUNT)
    drift: float | None = field(default=None, metadata=_SHARE)
    drift_factor: float = field(default=1.0, metadata=number("-", "[0.1, 1]"))
    drift_classes: tuple[tuple[str, float], ...] = ()
    second_order: float | None = field(default=None, metadata=_SHARE)
    torsion: float | None = field(default=None, metadata=number("-", "[1, 10)"))
    stability: tuple[float, float] | None = field(default=None, metadata=number("-", "(0, 1)"))
    displacement_factor: float = field(default=1.0, metadata=number("-", "[1, 10)"))
    uplift_allowed: bool = False
    least_gap: float = field(default=1e-3, metadata=number("m", "[0, inf)"))
    unacceptable_allowed: int = field(default=0, metadata=number("-", "[0, inf)"))
    median_factor: float = 1.2
    engagement: float | None = field(default=None, metadata=_SHARE)
    has_minima: bool = False
    accidental_eccentricity: float = field(
        default=0.0,
        metadata=number(
            "-",
            f"[0, {MOST_ECCENTRIC})",
            remedy="0.05 is a twentieth of the plan's sides, 0 leaves it out",
        ),
    )
    levels: tuple[ActionLevel, ...] = (ActionLevel(DESIGN),)
    statistic_clause: str = ""
    displacement_clause: str = ""
    drift_clause: str = ""
    torsion_clause: str = ""
    stability_clause: str = ""
    force_clause: str = ""
    uplift_clause: str = ""
    eccentricity_clause: str = ""
    standard: str = ""

    @property
    def cited(self) -> str:
        """Beginning of clauses."""
        return self.standard or self.code

    def __post_init__(self) -> None:
        check_numbers(self, error=CheckError)
        if not self.levels:
            msg = "levels is empty: give at least one seismic level"
            raise CheckError(msg)

    def for_elements(self, kind: str) -> HistoryRules:
        """Return the rules with the limit of drifts of a kind of non-structural elements.

        Parameters
        ----------
        kind : str
            One of `drift_classes`.

        Returns
        -------
        HistoryRules
            The others are the same.

        Raises
        ------
        CheckError
            If the code does not have the kind.
        """
        limits = dict(self.drift_classes)
        if not limits:
            msg = (
                f"nonstructural = {kind!r}: {self.code} has one drift limit for all elements; "
                "leave nonstructural out"
            )
            raise CheckError(msg)
        require_choice("nonstructural", kind, tuple(limits), error=CheckError)
        return replace(self, drift=limits[kind])

    @property
    def bearing_level(self) -> str:
        """The level of the seismic action at which bearings are checked."""
        return next(level.name for level in self.levels if level.judges_bearings)

    def level(self, name: str = "") -> ActionLevel:
        """Return a level by its name, the only one if "".

        Parameters
        ----------
        name : str
            Name of one of `levels`.

        Returns
        -------
        ActionLevel
            The level.

        Raises
        ------
        CheckError
            If there is none of that name, or none is named of several.
        """
        names = [each.name for each in self.levels]
        if not name and len(names) > 1:
            factors = ", ".join(
                f"{each.name!r} (motions times {each.factor:g}: {each.judges})"
                for each in self.levels
            )
            msg = (
                f"{self.cited} has checks at {len(names)} levels, {factors}: set the level of the "
                f"runs, action_level={names[0]!r}"
            )
            raise CheckError(msg)
        require_choice("action_level", name or names[0], tuple(names), error=CheckError)
        return self.levels[names.index(name or names[0])]


Combinations = dict[str, dict[str, float]]
"""Factors of the load cases "D", "L" and "S" by name of the combination."""

CASES = ("D", "L", "S")
"""Load cases: dead load, live load, snow."""


class LoadRule(NamedTuple):
    """Load combinations of an isolated building in a code.

    Attributes
    ----------
    clause : str
        Clause of the code.
    mass : mapping of str to float
        Share of each load case that is seismic mass [-], unless a project gives another.
    combinations : callable
        Returns the vertical load combinations of the bearings without the horizontal earthquake.
        "average" among them is that of time histories. Its argument is the acceleration of the
        vertical earthquake [g], or None without it.
    standing : Standing
        Source of the rule.
    note : str
        Factors of the loads, in words.
    vertical : callable
        Returns that acceleration of a spectrum [g]: S_MS of ASCE 7, None if there is none.

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
    standing: Standing = FROM_MEMORY
    note: str = ""
    vertical: Callable[[Spectrum], float | None] = lambda spectrum: spectrum.parameters.get("S_MS")

    def combined(self, spectrum: Spectrum | None) -> Combinations:
        """Return the combinations with the vertical earthquake of a spectrum; None without it."""
        return self.combinations(None if spectrum is None else self.vertical(spectrum))

    @property
    def cited(self) -> str:
        """Clause, with a star if it is from memory, and note."""
        said = self.standing.cited(self.clause)
        return worded("{clause}: {note}", clause=said, note=self.note) if self.note else said


LOADS_OF_ASCE = LoadRule(
    "ASCE/SEI 7-22, 12.7.2 and 17.2.7.1",
    {"D": 1.0, "L": 0.0, "S": 0.0},
    lambda s_ms: isolator_combinations(s_ms or 0.0),
    FROM_MEMORY,
    "of live loads, only 25 % of those of storage count as mass",
)
"""Seismic weight and combinations of ASCE 7, and of codes that give none of their own."""
