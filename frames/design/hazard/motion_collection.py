"""Ground motions by name, with their facts and measures; `MotionSet` adds the operations."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from scipy.fft import irfft, next_fast_len, rfft

from frames._errors import MotionError
from frames.design.hazard.motion_measures import motion_measures, pair_spectrum
from frames.design.hazard.scaling import Scaling
from frames.motion.ground_motion import GroundMotion
from lir_element.argument_checks import require_choice, require_type
from lir_element.texts import html_table, joined, worded
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    import numpy.typing as npt

    from frames._types import ComplexArray

SAME = 0.999
"""Correlation of two components from which they are one record [-]."""

STRONGEST = 2.5
"""Horizontal PGA above almost all that was recorded [g]."""

CONVERSIONS = {
    "g to m/s2": STANDARD_GRAVITY,
    "g to cm/s2": 100.0 * STANDARD_GRAVITY,
    "g to in/s2": STANDARD_GRAVITY / 0.0254,
    "m/s2 to g": 1.0 / STANDARD_GRAVITY,
    "cm/s2 to g": 0.01 / STANDARD_GRAVITY,
    "in/s2 to g": 0.0254 / STANDARD_GRAVITY,
    "cm/s2 to m/s2": 0.01,
    "m/s2 to cm/s2": 100.0,
}
"""Factors that change a unit."""


def twins(motions: Mapping[str, GroundMotion]) -> tuple[str, ...]:
    """Return which motions are one record under several names."""
    flat = {
        name: [a / np.linalg.norm(a) for a in (motion.x, motion.y) if a is not None and a.any()]
        for name, motion in motions.items()
    }
    longest = max((len(a) for each in flat.values() for a in each), default=1)
    size = next_fast_len(2 * longest, real=True)
    spectra = {name: [rfft(a, size) for a in each] for name, each in flat.items()}
    found = [
        worded("{one} and {other}", one=one, other=other)
        for one, other in combinations(spectra, 2)
        if motions[one].dt == motions[other].dt
        and any(_same(a, b, size) for a in spectra[one] for b in spectra[other])
    ]
    if not found:
        return ()
    return (
        worded(
            "{names}: identical or proportional histories, probably one record twice: the "
            "mean is not that of {count} motions. Replace one of them",
            names=joined(*found),
            count=len(motions),
        ),
    )


def _same(a: ComplexArray, b: ComplexArray, size: int) -> bool:
    # Correlation at any delay, of spectra of components of norm 1; first a bound on it.
    if 2.0 / size * float(np.abs(a) @ np.abs(b)) < SAME:
        return False
    return float(np.abs(irfft(a * np.conj(b), size)).max()) > SAME


def factor_doubts(factor: float, motions: Mapping[str, GroundMotion]) -> tuple[str, ...]:
    """Return whether a factor on motions changes a unit, or makes them stronger than any ground."""
    peaks = {
        name: float(np.hypot(*m.components[:, :2].T).max()) / STANDARD_GRAVITY
        for name, m in motions.items()
    }
    name = max(peaks, key=lambda each: peaks[each])
    remedy = "set the unit of the files in the column "
    remedy += '"unit" of their table; scale = 1 leaves motions as recorded'
    for words, value in CONVERSIONS.items():
        if abs(abs(factor) / value - 1.0) < 0.005:
            return (
                worded(
                    "scale = {factor:g} is the factor from {one} to {other} (PGA of {motion} then "
                    "{peak:.3g} g): {remedy}",
                    factor=factor,
                    **dict(zip(("one", "other"), words.split(" to "), strict=True)),
                    motion=name,
                    peak=peaks[name],
                    remedy=remedy,
                ),
            )
    if peaks[name] > STRONGEST:
        return (
            worded(
                "scale = {factor:g} gives {motion} a PGA of {peak:.3g} g, above the {most:g} g of "
                "almost all records: {remedy}",
                factor=factor,
                motion=name,
                peak=peaks[name],
                most=STRONGEST,
                remedy=remedy,
            ),
        )
    return ()


@dataclass(frozen=True, eq=False, repr=False)
class MotionCollection(Mapping[str, GroundMotion]):
    """Ground motions by name; parameters as in `MotionSet`."""

    motions: Mapping[str, GroundMotion] | Sequence[GroundMotion]
    facts: Mapping[str, Mapping[str, object]] = field(default_factory=dict)
    scaling: Scaling | None = None

    def __post_init__(self) -> None:
        """Check and copy."""
        given = self.motions
        pairs = (
            list(given.items())
            if isinstance(given, Mapping)
            else [(getattr(motion, "name", ""), motion) for motion in given]
        )
        for name, motion in pairs:
            require_type(f"motions[{name!r}]", motion, GroundMotion, "a GroundMotion")
        names = [name for name, _ in pairs]
        bad = [name for name in names if not name or names.count(name) > 1]
        if bad or not names:
            found = f"name {bad[0]!r} is empty or there twice" if bad else "no motion is given"
            msg = f"{found}: give motions by name, {{'name': motion}}"
            raise MotionError(msg)
        still = [name for name, motion in pairs if not motion.components[:, :2].any()]
        if still:
            msg = (
                f"motion {still[0]!r} has x = y = 0 throughout: name the file of its "
                "accelerations, or leave the motion out"
            )
            raise MotionError(msg)
        stray = set(self.facts) - set(names)
        if stray:
            msg = (
                f"facts of {sorted(stray)[0]!r} belong to no motion: use the names "
                f"{', '.join(names)}"
            )
            raise MotionError(msg)
        object.__setattr__(self, "motions", dict(pairs))
        object.__setattr__(self, "facts", {n: dict(self.facts.get(n, {})) for n in names})

    def __getitem__(self, name: str) -> GroundMotion:
        """Return a motion by its name."""
        return self._by_name[name]

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names."""
        return iter(self._by_name)

    def __len__(self) -> int:
        """Return the number of motions."""
        return len(self._by_name)

    @property
    def _by_name(self) -> Mapping[str, GroundMotion]:
        return self.motions if isinstance(self.motions, Mapping) else {}

    def spectra(
        self, periods: npt.ArrayLike, damping: float = 0.05, measure: str = "RotD100"
    ) -> pd.DataFrame:
        """Return the response spectra of all motions.

        Parameters
        ----------
        periods : array_like, shape (m,)
            Natural periods [s].
        damping : float
            Part of the critical damping [-].
        measure : str
            Measure of a pair (`frames.design.hazard.motion_measures.MEASURES`).

        Returns
        -------
        pandas.DataFrame
            Pseudo-accelerations [m/s2]: a row a period, a column a motion.

        Raises
        ------
        MotionError
            If a component is missing, or an argument out of its bounds.
        """
        columns = {n: pair_spectrum(m, periods, damping, measure) for n, m in self.items()}
        return pd.DataFrame(columns, index=pd.Index(np.atleast_1d(periods), name="period [s]"))

    def table(self, component: str = "x") -> pd.DataFrame:
        """Return facts and measures of one component of all motions.

        Parameters
        ----------
        component : {"x", "y", "z"}
            The component.

        Returns
        -------
        pandas.DataFrame
            A row a motion; columns: facts, the factor of a scaled set, and those of
            `frames.design.hazard.motion_measures.motion_measures`.

        Raises
        ------
        MotionError
            If a motion does not have the component.
        """
        require_choice("component", component, ("x", "y", "z"), error=MotionError)
        rows = []
        for name, motion in self.items():
            values = getattr(motion, component)
            if values is None:
                msg = f"{name} has no component {component}: choose one of {', '.join(motion.peak)}"
                raise MotionError(msg)
            factor = {} if self.scaling is None else {"factor": self.scaling.factors[name]}
            rows.append({**self.facts[name], **factor, **motion_measures(values, motion.dt)})
        return pd.DataFrame(rows, index=pd.Index(list(self), name="motion"))

    def _repr_html_(self) -> str:
        factors = {} if self.scaling is None else self.scaling.factors
        rows = [
            (
                name,
                ", ".join(f"{axis} {peak / STANDARD_GRAVITY:.3f}" for axis, peak in m.peak.items()),
                f"{m.duration:.4g}",
                f"{factors[name]:.3f}" if factors else "",
            )
            for name, m in self.items()
        ]
        notes = [] if self.scaling is None else [f"Scaled to {self.scaling.target.name}."]
        head = ("motion", "peaks [g]", "duration [s]", "factor")
        return html_table(f"{len(self)} motions", rows, head, notes)

    def __repr__(self) -> str:
        """Name the motions, and the target of a scaled set."""
        label = "" if self.scaling is None else f", scaled to {self.scaling.target.name}"
        return f"MotionSet of {len(self)}{label}: {', '.join(self)}"
