"""Claim: the bearing answers in OpenSees as it does in `frames`.

    LIR_RECORDS=<folder of records> python -m validation.claims.opensees_element

Source: OpenSeesPy. A steel frame on LIR-DCFP bearings under a recorded motion that drives sliders
into their rims, once analysed by `frames`, once by OpenSees with `bearing_element`, by both couplings.
Structure and damping are the same in both (see `opensees_building`).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from frames import Frame, GroundMotion, time_history
from frames.plots.plot_style import PALETTE, caption, grid_of, new_figure, style
from lir_element.opensees import bearing_element, record_bearings
from validation.claims.opensees_building import LOAD, RATIO, steel_frame, stiffness_damping
from validation.opensees.frames import frame_history
from validation.page import Check, Claim, Page, render, run, stated
from validation.scenes import EXAMPLE_RECORD, example_bearing

if TYPE_CHECKING:
    from pathlib import Path

    import xarray as xr
    from matplotlib.figure import Figure

    from frames._types import FloatArray
    from lir_element import LIRBearing
    from lir_element.device.features import Level

CLAIM = Claim(
    "opensees_element",
    "The same building in OpenSees and in frames",
    "A building on LIR-DCFP bearings answers in OpenSees, by either coupling, as it does in `frames`: "
    "peaks within 0.5 % where the step follows the rim impacts",
    "OpenSeesPy",
    EXAMPLE_RECORD,
)
GOAL = 0.005
GOAL_COARSE = 0.01  # where slip turns round within long steps, work is owed (docs/theory.md, 5)
SCALE, ANGLE = 1.1, math.radians(30.0)  # of the motion, and its direction in plan
DURATION = 8.0  # s
GRAVITY_STEPS = 10
ROOF = "floor-2-0-0"


RUNS: tuple[tuple[Level, float, tuple[str, ...]], ...] = (
    ("pendulum", 0.001, ("fast", "portable")),
    ("contact", 0.0005, ("fast",)),
    ("pendulum", 0.005, ("fast",)),
)
"""Level, step and routes that are compared with `frames` at the same level and step."""
COUPLINGS = {"fast": "in-process", "portable": "out-of-process"}
COARSE = 0.005  # s: a step that does not follow a rim impact
STEADY = ("displacement", "slip", "work")
"""What does not depend on how the step meets an impact."""


def building() -> Frame:
    """Return the building: one bay by one, two storeys, a bearing under each column."""
    return steel_frame(example_bearing(design_load=LOAD, slider_radius=0.1))


def in_opensees(
    frame: Frame, motion: GroundMotion, level: Level, dt: float, route: str
) -> tuple[xr.Dataset, FloatArray]:
    """Run the building in OpenSees; return the bearings' Dataset and the roof's displacements.

    Shapes: result (n, 3).
    """
    recordings: list[Any] = []

    def place(tag: int, i: int, j: int, bearing: LIRBearing) -> None:
        bearing_element(tag, i, j, bearing, level=level, route=route)  # type: ignore[arg-type]
        recordings[:] = [record_bearings()]

    track = frame_history(
        frame,
        place,
        motion,
        dt,
        [ROOF],
        duration=DURATION,
        stiffness_damping=stiffness_damping(frame),
    )
    data = recordings[0].dataset().isel(time=slice(GRAVITY_STEPS, None))
    return data, track.displacement[1:, 0]


def peaks(data: xr.Dataset, roof: FloatArray) -> dict[str, float]:
    """Read the peaks off a run."""
    moved = data["bearing_displacement"].to_numpy()[:, :, :2]
    drift = roof[-len(moved) :, :2] - moved[:, 0]
    return {
        "bearing displacement [mm]": 1e3 * _largest(moved),
        "roof against base [mm]": 1e3 * _largest(drift),
        "base shear [kN]": 1e-3 * _largest(data["bearing_force"].sum("bearing").to_numpy()[:, :2]),
        "bearing force [kN]": 1e-3 * _largest(data["bearing_force"].to_numpy()[:, :, :2]),
        "interface slip [mm]": 1e3 * float(data["interface_slip_size"].max()),
        "rim force [kN]": 1e-3 * float(data["rim_force"].max()),
        "axial force [kN]": 1e-3 * float(data["axial_force"].max()),
        "low friction's work [kJ]": 1e-3 * float(data["work_low_friction"][-1].sum()),
        "high friction's work [kJ]": 1e-3 * float(data["work_high_friction"][-1].sum()),
    }


def page(folder: Path | None) -> Page:
    """Run the building everywhere and compare."""
    assert folder is not None
    record = GroundMotion.from_at2(x=folder / EXAMPLE_RECORD)
    motion = record.scaled(SCALE).rotated(ANGLE).trimmed(0.0, DURATION)
    frame = building()
    checks: list[Check] = []
    found: dict[tuple[Level, float], dict[str, dict[str, float]]] = {}
    shown: dict[str, xr.Dataset] = {}
    for level, dt, routes in RUNS:
        data = time_history(frame, motion, duration=DURATION, dt=dt, level=level)
        shown.setdefault("frames", data)
        roof = data["node_displacement"].sel(node=ROOF).to_numpy()[:, :3]
        ours = peaks(data, roof)
        columns = found[level, dt] = {"frames": ours}
        for route in routes:
            theirs, their_roof = in_opensees(frame, motion, level, dt, route)
            shown.setdefault("OpenSees", theirs)
            other = columns[f"OpenSees, {COUPLINGS[route]}"] = peaks(theirs, their_roof)
            asked = [k for k in ours if dt < COARSE or any(word in k for word in STEADY)]
            worst = 100.0 * max(abs(other[k] / ours[k] - 1.0) for k in asked)
            what, goal = (
                ("a peak", GOAL) if dt < COARSE else ("displacement, slip, work", GOAL_COARSE)
            )
            name = f"{level}, {1e3 * dt:g} ms, {COUPLINGS[route]}"
            checks += stated(
                f"largest difference of {what} ({name}) | frames | < {100.0 * goal} % | {worst}"
            )
    slip = 1e3 * float(shown["frames"]["interface_slip_size"].max())
    worst = max(float(check.got.split()[0]) for check in checks if "a peak" in check.what)
    result = (
        f"largest difference of any peak {worst:.2g} % at steps that follow a rim impact, with "
        f"{slip:.0f} mm of slip"
    )
    body = render(globals(), RATIO=RATIO, found=found)
    return Page(CLAIM, result, checks, body, {"histories": _figure(shown)})


def _figure(shown: dict[str, xr.Dataset]) -> Figure:
    drawn = new_figure(4.4)
    panels = [row[0] for row in grid_of(drawn, 2, 1, share_x=True)]
    looks = ((PALETTE[5], 3.2), (PALETTE[1], 0.9))  # so that equal curves show both
    for (name, data), (colour, width) in zip(shown.items(), looks, strict=True):
        corner = data.isel(bearing=0).sel(axis="x")
        for panel, key in zip(panels, ("bearing_displacement", "interface_slip"), strict=True):
            values = 1e3 * corner[key].to_numpy()
            panel.plot(data["time"], values, color=colour, linewidth=width, label=name)
    caption(panels[0], y="displacement along x [mm]")
    caption(panels[1], x="time [s]", y="interface slip along x [mm]")
    for panel in panels:
        style(panel)
    panels[0].legend(frameon=False)
    return drawn


def _largest(vectors: FloatArray) -> float:
    return float(np.linalg.norm(vectors, axis=-1).max())


if __name__ == "__main__":
    run(CLAIM, page)
