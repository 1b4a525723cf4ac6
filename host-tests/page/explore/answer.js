// What the program answers: the figures, the judgement and the coefficients.
"use strict";

/// The answer to compare with, and its name: that before the last change, or that of the five terms if there was none.
function reference() {
  const earlier = undone.past.findLast((one) => one.state.record === state.record && one.answer);
  if (byId("reference").value === "before" && earlier) return { before: earlier.answer, named: "before" };
  const five = { record: state.record, judged: state.judged, with: [], without: [], taken_out: false };
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
    html("span", { class: "figures chi2" }, gloss("χ²"), " ", strong(tenth(answer.chi2)), was(tenth(before?.chi2 ?? null)), ` for ${answer.dof} `, gloss("degrees of freedom")),
    answer.error > answer.chi2 ? html("span", { class: "figures" }, "and ", strong(tenth(answer.error - answer.chi2)), ` of what follows ${data.records[state.record].covariate}`) : null,
    html("span", { class: "figures" }, gloss("p"), " ", strong(answer.p)),
  ].filter((one) => one !== null));
  byId("words").textContent = `${answer.words[0].toUpperCase()}${answer.words.slice(1)}.`;
  byId("widened").textContent = answer.widened ?? "";
  byId("command-line").textContent = answer.command;
  showEffects();
  say(before);
  showCoefficients(before, named);
  showJudged(before);
  showLegend(before, named);
  drawPlaces();
  drawHistory();
  drawTime();
}

/// Says the result to a screen reader, once the changes rest.
function say(before) {
  clearTimeout(saying);
  // Another log may be dropped meanwhile.
  const { chi2, dof, p } = answer;
  const was = before && before !== answer ? `, was ${tenth(before.chi2)}` : "";
  saying = setTimeout(() => {
    byId("said").textContent = `χ² ${tenth(chi2)}${was}, ${dof} degrees of freedom, p ${p}`;
  }, 400);
}

/// Whether what follows the covariates is taken out of the record that is fitted.
const isTakenOut = () => state.takenOut && data.records[state.record].covariate !== null;

const modelName = () => {
  const without = state.without.length > 0 ? ` without ${state.without.map(plain).join(", ")}` : "";
  const out = isTakenOut() ? ` + ${data.records[state.record].covariate}, taken out` : "";
  return `five terms${without}${out}${state.added.map(({ effect }) => ` + ${plain(effect)}`).join("")}`;
};

/// The figures with their tables, by what they show. Each keeps its cursor and what is seen of it.
const figures = new Map();

function figureOf(quantity) {
  if (!figures.has(quantity)) {
    const pick = quantity === "spectrum" ? { words: (x) => `Add a line at ${number(x)} Hz`, act: addLine } : null;
    const [plot, table] = [new Plot({ pick, changed: keepAddress }), new PointTable(fileName)];
    plot.root.append(table.root);
    figures.set(quantity, { plot, table });
  }
  return figures.get(quantity);
}

/// Adds a line at a frequency, from which its shape is fitted.
function addLine(x) {
  const { ranges: { [state.record]: [low, high] } } = effectNamed.get("sinusoid").parameters[0];
  const frequency = rounded(Math.min(high, Math.max(low, x)));
  change(null, (of) => of.added.push({ effect: "sinusoid", values: [frequency], fitted: true }));
}

