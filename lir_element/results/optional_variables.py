"""Variables of some bearings only: temperatures, rims that yield, backups."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from lir_element.device.sliders import interface_height
from lir_element.formulas import eccentricity, resultant_offset
from lir_element.results.dataset import SURFACES, labelled, rims_give_way

if TYPE_CHECKING:
    from lir_element.layout import Floats, Records

CONTACTS = (*SURFACES, "interface")


def optional_variables(step: str, states: Records, props: Records) -> dict[str, xr.Variable]:
    """Return temperatures, deformations of rims that yield, failures; nothing of bearings without.

    Shapes: states, props (n_steps, n_bearings).
    """
    found: dict[str, xr.Variable] = {}
    if props["heats"].any():
        values = np.where(props["heats"][:, None] == 1, states["temperature"], np.nan)
        found["contact"] = xr.Variable(("contact",), list(CONTACTS))
        found["temperature"] = labelled(
            (step, "bearing", "contact"),
            values,
            "degC",
            "temperature of what each contact slides on, at its middle",
        )
    if rims_give_way(props):
        surface = (step, "bearing", "surface")
        elastic = states["rim_closure"]
        found["rim_closure"] = labelled(
            surface,
            np.where(elastic > 0.0, elastic + states["rim_bent"], 0.0),
            "m",
            "deformation of each rim, plastic part included",
        )
        found["rim_plastic"] = labelled(
            surface,
            states["rim_plastic"],
            "m",
            "largest plastic deformation of each rim so far; infinite once it is broken",
        )
    if props["goes_on"].any():
        found["bearing_failed"] = labelled(
            (step, "bearing"),
            (states["failed"] > 0).astype(np.float64),
            "1",
            "1 once the bearing has failed: forces are those of its backup, if it has a stop",
        )
    return found


def interface_eccentricity(props: Records, states: Records) -> Floats:
    """Return the distance of the interface's resultant from the sliders' axes [m].

    Moment equilibrium of the bottom slider about the centre of its sphere: the normal force of the
    plate passes through that centre, friction and rim act at the vertex, the interface at the
    height h_b above it (`interface_height`; docs/theory.md, section 10)::

        e_b = ((R_1 - h_b) F_h - R_1 F_1 + R_1 P_1) / N,      e_t = e_b - s.

    If sliders are bodies with discs as faces, it is the centre of pressure between them.

    Shapes: props (n_bearings,), states (n_steps, n_bearings), result (n_steps, n_bearings).
    """
    slider_height = props["radius"].sum(axis=1) - props["length"]
    vectors = (
        states["axis"],
        states["rim_force"][..., :1],
        states["interface_force"],
        states["friction_force"][..., 0, :],
        states["slip"],
    )
    by_forces: Floats = eccentricity(
        states["axial_force"],
        props["axial_floor"],
        props["radius"][:, 0],
        interface_height(props["radius"], props["slider_radius"], slider_height),
        *(vector[..., k] for vector in vectors for k in range(vector.shape[-1])),
    )
    larger: Floats = resultant_offset(by_forces, states["offset"])
    return larger
