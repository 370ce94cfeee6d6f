"""Tables as the text that SAP2000 imports."""

from __future__ import annotations

from frames._errors import ModelError

Value = str | float | int | bool
"""What a cell holds."""

Tables = dict[str, list[dict[str, Value]]]
"""Rows by table."""


def text_of(tables: Tables) -> str:
    """Return tables as the text that SAP2000 imports."""
    lines = ["File written by lir-dcfp", " "]
    for name, rows in tables.items():
        lines.append(f'TABLE:  "{name}"')
        lines += ["   " + "   ".join(f"{k}={_text(v)}" for k, v in row.items()) for row in rows]
        lines.append(" ")
    return "\r\n".join([*lines, "END TABLE DATA", ""])


def _text(value: Value) -> str:
    if isinstance(value, bool):
        return "Yes" if value else "No"
    if isinstance(value, float):
        return repr(float(value))
    words = str(value)
    if '"' in words:
        message = f"the name {words!r} has a quotation mark, which SAP2000's text cannot hold"
        raise ModelError(message)
    return f'"{words}"' if not words or " " in words or "=" in words else words
