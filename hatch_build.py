"""Build hook: a wheel that brings its kernels along, compiled; ``LIR_BUILD_KERNELS=1`` asks for it.

Without, the wheel is plain Python and its kernels compile at their first use. With it the wheel
belongs to one version of Python and one platform; of the kernels those are packed that Python calls
in the analyses of `frames.precompile` (those that they call are within them).
"""

from __future__ import annotations

import os
import platform
import runpy
import shutil
import subprocess  # our own modules, by our own interpreter  # noqa: S404
import sys
import sysconfig
import tempfile
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

LIST = (
    "from frames.precompile import compile_usual; compile_usual(); "
    "from lir_element._compile.cache import taken; print(*taken, sep='\\n')"
)


class KernelHook(BuildHookInterface):  # type: ignore[misc]  # seen without hatchling, too
    """Compiles the usual kernels and adds them to the wheel."""

    @property
    def _wanted(self) -> bool:
        return os.environ.get("LIR_BUILD_KERNELS", "") not in {"", "0"}

    def dependencies(self) -> list[str]:
        """Return what compiling needs: all that running needs."""
        return list(self.metadata.core.dependencies) if self._wanted else []

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Compile, and name what the wheel holds.

        Parameters
        ----------
        version : str
            Of the build: "standard", or "editable", which has no kernels.
        build_data : dict
            What the builder goes by.

        Raises
        ------
        RuntimeError
            If there is no common processor to compile for.
        """
        if not self._wanted or version == "editable":
            return
        shipped = runpy.run_path(str(Path(self.root) / "lir_element" / "_compile" / "shipped.py"))
        processor = shipped["baseline"](platform.machine())
        if processor is None:
            msg = f"no kernels are shipped for {platform.machine()}: unset LIR_BUILD_KERNELS"
            raise RuntimeError(msg)
        self._folder = Path(tempfile.mkdtemp())
        for path in self._compiled(processor):
            inside = path.relative_to(self._folder).as_posix()
            build_data["force_include"][str(path)] = f"lir_element/_kernels/{inside}"
        python = f"cp{sys.version_info.major}{sys.version_info.minor}"
        build_data["pure_python"] = False
        build_data["tag"] = f"{python}-{python}-{_platform()}"

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        """Remove what was compiled, once the wheel is written.

        Parameters
        ----------
        version, build_data, artifact_path : str, dict, str
            As the builder hands them over.
        """
        if hasattr(self, "_folder"):
            shutil.rmtree(self._folder, ignore_errors=True)

    def _compiled(self, processor: str) -> list[Path]:
        # Files of the kernels that a second start takes.
        env = {
            **os.environ,
            "LIR_CACHE_DIR": str(self._folder),
            "NUMBA_CPU_NAME": processor,
            "NUMBA_CPU_FEATURES": "",
            "PYTHONPATH": os.pathsep.join(filter(None, (self.root, os.environ.get("PYTHONPATH")))),
        }
        found = ""
        for command in (["-m", "frames.precompile"], ["-c", LIST]):
            found = subprocess.run(  # noqa: S603
                [sys.executable, *command],
                env=env,
                check=True,
                stdout=subprocess.PIPE,
                text=True,
            ).stdout
        return sorted(Path(line) for line in found.splitlines())


def _platform() -> str:
    # No shared library is in the wheel, and its code asks for none but through numba.
    name = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    return name.replace("linux_", "manylinux_2_17_", 1) if name.startswith("linux_") else name
