
/* A page that follows a run in progress: buttons, rows and frames as the server sends them. */

/** Most frames, values of particles and rows of a table in the memory of the page; beyond that they are thinned. */
const MOST = { frames: 600, values: 12e6, rows: 12000 };

/** A film that grows. Values are kept as they are, so that none is outside the range of the first frames. */
class Growth {
  constructor(film) {
    this.film = film;
    const known = film.frames.map((_, i) => i && !film.alone[i] ? film.following(i - 1) : null);
    /** For each frame the numbers of the particles of the frame before in it; null if they are the same. */
    this.links = known;
    film.frames = film.frames.map(frame => plainFrame(frame, film.channels));
    film.span = film.span.map((x, c) => x * (film.channels[c]?.step ?? 0));
    film.channels = film.channels.map(c => ({ ...c, min: 0, step: 1 }));
    film.following = i => this.links[i + 1];
    if (film.moorings) this.looseLines(film.moorings);
  }

  looseLines(moorings) {
    moorings.frames = moorings.frames.map(frame => plainFrame(frame, moorings.channels));
    moorings.channels = moorings.channels.map(c => ({ ...c, min: 0, step: 1 }));
  }

  /** Adds the frames of `part` after the last one; whether there were any. */
  add(part) {
    const { film } = this, last = film.times.at(-1), before = film.times.length;
    part.times.forEach((t, i) => {
      if (t <= last + 1e-12) return;
      const linked = i > 0 && Math.abs(part.times[i - 1] - film.times.at(-1)) < 1e-12 && !part.alone[i];
      film.alone.push(!linked);
      this.links.push(linked ? part.following(i - 1) : null);
      film.times.push(t);
      film.frames.push(plainFrame(part.frames[i], part.channels));
      const wide = 12 * film.solids.length, poses = new Float32Array(film.poses.length + wide);
      poses.set(film.poses);
      poses.set(part.poses.subarray(wide * i, wide * (i + 1)), film.poses.length);
      film.poses = poses;
      if (part.moorings || film.moorings) this.addLines(part.moorings, i);
    });
    if (film.times.length === before) return false;
    film.span = film.span.map((x, c) => Math.max(x, part.span[c] * (part.channels[c]?.step ?? 0)));
    film.bounds = [0, 1].map(k => film.bounds[k].map((x, c) => Math[k ? "max" : "min"](x, part.bounds[k][c])));
    // A single frame at rest says nothing of the usual ranges.
    for (const field in part.ranges) {
      const own = before > 1 ? film.ranges[field] : null;
      film.ranges[field] = own ? [Math.min(own[0], part.ranges[field][0]), Math.max(own[1], part.ranges[field][1])] : [...part.ranges[field]];
    }
    const values = () => film.frames.reduce((sum, frame) => sum + frame.length * frame[0].length, 0);
    while (film.times.length > 2 && (film.times.length > MOST.frames || values() > MOST.values)) this.thin();
    return true;
  }

  addLines(part, i) {
    const { film } = this;
    if (!film.moorings) {
      const earlier = film.times.slice(0, -1), none = () => part.channels.map(() => new Float32Array(0));
      film.moorings = { channels: part.channels.map(c => ({ ...c, min: 0, step: 1 })), frames: earlier.map(none), nodes: earlier.map(() => []), alone: earlier.map(() => true), changes: earlier.map(() => null) };
    }
    const { moorings } = film, nodes = part ? part.nodes[i] : [];
    moorings.frames.push(part ? plainFrame(part.frames[i], part.channels) : moorings.channels.map(() => new Float32Array(0)));
    moorings.nodes.push(nodes);
    moorings.changes.push(null);
    moorings.alone.push(nodes.join() !== moorings.nodes.at(-2).join());
  }

