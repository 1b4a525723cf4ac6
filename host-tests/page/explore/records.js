// The records: which one is fitted, and which ones judge the fit.
"use strict";

/// More records than this get a field to find them and buttons for all of them. Chosen by hand: so many are seen at once.
const MANY = 8;

let wanted = "";

/// Whether a record may judge: it has the unit of the fitted one.
const mayJudge = (at, of = state) => at !== of.record && data.records[at].unit === data.records[of.record].unit;

/// The records whose names have all the words that are looked for.
function foundRecords() {
  const words = wanted.toLowerCase().split(/\s+/).filter((word) => word);
  const all = data.records.map((_, at) => at);
  return all.filter((at) => words.every((word) => data.records[at].name.toLowerCase().includes(word)));
}

function showRecords() {
  fill(byId("records"), [sessions, state.record, state.judged, wanted], recordRows);
}

function recordRows() {
  if (data.records.length === 1) {
    const [{ name, size }] = data.records;
    return [html("p", {}, name), html("p", { class: "record" }, size)];
  }
  const found = foundRecords();
  const table = html("table", {},
    html("thead", {}, html("tr", {}, html("th", { scope: "col" }, "fit"), html("th", { scope: "col" }, "judge"),
      html("th", { scope: "col" }, "record"))),
    html("tbody", {}, ...found.map(recordRow)));
  const size = html("p", { class: "record" }, data.records[state.record].size);
  if (data.records.length <= MANY) return [table, size];
  const judge = (words, by) => {
    const button = html("button", { type: "button", class: "turn", id: `judge-${words.split(" ").pop()}` }, words);
    button.addEventListener("click", () => change(null, by));
    return button;
  };
  return [
    finder(),
    html("div", { class: "options" },
      judge("Judge on all", (of) => { of.judged = [...new Set([...of.judged, ...found.filter((at) => mayJudge(at, of))])].sort((a, b) => a - b); }),
      judge("Judge on none", (of) => { of.judged = []; })),
    html("div", { class: "many", tabindex: 0, role: "region", "aria-label": "Records" }, table),
    html("p", { class: "record" }, `${found.length} of ${data.records.length} records; ${state.judged.length} judge. Fitted: ${data.records[state.record].name}`),
    size,
  ];
}

/// The field in which a record is looked for.
function finder() {
  const field = html("input", { type: "search", id: "find-record", "aria-label": "Find a record", placeholder: "Find a record", value: wanted });
  field.addEventListener("input", () => {
    wanted = field.value;
    showRecords();
    // The field was made anew, and one goes on to write at its end.
    byId("find-record").setSelectionRange(wanted.length, wanted.length);
  });
  return field;
}

function recordRow(at) {
  const record = data.records[at];
  const fit = html("input", { type: "radio", name: "fitted", id: `fit-${at}`, "aria-label": `fit to ${record.name}`, checked: at === state.record });
  fit.addEventListener("change", () => change(null, (of) => {
    // The record that was fitted judges, if the new one did.
    const others = of.judged.includes(at) ? [...of.judged.filter((other) => other !== at), of.record] : of.judged;
    Object.assign(of, { record: at, judged: others.sort((a, b) => a - b) });
  }));
  const judge = html("input", { type: "checkbox", id: `judge-${at}`, "aria-label": `judge on ${record.name}`, checked: state.judged.includes(at),
    disabled: !mayJudge(at) });
  judge.addEventListener("change", () => change(null, (of) => {
    of.judged = judge.checked ? [...of.judged, at].sort((a, b) => a - b) : of.judged.filter((other) => other !== at);
  }));
  return html("tr", {}, html("td", {}, fit), html("td", {}, judge),
    html("td", { title: record.size }, sample(at), record.name));
}

/// The colour of a record: 0 for the fitted one.
const colour = (record) => (record === state.record ? 0 : 1 + (state.judged.indexOf(record) % 4));
const sample = (record) => (state.judged.includes(record)
  ? html("span", { class: `sample record-${colour(record)}`, "aria-hidden": "true" }) : null);
