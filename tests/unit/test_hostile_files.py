"""Files that are damaged, change, lead elsewhere or cannot be written; files of others."""

import contextvars
import csv
import errno
import hashlib
import html
import json
import os
import shutil
import signal
import subprocess  # noqa: S404  # of this interpreter
import sys
import time
import zipfile
from collections.abc import Callable
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from typer.testing import CliRunner, Result

from frames import ModelError
from frames.command.app import app
from frames.design.project import design_run
from frames.design.project.inputs import ProjectInputs
from frames.design.project.level_runs import project_runs
from frames.design.project.preliminary import preliminary
from frames.design.project.reading import read_project
from frames.exchange.reading import read_excel
from frames.results.storage import csv_of, from_text
from tests.patience import patience
from tests.refusals import refused
from tests.unit.test_project import SOON

LAW = '{f_max = 0.06, f_min = "3 %", rate = "100 s/m"}'
SMALL = SOON.replace('"artificial-1", "artificial-3", ', "").replace(LAW, "0.06")


def lir(command: str, folder: Path, *more: str) -> Result:
    """Give a command for the small project; a traceback is no answer."""
    words = [str(folder / "small.toml"), "--results", str(folder / "out"), *more]
    if command in {"run", "report", "compare"}:
        words.append("--no-figures")
    if command == "check":
        words = words[:1]
    found = CliRunner().invoke(app, [command, *words])
    assert found.exception is None or isinstance(found.exception, SystemExit), found.exception
    return found


@pytest.fixture(scope="module")
def once(tmp_path_factory: pytest.TempPathFactory, put_example: Callable[..., Path]) -> Path:
    """Folder of a small project that was run."""
    folder = put_example(tmp_path_factory.mktemp("hostile"))
    (folder / "small.toml").write_text(SMALL)
    assert lir("run", folder).exit_code in {0, 1}
    return folder


@pytest.fixture
def done(tmp_path: Path, once: Path) -> Path:
    """The same for a test alone."""
    return Path(shutil.copytree(once, tmp_path / "project"))


def one_line(found: Result, code: int) -> str:
    """What a command said of its error, in one line."""
    assert found.exit_code == code, found.output
    assert "Traceback" not in found.output
    [said] = [line for line in found.stderr.splitlines() if line.startswith("error: ")]
    return said


