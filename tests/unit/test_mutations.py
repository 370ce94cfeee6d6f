"""The list of errors that the suite must notice: each text is there once, each test exists."""

import pytest

from validation.mutations import LIST, ROOT, Mutation, copied, mutations, noticed


def test_errors_that_can_be_put_in() -> None:
    found = mutations()
    assert len(found) == 61
    assert len({(m.file, m.old, m.new) for m in found}) == 61
    for m in found:
        assert m.old != m.new
        sound = (ROOT / m.file).read_text(encoding="utf-8")
        compile(sound.replace(m.old, m.new), m.file, "exec")
        assert all((ROOT / test.partition("::")[0]).is_file() for test in m.tests), m


def test_a_text_that_is_gone_is_told(tmp_path, monkeypatch) -> None:
    stale = LIST.read_text(encoding="utf-8").replace("a_Q * Q_nom", "a_Q * Q_gone")
    path = tmp_path / "mutations.toml"
    path.write_text(stale, encoding="utf-8")
    monkeypatch.setattr("validation.mutations.LIST", path)
    with pytest.raises(ValueError, match="occurs 0 times"):
        mutations()


@pytest.mark.nightly
def test_an_error_is_noticed_and_taken_out_again(tmp_path) -> None:
    """A copy of one module and one test: the error fails it, a change without effect does not."""
    (tmp_path / "sums.py").write_text("def twice(x):\n    return 2 * x\n")
    (tmp_path / "test_sums.py").write_text(
        "from sums import twice\n\n\ndef test_twice():\n    assert twice(3) == 6\n"
    )
    wrong = Mutation("sums.py", "a factor", "2 * x", "3 * x", ("test_sums.py",))
    assert noticed(wrong, tmp_path) == "test_sums.py::test_twice"
    assert noticed(wrong._replace(new="x * 2"), tmp_path) == ""
    assert "2 * x" in (tmp_path / "sums.py").read_text()


def test_the_copy_is_whole(tmp_path) -> None:
    copy = copied(tmp_path / "copy")
    assert all((copy / m.file).is_file() for m in mutations())
