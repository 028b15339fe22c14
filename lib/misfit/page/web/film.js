// The film of an experiment beside its plots over time.
import { element } from '/dom.js';
import { nearest, valueAt } from '/figure.js';
import { get } from '/server.js';

const at = (id) => document.getElementById(id);

/** The frame at the time cursor, or of a marked sample, with the markers as measured and as predicted. */
export class Film {
  place = -1; // among the films of the study; −1: this experiment has none
  t = null; // of the cursor
  chosen = null; // of a marked sample
  marks = [];
  busy = false;
  /** `timeShown(t)`: a time in words. */
  constructor(timeShown) {
    this.timeShown = timeShown;
    at('film').addEventListener('toggle', () => this.ask());
  }
  /** `place`: which film of the study, −1: none; `method`: by which the channels are predicted. */
  show(channels, place, method) {
    this.pairs = markersIn(channels);
    this.place = place;
    this.method = method;
    at('film').hidden = this.place < 0;
    this.asked = null;
    if (this.t === null) this.t = channels[0]?.figure.xs[0][0] ?? 0;
    this.ask();
  }
  point(t) {
    this.t = t;
    this.chosen = null;
    this.ask();
  }
  /** Of what is marked the sample nearest to the cursor is looked at, until the cursor moves on. */
  mark({ intervals, times }) {
    this.marks = intervals;
    this.chosen = intervals.length === 0 ? null : times.length > 0 ? times[nearest(times, this.t ?? 0)] : within(intervals[0], this.t ?? 0);
    this.ask();
    this.tell();
  }
  /** One question at a time; the last place that was pointed at is asked for in the end. */
  async ask() {
    if (this.busy || this.place < 0 || !at('film').open) return;
    this.busy = true;
    try {
      for (let t = this.chosen ?? this.t; t !== null && this.asked !== `${this.place} ${t}`; t = this.chosen ?? this.t) {
        this.asked = `${this.place} ${t}`;
        this.draw(await get('frame', { film: this.place, t }));
        this.seen = t;
        this.tell();
      }
    } catch (error) {
      at('frame-words').textContent = error.message;
    }
    this.busy = false;
  }
  /** Whether the frame is of a marked sample. */
  tell() {
    at('frame-badge').hidden = !this.marks.some(([from, to]) => from <= this.seen && this.seen <= to);
  }
  draw(frame) {
    this.picture().src = `data:image/jpeg;base64,${frame.jpeg}`;
    at('marks').setAttribute('viewBox', `0 0 ${frame.width} ${frame.height}`);
    this.putNodes();
    const said = new Set([`Frame at ${this.timeShown(frame.t)} s`]), size = 0.02 * frame.width;
    this.pairs.forEach((pair, k) => {
      const [measured, predicted] = ['measured', 'predicted'].map((kind) => placeOf(pair, kind, frame)), [circle, cross] = this.nodes[k];
      for (const [node, place] of [[circle, measured], [cross, predicted]]) node.style.display = place ? '' : 'none';
      if (measured) for (const [key, value] of [['cx', measured[0]], ['cy', measured[1]], ['r', size]]) circle.setAttribute(key, value);
      if (predicted) cross.setAttribute('d', `M${predicted[0] - size} ${predicted[1]}h${2 * size}M${predicted[0]} ${predicted[1] - size}v${2 * size}`);
      if (measured) said.add('yellow: measured');
      if (predicted) said.add(`blue: predicted by ${this.method}`);
    });
    at('frame-words').textContent = [...said].join(' · ');
  }
  /** Where the frame is seen: made when there is one. */
  picture() {
    if (!at('frame')) at('marks').before(element('img', { id: 'frame', alt: 'The frame at the time cursor' }));
    return at('frame');
  }
  /** A circle and a cross for each marker. */
  putNodes() {
    this.nodes ??= [[...at('marks').children]];
    while (this.nodes.length < this.pairs.length) this.nodes.push(this.nodes[0].map((node) => node.cloneNode()));
    at('marks').replaceChildren(...this.nodes.slice(0, Math.max(this.pairs.length, 1)).flat());
    for (const node of this.nodes[0]) node.style.display = 'none';
  }
}

const within = ([from, to], t) => Math.min(Math.max(t, from), to);

/** Where markers are: P_y, P_z from the middle of the picture, to the left and downwards; or x_px, y_px, column and row, of several x_px_NAME. */
function markersIn(channels) {
  const figures = new Map(channels.map((c) => [c.name, c.figure])), out = [];
  const add = (across, down, pixel) => { if (figures.has(across) && figures.has(down)) out.push({ figures: [figures.get(across), figures.get(down)], pixel }); };
  add('P_y', 'P_z', (x, y, { width, height }) => [width / 2 - x + 0.5, height / 2 + y + 0.5]);
  for (const name of figures.keys()) if (/^x_px(_|$)/.test(name)) add(name, name.replace('x', 'y'), (x, y) => [x + 0.5, y + 0.5]);
  return out;
}

/** [px] null: there is none at the frame's time. */
function placeOf({ figures, pixel }, kind, frame) {
  const [x, y] = figures.map((figure) => valueAt(figure, kind, frame.t));
  return x === undefined || y === undefined ? null : pixel(x, y, frame);
}
