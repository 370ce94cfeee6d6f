"""Models read from SAP2000's tables against OpenSeesPy built from the same tables: within 0.1 %."""

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from frames import Frame
from lir_element.opensees import opensees
from tests import sap2000_models as models
from tests.fixed_base import periods, reactions
from tests.sap2000_peer import Peer

CASES = {
    "concrete, kN and m": models.building(),
    "details, kip and inch": models.building("Kip, in, F", details=True, slabs=False),
    "details, N and mm": models.building("N, mm, C", details=True, bays=(2, 2), slabs=False),
    "walls": models.building(storeys=3, walls=True, width=(3.0, 4.0)),
}


def read(tmp_path: Path, tables: models.Rows, **options: object) -> Frame:
    path = tmp_path / "model.s2k"
    path.write_text(models.text(tables), encoding="utf-8")
    opensees().wipe()
    return Frame.from_sap2000(path, **options)  # type: ignore[arg-type]


@pytest.mark.parametrize("name", CASES)
def test_periods_and_reactions_are_those_of_opensees(tmp_path: Path, name: str) -> None:
    tables = CASES[name]
    frame = read(tmp_path, tables, loads={"DEAD": 1.0, "LIVE": 0.7}, mesh=100.0)
    found, periods_here = reactions(frame), periods(frame, 6)
    peer = Peer(opensees(), models.text(tables), {"DEAD": 1.0, "LIVE": 0.7}, share=0.3)
    expected, periods_there = peer.reactions(), peer.periods(6)
    opensees().wipe()
    largest = max(np.abs(force).max() for force in expected.values())
    for joint, force in expected.items():
        assert_allclose(found[joint], force, rtol=1e-3, atol=1e-4 * largest)
    assert_allclose(periods_here, periods_there, rtol=1e-3)
