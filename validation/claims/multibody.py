"""Claim: the reference, level 'rigid_body', agrees with a model in a multibody program.

    LIR_RECORDS=<folder of records> python -m validation.claims.multibody

Source: the paper's numerical example (COMPDYN 2023, section 3.1), modelled in Exudyn from its own
bodies, contacts and friction (`validation/multibody.py`).
"""

from __future__ import annotations

from importlib.metadata import version
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames import GroundMotion, lumped_mass, time_history
from frames.plots import plot_style as ps
from validation.multibody import (
    GRAVITY,
    History,
    Options,
    building_frame,
    building_history,
    multibody_history,
)
from validation.page import Check, Claim, Page, render, run, stated
from validation.scenes import EXAMPLE_MASS, EXAMPLE_RECORD, example_bearing, tcu065

if TYPE_CHECKING:
    from pathlib import Path

    import xarray as xr
    from matplotlib.figure import Figure

    from frames._types import FloatArray

CLAIM = Claim(
    "multibody",
    "The reference beside a multibody program",
    "Level 'rigid_body' agrees with an independent model of bodies and contacts in Exudyn, and the element inside Exudyn with `time_history`",
    "numerical example of the paper (3.1), in Exudyn",
    EXAMPLE_RECORD,
    "exudyn",
)
BUILDING_DURATION = 6.0  # s
DURATION = 8.0  # s, the peak lies at 4.3 s
NEARLY_RIGID = 1e-5  # m: elastic sliding of friction that is as good as none
ELASTIC = (2.5e-4, 1e-4, 3e-5, NEARLY_RIGID)
VARIANTS = {
    "the same": Options(),
    "zone of friction twice as wide, half the step": Options(zone=2e-3, step=1e-4),
    "24 points a face": Options(rings=3),
}
FINE = Options(zone=5e-4, step=1e-4)
STEADY = 5  # samples of 1 ms
WEIGHT = EXAMPLE_MASS * GRAVITY
CHI_CHI = (0.9, 20.0, 12.0)
"""Of TCU065: a factor on its east component, begin and length of the part [s]."""


class Measures(NamedTuple):
    """What is compared of a run."""

    peak: float
    """Displacement [mm]."""
    when: float
    """Of the peak [s]."""
    first: float
    """First contact of a rim [s]."""
    before: float
    """Largest slip before it [mm]."""
    slip: float
    """At the end [mm]."""
    force: float
    """Largest over the weight [-], of medians over some samples."""
    heavy: float
    """Largest axial force over the weight [-]."""
    light: float
    """Smallest."""
    work: float
    """Of the lateral force on the displacement [kJ]."""


def steady(force: FloatArray, samples: int) -> FloatArray:
    """Return medians over a few samples, which leave single ones out."""
    return np.median(np.lib.stride_tricks.sliding_window_view(force, samples), axis=1)


def measures(h: History, samples: int = STEADY) -> Measures:
    """Return what is compared."""
    at, start = int(np.argmax(np.abs(h.displacement))), int(np.argmax(h.rim > 0.0))
    return Measures(
        1e3 * abs(h.displacement[at]),
        h.time[at],
        h.time[start],
        1e3 * np.abs(h.slip[: max(start, 1)]).max(),
        1e3 * abs(h.slip[-1]),
        np.abs(steady(h.force, samples)).max() / WEIGHT,
        h.axial.max() / WEIGHT,
        h.axial.min() / WEIGHT,
        1e-3 * float(np.trapezoid(h.force, h.displacement)),
    )


def reference(motion: GroundMotion, elastic: float, duration: float = DURATION) -> History:
    """Run the level 'rigid_body', whose friction slides elastically by that much [m] before slip."""
    model = lumped_mass(example_bearing(yield_displacement=elastic), EXAMPLE_MASS)
    data = time_history(model, motion, level="rigid_body", dt=1e-3, duration=duration)
    vertical = -data["bearing_force"].sel(axis="z").mean("bearing").to_numpy()
    return history_of(data)._replace(axial=vertical)  # `axial_force` is along the slider's axis


def history_of(data: xr.Dataset) -> History:
    """Return what is compared of the first bearing of a result."""
    along = data.isel(bearing=0).sel(axis="x")
    return History(
        data["time"].to_numpy(),
        along["bearing_displacement"].to_numpy(),
        along["interface_slip"].to_numpy(),
        data["bearing_force"].sel(axis="x").mean("bearing").to_numpy(),
        along["axial_force"].to_numpy(),
        along["rim_force"].max("surface").to_numpy(),
    )


