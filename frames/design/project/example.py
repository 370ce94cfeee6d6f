"""The projects that ``lir new`` writes: a commented file, and motions to try it with."""

from __future__ import annotations

import re
from importlib import resources
from typing import TYPE_CHECKING

from frames.design._errors import ProjectError
from frames.design.codes.registry import ExampleProject, known_codes
from frames.design.hazard.code_rules import canonical
from frames.design.project.artificial_motions import motion_files
from frames.design.project.inputs import ProjectInputs
from frames.design.project.reading import read_project
from frames.results.storage import make_folder, write_whole
from lir_element.argument_checks import require_choice

if TYPE_CHECKING:
    from collections.abc import Mapping
    from importlib.resources.abc import Traversable
    from pathlib import Path

BUILDINGS = {
    "hospital": "six storeys, L-shaped, walls of shells, by an OpenSees script; NCh2745",
    "office": "four storeys of concrete with walls, two types of bearing; EN 1998",
    "near-fault": "eight braced storeys of steel, vertical motion, uplift; ASCE 7-22",
}
"""Whole buildings beside the plain example, and what each shows."""

_WITH_VERTICAL = frozenset({"near-fault"})  # buildings whose motions have a vertical component
_PLAIN = "example.toml"
_KEPT_AS_TEXT = ".txt"  # ending of files of a building that are not Python of this package


def write_example(folder: Path, code: str | None = None, building: str | None = None) -> list[Path]:
    """Write a project's file and artificial motions into a folder.

    The motions are filtered noise with a pulse of velocity in it, weaker across, whose amplitudes
    are brought to the design spectrum: there to try the project with, not to design by.
    """
    texts = _plain(code) if building is None else _building(building, code)
    for name in (*texts, "motions/motions.csv"):  # before the motions are made
        if (folder / name).exists():
            raise FileExistsError(str(folder / name))
    make_folder(folder)
    written = _put(folder, texts)
    parts = ProjectInputs(read_project(written[0]), folder)
    motions = motion_files(parts.spectrum(), vertical=building in _WITH_VERTICAL)
    return [*written, *_put(folder / "motions", motions)]


def _put(folder: Path, texts: Mapping[str, str]) -> list[Path]:
    paths = [folder / name for name in texts]
    for path in paths:
        if path.exists():
            raise FileExistsError(str(path))
    make_folder(folder)
    for path, text in zip(paths, texts.values(), strict=True):
        write_whole(path, text)
    return paths


def _kept() -> Traversable:
    return resources.files("frames.design.project").joinpath("examples")


def _building(name: str, code: str | None) -> dict[str, str]:
    # Its files by name; one that names a code must name its own.
    require_choice("example", name, tuple(BUILDINGS), error=ProjectError)
    kept = sorted(_kept().joinpath(name).iterdir(), key=lambda file: file.name != "project.toml")
    texts = {
        file.name.removesuffix(_KEPT_AS_TEXT): file.read_text(encoding="utf-8") for file in kept
    }
    own = re.search(r'(?m)^code = "([^"]*)"', texts["project.toml"])
    if code is not None and own is not None and canonical(code) != own[1]:
        msg = f'code = "{code}": the example "{name}" is of {own[1]}: leave --code out'
        raise ProjectError(msg)
    return texts


def _plain(code: str | None) -> dict[str, str]:
    # The commented file of ASCE 7-22, its sections replaced.
    known = {each.name: each for each in known_codes() if each.example is not None}
    asked = canonical("ASCE 7-22" if code is None else code)
    require_choice("code", asked, tuple(known), error=ProjectError)
    own = known[asked]
    text = _kept().joinpath(_PLAIN).read_text(encoding="utf-8")
    text = text.replace('code = "ASCE 7-22"', f'code = "{own.name}"')
    chosen = own.example or ExampleProject({}, {})
    for name, content in chosen.sections.items():
        text = re.sub(rf"(?ms)^\[{name}\].*?(?=^\[|\Z)", f"[{name}]\n{content}\n", text)
    return {"project.toml": text}
