"""A friction law from outside the package: its table, its way through every door, refusals."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.interpolate import CubicHermiteSpline

from frames import GroundMotion, lumped_mass, time_history
from frames._fingerprint import fingerprint
from frames.results.peak_response import summed
from lir_element import (
    CoulombFriction,
    Element,
    FrictionLaw,
    LIRBearing,
    MeasuredFriction,
    VelocityFriction,
    cyclic_test,
)
from lir_element.device.friction import known_laws, without_class
from lir_element.kernels.friction_law import coefficient, left_of_drop
from tests.refusals import refused
from tests.scenes import BOUNDS, DEVICE, MOTIONS, SOIL, STICK, small_bearing

LOAD = 1e6


@dataclass(frozen=True)
class ExponentialByTable(FrictionLaw):
    """The law of `VelocityFriction`, of which kernels know nothing but speeds and values."""

    f_max: float
    f_min: float
    rate: float

    def at_speed(self, speed: float) -> float:
        return self.f_max - (self.f_max - self.f_min) * math.exp(-self.rate * speed)


@dataclass(frozen=True)
class HalvingFriction(FrictionLaw):
    """A hyperbola over the speed."""

    f_max: float
    f_min: float
    half_speed: float = field(metadata={"unit": "m/s"})

    def at_speed(self, speed: float) -> float:
        return self.f_min + (self.f_max - self.f_min) * speed / (speed + self.half_speed)


@dataclass(frozen=True)
class AnyFriction(FrictionLaw):
    """A law that calls a function."""

    of: Callable[[float], float]

    def at_speed(self, speed: float) -> float:
        return self.of(speed)


LAW = HalvingFriction(0.066, 0.03, 0.03)


def device(friction: Any = LAW, **changes: Any) -> LIRBearing:
    return small_bearing(**{"friction": friction, "design_load": LOAD} | changes)


def shaking(dt: float = 0.005, end: float = 1.8) -> GroundMotion:
    t = np.arange(0.0, end, dt)

    def wave(size: float, period: float) -> np.ndarray:
        return size * np.sin(2.0 * np.pi * t / period) * np.sin(np.pi * t / end)

    return GroundMotion(x=wave(2.8, 1.2), y=wave(0.8, 1.0), z=wave(0.5, 0.7), dt=dt)


@pytest.mark.quick
@pytest.mark.parametrize("law", [LAW, ExponentialByTable(0.065, 0.0325, 15.0), LAW.scaled(1.2)])
def test_kernels_follow_the_law_at_all_speeds(law: FrictionLaw) -> None:
    values, p = law.kernel_values(), device(law).to_record()[0]
    assert values.error < 1e-8 * law.f_max
    speeds = [0.0, *np.geomspace(1e-7, 1e4, 400)]
    found = np.array([coefficient(p, 1, v) for v in speeds])
    # round-off of the table beside what was measured between its knots
    assert_allclose(
        found[:, 0], [law.at_speed(v) for v in speeds], rtol=1e-13, atol=2 * values.error
    )
    for v, (_, slope) in zip(speeds, found, strict=True):
        h = 1e-4 * (v + 1e-3)
        steep = (coefficient(p, 1, v + h)[0] - coefficient(p, 1, max(v - h, 0.0))[0]) / (
            v + h - max(v - h, 0.0)
        )
        assert slope == pytest.approx(steep, rel=2e-3, abs=1e-9 * values.drop * values.rate)
        assert 0.0 <= slope <= values.drop * values.rate * (1.0 + 1e-9)
    assert (np.diff(found[:, 0]) >= 0.0).all()
    assert law.f_min == found[0, 0]


def test_the_table_is_a_cubic_of_hermite_and_its_slope_that_of_it() -> None:
    """scipy's, between the same knots; a speed that is no number gives none."""
    table = np.array(LAW.kernel_values().table)
    knots = np.linspace(0.0, 1.0, (len(table) - 1) // 2)
    curve = CubicHermiteSpline(knots, table[1::2], table[2::2])
    for v in [0.0, 1e-3, 0.02, 0.5, 40.0]:
        x, by_v = v / (v + table[0]), table[0] / (v + table[0]) ** 2
        share, fall = left_of_drop(1.0, 0.0, table, v)
        assert share == pytest.approx(float(curve(x)), abs=1e-14)
        assert fall == pytest.approx(-float(curve(x, 1)) * by_v, rel=1e-10)
    assert math.isnan(left_of_drop(1.0, 0.0, table, math.nan)[0])


def test_fields_that_a_law_has_stand_for_its_limits() -> None:
    exact = AnyFriction(LAW.at_speed)
    assert (LAW.f_max, LAW.f_min) == (0.066, 0.03)
    assert (exact.f_max, exact.f_min) == pytest.approx((0.066, 0.03), rel=1e-12)
    assert LAW.scaled(2.0).scaled(0.5).kernel_values() == LAW.kernel_values()
    assert LAW.scaled(1.25).at_speed(0.03) == pytest.approx(1.25 * 0.048)
    refused(ValueError, r"f_max = 1.056 .* below 1", LAW.scaled, 16.0)
    level = AnyFriction(lambda speed: 0.05)
    assert level.kernel_values()[:4] == (0.05, 0.0, 0.0, ())
    data = [cyclic_test(device(law), [0.0, 0.02], LOAD) for law in (level, CoulombFriction(0.05))]
    assert_array_equal(data[0]["bearing_force"], data[1]["bearing_force"])


def test_the_table_goes_where_a_class_cannot() -> None:
    sent = without_class(LAW)
    assert sent.kernel_values() == LAW.kernel_values()
    assert sent.at_speed(0.1) == pytest.approx(LAW.at_speed(0.1), abs=1e-10)
    assert (sent.f_max, sent.f_min) == pytest.approx((0.066, 0.03), rel=1e-10)
    same = VelocityFriction(0.06, 0.03, 20.0)
    assert without_class(same) is same


@pytest.mark.quick
@pytest.mark.parametrize("level", ["pendulum", "contact", "rigid_body"])
def test_the_exponential_by_table_is_the_exponential(level: Any) -> None:
    exact, law = VelocityFriction(0.066, 0.033, 20.0), ExponentialByTable(0.066, 0.033, 20.0)
    path = [0.0, 0.03, 0.01] if level == "rigid_body" else [0.0, 0.06, 0.179, 0.1]
    path = path[: 3 if level == "contact" else None]
    one, two = (
        cyclic_test(device(each), path, LOAD, velocity=0.3, level=level) for each in (exact, law)
    )
    error = law.kernel_values().error
    # both surfaces, over the string: a coefficient's error passes (R1 + R2) / L times; with a rest
    # of what Newton's methods leave and, of free bodies, of the steps that they choose
    rest = {"pendulum": 1e-11, "contact": 1e-9, "rigid_body": 1e-8}[level]
    limit = (4.0 * error + rest) * LOAD
    assert np.abs(one["bearing_force"] - two["bearing_force"]).max() < limit
    assert (
        np.abs(one["friction_coefficient"] - two["friction_coefficient"]).max() < 4.0 * error + rest
    )
    assert float(one["sliding_speed"].max()) > 0.1


@pytest.mark.quick
def test_measured_points_give_their_isotonic_fit() -> None:
    """By the formula max over j <= i of min over k >= i of the mean of j to k (Barlow 1972)."""
    speeds = np.geomspace(0.002, 0.4, 12)
    fit = LAW.f_min + (LAW.f_max - LAW.f_min) * speeds / (speeds + LAW.half_speed)
    tests = fit + 0.004 * np.random.default_rng(3).standard_normal(12)
    law = MeasuredFriction([*speeds[::-1], *speeds], [*tests[::-1] + 0.001, *tests - 0.001])
    nearest = np.array(
        [
            max(min(tests[j : k + 1].mean() for k in range(i, 12)) for j in range(i + 1))
            for i in range(12)
        ]
    )
    error = 2.0 * law.kernel_values().error
    assert error < 1e-3
    assert len(set(nearest)) < 12
    for value in set(nearest):
        block = nearest == value
        assert law.at_speed(speeds[block].mean()) == pytest.approx(value, abs=error)
    assert (law.f_min, law.f_max) == pytest.approx((nearest[0], nearest[-1]), abs=error)
    p = device(law).to_record()[0]
    at = [0.0, *np.geomspace(1e-6, 1e3, 300)]
    found = [coefficient(p, 1, v)[0] for v in at]
    assert_allclose(found, [law.at_speed(v) for v in at], rtol=1e-13)
    assert (np.diff(found) >= 0.0).all()
    off = [law.at_speed(v) - f for v, f in zip(law.speeds, law.coefficients, strict=True)]
    assert law.misfit == pytest.approx(np.sqrt(np.mean(np.square(off))))
    assert 0.001 < law.misfit < 0.01
    assert MeasuredFriction([0.1], [0.05]).at_speed(0.0) == 0.05
    with pytest.raises(ValueError, match="1 speeds and 2 coefficients: pass one speed"):
        MeasuredFriction([0.1], [0.05, 0.06])
    refused(ValueError, r"coefficients\[0\] = 6.* below 1", MeasuredFriction, [0.1], [6.0])


@pytest.mark.parametrize("level", ["pendulum", "contact"])
def test_tangent_is_the_derivative(level: Any) -> None:
    element, dt = Element(device(), level), 2e-3
    u = np.zeros(12)
    u[8] = -LOAD / device().resolved()["axial_stiffness"]
    element.set_trial(u, np.zeros(12), 0.0)
    element.commit()
    for k in range(1, 11):  # 0.1 m/s: 0.05 m/s on a surface, where friction rises steeply
        u[6], u[7] = 2e-4 * k, 1e-4 * k
        element.set_trial(u, np.zeros(12), dt * k)
        if k < 10:
            element.commit()
    tangent, size = element.tangent_stiffness(), 2e-8
    speed = element.response("sliding_speed")
    assert (speed > 0.03).all()
    found = np.zeros((12, 3))
    for column in range(3):
        for sign in (1.0, -1.0):
            moved = u.copy()
            moved[6 + column] += sign * size
            element.set_trial(moved, np.zeros(12), dt * 10)
            found[:, column] += sign * element.resisting_force() / (2.0 * size)
    scale = np.abs(tangent[:, 6:8]).max()
    # second order in the size over the yield displacement; round-off of forces over the size
    assert_allclose(found[:, :2] / scale, tangent[:, 6:8] / scale, rtol=0.0, atol=2e-5)
    by_speed = (LAW.f_max - LAW.f_min) * 0.03 / (speed[0] + 0.03) ** 2 * LOAD / dt
    assert scale > 0.2 * by_speed  # the law's slope is in it


@pytest.mark.quick
def test_cyclic_force_is_that_of_the_pendulum_in_closed_form() -> None:
    """W tan(theta + atan m), sin(theta) = u / L, m = mu (R1 + R2) / L at the speed R theta'.

    For small m and u / L that is W (m + u / L), but for half of the square of that.
    """
    rigid = device(replace(LAW, half_speed=0.2), interface_friction=math.inf)
    path = np.linspace(0.0, 0.12, 13)
    for velocity in (0.02, 0.2, 1.0):
        data = cyclic_test(rigid, path, LOAD, velocity=velocity)
        # the spheres' centres are further apart by what the load closes
        length = rigid.effective_radius + LOAD / rigid.resolved()["axial_stiffness"]
        for k in (4, 8, 12):
            tilt = math.asin(path[k] / length)
            speed = 0.75 * velocity / (length * math.cos(tilt))
            m = rigid.frictions[0].at_speed(speed) * 1.5 / length
            force = float(data["bearing_force"].sel(axis="x")[k, 0])
            assert force == pytest.approx(LOAD * math.tan(tilt + math.atan(m)), rel=5e-6)
            plain = m + path[k] / length
            assert force == pytest.approx(LOAD * plain, rel=0.5 * plain**2)


def test_energy_balance_closes_and_what_a_run_keeps_is_the_same(run: Any) -> None:
    """Also where steps are left out: kernels sum what the Dataset would have said."""
    model, motion = lumped_mass(device((LAW, CoulombFriction(0.05))), 1e5), shaking()
    full, thin = (run(model, motion, dt=0.005, record_every=n) for n in (1, 8))
    assert float(full["work_low_friction"].isel(time=-1).sum()) > 0.0
    for name in ("sliding_work", "sliding_work_lower"):
        assert float(summed(full, name)) == pytest.approx(float(summed(thin, name)), rel=1e-12)
    table = full["friction_table"].isel(bearing=0)
    assert table.sel(surface="bottom")[0] > 0.0
    assert not table.sel(surface="top").any()
    assert "below that at high speed" in str(full.attrs["audit"])


def test_speed_left_out_is_friction_at_high_speed(run: Any) -> None:
    from lir_element import Features

    out = Features(velocity_dependence=False)
    plain, table = (
        run(lumped_mass(device(law), 1e5), shaking(end=0.8), dt=0.005, features=out)
        for law in (CoulombFriction(0.066), LAW)
    )
    assert_allclose(plain["bearing_force"], table["bearing_force"], rtol=1e-9, atol=1e-6)


@pytest.mark.parametrize("level", ["pendulum", "contact"])
def test_the_plug_in_takes_the_law(stand: Any, level: str) -> None:
    pytest.importorskip("openseespy")
    steps, dt = 60, 0.005
    stand.build(device(), level=level)
    stand.gravity(stand.MASS * 9.80665)
    stand.shaking(2.8, tolerance=1e-8)
    moved = stand.run(steps, dt)
    t = dt * np.arange(steps + 1)
    motion = GroundMotion(x=2.8 * np.sin(2.0 * np.pi * t), dt=dt)
    ours = time_history(lumped_mass(device(), stand.MASS), motion, dt=dt, level=level)
    expected = ours["bearing_displacement"].sel(axis="x").isel(bearing=0)[1:]
    largest = float(np.abs(expected).max())
    assert largest > 0.01
    assert_allclose(moved[:, 0], expected, rtol=0.0, atol=2e-3 * largest)
    other = time_history(
        lumped_mass(device(CoulombFriction(0.066)), stand.MASS), motion, dt=dt, level=level
    )
    apart = other["bearing_displacement"].sel(axis="x").isel(bearing=0)[1:] - moved[:, 0]
    assert float(np.abs(apart).max()) > 0.02 * largest  # the law matters


def test_opensees_own_elements_refuse_it() -> None:
    pytest.importorskip("openseespy")
    from lir_element.opensees import builtin_values, macro_model, opensees

    with pytest.raises(ValueError, match=r"HalvingFriction\(.*OpenSees supports Coulomb friction"):
        builtin_values(device().as_dcfp(), LOAD)
    ops = opensees()
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    ops.node(1, 0.0, 0.0, 0.0)
    ops.node(2, 0.0, 0.0, 0.0)
    with pytest.raises(ValueError, match=r"HalvingFriction\(.*or bearing_element"):
        macro_model(device(), 1, 2, load=LOAD)
    ops.wipe()


FALLING = (
    r"falls with speed, from 0.06 at 0 m/s to 0.04\d* at .* must not decrease.*FrictionHeating"
)


@pytest.mark.parametrize(
    ("law", "words"),
    [
        (lambda v: 0.04 + 0.02 * math.exp(-20.0 * v), FALLING),
        (lambda v: math.nan, "is nan at 0 m/s: it must be finite"),
        (lambda v: 1.05 * v / (v + 1.0), r"is 1.0\d+ at .* at least 0 and below 1"),
        (lambda v: -0.01 + 0.05 * v / (v + 1.0), r"is -0.01 at 0 m/s: .* at least 0"),
        (lambda v: 0.03 + 0.004 * math.log1p(v), "has no limit at high speed: it is"),
        (
            lambda v: 0.05 * math.exp(v) / (1.0 + math.exp(v)),
            r"fails at .*OverflowError.*exp\(-v\)",
        ),
        (lambda v: 0.03 if v < 0.05 else 0.05, r"changes too abruptly at 0.05\d* m/s: .* jumps"),
    ],
)
def test_a_law_that_kernels_cannot_take_is_refused(law: Any, words: str) -> None:
    refused(ValueError, "AnyFriction .*" + words, AnyFriction, law)


@dataclass(frozen=True)
class UnlikeFriction(FrictionLaw):
    """A law whose own limits are not those that it gives."""

    f_max: float
    f_min: float

    def at_speed(self, speed: float) -> float:
        return 0.06 - 0.03 / (1.0 + 20.0 * speed)


def test_limits_that_a_law_names_must_be_its_own() -> None:
    assert UnlikeFriction(0.06, 0.03).kernel_values().error < 1e-9
    with pytest.raises(ValueError, match=r"f_max = 0.05, but at high speed the law gives 0.06: re"):
        UnlikeFriction(0.05, 0.03)
    refused(ValueError, r"f_min = 0.02, but at rest the law gives 0.03", UnlikeFriction, 0.06, 0.02)


def test_straight_lines_between_points_are_taken_and_their_error_told() -> None:
    points = [0.0, 0.01, 0.05, 0.1, 0.3, 0.6], [0.03, 0.04, 0.05, 0.055, 0.059, 0.06]
    values = AnyFriction(lambda v: float(np.interp(v, *points))).kernel_values()
    assert 1e-6 < values.error / values.most < 1e-3


def test_what_is_no_frozen_dataclass_is_refused() -> None:
    class Loose(FrictionLaw):
        def at_speed(self, speed: float) -> float:
            return 0.05

    refused(TypeError, "Loose must be a frozen dataclass: write @dataclass", device, Loose())

    @dataclass(frozen=True)
    class Listed(FrictionLaw):
        values: list[float]

        def at_speed(self, speed: float) -> float:
            return self.values[0]

    refused(TypeError, "Listed: unhashable type: 'list'; use numbers", Listed, [0.05])
    with pytest.raises(
        TypeError, match="must derive from FrictionLaw: the formula of VelocityFriction"
    ):

        class Faster(VelocityFriction):  # type: ignore[misc]
            pass

    refused(TypeError, "abstract", FrictionLaw)  # type: ignore[abstract]


def test_friction_that_hardly_depends_on_speed_is_named() -> None:
    from lir_element import DesignWarning

    with pytest.warns(DesignWarning, match="growth of HalvingFriction over its range = 0.0333"):
        device(replace(LAW, half_speed=30.0))


def test_names_of_laws() -> None:
    names = [law.__name__ for law in known_laws()]
    assert names[:2] == ["CoulombFriction", "VelocityFriction"]
    assert "HalvingFriction" in names
    assert not [name for name in names if name.startswith("_")]
    assert names.count("HalvingFriction") == 1


def test_a_changed_formula_is_another_model() -> None:
    """Fields say nothing of what a class computes: runs that were kept must not be taken for it."""

    def made(power: float) -> FrictionLaw:
        @dataclass(frozen=True)
        class Edited(FrictionLaw):
            f_max: float

            def at_speed(self, speed: float) -> float:
                return self.f_max * (1.0 - 0.5 / (1.0 + speed) ** power)

        return Edited(0.06)

    one, same, other = made(10.0), made(10.0), made(20.0)
    assert fingerprint(one) == fingerprint(same) != fingerprint(other)


ISLAND = """
from dataclasses import dataclass, field

from lir_element import FrictionLaw


@dataclass(frozen=True)
class IslandFriction(FrictionLaw):
    f_max: float
    f_min: float
    half_speed: float = field(metadata={"unit": "m/s"})

    def at_speed(self, speed):
        return self.f_min + (self.f_max - self.f_min) * speed / (speed + self.half_speed)
"""
ISLAND_LAW = '{ law = "IslandFriction", f_max = 0.06, f_min = 0.03, half_speed = "20 mm/s" }'
STRUCTURE = STICK + DEVICE.replace("0.06", ISLAND_LAW) + MOTIONS + 'only = ["artificial-1"]\n'
PROJECT = (
    '[project]\nname = "Harbour"\ncode = "NCh2745"\nextensions = ["laws.py"]\n'
    + STRUCTURE
    + SOIL
    + BOUNDS
)
CAMPAIGN = (
    '[campaign]\nname = "Speeds"\nextensions = ["laws.py"]\n'
    + STRUCTURE
    + '[parameters]\nhalf_speed = { values = ["10 mm/s", "0.5 m/s"] }\n'
    + '[sample]\nkind = "grid"\n[analysis]\nduration = "3 s"\nworkers = 1\n'
)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    pytest.importorskip("pydantic")
    pytest.importorskip("pint")
    from frames.design.project import source_files
    from lir_element.device import friction

    monkeypatch.setattr(source_files, "_LOADED", {})
    monkeypatch.setattr(friction, "_KNOWN", dict(friction._KNOWN))
    (tmp_path / "laws.py").write_text(ISLAND)
    (tmp_path / "project.toml").write_text(PROJECT)
    return tmp_path


def bearing_of(folder: Path) -> LIRBearing:
    from frames.design.project.inputs import ProjectInputs
    from frames.design.project.reading import read_project

    return ProjectInputs(read_project(folder / "project.toml"), folder).bearing()


def test_a_project_names_a_law_of_its_extension(folder: Path) -> None:
    from frames.design import PropertyBounds, PropertyModificationFactors, with_property_bounds
    from frames.design.project.reading import schema

    found = bearing_of(folder)
    law = found.frictions[0]
    assert type(law).__name__ == "IslandFriction"
    assert (law.f_max, law.f_min, law.at_speed(0.02)) == pytest.approx((0.06, 0.03, 0.045))
    assert "IslandFriction" in schema()
    assert "IslandFriction" in repr(found)
    assert "IslandFriction" in found.describe()
    bounds = PropertyBounds(PropertyModificationFactors(0.8, 1.3))
    upper = with_property_bounds(found, "upper", bounds).frictions[0]
    assert upper.at_speed(0.02) == pytest.approx(1.3 * 0.045)
    assert "1.3 * IslandFriction(" in repr(upper)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('"IslandFriction"', '"IslandFrction"', r"friction: its law is not known: .*\"IslandFric"),
        ('half_speed = "20 mm/s"', 'half_sped = "20 mm/s"', "half_sped is not known; is .half_spe"),
        ('half_speed = "20 mm/s"', "half_speed = 0.02", "half_speed = 0.02 has no unit"),
        ('half_speed = "20 mm/s"', 'half_speed = "20 mm"', 'is in "mm", not a unit of m/s'),
        ("f_min = 0.03", "f_min = 0.07", "IslandFriction falls with speed"),
    ],
)
def test_messages_of_a_file_name_key_and_remedy(folder, old, new, words):
    from frames.design import ProjectError

    (folder / "project.toml").write_text(PROJECT.replace(old, new, 1))
    refused(ProjectError, words, bearing_of, folder)


