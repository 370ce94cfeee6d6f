"""Ground motions: readers, checks at the door, copies, and spectra against other routes."""

import itertools
import math
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.linalg import expm

from frames import MotionWarning
from frames.motion.columns import ColumnLayout, read_columns
from frames.motion.ground_motion import GroundMotion, MotionError
from frames.motion.records import read_at2
from tests.refusals import refused

G = 9.80665
VALUES = (0.1, -0.25, 0.5, 0.0, -0.05, 0.02, 0.01)
SIZES = (
    "NPTS=      7, DT=   .0050 SEC",
    "NPTS=      7, DT=   .0050 SEC,   5 POLE @    50.0 HZ,  -5 POLE @",
    "NPTS=7 DT=0.005 SEC",
    "    7   0.0050   NPTS, DT",
    "7  5.0E-03  NPTS, DT",
)


def at2_text(
    values: tuple[float, ...] = VALUES,
    sizes: str = "NPTS=  7, DT=  .0050 SEC",
    unit: str = "ACCELERATION TIME SERIES IN UNITS OF G",
) -> str:
    rows = [values[i : i + 5] for i in range(0, len(values), 5)]
    body = ["".join(f"{value:15.7E}" for value in row) for row in rows]
    return "\r\n".join(["PEER STRONG MOTION DATABASE RECORD", "Somewhere, 90", unit, sizes, *body])


@pytest.fixture
def write(tmp_path: Path) -> Callable[[str, str], Path]:
    def write_file(name: str, text: str) -> Path:
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        return path

    return write_file


def two_components() -> GroundMotion:
    time = np.arange(301) * 0.01
    return GroundMotion(x=np.sin(7.0 * time), y=0.5 * np.cos(3.0 * time), dt=0.01, name="made")


