"""Kernels that came with the wheel: compiled for what all usual processors have in common.

A wheel may bring a folder of compiled kernels along (`hatch_build.py`), laid out as that of the
cache. Those are taken that a start would otherwise compile: the same sources, the same Python,
numba and llvmlite, and a processor with all that they use.
"""

from __future__ import annotations

from pathlib import Path

FOLDER = Path(__file__).parents[1] / "_kernels"
"""Where a wheel has them; in a clone there is no such folder."""

Processor = tuple[str, str, str]
"""Target triple, name and features, as numba hands them to LLVM."""

_BASELINES = {
    "x86_64": ("x86-64-v3", "avx,avx2,bmi,bmi2,f16c,fma,lzcnt,movbe,popcnt,sse4.2,xsave"),
    "aarch64": ("generic", ""),
    "arm64": ("generic", ""),
}
"""By architecture: the processor compiled for, and the features that it takes for granted.

x86-64-v3 is that of the x86-64 psABI: Intel since Haswell (2013), AMD since Excavator (2015).
"""


def baseline(machine: str) -> str | None:
    """Return the name of the processor that kernels are shipped for.

    Parameters
    ----------
    machine : str
        The architecture, as `platform.machine` names it.

    Returns
    -------
    str or None
        LLVM's name; None where none are shipped.
    """
    name, _ = _BASELINES.get(machine.lower().replace("amd64", "x86_64"), (None, ""))
    return name


def shipped_for(own: Processor) -> Processor | None:
    """Return what shipped kernels were compiled for, if this processor can run them.

    Parameters
    ----------
    own : tuple of three str
        Triple, name and features (``"+avx2,-amx-tile,..."``) of this processor.

    Returns
    -------
    tuple or None
        The same of the shipped kernels; None if there are none, or they may use what it lacks.
    """
    triple, _, features = own
    name, needs = _BASELINES.get(triple.split("-", 1)[0], ("", "none"))
    has = set(features.split(","))
    if not FOLDER.is_dir() or not all(f"+{need}" in has for need in needs.split(",") if need):
        return None
    return triple, name, ""
