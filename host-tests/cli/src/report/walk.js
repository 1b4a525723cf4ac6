// One axis of a report: its diagnosis step by step, with its candidates, in either unit.
"use strict";

/// What the program wrote into the page.
const data = JSON.parse(byId("data").textContent);
takeGlossary(JSON.parse(byId("glossary").textContent));
let unitIndex = 0;

/// One axis: its diagnosis, its figures, and the step and candidate that are shown.
class Walk {
  constructor(root, index, changed) {
    Object.assign(this, { root, index, changed, step: 0, candidate: null });
    this.axis = data.axes[index];
    const { axis, steps } = data.diagnosis.axes[index];
    this.name = axis;
    this.steps = steps;
    this.build();
    this.show(0);
    // The figures are drawn again whenever their width changes.
    let width = 0;
    new ResizeObserver(() => {
      if (this.place.clientWidth === width) return;
      width = this.place.clientWidth;
      this.draw();
    }).observe(this.place);
  }

  /// What is seen of each figure, by its quantity.
  get views() {
    return Object.fromEntries(this.plots.map((plot, at) => [this.axis.frames[at].quantity, plot.view]));
  }

  /// Shows a step, and these parts of the figures.
  adopt({ step, views }) {
    this.plots.forEach((plot, at) => plot.adopt(views[this.axis.frames[at].quantity]));
    this.show(step);
  }

  build() {
    const id = (name) => `axis-${this.index}-${name}`;
    const button = (words, label, by) => {
      const one = html("button", { type: "button", class: "turn", "aria-label": label }, words);
      one.addEventListener("click", () => this.go(this.step + by));
      return one;
    };
    this.previous = button("← Previous", "Previous step", -1);
    this.next = button("Next →", "Next step", 1);
    const scale = logarithmicBars(errorsOf(this.steps));
    this.tabs = this.steps.map((_, at) => this.tab(at, id, scale));
    const list = html("div", { role: "tablist", "aria-orientation": "vertical", class: "steps",
      "aria-label": "Steps of the diagnosis" }, ...this.tabs);
    list.addEventListener("keydown", (event) => this.turn(event));
    this.heading = html("h3", { class: "model" });
    this.error = html("p", { class: "error", "aria-live": "polite" });
    this.found = html("div", { class: "finding" });
    const changed = () => this.changed(this);
    this.plots = this.axis.frames.map(() => new Plot({ changed }));
    this.tables = this.axis.frames.map(() => new PointTable(() => this.name));
    this.plots.forEach((plot, at) => plot.root.append(this.tables[at].root));
    this.place = html("div", { class: "places" }, ...this.plots.map((plot) => plot.root));
    this.course = this.axis.course ? html("div", { class: "place" }) : null;
    this.events = html("ol", { class: "events", "aria-label": "Events" },
      ...(this.axis.course?.events ?? []).map((event) => html("li", {}, event.words)));
    this.legend = html("ul", { class: "legend", "aria-label": "Legend" });
    this.words = html("p", { class: "words" });
    this.candidates = html("div", { class: "candidates" });
    this.coefficients = html("div", { class: "coefficients" });
    this.panel = html("div", { role: "tabpanel", id: id("panel"), class: "panel" },
      this.heading, this.error, this.words, this.place, this.legend, this.found, this.candidates, this.coefficients,
      this.course ? html("h3", {}, "The record over time") : null, this.course, this.course ? this.events : null);
    this.root.replaceChildren(
      html("div", { class: "control" },
        html("div", { class: "turns" }, this.previous, this.next),
        list, scale.axis(),
        html("p", { class: "key" }, "The bar is χ² on a logarithmic scale: from one rule to the next it is ten times as large. The mark is at the degrees of freedom.")),
      this.panel);
  }

  /// The tab of a step, with its χ² as a number and as a bar, and by how much it fell.
  tab(at, id, scale) {
    const { error: chi2, dof } = this.steps[at];
    const view = this.axis.steps[at];
    const name = at === 0 ? "five terms" : `+ ${view.found?.name ?? ""}`;
    const tab = html("button", { type: "button", role: "tab", id: id(`step-${at}`), class: "step",
      "aria-controls": id("panel") },
      html("span", { class: "name" }, name),
      html("span", { class: "chi2" }, `χ² ${tenth(chi2)}`),
      scale.bar(chi2, dof),
      at > 0 ? html("span", { class: "fell" }, fallInWords(this.steps[at - 1].error, chi2)) : null);
    tab.addEventListener("click", () => this.go(at));
    return tab;
  }

  /// Shows a step on a reader's wish, which the address keeps.
  go(step) {
    this.show(step);
    this.changed(this);
  }

  turn(event) {
    const last = this.steps.length - 1;
    const to = { ArrowDown: this.step + 1, ArrowRight: this.step + 1, ArrowUp: this.step - 1,
      ArrowLeft: this.step - 1, Home: 0, End: last }[event.key];
    if (to === undefined) return;
    event.preventDefault();
    this.go(to);
    this.tabs[this.step].focus();
  }

  show(step) {
    this.step = Math.min(Math.max(step, 0), this.steps.length - 1);
    this.candidate = null;
    this.previous.disabled = this.step === 0;
    this.next.disabled = this.step === this.steps.length - 1;
    this.tabs.forEach((tab, at) => {
      tab.setAttribute("aria-selected", at === this.step);
      tab.tabIndex = at === this.step ? 0 : -1;
    });
    this.panel.setAttribute("aria-labelledby", this.tabs[this.step].id);
    this.showFinding();
    this.showCandidates();
    this.update();
  }

