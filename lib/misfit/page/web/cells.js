// The cells of a map, and the samples in them.
import { lowerBound } from '/figure.js';

/** The samples of a map, sorted once into its cells: pointing at one looks it up. */
export class SamplesByCell {
  /** `cellOf(i)`: of a sample, undefined: none. */
  constructor(t, cellOf) {
    this.t = t;
    this.places = new Map();
    for (let i = 0; i < t.length; ++i) {
      const cell = cellOf(i);
      if (cell === undefined) continue;
      if (!this.places.has(cell)) this.places.set(cell, []);
      this.places.get(cell).push(i);
    }
  }
  /** { times, intervals }: each sample reaches half-way to its neighbours, marked or not. */
  at(cell) {
    const places = this.places.get(cell) ?? [], intervals = [];
    places.forEach((i, k) => {
      if (k > 0 && places[k - 1] === i - 1) intervals.at(-1)[1] = this.border(i + 1);
      else intervals.push([this.border(i), this.border(i + 1)]);
    });
    return { times: places.map((i) => this.t[i]), intervals };
  }
  /** Half-way between the sample before and this one. */
  border(i) {
    const { t } = this, n = t.length;
    if (n < 2) return t[0];
    return i === 0 ? 1.5 * t[0] - 0.5 * t[1] : i === n ? 1.5 * t[n - 1] - 0.5 * t[n - 2] : 0.5 * (t[i - 1] + t[i]);
  }
}

/** Which of the ranges [edges[k], edges[k + 1]) has the value; undefined: none. */
export function rangeOf(edges, value) {
  if (value === null || !(value >= edges[0]) || value >= edges[edges.length - 1]) return undefined;
  const k = lowerBound(edges, value);
  return edges[k] === value ? k : k - 1;
}

/** The cells of a map over two quantities, which has none where there are too few samples. */
export class PairCells {
  constructor(figure) {
    const { x, y, lo, hi, z } = figure.panels[0].series[0], xs = figure.xs[x];
    this.boxes = xs.map((v, k) => [v - lo[k], v + lo[k], y[k] - hi[k], y[k] + hi[k]]);
    this.z = z;
    this.columns = new Map(); // its left edge: its cells
    this.boxes.forEach(([left], k) => this.columns.set(left, [...(this.columns.get(left) ?? []), k]));
    this.edges = [...[...this.columns.keys()].sort((a, b) => a - b), Infinity];
  }
  at(x, y) {
    const edge = this.edges[rangeOf(this.edges, x)];
    return this.columns.get(edge)?.find((k) => x < this.boxes[k][1] && y >= this.boxes[k][2] && y < this.boxes[k][3]);
  }
}
