// Buttons, keys, pointer and wheel.

function fillControls() {
  slider.max = about.times.length - 1;
  const fields = byId("field"), probes = byId("probe");
  const option = (select, value, text) => { element(select, "option", undefined, text).value = value; };
  option(fields, "kind", "kind");
  for (const field of about.fields) option(fields, field.name, field.label);
  about.probes.forEach((probe, i) => option(probes, i, probe.unit ? `${probe.name} [${probe.unit}]` : probe.name));
  byId("probes").hidden = about.probes.length === 0;
  fillHelp();
}

function fillHelp() {
  const row = (...cells) => {
    const made = element(byId("errors"), "tr");
    cells.forEach((cell) => element(made, "td", undefined, cell));
  };
  row("positions", about.error_text, "");
  for (const field of about.fields) {
    const [least, largest] = [field.least, field.largest].map((value) => withUnit(value, field));
    const name = field.at === "points" ? `${field.label}, each component` : field.label;
    row(name, field.error_text, `${least} to ${largest}`);
  }
}

let frameAsked = false;
/// At most once a frame of the screen.
function showSoon() {
  if (frameAsked) return;
  frameAsked = true;
  requestAnimationFrame(() => { frameAsked = false; show(); });
}

function pausedAt(index) {
  play(false);
  go(index);
}

function listen() {
  slider.addEventListener("input", () => pausedAt(Number(slider.value)));
  byId("play").addEventListener("click", () => play());
  byId("back").addEventListener("click", () => pausedAt(state.frame - 1));
  byId("forward").addEventListener("click", () => pausedAt(state.frame + 1));
  byId("closer").addEventListener("click", () => { view.zoom(1.5); showSoon(); });
  byId("farther").addEventListener("click", () => { view.zoom(1 / 1.5); showSoon(); });
  byId("reset").addEventListener("click", () => { view.fit(); showSoon(); });
  byId("help-button").addEventListener("click", () => byId("help").showModal());
  byId("help-close").addEventListener("click", () => byId("help").close());
  byId("field").addEventListener("change", (event) => { chooseField(event.target.value); show(); });
  byId("probe").addEventListener("change", (event) => {
    state.probe = Number(event.target.value);
    showCurve();
    keepAddress();
  });
  for (const button of document.querySelectorAll("button, select"))
    button.addEventListener(button.tagName === "SELECT" ? "change" : "click", (event) => {
      if (event.detail > 0 || pointerChose) button.blur();  // so that keys go on to move the time
      pointerChose = false;
    });
  document.addEventListener("pointerdown", () => { pointerChose = true; });
  document.addEventListener("keydown", key);
  addEventListener("hashchange", () => { readAddress(); show(); });
  new ResizeObserver(() => { resize(); show(); }).observe(byId("stage"));
  listenToPointer();
  listenToCurve();
}

let pointerChose = false;

function key(event) {
  if (event.ctrlKey || event.altKey || event.metaKey || byId("help").open || event.target.tagName === "SELECT") return;
  pointerChose = false;
  const actions = {
    " ": () => play(), ArrowLeft: () => pausedAt(state.frame - 1), ArrowRight: () => pausedAt(state.frame + 1),
    Home: () => pausedAt(0), End: () => pausedAt(about.times.length - 1),
    "+": () => { view.zoom(1.5); showSoon(); }, "-": () => { view.zoom(1 / 1.5); showSoon(); },
    0: () => { view.fit(); showSoon(); }, Escape: () => { state.marks = []; showOver(); keepAddress(); },
    "?": () => byId("help").showModal(),
  };
  if (!(event.key in actions) || (event.key === " " && event.target.tagName === "BUTTON")) return;
  event.preventDefault();
  actions[event.key]();
}

function listenToPointer() {
  let from = null, moved = false;
  const ratio = () => devicePixelRatio;
  overlay.addEventListener("wheel", (event) => {
    event.preventDefault();
    const notches = event.deltaY * (event.deltaMode === 1 ? 0.05 : 0.0015);
    view.zoom(Math.exp(-notches), event.offsetX * ratio(), event.offsetY * ratio());
    showSoon();
  }, { passive: false });
  overlay.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    overlay.setPointerCapture(event.pointerId);
    [from, moved] = [[event.offsetX, event.offsetY], false];
  });
  overlay.addEventListener("pointermove", (event) => {
    state.pointer = { px: event.offsetX, py: event.offsetY };
    if (from && (moved || Math.hypot(event.offsetX - from[0], event.offsetY - from[1]) > 4)) {
      moved = true;
      view.pan((event.offsetX - from[0]) * ratio(), (event.offsetY - from[1]) * ratio());
      from = [event.offsetX, event.offsetY];
      showSoon();
    } else showOver();
  });
  overlay.addEventListener("pointerup", (event) => {
    if (from && !moved && now) {
      const hit = pick(model, now.frame, now.shown.walls, ...view.at(event.offsetX * ratio(), event.offsetY * ratio()));
      if (hit) toggle(hit);
    }
    from = null;
  });
  overlay.addEventListener("pointercancel", () => { from = null; });
  overlay.addEventListener("pointerleave", () => { state.pointer = null; showOver(); });
}

/// A click on the curve, or a drag along it, goes to the nearest frame.
function listenToCurve() {
  const seek = (event) => {
    if (!curve.axes || !(event.buttons & 1)) return;
    const t = curve.axes.time(event.offsetX), apart = about.times.map((time) => Math.abs(time - t));
    pausedAt(apart.indexOf(Math.min(...apart)));
  };
  curve.addEventListener("pointerdown", (event) => { curve.setPointerCapture(event.pointerId); seek(event); });
  curve.addEventListener("pointermove", seek);
}
