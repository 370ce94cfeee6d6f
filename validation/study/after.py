"""What follows the failure of a bearing, collapse or a stop: writes docs/validation/study_after.md.

    python -m validation.study.after --store after-runs

The campaign can be stopped; the same command goes on with its store. Needs the extras "campaign",
"fema" and "fragility".
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from frames.plots import plot_style as ps
from frames.risk import Campaign, LimitState, collapse_margin_ratio
from frames.risk.fragility.runs import UNKNOWN
from lir_element import BackupSupport
from lir_element.units import STANDARD_GRAVITY
from validation.measurements.yielding_runs import LIR
from validation.page import render
from validation.study.device_runs import best_devices, frame_of
from validation.study.far_field import RECORDS, far_field
from validation.study.part import run_part, write_part
from validation.study.records_runs import (
    COLLAPSE,
    INTENSITY,
    SCALES,
    STEP,
    compared,
    considered,
    curves_of,
    numbers_of,
    runs_of,
)
from validation.study.rounded import with_interval

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from matplotlib.figure import Figure

    Found = Mapping[str, Any]
    from collections.abc import Mapping
    from pathlib import Path

    import xarray as xr

    from frames import Frame, GroundMotion

NAME = "study_after"
FIGURE = f"{NAME}-collapse.png"


def page(found: Found) -> str:
    """Return the page in Markdown."""
    return render(globals(), found=found, FRICTION=FRICTION, INTENSITY=INTENSITY, RECORDS=RECORDS)


def _introduction(found: Found) -> Any:
    drops = " and ".join(f"{1e3 * drop:.0f}" for drop in DROPS if drop is not None)
    return drops


def _name(device: str, drop: float | None) -> str:
    return Kind(device, drop).name


def _verdict(found: Found) -> str:
    lines = []
    for place, drop in enumerate(DROPS):
        names = {device: _name(device, drop) for device in DEVICES}
        words = []
        for device, name in names.items():
            counts = [found["stripes"][name][-1][key] for key in ("failed", "collapsed", "known")]
            words.append(
                f"{device} {_margin(found['margins'].get(name))}; at {SCALES[-1]:g} m/s2 a bearing "
                f"fails in {counts[0]}, and {counts[1]} of {counts[2]} collapse"
            )
        then = (
            "Failure of a bearing is collapse"
            if drop is None
            else f"Stop after {1e3 * drop:.0f} mm"
        )
        lines.append(f"- **{then}.** Collapse margin: {'. '.join(words)}. {_ahead(found, place)}")
    return "\n".join(lines) + "\n\n" + _conclusion(found)


def _margin(value: Sequence[float] | None) -> str:
    return "not reached" if value is None else with_interval(value)


def _ahead(found: Found, place: int) -> str:
    # Ratios of medians of the LIR-DCFP over the DCFP, limit by limit.
    words = []
    for limit in LIMITS:
        ratio = found["ratios"][limit.name][place]
        if ratio is not None:
            words.append(f"{limit.name} {with_interval(ratio)}")
    return f"Median of the LIR-DCFP over that of the DCFP: {'; '.join(words)}."


def _conclusion(found: Found) -> str:
    lost = {device: [0, 0] for device in DEVICES}
    reached: dict[str, list[float]] = {"drift": [], "floor": []}
    for kind in KINDS:
        if kind.drop is None:
            continue
        for row in found["stripes"][kind.name]:
            lost[kind.device][0] += row["failed"]
            lost[kind.device][1] += row["collapsed"]
            for key, values in reached.items():
                if row[key] is not None:
                    values.append(row[key])
    counts = "; ".join(
        f"{device} in {collapsed} of {failed}" for device, (failed, collapsed) in lost.items()
    )
    drift, floor = reached["drift"], reached["floor"]
    return (
        "What is called collapse decides the comparison. Of the runs in which a bearing fails and a "
        f"stop carries on, the frame reaches a ductility of 9: {counts}. The building is lost for "
        "use all the same: it comes down, and by medians of the stripes its storeys drift by "
        f"{100.0 * min(drift):.1f} to {100.0 * max(drift):.1f} % and its floors are shaken by "
        f"{min(floor):.1f} to {max(floor):.1f} g, with either device. A designer who provides a "
        "stop need not count the failure of a bearing as collapse; one who does not, has to."
    )


def _margins(found: Found) -> tuple[Any, ...]:
    head = ["device and what follows", *(f"{limit.name}, median [m/s2]" for limit in LIMITS)]
    rows = []
    for kind in KINDS:
        curves = [found["limits"][limit.name][kind.name] for limit in LIMITS]
        ends = ", ".join(f"{n} `{end}`" for end, n in found["statuses"][kind.name].items())
        rows.append(
            [
                kind.name,
                *(f"{c['median'][0]:.2f}" if "median" in c else c["why"] for c in curves),
                _margin(found["margins"].get(kind.name)),
                ends,
            ]
        )
    return head, rows


def _reached(found: Found) -> Any:
    rows = []
    for kind in KINDS:
        if kind.drop is None:
            continue
        for row in found["stripes"][kind.name]:
            if not row["failed"]:
                continue
            rows.append(
                [
                    kind.name,
                    f"{row['im']:g}",
                    f"{row['failed']} of {row['known']}",
                    f"{row['collapsed']} of {row['known']}",
                    *(
                        "-" if row[key] is None else f"{factor * row[key]:.{digits}f}"
                        for key, factor, digits in (
                            ("drift", 100.0, 1),
                            ("ductility", 1.0, 1),
                            ("floor", 1.0, 1),
                        )
                    ),
                ]
            )
    return rows


def figure_of(found: Found) -> Figure:
    """Return shares of failed bearings and of collapse over intensity, a panel a device."""
    figure = ps.new_figure(2.9)
    (panels,) = ps.grid_of(figure, 1, len(DEVICES), share_x=True, share_y=True)
    for panel, device in zip(panels, DEVICES, strict=True):
        for k, drop in enumerate(DROPS):
            rows = found["stripes"][_name(device, drop)]
            at = [row["im"] for row in rows]
            label = "failure is collapse" if drop is None else f"stop after {1e3 * drop:.0f} mm"
            share = [row["collapsed"] / row["known"] for row in rows]
            panel.plot(
                at, share, label=label, **ps.line_of(k), marker=("o", "s", "^")[k], markersize=3
            )
        panel.axvline(found["considered"], color=ps.GREY, linewidth=0.7, linestyle=":")
        panel.set_ylim(-0.02, 1.02)
        ps.caption(panel, title=device, x="Sa(3 s) [m/s2]")
    ps.add_legend(figure, panels[0].get_lines()[:-1], columns=3)
    ps.caption(panels[0], y="share that collapses [-]")
    return figure


def write(found: Found) -> None:
    """Write the page, its figure and the numbers."""
    write_part(NAME, page(found), {FIGURE: figure_of(found)}, found)


def main(given: Sequence[str] | None = None) -> None:
    """Run the campaign, and write the page."""
    run_part("after", given, partial(far_field, campaign, found_of), write)


DROPS = (None, 0.02)
"""Way down to the stop [m]; None: the run ends by the failure, which is collapse."""

FRICTION = 0.3
"""Of the stop: an assumption, steel on steel or mortar."""

STRENGTHS = (1.0,)
"""Of the DCFP's rims, over the design load."""

