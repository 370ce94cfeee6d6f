"""``[compare]`` of a campaign's file: devices under the same records, and what is collapse."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from frames.design.project.derived import Table
from frames.design.project.quantities import Acceleration, Length, Ratio
from frames.risk.campaign.compared_devices import LARGER, SAME_PLAN, ComparedDevices
from frames.risk.campaign.comparison import collapse_limit
from frames.risk.fragility.limit_state import LimitState

_Length = Annotated[Length, Field(gt=0.0)]
_Device = Literal["DCFP", "DCFP of the same plan", "larger DCFP"]
_Strength = Annotated[Ratio, Field(gt=0.0)] | Literal["unbreakable"]

GEOMETRY = "radius", "slider_height", "slider_radius", "capacity"
"""Parameters that ``[parameters]`` does not vary beside ``[compare]``: they make the devices."""


class CompareTable(Table):
    """``[compare]``: the DCFPs beside the LIR-DCFP, strengths of their rims, collapse."""

    devices: tuple[_Device, ...] = Field(default=("DCFP", "larger DCFP"), min_length=1)
    rims: tuple[_Strength, ...] = ()
    slider_radius: _Length | None = None
    larger: _Length | None = None
    collapse_drift: Annotated[Ratio, Field(gt=0.0)] | None = None
    maximum_considered: Annotated[Acceleration, Field(gt=0.0)] | None = None

    @model_validator(mode="after")
    def _of_its_device(self) -> Self:
        for key, device in (("slider_radius", SAME_PLAN), ("larger", LARGER)):
            if getattr(self, key) is not None and device not in self.devices:
                msg = f'{key} is that of the "{device}", which devices does not name'
                raise ValueError(msg)
        if SAME_PLAN in self.devices and self.slider_radius is None:
            msg = f'"{SAME_PLAN}" needs slider_radius, below that of the LIR-DCFP: its sliders '
            msg += "need no room for a slip"
            raise ValueError(msg)
        for key in ("devices", "rims"):
            values = getattr(self, key)
            if len({*values}) < len(values):
                msg = f"{key} = {list(values)} has one twice"
                raise ValueError(msg)
        return self

    def made(self) -> ComparedDevices:
        """Return the devices."""
        return ComparedDevices(
            others=self.devices,
            rims=self.rims,
            slider_radius=self.slider_radius,
            larger=self.larger,
        )

    def collapse(self) -> LimitState:
        """Return what counts as collapse."""
        return collapse_limit(self.collapse_drift)
