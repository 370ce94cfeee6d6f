"""Ground motions by name, with what is known and measured of them; `MotionSet` adds the verbs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from frames._errors import MotionError
from frames.design.hazard.motion_measures import motion_measures
from frames.design.hazard.pair_spectra import pair_spectrum
from frames.design.hazard.scaling import Scaling
from frames.motion.ground_motion import GroundMotion
from lir_element.argument_checks import require_choice, require_type
from lir_element.tables import html_table
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    import numpy.typing as npt


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
        stray = set(self.facts) - set(names)
        if stray:
            msg = f"facts of {sorted(stray)[0]!r} belong to no motion: {', '.join(names)} are given"
            raise MotionError(msg)
        object.__setattr__(self, "motions", dict(pairs))
        object.__setattr__(self, "facts", {n: dict(self.facts.get(n, {})) for n in names})

    def __getitem__(self, name: str) -> GroundMotion:
        """Return a motion by its name."""
        return self._by_name[name]

    def __iter__(self) -> Iterator[str]:
        """Go through the names."""
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
            Measure of a pair (`frames.design.hazard.pair_spectra.MEASURES`).

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
            If a motion has no such component.
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
