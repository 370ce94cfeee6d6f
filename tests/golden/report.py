"""Every table of the report: its cells beside the tables of the folder, or what is recomputed."""

import functools
import math

import building
import checks
import codes
import described
import motions
import numpy as np
import reading
from reading import GRAVITY
from tally import plain

FACTORS = {
    "mm": 1e3,
    "kN": 1e-3,
    "kN m": 1e-3,
    "MPa": 1e-6,
    "%": 1e2,
    "kN/m": 1e-3,
    "t": 1e-3,
    "kJ": 1e-3,
}
BOUNDS = ("lower", "nominal", "upper", "value")
GROUND_PERIODS = np.geomspace(0.05, 12.0, 120)


def compare(project, tally):
    """Hold each table of the report against the folder's tables."""
    tally.category("tables of the report", 0.0, "to the last of the four digits that are printed")
    tally.category("limits of the procedure", 0.0, "to the last printed digit")
    tally.category("measures of motions", 0.0, "to the last printed digit, peaks of spectra aside")
    tally.category("levels at spectra's peaks", 4e-3, "two peaks may be as high, but for 0.3 %")
    tables = reading.tables_of(project.text("report.html"))
    seen = []
    for heading, head, rows in tables:
        kind = _kind(heading, head)
        seen.append(kind)
        if kind is None:
            tally.unknown("tables of the report", f"{heading}: {head[0]}")
        else:
            kind(project, head, rows, tally)
    wanted = [
        _described,
        _model,
        _loads,
        _modes,
        _device,
        _bearings,
        _friction,
        _motions,
        _linear,
        _limits,
        _demands,
        _by_motion,
        _checks,
        _provisions,
        _programme,
        _accepted,
    ]
    columns = {title for title in project.table("equivalent-linear")[0] if title}
    tally.words("tables of the report", "columns of linear", project.shown == columns, True)
    if project.moved:
        wanted.append(_raised)
    for kind in wanted:
        tally.words("tables of the report", f"table {kind.__name__} is there", kind in seen, True)


def _kind(heading, head):
    named = {
        ("Structure", "of the structure"): _described,
        ("Structure", "quantity"): _model,
        ("Structure", "mode"): _modes,
        ("Bearings", "property"): _device,
        ("Bearings", "friction coefficient"): _friction,
        ("Motions", "motion"): _motions,
        ("Equivalent-linear analysis", "bound"): _linear,
        ("Equivalent-linear analysis", "check"): _limits,
        ("Time histories", "quantity"): _demands,
        ("Time histories", "cause"): _failed_runs,
        ("Time histories", "largest"): _raised,
        ("Time histories", "motion"): _by_motion,
        ("Time histories", "members"): _members,
        ("Time histories", "foundation below"): _foundation,
        ("Time histories", "bearing that lifts"): _lifting,
        ("Checks", "check"): _checks,
        ("Checks", "provision"): _provisions,
        ("Structure", "level"): _table("centres"),
        ("Bearings for tender", "of the bearings"): _table("schedule"),
        ("Bearings for tender", "bearing"): _table("bearings"),
        ("Test programme", "bearings to test"): _table("rig"),
        ("Access, inspection, replacement", "type to replace"): _table("replacement"),
        ("Test programme", "test"): _programme,
        ("Test programme", "accepted if"): _accepted,
    }
    if (heading, head[0]) == ("Bearings", "bearing"):
        return _loads if any(title.startswith("pressure") for title in head) else _bearings
    return named.get((heading, head[0]))


def shown(tally, label, text, value, factor=1.0, category="tables of the report"):
    """Compare a cell of four digits with a number in SI units."""
    value = float(value) if value not in {"", None} else math.nan
    if not math.isfinite(value):
        tally.words(category, label, text in {"-", "", "rigid slider"}, True)
        return
    tally.printed(category, label, text, value, factor)
    if text not in {"", "-"}:
        digits = 0.5000001 * 10.0 ** (math.floor(math.log10(abs(value * factor) or 1.0)) - 3)
        off = abs(float(plain(text).split(" ")[0]) - value * factor)
        tally.words(category, f"{label}: four digits of {value * factor!r}", off <= digits, True)


