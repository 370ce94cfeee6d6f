"""Forces under bearings, of storeys and of members: their tables, from histories of bearings."""

import building
import codes
import motions
import numpy as np

MEAN_FROM = 7
AXES = ("Vx", "Vy", "Fz", "Mx", "My", "Mz")
EXTREMES = {"max": 1.0, "min": -1.0}


def compare(project, tally):
    """Hold the tables of forces against the histories."""
    name, summed = "reactions of bearings, from histories", "storey forces, from histories"
    tally.category(name, 2e-5, "single precision, over the largest of the bearing")
    tally.category(summed, 1e-4, "sums of single precision, of forces that cancel")
    tally.category("drifts of storeys", 1e-4, "as those of all runs")
    tally.category("forces of groups of members", 1e-6, "the same numbers in another table")
    rows = {}
    for row in project.table("reactions"):
        key = _level(project, row), row["bound"]
        rows.setdefault(key, {}).setdefault((row["bearing"], row["side"]), []).append(row)
    for key, each in rows.items():
        _reactions(project, key, each, tally)
    rows = {}
    for row in project.table("storeys"):
        key = _level(project, row), row["bound"]
        rows.setdefault(key, {}).setdefault(row["storey"], []).append(row)
    for key, each in rows.items():
        _storeys(project, key, each, tally)
    kinds = {"reaction": ("reactions", ("bearing", "side"))}
    if (project.results / "members.csv").is_file():
        _groups(project, tally)
        kinds["member"] = ("members", ("member", "station"))
    if (project.results / "reaction-combinations.csv").is_file():
        for kind, (of, keys) in kinds.items():
            _combined(project, kind, project.table(of), keys, tally)
        _uplift(project, tally)


def _combined(project, kind, runs, keys, tally):
    """Hold permanent loads plus earthquake against the forces of the runs, row by row."""
    name = f"{kind}s by combination"
    tally.category(name, 1e-6, "thousandths of a newton, over 10 kN")
    own = {}
    for row in runs:
        place = row["level"], row["bound"], *(row[key] for key in keys)
        own.setdefault(place, {})[row["force"], row["extreme"]] = row
    rows, still = project.table(f"{kind}-combinations"), {}
    for row in rows:  # what a combination changes is the same at all bounds
        at = [row[key] for key in keys]
        ran = own[row["level"], row["bound"], *at][row["force"], row["extreme"]]
        change = float(row["static"]) - float(ran["permanent"])
        still.setdefault((row["level"], row["combination"], *at), {})[row["force"]] = change
    for row in rows:
        at = [row[key] for key in keys]
        section = own[row["level"], row["bound"], *at]
        ran = section[row["force"], row["extreme"]]
        rest = {force: float(each["permanent"]) for (force, _), each in section.items()}
        permanent, single = float(ran["permanent"]), float(ran["single"])
        quake = float(ran["value"]) - permanent
        alike = abs(single - permanent) <= 1e-9 * abs(quake)
        factor = 1.0 if alike else quake / (single - permanent)
        over = row["combination"].partition("E / ")[2]
        factor /= float(over) if over else 1.0
        change = still[row["level"], row["combination"], *at]
        shaken = {f: factor * (float(ran[f"{f} then"]) - rest[f]) for f in rest}
        acting, grown = {f: rest[f] + change[f] + shaken[f] for f in rest}, 1.0
        if kind == "reaction":
            grown = max(acting["N"] / max(rest["N"] + shaken["N"], 0.05 * rest["N"]), 1.0)
        label = f"{row['combination']} {' '.join(at)} {row['force']} {row['extreme']}"
        for f, value in acting.items():
            value *= 1.0 if f == "N" else grown
            tally.same(name, f"{label}: {f} then", row[f"{f} then"], value, 1e4 * grown)
        own_value = acting[row["force"]] * (1.0 if row["force"] == "N" else grown)
        tally.same(name, label, row["value"], own_value, 1e4 * grown)
        tally.words(name, f"{label} governs", ran["governs"], "yes")
    if kind == "member":
        levels = {row["level"] for row in rows}
        tally.words(name, "level", levels, {"design"} if project.code == "NCh2745" else levels)
        above = codes.above_of(project)
        found = {float(row["combination"].partition("E / ")[2] or 1.0) for row in rows}
        tally.words(name, "reduction", sorted(found), sorted({1.0, _reduction(project, above)}))
        return
    words = list(dict.fromkeys(row["combination"] for row in rows))
    whole = {
        w: sum(s["N"] for k, s in still.items() if k[1] == w and k[3] == "below") for w in words
    }
    upright = any("z" in motion.axes for motion in motions.read(project))
    vertical = 0.0 if upright else building.upright(project)
    wanted, total = building.totals(project, vertical), float(project.governing["weight"])
    wanted = wanted or building.combined(project, (total, 0.0, 0.0), vertical)  # dead load alone
    levels = len({row["level"] for row in rows})
    if wanted["maximum"] == wanted["minimum"]:  # of EN 1998 without a vertical earthquake
        words *= 2
    for word, case in zip(words, ("maximum", "minimum"), strict=True):
        tally.same(name, f"load of {word}", total + whole[word] / levels, wanted[case])