class TestAT2:
    @pytest.mark.parametrize("sizes", SIZES)
    def test_headers(self, write, sizes):
        motion = GroundMotion.from_at2(write("rec.AT2", at2_text(sizes=sizes)))
        assert (motion.dt, motion.name, motion.y) == (0.005, "rec", None)
        assert_allclose(motion.x, np.array(VALUES) * G, rtol=1e-12, atol=0.0)  # exact in 8 digits

    @pytest.mark.parametrize(
        ("line", "factor"),
        [
            ("ACCELERATION TIME HISTORY IN UNITS OF G. FILTER POINTS: HP=0.2 Hz LP=47.0 Hz", G),
            ("ACCELERATION IN UNITS OF CM/S/S", 0.01),
            ("Units: cm/sec/sec", 0.01),
            ("ACCELERATION TIME SERIES", G),
            ("ACCELERATION TIME HISTORY, UNITS (M/S2)", 1.0),
            ("UNITS [M/S/S]", 1.0),
            ("ACCELERATION (CM / SEC / SEC), SAN FRANCISCO N/S COMP", 0.01),
            ("ACCELERATION IN MM/S2", 0.001),
            ("ACCELERATION IN GAL", 0.01),
            ("THE UNITS ARE (G)", G),
            ("ACCELERATION IN UNITS OF G/10", 0.1 * G),
            ("VELOCITY TIME SERIES IN UNITS OF CM/S", "CM/S"),
            ("VELOCITY TIME SERIES", "VELOCITY"),
            ("DISPLACEMENT, CM", "DISPLACEMENT"),
            ("ACCELERATION, FT/S2", "FT/S2"),
            ("ACCELERATION IN UNITS OF LIGHT", "LIGHT"),
        ],
    )
    def test_unit_of_line_3(self, write, line, factor):
        path = write("rec.AT2", at2_text(unit=line))
        if isinstance(factor, str):
            words = rf"rec.AT2: the unit '{factor}' in line 3.*use the file"
            refused(MotionError, words, read_at2, path)
        else:
            wanted = np.array(VALUES) * factor
            assert_allclose(read_at2(path).acceleration, wanted, rtol=1e-12, atol=0.0)

    def test_decimal_commas_touching_numbers_and_zeros_that_fill_up(self, write):
        """Each reads as the plain file does, because NPTS tells how many numbers there are."""
        wanted = read_at2(write("plain.AT2", at2_text()))
        comma = at2_text(sizes="NPTS= 7, DT= 5,0E-3")
        head, body = comma.split("5,0E-3")
        rows = [VALUES[:5], VALUES[5:]]
        touching = "\n".join("".join(f"{value:15.8E}" for value in row) for row in rows)
        texts = {
            "comma": f"{head}5,0E-3{body.replace('.', ',')}",
            "touching": at2_text().rpartition("SEC")[0] + "SEC\n" + touching.replace(" ", "+"),
            "filled": at2_text((*VALUES, 0.0, 0.0, 0.0)),
        }
        for name, text in texts.items():
            read = read_at2(write(f"{name}.AT2", text))
            assert read.dt == wanted.dt, name
            assert_allclose(read.acceleration, wanted.acceleration, rtol=1e-12, atol=0.0)

    def test_from_columns_reads_what_is_no_at2_file(self, write):
        path = write("rec.AT2", at2_text(sizes="El Centro"))
        read = GroundMotion.from_columns(x=path, order="rows", skip=4, dt=0.005, unit="g")
        assert_allclose(read.x, np.array(VALUES) * G, rtol=1e-12, atol=0.0)

    def test_a_peak_above_all_that_was_recorded_is_doubted(self, write):
        path = write("rec.AT2", at2_text(tuple(80.0 * v for v in VALUES), unit="UNITS OF M/S2"))
        assert GroundMotion.from_at2(path).peak["x"] == pytest.approx(40.0)
        strong = write("gal.AT2", at2_text(tuple(784.0 * v for v in VALUES), unit="UNITS OF M/S2"))
        with pytest.warns(MotionWarning, match=r"392 m/s2 = 40 g, above .*cm/s2 are 3.92"):
            GroundMotion.from_at2(strong)

    @pytest.mark.parametrize(
        ("text", "message"),
        [
            (at2_text(VALUES[:-1]), r"cut short: 6 values.*NPTS = 7"),
            (at2_text((*VALUES, 0.3)), r"more than.*8 values"),
            (at2_text(sizes="nothing here"), r"line 4 of an AT2 file must read.*'nothing here'"),
            ("too\nshort", r"only 2 lines.*from_columns"),
            (at2_text().replace("2.0000000E-02", 13 * "*"), r"line 6: '\*+' is not a number"),
            (at2_text(sizes="NPTS= 7, DT= 5 MS"), "DT = 5 in 'MS': write it in seconds"),
            (at2_text(sizes="El Centro"), 'order="rows", skip=<header lines>, dt='),
        ],
    )
    def test_broken_files(self, write, text, message):
        refused(MotionError, message, read_at2, write("rec.AT2", text))

    def test_three_components(self, write):
        east = write("E.AT2", at2_text())
        short = write("Z.AT2", at2_text(VALUES[:5], "NPTS=  5, DT=  .0050 SEC"))
        motion = GroundMotion.from_at2(east, str(east), short, scale=(1.0, 2.0, -1.0), name="two")
        assert motion.name == "two"
        assert_allclose(motion.components[:, 1], 2.0 * motion.components[:, 0], rtol=0.0, atol=0.0)
        assert_allclose(motion.components[5:, 2], 0.0, rtol=0.0, atol=0.0)  # filled up
        assert motion.peak["z"] == pytest.approx(0.5 * G, rel=1e-12)

    def test_records_that_were_cut_or_are_one_history(self, write):
        """The strongest 3 s of 15 s, and one file for x and y; whole and different ones pass."""
        time = DT * np.arange(1501)
        envelope = np.sin(np.pi * time / 15.0) ** 2
        for name, first, last in (("whole", 0, 1501), ("cut", 600, 900)):
            for axis, pulsation in (("E", 8.0), ("N", 11.0)):
                wave = (0.3 * envelope * np.sin(pulsation * time))[first:last]
                sizes = f"NPTS= {len(wave)}, DT= {DT} SEC"
                write(f"{name}-{axis}.AT2", at2_text(tuple(wave), sizes))
        folder = write("x", "").parent
        both = [folder / f"whole-{axis}.AT2" for axis in "EN"]
        assert GroundMotion.from_at2(*both).duration == 15.0
        with pytest.warns(MotionWarning, match="x and y are identical or proportional"):
            GroundMotion.from_at2(both[0], both[0])
        with pytest.warns(MotionWarning, match="was probably cut in its strong phase"):
            GroundMotion.from_at2(*(folder / f"cut-{axis}.AT2" for axis in "EN"))

    def test_unlike_steps_and_no_file(self, write):
        pair = write("E.AT2", at2_text()), write("N.AT2", at2_text(sizes="7 0.01 NPTS, DT"))
        refused(MotionError, r"x 0.005 s, y 0.01 s.*resample", GroundMotion.from_at2, *pair)
        refused(MotionError, "at least one of x, y and z", GroundMotion.from_at2)


