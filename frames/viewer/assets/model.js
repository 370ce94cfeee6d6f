// The model in space: members that bend, floors, bearings with what goes on in them, the ground.
"use strict";

const Model = (() => {
  const LARGEST = 0.08; // drawn size of the largest displacement over the extent, to begin with
  const BODY = 0.03; // least radius of a bearing as drawn, over the extent of the model
  const NICE = [1, 2, 3, 5, 10, 20, 30, 50, 100, 200, 300, 500, 1000];
  const { colour } = Figure;

  function niceFactor(extent, largest) {
    const wanted = largest > 0 ? (LARGEST * extent) / largest : 1;
    return [...NICE].reverse().find((factor) => factor <= wanted) ?? 1;
  }

  // The box around all nodes, and around the plates of bearings in plan.
  function boundsOf({ structure, devices }) {
    const low = [Infinity, Infinity, Infinity];
    const high = [-Infinity, -Infinity, -Infinity];
    const include = (place, radius) => place.forEach((value, c) => {
      low[c] = Math.min(low[c], value - (c < 2 ? radius : 0));
      high[c] = Math.max(high[c], value + (c < 2 ? radius : 0));
    });
    for (let k = 0; k < structure.nodes.length; k += 3) include(structure.nodes.slice(k, k + 3), 0);
    structure.bearings.forEach(([i], k) => include(structure.nodes.slice(3 * i, 3 * i + 3), plateRadius(devices[k])));
    const middle = low.map((value, k) => (value + high[k]) / 2);
    return { low, high, middle, extent: Math.hypot(...low.map((value, k) => high[k] - value)) || 1 };
  }

  // Displacements of all nodes, six each, at a place among the kept steps.
  function movesAt(content, place, into) {
    const [count, width] = content.shapes.shape;
    const amounts = Payload.rowAt(content.shapeHistories, place, 0, count);
    into.fill(0);
    for (let r = 0; r < count; r++) {
      const amount = amounts[r];
      const start = r * width;
      for (let k = 0; k < width; k++) into[k] += amount * content.shapes[start + k];
    }
    return into;
  }

  // Points of all members' lines, pairs of them by segment, into an array of six numbers a segment.
  function memberSegments(members, moves, factor, into) {
    const [, stations] = members.bending.shape;
    const point = new Float64Array(3);
    for (let m = 0, at = 0; m < members.kind.length; m++) {
      const bending = members.kind[m] * stations * 36;
      const [one, two] = [6 * members.nodes[2 * m], 6 * members.nodes[2 * m + 1]];
      for (let s = 0; s < stations; s++) {
        const share = s / (stations - 1);
        for (let c = 0; c < 3; c++) {
          const row = bending + (s * 3 + c) * 12;
          let moved = 0;
          for (let k = 0; k < 6; k++) {
            moved += members.bending[row + k] * moves[one + k] + members.bending[row + 6 + k] * moves[two + k];
          }
          const start = members.ends[6 * m + c];
          point[c] = start + share * (members.ends[6 * m + 3 + c] - start) + factor * moved;
        }
        if (s > 0) for (let c = 0; c < 3; c++) into[at + c - 3] = point[c];
        if (s < stations - 1) {
          for (let c = 0; c < 3; c++) into[at + c] = point[c];
          at += 6;
        }
      }
    }
  }

  function fatLines(count, width) {
    const geometry = new THREE.LineSegmentsGeometry();
    geometry.setPositions(new Float32Array(6 * Math.max(count, 1)));
    const buffer = geometry.attributes.instanceStart.data;
    buffer.setUsage(THREE.DynamicDrawUsage);
    geometry.instanceCount = count;
    const lines = new THREE.LineSegments2(geometry, new THREE.LineMaterial({ linewidth: width }));
    lines.frustumCulled = false;
    return { lines, numbers: buffer.array, changed: () => { buffer.needsUpdate = true; } };
  }

  function thinLines(points) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(points, 3));
    return new THREE.LineSegments(geometry, new THREE.LineBasicMaterial());
  }

  // Members and pairs at rest, two points each.
  function atRest(structure) {
    const points = [...structure.members.ends];
    structure.pairs.flat().forEach((node) => points.push(...structure.nodes.slice(3 * node, 3 * node + 3)));
    return new Float32Array(points);
  }

  // Areas by the nodes around each, in one mesh.
  function areaMesh(areas, places) {
    const triangles = [], nodes = areas.flat();
    let first = 0;
    areas.forEach((around) => {
      for (let k = 1; k < around.length - 1; k++) triangles.push(first, first + k, first + k + 1);
      first += around.length;
    });
    const geometry = new THREE.BufferGeometry();
    const positions = new THREE.BufferAttribute(new Float32Array(3 * nodes.length), 3);
    positions.setUsage(THREE.DynamicDrawUsage);
    geometry.setAttribute("position", positions);
    geometry.setIndex(triangles);
    const mesh = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({
      transparent: true, opacity: 0.14, side: THREE.DoubleSide, depthWrite: false,
    }));
    mesh.frustumCulled = false;
    mesh.move = () => {
      nodes.forEach((node, k) => positions.setXYZ(k, places[3 * node], places[3 * node + 1], places[3 * node + 2]));
      positions.needsUpdate = true;
    };
    return mesh;
  }

  // Plates and sliders of all bearings: cylinders, one kind of body a mesh.
  function bearingBodies(content) {
    const upright = new THREE.CylinderGeometry(1, 1, 1, 40).rotateX(Math.PI / 2);
    const count = content.devices.length;
    const names = ["bottomPlate", "bottomSlider", "topSlider", "topPlate"];
    return Object.fromEntries(names.map((name) => {
      const mesh = new THREE.InstancedMesh(upright, new THREE.MeshLambertMaterial(), count);
      mesh.frustumCulled = false;
      return [name, mesh];
    }));
  }

  function make(canvas, content, view, said) {
    let renderer;
    try {
      renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true });
    } catch {
      const note = document.createElement("p");
      note.className = "missing";
      note.textContent = "The model is not shown: this browser has no WebGL. Switch hardware acceleration on, or open " +
        "the page in another browser. The other views work.";
      canvas.replaceWith(note);
      return { update() {}, home() {}, setFactor() {}, factor: 1, bodySize: 1 };
    }
    const scene = build(content);
    const camera = new THREE.PerspectiveCamera(32, 1, 0.05, 1e4);
    camera.up.set(0, 0, 1);
    const controls = new THREE.OrbitControls(camera, canvas);
    const model = { factor: niceFactor(scene.bounds.extent, content.largest), bodySize: scene.bodySize, scene };
    const render = () => renderer.render(scene.root, camera);

    model.home = () => {
      fit(camera, controls, scene.bounds, model.factor * content.largest);
      render();
    };
    model.update = () => {
      move(content, scene, view, model.factor);
      render();
    };
    model.setFactor = (factor) => {
      model.factor = factor;
      model.update();
    };
    model.onScreen = (k) => placeOnScreen(canvas, camera, scene.bodies.topPlate, k);
    const resize = () => {
      const box = canvas.parentElement.getBoundingClientRect();
      if (!box.width) return;
      renderer.setPixelRatio(window.devicePixelRatio || 1);
      renderer.setSize(box.width, box.height, false);
      camera.aspect = box.width / box.height;
      camera.updateProjectionMatrix();
      render();
    };
    const paint = () => {
      scene.paint();
      model.update();
    };
    controls.addEventListener("change", render);
    new ResizeObserver(resize).observe(canvas.parentElement);
    Figure.onTheme(paint);
    choose(canvas, camera, scene, said);
    resize();
    paint();
    model.home();
    return model;
  }

  function build(content) {
    const { structure } = content;
    const root = new THREE.Scene();
    const bounds = boundsOf(content);
    const stations = structure.members.bending.shape[1] || 2;
    const members = fatLines(structure.members.kind.length * (stations - 1), 2.2);
    const pairs = fatLines(structure.pairs.length, 1.4);
    const rest = thinLines(atRest(structure));
    const places = new Float64Array(structure.nodes.length);
    const floors = [...structure.floors.map((around) => [around]), structure.shells]
      .filter((areas) => areas.flat().length > 2).map((areas) => areaMesh(areas, places));
    const bodies = bearingBodies(content);
    const level = Math.min(...structure.bearings.map(([i]) => structure.nodes[3 * i + 2]), bounds.low[2]);
    const masses = massesOf(structure, bounds);
    const ring = new THREE.Mesh(new THREE.TorusGeometry(1, 0.035, 8, 60), new THREE.MeshBasicMaterial());
    const supports = supportsOf(structure, bounds);
    const thick = Math.max(...content.devices.map((one) => one.sliderHeight));
    const bodySize = sizeOfBodies(content, bounds);
    const ground = groundOf(bounds, level + thick - 1.35 * bodySize * thick);
    const sky = new THREE.HemisphereLight(0xffffff, 0x9aa4b0, 2.2);
    sky.position.set(0, 0, 1);
    const sun = new THREE.DirectionalLight(0xffffff, 1.3);
    sun.position.set(-1, -2, 3);
    root.add(sky, sun, ground, rest, members.lines, pairs.lines, supports, masses, ring);
    root.add(...floors, ...Object.values(bodies));
    const scene = { root, bounds, members, pairs, rest, places, floors, bodies, ring, masses };
    scene.moves = new Float64Array(content.shapes.shape[1]);
    scene.bodySize = bodySize;
    scene.paint = () => {
      members.lines.material.color.set(colour("member"));
      pairs.lines.material.color.set(colour("accent"));
      rest.material.color.set(colour("faint"));
      floors.forEach((floor) => floor.material.color.set(colour("accent")));
      ground.children.forEach((part) => part.material.color.set(colour(part.isMesh ? "ground" : "line")));
      supports.material.color.set(colour("soft"));
      masses.material.color.set(colour("touch"));
      ring.material.color.set(colour("accent"));
    };
    return scene;
  }

  function groundOf(bounds, level) {
    const side = 1.35 * Math.max(bounds.high[0] - bounds.low[0], bounds.high[1] - bounds.low[1], 0.4 * bounds.extent);
    const grid = new THREE.GridHelper(side, 16);
    grid.geometry.deleteAttribute("color");
    grid.material = new THREE.LineBasicMaterial();
    grid.rotateX(Math.PI / 2);
    const disc = new THREE.Mesh(new THREE.CylinderGeometry(side * 0.71, side * 0.71, 0.001, 64).rotateX(Math.PI / 2),
      new THREE.MeshBasicMaterial());
    disc.position.z = -0.004 * bounds.extent;
    const ground = new THREE.Group();
    ground.add(grid, disc);
    ground.position.set(bounds.middle[0], bounds.middle[1], level);
    return ground;
  }

  // Supports that are no bottom of a bearing: cones under their nodes.
  function supportsOf(structure, bounds) {
    const below = new Set(structure.bearings.map(([i]) => i));
    const held = structure.supports.filter((node) => !below.has(node));
    const size = 0.012 * bounds.extent;
    const cone = new THREE.ConeGeometry(size, 2 * size, 4).rotateX(Math.PI / 2).translate(0, 0, -size);
    const mesh = new THREE.InstancedMesh(cone, new THREE.MeshLambertMaterial(), held.length);
    held.forEach((node, k) => mesh.setMatrixAt(k, new THREE.Matrix4().setPosition(
      ...structure.nodes.slice(3 * node, 3 * node + 3))));
    return mesh;
  }

  function massesOf(structure, bounds) {
    const heavy = [...structure.masses.keys()].filter((node) => structure.masses[node] > 0);
    const ball = new THREE.SphereGeometry(0.008 * bounds.extent, 16, 12);
    const mesh = new THREE.InstancedMesh(ball, new THREE.MeshLambertMaterial(), heavy.length);
    mesh.frustumCulled = false;
    mesh.nodes = heavy;
    mesh.sizes = heavy.map((node) => Math.cbrt(structure.masses[node]));
    return mesh;
  }

  function move(content, scene, view, factor) {
    const { structure } = content;
    const { places, moves } = scene;
    movesAt(content, view.place, moves);
    for (let node = 0; node < places.length / 3; node++) {
      for (let c = 0; c < 3; c++) places[3 * node + c] = structure.nodes[3 * node + c] + factor * moves[6 * node + c];
    }
    memberSegments(structure.members, moves, factor, scene.members.numbers);
    scene.members.changed();
    structure.pairs.forEach(([i, j], k) => {
      for (let c = 0; c < 3; c++) {
        scene.pairs.numbers[6 * k + c] = places[3 * i + c];
        scene.pairs.numbers[6 * k + 3 + c] = places[3 * j + c];
      }
    });
    scene.pairs.changed();
    scene.floors.forEach((floor) => floor.move());
    const { masses } = scene;
    masses.nodes.forEach((node, k) => {
      const size = masses.sizes[k];
      masses.setMatrixAt(k, new THREE.Matrix4().makeScale(size, size, size).setPosition(
        places[3 * node], places[3 * node + 1], places[3 * node + 2]));
    });
    masses.instanceMatrix.needsUpdate = true;
    content.devices.forEach((device, k) => moveBearing(content, scene, view, factor, k));
    Object.values(scene.bodies).forEach((mesh) => {
      mesh.instanceMatrix.needsUpdate = true;
      mesh.instanceColor.needsUpdate = true;
    });
  }

  // How many times as large as they are bearings are drawn: to be seen, and apart from each other.
  function sizeOfBodies(content, bounds) {
    const { nodes, bearings } = content.structure;
    const places = bearings.map(([i]) => nodes.slice(3 * i, 3 * i + 2));
    let spacing = Infinity;
    places.forEach(([x, y], k) => places.slice(0, k).forEach(([u, w]) => {
      const apart = Math.hypot(x - u, y - w);
      if (apart > 0) spacing = Math.min(spacing, apart);
    }));
    const wanted = Math.min(BODY * bounds.extent, 0.2 * spacing);
    return Math.max(1, wanted / Math.max(...content.devices.map(plateRadius)));
  }

  const plateRadius = (device) =>
    Math.max(...device.rimFaces.map((face) => face ?? device.reach)) + 0.3 * device.sliderHeight;

  // Bodies of a bearing between its nodes, and what goes on in it by colour.
  function moveBearing(content, scene, view, factor, k) {
    const device = content.devices[k];
    const state = view.stateOf(k);
    const [i, j] = content.structure.bearings[k].map((node) => scene.places.slice(3 * node, 3 * node + 3));
    const size = scene.bodySize;
    const [h, a] = [size * device.sliderHeight, size * device.sliderRadius];
    const plate = size * plateRadius(device);
    const bottom = [0, 1].map((c) => i[c] - factor * device.radii[0] * state.sliderAxis[c]);
    const top = [0, 1].map((c) => bottom[c] + factor * state.slip[c]);
    const edge = Math.max(0, ...device.rimFaces.map((face, s) => (face === null ? 0 :
      size * (device.radii[s] - Math.sqrt(device.radii[s] ** 2 - face ** 2) + 0.5 * device.rimHeight))));
    const low = i[2] + device.sliderHeight - h;
    const high = Math.max(j[2], low + h);
    const foot = (low + high - h) / 2; // sliders go half of what the top plate rises
    const middle = foot + size * device.planeHeight;
    place(scene.bodies.bottomPlate, k, [i[0], i[1], low - 0.175 * h + edge / 2], plate, 0.35 * h + edge,
      state.rims[0] ? "rim" : "plate");
    place(scene.bodies.bottomSlider, k, [...bottom, (foot + middle) / 2], a, middle - foot, state.slips ? "slip" : "low");
    place(scene.bodies.topSlider, k, [...top, (middle + foot + h) / 2], a, h - (middle - foot),
      state.slips ? "slip" : device.rigid ? "low" : "high");
    place(scene.bodies.topPlate, k, [j[0], j[1], high + 0.175 * h - edge / 2], plate, 0.35 * h + edge,
      state.lifted ? "gap" : state.rims[1] ? "rim" : "plate");
    if (k === view.bearing) {
      scene.ring.position.set(i[0], i[1], low);
      scene.ring.scale.setScalar(1.35 * plate);
    }
  }

  const painted = {};
  function place(mesh, k, [x, y, z], radius, height, name) {
    mesh.setMatrixAt(k, new THREE.Matrix4().makeScale(radius, radius, height).setPosition(x, y, z));
    mesh.setColorAt(k, (painted[name] ??= new THREE.Color()).set(colour(name)));
  }

  // A view on the whole model from the front left, whatever the shape of the canvas.
  function fit(camera, controls, bounds, farther) {
    const radius = 0.5 * bounds.extent + 0.5 * farther;
    const half = (camera.fov * Math.PI) / 360;
    const narrow = Math.min(half, Math.atan(Math.tan(half) * camera.aspect));
    const distance = radius / Math.sin(narrow);
    const [azimuth, elevation] = [(-62 * Math.PI) / 180, (16 * Math.PI) / 180];
    controls.target.set(...bounds.middle);
    camera.position.set(
      bounds.middle[0] + distance * Math.cos(elevation) * Math.cos(azimuth),
      bounds.middle[1] + distance * Math.cos(elevation) * Math.sin(azimuth),
      bounds.middle[2] + distance * Math.sin(elevation),
    );
    camera.near = distance / 200;
    camera.far = distance * 20;
    camera.updateProjectionMatrix();
    controls.update();
  }

  // Where a body of a bearing is in the window [px].
  function placeOnScreen(canvas, camera, mesh, k) {
    const box = canvas.getBoundingClientRect();
    const matrix = new THREE.Matrix4();
    mesh.getMatrixAt(k, matrix);
    const point = new THREE.Vector3().setFromMatrixPosition(matrix).project(camera);
    return [box.left + ((point.x + 1) / 2) * box.width, box.top + ((1 - point.y) / 2) * box.height];
  }

  // A click that is no drag chooses the bearing nearest to it on the screen.
  function choose(canvas, camera, scene, said) {
    const REACH = 36; // px
    let pressed = null;
    canvas.addEventListener("pointerdown", (event) => { pressed = [event.clientX, event.clientY]; });
    canvas.addEventListener("pointerup", (event) => {
      if (!pressed || Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) > 5) return;
      let nearest = { away: REACH, k: null };
      for (const mesh of [scene.bodies.bottomPlate, scene.bodies.topPlate]) {
        for (let k = 0; k < mesh.count; k++) {
          const [x, y] = placeOnScreen(canvas, camera, mesh, k);
          const away = Math.hypot(x - event.clientX, y - event.clientY);
          if (away < nearest.away) nearest = { away, k };
        }
      }
      if (nearest.k !== null) said(nearest.k);
    });
  }

  return { make, movesAt, memberSegments };
})();
