"""Tables of demands, bearings, friction and tests, from what runs reached and the file says."""

import math

import codes
import numpy as np

MEAN_FROM = 7
LEVELS = {  # name: factor on the motions, and what is judged
    "ASCE 7-22": {"": "all"},
    "EN 1998": {"": "all"},
    "NCh2745": {"design": "superstructure", "maximum": "isolation"},
}
ROWS = {
    "isolator displacement": ("displacement", 1),
    "residual displacement": ("displacement_left", 1),
    "interface slip": ("slip", 1),
    "residual interface slip": ("slip_left", 1),
    "rim force": ("rim_force", 1),
    "maximum axial force": ("axial_force", 1),
    "minimum axial force": ("axial_tension", -1),
    "uplifts, all bearings": ("uplifts", 1),
    "uplift duration": ("time_lifted", 1),
    "maximum uplift": ("gap", 1),
    "base shear": ("base_shear", 1),
    "storey shear": ("storey_shear", 1),
    "storey drift ratio": ("drift", 1),
    "storey drift ratio, maximum at any column line": ("line_drift", 1),
    "floor acceleration in plan": ("floor_plan", 1),
}


FACTORS = {
    "displacement",
    "force",
    "axial_force",
    "base_shear",
    "storey_shear",
    "drift",
    "line_drift",
    "floor_plan",
}
DIFFERENCES = {
    "slip",
    "rim_force",
    "eccentricity_loaded",
    "axial_tension",
    "displacement_left",
    "slip_left",
}


class Suite:
    """How the runs at one level and bound count."""

    def __init__(self, project, data, peaks, moved=None, moved_peaks=None):
        self.data, self.peaks = data, peaks
        self.moved, self.moved_peaks = moved, moved_peaks
        status = np.array(list(map(str, data["status"])))
        own = project.analysis.get("uplift_allowed", project.code == "ASCE 7-22")
        gap = project.analysis.get("least_gap", 1e-3)
        self.parted = peaks["gap"] > gap
        self.stopped = status != "ok"
        self.failed = self.stopped | (self.parted.any(axis=1) & (not own))
        self.uplift_allowed, self.least_gap = own, gap
        self.mean = len(status) >= MEAN_FROM
        self.void = bool(self.failed.any())
        self.more = {}
        if moved is not None:
            part = Suite(project, moved, moved_peaks)
            self.moved_failed, self.moved_stopped = part.failed, part.stopped
            self.void = self.void or part.void
            self.more = {name: max(self._raises(name)) for name in (*FACTORS, *DIFFERENCES)}

    def ways(self):
        """Yield each way of moving masses with its runs, and the runs of the same motions."""
        if self.moved is None:
            return
        known = list(zip(map(str, self.data["motion"]), self.data["scale"], strict=True))
        ways = list(map(str, self.moved["mass_shift"]))
        for way in dict.fromkeys(ways):
            there = [k for k, word in enumerate(ways) if word == way]
            own = [(str(self.moved["motion"][k]), self.moved["scale"][k]) for k in there]
            yield way, [known.index(each) for each in own], there

    def _raises(self, name):
        # What each way of the masses does to the largest of a quantity: factor and difference.
        there, here = (each[name] for each in (self.moved_peaks, self.peaks))
        for _, centred, moved in self.ways():
            pair = largest(here[centred]), largest(there[moved])
            if name in DIFFERENCES:
                yield 1.0, max(pair[1] - pair[0], 0.0)
            else:
                yield (max(pair[1] / pair[0], 1.0) if pair[0] > 0.0 else 1.0), 0.0

    def design(self, name):
        """Return the value of each place with what moved masses add, (m,)."""
        factor, added = self.more.get(name, (1.0, 0.0)) if not self.void else (1.0, 0.0)
        return factor * self.of(name) + added

    def every(self, name):
        """Return what runs reached, those with moved masses last, (n_runs, m)."""
        parts = [each[name] for each in (self.peaks, self.moved_peaks) if each is not None]
        return np.concatenate([part.reshape(len(part), -1) for part in parts]).astype(float)

    def value(self, column):
        """Return mean or largest; of failed runs what they reached."""
        column = column[np.isfinite(column)]
        return float(column.mean() if self.mean else column.max())

    def of(self, name):
        """Return the value of each place, (m,)."""
        values = self.reached(name)
        return np.array([self.value(column) for column in values.T])

    def reached(self, name):
        """Return what runs reached, (n_runs, m)."""
        values = self.peaks[name]
        return values.reshape(len(values), -1).astype(float)

    def names(self, name):
        """Return the names of a quantity's places."""
        kind = name.removesuffix("_left")
        if kind in {"base_shear", "uplifts"}:
            return [""]
        key = {
            "drift": "storey",
            "storey_shear": "storey",
            "line_drift": "line",
            "floor_plan": "level",
        }.get(kind, "bearing")
        return list(map(str, self.data[key]))


