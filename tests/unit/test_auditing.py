"""The assumption check's numbers on made cases, and what follows from them."""

import functools
import math
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose

from frames import (
    Finding,
    GroundMotion,
    audit,
    audit_report,
    load,
    lumped_mass,
    moment_frame,
    save,
    time_history,
)
from frames.demo import bearing_for
from frames.design import DesignLimits, impact_checks
from frames.design.histories.suite_notes import ON_AXIAL_STIFFNESS
from frames.results.assumption_checks import needed_level
from frames.results.findings import doubts_of, findings_of
from frames.results.level_doubts import DOUBTED, level_doubts, travels
from frames.results.measures import centre_shift
from frames.results.peak_response import largest, summed
from frames.solve.escalation import escalate_level, mark_other_end
from lir_element import (
    CoulombFriction,
    Element,
    Features,
    LIRBearing,
    VelocityFriction,
)
from lir_element.device.sliders import slider_record
from lir_element.errors import RunStatus
from lir_element.results.optional_variables import interface_eccentricity
from tests.scenes import paper_bearing, simple_bearing

DT = 0.005
MASS = 3e4


device = partial(simple_bearing, capacity=0.2, interface_friction=0.12, design_load=3e5)


def wave(peak: float, period: float = 1.5, rest: float = 1.0) -> np.ndarray:
    t = np.arange(0.0, 2.0 * period, DT)
    pulse = peak * np.sin(2.0 * np.pi * t / period) * np.sin(np.pi * t / (2.0 * period))
    return np.concatenate([pulse, np.zeros(round(rest / DT))])


PULSE = GroundMotion(x=wave(1.5), dt=DT)


@functools.cache
def of_pulse(bearing: LIRBearing, **options) -> xr.Dataset:
    return time_history(lumped_mass(bearing, MASS), PULSE, dt=DT, **options)


def run(bearing: LIRBearing, motion: GroundMotion = PULSE, **options) -> xr.Dataset:
    """Analyse a mass on a bearing; under the pulse, the same bearing once."""
    if motion is PULSE:
        return of_pulse(bearing, **options).copy()
    return time_history(lumped_mass(bearing, MASS), motion, dt=DT, **options)


def found(data: xr.Dataset) -> dict[str, Finding]:
    return {finding.feature: finding for finding in audit(data)}


def test_one_finding_a_feature():
    data = run(device())
    more = ("full_contact", "slip_stability", "equilibrium", "time_step")
    assert [*found(data)] == [*Features.names(), *more]
    data.attrs["dt"] = 0.1  # skips ground motion, of which its estimated error has nothing
    assert [each.feature for each in audit(data) if each.doubtful] == ["time_step"]


def test_rims_left_out_that_were_not_needed():
    free = run(device(capacity=math.inf), features=Features(rims=False))
    largest = float(np.abs(free["bearing_displacement"].sel(axis="x")).max())
    finding = found(run(device(capacity=largest / 0.71), features=Features(rims=False)))["rims"]
    assert_allclose(finding.number, 0.71, rtol=1e-4)  # the load stretches the string: 3e-5
    assert finding.sentence == "rims left out: reached 71 % of the displacement capacity"
    assert (finding.left_out, finding.mattered) == (True, False)
    without = found(free)["rims"]
    assert (without.mattered, without.number) == (False, 0.0)


@pytest.mark.parametrize(("share", "mattered"), [(0.94, False), (0.97, True)])
def test_near_the_rims_counts_where_more_is_left_out(share, mattered):
    features = Features(rims=False, interface=False)
    free = run(device(capacity=math.inf), features=features)
    largest = float(np.abs(free["bearing_displacement"].sel(axis="x")).max())
    at = device(capacity=largest / share)
    assert found(run(at, features=features))["rims"].mattered == mattered
    assert not found(run(at, features=Features(rims=False)))["rims"].mattered


