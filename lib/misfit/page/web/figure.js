// Draws a figure of the report (lib/misfit/report/figure.h) with uPlot: axes, zoom and cursor are uPlot's, the series are painted here, thinned
// to what the screen has pixels for (least and largest value of each column).
import uPlot from '/uPlot.esm.js';
import { element, plain, shown, shownPlace, shownWithSigma, spaced, tick, words } from '/dom.js';

const darkScreen = matchMedia('(prefers-color-scheme: dark)');
const onDark = { '#000000': '#e4e7ea', '#8a8a8a': '#8f989f', '#0072b2': '#5fb4ea', '#d55e00': '#ff8c42', '#009e73': '#37c79b', '#cc79a7': '#e39cc4',
  '#e69f00': '#f0b73a', '#56b4e9': '#8fd0f7', '#dcdcdc': '#17191b' };
const dotsOnDark = { '#000000': '#b3bdc6', '#8a8a8a': '#626a71' }; // thousands of dots: as bright as lines they would hide these

/** The colour on this screen: those of the report are made for white paper. `kind`: the style of the series. */
export const colour = (hex, kind = '') => {
  if (!darkScreen.matches) return hex;
  const known = hex.toLowerCase();
  return (kind === 'points' ? dotsOnDark[known] : undefined) ?? onDark[known] ?? hex;
};

/** A colour of the style sheet; asking the document for it lays the page out, so that it is asked once. */
const styles = new Map();
darkScreen.addEventListener('change', () => styles.clear());
function style(name) {
  if (!styles.has(name)) styles.set(name, getComputedStyle(document.documentElement).getPropertyValue(name).trim());
  return styles.get(name);
}

