"""Forces under bearings, of storeys and of members: their tables, from histories of bearings."""

import numpy as np

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
    if (project.results / "members.csv").is_file():
        _groups(project, tally)


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
        sign = 1.0 if side == "below" else -1.0
        force, moment = data["bearing_force"][:, :, b], data["bearing_moment"][:, :, b, end]
        acts = {"N": -force[..., 2], "Vx": sign * force[..., 0], "Vy": sign * force[..., 1]}
        acts |= {word: -moment[..., k] for k, word in enumerate(("Mx", "My", "Mz"))}
        scale = {"N": np.nanmax(np.abs(force)), "N m": np.nanmax(np.abs(moment))}
        contact = project.analysis.get("level", "contact") == "contact"
        if side == "below" and contact:  # histories have the forces above, the sliders between
            acts = {word: values for word, values in acts.items() if word[0] == "M"}
        for row in each:
            if row["force"] in acts:
                told = "reactions of bearings, from histories", tally
                factor = raised(_linear(project, key), suite)[1]
                _row(suite, row, acts, scale[row["unit"]], told, factor)


def _linear(project, key):
    # Of the bound of a level at which the structure is judged.
    return project.linear.get(key[1])


def _row(suite, row, acts, scale, told, factor):
    # A row of a table against histories of six forces, (n_runs, steps).
    category, tally = told
    sign, label = EXTREMES[row["extreme"]], " ".join(list(row.values())[:6])
    extremes = sign * np.nanmax(sign * acts[row["force"]], axis=1)
    motions = list(map(str, suite.data["motion"]))
    k = next(n for n, motion in enumerate(motions) if row["motion"].partition(" x ")[0] == motion)
    if not suite.stopped[_counting(suite)].any():  # the step that ends a run is in no history
        value = sign * _of(suite, sign * extremes)
        rest = float(row["permanent"])
        value = value + (factor - 1.0) * (value - rest)
        tally.same(category, label, float(row["value"]), value, scale)
        single = sign * np.max(sign * extremes[_counting(suite)])
        tally.same(category, f"{label}, single", float(row["single"]), single, scale)
    if suite.stopped[k]:
        return
    tally.same(category, f"{label}, motion", float(row["single"]), extremes[k], scale)
    time = suite.data["time"] if suite.data["time"].ndim == 1 else suite.data["time"][k]
    step = int(np.nanargmin(np.abs(time - float(row["time [s]"]))))
    for force, values in acts.items():
        size = scale if force == row["force"] else max(scale, np.nanmax(np.abs(values)))
        then = float(row[f"{force} then"])
        tally.same(category, f"{label}, {force} then", then, values[k, step], size)
    first = acts[row["force"]][k, 0]
    tally.same(category, f"{label}, permanent", float(row["permanent"]), first, scale)


def _storeys(project, key, rows, tally):
    data, suite = project.runs[key[0]][key[1]], project.suites[key[0]][key[1]]
    statics, category = project.governing, "storey forces, from histories"
    above, isolation = raised(_linear(project, key), suite)
    storeys = list(map(str, data["storey"]))
    for storey, each in rows.items():
        if storey in storeys:
            passed = data["storey_shear"][:, :, storeys.index(storey)]
            acts = {word: passed[..., k] for k, word in enumerate(AXES[:3])}
        else:  # at the foot of the lowest level, all of it passes through bearings
            acts = _through_bearings(data, statics)
        for row in each:
            if row["force"] == "drift":
                column = suite.reached("drift")[:, storeys.index(storey)]
                value = above * _of(suite, column)
                tally.same("drifts of storeys", storey, float(row["value"]), value)
            elif row["force"] in acts:
                of = [word for word in acts if (word[0] == "M") == (row["force"][0] == "M")]
                scale = max(np.nanmax(np.abs(acts[word])) for word in of)
                factor = above if storey in storeys else isolation
                _row(suite, row, acts, scale, (category, tally), factor)


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
