"""
A campaign over friction
========================

Twelve Latin hypercube samples of friction and radius, each a time history: a campaign keeps them
on disk, and goes on where it was stopped.
"""

from tempfile import mkdtemp

import matplotlib.pyplot as plt
import numpy as np
from scipy.stats import uniform

from frames import GroundMotion, lumped_mass
from frames.risk import Campaign, latin_hypercube
from lir_element import CoulombFriction, LIRBearing

bearing = LIRBearing(
    radius=1.5,
    slider_height=0.2,
    slider_radius=0.2,
    capacity=0.3,
    friction=CoulombFriction(0.06),
    interface_friction=0.2,
)
t = np.arange(0.0, 6.0, 0.01)  # s
motion = GroundMotion(x=1.2 * np.sin(3.0 * t) * (t < 4.18), dt=0.01, name="pulse")
sample = latin_hypercube({"friction": uniform(0.03, 0.06), "radius": uniform(1.2, 0.8)}, 12, seed=1)
store = mkdtemp() + "/friction"
runs = Campaign(lumped_mass(bearing, mass=200e3), motion, store=store, sample=sample).run()
peak = 1e3 * runs["peak_displacement"].max("bearing")
plt.scatter(runs["friction"], peak, c=runs["radius"])
plt.colorbar(label="radius [m]")
plt.xlabel("friction coefficient [-]")
plt.ylabel("maximum displacement [mm]")

assert np.corrcoef(runs["friction"], peak)[0, 1] < -0.5