def _reduction(project, above):
    # R_I, q, R_1; nothing is reduced where nothing is known of what stands on the bearings.
    if above is None:
        return 1.0
    r = above["R"]
    return {
        "ASCE 7-22": lambda: min(max(0.375 * r, 1.0), 2.0),
        "EN 1998": lambda: 1.5,
        "NCh2745": lambda: max(min(r, 2.0), 1.0),
    }[project.code]()


def _uplift(project, tally):
    # The least load of all combinations, what the formulas pull, and the larger tension of both.
    name = "tension of a restraint"
    tally.category(
        name, 2e-3, "multiples of the loads on average: the frame's equilibrium is nearly linear"
    )
    rows = project.table("reaction-combinations")
    above, shares = codes.above_of(project), codes.dead_shares(project)
    for k, row in enumerate(project.table("uplift")):
        own = [r for r in rows if (r["bearing"], r["side"]) == (row["bearing"], "below")]
        least = min(float(r["value"]) for r in own if (r["force"], r["extreme"]) == ("N", "min"))
        tally.same(name, f"{row['bearing']} least", row["least load by combination [N]"], least)
        gap = max(float(peaks["gap"][:, k].max()) for peaks in _all_peaks(project))
        tally.same(name, f"{row['bearing']} gap", row["uplift in runs [m]"], gap, 1e-6)
        said, pull = row["pull of the equivalent-linear analysis [N]"], -np.inf
        if above is not None and said:
            pull = max(
                codes.overturning(project, e, above)[k] - shares[1][k] * e["system"].P[k]
                for e in project.linear.values()
            )
            tally.same(
                name,
                f"{row['bearing']} pull",
                said,
                pull,
                next(iter(project.linear.values()))["system"].P[k],
            )
        tally.same(name, row["bearing"], row["tension if held [N]"], max(-least, pull, 0.0), 1e6)


def _all_peaks(project):
    return [*project.peaks.values(), *(project.moved_peaks or {}).values()]


def raised(linear, suite):
    """Return the factors of the code's least shears: above the isolation, and of bearings."""
    if not linear or "V_least" not in linear or suite.void:
        return 1.0, 1.0
    base = max(linear["V_least"] / suite.of("base_shear")[0], 1.0)
    storeys = suite.of("storey_shear")
    if not len(storeys):
        return base, base
    return max(base, linear["V_s"] * linear["R_I"] / storeys[0]), base


def _level(project, row):
    return row["level"] if project.code == "NCh2745" else ""


