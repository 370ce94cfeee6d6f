"""Messages of Python in the words of TOML: what the command says, its user can write."""

from __future__ import annotations

import re

_WORDS = tuple(
    (re.compile(pattern), said)
    for pattern, said in (
        (r"\bmath\.inf\b", "inf"),
        (r"\bSection\.rolled_i\b", "i_shape"),
        (r"\bSection\.elastic_modulus\b", "E"),
        (r"\bSection\.(\w+)", r"\1"),
        (r"\b(?:pass|use|give|set|take) (\w+)=None\b", r"leave \1 out"),
        (r"\b([A-Za-z_]\w*)=True\b", r"\1 = true"),
        (r"\b([A-Za-z_]\w*)=False\b", r"\1 = false"),
        (r"\b([A-Za-z_]\w*)=\(([^()]*)\)", r"\1 = [\2]"),
        (r'\b([A-Za-z_]\w*)=("[^"]*"|-?\d[\w.+-]*)', r"\1 = \2"),
        (r"\b([A-Za-z_]\w*)=(?=[\s,;:.)]|$)", r"\1"),
        (r"\bpass (?=\w+ = )", "write "),
        (r"choose one of \(([^()]*?),?\)", r"choose one of \1"),
    )
)


def in_toml(text: str) -> str:
    """Return a message with the remedies of Python as TOML has them.

    Examples
    --------
    >>> in_toml("raise it, or pass allow_weak_interface=True to study such a bearing")
    'raise it, or write allow_weak_interface = true to study such a bearing'
    >>> in_toml("must be below 1, or math.inf; or rims=(bottom, top)")
    'must be below 1, or inf; or rims = [bottom, top]'
    """
    if ".py" in text:
        return text
    for pattern, said in _WORDS:
        text = pattern.sub(said, text)
    return text
