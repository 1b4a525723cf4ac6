// The coefficients of a model with their intervals.
"use strict";

/// The coefficients of a model of an axis, beside those of the five terms if it is another model.
function coefficientTable(walk, fit, view, isWalked) {
  const before = walk.steps[0].coefficients;
  const custom = (one) => (unitIndex === 1 ? walk.axis.customary[one.unit] : undefined);
  const value = (one) => {
    const factor = custom(one)?.factor ?? 1;
    if (one.state === "not_observable") return "–";
    if (one.state === "upper_bound") return `< ${number(factor * one.upper)}`;
    return number(factor * one.value);
  };
  const interval = (one, state) => {
    if (one.state !== "measured") return state;
    const factor = custom(one)?.factor ?? 1;
    return `${number(factor * one.lower)} … ${number(factor * one.upper)}`;
  };
  const cell = (one, state) => html("td", { class: "value" },
    html("span", { class: "best" }, value(one)), html("span", { class: "interval" }, interval(one, state)));
  const none = html("td", {}, "–");
  const earlier = (one) => {
    const at = before.findIndex((other) => other.symbol === one.symbol);
    return at < 0 ? none.cloneNode(true) : cell(before[at], walk.axis.steps[0].states[at]);
  };
  const row = (one, at) => html("tr", {},
    html("th", { scope: "row" }, gloss(plain(one.effect)), " ", html("i", {}, one.symbol),
      html("span", { class: "unit" }, custom(one)?.unit ?? one.unit)),
    isWalked ? earlier(one) : null, cell(one, view.states[at]));
  const head = ["coefficient", "five terms", isWalked ? "now" : null];
  return html("table", {},
    html("thead", {}, html("tr", {}, ...head.filter((words) => words).map((words) => html("th", { scope: "col" }, words)))),
    html("tbody", {}, ...fit.coefficients.map(row)));
}
