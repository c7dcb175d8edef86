// A column of probes.csv over time, with a marker at the frame that is shown.

const CURVE = "#0072b2", MARKER = "#d55e00", AXIS = "#555", GRID = "#e3e5e8";
const columns = new Map();  // numbers to {time, values}

async function loadColumn(number) {
  if (!columns.has(number)) {
    const numbers = new Float32Array((await bytes(`probe-${number}`)).buffer), half = numbers.length / 2;
    columns.set(number, { time: numbers.subarray(0, half), values: numbers.subarray(half) });
  }
  return columns.get(number);
}

/// Linear between rows; NaN before the first and after the last.
function interpolated({ time, values }, t) {
  const margin = 1e-6 * time[time.length - 1];
  if (!(t >= time[0] - margin && t <= time[time.length - 1] + margin)) return NaN;
  let low = 0, high = time.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (time[middle] <= t) low = middle; else high = middle;
  }
  const share = time[high] > time[low] ? Math.min(Math.max((t - time[low]) / (time[high] - time[low]), 0), 1) : 0;
  return values[low] + share * (values[high] - values[low]);
}

/// Where the axes are, in CSS pixels, and what they span.
function axes(width, height, column, factor) {
  let low = Infinity, high = -Infinity;
  for (const value of column.values) {
    if (value < low) low = value;
    if (value > high) high = value;
  }
  if (low > 0 && low < 0.5 * high) low = 0;
  if (high < 0 && high > 0.5 * low) high = 0;
  const margin = 0.06 * (high - low) || 0.1 * Math.abs(high) || 1;
  [low, high] = [(low - margin) * factor, (high + margin) * factor];
  const end = Math.max(column.time[column.time.length - 1], about.times[about.times.length - 1]) * about.time.factor;
  const start = Math.min(column.time[0], about.times[0]) * about.time.factor;
  const area = { left: 64, right: width - 14, top: 8, bottom: height - 22 };
  return { low, high, start, end, ...area,
    x: (t) => area.left + ((t - start) / (end - start || 1)) * (area.right - area.left),
    y: (v) => area.bottom - ((v - low) / (high - low)) * (area.bottom - area.top),
    time: (px) => (start + ((px - area.left) / (area.right - area.left)) * (end - start)) / about.time.factor };
}

/// Draws the column; returns its axes and the value at time t.
function drawCurve(canvas, column, probe, t) {
  const ratio = devicePixelRatio, context = canvas.getContext("2d"), { factor } = probe;
  const [width, height] = [canvas.width / ratio, canvas.height / ratio], to = axes(width, height, column, factor);
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  context.font = `12px ${fontFamily()}`;
  drawAxes(context, to);
  context.beginPath();
  column.time.forEach((time, i) => context.lineTo(to.x(time * about.time.factor), to.y(column.values[i] * factor)));
  context.strokeStyle = CURVE;
  context.lineWidth = 1.4;
  context.lineJoin = "round";
  context.stroke();
  const value = interpolated(column, t), px = to.x(t * about.time.factor);
  context.beginPath();
  context.moveTo(px, to.top);
  context.lineTo(px, to.bottom);
  context.strokeStyle = MARKER;
  context.stroke();
  if (Number.isFinite(value)) {
    context.beginPath();
    context.arc(px, to.y(value * factor), 4, 0, 2 * Math.PI);
    context.fillStyle = MARKER;
    context.fill();
  }
  return { to, value };
}

function drawAxes(context, to) {
  context.fillStyle = AXIS;
  context.lineWidth = 1;
  const line = (ax, ay, bx, by, colour) => {
    context.strokeStyle = colour;
    context.beginPath();
    context.moveTo(Math.round(ax) + 0.5, Math.round(ay) + 0.5);
    context.lineTo(Math.round(bx) + 0.5, Math.round(by) + 0.5);
    context.stroke();
  };
  context.textAlign = "right";
  context.textBaseline = "middle";
  for (const value of ticks(to.low, to.high, Math.max(3, (to.bottom - to.top) / 30))) {
    line(to.left, to.y(value), to.right, to.y(value), GRID);
    context.fillText(round(value), to.left - 6, to.y(value));
  }
  context.textAlign = "center";
  context.textBaseline = "top";
  for (const value of ticks(to.start, to.end, Math.max(2, (to.right - to.left) / 90))) {
    line(to.x(value), to.top, to.x(value), to.bottom, GRID);
    context.fillText(round(value), to.x(value), to.bottom + 5);
  }
  context.textAlign = "right";
  context.fillText(`t [${about.time.unit}]`, to.left - 14, to.bottom + 5);
  line(to.left, to.top, to.left, to.bottom, AXIS);
  line(to.left, to.bottom, to.right, to.bottom, AXIS);
}
