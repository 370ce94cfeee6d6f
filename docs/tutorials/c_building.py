"""
3. A building
=============

A steel frame of two storeys on four bearings: model, gravity, modes, time history, forces.
"""

# %%
# Model
# -----
# ``moment_frame`` makes a regular frame with a bearing under every column; other structures are
# built node by node as a ``Frame``.

import numpy as np

from frames import (
    GroundMotion,
    gravity,
    member_forces,
    modes,
    moment_frame,
    peaks,
    plots,
    storey_forces,
    time_history,
)
from frames.demo import bearing_for

building = moment_frame(bays=(1, 1), storeys=2, bearing=bearing_for(500e3))
plots.model_view(building)

# %%
# Gravity and modes
# -----------------

print("axial forces [kN]", (1e-3 * gravity(building).axial_forces).round(1))
print("periods on the bearings [s]", modes(building, 3).periods.round(2))
print("periods, fixed base [s]", modes(building, 3, bearings="fixed").periods.round(3))
plots.mode_shapes(building, 3)

# %%
# Time history
# ------------
# The building rocks on its bearings when the rims are met, so that sliders may open on one side:
# the level "contact" has sliders as bodies. (The default, "pendulum", is faster; its check of
# modelling assumptions tells when it is not enough.)

t = np.arange(0.0, 6.0, 0.01)  # s
x, y = (a * np.sin(w * t) * (t < 3.14) for a, w in ((2.0, 4.0), (0.8, 5.0)))  # m/s2
motion = GroundMotion(x=x, y=y, dt=0.01)
data = time_history(building, motion, level="contact")
plots.orbits(data)

# %%
# Displacements and forces
# ------------------------

plots.storey_profiles(data)

# %%
# Largest responses, when and where:

table = peaks(data)
assert 0.0 < table.loc["storey drift, maximum at any column line", "value"] < 0.01
table

# %%
# Forces are recovered from the displacements; nothing needs to be asked for beforehand.

shear = abs(storey_forces(building, data).sel(component="Vx")).max("time")
moment = member_forces(building, data, ["column-1-0-0"]).sel(end="i", component="My")
print("storey shears [kN]", (1e-3 * shear.to_numpy()).round(0))
print(f"moment at the foot of a column {1e-3 * float(abs(moment).max()):.0f} kN m")
