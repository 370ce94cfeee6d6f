"""Ready-made models: a mass on one bearing, a storey stick on bearings, a steel moment frame."""

from __future__ import annotations

from typing import TYPE_CHECKING

from frames._errors import ModelError
from frames.frame import Frame
from frames.library.building import require_device
from frames.library.moment_frames import moment_frame as moment_frame
from frames.library.shear_buildings import shear_building as shear_building
from lir_element.argument_checks import require_positive
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from lir_element import LIRBearing


def lumped_mass(
    bearing: LIRBearing,
    mass: float,
    *,
    inertia: tuple[float, float, float] | None = None,
    gravity: float = STANDARD_GRAVITY,
    name: str = "lumped mass",
) -> Frame:
    """Build a mass on one bearing.

    Parameters
    ----------
    bearing : LIRBearing
        The device.
    mass : float
        Mass above the bearing [kg], > 0.
    inertia : (float, float, float), optional
        Rotational inertia of the mass about x, y, z through the top node [kg m2], > 0: it is then
        free to rotate, for the levels "contact" and "rigid_body" (at the level "pendulum" a
        bearing does not hold its plate's tilt). None: the plates stay parallel.
    gravity : float
        Acceleration of gravity [m/s2].
    name : str
        Name of the model.

    Returns
    -------
    Frame
        Nodes "ground" (fixed) and "mass" (ux, uy, uz free), bearing "bearing", no damping.

    Raises
    ------
    TypeError
        If the device is no bearing.
    ModelError
        If mass, inertia or gravity is not positive.

    Examples
    --------
    >>> from frames import lumped_mass
    >>> from frames.demo import bearing_for
    >>> lumped_mass(bearing_for(2000e3), mass=204e3)
    Frame("lumped mass": 2 nodes, 0 members, 0 springs, 0 diaphragms, 1 bearings)
    """
    require_device("bearing", bearing)
    frame = Frame(name, gravity)
    frame.add_node("ground", 0.0, 0.0, 0.0)
    frame.add_node("mass", 0.0, 0.0, bearing.height)
    frame.fix("ground", "all")
    checked = require_positive(
        "lumped_mass: mass [kg]", mass, remedy="give the isolated mass", error=ModelError
    )
    if inertia is None:
        frame.fix("mass", "rx", "ry", "rz")
        frame.add_mass("mass", checked)
    else:
        moments = [
            require_positive("lumped_mass: inertia [kg m2]", value, error=ModelError)
            for value in inertia
        ]
        frame.add_mass("mass", checked, moments)
    frame.add_bearing("bearing", "ground", "mass", bearing)
    return frame
