// A figure that answers: a cursor with the values of a point, zoom and pan by mouse, wheel, fingers and keys, and
// logarithmic or linear axes.
"use strict";

/// The smallest part of an axis that is shown. Chosen by hand: the bins of a spectrum are hardly closer.
const LEAST_PART = 0.01;
/// A pointer that moves less than this, in pixels, is a click.
const CLICK = 4;
/// The wheel of a page that scrolls goes on to scroll over a figure for this time, in milliseconds. Chosen by hand.
const SCROLLING = 300;

let lastWheel = { at: 0, plot: null };
window.addEventListener("wheel", (event) => {
  const plot = event.target instanceof Element ? event.target.closest(".stage") : null;
  const goesOn = event.timeStamp - lastWheel.at < SCROLLING;
  lastWheel = { at: event.timeStamp, plot: goesOn ? lastWheel.plot : plot };
}, { passive: true, capture: true });

/// A figure with its cursor and its controls. `changed` is called when another part is seen; `pick`, if there is one, has
/// the words of its button and what it does with the horizontal coordinate of a point.
class Plot {
  constructor({ changed = () => {}, pick = null } = {}) {
    Object.assign(this, { changed, pick, view: wholeView(), cursor: null, pointers: new Map(), moved: 0, drawn: null });
    this.stage = html("div", { class: "stage", tabindex: 0, role: "slider", "aria-orientation": "horizontal" });
    this.readout = html("p", { class: "readout" });
    this.tools = html("div", { class: "tools", role: "group" });
    this.root = html("div", { class: "place" }, this.stage, this.readout, this.tools);
    const on = (name, act, options) => this.stage.addEventListener(name, act, options);
    on("wheel", (event) => this.wheel(event), { passive: false });
    on("pointerdown", (event) => this.press(event));
    on("pointermove", (event) => this.move(event));
    on("pointerup", (event) => this.release(event));
    on("pointercancel", (event) => this.pointers.delete(event.pointerId));
    on("keydown", (event) => this.key(event));
  }

  /// Shows a scene in a frame.
  set(frame, scene, unit) {
    if (this.frame?.quantity !== frame.quantity) this.buildTools(frame);
    Object.assign(this, { frame, scene, unit });
    // The cursor stays at its coordinate; the first one is at the largest residual.
    const [record] = scene.records;
    const places = record.points.x.length;
    if (this.cursor === null || this.cursor.record >= scene.records.length) this.cursor = { record: 0, x: null };
    if (this.cursor.x === null && places > 0) this.cursor.x = record.points.x[worstOf(record)];
    this.draw();
  }

  /// Takes what is seen from an address, as far as it is in the frame.
  adopt(view) {
    const [low, high] = this.frame?.x ?? [0, Infinity];
    const part = view.x && view.x[0] < view.x[1] ? [Math.max(low, view.x[0]), Math.min(high, view.x[1])] : null;
    this.view = { ...wholeView(), ...view, x: part && part[0] < part[1] ? part : null };
    if (this.frame) this.draw();
  }

  buildTools(frame) {
    const tool = (name, words, label, act) => {
      const button = html("button", { type: "button", class: "tool", "data-tool": name, "aria-label": label, title: label }, words);
      button.addEventListener("click", act);
      return button;
    };
    const of = ` of the ${frame.name}`;
    const [across, up] = [frame.coordinate[0], frame.up];
    this.buttons = {
      out: tool("out", "−", `Zoom out${of}`, () => this.zoom(1 / 1.5)),
      in: tool("in", "+", `Zoom in${of}`, () => this.zoom(1.5)),
      left: tool("left", "←", `Move to the left${of}`, () => this.pan(-0.25)),
      right: tool("right", "→", `Move to the right${of}`, () => this.pan(0.25)),
      reset: tool("reset", "All", `Show all${of}`, () => this.reset()),
      across: tool("across", `${{ s: "τ", Hz: "f" }[frame.coordinate[1]]} linear`, `Linear scale of the ${across}`, () => this.turn("linearAcross")),
      up: tool("up", `${{ s: "σ", Hz: "√S" }[frame.coordinate[1]]} linear`, `Linear scale of the ${up}`, () => this.turn("linearUp")),
    };
    this.tools.setAttribute("aria-label", `View${of}`);
    this.tools.replaceChildren(...Object.values(this.buttons));
  }

  /// The width in which the figure is drawn.
  get width() {
    return Math.round(this.stage.clientWidth);
  }

  draw() {
    if (!this.scene || this.width < 100) return;
    this.drawn = drawFigure(this.frame, this.scene, this.unit, this.width, { view: this.view });
    this.stage.replaceChildren(this.drawn.svg);
    this.stage.setAttribute("aria-label", `${this.scene.title}; the arrow keys move a cursor, plus, minus and 0 zoom`);
    for (const name of ["out", "left", "right", "reset"]) this.buttons[name].disabled = this.view.x === null;
    this.buttons.across.setAttribute("aria-pressed", this.view.linearAcross);
    this.buttons.up.setAttribute("aria-pressed", this.view.linearUp);
    this.showCursor();
  }

