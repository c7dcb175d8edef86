// What is shown. The address keeps it: #frame=3&field=velocity&probe=...&mark=17:4862:0.2:0.3:0.5&view=x:y:zoom; at=x:y
// puts the pointer to a place (m).

const byId = (id) => document.getElementById(id);
const [picture, overlay, curve, slider] = ["picture", "overlay", "curve", "slider"].map(byId);
const state = { frame: 0, field: null, probe: 0, playing: false, marks: [], pointer: null };
let model, view, now, last = 0;  // now: what is drawn

async function show() {
  const turn = ++last, { frame: index, field } = state;
  const [frame, values] = await Promise.all([loadFrame(model, index), field && loadField(field, index)]);
  if (turn !== last) return;
  now = { frame, values, field, index, shown: drawPicture(picture, model, frame, view, field, values) };
  showTime(index);
  showOver();
  await showCurve();
  keepAddress();
  document.body.dataset.shown = `${index}`;
}

function showOver() {
  if (!now) return;
  const { frame, values, field, shown } = now, pointer = state.pointer;
  const place = pointer && (pointer.place ?? view.at(pointer.px * devicePixelRatio, pointer.py * devicePixelRatio));
  const hit = place && pick(model, frame, shown.walls, ...place);
  drawOverlay(overlay, model, frame, view, shown, hit, state.marks);
  showTip(hit, place);
  byId("marks").replaceChildren();
  for (const mark of state.marks) {
    const text = told(model, frame, field, values, mark).slice(0, 2).join(" \u00b7 ");
    const row = element(byId("marks"), "button", "mark", text);
    row.title = "click to unmark";
    row.addEventListener("click", () => toggle(mark));
  }
}

function showTip(hit, place) {
  const tip = byId("tip"), { factor, unit } = about.length;
  byId("place").textContent = place ? ["x", "y"].map((name, i) =>
    `${name} ${(place[i] * factor).toFixed(3)} ${unit}`).join(", ") : "";
  tip.hidden = !hit;
  if (!hit) return;
  tip.replaceChildren();
  for (const line of told(model, now.frame, now.field, now.values, hit)) element(tip, "div", undefined, line);
  const px = view.px(place[0]) / devicePixelRatio, py = view.py(place[1]) / devicePixelRatio;
  const over = px + 16 + tip.offsetWidth > picture.clientWidth, low = py + 16 + tip.offsetHeight > picture.clientHeight;
  tip.style.left = `${Math.max(0, over ? px - 12 - tip.offsetWidth : px + 16)}px`;
  tip.style.top = `${Math.max(0, low ? py - 12 - tip.offsetHeight : py + 16)}px`;
}

function showTime(index) {
  slider.value = index;
  const { factor, unit } = about.time, decimals = timeDigits();
  byId("time").textContent = `t = ${(about.times[index] * factor).toFixed(decimals)} ${unit}`;
  byId("number").textContent = `frame ${about.frames[index]} (${index + 1} of ${about.times.length})`;
}

/// So many that neighbouring frames differ.
function timeDigits() {
  const gaps = about.times.slice(1).map((t, i) => t - about.times[i]);
  const least = Math.min(...gaps, ...(gaps.length ? [] : [about.times[0] || 1])) * about.time.factor;
  return Math.min(Math.max(1 - Math.floor(Math.log10(least || 1)), 0), 9);
}

async function showCurve() {
  const probe = about.probes[state.probe];
  if (!probe) return;
  const column = await loadColumn(state.probe);
  const { to, value } = drawCurve(curve, column, probe, about.times[state.frame]);
  curve.axes = to;
  byId("probe-value").textContent = Number.isFinite(value)
    ? `${Number((value * probe.factor).toPrecision(5))} ${probe.unit}`.replace("-", "\u2212") : "no value at this time";
}

function go(index) {
  state.frame = Math.min(Math.max(index, 0), about.times.length - 1);
  return show();
}

function chooseField(name) {
  state.field = about.fields.find((field) => field.name === name) ?? null;
  byId("field").value = state.field ? name : "kind";
  showLegend(byId("legend"), model, state.field);
}

