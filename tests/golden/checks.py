"""Demand, limit, ratio and verdict of every check, from what was found of histories and codes."""

import math

import codes
import demands
import forces
import motions
import numpy as np

DRIFT = {"ASCE 7-22": 0.020, "EN 1998": 0.005, "NCh2745": 0.003}
STABILITY = {"ASCE 7-22": (0.10, 0.25), "EN 1998": (0.10, 0.30)}
LEAST_MOTIONS = {"ASCE 7-22": 7, "EN 1998": 3, "NCh2745": 3}
RIMS_FROM = {"ASCE 7-22": 0.60, "EN 1998": 1.0, "NCh2745": 1.0}
OWN = "no code: limit of the project"


class Device:
    """The bearing at a bound, or with bounds of both kinds where `bound` is None."""

    def __init__(self, project, bound=None, kind="standard"):
        b = project.devices[kind]
        up, low = (bound, bound) if bound else ("upper", "lower")
        self.b = b
        self.fast, self.slow = b.fast * project.outer[up], b.slow * project.outer[low]
        self.inner = b.inner * project.inner[low]
        self.inner_up = b.inner * project.inner[up]
        self.share = b.share(self.fast)
        self.holds = b.L * self.inner - self.fast * b.R.sum()
        self.most = max(min(b.overlap, self.holds), 0.0)

    def overlap_pressure(self, load, slip):
        """Return a load over the overlap of two circles of the slider's radius."""
        return load / lens(self.b.a, slip) if slip < 2.0 * self.b.a else math.inf

    def liner_pressure(self, k, load, slip):
        """Return a load over the part of a liner that is centred on its resultant."""
        off = 2.0 * abs(self.b.R[k] * (slip / self.b.L + self.share - self.fast))
        return self.overlap_pressure(load, off)

    def rim_height(self):
        """Return half of the height that has place for rims between the plates."""
        b, free = self.b, []
        heights = b.low, b.h - b.low
        between = b.h
        for k in (0, 1):
            r, d = b.R[k], b.rim[k]
            # the rim stands where the slider's edge is when it is tilted by asin(d / R)
            face = r * math.sin(math.asin(d / r) + math.asin(b.a / r))
            between -= r - math.sqrt(r**2 - face**2)
            free.append(heights[k] - (r - math.sqrt(r**2 - b.a**2)))
        return 0.5 * max(min(between / 2.0, *free), 0.0)


def lens(a, s):
    """Return the area that two circles of radius a share, their centres s apart."""
    half = math.acos(s / (2.0 * a))
    return a * a * (2.0 * half - math.sin(2.0 * half))


class Found:
    """Demands and limits of one row of the table of checks."""

    def __init__(self, project, row):
        self.p, self.row = project, row
        self.bound, self.level = row["bound"], row["level"]
        self.subject = row["subject"]
        self.limits, self.code = project.limits, project.code
        level = self.level if project.code == "NCh2745" else ""
        each = project.suites.get(level, {})
        self.suite = each.get(self.bound)
        self.each = each
        self.linear = project.linear.get(self.bound)
        part, _, rest = self.subject.partition(", ")
        self.kind = part.removeprefix("type ") if part.startswith("type ") else "standard"
        if part.startswith("type "):
            self.subject = rest
        self.ds = [Device(project, self.bound or None, kind) for kind in project.types]
        self.b = project.devices[self.kind]
        self.tests = project.tests.get(self.kind)
        self.whole = Device(project, None, self.kind)
        self.own = row["clause"] == OWN

    def worst(self, values, limits=None):
        """Return demand and limit of the largest ratio."""
        values = np.atleast_1d(np.asarray(values, float))
        limits = np.broadcast_to(limits, values.shape)
        k = int(np.argmax(values / limits))
        return float(values[k]), float(limits[k])

    def slips(self):
        """Return the slip of each bearing that counts."""
        slip = self.suite.design("slip")
        if self.code == "EN 1998":
            rims = np.array([d.b.capacity for d in self.ds])
            slip = np.maximum(slip, 1.2 * self.suite.design("displacement") - rims)
        return slip

    def of_each(self, of):
        """Return a number of each bearing."""
        return np.array([of(device) for device in self.ds])

    def least(self, key):
        """Return a least value of the equivalent-linear analysis of ASCE 7-22."""
        return (self.linear or {}).get(key, 0.0)

    def of(self, name, key):
        """Return what is reached, over a limit of the project by its name."""
        return self.worst(
            self.suite.design(name), self.limits.get(key, {"eccentricity": 0.8}.get(key))
        )

    def lifted(self, name):
        """Return a quantity of runs and bearings where these lift off."""
        return np.where(self.suite.every("time_lifted") > 0.0, self.suite.every(name), 0.0)


