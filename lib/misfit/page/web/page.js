// The page of `misfit open`: what the run folder holds, linked by one time cursor, one zoom and one selection. It computes no results.
import { askingButton, blocks, breakable, element, fittedTable, plain, shown, shownPlace, words } from '/dom.js';
import { Figure, TimeGroup, lowerBound, nearest, onScreenChange } from '/figure.js';
import { get, live, post, Refused } from '/server.js';
import { editor } from '/editor.js';

const at = (id) => document.getElementById(id);
const time = new TimeGroup();
const oneColumn = matchMedia('(max-width: 62rem)'), phone = matchMedia('(max-width: 34rem)'); // as in page.css
const tabs = [['where', 'Where it fails'], ['candidates', 'What could be missing'], ['curves', 'Curves, parameters'], ['calibration', 'Calibration'],
  ['ladder', 'Ladder'], ['study', 'Study'], ...(live ? [['commands', 'Commands']] : [])];

/** What is shown. The address keeps model and tab, so that a reload finds them again; without them it is the last model, of which the verdict speaks. */
const here = { state: null, model: 0, tab: 'where', method: null, name: undefined, motion: null, where: null, map: null, figures: [], timeFigures: [], force: null, added: null, marked: '', fixed: [], settingsOpen: false, late: false, chosen: false };

function readAddress() {
  const parts = new URLSearchParams(location.hash.slice(1));
  here.model = /^\d+$/.test(parts.get('model') ?? '') ? Number(parts.get('model')) : Infinity;
  here.tab = tabs.some(([name]) => name === parts.get('view')) ? parts.get('view') : 'where';
}
function writeAddress() {
  history.replaceState(null, '', `${location.search}#view=${here.tab}&model=${here.model}`);
}

function say(error) {
  at('alerts').append(element('p', { class: 'warning' }, String(error?.message ?? error)));
}

// ---- state and jobs

let version = null, jobNumber = null, busy = false, again = false;

/** Asks what there is; shows what has changed. */
async function look() {
  const state = await get('state');
  const job = state.job;
  const ended = jobNumber !== null && here.state?.job.state === 'running' && job.state !== 'running';
  here.state = state;
  showJob(job);
  if (state.version !== version || ended) {
    const grown = here.models !== undefined && state.models.length > here.models;
    version = state.version;
    here.models = state.models.length;
    if ((grown && !inHand()) || here.model >= state.models.length) here.model = state.models.length - 1;
    showHead();
    await showAll();
  }
  if (here.late && here.tab !== 'study' && !inHand()) {
    here.late = false;
    await showView();
  }
  jobNumber = job.number;
  return job.state === 'running';
}

async function watch() {
  if (!live) {
    await look().catch(say);
    document.body.dataset.ready = 'yes';
    return;
  }
  for (;;) {
    let running = false;
    try {
      running = await look();
      if (document.body.dataset.lost) location.reload();
    } catch (error) {
      if (error instanceof Refused) {
        if (!document.body.dataset.refused) say(error);
        document.body.dataset.refused = 'yes';
      } else if (!document.body.dataset.lost) {
        document.body.dataset.lost = 'yes';
        say('misfit does not answer any more: start `misfit open` again and use the address that it prints.');
      }
    }
    document.body.dataset.ready = 'yes';
    await new Promise((go) => setTimeout(go, running ? 400 : document.hidden ? 6000 : 1500));
  }
}

function showHead() {
  const { study, models, outdated, verdict, effects } = here.state;
  document.title = `${study.name} · misfit`;
  at('name').textContent = study.name;
  at('question').replaceChildren(words(study.question));
  const alerts = at('alerts');
  alerts.replaceChildren();
  if (study.fault) alerts.append(element('p', { class: 'warning', id: 'fault' }, `The study has an error: ${study.fault.message} `,
    element('button', { onclick: () => correct() }, 'Correct it')));
  at('tabs').querySelector('[data-view=calibration]').hidden = !here.state.camera && here.tab !== 'calibration';
  for (const sentence of outdated) alerts.append(element('p', { class: 'warning' }, sentence));
  if (!verdict) alerts.append(element('p', {}, 'There are no results yet: Run makes them.'));
  showVerdict(verdict ?? []);
  at('model').replaceChildren(...models.map((m, k) => element('option', { value: k }, m.added === '' ? "0: the study's own" : `${m.id}: + ${m.added}`)));
  at('model').value = here.model;
  const chosen = at('effect').value;
  const refused = effects.filter((one) => one.refused !== '');
  at('effect').replaceChildren(element('option', { value: '' }, 'an effect…'),
    ...effects.filter((one) => one.refused === '').map(({ effect }) => element('option', { value: effect }, effect)),
    refused.length === 0 ? '' : element('optgroup', { label: 'Not for this model, at their usual place' },
      ...refused.map(({ effect, refused: why }) => element('option', { value: effect, disabled: true, title: why }, `${effect}: ${reason(why)}`))));
  if (chosen) at('effect').value = chosen;
}

/** On a phone the sentence and what is next; the rest opens. */
function showVerdict(all) {
  const first = all.filter((b) => b.tone === 'lead' || b.tone === 'command'), rest = all.filter((b) => b.kind !== 'heading' && !first.includes(b));
  const open = at('verdict').querySelector('details')?.open ?? !phone.matches;
  const more = element('details', { open }, element('summary', {}, 'Where it fails, estimates, errors'), element('div', { class: 'facts' }, blocks(rest)));
  at('verdict').replaceChildren(blocks(first.filter((b) => b.tone === 'lead')), rest.length > 0 ? more : '', blocks(first.filter((b) => b.tone !== 'lead')));
}
phone.addEventListener('change', () => { if (!phone.matches) at('verdict').querySelector('details')?.setAttribute('open', ''); });

/** How a command failed, by its exit status. */
const failure = ({ status }) => (status === 2 ? 'refused: its message says what is wrong with the study or the command'
  : `not finished (status ${status}): its message says why`);

