"""Units of the fields of a bearing and of what it is made of: one table for prints and files."""

from __future__ import annotations

FIELD_UNITS: dict[str, dict[str, str]] = {
    "LIRBearing": {
        **dict.fromkeys(
            (
                "radius",
                "slider_height",
                "slider_radius",
                "capacity",
                "rims",
                "rim_overrun",
                "flange",
                "slip_capacity",
                "uplift_capacity",
                "yield_displacement",
                "interface_yield_displacement",
                "plate_thickness",
            ),
            "m",
        ),
        "axial_stiffness": "N/m",
        "axial_damping": "N s/m",
        "rim_stiffness": "N/m",
        "rim_damping": "N s/m",
        "rim_yield_force": "N",
        "design_load": "N",
        "slider_density": "kg/m3",
        "slider_mass": "kg",
        "slider_inertia": "kg m2",
    },
    "BackupSupport": {"drop": "m", "stiffness": "N/m", "damping": "N s/m"},
    "PressureDependence": {"reference_pressure": "Pa", "rate": "1/Pa"},
    "FrictionHeating": {
        "conductivity": "W/(m K)",
        "diffusivity": "m2/s",
        "initial_temperature": "C",
        "reference_temperature": "C",
        "thickness": "m",
    },
}
"""By class and field; fields that are not here are numbers without a unit, or no numbers. Friction
laws name the units of their fields themselves (`unit_of`)."""
