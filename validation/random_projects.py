"""Random projects: files with errors put into them, and sound ones, for `lir check` and `lir run`.

    python -m validation.random_projects --seed 1 --count 200 --workers 2
    python -m validation.random_projects --seed 1 --only 17

Project `number` of the series `seed` is always the same one. Most have one thing wrong, or two: a
unit, a thousandfold value, a key that is missing, misspelled, doubled or swapped with another,
sections in another order, a motion's file that cannot be read. Each must end in a message that says
what is wrong, with the documented exit code, or in numbers: of those that `lir check` takes, one
motion is run and tests/golden/recompute.py, which imports nothing of the packages, must find every
number again.
"""

from __future__ import annotations

import argparse
import math
import re
import tempfile
from collections import Counter
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from typer.testing import CliRunner

from frames.command.app import app
from validation.fuzzing.pool import in_children
from validation.golden_review import recomputed

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

Document = dict[str, dict[str, Any]]

LIMIT = 300.0
"""Longest time for a project [s]."""

_UNITS = ("m", "mm", "kN", "MPa", "t", "s", "kg/m2", "%", "m/s2", "stones")
_QUANTITY = re.compile(r"^([-+0-9.e]+) (\S+)$")
_DT, _SECONDS = 0.01, 4.0
_FINE = 0.2  # share of the projects in which nothing is put wrong
_TWICE = 0.15  # share of the others in which two things are


class Outcome(NamedTuple):
    """What became of a project.

    Attributes
    ----------
    number : int
        Of the project.
    wrong : str
        What was put wrong, in words.
    outcome : str
        "refused", "checked", "run", or what was found: "traceback", "exit code", "no remedy",
        "not a number", "disagrees", "hang", "crash".
    words : str
        The message, or what was found.
    """

    number: int
    wrong: str
    outcome: str
    words: str


_LOADED = 0.4
"""Share of the moment frames of ASCE 7-22 whose floors have pressures in place of masses."""

FINDINGS = (
    "traceback",
    "exit code",
    "no remedy",
    "not a number",
    "disagrees",
    "hang",
    "crash",
    "strange",
)
"""Outcomes that are defects."""


def sound(rng: np.random.Generator) -> Document:
    """Return a project that can be run, of a random code and structure.

    Parameters
    ----------
    rng : numpy.random.Generator
        Chooses.

    Returns
    -------
    dict of str to dict
        Sections of the file.
    """
    code = str(rng.choice(["ASCE 7-22", "EN 1998", "NCh2745"]))
    frame = rng.random() < 0.5
    structure: dict[str, Any] = {
        "kind": "moment frame" if frame else "shear building",
        "bays": [int(rng.integers(1, 3)), int(rng.integers(1, 3))],
        "bay_width": ["6 m", f"{rng.uniform(4.5, 7.0):.1f} m"],
        "storey_height": f"{rng.uniform(3.0, 4.0):.2f} m",
    }
    if frame:
        structure |= {
            "storeys": int(rng.integers(1, 3)),
            "floor_load": f"{rng.uniform(600.0, 1200.0):.0f} kg/m2",
            "columns": {"box": ["400 mm", "25 mm"], "material": "A992"},
            "beams": {"i_shape": ["550 mm", "220 mm", "20 mm", "12 mm"]},
            "base_beams": {"i_shape": ["800 mm", "300 mm", "30 mm", "16 mm"]},
        }
    else:
        structure |= {
            "storey_mass": ["120 t", "110 t"],
            "storey_stiffness": ["400 kN/mm", "300 kN/mm"],
        }
    counted = frame and code == "ASCE 7-22"  # whose combinations the recomputation has
    loads = _loads(rng) if counted and rng.random() < _LOADED else None
    if loads is not None:
        del structure["floor_load"]
        structure |= _stiffened(rng, structure)
    if rng.random() < 0.5:
        structure["eccentricity"] = [0.05, round(float(rng.uniform(0.0, 0.1)), 3)]
    radius, height = round(float(rng.uniform(1.2, 2.4)), 2), round(float(rng.uniform(160, 240)))
    friction = round(float(rng.uniform(0.03, 0.07)), 3)
    found: Document = {
        "project": {"name": "Random", "code": code},
        "structure": structure,
        **({} if loads is None else {"loads": loads}),
        "superstructure": {"R": 5.0, "importance": 1.0},
        "spectrum": {
            "ASCE 7-22": {"s_ms": 1.0, "s_m1": 0.5},
            "EN 1998": {"a_g": "2.5 m/s2", "ground_type": "B", "kind": 1},
            "NCh2745": {"soil": "II", "zone": 2},
        }[code],
        "motions": {"folder": "motions", "scale": round(float(rng.uniform(0.5, 1.5)), 2)},
        "bearing": {
            "radius": f"{radius:g} m",
            "slider_height": f"{height} mm",
            "slider_radius": "150 mm",
            "capacity": f"{rng.uniform(180.0, 260.0):.0f} mm",
            "friction": friction,
            "interface_friction": round(2.0 * friction + 0.04, 3),
        },
        "bounds": {"friction": [0.8, 1.25], "interface": [0.9, 1.1]},
        "limits": {"rim_strength": "3 MN", "interface_pressure": "80 MPa"},
        "analysis": {
            "level": "pendulum",
            "histories": "all",
            "uplift_allowed": True,
            "accidental_eccentricity": "none",  # the recomputation has the runs as they are
            "bounds": ["lower", "upper"],
        },
    }
    if rng.random() < 0.3:
        found["bearing"]["friction"] = {"f_max": friction, "f_min": 0.02, "rate": "80 s/m"}
    return found


