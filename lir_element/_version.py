"""The installed version: a module of its own, so that ``lir --version`` imports no library."""

from __future__ import annotations

from functools import cache
from importlib.metadata import PackageNotFoundError, version


@cache
def package_version() -> str:
    """Return the installed version, or 'unknown' outside an installation."""
    try:
        return version("lir-dcfp")
    except PackageNotFoundError:
        return "unknown"
