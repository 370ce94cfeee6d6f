// Drawing on a canvas: its size in pixels of the screen, colours of the theme, axes with round numbers.
"use strict";

const Figure = (() => {
  const SMALL = "12px system-ui, sans-serif";

  const found = new Map(); // colours of the theme that holds

  function colour(name) {
    if (!found.has(name)) {
      found.set(name, getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim());
    }
    return found.get(name);
  }

  // A canvas that is drawn anew where its size or the theme changes; draw(context, width, height).
  function on(canvas, draw) {
    const figure = { canvas, width: 0, height: 0 };
    figure.draw = () => {
      const box = canvas.parentElement.getBoundingClientRect();
      const ratio = window.devicePixelRatio || 1;
      figure.width = box.width;
      figure.height = box.height;
      if (!figure.width || !figure.height) return;
      const [wide, high] = [Math.round(box.width * ratio), Math.round(box.height * ratio)];
      if (canvas.width !== wide || canvas.height !== high) {
        canvas.width = wide;
        canvas.height = high;
      }
      const context = canvas.getContext("2d");
      context.setTransform(ratio, 0, 0, ratio, 0, 0);
      context.clearRect(0, 0, figure.width, figure.height);
      context.font = SMALL;
      draw(context, figure.width, figure.height);
    };
    new ResizeObserver(figure.draw).observe(canvas.parentElement);
    onTheme(figure.draw);
    return figure;
  }

  const dark = window.matchMedia("(prefers-color-scheme: dark)");
  dark.addEventListener("change", () => found.clear());

  function onTheme(act) {
    dark.addEventListener("change", act);
  }

  // Round numbers from low to high, some `count` of them.
  function ticks(low, high, count) {
    const rough = (high - low) / Math.max(count, 1);
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = power * [1, 2, 5, 10].find((factor) => factor * power >= rough * 0.999);
    const found = [];
    for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) found.push(k * step);
    return { found, digits: Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) };
  }

  function said(value, digits) {
    return value.toFixed(digits).replace(/^-(0(\.0*)?)$/, "$1").replace("-", "−");
  }

  // Axes of a plot: from data to pixels and back, drawn with grid and titles.
  function axes(context, width, height, limits, titles, equal) {
    const edge = { left: 56, right: 10, top: 8, bottom: 36 };
    let [x0, x1, y0, y1] = limits;
    const [across, up] = [width - edge.left - edge.right, height - edge.top - edge.bottom];
    if (equal) {
      const scale = Math.max((x1 - x0) / across, (y1 - y0) / up);
      const [cx, cy] = [(x0 + x1) / 2, (y0 + y1) / 2];
      [x0, x1] = [cx - (scale * across) / 2, cx + (scale * across) / 2];
      [y0, y1] = [cy - (scale * up) / 2, cy + (scale * up) / 2];
    }
    const x = (value) => edge.left + ((value - x0) / (x1 - x0)) * across;
    const y = (value) => edge.top + (1 - (value - y0) / (y1 - y0)) * up;
    const marks = [ticks(x0, x1, across / 75), ticks(y0, y1, up / 42)];
    context.lineWidth = 1;
    context.fillStyle = colour("soft");
    marks[0].found.forEach((value) => {
      line(context, [[x(value), edge.top], [x(value), edge.top + up]], value === 0 ? colour("faint") : colour("line"), 1);
      context.textAlign = "center";
      context.textBaseline = "top";
      context.fillText(said(value, marks[0].digits), x(value), edge.top + up + 4);
    });
    marks[1].found.forEach((value) => {
      line(context, [[edge.left, y(value)], [edge.left + across, y(value)]], value === 0 ? colour("faint") : colour("line"), 1);
      context.textAlign = "right";
      context.textBaseline = "middle";
      context.fillText(said(value, marks[1].digits), edge.left - 6, y(value));
    });
    context.textAlign = "center";
    context.textBaseline = "bottom";
    context.fillText(titles[0], edge.left + across / 2, height - 1);
    context.save();
    context.translate(11, edge.top + up / 2);
    context.rotate(-Math.PI / 2);
    context.textBaseline = "middle";
    context.fillText(titles[1], 0, 0);
    context.restore();
    return {
      x, y, box: [edge.left, edge.top, across, up],
      back: (px) => x0 + ((px - edge.left) / across) * (x1 - x0),
    };
  }

  function line(context, points, stroke, width) {
    context.beginPath();
    points.forEach(([px, py], k) => (k ? context.lineTo(px, py) : context.moveTo(px, py)));
    context.strokeStyle = stroke;
    context.lineWidth = width;
    context.stroke();
  }

  function dot(context, px, py, radius, fill) {
    context.beginPath();
    context.arc(px, py, radius, 0, 2 * Math.PI);
    context.fillStyle = fill;
    context.fill();
    context.strokeStyle = colour("panel");
    context.lineWidth = 1.5;
    context.stroke();
  }

  // Limits with a margin around values, never empty.
  function around(values) {
    let low = Infinity;
    let high = -Infinity;
    for (const value of values) {
      if (value < low) low = value;
      if (value > high) high = value;
    }
    const margin = 0.06 * (high - low) || Math.max(1e-9, 0.1 * Math.abs(high));
    return [low - margin, high + margin];
  }

  function legend(element, entries) {
    element.replaceChildren(...entries.map(([name, text]) => {
      const entry = document.createElement("span");
      const mark = document.createElement("i");
      mark.style.background = `var(--${name})`;
      entry.append(mark, text);
      return entry;
    }));
  }

  return { on, onTheme, colour, axes, line, dot, around, said, legend };
})();