@pytest.mark.quick
def test_rims_that_were_met():
    data = run(device(capacity=0.08))
    finding = found(data)["rims"]
    touched = (data["rim_force"] > 0.0).any(["bearing", "surface"]).to_numpy()
    first = float(data["time"][int(np.argmax(touched))])
    assert finding.sentence == f"rims: met by 1 of 1 bearings, first at {first:.2f} s"
    assert finding.mattered
    assert not finding.is_missing
    slip = found(data)["interface"]
    size = 1e3 * float(data["interface_slip_size"].max())
    assert f"slipped up to {size:.3g} mm, 1 of 1 bearings, first at " in slip.sentence
    assert not slip.doubtful


def test_slip_of_sliders_that_fly_is_told_apart():
    """A mass thrown up as its rims are met: what its sliders slip on is not settled by steps."""
    time = np.arange(0.0, 1.2, 0.002)
    push = 5.0 * np.sin(2.5 * np.pi * time) * (time < 0.8)
    up = np.where((time >= 0.3) & (time < 0.4), -1.2, 0.0)
    up = 9.80665 * (up - np.where((time >= 0.7) & (time < 0.8), -1.2, 0.0))
    motion = GroundMotion(x=push, z=up, dt=0.002)
    bearing = bearing_for(2000e3)
    frame = lumped_mass(bearing, mass=204e3)
    coarse, fine = (time_history(frame, motion, level="contact", dt=dt) for dt in (None, 2.5e-4))
    beyond = []
    for data in (coarse, fine):
        slip = data["interface_slip_size"].to_numpy()[:, 0]
        loose = data["axial_force"].to_numpy()[1:, 0] <= 0.01 * float(data["static_axial_force"][0])
        gained = float(np.diff(slip)[loose].sum())
        assert float(summed(data, "slip_loose")[0]) == pytest.approx(gained, rel=1e-9)
        moved = float(np.hypot(*data["bearing_displacement"].to_numpy()[:, 0, :2].T).max())
        made = moved - bearing.lateral_capacity  # by rims, whatever sliders do
        assert 0.5 * slip.max() < made < gained
        beyond.append(slip.max() - made)
        interface = found(data)["interface"]
        assert interface.doubtful
        said = f"{1e3 * beyond[-1]:.3g} of {1e3 * slip.max():.3g} mm of slip"
        assert said in interface.sentence
        assert f"count on 130 % of those {1e3 * beyond[-1]:.3g} mm" in interface.sentence
    assert abs(beyond[0] - beyond[1]) < 0.3 * beyond[1]
    plain = found(time_history(frame, motion, level="pendulum"))["interface"]
    assert not plain.doubtful


def test_interface_left_out():
    """A rigid slider carries mu (R1 + R2) / L of its load while it slides, 0.0526; mu_h is 0.12."""
    data = run(device(), features=Features(interface=False))
    finding = found(data)["interface"]
    assert_allclose(finding.number, 0.05 * 2.0 / 1.9 / 0.12, rtol=0.01)
    assert finding.sentence == "interface left out: carried 44 % of its friction strength"
    weak = device(interface_friction=0.0528)  # within 1 %
    assert not found(run(weak, features=Features(interface=False)))["interface"].mattered
    more = Features(interface=False, uplift=False)
    assert found(run(weak, features=more))["interface"].mattered


def test_uplift_left_out():
    up = wave(6.0, 0.5)
    motion = GroundMotion(x=0.2 * up, z=up, dt=DT)
    data = run(device(), motion, features=Features(uplift=False))
    finding = found(data)["uplift"]
    least = float((data["axial_force"] / data["static_axial_force"]).min())
    assert finding.number == least
    assert 0.0 < least < 0.6
    assert finding.sentence == f"uplift left out: smallest N {least:.2f} W"
    assert not finding.mattered
    pulled = run(device(), motion.scaled(2.5), features=Features(uplift=False))
    assert found(pulled)["uplift"].mattered
    assert found(pulled)["uplift"].number < 0.0
    lifted = run(device(), motion.scaled(2.5))
    said = "uplift: lifted off: 1 of 1 bearings, first at "
    assert found(lifted)["uplift"].sentence.startswith(said)
    assert needed_level(audit(lifted)) == "contact"


