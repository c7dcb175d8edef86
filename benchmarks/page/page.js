"use strict";
// Draws what stands in #data: a chart and a table in each section. A chart's aria-label says what it shows.

const data = JSON.parse(document.getElementById("data").textContent);
const colours = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#555555"];
const styles = ["circle", "rect", "triangle", "rectRot", "star"];
const giga = 1e9;
Chart.defaults.animation = false;
Chart.defaults.font.family = '"DejaVu Sans", "Liberation Sans", Arial, sans-serif';
Chart.defaults.font.size = 12;
Chart.defaults.color = "#333";
Chart.defaults.maintainAspectRatio = false;

const short = (commit) => commit.slice(0, 8);
const isPowerOfTen = (x) => Number.isInteger(Math.round(1e6 * Math.log10(x)) / 1e6);
const signed = (x, digits) => (x < 0 ? "\u2212" : "+") + Math.abs(x).toFixed(digits);
const grouped = (x) => Math.round(x).toString().replace(/\B(?=(\d{3})+$)/g, "\u202f");

function add(parent, tag, text, className) {
  const element = document.createElement(tag);
  if (text !== undefined) element.textContent = text;
  if (className) element.className = className;
  return parent.appendChild(element);
}

function missing(section, text) { add(document.getElementById(section), "p", text, "missing"); }

function draw(section, configuration, label) {
  const box = add(document.getElementById(section), "div", undefined, "chart");
  const canvas = add(box, "canvas");
  canvas.setAttribute("role", "img");
  const chart = new Chart(canvas, configuration);
  canvas.setAttribute("aria-label", label(chart));
}

/// Rows of texts; columns from `numbers` on hold numbers.
function table(section, head, rows, numbers = 1) {
  const element = add(document.getElementById(section), "table");
  const kind = (column) => (column >= numbers ? "number" : undefined);
  const fill = (row, tag, cells) => cells.forEach((cell, i) => add(row, tag, cell, kind(i)));
  fill(add(add(element, "thead"), "tr"), "th", head);
  const body = add(element, "tbody");
  for (const cells of rows) {
    const row = add(body, "tr");
    row.dataset.name = cells[0];
    fill(row, "td", cells);
  }
}

const look = (i) => ({
  borderColor: colours[i % colours.length], backgroundColor: colours[i % colours.length], borderWidth: 1.5,
  pointStyle: styles[Math.floor(i / colours.length) % styles.length], pointRadius: 4, tension: 0, spanGaps: true,
  borderDash: i < colours.length ? [] : [6, 4],
});

function overCommits(section, labels, datasets, title) {
  draw(section, {
    type: "line",
    data: { labels, datasets },
    options: {
      scales: {
        x: { offset: true, title: { display: true, text: "commit" } },
        y: { title: { display: true, text: title } },
      },
      plugins: {
        legend: {
          position: datasets.length > 4 ? "right" : "top",
          labels: { usePointStyle: true, boxWidth: 8, boxHeight: 7 },
        },
      },
    },
  }, (chart) => chart.data.datasets.map((set, i) =>
    `${set.label}: ${chart.getDatasetMeta(i).data.length} points, last ${set.data[set.data.length - 1]}`).join("; "));
}

function drawCounts(lines) {
  if (lines.length === 0) return missing("counts", "No counts yet: ./pliant bench gate --update writes them.");
  const names = [...new Set(lines.flatMap((line) => Object.keys(line.instructions)))];
  const values = (name) => lines.map((line) => line.instructions[name]);
  const first = (name) => values(name).find((value) => value !== undefined);
  const change = (name, value) => (value === undefined ? null : 100 * (value / first(name) - 1));
  overCommits("counts", lines.map((line) => short(line.commit)),
    names.map((name, i) => ({ ...look(i), label: name, data: values(name).map((value) => change(name, value)) })),
    "instructions, change in %");
  const last = lines[lines.length - 1].instructions;
  table("counts", ["counted", `at ${short(lines[lines.length - 1].commit)}`, "since the one before", "since the first"],
    names.filter((name) => name in last).map((name) => {
      const before = values(name).filter((value) => value !== undefined).slice(-2)[0];
      return [name, grouped(last[name]), signed(100 * (last[name] / before - 1), 2) + " %",
        signed(change(name, last[name]), 2) + " %"];
    }));
}

function drawSeconds(lines) {
  if (lines.length === 0) return missing("seconds", "No seconds yet: ./pliant bench ab BASE HEAD --record adds them.");
  const commits = [...new Set(lines.map((line) => line.commit))];
  const series = [...new Set(lines.map((line) => line.of))];
  const median = (of, commit) =>
    lines.filter((line) => line.of === of && line.commit === commit).pop()?.median ?? null;
  overCommits("seconds", commits.map(short),
    series.map((of, i) => ({ ...look(i), label: of, data: commits.map((commit) => median(of, commit)) })),
    "seconds, median");
  table("seconds", ["commit", "scene and machine", "date", "median, s", "least, s", "runs"], lines.map((line) =>
    [short(line.commit), line.of, line.date.slice(0, 10), line.median.toFixed(3), line.minimum.toFixed(3),
      `${line.runs}`]), 3);
}

