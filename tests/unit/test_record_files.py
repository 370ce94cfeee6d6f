"""Files in the formats of networks, written here, against their samples."""

from __future__ import annotations

import datetime
import re
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import openpyxl
import pytest
from numpy.testing import assert_allclose

from frames import GroundMotion, MotionError, MotionWarning
from frames.design import MotionSet
from frames.design.hazard.motion_folder import table_rows
from frames.design.project.irregular_plan import csv_rows
from frames.design.project.schema import read_points
from frames.motion.columns import ColumnLayout, read_columns
from frames.motion.formats import FORMATS
from frames.motion.record_files import format_of, read_record
from lir_element.units import STANDARD_GRAVITY as G

DT = 0.01
TIME = DT * np.arange(1000)
WAVES = np.array(
    [k * np.sin((5.0 + k) * TIME) * np.sin(np.pi * TIME / 9.99) ** 2 for k in (1.0, 2.0, 0.5)]
)
"""Three components [m/s2]: peaks near 1.0, 2.0 and 0.5."""


def rows(values: np.ndarray, a_line: int, form: str) -> str:
    """Return numbers so many a line, in Fortran's fields."""
    lines = [values[k : k + a_line] for k in range(0, len(values), a_line)]
    return "\n".join("".join(form % value for value in line) for line in lines)


def peak(values: np.ndarray, factor: float = 1.0) -> float:
    return float(np.abs(values).max()) / factor


def knet(k: int, direction: str) -> str:
    counts = np.round(WAVES[k] / 0.01 / (3920.0 / 6182761.0)) + 12085.0
    head = ["Origin Time       2018/01/24 19:51:00", "Station Code      AOM001"]
    head += ["Sampling Freq(Hz) 100Hz", "Duration Time(s)  10", f"Dir.              {direction}"]
    head += ["Scale Factor      3920(gal)/6182761", f"Max. Acc. (gal)   {100 * peak(WAVES[k]):.3f}"]
    return "\n".join([*head, "Memo.             ", rows(counts, 8, "%9.0f")]) + "\n"


def csmip(volume: int) -> str:
    parts = []
    for k, name in enumerate((" 90 Deg", "360 Deg", " Up")):
        head = ["Accelerogram Data", "1  2", f"Chan  {k + 1}: {name}"]
        if volume == 1:
            head += [f"Units of uncor data are sec and g . Max = {peak(WAVES[k], G):.3f} g , at"]
            head += [" 1000 Accelerogram points at 100 pts/sec in units of g .   Format: (8f9.6)"]
            parts += [*head, rows(WAVES[k] / G, 8, "%9.6f")]
        else:
            head += [f"Peak acceleration = {100.0 * peak(WAVES[k]):.3f} cm/sec/sec at 1.0 sec."]
            head += [" 1000 points of accel data equally spaced at .010 sec, in cm/sec2. (8f10.5)"]
            parts += [*head, rows(100.0 * WAVES[k], 8, "%10.5f")]
            parts += [" 1000 points of veloc data equally spaced at .010 sec, in cm/sec.  (8f10.7)"]
            parts += [rows(WAVES[k], 8, "%10.6f")]
        parts += [f"/&  ----------  End of data for channel  {k + 1}  ----------"]
    return "\n".join(parts) + "\n\x1a"


def volume_1() -> str:
    parts = []
    for k, name in enumerate(("L", "T", "V")):
        head = ["UNCORRECTED ACCELEROGRAM DATA", *["x"] * 5, f"CHAN  {k + 1}: {name}  (STA CHN: 1)"]
        head += [*["x"] * 3, "NO. OF POINTS =   1000  RECORD LENGTH = 10.000 SEC"]
        head += [f"UNITS OF UNCOR ACCEL ARE SEC AND G/10.     MAX  = {peak(WAVES[k], G):.3f} G, AT"]
        head += ["RMS", *["    0"] * 14]
        # 95 s on, so that times and values touch, as in long records
        pairs = np.column_stack([TIME + 95.0, 10.0 * WAVES[k] / G]).ravel()
        parts += [*head, rows(pairs, 10, "%7.3f"), f"/&  -----  END OF DATA FOR CHANNEL {k + 1}"]
    return "\n".join(parts) + "\n"


