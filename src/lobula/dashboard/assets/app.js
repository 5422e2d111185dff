// The page: hands what the program sends to the parts that show it.

import { makeEvents } from "./events.js";
import { forgetInk } from "./ink.js";
import { makePicture } from "./picture.js";
import { Record } from "./record.js";
import { makeSettings } from "./settings.js";
import { connect } from "./stream.js";
import { makeTimeline } from "./timeline.js";
import { makeTraces } from "./traces.js";
import { counted, milliseconds } from "./words.js";

const $ = (id) => document.getElementById(id);
const PAST = 0.75; // of the window lies before the moment shown, in a recording

let run = null, about = null, record = null, traces, picture = makePicture(), events, settings, timeline;
let fitted = false, status = {}, thresholds = {}, collisions = 0, drawn = false, asked = null, told = "", why = [];
let here = false; // whether there is a connection

if (location.search) history.replaceState(null, "", "/"); // the token has become a cookie: nobody need see it

const stream = connect({
  message(head, rows, jpeg, map) {
    if (head.hello) greet(head.hello);
    if (rows) {
      record.put(rows);
      timeline?.grown();
    }
    if (head.settings) {
      thresholds = head.settings.thresholds;
      settings.show(head.settings);
    }
    if (head.events) {
      collisions = head.collisions;
      events.show(head.events, collisions);
    }
    if (head.scene) {
      picture.show(head.scene, jpeg, map);
      why = head.scene.why;
      if (timeline) asked = null;
    }
    status = head.status;
    if (timeline && !fitted && status.complete) fit();
    changed();
    if (timeline && !asked) ask();
  },
  state(connected, reason) {
    here = connected;
    document.body.classList.toggle("lost", !connected);
    if (connected) return notice(status.problem ?? "");
    pill("lost", status.ended ? "ended" : "no connection");
    notice(`${ended()}${reason || "No connection"}. Trying again.`);
  },
});

/** How the run ended, where it has. */
function ended() {
  if (!status.ended) return "";
  const { status: how, problems } = status.ended;
  return `The run has ended: ${problems.join(". ") || how.replaceAll("_", " ")}. `;
}

/** Build the page for what is shown; anew where another program answers than before. */
function greet(hello) {
  if (hello.run === run) return;
  if (run !== null) return location.reload();
  run = hello.run;
  about = hello;
  const robot = about.mode === "robot", live = robot || about.mode === "live", trace = about.mode === "trace";
  record = new Record(live);
  thresholds = about.thresholds;
  $("name").textContent = about.name;
  $("mode").textContent = { live: "live", robot: "a robot, live", recording: "recording", trace: "saved trace" }[about.mode];
  document.title = `${about.name} · lobula`;
  $("facts").textContent = facts(about.facts, about.lobula);
  timeline = live ? null : makeTimeline(record, () => { changed(); ask(); });
  events = makeEvents(about.states, about.neurons, timeline && ((at) => timeline.seek(at)));
  events.show([], 0);
  settings = trace || robot ? null : makeSettings(about.settings);
  traces = makeTraces($("traces"), about.neurons, settings && drag);
  if (trace || robot) {
    picture.say(trace ? "A saved trace holds no pictures. Serve the clip itself to see them." : "A robot sends what it decides, and no pictures.");
    document.querySelector("main").classList.add("plain");
    $("layers").hidden = true;
  } else layers();
  timeline?.whenComplete(() => status.complete);
  fitted = false;
  if (timeline && !matchMedia("(prefers-reduced-motion: reduce)").matches) timeline.play();
}

function layers() {
  for (const [group, names] of Object.entries(about.maps)) {
    const options = document.createElement("optgroup");
    options.label = group;
    options.append(...names.map((name) => new Option(name.replace(/^lgmd(.)_/, "LGMD-$1 ").replaceAll("_", " "), name)));
    $("layer").append(options);
  }
  $("layer").onchange = () => {
    stream.send({ map: $("layer").value || null });
    $("strength-label").hidden = !$("layer").value;
  };
  $("strength-label").hidden = true;
  $("strength").oninput = () => picture.blend(Number($("strength").value));
}

/** A window that suits the length of a recording. */
function fit() {
  fitted = true;
  const spans = [...$("span").options].map((option) => Number(option.value));
  $("span").value = spans.findLast((seconds) => seconds <= record.last - record.first) ?? spans[0];
}

/** Ask for the scene of the row shown, one at a time: what comes next is always the newest wish. */
function ask() {
  if (!timeline || about.mode === "trace" || asked !== null || !record.length) return;
  if (timeline.row === ask.last) return;
  asked = ask.last = timeline.row;
  stream.send({ show: timeline.row });
}

/** A threshold dragged in its trace. Both LPTCs share one. */
function drag(neuron, level) {
  const path = neuron.startsWith("lptc") ? "lptc.spiking.threshold" : `${neuron}.spiking.threshold`;
  settings.change({ [path]: Math.min(0.99, Math.max(0.01, Number(Math.abs(level).toFixed(3)))) });
}