/** Of numbers that ascend: the first place whose number is not below `value`. */
export function lowerBound(numbers, value) {
  let low = 0, high = numbers.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (numbers[middle] < value) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** Place of the number nearest to `value`. */
export function nearest(numbers, value) {
  const at = lowerBound(numbers, value);
  if (at === 0) return 0;
  if (at === numbers.length) return at - 1;
  return value - numbers[at - 1] <= numbers[at] - value ? at - 1 : at;
}

/** Of the series of that kind in the first panel, held out or not; undefined: it has no sample there. */
export function valueAt(figure, kind, t) {
  for (const s of figure.panels[0].series) {
    const x = figure.xs[s.x], k = nearest(x, t), interval = Math.min(x[k] - x[k - 1] || Infinity, x[k + 1] - x[k] || Infinity);
    if (s.key.startsWith(kind) && Math.abs(x[k] - t) <= interval && s.y[k] !== null && s.y[k] !== undefined) return s.y[k];
  }
  return undefined;
}

function ascends(x) {
  for (let i = 0; i < x.length; ++i) if (x[i] === null || (i > 0 && !(x[i] >= x[i - 1]))) return false;
  return x.length > 1;
}

const clamped = (k, list) => Math.min(Math.max(k, 0), list.length - 1);
const distinct = (numbers) => [...new Set(numbers)].sort((a, b) => a - b);

/** Of a map over two quantities: the place of the cell so many columns to the right and rows up; at its edge it is the last one there. */
function cellBeside(cells, [x, y], columns, rows) {
  const xs = distinct(cells.x), to = xs[clamped(nearest(xs, x) + columns, xs)];
  const ys = distinct(cells.y.filter((_, i) => cells.x[i] === to));
  return [to, ys[clamped(nearest(ys, y) + rows, ys)]];
}

/** Plots over time that share cursor, zoom and marks. */
export class TimeGroup {
  constructor() {
    this.plots = new Set();
    this.window = null; // [from, to] of the zoom; null: all
    this.heldOut = []; // intervals of time [s] that no estimate has seen
    this.marks = []; // intervals of time [s]
    this.onmark = () => {};
    this.onbegun = () => {};
    this.onzoom = () => {};
    this.oncursor = () => {};
    this.begun = undefined;
    this.pressed = null; // the plot in which the mouse went down
    this.sync = uPlot.sync('time');
  }
  zoom(window) {
    this.window = window;
    for (const plot of this.plots) plot.showX(window);
    this.onzoom(window);
  }
  setMarks(marks) {
    this.marks = marks;
    for (const plot of this.plots) plot.paintLayers();
  }
  point(t) {
    for (const plot of this.plots) plot.pointAt(t);
  }
  /** Where the cursor is seen; null: nowhere. */
  cursor() {
    return [...this.plots].find((plot) => plot.u.cursor.left >= 0)?.cursor ?? null;
  }
  /** In plots that are drawn anew: nobody has moved it. */
  putBack(cursor) {
    this.quiet = true;
    this.point(cursor);
    this.quiet = false;
  }
  moved(t) {
    if (!this.quiet) this.oncursor(t);
  }
  /** A mark by keys: from one cursor to the next. */
  markFrom(t) {
    const from = this.begun;
    this.begun = from === undefined || from === t ? t : undefined;
    if (this.begun === undefined) this.onmark([[Math.min(from, t), Math.max(from, t)]]);
    else this.onbegun(t);
  }
}

/** Extent of numbers between two places; null entries left out. */
function extent(lists, from, to, out) {
  for (const list of lists) {
    if (!list) continue;
    for (let i = from; i < to; ++i) {
      const v = list[i];
      if (v === null) continue;
      if (v < out[0]) out[0] = v;
      if (v > out[1]) out[1] = v;
    }
  }
}

const spanOf = (numbers) => {
  const out = [Infinity, -Infinity];
  extent([numbers], 0, numbers.length, out);
  return out[1] - out[0];
};

/** Of a band's edge what lies where it is at most twice as wide as usual; null elsewhere. */
function usualPart(band, edge, begin, end) {
  const widths = [], step = Math.max(Math.floor((end - begin) / 2000), 1), width = (i) => band.hi[i] - band.lo[i];
  const known = (i) => band.lo[i] !== null && band.hi[i] !== null;
  for (let i = begin; i < end; i += step) if (known(i)) widths.push(width(i));
  const most = 2 * widths.sort((a, b) => a - b)[widths.length >> 1];
  const out = [];
  for (let i = begin; i < end; ++i) out.push(known(i) && width(i) <= most ? edge[i] : null);
  return out;
}

const withX = { boxes: true, cells: true, x_bars: true };

class Plot {
  constructor(view, panel, { last, xLabel }) {
    this.view = view;
    this.panel = panel;
    this.figure = view.figure;
    this.last = last;
    this.series = panel.series.map((s) => {
      const x = this.figure.xs[s.x];
      return { ...s, x, sorted: (view.sortedX[s.x] ??= ascends(x)) };
    });
    this.xRange = panel.beside?.range ?? this.figure.xRange ?? this.extentOfX();
    this.x = this.shownX();
    this.node = element('div', { class: 'panel' });
    this.legend = this.makeLegend();
    this.host = element('div', { class: 'plot', tabindex: 0, role: 'application', 'aria-roledescription': 'plot', 'aria-label': this.spoken(),
      'data-plot': `${view.options.key ?? this.figure.name} ${this.figure.panels.indexOf(panel)}` });
    this.values.sort((a, b) => (a.name === '') - (b.name === '')); // what is known of all before what is said of it
    this.readout = this.values.length > 0 ? element('p', { class: 'readout' }) : null;
    this.node.append(this.legend, this.readout ?? '', this.host);
    for (const [event, live] of [['focus', 'polite'], ['blur', 'off']]) this.host.addEventListener(event, () => this.readout?.setAttribute('aria-live', live));
    if ((last && view.options.xLabel !== false) || panel.beside)
      this.node.append(element('p', { class: 'xlabel' }, words(spaced(panel.beside?.label ?? xLabel)), panel.beside ? '' : this.unitText(this.x.unit)));
    (view.row ?? view.node).append(this.node);
    this.make();
  }

  /** Unit of what stands beside the axis, and how much of the figure's own it is: hours or days of long times, as in the report. */
  shownX() {
    const unit = this.figure.xUnit, hour = 3600, day = 24 * hour, span = this.xRange[1] - this.xRange[0];
    const long = !this.panel.beside && plain(this.figure.xLabel) === 'time' && plain(unit) === 's' && this.figure.xMarks.length === 0;
    if (long && span >= 3 * day) return { unit: 'd', size: day };
    return long && span >= 3 * hour ? { unit: 'h', size: hour } : { unit, size: 1 };
  }
  unitText(unit) {
    const out = document.createDocumentFragment();
    if (unit && plain(unit) !== '' && plain(unit) !== '-') out.append(' [', words(unit), ']');
    return out;
  }
  spoken() {
    const names = this.series.map((s) => plain(spaced(s.legend))).filter((name) => name !== ''), heldOut = this.view.heldOut();
    const label = plain(spaced(this.panel.label)), unit = plain(this.panel.unit), along = plain(spaced(this.panel.beside?.label ?? this.figure.xLabel));
    return [plain(spaced(this.figure.title)), label && `${label}${unit === '' || unit === '-' ? '' : ` [${unit}]`}`].filter((part) => part).join(': ') +
      (along === '' ? '' : ` against ${along}`) +
      (names.length > 0 ? `; ${names.join(', ')}` : '') +
      (heldOut.length > 0 ? `; held out from ${heldOut.map((part) => part.map((t) => shown(t)).join(' to ')).join(' s and from ')} s` : '');
  }

  extentOfX() {
    const out = [Infinity, -Infinity];
    for (const s of this.series) {
      extent([s.x, ...(s.style === 'boxes' || s.style === 'x_bars' ? [s.lo, s.hi] : [])], 0, s.x.length, out);
      if (s.style === 'bars') extent([[0]], 0, 1, out);
      if (s.style === 'cells') for (let i = 0; i < s.x.length; ++i) extent([[s.x[i] - s.lo[i], s.x[i] + s.lo[i]]], 0, 2, out);
    }
    if (!(out[1] > out[0])) return Number.isFinite(out[0]) ? [out[0] - 0.5, out[0] + 0.5] : [0, 1];
    const time = this.view.group !== null;
    const space = time || this.series.some((s) => withX[s.style] && s.style !== 'x_bars') ? 0 : 0.02 * (out[1] - out[0]);
    return [out[0] - space, out[1] + space];
  }

  /** Of what is drawn between two values of x; with `scales` never less than it was there before. */
  rangeOfY(window) {
    const out = [...this.extentOfY(window)], { scales } = this.view.options;
    for (const s of this.view.overlay ?? []) extent([s.y], ...this.placesIn(s, window), out);
    if (!scales) return out;
    const key = `${this.figure.panels.indexOf(this.panel)} ${window}`;
    extent([scales.get(key)], 0, 2, out);
    scales.set(key, out);
    return out;
  }
  placesIn(s, [from, to]) {
    if (!s.sorted) return [0, s.x.length];
    return [Math.max(lowerBound(s.x, from) - 1, 0), Math.min(lowerBound(s.x, to) + 1, s.x.length)];
  }
  /** Of the series between two values of x. */
  extentOfY(window) {
    if (this.panel.range) return this.panel.range;
    const out = [Infinity, -Infinity], bands = [Infinity, -Infinity];
    for (const s of this.series.filter((one) => !isGap(one))) {
      const [begin, end] = this.placesIn(s, window);
      if (s.style === 'band') extent([s.lo, s.hi].map((list) => usualPart(s, list, begin, end)), 0, end - begin, out);
      if (s.style === 'band' || s.style === 'pale_band') extent([s.lo, s.hi], begin, end, bands);
      if (s.style === 'error_bars') extent([s.lo, s.hi], begin, end, out);
      if (s.style === 'bars') extent([s.lo, s.hi], begin, end, out);
      else if (s.style === 'cells') for (let i = 0; i < s.x.length; ++i) extent([[s.y[i] - s.hi[i], s.y[i] + s.hi[i]]], 0, 2, out);
      else extent([s.y], begin, end, out);
      if (s.style === 'boxes') extent([[0]], 0, 1, out);
    }
    // A band may be much wider than usual where nothing is known yet: it must not make all else small.
    const span = out[1] > out[0] ? 0.3 * (out[1] - out[0]) : Infinity;
    extent([[Math.max(bands[0], out[0] - span), Math.min(bands[1], out[1] + span)].map((v) => (Number.isFinite(v) ? v : null))], 0, 2, out);
    if (this.panel.zero) extent([[0]], 0, 1, out);
    if (!(out[1] > out[0])) return Number.isFinite(out[0]) ? [out[0] - 1, out[0] + 1] : [-1, 1];
    const tight = this.series.some((s) => s.style === 'cells' || s.style === 'bars');
    const space = tight ? 0 : 0.05 * (out[1] - out[0]);
    const boxes = this.series.some((s) => s.style === 'boxes') && out[0] === 0;
    return [boxes ? 0 : out[0] - space, out[1] + space];
  }

  makeLegend() {
    const out = element('div', { class: 'legend' }, element('span', { class: 'axis' }, words(spaced(this.panel.label)), this.unitText(this.panel.unit)));
    this.values = [];
    for (const s of this.series) {
      if (plain(s.legend) === '') continue;
      const swatch = element('span', { class: 'swatch' });
      swatch.style.background = isGap(s) ? stripesOf(s) : colour(s.colour, s.style);
      if ((s.style === 'band' || s.style === 'pale_band') && !isGap(s)) swatch.style.opacity = 0.35;
      if (['points', 'markers', 'error_bars', 'x_bars'].includes(s.style)) {
        swatch.style.width = swatch.style.height = '.5rem';
        swatch.style.borderRadius = '50%';
      }
      if (['line', 'dashed', 'dotted', 'steps'].includes(s.style)) swatch.style.height = '3px';
      if (s.style === 'dashed' || s.style === 'dotted') {
        const [dash, gap] = s.style === 'dashed' ? [5, 3] : [2, 2];
        swatch.style.background = `repeating-linear-gradient(90deg, ${colour(s.colour, s.style)} 0 ${dash}px, transparent ${dash}px ${dash + gap}px)`;
      }
      out.append(element('span', {}, swatch, words(spaced(s.legend))));
      if (s.sorted && s.y && s.style !== 'bars')
        this.values.push({ s, name: plain(spaced(s.legend)).split(', ±')[0], sigma: this.sigmaOf(s), span: spanOf(s.y) });
      else if (s.style === 'band' && s.sorted && plain(s.legend).startsWith('±')) this.values.push({ s, name: '', sigma: { band: s } });
    }
    if (this.series.some((s) => s.style === 'cells')) out.append(this.scale());
    return out;
  }

  /** Where ± of a series stands: in itself, in the band about it, or, of a prediction, in the band of the residuals; null: nowhere. */
  sigmaOf(s) {
    if (s.style === 'error_bars') return { band: s };
    const about = this.series.find((b) => b.style === 'band' && plain(b.legend) === '' && b.x === s.x && b.colour === s.colour && s.style === 'line');
    const all = this.figure.panels.flatMap((panel) => panel.series);
    const predicted = s.style === 'line' && s.key.startsWith('predicted') ? all.find((b) => b.style === 'band' && plain(b.legend).endsWith('of the prediction')) : null;
    const band = about ?? (predicted && this.figure.xs[predicted.x] === s.x ? predicted : null);
    return band ? { band } : null;
  }

  /** What stands at a place: "12.35 s · measured 121 · predicted 121.1 ± 1.8 px". */
  words(x) {
    const { unit: xUnit, size } = this.x, unit = plain(this.panel.unit), behind = (one) => (one === '' || one === '-' ? '' : ` ${one}`);
    const out = [`${this.view.group ? '' : `${plain(spaced(this.figure.xLabel))} `}${shownPlace(x / size, (this.window[1] - this.window[0]) / size)}${behind(plain(xUnit))}`];
    for (const { s, name, sigma, span } of this.values) {
      if (s.x.length === 0) continue;
      const k = nearest(s.x, x), v = s.y?.[k] ?? null, lo = sigma?.band.lo[k] ?? null, hi = sigma?.band.hi[k] ?? null;
      const half = lo === null || hi === null ? null : 0.5 * (hi - lo);
      if (name === '' && half !== null) out.push(`${plain(s.legend).replace(/^± /, '')} ${shown(half, 2)}`);
      else if (v !== null) out.push(`${name} ${half > 0 ? shownWithSigma(v, half) : shownPlace(v, span, 4)}`);
    }
    return out.join(' · ') + (out.length > 1 ? behind(unit) : '');
  }

  /** The scale of the colours of cells. */
  scale() {
    const bar = element('span', { class: 'swatch' });
    bar.style.width = '7rem';
    bar.style.background = `linear-gradient(to right, ${[-1, -0.5, 0, 0.5, 1].map((v) => shade(v)).join(', ')})`;
    const most = this.most();
    const none = element('span', { class: 'swatch' });
    none.style.background = `repeating-linear-gradient(135deg, ${colour(this.panel.ground || '#dcdcdc')} 0 3px, ${stripes()} 3px 4px)`;
    return element('span', {}, words(this.figure.zLabel), ` ${shown(-most, 2)} `, bar, ` ${shown(most, 2)} `, this.panel.ground ? none : '',
      this.panel.ground ? 'too few samples' : '');
  }
  /** Its ends, by the rule of the report. */
  most() {
    return Math.max(this.figure.zMost, this.view.options.most ?? 0);
  }

  axes() {
    const ink = style('--soft'), line = style('--line'), font = '12px "Segoe UI", Helvetica, Arial, "DejaVu Sans", sans-serif';
    const axis = { stroke: ink, font, grid: { stroke: line, width: 1 }, ticks: { stroke: line, width: 1, size: 4 }, gap: 4 };
    const values = (u, splits, axis, space, step) => splits.map((v) => (v === null ? '' : tick(v, step)));
    const letters = (low, high) => Math.max(...[low, high].map((v) => tick(v, 0.1 * (high - low)).length));
    const marked = (marks) => ({ splits: () => marks.map(([at]) => at), values: () => marks.map(([, text]) => plain(text)) });
    const { size } = this.x, steps = Array.from({ length: 24 }, (_, k) => size * [1, 2, 5][k % 3] * 10 ** (Math.floor(k / 3) - 5));
    const inUnit = (u, splits, axis, space, step) => splits.map((v) => (v === null ? '' : tick(v / size, step / size)));
    const x = { ...axis, ...(size === 1 ? { values } : { values: inUnit, incrs: steps }), show: true, space: (u, axis, low, high) => Math.max(50, 7.4 * letters(low, high) + 14), size: this.last || this.panel.beside ? 26 : 8 };
    const names = this.figure.xMarks;
    if (names.length > 0 && !this.panel.beside)
      Object.assign(x, marked(names), { values: () => names.map(([, text]) => shortened(plain(text), Math.max(Math.floor((this.width() - 70) / names.length / 7.4), 5))) });
    if (!this.last && !this.panel.beside) x.values = (u, splits) => splits.map(() => '');
    const y = { ...axis, values, size: 60, space: 20 };
    const marks = this.panel.beside ? this.view.marks : this.panel.marks;
    if (marks.length > 0) {
      const longest = Math.max(...marks.map(([, text]) => plain(text).length)), size = Math.min(7 * longest + 14, 0.5 * this.width());
      Object.assign(y, marked(marks), { size, values: () => marks.map(([, text]) => shortened(plain(text), Math.floor((size - 10) / 7.4))) });
      if (this.panel.beside && this.view.row) Object.assign(y, { values: () => marks.map(() => ''), size: 10 });
    }
    return [x, y];
  }
  width() {
    const all = Math.max(this.view.node.clientWidth, 200);
    return this.view.row ? Math.floor((all - 12) * (this.panel.beside ? 0.4 : 0.6)) : all;
  }
  height() {
    const scale = this.view.options.height ?? 0.75;
    const foot = this.last || this.panel.beside;
    return Math.round(Math.max(this.panel.height * scale, foot ? 100 : 74) + (foot ? 18 : 0));
  }

  make() {
    const group = this.view.group;
    this.window = group?.window ?? this.xRange;
    const options = {
      width: this.width(), height: this.height(), legend: { show: false }, padding: [6, 10, 0, 0],
      scales: { x: { time: false, auto: false, range: (u, a, b) => [a, b] }, y: { auto: false, range: (u, a, b) => [a, b] } },
      axes: this.axes(), series: [{}, { points: { show: false } }],
      cursor: { y: false, points: { show: false }, drag: { x: true, y: false, setScale: false }, ...(group ? { sync: { key: 'time', setSeries: false } } : {}),
        bind: { mousedown: (u, target, handler) => (event) => { if (group) group.pressed = this; this.shift = event.shiftKey; this.dragged = false; handler(event); }, dblclick: () => () => this.all() } },
      hooks: { draw: [() => this.paint()], setCursor: [() => this.read()], setSelect: [() => this.selected()] },
    };
    this.u = new uPlot(options, [this.xRange, [null, null]], this.host);
    this.below = element('canvas', { class: 'layer' });
    this.above = element('canvas', { class: 'layer' });
    this.u.under.append(this.below);
    this.u.over.append(this.above);
    this.showX(this.window);
    this.host.addEventListener('keydown', (event) => this.key(event));
    this.u.over.addEventListener('mousemove', (event) => this.hover(event));
    this.u.over.addEventListener('mouseleave', () => this.view.options.onleave?.(this));
    this.u.over.addEventListener('click', (event) => { if (!this.dragged) this.click(event); this.dragged = false; });
    group?.plots.add(this);
  }
  destroy() {
    this.view.group?.plots.delete(this);
    this.u.destroy();
  }

  showX(window) {
    this.window = window ?? this.xRange;
    const [low, high] = this.rangeOfY(this.window);
    this.u.batch(() => {
      this.u.setScale('x', { min: this.window[0], max: this.window[1] });
      this.u.setScale('y', { min: low, max: high });
    });
  }
  /** Series over the others have changed. */
  redrawOver() {
    const [low, high] = this.rangeOfY(this.window), { min, max } = this.u.scales.y;
    if (low === min && high === max) this.u.redraw(false);
    else this.showX(this.window);
  }
  zoom(window) {
    if (this.view.group) this.view.group.zoom(window);
    else this.view.zoom(window);
  }
  all() {
    this.zoom(null);
  }
  /** The plots that are synchronised get the same selection: it is taken once, by the one that was dragged. */
  selected() {
    const { left, width } = this.u.select, { group } = this.view;
    if (width < 4) return;
    if (group && group.pressed !== this) {
      this.u.setSelect({ left: 0, width: 0, top: 0, height: 0 }, false);
      return;
    }
    this.dragged = true;
    const window = [this.u.posToVal(left, 'x'), this.u.posToVal(left + width, 'x')];
    this.u.setSelect({ left: 0, width: 0, top: 0, height: 0 }, false);
    if (this.shift && this.view.group) this.view.group.onmark([window]);
    else if (!this.shift) this.zoom(window);
  }
  hover(event) {
    this.cursorY = this.u.posToVal(event.offsetY, 'y');
    this.view.options.onpoint?.(this, this.u.posToVal(event.offsetX, 'x'), this.cursorY);
  }
  click(event) {
    this.view.options.onpick?.(this, this.u.posToVal(event.offsetX, 'x'), this.u.posToVal(event.offsetY, 'y'));
  }

  pointAt(x, y = null) {
    this.cursor = x;
    this.cursorY = y;
    this.u.setCursor({ left: this.u.valToPos(x, 'x'), top: 10 }, false);
    this.read();
  }
  read() {
    const left = this.u?.cursor.left;
    const inside = left !== undefined && left >= 0;
    if (inside) this.cursor = this.u.posToVal(left, 'x');
    if (inside) this.view.group?.moved(this.cursor);
    if (!this.readout) return;
    const text = inside ? this.words(this.cursor) : '';
    if (this.readout.textContent !== text) this.readout.textContent = this.readout.title = text;
  }
  /** Where the keys lead from the cursor, so many steps to the right and upwards; null: nowhere. */
  beside(right, up) {
    const { min, max } = this.u.scales.y, at = [this.cursor ?? 0.5 * (this.window[0] + this.window[1]), this.cursorY ?? 0.5 * (min + max)];
    const cells = this.series.find((s) => s.style === 'cells' && s.x.length > 0);
    if (cells) return cellBeside(cells, at, right, up);
    const samples = this.series.find((s) => s.sorted && s.y?.length > 0) ?? this.series.find((s) => s.sorted);
    if (!samples || up !== 0) return null;
    return [samples.x[clamped(nearest(samples.x, at[0]) + right, samples.x)], null];
  }
  go([x, y]) {
    const [from, to] = this.window;
    if (x < from || x > to) this.zoom([x - 0.5 * (to - from), x + 0.5 * (to - from)]);
    if (this.view.group) this.view.group.point(x);
    else this.pointAt(x, y);
    this.view.options.onkeypoint?.(this, x, y);
  }
  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return; // the browser's own
    const [from, to] = this.window, all = this.xRange;
    const at = this.cursor ?? 0.5 * (from + to);
    const around = (share) => [Math.max(at - share * (at - from), all[0]), Math.min(at + share * (to - at), all[1])];
    const far = event.shiftKey ? 10 : 1;
    const steps = { ArrowLeft: [-far, 0], ArrowRight: [far, 0], ArrowDown: [0, -far], ArrowUp: [0, far] }[event.key];
    const place = steps ? this.beside(...steps) : null;
    if (event.key === '+' || event.key === '=') this.zoom(around(0.5));
    else if (event.key === '-') {
      const next = around(2);
      this.zoom(next[0] <= all[0] && next[1] >= all[1] ? null : next);
    } else if (event.key === '0') this.all();
    else if (place) this.go(place);
    else if ((event.key === 'm' || event.key === 'M') && this.view.group) this.view.group.markFrom(at);
    else if (event.key === 'Enter') this.view.options.onpick?.(this, ...(this.beside(0, 0) ?? [at, null]));
    else return;
    event.preventDefault();
  }

  /** What draws on a canvas whose axes begin at `left`, `top`. */
  pen(ctx, left, top) {
    const { width, height } = this.u.bbox, { min: x0, max: x1 } = this.u.scales.x, { min: y0, max: y1 } = this.u.scales.y;
    return { ctx, left, top, width, height, x0, x1, ratio: devicePixelRatio || 1,
      X: (v) => left + ((v - x0) / (x1 - x0)) * width, Y: (v) => top + ((y1 - v) / (y1 - y0)) * height };
  }
  /** An empty canvas of the size of the axes; null: it was empty, and nothing comes into it. */
  emptied(layer, used) {
    const { width, height } = this.u.bbox, fits = layer.width === width && layer.height === height;
    if (!used && !layer.used) return null;
    layer.used = used;
    if (fits) layer.getContext('2d').clearRect(0, 0, width, height);
    else [layer.width, layer.height] = [width, height];
    return this.pen(layer.getContext('2d'), 0, 0);
  }
  /** What changes with the mouse is painted beside the series, which stay as they are: below marked times and cells, above boxes and marked
      samples. */
  paintLayers() {
    if (!this.above || !(this.u.scales.x.max > this.u.scales.x.min)) return;
    const marks = this.view.group?.marks ?? [], cells = this.view.cells ?? [], boxes = this.view.boxes ?? [], { marked } = this.view;
    const below = this.emptied(this.below, marks.length + cells.length > 0);
    if (below) {
      paintIntervals(below, marks);
      paintIntervals(below, cells);
    }
    const above = this.emptied(this.above, boxes.length > 0 || Boolean(marked));
    if (!above) return;
    const { ctx } = above;
    for (const s of marked ? this.series.filter((one) => one.style === 'points') : []) markedPoints(above, s, marked);
    ctx.strokeStyle = style('--ink');
    ctx.lineWidth = 2.5 * above.ratio;
    for (const [x0, x1, y0, y1] of boxes) ctx.strokeRect(above.X(x0), above.Y(y1), above.X(x1) - above.X(x0), above.Y(y0) - above.Y(y1));
  }

  /** Everything but the axes. */
  paint() {
    const u = this.u;
    if (!u) return;
    const { left, top, width, height } = u.bbox;
    const pen = this.pen(u.ctx, left, top);
    const ctx = u.ctx;
    ctx.save();
    ctx.beginPath();
    ctx.rect(left, top, width, height);
    ctx.clip();
    if (this.panel.ground) {
      hatch(pen, colour(this.panel.ground));
    }
    paintHeldOut(pen, this.view.heldOut(), this.panel === this.figure.panels[0]);
    if (this.panel.zero) {
      ctx.strokeStyle = style('--soft');
      ctx.lineWidth = pen.ratio;
      ctx.beginPath();
      ctx.moveTo(left, pen.Y(0));
      ctx.lineTo(left + width, pen.Y(0));
      ctx.stroke();
    }
    for (const s of [...this.series, ...(this.view.overlay ?? [])]) {
      ctx.strokeStyle = ctx.fillStyle = colour(s.colour, s.style);
      ctx.lineWidth = Math.max(s.width * 0.8, 1) * pen.ratio;
      ctx.setLineDash(s.style === 'dashed' ? [7 * pen.ratio, 4 * pen.ratio] : s.style === 'dotted' ? [2 * pen.ratio, 3 * pen.ratio] : []);
      if (isGap(s)) paintGaps(pen, s);
      else painters[s.style]?.(pen, s, this);
      ctx.setLineDash([]);
      ctx.globalAlpha = 1;
    }
    if (this.series.every((s) => s.x.length === 0)) {
      ctx.fillStyle = style('--soft');
      ctx.font = `${13 * pen.ratio}px sans-serif`;
      ctx.textAlign = 'center';
      ctx.fillText('no data', left + width / 2, top + height / 2);
    }
    ctx.restore();
    this.paintLayers();
  }
}