/** What misfit says against an effect, without its name again; the whole sentence is the title. */
function reason(why) {
  const said = why.replace(/^effect '[^']*' (is )?/, '').replace(/^does not suit this model: (effect '[^']*': )?/, '').replace(/ \(.*\)$/, '');
  return said.length > 70 ? `${said.slice(0, 68)}…` : said;
}

function showJob(job) {
  const running = job.state === 'running', box = at('job'), focused = document.activeElement;
  const idle = (here.idle = !running && here.state.study.fault === null);
  for (const id of ['run', 'fit', 'discover']) at(id).disabled = !idle;
  at('add').disabled = !idle || at('effect').value === '';
  for (const button of document.querySelectorAll('button.adds, button.removes, button.sets')) button.disabled = !idle;
  at('stop').hidden = !running;
  at('stop').textContent = job.stopping ? 'Stop at once' : 'Stop';
  began.follow(job);
  if (focused !== document.body && (focused.disabled || focused.hidden)) began.takeFocus(running);
  at('command').hidden = box.hidden = job.state === 'none' || (!running && here.closed === job.number);
  if (job.state === 'none') return;
  at('command').textContent = job.command;
  box.className = job.state;
  box.dataset.state = job.state;
  box.dataset.number = job.number;
  if (!running && box.dataset.shown === `${job.number}`) return;
  box.dataset.shown = running ? '' : `${job.number}`;
  const end = { running: job.stopping ? 'stopping' : 'at work', done: 'done', stopped: 'stopped: what was finished is kept', failed: failure(job) };
  const head = element('p', {}, element('b', {}, end[job.state]), ` · ${shown(job.seconds, 3)} s`);
  if (running && job.work) head.append(` · ${job.work} `, job.part === null ? '' : element('progress', { value: job.part, max: 1 }),
    job.left === null ? '' : ` at most ${shown(job.left, 2)} s left`);
  if (!running) head.append(' ', element('button', { class: 'closes', title: 'Hide what the command said; it stays in session.sh', onclick: () => { box.hidden = at('command').hidden = true; here.closed = job.number; } }, 'Close'));
  const open = box.querySelector('details')?.open ?? false;
  const parts = [head];
  if (!running && job.state === 'failed') parts.push(element('pre', { class: 'warning' }, job.notes.slice(-5).join('\n')));
  if (job.notes.length > 0 || job.output !== '')
    parts.push(element('details', { open }, element('summary', {}, 'What it says'), running ? '' : costs(job.costs), element('pre', {}, [...job.notes, job.output].join('\n'))));
  if (running) parts.push(costs(job.costs));
  box.replaceChildren(...parts);
}

/** How the searches of a command go on: the last two, in one line. */
function costs(traces) {
  const out = element('div', { class: 'costs' });
  for (const trace of traces.slice(-2)) {
    if (trace.points.length < 2) continue;
    out.append(element('figure', {}, sparkline(trace.points.map(([, value]) => value)),
      element('figcaption', {}, `${trace.work}: ${trace.what} ${shown(trace.points[0][1], 6)} → ${shown(trace.points.at(-1)[1], 6)} in ${trace.points.length} iterations`)));
  }
  return out;
}

/** A line without axes; its numbers stand below it. */
function sparkline(values) {
  const low = Math.min(...values), high = Math.max(...values), span = high - low || 1;
  const place = values.map((v, k) => `${((k / (values.length - 1)) * 270).toFixed(1)},${(56 - ((v - low) / span) * 52).toFixed(1)}`);
  const out = at('sparkline').content.cloneNode(true);
  out.querySelector('polyline').setAttribute('points', place.join(' '));
  return out;
}

/** The state of the last command, at the button that began it: buttons have a data-key, by which they are found when a view is drawn anew. */
class Began {
  key = null;
  number = null;
  at = -Infinity; // when it was asked for
  constructor() {
    this.words = element('span', { 'aria-live': 'polite' });
    this.clock = element('span', { 'aria-hidden': true });
    this.stop = element('button', { class: 'stops', hidden: true, onclick: stop });
    this.node = element('span', { class: 'began' }, this.words, this.clock, this.stop);
  }
  button() {
    return this.key === null ? null : document.querySelector(`button[data-key="${CSS.escape(this.key)}"]`);
  }
  /** Behind its button; beside the buttons above behind all of them, so that none moves. */
  place() {
    const button = this.button(), bar = button?.closest('#work .buttons');
    if (!button) return;
    const hadFocus = this.node.contains(document.activeElement);
    if (bar) {
      if (this.node.parentNode !== bar) bar.append(this.node);
    } else if (button.nextSibling !== this.node) button.after(this.node);
    if (hadFocus && document.activeElement === document.body) this.stop.focus({ preventScroll: true });
  }
  say(words, { clock = '', bad = false, stop = '' } = {}) {
    if (this.words.textContent !== words) this.words.textContent = words;
    this.clock.textContent = clock;
    this.node.classList.toggle('warning', bad);
    this.stop.textContent = stop;
    this.stop.hidden = stop === '' || this.node.closest('.buttons') !== null;
    this.place();
  }
  asked(key) {
    this.key = key;
    this.at = performance.now();
    this.number = null;
    this.node.remove();
    this.place();
    this.say('asked for');
  }
  refused(error) {
    this.say(error.message, { bad: true });
    if (!this.button()) say(error);
  }
  follow(job) {
    if (job.number !== this.number || job.state === 'none') return;
    const clock = ` ${shown(job.seconds, 3)} s `;
    if (job.state === 'running') this.say(job.stopping ? 'stopping' : 'at work', { clock, stop: job.stopping ? 'Stop at once' : 'Stop' });
    else if (job.state === 'done') this.say('done', { clock });
    else if (job.state === 'stopped') this.say('stopped', { clock });
    else this.say(job.notes.at(-1) ?? failure(job), { bad: true });
  }
  /** Of a button that cannot be used any more: to what is next, the end of the command, or to what began it. */
  takeFocus(running) {
    const button = this.button();
    const next = running ? [this.stop, at('stop')] : [button, at('job')];
    next.find((one) => one?.isConnected && !one.disabled && !one.hidden)?.focus({ preventScroll: true });
  }
}
const began = new Began();

