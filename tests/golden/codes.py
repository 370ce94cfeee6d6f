"""Spectra and equivalent-linear analyses of three codes, typed from their formulas.

ASCE 7-22 chapter 17, EN 1998-1 chapter 10, NCh2745. Bearings are pendulums below their rims:
F = P (D / L + mu), energy dissipated per cycle (EDC) 4 mu P D. SI units.
"""

import json
import math

import building
import numpy as np
from reading import GRAVITY as G

B_ASCE = ((2, 0.8), (5, 1.0), (10, 1.2), (20, 1.5), (30, 1.7), (40, 1.9), (50, 2.0))
B_NCH = (
    (2, 0.65),
    (5, 1.0),
    (10, 1.37),
    (15, 1.67),
    (20, 1.94),
    (25, 2.17),
    (30, 2.38),
    (50, 3.02),
)
GROUND = {  # S, T_B, T_C, T_D
    (1, "A"): (1.0, 0.15, 0.4, 2.0),
    (1, "B"): (1.2, 0.15, 0.5, 2.0),
    (1, "C"): (1.15, 0.20, 0.6, 2.0),
    (1, "D"): (1.35, 0.20, 0.8, 2.0),
    (1, "E"): (1.4, 0.15, 0.5, 2.0),
    (2, "A"): (1.0, 0.05, 0.25, 1.2),
    (2, "B"): (1.35, 0.05, 0.25, 1.2),
    (2, "C"): (1.5, 0.10, 0.25, 1.2),
    (2, "D"): (1.8, 0.10, 0.30, 1.2),
    (2, "E"): (1.6, 0.05, 0.25, 1.2),
}
SOIL = {  # A/g, T_a, T_b, T_c, T_d [s], alpha_A [cm/s2], alpha_V [cm/s], alpha_D [cm]
    "I": (0.40, 0.03, 0.110, 0.29, 2.51, 1085, 50, 20),
    "II": (0.41, 0.03, 0.200, 0.54, 2.00, 1100, 94, 30),
    "III": (0.45, 0.03, 0.375, 0.68, 1.58, 1212, 131, 33),
}
SOIL_433 = {"I": (0.9, 0.20, 1.0), "II": (1.0, 0.35, 1.33), "III": (1.2, 0.85, 1.8)}  # S, T', n
C_D = {"I": 0.200, "II": 0.300, "III": 0.330}  # m, times Z
ZONE = {1: 0.75, 2: 1.0, 3: 1.25}
M_M = 1.2


def between(table, percent):
    """Return a factor of a table of damping, linear between its values."""
    return float(np.interp(percent, *zip(*table, strict=True)))


def damping_factor(code, damping):
    """Return B (1 / eta of EN 1998)."""
    if code == "EN 1998":
        return 1.0 / max(math.sqrt(10.0 / (5.0 + 100.0 * damping)), 0.55)
    return between(B_ASCE if code == "ASCE 7-22" else B_NCH, 100.0 * damping)


def spectrum(code, given, period, damping=0.05):
    """Return the pseudo-acceleration [m/s2] at one period."""
    b = damping_factor(code, damping)
    if code == "ASCE 7-22":
        ms, m1, long = given["s_ms"], given["s_m1"], given.get("t_l", 8.0)
        corner = m1 / ms
        if period < 0.2 * corner:
            sa = ms * (0.4 + 0.6 * period / (0.2 * corner))
        elif period <= corner:
            sa = ms
        else:
            sa = m1 / period if period <= long else m1 * long / period**2
        return G * sa / b
    if code == "EN 1998":
        s, t_b, t_c, t_d = GROUND[given.get("kind", 1), given["ground_type"]]
        top = given["a_g"] * given.get("importance", 1.0) * s
        if period < t_b:
            return top * (1.0 + period / t_b * (2.5 / b - 1.0))
        shape = 1.0 if period <= t_c else t_c / period if period <= t_d else t_c * t_d / period**2
        return top * 2.5 / b * shape
    a, t_a, t_b, t_c, t_d, top, speed, far = SOIL[given["soil"]]
    if period < t_a:
        sa = a * G
    elif period < t_b:
        sa = a * G + (0.01 * top - a * G) * (period - t_a) / (t_b - t_a)
    elif period < t_c:
        sa = 0.01 * top
    elif period < t_d:
        sa = 2.0 * math.pi * 0.01 * speed / period
    else:
        sa = 4.0 * math.pi**2 * 0.01 * far / period**2
    return ZONE[given["zone"]] * sa / b