def _of(suite, extremes):
    # Mean or largest of the extremes of the runs, signed so that more is farther out; of what all
    # reached where more failed than may.
    good = extremes[_counting(suite)]
    return good.mean() if suite.mean else good.max()


def _counting(suite):
    return ~suite.failed | suite.void


def _reactions(project, key, rows, tally):
    data, suite = project.runs[key[0]][key[1]], project.suites[key[0]][key[1]]
    names = list(map(str, data["bearing"]))
    for (bearing, side), each in rows.items():
        b, end = names.index(bearing), ("below", "above").index(side)
        acts, more = (_of_bearing(one, b, end) for one in (data, suite.moved))
        force, moment = data["bearing_force"][:, :, b], data["bearing_moment"][:, :, b, end]
        scale = {"N": np.nanmax(np.abs(force)), "N m": np.nanmax(np.abs(moment))}
        contact = project.analysis.get("level", "contact") == "contact"
        if side == "below" and contact:  # histories have the forces above, the sliders between
            acts = {word: values for word, values in acts.items() if word[0] == "M"}
        for row in each:
            if row["force"] in acts:
                told = "reactions of bearings, from histories", tally
                factor = raised(_linear(project, key), suite)[1]
                _row(suite, row, (acts, more), scale[row["unit"]], told, factor)


def _of_bearing(data, b, end):
    # Histories of the six forces of a side of a bearing, (n_runs, steps).
    if data is None:
        return None
    force, moment = data["bearing_force"][:, :, b], data["bearing_moment"][:, :, b, end]
    sign = 1.0 if end == 0 else -1.0
    acts = {"N": -force[..., 2], "Vx": sign * force[..., 0], "Vy": sign * force[..., 1]}
    return acts | {word: -moment[..., k] for k, word in enumerate(("Mx", "My", "Mz"))}


def _linear(project, key):
    # Of the bound of a level at which the structure is judged.
    return project.linear.get(key[1])


def _added(suite, outward, beyond):
    # What moved masses add to extremes, by the way that adds most.
    most, word = 0.0, ""
    for way, here, there in suite.ways():
        of = np.mean if len(there) >= MEAN_FROM else np.max
        more = of(beyond[there]) - of(outward[here])
        if more > most:
            most, word = more, way
    return most, word


def _row(suite, row, pair, scale, told, factor):
    # A row of a table against histories of six forces, (n_runs, steps), and of moved runs.
    category, tally = told
    (acts, more), force = pair, row["force"]
    sign, label = EXTREMES[row["extreme"]], " ".join(list(row.values())[:6])
    outward = np.nanmax(sign * acts[force], axis=1)
    beyond = np.array([]) if more is None else np.nanmax(sign * more[force], axis=1)
    rest, way = float(row["permanent"]), ""
    if not suite.stopped[_counting(suite)].any():  # the step that ends a run is in no history
        value = _of(suite, outward)
        if not suite.void:
            added, way = _added(suite, outward, beyond)
            tally.same(category, f"{label}, added", row["moved masses add"], sign * added, scale)
            if added > 1e-4 * scale:
                tally.words(category, f"{label}, masses", row["masses"], way)
            value += added
        value = rest + max(factor, 1.0) * (sign * value - rest)
        tally.same(category, label, float(row["value"]), value, scale)
        tally.same(category, f"{label}, raised by", row["raised by"], factor)
        single = sign * max([*outward[_counting(suite)], *beyond])
        tally.same(category, f"{label}, single", float(row["single"]), single, scale)
    at = _run_of(suite, row["motion"])
    data, acts, stopped = (suite.data, acts, suite.stopped)
    if at >= len(outward):  # of the runs with moved masses
        at -= len(outward)
        data, acts, stopped = suite.moved, more, suite.moved_stopped
    if stopped[at]:
        return
    extreme = sign * np.nanmax(sign * acts[force][at])
    tally.same(category, f"{label}, motion", float(row["single"]), extreme, scale)
    time = data["time"] if data["time"].ndim == 1 else data["time"][at]
    step = int(np.nanargmin(np.abs(time - float(row["time [s]"]))))
    for word, values in acts.items():
        size = scale if word == force else max(scale, np.nanmax(np.abs(values)))
        then = float(row[f"{word} then"])
        tally.same(category, f"{label}, {word} then", then, values[at, step], size)
    tally.same(category, f"{label}, permanent", rest, acts[force][at, 0], scale)


