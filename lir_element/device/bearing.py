"""The LIR-DCFP bearing, as an engineer specifies it: geometry, friction, rims."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any

import numpy as np

from lir_element.argument_checks import as_pair, frozen_pair, require_positive
from lir_element.device.bearing_checks import check_bearing
from lir_element.device.friction import as_laws
from lir_element.device.specification import Specification
from lir_element.fields import check_numbers
from lir_element.layout import FRICTION_TABLE, PROPS, PROPS_FIELDS, Records
from lir_element.texts import html_table, text_table
from lir_element.units import STANDARD_GRAVITY as STANDARD_GRAVITY

_FACTORS = (
    "pressure_rate",
    "pressure_load",
    "softens",
    "softening_scale",
    "softening_rate",
    "softening_rest",
    "heats",
    "initial_temperature",
    "heat_rate",
    "heat_gain",
    "heat_skin",
)


@dataclass(frozen=True, kw_only=True, repr=False)
class LIRBearing(Specification):
    """A Lateral Impact Resilient Double Concave Friction Pendulum bearing.

    Parameters
    ----------
    radius : float or (float, float)
        Radius of the concave surfaces, bottom and top [m].
    slider_height : float
        Height of the whole inner slider on its axis, h [m].
    slider_radius : float
        Radius of the inner slider in plan [m].
    friction : FrictionLaw or float, or a pair of them
        Low friction of the surfaces, bottom and top: CoulombFriction, VelocityFriction,
        MeasuredFriction, or a law of your own; a number is CoulombFriction(number) [-].
    interface_friction : float
        Friction coefficient mu_h of the plane interface [-]; ``math.inf`` fuses the two sliders
        (a plain DCFP).
    capacity : float, optional
        Lateral displacement at the first rim contact, plates parallel [m]; ``math.inf`` for a
        bearing without rims. Both rims are then reached together.
    rims : float or (float, float), optional
        Sliding displacement at contact with each rim, bottom and top [m]; instead of `capacity` if
        they differ.
    axial_stiffness, axial_damping : float, optional
        Stiffness [N/m] and damping [N s/m] of the contact along the slider axis. Default: a slider
        with liners of 20 GPa in all, and 5 % of critical damping under the design load.
    rim_stiffness, rim_damping : float, optional
        Radial stiffness [N/m] and damping [N s/m] of a rim. Default: a tenth of the axial
        stiffness, and 10 % of critical damping.
    rim_yield_force : float
        Radial force at which a rim yields [N], from tests or `ring_strength`; default: it never
        yields. Beyond it the rim force rises only by hardening; the plastic deformation remains at
        the point of contact.
    rim_hardening : float
        Stiffness of a rim that yields over its elastic stiffness [-], above 0 and below 1.
    rim_overrun : float, optional
        Deformation of a rim, plastic deformation included, beyond which it counts as failed [m]:
        the bearing fails. Default: a tenth of the slider's radius.
    flange : float, optional
        Sliding length over the plate beyond a failed rim, on the same sphere [m]; the bearing fails
        at its end. Default: none, it fails with the rim.
    slip_capacity : float, optional
        Interface slip beyond which the sliders' overlap no longer carries [m]: the bearing fails.
        Default: the slider's radius (39 % of the area still overlaps).
    uplift_capacity : float
        Opening of the contact at which slider and plates separate and the bearing fails [m], for
        example the height of the rims. Default: none.
    backup : BackupSupport, optional
        Support that carries the load after the bearing's failure, so that the analysis continues.
        Default: the analysis ends at the failure.
    design_load : float, optional
        Axial load the defaults refer to [N]. Default: 30 MPa on the slider's area.
    yield_displacement, interface_yield_displacement : float
        Elastic sliding before slip, on a concave surface and in the interface [m].
    interface_hold : float
        Resistance of the interface to slip besides friction, independent of the axial force [N],
        for example of a seal or ring that slides with it. It holds the halves of an unloaded
        slider. Default: none.
    friction_law : {"elastic-plastic", "bouc-wen"}
        Regularisation of friction. Bouc-Wen models ratchet under small vibration about a biased
        force, the more the larger the yield displacement (docs/theory.md); it is there for
        comparison.
    bouc_wen_exponent : float
        Exponent of that law [-], at least 1.
    torsional_friction : bool
        True if the contacts resist rotation about the vertical axis.
    plate_thickness : float or (float, float)
        Distance from each node to the vertex of its concave surface [m].
    slider_density : float
        Density of the sliders [kg/m3], for mass and inertia at levels "contact" and "rigid_body".
    slider_mass : float or (float, float), optional
        Mass of the bottom and the top slider [kg] instead of that from density and geometry.
    slider_inertia : ((float, float), (float, float)), optional
        Moments of inertia of both sliders about a transverse axis through the mass centre and
        about the slider's axis [kg m2].
    contact_points : int, optional
        Contact points of each slider face at the levels "contact" and "rigid_body", for comparison:
        4 to 7 on the slider's edge, an even number from 8 to 64 on two rings, 96, 128, ... on rings
        of 32. Default: a disc on an elastic bed, in closed form.
    allow_weak_interface : bool
        Accept ``mu_h <= mu_d``, with which the device does not work as intended.
    pressure_dependence : PressureDependence, optional
        Decrease of low friction with the pressure on the slider. Default: none.
    friction_heating : FrictionHeating, optional
        Heating of the plates by sliding, and decrease of low friction with their temperature.
        Default: none, and no temperature is computed.

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

    def __post_init__(self) -> None:
        for name in ("radius", "friction", "plate_thickness", "rims", "slider_mass"):
            object.__setattr__(self, name, frozen_pair(name, getattr(self, name)))
        object.__setattr__(self, "friction", as_laws(self.friction))
        inertia: object = self.slider_inertia
        if isinstance(inertia, (tuple, list, np.ndarray)):
            pairs = tuple(
                tuple(pair) if isinstance(pair, (tuple, list, np.ndarray)) else pair
                for pair in inertia
            )
            object.__setattr__(self, "slider_inertia", pairs)
        check_numbers(self, places=("bottom", "top"))
        check_bearing(self)

    def __repr__(self) -> str:
        """Return the values that were set; `resolved` has defaults, `describe` lists all."""
        plain = {f.name: f.default for f in fields(self)}
        given = [
            f"{name}={getattr(self, name)!r}"
            for name, default in plain.items()
            if getattr(self, name) != default
        ]
        return f"LIRBearing({', '.join(given)})"

    @classmethod
    def of_period(cls, period: float, *, slider_height: float, **fields: Any) -> LIRBearing:
        """Return a bearing with equal surfaces of the radius that gives a period [s].

        ``R = (L + h) / 2`` with ``L = g T^2 / (4 pi^2)``, because ``L = R1 + R2 - h``.

        Parameters
        ----------
        period : float
            Period of the pendulum T [s].
        slider_height : float
            Height of the whole inner slider on its axis, h [m].
        **fields
            The other arguments of `LIRBearing`, without `radius`.

        Returns
        -------
        LIRBearing
            The bearing of that `period`.

        Raises
        ------
        ValueError, TypeError
            If the period or a field is out of bounds.

        Examples
        --------
        >>> bearing = LIRBearing.of_period(3.0, slider_height=0.1, slider_radius=0.1, capacity=0.3,
        ...                                friction=0.05, interface_friction=0.2)
        >>> round(bearing.period, 9), round(bearing.effective_radius, 4), round(bearing.radius, 4)
        (3.0, 2.2356, 1.1678)
        """
        length = STANDARD_GRAVITY * (require_positive("period", period, "s") / (2.0 * math.pi)) ** 2
        height = require_positive("slider_height", slider_height, "m")
        return cls(radius=0.5 * (length + height), slider_height=slider_height, **fields)

    def describe(self) -> str:
        """Return a printed table of all properties, defaults and derived values included."""
        return text_table(self._rows(), left=3)

    def _repr_html_(self) -> str:
        kind = "plain DCFP" if self.is_dcfp else "LIR-DCFP"
        return html_table(f"{kind} bearing", self._rows())

    def _rows(self) -> list[tuple[str, str, str]]:
        options = self.resolved()
        rows = [
            ("effective radius", f"{self.effective_radius:.4g}", "m"),
            ("pendulum period", f"{self.period:.3g}", "s"),
            ("displacement capacity", f"{self.lateral_capacity:.4g}", "m"),
            ("characteristic strength ratio Q/W", f"{self.effective_friction:.4g}", "-"),
            ("stable limit of interface slip", f"{self.slip_stability:.4g}", "m"),
        ]
        for f in fields(self):
            value, note = getattr(self, f.name), ""
            if value is None and f.name not in options:
                continue
            if value is None:
                value, note = options[f.name], ", default"
            elif value == f.default:
                note = ", default"
            shown = f"{value:.4g}" if isinstance(value, float) else str(value)
            rows.append((f.name, shown, f"{f.metadata.get('unit', '-')}{note}"))
        return rows

    def force_limit(self, axial_load: float) -> float:
        """Return the lateral force that starts the high-friction sliding at the rim [N].

        ``W tan(theta_max + atan(mu_h))`` with ``sin(theta_max) = U_cap / L``: the interface,
        tilted by theta_max, carries W and mu_h times its normal force. With an `interface_hold`
        F_0 add ``F_0 / (cos(theta_max) - mu_h sin(theta_max))``.

        Parameters
        ----------
        axial_load : float
            Vertical load W [N].

        Returns
        -------
        float
            Lateral force [N]; infinite without rims, with the rigid slider, or if tilt and friction
            angle reach 90 degrees together.
        """
        require_positive("axial_load", axial_load, "N")
        if self.is_dcfp or math.isinf(self.lateral_capacity):
            return math.inf
        tilt = math.asin(self.lateral_capacity / self.effective_radius)
        angle = tilt + math.atan(self.interface_friction)
        if angle >= 0.5 * math.pi:
            return math.inf
        held = math.cos(tilt) - self.interface_friction * math.sin(tilt)
        return axial_load * math.tan(angle) + self.interface_hold / held

    def as_dcfp(self, *, rims: bool = True) -> LIRBearing:
        """Return the same bearing with its rigid slider, with or without its rims."""
        if rims:
            return replace(self, interface_friction=math.inf)
        return replace(self, interface_friction=math.inf, capacity=math.inf, rims=None)

    def to_record(self) -> Records:
        """Return the kernels' properties, a record array of shape (1,)."""
        return self._record.copy()

    def _backup(self, options: dict[str, float]) -> dict[str, object]:
        # Support after the bearing's failure.
        stop = self.backup
        if stop is None:
            names = ("goes_on", "backup_friction", "backup_stiffness", "backup_damping")
            return {**dict.fromkeys(names, 0.0), "backup_drop": math.inf}
        return {
            "goes_on": True,
            "backup_drop": stop.drop,
            "backup_friction": stop.friction,
            "backup_stiffness": stop.stiffness or options["axial_stiffness"],
            "backup_damping": stop.damping or options["axial_damping"],
        }

    def _factors(self, load: float) -> dict[str, object]:
        # Properties of friction that depends on pressure and temperature; zeros without.
        values: dict[str, object] = dict.fromkeys(_FACTORS, 0.0)
        area = math.pi * self.slider_radius**2
        law, heating = self.pressure_dependence, self.friction_heating
        if law is not None:
            p_0 = law.reference_pressure
            values["pressure_rate"] = law.rate / area
            values["pressure_load"] = load if p_0 is None else p_0 * area
        if heating is not None:
            scale, rate, rest = heating.law
            values |= {"softening_scale": scale, "softening_rate": rate, "softening_rest": rest}
            values |= {"softens": True, "heats": True}
            values["initial_temperature"] = heating.initial_temperature
            values["heat_rate"], values["heat_gain"], values["heat_skin"] = heating.parts()
        return values

    @cached_property
    def _record(self) -> Records:
        record = np.full(1, np.nan, dtype=[(f.name, "f8", f.shape) for f in PROPS_FIELDS])
        radii, options = self.radii, self.resolved()
        laws = [law.kernel_values() for law in self.frictions]
        thickness = as_pair("plate_thickness", self.plate_thickness)
        values: dict[str, object] = {
            "radius": radii,
            "lever": (radii[0] + thickness[0], radii[1] + thickness[1]),
            "length": self.effective_radius,
            "friction_max": [law.most for law in laws],
            "friction_drop": [law.drop for law in laws],
            "friction_rate": [law.rate for law in laws],
            "friction_table": [law.table or np.zeros(FRICTION_TABLE) for law in laws],
            "interface_friction": self.interface_friction,
            "fused": self.is_dcfp,
            "bouc_wen": self.friction_law == "bouc-wen",
            "exponent": self.bouc_wen_exponent,
            "yield_displacement": self.yield_displacement,
            "interface_yield": self.interface_yield_displacement,
            "interface_preload": self.interface_hold / self.interface_friction,
            "axial_floor": 1e-3 * options["design_load"],
            "rim_displacement": self.rim_displacement,
            "rim_yield_force": self.rim_yield_force,
            "flange": self.flange or 0.0,
            "uplift_capacity": self.uplift_capacity,
            **self._backup(options),
            "rim_hardening": options["rim_stiffness"]
            * (self.rim_hardening / (1.0 - self.rim_hardening)),
            "torsion_lever": 2.0 / 3.0 * self.slider_radius * self.torsional_friction,
            "torsion_yield": self.yield_displacement / (2.0 / 3.0 * self.slider_radius),
            "slider_radius": self.slider_radius,
            "bilateral": False,
            "fixed_load": 0.0,
        }
        values |= self._factors(options["design_load"])
        names = {f.name for f in PROPS_FIELDS}
        values |= {name: value for name, value in options.items() if name in names}
        for name, value in values.items():
            record[name] = value
        if np.isnan(record.view("f8")).any():
            missing = [name for name in record.dtype.names or () if np.isnan(record[name]).any()]
            msg = f"bearing record left incomplete: {missing}"
            raise AssertionError(msg)
        complete = np.zeros(1, dtype=PROPS)
        for name in record.dtype.names or ():
            complete[name] = record[name]
        return complete
