"""What is compared between two runs of one test case: peaks, energy, slip and what remains."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import xarray as xr

    from lir_element.layout import Floats

QUANTILE = 0.999
LEAST_SLIP = 1e-3
"""Largest slip over the peak displacement, below which it is the elastic sliding of an interface
that holds."""
DISSIPATED = ("low_friction_bottom", "low_friction_top", "high_friction")


@dataclass(frozen=True)
class Response:
    """The histories of a run that are compared; (n,) times, (n, ...) values."""

    time: Floats
    displacement: Floats
    """Horizontal displacement of each bearing (n, bearings, 2) [m]."""
    force: Floats
    """Horizontal force on the ground (n, 2) [N]."""
    slip: Floats
    """Interface slip of each bearing (n, bearings, 3) [m]."""
    axial: Floats
    """Axial force of each bearing over its static value (n, bearings) [-]."""
    dissipated: Floats
    """Energy that all friction has dissipated (n,) [J]."""
    seconds: float
    status: str = "ok"


@dataclass(frozen=True)
class Errors:
    """Errors of a run [%]: of peaks, energy and slip relative to themselves."""

    peak: float
    """Largest displacement of a bearing."""
    force: float
    """Largest force, at the output times of the coarser run."""
    quantile: float
    """99.9 % quantile of the force, there."""
    energy: float
    """Energy dissipated by friction, at the end."""
    slip: float
    """Largest slip of an interface; NaN where the reference has next to none."""
    left: float
    """Largest difference of the slip at the end, over the largest slip; NaN likewise."""
    residual: float
    """Largest difference of the displacement at the end, over the peak displacement."""


NAMES = tuple(field.name for field in fields(Errors))


def response(data: xr.Dataset, *, seconds: float | None = None) -> Response:
    """Take from a time history or a cyclic test what is compared."""
    plane = ["x", "y"]
    axial = data["axial_force"].to_numpy()
    if "energy" in data:
        energy = data["energy"].sel(term=list(DISSIPATED)).sum("term").to_numpy()
        force = data["base_shear"].sel(axis=plane).to_numpy()
        static = data["static_axial_force"].to_numpy()
    else:
        energy = data["work_low_friction"].sum(["bearing", "surface"]).to_numpy()
        energy = energy + data["work_high_friction"].sum("bearing").to_numpy()
        force = data["bearing_force"].sel(axis=plane).to_numpy()[:, 0]
        static = axial[0]
    return Response(
        time=data["time"].to_numpy(),
        displacement=data["bearing_displacement"].sel(axis=plane).to_numpy(),
        force=force,
        slip=data["interface_slip"].to_numpy(),
        axial=axial / static,
        dissipated=energy,
        seconds=data.attrs["seconds_loop"] if seconds is None else seconds,
        status=data.attrs["status"],
    )


def peak_displacement(run: Response) -> float:
    """Return the largest horizontal displacement of a bearing [m]."""
    return float(np.linalg.norm(run.displacement, axis=-1).max())


def largest_slip(run: Response) -> float:
    """Return the largest slip of an interface [m]."""
    return float(np.linalg.norm(run.slip, axis=-1).max())


def common(run: Response, reference: Response) -> tuple[Floats, Floats]:
    """Return the sizes of both forces at the times that both runs recorded."""
    coarse, fine = (run, reference) if len(run.time) <= len(reference.time) else (reference, run)
    place = np.clip(np.searchsorted(fine.time, coarse.time - 1e-9), 0, len(fine.time) - 1)
    met = np.abs(fine.time[place] - coarse.time) < 1e-6
    sizes = (
        np.linalg.norm(coarse.force[met], axis=-1),
        np.linalg.norm(fine.force[place[met]], axis=-1),
    )
    return sizes if coarse is run else (sizes[1], sizes[0])


def errors(run: Response, reference: Response) -> Errors:
    """Compare a run with the reference; NaN where it did not complete."""
    if run.status != "ok":
        return Errors(*[float("nan")] * len(NAMES))
    peak = peak_displacement(reference)
    ours, theirs = common(run, reference)
    largest = largest_slip(reference)
    slipped = largest > LEAST_SLIP * peak
    kept = np.linalg.norm(run.slip[-1] - reference.slip[-1], axis=-1).max()
    left = np.linalg.norm(run.displacement[-1] - reference.displacement[-1], axis=-1).max()
    return Errors(
        peak=_percent(peak_displacement(run), peak),
        force=_percent(ours.max(), theirs.max()),
        quantile=_percent(np.quantile(ours, QUANTILE), np.quantile(theirs, QUANTILE)),
        energy=_percent(run.dissipated[-1], reference.dissipated[-1]),
        slip=_percent(largest_slip(run), largest) if slipped else math.nan,
        left=100.0 * float(kept) / largest if slipped else math.nan,
        residual=100.0 * float(left) / peak,
    )


def _percent(value: float, reference: float) -> float:
    return 100.0 * abs(float(value) / float(reference) - 1.0)
