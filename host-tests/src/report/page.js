// Shows a diagnosis step by step, with its candidates, in either unit.
"use strict";

let unitIndex = 0;

/// One axis: its diagnosis, its figures, and the step and candidate that are shown.
class Walk {
  constructor(root, index) {
    this.root = root;
    this.index = index;
    this.axis = data.axes[index];
    this.steps = data.diagnosis.axes[index].steps;
    this.step = 0;
    this.candidate = null;
    this.build();
    this.show(0);
    // The figure is drawn again whenever its width changes, as for printing.
    new ResizeObserver(() => this.draw()).observe(this.place);
  }

  build() {
    const id = (name) => `axis-${this.index}-${name}`;
    const button = (words, label, by) => {
      const one = html("button", { type: "button", class: "turn", "aria-label": label }, words);
      one.addEventListener("click", () => this.show(this.step + by));
      return one;
    };
    this.previous = button("← Previous", "Previous step", -1);
    this.next = button("Next →", "Next step", 1);
    this.tabs = this.steps.map((_, at) => this.tab(at, id));
    const list = html("div", { role: "tablist", "aria-orientation": "vertical", class: "steps",
      "aria-label": "Steps of the diagnosis" }, ...this.tabs);
    list.addEventListener("keydown", (event) => this.turn(event));
    this.heading = html("h3", { class: "model" });
    this.error = html("p", { class: "error", "aria-live": "polite" });
    this.found = html("div", { class: "finding" });
    this.places = this.axis.frames.map(() => html("div", { class: "place" }));
    this.place = html("div", { class: "places" }, ...this.places);
    this.course = this.axis.course ? html("div", { class: "place" }) : null;
    this.events = html("ol", { class: "events", "aria-label": "Events" },
      ...(this.axis.course?.events ?? []).map((event) => html("li", {}, event.words)));
    this.legend = html("ul", { class: "legend", "aria-label": "Legend" });
    this.words = html("p", { class: "words" });
    this.candidates = html("div", { class: "candidates" });
    this.coefficients = html("div", { class: "coefficients" });
    const panel = html("div", { role: "tabpanel", id: id("panel"), class: "panel" },
      this.heading, this.error, this.words, this.place, this.legend, this.found, this.candidates, this.coefficients,
      this.course ? html("h3", {}, "The record over time") : null, this.course, this.course ? this.events : null);
    this.panel = panel;
    this.root.replaceChildren(
      html("div", { class: "control" },
        html("div", { class: "turns" }, this.previous, this.next),
        list,
        html("p", { class: "key" }, "The bar is χ² on a logarithmic scale; the mark is at the degrees of freedom.")),
      panel);
  }

  /// The tab of a step, with its χ² as a number and as a bar.
  tab(at, id) {
    const { chi2, dof } = this.steps[at];
    const view = this.axis.steps[at];
    const most = Math.max(...this.steps.map((step) => Math.max(step.chi2 ?? 1, 2 * step.dof)));
    const share = (value) => 100 * Math.max(0.01, Math.log(Math.max(1, value)) / Math.log(most));
    const name = at === 0 ? "five terms" : `+ ${view.found?.name ?? ""}`;
    const tab = html("button", { type: "button", role: "tab", id: id(`step-${at}`), class: "step",
      "aria-controls": id("panel") },
      html("span", { class: "name" }, name),
      html("span", { class: "chi2" }, `χ² ${tenth(chi2)}`),
      html("span", { class: "track", "aria-hidden": "true" },
        html("span", { class: "fill", style: `width:${share(chi2 ?? 1)}%` }),
        dof > 0 ? html("span", { class: "dof", style: `left:${share(dof)}%` }) : null));
    tab.addEventListener("click", () => this.show(at));
    return tab;
  }