def largest(values):
    """Return the largest over all places of the mean or the largest of runs, (n_runs, ...)."""
    columns = values.reshape(len(values), -1)
    return (columns.mean(0) if len(values) >= MEAN_FROM else columns.max(0)).max()


def suites(project):
    """Return the suites by level, then bound."""
    found = {}
    for (level, bound), peaks in project.peaks.items():
        beside = project.moved.get(level, {}).get(bound), project.moved_peaks.get((level, bound))
        own = project.runs[level][bound]
        found.setdefault(level, {})[bound] = Suite(project, own, peaks, *beside)
    return found


def compare(project, tally):
    """Hold the tables against what is found; return the suites."""
    found = suites(project)
    _demands(project, found, tally)
    _by_motion(project, found, tally)
    _eccentricity(project, found, tally)
    _bearings(project, tally)
    _friction(project, tally)
    _programme(project, found, tally)
    return found


WAYS = {"+x": (0, 1.0), "-x": (0, -1.0), "+y": (1, 1.0), "-y": (1, -1.0)}


def _eccentricity(project, found, tally):
    # The table of moved masses; that the motion is the governing one, and each way is there once.
    name = "moved masses: raises of each way"
    tally.category(name, 1e-4, "of peaks from histories, in single precision")
    wanted = project.analysis.get("accidental_eccentricity", 0.05) != "none"
    if not project.moved:
        tally.words(name, "no moved runs", wanted, False)
        return
    rows = iter(project.table("eccentricity"))
    for level, each in found.items():
        for bound, suite in each.items():
            far = suite.peaks["displacement"].max(1)
            counts = ~suite.failed if not suite.failed.all() else suite.failed
            far = np.where(counts, far, -math.inf).argmax()
            for way, here, there in suite.ways():
                label = f"{level} {bound} {way}"
                if project.analysis.get("accidental_eccentricity_motions") != "all":
                    tally.same(name, f"{label} motion", here, [far])
                for quantity in ORDER:
                    _one_way(suite, quantity, (here, there), next(rows), tally)
            tally.words(name, "ways", [way for way, *_ in suite.ways()], list(WAYS))
    tally.words(name, "no more rows", next(rows, None), None)


ORDER = (
    "displacement",
    "force",
    "axial_force",
    "base_shear",
    "floor_plan",
    "storey_shear",
    "drift",
    "line_drift",
    "slip",
    "rim_force",
    "axial_tension",
    "eccentricity_loaded",
    "displacement_left",
    "slip_left",
)