  /// The record and the place of the point nearest to the cursor.
  point() {
    const record = this.scene.records[this.cursor.record];
    const { x } = record.points;
    if (x.length === 0) return null;
    const distance = (value) => Math.abs(Math.log(value / this.cursor.x));
    const at = x.reduce((nearest, value, k) => (distance(value) < distance(x[nearest]) ? k : nearest), 0);
    return { record, at };
  }

  showCursor() {
    const { svg, sheet, curve, residual, across, up } = this.drawn;
    svg.querySelector(".cursor")?.remove();
    const point = this.point();
    if (!point) return;
    const { record, at } = point;
    const share = across.at(record.points.x[at]);
    if (share > -0.001 && share < 1.001) {
      const x = sheet.x(share);
      const ring = (panel, height) => draw("circle", { cx: x, cy: sheet.y(panel, clamp(height)), r: 5.5 });
      svg.append(draw("g", { class: "cursor" },
        draw("line", { x1: x, y1: curve.top, x2: x, y2: residual.top + residual.height }),
        ring(curve, up.at(record.points.measured[at])), ring(residual, record.up[at])));
    }
    this.say(record, at);
  }

  /// Writes the values of a point below the figure, and tells them to a screen reader.
  say(record, at) {
    const { points, expected, z } = record;
    const [name, of] = this.frame.coordinate;
    const value = (values) => number(this.unit.factor * values[at]);
    const parts = [
      ["across", `${name} `, `${number(points.x[at])} ${of}`],
      ["measured", `${this.frame.up} `, `${value(points.measured)} ${this.unit.name}`],
      ["bar", "± standard error ", `${value(points.lower)} … ${value(points.upper)}`],
      ["model", "model ", value(expected)],
      ["residual", "residual ", standardErrors(z[at], 1)],
    ];
    const words = parts.map(([part, label, figures]) => html("span", { "data-part": part }, label, html("strong", {}, figures)));
    const named = this.scene.records.length > 1 ? [html("span", { "data-part": "record" }, record.name)] : [];
    const button = this.pick ? [this.pickButton(points.x[at])] : [];
    this.readout.replaceChildren(...named, ...words, ...button);
    const spoken = [...named, ...words].map((part) => part.textContent).join(", ");
    for (const [key, text] of [["valuemin", 1], ["valuemax", points.x.length], ["valuenow", at + 1], ["valuetext", spoken]]) {
      this.stage.setAttribute(`aria-${key}`, text);
    }
  }

  pickButton(x) {
    const button = html("button", { type: "button", class: "tool pick" }, this.pick.words(x));
    button.addEventListener("click", () => this.pick.act(x));
    return button;
  }

  // What is seen.

  /// The ends of the part that is seen, as positions of the whole axis, and the scale of that.
  part() {
    const whole = new Scale(this.frame.x, this.view.linearAcross);
    return { whole, ends: (this.view.x ?? this.frame.x).map((end) => whole.at(end)) };
  }

  see(from, size, whole) {
    const part = Math.min(1, Math.max(LEAST_PART, size));
    const start = Math.min(1 - part, Math.max(0, from));
    this.view.x = part > 0.999 ? null : [whole.value(start), whole.value(start + part)];
    this.draw();
    this.changed();
  }

  /// Zooms by a factor about a position of what is seen; without one, about the cursor or the middle.
  zoom(factor, about = null) {
    const { whole, ends: [from, to] } = this.part();
    const point = this.point();
    const cursor = point ? this.drawn.across.at(point.record.points.x[point.at]) : 0.5;
    const share = about ?? (cursor >= 0 && cursor <= 1 ? cursor : 0.5);
    const size = Math.min(1, Math.max(LEAST_PART, (to - from) / factor));
    this.see(from + share * (to - from - size), size, whole);
  }

  /// Moves what is seen by a share of it.
  pan(by) {
    const { whole, ends: [from, to] } = this.part();
    this.see(from + by * (to - from), to - from, whole);
  }

  reset() {
    this.view.x = null;
    this.draw();
    this.changed();
  }

  turn(name) {
    this.view[name] = !this.view[name];
    this.draw();
    this.changed();
  }

  // Pointers and keys.

  /// The position of an event in the drawing, in its pixels.
  place(event) {
    const box = this.stage.getBoundingClientRect();
    const scale = this.drawn.sheet.width / box.width;
    return { x: (event.clientX - box.left) * scale, y: (event.clientY - box.top) * scale };
  }

  /// The share of what is seen at a horizontal position.
  share(x) {
    const { sheet } = this.drawn;
    return (x - sheet.x(0)) / (sheet.x(1) - sheet.x(0));
  }