def _described(project, head, rows, tally):
    described.compare(project, rows, tally)


def _model(project, head, rows, tally):
    statics = project.governing
    mass = statics["node_mass"][:, 0].sum()
    found = {row[0]: row[1] for row in rows}
    tally.printed("tables of the report", "mass", found["mass"], 1e-3 * mass)
    tally.printed(
        "tables of the report",
        "weight",
        found["permanent vertical load"],
        1e-3 * float(statics["weight"]),
    )
    tally.printed(
        "tables of the report",
        "carried",
        found["carried by the bearings"],
        1e-3 * float(statics["weight"]),
    )
    rows = zip(project.table("bearings"), project.types, strict=True)
    loads = [(float(row["average load [N]"]), project.devices[kind].L) for row, kind in rows]
    length = sum(load for load, _ in loads) / sum(load / own for load, own in loads)
    period = 2.0 * math.pi * math.sqrt(length / GRAVITY)
    tally.printed(
        "tables of the report", "pendulum", found["period on the bearings, sliding"], period
    )
    fixed = [float(row["period, fixed base [s]"]) for row in project.table("modes")[:3]]
    for text, value in zip(found["periods, fixed base"].split(","), fixed, strict=False):
        tally.printed("tables of the report", "fixed base", text.strip(), value)


def _loads(project, head, rows, tally):
    own = {row["bearing"]: float(row["average load [N]"]) for row in project.table("bearings")}
    kinds = dict(zip(own, project.types, strict=True))
    place = {title.partition(" [")[0]: k for k, title in enumerate(head)}
    for row in rows:
        if row[0] in own:
            load, b = own[row[0]], project.devices[kinds[row[0]]]
            area, period = math.pi * b.a**2, 2.0 * math.pi * math.sqrt(b.L / GRAVITY)
            tally.printed("tables of the report", "load", row[place["axial force"]], 1e-3 * load)
            tally.printed(
                "tables of the report", "pressure", row[place["pressure"]], 1e-6 * load / area
            )
            tally.printed("tables of the report", "pendulum", row[place["pendulum period"]], period)


def _device(project, head, rows, tally):
    # One table a type, in the order in which bearings have them.
    kinds = list(dict.fromkeys(project.types))
    project.told = getattr(project, "told", -1) + 1
    b = project.devices[kinds[project.told % len(kinds)]]
    found = {row[0]: (row[1], FACTORS.get(row[2], 1.0)) for row in rows}
    own = {
        "effective radius": b.L,
        "pendulum period": 2.0 * math.pi * math.sqrt(b.L / GRAVITY),
        "displacement capacity": b.capacity,
        "characteristic strength ratio Q/W": b.share(b.fast),
        "stable limit of interface slip": b.L * b.inner - b.fast * b.R.sum(),
        "height of the inner slider": b.h,
        "radius of the inner slider in plan": b.a,
        "friction coefficient of the interface": b.inner,
        "displacement capacity, to rim contact": b.capacity,
        "interface slip at the end of the overlap": b.overlap,
    }
    for name, value in own.items():
        text, factor = found[name]
        tally.printed("tables of the report", name, text, value, factor)


def _from_csv(project, name, head, rows, tally, names=None):
    # Cells beside those of a table of the folder, columns by their titles without unit.
    own = project.table(name)
    tally.same("tables of the report", f"rows of {name}", len(rows), len(own))
    for row, given in zip(rows, own, strict=True):
        columns = {title.partition(" [")[0]: (title, value) for title, value in given.items()}
        for title, text in zip(head, row, strict=True):
            plain, _, unit = title.partition(" [")
            unit = unit.removesuffix("]")
            if names and title == head[0]:
                tally.words("tables of the report", f"{name} {text}", text, names(given))
                continue
            if plain not in columns:
                tally.unknown("tables of the report", f"{name}: {title}")
                continue
            full, value = columns[plain]
            factor = FACTORS.get(unit, 1.0) if f"[{unit}]" != full.partition(" ")[2] else 1.0
            factor = 1.0 if full.endswith(f"[{unit}]") else factor
            factor = _factor_of_row(given, title, factor)
            label = f"{name} {row[0]} {title}"
            if _number(value):
                shown(tally, label, text, value, factor)
            elif plain in {"unit"}:
                tally.words("tables of the report", label, text, UNIT.get(value, value))
            elif plain == "clause":
                tally.words("tables of the report", label, text.removesuffix(" *"), value)
            elif plain == "void":  # the reason is in a sentence
                tally.words("tables of the report", label, text, "not valid" if value else "")
            elif plain not in {"bearing", "friction coefficient", "test"}:
                tally.words(
                    "tables of the report",
                    label,
                    text if text != "-" else "",
                    " ".join(value.split()),
                )


