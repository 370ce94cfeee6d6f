"""
4. A building that yields
=========================

A stick of three storeys whose strength is limited, on both devices: what an impact on the rims
costs in ductility.
"""

# %%
# Storeys with a law
# ------------------
# ``storey_law`` gives each storey a hysteretic model; here bilinear, with a strength of 30 % of
# the weight above the base.

import numpy as np

from frames import GroundMotion, ductility, plots, shear_building, time_history
from frames.demo import bearing_for
from frames.laws import Bilinear

bearing = bearing_for(2000e3)
strength = 0.3 * 3 * 50e3 * 9.81  # N
building = shear_building(
    bearing,
    storey_mass=50e3,
    storey_stiffness=5e7,
    storeys=3,
    storey_law=lambda k: Bilinear(stiffness=k, yield_force=strength, hardening=0.03),
)
plain = building.with_bearings(bearing.as_dcfp())
t = np.arange(0.0, 6.0, 0.005)  # s
motion = GroundMotion(x=2.0 * np.sin(2.0 * np.pi * t / 1.6) * (t < 1.6), dt=0.005)
runs = {"LIR-DCFP": time_history(building, motion), "plain DCFP": time_history(plain, motion)}
plots.histories(runs, ["displacement", "base_shear"])

# %%
# Loops of the storeys
# --------------------

plots.link_loops(runs["plain DCFP"])

# %%

plots.link_loops(runs["LIR-DCFP"])

# %%
# Ductility
# ---------
# Largest deformation of each storey over its yield deformation.

demand = {}
for name, run in runs.items():
    ratio = abs(run["link_deformation"]).max("time") / run["link_yield_deformation"]
    demand[name] = float(ratio.max())
    print(f"{name}: {demand[name]:.2f}")
assert demand["plain DCFP"] > demand["LIR-DCFP"]

# %%
# What each storey did, and where the energy went:

ductility(runs["plain DCFP"])

# %%

plots.energy(runs)
