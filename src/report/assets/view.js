/* A picture of a film at a time, and what is under the pointer. */

const style = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/** A number with four digits that count, set as in print. */
function said(x) {
  if (!Number.isFinite(x)) return "–";
  const size = Math.abs(x);
  const text = x === 0 ? "0" : size >= 1e5 || size < 1e-3 ? x.toExponential(2) : x.toFixed(Math.min(6, Math.max(0, 3 - Math.floor(Math.log10(size)))));
  return text.replace("-", "−");
}

/** The same without zeros at its end. */
const plain = x => said(x).replace(/(\.\d*?)0+$/, "$1").replace(/\.$/, "");

/** Round numbers from `low` to `high`, about `count` of them. */
function marks(low, high, count) {
  const wished = (high - low) / count, ten = 10 ** Math.floor(Math.log10(wished));
  const step = [1, 2, 5, 10].map(x => x * ten).find(x => x >= 0.999 * wished) || wished, all = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) all.push(+(k * step).toPrecision(12));
  return all;
}

/** What lies nearer to a cut than half of dp is seen in it. */
const SEEN = 0.45;

const FIELDS = {
  pressure: { title: "pressure", unit: "Pa" },
  excess: { title: "pressure − still water’s", unit: "Pa" },
  speed: { title: "speed", unit: "m/s" },
};

/** One film on one canvas. `look` is shared by all views: field, range, camera, what is shown. */
class View {
  constructor(film, look, maps) {
    Object.assign(this, { film, look, maps, raster: new Raster(), near: null });
    this.canvas = document.createElement("canvas");
    this.context = this.canvas.getContext("2d");
    this.x = this.y = this.z = new Float32Array(0);
  }

