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

async function ask(path, options) {
  const response = await fetch(path, { ...options, headers: { 'X-Misfit-Token': token, 'Content-Type': 'application/json' }, cache: 'no-store' });
  const text = await response.text();
  let answer = null;
  try {
    answer = JSON.parse(text);
  } catch {
    answer = { error: text.trim() };
  }
  if (!response.ok) throw new Refused(response.status, answer);
  return answer;
}

/** get('where', {model: 1}) */
export const get = (what, parameters = {}) => ask(`/api/${what}?${new URLSearchParams(parameters)}`, {});
export const post = (what, body = {}) => ask(`/api/${what}`, { method: 'POST', body: JSON.stringify(body) });
