"""
A slender building lifts
========================

Axial forces of the four bearings under a slender building: two of them are nearly unloaded in
turn.
"""

import numpy as np

from frames import GroundMotion, plots, shear_building, time_history
from frames.demo import bearing_for

t = np.arange(0.0, 6.0, 0.01)  # s
motion = GroundMotion(x=1.8 * np.sin(4.0 * t) * (t < 3.14), dt=0.01)
tower = shear_building(
    bearing_for(900e3),
    storey_mass=60e3,
    storey_stiffness=6e7,
    storeys=5,
    storey_height=3.5,
    plan=((1, 1), (6.0, 6.0)),
)
data = time_history(tower, motion)

rest = data["axial_force"].isel(time=0)
assert float((data["axial_force"].min("time") / rest).min()) < 0.5

plots.bearing_plan(data)
