"""Specified and derived properties of a bearing: geometry, friction, defaults."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Literal, cast

from lir_element.argument_checks import as_number, as_pair
from lir_element.device.friction import FrictionLaw
from lir_element.device.heating import FrictionHeating, PressureDependence
from lir_element.fields import check_numbers, number
from lir_element.units import STANDARD_GRAVITY, meant, per_cent

LARGEST_SLIDER = 3.0
"""Radius or height of a slider that nobody builds [m]; the largest are about 1 m."""

LARGEST_PLATE = 10.0
"""Distance from a node to its concave surface that no plate has [m]."""

_BUILT = f"(0, {LARGEST_SLIDER:g}]"
_NO_RIMS = "no restraining rims"

_STACK_MODULUS = 20e9  # Pa, slider with its liners: a tenth of steel's
STACK_RANGE = 0.3, 3.0
"""Range of the default axial stiffness for sliders with liners (docs/choices_bearing.md)."""

_DESIGN_PRESSURE = 30e6  # Pa, on the slider's area
_AXIAL_DAMPING_RATIO = 0.05
_RIM_DAMPING_RATIO = 0.10


@dataclass(frozen=True, slots=True, kw_only=True)
class BackupSupport:
    r"""A support beside a bearing that carries no load until the bearing has failed.

    With a backup support the failure of the bearing does not end the analysis. The failed bearing
    carries nothing, and the structure over it comes down by `drop`, on a flat stop that presses and
    rubs but does not pull. Without a stop (``drop=math.inf``) the neighbours have to carry the
    load.

    Parameters
    ----------
    drop : float
        Vertical displacement of the top plate from its undeformed place to the stop [m], at least
        0; ``math.inf``: there is no stop.
    friction : float
        Friction coefficient of the stop [-], at least 0 and below 1.
    stiffness : float, optional
        Vertical stiffness of the stop [N/m]. Default: the axial stiffness of the bearing.
    damping : float, optional
        Vertical damping of the stop [N s/m]. Default: the axial damping of the bearing.

    Raises
    ------
    ValueError, TypeError
        If a value is out of bounds: the message names value, bound and remedy.

    Notes
    -----
    The stop is assumed to be wide enough for every position of the structure. Its force acts under
    the top node, which rotates without resistance; the resulting moment acts on the bottom node.
    Its friction is that of the surfaces (docs/theory.md, section 3): elastic sliding by the
    bearing's `yield_displacement`, then slip.

    Examples
    --------
    >>> BackupSupport(drop=0.05, friction=0.3).stiffness is None
    True
    """

    drop: float = field(
        metadata=number(
            "m",
            "[0, 5) or inf",
            remedy=lambda drop: f"{meant(drop, 'm', 1e-3, 1.0)}, or math.inf without a stop",
        )
    )
    friction: float = field(default=0.3, metadata=number("-", "[0, 1)"))
    stiffness: float | None = field(default=None, metadata=number("N/m", "(0, inf)"))
    damping: float | None = field(default=None, metadata=number("N s/m", "(0, inf)"))

    def __post_init__(self) -> None:
        check_numbers(self)

    def __str__(self) -> str:
        """Return it in words, for tables."""
        if self.drop == math.inf:
            return "none: the neighbours carry"
        return f"after {1e3 * self.drop:.4g} mm, friction {self.friction:.3g}"


@dataclass(frozen=True, kw_only=True, repr=False)
class Specification:
    """The numbers of a bearing, each explained at `LIRBearing`, which checks them."""

    radius: float | tuple[float, float] = field(
        metadata=number("m", "(0, inf)", "radius of the concave surfaces")
    )
    slider_height: float = field(
        metadata=number("m", _BUILT, "height of the inner slider", usual=(2e-3, 1.5))
    )
    slider_radius: float = field(
        metadata=number("m", _BUILT, "radius of the inner slider in plan", usual=(2e-3, 1.5))
    )
    friction: FrictionLaw | float | tuple[FrictionLaw | float, FrictionLaw | float] = field(
        metadata={"title": "friction coefficient of the concave surfaces"}
    )
    interface_friction: float = field(
        metadata=number(
            "-",
            "(0, 1) or inf",
            "friction coefficient of the interface",
            remedy=lambda mu: f"{per_cent(mu)}, or math.inf for a slider in one piece",
            endless="rigid slider",
        )
    )
    capacity: float | None = field(
        default=None,
        metadata=number("m", "(0, inf]", "displacement capacity, to rim contact", endless=_NO_RIMS),
    )
    rims: float | tuple[float, float] | None = field(
        default=None,
        metadata=number(
            "m", "(0, inf]", "sliding on a surface to its restraining rim", endless=_NO_RIMS
        ),
    )
    axial_stiffness: float | None = field(
        default=None, metadata=number("N/m", "(0, inf)", "axial stiffness of the slider")
    )
    axial_damping: float | None = field(
        default=None, metadata=number("N s/m", "[0, inf)", "axial damping of the slider")
    )
    rim_stiffness: float | None = field(
        default=None, metadata=number("N/m", "(0, inf)", "radial stiffness of a restraining rim")
    )
    rim_damping: float | None = field(
        default=None, metadata=number("N s/m", "[0, inf)", "radial damping of a restraining rim")
    )
    rim_yield_force: float = field(
        default=math.inf,
        metadata=number(
            "N", "(0, inf]", "radial force at which a restraining rim yields", endless="elastic"
        ),
    )
    rim_hardening: float = field(
        default=0.005,
        metadata=number(
            "-",
            "[1e-4, 1)",  # with zero the force would not determine the displacement: a choice
            "stiffness of a yielding rim over the elastic one",
            remedy="it is the stiffness of a rim that yields over its elastic one, some 0.005 of "
            "steel",
        ),
    )
    rim_overrun: float | None = field(
        default=None, metadata=number("m", "(0, inf)", "rim deformation at restrainer failure")
    )
    flange: float | None = field(
        default=None, metadata=number("m", "(0, inf)", "way beyond a broken restraining rim")
    )
    slip_capacity: float | None = field(
        default=None, metadata=number("m", "(0, inf)", "interface slip at the end of the overlap")
    )
    uplift_capacity: float = field(
        default=math.inf, metadata=number("m", "(0, inf]", "uplift at which the bearing fails")
    )
    backup: BackupSupport | None = field(
        default=None, metadata={"title": "support after the bearing's failure"}
    )
    design_load: float | None = field(
        default=None, metadata=number("N", "(0, inf)", "axial load that defaults refer to")
    )
    yield_displacement: float = field(
        default=0.25e-3,
        metadata=number("m", "(0, inf)", "elastic displacement before sliding, concave surfaces"),
    )
    interface_yield_displacement: float = field(
        default=0.01e-3,
        metadata=number("m", "(0, inf)", "elastic displacement before slip, interface"),
    )
    interface_hold: float = field(
        default=0.0,
        metadata=number("N", "[0, inf)", "force that holds the halves of the slider together"),
    )
    friction_law: Literal["elastic-plastic", "bouc-wen"] = field(
        default="elastic-plastic", metadata={"title": "hysteretic model of friction"}
    )
    bouc_wen_exponent: float = field(
        default=2.0, metadata=number("-", "[1, inf)", "exponent of the Bouc-Wen model")
    )
    torsional_friction: bool = field(
        default=True, metadata={"title": "friction against rotation about the vertical"}
    )
    plate_thickness: float | tuple[float, float] = field(
        default=0.0,
        metadata=number(
            "m",
            f"[0, {LARGEST_PLATE:g}]",
            "plate thickness, node to vertex of the surface",
            usual=(1e-3, 1.0),
        ),
    )
    slider_density: float = field(
        default=7850.0, metadata=number("kg/m3", "(0, inf)", "density of the sliders")
    )
    slider_mass: float | tuple[float, float] | None = field(
        default=None, metadata=number("kg", "(0, inf)", "mass of the sliders")
    )
    slider_inertia: tuple[tuple[float, float], tuple[float, float]] | None = field(
        default=None, metadata=number("kg m2", "(0, inf)", "moments of inertia of the sliders")
    )
    contact_points: int | None = field(
        default=None, metadata={"title": "contact points of a slider's face"}
    )
    allow_weak_interface: bool = field(
        default=False, metadata={"title": "interface weaker than the surfaces accepted"}
    )
    pressure_dependence: PressureDependence | None = field(
        default=None, metadata={"title": "friction and pressure"}
    )
    friction_heating: FrictionHeating | None = field(
        default=None, metadata={"title": "friction and temperature"}
    )

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
        """Sliding at rim contact on the bottom and the top surface [m]."""
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

        If the motion turns again in the direction of a larger slip, the interface slides before the
        surfaces do, until the sliders' overlap ends (docs/theory.md, Eq. 2.7). Infinite with the
        rigid slider.
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
        """True if the slider is rigid, as in a plain DCFP."""
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