def test_velocity_dependence_at_a_constant_share():
    friction = VelocityFriction(0.06, 0.03, 1e-9)  # so slow that f_min rules at all speeds
    data = run(device(friction=friction))
    finding = found(data)["velocity_dependence"]
    assert_allclose(finding.number, 0.5, rtol=1e-6)
    assert finding.mattered
    left = found(run(device(friction=friction), features=Features(velocity_dependence=False)))
    assert_allclose(left["velocity_dependence"].number, 0.5, rtol=1e-6)
    assert left["velocity_dependence"].is_missing
    assert found(run(device()))["velocity_dependence"].number == 0.0


def test_second_direction_left_out():
    motion = GroundMotion(x=wave(1.5), y=0.3 * wave(1.5), dt=DT)
    data = run(device(), motion, features=Features(second_direction=False))
    finding = found(data)["second_direction"]
    assert_allclose(finding.number, 0.3, rtol=1e-9)
    assert "peak ground velocity along y 30 % of that along x" in finding.sentence
    assert finding.mattered
    assert float(np.abs(data["ground_acceleration"].sel(axis="y")).max()) == 0.0
    calm = found(run(device(), features=Features(second_direction=False)))
    assert not calm["second_direction"].mattered


def test_vertical_coupling_left_out_is_estimated():
    """The lift of the pendulum, which the run leaves out, is added: the coupled run says so too."""
    coupled = found(run(device(capacity=math.inf)))["vertical_coupling"]
    apart = found(run(device(capacity=math.inf), features=Features(vertical_coupling=False)))
    assert coupled.number > 0.01
    assert_allclose(apart["vertical_coupling"].number, coupled.number, rtol=0.3)  # an estimate


def test_plate_rotation_is_that_of_the_spheres_centres():
    frame = moment_frame((1, 1), 1, bearing=device())
    data = time_history(frame, PULSE, dt=DT)
    turns = data["node_displacement"].sel(node="base-0-0", dof="ry")
    shift = centre_shift(data)[:, 0, 0]
    assert_allclose(shift, -1.0 * turns, rtol=0.0, atol=1e-15)  # the ground does not turn
    finding = found(data)["plate_rotation"]
    largest = np.linalg.norm(data["bearing_displacement"][..., :2], axis=-1).max()
    size = np.linalg.norm(centre_shift(data), axis=-1).max()
    assert_allclose(finding.number, size / largest, rtol=1e-12)


def test_centres_lie_where_the_axial_force_says():
    """Where a bearing is pressed, the centres' distance is beyond L + s by its force over k."""
    frame = moment_frame((1, 1), 3, bearing=device())
    data = time_history(frame, PULSE, dt=DT)
    stiffness = device().resolved()["axial_stiffness"]
    moved, length = data["bearing_displacement"].to_numpy(), data["length"].to_numpy()
    slip, force = (data[name].to_numpy() for name in ("interface_slip_size", "axial_force"))

    def off(across) -> float:
        square = (across**2).sum(axis=-1) + (length - moved[..., 2]) ** 2 - slip**2
        beyond = np.sqrt(square) - length - force / stiffness
        return float(np.abs(beyond[force > 0.0]).max())

    shift, level = centre_shift(data), moved[..., :2]
    assert off(level) > 10.0 * off(level + shift)
    assert off(level - shift) > 1.5 * off(level)  # the other sign is worse than none


