"""What many tests stand on: bearings, motions and texts of projects; a keyword changes one."""

import math
import warnings
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from frames import AuditWarning, Section
from lir_element import AnalysisWarning, CoulombFriction, LIRBearing, VelocityFriction

if TYPE_CHECKING:
    from frames import GroundMotion

# The bearing of the paper's numerical example, section 3.1 (COMPDYN 2023).
paper_bearing = partial(
    LIRBearing,
    radius=1.185,
    slider_height=0.12,
    slider_radius=0.15,
    capacity=0.25,
    friction=VelocityFriction(f_max=0.065, f_min=0.0325, rate=15.0),
    interface_friction=0.13,
)
# The one of its section 2.2.
small_bearing = partial(
    LIRBearing,
    radius=0.75,
    slider_height=0.085,
    slider_radius=0.08,
    capacity=0.175,
    friction=CoulombFriction(0.066),
    interface_friction=0.126,
)
# Radii of 1 m, and rims that are soon met.
simple_bearing = partial(
    LIRBearing,
    radius=1.0,
    slider_height=0.1,
    slider_radius=0.1,
    capacity=0.12,
    friction=0.05,
    interface_friction=0.13,
)
# A plain double pendulum without rims.
plain_pendulum = partial(simple_bearing, capacity=math.inf, interface_friction=math.inf)
# Wide plates, whose rims are met late.
wide_bearing = partial(
    LIRBearing,
    radius=1.5,
    slider_height=0.2,
    slider_radius=0.2,
    capacity=0.3,
    friction=0.05,
    interface_friction=0.2,
)
# A slider that stands high on wide plates.
tall_bearing = partial(
    wide_bearing, slider_height=0.3, capacity=0.45, friction=0.06, interface_friction=0.25
)
# The bearing of the tests of overturning: a wide slider on plates of 2.5 m.
large_bearing = partial(
    LIRBearing,
    radius=2.5,
    slider_height=0.225,
    slider_radius=0.225,
    capacity=0.356,
    friction=0.05,
    interface_friction=0.105,
)
# Under a heavy load: a slider of 0.6 m.
heavy_bearing = partial(
    wide_bearing, slider_height=0.25, slider_radius=0.3, capacity=0.2, interface_friction=0.16
)
# Of two radii.
uneven_bearing = partial(
    LIRBearing,
    radius=(1.0, 0.8),
    slider_height=0.1,
    slider_radius=0.12,
    capacity=0.08,
    friction=VelocityFriction(0.06, 0.03, 20.0),
    interface_friction=0.14,
)
# A pair whose sides differ in all.
rimmed_bearing = partial(
    LIRBearing,
    radius=(0.75, 1.1),
    slider_height=0.11,
    slider_radius=0.08,
    rims=(0.07, 0.11),
    friction=0.05,
    interface_friction=0.15,
)

# Of steel, without mass; the two axes differ.
SECTION = Section(
    area=0.01,
    inertia_y=8e-5,
    inertia_z=3e-5,
    torsion_constant=2e-5,
    elastic_modulus=200e9,
    shear_modulus=77e9,
    density=0.0,
)


def swell(
    *,
    middle: float = 1.5,
    width: float = 0.9,
    end: float = 4.0,
    dt: float = 0.005,
    name: str = "",
    **waves: tuple[float, float],
) -> "GroundMotion":
    """Return sines of a peak and a period [m/s2, s] for each axis, which grow and fade."""
    from frames import GroundMotion  # half a second, which bearings alone do not need

    time = np.arange(0.0, end, dt)
    bell = np.exp(-(((time - middle) / width) ** 2))
    axes = {
        axis: peak * bell * np.sin(2.0 * np.pi * time / period)
        for axis, (peak, period) in waves.items()
    }
    return GroundMotion(**axes, dt=dt, name=name)


def full_sine(size: float, across: float = 0.0, rest: float = 4.0) -> "GroundMotion":
    """Return a full sine of 2 s along x, a share of it along y, and some rest."""
    from frames import GroundMotion

    time = np.arange(0.0, 2.0 + rest, 0.01)
    wave = size * np.sin(math.pi * time) * (time < 2.0)
    more = {"y": across * wave} if across else {}
    return GroundMotion(x=wave, dt=0.01, name=f"pulse {size:g}", **more)


def quietly(analyse: Callable[..., Any], *given: Any, **options: Any) -> Any:
    """Analyse without the warnings of runs that stop or are doubtful."""
    with warnings.catch_warnings():
        for kind in (AnalysisWarning, AuditWarning):
            warnings.simplefilter("ignore", kind)
        return analyse(*given, **options)


STICK = """
[structure]
kind = "shear building"
bays = [1, 1]
bay_width = ["6 m", "6 m"]
storey_mass = ["100 t"]
storey_stiffness = ["300 kN/mm"]
storey_height = "3 m"
"""
DEVICE = """
[bearing]
radius = "1.5 m"
slider_height = "200 mm"
slider_radius = "200 mm"
capacity = "180 mm"
friction = 0.06
interface_friction = 0.18
"""
SOIL = '[spectrum]\nsoil = "II"\nzone = 2\n'
BOUNDS = "[bounds]\nfriction = [0.8, 1.3]\n"
MOTIONS = '[motions]\nfolder = "motions"\n'


def solve_linear(ops: Any, system: str = "BandGeneral", numberer: str = "Plain") -> None:
    """Analyse the loads on OpenSees' model in one linear static step."""
    ops.system(system)
    ops.numberer(numberer)
    ops.constraints("Plain")
    ops.integrator("LoadControl", 1)
    ops.algorithm("Linear")
    ops.analysis("Static")
    assert ops.analyze(1) == 0


def project_head(name: str, code: str = "NCh2745") -> str:
    """Return the first lines of a project's file."""
    return f'[project]\nname = "{name}"\ncode = "{code}"\n'
