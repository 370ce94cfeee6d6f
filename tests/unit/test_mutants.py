"""Random errors: what is drawn from a source, and what is lost between two sets of tests."""

import ast

import pytest

from validation.measurements.mutants import Mutant, Tried, drawn, require_sound, sites, tried
from validation.mutations import ROOT

SOURCE = '''"""1 + 1."""
LIMIT = 3


def law(x: "1 + 1", y=2 * 3) -> "2 - 1":
    """Not 1 + 1 either."""
    n: "4 + 4" = 5
    kept[n] = abs(x - 0.5)
    total += max(x, y)
    for one in y:  # 7
        say(
            one
        )
    if x < LIMIT and not y:
        raise ValueError(1 + 1)
    return f"{x + 1}" if True else 0.0
'''
EXPECTED = [
    (7, "5", "6"),
    (8, "kept[n] = abs(x - 0.5)", "pass"),
    (8, "abs(x - 0.5)", "(x - 0.5)"),
    (8, "x - 0.5", "x + 0.5"),
    (8, "0.5", "0.75"),
    (9, "total += max(x, y)", "pass"),
    (9, "max(x, y)", "min(x, y)"),
    (11, "say(\n            one\n        )", "pass"),
    (14, "x < LIMIT", "x >= LIMIT"),
    (14, "x < LIMIT and not y", "x < LIMIT or not y"),
    (16, 'f"{x + 1}" if True else 0.0', '(0.0) if (True) else (f"{x + 1}")'),
    (16, "True", "False"),
    (16, "0.0", "1.0"),
]


def test_errors_of_each_kind_and_none_of_what_is_not_computed() -> None:
    found = sites(SOURCE.encode(), "law.py")
    assert sorted((m.line, m.was, m.now) for m in found) == sorted(EXPECTED)
    for m in found:
        wrong = m.put(SOURCE.encode()).decode()
        assert ast.dump(ast.parse(wrong)) != ast.dump(ast.parse(SOURCE))
        assert wrong.count("\n") == SOURCE.count("\n")


def test_an_operator_is_that_of_its_own_operands() -> None:
    """With brackets, a comment that has operators and letters of more than a byte before it."""
    source = (
        "def f(a, b, c):\n    é = 'é'; return (a  # 2 < 3\n        * (b - c)) / c - b\n".encode()
    )
    wrong = {eval_of(m.put(source)) for m in sites(source)}
    a, b, c = 7.0, 5.0, 3.0
    assert wrong == {a / (b - c) / c - b, a * (b + c) / c - b, a * (b - c) * c - b} | {
        a * (b - c) / c + b
    }


def eval_of(source: bytes) -> float:
    known: dict = {}
    exec(compile(source, "f", "exec"), known)  # noqa: S102  (the source above)
    return known["f"](7.0, 5.0, 3.0)


def test_the_same_seed_draws_the_same_errors() -> None:
    files = ["lir_element/kernels/slip.py", "frames/kernels"]
    once = drawn(files, 40, 3)
    assert once == drawn(files, 40, 3) != drawn(files, 40, 4)
    assert len({(m.file, m.line) for m in once}) == 40
    for m in once:
        source = (ROOT / m.file).read_bytes()
        assert source[m.start :].startswith(m.was.encode())
        compile(m.put(source), m.file, "exec")


def test_what_cannot_be_drawn_is_told() -> None:
    with pytest.raises(ValueError, match=r"gone\.py is not in"):
        drawn(["gone.py"], 1, 1)
    with pytest.raises(ValueError, match="count = 0 must be at least 1"):
        drawn(["lir_element/kernels/slip.py"], 0, 1)
    with pytest.raises(ValueError, match="count = 10000 is more than the"):
        drawn(["lir_element/kernels/slip.py"], 10000, 1)


@pytest.mark.nightly
def test_an_error_that_only_the_old_tests_notice_is_lost(tmp_path) -> None:
    source = "def size(x):\n    return abs(x)\n"
    (tmp_path / "sizes.py").write_text(source)
    for name, x in (("old", -1), ("new", 1)):
        (tmp_path / f"test_{name}.py").write_text(
            f"from sizes import size\n\n\ndef test_size():\n    assert size({x}) == 1\n"
        )
    (mutant,) = sites(source.encode(), "sizes.py")
    found = tried(mutant, ["test_old.py"], ["test_new.py"], tmp_path, 60.0)
    assert found == Tried(mutant, "test_old.py::test_size", "")
    assert found.is_lost
    said = "sizes.py:2: abs(x) -> (x): before test_old.py::test_size; now LOST"
    assert found.line() == said
    assert not Tried(mutant, "", "").is_lost
    assert (tmp_path / "sizes.py").read_text() == source


@pytest.mark.nightly
def test_what_takes_too_long_counts_as_noticed(tmp_path) -> None:
    loop = "    while n > 0:\n        sleep(0.01)\n        n -= 1\n"
    source = f"from time import sleep\n\n\ndef count(n):\n{loop}"
    (tmp_path / "counts.py").write_text(source)
    (tmp_path / "test_counts.py").write_text(
        "from counts import count\n\n\ndef test_count():\n    count(3)\n"
    )
    endless = Mutant("counts.py", 7, source.index("n -= 1"), "n -= 1", "pass")
    assert endless in sites(source.encode(), "counts.py")
    found = tried(endless, ["test_counts.py"], [], tmp_path, 4.0)
    assert found.before == "test_counts.py (longer than 4 s)"


@pytest.mark.nightly
def test_tests_that_fail_without_an_error_are_refused(tmp_path) -> None:
    """They would notice each."""
    (tmp_path / "test_wrong.py").write_text("def test_wrong():\n    assert not __file__\n")
    with pytest.raises(ValueError, match="test_wrong fails without an error: give tests that"):
        require_sound("test_wrong.py", ["test_wrong.py"], tmp_path, 60.0)
    with pytest.raises(RuntimeError, match=r"test_gone\.py: pytest ended with 4"):
        require_sound("test_wrong.py", ["test_gone.py"], tmp_path, 60.0)
