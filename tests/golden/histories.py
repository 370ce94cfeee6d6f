"""Peaks of every run from its histories, by the definitions of docs/results.md."""

import numpy as np

SAME_PLACE = 1e-3  # m
ROUND_OFF = 3e-7  # of single precision, some digits
LOADED = 0.5  # the same, below which a check leaves it aside
LOOSE = 0.01  # the same, below which sliders are loose
PRESSED = 0.05  # share of the load at rest below which a resultant's offset does not count


def peaks(data, statics):
    """Return what each run reached, by name as the package has it, (n_runs, ...)."""
    ways = data.get("mass_shift", [""] * len(data["run"]))
    rows = [of_run(one(data, k), of_way(statics, way)) for k, way in enumerate(ways)]
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


ACCIDENTAL = 0.05  # of the plan's sides


def of_way(statics, way):
    """Return statics with the masses of each floor moved in plan, "+x", as their nodes have them.

    A mass m at s becomes m (1 + a (s - s_c)), with a = c M / sum(m (s - s_c)^2): the sum stays, and
    the centre s_c moves by c. A node of no level, as of a slab's mesh, is of the floor nearest.
    """
    if not way:
        return statics
    axis, sign = "xy".index(way[1]), float(f"{way[0]}1")
    mass, place = statics["node_mass"].copy(), statics["node_position"][:, axis]
    apart = np.abs(statics["node_position"][:, 2:] - statics["level_height"])
    nearest = np.where(statics["level_node"] >= 0, statics["level_node"], apart.argmin(1))
    for k in range(len(statics["level_height"])):
        on = np.flatnonzero(nearest == k)
        for direction in (0, 1):
            m, s = statics["node_mass"][on, direction], place[on]
            arm = s - m @ s / m.sum()
            moved = sign * ACCIDENTAL * np.ptp(s) * m.sum()
            mass[on, direction] = m * (1.0 + moved * arm / (m @ arm**2))
    return {**statics, "node_mass": mass}


def one(data, k):
    """Return the histories of a run, without what fills it up."""
    time = data["time"]
    time = time if time.ndim == 1 else time[k]
    force = data["axial_force"][k]
    until = int(np.isfinite(force).all(axis=-1).sum())  # a run that ended early is filled by NaN
    found = {"time": time[:until]}
    for name in (
        "axial_force",
        "bearing_displacement",
        "bearing_force",
        "interface_slip",
        "interface_slip_size",
        "interface_eccentricity",
        "rim_force",
        "slider_displacement",
        "node_displacement",
        "node_acceleration",
        "base_shear",
        "storey_shear",
        "energy",
        "ground_acceleration",
    ):
        found[name] = data[name][k][:until]
    return found


def plan(values):
    """Return sizes in plan of vectors."""
    return np.sqrt(values[..., 0] ** 2 + values[..., 1] ** 2)


def of_run(run, statics):
    """Return what one run reached."""
    time, force = run["time"], run["axial_force"]
    moved, slip = plan(run["bearing_displacement"]), run["interface_slip_size"]
    lifted = force <= 0.0
    begins = lifted.copy()
    begins[1:] &= ~lifted[:-1]
    steps = np.diff(time, prepend=time[0])
    offset = run["interface_eccentricity"] / statics["slider_radius"]
    pressed = force > PRESSED * statics["static_axial_force"]
    loaded = force > LOADED * statics["static_axial_force"]
    loose = force <= LOOSE * statics["static_axial_force"]
    means, drifts, lines = floors(run, statics)
    kinetic = run["energy"]
    found = {
        "displacement": moved.max(0),
        "displacement_left": moved[-1],
        "displacement_along": np.abs(run["bearing_displacement"]).max((0, 1)),
        "force": plan(run["bearing_force"]).max(0),
        "axial_force": force.max(0),
        "axial_tension": -force.min(0),
        "slip": slip.max(0),
        "slip_left": slip[-1],
        "sliding": plan(run["slider_displacement"]).max(0),
        "rim_force": run["rim_force"].max((0, 2)),
        "rims_met": (run["rim_force"] > 0.0).any((0, 2)).astype(float),
        "eccentricity": np.where(pressed, offset, 0.0).max(0),
        "eccentricity_loaded": np.where(loaded, offset, 0.0).max(0),
        "slip_loose": (np.diff(slip, axis=0, prepend=slip[:1]) * loose).sum(0),
        "time_lifted": (steps[:, None] * lifted).sum(0),
        "uplifts": float(begins.sum()),
        "gap": gaps(run, statics, lifted).max(0),
        "base_shear": plan(run["base_shear"]).max(),
        "storey_shear": plan(run["storey_shear"]).max(0),
        "floor_plan": plan(means).max(0),
        "drift": drifts.max(0),
        "line_drift": lines.max(0),
        "energy_input": np.abs(kinetic[:, 0]).max(),
        "energy_gap": np.abs(kinetic[:, 0] - kinetic[:, 1:].sum(1)).max(),
        "until": time[-1],
    }
    timed = {"displacement": moved, "base_shear": plan(run["base_shear"]), "axial_force": force}
    found |= {f"{name}_at": time[values.argmax(0)] for name, values in timed.items()}
    return found | {f"{name}_equal": equal(values, time) for name, values in timed.items()}


def equal(values, time):
    """Return first and last time at which a history is as large as its peak, (2, ...)."""
    high = values >= values.max(0) * (1.0 - ROUND_OFF)
    first, last = high.argmax(0), len(time) - 1 - high[::-1].argmax(0)
    return np.array([time[first], time[last]])


