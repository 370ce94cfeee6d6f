"""
Plastic hinges
==============

A weak frame whose beams and columns yield: where hinges turn, and by how much.
"""

import numpy as np

from frames import GroundMotion, Section, moment_frame, plots, time_history
from frames.demo import bearing_for
from frames.laws import PlasticHinge

t = np.arange(0.0, 5.0, 0.01)  # s
motion = GroundMotion(x=1.5 * np.sin(4.0 * t) * (t < 3.14), dt=0.01)
frame = moment_frame(
    (1, 1),
    2,
    bearing=bearing_for(430e3),
    column=Section.box(0.2, 0.2, 0.01),
    beam=Section.i_shape(0.2, 0.1, 0.0085, 0.0056),
    hinges={
        "beam": PlasticHinge(moment_y=45e3, hardening=0.03),  # N m
        "column": PlasticHinge(moment_y=90e3, moment_z=90e3, axial=2.6e6, hardening=0.03),
    },
)
data = time_history(frame, motion, dt=0.005)

assert int((data["hinge_turn"].isel(time=-1) > 0.0).sum()) > 0

plots.hinge_map(frame, data)
