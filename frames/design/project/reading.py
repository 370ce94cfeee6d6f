"""A project read from its file: every message names file, key, value and remedy."""

from __future__ import annotations

import difflib
import json
import re
import tomllib
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar, get_args

from pydantic import ValidationError

from frames.design._errors import ProjectError
from frames.design.hazard.code_rules import known_names
from frames.design.project.derived import Table, WholeFile
from frames.design.project.schema import project_file
from frames.design.project.source_files import load_extensions

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from frames.design.project.schema import ProjectFile

F = TypeVar("F", bound=WholeFile)

_KINDS = {
    "moment frame",
    "irregular frame",
    "shear building",
    "opensees",
    "sap2000",
    "etabs",
    "Friction",
}
"""Unions in the place of an error, besides its keys, and names of codes."""


def read_project(path: str | Path) -> ProjectFile:
    """Return a project's file, checked."""
    folder = Path(path).parent

    def kind(data: dict[str, Any]) -> type[ProjectFile]:
        load_extensions(data, folder)
        return project_file()

    return read_file(path, kind)


def read_file(
    path: str | Path,
    kind_of: Callable[[dict[str, Any]], type[F]],
    hint: str = "`lir new` shows how",
) -> F:
    """Return a TOML file of a kind, checked as `read_project` does."""
    file = Path(path)
    read: dict[Path, _Read] = {}
    data = _merged(file, hint, read)
    kind = kind_of(data)
    try:
        return kind.model_validate(data).read_from({each: read[each][0] for each in read})
    except ValidationError as cause:
        lines: dict[str, str] = {}  # the first of a key's alternatives
        for error in _told(cause.errors()):
            place = _place(error)
            name = str(_origin(place, read) or file)
            lines.setdefault(".".join(place), _line(name, data, error, kind, hint))
        raise ProjectError("\n".join(lines.values())) from cause


_Read = tuple[bytes, dict[str, Any]]
"""Content of a file, and its tables."""


def _loaded(file: Path, hint: str) -> _Read:
    # A file of TOML; errors of its syntax have their remedy.
    try:
        content = file.read_bytes()
        return content, tomllib.loads(content.decode("utf-8").replace("\r\n", "\n"))
    except OSError as cause:
        msg = f"{_short(file)}: {cause.strerror or cause}: name an existing file, {hint}"
        raise ProjectError(msg) from cause
    except UnicodeDecodeError as cause:
        msg = f"{file} is not text in UTF-8 ({cause}): save it as UTF-8"
        raise ProjectError(msg) from cause
    except tomllib.TOMLDecodeError as cause:
        given = content.decode("utf-8")
        msg = f"{file}: TOML syntax error: {cause}: {_mended(str(cause), given)}"
        raise ProjectError(msg) from cause
    except (ValueError, RecursionError) as cause:  # thousands of digits, or of brackets
        what = "brackets are nested too deep" if isinstance(cause, RecursionError) else cause
        msg = f"{_short(file)} cannot be read: {what}: {_mended('', '')}"
        raise ProjectError(msg) from cause


def _merged(file: Path, hint: str, read: dict[Path, _Read]) -> dict[str, Any]:
    # Tables of a file, each with the keys of the files that it is based on and lacks itself.
    read[file] = _loaded(file, hint)
    own, found = read[file][1], dict[str, Any]()
    names = own.get("based_on", [])
    bases = []
    for name in names if isinstance(names, list) else [names]:
        base = file.parent / str(name)
        if base.parent != file.parent or base in read or not base.is_file():
            why = "has been read" if base in read else "is no file of this folder"
            msg = f'{file}: based_on = "{name}" {why}: name another one, or leave it out'
            raise ProjectError(msg)
        bases.append(_merged(base, hint, read))
    for tables in (*bases, own):
        for key, given in tables.items():
            known = found.get(key)
            if isinstance(given, dict) and isinstance(known, dict):
                found[key] = {**known, **given}
            else:
                found[key] = given
    return found


def _origin(place: Sequence[str], read: Mapping[Path, _Read]) -> Path | None:
    # The file that a key is from, the first of those that have it.
    for path, (_, data) in read.items():
        table = data.get(place[0]) if place else None
        if isinstance(table, dict) and place[1:]:
            table = table.get(place[1])
        if table is not None:
            return path
    return None