def _one_way(suite, quantity, places, row, tally):
    name = "moved masses: raises of each way"
    label = f"{row['level']} {row['bound']} {row['masses']} {quantity}"
    tally.words(name, label, row["quantity"], quantity.replace("_", " "))
    here, there = places
    pair = largest(suite.peaks[quantity][here]), largest(suite.moved_peaks[quantity][there])
    floor = floor_of(quantity)
    tally.same(name, f"{label} centred", row["centred"], pair[0], floor)
    tally.same(name, f"{label} moved", row["moved"], pair[1], floor)
    if quantity in FACTORS:
        tally.words(name, f"{label} added", row["added"], "")
        tally.same(name, f"{label} factor", row["factor"], max(pair[1] / pair[0], 1.0))
    else:
        size = max(*map(abs, pair), floor)  # a difference of nearly equal numbers
        tally.words(name, f"{label} factor", row["factor"], "")
        tally.same(name, f"{label} added", row["added"], max(pair[1] - pair[0], 0.0), size)


def _demands(project, found, tally):
    name = "demands: statistics over motions"
    tally.category(name, 1e-4, "of peaks from histories, in single precision")
    for row in project.table("demands"):
        level = row["level"] if project.code == "NCh2745" else ""
        quantity, sign = ROWS[row["quantity"]]
        best = (-math.inf, "")
        worst = -math.inf
        for bound, suite in found[level].items():
            column = next(key for key in row if key.startswith(f"{bound}, "))
            left = quantity.endswith("_left")
            values = suite.reached(quantity)
            if left:
                values = np.where(suite.stopped[:, None], np.nan, values)
            if left and suite.void and suite.stopped.any():
                each = np.full(values.shape[1], np.nan)
            else:
                each = suite.design(quantity)
            largest = np.nan if np.isnan(each).all() else sign * np.nanmax(each)
            tally.same(
                name,
                f"{level} {row['quantity']} {bound}",
                row[column] or np.nan,
                largest,
                floor_of(quantity),
            )
            said = f"{'mean' if suite.mean else 'largest'} of"
            if len(suite.failed) == 1 and not suite.void:
                said = "1 run"
            if suite.moved is not None and not suite.void:
                words = ", raised by moved masses" in column
                tally.words(name, f"{level} {bound} raised", words, True)
            tally.words(
                name,
                f"{level} {bound} statistic",
                said if said in column else column,
                said,
            )
            if ":" not in column:  # one statistic for all levels
                tally.words(name, "void is marked", "no valid value" in column, bool(suite.void))
            if not np.isnan(each).all() and np.nanmax(each) > best[0]:
                best = float(np.nanmax(each)), suite.names(quantity)[int(np.nanargmax(each))]
            if not np.isnan(values).all():
                worst = max(worst, float(np.nanmax(values)))
            if suite.moved is not None:
                beside = suite.moved_peaks[quantity].reshape(len(suite.moved_stopped), -1)
                beside = np.where(left & suite.moved_stopped[:, None], -math.inf, beside)
                worst = max(worst, float(beside.max()))
        last = next(key for key in row if key.startswith("worst of all"))
        finite = math.isfinite
        tally.same(
            name,
            f"{level} {row['quantity']} envelope",
            row["envelope of these"] or np.nan,
            sign * best[0] if finite(best[0]) else np.nan,
            floor_of(quantity),
        )
        tally.same(
            name,
            f"{level} {row['quantity']} worst",
            row[last] or np.nan,
            sign * worst if finite(worst) else np.nan,
            floor_of(quantity),
        )
        if best[0] > 0.0 and row["where"] != best[1]:
            near(found[level], quantity, row["where"], best, tally, name)


BY_MOTION = {
    **ROWS,
    "lateral force of a bearing": ("force", 1),
    "normalised eccentricity e/a": ("eccentricity_loaded", 1),
}
ONE = {"base_shear", "uplifts"}  # without places