def _run_of(suite, said):
    # The place of a run by its name, those with moved masses last.
    names = list(map(str, suite.data["motion"]))
    if suite.moved is not None:
        ways = zip(suite.moved["motion"], suite.moved["mass_shift"], strict=True)
        names += [f"{motion}, masses {way}" for motion, way in ways]
    return names.index(said.partition(" x ")[0])


def _storeys(project, key, rows, tally):
    data, suite = project.runs[key[0]][key[1]], project.suites[key[0]][key[1]]
    category = "storey forces, from histories"
    above, isolation = raised(_linear(project, key), suite)
    storeys = list(map(str, data["storey"]))
    for storey, each in rows.items():
        k = storeys.index(storey) if storey in storeys else None
        acts, more = (_of_storey(project, one, k) for one in (data, suite.moved))
        for row in each:
            if row["force"] == "drift":
                _drift(suite, k, row, above, tally)
            elif row["force"] in acts:
                of = [word for word in acts if (word[0] == "M") == (row["force"][0] == "M")]
                scale = max(np.nanmax(np.abs(acts[word])) for word in of)
                factor = above if storey in storeys else isolation
                _row(suite, row, (acts, more), scale, (category, tally), factor)


def _of_storey(project, data, k):
    # Histories of the forces through a storey; at the foot of the lowest level through bearings.
    if data is None:
        return None
    if k is None:
        return _through_bearings(data, project.governing)
    passed = data["storey_shear"][:, :, k]
    return {word: passed[..., axis] for axis, word in enumerate(AXES[:3])}


def _drift(suite, k, row, factor, tally):
    name, centred = "drifts of storeys", suite.reached("drift")[:, k]
    value, way = _of(suite, centred), ""
    if suite.moved is not None and not suite.void:
        added, way = _added(suite, centred, suite.moved_peaks["drift"][:, k])
        tally.same(name, f"{row['storey']} added", row["moved masses add"], added, value)
        value += added
    tally.same(name, row["storey"], float(row["value"]), factor * value)
    if way and float(row["moved masses add"]) > 1e-3 * value:
        tally.words(name, f"{row['storey']} masses", row["masses"], way)


def _through_bearings(data, statics):
    place, level = statics["node_position"], statics["level_node"]
    arms = place[statics["bearing_node"][:, 1]] - place[level == 0].mean(axis=0)
    force, moment = data["bearing_force"], data["bearing_moment"][:, :, :, 1]
    turning = (moment + np.cross(arms, force)).sum(axis=2)
    both = np.concatenate([force.sum(axis=2), turning], axis=2)
    return {word: both[..., k] for k, word in enumerate(AXES)}


def _groups(project, tally):
    # Each cell has its row in the table of all members, and no bound of it is farther out.
    name, own = "forces of groups of members", {}
    for row in project.table("members"):
        key = f"{row['member']} {row['station']}", row["force"], row["extreme"]
        own.setdefault(key, []).append(row)
    judged = "design" if project.code == "NCh2745" else None
    for row in project.table("member-groups"):
        for title, extreme in (("largest", "max"), ("smallest", "min")):
            where = row[f"member of {title}"].partition(", ")[0]
            those = [
                float(each["value"])
                for each in own[where, row["force"], extreme]
                if judged in {None, each["level"]}
            ]
            worst = max(those) if extreme == "max" else min(those)
            tally.same(name, f"{row['group']} {row['force']}", float(row[title]), worst)
