"""How the packages are built: imports point one way, functions stay short, kernels stay kernels."""

import ast
import functools
import re
import warnings
from pathlib import Path

import pytest

import lir_element
from lir_element._compile.sources import COMPILERS, compiled_sources

ROOT = Path(lir_element.__file__).parents[1]
PACKAGES = ("lir_element", "frames", "validation")
MODULES = sorted(p for name in PACKAGES for p in (ROOT / name).rglob("*.py"))
LONGEST_FUNCTION = 80
MODULE_BUDGET = 350

# A package may import from itself and from those to its right.
ALLOWED = {
    "lir_element": {"lir_element"},
    "frames": {"frames", "lir_element"},
    "validation": set(PACKAGES),
}
KERNELS = [path for path in MODULES if "kernels" in path.relative_to(ROOT).parts]
# Formulas of numbers and of arrays: kernels compile them, results read Datasets by them.
FORMULAS = {"lir_element.formulas", "frames.formulas"}
# What makes pointers of addresses: code generators, which kernels call like kernels.
ADDRESSES = [ROOT / "lir_element/opensees/block/pointers.py"]
FOREIGN = {"numba.carray"}
DECORATORS = {"kernel", "inlined_by_llvm", "inlined_before_typing", "intrinsic", "entry_point"}
BUNDLES = {"lir_element.errors.RunStatus"} | {
    f"lir_element.bundles.contact_data.{name}" for name in ("BodyStep", "Contacts")
}


