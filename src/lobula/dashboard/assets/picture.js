// The picture with the decision drawn, and a map of one layer over it.

const ABOVE = [255, 159, 77], BELOW = [88, 169, 255];

export function makePicture() {
  const stage = document.getElementById("stage"), canvas = document.getElementById("picture");
  const map = document.getElementById("map"), nothing = document.getElementById("nothing");
  const label = document.getElementById("label"), scale = document.getElementById("scale");
  let waiting = null, busy = false, strength = 0.8, seen = null;

  document.addEventListener("visibilitychange", draw);

  async function draw() {
    if (busy || document.hidden) return;
    busy = true;
    try {
      while (waiting) {
        const jpeg = waiting;
        waiting = null;
        const image = await createImageBitmap(new Blob([jpeg], { type: "image/jpeg" }));
        if (canvas.width !== image.width || canvas.height !== image.height) [canvas.width, canvas.height] = [image.width, image.height];
        canvas.getContext("2d").drawImage(image, 0, 0);
        image.close();
        nothing.hidden = true;
      }
    } finally {
      busy = false; // one picture that cannot be drawn is no reason to draw none any more
    }
  }

  function drawMap() {
    map.hidden = scale.hidden = !seen;
    if (!seen) return;
    const { about, pixels, box } = seen;
    [map.width, map.height] = [about.width, about.height];
    const context = map.getContext("2d"), image = context.createImageData(about.width, about.height);
    for (let i = 0; i < pixels.length; i++) {
      const share = pixels[i] / 127, colour = share > 0 ? ABOVE : BELOW;
      image.data.set(colour, 4 * i);
      image.data[4 * i + 3] = 255 * strength * Math.min(1, 1.6 * Math.abs(share));
    }
    context.putImageData(image, 0, 0);
    const [left, top, width, height] = box.map((side) => `${100 * side}%`);
    Object.assign(map.style, { left, top, width, height });
    scale.textContent = about.peak > 1e-6 ? `full colour ±${about.peak.toPrecision(2)}` : "zero everywhere";
  }

  return {
    /** Show a scene's picture, or none, and its map, or none. */
    show(scene, jpeg, pixels) {
      if (jpeg) {
        waiting = jpeg;
        draw();
      }
      seen = scene.map ? { about: scene.map, pixels, box: scene.box } : null;
      drawMap();
    },
    /** Say what was decided, on the picture itself. */
    mark(collision, state, words) {
      stage.classList.toggle("collision", collision);
      stage.classList.toggle("stale", state === "stale");
      label.hidden = !collision && state === "ok";
      label.className = collision ? "collision" : state;
      const text = collision ? "COLLISION" : words;
      if (label.textContent !== text) label.textContent = text;
    },
    blend(value) {
      strength = value;
      drawMap();
    },
    say(words) {
      nothing.textContent = words;
      nothing.hidden = false;
    },
  };
}
