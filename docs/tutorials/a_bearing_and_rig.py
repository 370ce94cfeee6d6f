"""
1. A bearing and the testing rig
================================

What the device is, and what a test of it shows. You need ``lir_element`` alone.
"""

# %%
# The bearing
# -----------
# Two concave plates, a slider in two pieces between them, and restraining rims at the edges of the
# plates. The surfaces have a low friction, the interface between both pieces of the slider a high
# one.

import matplotlib.pyplot as plt
import numpy as np

from frames import plots
from lir_element import CoulombFriction, LIRBearing, cyclic_test

bearing = LIRBearing(
    radius=0.75,  # m, of both concave surfaces
    slider_height=0.085,
    slider_radius=0.08,
    capacity=0.175,  # m, displacement at the first rim contact
    friction=CoulombFriction(0.066),
    interface_friction=0.126,
)
plots.bearing_dimensions(bearing)

# %%
# What was left out has defaults; all properties that apply:

print(bearing.describe())

# %%
# A cycle within the rims
# -----------------------
# The loop of a friction pendulum: characteristic strength ratio Q/W, then the post-elastic
# stiffness W / L of a pendulum with the effective radius L.

load = 150e3  # N
path = 0.17 * np.sin(np.linspace(0.0, 4.0 * np.pi, 401))  # m
test = cyclic_test(bearing, path, axial_load=load, velocity=0.02).sel(axis="x").squeeze()
u, force = test["bearing_displacement"], test["bearing_force"]
plt.plot(1e3 * u, 1e-3 * force)
plt.xlabel("displacement [mm]")
plt.ylabel("force [kN]")
print(f"Q/W {bearing.effective_friction:.3f}, L {bearing.effective_radius:.3f} m")
print(f"period of the pendulum {bearing.period:.2f} s")

# %%
# Energy dissipated per cycle (EDC) over the second cycle, beside 4 Q U of the bilinear loop:

second = slice(100, 301)  # crest to crest
edc = np.trapezoid(force[second], u[second])
print(
    f"EDC {1e-3 * edc:.2f} kJ, 4 Q U {1e-3 * 4 * bearing.effective_friction * load * 0.17:.2f} kJ"
)
assert abs(edc / (4 * bearing.effective_friction * load * 0.17) - 1.0) < 0.02

# %%
# Beyond the rims
# ---------------
# At 175 mm the slider meets the rims. Its interface slips: the force stays below a limit, whatever
# the speed.

path = np.interp(np.linspace(0.0, 4.0, 1601), range(5), [0.0, 0.185, -0.185, 0.185, 0.0])  # m
test = cyclic_test(bearing, path, load, velocity=0.02).sel(axis="x").squeeze()
figure, (left, right) = plt.subplots(1, 2, figsize=(8, 3.4), layout="constrained")
left.plot(1e3 * test["bearing_displacement"], 1e-3 * test["bearing_force"])
left.axhline(1e-3 * bearing.force_limit(load), color="C3", linestyle="--")
left.set(xlabel="displacement [mm]", ylabel="force [kN]")
right.plot(1e3 * test["bearing_displacement"], 1e3 * test["interface_slip"])
right.set(xlabel="displacement [mm]", ylabel="interface slip [mm]")
assert float(test["bearing_force"].max()) < 1.001 * bearing.force_limit(load)