/** Of marked times and cells, in their order: of many thousands, those that a pixel already shows are passed over. */
function paintIntervals(pen, intervals) {
  const pixel = (pen.x1 - pen.x0) / pen.width, least = 1.5 * pen.ratio * pixel;
  pen.ctx.fillStyle = style('--mark');
  let end = -Infinity; // of what is painted
  for (const [from, to] of intervals) {
    if (to < pen.x0 || to <= end) continue;
    if (from > pen.x1) break;
    const begin = Math.max(from, end);
    end = Math.max(to, from + least);
    if (end > begin) pen.ctx.fillRect(pen.X(begin), pen.top, pen.X(end) - pen.X(begin), pen.height);
  }
}

/** Time that no estimate has seen: shaded, with a line where it begins; `named`: says what it is. */
function paintHeldOut(pen, intervals, named) {
  const { ctx, ratio } = pen;
  for (const [from, to] of intervals) {
    if (to <= pen.x0 || from >= pen.x1) continue;
    const a = Math.max(pen.X(from), pen.left), b = Math.min(pen.X(to), pen.left + pen.width);
    ctx.fillStyle = style('--held-out');
    ctx.fillRect(a, pen.top, b - a, pen.height);
    ctx.fillStyle = style('--soft');
    if (from > pen.x0) ctx.fillRect(a, pen.top, ratio, pen.height);
    ctx.font = `${11 * ratio}px "Segoe UI", Helvetica, Arial, "DejaVu Sans", sans-serif`;
    [ctx.textAlign, ctx.textBaseline] = ['left', 'alphabetic']; // uPlot leaves those of its axes
    const text = 'held out';
    if (named && ctx.measureText(text).width + 6 * ratio < b - a) ctx.fillText(text, a + 4 * ratio, pen.top + 11 * ratio);
  }
}

