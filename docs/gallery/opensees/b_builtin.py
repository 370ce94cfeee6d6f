"""
Beside an element that OpenSees ships
=====================================

A static cycle of a plain DCFP: this bearing, and OpenSees' element "singleFPBearing" put there by
one call.
"""

from dataclasses import replace

import matplotlib.pyplot as plt

from frames.demo import bearing_for
from lir_element import CoulombFriction
from lir_element.opensees import bearing_element, builtin_element, opensees

ops, load, largest = opensees(), 1000e3, {}  # N
bearing = replace(bearing_for(load), friction=CoulombFriction(0.05)).as_dcfp(rims=False)
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
    ops.system("UmfPack")
    ops.test("NormDispIncr", 1e-10, 50)
    ops.algorithm("KrylovNewton")
    u, force = [], []
    for case, (direction, size) in enumerate(
        ((2, -load), (0, 1.0)), start=1
    ):  # weight, then a push
        ops.timeSeries("Linear", case)
        ops.pattern("Plain", case, case)
        ops.load(2, *(size if k == direction else 0.0 for k in range(6)))
        ops.integrator("LoadControl", 0.1)
        ops.analysis("Static", "-noWarnings")
        if case == 1:
            ops.analyze(10)
            ops.loadConst("-time", 0.0)
    for steps, increment in ((100, 2e-3), (200, -2e-3), (200, 2e-3)):  # -, m
        ops.integrator("DisplacementControl", 2, 1, increment)
        for _ in range(steps):
            assert ops.analyze(1) == 0
            u.append(1e3 * ops.nodeDisp(2, 1))
            force.append(ops.getTime() / load)
    plt.plot(u, force, label=name)
    largest[name] = max(force)
plt.xlabel("displacement [mm]")
plt.ylabel("force / axial load [-]")
plt.legend()

assert abs(largest["bearing_element"] / largest["singleFPBearing"] - 1.0) < 0.06
