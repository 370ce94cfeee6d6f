"""
Three levels of fidelity
========================

A push beyond the restraining rims with the bearing as a condensed element ("pendulum"), with its
sliders as bodies ("contact"), and as rigid bodies in time ("rigid_body"): the levels are verified
against one another.
"""

import matplotlib.pyplot as plt
import numpy as np

from frames.demo import bearing_for
from lir_element import cyclic_test

load, largest = 1000e3, {}  # N
path = 0.28 * np.sin(np.linspace(0.0, 1.5 * np.pi, 151))  # m
styles = {"pendulum": "-", "contact": "--", "rigid_body": ":"}
for level, style in styles.items():
    test = cyclic_test(bearing_for(load), path, load, velocity=0.2, level=level)
    test = test.sel(axis="x").squeeze()
    force = test["bearing_force"] / load
    plt.plot(1e3 * test["bearing_displacement"], force, style, label=level)
    largest[level] = float(force.max())
plt.xlabel("displacement [mm]")
plt.ylabel("force / axial load [-]")
plt.legend()

assert max(largest.values()) / min(largest.values()) < 1.05  # the mass of the rigid bodies swings
