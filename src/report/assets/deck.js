/* Players that run together: buttons, keys, pointers, the colour bar. */

/** An element: its tag, what it has, what is in it. */
function make(tag, has = {}, ...inside) {
  const element = document.createElement(tag);
  for (const key in has) {
    if (key.startsWith("on")) element.addEventListener(key.slice(2), has[key]);
    else if (key in element && key !== "list") element[key] = has[key];
    else element.setAttribute(key, has[key]);
  }
  element.append(...inside);
  return element;
}

const labelled = (element, name) => { element.setAttribute("aria-label", name); return element; };

class Deck {
  constructor(home, films, maps) {
    this.films = films;
    this.from = Math.min(...films.map(f => f.times[0]));
    this.until = Math.max(...films.map(f => f.times.at(-1)));
    this.times = [...new Set(films.flatMap(f => [...f.times]))].sort((a, b) => a - b);
    this.t = this.from;
    for (const dim of [2, 3]) {
      const alike = films.filter(f => f.dim === dim), ends = k => alike[0].bounds[k].map((_, c) => Math[k ? "max" : "min"](...alike.map(f => f.bounds[k][c])));
      if (alike.length > 1) { const all = [ends(0), ends(1)]; alike.forEach(f => { f.bounds = all; }); }
    }
    this.fields = Object.keys(FIELDS).filter(f => films.every(film => film.ranges[f]));
    this.ranges = Object.fromEntries(this.fields.map(f => [f, [0, 1].map(k => Math[k ? "max" : "min"](...films.map(film => film.ranges[f][k])))]));
    const field = this.fields[0] ?? "pressure", deep = films.some(f => f.dim === 3);
    this.look = { field, range: [...(this.ranges[field] ?? [0, 1])], zoom: 1, pan: [0, 0], yaw: 0.55, pitch: 0.42, mode: deep ? "turn" : "flat", cut: 0.5,
      show: { particles: true, surface: true, gauges: true, names: true } };
    this.tables = Object.fromEntries(Object.keys(FIELDS).map(f => [f, colours(maps[f])]));
    this.maps = maps;
    this.views = films.map(film => new View(film, this.look, this.tables));
    this.followers = [];
    this.build(home, deep);
    // After the layout that called it: a canvas that changes within would call it again.
    new ResizeObserver(() => requestAnimationFrame(() => this.fit())).observe(this.stage);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
    this.fit();
  }

  build(home, deep) {
    const check = (name, word) => make("label", {}, make("input", { type: "checkbox", checked: true, onchange: e => { this.look.show[name] = e.target.checked; this.draw(); } }), word);
    this.stage = make("div", { className: this.views.length > 1 ? "views two" : "views" }, ...this.views.map(view => this.frame(view)));
    this.button = make("button", { className: "play", type: "button", onclick: () => this.toggle() }, "▶ Play");
    this.scrub = labelled(make("input", { type: "range", className: "scrub", min: 0, max: 1000, step: 1, value: 0, oninput: () => { this.pause(); this.seek(this.from + (this.until - this.from) * this.scrub.value / 1000); } }), "Time");
    this.clock = make("output", { className: "time" });
    const speeds = [1 / 32, 1 / 16, 1 / 8, 1 / 4, 1 / 2, 1, 2, 4, 8], long = this.until - this.from;
    this.speed = speeds.find(s => long / s < 12) ?? 8;
    const pace = labelled(make("select", { onchange: e => { this.speed = +e.target.value; } }, ...speeds.map(s => make("option", { value: s, selected: s === this.speed }, `${s < 1 ? "1/" + 1 / s : s} × real time`))), "Speed of playing");
    const colour = labelled(make("select", { onchange: e => this.paint(e.target.value) }, ...this.fields.map(f => make("option", { value: f }, FIELDS[f].title))), "Colour of the particles");
    const zoom = make("span", { className: "group" }, ...[["−", "Zoom out", () => this.zoom(1 / 1.4)], ["+", "Zoom in", () => this.zoom(1.4)], ["Fit", "Show all", () => this.reset()]].map(([word, name, onclick]) => labelled(make("button", { type: "button", onclick }, word), name)));
    const tools = make("div", { className: "row" }, make("label", { hidden: !this.fields.length }, "Colour", colour), make("label", {}, "Speed", pace), zoom, this.surface = check("surface", "surface"), check("gauges", "gauges"), check("names", "names"));
    if (deep) tools.append(...this.cutter());
    const keys = make("p", { className: "quiet keys" }, "Keys: space plays, ← → a frame (with shift ten), Home and End, + − zoom, a d w s move" + (deep ? ", or turn in 3-D" : "") + ", 0 shows all. Drag moves, " + (deep ? "or turns in 3-D (with shift it moves), " : "") + "Ctrl and the wheel zoom; point at the water to read its values.");
    const touch = make("p", { className: "quiet touch" }, "Tap the water to read its values; a finger to the side moves" + (deep ? ", or turns in 3-D" : "") + "; two zoom.");
    this.deck = make("div", { className: "deck", role: "group", onkeydown: e => this.key(e) }, this.stage, make("div", { className: "row scrubber" }, this.button, this.scrub, this.clock), this.legend(), tools, keys, touch);
    labelled(this.deck, "Player of the run");
    home.append(this.deck);
    document.addEventListener("keydown", e => { if (e.target === document.body) this.key(e); });
  }

