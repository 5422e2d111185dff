// Four potentials with their thresholds, spikes below each, scrolling; a threshold can be dragged with the mouse.

import { ground, ink, paper, roundStep } from "./ink.js";
import { potential } from "./words.js";

const RASTER = 0.2, MARGIN = 3, NEAR_PX = 7;

/** `moved(neuron, level)` is called while a threshold is dragged; null where it cannot be changed. */
export function makeTraces(root, neurons, moved) {
  const rows = neurons.map((neuron, number) => {
    const row = document.createElement("div");
    row.className = `trace ${neuron.name}`;
    const words = document.createElement("div");
    words.innerHTML = "<b></b><span class=meaning></span><span><span class=value></span><span class=count></span></span>";
    words.querySelector("b").textContent = neuron.label;
    words.querySelector(".meaning").textContent = neuron.meaning;
    const canvas = document.createElement("canvas");
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", `${neuron.label} potential and spikes`);
    row.append(words, canvas);
    root.append(row);
    const shown = {
      neuron, number, row, canvas, value: words.querySelector(".value"), count: words.querySelector(".count"), level: 0,
    };
    if (moved) drag(shown, moved);
    return shown;
  });
  const axis = document.createElement("div");
  axis.className = "trace axis";
  axis.append(document.createElement("div"), document.createElement("canvas"));
  root.append(axis);
  const seconds = axis.querySelector("canvas");

  return {
    /** Draw the stretch of `span` seconds in which `now` lies at `share` of the width. */
    draw(record, now, span, share, thresholds) {
      const start = now - share * span;
      const from = Math.max(0, record.at(start) - 1), to = Math.min(record.length - 1, record.at(start + span) + 1);
      const current = Math.min(record.length - 1, record.at(now + 1e-6));
      for (const shown of rows) {
        shown.level = thresholds[shown.neuron.name];
        tell(shown, record, current);
        drawRow(shown, record, from, to, (time, width) => ((time - start) / span) * width, share);
      }
      drawSeconds(seconds, start, span);
    },
  };
}

function tell(shown, record, current) {
  if (current < 0) return;
  const value = record.potentials[4 * current + shown.number], count = record.spikes[4 * current + shown.number];
  const text = potential(value);
  if (shown.value.textContent !== text) shown.value.textContent = text;
  const spikes = count ? `×${count}` : "";
  if (shown.count.textContent !== spikes) shown.count.textContent = spikes;
  shown.row.classList.toggle("over", Math.abs(value) >= Math.abs(shown.level));
}

function drawRow({ neuron, number, canvas, level }, record, from, to, place, share) {
  const { context, width, height } = paper(canvas);
  if (!width) return;
  const x = (i) => place(record.time[i], width);
  ground(context, record, from, to, x, width, height);
  const curve = Math.round(height * (1 - RASTER)), scale = (curve - 2 * MARGIN) / (neuron.high - neuron.low);
  const y = (value) => MARGIN + (neuron.high - value) * scale;
  const colour = ink(neuron.name);

  if (to >= from) drawCurve(context, record, number, from, to, x, y, y(neuron.name === "lptc_l" ? neuron.high : neuron.low), colour, width);
  drawSpikes(context, record, number, from, to, x, height, height - curve, colour);

  context.strokeStyle = ink("line");
  context.beginPath();
  context.moveTo(0, curve + 0.5);
  context.lineTo(width, curve + 0.5);
  context.stroke();
  context.strokeStyle = ink("dim");
  context.setLineDash([5, 4]);
  context.beginPath();
  context.moveTo(0, y(level));
  context.lineTo(width, y(level));
  context.stroke();
  context.setLineDash([]);
  if (share < 1) {
    context.strokeStyle = ink("text");
    context.beginPath();
    context.moveTo(share * width, 0);
    context.lineTo(share * width, height);
    context.stroke();
  }
  context.fillStyle = ink("dim");
  context.font = "10px system-ui, sans-serif";
  context.textBaseline = "top";
  context.fillText(`${neuron.high}`, 4, MARGIN + 3);
  context.textBaseline = "bottom";
  context.fillText(`${neuron.low}`.replace("-", "\u2212"), 4, curve - MARGIN - 2);
}