async function stop(event) {
  if (event.detail === 0 && performance.now() - began.at < 500) return; // by a key: the Enter that began it, pressed twice
  try {
    await post('stop');
    await look();
  } catch (error) {
    began.refused(error);
  }
}

// `key`: of the button; `more`: what the verb needs: { effect, at } to add, { rung } to remove.
async function start(key, verb, more = {}) {
  began.asked(key);
  try {
    began.number = (await post('job', { verb, ...more })).number;
    await look();
  } catch (error) {
    began.refused(error);
  }
}

// ---- over time

/** By the method that was chosen, by its name; of the last one until then, and where the model has none of that name. */
const askForMotion = () => get('motion', { model: here.model, ...(here.method === null ? {} : { method: here.method }) });

async function showMotion(motion = null) {
  motion = here.motion = motion ?? await askForMotion();
  at('methods').hidden = motion.methods.length === 0;
  at('method').replaceChildren(...motion.methods.map((name) => element('option', { value: name }, name)));
  at('method').value = motion.methods[motion.method];
  const names = [...new Set([...motion.channels.map((c) => c.experiment), ...(here.where?.force ?? []).map((f) => f.experiment), ...here.state.films])];
  chooseExperiment(names.includes(here.name) ? here.name : names[0]);
  at('experiments').hidden = names.length < 2;
  at('experiment').replaceChildren(...names.map((name) => element('option', { value: name }, name)));
  at('experiment').value = here.name;
  drawTime();
}

/** Marks and zoom are of one recording: they do not go with the choice of another one. */
function chooseExperiment(name) {
  if (name === here.name) return;
  here.name = name;
  time.zoom(null);
  unmark();
}

function drawTime() {
  for (const figure of here.timeFigures.splice(0)) figure.destroy();
  here.force = null;
  at('motion').replaceChildren();
  const options = { group: time, title: false, caption: false };
  const channels = here.motion.channels.filter((c) => c.experiment === here.name);
  const force = missing();
  const height = channels.length > 1 ? 0.45 : 0.7;
  film.show(channels);
  channels.forEach((c, k) => here.timeFigures.push(new Figure(at('motion'), c.figure, { ...options, height, xLabel: k === channels.length - 1,
    oncursor: k === 0 ? (t) => film.point(t) : null })));
  if (channels.length === 0) at('motion').append(element('p', { class: 'soft' },
    here.motion.methods.length === 0 ? 'Nothing is fitted yet.' : 'This method does not predict the motion.'), blocks(here.motion.blocks));
  drawForce(null);
}

/** The missing force of the experiment that is shown, and its place among those of all. */
const missing = () => here.where?.force.find((f) => f.experiment === here.name);
const placeOfMissing = () => here.where.force.indexOf(missing());

/** `added`: { name, figure } of a candidate, whose force stands in it, too. What is there goes when the new one stands: nothing jumps. */
function drawForce(added) {
  const before = [...at('force').children], old = here.force;
  here.added = added;
  here.force = null;
  if (missing()) {
    at('force').append(element('h3', {}, added ? `Force that is missing, ± 1 sigma, and (thick) what ${added.name} adds` : 'Force that is missing, ± 1 sigma'));
    here.force = new Figure(at('force'), added?.figure ?? missing().figure, { group: time, title: false, caption: false, height: 0.5 });
    here.timeFigures.push(here.force);
  }
  if (old) here.timeFigures.splice(here.timeFigures.indexOf(old), 1)[0].destroy();
  for (const node of before) node.remove();
}

/** The frame at the time cursor, with the marker as measured and as predicted. */
class Film {
  place = -1; // among the films of the study; −1: this experiment has none
  t = null;
  busy = false;
  constructor() {
    at('film').addEventListener('toggle', () => this.ask());
  }
  /** Where the marker is: P_y, P_z from the middle of the picture, to the left and downwards, or column and row. */
  show(channels) {
    const named = (name) => channels.find((c) => c.name === name)?.figure;
    const fromMiddle = named('P_y') && named('P_z');
    this.across = fromMiddle ? named('P_y') : named('x_px');
    this.down = fromMiddle ? named('P_z') : named('y_px');
    this.pixel = (x, y, { width, height }) => (fromMiddle ? [width / 2 - x + 0.5, height / 2 + y + 0.5] : [x + 0.5, y + 0.5]);
    this.place = here.state.films.indexOf(here.name);
    at('film').hidden = this.place < 0;
    this.asked = null;
    if (this.t === null) this.t = channels[0]?.figure.xs[0][0] ?? 0;
    this.ask();
  }
  point(t) {
    this.t = t;
    this.ask();
  }
  /** One question at a time; the last place that was pointed at is asked for in the end. */
  async ask() {
    if (this.busy || this.place < 0 || !at('film').open) return;
    this.busy = true;
    try {
      while (this.asked !== `${this.place} ${this.t}`) {
        const t = this.t;
        this.asked = `${this.place} ${t}`;
        this.draw(await get('frame', { film: this.place, t }));
      }
    } catch (error) {
      at('frame-words').textContent = error.message;
    }
    this.busy = false;
  }
  draw(frame) {
    at('frame').src = `data:image/jpeg;base64,${frame.jpeg}`;
    at('marks').setAttribute('viewBox', `0 0 ${frame.width} ${frame.height}`);
    const [measured, predicted] = ['measured', 'predicted'].map((kind) => this.marker(kind, frame)), size = 0.02 * frame.width;
    const [circle, cross] = at('marks').children;
    for (const [node, place] of [[circle, measured], [cross, predicted]]) node.style.display = place ? '' : 'none';
    if (measured) for (const [key, value] of [['cx', measured[0]], ['cy', measured[1]], ['r', size]]) circle.setAttribute(key, value);
    if (predicted) cross.setAttribute('d', `M${predicted[0] - size} ${predicted[1]}h${2 * size}M${predicted[0]} ${predicted[1] - size}v${2 * size}`);
    const said = [`Frame at ${timeShown(frame.t)} s`];
    if (measured) said.push('yellow: measured');
    if (predicted) said.push(`blue: predicted by ${here.motion.methods[here.motion.method]}`);
    at('frame-words').textContent = said.join(' · ');
  }
  /** [px] null: there is none at the frame's time. */
  marker(kind, frame) {
    const [x, y] = [this.across, this.down].map((figure) => figure && valueAt(figure, kind, frame.t));
    return x === undefined || y === undefined ? null : this.pixel(x, y, frame);
  }
}
const film = new Film();

