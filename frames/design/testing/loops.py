"""Cycles of a measured force-displacement loop, and their properties."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from frames.design._errors import CheckError
from lir_element.argument_checks import require_choice, unreal

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas as pd

    from frames._types import FloatArray, IntArray

_TURN = 0.2  # of the amplitude: less is no half cycle
_SLOPE = 0.1, 0.9  # of the half cycle's displacement: range of the slope
_END = 0.8  # of it: start of the range for the force at its end
_FEWEST = 5  # samples in either


@dataclass(frozen=True, kw_only=True, eq=False)
class PrototypeTest:
    """A measured test of a bearing.

    Parameters
    ----------
    name : str
        Name in the programme; tests of one name are checked together.
    displacement : array_like, (n,)
        Lateral displacement about the centre [m]; of the interface alone its slip.
    force : array_like, (n,)
        Lateral force [N], positive with positive displacement.
    load : float or array_like, (n,)
        Vertical load, compression positive [N].
    specimen : str
        Name of the bearing.
    kind : {"bearing", "interface"}
        The moved part: the whole bearing, or the interface between the sliders alone.

    Raises
    ------
    CheckError, ValueError
        If the arrays differ in length or are not finite, a load is not positive, or there is no
        full cycle of enough samples.

    Examples
    --------
    >>> import numpy as np
    >>> turns = np.linspace(0.0, 3.0, 1501)
    >>> path = 0.2 * np.sin(2.0 * np.pi * turns)
    >>> force = 1e6 * (path / 2.7 + 0.06 * np.sign(np.cos(2.0 * np.pi * turns)))
    >>> test = PrototypeTest(name="1 D_M", displacement=path, force=force, load=1e6)
    >>> test.name, test.kind, test.displacement.shape
    ('1 D_M', 'bearing', (1501,))
    """

    name: str
    displacement: npt.ArrayLike = field(repr=False)
    force: npt.ArrayLike = field(repr=False)
    load: npt.ArrayLike = field(repr=False)
    specimen: str = ""
    kind: Literal["bearing", "interface"] = "bearing"

    def __post_init__(self) -> None:
        require_choice("kind", self.kind, ("bearing", "interface"), error=CheckError)
        where = f"test {self.name!r}"
        given = {"displacement": self.displacement, "force": self.force, "load": self.load}
        for key, part in given.items():
            if odd := unreal(part):
                msg = f"{where}: {key} {odd}"
                raise CheckError(msg)
        moved, force = (
            np.asarray(part, dtype=np.float64) for part in (self.displacement, self.force)
        )
        if moved.ndim != 1 or moved.shape != force.shape or not len(moved):
            msg = (
                f"{where}: displacement {moved.shape} and force {force.shape} must have one "
                "number for every sample, (n,)"
            )
            raise CheckError(msg)
        load = np.asarray(self.load, dtype=np.float64)
        if load.shape not in {(), moved.shape}:
            msg = f"{where}: load {load.shape}: give one number [N], or one for each sample (n,)"
            raise CheckError(msg)
        load = np.broadcast_to(load, moved.shape)
        for name, values in (("displacement", moved), ("force", force), ("load", load)):
            if not np.isfinite(values).all():
                k = int(np.flatnonzero(~np.isfinite(values))[0])
                msg = f"{where}: {name} is {values[k]} at sample {k}: leave these samples out"
                raise CheckError(msg)
        if not load.min() > 0.0:
            msg = f"{where}: a load of {load.min():g} N: give compression as positive, in N"
            raise CheckError(msg)
        for name, values in (("displacement", moved), ("force", force), ("load", load)):
            object.__setattr__(self, name, values)
        _ = self.cycles  # raises if there is no full cycle

    @cached_property
    def cycles(self) -> tuple[Cycle, ...]:
        """Full cycles, in order."""
        moved, force, load = map(np.asarray, (self.displacement, self.force, self.load))
        return tuple(_cycles_of(self, moved, force, load))


class Cycle(NamedTuple):
    """A full cycle of a loop."""

    highest: float  # m
    lowest: float  # m
    force_high: float  # N, at the highest displacement, loading
    force_low: float  # N
    energy: float  # J
    load: float  # N, mean
    slopes: tuple[float, float]  # N/m of both loading halves

    @property
    def travel(self) -> float:
        """Distance between both ends [m]."""
        return self.highest - self.lowest

    @property
    def stiffness(self) -> float:
        """Effective stiffness, ASCE 7-22 (17.8-1) [N/m]."""
        return (abs(self.force_high) + abs(self.force_low)) / self.travel

    @property
    def damping(self) -> float:
        """Effective damping, ASCE 7-22 (17.8-2) [-]."""
        return 2.0 / np.pi * self.energy / (self.stiffness * self.travel**2)

    @property
    def friction(self) -> float:
        """Friction coefficient of the energy, E / (2 N travel) [-]."""
        return self.energy / (2.0 * self.load * self.travel)


def loop_properties(test: PrototypeTest) -> pd.DataFrame:
    """Return the properties of each full cycle of a test.

    Parameters
    ----------
    test : PrototypeTest
        The test.

    Returns
    -------
    pandas.DataFrame
        A row a cycle: displacements and forces at both ends [m, N], effective stiffness
        (ASCE 7-22 (17.8-1)) [N/m] and damping (17.8-2) [-], energy [J], post-elastic stiffness
        k_d, the mean slope of both loading halves [N/m], friction by the energy [-], mean load [N].

    Notes
    -----
    A half cycle extends over more than a fifth of the largest displacement. Slopes are fitted by
    least squares over 0.1 to 0.9 of the half cycle's displacement from zero to its end. So noise
    and the standstill at the end do not decide. The force at an end is that of a line through
    the last fifth on loading.

    Examples
    --------
    >>> import numpy as np
    >>> from frames.design import PrototypeTest, loop_properties
    >>> turns = np.linspace(0.0, 3.0, 1501)
    >>> path = 0.2 * np.sin(2.0 * np.pi * turns)
    >>> force = 1e6 * (path / 2.7 + 0.06 * np.sign(np.cos(2.0 * np.pi * turns)))
    >>> test = PrototypeTest(name="1 D_M", displacement=path, force=force, load=1e6)
    >>> loop_properties(test)["friction [-]"].round(3).tolist()
    [0.06, 0.06, 0.06]
    """
    import pandas as pd

    rows = [
        {
            "displacement + [m]": c.highest,
            "displacement - [m]": c.lowest,
            "force + [N]": c.force_high,
            "force - [N]": c.force_low,
            "k_eff [N/m]": c.stiffness,
            "beta_eff [-]": c.damping,
            "E_loop [J]": c.energy,
            "k_d [N/m]": sum(c.slopes) / 2.0,
            "friction [-]": c.friction,
            "load [N]": c.load,
        }
        for c in test.cycles
    ]
    return pd.DataFrame(rows, index=pd.RangeIndex(1, len(rows) + 1, name="cycle"))


def _cycles_of(
    test: PrototypeTest, moved: FloatArray, force: FloatArray, load: FloatArray
) -> list[Cycle]:
    turns = _half_cycles(moved)
    sign = float(np.sign(moved[turns[0]])) if len(turns) else 1.0
    moved, force = sign * moved, sign * force
    found = []
    begin = 0
    for k in range(0, len(turns) - 1, 2):
        high, low = int(turns[k]), int(turns[k + 1])
        end = _first(moved[low:] >= 0.0, low)
        if end is None:  # it does not come back
            if moved[-1] < -_TURN * np.abs(moved).max():
                break
            end = len(moved) - 1
        begin = _last(moved[begin : high + 1] <= 0.0, begin)
        middle = _first(moved[high:] <= 0.0, high) or low
        ends = [_line(test, moved, force, a, b) for a, b in ((begin, high), (middle, low))]
        d, f = moved[begin : end + 1], force[begin : end + 1]
        energy = float(np.trapezoid(np.append(f, f[0]), np.append(d, d[0])))
        (slope_1, top), (slope_2, bottom) = ends
        cycle = Cycle(
            float(moved[high]),
            float(moved[low]),
            top,
            bottom,
            energy,
            float(load[begin : end + 1].mean()),
            (slope_1, slope_2),
        )
        found.append(cycle if sign > 0.0 else _mirrored(cycle))
        begin = end
    if not found:
        msg = (
            f"test {test.name!r}: no full cycle about zero in {len(moved)} samples from "
            f"{1e3 * moved.min():.4g} to {1e3 * moved.max():.4g} mm: give the displacement from "
            "the centre [m], from zero to both sides and back"
        )
        raise CheckError(msg)
    return found


def _mirrored(cycle: Cycle) -> Cycle:
    return cycle._replace(
        highest=-cycle.lowest,
        lowest=-cycle.highest,
        force_high=-cycle.force_low,
        force_low=-cycle.force_high,
        slopes=cycle.slopes[::-1],
    )


def _half_cycles(moved: FloatArray) -> IntArray:
    # Places of the ends of half cycles: largest distances between changes of the side.
    side = np.sign(moved) * (np.abs(moved) > _TURN * np.abs(moved).max())
    places = np.flatnonzero(side)
    if not len(places):
        return places
    parts = np.split(places, np.flatnonzero(np.diff(side[places])) + 1)
    return np.array([part[np.abs(moved[part]).argmax()] for part in parts], dtype=np.int64)


def _first(mask: npt.NDArray[np.bool_], start: int) -> int | None:
    found = np.flatnonzero(mask)
    return start + int(found[0]) if len(found) else None


def _last(mask: npt.NDArray[np.bool_], start: int) -> int:
    found = np.flatnonzero(mask)
    return start + int(found[-1]) if len(found) else start


def _line(
    test: PrototypeTest, moved: FloatArray, force: FloatArray, begin: int, end: int
) -> tuple[float, float]:
    # Slope of a loading half, and the force at its end.
    d, f = moved[begin : end + 1], force[begin : end + 1]
    share = d / moved[end]
    middle, last = (share >= _SLOPE[0]) & (share <= _SLOPE[1]), share >= _END
    fewest = int(min(middle.sum(), last.sum()))
    if fewest < _FEWEST:
        msg = (
            f"test {test.name!r}: {fewest} samples in a part of a half cycle up to "
            f"{1e3 * abs(moved[end]):.4g} mm, at least {_FEWEST} are needed: use a higher sampling "
            "rate"
        )
        raise CheckError(msg)
    slope = float(np.polyfit(d[middle], f[middle], 1)[0])
    return slope, float(np.polyval(np.polyfit(d[last], f[last], 1), moved[end]))
