"""The cover of a report: who, when, by which codes, with which programs, of which input."""

from __future__ import annotations

import hashlib
import importlib.metadata
import platform
from datetime import UTC, datetime
from typing import TYPE_CHECKING, NamedTuple

from markupsafe import Markup

from frames.design.codes.registry import code_named
from lir_element.results.dataset import package_version

if TYPE_CHECKING:
    from frames.design.project.design_run import ProjectRun

_LIBRARIES = ("numpy", "scipy", "numba", "xarray", "matplotlib")
_SHORT = 12  # letters of a digest in the foot of a page


class Cover(NamedTuple):
    """What stands on the cover and in the margins.

    Attributes
    ----------
    people : list of (str, str)
        Client, engineer, checker; empty where they are to sign.
    issue : list of (str, str)
        Revision and date; empty where they were left out.
    codes : list of (str, str, str)
        Code and title.
    programs : list of (str, str)
        Program and main libraries with their versions, Python, system.
    digest : str
        SHA-256 of the project's file.
    motions : str
        Digest of the accelerations as they were run.
    written : str
        When.
    """

    people: list[tuple[str, str]]
    issue: list[tuple[str, str]]
    codes: list[tuple[str, str, str]]
    programs: list[tuple[str, str]]
    digest: str
    motions: str
    written: str

    @property
    def short(self) -> str:
        """The digest as it stands in the foot of a page."""
        return self.digest[:_SHORT]


def cover_of(run: ProjectRun, source: str) -> Cover:
    """Return the cover of a run's report.

    Parameters
    ----------
    run : ProjectRun
        The run.
    source : str
        Text of the project's file.

    Returns
    -------
    Cover
        What it says.
    """
    about = run.about
    code = code_named(run.equivalent.code)
    return Cover(
        people=[
            ("client", about.client),
            ("engineer", about.engineer),
            ("checker", about.checker),
        ],
        issue=[("revision", about.revision), ("date", str(about.date))],
        codes=[(code.name, code.title, code.edition)],
        programs=[
            ("lir-dcfp", package_version()),
            ("Python", platform.python_version()),
            *((name, importlib.metadata.version(name)) for name in _LIBRARIES),
            ("system", f"{platform.system()} {platform.machine()}"),
        ],
        digest=hashlib.sha256(source.encode("utf-8")).hexdigest(),
        motions=str(run.inputs.get("motions", "")),
        written=datetime.now(tz=UTC).strftime("%Y-%m-%d %H:%M UTC"),
    )


def css_string(text: str) -> Markup:
    """Return a text as a string of a style sheet inside a page, quotes included.

    Parameters
    ----------
    text : str
        Any text.

    Returns
    -------
    Markup
        Letters with a meaning in HTML or CSS are escaped by their number.
    """
    plain = " ".join(text.split())
    safe = "".join(c if c.isalnum() or c in " .,:;/-_()" else f"\\{ord(c):x} " for c in plain)
    return Markup(f'"{safe}"')  # noqa: S704  (nothing is left that ends a string or a tag)
