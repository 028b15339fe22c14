// The page of `misfit open`: what the run folder holds, linked by one time cursor, one zoom and one selection. It computes no results.
import { askingButton, blocks, breakable, element, fittedTable, plain, shown, shownPlace, spaced, words } from '/dom.js';
import { PairCells, SamplesByCell, rangeOf } from '/cells.js';
import { Figure, TimeGroup, lowerBound, nearest, onScreenChange } from '/figure.js';
import { Film } from '/film.js';
import { Began, JobBox } from '/job.js';
import { roughnessSlider } from '/slider.js';
import { get, kept, live, outdate, post, Unreachable } from '/server.js';
import { editor } from '/editor.js';

const at = (id) => document.getElementById(id);
const time = new TimeGroup();
const narrow = matchMedia('(max-width: 62rem)'); // as in page.css: map and motion below each other
const tabs = [['where', 'Where it fails'], ['candidates', 'What could be missing'], ['curves', 'Curves, parameters'], ['calibration', 'Calibration'],
  ['ladder', 'Ladder'], ['study', 'Study'], ...(live ? [['commands', 'Commands']] : [])];

/** Marked times: of samples `times`, each with its surroundings in `intervals`; or intervals alone. */
const nothingMarked = { intervals: [], times: [], text: '' };

/** What is shown. The address keeps model and tab, so that a reload finds them again; without them it is the last model, of which the verdict speaks. */
const here = { state: null, model: 0, tab: null /* that of the verdict */, method: null, name: undefined, motion: null, where: null, map: null, figures: [], timeFigures: [], force: null, fixed: nothingMarked, late: false, chosen: false,
  added: null, // the candidate whose force stands in the plot: { name, figure, of: the missing force beside it }
  candidate: null, // the name of the one whose button keeps it there
  picked: null, // the cell that stays marked: { map, cells, boxes }
  zooms: new Map(), // of figures of the views, by their names
  open: new Set(), // what is unfolded
  allCandidates: false };

function readAddress() {
  const parts = new URLSearchParams(location.hash.slice(1));
  here.model = /^\d+$/.test(parts.get('model') ?? '') ? Number(parts.get('model')) : Infinity;
  here.tab = tabs.some(([name]) => name === parts.get('view')) ? parts.get('view') : null;
}
function writeAddress() {
  if (document.body.dataset.exploring === 'false') return; // the address is that of a section of report.html
  history.replaceState(null, '', `${location.search}#view=${here.tab}&model=${here.model}`);
}

function say(error) {
  at('alerts').append(element('p', { class: 'warning' }, String(error?.message ?? error)));
}

// ---- state and jobs

let version = null;

/** Asks what there is; shows what has changed. */
async function look() {
  const state = await get('state');
  const job = state.job, before = here.state?.job;
  const changed = job.number !== before?.number || job.state !== before?.state;
  here.state = state;
  here.tab ??= state.verdict?.opens ?? 'where';
  showJob(job);
  if (state.version !== version || (changed && before?.state === 'running')) {
    const grown = here.models !== undefined && state.models.length > here.models;
    here.models = state.models.length;
    if ((grown && !inHand()) || here.model >= state.models.length) here.model = state.models.length - 1;
    outdate();
    showHead();
    await showAll();
    version = state.version; // now that it is seen
  } else if (here.late || (changed && here.tab === 'commands')) await refreshView();
  return job.state === 'running';
}

/** What hinders looking, said once, as long as it does. */
const trouble = element('p', { class: 'warning' });
function hindered(error) {
  const lost = error instanceof Unreachable;
  if (lost) document.body.dataset.lost = 'yes';
  const text = lost ? 'misfit does not answer any more: start “misfit open” again and use the address that it prints.' : String(error?.message ?? error);
  if (trouble.textContent !== text) trouble.textContent = text;
  if (!trouble.isConnected) at('alerts').append(trouble);
}
function unhindered() {
  delete document.body.dataset.lost;
  trouble.remove();
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
      if (document.body.dataset.lost) await showAll(); // what was asked for meanwhile
      unhindered();
    } catch (error) {
      hindered(error);
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
  const most = here.state.mostSamples ?? 0; // of the report; 0: all
  at('thinned').hidden = most === 0;
  at('thinned').textContent = `Recordings of more than ${most} samples are drawn by their least and largest values; “misfit open” draws every sample.`;
  if (!verdict) alerts.append(element('p', {}, 'There are no results yet: Run makes them.'));
  showVerdict(verdict?.blocks ?? []);
  at('model').replaceChildren(...models.map((m, k) => element('option', { value: k }, m.added === '' ? "0: the study's own" : `${m.id}: + ${m.added}`)));
  at('model').value = here.model;
  addedTo = modelsSeen();
  const chosen = at('effect').value;
  const refused = effects.filter((one) => one.refused !== '');
  at('effect').replaceChildren(element('option', { value: '' }, 'an effect…'),
    ...effects.filter((one) => one.refused === '').map(({ effect, formula }) => element('option', { value: effect, title: formula }, cut(`${spaced(effect)}: ${formula}`))),
    refused.length === 0 ? '' : element('optgroup', { label: 'Not for this model, at their usual place' },
      ...refused.map(({ effect, refused: why }) => element('option', { value: effect, disabled: true, title: why }, cut(`${spaced(effect)}: ${reason(why)}`)))));
  if (chosen) at('effect').value = chosen;
  showFormula();
}