UNIT = {"m": "mm", "N": "kN", "N m": "kN m", "N/m": "kN/m", "J": "kJ", "m/s2": "m/s²"}


def _factor_of_row(given, title, factor):
    # Rows that name their unit are shown in mm and kN.
    if "unit" in given and title not in {"members"}:
        return FACTORS.get(UNIT.get(given["unit"], ""), 1.0)
    return factor


def _number(text):
    try:
        float(text)
    except ValueError:
        return False
    return True


@functools.cache
def _table(name):
    # What holds a table of the report against the file of its name.
    def compare(project, head, rows, tally):
        _from_csv(project, name, head, rows, tally, lambda row: next(iter(row.values())))

    compare.__name__ = f"_{name}"
    return compare


def _modes(project, head, rows, tally):
    _from_csv(project, "modes", head, rows, tally)


def _bearings(project, head, rows, tally):
    _from_csv(project, "bearings", head, rows, tally, lambda row: row["bearing"])


def _friction(project, head, rows, tally):
    _from_csv(project, "friction", head, rows, tally, lambda row: row["friction coefficient"])


def _linear(project, head, rows, tally):
    # A wide table is shown in parts, each with its bounds.
    own = project.table("equivalent-linear")
    places = {title.partition(" [")[0].replace("_", " "): title for title in own[0] if title}
    project.shown = getattr(project, "shown", set())
    for row, given in zip(rows, own, strict=True):
        for title, text in zip(head[1:], row[1:], strict=True):
            name, _, unit = title.removesuffix("]").partition(" [")
            project.shown.add(places[name])
            value = given[places[name]]
            if value == "":
                tally.words("tables of the report", title, text, "")
            else:
                shown(tally, f"linear {row[0]} {title}", text, value, FACTORS.get(unit, 1.0))


def _demands(project, head, rows, tally):
    # Heads are short; a table a level, in parts where it is wide, at a column of its own.
    own = project.table("demands")
    levels = len({given["level"] for given in own})
    tally.same("tables of the report", "rows of demands", len(rows) * levels, len(own))
    tables = project.__dict__.setdefault("tables", [])  # the columns that each level had so far
    if not tables or tables[-1] & set(head[1:]):
        tables.append(set())
    tables[-1].update(head[1:])
    own = own[(len(tables) - 1) * len(rows) :][: len(rows)]
    full = {title.partition(",")[0]: title for title in own[0]}
    full["largest of all runs"] = next(title for title in own[0] if title.startswith("worst of"))
    for row, given in zip(rows, own, strict=True):
        tally.words("tables of the report", "demands", row[0], given["quantity"])
        for title, text in zip(head[1:], row[1:], strict=True):
            label = f"demands {row[0]} {title}"
            if title == "unit":
                tally.words(
                    "tables of the report", label, text, UNIT.get(given[title], given[title])
                )
            elif _number(given[full[title]]):
                shown(tally, label, text, given[full[title]], _factor_of_row(given, title, 1.0))
            else:
                given_text = " ".join(given[full[title]].split())
                tally.words("tables of the report", label, "" if text == "-" else text, given_text)