/// Writes each dataset's name beside its last point or below the one at `nameAt`; further down where another stands.
const names = {
  id: "names",
  afterDatasetsDraw(chart) {
    const { ctx, chartArea } = chart, taken = [];
    ctx.save();
    ctx.font = '12px "DejaVu Sans", "Liberation Sans", Arial, sans-serif';
    ctx.textBaseline = "middle";
    chart.data.datasets.forEach((set, i) => {
      const points = chart.getDatasetMeta(i).data, at = points[set.nameAt ?? points.length - 1];
      const width = ctx.measureText(set.label).width;
      const right = at.x + 9 + width < chartArea.right;
      const x = set.nameBelow ? at.x + 6 : right ? at.x + 9 : at.x - 9 - width;
      let y = at.y + (set.nameBelow ?? 0);
      while (taken.some((t) => x < t.x + t.width && t.x < x + width && Math.abs(y - t.y) < 13)) y += 2;
      taken.push({ x, y, width });
      ctx.fillStyle = "rgba(255, 255, 255, 0.8)";
      ctx.fillRect(x - 1, y - 7, width + 2, 14);
      ctx.fillStyle = set.borderColor;
      ctx.fillText(set.label, x, y);
    });
    ctx.restore();
  },
};

function drawRooflines(roofs) {
  if (roofs.length === 0) missing("roofline", "No roofline yet: ./pliant bench kernels --json measures it.");
  roofs.forEach(drawRoofline);
}

function drawRoofline(roof) {
  add(document.getElementById("roofline"), "h3", roof.threads === 1 ? "One thread" : `${roof.threads} threads`);
  const bandwidths = Object.entries(roof.bandwidths).sort((a, b) => b[1] - a[1]);
  const at = (intensity, bandwidth) => Math.min(roof.peak, intensity * bandwidth);
  const ridges = bandwidths.map(([, bandwidth]) => roof.peak / bandwidth);
  const intensities = [...roof.kernels.map((kernel) => kernel.intensity), ...ridges];
  const low = 10 ** Math.floor(Math.log10(Math.min(...intensities) / 1.5));
  const high = 10 ** Math.ceil(Math.log10(Math.max(...intensities) * 1.5));
  const line = (label, points, nameAt, nameBelow) => ({
    label, nameAt, nameBelow, data: points, showLine: true, borderColor: "#777", borderWidth: 1.5, pointRadius: 0,
  });
  const flat = { x: Math.min(...ridges), y: roof.peak / giga };
  const roofs = [
    line(`peak ${flat.y.toFixed(1)} GFLOP/s`, [flat, { x: high, y: flat.y }], 0, -11),
    ...bandwidths.map(([name, bandwidth]) => line(`${name} ${(bandwidth / giga).toFixed(1)} GB/s`,
      [{ x: low, y: low * bandwidth / giga }, { x: roof.peak / bandwidth, y: flat.y }], 0, 11)),
  ];
  const kernels = roof.kernels.map((kernel, i) => ({
    ...look(i), label: kernel.name, data: [{ x: kernel.intensity, y: kernel.rate / giga }], pointRadius: 5,
    showLine: false,
  }));
  const axis = (text) => ({
    type: "logarithmic", title: { display: true, text },
    ticks: { callback: (value) => (isPowerOfTen(value) ? `${value}` : "") },
    grid: { color: (context) => (context.tick && isPowerOfTen(context.tick.value) ? "#ddd" : "#f6f6f6") },
  });
  draw("roofline", {
    type: "scatter",
    data: { datasets: [...roofs, ...kernels] },
    options: {
      scales: { x: { ...axis("operations a byte"), min: low, max: high }, y: axis("GFLOP/s") },
      plugins: { legend: { display: false } },
    },
    plugins: [names],
  }, (chart) => kernels.map((set, i) => {
    const point = chart.getDatasetMeta(roofs.length + i).data[0];
    return `${set.label} at ${chart.scales.x.getValueForPixel(point.x).toPrecision(3)}, ` +
      `${chart.scales.y.getValueForPixel(point.y).toPrecision(3)} GFLOP/s`;
  }).join("; "));
  const [nameOfSlowest, slowest] = bandwidths[bandwidths.length - 1];
  const share = (rate, most) => `${(100 * rate / most).toFixed(1)} %`;
  table("roofline", ["kernel", "operations a byte", "GFLOP/s", "of the peak", `of the roof of ${nameOfSlowest}`],
    roof.kernels.map(({ name, intensity, rate }) => [name, intensity.toFixed(2), (rate / giga).toFixed(2),
      share(rate, roof.peak), share(rate, at(intensity, slowest))]));
}

function drawScaling(scenes) {
  if (scenes.length === 0) return missing("scaling", "No prediction yet: ./pliant bench scaling makes it.");
  const threads = scenes[0].threads;
  draw("scaling", {
    type: "line",
    data: {
      labels: threads,
      datasets: scenes.map(({ scene, efficiency }, i) =>
        ({ ...look(i), label: scene, data: efficiency.map((share) => 100 * share) })),
    },
    options: {
      scales: {
        x: { title: { display: true, text: "threads" } },
        y: { min: 0, title: { display: true, text: "efficiency in %" } },
      },
      plugins: { legend: { position: "top", labels: { usePointStyle: true, boxWidth: 8, boxHeight: 7 } } },
    },
  }, (chart) => chart.data.datasets.map((set) => `${set.label}: ${set.data.map((y) => y.toFixed(0)).join(", ")} %`)
    .join("; "));
  table("scaling", ["scene", ...threads.map((n) => `ms, ${n}`)],
    scenes.map(({ scene, seconds }) => [scene, ...seconds.map((s) => (1e3 * s).toFixed(3))]));
}

drawCounts(data.counts);
drawSeconds(data.seconds);
drawRooflines(data.rooflines);
drawScaling(data.scaling);