/** Of the series of that kind in the first panel, held out or not; undefined: it has none there. */
function valueAt(figure, kind, t) {
  for (const s of figure.panels[0].series) {
    const x = figure.xs[s.x], k = nearest(x, t);
    if (s.key.startsWith(kind) && s.y[k] !== null && s.y[k] !== undefined) return s.y[k];
  }
  return undefined;
}

function mark(intervals, text, fixed) {
  if (fixed) {
    Object.assign(here, { fixed: intervals, marked: text });
    time.begun = undefined;
  }
  const shownNow = intervals.length > 0 || fixed ? intervals : here.fixed;
  time.setMarks(shownNow);
  at('marked').textContent = at('marked').title = intervals.length > 0 ? text : here.marked;
  at('unmark').hidden = here.fixed.length === 0;
  at('holdout').hidden = !live || here.fixed.length !== 1 || here.model !== 0 || !here.state.settable.experiments.includes(here.name);
  at('time').dataset.marks = shownNow.length;
  markPoints();
}
function unmark() {
  for (const figure of here.figures) {
    if (!figure.fixedCells && !figure.fixedBoxes) continue;
    figure.cells = figure.boxes = figure.fixedCells = figure.fixedBoxes = undefined;
    figure.highlight();
  }
  mark([], '', true);
}
/** As exactly as what is seen of the motion tells. */
function timeShown(t) {
  const [from, to] = here.timeFigures[0]?.plots[0]?.window ?? [0, 0];
  return shownPlace(t, to - from);
}
time.onzoom = (window) => { at('time').dataset.window = window === null ? '' : window.join(' '); };
time.onbegun = (t) => { at('marked').textContent = `Marked from ${timeShown(t)} s: m again where it ends`; };
/** The ends of an interval, with the digits by which they differ. */
const endsShown = (from, to) => [from, to].map((end) => shownPlace(end, 10 * (to - from))).join(' to ');
time.onmark = ([[from, to]]) => mark([[from, to]], `Marked: ${endsShown(from, to)} s`, true);

/** Two times, to a millionth of what lies between them: a mouse knows no more. */
function written([from, to]) {
  const places = Math.min(Math.max(Math.ceil(6 - Math.log10(to - from)), 0), 15);
  return [from, to].map((t) => String(Number(t.toFixed(places)))).join(' ');
}

/** The samples of the marked times, in the view of force against a quantity. */
function markPoints() {
  const samples = here.samples;
  if (!samples) return;
  const marks = time.marks;
  let mask = null;
  if (marks.length > 0) {
    mask = new Uint8Array(samples.t.length);
    for (const [from, to] of marks) for (let i = lowerBound(samples.t, from); i < samples.t.length && samples.t[i] <= to; ++i) mask[i] = 1;
  }
  samples.figure.mark(mask);
}

// ---- views

function draw(parent, figure, options) {
  const out = new Figure(parent, figure, options);
  here.figures.push(out);
  return out;
}
const nothing = (parent, text) => parent.append(element('p', { class: 'soft' }, text));

/** The pair that a map is over, or the one quantity: its samples, in the order of their times. */
async function samplesOf(quantity) {
  const force = here.where.force, experiment = Math.max(force.findIndex((f) => f.experiment === here.name), 0);
  const k = force[experiment]?.quantities.findIndex((q) => q.name === quantity) ?? -1;
  if (k >= 0) return get('samples', { model: here.model, experiment, quantity: k });
  return null;
}

/** Times whose samples satisfy `inside`, as intervals. */
function intervals(t, inside) {
  const out = [];
  const half = t.length > 1 ? 0.5 * (t[t.length - 1] - t[0]) / (t.length - 1) : 0;
  let count = 0;
  for (let i = 0; i < t.length; ++i) {
    if (!inside(i)) continue;
    ++count;
    const last = out[out.length - 1];
    if (last && t[i] - half <= last[1] + half) last[1] = t[i] + half;
    else out.push([t[i] - half, t[i] + half]);
  }
  return { out, count };
}

