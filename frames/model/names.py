"""Names of a model's parts: new ones that are free, known ones that exist, and likely ones."""

from __future__ import annotations

import difflib
from collections.abc import Collection

from frames._errors import ModelError
from lir_element.argument_checks import require_type


def new_name(name: str, taken: Collection[str], kind: str) -> str:
    """Accept a name that is not empty and not taken."""
    require_type(f"name of a {kind}", name, str, "a string: write it in quotes")
    if not name.strip():
        message = f"the name of a {kind} is empty: give it at least one visible character"
        raise ModelError(message)
    if name in taken:
        message = f'a {kind} "{name}" exists already: names are unique, choose another one'
        raise ModelError(message)
    return name


def likely(name: object, known: Collection[str]) -> str:
    """Return what the caller may have meant instead of `name`; empty where nothing is known."""
    close = difflib.get_close_matches(str(name), list(known), n=3)
    if close:
        return "did you mean " + " or ".join(f'"{other}"' for other in close) + "?"
    return f'{len(known)} exist, the first is "{next(iter(known))}"' if known else ""


def known_name(name: object, known: Collection[str], kind: str) -> str:
    """Accept a name that exists."""
    if isinstance(name, str) and name in known:
        return name
    hint = likely(name, known) or f"the model has no {kind} yet"
    message = f'there is no {kind} "{name}": add it before it is used ({hint})'
    raise ModelError(message)