DT = 0.01
CURED = {
    "without sep.*width=10": (10.64359, 15.35039),
    r"without sep.*set their width, width=\.\.\.": (-1.0, -1.2),
    "'head' is text.*skip=2": (0.0, 0.0),
    'decimal comma.*decimal=","': (2.0, 2.0),
    'separated by commas.*delimiter=","': (2.0, 2.0),
    "line 3: 'End'.*or remove it": (2.0, 2.0),
    "line 2 holds 1 numbers.*repair line 2": (3.0, 3.0),
    r"line 1: '\*+' is not a number.*repair": (0.0, 0.0),
}
"""What the cured file's last row has more than its first."""

BBP = """# Station: somewhere
# Column 1: Time (s)
0.000000e+00\t-1.0\t2.0\t3.0
5.000000e-03\t-4.0\t5.0\t6.0
1.000000e-02\t-7.0\t8.0\t9.0
"""


class TestColumns:
    def test_one_file_with_times(self, write: Callable[[str, str], Path]) -> None:
        path = write("station.bbp", BBP)
        motion = GroundMotion.from_columns(path, x=2, y=1, z=3, time=0, unit="cm/s2")
        assert (motion.dt, motion.name) == (0.005, "station")
        wanted = np.array([[2.0, -1.0, 3.0], [5.0, -4.0, 6.0], [8.0, -7.0, 9.0]]) * 0.01
        assert_allclose(motion.components, wanted, rtol=1e-15, atol=0.0)

    def test_one_file_each(self, write: Callable[[str, str], Path]) -> None:
        east, north = write("E.ATH", "0.1\n0.2\n-0.3\n"), write("N.ATH", "head\n9 1\n9 2\n9 3\n")
        motion = GroundMotion.from_columns(x=east, dt=0.02, unit="g", scale=2.0)
        assert_allclose(motion.x, np.array([0.2, 0.4, -0.6]) * G, rtol=1e-14, atol=0.0)
        motion = GroundMotion.from_columns(y=(north, 1), dt=0.02, unit="m/s2", skip=1)
        assert_allclose(motion.y, [1.0, 2.0, 3.0], rtol=0.0, atol=0.0)

    def test_commas(self, write: Callable[[str, str], Path]) -> None:
        for end in ("", ",", " , "):  # a separator may end a row
            path = write("a.csv", f"0.0,1.5{end}\n0.1,2.5{end} # last\n")
            motion = GroundMotion.from_columns(x=path, time=0, unit="m/s2", delimiter=",")
            assert_allclose(motion.x, [1.5, 2.5], rtol=0.0, atol=0.0)
            with pytest.raises(MotionError, match=r"separated by commas.*delimiter=\",\""):
                GroundMotion.from_columns(x=path, time=0, unit="m/s2")

    @pytest.mark.parametrize(
        ("text", "options", "message"),
        [
            (BBP, {"unit": "ft/s2"}, r"unit = 'ft/s2' must be one of g, m/s2, cm/s2, gal"),
            (BBP, {"time": None}, r"time = None and dt = None: set one of them"),
            (BBP, {"dt": 0.1}, r"set one of them"),
            (BBP, {"x": 4}, r"column = 4 must be.*below 4"),
            (BBP, {"time": -1}, r"time = -1 must be at least 0"),
            (BBP.replace("1.000000e-02", "1.5e-02"), {}, "time step is not constant"),
            (BBP.replace("5.000000e-03", "nan"), {}, "time step is not constant"),
            ("a b\n1 2\n", {}, r"line 1: 'a' is text.*skip=1"),
            ("# only this\n", {}, "holds no values after 0 skipped"),
            ("1 2\n", {"decimal": ";"}, "decimal = ';'.*choose one"),
            ("0.0,one\n0.1,two\n", {}, r"line 1: '0.0,one' is not a number: repair"),
        ],
    )
    def test_refusals(self, write, text, options, message):
        path, given = write("station.txt", text), {"x": 1, "time": 0, "unit": "g"} | options
        refused(MotionError, message, GroundMotion.from_columns, path, **given)

    def test_unclear_column(self, write):
        given = {"x": write("station.bbp", BBP), "time": 0, "unit": "g"}
        words = r"has 4 columns: name the one.*\(path, column\)"
        refused(MotionError, words, GroundMotion.from_columns, **given)
        words = "y = 2 is a column, but no file is given: set path"
        refused(MotionError, words, GroundMotion.from_columns, y=2, dt=0.1, unit="g")

    def test_several_values_a_line(self, write: Callable[[str, str], Path]) -> None:
        """Row by row, in pairs: what the message says reads the file, to the digits."""
        time = DT * np.arange(2000)
        wave = np.sin(9.0 * time) * np.sin(0.15 * time) ** 2 * 3.0
        rows = wave.reshape(-1, 5)
        text = "\n".join("".join(f"{value:10.5f}" for value in row) for row in rows)
        path = write("rows.acc", text)
        options = {"unit": "m/s2", "dt": DT}
        with pytest.raises(MotionError, match=r'5 columns.*one history, row by row.*order="rows"'):
            GroundMotion.from_columns(x=path, **options)
        with pytest.warns(MotionWarning, match=r"every 5th sample: read it with order=\"rows\""):
            GroundMotion.from_columns(x=(path, 0), **options)
        read = GroundMotion.from_columns(x=path, order="rows", **options)
        assert_allclose(read.x, wave, rtol=0.0, atol=5.1e-6)
        short = write("short.acc", text + "\n   0.00000   0.00000")
        with pytest.raises(MotionError, match=r'line 401 holds 2 numbers.*order="rows"'):
            GroundMotion.from_columns(x=(short, 0), **options)
        assert GroundMotion.from_columns(x=short, order="rows", **options).n_steps == 2002
        pairs = np.column_stack([time, wave]).reshape(-1, 10)
        path = write("pairs.v1", "\n".join(" ".join(f"{v:.7g}" for v in row) for row in pairs))
        with pytest.raises(MotionError, match=r'pairs of time and value.*order="pairs", without'):
            GroundMotion.from_columns(x=(path, 1), time=0, unit="m/s2")
        read = GroundMotion.from_columns(x=path, order="pairs", unit="m/s2")
        assert read.dt == DT
        assert_allclose(read.x, wave, rtol=1e-6, atol=1e-12)
        table = write("table.txt", "\n".join(f"{t:.3f} {v:.6f}" for t, v in pairs[:, :2]))
        with pytest.raises(MotionError, match=r"column 0 holds even times.*time=0"):
            GroundMotion.from_columns(x=table, order="rows", **options)
        both = np.column_stack([wave, np.roll(wave, 700)])
        np.savetxt(path, both)
        layout = ColumnLayout("m/s2", dt=DT, order="rows")
        with pytest.warns(MotionWarning, match=r"seem to be 2 components.*order=\"columns\""):
            read_columns(path, None, layout)
        read = GroundMotion.from_columns(path, x=0, order="columns", **options)
        assert_allclose(read.x, wave, rtol=1e-12, atol=1e-15)

    @pytest.mark.parametrize(
        ("text", "message", "cure"),
        [
            (" -9.643590-13.350390\n  1.000000  2.000000", "without sep.*width=10", {"width": 10}),
            ("-1.500-2.5\n-2.500-3.7", r"without sep.*set their width, width=\.\.\.", {"width": 6}),
            ("head\nmore\n1.0 2.0\n1.0 2.0\n", "'head' is text.*skip=2", {"skip": 2}),
            ("1,0 2,0\n3,0 4,0\n", 'decimal comma.*decimal=","', {"decimal": ","}),
            ("1.0,2.0\n3.0,4.0\n", 'separated by commas.*delimiter=","', {"delimiter": ","}),
            ("1.0 2.0\n3.0 4.0\nEnd of data\n", "line 3: 'End'.*or remove it", "End of data"),
            ("1.0 2.0\n3.0\n4.0 5.0\n", "line 2 holds 1 numbers.*repair line 2", "3.0\n"),
            ("1.0 *****\n3.0 4.0\n", r"line 1: '\*+' is not a number.*repair", "1.0 *****\n"),
        ],
    )
    def test_causes_and_cures(self, write, text, message, cure):
        path = write("odd.txt", text)
        options = {"unit": "m/s2", "dt": 0.1}
        refused(MotionError, message, GroundMotion.from_columns, x=(path, 0), **options)
        if isinstance(cure, dict):
            options |= cure
        else:
            path.write_text(text.replace(str(cure), "3.0 4.0\n"))
        read = GroundMotion.from_columns(path, x=0, y=1, **options)
        assert_allclose(read.components[-1, :2] - read.components[0, :2], CURED[message])

    def test_spreadsheets_marks_and_what_is_no_text(self, write):
        path = write("semi.csv", "\ufeff0,0;1,5\n0,1;2,5D+00\n")
        read = GroundMotion.from_columns(x=path, time=0, unit="mm/s2")
        assert_allclose(read.x, [0.0015, 0.0025], rtol=1e-15)
        path.write_text("0,5;1,5\n2,5\n", encoding="utf-8")  # the first line has the separator
        read = GroundMotion.from_columns(x=path, dt=0.1, order="rows", unit="m/s2")
        assert read.x.tolist() == [0.5, 1.5, 2.5]
        path.write_text("0.0\t1.5\n0.1\t2.5\n", encoding="utf-16")
        assert GroundMotion.from_columns(x=path, time=0, unit="m/s2").x.tolist() == [1.5, 2.5]
        path.write_bytes(b"\x00\x01" * 300)
        with pytest.raises(MotionError, match=r"is binary.*GroundMotion\(x="):
            GroundMotion.from_columns(x=path, time=0, unit="m/s2")


