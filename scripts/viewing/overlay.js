// Above the picture: the body under the pointer, marked bodies, the length of a bar.

const MARK = "#d6006c", HOVER = "#0072b2";

function drawOverlay(canvas, model, frame, view, shown, hover, marks) {
  const context = canvas.getContext("2d"), ratio = devicePixelRatio;
  context.clearRect(0, 0, view.width, view.height);
  const [left, right, top, bottom] = sheetInPixels(view);
  context.save();
  context.beginPath();
  context.rect(left, top, right - left, bottom - top);
  context.clip();
  if (hover) outline(context, model, view, shown, hover.body, HOVER, 2 * ratio);
  for (const mark of marks) {
    outline(context, model, view, shown, mark.body, MARK, 2.5 * ratio);
    if (mark.cell >= 0) cross(context, model, frame, view, mark, ratio);
  }
  context.restore();
  scaleBar(context, view, ratio);
}

function outline(context, model, view, shown, body, colour, width) {
  context.beginPath();
  for (const [seen, dx, dy] of shown.seen) if (seen === body) trace(context, model, body, shown.pixels, dx, dy);
  for (const wall of shown.walls) {
    if (wall.body !== body) continue;
    context.moveTo(view.px(wall.ax), view.py(wall.ay));
    context.lineTo(view.px(wall.bx), view.py(wall.by));
  }
  context.lineJoin = "round";
  stroked(context, "#ffffff", width * 1.8);
  stroked(context, colour, width);
}

function stroked(context, colour, width) {
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.stroke();
}

/// At the material point that was clicked, with the body's number.
function cross(context, model, frame, view, mark, ratio) {
  const [x, y] = placeOf(model, frame, mark), size = 4 * ratio;
  for (const [right, up] of shifts(frame, mark.body)) {
    const px = view.px(x + right), py = view.py(y + up);
    context.beginPath();
    for (const side of [-1, 1]) {
      context.moveTo(px - size, py - side * size);
      context.lineTo(px + size, py + side * size);
    }
    stroked(context, "#ffffff", 4 * ratio);
    stroked(context, MARK, 2 * ratio);
    label(context, `${mark.body}`, px + 1.6 * size, py, ratio);
  }
}

function label(context, text, px, py, ratio) {
  context.font = `600 ${12 * ratio}px ${fontFamily()}`;
  context.textBaseline = "middle";
  context.textAlign = "left";
  context.lineJoin = "round";
  context.strokeStyle = "#ffffff";
  context.lineWidth = 4 * ratio;
  context.strokeText(text, px, py);
  context.fillStyle = "#111";
  context.fillText(text, px, py);
}

function fontFamily() { return getComputedStyle(document.body).fontFamily; }

/// A round length, at most a fifth of the width.
function scaleBar(context, view, ratio) {
  const { factor, unit } = about.length, most = (0.2 * view.width / view.scale) * factor;
  const power = 10 ** Math.floor(Math.log10(most)), length = power * [5, 2, 1].find((step) => step * power <= most);
  const px = 14 * ratio, py = view.height - 14 * ratio, width = (length / factor) * view.scale;
  context.beginPath();
  context.moveTo(px, py - 5 * ratio);
  context.lineTo(px, py);
  context.lineTo(px + width, py);
  context.lineTo(px + width, py - 5 * ratio);
  context.lineJoin = "miter";
  stroked(context, "#ffffff", 5 * ratio);
  stroked(context, "#111", 1.8 * ratio);
  label(context, `${Number(length.toPrecision(6))} ${unit}`, px + width + 7 * ratio, py - 3 * ratio, ratio);
}