def resultant(bearing: LIRBearing, element: Element, *, top: bool) -> float:
    """Return the eccentricity from moment equilibrium of one slider, with vectors in space."""
    n, p = element.response("axis"), bearing.to_record()[0]
    k = 1.0 / (1.0 + n[2])
    t = np.eye(3)[:2] - np.outer(n[:2], [k * n[0], k * n[1], 1.0])
    load, sliders = element.response("axial_force"), slider_record(bearing)
    height = abs(sliders["vertex"] - sliders["plane"])[0, int(top)]  # of the bodies themselves
    pushed = -load * n + element.response("interface_force") @ t  # down on the bottom slider
    side = int(top)
    sign = 1.0 if top else -1.0  # the vertex lies above the centre, or below
    outward = sign * np.array([n[0], n[1], 0.0]) / np.hypot(n[0], n[1])
    plate = sign * element.response("friction_force")[side] @ t
    plate = plate - element.response("rim_force")[side] * outward
    moment = np.cross(sign * p["radius"][side] * n, plate)
    pushed = -pushed if top else pushed
    moment = moment + np.cross(sign * (p["radius"][side] - height) * n, pushed)
    # e x (-+N n) must balance what is across n
    across = moment - (moment @ n) * n
    return float(np.linalg.norm(across) / load)


@pytest.mark.parametrize("lateral", [0.02, 0.09, 0.115])
def test_eccentricity_is_moment_equilibrium_of_each_slider(lateral):
    plates = {"radius": (1.4, 0.5), "slider_radius": 0.12, "friction": (0.03, 0.06)}
    bearing = device(capacity=0.1, axial_stiffness=1e9, **plates)
    element = Element(bearing)
    length = bearing.effective_radius + 2e5 / bearing.resolved()["axial_stiffness"]
    for share in np.linspace(0.0, 1.0, 200):
        u = np.zeros(12)
        u[6], u[7] = share * lateral, 0.4 * share * lateral
        u[8] = bearing.effective_radius - math.sqrt(length**2 - u[6] ** 2 - u[7] ** 2)
        element.set_trial(u, np.zeros(12), 0.0)
        element.commit()
    e = interface_eccentricity(bearing.to_record(), element._committed[None])[0, 0]
    sides = [resultant(bearing, element, top=top) for top in (False, True)]
    assert_allclose(e, max(sides), rtol=3e-3)  # equal to (A) but for the stretch of the string
    assert e > 1e-3


def test_full_contact_levels():
    data = run(device(capacity=0.08))
    share = found(data)["full_contact"].number
    assert_allclose(share, 5.0 * float(data["interface_slip_size"].max()), rtol=0.05)
    texts = {0.2: "holds", 0.4: "no tipping", 0.8: "edge contact", 1.2: "the slider tips"}
    for factor, text in texts.items():
        other = data.copy()
        other["interface_eccentricity"] = data["interface_eccentricity"] * (factor / share)
        finding = found(other)["full_contact"]
        assert_allclose(finding.number, factor, rtol=1e-9)
        assert text in finding.sentence
        assert finding.bearings == ("bearing",)
        assert needed_level(audit(other)) == "contact"
        assert ("bearings: force up to 7 %" in finding.sentence) == (0.33 < factor < 0.75)
        assert finding.is_missing == (factor > 0.75)
        other["rim_force"] = 0.0 * other["rim_force"]
        assert needed_level(audit(other)) == "pendulum"  # nothing that counts is off


def test_unequal_rims_and_uplift_are_classes_of_their_own():
    data = run(device(capacity=0.08))
    one = data.copy()
    one["rim_displacement"] = data["rim_displacement"] * [1.0, 0.9]
    doubts = level_doubts(one)
    assert doubts.marked
    assert doubts.errors[:, list(DOUBTED).index("slip")].tolist() == [2.2]
    assert "interface slip up to 220 %" in found(one)["full_contact"].sentence
    assert level_doubts(one.assign_attrs(level="contact")).bearings == ()
    assert level_doubts(one.assign_attrs(level="{'bearing': 'contact'}")).bearings == ()
    assert level_doubts(run(device())).bearings == ()