/** Places of a map without an estimate: not a value but a reason, so that it fills the axis. */
const isGap = (s) => s.style === 'band' && s.key.startsWith('no_estimate');
const gapsHeldOut = (s) => s.key === 'no_estimate_held_out';
const stripesOf = (s) => `repeating-linear-gradient(${gapsHeldOut(s) ? 45 : 135}deg, ${style('--held-out')} 0 3px, ${stripes()} 3px 4px)`;
function paintGaps(pen, s) {
  for (let i = 0; i + 1 < s.x.length; ++i) {
    if (s.x[i] === null || s.x[i + 1] === null) continue;
    const a = Math.max(pen.X(s.x[i]), pen.left), b = Math.min(pen.X(s.x[i + 1]), pen.left + pen.width);
    if (b <= a) continue;
    pen.ctx.save();
    pen.ctx.beginPath();
    pen.ctx.rect(a, pen.top, b - a, pen.height);
    pen.ctx.clip();
    hatch(pen, style('--held-out'), gapsHeldOut(s));
    pen.ctx.restore();
  }
}

/** Where there is nothing: stripes, which no value has; `falling`: from left to right. */
function hatch({ ctx, left, top, width, height, ratio }, ground, falling = false) {
  ctx.fillStyle = ground;
  ctx.fillRect(left, top, width, height);
  ctx.strokeStyle = stripes();
  ctx.lineWidth = ratio;
  ctx.beginPath();
  for (let x = left - height; x < left + width; x += 7 * ratio) {
    ctx.moveTo(x, falling ? top : top + height);
    ctx.lineTo(x + height, falling ? top + height : top);
  }
  ctx.stroke();
}
const stripes = () => (darkScreen.matches ? '#4c555d' : '#b4babf');

