// Triangles into pixels. A pixel belongs to the triangle that its middle is in; two that share an edge leave no gap.

class Raster {
  constructor(width, height) {
    this.width = width;
    this.height = height;
    this.image = new ImageData(width, height);
    this.pixels = new Uint32Array(this.image.data.buffer);
    this.clip(0, width, 0, height);
  }

  /// Pixels that may be painted.
  clip(left, right, top, bottom) {
    this.left = Math.max(0, Math.ceil(left - 0.5));
    this.right = Math.min(this.width, Math.ceil(right - 0.5));
    this.top = Math.max(0, Math.ceil(top - 0.5));
    this.bottom = Math.min(this.height, Math.ceil(bottom - 0.5));
  }

  /// One colour where may be painted, another elsewhere.
  clear(inside, outside) {
    this.pixels.fill(outside);
    if (this.left >= this.right) return;
    for (let row = this.top; row < this.bottom; row++)
      this.pixels.fill(inside, row * this.width + this.left, row * this.width + this.right);
  }

  /// `paint(row start, first column, end column, row)` for each row of pixels in a triangle.
  rows(ax, ay, bx, by, cx, cy, paint) {
    let t;
    if (by < ay) { t = ax; ax = bx; bx = t; t = ay; ay = by; by = t; }
    if (cy < ay) { t = ax; ax = cx; cx = t; t = ay; ay = cy; cy = t; }
    if (cy < by) { t = bx; bx = cx; cx = t; t = by; by = cy; cy = t; }
    const first = Math.max(this.top, Math.ceil(ay - 0.5)), end = Math.min(this.bottom, Math.ceil(cy - 0.5));
    for (let row = first; row < end; row++) {
      const y = row + 0.5;
      const long = ax + (cx - ax) * ((y - ay) / (cy - ay));
      const short = y < by ? ax + (bx - ax) * ((y - ay) / (by - ay)) : bx + (cx - bx) * ((y - by) / (cy - by));
      const from = Math.max(this.left, Math.ceil((long < short ? long : short) - 0.5));
      const to = Math.min(this.right, Math.ceil((long < short ? short : long) - 0.5));
      if (from < to) paint(row * this.width, from, to, row);
    }
  }

  triangle(ax, ay, bx, by, cx, cy, colour) {
    const pixels = this.pixels;
    this.rows(ax, ay, bx, by, cx, cy, (start, from, to) => {
      for (let x = start + from; x < start + to; x++) pixels[x] = colour;
    });
  }

  /// Colours of the norm of a vector (u, v) that is linear over the triangle.
  vectors(ax, ay, bx, by, cx, cy, [au, av], [bu, bv], [cu, cv], scale) {
    const area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
    if (area === 0) return;
    const slope = (a, b, c) => [((b - a) * (cy - ay) - (c - a) * (by - ay)) / area,
      ((c - a) * (bx - ax) - (b - a) * (cx - ax)) / area];
    const [ux, uy] = slope(au, bu, cu), [vx, vy] = slope(av, bv, cv), pixels = this.pixels;
    this.rows(ax, ay, bx, by, cx, cy, (start, from, to, row) => {
      let u = au + ux * (from + 0.5 - ax) + uy * (row + 0.5 - ay);
      let v = av + vx * (from + 0.5 - ax) + vy * (row + 0.5 - ay);
      for (let x = start + from; x < start + to; x++, u += ux, v += vx) pixels[x] = scale.of(Math.sqrt(u * u + v * v));
    });
  }

  /// From a segment straight down (or up) to the edge of what may be painted.
  column(ax, ay, bx, by, down, colour) {
    if (ax > bx) [ax, ay, bx, by] = [bx, by, ax, ay];
    const from = Math.max(this.left, Math.ceil(ax - 0.5)), to = Math.min(this.right, Math.ceil(bx - 0.5));
    for (let x = from; x < to; x++) {
      const y = Math.ceil(ay + (by - ay) * ((x + 0.5 - ax) / (bx - ax)) - 0.5);
      const first = Math.max(this.top, down ? y : 0), end = Math.min(this.bottom, down ? this.bottom : y);
      for (let row = first; row < end; row++) this.pixels[row * this.width + x] = colour;
    }
  }
}

/// "#rrggbb" as a pixel.
function pixel(hex) {
  const [r, g, b] = [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));
  return ((255 << 24) | (b << 16) | (g << 8) | r) >>> 0;
}

/// Colours of a field's values: below the scale, 256 steps, above it; neutral where there is no value.
class ColourScale {
  constructor(field) {
    const palette = about.palettes[field.palette];
    this.colours = [palette.below, ...palette.colours, palette.above];
    this.pixels = Uint32Array.from(this.colours, pixel);
    this.neutral = pixel(about.colours.neutral);
    this.low = field.low;
    this.factor = 256 / (field.high - field.low);
    this.margin = 256 + 1e-6;  // the end of the scale belongs to it
  }

  /// Index of the colour, -1 for none.
  index(value) {
    const at = (value - this.low) * this.factor;
    if (at >= 0) return at < 256 ? 1 + Math.floor(at) : at <= this.margin ? 256 : 257;
    return at < -1e-6 ? 0 : at < 0 ? 1 : -1;
  }

  of(value) {
    const index = this.index(value);
    return index < 0 ? this.neutral : this.pixels[index];
  }
}
