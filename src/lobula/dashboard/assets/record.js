// The readings this page has: columns in typed arrays, numbered as the program numbers them.

const LIVE_ROWS = 16384;
const SILENT_S = 1; // no row for longer than this: nothing was seen, and nothing is drawn

export class Record {
  /** `live`: the oldest rows make way for new ones. */
  constructor(live) {
    this.live = live;
    this.base = 0; // number of the row at place 0
    this.length = 0;
    this.room = 0;
    this.time = new Float64Array(0);
    this.frame = new Uint32Array(0);
    this.potentials = new Float32Array(0); // four a row
    this.spikes = new Uint8Array(0); // four a row
    this.state = new Uint8Array(0);
    this.collision = new Uint8Array(0);
  }

  /** Lay the rows of a message where they belong, over what is there. */
  put(rows) {
    if (rows.first < this.base || rows.first > this.base + this.length) {
      this.base = rows.first;
      this.length = 0;
    }
    let place = rows.first - this.base;
    if (this.live && place + rows.count > LIVE_ROWS) place -= this.shift(place + rows.count - LIVE_ROWS / 2);
    this.reserve(place + rows.count);
    this.time.set(rows.time, place);
    this.frame.set(rows.frame, place);
    this.potentials.set(rows.potentials, 4 * place);
    this.spikes.set(rows.spikes, 4 * place);
    this.state.set(rows.state, place);
    this.collision.set(rows.collision, place);
    this.length = Math.max(this.length, place + rows.count);
  }

  /** Place of the last row at or before `time`; -1 before the first. */
  at(time) {
    let low = 0, high = this.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.time[middle] <= time) low = middle + 1;
      else high = middle;
    }
    return low - 1;
  }

  /** Whether a live source gave nothing for long after the row at `place`. */
  silentAfter(place) {
    return this.live && place + 1 < this.length && this.time[place + 1] - this.time[place] > SILENT_S;
  }

  get first() { return this.length ? this.time[0] : 0; }
  get last() { return this.length ? this.time[this.length - 1] : 0; }

  shift(count) {
    const gone = Math.min(count, this.length);
    for (const [column, width] of this.columns()) column.copyWithin(0, width * gone, width * this.length);
    this.base += gone;
    this.length -= gone;
    return gone;
  }

  reserve(count) {
    if (count <= this.room) return;
    this.room = Math.max(count, 2 * this.room, 1024);
    for (const name of ["time", "frame", "potentials", "spikes", "state", "collision"]) {
      const old = this[name], width = name === "potentials" || name === "spikes" ? 4 : 1;
      this[name] = new old.constructor(width * this.room);
      this[name].set(old);
    }
  }

  columns() {
    return [[this.time, 1], [this.frame, 1], [this.potentials, 4], [this.spikes, 4], [this.state, 1], [this.collision, 1]];
  }
}