def _loads(rng: np.random.Generator) -> dict[str, Any]:
    # Pressures of floors in place of their mass: dead load alone, of which the recomputation knows
    # the combinations.
    found: dict[str, Any] = {"dead": f"{rng.uniform(6.0, 11.0):.2f} kN/m2"}
    if rng.random() < 0.5:
        found["facade"] = f"{rng.uniform(1.0, 8.0):.1f} kN/m"
    if rng.random() < 0.3:
        found["span"] = str(rng.choice(["x", "y"]))
    return found


def _stiffened(rng: np.random.Generator, structure: dict[str, Any]) -> dict[str, Any]:
    # A wall at one side, or braces at the other.
    n = structure["bays"][0]
    if rng.random() < 0.3:
        wall = {"between": ["0-0", "0-1"], "thickness": "200 mm", "material": "C30/37"}
        return {"walls": [wall]}
    if rng.random() < 0.3:
        rods = {"between": [f"{n}-0", f"{n}-1"], "circle": ["150 mm", "8 mm"], "material": "S355"}
        return {"braces": [rods]}
    return {}


def _quantities(document: Document) -> list[tuple[str, str, int | None]]:
    # Section, key and place of all values with a unit.
    found: list[tuple[str, str, int | None]] = []
    for section, keys in document.items():
        for key, value in keys.items():
            each = value if isinstance(value, list) else [value]
            for k, one in enumerate(each):
                if isinstance(one, str) and _QUANTITY.match(one):
                    found.append((section, key, k if isinstance(value, list) else None))
    return found


def _numbers(document: Document) -> list[tuple[str, str]]:
    return [
        (section, key)
        for section, keys in document.items()
        for key, value in keys.items()
        if isinstance(value, (int, float)) and not isinstance(value, bool)
    ]


def _choice(rng: np.random.Generator, each: Sequence[Any]) -> Any:
    return each[int(rng.integers(len(each)))]


def _put(document: Document, place: tuple[str, str, int | None], new: Any) -> None:
    section, key, k = place
    if k is None:
        document[section][key] = new
    else:
        document[section][key][k] = new


def _got(document: Document, place: tuple[str, str, int | None]) -> str:
    section, key, k = place
    value = document[section][key]
    return str(value if k is None else value[k])


def another_unit(document: Document, rng: np.random.Generator) -> str:
    """Give a value another unit."""
    place = _choice(rng, _quantities(document))
    number, unit = _got(document, place).split(" ")
    other = _choice(rng, [u for u in _UNITS if u != unit])
    _put(document, place, f"{number} {other}")
    return f"{place[0]}.{place[1]}: {unit} is {other}"


