"""Import of openseespy in any of its builds."""

from __future__ import annotations

import ctypes
import importlib
import importlib.util
import sys
from pathlib import Path
from typing import Any

_NAME = "openseespy.opensees"


def opensees() -> Any:
    """Import the commands of OpenSeesPy.

    Returns
    -------
    module
        `openseespy.opensees`. Its model is one for the whole process.

    Raises
    ------
    ImportError
        If openseespy is not installed, or its library cannot be loaded.

    Notes
    -----
    The build for Python 3.11 (3.7.1) does not find its own BLAS library unless that is loaded
    before. This function loads it, so call it before your own ``import openseespy.opensees``.

    Examples
    --------
    >>> from lir_element.opensees import opensees
    >>> ops = opensees()
    >>> ops.wipe()
    >>> ops.getNodeTags()
    []
    """
    if _NAME in sys.modules:
        return sys.modules[_NAME]
    if importlib.util.find_spec("openseespy") is None:
        other = "xara" if importlib.util.find_spec("xara") else ""
        note = f" ({other} is, in which the bearing is not tried)" if other else ""
        msg = f'openseespy is not installed{note}: pip install "lir-dcfp[opensees]"'
        raise ImportError(msg)
    _load_bundled_libraries()
    try:
        return importlib.import_module(_NAME)
    except (ImportError, RuntimeError) as cause:
        version = ".".join(map(str, sys.version_info[:3]))
        msg = f"openseespy cannot be loaded by Python {version} ({cause}): reinstall it by pip"
        raise ImportError(msg) from cause


def _load_bundled_libraries() -> None:
    spec = importlib.util.find_spec("openseespylinux")
    if spec is None or spec.origin is None:  # Windows and macOS find theirs
        return
    blas = Path(spec.origin).parent / "lib" / "libblas.so.3"
    if blas.exists():
        ctypes.CDLL(str(blas), mode=ctypes.RTLD_GLOBAL)