@pytest.mark.parametrize(("low", "high", "asks"), [(0.05, 0.05, False), (0.02, 0.1, True)])
def test_unlike_friction_is_doubtful_at_short_travels(low, high, asks):
    device_ = device(friction=(low, high), slider_radius=0.06)
    data = run(device_)
    ours, rocks = (
        float(np.abs(each["bearing_displacement"].sel(axis="x")).max())
        for each in (data, run(device_, level="contact"))
    )
    doubts = level_doubts(data)
    assert (doubts.bearings == ("bearing",)) == asks
    assert needed_level(audit(data)) == ("contact" if asks else "pendulum")
    if asks:
        error = float(doubts.errors[0, list(DOUBTED).index("displacement")])
        assert 0.3 * error < rocks / ours - 1.0 < 2.5 * error
    else:
        assert_allclose(rocks, ours, rtol=0.01)


def test_travels_of_unlike_friction():
    friction, length = np.array([[0.05, 0.05], [0.02, 0.1], [0.1, 0.02]]), np.full(3, 2.0)
    found_ = travels(np.array([[0.1, 0.08, 0.32], [0.1, 0.001, 0.0]]), friction, length)
    assert_allclose(found_, [[math.inf, 0.5, 2.0], [math.inf] * 3])


def test_audit_survives_a_file(tmp_path):
    data = run(device(), features=Features(rims=False, vertical_coupling=False))
    save(data, tmp_path / "run.nc")
    again = load(tmp_path / "run.nc")
    assert again.attrs["audit"] == data.attrs["audit"] == audit_report(again)
    assert audit(again) == audit(data)
    assert findings_of(again) == findings_of(data) == audit(data)
    del again.attrs["findings"]  # as files were before
    assert findings_of(again).lines() == data.attrs["audit"].splitlines()
    lines = data.attrs["audit"].splitlines()
    assert len(lines) == len(Features.names()) + 4
    assert sum("left out" in line for line in lines) == 3


def test_auto_settles_at_once_where_nothing_is_missing():
    data = run(device(), level="auto")
    assert data.attrs["level"] == "pendulum"
    assert data.attrs["features_left_out"] == "velocity_dependence, second_direction"
    assert data.attrs["auto_runs"].count("\n") == 0
    assert data.attrs["auto_runs"].endswith(": sufficient")
    plain = run(device())
    gap = data["bearing_displacement"] - plain["bearing_displacement"]
    assert float(np.abs(gap).max()) < 1e-9


def settled(bearing: LIRBearing, features: Features) -> xr.Dataset:
    return escalate_level(lambda kept, level: run(bearing, features=kept, level=level), features)


def test_cheap_run_is_repeated_where_the_rims_are_met():
    features = Features(rims=False, interface=False, second_direction=False)
    data = settled(device(capacity=0.08), features)
    assert data.attrs["features_left_out"] == "second_direction"
    lines = data.attrs["auto_runs"].splitlines()
    assert len(lines) == 3
    assert "again, for rims left out: reached " in lines[0]
    assert "again with all bearings at the level 'contact': full contact: e/a" in lines[1]
    assert lines[2].endswith("sufficient")
    kept = Features(second_direction=False)
    plain = run(device(capacity=0.08), features=kept, level="contact")
    xr.testing.assert_equal(data["bearing_displacement"], plain["bearing_displacement"])
    assert settled(device(), features).attrs["auto_runs"].count("\n") == 0  # not met: one run


def test_auto_takes_contact_for_bearings_that_ask():
    """By name, more of them run by run; "contact" where it is all."""
    rows = run(device(capacity=0.08)), run(device())
    known = rows[0].assign_coords(bearing=["a"])
    calm = rows[1].assign_coords(bearing=["b"])
    how = dict.fromkeys(("data_vars", "coords"), "minimal")
    how |= dict.fromkeys(("compat", "combine_attrs"), "override")
    both = xr.concat([known, calm], "bearing", **how)
    levels = []

    def analyse(features: Features, level: object) -> xr.Dataset:
        levels.append(level)
        data = both.assign_attrs(level=str(level))
        return data.assign_attrs(audit(data).attrs())

    again = escalate_level(analyse, Features())
    assert levels == ["pendulum", {"a": "contact"}]
    lines = again.attrs["auto_runs"].splitlines()
    assert "again with a at the level 'contact'" in lines[0]
    assert lines[1].startswith("run 2: 1 of 2 bearings at contact")