def _by_motion(project, found, tally):
    name = "demands of each motion"
    tally.category(name, 1e-4, "of peaks from histories, in single precision")
    rows = iter(project.table("demands-by-motion"))
    for level, each in found.items():
        for bound, suite in each.items():
            for k, motion in enumerate(map(str, suite.data["motion"])):
                row = next(rows)
                said = [row["bound"], row["motion"], row["masses moved"], row["failed"]]
                known = [bound, motion, "", "yes" if suite.failed[k] else "no"]
                tally.words(name, "run", " ".join(said), " ".join(known))
                if level:
                    tally.words(name, "level", row["level"], level)
                for title, (quantity, sign) in BY_MOTION.items():
                    _one_motion(suite, k, (title, quantity, sign), row, tally)
            beside = suite.moved["motion"] if suite.moved is not None else ()
            for k, motion in enumerate(map(str, beside)):
                row, way = next(rows), str(suite.moved["mass_shift"][k])
                said = [row["bound"], row["motion"], row["masses moved"], row["failed"]]
                known = [bound, motion, way, "yes" if suite.moved_failed[k] else "no"]
                tally.words(name, "run", " ".join(said), " ".join(known))
                for title, (quantity, sign) in BY_MOTION.items():
                    _one_motion(suite, -1 - k, (title, quantity, sign), row, tally)
    tally.words(name, "no more rows", next(rows, None), None)


def _one_motion(suite, k, column, row, tally):
    title, quantity, sign = column
    name, label = "demands of each motion", f"{row['motion']} {row['bound']} {title}"
    head = next((key for key in row if key.startswith(f"{title} [")), None)
    if head is None:
        tally.unknown(name, label)
        return
    unit = head.removeprefix(title)
    if k >= 0:
        own, stopped = suite.reached(quantity)[k].copy(), suite.stopped[k]
    else:  # of the runs with moved masses the one of place -1 - k
        k = len(suite.failed) - 1 - k
        own, stopped = suite.every(quantity)[k], suite.moved_stopped[k - len(suite.failed)]
    if quantity.endswith("_left") and stopped:
        own[:] = np.nan
    place = 0
    if quantity not in ONE:
        place = suite.names(quantity).index(row[f"{title}, at"])
        if not np.isnan(own).any():
            far = float(row[f"{title}, farthest{unit}"])
            tally.same(name, f"{label} farthest", far, sign * own.max(), floor_of(quantity))
    tally.same(name, label, row[head] or np.nan, sign * own[place], floor_of(quantity))
    void = quantity.endswith("_left") and suite.void
    if quantity not in ONE and not void:  # the place is that of the largest value for design
        each = suite.of(quantity)
        tally.same(name, f"{label} at", each[place], each.max(), floor_of(quantity))


def near(each, quantity, reported, best, tally, name):
    """Allow the name of another place that reached as much, to single precision."""
    values = [s.of(quantity)[s.names(quantity).index(reported)] for s in each.values()]
    tally.same(
        name,
        f"where {quantity}: {reported} for {best[1]}",
        max(values),
        best[0],
        floor_of(quantity),
    )


def floor_of(quantity):
    """Return the size below which differences of a quantity are round-off of single precision."""
    return {
        "gap": 0.1,
        "g": 0.1,
        "slip": 1e-3,
        "slip_left": 1e-3,
        "displacement_left": 1e-2,
        "axial_tension": 1e4,
        "drift": 1e-3,
        "line_drift": 1e-3,
        "eccentricity_loaded": 1e-2,
    }.get(quantity, 0.0)


def _bearings(project, tally):
    name = "table of bearings"
    tally.category(name, 1e-4, "of peaks from histories; average loads beside those at rest")
    columns = {
        "displacement [m]": ("displacement", 1),
        "slip [m]": ("slip", 1),
        "rim force [N]": ("rim_force", 1),
        "largest load [N]": ("axial_force", 1),
        "least load [N]": ("axial_tension", -1),
    }
    statics = project.governing
    for k, row in enumerate(project.table("bearings")):
        for column, (quantity, sign) in columns.items():
            every = *project.peaks.values(), *project.moved_peaks.values()
            reached = [peaks[quantity][:, k].max() for peaks in every]
            tally.same(
                name,
                f"{row['bearing']} {column}",
                row[column],
                sign * max(reached),
                floor_of(quantity),
            )
        if len(project.kinds()) > 1:
            tally.words(name, f"{row['bearing']} type", row["type"], project.types[k])
        top = statics["node_position"][statics["bearing_node"][k, 1]]
        tally.same(name, f"{row['bearing']} place", [row["x [m]"], row["y [m]"]], top[:2])
        tally.same(
            name,
            f"{row['bearing']} load at rest, by the weight",
            1.0,
            1.0
            + abs(float(row["average load [N]"]) - statics["static_axial_force"][k])
            / statics["static_axial_force"].max()
            * 1e-2,
        )  # friction holds some at rest
    total = sum(float(row["average load [N]"]) for row in project.table("bearings"))
    tally.same(name, "sum of the loads", total, float(statics["weight"]))


