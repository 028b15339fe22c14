// The study's text: checked by misfit while it is typed, saved only when nothing is wrong with it.
import { element } from '/dom.js';

/** Of a text that cannot be edited here. */
const whose = (rung) => (rung === 0 ? ": the study's own model (rung 0). This page only shows it; misfit open edits it."
  : `: the study of rung ${rung}, written by misfit; the study itself is edited with its own model (rung 0).`);

export function editor({ get, kept, post, look }) {
  // Of the study itself, also while the text of a rung is shown, which can only be read:
  let known = null; // as it lies on disk
  let text = null; // as it is typed; null: unchanged
  let faults = [], timer = 0, parts = null; // of what is shown
  let saved = false; // by this page, and unchanged since
  let stale = false; // somebody else has changed the file since it was read

  const changed = () => text !== null && text !== known?.text;

  function number() {
    const lines = parts.area.value.split('\n').length;
    parts.lines.replaceChildren();
    for (let k = 1; k <= lines; ++k) parts.lines.append(faults.some((fault) => fault.line === k) ? element('span', { class: 'bad' }, `${k}`) : `${k}\n`);
    parts.lines.scrollTop = parts.area.scrollTop;
  }
  function tell(message, kind) {
    parts.message.className = kind;
    parts.message.replaceChildren(message);
    const jump = ({ line }) => (line ? element('button', { onclick: () => go(line) }, `To line ${line}`) : '');
    if (faults.length > 0) parts.message.append(' ', jump(faults[0]));
    parts.further.replaceChildren(...faults.slice(1).map((fault) => element('li', {}, fault.message, ' ', jump(fault))));
    parts.furtherHead.hidden = faults.length < 2;
    parts.save.disabled = !changed() || stale || faults.length > 0;
    parts.undo.disabled = !changed();
  }
  function go(line) {
    const begin = parts.area.value.split('\n').slice(0, line - 1).reduce((sum, one) => sum + one.length + 1, 0);
    const end = parts.area.value.indexOf('\n', begin);
    parts.area.focus();
    parts.area.setSelectionRange(begin, end < 0 ? parts.area.value.length : end);
    parts.area.scrollTop = Math.max(0, (line - 5) * parseFloat(getComputedStyle(parts.area).lineHeight));
  }
  function verdict() {
    if (parts.editable && stale) return tell('The file was changed by somebody else meanwhile: copy what you typed, then "Undo all".', 'fault');
    tell(faults.length > 0 ? faults[0].message : parts.editable && changed() ? 'Nothing is wrong with it; not saved yet.' : parts.editable && saved ? 'Saved. Run makes the results anew.' : 'Nothing is wrong with it.', faults.length > 0 ? 'fault' : 'fine');
  }

  async function check() {
    const mine = parts, asked = parts.area.value;
    const current = () => mine === parts && asked === parts.area.value;
    try {
      const answer = await post('check', { text: asked });
      if (!current()) return;
      faults = answer.faults;
      number();
      verdict();
    } catch (error) {
      if (current()) tell(error.message, 'fault');
    }
  }
  function typed() {
    text = parts.area.value;
    saved = false;
    number();
    parts.save.disabled = true;
    clearTimeout(timer);
    timer = setTimeout(check, 300);
  }
  async function save() {
    const asked = text;
    try {
      const answer = await post('save', { text: asked, hash: known.hash });
      known = { ...known, text: asked, hash: answer.hash, faults: [] };
      if (text === asked) text = null; // else it was typed on meanwhile, and is checked again
      saved = text === null;
      stale = false;
      if (saved && parts.editable) {
        faults = [];
        number();
        verdict();
      }
      await look();
      if (document.activeElement === document.body) document.querySelector('#view textarea')?.focus({ preventScroll: true }); // it may have been made anew
    } catch (error) {
      if (parts.editable && text === asked) faults = error.answer?.faults ?? faults;
      number();
      tell(error.message, 'fault');
    }
  }
  function take(fresh) {
    if (fresh.hash !== known?.hash) saved = false;
    known = fresh;
    text = null;
    stale = false;
  }
  /** Back to the file as it is now, which somebody else may have changed. */
  async function undo() {
    const mine = parts;
    try {
      const fresh = await get('study', { model: 0 });
      if (mine !== parts) return;
      take(fresh);
      parts.area.value = known.text;
      faults = known.faults;
      number();
      verdict();
    } catch (error) {
      if (mine === parts) tell(error.message, 'fault');
    }
  }

  const ask = (model) => kept('study', { model });

  /** While something is typed: is the file still the one that was read? */
  function compare(fresh) {
    if (!fresh.editable || !parts?.editable || stale === (fresh.hash !== known.hash)) return;
    stale = !stale;
    verdict();
  }

  function show(view, fresh) {
    clearTimeout(timer);
    const keeps = fresh.editable && changed();
    if (keeps) stale = fresh.hash !== known.hash;
    else if (fresh.editable) take(fresh);
    faults = keeps ? [] : fresh.faults;
    const area = element('textarea', { id: 'study-text', spellcheck: 'false', wrap: 'off', 'aria-label': 'Text of the study', readonly: !fresh.editable, oninput: typed });
    area.value = keeps ? text : fresh.text;
    parts = { editable: fresh.editable, area, lines: element('pre', { 'aria-hidden': 'true' }), message: element('p', { 'aria-live': 'polite', id: 'check' }),
      furtherHead: element('p', { hidden: true }, 'More errors, found after skipping those already listed:'), further: element('ul', { class: 'fault', id: 'further' }),
      save: element('button', { id: 'save', class: 'main', onclick: save }, 'Save'), undo: element('button', { onclick: undo }, 'Undo all') };
    area.addEventListener('scroll', () => (parts.lines.scrollTop = area.scrollTop));
    view.append(element('p', { class: 'soft' }, fresh.file, fresh.editable ? '' : whose(fresh.rung)),
      element('div', { class: 'editor' }, parts.lines, area), parts.message, parts.furtherHead, parts.further);
    if (fresh.editable) view.append(element('div', { class: 'buttons' }, parts.save, parts.undo));
    number();
    if (keeps && !stale) check();
    else verdict();
  }

  return { ask, show, compare, changed };
}
