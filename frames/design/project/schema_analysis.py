"""What ``[analysis]`` of a project's file holds."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from frames.design.project.derived import Table
from frames.design.project.quantities import Length, Positive, Time


class Analysis(Table):
    """``[analysis]``: how time histories are run, and whether uplift voids them."""

    level: Literal["pendulum", "contact"] = "contact"
    dt: Annotated[Time, Positive] | None = None
    workers: int | None = Field(default=None, ge=1)
    bounds: tuple[Literal["lower", "nominal", "upper"], ...] = ("lower", "nominal", "upper")
    uplift_allowed: bool | None = None
    least_gap: Length | None = None
    histories: Literal["governing", "all"] = "governing"