class TestChecks:
    @pytest.mark.parametrize(
        ("options", "message"),
        [
            ({"x": [0.0, 1.0]}, r"dt = nan \[s\] must be positive and finite: give the time step"),
            ({"x": [0.0, 1.0], "dt": 0.0}, r"dt = 0 \[s\] must be positive"),
            ({"dt": 0.1}, r"at least one of x, y and z"),
            ({"x": [1.0], "dt": 0.1}, r"x has shape \(1,\).*at least 2 samples"),
            ({"y": [[1.0, 2.0]], "dt": 0.1}, r"y has shape \(1, 2\)"),
            ({"z": [1.0, math.nan, 2.0], "dt": 0.1}, r"z\[1\] = nan must be finite"),
            ({"x": "record.AT2", "dt": 0.1}, r"x must be a 1-D array.*use from_at2"),
            ({"x": np.array([1.0, 2.0j]), "dt": 0.1}, r"x has complex numbers.*values.real"),
            (
                {"y": np.ma.masked_equal([1.0, 9.0, 2.0], 9.0), "dt": 0.1},
                r"y has 1 masked values.*values.filled",
            ),
            (
                {"x": np.zeros(100), "y": np.zeros(79), "dt": 0.1},
                r"y has 79 samples and x has 100.*at most 20",
            ),
            (
                {"x": np.zeros(5000), "z": np.zeros(5051), "dt": 0.1},
                r"x has 5000 samples and z has 5051.*at most 50",
            ),
        ],
    )
    def test_refusals(self, options: dict[str, object], message: str) -> None:
        refused(MotionError, message, GroundMotion, **options)

    @pytest.mark.parametrize("dt", ["soon", "0.01", None, True, [0.01]])
    def test_a_step_is_a_number(self, dt: object) -> None:
        with pytest.raises(TypeError, match=rf"dt = {re.escape(repr(dt))} is not a number"):
            GroundMotion(x=[0.0, 1.0], dt=dt)

    def test_filling_up(self) -> None:
        motion = GroundMotion(x=np.ones(100), z=np.ones(80), dt=0.01)
        assert motion.n_steps == 100
        assert motion.components.shape == (100, 3)
        assert motion.components.flags.c_contiguous
        assert motion.components.sum(axis=0).tolist() == [100.0, 0.0, 80.0]

    def test_arrays_are_copies_and_read_only(self) -> None:
        given_values = np.ones(3)
        motion = GroundMotion(x=given_values, dt=0.1)
        given_values[0] = 5.0
        assert motion.x is not None
        assert motion.x[0] == 1.0
        with pytest.raises(ValueError, match="read-only"):
            motion.x[0] = 2.0
        with pytest.raises(AttributeError):
            motion.dt = 0.2  # type: ignore[misc]