def restoring(f):
    """F of the second half of the displacement."""
    return f.linear["restoring"]


def interface(f):
    """The interface at its lower bound over the surfaces at their upper one."""
    each = [f.p.devices[kind] for kind in f.p.types]
    worst = max(each, key=lambda b: b.share(b.fast) / b.inner)
    return worst.inner * f.p.inner["lower"], worst.share(worst.fast) * f.p.outer["upper"]


def displacement(f):
    """Displacement against rims and slip."""
    return f.worst(allowed_of(f), f.of_each(lambda d: d.b.capacity + d.most))


def allowed_of(f):
    """Return the displacement that each bearing must allow by histories."""
    moved = f.suite.design("displacement") * (1.2 if f.code == "EN 1998" else 1.0)
    return np.maximum(moved, f.least("D_least"))


def engaged(f):
    """Where a rim is met, over the displacement of histories."""
    moved = allowed_of(f)
    k = int((moved / f.of_each(lambda d: d.b.capacity + d.most)).argmax())
    return f.ds[k].b.capacity / moved[k], share_of(f)


def share_of(f):
    """Return the share from which on rims may be met."""
    return f.limits["rim_engagement"] if f.own else RIMS_FROM[f.code]


def engaged_linear(f):
    """Where a rim is met, over the displacement of the equivalent-linear analysis."""
    return f.b.capacity / f.linear["allowed"], share_of(f)


def pressure(f):
    """Largest load over the overlap at the largest slip."""
    pairs = zip(f.ds, f.suite.design("axial_force"), f.slips(), strict=True)
    values = [d.overlap_pressure(n, s) for d, n, s in pairs]
    return f.worst(values, f.limits["interface_pressure"])


def liner(f):
    """Largest load over a liner around its resultant: of runs, or of the bearing alone."""
    if f.row["symbol"] == "p":
        pairs = list(zip(f.ds, f.suite.design("axial_force"), f.slips(), strict=True))
        values = [max(d.liner_pressure(k, n, s) for k in (0, 1)) for d, n, s in pairs]
        return f.worst(values, f.limits["liner_pressure"])
    k = ["bottom surface", "top surface"].index(f.subject)
    t = f.tests
    return f.whole.liner_pressure(k, t.loads[1], t.slip), f.limits["liner_pressure"]


def gap_over_rims(f):
    """Gap over the height of the rims; the worst run."""
    heights = f.of_each(Device.rim_height)
    return f.worst(f.lifted("gap").max(0), f.limits.get("rim_height", heights))


def landing(f):
    """Pressure of a landing: of the runs in which a bearing lifts off."""
    force, slip = f.suite.every("axial_force"), f.suite.every("slip")
    places = np.argwhere(f.suite.every("time_lifted") > 0.0)
    values = [f.ds[k].overlap_pressure(force[i, k], slip[i, k]) for i, k in places]
    return max(values), f.limits.get("interface_pressure", 90e6)


def landing_force(f):
    """Maximum axial force of runs in which a bearing lifts off."""
    return f.lifted("axial_force").max(), f.limits["axial_force"]


def drift(f):
    """Worst drift of storeys and lines, grown as the shears must."""
    more = forces.raised(f.linear, f.suite)[0]
    theta = max(f.suite.design("drift").max(), f.suite.design("line_drift").max())
    if f.code == "EN 1998" and not f.own:
        theta *= 0.5  # nu, of damage limitation
    return theta * more, f.limits["drift"] if f.own else DRIFT[f.code]


def torsion(f):
    """Largest line over the mean of its storey; above 1.4 the static procedure does not apply."""
    mean, line = f.suite.design("drift"), f.suite.design("line_drift")
    statics = f.p.governing
    level = dict(zip(map(str, statics["node"]), statics["level_node"], strict=True))
    storey = np.array([level[str(name)] for name in f.suite.data["line"]]) - 1
    return (line / mean[storey])[mean[storey] > 1e-6].max(), 1.4


