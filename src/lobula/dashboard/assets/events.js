// What began and ended, newest first; in a recording a click goes there.

import { potential } from "./words.js";

const MOST = 200;

/** `go(time)` is null where there is nowhere to go. */
export function makeEvents(states, neurons, go) {
  const list = document.getElementById("list");
  const named = Object.fromEntries(states.map(({ name, label }) => [name, label]));

  return {
    show(records) {
      const items = paired(records).slice(-MOST);
      if (!go) items.reverse();
      list.replaceChildren(...items.map((item) => entry(item, named, neurons, go)));
      if (!items.length) list.append(Object.assign(document.createElement("li"), { className: "none", textContent: "nothing yet" }));
    },
  };
}

/** Records as events with a start and, once it has come, an end. */
function paired(records) {
  const items = [], open = new Map();
  for (const record of records) {
    const key = record.type === "collision" ? `collision ${record.id}` : `${record.type} ${record.state ?? record.hook}`;
    if (record.phase === "end") {
      const item = open.get(key) ?? { ...record, time_s: null };
      if (!open.has(key)) items.push(item);
      item.end = record;
      open.delete(key);
    } else {
      const item = { ...record };
      items.push(item);
      if (record.phase === "start") open.set(key, item);
    }
  }
  return items;
}

function entry(item, named, neurons, go) {
  const line = document.createElement("li"), title = document.createElement("b"), text = document.createElement("span");
  line.className = item.type;
  title.textContent = item.type === "collision" ? `Collision ${item.id}` : named[item.state] ?? `${item.type} ${item.hook ?? item.phase}`;
  text.textContent = ` ${stretch(item)}`;
  line.append(title, text);
  if (item.type === "collision" && item.lgmd1 !== undefined) {
    const values = document.createElement("div");
    values.className = "values";
    for (const { name, label } of neurons) {
      const value = document.createElement("span");
      value.className = name;
      value.textContent = `${label} ${potential(item[name])}`;
      values.append(value);
    }
    line.append(values);
  }
  if (item.type === "source") text.textContent += Object.entries(item).filter(([key]) => !["type", "phase", "frame", "time_s"].includes(key)).map(([key, value]) => `, ${key.replaceAll("_", " ")} ${value}`).join("");
  if (item.problem) text.textContent += `, ${item.problem}`;
  if (go && item.time_s !== null) {
    line.classList.add("seek");
    line.tabIndex = 0;
    line.onclick = () => go(item.time_s);
    line.onkeydown = (event) => { if (event.key === "Enter") go(item.time_s); };
  }
  return line;
}

function stretch(item) {
  const from = item.time_s === null ? "" : `${item.time_s.toFixed(2)} s`;
  if (!item.end) return item.phase === "start" ? `since ${from}` : `at ${from}`;
  if (item.time_s === null) return `until ${item.end.time_s.toFixed(2)} s`;
  return `${item.time_s.toFixed(2)} to ${item.end.time_s.toFixed(2)} s, ${(item.end.time_s - item.time_s).toFixed(2)} s long`;
}
