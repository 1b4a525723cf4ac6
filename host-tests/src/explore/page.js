// The page: controls that change the state, and what the server answers about it.
"use strict";

const html = (name, attributes, ...children) => make(null, name, attributes, children);
const byId = (id) => document.getElementById(id);
const tenth = (value) => (value === null ? "unknown" : value.toFixed(1));
const plain = (name) => name.replaceAll("_", " ");
/// The steps of a slider. Chosen by hand: a key moves a frequency by a third of a percent or less.
const SLIDER = 4000;
/// Changes of one control within this time are undone together, in milliseconds.
const TOGETHER = 1000;

/// Six digits, without trailing zeros.
const rounded = (value) => Number(value.toPrecision(6));
/// Four significant digits, as the program prints them.
function number(value) {
  if (value === null || !Number.isFinite(value)) return "∞";
  if (value === 0) return "0";
  const exponent = Math.floor(Math.log10(Math.abs(value)));
  if (exponent >= -3 && exponent <= 4) return value.toFixed(Math.max(0, 3 - exponent));
  return value.toExponential(3).replace("e+", "e");
}

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

/// Fills an element anew if what it shows has changed, and leaves the focus where it was.
function fill(place, shown, children) {
  const key = JSON.stringify(shown);
  if (place.dataset.shown === key) return;
  place.dataset.shown = key;
  const focused = place.contains(document.activeElement) ? document.activeElement.id : "";
  place.replaceChildren(...children());
  if (focused) byId(focused)?.focus();
}

// The records.

function showRecords() {
  fill(byId("records"), [state.record, state.judged], recordRows);
}

function recordRows() {
  if (data.records.length === 1) {
    const [{ name, size }] = data.records;
    return [html("p", {}, name), html("p", { class: "record" }, size)];
  }
  const fitted = data.records[state.record];
  const row = (record, at) => {
    const fit = html("input", { type: "radio", name: "fitted", id: `fit-${at}`, "aria-label": `fit to ${record.name}`, checked: at === state.record });
    fit.addEventListener("change", () => change(null, (of) => {
      // The record that was fitted judges, if the new one did.
      const others = of.judged.includes(at) ? [...of.judged.filter((other) => other !== at), of.record] : of.judged;
      Object.assign(of, { record: at, judged: others.sort((a, b) => a - b) });
    }));
    const judge = html("input", { type: "checkbox", id: `judge-${at}`, "aria-label": `judge on ${record.name}`, checked: state.judged.includes(at),
      disabled: at === state.record || record.unit !== fitted.unit });
    judge.addEventListener("change", () => change(null, (of) => {
      of.judged = judge.checked ? [...of.judged, at].sort((a, b) => a - b) : of.judged.filter((other) => other !== at);
    }));
    return html("tr", {}, html("td", {}, fit), html("td", {}, judge),
      html("td", { title: record.size }, sample(at), record.name));
  };
  return [
    html("table", {},
      html("thead", {}, html("tr", {}, html("th", { scope: "col" }, "fit"), html("th", { scope: "col" }, "judge"),
        html("th", { scope: "col" }, "record"))),
      html("tbody", {}, ...data.records.map(row))),
    html("p", { class: "record" }, fitted.size)];
}

/// The colour of a record: 0 for the fitted one.
const colour = (record) => (record === state.record ? 0 : 1 + (state.judged.indexOf(record) % 4));
const sample = (record) => (state.judged.includes(record)
  ? html("span", { class: `sample record-${colour(record)}`, "aria-hidden": "true" }) : null);

// The model.

function showTerms() {
  fill(byId("terms"), [state.without, state.added.map(({ effect }) => effect)], termRows);
}

function termRows() {
  const replaced = new Map();
  for (const { effect } of state.added) {
    const by = effectNamed.get(effect);
    if (by.replaces) replaced.set(by.replaces, by.plain);
  }
  const rows = data.catalogue.filter((effect) => effect.is_term).map((effect) => {
    const by = replaced.get(effect.name);
    const box = html("input", { type: "checkbox", id: `term-${effect.name}`, disabled: by !== undefined,
      checked: by === undefined && !state.without.includes(effect.name) });
    box.addEventListener("change", () => change(null, (of) => {
      of.without = box.checked ? of.without.filter((name) => name !== effect.name) : [...of.without, effect.name];
    }));
    return html("li", {}, box, " ", html("label", { for: box.id, title: effect.what }, effect.plain, " ", html("i", {}, effect.symbol)),
      by ? html("small", {}, ` – replaced by ${by}`) : null);
  });
  return [html("ul", { class: "terms", "aria-label": "The five terms" }, ...rows)];
}