  /** A view with its name and what reads values. */
  frame(view) {
    const tip = view.tip = make("div", { className: "tip", hidden: true });
    view.canvas.tabIndex = 0;
    view.canvas.setAttribute("role", "img");
    const name = this.views.length > 1 ? [make("figcaption", {}, view.film.run.name)] : [];
    this.pointer(view);
    return make("figure", { className: "view" }, ...name, view.canvas, tip);
  }

  cutter() {
    const slider = labelled(make("input", { type: "range", min: 0, max: 1, step: 0.005, value: 0.5, oninput: e => { this.look.cut = +e.target.value; this.draw(); } }), "Place of the section");
    this.place = make("output");
    const along = make("label", {}, slider, this.place), flat = this.films.some(film => film.dim === 2);
    // Uncut, a run in 3-D has no section to be moved and no line for a surface.
    const cut = mode => { along.hidden = mode === "turn"; this.surface.hidden = mode === "turn" && !flat; };
    cut("turn");
    const modes = [["turn", "whole, to be turned"], ["y", "section across y"], ["x", "section across x"], ["z", "section across z"]];
    const select = labelled(make("select", { onchange: e => { this.look.mode = e.target.value; cut(this.look.mode); this.reset(); } }, ...modes.map(([value, word]) => make("option", { value }, word))), "View");
    return [make("label", {}, "View", select), along];
  }

  legend() {
    const end = (k, name) => labelled(make("input", { className: "end" + (k ? " high" : ""), inputMode: "decimal", onchange: e => {
      const x = parseFloat(e.target.value.replace("−", "-").replace(",", "."));
      if (Number.isFinite(x)) this.look.range[k] = x;
      this.draw();
    } }), name);
    this.ends = [end(0, "Value of the lowest colour"), end(1, "Value of the highest colour")];
    this.strip = make("div", { className: "strip", role: "img" });
    this.unit = make("span", { className: "unit" });
    this.marks = make("div", { className: "marks" });
    return make("div", { className: "legend", hidden: !this.fields.length }, this.ends[0], this.strip, this.ends[1], this.unit, this.marks);
  }

  paint(field) {
    this.look.field = field;
    this.look.range = [...this.ranges[field]];
    this.draw();
  }

  reset() { Object.assign(this.look, { zoom: 1, pan: [0, 0] }); this.fit(); }
  fit() { this.views.forEach(view => view.fit()); this.draw(); }

  /** Zooms about a point of the sheet that stays where it is. */
  zoom(by, about) {
    const { look } = this, next = Math.min(200, Math.max(0.5, look.zoom * by));
    if (about) look.pan = look.pan.map((p, i) => { const c = this.views[0].middle[i] + p; return p + (about[i] - c) * (1 - look.zoom / next); });
    look.zoom = next;
    this.draw();
  }

  seek(t) { this.t = Math.min(this.until, Math.max(this.from, t)); this.draw(); }
  step(by) {
    this.pause();
    const i = this.times.findIndex(t => t >= this.t - 1e-9);
    this.seek(this.times[Math.min(this.times.length - 1, Math.max(0, i + by))]);
  }
  toggle() { if (this.playing) this.pause(); else this.play(); }
  pause() { this.playing = false; this.button.textContent = "▶ Play"; }
  play() {
    if (this.t >= this.until) this.t = this.from;
    this.playing = true;
    this.button.textContent = "❚❚ Pause";
    let last = null;
    const turn = now => {
      if (!this.playing) return;
      if (last !== null) this.seek(this.t + this.speed * Math.min(0.1, (now - last) / 1000));
      last = now;
      if (this.t >= this.until) this.pause(); else requestAnimationFrame(turn);
    };
    requestAnimationFrame(turn);
  }

