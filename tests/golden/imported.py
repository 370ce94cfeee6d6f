"""A model of ETABS' or SAP2000's text, read by itself: what it weighs, and what of it was read."""

import math
import re


class Model:
    """The lines of a file in kN and m, of rectangles and slabs of one material."""

    def __init__(self, path):
        self.lines = {}
        for line in path.read_text(encoding="utf-8").splitlines():
            words = [a or b for a, b in re.findall(r'"([^"]*)"|(\S+)', line)]
            if words and not line.startswith("$"):
                self.lines.setdefault(words[0], []).append(words[1:])
        rows = self.lines["STORY"][::-1]
        self.z, at = {}, 0.0
        for name, *words in rows:
            at += float(words[1])  # HEIGHT, of the base its elevation
            self.z[name] = at
        self.plan = {name: (float(x), float(y)) for name, x, y in self.lines["POINT"]}

    def value(self, kind, name, word):
        """Return the number behind a word of the lines of an object."""
        for found, *words in self.lines[kind]:
            if found == name and word in words:
                return float(words[words.index(word) + 1])
        raise KeyError(kind, name, word)

    def objects(self, kind):
        """Return name, story and section of assigned objects."""
        return [(words[0], words[1], words[3]) for words in self.lines[kind]]

    def frames(self):
        """Return names and volumes of columns and beams [m3]."""
        ends = {name: (i, j, int(down)) for name, _, i, j, down in self.lines["LINE"]}
        names, found = list(self.z), []
        for name, story, section in self.objects("LINEASSIGN"):
            i, j, down = ends[name]
            low = self.z[names[names.index(story) - down]]
            length = math.dist((*self.plan[i], low), (*self.plan[j], self.z[story]))
            size = math.prod(self.value("FRAMESECTION", section, side) for side in "DB")
            found.append((f"{name}-{story}", length * size))
        return found

    def size(self, name):
        """Return the size of an area in plan [m2], by the shoelace."""
        words = next(words for words in self.lines["AREA"] if words[0] == name)
        corners = [self.plan[p] for p in words[3 : 3 + int(words[2])]]
        turned = [*corners[1:], corners[0]]
        return 0.5 * abs(sum(a * d - b * c for (a, b), (c, d) in zip(corners, turned, strict=True)))

    def slabs(self):
        """Return names and volumes of slabs [m3]."""
        return [
            (f"{name}-{story}", self.size(name) * self.value("SHELLPROP", section, "SLABTHICKNESS"))
            for name, story, section in self.objects("AREAASSIGN")
        ]

    def pressed(self, pattern):
        """Return the load of a pattern on all areas [N]."""
        found = 0.0
        for words in self.lines["AREALOAD"]:
            if words[words.index("LC") + 1] == pattern:
                found += 1e3 * float(words[words.index("FVAL") + 1]) * self.size(words[0])
        return found

    def cases(self):
        """Return dead and live load [N], and the mass [kg]."""
        volume = math.fsum(v for _, v in [*self.frames(), *self.slabs()])
        (material, *_), *_ = self.lines["MATERIAL"]
        weight = 1e3 * self.value("MATERIAL", material, "WEIGHTPERVOLUME") * volume
        mass = 1e3 * self.value("MATERIAL", material, "MASSPERVOLUME") * volume
        found = {"Dead": 0.0, "Live": 0.0}
        for name, _, kind, _, own in self.lines["LOADPATTERN"]:
            load = self.pressed(name) + float(own) * weight
            found["Live" if kind == "Live" else "Dead"] += load
        for _, pattern, share in self.lines["MASSSOURCELOAD"]:
            mass += float(share) * self.pressed(pattern) / 9.80665
        return found["Dead"], found["Live"], mass

    def told(self):
        """Return the rows of what became of the file, each with its key."""
        slabs, frames = self.slabs(), self.frames()
        share = sum(v for _, v in slabs) / sum(v for _, v in [*slabs, *frames])
        feet = [f"{words[0]}-{words[1]}" for words in self.lines["POINTASSIGN"]]
        part = f"{len(slabs)}, {share:.1%} of own weight, {share:.1%} of stiffness"
        kinds = len({words[0] for words in self.lines["FRAMESECTION"]})
        alone = "by their loads and masses alone: their bending is not stiff"
        other = [
            f"areas: slabs in rigid diaphragms, {alone}: {', '.join(n for n, _ in slabs)} ({part})",
            f"supports: supports, each of them a bearing on the ground: {', '.join(feet)} "
            f"({len(feet)})",
            "masses: of loads and elements, in all three directions: all (1)",
        ]
        used = len({words[0] for words in self.lines["MATERIAL"]})
        same = [
            f"STORIES: stories ({len(self.z)})",
            f"MATERIAL PROPERTIES: materials in use ({used})",
            f"FRAME SECTIONS: cross-sections in use ({kinds})",
            f"SHELLPROP: sections of areas in use ({len(self.lines['SHELLPROP'])})",
            f"DIAPHRAGM NAMES: rigid diaphragms by story ({len(slabs)})",
            f"POINT COORDINATES: joints ({len(self.plan) * len(self.z)})",
            f"LINE CONNECTIVITIES: frame objects by story ({len(frames)})",
            f"AREA CONNECTIVITIES: areas by story ({len(slabs)})",
            f"POINT ASSIGNS: supports ({len(feet)})",
            f"LOAD PATTERNS: load patterns ({len(self.lines['LOADPATTERN'])})",
            f"AREA OBJECT LOADS: loads on areas ({len(self.lines['AREALOAD'])})",
            "MASS SOURCE: mass source (1)",
        ]
        return [("read as something else", text) for text in other] + [
            ("read", text) for text in same
        ]


