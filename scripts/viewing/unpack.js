// Chunks of the page: base64, deflated; packing.py writes them. Frames and fields are inflated when they are shown.

const about = JSON.parse(document.getElementById("about").textContent);
const KEPT = 10;  // decoded parts of frames

async function bytes(name) {
  const text = atob(document.getElementById(`chunk-${name}`).textContent);
  const packed = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) packed[i] = text.charCodeAt(i);
  const inflated = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(inflated).arrayBuffer());
}

/// Whole numbers; NaN for what is missing.
function unpacked(raw) {
  const planes = raw[0], count = (raw.length - 1) / planes, numbers = new Float64Array(count);
  for (let plane = 0, at = 1, weight = 1; plane < planes; plane++, weight *= 256)
    for (let i = 0; i < count; i++, at++) numbers[i] += weight * raw[at];
  for (let i = 0; i < count; i++) {
    const code = numbers[i], half = Math.floor(code / 2);
    numbers[i] = code === 0 ? NaN : code === 2 * half ? -half : half;
  }
  return numbers;
}

async function whole(name) { return Int32Array.from(unpacked(await bytes(name))); }

async function summed(name) {
  const numbers = await whole(name);
  for (let i = 1; i < numbers.length; i++) numbers[i] += numbers[i - 1];
  return numbers;
}

/// Where each body's entries begin in a list that goes body by body.
function starts(bodies, of) {
  const start = new Int32Array(bodies + 1);
  for (const body of of) start[body + 1]++;
  for (let body = 0; body < bodies; body++) start[body + 1] += start[body];
  return start;
}

/// What does not change: kinds, shapes, cells and segments, body by body.
async function loadModel() {
  const kind = await whole("kind"), body = await summed("body"), bodies = kind.length;
  const shape = unpacked(await bytes("shape")).map((code) => code * about.fine);
  const cellBody = await summed("cell-body");
  const model = {
    kind, body, bodies, points: body.length, shape, soft: await summed("soft"), cells: await summed("cells"),
    cellStart: starts(bodies, cellBody), outlinePoints: new Int32Array(0), segments: new Int32Array(0),
    segmentStart: new Int32Array(bodies + 1),
  };
  if (about.outlines) {
    model.outlinePoints = await summed("outline-points");
    model.segments = await summed("segments");
    model.segmentStart = starts(bodies, await summed("segment-body"));
  }
  return model;
}

const parts = new Map();  // names to promises, the oldest first

function kept(name, make) {
  const found = parts.get(name) ?? make();
  parts.delete(name);
  parts.set(name, found);
  if (parts.size > KEPT) parts.delete(parts.keys().next().value);
  return found;
}

/// Positions of all points (x, y, x, y, ...) and boxes of all bodies (left, right, low, high), m; the cell's
/// sides [ax, ay, bx, by], m, or null.
function loadFrame(model, index) {
  return kept(`frame-${index}`, async () => {
    const motion = new Float32Array((await bytes(`motion-${index}`)).buffer);
    const apart = unpacked(await bytes(`apart-${index}`));
    return { ...placed(model, motion, apart), cell: about.cells?.[index] ?? null };
  });
}

function placed(model, motion, apart) {
  const { points, body, shape, soft, bodies } = model, place = new Float64Array(2 * points);
  for (let i = 0; i < points; i++) {
    place[2 * i] = shape[i];
    place[2 * i + 1] = shape[points + i];
  }
  soft.forEach((point, i) => {
    place[2 * point] += about.step * apart[i];
    place[2 * point + 1] += about.step * apart[soft.length + i];
  });
  const boxes = new Float64Array(4 * bodies);
  for (let b = 0; b < bodies; b++) boxes.set([Infinity, -Infinity, Infinity, -Infinity], 4 * b);
  const cosine = new Float64Array(bodies), sine = new Float64Array(bodies);
  for (let b = 0; b < bodies; b++) {
    cosine[b] = Math.cos(motion[3 * b + 2]);
    sine[b] = Math.sin(motion[3 * b + 2]);
  }
  for (let i = 0; i < points; i++) {
    const b = body[i], own = place[2 * i], across = place[2 * i + 1];
    const x = motion[3 * b] + cosine[b] * own - sine[b] * across;
    const y = motion[3 * b + 1] + sine[b] * own + cosine[b] * across;
    place[2 * i] = x;
    place[2 * i + 1] = y;
    if (x < boxes[4 * b]) boxes[4 * b] = x;
    if (x > boxes[4 * b + 1]) boxes[4 * b + 1] = x;
    if (y < boxes[4 * b + 2]) boxes[4 * b + 2] = y;
    if (y > boxes[4 * b + 3]) boxes[4 * b + 3] = y;
  }
  return { place, boxes };
}

/// A field's values, body by body; the x and then the y components of one "at" points.
function loadField(field, index) {
  const name = field.once ? field.name : `${field.name}-${index}`;
  return kept(name, async () => {
    const values = unpacked(await bytes(name));
    for (let i = 0; i < values.length; i++) values[i] = field.centre + field.step * values[i];
    return values;
  });
}

/// Shifts [x, y] with which a body stands in the period or the cell, or enters it: whole bodies, and copies at edges.
function shifts(frame, body) {
  const period = about.period, { boxes, cell } = frame;
  if (cell) return shiftsInCell(cell, ...boxes.subarray(4 * body, 4 * body + 4));
  if (period === null) return [[0, 0]];
  const found = [], first = Math.floor(-boxes[4 * body + 1] / period) + 1;
  for (let k = first; boxes[4 * body] + k * period < period; k++) found.push([k * period, 0]);
  return found;
}

/// Of a box in a cell with the sides a and b: in coordinates along them, the cell is a unit square.
function shiftsInCell([ax, ay, bx, by], left, right, low, high) {
  const det = ax * by - ay * bx, x = (left + right) / 2, y = (low + high) / 2, found = [];
  const u = (x * by - y * bx) / det, v = (ax * y - ay * x) / det;
  const du = (Math.abs(by) * (right - left) + Math.abs(bx) * (high - low)) / (2 * Math.abs(det));
  const dv = (Math.abs(ay) * (right - left) + Math.abs(ax) * (high - low)) / (2 * Math.abs(det));
  for (let i = Math.floor(-u - du) + 1; u + i - du < 1; i++)
    for (let j = Math.floor(-v - dv) + 1; v + j - dv < 1; j++) found.push([i * ax + j * bx, i * ay + j * by]);
  return found;
}