/// A slider position of a value in a range, and back.
const position = (value, [low, high]) => Math.round(SLIDER * clamp(Math.log(value / low) / Math.log(high / low)));
const valueAt = (place, [low, high]) => rounded(low * (high / low) ** (place / SLIDER));

/// The controls of the added effects. They are made anew only if another effect is there, so that a drag is not broken.
let effectControls = [];
let effectsShown = "";

function showEffects() {
  const structure = JSON.stringify([state.record, state.added.map(({ effect }) => effect)]);
  if (structure !== effectsShown) {
    effectsShown = structure;
    effectControls = state.added.map((_, at) => effectControl(at));
    byId("effects").replaceChildren(...effectControls.map((control) => control.field));
  }
  effectControls.forEach((control) => control.update());
}

function effectControl(at) {
  const effect = effectNamed.get(state.added[at].effect);
  const same = state.added.slice(0, at).filter((other) => other.effect === effect.name).length;
  const title = same > 0 ? `${effect.plain} ${same + 1}` : effect.plain;
  const id = (name) => `effect-${at}-${name}`;
  const parameters = effect.parameters.map((parameter, j) => parameterControl(at, parameter, j, id));
  const fit = html("input", { type: "checkbox", id: id("fit") });
  fit.addEventListener("change", () => change(null, (of) => {
    of.added[at] = { ...of.added[at], fitted: fit.checked, text: undefined };
  }));
  const find = html("button", { type: "button", class: "turn", title: "Fit the shape, wherever it is in its range" }, "Find best");
  find.addEventListener("click", () => change(null, (of) => {
    // Whole numbers are looked for as well.
    of.added[at] = { ...of.added[at], fitted: true, values: effect.parameters.map(() => null), text: undefined };
  }));
  const remove = html("button", { type: "button", class: "turn", "aria-label": `Remove ${title}` }, "Remove");
  remove.addEventListener("click", () => {
    change(null, (of) => of.added.splice(at, 1));
    byId("undo").focus();
  });
  const open = effect.parameters.some((parameter) => !parameter.is_whole);
  const field = html("fieldset", { class: "effect" }, html("legend", { title: effect.what }, title, " ", html("i", {}, effect.symbol)),
    ...parameters.map((one) => one.row),
    html("div", { class: "options" }, open ? html("span", {}, fit, " ", html("label", { for: fit.id }, "Fit")) : null,
      open ? find : null, remove));
  return {
    field,
    update() {
      fit.checked = state.added[at].fitted;
      parameters.forEach((one) => one.update());
    },
  };
}

function parameterControl(at, parameter, j, id) {
  const range = parameter.ranges[state.record];
  const { is_whole: isWhole, unit } = parameter;
  const slider = html("input", isWhole
    ? { type: "range", id: id(j), min: range[0], max: range[1], step: 1 }
    : { type: "range", id: id(j), min: 0, max: SLIDER, step: 1 });
  const field = html("input", { type: "number", id: id(`${j}-number`), step: isWhole ? 1 : "any", "aria-label": `${parameter.plain}, ${unit || "number"}` });
  const interval = html("span", { class: "interval" });
  const set = (value, control) => change(control, (of) => {
    const values = [...of.added[at].values];
    values[j] = value;
    // A shape that is moved by hand is fitted no more, except for its whole numbers.
    of.added[at] = { ...of.added[at], values, fitted: of.added[at].fitted && isWhole, text: undefined };
  });
  slider.addEventListener("input", () => set(isWhole ? Number(slider.value) : valueAt(Number(slider.value), range), slider));
  field.addEventListener("change", () => {
    const value = Number(field.value);
    if (field.value !== "" && Number.isFinite(value)) set(value, null);
  });
  field.addEventListener("keydown", (event) => {
    const by = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    if (by === undefined || isWhole) return;
    event.preventDefault();
    set(rounded(Number(field.value) * 1.0005 ** by), field);
  });
  const row = html("div", { class: "parameter" }, html("label", { for: slider.id }, parameter.plain), slider, field,
    html("span", { class: "unit" }, unit), interval);
  return {
    row,
    update() {
      const value = state.added[at].values[j] ?? null;
      slider.disabled = value === null;
      if (value === null) return;
      const place = isWhole ? value : position(value, range);
      slider.value = place;
      slider.setAttribute("aria-valuetext", `${number(value)} ${unit}`);
      if (document.activeElement !== field || Number(field.value) !== value) field.value = isWhole ? value : rounded(value);
      const ends = answer?.added[at]?.effect === state.added[at].effect && state.added[at].fitted ? answer.added[at].intervals[j] : null;
      interval.textContent = ends ? (ends[1] === null ? "fitted: any value" : `fitted: ${number(ends[0])} … ${number(ends[1])}`) : "";
    },
  };
}

