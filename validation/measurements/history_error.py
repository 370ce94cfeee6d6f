"""Errors of displacement histories over the tolerance that was stated: prints a table.

    LIR_RECORDS=<folder of records> python -m validation.measurements.history_error

The reference of every test case is a step of 0.1 ms; errors are the largest difference at any time and
bearing over the largest displacement.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from frames import GroundMotion, lumped_mass, moment_frame, time_history
from validation.measurements.performance import near_fault
from validation.scenes import EXAMPLE_RECORD, example_bearing, records

if TYPE_CHECKING:
    from lir_element.layout import Floats

TOLERANCES = (1e-3, 5e-4, 2e-4, 1e-4, 5e-5)
FINE = 1e-4
COMPARED = 0.02  # s between the instants that are compared
MASS = 204e3


def scenes() -> dict[str, tuple[Any, GroundMotion]]:
    """Return models and motions by name; those of records where there are any."""
    device = example_bearing()
    below = example_bearing(slider_radius=0.12)
    mass = lumped_mass(device, MASS)
    building = moment_frame(bays=(2, 2), storeys=3, bearing=below)
    plain = moment_frame(bays=(2, 2), storeys=3, bearing=below.as_dcfp())
    found: dict[str, tuple[Any, GroundMotion]] = {
        f"mass, synthetic motion × {scale:g}": (mass, near_fault(scale))
        for scale in (0.5, 0.8, 1.0)
    }
    found["plain mass, synthetic motion × 0.5"] = (
        lumped_mass(device.as_dcfp(), MASS),
        near_fault(0.5),
    )
    for scale in (0.5, 0.9):
        found[f"building, synthetic motion × {scale:g}"] = (building, near_fault(scale))
    for scale in (0.7, 0.85):
        found[f"building on plain DCFP, synthetic motion × {scale:g}"] = (plain, near_fault(scale))
    folder = records()
    if folder:
        newhall = GroundMotion.from_at2(x=folder / EXAMPLE_RECORD)
        found["mass, Newhall"] = (mass, newhall)
        found["building, Newhall"] = (building, newhall)
    return found


def history(data: Any) -> Floats:
    """Return horizontal displacements of the bearings at the compared instants."""
    every = round(COMPARED / float(data["time"][1]))
    moves: Floats = data["bearing_displacement"].to_numpy()[::every, :, :2]
    return moves


def errors(model: Any, motion: GroundMotion) -> tuple[bool, list[float], list[int]]:
    """Return whether a rim is met, errors over tolerances, and steps."""
    fine = time_history(model, motion, dt=FINE, record_every=round(0.005 / FINE))
    expected = history(fine)
    largest = np.linalg.norm(expected, axis=-1).max()
    found, steps = [], []
    for tolerance in TOLERANCES:
        data = time_history(model, motion, tolerance=tolerance)
        gap = np.linalg.norm(history(data) - expected, axis=-1).max() / largest
        found.append(float(gap / tolerance))
        steps.append(int(data.attrs["steps"]))
    return float(fine["rim_force"].max()) > 0.0, found, steps


def main() -> None:
    """Run all test cases and print their rows."""
    print("| test case | rims met | " + " | ".join(f"{t:.0e}" for t in TOLERANCES) + " | steps |")
    print("|---" * (len(TOLERANCES) + 3) + "|")
    for name, (model, motion) in scenes().items():
        met, found, steps = errors(model, motion)
        cells = " | ".join(f"{ratio:.2f}" for ratio in found)
        print(f"| {name} | {'yes' if met else 'no'} | {cells} | {steps} |", flush=True)


if __name__ == "__main__":
    main()
