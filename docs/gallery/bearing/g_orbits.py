"""
Orbits of two devices
=====================

A mass under two components: the plain DCFP stays within its rims and strikes them, the LIR-DCFP
passes them by the slip of its interface.
"""

from dataclasses import replace

import numpy as np

from frames import GroundMotion, lumped_mass, plots, time_history
from frames.demo import bearing_for

t = np.arange(0.0, 8.0, 0.005)  # s
x, y = (a * np.sin(w * t) * (t < 4.0) for a, w in ((1.8, 3.6), (1.2, 4.5)))
motion = GroundMotion(x=x, y=y, dt=0.005)
bearing = replace(bearing_for(2000e3), axial_stiffness=12e9)  # N/m, which its impacts rest on
devices = {"LIR-DCFP": bearing, "plain DCFP": bearing.as_dcfp()}
runs = {
    name: time_history(lumped_mass(device, mass=204e3), motion) for name, device in devices.items()
}

slip = {name: float(run["interface_slip_size"].max()) for name, run in runs.items()}
assert slip["LIR-DCFP"] > slip["plain DCFP"] + 1e-3  # m

plots.orbits(runs)