  /// The fit and the view that are shown: those of the step, or those of the chosen candidate.
  shown() {
    const { step, candidate } = this;
    if (candidate === null) return { fit: this.steps[step], view: this.axis.steps[step] };
    const { fitted } = this.axis.steps[step].candidates[candidate];
    if (fitted) return { fit: fitted, view: fitted.view };
    return { fit: this.steps[step + 1], view: this.axis.steps[step + 1] };
  }

  update() {
    const { fit, view } = this.shown();
    const strong = (words) => html("strong", {}, words);
    this.heading.textContent = `${this.candidate === null ? "Model" : "With this candidate"}: ${view.model}`;
    this.error.replaceChildren(
      html("span", { class: "figures chi2" }, gloss("χ²"), " ", strong(tenth(fit.chi2)), ` for ${fit.dof} `, gloss("degrees of freedom")),
      ...(fit.error > fit.chi2 ? [html("span", { class: "figures" }, "and ", strong(tenth(fit.error - fit.chi2)), " of what a later step subtracts")] : []),
      html("span", { class: "figures" }, gloss("p"), " ", strong(view.p)));
    this.words.textContent = `${view.words[0].toUpperCase()}${view.words.slice(1)}.`;
    this.showCoefficients(fit, view);
    this.showLegend(view);
    this.draw();
  }

  /// The scene of a figure of a view.
  scene(view, at) {
    const frame = this.axis.frames[at];
    const { model, shares, measured, z, up, expected } = view.figures[at];
    return { title: `${frame.up} and residual, ${view.model}: ${view.words}`, model_name: view.model, model, shares, before: null,
      records: [{ name: this.name, points: measured ?? frame.measured, z, up, expected, colour: 0 }] };
  }

  unit(frame) {
    return frame.units[Math.min(unitIndex, frame.units.length - 1)];
  }

  draw() {
    const { view } = this.shown();
    this.plots.forEach((plot, at) => {
      const frame = this.axis.frames[at];
      const shown = [frame, this.scene(view, at), this.unit(frame)];
      // Where the figures are below each other, the one in which this step changed most comes first.
      plot.root.classList.toggle("front", at === view.front);
      plot.set(...shown);
      this.tables[at].set(...shown);
    });
    const width = this.course?.clientWidth ?? 0;
    if (width >= 100) this.course.replaceChildren(drawCourse(this.axis.course, Math.round(width)).svg);
  }

  showLegend(view) {
    this.legend.replaceChildren(...legendEntries(view.figures.flatMap((figure) => figure.shares), "measured ± standard error"));
  }

  showFinding() {
    const found = this.axis.steps[this.step].found;
    this.found.hidden = !found;
    if (!found) return this.found.replaceChildren();
    const rows = [...found.lines];
    if (found.ambiguous) rows.push(["ambiguous", found.ambiguous]);
    const list = rows.flatMap(([label, words]) => [html("dt", {}, label), html("dd", {}, words)]);
    this.found.replaceChildren(html("h3", {}, `What was missing: ${found.name}`),
      found.found ? html("p", { class: "size" }, found.found) : null, html("dl", {}, ...list));
  }

  showCandidates() {
    const tried = this.steps[this.step].candidates;
    const views = this.axis.steps[this.step].candidates;
    if (tried.length === 0) {
      const words = this.step > 0 || this.steps.length === 1 ? "No further effect was tried." : "";
      return this.candidates.replaceChildren(html("p", { class: "hint" }, words));
    }
    const group = `axis-${this.index}-candidate`;
    const row = (at, ...cells) => {
      const radio = html("input", { type: "radio", name: group, id: `${group}-${at ?? "none"}`, checked: at === null });
      radio.addEventListener("change", () => {
        this.candidate = at;
        this.update();
      });
      radio.disabled = at !== null && !views[at].added && !views[at].fitted;
      const [name, ...rest] = cells;
      return html("tr", {}, html("td", {}, radio, " ", html("label", { for: radio.id }, name)),
        ...rest.map((cell) => html("td", { class: "number" }, cell)));
    };
    const rows = tried.map((one, at) =>
      row(at, views[at].name + (views[at].added ? " — added" : ""), tenth(one.chi2), tenth(one.improvement)));
    this.candidates.replaceChildren(
      html("h3", {}, "What was tried next"),
      html("p", { class: "hint" },
        "Best first. χ² is a quick estimate; select a candidate to refit it in full."),
      html("table", {},
        html("thead", {}, html("tr", {}, html("th", {}, "candidate"), html("th", { class: "number" }, "χ²"),
          html("th", { class: "number" }, gloss("improvement")))),
        html("tbody", {}, row(null, "none: the model of this step", tenth(this.steps[this.step].chi2), "0"), ...rows)));
  }

  /// The coefficients of the five terms beside those of the model that is shown.
  showCoefficients(fit, view) {
    const isWalked = this.step > 0 || this.candidate !== null;
    this.coefficients.replaceChildren(html("h3", {}, "Coefficients, with ", gloss("95 % interval", "95 % intervals")), coefficientTable(this, fit, view, isWalked));
  }
}
