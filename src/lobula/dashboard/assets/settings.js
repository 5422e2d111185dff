// The settings that can be changed while it runs: a slider and a number each; sent as they move.

const GROUPS = { alarm: "Alarm", spiking: "Spiking thresholds", sigmoid: "Sigmoids", more: "Gains and times" };
const SEND_MS = 60, STEPS = 1000;

export function makeSettings(described) {
  const form = document.getElementById("controls"), refused = document.getElementById("refused");
  const controls = new Map(), groups = new Map();
  let values = {}, pending = {}, timer = 0, sending = false;
  document.getElementById("settings").hidden = false;

  for (const [name, title] of Object.entries(GROUPS)) {
    const more = name === "more", group = document.createElement(more ? "details" : "fieldset");
    const heading = document.createElement(more ? "summary" : "legend");
    heading.textContent = title;
    group.append(heading);
    form.append(group);
    groups.set(name, group);
  }
  for (const about of described) {
    const control = makeControl(about, (value) => change({ [about.path]: value }));
    controls.set(about.path, control);
    groups.get(about.group).append(control.root);
  }
  form.onsubmit = (event) => event.preventDefault();
  document.getElementById("restore").onclick = () => post({ restore: true });

  function change(some) {
    pending = { ...pending, ...some };
    if (!timer && !sending) timer = setTimeout(flush, SEND_MS);
  }

  async function flush() {
    timer = 0;
    const now = pending;
    pending = {};
    sending = true;
    await post(now);
    sending = false;
    if (Object.keys(pending).length) flush();
  }

  async function post(body) {
    try {
      const answer = await fetch("/settings", {
        method: "POST", headers: { "content-type": "application/json" }, body: JSON.stringify(body),
      });
      refused.hidden = answer.ok;
      if (answer.ok) show(await answer.json());
      else {
        refused.textContent = await answer.text();
        show({ values, settings_hash: null });
      }
    } catch {
      refused.hidden = false;
      refused.textContent = "not sent: no connection";
    }
  }

  function show(now) {
    values = now.values;
    for (const [path, control] of controls) if (!(path in pending)) control.set(values[path]);
    if (now.settings_hash) document.getElementById("hash").textContent = `hash ${now.settings_hash}`;
  }

  return { show, change };
}

function makeControl(about, changed) {
  const root = document.createElement("div"), label = document.createElement("label"), id = `set-${about.path}`;
  const slider = about.slider && document.createElement("input"), field = document.createElement(about.choices ? "select" : "input");
  const unit = document.createElement("span"), back = document.createElement("button");
  root.className = "setting";
  label.textContent = about.label;
  label.htmlFor = field.id = id;
  root.title = `${about.path}: ${about.meaning}`;
  unit.className = "unit";
  unit.textContent = about.unit.replace("^2", "\u00b2");
  back.type = "button";
  back.textContent = "↺";
  back.setAttribute("aria-label", `${about.label}: back to ${about.start}`);
  back.onclick = () => changed(about.start);
  if (about.choices) field.append(...about.choices.map((choice) => new Option(choice, choice)));
  else Object.assign(field, { type: "number", min: about.low, max: about.high, step: "any" });
  field.onchange = () => changed(about.choices ? field.value : Number(field.value));
  root.append(label);
  if (slider) {
    const { low, high, log } = about.slider;
    Object.assign(slider, { type: "range", min: 0, max: STEPS, step: 1 });
    slider.setAttribute("aria-label", about.label);
    slider.oninput = () => {
      const share = slider.value / STEPS, value = log ? low * (high / low) ** share : low + share * (high - low);
      field.value = about.whole ? Math.round(value) : neat(value, about.start);
      changed(Number(field.value));
    };
    root.append(slider);
  }
  root.append(field, unit, back);
  return {
    root,
    set(value) {
      root.classList.toggle("changed", value !== about.start);
      if (document.activeElement !== field) field.value = about.choices ? value : neat(value, about.start);
      if (!slider || slider.matches(":active")) return;
      const { low, high, log } = about.slider;
      slider.value = STEPS * (log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low));
    },
  };
}

/** A number as people write it; the start value is left as it is. */
function neat(value, start) {
  return value === start ? value : Number(value.toPrecision(3));
}