  /** Leaves out every other frame, but neither the first nor the last. */
  thin() {
    const { film } = this, last = film.times.length - 1, kept = film.times.map((_, i) => i).filter(i => i % 2 === 0 || i === last);
    const same = (from, to) => { for (let i = from + 1; i <= to; i++) if (film.alone[i] || this.links[i]) return false; return true; };
    const alone = kept.map((i, k) => k === 0 || (kept[k - 1] === i - 1 ? film.alone[i] : !same(kept[k - 1], i)));
    this.links = kept.map((i, k) => k && kept[k - 1] === i - 1 ? this.links[i] : null);
    film.alone = alone;
    const wide = 12 * film.solids.length, poses = new Float32Array(wide * kept.length);
    kept.forEach((i, k) => poses.set(film.poses.subarray(wide * i, wide * (i + 1)), wide * k));
    film.poses = poses;
    film.frames = kept.map(i => film.frames[i]);
    film.times = kept.map(i => film.times[i]);
    const { moorings } = film;
    if (!moorings) return;
    for (const name of ["frames", "nodes", "changes"]) moorings[name] = kept.map(i => moorings[name][i]);
    moorings.alone = moorings.nodes.map((nodes, k) => !k || nodes.join() !== moorings.nodes[k - 1].join());
  }
}

/** The values of a frame in single precision. */
const plainFrame = (frame, channels) => frame.map((q, c) => Float32Array.from(q, x => channels[c].min + channels[c].step * x));

/** The rows of a table that grows, shared by the charts of its columns. */
class GrowingTable {
  constructor() { Object.assign(this, { t: null, columns: new Map(), charts: new Set() }); }

  /** Joins a line of a chart that shows column `index`. */
  join(chart, line, index) {
    this.t ??= Array.from(line.t);
    if (!this.columns.has(index)) this.columns.set(index, Array.from(line.x));
    this.charts.add(chart);
    this.refill(chart);
  }

  /** Adds rows, given as columns of which the first is the time. */
  add(rows) {
    const last = this.t.at(-1) ?? -Infinity;
    rows[0].forEach((t, i) => {
      if (Math.fround(t) <= last) return;
      this.t.push(t);
      this.columns.forEach((x, index) => x.push(rows[index + 1][i] ?? NaN));
    });
    if (this.t.length > MOST.rows) this.thin();
    this.charts.forEach(chart => { this.refill(chart); chart.stale = true; });
  }

  refill(chart) {
    for (const line of chart.what.lines) if (line.of === this) Object.assign(line, { t: this.t, x: this.columns.get(line.index) });
  }

  /** Keeps of each of many equal intervals the rows with the least and the greatest value of a column. */
  thin() {
    const all = this.t.length, columns = [...this.columns.values()], kept = new Set([0, all - 1]);
    const stretch = Math.ceil(all * 2 * columns.length / (MOST.rows / 2));
    for (let from = 0; from < all; from += stretch) for (const x of columns) {
      let low = from, high = from;
      for (let i = from; i < Math.min(all, from + stretch); i++) { if (!(x[i] >= x[low])) low = i; if (!(x[i] <= x[high])) high = i; }
      kept.add(low).add(high);
    }
    const order = [...kept].sort((a, b) => a - b);
    this.t = order.map(i => this.t[i]);
    for (const [index, x] of this.columns) this.columns.set(index, order.map(i => x[i]));
  }
}

/** Follows the run. */
class Live {
  constructor(home, told, { deck, films, charts }) {
    Object.assign(this, { home, told, deck, charts, events: 0, waiting: 0, token: new URLSearchParams(location.search).get("token") });
    this.growth = films.map(film => new Growth(film));
    this.bounds = JSON.stringify(films[0]?.bounds);
    this.tables = this.join(told.runs[0], charts);
    this.build();
    this.show(told.live.state);
    // The newest frame first: the player follows from there on.
    deck?.seek(deck.until);
    this.listen(`${told.live.rollbacks}.${told.live.position}`);
    addEventListener("scroll", () => this.refresh(), { passive: true });
  }

