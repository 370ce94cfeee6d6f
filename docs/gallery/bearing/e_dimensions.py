"""
A bearing to scale
==================

Vertical section of a bearing with its dimensions, as a manufacturer needs them.
"""

from frames import plots
from lir_element import LIRBearing, VelocityFriction

bearing = LIRBearing(
    radius=1.185,  # m
    slider_height=0.12,
    slider_radius=0.15,
    capacity=0.25,
    friction=VelocityFriction(f_max=0.065, f_min=0.0325, rate=15.0),
    interface_friction=0.13,
)

assert abs(bearing.effective_radius - (2 * 1.185 - 0.12)) < 1e-12

plots.bearing_dimensions(bearing)
