"""Variables of what only some bearings have: temperatures, rims that yield, backups."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from lir_element.results.dataset import SURFACES, labelled, rims_give_way

if TYPE_CHECKING:
    from lir_element.layout import Records

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
