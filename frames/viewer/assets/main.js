// The page put together: what is chosen, the time, and who draws what.
"use strict";

(() => {
  const byId = (id) => document.getElementById(id);
  const canvasOf = (id) => document.querySelector(`#${id} canvas`);
  const content = Payload.read();
  const { bearings, devices, time } = content;
  const count = devices.length;
  const clock = Clock.make(time);

  // What all views read: the time, the chosen bearing, its state and its histories.
  const view = {
    time,
    first: clock.first,
    last: clock.last,
    now: clock.now,
    place: Payload.placeOf(time, clock.now),
    bearing: content.worst,
    zoom: "whole",
    plane: "along",
    contacts: bearings.contacts,
  };

  view.device = () => devices[view.bearing];
  view.extreme = (name) => content.peaks[name][view.bearing];
  view.peak = (name) => view.extreme(name)[0];
  view.setTime = (t) => {
    clock.playing = false;
    clock.set(t);
  };
  view.setStep = (step) => view.setTime(time[step]);

  view.stateOf = (k) => {
    const of = (name, width) => Payload.rowAt(bearings[name], view.place, k * width, width);
    const nearest = view.place.step + (view.place.share > 0.5 ? 1 : 0);
    const bits = bearings.contacts[nearest * count + k];
    return {
      displacement: of("displacement", 3), force: of("force", 2), axialForce: of("axial_force", 1)[0],
      sliderAxis: of("slider_axis", 2), plateAxis: of("plate_axis", 2), slip: of("slip", 3), gap: of("gap", 1)[0], opening: of("opening", 3),
      rimForce: of("rim_force", 2),
      rims: [(bits & 1) > 0, (bits & 2) > 0], slips: (bits & 4) > 0, lifted: (bits & 8) > 0,
    };
  };
  view.bearingNow = () => view.stateOf(view.bearing);

  const histories = new Map();
  view.series = () => {
    if (!histories.has(view.bearing)) histories.set(view.bearing, seriesOf(view.bearing));
    return histories.get(view.bearing);
  };

  function seriesOf(k) {
    const column = (values, width, c) => Float64Array.from(time, (_, step) => values[(step * count + k) * width + c]);
    const displacement = [0, 1].map((c) => column(bearings.displacement, 3, c));
    const heights = column(bearings.displacement, 3, 2);
    const steps = time.length;
    return {
      displacement,
      force: [0, 1].map((c) => column(bearings.force, 2, c)),
      sizes: displacement[0].map((x, step) => Math.hypot(x, displacement[1][step])),
      rise: heights.reduce((a, b) => Math.max(a, b), 0),
      touches: (step) => (bearings.contacts[step * count + k] & 3) > 0,
      planes: Section.planes({ steps, displacement: (step) => [displacement[0][step], displacement[1][step]] }),
    };
  }

  Object.defineProperty(view, "rise", { get: () => view.series().rise });
  view.direction = () => {
    if (view.plane === "x") return [1, 0];
    if (view.plane === "y") return [0, 1];
    return Section.directionAt(view.series().planes, view.place);
  };
  view.across = () => {
    const [dx, dy] = view.direction();
    const { displacement } = view.bearingNow();
    return displacement[1] * dx - displacement[0] * dy;
  };

  function loopDirection() {
    const chosen = byId("loop-direction").value;
    if (chosen !== "far") return chosen === "x" ? [1, 0] : [0, 1];
    const { displacement: [xs, ys], sizes } = view.series();
    const far = sizes.indexOf(sizes.reduce((a, b) => Math.max(a, b), 0));
    return sizes[far] > 0 ? [xs[far] / sizes[far], ys[far] / sizes[far]] : [1, 0];
  }

  function chosenResponse() {
    const quantity = content.responses[Number(byId("quantity").value)];
    return { quantity, place: Number(byId("place").value), axis: Number(byId("axis").value) };
  }

  content.largest = content.peaks.displacement.reduce((most, [size]) => Math.max(most, size), 0);
  const model = Model.make(canvasOf("model"), content, view, choose);
  const figures = {
    section: Section.make(canvasOf("section"), view),
    loop: Plots.loop(canvasOf("loop"), view, loopDirection),
    orbit: Plots.orbit(canvasOf("orbit"), view),
    response: Plots.response(canvasOf("response"), view, chosenResponse),
    timeline: Timeline.make(byId("timeline"), view),
  };

  function draw() {
    Object.values(figures).forEach((figure) => figure.draw());
    model.update();
    Tables.readings(byId("readings"), view);
    byId("now").textContent = `${view.now.toFixed(3)} s`;
    byId("response-said").textContent = saidOf(chosenResponse());
    byId("timeline").setAttribute("aria-valuenow", view.now.toFixed(3));
    byId("play").textContent = clock.playing ? "❚❚" : "▶";
    byId("play").setAttribute("aria-label", clock.playing ? "pause" : "play");
  }

  // A response now, and its largest: extremes of each curve are among the steps kept.
  function saidOf({ quantity, place, axis }) {
    const places = quantity.places.length;
    const value = (step) => quantity.factor * quantity.values[(step * places + place) * 2 + axis];
    let far = 0;
    for (let step = 1; step < time.length; step++) if (Math.abs(value(step)) > Math.abs(value(far))) far = step;
    const now = value(view.place.step) + view.place.share * (value(view.place.step + 1) - value(view.place.step));
    const digits = Math.abs(value(far)) < 10 ? 3 : 1;
    const text = (number) => `${Figure.said(number, digits)} ${quantity.unit}`;
    return `${quantity.places[place]}: ${text(now)} now, largest ${text(value(far))} at ${time[far].toFixed(2)} s`;
  }

  function choose(k) {
    view.bearing = k;
    byId("bearing").value = String(k);
    draw();
  }

  clock.listen(() => {
    view.now = clock.now;
    view.place = Payload.placeOf(time, clock.now);
    draw();
  });

  function options(select, texts) {
    select.replaceChildren(...texts.map((text, k) => new Option(text, String(k))));
  }

  // The largest over all bearings, by a quantity of which there may be two; [value, time, bearing].
  function largestOf(...names) {
    return names.flatMap((name) => content.peaks[name].map(([value, at], k) => [value, at, k]))
      .reduce((most, one) => (one[0] > most[0] ? one : most));
  }

  function goTo([, at, k]) {
    view.bearing = k;
    byId("bearing").value = String(k);
    view.setTime(at);
  }

  function head() {
    byId("title").textContent = content.title;
    const { message, ...facts } = content.facts;
    byId("facts").textContent = Object.entries(facts).map(([name, text]) => `${name}: ${text}`).join(" · ");
    const said = [...(message ? [message] : []), ...content.warnings];
    byId("warnings").replaceChildren(...said.map((text) => {
      const paragraph = document.createElement("p");
      paragraph.textContent = text;
      return paragraph;
    }));
    Figure.legend(byId("model-legend"), [
      ["member", "model"], ["faint", "at rest"], ["rim", "rim contact"], ["slip", "interface slides"], ["gap", "lifted"],
      ...(model.bodySize > 1.05 ? [["plate", `bearings drawn × ${model.bodySize.toFixed(1)}`]] : []),
    ]);
    Figure.legend(byId("section-legend"), [
      ["touch", "surfaces in contact"], ["rim", "rim contact"], ["slip", "interface slides"], ["gap", "gap of uplift"],
    ]);
    Figure.legend(byId("orbit-legend"), [["rim", "rim contact; dashed circle: rims without slip"], ["soft", "dotted: the cut"]]);
    Figure.legend(byId("loop-legend"), [["rim", "rim contact"]]);
    Tables.checks(byId("checks"), content.checks, choose);
    Tables.kept(byId("kept"), content.kept);
  }

  function controls() {
    options(byId("bearing"), devices.map((device) => device.name));
    options(byId("quantity"), content.responses.map((one) => one.name));
    byId("bearing").value = String(view.bearing);
    byId("bearing").addEventListener("change", (event) => choose(Number(event.target.value)));
    const places = () => {
      const { quantity } = chosenResponse();
      options(byId("place"), quantity.places);
      byId("place").value = String(quantity.places.length - 1);
      byId("place").hidden = quantity.places.length < 2;
    };
    places();
    byId("quantity").addEventListener("change", () => { places(); draw(); });
    ["place", "axis", "loop-direction"].forEach((id) => byId(id).addEventListener("change", draw));
    ["plane", "zoom"].forEach((id) => byId(id).addEventListener("change", (event) => {
      view[id] = event.target.value;
      draw();
    }));
    const factor = byId("factor");
    Object.assign(factor, { min: 0, max: 2, step: 0.01 });
    const sayFactor = () => { byId("factor-said").textContent = String(model.factor); };
    factor.value = String(Math.log10(model.factor));
    factor.addEventListener("input", () => {
      model.setFactor(Number((10 ** Number(factor.value)).toPrecision(2)));
      sayFactor();
    });
    sayFactor();
    byId("home").addEventListener("click", model.home);
    byId("play").addEventListener("click", clock.toggle);
    byId("speed").addEventListener("change", (event) => { clock.speed = Number(event.target.value); });
    const rim = largestOf("rimBottom", "rimTop");
    byId("to-rim").hidden = !(rim[0] > 0);
    byId("to-rim").addEventListener("click", () => goTo(rim));
    byId("to-far").addEventListener("click", () => goTo(largestOf("displacement")));
    byId("timeline").setAttribute("aria-valuemax", clock.last.toFixed(3));
    document.addEventListener("keydown", onKey);
  }

  function onKey(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.target.closest("select, input, summary")) return;
    const act = {
      " ": () => clock.toggle(),
      ArrowLeft: () => (event.shiftKey ? view.setTime(clock.now - 1) : clock.step(-1)),
      ArrowRight: () => (event.shiftKey ? view.setTime(clock.now + 1) : clock.step(1)),
      Home: () => view.setTime(clock.first),
      End: () => view.setTime(clock.last),
    }[event.key];
    if (!act || (event.key === " " && event.target.closest("button"))) return;
    event.preventDefault();
    act();
  }

  head();
  controls();
  draw();
  window.view = { content, clock, view, model, figures }; // for a console, and for tests
})();