/** From blue through the paper's colour to orange, of −1…1. */
function shade(v) {
  const paper = darkScreen.matches ? [72, 79, 86] : [250, 250, 250];
  const end = v < 0 ? (darkScreen.matches ? [95, 180, 234] : [0, 114, 178]) : darkScreen.matches ? [255, 140, 66] : [213, 94, 0];
  const share = Math.min(Math.abs(v), 1);
  return `rgb(${paper.map((p, k) => Math.round(p + share * (end[k] - p))).join(', ')})`;
}

/** Places of a series that can be seen. */
function seen(pen, s) {
  if (!s.sorted) return [0, s.x.length];
  return [Math.max(lowerBound(s.x, pen.x0) - 1, 0), Math.min(lowerBound(s.x, pen.x1) + 1, s.x.length)];
}

/** A name in so many letters: its begin and its end. */
function shortened(text, most) {
  if (text.length <= most) return text;
  const end = Math.floor(0.6 * (most - 1));
  return `${text.slice(0, most - 1 - end)}…${text.slice(text.length - end)}`;
}

/** Calls `column(px, first, least, largest, last)` for each column of pixels; null for a gap. */
function byColumn(pen, x, low, high, from, to, column) {
  let px = null, first = 0, least = 0, largest = 0, last = 0;
  for (let i = from; i < to; ++i) {
    const a = low[i], b = high[i];
    if (a === null || b === null || x[i] === null) {
      if (px !== null) column(px, first, least, largest, last);
      px = null;
      column(null);
      continue;
    }
    const at = Math.round(pen.X(x[i]));
    if (at !== px) {
      if (px !== null) column(px, first, least, largest, last);
      px = at;
      first = least = a;
      largest = b;
    }
    if (a < least) least = a;
    if (b > largest) largest = b;
    last = a;
  }
  if (px !== null) column(px, first, least, largest, last);
}

