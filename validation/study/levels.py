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
from validation.study.part import quietly

if TYPE_CHECKING:
    from collections.abc import Mapping

    import xarray as xr
    from matplotlib.figure import Figure

    from frames.frame import Frame
    from frames.risk.campaign.tables import CampaignTables

HOLD = 1e3
"""Force that holds the halves [N]."""

RECORD, SCALE, DEVICE, BEARING = (
    "Kocaeli, Turkey 1999, Duzce",
    2.6,
    "LIR-DCFP 689 mm",
    "bearing-2-2",
)
"""Of the histories: the record, its Sa [m/s2], the device, a corner."""

STEP, SPAN = 0.005, (7.0, 10.0)
"""Step, and times that are kept [s]."""

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
    frame = every["contact"].frames[DEVICE]
    found: dict[str, Any] = {"alone": {}, "histories": _histories(frame)}
    for name in every["held"].runs:
        contact, pendulum, held = (failed[k].loc[name] for k in ("contact", "pendulum", "held"))
        alone = contact & ~pendulum.reindex(contact.index)
        found["alone"][name] = {
            "contact": int(alone.sum()),
            "pendulum": int((pendulum & ~contact.reindex(pendulum.index)).sum()),
            "held": int((alone & held.reindex(alone.index)).sum()),
        }
    each = [_doubts(name, failed) for name in every["held"].runs]
    found["doubts"] = [[text, *(part[text] for part in each)] for text in each[0]]
    return found


def _failed(data: xr.Dataset) -> pd.Series:
    # Whether a bearing fails, by device, record, intensity and factors on damping.
    keys = KEYS + [name for name in FACTORS if name in data.coords]
    frame = pd.DataFrame({name: data[name].to_numpy() for name in keys})
    frame["failed"] = [outcome_of(str(each)) == FAILURE for each in data["status"].to_numpy()]
    return frame.set_index(keys)["failed"].sort_index()


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
    # Slip and axial force of the corner over time, by `KINDS`.
    file, found = Path(__file__).with_name("device-contact.toml"), {}
    with quietly():
        motion = read_campaign(file).motions[RECORD].scaled(SCALE)  # that a trial may leave out
        for name, (level, hold) in KINDS.items():
            model = with_parameters(frame, {"interface_hold": hold})
            data = time_history(model, motion, dt=STEP, level=level, duration=SPAN[1])
            own = data.sel(bearing=BEARING)
            t = own["time"].to_numpy()
            kept = (SPAN[0] <= t) & (t <= SPAN[1])
            slip = 1e3 * np.hypot(*own["interface_slip"].sel(axis=["x", "y"]).to_numpy().T)
            axial = (own["axial_force"] / own["static_axial_force"]).to_numpy()
            series = {"time": t, "slip": slip, "axial": axial}
            found[name] = {key: each[kept].tolist() for key, each in series.items()}
    return found


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
