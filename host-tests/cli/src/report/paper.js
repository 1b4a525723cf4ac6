// An axis on paper: its first and its last model beside each other, what was missing, and the coefficients.
"use strict";

/// The width of a figure on paper in its own pixels. Two of them are as wide as a page.
const PAPER_FIGURE = 470;

class Paper {
  constructor(walk) {
    this.walk = walk;
    this.root = html("div", { class: "paper" });
    walk.root.after(this.root);
  }

  /// Draws the axis, in the units that are shown.
  fill() {
    const { axis, steps } = this.walk;
    const last = steps.length - 1;
    const models = last > 0 ? [0, last] : [0];
    const column = (at) => html("div", { class: "model-on-paper" },
      html("h3", {}, `${at === 0 ? "First" : "Last"} model: ${axis.steps[at].model}`),
      html("p", { class: "words" }, `χ² ${tenth(steps[at].chi2)} for ${steps[at].dof} degrees of freedom, p ${axis.steps[at].p}`),
      ...axis.frames.map((frame, figure) =>
        drawFigure(frame, this.walk.scene(axis.steps[at], figure), this.walk.unit(frame), PAPER_FIGURE, { heights: [200, 90] }).svg));
    const shares = models.flatMap((at) => axis.steps[at].figures.flatMap((figure) => figure.shares));
    this.root.replaceChildren(html("div", { class: "pair" }, ...models.map(column)),
      html("ul", { class: "legend" }, ...legendEntries(shares, "measured ± standard error")),
      ...(last > 0 ? [this.course()] : []), this.findings(),
      html("div", { class: "coefficients" }, html("h3", {}, "Coefficients, with 95 % intervals"),
        coefficientTable(this.walk, steps[last], axis.steps[last], last > 0)));
  }

  /// χ² from step to step.
  course() {
    const { steps, axis } = this.walk;
    const scale = logarithmicBars(errorsOf(steps));
    const row = ({ error: chi2, dof }, at) => html("tr", {}, html("th", { scope: "row" }, at === 0 ? "five terms" : `+ ${axis.steps[at].found?.name ?? ""}`),
      html("td", { class: "number" }, tenth(chi2)), html("td", { class: "number" }, at > 0 ? fallInWords(steps[at - 1].error, chi2) : ""),
      html("td", { class: "bars" }, scale.bar(chi2, dof)));
    return html("table", { class: "course-on-paper" },
      html("thead", {}, html("tr", {}, html("th", {}, "model"), html("th", { class: "number" }, "χ²"), html("th", {}), html("th", { class: "bars" }, scale.axis()))),
      html("tbody", {}, ...steps.map(row)));
  }

  findings() {
    const found = this.walk.axis.steps.map((step) => step.found).filter((one) => one);
    return html("div", { class: "found-on-paper" }, ...found.map((one) => html("div", {}, html("h4", {}, `What was missing: ${one.name}`),
      one.found ? html("p", {}, one.found) : null, one.ambiguous ? html("p", {}, `Ambiguous: ${one.ambiguous}.`) : null,
      ...one.lines.filter(([label]) => label === "what to check").map(([label, words]) => html("p", {}, `${label}: ${words}`)))));
  }
}
