// The command that runs, or ran last: what it does and says, and its state at the button that began it.
import { element, shown } from '/dom.js';

const at = (id) => document.getElementById(id);

/** How a command failed, by its exit status. */
const failure = ({ status }) => (status === 2 ? 'refused: its message says what is wrong with the study or the command'
  : `not finished (status ${status}): its message says why`);

const setText = (node, text) => { if (node.textContent !== text) node.textContent = text; };

/** Adds what has come: what was there, and is read, scrolled or chosen, stays. */
function grow(node, text) {
  if (text.startsWith(node.data)) node.appendData(text.slice(node.data.length));
  else node.data = text;
}

/** What a command does and says, in nodes that stay. */
export class JobBox {
  closed = null; // number of the job that the user has closed
  constructor() {
    this.state = element('b');
    this.doing = element('span');
    this.progress = element('progress', { max: 1, 'aria-label': 'part that is done' });
    this.left = element('span');
    this.close = element('button', { class: 'closes', title: 'Hide what the command said; it stays in session.sh', onclick: () => { at('job').hidden = at('command').hidden = true; this.closed = this.number; } }, 'Close');
    this.failure = element('pre', { class: 'warning' });
    this.costs = element('div', { class: 'costs' });
    this.notes = document.createTextNode('');
    this.output = document.createTextNode('');
    this.said = element('pre', { tabindex: 0 }, this.notes, this.output);
    this.more = element('details', {}, element('summary', {}, 'What it says'), this.said);
    at('job').append(element('p', {}, this.state, this.doing, this.progress, this.left, ' ', this.close), this.failure, this.more, this.costs);
  }
  show(job) {
    const running = job.state === 'running', box = at('job');
    at('command').hidden = box.hidden = job.state === 'none' || (!running && this.closed === job.number);
    if (job.state === 'none') return;
    this.number = job.number;
    setText(at('command'), job.command);
    box.className = job.state;
    Object.assign(box.dataset, { state: job.state, number: job.number });
    const end = { running: job.stopping ? 'stopping' : 'at work', done: 'done', stopped: 'stopped: what was finished is kept', failed: failure(job) };
    setText(this.state, end[job.state]);
    setText(this.doing, ` · ${shown(job.seconds, 3)} s${running && job.work ? ` · ${job.work} ` : ''}`);
    this.progress.hidden = !running || !job.work || job.part === null;
    if (!this.progress.hidden) this.progress.value = job.part;
    setText(this.left, running && job.work && job.left !== null ? ` at most ${shown(job.left, 2)} s left` : '');
    this.close.hidden = running;
    this.failure.hidden = job.state !== 'failed';
    setText(this.failure, job.state === 'failed' ? job.notes.slice(-5).join('\n') : '');
    this.more.hidden = job.notes.length === 0 && job.output === '';
    grow(this.notes, job.notes.map((note) => `${note}\n`).join(''));
    grow(this.output, job.output);
    this.showCosts(job.costs, running);
  }
  /** Beside what it does while it runs, then in what it says. */
  showCosts(traces, running) {
    this.costs.replaceChildren(...costs(traces));
    if (running && this.costs.parentNode !== at('job')) at('job').append(this.costs);
    if (!running && this.costs.parentNode !== this.more) this.said.before(this.costs);
  }
}
/** How the searches of a command go on: the last two, in one line. */
function costs(traces) {
  const out = [];
  for (const trace of traces.slice(-2)) {
    if (trace.points.length < 2) continue;
    out.push(element('figure', {}, sparkline(trace.points.map(([, value]) => value)),
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
export class Began {
  key = null;
  number = null;
  asks = false; // misfit has not answered yet
  at = -Infinity; // when it was asked for
  /** `stop`: what its Stop does; `say(error)`: where an error is shown if the button is gone. */
  constructor({ stop, say }) {
    this.sayElsewhere = say;
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
    this.asks = true;
    this.node.remove();
    this.place();
    this.say('asked for');
  }
  answered(job) {
    this.number = job.number;
    this.asks = false;
  }
  refused(error) {
    this.asks = false;
    this.say(error.message, { bad: true });
    if (!this.button()) this.sayElsewhere(error);
  }
  owns(job) {
    return this.asks || job.number === this.number;
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
