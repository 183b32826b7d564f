/* Pictures of particles, pixel by pixel, and the line of the free surface. */

/** A table of 256 colours, as pixels, from the few of `map`. */
function colours(map) {
  return Uint32Array.from({ length: 256 }, (_, k) => {
    const place = k / 255 * (map.length - 1), i = Math.min(map.length - 2, Math.floor(place));
    const mix = shift => {
      const a = map[i] >> shift & 255, b = map[i + 1] >> shift & 255;
      return Math.round(a + (place - i) * (b - a));
    };
    return (255 << 24 | mix(0) << 16 | mix(8) << 8 | mix(16)) >>> 0;
  });
}

/** A colour of a map for style sheets. */
const hex = colour => "#" + colour.toString(16).padStart(6, "0");

/** Pixels with a depth, and who is seen in each. */
class Raster {
  constructor() { this.canvas = document.createElement("canvas"); }

  clear(width, height, deep) {
    if (this.canvas.width !== width || this.canvas.height !== height || !this.image) {
      Object.assign(this.canvas, { width, height });
      this.context = this.canvas.getContext("2d");
      this.image = this.context.createImageData(width, height);
      this.pixels = new Uint32Array(this.image.data.buffer);
      this.depth = null;
    }
    this.pixels.fill(0);
    Object.assign(this, { width, height });
    if (deep) {
      this.depth ??= new Float32Array(width * height);
      this.who ??= new Int32Array(width * height);
      if (this.who.length !== width * height) this.who = new Int32Array(width * height);
      this.depth.fill(-Infinity);
      this.who.fill(-1);
    }
  }

  show() { this.context.putImageData(this.image, 0, 0); return this.canvas; }

  /** A disc of radius `r` at (`x`, `y`), smooth at its edge; a square where it is but a few pixels wide. */
  disc(x, y, r, colour) {
    const { width, height, pixels } = this;
    if (x + r < 0 || y + r < 0 || x - r >= width || y - r >= height) return;
    if (r < 1.6) {
      const side = Math.max(1, Math.round(2 * r)), x0 = Math.round(x - side / 2), y0 = Math.round(y - side / 2);
      for (let j = Math.max(0, y0); j < Math.min(height, y0 + side); j++)
        for (let i = Math.max(0, x0); i < Math.min(width, x0 + side); i++) pixels[j * width + i] = colour;
      return;
    }
    const rim = r + 0.5, x0 = Math.max(0, Math.floor(x - rim)), x1 = Math.min(width - 1, Math.ceil(x + rim));
    const y1 = Math.min(height - 1, Math.ceil(y + rim));
    for (let j = Math.max(0, Math.floor(y - rim)); j <= y1; j++) for (let i = x0; i <= x1; i++) {
      const d2 = (i + 0.5 - x) ** 2 + (j + 0.5 - y) ** 2;
      if (d2 >= rim * rim) continue;
      const cover = Math.min(1, rim - Math.sqrt(d2)), k = j * width + i;
      if (cover > 0.5 && pixels[k] >>> 24) pixels[k] = colour;
      else if (cover * 255 > pixels[k] >>> 24) pixels[k] = (colour & 0xffffff | cover * 255 << 24) >>> 0;
    }
  }

  /** A ball of radius `r` at (`x`, `y`), the nearer the larger `z`, lit from above; `who` it is. */
  ball(x, y, z, r, colour, who) {
    const { width, height, pixels, depth } = this;
    if (x + r < 0 || y + r < 0 || x - r >= width || y - r >= height) return;
    const x0 = Math.max(0, Math.floor(x - r)), x1 = Math.min(width - 1, Math.ceil(x + r)), y1 = Math.min(height - 1, Math.ceil(y + r));
    const r2 = Math.max(r * r, 0.5);
    for (let j = Math.max(0, Math.floor(y - r)); j <= y1; j++) for (let i = x0; i <= x1; i++) {
      const dx = i + 0.5 - x, dy = j + 0.5 - y, d2 = dx * dx + dy * dy;
      if (d2 > r2) continue;
      const up = Math.sqrt(r2 - d2), k = j * width + i;
      if (z + up <= depth[k]) continue;
      depth[k] = z + up;
      this.who[k] = who;
      const light = r < 1.5 ? 1 : 0.62 + 0.38 * Math.max(0, (0.75 * up - 0.45 * dy - 0.3 * dx) / Math.sqrt(r2));
      pixels[k] = (255 << 24 | (colour >>> 16 & 255) * light << 16 | (colour >>> 8 & 255) * light << 8 | (colour & 255) * light) >>> 0;
    }
  }
}

/**
 * The free surface: where water and solids together fill half of the space, beside water. Points in metres on the sheet,
 * `dp` apart; `box` is the part of the sheet that is looked at. Segments, four numbers each.
 */
function surface(water, solids, dp, box) {
  const [x0, y0, x1, y1] = box, g = Math.max(1.25 * dp, Math.sqrt((x1 - x0) * (y1 - y0) / 4e5));
  const nx = Math.ceil((x1 - x0) / g) + 1, ny = Math.ceil((y1 - y0) / g) + 1;
  if (!(nx > 1 && ny > 1)) return [];
  const wet = new Float32Array(nx * ny), all = new Float32Array(nx * ny), share = (dp / g) ** 2;
  const add = (into, { x, y, near, n }) => {
    for (let k = 0; k < n; k++) {
      const u = (x[k] - x0) / g, v = (y[k] - y0) / g, i = Math.round(u), j = Math.round(v);
      if (!(i > 0 && j > 0 && i < nx - 1 && j < ny - 1)) continue;
      const a = u - i, b = v - j;
      const p = [0.5 * (0.5 - a) ** 2, 0.75 - a * a, 0.5 * (0.5 + a) ** 2], q = [0.5 * (0.5 - b) ** 2, 0.75 - b * b, 0.5 * (0.5 + b) ** 2];
      for (let s = 0; s < 3; s++) for (let r = 0; r < 3; r++) into[(j + s - 1) * nx + i + r - 1] += share * near[k] * p[r] * q[s];
    }
  };
  add(wet, water);
  all.set(wet);
  solids.forEach(solid => add(all, solid));
  const lines = [], cut = (i, j, k, l) => {
    const a = all[j * nx + i] - 0.5, b = all[l * nx + k] - 0.5;
    if (a < 0 === b < 0) return null;
    const s = a / (a - b);
    return [x0 + g * (i + s * (k - i)), y0 + g * (j + s * (l - j))];
  };
  for (let j = 0; j + 1 < ny; j++) for (let i = 0; i + 1 < nx; i++) {
    const k = j * nx + i;
    if (Math.max(wet[k], wet[k + 1], wet[k + nx], wet[k + nx + 1]) < 0.3) continue;
    const ends = [cut(i, j, i + 1, j), cut(i + 1, j, i + 1, j + 1), cut(i + 1, j + 1, i, j + 1), cut(i, j + 1, i, j)].filter(Boolean);
    for (let e = 0; e + 1 < ends.length; e += 2) lines.push(...ends[e], ...ends[e + 1]);
  }
  return lines;
}
