// The controls: the terms and effects of the model, and the catalogue.
"use strict";

/// The steps of a slider. Chosen by hand: a key moves a frequency by a third of a percent or less.
const SLIDER = 4000;

/// Fills an element anew if what it shows has changed, and leaves the focus where it was.
function fill(place, shown, children) {
  const key = JSON.stringify(shown);
  if (place.dataset.shown === key) return;
  place.dataset.shown = key;
  const focused = place.contains(document.activeElement) ? document.activeElement.id : "";
  place.replaceChildren(...children().filter((one) => one !== null));
  if (focused) byId(focused)?.focus();
}

// The model.

function showTerms() {
  fill(byId("terms"), [sessions, state.record, state.without, state.takenOut, state.added.map(({ effect }) => effect)], termRows);
}

function termRows() {
  const replaced = new Map();
  for (const { effect } of state.added) {
    const by = effectOf(effect);
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
  return [html("ul", { class: "terms", "aria-label": "The five terms" }, ...rows), covariateRow()];
}

/// What can be taken out of the record, such as what follows the temperature.
function covariateRow() {
  const { covariate } = data.records[state.record];
  if (covariate === null) return null;
  const box = html("input", { type: "checkbox", id: "covariate", checked: state.takenOut });
  box.addEventListener("change", () => change(null, (of) => { of.takenOut = box.checked; }));
  return html("p", { class: "covariate" }, box, " ", html("label", { for: box.id }, `Take out what follows ${covariate}`));
}

/// A slider position of a value in a range, and back.
const position = (value, [low, high]) => Math.round(SLIDER * clamp(Math.log(value / low) / Math.log(high / low)));
const valueAt = (place, [low, high]) => rounded(low * (high / low) ** (place / SLIDER));

/// The controls of the added effects. They are made anew only if another effect is there, so that a drag is not broken.
let effectControls = [];
let effectsShown = "";

function showEffects() {
  const structure = JSON.stringify([sessions, state.record, state.added.map(({ effect, formula }) => [effect, formula, effectOf(effect).parameters.length])]);
  if (structure !== effectsShown) {
    effectsShown = structure;
    effectControls = state.added.map((_, at) => effectControl(at));
    byId("effects").replaceChildren(...effectControls.map((control) => control.field));
  }
  effectControls.forEach((control) => control.update());
}

function effectControl(at) {
  const effect = effectOf(state.added[at].effect);
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
    html("div", { class: "options" }, open ? html("span", {}, fit, " ", html("label", { for: fit.id }, "Fit the shape")) : null,
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

/// Adds an effect of one's own, if the program understands its formula.
async function addOwn(text) {
  const next = structuredClone(state);
  next.added.push(addedOf(text));
  byId("own-problem").textContent = "";
  try {
    takeOwn(await fits.answer(question(next)));
    change(null, (of) => of.added.push(addedOf(text)));
  } catch (error) {
    byId("own-problem").textContent = error.message.replace(/^--with [^:]*: /, "");
  }
}

byId("own").addEventListener("submit", (event) => {
  event.preventDefault();
  addOwn(byId("formula").value);
});

function showControls() {
  showRecords();
  showTerms();
  showEffects();
  byId("undo").disabled = undone.past.length === 0;
  byId("redo").disabled = undone.future.length === 0;
  byId("reset").disabled = state.added.length === 0 && state.without.length === 0 && !state.takenOut;
}
