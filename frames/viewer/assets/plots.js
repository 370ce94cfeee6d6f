// Plots that share the time: loop, orbit, response. What is past is drawn strong, a click sets the time.
"use strict";

const Plots = (() => {
  const { colour } = Figure;

  // A curve in a plane: all of it faint, the part up to now strong, rim contacts in their colour.
  function curve(context, axes, xs, ys, view, contact) {
    const point = (k) => [axes.x(xs[k]), axes.y(ys[k])];
    const every = Array.from(xs, (_, k) => point(k));
    context.save();
    context.beginPath();
    context.rect(...axes.box);
    context.clip();
    Figure.line(context, every, colour("faint"), 1);
    const past = every.slice(0, view.place.step + 1);
    const here = [axes.x(at(xs, view.place)), axes.y(at(ys, view.place))];
    Figure.line(context, [...past, here], colour("accent"), 1.4);
    context.beginPath();
    every.forEach((there, k) => (k > 0 && contact(k) && contact(k - 1) ? context.lineTo(...there) : context.moveTo(...there)));
    context.strokeStyle = colour("rim");
    context.lineWidth = 2;
    context.stroke();
    Figure.dot(context, ...here, 5, colour("ink"));
    context.restore();
    return every;
  }

  const at = (values, place) => values[place.step] + place.share * (values[place.step + 1] - values[place.step]);

  // The kept step whose point is nearest to a click.
  function nearest(points, px, py) {
    let best = 0;
    let least = Infinity;
    points.forEach(([x, y], k) => {
      const away = (x - px) ** 2 + (y - py) ** 2;
      if (away < least) [least, best] = [away, k];
    });
    return best;
  }

  function onPress(canvas, act) {
    const press = (event) => {
      const box = canvas.getBoundingClientRect();
      act(event.clientX - box.left, event.clientY - box.top);
    };
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      press(event);
    });
    canvas.addEventListener("pointermove", (event) => event.buttons === 1 && press(event));
  }

  function loop(canvas, view, direction) {
    let drawn = [];
    const figure = Figure.on(canvas, (context, width, height) => {
      const [dx, dy] = direction();
      const series = view.series();
      const along = (pair, scale) => Float64Array.from(pair[0], (x, k) => scale * (x * dx + pair[1][k] * dy));
      const xs = along(series.displacement, 1e3);
      const ys = along(series.force, 1e-3);
      const limits = [...Figure.around(xs), ...Figure.around(ys)];
      const axes = Figure.axes(context, width, height, limits, ["displacement [mm]", "force [kN]"]);
      drawn = curve(context, axes, xs, ys, view, series.touches);
    });
    onPress(canvas, (x, y) => view.setStep(nearest(drawn, x, y)));
    return figure;
  }

  function orbit(canvas, view) {
    let drawn = [];
    const figure = Figure.on(canvas, (context, width, height) => {
      const series = view.series();
      const [xs, ys] = series.displacement.map((values) => Float64Array.from(values, (value) => 1e3 * value));
      const { capacity } = view.device();
      const reach = capacity === null ? 0 : 1e3 * capacity;
      const limits = [...Figure.around([...xs, -reach, reach]), ...Figure.around([...ys, -reach, reach])];
      const axes = Figure.axes(context, width, height, limits, ["x [mm]", "y [mm]"], true);
      if (reach > 0) {
        context.setLineDash([6, 4]);
        const round = Array.from({ length: 121 }, (_, k) => [
          axes.x(reach * Math.cos((k * Math.PI) / 60)), axes.y(reach * Math.sin((k * Math.PI) / 60))]);
        Figure.line(context, round, colour("rim"), 1.2);
        context.setLineDash([]);
      }
      const direction = view.direction();
      const far = 2 * Math.max(...limits.map(Math.abs));
      context.save();
      context.beginPath();
      context.rect(...axes.box);
      context.clip();
      context.setLineDash([2, 4]);
      Figure.line(context, [-far, far].map((size) => [axes.x(size * direction[0]), axes.y(size * direction[1])]),
        colour("soft"), 1);
      context.setLineDash([]);
      context.restore();
      drawn = curve(context, axes, xs, ys, view, series.touches);
      figure.axes = axes;
    });
    onPress(canvas, (x, y) => view.setStep(nearest(drawn, x, y)));
    return figure;
  }

  // One quantity over time: the chosen place strong, the others faint.
  function response(canvas, view, chosen) {
    let axes = null;
    const figure = Figure.on(canvas, (context, width, height) => {
      const { quantity, place, axis } = chosen();
      const count = quantity.places.length;
      const value = (step, k) => quantity.factor * quantity.values[(step * count + k) * 2 + axis];
      const time = view.time;
      let [low, high] = [0, 0];
      for (let step = 0; step < time.length; step++) {
        for (let k = 0; k < count; k++) {
          low = Math.min(low, value(step, k));
          high = Math.max(high, value(step, k));
        }
      }
      const limits = [time[0], time[time.length - 1], ...Figure.around([low, high])];
      axes = Figure.axes(context, width, height, limits, ["time [s]", `${quantity.name} [${quantity.unit}]`]);
      for (let k = 0; k < count; k++) if (k !== place) trace(context, axes, time, (step) => value(step, k), "faint", 0.8);
      trace(context, axes, time, (step) => value(step, place), "accent", 1.3);
      const [left, top, , tall] = axes.box;
      const now = axes.x(view.now);
      Figure.line(context, [[now, top], [now, top + tall]], colour("ink"), 1);
      const there = value(view.place.step, place);
      const next = value(view.place.step + 1, place);
      Figure.dot(context, Math.max(now, left), axes.y(there + view.place.share * (next - there)), 4, colour("ink"));
    });
    onPress(canvas, (x) => axes && view.setTime(axes.back(x)));
    return figure;
  }

  function trace(context, axes, time, value, name, width) {
    context.beginPath();
    for (let step = 0; step < time.length; step++) context.lineTo(axes.x(time[step]), axes.y(value(step)));
    context.strokeStyle = colour(name);
    context.lineWidth = width;
    context.stroke();
  }

  return { loop, orbit, response, onPress };
})();
