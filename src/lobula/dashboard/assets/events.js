// What began and ended, newest first; in a recording a click goes there.

import { counted, potential } from "./words.js";

/** `go(time)` is null where there is nowhere to go. */
export function makeEvents(states, neurons, go) {
  const list = document.getElementById("list");
  const named = Object.fromEntries(states.map(({ name, label }) => [name, label]));

  return {
    /** `collisions` there were, listed or not: a list ends somewhere. */
    show(records, collisions) {
      const items = paired(records), earlier = collisions - items.filter(({ type }) => type === "collision").length;
      const lines = items.map((item) => entry(item, named, neurons, go));
      if (earlier > 0) lines.unshift(note(`${earlier} ${counted(earlier, "earlier collision")} not listed`));
      if (!go) lines.reverse();
      list.replaceChildren(...(lines.length ? lines : [note("nothing yet")]));
    },
  };
}

function note(words) {
  return Object.assign(document.createElement("li"), { className: "none", textContent: words });
}

/** Records as events with a start and, once it has come, an end. */
function paired(records) {
  const items = [], open = new Map();
  for (const record of records) {
    const key = `${record.type} ${record.id ?? record.state ?? record.hook}`;
    if (record.phase === "end" || record.phase === "back") {
      const item = open.get(key) ?? { ...record, time_s: null };
      if (!open.has(key)) items.push(item);
      item.end = record;
      open.delete(key);
    } else if (record.phase === "retry" && open.has(key)) open.get(key).tried = record;
    else {
      const item = { ...record };
      items.push(item);
      if (record.phase === "start" || record.phase === "lost") open.set(key, item);
    }
  }
  return items;
}

function entry(item, named, neurons, go) {
  const line = document.createElement("li"), title = document.createElement("b"), text = document.createElement("span");
  line.className = item.type;
  title.textContent = titled(item, named);
  text.textContent = ` ${stretch(item)}${more(item)}`;
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
  if (go && item.time_s !== null) {
    line.classList.add("seek");
    line.tabIndex = 0;
    line.onclick = () => go(item.time_s);
    line.onkeydown = (event) => { if (event.key === "Enter") go(item.time_s); };
  }
  return line;
}

function titled(item, named) {
  if (item.type === "collision") return `Collision ${item.id}`;
  if (item.type === "source") return { resized: "New picture size", restarted: "Robot switched on anew", settings: "Other settings" }[item.phase] ?? "Source lost";
  return named[item.state] ?? `${item.type} ${item.hook ?? item.phase}`;
}

/** What there is to say beside when it was. */
function more(item) {
  if (item.phase === "resized") return `: ${item.width} \u00d7 ${item.height} px`;
  if (item.phase === "settings") return `: ${item.settings_hash} of preset ${item.preset}`;
  const parts = [item.reason, item.tried && !item.end && `try ${item.tried.attempt} failed: ${item.tried.reason}`];
  if (item.end?.phase === "back") parts.push(`back at try ${item.end.attempt}`);
  return [...parts, item.problem].filter(Boolean).map((part) => `; ${part}`).join("");
}

function stretch(item) {
  const from = item.time_s === null ? "" : `${item.time_s.toFixed(2)} s`;
  if (!item.end) return item.phase === "start" || item.phase === "lost" ? `since ${from}` : `at ${from}`;
  if (item.time_s === null) return `until ${item.end.time_s.toFixed(2)} s`;
  return `${item.time_s.toFixed(2)} to ${item.end.time_s.toFixed(2)} s, ${(item.end.time_s - item.time_s).toFixed(2)} s long`;
}
