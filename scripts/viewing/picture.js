// The picture: cells of grains, walls, outlines, and colours along outlines.

const PLAIN = pixel("#ffffff"), OUTSIDE = pixel("#eef0f2");
const kindPixels = about.colours.kinds.map(pixel), bodyPixel = pixel(about.colours.bodies);
const COMPLIANT = 0, WALL = 2;

/// Metres to pixels: the middle of the canvas and pixels a metre.
class View {
  constructor(width, height) {
    this.width = width;
    this.height = height;
    this.fit();
  }

  fit() {
    const [left, right, low, high] = about.box, margin = about.period !== null || about.cells ? 1.1 : 1.05;
    this.x = (left + right) / 2;
    this.y = (low + high) / 2;
    this.smallest = Math.min(this.width / (right - left || 1), this.height / (high - low || 1)) / margin;
    this.scale = this.smallest;
  }

  resize(width, height) {
    const whole = this.scale === this.smallest, share = this.scale / this.smallest, { x, y } = this;
    this.width = width;
    this.height = height;
    this.fit();
    if (!whole) Object.assign(this, { x, y, scale: share * this.smallest });
  }

  px(x) { return (x - this.x) * this.scale + this.width / 2; }
  py(y) { return (this.y - y) * this.scale + this.height / 2; }
  at(px, py) { return [this.x + (px - this.width / 2) / this.scale, this.y - (py - this.height / 2) / this.scale]; }

  zoom(factor, px = this.width / 2, py = this.height / 2) {
    const [x, y] = this.at(px, py);
    const scale = Math.min(Math.max(this.scale * factor, this.smallest / 4), this.smallest * 1e5);
    const change = this.scale / scale;
    Object.assign(this, { x: x + (this.x - x) * change, y: y + (this.y - y) * change, scale });
  }

  pan(dx, dy) {
    this.x -= dx / this.scale;
    this.y += dy / this.scale;
  }
}

/// Bodies in sight: [body, shift right, shift down] of each picture, and all points in pixels.
function projected(model, frame, view) {
  const pixels = new Float64Array(frame.place.length), { place, boxes } = frame;
  for (let i = 0; i < place.length; i += 2) {
    pixels[i] = view.px(place[i]);
    pixels[i + 1] = view.py(place[i + 1]);
  }
  const seen = [];
  for (let body = 0; body < model.bodies; body++) {
    if (model.kind[body] === WALL) continue;
    for (const [x, y] of shifts(frame, body)) {
      if (view.py(boxes[4 * body + 3] + y) > view.height || view.py(boxes[4 * body + 2] + y) < 0) continue;
      if (view.px(boxes[4 * body + 1] + x) > 0 && view.px(boxes[4 * body] + x) < view.width)
        seen.push([body, x * view.scale, -y * view.scale]);
    }
  }
  return { pixels, seen };
}

function paintCells(raster, model, shown, field, values, scale) {
  const { cells, cellStart, kind } = model, { pixels, seen } = shown, half = values ? values.length / 2 : 0;
  for (const [body, dx, dy] of seen) {
    for (let cell = cellStart[body]; cell < cellStart[body + 1]; cell++) {
      const a = cells[3 * cell], b = cells[3 * cell + 1], c = cells[3 * cell + 2];
      const ax = pixels[2 * a] + dx, bx = pixels[2 * b] + dx, cx = pixels[2 * c] + dx;
      const ay = pixels[2 * a + 1] + dy, by = pixels[2 * b + 1] + dy, cy = pixels[2 * c + 1] + dy;
      if (field && field.at === "points") {
        const [u, v, w] = [a, b, c].map((point) => [values[point], values[half + point]]);
        raster.vectors(ax, ay, bx, by, cx, cy, u, v, w, scale);
      } else {
        const colour = !field ? kindPixels[kind[body]] : field.at === "cells" ? scale.of(values[cell]) : bodyPixel;
        raster.triangle(ax, ay, bx, by, cx, cy, colour);
      }
    }
  }
}

/// Segments of walls, put into one period with copies of those that stand out: ends in m, outline points, whether the
/// wall is below the grains.
function wallSegments(model, frame) {
  const period = about.period, found = [], { boxes, place } = frame, middle = middleOfGrains(model, boxes);
  for (let body = 0; body < model.bodies; body++) {
    if (model.kind[body] !== WALL) continue;
    for (let s = model.segmentStart[body]; s < model.segmentStart[body + 1]; s++) {
      const points = [model.segments[2 * s], model.segments[2 * s + 1]];
      const [a, b] = points.map((point) => model.outlinePoints[point]);
      let [ax, ay, bx, by] = [place[2 * a], place[2 * a + 1], place[2 * b], place[2 * b + 1]];
      const below = (ay + by) / 2 < middle;
      const add = (shift) => found.push({ ax: ax - shift, ay, bx: bx - shift, by, points, below, body });
      if (period === null) { add(0); continue; }
      bx -= Math.round((bx - ax) / period) * period;
      const shift = Math.floor(Math.min(ax, bx) / period) * period;
      add(shift);
      if (Math.max(ax, bx) - shift > period) add(shift + period);
    }
  }
  return found;
}

function middleOfGrains(model, boxes) {
  let sum = 0, grains = 0;
  for (let body = 0; body < model.bodies; body++) {
    if (model.kind[body] === WALL) continue;
    sum += (boxes[4 * body + 2] + boxes[4 * body + 3]) / 2;
    grains++;
  }
  return grains ? sum / grains : 0;
}