def cosmos() -> str:
    reals = np.full(100, -999.0)
    reals[33] = DT
    head = ["Corrected acceleration", "Sta Chan   1: 90 Deg (Rcrdr Chan  ?) Location:"]
    head += [" 100 Integer-header values follow on  10 lines, Format= (10I8)"]
    head += [rows(np.zeros(100), 10, "%8.0f")]
    head += [" 100 Real-header values follow on  17 lines, Format= (6F13.6)"]
    head += [rows(reals, 6, "%13.6f"), "  1 Comment line(s) follow, each starting with a |", "| x"]
    head += ["   1000 acceleration pts, approx 10 secs, units=cm/sec2(04),Format=(8F10.5)"]
    return "\n".join([*head, rows(100.0 * WAVES[0], 8, "%10.5f"), "End-of-data for Chan 1"]) + "\n"


def smc(kind: str = "2 CORRECTED", rate: float = 100.0) -> str:
    whole, reals = np.full(48, -32768.0), np.full(50, 1.7e38)
    whole[15], whole[16], reals[1] = 1.0, 1000.0, rate
    head = [f"{kind} ACCELEROGRAM", *["*"] * 4, "station = A, component=    360"]
    head += [f"epicentral dist = 89.0 pk acc = {100.0 * peak(WAVES[0]):.1f}", *["*"] * 4]
    numbers = [
        f"{value:10.4E}".replace("E+0", "E+").replace("E-0", "E-") for value in 100 * WAVES[0]
    ]
    cut = ["".join(f"{text:>10}" for text in numbers[k : k + 8]) for k in range(0, 1000, 8)]
    return (
        "\n".join([*head, rows(whole, 8, "%10.0f"), rows(reals, 5, "%15.7E"), "|ref", *cut]) + "\n"
    )


def geonet() -> str:
    parts = []
    for k, name in enumerate(("S16W", "N74W", "Up")):
        head = ["Corrected accelerogram 20180212 GNS Science", *["x"] * 8]
        head += ["Number of points  1000    Duration 10.0 sec"]
        head += ["Instrument corrected data at 0.010 sec intervals", "x", f"Component {name}  axis"]
        head += [f"Acceleration:  peak  {1000.0 * peak(WAVES[k]):.1f} mm/s/s at  1.0 sec"]
        parts += [*head, *["x"] * 2, *["  1  2"] * 10, rows(1000.0 * WAVES[k], 10, "%8.1f")]
        parts += [rows(WAVES[k], 10, "%8.3f")]  # velocities
    return "\n".join(parts) + "\n"


def esm() -> str:
    head = ["EVENT_NAME: GREECE", "SAMPLING_INTERVAL_S: 0.010000", "NDATA: 1000", "STREAM: HNN"]
    head += ["UNITS: cm/s^2", f"PGA_CM/S^2: {100.0 * peak(WAVES[0]):.6f}", "USER5:"]
    return "\n".join(head) + "\n" + rows(100.0 * WAVES[0], 1, "%.6f") + "\n"


def table(head: list[str], columns: list[np.ndarray], width: int) -> str:
    return (
        "\n".join(head)
        + "\n"
        + rows(np.column_stack(columns).ravel(), len(columns), f"%{width}.4f")
    )


def nsmn() -> str:
    head = ["STRONG GROUND MOTION RECORDS OF TURKIYE", "NUMBER OF DATA          : 1000"]
    head += ["SAMPLING INTERVAL (sec) : 0.01", "       N-S          E-W          U-D"]
    return table(head, list(100.0 * WAVES), 13) + "\n"


def unam() -> str:
    head = ["ARCHIVO ESTANDAR DE ACELERACION:"]
    head += ["ORIENTACION C1-C6 (rumbo;orientacion)  : /N00E/N90E/V"]
    head += ["INTERVALO DE MUESTREO, C1-C6 (s)       : /0.01/0.01/0.01"]
    head += ["NUM. TOTAL DE MUESTRAS, C1-C6          : /1000/1000/1000"]
    head += [
        "UNIDADES DE LOS DATOS                  : Gal (cm/s/s)",
        "   CANAL-1   CANAL-2",
        "x",
        "--",
    ]
    return table(head, list(100.0 * WAVES), 10) + "\n"


def cwa() -> str:
    head = ["#StationCode: EAS", "#RecordLength(sec): 10", "#SampleRate(Hz): 100"]
    head += ["#AmplitudeUnit:  gal. DCoffset(corr)", "#DataSequence: Time N(+); E(+); U(+)"]
    return table([*head, "#Data: 4F10.3 "], [TIME, *(100.0 * WAVES)], 10) + "\n"