  /** The tables whose columns the charts show. */
  join(run, charts) {
    const tables = new Map(run.tables.map(table => [table.name, new GrowingTable()]));
    for (const chart of charts.all) for (const line of chart.what.lines) {
      const table = run.tables.find(table => line.series?.startsWith(table.name + "."));
      const index = table?.columns.findIndex(column => `${table.name}.${column.name}` === line.series) ?? -1;
      if (index < 0) continue;
      Object.assign(line, { of: tables.get(table.name), index });
      line.of.join(chart, line, index);
    }
    return tables;
  }

  build() {
    this.badge = document.querySelector(".badge") ?? make("span");
    this.bar = labelled(make("progress", { max: 1, value: 0 }), "Progress of the run");
    this.figures = make("output");
    this.message = make("div", { className: "message", role: "status" });
    this.pause = make("button", { type: "button", onclick: () => this.ask(this.state.paused ? "resume" : "pause") }, "Pause the run");
    this.checkpoint = make("button", { type: "button", onclick: () => { this.message.textContent = "The checkpoint is being written."; this.ask("checkpoint"); } }, "Write a checkpoint");
    this.controls = this.told.live.state.controls.map(({ key, unit, min, max, value }) => {
      const input = labelled(make("input", { type: "number", min, max, step: "any", value, onchange: () => this.set(key, input) }), `${key}, ${unit}`);
      input.title = `from ${plain(min)} to ${plain(max)} ${unit}`;
      return { key, input, element: make("label", {}, key, input, unit) };
    });
    this.home.append(make("div", { className: "live" }, this.pause, this.checkpoint, this.bar, this.figures, ...this.controls.map(control => control.element), this.message));
  }

  /** Changes a control to the value of its input. */
  set(key, input) {
    if (!input.value || !input.checkValidity()) {
      this.message.textContent = `${key} is a number ${input.title}.`;
      return;
    }
    this.message.textContent = "";
    this.ask("set", JSON.stringify({ key, value: +input.value }));
  }

  async ask(what, body) {
    try {
      const answer = await fetch(`${what}?token=${this.token}`, { method: "POST", body });
      // The next event shows the new state; an answer might come after a later one.
      if (!answer.ok) throw new Error(await answer.text());
    } catch (why) {
      this.message.textContent = `The run did not get the request: ${why.message}`;
    }
  }

  show(state) {
    const written = state.checkpoint !== null && state.checkpoint !== this.state?.checkpoint;
    const before = this.state;
    this.state = state;
    if (written) this.message.textContent = `A checkpoint was written at ${said(state.checkpoint)} s.`;
    this.pause.textContent = state.paused ? "Let the run go on" : "Pause the run";
    this.badge.textContent = state.held ? "paused" : state.paused ? "pausing after this step" : "running";
    this.badge.className = state.paused ? "badge odd" : "badge good";
    // What is being typed stays.
    state.controls.forEach(({ value }, i) => {
      const { key, input } = this.controls[i];
      if (before && before.controls[i].value !== value) this.message.textContent = `${key} is ${said(value)} from ${said(state.t)} s on.`;
      if (document.activeElement !== input && input.checkValidity()) input.value = value;
    });
    if (state.t === undefined) return;
    this.bar.value = state.t / state.until;
    this.figures.textContent = [`t = ${state.t.toFixed(3)} of ${state.until} s`, `step ${state.steps}`, `Δt ${said(state.dt)} s`, state.energy].filter(Boolean).join(", ");
  }

