"""``[fragility]`` of a campaign's file: limit states whose curves its page shows."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Self

from pydantic import Field, model_validator

from frames.design.project.derived import Table
from frames.design.project.quantities import Acceleration, Length, Ratio, Time
from frames.risk.fragility.intensity import Intensity, Kind
from frames.risk.fragility.limit_state import LimitState

if TYPE_CHECKING:
    from collections.abc import Callable

_Lengths = tuple[Annotated[Length, Field(gt=0.0)], ...]
_Ratios = tuple[Annotated[Ratio, Field(gt=0.0)], ...]
_Accelerations = tuple[Annotated[Acceleration, Field(gt=0.0)], ...]


class FragilityTable(Table):
    """``[fragility]``: limit states, and the measure that their curves are over."""

    intensity: Kind = "scale"
    period: Time | None = None
    periods: tuple[Annotated[Time, Field(gt=0.0)], ...] = ()
    measure: str = "RotD50"
    drift: _Ratios = ()
    displacement: _Lengths = ()
    residual_displacement: _Lengths = ()
    floor_acceleration: _Accelerations = ()
    rim_contact: bool = False
    bearing_failure: bool = False

    @model_validator(mode="after")
    def _something(self) -> Self:
        if not self.limits():
            msg = "has no limit state: give drift = [0.005], bearing_failure = true or the like"
            raise ValueError(msg)
        if (self.intensity == "Sa") != (self.period is not None):
            msg = 'period goes with intensity = "Sa", as period = "3 s": give both, or neither'
            raise ValueError(msg)
        if (self.intensity == "Sa_avg") != bool(self.periods):
            msg = 'periods go with intensity = "Sa_avg", as periods = ["0.6 s", "3 s", "9 s"]: '
            raise ValueError(msg + "give both, or neither")
        self.measured()  # periods rise
        return self

    def limits(self) -> list[LimitState]:
        """Return the limit states, in the order of their keys."""
        made: list[tuple[Callable[[float], LimitState], tuple[float, ...]]] = [
            (LimitState.drift, self.drift),
            (LimitState.displacement, self.displacement),
            (LimitState.residual_displacement, self.residual_displacement),
            (LimitState.floor_acceleration, self.floor_acceleration),
        ]
        found = [make(value) for make, values in made for value in values]
        found += [LimitState.rim_contact()] if self.rim_contact else []
        return found + ([LimitState.bearing_failure()] if self.bearing_failure else [])

    def measured(self) -> Intensity:
        """Return the intensity measure."""
        return Intensity(
            kind=self.intensity, period=self.period, measure=self.measure, periods=self.periods
        )
