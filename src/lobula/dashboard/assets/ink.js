// Colours of the theme, and canvases that are sharp on any screen.

let colours = {};

/** The value of a colour of the style sheet, such as `ink("hit")`. */
export function ink(name) {
  return colours[name] ??= getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

/** Forget the colours, as when the theme has changed. */
export function forgetInk() { colours = {}; }

/** Fit the canvas to its place on the page; return its context, in CSS pixels, with its width and height. */
export function paper(canvas) {
  const ratio = window.devicePixelRatio || 1, { clientWidth: width, clientHeight: height } = canvas;
  const wide = Math.round(width * ratio), high = Math.round(height * ratio);
  if (canvas.width !== wide || canvas.height !== high) [canvas.width, canvas.height] = [wide, high];
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  return { context, width, height };
}

/** Fill what lies behind a curve: panel, states other than ok and silence, collisions. `x`: the place of a row's time. */
export function ground(context, record, from, to, x, width, height) {
  context.fillStyle = ink("panel");
  context.fillRect(0, 0, width, height);
  const stretch = (colour, alpha, holds) => {
    context.fillStyle = ink(colour);
    context.globalAlpha = alpha;
    for (let i = from; i <= to; i++) {
      if (!holds(i)) continue;
      let end = i;
      while (end < to && holds(end + 1)) end++;
      const left = x(i), right = end < to ? x(end + 1) : x(end) + 1;
      context.fillRect(left, 0, Math.max(right - left, 1), height);
      i = end;
    }
  };
  stretch("dim", 0.2, (i) => record.state[i] || record.silentAfter(i));
  stretch("hit", 0.28, (i) => record.collision[i] && !record.silentAfter(i));
  context.globalAlpha = 1;
}

/** The next 1, 2 or 5 times a power of ten. */
export function roundStep(step) {
  const power = 10 ** Math.floor(Math.log10(Math.max(step, 1e-3)));
  return [1, 2, 5, 10].map((m) => m * power).find((s) => s >= step * (1 - 1e-9));
}