def test_auto_names_runs_that_end_otherwise():
    """One completes, the other fails: the assumption check says so, and with it every summary."""
    ends = {
        "alike": [(RunStatus.OK, 3.0), (RunStatus.INACCURATE, 3.0)],
        "last fails": [(RunStatus.OK, 3.0), (RunStatus.SLIP_EXCEEDED, 1.25)],
        "first fails": [(RunStatus.STEP_TOO_SMALL, 1.0), (RunStatus.OK, 3.0)],
    }
    lines = {}
    for name, each in ends.items():
        data = run(device())
        data.attrs["auto_runs"] = "run 1: pendulum"
        mark_other_end(data, each)
        lines[name] = [line for line in doubts_of(data) if line.startswith("ends:")]
        assert data.attrs["auto_runs"].count("\n") == len(lines[name])
    assert lines["alike"] == []
    said = "run 1 completed at t = 3 s, run 2 stopped (slip_exceeded) at t = 1.25 s"
    assert said in lines["last fails"][0]
    assert "run 1 stopped (step_too_small) at t = 1 s, run 2 completed" in lines["first fails"][0]


def test_a_slip_near_the_one_that_holds_is_marked():
    """L mu_h - (mu1 R1 + mu2 R2) is 14 mm with 0.06, 133 mm with 0.12."""
    for mu_h, marked in ((0.06, True), (0.12, False)):
        bearing = device(capacity=0.08, interface_friction=mu_h)
        assert_allclose(bearing.slip_stability, 1.9 * mu_h - 0.1, rtol=1e-12)
        data = run(bearing)
        finding = found(data)["slip_stability"]
        slip = float(data["interface_slip_size"].max())
        assert slip > 1e-3
        assert_allclose(finding.number, slip / bearing.slip_stability, rtol=1e-9)
        assert finding.mattered is (slip > 0.8 * bearing.slip_stability) is marked
        assert ("! slip stability: bearing" in data.attrs["audit"]) is marked
    whole = found(run(device().as_dcfp()))["slip_stability"]
    assert (whole.number, whole.mattered) == (0.0, False)


def test_a_slip_near_the_end_of_the_overlap_is_marked():
    """The slip is the same, the overlap longer."""
    slip = 1e3 * float(run(device(capacity=0.08))["interface_slip_size"].max())
    for factor, marked in ((1.05, True), (1.2, False)):
        data = run(device(capacity=0.08, slip_capacity=1e-3 * factor * slip))
        assert data.attrs["status"] == "ok"
        finding = found(data)["slip_stability"]
        assert finding.doubtful is finding.mattered is marked
        words = f"bearing slipped {slip:.4g} of {factor * slip:.4g} mm, the overlap"
        assert (words in finding.sentence) is marked
    old = run(device(capacity=0.08, slip_capacity=1.05e-3 * slip)).drop_vars("slip_capacity")
    assert not found(old)["slip_stability"].doubtful  # a file of a version that did not keep it


LATE = VelocityFriction(f_max=0.065, f_min=0.0325, rate=15.0)
SLIPS = paper_bearing(friction=LATE, interface_friction=0.2)


def near_fault(until: float) -> GroundMotion:
    """Return a velocity pulse of 1 m/s and 1.8 s (Mavroeidis and Papageorgiou 2003), 1.5 cycles."""
    t, period, cycles = np.arange(0.0, until, DT), 0.6 * SLIPS.period, 1.5
    turns = 2.0 * np.pi * (t / period - 0.5 * cycles)
    speed = 0.5 * (1.0 + np.cos(turns / cycles)) * np.cos(turns)
    return GroundMotion(x=np.gradient(np.where(t < cycles * period, speed, 0.0), DT), dt=DT)