def stability(f):
    """P-Delta coefficient of the worst storey; members have P-Delta in the analysis."""
    weights = codes.floor_weights(f.p.governing)
    above = weights[::-1].cumsum()[::-1]
    theta = above * f.suite.design("drift") / f.suite.design("storey_shear")
    stick = f.p.file["structure"]["kind"] == "shear building"
    without, there = STABILITY[f.code]
    return theta.max(), without if stick else there


def base_shear(f):
    """Mean or largest base shear, at least that of the equivalent-linear analysis."""
    return max(f.suite.design("base_shear")[0], f.least("V_least")), f.limits["base_shear"]


def storey_shear(f):
    """Shear of the lowest storey over R_I, to be at least V_s."""
    return f.suite.of("storey_shear")[0] / f.linear["R_I"], f.linear["V_s"]


def least_base_shear(f):
    """Shear at the base, to be at least that of the equivalent-linear analysis."""
    return f.suite.of("base_shear")[0], f.linear["V_least"]


def lifted_for(f):
    """Longest time of a bearing in a run that parts by more than counts as contact."""
    time, gap = f.suite.every("time_lifted"), f.suite.every("gap")
    return np.where(gap > f.suite.least_gap, time, 0.0).max(), 0.0


def holds(f):
    """What the interface carries until a rim is met, over what it holds."""
    load = f.tests.loads[f.subject == "N_max"]
    margin = f.limits.get("margin", 1.2)
    return load * f.whole.share, f.whole.inner * load / margin


def slips_before(f):
    """Rim force at which the interface slips, one rim alone or both."""
    b, w = f.b, f.whole
    tilt = math.sqrt(1.0 - (b.capacity / b.L) ** 2)
    moment = f.tests.loads[1] * (b.L * w.inner_up - w.slow * b.R.sum()) / tilt
    k = ["bottom rim", "top rim"].index(f.subject)
    if f.limits.get("rims_together", False):
        return moment * b.R[k] / (b.R**2).sum(), f.limits["rim_strength"]
    return moment / b.R[k], f.limits["rim_strength"]


def resultant(f):
    """Offset of the resultant between the sliders: no restrainer contact, then each alone."""
    b, w, s = f.b, f.whole, f.tests.slip
    levers = b.R[0] - b.low, b.R[1] - (b.h - b.low)
    free = levers[0] * (s / b.L + w.share) - b.R[0] * w.fast
    bottom = levers[1] * w.inner_up - w.slow * b.R[1]
    top = levers[0] * w.inner_up - w.slow * b.R[0]
    most = max(map(abs, (free, free - s, bottom - s, top - s, bottom, top)))
    return most / b.a, f.limits.get("eccentricity", 0.8)


def lateral(f):
    """Lateral force at which the interface slips at the rim's tilt."""
    b = f.b
    if f.row["symbol"] == "H":
        return f.of("force", "lateral_force")
    tilt = b.capacity / b.L
    across = tilt + f.whole.inner_up * math.sqrt(1.0 - tilt**2)
    return f.tests.loads[1] * across, f.limits["lateral_force"]


def on_overlap(f):
    """Pressure on the sliders' overlap: of runs, or of the bearing alone."""
    if f.row["symbol"] == "p":
        return pressure(f)
    t = f.tests
    return f.whole.overlap_pressure(t.loads[1], t.slip), f.limits["interface_pressure"]


def recentring_energy(f):
    """E_S over E_H of the worst bearing, EN 15129."""
    s, d = f.linear["system"], f.linear["centre"]
    k = s.names.index(f.subject)
    return s.P[k] * d**2 / (2.0 * s.L[k]), 0.25 * s.P[k] * s.mu[k] * d


def recentring(f):
    """Displacement over half of the largest residual one, EN 1998-2."""
    s = f.linear["system"]
    return f.linear["centre"], (0.5 * s.mu * s.L).max()


def overturning(f):
    """Moment of unreduced forces, and of the weight about the nearest outer bearings."""
    import codes

    s = f.linear["system"]
    moment = codes.overturning_moment(f.p, f.linear, codes.above_of(f.p))
    x = min(s.centre[0] - s.x.min(), s.x.max() - s.centre[0])
    y = min(s.centre[1] - s.y.min(), s.y.max() - s.centre[1])
    return moment, s.W * min(x, y)


def wind(f):
    """Wind against the friction of low speed at its lower bound."""
    s = next(iter(f.p.linear.values()))["system"]
    return f.p.file["superstructure"]["wind_shear"], s.slow @ s.P