async function showWhere(view) {
  const where = here.where;
  if (!where) return nothing(view, 'This model is not diagnosed yet. Discover (or misfit diagnose) does it; Run does it only if filter_error is among the methods of the study.');
  const conclusions = where.blocks.find((b) => b.kind === 'list');
  if (conclusions) view.append(blocks([conclusions]));
  const all = [...where.maps, ...where.pairs].sort((a, b) => (a.p ?? 2) - (b.p ?? 2)); // the most significant first; without a p last
  const list = element('div', { class: 'list', role: 'group', 'aria-label': 'Maps of the missing force' });
  const body = element('div');
  const buttons = all.map((map, k) => element('button', { 'aria-pressed': 'false', 'data-map': map.figure.name, onclick: () => show(k) }, words(map.portLabel), ' against ',
    words(map.label ?? map.xLabel), map.yLabel ? ' and ' : '', map.yLabel ? words(map.yLabel) : '', ' ', element('small', {}, `p = ${shown(map.p, 2)}`)));
  list.append(...buttons);
  view.append(element('h3', {}, 'Missing force against…'), list, body);
  const more = element('details', {}, element('summary', {}, 'Tests of the residuals'));
  more.addEventListener('toggle', () => {
    if (!more.open || more.dataset.drawn) return;
    more.dataset.drawn = 'yes';
    for (const figure of where.whiteness) draw(more, figure);
    more.append(blocks(where.blocks.filter((b) => b !== conclusions && b.kind !== 'figures')));
  });
  view.append(more);
  let turn = 0;
  async function show(k) {
    const mine = ++turn;
    here.map = all[k].figure.name;
    buttons.forEach((b, n) => b.setAttribute('aria-pressed', n === k));
    for (const figure of here.figures.splice(0)) if (body.contains(figure.node)) figure.destroy(); else here.figures.push(figure);
    here.samples = null;
    body.replaceChildren();
    if (where.maps.includes(all[k])) await showMap(body, all[k], () => mine === turn);
    else await showPair(body, all[k], () => mine === turn);
  }
  const before = all.findIndex((map) => map.figure.name === here.map);
  if (all.length > 0) await show(Math.max(before, 0));
}

async function showMap(body, map, current) {
  const samples = map.quantity === 'time' ? null : await samplesOf(map.quantity).catch(() => null);
  if (!current()) return;
  const places = map.figure.xs[map.figure.panels[0].series.find((s) => s.style === 'error_bars').x];
  const edge = (k) => (k < 0 ? places[0] - 0.5 * (places[1] - places[0]) : k >= places.length - 1
    ? places[places.length - 1] + 0.5 * (places[places.length - 1] - places[places.length - 2]) : 0.5 * (places[k] + places[k + 1]));
  const t = samples?.t ?? here.timeFigures.at(-1)?.figure.xs[0] ?? [], values = samples?.values ?? (map.quantity === 'time' ? t : []);
  const unit = plain(map.figure.xUnit);
  let hot = null;
  const choose = (figure, x, fixed) => {
    const k = nearest(places, x), from = edge(k - 1), to = edge(k);
    if (hot === k && !fixed) return;
    hot = k;
    figure.cells = [[from, to]];
    if (fixed) figure.fixedCells = figure.cells;
    figure.highlight();
    const { out, count } = intervals(t, (i) => values[i] !== null && values[i] >= from && values[i] < to);
    mark(out, `Marked: ${count} samples with ${map.quantity} from ${endsShown(from, to)} ${unit}`, fixed);
  };
  const figure = draw(body, map.change ?? map.figure, { height: 0.8,
    onpoint: (plot, x) => choose(plot.view, x, false), onpick: (plot, x) => choose(plot.view, x, true), onkeypoint: (plot, x) => choose(plot.view, x, true),
    onleave: (plot) => { hot = null; plot.view.cells = plot.view.fixedCells ?? []; plot.view.highlight(); mark([], '', false); } });
  figure.node.append(element('p', { class: 'soft' }, samples || map.quantity === 'time'
    ? 'Point at a place: its samples are marked in the motion. A click keeps them marked.' : 'Its samples are not at hand here; `misfit open` marks them in the motion.'));
  if (samples) {
    here.samples = { t: samples.t, figure: draw(body, samples.figure, { height: 0.7 }) };
    markPoints();
  }
}

async function showPair(body, map, current) {
  const [first, second] = await Promise.all([samplesOf(map.x), samplesOf(map.y)].map((p) => p.catch(() => null)));
  if (!current()) return;
  const timeOf = (name, other) => (name === 'time' && other ? { t: other.t, values: other.t } : null); // a sample's own
  const x = first ?? timeOf(map.x, second), y = second ?? timeOf(map.y, first);
  const cells = map.figure.panels[0].series[0], xs = map.figure.xs[cells.x];
  let hot = null;
  const choose = (figure, px, py, fixed) => {
    const k = xs.findIndex((v, i) => Math.abs(px - v) <= cells.lo[i] && Math.abs((py ?? cells.y[i]) - cells.y[i]) <= cells.hi[i]);
    if (k < 0 || (hot === k && !fixed)) return;
    hot = k;
    const box = [xs[k] - cells.lo[k], xs[k] + cells.lo[k], cells.y[k] - cells.hi[k], cells.y[k] + cells.hi[k]];
    figure.boxes = [box];
    if (fixed) figure.fixedBoxes = figure.boxes;
    figure.highlight();
    if (!x || !y) return;
    const { out, count } = intervals(x.t, (i) => x.values[i] !== null && y.values[i] !== null && x.values[i] >= box[0] && x.values[i] < box[1] &&
      y.values[i] >= box[2] && y.values[i] < box[3]);
    mark(out, `Marked: ${count} samples with ${map.x} from ${endsShown(box[0], box[1])} ${plain(map.figure.xUnit)} and ${map.y} from ` +
      `${endsShown(box[2], box[3])} ${plain(map.figure.panels[0].unit)}; force ${shown(cells.z[k], 2)} sigma`, fixed);
  };
  draw(body, map.figure, { height: 0.9, onpoint: (plot, px, py) => choose(plot.view, px, py, false), onpick: (plot, px, py) => choose(plot.view, px, py, true),
    onleave: (plot) => { hot = null; plot.view.boxes = plot.view.fixedBoxes ?? []; plot.view.highlight(); mark([], '', false); } });
}

