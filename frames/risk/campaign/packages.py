"""What campaigns need that comes with the extra `campaign`."""

from __future__ import annotations

from importlib.util import find_spec


def lacking_packages(*needed: str) -> str:
    """Return what is missing and how to install it, in a sentence; nothing where all is there."""
    missing = [name for name in needed or ("filelock",) if find_spec(name) is None]
    if not missing:
        return ""
    return f"campaigns need {' and '.join(missing)}: pip install 'lir-dcfp[campaign]'"
