"""What the check says of a run's equilibrium, of violent nodes, and of the steps it took."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames.results.formulas import VIOLENT
from frames.results.peak_response import largest
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    import xarray as xr

BALANCED = 2e-3
"""Sum of all forces over the weight, of moments over weight times half the structure's extent, up
to which a run is in equilibrium: ordinary runs keep 1e-6 of forces, and 1e-4 of moments: damping
by modes does not know what axial forces turn (docs/theory.md, 5)."""

ROUGH = 0.05
"""Estimated error of a given step over the displacement reached from which on a run says so."""

_LIGHT = 1e-2  # of the nodes' mean mass: a node that weighs next to nothing beside the others


class Remark(NamedTuple):
    """A line of the assumption check."""

    feature: str
    number: float
    sentence: str
    doubtful: bool


def equilibrium(data: xr.Dataset) -> tuple[Remark, ...]:
    """Judge whether forces, weight and inertia agree, and whether nodes moved beyond reason."""
    if "imbalance" not in data and "reached_imbalance" not in data:
        return ()
    gaps = largest(data, "imbalance")
    text, most, doubtful = "equilibrium: supports share in it, not summed up", 0.0, False
    if gaps.values.size:
        k = int(np.argmax(gaps.values))
        most, name = float(gaps.values[k]), str(data["resultant"].to_numpy()[k])
        doubtful = most > BALANCED
        over = "the weight" if name.startswith("F") else "weight times half the extent"
        text = f"equilibrium: forces and inertia agree within {most:.1g} of the weight"
        if doubtful:
            text = (
                f"equilibrium: {name} of bearing forces, weight and inertia differ by "
                f"{100.0 * most:.3g} % of {over} at t = {float(gaps.at[k]):.4g} s: forces and "
                "accelerations of one instant do not belong together; take neither for a design"
            )
    return (Remark("equilibrium", most, text, doubtful), *_violence(data))


def _violence(data: xr.Dataset) -> tuple[Remark, ...]:
    found = largest(data, "violence")
    k = int(np.argmax(found.values))
    most = float(found.values[k]) / STANDARD_GRAVITY
    if not most > 0.0:
        return ()
    mass = data["node_mass"].transpose("node", "axis").to_numpy().max(axis=1)
    own, mean = float(mass[k]), float(mass[mass > 0.0].mean())
    struck = bool(largest(data, "rims_met").values.any() or largest(data, "lifted").values.any())
    cause = "look at the stiffness of what holds its mass"
    if own < _LIGHT * mean:
        cause = (
            f"its mass of {own:.3g} kg is next to nothing beside {mean:.3g} kg at a node: give it "
            "what stands there, or none"
        )
    elif struck:
        cause = "an impact, at a rim or in landing: compare smaller steps, and softer rims"
    text = (
        f"accelerations: node {data['node'].to_numpy()[k]} reached {most:.3g} g at t = "
        f"{float(found.at[k]):.4g} s (more than {VIOLENT / STANDARD_GRAVITY:.0f} g is beyond what "
        f"structures do): {cause}"
    )
    return (Remark("accelerations", most, text, True),)


def time_step(data: xr.Dataset) -> tuple[Remark, ...]:
    """Judge the step of a run whose step was given."""
    error = float(data.attrs.get("estimated_error", np.nan))
    if data.attrs.get("step_control") != "fixed" or not np.isfinite(error):
        return ()
    doubtful = error > ROUGH
    text = f"time step: as given, estimated error {100.0 * error:.1g} % of the displacement reached"
    if doubtful:
        text = (
            f"time step: steps as given make displacements wrong by up to some "
            f"{100.0 * error:.2g} % of the largest one: leave dt out, or compare a smaller one "
            "(step_sensitivity)"
        )
    return (Remark("time_step", error, text, doubtful),)