function showCatalogue() {
  const rows = data.catalogue.filter((effect) => !effect.is_term).map((effect) => {
    const add = html("button", { type: "button", class: "turn", "aria-label": `Add ${effect.plain}`, "data-effect": effect.name }, "Add");
    add.addEventListener("click", () => {
      change(null, (of) => {
        // The middle of the range of each parameter.
        const values = effect.parameters.map(({ is_whole: isWhole, ranges }) => {
          const [low, high] = ranges[of.record];
          return isWhole ? low : rounded(Math.sqrt(low * high));
        });
        of.added.push({ effect: effect.name, values, fitted: false });
      });
      document.querySelector(".effect:last-child input")?.focus();
    });
    const lines = [["what it is", effect.what], ["where it comes from", effect.origin], ["what to check", effect.check]];
    if (effect.replaces) lines.push(["in the model", `replaces ${plain(effect.replaces)}`]);
    const list = lines.flatMap(([label, words]) => [html("dt", {}, label), html("dd", {}, words)]);
    return html("li", {}, html("details", {}, html("summary", {}, effect.plain), html("dl", {}, ...list)), add);
  });
  byId("catalogue").replaceChildren(...rows);
}

function showControls() {
  showRecords();
  showTerms();
  showEffects();
  byId("undo").disabled = undone.past.length === 0;
  byId("redo").disabled = undone.future.length === 0;
  byId("reset").disabled = state.added.length === 0 && state.without.length === 0;
}

// The answer.

/// The answer to compare with: that of the five terms, or that before the last change.
function reference() {
  if (byId("reference").value === "before") {
    return undone.past.findLast((earlier) => earlier.state.record === state.record)?.answer ?? null;
  }
  const five = { record: state.record, judged: state.judged, with: [], without: [] };
  const known = fits.known.get(JSON.stringify(five));
  if (!known) fits.answer(five).then(show, () => {});
  return known ?? null;
}

function show() {
  if (!answer) return;
  const before = reference();
  byId("model").textContent = `Model: ${modelName()}`;
  const strong = (words) => html("strong", {}, words);
  const was = (words) => (before && before !== answer ? html("span", { class: "was" }, ` (was ${words})`) : null);
  byId("error").replaceChildren(...[
    html("span", { class: "figures chi2" }, "χ² ", strong(tenth(answer.chi2)), was(tenth(before?.chi2 ?? null)), ` for ${answer.dof} degrees of freedom`),
    html("span", { class: "figures" }, "p ", strong(answer.p)),
    html("span", { class: "figures" }, "misfit ", strong(tenth(answer.rms_percent)), " % rms", was(tenth(before?.rms_percent ?? null))),
  ]);
  byId("words").textContent = `${answer.words[0].toUpperCase()}${answer.words.slice(1)}.`;
  byId("widened").textContent = answer.widened ?? "";
  byId("command").textContent = answer.command;
  showEffects();
  say(before);
  showCoefficients(before);
  showJudged(before);
  showLegend(before);
  drawPlaces();
}

/// Says the result to a screen reader, once the changes rest.
function say(before) {
  clearTimeout(saying);
  saying = setTimeout(() => {
    const was = before && before !== answer ? `, was ${tenth(before.chi2)}` : "";
    byId("said").textContent = `χ² ${tenth(answer.chi2)}${was}, ${answer.dof} degrees of freedom, p ${answer.p}, misfit ${tenth(answer.rms_percent)} %`;
  }, 400);
}

const modelName = () => {
  const without = state.without.length > 0 ? ` without ${state.without.map(plain).join(", ")}` : "";
  return `five terms${without}${state.added.map(({ effect }) => ` + ${plain(effect)}`).join("")}`;
};

function drawPlaces() {
  if (!answer) return;
  const places = byId("places");
  while (places.childElementCount < answer.frames.length) places.append(html("div", { class: "place" }));
  while (places.childElementCount > answer.frames.length) places.lastChild.remove();
  const before = reference();
  answer.frames.forEach((frame, at) => {
    const place = places.children[at];
    if (place.clientWidth < 100) return;
    const unit = frame.units[Math.min(unitIndex(), frame.units.length - 1)];
    const judged = answer.judged.map((one) => ({ drawn: one.records[at], colour: colour(one.record) }));
    const shown = { model: answer.models[at], before: before?.models[at]?.model ?? null, words: `${modelName()}: ${answer.words}`,
      records: [{ drawn: answer.records[at], colour: 0 }, ...judged] };
    place.replaceChildren(drawRecords(frame, shown, unit, Math.round(place.clientWidth)));
  });
}

const unitIndex = () => Number(byId("unit").value);