async function showCandidates(view) {
  const found = await get('candidates', { model: here.model });
  if (!found) return nothing(view, 'Nobody has asked yet which effect is missing: Discover ranks them.');
  const last = here.model === here.state.models.length - 1;
  const begin = found.blocks.findIndex((b) => b.kind !== 'heading' && b.kind !== 'paragraph');
  const lead = found.blocks.slice(0, begin).filter((b) => b.kind === 'paragraph');
  const table = found.blocks.find((b) => b.kind === 'table');
  view.append(blocks(lead));
  if (!last) nothing(view, 'Effects are added to the last model of the ladder; these are the candidates of an earlier one.');
  if (live && last && found.unknown.length > 0) view.append(asCurve(found.unknown));
  if (table) view.append(candidateTable(table, found.rows, last));
  if (found.figure) draw(view, found.figure, { height: 0.85 });
  const rest = found.blocks.filter((b) => !lead.includes(b) && b !== table && b.kind !== 'figures' && !(b.kind === 'heading' && b.level === 1));
  view.append(element('details', {}, element('summary', {}, 'Remarks, reasons and what was tried'), blocks(rest)));
}

/** Of a force or an error that no named effect describes: it can stay in the model as a curve of a quantity. */
function asCurve(unknown) {
  const button = (one) => element('button', { class: 'adds', 'data-effect': one.effect, 'data-key': `add ${one.name}`, disabled: !here.idle,
    title: `misfit add … ${[one.effect, ...one.at].join(' --at=')}`,
    onclick: () => start(`add ${one.name}`, 'add', { effect: one.effect, at: one.at }) }, `Add ${one.name}`);
  return element('p', { class: 'unknown' }, 'No effect of the list describes it. Added as a curve of one quantity, it takes over what no formula does: ',
    ...unknown.map(button));
}

/** Pointing at a candidate shows the force that it adds beside the missing one; its button keeps it there. */
class AddedForces {
  kept = null;
  turn = 0;
  offer(line, cell, row) {
    const button = element('button', { class: 'shows', 'aria-pressed': 'false', title: 'Show over time the force that it adds' }, ...cell.childNodes);
    cell.replaceChildren(button);
    const own = { button, name: row.name, candidate: row.candidate };
    line.addEventListener('mouseenter', () => this.show(own));
    line.addEventListener('mouseleave', () => this.show(this.kept));
    button.addEventListener('click', () => {
      this.kept?.button.setAttribute('aria-pressed', 'false');
      this.kept = this.kept === own ? null : own;
      button.setAttribute('aria-pressed', this.kept === own);
      this.show(this.kept);
    });
  }
  async show(own) {
    const mine = ++this.turn, { model, name } = here;
    const figure = own && missing() ? await get('added', { model: here.model, experiment: placeOfMissing(), candidate: own.candidate }).catch(() => null) : null;
    const shown = model === here.model && name === here.name && here.tab === 'candidates' && own?.button.isConnected !== false;
    if (mine === this.turn && shown) drawForce(figure ? { name: own.name, figure } : null);
  }
}

function candidateTable(table, rows, last) {
  const most = 12; // rows to begin with
  const heading = (n) => plain(table.columns[n].heading), empty = (n) => table.rows.every((row) => plain(row[n]) === '–');
  const columns = table.columns.map((_, n) => n).filter((n) => !['rank', 'accepted'].includes(heading(n)) && !empty(n));
  const side = (n) => (table.columns[n].right ? 'number' : null);
  const head = element('tr', {}, element('td'), ...columns.map((n) => element('th', { scope: 'col', class: side(n) }, words(table.columns[n].heading))));
  const body = element('tbody'), pointing = new AddedForces();
  rows.forEach((row, k) => {
    const button = live && row.addable && last
      ? element('button', { class: 'adds' + (row.accepted ? ' main' : ''), 'data-effect': row.effect, 'data-key': `add ${row.name}`,
          title: `misfit add … ${[row.effect, ...row.at].join(' --at=')}`, disabled: !here.idle,
          onclick: () => start(`add ${row.name}`, 'add', { effect: row.effect, at: row.at }) }, 'Add') : '';
    const more = k >= most ? ' more' : '';
    const line = element('tr', { class: (row.accepted ? 'accepted ' : '') + 'of-why' + more }, element('td', {}, button),
      ...columns.map((n) => element('td', { class: side(n), 'data-label': heading(n) === 'effect' ? null : heading(n) }, breakable(table.rows[k][n]))));
    if (row.force) pointing.offer(line, line.children[1], row);
    body.append(line, element('tr', { class: 'why' + more }, element('td'), element('td', { colspan: columns.length }, words(row.why))));
  });
  const all = element('table', { id: 'candidates' }, element('thead', {}, head), body);
  const rest = rows.length > most ? element('button', { onclick: () => { all.classList.add('all'); rest.remove(); } }, `All ${rows.length}`) : null;
  return element('div', {}, fittedTable(all), rest);
}

async function showCurves(view) {
  const curves = await get('curves', { model: here.model });
  if (curves.figures.length === 0) nothing(view, 'This model has no curves; its parameters:');
  const figures = curves.figures.map((figure) => draw(view, figure, { height: 0.8 }));
  figures.forEach((figure, k) => roughnessOf(curves.roughness.filter((path) => path.curves[0].figure === k), figures, figure.node));
  view.append(blocks(curves.blocks));
  if (!live) return;
  if (here.model !== 0) nothing(view, "Parameters are fixed and roughness is set with the study's own model (rung 0).");
  else if (here.state.study.fault === null) view.append(settings());
}

/** A slider for the roughness of a curve, by each of the methods that have one: the curve, and those derived from it, follow at once, by the
    linearised fit. A refit is made by Set and Run. */
