// Talking to misfit. Every request carries the token of the address.
const token = new URLSearchParams(location.search).get('token') ?? '';

/** A program answers, which works on the study. */
export const live = true;

/** The answer was an error; `status` of HTTP, `answer` as it came. */
export class Refused extends Error {
  constructor(status, answer) {
    super(answer?.error ?? `misfit answered ${status}`);
    this.status = status;
    this.answer = answer;
  }
}

/** Nobody answers. */
export class Unreachable extends Error {}

async function textOf(path, options) {
  let response = null, text = '';
  try {
    response = await fetch(path, { ...options, headers: { 'X-Misfit-Token': token, 'Content-Type': 'application/json' }, cache: 'no-store' });
    text = await response.text();
  } catch {
    throw new Unreachable('misfit does not answer');
  }
  if (!response.ok) throw new Refused(response.status, refusalIn(text));
  return text;
}
function refusalIn(text) {
  try {
    return JSON.parse(text);
  } catch {
    return { error: text.trim() };
  }
}
const ask = async (path, options) => JSON.parse(await textOf(path, options));

/** get('where', {model: 1}) */
export const get = (what, parameters = {}) => ask(`/api/${what}?${new URLSearchParams(parameters)}`, {});
export const post = (what, body = {}) => ask(`/api/${what}`, { method: 'POST', body: JSON.stringify(body) });

const most = 40e6; // letters of what is kept
const known = new Map(); // question: { text, answer, of }; what was asked for last stands last
let generation = 0;

/** As get(), asked once until outdate(). An answer that comes again in the same words is the same object: what is drawn of it can stay. */
export async function kept(what, parameters = {}) {
  const question = `${what}?${new URLSearchParams(parameters)}`, of = generation, before = known.get(question);
  if (before?.of === of) return before.answer;
  const text = await textOf(`/api/${question}`, {});
  const answer = before?.text === text ? before.answer : JSON.parse(text);
  known.delete(question);
  known.set(question, { text, answer, of });
  let letters = 0;
  for (const one of known.values()) letters += one.text.length;
  for (const [oldest, one] of known) {
    if (letters <= most) break;
    letters -= one.text.length;
    known.delete(oldest);
  }
  return answer;
}
/** Something has changed: everything is asked for again. */
export function outdate() {
  ++generation;
}
