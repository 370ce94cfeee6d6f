"""What ``[limits]`` and ``[design]`` of a project's file hold."""

from __future__ import annotations

from frames.design.project.derived import Table
from frames.design.project.quantities import Acceleration, Force, Length, Pressure, Ratio


class Limits(Table):
    """``[limits]``: what the engineer allows; the fields of `frames.DesignLimits`."""

    margin: float | None = None
    rim_strength: Force | None = None
    rims_together: bool | None = None
    eccentricity: float | None = None
    interface_pressure: Pressure | None = None
    liner_pressure: Pressure | None = None
    lateral_force: Force | None = None
    slip_left: Length | None = None
    uplift_gap: Length | None = None
    rim_height: Length | None = None
    axial_force: Force | None = None
    floor_acceleration: Acceleration | None = None
    drift: Ratio | None = None
    base_shear: Force | None = None
    displacement_left: Length | None = None
    rim_engagement: Ratio | None = None
    moat_gap: Length | None = None


class Target(Table):
    """``[design]``: what ``lir design`` chooses from; fields of `frames.DesignTarget`."""

    radii: tuple[Length, ...] | None = None
    frictions: tuple[Ratio, ...] | None = None
    rim_share: Ratio | None = None
    slip_margin: Ratio | None = None
    pressure: Pressure | None = None
    largest_pressure: Pressure | None = None
    least_pressure: Pressure | None = None
    max_displacement: Length | None = None
    max_base_shear: Ratio | None = None
    max_plan_diameter: Length | None = None