  turn(event) {
    const last = this.steps.length - 1;
    const to = { ArrowDown: this.step + 1, ArrowRight: this.step + 1, ArrowUp: this.step - 1,
      ArrowLeft: this.step - 1, Home: 0, End: last }[event.key];
    if (to === undefined) return;
    event.preventDefault();
    this.show(to);
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
      html("span", { class: "figures chi2" }, "χ² ", strong(tenth(fit.chi2)), ` for ${fit.dof} degrees of freedom`),
      html("span", { class: "figures" }, "misfit ", strong(tenth(fit.rms_percent)), " % rms"),
      html("span", { class: "figures" }, "p ", strong(view.p)));
    this.words.textContent = `${view.words[0].toUpperCase()}${view.words.slice(1)}.`;
    this.showCoefficients(fit, view);
    this.showLegend(view);
    this.draw();
  }

  draw() {
    if (this.place.clientWidth < 100) return;
    const { view } = this.shown();
    this.places.forEach((place, number) => {
      const frame = this.axis.frames[number];
      const unit = frame.units[Math.min(unitIndex, frame.units.length - 1)];
      // Where the figures are below each other, the one in which this step changed most comes first.
      place.classList.toggle("front", number === view.front);
      place.replaceChildren(drawFigure(frame, view, view.figures[number], unit, Math.round(place.clientWidth)));
    });
    if (this.course) this.course.replaceChildren(drawCourse(this.axis.course, Math.round(this.course.clientWidth)));
  }

  showLegend(view) {
    const entry = (words, ...sample) => html("li", {},
      draw("svg", { width: 34, height: 14, "aria-hidden": "true" }, ...sample), words);
    const line = (name) => draw("line", { x1: 1, y1: 7, x2: 33, y2: 7, class: name });
    // An effect that shows in both figures has one entry.
    const shares = new Map(view.figures.flatMap((figure) => figure.shares).map((share) => [share.effect, share]));
    const effects = [...shares.values()].map((share) =>
      entry(plain(share.effect), line(`line effect-${share.colour}`)));
    this.legend.replaceChildren(
      entry("measured ± standard error", draw("line", { x1: 17, y1: 0, x2: 17, y2: 14, class: "bar" }),
        draw("circle", { cx: 17, cy: 7, r: 3.5, class: "dot" })),
      entry("model", line("line model")), ...effects,
      entry("within ± 2 standard errors", draw("rect", { x: 1, y: 1, width: 32, height: 12, class: "band" })));
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
          html("th", { class: "number" }, "improvement"))),
        html("tbody", {}, row(null, "none: the model of this step", tenth(this.steps[this.step].chi2), "0"), ...rows)));
  }

  /// The coefficients of the five terms beside those of the model that is shown.
  showCoefficients(fit, view) {
    const before = this.steps[0].coefficients;
    const custom = (one) => (unitIndex === 1 ? this.axis.customary[one.unit] : undefined);
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
      return at < 0 ? none.cloneNode(true) : cell(before[at], this.axis.steps[0].states[at]);
    };
    const walked = this.step > 0 || this.candidate !== null;
    const row = (one, at) => html("tr", {},
      html("th", { scope: "row" }, plain(one.effect), " ", html("i", {}, one.symbol),
        html("span", { class: "unit" }, custom(one)?.unit ?? one.unit)),
      walked ? earlier(one) : null, cell(one, view.states[at]));
    const head = ["coefficient", "five terms", walked ? "now" : null];
    this.coefficients.replaceChildren(html("h3", {}, "Coefficients, with 95 % intervals"),
      html("table", {},
        html("thead", {}, html("tr", {}, ...head.filter((words) => words).map((words) => html("th", { scope: "col" }, words)))),
        html("tbody", {}, ...fit.coefficients.map(row))));
  }
}

const walks = [...document.querySelectorAll(".walk")].map((root) => new Walk(root, Number(root.dataset.axis)));
const units = document.getElementById("units");
units.hidden = false;
units.addEventListener("change", (event) => {
  unitIndex = Number(event.target.value);
  walks.forEach((walk) => walk.update());
});
// A link such as #step=2 shows that step of every axis, or the last step of an axis with fewer.
const step = /^#step=(\d+)$/.exec(location.hash);
if (step) walks.forEach((walk) => walk.show(Number(step[1])));
