"""Random buildings with setbacks and plans like an L, on bearings: turned, mirrored, reordered."""

import math
from dataclasses import dataclass

import numpy as np

from frames import Frame, ModalDamping, Section
from frames.demo import bearing_for

RISE = 3.5  # m


@dataclass(frozen=True)
class Building:
    """How a building is drawn: the numbers give its shape, all else its place and scale."""

    seed: int
    storeys: int = 4
    turn: float = 0.0  # rad, of the plan
    mirror: bool = False
    shift: tuple[float, float] = (0.0, 0.0)  # m
    reordered: bool = False

    def place(self, x: float, y: float) -> tuple[float, float]:
        """Return where a place of the plan comes to stand [m]."""
        x = -x if self.mirror else x
        c, s = math.cos(self.turn), math.sin(self.turn)
        return c * x - s * y + self.shift[0], s * x + c * y + self.shift[1]

    def frame(self) -> Frame:
        """Return the model: columns that end at random floors, floors rigid or not."""
        rng = np.random.default_rng(self.seed)
        counts = rng.integers(2, 4, 2)
        grid = [np.concatenate([[0.0], np.cumsum(rng.uniform(4.0, 7.0, n - 1))]) for n in counts]
        plan = [(i, j) for i in range(counts[0]) for j in range(counts[1])]
        tops = dict(zip(plan, rng.integers(1, self.storeys + 1, len(plan)).tolist(), strict=True))
        tops[plan[0]] = tops[plan[1]] = self.storeys
        rigid = bool(rng.integers(2))
        side, masses = (
            rng.uniform(0.35, 0.5),
            dict(zip(plan, rng.uniform(2e4, 4e4, len(plan)), strict=True)),
        )
        concrete = Section.rectangle(side, side, elastic_modulus=30e9, density=2500.0)
        frame, device = Frame(f"irregular {self.seed}"), bearing_for(2e6)
        order = list(plan)
        if self.reordered:
            np.random.default_rng(self.seed + 1).shuffle(order)
        for i, j in order:
            x, y = self.place(grid[0][i], grid[1][j])
            frame.add_node(f"ground-{i}-{j}", x, y, 0.0)
            frame.fix(f"ground-{i}-{j}", "all")
            for k in range(tops[i, j] + 1):
                frame.add_node(f"{k}-{i}-{j}", x, y, device.height + k * RISE)
                frame.add_mass(f"{k}-{i}-{j}", masses[i, j])
                if k:
                    frame.add_member(
                        f"column-{k}-{i}-{j}", f"{k - 1}-{i}-{j}", f"{k}-{i}-{j}", concrete
                    )
            frame.add_bearing(f"bearing-{i}-{j}", f"ground-{i}-{j}", f"0-{i}-{j}", device)
        for k in range(self.storeys + 1):
            here = [place for place in order if tops[place] >= k]
            nodes = [f"{k}-{i}-{j}" for i, j in here]
            for i, j in here:
                for other in ((i + 1, j), (i, j + 1)):
                    if other in here:
                        to = f"{k}-{other[0]}-{other[1]}"
                        frame.add_member(f"beam {k}-{i}-{j} {to}", f"{k}-{i}-{j}", to, concrete)
            if (k == 0 or rigid) and len(nodes) > 1:
                frame.add_diaphragm(f"floor-{k}", nodes)
            frame.add_level(f"level-{k}", nodes)
        frame.set_damping(ModalDamping(0.03))
        return frame
