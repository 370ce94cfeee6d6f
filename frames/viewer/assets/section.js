// One bearing cut open: its section to scale, with what touches in colour.
"use strict";

const Section = (() => {
  const HELD = 0.1; // of the largest displacement: below, the plane stays as it was
  const { colour } = Figure;

  // Horizontal direction of the displacement at each kept step, as an angle without jumps: the plane
  // turns with the orbit, and stays where the bearing passes near its centre.
  function planes(state) {
    const count = state.steps;
    const sizes = Array.from({ length: count }, (_, k) => Math.hypot(...state.displacement(k)));
    const small = HELD * Math.max(...sizes);
    const start = sizes.findIndex((size) => size > small);
    const angles = new Float64Array(count);
    if (start < 0 || small === 0) return angles;
    let angle = Math.atan2(state.displacement(start)[1], state.displacement(start)[0]);
    if (Math.abs(angle) > Math.PI / 2) angle -= Math.PI * Math.sign(angle);
    for (let k = 0; k < count; k++) {
      if (sizes[k] > small) {
        const [x, y] = state.displacement(k);
        const turned = Math.atan2(y, x) - angle;
        angle += turned - Math.PI * Math.round(turned / Math.PI);
      }
      angles[k] = angle;
    }
    return angles;
  }

  function directionAt(angles, place) {
    const [first, second] = [angles[place.step], angles[place.step + 1]];
    const angle = first + place.share * (second - first);
    return [Math.cos(angle), Math.sin(angle)];
  }

  function make(canvas, view) {
    const figure = Figure.on(canvas, (context, width, height) => draw(context, width, height, view));
    return figure;
  }

  // From metres to pixels: the whole bearing at all its displacements, or a window on the slider.
  function viewport(device, view, middle, width, height) {
    const plate = outer(device);
    const far = view.peak("displacement");
    const high = device.sliderHeight * 1.35 + Math.max(view.rise, 0) + 0.02;
    const low = -0.35 * device.sliderHeight - 0.02;
    if (view.zoom === "slider") {
      const scale = Math.min(width / (3.4 * device.sliderRadius), height / (1.9 * device.sliderHeight + view.peak("gap")));
      return { scale, left: width / 2 - scale * middle[0], base: height / 2 + scale * middle[1] };
    }
    const scale = Math.min(width / (2 * (plate + far) + 0.02), (height - 24) / (high - low));
    return { scale, left: width / 2, base: (height + 12 + scale * (high + low)) / 2 };
  }

  const outer = (device) => Math.max(...device.rimFaces.map((face) => face ?? device.reach)) + 0.3 * device.sliderHeight;

  function draw(context, width, height, view) {
    const state = view.bearingNow();
    const device = view.device();
    const direction = view.direction();
    const now = SectionGeometry.posture(state, direction);
    const bodies = SectionGeometry.bodies(device, now);
    const frame = viewport(device, view, bodies.points.middle, width, height);
    const to = ([x, z]) => [frame.left + frame.scale * x, frame.base - frame.scale * z];
    const fill = (outline, name) => {
      context.beginPath();
      outline.map(to).forEach((point, k) => (k ? context.lineTo(...point) : context.moveTo(...point)));
      context.closePath();
      context.fillStyle = colour(name);
      context.fill();
      context.strokeStyle = colour("edge");
      context.lineWidth = 1;
      context.stroke();
    };
    context.lineJoin = "round";
    fill(bodies.bottomPlate, "plate");
    fill(bodies.topPlate, "plate");
    fill(bodies.bottomSlider, "low");
    fill(bodies.topSlider, device.rigid ? "low" : "high");
    contacts(context, state, device, bodies, to);
    axisLine(context, bodies, to);
    rimLabels(context, state, bodies, to, width);
    frameText(context, view, direction, frame, width, height);
  }

  function contacts(context, state, device, bodies, to) {
    const stroke = (points, name, thick) => Figure.line(context, points.map(to), colour(name), thick);
    stroke(bodies.bottomFace, "touch", 2.5);
    stroke(bodies.topFace, state.lifted ? "gap" : "touch", state.lifted ? 3.5 : 2.5);
    if (!device.rigid && bodies.interface[0] !== bodies.interface[1]) {
      stroke(bodies.interface, state.slips ? "slip" : "edge", state.slips ? 4 : 2);
    }
    state.rims.forEach((touched, k) => touched && stroke(bodies.rims[k], "rim", 6));
  }

  function axisLine(context, bodies, to) {
    const { bottom, middle, middleTop, top } = bodies.points;
    context.setLineDash([7, 3, 1, 3]);
    Figure.line(context, [bottom, middle].map(to), colour("edge"), 1);
    Figure.line(context, [middleTop, top].map(to), colour("edge"), 1);
    context.setLineDash([]);
  }

  // Each rim that is touched, with its force, beside the plates.
  function rimLabels(context, state, bodies, to, width) {
    context.font = "600 13px system-ui, sans-serif";
    state.rims.forEach((touched, k) => {
      if (!touched) return;
      const [x, y] = to(bodies.rims[k][1]);
      const text = `${k ? "top" : "bottom"} rim ${Figure.said(state.rimForce[k] / 1e3, 0)} kN`;
      const half = context.measureText(text).width / 2 + 4;
      const at = Math.min(Math.max(x, half), width - half);
      context.textAlign = "center";
      context.textBaseline = "middle";
      const level = k ? y - 46 : y + 46;
      context.fillStyle = colour("panel");
      context.globalAlpha = 0.85;
      context.fillRect(at - half, level - 10, 2 * half, 20);
      context.globalAlpha = 1;
      context.fillStyle = colour("rim");
      context.fillText(text, at, level);
    });
    context.font = "12px system-ui, sans-serif";
  }

  function frameText(context, view, direction, frame, width, height) {
    const bar = [500, 200, 100, 50, 20, 10].find((mm) => (mm / 1e3) * frame.scale < 0.3 * width);
    const long = (bar / 1e3) * frame.scale;
    context.fillStyle = colour("panel");
    context.fillRect(0, 0, width, 24);
    Figure.line(context, [[8, 12], [8 + long, 12]], colour("soft"), 3);
    context.fillStyle = colour("soft");
    context.textAlign = "left";
    context.textBaseline = "middle";
    context.fillText(`${bar} mm`, 14 + long, 12);
    const degrees = ((Math.round((Math.atan2(direction[1], direction[0]) * 180) / Math.PI) % 360) + 360) % 360;
    const across = view.across();
    const beside = Math.abs(across) > 1e-3 ? `, ${Figure.said(Math.abs(across) * 1e3, 0)} mm across it` : "";
    context.textAlign = "right";
    context.fillText(`to scale, cut at ${degrees}° from x${beside}`, width - 6, 12);
  }

  return { make, planes, directionAt };
})();