@pytest.mark.parametrize(
    ("level", "factor"), [("pendulum", 0.1), ("pendulum", 1.0), ("contact", 1.0), ("rigid_body", 1)]
)
def test_a_rim_met_with_a_slip_is_stopped_by_the_axial_stiffness(level, factor):
    """The first contact keeps its bound; the next rises by v_n sqrt(k m), which is told."""
    mass, stiffness = 204e3, factor * SLIPS.resolved()["axial_stiffness"]
    bearing = replace(SLIPS, axial_stiffness=stiffness) if factor != 1.0 else SLIPS
    data = time_history(lumped_mass(bearing, mass), near_fault(2.4), level=level)
    time, weight = data["time"].to_numpy(), float(data["weight"])
    force = np.abs(data["base_shear"].sel(axis="x").to_numpy()) / weight
    load = data["axial_force"].to_numpy()[:, 0] / weight
    closing = largest(data, "closing")
    at, speed = float(closing.at[0]), float(closing.values[0])
    k = int(np.searchsorted(time, at)) - 1
    slip = float(data["interface_slip_size"][k, 0])
    moves = abs(float(data["bearing_velocity"].sel(axis="x")[k, 0]))
    assert speed == pytest.approx(
        slip * moves / math.hypot(bearing.effective_radius, slip), rel=0.03
    )
    bound = bearing.force_limit(1.0)
    assert force[time < at - 0.1].max() < 1.08 * bound  # with m v^2 / L at most
    damping = bearing.resolved()["axial_damping"] / (2.0 * math.sqrt(stiffness * mass))
    rise = speed * math.sqrt(stiffness * mass) / weight
    expected = 1.0 + rise * math.exp(-0.5 * math.pi * damping)
    assert 0.9 * expected < load[time > at - 0.1].max() < expected  # rims that give way take a part
    assert 0.9 * bound * load.max() < force.max() < bound * load.max()
    told = found(data)["impacts"]
    assert told.number == pytest.approx(rise, rel=1e-9)
    assert told.doubtful == ("is a default estimate" in told.sentence) == (factor == 1.0)


def test_no_word_of_impacts_without_a_second_contact():
    data = time_history(lumped_mass(SLIPS, 204e3), near_fault(2.0))
    assert found(data)["interface"].mattered
    assert "impacts" not in found(data)


def test_the_yield_displacement_counts_where_friction_holds_nearly_all():
    """Displacements below half of L Q/W go by it; so does what is left at the end; else no word."""
    for scale, words in ((0.3, "moved"), (1.0, "has a residual displacement")):
        motion = near_fault(6.0)
        data = time_history(lumped_mass(SLIPS, 204e3), GroundMotion(x=scale * motion.x, dt=DT))
        assert words in found(data)["yield_displacement"].sentence
    assert "yield_displacement" not in found(run(device(friction=CoulombFriction(0.01))))


def test_checks_of_forces_say_that_they_rest_on_a_default():
    """Axial and lateral force, if a rim was met with a slip; not if the stiffness is given."""
    limits = DesignLimits(axial_force=1e9, lateral_force=1e9, interface_pressure=1e9)
    given = replace(SLIPS, axial_stiffness=SLIPS.resolved()["axial_stiffness"])
    for bearing, until, says in ((SLIPS, 2.4, True), (SLIPS, 2.0, False), (given, 2.4, False)):
        frame = lumped_mass(bearing, 204e3)
        checks = impact_checks(time_history(frame, near_fault(until)), frame, limits=limits)
        noted = {check.title for check in checks if ON_AXIAL_STIFFNESS in check.note}
        titles = {"maximum axial force", "lateral force of a bearing"}
        assert noted == ({*titles, "pressure on the sliders' overlap"} if says else set())
