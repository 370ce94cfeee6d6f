"""Origin of results: sources that numbers depend on, versions, date, citation."""

from __future__ import annotations

import datetime
import hashlib
import platform
from functools import cache
from pathlib import Path

import numba
import numpy as np
import scipy

from lir_element._version import package_version

NUMERICAL = (
    "lir_element/*.py",
    "lir_element/bundles/**/*.py",
    "lir_element/device/**/*.py",
    "lir_element/kernels/**/*.py",
    "lir_element/results/**/*.py",
    "frames/*.py",
    "frames/assembly/**/*.py",
    "frames/batch/**/*.py",
    "frames/kernels/**/*.py",
    "frames/library/**/*.py",
    "frames/model/**/*.py",
    "frames/motion/**/*.py",
    "frames/recording/**/*.py",
    "frames/results/**/*.py",
    "frames/solve/**/*.py",
    "frames/statics/**/*.py",
    "frames/risk/campaign/batches.py",
    "frames/risk/campaign/designs.py",
)
"""Patterns of the sources that the numbers of a time history depend on."""

CITATION = "The lir-dcfp developers: lir-dcfp, seismic isolation with the LIR-DCFP bearing"

_ROOT = Path(__file__).parents[1]


@cache
def numerical_sources() -> dict[str, str]:
    """Return a digest of each source that results depend on, as first read by this process."""
    files = sorted({path for pattern in NUMERICAL for path in _ROOT.glob(pattern)})
    return {
        path.relative_to(_ROOT).as_posix(): _digest(path.read_bytes().replace(b"\r\n", b"\n"))
        for path in files
    }


@cache
def sources_hash() -> str:
    """Return one digest of all sources that results depend on, 8 hexadecimal digits."""
    return _digest("".join(f"{k} {v}\n" for k, v in numerical_sources().items()).encode())


def provenance(dated: bool = True) -> dict[str, str]:
    """Return the origin of results, as attributes."""
    now = datetime.datetime.now(datetime.UTC)
    date = {"date_created": f"{now:%Y-%m-%dT%H:%M:%SZ}"} if dated else {}
    return {
        "Conventions": "CF-1.8",
        "source": f"lir-dcfp {package_version()}, sources {sources_hash()}",
        "software": (
            f"Python {platform.python_version()}, numpy {np.__version__}, scipy "
            f"{scipy.__version__}, numba {numba.__version__}"
        ),
        "references": f"{CITATION}, version {package_version()}",
        **date,
    }


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()[:8]
