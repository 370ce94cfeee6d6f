"""
An impact in sections
=====================

A mass on one bearing under a pulse: sections before the impact, at rim contact, at the largest
displacement and after it. The interface between both pieces of the slider slips.
"""

import numpy as np

from frames import GroundMotion, lumped_mass, plots, time_history
from frames.demo import bearing_for

t = np.arange(0.0, 6.0, 0.005)  # s
motion = GroundMotion(x=2.0 * np.sin(2.0 * np.pi * t / 1.6) * (t < 1.6), dt=0.005)  # m/s2
data = time_history(lumped_mass(bearing_for(2000e3), mass=204e3), motion)

assert 0.03 < float(data["interface_slip_size"].max()) < 0.12  # m

plots.bearing_sections(data)