/** By the effects that were added: what is added or removed is refused where another page has changed them meanwhile. */
const modelsSeen = () => here.state.models.map((model) => model.added);
let addedTo = [];

/** On a narrow screen the sentence and what is next, so that the map is on the first one; the rest opens. */
function showVerdict(all) {
  const first = all.filter((b) => b.tone === 'lead' || b.tone === 'command'), rest = all.filter((b) => b.kind !== 'heading' && !first.includes(b));
  const open = at('verdict').querySelector('details')?.open ?? !narrow.matches;
  const more = element('details', { open }, element('summary', {}, 'Where it fails, estimates, errors'), element('div', { class: 'facts' }, blocks(rest)));
  at('verdict').replaceChildren(blocks(first.filter((b) => b.tone === 'lead')), rest.length > 0 ? more : '', blocks(first.filter((b) => b.tone !== 'lead')));
}
narrow.addEventListener('change', () => { if (!narrow.matches) at('verdict').querySelector('details')?.setAttribute('open', ''); });

/** What misfit says against an effect, in a reader's words; the whole sentence is the title. */
function reason(why) {
  const said = why.replace(/^effect '[^']*' (is )?/, '').replace(/^does not suit this model: (effect '[^']*': )?/, '').replace(/ \(.*\)$/, '');
  const [, kind, lacks] = /has no (port|quantity) '([^']*)'/.exec(said) ?? [];
  if (kind === 'port') return `acts on ${spaced(lacks)}, which this model does not have`;
  if (kind) return `needs to be told its ${spaced(lacks)}: misfit add … --at ${lacks}=NAME`;
  if (/^role '[^']*' needs \[/.test(said)) return 'acts on another unit than this model has there';
  return said;
}
const cut = (text) => (text.length > 90 ? `${text.slice(0, 88)}…` : text);

/** What the chosen effect adds to the model. */
function showFormula() {
  const formula = here.state.effects.find((one) => one.effect === at('effect').value)?.formula;
  at('formula').hidden = !formula;
  at('formula').textContent = formula ? `${spaced(at('effect').value)}: ${formula}` : '';
}

function showJob(job) {
  const running = job.state === 'running', focused = document.activeElement;
  const idle = (here.idle = !running && here.state.study.fault === null);
  for (const id of ['run', 'fit', 'discover']) at(id).disabled = !idle;
  at('add').disabled = !idle || at('effect').value === '';
  for (const button of document.querySelectorAll('button.adds, button.removes, button.sets')) button.disabled = !idle;
  at('stop').hidden = !running;
  at('stop').textContent = job.stopping ? 'Stop at once' : 'Stop';
  began.follow(job);
  jobBox.show(job);
  if (focused === document.body || !(focused.disabled || focused.hidden)) return;
  if (began.owns(job)) began.takeFocus(running);
  else at('job').focus({ preventScroll: true }); // another page's: a key pressed here must not stop it
}


const jobBox = new JobBox(), began = new Began({ stop, say });

async function stop(event) {
  if (event.detail === 0 && performance.now() - began.at < 500) return; // by a key: the Enter that began it, pressed twice
  try {
    await post('stop');
    await look();
  } catch (error) {
    began.refused(error);
  }
}

// `key`: of the button; `more`: what the verb needs: { effect, at, models } to add, { rung, models } to remove.
async function start(key, verb, more = {}) {
  began.asked(key);
  try {
    began.answered(await post('job', { verb, ...more }));
    await look();
  } catch (error) {
    began.refused(error);
  }
}

// ---- over time

/** By the method that was chosen, by its name; of the last one until then, and where the model has none of that name. */
const askForMotion = () => kept('motion', { model: here.model, ...(here.method === null ? {} : { method: here.method }) });

/** Of the method that was chosen; an answer that comes late is passed over. */
let motionTurn = 0;
async function showMotion() {
  const mine = ++motionTurn, motion = await askForMotion();
  if (mine === motionTurn) takeMotion(motion);
}

function takeMotion(motion) {
  here.motion = motion;
  at('methods').hidden = motion.methods.length === 0;
  at('method').replaceChildren(...motion.methods.map((name) => element('option', { value: name }, name)));
  at('method').value = motion.methods[motion.method];
  const names = [...new Set([...motion.channels.map((c) => c.experiment), ...(here.where?.force ?? []).map((f) => f.experiment), ...here.state.films])];
  chooseExperiment(names.includes(here.name) ? here.name : names[0]);
  at('experiments').hidden = names.length < 2;
  at('experiment').replaceChildren(...names.map((name) => element('option', { value: name }, name)));
  at('experiment').value = here.name;
  for (const c of motion.channels) heldOut.set(`${here.model} ${c.experiment}`, c.heldOut);
  showTime();
}

/** Intervals of the experiment that is shown: known from a method that predicts the motion, the same of all. */
const heldOut = new Map();
const heldOutHere = () => heldOut.get(`${here.model} ${here.name}`) ?? [];

/** Marks and zoom are of one recording: they do not go with the choice of another one. */
function chooseExperiment(name) {
  if (name === here.name) return;
  here.name = name;
  film.t = null;
  time.zoom(null);
  unmark();
}

const channelsShown = () => here.motion.channels.filter((c) => c.experiment === here.name);

/** Plots that show the same as before stay as they are. */
let timeDrawn = [];
function showTime() {
  film.show(channelsShown(), here.state.films.indexOf(here.name), here.motion.methods[here.motion.method]);
  const what = [here.motion, missing(), here.name];
  if (what.some((one, k) => one !== timeDrawn[k])) drawTime();
  timeDrawn = what;
}

