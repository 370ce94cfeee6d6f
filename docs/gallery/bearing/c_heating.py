"""
Heat of cycles
==============

Sliding heats the plates, and friction falls with their temperature: five cycles of ±150 mm at 0.4
m/s.
"""

import matplotlib.pyplot as plt
import numpy as np

from lir_element import CoulombFriction, FrictionHeating, LIRBearing, cyclic_test

bearing = LIRBearing(
    radius=0.75,
    slider_height=0.085,
    slider_radius=0.08,
    capacity=0.175,
    friction=CoulombFriction(0.066),
    interface_friction=0.126,
    friction_heating=FrictionHeating(variant="half"),  # what is left at 200 C
)
path = np.tile([0.15, -0.15], 5)  # m
path = np.concatenate([np.linspace(a, b, 60) for a, b in zip([0.0, *path[:-1]], path, strict=True)])
test = cyclic_test(bearing, path, axial_load=150e3, velocity=0.4).squeeze()
plate = test["temperature"].sel(contact="bottom")
figure, (above, below) = plt.subplots(2, 1, sharex=True, layout="constrained")
above.plot(test["time"], plate)
above.set_ylabel("temperature of the plate [°C]")
below.plot(test["time"], test["friction_coefficient"].sel(surface="bottom"), color="C1")
below.set(xlabel="time [s]", ylabel="friction coefficient [-]")

assert 40.0 < float(plate.max()) < 80.0