def _friction(project, tally):
    name = "table of friction"
    tally.category(name, 1e-12, "products of numbers of the file")
    own = {}
    kinds = project.kinds()
    for kind in kinds:
        b, more = project.devices[kind], f", {kind}" if len(kinds) > 1 else ""
        own |= {f"{side} surface{more}": (b.fast, project.outer) for side in ("bottom", "top")}
        slow = {f"{side} surface, slow{more}": b.slow for side in ("bottom", "top")}
        own |= {what: (value, project.outer) for what, value in slow.items()}
        own[f"interface{more}"] = b.inner, project.inner
    rows = project.table("friction")
    for row in rows:
        what = row["friction coefficient"]
        value, factors = own[what]
        for bound in ("lower", "nominal", "upper"):
            tally.same(name, f"{what} {bound}", row[bound], factors[bound] * value)
    said = {row["friction coefficient"] for row in rows}
    missing = [what for what in own if what not in said and ", slow" not in what]
    tally.words(name, "rows that are missing", missing, [])


class Tests:
    """Numbers that the programme of tests is made of."""

    def __init__(self, project, found, kind="standard", places=None):
        most = max(each["total"] for each in project.linear.values())
        alike = [each for each in project.linear.values() if each["total"] > (1.0 - 1e-6) * most]
        own = min(alike, key=lambda each: each["period"])  # alike: the faster tests
        self.own, self.b, self.system = own, project.devices[kind], own["system"]
        self.moved, self.total = own.get("moved", own["centre"]), own["total"]
        self.more = 1.2 if project.code == "EN 1998" else 1.0  # gamma_x
        self.slow = 0.05  # m/s
        level = "maximum" if project.code == "NCh2745" else ""
        self.loads, self.slip = asked(project, found[level], places)
        self.average = self.system.P[places if places is not None else slice(None)].mean()
        self.impact = impact_speed(project)

    def force(self, load, moved, alone, ends):
        """Return the lateral force with friction at a bound: (surfaces, interface)."""
        outer, inner = ends
        b = self.b
        if alone:
            return inner * b.inner * load
        if moved <= b.capacity:
            return load * (moved / b.L + outer * b.share(b.fast))
        return load * math.tan(math.asin(b.capacity / b.L) + math.atan(inner * b.inner))


def asked(project, suites_, places=None):
    """Return the loads that are checked and the slip: of the bearings of a type, or of all."""
    if places is None:  # the largest and the least of all types
        each = [asked(project, suites_, own) for own in project.kinds().values()]
        least, most = min(one[0][0] for one in each), max(one[0][1] for one in each)
        return (least, most), max(one[1] for one in each)
    b = project.devices[project.types[places[0]]]
    average = next(iter(project.linear.values()))["system"].P[places]
    loads = list(average)
    if not unknown_loads(project):
        shares = codes.dead_shares(project)
        loads += [load for share in shares for load in average * share[places]]
    void = any(suite.void for suite in suites_.values())
    for name, sign in (("axial_force", 1.0), ("axial_tension", -1.0)):
        each = [suite.design(name)[places] for suite in suites_.values()]
        loads += [*sign * np.max(each, axis=0)]  # of a bearing at the bound that is worst
    slip = max(suite.design("slip")[places].max() for suite in suites_.values())
    moved = max(suite.design("displacement")[places].max() for suite in suites_.values())
    if void:
        slip = b.overlap
    elif project.code == "EN 1998":
        slip = max(slip, 1.2 * moved - b.capacity)
    loads = [load for load in loads if load > 0.0]
    return (min(loads), max(loads)), slip


