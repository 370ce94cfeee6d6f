"""Tables in the columns of SAP2000 and ETABS: signs of axes 1, 2, 3, units, sums."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from numpy.testing import assert_allclose

from frames import (
    Frame,
    GroundMotion,
    ModelError,
    gravity,
    moment_frame,
    storey_drift,
    time_history,
)
from frames.demo import bearing_for
from frames.recording.program_tables import program_tables


@pytest.fixture(scope="module")
def frame() -> Frame:
    """Return a frame whose beams carry a load."""
    found = moment_frame((1, 1), 1, bearing=bearing_for(400e3), floor_load=800.0)
    for name in found.members:
        if name.startswith("beam"):
            found.add_uniform_load(name, (0.0, 0.0, -9e3))
    return found


@pytest.fixture(scope="module")
def data(frame: Frame) -> xr.Dataset:
    pulse = 1.5 * np.sin(np.linspace(0.0, 6.28, 41))
    return time_history(frame, GroundMotion(x=pulse, y=0.5 * pulse, dt=0.02))


def of(table: pd.DataFrame, **chosen: object) -> pd.DataFrame:
    for word, value in chosen.items():
        table = table[table[word] == value]
    return table


def test_signs_of_a_beam_that_carries(frame: Frame) -> None:
    still = time_history(frame, GroundMotion(x=np.zeros(6), dt=0.01))
    forces = program_tables(frame, still, units="N, m")["Element Forces - Frames"]
    beam = next(name for name in frame.members if name.startswith("beam"))
    first, last = (of(forces, Frame=beam, StepType="Max").iloc[k] for k in (0, -1))
    assert first["Station"] == 0.0
    assert last["Station"] > 1.0
    # gravity: V2 rises from below zero at i to above zero at j, both ends hog: the top is pulled
    assert first["V2"] < -1e3 < 1e3 < last["V2"]
    assert first["M3"] < 0.0 > last["M3"]
    # equilibrium by hand: q L, and M_i + V L = M_j of the section forces
    length, q = last["Station"], last["V2"] - first["V2"]
    assert_allclose(last["M3"] - first["M3"], -0.5 * (first["V2"] + last["V2"]) * length, atol=1.0)
    assert q > 9e3 * length - 1.0
    columns = of(forces, StepType="Max")
    columns = columns[columns["Frame"].str.startswith("column")]
    assert (columns["P"] < 0.0).all()


def test_base_reactions_are_the_weight_about_the_origin(frame: Frame) -> None:
    still = time_history(frame, GroundMotion(x=np.zeros(6), dt=0.01))
    tables = program_tables(frame, still, units="KN, m")
    base = of(tables["Base Reactions"], StepType="Max").iloc[0]
    state = gravity(frame)
    assert_allclose(base["GlobalFZ"], 1e-3 * state.axial_forces.sum(), rtol=1e-6)
    joints = of(tables["Joint Reactions"], StepType="Max").set_index("Joint")
    y = np.array([frame.nodes[name].y for name in joints.index])
    x = np.array([frame.nodes[name].x for name in joints.index])
    assert_allclose(base["GlobalMX"], joints["F3"].to_numpy() @ y, rtol=1e-3)
    assert_allclose(base["GlobalMY"], -joints["F3"].to_numpy() @ x, rtol=1e-3)


def test_extremes_and_units(frame: Frame, data: xr.Dataset) -> None:
    tables = program_tables(frame, {"one": data, "two": data}, units="Kip, in")
    moves = tables["Joint Displacements"]
    assert set(moves["OutputCase"]) == {"one", "two"}
    node = str(data["node"].to_numpy()[-1])
    own = data["node_displacement"].sel(node=node, dof="ux").to_numpy()
    rows = of(moves, Joint=node, OutputCase="two").set_index("StepType")
    assert_allclose(rows["U1"], [own.max() / 0.0254, own.min() / 0.0254])
    drift = storey_drift(data)
    rows = of(tables["Story Drifts"], OutputCase="one", Direction="Y", StepType="Max")
    assert_allclose(rows["Drift"], drift.sel(axis="y").max("time").to_numpy())
    kn = frame.program_tables(data, units="KN, m")["Element Forces - Frames"]
    kip = of(tables["Element Forces - Frames"], OutputCase="one")
    assert_allclose(kip["P"] * 4.4482216152605, kn["P"])
    assert_allclose(kip["M3"] * 4.4482216152605 * 0.0254, kn["M3"])
    assert_allclose(kip["Station"] * 0.0254, kn["Station"])
    with pytest.raises(ModelError, match=r'units = "stone" must be one of KN, m'):
        program_tables(frame, data, units="stone")


def test_stations_along_a_beam_by_statics() -> None:
    """A beam with a uniform and a partial load: shear and moment from those of end i alone."""
    frame = moment_frame((1, 1), 1, bearing=bearing_for(400e3), floor_load=800.0)
    beam = next(name for name in frame.members if name.startswith("beam"))
    frame.add_uniform_load(beam, (0.0, 0.0, -9e3))
    frame.add_tapered_load(beam, (0.0, 0.0, -4e3), (0.0, 0.0, -12e3), a=1.0, b=2.5)
    still = time_history(frame, GroundMotion(x=np.zeros(6), dt=0.01))
    table = frame.program_tables(still, units="N, m", stations=7)["Element Forces - Frames"]
    rows = of(table, Frame=beam, StepType="Max")
    assert len(rows) == 7
    x = rows["Station"].to_numpy()
    assert_allclose(np.diff(x), (x[-1] - x[0]) / 6.0)
    fine = np.linspace(0.0, 1.0, 20001)
    for station, row in zip(x, rows.to_dict("records"), strict=True):
        s = fine * station
        q = np.full_like(s, 9e3)  # members weigh at their nodes
        inside = (s >= 1.0) & (s <= 2.5)
        q[inside] += 4e3 + 8e3 * (s[inside] - 1.0) / 1.5
        shear = rows["V2"].iloc[0] + np.trapezoid(q, s)
        moment = rows["M3"].iloc[0] - rows["V2"].iloc[0] * station
        moment -= np.trapezoid(q * (station - s), s)
        assert_allclose(row["V2"], shear, atol=5.0)
        assert_allclose(row["M3"], moment, atol=10.0)
    with pytest.raises(ModelError, match="stations"):
        frame.program_tables(still, stations=1)
