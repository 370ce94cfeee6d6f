"""How a remedy names an argument of an importer: as in Python, or as in a project's file."""

from __future__ import annotations

from collections.abc import Generator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar

_IN_FILE = ContextVar("_IN_FILE", default=False)
_KEYS = {"at": "bearings_at"}
_UNITS = {"gravity": "m/s2", "mesh": "m", "plate_thickness": "m"}


@contextmanager
def in_project_file() -> Generator[None, None, None]:
    """Let remedies speak the language of a project's file while a model is imported for it."""
    token = _IN_FILE.set(True)
    try:
        yield
    finally:
        _IN_FILE.reset(token)


def argument(name: str, value: object) -> str:
    """Return an argument with its value: ``at=["X"]``, or ``bearings_at = ["X"]`` in a file."""
    if not _IN_FILE.get():
        return f"{name}={_text(value, file=False)}"
    if name in _UNITS:
        value = f"{value:g} {_UNITS[name]}"
    return f"{_KEYS.get(name, name)} = {_text(value, file=True)}"


def in_python(text: str) -> str:
    """Return a remedy that Python alone has, nothing for a project's file."""
    return "" if _IN_FILE.get() else text


def bearing_for(place: str) -> str:
    """Return how a bearing is put in the place of links: by a mapping, or by ``bearings_at``."""
    if _IN_FILE.get():
        return f"{argument('at', [place])}, which puts that of [bearing] there"
    return f'bearing={{"{place}": LIRBearing(...)}}'


def _text(value: object, *, file: bool) -> str:
    if isinstance(value, bool):
        return str(value).lower() if file else str(value)
    if isinstance(value, Mapping):
        pairs = [f'"{k}"{" = " if file else ": "}{_text(v, file=file)}' for k, v in value.items()]
        return f"{{ {', '.join(pairs)} }}" if file else f"{{{', '.join(pairs)}}}"
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(_text(each, file=file) for each in value)}]"
    if value is ...:
        return "..."
    return f'"{value}"' if isinstance(value, str) else f"{value}"
