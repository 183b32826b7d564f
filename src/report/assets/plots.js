/* Plots of the series, and the beginning of it all. */

const TINTS = 7;
const tint = i => style(`--c${i % TINTS}`);

/** Charts that follow the players' time. */
class Charts {
  constructor(deck) {
    this.deck = deck;
    this.all = [];
    this.seen = new IntersectionObserver(entries => entries.forEach(e => { if (e.isIntersecting) e.target.chart.draw(); }), { rootMargin: "400px" });
    deck?.followers.push(t => this.all.forEach(chart => chart.follow(t)));
    const fresh = () => this.all.forEach(chart => chart.again());
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", fresh);
    addEventListener("resize", () => this.all.forEach(chart => chart.size()));
    addEventListener("beforeprint", () => { document.documentElement.dataset.theme = "light"; deck?.draw(); this.all.forEach(chart => chart.again(340)); });
    addEventListener("afterprint", () => { delete document.documentElement.dataset.theme; deck?.draw(); fresh(); });
  }

  add(home, what) {
    const chart = new Chart(what, this.deck);
    chart.element.chart = chart;
    home.append(chart.element);
    this.all.push(chart);
    this.seen.observe(chart.element);
  }
}

/** One chart: `title`, `unit`, `said`, and `lines`, each with a label, times (frequencies, if `spectral`), values, a tint, and whether it is dots. */
class Chart {
  constructor(what, deck) {
    Object.assign(this, { what, deck });
    this.plot = make("div", { className: "plot" });
    const below = what.said ? [make("div", { className: "said" }, what.said)] : [];
    this.element = make("figure", { className: "chart" }, make("figcaption", {}, what.title, make("span", {}, `, ${what.unit}`)), this.plot, ...below);
  }

  draw(wide) {
    if (this.u) return;
    const { lines, unit, spectral } = this.what, across = spectral ? "Hz" : "s";
    if (!lines.some(line => line.x.some(Number.isFinite))) {
      this.plot.style.minHeight = 0;
      return this.plot.replaceChildren(make("p", { className: "quiet" }, "Nothing was measured."));
    }
    const gaps = x => Array.from(x, v => Number.isNaN(v) ? null : v);
    const data = uPlot.join(lines.map(line => [Array.from(line.t), gaps(line.x)]));
    const axis = { stroke: style("--quiet"), font: "11px system-ui, sans-serif", grid: { stroke: style("--rule"), width: 1 }, ticks: { stroke: style("--rule"), width: 1, size: 5 } };
    const short = v => Math.abs(v) < 1e-3 || Math.abs(v) >= 1e6 ? (+v.toPrecision(6)).toExponential().replace("e+", "e") : `${+v.toPrecision(6)}`;
    const words = (_, all) => all.map(v => v === null ? "" : v === 0 ? "0" : short(v).replaceAll("-", "−"));
    const series = lines.map((line, i) => {
      const stroke = tint(line.tint ?? i), value = (_, v) => v == null ? "–" : `${said(v)} ${unit}`;
      const dots = { paths: () => null, points: { show: true, size: 4.5, width: 1, stroke, fill: stroke } };
      return { label: line.label, stroke, width: 1.5, spanGaps: false, value, dash: line.dash, points: { show: false }, ...(line.dots ? dots : {}) };
    });
    this.u = new uPlot({
      width: wide ?? this.plot.clientWidth, height: 190, scales: { x: { time: false }, y: { range: (_, low, high) => low === high ? [low - 0.1 * (Math.abs(low) || 1), high + 0.1 * (Math.abs(low) || 1)] : uPlot.rangeNum(low, high, 0.08, false) } }, legend: { live: true }, cursor: { sync: { key: spectral ? "frequency" : "time" }, drag: { x: true, y: false }, points: { size: 6 } },
      axes: [{ ...axis, size: 34, values: (_, all) => all.map(v => `${+v.toPrecision(6)} ${across}`) }, { ...axis, size: 58, values: words }], series: [{ label: spectral ? "f" : "t", value: (_, v) => v == null ? "–" : `${v.toFixed(3)} ${across}` }, ...series],
    }, data, this.plot);
    if (spectral) return;
    this.now = make("div", { className: "now" });
    this.u.over.append(this.now);
    let pressed = 0;
    this.u.over.addEventListener("mousedown", e => { pressed = e.clientX; });
    this.u.over.addEventListener("click", e => { if (Math.abs(e.clientX - pressed) < 3) { this.deck?.pause(); this.deck?.seek(this.u.posToVal(this.u.cursor.left, "x")); } });
    if (this.deck) this.follow(this.deck.t);
  }