class TestCopies:
    def test_time(self) -> None:
        motion = two_components()
        assert motion.n_steps == len(motion.time) == 301
        assert motion.time[-1] == pytest.approx(motion.duration, rel=1e-14)

    def test_scaled(self) -> None:
        motion = two_components()
        assert motion.scaled(-2.0).peak["y"] == pytest.approx(1.0, rel=1e-14)
        one = motion.scaled((3.0, 0.0, 1.0))
        assert_allclose(one.components, motion.components * [3.0, 0.0, 1.0], rtol=0.0, atol=0.0)
        assert (one.name, one.z) == ("made", None)
        refused(MotionError, "factor has 2 entries", motion.scaled, (1.0, 2.0))
        refused(MotionError, "factor = inf must be finite", motion.scaled, math.inf)

    def test_quarter_turn(self) -> None:
        motion = GroundMotion(x=[1.0, 2.0], z=[3.0, 4.0], dt=0.1).rotated(0.5 * math.pi)
        wanted = [[0.0, 1.0, 3.0], [0.0, 2.0, 4.0]]
        assert_allclose(motion.components, wanted, rtol=0.0, atol=1e-15)

    @given(st.floats(-10.0, 10.0), st.floats(-10.0, 10.0))
    def test_rotations_add_up_and_keep_lengths(self, one: float, two: float) -> None:
        motion = two_components()
        turned = motion.rotated(one).rotated(two).components
        assert_allclose(turned, motion.rotated(one + two).components, rtol=0.0, atol=1e-13)
        lengths = np.hypot(*motion.components[:, :2].T)
        assert_allclose(np.hypot(*turned[:, :2].T), lengths, rtol=1e-13, atol=0.0)

    def test_trimmed(self) -> None:
        motion = two_components().trimmed(0.1, 0.3)
        assert motion.n_steps == 21
        assert_allclose(motion.x, two_components().components[10:31, 0], rtol=0.0, atol=0.0)
        assert two_components().trimmed().n_steps == 301
        with pytest.raises(MotionError, match=r"start = 4 s, end = 3 s leave fewer than 2.*3 s"):
            two_components().trimmed(4.0)

    def test_resampled(self) -> None:
        motion = two_components()
        fine = motion.resampled(0.0025)
        assert fine.n_steps == 1201
        assert_allclose(fine.components[::4], motion.components, rtol=0.0, atol=1e-15)
        middle = 0.5 * (motion.components[1:] + motion.components[:-1])
        assert_allclose(fine.components[2::4], middle, rtol=0.0, atol=1e-14)
        assert motion.resampled(0.7).n_steps == 5  # 2.8 s of 3 s
        for bad in (0.0, 3.1):
            refused(MotionError, f"dt = {bad:g} s must be.*at most 3 s", motion.resampled, bad)

    def test_with_tail(self) -> None:
        motion = two_components().with_tail(0.025)
        assert motion.n_steps == 304
        assert not motion.components[301:].any()
        refused(MotionError, r"seconds = -1 must be at least 0.*trimmed", motion.with_tail, -1.0)

    def test_words(self) -> None:
        motion = two_components()
        peaks = "peak x 1.000, y 0.500 m/s2"
        assert repr(motion) == f"GroundMotion 'made': 301 samples, dt = 0.01 s, 3 s, {peaks}"
        assert "y: peak 0.500 m/s2 (0.051 g)" in motion.summary()


