"""
Three loops: no rims, rims, LIR-DCFP
====================================

The static test of the paper, 150 kN and cycles of ±185 mm: beyond the restraining rims the force
of a plain DCFP has no bound, that of the LIR-DCFP ends where its interface slips.
"""

import matplotlib.pyplot as plt
import numpy as np

from lir_element import CoulombFriction, LIRBearing, cyclic_test

bearing = LIRBearing(
    radius=0.75,
    slider_height=0.085,
    slider_radius=0.08,
    capacity=0.175,  # m
    friction=CoulombFriction(0.066),
    interface_friction=0.126,
)
devices = {
    "DCFP, no rims": bearing.as_dcfp(rims=False),
    "DCFP with rims": bearing.as_dcfp(),
    "LIR-DCFP": bearing,
}
load, largest = 150e3, {}  # N
figure, panels = plt.subplots(1, 3, figsize=(9, 3.2), sharex=True, layout="constrained")
for panel, (name, device) in zip(panels, devices.items(), strict=True):
    reach = 0.176 if name == "DCFP with rims" else 0.185  # 1 mm into the rims
    path = reach * np.interp(np.linspace(0.0, 5.0, 2001), range(6), [0, 1, -1, 1, -1, 0])  # m
    test = cyclic_test(device, path, load).sel(axis="x").squeeze()
    panel.plot(1e3 * test["bearing_displacement"], test["bearing_force"] / load)
    panel.set(title=name, xlabel="displacement [mm]")
    largest[name] = float(abs(test["bearing_force"]).max()) / load
panels[0].set_ylabel("force / axial load [-]")

assert abs(largest["LIR-DCFP"] - bearing.force_limit(load) / load) < 0.002
