"""The optional package pyFragility as the fits use it: maximum likelihood, or nothing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from frames._types import BoolArray, FloatArray, IntArray


class Likely(NamedTuple):
    """Parameters of the largest likelihood, and the covariance of their estimates."""

    parameters: FloatArray
    covariance: FloatArray


def _package() -> Any:
    try:
        import pyFragility
    except ImportError as cause:
        msg = "this fit needs the package pyFragility: pip install 'lir-dcfp[fragility]'"
        raise ImportError(msg) from cause
    return pyFragility


def binomial(
    im: FloatArray,
    count: FloatArray,
    total: FloatArray,
    link: str,
    *,
    clusters: IntArray | None = None,
    start: FloatArray | None = None,
) -> Likely | None:
    """Fit ``link(P) = b0 + b1 ln im`` to counts.

    Shapes: im, count, total (n,), clusters (n,), start (2,).
    """
    package = _package()
    some, others = im[count > 0.0], im[count < total]
    if not (len(some) and len(others) and others.max() > some.min()):
        return None
    model = package.binomial.BinomialGLM(im, count, total, link=link, cluster=clusters)
    with np.errstate(all="ignore"):  # intermediate values; convergence is checked below
        fit = package.engine.fit_likelihood(model, start=start, warn=False)
    if not fit.converged or not fit.params[1] > 0.0:
        return None
    if start is not None:
        return Likely(fit.params, np.full((2, 2), np.nan))
    return Likely(fit.params, fit.covariance("mle" if clusters is None else "sandwich"))


def censored_lognormal(capacity: FloatArray, censored: BoolArray) -> Likely | None:
    """Fit a lognormal distribution to capacities of which some are only known to be larger.

    Shapes: capacity (n,), censored (n,).
    """
    package = _package()
    if len(np.unique(capacity[~censored])) < 2:
        return None
    model = package.capacity.LognormalCapacity(capacity, censored)
    with np.errstate(all="ignore"):
        fit = package.engine.fit_likelihood(model, warn=False)
    return Likely(fit.params, fit.covariance("mle")) if fit.converged else None