class TestSpectrum:
    @pytest.mark.parametrize(("period", "damping"), [(0.4, 0.0), (1.0, 0.05), (9.0, 0.3)])
    def test_against_the_matrix_exponential(self, period: float, damping: float) -> None:
        """The same exact step another way: displacement, velocity, ground and its slope."""
        motion = GroundMotion(x=np.random.default_rng(3).normal(size=400), dt=0.01)
        omega = 2.0 * math.pi / period
        system = np.zeros((4, 4))
        system[0, 1] = system[2, 3] = 1.0
        system[1, :3] = -(omega**2), -2.0 * damping * omega, -1.0
        step = expm(system * motion.dt)
        ground, state, wanted = motion.components[:, 0], np.zeros(4), 0.0
        for now, later in itertools.pairwise(ground):
            state[2:] = now, (later - now) / motion.dt
            state = step @ state
            wanted = max(wanted, abs(state[0]))
        system[1, 2] = 0.0  # the motion has ended
        free = expm(system * period / 40)
        for _ in range(40):
            state = free @ state
            wanted = max(wanted, abs(state[0]))
        peak = motion.response_spectrum([period], damping)["displacement"]
        # round-off only: phi_2 loses (omega dt)^-1 of the digits
        assert_allclose(peak, wanted, rtol=1e-11, atol=0.0)

    def test_rigid_end(self) -> None:
        motion = two_components()
        spectrum = motion.response_spectrum([0.0, 1e-4], component="x")
        assert spectrum["pseudo_acceleration"].values[0] == motion.peak["x"]
        # sin(7 t) is followed quasi-statically: the difference is (7 / omega)^2, and 0.3 %
        assert_allclose(spectrum["pseudo_acceleration"][1], motion.peak["x"], rtol=3e-3, atol=0.0)
        assert spectrum["displacement"].values[0] == 0.0
        assert spectrum["pseudo_velocity"].values[0] == 0.0

    def test_labels_and_linearity(self) -> None:
        motion = two_components()
        periods = np.geomspace(0.05, 5.0, 12)
        data = motion.response_spectrum(periods, 0.1, "y")
        assert data.sizes == {"period": 12}
        assert data.attrs == {"damping": 0.1, "motion": "made", "component": "y"}
        units = {"pseudo_acceleration": "m/s2", "pseudo_velocity": "m/s", "displacement": "m"}
        assert {name: data[name].attrs["units"] for name in data.data_vars} == units
        assert data["period"].attrs["units"] == "s"
        assert all(data[name].attrs["long_name"] for name in data.variables)
        omega = 2.0 * np.pi / periods
        assert_allclose(data["pseudo_velocity"], omega * data["displacement"], rtol=1e-14, atol=0.0)
        double = motion.scaled(-2.0).response_spectrum(periods, 0.1, "y")
        assert_allclose(double["displacement"], 2.0 * data["displacement"], rtol=1e-14, atol=0.0)
        fine = motion.resampled(0.002).response_spectrum(periods, 0.1, "y")
        assert_allclose(fine["displacement"], data["displacement"], rtol=3e-3, atol=0.0)

    @pytest.mark.parametrize(
        ("options", "message"),
        [
            ({"periods": [1.0, -0.5]}, r"periods hold -0.5"),
            ({"periods": [[1.0]]}, r"periods have shape \(1, 1\)"),
            ({"periods": [1.0j]}, "periods has complex numbers"),
            ({"periods": [1.0], "damping": 5.0}, r"damping = 5 must be.*5 % is 0.05"),
            ({"periods": [1.0], "component": "z"}, r"component = 'z': choose one of x, y"),
        ],
    )
    def test_refusals(self, options: dict[str, object], message: str) -> None:
        refused(MotionError, message, lambda: two_components().response_spectrum(**options))


