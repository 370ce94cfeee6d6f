"""A small building that is viewed in motion, and what its page holds, read back."""

import base64
import functools
import json
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from frames import Frame, GroundMotion, moment_frame, time_history
from tests.scenes import simple_bearing

BEARING = simple_bearing()


@dataclass
class Judged:
    """A check as the page takes it."""

    title: str
    note: str
    verdict: str = "FAILS"
    concerns: str = "lower"
    relation: str = "<="
    said: tuple[str, str, str] = ("1 kN", "2 kN", "0.5")
    ratio: float = float("inf")
    cited: str = "a code 1.2 *"


@functools.cache
def building() -> tuple[Frame, xr.Dataset]:
    """Run six bearings under one storey: rims, slip and, as the ground drops, uplift."""
    time = np.arange(0.0, 3.0, 0.01)
    push = 1.8 * np.sin(2.0 * np.pi * time / 1.0) * (time < 1.0)
    drop = np.where((time > 0.2) & (time < 0.3), -12.0, 0.0)
    catch = np.where((time > 0.3) & (time < 0.4), 12.0, 0.0)
    motion = GroundMotion(x=push, y=0.4 * push, z=drop + catch, dt=0.01)
    frame = moment_frame((2, 1), 1, bearing=BEARING)
    return frame, time_history(frame, motion, level="contact", dt=0.005)


def payload(path: Path) -> dict[str, Any]:
    """Read what a page holds, arrays as arrays."""
    text = path.read_text(encoding="utf-8")
    found = re.search(r'<script type="application/json" id="payload">(.*?)</script>', text, re.S)
    assert found is not None
    return unpacked(json.loads(found[1]))  # type: ignore[no-any-return]


def unpacked(part: Any) -> Any:
    """Put arrays in the place of their texts, anywhere in a tree; scaled ones in SI units."""
    if isinstance(part, list):
        return [unpacked(each) for each in part]
    if not isinstance(part, dict):
        return part
    if not {"type", "shape", "data"} <= set(part):
        return {name: unpacked(each) for name, each in part.items()}
    kind = np.dtype(part["type"]).newbyteorder("<")
    values = np.frombuffer(base64.b64decode(part["data"]), kind).reshape(part["shape"])
    if "scale" not in part:
        return values
    return values * np.expand_dims(unpacked(part["scale"]).astype(float), part["along"])