function drawCurve(context, record, number, from, to, x, y, rest, colour, width) {
  // More rows than pixels: of each pixel the lowest and the highest, so that no peak is lost. Silence parts the line.
  const line = new Path2D(), area = new Path2D(), dense = to - from > 2 * width;
  let points = [];
  for (let i = from; i <= to; ) {
    const column = Math.floor(x(i));
    let low = Infinity, high = -Infinity, last;
    do {
      last = i++;
      const value = record.potentials[4 * last + number];
      low = Math.min(low, value);
      high = Math.max(high, value);
    } while (dense && i <= to && Math.floor(x(i)) === column && !record.silentAfter(last));
    if (dense) points.push([column, y(low)], [column, y(high)]);
    else points.push([x(last), y(high)]);
    if (i <= to && !record.silentAfter(last)) continue;
    const piece = new Path2D();
    for (const [left, top] of points) piece.lineTo(left, top);
    line.addPath(piece);
    piece.lineTo(points.at(-1)[0], rest);
    piece.lineTo(points[0][0], rest);
    area.addPath(piece);
    points = [];
  }
  context.globalAlpha = 0.16;
  context.fillStyle = colour;
  context.fill(area);
  context.globalAlpha = 1;
  context.strokeStyle = colour;
  context.lineWidth = 1.8;
  context.lineJoin = "round";
  context.stroke(line);
  context.lineWidth = 1;
}

function drawSpikes(context, record, number, from, to, x, foot, band, colour) {
  context.fillStyle = colour;
  const apart = to > from ? (x(to) - x(from)) / (to - from) : 4;
  const wide = Math.min(Math.max(0.6 * apart, 1), 5);
  for (let i = from; i <= to; i++) {
    const count = record.spikes[4 * i + number];
    if (!count) continue;
    const tall = Math.min(0.33 * Math.log2(1 + count), 1) * (band - 2); // 1 spike a third of the band, 7 all of it
    context.fillRect(x(i) - wide, foot - tall, wide, tall);
  }
}

function drawSeconds(canvas, start, span) {
  const { context, width, height } = paper(canvas);
  context.clearRect(0, 0, width, height);
  context.fillStyle = ink("dim");
  context.font = "11px system-ui, sans-serif";
  context.textAlign = "center";
  context.textBaseline = "top";
  const step = roundStep(span / Math.max(3, Math.floor(width / 90)));
  const digits = Math.max(0, -Math.floor(Math.log10(step)));
  for (let n = Math.ceil(start / step); n * step <= start + span; n++) {
    const left = ((n * step - start) / span) * width;
    if (n < 0 || left < 14 || left > width - 14) continue;
    context.fillText(`${(n * step).toFixed(digits)} s`, left, 6);
    context.fillRect(left, 0, 1, 4);
  }
}

function drag(shown, moved) {
  const { canvas, neuron } = shown;
  const scale = () => (canvas.clientHeight * (1 - RASTER) - 2 * MARGIN) / (neuron.high - neuron.low);
  const near = (event) => Math.abs(MARGIN + (neuron.high - shown.level) * scale() - event.offsetY) < NEAR_PX;
  let held = false;
  canvas.addEventListener("pointerdown", (event) => {
    if (event.pointerType !== "mouse" || !near(event)) return;
    held = true;
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    canvas.style.cursor = held || near(event) ? "ns-resize" : "";
    if (!held) return;
    const level = neuron.high - (event.offsetY - MARGIN) / scale();
    moved(neuron.name, Math.min(neuron.high, Math.max(neuron.low, level)));
  });
  canvas.addEventListener("pointerup", () => { held = false; });
}
