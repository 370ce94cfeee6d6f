"""Random errors put into code, one at a time: which tests notice them, of two sets of tests.

    python -m validation.measurements.mutants frames/design --count 30 --seed 1
        --before tests/unit/test_project.py --now tests/unit/test_project.py::test_exports

An error is drawn by its line, so that a long module has more of them than a short one: a comparison
turned round, a sum for a difference, a product for a quotient, a constant changed, `and` for `or`,
the two sides of a choice exchanged, a minimum for a maximum, a statement left out. An error that
`--before` notices and `--now` does not is lost by the change from one to the other.
"""

from __future__ import annotations

import argparse
import ast
import os
import random
import re
import shutil
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from validation.mutations import ROOT, copied, first_failure

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    Node = ast.expr | ast.stmt
    Edit = tuple[int, int, str]
    Place = Callable[[int, int], int]

OTHER = {
    "<": ">=",
    ">": "<=",
    "<=": ">",
    ">=": "<",
    "==": "!=",
    "!=": "==",
    "+": "-",
    "-": "+",
    "*": "/",
    "/": "*",
    "and": "or",
    "or": "and",
    "min": "max",
    "max": "min",
    "minimum": "maximum",
    "maximum": "minimum",
    "argmin": "argmax",
    "argmax": "argmin",
    "any": "all",
    "all": "any",
}
"""What takes the place of an operator or of a function."""
FACTOR = 1.5
"""Of a number that is no integer; to an integer one is added."""


class Mutant(NamedTuple):
    """An error: the expression or statement at a place of a file, and what takes its place."""

    file: str
    line: int
    start: int
    """Of the text, in bytes of the file."""
    was: str
    now: str

    def put(self, source: bytes) -> bytes:
        """Return the file's content with the error, its lines where they were."""
        was = self.was.encode()
        now = f"({self.now})" if self.now != "pass" else "pass" + "\n" * self.was.count("\n")
        return source[: self.start] + now.encode() + source[self.start + len(was) :]


def sites(source: bytes, file: str = "") -> list[Mutant]:
    """Return all errors that can be put into the functions of a module."""
    starts = [0]
    for line in source.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))

    def at(line: int, column: int) -> int:
        return starts[line - 1] + column

    found = []
    for node in _nodes(ast.parse(source)):
        start, end = _from(at, node), _to(at, node)
        was = source[start:end].decode()
        for first, last, new in _edits(node, source, at):
            now = source[start:first].decode() + new + source[last:end].decode()
            found.append(Mutant(file, node.lineno, start, was, now))
    return sorted(found, key=lambda one: (one.start, one.was, one.now))


def _nodes(module: ast.Module) -> Iterator[Node]:
    # Expressions and statements in the bodies of functions, without annotations and texts.
    new: list[ast.AST] = [
        statement
        for function in ast.walk(module)
        if isinstance(function, ast.FunctionDef)
        for statement in function.body
        if not isinstance(statement, ast.FunctionDef | ast.ClassDef)
    ]
    seen: set[ast.AST] = set()
    while new:
        node = new.pop()
        if node in seen or isinstance(
            node, ast.FunctionDef | ast.ClassDef | ast.JoinedStr | ast.Raise | ast.Import
        ):
            continue
        seen.add(node)
        if isinstance(node, ast.expr | ast.stmt):
            yield node
        notes = {getattr(node, "annotation", None)}
        new += [child for child in ast.iter_child_nodes(node) if child not in notes]


def _edits(node: Node, source: bytes, at: Place) -> Iterator[Edit]:
    # Places and new texts that make an error of a node.
    first, last = _from(at, node), _to(at, node)
    match node:
        case ast.BinOp(left, ast.Add() | ast.Sub() | ast.Mult() | ast.Div(), right):
            yield from _operator(left, right, source, at)
        case ast.Compare(left, [_, *_], [right, *_]):
            yield from _operator(left, right, source, at)
        case ast.BoolOp(_, [left, right, *_]):
            yield from _operator(left, right, source, at)
        case ast.Constant(bool() as value):
            yield first, last, str(not value)
        case ast.Constant(int() as value):
            yield first, last, str(value + 1)
        case ast.Constant(float() as value):
            yield first, last, repr(FACTOR * value or 1.0)
        case ast.IfExp(test, body, orelse):
            text = [
                source[_from(at, part) : _to(at, part)].decode() for part in (orelse, test, body)
            ]
            yield first, last, "({}) if ({}) else ({})".format(*text)
        case ast.Call(ast.Name("abs") as called, [_]) | ast.Call(
            ast.Attribute(_, "abs" | "fabs") as called, [_]
        ):
            yield _from(at, called), _to(at, called), ""
        case ast.Call(ast.Name(name) | ast.Attribute(_, name) as called) if name in OTHER:
            yield _to(at, called) - len(name), _to(at, called), OTHER[name]
        case ast.Expr(ast.Call()) | ast.AugAssign():
            yield first, last, "pass"
        case ast.Assign([ast.Subscript() | ast.Attribute()]):
            yield first, last, "pass"


def _from(at: Place, node: Node) -> int:
    return at(node.lineno, node.col_offset)


