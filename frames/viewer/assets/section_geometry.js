// Where the bodies of a bearing are in a vertical section; as frames/results/bearing_geometry.py has it.
"use strict";

const SectionGeometry = (() => {
  const ARC = 61;

  const sagitta = (radius, half) => radius - Math.sqrt(radius * radius - half * half);
  const plus = (a, b, times) => [a[0] + times * b[0], a[1] + times * b[1]];

  // A vector in space, in the plane along a horizontal unit vector, of length one.
  function inPlane([x, y, z], [dx, dy]) {
    const along = x * dx + y * dy;
    const size = Math.hypot(along, z);
    return [along / size, z / size];
  }

  // A unit vector that points upwards, from its horizontal parts.
  const upright = (x, y) => [x, y, Math.sqrt(Math.max(0, 1 - x * x - y * y))];

  // Axes, slip and opening in the plane, from what the payload holds of a bearing at an instant.
  function posture(state, direction) {
    const axis = inPlane(upright(...state.sliderAxis), direction);
    const plateAxis = inPlane(upright(...state.plateAxis), direction);
    const across = [axis[1], -axis[0]];
    const part = ([x, y, z], [u, w]) => (x * direction[0] + y * direction[1]) * u + z * w;
    const lift = Math.max(0, part(state.opening, axis));
    return { axis, plateAxis, across, slip: part(state.slip, across), lift, aside: part(state.opening, across) };
  }

  // Points that fix the bodies, from the vertex of the bottom surface [m].
  function contactPoints(device, now) {
    const [bottomRadius, topRadius] = device.radii;
    const bottom = plus([0, bottomRadius], now.axis, -bottomRadius);
    const middle = plus(bottom, now.axis, device.planeHeight);
    const middleTop = plus(middle, now.across, now.slip);
    const top = plus(middleTop, now.axis, device.sliderHeight - device.planeHeight);
    const centreTop = plus(plus(top, now.axis, now.lift - topRadius), now.across, now.aside);
    return { bottom, middle, middleTop, top, vertex: plus(centreTop, now.plateAxis, topRadius) };
  }

  // Angle of the slider against the axis of a plate, positive to the right in that plate's axes.
  function turn(now, surface) {
    const plate = surface === 0 ? [0, 1] : now.plateAxis;
    const cross = plate[0] * now.axis[1] - plate[1] * now.axis[0];
    const angle = Math.atan2(cross, plate[0] * now.axis[0] + plate[1] * now.axis[1]);
    return surface === 0 ? angle : -angle;
  }

  // Distance from the slider's edge to the nearer rim face; negative where the rim is pressed in.
  function rimGap(device, now, surface) {
    const radius = device.radii[surface];
    const edge = radius * Math.sin(Math.abs(turn(now, surface)) + Math.asin(device.sliderRadius / radius));
    return device.rimFaces[surface] - edge;
  }

  function arc(radius, left, right, count) {
    return Array.from({ length: count }, (_, k) => {
      const x = left + ((right - left) * k) / (count - 1);
      return [x, sagitta(radius, x)];
    });
  }

  function plate(device, now, surface) {
    const radius = device.radii[surface];
    const face = device.rimFaces[surface];
    const hasRim = face !== null;
    const half = hasRim ? face : device.reach;
    const pressed = hasRim ? Math.max(0, -rimGap(device, now, surface)) : 0;
    const tilt = turn(now, surface);
    const left = half + (tilt < 0 ? pressed : 0);
    const right = half + (tilt > 0 ? pressed : 0);
    const outer = half + 0.3 * device.sliderHeight;
    const crown = sagitta(radius, half) + (hasRim ? device.rimHeight : 0);
    const below = -0.35 * device.sliderHeight;
    const surfaceLine = arc(radius, -left, right, 2 * ARC);
    const body = [[right, crown], [outer, crown], [outer, below], [-outer, below], [-outer, crown], [-left, crown]];
    const side = tilt < 0 ? -1 : 1;
    const at = side < 0 ? -left : right;
    return {
      outline: [...surfaceLine, ...body],
      rim: [[at, Math.min(sagitta(radius, half), crown)], [at, crown]],
    };
  }

  // Points of a body whose own axis is `up`, placed at a point; mirrored where it hangs.
  function placed(points, up, at, mirrored) {
    const sign = mirrored ? -1 : 1;
    return points.map(([x, z]) => [
      at[0] + x * up[1] + sign * z * up[0],
      at[1] - x * up[0] + sign * z * up[1],
    ]);
  }

  // Outlines of the four bodies, faces that touch or may, rims at the side of the slider [m].
  function bodies(device, now) {
    const points = contactPoints(device, now);
    const half = device.sliderRadius;
    const upper = device.sliderHeight - device.planeHeight;
    const low = arc(device.radii[0], -half, half, ARC);
    const high = arc(device.radii[1], -half, half, ARC);
    const plates = [plate(device, now, 0), plate(device, now, 1)];
    const overlap = [Math.max(-half, now.slip - half), Math.min(half, now.slip + half)];
    return {
      points,
      bottomPlate: plates[0].outline,
      topPlate: placed(plates[1].outline, now.plateAxis, points.vertex, true),
      bottomSlider: placed([...low, [half, device.planeHeight], [-half, device.planeHeight]], now.axis, points.bottom),
      topSlider: placed([...high, [half, upper], [-half, upper]], now.axis, points.top, true),
      bottomFace: placed(low, now.axis, points.bottom),
      topFace: placed(high, now.axis, points.top, true),
      interface: overlap.map((x) => plus(points.middle, now.across, x)),
      rims: [plates[0].rim, placed(plates[1].rim, now.plateAxis, points.vertex, true)],
    };
  }

  return { posture, bodies };
})();
