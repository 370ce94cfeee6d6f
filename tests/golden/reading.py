"""What a project's folder holds: its file, its motions, tables, histories and its report.

Nothing of the package is imported: its numbers are read as they lie in the files.
"""

import csv
import html.parser
import math
import re
import tomllib
from pathlib import Path

import h5py
import numpy as np

GRAVITY = 9.80665
UNITS = {
    "m": 1.0,
    "cm": 1e-2,
    "mm": 1e-3,
    "kg": 1.0,
    "t": 1e3,
    "N": 1.0,
    "kN": 1e3,
    "MN": 1e6,
    "Pa": 1.0,
    "MPa": 1e6,
    "m/s2": 1.0,
    "kN/mm": 1e6,
    "s/m": 1.0,
    "s": 1.0,
    "kg/m2": 1.0,
    "kN/m2": 1e3,
    "kN/m": 1e3,
    "%": 1e-2,
}


def si(value):
    """Return a value of the project's file in SI units."""
    if isinstance(value, str):
        found = re.fullmatch(r"\s*([-+0-9.eE]+)\s*(\S+)\s*", value)
        return float(found[1]) * UNITS[found[2]] if found and found[2] in UNITS else value
    if isinstance(value, list):
        return [si(each) for each in value]
    if isinstance(value, dict):
        return {key: si(each) for key, each in value.items()}
    return value


class Bearing:
    """The bearing of a project's file, by the formulas of docs/theory.md, section 2."""

    def __init__(self, given):
        radius = given["radius"]
        self.R = np.array(radius if isinstance(radius, list) else [radius, radius])
        self.h, self.a = given["slider_height"], given["slider_radius"]
        self.L = self.R.sum() - self.h
        self.capacity = given["capacity"]
        self.rim = self.capacity * self.R / self.L  # sliding at which rims are met
        law = given["friction"]
        named = law if isinstance(law, dict) else {"f_max": law, "f_min": law}
        self.fast, self.slow = named["f_max"], named["f_min"]
        self.inner = given["interface_friction"]
        self.overlap = self.a  # slip at which the overlap ends, unless given
        caps = self.R - np.sqrt(self.R**2 - self.a**2)
        self.low = 0.5 * (self.h + caps[0] - caps[1])  # height of the interface over the vertex

    def share(self, friction):
        """Return the characteristic strength ratio Q/W."""
        return friction * self.R.sum() / self.L


class Project:
    """A project and what its run wrote."""

    def __init__(self, folder):
        self.folder, self.results = Path(folder), Path(folder) / "results"
        raw = tomllib.loads((self.results / "project.toml").read_text(encoding="utf-8"))
        self.file = si(raw)
        self.code = raw["project"]["code"]
        self.bearing = Bearing(self.file["bearing"])
        bounds = self.file["bounds"]
        outer, inner = (
            by_source(self.code, given) if isinstance(given, dict) else given
            for given in (bounds["friction"], bounds.get("interface", bounds["friction"]))
        )
        self.outer = {"lower": outer[0], "nominal": 1.0, "upper": outer[1]}
        self.inner = {"lower": inner[0], "nominal": 1.0, "upper": inner[1]}
        self.devices = {"standard": self.bearing}
        for name, own in self.file.get("bearings", {}).items():
            self.devices[name] = Bearing(self.file["bearing"] | own)
        self.limits = self.file.get("limits", {})
        self.analysis = self.file.get("analysis", {})
        self.governing = netcdf(self.results / "governing.nc")
        self.runs, self.moved = self._histories("runs"), self._histories("moved")
        self.types = [self._type(row) for row in self.table("bearings")]

    def _histories(self, kind):
        # By level, then bound.
        found = {}
        for path in sorted(self.results.glob(f"{kind}-*.nc")):
            level, _, bound = path.stem.removeprefix(f"{kind}-").rpartition("-")
            found.setdefault(level, {})[bound] = netcdf(path)
        order = ("lower", "nominal", "upper")
        return {
            level: {bound: each[bound] for bound in order if bound in each}
            for level, each in sorted(found.items())
        }

    def _type(self, row):
        # A type that names the column, else the highest load that is exceeded; bearings of one
        # height, so that the loads of standard ones are those of the table.
        given, load = self.file.get("bearings", {}), float(row["average load [N]"])
        column = row["bearing"].removeprefix("bearing-")
        for name, own in given.items():
            if column in own.get("columns", []):
                return name
        heavy = [name for name, own in given.items() if load >= own.get("above", float("inf"))]
        return max(heavy, key=lambda name: given[name]["above"], default="standard")

    def kinds(self):
        """Return the types that stand somewhere, each with the places of its bearings."""
        places = {
            name: [k for k, own in enumerate(self.types) if own == name] for name in self.devices
        }
        return {name: own for name, own in places.items() if own}

    def table(self, name):
        """Return the rows of a table as mappings."""
        with (self.results / f"{name}.csv").open(encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file))

    def text(self, name):
        """Return a text file of the results."""
        return (self.results / name).read_text(encoding="utf-8")