def no_unit(document: Document, rng: np.random.Generator) -> str:
    """Leave a unit out."""
    place = _choice(rng, _quantities(document))
    _put(document, place, float(_got(document, place).split(" ")[0]))
    return f"{place[0]}.{place[1]}: no unit"


def thousandfold(document: Document, rng: np.random.Generator) -> str:
    """Take a value a thousand times, a thousandth, or its negative."""
    factor = _choice(rng, [1e3, 1e-3, -1.0, 0.0])
    if rng.random() < 0.3:
        section, key = _choice(rng, _numbers(document))
        document[section][key] = factor * document[section][key]
        return f"{section}.{key}: times {factor:g}"
    place = _choice(rng, _quantities(document))
    number, unit = _got(document, place).split(" ")
    _put(document, place, f"{factor * float(number):g} {unit}")
    return f"{place[0]}.{place[1]}: times {factor:g}"


def not_finite(document: Document, rng: np.random.Generator) -> str:
    """Make a number infinite or none."""
    word = _choice(rng, [math.inf, math.nan])
    if rng.random() < 0.5:
        section, key = _choice(rng, _numbers(document))
        document[section][key] = word
        return f"{section}.{key}: {word}"
    place = _choice(rng, _quantities(document))
    _put(document, place, f"{word} {_got(document, place).split(' ')[1]}")
    return f"{place[0]}.{place[1]}: {word}"


def missing_key(document: Document, rng: np.random.Generator) -> str:
    """Leave a key out."""
    section = _choice(rng, [name for name in document if document[name]])
    key = _choice(rng, list(document[section]))
    del document[section][key]
    return f"{section}.{key}: missing"


def missing_section(document: Document, rng: np.random.Generator) -> str:
    """Leave a section out."""
    section = _choice(rng, list(document))
    del document[section]
    return f"{section}: missing"


def misspelled(document: Document, rng: np.random.Generator) -> str:
    """Change a letter of a key."""
    section = _choice(rng, [name for name in document if document[name]])
    key = _choice(rng, list(document[section]))
    k = int(rng.integers(len(key)))
    other = key[:k] + _choice(rng, "abcxyz") + key[k + 1 :]
    document[section] = {(other if n == key else n): v for n, v in document[section].items()}
    return f"{section}.{key}: {other}"


def doubled(document: Document, rng: np.random.Generator) -> str:
    """Have a key twice, once with another value."""
    section = _choice(rng, [name for name in document if document[name]])
    key = _choice(rng, list(document[section]))
    document[section][f"{key} "] = document[section][key]  # written without the space
    return f"{section}.{key}: twice"


def swapped(document: Document, rng: np.random.Generator) -> str:
    """Swap two values of a section."""
    section = _choice(rng, [name for name in document if len(document[name]) > 1])
    one, two = rng.choice(list(document[section]), 2, replace=False)
    keys = document[section]
    keys[one], keys[two] = keys[two], keys[one]
    return f"{section}: {one} and {two} swapped"


def turned_bounds(document: Document, rng: np.random.Generator) -> str:
    """Swap the lower and upper bound friction properties."""
    key = _choice(rng, list(document["bounds"]))
    document["bounds"][key] = document["bounds"][key][::-1]
    return f"bounds.{key}: upper before lower"


def another_kind(document: Document, rng: np.random.Generator) -> str:
    """Put a value of another kind."""
    section = _choice(rng, [name for name in document if document[name]])
    key = _choice(rng, list(document[section]))
    document[section][key] = _choice(rng, [[], "", True, {"a": 1}, -3, "1 m 2 m", [1, 2, 3, 4]])
    return f"{section}.{key}: {document[section][key]!r}"


def another_order(document: Document, rng: np.random.Generator) -> str:
    """Write sections and keys in another order, which must not matter."""
    sections = list(document)
    rng.shuffle(sections)
    turned = {name: dict(reversed(document[name].items())) for name in sections}
    document.clear()
    document.update(turned)
    return "order"


def another_code(document: Document, rng: np.random.Generator) -> str:
    """Name another code than the spectrum is of."""
    own = document["project"]["code"]
    codes = ["ASCE 7-22", "EN 1998", "NCh2745", "ASCE 7-16", "eurocode 8"]
    document["project"]["code"] = _choice(rng, [c for c in codes if c != own])
    return f"project.code: {document['project']['code']} for {own}"