def _failed_runs(project, head, rows, tally):
    # Rows of a level and bound, by cause: their counts are those of the table of all motions.
    own = project.table("demands-by-motion")
    for level, bound in sorted({(row[1], row[2]) for row in rows}):
        cells = [row[3] for row in rows if (row[1], row[2]) == (level, bound)]
        runs = [row for row in own if (row["level"], row["bound"]) == (level, bound)]
        failed = sum(row["failed"] == "yes" for row in runs)
        label = f"failed runs {level} {bound}"
        tally.same(
            "tables of the report", label, sum(int(c.split(" / ")[0]) for c in cells), failed
        )
        every = {c.split(" / ")[1] for c in cells}
        tally.words("tables of the report", label, every, {str(len(runs))})


def _by_motion(project, head, rows, tally):
    # A wide table is shown in parts, each with the columns that say of which run a row is.
    own = project.table("demands-by-motion")
    tally.same("tables of the report", "rows of each motion", len(rows), len(own))
    for row, given in zip(rows, own, strict=True):
        columns = {title.partition(" [")[0]: value for title, value in given.items()}
        for title, text in zip(head, row, strict=True):
            plain_title, _, unit = title.removesuffix("]").partition(" [")
            label, value = f"{row[0]} {title}", columns[plain_title]
            if unit or plain_title == "scale":
                shown(tally, label, text, value, FACTORS.get(unit, 1.0) if unit != "-" else 1.0)
            else:
                tally.words("tables of the report", label, text, value)


def _members(project, head, rows, tally):
    own = project.table("member-groups")
    for row, given in zip(rows, own, strict=True):
        factor = FACTORS[UNIT[given["unit"]]]
        tally.words("tables of the report", "members", row[0], given["group"])
        for title, text in zip(head[1:], row[1:], strict=True):
            source = given.get(title)
            if title == "void":  # the reason is in a sentence
                source = "not valid" if source else ""
            if title in {"smallest", "largest"}:
                shown(tally, f"members {row[0]} {title}", text, source, factor)
            elif title == "unit":
                tally.words("tables of the report", "members unit", text, UNIT[source])
            else:
                tally.words("tables of the report", f"members {title}", text, source)


def _foundation(project, head, rows, tally):
    # Three rows a bearing, of the table of reactions by combination, in parts of a page.
    level = "maximum" if project.code == "NCh2745" else None
    own = [row for row in project.table("reaction-combinations") if row["side"] == "below"]
    own = [row for row in own if level in {None, row["level"]}]
    moments = [row for row in own if row["force"] in {"Mx", "My"}]
    loads = [row for row in own if row["force"] == "N"]
    of = {
        "largest N": lambda b: max((r for r in loads if r["bearing"] == b), key=_value),
        "least N": lambda b: min((r for r in loads if r["bearing"] == b), key=_value),
        "largest M": lambda b: max(
            (r for r in moments if r["bearing"] == b), key=lambda r: abs(_value(r))
        ),
    }
    for row in rows:
        found = of[row[1]](row[0])
        for title, text in list(zip(head, row, strict=True))[2:]:
            force, _, unit = title.removesuffix("]").partition(" [")
            label = f"foundation {row[0]} {row[1]} {title}"
            if unit:
                shown(tally, label, text, found[f"{force} then"], FACTORS[unit])
            else:
                tally.words("tables of the report", label, text, found[title])


def _value(row):
    return float(row["value"])


def _lifting(project, head, rows, tally):
    own = {row["bearing"]: row for row in project.table("uplift")}
    for row in rows:
        found = {k.partition(" [")[0]: v for k, v in own[row[0]].items()}
        for title, text in list(zip(head, row, strict=True))[1:]:
            what, _, unit = title.removesuffix("]").partition(" [")
            label = f"lifting {row[0]} {title}"
            if unit:
                shown(tally, label, text, found[what], FACTORS[unit])
            else:
                tally.words("tables of the report", label, text, found[what])


RAISED = {
    "displacement": "isolator displacement",
    "force": "lateral force of a bearing",
    "axial force": "maximum axial force",
    "drift": "storey drift ratio",
    "line drift": "storey drift ratio, maximum at any column line",
    "floor plan": "floor acceleration in plan",
    "slip": "interface slip",
    "eccentricity loaded": "normalised eccentricity e/a",
    "axial tension": "maximum axial tension",
    "displacement left": "residual displacement",
    "slip left": "residual interface slip",
}