function showLegend(before) {
  const entry = (words, ...marks) => html("li", {}, draw("svg", { width: 34, height: 14, "aria-hidden": "true" }, ...marks), words);
  const line = (name) => draw("line", { x1: 1, y1: 7, x2: 33, y2: 7, class: name });
  const shares = new Map(answer.models.flatMap((model) => model.shares).map((share) => [share.effect, share]));
  const many = answer.judged.length > 0;
  byId("legend").replaceChildren(
    entry(many ? `${data.records[state.record].name}, fitted` : "measured ± standard error",
      draw("line", { x1: 17, y1: 0, x2: 17, y2: 14, class: "bar" }), draw("circle", { cx: 17, cy: 7, r: 3.5, class: "dot" })),
    ...answer.judged.map(({ record }) => entry(data.records[record]?.name ?? "",
      draw("circle", { cx: 17, cy: 7, r: 4, class: `other record-${colour(record)}` }))),
    entry("model", line("line model")),
    ...(before && before !== answer ? [entry("model before", line("line before"))] : []),
    ...[...shares.values()].map((share) => entry(plain(share.effect), line(`line effect-${share.colour}`))),
    entry("within ± 2 standard errors", draw("rect", { x: 1, y: 1, width: 32, height: 12, class: "band" })));
}

function showJudged(before) {
  if (answer.judged.length === 0) return byId("judged").replaceChildren();
  const cells = (one, earlier) => [
    `${tenth(one.chi2)}${earlier && earlier !== one ? ` (was ${tenth(earlier.chi2)})` : ""}`, `${one.dof}`, one.p, tenth(one.rms_percent)];
  const row = (record, role, one, earlier) => html("tr", {}, html("th", { scope: "row" }, sample(record), data.records[record].name),
    html("td", {}, role), ...cells(one, earlier).map((words) => html("td", { class: "number" }, words)));
  const others = answer.judged.map((one) =>
    row(one.record, "judged", one, before?.judged.find((other) => other.record === one.record)));
  const head = ["record", "", "χ²", "dof", "p", "misfit %"];
  byId("judged").replaceChildren(html("table", {},
    html("thead", {}, html("tr", {}, ...head.map((words, at) => html("th", { scope: "col", class: at > 1 ? "number" : null }, words)))),
    html("tbody", {}, row(state.record, "fitted", answer, before), ...others)));
}

/// The coefficients beside those of the reference, and what changed. Effects of one name are told apart by their order.
function showCoefficients(before) {
  const keyed = (coefficients) => {
    const seen = new Map();
    return new Map(coefficients.map((one) => {
      const count = (seen.get(one.effect) ?? 0) + 1;
      seen.set(one.effect, count);
      return [`${one.effect} ${count}`, one];
    }));
  };
  const now = keyed(answer.coefficients);
  const then = keyed(before && before !== answer ? before.coefficients : []);
  const shown = (one) => one?.units[Math.min(unitIndex(), one.units.length - 1)];
  const cell = (one) => (one
    ? html("td", { class: "value" }, html("span", { class: "best" }, shown(one)[0]), html("span", { class: "interval" }, shown(one)[1]))
    : html("td", {}, "–"));
  const row = ([key, one]) => {
    const known = now.get(key) ?? one;
    return html("tr", { "data-effect": known.effect }, html("th", { scope: "row" }, known.name, " ", html("i", {}, known.symbol),
      html("span", { class: "unit" }, shown(known)[2])),
      then.size > 0 ? cell(then.get(key)) : null, cell(now.get(key)),
      then.size > 0 ? html("td", { class: "change" }, changed(then.get(key), now.get(key))) : null);
  };
  const gone = [...then].filter(([key]) => !now.has(key));
  const named = byId("reference").value === "five" ? "five terms" : "before";
  const head = then.size > 0 ? ["coefficient", named, "now", "change"] : ["coefficient", "now"];
  byId("coefficients").replaceChildren(html("table", {},
    html("caption", { class: "spoken" }, "Coefficients with 95 % intervals"),
    html("thead", {}, html("tr", {}, ...head.map((words) => html("th", { scope: "col" }, words)))),
    html("tbody", {}, ...[...now, ...gone].map(row))));
}

/// What happened to a coefficient, in a few words.
function changed(was, is) {
  if (!was) return "new";
  if (!is) return "not in the model";
  if (was.state === "measured" && is.state === "measured") {
    const percent = 100 * (is.value / was.value - 1);
    if (Math.abs(percent) < 0.05) return "same";
    return `${percent > 0 ? "+" : "−"}${Math.abs(percent) < 1000 ? Math.abs(percent).toFixed(1) : Math.abs(percent).toExponential(1)} %`;
  }
  if (was.state === "measured") return "no longer measured";
  return is.state === "measured" ? "now measured" : "same";
}

for (const id of ["reference", "unit"]) byId(id).addEventListener("change", show);
new ResizeObserver(drawPlaces).observe(byId("places"));

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

showCatalogue();
refresh();
