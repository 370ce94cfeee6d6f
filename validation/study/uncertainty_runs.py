"""What is not known of a device and its building: parameters, runs and shares of the variance.

A sample of Saltelli's kind over the properties, and over the record as one property more: each run
is of one set of properties under one record at one intensity. Beside it all records at several
intensities, with rims of one stiffness after another.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy import stats

from frames import ModalDamping
from frames.risk import Campaign, ParameterSample
from frames.risk.fragility.sobol import saltelli_sets
from validation.study.pairs import BY_LOAD, OURS, UNBREAKABLE, device
from validation.study.records_runs import STEP
from validation.study.rims_runs import BREAKS

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from pathlib import Path

    from frames import Frame, GroundMotion
    from lir_element import LIRBearing

RECORD = "record"
SPREADS: dict[str, Any] = {
    "friction": stats.uniform(0.7, 0.6),
    "interface": stats.uniform(0.7, 0.6),
    "stiffness": stats.loguniform(0.1, 1.0),
    "strength": stats.loguniform(0.5, 2.0),
    "breaks": stats.uniform(0.01, 0.03),
    "damping": stats.uniform(0.01, 0.04),
    "axial": stats.loguniform(0.3, 3.0),
    "yield": stats.loguniform(5e-5, 2e-3),
    RECORD: stats.uniform(0.0, 1.0),
}
"""What is not known, and how it is distributed: assumptions."""

MEANINGS = {
    "friction": "friction of the dishes over the nominal",
    "interface": "friction of the interface over the nominal",
    "stiffness": "stiffness of the rims over the default",
    "strength": "strength of the rims over W",
    "breaks": "plastic deformation at which a rim breaks [m]",
    "damping": "modal damping of the frame",
    "axial": "axial stiffness of the bearings over the default",
    "yield": "yield displacement of the friction of the dishes [m]",
    RECORD: "record of the set",
}

SAMPLES, SEED = 64, 1
LEVEL = 2.2
"""Intensity of the sample [m/s2], next to that of the maximum considered earthquake."""

PAIR = {"LIR-DCFP": BY_LOAD, "DCFP": UNBREAKABLE}
"""Devices whose rims have one stiffness after another: names of runs, devices of the study."""

BEST = "LIR-DCFP, equal sliders"

SHARES = (1.0, 0.3, 0.1, 0.03)
"""Stiffness of the rims over the default, where that alone is varied."""

BREAKING = (0.1, 0.03)
"""The same of rims that stay elastic until they break."""

LEVELS = (1.6, 2.2, 2.6, 3.2, 4.2)
"""Intensities then [m/s2]."""

STRENGTH = 1.0
"""Of rims that break, over W, where the stiffness alone is varied."""


def sets_of(samples: int = SAMPLES, seed: int = SEED) -> list[dict[str, float]]:
    """Return the sets of properties, the record among them, samples * (properties + 2)."""
    return saltelli_sets(SPREADS, samples, seed)


def record_of(each: Mapping[str, float], count: int) -> int:
    """Return the number of the record of a set."""
    return min(int(each[RECORD] * count), count - 1)


def changed(own: LIRBearing, parameters: Mapping[str, float]) -> LIRBearing:
    """Return a bearing with other properties; those that are not named stay."""
    law = own.frictions[0]
    factor = parameters.get("friction", 1.0)
    friction = replace(law, f_max=factor * law.f_max, f_min=factor * law.f_min)  # type: ignore[attr-defined,call-arg]
    options = own.resolved()
    stiffness = parameters.get("stiffness", 1.0) * options["rim_stiffness"]
    changes: dict[str, Any] = {"friction": friction, "rim_stiffness": stiffness}
    if "axial" in parameters:
        changes["axial_stiffness"] = parameters["axial"] * options["axial_stiffness"]
    if "yield" in parameters:
        changes["yield_displacement"] = parameters["yield"]
    if not own.is_dcfp:
        changes["interface_friction"] = parameters.get("interface", 1.0) * own.interface_friction
    if "strength" in parameters:
        force = parameters["strength"] * options["design_load"]
        changes["rim_yield_force"] = force
        changes["rim_overrun"] = parameters["breaks"] + force / stiffness
    return replace(own, **changes)


def frame_of(name: str, of: str, parameters: Mapping[str, float]) -> Frame:
    """Return the building on a device of the study with other properties, under a name."""
    frame = device(of)
    found = frame.with_bearings(
        {each: changed(link.bearing, parameters) for each, link in frame.bearings.items()}, name
    )
    if "damping" in parameters:
        found.set_damping(ModalDamping(parameters["damping"]))
    return found


def ours(parameters: Mapping[str, float]) -> Frame:
    """Return the building on the LIR-DCFP, sliders by load: a model of campaigns."""
    return frame_of("LIR-DCFP", PAIR["LIR-DCFP"], parameters)


def best(parameters: Mapping[str, float]) -> Frame:
    """Return the building on the best LIR-DCFP: a model of campaigns."""
    return frame_of("LIR-DCFP", OURS, parameters)


def plain(parameters: Mapping[str, float]) -> Frame:
    """Return the building on the DCFP: a model of campaigns."""
    return frame_of("DCFP", PAIR["DCFP"], parameters)


def sampled(
    motions: Mapping[str, GroundMotion],
    store: Path,
    sets: Sequence[Mapping[str, float]],
) -> Iterator[tuple[list[int], Campaign]]:
    """Yield a campaign a record: the numbers of its sets, and the runs of both devices."""
    names = [name for name in SPREADS if name != RECORD]
    for k, (name, motion) in enumerate(motions.items()):
        own = [n for n, each in enumerate(sets) if record_of(each, len(motions)) == k]
        if own:
            values = np.array([[sets[n][key] for key in names] for n in own])
            sample = ParameterSample(tuple(names), values, f"Saltelli's sets, seed {SEED}")
            models = {"LIR-DCFP": best, "DCFP": plain}
            yield (
                own,
                Campaign(
                    models,
                    {name: motion},
                    store=store / f"{k:02d}",
                    scales=[LEVEL],
                    sample=sample,
                    dt=STEP,
                ),
            )


def stiffness_frames() -> dict[str, Frame]:
    """Return the building on devices whose rims have one stiffness after another, by name."""
    found = {}
    for share in SHARES:
        soft = {"stiffness": share}
        found[f"LIR-DCFP|{share:g}"] = ours(soft)
        found[f"DCFP, never|{share:g}"] = plain(soft)
        breaking = {}
        for name, link in plain(soft).bearings.items():
            options = link.bearing.resolved()
            force = STRENGTH * options["design_load"]
            nominal = force / (options["rim_stiffness"] / share)
            breaking[name] = replace(
                link.bearing,
                rim_yield_force=force,
                rim_overrun=BREAKS - nominal + force / options["rim_stiffness"],
            )
        found[f"DCFP, {STRENGTH:g} W|{share:g}"] = plain(soft).with_bearings(breaking)
    return found


def best_frames() -> dict[str, Frame]:
    """Return the building on the best LIR-DCFP, its rims of one stiffness after another, by name."""
    frame = device(OURS)
    found = {}
    for share in SHARES:
        soft = {}
        for name, link in frame.bearings.items():
            bearing = link.bearing
            stiffness = share * bearing.resolved()["rim_stiffness"]
            force = bearing.rim_yield_force
            more = force / stiffness - force / bearing.resolved()["rim_stiffness"]
            overrun = bearing.resolved()["rim_overrun"] + more
            soft[name] = replace(bearing, rim_stiffness=stiffness, rim_overrun=overrun)
        found[f"{BEST}|{share:g}"] = frame.with_bearings(soft)
    return found


def best_campaign(motions: Mapping[str, GroundMotion], store: Path) -> Campaign:
    """Return the campaign of all records on the best LIR-DCFP."""
    return Campaign(best_frames(), dict(motions), store=store, scales=list(LEVELS), dt=STEP)


def elastic_frames() -> dict[str, Frame]:
    """Return the building on DCFPs whose rims stay elastic and break at one deformation, by name."""
    found = {}
    for share in BREAKING:
        frame = plain({"stiffness": share})
        found[f"DCFP, elastic|{share:g}"] = frame.with_bearings(
            {
                name: replace(link.bearing, rim_overrun=BREAKS)
                for name, link in frame.bearings.items()
            }
        )
    return found


def elastic_campaign(motions: Mapping[str, GroundMotion], store: Path) -> Campaign:
    """Return the campaign of all records on rims that break at one deformation."""
    return Campaign(elastic_frames(), dict(motions), store=store, scales=list(LEVELS), dt=STEP)


def stiffness_campaign(motions: Mapping[str, GroundMotion], store: Path) -> Campaign:
    """Return the campaign of all records on rims of one stiffness after another."""
    return Campaign(stiffness_frames(), dict(motions), store=store, scales=list(LEVELS), dt=STEP)