def _raised(project, head, rows, tally):
    # Of each quantity and bound the way that raises it most, in parts.
    own, best = project.table("eccentricity"), {}
    for row in own:
        key = row["level"], row["bound"], row["quantity"]
        size = float(row["factor"] or 0.0) + float(row["added"] or 0.0)
        if key not in best or size > best[key][0]:
            best[key] = size, row
    given_rows = [row for row in own if any(row is kept for _, kept in best.values())]
    tally.same("tables of the report", "rows of moved masses", len(rows), len(given_rows))
    for row, given in zip(rows, given_rows, strict=True):
        said = RAISED.get(given["quantity"], given["quantity"])
        tally.words("tables of the report", "moved masses", row[0], said)
        unit = FACTORS.get(UNIT.get(given["unit"], ""), 1.0)
        for title, text in zip(head[1:], row[1:], strict=True):
            label, value = f"moved masses {row[0]} {title}", given[title]
            if title == "unit":
                tally.words("tables of the report", label, text, UNIT.get(value, value))
            elif title in {"centred", "moved", "factor", "added"}:
                factor = 1.0 if title == "factor" else unit
                shown(tally, label, text, value, factor)
            else:
                tally.words("tables of the report", label, text, value)


def _accepted(project, head, rows, tally):
    # Rule by rule what programme.csv has test by test.
    category, by_test = "tables of the report", {}
    for rule, tests, clause in rows:
        for number in tests.split(", "):
            by_test.setdefault(number, []).append(f"{rule} ({clause})")
    for row in project.table("programme"):
        said = "; ".join(by_test.get(row["test"], []))
        tally.words(category, f"{row['what']}: accepted if", said, row["accepted if"])


def _programme(project, head, rows, tally):
    _from_csv(project, "programme", head, rows, tally, lambda row: f"{row['test']} {row['what']}")


def _checks(project, head, rows, tally):
    own = project.table("checks")
    tally.same("tables of the report", "rows of checks", len(rows), len(own))
    clause = head.index("clause")
    for row, given in zip(rows, own, strict=True):
        label = f"check {given['title']} {given['subject']} {given['bound']}"
        for title, text in (
            ("title", row[0]),
            ("subject", row[1]),
            ("bound", row[2]),
            ("level", row[3]),
            ("verdict", row[8]),
        ):
            tally.words("tables of the report", label, text, " ".join(given[title].split()))
        tally.words("tables of the report", label, row[clause].removesuffix(" *"), given["clause"])
        star = given["standing"].startswith("from memory")
        tally.words("tables of the report", f"{label} star", row[clause].endswith("*"), star)
        void = bool(given["void"])
        numbers = [float(given[name]) for name in ("demand", "limit")]
        plain_words = void or nothing(given) or not np.isfinite(numbers).all()
        sign = "" if plain_words else {"<=": "≤", ">=": "≥"}[given["relation"]]
        tally.words("tables of the report", label, row[5], sign)
        for text, value in zip((row[4], row[6]), numbers, strict=True):
            _said(tally, label, text.strip("()"), value)
        if nothing(given):
            tally.words("tables of the report", f"{label} limit", row[6], "none allowed")
        elif not void and math.isfinite(float(given["ratio"])):
            tally.printed("tables of the report", f"{label} ratio", row[7], float(given["ratio"]))


def nothing(given):
    """Return whether nothing is allowed: words stand in the place of zeros."""
    return float(given["limit"]) == 0.0 and given["relation"] == "<="


WORDS = {"none": 0.0, "none allowed": 0.0}
NO_NUMBER = {"no limit", "not evaluated", "not known"}


def _said(tally, label, text, value, category="tables of the report"):
    # A number with its unit.
    if text in WORDS:
        tally.same(category, label, WORDS[text], value)
        return
    if not math.isfinite(value):
        tally.words(category, label, text in NO_NUMBER, True)
        return
    number, _, unit = text.partition(" ")
    number, unit = plain(number), unit.replace("²", "2")
    factor = FACTORS.get(unit, 1.0)
    tally.printed(category, label, number, value, factor)


