// The time of the whole run as a strip: displacement of the bearing, contacts as marks, the time now.
"use strict";

const Timeline = (() => {
  const { colour } = Figure;

  function make(element, view) {
    const figure = Figure.on(element.querySelector("canvas"), (context, width, height) => {
      const { time } = view;
      const last = time.length - 1;
      const x = (t) => 6 + ((t - time[0]) / (time[last] - time[0])) * (width - 12);
      const sizes = view.series().sizes;
      const largest = Math.max(...sizes) || 1;
      const floor = height - 12;
      context.beginPath();
      context.moveTo(x(time[0]), floor);
      sizes.forEach((size, k) => context.lineTo(x(time[k]), floor - (size / largest) * (floor - 3)));
      context.lineTo(x(time[last]), floor);
      context.fillStyle = colour("faint");
      context.fill();
      marks(context, view, x, floor);
      const now = x(view.now);
      Figure.line(context, [[now, 0], [now, height]], colour("ink"), 1.5);
      Figure.dot(context, now, floor + 1, 6, colour("accent"));
    });
    const canvas = element.querySelector("canvas");
    Plots.onPress(canvas, (px) => {
      const share = (px - 6) / (canvas.getBoundingClientRect().width - 12);
      view.setTime(view.first + share * (view.last - view.first));
    });
    return figure;
  }

  // Below the strip: where a rim of any bearing is touched or one has lifted; strong for the chosen one.
  function marks(context, view, x, floor) {
    const { contacts, time } = view;
    const count = contacts.shape[1];
    for (let step = 0; step < time.length; step++) {
      let any = 0;
      for (let k = 0; k < count; k++) any |= contacts[step * count + k];
      const own = contacts[step * count + view.bearing];
      const [from, to] = [x(time[step]), x(time[Math.min(step + 1, time.length - 1)])];
      [[1 | 2, "rim", 2], [8, "gap", 7]].forEach(([bits, name, below]) => {
        if (!(any & bits)) return;
        context.globalAlpha = own & bits ? 1 : 0.4;
        context.fillStyle = colour(name);
        context.fillRect(from, floor + below, Math.max(to - from, 1.5), 4);
      });
    }
    context.globalAlpha = 1;
  }

  return { make };
})();