function line(pen, s) {
  const { ctx } = pen, [from, to] = seen(pen, s);
  ctx.lineJoin = 'round';
  ctx.beginPath();
  let open = false;
  if (s.sorted && to - from > 3 * pen.width) {
    byColumn(pen, s.x, s.y, s.y, from, to, (px, first, least, largest, last) => {
      if (px === null) {
        open = false;
        return;
      }
      if (!open) ctx.moveTo(px, pen.Y(first));
      else ctx.lineTo(px, pen.Y(first));
      ctx.lineTo(px, pen.Y(least));
      ctx.lineTo(px, pen.Y(largest));
      ctx.lineTo(px, pen.Y(last));
      open = true;
    });
  } else {
    for (let i = from; i < to; ++i) {
      if (s.y[i] === null || s.x[i] === null) {
        open = false;
        continue;
      }
      if (open) ctx.lineTo(pen.X(s.x[i]), pen.Y(s.y[i]));
      else ctx.moveTo(pen.X(s.x[i]), pen.Y(s.y[i]));
      open = true;
    }
  }
  ctx.stroke();
}

const manyDots = 12000;

/** Small squares at the samples that are `wanted`; of very many those that would cover others, two pixels apart or less, and those outside of
    the axes are left out. */
function dots(pen, s, [from, to], side, wanted) {
  const columns = Math.ceil(pen.width / 2) + 1, rows = Math.ceil(pen.height / 2) + 1;
  const taken = to - from > manyDots ? new Uint8Array(columns * rows) : null;
  for (let i = from; i < to; ++i) {
    if (!wanted(i) || s.y[i] === null || s.x[i] === null) continue;
    const x = pen.X(s.x[i]), y = pen.Y(s.y[i]);
    if (taken) {
      const column = Math.round((x - pen.left) / 2), row = Math.round((y - pen.top) / 2);
      if (column < 0 || column >= columns || row < 0 || row >= rows) continue;
      const place = row * columns + column;
      if (taken[place]) continue;
      taken[place] = 1;
    }
    pen.ctx.fillRect(x - side / 2, y - side / 2, side, side);
  }
}
const sideOfDots = (pen, [from, to]) => (to - from > 3000 ? 1.8 : 2.6) * pen.ratio;

