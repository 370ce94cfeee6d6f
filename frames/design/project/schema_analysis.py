"""What ``[analysis]`` of a project's file holds."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, field_validator

from frames.design.codes.history_rules import MOST_ECCENTRIC
from frames.design.project.derived import Table
from frames.design.project.quantities import Length, Positive, Ratio, Time


class Analysis(Table):
    """``[analysis]``: how time histories are run, and whether uplift voids them."""

    level: Literal["pendulum", "contact"] = "contact"
    dt: Annotated[Time, Positive] | None = None
    workers: int | None = Field(default=None, ge=1)
    bounds: tuple[Literal["lower", "nominal", "upper"], ...] = Field(
        default=("lower", "nominal", "upper"), min_length=1
    )
    uplift_allowed: bool | None = None
    least_gap: Length | None = None
    nonstructural: str | None = None
    histories: Literal["governing", "all"] = "governing"
    accidental_eccentricity: Ratio | Literal["none"] | None = None
    accidental_eccentricity_motions: Literal["governing", "all"] = "governing"

    @field_validator("bounds")
    @classmethod
    def _each_once(cls, names: tuple[str, ...]) -> tuple[str, ...]:
        if len(set(names)) < len(names):
            msg = 'must name each bound once: ["lower", "nominal", "upper"] are all'
            raise ValueError(msg)
        return names

    @field_validator("accidental_eccentricity")
    @classmethod
    def _eccentricity(cls, share: float | str | None) -> float | str | None:
        if isinstance(share, float) and not 0.0 <= share <= MOST_ECCENTRIC:
            msg = (
                f"must be a share of the sides of the plan between 0 and {MOST_ECCENTRIC:g}, such "
                'as "5 %", or "none"'
            )
            raise ValueError(msg)
        return share