def dead_shares(project):
    """Return the multiples of each average load in the maximum and minimum combination.

    Where no cases are known all is dead load. Loads of the bearings are nearly multiples of those
    on average where all floors carry alike. The least have dead load alone: each bearing's part of
    it is that of the combination of its reactions with the least loads.
    """
    totals = building.totals(project) or building.combined(project, (1.0, 0.0, 0.0))
    average = np.array([float(row["average load [N]"]) for row in project.table("bearings")])
    most, least = (totals[name] / totals["average"] for name in ("maximum", "minimum"))
    shares = [share * np.ones_like(average) for share in (most, least)]
    if (
        not building.totals(project)
        or not (project.results / "reaction-combinations.csv").is_file()
    ):
        return shares
    still = {}
    for row in project.table("reaction-combinations"):
        if (row["side"], row["force"]) == ("below", "N"):
            own = still.setdefault((row["level"], row["combination"]), {})
            own[row["bearing"]] = float(row["static"])
    lightest = min((list(own.values()) for own in still.values()), key=sum)
    shares[1] = totals["minimum"] * np.array(lightest) / sum(lightest) / average
    return shares


class System:
    """Bearings at one bound with what rests on them."""

    def __init__(self, project, bound):
        rows, statics = project.table("bearings"), project.governing
        self.P = np.array([float(row["average load [N]"]) for row in rows])
        self.x = np.array([float(row["x [m]"]) for row in rows])
        self.y = np.array([float(row["y [m]"]) for row in rows])
        self.names = [row["bearing"] for row in rows]
        own = G * statics["node_mass"][:, 0].sum()  # the mass that loads are
        self.W = own if building.totals(project) else self.P.sum()
        each = [project.devices[name] for name in project.types]
        self.L = np.array([b.L for b in each])
        self.capacity = np.array([b.capacity for b in each])
        self.slow = np.array([b.share(b.slow) for b in each]) * project.outer["lower"]
        share = np.array([b.share(b.fast) for b in each])
        self.mu, self.mu_nominal = share * project.outer[bound], share
        self.mu_upper = share * project.outer["upper"]
        place, mass = statics["node_position"], statics["node_mass"]
        self.b, self.d = np.ptp(place[:, :2], axis=0)
        self.centre = (
            (mass[:, 0] @ place[:, 0]) / mass[:, 0].sum(),
            (mass[:, 1] @ place[:, 1]) / mass[:, 1].sum(),
        )

    def force(self, moved, friction=None):
        """Return the lateral force of each bearing."""
        return self.P * (moved / self.L + (self.mu if friction is None else friction))

    def secant(self, moved):
        """Return effective stiffness, damping and period."""
        k = self.force(moved).sum() / moved
        beta = (4.0 * self.mu * self.P * moved).sum() / (2.0 * math.pi * k * moved**2)
        return k, beta, 2.0 * math.pi * math.sqrt(self.W / (k * G))

    def stiffness_centre(self, moved):
        """Return the centre of stiffness."""
        force = self.force(moved)
        return (force @ self.x) / force.sum(), (force @ self.y) / force.sum()


def settled(of, start):
    """Return the displacement that gives itself, by bisection on its logarithm."""
    low, high = 1e-6 * start, 1e2 * start
    for _ in range(200):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if of(middle) > middle else (low, middle)
    return math.sqrt(low * high)


def analysed(project, bound, above):
    """Return the equivalent-linear analysis at a bound as a mapping."""
    system = System(project, bound)
    found = {"ASCE 7-22": asce, "EN 1998": en, "NCh2745": nch}[project.code](
        system, project.file["spectrum"], above
    )
    return found | {"system": system, "restoring": restoring(system, found["centre"])}


def restoring(system, moved):
    """Return the force that the second half of a displacement adds, and its least value."""
    return (system.force(moved) - system.force(0.5 * moved)).sum(), 0.025 * system.W


def torsion(system, moved, least, ratio=1.0):
    """Return the total displacement of each bearing: 5 % of the longest side, 12 e / (b2 + d2)."""
    cx, cy = system.stiffness_centre(moved)
    side = 0.05 * max(system.b, system.d)
    ex, ey = abs(system.centre[0] - cx) + side, abs(system.centre[1] - cy) + side
    square = system.b**2 + system.d**2
    along = 1.0 + np.abs(system.y - cy) / ratio * 12.0 * ey / square
    across = 1.0 + np.abs(system.x - cx) / ratio * 12.0 * ex / square
    return moved * np.maximum(np.maximum(along, across), least)


