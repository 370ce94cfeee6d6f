"""
Storeys that yield
==================

Loops of the storeys of a building whose strength is a tenth of its weight.
"""

import numpy as np

from frames import GroundMotion, plots, shear_building, time_history
from frames.demo import bearing_for
from frames.laws import Bilinear

t = np.arange(0.0, 6.0, 0.005)  # s
motion = GroundMotion(x=2.0 * np.sin(4.0 * t) * (t < 3.14), dt=0.005)
strength = 0.1 * 3 * 60e3 * 9.81  # N
building = shear_building(
    bearing_for(2000e3),
    storey_mass=60e3,
    storey_stiffness=6e7,
    storeys=3,
    storey_law=lambda k: Bilinear(stiffness=k, yield_force=strength, hardening=0.03),
)
data = time_history(building, motion)

ductility = abs(data["link_deformation"]).max("time") / data["link_yield_deformation"]
assert float(ductility.max()) > 1.0

plots.link_loops(data)
