"""
Many time histories at once
===========================

Two devices under one motion at eight intensities, in one call: displacement and base shear of each
run.
"""

import warnings

import matplotlib.pyplot as plt
import numpy as np

from frames import GroundMotion, lumped_mass, time_histories
from frames.demo import bearing_for

t = np.arange(0.0, 6.0, 0.01)  # s
motion = GroundMotion(x=1.5 * np.sin(4.0 * t) * (t < 3.14), dt=0.01, name="pulse")
bearing = bearing_for(2000e3)
devices = {"LIR-DCFP": bearing, "plain DCFP": bearing.as_dcfp()}
models = {name: lumped_mass(device, mass=204e3) for name, device in devices.items()}
with warnings.catch_warnings(action="ignore"):  # some bearings fail: that is a result
    many = time_histories(models, motion, scales=np.linspace(0.3, 1.7, 8))
figure, panels = plt.subplots(1, 2, figsize=(8, 3.4), layout="constrained")
for panel, quantity in zip(panels, ("bearing displacement", "base shear over weight"), strict=True):
    for name in models:
        runs = many.isel(run=(many["model"] == name) & (many["status"] == "ok"))
        panel.plot(runs["scale"], runs["peak"].sel(quantity=quantity), "o-", label=name)
    panel.set(xlabel="scale of the motion [-]", title=quantity)
panels[0].legend()

assert many.sizes["run"] == 16