def asce(s, given, above):
    """ASCE 7-22: 17.5."""

    def next_(moved):
        _, beta, period = s.secant(moved)
        return G * given["s_m1"] * period / (4.0 * math.pi**2 * damping_factor("ASCE 7-22", beta))

    moved = settled(next_, 0.3)
    k, beta, period = s.secant(moved)
    square = ((s.x - s.centre[0]) ** 2 + (s.y - s.centre[1]) ** 2).mean()
    ratio = max(math.sqrt(square) / math.sqrt((s.b**2 + s.d**2) / 12.0), 1.0)
    each = torsion(s, moved, 1.15, ratio**2)
    found = {
        "centre": moved,
        "each": each,
        "total": each.max(),
        "allowed": each.max(),
        "period": period,
        "damping": beta,
        "factor": damping_factor("ASCE 7-22", beta),
        "k": k,
        "V_b": k * moved,
        "k_02": s.force(0.2 * moved).sum() / (0.2 * moved),
    }
    if above is None:
        return found
    v_st = found["V_b"] * (above["W_s"] / s.W) ** (1.0 - 3.5 * beta)
    r_i = min(max(0.375 * above["R"], 1.0), 2.0)
    ds, d1, i_e = 2.0 / 3.0 * given["s_ms"], 2.0 / 3.0 * given["s_m1"], above["importance"]
    fixed = max(min(ds, d1 / period) * i_e / above["R"], 0.044 * ds * i_e, 0.01)
    s_1 = given.get("s_1", given["s_m1"])
    if s_1 >= 0.6:
        fixed = max(fixed, 0.5 * s_1 * i_e / above["R"])
    fixed *= above["W_s"]
    sliding = max(s.mu_upper @ s.P, 1.5 * s.mu_nominal @ s.P)
    prime = moved / math.sqrt(1.0 + (above["T_fb"] / period) ** 2)
    return found | {
        "V_s": max(v_st / r_i, fixed, above["wind"], sliding),
        "V_st": v_st,
        "R_I": r_i,
        "D_least": 0.8 * found["total"] * prime / moved,
        "V_least": 0.9 * found["V_b"],
    }


def en(s, given, above):
    """EN 1998-1: 10.9.2, with S_e of T_eff and xi_eff."""

    def next_(moved):
        k, xi, period = s.secant(moved)
        return s.W / G * spectrum("EN 1998", given, period, xi) / k

    moved = settled(next_, 0.2)
    k, xi, period = s.secant(moved)
    force = s.force(moved)
    cx, cy = s.stiffness_centre(moved)
    ex, ey = abs(s.centre[0] - cx) + 0.05 * s.b, abs(s.centre[1] - cy) + 0.05 * s.d
    radius = (force @ ((s.x - cx) ** 2 + (s.y - cy) ** 2)) / force.sum()
    more = np.maximum(ey / radius * np.abs(s.y - cy), ex / radius * np.abs(s.x - cx))
    each = moved * (1.0 + more)
    found = {
        "centre": moved,
        "each": each,
        "total": each.max(),
        "allowed": 1.2 * each.max(),
        "period": period,
        "damping": xi,
        "factor": 1.0 / damping_factor("EN 1998", xi),
        "k": k,
        "V_b": k * moved,
        "k_02": s.force(0.2 * moved).sum() / (0.2 * moved),
        "a_tot": max(ex / s.b, ey / s.d),
        "e_r": max(abs(s.centre[0] - cx), abs(s.centre[1] - cy)) / math.sqrt(radius),
        "r_l": math.sqrt(12.0 * radius / (s.b**2 + s.d**2)),
    }
    if above is not None:
        found["V_s"] = above["W_s"] / G * spectrum("EN 1998", given, period, xi) / 1.5
    return found


def nch(s, given, above):
    """NCh2745: 7.3 and 7.4; the upper bound's stiffness makes the shears."""
    far = C_D[given["soil"]] * ZONE[given["zone"]]

    def of(most):
        return lambda moved: most * far / damping_factor("NCh2745", s.secant(moved)[1])

    design, moved = settled(of(1.0), 0.1), settled(of(M_M), 0.1)
    k, beta, period = s.secant(moved)
    each = torsion(s, design, 1.1) / design * moved
    shear = s.force(design, s.mu_upper).sum()
    found = {
        "centre": design,
        "each": each,
        "total": each.max(),
        "allowed": each.max(),
        "moved": moved,
        "period": period,
        "damping": beta,
        "design": design,
        "factor": damping_factor("NCh2745", beta),
        "k": k,
        "V_b": shear,
        "T_D": s.secant(design)[2],
        "beta_D": s.secant(design)[1],
        "D_TD": torsion(s, design, 1.1).max(),
    }
    if above is not None:
        r_1 = max(min(above["R"], 2.0), 1.0)
        sliding = max(s.mu_upper @ s.P, 1.5 * s.mu_nominal @ s.P)
        s_433, t_433, n_433 = SOIL_433[given["soil"]]
        a_0 = {1: 0.2, 2: 0.3, 3: 0.4}[given["zone"]]
        falling = 2.75 * s_433 * a_0 / above["R"] * (t_433 / found["T_D"]) ** n_433
        fixed = max(falling, s_433 * a_0 / 6.0) * above["W_s"]
        found["V_s"] = max(shear / r_1, fixed, above["wind"], sliding)
    return found