  follow(t) {
    if (!this.u || !this.now) return;
    const x = this.u.valToPos(t, "x");
    this.now.hidden = !(x >= 0 && x <= this.u.over.clientWidth);
    this.now.style.left = x + "px";
  }

  size() { if (this.u && this.plot.clientWidth) { this.u.setSize({ width: this.plot.clientWidth, height: 190 }); this.follow(this.deck?.t); } }
  again(wide) { if (!this.u && !wide) return; this.u?.destroy(); this.u = this.now = null; if (wide || this.plot.clientWidth) this.draw(wide); }
}

/** The columns of `indices` of a table as lines. */
function lines(table, indices, bytes, label, offset = 0) {
  const t = floats(bytes, table.t, table.rows[0]);
  const dash = k => k + offset < TINTS ? undefined : [7, 4];
  return indices.map((c, k) => ({ label: label ?? table.columns[c].label, t, x: floats(bytes, table.columns[c].x, table.rows[0]), series: `${table.name}.${table.columns[c].name}`, tint: k + offset, dash: dash(k) }));
}

/** A line of a check. */
const curve = (line, bytes) => ({ t: floats(bytes, line.t, line.rows), x: floats(bytes, line.x, line.rows) });

function series(home, charts, runs, bytes) {
  const several = runs.length > 1, tables = [];
  for (const run of runs) for (const table of run.tables) if (!tables.some(t => t.name === table.name)) tables.push(table);
  for (const table of tables) {
    home.append(make("h3", {}, table.name, make("span", {}, ` · ${table.what}`)));
    const open = make("div", { className: "charts" }), folded = make("div", { className: "charts" });
    if (several) abreast(open, folded, charts, runs, table.name, bytes);
    else for (const chart of table.charts) {
      const first = table.columns[chart.columns[0]], title = chart.title ?? (chart.columns.length > 3 ? table.what : chart.columns.map(c => table.columns[c].label).join(", "));
      const known = references(runs[0], table, chart.columns, bytes);
      charts.add(chart.folded ? folded : open, { title, unit: first.unit, lines: [...lines(table, chart.columns, bytes), ...known] });
    }
    home.append(open);
    const own = runs.map(run => run.tables.find(t => t.name === table.name)).filter(Boolean), idle = table.idle.filter(kind => own.every(t => t.idle.includes(kind)));
    if (idle.length) home.append(make("p", { className: "quiet" }, `0 throughout: ${idle.join(", ")}.`));
    if (table.rows[0] < table.rows[1]) home.append(make("p", { className: "quiet" }, `${table.rows[0]} of ${table.rows[1]} rows are drawn, with every peak.`));
    spectra(home, charts, runs, table, bytes);
    const more = several ? [...folded.children].map(figure => figure.chart.what.title) : table.charts.filter(c => c.folded).map(c => c.title ?? c.columns.map(k => table.columns[k].label).join(", "));
    if (folded.childElementCount) home.append(make("details", {}, make("summary", {}, `More of ${table.name}: ${more.join("; ")}`), folded));
  }
}

/** The columns that any of several runs has in its table called `name`, each in a chart: what one run alone has, too, with a remark. */
function abreast(open, folded, charts, runs, name, bytes) {
  const drawn = new Set(), tables = runs.map(run => run.tables.find(table => table.name === name));
  for (const table of tables) for (const chart of table?.charts ?? []) for (const c of chart.columns) {
    const { name: column, label, unit } = table.columns[c], all = [];
    if (drawn.has(column)) continue;
    drawn.add(column);
    tables.forEach((own, r) => {
      const k = own ? own.columns.findIndex(other => other.name === column) : -1;
      if (k >= 0) all.push(...lines(own, [k], bytes, runs[r].name, r));
    });
    const alone = all.length < runs.length ? `only in ${all.map(line => line.label).join(", ")}` : "";
    charts.add(chart.folded ? folded : open, { title: label, unit, said: alone, lines: all });
  }
}

