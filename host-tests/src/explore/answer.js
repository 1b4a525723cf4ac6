// What the server answers: the figures, the judgement and the coefficients.
"use strict";

/// The answer to compare with, and its name: that before the last change, or that of the five terms if there was none.
function reference() {
  const earlier = undone.past.findLast((one) => one.state.record === state.record && one.answer);
  if (byId("reference").value === "before" && earlier) return { before: earlier.answer, named: "before" };
  const five = { record: state.record, judged: state.judged, with: [], without: [] };
  const known = fits.known.get(JSON.stringify(five));
  if (!known) fits.answer(five).then(show, () => {});
  return { before: known ?? null, named: "five terms" };
}

function show() {
  if (!answer) return;
  const { before, named } = reference();
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
  showCoefficients(before, named);
  showJudged(before);
  showLegend(before, named);
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
  const { before } = reference();
  answer.frames.forEach((frame, at) => {
    const place = places.children[at];
    if (place.clientWidth < 100) return;
    const unit = frame.units[Math.min(unitIndex(), frame.units.length - 1)];
    const judged = answer.judged.map((one) => ({ drawn: one.records[at], colour: colour(one.record) }));
    const shown = { model: answer.models[at], before: before && before !== answer ? before.models[at]?.model ?? null : null, words: `${modelName()}: ${answer.words}`,
      records: [{ drawn: answer.records[at], colour: 0 }, ...judged] };
    place.replaceChildren(drawRecords(frame, shown, unit, Math.round(place.clientWidth)));
  });
}

const unitIndex = () => Number(byId("unit").value);

function showLegend(before, named) {
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
    ...(before && before !== answer ? [entry(named === "before" ? "model before" : "five terms", line("line before"))] : []),
    ...[...shares.values()].map((share) => entry(plain(share.effect), line(`line effect-${share.colour}`))),
    entry("within ± 2 standard errors", draw("rect", { x: 1, y: 1, width: 32, height: 12, class: "band" })));
}

function showJudged(before) {
  if (answer.judged.length === 0) return byId("judged").replaceChildren();
  const row = (record, role, one, earlier) => html("tr", {},
    html("th", { scope: "row" }, sample(record), data.records[record].name, html("span", { class: "unit" }, role)),
    html("td", { class: "number" }, tenth(one.chi2),
      earlier && earlier !== one ? html("span", { class: "unit" }, `was ${tenth(earlier.chi2)}`) : null),
    ...[`${one.dof}`, one.p, tenth(one.rms_percent)].map((words) => html("td", { class: "number" }, words)));
  const others = answer.judged.map((one) =>
    row(one.record, "judges", one, before?.judged.find((other) => other.record === one.record)));
  const head = ["record", "χ²", "dof", "p", "misfit %"];
  byId("judged").replaceChildren(html("table", {},
    html("thead", {}, html("tr", {}, ...head.map((words, at) => html("th", { scope: "col", class: at > 0 ? "number" : null }, words)))),
    html("tbody", {}, row(state.record, "fitted", answer, before), ...others)));
}

/// The coefficients beside those of the reference, and what changed. A filter has the coefficient of what it replaces;
/// effects of one name are told apart by their order.
function showCoefficients(before, named) {
  const keyed = (coefficients) => {
    const seen = new Map();
    return new Map(coefficients.map((one) => {
      const name = effectNamed.get(one.effect)?.replaces ?? one.effect;
      const count = (seen.get(name) ?? 0) + 1;
      seen.set(name, count);
      return [`${name} ${count}`, one];
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
  if (was.state !== is.state) {
    return { measured: "now measured", upper_bound: "now a bound", not_observable: "now not observable" }[is.state];
  }
  if (is.state === "not_observable") return "–";
  const percent = is.state === "measured" ? 100 * (is.value / was.value - 1) : 100 * (is.upper / was.upper - 1);
  if (!Number.isFinite(percent) || Math.abs(percent) < 0.05) return "same";
  const size = Math.abs(percent);
  return `${percent > 0 ? "+" : "−"}${size < 1000 ? size.toFixed(1) : size.toExponential(1).replace("e+", "e")} %`;
}