FILES: dict[str, tuple[Callable[[], str], int, str, float]] = {
    "K-NET": (lambda: knet(0, "E-W"), 1, "E-W", 90.0),
    "KiK-net": (lambda: knet(0, "5"), 1, "EW", 90.0),
    "CSMIP 1": (lambda: csmip(1), 3, "90 Deg", 90.0),
    "CSMIP 2": (lambda: csmip(2), 3, "90 Deg", 90.0),
    "volume 1": (volume_1, 3, "L", -1.0),
    "COSMOS": (cosmos, 1, "90 Deg", 90.0),
    "SMC": (smc, 1, "360", 0.0),
    "GeoNet": (geonet, 3, "S16W", 196.0),
    "ESM": (esm, 1, "HNN", 0.0),
    "NSMN": (nsmn, 3, "N-S", 0.0),
    "UNAM": (unam, 3, "N00E", 0.0),
    "CWA": (cwa, 3, "N(+)", 0.0),
}
"""A file of each, its components, and direction and azimuth of the first; -1 where it has none."""


@pytest.mark.parametrize("name", FILES)
def test_each_format_gives_its_samples(tmp_path: Path, name: str) -> None:
    make, count, direction, azimuth = FILES[name]
    path = tmp_path / "record.txt"
    path.write_text(make(), encoding="latin-1")
    found = read_record(path)
    assert len(found) == count
    assert found[0].direction == direction
    assert (-1.0 if found[0].azimuth is None else found[0].azimuth) == azimuth
    assert [each.vertical for each in found] == [False, False, True][:count]
    for each, wave in zip(found, WAVES, strict=False):
        assert each.trace.dt == pytest.approx(DT, rel=1e-12)
        # printed digits of g / 10 with three decimals; the mean of a whole record is taken off
        assert_allclose(each.trace.acceleration, wave, rtol=0.0, atol=1e-3)


def test_every_format_of_the_table_is_tried() -> None:
    tried = {getattr(format_of(make().splitlines()), "name", "") for make, *_ in FILES.values()}
    assert tried == {each.name for each in FORMATS}


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (csmip(2).replace("in cm/sec2", "in counts"), "the unit 'counts'.*volume 1 or 2"),
        (esm().replace("cm/s^2", "cm/s"), "the unit 'cm/s' is not an acc"),
        (esm().replace("NDATA: 1000", "NDATA: 2000"), "states 2000 samples, but the file has 10"),
        (esm().replace("NDATA: 1000", "NDATA: 500"), "states 500 samples, but the file has 1000"),
        (esm().replace("NDATA: 1000", "x"), "has no number of samples or no time step"),
        (cosmos().replace("0.010000", "0.005000"), "states 10 s, but 1000 .* of 0.005 s last 5 s"),
        (smc("1 UNCORRECTED", 1.7e38), "uncorrected record with uneven times.*volume 2"),
        ("0.1\n0.2\n", 'is in no known format.*order="rows"'),
    ],
)
def test_what_cannot_be_used_is_refused(tmp_path: Path, text: str, words: str) -> None:
    path = tmp_path / "odd.txt"
    path.write_text(text, encoding="latin-1")
    with pytest.raises(MotionError, match=words):
        read_record(path)
    if "order=" in words:  # what the message says reads it
        read = GroundMotion.from_columns(x=path, order="rows", skip=0, dt=0.1, unit="cm/s2")
        assert_allclose(read.x, [0.001, 0.002])


LONG = esm().replace("NDATA: 1000", "NDATA: 10000") + "0.0\n" * 9000


@pytest.mark.parametrize(
    ("text", "count", "spare"),
    [
        (esm(), 1000, 20),
        (esm().replace("NDATA: 1000", "NDATA: 980"), 980, 0),
        (nsmn(), 1000, 60),  # 20 samples of each of three columns
        (LONG, 10000, 100),  # 1 %
    ],
)
def test_padding_after_the_samples_is_left_out(tmp_path, text, count, spare):
    path = tmp_path / "padded.txt"
    path.write_text(text + "0.0\n" * spare)
    assert len(read_record(path)[0].trace.acceleration) == count
    path.write_text(text + "0.0\n" * (spare + 1))
    with pytest.raises(MotionError, match=f"states {count} samples, but the file has"):
        read_record(path)


