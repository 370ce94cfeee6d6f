"""Formulas of what results derive from a bearing's state: of numbers in kernels, of arrays besides.

Each takes numbers in compiled code, and arrays as the Python that it is (`on_arrays`): what is read
off a record at one step and off all steps of a result is one formula. None calls another.
"""

from __future__ import annotations

from numpy import maximum, sqrt

from lir_element._compile.jit import inlined_by_llvm


@inlined_by_llvm
def in_plan(x: float, y: float) -> float:
    """Return the size of a vector in a plane."""
    return sqrt(x * x + y * y)


@inlined_by_llvm
def in_space(x: float, y: float, z: float) -> float:
    """Return the size of a vector."""
    return sqrt(x * x + y * y + z * z)


@inlined_by_llvm
def eccentricity(
    axial_force: float,
    floor: float,
    radius: float,
    height: float,
    axis_x: float,
    axis_y: float,
    axis_z: float,
    rim_force: float,
    interface_x: float,
    interface_y: float,
    friction_x: float,
    friction_y: float,
    slip_x: float,
    slip_y: float,
) -> float:
    """Return how far the resultant in the interface lies off the sliders' axes, the larger [m].

    Moment equilibrium of the bottom slider about the centre of its sphere (10.2); `rim_force` and
    `friction` are those of the bottom surface, `height` that of the interface over its vertex. 0
    where the axial force has faded to `floor`.
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


@inlined_by_llvm
def resultant_offset(by_forces: float, of_pressure: float) -> float:
    """Return the eccentricity: of the pressure itself where sliders are bodies (not 0) [m].

    The forces on them do not tell, for inertia takes its part when a rim is met.
    """
    known = of_pressure > 0.0
    return of_pressure * known + by_forces * (1.0 - known)