/** The spectra of a table, behind a fold: of one run those in the same unit in one chart, of several those of a column. */
function spectra(home, charts, runs, table, bytes) {
  const several = runs.length > 1, all = new Map();
  runs.forEach((run, r) => {
    const own = run.tables.find(t => t.name === table.name);
    for (const { column, rows, f, s } of own?.spectra ?? []) {
      const { label, unit, name } = own.columns[column], key = several ? name : unit;
      if (!all.has(key)) all.set(key, { title: several ? `spectrum of ${label}` : "spectrum", unit: `${/[ \/]/.test(unit) ? `(${unit})` : unit}²/Hz`, spectral: true, lines: [] });
      all.get(key).lines.push({ label: several ? run.name : label, t: floats(bytes, f, rows), x: floats(bytes, s, rows), tint: several ? r : undefined });
    }
  });
  if (!all.size) return;
  const grid = make("div", { className: "charts" });
  for (const chart of all.values()) charts.add(grid, chart);
  home.append(make("details", {}, make("summary", {}, `Spectra of ${table.name}`), grid));
}

/** References of the columns of a chart that are held as they are. */
function references(run, table, columns, bytes) {
  const named = columns.map(c => `${table.name}.${table.columns[c].name}`);
  return run.checks.filter(check => named.includes(check.series)).map((check, k) => ({ label: `${check.label}, reference`, ...curve(check.reference, bytes), tint: 6 - k % 2, dots: !check.exact, dash: check.exact ? [5, 4] : undefined }));
}

function held(home, charts, runs, bytes) {
  const grid = make("div", { className: "charts" }), keys = [...new Set(runs.flatMap(run => run.checks.map(c => c.series)))];
  const several = runs.length > 1;
  for (const key of several ? keys : runs[0].checks) {
    const checks = several ? runs.map(run => run.checks.find(c => c.series === key)).filter(Boolean) : [key], [first] = checks;
    const all = checks.map((check, i) => ({ label: several ? runs.find(run => run.checks.includes(check)).name : "run", ...curve(check.sim, bytes), series: check.series, tint: i }));
    if (!several && first.meaned) all.push({ label: "mean", ...curve(first.meaned, bytes), tint: 2 });
    const known = several ? runs.find(run => run.checks.includes(first)).checks.filter(c => c.series === key) : [first];
    known.forEach((check, k) => all.push({ label: k ? `reference ${k + 1}` : "reference", ...curve(check.reference, bytes), tint: several ? 6 - k : 1, dots: !check.exact, dash: check.exact ? [5, 4] : undefined }));
    charts.add(grid, { title: first.series, unit: first.unit, said: several ? "" : first.caption, lines: all });
  }
  home.append(grid);
}

/** How motions answer irregular waves over frequency: of each statistic the ratios by their units, the phases, the coherences. */
function answers(home, charts, run, bytes) {
  const grid = make("div", { className: "charts" }), all = new Map();
  for (const { name, label, unit: own, rows, f, rao, phase, coherence } of run.answers) {
    for (const [what, unit, x] of [["ratio", own, rao], ["phase", "°", phase], ["coherence", "–", coherence]]) {
      const title = `${name} · ${what}`, key = title + unit;
      if (!all.has(key)) all.set(key, { title, unit, spectral: true, lines: [] });
      all.get(key).lines.push({ label, t: floats(bytes, f, rows), x: floats(bytes, x, rows) });
    }
  }
  for (const chart of all.values()) charts.add(grid, chart);
  home.append(grid);
}

/** Unpacks the numbers and fills the page. */
async function begin() {
  const home = id => document.getElementById(id);
  try {
    const told = JSON.parse(home("told").textContent), bytes = await unpack(home("blob").textContent);
    const films = told.runs.filter(run => run.reel).map(run => new Film(run, bytes));
    const deck = home("deck") && films.length ? new Deck(home("deck"), films, told.maps) : null;
    const charts = new Charts(deck);
    if (home("held")) held(home("held"), charts, told.runs, bytes);
    if (home("answers")) answers(home("answers"), charts, told.runs[0], bytes);
    if (home("charts")) series(home("charts"), charts, told.runs, bytes);
    Object.assign(window.pontoon, { deck, charts, films });
    document.documentElement.dataset.ready = "";
  } catch (why) {
    (home("deck") ?? document.querySelector("main")).append(make("p", { className: "note bad" }, `The player and the plots cannot be shown: ${why.message}`));
    throw why;
  }
}
