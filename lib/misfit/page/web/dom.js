// Building the document. Every text is set as text: names of a study never become markup.

/** element('p', {class: 'soft'}, 'text', child, …); properties that begin with "on" are listeners. */
export function element(name, properties = {}, ...children) {
  const out = document.createElement(name);
  for (const [key, value] of Object.entries(properties)) {
    if (value === undefined || value === null || value === false) continue;
    if (key.startsWith('on')) out.addEventListener(key.slice(2), value);
    else out.setAttribute(key, value === true ? '' : value);
  }
  for (const child of children) if (child !== null && child !== undefined) out.append(child);
  return out;
}

/** Text from the server: plain, or pieces on (0), below (−1) and above (1) the line. */
export function words(text) {
  const out = document.createDocumentFragment();
  if (typeof text === 'string') {
    out.append(text);
    return out;
  }
  for (const [piece, place] of text ?? []) out.append(place === 0 ? piece : element(place < 0 ? 'sub' : 'sup', {}, piece));
  return out;
}

/** A text with the names in it as they are read: "lateral moment" for lateral_moment. Symbols, such as x_px, stay. */
export function spaced(text) {
  const read = (piece) => piece.replace(/(?<=[a-z]{2})_(?=[a-z]{2})/g, ' ');
  return typeof text === 'string' ? read(text) : (text ?? []).map(([piece, place]) => [read(piece), place]);
}

/** The same, with places where a long name may go on in the next line: before '(' and behind '_' and ':'. */
export function breakable(text) {
  const out = words(text);
  for (const node of [...out.childNodes]) {
    if (node.nodeType !== Node.TEXT_NODE) continue;
    const pieces = node.data.split(/(?=\()|(?<=[_:])/);
    node.replaceWith(...pieces.flatMap((piece, k) => (k === 0 ? [piece] : [element('wbr'), piece])));
  }
  return out;
}

export const plain = (text) => (typeof text === 'string' ? text : (text ?? []).map(([piece]) => piece).join(''));

/** A table that is wider than its place becomes rows of labelled values: nothing is cut off. Its cells have data-label. */
const tables = new ResizeObserver((entries) => {
  for (const { target } of entries) {
    const known = `${target.clientWidth}`;
    if (target.dataset.fitted === known) continue;
    target.dataset.fitted = known;
    target.classList.remove('stacked');
    target.classList.toggle('stacked', target.scrollWidth > target.clientWidth + 1);
  }
});
export function fittedTable(...children) {
  const out = element('div', { class: 'wide' }, ...children);
  tables.observe(out);
  return out;
}

function table(block) {
  const align = (k) => (block.columns[k]?.right ? { class: 'number' } : {});
  const head = element('tr', {}, ...block.columns.map((c, k) => element('th', { scope: 'col', ...align(k) }, words(c.heading))));
  const label = (k) => ({ 'data-label': k === 0 ? null : plain(block.columns[k]?.heading) });
  const body = element('tbody', {}, ...block.rows.map((row) => element('tr', {}, ...row.map((cell, k) => element('td', { ...align(k), ...label(k) }, words(cell))))));
  return fittedTable(element('table', {}, element('thead', {}, head), body));
}

/** Blocks as of a terminal or the report. `figures(name, parent)` draws what belongs to a place; `skip(block)`: left out. */
export function blocks(list, { figures = () => {}, skip = () => false } = {}) {
  const out = document.createDocumentFragment();
  for (const block of list ?? []) {
    if (skip(block)) continue;
    const tone = { class: block.tone === 'plain' ? null : block.tone };
    if (block.kind === 'heading') out.append(element(block.level === 1 ? 'h3' : 'h3', {}, words(block.text)));
    if (block.kind === 'paragraph') out.append(element('p', tone, words(block.text)));
    if (block.kind === 'list') {
      const list = element('ul', tone, ...block.items.map((item) => element('li', {}, words(item))));
      out.append(block.folded ? element('details', {}, element('summary', {}, words(block.folded)), list) : list);
    }
    if (block.kind === 'table') out.append(table(block));
    if (block.kind === 'figures') {
      const place = element('div');
      out.append(place);
      figures(block.name, place);
    }
  }
  return out;
}

/** A button that asks once, in its own place, before it acts; Escape and `no` lead back. */
export function askingButton(properties, text, { question, yes, no }, act) {
  const begin = element('button', { ...properties, onclick: () => ask() }, text), place = element('span', { class: 'asking' }, begin);
  function back() {
    place.replaceChildren(begin);
    begin.focus();
  }
  function ask() {
    const keep = element('button', { onclick: back }, no);
    place.replaceChildren(question, ' ', element('button', { class: 'yes', onclick: () => { back(); act(); } }, yes), ' ', keep);
    keep.focus();
  }
  place.addEventListener('keydown', (event) => {
    if (event.key !== 'Escape' || begin.isConnected) return;
    event.stopPropagation();
    back();
  });
  return place;
}

/** A number for readers: `digits` significant ones, a real minus sign. */
export function shown(value, digits = 4) {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  const size = Math.abs(value);
  const text = size !== 0 && (size >= 1e6 || size < 1e-4) ? value.toExponential(digits - 1) : String(Number(value.toPrecision(digits)));
  return text.replaceAll('-', '−');
}

/** Significant digits with which numbers of this size are told apart that differ by `difference`, such as times in UNIX seconds. */
const digitsFor = (value, difference) => (value === 0 || !(difference > 0) ? 1 : Math.floor(Math.log10(Math.abs(value) / difference)) + 2);

/** A place on an axis of which `span` is seen: to a thousandth of it, and with five digits at least; with `least`: so many, and to as many
    places of the span. */
export function shownPlace(value, span, least = 5) {
  const digits = Math.min(digitsFor(value, span) + least - 2, 15);
  return digits <= least || !Number.isFinite(value) ? shown(value, least) : String(Number(value.toPrecision(digits))).replaceAll('-', '−');
}

/** Beside an axis, as short as it goes: "20", "0.125", "1e6", "−2.5e−9"; neighbours, a `step` apart, differ. */
export function tick(value, step = 0) {
  const size = Math.abs(value), digits = Math.min(Math.max(digitsFor(value, step), 6), 15), text = Number(value.toPrecision(digits));
  const short = digits === 6 && size !== 0 && (size >= 1e6 || size < 1e-3);
  return (short ? text.toExponential().replace('e+', 'e') : String(text)).replaceAll('-', '−');
}

/** "12.3 ± 4.5": the sigma with two digits, the value with as many places. */
export function shownWithSigma(value, sigma) {
  if (!(sigma > 0) || !Number.isFinite(value)) return shown(value);
  const size = Math.max(Math.abs(value), sigma);
  if ((size >= 1e6 && sigma >= 100) || size < 1e-4) return `${shown(value, Math.min(Math.max(digitsFor(value, sigma), 2), 15))}\u00a0±\u00a0${shown(sigma, 2)}`;
  const places = Math.min(Math.max(1 - Math.floor(Math.log10(sigma)), 0), 8);
  return `${value.toFixed(places).replaceAll('-', '−')}\u00a0±\u00a0${sigma.toFixed(places)}`;
}
