"""
Lower and upper bound loops
===========================

Codes ask for analyses at the lower and the upper bound of friction: the loops of both, and of the
nominal bearing.
"""

import matplotlib.pyplot as plt

from frames.demo import bearing_for
from frames.design import PropertyBounds, PropertyModificationFactors, with_property_bounds
from lir_element import cyclic_test

load, strength = 1000e3, {}  # N
bounds = PropertyBounds(friction=PropertyModificationFactors(0.8, 1.3))
for bound in ("upper", "nominal", "lower"):
    bearing = with_property_bounds(bearing_for(load), bound, bounds)
    test = cyclic_test(bearing, [0.2, -0.2, 0.2], load, velocity=0.5).sel(axis="x").squeeze()
    force = test["bearing_force"] / load
    plt.plot(1e3 * test["bearing_displacement"], force, label=bound)
    strength[bound] = bearing.effective_friction
plt.xlabel("displacement [mm]")
plt.ylabel("force / axial load [-]")
plt.legend(title="friction")

assert abs(strength["upper"] / strength["lower"] - 1.3 / 0.8) < 1e-9