def test_a_name_given_twice_is_told(folder: Path) -> None:
    from frames.design import ProjectError

    (folder / "more.py").write_text(ISLAND)
    (folder / "project.toml").write_text(PROJECT.replace('["laws.py"]', '["laws.py", "more.py"]'))
    with pytest.raises(ProjectError, match=r"IslandFriction is written in \S+laws and in \S+more"):
        bearing_of(folder)


def test_a_campaign_varies_a_field_of_the_law(folder, put_example):
    pytest.importorskip("filelock")
    from frames.design import ProjectError
    from frames.risk.campaign.file import read_campaign

    put_example(folder)
    (folder / "speeds.toml").write_text(CAMPAIGN)
    campaign = read_campaign(folder / "speeds.toml")
    campaign.run(workers=1)
    data = campaign.results()
    assert sorted(data["half_speed"].to_numpy().tolist()) == [0.01, 0.5]
    moved = data["peak_displacement"].max("bearing").sortby(data["half_speed"]).to_numpy()
    assert moved[1] > 1.005 * moved[0]  # less friction at speeds of some 0.1 m/s
    text = CAMPAIGN.replace('"0.5 m/s"]', '"0.5 m"]')
    (folder / "speeds.toml").write_text(text)
    refused(ProjectError, "not a unit of m/s", read_campaign, folder / "speeds.toml")


def test_parameters_are_fields_of_the_law() -> None:
    from frames.risk._errors import CampaignError
    from frames.risk.campaign.designs import with_parameters

    def laws(frame: Any, **parameters: float) -> set[FrictionLaw]:
        changed = with_parameters(frame, parameters)
        return {law for link in changed.bearings.values() for law in link.bearing.frictions}

    frame = lumped_mass(device(), 1e5)
    assert laws(frame, half_speed=0.05, f_max=0.07) == {HalvingFriction(0.07, 0.03, 0.05)}
    assert laws(frame, friction=0.05) == {CoulombFriction(0.05)}
    plain = lumped_mass(device(0.05), 1e5)
    assert laws(plain, coefficient=0.06) == {CoulombFriction(0.06)}
    with pytest.raises(CampaignError, match=r"half_speed: the bearing has Coulomb's .*HalvingFric"):
        laws(plain, half_speed=0.05)
    with pytest.raises(CampaignError, match="rate: the bearing has HalvingFriction; give it Velo"):
        laws(frame, rate=50.0)
