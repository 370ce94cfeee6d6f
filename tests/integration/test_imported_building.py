"""The building of docs/imported_building.md against OpenSeesPy, built from its dimensions alone."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from docs.imported_building import HEIGHT, PRESSURES, SIZES, STOREYS, WALLS, X, Y, model
from frames import Frame
from frames.demo import bearing_for
from lir_element.opensees import opensees
from tests.fixed_base import periods, reactions

G, E, NU, UNIT = 9.80665, 30e9, 0.2, 25e3  # m/s2, Pa, -, N/m3
SLAB, WALL = 0.18, 0.25
GRID = [(i, j) for j in range(len(Y)) for i in range(len(X))]
LEVELS = range(STOREYS + 1)


def tag(place: tuple[int, int], level: int) -> int:
    return 1 + GRID.index(place) + 100 * level


def torsion(depth: float, width: float) -> float:
    """Return the torsion constant of a rectangle by Saint-Venant's series."""
    a, b = max(depth, width), min(depth, width)
    odd = np.arange(1, 40, 2)
    series = np.sum(np.tanh(0.5 * odd * np.pi * a / b) / odd**5)
    return a * b**3 / 3.0 * (1.0 - 192.0 * b / (np.pi**5 * a) * float(series))


def sides() -> Iterator[tuple[tuple[int, int], tuple[int, int]]]:
    for i, j in GRID:
        for other in ((i + 1, j), (i, j + 1)):
            if other in GRID:
                yield (i, j), other


class Peer:
    """The building on pinned supports, a wall of one shell a storey."""

    def __init__(self, ops: Any, live: float) -> None:
        self.ops, self.live = ops, live
        self.load: dict[int, np.ndarray] = {}
        self.mass: dict[int, float] = {}
        self.count = 0
        ops.wipe()
        ops.model("basic", "-ndm", 3, "-ndf", 6)
        for level in LEVELS:
            for i, j in GRID:
                ops.node(tag((i, j), level), X[i], Y[j], HEIGHT * level)
        for place in GRID:
            ops.fix(tag(place, 0), 1, 1, 1, 0, 0, 0)
        ops.geomTransf("Linear", 1, 0, 0, 1)
        ops.geomTransf("Linear", 2, 0, 1, 0)
        ops.section("ElasticMembranePlateSection", 1, E, NU, WALL, 0.0)
        for level in LEVELS:
            self.floor(level)
        for level in LEVELS[1:]:
            self.storey(level)
            ops.rigidDiaphragm(3, *(tag(place, level) for place in GRID))
        for node, mass in self.mass.items():
            ops.mass(node, mass, mass, mass, 0, 0, 0)
        ops.timeSeries("Linear", 1)
        ops.pattern("Plain", 1, 1)
        for node, force in self.load.items():
            ops.load(node, *map(float, force))

    def member(self, one: int, two: int, section: str, transf: int) -> None:
        depth, width = SIZES[section]
        area, shear = depth * width, 5.0 / 6.0 * depth * width
        self.count += 1
        inertia = width * depth**3 / 12.0, depth * width**3 / 12.0
        constants = (area, torsion(depth, width), *inertia, shear, shear)
        self.ops.element(
            "ElasticTimoshenkoBeam", self.count, one, two, E, E / (2 + 2 * NU), *constants, transf
        )
        ends = [np.array(self.ops.nodeCoord(n)) for n in (one, two)]
        way = ends[1] - ends[0]
        length = float(np.linalg.norm(way))
        weight = UNIT * area
        self.put((one, two), way, 0.5 * weight * length, weight * length**2 / 12.0)
        for node in (one, two):
            self.mass[node] = self.mass.get(node, 0.0) + 0.5 * weight * length / G

    def put(self, ends: tuple[int, int], way: np.ndarray, force: float, moment: float) -> None:
        # Down at both ends, and the fixed-end moments of a load that is symmetric along the beam.
        turn = np.cross(way / np.linalg.norm(way), [0.0, 0.0, -1.0])
        for node, sign in zip(ends, (1.0, -1.0), strict=True):
            here = self.load.setdefault(node, np.zeros(6))
            here[2] -= force
            here[3:] += sign * moment * turn

    def floor(self, level: int) -> None:
        for here, there in sides():
            ends = tag(here, level), tag(there, level)
            self.member(*ends, "B90" if level == 0 else "B60", 1)
            way = np.subtract(self.ops.nodeCoord(ends[1]), self.ops.nodeCoord(ends[0]))
            # square panels on one side or both: triangles of w at midspan, 5 w L^2 / 96
            along_x = here[1] == there[1]
            at, last = (here[1], len(Y) - 1) if along_x else (here[0], len(X) - 1)
            panels = 1 if at in {0, last} else 2
            length = float(np.linalg.norm(way))
            for pressure, own in (
                (UNIT * SLAB + 1e3 * PRESSURES["SDL"], True),
                (self.live * 1e3 * PRESSURES["Live"], False),
            ):
                peak = panels * pressure * 0.5 * length
                self.put(ends, way, peak * length / 4.0, 5.0 * peak * length**2 / 96.0)
                for node in ends if own else ():
                    self.mass[node] = self.mass.get(node, 0.0) + peak * length / 4.0 / G

    def storey(self, level: int) -> None:
        for place in GRID:
            self.member(tag(place, level - 1), tag(place, level), "C50", 2)
        for here, there in WALLS:
            corners = [tag(here, level - 1), tag(there, level - 1), tag(there, level)]
            corners.append(tag(here, level))
            self.count += 1
            self.ops.element("ShellMITC4", self.count, *corners, 1)
            ends = [np.array(self.ops.nodeCoord(n)) for n in corners[:2]]
            quarter = 0.25 * UNIT * WALL * HEIGHT * math.dist(*ends)
            for node in corners:
                self.load.setdefault(node, np.zeros(6))[2] -= quarter
                self.mass[node] = self.mass.get(node, 0.0) + quarter / G

    def reactions(self) -> np.ndarray:
        ops = self.ops
        ops.constraints("Transformation")
        ops.numberer("RCM")
        ops.system("BandGeneral")
        ops.algorithm("Linear")
        ops.integrator("LoadControl", 1.0)
        ops.analysis("Static")
        assert ops.analyze(1) == 0
        ops.reactions()
        return np.array([ops.nodeReaction(tag(place, 0)) for place in GRID])

    def periods(self, count: int) -> np.ndarray:
        self.ops.wipeAnalysis()
        self.ops.constraints("Transformation")
        self.ops.numberer("RCM")
        self.ops.system("BandGeneral")
        found = np.array(self.ops.eigen("-fullGenLapack", count))
        return 2.0 * np.pi / np.sqrt(found)