function points(pen, s, plot) {
  const { ctx } = pen, range = seen(pen, s), [from, to] = range;
  if (s.sorted && to - from > manyDots) {
    byColumn(pen, s.x, s.y, s.y, from, to, (px, first, least, largest) => {
      if (px !== null) ctx.fillRect(px, pen.Y(largest) - 1, 1, pen.Y(least) - pen.Y(largest) + 2);
    });
    return;
  }
  if (plot.view.marked) ctx.globalAlpha = 0.35;
  dots(pen, s, range, sideOfDots(pen, range), () => true);
}

function markedPoints(pen, s, marked) {
  const range = seen(pen, s);
  pen.ctx.fillStyle = style('--marked');
  dots(pen, s, range, 1.6 * sideOfDots(pen, range), (i) => marked[i]);
}

function band(pen, s, alpha) {
  const { ctx } = pen, [from, to] = seen(pen, s);
  ctx.globalAlpha = alpha;
  let upper = [], lower = [];
  const fill = () => {
    if (upper.length > 1) {
      ctx.beginPath();
      upper.forEach(([x, y], k) => (k === 0 ? ctx.moveTo(x, y) : ctx.lineTo(x, y)));
      for (const [x, y] of lower.reverse()) ctx.lineTo(x, y);
      ctx.fill();
    }
    upper = [];
    lower = [];
  };
  const add = (x, low, high) => {
    upper.push([x, pen.Y(high)]);
    lower.push([x, pen.Y(low)]);
  };
  if (s.sorted && to - from > 3 * pen.width)
    byColumn(pen, s.x, s.lo, s.hi, from, to, (px, first, least, largest) => (px === null ? fill() : add(px, least, largest)));
  else
    for (let i = from; i < to; ++i) {
      if (s.x[i] === null || s.lo[i] === null || s.hi[i] === null) fill();
      else add(pen.X(s.x[i]), s.lo[i], s.hi[i]);
    }
  fill();
}

function marker(pen, x, y, radius) {
  pen.ctx.beginPath();
  pen.ctx.arc(x, y, radius * pen.ratio, 0, 2 * Math.PI);
  pen.ctx.fill();
}

function each(s, draw) {
  for (let i = 0; i < s.x.length; ++i) if (s.x[i] !== null && s.y[i] !== null) draw(i);
}