function drawPlaces() {
  if (!answer) return;
  const { before } = reference();
  const places = byId("places");
  const shown = answer.frames.map(({ quantity }) => figureOf(quantity).plot.root);
  if (shown.some((root, at) => places.children[at] !== root) || places.childElementCount !== shown.length) places.replaceChildren(...shown);
  answer.frames.forEach((frame, at) => {
    const { plot, table } = figureOf(frame.quantity);
    const record = ({ measured, z, up, expected }, number, name) => ({ name, points: measured, z, up, expected, colour: number });
    const judged = answer.judged.map((one) => record(one.records[at], colour(one.record), data.records[one.record]?.name ?? ""));
    const scene = { title: `${frame.up} and residual, ${modelName()}: ${answer.words}`, model_name: modelName(), model: answer.models[at].model,
      shares: answer.models[at].shares, before: before && before !== answer ? before.models[at]?.model ?? null : null,
      fine: frame.quantity === "spectrum" ? fineSpectrum(frame) : null,
      records: [record(answer.records[at], 0, data.records[state.record].name), ...judged] };
    const unit = frame.units[Math.min(unitIndex(), frame.units.length - 1)];
    plot.set(frame, scene, unit);
    table.set(frame, scene, unit);
  });
}

/// The fine spectrum of the record that is fitted, as far as it is in a frame.
function fineSpectrum({ x: [low, high] }) {
  const { spectrogram } = data.records[state.record];
  if (!spectrogram) return null;
  const points = spectrogram.fine.map((density, at) => [(at + 1) * spectrogram.bin_hz, density]);
  return points.filter(([frequency, density]) => frequency >= low && frequency <= high && density > 0);
}

/// Draws χ² of the models so far of this record, the newest ones if they are many.
function drawHistory() {
  const place = byId("history");
  const width = Math.round(place.clientWidth);
  if (!answer || width < 100) return;
  const earlier = undone.past.filter((one) => one.state.record === state.record && one.answer).map((one) => one.answer);
  const all = [...earlier, answer].filter((one, at, list) => one !== list[at - 1]).slice(-24);
  place.replaceChildren(drawStairs(errorsOf(all), width));
}

const unitIndex = () => Number(byId("unit").value);

function showLegend(before, named) {
  const judged = answer.judged.length > MANY
    ? [legendEntry(`${answer.judged.length} records that judge`, draw("circle", { cx: 17, cy: 7, r: 4, class: "other record-1" }))]
    : answer.judged.map(({ record }) => legendEntry(data.records[record]?.name ?? "", draw("circle", { cx: 17, cy: 7, r: 4, class: `other record-${colour(record)}` })));
  const earlier = before && before !== answer ? [legendEntry(named === "before" ? "model before" : "five terms", legendLine("line before"))] : [];
  if (data.records[state.record].spectrogram) earlier.push(legendEntry("fine spectrum, not fitted", legendLine("line fine")));
  const measured = answer.judged.length > 0 ? `${data.records[state.record].name}, fitted` : "measured ± standard error";
  byId("legend").replaceChildren(...legendEntries(answer.models.flatMap((model) => model.shares), measured, ...judged, ...earlier));
}

function showJudged(before) {
  if (answer.judged.length === 0) return byId("judged").replaceChildren();
  const row = (record, role, one, earlier) => html("tr", {},
    html("th", { scope: "row" }, sample(record), data.records[record].name, html("span", { class: "unit" }, role)),
    html("td", { class: "number" }, tenth(one.chi2),
      earlier && earlier !== one ? html("span", { class: "unit" }, `was ${tenth(earlier.chi2)}`) : null),
    ...[`${one.dof}`, one.p].map((words) => html("td", { class: "number" }, words)));
  const others = answer.judged.map((one) =>
    row(one.record, "judges", one, before?.judged.find((other) => other.record === one.record)));
  const head = ["record", "χ²", "dof", "p"];
  const table = html("table", {},
    html("thead", {}, html("tr", {}, ...head.map((words, at) => html("th", { scope: "col", class: at > 0 ? "number" : null }, words)))),
    html("tbody", {}, row(state.record, "fitted", answer, before), ...others));
  byId("judged").replaceChildren(answer.judged.length > MANY
    ? html("div", { class: "many", tabindex: 0, role: "region", "aria-label": "Records that judge" }, table) : table);
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
    return html("tr", { "data-effect": known.effect }, html("th", { scope: "row" }, gloss(known.name), " ", html("i", {}, known.symbol),
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
