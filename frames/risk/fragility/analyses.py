"""Multiple stripes, clouds and incremental dynamic analyses, run in batches."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

from frames._errors import ModelWarning
from frames.batch.cases import named_models, named_motions
from frames.batch.time_histories import time_histories
from frames.risk._errors import FragilityError
from frames.risk.fragility.hunt_fill import HuntFill
from frames.risk.fragility.incremental import IDA
from frames.risk.fragility.intensity import OWN, IntensityMeasure, is_same
from frames.risk.fragility.limit_state import LimitState
from frames.risk.fragility.runs import CLOUD, HUNT, STRIPES, IntensityRuns
from frames.risk.fragility.scaled_motions import factors_to
from lir_element.argument_checks import require_positive, require_type
from lir_element.errors import AnalysisWarning, RunStatus

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from frames.model.frame_data import FrameData
    from frames.motion.ground_motion import GroundMotion


def ida(
    model: FrameData,
    motions: object,
    *,
    intensity: IntensityMeasure,
    rules: HuntFill,
    limit: LimitState | None = None,
    known: IntensityRuns | None = None,
    **options: Any,
) -> IDA:
    """Analyse a structure under motions of increasing intensity, up to a limit state.

    Each round is one call of `time_histories` with the next intensities of all motions.

    Parameters
    ----------
    model : Frame
        The structure.
    motions : GroundMotion, or a sequence or mapping of them
        The motions; they are scaled as a whole.
    intensity : IntensityMeasure
        The measure that rises.
    rules : HuntFill
        Rules for the next intensities.
    limit : LimitState, optional
        Limit state of the search; failure of a bearing if None.
    known : IntensityRuns, optional
        Runs of the same structure and measure that are there already, as of an analysis that was
        interrupted: it goes on from them.
    **options
        Options of `time_histories`: `level`, `dt`, `workers` and so on.

    Returns
    -------
    IDA
        Runs, curves and capacities.

    Raises
    ------
    FragilityError
        If an option is one that is decided here, or `known` is of another measure or has runs of
        motions that are not given.

    Warns
    -----
    AnalysisWarning
        If runs failed numerically: they count as neither.

    Examples
    --------
    In the gallery: "Incremental dynamic analysis" (docs/gallery/research/a_ida.py).
    """
    require_type("intensity", intensity, IntensityMeasure, OWN)
    require_type("rules", rules, HuntFill, "a HuntFill")
    state = LimitState.bearing_failure() if limit is None else limit
    grounds = named_motions(motions)
    if known is None:
        begin = [(motion, level) for motion in grounds for level in rules.next_intensities([], [])]
        first = factors_to(grounds, begin, intensity)
        runs = _run_at(model, grounds, first, intensity, options, HUNT)
    else:
        runs = _checked(known, grounds, intensity)
    while cases := _next_cases(runs, tuple(grounds), rules, state):
        cases = factors_to(grounds, cases, intensity)
        runs = runs.joined(_run_at(model, grounds, cases, intensity, options, HUNT))
    return IDA(runs, state, rules)


def _run_at(
    model: FrameData,
    motions: Mapping[str, GroundMotion],
    cases: Sequence[tuple[str, float]],
    intensity: IntensityMeasure,
    options: Mapping[str, Any],
    plan: str,
) -> IntensityRuns:
    """Run a structure under scaled motions, all at once."""
    fixed = {"scales", "cases", "record"} & set(options)
    if fixed:
        msg = f"{sorted(fixed)[0]} is set by this analysis: leave it out"
        raise FragilityError(msg)
    structures = named_models(model)
    if len(structures) > 1:
        msg = f"{len(structures)} structures: give one, compare_fragility compares their curves"
        raise FragilityError(msg)
    ((name, structure),) = structures.items()
    wanted = [(name, motion, factor) for motion, factor in cases]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AnalysisWarning)  # the warnings are in the table
        # intensities begin low on purpose
        warnings.filterwarnings("ignore", ".*the bearings hardly slide", ModelWarning)
        data = time_histories({name: structure}, motions, cases=wanted, **options)
    runs = IntensityRuns.from_dataset(data, motions, intensity, plan=plan)
    doubtful = runs.table[runs.of("status") == RunStatus.INACCURATE.name.lower()]
    for own, what in (
        (runs.failed, "failed numerically and count as neither"),
        (doubtful, "are inaccurate and count with their demands"),
    ):
        if len(own):
            motion, im, message = (own.iloc[0][key] for key in ("motion", "im", "message"))
            warnings.warn(
                f"{len(own)} of {len(runs.table)} runs {what}; the first, {motion} at {im:.3g} "
                f"{intensity.unit}: {message}",
                AnalysisWarning,
                stacklevel=3,
            )
    return runs


def _checked(
    known: IntensityRuns, motions: Mapping[str, object], intensity: IntensityMeasure
) -> IntensityRuns:
    require_type("known", known, IntensityRuns, "IntensityRuns")
    if not is_same(known.intensity, intensity):
        msg = f"known is of {known.intensity.label}, not of {intensity.label}: take one measure"
        raise FragilityError(msg)
    stray = [name for name in known.motions if name not in motions]
    if stray:
        msg = f"known has runs of {stray[0]!r}, which is not among the motions: add it"
        raise FragilityError(msg)
    return known


def _next_cases(
    runs: IntensityRuns, motions: Sequence[str], rules: HuntFill, limit: LimitState
) -> list[tuple[str, float]]:
    over, im, cases = runs.exceeded(limit), runs.of("im"), []
    for motion in motions:
        own = runs.of("motion") == motion
        cases += [(motion, level) for level in rules.next_intensities(im[own], over[own])]
    return cases


def multiple_stripes(
    model: FrameData,
    motions: object,
    levels: Sequence[float],
    *,
    intensity: IntensityMeasure,
    **options: Any,
) -> IntensityRuns:
    """Analyse a structure under all motions, each scaled to each given intensity.

    Parameters
    ----------
    model : Frame
        The structure.
    motions : GroundMotion, or a sequence or mapping of them
        The motions. If each stripe has motions of its own, join the runs of several calls.
    levels : sequence of float
        Intensities of the stripes, in the unit of the measure.
    intensity : IntensityMeasure
        The measure.
    **options
        Options of `time_histories`.

    Returns
    -------
    IntensityRuns
        A run a motion and stripe.

    Raises
    ------
    FragilityError
        If there is no level, or one is not positive.

    Examples
    --------
    >>> from frames.demo import example
    >>> from frames.risk import Intensity, multiple_stripes
    >>> frame, pulse = example(1.0)
    >>> intensity = Intensity(kind="PGA", measure="x")
    >>> runs = multiple_stripes(frame, pulse, [0.5, 1.0], intensity=intensity, workers=1)
    >>> runs.table["im"].round(6).tolist(), runs.table["outcome"].tolist()
    ([0.5, 1.0], ['complete', 'complete'])
    """
    require_type("intensity", intensity, IntensityMeasure, OWN)
    if not len(levels):
        msg = "levels is empty: give the intensities of the stripes"
        raise FragilityError(msg)
    stripes = [require_positive("level", each, error=FragilityError) for each in levels]
    grounds = named_motions(motions)
    cases = [(motion, level) for motion in grounds for level in stripes]
    cases = factors_to(grounds, cases, intensity)
    return _run_at(model, grounds, cases, intensity, options, STRIPES)


def cloud_analysis(
    model: FrameData,
    motions: object,
    *,
    intensity: IntensityMeasure,
    scales: Sequence[float] = (1.0,),
    **options: Any,
) -> IntensityRuns:
    """Analyse a structure under unscaled motions, or with a few factors.

    Parameters
    ----------
    model : Frame
        The structure.
    motions : GroundMotion, or a sequence or mapping of them
        The motions.
    intensity : IntensityMeasure
        The measure that demands are regressed on.
    scales : sequence of float
        Factors on all motions [-], positive.
    **options
        Options of `time_histories`.

    Returns
    -------
    IntensityRuns
        A run a motion and factor.

    Raises
    ------
    FragilityError
        If there is no factor, or one is not positive.

    Examples
    --------
    >>> from frames.demo import example
    >>> from frames.risk import Intensity, cloud_analysis
    >>> frame, pulse = example(1.0)
    >>> intensity = Intensity(kind="PGA", measure="x")
    >>> runs = cloud_analysis(frame, pulse, intensity=intensity, scales=(1.0, 1.5), workers=1)
    >>> runs.table["im"].round(6).tolist()
    [1.0, 1.5]
    """
    require_type("intensity", intensity, IntensityMeasure, OWN)
    if not len(scales):
        msg = "scales is empty: give factors on the motions, 1 for as they are"
        raise FragilityError(msg)
    factors = [require_positive("scale", each, "-", error=FragilityError) for each in scales]
    grounds = named_motions(motions)
    cases = [(name, factor) for name in grounds for factor in factors]
    return _run_at(model, grounds, cases, intensity, options, CLOUD)
