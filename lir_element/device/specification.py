"""What is specified of a bearing, and what follows from it: geometry, friction, defaults."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, cast

from lir_element.argument_checks import as_number, as_pair
from lir_element.device.backup import BackupSupport
from lir_element.device.friction import FrictionLaw
from lir_element.device.heating import FrictionHeating, PressureDependence
from lir_element.units import STANDARD_GRAVITY

_STACK_MODULUS = 20e9  # Pa, slider with its liners: a tenth of steel's
STACK_RANGE = 0.3, 3.0
"""Of the default axial stiffness, in which sliders with liners lie (docs/choices.md)."""

_DESIGN_PRESSURE = 30e6  # Pa, on the slider's area
_AXIAL_DAMPING_RATIO = 0.05
_RIM_DAMPING_RATIO = 0.10


@dataclass(frozen=True, kw_only=True, repr=False)
class Specification:
    """The numbers of a bearing, each explained at `LIRBearing`, which checks them."""

    radius: float | tuple[float, float]
    slider_height: float
    slider_radius: float
    friction: FrictionLaw | float | tuple[FrictionLaw | float, FrictionLaw | float]
    interface_friction: float
    capacity: float | None = None
    rims: float | tuple[float, float] | None = None
    axial_stiffness: float | None = None
    axial_damping: float | None = None
    rim_stiffness: float | None = None
    rim_damping: float | None = None
    rim_yield_force: float = math.inf
    rim_hardening: float = 0.005
    rim_overrun: float | None = None
    flange: float | None = None
    slip_capacity: float | None = None
    uplift_capacity: float = math.inf
    backup: BackupSupport | None = None
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
    contact_points: int | None = None
    allow_weak_interface: bool = False
    pressure_dependence: PressureDependence | None = None
    friction_heating: FrictionHeating | None = None

    @property
    def radii(self) -> tuple[float, float]:
        """Radius of the bottom and of the top surface [m]."""
        first, second = as_pair("radius", self.radius)
        return as_number("radius", first, "m"), as_number("radius", second, "m")

    @property
    def frictions(self) -> tuple[FrictionLaw, FrictionLaw]:
        """Friction of the bottom and of the top surface."""
        return cast("tuple[FrictionLaw, FrictionLaw]", as_pair("friction", self.friction))

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
        """Characteristic strength ratio Q/W at high speed [-].

        (mu1 R1 + mu2 R2) / L, from the moment equilibrium of the slider.
        """
        moment = sum(f.f_max * r for f, r in zip(self.frictions, self.radii, strict=True))
        return moment / self.effective_radius

    @property
    def slip_stability(self) -> float:
        """Stable limit of interface slip without rims [m]: ``L mu_h - mu1 R1 - mu2 R2``.

        Where the motion turns again in the direction of a larger slip, the interface slides before
        the surfaces do, until the sliders' overlap ends (docs/theory.md, Eq. 2.7). Infinite with
        the rigid slider.
        """
        return self.effective_radius * (self.interface_friction - self.effective_friction)

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
        """Whether the slider is rigid, as in a plain DCFP."""
        return math.isinf(self.interface_friction)

    def resolved(self) -> dict[str, float]:
        """Return the optional mechanical properties, defaults filled in (SI units)."""
        area = math.pi * self.slider_radius**2
        load = self.design_load or _DESIGN_PRESSURE * area
        mass = load / STANDARD_GRAVITY
        axial = self.axial_stiffness or stack_stiffness(area, self.slider_height)
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


def stack_stiffness(area: float, height: float) -> float:
    """Return the default axial stiffness of a slider with its liners [N/m]: an estimate."""
    return _STACK_MODULUS * area / height


def _or(value: float | None, default: float) -> float:
    return default if value is None else float(value)
