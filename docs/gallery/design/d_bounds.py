"""
Lower and upper bound loops
===========================

Codes ask for analyses at the lower and the upper bound of friction: the loops of both, and of the
nominal bearing.
"""

import matplotlib.pyplot as plt
import numpy as np

from frames.demo import bearing_for
from frames.design import PropertyBounds, PropertyModificationFactors, with_property_bounds
from lir_element import cyclic_test

load, edc = 1000e3, {}  # N; energy dissipated per cycle over the load [m]
path = 0.2 * np.cos(np.linspace(0.0, 2.0 * np.pi, 401))  # m
bounds = PropertyBounds(friction=PropertyModificationFactors(0.8, 1.3))
for bound in ("upper", "nominal", "lower"):
    bearing = with_property_bounds(bearing_for(load), bound, bounds)
    test = cyclic_test(bearing, path, load, velocity=0.5).sel(axis="x").squeeze()
    force = test["bearing_force"] / load
    plt.plot(1e3 * test["bearing_displacement"], force, label=bound)
    edc[bound] = float(np.trapezoid(force, test["bearing_displacement"]))
plt.xlabel("displacement [mm]")
plt.ylabel("force / axial load [-]")
plt.legend(title="friction")

assert abs(edc["upper"] / edc["lower"] - 1.3 / 0.8) < 0.03