def _short(text: object) -> str:
    # A path or a value in a message: a long one without its middle.
    whole = str(text)
    return whole if len(whole) <= _LONGEST else f"{whole[:60]}...{whole[-60:]}"


_LONGEST = 300  # characters of a path or a value in a message
_KEYS = 9  # at most, in a message on an unknown one


def _told(errors: Sequence[Any]) -> list[Any]:
    # Errors without those of a table whose keys have errors: the other alternative was not meant. A
    # list whose entries have errors has no wrong number of them, an unknown code no spectrum.
    inside = {tuple(_place(error)[:-1]) for error in errors if _place(error)}
    no_code = any(_place(error) == ["project", "code"] for error in errors)

    def is_told_elsewhere(error: Any) -> bool:
        place, kind = tuple(_place(error)), error["type"]
        if no_code and place == ("spectrum",) and kind.startswith("union_tag"):
            return True
        return place in inside and (isinstance(error["input"], dict) or kind in _LENGTHS)

    return [error for error in errors if not is_told_elsewhere(error) or error["type"] == "missing"]


def _mended(error: str, text: str) -> str:
    # Remedy for an error of syntax.
    line = re.search(r"at line (\d+)", error)
    written = text.splitlines()[int(line[1]) - 1 :][:1] if line else []
    if written and (comma := re.search(r"=\s*(\d+),(\d+)\s*(?:#|$)", written[0])):
        return f"write decimals with a point, {comma[1]}.{comma[2]}"
    if "overwrite" in error or "twice" in error:
        return "the key or the section occurs twice: keep one of them"
    return 'write `key = value`, with texts and numbers with a unit in quotes, "250 mm"'


def schema() -> str:
    """Return the JSON schema of a project's file, for editors."""
    return json.dumps(project_file().model_json_schema(), indent=2)


def _place(error: Any) -> list[str]:
    # For a key with one value or two, the alternative that was tried ends with a bracket.
    ways = {*_KINDS, *known_names()}
    return [str(p) for p in error["loc"] if p not in ways and not str(p).endswith("]")]


def _line(name: str, data: dict[str, Any], error: Any, whole: type[Table], hint: str) -> str:
    place = _place(error)
    key, kind = ".".join(place) or "the file", error["type"]
    if kind == "missing":
        return f"{name}: {key} is missing: write it, {hint}"
    if kind == "extra_forbidden":
        known = _known(data, error["loc"], whole)
        near = difflib.get_close_matches(place[-1], _lacking(data, place, known), n=1)
        likely = difflib.get_close_matches(place[-1], known, n=_KEYS, cutoff=0.0)
        others = f" (`lir schema` lists {len(known)})" if len(known) > _KEYS else ""
        meant = f": leave it out, or write one of {', '.join(sorted(likely))}{others}"
        if near:
            meant = f'; is "{near[0]}" meant?'
        own = [section for section in _sections_with(place[-1], whole) if section != place[0]]
        if own and len(place) > 1:
            meant = f": it is a key of [{'] and ['.join(own)}]; move it there"
        if len(place) > 1 and place[-1] in whole.model_fields:
            meant = ": it stands alone, before the first section; move it there"
        return f"{name}: {key} is not known{meant}"
    if kind.startswith("union_tag"):
        return _of_a_kind(name, key, error)
    if kind in _LISTS:
        given = _short(json.dumps(error["input"], default=str))
        entries = "0.8, 1.3" if _first_number(error["input"]) == "" else f"{given}, {given}"
        return f"{name}: {key} = {given} must be a list: write it in brackets, [{entries}]"
    if kind in _LENGTHS:
        held = error["ctx"].get("max_length", error["ctx"].get("min_length"))
        bound = "at most" if kind == "too_long" else "at least"
        return f"{name}: {key} has {error['ctx']['actual_length']} entries: write {bound} {held}"
    if kind in _TABLES and place[-1].isdigit():
        listed = ".".join(place[:-1])
        return f"{name}: {key} must be a table: write [[{listed}]] and its keys below for each"
    if kind in _TABLES:
        return f"{name}: {key} must be a table: write [{key}] and its keys below, {hint}"
    text = error["msg"].removeprefix("Value error, ").replace("Input should", "must")
    if kind in _BOUNDS:
        text = _beyond(error)
    if kind == "float_parsing":
        text = f"must be a pure number, without quotes and unit{_first_number(error['input'])}"
    value = error["input"]
    if isinstance(value, (dict, list)):
        return f"{name}: {key}: {text}" if place else f"{name}: {text}"
    return f"{name}: {key} = {_short(json.dumps(value, default=str))} {text[0].lower()}{text[1:]}"


