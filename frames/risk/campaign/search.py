"""A search over numbers of a structure or its devices: the largest median of a limit state."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from scipy.interpolate import RBFInterpolator
from scipy.optimize import Bounds, brentq, direct
from scipy.stats import norm, qmc

from frames.risk._errors import CampaignError
from frames.risk.campaign.campaign import Campaign
from frames.risk.campaign.ductility import with_ductility
from frames.risk.campaign.plot_response import runs_by_model
from lir_element.fields import check_numbers, number

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from frames._types import FloatArray
    from frames.frame import Frame
    from frames.motion.ground_motion import GroundMotion
    from frames.risk.fragility.intensity import Intensity
    from frames.risk.fragility.limit_state import LimitState

    Point = Mapping[str, float]

SMOOTHING = 1e-3
"""Smoothing of the response surface: runs are few, so that it does not pass through each point."""

FRUITLESS = 256
"""Sobol' points drawn for each that is wanted, at most."""

EVALUATIONS = 300
"""Largest number of evaluations of the response surface by `scipy.optimize.direct`."""


@dataclass(frozen=True, kw_only=True)
class MedianSearch:
    """Search for the parameters at which the median intensity of a limit state is largest.

    The search starts with Sobol' points, and fits a response surface to the logarithms of their
    medians (a plane and linear radial functions). `scipy.optimize.direct` finds its maximum; that
    point is run, and the surface fitted again, `trials` times.

    Parameters
    ----------
    build : callable
        Makes the structure of a point, a dict of str to float; a ValueError means there is none.
    bounds : mapping of str to (float, float)
        Bounds of each number [SI].
    limit : LimitState
        Limit state whose median is maximised.
    intensity : Intensity
        Measure of the motions' intensity.
    scales : sequence of float
        Factors on the motions [-], a stripe each.
    constraint : callable, optional
        Ratio of a structure's checks [-]; at most 1 if it is allowed.
    points : int
        First points.
    trials : int
        Points after them.
    dispersion : float
        Dispersion of the lognormal curve whose mean over the stripes is that of the shares [-].
    seed : int
        Seed of the first points.

    Raises
    ------
    CampaignError
        If a number cannot be, or no point is allowed.

    Notes
    -----
    With a known dispersion a few runs give a median, even if a fit of both numbers does not
    converge. Medians beyond the stripes rank points, and are no result.

    Examples
    --------
    >>> from frames.demo import example
    >>> from frames.risk import Device, Intensity, LimitState, MedianSearch
    >>> frame, pulse = example()
    >>> search = MedianSearch(
    ...     build=lambda point: Device(**point).on(frame),
    ...     bounds={"capacity": (0.2, 0.4), "interface_friction": (0.1, 0.2)},
    ...     limit=LimitState.bearing_failure(),
    ...     intensity=Intensity(kind="scale"),
    ...     scales=[1.0, 1.5, 2.0],
    ...     points=4,
    ... )
    >>> [round(point["capacity"], 3) for point in search.first_points()]
    [0.282, 0.344, 0.381, 0.243]
    """

    build: Callable[[dict[str, float]], Frame]
    bounds: Mapping[str, tuple[float, float]]
    limit: LimitState
    intensity: Intensity
    scales: Sequence[float]
    constraint: Callable[[Frame], float] | None = None
    points: int = field(default=16, metadata=number("-", "[2, 1e4]"))
    trials: int = field(default=4, metadata=number("-", "[0, 1000]"))
    dispersion: float = field(default=0.4, metadata=number("-", "[0.01, 2]"))
    seed: int = field(default=0, metadata=number("-", "[0, 1e9]"))

    def __post_init__(self) -> None:
        check_numbers(self, error=CampaignError)
        for name, (low, high) in self.bounds.items():
            if not low < high:
                msg = f"{name}: low = {low:g} must be below high = {high:g}"
                raise CampaignError(msg)
        if self.points <= len(self.bounds):
            msg = f"points = {self.points} must exceed the {len(self.bounds)} of bounds: raise it"
            raise CampaignError(msg)

    def run(
        self,
        motions: Mapping[str, GroundMotion],
        *,
        store: str | Path,
        workers: int | None = None,
        client: Any = None,
        **options: Any,
    ) -> pd.DataFrame:
        """Run the points, each stage a resumed campaign, and return them.

        Parameters
        ----------
        motions : mapping of str to GroundMotion
            As for `Campaign`.
        store : str or path
            Folder of the campaigns' results databases.
        workers, client : int, distributed.Client, optional
            As for `Campaign.run`.
        **options
            Others of `Campaign`, as level and dt.

        Returns
        -------
        pandas.DataFrame
            A row a point: its numbers, stage, ratio of its checks, unknown runs, median; the last
            column, "best", is true of one.
        """
        rows: list[dict[str, Any]] = []
        todo = self.first_points()
        for stage in range(self.trials + 1):
            if stage:
                todo = [self.proposed(rows)]
            names = {_named(point): self.build(point) for point in todo}
            campaign = Campaign(
                names,
                dict(motions),
                store=Path(store) / f"stage-{stage}",
                scales=self.scales,
                **options,
            )
            data = campaign.run(workers=workers, client=client)
            runs = runs_by_model(data, motions, self.intensity)
            runs = with_ductility(runs, data, lambda built=names: built, [self.limit])  # type: ignore[misc]
            for point in todo:
                name = _named(point)
                exceeded = runs[name].exceeded(self.limit)
                scale, im = runs[name].of("scale"), runs[name].of("im")
                at = [im[scale == each].mean() for each in self.scales]
                shares = [float(_mean(exceeded[scale == each])) for each in self.scales]
                rows.append(
                    {
                        **point,
                        "stage": stage,
                        "ratio of checks [-]": self._checked(names[name]),
                        "unknown": int(np.isnan(exceeded).sum()),
                        f"median [{self.intensity.unit}]": median_of(shares, at, self.dispersion),
                    }
                )
        found = pd.DataFrame(rows)
        column = f"median [{self.intensity.unit}]"
        if not found[column].notna().any():
            msg = "no point has a median, no run has a known outcome: see the messages of its runs"
            raise CampaignError(msg)
        found["best"] = found.index == found[column].idxmax()
        return found

    def first_points(self) -> list[dict[str, float]]:
        """Return the first points: of Sobol's sequence those that are allowed."""
        sequence = qmc.Sobol(len(self.bounds), rng=np.random.default_rng(self.seed))
        found: list[dict[str, float]] = []
        for _ in range(FRUITLESS):
            drawn = [self._point(share) for share in sequence.random(_power(self.points))]
            found += [point for point in drawn if self._ratio(point) <= 1.0]
            if len(found) >= self.points:
                return found[: self.points]
        msg = (
            f"{len(found)} of {FRUITLESS * _power(self.points)} points within the bounds pass the "
            f"checks, and points = {self.points}: choose bounds within which more do"
        )
        raise CampaignError(msg)

    def proposed(self, rows: Sequence[Mapping[str, Any]]) -> dict[str, float]:
        """Return the point at which the response surface through points is highest."""
        column = f"median [{self.intensity.unit}]"
        known = [row for row in rows if math.isfinite(row[column])]
        shares = np.array([self._shares(row) for row in known])
        medians = np.log([row[column] for row in known])
        surface = RBFInterpolator(shares, medians, kernel="linear", degree=1, smoothing=SMOOTHING)
        lowest = float(medians.min())

        def depth(share: FloatArray) -> float:
            ratio = self._ratio(self._point(share))
            if ratio > 1.0:  # below all that is allowed, the more the further beyond
                return 1.0 - lowest + min(ratio, 10.0)
            return -float(surface([share])[0])

        size = len(self.bounds)
        best = direct(depth, Bounds([0.0] * size, [1.0] * size), maxfun=EVALUATIONS * size)
        if best.fun < 1.0 - lowest:
            return self._point(best.x)
        again = max(known, key=lambda row: row[column])  # no better point was found
        return {name: float(again[name]) for name in self.bounds}

    def _point(self, share: FloatArray) -> dict[str, float]:
        # Rounded, so that names of points and their numbers are the same ones.
        return {
            name: float(f"{low + (high - low) * part:.5g}")
            for (name, (low, high)), part in zip(self.bounds.items(), share, strict=True)
        }

    def _shares(self, point: Point) -> list[float]:
        return [(point[name] - low) / (high - low) for name, (low, high) in self.bounds.items()]

    def _ratio(self, point: Point) -> float:
        # Infinite if no structure can be made.
        try:
            frame = self.build({name: point[name] for name in self.bounds})
        except ValueError:
            return math.inf
        return self._checked(frame)

    def _checked(self, frame: Frame) -> float:
        return 0.0 if self.constraint is None else float(self.constraint(frame))


def median_of(shares: Sequence[float], at: Sequence[float], dispersion: float) -> float:
    """Return the median intensity that goes with shares at intensities, NaN if none is known.

    That of the lognormal curve of a dispersion whose mean over the stripes is that of the shares.
    """
    known = [(share, im) for share, im in zip(shares, at, strict=True) if math.isfinite(share)]
    if not known:
        return math.nan
    mean = min(max(float(np.mean([share for share, _ in known])), 1e-3), 1.0 - 1e-3)
    stripes = np.log([im for _, im in known])

    def excess(middle: float) -> float:
        return float(norm.cdf((stripes - middle) / dispersion).mean()) - mean

    reach = 8.0 * dispersion
    return math.exp(brentq(excess, stripes.min() - reach, stripes.max() + reach))


def _mean(values: FloatArray) -> float:
    known = values[~np.isnan(values)]
    return float(known.mean()) if len(known) else math.nan


def _named(point: Point) -> str:
    return ", ".join(f"{name} {value:.5g}" for name, value in point.items())


def _power(count: int) -> int:
    return int(1 << (count - 1).bit_length())