  wheel(event) {
    if (lastWheel.plot !== this.stage && !event.ctrlKey) return;
    const isAcross = event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY);
    const turned = (event.deltaMode === 1 ? 16 : 1) * (isAcross ? event.deltaX || event.deltaY : event.deltaY);
    // What cannot move any further lets the page scroll.
    if (this.view.x === null && (isAcross || turned > 0)) return;
    event.preventDefault();
    if (isAcross) this.pan(turned / 600);
    else this.zoom(Math.exp(-turned / (event.ctrlKey ? 100 : 300)), clamp(this.share(this.place(event).x)));
  }

  press(event) {
    if (event.button !== 0) return;
    this.stage.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, this.place(event));
    this.moved = this.pointers.size > 1 ? Infinity : 0;
    if (event.pointerType !== "mouse" && this.pointers.size === 1) this.pointAt(this.place(event));
  }

  move(event) {
    const to = this.place(event);
    const from = this.pointers.get(event.pointerId);
    if (!from) {
      if (event.pointerType === "mouse") this.pointAt(to);
      return;
    }
    if (this.pointers.size === 2) return this.pinch(event.pointerId, from, to);
    this.moved = Math.max(this.moved, Math.hypot(to.x - from.x, to.y - from.y));
    if (event.pointerType !== "mouse") {
      this.pointers.set(event.pointerId, to);
      return this.pointAt(to);
    }
    // Until the mouse has moved by more than a click, the place of the press is kept, so that the drag begins there.
    if (this.moved <= CLICK) return;
    this.pointers.set(event.pointerId, to);
    if (this.view.x) this.pan(this.share(from.x) - this.share(to.x));
  }

  /// Two fingers zoom by their distance, and move what is between them.
  pinch(moving, from, to) {
    const [[, other]] = [...this.pointers].filter(([id]) => id !== moving);
    const distance = (one) => Math.max(20, Math.hypot(one.x - other.x, one.y - other.y));
    const middle = (one) => this.share((one.x + other.x) / 2);
    const [before, after] = [middle(from), middle(to)];
    this.pointers.set(moving, to);
    this.zoom(distance(to) / distance(from), clamp(before));
    if (this.view.x) this.pan(before - after);
  }

  release(event) {
    if (!this.pointers.delete(event.pointerId)) return;
    if (this.moved <= CLICK && event.pointerType === "mouse" && this.pick) {
      const peak = this.peak(this.place(event));
      if (peak !== null) this.pick.act(peak);
    }
  }

  /// The point with the largest residual among those of the fitted record that are near a position.
  peak({ x }) {
    const { sheet, across } = this.drawn;
    const [record] = this.scene.records;
    const near = record.points.x.map((value, k) => k).filter((k) => Math.abs(sheet.x(across.at(record.points.x[k])) - x) < 14);
    if (near.length === 0) return null;
    return record.points.x[near.reduce((best, k) => (record.z[k] > record.z[best] ? k : best))];
  }

  /// Moves the cursor to the point nearest to a position; among several records, height counts as well.
  pointAt({ x, y }) {
    const { sheet, curve, across, up } = this.drawn;
    let least = Infinity;
    this.scene.records.forEach(({ points }, record) => {
      points.x.forEach((value, k) => {
        const share = across.at(value);
        if (share < -0.001 || share > 1.001) return;
        const high = this.scene.records.length > 1 && y < curve.top + curve.height;
        const far = Math.hypot(sheet.x(share) - x, high ? 0.3 * (sheet.y(curve, clamp(up.at(points.measured[k]))) - y) : 0);
        if (far >= least) return;
        least = far;
        this.cursor = { record, x: value };
      });
    });
    this.showCursor();
  }

  /// Moves the cursor by so many points, and what is seen with it.
  step(by) {
    const point = this.point();
    if (!point) return;
    const { x } = point.record.points;
    this.cursor.x = x[Math.min(x.length - 1, Math.max(0, point.at + by))];
    const share = this.drawn.across.at(this.cursor.x);
    if (this.view.x && (share < 0 || share > 1)) this.pan(share - (share < 0 ? 0.1 : 0.9));
    else this.showCursor();
  }

  key(event) {
    if (event.ctrlKey || event.altKey || event.metaKey || !this.drawn) return;
    const acts = {
      "+": () => this.zoom(1.5), "=": () => this.zoom(1.5), "-": () => this.zoom(1 / 1.5), "−": () => this.zoom(1 / 1.5), "0": () => this.reset(),
      ArrowLeft: () => (event.shiftKey ? this.pan(-0.1) : this.step(-1)),
      ArrowRight: () => (event.shiftKey ? this.pan(0.1) : this.step(1)),
      ArrowUp: () => this.record(-1), ArrowDown: () => this.record(1),
      PageUp: () => this.step(10), PageDown: () => this.step(-10), Home: () => this.step(-Infinity), End: () => this.step(Infinity),
    };
    if (event.key === "Enter" && this.pick) acts.Enter = () => this.pick.act(this.cursor.x);
    const act = acts[event.key];
    if (!act) return;
    event.preventDefault();
    act();
  }

  /// Moves the cursor to another record.
  record(by) {
    const { length } = this.scene.records;
    this.cursor.record = (this.cursor.record + by + length) % length;
    this.showCursor();
  }
}