def bad_motion(document: Document, rng: np.random.Generator) -> str:
    """Ask for a motion that cannot be: `motion_files` writes it."""
    kinds = ("no file", "a word", "nan", "empty", "unit", "no dt", "no table", "still", "in g")
    kind = str(_choice(rng, kinds))
    document["motions"]["spoilt "] = kind
    return f"motions: {kind}"


MUTATIONS: tuple[Callable[[Document, np.random.Generator], str], ...] = (
    another_unit,
    no_unit,
    thousandfold,
    thousandfold,
    thousandfold,
    not_finite,
    missing_key,
    missing_section,
    misspelled,
    doubled,
    swapped,
    turned_bounds,
    another_kind,
    another_order,
    another_code,
    bad_motion,
)
"""What can be put wrong; what stands several times is chosen as often."""


def random_project(seed: int, number: int) -> tuple[Document, str]:
    """Return a project and what was put wrong in it.

    Parameters
    ----------
    seed, number : int
        Series and place in it.

    Returns
    -------
    dict, str
        Sections, and words; "" where nothing is wrong.
    """
    rng = np.random.default_rng([seed, number])
    document = sound(rng)
    if rng.random() < _FINE:
        return document, ""
    times = 2 if rng.random() < _TWICE else 1
    words = []
    for _ in range(times):
        mutate = MUTATIONS[int(rng.integers(len(MUTATIONS)))]
        with suppress(KeyError, IndexError, ValueError, TypeError):  # what it changes is gone
            words.append(mutate(document, rng))
    return document, "; ".join(words)


def written(document: Document) -> str:
    """Return a project as TOML.

    Parameters
    ----------
    document : dict
        Sections; a key that ends in a space is written without it: a second time.

    Returns
    -------
    str
        The file.
    """
    lines = []
    for section, keys in document.items():
        lines.append(f"[{section}]")
        lines += (f"{key.strip()} = {_toml(v)}" for key, v in keys.items() if key != "spoilt ")
    return "\n".join(lines) + "\n"


def _toml(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, list):
        return f"[{', '.join(map(_toml, value))}]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{k} = {_toml(v)}" for k, v in value.items()) + "}"
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        return f"{value:.1f}"
    return f'"{value}"' if isinstance(value, str) else str(value)


def motion_files(folder: Path, spoilt: str) -> None:
    """Write one short motion and its table.

    Parameters
    ----------
    folder : Path
        Made.
    spoilt : str
        What is wrong of it; "" for nothing.
    """
    folder.mkdir(parents=True)
    time = np.arange(0.0, _SECONDS, _DT)
    bell = np.sin(np.pi * time / _SECONDS) ** 2
    unit = {"unit": "m/s"}.get(spoilt, "m/s2")
    for axis, size, period in (("x", 1.6, 1.9), ("y", 1.0, 1.3)):
        values = size * bell * np.sin(2.0 * np.pi * time / period)
        values = 0.0 * values if spoilt == "still" else values
        lines = [f"{9.80665 * v if spoilt == 'in g' else v:.6e}" for v in values]
        if spoilt in {"a word", "nan"}:
            lines[40] = {"a word": "gap", "nan": "nan"}[spoilt]
        if spoilt != "no file":
            text = "" if spoilt == "empty" else "\n".join(lines) + "\n"
            (folder / f"one-{axis}.txt").write_text(text, encoding="utf-8")
    step = "" if spoilt == "no dt" else f"{_DT:g}"
    table = f"name,x,y,dt,unit\none,one-x.txt,one-y.txt,{step},{unit}\n"
    if spoilt != "no table":
        (folder / "motions.csv").write_text(table, encoding="utf-8")


def perform(number: int, *, seed: int, most: float = 1.0) -> Outcome:
    """Check a project, run it where it can be, and judge what comes out.

    Parameters
    ----------
    number, seed : int
        Place and series.
    most : float
        Share of the projects that `lir check` takes that are run as well.

    Returns
    -------
    Outcome
        What became of it.
    """
    document, wrong = random_project(seed, number)
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        (folder / "project.toml").write_text(written(document), encoding="utf-8")
        motion_files(folder / "motions", str(document.get("motions", {}).get("spoilt ", "")))
        outcome, words = _judged(folder, wrong, runs=(number % 100) < 100.0 * most)
    return Outcome(number, wrong, outcome, words)