def by_source(code, given):
    """Return lower and upper factor on friction, of their sources.

    ASCE 7-22 17.2.8.4, EN 1998-2 annex J; the product of all where a code has no rule.
    """
    found = []
    for end in (0, 1):
        each = {name: pair[end] for name, pair in given.items() if isinstance(pair, list)}
        spec = each.pop("specification", 1.0)
        if code == "ASCE 7-22":
            aged = each.pop("ageing", 1.0) * each.pop("contamination", 1.0)
            factor = (1.0 + 0.75 * (aged - 1.0)) * each.pop("test", 1.0) * spec
            if not given.get("full_scale_tests", False):
                factor = max(factor, 1.8) if end else min(factor, 0.6)
        elif code == "EN 1998":
            psi = {"I": 0.6, "II": 0.7, "III": 0.9}[given.get("importance_class", "II")]
            factor = spec * math.prod(1.0 + (value - 1.0) * psi for value in each.values())
        else:
            factor = spec * math.prod(each.values())
        found.append(factor)
    return found


class Data(dict):
    """Variables of a netCDF file by name, with its attributes."""

    attrs: dict


def netcdf(path):
    """Read a netCDF file by HDF5 alone."""
    data = Data()
    with h5py.File(path) as file:
        data.attrs = {key: plain(value) for key, value in file.attrs.items()}
        for name, variable in file.items():
            values = variable[()]
            if values.dtype == object:
                values = np.array([plain(each) for each in values.ravel()]).reshape(values.shape)
            elif values.dtype.kind == "f":
                values = values.astype(float)
            data[name] = values
    return data


def plain(value):
    """Return bytes as text, arrays of one number as that."""
    if isinstance(value, bytes):
        return value.decode()
    if isinstance(value, np.ndarray) and value.size == 1:
        return plain(value.ravel()[0])
    return value


class Tables(html.parser.HTMLParser):
    """The tables of a report: each with the heading it stands under, its head and its rows."""

    def __init__(self):
        super().__init__()
        self.heading, self.tables, self.row, self.cell, self.depth = "", [], None, None, ""

    def handle_starttag(self, tag, attrs):
        """Begin a heading, a table, a row or a cell."""
        if tag == "h2":
            self.depth = "h2"
            self.heading = ""
        elif tag == "table":
            self.tables.append((self.heading, []))
        elif tag == "tr":
            self.row = []
        elif tag in {"td", "th"}:
            self.cell = ""

    def handle_endtag(self, tag):
        """End it."""
        if tag == "h2":
            self.depth = ""
        elif tag in {"td", "th"} and self.cell is not None:
            self.row.append(" ".join(self.cell.split()))
            self.cell = None
        elif tag == "tr" and self.row is not None:
            self.tables[-1][1].append(self.row)
            self.row = None

    def handle_data(self, data):
        """Take text up."""
        if self.depth == "h2":
            self.heading += data
        if self.cell is not None:
            self.cell += data


def tables_of(text):
    """Return the tables of a report as (heading, head, rows), without the cover's."""
    parser = Tables()
    parser.feed(text)
    under = ((heading.strip(), rows) for heading, rows in parser.tables)
    return [(heading, rows[0], rows[1:]) for heading, rows in under if rows and heading]
