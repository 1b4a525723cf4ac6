// The page: its state with what was before, what the diagnosis thinks, and what is kept.
"use strict";

/// Changes of one control within this time are undone together, in milliseconds. Chosen by hand.
const TOGETHER = 1000;

let state = emptyState();
let answer = null;
/// Earlier and later states, each with its answer.
let undone = { past: [], future: [] };
let last = { control: null, at: 0 };
let saying = 0;
let fits = null;

/// Opens what `explore --session` printed: the records, and what the page shows of them.
function openSession(text) {
  data = JSON.parse(text).page;
  session = new TextEncoder().encode(text);
  sessions += 1;
  effectNamed = new Map(data.catalogue.map((effect) => [effect.name, effect]));
  state = stateOf(location.hash);
  answer = null;
  undone = { past: [], future: [] };
  fits = new Fits((of, given) => {
    byId("problem").textContent = "";
    answer = given;
    takeOwn(given);
    if (JSON.stringify(question(of)) === JSON.stringify(question(state))) adopt(given);
    show();
  }, (words) => {
    byId("problem").textContent = words;
  });
  takeGlossary(data.glossary);
  takeViews(location.hash);
  byId("styles").textContent = data.styles;
  byId("explore").hidden = false;
  document.body.classList.add("exploring");
  showCatalogue();
  refresh();
}

/// Takes the values of the answer: those that were fitted, and those that the address gave as text.
function adopt(given) {
  given.added.forEach((added, at) => {
    state.added[at] = { effect: added.effect, values: added.parameters, fitted: added.fitted, formula: added.formula ?? undefined };
  });
  history.replaceState(null, "", fragment(state));
}

let keeping = 0;

/// Writes what is seen into the address, once it rests: browsers refuse to do so at every move.
function keepAddress() {
  clearTimeout(keeping);
  keeping = setTimeout(() => history.replaceState(null, "", fragment(state)), 120);
}

/// What is seen of the figures.
const viewsSeen = () => Object.fromEntries([...figures].map(([quantity, { plot }]) => [quantity, plot.view]));

/// Shows of the figures what an address says.
function takeViews(hash) {
  const views = freshViews();
  for (const part of hash.replace(/^#/, "").split("&")) {
    const [, key, value] = /^([a-z.]+)=(.*)$/.exec(part) ?? [];
    if (key) takeViewPart(views, key, value);
  }
  for (const [quantity, view] of Object.entries(views)) figureOf(quantity).plot.adopt(view);
}

/// Changes the state by a function. Changes of the same control that follow each other are undone together.
function change(control, by) {
  const now = Date.now();
  if (control === null || last.control !== control || now - last.at > TOGETHER) {
    undone.past.push({ state: structuredClone(state), answer });
    undone.future = [];
  }
  last = { control, at: now };
  by(state);
  refresh();
}

function refresh() {
  showControls();
  showThought();
  fits.ask(state);
}

/// Goes back or forth.
function travel(from, to) {
  const target = from.pop();
  if (!target) return;
  to.push({ state: structuredClone(state), answer });
  state = structuredClone(target.state);
  last = { control: null, at: 0 };
  refresh();
}

byId("undo").addEventListener("click", () => travel(undone.past, undone.future));
byId("redo").addEventListener("click", () => travel(undone.future, undone.past));
byId("reset").addEventListener("click", () => change(null, (of) => Object.assign(of, emptyState(of.record), { judged: of.judged })));

// What the diagnosis thinks.

function showThought() {
  fill(byId("diagnosis"), [sessions, state.record], () => {
    const { name, thought } = data.records[state.record];
    const finding = (one) => {
      const rows = [...one.lines];
      if (one.ambiguous) rows.push(["ambiguous", one.ambiguous]);
      return html("div", { class: "finding" }, html("h3", {}, one.name), one.found ? html("p", {}, one.found) : null,
        html("dl", {}, ...rows.flatMap(([label, words]) => [html("dt", {}, label), html("dd", {}, words)])));
    };
    byId("adopt").hidden = thought.with.length === 0 && thought.without.length === 0 && !thought.taken_out;
    byId("lead-words").textContent = `${name}: ${thought.lead}`;
    return [...thought.findings.map(finding),
      html("ul", {}, ...thought.notes.map((note) => html("li", {}, note)))];
  });
}

byId("adopt").addEventListener("click", () => change(null, (of) => {
  const { thought } = data.records[of.record];
  of.added = thought.with.map(addedOf);
  of.without = [...thought.without];
  of.takenOut = thought.taken_out;
}));

// What is kept.

async function download(name, file, type) {
  try {
    keep(await ask(name, question(state)), file, type);
    byId("kept").textContent = `${file} was downloaded.`;
  } catch (error) {
    byId("kept").textContent = error.message;
  }
}

async function copy(text, what) {
  try {
    await navigator.clipboard.writeText(text);
    byId("kept").textContent = `The ${what} was copied.`;
  } catch {
    byId("kept").textContent = `The browser does not allow to copy; the ${what} is: ${text}`;
  }
}

const fileName = () => fileNameOf(data.records[state.record].axis);
byId("drawing").addEventListener("click", () => download("drawing", `${fileName()}.svg`, "image/svg+xml"));
byId("table").addEventListener("click", () => download("table", `${fileName()}.csv`, "text/csv"));
byId("link").addEventListener("click", () => copy(location.href, "address"));
byId("copy").addEventListener("click", () => copy(answer?.command ?? "", "command"));
window.addEventListener("hashchange", () => {
  if (!data || location.hash === fragment(state)) return;
  takeViews(location.hash);
  change(null, (of) => Object.assign(of, stateOf(location.hash)));
});

for (const id of ["reference", "unit"]) byId(id).addEventListener("change", show);
new ResizeObserver(() => {
  if (!answer) return;
  drawPlaces();
  drawHistory();
  drawTime();
}).observe(byId("places"));
