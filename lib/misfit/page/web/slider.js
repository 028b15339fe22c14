// The slider of a curve's roughness.
import { element, shown, words } from '/dom.js';
import { nearest } from '/figure.js';

/** A slider for the roughness of a curve, by each of the methods that have one: the curve, and those derived from it, follow at once, by the
    linearised fit. A refit is made by Set and Run. `set(curve, key)`: writes a roughness into the study, undefined where it cannot; `idle`: it can at
    once. */
export function roughnessSlider(paths, figures, parent, { set, idle }) {
  if (paths.length === 0) return;
  let path = paths[paths.length - 1];
  const slider = element('input', { type: 'range', min: 0, step: 'any', 'aria-label': `smoothness of ${path.curve}`, 'data-curve': path.curve, oninput: () => move() });
  const said = element('output', {}), back = element('button', { onclick: () => begin() }, 'As fitted');
  const key = `slider ${path.curve}`, write = set(path.curve, key);
  const setButton = write ? element('button', { class: 'sets', 'data-key': key, disabled: !idle, title: 'writes it into the study; Run refits',
    onclick: () => {
      slider.removeAttribute('data-changed'); // it is in the study now
      write(value().toPrecision(3));
    } }, 'Set') : null;
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
    slider.toggleAttribute('data-changed', !asFitted);
    for (const figure of figures) figure.overlay = (figure.overlay ?? []).filter((s) => s.of !== slider); // other curves keep theirs
    for (const c of asFitted ? [] : path.curves) {
      const y = between(c.values, (a, b, share) => a.map((v, i) => (v === null || b[i] === null ? null : mixed(v, b[i], share))));
      figures[c.figure]?.overlay.push({ of: slider, x: c.x, y, sorted: true, style: 'line', width: 2.5, colour: '#000000' });
    }
    for (const figure of figures) figure.redrawOver();
    const support = between(path.support, mixed), freedom = path.freedom && `; ${path.freedom} effective degrees of freedom`;
    said.replaceChildren(asFitted ? '' : 'Thick line (all others, and the bands, are as fitted): ', `roughness λ = ${shown(value(), 3)} `, words(path.unit), asFitted
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
    element('span', { class: 'soft' }, 'smooth'), back, setButton, said));
}
