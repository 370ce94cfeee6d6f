"""Plan of a results database: all input that must be the same to resume it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from frames._fingerprint import fingerprint, motion_digest
from frames._provenance import numerical_sources, provenance
from frames.risk.campaign.plan import differences
from lir_element._version import package_version
from lir_element.device.features import Features

if TYPE_CHECKING:
    from collections.abc import Mapping

    from frames.frame import Frame
    from frames.risk.campaign.batches import CampaignJob
    from lir_element import LIRBearing

FORMAT = 4
"""Format of the results databases."""

OLD = 1, 2, 3
"""Formats of version 0.2, which `convert_campaign` reads."""

SOURCES = "sources", "program"
"""Parts of a plan that may differ if other sources are accepted."""

TAKEN_OVER = "gone on with"
"""Part of a plan with the accepted other sources, and the number of runs before each."""

_NOT_COMPARED = {*SOURCES, "provenance", TAKEN_OVER}


def described(work: CampaignJob, frames: Mapping[str, Frame]) -> dict[str, Any]:
    """Return the plan of a campaign for plan.json."""
    plan = work.plan
    options = {name: value for name, value in work.options.items() if name != "features"}
    features = work.options["features"] or Features.all()
    sample: dict[str, str] = {}
    if plan.sample is not None:
        columns = zip(plan.sample.names, plan.sample.values.T, strict=True)
        sample = {name: fingerprint(values) for name, values in columns}
    properties: dict[str, Any] = {}
    for name, frame in frames.items():
        properties |= bearing_properties(name, frame)
    measures = {name: f"{own.digest()} [{own.unit}]" for name, own in work.measures.items()}
    return {
        "format": FORMAT,
        "program": package_version(),
        "sources": numerical_sources(),
        "runs": plan.runs,
        "batch": plan.batch,
        "models": {
            name: fingerprint(frames[name]) if name in frames else "none" for name in plan.models
        },
        "bearings": properties,
        "motions": {name: motion_digest(motion) for name, motion in work.motions.items()},
        "scales": list(plan.scales),
        "parameters": sample,
        "options": options | {"features left out": list(features.left_out)},
        "record": str(work.record) if work.record else "what was reached",
        "provenance": provenance()
        | ({} if plan.sample is None else {"sample": plan.sample.origin or "given"}),
    } | ({"measures": measures} if measures else {})


def unlike(stored: Mapping[str, Any], given: Mapping[str, Any]) -> tuple[list[str], list[str]]:
    """Return the differences of two plans in words."""
    latest = dict(stored)
    for taken in stored.get(TAKEN_OVER, []):
        latest |= taken
    asked = [{k: v for k, v in plan.items() if k not in _NOT_COMPARED} for plan in (stored, given)]
    sources = [{k: plan.get(k) for k in SOURCES} for plan in (latest, given)]
    return differences(*asked), differences(*sources)


def bearing_properties(model: str, frame: Frame) -> dict[str, Any]:
    """Return the properties that the bearings of a model are computed with."""
    kinds: dict[str, tuple[str, dict[str, Any]]] = {}
    for name, link in frame.bearings.items():
        own = _properties(link.bearing)
        kinds.setdefault(fingerprint(own), (name, own))
    several = len(kinds) > 1
    return {
        f"{model}, {first}: {key}" if several else f"{model}: {key}": value
        for first, own in kinds.values()
        for key, value in own.items()
    }


def _properties(bearing: LIRBearing) -> dict[str, Any]:
    # Defaults filled in, then the values for kernels.
    record = np.asarray(bearing.to_record()).reshape(-1)[0]
    names = [name for name in record.dtype.names or () if name != "friction_table"]
    kernels = {name: record[name].tolist() for name in names}
    if record["friction_table"].any():
        kernels["friction_table"] = fingerprint(record["friction_table"])
    return {name: float(value) for name, value in bearing.resolved().items()} | kernels