def _judged(folder: Path, wrong: str, *, runs: bool) -> tuple[str, str]:
    file = folder / "project.toml"
    done = CliRunner().invoke(app, ["check", str(file)])
    found = _of_command(done, wrong)
    if found is not None or not runs:
        return found or ("checked", "")
    results = folder / "results"
    done = CliRunner().invoke(app, ["run", "--no-figures", str(file), "--results", str(results)])
    found = _of_command(done, wrong)
    if found is not None:
        return found
    if 'histories = "all"' not in file.read_text(encoding="utf-8"):
        return "run", "histories were not kept"
    review = recomputed(folder)
    if review.bad:
        return "disagrees", " | ".join(review.bad[0])
    return "run", f"{sum(review.counts.values())} numbers; {done.stderr.strip()[-200:]}"


def _of_command(done: Any, wrong: str) -> tuple[str, str] | None:
    # What a command's end says, None where it gave numbers.
    said = " ".join(done.stderr.split())
    if done.exception is not None and not isinstance(done.exception, SystemExit):
        return "traceback", f"{type(done.exception).__name__}: {done.exception}"
    if "Traceback" in said:
        return "traceback", said
    if done.exit_code in {0, 1}:
        shown = re.search(r"\b(nan|NaN)\b", done.stdout)
        return ("not a number", done.stdout[max(0, shown.start() - 100) :]) if shown else None
    if done.exit_code not in {2, 3}:
        return "exit code", f"{done.exit_code}: {said}"
    return ("refused", said) if _tells(said, wrong) else ("no remedy", said)


def _tells(said: str, wrong: str) -> bool:
    # Whether a message begins as one, and names what was put wrong or its section.
    if not said.startswith(("error:", "warning:")) or ":" not in said[6:]:
        return False
    named = re.findall(r"[A-Za-z_0-9]{2,}", wrong.replace("spoilt", ""))
    if re.search(r"TOML syntax error: .*line \d+.*\): ", said):
        return True
    return not wrong or any(word.lower() in said.lower() for word in named)


def table(found: Sequence[Outcome]) -> str:
    """Return how often each kind of error ended how.

    Parameters
    ----------
    found : sequence of Outcome
        Of all projects.

    Returns
    -------
    str
        A row a kind of outcome, with an example; then all findings.
    """
    counts = Counter(one.outcome for one in found)
    lines = [f"{len(found)} projects"]
    for outcome, count in counts.most_common():
        lines.append(f"  {outcome:14}{count:5d}")
    quiet = [o for o in found if o.outcome in {"run", "checked"} and o.wrong]
    lines += [f"taken with something wrong: {len(quiet)}"]
    lines += [f"  {o.number}: {o.wrong}: {o.words}" for o in quiet]
    lines += [
        f"FINDING {o.outcome}, project {o.number} ({o.wrong}): {o.words[:600]}"
        for o in found
        if o.outcome in FINDINGS
    ]
    return "\n".join(lines)


def main(given: Sequence[str] | None = None) -> int:
    """Run the series, print the table; return 1 where there is a finding."""
    parser = argparse.ArgumentParser(prog="python -m validation.random_projects")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument("--most", type=float, default=1.0, help="share of sound ones to be run")
    parser.add_argument("--only", type=int, metavar="NUMBER")
    chosen = parser.parse_args(given)
    if chosen.only is not None:
        print(written(random_project(chosen.seed, chosen.only)[0]))
        print(perform(chosen.only, seed=chosen.seed))
        return 0
    found = []
    task = partial(perform, seed=chosen.seed, most=chosen.most)
    for number, result, how in in_children(task, range(chosen.count), chosen.workers, LIMIT):
        wrong = random_project(chosen.seed, number)[1]
        found.append(Outcome(number, wrong, how, "") if how else result)
        if found[-1].outcome in FINDINGS:
            print(found[-1], flush=True)
    found.sort(key=lambda one: one.number)
    print(table(found))
    return int(any(one.outcome in FINDINGS for one in found))


if __name__ == "__main__":
    raise SystemExit(main())
