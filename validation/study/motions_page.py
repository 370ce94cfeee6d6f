"""The page of the study of motions, from its numbers alone; its tables."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from scipy.stats import fisher_exact

from lir_element.units import STANDARD_GRAVITY
from validation.measurements.yielding_runs import LIR, TAIL
from validation.page import render, table
from validation.study.motions_figures import PULSES_FIGURE, SHOCKS_FIGURE
from validation.study.motions_runs import (
    GAMMA,
    LARGEST_FACTOR,
    PHASES,
    PULSE_SCALES,
    PULSE_STEP,
    PULSES,
    TRIED,
    isolated_period,
)
from validation.study.paired import (
    LIMITS,
    WEAK,
    as_csv,
    cost_line,
    told_lir,
)
from validation.study.records_runs import COLLAPSE, INTENSITY
from validation.study.rounded import with_interval

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    Found = Mapping[str, Any]

NAME = "study_motions"


def page(found: Found) -> str:
    """Return the page in Markdown."""
    return render(
        globals(),
        INTENSITY=INTENSITY,
        LIR=LIR,
        PULSES_FIGURE=PULSES_FIGURE,
        SHOCKS_FIGURE=SHOCKS_FIGURE,
        WEAK=WEAK,
        cost_line=cost_line,
        found=found,
        told_lir=told_lir,
        PULSES=PULSES,
        PULSE_STEP=PULSE_STEP,
    )


def _verdict_angles(found: Found) -> str:
    own = found["angles"]["limits"][COLLAPSE.name]
    ratios = [each["ratio"][0] for each in own.values() if each["ratio"]]
    differ = ", ".join(
        f"{name} {n} of {total}" for name, (n, total) in found["angles"]["differ"].items()
    )
    if not ratios:
        return f"No ratio can be formed. Runs of which an angle decides: {differ}."
    return (
        f"The collapse median of the {LIR} over that of the {WEAK} is {min(ratios):.2f} to "
        f"{max(ratios):.2f} by angle: the direction of the records does not "
        f"{'turn the sign' if _one_side(ratios) else 'leave the sign alone: it turns'}. Of a "
        f"record at an intensity the angle decides on collapse in: {differ}."
    )


def _one_side(ratios: Iterable[float]) -> bool:
    values = list(ratios)
    return all(value > 1.0 for value in values) or all(value < 1.0 for value in values)


def _totals(found: Found, second: str, device: str) -> tuple[int, int, int, int]:
    # Survivors that collapse, survivors, and of intact buildings under the second shock alone.
    rows = found["seconds"][second][device]
    return (
        sum(row["collapsed"] for row in rows),
        sum(row["known"] for row in rows),
        sum(row["intact"][0] for row in rows),
        sum(row["intact"][1] for row in rows),
    )


def _verdict_seconds(found: Found) -> str:
    words = []
    for second in found["seconds"]:
        shares = []
        for name in TRIED:
            fallen, known, *_ = _totals(found, second, name)
            shares.append(f"{name} {fallen} of {known}")
        words.append(f"{second}: {', '.join(shares)}")
    sums = [
        [sum(_totals(found, second, name)[k] for second in found["seconds"]) for k in (0, 1)]
        for name in TRIED
    ]
    chance = float(fisher_exact([[fallen, known - fallen] for fallen, known in sums]).pvalue)
    shares = " and ".join(f"{100.0 * fallen / known:.0f} %" for fallen, known in sums)
    return (
        "Collapse in the second shock of those that survived the first: "
        + "; ".join(words)
        + f". Together {shares}, which "
        + ("chance alone would seldom bring" if chance < 0.05 else "are not told apart")
        + f" (Fisher's exact test, as if runs were independent, p = {chance:.2f})."
    )


def _verdict_vertical(found: Found) -> tuple[Any, ...]:
    words = []
    for name, own in found["vertical"]["devices"].items():
        more, less = own["turned"]
        total = sum(row[3] for row in own["shares"][0])
        words.append(f"{name} {more} runs more and {less} less of {total}")
    ratios = found["vertical"]["ratios"]
    both = " and ".join(
        f"{with_interval(ratios[kind])} {word} it"
        for kind, word in (("flat", "without"), ("whole", "with"))
        if ratios[kind]
    )
    told = f" Collapse median of the {LIR} over that of the {WEAK}: {both}." if both else ""
    return told, words


def _verdict_pulses(found: Found) -> tuple[Any, ...]:
    pairs = [[_begins(found, name, pulse.name) for name in TRIED] for pulse in PULSES]
    above, below = (sum(sign * (a - b) > 0.0 for a, b in pairs) for sign in (1.0, -1.0))
    neither = sum(
        all(found["pulses"][name][pulse.name]["high"] is None for name in TRIED) for pulse in PULSES
    )
    lowest = min(PULSES, key=lambda pulse: _begins(found, LIR, pulse.name))
    least = ", ".join(f"{name} {min(row[k] for row in pairs):.2f}" for k, name in enumerate(TRIED))
    return above, below, least, lowest, neither


def _begins(found: Found, device: str, pulse: str) -> float:
    # Intensity of the first collapse; beyond all that was run where there is none.
    high = found["pulses"][device][pulse]["high"]
    return PULSE_STEP * PULSE_SCALES[-1] if high is None else float(high)


def _angles(found: Found) -> str:
    rows = []
    for limit in LIMITS:
        for angle, own in found["angles"]["limits"][limit.name].items():
            failed = [
                f"{sum(row[1] for row in own['shares'][name])}, "
                f"{sum(row[2] for row in own['shares'][name])}"
                for name in TRIED
            ]
            medians = [with_interval(own["medians"][name]) for name in TRIED]
            rows.append([limit.name, angle, *medians, *failed, with_interval(own["ratio"])])
    runs = sum(row[3] + row[4] for row in own["shares"][LIR])
    head = [
        "limit state",
        "angle [deg]",
        *(f"{name}, median [m/s2]" for name in TRIED),
        *(f"{name}, runs over the limit, of them bearings failed" for name in TRIED),
        f"{LIR} over {WEAK}",
    ]
    return (
        "Building and bearings are their own image after a quarter turn, so that angles of 90, 120 and "
        "150 degrees are those of 0, 30 and 60. RotD50 is the same for all. "
        "Friction and rims are round, and the stiffness of this plan has no direction: only hinges and "
        "the worst of nine bearings feel the angle. A plan of unequal sides would feel it more. "
        f"{found['records']} records, {runs} runs a device and angle; intervals of 90 %, records "
        f"resampled.\n\n{table(head, rows)}"
    )


def _seconds(found: Found) -> str:
    rows = []
    for second, own in found["seconds"].items():
        for name, levels in own.items():
            for row in levels:
                slip, moved = row["residual interface slip"], row["residual bearing displacement"]
                rows.append(
                    [
                        second,
                        name,
                        f"{row['scale']:g}",
                        f"{row['survived']} of {row['motions']}",
                        f"{row['collapsed']} of {row['known']}",
                        str(row["bearing"]),
                        "{} of {}".format(*row["intact"]),
                        _both(slip),
                        _both(moved),
                    ]
                )
    head = [
        "second shock",
        "device",
        "first shock, Sa [m/s2]",
        "survived the first",
        "of them collapsed in the second",
        "of these bearings failed",
        "intact buildings that collapse in it, of the same",
        "residual slip after the first and the second, median [mm]",
        "residual displacement, the same [mm]",
    ]
    return (
        "Both shocks are one motion: the first record, "
        f"{TAIL:g} s without motion, the second, {TAIL:g} s more. Slip, displacement, "
        "the dents of rims and plastic rotations of the first are what the second meets. The second is "
        "the same record times a factor, or the next record of the set at the same intensity. Under "
        "the same record an intact building is held to be what the first, whole, left standing. "
        "Medians of what is left are of runs that both shocks left standing.\n\n"
        + table(head, rows)
    )


def _both(pair: Sequence[float | None]) -> str:
    return ", ".join("-" if each is None else f"{1e3 * each:.1f}" for each in pair)


QUANTITIES = {
    "axial force": ("largest axial force [kN]", 1e-3, ".0f"),
    "minimum axial force": ("least axial force [kN]", 1e-3, ".0f"),
    "maximum uplift": ("uplift [mm]", 1e3, ".1f"),
    "floor acceleration, vertical, mean": (
        "vertical floor acceleration [g]",
        1.0 / STANDARD_GRAVITY,
        ".2f",
    ),
    "bearing displacement": ("displacement [mm]", 1e3, ".0f"),
    "interface slip": ("slip [mm]", 1e3, ".0f"),
}


def _vertical(found: Found) -> str:
    own, three = found["vertical"], found["three"]
    rows = []
    for name, each in own["devices"].items():
        levels = [row[0] for row in each["shares"][0]]
        for k, level in enumerate(levels):
            cells = [
                "{}, {}".format(*(_of(value, factor, form) for value in each["peaks"][q][k][2:]))
                for q, (_, factor, form) in QUANTITIES.items()
            ]
            collapsed = ", ".join(f"{s[k][1]} of {s[k][3]}" for s in each["shares"])
            rows.append(
                [name, f"{level:g}", collapsed, str(each["peaks"]["axial force"][k][1]), *cells]
            )
    head = [
        "device",
        "Sa [m/s2]",
        "collapse without, with",
        "runs complete in both",
        *(text for text, _, _ in QUANTITIES.values()),
    ]
    medians = "; ".join(
        f"{name} {with_interval(each['medians'][0])} without, {with_interval(each['medians'][1])} with, ratio "
        f"{with_interval(each['ratio'])}"
        for name, each in own["devices"].items()
    )
    ratios = ", ".join(f"{ratio:.2f}" for _, ratio in three.values())
    return (
        f"The records of FEMA P695 come as pairs. {len(three)} others have three components "
        f"({', '.join(three)}; those whose factor exceeds {LARGEST_FACTOR:g} at 2 m/s2 are left out). All "
        "components get one factor. Peaks of the vertical over the mean of the horizontal ones: "
        f"{ratios}. Medians of collapse [m/s2]: {medians}. Few records, one earthquake among them most "
        "often: the difference that the component makes is known better than the medians.\n\n"
        "Medians without, with the component, of the runs that are complete in both.\n\n"
        + table(head, rows)
    )


def _of(value: float | None, factor: float, form: str) -> str:
    return "-" if value is None else f"{factor * value:{form}}"


def _pulses(found: Found) -> str:
    rows = []
    for pulse in PULSES:
        cells = []
        for name in TRIED:
            row = found["pulses"][name][pulse.name]
            if row["high"] is None:
                cells.append(f"above {row['low']:.2f}")
            else:
                again = f"; {row['again']} above hold" if row["again"] else ""
                cells.append(f"{row['high']:.2f} `{row['status']}`{again}")
        own, other = (found["pulses"][name][pulse.name] for name in TRIED)
        velocity = found["velocities"][pulse.name] * (own["high"] or own["low"])
        period = pulse.ratio * isolated_period()
        rows.append(
            [
                pulse.kind,
                f"{pulse.ratio:g}",
                f"{period:.2f}",
                ("above " if own["high"] is None else "") + f"{velocity:.2f}",
                *cells,
                _quotient(own, other),
            ]
        )
    head = [
        "velocity",
        "T_p / T_iso",
        "T_p [s]",
        f"velocity at collapse of the {LIR} [m/s]",
        *(f"{name}: first collapse [m/s2], end of that run" for name in TRIED),
        f"{LIR} over {WEAK}",
    ]
    return (
        "Pulses of Mavroeidis and Papageorgiou in closed form along x, "
        f"gamma = {GAMMA:g}, velocities that are {' or '.join(PHASES)} about their middle, of periods T_p "
        f"between {PULSES[0].ratio:g} and {PULSES[-1].ratio:g} of that of the bearings while they slide, "
        f"T_iso = {isolated_period():.2f} s. Intensity is Sa(3 s, 5 %) along x; intensities rise by "
        f"{100.0 * (PULSE_STEP - 1.0):.0f} % a step from {PULSE_SCALES[0]:g} to {PULSE_SCALES[-1]:.2f} m/s2, and a "
        "pulse is one motion without scatter: ratios are known to a step.\n\n" + table(head, rows)
    )


def _quotient(own: Mapping[str, Any], other: Mapping[str, Any]) -> str:
    # A bound where one of both collapses at no intensity that was run.
    if own["high"] is None and other["high"] is None:
        return "-"
    word = "above " if own["high"] is None else "below " if other["high"] is None else ""
    value = (own["high"] or own["low"]) / (other["high"] or other["low"])
    return f"{word}{value:.2f}"


def csv_tables(found: Found) -> dict[str, str]:
    """Return the tables by the names of their files, SI units."""
    angles = [
        [limit, angle, name, *(own["medians"][name] or [None] * 3)]
        for limit, each in found["angles"]["limits"].items()
        for angle, own in each.items()
        for name in TRIED
    ]
    seconds = [
        [second, name, row["scale"], row["motions"], row["survived"], row["known"], row["collapsed"],
         row["bearing"], *row["intact"], *row["residual interface slip"]]
        for second, own in found["seconds"].items()
        for name, levels in own.items()
        for row in levels
    ]  # fmt: skip
    pulse_rows = [
        [each.kind, each.ratio, each.ratio * isolated_period(), name, row["low"], row["high"],
         row["status"], row["again"], found["velocities"][each.name]]
        for each in PULSES
        for name in TRIED
        for row in [found["pulses"][name][each.name]]
    ]  # fmt: skip
    vertical = [
        [name, with_it, *row]
        for name, own in found["vertical"]["devices"].items()
        for with_it, rows in zip((False, True), own["shares"], strict=True)
        for row in rows
    ]
    return {
        f"{NAME}-angles.csv": as_csv(
            ["limit state", "angle [deg]", "device", "median [m/s2]", "low [m/s2]", "high [m/s2]"],
            angles,
        ),
        f"{NAME}-seconds.csv": as_csv(
            ["second shock", "device", "Sa of the first [m/s2]", "motions", "survived the first",
             "known", "collapsed in the second", "bearings failed", "intact collapse", "intact known",
             "residual slip after the first [m]", "after the second [m]"],
            seconds,
        ),
        f"{NAME}-vertical.csv": as_csv(
            ["device", "vertical component", "Sa [m/s2]", "collapse", "bearings failed", "known",
             "unknown"],
            vertical,
        ),
        f"{NAME}-pulses.csv": as_csv(
            ["velocity", "T_p over T_iso [-]", "T_p [s]", "device", "holds at Sa [m/s2]",
             "collapses at Sa [m/s2]", "end", "runs above that hold", "velocity per Sa [s]"],
            pulse_rows,
        ),
    }  # fmt: skip
