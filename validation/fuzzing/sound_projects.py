"""Random projects that can be run: a code, a structure, a bearing, its bounds and limits."""

from __future__ import annotations

from typing import Any

import numpy as np

Document = dict[str, dict[str, Any]]
"""Sections of a project's file."""

_LOADED = 0.4
"""Share of the moment frames of ASCE 7-22 whose floors have pressures in place of masses."""


def sound(rng: np.random.Generator) -> Document:
    """Return a project that can be run, of a random code and structure."""
    code = str(rng.choice(["ASCE 7-22", "EN 1998", "NCh2745"]))
    frame = rng.random() < 0.5
    structure: dict[str, Any] = {
        "kind": "moment frame" if frame else "shear building",
        "bays": [int(rng.integers(1, 3)), int(rng.integers(1, 3))],
        "bay_width": ["6 m", f"{rng.uniform(4.5, 7.0):.1f} m"],
        "storey_height": f"{rng.uniform(3.0, 4.0):.2f} m",
    }
    if frame:
        structure |= {
            "storeys": int(rng.integers(1, 3)),
            "floor_load": f"{rng.uniform(600.0, 1200.0):.0f} kg/m2",
            "columns": {"box": ["400 mm", "25 mm"], "material": "A992"},
            "beams": {"i_shape": ["550 mm", "220 mm", "20 mm", "12 mm"]},
            "base_beams": {"i_shape": ["800 mm", "300 mm", "30 mm", "16 mm"]},
        }
    else:
        structure |= {
            "storey_mass": ["120 t", "110 t"],
            "storey_stiffness": ["400 kN/mm", "300 kN/mm"],
        }
    counted = frame and code == "ASCE 7-22"
    loads = _loads(rng) if counted and rng.random() < _LOADED else None
    if loads is not None:
        del structure["floor_load"]
        structure |= _stiffened(rng, structure)
    if rng.random() < 0.5:
        structure["eccentricity"] = [0.05, round(float(rng.uniform(0.0, 0.1)), 3)]
    radius, height = round(float(rng.uniform(1.2, 2.4)), 2), round(float(rng.uniform(160, 240)))
    friction = round(float(rng.uniform(0.03, 0.07)), 3)
    found: Document = {
        "project": {"name": "Random", "code": code},
        "structure": structure,
        **({} if loads is None else {"loads": loads}),
        "superstructure": {"R": 5.0, "importance": 1.0},
        "spectrum": {
            "ASCE 7-22": {"s_ms": 1.0, "s_m1": 0.5},
            "EN 1998": {"a_g": "2.5 m/s2", "ground_type": "B", "kind": 1},
            "NCh2745": {"soil": "II", "zone": 2},
        }[code],
        "motions": {"folder": "motions", "scale": round(float(rng.uniform(0.5, 1.5)), 2)},
        "bearing": {
            "radius": f"{radius:g} m",
            "slider_height": f"{height} mm",
            "slider_radius": "150 mm",
            "capacity": f"{rng.uniform(180.0, 260.0):.0f} mm",
            "friction": friction,
            "interface_friction": round(2.0 * friction + 0.04, 3),
        },
        "bounds": {"friction": [0.8, 1.25], "interface": [0.9, 1.1]},
        "limits": {"rim_strength": "3 MN", "interface_pressure": "80 MPa"},
        "analysis": {
            "level": "pendulum",
            "histories": "all",
            "uplift_allowed": True,
            "accidental_eccentricity": "none",  # half of the runs; tests/golden moves masses
            "bounds": ["lower", "upper"],
        },
    }
    if rng.random() < 0.3:
        found["bearing"]["friction"] = {"f_max": friction, "f_min": 0.02, "rate": "80 s/m"}
    return found


def _loads(rng: np.random.Generator) -> dict[str, Any]:
    # Pressures of floors in place of their mass: dead load alone, of which the recomputation knows
    # the combinations.
    found: dict[str, Any] = {"dead": f"{rng.uniform(6.0, 11.0):.2f} kN/m2"}
    if rng.random() < 0.5:
        found["facade"] = f"{rng.uniform(1.0, 8.0):.1f} kN/m"
    if rng.random() < 0.3:
        found["span"] = str(rng.choice(["x", "y"]))
    return found


def _stiffened(rng: np.random.Generator, structure: dict[str, Any]) -> dict[str, Any]:
    # A wall at one side, or braces at the other.
    n = structure["bays"][0]
    if rng.random() < 0.3:
        wall = {"between": ["0-0", "0-1"], "thickness": "200 mm", "material": "C30/37"}
        return {"walls": [wall]}
    if rng.random() < 0.3:
        rods = {"between": [f"{n}-0", f"{n}-1"], "circle": ["150 mm", "8 mm"], "material": "S355"}
        return {"braces": [rods]}
    return {}