  /** Directions on the sheet: to the right, up, towards the eye. */
  axes() {
    const { mode, yaw, pitch } = this.look;
    if (this.film.dim === 2 || mode === "z") return [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
    if (mode === "y") return [[1, 0, 0], [0, 0, 1], [0, -1, 0]];
    if (mode === "x") return [[0, 1, 0], [0, 0, 1], [1, 0, 0]];
    const s = Math.sin(yaw), c = Math.cos(yaw), S = Math.sin(pitch), C = Math.cos(pitch);
    return [[c, s, 0], [-s * S, c * S, C], [s * C, -c * C, S]];
  }

  get turning() { return this.film.dim === 3 && this.look.mode === "turn"; }

  /** The box of the film on the sheet: low and high corner, m. */
  extent() {
    const [low, high] = this.film.bounds, axes = this.axes(), out = [[1e9, 1e9], [-1e9, -1e9]];
    for (let k = 0; k < 8; k++) {
      const p = [0, 1, 2].map(i => (k >> i & 1 ? high : low)[i] ?? 0);
      axes.slice(0, 2).forEach((axis, i) => {
        const x = axis[0] * p[0] + axis[1] * p[1] + axis[2] * p[2];
        out[0][i] = Math.min(out[0][i], x);
        out[1][i] = Math.max(out[1][i], x);
      });
    }
    return out;
  }

  /** Gives the canvas the size at which the whole film fits, and finds the pixels of a metre there. */
  fit() {
    const ratio = Math.min(3, devicePixelRatio || 1), wide = this.canvas.parentElement.clientWidth || 600;
    const [low, high] = this.extent(), size = [high[0] - low[0], high[1] - low[1]];
    this.margin = this.turning ? [0, 0] : [40, 24];
    const inner = wide - this.margin[0] - 8, most = Math.max(220, 0.62 * Math.min(innerHeight, 1100));
    const tall = Math.min(most, Math.max(this.turning ? Math.min(most, 0.62 * wide) : 90, inner * size[1] / size[0]));
    this.base = Math.min(inner / size[0], tall / size[1]);
    this.middle = [0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])];
    const height = Math.round(tall + this.margin[1] + 8);
    if (this.canvas.width !== Math.round(wide * ratio) || this.canvas.height !== Math.round(height * ratio)) {
      this.canvas.width = Math.round(wide * ratio);
      this.canvas.height = Math.round(height * ratio);
      this.canvas.style.height = height + "px";
    }
    Object.assign(this, { ratio, wide, height });
  }

  /** Pixels a metre, and the pixel of a point of the sheet. */
  get scale() { return this.base * this.look.zoom; }
  pixel([x, y]) {
    const { scale, look, middle, margin, wide, height } = this;
    return [margin[0] + (wide - margin[0]) / 2 + scale * (x - middle[0] - look.pan[0]),
      (height - margin[1]) / 2 - scale * (y - middle[1] - look.pan[1])];
  }
  sheet([px, py]) {
    const { scale, look, middle, margin, wide, height } = this;
    return [(px - margin[0] - (wide - margin[0]) / 2) / scale + middle[0] + look.pan[0],
      ((height - margin[1]) / 2 - py) / scale + middle[1] + look.pan[1]];
  }

  /** Where on the sheet (m) and how deep the points `p` lie; the numbers of those that are seen, and how near to the cut. */
  project(p, n, cut) {
    const [u, v, d] = this.axes(), x = new Float32Array(n), y = new Float32Array(n), z = new Float32Array(n);
    const [a, b] = p, c = this.film.dim === 3 ? p[2] : null, near = new Float32Array(n).fill(1), { dp } = this.film;
    const axis = cut === null ? null : p["xyz".indexOf(this.look.mode)];
    let m = 0;
    const who = new Int32Array(n);
    for (let k = 0; k < n; k++) {
      if (axis && Math.abs(axis[k] - cut) >= dp) continue;
      if (axis) near[m] = 1 - Math.abs(axis[k] - cut) / dp;
      const w = c ? c[k] : 0;
      x[m] = u[0] * a[k] + u[1] * b[k] + u[2] * w;
      y[m] = v[0] * a[k] + v[1] * b[k] + v[2] * w;
      z[m] = d[0] * a[k] + d[1] * b[k] + d[2] * w;
      who[m++] = k;
    }
    return { x, y, z, who, near, n: m };
  }

  /** Place of the cut along its axis (m), or null where nothing is cut. */
  get cut() {
    const { look, film } = this, i = "xyz".indexOf(look.mode);
    return film.dim === 3 && i >= 0 ? film.bounds[0][i] + look.cut * (film.bounds[1][i] - film.bounds[0][i]) : null;
  }

  draw(t) {
    const { film, look, context: on, ratio } = this, css = { body: "--body", line: "--body-line", wall: "--wall", edge: "--wall-line", surface: "--surface", gauge: "--gauge", quiet: "--quiet", rule: "--rule", ink: "--ink" };
    for (const key in css) css[key] = style(css[key]);
    this.css = css;
    this.t = t;
    film.place(t);
    this.values = film.values(look.field);
    this.water = this.project(film.x, film.n, this.cut);
    this.skins = film.solids.map((solid, s) => this.project(this.carried(solid, film.pose(s)), solid.count, this.cut));
    on.setTransform(ratio, 0, 0, ratio, 0, 0);
    on.clearRect(0, 0, this.wide, this.height);
    on.save();
    on.beginPath();
    on.rect(this.margin[0], 0, this.wide - this.margin[0], this.height - this.margin[1]);
    on.clip();
    if (!this.turning) this.solids(on, solid => solid.role === "fixed");
    if (look.show.particles) this.particles(on);
    if (this.turning) this.edges(on);
    else {
      if (look.show.surface) this.surface(on);
    }
    this.moorings(on);
    if (!this.turning) this.solids(on, solid => solid.role !== "fixed");
    if (look.show.gauges) this.gauges(on);
    if (look.show.names) this.names(on);
    on.restore();
    if (this.turning) this.tripod(on); else this.ticks(on);
  }

  /** The boundary particles of a solid at `pose`, m. */
  carried(solid, pose) {
    const { dim } = this.film, out = [0, 1, 2].map(() => new Float32Array(solid.count)), local = solid.skin;
    for (let i = 0; i < dim; i++) for (let k = 0; k < solid.count; k++) {
      let x = pose[i];
      for (let j = 0; j < dim; j++) x += pose[3 + 3 * i + j] * local[j][k];
      out[i][k] = x;
    }
    return out;
  }

  particles(on) {
    const { raster, ratio, water, values, look, maps, film } = this, [low, high] = look.range;
    const width = Math.round((this.wide - this.margin[0]) * ratio), height = Math.round((this.height - this.margin[1]) * ratio);
    const table = maps[look.field], scale = this.scale * ratio, turning = this.turning;
    const [ox, oy] = this.pixel([0, 0]), X = (ox - this.margin[0]) * ratio, Y = oy * ratio;
    raster.clear(width, height, turning);
    const by = 255 / (high - low || 1), dp = scale * film.dp, r = dp * (turning ? 0.62 : dp < 8 ? 0.72 : 0.54);
    for (let k = 0; k < water.n; k++) {
      if (water.near[k] < SEEN) continue;
      const s = (values[water.who[k]] - low) * by, colour = table[s > 0 ? s < 255 ? s | 0 : 255 : 0];
      const x = X + scale * water.x[k], y = Y - scale * water.y[k];
      if (turning) raster.ball(x, y, scale * water.z[k], r, colour, water.who[k]);
      else raster.disc(x, y, r, colour);
    }
    this.skins.forEach((skin, s) => {
      const solid = film.solids[s];
      if (turning ? solid.role === "fixed" : solid.lines.length && film.dim === 2) return;
      const colour = turning ? 0xffa9bccb : solid.role === "fixed" ? 0xffa8a19b : 0xff8fa3b5;
      for (let k = 0; k < skin.n; k++) {
        if (skin.near[k] < SEEN) continue;
        const x = X + scale * skin.x[k], y = Y - scale * skin.y[k];
        if (turning) raster.ball(x, y, scale * skin.z[k], r, colour, -2 - s);
        else raster.disc(x, y, r, colour);
      }
    });
    on.drawImage(raster.show(), this.margin[0], 0, width / ratio, height / ratio);
  }

  /** The lines of solid `s` on the sheet, as a path. */
  outline(s) {
    const path = new Path2D(), pose = this.film.pose(s), [u, v] = this.axes();
    for (const line of this.film.solids[s].lines) {
      line.points.forEach((x, k) => {
        const p = moved(pose, x), at = this.pixel([u, v].map(a => a[0] * p[0] + a[1] * p[1] + a[2] * p[2]));
        if (k) path.lineTo(...at); else path.moveTo(...at);
      });
      if (line.closed) path.closePath();
    }
    return path;
  }

  solids(on, which) {
    if (this.film.dim === 3) return;
    this.film.solids.forEach((solid, s) => {
      if (!which(solid) || !solid.lines.length) return;
      const path = this.outline(s), fixed = solid.role === "fixed";
      on.fillStyle = fixed ? this.css.wall : this.css.body;
      on.strokeStyle = fixed ? this.css.edge : this.css.line;
      on.lineWidth = fixed ? 1 : 1.4;
      on.lineJoin = "round";
      on.fill(path);
      on.stroke(path);
    });
  }

  edges(on) {
    this.film.solids.forEach((solid, s) => {
      on.strokeStyle = solid.role === "fixed" ? this.css.edge : this.css.line;
      on.globalAlpha = solid.role === "fixed" ? 0.8 : 0.45;
      on.lineWidth = 1;
      on.stroke(this.outline(s));
    });
    on.globalAlpha = 1;
  }

  /** The springs, ropes and mooring lines; in a section what is near to it. */
  moorings(on) {
    const { film, cut } = this, [u, v] = this.axes(), axis = "xyz".indexOf(this.look.mode);
    const off = x => x[axis] - cut, crosses = (a, b) => off(a) * off(b) <= 0 || Math.min(Math.abs(off(a)), Math.abs(off(b))) < film.dp;
    on.beginPath();
    for (const line of film.lines()) line.forEach((x, k) => {
      const at = this.pixel([u, v].map(a => a[0] * x[0] + a[1] * x[1] + a[2] * x[2]));
      if (k && (cut === null || crosses(line[k - 1], x))) on.lineTo(...at); else on.moveTo(...at);
    });
    on.strokeStyle = this.css.line;
    on.lineJoin = on.lineCap = "round";
    on.lineWidth = 1.6;
    on.stroke();
  }

  surface(on) {
    const [x0, y1] = this.sheet([this.margin[0], 0]), [x1, y0] = this.sheet([this.wide, this.height - this.margin[1]]), { dp } = this.film;
    const lines = surface(this.water, this.skins, dp, [x0 - 3 * dp, y0 - 3 * dp, x1 + 3 * dp, y1 + 3 * dp]);
    // Water goes on beyond faces, periodic sides and symmetry planes.
    const axes = this.axes(), ends = [0, 1].map(i => (this.film.run.stage?.ends ?? []).filter(([axis]) => axes[i][axis] === 1).map(([, at]) => at));
    const goesOn = k => [0, 1].some(i => {
      const [p, q] = [lines[k + i], lines[k + 2 + i]], along = Math.abs(lines[k + 1 - i] - lines[k + 3 - i]);
      return along > Math.abs(p - q) && ends[i].some(at => Math.max(Math.abs(p - at), Math.abs(q - at)) < 1.5 * dp);
    });
    on.beginPath();
    for (let k = 0; k < lines.length; k += 4) {
      if (goesOn(k)) continue;
      on.moveTo(...this.pixel([lines[k], lines[k + 1]]));
      on.lineTo(...this.pixel([lines[k + 2], lines[k + 3]]));
    }
    on.strokeStyle = this.css.surface;
    on.lineCap = "round";
    on.lineWidth = 1.3;
    on.stroke();
  }

  /** Gauges: a dashed upright at a level's place, a ring at a point. */
  gauges(on) {
    const { film } = this, stage = film.run.stage, [u, v] = this.axes();
    if (!stage) return;
    const at = p => this.pixel([u, v].map(a => a[0] * p[0] + a[1] * p[1] + a[2] * (p[2] ?? 0)));
    stage.gauges.forEach(gauge => {
      const upright = gauge.what === "elevation", up = film.dim - 1;
      const ends = upright ? film.bounds.map(b => [...gauge.at, b[up]]) : [gauge.at, gauge.at];
      if (this.cut !== null && Math.abs(ends[0]["xyz".indexOf(this.look.mode)] - this.cut) > 3 * film.dp && !(upright && this.look.mode === "z")) return;
      const [a, b] = ends.map(at);
      on.beginPath();
      on.strokeStyle = this.css.gauge;
      on.lineWidth = 1.2;
      if (upright) {
        on.setLineDash([5, 4]);
        on.moveTo(...a);
        on.lineTo(...b);
      } else on.arc(a[0], a[1], 4, 0, 7);
      on.stroke();
      on.setLineDash([]);
      this.label(on, gauge.name, b[0], Math.max(12, upright ? b[1] + 10 : b[1] - 8), this.css.gauge);
    });
  }

  names(on) {
    const [u, v] = this.axes();
    this.film.solids.forEach((solid, s) => {
      if (solid.role === "fixed" || !this.skins[s].n && this.cut !== null) return;
      const p = this.film.pose(s), [x, y] = this.pixel([u, v].map(a => a[0] * p[0] + a[1] * p[1] + a[2] * p[2]));
      this.label(on, solid.name, x, Math.min(this.height - this.margin[1] - 6, Math.max(12, y + 4)), this.css.ink);
    });
  }

  label(on, text, x, y, colour) {
    on.font = "11px system-ui, sans-serif";
    on.textAlign = "center";
    on.lineWidth = 3;
    on.lineJoin = "round";
    on.strokeStyle = style("--card");
    on.strokeText(text, x, y);
    on.fillStyle = colour;
    on.fillText(text, x, y);
  }

  /** Metres along the edges. */
  ticks(on) {
    const { margin, wide, height, css } = this, [x0, y1] = this.sheet([margin[0], 0]), [x1, y0] = this.sheet([wide, height - margin[1]]);
    on.strokeStyle = css.rule;
    on.lineWidth = 1;
    on.strokeRect(margin[0] + 0.5, 0.5, wide - margin[0] - 1, height - margin[1] - 1);
    on.font = "11px system-ui, sans-serif";
    on.fillStyle = on.strokeStyle = css.quiet;
    on.textAlign = "center";
    on.beginPath();
    for (const x of marks(x0, x1, Math.max(2, wide / 110))) {
      const [px] = this.pixel([x, 0]);
      if (px > wide - 14 || px < margin[0] + 6) continue;
      on.moveTo(px, height - margin[1]);
      on.lineTo(px, height - margin[1] + 4);
      on.fillText(plain(x), px, height - margin[1] + 16);
    }
    on.textAlign = "right";
    for (const y of marks(y0, y1, Math.max(2, height / 70))) {
      const [, py] = this.pixel([0, y]);
      if (py < 8 || py > height - margin[1] - 2) continue;
      on.moveTo(margin[0] - 4, py);
      on.lineTo(margin[0], py);
      on.fillText(plain(y), margin[0] - 7, py + 4);
    }
    on.stroke();
    on.fillText("m", margin[0] - 7, height - margin[1] + 16);
  }

  /** Which way the axes point. */
  tripod(on) {
    const axes = this.axes(), at = [44, this.height - 40];
    ["x", "y", "z"].forEach((name, i) => {
      const [dx, dy] = [26 * axes[0][i], -26 * axes[1][i]];
      on.strokeStyle = on.fillStyle = this.css.quiet;
      on.beginPath();
      on.moveTo(...at);
      on.lineTo(at[0] + dx, at[1] + dy);
      on.stroke();
      on.font = "11px system-ui, sans-serif";
      on.textAlign = "center";
      on.fillText(name, at[0] + 1.35 * dx, at[1] + 1.35 * dy + 4);
    });
  }

  /** What is at the pixel (`px`, `py`) of the canvas, in words; null if nothing is. */
  read(px, py) {
    const { film, water, look } = this;
    if (!water) return null;
    let found = -1, solid = -1;
    if (this.turning) {
      const k = Math.round(py * this.ratio) * this.raster.width + Math.round(px * this.ratio), who = this.raster.who ? this.raster.who[k] : -1;
      if (who >= 0) found = who; else if (who <= -2) solid = -2 - who;
    } else {
      solid = film.dim === 2 ? film.solids.findLastIndex((body, s) => body.role !== "fixed" && this.context.isPointInPath(this.outline(s), px * this.ratio, py * this.ratio)) : -1;
      const [x, y] = this.sheet([px, py]);
      let best = Math.max(0.8 * film.dp, 5 / this.scale) ** 2;
      for (let k = 0; k < water.n && solid < 0; k++) {
        const d = (water.x[k] - x) ** 2 + (water.y[k] - y) ** 2;
        if (d < best && water.near[k] >= SEEN) { best = d; found = water.who[k]; }
      }
    }
    if (solid >= 0) {
      const p = film.pose(solid), turn = film.dim === 2 ? `, turned ${said(Math.atan2(p[6], p[3]) * 180 / Math.PI)}°` : "";
      return `${film.solids[solid].name} (${film.solids[solid].role})\nat ${[...p.slice(0, film.dim)].map(said).join(", ")} m${turn}`;
    }
    if (found < 0) return null;
    const place = film.x.slice(0, film.dim).map((x, i) => `${"xyz"[i]} ${said(x[found])}`).join(", ") + " m";
    const fields = Object.keys(FIELDS).filter(f => film.ranges[f]).map(f => `${FIELDS[f].title} ${said(f === look.field ? this.values[found] : film.values(f)[found])} ${FIELDS[f].unit}`);
    return [place, ...fields].join("\n");
  }
}
