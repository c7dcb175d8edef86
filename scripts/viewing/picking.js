// What is at a place, and what the field is there.

/// The body at (x, y), m: {body, cell, weights of its corners}; walls have no cells.
function pick(model, frame, walls, x, y) {
  if (about.period !== null && (x < 0 || x > about.period)) return null;
  const { boxes } = frame;
  for (let body = model.bodies - 1; body >= 0; body--) {
    if (model.kind[body] === WALL) continue;
    for (const [right, up] of shifts(frame, body)) {
      if (y - up < boxes[4 * body + 2] || y - up > boxes[4 * body + 3]) continue;
      if (x - right < boxes[4 * body] || x - right > boxes[4 * body + 1]) continue;
      const hit = cellAt(model, frame, body, x - right, y - up);
      if (hit) return hit;
    }
  }
  for (const { ax, ay, bx, by, below, body } of walls) {
    if (x < Math.min(ax, bx) || x > Math.max(ax, bx)) continue;
    const level = ay + (by - ay) * (ax === bx ? 0 : (x - ax) / (bx - ax));
    if (below ? y <= level : y >= level) return { body, cell: -1, weights: [], place: [x, y] };
  }
  return null;
}

function cellAt(model, frame, body, x, y) {
  for (let cell = model.cellStart[body]; cell < model.cellStart[body + 1]; cell++) {
    const [ax, ay, bx, by, cx, cy] = cornersOf(model, frame, cell);
    const area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
    const second = ((x - ax) * (cy - ay) - (y - ay) * (cx - ax)) / area;
    const third = ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / area;
    if (second >= 0 && third >= 0 && second + third <= 1)
      return { body, cell, weights: [1 - second - third, second, third] };
  }
  return null;
}

function cornersOf(model, frame, cell) {
  return [0, 1, 2].flatMap((corner) => {
    const point = model.cells[3 * cell + corner];
    return [frame.place[2 * point], frame.place[2 * point + 1]];
  });
}

/// Where a hit's material point is now, not wrapped.
function placeOf(model, frame, hit) {
  if (hit.cell < 0) return hit.place;
  const corners = cornersOf(model, frame, hit.cell);
  const at = (axis) => hit.weights.reduce((s, w, i) => s + w * corners[2 * i + axis], 0);
  return [at(0), at(1)];
}

/// Value of a field at a hit: {value, parts} with the components of a vector; value is NaN where there is none.
function valueAt(model, frame, field, values, hit) {
  if (field.at === "outlines") return { value: alongOutline(model, frame, values, hit) };
  if (hit.cell < 0) return { value: NaN };
  if (field.at === "cells") return { value: values[hit.cell] };
  const half = values.length / 2;
  const parts = [0, half].map((offset) =>
    hit.weights.reduce((s, w, i) => s + w * values[offset + model.cells[3 * hit.cell + i]], 0));
  return { value: Math.hypot(...parts), parts };
}

/// At the nearest place of the body's outline.
function alongOutline(model, frame, values, hit) {
  const { segments, segmentStart, outlinePoints } = model, { place } = frame, [x, y] = placeOf(model, frame, hit);
  const wrap = (dx) => (hit.cell < 0 && about.period !== null ? dx - Math.round(dx / about.period) * about.period : dx);
  let nearest = Infinity, value = NaN;
  for (let s = segmentStart[hit.body]; s < segmentStart[hit.body + 1]; s++) {
    const i = segments[2 * s], j = segments[2 * s + 1], a = outlinePoints[i], b = outlinePoints[j];
    const ax = wrap(place[2 * a] - x), ay = place[2 * a + 1] - y;
    const bx = ax + wrap(place[2 * b] - place[2 * a]), by = place[2 * b + 1] - y;
    const length = (bx - ax) ** 2 + (by - ay) ** 2;
    const share = length ? Math.min(Math.max((ax * (ax - bx) + ay * (ay - by)) / length, 0), 1) : 0;
    const distance = (ax + share * (bx - ax)) ** 2 + (ay + share * (by - ay)) ** 2;
    if (distance < nearest) {
      nearest = distance;
      value = (1 - share) * values[i] + share * values[j];
    }
  }
  return value;
}

const kindNames = ["compliant", "rigid", "wall"];

function withUnit(value, field) {
  const text = (value * field.factor).toFixed(field.digits), sign = Number(text) < 0 ? "\u2212" : "";
  return `${sign}${text.replace("-", "")} ${field.unit}`.trim();
}

/// Lines that tell what is at a hit.
function told(model, frame, field, values, hit) {
  const lines = [`body ${hit.body}, ${kindNames[model.kind[hit.body]]}`];
  if (!field) return lines;
  const { value, parts } = valueAt(model, frame, field, values, hit);
  if (Number.isNaN(value)) return [...lines, `${field.label}: none`];
  const beyond = value > field.high + field.step / 2 || value < field.low - field.step / 2 ? ", beyond the scale" : "";
  lines.push(`${field.label}: ${withUnit(value, field)}${beyond}`);
  if (parts) lines.push(`x ${withUnit(parts[0], field)}, y ${withUnit(parts[1], field)}`);
  return lines;
}