@pytest.mark.filterwarnings("always:.*was changed or removed:frames.ModelWarning")
def test_what_is_shown_is_what_was_analysed(done: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The file is edited, and a record removed, while the time histories are computed."""
    histories = project_runs
    record = done / "motions" / "artificial-5-x.txt"

    def edited(*given: Any) -> Any:
        (done / "small.toml").write_text(SMALL.replace("1.5 m", "3.5 m"))
        record.unlink()
        return histories(*given)

    monkeypatch.setattr(design_run, "project_runs", edited)
    found = lir("run", done)
    assert found.exit_code in {0, 1}, found.output
    page = (done / "out" / "report.html").read_text(encoding="utf-8")
    assert (done / "out" / "project.toml").read_text() == SMALL
    assert 'radius = "1.5 m"' in html.unescape(page)
    assert 'radius = "3.5 m"' not in html.unescape(page)
    assert hashlib.sha256(SMALL.encode()).hexdigest() in page
    for path in (done / "small.toml", record):
        assert f"{path} was changed or removed after it was read" in found.stderr
        assert path.name in page


@pytest.mark.parametrize(
    ("head", "row"),
    [
        ("name,x,y", "one,a.txt,b.txt"),
        ("name;x;y", "one;a.txt;b.txt"),
        ("name,record", "one,a.txt | b.txt"),
    ],
)
def test_records_of_every_table_that_is_read_are_among_the_digests(done, head, row):
    folder = done / "motions"
    (folder / "motions.csv").write_text(f"{head}\n{row}\n", encoding="utf-8-sig")
    for name in ("a.txt", "b.txt"):
        (folder / name).write_text(name)
    parts = ProjectInputs(read_project(done / "small.toml"), done)
    for name in ("a.txt", "b.txt"):
        assert parts.sources.digest(folder / name) == hashlib.sha256(name.encode()).hexdigest()
    (folder / "b.txt").write_text("changed")
    assert [str(folder / "b.txt") in said for said in parts.sources.changed()] == [True]


def test_a_file_that_changes_before_anything_is_run_is_refused(done, monkeypatch):
    before = preliminary

    def edited(parts: Any) -> Any:
        (done / "small.toml").write_text("")
        return before(parts)

    monkeypatch.setattr(design_run, "preliminary", edited)
    assert "run the command again" in one_line(lir("run", done), 2)


def linked(out: Path, name: str, target: Path) -> None:
    """Put a link among results, or in their place."""
    place = out / name if name else out
    if place.is_dir():
        shutil.rmtree(place)
    place.unlink(missing_ok=True)
    place.symlink_to(target)


def contents(folder: Path) -> dict[Path, bytes]:
    """All files below a folder."""
    return {path: path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


@pytest.mark.parametrize("command", ["run", "report", "compare", "view"])
@pytest.mark.parametrize("name", ["", "project.toml", "checks.csv", "view.html", "unfinished"])
def test_no_link_leads_out_of_the_results(done: Path, command: str, name: str) -> None:
    """Nothing is written where it points to, and nothing among the results before."""
    folder = name in {"", "unfinished"}
    target, out = done.parent / "elsewhere", done / "out"
    if folder:
        shutil.copytree(out, target)
    else:
        target.write_text("of somebody else")
    linked(out, name, target)
    files = contents(done.parent)
    said = one_line(lir(command, done), 4)
    assert f"{out / name if name else out} is a link out of its folder" in said
    assert contents(done.parent) == files


def test_what_shares_a_file_is_not_written_to(done: Path) -> None:
    """A hard link is replaced; a link within the folder stays one."""
    out, other = done / "out", done / "elsewhere"
    other.write_text("of somebody else")
    (out / "checks.txt").unlink()
    os.link(other, out / "checks.txt")
    (out / "demands.csv").rename(out / "kept.csv")
    (out / "demands.csv").symlink_to("kept.csv")
    (out / "kept.csv").write_text("")
    assert lir("report", done).exit_code in {0, 1}
    assert other.read_text() == "of somebody else"
    assert "standing" in (out / "checks.txt").read_text()
    assert (out / "demands.csv").is_symlink()
    assert (out / "kept.csv").read_text()


def test_files_are_written_by_one_function() -> None:
    """But for what is made in a folder of its own, which is then moved into its place."""
    words = ("write_text(", "write_bytes(", ".to_csv(", ".to_netcdf(", ".to_excel(", 'open("w')
    here = Path(design_run.__file__).parents[3]
    found = {
        path.relative_to(here).as_posix()
        for folder in ("frames", "lir_element")
        for path in (here / folder).rglob("*.py")
        if any(word in path.read_text(encoding="utf-8") for word in words)
    }
    assert found == {
        "frames/design/report/files.py",
        "frames/results/envelopes.py",
        "frames/results/storage.py",
        "frames/risk/campaign/archive.py",
        "frames/risk/campaign/loss_file.py",  # its example
        "frames/risk/campaign/store_writing.py",
        "lir_element/library.py",
        "lir_element/_compile/cache.py",
    }


MARK = "from pathlib import Path\nPath({!r}).write_text('')\nraise ValueError('on purpose')\n"


def invoked(*words: str) -> Result:
    """Give a command; what it allows to run is for it alone."""
    return contextvars.copy_context().run(CliRunner().invoke, app, list(words))


@pytest.mark.parametrize("way", ["extension", "script", "campaign", "link"])
def test_files_that_run_are_named_and_lie_in_the_folder(done: Path, way: str) -> None:
    if way == "script":
        pytest.importorskip("openseespy")
    ran, outside = done / "ran", done.parent / "own.py"
    outside.write_text(MARK.format(str(ran)))
    head, tail = SMALL.index("[structure]"), SMALL.index("[bearing]")
    name = "inside.py" if way == "link" else "../own.py"
    text = SMALL.replace("[structure]", f'extensions = ["{name}"]\n[structure]')
    if way == "script":
        kind = f'[structure]\nkind = "opensees"\nscript = "{name}"\nbase_nodes = [1]\n'
        text = SMALL[:head] + kind + SMALL[tail:]
    file, command = done / "small.toml", "check"
    if way == "campaign":
        pytest.importorskip("filelock")
        text, command = text.replace("[project]", "[campaign]"), "campaign"
    if way == "link":
        (done / "inside.py").symlink_to(outside)
    file.write_text(text)
    said = one_line(invoked(command, str(file)), 2)
    assert f"{outside} is outside of the project's folder" in said
    assert not ran.exists()
    found = invoked("--scripts-from-anywhere", command, str(file))
    assert "ValueError: on purpose" in one_line(found, 2)
    assert found.stderr.startswith(f"running {outside}, a Python file that the project names\n")
    assert ran.exists()
    ran.unlink()
    (done / "inside.py").unlink(missing_ok=True)
    (done / "inside.py").write_text(outside.read_text())
    file.write_text(text.replace("../own.py", "inside.py"))
    found = invoked(command, str(file))
    assert found.stderr.startswith(f"running {done / 'inside.py'}, ")
    assert ran.exists()


def cut(path: Path) -> None:
    """Half of a file."""
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])


def binary(path: Path, content: bytes = b"\x00\xff\xfe\x80" * 500) -> None:
    """Bytes that mean nothing."""
    path.write_bytes(content)


emptied = partial(binary, content=b"")


def flipped(path: Path) -> None:
    """One bit in the middle."""
    whole = bytearray(path.read_bytes())
    whole[len(whole) // 2] ^= 1
    path.write_bytes(whole)


def a_folder(path: Path) -> None:
    """A folder in its place."""
    path.unlink(missing_ok=True)
    path.mkdir()


def a_file(path: Path) -> None:
    """A file in the place of a folder, which root cannot write into either."""
    shutil.rmtree(path)
    path.write_text("")


def undigested(path: Path) -> None:
    """Damaged results of a version that kept no digests."""
    facts = path.parent / "run.json"
    facts.write_text(json.dumps(json.loads(facts.read_text()) | {"digests": {}}))
    binary(path)


@pytest.mark.parametrize(
    ("damage", "name", "command", "code", "words"),
    [
        (cut, "out/runs-lower.nc", "report", 2, "runs-lower.nc was changed after the run"),
        (emptied, "out/runs-upper.nc", "report", 2, "runs-upper.nc was changed after the run"),
        (flipped, "out/runs-nominal.nc", "report", 2, "its SHA-256 is not the one in run.json"),
        (flipped, "out/governing.nc", "view", 2, "governing.nc was changed after the run"),
        (Path.unlink, "out/governing.nc", "report", 2, "run `lir run` again"),
        (undigested, "out/governing.nc", "report", 2, "has no results (netCDF)"),
        (binary, "out/run.json", "report", 2, "run.json is damaged"),
        (cut, "out/run.json", "view", 2, "run.json is damaged"),
        (binary, "out/checks.csv", "view", 2, "checks.csv cannot be read"),
        (a_folder, "out/demands.csv", "report", 4, "demands.csv could not be written"),
        (a_folder, "out/view.html", "view", 4, "view.html could not be written"),
        (a_folder, "out/runs-lower.nc", "report", 2, "runs-lower.nc"),
        (a_file, "out", "run", 4, "out is not a folder and cannot be created"),
        (a_file, "out", "compare", 4, "out is not a folder and cannot be created"),
        (binary, "motions/motions.csv", "check", 2, "motions.csv"),
        (Path.unlink, "motions/motions.csv", "check", 2, "motions.csv"),
        (binary, "motions/artificial-5-x.txt", "check", 2, "artificial-5-x.txt"),
        (emptied, "motions/artificial-5-y.txt", "check", 2, "artificial-5-y.txt"),
        (a_folder, "motions/artificial-5-y.txt", "check", 2, "artificial-5-y.txt"),
        (binary, "small.toml", "check", 2, "save it as UTF-8"),
        (a_folder, "small.toml", "check", 2, "name an existing file"),
    ],
)
def test_damage_is_a_line_with_its_code(done, damage, name, command, code, words):
    damage(done / name)
    said = one_line(lir(command, done), code)
    assert words in said
    assert len(said) < 1000


@pytest.mark.parametrize("command", ["report", "view"])
def test_a_full_disk_is_a_line(done: Path, monkeypatch: pytest.MonkeyPatch, command: str) -> None:
    def full(_: int) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "fsync", full)
    assert "No space left on device" in one_line(lir(command, done), 4)
    assert not list(done.rglob("*.part"))


@pytest.mark.parametrize("instead", [False, True])
def test_results_that_are_removed_while_running(done, monkeypatch, instead):
    """They are written where they belong; where a file stands now, a line says so."""
    out = done / "out"
    run = design_run.run_project

    def removed(*given: Any, **options: Any) -> Any:
        found = run(*given, **options)
        a_file(out) if instead else shutil.rmtree(out)
        return found

    monkeypatch.setattr(design_run, "run_project", removed)
    found = lir("run", done)
    if instead:
        assert "cannot be created" in one_line(found, 4)
    else:
        assert found.exit_code in {0, 1}, found.output
        assert lir("report", done).exit_code in {0, 1}


HOSTILE = ("=1+1", "+SUM(A1)", "-cmd|'/c calc'!A0", "@SUM(1)", "\t=1", " =1")


def test_no_cell_of_a_table_is_a_formula() -> None:
    index = pd.Index(HOSTILE, name="@index")
    table = pd.DataFrame({"=head": HOSTILE, "number": np.arange(-1.0, 5.0)}, index=index)
    rows = list(csv.reader(csv_of(table).splitlines()))
    assert rows[0] == ["'@index", "'=head", "number"]
    assert [row[0] for row in rows[1:]] == [f"'{name}" for name in HOSTILE]
    assert rows[1][2] == "-1.0"
    assert [from_text(row[1]) for row in rows[1:]] == list(HOSTILE)
    several = csv_of(table.set_index("=head", append=True))
    assert several.splitlines()[1].startswith("'=1+1,'=1+1,")
    for plain in ("-1.5e3", "+3", "- ", "-", "'quoted", "a=b"):
        assert csv_of(pd.DataFrame({"a": [plain]}), index=False).splitlines()[1] == plain


def test_names_of_a_project_are_no_formulas(done: Path) -> None:
    table = done / "motions" / "motions.csv"
    table.write_text(table.read_text().replace("artificial-5,", "=1+artificial,"))
    left = done / "out" / ".checks.csv.0123.part"  # of a run that was killed
    left.write_text("")
    text = SMALL.replace('"artificial-5"', '"=1+artificial"').replace('"Two st', '"=Two st')
    (done / "small.toml").write_text(text)
    assert lir("run", done).exit_code in {0, 1}
    assert not left.exists()
    found = 0
    for path in (done / "out").glob("*.csv"):
        cells = [c for row in csv.reader(path.read_text().splitlines()) for c in row]
        found += sum("'=1+artificial" in cell for cell in cells)
        assert not [c for c in cells if c.lstrip()[:1] in set("=@")], path.name
    assert found > 2
    assert lir("view", done).exit_code == 0


@pytest.mark.skipif(sys.platform == "win32", reason="no such signal")
def test_sigterm_ends_a_run_as_ctrl_c_does(done: Path) -> None:
    """In a script's background, too, where interrupts are ignored; OpenSees says no farewell."""
    shutil.rmtree(done / "out")
    load = "from lir_element.opensees import opensees; opensees(); "
    code = (
        f"{load if find_spec('openseespy') else ''}"
        "import signal, sys; signal.signal(signal.SIGINT, signal.SIG_IGN); "
        "sys.argv = ['lir', 'run', '--no-figures', 'small.toml', '--results', 'out']; "
        "from frames.command.entry import main; main()"
    )
    with subprocess.Popen(  # noqa: S603
        [sys.executable, "-c", code], cwd=done, stderr=subprocess.PIPE, text=True
    ) as started:
        while started.poll() is None and not list(done.glob("out/unfinished/*.npz")):
            time.sleep(0.02)
        started.terminate()
        said = started.communicate()[1]
    assert started.returncode == 130, said
    assert "repeat the command to continue" in said
    assert "Process 0" not in said
    assert not list((done / "out").rglob(".*.part"))


def test_a_signal_leaves_the_file_of_before(done: Path) -> None:
    code = (
        "import os, signal, sys\n"
        "from frames.results.storage import write_whole\n"
        "os.fsync = lambda _: os.kill(os.getpid(), signal.SIGTERM)\n"
        "write_whole(sys.argv[1], 'text')\n"
    )
    place = str(done / "out" / "checks.csv")
    before = Path(place).read_bytes()
    ended = subprocess.run(  # noqa: S603
        [sys.executable, "-c", code, place], timeout=patience(), check=False
    )
    assert ended.returncode == -signal.SIGTERM
    assert len(list((done / "out").glob(".*.part"))) == 1
    assert Path(place).read_bytes() == before


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('folder = "motions"', f'folder = "{"m" * 6000}"', "File name too long"),
        ('folder = "motions"', f'folder = "{"m/" * 3000}"', "File name too long"),
        ("[structure]", f'extensions = ["{"e" * 6000}.py"]\n[structure]', "File name too long"),
        ("friction = 0.06", f"friction = {'9' * 100_000}", "digits"),
        ("friction = 0.06", f"friction = 0.{'9' * 100_000}", "below 1"),
        ("friction = 0.06", f'friction = "{"9" * 100_000} %"', "friction"),
        ("friction = 0.06", f"friction = {'[' * 3000}{']' * 3000}", "brackets are nested too deep"),
        ('"Two storeys"', '"nul \\u0000"', None),
        ('folder = "motions"', 'folder = "nul \\u0000"', "is not a file"),
    ],
)
def test_what_is_far_too_long_is_refused(done: Path, old: str, new: str, words: str | None) -> None:
    assert old in SMALL
    (done / "small.toml").write_text(SMALL.replace(old, new, 1))
    found = lir("check", done)
    if words is not None:
        said = one_line(found, 2)
        assert words in said
        assert len(said) < 1500
    far = CliRunner().invoke(app, ["check", f"{'p' * 6000}.toml"])
    assert "File name too long" in one_line(far, 2)


@pytest.mark.parametrize("content", ["<a>", "", "<Types/>"])
def test_what_is_no_workbook_is_refused(tmp_path: Path, content: str) -> None:
    pytest.importorskip("openpyxl")
    path = tmp_path / "model.xlsx"
    with zipfile.ZipFile(path, "w") as whole:
        whole.writestr("[Content_Types].xml", content)
    words = r"model\.xlsx is not a readable workbook .*save it as \.xlsx"
    refused(ModelError, words, read_excel, path)