def test_a_peak_that_the_samples_miss_is_told(tmp_path: Path) -> None:
    path = tmp_path / "record.EW"
    path.write_text(knet(0, "E-W").replace("3920(gal)", "2000(gal)"))
    with pytest.warns(
        MotionWarning, match=r"states a peak of 0.99\d* m/s2, but the samples reach 0.5"
    ):
        read_record(path)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for k, direction in enumerate(("E-W", "N-S", "U-D")):
        (tmp_path / f"A.{direction.replace('-', '')}").write_text(knet(k, direction))
    (tmp_path / "B.EW").write_text(knet(1, "30"))
    (tmp_path / "CE1.V2").write_text(csmip(2))
    (tmp_path / "five.acc").write_text("title\n" + rows(WAVES[0], 5, "%10.5f"))
    (tmp_path / "comma.txt").write_text(
        "\n".join(f"{t:.2f} {a:.6f}" for t, a in zip(TIME, WAVES[1], strict=True)).replace(".", ",")
    )
    return tmp_path


def test_components_are_put_on_axes(folder: Path) -> None:
    motion = GroundMotion.from_record(folder / "A.EW", folder / "A.NS", folder / "A.UD", scale=2.0)
    assert_allclose(motion.components.T, 2.0 * WAVES, rtol=0.0, atol=1e-3)
    turned = GroundMotion.from_record(folder / "CE1.V2", x="360 deg", y="90 Deg", name="turned")
    assert turned.name == "turned"
    assert_allclose(turned.components.T[:2], WAVES[1::-1], rtol=0.0, atol=1e-4)
    for paths, options, words in (
        ((), {}, "no file is given"),
        (("CE1.V2", "A.UD"), {}, r"hold 4 components.*set the directions .*, for example x"),
        (("A.EW", "A.NS", "B.EW"), {}, r"hold 3 components.*set the directions of x, y and z"),
        (("CE1.V2",), {"x": "45 Deg"}, "x = '45 Deg' is 0 of the directions 90 Deg, 360 Deg, Up"),
    ):
        with pytest.raises(MotionError, match=words):
            GroundMotion.from_record(*(folder / each for each in paths), **options)


@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_a_table_of_all_kinds(folder: Path, separator: str) -> None:
    """One file a component, all in one, several values a line, decimal commas: as they come."""
    lines = [
        ["name", "record", "x", "y", "z", "unit", "dt", "order", "skip", "decimal", "magnitude"],
        ["knet", "", "A.EW", "A.NS", "A.UD", "", "", "", "", "", "6.2"],
        ["same", "A.EW | A.NS | A.UD", "", "", "", "", "", "", "", "", "6.2"],
        ["csmip", "CE1.V2", "90 Deg", "360 Deg", "", "", "", "", "", "", "6.2"],
        ["rows", "", "five.acc", "", "", "m/s2", "0.01", "rows", "1", "", "6.2"],
    ]
    if separator != ",":
        lines = [
            [cell.replace("0.01", "0,01").replace("6.2", "6,2") for cell in row] for row in lines
        ]
        lines += [["comma", "", "comma.txt", "", "", "m/s2", "", "", "", ",", "6,2"]]
    text = "\n".join(separator.join(row) for row in lines)
    (folder / "motions.csv").write_text(text, encoding="utf-8-sig")
    read = MotionSet.from_folder(folder)
    for name in ("knet", "same", "csmip"):
        assert_allclose(read[name].components.T[:2], WAVES[:2], rtol=0.0, atol=1e-3)
        wanted = {"azimuth_x": 90.0, "azimuth_y": 0.0, "magnitude": 6.2}
        assert read.facts[name] == wanted, name
    assert_allclose(read["rows"].x, WAVES[0], rtol=0.0, atol=1e-5)
    if separator != ",":
        assert_allclose(read["comma"].x, WAVES[1], rtol=0.0, atol=1e-6)


@pytest.mark.parametrize(
    ("row", "words", "cure"),
    [
        ("a,five.acc,m/s2,0.01,rows,", r"'title' is text.*skip=1 \(.*columns of", "1"),
        ("a,CE1.V2,,,,", "holds 3 components.*column record, and the directions", None),
        ("a,five.acc,m/s2,0,01,rows,1", "line 2 has 7 cells, its head 6.*semicolons", None),
        ("a,five.acc,,,,", "unit is missing: set the column unit", None),
        ("a,five.acc,m/s2,soon,rows,1", "dt = soon is not a number", None),
    ],
)
def test_rows_of_a_table_are_refused_by_their_cause(folder, row, words, cure):
    path = folder / "motions.csv"
    path.write_text(f"name,x,unit,dt,order,skip\n{row}\n")
    with pytest.raises(MotionError, match=words):
        MotionSet.from_folder(folder)
    if cure:
        path.write_text(f"name,x,unit,dt,order,skip\n{row}{cure}\n")
        assert MotionSet.from_folder(folder)["a"].n_steps == len(TIME)