def _to(at: Place, node: Node) -> int:
    return at(node.end_lineno or node.lineno, node.end_col_offset or 0)


def _operator(left: ast.expr, right: ast.expr, source: bytes, at: Place) -> Iterator[Edit]:
    # The operator between two operands, where it has an opposite.
    first, last = _to(at, left), _from(at, right)
    between = source[first:last].decode()
    found = re.search(
        r"[<>=!]=|[<>+*/-]|\band\b|\bor\b", re.sub(r"#[^\n]*", lambda m: " " * len(m[0]), between)
    )
    if found:
        yield first + found.start(), first + found.end(), OTHER[found[0]]


def drawn(files: Sequence[str], count: int, seed: int, root: Path = ROOT) -> list[Mutant]:
    """Draw errors: a line of those where one is possible, then one of the line's."""
    lines: dict[tuple[str, int], list[Mutant]] = {}
    for path in _modules(files, root):
        name = path.relative_to(root).as_posix()
        for one in sites(path.read_bytes(), name):
            lines.setdefault((name, one.line), []).append(one)
    if count < 1:
        msg = f"count = {count} must be at least 1"
        raise ValueError(msg)
    if count > len(lines):
        msg = f"count = {count} is more than the {len(lines)} lines where an error is possible"
        raise ValueError(msg)
    rng = random.Random(seed)  # noqa: S311  (nothing secret)
    return [rng.choice(lines[line]) for line in rng.sample(sorted(lines), count)]


def _modules(files: Sequence[str], root: Path) -> list[Path]:
    found: set[Path] = set()
    for name in files:
        path = root / name
        if not path.exists():
            msg = f"{name} is not in {root.name}: give modules and folders from its root"
            raise ValueError(msg)
        found |= set(path.rglob("*.py")) if path.is_dir() else {path}
    return sorted(found)


class Tried(NamedTuple):
    """What became of an error: the tests that noticed it, "" where none did."""

    mutant: Mutant
    before: str
    now: str

    @property
    def is_lost(self) -> bool:
        """Whether it was noticed and no longer is."""
        return bool(self.before) and not self.now

    def line(self) -> str:
        """Return it in words."""
        one = self.mutant
        by = f"before {self.before or '-'}; now {self.now or ('LOST' if self.before else '-')}"
        what = " ".join(f"{one.was} -> {one.now}".split())
        return f"{one.file}:{one.line}: {what}: {by}"


def tried(
    mutant: Mutant, before: Sequence[str], now: Sequence[str], copy: Path, longest: float
) -> Tried:
    """Put an error into a copy and run the tests of before, and where one fails those of now."""
    wrong = mutant.put((copy / mutant.file).read_bytes())
    first = first_failure(mutant.file, wrong, before, copy, longest)
    then = first_failure(mutant.file, wrong, now, copy, longest) if first else ""
    return Tried(mutant, first, then)


def require_sound(file: str, tests: Sequence[str], copy: Path, longest: float) -> None:
    """Require that tests pass without an error: else they would notice whatever is put in."""
    sound = (copy / file).read_bytes()
    if failed := first_failure(file, sound, list(dict.fromkeys(tests)), copy, longest):
        msg = f"{failed} fails without an error: give tests that pass, or a larger --longest"
        raise ValueError(msg)


def main(arguments: list[str] | None = None) -> int:
    """Draw errors, print what became of each and return 1 if one is lost."""
    parser = argparse.ArgumentParser(prog="python -m validation.measurements.mutants")
    parser.add_argument("files", nargs="+", help="modules and folders that errors are put into")
    parser.add_argument("--before", nargs="+", required=True, help="tests as they were")
    parser.add_argument("--now", nargs="+", required=True, help="tests as they are")
    parser.add_argument("--count", type=int, default=30, help="errors (30)")
    parser.add_argument("--seed", type=int, default=1, help="of the random numbers (1)")
    parser.add_argument("--longest", type=float, default=600.0, help="seconds for each test (600)")
    chosen = parser.parse_args(arguments)
    given = drawn(chosen.files, chosen.count, chosen.seed)
    found = []
    with tempfile.TemporaryDirectory() as folder:
        copy, kernels = copied(Path(folder) / "copy"), Path(folder) / "kernels"
        os.environ["LIR_CACHE_DIR"] = str(kernels)  # of the tests, which get this environment
        kernels.mkdir()
        require_sound(given[0].file, (*chosen.before, *chosen.now), copy, chosen.longest)
        kept = set(kernels.iterdir())
        for mutant in given:
            found.append(tried(mutant, chosen.before, chosen.now, copy, chosen.longest))
            print(found[-1].line(), flush=True)
            for compiled in set(kernels.iterdir()) - kept:
                shutil.rmtree(compiled, ignore_errors=True)
    lost = sum(one.is_lost for one in found)
    before, now = sum(bool(one.before) for one in found), sum(bool(one.now) for one in found)
    print(f"{len(found)} errors: {before} noticed before, {now} of these now, {lost} lost")
    return int(lost > 0)


if __name__ == "__main__":
    sys.exit(main())
