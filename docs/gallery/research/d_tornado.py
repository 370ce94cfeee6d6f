"""
Which property matters
======================

Displacement of a mass on one bearing as each property varies between its bounds.
"""

from dataclasses import replace

import numpy as np

from frames import GroundMotion, lumped_mass, time_history
from frames.demo import bearing_for
from frames.risk import tornado
from frames.risk.plots import tornado_chart
from lir_element import CoulombFriction

t = np.arange(0.0, 6.0, 0.01)  # s
motion = GroundMotion(x=1.5 * np.sin(4.0 * t) * (t < 3.14), dt=0.01)
bearing = replace(bearing_for(2000e3), interface_friction=0.25)


def displacements(sets):
    """Return the largest displacement [mm] of each set of properties."""
    found = []
    for each in sets:
        friction = CoulombFriction(each["friction"])
        device = replace(bearing, radius=each["radius"], friction=friction)
        data = time_history(lumped_mass(device, mass=204e3), motion)
        found.append(1e3 * float(abs(data["bearing_displacement"]).max()))
    return found


found = tornado(displacements, {"friction": (0.04, 0.06, 0.08), "radius": (1.0, 1.185, 1.4)})

assert found.table["swing"].max() > 10.0

tornado_chart(found, label="displacement", unit="mm")
