// Tables of the page: the chosen bearing now and at its largest, the checks, what was kept.
"use strict";

const Tables = (() => {
  const FEW = 12; // checks that are shown before all are asked for

  function cell(tag, content, name) {
    const found = document.createElement(tag);
    found.append(content);
    if (name) found.className = name;
    return found;
  }

  function row(cells, name) {
    const found = document.createElement("tr");
    if (name) found.className = name;
    found.append(...cells);
    return found;
  }

  const mm = (value) => `${Figure.said(1e3 * value, 1)} mm`;
  const kN = (value) => `${Figure.said(1e-3 * value, 1)} kN`;

  // Quantities of a bearing: title, value now, how it is said, extreme, what it is compared with, mark.
  function quantities(state, device, peak) {
    const found = [
      ["displacement", Math.hypot(state.displacement[0], state.displacement[1]), mm, "displacement",
        device.capacity === null ? "no rims" : `rims at ${mm(device.capacity)} without slip`, ""],
      ["horizontal force", Math.hypot(...state.force), kN, "force", "", ""],
      ["axial force", state.axialForce, kN, "axial", `least ${kN(peak("axialLeast")[0])}`, ""],
      ["bottom rim", state.rimForce[0], kN, "rimBottom", "", state.rims[0] ? "is-rim" : ""],
      ["top rim", state.rimForce[1], kN, "rimTop", "", state.rims[1] ? "is-rim" : ""],
      ["gap of uplift", state.gap, mm, "gap", "", state.lifted ? "is-gap" : ""],
    ];
    const overlap = device.slipCapacity === null ? "" : `overlap ends at ${mm(device.slipCapacity)}`;
    if (!device.rigid) {
      found.splice(3, 0, ["interface slip", Math.hypot(...state.slip), mm, "slip", overlap, state.slips ? "is-slip" : ""]);
    }
    return found;
  }

  function readings(table, view) {
    const rows = quantities(view.bearingNow(), view.device(), view.extreme).map(([title, now, said, name, beside, mark]) => {
      const [value, time] = view.extreme(name);
      const there = document.createElement("button");
      there.type = "button";
      there.textContent = `${said(value)} at ${time.toFixed(2)} s`;
      there.addEventListener("click", () => view.setTime(time));
      return row([cell("td", title), cell("td", said(now), mark), cell("td", there), cell("td", beside)]);
    });
    const head = row(["", "now", "largest", ""].map((text) => cell("th", text)));
    table.replaceChildren(head, ...rows);
  }

  const order = { FAILS: 0, "no value": 1, "needs agreement": 2, "does not apply": 3, raised: 4, "no limit": 5, ok: 6 };

  function checks(panel, list, choose) {
    panel.hidden = list.length === 0;
    const sorted = [...list].sort((a, b) => order[a.verdict] - order[b.verdict] || b.rank - a.rank);
    const count = (verdict) => list.filter((check) => check.verdict === verdict).length;
    const [fail, unknown] = [count("FAILS"), count("no value")];
    const failed = fail + unknown;
    const tally = panel.querySelector("#tally");
    const without = unknown ? `, ${unknown} without a valid value` : "";
    tally.textContent = `${list.length} checks, ${fail} failed${without}; governing ones first`;
    tally.classList.toggle("bad", failed > 0);
    const table = panel.querySelector("table");
    const all = panel.querySelector("#all-checks");
    const show = (count) => {
      const head = row(["", "check", "concerns", "demand", "", "limit", "ratio", "clause"].map((text) => cell("th", text)));
      table.replaceChildren(head, ...sorted.slice(0, count).map((check) => line(check, choose)));
      all.hidden = count >= sorted.length;
    };
    all.textContent = `show all ${list.length} checks`;
    all.addEventListener("click", () => show(sorted.length));
    show(Math.max(FEW, failed));
  }

  function line(check, choose) {
    const title = cell("td", check.title);
    if (check.note) title.append(cell("small", check.note));
    let concerns = check.concerns;
    if (check.bearing !== null) {
      concerns = document.createElement("button");
      concerns.type = "button";
      concerns.textContent = check.concerns;
      concerns.addEventListener("click", () => choose(check.bearing));
    }
    return row([
      cell("td", check.verdict), title, cell("td", concerns), cell("td", check.demand), cell("td", { "<=": "≤", ">=": "≥" }[check.relation]),
      cell("td", check.limit), cell("td", check.ratio), cell("td", check.clause),
    ], { FAILS: "FAILS", "no value": "FAILS", ok: "ok" }[check.verdict] ?? "beyond");
  }

  function kept(element, said) {
    const paragraph = (text) => cell("p", text);
    const percent = (share) => `${(100 * share).toPrecision(2)} %`;
    const parts = [];
    if (said.steps === said.recorded) {
      parts.push(paragraph(`All ${said.recorded} recorded steps.`));
    } else {
      const errors = Object.entries(said.errors).map(([name, error]) => `${name} ${percent(error)}`);
      parts.push(paragraph(`${said.steps} of ${said.recorded} recorded steps. Kept are the ends, the extremes of each curve, ` +
        "and then, one after the other, the step that lies farthest off the line between its kept neighbours; where a rim is " +
        "touched or a bearing has lifted (and 20 ms around) the distance counts four times. Between kept steps curves " +
        `are straight; they miss the recorded ones by at most, over the largest value: ${errors.join(", ")}.`));
    }
    parts.push(paragraph("Each history is kept in 16 bits, to 0.0015 % of its largest value; displacements of nodes as a sum " +
      `of shapes, to ${Figure.said(1e3 * said.shapeError, 2)} mm. Largest values, their times and the checks are those of the run itself.`));
    element.replaceChildren(...parts);
  }

  return { readings, checks, kept };
})();