/** Plots over time are drawn anew: the cursor stays where it is, the focus in its panel. */
function drawnAnew(draw) {
  const focused = document.activeElement?.closest('#time [data-plot]')?.dataset.plot, cursor = time.cursor();
  draw();
  if (cursor !== null) time.putBack(cursor);
  if (focused) at('time').querySelector(`[data-plot="${CSS.escape(focused)}"]`)?.focus({ preventScroll: true });
}

function drawTime() {
  drawnAnew(() => {
    for (const figure of here.timeFigures.splice(0)) figure.destroy();
    here.force = null;
    time.heldOut = heldOutHere();
    const channels = channelsShown(), options = { group: time, title: false, caption: false, height: channels.length > 1 ? 0.45 : 0.7 };
    at('motion').replaceChildren();
    channels.forEach((c, k) => here.timeFigures.push(new Figure(at('motion'), c.figure, { ...options, key: `motion ${k}`, xLabel: k === channels.length - 1 })));
    if (channels.length === 0) at('motion').append(element('p', { class: 'soft' },
      here.motion.methods.length === 0 ? 'Nothing is fitted yet.' : 'This method does not predict the motion.'), blocks(here.motion.blocks));
    putForce(here.added?.of === missing() ? here.added : null);
  });
}

/** The missing force of the experiment that is shown, and its place among those of all. */
const missing = () => here.where?.force.find((f) => f.experiment === here.name);
const placeOfMissing = () => here.where.force.indexOf(missing());

const drawForce = (added) => drawnAnew(() => putForce(added));

/** One scale for the missing force and all candidates beside it that are looked at. */
const forceScales = { of: null, scales: null };
function scalesOf(force) {
  if (forceScales.of !== force) Object.assign(forceScales, { of: force, scales: new Map() });
  return forceScales.scales;
}

/** `added`: of a candidate, whose force stands in it, too (here.added). What is there goes when the new one stands: nothing jumps. */
function putForce(added) {
  const before = [...at('force').children], old = here.force, force = missing();
  here.added = added;
  here.force = null;
  if (force) {
    at('force').append(element('h3', {}, added ? `Force that is missing, ± 1 sigma, and (thick) what ${spaced(added.name)} adds` : 'Force that is missing, ± 1 sigma'));
    here.force = new Figure(at('force'), added?.figure ?? force.figure, { group: time, title: false, caption: false, height: 0.5, key: 'force', scales: scalesOf(force) });
    here.timeFigures.push(here.force);
  }
  if (old) here.timeFigures.splice(here.timeFigures.indexOf(old), 1)[0].destroy();
  for (const node of before) node.remove();
}

const film = new Film(timeShown);
time.oncursor = (t) => film.point(t);