def _limits(project, head, rows, tally):
    # What of the equivalent-linear analysis does not count among the checks.
    name = "limits of the procedure"
    for row in rows:
        own = _limit(project, row)
        label = f"{row[0]} {row[1]} {row[2]}"
        if own is None:
            tally.unknown(name, label)
            continue
        demand, limit = own
        if row[0].startswith("no uplift"):  # loads of combinations: nearly multiples
            value = 1e3 * float(plain(row[6]).split(" ")[0])
            live = project.file.get("loads", {}).get("live", 0.0) > 0.0
            live = live or project.file["structure"]["kind"] == "sap2000"
            off = 1e-2 if live else 2e-3  # live load is on no facade
            tally.words(name, label, abs(value - limit) < off * limit, True)
            limit = value  # the verdict may be decided by what is nearly a multiple
        else:
            _said(tally, f"{label} limit", row[6], limit, name)
        _said(tally, f"{label} demand", row[4], demand, name)
        relation = "<=" if row[5] == "≤" or row[6] == "none allowed" else ">="
        ratio = checks.ratio_of(demand, limit, relation)
        beyond = "FAILS" if row[0].startswith(("storey drift", "pressure on")) else "does not apply"
        word = "ok" if ratio <= 1.0 + 1e-9 else beyond
        tally.words(name, f"{label} verdict", row[8], word)


def _limit(project, row):
    title, subject, bound = row[:3]
    e, above = project.linear.get(bound), codes.above_of(project)
    if e is None:
        return None
    s = e["system"]
    if title == "capacity with accumulated displacement":
        moved = 1.2 * e["each"] + 0.5 * s.mu * s.L
        k = int((moved / s.capacity).argmax())
        return moved[k], s.capacity[k]
    if title.startswith("no restrainer contact at "):
        moved = e["each"] * (1.2 if project.code == "EN 1998" else 1.0)
        k = int((moved / s.capacity).argmax())
        return moved[k], s.capacity[k]
    if title == "effective stiffness ratio, D_M to 0.2 D_M":
        return e["k"], e["k_02"] / 3.0
    if title == "effective stiffness ratio, d_dc to 0.2 d_dc":
        return e["k"], e["k_02"] / 2.0
    if title == "no uplift where the vertical earthquake leads":
        rest = 0.7 * building.upright(project, 1.0) * s.P
        beside = codes.overturning(project, e, above, 0.3, 0.3)
        k = s.names.index(subject)
        return (beside + rest)[k], codes.dead_shares(project)[1][k] * s.P[k]
    if title.startswith("no uplift") and "not evaluated" not in title:
        most, least = codes.dead_shares(project)
        share = most if title.endswith("maximum") else least
        k = s.names.index(subject)
        return codes.overturning(project, e, above)[k], share[k] * s.P[k]
    held = above["T_fb"] if above and above["T_fb"] else 0.0
    if title == "storey drift":
        return storey_drift(project, e, above, int(subject.removeprefix("storey ")) - 1)
    simple = {
        "effective period": (e["period"], 5.0),
        "effective damping": (e["damping"], 0.30),
        "restoring force": e["restoring"],
        "total eccentricity over the side of the plan": (e.get("a_tot", 0.0), 0.075),
        "eccentricity of the isolation over its torsional radius": (e.get("e_r"), 0.30),
        "torsional radius of the isolation over the radius of gyration": (e.get("r_l"), 1.0),
        "period ratio T_M / T_fb": (e["period"], 3.0 * held),
        "storeys": (len(above["w"]) if above else 0, 4.0),
        "height": (above["h"][-1] if above else 0.0, 19.8),
    }
    return simple.get(title)


def storey_drift(project, e, above, k):
    """Return the drift of a storey under the floors' forces, and its limit."""
    stiffness = project.file["structure"]["storey_stiffness"][k]
    w, h = above["w"], above["h"]
    code = project.code
    share = w * h ** (14.0 * e["damping"] * above["T_fb"]) if code == "ASCE 7-22" else w * h
    share = w if code == "EN 1998" else share  # one acceleration for all
    more = {"ASCE 7-22": e.get("R_I"), "EN 1998": 0.5 * 1.5, "NCh2745": min(above["R"] or 2.0, 2.0)}
    limit = {"ASCE 7-22": 0.015, "EN 1998": 0.005, "NCh2745": 0.0025}[code]
    shear = e["V_s"] * share[k:].sum() / share.sum()
    return more[code] * shear / stiffness, limit * np.diff(h, prepend=0.0)[k]