function toggle(hit) {
  const there = state.marks.findIndex((mark) => mark.body === hit.body);
  if (there >= 0) state.marks.splice(there, 1); else state.marks.push(hit);
  showOver();
  keepAddress();
}

/// Frames one after the other, each when the one before is drawn.
async function play(on = !state.playing) {
  const started = on && !state.playing;
  state.playing = on;
  byId("play").textContent = on ? "\u275a\u275a" : "\u25b6";
  byId("play").title = on ? "pause (space)" : "play (space)";
  if (!started) return;
  if (state.frame === about.times.length - 1) await go(0);
  while (state.playing && state.frame < about.times.length - 1) {
    const pause = new Promise((done) => setTimeout(done, 1000 / Number(byId("speed").value)));
    await go(state.frame + 1);
    if (state.frame < about.times.length - 1) loadFrame(model, state.frame + 1);
    await pause;
  }
  if (state.playing) play(false);
}

let addressTimer;
function keepAddress() {
  clearTimeout(addressTimer);
  addressTimer = setTimeout(() => {
    const items = [`frame=${state.frame}`];
    if (state.field) items.push(`field=${state.field.name}`);
    if (state.field && state.field.stretch !== 1) items.push(`stretch=${state.field.stretch}`);
    if (about.probes[state.probe]) items.push(`probe=${encodeURIComponent(about.probes[state.probe].name)}`);
    for (const { body, cell, weights } of state.marks)
      items.push(`mark=${[body, cell, ...weights.map((weight) => weight.toFixed(4))].join(":")}`);
    const place = [view.x, view.y, view.scale / view.smallest].map((number) => number.toPrecision(6));
    if (view.scale !== view.smallest) items.push(`view=${place.join(":")}`);
    try { history.replaceState(null, "", `#${items.join("&")}`); } catch { /* a page that may not keeps its address */ }
  }, 200);
}

function readAddress() {
  const items = new URLSearchParams(location.hash.slice(1)), numbers = (text) => text.split(":").map(Number);
  state.frame = Math.min(Math.max(Math.floor(Number(items.get("frame"))) || 0, 0), about.times.length - 1);
  state.probe = Math.max(0, about.probes.findIndex((probe) => probe.name === items.get("probe")));
  const times = Number(items.get("stretch")), chosen = about.fields.find((field) => field.name === items.get("field"));
  for (const field of about.fields) stretch(field, field === chosen && times > 0 ? times : 1);
  chooseField(items.get("field") ?? "kind");
  byId("probe").value = `${state.probe}`;
  state.marks = [];
  for (const [body, cell, ...weights] of items.getAll("mark").map(numbers))
    if (cell >= model.cellStart[body] && cell < model.cellStart[body + 1] && weights.length === 3)
      state.marks.push({ body, cell, weights });
  const [x, y, zoom] = numbers(items.get("view") ?? "");
  if (zoom > 0) Object.assign(view, { x, y, scale: zoom * view.smallest });
  const at = numbers(items.get("at") ?? "");
  if (at.length === 2 && at.every(Number.isFinite)) state.pointer = { place: at };
}

function resize() {
  const ratio = devicePixelRatio, fit = (canvas) => {
    canvas.width = Math.max(1, Math.round(canvas.clientWidth * ratio));
    canvas.height = Math.max(1, Math.round(canvas.clientHeight * ratio));
  };
  [picture, overlay, curve].forEach(fit);
  if (!view) view = new View(picture.width, picture.height);
  else view.resize(picture.width, picture.height);
}

async function start() {
  if (typeof DecompressionStream === "undefined") throw new Error("the browser is older than 2023");
  model = await loadModel();
  resize();
  fillControls();
  readAddress();
  listen();
  byId("loading").hidden = true;
  await show();
}

start().catch((error) => {
  byId("loading").hidden = false;
  byId("loading").textContent = `This page cannot be shown: ${error.message}`;
  throw error;
});
