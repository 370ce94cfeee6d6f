// The common time: it runs, stands, and tells whoever listens.
"use strict";

const Clock = (() => {
  function make(times) {
    const first = times[0];
    const last = times[times.length - 1];
    const listeners = [];
    let before = 0;
    const clock = { first, last, now: first, speed: 1, playing: false };

    clock.listen = (listener) => listeners.push(listener);
    const tell = () => listeners.forEach((listener) => listener(clock));

    clock.set = (t) => {
      clock.now = Math.min(Math.max(t, first), last);
      tell();
    };
    clock.step = (count) => {
      clock.pause();
      const place = Payload.placeOf(times, clock.now);
      const at = count > 0 ? place.step + (place.share === 1 ? 1 : 0) : place.step + (place.share > 0 ? 1 : 0);
      clock.set(times[Math.min(Math.max(at + count, 0), times.length - 1)]);
    };
    clock.pause = () => {
      clock.playing = false;
      tell();
    };
    clock.toggle = () => {
      if (clock.playing) {
        clock.pause();
        return;
      }
      if (clock.now >= last) clock.now = first;
      clock.playing = true;
      before = performance.now();
      tell();
      requestAnimationFrame(tick);
    };

    function tick(moment) {
      if (!clock.playing) return;
      const passed = Math.min(Math.max(moment - before, 0), 250) / 1000;
      before = moment;
      clock.now = Math.min(clock.now + passed * clock.speed, last);
      if (clock.now >= last) clock.playing = false;
      tell();
      if (clock.playing) requestAnimationFrame(tick);
    }

    return clock;
  }

  return { make };
})();