def test_the_page_names_what_is_read() -> None:
    """Its table of tries adds up to its sentence, and it has a row for each kind of format."""
    page = (Path(__file__).parents[2] / "docs/motion_files.md").read_text(encoding="utf-8")
    tried, read, refused = map(
        int, re.findall(r"(\d+) (?:public files|of them read|refused with)", page)
    )
    counts = re.findall(r"^\| [^|]+ \| (\d+) \| (\d+) \| (\d+) \|$", page, re.MULTILINE)
    sums = np.array(counts, dtype=int).sum(axis=0)
    assert sums.tolist() == [tried, read, refused]
    assert tried == read + refused
    named = page.split("## Files that were tried")[1].count("`")
    assert named == 2 * tried
    for each in FORMATS:
        assert re.split(r"[ ,]", each.name)[0] in page, each.name


HISTORY = [[0.01 * k, 0.25 * k * (-1) ** k] for k in range(60)]
LAYOUT = ColumnLayout("m/s2", time=0)
LAYOUTS = {"comma": LAYOUT._replace(delimiter=","), "tab": LAYOUT._replace(decimal=",")}
DOORS = {
    "spectrum": (
        [["period [s]", "acceleration [m/s2]"], [0, 1.5], [0.5, 2.25], [2, 0.75]],
        read_points,
        ((0.0, 1.5), (0.5, 2.25), (2.0, 0.75)),
    ),
    "motions": (
        [["name", "x", "unit", "dt"], ["a", "a.txt", "m/s2", 0.005]],
        lambda path: [
            {k: r[k].replace(",", ".") for k in r} for r in table_rows(path.parent, path.name)
        ],
        [{"name": "a", "x": "a.txt", "unit": "m/s2", "dt": "0.005"}],
    ),
    "columns": (
        [["name", "x [ft]", "y [m]", "section"], ["A1", 2.5, 6, "C"]],
        lambda path: [
            (r.text("name"), r.length("x"), r.length("y"))
            for r in csv_rows(path, ("name", "x", "y", "section"))
        ],
        [("A1", pytest.approx(2.5 * 0.3048), 6.0)],
    ),
    "history": (
        HISTORY,
        lambda path: read_columns(path, 1, LAYOUTS.get(path.stem, LAYOUT)).acceleration.tolist(),
        [row[1] for row in HISTORY],
    ),
}
"""Tables that the product reads from its user: rows, reader, what it returns."""


def saved(folder: Path, rows: list[list[object]], kind: str) -> Path:
    """Return a table as a spreadsheet saves it."""
    if kind == "workbook":
        book = openpyxl.Workbook()
        for row in rows:
            book.active.append(row)
        book.save(folder / "workbook.xlsx")
        return folder / "workbook.xlsx"
    cut, code = {
        "comma": (",", "utf-8-sig"),
        "semicolon": (";", "utf-8-sig"),
        "tab": ("\t", "utf-16"),
    }[kind]
    cells = [
        [str(c).replace(".", ",") if isinstance(c, float) and cut != "," else str(c) for c in row]
        for row in rows
    ]
    path = folder / f"{kind}.csv"
    path.write_text("\n".join(cut.join(row) for row in cells) + "\n", encoding=code)
    return path


@pytest.mark.parametrize("kind", ["comma", "semicolon", "tab", "workbook"])
@pytest.mark.parametrize("door", list(DOORS))
def test_tables_of_offices_at_every_door(tmp_path: Path, door: str, kind: str) -> None:
    """Separators, decimal commas, marks and workbooks are read alike."""
    rows, read, expected = DOORS[door]
    assert read(saved(tmp_path, rows, kind)) == expected


@pytest.mark.parametrize("door", list(DOORS))
def test_workbooks_that_cannot_be_read_say_why(tmp_path: Path, door: str, monkeypatch) -> None:
    rows, read, _ = DOORS[door]
    path = saved(tmp_path, [*rows[:-1], [datetime.date(2026, 1, 3), *rows[-1][1:]]], "workbook")
    with pytest.raises(ValueError, match=r"row \d+: 2026-01-03.* is a date: format the col"):
        read(path)
    path.write_bytes(b"none")
    with pytest.raises(ValueError, match=r"workbook.xlsx:? is not a readable workbook"):
        read(path)
    monkeypatch.setitem(sys.modules, "openpyxl", None)
    with pytest.raises(ImportError, match=r"workbooks need openpyxl: pip install"):
        read(path)
