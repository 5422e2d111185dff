// A recording under the fingers: play, step, scrub; the whole of it in one strip.

import { ground, ink, paper } from "./ink.js";

const PLAY = '<svg viewBox="0 0 24 24" width="18" height="18" aria-hidden="true"><path d="M6 4l14 8-14 8z" fill="currentColor"/></svg>';
const PAUSE = '<svg viewBox="0 0 24 24" width="18" height="18" aria-hidden="true"><path d="M6 4h4v16H6zM14 4h4v16h-4z" fill="currentColor"/></svg>';

/** `moved()` is called whenever the position has changed. */
export function makeTimeline(record, moved) {
  const root = document.getElementById("replay"), seek = document.getElementById("seek");
  const play = document.getElementById("play"), clock = document.getElementById("clock");
  const speed = document.getElementById("speed"), canvas = root.querySelector("#timeline canvas");
  let time = 0, row = 0, playing = false, before = 0;
  root.hidden = false;

  function button() {
    play.innerHTML = playing ? PAUSE : PLAY;
    play.setAttribute("aria-label", playing ? "Pause" : "Play");
  }

  function go(place, at = record.time[place]) {
    row = Math.max(0, Math.min(place, record.length - 1));
    time = at ?? 0;
    seek.value = row;
    seek.setAttribute("aria-valuetext", `${time.toFixed(2)} s`);
    moved();
  }

  function set(on) {
    if (on && row >= record.length - 1) go(0);
    playing = on;
    before = performance.now();
    button();
    if (on) requestAnimationFrame(tick);
  }

  function tick(now) {
    if (!playing) return;
    const passed = Math.min(0.25, (now - before) / 1000) * Number(speed.value);
    before = now;
    const next = Math.min(record.last, time + passed);
    go(Math.max(0, record.at(next)), next);
    if (next >= record.last && complete()) set(false);
    else requestAnimationFrame(tick);
  }

  let complete = () => true;
  play.onclick = () => set(!playing);
  document.getElementById("back").onclick = () => { set(false); go(row - 1); };
  document.getElementById("forth").onclick = () => { set(false); go(row + 1); };
  seek.oninput = () => { set(false); go(Number(seek.value)); };
  document.addEventListener("keydown", (event) => {
    if (event.target.closest("input:not(#seek), select, button, a, summary")) return;
    if (event.key === " ") set(!playing);
    else if (event.key === "ArrowLeft" && event.target !== seek) go(row - 1);
    else if (event.key === "ArrowRight" && event.target !== seek) go(row + 1);
    else return;
    event.preventDefault();
  });
  button();

  return {
    get time() { return time; },
    get row() { return row; },
    play: () => set(true),
    seek(at) { set(false); go(Math.max(0, record.at(at + 1e-6))); },
    whenComplete(test) { complete = test; },
    /** More rows, or others, have come. */
    grown() { seek.max = Math.max(0, record.length - 1); },
    draw() {
      const { context, width, height } = paper(canvas), first = record.first, span = Math.max(record.last - first, 1e-9);
      const x = (i) => ((record.time[i] - first) / span) * width;
      ground(context, record, 0, record.length - 1, x, width, height);
      for (const [number, name] of [[0, "lgmd1"], [1, "lgmd2"]]) curve(context, record, number, ink(name), x, width, height);
      context.fillStyle = ink("text");
      context.fillRect(Math.min(Math.max(0, ((time - first) / span) * width - 1), width - 2), 0, 2, height);
      clock.textContent = `${Math.max(time, first).toFixed(2)} / ${record.last.toFixed(2)} s`;
    },
  };
}

/** The highest potential of each pixel. */
function curve(context, record, number, colour, x, width, height) {
  const tops = new Float32Array(Math.ceil(width) + 1);
  for (let i = 0; i < record.length; i++) {
    const place = Math.round(x(i));
    tops[place] = Math.max(tops[place], record.potentials[4 * i + number]);
  }
  context.strokeStyle = colour;
  context.lineWidth = 1.4;
  context.beginPath();
  tops.forEach((top, left) => { if (top) context.lineTo(left, height - 3 - (top - 0.5) * 2 * (height - 6)); });
  context.stroke();
  context.lineWidth = 1;
}
