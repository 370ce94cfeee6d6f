"""Records drawn with replacement, and what the fits of both kinds of runs share."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from frames._types import FloatArray
from frames.risk._errors import FragilityError
from lir_element.argument_checks import require_positive, require_type

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy.typing as npt

RESAMPLES = 500
"""Resamples of a confidence band, as a rule."""

LEAST_FITS = 0.5
"""Share of resamples that must allow a fit."""

Fit = Callable[[FloatArray], FloatArray | None]
"""Of the weights of the records (n,) to parameters, None where they allow no fit."""


def checked_runs(
    im: npt.ArrayLike, values: npt.ArrayLike, records: Sequence[str]
) -> tuple[FloatArray, FloatArray]:
    """Return intensities and values of runs as arrays (n,), or raise.

    Shapes: im, values (n,), result (n,).
    """
    at, found = np.asarray(im, dtype=np.float64), np.asarray(values, dtype=np.float64)
    if at.ndim != 1 or at.shape != found.shape or len(records) != len(at):
        msg = f"shapes {at.shape}, {found.shape}, {len(records)} records: give lists of one length"
        raise FragilityError(msg)
    if not (np.isfinite(at) & (at > 0.0)).all():
        msg = f"intensity {at[~(at > 0.0)][:1].tolist()} must be positive and finite"
        raise FragilityError(msg)
    return at, found


def resampled(count: int, fit: Fit, size: int, resamples: int, seed: int) -> FloatArray:
    """Return the parameters of fits to records that are drawn with replacement.

    Shapes: result (resamples, size).
    """
    require_type("seed", seed, int, "a whole number")
    require_type("resamples", resamples, int, "a whole number")
    require_positive("resamples", resamples, error=FragilityError)
    rng = np.random.default_rng(seed)
    found = np.full((resamples, size), np.nan)
    for row in found:
        again = fit(rng.multinomial(count, np.full(count, 1.0 / count)).astype(np.float64))
        if again is not None:
            row[:] = again
    fits = int(np.isfinite(found).all(axis=1).sum())
    if fits < LEAST_FITS * resamples:
        msg = f"{fits} of {resamples} resamples allow a fit: run more records or intensities"
        raise FragilityError(msg)
    return found


def no_fit(at: FloatArray, over: FloatArray) -> str:
    """Say why outcomes (n,) at intensities (n,) determine no curve."""
    if not over.any() or over.all():
        what = "no run exceeds" if not over.any() else "all runs exceed"
        return f"{what} the limit state: run {'higher' if not over.any() else 'lower'} intensities"
    return (
        f"no fit: exceeded from {at[over > 0.5].min():.4g}, not exceeded up to "
        f"{at[over < 0.5].max():.4g}; the outcomes must overlap and exceedance grow with the "
        "intensity: run more records, or intensities between"
    )
