"""
Storey profiles
===============

Maximum drift and acceleration of each storey: an impact on the rims shakes the frame of the plain
DCFP.
"""

import numpy as np

from frames import GroundMotion, moment_frame, peaks, plots, time_history
from frames.demo import bearing_for

t = np.arange(0.0, 6.0, 0.01)  # s
x, y = (a * np.sin(w * t) * (t < 3.14) for a, w in ((2.0, 4.0), (0.8, 5.0)))  # m/s2
motion = GroundMotion(x=x, y=y, dt=0.01)
bearing = bearing_for(500e3)
building = moment_frame((1, 1), 2, bearing=bearing)
plain = building.with_bearings(bearing.as_dcfp())
runs = {
    name: time_history(model, motion, duration=6.0, level="contact")
    for name, model in {"LIR-DCFP": building, "plain DCFP": plain}.items()
}

quantity = "storey drift, maximum at any column line"
drift = {name: peaks(run).loc[quantity, "value"] for name, run in runs.items()}
assert drift["plain DCFP"] > drift["LIR-DCFP"]

plots.storey_profiles(runs)
