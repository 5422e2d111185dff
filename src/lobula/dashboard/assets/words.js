// Numbers as the page writes them.

/** A potential, cut and not rounded: 0.699 is below 0.70 and must not read so. */
export function potential(value) {
  return (Math.trunc(+(value * 100).toFixed(6)) / 100 + 0).toFixed(2).replace("-", "\u2212");
}

/** The word that goes with a number. */
export function counted(number, word) {
  return number === 1 ? word : `${word}s`;
}

export function milliseconds(value) {
  return `${value < 10 ? value.toFixed(2) : value.toFixed(0)} ms`;
}
