"""One radius and friction with a fitted bearing: its numbers, limits and deficits."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING, NamedTuple

from frames.design._errors import CheckError
from frames.design.codes.registry import code_named

if TYPE_CHECKING:
    from collections.abc import Sequence

    from frames.design.calculation.check import Checks
    from frames.design.calculation.trace import Trace
    from frames.design.codes.isolation import IsolationSystem
    from frames.design.codes.outcome import EquivalentLinear
    from frames.design.sizing.target import Prices
    from lir_element import LIRBearing
    from lir_element.device.friction import FrictionLaw


class Size(NamedTuple):
    """Loads of the bearings that have sliders of one radius [N]."""

    least: float  # of all combinations
    average: float  # the largest of the average combination
    largest: float  # of all combinations
    lightest: float  # the least of the average combination
    # its mean weighted by the loads: under it the friction of all of them together is developed
    typical: float
    number: int  # of bearings


def grouped(
    system: IsolationSystem, sizes: int, least: Sequence[float] = ()
) -> tuple[tuple[int, ...], tuple[Size, ...]]:
    """Return the size of each bearing, smallest first, and the loads of each size [N].

    The largest loads are divided so that the total area of the sliders is least; a bearing counts
    with `least` [N] if its load is smaller.

    Shapes: least and result (n_bearings,).
    """
    if sizes < 1:
        msg = f"sizes = {sizes}: give the number of slider sizes, at least 1"
        raise CheckError(msg)
    columns = list(zip(system.loads, *system.combinations.values(), strict=True))
    largest = [max(column) for column in columns]
    largest = [max(pair) for pair in zip(largest, least or largest, strict=True)]
    rounded = [float(f"{load:.3g}") for load in largest]
    steps = sorted(set(rounded))
    counts = [rounded.count(step) for step in steps]
    inner = range(len(steps) - 1)

    def area(tops: tuple[int, ...]) -> float:
        ends = (*tops, len(steps) - 1)
        starts = (0, *(top + 1 for top in tops))
        return sum(
            steps[end] * sum(counts[start : end + 1])
            for start, end in zip(starts, ends, strict=True)
        )

    tops = min(combinations(inner, min(sizes, len(steps)) - 1), key=area)
    limits = [steps[top] for top in tops]
    places = tuple(sum(load > limit for limit in limits) for load in rounded)
    return places, tuple(
        _loads([columns[k] for k, size in enumerate(places) if size == number])
        for number in range(len(limits) + 1)
    )


def _loads(columns: list[tuple[float, ...]]) -> Size:
    # If a combination lifts a bearing, its least positive load counts.
    pressed = [load for column in columns for load in column if load > 0.0]
    average = [column[0] for column in columns]
    return Size(
        least=min(pressed),
        average=max(average),
        largest=max(pressed),
        lightest=min(average),
        typical=sum(load * load for load in average) / sum(average),
        number=len(columns),
    )


class Governing(NamedTuple):
    """Governing limit of a candidate: the largest ratio of demand to limit."""

    what: str
    ratio: float


@dataclass(frozen=True, kw_only=True, eq=False)
class Candidate:
    """A radius and a friction with a fitted bearing."""

    radius: float  # of both concave surfaces [m]
    friction: FrictionLaw  # nominal, of both surfaces
    # A bearing for each size of slider; none if their plates would be too deep
    bearings: tuple[LIRBearing, ...]
    analysis: EquivalentLinear  # of the same bearings without rims
    # of each size by its own numbers, at the slip that the rims leave to the interface
    checks: Checks
    trace: Trace  # the calculation of rims and interface
    lacks: tuple[str, ...]  # its unmet requirements; empty if there are none
    groups: tuple[Size, ...]  # loads and number of the bearings of each size
    governing: Governing  # governing limit and its ratio: above 1 if a requirement is unmet
    # pressure of the target below which liners rub more than they are meant to [Pa]
    least_pressure: float
    places: tuple[int, ...]  # size of the bearing at each place
    prices: Prices | None = None  # prices for `cost`

    @property
    def plan_diameter(self) -> float:
        """Diameter of the largest bearing's plates [m]."""
        return self.trace.value("d_plan")

    @property
    def base_shear(self) -> float:
        """Largest base shear over weight, without rims [-]."""
        return self.trace.value("V_b") / self.trace.value("W")

    @property
    def displacement(self) -> float:
        """Largest displacement that bearings without rims must allow [m]."""
        return self.trace.value("D")

    @property
    def bearing_volume(self) -> float:
        """Volume of all bearings, plates' area times slider's height: a measure of cost [m3].

        It measures the steel to be forged, machined and moved; it is no price.
        """
        t, found = self.trace, 0.0
        for bearing, group in zip(self.bearings, self.groups, strict=False):
            smaller = t.value("a") - bearing.slider_radius
            diameter = t.value("d_plan") - 2.0 * smaller
            found += group.number * math.pi / 4.0 * diameter**2 * bearing.slider_height
        return found if self.bearings else math.nan

    @property
    def cost(self) -> float:
        """Cost of all bearings and of the gap around them, by the prices of the target.

        NaN if there is no price or no bearing.
        """
        if self.prices is None or not self.bearings:
            return math.nan
        each, number = self.prices, sum(group.number for group in self.groups)
        liners = sum(
            group.number * 3.0 * math.pi * bearing.slider_radius**2  # both surfaces, interface
            for bearing, group in zip(self.bearings, self.groups, strict=False)
        )
        return (
            each.bearing * number
            + each.volume * self.bearing_volume
            + each.liner * liners
            + each.gap * self.displacement
        )

    @property
    def pressures(self) -> tuple[tuple[float, float, float], ...]:
        """Pressures of each slider size in the average combination [Pa]: least, typical, largest.

        That of the lightest bearing, the mean weighted by the loads, and the heaviest bearing's.
        """
        return tuple(
            (group.lightest / area, group.typical / area, group.average / area)
            for bearing, group in zip(self.bearings, self.groups, strict=False)
            for area in [math.pi * bearing.slider_radius**2]
        )

    @property
    def warnings(self) -> tuple[str, ...]:
        """Warnings without a check, for the liner's maker: sliders under low pressure."""
        return tuple(
            "friction of PTFE-type liners may be higher than assumed: sliders of "
            f"{2e3 * bearing.slider_radius:.0f} mm diameter have {typical / 1e6:.3g} MPa "
            f"({least / 1e6:.3g} to {most / 1e6:.3g} MPa, average combination), below "
            f"least_pressure = {self.least_pressure / 1e6:.3g} MPa; ask the liner's maker"
            for bearing, (least, typical, most) in zip(self.bearings, self.pressures, strict=True)
            if typical < self.least_pressure
        )

    @property
    def beyond_procedure(self) -> tuple[str, ...]:
        """Effects outside of the equivalent-linear procedure, for a time history."""
        return tuple(
            f"{check.title} ({check.bound})" for check in self.analysis.checks.inapplicable
        )

    @property
    def rims(self) -> str:
        """Place of its rims, in words: beyond the displacement, or reached, and the consequence."""
        rule, share = code_named(self.analysis.code).rims, self.trace.value("r")
        if share >= 1.0:
            return f"beyond {rule.symbol}"
        if share >= rule.least:
            return f"met, {rule.clause} allows it from {rule.least:g} {rule.symbol}"
        return f"met below {rule.least:g} {rule.symbol}: needs agreement"

    def row(self) -> dict[str, object]:
        """Return its main numbers in SI units, and its unmet requirements."""
        t = self.trace
        found: dict[str, object] = {
            "radius [m]": self.radius,
            "friction [-]": self.friction.f_max,
            "displacement [m]": self.displacement,
            "base shear / weight [-]": self.base_shear,
        }
        for name, each in self.analysis.bounds.items():
            found |= {f"period, {name} [s]": each.period, f"damping, {name} [-]": each.damping}
        pressures = self.pressures or ((math.nan,) * 3,)
        return found | {
            "slider radius [m]": t.value("a"),
            "capacity [m]": t.value("U_cap"),
            "capacity / displacement [-]": t.value("r"),
            "rims": self.rims,
            "interface friction [-]": t.value("mu_h"),
            "plan diameter [m]": self.plan_diameter,
            "bearing volume [m3]": self.bearing_volume,
            **({} if self.prices is None else {"cost": self.cost}),
            "pressure, lightest bearing [Pa]": min(each[0] for each in pressures),
            "pressure, typical [Pa]": min(each[1] for each in pressures),
            "pressure, heaviest bearing [Pa]": max(each[2] for each in pressures),
            "limited by": self.governing.what,
            "largest ratio [-]": self.governing.ratio,
            "lacks": "; ".join(self.lacks),
            "warnings": "; ".join(self.warnings),
            "beyond the procedure": "; ".join(self.beyond_procedure),
        }