/** `fixed`: it stays when the mouse goes on. Nothing, and not fixed: what is fixed is seen again. */
function mark(marked, fixed) {
  if (fixed) {
    here.fixed = marked;
    time.begun = undefined;
  }
  const seen = marked.intervals.length > 0 || fixed ? marked : here.fixed;
  time.setMarks(seen.intervals);
  film.mark(seen);
  at('marked').textContent = at('marked').title = seen.text;
  at('time').dataset.marks = seen.intervals.length;
  offerWithMarks();
  markPoints();
}
function offerWithMarks() {
  const { intervals } = here.fixed;
  at('unmark').hidden = intervals.length === 0;
  at('holdout').hidden = !live || intervals.length !== 1 || here.model !== 0 || !here.state.settable.experiments.includes(here.name);
}
function unmark() {
  for (const figure of here.figures) {
    if (!figure.fixedCells && !figure.fixedBoxes) continue;
    figure.cells = figure.boxes = figure.fixedCells = figure.fixedBoxes = undefined;
    figure.highlight();
  }
  here.picked = null;
  mark(nothingMarked, true);
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
time.onmark = ([[from, to]]) => mark({ intervals: [[from, to]], times: [], text: `Marked: ${endsShown(from, to)} s` }, true);

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

/** As it was zoomed before, in this model or another. */
function draw(parent, figure, options = {}) {
  const { name } = figure, zoom = here.zooms.get(name);
  const out = new Figure(parent, figure, { ...options, onzoom: (window) => (window ? here.zooms.set(name, window) : here.zooms.delete(name)) });
  here.figures.push(out);
  if (zoom && out.reaches(zoom)) out.zoom(zoom);
  return out;
}

/** Something to unfold, which is found unfolded again where the view is drawn anew. */
function folded(summary, content, properties = {}) {
  const key = `${here.tab} ${summary}`, out = element('details', { ...properties, open: here.open.has(key) }, element('summary', { 'data-fold': key }, summary), content);
  out.addEventListener('toggle', () => (out.open ? here.open.add(key) : here.open.delete(key)));
  return out;
}
const nothing = (parent, ...text) => parent.append(element('p', { class: 'soft' }, ...text));
/** There is no such result: the motion gets the width of the page. In a document, which has no buttons, a command says how it is made. */
function absent(view, byButton, command) {
  at('main').dataset.alone = 'yes';
  if (live) nothing(view, byButton);
  else nothing(view, byButton.split(': ')[0], ': ', element('code', {}, command));
}
/** As commands name the study, in the verdict. */
const studyNamed = () => /^next: misfit \w+ ('[^']*'|\S+)/.exec((here.state.verdict?.blocks ?? []).map((b) => plain(b.text ?? '')).find((text) => text.startsWith('next: ')) ?? '')?.[1] ?? 'STUDY';

/** Of a quantity that a map is over, in the order of their times; null: this experiment has none. */
async function samplesOf(quantity) {
  const force = here.where.force, experiment = force.findIndex((f) => f.experiment === here.name);
  const k = force[experiment]?.quantities.findIndex((q) => q.name === quantity) ?? -1;
  return k < 0 ? null : kept('samples', { model: here.model, experiment, quantity: k });
}

async function showWhere(view, where, current) {
  if (!where) return absent(view, 'This model is not diagnosed yet: Discover does it; Run does it only if filter_error is among the methods of the study.', `misfit discover ${studyNamed()}`);
  const conclusions = where.blocks.find((b) => b.kind === 'list');
  const least = (map) => Math.min(map.p ?? 2, map.pBefore ?? 2); // the most significant first, now or before; without a p last
  const all = [...where.maps, ...where.pairs].sort((a, b) => least(a) - least(b));
  const significance = ({ p, pBefore }) => (pBefore < 0.01 && pBefore !== null ? `p = ${shown(pBefore, 2)} before, ${shown(p, 2)} now` : `p = ${shown(p, 2)}`);
  const list = element('div', { class: 'list', role: 'group', 'aria-label': 'Maps of the missing force' });
  const body = element('div'), below = element('div');
  const buttons = all.map((map, k) => element('button', { 'aria-pressed': 'false', 'data-map': map.figure.name, onclick: () => show(k) }, words(spaced(map.portLabel)), ' against ',
    words(spaced(map.label ?? map.xLabel)), map.yLabel ? ' and ' : '', map.yLabel ? words(spaced(map.yLabel)) : '', ' ', element('small', {}, significance(map))));
  list.append(...buttons);
  if (where.ahead) draw(view, where.ahead, { height: 0.8 });
  view.append(body, conclusions ? blocks([conclusions]) : '', all.length > 1 ? element('h3', {}, 'Missing force against…') : '', all.length > 1 ? list : '', below);
  const tests = element('div'), more = folded('Tests of the residuals', tests);
  more.addEventListener('toggle', () => {
    if (!more.open || tests.hasChildNodes() || !current()) return;
    for (const figure of where.whiteness) draw(tests, figure);
    tests.append(blocks(where.blocks.filter((b) => b !== conclusions && b.kind !== 'figures')));
  });
  view.append(more);
  let turn = 0;
  async function show(k) {
    const mine = ++turn, still = () => mine === turn && current();
    here.map = all[k].figure.name;
    buttons.forEach((b, n) => b.setAttribute('aria-pressed', n === k));
    for (const figure of here.figures.splice(0)) if (body.contains(figure.node) || below.contains(figure.node)) figure.destroy(); else here.figures.push(figure);
    here.samples = null;
    body.style.minHeight = `${body.offsetHeight}px`; // the list stays where it is until the map stands
    body.replaceChildren();
    below.replaceChildren();
    await (where.maps.includes(all[k]) ? showMap : showPair)(body, all[k], still, below);
    if (still()) body.style.minHeight = '';
  }
  const before = all.findIndex((map) => map.figure.name === here.map);
  if (all.length > 0) await show(Math.max(before, 0));
}

/** Why pointing at a map marks nothing; '': it does. */
function withoutSamples(asked) {
  const failed = asked.find((one) => one.status === 'rejected');
  if (!live) return failed ? 'Which samples lie there “misfit open” shows, in the motion.' : '';
  if (failed) return `Its samples cannot be shown: ${failed.reason.message}`;
  return asked.every((one) => one.value === null) ? 'This experiment has no samples of it.' : '';
}

/** Pointing at a cell of a map marks its samples; a click, or a key, keeps them marked. `cellAt(x, y)`: undefined: there is none; `emphasised(cell)`:
    what stands out in the figure; `said(cell, count)`: in words. */
function pointing(map, samples, { cellAt, emphasised, said }) {
  let hot;
  const emphasise = (view, what) => {
    Object.assign(view, what);
    view.highlight();
  };
  const choose = (view, x, y, fixed) => {
    const cell = cellAt(x, y);
    if (cell === undefined || (cell === hot && !fixed)) return;
    hot = cell;
    const what = emphasised(cell);
    emphasise(view, what);
    if (fixed) {
      view.fixedCells = what.cells;
      view.fixedBoxes = what.boxes;
    }
    const { times, intervals } = samples?.at(cell) ?? nothingMarked;
    if (samples) mark({ times, intervals, text: said(cell, times.length) }, fixed);
    if (fixed) here.picked = { map: map.figure.name, ...what };
  };
  const fixed = (plot, x, y) => choose(plot.view, x, y, true);
  return { onpoint: (plot, x, y) => choose(plot.view, x, y, false), onpick: fixed, onkeypoint: fixed,
    onleave: (plot) => {
      hot = undefined;
      emphasise(plot.view, { cells: plot.view.fixedCells, boxes: plot.view.fixedBoxes });
      mark(nothingMarked, false);
    } };
}

/** The cell that is marked already, in a map that is drawn anew. */
function emphasisePicked(figure, map) {
  if (here.picked?.map !== map.figure.name) return;
  const { cells, boxes } = here.picked;
  Object.assign(figure, { cells, boxes, fixedCells: cells, fixedBoxes: boxes });
  figure.highlight();
}

async function showMap(body, map, current, below) {
  const asked = await Promise.allSettled(map.quantity === 'time' ? [] : [samplesOf(map.quantity)]);
  if (!current()) return;
  const samples = asked[0]?.value ?? null;
  const places = map.figure.xs[map.figure.panels[0].series.find((s) => s.style === 'error_bars').x], n = places.length;
  const edges = places.map((place, k) => (k === 0 ? place - 0.5 * (places[1] - place) : 0.5 * (places[k - 1] + place)));
  edges.push(places[n - 1] + 0.5 * (places[n - 1] - places[n - 2]));
  const t = samples?.t ?? here.timeFigures.at(-1)?.figure.xs[0] ?? [], values = samples?.values ?? t, unit = plain(map.figure.xUnit);
  const byCell = samples || map.quantity === 'time' ? new SamplesByCell(t, (i) => rangeOf(edges, values[i])) : null;
  const overTime = map.quantity === 'time' && here.where.force.length === 1 ? { heldOut: heldOutHere() } : {};
  const figure = draw(body, map.change ?? map.figure, { height: 0.8, ...overTime, ...pointing(map, byCell, {
    cellAt: (x) => nearest(places, x),
    emphasised: (k) => ({ cells: [[edges[k], edges[k + 1]]] }),
    said: (k, count) => `Marked: ${count} samples with ${map.quantity} from ${endsShown(edges[k], edges[k + 1])} ${unit}` }) });
  emphasisePicked(figure, map);
  figure.node.append(element('p', { class: 'soft' }, byCell
    ? 'Point at a place: its samples are marked in the motion. A click keeps them marked.' : withoutSamples(asked)));
  if (samples) {
    here.samples = { t: samples.t, figure: draw(below, samples.figure, { height: 0.7 }) };
    markPoints();
  }
}

async function showPair(body, map, current) {
  const asked = await Promise.allSettled([samplesOf(map.x), samplesOf(map.y)]);
  if (!current()) return;
  const [first, second] = asked.map((one) => one.value ?? null);
  const timeOf = (name, other) => (name === 'time' && other ? { t: other.t, values: other.t } : null); // a sample's own
  const x = first ?? timeOf(map.x, second), y = second ?? timeOf(map.y, first);
  const most = Math.max(...[map.figure, map.before].map((f) => f?.zMost ?? 0));
  const cells = new PairCells(map.figure), now = { ...map.figure, title: `Now: ${plain(map.figure.title)}` };
  const byCell = x && y ? new SamplesByCell(x.t, (i) => (x.values[i] === null || y.values[i] === null ? undefined : cells.at(x.values[i], y.values[i]))) : null;
  const figure = draw(body, map.before ? now : map.figure, { height: map.before ? 0.6 : 0.9, most, ...pointing(map, byCell, {
    cellAt: (px, py) => cells.at(px, py),
    emphasised: (k) => ({ boxes: [cells.boxes[k]] }),
    said: (k, count) => {
      const box = cells.boxes[k];
      return `Marked: ${count} samples, force ${shown(cells.z[k], 2)} sigma, with ${map.x} from ${endsShown(box[0], box[1])} ${plain(map.figure.xUnit)} and ${map.y} from ` +
        `${endsShown(box[2], box[3])} ${plain(map.figure.panels[0].unit)}`;
    } }) });
  emphasisePicked(figure, map);
  if (!byCell) figure.node.append(element('p', { class: 'soft' }, withoutSamples(asked)));
  if (map.before) draw(body, { ...map.before, name: `${map.before.name}_before`, title: `Before ${spaced(here.state.models[here.model].added)}: ${plain(map.before.title)}` }, { height: 0.6, most, caption: false });
}

function showCandidates(view, found) {
  if (!found) return absent(view, 'Nobody has asked yet which effect is missing: Discover ranks them.', `misfit discover ${studyNamed()}`);
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
  view.append(folded('Remarks, reasons and what was tried', blocks(rest)));
}

/** Of a force or an error that no named effect describes: it can stay in the model as a curve of a quantity. */
function asCurve(unknown) {
  const models = modelsSeen();
  const button = (one) => element('button', { class: 'adds', 'data-effect': one.effect, 'data-key': `add ${one.name}`, disabled: !here.idle,
    title: `misfit add … ${[one.effect, ...one.at].join(' --at=')}`,
    onclick: () => start(`add ${one.name}`, 'add', { effect: one.effect, at: one.at, models }) }, `Add ${one.name}`);
  return element('p', { class: 'unknown' }, 'No effect of the list describes it. Added as a curve of one quantity, it takes over what no formula does: ',
    ...unknown.map(button));
}

/** Pointing at a candidate shows the force that it adds beside the missing one; its button keeps it there. */
class AddedForces {
  kept = null;
  turn = 0;
  offer(line, cell, row) {
    const button = element('button', { class: 'shows', 'aria-pressed': 'false', 'data-candidate': row.name, title: 'Show over time the force that it adds' }, ...cell.childNodes);
    cell.replaceChildren(button);
    const own = { button, name: row.name, candidate: row.candidate };
    line.addEventListener('mouseenter', () => this.show(own));
    line.addEventListener('mouseleave', () => this.show(this.kept));
    button.addEventListener('click', () => this.keep(this.kept === own ? null : own));
    if (row.name === here.candidate) this.keep(own);
  }
  keep(own) {
    this.kept?.button.setAttribute('aria-pressed', 'false');
    own?.button.setAttribute('aria-pressed', 'true');
    this.kept = own;
    here.candidate = own?.name ?? null;
    this.show(own);
  }
  async show(own) {
    const mine = ++this.turn, of = missing();
    const figure = own && of ? await kept('added', { model: here.model, experiment: placeOfMissing(), candidate: own.candidate }).catch(() => null) : null;
    const shown = of === missing() && here.tab === 'candidates' && own?.button.isConnected !== false;
    if (mine === this.turn && shown && (figure || here.added)) drawForce(figure ? { name: own.name, figure, of } : null);
  }
}

function candidateTable(table, rows, last) {
  const most = 12, models = modelsSeen(); // rows to begin with
  const heading = (n) => plain(table.columns[n].heading), empty = (n) => table.rows.every((row) => plain(row[n]) === '–');
  const columns = table.columns.map((_, n) => n).filter((n) => !['rank', 'accepted'].includes(heading(n)) && !empty(n));
  const side = (n) => (table.columns[n].right ? 'number' : null);
  const head = element('tr', {}, element('td'), ...columns.map((n) => element('th', { scope: 'col', class: side(n) }, words(table.columns[n].heading))));
  const body = element('tbody'), added = new AddedForces();
  rows.forEach((row, k) => {
    const button = live && row.addable && last
      ? element('button', { class: 'adds' + (row.accepted ? ' main' : ''), 'data-effect': row.effect, 'data-key': `add ${row.name}`,
          title: `misfit add … ${[row.effect, ...row.at].join(' --at=')}`, disabled: !here.idle,
          onclick: () => start(`add ${row.name}`, 'add', { effect: row.effect, at: row.at, models }) }, 'Add') : '';
    const more = k >= most ? ' more' : '';
    const line = element('tr', { class: (row.accepted ? 'accepted ' : '') + 'of-why' + more }, element('td', {}, button),
      ...columns.map((n) => element('td', { class: side(n), 'data-label': heading(n) === 'effect' ? null : heading(n) }, breakable(table.rows[k][n]))));
    if (row.force) added.offer(line, line.children[1], row);
    if (plain(row.why) === '') line.classList.remove('of-why');
    body.append(line, plain(row.why) === '' ? '' : element('tr', { class: 'why' + more }, element('td'), element('td', { colspan: columns.length }, words(row.why))));
  });
  const all = element('table', { id: 'candidates', class: here.allCandidates && 'all' }, element('thead', {}, head), body);
  const showRest = () => {
    here.allCandidates = true;
    all.classList.add('all');
    rest.remove();
  };
  const rest = rows.length > most && !here.allCandidates ? element('button', { onclick: showRest }, `All ${rows.length}`) : null;
  if (here.added && !added.kept) drawForce(null); // it is of a list that is not there any more
  return element('div', {}, fittedTable(all), rest);
}

function showCurves(view, curves) {
  if (curves.figures.length === 0) nothing(view, 'This model has no curves; its parameters:');
  const figures = curves.figures.map((figure) => draw(view, figure, { height: 0.8 }));
  const own = live && here.model === 0 && here.state.study.fault === null;
  const set = (name, key) => (own && here.state.settable.curves.some((c) => c.name === name)
    ? (value) => start(key, 'set', { what: 'roughness', name, value }) : undefined);
  figures.forEach((figure, k) => roughnessSlider(curves.roughness.filter((path) => path.curves[0].figure === k), figures, figure.node, { set, idle: here.idle }));
  view.append(blocks(curves.blocks));
  if (!live) return;
  if (here.model !== 0) nothing(view, "Parameters are fixed and roughness is set with the study's own model (rung 0).");
  else if (here.state.study.fault === null) view.append(settings(curves.estimates));
}

/** What of the study's own model is estimated and how; each change is `misfit set`, the results are made anew by Run. */
function settings(estimates) {
  const set = (what, name, value) => start(`${what} ${name}`, 'set', { what, name, value });
  const rows = here.state.settable.parameters.map(({ name, label, unit, free, value }) => element('tr', {}, element('td', {}, words(label), ' [', words(unit), ']'),
    element('td', { class: 'number' }, words(estimates?.values[name] ?? (free ? '' : value))),
    element('td', {}, free ? 'estimated' : 'fixed'), element('td', {}, element('button', { class: 'sets', 'data-parameter': name, 'data-key': `free ${name}`, disabled: !here.idle,
      onclick: () => set('free', name, `${!free}`) }, free ? 'Fix' : 'Estimate'))));
  for (const { name, label, unit, roughness } of here.state.settable.curves) {
    const box = element('input', { value: roughness, size: 12, 'aria-label': `roughness of ${name}`, 'data-box': name, oninput: () => box.toggleAttribute('data-changed', box.value !== roughness) });
    const setIt = () => {
      box.removeAttribute('data-changed');
      set('roughness', name, box.value.trim());
    };
    rows.push(element('tr', {}, element('td', {}, 'roughness of ', words(label), ' [', words(unit), '], larger: smoother'), element('td', { colspan: 2 }, box), element('td', {},
      element('button', { class: 'sets', 'data-roughness': name, 'data-key': `roughness ${name}`, title: 'auto, or a number of at least 0', disabled: !here.idle,
        onclick: setIt }, 'Set'))));
  }
  const heading = (text, side) => element('th', { scope: 'col', class: side }, text);
  const head = element('thead', {}, element('tr', {}, heading('parameter'), heading(estimates ? `value ± sigma, by ${spaced(estimates.method)}` : 'value', 'number'), heading('is'), element('td')));
  const content = element('div', {}, fittedTable(element('table', {}, head, element('tbody', {}, ...rows))),
    element('p', { class: 'soft' }, 'A change is written into the study; Run makes the results anew.'));
  return folded('Fix or estimate a parameter, change a roughness', content, { id: 'settings' });
}

function showCalibration(view, calibration) {
  if (!calibration) return absent(view, 'This study has no calibrated camera: one is declared in its text.', '[camera]');
  const evidence = here.state.verdict?.opens === 'calibration', [points, residuals] = calibration.figures; // the verdict is about them
  if (evidence) draw(view, residuals);
  view.append(blocks(calibration.blocks.filter((b) => b.kind !== 'heading' || b.level !== 1), { figures: (name, parent) => (evidence ? [points] : calibration.figures).forEach((f) => draw(parent, f)) }));
}

function showLadder(view, ladder) {
  if (!ladder) return absent(view, 'The ladder begins when an effect is added: each added effect is a rung.', `misfit add ${studyNamed()} EFFECT`);
  const choice = element('div', { class: 'rungs', role: 'group', 'aria-label': 'Rungs' }, ...ladder.rungs.map((rung) => {
    const k = here.state.models.findIndex((m) => m.id === rung.id);
    return element('button', { 'aria-pressed': `${k === here.model}`, 'data-rung': rung.id, disabled: k < 0, onclick: () => choose(k) }, `${rung.id}: ${rung.added === '' ? rung.system : `+ ${rung.added}`}`);
  }));
  view.append(element('p', { class: 'soft' }, 'A click shows the results of that model everywhere on this page.'), choice);
  draw(view, ladder.figure, { height: 0.75 });
  const current = ladder.rungs.find((rung) => rung.id === here.state.models[here.model].id), last = ladder.rungs[ladder.rungs.length - 1];
  if (current) view.append(element('h3', {}, `Rung ${current.id}`), blocks(current.blocks));
  if (live && current && current.added !== '') {
    const above = last === current ? 'this rung' : 'this rung and those above it', key = `remove ${current.id}`, models = modelsSeen();
    view.append(element('p', {}, askingButton({ class: 'removes', title: `misfit remove … ${current.id}`, 'data-key': key, disabled: !here.idle }, `Remove ${above}`,
      { question: `Take ${above} off the ladder? What was computed stays in the run folder.`, yes: 'Remove', no: 'Keep' },
      () => start(key, 'remove', { rung: `${current.id}`, models }))));
  }
  view.append(folded('All rungs in numbers', blocks(ladder.blocks.filter((b) => b.kind !== 'figures'))));
}

function showCommands(view, text) {
  view.append(element('p', {}, 'Every click above is a command. They stand in session.sh of the run folder, ', element('code', {}, here.state.study.folder),
    '; sh session.sh does them again.'));
  view.append(text === '' ? element('p', { class: 'soft' }, 'None yet.') : element('pre', { class: 'script', tabindex: 0 }, text));
}

const study = editor({ get, kept, post, look });
const ofModel = (what) => () => kept(what, { model: here.model });
/** `ask`: for what the view is drawn from. */
const views = {
  where: { ask: () => here.where, show: showWhere },
  candidates: { ask: ofModel('candidates'), show: showCandidates },
  curves: { ask: ofModel('curves'), show: showCurves },
  calibration: { ask: () => kept('calibration'), show: showCalibration },
  ladder: { ask: () => kept('ladder'), show: showLadder },
  study: { ask: () => study.ask(here.model), show: (view, fresh) => study.show(view, fresh) },
  commands: { ask: async () => (await get('session')).text, show: showCommands },
};
/** What every view is drawn from besides. */
const surroundings = () => JSON.stringify([here.tab, here.model, here.name, here.state.models, here.state.settable, here.state.study.fault]);

let turn = 0;
let drawn = null; // { answer, surroundings } of the view that is seen
const isDrawn = (answer) => drawn !== null && drawn.answer === answer && drawn.surroundings === surroundings();

async function showView() {
  const mine = ++turn, current = () => mine === turn, { ask, show } = views[here.tab];
  writeAddress();
  showTabs();
  setLate(false);
  let answer = null, refused = null;
  try {
    answer = await ask();
  } catch (error) {
    refused = error;
  }
  if (!current()) return;
  const view = element('div'), back = emptied(view);
  try {
    if (refused) throw refused;
    drawn = { answer, surroundings: surroundings() };
    await show(view, answer, current);
  } catch (error) {
    drawn = null;
    if (current()) view.append(element('p', { class: 'warning' }, error.message));
  }
  if (!current()) return;
  began.place();
  back();
}

function showTabs() {
  for (const tab of at('tabs').children) {
    const on = tab.dataset.view === here.tab;
    tab.setAttribute('aria-selected', on);
    tab.tabIndex = on ? 0 : -1;
  }
  at('view').setAttribute('aria-labelledby', `tab-${here.tab}`);
}

/** Puts an empty view in the place of what was there; what is given back puts scroll and focus back when it is filled. */
let focusedBefore = null;
function emptied(view) {
  if (here.tab !== 'candidates') {
    here.candidate = null;
    if (here.added) drawForce(null);
  }
  const scroll = scrollY;
  if (at('view').contains(document.activeElement)) focusedBefore = document.activeElement;
  for (const figure of here.figures.splice(0)) figure.destroy();
  here.samples = null;
  delete at('main').dataset.alone;
  at('view').replaceChildren(view);
  at('view').dataset.view = here.tab;
  const begun = scrollY;
  return () => {
    if (scrollY === begun) scrollTo(0, scroll); // else somebody has scrolled meanwhile
    if (focusedBefore && document.activeElement === document.body) focusAgain(focusedBefore);
    focusedBefore = null;
  };
}

/** On what has the same place in a view that is drawn anew; else on the view. */
function focusAgain(old) {
  const key = ['data-key', 'data-curve', 'data-map', 'data-rung', 'data-plot', 'data-fold', 'data-candidate', 'data-box', 'id'].find((name) => old.hasAttribute(name));
  const same = key && at('view').querySelector(`[${key}="${CSS.escape(old.getAttribute(key))}"]`);
  (same && !same.disabled ? same : at('view')).focus({ preventScroll: true });
}

/** Somebody types, has moved a slider, or is asked something: the view is not drawn anew under their hands. */
function inHand() {
  const focused = document.activeElement, view = at('view');
  return (here.tab === 'study' && study.changed()) || view.querySelector('.asking .yes, [data-changed]') !== null || (view.contains(focused) && focused.matches('input'));
}

/** Something newer could be shown than what somebody has in hand. */
function setLate(late) {
  here.late = late;
  at('newer').hidden = !late || here.tab === 'study';
}

/** The view again, if what it is drawn from has changed. */
async function refreshView() {
  const mine = turn, answer = await views[here.tab].ask();
  if (mine !== turn) return;
  const held = inHand() && !here.chosen;
  here.chosen = false;
  if (held && here.tab === 'study') study.compare(answer);
  if (isDrawn(answer) || held) setLate(!isDrawn(answer));
  else await showView();
}

let refreshing = null, again = false;
/** Once at a time: who is at it does it again. */
function showAll() {
  again = true;
  return (refreshing ??= refresh());
}
async function refresh() {
  try {
    while (again) {
      again = false;
      const mine = ++motionTurn, [where, motion] = await Promise.all([kept('where', { model: here.model }), askForMotion()]);
      if (again) continue;
      here.where = where;
      takeMotion(mine === motionTurn ? motion : here.motion);
      offerWithMarks();
      await refreshView();
    }
  } finally {
    refreshing = null;
  }
}

function choose(model) {
  for (const question of at('view').querySelectorAll('.asking')) question.remove(); // it was about another one
  here.model = model;
  here.chosen = true; // what is typed in the study is kept by the editor
  at('model').value = model;
  showAll().catch(say);
}

/** The study's own text is that of its own model (rung 0). */
function correct() {
  here.tab = 'study';
  choose(0);
}

function showTab(name, focus = false) {
  here.tab = name;
  showView().catch(say);
  if (focus) at('tabs').querySelector('[aria-selected=true]').focus();
}

/** A column that is shorter than the other stays in sight; one that is longer than the screen with its end: the page scrolls as one. */
function keepInSight() {
  const place = () => { for (const id of ['time', 'side']) at(id).style.top = `${Math.min(0, innerHeight - at(id).offsetHeight)}px`; };
  const sizes = new ResizeObserver(place);
  for (const id of ['time', 'side']) sizes.observe(at(id));
  addEventListener('resize', place);
}

function begin() {
  readAddress();
  keepInSight();
  at('work').hidden = !live;
  at('tabs').replaceChildren(...tabs.map(([name, text]) => element('button', { role: 'tab', 'data-view': name, 'aria-controls': 'view', id: `tab-${name}`, onclick: () => showTab(name) }, text)));
  at('tabs').addEventListener('keydown', (event) => {
    const there = tabs.filter(([name]) => !at('tabs').querySelector(`[data-view=${name}]`).hidden), n = there.length;
    const k = there.findIndex(([name]) => name === here.tab);
    const next = { ArrowRight: (k + 1) % n, ArrowLeft: (k + n - 1) % n, Home: 0, End: n - 1 }[event.key];
    if (next === undefined || event.ctrlKey || event.metaKey || event.altKey) return;
    showTab(there[next][0], true);
    event.preventDefault();
  });
  for (const verb of ['run', 'fit', 'discover']) at(verb).addEventListener('click', () => start(verb, verb));
  at('stop').addEventListener('click', stop);
  at('add').addEventListener('click', () => start('add', 'add', { effect: at('effect').value, models: addedTo }));
  at('effect').addEventListener('change', () => { showFormula(); at('add').disabled = !here.idle || at('effect').value === ''; });
  at('model').addEventListener('change', (event) => choose(Number(event.target.value)));
  at('method').addEventListener('change', (event) => { here.method = event.target.value; showMotion().catch(say); });
  at('experiment').addEventListener('change', (event) => { chooseExperiment(event.target.value); showTime(); showView().catch(say); });
  at('newer').querySelector('button').addEventListener('click', () => showView().catch(say));
  at('whole').addEventListener('click', () => time.zoom(null));
  at('unmark').addEventListener('click', unmark);
  at('holdout').addEventListener('click', () => start('holdout', 'set', { what: 'validation', name: here.name, value: written(here.fixed.intervals[0]) }));
  addEventListener('keydown', (event) => { if (event.key === 'Escape' && !event.target.closest?.('input, textarea, select')) unmark(); });
  addEventListener('beforeunload', (event) => { if (study.changed()) event.preventDefault(); });
  onScreenChange(() => { drawTime(); showView().catch(say); });
  watch();
}

begin();
