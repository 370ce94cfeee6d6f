"""
Radius, friction and displacement
=================================

Maximum displacement by the equivalent-linear procedure of ASCE 7-22, over the friction of bearings
of three radii.
"""

import matplotlib.pyplot as plt
import numpy as np

from frames.design import IsolationSystem, Spectrum, equivalent_linear
from lir_element import CoulombFriction, LIRBearing

spectrum = Spectrum.asce7(s_ms=0.9, s_m1=0.5)
frictions = np.linspace(0.03, 0.08, 6)
for radius in (1.0, 1.5, 2.0):  # m
    found = []
    for mu in frictions:
        bearing = LIRBearing(
            radius=radius,
            slider_height=0.2,
            slider_radius=0.2,
            capacity=0.4,
            friction=CoulombFriction(mu),
            interface_friction=0.2,
        )
        corners = ((-5, -5), (5, -5), (5, 5), (-5, 5))
        system = IsolationSystem(
            bearings=(bearing,) * 4, loads=(1.0e6,) * 4, positions=corners, plan=(12.0, 12.0)
        )
        found.append(1e3 * equivalent_linear(system, spectrum, bounds=None).displacement)
    plt.plot(100.0 * frictions, found, "o-", label=f"R = {radius:g} m")
    assert found[0] > found[-1]  # friction damps
plt.xlabel("friction coefficient [%]")
plt.ylabel("maximum displacement [mm]")
plt.legend()
