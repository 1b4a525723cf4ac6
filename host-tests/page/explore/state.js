// The state of the page: the records and the model, in the words of the command `compare`.
"use strict";

/// Six digits, without trailing zeros.
const rounded = (value) => Number(value.toPrecision(6));

/// What the program wrote for the page about its records, and all of what it wrote, which it is asked about.
let data = null;
let session = null;
/// The number of sessions so far.
let sessions = 0;
let effectNamed = new Map();

/// An effect by its name. One of the user's own is known once the program has read its formula.
const effectOf = (name) => effectNamed.get(name) ?? { name, plain: plain(name), symbol: "", what: "", replaces: null, parameters: [] };

/// Takes what the program says of effects of the user's own.
function takeOwn(given) {
  for (const { effect, own } of given.added) if (own) effectNamed.set(effect, own);
}

const isFormula = (text) => /^\s*(density|covariance)\s*:/.test(text);

/// An effect as its text gives it. The values follow from the answer of the program.
function addedOf(text) {
  const named = /;\s*name\s*=\s*([a-z0-9_]+)/.exec(text);
  const effect = isFormula(text) ? named?.[1] ?? "own" : text.split(":")[0].trim();
  return { effect, values: [], fitted: text.includes("~") || /\.\./.test(text), text };
}

/// The value of the option --with for an added effect. A shape that is fitted has `~`; one without values is looked for.
function withText({ effect, values, fitted, text, formula }) {
  if (text !== undefined) return text;
  const { parameters } = effectOf(effect);
  if (formula) {
    const ranges = parameters.map(({ ranges }) => ranges[state.record].join(".."));
    return [formula, ...parameters.map(({ name }, at) =>
      ((values[at] ?? null) === null ? `${name}=${ranges[at]}` : `${name}${fitted ? "~" : "="}${values[at]}`))].join("; ");
  }
  const pairs = parameters.map(({ name, is_whole: isWhole }, at) =>
    ((values[at] ?? null) === null ? null : `${name}${fitted && !isWhole ? "~" : "="}${values[at]}`));
  const given = pairs.filter((pair) => pair !== null);
  return given.length > 0 ? `${effect}:${given.join(",")}` : effect;
}

/// What is asked of the program about a state.
const question = (state) => ({ record: state.record, judged: state.judged, with: state.added.map(withText), without: state.without, taken_out: state.takenOut });

const emptyState = (record = 0) => ({ record, judged: [], added: [], without: [], takenOut: false });

/// The state as the fragment of the address.
function fragment(state) {
  const readable = (text) => encodeURIComponent(text).replace(/%(3A|2C|3D|7E|2F)/g, decodeURIComponent);
  const parts = [`record=${state.record}`, ...state.judged.map((record) => `judged=${record}`),
    ...state.added.map((added) => `with=${readable(withText(added))}`),
    ...state.without.map((name) => `without=${readable(name)}`), ...(state.takenOut ? ["covariate=out"] : []), ...viewParts(viewsSeen())];
  return `#${parts.join("&")}`;
}

/// The state of a fragment. The program refuses what it does not know.
function stateOf(hash) {
  const state = emptyState();
  const isRecord = (value) => /^\d+$/.test(value) && Number(value) < data.records.length;
  for (const part of hash.replace(/^#/, "").split("&")) {
    const at = part.indexOf("=");
    const name = part.slice(0, at);
    let value = part.slice(at + 1);
    try {
      value = decodeURIComponent(value);
    } catch {
      continue;
    }
    if (name === "record" && isRecord(value)) state.record = Number(value);
    if (name === "judged" && isRecord(value)) state.judged.push(Number(value));
    if (name === "with") state.added.push(addedOf(value));
    if (name === "without") state.without.push(value);
    if (name === "covariate" && value === "out") state.takenOut = true;
  }
  state.judged = [...new Set(state.judged)].filter((record) => record !== state.record).sort((a, b) => a - b);
  state.added = state.added.filter(({ effect, text }) => isFormula(text) || effectNamed.has(effect));
  return state;
}

/// The worker that answers questions. The one that reads logs is another, so that it can be ended.
const questions = new Runner();

/// Asks the program about a model, and gives what it prints or throws what it says.
async function ask(what, asked) {
  const args = ["allanite", "ask", what, JSON.stringify(asked), "session.json"];
  const { status, output, errors } = await questions.run(args, [["session.json", session]]);
  if (status === 0) return output;
  throw new Error(errors.trim().replace(/^allanite: /, "") || `the program ended with status ${status}`);
}

/// Asks for fits, one after the other: while one is on its way, only the newest question waits.
class Fits {
  constructor(shown, failed) {
    Object.assign(this, { shown, failed, waiting: null, busy: false, known: new Map() });
  }

  ask(state) {
    this.waiting = structuredClone(state);
    if (!this.busy) this.work();
  }

  async work() {
    this.busy = true;
    while (this.waiting) {
      const state = this.waiting;
      this.waiting = null;
      try {
        this.shown(state, await this.answer(question(state)));
      } catch (error) {
        this.failed(error.message);
      }
    }
    this.busy = false;
  }

  /// The answer to a question, which is asked once only.
  async answer(asked) {
    const key = JSON.stringify(asked);
    if (!this.known.has(key)) {
      const answer = JSON.parse(await ask("fit", asked));
      if (this.known.size > 200) this.known.clear();
      this.known.set(key, answer);
    }
    return this.known.get(key);
  }
}
