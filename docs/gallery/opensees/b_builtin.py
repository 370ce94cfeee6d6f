"""
Beside an element that OpenSees ships
=====================================

A static cycle of a plain DCFP: this bearing, and OpenSees' element "singleFPBearing" put there by one call.
"""

import matplotlib.pyplot as plt

from lir_element import CoulombFriction, LIRBearing
from lir_element.opensees import bearing_element, builtin_element, opensees

bearing = LIRBearing(
    radius=1.0,
    slider_height=0.1,
    slider_radius=0.15,
    capacity=0.3,
    friction=CoulombFriction(0.05),
    interface_friction=0.13,
).as_dcfp(rims=False)
ops, load, largest = opensees(), 1000e3, {}  # N
for name in ("bearing_element", "singleFPBearing"):
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    ops.node(1, 0.0, 0.0, 0.0)
    ops.node(2, 0.0, 0.0, bearing.height)
    ops.fix(1, 1, 1, 1, 1, 1, 1)
    ops.fix(2, 0, 1, 0, 1, 1, 1)
    if name == "bearing_element":
        bearing_element(10, 1, 2, bearing)
    else:
        builtin_element(name, 10, 1, 2, bearing, load)
    ops.constraints("Plain")
    ops.numberer("Plain")
    ops.system("UmfPack")
    ops.test("NormDispIncr", 1e-10, 50)
    ops.algorithm("KrylovNewton")
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    ops.load(2, 0.0, 0.0, -load, 0.0, 0.0, 0.0)
    ops.integrator("LoadControl", 0.1)
    ops.analysis("Static")
    ops.analyze(10)
    ops.loadConst("-time", 0.0)
    ops.timeSeries("Linear", 2)
    ops.pattern("Plain", 2, 2)
    ops.load(2, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    u, force = [], []
    for steps, increment in ((100, 2e-3), (200, -2e-3), (200, 2e-3)):
        ops.integrator("DisplacementControl", 2, 1, increment)
        for _ in range(steps):
            assert ops.analyze(1) == 0
            u.append(1e3 * ops.nodeDisp(2, 1))
            force.append(ops.getTime() / load)
    plt.plot(u, force, label=name)
    largest[name] = max(force)
ops.wipe()
plt.xlabel("displacement [mm]")
plt.ylabel("force / axial load [-]")
plt.legend()

assert abs(largest["bearing_element"] / largest["singleFPBearing"] - 1.0) < 0.06
