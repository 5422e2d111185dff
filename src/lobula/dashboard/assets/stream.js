// The connection to the program: messages taken apart, and opened again when it is lost.

const FIRST_WAIT_MS = 500, LONGEST_WAIT_MS = 5000, SILENT_MS = 15000; // the program speaks every 4 s at least

/** Calls `on.message(head, rows, jpeg, map)` and `on.state(connected, reason)`; `send` says what this page wants. */
export function connect(on) {
  let socket = null, wait = FIRST_WAIT_MS, wanted = {}, timer = 0;

  function open() {
    socket = new WebSocket(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/stream`);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => { if (Object.keys(wanted).length) socket.send(JSON.stringify(wanted)); };
    socket.onmessage = (event) => {
      wait = FIRST_WAIT_MS;
      on.state(true, "");
      alive();
      on.message(...takenApart(event.data));
    };
    socket.onclose = (event) => {
      clearTimeout(timer);
      on.state(false, event.reason);
      setTimeout(open, wait * (0.75 + Math.random() / 2));
      wait = Math.min(2 * wait, LONGEST_WAIT_MS);
    };
  }

  // A dead line is not always told: a phone that changed its network hears nothing any more.
  function alive() {
    clearTimeout(timer);
    timer = setTimeout(() => socket.close(), SILENT_MS);
  }

  open();
  return {
    send(wish) {
      wanted = { ...wanted, ...wish };
      if (socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify(wish));
    },
  };
}

function takenApart(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  let at = 4 + length;
  const take = (Kind, count) => {
    const part = new Kind(buffer, at, count);
    at += part.byteLength;
    return part;
  };
  let rows = null;
  if (head.rows) {
    const n = head.rows.count;
    rows = {
      ...head.rows, time: take(Float64Array, n), frame: take(Uint32Array, n), potentials: take(Float32Array, 4 * n),
      spikes: take(Uint8Array, 4 * n), state: take(Uint8Array, n), collision: take(Uint8Array, n),
    };
  }
  const jpeg = head.scene?.jpeg ? take(Uint8Array, head.scene.jpeg) : null;
  const map = head.scene?.map ? take(Int8Array, head.scene.map.width * head.scene.map.height) : null;
  return [head, rows, jpeg, map];
}