  listen(from) {
    const source = this.source = new EventSource(`events?token=${this.token}&from=${from}`);
    // One after the other: frames are unpacked asynchronously.
    let last = Promise.resolve();
    const follow = step => {
      this.waiting++;
      last = last.then(step).catch(why => { this.message.textContent = `An event of the run cannot be shown: ${why.message}`; }).then(() => { this.waiting--; });
    };
    source.addEventListener("tick", e => follow(() => this.tick(JSON.parse(e.data))));
    source.addEventListener("reload", () => { source.close(); location.reload(); });
    source.addEventListener("end", e => { source.close(); follow(() => this.end(JSON.parse(e.data))); });
    source.onopen = () => { if (this.lost) this.message.textContent = this.lost = ""; };
    source.onerror = () => { this.message.textContent = this.lost = "The connection to the run is lost; the page tries again."; };
  }

  async tick({ state, added }) {
    this.show(state);
    for (const name in added.rows) if (this.tables.get(name)?.t) this.tables.get(name).add(added.rows[name]);
    // A page that is behind leaves out frames.
    if (added.reel && this.deck && this.waiting < 5) {
      const run = this.told.runs[0], part = new Film({ reel: added.reel, stage: run.stage, name: run.name }, await unpack(added.blob));
      if (this.growth[0].add(part)) this.extend();
    }
    this.refresh();
    this.events++;
  }

  /** Lets the player know of new frames. It goes on to the newest if it shows the last one and does not play. */
  extend() {
    const { deck, growth: [{ film }] } = this, follows = !deck.playing && deck.t >= deck.until - 1e-9, bounds = JSON.stringify(film.bounds);
    const usual = JSON.stringify(deck.look.range) === JSON.stringify(deck.ranges[deck.look.field]);
    deck.until = film.times.at(-1);
    deck.times = [...film.times];
    for (const field of deck.fields) deck.ranges[field] = [...film.ranges[field]];
    if (usual && deck.fields.length) deck.look.range = [...deck.ranges[deck.look.field]];
    if (document.hidden) { if (follows) deck.t = deck.until; return; }
    if (bounds !== this.bounds) { this.bounds = bounds; deck.views.forEach(view => view.fit()); }
    if (follows) deck.seek(deck.until); else deck.draw();
  }

  /** Draws the charts that have new rows and can be seen. */
  refresh() {
    for (const chart of this.charts.all) {
      const { top, bottom, width } = chart.element.getBoundingClientRect();
      if (!chart.stale || !width || document.hidden || bottom < -400 || top > innerHeight + 400) continue;
      chart.stale = false;
      redraw(chart);
    }
  }

  end({ status, error, report }) {
    this.badge.textContent = status;
    this.badge.className = `badge ${status === "finished" ? "good" : status === "failed" ? "bad" : "odd"}`;
    for (const input of [this.pause, this.checkpoint, ...this.controls.map(control => control.input)]) input.disabled = true;
    const where = report ? ` The page of the whole run is ${report}.` : "";
    this.message.textContent = (status === "finished" ? "The run has finished." : status === "failed" ? `The run could not go on: ${error}` : "The run was interrupted; pontoon resume goes on with it.") + where;
    this.ended = status;
  }
}

/** Draws a chart with its new rows, at the same place if it is zoomed. */
function redraw(chart) {
  const { u, what } = chart;
  if (!u) {
    if (!what.lines.some(line => line.x.some(Number.isFinite))) return;
    chart.plot.replaceChildren();
    chart.plot.style.minHeight = "";
    return chart.draw();
  }
  const data = uPlot.join(what.lines.map(line => [Array.from(line.t), Array.from(line.x, x => Number.isNaN(x) ? null : x)]));
  const { min, max } = u.scales.x, zoomed = min > u.data[0][0] || max < u.data[0].at(-1);
  u.setData(data, !zoomed);
  if (zoomed) u.redraw(false, true);
  if (chart.deck) chart.follow(chart.deck.t);
}

document.addEventListener("DOMContentLoaded", () => {
  pontoon.ready = pontoon.ready.then(() => {
    const told = JSON.parse(document.getElementById("told").textContent);
    pontoon.live = new Live(document.getElementById("live"), told, pontoon);
  });
});
