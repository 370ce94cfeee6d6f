"""The method "reduced": few vectors in place of all modes, and what it says about its error."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy import sparse

from frames import (
    AuditWarning,
    Frame,
    ModelError,
    ModelWarning,
    RayleighDamping,
    Section,
    audit,
    gravity,
    load,
    member_forces,
    moment_frame,
    save,
    shear_building,
    time_histories,
    time_history,
)
from frames.assembly import ritz
from frames.assembly.basis import build_basis
from frames.assembly.ritz import RitzSpace
from frames.assembly.solvers import Factors
from frames.laws import Bilinear
from frames.recording.reduction import present_quantities
from frames.results.peak_response import largest
from frames.statics import basis_refinement
from frames.statics.basis_refinement import differences
from frames.statics.gravity import prepare
from tests.scenes import heavy_bearing, swell

# Tall and soft on purpose: many modes on few bearings.
pytestmark = [pytest.mark.meant("the fixed-base period is")]

DT = 0.005
MOTION = swell(x=(1.5, 1.6), y=(0.9, 0.9), z=(0.4, 0.4), middle=2.0, width=1.2, end=5.0)


def bearing(capacity=0.25, load=1.5e6):
    return heavy_bearing(capacity=capacity, design_load=load)


def uneven():
    """Return a frame on a flexible base, some of its bearings under three times the load."""
    thin = Section.rectangle(0.3, 0.3)
    frame = moment_frame((2, 1), 16, bearing=bearing(), base_beam=thin)
    for level in range(1, 17):
        frame.add_mass(f"floor-{level}-0-0", 4e4)
    return frame


def yielding():
    def law(stiffness):
        return Bilinear(stiffness=stiffness, yield_force=8e4, hardening=0.03)

    return shear_building(
        bearing(load=1.24e7),
        4e4,
        6e7,
        storeys=30,
        base_mass=6e4,
        storey_law=law,
        damping=RayleighDamping(0.02, (2.0, 0.2)),
    )


BUILDINGS = {
    "symmetric": lambda: moment_frame((2, 2), 16, bearing=bearing()),
    "eccentric": lambda: moment_frame((2, 2), 16, bearing=bearing(), eccentricity=(0.1, 0.05)),
    "flexible base, uneven loads": uneven,
    "yielding storeys": yielding,
}


def reached(data):
    return {name: largest(data, name) for name in present_quantities(data)}


@pytest.fixture(scope="module", params=BUILDINGS)
def both(request):
    """Return a building and its histories, direct and reduced."""
    frame = BUILDINGS[request.param]()
    runs = [time_history(frame, MOTION, dt=DT, method=m) for m in ("direct", "reduced")]
    return frame, *runs


def test_reduced_is_as_direct_within_what_is_asked_for(both):
    frame, direct, reduced = both
    # what a yielding storey excites asks for all modes in the end
    few = frame.name == "shear building" or reduced.attrs["modes"] < 0.81 * direct.attrs["modes"]
    assert few
    assert reduced.attrs["status"] == direct.attrs["status"]
    off = differences(reached(direct), reached(reduced))
    assert off["bearing_displacement"] < 1e-3
    assert off["base_shear"] < 1e-3
    for part in ("axial_force", "floor_acceleration", "storey_drift", "yielding"):
        assert off[part] < 1e-2, part
    assert off["vertical_acceleration"] < 1e-1
    names = list(frame.members)[:: max(len(frame.members) // 12, 1)]
    if names:  # each component over its largest in the member that was looked at, (..., 6)
        exact, other = (
            np.abs(member_forces(frame, data, names).to_numpy()).max(axis=(0, 1, 2))
            for data in (direct, reduced)
        )
        assert_allclose(other, exact, rtol=1e-2, atol=1e-4 * exact[3:].max())  # torsion is little


def test_the_error_it_reports_is_larger_than_its_error(both):
    _, direct, reduced = both
    off = differences(reached(direct), reached(reduced))
    for part, error in off.items():
        more = 1.5 if part == "vertical_acceleration" else 1.05  # as its docstring says
        assert error <= more * reduced.attrs[f"reduction_error_{part}"] + 1e-5, part
    assert reduced.attrs["reduction_runs"] >= 2
    assert "reduced:" not in reduced.attrs["audit"]


def test_gravity_is_that_of_all_modes(both):
    frame, _, _ = both
    prepared = prepare(frame, None, "pendulum")
    space = RitzSpace(prepared.system, prepared.geometric, frame.damping)
    space.grow()
    basis = space.basis()
    state = gravity(frame)
    assert len(basis.omega2) < len(state.basis.omega2)
    b = state.run.b
    e = basis.load_e / basis.omega2
    displacement = basis.expand_b @ b + basis.expand_e @ e + basis.offset
    assert_allclose(displacement, state.displacement, atol=1e-9 * np.abs(state.displacement).max())


def test_a_structure_too_large_for_all_its_modes_says_so(monkeypatch):
    """Many vectors stand for them: the equilibrium is the same, peaks of bearings nearly."""
    frame = uneven()
    exact, whole = gravity(frame), time_history(frame, MOTION, 2.0, DT)
    monkeypatch.setattr(ritz, "LARGE", 100)
    monkeypatch.setattr(ritz, "VECTORS", 60)
    with pytest.warns(ModelWarning, match=r"vectors replace all modes of \d+ displacements"):
        state = gravity(frame)
    assert len(state.basis.omega2) < len(exact.basis.omega2)
    assert_allclose(state.displacement, exact.displacement, atol=1e-9)
    assert_allclose(state.held_periods[:6], exact.held_periods[:6], rtol=1e-6)
    with pytest.warns(ModelWarning):
        data = time_history(frame, MOTION, 2.0, DT)
    few, all_ = (np.abs(each["bearing_force"]).max("time") for each in (data, whole))
    assert_allclose(few, all_, atol=1e-3 * all_.max())


def test_what_is_left_out_follows_nonlinear_parts_statically():
    frame = yielding()
    prepared = prepare(frame, None, "pendulum")
    system = prepared.system
    space = RitzSpace(system, prepared.geometric, frame.damping)
    space.grow()
    few, all_ = space.basis(), build_basis(system, prepared.geometric, frame.damping)
    rows = system.part_rows

    def flexibility(basis):
        to_e = rows @ basis.expand_e
        return (to_e / basis.omega2) @ to_e.T + rows @ basis.shift(rows.T.toarray())

    assert len(few.omega2) < len(all_.omega2)
    assert np.abs(rows @ few.shift(rows.T.toarray())).max() > 0.0
    expected = flexibility(all_)
    assert_allclose(flexibility(few), expected, atol=1e-9 * np.abs(expected).max())


def test_all_vectors_are_all_modes():
    frame = moment_frame((1, 1), 3, bearing=bearing(), eccentricity=(0.1, 0.05))
    prepared = prepare(frame, None, "pendulum")
    space = RitzSpace(prepared.system, prepared.geometric, frame.damping)
    counts = [space.grow() for _ in range(8)]
    assert counts[-1] == space.most > counts[0]
    few = space.basis()
    whole = build_basis(prepared.system, prepared.geometric, frame.damping)
    assert_allclose(few.omega2, whole.omega2, rtol=1e-8)
    assert_allclose(few.mass_b, whole.mass_b, atol=1e-9 * np.abs(whole.mass_b).max())
    assert_allclose(few.stiffness_b, whole.stiffness_b, atol=1e-9 * np.abs(whole.stiffness_b).max())
    off = few.mass_be @ few.mass_be.T - whole.mass_be @ whole.mass_be.T
    assert np.abs(off).max() < 1e-9 * np.abs(whole.mass_b).max()


def test_where_most_modes_are_needed_it_is_the_direct_method():
    frame = moment_frame((1, 1), 2, bearing=bearing())
    direct, reduced = (
        time_history(frame, MOTION, 2.0, DT, method=m) for m in ("direct", "reduced")
    )
    assert reduced.attrs["modes"] == direct.attrs["modes"]
    assert reduced.attrs["reduction_error_bearing_displacement"] == 0.0
    assert reduced["bearing_displacement"].equals(direct["bearing_displacement"])


def test_an_error_that_stays_is_told(monkeypatch, tmp_path):
    monkeypatch.setattr(basis_refinement, "ROUNDS", 2)
    frame = BUILDINGS["symmetric"]()
    with pytest.warns(AuditWarning, match=r"differ by more than reduction_tolerance: .* %"):
        data = time_history(frame, MOTION, 3.0, DT, method="reduced", reduction_tolerance=1e-8)
    assert data.attrs["reduction_runs"] == 2
    assert "! reduced:" in data.attrs["audit"]
    save(data, tmp_path / "run.nc")
    assert load(tmp_path / "run.nc").attrs["reduction_error_base_shear"] > 1e-8
    assert audit(data)


def test_recordings_and_failures_are_those_of_a_run():
    frame = moment_frame((2, 2), 9, bearing=bearing(capacity=0.02))
    with pytest.warns(UserWarning, match="slip"):
        data = time_history(
            frame, MOTION.scaled((4.0, 4.0, 1.0)), dt=DT, method="reduced", record_every=20
        )
    assert data.attrs["status"] == "slip_exceeded"
    assert math.isfinite(data.attrs["reduction_error_bearing_displacement"])


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"reduction_tolerance": 1e-3}, 'needs method="reduced"'),
        ({"method": "reduced", "reduction_tolerance": 0.5}, "reduction_tolerance"),
        ({"method": "reduced", "level": "rigid_body"}, 'level="rigid_body"'),
        ({"method": "modal"}, "method"),
    ],
)
def test_options_that_do_not_go_together_are_refused(options, message):
    with pytest.raises(ValueError, match=message):
        time_history(moment_frame((1, 1), 1, bearing=bearing()), MOTION, **options)


def test_many_histories_have_all_modes():
    with pytest.raises(ValueError, match="method"):
        time_histories(moment_frame((1, 1), 1, bearing=bearing()), MOTION, method="reduced")


def test_a_structure_that_buckles_is_refused_with_the_culprit():
    weak = Section.rectangle(0.05, 0.05)
    frame = moment_frame((1, 1), 2, bearing=bearing(), column=weak)
    messages = []
    for method in ("direct", "reduced"):
        with pytest.raises(ModelError) as caught:
            time_history(frame, MOTION, method=method)
        messages.append(str(caught.value))
    assert messages[0] == messages[1]
    assert "loads" in messages[0]


def test_sparse_factors_tell_whether_a_matrix_is_positive():
    matrix = sparse.csr_array(np.array([[2.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 2.0]]))
    factors = Factors(matrix)
    right = np.array([[1.0, 0.0], [0.0, 2.0], [3.0, 0.0]])
    assert factors.is_positive
    assert_allclose(matrix @ factors.solve(right), right, atol=1e-14)
    assert not Factors(matrix - 1.0 * sparse.eye_array(3)).is_positive


def test_a_frame_without_structure_above_has_no_vectors():
    frame = Frame()
    frame.add_node("ground", 0.0, 0.0, 0.0)
    frame.add_node("top", 0.0, 0.0, 0.25)
    frame.fix("ground", "all")
    frame.fix("top", "rx", "ry", "rz")
    frame.add_mass("top", 1.5e5)
    frame.add_bearing("bearing", "ground", "top", bearing())
    direct, reduced = (
        time_history(frame, MOTION, 2.0, DT, method=m) for m in ("direct", "reduced")
    )
    assert reduced.attrs["modes"] == 0
    assert reduced["bearing_displacement"].equals(direct["bearing_displacement"])