def floors(run, statics):
    """Return accelerations of levels by mass, drifts of storeys, and drifts of lines.

    A storey drifts by the mean of its columns: places in plan at which both of its levels have a
    node. Rigid floors move the place below a node that stands over none.
    """
    level, mass = statics["level_node"], statics["node_mass"]
    place, heights = statics["node_position"], statics["level_height"]
    moves, pushed = run["node_displacement"], run["node_acceleration"]
    means, drifts, lines = [], [], []
    for k in range(len(heights)):
        on = level == k
        share = mass[on, :2] / mass[on, :2].sum(0) if mass[on, 0].sum() > 0.0 else 1.0 / on.sum()
        means.append((pushed[:, on, :2] * share).sum(1))
    for k in range(1, len(heights)):
        low, columns, apart = np.flatnonzero(level == k - 1), [], []
        for up in np.flatnonzero(level == k):
            from_low = place[up, :2] - place[low, :2]
            apart.append(np.hypot(*from_low.T).min())
            under = np.hypot(*from_low.T).argmin()
            below, (dx, dy) = moves[:, low[under]], from_low[under]
            turned = below[:, 5:] * np.array([-dy, dx])
            columns.append(
                (moves[:, up, :2] - below[:, :2] - turned) / (heights[k] - heights[k - 1])
            )
        stands = np.array(apart) < SAME_PLACE
        chosen = [c for c, on in zip(columns, stands, strict=True) if on or not stands.any()]
        drifts.append(plan(np.mean(chosen, axis=0)))
        lines += [plan(column) for column in chosen]
    return np.stack(means, 1), np.array(drifts).T, np.array(lines).T


def gaps(run, statics, lifted):
    """Return how far bearings are open.

    From the place of the upper sphere's centre over the lower one: each centre lies on its plate's
    axis, which turns with its node (a small rotation tilts it by (r_y, -r_x)).
    """
    ends, lever = statics["bearing_node"], statics["lever"]
    turns = run["node_displacement"][..., 3:5]
    across = run["bearing_displacement"][..., :2].copy()
    for end, sign in ((0, -1.0), (1, -1.0)):  # C2 - C1 = (x_j - l_2 e_j) - (x_i + l_1 e_i)
        turn = turns[:, ends[:, end]]
        across[..., 0] += sign * lever[:, end] * turn[..., 1]
        across[..., 1] -= sign * lever[:, end] * turn[..., 0]
    down = statics["length"] - run["bearing_displacement"][..., 2]
    square = (across**2).sum(-1) + down**2
    closed = np.sqrt(np.maximum(square - run["interface_slip_size"] ** 2, 0.0))
    return np.where(lifted, np.maximum(statics["length"] - closed, 0.0), 0.0)


COMPARED = (
    "displacement",
    "displacement_left",
    "displacement_along",
    "force",
    "axial_force",
    "axial_tension",
    "slip",
    "slip_left",
    "sliding",
    "rim_force",
    "rims_met",
    "eccentricity",
    "eccentricity_loaded",
    "slip_loose",
    "time_lifted",
    "uplifts",
    "gap",
    "base_shear",
    "storey_shear",
    "floor_plan",
    "drift",
    "line_drift",
    "energy_input",
    "until",
    "displacement_at",
    "base_shear_at",
    "axial_force_at",
)


def compare(project, runs, tally):
    """Hold what runs reached against their histories; return the peaks by level and bound."""
    name, small = "peaks of all runs, from histories", "drifts and gaps of all runs, from histories"
    tally.category(name, 1e-6, "histories are kept in single precision, 6e-8 of each value")
    tally.category(small, 1e-4, "differences of such: 1e-8 m of 0.3 m, over drifts of 3 mm")
    times = "times of peaks"
    tally.category(times, 1e-2, "in single precision two steps near a peak may be equal")
    balance = "base shear, as the sum of the bearings"
    tally.category(balance, 1e-4, "sums of single precision, of forces that cancel")
    floor = {
        "gap": 1e-3,
        "drift": 2e-3,
        "line_drift": 2e-3,
        "slip": 1e-3,
        "slip_left": 1e-3,
        "slip_loose": 3e-2,
        "displacement_left": 1e-2,
        "eccentricity": 1e-2,
        "eccentricity_loaded": 1e-2,
        "axial_tension": 1e4,
    }
    found = {}
    for level, each in runs.items():
        for bound, data in each.items():
            own = found[level, bound] = peaks(data, project.governing)
            for quantity in COMPARED:
                reported = data[f"peak_{quantity}"].copy()
                beyond(data, quantity, reported, own[quantity], tally)
                if quantity.endswith("_at"):  # of equal steps the one that was reported
                    first, last = np.moveaxis(own[quantity.replace("_at", "_equal")], 1, 0)
                    own[quantity] = np.clip(reported, first, last)
                of = small if quantity in {"gap", "drift", "line_drift"} else name
                of = times if quantity.endswith("_at") else of
                tally.same(
                    of,
                    f"{level} {bound} {quantity}",
                    reported,
                    own[quantity],
                    floor.get(quantity, 0.0),
                )
            total = np.nansum(data["bearing_force"], axis=2)
            size = np.nanmax(np.abs(data["base_shear"]))
            off = np.nanmax(np.abs(total - np.nan_to_num(data["base_shear"])))
            tally.same(balance, f"{level} {bound}", 1.0, 1.0 + off / size)
    return found


def beyond(data, quantity, reported, own, tally):
    """Take the step that ended a run, which is in no history, from what was reached."""
    kind = {"slip": "slip_exceeded", "rim_force": "rim_overrun"}.get(quantity)
    if kind is None:
        return
    names = list(map(str, data["bearing"]))
    for k, status in enumerate(data["status"]):
        where = str(data["failed_where"][k])
        if status == kind:
            b = next(i for i, n in enumerate(names) if f'"{n}"' in where or n == where)
            if reported[k, b] > own[k, b]:
                own[k, b] = reported[k, b]