function roughnessOf(paths, figures, parent) {
  if (paths.length === 0) return;
  let path = paths[paths.length - 1];
  const slider = element('input', { type: 'range', min: 0, step: 'any', 'aria-label': `smoothness of ${path.curve}`, 'data-curve': path.curve, oninput: () => move() });
  const said = element('output', {}), back = element('button', { onclick: () => begin() }, 'As fitted');
  const setting = live && here.model === 0 && here.state.study.fault === null && here.state.settable.curves.some((c) => c.name === path.curve);
  const key = `slider ${path.curve}`;
  const set = setting ? element('button', { class: 'sets', 'data-key': key, disabled: !here.idle, title: 'writes it into the study; Run refits',
    onclick: () => start(key, 'set', { what: 'roughness', name: path.curve, value: value().toPrecision(3) }) }, 'Set') : null;
  const methods = element('select', { 'aria-label': 'method', hidden: paths.length < 2, onchange: () => { path = paths[methods.value]; begin(); } },
    ...paths.map((p, k) => element('option', { value: k, selected: p === path }, p.method)));
  const used = () => nearest(path.roughness, path.used);
  /** Of lists by roughness, between two of them. */
  const between = (lists, mix) => {
    const k = Math.min(Math.floor(slider.valueAsNumber), lists.length - 2), share = slider.valueAsNumber - k;
    return mix(lists[k], lists[k + 1], share);
  };
  const mixed = (a, b, share) => a + share * (b - a);
  const value = () => Math.exp(between(path.roughness.map(Math.log), mixed));
  function move() {
    const asFitted = slider.valueAsNumber === used();
    for (const figure of figures) figure.overlay = (figure.overlay ?? []).filter((s) => s.of !== slider); // other curves keep theirs
    for (const c of asFitted ? [] : path.curves) {
      const y = between(c.values, (a, b, share) => a.map((v, i) => mixed(v, b[i], share)));
      figures[c.figure]?.overlay.push({ of: slider, x: c.x, y, sorted: true, style: 'line', width: 2.5, colour: '#000000' });
    }
    for (const figure of figures) figure.redraw();
    const support = between(path.support, mixed), freedom = path.freedom && `; ${path.freedom} effective degrees of freedom`;
    said.replaceChildren(asFitted ? '' : 'Black: ', `roughness λ = ${shown(value(), 3)} `, words(path.unit), asFitted
      ? ` as fitted, ${path.chosen ? 'chosen from the data' : 'given by the study'}${freedom}`
      : `, ${shown(value() / path.used, 2)} times as fitted; ${support < 0 ? 'less' : 'more'} likely by ${
        shown(Math.abs(support), 2)} (log marginal likelihood). All other unknowns follow (linearised).`);
    back.disabled = asFitted;
  }
  function begin() {
    slider.max = path.roughness.length - 1;
    slider.value = used();
    move();
  }
  begin();
  parent.append(element('div', { class: 'slider' }, element('span', { title: 'the key roughness of the curve: the larger it is, the smoother is the curve' }, 'Smoothness of ', words(path.label)), methods, element('span', { class: 'soft' }, 'rough'), slider,
    element('span', { class: 'soft' }, 'smooth'), back, set, said));
}

/** What of the study's own model is estimated and how; each change is `misfit set`, the results are made anew by Run. */
function settings() {
  const set = (what, name, value) => start(`${what} ${name}`, 'set', { what, name, value });
  const rows = here.state.settable.parameters.map(({ name, label, unit, free }) => element('tr', {}, element('td', {}, words(label), ' [', words(unit), ']'),
    element('td', {}, free ? 'estimated' : 'fixed'), element('td', {}, element('button', { class: 'sets', 'data-parameter': name, 'data-key': `free ${name}`, disabled: !here.idle,
      onclick: () => set('free', name, `${!free}`) }, free ? 'Fix' : 'Estimate'))));
  for (const { name, label, unit, roughness } of here.state.settable.curves) {
    const box = element('input', { value: roughness, size: 12, 'aria-label': `roughness of ${name}` });
    rows.push(element('tr', {}, element('td', {}, 'roughness of ', words(label), ' [', words(unit), '], larger: smoother'), element('td', {}, box), element('td', {},
      element('button', { class: 'sets', 'data-roughness': name, 'data-key': `roughness ${name}`, title: 'auto, or a number of at least 0', disabled: !here.idle,
        onclick: () => set('roughness', name, box.value.trim()) }, 'Set'))));
  }
  return element('details', { id: 'settings', open: here.settingsOpen, ontoggle: (event) => (here.settingsOpen = event.target.open) }, element('summary', {}, 'Fix or estimate a parameter, change a roughness'), fittedTable(element('table', {}, element('tbody', {}, ...rows))),
    element('p', { class: 'soft' }, 'A change is written into the study; Run makes the results anew.'));
}

async function showCalibration(view) {
  const calibration = await get('calibration');
  if (!calibration) return nothing(view, 'This study has no calibrated camera.');
  view.append(blocks(calibration.blocks.filter((b) => b.kind !== 'heading' || b.level !== 1), { figures: (name, parent) => calibration.figures.forEach((f) => draw(parent, f)) }));
}

async function showLadder(view) {
  const ladder = await get('ladder');
  if (!ladder) return nothing(view, 'The ladder begins when an effect is added: each added effect is a rung.');
  const choice = element('div', { class: 'rungs', role: 'group', 'aria-label': 'Rungs' }, ...ladder.rungs.map((rung) => {
    const k = here.state.models.findIndex((m) => m.id === rung.id);
    return element('button', { 'aria-pressed': `${k === here.model}`, 'data-rung': rung.id, onclick: () => choose(k) }, `${rung.id}: ${rung.added === '' ? rung.system : `+ ${rung.added}`}`);
  }));
  view.append(element('p', { class: 'soft' }, 'A click shows the results of that model everywhere on this page.'), choice);
  draw(view, ladder.figure, { height: 0.75 });
  const current = ladder.rungs.find((rung) => rung.id === here.state.models[here.model].id), last = ladder.rungs[ladder.rungs.length - 1];
  if (current) view.append(element('h3', {}, `Rung ${current.id}`), blocks(current.blocks));
  if (live && current && current.added !== '') {
    const above = last === current ? 'this rung' : 'this rung and those above it', key = `remove ${current.id}`;
    view.append(element('p', {}, askingButton({ class: 'removes', title: `misfit remove … ${current.id}`, 'data-key': key, disabled: !here.idle }, `Remove ${above}`,
      { question: `Take ${above} off the ladder? What was computed stays in the run folder.`, yes: 'Remove', no: 'Keep' },
      () => start(key, 'remove', { rung: `${current.id}` }))));
  }
  view.append(element('details', {}, element('summary', {}, 'All rungs in numbers'), blocks(ladder.blocks.filter((b) => b.kind !== 'figures'))));
}

