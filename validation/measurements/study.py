"""The study of devices, by another name: `python -m validation.study`."""

from __future__ import annotations

import runpy

if __name__ == "__main__":
    runpy.run_module("validation.study", run_name="__main__", alter_sys=True)