@pytest.fixture(scope="module")
def frame(tmp_path_factory: pytest.TempPathFactory) -> Frame:
    path = tmp_path_factory.mktemp("building") / "model.e2k"
    path.write_text(model(), encoding="utf-8")
    opensees().wipe()
    return Frame.from_etabs(path, mesh=6.0, loads={"Dead": 1.0, "SDL": 1.0, "Live": 0.5})


def test_reactions_and_periods_are_those_of_opensees(frame: Frame) -> None:
    found, here = reactions(frame), periods(frame, 6)
    peer = Peer(opensees(), live=0.5)
    expected, there = peer.reactions(), peer.periods(6)
    opensees().wipe()
    read = np.array([found[f"{k + 1}-Base"] for k in range(len(GRID))])
    assert_allclose(read[:, :3], expected[:, :3], rtol=1e-3, atol=1e-4 * expected.max())
    assert_allclose(here, there, rtol=1e-3)


def test_the_weight_is_that_of_the_volumes(frame: Frame) -> None:
    plan, beams = 18.0 * 12.0, 3 * 18.0 + 4 * 12.0
    floors = 6 * plan * (UNIT * SLAB + 2e3 + 0.5 * 3e3)
    own = UNIT * (beams * (0.9 * 0.4 + 5 * 0.6 * 0.3) + 12 * 16.5 * 0.25 + 4 * 6.0 * 16.5 * WALL)
    vertical = sum(force[2] for name, force in reactions(frame).items() if "Base" in name)
    assert_allclose(vertical, floors + own, rtol=1e-9)


def test_the_page_has_the_numbers_of_the_building(tmp_path: Path) -> None:
    page = (Path(__file__).parents[2] / "docs" / "imported_building.md").read_text(encoding="utf-8")
    path = tmp_path / "model.e2k"
    path.write_text(model(), encoding="utf-8")
    opensees().wipe()
    fine = Frame.from_etabs(path, bearing_for(1.4e6), loads="all", mesh=1.5)
    assert f"| {fine.check().mass / 1e3:.0f} t," in page
    assert "in 240 elements" in str(fine.imported)
    assert "left out" not in str(fine.imported)
