"""
5. The bearing in OpenSeesPy
============================

A mass on one bearing, once by OpenSees and once by ``time_history``. You need ``pip install
"lir-dcfp[opensees]"``.
"""

# %%
# The model
# ---------
# ``bearing_element`` puts the bearing between two nodes of the current model; it returns the route
# taken: "fast" is in-process, "portable" out-of-process.

import numpy as np

from frames import GroundMotion, lumped_mass, plots, time_history
from frames.demo import bearing_for
from lir_element.opensees import bearing_element, opensees, record_bearings

bearing, mass, dt = bearing_for(2000e3), 204e3, 0.005  # -, kg, s
t = np.arange(0.0, 4.0, dt)
ground = 2.0 * np.sin(2.0 * np.pi * t / 1.6) * (t < 1.6)  # m/s2

ops = opensees()
ops.wipe()
ops.model("basic", "-ndm", 3, "-ndf", 6)
ops.node(1, 0.0, 0.0, 0.0)
ops.node(2, 0.0, 0.0, bearing.height)
ops.fix(1, 1, 1, 1, 1, 1, 1)
ops.fix(2, 0, 0, 0, 1, 1, 1)
ops.mass(2, mass, mass, mass, 0.0, 0.0, 0.0)
print(bearing_element(10, 1, 2, bearing))

# %%
# Weight first
# ------------
# Friction is in proportion to the axial force. The tangent of a bearing that slides is
# unsymmetric: take UmfPack, and KrylovNewton, which passes an impact on the rims where plain
# Newton may stop.


def analysis(kind, *integrator):
    """Set up an analysis."""
    ops.wipeAnalysis()
    ops.constraints("Transformation")
    ops.numberer("RCM")
    ops.system("UmfPack")
    ops.test("NormDispIncr", 1e-9, 25)
    ops.algorithm("KrylovNewton")
    ops.integrator(*integrator)
    ops.analysis(kind)


ops.timeSeries("Linear", 1)
ops.pattern("Plain", 1, 1)
ops.load(2, 0.0, 0.0, -mass * 9.80665, 0.0, 0.0, 0.0)
analysis("Static", "LoadControl", 0.1)
ops.analyze(10)
ops.loadConst("-time", 0.0)

# %%
# The motion
# ----------

recording = record_bearings()
ops.timeSeries("Path", 2, "-dt", dt, "-values", *ground)
ops.pattern("UniformExcitation", 2, 1, "-accel", 2)
analysis("Transient", "Newmark", 0.5, 0.25)
assert ops.analyze(len(t) - 1, dt) == 0
by_opensees = recording.dataset()
ops.wipe()

# %%
# The same by ``time_history``
# ----------------------------

ours = time_history(lumped_mass(bearing, mass=mass), GroundMotion(x=ground, dt=dt))
peak = {
    name: 1e3 * float(abs(run["bearing_displacement"].sel(axis="x")).max())
    for name, run in {"OpenSees": by_opensees, "time_history": ours}.items()
}
print({name: round(value, 1) for name, value in peak.items()}, "mm")
assert abs(peak["OpenSees"] / peak["time_history"] - 1.0) < 0.005

# %%
# The recording has the variables of a time history, so that the same functions draw it.

name = str(by_opensees["bearing"][0].item())
plots.hysteresis({"OpenSees": by_opensees}, name)