def service(f):
    """Displacement in service against the first rim that is met."""
    s = next(iter(f.p.linear.values()))["system"]
    return f.p.file["superstructure"]["service_displacement"], s.capacity.min()


def moat_linear(f):
    """Displacement that bearings must allow against the clear distance."""
    return f.linear["allowed"], f.limits["moat_gap"]


def moat(f):
    """Displacement of the histories with the code's factor against the clear distance."""
    factor = 1.2 if f.code == "EN 1998" else 1.0
    return factor * f.suite.design("displacement").max(), f.limits["moat_gap"]


RULES = {
    "overturning of the whole structure": overturning,
    "sliding under wind": wind,
    "no restrainer contact in service": service,
    "clearance to the moat wall, equivalent-linear": moat_linear,
    "clearance to the moat wall": moat,
    "moat wall is not met in any run": lambda f: (
        f.suite.every("displacement").max(),
        f.limits["moat_gap"],
    ),
    "runs with moved masses that failed": lambda f: (f.suite.moved_failed.sum(), 0.0),
    "restoring force": restoring,
    "interface holds before the rim": interface,
    "pairs of motions": motions.pairs,
    "mean spectrum of the motions": motions.mean,
    "mean spectrum of the motions at the period 0": motions.mean_at_zero,
    "near-fault pairs that are not turned to the fault": motions.turned,
    "number of motions": lambda f: (len(f.suite.failed), LEAST_MOTIONS[f.code]),
    "runs that failed": lambda f: (f.suite.failed.sum(), 0.0),
    "isolator displacement": displacement,
    "slip over the overlap": lambda f: f.worst(f.slips(), f.of_each(lambda d: d.b.overlap)),
    "slip over its stable limit s*": lambda f: f.worst(f.slips(), f.of_each(lambda d: d.holds)),
    "residual slip": lambda f: f.worst(
        f.suite.design("slip_left"), f.limits.get("slip_left", f.of_each(lambda d: d.holds))
    ),
    "rim force": lambda f: f.of("rim_force", "rim_strength"),
    "normalised eccentricity e/a": lambda f: f.of("eccentricity_loaded", "eccentricity"),
    "lateral force of a bearing": lateral,
    "lateral force that the bearing passes on": lateral,
    "residual displacement": lambda f: f.of("displacement_left", "displacement_left"),
    "maximum axial force": lambda f: f.of("axial_force", "axial_force"),
    "pressure on the sliders' overlap": on_overlap,
    "pressure on the liner around its resultant": liner,
    "maximum uplift over the rim height": gap_over_rims,
    "maximum uplift": lambda f: f.worst(f.lifted("gap").max(0), f.limits["uplift_gap"]),
    "pressure of a landing on the sliders": landing,
    "axial force with a landing": landing_force,
    "base shear": base_shear,
    "base shear of time histories": least_base_shear,
    "storey shear of time histories": storey_shear,
    "storey drift ratio": drift,
    "largest over mean drift of a storey": torsion,
    "P-Delta coefficient of a storey": stability,
    "floor acceleration in plan": lambda f: f.of("floor_plan", "floor_acceleration"),
    "interface holds until a rim is met": holds,
    "stable limit of interface slip": lambda f: (f.tests.slip, f.whole.holds),
    "interface slips before the rim breaks": slips_before,
    "normalised eccentricity e/a at the rims": resultant,
    "recentring, energy": recentring_energy,
    "recentring, displacement": recentring,
}
SUITE = {
    "overturning of the whole structure",
    "sliding under wind",
    "no restrainer contact in service",
    "clearance to the moat wall, equivalent-linear",
    "moat wall is not met in any run",
    "runs with moved masses that failed",
    "restoring force",
    "interface holds before the rim",
    "number of motions",
    "runs that failed",
    "recentring, energy",
    "recentring, displacement",
}
OF_RUN = {
    "maximum uplift over the rim height",
    "maximum uplift",
    "axial force with a landing",
    "pressure of a landing on the sliders",
}

OF_BEARING = {
    "interface holds until a rim is met",
    "stable limit of interface slip",
    "interface slips before the rim breaks",
    "normalised eccentricity e/a at the rims",
    "lateral force that the bearing passes on",
    "lateral force of a bearing",
    "pressure on the sliders' overlap",
    "pressure on the liner around its resultant",
}


def rule_of(title):
    """Return how a check's demand and limit are found."""
    if title in RULES:
        return RULES[title]
    if title.startswith("displacement where a rim engages"):
        return engaged if title.endswith("of histories") else engaged_linear
    return lifted_for if title.startswith("uplift duration above") else None