async function showCommands(view) {
  const { text } = await get('session');
  view.append(element('p', {}, 'Every click above is a command. They stand in session.sh of the run folder, ', element('code', {}, here.state.study.folder),
    '; sh session.sh does them again.'));
  view.append(text === '' ? element('p', { class: 'soft' }, 'None yet.') : element('pre', { class: 'script', tabindex: 0 }, text));
}

const study = editor({ get, post, look });
const views = { where: showWhere, candidates: showCandidates, curves: showCurves, calibration: showCalibration, ladder: showLadder,
  study: (view) => study.show(view, here.model), commands: showCommands };

let turn = 0, focusedBefore = null;
async function showView() {
  const mine = ++turn;
  writeAddress();
  for (const tab of at('tabs').children) {
    const on = tab.dataset.view === here.tab;
    tab.setAttribute('aria-selected', on);
    tab.tabIndex = on ? 0 : -1;
    if (on) at('tabs').scrollLeft = tab.offsetLeft - 0.5 * (at('tabs').clientWidth - tab.offsetWidth); // where they do not all find room
  }
  const view = element('div');
  const old = here.figures;
  here.figures = [];
  here.samples = null;
  if (here.added) drawForce(null);
  const scroll = scrollY;
  if (at('view').contains(document.activeElement)) focusedBefore = document.activeElement;
  for (const figure of old) figure.destroy();
  at('view').replaceChildren(view);
  at('view').dataset.view = here.tab;
  try {
    await views[here.tab](view);
  } catch (error) {
    if (mine === turn) view.append(element('p', { class: 'warning' }, error.message));
  }
  if (mine !== turn) return;
  scrollTo(0, scroll);
  began.place();
  if (focusedBefore && document.activeElement === document.body) focusAgain(focusedBefore);
  focusedBefore = null;
}

/** On what has the same place in a view that is drawn anew; else on the view. */
function focusAgain(old) {
  const key = ['data-key', 'data-curve', 'data-map', 'data-rung', 'id'].find((name) => old.hasAttribute(name));
  const same = key && at('view').querySelector(`[${key}="${CSS.escape(old.getAttribute(key))}"]`);
  (same && !same.disabled ? same : at('view')).focus({ preventScroll: true });
}

/** Somebody types, or is asked something: the view is not drawn anew under their hands. */
const inHand = () => (here.tab === 'study' && study.changed()) || at('view').querySelector('.asking .yes') !== null;

async function showAll() {
  again = true;
  if (busy) return; // who is at it does it again
  busy = true;
  try {
    while (again) {
      again = false;
      const [where, motion] = await Promise.all([get('where', { model: here.model }), askForMotion()]);
      here.where = where;
      await showMotion(motion);
      mark([], '', true);
      here.late = inHand() && !here.chosen;
      here.chosen = false;
      if (!here.late) await showView();
    }
  } finally {
    busy = false;
  }
}

function choose(model) {
  for (const question of at('view').querySelectorAll('.asking')) question.remove(); // it was about another one
  here.model = model;
  here.chosen = true; // what is typed in the study is kept by the editor
  at('model').value = model;
  showAll().catch(say);
}

/** The study's own text is that of model 0. */
function correct() {
  here.tab = 'study';
  choose(0);
}

/** In one column the view lies below the motion: it is scrolled to. */
function showTab(name, focus = false) {
  here.tab = name;
  showView().then(() => { if (oneColumn.matches && here.tab === name) at('view').scrollIntoView(); }).catch(say);
  if (focus) at('tabs').querySelector('[aria-selected=true]').focus();
}

function begin() {
  readAddress();
  at('work').hidden = !live;
  at('tabs').replaceChildren(...tabs.map(([name, text]) => element('button', { role: 'tab', 'data-view': name, 'aria-controls': 'view', onclick: () => showTab(name) }, text)));
  at('tabs').addEventListener('keydown', (event) => {
    const there = tabs.filter(([name]) => !at('tabs').querySelector(`[data-view=${name}]`).hidden), n = there.length;
    const k = there.findIndex(([name]) => name === here.tab);
    const next = { ArrowRight: (k + 1) % n, ArrowLeft: (k + n - 1) % n, Home: 0, End: n - 1 }[event.key];
    if (next === undefined) return;
    showTab(there[next][0], true);
    event.preventDefault();
  });
  for (const verb of ['run', 'fit', 'discover']) at(verb).addEventListener('click', () => start(verb, verb));
  at('stop').addEventListener('click', stop);
  at('add').addEventListener('click', () => start('add', 'add', { effect: at('effect').value }));
  at('effect').addEventListener('change', () => { at('add').disabled = !here.idle || at('effect').value === ''; });
  at('model').addEventListener('change', (event) => choose(Number(event.target.value)));
  at('method').addEventListener('change', (event) => { here.method = event.target.value; showMotion().catch(say); });
  at('experiment').addEventListener('change', (event) => { chooseExperiment(event.target.value); showMotion().then(showView).catch(say); });
  at('whole').addEventListener('click', () => time.zoom(null));
  at('unmark').addEventListener('click', unmark);
  at('holdout').addEventListener('click', () => start('holdout', 'set', { what: 'validation', name: here.name, value: written(here.fixed[0]) }));
  addEventListener('keydown', (event) => { if (event.key === 'Escape') unmark(); });
  addEventListener('beforeunload', (event) => { if (study.changed()) event.preventDefault(); });
  onScreenChange(() => { drawTime(); showView().catch(say); });
  watch();
}

begin();
