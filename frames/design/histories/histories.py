"""Checks of time history analyses by a code's number of motions, at each bound of properties."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import xarray as xr

from frames.batch.cases import named_motions
from frames.batch.runs import BOUND, HAZARD, MASS_SHIFT, Runs
from frames.batch.time_histories import time_histories
from frames.design._errors import CheckError
from frames.design.calculation.check import Bound, Check, Checks
from frames.design.codes.bounds import BoundName, PropertyBounds
from frames.design.codes.history_rules import HistoryRules
from frames.design.codes.isolation import with_property_bounds
from frames.design.codes.registry import code_named
from frames.design.devices.limits import DesignLimits
from frames.design.histories.bound_checks import BoundChecks
from frames.design.histories.demand_table import demand_table
from frames.design.histories.eccentricity import Case, cases_of
from frames.results.recorded import with_present_names
from lir_element.argument_checks import require_choice

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pandas as pd

    from frames.design.codes.history_rules import ActionLevel
    from frames.design.codes.outcome import EquivalentLinear
    from frames.frame import Frame
    from frames.motion.ground_motion import GroundMotion

_BOUNDS: tuple[BoundName, ...] = ("lower", "nominal", "upper")


def bounded_histories(
    frame: Frame,
    motions: GroundMotion | Sequence[GroundMotion] | Mapping[str, GroundMotion],
    bounds: PropertyBounds,
    *,
    scales: float | Mapping[str, float] = 1.0,
    at: Sequence[BoundName] = _BOUNDS,
    **options: Any,
) -> dict[Bound, xr.Dataset]:
    """Run time histories at the bounds of the bearings' friction, all on all processors.

    Parameters
    ----------
    frame : Frame
        The structure, friction nominal.
    motions : GroundMotion, or a sequence or mapping of them
        The suite of motions.
    bounds : PropertyBounds
        Factors of friction.
    scales : float or mapping of str to float
        Factor on all motions, or on each by its name [-].
    at : sequence of str
        Bounds to run at.
    **options
        Options of `time_histories`: dt, level, record, workers and so on.

    Returns
    -------
    dict of str to xarray.Dataset
        A row a motion along `run`, by bound.

    Raises
    ------
    CheckError
        If a motion has no scale, or a word is no bound.
    ValueError
        If a bearing cannot be at a bound, or as `time_histories` has it.

    Examples
    --------
    >>> from frames.demo import example
    >>> from frames.design import PropertyBounds, PropertyModificationFactors, bounded_histories
    >>> frame, pulse = example(1.5)
    >>> bounds = PropertyBounds(friction=PropertyModificationFactors(0.9, 1.1),
    ...                         interface=PropertyModificationFactors(1.0, 1.1))
    >>> runs = bounded_histories(frame, {"pulse": pulse}, bounds, workers=1)
    >>> list(runs), runs["lower"]["status"].values.tolist()
    (['lower', 'nominal', 'upper'], ['ok'])
    """
    suite = named_motions(motions)
    factors = scales if isinstance(scales, Mapping) else dict.fromkeys(suite, scales)
    lacking = [name for name in suite if name not in factors]
    if lacking:
        msg = f"scales has no factor for the motion {lacking[0]!r}: give one factor for each motion"
        raise CheckError(msg)
    models: dict[str, Frame] = {name: with_property_bounds(frame, name, bounds) for name in at}
    cases = [(bound, name, factors[name]) for bound in models for name in suite]
    data = time_histories(models, suite, cases=cases, **options)
    return {bound: Runs(data).where(model=bound).data for bound in at}


def history_checks(
    runs: xr.Dataset | Mapping[Bound, xr.Dataset],
    frame: Frame,
    code: str | HistoryRules,
    *,
    bounds: PropertyBounds | None = None,
    limits: DesignLimits | None = None,
    equivalent: EquivalentLinear | None = None,
    action_level: str = "",
    moved: xr.Dataset | Mapping[Bound, xr.Dataset] | None = None,
) -> Checks:
    """Check time histories by the statistics of a code, at each bound of properties.

    Parameters
    ----------
    runs : xarray.Dataset or mapping of str to xarray.Dataset
        Results of `time_histories`, or by bound as those of `bounded_histories`.
    frame : Frame
        The structure, friction nominal.
    code : str or HistoryRules
        The code, "ASCE 7-22", "EN 1998" or "NCh2745", or its rules with other factors.
    bounds : PropertyBounds, optional
        Factors of the runs at a bound: the stable limit of interface slip depends on them.
    limits : DesignLimits, optional
        Limits of bearings and structure; the code's own limits are checked beside.
    equivalent : EquivalentLinear, optional
        For a code with minima (`HistoryRules.has_minima`: ASCE 7-22), with a superstructure. At its
        bounds its minima apply to displacement and base shear, and drifts grow as the base shear
        does. The shear of the storey over the lowest level is compared with its least value.
    action_level : str
        Level of the seismic action of the runs, if the code has several: NCh2745 checks the
        structure above at "design", the bearings at "maximum".
    moved : xarray.Dataset or mapping of str to xarray.Dataset, optional
        Runs of motions among those of `runs` with the floors' masses moved, by bound as these: a
        coordinate ``mass_shift`` along `run` gives the direction, "+x", "-x", "+y" or "-y". The
        worst direction raises the demands: by the ratio of the largest values, but slip, rim force,
        eccentricity of the sliders' resultant and lost axial force by their difference
        (docs/history_checks.md). None of them may fail.

    Returns
    -------
    Checks
        The checks at each bound, as far as the level covers it: number of motions, failed runs,
        displacement, slip, rims and forces of the worst bearing, drift of the worst storey, and the
        quantities in `limits`. If more runs failed than the rules allow, there are no values from
        the others: each check that needs them fails (`Check.void`), its demand is the peak of the
        runs, and its note names the failed runs. Notes also give the findings of the runs'
        assumption checks.

    Raises
    ------
    CheckError
        If runs and frame do not belong together, runs are missing, a motion has two scales, the
        code has no minima, or the level is not one of the code's.

    Examples
    --------
    >>> from frames.demo import example
    >>> from frames.design import PropertyBounds, PropertyModificationFactors
    >>> from frames.design import bounded_histories, history_checks
    >>> frame, pulse = example(1.5)
    >>> bounds = PropertyBounds(friction=PropertyModificationFactors(0.9, 1.1),
    ...                         interface=PropertyModificationFactors(1.0, 1.1))
    >>> runs = bounded_histories(frame, {"pulse": pulse}, bounds, workers=1)
    >>> checks = history_checks(runs, frame, "ASCE 7-22", bounds=bounds)
    >>> [check.title for check in checks.failed][0]  # one motion is not seven
    'number of motions'
    """
    rules = _rules(code)
    level = rules.level(action_level)
    cases = _cases(runs, rules, moved)
    return Checks(case_checks(cases, frame, level, bounds, limits or DesignLimits(), equivalent))


def case_checks(
    cases: Sequence[Case],
    frame: Frame,
    level: ActionLevel,
    bounds: PropertyBounds | None,
    limits: DesignLimits,
    equivalent: EquivalentLinear | None,
) -> list[Check]:
    """Return the checks of runs at each bound of a level, as `history_checks` has them."""
    found: list[Check] = []
    for case in cases:
        model = frame
        if bounds is not None and case.bound:
            model = with_property_bounds(frame, case.bound, bounds)
        found += BoundChecks(case, model, limits, equivalent, level).checks()
    return found


def history_demands(
    runs: xr.Dataset | Mapping[Bound, xr.Dataset],
    code: str | HistoryRules,
    *,
    moved: xr.Dataset | Mapping[Bound, xr.Dataset] | None = None,
) -> pd.DataFrame:
    """Return the design values of time histories: at each bound, and the envelope.

    Parameters
    ----------
    runs : xarray.Dataset or mapping of str to xarray.Dataset
        As for `history_checks`.
    code : str or HistoryRules
        As for `history_checks`.
    moved : xarray.Dataset or mapping of str to xarray.Dataset, optional
        Runs with the floors' masses moved, as for `history_checks`: accidental eccentricity.

    Returns
    -------
    pandas.DataFrame
        A row a quantity with its unit (SI); the worst bearing, storey or level. Columns:

        - each bound ("value" of runs at none): mean or largest of the runs, by the rules of the
          code; of the minimum axial force the mean or the smallest of the runs' smallest;
          ``attrs["statistics"]`` says which, and of how many;
        - envelope: the largest of these, and its place;
        - worst: the largest of all single runs (of the minimum axial force the smallest), and its
          run, with its status if it failed;
        - note: definition of the row, and gaps that do not count;
        - void: the reason, if more runs failed than the rules allow. The numbers of that bound are
          then the peaks of its runs, failed ones included, up to their end: no design values.
          Quantities that stopped runs cannot give are NaN.

        Minima and factors of codes are not in it.

    Raises
    ------
    CheckError
        If runs are missing, or a motion is there at two scales.

    Examples
    --------
    >>> from frames.demo import example
    >>> from frames.design import PropertyBounds, PropertyModificationFactors
    >>> from frames.design import bounded_histories, history_demands
    >>> frame, pulse = example(1.5)
    >>> bounds = PropertyBounds(friction=PropertyModificationFactors(0.9, 1.1),
    ...                         interface=PropertyModificationFactors(1.0, 1.1))
    >>> runs = bounded_histories(frame, {"pulse": pulse}, bounds, workers=1)
    >>> demands = history_demands(runs, "ASCE 7-22")
    >>> demands.loc["isolator displacement", "unit"]
    'm'
    """
    return demand_table(_cases(runs, _rules(code), moved))


def _rules(code: str | HistoryRules) -> HistoryRules:
    return code if isinstance(code, HistoryRules) else code_named(code).histories


def _cases(
    runs: xr.Dataset | Mapping[Bound, xr.Dataset],
    rules: HistoryRules,
    moved: xr.Dataset | Mapping[Bound, xr.Dataset] | None,
) -> list[Case]:
    # Each bound of the properties, with the runs with moved masses at the same one.
    rows = Runs()
    for given, tag in ((runs, "status"), ({} if moved is None else moved, MASS_SHIFT)):
        for bound, one in {"": given}.items() if isinstance(given, xr.Dataset) else given.items():
            require_choice("bound", bound, ("", *_BOUNDS), error=CheckError)
            data = with_present_names(one)
            if "run" not in data.dims or tag not in data.variables:
                raise CheckError(_unlike_runs(tag, bound))
            own = {BOUND: bound, HAZARD: ""} | ({} if tag == MASS_SHIFT else {MASS_SHIFT: ""})
            count = data.sizes["run"]
            rows += Runs(data.assign_coords({n: ("run", [v] * count) for n, v in own.items()}))
    if not len(rows):
        msg = "runs is empty: give the runs of at least one bound"
        raise CheckError(msg)
    return cases_of(rows, rules)


def _unlike_runs(tag: str, bound: str) -> str:
    where = f" at the bound {bound!r}" if bound else ""
    if tag == MASS_SHIFT:
        lacking = f"no coordinate {tag!r} along 'run': name the direction of each run, '+x'"
        return f"moved{where}: {lacking}"
    return f"runs{where}: no dimension 'run': give the Dataset of time_histories"
