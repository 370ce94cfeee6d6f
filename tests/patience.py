"""How long tests wait: by what this machine takes, as it is loaded, to start Python and import.

No test has a limit in seconds: a machine that is busy, slow or debugged would fail it.
"""

import functools
import os
import subprocess  # a fresh interpreter  # noqa: S404
import sys
import time
from pathlib import Path

_HANG = 4000.0  # starts with numpy alone, that nothing which ends by itself takes
_LEAST = 600.0  # s, the same: kernels may have to be compiled first


def start_up(code: str = "from frames import *") -> float:
    """Time a start of Python that runs some code, now [s]."""
    began = time.perf_counter()
    subprocess.run([sys.executable, "-c", code], check=True)  # noqa: S603
    return time.perf_counter() - began


@functools.cache
def patience() -> float:
    """Return the time after which something hangs [s]."""
    return max(_LEAST, _HANG * start_up("import numpy"))


def fresh(
    code: str,
    *words: str,
    cwd: Path | None = None,
    check: bool = True,
    timeout: float | None = None,
    **environment: str,
) -> "subprocess.CompletedProcess[str]":
    """Run code in a new interpreter to its end and return the process; words are its arguments."""
    return subprocess.run(  # noqa: S603
        [sys.executable, "-c", code, *words],
        env=os.environ | environment,
        cwd=cwd,
        check=check,
        timeout=timeout,
        capture_output=True,
        text=True,
    )