  key(e) {
    if (e.ctrlKey || e.metaKey || e.altKey || ["SELECT"].includes(e.target.tagName) || e.target.className?.includes?.("end")) return;
    const ten = e.shiftKey ? 10 : 1;
    const acts = { " ": () => this.toggle(), ArrowRight: () => this.step(ten), ArrowLeft: () => this.step(-ten), Home: () => { this.pause(); this.seek(this.from); }, End: () => { this.pause(); this.seek(this.until); },
      a: () => this.nudge(1, 0), d: () => this.nudge(-1, 0), w: () => this.nudge(0, 1), s: () => this.nudge(0, -1), "+": () => this.zoom(1.4), "=": () => this.zoom(1.4), "-": () => this.zoom(1 / 1.4), 0: () => this.reset() };
    if (!acts[e.key] || e.key === " " && ["BUTTON", "INPUT", "SUMMARY"].includes(e.target.tagName) && e.target.type !== "range") return;
    e.preventDefault();
    acts[e.key]();
  }

  pointer(view) {
    const { canvas } = view, down = new Map();
    const at = e => { const box = canvas.getBoundingClientRect(); return [e.clientX - box.left, e.clientY - box.top]; };
    canvas.addEventListener("pointerdown", e => { down.set(e.pointerId, at(e)); if (e.isTrusted) canvas.setPointerCapture(e.pointerId); this.tell(view, at(e)); });
    canvas.addEventListener("pointermove", e => {
      const now = at(e), before = down.get(e.pointerId);
      if (!before) return this.tell(view, now);
      const others = [...down].filter(([id]) => id !== e.pointerId).map(([, p]) => p);
      down.set(e.pointerId, now);
      if (others.length) {
        const gap = p => Math.hypot(p[0] - others[0][0], p[1] - others[0][1]);
        return this.zoom(gap(now) / Math.max(1, gap(before)), view.sheet(others[0]));
      }
      this.drag(view, now[0] - before[0], now[1] - before[1], e.shiftKey);
    });
    for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, e => down.delete(e.pointerId));
    canvas.addEventListener("pointerleave", () => { view.near = null; view.tip.hidden = true; });
    canvas.addEventListener("wheel", e => {
      if (!e.ctrlKey && !e.metaKey && document.activeElement !== canvas) return;
      e.preventDefault();
      this.zoom(Math.exp(-0.0015 * e.deltaY), view.sheet(at(e)));
    }, { passive: false });
  }

  drag(view, dx, dy, shift) {
    const { look } = this;
    view.tip.hidden = true;
    view.near = null;
    if (view.turning && !shift) {
      look.yaw -= 0.008 * dx;
      look.pitch = Math.min(1.55, Math.max(-0.3, look.pitch + 0.008 * dy));
    } else look.pan = [look.pan[0] - dx / view.scale, look.pan[1] + dy / view.scale];
    this.draw();
  }

  /** Drags by a key. */
  nudge(x, y) { this.drag(this.views[0], 40 * x, 40 * y, false); }

  /** Shows what is under the pointer. */
  tell(view, at) {
    view.near = at;
    const text = view.read(...at);
    view.tip.hidden = text === null;
    if (text === null) return;
    view.tip.textContent = text;
    const { offsetTop, clientWidth } = view.canvas, wide = view.tip.offsetWidth;
    view.tip.style.left = Math.max(0, Math.min(clientWidth - wide, at[0] + 14)) + "px";
    view.tip.style.top = offsetTop + at[1] + 16 + "px";
  }

  draw() {
    const { look, t } = this, [low, high] = look.range, { title, unit } = FIELDS[look.field], map = this.maps[look.field];
    for (const view of this.views) {
      view.draw(t);
      labelled(view.canvas, `${view.film.run.name} at ${t.toFixed(3)} s, particles coloured by ${title}`);
      if (view.near) this.tell(view, view.near);
    }
    if (document.activeElement !== this.scrub || this.playing) this.scrub.value = 1000 * (t - this.from) / (this.until - this.from || 1);
    this.clock.textContent = `t = ${t.toFixed(3)} s`;
    this.scrub.setAttribute("aria-valuetext", this.clock.textContent);
    this.ends.forEach((end, k) => { if (document.activeElement !== end) end.value = plain(look.range[k]); });
    this.strip.style.background = `linear-gradient(to right, ${map.map(hex).join(",")})`;
    labelled(this.strip, `Colours from ${plain(low)} to ${plain(high)} ${unit}`);
    this.unit.textContent = `${title}, ${unit}`;
    this.marks.replaceChildren(...marks(low, high, 5).map(x => {
      const mark = make("span", {}, plain(x));
      mark.style.left = `${100 * (x - low) / (high - low)}%`;
      return mark;
    }));
    if (this.place) this.place.textContent = this.views[0].cut === null ? "" : `${look.mode} = ${said(this.views[0].cut)} m`;
    this.followers.forEach(follow => follow(t));
  }
}
