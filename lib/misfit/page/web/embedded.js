// The answers that stand in the document itself: report.html, which no server sends. Takes the place of server.js there.
const at = (id) => document.getElementById(id);
const packed = Uint8Array.from(atob(at('answers').textContent), (letter) => letter.charCodeAt(0));
const unpacked = new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'))).json();

/** With the lists of numbers, which stand once, in their places. */
function whole(value, lists) {
  if (value === null || typeof value !== 'object') return value;
  if (Array.isArray(value)) return value.map((one) => whole(one, lists));
  return '$' in value ? lists[value.$] : Object.fromEntries(Object.entries(value).map(([key, one]) => [key, whole(one, lists)]));
}

/** Nobody is asked: nothing can be done, and what is not in the document cannot be shown. */
export const live = false;

export class Refused extends Error {}
export class Unreachable extends Error {}

export async function get(what, parameters = {}) {
  const { lists, answers } = await unpacked;
  const answer = answers[`${what}?${new URLSearchParams(parameters)}`];
  if (answer === undefined) throw new Refused('This view found no room in the report; “misfit open” shows it.');
  return whole(answer, lists);
}
/** Nothing changes in a document. */
export const kept = get;
export function outdate() {}
export async function post() {
  throw new Refused('A report can only be read; “misfit open” shows the study.');
}

/** The document is read, or explored: one of both is seen. On paper it is always the document. */
function explore(on) {
  const exploring = at('explore-style');
  document.head.querySelector('style').media = on ? 'print' : 'all';
  exploring.media = on ? 'screen' : 'not all';
  document.body.dataset.exploring = on;
  dispatchEvent(new Event('resize'));
}

const page = document.createElement('div');
page.id = 'page';
page.append(at('explore').content.cloneNode(true));
document.head.append(at('explore-styles').content.cloneNode(true));
const button = (text, on) => {
  const out = document.createElement('button');
  out.textContent = text;
  out.className = on ? 'explore' : 'read';
  out.addEventListener('click', () => explore(on));
  return out;
};
document.body.prepend(page);
page.querySelector('.top').append(button('Read as a document', false));
document.querySelector('body > header').append(button('Explore: point, zoom, compare', true));
explore(location.hash === '' || location.hash.startsWith('#view=')); // else a section of the document was asked for
if (document.body.dataset.exploring === 'false') document.querySelector(':target')?.scrollIntoView();