class Tables:
    """The tables of a file of SAP2000 in kN and m: frames and slabs of one material, no offsets."""

    def __init__(self, path):
        self.rows, name = {}, ""
        for line in path.read_text(encoding="utf-8").replace(" _\n", " ").splitlines():
            head = re.match(r'TABLE:\s+"([^"]*)"', line)
            if head:
                name = head[1]
            elif "=" in line:
                words = {
                    key: a or b for key, a, b in re.findall(r'(\w+)=(?:"([^"]*)"|(\S+))', line)
                }
                self.rows.setdefault(name, []).append(words)
        self.at = {
            row["Joint"]: tuple(float(row[key]) for key in ("XorR", "Y", "Z"))
            for row in self.rows["JOINT COORDINATES"]
        }

    def by(self, table, key, value):
        """Return a column of a table by another."""
        return {row[key]: row[value] for row in self.rows[table]}

    def sizes(self):
        """Return the size of each area in plan [m2], of rectangles."""
        found = {}
        for row in self.rows["CONNECTIVITY - AREA"]:
            one, other = (self.at[row[key]] for key in ("Joint1", "Joint3"))
            found[row["Area"]] = abs((other[0] - one[0]) * (other[1] - one[1]))
        return found

    def volume(self):
        """Return the volume of all members and slabs [m3]."""
        areas = self.by("FRAME SECTION PROPERTIES 01 - GENERAL", "SectionName", "Area")
        of = self.by("FRAME SECTION ASSIGNMENTS", "Frame", "AnalSect")
        volumes = [
            math.dist(self.at[row["JointI"]], self.at[row["JointJ"]])
            * float(areas[of[row["Frame"]]])
            for row in self.rows["CONNECTIVITY - FRAME"]
        ]
        thick = self.by("AREA SECTION PROPERTIES", "Section", "Thickness")
        of = self.by("AREA SECTION ASSIGNMENTS", "Area", "Section")
        volumes += [size * float(thick[of[name]]) for name, size in self.sizes().items()]
        return math.fsum(volumes)

    def cases(self):
        """Return dead and live load [N], and the mass [kg]."""
        (material,) = self.rows["MATERIAL PROPERTIES 02 - BASIC MECHANICAL PROPERTIES"]
        volume, sizes = self.volume(), self.sizes()
        mass = 1e3 * float(material["UnitMass"]) * volume
        found, pressed = {"Dead": 0.0, "Live": 0.0}, {}
        for row in self.rows["AREA LOADS - UNIFORM"]:
            load = 1e3 * float(row["UnifLoad"]) * sizes[row["Area"]]
            pressed[row["LoadPat"]] = pressed.get(row["LoadPat"], 0.0) + load
        for row in self.rows["LOAD PATTERN DEFINITIONS"]:
            load = float(row["SelfWtMult"]) * 1e3 * float(material["UnitWeight"]) * volume
            load += pressed.get(row["LoadPat"], 0.0)
            found["Live" if row["DesignType"] == "Live" else "Dead"] += load
        for row in self.rows["MASS SOURCE"]:
            mass += float(row["Multiplier"]) * pressed[row["LoadPat"]] / 9.80665
        return found["Dead"], found["Live"], mass


def model(project):
    """Return the model of a project."""
    given = project.file["structure"]
    kind = Tables if given["kind"] == "sap2000" else Model
    return kind(project.folder / given["file"])


def compare(project, tally, average):
    """Hold the weight that the bearings carry [N], and the mass, against the model's file."""
    _, _, mass = model(project).cases()
    name = "loads and masses, by hand"
    tally.category(name, 1e-9, "sums of the same numbers in another order")
    carried = float(project.governing["weight"])
    tally.same(name, "average combination", carried, average)
    for axis in (0, 1, 2):
        own = project.governing["node_mass"][:, axis].sum()
        tally.same(name, f"mass along {'xyz'[axis]}", own, mass)
