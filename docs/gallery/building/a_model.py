"""
A building on nine bearings
===========================

A regular steel frame with a bearing under every column, as nodes, members and bearings.
"""

from frames import moment_frame, plots
from frames.demo import bearing_for

building = moment_frame(bays=(2, 2), storeys=3, bearing=bearing_for(1000e3))

assert len(building.bearings) == 9

plots.model_view(building)
