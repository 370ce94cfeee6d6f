"""
Modes with the bearings sliding
===============================

Natural modes of the structure on its bearings, whose stiffness is that of the pendulum:
translation along both axes and torsion.
"""

from frames import modes, moment_frame, plots
from frames.demo import bearing_for

bearing = bearing_for(1000e3)
building = moment_frame(bays=(2, 1), storeys=2, bearing=bearing)

assert abs(modes(building, 1).periods[0] / bearing.period - 1.0) < 0.05

plots.mode_shapes(building, 3)
