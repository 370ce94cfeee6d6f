"""The old name of `frames.precompile`, for one version: ``python -m frames.precompile``."""

from __future__ import annotations

import warnings

from frames.precompile import main

warnings.warn(
    "frames.ahead is now frames.precompile; the old name goes with version 0.3",
    DeprecationWarning,
    stacklevel=2,
)

if __name__ == "__main__":
    main()
