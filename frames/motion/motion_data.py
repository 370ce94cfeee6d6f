"""Data of a ground motion, checked and read-only; `GroundMotion` adds the operations."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Self

import numpy as np

from frames._errors import MotionError, MotionWarning
from frames._types import FloatArray
from frames.motion.records import AXES, checked_component, checked_step, equal_lengths
from frames.motion.transforms import Drift, drift_of, left_at_end
from lir_element.texts import html_table, worded
from lir_element.units import STANDARD_GRAVITY


@dataclass(frozen=True, eq=False, repr=False, slots=True)
class MotionData:
    """Accelerations of the ground, checked, copied and frozen; parameters as in `GroundMotion`."""

    x: FloatArray | None = None
    y: FloatArray | None = None
    z: FloatArray | None = None
    dt: float = math.nan
    name: str = ""

    def __post_init__(self) -> None:
        """Copy, check and freeze the components."""
        self._freeze()
        self._warn_of_drift(recorded=False)

    def _freeze(self) -> None:
        """Check the fields, and put copies in their place that cannot be written to."""
        object.__setattr__(self, "dt", checked_step(self.dt))
        given = {axis: checked_component(axis, a) for axis, a in self._given().items()}
        if not given:
            msg = "a ground motion needs at least one of x, y and z: give accelerations in m/s2"
            raise MotionError(msg)
        for axis, values in equal_lengths(given).items():
            values.flags.writeable = False
            object.__setattr__(self, axis, values)

    def _warn_of_drift(self, *, recorded: bool) -> None:
        left = left_at_end(self._given(), self.dt, recorded=recorded)
        if left:
            msg = worded(
                "{motion}: the ground still moves at the end, {left}. Use corrected(), "
                "unless the motion was cut on purpose",
                motion=self.name or "ground motion",
                left=left,
            )
            warnings.warn(msg, MotionWarning, stacklevel=4)

    @classmethod
    def _made(
        cls,
        x: FloatArray | None,
        y: FloatArray | None,
        z: FloatArray | None,
        dt: float,
        name: str,
    ) -> Self:
        """Return a motion made of another one or of a file: its end is not looked at (again)."""
        motion = object.__new__(cls)
        for field, value in {"x": x, "y": y, "z": z, "dt": dt, "name": name}.items():
            object.__setattr__(motion, field, value)
        motion._freeze()
        return motion

    def _with(
        self, arrays: Mapping[str, FloatArray], dt: float | None = None, name: str | None = None
    ) -> Self:
        """Return a motion with other components, by default with the same step and name."""
        x, y, z = (arrays.get(axis) for axis in AXES)
        step = self.dt if dt is None else dt
        return self._made(x, y, z, step, self.name if name is None else name)

    def __reduce__(self) -> tuple[Callable[..., Self], tuple[object, ...]]:
        # copies and pickles are built anew: arrays copied one by one would be writeable
        return type(self)._made, (self.x, self.y, self.z, self.dt, self.name)

    @property
    def n_steps(self) -> int:
        """Number of samples."""
        return len(next(iter(self._given().values())))

    @property
    def duration(self) -> float:
        """Time from the first to the last sample [s]."""
        return (self.n_steps - 1) * self.dt

    @property
    def time(self) -> FloatArray:
        """Times of the samples from 0 on [s], shape (n_steps,)."""
        return np.arange(self.n_steps, dtype=np.float64) * self.dt

    @property
    def peak(self) -> dict[str, float]:
        """Peak ground acceleration of each component that is given [m/s2]."""
        return {axis: float(np.abs(values).max()) for axis, values in self._given().items()}

    @property
    def drift(self) -> dict[str, Drift]:
        """Velocity [m/s] and displacement [m] of the ground at its end, and peaks, by component."""
        return {axis: drift_of(values, self.dt) for axis, values in self._given().items()}

    @property
    def components(self) -> FloatArray:
        """Accelerations along x, y, z [m/s2], shape (n_steps, 3), contiguous; zeros if missing."""
        columns = np.zeros((self.n_steps, 3))
        for axis, values in self._given().items():
            columns[:, AXES.index(axis)] = values
        return columns

    def summary(self) -> str:
        """Return a printed summary of the motion.

        Returns
        -------
        str
            Name, samples, peaks of each component, and residual velocity and displacement.
        """
        lines = [self.name or "ground motion"]
        return "\n".join(lines + [f"  {what}: {value}" for what, value in self.facts().items()])

    def facts(self) -> dict[str, str]:
        """Return size, peaks and residual motion at the end, in words by name."""
        return facts_of(self._given(), self.dt)

    def _repr_html_(self) -> str:
        return html_table(self.name or "ground motion", list(self.facts().items()))

    def __repr__(self) -> str:
        """Name, size and peaks on one line."""
        peaks = ", ".join(f"{axis} {peak:.3f}" for axis, peak in self.peak.items())
        label = f" {self.name!r}" if self.name else ""
        size = f"{self.n_steps} samples, dt = {self.dt:g} s, {self.duration:g} s"
        return f"GroundMotion{label}: {size}, peak {peaks} m/s2"

    def _given(self) -> dict[str, FloatArray]:
        """Return the components that are given, in the order x, y, z."""
        pairs = zip(AXES, (self.x, self.y, self.z), strict=True)
        return {axis: values for axis, values in pairs if values is not None}


def facts_of(given: Mapping[str, FloatArray], dt: float) -> dict[str, str]:
    """Return facts about components by axis [m/s2], in words by name."""
    count = len(next(iter(given.values())))
    found = {"motion": f"{count} samples, dt = {dt:g} s, duration {(count - 1) * dt:g} s"}
    for axis, values in given.items():
        left, peak = drift_of(values, dt), float(np.abs(values).max())
        found[axis] = (
            f"peak {peak:.3f} m/s2 ({peak / STANDARD_GRAVITY:.3f} g), "
            f"{left.peak_velocity:.3f} m/s, {left.peak_displacement:.3f} m; at its end "
            f"{round(left.velocity, 3) + 0.0:.3f} m/s, "
            f"{round(left.displacement, 3) + 0.0:.3f} m"
        )
    return found