class Touch(NamedTuple):
    """A slider that arrives at a rim for the first time."""

    speed: float
    """Half of that of the plate [m/s]."""
    force: float
    """Of the rim's damper at this speed, over the weight [-]."""
    mass: float
    """Of one half of the slider [kg]."""
    time: float
    """In which the damper stops it [s]."""


def first_touch(h: History) -> Touch:
    """Return the first touch of a rim."""
    bearing, at = example_bearing(), int(np.argmax(h.rim > 0.0))
    speed = 0.5 * abs(np.gradient(h.displacement, h.time)[at - 1])
    damping = float(bearing.resolved()["rim_damping"])
    volume = np.pi * bearing.slider_radius**2 * 0.5 * bearing.slider_height
    mass = bearing.slider_density * volume
    return Touch(speed, damping * speed / WEIGHT, mass, mass / damping)


def apart(first: History, second: History, name: str) -> float:
    """Return the largest distance of two histories over the peak of the first [-]."""
    one, two = getattr(first, name), getattr(second, name)
    distance = np.abs(one - np.interp(first.time, second.time, two))
    return float(distance.max() / np.abs(one).max())


def alike(record: str, multibody: History, near: History) -> list[Check]:
    """Compare both programs under a record, friction of this one as good as rigid."""
    found, want = measures(multibody), measures(near)
    elastic = f"rigid_body, elastic sliding {1e3 * NEARLY_RIGID:g} mm"
    return stated(f"""
        {record}: peak displacement | {elastic} | {want.peak} mm ± 1 % | {found.peak}
        {record}: time of the peak | {elastic} | {want.when} s ± 0.1 % | {found.when}
        {record}: first contact of a rim | {elastic} | {want.first} s ± 0.1 % | {found.first}
        {record}: slip at the end | {elastic} | {want.slip} mm ± 2 % | {found.slip}
        {record}: largest lateral force over the weight | {elastic} | {want.force} ± 1 % | {found.force}
        {record}: largest axial force over the weight | {elastic} | {want.heavy} ± 1 % | {found.heavy}
        {record}: smallest axial force over the weight | {elastic} | {want.light} ± 1 % | {found.light}
        {record}: work of the lateral force | {elastic} | {want.work} kJ ± 1 % | {found.work}
        {record}: largest distance of both displacements over the peak | {elastic} | < 0.01 | {apart(multibody, near, "displacement")}
        """)


def checks(multibody: History, near: History, default: History) -> list[Check]:
    """Compare the runs under Newhall."""
    found, usual = measures(multibody), measures(default)
    return alike("Newhall", multibody, near) + stated(f"""
        Newhall: slip before rim contact | paper, Fig. 6(a): none | < 0.3 mm | {found.before}
        Newhall: peak displacement, default elastic sliding | rigid_body as it is | {usual.peak} mm ± 3 % | {found.peak}
        """)


def chi_chi(folder: Path) -> tuple[list[Check], dict[str, Measures], float]:
    """Run both programs under a part of TCU065; nothing if the folder has no such record.

    The last number is the peak of Exudyn at half the step and half the zone of friction [mm].
    """
    record = tcu065(folder)
    if record is None:
        return [], {}, 0.0
    factor, begin, duration = CHI_CHI
    part = record.trimmed(begin, begin + duration - record.dt)
    motion = GroundMotion(x=factor * part.components[:, 0], dt=part.dt)
    found = multibody_history(example_bearing(), EXAMPLE_MASS, motion, duration)
    fine = multibody_history(example_bearing(), EXAMPLE_MASS, motion, 0.75 * duration, FINE)
    elastic = (ELASTIC[0], NEARLY_RIGID, 0.1 * NEARLY_RIGID)
    ours = {e: reference(motion, e, duration) for e in elastic}
    rows = {f"Exudyn {version('exudyn')}": found}
    rows |= {f"rigid_body, elastic sliding {1e3 * e:g} mm": h for e, h in ours.items()}
    checked = alike("TCU065", found, ours[NEARLY_RIGID])
    return checked, {name: measures(h) for name, h in rows.items()}, measures(fine).peak


