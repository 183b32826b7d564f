"use strict";
/* Numbers of the page: unpacked, and a film played back from them. */

/** The bytes that `text` (base 64, deflated) holds. */
async function unpack(text) {
  if (!("DecompressionStream" in window)) {
    throw new Error("This browser cannot unpack the numbers of the page; any of the year 2023 or later can.");
  }
  const signs = atob(text.trim()), packed = new Uint8Array(signs.length);
  for (let i = 0; i < signs.length; i++) packed[i] = signs.charCodeAt(i);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** `count` single-precision numbers from byte `offset`. */
const floats = (bytes, offset, count) => new Float32Array(bytes.slice(offset, offset + 4 * count).buffer);

/** `count` whole numbers whose low bytes begin at `offset`, the high ones after them. */
function planes(bytes, offset, count) {
  const all = new Uint16Array(count);
  for (let i = 0; i < count; i++) all[i] = bytes[offset + i] | bytes[offset + count + i] << 8;
  return all;
}

/** For each particle of a frame of `n` its number in the frame before, -1 for a new one; null where all are the same. */
function origins(change, n, bytes) {
  if (!change) return null;
  const gone = floats(bytes, change.at, change.gone), fresh = floats(bytes, change.at + 4 * change.gone, change.new), from = new Int32Array(n);
  for (let k = 0, i = 0, g = 0, f = 0; k < n; k++) {
    if (fresh[f] === k) { from[k] = -1; f++; continue; }
    while (gone[g] === i) { g++; i++; }
    from[k] = i++;
  }
  return from;
}

/** The frames of `reel`: whole numbers by frame and channel. */
function unroll(reel, bytes) {
  let at = reel.offset, before = null;
  return reel.counts.map((n, f) => {
    const from = origins(reel.changes[f], n, bytes);
    const now = reel.channels.map((_, c) => {
      const q = planes(bytes, at, n);
      at += 2 * n;
      if (!reel.alone[f]) for (let i = 0, b = before[c]; i < n; i++) {
        const then = from ? from[i] < 0 ? 0 : b[from[i]] : b[i];
        q[i] = then + ((q[i] >>> 1) ^ -(q[i] & 1));
      }
      return q;
    });
    return before = now;
  });
}

/** The frames of a run: where its particles and solids are at any time. */
class Film {
  constructor(run, bytes) {
    const { reel, stage } = run;
    this.run = run;
    this.times = reel.times;
    this.channels = reel.channels;
    this.dim = reel.channels.filter(c => "xyz".includes(c.name)).length;
    this.dp = (reel.dp || 0.01) * reel.apart;
    this.ranges = Object.fromEntries(reel.ranges);
    this.frames = unroll(reel, bytes);
    this.alone = reel.alone;
    this.following = i => {
      if (this.followed?.i !== i) {
        const from = origins(reel.changes[i + 1], reel.counts[i + 1], bytes), next = from && new Int32Array(reel.counts[i]).fill(-1);
        from?.forEach((p, k) => { if (p >= 0) next[p] = k; });
        this.followed = { i, next };
      }
      return this.followed.next;
    };
    this.moorings = reel.lines && { ...reel.lines, frames: unroll(reel.lines, bytes) };
    const { skins } = reel;
    this.poses = floats(bytes, skins.poses, stage ? 12 * reel.times.length * stage.solids.length : 0);
    this.solids = this.skins(stage ? stage.solids : [], skins, bytes);
    this.x = [0, 1, 2].map(() => new Float32Array(0));
    this.bounds = this.around();
  }

  skins(solids, skins, bytes) {
    const all = skins.counts.reduce((a, b) => a + b, 0);
    const local = skins.channels.map((c, k) => Float32Array.from(planes(bytes, skins.offsets[k], all), q => c.min + c.step * q));
    let from = 0;
    return solids.map((solid, i) => {
      const part = local.map(x => x.subarray(from, from + skins.counts[i]));
      from += skins.counts[i];
      return { ...solid, skin: part, count: skins.counts[i] };
    });
  }

  /** The frame at or before time `t`, and which part of the way to the next has gone. */
  locate(t) {
    const { times } = this;
    let i = 0, end = times.length - 1;
    while (i < end) { const m = (i + end + 1) >> 1; if (times[m] <= t + 1e-9) i = m; else end = m - 1; }
    if (i + 1 >= times.length || this.alone[i + 1]) return { i, a: 0 };
    return { i, a: Math.min(1, Math.max(0, (t - times[i]) / (times[i + 1] - times[i]))) };
  }

  /** Puts every particle where it is at time `t`: `n` of them, at `x`. */
  place(t) {
    const { i, a } = this.at = this.locate(t), now = this.frames[i];
    this.n = now[0].length;
    if (this.x[0].length !== this.n) this.x = this.x.map(() => new Float32Array(this.n));
    for (let c = 0; c < this.dim; c++) this.mix(c, i, a, this.x[c]);
  }

  /** Channel `c` between two frames. What leaps across a periodic side does not fly through the water. */
  mix(c, i, a, out) {
    const { min, step } = this.channels[c], p = this.frames[i][c];
    if (a < 1e-6) { for (let k = 0; k < out.length; k++) out[k] = min + step * p[k]; return; }
    const q = this.frames[i + 1][c], most = c < this.dim ? 0.5 * this.span[c] : Infinity;
    // A particle that is not in the next frame stays.
    const next = this.following(i);
    for (let k = 0; k < out.length; k++) {
      const d = next ? next[k] < 0 ? 0 : q[next[k]] - p[k] : q[k] - p[k];
      out[k] = min + step * (p[k] + (d > most || d < -most ? 0 : a * d));
    }
  }

  /** The values of `field` for the particles where they were placed. */
  values(field) {
    const name = field === "excess" ? "pressure" : field, c = this.channels.findIndex(k => k.name === name);
    const out = new Float32Array(this.n);
    if (c < 0) return out.fill(NaN);
    this.mix(c, this.at.i, this.at.a, out);
    if (field === "excess") {
      const { rho0, g, level } = this.run.stage, z = this.x[this.dim - 1];
      for (let k = 0; k < out.length; k++) out[k] -= rho0 * g * Math.max(0, level - z[k]);
    }
    return out;
  }

  /** Pose of solid `s` where it was placed: three coordinates and a matrix, row by row. */
  pose(s) {
    const { i, a } = this.at, count = this.solids.length, from = 12 * (i * count + s);
    const p = this.poses.subarray(from, from + 12);
    if (a < 1e-6) return p;
    const q = this.poses.subarray(from + 12 * count, from + 12 * count + 12);
    return p.map((x, k) => x + a * (q[k] - x));
  }

  /** The springs and ropes where they were placed: the ends of each, m. */
  ties() {
    const { i, a } = this.at, { times } = this, t = times[i] + (a ? a * (times[i + 1] - times[i]) : 0);
    const acts = tie => tie.since <= t && (tie.until === null || t < tie.until);
    const place = (x, solid) => solid === null ? x : moved(this.pose(solid), x);
    return (this.run.stage?.ties ?? []).filter(acts).map(tie => tie.ends.map((x, k) => place(x, tie.solids[k])));
  }

  /** The springs, ropes and mooring lines where they were placed: the points of each, m. */
  lines() {
    const ties = this.ties();
    if (!this.moorings) return ties;
    const { i } = this.at, { frames, channels, alone, changes, nodes } = this.moorings;
    const a = i + 1 < frames.length && !alone[i + 1] && !changes[i + 1] ? this.at.a : 0;
    let from = 0;
    const moorings = nodes[i].map(n => {
      const line = Array.from({ length: n }, (_, k) => [0, 1, 2].map(c => {
        if (!channels[c]) return 0;
        const p = frames[i][c][from + k], q = a ? frames[i + 1][c][from + k] : p;
        return channels[c].min + channels[c].step * (p + a * (q - p));
      }));
      from += n;
      return line;
    });
    return [...ties, ...moorings];
  }

  /** The box that holds the water of all frames, but for single drops, and the moving solids: low and high corner. */
  around() {
    const low = [1e9, 1e9, 1e9], high = [-1e9, -1e9, -1e9];
    this.span = [0, 0, 0];
    const take = (c, x) => { low[c] = Math.min(low[c], x); high[c] = Math.max(high[c], x); };
    for (const frame of this.frames) for (let c = 0; c < this.dim; c++) {
      const sorted = frame[c].slice().sort(), last = sorted.length - 1, rare = Math.floor(0.005 * last);
      if (last < 0) continue;
      const a = sorted[rare], b = sorted[last - rare];
      this.span[c] = Math.max(this.span[c], sorted[last]);
      [a, b].forEach(q => take(c, this.channels[c].min + this.channels[c].step * q));
    }
    this.times.forEach((_, i) => {
      this.at = { i, a: 0 };
      this.solids.forEach((solid, s) => {
        if (solid.role === "fixed" && this.dim === 2) return;
        const pose = this.pose(s);
        for (const line of solid.lines) for (const x of line.points) moved(pose, x).forEach((x, c) => c < this.dim && take(c, x));
      });
      for (const line of this.lines()) for (const x of line) x.forEach((x, c) => c < this.dim && take(c, x));
    });
    return [low, high].map((x, k) => x.slice(0, this.dim).map(x => x + (k ? 2 : -2) * this.dp));
  }
}

/** The point `x` of a solid in the world. */
const moved = (p, x) => [0, 1, 2].map(i => p[i] + p[3 + 3 * i] * x[0] + p[4 + 3 * i] * x[1] + p[5 + 3 * i] * x[2]);
