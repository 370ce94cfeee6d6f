"""Claim: as a plain DCFP the element agrees with those of OpenSees; each difference has its cause.

    python -m validation.claims.opensees_pendulum

Sources: closed forms of each element's force (its documentation and public sources; for the rigid
slider docs/theory.md, section 2); OpenSeesPy itself.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.lines import Line2D

from frames import GroundMotion
from frames.plots.plot_style import PALETTE, add_legend, caption, grid_of, new_figure, style
from lir_element.opensees import BUILTIN_KINDS, builtin_values, opensees
from validation.claims import opensees_building as building
from validation.claims import opensees_loops as loops
from validation.claims.opensees_causes import (
    ELASTIC,
    FRICTION,
    LARGE,
    LIFT,
    LOAD,
    SPEED,
    TENTH,
    VERTICAL,
    YIELD,
    Row,
    Rung,
    Setting,
    apart,
    bearing_of,
    here,
    ladder,
    largest,
    percent,
    there,
)
from validation.page import Check, Claim, Page, render, run, stated, table
from validation.scenes import EXAMPLE_RECORD, tcu065

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from lir_element.opensees.compare.builtin_writing import BuiltinKind
    from validation.claims.opensees_loops import Loop
    from validation.opensees.runs import Track

CLAIM = Claim(
    "opensees_pendulum",
    "The plain DCFP and the friction pendulums of OpenSees",
    "As a plain DCFP the bearing agrees with OpenSees' own friction pendulums once their "
    "parameters are mapped; differences above 1 % vanish with their causes (of TFP, as far as its "
    "steps allow)",
    "closed forms; OpenSeesPy",
    EXAMPLE_RECORD,
)
SMALL = 0.01  # share that calls for a cause
MAPPED = 0.02  # of a peak with the parameters mapped and nothing left out
EXACT = 2e-3  # of a loop against its closed form
SHORT = 8.0  # s of the record, where steps are very small
SCALE = 0.55  # of TCU065, whose peak then stays below the capacity of the example's rims
TINY = 5e-5  # s
FINER: dict[str, int] = {"TFP": 100}
"""By how much the path is divided finer where displacements are small."""
VELOCITY: tuple[BuiltinKind, ...] = ("singleFPBearing", "FPBearingPTV")
TRIPLE: BuiltinKind = "TripleFrictionPendulum"
FINE: Rung = ("step", "both: 1.25 ms in place of 5 ms", {"dt": 1.25e-3, "their_dt": 1.25e-3})
LEVEL: Rung = (
    "force added up from increments, which a change of the axial force does not enter",
    "both: no vertical motion",
    {"level": True},
)


def explicit(dt: float) -> Rung:
    """Return the cause that TFP does not iterate, and a step with which it matters less."""
    return "increments without iteration", f"there: step {1e3 * dt:g} ms", {"their_dt": dt}


def static_part() -> tuple[list[Check], list[str], dict[str, loops.Loop]]:
    """Run the quasi-static loops; return checks, tables and loops."""
    ours = {scale: loops.here(scale) for scale in (1.0, TENTH)}
    found: dict[str, dict[float, loops.Loop]] = {
        kind: {1.0: loops.there(kind), TENTH: loops.there(kind, TENTH, finer=FINER.get(kind, 1))}
        for kind in BUILTIN_KINDS
    }
    everything = {loops.OURS: ours, **found}
    values = {name: {s: one.values() for s, one in by.items()} for name, by in everything.items()}
    checks, rows = [], []
    for name, by in values.items():
        exact = loops.closed_form(name) if name in loops.LAWS else None
        cells = [
            f"{got:.3f}" + ("" if exact is None else f" ({exact[k]:.3f})")
            for k, got in enumerate(by[1.0])
        ]
        rows.append((name, *cells))
        if exact is not None:
            error = float(np.abs(by[1.0] / exact - 1.0).max())
            what = f"loop: {name}, largest difference from its closed form"
            checks += stated(f"{what} | closed form | < {EXACT} | {error}")
    bearing = loops.plain()
    mapped = builtin_values(bearing, LOAD).friction_max / bearing.frictions[0].f_max
    printed = loops.there("singleFPBearing", factor=1.0 / mapped).values()
    target = values[loops.OURS]
    apart_rows = [
        (
            "singleFPBearing, μ as printed → mapped",
            *(
                percent(a, b)
                for a, b in zip(
                    printed / target[1.0] - 1.0,
                    values["singleFPBearing"][1.0] / target[1.0] - 1.0,
                    strict=True,
                )
            ),
        )
    ]
    for kind in BUILTIN_KINDS:
        before, after = (values[kind][s] / target[s] - 1.0 for s in (1.0, TENTH))
        apart_rows.append((f"{kind}, large displacements → a tenth", *map(percent, before, after)))
        what = f"loop: {kind} against the bearing, small displacements"
        checks += stated(f"{what} | similarity | < {SMALL} | {np.abs(after).max()}")
    head = ("element", *(f"{n} [{u}]" for n, u in zip(loops.NAMES, loops.UNITS, strict=True)))
    tables = [
        table(head, rows),
        table(("difference from the bearing [%]", *loops.NAMES), apart_rows),
    ]
    return checks, tables, {name: by[1.0] for name, by in everything.items()}


def newhall_rows(record: GroundMotion) -> list[list[Row]]:
    """Leave out the causes under Newhall, for each element."""
    differences = partial(apart, record=record)
    short = partial(apart, record=record.trimmed(0.0, SHORT))
    raw = Setting("singleFPBearing", ("friction", "rate", "yield"))
    small = [VERTICAL, LARGE, ELASTIC]
    steps = [explicit(dt) for dt in (1e-3, 2e-4, TINY)]
    return [
        ladder(raw, [FRICTION, SPEED, YIELD, *small], differences),
        ladder(Setting("FPBearingPTV"), small, differences),
        ladder(Setting(TRIPLE, speed=False), [VERTICAL, LARGE], differences),
        ladder(Setting("TFP", speed=False), [VERTICAL, LARGE, *steps], short),
    ]


def three_components(folder: Path) -> list[list[Row]]:
    """Leave out the causes under TCU065; nothing where the folder does not hold it."""
    record = tcu065(folder)
    if record is None:
        return []
    differences = partial(apart, record=record.scaled(SCALE))
    slow = Setting("TFP", speed=False, their_dt=1e-3)
    return [
        ladder(Setting("singleFPBearing"), [LARGE, ELASTIC, FINE], differences),
        ladder(Setting("FPBearingPTV"), [LARGE, ELASTIC], differences),
        ladder(Setting(TRIPLE, speed=False), [LARGE, FINE], differences),
        ladder(slow, [LEVEL, LARGE, explicit(2e-4)], differences),
    ]


def in_building(record: GroundMotion) -> list[list[Row]]:
    """Leave out the causes in the building, for each element that takes an earthquake well."""
    differences = partial(building.apart, record=record)
    kinds = (*VELOCITY, TRIPLE)
    return [ladder(building.Building(kind), building.RUNGS, differences) for kind in kinds]


def left(what: str, ladders: Sequence[Sequence[Row]]) -> list[Check]:
    """Check that what remains at the end of each ladder needs no cause."""
    rest = "largest difference with all causes left out | OpenSeesPy"
    return [
        check
        for rows in ladders
        for check in stated(
            f"{what}: {rows[-1].kind}, {rest} | < {SMALL} | {largest(rows[-1].after)}"
        )
    ]


def mapped_check(what: str, rows: Sequence[Row], name: str) -> list[Check]:
    """Check a difference with the parameters mapped and nothing left out."""
    plain = next(row for row in rows if row.cause not in {FRICTION[0], SPEED[0], YIELD[0]})
    of = f"{what}: {plain.kind} as mapped, difference of the {name}"
    return stated(f"{of} | OpenSeesPy | < {MAPPED} | {abs(plain.before[name])}")


def page(folder: Path | None) -> Page:
    """Run everything and return the page."""
    if folder is None:
        message = f"{CLAIM.name} needs the record {CLAIM.record}"
        raise ValueError(message)
    record = GroundMotion.from_at2(x=folder / EXAMPLE_RECORD)
    checks, static, drawn = static_part()
    newhall, tcu = newhall_rows(record), three_components(folder)
    frames = in_building(record)
    for k in range(3):
        checks += mapped_check("Newhall", newhall[k], "peak")
    checks += left("Newhall", newhall)
    lift = ladder(Setting("singleFPBearing"), [LIFT], partial(apart, record=record))
    checks += stated(
        "Newhall: singleFPBearing that lifts the mass, difference of the force | OpenSeesPy | "
        f"< {SMALL} | {abs(lift[0].after['force'])}"
    )
    for rows in tcu[:3]:
        checks += mapped_check("TCU065", rows, "peak")
    checks += left("TCU065", tcu[:3])
    for rows in frames:
        checks += mapped_check("building", rows, "base")
    checks += left("building", frames)
    setting = Setting("singleFPBearing")
    tracks = {loops.OURS: here(setting, record)}
    tracks |= {kind: there(Setting(kind), record) for kind in VELOCITY}
    peaks = [abs(row.before["peak"]) for row in (newhall[0][3], newhall[1][0], newhall[2][0])]
    rest = max(largest(rows[-1].after) for rows in (*newhall, *tcu[:3], *frames))
    weight = bearing_of(setting).resolved()["design_load"]
    return Page(
        CLAIM,
        f"peak under Newhall within {100.0 * max(peaks):.1f} % as mapped; with causes left out "
        f"all differences are below {100.0 * rest:.1f} %",
        checks,
        render(
            globals(),
            building=building,
            buildings=frames,
            lift=[lift],
            loops=loops,
            mapped=builtin_values(loops.plain(), loops.LOAD),
            newhall=newhall,
            np=np,
            percent=percent,
            static=static,
            tcu=tcu,
            version=opensees().version(),
        ),
        {"loops": draw_loops(drawn, loops.LOAD), "newhall": draw_newhall(tracks, weight)},
    )


SHOWN = 15.0  # s, of the histories
OURS, THEIRS = 3.2, 0.9  # pt; so that equal curves show both
COLOURS = tuple(PALETTE[k] for k in (5, 1, 0, 3, 2))  # a light one below


def draw_loops(found: Mapping[str, Loop], load: float) -> Figure:
    """Draw the loop of the bearing, the first one, under that of each element of OpenSees."""
    drawn = new_figure(4.9)
    panels = [panel for row in grid_of(drawn, 2, 2, share_x=True, share_y=True) for panel in row]
    (name, ours), *others = found.items()
    for panel, (other, loop), colour in zip(panels, others, COLOURS[1:], strict=True):
        panel.plot(1e3 * ours.path, ours.force / load, color=COLOURS[0], linewidth=OURS)
        panel.plot(1e3 * loop.path, loop.force / load, color=colour, linewidth=THEIRS)
        caption(panel, title=other)
    for panel in panels[2:]:
        caption(panel, x="displacement [mm]")
    for panel in panels[::2]:
        caption(panel, y="lateral force / load [-]")
    add_legend(drawn, _handles(name, list(found)[1:]), title="Quasi-static cycle")
    return drawn


def draw_newhall(found: Mapping[str, Track], load: float) -> Figure:
    """Draw displacement over time and loops of the bearing, the first one, and of the others."""
    drawn = new_figure(4.9)
    grid = drawn.add_gridspec(2, 2, height_ratios=(1.0, 1.3))
    history = drawn.add_subplot(grid[0, :])
    sides = [drawn.add_subplot(grid[1, k]) for k in (0, 1)]
    (name, ours), *others = found.items()
    for panel in (history, *sides):
        style(panel)
    _history(history, ours, 0)
    for k, (side, (other, track)) in enumerate(zip(sides, others, strict=True), start=1):
        _history(history, track, k)
        _loop(side, ours, load, 0)
        _loop(side, track, load, k)
        caption(side, x="displacement [mm]", y="lateral force / load [-]", title=other)
    history.set_xlim(0.0, SHOWN)
    caption(history, x="time [s]", y="displacement [mm]")
    add_legend(drawn, _handles(name, list(found)[1:]), title="A mass on one bearing, Newhall 360")
    return drawn


def _history(panel: Axes, track: Track, k: int) -> None:
    panel.plot(track.time, 1e3 * track.displacement[:, 0], color=COLOURS[k], linewidth=_width(k))


def _loop(panel: Axes, track: Track, load: float, k: int) -> None:
    u, force = 1e3 * track.displacement[:, 0], track.force[:, 0] / load
    panel.plot(u, force, color=COLOURS[k], linewidth=_width(k))


def _width(k: int) -> float:
    return THEIRS if k else OURS


def _handles(first: str, others: list[str]) -> list[Artist]:
    names = [first, *others]
    return [
        Line2D([], [], color=COLOURS[k], linewidth=_width(k), label=name)
        for k, name in enumerate(names)
    ]


if __name__ == "__main__":
    run(CLAIM, page)
