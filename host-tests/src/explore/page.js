// The page: its state with what was before, what the diagnosis thinks, and what is kept.
"use strict";

/// Changes of one control within this time are undone together, in milliseconds. Chosen by hand.
const TOGETHER = 1000;

let state = stateOf(location.hash);
let answer = null;
/// Earlier and later states, each with its answer.
const undone = { past: [], future: [] };
let last = { control: null, at: 0 };
let saying = 0;

const fits = new Fits((of, given) => {
  byId("problem").textContent = "";
  answer = given;
  if (JSON.stringify(question(of)) === JSON.stringify(question(state))) adopt(given);
  show();
}, (words) => {
  byId("problem").textContent = words;
});

/// Takes the values of the answer: those that were fitted, and those that the address gave as text.
function adopt(given) {
  given.added.forEach((added, at) => {
    state.added[at] = { effect: added.effect, values: added.parameters, fitted: added.fitted };
  });
  history.replaceState(null, "", fragment(state));
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

let thought = null;
byId("diagnose").addEventListener("click", async () => {
  const { record } = state;
  const place = byId("diagnosis");
  byId("diagnose").disabled = true;
  byId("adopt").hidden = true;
  place.replaceChildren(html("p", {}, "Diagnosing …"));
  try {
    thought = { record, ...(await (await post("diagnose", { record })).json()) };
    const finding = (one) => {
      const rows = [...one.lines];
      if (one.ambiguous) rows.push(["ambiguous", one.ambiguous]);
      return html("div", { class: "finding" }, html("h3", {}, one.name), one.found ? html("p", {}, one.found) : null,
        html("dl", {}, ...rows.flatMap(([label, words]) => [html("dt", {}, label), html("dd", {}, words)])));
    };
    const notes = [...(thought.beyond ? [thought.beyond] : []), ...thought.notes];
    place.replaceChildren(html("p", {}, `${data.records[record].name}: ${thought.lead}`), ...thought.findings.map(finding),
      html("ul", {}, ...notes.map((note) => html("li", {}, note))));
    byId("adopt").hidden = thought.with.length === 0 && thought.without.length === 0;
  } catch (error) {
    place.replaceChildren(html("p", {}, error.message));
  }
  byId("diagnose").disabled = false;
});
byId("adopt").addEventListener("click", () => change(null, (of) => {
  of.record = thought.record;
  of.judged = of.judged.filter((record) => record !== thought.record);
  of.added = thought.with.map((text) => ({ effect: text.split(":")[0], values: [], fitted: text.includes("~"), text }));
  of.without = [...thought.without];
}));

// What is kept.

async function download(name, file) {
  try {
    const blob = await (await post(name, question(state))).blob();
    const link = html("a", { href: URL.createObjectURL(blob), download: file });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
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

const fileName = () => data.records[state.record].axis.replace(/[^A-Za-z0-9_.-]+/g, "-");
byId("drawing").addEventListener("click", () => download("drawing", `${fileName()}.svg`));
byId("table").addEventListener("click", () => download("table", `${fileName()}.csv`));
byId("link").addEventListener("click", () => copy(location.href, "address"));
byId("copy").addEventListener("click", () => copy(answer?.command ?? "", "command"));
window.addEventListener("hashchange", () => {
  if (location.hash !== fragment(state)) change(null, (of) => Object.assign(of, stateOf(location.hash)));
});

for (const id of ["reference", "unit"]) byId(id).addEventListener("change", show);
new ResizeObserver(() => {
  drawPlaces();
  drawHistory();
}).observe(byId("places"));
showCatalogue();
refresh();
