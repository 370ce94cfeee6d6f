"""Kernels that came with the wheel, compiled for the common features of all usual processors.

A wheel may contain a folder of compiled kernels (`hatch_build.py`) in the layout of the cache. They
are used if sources, Python, numba and llvmlite are the same, and if the processor has all features
of their code.
"""

from __future__ import annotations

from pathlib import Path

FOLDER = Path(__file__).parents[1] / "_kernels"
"""Folder of the kernels in a wheel; a clone has no such folder."""

Processor = tuple[str, str, str]
"""Target triple, name and features, as numba passes them to LLVM."""

_BASELINES = {
    "x86_64": ("x86-64-v3", "avx,avx2,bmi,bmi2,f16c,fma,lzcnt,movbe,popcnt,sse4.2,xsave"),
    "aarch64": ("generic", ""),
    "arm64": ("generic", ""),
}
"""By architecture: the target processor, and its assumed features.

x86-64-v3 is that of the x86-64 psABI: Intel since Haswell (2013), AMD since Excavator (2015).
"""


def baseline(machine: str) -> str | None:
    """Return the name of the processor that kernels are shipped for."""
    name, _ = _BASELINES.get(machine.lower().replace("amd64", "x86_64"), (None, ""))
    return name


def shipped_for(own: Processor) -> Processor | None:
    """Return the processor that shipped kernels were compiled for, if this one can run them."""
    triple, _, features = own
    name, needs = _BASELINES.get(triple.split("-", 1)[0], ("", "none"))
    has = set(features.split(","))
    if not FOLDER.is_dir() or not all(f"+{need}" in has for need in needs.split(",") if need):
        return None
    return triple, name, ""
