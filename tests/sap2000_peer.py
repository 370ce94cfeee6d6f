"""The tables of SAP2000 built in OpenSeesPy without this project's reader, to compare with it."""

from __future__ import annotations

import math
import re
from typing import Any

import numpy as np

G = 9.80665
FORCES = {"kn": 1e3, "kip": 4448.2216152605, "n": 1.0}
LENGTHS = {"m": 1.0, "in": 0.0254, "mm": 1e-3}
HELD = ("U1", "U2", "U3", "R1", "R2", "R3")


def tables_of(text: str) -> dict[str, list[dict[str, str]]]:
    found: dict[str, list[dict[str, str]]] = {}
    name = ""
    for line in re.sub(r" _\n\s*", "   ", text).splitlines():
        if line.startswith("TABLE:"):
            name = line.split('"')[1]
            found[name] = []
        elif name and "=" in line:
            pairs = re.findall(r'(\S+?)=("[^"]*"|\S*)', line)
            found[name].append({key: value.strip('"') for key, value in pairs})
    return found


class Peer:
    """A model in OpenSeesPy: elasticBeamColumn, ShellMITC4, rigidDiaphragm; loads of patterns."""

    def __init__(self, ops: Any, text: str, factors: dict[str, float], share: float) -> None:
        self.ops, self.t = ops, tables_of(text)
        words = self.t["PROGRAM CONTROL"][0]["CurrUnits"].lower().split(",")
        self.f, self.l = FORCES[words[0].strip()], LENGTHS[words[1].strip()]
        self.factors, self.share = factors, share
        self.mass: dict[int, float] = {}
        self.loads: list[tuple[int, list[float]]] = []
        self.beams: list[tuple[Any, ...]] = []
        ops.wipe()
        ops.model("basic", "-ndm", 3, "-ndf", 6)
        self.xyz = {
            int(r["Joint"]): self.l * np.array([float(r[k]) for k in ("XorR", "Y", "Z")])
            for r in self.t["JOINT COORDINATES"]
        }
        for tag, place in self.xyz.items():
            ops.node(tag, *place)
        for r in self.t["JOINT RESTRAINT ASSIGNMENTS"]:
            ops.fix(int(r["Joint"]), *[int(r[k] == "Yes") for k in HELD])
        self.frames()
        self.areas()
        self.diaphragms()
        self.apply()

    def row(self, table: str, key: str, name: str) -> dict[str, str]:
        return next((r for r in self.t.get(table, []) if r[key] == name), {})

    def add_mass(self, node: int, mass: float) -> None:
        self.mass[node] = self.mass.get(node, 0.0) + mass

    def frames(self) -> None:
        matter = self.t["MATERIAL PROPERTIES 02 - BASIC MECHANICAL PROPERTIES"][0]
        e, g = (float(matter[k]) * self.f / self.l**2 for k in ("E1", "G12"))
        weight = float(matter["UnitWeight"]) * self.f / self.l**3
        self.e, self.density = e, float(matter["UnitMass"]) * self.f / self.l**4
        self.weight = weight
        self.axes, self.ends, self.tags = {}, {}, {}
        for tag, r in enumerate(self.t["CONNECTIVITY - FRAME"], start=1):
            name, i, j = r["Frame"], int(r["JointI"]), int(r["JointJ"])
            self.tags[name] = tag
            given = self.row("FRAME SECTION ASSIGNMENTS", "Frame", name)["AnalSect"]
            s = self.row("FRAME SECTION PROPERTIES 01 - GENERAL", "SectionName", given)
            mod = self.row("FRAME PROPERTY MODIFIERS", "Frame", name)
            area = float(s["Area"]) * self.l**2 * float(mod.get("AMod", 1))
            inertia = {
                k: float(s[k]) * self.l**4 * float(s.get(a, 1)) * float(mod.get(b, 1))
                for k, a, b in (("I33", "I3Mod", "I33Mod"), ("I22", "I2Mod", "I22Mod"))
            }
            torsion = float(s["TorsConst"]) * self.l**4 * float(mod.get("JMod", 1))
            angle = float(
                self.row("FRAME LOCAL AXES ASSIGNMENTS 1 - TYPICAL", "Frame", name).get("Angle", 0)
            )
            x = self.xyz[j] - self.xyz[i]
            length = float(np.linalg.norm(x))
            one = x / length
            two = np.array([1.0, 0, 0]) if abs(one[2]) > 0.999999 else np.array([0, 0, 1.0])
            two = two - one * (one @ two)
            three = np.cross(one, two)
            c, sn = math.cos(math.radians(angle)), math.sin(math.radians(angle))
            two, three = c * two + sn * three, c * three - sn * two
            zone = self.row("FRAME OFFSET ALONG LENGTH ASSIGNMENTS", "Frame", name)
            stiff = float(zone.get("RigidFactor", 0)) * self.l
            first, last = (stiff * float(zone.get(f"Length{k}", 0)) for k in "IJ")
            point = self.row("FRAME INSERTION POINT ASSIGNMENTS", "Frame", name)
            shift = np.array([self.l * float(point.get("JtOffsetXI", 0)), 0, 0])
            if point.get("CardinalPt", "").startswith("8"):
                shift = shift - 0.5 * float(s["t3"]) * self.l * two
            # local y of OpenSees is axis 2: local z = axis 3 = vecxz direction
            offsets = [*(shift + first * one), *(shift - last * one)]
            self.ops.geomTransf("Linear", tag, *three, "-jntOffset", *offsets)
            release = self.row("FRAME RELEASE ASSIGNMENTS 1 - GENERAL", "Frame", name)
            code = [
                int(release.get(f"{m}I") == "Yes") + 2 * int(release.get(f"{m}J") == "Yes")
                for m in ("M3", "M2")
            ]
            numbers = (area, e, g, torsion, inertia["I22"], inertia["I33"])
            options = ["-releasez", code[0], "-releasey", code[1]]
            self.ops.element("elasticBeamColumn", tag, i, j, *numbers, tag, *options)
            self.axes[name], self.ends[name] = (one, two, three), (i, j, length, first, last, shift)
            plain = float(s["Area"]) * self.l**2 * float(mod.get("AMod", 1))
            for node in (i, j):
                self.add_mass(
                    node, 0.5 * plain * self.density * length * float(mod.get("MassMod", 1))
                )
            own = self.factors["DEAD"] * np.array([0, 0, -weight * plain])
            self.line(name, own, own, 0.0, 1.0)
        for r in self.t.get("FRAME LOADS - DISTRIBUTED", []):
            one, two, _ = self.axes[r["Frame"]]
            way = {"Gravity": np.array([0, 0, -1.0]), "Z": np.array([0, 0, 1.0]), "2": two}[
                r["Dir"]
            ]
            sizes = [
                float(r[f"FOverL{k}"]) * self.f / self.l * self.factors[r["LoadPat"]] for k in "AB"
            ]
            a, b = float(r["RelDistA"]), float(r["RelDistB"])
            self.line(r["Frame"], sizes[0] * way, sizes[1] * way, a, b)
        for r in self.t.get("FRAME LOADS - POINT", []):
            i, j, length, first, last, shift = self.ends[r["Frame"]]
            one, two, three = self.axes[r["Frame"]]
            size = float(r["Force"]) * self.f * self.factors[r["LoadPat"]]
            x = (float(r["AbsDist"]) * self.l - first) / (length - first - last)
            force = np.array([0, 0, -size])
            local = (force @ two, force @ three, x, force @ one)
            self.beams.append((self.tags[r["Frame"]], "-beamPoint", *local))
        for r in self.t.get("JOINT LOADS - FORCE", []):
            factor = self.factors[r["LoadPat"]] * self.f
            force = [factor * float(r.get(f"F{k}", 0)) for k in (1, 2, 3)]
            self.loads.append((int(r["Joint"]), [*force, 0.0, 0.0, 0.0]))
        for r in self.t.get("JOINT ADDED MASS ASSIGNMENTS", []):
            self.add_mass(int(r["Joint"]), float(r["Mass1"]) * self.f / self.l)

    def line(self, name: str, qa: Any, qb: Any, a: float, b: float) -> None:
        # On the flexible part as a load of the element; on stiff ends as forces and moments.
        i, j, length, first, last, shift = self.ends[name]
        one, two, three = self.axes[name]

        def size(x: float) -> Any:
            return qa + (qb - qa) * (x - a * length) / ((b - a) * length)

        for node, low, high, sign in ((i, 0.0, first, 1), (j, length - last, length, -1)):
            x0, x1 = max(low, a * length), min(high, b * length)
            if x1 > x0:
                for t in np.linspace(x0, x1, 201)[:-1] + (x1 - x0) / 400:
                    force = size(t) * (x1 - x0) / 200
                    arm = shift + one * (t if sign == 1 else t - length)
                    self.loads.append((node, [*force, *np.cross(arm, force)]))
        x0, x1 = max(first, a * length), min(length - last, b * length)
        clear = length - first - last
        if x1 - x0 > clear - 1e-9 and np.array_equal(qa, qb):
            local = (qa @ two, qa @ three, qa @ one)
            self.beams.append((self.tags[name], "-beamUniform", *map(float, local)))
        elif x1 > x0:  # OpenSees has no trapezoids, and its point loads know no releases
            assert not self.row("FRAME RELEASE ASSIGNMENTS 1 - GENERAL", "Frame", name)
            for t in np.linspace(x0, x1, 101)[:-1] + (x1 - x0) / 200:
                force = size(t) * (x1 - x0) / 100
                local = (force @ two, force @ three, (t - first) / clear, force @ one)
                self.beams.append((self.tags[name], "-beamPoint", *map(float, local)))

    def areas(self) -> None:
        self.shells = 0
        for r in self.t.get("CONNECTIVITY - AREA", []):
            corners = [int(r[f"Joint{k}"]) for k in (1, 2, 3, 4)]
            name = self.row("AREA SECTION ASSIGNMENTS", "Area", r["Area"])["Section"]
            s = self.row("AREA SECTION PROPERTIES", "Section", name)
            h = float(s["Thickness"]) * self.l
            a, b, c, d = (self.xyz[k] for k in corners)
            size = 0.5 * float(np.linalg.norm(np.cross(c - a, d - b)))
            if name == "WALL":
                self.shells += 1
                self.ops.section("ElasticMembranePlateSection", self.shells, self.e, 0.2, h, 0.0)
                self.ops.element("ShellMITC4", 10000 + self.shells, *corners, self.shells)
            live = self.row("AREA LOADS - UNIFORM", "Area", r["Area"])
            q = float(live.get("UnifLoad", 0)) * self.f / self.l**2
            for node in corners:
                self.add_mass(node, 0.25 * size * (self.density * h + self.share * q / G))
            load = self.factors["DEAD"] * self.weight * h + self.factors["LIVE"] * q
            if name == "WALL":
                for node in corners:
                    self.loads.append((node, [0, 0, -0.25 * size * load, 0, 0, 0]))
            else:
                self.slab(corners, load)

    def slab(self, corners: list[int], q: float) -> None:
        # Triangles and trapezoids under 45 degrees on the four beams, if all four are there.
        sides = [(corners[k], corners[(k + 1) % 4]) for k in range(4)]
        ends = {frozenset(e[:2]): name for name, e in self.ends.items()}
        beams = [ends.get(frozenset(side)) for side in sides]
        lengths = [float(np.linalg.norm(self.xyz[b] - self.xyz[a])) for a, b in sides]
        if None in beams:
            for node in corners:
                self.loads.append((node, [0, 0, -0.25 * lengths[0] * lengths[1] * q, 0, 0, 0]))
            return
        half = 0.5 * min(lengths[:2])
        for name, length in zip(beams, lengths, strict=True):
            peak = np.array([0, 0, -q * min(half, 0.5 * length)])
            rise = min(half, 0.5 * length) / length
            zero = np.zeros(3)
            self.line(str(name), zero, peak, 0.0, rise)
            if 1 - 2 * rise > 1e-9:
                self.line(str(name), peak, peak, rise, 1 - rise)
            self.line(str(name), peak, zero, 1 - rise, 1.0)

    def diaphragms(self) -> None:
        groups: dict[str, list[int]] = {}
        for r in self.t.get("JOINT CONSTRAINT ASSIGNMENTS", []):
            groups.setdefault(r["Constraint"], []).append(int(r["Joint"]))
        for nodes in groups.values():
            self.ops.rigidDiaphragm(3, *nodes)

    def apply(self) -> None:
        ops = self.ops
        for node, mass in self.mass.items():
            ops.mass(node, mass, mass, mass, 0, 0, 0)
        ops.timeSeries("Linear", 1)
        ops.pattern("Plain", 1, 1)
        for node, force in self.loads:
            ops.load(node, *map(float, force))
        for tag, *load in self.beams:
            ops.eleLoad("-ele", tag, "-type", *load)

    def reactions(self) -> dict[str, np.ndarray]:
        ops = self.ops
        ops.constraints("Transformation")
        ops.numberer("RCM")
        ops.system("BandGeneral")
        ops.test("NormUnbalance", 1e-6, 5)
        ops.algorithm("Linear")
        ops.integrator("LoadControl", 1.0)
        ops.analysis("Static")
        assert ops.analyze(1) == 0
        ops.reactions()
        return {
            r["Joint"]: np.array(ops.nodeReaction(int(r["Joint"])))
            for r in self.t["JOINT RESTRAINT ASSIGNMENTS"]
        }

    def periods(self, count: int) -> np.ndarray:
        self.ops.wipeAnalysis()
        self.ops.constraints("Transformation")
        self.ops.numberer("RCM")
        self.ops.system("BandGeneral")
        values = self.ops.eigen("-fullGenLapack", count)
        return 2 * np.pi / np.sqrt(np.array(values))
