"""
2. A mass on a bearing
======================

A time history of 204 t on one bearing under a pulse of the ground, on the LIR-DCFP and on a plain
DCFP.
"""

# %%
# Ground motion and model
# -----------------------
# A motion is an acceleration along x, y, z in m/s². Files are read by ``GroundMotion.from_at2``
# and ``from_columns``.

import numpy as np

from frames import GroundMotion, audit, energy_error, lumped_mass, plots, summary, time_history
from lir_element import LIRBearing, VelocityFriction

bearing = LIRBearing(
    radius=1.185,
    slider_height=0.12,
    slider_radius=0.15,
    capacity=0.25,  # m
    friction=VelocityFriction(f_max=0.065, f_min=0.0325, rate=15.0),  # -, -, s/m
    interface_friction=0.13,
)
t = np.arange(0.0, 6.0, 0.005)  # s
motion = GroundMotion(x=2.0 * np.sin(2.0 * np.pi * t / 1.6) * (t < 1.6), dt=0.005)  # m/s2
model = lumped_mass(bearing, mass=204e3)  # kg
print(model.check(motion))

# %%
# Time histories
# --------------

runs = {
    "LIR-DCFP": time_history(model, motion),
    "plain DCFP": time_history(model.with_bearings(bearing.as_dcfp()), motion),
}
plots.histories(runs)

# %%
# Force over displacement. The plain DCFP strikes its rims; the arrow names the peak of its force.

plots.hysteresis(runs)

# %%
# The bearing to scale: before the impact, at rim contact, at the largest displacement, after it.

plots.bearing_sections(runs["LIR-DCFP"])

# %%
# What to look at first
# ---------------------
# The status, the energy balance, and the check of modelling assumptions.

for name, run in runs.items():
    print(name, run.attrs["status"], f"energy error {energy_error(run):.1e}")
    print("warnings:", [finding for finding in audit(run) if finding.doubtful])
    assert energy_error(run) < 1e-3

# %%
# Both runs side by side:

summary(runs)