@functools.cache
def parse(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


@functools.cache
def imported(tree: ast.AST, package: str) -> set[str]:
    """Return the full names of all that is imported."""
    names: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            base = f"{package}.{node.module or ''}" if node.level else node.module or ""
            names |= {f"{base}.{alias.name}" for alias in node.names}
    return names


@functools.cache
def functions(tree: ast.AST) -> list[ast.FunctionDef]:
    return [n for n in ast.walk(tree) if isinstance(n, ast.FunctionDef)]


def is_kernel(function: ast.FunctionDef) -> bool:
    decorators = [d.func if isinstance(d, ast.Call) else d for d in function.decorator_list]
    return any(isinstance(d, ast.Name) and d.id in DECORATORS for d in decorators)


def compiled(path: Path) -> set[str]:
    """Return the names of formulas that a file of kernels compiles: `name = decorator(formula)`."""
    return {
        n.targets[0].id
        for n in parse(path).body
        if isinstance(n, ast.Assign)
        and isinstance(n.targets[0], ast.Name)
        and isinstance(n.value, ast.Call)
        and isinstance(n.value.func, ast.Name)
        and n.value.func.id in DECORATORS
    }


# Rooms of modules alone, from the floor to the roof: each imports from those before it.
FLOORS = (
    "lir_element._compile",
    "lir_element.device",
    "lir_element.bundles",
    "lir_element.kernels.pendulum",
    "lir_element.kernels.contact",
    "lir_element.kernels.rigid_body",
    "lir_element.results",
    "lir_element.rig",
    "lir_element.opensees.block",
    "lir_element.opensees.kernels",
    "lir_element.opensees.in_process",
    "lir_element.opensees.out_of_process",
    "lir_element.opensees.compare",
    "frames.model",
    "frames.motion",
    "frames.assembly",
    "frames.bundles",
    "frames.kernels",
    "frames.results",
    "frames.opensees",
    "frames.statics",
    "frames.library",
    "frames.exchange",
    "frames.recording",
    "frames.solve",
    "frames.batch",
    "frames.plots",
    "frames.viewer",
    "frames.design.calculation",
    "frames.design.hazard",
    "frames.design.codes",
    "frames.design.devices",
    "frames.design.histories",
    "frames.design.testing",
    "frames.design.sizing",
    "frames.design.project",
    "frames.design.report",
    "frames.risk.fragility",
    "frames.risk.campaign",
    "frames.command",
    "validation.opensees",
    "validation.fuzzing",
    "validation.claims",
    "validation.measurements",
    "validation.study",
)


def test_there_is_something_to_check() -> None:
    assert len(MODULES) > 25
    assert sum(is_kernel(f) for path in MODULES for f in functions(parse(path))) > 30


def test_imports_point_one_way() -> None:
    wrong = {}
    for path in MODULES:
        package = path.relative_to(ROOT).parts[0]
        own = {name.split(".")[0] for name in imported(parse(path), package)} & set(PACKAGES)
        if own - ALLOWED[package]:
            wrong[path] = own - ALLOWED[package]
    assert not wrong


def dotted(path: Path) -> str:
    """Return the name by which a file is imported."""
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


@functools.cache
def targets(path: Path) -> set[str]:
    """Return the modules that a module imports, anywhere in it and for annotations, too."""
    names = imported(parse(path), "")
    found = {m for n in names for m in (n, n.rpartition(".")[0]) if m in FILES}
    whole = {m for m in found if m not in names and any(n.startswith(f"{m}.") for n in names)}
    parts = {n.rpartition(".")[0] for n in names & found}
    return (found - (parts & whole)) - {dotted(path)}


@functools.cache
def room(path: Path) -> str:
    """Return the folder, or the module itself where its folder holds rooms."""
    return dotted(path) if holds_rooms(path.parent) else name_of(path.parent)


def name_of(folder: Path) -> str:
    return ".".join(folder.relative_to(ROOT).parts)


@functools.cache
def holds_rooms(folder: Path) -> bool:
    return any(folder in other.parents and other.parent != folder for other in MODULES)


def circles(graph: dict[str, set[str]]) -> list[str]:
    """Return what is left of a graph when, again and again, all that lead nowhere are removed."""
    left = {node: set(after) for node, after in graph.items()}
    while ends := {node for node, after in left.items() if not after & set(left)}:
        left = {node: after for node, after in left.items() if node not in ends}
    return sorted(left)


def test_a_circle_is_found() -> None:
    assert circles({"a": {"b"}, "b": {"c"}, "c": set()}) == []
    assert circles({"a": {"b"}, "b": {"c"}, "c": {"b"}, "d": {"e"}, "e": set()}) == ["a", "b", "c"]


def test_modules_do_not_import_each_other_in_a_circle() -> None:
    assert circles({dotted(path): targets(path) for path in MODULES}) == []


@functools.cache
def room_graph() -> dict[str, set[str]]:
    rooms: dict[str, set[str]] = {room(path): set() for path in MODULES}
    for path in MODULES:
        rooms[room(path)] |= {room(FILES[name]) for name in targets(path)} - {room(path)}
    return rooms


def test_rooms_do_not_import_each_other_in_a_circle() -> None:
    assert circles(room_graph()) == []


def test_rooms_keep_their_direction() -> None:
    graph = room_graph()
    folders = {path.parent for path in MODULES}
    assert {name_of(folder) for folder in folders if not holds_rooms(folder)} == set(FLOORS)
    for k, name in enumerate(FLOORS):
        assert graph[name] & set(FLOORS) <= set(FLOORS[:k]), name


def at_runtime(path: Path) -> ast.Module:
    """Return the module without what only annotations need."""
    body = [
        n
        for n in parse(path).body
        if not (isinstance(n, ast.If) and "TYPE_CHECKING" in ast.dump(n.test))
    ]
    return ast.Module(body, type_ignores=[])


def needed_modules(path: Path) -> set[Path]:
    """Return the files of the packages that a module imports at runtime."""
    names = imported(at_runtime(path), "")
    return {FILES[m] for n in names for m in (n, n.rpartition(".")[0]) if m in FILES}


FILES = {dotted(path): path for path in MODULES}


@pytest.mark.parametrize("path", KERNELS, ids=[dotted(p) for p in KERNELS])
def test_kernels_know_no_classes(path: Path) -> None:
    """Kernel files hold kernels alone; of the packages they import other kernels and constants."""
    tree = at_runtime(path)
    kernels = {
        f"{dotted(other)}.{name}"
        for other in (*KERNELS, *ADDRESSES)
        for name in {*(f.name for f in functions(parse(other)) if is_kernel(f)), *compiled(other)}
    }
    own = {n for n in imported(tree, "") if n.split(".")[0] in PACKAGES}
    named = {n for n in own if n.rsplit(".", 1)[-1].isupper()}
    decorators = {n for n in own if n.split(".")[1] in {"_jit", "_compile"}}
    assert own - named - decorators - kernels <= BUNDLES | FORMULAS
    assert not [n for n in ast.walk(tree) if isinstance(n, ast.ClassDef)]
    assert all(is_kernel(f) for f in functions(tree))
    others = {n for n in imported(tree, "") if n not in own}
    assert others <= {"math", "typing.TYPE_CHECKING", "__future__.annotations", *FOREIGN}
    # no exceptions, no allocation in the step
    forbidden = (ast.Raise, ast.Try, ast.ListComp, ast.Dict, ast.Lambda, ast.JoinedStr)
    assert not [n for n in ast.walk(tree) if isinstance(n, forbidden)]


def test_every_kernel_is_in_a_room_of_kernels() -> None:
    product = [path for path in MODULES if path.relative_to(ROOT).parts[0] in PACKAGES[:2]]
    found = {path for path in product if any(is_kernel(f) for f in functions(parse(path)))}
    assert found <= {*KERNELS, *ADDRESSES}


def test_the_cache_depends_on_all_that_kernels_import() -> None:
    hashed = {path for _, path in compiled_sources(*(ROOT / name for name in PACKAGES[:2]))}
    named = {FILES[name] for path in KERNELS for name in targets(path)}  # by annotations, too
    assert {*KERNELS, *named} <= hashed


def at_import(tree: ast.AST) -> set[str]:
    """Return the names that a module looks up while it is imported: not in bodies of functions."""
    if isinstance(tree, ast.Name):
        return {tree.id}
    skipped = {"body"} if isinstance(tree, ast.FunctionDef | ast.Lambda) else set()
    skipped |= {"annotation", "returns"}  # of which Python makes text
    parts = [part for field, part in ast.iter_fields(tree) if field not in skipped]
    each = [n for part in parts for n in (part if isinstance(part, list) else [part])]
    return {name for n in each if isinstance(n, ast.AST) for name in at_import(n)}


def test_the_cache_depends_on_what_constants_of_kernels_are_made_from() -> None:
    hashed = {path for _, path in compiled_sources(*(ROOT / name for name in PACKAGES[:2]))}
    makers = {ROOT / name / part for name in PACKAGES[:2] for part in COMPILERS}
    for path in hashed - set(KERNELS) - makers:
        tree = at_runtime(path)
        used = at_import(tree)
        names = {n for n in imported(tree, "") if n.rsplit(".", 1)[-1] in used}
        needed = {FILES[m] for n in names for m in (n, n.rpartition(".")[0]) if m in FILES}
        assert needed - {ROOT / name / "__init__.py" for name in PACKAGES} <= hashed, path


def test_names_that_a_module_looks_up_while_it_is_imported_are_found() -> None:
    text = "class A(B):\n    x: C = D\n@e\ndef f(g: H = I) -> J:\n    return K\nL = m(n.o)"
    assert at_import(ast.parse(text)) == {"B", "D", "e", "I", "L", "m", "n", "x"}


def test_functions_are_short() -> None:
    """No function longer than 80 lines, its docstring aside."""
    lengths = {}
    for path in MODULES:
        for f in functions(parse(path)):
            first = f.body[1] if ast.get_docstring(f) and len(f.body) > 1 else f.body[0]
            lengths[f"{dotted(path)}.{f.name}"] = (f.end_lineno or 0) - first.lineno + 1
    assert not {name: n for name, n in lengths.items() if n > LONGEST_FUNCTION}


def test_all_public_names_come_from_the_package() -> None:
    names = {n for n in dir(lir_element) if not n.startswith("_")}  # imported when asked for
    contract = {"LIRBearing", "CoulombFriction", "VelocityFriction", "Element", "cyclic_test"}
    assert contract <= names
    for name in contract:
        assert getattr(lir_element, name).__doc__


def test_module_budget() -> None:
    """A warning list, not a limit: a module far beyond the budget wants splitting."""
    lines = {p: len(p.read_text(encoding="utf-8").splitlines()) for p in MODULES}
    long = {dotted(path): count for path, count in lines.items() if count > MODULE_BUDGET}
    if long:
        with warnings.catch_warnings():
            warnings.simplefilter("always")
            warnings.warn(f"modules over {MODULE_BUDGET} lines: {long}", stacklevel=1)
    assert not {name: n for name, n in long.items() if n > 2 * MODULE_BUDGET}


def test_equations_that_kernels_cite_are_in_the_theory() -> None:
    """A kernel cites (section.number); docs/theory_*.md end that equation's block with it."""
    theory = "".join(p.read_text(encoding="utf-8") for p in (ROOT / "docs").glob("theory_*.md"))
    numbered = re.findall(r"^ *\$\$ \((\d+\.\d+)\)$", theory, flags=re.MULTILINE)
    assert len(numbered) == len(set(numbered)) > 30
    cited = {
        number
        for path in MODULES
        if "kernels" in path.parts
        for line in path.read_text(encoding="utf-8").splitlines()
        for number in re.findall(r"\((\d+\.\d+)\)", line.partition("#")[2])
    }
    assert len(cited) > 20
    assert cited <= set(numbered)