LIMITS = (
    LimitState.drift(0.02),
    LimitState.drift(0.04),
    LimitState.floor_acceleration(STANDARD_GRAVITY),
    COLLAPSE,
)


class Kind(NamedTuple):
    """A device, and what carries after its failure."""

    device: str
    drop: float | None

    @property
    def name(self) -> str:
        """How the page calls it."""
        then = "ends" if self.drop is None else f"stop after {1e3 * self.drop:.0f} mm"
        return f"{self.device}: {then}"


DEVICES = (LIR, *(f"DCFP, rims of {strength:g} W" for strength in STRENGTHS))
KINDS = tuple(Kind(device, drop) for device in DEVICES for drop in DROPS)


def devices() -> dict[str, Frame]:
    """Return the building on each device, with each of the backups."""
    best = best_devices()
    found = {}
    for kind in KINDS:
        frame = frame_of(best[kind.device])
        if kind.drop is not None:
            backup = BackupSupport(drop=kind.drop, friction=FRICTION)
            own = frame.bearings.items()
            frame = frame.with_bearings(
                {name: replace(link.bearing, backup=backup) for name, link in own}
            )
        found[kind.name] = frame
    return found


def campaign(
    motions: Mapping[str, GroundMotion], store: Path, scales: Sequence[float] = SCALES
) -> Campaign:
    """Return the campaign of all devices under motions at intensities [m/s2]."""
    return Campaign(devices(), dict(motions), store=store, scales=list(scales), dt=STEP)


def found_of(
    data: xr.Dataset, motions: Mapping[str, GroundMotion], resamples: int
) -> dict[str, Any]:
    """Return what the page says of the results of a campaign: plain numbers, for JSON."""
    runs = {kind.name: runs_of(data, motions, kind.name) for kind in KINDS}
    at = considered()
    limits: dict[str, Any] = {}
    ratios: dict[str, Any] = {}
    for limit in LIMITS:
        curves = curves_of(runs, limit, resamples)
        limits[limit.name] = {n: numbers_of(curve, band=False) for n, curve in curves.items()}
        ratios[limit.name] = [
            compared(curves, Kind(LIR, drop).name).get(Kind(DEVICES[1], drop).name)
            for drop in DROPS
        ]
    margins = {
        name: [collapse_margin_ratio(value, at) for value in curve["median"]]
        for name, curve in limits[COLLAPSE.name].items()
        if "median" in curve
    }
    stripes: dict[str, list[dict[str, float]]] = {}
    for name, each in runs.items():
        table = each.table
        failed = each.exceeded(LimitState.bearing_failure())
        collapsed = each.exceeded(COLLAPSE)
        rows = []
        for level in sorted(set(table["im"])):
            own = (table["im"] == level).to_numpy() & (table["outcome"] != UNKNOWN).to_numpy()
            lost = own & (table["status"] == "bearing_lost").to_numpy()
            rows.append(
                {
                    "im": float(level),
                    "known": int(own.sum()),
                    "failed": int(np.nansum(failed[own])),
                    "collapsed": int(np.nansum(collapsed[own])),
                    "drift": _median(table["storey drift, mean"].to_numpy()[lost]),
                    "floor": _median(
                        table["floor acceleration in plan, mean"].to_numpy()[lost]
                        / STANDARD_GRAVITY
                    ),
                    "ductility": _median(table["ductility"].to_numpy()[lost]),
                }
            )
        stripes[name] = rows
    return {
        "considered": at,
        "limits": limits,
        "ratios": ratios,
        "loop": round(float(data["seconds_loop"].sum()), 1),
        "margins": margins,
        "stripes": stripes,
        "statuses": {n: each.table["status"].value_counts().to_dict() for n, each in runs.items()},
    }


def _median(values: Any) -> float | None:
    # Of the runs that went on; none: None.
    return float(np.round(np.median(values), 5)) if len(values) else None


if __name__ == "__main__":
    main()