_BOUNDS = {
    "greater_than": "above",
    "greater_than_equal": "at least",
    "less_than": "below",
    "less_than_equal": "at most",
}
"""Kinds of errors of numbers out of their bounds, in words."""


def _beyond(error: Any) -> str:
    # Bound of the value, and the probable meaning.
    bound, value = next(iter(error["ctx"].values())), error["input"]
    text = f"must be {_BOUNDS[error['type']]} {bound:g}"
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if number and error["type"].startswith("less") and bound <= 1.0 < value <= 100.0 * bound:
        return f'{text}: write {value / 100.0:g}, or "{value:g} %" if per cent are meant'
    return f"{text}: write a number within that bound"


def _first_number(given: object) -> str:
    # The correct form; empty if there is none.
    found = re.match(r"\s*(-?\d+(?:\.\d+)?)", str(given))
    return f": write {found[1]}" if found else ""


def _sections_with(key: str, whole: type[Table]) -> list[str]:
    # Sections that have a key, of those with one table.
    tables = {name: _section(field.annotation, {}) for name, field in whole.model_fields.items()}
    return [name for name, table in tables.items() if key in getattr(table, "model_fields", {})]


_LISTS = {"tuple_type", "list_type"}
"""Kinds of errors if a list was expected."""

_LENGTHS = {"too_long", "too_short"}
"""Kinds of errors for a list with more or fewer entries."""

_TABLES = {"model_type", "model_attributes_type", "dict_type"}
"""Kinds of errors if a section was expected."""


def _of_a_kind(name: str, key: str, error: Any) -> str:
    # A section whose kind, or code, is missing or not known.
    told = error.get("ctx", {})
    which = str(told.get("discriminator", "kind")).strip("'")
    where = "project.code" if which == "code" else f"{key}.{which}"
    known = told.get(
        "expected_tags", "'moment frame', 'irregular frame', 'shear building', 'opensees'"
    )
    choices = str(known).replace("'", '"')
    if "tag" in told:
        return f'{name}: {where} = "{told["tag"]}" is not known: choose one of {choices}'
    return f"{name}: {where} is missing: choose one of {choices}"


def _lacking(data: dict[str, Any], place: Sequence[str], known: Sequence[str]) -> list[str]:
    # Keys that a section accepts and does not have yet.
    section: Any = data
    for part in place[:-1]:
        section = section.get(part, {}) if isinstance(section, dict) else {}
    return [key for key in known if key not in section]


def _known(data: dict[str, Any], place: Sequence[Any], whole: type[Table]) -> list[str]:
    # Keys of the section with an unknown one.
    model, annotation = whole, None
    for part in place[:-1]:
        if str(part).endswith("]"):  # the alternative in which a value was given
            model = _named(annotation, str(part).strip("[]")) or model
            continue
        field = model.model_fields.get(part)
        if field is not None:
            annotation = field.annotation
            found = _section(annotation, data.get(part, {}), place)
            model = found if hasattr(found, "model_fields") else model
    return sorted(
        set(model.model_fields) - {"code"} if place[0] == "spectrum" else model.model_fields
    )


def _named(annotation: Any, name: str) -> Any:
    # The table of a name among the alternatives of an annotation.
    if getattr(annotation, "__name__", "") == name and hasattr(annotation, "model_fields"):
        return annotation
    ways = (_named(part, name) for part in get_args(annotation))
    return next((way for way in ways if way), None)


def _section(annotation: Any, given: Any, place: Sequence[Any] = ()) -> Any:
    # The class of a section: of several, the one of its kind, or of the code in an error's place.
    every = getattr(annotation, "__args__", (annotation,))
    parts = [one for one in every if isinstance(one, type) and hasattr(one, "model_fields")]
    for one in parts:
        keys: Any = getattr(one, "model_fields", {})
        kinds, codes = (get_args(keys[k].annotation) if k in keys else () for k in ("kind", "code"))
        if given.get("kind") in kinds or set(codes) & set(place):
            return one
    return parts[0] if parts else annotation
