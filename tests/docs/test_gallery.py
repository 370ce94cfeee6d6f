"""Scripts of the gallery and the tutorials run, without a warning, and draw."""

import runpy
from pathlib import Path

import matplotlib.pyplot as plt
import pytest
from matplotlib.figure import Figure

DOCS = Path(__file__).parents[2] / "docs"
GALLERY = sorted((DOCS / "gallery").rglob("*.py"))
TUTORIALS = sorted((DOCS / "tutorials").glob("*.py"))
SLOW = {  # over 2 s
    "c_histories",
    "d_profiles",
    "e_floor_spectra",
    "f_energy",
    "h_levels",
    "a_bearing",
    "a_ida",
    "a_bearing_and_rig",
    "b_mass_on_bearing",
    "c_building",
    "e_openseespy",
    "f_design_project",
}
NEEDS = {"a_bearing": "openseespy", "b_builtin": "openseespy", "e_openseespy": "openseespy"}
NEEDS |= {"e_campaign": "filelock", "a_ida": "pyFragility", "b_fragility": "pyFragility"}
AT_NIGHT = {"f_design_project"}  # a whole project, as many tests run one
LINES = 50  # of a script of the gallery, without its text


def cases(paths: list[Path]) -> list[object]:
    """Return parameters, long ones marked as slow."""
    marks = {path: [pytest.mark.slow] if path.stem in SLOW else [] for path in paths}
    for path in paths:
        marks[path] += [pytest.mark.nightly] if path.stem in AT_NIGHT else []
    return [pytest.param(p, id=f"{p.parent.name}-{p.stem}", marks=marks[p]) for p in paths]


@pytest.mark.filterwarnings("error")  # those of checks of modelling assumptions, too
@pytest.mark.parametrize("path", cases(GALLERY + TUTORIALS))
def test_script_runs_and_draws(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    if path.stem in NEEDS:
        pytest.importorskip(NEEDS[path.stem])
    drawn = []
    monkeypatch.setattr(plt, "show", lambda: None)
    init = Figure.__init__

    def count(figure: Figure, *args: object, **options: object) -> None:
        drawn.append(path)
        init(figure, *args, **options)  # type: ignore[arg-type]

    monkeypatch.setattr(Figure, "__init__", count)
    plt.switch_backend("agg")
    try:
        runpy.run_path(str(path))
    finally:
        plt.close("all")
    assert drawn


def test_gallery_is_worth_a_look() -> None:
    assert len(GALLERY) >= 18
    for path in GALLERY + TUTORIALS:
        text = path.read_text(encoding="utf-8")
        assert text.startswith('"""\n'), path
        assert "assert " in text, path
    for path in GALLERY:
        code = path.read_text(encoding="utf-8").split('"""', 2)[2]
        assert len(code.strip().splitlines()) <= LINES, path