MULTIPLES = "multiples of the loads on average: the frame's equilibrium is nearly linear"
"""Why loads of combinations agree as they do."""


def unknown_loads(project):
    """Say whether the bearings' own loads are not known, as the notes of tests have it."""
    return any("not evaluated" in row["note"] for row in project.table("programme"))


def impact_speed(project):
    """Return the largest speed with which a rim is first met in the governing run."""
    data = project.governing
    speed = np.hypot(*np.moveaxis(data["bearing_velocity"][..., :2], -1, 0))
    found = []
    for k in range(data["rim_force"].shape[1]):
        for side in (0, 1):
            met = np.flatnonzero(data["rim_force"][:, k, side] > 0.0)
            if len(met):
                found.append(speed[max(met[0] - 1, 0), k])
    return max(found) if found else None


def _programme(project, found, tally):
    name = "programme of tests"
    tally.category(name, 2e-3, MULTIPLES)
    words = {"ASCE 7-22": _of_asce, "EN 1998": _of_en, "NCh2745": _of_nch}[project.code]
    project.tests, plan, kinds = {}, [], project.kinds()
    for n, kind in enumerate(dict.fromkeys(project.types), start=1):
        project.tests[kind] = d = Tests(project, found, kind, kinds[kind])
        title = f"kind {n}, {len(kinds[kind])} of {len(project.types)}"
        of_all = Tests(project, found, kind)  # tests are at the loads and the slip of all types
        of_all.average = d.average
        plan += [
            (title, of_all, test)
            for test in (*words(of_all, project), *_produced(of_all, project), *_of_all(of_all))
        ]
    rows = project.table("programme")
    tally.same(name, "number of tests", len(rows), len(plan))
    hidden = unknown_loads(project)
    for row, (title, d, test) in zip(rows, plan, strict=True):
        what, moved, load, cycles, speed, alone = test
        tally.words(name, "test", row["what"], what)
        tally.words(name, f"{what}: bearings", row["bearings"], title)
        unknown = hidden and ("largest load" in what or "least load" in what)
        load = math.nan if unknown else load
        ends = [(project.outer[e], project.inner[e]) for e in ("lower", "upper")]
        forces = [math.nan if math.isnan(moved) else d.force(load, moved, alone, e) for e in ends]
        if what == "wind":
            wind = project.file.get("superstructure", {}).get("wind_shear", 0.0)
            forces = 2 * [wind / len(d.system.P) or math.nan]
        own = {
            "displacement [m]": moved,
            "vertical load [N]": load,
            "cycles": cycles,
            "peak speed [m/s]": speed,
            "period [s]": 2.0 * math.pi * moved / speed if speed > 0.0 else math.nan,
            "least force [N]": forces[0],
            "largest force [N]": forces[1],
        }
        for column, value in own.items():
            tally.same(name, f"{what}: {column}", row[column] or math.nan, value)


def _steps(d, steps):
    for word, load in (("average", d.average), ("largest", d.loads[1]), ("least", d.loads[0])):
        for title, moved, period in steps:
            speed = 2.0 * math.pi * moved / period
            yield f"increments, {word} load, {title}", moved, load, 3, speed, False


def _harmonic(d, moved):
    return 2.0 * math.pi * moved / d.own["period"]