const painters = {
  line, dashed: line, dotted: line, points,
  markers: (pen, s) => each(s, (i) => marker(pen, pen.X(s.x[i]), pen.Y(s.y[i]), 3.2)),
  error_bars: (pen, s) => each(s, (i) => {
    const x = pen.X(s.x[i]);
    pen.ctx.lineWidth = 1.4 * pen.ratio;
    pen.ctx.beginPath();
    pen.ctx.moveTo(x, pen.Y(s.lo[i]));
    pen.ctx.lineTo(x, pen.Y(s.hi[i]));
    pen.ctx.stroke();
    marker(pen, x, pen.Y(s.y[i]), 3.2);
  }),
  x_bars: (pen, s) => each(s, (i) => {
    const x = pen.X(s.x[i]), y = pen.Y(s.y[i]), r = 4.5 * pen.ratio;
    pen.ctx.beginPath();
    pen.ctx.moveTo(pen.X(s.lo[i]), y);
    pen.ctx.lineTo(pen.X(s.hi[i]), y);
    pen.ctx.stroke();
    pen.ctx.beginPath();
    pen.ctx.moveTo(x - r, y);
    pen.ctx.lineTo(x, y - r);
    pen.ctx.lineTo(x + r, y);
    pen.ctx.lineTo(x, y + r);
    pen.ctx.fill();
  }),
  band: (pen, s) => band(pen, s, 0.25),
  pale_band: (pen, s) => band(pen, s, 0.12),
  steps: (pen, s) => {
    const { ctx } = pen;
    ctx.beginPath();
    each(s, (i) => {
      const x = pen.X(s.x[i]), y = pen.Y(s.y[i]);
      if (i > 0) ctx.lineTo(x, pen.Y(s.y[i - 1]));
      else ctx.moveTo(x, y);
      ctx.lineTo(x, y);
    });
    ctx.stroke();
  },
  boxes: (pen, s) => each(s, (i) => {
    const a = pen.X(s.lo[i]), b = pen.X(s.hi[i]), zero = pen.Y(0), y = pen.Y(s.y[i]);
    pen.ctx.globalAlpha = 0.8;
    pen.ctx.fillRect(a, Math.min(y, zero), Math.max(b - a, 1), Math.max(Math.abs(zero - y), 1));
  }),
  bars: (pen, s) => each(s, (i) => {
    const a = pen.Y(s.hi[i]), b = pen.Y(s.lo[i]), zero = pen.X(0), x = pen.X(s.x[i]);
    pen.ctx.globalAlpha = 0.85;
    pen.ctx.fillRect(Math.min(x, zero), a, Math.max(Math.abs(x - zero), 1), Math.max(b - a, 1));
  }),
  cells: (pen, s, plot) => {
    const most = plot.most();
    each(s, (i) => {
      if (s.z[i] === null) return;
      pen.ctx.fillStyle = shade(s.z[i] / most);
      const x = pen.X(s.x[i] - s.lo[i]), y = pen.Y(s.y[i] + s.hi[i]);
      pen.ctx.fillRect(x, y, pen.X(s.x[i] + s.lo[i]) - x + 0.5, pen.Y(s.y[i] - s.hi[i]) - y + 0.5);
    });
  },
};

/** A figure in the document. options: group (TimeGroup), height (of panels, in those of the report), title and caption (false: none), onpoint,
    onleave, onpick, onkeypoint, onzoom; key: its name where others take its place; heldOut: intervals of x that are shaded, without a group; most: at the end of the scale of cells, at least; scales: a Map that they share, so that they have one scale.
    `cells`, `boxes`: what is emphasised, highlight() after a change; mark(): samples; `overlay`: series that are drawn over the others,
    redrawOver() after a change. */
export class Figure {
  constructor(parent, figure, options = {}) {
    this.figure = figure;
    this.options = options;
    this.group = options.group ?? null;
    this.sortedX = [];
    this.node = element('figure', { 'data-figure': figure.name });
    parent.append(this.node);
    this.width = this.node.clientWidth;
    if (options.title !== false) this.node.append(element('h3', {}, words(spaced(figure.title))));
    this.row = figure.panels.some((p) => p.beside) && this.width >= 520 ? element('div', { class: 'row' }) : null;
    if (this.row) this.node.append(this.row);
    this.marks = figure.panels.find((p) => p.marks.length > 0)?.marks ?? [];
    const own = figure.panels.filter((p) => !p.beside);
    const shared = this.sharedRange(own);
    this.plots = figure.panels.map((panel) => {
      const plot = new Plot(this, panel, { last: panel === own[own.length - 1], xLabel: figure.xLabel });
      if (!panel.beside) plot.xRange = shared ?? plot.xRange;
      return plot;
    });
    if (shared && !this.group?.window) for (const plot of this.plots) plot.showX(plot.xRange);
    const caption = element('figcaption', {}, options.caption === false ? '' : words(spaced(figure.caption)));
    for (const note of figure.notes) caption.append(element('span', { class: 'note' }, words(note)));
    if (caption.childNodes.length > 0) this.node.append(caption);
    this.observer = new ResizeObserver(() => this.resize());
    this.observer.observe(this.node);
  }
  /** Intervals of time that are shaded; none: x is no time. */
  heldOut() {
    return this.options.heldOut ?? this.group?.heldOut ?? [];
  }
  /** Panels above each other have the same x. */
  sharedRange(panels) {
    if (this.figure.xRange || panels.length < 2) return null;
    const out = [Infinity, -Infinity];
    for (const panel of panels) {
      const range = Plot.prototype.extentOfX.call({ series: panel.series.map((s) => ({ ...s, x: this.figure.xs[s.x] })), view: this });
      if (panel.series.some((s) => this.figure.xs[s.x].length > 0)) {
        out[0] = Math.min(out[0], range[0]);
        out[1] = Math.max(out[1], range[1]);
      }
    }
    return out[1] > out[0] ? out : null;
  }
  zoom(window) {
    for (const plot of this.plots) if (!plot.panel.beside) plot.showX(window);
    this.node.dataset.window = window === null ? '' : window.join(' ');
    this.options.onzoom?.(window);
  }
  /** Is there anything between these values of x? */
  reaches([from, to]) {
    const [low, high] = this.plots.find((plot) => !plot.panel.beside).xRange;
    return from < high && to > low;
  }
  redraw() {
    for (const plot of this.plots) plot.u.redraw(false);
  }
  redrawOver() {
    for (const plot of this.plots) plot.redrawOver();
  }
  /** After a change of `cells` or `boxes`: the series stay. */
  highlight() {
    for (const plot of this.plots) plot.paintLayers();
  }
  /** The samples with a 1 stand out; null: none. */
  mark(samples) {
    const others = Boolean(samples) !== Boolean(this.marked); // these fade
    this.marked = samples;
    if (others) this.redraw();
    else this.highlight();
  }
  resize() {
    const width = this.node.clientWidth;
    if (width === this.width || width === 0) return;
    this.width = width;
    for (const plot of this.plots) plot.u.setSize({ width: plot.width(), height: plot.height() });
  }
  destroy() {
    this.observer.disconnect();
    for (const plot of this.plots) plot.destroy();
    this.node.remove();
  }
}

/** `changed` is called when the screen turns light or dark: colours are drawn, so that figures must be drawn again. */
export const onScreenChange = (changed) => darkScreen.addEventListener('change', changed);