function changed() {
  if (drawn) return;
  drawn = true;
  requestAnimationFrame(() => {
    drawn = false;
    if (record) draw();
  });
}

function draw() {
  const span = Number($("span").value), now = timeline ? timeline.time : record.last;
  traces.draw(record, now, span, timeline ? PAST : 1, thresholds);
  timeline?.draw();
  const place = timeline ? timeline.row : record.length - 1;
  const row = record.length ? { collision: !!record.collision[place], state: about.states[record.state[place]].name } : null;
  if (!row) return;
  const state = timeline ? row.state : status.state ?? row.state, collision = row.collision && state !== "stale";
  const words = about.states.find(({ name }) => name === state).label;
  picture.mark(collision, state, words);
  if (here) pill(collision ? "collision" : state, collision ? "COLLISION" : words);
  explain(state);
  figures(state);
}

function pill(kind, words) {
  if (told === kind) return;
  told = kind;
  $("state").className = `pill ${kind}`;
  $("state").textContent = words;
  document.title = `${kind === "collision" ? "COLLISION · " : ""}${about ? `${about.name} · ` : ""}lobula`;
}

function figures(state) {
  const shown = [];
  const rate = state === "stale" && !timeline ? 0 : ratePerSecond();
  shown.push(["frames / s", rate.toFixed(rate && rate < 10 ? 1 : 0)]);
  if (timeline) {
    shown.push([counted(record.length, "frame"), record.length]);
    if (!status.complete) shown.push(["analysed", status.total ? `${Math.min(100, Math.round((100 * record.length) / status.total))} %` : "…"]);
  } else {
    if (status.latency) shown.push(["latency, median", milliseconds(status.latency.median)], ["latency, worst", milliseconds(status.latency.worst)]);
    if (status.work) shown.push(["network, median", milliseconds(status.work.median)]);
    shown.push([about.mode === "robot" ? "lost" : "dropped", status.dropped ?? 0, (status.dropped ?? 0) > 0]);
    if (status.motor) shown.push(["wheels", status.motor.replaceAll("_", " ")]);
    if (status.damaged) shown.push(["damaged", status.damaged, true]);
  }
  shown.push([counted(collisions, "collision"), collisions]);
  shown.push([counted(status.viewers ?? 1, "viewer"), status.viewers ?? 1]);
  const text = JSON.stringify(shown);
  if (figures.last === text) return;
  figures.last = text;
  $("figures").replaceChildren(...shown.map(([name, value, bad]) => {
    const box = document.createElement("div");
    box.className = bad ? "bad" : "";
    box.append(Object.assign(document.createElement("dd"), { textContent: value }), Object.assign(document.createElement("dt"), { textContent: name }));
    return box;
  }));
}

/** Of the last two seconds, live; of all, in a recording. */
function ratePerSecond() {
  const from = timeline ? 0 : Math.max(0, record.at(record.last - 2)), span = record.last - record.time[from];
  return span > 0 ? (record.length - 1 - from) / span : 0;
}

function explain(state) {
  $("why").hidden = !why.length;
  const blind = state === "stale";
  if (!why.length || (explain.last === why && explain.blind === blind)) return;
  [explain.last, explain.blind] = [why, blind];
  const unmet = why.find((one) => !one.holds);
  const met = unmet ? `No collision: ${unmet.because}` : "Collision: every condition holds";
  $("verdict").textContent = blind ? "Nothing is decided: no new picture comes" : met;
  $("verdict").className = unmet || blind ? "" : "collision";
  $("conditions").replaceChildren(...(blind ? [] : why).map((one) => Object.assign(document.createElement("li"), {
    className: one.holds ? "" : "no", textContent: one.because,
  })));
}

function notice(words) {
  $("notice").hidden = !words;
  if ($("notice").textContent !== words) $("notice").textContent = words;
}

function facts(known, version) {
  const words = { preset: "preset", neurons: "neurons", engine: "engine", settings_hash: "settings" };
  const parts = Object.entries(words).filter(([key]) => known[key]).map(([key, word]) => `${word} ${known[key]}`);
  if (known.width) parts.push(`${known.width} × ${known.height} px`);
  return [known.source, ...parts, `lobula ${known.version ?? version}`].filter(Boolean).join(" · ");
}

$("span").onchange = changed;
addEventListener("resize", changed);
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { forgetInk(); changed(); });
$("theme").onclick = () => {
  const dark = getComputedStyle(document.documentElement).colorScheme === "dark";
  document.documentElement.dataset.theme = dark ? "light" : "dark";
  localStorage.setItem("lobula-theme", document.documentElement.dataset.theme);
  forgetInk();
  changed();
};
const theme = localStorage.getItem("lobula-theme");
if (theme) document.documentElement.dataset.theme = theme;
