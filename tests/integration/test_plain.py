"""The time loop as plain Python: what the compiled one does, to round-off."""

import numpy as np
from numpy.testing import assert_allclose

from tests.plain import both_ways

SCRIPT = """
import numpy as np
from frames import GroundMotion, shear_building, time_history
from lir_element import LIRBearing, VelocityFriction

bearing = LIRBearing(
    radius=(0.75, 1.1), slider_height=0.11, slider_radius=0.08, rims=(0.03, 0.03),
    friction=VelocityFriction(0.07, 0.03, 12.0), interface_friction=0.12, design_load=3e5,
)
t = np.arange(0.0, 0.4, 0.01)
x, y, z = 2.2 * np.sin(9.0 * t), np.sin(11.0 * t), np.cos(30.0 * t)
motion = GroundMotion(x, y, z, dt=0.01)
model = shear_building(
    bearing, storey_mass=15e3, storey_stiffness=2e7, base_mass=15e3,
)
data = time_history(model, motion, dt=0.01)
names = ("bearing_displacement", "bearing_force", "interface_slip", "rim_force", "energy")
values = [data[name].to_numpy().tolist() for name in names]
out = [data.attrs["status"], data.attrs["steps"], *values]
"""


def test_the_compiled_loop_is_plain_python() -> None:
    compiled, python = both_ways(SCRIPT)
    assert compiled[:2] == python[:2]
    assert compiled[0] == "ok"
    for a, b in zip(compiled[2:], python[2:], strict=True):
        scale = np.abs(np.array(a)).max()
        assert scale > 0.0
        # Round-off (contracted multiply-adds, libm), amplified at the rims.
        assert_allclose(np.array(b) / scale, np.array(a) / scale, rtol=0.0, atol=1e-9)