/// Adds a body's outline to the path; points closer than a pixel's part to the last one are left out.
function trace(context, model, body, pixels, dx, dy) {
  const { segments, segmentStart, outlinePoints } = model;
  let last = -1, px = 0, py = 0;
  for (let s = segmentStart[body]; s < segmentStart[body + 1]; s++) {
    const a = outlinePoints[segments[2 * s]], b = outlinePoints[segments[2 * s + 1]];
    if (a !== last) {
      px = pixels[2 * a] + dx;
      py = pixels[2 * a + 1] + dy;
      context.moveTo(px, py);
    }
    last = b;
    const x = pixels[2 * b] + dx, y = pixels[2 * b + 1] + dy;
    if (s + 1 < segmentStart[body + 1] && Math.abs(x - px) + Math.abs(y - py) < 0.7) continue;
    context.lineTo(px = x, py = y);
  }
}

function strokeOutlines(context, model, shown, view, ratio) {
  const { pixels, seen, walls } = shown, size = grainSize * view.scale;
  context.beginPath();
  for (const [body, dx, dy] of seen) trace(context, model, body, pixels, dx, dy);
  for (const { ax, ay, bx, by } of walls) {
    context.moveTo(view.px(ax), view.py(ay));
    context.lineTo(view.px(bx), view.py(by));
  }
  context.lineWidth = Math.min(Math.max(0.025 * size, 0.35), 1.3 * ratio);
  context.strokeStyle = about.colours.edge;
  context.lineJoin = "round";
  context.stroke();
}

/// The cell, with a corner at the origin.
function strokeCell(context, [ax, ay, bx, by], view, ratio) {
  context.beginPath();
  for (const [x, y] of [[0, 0], [ax, ay], [ax + bx, ay + by], [bx, by]]) context.lineTo(view.px(x), view.py(y));
  context.closePath();
  context.lineWidth = 1.5 * ratio;
  context.strokeStyle = about.colours.cell;
  context.stroke();
}

/// A band on the inner side of each segment, in the colour of the mean of its ends, where anything acts.
function paintBands(raster, model, shown, field, values, scale, view, ratio) {
  const { segments, segmentStart, outlinePoints } = model, { pixels, seen, walls } = shown;
  const width = Math.min(Math.max(0.1 * grainSize * view.scale, 2 * ratio), 6 * ratio);
  const paint = (i, j, ax, ay, bx, by) => {  // counter-clockwise: inside is on the left
    if (!shownAlong(field, values[i], values[j])) return;
    const colour = scale.of((values[i] + values[j]) / 2), length = Math.hypot(bx - ax, by - ay) || 1;
    const dx = (width * (by - ay)) / length, dy = (-width * (bx - ax)) / length;
    raster.triangle(ax, ay, bx, by, bx + dx, by + dy, colour);
    raster.triangle(ax, ay, bx + dx, by + dy, ax + dx, ay + dy, colour);
  };
  for (const [body, dx, dy] of seen) {
    for (let s = segmentStart[body]; s < segmentStart[body + 1]; s++) {
      const i = segments[2 * s], j = segments[2 * s + 1], a = outlinePoints[i], b = outlinePoints[j];
      paint(i, j, pixels[2 * a] + dx, pixels[2 * a + 1] + dy, pixels[2 * b] + dx, pixels[2 * b + 1] + dy);
    }
  }
  for (const { ax, ay, bx, by, points, below } of walls) {
    const ends = [[view.px(ax), view.py(ay)], [view.px(bx), view.py(by)]];
    if (ax < bx === below) ends.reverse();  // solid is on the left
    paint(...points, ...ends[0], ...ends[1]);
  }
}

/// Damage and gaps have a value where they are; other fields of contacts are zero away from them.
function shownAlong(field, a, b) {
  if (Number.isNaN(a) || Number.isNaN(b)) return false;
  return field.name === "bond_damage" || field.name === "contact_gap" || a !== 0 || b !== 0;
}

let grainSize = 0;  // m, median extent of grains in the first frame that is drawn

function measureGrains(model, frame) {
  const extents = [];
  for (let body = 0; body < model.bodies; body++)
    if (model.kind[body] !== WALL) extents.push(frame.boxes[4 * body + 1] - frame.boxes[4 * body]);
  extents.sort((a, b) => a - b);
  grainSize = extents[extents.length >> 1] ?? 0;
}

/// Draws a frame; returns what is in sight.
function drawPicture(canvas, model, frame, view, field, values) {
  const ratio = devicePixelRatio, context = canvas.getContext("2d"), raster = new Raster(view.width, view.height);
  const scale = field && new ColourScale(field), shown = projected(model, frame, view);
  shown.walls = wallSegments(model, frame);
  if (!grainSize) measureGrains(model, frame);
  const [left, right, top, bottom] = sheetInPixels(view);
  raster.clip(left, right, top, bottom);
  raster.clear(PLAIN, OUTSIDE);
  paintCells(raster, model, shown, field, values, scale);
  for (const { ax, ay, bx, by, below } of shown.walls)
    raster.column(view.px(ax), view.py(ay), view.px(bx), view.py(by), below, kindPixels[WALL]);
  if (field && field.at === "outlines") paintBands(raster, model, shown, field, values, scale, view, ratio);
  context.putImageData(raster.image, 0, 0);
  context.save();
  context.beginPath();
  context.rect(left, top, right - left, bottom - top);
  context.clip();
  strokeOutlines(context, model, shown, view, ratio);
  if (frame.cell) strokeCell(context, frame.cell, view, ratio);
  context.restore();
  return shown;
}

/// Left, right, top and bottom of what is drawn: of a periodic scene one period.
function sheetInPixels(view) {
  if (about.period === null) return [0, view.width, 0, view.height];
  const [left, right, low, high] = about.box, margin = 0.04 * Math.max(high - low, 0.25 * (right - left));
  return [view.px(left), view.px(right), view.py(high + margin), view.py(low - margin)];
}