def _provisions(project, head, rows, tally):
    """The table among the files, and that each is checked by a check that was made or says why."""
    name, kept = "tables of the report", project.table("provisions")
    tally.words(name, "number of provisions", len(rows), len(kept))
    made = {row["title"] for row in project.table("checks")}
    for row, own in zip(rows, kept, strict=True):
        tally.words(name, f"{own['what']}", row[0], own["what"])
        tally.words(name, f"{own['what']} is", row[2], own["state"])
        if own["state"] == "checked":
            titles = own["how"].split("; ")
            limits = "storey drift", "no uplift", "effective", "period ratio", "no restrainer"
            limits += "restoring", "total eccentricity", "capacity with", "storeys", "height"
            limits += "eccentricity of the isolation", "torsional radius"
            found = [t in made or t.startswith(limits) for t in titles]
            tally.words(name, f"{own['what']} by", all(found), True)


def _motions(project, head, rows, tally):
    name = "measures of motions"
    found = project.motions
    for k, (row, motion) in enumerate(zip(rows, found.motions, strict=True)):
        cells = dict(zip(head, row, strict=True))
        a = found.factors[k] * motion.axes["x"]
        if "factor" in cells:
            tally.printed(name, f"{motion.name} factor", cells["factor"], found.used[k])
        # the factor that was used; the rule's is compared with it elsewhere
        if project.file["motions"].get("scale", "spectrum") == "spectrum":
            a = found.used[k] * motion.axes["x"]
        for title, value in measures(a, motion.dt).items():
            if title in cells:  # the table is in parts
                tally.printed(name, f"{motion.name} {title}", cells[title], value)
        for title, levels in zip(("Tp [s]", "T pulse [s]"), spectra(a, motion.dt), strict=True):
            if title not in cells:
                continue
            k = int(np.abs(GROUND_PERIODS - float(cells[title])).argmin())
            tally.printed(name, f"{motion.name} {title}", cells[title], GROUND_PERIODS[k])
            of = "levels at spectra's peaks"
            tally.same(of, f"{motion.name} {title}", levels[k], levels.max())


def measures(a, dt):
    """Return peaks, intensities and durations of one component."""
    between = 0.5 * dt * (a[:-1] ** 2 + a[1:] ** 2)
    arias = np.concatenate([[0.0], math.pi / (2.0 * GRAVITY) * np.cumsum(between)])
    time = dt * np.arange(len(a))
    # exact integrals of an acceleration that is linear between its samples
    v = np.concatenate([[0.0], np.cumsum(0.5 * dt * (a[:-1] + a[1:]))])
    d = np.concatenate([[0.0], np.cumsum(dt * v[:-1] + dt**2 * (2.0 * a[:-1] + a[1:]) / 6.0)])
    at = np.interp(np.array([0.05, 0.75, 0.95]) * arias[-1], arias, time)
    power, f = np.abs(np.fft.rfft(a)) ** 2, np.fft.rfftfreq(len(a), dt)
    band = (f >= 0.25) & (f <= 20.0)
    size = np.abs(a)
    return {
        "PGA [m/s2]": size.max(),
        "PGV [m/s]": np.abs(v).max(),
        "PGD [m]": np.abs(d).max(),
        "Arias [m/s]": arias[-1],
        "CAV [m/s]": (0.5 * dt * (size[:-1] + size[1:])).sum(),
        "D5-75 [s]": at[1] - at[0],
        "D5-95 [s]": at[2] - at[0],
        "Tm [s]": (power[band] / f[band]).sum() / power[band].sum(),
    }


def spectra(a, dt):
    """Return pseudo-accelerations and pseudo-velocities at the periods of the package."""
    u = np.array([np.abs(motions.oscillator(a, dt, t)).max() for t in GROUND_PERIODS])
    w = 2.0 * math.pi / GROUND_PERIODS
    return w**2 * u, w * u
