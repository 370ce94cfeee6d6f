"""
Friction and speed
==================

Loops of a bearing whose friction grows with the sliding speed, at 1 mm/s and at 0.5 m/s, and the
energy dissipated per cycle (EDC).
"""

import matplotlib.pyplot as plt
import numpy as np

from frames.demo import bearing_for
from lir_element import cyclic_test

load = 1000e3  # N
bearing = bearing_for(load)
edc = {}
path = 0.2 * np.cos(np.linspace(0.0, 2.0 * np.pi, 401))  # m
for speed in (0.001, 0.5):  # m/s
    test = cyclic_test(bearing, path, load, velocity=speed).sel(axis="x").squeeze()
    u, force = test["bearing_displacement"].to_numpy(), test["bearing_force"].to_numpy()
    plt.plot(1e3 * u, force / load, label=f"{1e3 * speed:g} mm/s")
    edc[speed] = float(np.trapezoid(force, u))  # J
plt.xlabel("displacement [mm]")
plt.ylabel("force / axial load [-]")
plt.legend(title="speed")

f_min, f_max = bearing.friction.f_min, bearing.friction.f_max
assert abs(edc[0.5] / edc[0.001] - f_max / f_min) < 0.05 * f_max / f_min