def ratio_of(demand, limit, relation):
    """Return the utilisation: what must be smaller over the other."""
    below, above = (demand, limit) if relation == "<=" else (limit, demand)
    if above > 0.0:
        return max(below / above, 0.0)
    if above < 0.0:
        return above / below if below < 0.0 else math.inf
    return 0.0 if below <= 0.0 else math.inf


def compare(project, tally):
    """Hold every row of the table of checks against what is found."""
    name, verdicts = "demands and limits of checks", "ratios and verdicts of checks"
    spectra = "mean spectra of motions"
    tally.category(name, 3e-4, "peaks in single precision")
    loads = "loads of combinations in checks"
    tally.category(loads, 2e-3, demands.MULTIPLES)
    tally.category(spectra, 4e-3, "a peak between samples: 40 points of a period miss 0.3 %")
    tally.category(verdicts, 1e-9, "quotients of the table's own numbers")
    hidden = demands.unknown_loads(project)
    failed = 0
    for row in project.table("checks"):
        title = row["title"].partition(": not evaluated")[0]
        label = f"{row['title']} {row['subject']} {row['bound']} {row['level']}"
        found, rule = Found(project, row), rule_of(title)
        demand, limit = float(row["demand"]), float(row["limit"])
        if rule is None:
            tally.unknown(name, label)
            continue
        own, allowed = rule(found)
        missing = row["title"].endswith(": not evaluated")
        own = math.inf if missing and row["relation"] == "<=" else own
        of = spectra if "spectrum" in title else name
        of = loads if found.suite is None and title in OF_BEARING else of
        tally.same(of, f"{label} demand", demand, own, demands.floor_of(row["symbol"]))
        if not (missing and hidden and title.startswith("interface holds")):
            tally.same(of, f"{label} limit", limit, allowed)
        void = _void(found, title)
        tally.words(verdicts, f"{label} void", bool(row["void"]), void)
        ratio = math.inf if void else ratio_of(demand, limit, row["relation"])
        tally.same(verdicts, f"{label} ratio", row["ratio"], ratio)
        # without a rule of the code, rims met early are to be agreed
        no_rule = title.startswith("displacement where a rim") and not found.own
        no_rule = no_rule and RIMS_FROM[project.code] >= 1.0
        beyond = "needs agreement" if no_rule else "FAILS"
        if void and not no_rule:
            beyond = "no value"
        elif title.startswith("largest over mean drift"):
            beyond = "does not apply"  # a limit of the static procedure
        elif title.endswith("shear of time histories"):
            beyond = "raised"  # less is the shear to design for
        word = "ok" if ratio <= 1.0 + 1e-9 else beyond
        tally.words(verdicts, f"{label} verdict", row["verdict"], word)
        tally.words(verdicts, f"{label} passed", row["passed"], word == "ok")
        failed += word in {"FAILS", "no value"}
    _facts(project, failed, tally, verdicts)


def _void(found, title):
    if found.suite is None and title in OF_BEARING:  # at what the runs of all bounds reached
        return any(suite.void for suite in found.each.values())
    if found.suite is None or title in SUITE or found.row["symbol"] in {"eta", "n"}:
        return False
    if title in OF_RUN or title.startswith("uplift duration"):
        moved = found.suite.moved is not None and found.suite.moved_stopped.any()
        return bool(found.suite.stopped.any() or moved)
    return found.suite.void


def _facts(project, failed, tally, name):
    import json

    facts = json.loads(project.text("run.json"))
    tally.same(name, "number of checks", facts["checks"], len(project.table("checks")))
    tally.same(name, "number that fail", len(facts["failed"]), failed)
    tally.words(name, "passed", facts["passed"], failed == 0)
    largest = max(
        (peaks["displacement"].max(), level, bound, k)
        for (level, bound), peaks in project.peaks.items()
        for k in [int(peaks["displacement"].max(1).argmax())]
    )
    motion = project.runs[largest[1]][largest[2]]["motion"][largest[3]]
    level = largest[1] or ("MCE_R" if project.code == "ASCE 7-22" else "design")
    status = project.runs[largest[1]][largest[2]]["status"][largest[3]]
    ended = "" if status == "ok" else ", failed"
    case = f"{motion}, {largest[2]} bound, {level} level{ended}"
    tally.words(name, "governing case", facts["governing_case"], case)
