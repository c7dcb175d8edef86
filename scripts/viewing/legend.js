// The colour bar with its ticks and ends, or the kinds.

function round(value) { return `${Number(value.toPrecision(12))}`.replace("-", "\u2212"); }

/// Round numbers from low to high, some `count` of them.
function ticks(low, high, count) {
  const power = 10 ** Math.floor(Math.log10((high - low) / count)), spacing = [1, 2, 5, 10].map((step) => step * power)
    .find((step) => (high - low) / step <= count * 1.3) ?? 10 * power;
  const found = [];
  for (let i = Math.ceil(low / spacing - 1e-9); i * spacing <= high + 1e-9 * spacing; i++) found.push(i * spacing);
  return found;
}

function element(parent, tag, className, text) {
  const made = document.createElement(tag);
  if (className) made.className = className;
  if (text !== undefined) made.textContent = text;
  return parent.appendChild(made);
}

/// The scale as many times as long as the page came with it.
function stretch(field, times) {
  field.ends ??= [field.low, field.high];
  field.stretch = times;
  [field.low, field.high] = field.ends.map((end) => field.centre + times * (end - field.centre));
}

function showLegend(parent, model, field) {
  parent.replaceChildren();
  if (!field) return showKinds(parent, model);
  const { factor, unit } = field, palette = about.palettes[field.palette];
  element(parent, "div", "legend-title", field.at === "points" ? `${field.label}, norm` : field.label);
  const row = element(parent, "div", "legend-unit", unit ? `in ${unit}` : "");
  if (!field.fixed) {
    const buttons = element(row, "span", "stretches");
    for (const [text, share] of [["\u00f72", 0.5], ["\u00d72", 2]]) {
      const button = element(buttons, "button", "stretch", text);
      button.title = share < 1 ? "half the scale" : "twice the scale";
      button.addEventListener("click", () => {
        stretch(field, field.stretch * share);
        showLegend(parent, model, field);
        show();
      });
    }
  }
  const column = element(parent, "div", "bar-column");
  const above = field.largest > field.high + field.step / 2, below = field.least < field.low - field.step / 2;
  const end = (kind, colour, value) => {
    const row = element(column, "div", `bar-end ${kind}`);
    element(row, "span", "bar-arrow").style.background = colour;
    const text = `to ${round(Number((value * factor).toPrecision(3)))}`;
    element(row, "span", "bar-beyond", text).title = "values beyond the scale";
  };
  if (above) end("above", palette.above, field.largest);
  const bar = element(column, "div", "bar");
  const stops = palette.colours.filter((_, i) => i % 5 === 0);
  element(bar, "div", "bar-colours").style.background = `linear-gradient(to top, ${stops.join(", ")})`;
  const [low, high] = [field.low * factor, field.high * factor];
  for (const value of ticks(low, high, 6)) {
    const tick = element(bar, "span", "bar-tick", round(value));
    tick.style.bottom = `${(100 * (value - low)) / (high - low)}%`;
  }
  if (below) end("below", palette.below, field.least);
  if (field.at === "outlines") entry(parent, about.colours.bodies, "bodies");
  if (field.at === "cells" && !field.once) entry(parent, about.colours.neutral, "no value");
}

function showKinds(parent, model) {
  element(parent, "div", "legend-title", "kind");
  kindNames.forEach((name, kind) => {
    const count = model.kind.filter((of) => of === kind).length;
    if (count) entry(parent, about.colours.kinds[kind], `${name} (${count})`);
  });
}

function entry(parent, colour, text) {
  const row = element(parent, "div", "legend-entry");
  element(row, "span", "swatch").style.background = colour;
  element(row, "span", undefined, text);
}
