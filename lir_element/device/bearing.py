"""The LIR-DCFP bearing, as an engineer specifies it: geometry, friction, rims."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Literal, cast

import numpy as np

from lir_element.device.bearing_checks import check_bearing
from lir_element.device.friction import Friction
from lir_element.door import as_number, as_pair, frozen_pair, require_positive
from lir_element.layout import PROPS, PROPS_FIELDS, Records

STANDARD_GRAVITY = 9.80665
_STACK_MODULUS = 20e9  # Pa, slider with its liners: a tenth of steel's
_DESIGN_PRESSURE = 30e6  # Pa, on the slider's area
_AXIAL_DAMPING_RATIO = 0.05
_RIM_DAMPING_RATIO = 0.10


@dataclass(frozen=True, kw_only=True)
class LIRBearing:
    """A Lateral Impact Resilient Double Concave Friction Pendulum bearing.

    Parameters
    ----------
    radius : float or (float, float)
        Radius of the concave surfaces, bottom and top [m].
    slider_height : float
        Height of the whole inner slider on its axis, h [m].
    slider_radius : float
        Radius of the inner slider in plan [m].
    friction : CoulombFriction or VelocityFriction, or a pair of them
        Low friction of the surfaces, bottom and top.
    interface_friction : float
        Friction coefficient mu_h of the plane interface [-]; ``math.inf`` fuses the two sliders
        (a plain DCFP).
    capacity : float, optional
        Lateral displacement at the first rim contact, plates parallel [m]; ``math.inf`` for a
        bearing without rims. Both rims are then met together.
    rims : float or (float, float), optional
        Sliding displacement at which each rim is met, bottom and top [m]; instead of `capacity`
        where they differ.
    axial_stiffness, axial_damping : float, optional
        Of the contact along the slider's axis [N/m, N s/m]. Default: a slider with liners of
        20 GPa in all, and 5 % of critical damping under the design load.
    rim_stiffness, rim_damping : float, optional
        Of a rim in radial direction [N/m, N s/m]. Default: a tenth of the axial stiffness, and
        10 % of critical damping.
    rim_overrun : float, optional
        Deformation of a rim beyond which the slider has overrun it [m]: the bearing fails.
        Default: a tenth of the slider's radius.
    slip_capacity : float, optional
        Interface slip beyond which the sliders' overlap no longer carries [m]: the bearing fails.
        Default: the slider's radius (39 % of the area still overlaps).
    design_load : float, optional
        Axial load the defaults refer to [N]. Default: 30 MPa on the slider's area.
    yield_displacement, interface_yield_displacement : float
        Elastic sliding before slip, on a concave surface and in the interface [m], under the axial
        force at rest (the design load, where a bearing moves before it was at rest under load).
    friction_law : {"elastic-plastic", "bouc-wen"}
        Regularisation of friction. Bouc-Wen creeps under small vibration about a biased force,
        the more the larger the yield displacement (docs/theory.md); it is there for comparison.
    bouc_wen_exponent : float
        Exponent of that law [-], at least 1.
    torsional_friction : bool
        Whether the contacts resist rotation about the vertical axis.
    plate_thickness : float or (float, float)
        Distance from each node to the vertex of its concave surface [m].
    slider_density : float
        Density of the sliders [kg/m3], for mass and inertia at the levels with contact points.
    slider_mass : float or (float, float), optional
        Mass of the bottom and the top slider [kg] instead of that from density and geometry.
    slider_inertia : ((float, float), (float, float)), optional
        Moments of inertia of both sliders about a transverse axis through the mass centre and
        about the slider's axis [kg m2].
    contact_points : int
        Contact points of each of the three interfaces, at the levels that have them: 4 to 7 lie on
        the slider's edge, an even number from 8 on lies on two rings that act as a full disc.
    allow_weak_interface : bool
        Accept ``mu_h <= mu_d``, with which the device does not work as intended.

    Raises
    ------
    ValueError, TypeError
        If a value is out of bounds: the message names value, bound and remedy.

    Notes
    -----
    Source: the paper (COMPDYN 2023), section 2; Auad and Almazan (2021), Eng. Struct. 233, 111892.

    Examples
    --------
    >>> from lir_element import CoulombFriction
    >>> bearing = LIRBearing(radius=0.75, slider_height=0.085, slider_radius=0.08, capacity=0.175,
    ...                      friction=CoulombFriction(0.066), interface_friction=0.126)
    >>> round(bearing.effective_radius, 3)
    1.415
    >>> tuple(round(d, 4) for d in bearing.rim_displacement)
    (0.0928, 0.0928)
    """

    radius: float | tuple[float, float]
    slider_height: float
    slider_radius: float
    friction: Friction | tuple[Friction, Friction]
    interface_friction: float
    capacity: float | None = None
    rims: float | tuple[float, float] | None = None
    axial_stiffness: float | None = None
    axial_damping: float | None = None
    rim_stiffness: float | None = None
    rim_damping: float | None = None
    rim_overrun: float | None = None
    slip_capacity: float | None = None
    design_load: float | None = None
    yield_displacement: float = 0.25e-3
    interface_yield_displacement: float = 0.01e-3
    friction_law: Literal["elastic-plastic", "bouc-wen"] = "elastic-plastic"
    bouc_wen_exponent: float = 2.0
    torsional_friction: bool = True
    plate_thickness: float | tuple[float, float] = 0.0
    slider_density: float = 7850.0
    slider_mass: float | tuple[float, float] | None = None
    slider_inertia: tuple[tuple[float, float], tuple[float, float]] | None = None
    contact_points: int = 8
    allow_weak_interface: bool = False

    def __post_init__(self) -> None:
        for name in ("radius", "friction", "plate_thickness", "rims", "slider_mass"):
            object.__setattr__(self, name, frozen_pair(name, getattr(self, name)))
        inertia: object = self.slider_inertia
        if isinstance(inertia, (tuple, list, np.ndarray)):
            pairs = tuple(
                tuple(pair) if isinstance(pair, (tuple, list, np.ndarray)) else pair
                for pair in inertia
            )
            object.__setattr__(self, "slider_inertia", pairs)
        check_bearing(self)

    @property
    def radii(self) -> tuple[float, float]:
        """Radius of the bottom and of the top surface [m]."""
        first, second = as_pair("radius", self.radius)
        return as_number("radius", first, "m"), as_number("radius", second, "m")

    @property
    def frictions(self) -> tuple[Friction, Friction]:
        """Friction of the bottom and of the top surface."""
        return cast("tuple[Friction, Friction]", as_pair("friction", self.friction))

    @property
    def effective_radius(self) -> float:
        """L = R1 + R2 - h [m] (R_eff in the paper)."""
        return sum(self.radii) - self.slider_height

    @property
    def rim_displacement(self) -> tuple[float, float]:
        """Sliding on the bottom and the top surface at which its rim is met [m]."""
        if self.rims is not None:
            bottom, top = as_pair("rims", self.rims)
            return as_number("rims", bottom, "m"), as_number("rims", top, "m")
        first, second = self.radii
        ratio = float(self.capacity or math.inf) / self.effective_radius
        return first * ratio, second * ratio

    @property
    def lateral_capacity(self) -> float:
        """Lateral displacement at the first rim contact, plates parallel [m]."""
        ratios = (d / r for d, r in zip(self.rim_displacement, self.radii, strict=True))
        return self.effective_radius * min(ratios)

    @property
    def effective_friction(self) -> float:
        """Sliding force at zero displacement over weight, at high speed [-].

        (mu1 R1 + mu2 R2) / L, from the moment equilibrium of the slider.
        """
        moment = sum(f.f_max * r for f, r in zip(self.frictions, self.radii, strict=True))
        return moment / self.effective_radius

    @property
    def period(self) -> float:
        """Period of the pendulum, 2 pi sqrt(L / g) [s]."""
        return 2.0 * math.pi * math.sqrt(self.effective_radius / STANDARD_GRAVITY)

    @property
    def height(self) -> float:
        """Vertical distance from node i to node j, undeformed [m]."""
        return sum(as_pair("plate_thickness", self.plate_thickness)) + self.slider_height

    @property
    def is_dcfp(self) -> bool:
        """Whether the slider is one piece."""
        return math.isinf(self.interface_friction)

    def force_limit(self, axial_load: float) -> float:
        """Return the lateral force that starts the high-friction sliding at the rim [N].

        ``W tan(theta_max + atan(mu_h))`` with ``sin(theta_max) = U_cap / L``: the interface,
        tilted by theta_max, carries W and mu_h times its normal force.

        Parameters
        ----------
        axial_load : float
            Vertical load W [N].

        Returns
        -------
        float
            Lateral force [N]; infinite without rims, with the slider in one piece, or where tilt
            and friction angle reach 90 degrees together.
        """
        require_positive("axial_load", axial_load, "N")
        if self.is_dcfp or math.isinf(self.lateral_capacity):
            return math.inf
        tilt = math.asin(self.lateral_capacity / self.effective_radius)
        angle = tilt + math.atan(self.interface_friction)
        return axial_load * math.tan(angle) if angle < 0.5 * math.pi else math.inf

    def as_dcfp(self, *, rims: bool = True) -> LIRBearing:
        """Return the same bearing with its slider in one piece, with or without its rims."""
        if rims:
            return replace(self, interface_friction=math.inf)
        return replace(self, interface_friction=math.inf, capacity=math.inf, rims=None)

    def resolved(self) -> dict[str, float]:
        """Return the optional mechanical properties, defaults filled in (SI units)."""
        area = math.pi * self.slider_radius**2
        load = self.design_load or _DESIGN_PRESSURE * area
        mass = load / STANDARD_GRAVITY
        axial = self.axial_stiffness or _STACK_MODULUS * area / self.slider_height
        rim = self.rim_stiffness or 0.1 * axial
        return {
            "design_load": load,
            "axial_stiffness": axial,
            "axial_damping": _or(
                self.axial_damping, 2.0 * _AXIAL_DAMPING_RATIO * math.sqrt(axial * mass)
            ),
            "rim_stiffness": rim,
            "rim_damping": _or(self.rim_damping, 2.0 * _RIM_DAMPING_RATIO * math.sqrt(rim * mass)),
            "rim_overrun": self.rim_overrun or 0.1 * self.slider_radius,
            "slip_capacity": self.slip_capacity or self.slider_radius,
        }

    def to_record(self) -> Records:
        """Return the kernels' properties, a record array of shape (1,)."""
        record = np.full(1, np.nan, dtype=[(f.name, "f8", f.shape) for f in PROPS_FIELDS])
        radii, laws, options = self.radii, self.frictions, self.resolved()
        thickness = as_pair("plate_thickness", self.plate_thickness)
        values: dict[str, object] = {
            "radius": radii,
            "lever": (radii[0] + thickness[0], radii[1] + thickness[1]),
            "length": self.effective_radius,
            "friction_max": [law.f_max for law in laws],
            "friction_drop": [law.f_max - law.f_min for law in laws],
            "friction_rate": [law.rate for law in laws],
            "interface_friction": self.interface_friction,
            "fused": self.is_dcfp,
            "bouc_wen": self.friction_law == "bouc-wen",
            "exponent": self.bouc_wen_exponent,
            "yield_displacement": self.yield_displacement,
            "interface_yield": self.interface_yield_displacement,
            "axial_floor": 1e-3 * options["design_load"],
            "rim_displacement": self.rim_displacement,
            "torsion_lever": 2.0 / 3.0 * self.slider_radius * self.torsional_friction,
            "torsion_yield": self.yield_displacement / (2.0 / 3.0 * self.slider_radius),
            "slider_radius": self.slider_radius,
            "bilateral": False,
            "fixed_load": 0.0,
        }
        names = {f.name for f in PROPS_FIELDS}
        values |= {name: value for name, value in options.items() if name in names}
        for name, value in values.items():
            record[name] = value
        missing = [name for name in record.dtype.names or () if np.isnan(record[name]).any()]
        if missing:
            msg = f"bearing record left incomplete: {missing}"
            raise AssertionError(msg)
        complete = np.zeros(1, dtype=PROPS)
        for name in record.dtype.names or ():
            complete[name] = record[name]
        return complete


def _or(value: float | None, default: float) -> float:
    return default if value is None else float(value)