def floor_weights(statics):
    """Return the weights of the floors' masses, each node's with the nearest level."""
    height, levels = statics["node_position"][:, 2], statics["level_height"]
    nearest = np.abs(height[:, None] - levels).argmin(axis=1)
    mass = np.array([statics["node_mass"][nearest == k, 0].sum() for k in range(len(levels))])
    return G * mass[1:]


def above_of(project):
    """Return what stands on the bearings: weights and heights of floors, fixed-base period."""
    given = project.file.get("superstructure")
    if given is None:
        return None
    weights, levels = floor_weights(project.governing), project.governing["level_height"]
    facts = json.loads(project.text("run.json"))  # of the base held: modes.csv has a fixed base
    period = facts["fixed_base_period"]
    return {
        "W_s": weights.sum(),
        "w": weights,
        "h": levels[1:] - levels[0],
        "R": given.get("R"),
        "importance": given.get("importance", 1.0),
        "wind": given.get("wind_shear", 0.0),
        "T_fb": period,
    }


def overturning_moment(project, e, above):
    """Return the moment of unreduced forces: V_st by C_vx, S_e, or the largest k D_M."""
    s, w, h = e["system"], above["w"], above["h"]
    if project.code == "ASCE 7-22":
        share = w * h ** (14.0 * e["damping"] * above["T_fb"])
        return e["V_st"] * (share @ h) / share.sum()
    if project.code == "EN 1998":
        given = project.file["spectrum"]
        return (w @ h) / G * spectrum("EN 1998", given, e["period"], e["damping"])
    return (w @ h**2) / (w @ h) * s.force(e["moved"], s.mu_upper).sum()


def overturning(project, e, above, full=1.0, part=0.3):
    """Return axial loads of the bearings from unreduced forces on a rigid base, 100 and 30 %."""
    s, moment = e["system"], overturning_moment(project, e, above)
    x, y = np.abs(s.x - s.x.mean()), np.abs(s.y - s.y.mean())
    one, two = moment * x / (x**2).sum(), moment * y / (y**2).sum()
    return np.maximum(full * one + part * two, part * one + full * two)


COLUMNS = {
    "total_displacement [m]": "total",
    "period [s]": "period",
    "damping [-]": "damping",
    "damping_factor [-]": "factor",
    "stiffness [N/m]": "k",
    "base_shear [N]": "V_b",
    "superstructure_shear [N]": "V_s",
}


def stick_period(given):
    """Return the longest period of a chain of storeys on a held base, without torsion."""
    k, m = np.array(given["storey_stiffness"]), np.array(given["storey_mass"])
    matrix = np.diag(k + np.append(k[1:], 0.0)) - np.diag(k[1:], 1) - np.diag(k[1:], -1)
    values = np.linalg.eigvals(matrix / m[:, None])
    return 2.0 * math.pi / math.sqrt(values.real.min())


def compare(project, tally):
    """Hold the table of the equivalent-linear analysis against the formulas."""
    name = "equivalent-linear analysis"
    tally.category(name, 1e-8, "loads of sixteen digits, displacement found to 1e-12")
    above = above_of(project)
    found = {}
    for row in project.table("equivalent-linear"):
        bound = row[""]
        own = found[bound] = analysed(project, bound, above)
        moved = own.get("moved", own["centre"])
        tally.same(name, f"{bound} displacement", row["displacement [m]"], moved)
        if project.code == "EN 1998":
            allowed = row["allowed_displacement [m]"]
            tally.same(name, f"{bound} allowed displacement", allowed, own["allowed"])
        for column, key in COLUMNS.items():
            if row[column] != "" or key in own:
                tally.same(name, f"{bound} {column}", row[column] or np.nan, own[key])
    structure = project.file["structure"]
    plain = structure["kind"] == "shear building" and not any(structure.get("eccentricity", [0]))
    if plain and above is not None and above["T_fb"] is not None:
        stick = "fixed-base period of a stick"
        tally.category(stick, 1e-5, "the model holds its base by stiff springs")
        tally.same(stick, "T_fb", above["T_fb"], stick_period(structure))
    return found
