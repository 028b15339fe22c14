// The study's text: checked by misfit while it is typed, saved only when nothing is wrong with it.
import { element } from '/dom.js';

export function editor({ get, post, look }) {
  let known = null; // as it lies on disk
  let text = null; // as it is typed; null: unchanged
  let fault = null, timer = 0, parts = null;
  let saved = false; // by this page, and unchanged since

  const changed = () => text !== null && text !== known?.text;

  function number() {
    const lines = parts.area.value.split('\n').length;
    parts.lines.replaceChildren();
    for (let k = 1; k <= lines; ++k) parts.lines.append(k === fault?.line ? element('span', { class: 'bad' }, `${k}`) : `${k}\n`);
    parts.lines.scrollTop = parts.area.scrollTop;
  }
  function tell(message, kind) {
    parts.message.className = kind;
    parts.message.replaceChildren(message);
    if (fault?.line) parts.message.append(' ', element('button', { onclick: () => go(fault.line) }, `To line ${fault.line}`));
    parts.save.disabled = !changed() || fault !== null;
    parts.undo.disabled = !changed();
  }
  function go(line) {
    const begin = parts.area.value.split('\n').slice(0, line - 1).reduce((sum, one) => sum + one.length + 1, 0);
    const end = parts.area.value.indexOf('\n', begin);
    parts.area.focus();
    parts.area.setSelectionRange(begin, end < 0 ? parts.area.value.length : end);
    parts.area.scrollTop = Math.max(0, (line - 5) * parseFloat(getComputedStyle(parts.area).lineHeight));
  }
  const verdict = () => tell(fault ? fault.message : changed() ? 'Nothing is wrong with it; not saved yet.' : saved ? 'Saved. Run makes the results anew.' : 'Nothing is wrong with it.', fault ? 'fault' : 'fine');

  async function check() {
    const asked = parts.area.value;
    try {
      const answer = await post('check', { text: asked });
      if (asked !== parts.area.value) return;
      fault = answer.fault;
      number();
      verdict();
    } catch (error) {
      tell(error.message, 'fault');
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
    try {
      const answer = await post('save', { text: parts.area.value, hash: known.hash });
      known = { ...known, text: parts.area.value, hash: answer.hash };
      text = null;
      fault = null;
      saved = true;
      number();
      verdict();
      await look();
    } catch (error) {
      fault = error.answer?.fault ?? fault;
      number();
      tell(error.message, 'fault');
    }
  }
  function undo() {
    parts.area.value = known.text;
    text = null;
    fault = known.fault;
    number();
    verdict();
  }

  async function show(view, model) {
    const fresh = await get('study', { model });
    const kept = fresh.editable && changed();
    if (!kept) {
      if (fresh.hash !== known?.hash) saved = false;
      known = fresh;
      text = null;
      fault = fresh.fault;
    }
    const area = element('textarea', { spellcheck: 'false', wrap: 'off', 'aria-label': 'Text of the study', readonly: !fresh.editable, oninput: typed });
    area.value = kept ? text : fresh.text;
    parts = { area, lines: element('pre', { 'aria-hidden': 'true' }), message: element('p', { 'aria-live': 'polite', id: 'check' }),
      save: element('button', { id: 'save', class: 'main', onclick: save }, 'Save'), undo: element('button', { onclick: undo }, 'Undo all') };
    area.addEventListener('scroll', () => (parts.lines.scrollTop = area.scrollTop));
    view.append(element('p', { class: 'soft' }, fresh.file, fresh.editable ? '' : ': the study of a rung, written by misfit; the study itself is edited with model 0.'),
      element('div', { class: 'editor' }, parts.lines, area), parts.message);
    if (fresh.editable) view.append(element('div', { class: 'buttons' }, parts.save, parts.undo));
    number();
    if (kept && fresh.hash !== known.hash) tell('The file was changed by somebody else meanwhile: copy what you typed, then "Undo all" and reload.', 'fault');
    else if (kept) check();
    else verdict();
  }

  return { show, changed };
}