MOVING_AT_ITS_END = "5071"
"""Station of the Landers records with 19 % of the peak velocity left; all others at most 2 %."""


@pytest.mark.records
def test_a_record_that_still_moves_at_its_end(records: Path) -> None:
    """Of all processed records of the folder (the test below) this one alone is named."""
    for path in records.glob(f"**/{MOVING_AT_ITS_END}.bbp"):
        with pytest.warns(MotionWarning, match=r"x: .*19% of its peak.*-0.192 m; z: .*19%"):
            motion = GroundMotion.from_columns(path, x=2, y=1, z=3, time=0, unit="cm/s2")
        still = motion.corrected()
        assert max(left.share for left in still.drift.values()) < 1e-12
        assert_allclose(list(still.peak.values()), list(motion.peak.values()), rtol=5e-4)


@pytest.mark.records
def test_every_file_of_the_records_folder(records: Path) -> None:
    motions = [GroundMotion.from_at2(path) for path in sorted(records.glob("*.AT2"))]
    motions += [
        GroundMotion.from_columns(path, x=2, y=1, z=3, time=0, unit="cm/s2")
        for path in sorted(records.glob("**/*.bbp"))
        if path.stem != MOVING_AT_ITS_END
    ]
    motions += [
        GroundMotion.from_columns(
            x=path,
            y=path.with_name(path.name.replace("-E.", "-N.")),
            z=path.with_name(path.name.replace("-E.", "-V.")),
            dt=0.005,
            unit="g",
        )
        for path in sorted(records.glob("*-E.ATH"))
    ]
    assert motions, f"no record in {records}"
    for motion in motions:
        # strong motion: stronger than 0.02 g, weaker than 2 g, and long enough to be one
        assert all(0.02 * G < peak < 2.0 * G for peak in motion.peak.values()), motion.summary()
        assert motion.duration > 15.0
        assert 0.002 <= motion.dt <= 0.02


@pytest.mark.parametrize("dt", [1e-300, 9e-10, 5e-324, 1e-10])
def test_steps_and_tails_at_the_ends_of_arithmetic_are_refused(dt: float) -> None:
    words = rf"dt = {dt:g} s is shorter than any record's"
    refused(MotionError, words, GroundMotion, x=[0.0, 1.0, 0.0], dt=dt)
    motion = GroundMotion(x=[0.0, 1.0, 0.0], dt=0.01)
    words = r"dt = .* shorter than any record's, at least 1e-09"
    refused(MotionError, words, motion.resampled, dt)
    words = r"seconds = .* must be at most 100000"
    refused(MotionError, words, motion.with_tail, min(1.0 / max(dt, 1e-300), 1e300))
