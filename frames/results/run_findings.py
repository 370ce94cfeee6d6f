"""What the assumption check finds on a run: equilibrium, violent nodes, steps, yielding."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from frames.results.findings import Finding, finding, remark
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

TURNED = 0.05
"""Plastic rotation from which on a hinge is doubtful [rad]: compact members of steel begin to lose
strength at 4 to 11 yield rotations (ASCE/SEI 41-17, chapter 9), others before."""


def equilibrium(data: xr.Dataset) -> tuple[Finding, ...]:
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
    return (remark("equilibrium", most, text, doubtful=doubtful), *_violence(data))


def _violence(data: xr.Dataset) -> tuple[Finding, ...]:
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
    return (remark("accelerations", most, text, doubtful=True),)


def time_step(data: xr.Dataset) -> tuple[Finding, ...]:
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
    return (remark("time_step", error, text, doubtful=doubtful),)


def yielding(data: xr.Dataset) -> tuple[Finding, ...]:
    """Judge how far hinges turned."""
    # They keep their strength here; those of steel lose it from about TURNED on.
    if "hinge" not in data.dims:
        return ()
    turned = largest(data, "hinge_rotation")
    k = int(np.argmax(turned.values))
    most = float(turned.values[k])
    text = f"plastic rotation of hinges up to {1e3 * most:.3g} mrad"
    if most > TURNED:
        text = (
            f"plastic rotation of hinge {data['hinge'].to_numpy()[k]}: {1e3 * most:.3g} mrad at "
            f"t = {float(turned.at[k]):.4g} s: members lose strength from about {1e3 * TURNED:.0f} "
            "mrad on, which is not modelled; take it as the beginning of a failure"
        )
    return (finding("yielding", False, most > 0.0, most, text, doubtful=most > TURNED),)


def strained(data: xr.Dataset) -> tuple[Finding, ...]:
    """Judge whether imported members, which stay elastic, would have yielded."""
    most = float(data.attrs.get("strain_over_limit", 0.0))
    if most <= 1.0:
        return ()
    count = int(data.attrs["strain_over_limit_count"])
    text = (
        f"{data.attrs['strain_over_limit_in']} strains {most:.3g} times as far as its material "
        f"keeps its stiffness, at t = {float(data.attrs['strain_over_limit_at']):.4g} s ({count} "
        "imported members are beyond that): here they stay elastic, in OpenSees they yield, and "
        "displacements differ; put the bearings under the model there by isolate, and compare"
    )
    return (finding("yielding", False, True, most, text, doubtful=True),)
