"""
A bearing in OpenSeesPy
=======================

A mass on one bearing under a sine, analysed by OpenSees; the bearing's recording is drawn as that
of a time history.
"""

from frames import plots
from frames.demo import bearing_for
from lir_element.opensees import bearing_element, opensees, record_bearings

bearing, mass = bearing_for(2000e3), 204e3  # kg
ops = opensees()
ops.wipe()
ops.model("basic", "-ndm", 3, "-ndf", 6)
ops.node(1, 0.0, 0.0, 0.0)
ops.node(2, 0.0, 0.0, bearing.height)
ops.fix(1, 1, 1, 1, 1, 1, 1)
ops.fix(2, 0, 0, 0, 1, 1, 1)
ops.mass(2, mass, mass, mass, 0.0, 0.0, 0.0)
bearing_element(10, 1, 2, bearing)
ops.timeSeries("Linear", 1)
ops.pattern("Plain", 1, 1)
ops.load(2, 0.0, 0.0, -mass * 9.80665, 0.0, 0.0, 0.0)
for integrator in (("LoadControl", 0.1), ("Newmark", 0.5, 0.25)):
    ops.system("UmfPack")  # the tangent is unsymmetric
    ops.test("NormDispIncr", 1e-9, 25)
    ops.algorithm("KrylovNewton")
    ops.integrator(*integrator)
    if integrator[0] == "LoadControl":
        ops.analysis("Static")
        ops.analyze(10)
        ops.loadConst("-time", 0.0)
        ops.wipeAnalysis()
        recording = record_bearings()
        ops.timeSeries("Trig", 2, 0.0, 1.6, 1.6, "-factor", 2.0)
        ops.pattern("UniformExcitation", 2, 1, "-accel", 2)
ops.analysis("Transient")
done = ops.analyze(800, 0.005)
data = recording.dataset()
ops.wipe()

assert done == 0

plots.hysteresis({"OpenSees": data}, str(data["bearing"][0].item()))
