"""Formulas of results derived from a bearing's state, for numbers or arrays.

The value of a record at one step (`kernels/derived.py` compiles them) and those of all steps of a
result have one formula. None calls another.
"""

from __future__ import annotations

from typing import Any, TypeAlias

from numpy import maximum, sqrt

Numbers: TypeAlias = Any
"""A number, or an array of them."""


def in_plan(x: Numbers, y: Numbers) -> Numbers:
    """Return the size of a vector in a plane."""
    return sqrt(x * x + y * y)


def in_space(x: Numbers, y: Numbers, z: Numbers) -> Numbers:
    """Return the size of a vector."""
    return sqrt(x * x + y * y + z * z)


def eccentricity(
    axial_force: Numbers,
    floor: Numbers,
    radius: Numbers,
    height: Numbers,
    axis_x: Numbers,
    axis_y: Numbers,
    axis_z: Numbers,
    rim_force: Numbers,
    interface_x: Numbers,
    interface_y: Numbers,
    friction_x: Numbers,
    friction_y: Numbers,
    slip_x: Numbers,
    slip_y: Numbers,
) -> Numbers:
    """Return the larger distance of the interface's resultant from the sliders' axes [m].

    Moment equilibrium of the bottom slider about the centre of its sphere (10.2); `rim_force` and
    `friction` are those of the bottom surface, `height` that of the interface over its vertex. 0 if
    the axial force has faded to `floor`.
    """
    size = sqrt(axis_x * axis_x + axis_y * axis_y)
    unit = size + (size == 0.0)
    arm, pressed = radius - height, axial_force > floor
    load = maximum(axial_force, floor)
    b_x = arm * interface_x + radius * (rim_force * (axis_x / unit) * axis_z - friction_x)
    b_y = arm * interface_y + radius * (rim_force * (axis_y / unit) * axis_z - friction_y)
    b_x, b_y = b_x / load, b_y / load
    t_x, t_y = b_x - slip_x, b_y - slip_y
    return sqrt(maximum(b_x * b_x + b_y * b_y, t_x * t_x + t_y * t_y)) * pressed


def resultant_offset(by_forces: Numbers, of_pressure: Numbers) -> Numbers:
    """Return the eccentricity: of the pressure itself if sliders are bodies (not 0) [m].

    The forces on them do not give it, because their inertia acts at rim contact.
    """
    known = of_pressure > 0.0
    return of_pressure * known + by_forces * (1.0 - known)
