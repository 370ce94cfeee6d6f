// The payload: from the text in the page to arrays, and histories read at any time.
"use strict";

const Payload = (() => {
  const KINDS = {
    int16: Int16Array, uint8: Uint8Array, int32: Int32Array, float32: Float32Array, float64: Float64Array,
  };

  // Numbers of a packed array in C order, with their `shape`; scaled ones in single precision.
  function decode(packed) {
    const text = atob(packed.data);
    const bytes = new Uint8Array(text.length);
    for (let k = 0; k < text.length; k++) bytes[k] = text.charCodeAt(k);
    const numbers = new KINDS[packed.type](bytes.buffer);
    const values = packed.scale ? scaled(numbers, packed) : numbers;
    values.shape = packed.shape;
    return values;
  }

  function scaled(numbers, packed) {
    const scale = decode(packed.scale);
    const inner = packed.shape.slice(packed.along + 1).reduce((a, b) => a * b, 1);
    const outer = inner * packed.shape[packed.along];
    const values = new Float32Array(numbers.length);
    for (let k = 0; k < numbers.length; k++) {
      values[k] = numbers[k] * scale[Math.floor(k / outer) * inner + (k % inner)];
    }
    return values;
  }

  // Every packed array in a tree of objects, decoded.
  function decoded(tree) {
    if (Array.isArray(tree)) return tree.map(decoded);
    if (tree === null || typeof tree !== "object") return tree;
    if (typeof tree.data === "string" && tree.shape) return decode(tree);
    return Object.fromEntries(Object.entries(tree).map(([name, part]) => [name, decoded(part)]));
  }

  // Place of a time among kept times: between `step` and the next, `share` of the way.
  function placeOf(time, t) {
    let low = 0;
    let high = time.length - 1;
    if (t >= time[high]) return { step: high - 1, share: 1 };
    if (t <= time[0]) return { step: 0, share: 0 };
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (time[middle] <= t) low = middle;
      else high = middle;
    }
    return { step: low, share: (t - time[low]) / (time[high] - time[low]) };
  }

  // Numbers `from` to `from + count` of the row of a history (n_steps, ...) at a place.
  function rowAt(history, place, from, count) {
    const width = history.length / history.shape[0];
    const row = new Float64Array(count);
    const start = place.step * width + from;
    for (let k = 0; k < count; k++) {
      const value = history[start + k];
      row[k] = value + place.share * (history[start + width + k] - value);
    }
    return row;
  }

  function read() {
    return decoded(JSON.parse(document.getElementById("payload").textContent));
  }

  return { read, decode, placeOf, rowAt };
})();
