"""Import of openseespy in any of its builds, and the same commands of xara."""

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
        other = "; or pass a model of xara by ops=" if importlib.util.find_spec("xara") else ""
        msg = f'openseespy is not installed: pip install "lir-dcfp[opensees]"{other}'
        raise ImportError(msg)
    _load_bundled_libraries()
    try:
        return importlib.import_module(_NAME)
    except (ImportError, RuntimeError) as cause:
        version = ".".join(map(str, sys.version_info[:3]))
        msg = f"openseespy cannot be loaded by Python {version} ({cause}): reinstall it by pip"
        raise ImportError(msg) from cause


class XaraCommands:
    """The commands of a model in xara, with the names and results of OpenSeesPy."""

    def __init__(self, model: Any) -> None:
        self._model = model

    def __getattr__(self, name: str) -> Any:
        """Return a command that is the same in both."""
        return getattr(self._model, name)

    def getNodeTags(self) -> list[int]:  # noqa: N802
        """Return the tags of all nodes."""
        return self._tags("getNodeTags")

    def getEleTags(self) -> list[int]:  # noqa: N802
        """Return the tags of all elements."""
        return self._tags("getEleTags")

    def getFixedNodes(self) -> list[int]:  # noqa: N802
        """Return the tags of nodes with supports."""
        return self._tags("fixedNodes")

    def getFixedDOFs(self, tag: int) -> list[int]:  # noqa: N802
        """Return the fixed degrees of freedom of a node."""
        return self._tags(f"fixedDOFs {tag}")

    def remove(self, *what: Any) -> None:
        """Remove an object; xara reports an element that it removed as an error."""
        self._model.eval(f"catch {{remove {' '.join(map(str, what))}}}")

    def _tags(self, command: str) -> list[int]:
        # Of a model that was wiped there are none.
        lines = f"if {{[catch {{{command}}} tags]}} {{return {{}}}}; return $tags"
        return [int(tag) for tag in self._model.eval(f"apply {{{{}} {{{lines}}}}}").split()]


def commands_of(ops: Any = None) -> Any:
    """Return the commands of a model: OpenSeesPy's, or those of xara's model or module."""
    if ops is None:
        return opensees()
    if getattr(ops, "__name__", "") == _NAME or isinstance(ops, XaraCommands):
        return ops
    if not (hasattr(ops, "eval") and hasattr(ops, "nodeDisp")):
        msg = (
            f"ops = {ops!r} must be a model of xara, as xara.Model(ndm=3, ndf=6), or left out "
            "for OpenSeesPy"
        )
        raise TypeError(msg)
    return vars(ops).setdefault("_lir_commands", XaraCommands(ops))  # one for each model


def _load_bundled_libraries() -> None:
    spec = importlib.util.find_spec("openseespylinux")
    if spec is None or spec.origin is None:  # Windows and macOS find theirs
        return
    blas = Path(spec.origin).parent / "lib" / "libblas.so.3"
    if blas.exists():
        ctypes.CDLL(str(blas), mode=ctypes.RTLD_GLOBAL)