def buildings(motion: GroundMotion) -> tuple[list[Check], dict[str, Measures]]:
    """Run a rigid building on four bearings in both programs and compare them."""
    inside = building_history(example_bearing(), 4.0 * EXAMPLE_MASS, motion, BUILDING_DURATION)
    model = building_frame(example_bearing(), 4.0 * EXAMPLE_MASS)
    data = time_history(model, motion, level="pendulum", duration=BUILDING_DURATION)
    found, want = measures(inside, 1), measures(history_of(data), 1)
    by = "building, level pendulum, `time_history`"
    of = "element in Exudyn"
    compared = stated(f"""
        {of}: peak displacement | {by} | {want.peak} mm ± 1 % | {found.peak}
        {of}: slip at the end | {by} | {want.slip} mm ± 1 % | {found.slip}
        {of}: largest base shear over the weight | {by} | {want.force} ± 1 % | {found.force}
        {of}: largest axial force over the weight | {by} | {want.heavy} ± 1 % | {found.heavy}
        {of}: smallest axial force over the weight | {by} | {want.light} ± 1 % | {found.light}
        """)
    return compared, {"Exudyn with the element": found, "`time_history`": want}


def drawing(runs: dict[str, History]) -> Figure:
    """Draw displacement, slip, force and loops of the runs."""
    drawn = ps.new_figure(5.0)
    grid = ps.grid_of(drawn, 2, 2)
    for k, (name, h) in enumerate(runs.items()):
        look = ps.line_of(k)
        grid[0][0].plot(h.time, 1e3 * h.displacement, label=name, **look)
        grid[0][1].plot(h.time, 1e3 * h.slip, **look)
        grid[1][0].plot(h.time, h.force / WEIGHT, **look)
        grid[1][1].plot(1e3 * h.displacement, h.force / WEIGHT, **look)
    labels = (("displacement [mm]", "slip of the halves [mm]"), ("force / weight [-]",) * 2)
    for row, texts in zip(grid, labels, strict=True):
        for panel, text in zip(row, texts, strict=True):
            ps.caption(panel, x="time [s]", y=text)
    ps.caption(grid[1][1], x="displacement [mm]")
    for panel in (grid[0][0], grid[0][1], grid[1][0]):
        panel.set_xlim(2.0, DURATION)
    ps.add_legend(drawn, grid[0][0].get_lines(), columns=1, title="Newhall 360")
    return drawn


def page(folder: Path | None) -> Page:
    """Run both programs and return the page."""
    if folder is None:
        message = f"{CLAIM.name} needs the record {CLAIM.record}"
        raise ValueError(message)
    motion = GroundMotion.from_at2(x=folder / EXAMPLE_RECORD)
    bodies = {
        name: multibody_history(example_bearing(), EXAMPLE_MASS, motion, DURATION, options)
        for name, options in VARIANTS.items()
    }
    levels = {elastic: reference(motion, elastic) for elastic in ELASTIC}
    first, near, default = bodies["the same"], levels[NEARLY_RIGID], levels[ELASTIC[0]]
    found, want, usual = measures(first), measures(near), measures(default)
    rows = {f"Exudyn {version('exudyn')}": found}
    rows |= {f"Exudyn, {name}": measures(h) for name, h in list(bodies.items())[1:]}
    rows |= {
        f"rigid_body, elastic sliding {1e3 * elastic:g} mm": measures(h)
        for elastic, h in levels.items()
    }
    tcu_checks, tcu, fine = chi_chi(folder)
    more, both = buildings(motion)
    spike = max(np.abs(h.force).max() / WEIGHT for h in bodies.values())
    return Page(
        CLAIM,
        f"peak {found.peak:.1f} mm beside {want.peak:.1f} mm ({usual.peak:.1f} mm with the default elastic sliding), "
        f"slip at the end {found.slip:.1f} mm beside {want.slip:.1f} mm",
        checks(first, near, default) + tcu_checks + more,
        render(
            globals(),
            rows=rows,
            both=both,
            tcu=tcu,
            fine=fine,
            touch=first_touch(first),
            spike=spike,
            options=Options(),
            usual=usual,
            found=found,
            want=want,
        ),
        {
            "histories": drawing(
                {
                    "Exudyn": first,
                    f"rigid_body, elastic sliding {1e3 * NEARLY_RIGID:g} mm": near,
                    "rigid_body, default elastic sliding 0.25 mm": default,
                }
            )
        },
    )


if __name__ == "__main__":
    run(CLAIM, page)
