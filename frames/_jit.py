"""The kernel decorator of this package; its cache also depends on the bearing's sources."""

from __future__ import annotations

from pathlib import Path

import lir_element
from lir_element._compile.cache import Sources
from lir_element._compile.jit import inlined_before_typing as inlined_before_typing
from lir_element._compile.jit import kernels_of

_SOURCES = Sources(Path(lir_element.__file__).parent, Path(__file__).parent)

kernel = kernels_of(_SOURCES)

inlined_by_llvm = kernels_of(_SOURCES, inline=True)
"""The same for kernels that become part of their callers (see `kernels_of`)."""