def _of_asce(d, project):
    nan, given = math.nan, project.file["spectrum"]
    yield "production, each bearing", 0.67 * d.moved, d.average, 3, d.slow, False
    yield "wind", nan, d.average, 20, nan, False
    yield from _steps(
        d, [(f"{s:g} D_M", s * d.moved, d.own["period"]) for s in (0.25, 0.5, 0.67, 1.0)]
    )
    for title, moved in (("D_M", d.moved), ("D_TM", d.total)):
        yield f"maximum displacement, {title}", moved, d.average, 3, _harmonic(d, moved), False
    count = max(10.0, 30.0 * given["s_m1"] / (given["s_ms"] * d.own["factor"]))
    moved = 0.75 * d.moved
    yield "many cycles, 0.75 D_M", moved, d.average, math.ceil(count), _harmonic(d, moved), False
    yield "static, largest load, D_TM", d.total, d.loads[1], 1, d.slow, False
    yield "static, least load, D_TM", d.total, d.loads[0], 1, d.slow, False


def _of_en(d, project):
    fast = _harmonic(d, d.total)
    service = project.file.get("superstructure", {}).get("service_displacement", math.nan)
    yield "S, service", service, d.average, 20, 0.1 * d.slow, False
    for title, share, load, speed in (
        ("P1, benchmark", 1.0, d.average, d.slow),
        ("D1, dynamic", 0.25, d.average, fast),
        ("D2, dynamic", 0.5, d.average, fast),
        ("D3, dynamic", 1.0, d.average, fast),
        ("P2, integrity of the liner", 1.0, d.average, d.slow),
        ("D4, seismic, largest load", 1.0, d.loads[1], fast),
        ("D5, seismic, least load", 1.0, d.loads[0], fast),
        ("B, both directions", 1.0, d.average, fast),
    ):
        yield title, share * d.total, load, 3, speed, False


def _of_nch(d, project):
    design, period = d.own["design"], d.own["T_D"]
    yield "wind", math.nan, d.average, 20, math.nan, False
    steps = [("0.25 D_D", 0.25 * design, period), ("0.5 D_D", 0.5 * design, period)]
    steps += [("D_D", design, period), ("D_M", d.moved, d.own["period"])]
    yield from _steps(d, steps)
    speed = _harmonic(d, d.total)
    yield "maximum displacement, D_TM", d.total, d.average, 3, speed, False
    many = d.own["D_TD"]
    given = project.file["spectrum"]
    sa = [codes.spectrum("NCh2745", given, t) for t in (1.0, codes.SOIL[given["soil"]][3] - 1e-9)]
    factor = codes.damping_factor("NCh2745", d.own["beta_D"])
    count = max(10.0, 15.0 * 2.5 * sa[0] / sa[1] / factor)
    yield (
        "many cycles, D_TD",
        many,
        d.average,
        math.ceil(count),
        2.0 * math.pi * many / period,
        False,
    )
    yield "static, largest load, D_TM", d.total, d.loads[1], 1, d.slow, False
    yield "static, least load, D_TM", d.total, d.loads[0], 1, d.slow, False


def _produced(d, project):
    if project.code != "ASCE 7-22":  # which has a test of its own
        yield "each bearing produced", 0.67 * d.moved, d.average, 3, d.slow, False


def _of_all(d):
    b = d.b
    holds = b.L * b.inner - b.fast * b.R.sum()
    allowed = d.total * d.more
    slip = max(allowed - b.capacity, d.slip, 0.25 * min(b.overlap, max(holds, 0.0)))
    speed = d.impact
    if speed is None:
        beyond = allowed**2 - b.capacity**2
        speed = _harmonic(d, math.sqrt(beyond) if beyond > 0.0 else allowed)
    for word, load in (("largest", d.loads[1]), ("least", d.loads[0])):
        for pace, at in (("slow", d.slow), ("fast", speed)):
            yield f"interface alone, {word} load, {pace}", slip, load, 3, at, True
    for word, load in (("average", d.average), ("largest", d.loads[1])):
        yield f"impact and return, {word} load", b.capacity + slip, load, 3, speed, False
    yield "after the impacts", min(d.moved, 0.9 * b.capacity), d.average, 3, d.slow, False
