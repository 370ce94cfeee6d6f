"""Why levels of fidelity differ: runs that fail at one alone, doubts of the model, and a history."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from frames import time_history
from frames.plots import plot_style as ps
from frames.risk.campaign.designs import with_parameters
from frames.risk.campaign.file import read_campaign
from frames.risk.fragility.runs import FAILURE, outcome_of
from validation.study.runner import quietly

if TYPE_CHECKING:
    from collections.abc import Mapping

    import xarray as xr
    from matplotlib.figure import Figure

    from frames.frame import Frame
    from frames.risk.campaign.tables import CampaignTables

HOLD = 1e3
"""Force that holds the halves [N]."""

RECORD, SCALE, DEVICE = "Kocaeli, Turkey 1999, Duzce", 2.6, "LIR-DCFP 689 mm"
"""Of the histories: the record, its Sa [m/s2], the device."""

BEARING, STEP, SPAN = "bearing-2-2", 0.005, (7.0, 10.0)
"""A corner, the step, and times that are kept [s]."""

KINDS = {
    "contact": ("contact", 0.0),
    f"contact, held by {1e-3 * HOLD:.0f} kN": ("contact", HOLD),
    "pendulum": ("pendulum", 0.0),
}
"""Level and force that holds the halves [N], by the name of a history."""


KEYS = ["model", "motion", "scale"]
FACTORS = ("rim_damping_factor", "axial_damping_factor")


def numbers(every: Mapping[str, CampaignTables]) -> dict[str, Any]:
    """Return by device the runs that fail at one level alone and by each doubt, and histories."""
    failed = {name: _failed(tables.data) for name, tables in every.items()}
    frame, data = every["contact"].frames[DEVICE], every["contact"].data
    spins = _by_run(data, data["peak_spin"].max("bearing").to_numpy())
    found: dict[str, Any] = {"alone": {}, "histories": _histories(frame)}
    for name in (each for each in every["held"].runs if "LIR" in each):
        contact, pendulum, held = (failed[k].loc[name] for k in ("contact", "pendulum", "held"))
        alone = contact & ~pendulum.reindex(contact.index)
        found["alone"][name] = {
            "contact": int(alone.sum()),
            "pendulum": int((pendulum & ~contact.reindex(pendulum.index)).sum()),
            "held": int((alone & held.reindex(alone.index)).sum()),
            "spin": float(spins.loc[name][alone].median()),
        }
    each = [_doubts(name, failed) for name in found["alone"]]
    found["doubts"] = [[text, *(part[text] for part in each)] for text in each[0]]
    return found


def _by_run(data: xr.Dataset, values: Any) -> pd.Series:
    # By device, record, intensity and factors on damping.
    keys = KEYS + [name for name in FACTORS if name in data.coords]
    index = pd.MultiIndex.from_arrays([data[name].to_numpy() for name in keys], names=keys)
    return pd.Series(values, index).sort_index()


def _failed(data: xr.Dataset) -> pd.Series:
    # Whether a bearing fails.
    return _by_run(data, [outcome_of(str(each)) == FAILURE for each in data["status"].to_numpy()])


def _doubts(name: str, failed: Mapping[str, pd.Series]) -> dict[str, list[int]]:
    # Failed bearings by variant, and runs that end otherwise than at contact.
    step = failed["step"].loc[name]
    usual = failed["contact"].loc[name].reindex(step.index)
    variants = {"as computed": usual, "a quarter of the step": step}
    for factors, part in failed["damping"].loc[name].groupby(level=list(FACTORS)):
        text = "damping of rims times {:g}, of contacts times {:g}".format(*factors)
        variants[text] = part.droplevel(list(FACTORS))
    for text, kind in ((f"held by {1e-3 * HOLD:.0f} kN", "held"), ("level pendulum", "pendulum")):
        variants[text] = failed[kind].loc[name].reindex(step.index)
    return {
        text: [int(part.sum()), int((part != usual.reindex(part.index)).sum())]
        for text, part in variants.items()
    }


def _histories(frame: Frame) -> dict[str, Any]:
    # Histories of the corner by `KINDS`; a trial may leave the record out.
    file, found = Path(__file__).with_name("device-contact.toml"), {}
    with quietly():
        motion = read_campaign(file).motions[RECORD].scaled(SCALE)
        for name, (level, hold) in KINDS.items():
            model = with_parameters(frame, {"interface_hold": hold})
            data = time_history(model, motion, dt=STEP, level=level, duration=SPAN[1])
            found[name] = corner(data, SPAN)
    return found


def corner(data: xr.Dataset, span: tuple[float, float]) -> dict[str, list[float]]:
    """Return a history of the corner: s, m, mm of slip, forces over the load at rest.

    Displacement and force are those along the largest displacement.
    """
    own, t = data.sel(bearing=BEARING, axis=["x", "y"]), data["time"].to_numpy()
    kept, over = (span[0] <= t) & (t <= span[1]), 1.0 / float(own["static_axial_force"])
    way, force, slip = (
        own[name].to_numpy() for name in ("bearing_displacement", "bearing_force", "interface_slip")
    )
    toward = way[np.hypot(*way.T).argmax()] / np.hypot(*way.T).max()
    series = {
        "time": t,
        "displacement": way @ toward,
        "force": over * (force @ toward),
        "axial": over * own["axial_force"].to_numpy(),
        "slip": 1e3 * np.hypot(*slip.T),
    }
    return {key: values[kept].round(4).tolist() for key, values in series.items()}


def figure(own: Mapping[str, Any]) -> Figure:
    """Return slip and axial force of a corner bearing over time, by level."""
    drawn = ps.new_figure(2.6)
    ((axial, slip),) = ps.grid_of(drawn, 1, 2)
    for k, (name, run) in enumerate(own["histories"].items()):
        for panel, key in ((axial, "axial"), (slip, "slip")):
            panel.plot(run["time"], run[key], label=name, **ps.line_of(k))
    ps.caption(axial, x="time [s]", y="N / W [-]")
    ps.caption(slip, x="time [s]", y="slip [mm]")
    slip.legend(fontsize=ps.SMALL, frameon=False)
    return drawn
