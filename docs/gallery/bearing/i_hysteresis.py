"""
Loops of a time history
=======================

Force over displacement in a time history. The spike of the plain DCFP at its rims would flatten
the loops: the axis ends earlier, and arrows name the peaks.
"""

import numpy as np

from frames import GroundMotion, lumped_mass, plots, time_history
from frames.demo import bearing_for

t = np.arange(0.0, 6.0, 0.005)  # s
motion = GroundMotion(x=2.0 * np.sin(2.0 * np.pi * t / 1.6) * (t < 1.6), dt=0.005)  # m/s2
bearing = bearing_for(2000e3)
devices = {"LIR-DCFP": bearing, "plain DCFP": bearing.as_dcfp()}
runs = {
    name: time_history(lumped_mass(device, mass=204e3), motion) for name, device in devices.items()
}

force = {name: float(abs(run["base_shear"].sel(axis="x")).max()) for name, run in runs.items()}
assert force["plain DCFP"] > 5.0 * force["LIR-DCFP"]

plots.hysteresis(runs)
