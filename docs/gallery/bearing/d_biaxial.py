"""
A path in two directions
========================

The top plate goes around a figure of eight: the friction force follows the direction of sliding,
the restoring force the place.
"""

import matplotlib.pyplot as plt
import numpy as np

from frames.demo import bearing_for
from lir_element import cyclic_test

load = 1000e3  # N
angle = np.linspace(0.0, 2.0 * np.pi, 241)
path = np.column_stack([0.2 * np.sin(angle), 0.1 * np.sin(2.0 * angle)])  # m
test = cyclic_test(bearing_for(load), path, load, velocity=0.3).squeeze()
figure, (left, right) = plt.subplots(1, 2, figsize=(8, 3.6), layout="constrained")
left.plot(*(1e3 * test["bearing_displacement"].sel(axis=axis) for axis in "xy"))
left.set(xlabel="x [mm]", ylabel="y [mm]", title="displacement", aspect="equal")
force = [test["bearing_force"].sel(axis=axis) / load for axis in "xy"]
right.plot(*force, color="C1")
right.set(xlabel="x", ylabel="y", title="force / axial load [-]", aspect="equal")

assert float(np.hypot(*force).max()) < bearing_for(load).force_limit(load) / load
